//! What is exported: the scenarios of a suite, of a folder, or one file; and a run of each.

use crate::error::PipelineError;
use crate::files::store::{Store, io, read_text};
use crate::profiles::{DEFAULT_PROFILE, load_profile};
use crate::simulators::external::Patience;
use crate::simulators::{SimulatorKind, start_simulator};
use crate::stages::{Cases, case_inputs, case_stages, unit_name};
use crate::suite::{Stage, Suite, Work, names, refuse_untrusted};
use recrash_model::rollout::Rollout;
use recrash_model::run::JudgedRun;
use recrash_model::selection::{Cluster, Selection};
use recrash_model::tuning::{Parameter, TuneLog};
use recrash_roads::{Scenario, Simulator};
use recrash_sim::{Ego, Native};
use serde::Deserialize;
use std::cell::OnceCell;
use std::path::{Path, PathBuf};

/// Largest scenario file that is looked at in a folder. [bytes]
const MAX_FILE: u64 = 64 << 20;

/// A scenario that is exported.
pub(super) struct Source {
    pub path: PathBuf,
    /// What the search of a suite might move.
    pub parameters: Vec<Parameter>,
    /// In a suite: which scenario it is.
    id: Option<String>,
}

/// What is exported, and who drives in it.
pub(super) struct Sources {
    pub scenarios: Vec<Source>,
    /// What the profile calls too near. [m]
    pub min_gap_m: f64,
    driver: Driver,
}

/// The system under test of the scenarios that have no recorded driver. It is started for the first that has no run on the disk, and
/// drives in all of them.
struct Driver {
    kind: SimulatorKind,
    ego: String,
    python: PathBuf,
    trust: bool,
    kept: Option<KeptRuns>,
    started: OnceCell<Result<Box<dyn Simulator>, String>>,
}

/// Runs of a suite that are on the disk.
struct KeptRuns {
    suite: Suite,
    cases: Cases,
    stage: Stage,
    file: fn(&str) -> String,
}

impl Sources {
    /// The scenarios of a suite as tuned, or as designed; those of a folder of scenario files; or the one of a file.
    ///
    /// # Errors
    /// The folder holds neither, or a file of the suite cannot be read.
    pub fn read(source: &Path, designed: bool, python: &Path, trust: bool) -> Result<Self, PipelineError> {
        let saved = source.is_dir().then(|| Suite::saved_options(source)).transpose()?.flatten();
        let Some(options) = saved else {
            let files = if source.is_dir() { scenario_files(source)? } else { vec![source.to_owned()] };
            let profile = load_profile(DEFAULT_PROFILE)?;
            let alone = |path| Source { path, parameters: Vec::new(), id: None };
            let driver = Driver::new(SimulatorKind::Native, profile.ego, python, true, None);
            let scenarios = files.into_iter().map(alone).collect();
            return Ok(Self { scenarios, min_gap_m: profile.failure.min_gap_m, driver });
        };
        let profile = options.system_profile()?;
        let ego = options.ego.clone().unwrap_or(profile.ego);
        let store = Store::at(source);
        let selection: Selection = store.read_json(names::SELECTION)?;
        let of = |cluster: &Cluster| {
            let id = &cluster.scenario_id;
            // A damaged log costs the ranges, not the scenario.
            let log: Option<TuneLog> = store.read_json(&names::tune_log(id)).ok();
            let parameters = log.map_or_else(Vec::new, |log| log.parameters);
            let name = if designed { names::scenario(id) } else { names::tuned(id) };
            Source { path: store.path(&name), parameters, id: Some(id.clone()) }
        };
        let kept = KeptRuns::of(source, designed);
        let driver = Driver::new(options.simulator, ego, python, trust, kept);
        let scenarios = selection.clusters.iter().map(of).collect();
        Ok(Self { scenarios, min_gap_m: profile.failure.min_gap_m, driver })
    }

    /// What happens in a scenario: the crash as it is told, where it is, so that another tool shows it too; else what the system under
    /// test drives.
    ///
    /// # Errors
    /// It cannot be run; or its driver is a program that only the suite names, which ends it all.
    pub fn rollout(&self, source: &Source, scenario: &Scenario) -> Result<Result<Rollout, String>, PipelineError> {
        if scenario.recorded().is_some() {
            return Ok(Native::new(Ego::Recorded).run(scenario).map_err(|error| error.to_string()));
        }
        let kept = self.driver.kept.as_ref().zip(source.id.as_deref());
        if let Some(rollout) = kept.and_then(|(kept, id)| kept.rollout(id)) {
            return Ok(Ok(rollout));
        }
        let simulator = match self.driver.simulator()? {
            Ok(simulator) => simulator,
            Err(why) => return Ok(Err(why.clone())),
        };
        Ok(simulator.run(scenario).map_err(|error| error.to_string()))
    }
}

impl Driver {
    fn new(kind: SimulatorKind, ego: String, python: &Path, trust: bool, kept: Option<KeptRuns>) -> Self {
        Self { kind, ego, python: python.to_owned(), trust, kept, started: OnceCell::new() }
    }

    fn simulator(&self) -> Result<&Result<Box<dyn Simulator>, String>, PipelineError> {
        refuse_untrusted(&self.ego, self.trust)?;
        Ok(self.started.get_or_init(|| {
            let started = start_simulator(self.kind, &self.ego, &self.python, 1, Patience::default());
            started.map_err(|error| error.to_string())
        }))
    }
}

impl KeptRuns {
    /// Nothing where the suite is not far enough.
    fn of(folder: &Path, designed: bool) -> Option<Self> {
        let suite = Suite::look(folder).ok()?;
        let cases = Cases::read(&suite).ok()?;
        let (stage, file): (_, fn(&str) -> String) =
            if designed { (Stage::Simulate, names::first_run) } else { (Stage::Triage, names::tuned_run) };
        Some(Self { suite, cases, stage, file })
    }

    /// The run of a scenario, where it is of the scenario and of the ego as they are now.
    fn rollout(&self, id: &str) -> Option<Rollout> {
        let cluster = self.cases.selection.clusters.iter().find(|cluster| cluster.scenario_id == id)?;
        let declared = case_stages(&self.suite).into_iter().find(|declared| declared.stage == self.stage)?;
        let inputs = case_inputs(&self.suite, &declared, &self.cases, cluster).ok()?;
        let (name, editable) = (unit_name(self.stage, id), (declared.editable)(id));
        self.suite.must_be_current(self.stage, &Work { name: &name, inputs: &inputs, editable: &editable }).ok()?;
        let run: JudgedRun = self.suite.store().read_json(&(self.file)(id)).ok()?;
        Some(run.rollout)
    }
}

/// The scenario files of a folder, such as `recrash reconstruct` writes them.
fn scenario_files(folder: &Path) -> Result<Vec<PathBuf>, PipelineError> {
    #[derive(Deserialize)]
    struct Head {
        format: String,
    }
    let entries = std::fs::read_dir(folder).map_err(|source| io("read", folder, source))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    files.retain(|file| {
        let head = read_text(file, MAX_FILE).ok().and_then(|text| serde_json::from_str::<Head>(&text).ok());
        head.is_some_and(|head| head.format.starts_with("recrash.scenario/"))
    });
    if files.is_empty() {
        return Err(PipelineError::bad_input(format!(
            "{} is not a suite: it holds no suite.json, and no scenario file (*.json) either",
            folder.display()
        )));
    }
    Ok(files)
}
