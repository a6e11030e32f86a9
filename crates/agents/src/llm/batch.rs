//! Batch files in OpenAI's form: one JSON object per line, a request with our `custom_id`, or a response with it.

use crate::llm::prompts;
use crate::llm::question::{Asked, EXCHANGE_FORMAT, Exchange, Question, bounded_answer};
use crate::llm::secrets::Scrubber;
use crate::llm::spending::Tokens;
use crate::llm::wire::{Reply, Wire, openai_body};
use recrash_model::Diagnostic;
use recrash_model::diagnostic::{Location, Severity};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Longest line of a response file. [bytes]
pub const LONGEST_RESPONSE: usize = 4 << 20;
/// Most lines that are told one by one.
const MOST_TOLD: usize = 1_000;
/// Longest text of a provider's that is passed on. [characters]
const LONGEST_TEXT: usize = 240;

/// The line of a request file for a question.
pub fn request_line(question: &Question) -> String {
    let line = json!({
        "custom_id": question.hash(),
        "method": "POST",
        "url": "/v1/chat/completions",
        "body": openai_body(question, true),
    });
    line.to_string()
}

/// Reads a response file line by line.
pub struct Responses<'a> {
    file: &'a str,
    /// Questions that were asked, by hash.
    questions: BTreeMap<String, &'a Question>,
    scrubber: &'a Scrubber,
    /// Lines that answered a question, by its hash.
    answered: BTreeMap<String, u64>,
    /// What was wrong with the lines of those that are not answered, by hash.
    problems: BTreeMap<String, String>,
    diagnostics: Vec<Diagnostic>,
    /// Lines beyond those that are told.
    untold: usize,
}

/// What is wrong with a line, and whose answer it would have been.
struct Unusable {
    hash: Option<String>,
    why: String,
}

impl<'a> Responses<'a> {
    /// Nothing read yet. `questions` are those that were asked.
    pub fn new(file: &'a str, questions: &'a [Question], scrubber: &'a Scrubber) -> Self {
        Self {
            file,
            questions: questions.iter().map(|question| (question.hash(), question)).collect(),
            scrubber,
            answered: BTreeMap::new(),
            problems: BTreeMap::new(),
            diagnostics: Vec::new(),
            untold: 0,
        }
    }

