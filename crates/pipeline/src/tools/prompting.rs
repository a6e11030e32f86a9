//! What a model would be asked, shown without asking it.

use crate::error::{Choice, PipelineError};
use crate::models::cast::RULES;
use crate::options::Options;
use crate::progress::NoProgress;
use crate::reading::scenarios::read_scenario;
use crate::stages::{Beside, Cases, restage_question, run_stage};
use crate::suite::names;
use crate::suite::{Resources, Stage, Suite};
use recrash_agents::llm::{
    Question, Role, TuneBrief, design_question, paraphrase_question, prompts_version, tune_question,
};
use recrash_agents::{AgentError, Brief, Design, Paraphrase, Rules, expectation, parameters};
use recrash_lab::Scoring;
use recrash_lab::run_scenario;
use recrash_model::account::Account;
use recrash_model::narrative::Narrative;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::Cluster;
use recrash_model::tuning::TunePoint;
use recrash_roads::Scenario;
use serde::Serialize;
use std::path::PathBuf;

/// Which question is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct PromptRequest {
    /// Folder of the suite; where there is none, the records of `options` are read and selected from.
    pub dir: PathBuf,
    /// Options for where there is no suite.
    pub options: Options,
    /// Role.
    pub role: Role,
    /// Model; the suite's where not given.
    pub model: Option<String>,
    /// Scenario; the first where neither it nor a record is given.
    pub scenario: Option<String>,
    /// Record, such as `30270-7733/2`.
    pub record: Option<String>,
}

/// A question, as it would be sent first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Prompt {
    /// Always `recrash.prompt/1`.
    pub format: String,
    /// Hash of the prompt files.
    pub prompts: String,
    /// Hash of the question: its name in the ledger and in batch files.
    pub hash: String,
    /// The question.
    pub question: Question,
}

/// Makes the first question of a role. What a stage of the suite has not made yet, the rules make for the purpose.
///
/// # Errors
/// There is no such scenario or record, or the suite cannot be read.
pub fn prompt(request: &PromptRequest) -> Result<Prompt, PipelineError> {
    let scratch = tempfile::tempdir();
    let suite = match Suite::saved_options(&request.dir)? {
        Some(_) => Suite::look(&request.dir)?,
        None => {
            let failed = |source| PipelineError::Io { action: "create", path: std::env::temp_dir(), source };
            let scratch = scratch.as_ref().map_err(|e| failed(std::io::Error::from(e.kind())))?;
            let suite = Suite::open(scratch.path(), request.options.clone(), Resources::default())?;
            run_stage(&suite, Stage::Records, &NoProgress)?;
            run_stage(&suite, Stage::Select, &NoProgress)?;
            suite
        }
    };
    let cases = Cases::read(&suite)?;
    let cluster = find(request, &cases)?;
    let records = cases.records_of(&cluster);
    let account = Cases::read_by_rules(&records);
    let brief = cases.brief(&suite, &cluster, &records, account.as_ref());
    let cast = &suite.options().cast;
    let played = match request.role {
        Role::Paraphrase => cast.paraphrase.as_str(),
        Role::Design | Role::Restage => &cast.design,
        Role::Tune => &cast.tune,
        Role::Review => cast.review.as_deref().unwrap_or(RULES),
    };
    let model = match &request.model {
        Some(model) => model,
        None if played == RULES => "MODEL",
        None => played,
    };
    let question = match request.role {
        Role::Review => about_replay(&suite, &cases, &cluster, model)?,
        Role::Restage => about_staging(&suite, &cases, &cluster, model)?,
        role => question(&suite, &brief, role, model)?,
    };
    Ok(Prompt { format: "recrash.prompt/1".into(), prompts: prompts_version(), hash: question.hash(), question })
}

