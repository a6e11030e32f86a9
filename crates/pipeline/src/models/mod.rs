//! The models' side of a suite: its ledger, and where answers come from.

pub(crate) mod cast;
pub(crate) mod ledger;
pub(crate) mod responses;

use crate::error::PipelineError;
use crate::files::store::{Store, read_text};
use crate::models::cast::Cast;
use crate::secrets;
#[cfg(feature = "live")]
use recrash_agents::llm::Live;
use recrash_agents::llm::{
    Answers, AskError, Batch, Caps, Exchange, LanguageModel, Ledger, LiveOptions, PriceTable, Question, Repairs,
    Replay, Spending, Spent, request_line,
};
use recrash_model::Diagnostic;
use responses::{PENDING, REQUESTS, TakenIn, exchange_file};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest file of prices. [bytes]
const MAX_PRICES: u64 = 1 << 20;
/// Variable with the key for a server whose address was given.
const KEY_VARIABLE: &str = "RECRASH_API_KEY";
/// Largest exchange: its question holds the answers before it, each bounded. [bytes]
const MAX_EXCHANGE: u64 = 64 << 20;

/// Bytes of English that models count as a token, about.
const BYTES_PER_TOKEN: usize = 4;
/// Tokens of an answer, about: of an account; a review is shorter.
const TOKENS_PER_ANSWER: u64 = 700;

/// Where a model's answers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AnswerMode {
    /// From the model, over the network.
    #[default]
    Live,
    /// Questions are written to a batch file; the run stops, and goes on when the answers are there.
    Batch,
    /// From the ledger alone; a missing answer is an error.
    Replay,
}

/// How models are asked. No byte of a question depends on it.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelAccess {
    /// Where answers come from.
    pub mode: AnswerMode,
    /// Address of an OpenAI-compatible server; the models' own providers where not given.
    pub base_url: Option<String>,
    /// Longest time for one answer. [s]
    pub timeout_s: f64,
    /// How often a question is asked again after a passing fault.
    pub retries: u32,
    /// Questions under way at once.
    pub concurrency: usize,
    /// Caps on what the run spends.
    pub caps: Caps,
    /// File of prices that goes before the built-in table.
    pub prices: Option<PathBuf>,
}

impl Default for ModelAccess {
    fn default() -> Self {
        let live = LiveOptions::new(PriceTable::default());
        Self {
            mode: AnswerMode::default(),
            base_url: None,
            timeout_s: live.timeout_s,
            retries: live.retries,
            concurrency: 4,
            caps: live.caps,
            prices: None,
        }
    }
}

/// The models' side of a suite.
pub struct Models {
    store: Store,
    answers: Arc<dyn Answers>,
    batch: Option<Arc<Batch>>,
    spending: Arc<Spending>,
    prices: PriceTable,
}

impl Models {
    /// Sets up the ledger; takes in the answers of a batch, where there are any.
    ///
    /// # Errors
    /// The ledger cannot be read or written, or the models cannot be asked like this.
    ///
    /// Only the models of which `may_ask` is true are asked over the network. The others are named by a file alone, which may
    /// be anybody's: for them the ledger answers, or nobody.
    pub fn open(
        store: &Store,
        cast: &Cast,
        access: &ModelAccess,
        may_ask: impl Fn(&str) -> bool,
    ) -> Result<(Self, Vec<Diagnostic>), PipelineError> {
        let ledger: Arc<dyn Ledger> = Arc::new(FileLedger(store.clone()));
        let spending = Arc::new(Spending::default());
        let mut diagnostics = Vec::new();
        let (answers, batch): (Arc<dyn Answers>, _) = match access.mode {
            AnswerMode::Replay => (Arc::new(Replay { ledger }), None),
            AnswerMode::Live => {
                let all: Vec<String> = cast.models().into_iter().map(str::to_owned).collect();
                let named: Vec<String> = all.iter().filter(|model| may_ask(model)).cloned().collect();
                let asked = match named.is_empty() {
                    true => None,
                    false => Some(live(Arc::clone(&ledger), &named, access, &spending)?),
                };
                (Arc::new(NamedOnly { ledger, cast: all, named, asked }), None)
            }
            AnswerMode::Batch => {
                let taken_in = responses::take_in(store, &price_table(access)?, &secrets::scrubber())?;
                let TakenIn { tried, diagnostics: told } = taken_in;
                diagnostics = told;
                let batch = Arc::new(Batch::new(ledger, tried, cast.repairs + 1));
                (Arc::clone(&batch) as Arc<dyn Answers>, Some(batch))
            }
        };
        let prices = price_table(access)?;
        Ok((Self { store: store.clone(), answers, batch, spending, prices }, diagnostics))
    }

