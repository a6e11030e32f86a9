//! Files that commands write outside a suite: no output takes the place of something that is read, or of another output.
//!
//! What is to be read and written is told before the work begins ([`Outputs`]), so that a run of an hour does not end in
//! a refusal. A regular file is replaced whole or not at all; a device, a FIFO or the standard output is written to.

use crate::error::PipelineError;
use crate::files::store::{TEMPORARY_PREFIX, Unfinished, io, write_file_whole};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// What a command reads, and what it is about to write.
#[derive(Debug, Default)]
pub struct Outputs {
    inputs: BTreeMap<Identity, PathBuf>,
    /// Folders among the inputs: as they were named, and without links.
    folders: Vec<(PathBuf, PathBuf)>,
    taken: BTreeMap<Identity, PathBuf>,
}

impl Outputs {
    /// Outputs of a command that reads these files and folders.
    pub fn of_inputs(inputs: impl IntoIterator<Item = PathBuf>) -> Self {
        let mut outputs = Self::default();
        for input in inputs {
            if input.is_dir() {
                outputs.folders.push((input.clone(), real(&input)));
            }
            outputs.inputs.insert(Identity::of(&input), input);
        }
        outputs
    }

    /// A file to be written.
    ///
    /// # Errors
    /// It is something that is read, a file that lies in a folder that is read, another output, or a folder.
    pub fn claim(&mut self, path: &Path) -> Result<Output, PipelineError> {
        let refused = |why: String| Err(PipelineError::bad_input(format!("{}: {why}", path.display())));
        let output = Output { target: Target::of(path)?, shown: path.to_owned() };
        let identity = Identity::of(output.path());
        if let Some(input) = self.inputs.get(&identity) {
            return refused(format!("it is read as {}, so it is not overwritten; name another file", input.display()));
        }
        let Target::Replaced(target) = &output.target else {
            // Two streams into one device mix, and take nothing's place.
            return Ok(output);
        };
        if target.exists()
            && let Some(place) = target.parent().map(real)
            && let Some((folder, _)) = self.folders.iter().find(|(_, folder)| place.starts_with(folder))
        {
            let folder = folder.display();
            return refused(format!("it lies in {folder}, which is read, so it is not overwritten; name another file"));
        }
        match self.taken.insert(identity, path.to_owned()) {
            Some(other) => refused(format!("it is written as {} as well; name two files", other.display())),
            None => Ok(output),
        }
    }
}

/// A file that may be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    target: Target,
    shown: PathBuf,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Target {
    /// A regular file, or none yet: links resolved.
    Replaced(PathBuf),
    /// A device, a FIFO or a socket.
    WrittenTo(PathBuf),
    /// `/dev/stdout`: opened by its name, it would begin at the start of a file that the shell has opened for us.
    StandardOutput,
}

impl Target {
    fn of(path: &Path) -> Result<Self, PipelineError> {
        let bad = |why: &str| PipelineError::bad_input(format!("{}: {why}", path.display()));
        if path == Path::new("/dev/stdout") {
            return Ok(Self::StandardOutput);
        }
        match fs::metadata(path) {
            Ok(there) if there.is_dir() => Err(bad("it is a folder; name a file in it")),
            Ok(there) if there.is_file() => Ok(Self::Replaced(real(path))),
            Ok(_) => Ok(Self::WrittenTo(path.to_owned())),
            Err(_) if fs::symlink_metadata(path).is_ok() => Err(bad("it is a link to nowhere; name the file itself")),
            Err(_) => Ok(Self::Replaced(path.to_owned())),
        }
    }
}

impl Output {
    /// Refuses a file whose folder is not there, before the work of an hour ends in that.
    ///
    /// # Errors
    /// There is no such folder.
    pub(crate) fn in_a_folder(self) -> Result<Self, PipelineError> {
        let folder = self.path().parent().filter(|folder| !folder.as_os_str().is_empty());
        match folder.is_some_and(|folder| !folder.exists()) {
            true => Err(self.failed()(std::io::Error::from(std::io::ErrorKind::NotFound))),
            false => Ok(self),
        }
    }

    /// As it was named.
    pub fn name(&self) -> &Path {
        &self.shown
    }

    /// Whether a regular file is there, which writing replaces.
    pub(crate) fn replaces(&self) -> bool {
        matches!(&self.target, Target::Replaced(path) if path.exists())
    }

    fn path(&self) -> &Path {
        match &self.target {
            Target::Replaced(path) | Target::WrittenTo(path) => path,
            Target::StandardOutput => &self.shown,
        }
    }

    fn failed(&self) -> impl Fn(std::io::Error) -> PipelineError + use<> {
        let path = self.shown.clone();
        move |source| io("write", &path, source)
    }

    /// Writes all of it: a regular file whole or not at all.
    ///
    /// # Errors
    /// It cannot be written; a regular file that stood there still stands.
    pub fn write(&self, content: &[u8]) -> Result<(), PipelineError> {
        let written = match &self.target {
            Target::Replaced(path) => write_file_whole(path, content),
            Target::WrittenTo(path) => OpenOptions::new().write(true).open(path).and_then(|mut f| f.write_all(content)),
            Target::StandardOutput => standard_output(content),
        };
        written.map_err(self.failed())
    }

    /// Begins to write bit by bit. A regular file is written under another name, and gets its own at the end.
    ///
    /// # Errors
    /// It cannot be opened, or another run is writing it.
    pub fn begin(&self) -> Result<Begun, PipelineError> {
        let failed = self.failed();
        let sink: Box<dyn Write + Send> = match &self.target {
            Target::Replaced(path) => return self.begin_beside(path),
            Target::WrittenTo(path) => Box::new(OpenOptions::new().write(true).open(path).map_err(failed)?),
            Target::StandardOutput => Box::new(std::io::stdout()),
        };
        Ok(Begun { sink: BufWriter::new(sink), part: None })
    }

