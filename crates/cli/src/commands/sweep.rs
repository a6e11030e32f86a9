//! `recrash sweep`: very many rollouts around a scenario or a suite, as a table.

use crate::output::{self, Output};
use crate::screen::{bold, eprintln, println, yellow};
use crate::table::{Cell, number, table};
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use recrash_pipeline::{Patience, PipelineError, Sweep, SweepRequest, SweepSummary, Vary};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const EXAMPLES: &str = "\
Examples:
  recrash sweep suite -n 1000000 --out rollouts.parquet        the suite's tuned scenarios in turn, as far as tuning may move them
  recrash sweep crossing.json --vary /partners/0/start/arrival_gap_s=-2:2 --vary /ego/target_speed_mps=6:10
  recrash sweep suite -n 1000000 --ego reference --out reference.parquet
  recrash sweep suite -n 1000000 --rollout 4711 --out one.json  the scenario of one row, for `recrash simulate`";

/// Options of `sweep`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct SweepArgs {
    /// A scenario file, or the folder of a suite, whose scenarios are taken as tuned.
    #[arg(value_name = "SCENARIO|SUITE")]
    pub source: PathBuf,
    /// Rollouts.
    #[arg(long, short = 'n', value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    pub rollouts: u64,
    /// A number of the scenario that varies, uniformly; may be given several times. [default: what tuning may move]
    #[arg(long, value_name = "POINTER=MIN:MAX")]
    pub vary: Vec<Vary>,
    /// Parquet file to write, whole or not at all.
    #[arg(long, short, value_name = "FILE", default_value = "rollouts.parquet")]
    pub out: PathBuf,
    /// Write the scenario of this one rollout instead, as JSON.
    #[arg(long, value_name = "NUMBER")]
    pub rollout: Option<u64>,
    /// System profile with the failure criteria. [default: the suite's, else open]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Ego: metadrive-idm, idm, reference, or a program as 'cmd:PROGRAM ARGS'. [default: the suite's, else the profile's]
    #[arg(long, value_name = "NAME|cmd:PROGRAM")]
    pub ego: Option<String>,
    /// Start the program that the suite names as its ego.
    #[arg(long)]
    pub trust: bool,
    /// Seconds such a program may take for an answer; six times that to start.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u16).range(1..=3600), default_value_t = 10)]
    pub ego_timeout: u16,
    /// Seed of the samples.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Worker threads; the file does not depend on it. [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// Runs the rollouts.
///
/// # Errors
/// The scenario cannot be used, or the file cannot be written.
pub fn run(args: &SweepArgs, output: Output) -> Result<(), PipelineError> {
    let answer = Duration::from_secs(u64::from(args.ego_timeout));
    let defaults = crate::options::defaults();
    let sweep = Sweep::prepare(&SweepRequest {
        source: &args.source,
        vary: &args.vary,
        rollouts: args.rollouts,
        profile: args.profile.as_deref(),
        default_profile: &defaults.profile,
        ego: args.ego.as_deref(),
        patience: Patience { start: 6 * answer, answer },
        seed: args.seed,
        threads: args.threads.map(usize::from),
        trust: args.trust,
        out: &args.out,
    })?;
    if let Some(number) = args.rollout {
        return sweep.write_draft(number);
    }
    if !output.quiet && !sweep.passed_over().is_empty() {
        let ids = sweep.passed_over();
        eprintln!(
            "  {} {} scenarios without a tuned file are not swept: {}",
            yellow("warning"),
            ids.len(),
            ids.join(", ")
        );
    }
    if !output.quiet && !sweep.fixed().is_empty() {
        let ids = sweep.fixed();
        eprintln!(
            "  {} {} scenarios in which no number may move are not swept: {}",
            yellow("warning"),
            ids.len(),
            ids.join(", ")
        );
    }
    if !output.quiet && !sweep.parked().is_empty() {
        let ids = sweep.parked();
        eprintln!(
            "  {} {} scenarios whose ego was parked are not swept, as there is nothing to test: {}",
            yellow("warning"),
            ids.len(),
            ids.join(", ")
        );
    }
    let bar = bar(args.rollouts, output);
    let begun = Instant::now();
    let summary = sweep.run(&|done| bar.set_position(done))?;
    bar.finish_and_clear();
    let seconds = begun.elapsed().as_secs_f64();
    if output.json {
        output::json(&summary);
    } else if !output.quiet {
        let rate = summary.rollouts as f64 / seconds.max(1e-9);
        eprintln!("  sweep     {} rollouts  {seconds:.1} s  {rate:.0}/s", summary.rollouts);
        show(&summary, sweep.ego());
    }
    Ok(())
}

/// A bar with rate and time left; none where nobody looks.
fn bar(rollouts: u64, output: Output) -> ProgressBar {
    let seen = output.tables() && std::io::stderr().is_terminal();
    let target = if seen { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(rollouts), target);
    let template = "  sweep     {bar:28} {human_pos}/{human_len}  {per_sec}  {eta} left";
    bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn show(summary: &SweepSummary, ego: &str) {
    let mut rows = table(&["verdict", "rollouts", "share"]);
    for (verdict, &count) in &summary.verdicts {
        let share = 100.0 * count as f64 / summary.rollouts.max(1) as f64;
        rows.add_row(vec![Cell::new(verdict), number(count), number(format!("{share:.2} %"))]);
    }
    println!("{rows}");
    let varied: usize = summary.scenarios.iter().map(|scenario| scenario.parameters.len()).sum();
    println!("{} {} scenarios, {varied} parameters, ego {ego}", bold("swept:"), summary.scenarios.len());
    if let Some((number, gap)) = summary.closest {
        println!("least gap: {gap:.3} m in rollout {number}");
    }
    println!("table: {}", summary.file.display());
}
