//! Folders that commands make.

use crate::error::PipelineError;
use crate::files::store::io;
use std::io::ErrorKind;
use std::path::Path;

/// Refuses to fill a folder that holds something else: it must be new, empty, or hold `ours`, the file that says that we filled it.
///
/// # Errors
/// It holds something else, or is a file.
pub fn must_be_free(folder: &Path, ours: Option<&str>) -> Result<(), PipelineError> {
    let refused = |why: &str| Err(PipelineError::bad_input(format!("{}: {why}", folder.display())));
    match std::fs::read_dir(folder) {
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
    if std::fs::symlink_metadata(file).is_ok() && std::fs::read(file).ok().as_deref() != Some(text) {
        return Err(PipelineError::bad_input(format!(
            "{} is there and differs from what would be written; name another folder, or move the file away",
            file.display()
        )));
    }
    Ok(())
}
