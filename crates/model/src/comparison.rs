//! Two results of one frozen suite, held against each other. Defined in `docs/models/comparison.md`.

use crate::account::CrashType;
use crate::metrics::FindingKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The comparisons' format tag.
pub const COMPARISON_FORMAT: &str = "recrash.comparison/1";

/// What became of a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// It passed and fails.
    Broken,
    /// It fails or passes as before, and worse.
    Worse,
    /// It failed and passes.
    Fixed,
    /// It fails or passes as before, and better.
    Better,
    /// Its runs come out differently by chance alone, as far as they can tell.
    Flaky,
    /// It came into the situation of its record, or failed, and now does neither: whether it is better is not told.
    Unmet,
    /// It gave a rollout on one side only, or on neither.
    NotRun,
    /// The test itself is another one.
    Changed,
    /// It is new.
    Added,
    /// It is gone.
    Removed,
    /// As before.
    Same,
}

impl Change {
    /// Every change, in the order of tables.
    pub const ALL: [Self; 11] = [
        Self::Broken,
        Self::Worse,
        Self::Fixed,
        Self::Better,
        Self::Flaky,
        Self::Unmet,
        Self::NotRun,
        Self::Changed,
        Self::Added,
        Self::Removed,
        Self::Same,
    ];

    /// Its name in files and options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Broken => "broken",
            Self::Worse => "worse",
            Self::Fixed => "fixed",
            Self::Better => "better",
            Self::Flaky => "flaky",
            Self::Unmet => "unmet",
            Self::NotRun => "not_run",
            Self::Changed => "changed",
            Self::Added => "added",
            Self::Removed => "removed",
            Self::Same => "same",
        }
    }

    /// For sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Unmet => "not met",
            Self::NotRun => "not run",
            _ => self.name(),
        }
    }
}

impl std::str::FromStr for Change {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        let found = Self::ALL.into_iter().find(|change| change.name() == name);
        found.ok_or_else(|| format!("there is no change \"{name}\"; there are: {}", names()))
    }
}

/// How one side of a test came out.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Side {
    /// Runs that gave a rollout.
    pub runs: usize,
    /// Of those, the ones that failed.
    pub failures: usize,
    /// Kinds of findings of the telling run.
    pub findings: Vec<FindingKind>,
    /// Its least gap. [m]
    pub least_gap_m: Option<f64>,
    /// The greater delta-v of its contact; 0 without one. [m/s]
    pub delta_v_mps: f64,
}

/// One test on both sides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// The test.
    pub id: String,
    /// Its crash type, where it is known.
    pub crash_type: Option<CrashType>,
    /// What became of it.
    pub change: Change,
    /// In a few words.
    pub why: String,
    /// Before; absent where it was not there.
    pub base: Option<Side>,
    /// Now; absent where it is gone.
    pub new: Option<Side>,
    /// How probable it is that shares that differ so come from one; absent where nothing is random.
    pub p: Option<f64>,
    /// Whether every run drove the same, state by state.
    pub identical: bool,
}

/// How many tests of one crash type changed how.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TypeRow {
    /// Crash type, for tables.
    pub crash_type: &'static str,
    /// Tests.
    pub tests: usize,
    /// Failed before.
    pub base_failed: usize,
    /// Failed now.
    pub new_failed: usize,
    /// By change; those without any are left out.
    pub changes: BTreeMap<Change, usize>,
    /// McNemar's exact p of broken against fixed.
    pub p: f64,
}

/// Two results, compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Always [`COMPARISON_FORMAT`].
    pub format: &'static str,
    /// Egos of both.
    pub egos: [String; 2],
    /// Simulators of both.
    pub simulators: [String; 2],
    /// Suites of both, by content.
    pub suites: [String; 2],
    /// The greatest p of a test that counts, held against all tests that have one; absent where none has.
    pub level: Option<f64>,
    /// Over all tests.
    pub all: TypeRow,
    /// By crash type, in the order of tables.
    pub by_type: Vec<TypeRow>,
    /// Every test, by id.
    pub tests: Vec<Compared>,
}

impl Comparison {
    /// Tests that changed so, the most harmful first, then by id.
    pub fn of(&self, change: Change) -> Vec<&Compared> {
        let mut tests: Vec<&Compared> = self.tests.iter().filter(|test| test.change == change).collect();
        tests.sort_by(|a, b| b.harm_mps().total_cmp(&a.harm_mps()));
        tests
    }

    /// Tests that were on both sides with the same content, so that they can be compared at all.
    pub fn comparable(&self) -> impl Iterator<Item = &Compared> {
        let apart = [Change::Changed, Change::Added, Change::Removed];
        self.tests.iter().filter(move |test| !apart.contains(&test.change))
    }
}

impl Compared {
    /// Whether it gave a rollout for the baseline.
    pub fn ran_before(&self) -> bool {
        self.base.as_ref().is_some_and(|side| side.runs > 0)
    }

    /// The greater delta-v of both sides. [m/s]
    pub fn harm_mps(&self) -> f64 {
        [&self.base, &self.new].into_iter().flatten().map(|side| side.delta_v_mps).fold(0.0, f64::max)
    }
}

/// A probability as tables tell it: no probability is 0.
pub fn shown_p(p: f64) -> String {
    if p < 0.001 { "<0.001".to_owned() } else { format!("{p:.3}") }
}
