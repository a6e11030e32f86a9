//! What a run has spent on questions, and where it stops.

use crate::llm::answers::AskError;
use crate::llm::question::Exchange;
use crate::llm::wire::Reply;
use std::sync::{Mutex, PoisonError};

/// Most that a run may spend. Nothing is asked once a cap is reached; what is under way by then is finished and kept.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Caps {
    /// Tokens, read and written together.
    pub tokens: Option<u64>,
    /// Money. [USD]
    pub cost_usd: Option<f64>,
}

/// Bytes that are taken for a token where a server does not count: English has four, the digits and brackets of a
/// scenario two or three, so that the estimate is high rather than low. [bytes]
const BYTES_OF_A_TOKEN: usize = 2;

/// Tokens of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tokens {
    /// Read by the model.
    pub input: u64,
    /// Written by the model.
    pub output: u64,
    /// Whether the server did not tell, so that they are estimated from the bytes.
    pub estimated: bool,
}

impl Tokens {
    /// As the server counted, and estimated from the bytes where it did not: `sent` of the question, and the answer's own.
    pub fn of(reply: &Reply, sent: usize) -> Self {
        let (read, written) = (Self::estimate(sent), Self::estimate(reply.text.len()));
        // A count of nothing for something is none.
        let input = reply.input_tokens.filter(|&n| n > 0);
        let output = reply.output_tokens.filter(|&n| n > 0 || written == 0);
        let estimated = input.is_none() || output.is_none();
        Self { input: input.unwrap_or(read), output: output.unwrap_or(written), estimated }
    }

    /// Tokens of so many bytes.
    pub fn estimate(bytes: usize) -> u64 {
        bytes.div_ceil(BYTES_OF_A_TOKEN) as u64
    }
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
        // What a server says is not to be trusted: no sum of it runs over.
        spent.tokens = spent.tokens.saturating_add(exchange.input_tokens).saturating_add(exchange.output_tokens);
        spent.cost_usd += exchange.cost_usd.unwrap_or(0.0);
    }

    /// Adds tokens of a question that came to nothing.
    #[cfg(feature = "live")]
    pub fn add_lost(&self, tokens: u64) {
        let mut spent = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        spent.tokens = spent.tokens.saturating_add(tokens);
    }

    /// Whether another question may be asked.
    ///
    /// # Errors
    /// A cap is reached: which, and at how much.
    pub fn check(&self, caps: &Caps) -> Result<(), AskError> {
        let spent = self.spent();
        let reached = match caps {
            Caps { tokens: Some(cap), .. } if spent.tokens >= *cap => {
                format!("the cap of {cap} tokens is reached: {} are spent", spent.tokens)
            }
            Caps { cost_usd: Some(cap), .. } if spent.cost_usd >= *cap => {
                format!("the cap of {cap} USD is reached: {:.4} are spent", spent.cost_usd)
            }
            _ => return Ok(()),
        };
        Err(AskError::BudgetSpent(reached))
    }
}
