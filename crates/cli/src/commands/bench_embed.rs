//! `recrash bench embed`: our MiniLM beside sentence-transformers.

use crate::options::SourceArgs;
use crate::output::{self, Output};
use crate::screen::{eprintln, println};
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{EmbedBench, EmbedBenchRequest, Options, PipelineError, bench_embedding};
use std::path::PathBuf;

/// Greatest difference of a value that is allowed: the grid to which embeddings are rounded before they are clustered.
const ALLOWED_DIFFERENCE: f64 = 1e-5;

const EXAMPLES: &str = "\
Examples:
  recrash bench embed --python .venv/bin/python --records ads-archive.csv
  taskset -c 0,1 recrash bench embed --python .venv/bin/python      both sides on the same two cores

Python needs sentence-transformers; both sides read the same model folder (see recrash model).";

/// Options of `bench embed`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct BenchEmbedArgs {
    /// Where narratives come from.
    #[command(flatten)]
    pub source: SourceArgs,
    /// Narratives to embed.
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u16).range(1..=2000))]
    pub count: u16,
    /// Measurements of each side, in turn.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=100))]
    pub rounds: u16,
    /// Threads of each side.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Folder with the files of all-MiniLM-L6-v2. [default: looked for]
    #[arg(long, value_name = "DIR")]
    pub model_dir: Option<PathBuf>,
    /// Python interpreter with sentence-transformers.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
}

/// Measures both sides and shows them.
///
/// # Errors
/// The model or Python is missing.
pub fn run(args: &BenchEmbedArgs, output: Output) -> Result<(), PipelineError> {
    if output.tables() {
        eprintln!("measuring {} times in turn, {} threads each", args.rounds, args.threads);
    }
    let options = Options { model_dir: args.model_dir.clone(), ..args.source.over(crate::options::defaults()) };
    let bench = bench_embedding(&EmbedBenchRequest {
        options,
        count: usize::from(args.count),
        rounds: usize::from(args.rounds),
        threads: usize::from(args.threads),
        python: args.python.clone(),
    })?;
    if output.json {
        output::json(&bench);
    } else if !output.quiet {
        show(&bench);
    }
    Ok(())
}

/// Prints what was measured.
fn show(bench: &EmbedBench) {
    println!(
        "all-MiniLM-L6-v2, {} narratives of {} characters on average, {} at most; {} threads each",
        bench.narratives,
        bench.total_chars / bench.narratives.max(1),
        bench.longest_chars,
        bench.threads
    );
    let mut rows = table(&["program", "load", "best", "median", "narratives/s", "measured"]);
    for side in &bench.sides {
        let measured: Vec<String> = side.times_s.iter().map(|time| format!("{time:.2}")).collect();
        rows.add_row(vec![
            Cell::new(&side.name),
            number(format!("{:.2} s", side.load_s)),
            number(format!("{:.2} s", side.best_s())),
            number(format!("{:.2} s", side.median_s())),
            number(format!("{:.0}", bench.narratives as f64 / side.median_s())),
            Cell::new(measured.join(" ")),
        ]);
    }
    println!("{rows}");
    let [ours, theirs] = &bench.sides;
    let within = if bench.max_difference <= ALLOWED_DIFFERENCE { "within" } else { "NOT within" };
    println!("greatest difference of a value {:.1e}: {within} {ALLOWED_DIFFERENCE:.0e}", bench.max_difference);
    println!("speed against sentence-transformers: {:.2} times by the medians", theirs.median_s() / ours.median_s());
}