fn find(request: &PromptRequest, cases: &Cases) -> Result<Cluster, PipelineError> {
    let clusters = &cases.selection.clusters;
    if let Some(id) = &request.record {
        let known = |cluster: &&Cluster| cluster.pick.to_string() == *id;
        if let Some(cluster) = clusters.iter().find(known) {
            return Ok(cluster.clone());
        }
        let records = &cases.records.records;
        let found = records.iter().enumerate().find(|(_, record)| record.id.to_string() == *id);
        let Some((pick_index, record)) = found else {
            return Err(PipelineError::choose(format!("there is no record {id}"), Choice::Record));
        };
        let template = record.template().ok_or_else(|| {
            PipelineError::bad_input(format!("record {id} has no template: its columns name no road or movement"))
        })?;
        let (pick, members) = (record.id.clone(), vec![pick_index]);
        let scenario_id = format!("00-{}", record.id.report_id);
        return Ok(Cluster {
            number: 0,
            scenario_id,
            template,
            pick,
            pick_index,
            members,
            radius: 0.0,
            invented: false,
        });
    }
    let wanted = |cluster: &&Cluster| request.scenario.as_ref().is_none_or(|id| cluster.scenario_id == *id);
    clusters.iter().find(wanted).cloned().ok_or_else(|| {
        let ids: Vec<&str> = clusters.iter().map(|cluster| cluster.scenario_id.as_str()).collect();
        PipelineError::bad_input(format!("there is no such scenario; there are: {}", ids.join(", ")))
    })
}

fn question(suite: &Suite, brief: &Brief, role: Role, model: &str) -> Result<Question, PipelineError> {
    let failed = |e: AgentError| PipelineError::bad_input(e.to_string());
    if role == Role::Paraphrase {
        return paraphrase_question(model, brief).map_err(failed);
    }
    let narrative = match stored::<Narrative>(suite, &names::narrative(brief.scenario_id)) {
        Some(narrative) => narrative,
        None => Rules.paraphrase(brief).map_err(failed)?.value,
    };
    if role == Role::Design {
        return design_question(model, brief, &narrative).map_err(failed);
    }
    let scenario = designed(suite, brief, &narrative)?;
    let expectation = expectation(&narrative, brief.records[0], brief.profile);
    let simulator = suite.simulator()?;
    let first = match stored::<JudgedRun>(suite, &names::first_run(brief.scenario_id)) {
        Some(run) => run,
        None => run_scenario(&scenario, &*simulator, brief.profile, Some(&expectation))?,
    };
    let draft: &ScenarioDraft = scenario.draft();
    let parameters = parameters(draft, &narrative, brief.profile);
    let scoring = Scoring::new(draft, &parameters, &expectation, brief.profile, &*simulator, &first);
    let values: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let score = scoring.score(&values);
    let history = [TunePoint { number: 0, proposed_by: "start".into(), values, score }];
    let (narrative, metrics, parameters) = (&narrative, &first.metrics, parameters.as_slice());
    let told = TuneBrief { narrative, draft, metrics, parameters, history: &history };
    tune_question(model, brief, &told).map_err(failed)
}

/// A question about a replay: there is none before the recorded driver was run.
fn about_replay(suite: &Suite, cases: &Cases, cluster: &Cluster, model: &str) -> Result<Question, PipelineError> {
    let id = &cluster.scenario_id;
    if stored::<JudgedRun>(suite, &names::recorded_run(id)).is_none() {
        return Err(PipelineError::bad_input(format!(
            "there is no replay of {id} yet: run a suite that goes by accounts, and name its folder"
        )));
    }
    let question = Beside::read(suite, cases, cluster)?.question(model);
    question.map_err(|e: AgentError| PipelineError::bad_input(e.to_string()))
}

/// A question about what the rules staged: there is none before they did, of a suite that goes by accounts.
fn about_staging(suite: &Suite, cases: &Cases, cluster: &Cluster, model: &str) -> Result<Question, PipelineError> {
    let id = &cluster.scenario_id;
    if stored::<Account>(suite, &names::account(id)).is_none() {
        return Err(PipelineError::bad_input(format!(
            "nothing is staged of {id} yet: run a suite that goes by accounts, and name its folder"
        )));
    }
    restage_question(suite, cases, cluster, model)
}

fn designed(suite: &Suite, brief: &Brief, narrative: &Narrative) -> Result<Scenario, PipelineError> {
    let file = suite.store().path(&names::scenario(brief.scenario_id));
    if file.exists() {
        return Ok(read_scenario(&file)?.0);
    }
    let draft = Rules.design(brief, narrative, &[]).map_err(|e| PipelineError::bad_input(e.to_string()))?;
    let checked = recrash_roads::check(draft);
    let what = || format!("the rules' design of {} cannot be run", brief.scenario_id);
    Ok(checked.map_err(|diagnostics| PipelineError::BadInput { what: what(), diagnostics })?.value)
}

/// What a stage wrote; nothing where it has not.
fn stored<T: serde::de::DeserializeOwned>(suite: &Suite, file: &str) -> Option<T> {
    suite.store().read_json(file).ok()
}
