//! `recrash test` and `recrash compare`: a frozen suite run with an ego, and held against a baseline.

use super::retold::DELTA_V;
use super::simulate::REGULATION_DRIVERS;
use crate::options::{EgoArgs, one_change, patience};
use crate::output::{self, Output};
use crate::screen::{self, println};
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_model::cause::{Cause, Failures};
use recrash_model::comparison::{Change, Comparison, TypeRow, shown_p};
use recrash_model::preventability::Bracket;
use recrash_model::results::{TestOutcome, TestResult, TestResults, TestVerdict, Unrepeated};
use recrash_pipeline::{
    CiFiles, Outputs, PageRequest, PipelineError, SimulatorKind, TestRequest, by_cause, compare_files, compare_with,
    comparison_sentence, default_python, github_annotations, hold_to, must_tell, read_results, test, write_page,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const TEST_EXAMPLES: &str = "\
Examples:
  recrash test nightly                                   the frozen suite with its profile's ego
  recrash test nightly --ego 'cmd:./my_stack' --out tonight.json
  recrash test nightly --ego 'cmd:./my_stack' --baseline main.json --fail-on broken,worse --junit junit.xml
  recrash test nightly --ego 'cmd:./my_stack' --seeds 5  for an ego, or a simulation, that is random

Exit code 5: no test could be run; or, with --fail-on, one of its changes happened or a test could not be run. Without a baseline
--fail-on broken means that a test failed.";

const COMPARE_EXAMPLES: &str = "\
Examples:
  recrash compare main.json tonight.json                 fixed, broken, worse, better, same, flaky
  recrash compare main.json tonight.json --fail-on broken,worse --markdown summary.md --github
  recrash compare main.json tonight.json --suite nightly --page changes.html --base-ego 'cmd:./old' --new-ego 'cmd:./new'

Exit code 5: a change of --fail-on happened, or a test of NEW could not be run. What each word means: docs/models/comparison.md.";

/// Failures that the screen tells one by one.
const SHOWN: usize = 20;
/// Tests that were not run, of which it tells why.
const SHOWN_NOT_RUN: usize = 3;

/// What continuous integration gets.
#[derive(Debug, Clone, Args)]
pub struct CiArgs {
    /// Changes that end the command with exit code 5: broken, worse, fixed, better, flaky, unmet, not_run, changed, added, removed.
    #[arg(long, value_name = "CHANGES", value_delimiter = ',', value_parser = one_change)]
    pub fail_on: Vec<Change>,
    /// Write JUnit XML; what the baseline fails as well is skipped in it.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Write a summary of the comparison in Markdown.
    #[arg(long, value_name = "FILE")]
    pub markdown: Option<PathBuf>,
    /// Print annotations as GitHub reads them.
    #[arg(long)]
    pub github: bool,
}

impl CiArgs {
    fn files(&self) -> CiFiles {
        CiFiles { junit: self.junit.clone(), markdown: self.markdown.clone(), json: None }
    }
}

/// Options of `test`.
#[derive(Debug, Clone, Args)]
#[command(after_help = TEST_EXAMPLES)]
pub struct TestArgs {
    /// The frozen suite's folder.
    #[arg(value_name = "FROZEN")]
    pub frozen: PathBuf,
    /// Who drives, and where.
    #[command(flatten)]
    pub ego: EgoArgs,
    /// Run each test so often, each time with another seed.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub seeds: u32,
    /// Results to compare with.
    #[arg(long, value_name = "RESULTS")]
    pub baseline: Option<PathBuf>,
    /// What continuous integration gets.
    #[command(flatten)]
    pub ci: CiArgs,
    /// Write the results.
    #[arg(long, short, value_name = "RESULTS")]
    pub out: Option<PathBuf>,
}

/// Options of `compare`.
#[derive(Debug, Clone, Args)]
#[command(after_help = COMPARE_EXAMPLES)]
pub struct CompareArgs {
    /// Results before.
    #[arg(value_name = "BASE")]
    pub base: PathBuf,
    /// Results now.
    #[arg(value_name = "NEW")]
    pub new: PathBuf,
    /// What continuous integration gets.
    #[command(flatten)]
    pub ci: CiArgs,
    /// Write the comparison as JSON.
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write a page on which both egos play what changed, in one scene; they drive it again.
    #[arg(long, value_name = "FILE", requires = "suite")]
    pub page: Option<PathBuf>,
    /// The frozen suite that both results are of, for the page.
    #[arg(long, value_name = "FROZEN")]
    pub suite: Option<PathBuf>,
    /// The ego of BASE where it is a program, for the page: what only a results file names is not started.
    #[arg(long, value_name = "cmd:PROGRAM")]
    pub base_ego: Option<String>,
    /// The ego of NEW likewise.
    #[arg(long, value_name = "cmd:PROGRAM")]
    pub new_ego: Option<String>,
    /// Seconds such a program may take for an answer; six times that to start.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u16).range(1..=3600), default_value_t = 10)]
    pub ego_timeout: u16,
}

impl CompareArgs {
    fn page_request(&self, suite: &Path) -> PageRequest {
        let test = TestRequest {
            frozen: suite.to_owned(),
            ego: None,
            simulator: SimulatorKind::Native,
            python: default_python(),
            patience: patience(self.ego_timeout),
            seeds: 1,
            threads: None,
            out: None,
        };
        let egos = [self.base_ego.clone(), self.new_ego.clone()];
        PageRequest { test, egos, results: [self.base.clone(), self.new.clone()] }
    }
}

/// Runs a frozen suite.
///
/// # Errors
/// The suite cannot be opened, the ego cannot be started, a file cannot be written, or a change of `--fail-on` happened.
pub fn run(args: &TestArgs, output: Output) -> Result<(), PipelineError> {
    let of_a_comparison = [("--markdown", args.ci.markdown.is_some()), ("--github", args.ci.github)];
    if let (Some((option, _)), None) = (of_a_comparison.iter().find(|(_, asked)| *asked), &args.baseline) {
        return Err(PipelineError::Usage(format!("{option} is of a comparison; name a --baseline")));
    }
    // Before anything is run: a run may take hours.
    let baseline = args.baseline.as_deref().map(read_results).transpose()?;
    baseline.as_ref().map(must_tell).transpose()?;
    let read = args.baseline.iter().cloned().chain([args.frozen.clone()]);
    let mut outputs = Outputs::of_inputs(read);
    let files = args.ci.files().claim(&mut outputs)?;
    if let Some(out) = &args.out {
        outputs.claim(out)?;
    }
    let request = TestRequest {
        frozen: args.frozen.clone(),
        ego: args.ego.ego.clone(),
        simulator: args.ego.sim.unwrap_or_default(),
        python: args.ego.python.clone(),
        patience: args.ego.patience(),
        seeds: args.seeds,
        threads: args.ego.threads.map(usize::from),
        out: args.out.clone(),
    };
    let results = test(&request, &*output.progress())?;
    let comparison = baseline.as_ref().map(|base| compare_with(base, &results)).transpose()?;
    files.write(&results, comparison.as_ref())?;
    match (&comparison, output.json) {
        (None, true) => output::json(&results),
        (Some(comparison), true) => output::json(&serde_json::json!({ "results": results, "comparison": comparison })),
        (_, false) if output.tables() => {
            show_results(&results);
            comparison.iter().for_each(show_comparison);
        }
        _ => {}
    }
    annotate(&args.ci, comparison.as_ref(), output);
    hold_to(&results, comparison.as_ref(), &args.ci.fail_on)
}

/// Compares two results.
///
/// # Errors
/// A file cannot be read or written, or a change of `--fail-on` happened.
pub fn compare(args: &CompareArgs, output: Output) -> Result<(), PipelineError> {
    let mut outputs = Outputs::of_inputs([args.base.clone(), args.new.clone()].into_iter().chain(args.suite.clone()));
    let files = CiFiles { json: args.out.clone(), ..args.ci.files() }.claim(&mut outputs)?;
    let page = args.page.as_ref().map(|page| outputs.claim(page)).transpose()?;
    let (results, comparison) = compare_files(&args.base, &args.new)?;
    files.write(&results, Some(&comparison))?;
    if let (Some(page), Some(suite)) = (&page, &args.suite) {
        write_page(&args.page_request(suite), &comparison, page).map_err(named_yourself)?;
    }
    if output.json {
        output::json(&comparison);
    } else if output.tables() {
        show_comparison(&comparison);
    }
    annotate(&args.ci, Some(&comparison), output);
    hold_to(&results, Some(&comparison), &args.ci.fail_on)
}

/// A program that only the results name is not started; here two options name one.
fn named_yourself(error: PipelineError) -> PipelineError {
    match error {
        PipelineError::Untrusted { program } => PipelineError::Usage(format!(
            "the results have the program `{program}` as their ego; results may be anybody's, so name it yourself: --base-ego is \
             that of the first results, --new-ego that of the second"
        )),
        other => other,
    }
}

fn annotate(args: &CiArgs, comparison: Option<&Comparison>, output: Output) {
    if let Some(comparison) = comparison.filter(|_| args.github && !output.json) {
        screen::raw(github_annotations(comparison).as_bytes());
    }
}

/// Prints results: counts by crash type, causes, and the worst failures.
fn show_results(results: &TestResults) {
    output::title(&format!("{} in {}", results.ego, results.simulator));
    let mut by_type: BTreeMap<&str, [usize; 5]> = BTreeMap::new();
    for test in &results.tests {
        for kind in [test.about.crash_type_label(), "all"] {
            let row = by_type.entry(kind).or_default();
            row[0] += 1;
            row[match test.verdict() {
                _ if test.never_met() => 2,
                TestVerdict::Passed => 1,
                TestVerdict::Failed => 3,
                TestVerdict::NotRun => 4,
            }] += 1;
        }
    }
    let mut rows =
        table(&["crash type", "tests", "passed", "not met", "failed", "not run"]).without_first(&["not run"]);
    let order = |kind: &str| (kind == "all", kind == "not stated");
    let mut ordered: Vec<(&str, [usize; 5])> = by_type.into_iter().collect();
    ordered.sort_by_key(|(kind, _)| order(kind));
    for (kind, counts) in ordered {
        rows.add_row([Cell::new(kind)].into_iter().chain(counts.map(number)));
    }
    println!("{rows}");
    if let Some(unrepeated) = &results.unrepeated {
        let Unrepeated { test, why } = unrepeated;
        screen::sentence(&format!(
            "warning: the ego does not repeat: {test} was run twice, and {why}; what it fails may pass the next time"
        ));
    }
    if results.tests.iter().any(TestResult::never_met) {
        screen::sentence("not met: never in the situation of its record, no failure and no pass");
    }
    let beyond = results.tests.iter().filter(|test| test.passes_beyond_tyres()).count();
    if beyond > 0 {
        let words = "of those passed it brakes harder than tyres can, so that a real vehicle might not pass";
        screen::sentence(&format!("in {beyond} {words}"));
    }
    show_not_run(results);
    show_causes(results);
    show_failures(results);
    show_brackets(results);
}

/// Why the first tests were not run.
fn show_not_run(results: &TestResults) {
    let not_run = results.tests.iter().filter(|test| test.verdict() == TestVerdict::NotRun);
    let told: Vec<(&str, &str)> =
        not_run.filter_map(|test| Some((test.id.as_str(), test.telling()?.why.as_deref()?))).collect();
    for (id, why) in told.iter().take(SHOWN_NOT_RUN) {
        screen::sentence(&format!("not run: {id}: {why}"));
    }
    if told.len() > SHOWN_NOT_RUN {
        println!("and {} more, told by --json and --out", told.len() - SHOWN_NOT_RUN);
    }
}

fn show_causes(results: &TestResults) {
    let groups = by_cause(&results.tests);
    if groups.is_empty() {
        return;
    }
    output::title("Causes: one finding each");
    let mut rows = table(&["cause", "tests", "worst delta-v", "shortest example"]);
    for group in groups {
        rows.add_row([
            Cell::new(group.cause.map_or("no rule holds", |cause| cause.label())),
            number(group.tests.len()),
            number(
                Some(group.worst_delta_v_mps)
                    .filter(|worst| *worst > 0.0)
                    .map_or("-".to_owned(), |worst| format!("{worst:.1} m/s")),
            ),
            Cell::new(group.example),
        ]);
    }
    println!("{rows}");
}

/// Failures, the most harmful first.
fn show_failures(results: &TestResults) {
    let outcome = |test: &'_ TestResult| test.telling().and_then(|run| run.outcome.clone());
    let failed = results.tests.iter().filter(|test| test.verdict() == TestVerdict::Failed);
    let mut failed: Vec<(&TestResult, TestOutcome)> = failed.filter_map(|test| Some((test, outcome(test)?))).collect();
    if failed.is_empty() {
        return;
    }
    let gap = |outcome: &TestOutcome| outcome.least_gap.map_or(f64::MAX, |gap| gap.value);
    failed.sort_by(|(a, one), (b, other)| {
        let by_kind = struck_standing(one).cmp(&struck_standing(other));
        let by_harm = other.harm_mps().total_cmp(&one.harm_mps());
        by_kind.then(by_harm).then(gap(one).total_cmp(&gap(other))).then(a.id.cmp(&b.id))
    });
    output::title("Failures, the most harmful first, then those in which it was struck while it stood");
    let header = ["verdict", "test", "what failed", DELTA_V, "least gap", "failed", "UN R157 reference drivers"];
    let spare = ["failed", "UN R157 reference drivers", "least gap", DELTA_V];
    let mut rows = table(&header).named_by("test").whole("what failed").without_first(&spare);
    for (test, outcome) in failed.iter().take(SHOWN) {
        let kinds: Vec<&str> = outcome.kinds().iter().map(|kind| kind.label()).collect();
        let what = outcome.cause.map_or_else(|| kinds.join(", "), |cause| cause.label().to_owned());
        rows.add_row([
            Cell::new(if struck_standing(outcome) { "STRUCK" } else { "FAIL" }),
            Cell::new(&test.id),
            Cell::new(what),
            number(outcome.severity.as_ref().map_or("-".to_owned(), |severity| {
                format!("{:.1} / {:.1}", severity.first.delta_v_mps, severity.second.delta_v_mps)
            })),
            number(outcome.least_gap.map_or_else(|| "-".to_owned(), |gap| format!("{:.2} m", gap.value))),
            number(format!("{} of {}", test.failures(), test.runs.len())),
            Cell::new(outcome.bracket().map_or("-", short)),
        ]);
    }
    println!("{rows}");
    if failed.len() > SHOWN {
        println!("and {} more, told by --json and --out", failed.len() - SHOWN);
    }
    let failures = Failures::of(failed.iter().map(|(_, outcome)| outcome.cause));
    screen::sentence(&format!(
        "{} failed: {failures} (STRUCK: it had stood for a second, seldom by what it drove)",
        failures.total()
    ));
}

/// Whether it failed by being struck while it stood.
fn struck_standing(outcome: &TestOutcome) -> bool {
    outcome.cause == Some(Cause::StruckStanding)
}

fn short(bracket: Bracket) -> &'static str {
    match bracket {
        Bracket::AvoidedByAll => "all avoid it",
        Bracket::AvoidedBySome => "some avoid it",
        Bracket::AvoidedByNone => "none avoids it",
        Bracket::NotCovered => "not covered",
    }
}

