//! Evidence: a folder with claims, their numbers, and everything that a stranger needs to work each number out again. Described in
//! `docs/evidence.md`.

mod claims;
mod corpus;
mod number;
mod numbers;
mod structure;

use crate::error::PipelineError;
use crate::files::folders::{FolderInWork, must_be_free};
use crate::files::json::{to_compact_json, to_json};
use crate::files::paths;
use crate::files::store::{Store, io, read_bytes, sha256, write_suite_file};
use crate::profiles::DEFAULT_PROFILE;
use crate::progress::{Progress, ProgressEvent};
use crate::suite::SUITE_FILE;
use crate::tools::freezing::{FreezeRequest, Opened, freeze};
use crate::tools::running::recorded_crash;
use crate::tools::testing::{Bench, TestRequest, outcome, read_results};
use rayon::prelude::*;
use recrash_lab::run_scenario;
use recrash_model::frozen::{FROZEN_FILE, FrozenTest};
use recrash_model::kinds::PartnerKind;
use recrash_model::results::{TestOutcome, TestResults, TestVerdict, Unrepeated};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Scenario;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The checker, in the folder as it stands here.
const CHECKER: &str = include_str!("check.py");
/// Name of what is done, for progress.
const STAGE: &str = "evidence";
/// A larger report of another command is refused. [bytes]
const MAX_REPORT: u64 = 1 << 28;
/// Reports that go along: the format of each, and what it is called.
const REPORTS: [(&str, &str); 2] = [("recrash.robustness/1", "robustness"), ("recrash.parity/1", "parity")];

/// What to show evidence of, and where to write it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EvidenceRequest {
    /// A frozen suite or a suite, the ego and where it drives; `out` is not used.
    pub test: TestRequest,
    /// Of a suite: its scenarios as tuned.
    pub tuned: bool,
    /// Results that the runs must give again.
    pub results: Option<PathBuf>,
    /// Reports of `recrash robustness` and `recrash parity`.
    pub reports: Vec<PathBuf>,
    /// The folder to make.
    pub folder: PathBuf,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evidence {
    /// Claims.
    pub claims: usize,
    /// Numbers that the checker works out again.
    pub numbers: usize,
    /// SHA-256 of `manifest.json`, which names every other file by its own: who keeps this keeps all.
    pub root: String,
    /// The folder.
    #[serde(serialize_with = "paths::as_text")]
    pub folder: PathBuf,
}

/// What the checker reads of the runs.
#[derive(Serialize)]
struct Runs {
    format: &'static str,
    recrash: &'static str,
    suite: String,
    ego: String,
    simulator: String,
    /// That the ego does not repeat, where one test was driven otherwise when it was run again.
    #[serde(skip_serializing_if = "Option::is_none")]
    unrepeated: Option<Unrepeated>,
    masses_kg: BTreeMap<String, Option<f64>>,
    tests: Vec<TestFacts>,
}

/// What is said of one test.
#[derive(Serialize)]
struct TestFacts {
    id: String,
    verdict: &'static str,
    why: Option<String>,
    rollout: Option<String>,
    provenance: &'static str,
    crash_type: &'static str,
    report: Option<String>,
    cause: Option<&'static str>,
    preventability: Option<&'static str>,
    met: Option<bool>,
    /// Whether the ego, brought into the situation, brakes harder than tyres let a vehicle.
    beyond_tyres: Option<bool>,
    #[serde(skip)]
    outcome: Option<TestOutcome>,
}

/// The root: every file by its hash.
#[derive(Serialize)]
struct Manifest {
    format: &'static str,
    files: BTreeMap<String, String>,
}

/// Runs a suite once more and writes what is claimed of it.
///
/// # Errors
/// The suite cannot be opened, an ego fails to start, the results are others than those given, a report is of something else, or a
/// file cannot be written.
pub fn evidence(request: &EvidenceRequest, progress: &dyn Progress) -> Result<Evidence, PipelineError> {
    must_be_free(&request.folder, None)?;
    let reports = read_reports(&request.reports)?;
    let results = request.results.as_deref().map(read_results).transpose()?;
    // Half a folder would only be in the way of the next try, and what is in the user's is his.
    let work = FolderInWork::beside(&request.folder)?;
    let in_work = EvidenceRequest { folder: work.path().to_owned(), ..request.clone() };
    let written = write(&in_work, reports, results.as_ref(), progress)?;
    work.finish()?;
    Ok(Evidence { folder: request.folder.clone(), ..written })
}

