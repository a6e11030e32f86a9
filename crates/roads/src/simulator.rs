//! What a simulator is to everybody else: scenarios in, rollouts out, with the system under test inside.

use crate::scenario::Scenario;
use recrash_model::rollout::{Rollout, Substeps};
use std::error::Error;
use std::fmt;

/// A simulator with a system under test in the ego's seat. It may be shared between threads.
///
/// To add one: implement this, for a world where road users appear where a [`Scenario`] has them, do what its plans say,
/// and are written down every 0.1 s as [`Rollout`] says.
pub trait Simulator: Send + Sync {
    /// Its name, such as `native`.
    fn name(&self) -> &str;

    /// Its version, such as `0.4.3`. Rollouts name their simulator by name and version.
    fn version(&self) -> &str;

    /// Name of the system under test in it, as rollouts have it.
    fn ego(&self) -> &str;

    /// Runs a scenario.
    ///
    /// # Errors
    /// There is no rollout, and why. Whatever happens inside a run (a contact, a road left) is no error but data.
    fn run(&self, scenario: &Scenario) -> Result<Rollout, RunError>;

    /// How long the system under test has taken for its answers so far, where it is a program. No rollout depends on it.
    fn answer_times(&self) -> Option<AnswerTimes> {
        None
    }

    /// Runs a scenario with another physics step; decisions stay at every 0.1 s. `None` where the simulator has one only.
    fn run_in(&self, _scenario: &Scenario, _substeps: Substeps) -> Option<Result<Rollout, RunError>> {
        None
    }
}

impl<S: Simulator + ?Sized> Simulator for Box<S> {
    fn name(&self) -> &str {
        (**self).name()
    }

    fn version(&self) -> &str {
        (**self).version()
    }

    fn ego(&self) -> &str {
        (**self).ego()
    }

    fn run(&self, scenario: &Scenario) -> Result<Rollout, RunError> {
        (**self).run(scenario)
    }

    fn answer_times(&self) -> Option<AnswerTimes> {
        (**self).answer_times()
    }

    fn run_in(&self, scenario: &Scenario, substeps: Substeps) -> Option<Result<Rollout, RunError>> {
        (**self).run_in(scenario, substeps)
    }
}

/// How long a system under test takes for an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnswerTimes {
    /// Answers.
    pub answers: usize,
    /// Half of them came sooner. [s]
    pub median_s: f64,
    /// [s]
    pub greatest_s: f64,
}

/// Why there is no rollout of a scenario.
#[derive(Debug)]
pub struct RunError {
    /// The scenario's id.
    pub scenario_id: String,
    /// What went wrong: with a process, a program, or a world that was not as it should be.
    pub why: Box<dyn Error + Send + Sync>,
}

impl RunError {
    /// What a scenario failed of.
    pub fn new(scenario: &Scenario, why: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self { scenario_id: scenario.draft().id.clone(), why: why.into() }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "scenario `{}` could not be run: {}", self.scenario_id, self.why)
    }
}

impl Error for RunError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&*self.why)
    }
}
