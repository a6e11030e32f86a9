//! The roles played by a language model: it reads reports into accounts, designs scenarios, tunes them, stages anew what a
//! replay does not show as it is told, and holds replays against reports. Whatever it says is checked; what cannot be used goes back to it a bounded number of times, and then the caller lets the rules take over.
//!
//! A role makes a [`Question`]; [`Answers`] answers it: live, from a batch, or from the ledger. So prompts, repairs and
//! fallback are one path for every provider, and a provider is known to
//! `providers.rs` and `wire.rs` only.

mod access;
mod answers;
mod batch;
mod extract;
#[cfg(feature = "live")]
mod fault;
mod form;
#[cfg(feature = "live")]
mod live;
mod prices;
mod prompts;
#[cfg(feature = "live")]
mod providers;
mod question;
mod reading;
mod repairs;
mod restaging;
mod review;
mod schema;
mod secrets;
mod spending;
mod staging;
mod wire;

pub use access::LiveOptions;
pub use answers::{Answers, AskError, Batch, Ledger, Replay, Tried};
pub use batch::{LONGEST_RESPONSE, Responses, request_line};
#[cfg(feature = "live")]
pub use live::Live;
pub use prices::{ModelPrice, PriceTable, plain_name};
pub use prompts::{TuneBrief, version as prompts_version};
pub use question::{Asked, EXCHANGE_FORMAT, Exchange, Purpose, Question, Role, Speaker, Turn};
pub use repairs::Repairs;
pub use secrets::{Scrubber, Secret};
pub use spending::{Caps, Spending, Spent};
pub use staging::Staging;

use crate::{AgentError, Brief, Design, Feedback, Paraphrase, Problem};
use reading::AccountAnswer;
use recrash_model::account::Account;
use recrash_model::narrative::Narrative;
use recrash_model::review::Review;
use recrash_model::scenario::{
    Author, CrossMap, CurveMap, Environment, Obstacle, Partner, RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source,
    StraightMap, TeeMap,
};
use recrash_model::tuning::Parameter;
use recrash_model::{Diagnostic, Outcome};
use restaging::RestageAnswer;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

/// A language model in all roles.
#[derive(Clone, Copy)]
pub struct LanguageModel<'a> {
    /// Model, such as `gpt-5-mini`.
    pub model: &'a str,
    /// Where answers come from.
    pub answers: &'a dyn Answers,
    /// How often an answer that says what cannot be goes back, and how often one of a wrong form, in one role for one scenario.
    pub max_repairs: usize,
    /// Counts the answers that went back.
    pub repairs: &'a Repairs,
}

/// The form of a design: what a model decides of a scenario. `recrash_roads::read_draft` reads it, so it is no type of
/// its own but for the schema.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "only its schema is used")]
struct ScenarioAnswer {
    /// Road map.
    map: MapAnswer,
    /// The subject vehicle.
    ego: EgoAnswer,
    /// Other road users with a script, at most 16.
    partners: Vec<Partner>,
    /// Static obstacles, at most 64.
    #[serde(default)]
    obstacles: Vec<Obstacle>,
    /// Surface, light and weather.
    #[serde(default)]
    environment: Environment,
    /// The rollout ends after this time at the latest, 1 to 120. [s]
    duration_s: f64,
}

/// The maps a model designs on: the paper's blocks.
#[derive(JsonSchema)]
#[schemars(tag = "type")]
#[expect(dead_code, reason = "only its schema is used")]
enum MapAnswer {
    /// Straight road.
    S(StraightMap),
    /// Curve.
    C(CurveMap),
    /// Four-way intersection.
    X(CrossMap),
    /// Three-way intersection.
    T(TeeMap),
    /// Roundabout.
    O(RoundaboutMap),
}

/// What a model decides of the subject vehicle. It starts on the approach road.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "only its schema is used")]
struct EgoAnswer {
    /// Which way it leaves the block.
    turn: recrash_model::scenario::Turn,
    /// Lane, 0 is the leftmost.
    lane: u8,
    /// Start along its lane, from the beginning of the map. [m]
    s_m: f64,
    /// Speed at the start. [m/s]
    speed_mps: f64,
    /// Speed it wants. [m/s]
    target_speed_mps: f64,
}

/// The form of a proposal.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ValuesAnswer {
    /// One value for each parameter, in their order.
    values: Vec<f64>,
}

/// The first question of the role that reads.
///
/// # Errors
/// [`AgentError::Prompt`].
pub fn paraphrase_question(model: &str, brief: &Brief) -> Result<Question, AgentError> {
    question(model, Role::Paraphrase, brief, prompts::paraphrase(brief)?)
}

/// The first question of the role that designs.
///
/// # Errors
/// [`AgentError::Prompt`].
pub fn design_question(model: &str, brief: &Brief, narrative: &Narrative) -> Result<Question, AgentError> {
    question(model, Role::Design, brief, prompts::design(brief, narrative)?)
}

