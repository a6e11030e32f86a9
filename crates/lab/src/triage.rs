//! Triage of failures: the other egos drive the same scenario. Defined in `docs/models/triage.md`.

use crate::judging::run_scenario;
use recrash_model::metrics::{Finding, FindingKind};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_model::triage::{EgoOutcome, Fared, REFERENCE_EGO, Triage};
use recrash_roads::{RunError, Scenario, Simulator};

/// The triage of a scenario that the system under test fails in this run, and the run of the reference driver where that is another.
///
/// The others are simulators with another ego each, whichever simulator the system under test was run on.
///
/// # Errors
/// One of the others could not be run.
pub fn triage(
    scenario: &Scenario,
    failed: &JudgedRun,
    profile: &SystemProfile,
    others: &[Box<dyn Simulator>],
) -> Result<(Triage, Option<JudgedRun>), RunError> {
    let mut outcomes = Vec::new();
    let mut reference = None;
    for other in others.iter().filter(|other| other.ego() != failed.ego) {
        let run = run_scenario(scenario, other, profile, None)?;
        outcomes.push(EgoOutcome {
            ego: other.ego().to_owned(),
            failed: run.failed(),
            fared: Fared::of(failed, &run),
            findings: kinds(&run.findings),
            min_gap: run.least_gap(),
            termination: run.metrics.termination,
            state_hash: run.rollout.state_hash.clone(),
        });
        if other.ego() == REFERENCE_EGO {
            reference = Some(run);
        }
    }
    Ok((Triage::new(outcomes), reference))
}

fn kinds(findings: &[Finding]) -> Vec<FindingKind> {
    let mut kinds: Vec<FindingKind> = findings.iter().map(|finding| finding.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}
