//! `recrash export`: the scenarios in the formats of other tools.

use crate::output::{self, Output};
use crate::screen::println;
use clap::Args;
use recrash_pipeline::{ExportReport, ExportRequest, Format, PartnersAs, PipelineError};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  recrash export suite --to openscenario,scenic,metadrive,commonroad,scenarionet    in every format, in suite/exports/
  recrash export suite --to openscenario --as trajectory --to-dir t     partners on the way that was recorded
  recrash export suite --to openscenario --designed --to-dir crashes    the crashes as reconstructed, before tuning
  recrash export suite/6-tuned/intersection-straight-straight-90101-80.json --to scenic --to-dir t
  recrash import suite/exports/openscenario/intersection-straight-straight-90101-80.xosc    and back

What each file holds, and what each tool takes for a position, a heading and a time: docs/formats.";

/// Options of `export`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ExportArgs {
    /// Folder of a suite, whose scenarios are taken as tuned; folder of scenario files, as reconstruct writes them; or a scenario file
    /// (JSON).
    #[arg(value_name = "SUITE|FOLDER|SCENARIO")]
    pub source: PathBuf,
    /// Formats, separated by commas: openscenario (with OpenDRIVE), scenic, metadrive, commonroad, scenarionet.
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', required = true)]
    pub to: Vec<Format>,
    /// Of a suite: the scenarios as designed, before tuning; by accounts, the crashes as reconstructed.
    #[arg(long)]
    pub designed: bool,
    /// How partners move: by their policies as actions, or on the trajectory that was recorded.
    #[arg(long = "as", value_name = "HOW", value_parser = ["actions", "trajectory"], default_value = "actions")]
    pub partners_as: String,
    /// Target folder; each format gets a folder in it. [default: exports, in the suite or beside the file]
    #[arg(long, value_name = "DIR")]
    pub to_dir: Option<PathBuf>,
    /// Overwrite files that are there already and hold something else.
    #[arg(long)]
    pub force: bool,
    /// Python interpreter for an ego of MetaDrive's or in Python, where its runs are not in the suite.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
    /// Start the program that the suite names as its ego, where its runs are not in the suite; the exports hold what it drives.
    #[arg(long)]
    pub trust: bool,
}

/// Writes the scenarios.
///
/// # Errors
/// A scenario cannot be exported, or a file cannot be written.
pub fn run(args: &ExportArgs, output: Output) -> Result<(), PipelineError> {
    let partners_as = if args.partners_as == "trajectory" { PartnersAs::Trajectory } else { PartnersAs::Actions };
    let report = recrash_pipeline::export(&ExportRequest {
        source: args.source.clone(),
        designed: args.designed,
        formats: args.to.clone(),
        partners_as,
        target: args.to_dir.clone(),
        force: args.force,
        python: args.python.clone(),
        trust: args.trust,
    })?;
    if output.json {
        output::json(&report);
    } else if !output.quiet {
        show(&report);
    }
    if report.failures.is_empty() {
        return Ok(());
    }
    Err(PipelineError::BadInput { what: not_exported(&report), diagnostics: report.failures })
}

/// How many scenarios were not exported, or not in every format, and what became of the others.
fn not_exported(report: &ExportReport) -> String {
    let mut failed: Vec<_> = report.failures.iter().map(|failure| &failure.location.file).collect();
    failed.dedup();
    let (lost, made, partial) = (failed.len() - report.partial, report.scenarios, report.partial);
    if partial > 0 {
        let scenarios = if partial == 1 { "1 scenario was" } else { &format!("{partial} scenarios were") };
        let lost = if lost == 0 { String::new() } else { format!(", {lost} in none") };
        return format!("{scenarios} not exported in every format{lost}; everything else was written");
    }
    match (lost, made) {
        (1, 0) => "the scenario was not exported".to_owned(),
        (_, 0) => format!("none of {lost} scenarios was exported"),
        (1, _) => format!("1 scenario was not exported; the other {made} were"),
        _ => format!("{lost} scenarios were not exported; the other {made} were"),
    }
}

/// Prints what was exported.
fn show(report: &ExportReport) {
    let mut folders: Vec<(&Path, usize)> = Vec::new();
    for folder in report.files.iter().filter_map(|file| file.parent()) {
        match folders.iter_mut().find(|(known, _)| *known == folder) {
            Some((_, count)) => *count += 1,
            _ => folders.push((folder, 1)),
        }
    }
    for (folder, count) in folders {
        println!("{count} files in {}", folder.display());
    }
}
