//! The roles that turn a crash record into a scenario, and the rules that play them without a language model.
//!
//! [`Paraphrase`] reads a pick and gives a [`Narrative`]: a short text and its facts, each with the words or the column
//! it comes from, or marked as assumed. [`Design`] turns a narrative into a [`ScenarioDraft`], and tries again when told
//! what was wrong ([`Feedback`]). [`Rules`] plays both, deterministic and without a network; a language model ([`llm`])
//! stands behind the same two traits. What the rules read and assume is written in `docs/models/rules.md`.
//!
//! [`expectation`] says what a rollout must show to be true to a narrative, [`parameters`] which numbers of a scenario
//! may move while it stays true.
//!
//! What this crate does **not** do: it simulates nothing, measures nothing and searches nothing. Narratives are untrusted
//! text: they are matched against patterns, never followed.

mod agreement;
mod contradiction;
mod expectation;
mod expressible;
pub mod llm;
mod parameters;
mod rules;

pub use agreement::disagreement;
pub use contradiction::narrative_contradictions;
pub use expectation::expectation;
pub use expressible::inexpressible;
pub use parameters::parameters;
pub use rules::telling::tell;
pub use rules::{Rules, can_stage, own_narrative};

use recrash_model::account::Account;
use recrash_model::metrics::{Check, Metrics};
use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::template::Template;
use recrash_model::{Diagnostic, Outcome, Seed};

/// What an agent is told about the scenario it works on.
#[derive(Debug, Clone, Copy)]
pub struct Brief<'a> {
    /// The scenario, such as `03-intersection-straight-left`.
    pub scenario_id: &'a str,
    /// The template it must keep.
    pub template: Template,
    /// The pick first, then the other reports of its incident; none where no record is of the template, and `untold` says so.
    pub records: &'a [&'a CrashRecord],
    /// Why the pick's own crash is not told, where that is known: then one is invented.
    pub untold: Option<&'a str>,
    /// What the system under test and its simulator can express.
    pub profile: &'a SystemProfile,
    /// What the built-in reader made of the incident, for agents that read.
    pub account: Option<&'a Account>,
    /// Seed of the agent's choices.
    pub seed: Seed,
}

impl<'a> Brief<'a> {
    /// The report whose narrative speaks for the incident.
    pub(crate) fn speaker(&self) -> Option<&'a CrashRecord> {
        let speaker = self.account.map(|account| &account.report);
        self.records.iter().find(|record| Some(&record.id) == speaker).or(self.records.first()).copied()
    }

    /// The record whose crash a narrative tells; of an invented one the pick, which its surroundings are taken from.
    pub fn told(&self, narrative: &Narrative) -> Option<&'a CrashRecord> {
        let told = narrative.told_record();
        let named = self.records.iter().find(|record| Some(&record.id) == told);
        named.or(self.records.first()).copied()
    }
}

/// Retells a record, with only what matters to a scenario.
pub trait Paraphrase {
    /// Writes the narrative of a scenario.
    ///
    /// # Errors
    /// [`AgentError`], where there is nothing to retell or the template is beyond the agent.
    fn paraphrase(&self, brief: &Brief) -> Result<Outcome<Narrative>, AgentError>;
}

/// Designs a scenario from a narrative.
pub trait Design {
    /// Designs the scenario, or designs it anew: `feedback` holds the earlier tries, oldest first.
    ///
    /// # Errors
    /// [`AgentError`], where the template is beyond the agent.
    fn design(&self, brief: &Brief, narrative: &Narrative, feedback: &[Feedback]) -> Result<ScenarioDraft, AgentError>;
}

/// An earlier design, and what was wrong with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Feedback {
    /// The design.
    pub draft: ScenarioDraft,
    /// What was wrong.
    pub problem: Problem,
}

/// What was wrong with a design.
#[derive(Debug, Clone, PartialEq)]
pub enum Problem {
    /// It did not pass `recrash_roads::check`.
    NotRunnable {
        /// What the check said; at least one error.
        diagnostics: Vec<Diagnostic>,
    },
    /// It ran, and its rollout is not true to the record.
    NotFaithful {
        /// The checks that failed.
        failures: Vec<Check>,
        /// What was measured.
        metrics: Box<Metrics>,
    },
}

/// Why an agent gave no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AgentError {
    /// The brief holds no record.
    #[error("there is no record to work from")]
    NoRecord,
    /// The agent has no way to stage this template.
    #[error("the rules cannot stage \"{template}\"; they know {known}")]
    TemplateUnknown {
        /// Template.
        template: Template,
        /// What the agent can stage.
        known: &'static str,
    },
    /// A prompt cannot be filled in.
    #[error("a prompt cannot be filled in: {0}")]
    Prompt(String),
    /// The model gave no answer that can be used.
    #[error("{model} gave no usable answer in {repairs} repairs: {problem}")]
    NoUsableAnswer {
        /// Model.
        model: String,
        /// How often it was told what was wrong.
        repairs: usize,
        /// What was wrong with the last answer.
        problem: String,
    },
    /// The model says that the reports do not tell what a scenario is held against.
    #[error(
        "{model} says that the reports do not tell what is checked: {facts}; correct the account, or have a model read it"
    )]
    FactsDisputed {
        /// Model.
        model: String,
        /// Which facts, and what is told instead, in its words.
        facts: String,
    },
    /// The model was not asked, or could not be.
    #[error(transparent)]
    Ask(#[from] llm::AskError),
}