/// A question of the role that tunes.
///
/// # Errors
/// [`AgentError::Prompt`].
pub fn tune_question(model: &str, brief: &Brief, tune: &TuneBrief) -> Result<Question, AgentError> {
    question(model, Role::Tune, brief, prompts::tune(brief.scenario_id, tune)?)
}

/// The first question of the role that reviews. `replay` says in words what the recorded driver's run shows.
///
/// # Errors
/// [`AgentError::Prompt`].
pub fn review_question(model: &str, brief: &Brief, replay: &str) -> Result<Question, AgentError> {
    question(model, Role::Review, brief, prompts::review(brief, replay)?)
}

/// The first question of the role that stages anew.
///
/// # Errors
/// [`AgentError::Prompt`].
pub fn restage_question(model: &str, brief: &Brief, staging: &Staging) -> Result<Question, AgentError> {
    question(model, Role::Restage, brief, prompts::restage(brief, staging)?)
}

fn question(model: &str, role: Role, brief: &Brief, text: String) -> Result<Question, AgentError> {
    let (name, schema) = match role {
        Role::Paraphrase => ("account", schemars::schema_for!(AccountAnswer).to_value()),
        Role::Design => ("scenario", schemars::schema_for!(ScenarioAnswer).to_value()),
        Role::Tune => ("values", schemars::schema_for!(ValuesAnswer).to_value()),
        Role::Restage => ("staging", schemars::schema_for!(RestageAnswer).to_value()),
        Role::Review => ("review", schemars::schema_for!(Review).to_value()),
    };
    let schema = schema::plain(schema);
    Ok(Question {
        model: model.to_owned(),
        purpose: Purpose { role, scenario_id: brief.scenario_id.to_owned(), attempt: 0 },
        system: prompts::system(role, brief.profile)?,
        turns: vec![Turn { speaker: Speaker::User, text }],
        schema_name: name.to_owned(),
        schema,
    })
}

impl LanguageModel<'_> {
    /// Asks, and asks again with what is wrong, until `accept` takes the answer or the repairs are used up. `ours` are fields
    /// that are not the model's to say: they are left out of its answer.
    fn converse<T>(
        &self,
        mut question: Question,
        ours: &[&str],
        accept: impl Fn(Value) -> Result<T, Vec<String>>,
    ) -> Result<T, AgentError> {
        loop {
            let exchange = self.answers.answer(&question)?;
            let (problems, of_form) = match read(&exchange.answer, ours, &question.schema) {
                Err(problems) => (problems, true),
                Ok(value) => match accept(value) {
                    Ok(taken) => return Ok(taken),
                    Err(problems) => (problems, false),
                },
            };
            let granted =
                if of_form { self.repairs.form(self.max_repairs) } else { self.repairs.meaning(self.max_repairs) };
            if !granted {
                return Err(self.no_usable_answer(&problems));
            }
            push_repair(&mut question, exchange.answer, &problems)?;
        }
    }

    fn no_usable_answer(&self, problems: &[String]) -> AgentError {
        let (model, problem) = (self.model.to_owned(), problems.join("; "));
        AgentError::NoUsableAnswer { model, repairs: self.repairs.all(), problem }
    }

    /// Reads the reports of an incident. `base` is what the built-in reader made of it: what the model does not tell stays as it is
    /// there.
    ///
    /// # Errors
    /// [`AgentError`], where the model gives no usable answer.
    pub fn read(&self, brief: &Brief, base: &Account) -> Result<Account, AgentError> {
        self.read_until(brief, base, Ok)
    }

    /// The same, until `accept` takes the account; why it does not goes back to the model.
    ///
    /// # Errors
    /// [`AgentError`], where the model gives no usable answer.
    pub fn read_until<T>(
        &self,
        brief: &Brief,
        base: &Account,
        accept: impl Fn(Account) -> Result<T, String>,
    ) -> Result<T, AgentError> {
        let record = brief.speaker().ok_or(AgentError::NoRecord)?;
        self.converse(paraphrase_question(self.model, brief)?, &[], |value| {
            let answer: AccountAnswer = fitting(value)?;
            accept(reading::account(&answer, base, record, self.model)?).map_err(|why| vec![why])
        })
    }

    /// Holds a replay against the reports of its incident; of the account nothing is said to the model.
    ///
    /// # Errors
    /// [`AgentError`], where the model gives no usable answer.
    pub fn review(&self, brief: &Brief, replay: &str) -> Result<Review, AgentError> {
        self.converse(review_question(self.model, brief, replay)?, &[], |value| review::taken(fitting(value)?))
    }

    /// Proposes the next values of the parameters, given what was tried.
    ///
    /// # Errors
    /// [`AgentError`], where the model gives no usable answer.
    pub fn propose(&self, brief: &Brief, tune: &TuneBrief) -> Result<Vec<f64>, AgentError> {
        let mut question = tune_question(self.model, brief, tune)?;
        // The design is the first try, and nobody's answer.
        question.purpose.attempt = tune.history.len().saturating_sub(1);
        self.converse(question, &[], |value| {
            let answer: ValuesAnswer = fitting(value)?;
            check_values(&answer.values, tune.parameters)?;
            Ok(answer.values)
        })
    }
}

