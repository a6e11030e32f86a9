//! Runs of a frozen suite: what an ego does in each of its tests. Described in `docs/nightly.md`.

use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::files::output::Outputs;
use crate::progress::{Progress, ProgressEvent};
use crate::reading::documents::read_document;
use crate::reading::named;
use crate::simulators::external::{EgoCommand, Patience};
use crate::simulators::{Simulator, SimulatorKind, start_simulator};
use crate::suite::{refuse_untrusted, thread_pool};
use crate::tools::freezing::Opened;
use crate::tools::running::recorded_crash;
use rayon::prelude::*;
use recrash_drivers::preventability;
use recrash_lab::{run_scenario, situation};
use recrash_model::Seed;
use recrash_model::frozen::FrozenTest;
use recrash_model::metrics::CheckResult;
use recrash_model::profile::SystemProfile;
use recrash_model::results::{RESULTS_FORMAT, TestOutcome, TestResult, TestResults, TestRun, TestVerdict, Unrepeated};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_roads::{AnswerTimes, Scenario};
use std::path::{Path, PathBuf};

/// Name of what is done, for progress.
const STAGE: &str = "test";

/// What to run, and where to write what comes of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TestRequest {
    /// The frozen suite's folder.
    pub frozen: PathBuf,
    /// Ego; the profile's where none is named.
    pub ego: Option<String>,
    /// Simulator.
    pub simulator: SimulatorKind,
    /// Python interpreter for MetaDrive.
    pub python: PathBuf,
    /// How long answers of an external ego are waited for.
    pub patience: Patience,
    /// How often each test is run, each time with another seed.
    pub seeds: u32,
    /// Worker threads; as many as there are cores where not given. No byte of the results depends on it.
    pub threads: Option<usize>,
    /// Where to write the results.
    pub out: Option<PathBuf>,
}

/// A frozen suite with an ego in it, ready to run.
pub(crate) struct Bench {
    pub opened: Opened,
    pub simulator: Box<dyn Simulator>,
    pub threads: rayon::ThreadPool,
}

impl Bench {
    /// Opens the suite and starts the ego.
    pub fn set_up(request: &TestRequest) -> Result<Self, PipelineError> {
        let opened = Opened::read(&request.frozen)?;
        let ego = request.ego.as_deref().unwrap_or(&opened.suite.profile.ego);
        refuse_untrusted(ego, request.ego.is_some())?;
        let threads = thread_pool(request.threads.unwrap_or(0))?;
        let workers = threads.current_num_threads();
        let simulator = start_simulator(request.simulator, ego, &request.python, workers, request.patience)?;
        Ok(Self { opened, simulator, threads })
    }

    /// The tests with their scenarios.
    pub fn tests(&self) -> impl IndexedParallelIterator<Item = (&FrozenTest, &Scenario)> {
        self.opened.suite.tests.par_iter().zip(self.opened.scenarios.par_iter())
    }

    /// What counts as a failure.
    pub fn profile(&self) -> &SystemProfile {
        &self.opened.suite.profile
    }

    /// Where the ego is a program: this test, with the hash of what was driven in it, is run again; what is said where that gives
    /// something else.
    pub fn unrepeated(&self, driven: Option<(&str, &str)>) -> Option<Unrepeated> {
        EgoCommand::parse(self.simulator.ego()).ok().flatten()?;
        let (id, hash) = driven?;
        let at = self.opened.suite.tests.iter().position(|test| test.id == id)?;
        let again = self.simulator.run(&self.opened.scenarios[at]);
        let why = match again {
            Ok(rollout) if rollout.state_hash == hash => return None,
            Ok(rollout) => format!("the states are others: {hash} the first time, {} the second", rollout.state_hash),
            Err(error) => {
                format!("no answer the second time: {}", crate::secrets::scrubber().scrub(&error.why.to_string()))
            }
        };
        Some(Unrepeated { test: id.to_owned(), why })
    }

    /// Results with these tests.
    pub fn results(&self, tests: Vec<TestResult>, seeds: u32) -> TestResults {
        let suite = &self.opened.suite;
        let mut driven = tests.iter().filter_map(|test| {
            let outcome = test.runs.first()?.outcome.as_ref()?;
            Some((test.id.as_str(), outcome.state_hash.as_str()))
        });
        let unrepeated = self.unrepeated(driven.next());
        TestResults {
            format: RESULTS_FORMAT.to_owned(),
            recrash: env!("CARGO_PKG_VERSION").to_owned(),
            suite: suite.content.clone(),
            profile: suite.profile.name.clone(),
            ego: self.simulator.ego().to_owned(),
            simulator: format!("{} {}", self.simulator.name(), self.simulator.version()),
            seeds,
            unrepeated,
            tests,
        }
    }
}

