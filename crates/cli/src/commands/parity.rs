//! `recrash parity`: the same scenarios on the native simulator and on MetaDrive, side by side.

use crate::output::{self, Output};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{
    OpenLoop, OpenLoopRequest, Parity, ParityRequest, ParitySource, PipelineError, open_loop, parity,
};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  recrash parity --n 200 --seed 1                        200 random ones, table and replays in parity/
  recrash parity paper-suite --out paper-suite-parity    every scenario of a suite, as designed and as tuned
  recrash parity --open-loop                             the vehicle alone: 5 s of random throttle, brake and steering

MetaDrive must be installed: recrash doctor says whether it is.
Exit code 5: a share that is asked for was missed; the results are written all the same.";

/// Options of `parity`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ParityArgs {
    /// Folder of a suite: its scenarios instead of random ones.
    #[arg(value_name = "SUITE", conflicts_with_all = ["count", "seed", "open_loop"])]
    pub suite: Option<PathBuf>,
    /// Random scenarios to draw, in turn on the paper's maps and on networks of roads. [default: 200; with --open-loop 60]
    #[arg(long = "n", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub count: Option<u32>,
    /// Seed of the random scenarios.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Compare the vehicle alone, with given controls.
    #[arg(long)]
    pub open_loop: bool,
    /// Python interpreter with MetaDrive.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
    /// MetaDrive workers at once; each takes 300 MB, and the results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: u16,
    /// Folder for parity.json, parity.csv, parity.html and the scenarios of the worst pairs.
    #[arg(long, short, value_name = "DIR", default_value = "parity")]
    pub out: PathBuf,
}

/// Compares.
///
/// # Errors
/// MetaDrive is missing, a file cannot be read or written, or a share that is asked for was missed.
pub fn run(args: &ParityArgs, output: Output) -> Result<(), PipelineError> {
    if args.open_loop {
        return run_open_loop(args, output);
    }
    let source = match &args.suite {
        Some(dir) => ParitySource::Suite { dir: dir.clone() },
        None => ParitySource::Random { count: args.count.unwrap_or(200) as usize, seed: args.seed },
    };
    let request = ParityRequest {
        source,
        python: args.python.clone(),
        workers: usize::from(args.threads),
        out: args.out.clone(),
    };
    let result = parity(&request, &*output.progress())?;
    if output.json {
        output::json(&result);
    } else if !output.quiet {
        show(&result, &args.out);
    }
    let missed: Vec<&str> = result.thresholds.iter().filter(|each| !each.passed).map(|each| each.what).collect();
    missed_or_done(&missed)
}

fn run_open_loop(args: &ParityArgs, output: Output) -> Result<(), PipelineError> {
    let request = OpenLoopRequest {
        count: args.count.unwrap_or(60) as usize,
        seed: args.seed,
        python: args.python.clone(),
        workers: usize::from(args.threads),
    };
    let result = open_loop(&request, &*output.progress())?;
    if output.json {
        output::json(&result);
    } else if !output.quiet {
        show_open_loop(&result);
    }
    if result.passed() { Ok(()) } else { missed_or_done(&["median distance after 5 s"]) }
}

fn missed_or_done(missed: &[&str]) -> Result<(), PipelineError> {
    if missed.is_empty() {
        Ok(())
    } else {
        Err(PipelineError::Missed { what: format!("missed: {}", missed.join("; ")) })
    }
}

fn show(parity: &Parity, out: &Path) {
    println!("{} against {}", parity.simulators[0], parity.simulators[1]);
    for each in parity.tables() {
        output::title(each.caption);
        let mut rows = table(&each.header);
        for row in &each.rows {
            let cells = row.iter().enumerate().map(|(column, cell)| {
                let is_number = column > 0 && cell.starts_with(|c: char| c.is_ascii_digit());
                if is_number { number(cell) } else { Cell::new(cell) }
            });
            rows.add_row(cells.collect::<Vec<_>>());
        }
        println!("{rows}");
    }
    println!("\n{} holds parity.html with the worst side by side, parity.csv and parity.json", out.display());
}

fn show_open_loop(result: &OpenLoop) {
    let mut rows = table(&["steering up to", "runs", "median after 5 s", "worst", "asked for", ""]);
    for limit in &result.limits {
        let worst = limit.apart_m.last().copied().unwrap_or(0.0);
        let verdict = match (limit.wanted_m, limit.passed()) {
            (None, _) => String::new(),
            (Some(_), true) => "reached".to_owned(),
            (Some(_), false) => "missed".to_owned(),
        };
        rows.add_row(vec![
            number(limit.steer),
            number(limit.apart_m.len()),
            number(format!("{:.2} m", limit.median_m)),
            number(format!("{worst:.2} m")),
            number(limit.wanted_m.map_or_else(|| "-".to_owned(), |wanted| format!("{wanted} m"))),
            Cell::new(verdict),
        ]);
    }
    println!("{rows}");
}
