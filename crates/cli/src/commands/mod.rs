//! The subcommands: one file each, with what may be typed, what is done and what is shown.

mod bench;
mod bench_embed;
mod bench_sim;
mod doctor;
mod eval;
mod export;
mod fetch;
mod import;
mod model;
mod parity;
mod records;
mod run;
mod schema;
mod select;
mod simulate;
mod stage;
#[cfg(feature = "parquet")]
mod sweep;

use crate::options::SuiteArgs;
use crate::output::Output;
use clap::{Parser, Subcommand};
use recrash_pipeline::{PipelineError, Stage};

const EXAMPLES: &str = "\
Examples:
  recrash run                                            the built-in sample, everything else by default, into suite/
  recrash run --records SGO-2021-01_Incident_Reports_ADS.csv --profile paper --out paper-suite
  recrash simulate suite/6-tuned/01-intersection-straight-straight.json --ego idm
  recrash export suite --to openscenario,scenic          the suite for other tools, in suite/exports/
  recrash records SGO-2021-01_Incident_Reports_ADS.csv   what is in a crash file, and what of it can be used
  recrash fetch --edition archive                        NHTSA's crash file, for --records sgo-ads-archive.csv

Exit codes: 0 done; 1 a file could not be read or written; 2 wrong usage; 3 the input cannot be used;
  4 the run stopped and the same command goes on: questions wait for a batch, or a cap is reached;
  5 a share or speed that is asked for was missed; 130 interrupted";

/// Turns real crash records of automated vehicles into a simulation test suite for one system under test.
#[derive(Debug, Parser)]
#[command(name = "recrash", version, about, after_help = EXAMPLES, max_term_width = 110)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Print results as JSON on standard output.
    #[arg(long, global = true)]
    pub json: bool,
    /// Print errors only.
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Do everything: read, select, narrate, design, simulate, tune, report.
    Run(SuiteArgs),
    /// Stage 1: read crash files, and show what of them can be used.
    Records(records::RecordsArgs),
    /// Stage 2: choose a few records that stand for all.
    Select(select::SelectArgs),
    /// Stage 3: paraphrase the narratives of the picks.
    Narrate(SuiteArgs),
    /// Stage 4: design a scenario for each narrative, checked by running it.
    Design(SuiteArgs),
    /// Stage 5: run the scenarios of a suite; or run one scenario file and show its metrics.
    Simulate(simulate::SimulateArgs),
    /// Stage 6: search each scenario's parameters for the nearest failure that is still true to the record.
    Tune(SuiteArgs),
    /// Stage 7: write report.html, junit.xml and results.csv.
    Report(SuiteArgs),
    /// Write the scenarios of a suite, or one scenario file, in the formats of other tools.
    Export(export::ExportArgs),
    /// Read a scenario back: OpenSCENARIO that recrash wrote, or the paper's JSON dialect.
    Import(import::ImportArgs),
    /// Say how well the rules, or a model, read records: accuracy by field against labels that people wrote.
    Eval(eval::EvalArgs),
    /// Download NHTSA's crash file, whole or not at all, for --records.
    Fetch(fetch::FetchArgs),
    /// Get or find the files of the embedding model all-MiniLM-L6-v2.
    Model(model::ModelArgs),
    /// Run the same scenarios on both simulators, and tell how far they agree.
    Parity(parity::ParityArgs),
    /// Tell what is installed of all that can be used, and how to get the rest.
    Doctor(doctor::DoctorArgs),
    /// Measure speeds on this machine.
    Bench(bench::BenchArgs),
    /// Run very many rollouts around a scenario or a suite, into a Parquet file.
    #[cfg(feature = "parquet")]
    Sweep(sweep::SweepArgs),
    /// Print the JSON Schema of scenario files.
    Schema,
}

/// Runs a subcommand.
///
/// # Errors
/// Why it stopped.
pub fn run(cli: &Cli) -> Result<(), PipelineError> {
    let output = Output { json: cli.json, quiet: cli.quiet };
    match &cli.command {
        Command::Run(args) => run::run(args, output),
        Command::Records(args) => records::run(args, output),
        Command::Select(args) => select::run(args, output),
        Command::Narrate(args) => stage::run(args, Stage::Narrate, output),
        Command::Design(args) => stage::run(args, Stage::Design, output),
        Command::Simulate(args) => simulate::run(args, output),
        Command::Tune(args) => stage::run(args, Stage::Tune, output),
        Command::Report(args) => run::report(args, output),
        Command::Export(args) => export::run(args, output),
        Command::Import(args) => import::run(args, output),
        Command::Eval(args) => eval::run(args, output),
        Command::Fetch(args) => fetch::run(args, output),
        Command::Model(args) => model::run(args, output),
        Command::Parity(args) => parity::run(args, output),
        Command::Doctor(args) => doctor::run(args, output),
        Command::Bench(args) => bench::run(args, output),
        #[cfg(feature = "parquet")]
        Command::Sweep(args) => sweep::run(args, output),
        Command::Schema => schema::run(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
