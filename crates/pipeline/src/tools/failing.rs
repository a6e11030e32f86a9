//! Failures of a frozen suite, looked at closer: how robust each is, and what it needs. Described in `docs/models/robustness.md`
//! and `docs/models/minimal.md`.

use crate::error::PipelineError;
use crate::files::folders::{must_be_absent_or_same, must_be_free};
use crate::files::json::to_json;
use crate::files::output::Outputs;
use crate::files::store::{Store, write_suite_file};
use crate::progress::{Progress, ProgressEvent};
use crate::simulators::{SimulatorKind, start_simulator};
use crate::tools::freezing::Opened;
use crate::tools::testing::{Bench, TestRequest};
use rayon::prelude::*;
use recrash_lab::minimal::{Needed, minimal};
use recrash_lab::robustness::{Robustness, robustness};
use recrash_lab::run_scenario;
use recrash_model::Seed;
use recrash_model::account::CrashType;
use recrash_model::cause::Cause;
use recrash_model::frozen::FrozenTest;
use recrash_model::metrics::FindingKind;
use recrash_model::scenario::ScenarioDraft;
use recrash_roads::{Scenario, Simulator};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Failures to look at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FailureRequest {
    /// The suite, the ego and where it drives; where to write is this request's own.
    pub test: TestRequest,
    /// Only these tests; all where none is named.
    pub only: Vec<String>,
}

/// How robust the failures of a frozen suite are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobustnessReport {
    /// Always `recrash.robustness/1`.
    pub format: &'static str,
    /// Name of the frozen suite by its content.
    pub suite: String,
    /// Ego.
    pub ego: String,
    /// Simulator and its version.
    pub simulator: String,
    /// The second simulator, where failures were to be confirmed.
    pub confirmed_by: Option<String>,
    /// Random changes of each failure.
    pub tries: u32,
    /// Seed of them.
    pub seed: u64,
    /// Tests that were run.
    pub tests: usize,
    /// Failures, by id.
    pub failures: Vec<RobustnessOf>,
}

/// How robust one failure is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobustnessOf {
    /// The test.
    pub id: String,
    /// Its crash type, where it is known.
    pub crash_type: Option<CrashType>,
    /// Kinds of its findings, failures first.
    pub findings: Vec<FindingKind>,
    /// What led to it.
    pub cause: Option<Cause>,
    /// Share of the small changes that still fail.
    pub share: f64,
    /// Whether it lives on less than 5 cm or 0.1 s.
    pub marginal: bool,
    /// Whether another physics step undoes it.
    pub step_artefact: bool,
    /// Whether more than 80 % of the changes still fail.
    pub robust: bool,
    /// The counts.
    pub robustness: Robustness,
    /// Whether the second simulator fails as well; absent where it was not asked, or could not run it.
    pub confirmed: Option<bool>,
}

/// What the failures of a frozen suite need.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MinimalReport {
    /// Always `recrash.minimal/1`.
    pub format: &'static str,
    /// Name of the frozen suite by its content.
    pub suite: String,
    /// Ego.
    pub ego: String,
    /// Failures, by id.
    pub failures: Vec<MinimalOf>,
}

/// What one failure needs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MinimalOf {
    /// The test.
    pub id: String,
    /// File of the stripped scenario, from the folder.
    pub scenario: String,
    /// What it fails by, stripped: the gravest as at first, others may have gone or come.
    pub findings: Vec<FindingKind>,
    /// File of the nearest scenario that passes.
    pub twin: Option<String>,
    /// How that differs.
    pub difference: Option<String>,
    /// What was taken away or set back.
    pub taken: Vec<String>,
    /// What is left; without any one of these the failure is gone.
    pub needed: Vec<Needed>,
}

/// A test that fails.
struct Failing<'a> {
    test: &'a FrozenTest,
    scenario: &'a Scenario,
    findings: Vec<FindingKind>,
    cause: Option<Cause>,
}

