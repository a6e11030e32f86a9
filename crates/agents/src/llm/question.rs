//! Questions to a model and its answers: the nouns of the ledger.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The exchanges' format tag.
pub const EXCHANGE_FORMAT: &str = "recrash.exchange/1";

/// What is asked, of whom, and in which form the answer must come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Question {
    /// Model, such as `gpt-5-mini` or `claude-sonnet-5`.
    pub model: String,
    /// What the answer is for.
    pub purpose: Purpose,
    /// Standing instructions.
    pub system: String,
    /// The conversation so far: the user begins and ends it.
    pub turns: Vec<Turn>,
    /// Name of the answer's form.
    pub schema_name: String,
    /// JSON Schema of the answer.
    pub schema: serde_json::Value,
}

/// What an answer is for.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Purpose {
    /// Role that asks.
    pub role: Role,
    /// Scenario.
    pub scenario_id: String,
    /// 0 for the first question of its role, then one more for each repair or round.
    pub attempt: usize,
}

/// The three roles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Retells the record.
    Paraphrase,
    /// Designs the scenario.
    Design,
    /// Proposes other numbers.
    Tune,
}

impl Role {
    /// All of them, in order.
    pub const ALL: [Self; 3] = [Self::Paraphrase, Self::Design, Self::Tune];

    /// Name on the command line and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paraphrase => "paraphrase",
            Self::Design => "design",
            Self::Tune => "tune",
        }
    }
}

/// One part of a conversation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Turn {
    /// Who speaks.
    pub speaker: Speaker,
    /// What is said.
    pub text: String,
}

/// Who speaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Speaker {
    /// This program.
    User,
    /// The model.
    Assistant,
}

impl Question {
    /// Name of the question in the ledger and in batch files: the SHA-256 of everything that is sent. The purpose is
    /// not part of it: the same question asked twice has one answer.
    pub fn hash(&self) -> String {
        let sent = (&self.model, &self.system, &self.turns, &self.schema_name, &self.schema);
        sha256(&serde_json::to_vec(&sent).unwrap_or_default())
    }
}

/// SHA-256 in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A question with its answer, as the ledger keeps it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Exchange {
    /// Always [`EXCHANGE_FORMAT`].
    pub format: String,
    /// [`Question::hash`].
    pub hash: String,
    /// The question.
    pub question: Question,
    /// Hash of the prompt files behind the question.
    #[serde(default)]
    pub prompts: String,
    /// What the model said, word for word but for keys, which are blacked out. Untrusted text.
    pub answer: String,
    /// How it was asked.
    #[serde(default)]
    pub asked: Asked,
    /// Tokens read by the model.
    pub input_tokens: u64,
    /// Tokens written by the model.
    pub output_tokens: u64,
    /// Time from the question to its answer; absent for a batch. [s]
    #[serde(default)]
    pub latency_s: Option<f64>,
    /// How often it was asked again after a passing fault.
    #[serde(default)]
    pub retries: u32,
    /// Price when it was asked; absent where none is known. [USD]
    #[serde(default)]
    pub cost_usd: Option<f64>,
}

/// How a question was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Asked {
    /// In a batch file.
    #[default]
    Batch,
    /// Over the network, of the model's own provider.
    Live,
    /// Over the network, of a server whose address was given.
    Server,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_depends_on_what_is_sent_and_on_nothing_else() {
        let question = Question {
            model: "m".into(),
            purpose: Purpose { role: Role::Design, scenario_id: "01".into(), attempt: 0 },
            system: "s".into(),
            turns: vec![Turn { speaker: Speaker::User, text: "t".into() }],
            schema_name: "n".into(),
            schema: serde_json::json!({}),
        };
        let other_purpose = Question {
            purpose: Purpose { role: Role::Tune, scenario_id: "02".into(), attempt: 3 },
            ..question.clone()
        };
        let other_text = Question { system: "S".into(), ..question.clone() };
        assert_eq!(question.hash(), other_purpose.hash());
        assert_ne!(question.hash(), other_text.hash());
        assert_eq!(question.hash().len(), 64);
    }
}
