//! The three protocols that models are asked by: what a question looks like in each, and where its answer stands. A batch
//! file is written and read in the first.
//!
//! What this module does **not** do: it speaks to nobody.

use crate::llm::prices::plain_name;
use crate::llm::question::{Question, Speaker};
use serde_json::{Value, json};

/// Most tokens of an answer where the protocol wants a bound: a scenario has 1 000, and some models think first (assumed).
#[cfg(feature = "live")]
const MOST_TOKENS: u32 = 16_000;

/// A protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wire {
    /// OpenAI's chat completions, which most servers speak.
    OpenAi,
    /// Anthropic's messages.
    #[cfg(feature = "live")]
    Anthropic,
    /// Gemini's content.
    #[cfg(feature = "live")]
    Gemini,
}

/// What a model said.
#[derive(Debug, PartialEq)]
pub struct Reply {
    /// Its words; empty where it said none.
    pub text: String,
    /// Whether it said that it will not answer.
    pub refused: bool,
    /// Tokens it read, where the server tells.
    pub input_tokens: Option<u64>,
    /// Tokens it wrote, where the server tells.
    pub output_tokens: Option<u64>,
}

impl Wire {
    /// What is added to the address for a question.
    #[cfg(feature = "live")]
    pub fn path(self, model: &str) -> String {
        match self {
            Self::OpenAi => "/chat/completions".to_owned(),
            Self::Anthropic => "/messages".to_owned(),
            Self::Gemini => format!("/models/{}:generateContent", plain_name(model)),
        }
    }

    /// The header with the key: its name, and its content.
    #[cfg(feature = "live")]
    pub fn key_header(self, key: &str) -> (&'static str, String) {
        match self {
            Self::OpenAi => ("authorization", format!("Bearer {key}")),
            Self::Anthropic => ("x-api-key", key.to_owned()),
            Self::Gemini => ("x-goog-api-key", key.to_owned()),
        }
    }

    /// The body of a question. Anthropic takes no schema like ours: there the prompt alone has it.
    #[cfg(feature = "live")]
    pub fn body(self, question: &Question, with_schema: bool) -> Value {
        match self {
            Self::OpenAi => openai_body(question, with_schema),
            Self::Anthropic => json!({
                "model": plain_name(&question.model),
                "max_tokens": MOST_TOKENS,
                "system": instructions(question, true),
                "messages": turns(question, "assistant", |text| json!(text)),
            }),
            Self::Gemini => {
                let contents: Vec<Value> = question
                    .turns
                    .iter()
                    .map(|turn| json!({"role": role(turn.speaker, "model"), "parts": [{"text": turn.text}]}))
                    .collect();
                let mut body = json!({"systemInstruction": {"parts": [{"text": instructions(question, !with_schema)}]}, "contents": contents});
                if with_schema {
                    body["generationConfig"] =
                        json!({"responseMimeType": "application/json", "responseJsonSchema": question.schema});
                }
                body
            }
        }
    }

    /// What a model said; `None` where the body is no answer of this protocol.
    pub fn reply(self, body: &Value) -> Option<Reply> {
        let count = |place: &str| body.pointer(place).and_then(Value::as_u64);
        let (text, refused, input, output) = match self {
            Self::OpenAi => {
                let message = body.pointer("/choices/0/message")?;
                let refusal = message["refusal"].as_str();
                let text = text_of(&message["content"])?;
                let (text, refused) =
                    if text.is_empty() { (refusal.unwrap_or_default(), refusal) } else { (&*text, None) };
                let refused = refused.is_some();
                (text.to_owned(), refused, count("/usage/prompt_tokens"), count("/usage/completion_tokens"))
            }
            #[cfg(feature = "live")]
            Self::Anthropic => {
                let refused = body["stop_reason"] == "refusal";
                let read = count("/usage/input_tokens");
                let cached = ["/usage/cache_creation_input_tokens", "/usage/cache_read_input_tokens"].map(count);
                let read = read.map(|read| cached.into_iter().flatten().fold(read, u64::saturating_add));
                (text_of(body.get("content")?)?, refused, read, count("/usage/output_tokens"))
            }
            #[cfg(feature = "live")]
            Self::Gemini => {
                let parts = body.pointer("/candidates/0")?.pointer("/content/parts").cloned().unwrap_or_default();
                let thought = count("/usageMetadata/thoughtsTokenCount").unwrap_or(0);
                let written = count("/usageMetadata/candidatesTokenCount").map(|n| n.saturating_add(thought));
                (text_of(&parts)?, false, count("/usageMetadata/promptTokenCount"), written)
            }
        };
        Some(Reply { text, refused, input_tokens: input, output_tokens: output })
    }
}

/// The body of a question in OpenAI's protocol.
pub fn openai_body(question: &Question, with_schema: bool) -> Value {
    let mut messages = vec![json!({"role": "system", "content": instructions(question, !with_schema)})];
    messages.extend(turns(question, "assistant", |text| json!(text)));
    let mut body = json!({"model": plain_name(&question.model), "messages": messages});
    if with_schema {
        body["response_format"] = json!({
            "type": "json_schema",
            "json_schema": {"name": question.schema_name, "schema": question.schema, "strict": false}
        });
    }
    body
}

