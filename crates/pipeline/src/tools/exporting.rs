//! Exports of a suite or of one scenario file.

use crate::error::{Choice, PipelineError};
use crate::files::output::Outputs;
use crate::files::paths;
use crate::files::store::{Store, io};
use crate::profiles::{DEFAULT_PROFILE, load_profile};
use crate::reading::scenarios::read_scenario;
use crate::simulators::external::Patience;
use crate::simulators::{SimulatorKind, start_simulator};
use crate::suite::names;
use crate::suite::{Suite, refuse_untrusted};
use recrash_export::{ExportFile, ExportOptions, Format, PartnersAs};
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_model::selection::Selection;
use recrash_model::tuning::{Parameter, TuneLog};
use recrash_roads::Simulator;
use recrash_sim::Ego;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What to export, and where to.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRequest {
    /// A suite's folder, or a scenario file.
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
    /// Whether a program that only the suite names is started as the ego.
    pub trust: bool,
}

/// What was exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExportReport {
    /// Scenarios that were exported.
    pub scenarios: usize,
    /// Files written, in order.
    #[serde(serialize_with = "paths::as_texts")]
    pub files: Vec<PathBuf>,
    /// Scenarios that could not be exported, each with its reason.
    pub failures: Vec<Diagnostic>,
}

/// Exports every scenario that can be; one that cannot is named, and the rest goes on. Files that an earlier export of the
/// same scenarios has written stay, so that one that was interrupted goes on.
///
/// # Errors
/// The source is no suite and no file, or the target holds other files already; then nothing is written.
pub fn export(request: &ExportRequest) -> Result<ExportReport, PipelineError> {
    let sources = sources(&request.source, request.designed, request.trust)?;
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
    let formats: Vec<Format> = folders.iter().map(|(format, _)| *format).collect();
    let exported = |source: &ScenarioSource| files_of(source, &formats, request.partners_as);
    let mut filled = Vec::new();
    for (at, (_, folder)) in folders.iter().enumerate() {
        if folder.is_dir() {
            Store::at(folder).remove_leftovers()?;
        }
        if !request.force && std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
            filled.push((at, folder.as_path()));
        }
    }
    if !filled.is_empty() {
        let all = sources.iter().filter_map(|source| exported(source).ok());
        only_of_this_export(&filled, all)?;
    }
    let mut outputs = Outputs::of_inputs(sources.iter().map(|source| source.path.clone()));
    let mut report = ExportReport { scenarios: 0, files: Vec::new(), failures: Vec::new() };
    let mut written = BTreeSet::new();
    for source in &sources {
        match exported(source) {
            Ok(per_format) => {
                report.scenarios += 1;
                let in_folder = |((_, folder), files): (&(Format, PathBuf), Vec<ExportFile>)| {
                    files.into_iter().map(|file| (folder.join(&file.name), file.content)).collect::<Vec<_>>()
                };
                let files = folders.iter().zip(per_format).flat_map(in_folder);
                // MetaDrive's script is the same for all.
                let new = files.filter(|(path, _)| written.insert(path.clone()));
                let claimed = new.map(|(path, content)| Ok((outputs.claim(&path)?, content)));
                for (output, content) in claimed.collect::<Result<Vec<_>, PipelineError>>()? {
                    let folder = parent(output.name());
                    std::fs::create_dir_all(&folder).map_err(|source| io("create", &folder, source))?;
                    output.write(&content)?;
                    report.files.push(output.name().to_owned());
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

/// Whether folders hold nothing but what this export writes, as it writes it: then an earlier one was interrupted, or is
/// done again.
///
/// # Errors
/// There is something else in a folder.
fn only_of_this_export(
    filled: &[(usize, &Path)],
    exports: impl Iterator<Item = Vec<Vec<ExportFile>>>,
) -> Result<(), PipelineError> {
    let mut ours: BTreeSet<PathBuf> = BTreeSet::new();
    for files in exports {
        for &(at, folder) in filled {
            let paths = files[at].iter().map(|file| (folder.join(&file.name), &file.content));
            ours.extend(paths.filter(|(path, content)| has_content(path, content)).map(|(path, _)| path));
        }
    }
    for (_, folder) in filled {
        let entries = std::fs::read_dir(folder).map_err(|source| io("read", folder, source))?;
        if entries.flatten().any(|entry| !ours.contains(&entry.path())) {
            return Err(PipelineError::choose(
                format!("{} holds other files already", folder.display()),
                Choice::ExportFolder,
            ));
        }
    }
    Ok(())
}

/// Whether a regular file holds exactly this.
fn has_content(path: &Path, content: &[u8]) -> bool {
    let size = std::fs::symlink_metadata(path).ok().filter(|there| there.is_file()).map(|there| there.len());
    size == Some(content.len() as u64) && std::fs::read(path).is_ok_and(|there| there == content)
}

struct ScenarioSource {
    path: PathBuf,
    parameters: Vec<Parameter>,
    ego: String,
    /// What the profile calls too near. [m]
    min_gap_m: f64,
}

fn parent(file: &Path) -> PathBuf {
    file.parent().map_or_else(PathBuf::new, Path::to_owned)
}

fn sources(source: &Path, designed: bool, trust: bool) -> Result<Vec<ScenarioSource>, PipelineError> {
    let Some(options) = source.is_dir().then(|| Suite::saved_options(source)).transpose()? else {
        let profile = load_profile(DEFAULT_PROFILE)?;
        let (ego, min_gap_m) = (profile.ego, profile.failure.min_gap_m);
        return Ok(vec![ScenarioSource { path: source.to_owned(), parameters: Vec::new(), ego, min_gap_m }]);
    };
    let options = options.ok_or_else(|| {
        PipelineError::bad_input(format!("{} is not a suite: it holds no suite.json", source.display()))
    })?;
    let profile = options.system_profile()?;
    let ego = options.ego.unwrap_or(profile.ego);
    refuse_untrusted(&ego, trust)?;
    let store = Store::at(source);
    let selection: Selection = store.read_json(names::SELECTION)?;
    let of = |id: &str| {
        // A damaged log costs the ranges, not the scenario.
        let log: Option<TuneLog> = store.read_json(&names::tune_log(id)).ok();
        let parameters = log.map_or_else(Vec::new, |log| log.parameters);
        let name = if designed { names::scenario(id) } else { names::tuned(id) };
        ScenarioSource { path: store.path(&name), parameters, ego: ego.clone(), min_gap_m: profile.failure.min_gap_m }
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
    // The crash as it is told, where it is: so another tool shows it too.
    let ego = if scenario.recorded().is_some() { Ego::Recorded.name() } else { &source.ego };
    let native = start_simulator(SimulatorKind::Native, ego, Path::new(""), 1, Patience::default()).map_err(told)?;
    let rollout = native.run(&scenario).map_err(|error| told(error.into()))?;
    let files = formats.iter().map(|&format| {
        let options = ExportOptions { partners_as, min_gap_m: source.min_gap_m, ..ExportOptions::new(format) };
        recrash_export::export(&scenario, Some(&rollout), &source.parameters, &options).map_err(|e| e.to_string())
    });
    files.collect()
}
