//! Live models: OpenAI and compatible servers, Anthropic, Gemini, Ollama.
//!
//! The one place of this crate that speaks to a network. Keys go from the environment into the header they belong in; they
//! are blacked out in whatever comes back. Every answer is bounded in time and in bytes, and compressed ones are not asked
//! for: what is counted on the way is what is kept in memory.
//!
//! What this module does **not** do: it does not judge answers. A silly one is an answer.

use crate::llm::access::LiveOptions;
use crate::llm::answers::{Answers, AskError, Ledger};
use crate::llm::fault::{self, CONNECT_S, Fault, MOST_BYTES};
use crate::llm::prompts;
use crate::llm::providers::{Provider, provider};
use crate::llm::question::{Asked, EXCHANGE_FORMAT, Exchange, Question, bounded_answer};
use crate::llm::spending::{Spending, Tokens};
use crate::llm::wire::{Reply, Wire};
use recrash_model::Seed;
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};
use ureq::Agent;
use ureq::http::Uri;

/// Longest wait that a provider may ask for; past it, the question is given up. [s]
const LONGEST_WAIT_S: f64 = 120.0;
/// First wait after a passing fault; each further one is twice as long. [s]
const FIRST_WAIT_S: f64 = 1.0;
/// Most that is read of an error. [bytes]
const MOST_ERROR_BYTES: u64 = 1 << 16;
/// Anthropic's protocol as it is spoken here.
const ANTHROPIC_VERSION: &str = "2023-06-01";

/// Answers of live models, through the ledger. May be asked from several threads.
pub struct Live {
    ledger: Arc<dyn Ledger>,
    options: LiveOptions,
    spending: Arc<Spending>,
    agent: Agent,
    /// Every model that may be asked.
    models: Vec<String>,
    /// Whether all of them can be asked, found out before the first question.
    ready: OnceLock<Result<(), String>>,
    /// No question is sent before this: a provider asked for a pause.
    not_before: Mutex<Option<Instant>>,
    /// The server takes no schema; the prompt has it as well.
    without_schema: AtomicBool,
    /// Why no question will be answered, once that is known.
    refused: OnceLock<String>,
}

/// Where a question goes.
struct Target {
    wire: Wire,
    address: String,
    key: Option<String>,
}

impl Live {
    /// Sets the client up for these models; connects nothing yet.
    pub fn new(ledger: Arc<dyn Ledger>, options: LiveOptions, spending: Arc<Spending>, models: &[&str]) -> Self {
        let connect = Duration::from_secs_f64(options.timeout_s.min(CONNECT_S));
        let config = Agent::config_builder()
            .http_status_as_error(false)
            // A key goes to the address it was given for, and nowhere else.
            .max_redirects(0)
            .timeout_resolve(Some(connect))
            .timeout_connect(Some(connect))
            .timeout_global(Some(Duration::from_secs_f64(options.timeout_s)))
            .user_agent(concat!("recrash/", env!("CARGO_PKG_VERSION")))
            .build();
        Self {
            ledger,
            options,
            spending,
            agent: config.new_agent(),
            models: models.iter().map(|&model| model.to_owned()).collect(),
            ready: OnceLock::new(),
            not_before: Mutex::new(None),
            without_schema: AtomicBool::new(false),
            refused: OnceLock::new(),
        }
    }

    fn checked(&self) -> Result<(), AskError> {
        let ready = self.ready.get_or_init(|| self.check_models());
        ready.clone().map_err(AskError::Refused)
    }