/// The standing instructions, with the schema where nothing else carries it.
fn instructions(question: &Question, with_schema: bool) -> String {
    if !with_schema {
        return question.system.clone();
    }
    format!("{}\n# JSON Schema of the answer\n{}\n", question.system, question.schema)
}

fn turns(question: &Question, model: &str, content: fn(&str) -> Value) -> Vec<Value> {
    let turn = |turn: &crate::llm::Turn| json!({"role": role(turn.speaker, model), "content": content(&turn.text)});
    question.turns.iter().map(turn).collect()
}

fn role(speaker: Speaker, model: &str) -> &str {
    match speaker {
        Speaker::User => "user",
        Speaker::Assistant => model,
    }
}

/// A text, or the texts of a list of parts but for thoughts; empty where there is none. `None` where it is something else.
fn text_of(content: &Value) -> Option<String> {
    match content {
        Value::Null => Some(String::new()),
        Value::String(text) => Some(text.clone()),
        Value::Array(parts) => {
            let said = parts.iter().filter(|part| part["thought"] != true && part["type"] != "thinking");
            Some(said.filter_map(|part| part["text"].as_str()).collect())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reply(wire: Wire, body: &Value) -> Option<(String, bool, Option<u64>, Option<u64>)> {
        wire.reply(body).map(|r| (r.text, r.refused, r.input_tokens, r.output_tokens))
    }

    #[test]
    #[cfg(feature = "live")]
    fn an_answer_is_found_in_each_protocol() {
        let openai = json!({"choices": [{"message": {"content": "yes"}}],
                            "usage": {"prompt_tokens": 7, "completion_tokens": 2}});
        assert_eq!(reply(Wire::OpenAi, &openai), Some(("yes".into(), false, Some(7), Some(2))));
        let anthropic = json!({"content": [{"type": "thinking", "thinking": "hm"}, {"type": "text", "text": "yes"}],
                               "usage": {"input_tokens": 5, "cache_read_input_tokens": 2, "output_tokens": 2}});
        assert_eq!(reply(Wire::Anthropic, &anthropic), Some(("yes".into(), false, Some(7), Some(2))));
        let gemini = json!({"candidates": [{"content": {"parts": [{"text": "hm", "thought": true}, {"text": "yes"}]}}],
            "usageMetadata": {"promptTokenCount": 7, "candidatesTokenCount": 1, "thoughtsTokenCount": 1}});
        assert_eq!(reply(Wire::Gemini, &gemini), Some(("yes".into(), false, Some(7), Some(2))));
    }

    #[test]
    fn refusals_parts_and_missing_counts_are_read_and_other_things_are_no_answers() {
        let message = |message: Value| json!({"choices": [{"message": message}]});
        let refusal = message(json!({"content": null, "refusal": "I cannot"}));
        assert_eq!(reply(Wire::OpenAi, &refusal), Some(("I cannot".into(), true, None, None)));
        let parts = message(json!({"content": [{"type": "text", "text": "a"}, {"type": "text", "text": "b"}]}));
        assert_eq!(reply(Wire::OpenAi, &parts), Some(("ab".into(), false, None, None)));
        assert_eq!(reply(Wire::OpenAi, &message(json!({"content": null}))), Some((String::new(), false, None, None)));
        for wrong in [json!({}), json!([]), json!({"choices": []}), json!({"choices": [{"message": {"content": 7}}]})] {
            assert_eq!(reply(Wire::OpenAi, &wrong), None, "{wrong}");
        }
    }

    #[test]
    #[cfg(feature = "live")]
    fn a_question_has_its_system_text_turns_and_schema_in_each_protocol() {
        use crate::llm::{Purpose, Role, Turn};
        let question = Question {
            model: "gemini::m".into(),
            purpose: Purpose { role: Role::Design, scenario_id: "01".into(), attempt: 0 },
            system: "be brief".into(),
            turns: vec![
                Turn { speaker: Speaker::User, text: "ask".into() },
                Turn { speaker: Speaker::Assistant, text: "said".into() },
                Turn { speaker: Speaker::User, text: "again".into() },
            ],
            schema_name: "scenario".into(),
            schema: json!({"type": "object"}),
        };
        let openai = Wire::OpenAi.body(&question, true);
        assert_eq!((&openai["model"], &openai["messages"][2]["role"]), (&json!("m"), &json!("assistant")));
        assert_eq!(openai["response_format"]["json_schema"]["schema"], question.schema);
        assert!(Wire::OpenAi.body(&question, false).get("response_format").is_none());
        let anthropic = Wire::Anthropic.body(&question, true);
        // Nothing else carries the schema there.
        let system = anthropic["system"].as_str().expect("a text");
        assert!(system.starts_with("be brief\n") && system.contains(r#"{"type":"object"}"#), "{system}");
        assert_eq!(anthropic["messages"][1]["content"], json!("said"));
        assert!(anthropic["max_tokens"].as_u64() > Some(4_000));
        let gemini = Wire::Gemini.body(&question, true);
        assert_eq!(
            (&gemini["contents"][1]["role"], gemini["contents"].as_array().map(Vec::len)),
            (&json!("model"), Some(3))
        );
        assert_eq!(gemini["generationConfig"]["responseJsonSchema"], question.schema);
        assert_eq!(Wire::Gemini.path("gemini::m"), "/models/m:generateContent");
    }
}