/// Runs every wanted test once, and gives those that fail.
fn failing<'a>(bench: &'a Bench, only: &[String]) -> Result<Vec<Failing<'a>>, PipelineError> {
    let known = |id: &&String| bench.opened.suite.tests.iter().any(|test| test.id == **id);
    if let Some(unknown) = only.iter().find(|id| !known(id)) {
        return Err(PipelineError::bad_input(format!("the suite has no test {unknown}")));
    }
    let fails = |(test, scenario): (&'a FrozenTest, &'a Scenario)| {
        if !only.is_empty() && !only.contains(&test.id) {
            return None;
        }
        let run = match run_scenario(scenario, &bench.simulator, bench.profile(), None) {
            Ok(run) => run,
            Err(error) => return Some(Err(PipelineError::not_run(&error))),
        };
        run.failed().then(|| Ok(Failing { test, scenario, findings: run.finding_kinds(), cause: run.cause }))
    };
    bench.threads.install(|| bench.tests().filter_map(fails).collect())
}

/// Works on each failure, on all threads, in the order of the tests.
fn on_each<T: Send>(
    bench: &Bench,
    failing: &[Failing],
    stage: &'static str,
    progress: &dyn Progress,
    work: impl Fn(&Failing) -> Result<T, PipelineError> + Sync,
) -> Result<Vec<T>, PipelineError> {
    progress.event(ProgressEvent::Started { stage, units: failing.len() });
    let done = bench.threads.install(|| {
        let one = |each: &Failing| {
            let result = work(each);
            progress.event(ProgressEvent::Advanced { stage, unit: &each.test.id, skipped: false });
            result
        };
        failing.par_iter().map(one).collect()
    });
    progress.event(ProgressEvent::Finished { stage });
    done
}

/// Tells how robust each failure is.
///
/// # Errors
/// The suite cannot be opened, an ego or a simulator fails, or the file cannot be written.
pub fn robustness_of_failures(
    request: &FailureRequest,
    tries: u32,
    seed: u64,
    confirm: bool,
    progress: &dyn Progress,
) -> Result<RobustnessReport, PipelineError> {
    let mut outputs = Outputs::of_inputs([request.test.frozen.clone()]);
    let output = request.test.out.as_ref().map(|out| outputs.claim(out)?.in_a_folder()).transpose()?;
    let bench = Bench::set_up(&request.test)?;
    let second = confirm.then(|| second_simulator(&bench, &request.test)).transpose()?;
    let failing = failing(&bench, &request.only)?;
    let of = |each: &Failing| -> Result<RobustnessOf, PipelineError> {
        let draft = each.scenario.draft();
        let found = robustness(draft, &bench.simulator, bench.profile(), tries, Seed(seed))?;
        let again = |other: &dyn Simulator| run_scenario(each.scenario, other, bench.profile(), None).ok();
        Ok(RobustnessOf {
            id: each.test.id.clone(),
            crash_type: each.test.about.crash_type,
            findings: each.findings.clone(),
            cause: each.cause,
            share: found.share(),
            marginal: found.is_marginal(),
            step_artefact: found.is_step_artefact(),
            robust: found.is_robust(),
            robustness: found,
            confirmed: second.as_deref().and_then(again).map(|run| run.failed()),
        })
    };
    let failures = on_each(&bench, &failing, "robustness", progress, of)?;
    let version = |simulator: &dyn Simulator| format!("{} {}", simulator.name(), simulator.version());
    let report = RobustnessReport {
        format: "recrash.robustness/1",
        suite: bench.opened.suite.content.clone(),
        ego: bench.simulator.ego().to_owned(),
        simulator: version(&*bench.simulator),
        confirmed_by: second.as_deref().map(version),
        tries,
        seed,
        tests: bench.opened.scenarios.len(),
        failures,
    };
    if let Some(output) = output {
        output.write(&to_json(&report))?;
    }
    Ok(report)
}

