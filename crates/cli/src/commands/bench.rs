//! `recrash bench`: speeds, measured on the machine at hand.

use super::bench_embed;
use super::bench_sim;
use crate::output::Output;
use clap::{Args, Subcommand};
use recrash_pipeline::PipelineError;

const EXAMPLES: &str = "\
Examples:
  recrash bench sim                                      the native simulator on this machine
  recrash bench embed --python .venv/bin/python          MiniLM beside sentence-transformers";

/// Options of `bench`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct BenchArgs {
    /// What to measure.
    #[command(subcommand)]
    pub what: What,
}

/// What to measure.
#[derive(Debug, Clone, Subcommand)]
pub enum What {
    /// MiniLM embeddings, beside sentence-transformers.
    Embed(bench_embed::BenchEmbedArgs),
    /// The native simulator, beside MetaDrive.
    Sim(bench_sim::BenchSimArgs),
}

/// Measures.
///
/// # Errors
/// What is measured cannot be run.
pub fn run(args: &BenchArgs, output: Output) -> Result<(), PipelineError> {
    match &args.what {
        What::Embed(args) => bench_embed::run(args, output),
        What::Sim(args) => bench_sim::run(args, output),
    }
}
