//! `recrash read`: each incident of crash files as an account.

use crate::options::SourceArgs;
use crate::output::{self, Output, title};
use crate::screen::{bold, dim, one_line, println};
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_model::account::{Account, CrashType, Source, told};
use recrash_model::incident::Incident;
use recrash_pipeline::{
    Accounts, Options, Output as File, PipelineError, TableFormat, read_accounts, record_outputs, reported_columns,
    told_facts, write_accounts,
};
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash read                                           the built-in sample
  recrash read archive.csv current.csv                   how many incidents of which type, and how they came about
  recrash read archive.csv --report 30270-7733           one account, with the words each fact stands in
  recrash read archive.csv --where 'road = intersection' --csv accounts.csv
  recrash read archive.csv --json > accounts.json        whole accounts, with sources

Nothing is written but what --csv and --parquet name. docs/models/crash-types.md defines the types.";

/// Options of `read`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ReadArgs {
    /// SGO crash files (CSV), as with --records. [default: the built-in sample]
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where crash records come from.
    #[command(flatten)]
    pub source: SourceArgs,
    /// Show the account of the incident that this report is of, with its words.
    #[arg(long, value_name = "ID")]
    pub report: Option<String>,
    /// Write the main facts of all accounts as a CSV table.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the main facts of all accounts as a Parquet table.
    #[cfg(feature = "parquet")]
    #[arg(long, value_name = "FILE")]
    pub parquet: Option<PathBuf>,
}

impl ReadArgs {
    fn options(&self) -> Options {
        let mut source = self.source.clone();
        source.records.extend(self.files.iter().cloned());
        source.over(crate::options::defaults())
    }

    fn tables(&self, options: &Options) -> Result<Vec<(TableFormat, File)>, PipelineError> {
        let mut wanted = Vec::new();
        wanted.extend(self.csv.iter().map(|path| (TableFormat::Csv, path)));
        #[cfg(feature = "parquet")]
        wanted.extend(self.parquet.iter().map(|path| (TableFormat::Parquet, path)));
        let mut outputs = record_outputs(options, None);
        wanted.into_iter().map(|(format, path)| Ok((format, outputs.claim(path)?))).collect()
    }
}

/// Reads crash files into accounts and shows them.
///
/// # Errors
/// A file cannot be read or written, or the report is in none of them.
pub fn run(args: &ReadArgs, output: Output) -> Result<(), PipelineError> {
    let options = args.options();
    let tables = args.tables(&options)?;
    let read = read_accounts(&options)?;
    if let Some(id) = &args.report {
        return one(&read, id, output);
    }
    let columns = reported_columns(&read.incidents);
    let write = |(format, file): &(TableFormat, File)| write_accounts(&read.accounts, &columns, *format, file);
    let written = tables.iter().map(write).collect::<Result<Vec<usize>, _>>()?;
    if output.json {
        output::json(&serde_json::json!({
            "files": read.files, "reports": read.reports, "incidents": read.incidents.len(),
            "accounts": read.accounts, "diagnostics": read.diagnostics,
        }));
    } else if !output.quiet {
        output::remark_list(&read.diagnostics, "told by --json");
        types(&read);
        facts(&read.accounts);
        println!(
            "{} reports = {} incidents; {} of them have a narrative that can be read",
            read.reports,
            read.incidents.len(),
            read.accounts.len()
        );
        for (rows, (_, table)) in written.iter().zip(&tables) {
            println!("{rows} accounts in {}", table.name().display());
        }
    }
    Ok(())
}