    /// The exchange that a line tells; `None` where it is blank or cannot be used, which is told. `number` counts from 1;
    /// `line` is at most one byte longer than [`LONGEST_RESPONSE`].
    pub fn line(&mut self, number: u64, line: &[u8]) -> Option<Exchange> {
        let line = if number == 1 { line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line) } else { line };
        if line.trim_ascii().is_empty() {
            return None;
        }
        match self.read(line) {
            Ok((exchange, refused)) => {
                if refused {
                    let said = self.presentable(&exchange.answer);
                    self.tell(Some(number), format!("the model refuses to answer: {said}"));
                }
                self.answered.insert(exchange.hash.clone(), number);
                self.problems.remove(&exchange.hash);
                Some(exchange)
            }
            Err(Unusable { hash, why }) => {
                if let Some(hash) = hash.filter(|hash| !self.answered.contains_key(hash)) {
                    self.problems.insert(hash, why.clone());
                }
                self.tell(Some(number), why);
                None
            }
        }
    }

    /// The questions without a usable answer, by hash, with what was wrong; and what there is to tell.
    pub fn finish(mut self) -> (BTreeMap<String, String>, Vec<Diagnostic>) {
        let unanswered = self.questions.keys().filter(|hash| !self.answered.contains_key(*hash));
        let why = |hash: &String| self.problems.get(hash).cloned().unwrap_or_else(|| "no line answers it".to_owned());
        let unanswered: BTreeMap<String, String> = unanswered.map(|hash| (hash.clone(), why(hash))).collect();
        if self.untold > 0 {
            let more = format!("{} more lines cannot be used", self.untold);
            self.diagnostics.push(self.diagnostic(None, more));
        }
        if !unanswered.is_empty() {
            let (count, all) = (unanswered.len(), self.questions.len());
            let message = format!(
                "{count} of {all} questions have no usable answer; they are asked again as often as answers may be repaired, \
                 and then the rules take over"
            );
            self.diagnostics.push(self.diagnostic(None, message));
        }
        (unanswered, self.diagnostics)
    }

    fn read(&self, line: &[u8]) -> Result<(Exchange, bool), Unusable> {
        let nobodys = |why: String| Unusable { hash: None, why };
        if line.len() > LONGEST_RESPONSE {
            return Err(nobodys(format!("the line is longer than {LONGEST_RESPONSE} bytes")));
        }
        let text = std::str::from_utf8(line).map_err(|_| nobodys("the line is no text (not UTF-8)".to_owned()))?;
        if text.trim_start().starts_with('<') {
            return Err(nobodys("the line is a piece of a web page, and no batch response".to_owned()));
        }
        let value: Value = serde_json::from_str(text).map_err(|e| nobodys(format!("the line is no JSON: {e}")))?;
        let Some(hash) = value["custom_id"].as_str() else {
            return Err(nobodys("the line is no batch response: it has no custom_id".to_owned()));
        };
        let Some(question) = self.questions.get(hash) else {
            return Err(nobodys("its custom_id belongs to no question that waits".to_owned()));
        };
        let unusable = |why: String| Unusable { hash: Some(hash.to_owned()), why };
        if let Some(line) = self.answered.get(hash) {
            return Err(unusable(format!("its question is answered by line {line} already")));
        }
        let error = [&value["error"], &value["response"]["body"]["error"]].into_iter().find(|error| !error.is_null());
        if let Some(error) = error {
            let told = error["message"].as_str().map_or_else(|| error.to_string(), str::to_owned);
            return Err(unusable(format!("the provider answered with an error: {}", self.presentable(&told))));
        }
        let response = &value["response"];
        match &response["status_code"] {
            Value::Null => {}
            status if *status == 200 => {}
            status => {
                return Err(unusable(format!(
                    "the provider answered with status {}",
                    self.presentable(&status.to_string())
                )));
            }
        }
        let Some(reply) = Wire::OpenAi.reply(&response["body"]) else {
            return Err(unusable("its response holds no answer as the protocol has it".to_owned()));
        };
        if reply.text.trim().is_empty() {
            return Err(unusable("its response has no text".to_owned()));
        }
        let refused = reply.refused;
        Ok((self.exchange(hash, question, &reply), refused))
    }

    fn exchange(&self, hash: &str, question: &Question, reply: &Reply) -> Exchange {
        let tokens = Tokens::of(reply, openai_body(question, true).to_string().len());
        Exchange {
            format: EXCHANGE_FORMAT.to_owned(),
            hash: hash.to_owned(),
            question: question.clone(),
            prompts: prompts::version(),
            answer: bounded_answer(&self.scrubber.scrub(&reply.text)),
            answer_sha256: None,
            asked: Asked::Batch,
            input_tokens: tokens.input,
            output_tokens: tokens.output,
            tokens_estimated: tokens.estimated,
            latency_s: None,
            retries: 0,
            cost_usd: None,
        }
        .sealed()
    }

    fn tell(&mut self, line: Option<u64>, message: String) {
        if self.diagnostics.len() < MOST_TOLD {
            self.diagnostics.push(self.diagnostic(line, message));
        } else {
            self.untold += 1;
        }
    }

    fn diagnostic(&self, line: Option<u64>, message: String) -> Diagnostic {
        let location = Location { file: Some(self.file.to_owned()), line, ..Location::default() };
        Diagnostic::new(Severity::Warning, "batch.response", location, message)
    }

    /// The beginning of a stranger's text, on one line.
    fn presentable(&self, text: &str) -> String {
        let text = self.scrubber.scrub(&text.chars().take(4 * LONGEST_TEXT).collect::<String>());
        let words = text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join(" ").chars().take(LONGEST_TEXT).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::llm::question::{Purpose, Role, Speaker, Turn};

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

    fn good() -> Value {
        json!({"custom_id": question().hash(), "error": null, "response": {"status_code": 200, "body": {
            "choices": [{"message": {"content": "{}"}}], "usage": {"prompt_tokens": 7, "completion_tokens": 2}}}})
    }

    /// Answers, lines that are told, and questions without an answer.
    fn read(text: &[u8]) -> (Vec<Exchange>, Vec<Diagnostic>, usize) {
        let (questions, scrubber) = ([question()], Scrubber::default());
        let mut responses = Responses::new("responses.jsonl", &questions, &scrubber);
        let lines = text.split(|&byte| byte == b'\n').zip(1..);
        let exchanges = lines.filter_map(|(line, number)| responses.line(number, line)).collect();
        let (unanswered, diagnostics) = responses.finish();
        (exchanges, diagnostics, unanswered.len())
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
        let failed = json!({"custom_id": question().hash(), "response": {"status_code": 500, "body": {}}});
        let stranger = json!({"custom_id": "x", "response": null});
        let text = format!("\u{feff}{}\r\n\nnonsense\n{failed}\n{stranger}\n", good());
        let (exchanges, diagnostics, unanswered) = read(text.as_bytes());
        assert_eq!((exchanges[0].answer.as_str(), exchanges[0].input_tokens), ("{}", 7));
        assert_eq!(exchanges[0].check(&question().hash()), Ok(()));
        let lines: Vec<_> = diagnostics.iter().map(|d| d.location.line).collect();
        assert_eq!((lines, unanswered), (vec![Some(3), Some(4), Some(5)], 0));
    }

    #[test]
    fn a_later_line_may_answer_what_an_earlier_one_did_not_and_the_first_answer_counts() {
        let mut other = good();
        other["response"]["body"]["choices"][0]["message"]["content"] = json!("other");
        let failed = json!({"custom_id": question().hash(), "error": {"message": "busy\u{1b}[31m"}});
        let (exchanges, diagnostics, unanswered) = read(format!("{failed}\n{}\n{other}", good()).as_bytes());
        assert_eq!((exchanges.len(), exchanges[0].answer.as_str(), unanswered), (1, "{}", 0));
        assert!(diagnostics[0].message.ends_with("error: busy [31m"), "{}", diagnostics[0]);
        assert!(diagnostics[1].message.contains("by line 2 already"), "{}", diagnostics[1]);
    }

    #[test]
    fn whatever_stands_in_a_line_is_told() {
        let hash = question().hash();
        let with = |place: &str, value: Value| {
            let mut line = good();
            *line.pointer_mut(place).unwrap() = value;
            line.to_string().into_bytes()
        };
        let lines: Vec<(Vec<u8>, &str)> = vec![
            (b"<!DOCTYPE html><html>".to_vec(), "web page"),
            (b"{\"custom_id\": \"".to_vec(), "no JSON"),
            (b"\xff\xfe{\x00".to_vec(), "not UTF-8"),
            (b"[]".to_vec(), "no custom_id"),
            (b"null".to_vec(), "no custom_id"),
            (with("/custom_id", json!(7)), "no custom_id"),
            (with("/custom_id", json!(hash.to_uppercase())), "no question that waits"),
            (with("/error", json!("no")), "error: \"no\""),
            (with("/response", json!(null)), "holds no answer"),
            (with("/response/status_code", json!("200")), "status"),
            (with("/response/status_code", json!(429)), "status 429"),
            (with("/response/body", json!([])), "holds no answer"),
            (with("/response/body/choices", json!([])), "holds no answer"),
            (with("/response/body/choices/0/message/content", json!({"a": 1})), "holds no answer"),
            (with("/response/body/choices/0/message/content", json!(" \n")), "no text"),
            (vec![b' '; LONGEST_RESPONSE].into_iter().chain(*b"{}").collect(), "longer than"),
        ];
        for (line, wanted) in lines {
            let (exchanges, diagnostics, unanswered) = read(&line);
            assert_eq!((exchanges.len(), unanswered), (0, 1), "{wanted}");
            assert!(diagnostics[0].message.contains(wanted), "{wanted}: {}", diagnostics[0]);
            assert_eq!(diagnostics[0].location.line, Some(1));
        }
    }

    #[test]
    fn a_refusal_is_an_answer_and_is_told() {
        let mut line = good();
        line["response"]["body"]["choices"][0]["message"] = json!({"content": null, "refusal": "I cannot help"});
        let (exchanges, diagnostics, unanswered) = read(line.to_string().as_bytes());
        assert_eq!((exchanges[0].answer.as_str(), unanswered), ("I cannot help", 0));
        assert!(diagnostics[0].message.contains("refuses"), "{}", diagnostics[0]);
    }

    #[test]
    fn a_file_of_rubbish_is_told_in_a_thousand_lines() {
        let (_, diagnostics, unanswered) = read(&b"x\n".repeat(5_000));
        assert_eq!((diagnostics.len(), unanswered), (MOST_TOLD + 2, 1));
        assert!(diagnostics[MOST_TOLD].message.starts_with("4000 more"), "{}", diagnostics[MOST_TOLD]);
    }
}
