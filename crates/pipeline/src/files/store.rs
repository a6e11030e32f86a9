//! Files: read with a bound on their size, written whole or not at all.

use crate::error::PipelineError;
use crate::files::json::{from_json, to_json};
use recrash_model::hash::hexadecimal;
use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// This program: what other code made is made again.
pub(crate) const CODE: &str = concat!(env!("CARGO_PKG_VERSION"), " ", env!("RECRASH_CODE"));

/// Greatest size of a file of a suite that is read back. [bytes]
const MAX_SUITE_FILE: u64 = 1 << 30;

/// First letters of the names of files that are being written.
pub(crate) const TEMPORARY_PREFIX: &str = ".recrash-";

/// Files and folders that are being written under another name.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file and folder that is being written, for a program that is interrupted and ends: nothing is begun afterwards.
pub fn remove_unfinished() {
    let files = unfinished();
    for file in files.iter() {
        // Whoever interrupts wants the end, not a word about a file.
        let is_folder = fs::symlink_metadata(file).is_ok_and(|is| is.file_type().is_dir());
        let _ = if is_folder { fs::remove_dir_all(file) } else { fs::remove_file(file) };
    }
    std::mem::forget(files);
}

/// A file or folder that is being written, as long as this lives.
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    pub(crate) fn new(path: &Path) -> Self {
        unfinished().insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

/// Writes a whole file; a seam for tests of full disks.
pub type WriteFile = fn(&Path, &[u8]) -> std::io::Result<()>;

/// A folder whose files are written whole: under a temporary name first, then renamed.
#[derive(Debug, Clone)]
pub struct Store {
    dir: PathBuf,
    write_file: WriteFile,
}

impl Store {
    /// The folder, which is made where it does not exist.
    ///
    /// # Errors
    /// The folder cannot be made or written to.
    pub fn create(dir: &Path, write_file: WriteFile) -> Result<Self, PipelineError> {
        fs::create_dir_all(dir).map_err(|source| io("create", dir, source))?;
        Ok(Self { dir: dir.to_owned(), write_file })
    }

    /// A folder that is there already, and is only read.
    pub fn at(dir: &Path) -> Self {
        Self { dir: dir.to_owned(), write_file: write_file_whole }
    }

    /// Removes what a killed run was writing when it was killed, one folder deep. Links are not followed.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn remove_leftovers(&self) -> Result<(), PipelineError> {
        let list = |dir: &Path| -> Result<Vec<fs::DirEntry>, PipelineError> {
            let entries = fs::read_dir(dir).and_then(Iterator::collect);
            entries.map_err(|source| io("read", dir, source))
        };
        let is = |entry: &fs::DirEntry, wanted: fn(&fs::FileType) -> bool| entry.file_type().is_ok_and(|t| wanted(&t));
        let mut entries = list(&self.dir)?;
        let folders: Vec<_> = entries.iter().filter(|e| is(e, fs::FileType::is_dir)).map(fs::DirEntry::path).collect();
        for folder in folders {
            entries.extend(list(&folder)?);
        }
        for entry in entries {
            let is_ours = entry.file_name().to_string_lossy().starts_with(TEMPORARY_PREFIX);
            if is_ours && is(&entry, fs::FileType::is_file) {
                fs::remove_file(entry.path()).map_err(|source| io("remove", &entry.path(), source))?;
            }
        }
        Ok(())
    }

    /// The folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Path of a file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Path of a file of the folder, once it is sure to lie in it: a suite may be a stranger's.
    ///
    /// # Errors
    /// The name leads out of the folder, or through a link.
    fn inside(&self, name: &str) -> Result<PathBuf, PipelineError> {
        let path = self.path(name);
        let outside = |why: &str| PipelineError::bad_input(format!("{}: {why}; it is left alone", path.display()));
        if !is_plain_name(name) {
            return Err(outside("a suite's file lies in the suite's folder, or in a folder of it"));
        }
        let link = |path: &Path| fs::symlink_metadata(path).is_ok_and(|is| is.file_type().is_symlink());
        match path.parent().filter(|parent| *parent != self.dir && link(parent)) {
            Some(_) => Err(outside("its folder is a link, and a suite's links are not followed")),
            None => Ok(path),
        }
    }

    /// Path of a folder of this folder, which may be still to be made.
    ///
    /// # Errors
    /// It is a link.
    pub(crate) fn own_folder(&self, name: &str) -> Result<PathBuf, PipelineError> {
        let path = self.path(name);
        if fs::symlink_metadata(&path).is_ok_and(|is| is.file_type().is_symlink()) {
            return Err(PipelineError::bad_input(format!("{} is a link, and is not followed", path.display())));
        }
        Ok(path)
    }

    /// Refuses what is no regular file of the folder: a pipe, a device, a link.
    ///
    /// # Errors
    /// It is such a thing, or lies elsewhere.
    pub(crate) fn must_be_a_file(&self, name: &str) -> Result<(), PipelineError> {
        refuse_special(&self.inside(name)?)
    }

    /// Size and time of last change of a regular file; `None` for what is none, links among them.
    pub(crate) fn stamp(&self, name: &str) -> Option<(u64, u64)> {
        let is = fs::symlink_metadata(self.inside(name).ok()?).ok().filter(|is| is.file_type().is_file())?;
        let changed = is.modified().ok()?.duration_since(std::time::UNIX_EPOCH).ok()?;
        Some((is.len(), u64::try_from(changed.as_nanos()).ok()?))
    }

    /// Adds whole lines to the end of a file, which is made where it does not exist.
    ///
    /// # Errors
    /// The file cannot be written, or is none.
    pub(crate) fn append(&self, name: &str, lines: &[u8]) -> Result<(), PipelineError> {
        let path = self.inside(name)?;
        refuse_special(&path)?;
        let add = || {
            let mut file = fs::OpenOptions::new().create(true).append(true).open(&path)?;
            let before = file.metadata()?.len();
            // Half a line, on a disk that is full, would become the beginning of the next one.
            file.write_all(lines).inspect_err(|_| drop(file.set_len(before)))
        };
        add().map_err(|source| io("write", &path, source))
    }

    /// Writes a file of the folder, and gives the hash of its content.
    ///
    /// # Errors
    /// The file cannot be written; what stood there before still stands.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<String, PipelineError> {
        let path = self.inside(name)?;
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|source| io("create", parent, source))?;
        }
        (self.write_file)(&path, content).map_err(|source| io("write", &path, source))?;
        Ok(sha256(content))
    }

    /// Writes a value as JSON.
    ///
    /// # Errors
    /// As [`Store::write`].
    pub fn write_json<T: Serialize>(&self, name: &str, value: &T) -> Result<String, PipelineError> {
        self.write(name, &to_json(value))
    }

    /// Reads a value from JSON.
    ///
    /// # Errors
    /// The file cannot be read, or is not what a stage wrote.
    pub fn read_json<T: DeserializeOwned>(&self, name: &str) -> Result<T, PipelineError> {
        let path = self.inside(name)?;
        refuse_special(&path)?;
        let text = read_bytes(&path, MAX_SUITE_FILE)?;
        from_json(&text).map_err(|misread| PipelineError::Damaged { problem: misread.to_string(), path })
    }

    /// A file's bytes; none where it cannot be read.
    pub fn read_or_empty(&self, name: &str) -> Vec<u8> {
        self.stamp(name).and_then(|_| read_bytes(&self.path(name), MAX_SUITE_FILE).ok()).unwrap_or_default()
    }

    /// Hash of a file's content; `None` where it is not there.
    pub fn hash(&self, name: &str) -> Option<String> {
        self.stamp(name)?;
        file_hash(&self.path(name))
    }

    /// Removes a file that an earlier run wrote and this one does not. A file that is gone already is no error.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), PipelineError> {
        let path = self.inside(name)?;
        if self.stamp(name).is_none() {
            return Ok(());
        }
        match fs::remove_file(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(io("remove", &path, source)),
            _ => Ok(()),
        }
    }
}

