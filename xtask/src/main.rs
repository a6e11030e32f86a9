//! The project's one script language. `cargo xtask ci` is what CI runs, and a developer's one command.

mod steps;
mod tidy;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask COMMAND
  ci        everything below, in this order; stops at the first failure
  format    cargo fmt --check
  lint      clippy over all targets, warnings denied
  tidy      what no compiler checks: the map in ARCHITECTURE.md, file lengths, stray paths and hosts
  test      all Rust tests
  docs      rustdoc, warnings denied
  python    sets up .venv from requirements/dev.txt and runs the Python tests
  metadrive the tests on a real MetaDrive, in an environment of their own (0.8 GB, once)
  browser   makes a suite and clicks through its report in headless Chromium
  fuzz      20 s of fuzzing for each reader of untrusted files
With CI set in the environment a step that lacks something fails; without it, it is skipped by name.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["ci"] => steps::ci(),
        ["format"] => steps::format(),
        ["lint"] => steps::lint(),
        ["tidy"] => tidy::run(),
        ["test"] => steps::test(),
        ["docs"] => steps::docs(),
        ["python"] => steps::python(),
        ["metadrive"] => steps::metadrive(),
        ["browser"] => steps::browser(),
        ["fuzz"] => steps::fuzz(),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}
