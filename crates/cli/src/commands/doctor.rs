//! `recrash doctor`: what is installed, and how to get the rest.

use crate::output::{self, Output};
use crate::screen::{bold, println};
use crate::table::{Cell, table};
use clap::Args;
use recrash_pipeline::{DoctorItem, DoctorRequest, DoctorState, PipelineError, doctor};
use std::path::PathBuf;

const NOTES: &str = "\
Examples:
  recrash doctor
  recrash doctor --python .venv/bin/python --json

Exit code 0, whatever is missing: a run with the defaults needs none of it.";

/// Options of `doctor`.
#[derive(Debug, Clone, Args)]
#[command(after_help = NOTES)]
pub struct DoctorArgs {
    /// Python interpreter to look at.
    #[arg(long, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
    /// Folder with the files of all-MiniLM-L6-v2. [default: looked for]
    #[arg(long, value_name = "DIR")]
    pub model_dir: Option<PathBuf>,
}

/// Looks and tells.
///
/// # Errors
/// None: what is missing is told, and is no error.
pub fn run(args: &DoctorArgs, output: Output) -> Result<(), PipelineError> {
    let items = doctor(&DoctorRequest { python: args.python.clone(), model_dir: args.model_dir.clone() });
    if output.json {
        output::json(&items);
    } else if !output.quiet {
        show(&items);
    }
    Ok(())
}

fn show(items: &[DoctorItem]) {
    let mut rows = table(&["", "state", "found", "needed for"]);
    for item in items {
        rows.add_row([item.name, item.state.name(), &item.found, item.needed_for].map(Cell::new));
    }
    println!("{rows}");
    let lacking: Vec<&DoctorItem> = items.iter().filter(|item| item.state != DoctorState::Ready).collect();
    if !lacking.is_empty() {
        println!("\nTo get the rest (all of it is optional):");
    }
    for item in lacking {
        println!("  {} {}", bold(format!("{:<16}", item.name)), item.remedy);
    }
}
