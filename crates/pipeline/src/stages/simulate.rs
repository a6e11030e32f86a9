//! Scenarios to judged runs.

use super::cases::scenario;
use super::{Bench, CaseStage};
use crate::error::PipelineError;
use crate::files::json::to_compact_json;
use crate::suite::names;
use crate::suite::{Files, Stage};
use recrash_drivers::preventability;
use recrash_lab::run_scenario;
use recrash_model::selection::Cluster;

/// The stage.
pub(super) const DECLARED: CaseStage = CaseStage {
    stage: Stage::Simulate,
    reads: |id| vec![(Stage::Narrate, names::narrative(id)), (Stage::Design, names::scenario(id))],
    editable: |_| Vec::new(),
    decides: |_| Ok(Vec::new()),
    runs_ego: true,
    work: simulate,
};

fn simulate(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let id = &cluster.scenario_id;
    let (_, expectation) = bench.cases.expectation(bench.suite, cluster)?;
    let checked = scenario(bench.suite, id, &names::scenario(id))?;
    let mut run = run_scenario(&checked, bench.simulator(), bench.suite.profile(), Some(&expectation))?;
    run.judgement.preventability = preventability(&run.rollout);
    Ok(vec![(names::first_run(id), to_compact_json(&run))])
}