/// Prints the crash types, and who stood, struck and drove in each.
fn types(read: &Accounts) {
    title("Crash types");
    let mut table = table(&["type", "incidents", "share", "responder", "SV stood", "human drove"]);
    let all = read.accounts.len();
    let types = CrashType::ALL.into_iter().map(Some).chain([None]);
    for kind in types {
        let of_kind: Vec<&Account> = read.accounts.iter().filter(|account| told(&account.crash_type) == kind).collect();
        if of_kind.is_empty() && kind.is_none() {
            continue;
        }
        let count = |wanted: &dyn Fn(&Account) -> bool| of_kind.iter().filter(|account| wanted(account)).count();
        use recrash_model::account::{Driver, Role};
        table.add_row(vec![
            Cell::new(kind.map_or("not told", CrashType::label)),
            number(of_kind.len()),
            number(format!("{:.1} %", 100.0 * of_kind.len() as f64 / all.max(1) as f64)),
            number(count(&|account| told(&account.role) == Some(Role::Responder))),
            number(count(&|account| told(&account.sv.state).is_some_and(|state| state.stands()))),
            number(count(&|account| matches!(told(&account.driver), Some(Driver::Human | Driver::HumanTookOver)))),
        ]);
    }
    println!("{table}");
}

/// Prints how often each fact is told, so that silence cannot pass for truth.
fn facts(accounts: &[Account]) {
    title("Facts");
    let mut table = table(&["fact", "in words", "by column", "by rule", "not told"]);
    let mut row = |name: &str, of: &dyn Fn(&Account) -> Option<Source>| {
        let mut counts = [0_usize; 4];
        for account in accounts {
            let place = match of(account) {
                Some(Source::Words { .. }) => 0,
                Some(Source::Column { .. }) => 1,
                Some(Source::Rule { .. }) => 2,
                None => 3,
            };
            counts[place] += 1;
        }
        table.add_row([Cell::new(name)].into_iter().chain(counts.map(number)));
    };
    row("partner", &|account| account.partner.as_ref()?.kind.as_ref().map(|fact| fact.source.clone()));
    row("where it came from", &|account| account.came_from.as_ref().map(|fact| fact.source.clone()));
    row("SV state", &|account| account.sv.state.as_ref().map(|fact| fact.source.clone()));
    row("SV movement", &|account| account.sv.movement.as_ref().map(|fact| fact.source.clone()));
    row("partner movement", &|account| account.partner.as_ref()?.movement.as_ref().map(|fact| fact.source.clone()));
    row("SV zones", &|account| account.sv.zones.first().map(|fact| fact.source.clone()));
    row("partner zones", &|account| account.partner.as_ref()?.zones.first().map(|fact| fact.source.clone()));
    row("striker", &|account| account.striker.as_ref().map(|fact| fact.source.clone()));
    row("who drove", &|account| account.driver.as_ref().map(|fact| fact.source.clone()));
    println!("{table}");
    let words: u64 = accounts.iter().map(|account| u64::from(account.words)).sum();
    let told: usize = accounts.iter().map(|account| told_facts(account).len()).sum();
    println!("{:.1} facts in words for 100 words of narrative", 100.0 * told as f64 / words.max(1) as f64);
}

/// Shows one account.
fn one(read: &Accounts, id: &str, output: Output) -> Result<(), PipelineError> {
    let of = |incident: &&Incident| incident.reports.iter().any(|report| report.record.id.is_called(id));
    let Some(incident) = read.incidents.iter().find(of) else {
        let message =
            format!("there is no report {id} among {} reports; recrash records --csv lists their ids", read.reports);
        return Err(PipelineError::bad_input(message));
    };
    let Some(account) = read.accounts.iter().find(|account| account.incident == incident.id) else {
        let message = format!(
            "no narrative of incident {} can be read: it is withheld, empty or refers to another report",
            incident.id
        );
        return Err(PipelineError::bad_input(message));
    };
    if output.json {
        output::json(&serde_json::json!({ "account": account, "told": told_facts(account) }));
        return Ok(());
    }
    if output.quiet {
        return Ok(());
    }
    let narrative = incident.spoken().map_or("", |report| report.record.narrative.as_str());
    let told = told_facts(account);
    title(&format!("Report {}, incident {}", account.report, one_line(&account.incident)));
    println!("{}", highlighted(narrative, &told.iter().map(|fact| (fact.start, fact.end)).collect::<Vec<_>>()));
    title("Account");
    let mut table = table(&["fact", "value", "words, or where it stands"]);
    for (path, value, source) in listed(account) {
        let source = match source {
            Source::Words { text, .. } => format!("\"{}\"", one_line(&text)),
            Source::Column { name } => format!("column {name}"),
            Source::Rule { name } => format!("rule: {name}"),
        };
        table.add_row(vec![Cell::new(path), Cell::new(value), Cell::new(source)]);
    }
    println!("{table}");
    for contradiction in &account.contradictions {
        println!("{}: {} against {}", contradiction.about, contradiction.kept, contradiction.against);
    }
    for report in &incident.reports {
        let changed =
            if report.changed.is_empty() { String::new() } else { format!("; changed: {}", report.changed.join(", ")) };
        println!("{}", dim(format!("report {} of {}{changed}", report.record.id, one_line(&report.record.entity))));
    }
    Ok(())
}

