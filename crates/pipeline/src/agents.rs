//! Who plays which role, and what happens when a model cannot.

use crate::error::PipelineError;
use crate::store::{Store, sha256};
use recrash_agents::llm::{Answers, AskError, Batch, Exchange, LanguageModel, Ledger, Question, Replay};
use recrash_agents::llm::{read_responses, request_line};
use recrash_agents::{AgentError, Brief, Paraphrase, Rules};
use recrash_model::Diagnostic;
use recrash_model::narrative::Narrative;
use recrash_model::scenario::Author;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How often an answer that cannot be used goes back to its model.
pub const MAX_REPAIRS: usize = 3;
/// Name of the built-in rules.
pub const RULES: &str = "rules";
/// Requests for a provider's batch service.
pub const REQUESTS: &str = "requests.jsonl";
/// Its answers.
pub const RESPONSES: &str = "responses.jsonl";
/// The questions behind the requests.
const PENDING: &str = "ledger/pending.json";

/// Who plays which role: `rules`, or the name of a model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cast {
    /// Retells records.
    pub paraphrase: String,
    /// Designs scenarios.
    pub design: String,
    /// Tunes them; `rules` stands for the search.
    pub tune: String,
    /// Rounds of a model that tunes.
    pub rounds: usize,
}

impl Default for Cast {
    fn default() -> Self {
        Self { paraphrase: RULES.into(), design: RULES.into(), tune: RULES.into(), rounds: 3 }
    }
}

impl Cast {
    /// Whether any role is a model's.
    pub fn has_model(&self) -> bool {
        [&self.paraphrase, &self.design, &self.tune].into_iter().any(|name| name != RULES)
    }

    /// For the report.
    pub fn describe(&self) -> String {
        if !self.has_model() {
            return RULES.into();
        }
        format!("{} paraphrases, {} designs, {} tunes", self.paraphrase, self.design, self.tune)
    }
}

/// Where a model's answers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AnswerMode {
    /// Questions are written to a batch file; the run stops, and goes on when the answers are there.
    #[default]
    Batch,
    /// From the ledger alone; a missing answer is an error.
    Replay,
}

/// The models' side of a suite.
pub struct Models {
    store: Store,
    answers: Arc<dyn Answers>,
    batch: Option<Arc<Batch>>,
}

impl Models {
    /// Sets up the ledger; takes in the answers of a batch, where there are any.
    ///
    /// # Errors
    /// The ledger cannot be read or written.
    pub fn open(store: &Store, mode: AnswerMode) -> Result<(Self, Vec<Diagnostic>), PipelineError> {
        let ledger: Arc<dyn Ledger> = Arc::new(FileLedger(store.clone()));
        let mut diagnostics = Vec::new();
        let (answers, batch): (Arc<dyn Answers>, _) = match mode {
            AnswerMode::Replay => (Arc::new(Replay { ledger }), None),
            AnswerMode::Batch => {
                diagnostics = take_in_responses(store)?;
                let batch = Arc::new(Batch::new(ledger));
                (Arc::clone(&batch) as Arc<dyn Answers>, Some(batch))
            }
        };
        Ok((Self { store: store.clone(), answers, batch }, diagnostics))
    }

    /// A model in its roles. `repairs` counts the answers that went back.
    pub fn model<'a>(&'a self, name: &'a str, repairs: &'a AtomicUsize) -> LanguageModel<'a> {
        LanguageModel { model: name, answers: &*self.answers, max_repairs: MAX_REPAIRS, repairs }
    }

    /// Writes the questions that wait, as a batch file; gives its path and their number.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_requests(&self) -> Result<(PathBuf, usize), PipelineError> {
        let questions = self.batch.as_ref().map_or_else(Vec::new, |batch| batch.pending());
        let lines: String = questions.iter().map(|question| request_line(question) + "\n").collect();
        self.store.write_json(PENDING, &questions)?;
        self.store.write(REQUESTS, lines.as_bytes())?;
        Ok((self.store.path(REQUESTS), questions.len()))
    }
}

/// Exchanges as files of a suite, named by hash.
struct FileLedger(Store);

fn exchange_file(hash: &str) -> String {
    format!("ledger/{hash}.json")
}

impl Ledger for FileLedger {
    fn find(&self, hash: &str) -> Option<Exchange> {
        self.0.read_json(&exchange_file(hash)).ok()
    }
}

fn take_in_responses(store: &Store) -> Result<Vec<Diagnostic>, PipelineError> {
    let path = store.path(RESPONSES);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = crate::store::read_text(&path, 1 << 30)?;
    let questions: Vec<Question> = store.read_json(PENDING)?;
    let (exchanges, diagnostics) = read_responses(RESPONSES, &text, &questions);
    for exchange in &exchanges {
        store.write_json(&exchange_file(&exchange.hash), exchange)?;
    }
    store.write(&format!("ledger/responses-{}.jsonl", &sha256(text.as_bytes())[..12]), text.as_bytes())?;
    for done in [RESPONSES, REQUESTS, PENDING] {
        store.remove(done)?;
    }
    Ok(diagnostics)
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
}

impl AgentLog {
    /// For the rules, who are asked first.
    pub fn rules() -> Self {
        Self { asked: RULES.into(), author: Author::Rules, repairs: 0, fallback: None }
    }

    /// One word for tables: `rules`, `first answer`, `after repair` or `fallback`.
    pub fn outcome(&self) -> &'static str {
        match self {
            Self { asked, .. } if asked == RULES => "rules",
            Self { fallback: Some(_), .. } => "fallback",
            Self { repairs: 0, .. } => "first answer",
            _ => "after repair",
        }
    }
}

/// Retells a record, by the model where one is cast, and by the rules where it cannot.
///
/// # Errors
/// The answer is still to come, is missing from the ledger, or the rules cannot either.
pub fn paraphrase(models: Option<&Models>, name: &str, brief: &Brief) -> Result<(Narrative, AgentLog), PipelineError> {
    let by_rules = || {
        Rules.paraphrase(brief).map(|outcome| outcome.value).map_err(|e| PipelineError::scenario(brief.scenario_id, e))
    };
    let Some(models) = models.filter(|_| name != RULES) else {
        return Ok((by_rules()?, AgentLog::rules()));
    };
    let repairs = AtomicUsize::new(0);
    let answer = models.model(name, &repairs).paraphrase(brief);
    let repairs = repairs.load(Ordering::Relaxed);
    let asked = name.to_owned();
    match answer {
        Ok(outcome) => {
            let author = outcome.value.author.clone();
            Ok((outcome.value, AgentLog { asked, author, repairs, fallback: None }))
        }
        Err(error) => {
            let fallback = Some(unusable(error)?);
            Ok((by_rules()?, AgentLog { asked, author: Author::Rules, repairs, fallback }))
        }
    }
}

/// Why a model's part goes to the rules.
///
/// # Errors
/// What no rules can mend: an answer that is still to come, or one the ledger lacks.
pub fn unusable(error: AgentError) -> Result<String, PipelineError> {
    match error {
        AgentError::Ask(AskError::Pending) => Err(PipelineError::AnswerPending),
        AgentError::Ask(error) => Err(PipelineError::bad_input(error.to_string())),
        other => Ok(other.to_string()),
    }
}
