//! `recrash robustness` and `recrash minimise`: the failures of a frozen suite, looked at closer.

use crate::options::EgoArgs;
use crate::output::{self, Output};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{
    FailureRequest, MinimalReport, PipelineError, RobustnessOf, RobustnessReport, TestRequest, minimal_failures,
    robustness_of_failures,
};
use std::path::{Path, PathBuf};

const ROBUSTNESS_EXAMPLES: &str = "\
Examples:
  recrash robustness nightly                             every failure under 20 small changes
  recrash robustness nightly --ego idm --only incident-30270-7733 --tries 200
  recrash robustness nightly --confirm --python .venv/bin/python   and on MetaDrive

What is changed, and by how much: docs/models/robustness.md.";

const MINIMISE_EXAMPLES: &str = "\
Examples:
  recrash minimise nightly --out minimal                 every failure, stripped, with the nearest scenario that passes
  recrash minimise tuned --record designed --out minimal numbers go back to those of the other frozen suite
  recrash simulate minimal/incident-30270-7733.passes.json --ego idm

What can be taken away: docs/models/minimal.md.";

/// Failures that the screen tells one by one.
const SHOWN: usize = 30;

/// Which failures.
#[derive(Debug, Clone, Args)]
pub struct FailureArgs {
    /// The frozen suite's folder.
    #[arg(value_name = "FROZEN")]
    pub frozen: PathBuf,
    /// Who drives, and where.
    #[command(flatten)]
    pub ego: EgoArgs,
    /// Only this test; may be given more than once.
    #[arg(long, value_name = "ID")]
    pub only: Vec<String>,
}

impl FailureArgs {
    fn request(&self, out: Option<&Path>) -> FailureRequest {
        let test = TestRequest {
            frozen: self.frozen.clone(),
            ego: self.ego.ego.clone(),
            simulator: self.ego.sim.unwrap_or_default(),
            python: self.ego.python.clone(),
            patience: self.ego.patience(),
            seeds: 1,
            threads: self.ego.threads.map(usize::from),
            out: out.map(Path::to_owned),
        };
        FailureRequest { test, only: self.only.clone() }
    }
}

/// Options of `robustness`.
#[derive(Debug, Clone, Args)]
#[command(after_help = ROBUSTNESS_EXAMPLES)]
pub struct RobustnessArgs {
    /// Which failures.
    #[command(flatten)]
    pub failures: FailureArgs,
    /// Random changes of each failure.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub tries: u32,
    /// Seed of the changes.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Run each failure on MetaDrive as well.
    #[arg(long)]
    pub confirm: bool,
    /// Write the report (JSON).
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Options of `minimise`.
#[derive(Debug, Clone, Args)]
#[command(after_help = MINIMISE_EXAMPLES)]
pub struct MinimiseArgs {
    /// Which failures.
    #[command(flatten)]
    pub failures: FailureArgs,
    /// A frozen suite of the same tests as their records tell them.
    #[arg(long, value_name = "FROZEN")]
    pub record: Option<PathBuf>,
    /// Folder for the scenarios and minimal.json.
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
}

/// Tells how robust failures are.
///
/// # Errors
/// The suite cannot be opened, the ego or a simulator fails, or a file cannot be written.
pub fn robustness(args: &RobustnessArgs, output: Output) -> Result<(), PipelineError> {
    let request = args.failures.request(args.out.as_deref());
    let report = robustness_of_failures(&request, args.tries, args.seed, args.confirm, &*output.progress())?;
    if output.json {
        output::json(&report);
    } else if output.tables() {
        show_robustness(&report);
    }
    Ok(())
}

fn show_robustness(report: &RobustnessReport) {
    output::title(&format!(
        "Failures of {} under {} small changes each, the least robust first",
        report.ego, report.tries
    ));
    let mut failures: Vec<&RobustnessOf> = report.failures.iter().collect();
    failures.sort_by(|a, b| a.share.total_cmp(&b.share).then(a.id.cmp(&b.id)));
    let header = ["test", "still fails", "still crashes", "lives on", "MetaDrive"];
    let mut rows = table(&header).without_first(&["MetaDrive", "still crashes"]);
    for each in failures.iter().take(SHOWN) {
        let found = &each.robustness;
        let lives = [("5 cm of", &found.lives_on_centimetres), ("0.1 s of", &found.lives_on_tenths)];
        let mut lives: Vec<String> = lives
            .into_iter()
            .filter(|(_, who)| !who.is_empty())
            .map(|(what, who)| format!("{what} {}", who.join(", ")))
            .collect();
        if each.step_artefact {
            lives.push("the physics step".to_owned());
        }
        let confirmed = each.confirmed.map_or("-", |confirmed| if confirmed { "fails" } else { "passes" });
        rows.add_row([
            Cell::new(&each.id),
            number(format!("{:.0} %", 100.0 * each.share)),
            number(format!("{} of {}", found.crashed, found.tries)),
            Cell::new(if lives.is_empty() { "-".to_owned() } else { lives.join("; ") }),
            Cell::new(confirmed),
        ]);
    }
    println!("{rows}");
    if failures.len() > SHOWN {
        println!("and {} more, told by --json and --out", failures.len() - SHOWN);
    }
    let count = |of: fn(&RobustnessOf) -> bool| report.failures.iter().filter(|each| of(each)).count();
    println!(
        "{} of {} tests fail; {} are robust (more than 80 % still fail), {} live on less than 5 cm or 0.1 s, {} on the physics \
         step",
        report.failures.len(),
        report.tests,
        count(|each| each.robust),
        count(|each| each.marginal),
        count(|each| each.step_artefact)
    );
    if let Some(second) = &report.confirmed_by {
        let run = count(|each| each.robust && each.confirmed.is_some());
        let confirmed = count(|each| each.robust && each.confirmed == Some(true));
        let unable = count(|each| each.robust && each.confirmed.is_none());
        let share = 100.0 * confirmed as f64 / run.max(1) as f64;
        println!(
            "{second}: {confirmed} of {run} robust failures fail there too ({share:.1} %); {unable} robust ones could not be run \
             there"
        );
    }
}

/// Strips failures.
///
/// # Errors
/// The suite cannot be opened, the ego or a simulator fails, or a file cannot be written.
pub fn minimise(args: &MinimiseArgs, output: Output) -> Result<(), PipelineError> {
    let request = args.failures.request(None);
    let report = minimal_failures(&request, args.record.as_deref(), &args.out, &*output.progress())?;
    if output.json {
        output::json(&report);
    } else if output.tables() {
        show_minimal(&report, &args.out);
    }
    Ok(())
}

fn show_minimal(report: &MinimalReport, folder: &Path) {
    output::title(&format!("What failures of {} need", report.ego));
    let mut rows = table(&["test", "fails by", "taken", "needed", "nearest that passes"]).without_first(&["taken"]);
    for each in report.failures.iter().take(SHOWN) {
        let needed: Vec<&str> = each.needed.iter().map(|needed| needed.name.as_str()).collect();
        rows.add_row([
            Cell::new(&each.id),
            Cell::new(each.findings.iter().map(|kind| kind.label()).collect::<Vec<_>>().join(", ")),
            number(each.taken.len()),
            Cell::new(if needed.is_empty() { "nothing else".to_owned() } else { needed.join(", ") }),
            Cell::new(each.difference.as_deref().unwrap_or("-")),
        ]);
    }
    println!("{rows}");
    if report.failures.len() > SHOWN {
        println!("and {} more, in minimal.json", report.failures.len() - SHOWN);
    }
    println!("{} failures in {}", report.failures.len(), folder.display());
}
