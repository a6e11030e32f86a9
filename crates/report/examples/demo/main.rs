//! Writes the report of a made-up suite: `cargo run -p recrash-report --example demo -- FOLDER [SCENARIOS]` makes
//! `FOLDER/report.html` and `FOLDER/report/`. `-- junit` and `-- csv` print the other two.

mod drive;
mod roads;
mod suite;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let count = words.get(1).map_or(Ok(suite::DESIGNED), |count| count.parse());
    match (words.first(), count) {
        (Some(&"junit"), _) => print!("{}", recrash_report::junit(&suite::demo().suite)),
        (Some(&"csv"), _) => print!("{}", recrash_report::results_csv(&suite::demo().suite)),
        (Some(folder), Ok(count)) => {
            if let Err(why) = suite::demo_of(count).write(Path::new(folder)) {
                eprintln!("{folder}: {why}");
                return ExitCode::FAILURE;
            }
        }
        _ => {
            eprintln!("usage: demo FOLDER [SCENARIOS] | junit | csv");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
