//! Many scenarios, run and judged on as many threads as the caller likes.

use crate::error::PipelineError;
use crate::simulators::Simulator;
use crate::suite::thread_pool;
use rayon::prelude::*;
use recrash_lab::run_scenario;
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_roads::Scenario;

/// Runs scenarios in the order given. What one fails of stands in its place, and the others go on.
///
/// # Errors
/// There cannot be so many threads.
pub fn run_many(
    scenarios: &[&Scenario],
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    threads: usize,
) -> Result<Vec<Result<JudgedRun, PipelineError>>, PipelineError> {
    let run = |scenario: &&Scenario| Ok(run_scenario(scenario, simulator, profile, None)?);
    Ok(thread_pool(threads)?.install(|| scenarios.par_iter().map(run).collect()))
}
