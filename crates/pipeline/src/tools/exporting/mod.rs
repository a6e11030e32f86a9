//! Exports of a suite, of a folder of scenario files, or of one of them.

mod sources;

use crate::error::{Choice, PipelineError};
use crate::files::output::Outputs;
use crate::files::paths;
use crate::files::store::{Store, io};
use crate::reading::scenarios::read_scenario;
use recrash_export::{ExportFile, ExportOptions, Format, PartnersAs};
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use serde::Serialize;
use sources::{Source, Sources};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What to export, and where to.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRequest {
    /// A suite's folder, one of scenario files, or a scenario file.
    pub source: PathBuf,
    /// Whether a suite's scenarios are taken as designed, and not as tuned.
    pub designed: bool,
    /// Formats.
    pub formats: Vec<Format>,
    /// How partners move.
    pub partners_as: PartnersAs,
    /// Target folder; each format gets a folder in it. Where not given: `exports` in the suite, or beside the file.
    pub target: Option<PathBuf>,
    /// Whether files that are there already may be overwritten.
    pub force: bool,
    /// Python interpreter, for an ego of MetaDrive's or in Python whose runs are not on the disk.
    pub python: PathBuf,
    /// Whether a program that only the suite names is started as the ego.
    pub trust: bool,
}

/// What was exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExportReport {
    /// Scenarios that were exported, in one format at least.
    pub scenarios: usize,
    /// Those of them that a format cannot hold.
    pub partial: usize,
    /// Files written, in order, and those that an earlier export wrote the same.
    #[serde(serialize_with = "paths::as_texts")]
    pub files: Vec<PathBuf>,
    /// What could not be exported, each with its reason: a scenario, or a scenario in one format.
    pub failures: Vec<Diagnostic>,
}

/// Exports every scenario that can be, in every format that can hold it; what cannot is named, and the rest goes on. Files that are
/// there as they would be written stay, so that an export that was interrupted goes on.
///
/// # Errors
/// The source is no suite and no file, or a file that is there holds something else than would be written; then nothing more is
/// written.
pub fn export(request: &ExportRequest) -> Result<ExportReport, PipelineError> {
    let sources = Sources::read(&request.source, request.designed, &request.python, request.trust)?;
    let beside = if request.source.is_dir() { request.source.clone() } else { parent(&request.source) };
    let target = match &request.target {
        Some(target) => target.clone(),
        // A folder of a suite that is a link leads where nobody asked for.
        None => Store::at(&beside).own_folder("exports")?,
    };
    let mut folders: Vec<(Format, PathBuf)> = Vec::new();
    for &format in &request.formats {
        if !folders.iter().any(|(known, _)| *known == format) {
            folders.push((format, target.join(format.name())));
        }
    }
    for (_, folder) in folders.iter().filter(|(_, folder)| folder.is_dir()) {
        Store::at(folder).remove_leftovers()?;
    }
    let mut writer = Writer {
        outputs: Outputs::of_inputs(sources.scenarios.iter().map(|source| source.path.clone())),
        written: BTreeSet::new(),
        force: request.force,
        files: Vec::new(),
    };
    let mut report = ExportReport { scenarios: 0, partial: 0, files: Vec::new(), failures: Vec::new() };
    for source in &sources.scenarios {
        let made = match files_of(&sources, source, &folders, request.partners_as)? {
            Ok(made) => made,
            Err(why) => {
                report.failures.push(failure(source, "export.failed", format!("not exported: {why}")));
                continue;
            }
        };
        let (files, refused): (Vec<_>, Vec<_>) = made.into_iter().partition(|(_, made)| made.is_ok());
        report.scenarios += usize::from(!files.is_empty());
        report.partial += usize::from(!files.is_empty() && !refused.is_empty());
        for (format, why) in refused.into_iter().filter_map(|(format, made)| Some((format, made.err()?))) {
            report.failures.push(failure(source, "export.format", format!("not exported to {}: {why}", format.name())));
        }
        writer.write(files.into_iter().filter_map(|(_, made)| made.ok()).flatten())?;
    }
    report.files = writer.files;
    Ok(report)
}

