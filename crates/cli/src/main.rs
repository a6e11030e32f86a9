//! The `recrash` command: reads what was typed, runs the pipeline, shows what came of it.

mod bars;
mod commands;
mod model_options;
mod options;
mod output;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = commands::Cli::parse();
    on_interrupt(cli.command.goes_on());
    match commands::run(&cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            output::error(&error);
            if error.goes_on() {
                output::go_on();
            }
            ExitCode::from(error.exit_code())
        }
    }
}

/// Ctrl-C stops at once: files are written whole or taken away, and every answer of a model is in the ledger as soon as it is there.
fn on_interrupt(goes_on: bool) {
    // Without a handler the system stops the program as well, only without a word.
    let _ = ctrlc::set_handler(move || {
        recrash_pipeline::remove_unfinished();
        recrash_pipeline::end_programs();
        output::interrupted(goes_on);
        std::process::exit(130);
    });
}
