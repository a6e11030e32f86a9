//! Where answers come from: a live model, a batch file that somebody sends to a provider, or the ledger alone.
//!
//! All three are one trait, so prompts, repairs and fallback are one path for every provider and every mode.

use crate::llm::question::{Exchange, Question};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Keeps exchanges. The pipeline keeps them as files.
pub trait Ledger: Send + Sync {
    /// The exchange of this question, where there was one.
    ///
    /// # Errors
    /// It is not what was kept, in one sentence.
    fn find(&self, hash: &str) -> Result<Option<Exchange>, String>;

    /// Keeps an exchange for good.
    ///
    /// # Errors
    /// Why it cannot be kept, in one sentence.
    fn keep(&self, exchange: &Exchange) -> Result<(), String>;
}

/// Gives answers.
pub trait Answers: Send + Sync {
    /// The answer to a question.
    ///
    /// # Errors
    /// [`AskError`].
    fn answer(&self, question: &Question) -> Result<Exchange, AskError>;

    /// Whether questions can be asked at all, as far as that is seen without asking one.
    ///
    /// # Errors
    /// [`AskError::Refused`]: a key is missing, or nobody is at an address.
    fn ready(&self) -> Result<(), AskError> {
        Ok(())
    }
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AskError {
    /// It was put down for the next batch. The run stops when all questions that can be asked are put down.
    #[error("the question waits for the next batch")]
    Pending,
    /// A cap on tokens or money is reached. The run stops.
    #[error("{0}")]
    BudgetSpent(String),
    /// No question will be answered like this: a key is missing or wrong, the model is unknown. The run stops.
    #[error("{0}")]
    Refused(String),
    /// This question was not answered, however often it was asked. The rules take over.
    #[error("{0}")]
    Trouble(String),
    /// The ledger cannot keep an answer, or does not hold what it kept. The run stops.
    #[error("{0}")]
    Ledger(String),
    /// The ledger does not hold it, and nothing else is asked. The run stops.
    #[error("the ledger has no answer to question {hash} ({what}); have the models asked once")]
    NotInLedger {
        /// Hash of the question.
        hash: String,
        /// What it is for.
        what: String,
    },
}

/// Answers from the ledger alone.
pub struct Replay {
    /// The ledger.
    pub ledger: Arc<dyn Ledger>,
}

impl Answers for Replay {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        let hash = question.hash();
        self.ledger.find(&hash).map_err(AskError::Ledger)?.ok_or_else(|| {
            let purpose = &question.purpose;
            let what = format!("{:?} of {}, attempt {}", purpose.role, purpose.scenario_id, purpose.attempt);
            AskError::NotInLedger { hash, what: what.to_lowercase() }
        })
    }
}

/// Batches that came back without a usable answer to a question.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tried {
    /// How many.
    pub times: usize,
    /// What was wrong the last time.
    pub why: String,
}

/// Answers from the ledger; what it lacks is put down for a batch, so many times and no more.
pub struct Batch {
    ledger: Arc<dyn Ledger>,
    tried: BTreeMap<String, Tried>,
    most_tries: usize,
    pending: Mutex<BTreeMap<String, Question>>,
}

impl Batch {
    /// With nothing put down yet. `tried` tells by hash which questions were put down in vain.
    pub fn new(ledger: Arc<dyn Ledger>, tried: BTreeMap<String, Tried>, most_tries: usize) -> Self {
        Self { ledger, tried, most_tries, pending: Mutex::new(BTreeMap::new()) }
    }

    /// What was put down, in the order of hashes.
    pub fn pending(&self) -> Vec<Question> {
        self.pending.lock().unwrap_or_else(PoisonError::into_inner).values().cloned().collect()
    }
}

impl Answers for Batch {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        let hash = question.hash();
        if let Some(exchange) = self.ledger.find(&hash).map_err(AskError::Ledger)? {
            return Ok(exchange);
        }
        if let Some(Tried { times, why }) = self.tried.get(&hash).filter(|tried| tried.times >= self.most_tries) {
            let model = &question.model;
            return Err(AskError::Trouble(format!("{model} gave no usable answer in {times} batches: {why}")));
        }
        self.pending.lock().unwrap_or_else(PoisonError::into_inner).insert(hash, question.clone());
        Err(AskError::Pending)
    }
}
