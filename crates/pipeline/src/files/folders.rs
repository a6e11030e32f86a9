//! Folders that commands make.

use crate::error::PipelineError;
use crate::files::store::{TEMPORARY_PREFIX, Unfinished, io};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Refuses to fill a folder that holds something else: it must be new, empty, or hold `ours`, the file that says that we filled it.
///
/// # Errors
/// It holds something else, or is a file.
pub fn must_be_free(folder: &Path, ours: Option<&str>) -> Result<(), PipelineError> {
    let refused = |why: &str| Err(PipelineError::bad_input(format!("{}: {why}", folder.display())));
    match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(_) if folder.is_file() => refused("it is a file; name a folder"),
        Err(source) => Err(io("read", folder, source)),
        Ok(mut entries) => {
            let is_ours = ours.is_some_and(|name| folder.join(name).is_file());
            if is_ours || entries.next().is_none() {
                Ok(())
            } else {
                refused("it holds something else; name another folder, or empty it")
            }
        }
    }
}

/// A file that is there and says something else than would be written may be somebody's work: it is not replaced.
///
/// # Errors
/// There is such a file.
pub fn must_be_absent_or_same(file: &Path, text: &[u8]) -> Result<(), PipelineError> {
    if fs::symlink_metadata(file).is_ok() && fs::read(file).ok().as_deref() != Some(text) {
        return Err(PipelineError::bad_input(format!(
            "{} is there and differs from what would be written; name another folder, or move the file away",
            file.display()
        )));
    }
    Ok(())
}

/// A folder that is filled under another name beside its own, and gets that at the end: whole or not at all. Without
/// [`FolderInWork::finish`] nothing of it remains.
pub struct FolderInWork {
    target: PathBuf,
    folder: tempfile::TempDir,
    _unfinished: Unfinished,
}

impl FolderInWork {
    /// Begins one. What is to become of it must be free: see [`must_be_free`].
    ///
    /// # Errors
    /// No folder can be made beside it.
    pub fn beside(target: &Path) -> Result<Self, PipelineError> {
        // An empty folder may be a link to one.
        let target = target.canonicalize().unwrap_or_else(|_| target.to_owned());
        let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(parent).map_err(|source| io("create", parent, source))?;
        let mut builder = tempfile::Builder::new();
        builder.prefix(TEMPORARY_PREFIX);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Temporary folders are private by default; results are not, and the umask still applies.
            builder.permissions(fs::Permissions::from_mode(0o777));
        }
        let folder = builder.tempdir_in(parent).map_err(|source| io("create", &target, source))?;
        let unfinished = Unfinished::new(folder.path());
        Ok(Self { target, folder, _unfinished: unfinished })
    }

    /// Where it is filled.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Gives it its name. An empty folder in its place goes, and one that is not empty any more stays.
    ///
    /// # Errors
    /// Something came into its place meanwhile, or the system refuses.
    pub fn finish(self) -> Result<(), PipelineError> {
        let failed = |source| io("write", &self.target, source);
        if let Ok(there) = fs::metadata(&self.target) {
            fs::set_permissions(self.path(), there.permissions()).map_err(failed)?;
            fs::remove_dir(&self.target).map_err(failed)?;
        }
        fs::rename(self.path(), &self.target).map_err(failed)?;
        // Its old name is gone already.
        let _ = self.folder.keep();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_comes_whole_or_not_at_all_and_what_came_into_its_place_stays() {
        let place = tempfile::tempdir().unwrap();
        let target = place.path().join("evidence");
        let filled = || {
            let work = FolderInWork::beside(&target).unwrap();
            fs::write(work.path().join("a"), "ours").unwrap();
            work
        };
        drop(filled());
        assert_eq!(names(place.path()), [""; 0]);
        fs::create_dir(&target).unwrap();
        drop(filled());
        assert_eq!(names(place.path()), ["evidence"]);
        let work = filled();
        fs::write(target.join("mine"), "precious").unwrap();
        let error = work.finish().unwrap_err().to_string();
        assert!(error.contains("evidence"), "{error}");
        assert_eq!((names(place.path()), names(&target)), (vec!["evidence".to_owned()], vec!["mine".to_owned()]));
        fs::remove_file(target.join("mine")).unwrap();
        filled().finish().unwrap();
        assert_eq!((names(place.path()), names(&target)), (vec!["evidence".to_owned()], vec!["a".to_owned()]));
    }
}
