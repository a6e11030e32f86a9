//! A live model, through the `genai` client: OpenAI and compatible servers, Anthropic, Gemini, Ollama and others.
//!
//! The one place in this project that speaks to a network. Keys come from the environment, as `genai` names them
//! (`OPENAI_API_KEY`, `ANTHROPIC_API_KEY`, `GEMINI_API_KEY`, ...); they are put into no question, answer or error.

use crate::llm::answers::{Answers, AskError, Ledger};
use crate::llm::question::{EXCHANGE_FORMAT, Exchange, Question, Speaker};
use genai::adapter::AdapterKind;
use genai::chat::{ChatMessage, ChatOptions, ChatRequest, ChatResponse, JsonSpec};
use genai::resolver::{AuthData, Endpoint};
use genai::{Client, ClientBuilder, ModelIden, ServiceTarget, WebConfig};
use recrash_model::Seed;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use tokio::runtime::Runtime;
use tokio::sync::Semaphore;
use tokio::time::Instant;

/// Longest wait that a provider may ask for. [s]
const MAX_WAIT_S: f64 = 120.0;
/// First wait after a passing fault; each further one is twice as long. [s]
const FIRST_WAIT_S: f64 = 1.0;
/// Longest text of a provider's error that is passed on. [characters]
const MAX_ERROR_TEXT: usize = 300;

/// How a live model is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveOptions {
    /// Base address of an OpenAI-compatible server (Ollama, vLLM, llama.cpp); the model's own provider where not given.
    pub base_url: Option<String>,
    /// Environment variable that holds the key for `base_url`; no key is sent where not given.
    pub key_variable: Option<String>,
    /// Longest time for one answer. [s]
    pub timeout_s: f64,
    /// How often a question is asked again after a passing fault (429, 5xx, time-out, broken connection).
    pub retries: u32,
    /// Questions under way at once.
    pub concurrency: usize,
    /// Tokens, read and written together, after which no further question is asked.
    pub max_tokens: Option<u64>,
    /// Money after which no further question is asked; needs prices. [USD]
    pub max_cost_usd: Option<f64>,
    /// Price of a million tokens read and a million written. [USD]
    pub price_per_million_usd: Option<(f64, f64)>,
}

impl Default for LiveOptions {
    fn default() -> Self {
        Self {
            base_url: None,
            key_variable: None,
            timeout_s: 120.0,
            retries: 4,
            concurrency: 4,
            max_tokens: None,
            max_cost_usd: None,
            price_per_million_usd: None,
        }
    }
}

/// Answers of a live model, through the ledger.
pub struct Live<'a> {
    ledger: &'a dyn Ledger,
    options: LiveOptions,
    runtime: Runtime,
    client: Client,
    permits: Semaphore,
    spent: Mutex<(u64, u64)>,
}

impl<'a> Live<'a> {
    /// Connects nothing yet.
    ///
    /// # Errors
    /// The runtime or the client cannot be set up, or a cap on money lacks prices.
    pub fn new(ledger: &'a dyn Ledger, options: LiveOptions) -> Result<Self, AskError> {
        if options.max_cost_usd.is_some() && options.price_per_million_usd.is_none() {
            return Err(AskError::Provider("a cap on money needs prices: add --price IN,OUT (USD per million)".into()));
        }
        let failed = |what: &str, e: &dyn std::fmt::Display| AskError::Provider(format!("cannot set up {what}: {e}"));
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .map_err(|e| failed("the network runtime", &e))?;
        let web = WebConfig::default()
            .with_timeout(Duration::from_secs_f64(options.timeout_s))
            .with_connect_timeout(Duration::from_secs_f64(options.timeout_s.min(10.0)));
        let mut builder: ClientBuilder = Client::builder().with_web_config(web);
        if let Some(base_url) = options.base_url.clone() {
            // The adapter joins paths to the address: it must end in a slash.
            let base_url = format!("{}/", base_url.trim_end_matches('/'));
            let auth = options.key_variable.clone().map_or_else(|| AuthData::from_single("none"), AuthData::from_env);
            builder = builder.with_service_target_resolver_fn(move |target: ServiceTarget| {
                let model = ModelIden::new(AdapterKind::OpenAI, target.model.model_name);
                Ok(ServiceTarget { endpoint: Endpoint::from_owned(base_url.clone()), auth: auth.clone(), model })
            });
        }
        let client = builder.build().map_err(|e| failed("the model client", &e))?;
        let permits = Semaphore::new(options.concurrency.max(1));
        Ok(Self { ledger, options, runtime, client, permits, spent: Mutex::new((0, 0)) })
    }

