//! Batch files in OpenAI's form: one JSON object per line, a request with our `custom_id`, or a response with it.

use crate::llm::prices::plain_name;
use crate::llm::prompts;
use crate::llm::question::{Asked, EXCHANGE_FORMAT, Exchange, Question, Speaker};
use recrash_model::Diagnostic;
use recrash_model::diagnostic::{Location, Severity};
use serde::Deserialize;
use serde_json::{Value, json};

/// Longest line of a response file. [bytes]
const MAX_LINE: usize = 4 << 20;

/// The line of a request file for a question.
pub fn request_line(question: &Question) -> String {
    let line = json!({
        "custom_id": question.hash(),
        "method": "POST",
        "url": "/v1/chat/completions",
        "body": {
            "model": plain_name(&question.model),
            "messages": messages(question),
            "response_format": {
                "type": "json_schema",
                "json_schema": {"name": question.schema_name, "schema": question.schema, "strict": false}
            }
        }
    });
    line.to_string()
}

fn messages(question: &Question) -> Vec<Value> {
    let system = json!({"role": "system", "content": question.system});
    let turns = question.turns.iter().map(|turn| {
        let role = match turn.speaker {
            Speaker::User => "user",
            Speaker::Assistant => "assistant",
        };
        json!({"role": role, "content": turn.text})
    });
    std::iter::once(system).chain(turns).collect()
}

#[derive(Deserialize)]
struct ResponseLine {
    custom_id: String,
    response: Option<Response>,
    error: Option<Value>,
}

#[derive(Deserialize)]
struct Response {
    status_code: Option<u16>,
    body: Option<Body>,
}

#[derive(Deserialize)]
struct Body {
    #[serde(default)]
    choices: Vec<Choice>,
    usage: Option<Usage>,
}

#[derive(Deserialize)]
struct Choice {
    message: Message,
}

#[derive(Deserialize)]
struct Message {
    content: Option<String>,
}

#[derive(Deserialize)]
struct Usage {
    #[serde(default)]
    prompt_tokens: u64,
    #[serde(default)]
    completion_tokens: u64,
}

/// The exchanges in a response file. `questions` are those that were asked. A line that cannot be used gets a diagnostic
/// with its number, and the others go on.
pub fn read_responses(file: &str, text: &str, questions: &[Question]) -> (Vec<Exchange>, Vec<Diagnostic>) {
    let mut exchanges = Vec::new();
    let mut diagnostics = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        match read_response(line, questions) {
            Ok(exchange) => exchanges.push(exchange),
            Err(message) => {
                let location =
                    Location { file: Some(file.to_owned()), line: Some(index as u64 + 1), ..Location::default() };
                diagnostics.push(Diagnostic::new(Severity::Warning, "batch.response", location, message));
            }
        }
    }
    (exchanges, diagnostics)
}

fn read_response(line: &str, questions: &[Question]) -> Result<Exchange, String> {
    if line.len() > MAX_LINE {
        return Err(format!("the line is longer than {MAX_LINE} bytes"));
    }
    let line: ResponseLine = serde_json::from_str(line).map_err(|e| format!("not a batch response: {e}"))?;
    let question = questions
        .iter()
        .find(|question| question.hash() == line.custom_id)
        .ok_or("its custom_id belongs to no question of this suite")?;
    if let Some(error) = line.error.filter(|error| !error.is_null()) {
        return Err(format!("the provider answered with an error: {error}"));
    }
    let response = line.response.ok_or("it holds no response")?;
    if response.status_code.is_some_and(|status| status != 200) {
        return Err(format!("the provider answered with status {}", response.status_code.unwrap_or_default()));
    }
    let body = response.body.ok_or("its response has no body")?;
    let answer = body.choices.into_iter().next().and_then(|choice| choice.message.content);
    Ok(Exchange {
        format: EXCHANGE_FORMAT.to_owned(),
        hash: line.custom_id,
        question: question.clone(),
        prompts: prompts::version(),
        answer: answer.ok_or("its response has no text")?,
        asked: Asked::Batch,
        input_tokens: body.usage.as_ref().map_or(0, |usage| usage.prompt_tokens),
        output_tokens: body.usage.as_ref().map_or(0, |usage| usage.completion_tokens),
        latency_s: None,
        retries: 0,
        cost_usd: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::llm::question::{Purpose, Role, Turn};

    fn question() -> Question {
        Question {
            model: "m".into(),
            purpose: Purpose { role: Role::Design, scenario_id: "01".into(), attempt: 0 },
            system: "s".into(),
            turns: vec![Turn { speaker: Speaker::User, text: "t".into() }],
            schema_name: "scenario".into(),
            schema: json!({"type": "object"}),
        }
    }

    #[test]
    fn a_request_line_is_one_line_in_the_batch_form() {
        let line = request_line(&question());
        assert!(!line.contains('\n'));
        let value: Value = serde_json::from_str(&line).unwrap();
        assert_eq!(value["custom_id"], question().hash());
        assert_eq!(value["url"], "/v1/chat/completions");
        assert_eq!(value["body"]["messages"][1], json!({"role": "user", "content": "t"}));
    }

    #[test]
    fn good_lines_become_exchanges_and_bad_ones_diagnostics_with_their_line() {
        let hash = question().hash();
        let good = json!({"custom_id": hash, "response": {"status_code": 200, "body": {
            "choices": [{"message": {"content": "{}"}}], "usage": {"prompt_tokens": 7, "completion_tokens": 2}}}});
        let failed = json!({"custom_id": hash, "response": {"status_code": 500, "body": {}}});
        let stranger = json!({"custom_id": "x", "response": null});
        let text = format!("{good}\nnonsense\n{failed}\n{stranger}\n");
        let (exchanges, diagnostics) = read_responses("responses.jsonl", &text, &[question()]);
        assert_eq!((exchanges[0].answer.as_str(), exchanges[0].input_tokens), ("{}", 7));
        let lines: Vec<_> = diagnostics.iter().map(|d| d.location.line).collect();
        assert_eq!(lines, [Some(2), Some(3), Some(4)]);
    }
}
