//! Live models, through the `genai` client: OpenAI and compatible servers, Anthropic, Gemini, Ollama and others.
//!
//! The one place of this crate that speaks to a network, and the one that knows providers. Keys go from the environment
//! into the header they belong in; they are blacked out in whatever comes back.
//!
//! What this module does **not** do: it does not judge answers. A silly one is an answer.

use crate::llm::access::LiveOptions;
use crate::llm::answers::{Answers, AskError, Ledger};
use crate::llm::fault::Fault;
use crate::llm::prompts;
use crate::llm::question::{Asked, EXCHANGE_FORMAT, Exchange, Question, Speaker};
use crate::llm::secrets::redact;
use crate::llm::spending::Spending;
use genai::adapter::AdapterKind;
use genai::chat::{ChatMessage, ChatOptions, ChatRequest, ChatResponse, JsonSpec};
use genai::resolver::{AuthData, Endpoint};
use genai::{Client, ModelIden, ServiceTarget, WebConfig};
use recrash_model::Seed;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;
use tokio::runtime::Runtime;
use tokio::time::Instant;

/// Longest time until a connection stands. [s]
const CONNECT_S: f64 = 15.0;
/// Longest wait that a provider may ask for; past it, the question is given up. [s]
const LONGEST_WAIT_S: f64 = 120.0;
/// First wait after a passing fault; each further one is twice as long. [s]
const FIRST_WAIT_S: f64 = 1.0;
/// OpenAI-compatible address of Ollama on this machine; its own protocol takes no schema through `genai`.
const OLLAMA: &str = "http://localhost:11434/v1/";
/// What servers without keys are given for one: the protocol wants a header.
const NO_KEY: &str = "none";

/// Answers of live models, through the ledger. May be asked from several threads.
pub struct Live {
    ledger: Arc<dyn Ledger>,
    options: LiveOptions,
    spending: Arc<Spending>,
    runtime: Runtime,
    client: Client,
    /// No question is sent before this: a provider asked for a pause.
    not_before: Mutex<Option<Instant>>,
    /// The server takes no schema; the prompt has it as well.
    without_schema: AtomicBool,
    /// Why no question will be answered, once that is known.
    refused: OnceLock<String>,
}

impl Live {
    /// Sets the client up; connects nothing yet.
    ///
    /// # Errors
    /// The client cannot be set up on this machine.
    pub fn new(ledger: Arc<dyn Ledger>, options: LiveOptions, spending: Arc<Spending>) -> Result<Self, AskError> {
        let failed = |e: &dyn std::fmt::Display| AskError::Refused(format!("cannot set up the model client: {e}"));
        // Another one may be installed already: the same.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build();
        let runtime = runtime.map_err(|e| failed(&e))?;
        let web = WebConfig::default()
            .with_timeout(Duration::from_secs_f64(options.timeout_s))
            .with_connect_timeout(Duration::from_secs_f64(options.timeout_s.min(CONNECT_S)));
        let client = Client::builder().with_web_config(web).build().map_err(|e| failed(&e))?;
        let (not_before, without_schema, refused) = (Mutex::new(None), AtomicBool::new(false), OnceLock::new());
        Ok(Self { ledger, options, spending, runtime, client, not_before, without_schema, refused })
    }

    async fn ask(&self, question: &Question) -> Result<Exchange, AskError> {
        let mut retries = 0;
        loop {
            self.wait_for_turn().await;
            if let Some(why) = self.refused.get() {
                return Err(AskError::Refused(why.clone()));
            }
            self.spending.check(&self.options.caps)?;
            let schema = !self.without_schema.load(Ordering::Relaxed);
            let begun = Instant::now();
            let fault = match self.send(question, schema).await {
                Ok(response) => return Ok(self.exchange(question, &response, begun.elapsed(), retries)),
                Err(error) => Fault::of(&error, &self.options),
            };
            match fault {
                Fault::Refused(why) => return Err(AskError::Refused(why)),
                Fault::Request(_) if schema => self.without_schema.store(true, Ordering::Relaxed),
                Fault::Request(why) => return Err(self.given_up(question, &why, retries, true)),
                Fault::Passing { why, retry_after_s, reachable } => {
                    if retries == self.options.retries || retry_after_s.is_some_and(|s| s > LONGEST_WAIT_S) {
                        return Err(self.given_up(question, &why, retries, !reachable));
                    }
                    self.pause(question, retries, retry_after_s).await;
                    retries += 1;
                }
            }
        }
    }