    fn check_budget(&self) -> Result<(), AskError> {
        let (input, output) = *self.spent.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(cap) = self.options.max_tokens
            && input + output >= cap
        {
            return Err(AskError::BudgetSpent(format!("the cap of {cap} tokens is reached ({})", input + output)));
        }
        if let (Some(cap), Some((in_price, out_price))) =
            (self.options.max_cost_usd, self.options.price_per_million_usd)
        {
            let cost = (input as f64 * in_price + output as f64 * out_price) / 1e6;
            if cost >= cap {
                return Err(AskError::BudgetSpent(format!("the cap of {cap} USD is reached ({cost:.2} USD)")));
            }
        }
        Ok(())
    }

    async fn ask(&self, question: &Question) -> Result<Exchange, AskError> {
        let _permit = self.permits.acquire().await.map_err(|e| AskError::Provider(e.to_string()))?;
        self.check_budget()?;
        let mut retries = 0;
        loop {
            let begun = Instant::now();
            match self.client.exec_chat(question.model.as_str(), request(question), Some(&chat_options(question))).await
            {
                Ok(response) => return Ok(self.exchange(question, &response, begun.elapsed(), retries)),
                Err(error) => {
                    let fault = Fault::of(&error);
                    if !fault.passing || retries == self.options.retries {
                        let tries = retries + 1;
                        return Err(AskError::Provider(format!(
                            "{} (asked {tries} times): {}",
                            question.model, fault.text
                        )));
                    }
                    tokio::time::sleep(wait(question, retries, fault.retry_after_s)).await;
                    retries += 1;
                }
            }
        }
    }

    fn exchange(&self, question: &Question, response: &ChatResponse, latency: Duration, retries: u32) -> Exchange {
        let tokens = |n: Option<i32>| n.and_then(|n| u64::try_from(n).ok()).unwrap_or(0);
        let (input, output) = (tokens(response.usage.prompt_tokens), tokens(response.usage.completion_tokens));
        let mut spent = self.spent.lock().unwrap_or_else(PoisonError::into_inner);
        *spent = (spent.0 + input, spent.1 + output);
        Exchange {
            format: EXCHANGE_FORMAT.to_owned(),
            hash: question.hash(),
            question: question.clone(),
            answer: response.first_text().unwrap_or_default().to_owned(),
            input_tokens: input,
            output_tokens: output,
            latency_ms: u64::try_from(latency.as_millis()).unwrap_or(u64::MAX),
            retries,
        }
    }
}

impl Answers for Live<'_> {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        if let Some(exchange) = self.ledger.find(&question.hash()) {
            return Ok(exchange);
        }
        let exchange = self.runtime.block_on(self.ask(question))?;
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

fn chat_options(question: &Question) -> ChatOptions {
    ChatOptions::default()
        .with_response_format(JsonSpec::new(question.schema_name.as_str(), question.schema.clone()))
        .with_capture_usage(true)
}

/// Waits as long as the provider asks for, or twice as long each time, with jitter so that not all come back at once.
fn wait(question: &Question, retries: u32, asked_s: Option<f64>) -> Duration {
    let jitter = Seed(u64::from(retries)).child(&question.hash()).rng().uniform();
    let own = FIRST_WAIT_S * f64::from(1_u32 << retries.min(6)) * (0.5 + jitter);
    Duration::from_secs_f64(asked_s.map_or(own, |s| s.max(0.0) + 0.1 * jitter).min(MAX_WAIT_S))
}

/// A provider's error as this program sees it.
struct Fault {
    passing: bool,
    retry_after_s: Option<f64>,
    text: String,
}

impl Fault {
    fn of(error: &genai::Error) -> Self {
        use genai::webc::Error as Web;
        let web = match error {
            genai::Error::WebModelCall { webc_error, .. } | genai::Error::WebAdapterCall { webc_error, .. } => {
                webc_error
            }
            other => return Self { passing: false, retry_after_s: None, text: brief(&other.to_string()) },
        };
        let status = web.status().map(|status| status.as_u16());
        let retry_after_s = web
            .headers()
            .and_then(|headers| headers.get("retry-after"))
            .and_then(|value| value.to_str().ok()?.trim().parse().ok());
        let (passing, text) = match (web, status) {
            (_, Some(status)) => (matches!(status, 408 | 409 | 425 | 429 | 500..=599), format!("status {status}")),
            (Web::Reqwest(e), None) if e.is_timeout() => (true, "no answer in time".to_owned()),
            (Web::Reqwest(e), None) if e.is_connect() => (true, "cannot connect".to_owned()),
            (Web::Reqwest(_), None) => (true, "the connection broke off".to_owned()),
            (Web::ResponseFailedInvalidJson { .. } | Web::ResponseFailedNotJson { .. }, None) => {
                (true, "the server's answer was not JSON or was cut off".to_owned())
            }
            (other, None) => (false, brief(&other.to_string())),
        };
        Self { passing, retry_after_s, text }
    }
}

/// The beginning of a text, on one line.
fn brief(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(MAX_ERROR_TEXT).collect()
}
