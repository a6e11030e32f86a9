//! `recrash profile`: the built-in profiles, as a beginning of one's own.

use crate::screen;
use clap::Args;
use recrash_pipeline::{PipelineError, profile_text};

const EXAMPLES: &str = "\
Examples:
  recrash profile open > mine.toml                       the profile open, with all its fields
  recrash run --profile mine.toml --out mine             with it

A profile of one's own needs no more than what is otherwise in it: base = \"open\", then those fields. All of them: docs/profiles.md.";

/// Options of `profile`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ProfileArgs {
    /// open or paper.
    #[arg(value_name = "NAME")]
    pub name: String,
}

/// Prints a profile.
///
/// # Errors
/// There is none of this name.
pub fn run(args: &ProfileArgs) -> Result<(), PipelineError> {
    screen::raw(profile_text(&args.name)?.as_bytes());
    Ok(())
}
