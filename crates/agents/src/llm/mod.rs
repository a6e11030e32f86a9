//! The roles played by a language model. Whatever it says is checked; what cannot be used goes back to it a bounded number
//! of times, and then the caller lets the rules take over.
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
#[cfg(feature = "live")]
mod live;
mod prices;
mod prompts;
#[cfg(feature = "live")]
mod providers;
mod question;
mod schema;
mod secrets;
mod spending;
mod wire;

pub use access::LiveOptions;
pub use answers::{Answers, AskError, Batch, Ledger, Replay, Tried};
pub use batch::{LONGEST_RESPONSE, Responses, request_line};
#[cfg(feature = "live")]
pub use live::Live;
pub use prices::{ModelPrice, PriceTable, plain_name};
pub use prompts::{TuneBrief, version as prompts_version};
pub use question::{Asked, EXCHANGE_FORMAT, Exchange, Purpose, Question, Role, Speaker, Turn};
pub use secrets::{Scrubber, Secret};
pub use spending::{Caps, Spending, Spent};

use crate::{AgentError, Brief, Design, Feedback, Paraphrase, Problem};
use recrash_model::narrative::{Fact, FactSource, NARRATIVE_FORMAT, Narrative, Origin};
use recrash_model::scenario::{
    Author, CrossMap, CurveMap, Environment, Obstacle, Partner, RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source,
    StraightMap, TeeMap,
};
use recrash_model::tuning::Parameter;
use recrash_model::{Diagnostic, Outcome};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};
use std::cell::Cell;

/// Longest narrative text that is accepted. [characters]
const MAX_TEXT: usize = 2_000;
/// Most facts that are accepted.
const MAX_FACTS: usize = 40;

/// A language model in all three roles.
#[derive(Clone, Copy)]
pub struct LanguageModel<'a> {
    /// Model, such as `gpt-5-mini`.
    pub model: &'a str,
    /// Where answers come from.
    pub answers: &'a dyn Answers,
    /// How often an answer that cannot be used goes back, in one role for one scenario.
    pub max_repairs: usize,
    /// Counts the answers that went back.
    pub repairs: &'a Cell<usize>,
}

/// The form of a paraphrase.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NarrativeAnswer {
    /// The narrative: 2 to 6 plain sentences.
    text: String,
    /// What the text states.
    facts: Vec<Fact>,
    /// Why the narrative takes the record's place, where it does; null where it retells the record.
    replaces_record: Option<String>,
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

/// The first question of the role that retells.
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

fn question(model: &str, role: Role, brief: &Brief, text: String) -> Result<Question, AgentError> {
    let (name, schema) = match role {
        Role::Paraphrase => ("narrative", schemars::schema_for!(NarrativeAnswer).to_value()),
        Role::Design => ("scenario", schemars::schema_for!(ScenarioAnswer).to_value()),
        Role::Tune => ("values", schemars::schema_for!(ValuesAnswer).to_value()),
    };
    let schema = schema::plain(schema);
    Ok(Question {
        model: model.to_owned(),
        purpose: Purpose { role, scenario_id: brief.scenario_id.to_owned(), attempt: 0 },
        system: prompts::system(role, brief.profile, &schema)?,
        turns: vec![Turn { speaker: Speaker::User, text }],
        schema_name: name.to_owned(),
        schema,
    })
}

impl LanguageModel<'_> {
    /// Asks, and asks again with what is wrong, until `accept` takes the answer or the repairs are used up.
    fn converse<T>(
        &self,
        mut question: Question,
        accept: impl Fn(&str) -> Result<T, Vec<String>>,
    ) -> Result<T, AgentError> {
        loop {
            let exchange = self.answers.answer(&question)?;
            let found = extract::json_object(&exchange.answer).map_err(|why| vec![why]).and_then(|json| accept(&json));
            let problems = match found {
                Ok(value) => return Ok(value),
                Err(problems) => problems,
            };
            self.count_repair(&problems)?;
            push_repair(&mut question, exchange.answer, &problems)?;
        }
    }

    /// Counts an answer that goes back.
    ///
    /// # Errors
    /// The repairs are used up.
    fn count_repair(&self, problems: &[String]) -> Result<(), AgentError> {
        if self.repairs.get() >= self.max_repairs {
            let (model, problem) = (self.model.to_owned(), problems.join("; "));
            return Err(AgentError::NoUsableAnswer { model, repairs: self.max_repairs, problem });
        }
        self.repairs.set(self.repairs.get() + 1);
        Ok(())
    }

    /// Proposes the next values of the parameters, given what was tried.
    ///
    /// # Errors
    /// [`AgentError`], where the model gives no usable answer.
    pub fn propose(&self, brief: &Brief, tune: &TuneBrief) -> Result<Vec<f64>, AgentError> {
        let mut question = tune_question(self.model, brief, tune)?;
        // The design is the first try, and nobody's answer.
        question.purpose.attempt = tune.history.len().saturating_sub(1);
        self.converse(question, |json| {
            let answer: ValuesAnswer = read(json)?;
            check_values(&answer.values, tune.parameters)?;
            Ok(answer.values)
        })
    }
}

