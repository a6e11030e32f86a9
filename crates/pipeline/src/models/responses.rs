//! Takes in what a provider's batch service answered: `responses.jsonl` beside the `requests.jsonl` of a suite.

use crate::error::PipelineError;
use crate::files::store::{Store, io};
use recrash_agents::llm::{Exchange, LONGEST_RESPONSE, PriceTable, Question, Responses, Scrubber, Tried};
use recrash_model::Diagnostic;
use recrash_model::diagnostic::{Location, Severity};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// Requests for a provider's batch service.
pub(crate) const REQUESTS: &str = "requests.jsonl";
/// Its answers.
const RESPONSES: &str = "responses.jsonl";
/// The questions behind the requests.
pub(crate) const PENDING: &str = "ledger/pending.json";
/// Questions that batches did not answer usably, by hash.
const TRIED: &str = "ledger/tried.json";

/// What came of a batch.
pub(crate) struct TakenIn {
    /// Questions that batches did not answer usably, by hash.
    pub tried: BTreeMap<String, Tried>,
    /// What is told of it.
    pub diagnostics: Vec<Diagnostic>,
}

/// Takes the answers of a batch into the ledger, where there are any. A question that the file does not answer counts as
/// tried. The file itself moves into the ledger, beside what is told of it.
///
/// # Errors
/// A file of the suite cannot be read or written.
pub(crate) fn take_in(store: &Store, prices: &PriceTable, scrubber: &Scrubber) -> Result<TakenIn, PipelineError> {
    let mut tried: BTreeMap<String, Tried> = match store.path(TRIED).exists() {
        true => store.read_json(TRIED)?,
        false => BTreeMap::new(),
    };
    let path = store.path(RESPONSES);
    let Ok(metadata) = std::fs::symlink_metadata(&path) else {
        return Ok(TakenIn { tried, diagnostics: Vec::new() });
    };
    if !metadata.is_file() {
        let what = format!("{} is no regular file; put the answers of the batch there as one", path.display());
        return Err(PipelineError::bad_input(what));
    }
    let questions: Vec<Question> = match store.read_json(PENDING) {
        Ok(questions) => questions,
        Err(error) => {
            // The questions are made again from the suite, under the same ids.
            let message = format!(
                "{error}. Without it nobody knows which questions the answers belong to: it is written again now, \
                 {RESPONSES} stays, and the next run takes it in"
            );
            let location = Location { file: Some(PENDING.to_owned()), ..Location::default() };
            let diagnostics = vec![Diagnostic::new(Severity::Warning, "batch.pending", location, message)];
            return Ok(TakenIn { tried, diagnostics });
        }
    };
    let mut responses = Responses::new(RESPONSES, &questions, scrubber);
    for_each_line(&path, |number, line| {
        let Some(mut exchange) = responses.line(number, line) else { return Ok(()) };
        let price = prices.price(&exchange.question.model);
        let (input, output) = (exchange.input_tokens, exchange.output_tokens);
        exchange.cost_usd = price.map(|price| price.batch_share * price.cost_usd(input, output));
        tried.remove(&exchange.hash);
        keep(store, &exchange)
    })?;
    let (unanswered, diagnostics) = responses.finish();
    for (hash, why) in unanswered {
        let times = tried.get(&hash).map_or(0, |tried| tried.times) + 1;
        tried.insert(hash, Tried { times, why });
    }
    store.write_json(TRIED, &tried)?;
    let name = store.hash(RESPONSES).unwrap_or_default();
    let name = name.get(..12).unwrap_or("unread");
    store.write_json(&format!("ledger/responses-{name}.diagnostics.json"), &diagnostics)?;
    let moved = store.path(&format!("ledger/responses-{name}.jsonl"));
    std::fs::rename(&path, &moved).map_err(|source| io("write", &moved, source))?;
    for done in [REQUESTS, PENDING] {
        store.remove(done)?;
    }
    Ok(TakenIn { tried, diagnostics })
}

/// Name of an exchange's file.
pub(crate) fn exchange_file(hash: &str) -> String {
    format!("ledger/{hash}.json")
}

fn keep(store: &Store, exchange: &Exchange) -> Result<(), PipelineError> {
    store.write_json(&exchange_file(&exchange.hash), exchange).map(drop)
}

/// Every line with its number from 1; of one that is too long, so much that it can be seen.
fn for_each_line(
    path: &Path,
    mut line_is: impl FnMut(u64, &[u8]) -> Result<(), PipelineError>,
) -> Result<(), PipelineError> {
    let failed = |source| io("read", path, source);
    let mut reader = BufReader::new(File::open(path).map_err(failed)?);
    for number in 1.. {
        let mut line = Vec::new();
        reader.by_ref().take(LONGEST_RESPONSE as u64 + 1).read_until(b'\n', &mut line).map_err(failed)?;
        if line.is_empty() {
            break;
        }
        line_is(number, &line)?;
        if line.len() > LONGEST_RESPONSE && line.last() != Some(&b'\n') {
            reader.skip_until(b'\n').map_err(failed)?;
        }
    }
    Ok(())
}