    /// A model in its roles. `repairs` counts the answers that went back.
    pub fn model<'a>(&'a self, name: &'a str, cast: &Cast, repairs: &'a Repairs) -> LanguageModel<'a> {
        LanguageModel { model: name, answers: &*self.answers, max_repairs: cast.repairs, repairs }
    }

    /// Whether the models can be asked, as far as that is seen without asking one. Where the ledger holds answers it may hold all that are
    /// wanted: then this is seen when one is wanted that it does not hold.
    ///
    /// # Errors
    /// The suite names a model that the caller does not, or a key is missing.
    pub fn ready(&self) -> Result<(), PipelineError> {
        let answered = std::fs::read_dir(self.store.path("ledger")).is_ok_and(|mut entries| entries.next().is_some());
        if answered {
            return Ok(());
        }
        self.answers.ready().map_err(|error| PipelineError::ModelRefused(error.to_string()))
    }

    /// About what so many questions of so many bytes together cost, in words.
    pub fn estimate(&self, name: &str, bytes: usize, questions: usize) -> String {
        let (read, written) = ((bytes / BYTES_PER_TOKEN) as u64, questions as u64 * TOKENS_PER_ANSWER);
        let tokens = format!("about {} thousand tokens", (read + written).div_ceil(1_000));
        match self.prices.price(name) {
            Some(price) => {
                let share = if self.batch.is_some() { price.batch_share } else { 1.0 };
                format!("{tokens}, about {:.2} USD", share * price.cost_usd(read, written))
            }
            None => format!("{tokens}, at a price that is not known"),
        }
    }

    /// What this run has spent.
    pub fn spent(&self) -> Spent {
        self.spending.spent()
    }

    /// Writes the questions that wait, as a batch file; gives its path and their number.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_requests(&self) -> Result<(PathBuf, usize), PipelineError> {
        let questions = self.batch.as_ref().map_or_else(Vec::new, |batch| batch.pending());
        let lines: String = questions.iter().map(|question| request_line(question) + "\n").collect();
        self.store.write_json(PENDING, &questions)?;
        self.store.write(REQUESTS, lines.as_bytes())?;
        Ok((self.store.path(REQUESTS), questions.len()))
    }

    /// Writes the questions that wait, where answers of a batch are still to come and nothing else went wrong.
    ///
    /// # Errors
    /// [`PipelineError::WaitingForBatch`]; or the file cannot be written.
    pub fn must_be_answered<T>(&self, answers: &[Result<T, PipelineError>]) -> Result<(), PipelineError> {
        let waits = |answer: &Result<T, PipelineError>| matches!(answer, Err(PipelineError::AnswerPending));
        if !answers.iter().any(waits) || !answers.iter().all(|answer| answer.is_ok() || waits(answer)) {
            return Ok(());
        }
        let (requests, count) = self.write_requests()?;
        Err(PipelineError::WaitingForBatch { requests, count })
    }
}

/// Asks the models that the caller allows; for others the ledger answers.
struct NamedOnly {
    ledger: Arc<dyn Ledger>,
    /// All models of the suite.
    cast: Vec<String>,
    /// Those that may be asked.
    named: Vec<String>,
    asked: Option<Arc<dyn Answers>>,
}

impl Answers for NamedOnly {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        if let Some(asked) = self.asked.as_ref().filter(|_| self.named.contains(&question.model)) {
            return asked.answer(question);
        }
        self.ledger.find(&question.hash()).map_err(AskError::Ledger)?.ok_or_else(|| unnamed(&question.model))
    }

    fn ready(&self) -> Result<(), AskError> {
        match self.cast.iter().find(|model| !self.named.contains(model)) {
            Some(model) => Err(unnamed(model)),
            None => self.asked.as_ref().map_or(Ok(()), |asked| asked.ready()),
        }
    }
}

