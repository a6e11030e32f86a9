//! Runs of scenarios, judged: whichever simulator gave the rollout, what is measured and said is the same.

use crate::causes::cause;
use recrash_metrics::{faithfulness, findings, measure, severity_of};
use recrash_model::metrics::{Check, CheckKind, CheckResult, Expectation, Timed, Verdict};
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::{Rollout, Substeps};
use recrash_model::run::JudgedRun;
use recrash_roads::{RunError, Scenario, Simulator};

/// Runs a scenario and computes everything from its rollout. Where there is nothing to test, simulators let the recorded
/// driver drive, and the run has no failure.
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

/// The same with another physics step; `None` where the simulator has one only.
///
/// # Errors
/// As [`run_scenario`].
pub fn run_scenario_in(
    scenario: &Scenario,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
    substeps: Substeps,
) -> Result<Option<JudgedRun>, RunError> {
    let rollout = simulator.run_in(scenario, substeps).transpose()?;
    Ok(rollout.map(|rollout| judge(scenario, rollout, profile, None)))
}

/// Computes everything from a rollout of a scenario, whichever simulator it comes from.
pub fn judge(
    scenario: &Scenario,
    rollout: Rollout,
    profile: &SystemProfile,
    expectation: Option<&Expectation>,
) -> JudgedRun {
    let mut run = judge_by(scenario, rollout, profile, Verdict::default());
    if let Some(expectation) = expectation {
        run.judgement.verdict = faithfulness(scenario, &run.rollout, &run.metrics, expectation);
    }
    run
}

/// The same, with a verdict from elsewhere.
pub fn judge_by(scenario: &Scenario, rollout: Rollout, profile: &SystemProfile, verdict: Verdict) -> JudgedRun {
    let metrics = measure(scenario, &rollout, &profile.failure);
    let handover_s = scenario.draft().ego.handover_s.unwrap_or(0.0);
    let found = findings(&rollout, handover_s, &metrics, &profile.failure);
    let severity = severity_of(&rollout, &metrics);
    let cause = cause(scenario.network(), &rollout, &metrics, &found);
    let mut run = JudgedRun::new(rollout, metrics, found, severity, verdict);
    run.judgement.cause = cause;
    run.judgement.parked = !scenario.draft().is_tested();
    run
}

/// Nearer than this to what it crashed with in the record, the ego is in the situation of the record. [m]
const MET_GAP_M: f64 = 3.0;
/// So it is with less time than this to a collision. [s]
const MET_TTC_S: f64 = 4.0;

/// Whether the system under test came into the situation of its record: after the handover, before which nothing is measured, it
/// came so near to what the recorded driver crashed with, or had so little time to a collision with it, that it had to deal
/// with it.
pub fn situation(run: &JudgedRun, recorded: &JudgedRun) -> Check {
    let (gap, soon) = match &recorded.metrics.contact {
        Some(contact) => {
            let of = run.metrics.partners.iter().find(|partner| partner.actor == contact.actor);
            (of.map(|of| of.min_gap), of.and_then(|of| of.min_ttc).is_some_and(|ttc| ttc.value <= MET_TTC_S))
        }
        None => (least_obstacle_gap(run, &recorded.metrics.obstacles_hit), false),
    };
    let met = soon || gap.is_some_and(|gap| gap.value <= MET_GAP_M);
    let observed = gap.map_or("never near".to_owned(), |gap| format!("{:.1} m apart at the nearest", gap.value));
    Check {
        kind: CheckKind::Situation,
        expected: format!("within {MET_GAP_M:.0} m or {MET_TTC_S:.0} s of what it crashed with"),
        observed,
        result: if met { CheckResult::Shown } else { CheckResult::NotShown },
    }
}

/// The least gap to the obstacles that were hit; to any, where none was.
fn least_obstacle_gap(run: &JudgedRun, hit: &[usize]) -> Option<Timed> {
    let gaps = run.metrics.obstacle_gaps.iter().enumerate();
    let of = gaps.filter(|(obstacle, _)| hit.is_empty() || hit.contains(obstacle)).map(|(_, gap)| *gap);
    of.min_by(|a, b| a.value.total_cmp(&b.value))
}
