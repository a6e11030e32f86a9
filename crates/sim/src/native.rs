//! The native simulator behind the door that all simulators have.

use crate::ego::Ego;
use crate::recorder::{self, RolloutRecorder};
use crate::runner::Runner;
use recrash_model::rollout::{Rollout, Substeps};
use recrash_roads::{RunError, Scenario, Simulator};
use std::sync::{Mutex, PoisonError};

/// The native simulator with a built-in ego. It never fails.
#[derive(Debug)]
pub struct Native {
    ego: Ego,
    /// Memory of runs that are over, at most one for each thread.
    idle: Mutex<Vec<Runner>>,
}

impl Native {
    /// Its name in rollouts.
    pub const NAME: &'static str = recorder::NAME;

    /// Its version in rollouts.
    pub const VERSION: &'static str = recorder::VERSION;

    /// With this ego.
    pub const fn new(ego: Ego) -> Self {
        Self { ego, idle: Mutex::new(Vec::new()) }
    }

    fn rollout(&self, scenario: &Scenario, substeps: Substeps) -> Rollout {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut runner = idle.unwrap_or_default().stepping(substeps);
        let mut recorder = RolloutRecorder::new();
        runner.run(scenario, self.ego, &mut recorder);
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(runner);
        recorder.finish().unwrap_or_else(|| unreachable!("a run begins and ends"))
    }
}

impl Simulator for Native {
    fn name(&self) -> &str {
        Self::NAME
    }

    fn version(&self) -> &str {
        Self::VERSION
    }

    fn ego(&self) -> &str {
        self.ego.name()
    }

    fn run(&self, scenario: &Scenario) -> Result<Rollout, RunError> {
        Ok(self.rollout(scenario, Substeps::default()))
    }

    fn run_in(&self, scenario: &Scenario, substeps: Substeps) -> Option<Result<Rollout, RunError>> {
        Some(Ok(self.rollout(scenario, substeps)))
    }
}