    fn ask(&self, question: &Question) -> Result<Exchange, AskError> {
        self.checked()?;
        let mut retries = 0;
        loop {
            self.wait_for_turn();
            if let Some(why) = self.refused.get() {
                return Err(AskError::Refused(why.clone()));
            }
            self.spending.check(&self.options.caps)?;
            let schema = !self.without_schema.load(Ordering::Relaxed);
            let begun = Instant::now();
            let failed = match self.send(question, schema) {
                Ok((reply, sent)) => return Ok(self.exchange(question, reply, sent, begun.elapsed(), retries)),
                Err(failed) => failed,
            };
            match failed {
                Fault::Refused(why) => return Err(AskError::Refused(why)),
                Fault::Request(_) if schema => self.without_schema.store(true, Ordering::Relaxed),
                Fault::Request(why) => return Err(self.given_up(question, &why, retries, true)),
                Fault::Endless(why) => {
                    // Whoever writes so much is paid for it.
                    self.spending.add_lost(Tokens::estimate(question.bytes()) + Tokens::estimate(MOST_BYTES as usize));
                    return Err(self.given_up(question, &why, retries, false));
                }
                Fault::Passing { why, reachable: false, .. } if self.spending.spent().answers == 0 => {
                    return Err(self.given_up(question, &why, retries, true));
                }
                Fault::Passing { why, retry_after_s, reachable } => {
                    if retries == self.options.retries || retry_after_s.is_some_and(|s| s > LONGEST_WAIT_S) {
                        return Err(self.given_up(question, &why, retries, !reachable));
                    }
                    self.pause(question, retries, retry_after_s);
                    retries += 1;
                }
            }
        }
    }

    /// Sends a question; gives the reply and the bytes that were sent.
    fn send(&self, question: &Question, schema: bool) -> Result<(Reply, usize), Fault> {
        let target = self.target(&question.model).map_err(Fault::Refused)?;
        let url = format!("{}{}", target.address, target.wire.path(&question.model));
        let body = target.wire.body(question, schema).to_string();
        let mut request = self.agent.post(&url).header("content-type", "application/json");
        if target.wire == Wire::Anthropic {
            request = request.header("anthropic-version", ANTHROPIC_VERSION);
        }
        if let Some(key) = &target.key {
            let (name, content) = target.wire.key_header(key);
            request = request.header(name, content);
        }
        let failed = |error: ureq::Error| Fault::of(&error, &url, &self.options);
        let mut response = request.send(body.as_bytes()).map_err(failed)?;
        let status = response.status().as_u16();
        if status != 200 {
            let told = response.body_mut().with_config().limit(MOST_ERROR_BYTES).read_to_vec().unwrap_or_default();
            return Err(Fault::of_response(status, response.headers(), &told, &self.options));
        }
        let bytes = response.body_mut().with_config().limit(MOST_BYTES).read_to_vec().map_err(failed)?;
        let reply = serde_json::from_slice(&bytes).ok().and_then(|body| target.wire.reply(&body));
        reply.map(|reply| (reply, body.len())).ok_or_else(Fault::broken)
    }

    /// Where a model is asked.
    fn target(&self, model: &str) -> Result<Target, String> {
        if let Some(base_url) = &self.options.base_url {
            let key = self.options.key.as_ref().map(|key| key.expose().to_owned());
            return Ok(Target { wire: Wire::OpenAi, address: base_url.trim_end_matches('/').to_owned(), key });
        }
        let Provider { wire, address, key_variable, .. } = provider(model)?;
        let key = match key_variable {
            Some(variable) => match (self.options.provider_key)(variable) {
                Some(key) => Some(key.expose().to_owned()),
                None => return Err(format!("{model} needs a key: set the environment variable {variable} to it")),
            },
            None => None,
        };
        Ok(Target { wire, address: address.to_owned(), key })
    }

    /// Nothing is paid for as long as a key is missing or nobody answers at one of several addresses; a single one tells
    /// by itself.
    fn check_models(&self) -> Result<(), String> {
        let mut addresses: Vec<String> = Vec::new();
        for model in &self.models {
            addresses.push(self.target(model)?.address);
        }
        addresses.sort();
        addresses.dedup();
        // Behind a proxy it is the proxy that answers.
        let probed = if addresses.len() > 1 && ureq::Proxy::try_from_env().is_none() { &addresses[..] } else { &[] };
        probed.iter().try_for_each(|address| connects(address).map_err(|why| fault::unreachable(address, &why)))
    }

    /// Why a question is given up. A fault that may be everybody's stops the run as long as nothing was answered at all:
    /// then it is the address or the request that is wrong, and not the moment.
    fn given_up(&self, question: &Question, why: &str, retries: u32, may_be_everybodys: bool) -> AskError {
        let times = if retries == 0 { "once".to_owned() } else { format!("{} times", retries + 1) };
        let text = format!("{} did not answer (asked {times}): {why}", question.model);
        match may_be_everybodys && self.spending.spent().answers == 0 {
            true => AskError::Refused(text),
            false => AskError::Trouble(text),
        }
    }

