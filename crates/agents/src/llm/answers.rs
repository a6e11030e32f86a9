//! Where answers come from: a live model, a batch file that somebody else has sent, or the ledger alone.
//!
//! All three are one trait, so prompts, repairs and fallback are one path for every provider and every mode.

use crate::llm::question::{Exchange, Question};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Keeps exchanges. The pipeline keeps them as files.
pub trait Ledger: Sync {
    /// The exchange of this question, where there was one.
    fn find(&self, hash: &str) -> Option<Exchange>;

    /// Keeps an exchange for good.
    ///
    /// # Errors
    /// What went wrong, in one sentence.
    fn keep(&self, exchange: &Exchange) -> Result<(), String>;
}

/// Gives answers.
pub trait Answers: Sync {
    /// The answer to a question.
    ///
    /// # Errors
    /// [`AskError`].
    fn answer(&self, question: &Question) -> Result<Exchange, AskError>;
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AskError {
    /// It was put down for the next batch.
    #[error("the question waits for the next batch")]
    Pending,
    /// The ledger does not hold it, and nothing else is asked.
    #[error("the ledger has no answer to question {hash} ({what}); run once without --llm replay")]
    NotInLedger {
        /// Hash of the question.
        hash: String,
        /// What it is for.
        what: String,
    },
    /// A cap on tokens or money is reached.
    #[error("{0}")]
    BudgetSpent(String),
    /// The provider failed for good.
    #[error("{0}")]
    Provider(String),
    /// The ledger cannot keep the answer.
    #[error("the ledger cannot keep an answer: {0}")]
    Ledger(String),
}

/// Answers from the ledger alone.
pub struct Replay<'a> {
    /// The ledger.
    pub ledger: &'a dyn Ledger,
}

impl Answers for Replay<'_> {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        let hash = question.hash();
        self.ledger.find(&hash).ok_or_else(|| {
            let purpose = &question.purpose;
            let what = format!("{:?} of {}, attempt {}", purpose.role, purpose.scenario_id, purpose.attempt);
            AskError::NotInLedger { hash, what: what.to_lowercase() }
        })
    }
}

/// Answers from the ledger; what it lacks is put down for a batch.
pub struct Batch<'a> {
    ledger: &'a dyn Ledger,
    pending: Mutex<BTreeMap<String, Question>>,
}

impl<'a> Batch<'a> {
    /// With nothing put down yet.
    pub fn new(ledger: &'a dyn Ledger) -> Self {
        Self { ledger, pending: Mutex::new(BTreeMap::new()) }
    }

    /// What was put down, in the order of hashes.
    pub fn into_pending(self) -> Vec<Question> {
        self.pending.into_inner().unwrap_or_else(PoisonError::into_inner).into_values().collect()
    }
}

impl Answers for Batch<'_> {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        let hash = question.hash();
        if let Some(exchange) = self.ledger.find(&hash) {
            return Ok(exchange);
        }
        self.pending.lock().unwrap_or_else(PoisonError::into_inner).insert(hash, question.clone());
        Err(AskError::Pending)
    }
}