/// Writes to a temporary file beside the target, flushes it to the disk, then renames it.
pub(crate) fn write_file_whole(path: &Path, content: &[u8]) -> std::io::Result<()> {
    write_whole(path, content, true)
}

/// Writes to a temporary file beside the target, then renames it: whole or not at all for whoever reads it, as long as the
/// machine runs. A suite has thousands of files, and one that a power cut spoils is found by its size or hash and made again.
pub(crate) fn write_suite_file(path: &Path, content: &[u8]) -> std::io::Result<()> {
    write_whole(path, content, false)
}

fn write_whole(path: &Path, content: &[u8], to_disk: bool) -> std::io::Result<()> {
    let dir = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_PREFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Temporary files are private by default; results are not, and the umask still applies.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(dir)?;
    let _unfinished = Unfinished::new(file.path());
    file.write_all(content)?;
    if to_disk {
        file.as_file().sync_data()?;
    }
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
}

/// Whether a name is that of a file in a suite: plain words, at most one folder deep.
pub(crate) fn is_plain_name(name: &str) -> bool {
    let plain = |part: &str| {
        let letters = part.chars().all(|c| c.is_ascii_alphanumeric() || "._-".contains(c));
        letters && !part.is_empty() && !part.starts_with('.') && part.len() <= 160
    };
    let parts: Vec<&str> = name.split('/').collect();
    parts.len() <= 2 && parts.into_iter().all(plain)
}

