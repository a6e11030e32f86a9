//! The project's one script language. `cargo xtask ci` is what CI runs, and a developer's one command.

mod compiler;
mod edges;
mod fuzz;
mod licences;
mod links;
mod pages;
mod steps;
mod tally;
mod tidy;
mod wheel;

use std::process::ExitCode;
use tally::Tally;

const USAGE: &str = "\
usage: cargo xtask ci | STEP... | COMMAND
  ci         all steps: `format`, `tidy`, `prepare`; `build`; then those that build more beside those that run what was built
steps, of which several are done one after the other:
  format     cargo fmt --check
  tidy       what no compiler checks: map and edges in ARCHITECTURE.md, file lengths, stray paths and hosts
  prepare    sets up .venv, a Python with MetaDrive (0.8 GB, once), and what drives the browser
  test       all Rust tests; those on a real MetaDrive where it is set up
  python     the Python tests
  browser    makes a suite and clicks through its report in headless Chromium
  build      programs, tests, examples and benchmarks, with Clippy's lints on the way, warnings denied
  fuzz       a short run of fuzzing for each reader of untrusted files
  wheel      lint, types, tests, notebook and API pages of the Python package, in a wheel that it builds; and its sdist
  docs       rustdoc over all of that, warnings denied; and the program without language models is linted
commands:
  wheel-size whether the release wheels in target/wheels are under 12 MB; `wheel` asks that too where one is there
  fuzz-keep  keeps what fuzzing found, as few inputs as reach the same code
  licences   writes python/LICENSES.txt: what stands in a wheel, and its licences
What was skipped is named at the end. With CI set in the environment a step that lacks something fails.";

/// Steps that count tests, or say that they are skipped.
const COUNT: [&str; 6] = ["ci", "prepare", "test", "python", "wheel", "browser"];

fn main() -> ExitCode {
    if let Some(code) = compiler::stand_in() {
        return code;
    }
    if let Err(why) = compiler::prepare() {
        eprintln!("xtask: {why}");
        return ExitCode::FAILURE;
    }
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let mut tally = Tally::default();
    let result = match &words[..] {
        ["ci"] => steps::ci(&mut tally),
        ["fuzz-keep"] => fuzz::keep(),
        ["licences"] => licences::write(),
        ["wheel-size"] => wheel::sizes(),
        names if !names.is_empty() && names.iter().all(|name| steps::STEPS.iter().any(|(step, _)| step == name)) => {
            steps::in_turn(names, &mut tally)
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    if words.iter().any(|word| COUNT.contains(word)) {
        println!("{}", tally.closing());
    }
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}