fn write(
    request: &EvidenceRequest,
    reports: Vec<Report>,
    results: Option<&TestResults>,
    progress: &dyn Progress,
) -> Result<Evidence, PipelineError> {
    let store = Store::create(&request.folder, write_suite_file)?;
    let mut files = Files { store: &store, hashes: BTreeMap::new() };
    take_suite(request, &mut files)?;
    let bench = Bench::set_up(&TestRequest { frozen: request.folder.join("suite"), ..request.test.clone() })?;
    let mut reports = take_reports(reports, &bench, &mut files)?;
    let facts = run(&bench, &mut files, progress)?;
    if let (Some(results), Some(path)) = (results, &request.results) {
        must_be_given_again(results, path, &facts)?;
    }
    if let Some(covered) = corpus::of(&request.test.frozen)? {
        files.write(corpus::FILE, &to_json(&covered))?;
        reports.insert(corpus::NAME, covered);
    }
    let runs = Runs {
        format: "recrash.evidence-runs/1",
        recrash: env!("CARGO_PKG_VERSION"),
        suite: bench.opened.suite.content.clone(),
        ego: bench.simulator.ego().to_owned(),
        simulator: format!("{} {}", bench.simulator.name(), bench.simulator.version()),
        unrepeated: bench.unrepeated(
            facts.iter().find_map(|test| Some((test.id.as_str(), test.outcome.as_ref()?.state_hash.as_str()))),
        ),
        masses_kg: masses(),
        tests: facts,
    };
    let numbers = numbers::all(&runs.tests, &reports);
    let claims = claims::all(&runs, bench.profile(), &numbers, &reports);
    files.write("runs.json", &to_json(&runs))?;
    files.write("claims.json", &to_json(&serde_json::json!({ "format": "recrash.claims/1", "claims": claims })))?;
    files.write("check.py", CHECKER.as_bytes())?;
    files.write("README.md", claims::readme(&runs, numbers.len()).as_bytes())?;
    files.write("numbers.json", &to_json(&serde_json::json!({ "format": "recrash.numbers/1", "numbers": numbers })))?;
    let root = to_json(&Manifest { format: "recrash.evidence/1", files: files.hashes });
    store.write("manifest.json", &root)?;
    Ok(Evidence { claims: claims.len(), numbers: numbers.len(), root: sha256(&root), folder: request.folder.clone() })
}

/// Files of the folder, each with its hash.
struct Files<'a> {
    store: &'a Store,
    hashes: BTreeMap<String, String>,
}

impl Files<'_> {
    fn write(&mut self, name: &str, content: &[u8]) -> Result<(), PipelineError> {
        if let Some(parent) = self.store.path(name).parent() {
            std::fs::create_dir_all(parent).map_err(|source| io("create", parent, source))?;
        }
        let path = self.store.path(name);
        write_suite_file(&path, content).map_err(|source| io("write", &path, source))?;
        self.hashes.insert(name.to_owned(), sha256(content));
        Ok(())
    }
}

/// The frozen suite into the folder: a copy, or frozen now.
fn take_suite(request: &EvidenceRequest, files: &mut Files) -> Result<(), PipelineError> {
    let source = &request.test.frozen;
    let target = request.folder.join("suite");
    if source.join(SUITE_FILE).is_file() {
        freeze(&FreezeRequest {
            sources: vec![source.clone()],
            about: None,
            out: target.clone(),
            profile: None,
            default_profile: DEFAULT_PROFILE.to_owned(),
            tuned: request.tuned,
            narratives: false,
            replace: false,
        })?;
    }
    let from = if target.is_dir() { &target } else { source };
    let opened = Opened::read(from)?;
    let own = opened.suite.tests.iter().flat_map(|test| {
        let account = test.account.as_ref().map(|account| account.file.clone());
        std::iter::once(test.scenario.clone()).chain(account)
    });
    for name in own.chain([FROZEN_FILE.to_owned()]) {
        let content = read_bytes(&from.join(&name), MAX_REPORT)?;
        files.write(&format!("suite/{name}"), &content)?;
    }
    Ok(())
}

