//! Scenarios of other formats read back: our OpenSCENARIO, and the paper's JSON dialect.

use crate::error::{Choice, PipelineError};
use crate::files::output::Outputs;
use crate::files::paths;
use crate::files::store::read_text;
use crate::reading::scenarios::{not_runnable, scenario_from};
use recrash_export::MAX_IMPORT_BYTES;
use recrash_model::diagnostic::Diagnostic;
use recrash_model::scenario::ScenarioDraft;
use recrash_roads::write_draft;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What to import, and where to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImportRequest<'a> {
    /// OpenSCENARIO XML that recrash wrote, or a scenario in JSON: recrash's own or the paper's dialect.
    pub source: &'a Path,
    /// Scenario file to write. Where not given: the scenario's id with `.json`, in the current folder.
    pub target: Option<&'a Path>,
    /// Whether a file that is there already may be overwritten.
    pub force: bool,
}

/// An imported scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Imported {
    /// The scenario file that was written.
    #[serde(serialize_with = "paths::as_text")]
    pub file: PathBuf,
    /// What the source was read as.
    pub read_as: SourceFormat,
    /// The scenario.
    pub scenario: ScenarioDraft,
    /// Remarks on the source, with their places in it.
    pub diagnostics: Vec<Diagnostic>,
}

/// What a source was read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SourceFormat {
    /// OpenSCENARIO XML.
    OpenScenario,
    /// A scenario in JSON.
    Json,
}

/// Reads a scenario, checks it and writes it as a scenario file. What begins with `<` is read as XML.
///
/// # Errors
/// The source cannot be read or is no scenario that can be run: every problem with its place. Or the target is there
/// already, or cannot be written.
pub fn import(request: &ImportRequest) -> Result<Imported, PipelineError> {
    let source = request.source;
    let text = read_text(source, MAX_IMPORT_BYTES as u64)?;
    let is_xml = text.trim_start_matches('\u{feff}').trim_start().starts_with('<');
    let (read_as, read) = if is_xml {
        (SourceFormat::OpenScenario, recrash_export::import(&text))
    } else {
        (SourceFormat::Json, scenario_from(&text))
    };
    let read = read.map_err(|diagnostics| not_runnable(source, diagnostics))?;
    let scenario = read.value.draft().clone();
    let file = request.target.map_or_else(|| PathBuf::from(format!("{}.json", scenario.id)), Path::to_owned);
    let output = Outputs::of_inputs([source.to_owned()]).claim(&file)?;
    if !request.force && output.replaces() {
        return Err(PipelineError::choose(format!("{} is there already", file.display()), Choice::ImportFile));
    }
    output.write(write_draft(&scenario).as_bytes())?;
    Ok(Imported { file, read_as, scenario, diagnostics: read.diagnostics })
}
