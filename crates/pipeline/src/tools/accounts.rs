//! Crash files into accounts: one an incident, and as a table.

use crate::error::PipelineError;
use crate::files::output::Output;
use crate::files::store::io;
use crate::options::Options;
use crate::reading::records::{RecordInput, TableFormat, read_filter};
use recrash_model::Diagnostic;
use recrash_model::account::{Account, Fact, LeftRight, Origin, Party};
use recrash_model::incident::Incident;
use recrash_model::profile::Dedupe;
use recrash_model::record::SourceFile;
use recrash_records::{Column, RecordTable};
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
    let mut profile = options.system_profile()?;
    // Incidents are made of every row.
    profile.records.dedupe = Dedupe::None;
    let filter = read_filter(options)?;
    let read = RecordInput::read(options)?.ingest(&profile)?;
    let mut incidents = recrash_reader::incidents(&read.value.records);
    if let Some(filter) = filter {
        incidents.retain(|incident| incident.leading().is_some_and(|report| filter.keeps(&report.record)));
    }
    let accounts = incidents.iter().filter_map(recrash_reader::account).collect();
    Ok(Accounts {
        files: read.value.files,
        reports: read.value.records.len(),
        incidents,
        accounts,
        diagnostics: read.diagnostics,
    })
}

/// Writes accounts as a table of their main facts, a row an incident. Gives the number of rows.
///
/// # Errors
/// The file cannot be written.
pub fn write_accounts(accounts: &[Account], format: TableFormat, output: &Output) -> Result<usize, PipelineError> {
    let table = account_table(accounts);
    match format {
        TableFormat::Csv => {
            let failed = |source| io("write", output.name(), source);
            let mut begun = output.begin()?;
            table.write_csv(&mut begun).map_err(failed)?;
            begun.finish().map_err(failed)?;
        }
        #[cfg(feature = "parquet")]
        TableFormat::Parquet => output.write(&table.to_parquet())?,
    }
    Ok(table.rows)
}

/// Accounts as a table of their main facts, a row an incident.
pub fn account_table(accounts: &[Account]) -> RecordTable {
    let text = |of: &dyn Fn(&Account) -> Option<String>| Column::Text(accounts.iter().map(of).collect());
    let partner = |of: &dyn Fn(&Party) -> Option<String>| -> Column {
        Column::Text(accounts.iter().map(|account| account.partner.as_ref().and_then(of)).collect())
    };
    let whole = |of: &dyn Fn(&Account) -> usize| {
        Column::Whole(accounts.iter().map(|account| i64::try_from(of(account)).ok()).collect())
    };
    let columns = vec![
        ("incident", text(&|account| Some(account.incident.clone()))),
        ("report", text(&|account| Some(account.report.report_id.clone()))),
        ("version", whole(&|account| account.report.version as usize)),
        ("reports", whole(&|account| account.reports.len())),
        ("crash_type", text(&|account| name(&account.crash_type))),
        ("role", text(&|account| name(&account.role))),
        ("striker", text(&|account| name(&account.striker))),
        ("driver", text(&|account| name(&account.driver))),
        ("scenario", text(&|account| name(&account.scenario))),
        ("place", text(&|account| name(&account.place.kind))),
        ("sv_state", text(&|account| name(&account.sv.state))),
        ("sv_reasons", text(&|account| list(&account.sv.reasons))),
        ("sv_movement", text(&|account| name(&account.sv.movement))),
        ("sv_acts", text(&|account| acts(&account.sv))),
        ("sv_zones", text(&|account| list(&account.sv.zones))),
        ("cp_kind", partner(&|party| name(&party.kind))),
        ("cp_state", partner(&|party| name(&party.state))),
        ("cp_movement", partner(&|party| name(&party.movement))),
        ("cp_acts", partner(&acts)),
        ("cp_zones", partner(&|party| list(&party.zones))),
        ("cp_from", text(&|account| account.came_from.as_ref().map(|from| origin(from.value)))),
        ("order", text(&|account| name(&account.order))),
        ("others", whole(&|account| account.others.len())),
        ("contradictions", whole(&|account| account.contradictions.len())),
        ("words", whole(&|account| account.words as usize)),
    ];
    RecordTable { columns, rows: accounts.len() }
}

/// A coded value as its format writes it.
fn coded<T: Serialize>(value: &T) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(text)) => text,
        Ok(other) => other.to_string(),
        Err(_) => String::new(),
    }
}

fn name<T: Serialize>(fact: &Option<Fact<T>>) -> Option<String> {
    fact.as_ref().map(|fact| coded(&fact.value))
}

fn list<T: Serialize>(facts: &[Fact<T>]) -> Option<String> {
    let all: Vec<String> = facts.iter().map(|fact| coded(&fact.value)).collect();
    (!all.is_empty()).then(|| all.join(";"))
}

fn acts(party: &Party) -> Option<String> {
    let all: Vec<String> = party
        .acts
        .iter()
        .filter(|fact| !fact.after_contact)
        .map(|fact| match fact.side {
            Some(side) => format!("{}_{}", coded(&fact.act), coded(&side)),
            None => coded(&fact.act),
        })
        .collect();
    (!all.is_empty()).then(|| all.join(";"))
}

/// An origin in one word or two.
fn origin(origin: Origin) -> String {
    let sided = |name: &str, side: Option<LeftRight>| match side {
        Some(side) => format!("{name}_{}", coded(&side)),
        None => name.to_owned(),
    };
    match origin {
        Origin::Beside { side } => sided("beside", Some(side)),
        Origin::Cross { side } => sided("cross", Some(side)),
        Origin::Stall { side } => sided("stall", side),
        Origin::Driveway { side } => sided("driveway", side),
        Origin::Parked { side } => sided("parked", side),
        Origin::Sidewalk { side } => sided("sidewalk", side),
        plain => coded(&plain),
    }
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
