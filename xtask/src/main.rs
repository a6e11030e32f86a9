//! The project's one script language. `cargo xtask ci` is what CI runs, and a developer's one command.

mod edges;
mod fuzz;
mod licences;
mod pages;
mod steps;
mod tally;
mod tidy;
mod wheel;

use std::process::ExitCode;
use tally::Tally;

const USAGE: &str = "\
usage: cargo xtask COMMAND
  ci         everything below down to `browser`, in this order (`python` beside the two behind it); stops at the first failure
  format     cargo fmt --check
  tidy       what no compiler checks: map and edges in ARCHITECTURE.md, file lengths, stray paths and hosts
  lint       clippy over all targets, warnings denied
  prepare    sets up .venv, a Python with MetaDrive (0.8 GB, once), and what drives the browser
  test       all Rust tests; those on a real MetaDrive where it is set up
  python     the Python tests
  fuzz       12 s of fuzzing for each reader of untrusted files
  docs       rustdoc, warnings denied
  wheel      lint, types, tests, notebook and API pages of the Python package, in a wheel that it builds; and its sdist
  wheel-size whether the release wheels in target/wheels are under 12 MB; `wheel` asks that too where one is there
  browser    makes a suite and clicks through its report in headless Chromium
  fuzz-keep  keeps what fuzzing found, as few inputs as reach the same code
  licences   writes python/LICENSES.txt: what stands in a wheel, and its licences
What was skipped is named at the end. With CI set in the environment a step that lacks something fails.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [command] = &arguments[..] else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    let mut tally = Tally::default();
    let result = match command.as_str() {
        "ci" => steps::ci(&mut tally),
        "fuzz-keep" => fuzz::keep(),
        "licences" => licences::write(),
        "wheel-size" => wheel::sizes(),
        name => match steps::STEPS.iter().find(|(step, _)| *step == name) {
            Some((_, step)) => step(&mut tally),
            None => {
                eprintln!("{USAGE}");
                return ExitCode::from(2);
            }
        },
    };
    let counts = ["ci", "prepare", "test", "python", "wheel", "browser"].contains(&command.as_str());
    if counts {
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
