//! Triage of failures: the other egos drive the same scenario. Defined in `docs/models/triage.md`.

use crate::judging::run_scenario;
use recrash_model::metrics::{Finding, FindingKind};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_model::triage::{EgoOutcome, REFERENCE_EGO, Triage};
use recrash_roads::{RunError, Scenario, Simulator};

/// The triage of a scenario that `system` fails with these findings, and the run of the reference driver where that is another.
///
/// The others are simulators with another ego each, whichever simulator the system under test was run on.
///
/// # Errors
/// One of the others could not be run.
pub fn triage(
    scenario: &Scenario,
    system: &str,
    failed: &[Finding],
    profile: &SystemProfile,
    others: &[Box<dyn Simulator>],
) -> Result<(Triage, Option<JudgedRun>), RunError> {
    let mut outcomes = Vec::new();
    let mut reference = None;
    for other in others.iter().filter(|other| other.ego() != system) {
        let run = run_scenario(scenario, other, profile, None)?;
        outcomes.push(EgoOutcome {
            ego: other.ego().to_owned(),
            failed: run.failed(),
            avoids: false,
            findings: kinds(&run.findings),
            min_gap: run.metrics.min_gap,
            termination: run.metrics.termination,
            state_hash: run.rollout.state_hash.clone(),
        });
        if other.ego() == REFERENCE_EGO {
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
