//! Scenario files: read and checked; and one file run on its own.

use crate::error::PipelineError;
use crate::files::json::to_compact_json;
use crate::files::output::Outputs;
use crate::files::store::read_text;
use crate::profiles::load_profile;
use crate::reading::named;
use crate::simulators::external::Patience;
use crate::simulators::{SimulatorKind, start_simulator};
use recrash_lab::{replay, run_scenario};
use recrash_model::diagnostic::{Location, Severity};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::NOTHING_TO_TEST;
use recrash_model::{Diagnostic, Outcome};
use recrash_roads::{MAX_SCENARIO_BYTES, Scenario};
use recrash_sim::Ego;
use std::path::Path;

/// One scenario file, run.
#[derive(Debug, Clone, PartialEq)]
pub struct FileRun {
    /// The run.
    pub run: JudgedRun,
    /// What it shows, in words.
    pub words: String,
    /// Remarks on the file.
    pub diagnostics: Vec<Diagnostic>,
}

/// How one scenario file is run.
#[derive(Debug, Clone, PartialEq)]
pub struct FileRequest<'a> {
    /// The file.
    pub scenario: &'a Path,
    /// Profile with the failure criteria, and the ego where none is named.
    pub profile: &'a str,
    /// Ego.
    pub ego: Option<&'a str>,
    /// Simulator.
    pub simulator: SimulatorKind,
    /// Python interpreter for MetaDrive.
    pub python: &'a Path,
    /// How long answers of an external ego are waited for.
    pub patience: Patience,
    /// Where to write the rollout.
    pub rollout: Option<&'a Path>,
    /// Where to draw the scenario and its run.
    pub picture: Option<&'a Path>,
}

/// Reads, checks and runs one scenario file.
///
/// # Errors
/// The file cannot be read, is no scenario, or cannot be run: every problem with its place.
pub fn simulate_file(request: &FileRequest) -> Result<FileRun, PipelineError> {
    let read = named::of_profile_and_ego(Some(request.profile), request.ego).into_iter();
    let mut outputs = Outputs::of_inputs(read.chain([request.scenario.to_owned()]));
    let rollout = request.rollout.map(|target| outputs.claim(target)).transpose()?;
    let picture = request.picture.map(|target| outputs.claim(target)).transpose()?;
    let profile = load_profile(request.profile)?;
    let (scenario, mut diagnostics) = read_scenario(request.scenario)?;
    let ego = request.ego.unwrap_or(&profile.ego);
    let simulator = start_simulator(request.simulator, ego, request.python, 1, request.patience)?;
    let run = run_scenario(&scenario, &simulator, &profile, None)?;
    if !scenario.draft().is_tested() && ego != Ego::Recorded.name() {
        let message = format!("{NOTHING_TO_TEST}: the recorded driver drives, and not {ego}");
        diagnostics.push(Diagnostic::new(Severity::Note, "scenario.parked", Location::default(), message));
    }
    if let Some(rollout) = rollout {
        rollout.write(&to_compact_json(&run.rollout))?;
    }
    if let Some(picture) = picture {
        picture.write(recrash_report::picture(&scenario, &run.rollout).as_bytes())?;
    }
    let words = replay::in_words(scenario.draft(), &run.rollout);
    Ok(FileRun { run, words, diagnostics })
}

/// Reads and checks a scenario file.
///
/// # Errors
/// As [`simulate_file`].
pub fn read_scenario(path: &Path) -> Result<(Scenario, Vec<Diagnostic>), PipelineError> {
    let text = read_text(path, MAX_SCENARIO_BYTES as u64)?;
    match scenario_from(&text) {
        Ok(read) => Ok((read.value, read.diagnostics)),
        Err(diagnostics) => Err(not_runnable(path, diagnostics)),
    }
}

/// Reads and checks the JSON of a scenario that stands in no file.
///
/// # Errors
/// It is no scenario: every problem with its place.
pub fn parse_scenario(json: &str) -> Result<(Scenario, Vec<Diagnostic>), PipelineError> {
    match scenario_from(json) {
        Ok(read) => Ok((read.value, read.diagnostics)),
        Err(diagnostics) => {
            Err(PipelineError::BadInput { what: "this is not a scenario that can be run".to_owned(), diagnostics })
        }
    }
}

/// Reads and checks a scenario's JSON: recrash's own, or the paper's dialect.
pub(crate) fn scenario_from(json: &str) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    let draft = recrash_roads::read_draft(json)?;
    let with_lines = |mut list: Vec<Diagnostic>| {
        recrash_roads::add_lines(json, &mut list);
        list
    };
    let mut checked = recrash_roads::check(draft.value).map_err(with_lines)?;
    checked.diagnostics = draft.diagnostics.into_iter().chain(with_lines(checked.diagnostics)).collect();
    Ok(checked)
}

pub(crate) fn not_runnable(path: &Path, diagnostics: Vec<Diagnostic>) -> PipelineError {
    PipelineError::BadInput { what: format!("{} is not a scenario that can be run", path.display()), diagnostics }
}
