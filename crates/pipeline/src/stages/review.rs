//! A language model holds the recorded driver's run of each case against its reports, in a suite that goes by accounts. It changes no
//! scenario and hides none.

use super::cases::scenario;
use super::{
    Bench, CaseStage, Cases, StageReport, StageWork, case_inputs, case_stages, per_case, player, retold, unit_name,
};
use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::models::cast::{AgentLog, unusable};
use crate::progress::ProgressEvent;
use crate::suite::names;
use crate::suite::{Files, Stage, Suite, Work};
use rayon::prelude::*;
use recrash_agents::llm::{Question, Repairs, review_question};
use recrash_agents::{AgentError, Brief};
use recrash_lab::replay;
use recrash_model::account::Account;
use recrash_model::record::CrashRecord;
use recrash_model::review::{Review, ReviewBy};
use recrash_model::run::JudgedRun;
use recrash_model::selection::Cluster;
use serde::{Deserialize, Serialize};

/// The stage, where a model is cast for it.
pub(super) const DECLARED: CaseStage = CaseStage {
    stage: Stage::Review,
    reads: |id| {
        vec![
            (Stage::Narrate, names::account(id)),
            (Stage::Design, names::scenario(id)),
            (Stage::Simulate, names::recorded_run(id)),
        ]
    },
    editable: |_| Vec::new(),
    decides: |suite| Ok(reviewer(suite).map(|model| player(suite, model)).into_iter().collect()),
    runs_ego: false,
    work: review,
};

/// What came of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Reviewed {
    /// Who was asked, and how.
    pub agent: AgentLog,
    /// What it finds; nothing where it gave no usable answer.
    pub review: Option<Review>,
}

impl Reviewed {
    /// The review, and whose it is.
    pub fn by(&self) -> Option<ReviewBy> {
        let review = self.review.clone()?;
        Some(ReviewBy { model: self.agent.asked.clone(), review })
    }
}

/// The model that is cast.
fn reviewer(suite: &Suite) -> Option<&str> {
    suite.options().cast.review.as_deref()
}

/// Runs the stage. Where nobody is cast, what an earlier run left goes.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let declared = case_stages(suite).into_iter().find(|declared| declared.stage == Stage::Review);
    let (Some(declared), Some(model)) = (declared, reviewer(suite)) else {
        let diagnostics = suite.keep_only(Stage::Review, &[], |_| Vec::new())?;
        return Ok(StageReport { diagnostics, ..StageReport::default() });
    };
    let cases = Cases::read(suite)?;
    tell_cost(work, &declared, &cases, model)?;
    per_case(work, &declared, &cases)
}

/// A replay beside its reports.
pub(crate) struct Beside<'a> {
    suite: &'a Suite,
    cases: &'a Cases,
    cluster: &'a Cluster,
    records: Vec<&'a CrashRecord>,
    /// Says which report speaks; nothing else of it is shown.
    account: Account,
    replay: String,
}

impl<'a> Beside<'a> {
    /// Of a case whose recorded run is there.
    ///
    /// # Errors
    /// It is not, or a file cannot be read.
    pub fn read(suite: &'a Suite, cases: &'a Cases, cluster: &'a Cluster) -> Result<Self, PipelineError> {
        let id = &cluster.scenario_id;
        let scenario = scenario(suite, id, &names::scenario(id))?;
        let run: JudgedRun = suite.store().read_json(&names::recorded_run(id))?;
        let replay = replay::in_words(scenario.draft(), &run.rollout);
        let (records, account) = (cases.records_of(cluster), retold::account(suite, id)?);
        Ok(Self { suite, cases, cluster, records, account, replay })
    }

    fn brief(&self) -> Brief<'_> {
        self.cases.brief(self.suite, self.cluster, &self.records, Some(&self.account))
    }

    /// The first question about it.
    ///
    /// # Errors
    /// As [`review_question`].
    pub fn question(&self, model: &str) -> Result<Question, AgentError> {
        review_question(model, &self.brief(), &self.replay)
    }
}

fn review(bench: &Bench, cluster: &Cluster) -> Result<Files, PipelineError> {
    let (suite, id) = (bench.suite, &cluster.scenario_id);
    let Some((models, model)) = suite.models().zip(reviewer(suite)) else { return Ok(Vec::new()) };
    let shown = Beside::read(suite, bench.cases, cluster)?;
    let repairs = Repairs::default();
    let asked = models.model(model, &suite.options().cast, &repairs);
    let reviewed = match asked.review(&shown.brief(), &shown.replay) {
        Ok(review) => Reviewed { agent: AgentLog::model(model, repairs.all()), review: Some(review) },
        Err(error) => Reviewed { agent: AgentLog::fallback(model, repairs.all(), unusable(error)?), review: None },
    };
    Ok(vec![(names::review(id), to_json(&reviewed))])
}

/// Says before the first question how many replays are read, and what that costs.
fn tell_cost(work: &StageWork, declared: &CaseStage, cases: &Cases, model: &str) -> Result<(), PipelineError> {
    let suite = work.suite;
    let clusters = cases.up_to(suite, Stage::Review);
    let bytes = |cluster: &&Cluster| -> Result<Option<usize>, PipelineError> {
        let id = &cluster.scenario_id;
        let (name, inputs) = (unit_name(Stage::Review, id), case_inputs(suite, declared, cases, cluster)?);
        let unit = Work { name: &name, inputs: &inputs, editable: &[] };
        if suite.must_be_current(Stage::Review, &unit).is_ok() {
            return Ok(None);
        }
        let shown = Beside::read(suite, cases, cluster)?;
        Ok(Some(shown.question(model).map_or(0, |question| question.bytes())))
    };
    let all: Vec<Option<usize>> = clusters.par_iter().map(bytes).collect::<Result<_, _>>()?;
    let unread: Vec<usize> = all.into_iter().flatten().collect();
    if let (Some(models), false) = (suite.models(), unread.is_empty()) {
        let cost = models.estimate(model, unread.iter().sum(), unread.len());
        let what = format!("{model} reads {} of {} replays beside their reports: {cost}", unread.len(), clusters.len());
        work.progress.event(ProgressEvent::Said { what: &what });
    }
    Ok(())
}
