//! Scenarios to tuned scenarios: the nearest failure that stays true to the record.

use super::cases::{case_seed, scenario, text_of};
use super::{Bench, CaseStage, player};
use crate::error::PipelineError;
use crate::files::json::{to_compact_json, to_json};
use crate::models::cast::{self, AgentLog, RULES};
use crate::suite::names;
use crate::suite::{Files, Stage, Suite};
use recrash_agents::llm::{Repairs, TuneBrief};
use recrash_agents::parameters;
use recrash_lab::{Scoring, is_sound, is_sound_contact};
use recrash_model::run::JudgedRun;
use recrash_model::selection::Cluster;
use recrash_model::tuning::{Aim, TuneLog, TunePoint};
use recrash_search::{Task, TuneOptions};

/// The stage.
pub(super) const DECLARED: CaseStage = CaseStage {
    stage: Stage::Tune,
    reads: |id| {
        vec![
            (Stage::Narrate, names::narrative(id)),
            (Stage::Design, names::scenario(id)),
            (Stage::Simulate, names::first_run(id)),
        ]
    },
    editable: |id| vec![names::tuned(id)],
    decides: |suite| {
        let chosen = suite.options();
        let options = format!("{:?}", tune_options(suite)?);
        let seed = text_of(&chosen.seed);
        Ok(vec![options, text_of(&chosen.aim), seed, player(suite, &chosen.cast.tune), text_of(&chosen.cast.rounds)])
    },
    runs_ego: true,
    work: tune,
};

pub(super) fn tune_options(suite: &Suite) -> Result<TuneOptions, PipelineError> {
    let searcher = suite.options().searcher.parse().map_err(|e: String| PipelineError::bad_input(e))?;
    Ok(TuneOptions { searcher, budget: suite.options().tune_budget })
}

fn tune(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let (suite, id) = (bench.suite, &cluster.scenario_id);
    let options = tune_options(suite)?;
    let (narrative, expectation) = bench.cases.expectation(suite, cluster)?;
    let draft = scenario(suite, id, &names::scenario(id))?.draft().clone();
    let first: JudgedRun = suite.store().read_json(&names::first_run(id))?;
    let parameters = parameters(&draft, &narrative, suite.profile());
    let scoring = Scoring::new(&draft, &parameters, &expectation, suite.profile(), bench.simulator(), &first)
        .aiming_at(suite.options().aim);
    // A contact as designed that is true to the record is what the search looks for, at no distance from the record.
    let sound = is_sound_contact(&first.rollout) && suite.options().aim == Aim::Failure;
    let enough = |point: &TunePoint| point.number == 0 && point.score.refused.is_empty() && sound;
    let seed = case_seed(suite, cluster).child("tune");
    let search = || recrash_search::tune(id, &parameters, options, seed, |values, _| scoring.score(values), enough);
    let cast = &suite.options().cast;
    let (log, agent): (TuneLog, AgentLog) = match suite.models().filter(|_| cast.tune != RULES && !cluster.invented) {
        None => (search(), AgentLog::rules()),
        Some(models) => {
            let (name, repairs) = (&cast.tune, Repairs::default());
            let model = models.model(name, cast, &repairs);
            let records = bench.cases.records_of(cluster);
            let brief = bench.cases.brief(suite, cluster, &records, None);
            let (narrative, draft, metrics) = (&narrative, &draft, &first.metrics);
            let propose = |history: &[TunePoint]| {
                let told = TuneBrief { narrative, draft, metrics, parameters: &parameters, history };
                model.propose(&brief, &told).map(|values| (values, "model"))
            };
            let task = Task { scenario_id: id, parameters: &parameters, seed, searcher: name };
            // A model is asked no more once it has what was looked for.
            let found = |point: &TunePoint| is_sound(&point.score);
            match recrash_search::tune_with(&task, cast.rounds + 1, propose, |v| scoring.score(v), found) {
                Ok(log) => {
                    let agent = AgentLog { needless: log.points.len() == 1, ..AgentLog::model(name, repairs.all()) };
                    (log, agent)
                }
                Err(error) => {
                    let why = cast::unusable(error)?;
                    (search(), AgentLog::fallback(name, repairs.all(), why))
                }
            }
        }
    };
    let tuned = recrash_model::tuning::apply(&draft, &parameters, &log.points[log.best].values)
        .map_err(|e| PipelineError::bad_input(format!("tuned {id}: {e}")))?;
    Ok(vec![
        (names::tuned(id), to_json(&tuned)),
        (names::tune_log(id), to_compact_json(&log)),
        (names::tune_agent(id), to_json(&agent)),
    ])
}
