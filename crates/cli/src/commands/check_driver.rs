//! `recrash check-driver`: drivers on the grids of UN R157 and at the limits of EU 2022/1426.

use crate::output::{self, Output};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{CheckDriverRequest, DriverCheck, Patience, PipelineError, check_driver};
use std::path::{Path, PathBuf};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  recrash check-driver                                   the reference drivers on all 36,941 scenarios
  recrash check-driver --ego idm                         an ego beside them, where the native simulator goes as fast
  recrash check-driver --ego 'cmd:python3 my_ego.py' --every 20

Formulas, sources and where they are valid: docs/models/reference-drivers.md.";

/// Options of `check-driver`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct CheckDriverArgs {
    /// An ego beside the reference drivers: metadrive-idm, idm, reference, or cmd:PROGRAM.
    #[arg(long, value_name = "EGO")]
    pub ego: Option<String>,
    /// Seconds such a program may take for an answer; six times that to start.
    #[arg(long, value_name = "SECONDS", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=3600))]
    pub ego_timeout: u16,
    /// Try one in N scenarios of each grid only, spread over it.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub every: u16,
    /// Folder for check-driver.json, verdicts.csv and a plot of each grid.
    #[arg(long, short, value_name = "DIR", default_value = "check-driver")]
    pub out: PathBuf,
}

/// Tries the drivers and shows what they do.
///
/// # Errors
/// There is no such ego, it fails, or a file cannot be written.
pub fn run(args: &CheckDriverArgs, output: Output) -> Result<(), PipelineError> {
    let answer = Duration::from_secs(u64::from(args.ego_timeout));
    let request = CheckDriverRequest {
        ego: args.ego.clone(),
        patience: Patience { start: 6 * answer, answer },
        every: usize::from(args.every),
        out: args.out.clone(),
    };
    let check = check_driver(&request, &*output.progress())?;
    if output.json {
        output::json(&check);
    } else if output.tables() {
        show(&check, &args.out);
    }
    Ok(())
}

fn show(check: &DriverCheck, out: &Path) {
    output::title("crashes");
    let mut rows = table(&["grid", "driver", "scenarios", "crashes", "share", "all avoid", "some avoid", "not run"])
        .without_first(&["not run", "share"]);
    for grid in &check.grids {
        let share = 100.0 * grid.crashes as f64 / grid.scenarios.max(1) as f64;
        let avoided = |count: Option<usize>| number(count.map_or_else(String::new, |count| count.to_string()));
        rows.add_row(vec![
            Cell::new(grid.grid),
            Cell::new(&grid.driver),
            number(grid.scenarios),
            number(grid.crashes),
            number(if grid.scenarios == 0 { "-".to_owned() } else { format!("{share:.1} %") }),
            avoided(grid.avoided_by.map(|by| by.all)),
            avoided(grid.avoided_by.map(|by| by.some)),
            number(grid.not_run),
        ]);
    }
    println!("{rows}");
    if check.grids.iter().any(|grid| grid.avoided_by.is_some()) {
        println!(
            "all avoid, some avoid: its crashes in scenarios that every reference driver avoids, or some but not every; not run: the \
             simulator does not go so fast"
        );
    }
    output::title("least time to collision in a cut-in that is survived, beside the limits of EU 2022/1426");
    let names: Vec<&str> = check
        .limits
        .first()
        .map_or(Vec::new(), |limit| limit.survived.iter().map(|each| each.driver.as_str()).collect());
    let mut rows = table(&[&["closing", "limit", "limit, standing"], names.as_slice()].concat());
    for limit in &check.limits {
        let mut row = vec![
            Cell::new(format!("{} km/h", limit.closing_kmh)),
            number(format!("{:.2} s", limit.belted_s)),
            number(format!("{:.2} s", limit.standing_s)),
        ];
        let from = |from_s: Option<f64>| from_s.map_or_else(|| "-".to_owned(), |from_s| format!("{from_s:.2} s"));
        row.extend(limit.survived.iter().map(|each| number(from(each.from_s))));
        rows.add_row(row);
    }
    for (at, what) in [(0, "limits kept"), (1, "limits kept, standing")] {
        let kept = |driver: usize| {
            let of = check.limits.iter().filter_map(|limit| limit.survived.get(driver));
            of.filter(|each| [each.keeps_belted, each.keeps_standing][at]).count()
        };
        let blank = [Cell::new(what), Cell::new(""), Cell::new("")];
        let counts = (0..names.len()).map(|driver| number(format!("{} of {}", kept(driver), check.limits.len())));
        rows.add_row(blank.into_iter().chain(counts));
    }
    println!("{rows}");
    println!("\n{} holds check-driver.json, verdicts.csv and a plot of each grid", out.display());
}