/// MetaDrive with the same ego, for the native simulator.
fn second_simulator(bench: &Bench, request: &TestRequest) -> Result<Box<dyn Simulator>, PipelineError> {
    let workers = bench.threads.current_num_threads();
    start_simulator(SimulatorKind::Metadrive, bench.simulator.ego(), &request.python, workers, request.patience)
}

/// Strips each failure to what it needs, and writes it with its twin. `record` is a frozen suite of the same tests as their records
/// tell them: numbers go back to it.
///
/// # Errors
/// The suite cannot be opened, an ego or a simulator fails, or a file cannot be written.
pub fn minimal_failures(
    request: &FailureRequest,
    record: Option<&Path>,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<MinimalReport, PipelineError> {
    let bench = Bench::set_up(&request.test)?;
    let told = record.map(Opened::read).transpose()?;
    let told: BTreeMap<&str, &ScenarioDraft> = told
        .iter()
        .flat_map(|suite| &suite.scenarios)
        .map(|scenario| (scenario.draft().id.as_str(), scenario.draft()))
        .collect();
    if record.is_some() && !bench.opened.suite.tests.iter().any(|test| told.contains_key(test.id.as_str())) {
        return Err(PipelineError::bad_input(
            "the frozen suite of the records has none of the tests: it is of another suite",
        ));
    }
    must_be_free(folder, Some(MINIMAL_FILE))?;
    let failing = failing(&bench, &request.only)?;
    let (failures, files): (Vec<MinimalOf>, Vec<_>) =
        on_each(&bench, &failing, "minimal", progress, |each| minimal_of(&bench, &told, each))?.into_iter().unzip();
    let report = MinimalReport {
        format: "recrash.minimal/1",
        suite: bench.opened.suite.content.clone(),
        ego: bench.simulator.ego().to_owned(),
        failures,
    };
    let mut files: Files = files.into_iter().flatten().collect();
    files.push((MINIMAL_FILE.to_owned(), to_json(&report)));
    files.iter().try_for_each(|(name, text)| must_be_absent_or_same(&folder.join(name), text))?;
    let store = Store::create(folder, write_suite_file)?;
    files.iter().try_for_each(|(name, text)| store.write(name, text).map(drop))?;
    Ok(report)
}

/// Files to write, by name.
type Files = Vec<(String, Vec<u8>)>;

/// What a failure needs, and the files that hold it.
fn minimal_of(
    bench: &Bench,
    told: &BTreeMap<&str, &ScenarioDraft>,
    each: &Failing,
) -> Result<(MinimalOf, Files), PipelineError> {
    let id = &each.test.id;
    let record = told.get(id.as_str()).copied();
    let found = minimal(each.scenario.draft(), record, &bench.simulator, bench.profile())?;
    let scenario = format!("{id}.json");
    let mut files = vec![(scenario.clone(), recrash_roads::write_draft(&found.draft).into_bytes())];
    let twin = found.twin.as_ref().map(|twin| {
        let file = format!("{id}.passes.json");
        files.push((file.clone(), recrash_roads::write_draft(&twin.draft).into_bytes()));
        file
    });
    let findings = match recrash_roads::check(found.draft) {
        Ok(checked) => run_scenario(&checked.value, &bench.simulator, bench.profile(), None)
            .map_err(|error| PipelineError::not_run(&error))?
            .finding_kinds()
            .into_iter()
            .filter(|kind| kind.is_failure())
            .collect(),
        Err(_) => Vec::new(),
    };
    let difference = found.twin.map(|twin| twin.difference);
    let (taken, needed) = (found.taken, found.needed);
    Ok((MinimalOf { id: id.clone(), scenario, findings, twin, difference, taken, needed }, files))
}

/// The list of a folder of minimal failures.
const MINIMAL_FILE: &str = "minimal.json";