/// The narrative with its facts' words in bold.
fn highlighted(narrative: &str, spans: &[(usize, usize)]) -> String {
    let mut marks = vec![false; narrative.len()];
    for &(start, end) in spans {
        if let Some(marked) = marks.get_mut(start..end) {
            marked.fill(true);
        }
    }
    let mut shown = String::new();
    let mut at = 0;
    while at < narrative.len() {
        let end = (at + 1..narrative.len()).find(|&next| marks[next] != marks[at]).unwrap_or(narrative.len());
        let piece = one_line(narrative.get(at..end).unwrap_or_default());
        if marks[at] {
            shown.push_str(&bold(piece).to_string());
        } else {
            shown.push_str(&piece);
        }
        at = end;
    }
    shown
}

/// A value for a cell, in words: `10.3 m/s (approach)`, `stall side right`.
fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => "not told".to_owned(),
        Value::Array(values) => values.iter().map(text).collect::<Vec<_>>().join(", "),
        Value::Object(fields) => match (fields.get("mps").and_then(Value::as_f64), fields.get("meaning")) {
            (Some(mps), Some(meaning)) => format!("{mps:.1} m/s ({})", text(meaning)),
            _ => fields.iter().map(|(name, inner)| format!("{name} {}", text(inner))).collect::<Vec<_>>().join(", "),
        },
        Value::Bool(_) | Value::Number(_) => value.to_string(),
    }
}

/// Facts of an account in the order of the type: path, value, source.
fn listed(account: &Account) -> Vec<(String, String, Source)> {
    fn walk(path: &str, value: &Value, all: &mut Vec<(String, String, Source)>) {
        match value {
            Value::Object(fields) => {
                let source =
                    fields.get("source").and_then(|source| serde_json::from_value::<Source>(source.clone()).ok());
                if let Some(source) = source {
                    let value = match (fields.get("value"), fields.get("act"), fields.get("side")) {
                        (Some(value), ..) => text(value),
                        (None, Some(act), Some(side)) if side.is_string() => format!("{} {}", text(act), text(side)),
                        (None, Some(act), _) => text(act),
                        _ => String::new(),
                    };
                    all.push((path.to_owned(), value, source));
                    return;
                }
                for (name, inner) in fields {
                    let inner_path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                    walk(&inner_path, inner, all);
                }
            }
            Value::Array(values) => values.iter().for_each(|inner| walk(path, inner, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    walk("", &serde_json::to_value(account).unwrap_or_default(), &mut all);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_told_in_words() {
        for (value, says) in [
            (serde_json::json!({ "mps": 0.89408, "meaning": "approach" }), "0.9 m/s (approach)"),
            (serde_json::json!({ "stall": { "side": "right" } }), "stall side right"),
            (serde_json::json!({ "driveway": { "side": null } }), "driveway side not told"),
            (serde_json::json!({ "device": "signal", "state": "red" }), "device signal, state red"),
            (serde_json::json!("front"), "front"),
            (serde_json::json!(true), "true"),
        ] {
            assert_eq!(text(&value), says);
        }
    }
}