fn failure(source: &Source, code: &str, message: String) -> Diagnostic {
    let location = Location { file: Some(source.path.display().to_string()), ..Location::default() };
    Diagnostic::new(Severity::Error, code, location, message)
}

/// Writes the files of an export.
struct Writer {
    outputs: Outputs,
    written: BTreeSet<PathBuf>,
    force: bool,
    files: Vec<PathBuf>,
}

impl Writer {
    /// Writes the files of one scenario, unless they are there.
    ///
    /// # Errors
    /// A file cannot be written, or one of them is there with another content; then none of these is.
    fn write(&mut self, files: impl Iterator<Item = (PathBuf, Vec<u8>)>) -> Result<(), PipelineError> {
        // MetaDrive's script is the same for all.
        let new: Vec<_> = files.filter(|(path, _)| self.written.insert(path.clone())).collect();
        let is_other = |path: &Path, content: &[u8]| path.symlink_metadata().is_ok() && !has_content(path, content);
        if let Some((path, _)) = new.iter().find(|(path, content)| !self.force && is_other(path, content)) {
            let what = format!("{} is there already, and holds something else", path.display());
            return Err(PipelineError::choose(what, Choice::ExportFolder));
        }
        let claimed = new.into_iter().map(|(path, content)| Ok((self.outputs.claim(&path)?, content)));
        for (output, content) in claimed.collect::<Result<Vec<_>, PipelineError>>()? {
            if !has_content(output.name(), &content) {
                let folder = parent(output.name());
                std::fs::create_dir_all(&folder).map_err(|source| io("create", &folder, source))?;
                output.write(&content)?;
            }
            self.files.push(output.name().to_owned());
        }
        Ok(())
    }
}

/// Whether a regular file holds exactly this.
fn has_content(path: &Path, content: &[u8]) -> bool {
    let size = std::fs::symlink_metadata(path).ok().filter(|there| there.is_file()).map(|there| there.len());
    size == Some(content.len() as u64) && std::fs::read(path).is_ok_and(|there| there == content)
}

fn parent(file: &Path) -> PathBuf {
    file.parent().map_or_else(PathBuf::new, Path::to_owned)
}

/// Files with their paths, or why a format cannot hold the scenario.
type Made = Vec<(Format, Result<Vec<(PathBuf, Vec<u8>)>, String>)>;

/// The files of one scenario in each format; else why it cannot be read or run.
fn files_of(
    sources: &Sources,
    source: &Source,
    folders: &[(Format, PathBuf)],
    partners_as: PartnersAs,
) -> Result<Result<Made, String>, PipelineError> {
    let scenario = match read_scenario(&source.path) {
        Ok((scenario, _)) => scenario,
        Err(error) => return Ok(Err(told(&error))),
    };
    let rollout = match sources.rollout(source, &scenario)? {
        Ok(rollout) => rollout,
        Err(why) => return Ok(Err(why)),
    };
    let made = folders.iter().map(|(format, folder)| {
        let options = ExportOptions { partners_as, min_gap_m: sources.min_gap_m, ..ExportOptions::new(*format) };
        let files = recrash_export::export(&scenario, Some(&rollout), &source.parameters, &options);
        let placed = |file: ExportFile| (folder.join(&file.name), file.content);
        let files = files.map(|files| files.into_iter().map(placed).collect()).map_err(|error| error.to_string());
        (*format, files)
    });
    Ok(Ok(made.collect()))
}

fn told(error: &PipelineError) -> String {
    match error {
        PipelineError::BadInput { diagnostics, .. } if !diagnostics.is_empty() => {
            diagnostics.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        }
        _ => error.to_string(),
    }
}