/// Runs every test and writes the results.
///
/// # Errors
/// The suite cannot be opened, the ego cannot be started, or the file cannot be written. A test that the ego spoils is a result.
pub fn test(request: &TestRequest, progress: &dyn Progress) -> Result<TestResults, PipelineError> {
    let read = named::of_profile_and_ego(None, request.ego.as_deref());
    let mut outputs = Outputs::of_inputs(read.into_iter().chain([request.frozen.clone()]));
    let output = request.out.as_ref().map(|out| outputs.claim(out)?.in_a_folder()).transpose()?;
    let bench = Bench::set_up(request)?;
    progress.event(ProgressEvent::Started { stage: STAGE, units: bench.opened.scenarios.len() });
    let tests = bench.threads.install(|| {
        let run = |(test, scenario): (&FrozenTest, &Scenario)| {
            let result = run_test(test, scenario, &bench, request.seeds);
            progress.event(ProgressEvent::Advanced { stage: STAGE, unit: &test.id, skipped: false });
            result
        };
        bench.tests().map(run).collect()
    });
    progress.event(ProgressEvent::Finished { stage: STAGE });
    let results = bench.results(tests, request.seeds);
    if let Some(AnswerTimes { answers, median_s, greatest_s }) = bench.simulator.answer_times() {
        let (median_ms, greatest_ms) = (1e3 * median_s, 1e3 * greatest_s);
        let what =
            format!("answer times of the ego: median {median_ms:.1} ms, greatest {greatest_ms:.1} ms, of {answers}");
        progress.event(ProgressEvent::Said { what: &what });
    }
    if let Some(output) = output {
        output.write(&to_json(&results))?;
    }
    Ok(results)
}

/// Reads results.
///
/// # Errors
/// The file cannot be read, or holds no results: where what is wrong stands.
pub fn read_results(path: &Path) -> Result<TestResults, PipelineError> {
    let results: TestResults = read_document(path, "results file", RESULTS_FORMAT)?;
    let bad = |why: String| PipelineError::bad_input(format!("{}: {why}", path.display()));
    for (at, pair) in results.tests.windows(2).enumerate() {
        if pair[0].id >= pair[1].id {
            return Err(bad(format!("tests[{}].id: \"{}\" is not in order, or is there twice", at + 1, pair[1].id)));
        }
    }
    for (at, test) in results.tests.iter().enumerate() {
        if test.runs.is_empty() {
            return Err(bad(format!("tests[{at}].runs: \"{}\" has no run", test.id)));
        }
    }
    Ok(results)
}

/// Runs one test with each seed.
fn run_test(test: &FrozenTest, scenario: &Scenario, bench: &Bench, seeds: u32) -> TestResult {
    let recorded = recorded_crash(scenario, bench.profile());
    let run = |number: u32| match seeded(scenario, number) {
        Ok(scenario) => run_of(test, &scenario, recorded.as_ref(), bench),
        Err(why) => not_run(scenario.draft().source.seed, why),
    };
    let runs = (0..seeds.max(1)).map(run).collect();
    TestResult { id: test.id.clone(), content: test.content.clone(), about: test.about.clone(), runs }
}

/// The scenario with the seeds of its n-th run; the first is as the suite has it.
fn seeded(scenario: &Scenario, number: u32) -> Result<Scenario, String> {
    if number == 0 {
        return Ok(scenario.clone());
    }
    let mut draft: ScenarioDraft = scenario.draft().clone();
    let child = |seed: u64| Seed(seed).child(&format!("run {number}")).0;
    draft.source.seed = child(draft.source.seed);
    if draft.traffic.density > 0.0 {
        draft.traffic.seed = child(draft.traffic.seed);
    }
    let refused = |list: Vec<recrash_model::Diagnostic>| list.first().map(ToString::to_string).unwrap_or_default();
    recrash_roads::check(draft).map(|checked| checked.value).map_err(refused)
}

fn run_of(test: &FrozenTest, scenario: &Scenario, recorded: Option<&JudgedRun>, bench: &Bench) -> TestRun {
    let seed = scenario.draft().source.seed;
    match run_scenario(scenario, &bench.simulator, bench.profile(), test.expectation.as_ref()) {
        Ok(run) => TestRun {
            seed,
            verdict: if run.failed() { TestVerdict::Failed } else { TestVerdict::Passed },
            why: None,
            outcome: Some(outcome(&run, test, recorded)),
        },
        // What a program says of itself may hold a key.
        Err(error) => not_run(seed, crate::secrets::scrubber().scrub(&error.why.to_string())),
    }
}

/// Whether the ego came into the situation of the recorded crash.
fn met(run: &JudgedRun, recorded: &JudgedRun) -> bool {
    situation(run, recorded).result == CheckResult::Shown
}

fn not_run(seed: u64, why: String) -> TestRun {
    TestRun { seed, verdict: TestVerdict::NotRun, why: Some(why), outcome: None }
}

/// What is kept of a run of a test.
pub(crate) fn outcome(run: &JudgedRun, test: &FrozenTest, recorded: Option<&JudgedRun>) -> TestOutcome {
    TestOutcome {
        state_hash: run.state_hash.clone(),
        termination: run.metrics.termination,
        duration_s: run.metrics.duration_s,
        findings: run.findings.clone(),
        contact: run.metrics.contact.clone(),
        least_gap: run.least_gap(),
        severity: run.severity.clone(),
        preventability: preventability(&run.rollout),
        cause: run.cause,
        faithful: test.expectation.is_some().then(|| run.faithful()),
        met: recorded.map(|recorded| met(run, recorded)),
    }
}