/// Runs every test and keeps its rollout.
fn run(bench: &Bench, files: &mut Files, progress: &dyn Progress) -> Result<Vec<TestFacts>, PipelineError> {
    progress.event(ProgressEvent::Started { stage: STAGE, units: bench.opened.scenarios.len() });
    let one = |(test, scenario): (&FrozenTest, &Scenario)| {
        let ran = run_scenario(scenario, &bench.simulator, bench.profile(), test.expectation.as_ref());
        progress.event(ProgressEvent::Advanced { stage: STAGE, unit: &test.id, skipped: false });
        let about = &test.about;
        let name = format!("rollouts/{}.json", test.id);
        let mut facts = TestFacts {
            id: test.id.clone(),
            verdict: TestVerdict::NotRun.label(),
            why: None,
            rollout: None,
            provenance: about.provenance.label(),
            crash_type: about.crash_type_label(),
            report: about.told.as_ref().map(ToString::to_string),
            cause: None,
            preventability: None,
            met: None,
            beyond_tyres: None,
            outcome: None,
        };
        match ran {
            Err(error) => {
                facts.why = Some(crate::secrets::scrubber().scrub(&error.why.to_string()));
                Ok(facts)
            }
            Ok(run) => {
                let content = to_compact_json(&run.rollout);
                let path = files.store.path(&name);
                let folder = path.parent().unwrap_or(Path::new("."));
                std::fs::create_dir_all(folder).map_err(|source| io("create", folder, source))?;
                write_suite_file(&path, &content).map_err(|source| io("write", &path, source))?;
                let recorded = recorded_crash(scenario, bench.profile());
                let outcome = outcome(&run, test, recorded.as_ref());
                facts.verdict = if run.failed() { TestVerdict::Failed } else { TestVerdict::Passed }.label();
                facts.rollout = Some(name);
                facts.met = outcome.met;
                facts.beyond_tyres = Some(outcome.met != Some(false) && run.brakes_beyond_tyres());
                facts.cause = outcome.cause.map(|cause| cause.label());
                facts.preventability = outcome.bracket().map(|bracket| bracket.label());
                facts.outcome = Some(outcome);
                Ok(facts)
            }
        }
    };
    let facts: Vec<TestFacts> =
        bench.threads.install(|| bench.tests().map(one).collect::<Result<_, PipelineError>>())?;
    for name in facts.iter().filter_map(|test| test.rollout.clone()) {
        let content = read_bytes(&files.store.path(&name), MAX_REPORT)?;
        files.hashes.insert(name, sha256(&content));
    }
    progress.event(ProgressEvent::Finished { stage: STAGE });
    Ok(facts)
}

/// Whether the runs drove what the results say.
fn must_be_given_again(results: &TestResults, path: &Path, facts: &[TestFacts]) -> Result<(), PipelineError> {
    let told: BTreeMap<&str, Option<&str>> = results
        .tests
        .iter()
        .map(|test| {
            let outcome = test.runs.first().and_then(|run| run.outcome.as_ref());
            (test.id.as_str(), outcome.map(|outcome| outcome.state_hash.as_str()))
        })
        .collect();
    for test in facts {
        let now = test.outcome.as_ref().map(|outcome| outcome.state_hash.as_str());
        if told.get(test.id.as_str()) != Some(&now) {
            return Err(PipelineError::bad_input(format!(
                "{}: the run of {} is another one now; the ego, the suite or recrash changed, so the results are no evidence",
                path.display(),
                test.id
            )));
        }
    }
    Ok(())
}

/// A report of another command.
struct Report {
    name: &'static str,
    path: PathBuf,
    content: Vec<u8>,
    value: Value,
}

fn read_reports(paths: &[PathBuf]) -> Result<Vec<Report>, PipelineError> {
    let read = |path: &PathBuf| {
        let bad = |why: String| PipelineError::bad_input(format!("{}: {why}", path.display()));
        let content = read_bytes(path, MAX_REPORT)?;
        let value: Value = serde_json::from_slice(&content).map_err(|error| bad(error.to_string()))?;
        let format = value["format"].as_str().unwrap_or_default();
        let known = REPORTS.into_iter().find(|(known, _)| *known == format);
        let (_, name) = known.ok_or_else(|| {
            bad("it is neither a report of `recrash robustness` nor one of `recrash parity`".to_owned())
        })?;
        Ok(Report { name, path: path.clone(), content, value })
    };
    paths.iter().map(read).collect()
}

/// Puts reports into the folder; gives them by their names.
fn take_reports(
    reports: Vec<Report>,
    bench: &Bench,
    files: &mut Files,
) -> Result<BTreeMap<&'static str, Value>, PipelineError> {
    let mut taken = BTreeMap::new();
    for report in reports {
        let bad = |why: &str| PipelineError::bad_input(format!("{}: {why}", report.path.display()));
        if report.value.get("suite").is_some_and(|suite| *suite != bench.opened.suite.content) {
            return Err(bad("it is of another frozen suite"));
        }
        if report.name == "robustness" && report.value["ego"] != bench.simulator.ego() {
            return Err(bad("it is of another ego"));
        }
        files.write(&format!("reports/{}.json", report.name), &report.content)?;
        taken.insert(report.name, report.value);
    }
    Ok(taken)
}

/// Mass of every kind, by its name in files. [kg]
fn masses() -> BTreeMap<String, Option<f64>> {
    let name = |kind: PartnerKind| serde_json::to_value(kind).ok()?.as_str().map(str::to_owned);
    PartnerKind::ALL.into_iter().filter_map(|kind| Some((name(kind)?, VehicleSpec::mass_kg(kind)))).collect()
}
