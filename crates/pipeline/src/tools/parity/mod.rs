//! The same scenarios on both simulators, side by side. Described in `docs/models/parity.md`.

mod open_loop;
mod tables;

pub use open_loop::{OpenLoop, OpenLoopLimit, OpenLoopRequest, open_loop};
pub use recrash_lab::parity::{
    Agreement, Apart, GAP_TOLERANCE_M, Pair, PairOutcome, TIME_TOLERANCE_S, random_scenario, random_scene,
};
pub use tables::ParityTable;

use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::files::store::{Store, write_file_whole};
use crate::profiles::load_profile;
use crate::progress::{Progress, ProgressEvent};
use crate::reading::scenarios::read_scenario;
use crate::suite::Suite;
use crate::suite::names;
use recrash_lab::judge;
use recrash_metadrive::{Drive, Metadrive, MetadriveError};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_model::selection::Selection;
use recrash_report::{PairView, PairsView};
use recrash_roads::Scenario;
use recrash_sim::Ego;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Pairs shown side by side on the page.
const SHOWN: usize = 10;

/// Which scenarios are compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "of")]
pub enum ParitySource {
    /// Random ones: in turn a scenario on the paper's maps with the paper's policies, and a scene on a network of roads whose
    /// road users have plans.
    Random {
        /// How many.
        count: usize,
        /// Seed.
        seed: u64,
    },
    /// Those of a suite, as designed and as tuned.
    Suite {
        /// Its folder.
        #[serde(serialize_with = "crate::files::paths::as_text")]
        dir: PathBuf,
    },
}

/// What to compare, and where to write it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParityRequest {
    /// Scenarios.
    pub source: ParitySource,
    /// Python interpreter with MetaDrive.
    pub python: PathBuf,
    /// MetaDrive workers at once. No byte of the results depends on it.
    pub workers: usize,
    /// Folder for `parity.json`, `parity.csv`, `parity.html` and the scenarios of the worst pairs.
    pub out: PathBuf,
}

/// A share that is asked for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Threshold {
    /// What.
    pub what: &'static str,
    /// Least share, in [0, 1].
    pub wanted: f64,
    /// How many.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// Whether it is reached.
    pub passed: bool,
}

impl Threshold {
    fn new(what: &'static str, wanted: f64, count: usize, of: usize) -> Self {
        Self { what, wanted, count, of, passed: count as f64 >= wanted * of as f64 }
    }
}

/// A scenario that MetaDrive cannot hold.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RefusedScenario {
    /// Its name.
    pub name: String,
    /// Why.
    pub why: String,
}

/// What the comparison says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parity {
    /// Always `recrash.parity/1`.
    pub format: &'static str,
    /// Scenarios.
    pub source: ParitySource,
    /// Both simulators, with their versions.
    pub simulators: [String; 2],
    /// Counts over all pairs.
    pub agreement: Agreement,
    /// What is asked for, and whether it is reached.
    pub thresholds: Vec<Threshold>,
    /// Positions over time.
    pub apart: Vec<Apart>,
    /// Every pair, in the order of the scenarios.
    pub pairs: Vec<Pair>,
    /// Positions in `pairs` of those farthest apart, the worst first.
    pub worst: Vec<usize>,
    /// Scenarios that MetaDrive cannot hold; they are no pairs.
    pub refused: Vec<RefusedScenario>,
}

impl Parity {
    /// Whether every threshold is reached.
    pub fn passed(&self) -> bool {
        self.thresholds.iter().all(|threshold| threshold.passed)
    }
}

/// A scenario with its name among the others.
struct Named {
    name: String,
    scenario: Scenario,
}

