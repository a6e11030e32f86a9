//! The `recrash` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(recrash_cli::command(std::env::args_os()))
}
