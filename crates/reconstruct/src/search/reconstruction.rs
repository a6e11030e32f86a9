//! A crash, reconstructed.

use recrash_model::metrics::{Answer, Check, CheckResult, Verdict};
use recrash_model::rollout::Rollout;
use recrash_model::scenario::ScenarioDraft;

/// A crash, reconstructed.
#[derive(Debug, Clone, PartialEq)]
pub struct Reconstruction {
    /// The scenario, with the recorded driver.
    pub draft: ScenarioDraft,
    /// What it shows.
    pub rollout: Rollout,
    /// Every told fact, and whether it is shown.
    pub verdict: Verdict,
    /// What nobody told, and was chosen.
    pub assumed: Vec<String>,
}

impl Reconstruction {
    /// Whether no told fact is shown otherwise; some may be beyond what can be shown yet.
    pub fn is_true(&self) -> bool {
        self.verdict.faithful() != Answer::No
    }

    /// The first told fact without which this is not the crash: one that is shown otherwise, or something that the two are told to have
    /// done and that is not to be seen. Nothing where the crash is told; others, or why the ego stood, may still not be drawn.
    pub fn missed(&self) -> Option<&Check> {
        self.all_missed().next()
    }

    /// All of them.
    pub fn all_missed(&self) -> impl Iterator<Item = &Check> {
        self.verdict.failures().chain(self.verdict.checks.iter().filter(|check| is_deed_left_open(check)))
    }
}

/// Whether something that the two are told to have done is not to be seen.
fn is_deed_left_open(check: &Check) -> bool {
    check.kind.class().is_deed() && is_left_open(check)
}

/// Whether a stated fact is not to be seen.
pub(super) fn is_left_open(check: &Check) -> bool {
    check.result == CheckResult::CannotBeShown
}