/// Runs every scenario on both simulators, compares them with the same metrics, and writes what came of it.
///
/// # Errors
/// Python or MetaDrive is missing, the suite cannot be read or has another ego, or a file cannot be written. A scenario
/// that MetaDrive fails on is no error: it counts as disagreeing.
pub fn parity(request: &ParityRequest, progress: &dyn Progress) -> Result<Parity, PipelineError> {
    let (scenarios, profile) = scenarios(&request.source)?;
    let metadrive = start(&request.python, request.workers)?;
    let store = Store::create(&request.out, write_file_whole)?;
    let native = |named: &Named| {
        judge(&named.scenario, recrash_sim::simulate(&named.scenario, Ego::MetadriveIdm), &profile, None)
    };
    let ours: Vec<JudgedRun> = scenarios.iter().map(native).collect();
    let all = on_metadrive(&metadrive, &scenarios, &profile, progress);
    let (mut held, mut refused) = ((Vec::new(), Vec::new(), Vec::new()), Vec::new());
    for ((named, ours), theirs) in scenarios.into_iter().zip(ours).zip(all) {
        match theirs {
            Err(error) if error.is_refused() => {
                refused.push(RefusedScenario { name: named.name, why: error.to_string() })
            }
            theirs => {
                held.0.push(named);
                held.1.push(ours);
                held.2.push(theirs.map_err(|error| error.to_string()));
            }
        }
    }
    let (scenarios, ours, theirs) = held;
    let pairs = scenarios.iter().zip(ours.iter().zip(&theirs)).map(|(named, (ours, theirs))| {
        let theirs = theirs.as_ref().map_err(Clone::clone);
        Pair::of(named.name.clone(), named.scenario.draft(), ours, theirs)
    });
    let pairs: Vec<Pair> = pairs.collect();
    let agreement = Agreement::of(&pairs);
    let mut worst: Vec<usize> = (0..pairs.len()).collect();
    worst.sort_by(|&a, &b| pairs[b].badness().total_cmp(&pairs[a].badness()));
    worst.truncate(SHOWN);
    let parity = Parity {
        format: "recrash.parity/1",
        source: request.source.clone(),
        simulators: [
            ours.first().map_or_else(String::new, |run| run.rollout.simulator.clone()),
            format!("MetaDrive {} on Python {}", metadrive.versions().1, metadrive.versions().0),
        ],
        agreement,
        thresholds: thresholds(&request.source, &agreement, &refused),
        apart: recrash_lab::parity::compare::apart_over_time(&pairs),
        pairs,
        worst,
        refused,
    };
    store.write("parity.json", &to_json(&parity))?;
    store.write("parity.csv", parity.csv().as_bytes())?;
    store.write(
        "parity.html",
        recrash_report::pairs_html(&page(&parity, &scenarios, &ours, &theirs, &profile)).as_bytes(),
    )?;
    for &position in &parity.worst {
        let named = &scenarios[position];
        store.write(&format!("worst/{}.json", file_name(&named.name)), &to_json(named.scenario.draft()))?;
    }
    Ok(parity)
}

/// MetaDrive, or why there is none.
pub(crate) fn start(python: &Path, workers: usize) -> Result<Metadrive, PipelineError> {
    let options = recrash_metadrive::Options { workers: workers.max(1), ..recrash_metadrive::Options::new(python) };
    Metadrive::start(options).map_err(|error| PipelineError::bad_input(error.to_string()))
}

fn on_metadrive(
    metadrive: &Metadrive,
    scenarios: &[Named],
    profile: &SystemProfile,
    progress: &dyn Progress,
) -> Vec<Result<JudgedRun, MetadriveError>> {
    const STAGE: &str = "parity";
    progress.event(ProgressEvent::Started { stage: STAGE, units: scenarios.len() });
    let checked: Vec<Scenario> = scenarios.iter().map(|named| named.scenario.clone()).collect();
    let done = |_| progress.event(ProgressEvent::Advanced { stage: STAGE, unit: "MetaDrive", skipped: false });
    let rollouts = metadrive.simulate_all(&checked, &Drive::MetadriveIdm, &done);
    progress.event(ProgressEvent::Finished { stage: STAGE });
    let judged = rollouts
        .into_iter()
        .zip(&checked)
        .map(|(rollout, scenario)| rollout.map(|rollout| judge(scenario, rollout, profile, None)));
    judged.collect()
}

/// The scenarios, and the profile whose criteria say what a failure is.
fn scenarios(source: &ParitySource) -> Result<(Vec<Named>, SystemProfile), PipelineError> {
    match source {
        ParitySource::Random { count, seed } => {
            let named = |number| {
                let of = if number % 2 == 0 { random_scenario } else { random_scene };
                let scenario = of(*seed, number / 2);
                Named { name: scenario.draft().id.clone(), scenario }
            };
            Ok(((0..*count).map(named).collect(), load_profile("paper")?))
        }
        ParitySource::Suite { dir } => of_suite(dir),
    }
}

