//! Drivers on the grids of UN R157 and at the limits of EU 2022/1426: the reference drivers, and an ego of the user's.
//!
//! Described in `docs/models/reference-drivers.md`.

mod limits;
mod plot;
mod scenarios;

pub use limits::{LimitCheck, Survived};

use crate::error::PipelineError;
use crate::files::folders::must_be_free;
use crate::files::json::to_json;
use crate::files::output::Outputs;
use crate::files::store::io;
use crate::progress::{Progress, ProgressEvent};
use crate::simulators::external::{Patience, default_python};
use crate::simulators::{Simulator, SimulatorKind, start_simulator};
use rayon::prelude::*;
use recrash_drivers::{Concrete, Grid, drive};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// What was found: the file that says that a folder is one of ours.
const CHECK_FILE: &str = "check-driver.json";

/// What to try, and where to write it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CheckDriverRequest {
    /// An ego of the native simulator, or a program, beside the reference drivers.
    pub ego: Option<String>,
    /// How long answers of a program are waited for.
    pub patience: Patience,
    /// One in so many scenarios of each grid is tried, spread over it; 1 for all.
    pub every: usize,
    /// Folder for `check-driver.json`, `verdicts.csv` and a plot of each grid.
    pub out: PathBuf,
}

/// What the drivers do.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriverCheck {
    /// Always `recrash.check-driver/1`.
    pub format: &'static str,
    /// One in so many scenarios was tried.
    pub every: usize,
    /// By grid, and in it by driver.
    pub grids: Vec<GridCheck>,
    /// By closing speed.
    pub limits: Vec<LimitCheck>,
}

/// One driver on one grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GridCheck {
    /// Grid.
    pub grid: &'static str,
    /// Driver.
    pub driver: String,
    /// Scenarios that it drove.
    pub scenarios: usize,
    /// Scenarios that it could not drive: too fast for the simulator.
    pub not_run: usize,
    /// Crashes.
    pub crashes: usize,
    /// Of an ego: crashes in scenarios that every reference driver avoids, and that some, but not every one avoids.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub avoided_by: Option<AvoidedBy>,
    /// The same by speed at the start.
    pub by_speed: Vec<SpeedCheck>,
}

/// How many of an ego's crashes reference drivers avoid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct AvoidedBy {
    /// Every reference driver that covers the grid.
    pub all: usize,
    /// Some, but not every one.
    pub some: usize,
}

/// One driver at one speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpeedCheck {
    /// Speed at the start. [km/h]
    pub speed_kmh: f64,
    /// Scenarios that it drove.
    pub scenarios: usize,
    /// Crashes.
    pub crashes: usize,
}

/// How one scenario ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Verdict {
    /// It cannot be driven.
    NotRun,
    /// Nobody touches the ego.
    Avoided,
    /// Somebody does; speeds of both. [m/s]
    Crashed { ego_mps: f64, other_mps: f64 },
}

impl Verdict {
    fn crashed(self) -> bool {
        matches!(self, Self::Crashed { .. })
    }
}

/// One driver's verdicts on a grid.
struct Column {
    driver: String,
    is_reference: bool,
    verdicts: Vec<Verdict>,
}

/// Tries the drivers and writes what they do.
///
/// # Errors
/// There is no such ego, it fails in a scenario, or a file cannot be written.
pub fn check_driver(request: &CheckDriverRequest, progress: &dyn Progress) -> Result<DriverCheck, PipelineError> {
    const STAGE: &str = "check-driver";
    let simulator = match &request.ego {
        Some(ego) => {
            let programs = rayon::current_num_threads();
            Some(start_simulator(SimulatorKind::Native, ego, &default_python(), programs, request.patience)?)
        }
        None => None,
    };
    must_be_free(&request.out, Some(CHECK_FILE))?;
    std::fs::create_dir_all(&request.out).map_err(|error| io("create", &request.out, error))?;
    let mut outputs = Outputs::default();
    let mut files = Vec::new();
    let mut grids = Vec::new();
    let mut csv =
        "grid,driver,ego_kmh,other_kmh,gap_m,lateral_mps,deceleration_g,verdict,ego_mps,other_mps\n".to_owned();
    let all = Grid::ALL.map(|grid| (grid, spread(grid.scenarios(), request.every)));
    // An ego takes its time in each scenario, the reference drivers in none.
    let drives = simulator.is_some();
    let units = if drives { all.iter().map(|(_, scenarios)| scenarios.len()).sum() } else { Grid::ALL.len() };
    progress.event(ProgressEvent::Started { stage: STAGE, units });
    for (grid, scenarios) in all {
        let mut columns = references(grid, &scenarios);
        if let Some(simulator) = &simulator {
            let driven = || progress.event(ProgressEvent::Advanced { stage: STAGE, unit: grid.name(), skipped: false });
            columns.push(ego(&**simulator, &scenarios, driven)?);
        }
        for column in &columns {
            grids.push(count(grid, &scenarios, column, &columns));
            write_rows(&mut csv, grid, &scenarios, column);
        }
        files.push((format!("{}.svg", grid.name()), plot::svg(grid, &scenarios, &columns).into_bytes()));
        if !drives {
            progress.event(ProgressEvent::Advanced { stage: STAGE, unit: grid.name(), skipped: false });
        }
    }
    let limits = limits::check(simulator.as_deref())?;
    let check = DriverCheck { format: "recrash.check-driver/1", every: request.every.max(1), grids, limits };
    files.push(("verdicts.csv".to_owned(), csv.into_bytes()));
    files.push((CHECK_FILE.to_owned(), to_json(&check)));
    for (name, content) in files {
        outputs.claim(&request.out.join(name))?.write(&content)?;
    }
    progress.event(ProgressEvent::Finished { stage: STAGE });
    Ok(check)
}

