//! Who plays which role, and what happens when a model cannot.

use crate::error::PipelineError;
use crate::models::Models;
use recrash_agents::llm::{AskError, Repairs};
use recrash_agents::{AgentError, Brief, Paraphrase, Rules};
use recrash_model::Seed;
use recrash_model::account::Account;
use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::Author;
use serde::{Deserialize, Serialize};

/// How often an answer that cannot be used goes back to its model, where nothing else is said.
const REPAIRS: usize = 3;
/// Name of the built-in rules.
pub const RULES: &str = "rules";

/// Who plays which role: `rules`, or the name of a model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cast {
    /// Reads reports, where a model plays it: of a suite that goes by templates each pick's, of one that goes by accounts
    /// those of `reads`.
    pub paraphrase: String,
    /// Designs scenarios.
    pub design: String,
    /// Tunes them; `rules` stands for the search.
    pub tune: String,
    /// Rounds of a model that tunes.
    pub rounds: usize,
    /// How often an answer that cannot be used goes back, in one role for one scenario.
    #[serde(default = "default_repairs")]
    pub repairs: usize,
    /// Which incidents a model reads, of a suite that goes by accounts.
    #[serde(default)]
    pub reads: Reads,
    /// Holds each replay against its report, in a suite that goes by accounts: a model, or nobody.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub review: Option<String>,
}

/// Which incidents a language model reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reads {
    /// Those that the built-in reader did not read whole.
    #[default]
    Unread,
    /// All.
    All,
}

impl Reads {
    /// As it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unread => "unread",
            Self::All => "all",
        }
    }
}

fn default_repairs() -> usize {
    REPAIRS
}

impl Default for Cast {
    fn default() -> Self {
        Self {
            paraphrase: RULES.into(),
            design: RULES.into(),
            tune: RULES.into(),
            rounds: 3,
            repairs: REPAIRS,
            reads: Reads::default(),
            review: None,
        }
    }
}

impl Cast {
    /// The models among the cast, each once.
    pub fn models(&self) -> Vec<&str> {
        let mut names = self.makers();
        names.extend(self.review.as_deref());
        names.sort_unstable();
        names.dedup();
        names
    }

    /// The models that make something of a suite: who reviews changes none of it.
    pub fn makers(&self) -> Vec<&str> {
        let names = [self.paraphrase.as_str(), &self.design, &self.tune];
        names.into_iter().filter(|name| *name != RULES).collect()
    }

    /// The model that designs, where one is cast.
    pub fn designer(&self) -> Option<&str> {
        Some(self.design.as_str()).filter(|name| *name != RULES)
    }

    /// For the report.
    pub fn describe(&self) -> String {
        let makers = match self.makers().is_empty() {
            true => RULES.to_owned(),
            false => format!("{} paraphrases, {} designs, {} tunes", self.paraphrase, self.design, self.tune),
        };
        match &self.review {
            None => makers,
            Some(model) => format!("{makers}; {model} reviews"),
        }
    }
}

/// Who was asked, and who answered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AgentLog {
    /// `rules`, or the model that was asked.
    pub asked: String,
    /// Who wrote what was taken.
    pub author: Author,
    /// Answers that went back to the model.
    pub repairs: usize,
    /// Why the rules took over, where they did.
    pub fallback: Option<String>,
    /// Whether there was nothing to ask: a contact as designed needs no tuning.
    #[serde(default)]
    pub needless: bool,
}

impl AgentLog {
    /// For the rules, who are asked first.
    pub fn rules() -> Self {
        Self { asked: RULES.into(), author: Author::Rules, repairs: 0, fallback: None, needless: false }
    }

    /// For a model whose answer was taken.
    pub fn model(asked: &str, repairs: usize) -> Self {
        Self { author: Author::Model(asked.to_owned()), asked: asked.to_owned(), repairs, ..Self::rules() }
    }

    /// For a model that the rules took over from.
    pub fn fallback(asked: &str, repairs: usize, why: String) -> Self {
        Self { asked: asked.to_owned(), repairs, fallback: Some(why), ..Self::rules() }
    }

    /// One word for tables: `rules`, `first answer`, `after repair`, `fallback` or `not asked`.
    pub fn outcome(&self) -> &'static str {
        match self {
            Self { asked, .. } if asked == RULES => "rules",
            Self { fallback: Some(_), .. } => "fallback",
            Self { needless: true, .. } => "not asked",
            Self { repairs: 0, .. } => "first answer",
            _ => "after repair",
        }
    }
}

/// Retells a record: read by the model where one is cast, and by the rules where it cannot.
///
/// # Errors
/// The run has to stop, or the rules cannot either.
pub fn paraphrase(models: Option<&Models>, cast: &Cast, brief: &Brief) -> Result<(Narrative, AgentLog), PipelineError> {
    let by_rules = || {
        Rules.paraphrase(brief).map(|outcome| outcome.value).map_err(|e| PipelineError::scenario(brief.scenario_id, e))
    };
    let name = &cast.paraphrase;
    let Some(models) = models.filter(|_| name != RULES) else {
        return Ok((by_rules()?, AgentLog::rules()));
    };
    // What cannot be told needs no reader: it is invented.
    if brief.untold.is_some() || brief.account.is_none() {
        return Ok((by_rules()?, AgentLog { needless: true, ..AgentLog::model(name, 0) }));
    }
    let repairs = Repairs::default();
    match models.model(name, cast, &repairs).paraphrase(brief) {
        Ok(outcome) => Ok((outcome.value, AgentLog::model(name, repairs.all()))),
        Err(error) => {
            let why = unusable(error)?;
            Ok((by_rules()?, AgentLog::fallback(name, repairs.all(), why)))
        }
    }
}

/// What a model is told that reads the reports of an incident. `base` is what the built-in reader made of them.
pub fn reading_brief<'a>(
    id: &'a str,
    records: &'a [&'a CrashRecord],
    profile: &'a SystemProfile,
    base: &'a Account,
) -> Brief<'a> {
    let template = base.template();
    Brief { scenario_id: id, template, records, untold: None, profile, account: Some(base), seed: Seed(0) }
}

/// Why a model's part goes to the rules.
///
/// # Errors
/// What no rules can mend: the run has to stop.
pub fn unusable(error: AgentError) -> Result<String, PipelineError> {
    match error {
        AgentError::Ask(AskError::Pending) => Err(PipelineError::AnswerPending),
        AgentError::Ask(AskError::BudgetSpent(why)) => Err(PipelineError::BudgetSpent(why)),
        AgentError::Ask(AskError::Refused(why)) => Err(PipelineError::ModelRefused(why)),
        AgentError::Ask(AskError::Ledger(why)) => Err(PipelineError::Ledger(why)),
        AgentError::Ask(error @ AskError::NotInLedger { .. }) => Err(PipelineError::bad_input(error.to_string())),
        // A server that gives trouble and answers that cannot be used: the rules can mend those.
        error @ (AgentError::Ask(AskError::Trouble(_))
        | AgentError::NoRecord
        | AgentError::TemplateUnknown { .. }
        | AgentError::Prompt(_)
        | AgentError::FactsDisputed { .. }
        | AgentError::NoUsableAnswer { .. }) => Ok(error.to_string()),
    }
}