    fn begin_beside(&self, path: &Path) -> Result<Begun, PipelineError> {
        let failed = self.failed();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let part = path.with_file_name(format!("{TEMPORARY_PREFIX}{name}.part"));
        remove_part_of_a_killed_run(&part, path)?;
        // Never through a link, and never into a file that is there.
        let file = OpenOptions::new().write(true).create_new(true).open(&part).map_err(&failed)?;
        // Where the system has no locks, two runs at once are the user's to avoid.
        let _ = file.try_lock();
        let unfinished = Unfinished::new(&part);
        let kept = file.try_clone().map_err(&failed)?;
        let part = Part { file: kept, part, target: path.to_owned(), finished: false, _unfinished: unfinished };
        Ok(Begun { sink: BufWriter::new(Box::new(file)), part: Some(part) })
    }
}

/// Removes what a killed run was writing when it was killed.
fn remove_part_of_a_killed_run(part: &Path, target: &Path) -> Result<(), PipelineError> {
    if fs::symlink_metadata(part).is_ok_and(|there| there.is_file())
        && let Ok(file) = File::open(part)
        && matches!(file.try_lock(), Err(TryLockError::WouldBlock))
    {
        return Err(PipelineError::bad_input(format!(
            "another run is writing {}; name another file",
            target.display()
        )));
    }
    match fs::remove_file(part) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(io("remove", part, source)),
        _ => Ok(()),
    }
}

/// An output that is being written; without [`Begun::finish`] nothing of a regular file remains.
pub struct Begun {
    sink: BufWriter<Box<dyn Write + Send>>,
    part: Option<Part>,
}

struct Part {
    file: File,
    part: PathBuf,
    target: PathBuf,
    finished: bool,
    _unfinished: Unfinished,
}

impl Begun {
    /// Ends the writing, and gives a regular file its name.
    ///
    /// # Errors
    /// Not all of it could be written.
    pub fn finish(mut self) -> std::io::Result<()> {
        self.sink.flush()?;
        if let Some(part) = &mut self.part {
            part.file.sync_data()?;
            fs::rename(&part.part, &part.target)?;
            part.finished = true;
        }
        Ok(())
    }
}

impl Write for Begun {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.sink.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.sink.flush()
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if !self.finished {
            // What was written of it is of no use; that it cannot be removed changes nothing.
            let _ = fs::remove_file(&self.part);
        }
    }
}

fn standard_output(content: &[u8]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(content)?;
    out.flush()
}

/// What makes two names one file: links, hard links and other spellings are the same.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Identity {
    #[cfg(unix)]
    Inode(u64, u64),
    Path(PathBuf),
}

impl Identity {
    fn of(path: &Path) -> Self {
        #[cfg(unix)]
        if let Ok(there) = fs::metadata(path) {
            use std::os::unix::fs::MetadataExt;
            return Self::Inode(there.dev(), there.ino());
        }
        Self::Path(real(path))
    }
}

/// The path without links and `..`; of a file that is not there yet, its folder's.
fn real(path: &Path) -> PathBuf {
    let folder = || {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(fs::canonicalize(parent).ok()?.join(path.file_name()?))
    };
    let empty = path.as_os_str().is_empty();
    let whole = fs::canonicalize(if empty { Path::new(".") } else { path });
    whole.ok().or_else(folder).unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("input"), "precious").unwrap();
        folder
    }

    #[test]
    fn an_output_that_is_begun_and_dropped_leaves_what_was_there() {
        let folder = place();
        let target = folder.path().join("input");
        let output = Outputs::default().claim(&target).unwrap();
        let mut begun = output.begin().unwrap();
        begun.write_all(b"half").unwrap();
        assert!(matches!(output.begin(), Err(PipelineError::BadInput { .. })), "two at once");
        drop(begun);
        assert_eq!(fs::read_to_string(&target).unwrap(), "precious");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let mut begun = output.begin().unwrap();
        begun.write_all(b"whole").unwrap();
        begun.finish().unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "whole");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn where_there_is_no_folder_nothing_is_begun() {
        let refused = Outputs::default().claim(&place().path().join("nowhere/results.json")).unwrap().in_a_folder();
        assert!(matches!(refused, Err(PipelineError::Io { action: "write", .. })), "{refused:?}");
    }

    #[test]
    #[cfg(unix)]
    fn what_a_killed_run_left_is_not_written_through() {
        let folder = place();
        let input = folder.path().join("input");
        std::os::unix::fs::symlink(&input, folder.path().join(".recrash-new.part")).unwrap();
        let output = Outputs::default().claim(&folder.path().join("new")).unwrap();
        let mut begun = output.begin().unwrap();
        begun.write_all(b"rows").unwrap();
        begun.finish().unwrap();
        assert_eq!(fs::read_to_string(&input).unwrap(), "precious");
        assert_eq!(fs::read_to_string(folder.path().join("new")).unwrap(), "rows");
    }

    #[test]
    #[cfg(unix)]
    fn a_link_is_followed_and_stays_a_link() {
        let folder = place();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("input", &link).unwrap();
        Outputs::default().claim(&link).unwrap().write(b"new").unwrap();
        assert_eq!(fs::read_to_string(folder.path().join("input")).unwrap(), "new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        std::os::unix::fs::symlink("nowhere", folder.path().join("lost")).unwrap();
        assert!(Outputs::default().claim(&folder.path().join("lost")).is_err());
    }
}
