//! `recrash export`: the scenarios in the formats of other tools.

use crate::output::{self, Output};
use anstream::println;
use clap::Args;
use recrash_pipeline::{ExportReport, ExportRequest, Format, PartnersAs, PipelineError};
use std::path::{Path, PathBuf};

/// Options of `export`.
#[derive(Debug, Clone, Args)]
pub struct ExportArgs {
    /// Folder of a suite, or a scenario file (JSON).
    #[arg(value_name = "SUITE|SCENARIO")]
    pub source: PathBuf,
    /// Formats, separated by commas: openscenario (with OpenDRIVE), scenic, metadrive, commonroad.
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', required = true)]
    pub to: Vec<Format>,
    /// How partners move: by their policies as actions, or on the trajectory that was recorded.
    #[arg(long = "as", value_name = "HOW", value_parser = ["actions", "trajectory"], default_value = "actions")]
    pub partners_as: String,
    /// Target folder; each format gets a folder in it. [default: exports, in the suite or beside the file]
    #[arg(long, value_name = "DIR")]
    pub to_dir: Option<PathBuf>,
    /// Overwrite files that are there already.
    #[arg(long)]
    pub force: bool,
}

/// Writes the scenarios.
///
/// # Errors
/// A scenario cannot be exported, or a file cannot be written.
pub fn run(args: &ExportArgs, output: Output) -> Result<(), PipelineError> {
    let partners_as = if args.partners_as == "trajectory" { PartnersAs::Trajectory } else { PartnersAs::Actions };
    let report = recrash_pipeline::export(&ExportRequest {
        source: args.source.clone(),
        formats: args.to.clone(),
        partners_as,
        target: args.to_dir.clone(),
        force: args.force,
    })?;
    if output.json {
        output::json(&report);
    } else if !output.quiet {
        show(&report);
    }
    match report.failures.is_empty() {
        true => Ok(()),
        false => Err(PipelineError::BadInput {
            what: format!("{} scenarios were not exported; the others were", report.failures.len()),
            diagnostics: report.failures,
        }),
    }
}

/// Prints what was exported.
fn show(report: &ExportReport) {
    let mut folders: Vec<(&Path, usize)> = Vec::new();
    for folder in report.files.iter().filter_map(|file| file.parent()) {
        match folders.last_mut() {
            Some((last, count)) if *last == folder => *count += 1,
            _ => folders.push((folder, 1)),
        }
    }
    for (folder, count) in folders {
        println!("{count} files in {}", folder.display());
    }
}