fn of_suite(dir: &Path) -> Result<(Vec<Named>, SystemProfile), PipelineError> {
    let options = if dir.is_dir() { Suite::saved_options(dir)? } else { None };
    let options = options
        .ok_or_else(|| PipelineError::bad_input(format!("{} is not a suite: it holds no suite.json", dir.display())))?;
    let profile = load_profile(&options.profile)?;
    let ego = options.ego.as_ref().unwrap_or(&profile.ego);
    if *ego != Ego::MetadriveIdm.name() {
        return Err(PipelineError::bad_input(format!(
            "the ego of {} is {ego}, which MetaDrive does not have; make the suite again with the ego metadrive-idm",
            dir.display()
        )));
    }
    let store = Store::at(dir);
    if !store.path(names::SELECTION).exists() {
        return Err(PipelineError::MissingStage { dir: dir.to_owned(), missing: "design" });
    }
    let selection: Selection = store.read_json(names::SELECTION)?;
    let mut all = Vec::new();
    for cluster in &selection.clusters {
        for name in [names::scenario(&cluster.scenario_id), names::tuned(&cluster.scenario_id)] {
            // A scenario that was refused has no file; a suite may not be tuned yet.
            if store.path(&name).exists() {
                let scenario = read_scenario(&store.path(&name))?.0;
                all.push(Named { name: name.trim_end_matches(".json").to_owned(), scenario });
            }
        }
    }
    if all.is_empty() {
        return Err(PipelineError::MissingStage { dir: dir.to_owned(), missing: "design" });
    }
    Ok((all, profile))
}

/// What issues 11 and 12 of the project ask for; of a suite, issue 3.
fn thresholds(source: &ParitySource, all: &Agreement, refused: &[RefusedScenario]) -> Vec<Threshold> {
    match source {
        ParitySource::Random { count, .. } => vec![
            Threshold::new("contact on both or on neither", 0.98, all.same_verdict, all.pairs),
            Threshold::new("least gap within 0.5 m", 0.96, all.same_gap, all.pairs),
            Threshold::new("its time within 0.3 s", 0.90, all.same_time, all.pairs),
            // Nothing on the paper's maps is refused: every other one is a scene.
            Threshold::new(
                "scenes that MetaDrive can hold",
                0.75,
                (count / 2).saturating_sub(refused.len()),
                count / 2,
            ),
        ],
        ParitySource::Suite { .. } => {
            vec![Threshold::new("native failures that fail on MetaDrive too", 0.90, all.confirmed, all.failed_natively)]
        }
    }
}

/// A name fit for a file: scenario ids are, apart from the folder of a suite's.
fn file_name(name: &str) -> String {
    name.replace(['/', '\\'], "-")
}

fn page(
    parity: &Parity,
    scenarios: &[Named],
    ours: &[JudgedRun],
    theirs: &[Result<JudgedRun, String>],
    profile: &SystemProfile,
) -> PairsView {
    let pairs = parity.worst.iter().map(|&position| {
        let (pair, named) = (&parity.pairs[position], &scenarios[position]);
        PairView {
            title: pair.name.clone(),
            remark: pair.remark(),
            drawing: named.scenario.drawing(),
            first: view(&ours[position]),
            second: theirs[position].as_ref().ok().map(view),
        }
    });
    PairsView {
        title: "Parity of the simulators".to_owned(),
        generated_by: format!("recrash {}", env!("CARGO_PKG_VERSION")),
        command: parity.command(),
        names: ["native".to_owned(), "MetaDrive".to_owned()],
        criteria: profile.failure.clone(),
        tables: parity.tables().into_iter().map(Into::into).collect(),
        pairs: pairs.collect(),
        more: None,
    }
}

fn view(run: &JudgedRun) -> recrash_report::RunTrace {
    recrash_report::RunTrace { run: run.clone(), series: recrash_metrics::series(&run.rollout) }
}
