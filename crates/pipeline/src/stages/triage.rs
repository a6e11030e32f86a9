//! Tuned scenarios to judged runs; and where the system fails, how the other egos fare there.

use super::cases::scenario;
use super::{Bench, CaseStage};
use crate::error::PipelineError;
use crate::files::json::{to_compact_json, to_json};
use crate::simulators::built_in;
use crate::suite::names;
use crate::suite::{Files, Stage};
use recrash_drivers::preventability;
use recrash_lab::{run_scenario, triage};
use recrash_model::selection::Cluster;
use recrash_model::triage::TRIAGE_FORMAT;

/// The stage.
pub(super) const DECLARED: CaseStage = CaseStage {
    stage: Stage::Triage,
    reads: |id| vec![(Stage::Narrate, names::narrative(id)), (Stage::Tune, names::tuned(id))],
    editable: |_| Vec::new(),
    decides: |_| Ok(vec![TRIAGE_FORMAT.to_owned()]),
    runs_ego: true,
    work,
};

fn work(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let (suite, id) = (bench.suite, &cluster.scenario_id);
    let (_, expectation) = bench.cases.expectation(suite, cluster)?;
    let scenario = scenario(suite, id, &names::tuned(id))?;
    let mut run = run_scenario(&scenario, bench.simulator(), suite.profile(), Some(&expectation))?;
    run.judgement.preventability = preventability(&run.rollout);
    let mut files = vec![(names::tuned_run(id), to_compact_json(&run))];
    if run.failed() {
        let (triage, reference) = triage(&scenario, &run, suite.profile(), &built_in())?;
        files.push((names::triage(id), to_json(&triage)));
        files.extend(reference.map(|run| (names::reference_run(id), to_compact_json(&run))));
    }
    Ok(files)
}