/// Refuses what would block or lead elsewhere: a pipe, a device, a link. What is not there is nobody's business here.
fn refuse_special(path: &Path) -> Result<(), PipelineError> {
    match fs::symlink_metadata(path) {
        Ok(is) if !is.file_type().is_file() => {
            Err(PipelineError::bad_input(format!("{} is no regular file; a suite holds nothing else", path.display())))
        }
        _ => Ok(()),
    }
}

/// Reads a file whole.
///
/// # Errors
/// The file cannot be read, or is larger than `limit` bytes.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, PipelineError> {
    let read = || -> std::io::Result<Vec<u8>> {
        let mut content = Vec::new();
        fs::File::open(path)?.take(limit + 1).read_to_end(&mut content)?;
        Ok(content)
    };
    let content = read().map_err(|source| io("read", path, source))?;
    if content.len() as u64 > limit {
        return Err(PipelineError::bad_input(format!("{} is larger than {limit} bytes", path.display())));
    }
    Ok(content)
}

/// Reads a text file whole.
///
/// # Errors
/// As [`read_bytes`], or the file is not UTF-8.
pub(crate) fn read_text(path: &Path, limit: u64) -> Result<String, PipelineError> {
    String::from_utf8(read_bytes(path, limit)?)
        .map_err(|_| PipelineError::bad_input(format!("{} is not a text file (not UTF-8)", path.display())))
}

/// SHA-256 of a regular file's content, in hexadecimal; `None` where it cannot be read.
pub(crate) fn file_hash(path: &Path) -> Option<String> {
    let mut file = fs::metadata(path).ok().filter(fs::Metadata::is_file).and_then(|_| fs::File::open(path).ok())?;
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer).ok()? {
            0 => return Some(hexadecimal(&hasher.finalize())),
            n => hasher.update(&buffer[..n]),
        }
    }
}

/// SHA-256 in hexadecimal.
pub(crate) fn sha256(content: &[u8]) -> String {
    hexadecimal(&Sha256::digest(content))
}

pub(crate) fn io(action: &'static str, path: &Path, source: std::io::Error) -> PipelineError {
    PipelineError::Io { action, path: path.to_owned(), source }
}
