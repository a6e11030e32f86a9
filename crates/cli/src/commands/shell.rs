//! `recrash completions` and `recrash man`: what a shell and `man` want to know of the command line.

use super::Cli;
use crate::output::Output;
use crate::screen::{self, println};
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use recrash_pipeline::{Outputs, PipelineError};
use std::path::PathBuf;

const COMPLETION_EXAMPLES: &str = "\
Examples:
  recrash completions bash > ~/.local/share/bash-completion/completions/recrash
  recrash completions zsh > ~/.zfunc/_recrash            a folder of $fpath
  recrash completions fish > ~/.config/fish/completions/recrash.fish";

const MAN_EXAMPLES: &str = "\
Examples:
  recrash man ~/.local/share/man/man1                    then: man recrash, man recrash-run";

/// Options of `completions`.
#[derive(Debug, Clone, Args)]
#[command(after_help = COMPLETION_EXAMPLES)]
pub struct CompletionArgs {
    /// Shell.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Options of `man`.
#[derive(Debug, Clone, Args)]
#[command(after_help = MAN_EXAMPLES)]
pub struct ManArgs {
    /// Folder to write the pages into, one a command.
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
}

/// Prints the completions for a shell.
pub fn completions(args: &CompletionArgs) {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "recrash", &mut script);
    screen::raw(&script);
}

/// Writes the manual pages.
///
/// # Errors
/// A page cannot be written.
pub fn man(args: &ManArgs, output: Output) -> Result<(), PipelineError> {
    let mut command = Cli::command();
    command.build();
    let mut pages = Vec::new();
    add_pages(&command, &mut pages);
    let failed = |action, source| PipelineError::Io { action, path: args.dir.clone(), source };
    std::fs::create_dir_all(&args.dir).map_err(|source| failed("create", source))?;
    let mut outputs = Outputs::default();
    for page in &pages {
        let mut text = Vec::new();
        page.render(&mut text).map_err(|source| failed("write", source))?;
        outputs.claim(&args.dir.join(page.get_filename()))?.write(&text)?;
    }
    if output.tables() {
        println!("{} pages in {}", pages.len(), args.dir.display());
    }
    Ok(())
}

/// The pages of a command and of those below it.
fn add_pages(command: &clap::Command, pages: &mut Vec<Man>) {
    pages.push(Man::new(command.clone()));
    for below in command.get_subcommands().filter(|below| below.get_name() != "help") {
        add_pages(below, pages);
    }
}