impl Paraphrase for LanguageModel<'_> {
    /// The model reads, the rules write: an account that cannot be staged as the template goes back.
    fn paraphrase(&self, brief: &Brief) -> Result<Outcome<Narrative>, AgentError> {
        let base = brief.account.ok_or(AgentError::NoRecord)?;
        let author = Author::Model(self.model.to_owned());
        let value =
            self.read_until(brief, base, |account| crate::rules::narrative_of(&account, brief, author.clone()))?;
        Ok(Outcome { value, diagnostics: Vec::new() })
    }
}

impl Design for LanguageModel<'_> {
    /// Every earlier try is one more turn of the conversation. Forms are repaired here; what the check and the rollout
    /// say comes back through `feedback`.
    fn design(&self, brief: &Brief, narrative: &Narrative, feedback: &[Feedback]) -> Result<ScenarioDraft, AgentError> {
        let mut question = design_question(self.model, brief, narrative)?;
        for earlier in feedback {
            let draft = prompts::answer_form(&earlier.draft).to_string();
            push_repair(&mut question, draft, &problem_sentences(&earlier.problem))?;
        }
        if let Some(last) = feedback.last()
            && !self.repairs.meaning(self.max_repairs)
        {
            return Err(self.no_usable_answer(&problem_sentences(&last.problem)));
        }
        let draft = self.converse(question, &["format", "id", "source", "traffic"], |mut draft| {
            draft["format"] = json!(SCENARIO_FORMAT);
            draft["id"] = json!(brief.scenario_id);
            draft["source"] = json!({});
            match recrash_roads::read_draft(&draft.to_string()) {
                Ok(outcome) => Ok(outcome.value),
                Err(diagnostics) => Err(sentences(&diagnostics)),
            }
        })?;
        // What names files and says where things came from is ours to say, never the model's.
        Ok(ScenarioDraft {
            format: SCENARIO_FORMAT.to_owned(),
            id: brief.scenario_id.to_owned(),
            source: Source {
                records: narrative.sources(),
                origin: Some(narrative.origin.clone()),
                template: Some(brief.template),
                narrative: narrative.text.clone(),
                author: Author::Model(self.model.to_owned()),
                seed: brief.seed.0,
            },
            ..draft
        })
    }
}

fn push_repair(question: &mut Question, answer: String, problems: &[String]) -> Result<(), AgentError> {
    push_turns(question, answer, prompts::repair(problems)?);
    Ok(())
}

/// Goes on with the conversation: the model's answer, and what is said to it.
fn push_turns(question: &mut Question, answer: String, said: String) {
    // Some providers take no empty turn.
    let answer = if answer.trim().is_empty() { "(no answer)".to_owned() } else { question::bounded_turn(&answer) };
    question.turns.push(Turn { speaker: Speaker::Assistant, text: answer });
    question.turns.push(Turn { speaker: Speaker::User, text: said });
    question.purpose.attempt += 1;
}

/// The answer's object, where it has the form that was asked for; else everything that is wrong with its form.
fn read(answer: &str, ours: &[&str], schema: &Value) -> Result<Value, Vec<String>> {
    let json = extract::json_object(answer).map_err(|why| vec![why])?;
    let mut value: Value = serde_json::from_str(&json).map_err(|e| vec![format!("the answer is no JSON: {e}")])?;
    if let Some(fields) = value.as_object_mut() {
        fields.retain(|name, _| !ours.contains(&name.as_str()));
    }
    let problems = form::problems(&value, schema);
    if problems.is_empty() { Ok(value) } else { Err(problems) }
}

fn fitting<T: for<'de> Deserialize<'de>>(value: Value) -> Result<T, Vec<String>> {
    serde_json::from_value(value).map_err(|e| vec![format!("the answer does not fit the schema: {e}")])
}

fn check_values(values: &[f64], parameters: &[Parameter]) -> Result<(), Vec<String>> {
    if values.len() != parameters.len() {
        return Err(vec![format!("values has {} numbers; there are {} parameters", values.len(), parameters.len())]);
    }
    let outside = values.iter().zip(parameters).filter(|(value, p)| !(p.min..=p.max).contains(*value));
    let problems: Vec<String> =
        outside.map(|(value, p)| format!("{} is {value}; {} to {} is allowed", p.pointer, p.min, p.max)).collect();
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

fn problem_sentences(problem: &Problem) -> Vec<String> {
    match problem {
        Problem::NotRunnable { diagnostics } => sentences(diagnostics),
        Problem::NotFaithful { failures, .. } => failures
            .iter()
            .map(|c| format!("in the rollout, {} is {}; it must be {}", c.kind.label(), c.observed, c.expected))
            .collect(),
    }
}

fn sentences(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().filter(|d| d.is_error()).map(ToString::to_string).collect()
}