    async fn send(&self, question: &Question, schema: bool) -> genai::Result<ChatResponse> {
        let target = self.target(&question.model).await?;
        let options = ChatOptions::default().with_capture_usage(true).with_normalize_reasoning_content(true);
        let options = match schema {
            true => options.with_response_format(JsonSpec::new(question.schema_name.as_str(), question.schema.clone())),
            false => options,
        };
        self.client.exec_chat(target, request(question), Some(&options)).await
    }

    /// Where a model is asked.
    async fn target(&self, model: &str) -> genai::Result<ServiceTarget> {
        let compatible = |address: String, key: &str, name: &str| ServiceTarget {
            endpoint: Endpoint::from_owned(address),
            auth: AuthData::from_single(key),
            model: ModelIden::new(AdapterKind::OpenAI, name),
        };
        if let Some(base_url) = &self.options.base_url {
            let key = self.options.key.as_ref().map_or(NO_KEY, |key| key.expose());
            // The client joins paths to the address: it must end in a slash.
            return Ok(compatible(format!("{}/", base_url.trim_end_matches('/')), key, model));
        }
        let target = self.client.resolve_service_target(model).await?;
        Ok(match target.model.adapter_kind {
            AdapterKind::Ollama => compatible(OLLAMA.to_owned(), NO_KEY, super::prices::plain_name(model)),
            _ => target,
        })
    }

    /// Why a question is given up. A fault that may be everybody's stops the run as long as nothing was answered at all:
    /// then it is the address or the request that is wrong, and not the moment.
    fn given_up(&self, question: &Question, why: &str, retries: u32, may_be_everybodys: bool) -> AskError {
        let text = format!("{} did not answer (asked {} times): {why}", question.model, retries + 1);
        match may_be_everybodys && self.spending.spent().answers == 0 {
            true => AskError::Refused(text),
            false => AskError::Trouble(text),
        }
    }

    async fn wait_for_turn(&self) {
        let until = *self.not_before.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(until) = until {
            tokio::time::sleep_until(until).await;
        }
    }

    /// Waits twice as long each time, with jitter so that not all come back at once; or as long as the provider asks
    /// for, and then everybody waits.
    async fn pause(&self, question: &Question, retries: u32, asked_s: Option<f64>) {
        let jitter = Seed(u64::from(retries)).child(&question.hash()).rng().uniform();
        if let Some(asked_s) = asked_s {
            let until = Instant::now() + Duration::from_secs_f64(asked_s);
            let mut not_before = self.not_before.lock().unwrap_or_else(PoisonError::into_inner);
            *not_before = (*not_before).max(Some(until));
        }
        let own_s = FIRST_WAIT_S * f64::from(1_u32 << retries.min(6)) * (0.5 + jitter);
        let wait_s = asked_s.map_or(own_s, |asked_s| asked_s + 0.2 * jitter);
        tokio::time::sleep(Duration::from_secs_f64(wait_s.min(LONGEST_WAIT_S))).await;
    }

    fn exchange(&self, question: &Question, response: &ChatResponse, latency: Duration, retries: u32) -> Exchange {
        let tokens = |count: Option<i32>| count.and_then(|n| u64::try_from(n).ok()).unwrap_or(0);
        let input_tokens = tokens(response.usage.prompt_tokens);
        let output_tokens = tokens(response.usage.completion_tokens);
        let price = self.options.prices.price(&question.model);
        Exchange {
            format: EXCHANGE_FORMAT.to_owned(),
            hash: question.hash(),
            question: question.clone(),
            prompts: prompts::version(),
            answer: redact(&response.texts().concat(), &self.options.secrets),
            asked: if self.options.base_url.is_some() { Asked::Server } else { Asked::Live },
            input_tokens,
            output_tokens,
            latency_s: Some((latency.as_secs_f64() * 1e3).round() / 1e3),
            retries,
            cost_usd: price.map(|price| price.cost_usd(input_tokens, output_tokens)),
        }
    }
}

impl Answers for Live {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        if let Some(exchange) = self.ledger.find(&question.hash()) {
            return Ok(exchange);
        }
        let exchange = self.runtime.block_on(self.ask(question)).inspect_err(|error| {
            if let AskError::Refused(why) = error {
                // Another thread may have been told first: the same.
                let _ = self.refused.set(why.clone());
            }
        })?;
        self.spending.add(&exchange);
        self.ledger.keep(&exchange).map_err(AskError::Ledger)?;
        Ok(exchange)
    }
}

fn request(question: &Question) -> ChatRequest {
    let messages = question.turns.iter().map(|turn| match turn.speaker {
        Speaker::User => ChatMessage::user(turn.text.as_str()),
        Speaker::Assistant => ChatMessage::assistant(turn.text.as_str()),
    });
    ChatRequest::new(messages.collect()).with_system(question.system.as_str())
}
