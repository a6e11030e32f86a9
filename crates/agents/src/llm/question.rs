//! Questions to a model and its answers: the nouns of the ledger.

use recrash_model::hash::hexadecimal;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The exchanges' format tag. Those of version 1 have no hash of the answer, and are read all the same.
pub const EXCHANGE_FORMAT: &str = "recrash.exchange/2";

/// Longest answer that is kept and looked at; a scenario has some 5 kB. [bytes]
const LONGEST_ANSWER: usize = 1 << 18;
/// How much is kept of a longer one. [bytes]
const KEPT_OF_LONGER: usize = 1 << 12;
/// Longest answer that goes back to the model with what is wrong. [bytes]
const LONGEST_TURN: usize = 1 << 14;

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

/// The roles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Retells the record.
    Paraphrase,
    /// Designs the scenario.
    Design,
    /// Proposes other numbers.
    Tune,
    /// Changes what a replay does not show as it is told.
    Restage,
    /// Holds the replay against the report.
    Review,
}

impl Role {
    /// All of them, in order.
    pub const ALL: [Self; 5] = [Self::Paraphrase, Self::Design, Self::Tune, Self::Restage, Self::Review];

    /// Name on the command line and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paraphrase => "paraphrase",
            Self::Design => "design",
            Self::Tune => "tune",
            Self::Restage => "restage",
            Self::Review => "review",
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
        sha256(&serde_json::to_vec(&sent).expect("texts can be written"))
    }

    /// Bytes of what is sent, about.
    pub fn bytes(&self) -> usize {
        let turns: usize = self.turns.iter().map(|turn| turn.text.len()).sum();
        self.system.len() + turns + self.schema.to_string().len()
    }
}

/// An answer as it is kept: whole, or its beginning where no answer is that long.
pub(crate) fn bounded_answer(answer: &str) -> String {
    bounded(answer, LONGEST_ANSWER, KEPT_OF_LONGER)
}

/// An answer as it goes back to its model.
pub(crate) fn bounded_turn(answer: &str) -> String {
    bounded(answer, LONGEST_TURN, LONGEST_TURN)
}

fn bounded(text: &str, longest: usize, kept: usize) -> String {
    if text.len() <= longest {
        return text.to_owned();
    }
    let whole = (0..=kept).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
    let beginning = &text[..whole];
    format!("{beginning}\n(cut: of {} bytes, at most {longest} are looked at)", text.len())
}

/// SHA-256 in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
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
    /// SHA-256 of the question's hash and the answer; absent in version 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answer_sha256: Option<String>,
    /// How it was asked.
    #[serde(default)]
    pub asked: Asked,
    /// Tokens read by the model.
    pub input_tokens: u64,
    /// Tokens written by the model.
    pub output_tokens: u64,
    /// Whether the server did not count the tokens, so that they are estimated from the bytes.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub tokens_estimated: bool,
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

impl Exchange {
    /// With the hash of its answer.
    #[must_use]
    pub fn sealed(self) -> Self {
        Self { answer_sha256: Some(self.seal()), ..self }
    }

    fn seal(&self) -> String {
        sha256(format!("{}\n{}", self.hash, self.answer).as_bytes())
    }

    /// Whether it is the exchange of this name, and question and answer are as they were kept.
    ///
    /// # Errors
    /// What does not fit, in a few words.
    pub fn check(&self, hash: &str) -> Result<(), &'static str> {
        match &self.answer_sha256 {
            _ if self.hash != hash || self.question.hash() != hash => Err("its question is not the one it is named by"),
            Some(seal) if *seal != self.seal() => Err("its answer is not the one that was given"),
            None if self.format == EXCHANGE_FORMAT => Err("the hash of its answer is missing"),
            _ => Ok(()),
        }
    }
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

    fn question() -> Question {
        Question {
            model: "m".into(),
            purpose: Purpose { role: Role::Design, scenario_id: "01".into(), attempt: 0 },
            system: "s".into(),
            turns: vec![Turn { speaker: Speaker::User, text: "t".into() }],
            schema_name: "n".into(),
            schema: serde_json::json!({}),
        }
    }

    #[test]
    fn an_exchange_is_what_was_asked_and_answered() {
        let hash = question().hash();
        let kept = serde_json::json!({"format": EXCHANGE_FORMAT, "hash": hash, "question": question(), "answer": "yes",
                                      "input_tokens": 1, "output_tokens": 1});
        let exchange: Exchange = serde_json::from_value(kept).unwrap();
        assert!(exchange.check(&hash).is_err(), "without a hash of the answer");
        let exchange = exchange.sealed();
        assert_eq!(exchange.check(&hash), Ok(()));
        assert!(Exchange { answer: "no".into(), ..exchange.clone() }.check(&hash).is_err());
        assert!(exchange.check(&"0".repeat(64)).is_err());
        let other = Question { system: "S".into(), ..question() };
        assert!(Exchange { question: other, ..exchange.clone() }.check(&hash).is_err());
        let old = Exchange { format: "recrash.exchange/1".into(), answer_sha256: None, ..exchange };
        assert_eq!(old.check(&hash), Ok(()));
    }

    #[test]
    fn long_answers_are_cut_and_others_are_not() {
        assert_eq!(bounded_answer("\u{e9}"), "\u{e9}");
        let cut = bounded_answer(&"\u{e9}".repeat(1 << 20));
        assert!(cut.len() < 5_000 && cut.contains("of 2097152 bytes"), "{}", cut.len());
        assert!(bounded_turn(&"x".repeat(1 << 20)).len() < 17_000);
    }

    #[test]
    fn the_hash_depends_on_what_is_sent_and_on_nothing_else() {
        let question = question();
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