fn show_brackets(results: &TestResults) {
    let mut counts: BTreeMap<Bracket, usize> = BTreeMap::new();
    let failed = results.tests.iter().filter(|test| test.verdict() == TestVerdict::Failed);
    for bracket in failed.filter_map(|test| test.telling()?.outcome.as_ref()?.bracket()) {
        *counts.entry(bracket).or_default() += 1;
    }
    if !counts.is_empty() {
        let told: Vec<String> = counts.iter().map(|(bracket, count)| format!("{count} {}", bracket.label())).collect();
        screen::sentence(&format!("of contacts, {REGULATION_DRIVERS}: {}", told.join(", ")));
    }
}

/// Prints a comparison: counts by crash type, and what changed.
fn show_comparison(comparison: &Comparison) {
    let [before, now] = &comparison.egos;
    output::title(&format!("{now} against {before}"));
    if comparison.suites[0] != comparison.suites[1] {
        screen::sentence("the two are of different suites; tests that differ are told as changed");
    }
    let used: Vec<Change> =
        Change::ALL.into_iter().filter(|change| comparison.all.changes.contains_key(change)).collect();
    let labels: Vec<&str> = used.iter().map(|change| change.label()).collect();
    let header = [&["crash type", "tests", "failed before", "failed now"], &labels[..], &["p"]].concat();
    let mut rows = table(&header).without_first(&[
        "same",
        "p",
        "removed",
        "added",
        "failed before",
        "failed now",
        "changed",
        "not run",
    ]);
    let row = |row: &TypeRow| -> Vec<Cell> {
        let head = [Cell::new(row.crash_type), number(row.tests), number(row.base_failed), number(row.new_failed)];
        let counts = used.iter().map(|change| number(row.changes.get(change).unwrap_or(&0)));
        head.into_iter().chain(counts).chain([number(shown_p(row.p))]).collect()
    };
    for each in comparison.by_type.iter().chain([&comparison.all]) {
        rows.add_row(row(each));
    }
    println!("{rows}");
    let changed: Vec<_> =
        used.iter().filter(|change| **change != Change::Same).flat_map(|change| comparison.of(*change)).collect();
    if !changed.is_empty() {
        let mut rows = table(&["test", "what changed"]);
        for test in changed.iter().take(2 * SHOWN) {
            let p = test.p.map_or_else(String::new, |p| format!(" (p {})", shown_p(p)));
            rows.add_row([Cell::new(&test.id), Cell::new(format!("{}: {}{p}", test.change.label(), test.why))]);
        }
        println!("{rows}");
        if changed.len() > 2 * SHOWN {
            println!("and {} more, told by --json and --out", changed.len() - 2 * SHOWN);
        }
    }
    screen::sentence(&comparison_sentence(comparison));
}
