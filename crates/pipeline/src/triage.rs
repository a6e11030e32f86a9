//! Triage of failures: the other egos drive the same scenario. Defined in `docs/models/triage.md`.

use crate::casework::run_scenario;
use crate::error::PipelineError;
use recrash_model::metrics::{Finding, FindingKind};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_model::triage::{EgoOutcome, REFERENCE_EGO, Triage};
use recrash_roads::Scenario;
use recrash_sim::{Ego, Native};

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
