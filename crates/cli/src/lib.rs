//! The `recrash` command: reads what was typed, runs the pipeline, shows what came of it.
// What is printed goes through `screen`, which keeps it clean and knows whether it was written.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod bars;
mod commands;
mod model_options;
mod options;
mod output;
mod screen;
mod table;

use clap::Parser;
use std::ffi::OsString;

/// Exit code of a standard output that cannot be written, as of any other file.
const CANNOT_WRITE: u8 = 1;

/// Runs the command that stands in these words, the first of which is the program's own name. Gives the exit code.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let code = match commands::Cli::try_parse_from(words) {
        Ok(cli) => run(&cli),
        Err(error) => usage(&error),
    };
    match screen::finish() {
        Ok(()) => code,
        Err(error) => {
            output::cannot_print(&error);
            if code == 0 { CANNOT_WRITE } else { code }
        }
    }
}

fn run(cli: &commands::Cli) -> u8 {
    on_interrupt(cli.command.goes_on());
    let Err(error) = commands::run(cli) else { return 0 };
    output::error(&error);
    if error.goes_on() {
        output::go_on();
    }
    error.exit_code()
}

/// Shows help, or what is wrong with what was typed.
fn usage(error: &clap::Error) -> u8 {
    if error.use_stderr() {
        // It quotes what was typed.
        output::usage(&error.render().to_string());
    } else {
        screen::written(error.print());
    }
    u8::try_from(error.exit_code()).unwrap_or(CANNOT_WRITE)
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
