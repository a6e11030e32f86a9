//! Many scenarios, run and judged on all threads.

use crate::error::PipelineError;
use crate::simulators::Simulator;
use rayon::prelude::*;
use recrash_lab::run_scenario;
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_roads::Scenario;

/// Runs scenarios in the order given. What one fails of stands in its place, and the others go on.
pub fn run_many(
    scenarios: &[&Scenario],
    simulator: &dyn Simulator,
    profile: &SystemProfile,
) -> Vec<Result<JudgedRun, PipelineError>> {
    scenarios.par_iter().map(|scenario| Ok(run_scenario(scenario, simulator, profile, None)?)).collect()
}
