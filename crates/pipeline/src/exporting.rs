//! Exports of a suite or of one scenario file.

use crate::error::PipelineError;
use crate::external::Patience;
use crate::judging::run_scenario;
use crate::profiles::load_profile;
use crate::scenario_files::read_scenario;
use crate::simulator::{SimulatorKind, start_simulator};
use crate::stages::names;
use crate::store::{Store, write_file_whole};
use crate::suite::{Suite, refuse_untrusted};
use recrash_export::{ExportFile, ExportOptions, Format, PartnersAs};
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_model::selection::Selection;
use recrash_model::tuning::{Parameter, TuneLog};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What to export, and where to.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRequest {
    /// A suite's folder, or a scenario file.
    pub source: PathBuf,
    /// Formats.
    pub formats: Vec<Format>,
    /// How partners move.
    pub partners_as: PartnersAs,
    /// Target folder; each format gets a folder in it. Where not given: `exports` in the suite, or beside the file.
    pub target: Option<PathBuf>,
    /// Whether files that are there already may be overwritten.
    pub force: bool,
    /// Whether a program that only the suite names is started as the ego.
    pub trust: bool,
}

/// What was exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExportReport {
    /// Scenarios that were exported.
    pub scenarios: usize,
    /// Files written, in order.
    pub files: Vec<PathBuf>,
    /// Scenarios that could not be exported, each with its reason.
    pub failures: Vec<Diagnostic>,
}

/// Exports every scenario that can be; one that cannot is named, and the rest goes on.
///
/// # Errors
/// The source is no suite and no file, or the target holds files already; then nothing is written.
pub fn export(request: &ExportRequest) -> Result<ExportReport, PipelineError> {
    let sources = sources(&request.source, request.trust)?;
    let beside = if request.source.is_dir() { request.source.clone() } else { parent(&request.source) };
    let target = request.target.clone().unwrap_or_else(|| beside.join("exports"));
    let folders: Vec<(Format, PathBuf)> =
        request.formats.iter().map(|&format| (format, target.join(format.name()))).collect();
    for (_, folder) in &folders {
        if folder.is_dir() {
            Store::at(folder).remove_leftovers()?;
        }
        if !request.force && std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
            return Err(PipelineError::bad_input(format!(
                "{} holds files already; add --force to overwrite them, or choose another --to-dir",
                folder.display()
            )));
        }
    }
    let mut report = ExportReport { scenarios: 0, files: Vec::new(), failures: Vec::new() };
    for source in &sources {
        match files_of(source, &request.formats, request.partners_as) {
            Ok(per_format) => {
                report.scenarios += 1;
                for ((_, folder), files) in folders.iter().zip(per_format) {
                    let store = Store::create(folder, write_file_whole)?;
                    for file in files {
                        store.write(&file.name, &file.content)?;
                        let path = folder.join(&file.name);
                        // MetaDrive's script is the same for all.
                        if !report.files.contains(&path) {
                            report.files.push(path);
                        }
                    }
                }
            }
            Err(why) => report.failures.push(Diagnostic::new(
                Severity::Error,
                "export.failed",
                Location { file: Some(source.path.display().to_string()), ..Location::default() },
                format!("not exported: {why}"),
            )),
        }
    }
    Ok(report)
}

struct ScenarioSource {
    path: PathBuf,
    parameters: Vec<Parameter>,
    ego: String,
}

fn parent(file: &Path) -> PathBuf {
    file.parent().map_or_else(PathBuf::new, Path::to_owned)
}

fn sources(source: &Path, trust: bool) -> Result<Vec<ScenarioSource>, PipelineError> {
    let Some(options) = source.is_dir().then(|| Suite::saved_options(source)).transpose()? else {
        let ego = load_profile("paper")?.ego;
        return Ok(vec![ScenarioSource { path: source.to_owned(), parameters: Vec::new(), ego }]);
    };
    let options = options.ok_or_else(|| {
        PipelineError::bad_input(format!("{} is not a suite: it holds no suite.json", source.display()))
    })?;
    let ego = options.ego.clone().map_or_else(|| load_profile(&options.profile).map(|p| p.ego), Ok)?;
    refuse_untrusted(&ego, trust)?;
    let store = Store::at(source);
    let selection: Selection = store.read_json(names::SELECTION)?;
    let of = |id: &str| {
        // A damaged log costs the ranges, not the scenario.
        let log: Option<TuneLog> = store.read_json(&names::tune_log(id)).ok();
        let parameters = log.map_or_else(Vec::new, |log| log.parameters);
        ScenarioSource { path: store.path(&names::tuned(id)), parameters, ego: ego.clone() }
    };
    Ok(selection.clusters.iter().map(|cluster| of(&cluster.scenario_id)).collect())
}

/// The files of one scenario in each format.
fn files_of(
    source: &ScenarioSource,
    formats: &[Format],
    partners_as: PartnersAs,
) -> Result<Vec<Vec<ExportFile>>, String> {
    let told = |error: PipelineError| match &error {
        PipelineError::BadInput { diagnostics, .. } if !diagnostics.is_empty() => {
            diagnostics.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        }
        _ => error.to_string(),
    };
    let (scenario, _) = read_scenario(&source.path).map_err(told)?;
    let profile = load_profile("paper").map_err(told)?;
    let native =
        start_simulator(SimulatorKind::Native, &source.ego, Path::new(""), 1, Patience::default()).map_err(told)?;
    let rollout = run_scenario(&scenario, &native, &profile, None).map_err(told)?.rollout;
    let files = formats.iter().map(|&format| {
        let options = ExportOptions { partners_as, ..ExportOptions::new(format) };
        recrash_export::export(&scenario, Some(&rollout), &source.parameters, &options).map_err(|e| e.to_string())
    });
    files.collect()
}
