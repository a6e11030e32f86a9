//! Runs of scenarios, judged; and triage of failures: the other egos drive the same scenario (`docs/models/triage.md`).

use crate::error::PipelineError;
use crate::simulator::Simulator;
use recrash_metrics::{faithfulness, findings, measure};
use recrash_model::metrics::{Expectation, Finding, FindingKind};
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::Rollout;
use recrash_model::run::JudgedRun;
use recrash_model::triage::{EgoOutcome, REFERENCE_EGO, Triage};
use recrash_roads::Scenario;
use recrash_sim::{Ego, Native};

/// Runs a scenario and computes everything from its rollout.
///
/// # Errors
/// The simulator failed; the native one cannot.
pub fn run_scenario(
    scenario: &Scenario,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    expectation: Option<&Expectation>,
) -> Result<JudgedRun, PipelineError> {
    let rollout = simulator.run(scenario).map_err(|error| PipelineError::not_run(&error))?;
    Ok(judge(scenario, rollout, profile, expectation))
}

/// Computes everything from a rollout of a scenario, whichever simulator it comes from.
pub(crate) fn judge(
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

/// The triage of a scenario that `system` fails with these findings, and the run of the reference driver where that is another.
///
/// The others drive on the native simulator, whichever the system under test was run on.
///
/// # Errors
/// None: the native simulator cannot fail.
pub fn triage(
    scenario: &Scenario,
    system: &str,
    failed: &[Finding],
    profile: &SystemProfile,
) -> Result<(Triage, Option<JudgedRun>), PipelineError> {
    let mut outcomes = Vec::new();
    let mut reference = None;
    for ego in Ego::ALL.into_iter().filter(|ego| ego.name() != system) {
        let run = run_scenario(scenario, &Native::new(ego), profile, None)?;
        outcomes.push(EgoOutcome {
            ego: ego.name().to_owned(),
            failed: run.failed(),
            avoids: false,
            findings: kinds(&run.findings),
            min_gap: run.metrics.min_gap,
            termination: run.metrics.termination,
            state_hash: run.rollout.state_hash.clone(),
        });
        if ego.name() == REFERENCE_EGO {
            reference = Some(run);
        }
    }
    Ok((Triage::new(&kinds(failed), outcomes), reference))
}

fn kinds(findings: &[Finding]) -> Vec<FindingKind> {
    let mut kinds: Vec<FindingKind> = findings.iter().map(|finding| finding.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}
