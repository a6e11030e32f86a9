//! `recrash evidence`: claims with numbers that a stranger can work out again.

use crate::options::EgoArgs;
use crate::output::{self, Output};
use crate::screen::println;
use clap::Args;
use recrash_pipeline::{EvidenceRequest, PipelineError, TestRequest, evidence};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash evidence nightly --ego 'cmd:./my_stack' --out evidence
  recrash evidence paper-suite --tuned --out evidence    a suite, frozen on the way
  recrash evidence nightly --ego idm --results tonight.json --with robustness.json --with parity.json --out evidence
  python3 evidence/check.py                              works every number out again

What is in the folder: docs/evidence.md.";

/// Options of `evidence`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct EvidenceArgs {
    /// A frozen suite's folder, or a suite's.
    #[arg(value_name = "FROZEN|SUITE")]
    pub source: PathBuf,
    /// Who drives, and where.
    #[command(flatten)]
    pub ego: EgoArgs,
    /// Of a suite: the scenarios as tuned.
    #[arg(long)]
    pub tuned: bool,
    /// Results of `recrash test` that the runs must give again.
    #[arg(long, value_name = "RESULTS")]
    pub results: Option<PathBuf>,
    /// A report of `recrash robustness` or `recrash parity`; may be given more than once.
    #[arg(long = "with", value_name = "REPORT")]
    pub reports: Vec<PathBuf>,
    /// The folder to make.
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
}

/// Writes the folder.
///
/// # Errors
/// The suite cannot be opened or run, the results are others, or a file cannot be written.
pub fn run(args: &EvidenceArgs, output: Output) -> Result<(), PipelineError> {
    let test = TestRequest {
        frozen: args.source.clone(),
        ego: args.ego.ego.clone(),
        simulator: args.ego.sim.unwrap_or_default(),
        python: args.ego.python.clone(),
        patience: args.ego.patience(),
        seeds: 1,
        threads: args.ego.threads.map(usize::from),
        out: None,
    };
    let written = evidence(
        &EvidenceRequest {
            test,
            tuned: args.tuned,
            results: args.results.clone(),
            reports: args.reports.clone(),
            folder: args.out.clone(),
        },
        &*output.progress(),
    )?;
    if output.json {
        output::json(&written);
    } else if output.tables() {
        let folder = written.folder.display();
        println!("{} claims with {} numbers in {folder}", written.claims, written.numbers);
        println!("SHA-256 of manifest.json: {}", written.root);
        println!("check it with: python3 {folder}/check.py");
    }
    Ok(())
}
