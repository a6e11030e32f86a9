//! Crash files into accounts, one an incident.

use crate::error::PipelineError;
use crate::options::Options;
use crate::reading::records::{RecordInput, incidents};
use recrash_model::Diagnostic;
use recrash_model::account::Account;
use recrash_model::incident::Incident;
use recrash_model::record::SourceFile;
use serde::Serialize;
use serde_json::Value;

/// Everything that crash files tell.
#[derive(Debug, Clone)]
pub struct Accounts {
    /// Files read.
    pub files: Vec<SourceFile>,
    /// Rows that are crash reports.
    pub reports: usize,
    /// Incidents, by id.
    pub incidents: Vec<Incident>,
    /// Accounts of those incidents with a narrative that can be read, by id.
    pub accounts: Vec<Account>,
    /// Remarks on the files.
    pub diagnostics: Vec<Diagnostic>,
}

/// One fact of an account that stands in the narrative.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ToldFact {
    /// Path of the fact in the account: `sv.state`.
    pub path: String,
    /// Its value, in JSON.
    pub value: String,
    /// First byte in the narrative. [byte]
    pub start: usize,
    /// Byte behind. [byte]
    pub end: usize,
}

/// Reads crash files, groups their rows into incidents, and reads each.
///
/// # Errors
/// A file cannot be read or is no crash file, or the filter or the mapping cannot be used.
pub fn read_accounts(options: &Options) -> Result<Accounts, PipelineError> {
    let (read, filter) = RecordInput::read(options)?.ingest_all(&options.system_profile()?)?;
    let mut incidents = incidents(&read.value);
    if let Some(filter) = filter {
        incidents.retain(|incident| incident.leading().is_some_and(|report| filter.keeps(&report.record)));
    }
    let accounts = incidents.iter().filter_map(recrash_reader::account).collect();
    Ok(Accounts {
        files: read.value.files,
        reports: read.value.usable.len(),
        incidents,
        accounts,
        diagnostics: read.diagnostics,
    })
}

/// Every fact of an account that stands in the narrative, in the order of the words.
pub fn told_facts(account: &Account) -> Vec<ToldFact> {
    let mut all = Vec::new();
    if let Ok(value) = serde_json::to_value(account) {
        collect("", &value, &mut all);
    }
    all.sort_by(|one, other| (one.start, one.end, &one.path).cmp(&(other.start, other.end, &other.path)));
    all
}

fn collect(path: &str, value: &Value, all: &mut Vec<ToldFact>) {
    match value {
        Value::Object(fields) => {
            let words = fields.get("source").and_then(|source| source.get("words"));
            let place = words.and_then(|words| Some((words.get("start")?.as_u64()?, words.get("end")?.as_u64()?)));
            if let Some((start, end)) = place {
                let said = ["value", "act"].iter().find_map(|name| fields.get(*name)).map_or_else(String::new, coded);
                let (start, end) = (usize::try_from(start).unwrap_or(0), usize::try_from(end).unwrap_or(0));
                all.push(ToldFact { path: path.to_owned(), value: said, start, end });
            }
            for (name, inner) in fields {
                let inner_path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                collect(&inner_path, inner, all);
            }
        }
        Value::Array(values) => values.iter().for_each(|inner| collect(path, inner, all)),
        _ => {}
    }
}

/// A coded value as its format writes it.
pub(crate) fn coded<T: Serialize>(value: &T) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(text)) => text,
        Ok(other) => other.to_string(),
        Err(_) => String::new(),
    }
}
