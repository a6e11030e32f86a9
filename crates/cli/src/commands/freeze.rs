//! `recrash freeze`: tests in a folder that runs anywhere.

use crate::output::{self, Output};
use crate::screen::{println, yellow};
use clap::Args;
use recrash_pipeline::{FreezeRequest, PipelineError, freeze};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash freeze suite --out nightly                     the scenarios of a suite, as designed
  recrash freeze suite --tuned --out tuned-nightly       as tuned
  recrash freeze cases --out cases-frozen                scenario files, from folders or one by one
  recrash reconstruct ads.csv --to-dir scenes --json > told.json
  recrash freeze scenes --about told.json --out crashes  real crashes, with incidents and crash types
  recrash test crashes --ego idm                         anywhere, without the crash file

What is in the folder: docs/nightly.md.";

/// Scenarios left out that the screen tells one by one.
const SHOWN: usize = 5;

/// Options of `freeze`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct FreezeArgs {
    /// A suite's folder, folders of scenario files, or scenario files.
    #[arg(value_name = "SUITE|DIR|FILE", required = true)]
    pub sources: Vec<PathBuf>,
    /// The folder to make.
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
    /// What `recrash reconstruct --json` printed: incidents and crash types of the scenario files.
    #[arg(long, value_name = "FILE")]
    pub about: Option<PathBuf>,
    /// Profile that says what a failure is: a built-in name or a TOML file. [default: the suite's, else open]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Of a suite: the scenarios as tuned.
    #[arg(long)]
    pub tuned: bool,
    /// Put the text of the narratives into the folder.
    #[arg(long)]
    pub with_narratives: bool,
    /// Replace a frozen suite that is there.
    #[arg(long)]
    pub replace: bool,
}

/// Freezes, and says what.
///
/// # Errors
/// A source cannot be read or run, or the folder cannot be written.
pub fn run(args: &FreezeArgs, output: Output) -> Result<(), PipelineError> {
    let frozen = freeze(&FreezeRequest {
        sources: args.sources.clone(),
        about: args.about.clone(),
        out: args.out.clone(),
        profile: args.profile.clone(),
        default_profile: crate::options::defaults().profile,
        tuned: args.tuned,
        narratives: args.with_narratives,
        replace: args.replace,
    })?;
    if output.json {
        output::json(&frozen);
    } else if output.tables() {
        let whose = frozen.provenance.iter().map(|(whose, count)| format!("{count} {}", whose.label()));
        println!("{} tests in {} ({})", frozen.tests, frozen.folder.display(), whose.collect::<Vec<_>>().join(", "));
        println!("crash type known of {}; content {}", frozen.typed, frozen.content);
        for left_out in frozen.left_out.iter().take(SHOWN) {
            println!("{} {left_out}", yellow("left out:"));
        }
        if frozen.left_out.len() > SHOWN {
            println!("and {} more, told by --json", frozen.left_out.len() - SHOWN);
        }
    }
    Ok(())
}
