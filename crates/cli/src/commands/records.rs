//! `recrash records`: what is in crash files, and what of it can be used.

use crate::options::SourceArgs;
use crate::output::{self, Output, title};
use crate::screen::{one_line, println};
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_model::Outcome;
use recrash_model::record::{FunnelStep, RecordSet, RejectReason};
use recrash_pipeline::{
    Distribution, Options, Output as File, PipelineError, Resources, Stage, Suite, TableFormat, TableRows,
    distributions, read_records, record_outputs, run_stage, write_records,
};
use std::path::PathBuf;

/// Values of a distribution that are shown.
const VALUES_SHOWN: usize = 8;

const EXAMPLES: &str = "\
Examples:
  recrash records                                    the built-in sample
  recrash records archive.csv current.csv --dedupe incident
  recrash records archive.csv --where 'road = intersection and severity >= minor' --csv out.csv
  recrash records archive.csv --all --parquet all.parquet
  recrash records archive.csv --out suite            a suite's first stage; recrash select goes on

Nothing is written but what --csv, --parquet and --out name.";

/// Options of `records`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct RecordsArgs {
    /// SGO crash files (CSV), as with --records. [default: the built-in sample]
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where crash records come from.
    #[command(flatten)]
    pub source: SourceArgs,
    /// System profile, which decides what is usable: a built-in name or a TOML file. [default: open]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
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
    /// Keep the records as the first stage of the suite in this folder. [default: nothing is kept]
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl RecordsArgs {
    /// What was typed, over `base`.
    fn over(&self, base: Options) -> Options {
        let mut source = self.source.clone();
        source.records.extend(self.files.iter().cloned());
        let base = source.over(base);
        Options { profile: self.profile.clone().unwrap_or(base.profile), ..base }
    }

    /// The tables that are asked for.
    fn tables(&self, options: &Options) -> Result<Vec<(TableFormat, File)>, PipelineError> {
        let mut wanted = Vec::new();
        wanted.extend(self.csv.iter().map(|path| (TableFormat::Csv, path)));
        #[cfg(feature = "parquet")]
        wanted.extend(self.parquet.iter().map(|path| (TableFormat::Parquet, path)));
        let mut outputs = record_outputs(options, self.out.as_deref());
        wanted.into_iter().map(|(format, path)| Ok((format, outputs.claim(path)?))).collect()
    }
}

/// Reads crash files and shows what is in them.
///
/// # Errors
/// A file cannot be read or written.
pub fn run(args: &RecordsArgs, output: Output) -> Result<(), PipelineError> {
    let saved = args.out.as_deref().map(Suite::saved_options).transpose()?.flatten();
    let options = args.over(saved.unwrap_or_else(crate::options::defaults));
    let tables = args.tables(&options)?;
    let (records, diagnostics) = match &args.out {
        None => {
            let Outcome { value, diagnostics } = read_records(&options)?;
            (value, diagnostics)
        }
        Some(out) => {
            let suite = Suite::open(out, options, Resources::default())?;
            let report = run_stage(&suite, Stage::Records, &*output.progress())?;
            (suite.store().read_json("1-records.json")?, report.diagnostics)
        }
    };
    let rows = if args.all { TableRows::All } else { TableRows::Usable };
    let write = |(format, output): &(TableFormat, File)| write_records(&records, rows, *format, output);
    let written = tables.iter().map(write).collect::<Result<Vec<usize>, _>>()?;
    let shown = distributions(&records);
    if output.json {
        output::json(&serde_json::json!({
            "distributions": shown,
            "files": records.files, "funnel": records.funnel, "usable": records.usable.len(),
            "diagnostics": diagnostics,
        }));
    } else if !output.quiet {
        output::remark_list(&diagnostics, "told by --json");
        files(&records);
        funnel(&records.funnel);
        sum(&records);
        show_distributions(&shown);
        for (rows, (_, table)) in written.iter().zip(&tables) {
            println!("{rows} records in {}", table.name().display());
        }
    }
    Ok(())
}

/// Prints the files read.
fn files(records: &RecordSet) {
    title("Files");
    let mut table = table(&["file", "edition", "rows", "SHA-256"]);
    for file in &records.files {
        table.add_row(vec![
            Cell::new(&file.name),
            Cell::new(file.edition.label()),
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

/// Prints that the counts add up.
fn sum(records: &RecordSet) {
    let merged = records.rejects.iter().filter(|reject| reject.reason == RejectReason::Merged).count();
    let rejected = records.rejects.len() - merged;
    let (rows, usable) = (records.files.iter().map(|file| file.rows).sum::<usize>(), records.usable.len());
    println!("{rows} rows = {usable} usable + {rejected} rejected + {merged} merged");
}

/// Prints how the records are spread: of all that could be read, and of the usable ones.
fn show_distributions(all: &[Distribution]) {
    title("Distributions (records, usable ones behind the stroke)");
    for distribution in all {
        let shown: Vec<String> = distribution
            .values
            .iter()
            .take(VALUES_SHOWN)
            .map(|count| format!("{} {}/{}", one_line(&count.value), count.records, count.usable))
            .collect();
        let more = distribution.values.len().saturating_sub(VALUES_SHOWN);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        println!("  {:<12} {}{more}", distribution.field, shown.join(", "));
    }
}
