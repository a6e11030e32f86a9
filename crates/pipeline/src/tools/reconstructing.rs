//! Reconstructions as scenario files, one an incident.

use crate::error::PipelineError;
use crate::files::folders::must_be_absent_or_same;
use crate::files::output::Outputs;
use crate::files::store::io;
use crate::reading::retelling::Retold;
use recrash_reconstruct::Reconstruction;
use std::path::{Path, PathBuf};

/// Writes the scenarios that show every told fact that is checked, each as a file named by its incident. Gives the files.
///
/// # Errors
/// A file cannot be written, or is one of the inputs.
pub fn write_reconstructions(
    retold: &[Retold],
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<Vec<PathBuf>, PipelineError> {
    if folder.exists() && !folder.is_dir() {
        return Err(PipelineError::bad_input(format!(
            "{} is a file; name a folder for the scenarios",
            folder.display()
        )));
    }
    std::fs::create_dir_all(folder).map_err(|source| io("create", folder, source))?;
    let mut files = Vec::new();
    let text = |made: &Reconstruction| recrash_roads::write_draft(&made.draft);
    // All of them before the first is written.
    for made in retold.iter().filter(|each| each.untold().is_none()).filter_map(|each| each.result.as_ref().ok()) {
        must_be_absent_or_same(&folder.join(format!("{}.json", made.draft.id)), text(made).as_bytes())?;
    }
    for each in retold.iter().filter(|each| each.untold().is_none()) {
        let Ok(made) = &each.result else { continue };
        let file = folder.join(format!("{}.json", made.draft.id));
        let output = outputs.claim(&file)?;
        output.write(text(made).as_bytes())?;
        files.push(file);
    }
    Ok(files)
}
