//! How a batch works.

use crate::handles::Handles;
use crate::reward::Reward;
use crate::view::View;
use recrash_model::profile::SystemProfile;

/// What happens when an episode has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Autoreset {
    /// The next step begins a new one: its action is not used, its reward is 0.
    NextStep,
    /// The same step begins a new one: the last observation is in [`crate::Outputs::final_numbers`].
    SameStep,
    /// Nothing, until somebody resets it.
    Disabled,
}

/// How a batch works.
#[derive(Debug, Clone)]
pub struct Settings {
    /// What drivers are shown.
    pub view: View,
    /// What they answer.
    pub handles: Handles,
    /// What is good and bad.
    pub reward: Reward,
    /// What happens at the end of an episode.
    pub autoreset: Autoreset,
    /// Judges every episode that ended by this profile.
    pub judged_by: Option<SystemProfile>,
    /// Threads, the caller's own among them; 1 starts none.
    pub threads: usize,
}
