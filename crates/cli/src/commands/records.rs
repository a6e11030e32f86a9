//! `recrash records`: what is in crash files, and what of it can be used.

use crate::options::SuiteArgs;
use crate::output::{self, Output, number, table, title};
use anstream::println;
use clap::Args;
use comfy_table::Cell;
use recrash_model::record::{FunnelStep, RecordSet};
use recrash_pipeline::{
    Distribution, PipelineError, Stage, Suite, TableFormat, TableRows, distributions, write_records,
};
use std::path::{Path, PathBuf};

/// Values of a distribution that are shown.
const VALUES_SHOWN: usize = 8;

/// Options of `records`.
#[derive(Debug, Clone, Args)]
pub struct RecordsArgs {
    /// SGO crash files (CSV), as with --records. [default: the built-in sample]
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write the usable records as a CSV table.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the usable records as a Parquet table.
    #[cfg(feature = "parquet")]
    #[arg(long, value_name = "FILE")]
    pub parquet: Option<PathBuf>,
    /// Write every record that could be read into the tables, with why it was lost.
    #[arg(long)]
    pub all: bool,
    /// Options of the suite.
    #[command(flatten)]
    pub suite: SuiteArgs,
}

/// Reads crash files and shows what is in them.
///
/// # Errors
/// A file cannot be read or written.
pub fn run(args: &RecordsArgs, output: Output) -> Result<(), PipelineError> {
    let mut suite_args = args.suite.clone();
    suite_args.records.extend(args.files.iter().cloned());
    let suite = suite_args.open_saved()?;
    let report = suite.run_stage(Stage::Records, &*output.progress())?;
    let records: RecordSet = suite.store().read_json("1-records.json")?;
    let written = write_tables(args, &suite)?;
    let shown = distributions(&records);
    if output.json {
        output::json(&serde_json::json!({
            "distributions": shown,
            "files": records.files, "funnel": records.funnel, "usable": records.usable.len(),
            "diagnostics": report.diagnostics,
        }));
    } else if !output.quiet {
        output::remarks(&report);
        files(&records);
        funnel(&records.funnel);
        show_distributions(&shown);
        written.iter().for_each(|(path, rows)| show_written(path, *rows));
    }
    Ok(())
}

/// Writes the tables that were asked for; gives each file with its rows.
fn write_tables(args: &RecordsArgs, suite: &Suite) -> Result<Vec<(PathBuf, usize)>, PipelineError> {
    let rows = if args.all { TableRows::All } else { TableRows::Usable };
    let mut wanted = Vec::new();
    wanted.extend(args.csv.iter().map(|path| (TableFormat::Csv, path)));
    #[cfg(feature = "parquet")]
    wanted.extend(args.parquet.iter().map(|path| (TableFormat::Parquet, path)));
    wanted.into_iter().map(|(format, path)| Ok((path.clone(), write_records(suite, rows, format, path)?))).collect()
}

/// Prints the files read.
fn files(records: &RecordSet) {
    title("Files");
    let mut table = table(&["file", "edition", "rows", "SHA-256"]);
    for file in &records.files {
        let edition = format!("{:?}", file.edition).to_lowercase();
        table.add_row(vec![
            Cell::new(&file.name),
            Cell::new(edition),
            number(file.rows),
            Cell::new(&file.sha256[..12.min(file.sha256.len())]),
        ]);
    }
    println!("{table}");
}

/// Prints the way from rows to usable records.
pub fn funnel(steps: &[FunnelStep]) {
    title("From rows to usable records");
    let mut table = table(&["step", "remaining", "lost"]);
    for step in steps {
        let lost: Vec<String> = step.lost.iter().map(|(reason, n)| format!("{n} {}", reason.label())).collect();
        table.add_row(vec![Cell::new(&step.name), number(step.remaining), Cell::new(lost.join(", "))]);
    }
    println!("{table}");
}

/// Prints how the records are spread: of all that could be read, and of the usable ones.
fn show_distributions(all: &[Distribution]) {
    title("Distributions (records, usable ones behind the stroke)");
    for distribution in all {
        let shown: Vec<String> = distribution
            .values
            .iter()
            .take(VALUES_SHOWN)
            .map(|count| format!("{} {}/{}", count.value, count.records, count.usable))
            .collect();
        let more = distribution.values.len().saturating_sub(VALUES_SHOWN);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        println!("  {:<12} {}{more}", distribution.field, shown.join(", "));
    }
}

/// Prints that a table was written.
fn show_written(path: &Path, rows: usize) {
    println!("{rows} records in {}", path.display());
}
