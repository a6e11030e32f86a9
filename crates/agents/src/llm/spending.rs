//! What a run has spent on questions, and where it stops.

use crate::llm::answers::AskError;
use crate::llm::question::Exchange;
use std::sync::{Mutex, PoisonError};

/// Most that a run may spend. Nothing is asked once a cap is reached; what is under way by then is finished and kept.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Caps {
    /// Tokens, read and written together.
    pub tokens: Option<u64>,
    /// Money. [USD]
    pub cost_usd: Option<f64>,
}

/// What a run has spent so far. Answers that were in the ledger before cost nothing.
#[derive(Debug, Default)]
pub struct Spending(Mutex<Spent>);

/// Sums of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spent {
    /// Questions that were answered.
    pub answers: u64,
    /// Tokens, read and written together.
    pub tokens: u64,
    /// Money, of the answers with a known price. [USD]
    pub cost_usd: f64,
}

impl Spending {
    /// The sums.
    pub fn spent(&self) -> Spent {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds an answer.
    pub fn add(&self, exchange: &Exchange) {
        let mut spent = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        spent.answers += 1;
        spent.tokens += exchange.input_tokens + exchange.output_tokens;
        spent.cost_usd += exchange.cost_usd.unwrap_or(0.0);
    }

    /// Whether another question may be asked.
    ///
    /// # Errors
    /// A cap is reached: which, and at how much.
    pub fn check(&self, caps: &Caps) -> Result<(), AskError> {
        let spent = self.spent();
        let reached = match caps {
            Caps { tokens: Some(cap), .. } if spent.tokens >= *cap => {
                format!("the cap of {cap} tokens is reached: {} are spent (--max-tokens)", spent.tokens)
            }
            Caps { cost_usd: Some(cap), .. } if spent.cost_usd >= *cap => {
                format!("the cap of {cap} USD is reached: {:.4} are spent (--max-cost)", spent.cost_usd)
            }
            _ => return Ok(()),
        };
        Err(AskError::BudgetSpent(reached))
    }
}
