//! Picks to narratives.

use super::cases::text_of;
use super::{Bench, CaseStage, Cases, player};
use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::models::cast;
use crate::suite::names;
use crate::suite::{Files, Stage};
use recrash_model::selection::Cluster;

/// The stage.
pub(super) const DECLARED: CaseStage = CaseStage {
    stage: Stage::Narrate,
    reads: |_| Vec::new(),
    editable: |id| vec![names::narrative(id)],
    decides: |suite| {
        let chosen = suite.options();
        Ok(vec![text_of(&chosen.seed), player(suite, &chosen.cast.paraphrase)])
    },
    runs_ego: false,
    work: narrate,
};

fn narrate(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let suite = bench.suite;
    let records = bench.cases.records_of(cluster);
    let by_model = suite.options().cast.paraphrase != cast::RULES;
    let account = if by_model { Cases::read_by_rules(&records) } else { None };
    let brief = bench.cases.brief(suite, cluster, &records, account.as_ref());
    let (narrative, log) = cast::paraphrase(suite.models(), &suite.options().cast, &brief)?;
    let id = &cluster.scenario_id;
    Ok(vec![(names::narrative(id), to_json(&narrative)), (names::narrative_log(id), to_json(&log))])
}
