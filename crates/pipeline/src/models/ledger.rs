//! What models were asked for a suite, what they answered, and what it cost.

use crate::error::PipelineError;
use crate::files::store::Store;
use crate::models::read_prices;
use recrash_agents::llm::{Asked, Exchange, PriceTable, Role};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The ledger of a suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LedgerReport {
    /// Always `recrash.ledger/1`.
    pub format: String,
    /// All exchanges together.
    pub total: Sum,
    /// Sums by role and model, in their order.
    pub by_model: Vec<ModelSum>,
    /// Models without a known price: their exchanges are in no sum of money.
    pub without_price: Vec<String>,
    /// Every exchange, by role, scenario and attempt.
    pub exchanges: Vec<Entry>,
}

/// Sums over exchanges.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Sum {
    /// Answers.
    pub answers: usize,
    /// Those to questions that were repairs or later rounds.
    pub later: usize,
    /// Tokens read by the model.
    pub input_tokens: u64,
    /// Tokens written by the model.
    pub output_tokens: u64,
    /// Time from question to answer, one after the other. [s]
    pub latency_s: f64,
    /// Price, of those with a known one. [USD]
    pub cost_usd: f64,
}

/// Sums over the exchanges of one role with one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelSum {
    /// Role.
    pub role: Role,
    /// Model.
    pub model: String,
    /// Sums.
    pub sum: Sum,
}

/// One exchange.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// Hash of the question: the file is `ledger/HASH.json`.
    pub hash: String,
    /// Role.
    pub role: Role,
    /// Scenario.
    pub scenario_id: String,
    /// 0 for the first question of its role, then one more for each repair or round.
    pub attempt: usize,
    /// Model.
    pub model: String,
    /// How it was asked.
    pub asked: Asked,
    /// Tokens read by the model.
    pub input_tokens: u64,
    /// Tokens written by the model.
    pub output_tokens: u64,
    /// Time from question to answer; absent for a batch. [s]
    pub latency_s: Option<f64>,
    /// How often it was asked again after a passing fault.
    pub retries: u32,
    /// Price; absent where none is known. [USD]
    pub cost_usd: Option<f64>,
}

impl Sum {
    fn add(&mut self, entry: &Entry) {
        self.answers += 1;
        self.later += usize::from(entry.attempt > 0);
        self.input_tokens = self.input_tokens.saturating_add(entry.input_tokens);
        self.output_tokens = self.output_tokens.saturating_add(entry.output_tokens);
        self.latency_s += entry.latency_s.unwrap_or(0.0);
        self.cost_usd += entry.cost_usd.unwrap_or(0.0);
    }
}

/// Lists, sums and prices the ledger of the suite in `dir`. What was paid when it was asked counts as it was; what has no
/// price from then gets one from the file `prices`, and else from the built-in table.
///
/// # Errors
/// There is no suite or no ledger, or a file of it cannot be read.
pub fn ledger(dir: &Path, prices: Option<&Path>) -> Result<LedgerReport, PipelineError> {
    let own = prices.map(read_prices).transpose()?.unwrap_or_default();
    let mut entries = Vec::new();
    for file in exchange_files(dir)? {
        let exchange: Exchange = Store::create(dir, crate::files::store::write_file_whole)?.read_json(&file)?;
        entries.push(entry(exchange, &own));
    }
    entries.sort_by(|a, b| {
        (a.role, &a.scenario_id, &a.model, a.attempt, &a.hash).cmp(&(
            b.role,
            &b.scenario_id,
            &b.model,
            b.attempt,
            &b.hash,
        ))
    });
    let mut total = Sum::default();
    let mut by_model: Vec<ModelSum> = Vec::new();
    for entry in &entries {
        total.add(entry);
        match by_model.iter_mut().find(|sum| sum.role == entry.role && sum.model == entry.model) {
            Some(known) => known.sum.add(entry),
            None => {
                let mut sum = Sum::default();
                sum.add(entry);
                by_model.push(ModelSum { role: entry.role, model: entry.model.clone(), sum });
            }
        }
    }
    let mut without_price: Vec<String> =
        entries.iter().filter(|e| e.cost_usd.is_none()).map(|e| e.model.clone()).collect();
    without_price.sort();
    without_price.dedup();
    Ok(LedgerReport { format: "recrash.ledger/1".into(), total, by_model, without_price, exchanges: entries })
}

fn entry(exchange: Exchange, own: &PriceTable) -> Entry {
    let Exchange { hash, question, asked, input_tokens, output_tokens, latency_s, retries, cost_usd, .. } = exchange;
    let table = if asked == Asked::Server { PriceTable::default() } else { PriceTable::built_in() };
    let table = table.after(own.clone());
    let price = || {
        let price = table.price(&question.model)?;
        let share = if asked == Asked::Batch { price.batch_share } else { 1.0 };
        Some(share * price.cost_usd(input_tokens, output_tokens))
    };
    Entry {
        cost_usd: cost_usd.or_else(price),
        hash,
        role: question.purpose.role,
        scenario_id: question.purpose.scenario_id,
        attempt: question.purpose.attempt,
        model: question.model,
        asked,
        input_tokens,
        output_tokens,
        latency_s,
        retries,
    }
}

/// Names of the exchanges' files, sorted.
fn exchange_files(dir: &Path) -> Result<Vec<String>, PipelineError> {
    let folder: PathBuf = dir.join("ledger");
    let entries = match std::fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            return Err(PipelineError::bad_input(format!(
                "{} holds no ledger: no language model was asked for it",
                dir.display()
            )));
        }
        Err(source) => return Err(PipelineError::Io { action: "read", path: folder, source }),
    };
    let is_exchange = |name: &str| {
        name.strip_suffix(".json").is_some_and(|hash| hash.len() == 64 && hash.bytes().all(|b| b.is_ascii_hexdigit()))
    };
    let regular = entries.filter_map(Result::ok).filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file()));
    let names = regular.filter_map(|entry| entry.file_name().into_string().ok());
    let mut files: Vec<String> = names.filter(|name| is_exchange(name)).map(|name| format!("ledger/{name}")).collect();
    files.sort();
    Ok(files)
}
