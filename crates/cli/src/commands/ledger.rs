//! `recrash ledger`: what models were asked, what they answered, and what it cost.

use crate::output::{self, Output, title};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{LedgerReport, LedgerSum, PipelineError, ledger};
use std::path::PathBuf;

const NOTES: &str = "\
Examples:
  recrash ledger                           sums of the suite in suite/
  recrash ledger mini-suite --list         every exchange as well
  recrash ledger mini-suite --json | jq .total.cost_usd

A file of prices, for --prices here and in recrash run, goes before the built-in table (USD for a million tokens):
  [[model]]
  name = \"my-model\"
  input_usd = 0.5
  output_usd = 1.5
  batch_share = 0.5            what a batch costs of that; 1 where it is left out
  checked = \"2026-11-21\"
  source = \"our contract\"";

/// Options of `ledger`.
#[derive(Debug, Clone, Args)]
#[command(after_help = NOTES)]
pub struct LedgerArgs {
    /// Folder of the suite.
    #[arg(value_name = "SUITE", default_value = "suite")]
    pub suite: PathBuf,
    /// List every exchange.
    #[arg(long)]
    pub list: bool,
    /// Prices of models (TOML), for exchanges that have none from when they were asked.
    #[arg(long, value_name = "FILE")]
    pub prices: Option<PathBuf>,
}

/// Lists, sums and prices.
///
/// # Errors
/// There is no ledger, or it cannot be read.
pub fn run(args: &LedgerArgs, output: Output) -> Result<(), PipelineError> {
    let report = ledger(&args.suite, args.prices.as_deref())?;
    if output.json {
        output::json(&report);
    } else if !output.quiet {
        if args.list {
            list(&report);
        }
        sums(&report);
    }
    Ok(())
}

fn list(report: &LedgerReport) {
    title("Exchanges");
    let mut rows = table(&["scenario", "role", "attempt", "model", "read", "written", "time", "USD", "ledger file"]);
    for entry in &report.exchanges {
        rows.add_row(vec![
            Cell::new(&entry.scenario_id),
            Cell::new(entry.role.name()),
            number(entry.attempt),
            Cell::new(&entry.model),
            number(entry.input_tokens),
            number(entry.output_tokens),
            number(entry.latency_s.map_or_else(|| "-".into(), |s| format!("{s:.1} s"))),
            number(entry.cost_usd.map_or_else(|| "?".into(), |usd| format!("{usd:.4}"))),
            Cell::new(format!("{}...", &entry.hash[..12.min(entry.hash.len())])),
        ]);
    }
    println!("{rows}");
}

fn sums(report: &LedgerReport) {
    title("Ledger");
    let mut rows = table(&["role", "model", "answers", "repairs and rounds", "tokens read", "written", "time", "USD"]);
    let row = |role: &str, model: &str, sum: &LedgerSum| {
        vec![
            Cell::new(role),
            Cell::new(model),
            number(sum.answers),
            number(sum.later),
            number(sum.input_tokens),
            number(sum.output_tokens),
            number(format!("{:.0} s", sum.latency_s)),
            number(format!("{:.4}", sum.cost_usd)),
        ]
    };
    for part in &report.by_model {
        rows.add_row(row(part.role.name(), &part.model, &part.sum));
    }
    rows.add_row(row("all", "", &report.total));
    println!("{rows}");
    if !report.without_price.is_empty() {
        println!("no price is known for {}: give it with --prices FILE", report.without_price.join(", "));
    }
}
