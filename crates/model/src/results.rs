//! Results of a frozen suite: what an ego did in each of its tests.

use crate::cause::Cause;
use crate::frozen::About;
use crate::metrics::{Answer, Contact, Finding, FindingKind, Timed};
use crate::preventability::{Bracket, Preventability};
use crate::rollout::TerminationKind;
use crate::severity::Severity;
use serde::{Deserialize, Serialize};

/// The results' format tag.
pub const RESULTS_FORMAT: &str = "recrash.results/1";

/// What an ego did in the tests of a frozen suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestResults {
    /// Always [`RESULTS_FORMAT`].
    pub format: String,
    /// Version of recrash that ran it.
    pub recrash: String,
    /// Name of the frozen suite by its content.
    pub suite: String,
    /// Name of the profile that says what a failure is.
    pub profile: String,
    /// Ego.
    pub ego: String,
    /// Simulator and its version; empty where nothing could be run.
    pub simulator: String,
    /// How often each test was run.
    pub seeds: u32,
    /// That the ego does not repeat, where it is a program and one test was run again to see that; absent where it drove the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unrepeated: Option<Unrepeated>,
    /// By id.
    pub tests: Vec<TestResult>,
}

/// A test that an ego drove otherwise when it was run again, with the same seed: what it fails once it may pass the next time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unrepeated {
    /// The test.
    pub test: String,
    /// What came of the second run.
    pub why: String,
}

/// What an ego did in one test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestResult {
    /// The test.
    pub id: String,
    /// Name of what was run, by its content.
    pub content: String,
    /// Whose crash it is.
    pub about: About,
    /// One for each seed, in order.
    pub runs: Vec<TestRun>,
}

/// One run of a test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestRun {
    /// Seed of what is random in it.
    pub seed: u64,
    /// How it came out.
    pub verdict: TestVerdict,
    /// Why it was not run, where it was not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// What happened, where it was run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outcome: Option<TestOutcome>,
}

/// How a run of a test came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TestVerdict {
    /// Nothing that the profile calls a failure happened.
    Passed,
    /// Something did.
    Failed,
    /// The ego or the simulator gave no rollout.
    NotRun,
}

impl TestVerdict {
    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "failed",
            Self::NotRun => "not run",
        }
    }
}

/// What happened in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestOutcome {
    /// Hash of all states: two runs of one hash drove the same.
    pub state_hash: String,
    /// How it ended.
    pub termination: TerminationKind,
    /// How long it lasted. [s]
    pub duration_s: f64,
    /// Failures first.
    pub findings: Vec<Finding>,
    /// The ego's first contact with a road user.
    pub contact: Option<Contact>,
    /// Least box gap to a scripted partner. [m]
    pub least_gap: Option<Timed>,
    /// How bad the contact is.
    pub severity: Option<Severity>,
    /// What reference drivers make of the contact.
    pub preventability: Option<Preventability>,
    /// What led to the failure.
    pub cause: Option<Cause>,
    /// Whether it shows its record's crash, where what to show is known.
    pub faithful: Option<Answer>,
    /// Whether the ego came into the situation of its record; absent where no recorded driver crashes in the scenario.
    pub met: Option<bool>,
}

impl TestOutcome {
    /// Kinds of findings, each once, failures first.
    pub fn kinds(&self) -> Vec<FindingKind> {
        let mut kinds: Vec<FindingKind> = self.findings.iter().map(|finding| finding.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }

    /// The bracket over the reference drivers, where there was a contact.
    pub fn bracket(&self) -> Option<Bracket> {
        self.preventability.as_ref().map(Preventability::bracket)
    }

    /// Greater change of velocity of the two in the contact; 0 where there is none. [m/s]
    pub fn harm_mps(&self) -> f64 {
        self.severity.as_ref().map_or(0.0, Severity::harm_mps)
    }
}

impl TestResult {
    /// Runs that failed.
    pub fn failures(&self) -> usize {
        self.runs.iter().filter(|run| run.verdict == TestVerdict::Failed).count()
    }

    /// Whether there are runs, none failed, and none came into the situation of its record.
    pub fn never_met(&self) -> bool {
        let unmet = |run: &TestRun| run.outcome.as_ref().is_some_and(|outcome| outcome.met == Some(false));
        self.verdict() == TestVerdict::Passed && self.runs.iter().all(unmet)
    }

    /// Whether it passes, and in some run by braking that tyres do not give.
    pub fn passes_beyond_tyres(&self) -> bool {
        let is_beyond = |finding: &Finding| finding.kind == FindingKind::BrakingBeyondTyres;
        let beyond = |run: &TestRun| run.outcome.as_ref().is_some_and(|outcome| outcome.findings.iter().any(is_beyond));
        self.verdict() == TestVerdict::Passed && !self.never_met() && self.runs.iter().any(beyond)
    }

    /// How all of its runs came out together: the worst, where not running is worst.
    pub fn verdict(&self) -> TestVerdict {
        self.runs.iter().map(|run| run.verdict).max().unwrap_or(TestVerdict::NotRun)
    }

    /// The run that stands for all: the one that did the greatest harm among those of the test's verdict, the first of
    /// equals.
    pub fn telling(&self) -> Option<&TestRun> {
        let verdict = self.verdict();
        let harm = |run: &TestRun| run.outcome.as_ref().map_or(0.0, TestOutcome::harm_mps);
        let candidates = self.runs.iter().filter(|run| run.verdict == verdict);
        candidates.reduce(|best, run| if harm(run) > harm(best) { run } else { best })
    }
}

impl TestResults {
    /// How many tests came out so.
    pub fn count(&self, verdict: TestVerdict) -> usize {
        self.tests.iter().filter(|test| test.verdict() == verdict).count()
    }
}
