//! `recrash bench sim`: the native simulator beside MetaDrive, on the same scenarios.

use crate::output::{self, Output};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{PipelineError, SimBench, SimBenchRequest, bench_sim};
use std::path::PathBuf;
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  recrash bench sim --python .venv/bin/python
  recrash bench sim --json

Without MetaDrive the native figures stand alone. Exit code 5: a figure that is asked for was missed. Only a release build on
a machine with two idle cores says what the simulator can do.";

/// Options of `bench sim`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct BenchSimArgs {
    /// Random scenarios that both simulators run.
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u16).range(1..=2000))]
    pub count: u16,
    /// Their seed.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Measurements of the native simulator, of at least a second each; the fastest counts.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=100))]
    pub rounds: u16,
    /// Python interpreter with MetaDrive.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
}

/// Measures and shows.
///
/// # Errors
/// MetaDrive fails, or a figure that is asked for was missed.
pub fn run(args: &BenchSimArgs, output: Output) -> Result<(), PipelineError> {
    let request = SimBenchRequest {
        count: usize::from(args.count),
        seed: args.seed,
        rounds: usize::from(args.rounds),
        least: Duration::from_secs(1),
        python: args.python.clone(),
    };
    let bench = bench_sim(&request, &*output.progress())?;
    if output.json {
        output::json(&bench);
    } else if !output.quiet {
        show(&bench);
    }
    let missed: Vec<&str> = bench.asked().into_iter().filter(|(.., passed)| !passed).map(|(what, ..)| what).collect();
    if missed.is_empty() {
        Ok(())
    } else {
        Err(PipelineError::Missed { what: format!("missed: {}", missed.join("; ")) })
    }
}

fn show(bench: &SimBench) {
    println!("{} scenarios, {} agent-steps; {} cores", bench.scenarios, bench.agent_steps, bench.cores);
    let mut rows = table(&["", "agent-steps/s"]);
    let figure = |figure: f64| number(format!("{figure:.0}"));
    rows.add_row(vec![Cell::new("native, one thread"), figure(bench.one_thread)]);
    rows.add_row(vec![Cell::new("native, two threads"), figure(bench.two_threads)]);
    if let Some(metadrive) = bench.metadrive {
        rows.add_row(vec![Cell::new(format!("{}, one worker", bench.metadrive_note)), figure(metadrive)]);
    }
    println!("{rows}");
    let mut rows = table(&["", "measured", "asked for", ""]);
    for (what, figure, wanted, passed) in bench.asked() {
        let shown = |value: f64| if value > 1e4 { format!("{value:.0}") } else { format!("{value:.2}") };
        let verdict = if figure.is_none() {
            "not measured"
        } else if passed {
            "reached"
        } else {
            "missed"
        };
        rows.add_row(vec![
            Cell::new(what),
            number(figure.map_or_else(|| "-".to_owned(), shown)),
            number(shown(wanted)),
            Cell::new(verdict),
        ]);
    }
    println!("{rows}");
    if bench.metadrive.is_none() {
        println!("MetaDrive was not measured: {}", bench.metadrive_note);
    }
}
