//! Runs of scenarios, judged: whichever simulator gave the rollout, what is measured and said is the same.

use recrash_metrics::{faithfulness, findings, measure};
use recrash_model::metrics::Expectation;
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::Rollout;
use recrash_model::run::JudgedRun;
use recrash_roads::{RunError, Scenario, Simulator};

/// Runs a scenario and computes everything from its rollout.
///
/// # Errors
/// The simulator failed; the native one cannot.
pub fn run_scenario(
    scenario: &Scenario,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    expectation: Option<&Expectation>,
) -> Result<JudgedRun, RunError> {
    Ok(judge(scenario, simulator.run(scenario)?, profile, expectation))
}

/// Computes everything from a rollout of a scenario, whichever simulator it comes from.
pub fn judge(
    scenario: &Scenario,
    rollout: Rollout,
    profile: &SystemProfile,
    expectation: Option<&Expectation>,
) -> JudgedRun {
    let metrics = measure(scenario, &rollout, &profile.failure);
    let found = findings(scenario, &rollout, &metrics, &profile.failure);
    let verdict = expectation.map(|e| faithfulness(scenario, &rollout, &metrics, e)).unwrap_or_default();
    JudgedRun::new(rollout, metrics, found, verdict)
}
