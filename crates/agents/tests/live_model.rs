//! The live client against a scripted server: faults pass, keys stay secret, budgets stop, answers are kept.

mod server;

use recrash_agents::llm::{
    Answers, AskError, Exchange, Ledger, Live, LiveOptions, Purpose, Question, Replay, Role, Speaker, Turn,
};
use server::{Reply, Server};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

#[derive(Default)]
struct Memory(Mutex<BTreeMap<String, Exchange>>);

impl Ledger for Memory {
    fn find(&self, hash: &str) -> Option<Exchange> {
        self.0.lock().unwrap().get(hash).cloned()
    }

    fn keep(&self, exchange: &Exchange) -> Result<(), String> {
        self.0.lock().unwrap().insert(exchange.hash.clone(), exchange.clone());
        Ok(())
    }
}

fn question(text: &str) -> Question {
    Question {
        model: "scripted".into(),
        purpose: Purpose { role: Role::Design, scenario_id: "01".into(), attempt: 0 },
        system: "Answer.".into(),
        turns: vec![Turn { speaker: Speaker::User, text: text.into() }],
        schema_name: "answer".into(),
        schema: serde_json::json!({"type": "object", "properties": {}}),
    }
}

fn options(server: &Server) -> LiveOptions {
    LiveOptions { base_url: Some(server.base_url.clone()), timeout_s: 0.5, retries: 2, ..LiveOptions::default() }
}

fn ask(replies: Vec<Reply>) -> (Result<Exchange, AskError>, usize) {
    let server = Server::start(replies);
    let memory = Memory::default();
    let answer = Live::new(&memory, options(&server)).unwrap().answer(&question("hello"));
    (answer, server.requests().len())
}

fn text() -> Reply {
    Reply::Text("{\"a\": 1}".into())
}

#[test]
fn a_normal_answer_is_kept_with_its_tokens_and_never_asked_again() {
    let server = Server::start(vec![text()]);
    let memory = Memory::default();
    let live = Live::new(&memory, options(&server)).unwrap();
    let exchange = live.answer(&question("hello")).unwrap();
    assert_eq!((exchange.answer.as_str(), exchange.input_tokens, exchange.output_tokens), ("{\"a\": 1}", 100, 20));
    assert_eq!(live.answer(&question("hello")).unwrap(), exchange);
    assert_eq!(server.requests().len(), 1);
    assert_eq!(Replay { ledger: &memory }.answer(&question("hello")).unwrap(), exchange);
    let missing = Replay { ledger: &memory }.answer(&question("something else")).unwrap_err();
    assert!(missing.to_string().contains("design of 01"), "{missing}");
}

#[test]
fn passing_faults_are_asked_again() {
    for fault in [
        Reply::Status(429, "Retry-After: 0\r\n"),
        Reply::Status(500, "Retry-After: 0\r\n"),
        Reply::Hang(Duration::from_secs(2)),
        Reply::CutOff,
    ] {
        let (answer, requests) = ask(vec![fault, text()]);
        assert_eq!((answer.unwrap().retries, requests), (1, 2));
    }
}

#[test]
fn a_fault_that_does_not_pass_is_told_at_once() {
    let (answer, requests) = ask(vec![Reply::Status(401, "")]);
    assert!(answer.unwrap_err().to_string().contains("status 401"));
    assert_eq!(requests, 1);
}

#[test]
fn a_fault_that_stays_is_told_after_the_retries() {
    let (answer, requests) = ask(vec![Reply::Status(503, "Retry-After: 0\r\n")]);
    assert!(answer.unwrap_err().to_string().contains("asked 3 times"));
    assert_eq!(requests, 3);
}

#[test]
fn the_cap_on_tokens_stops_before_the_next_question() {
    let server = Server::start(vec![text()]);
    let memory = Memory::default();
    let live = Live::new(&memory, LiveOptions { max_tokens: Some(100), ..options(&server) }).unwrap();
    live.answer(&question("one")).unwrap();
    assert!(matches!(live.answer(&question("two")), Err(AskError::BudgetSpent(_))));
    assert_eq!(server.requests().len(), 1);
}

#[test]
fn the_cap_on_money_needs_prices_and_then_holds() {
    let server = Server::start(vec![text()]);
    let memory = Memory::default();
    let capped = LiveOptions { max_cost_usd: Some(0.001), ..options(&server) };
    assert!(Live::new(&memory, capped.clone()).is_err());
    let live = Live::new(&memory, LiveOptions { price_per_million_usd: Some((10.0, 30.0)), ..capped }).unwrap();
    live.answer(&question("one")).unwrap();
    assert!(matches!(live.answer(&question("two")), Err(AskError::BudgetSpent(_))));
}

#[test]
fn the_key_reaches_the_server_and_nothing_else() {
    // PATH is set wherever tests run; its value stands in for a key.
    let planted = std::env::var("PATH").unwrap();
    let server = Server::start(vec![text(), Reply::Status(400, "")]);
    let memory = Memory::default();
    let live = Live::new(&memory, LiveOptions { key_variable: Some("PATH".into()), ..options(&server) }).unwrap();
    let exchange = live.answer(&question("one")).unwrap();
    assert!(server.requests()[0].contains(&planted), "the key is sent");
    assert!(!serde_json::to_string(&exchange).unwrap().contains(&planted));
    let error = live.answer(&question("two")).unwrap_err();
    assert!(!format!("{error} {error:?}").contains(&planted));
}