/// Refuses to ask a model that a file alone names.
fn unnamed(model: &str) -> AskError {
    AskError::Refused(format!(
        "the suite wants to ask the language model {model}; a suite may be anybody's, so name the model in the command, or say that \
         the suite is trusted"
    ))
}

#[cfg(feature = "live")]
fn live(
    ledger: Arc<dyn Ledger>,
    named: &[String],
    access: &ModelAccess,
    spending: &Arc<Spending>,
) -> Result<Arc<dyn Answers>, PipelineError> {
    let options = live_options(access)?;
    let named: Vec<&str> = named.iter().map(String::as_str).collect();
    options.check(&named).map_err(PipelineError::Usage)?;
    Ok(Arc::new(Live::new(ledger, options, Arc::clone(spending), &named)))
}

#[cfg(not(feature = "live"))]
fn live(
    _ledger: Arc<dyn Ledger>,
    _named: &[String],
    _access: &ModelAccess,
    _spending: &Arc<Spending>,
) -> Result<Arc<dyn Answers>, PipelineError> {
    Ok(Arc::new(Absent))
}

/// Stands in for live models where they were left out of the build.
#[cfg(not(feature = "live"))]
struct Absent;

#[cfg(not(feature = "live"))]
impl Answers for Absent {
    fn answer(&self, _question: &Question) -> Result<Exchange, AskError> {
        let why = "this recrash was built without live models; build it with the feature `live`, or have the questions written for a batch";
        Err(AskError::Refused(why.into()))
    }
}

/// Reads what the environment says about keys. Nothing of it is kept.
#[cfg_attr(not(feature = "live"), expect(dead_code, reason = "for live models only"))]
fn live_options(access: &ModelAccess) -> Result<LiveOptions, PipelineError> {
    Ok(LiveOptions {
        base_url: access.base_url.clone(),
        key: secrets::key(KEY_VARIABLE),
        provider_key: secrets::key,
        scrubber: secrets::scrubber(),
        timeout_s: access.timeout_s,
        retries: access.retries,
        caps: access.caps,
        prices: price_table(access)?,
    })
}

/// The user's prices, then the built-in ones. What a server of the user's asks for is not in the built-in table, whatever
/// its models are called.
fn price_table(access: &ModelAccess) -> Result<PriceTable, PipelineError> {
    let base = if access.base_url.is_some() { PriceTable::default() } else { PriceTable::built_in() };
    Ok(match &access.prices {
        Some(path) => base.after(read_prices(path)?),
        None => base,
    })
}

/// Reads a file of prices.
///
/// # Errors
/// It cannot be read, or is no such file.
pub fn read_prices(path: &Path) -> Result<PriceTable, PipelineError> {
    let text = read_text(path, MAX_PRICES)?;
    PriceTable::parse(&text).map_err(|e| PipelineError::bad_input(format!("{}: {e}", path.display())))
}

/// Exchanges as files of a suite, named by hash.
struct FileLedger(Store);

impl Ledger for FileLedger {
    fn find(&self, hash: &str) -> Result<Option<Exchange>, String> {
        let name = exchange_file(hash);
        let path = self.0.path(&name);
        let spoilt = |why: &str| {
            Err(format!(
                "{}: {why}; put the file back as it was, or remove it to have its question asked again",
                path.display()
            ))
        };
        match std::fs::symlink_metadata(&path) {
            Err(_) => return Ok(None),
            Ok(metadata) if !metadata.is_file() => return spoilt("it is no regular file"),
            Ok(metadata) if metadata.len() > MAX_EXCHANGE => return spoilt("it is longer than any exchange"),
            Ok(_) => {}
        }
        match self.0.read_json::<Exchange>(&name) {
            Err(_) => spoilt("it is damaged"),
            Ok(exchange) => match exchange.check(hash) {
                Err(why) => spoilt(why),
                Ok(()) => Ok(Some(exchange)),
            },
        }
    }

    fn keep(&self, exchange: &Exchange) -> Result<(), String> {
        let kept = self.0.write_json(&exchange_file(&exchange.hash), exchange);
        kept.map(drop).map_err(|e| format!("the ledger cannot keep an answer: {e}"))
    }
}
