//! Many scenarios, run and judged on as many threads as the caller likes.

use crate::error::PipelineError;
use crate::simulators::Simulator;
use crate::suite::thread_pool;
use rayon::prelude::*;
use recrash_lab::{run_scenario, situation};
use recrash_model::metrics::FindingKind;
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_roads::Scenario;
use recrash_sim::{Ego, Native};

/// Runs scenarios in the order given, and asks of each run whether it came into the situation of its record. What one fails of stands in its place, and the others go on.
///
/// # Errors
/// There cannot be so many threads.
pub fn run_many(
    scenarios: &[&Scenario],
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    threads: usize,
) -> Result<Vec<Result<JudgedRun, PipelineError>>, PipelineError> {
    let run = |scenario: &&Scenario| {
        let mut run = run_scenario(scenario, simulator, profile, None)?;
        ask_for_situation(scenario, &mut run, profile);
        Ok(run)
    };
    Ok(thread_pool(threads)?.install(|| scenarios.par_iter().map(run).collect()))
}

/// Asks of a run whether it came into the situation of its record: that of the recorded driver's crash, where there is one
/// and somebody is tested.
pub fn ask_for_situation(scenario: &Scenario, run: &mut JudgedRun, profile: &SystemProfile) {
    if scenario.draft().is_tested()
        && let Some(recorded) = recorded_crash(scenario, profile)
    {
        let check = situation(run, &recorded);
        run.judgement.verdict.checks.push(check);
    }
}

/// The recorded driver's run, where it crashes: the situation that a system under test is to come into.
pub(crate) fn recorded_crash(scenario: &Scenario, profile: &SystemProfile) -> Option<JudgedRun> {
    scenario.draft().ego.recorded.as_ref()?;
    let run = run_scenario(scenario, &Native::new(Ego::Recorded), profile, None).ok()?;
    run.finding_kinds().into_iter().any(FindingKind::is_crash).then_some(run)
}