/// One in so many, by the multiples of the golden ratio: a fixed step would meet the same few numbers of an axis again and again.
fn spread(scenarios: Vec<Concrete>, every: usize) -> Vec<Concrete> {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let taken = |number: usize| (number as f64 * GOLDEN).fract() < 1.0 / every.max(1) as f64;
    scenarios.into_iter().enumerate().filter(|&(number, _)| taken(number)).map(|(_, scenario)| scenario).collect()
}

fn references(grid: Grid, scenarios: &[Concrete]) -> Vec<Column> {
    let verdict = |scenario: &Concrete, driver| match drive(scenario, driver) {
        None => Verdict::Avoided,
        Some(crash) => Verdict::Crashed { ego_mps: crash.ego_mps, other_mps: crash.other_mps },
    };
    grid.drivers()
        .map(|driver| Column {
            driver: driver.name().to_owned(),
            is_reference: true,
            verdicts: scenarios.par_iter().map(|scenario| verdict(scenario, driver)).collect(),
        })
        .collect()
}

fn ego(simulator: &dyn Simulator, scenarios: &[Concrete], driven: impl Fn() + Sync) -> Result<Column, PipelineError> {
    let run = |scenario| run(simulator, scenario).inspect(|_| driven());
    let verdicts = scenarios.par_iter().map(run).collect::<Result<_, _>>()?;
    Ok(Column { driver: simulator.ego().to_owned(), is_reference: false, verdicts })
}

/// Runs one scenario with the ego; any contact of the ego's is a crash.
fn run(simulator: &dyn Simulator, scenario: &Concrete) -> Result<Verdict, PipelineError> {
    let Some(scenario) = scenarios::of(scenario) else { return Ok(Verdict::NotRun) };
    let rollout = simulator.run(&scenario).map_err(|error| PipelineError::not_run(&error))?;
    Ok(match rollout.first_ego_contact() {
        None => Verdict::Avoided,
        Some((_, _, ego, other)) => {
            Verdict::Crashed { ego_mps: ego.velocity().length(), other_mps: other.velocity().length() }
        }
    })
}

fn speed_kmh(scenario: &Concrete) -> f64 {
    match *scenario {
        Concrete::CutIn { ego_kmh, .. } => ego_kmh,
        Concrete::CutOut { speed_kmh, .. } | Concrete::Following { speed_kmh, .. } => speed_kmh,
    }
}

fn count(grid: Grid, scenarios: &[Concrete], column: &Column, columns: &[Column]) -> GridCheck {
    let mut by_speed: BTreeMap<u32, SpeedCheck> = BTreeMap::new();
    let mut avoided_by = AvoidedBy::default();
    for (number, (scenario, verdict)) in scenarios.iter().zip(&column.verdicts).enumerate() {
        let speed_kmh = speed_kmh(scenario);
        if *verdict == Verdict::NotRun {
            continue;
        }
        let none = SpeedCheck { speed_kmh, scenarios: 0, crashes: 0 };
        let counted = by_speed.entry(speed_kmh.round() as u32).or_insert(none);
        counted.scenarios += 1;
        if verdict.crashed() {
            counted.crashes += 1;
            let references = columns.iter().filter(|other| other.is_reference);
            let avoid = references.clone().filter(|other| !other.verdicts[number].crashed()).count();
            avoided_by.all += usize::from(avoid == references.clone().count());
            avoided_by.some += usize::from(avoid > 0 && avoid < references.count());
        }
    }
    let sum = |of: fn(&SpeedCheck) -> usize| by_speed.values().map(of).sum::<usize>();
    let run = sum(|speed| speed.scenarios);
    GridCheck {
        grid: grid.name(),
        driver: column.driver.clone(),
        scenarios: run,
        not_run: scenarios.len() - run,
        crashes: sum(|speed| speed.crashes),
        avoided_by: (!column.is_reference).then_some(avoided_by),
        by_speed: by_speed.into_values().collect(),
    }
}

/// One row for each scenario.
fn write_rows(csv: &mut String, grid: Grid, scenarios: &[Concrete], column: &Column) {
    // A name of a program may hold anything.
    let driver = format!("\"{}\"", column.driver.replace('"', "\"\""));
    for (scenario, verdict) in scenarios.iter().zip(&column.verdicts) {
        let numbers = match *scenario {
            Concrete::CutIn { ego_kmh, other_kmh, gap_m, lateral_mps } => {
                format!("{ego_kmh},{other_kmh},{gap_m},{lateral_mps:.1},")
            }
            Concrete::CutOut { speed_kmh, gap_m, lateral_mps } => format!("{speed_kmh},,{gap_m},{lateral_mps:.1},"),
            Concrete::Following { speed_kmh, deceleration_g } => format!("{speed_kmh},,,,{deceleration_g:.2}"),
        };
        let verdict = match verdict {
            Verdict::NotRun => "not run,,".to_owned(),
            Verdict::Avoided => "avoided,,".to_owned(),
            Verdict::Crashed { ego_mps, other_mps } => format!("crashed,{ego_mps:.3},{other_mps:.3}"),
        };
        let _ = writeln!(csv, "{},{driver},{numbers},{verdict}", grid.name());
    }
}

#[cfg(test)]
mod tests;
