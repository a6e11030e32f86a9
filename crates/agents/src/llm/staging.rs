//! A scenario that was staged, as a model gets it to look at.

use recrash_model::metrics::Check;
use recrash_model::scenario::ScenarioDraft;

/// A scenario, and what the recorded driver's run of it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Staging {
    /// The scenario.
    pub draft: ScenarioDraft,
    /// The run in words.
    pub replay: String,
    /// Every told fact, and what the run shows of it.
    pub checks: Vec<Check>,
    /// Those without which it is not taken: they are shown otherwise, or no longer.
    pub missed: Vec<Check>,
    /// What was changed in it, change by change: what was told and shown otherwise before.
    pub changed: Vec<String>,
}