    fn wait_for_turn(&self) {
        let until = *self.not_before.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(until) = until {
            std::thread::sleep(until.saturating_duration_since(Instant::now()));
        }
    }

    /// Waits twice as long each time, with jitter so that not all come back at once; or as long as the provider asks
    /// for, and then everybody waits.
    fn pause(&self, question: &Question, retries: u32, asked_s: Option<f64>) {
        let jitter = Seed(u64::from(retries)).child(&question.hash()).rng().uniform();
        if let Some(asked_s) = asked_s {
            let until = Instant::now() + Duration::from_secs_f64(asked_s);
            let mut not_before = self.not_before.lock().unwrap_or_else(PoisonError::into_inner);
            *not_before = (*not_before).max(Some(until));
        }
        let own_s = FIRST_WAIT_S * f64::from(1_u32 << retries.min(6)) * (0.5 + jitter);
        let wait_s = asked_s.map_or(own_s, |asked_s| asked_s + 0.2 * jitter);
        std::thread::sleep(Duration::from_secs_f64(wait_s.min(LONGEST_WAIT_S)));
    }

    fn exchange(&self, question: &Question, reply: Reply, sent: usize, latency: Duration, retries: u32) -> Exchange {
        let tokens = Tokens::of(&reply, sent);
        let price = self.options.prices.price(&question.model);
        Exchange {
            format: EXCHANGE_FORMAT.to_owned(),
            hash: question.hash(),
            question: question.clone(),
            prompts: prompts::version(),
            answer: bounded_answer(&self.options.scrubber.scrub(&reply.text)),
            answer_sha256: None,
            asked: if self.options.base_url.is_some() { Asked::Server } else { Asked::Live },
            input_tokens: tokens.input,
            output_tokens: tokens.output,
            tokens_estimated: tokens.estimated,
            latency_s: Some((latency.as_secs_f64() * 1e3).round() / 1e3),
            retries,
            cost_usd: price.map(|price| price.cost_usd(tokens.input, tokens.output)),
        }
        .sealed()
    }
}

impl Answers for Live {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        if let Some(exchange) = self.ledger.find(&question.hash()).map_err(AskError::Ledger)? {
            return Ok(exchange);
        }
        let exchange = self.ask(question).inspect_err(|error| {
            if let AskError::Refused(why) = error {
                // Another thread may have been told first: the same.
                let _ = self.refused.set(why.clone());
            }
        })?;
        self.spending.add(&exchange);
        self.ledger.keep(&exchange).map_err(AskError::Ledger)?;
        Ok(exchange)
    }

    fn ready(&self) -> Result<(), AskError> {
        self.checked()
    }
}

/// Whether anybody listens at an address; looking its name up is bounded in time like the rest.
fn connects(address: &str) -> Result<(), String> {
    let patience = Duration::from_secs_f64(CONNECT_S);
    let uri: Uri = address.parse().map_err(|_| "it is no address".to_owned())?;
    let port = uri.port_u16().unwrap_or(if uri.scheme_str() == Some("http") { 80 } else { 443 });
    let host = uri.host().unwrap_or_default().trim_matches(['[', ']']).to_owned();
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let mut told = Err("its name is not known".to_owned());
        for place in (host.as_str(), port).to_socket_addrs().into_iter().flatten() {
            told = TcpStream::connect_timeout(&place, patience).map(drop).map_err(|e| e.to_string());
            if told.is_ok() {
                break;
            }
        }
        // Who asked may have gone.
        let _ = sender.send(told);
    });
    receiver.recv_timeout(patience).unwrap_or_else(|_| Err(format!("no connection within {CONNECT_S} s")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_listens_is_told_from_who_does_not() {
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}/v1", listener.local_addr().unwrap());
        assert_eq!(connects(&address), Ok(()));
        drop(listener);
        assert!(connects(&address).is_err());
    }
}