impl Paraphrase for LanguageModel<'_> {
    fn paraphrase(&self, brief: &Brief) -> Result<Outcome<Narrative>, AgentError> {
        if brief.records.is_empty() {
            return Err(AgentError::NoRecord { scenario_id: brief.scenario_id.to_owned() });
        }
        let answer = self.converse(paraphrase_question(self.model, brief)?, |json| {
            let answer: NarrativeAnswer = read(json)?;
            let problems = narrative_problems(&answer, brief);
            if problems.is_empty() { Ok(answer) } else { Err(problems) }
        })?;
        let narrative = Narrative {
            format: NARRATIVE_FORMAT.to_owned(),
            scenario_id: brief.scenario_id.to_owned(),
            template: brief.template,
            records: brief.records.iter().map(|record| record.id.clone()).collect(),
            text: answer.text,
            origin: origin(answer.replaces_record, &answer.facts, brief),
            facts: answer.facts,
            author: Author::Model(self.model.to_owned()),
        };
        Ok(Outcome { value: narrative, diagnostics: Vec::new() })
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
        if let Some(last) = feedback.last() {
            self.count_repair(&problem_sentences(&last.problem))?;
        }
        let draft = self.converse(question, |json| {
            let mut draft: Value = read(json)?;
            // Fields that are ours to say; a model may leave them out.
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

/// Whose crash an answer tells: where it takes the pick's place, that of the report whose words it quotes first.
fn origin(replaces_record: Option<String>, facts: &[Fact], brief: &Brief) -> Origin {
    let Some(reason) = replaces_record else { return Origin::Own };
    let quoted = facts.iter().find_map(|fact| match &fact.source {
        FactSource::Words { record, .. } => Some(record),
        FactSource::Column { .. } | FactSource::Assumed { .. } => None,
    });
    match quoted.filter(|record| brief.records.first().is_some_and(|pick| pick.id != **record)) {
        Some(record) => Origin::Other { record: record.clone(), reason },
        None => Origin::Invented { reason },
    }
}

fn push_repair(question: &mut Question, answer: String, problems: &[String]) -> Result<(), AgentError> {
    // Some providers take no empty turn.
    let answer = if answer.trim().is_empty() { "(no answer)".to_owned() } else { question::bounded_turn(&answer) };
    question.turns.push(Turn { speaker: Speaker::Assistant, text: answer });
    question.turns.push(Turn { speaker: Speaker::User, text: prompts::repair(problems)? });
    question.purpose.attempt += 1;
    Ok(())
}

fn read<T: for<'de> Deserialize<'de>>(json: &str) -> Result<T, Vec<String>> {
    serde_json::from_str(json).map_err(|e| vec![format!("the answer does not fit the schema: {e}")])
}

fn narrative_problems(answer: &NarrativeAnswer, brief: &Brief) -> Vec<String> {
    let mut problems = Vec::new();
    let length = answer.text.chars().count();
    if !(20..=MAX_TEXT).contains(&length) {
        problems.push(format!("text has {length} characters; 20 to {MAX_TEXT} are allowed"));
    }
    if answer.facts.len() > MAX_FACTS {
        problems.push(format!("there are {} facts; {MAX_FACTS} are allowed", answer.facts.len()));
    }
    for (index, fact) in answer.facts.iter().enumerate() {
        let FactSource::Words { record, words } = &fact.source else { continue };
        match brief.records.iter().find(|known| known.id == *record) {
            None => problems.push(format!("facts[{index}].source.record is {record}, which is not among the reports")),
            Some(known) if words.trim().is_empty() || !known.narrative.contains(words.as_str()) => {
                problems.push(format!("facts[{index}].source.words do not stand in the narrative of {record}"));
            }
            Some(_) => {}
        }
    }
    problems.extend(crate::narrative_contradictions(&answer.facts, brief.template, brief.profile));
    problems
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
