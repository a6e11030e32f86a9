//! The vehicle alone: given controls on both simulators, and how far apart the vehicle ends.

use super::start;
use crate::error::PipelineError;
use crate::progress::{Progress, ProgressEvent};
use recrash_lab::parity::compare::quantile;
use recrash_metadrive::Drive;
use recrash_model::Seed;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::SUBSTEPS;
use recrash_model::scenario::{
    EgoSpec, Environment, MapSpec, SCENARIO_FORMAT, ScenarioDraft, Source, StraightMap, Traffic,
};
use recrash_model::seed::Rng;
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{Scenario, check};
use recrash_sim::{Chassis, Controls, VehicleState};
use serde::Serialize;
use std::path::PathBuf;

/// Length of a run: 5 s. [steps]
const STEPS: usize = 50;

/// Controls change as often: every 0.8 s. [steps]
const HOLD_STEPS: usize = 8;

/// Greatest steering of the runs, and the median distance that is asked for. Beyond 0.2 tyres mostly slide.
const LIMITS: [(f64, Option<f64>); 3] = [(0.05, Some(0.3)), (0.2, Some(0.8)), (0.5, None)];

/// What to run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OpenLoopRequest {
    /// Runs, shared among the limits of steering.
    pub count: usize,
    /// Seed.
    pub seed: u64,
    /// Python interpreter with MetaDrive.
    pub python: PathBuf,
    /// MetaDrive workers at once.
    pub workers: usize,
}

/// Open loop on both simulators.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OpenLoop {
    /// Always `recrash.open-loop/1`.
    pub format: &'static str,
    /// Seed.
    pub seed: u64,
    /// For each greatest steering.
    pub limits: Vec<OpenLoopLimit>,
}

/// Runs with one greatest steering.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OpenLoopLimit {
    /// Greatest steering; 1 is 40 degrees at the wheels.
    pub steer: f64,
    /// Distance after 5 s of each run, sorted. [m]
    pub apart_m: Vec<f64>,
    /// Median of these. [m]
    pub median_m: f64,
    /// Greatest median that is asked for. [m]
    pub wanted_m: Option<f64>,
}

impl OpenLoopLimit {
    /// Whether the median is small enough.
    pub fn passed(&self) -> bool {
        self.wanted_m.is_none_or(|wanted| self.median_m <= wanted)
    }
}

impl OpenLoop {
    /// Whether every median is small enough.
    pub fn passed(&self) -> bool {
        self.limits.iter().all(OpenLoopLimit::passed)
    }
}

/// Drives 5 s with random throttle, brake and steering on both simulators.
///
/// # Errors
/// Python or MetaDrive is missing, or a run failed there twice.
pub fn open_loop(request: &OpenLoopRequest, progress: &dyn Progress) -> Result<OpenLoop, PipelineError> {
    const STAGE: &str = "open loop";
    let metadrive = start(&request.python, request.workers)?;
    let each = request.count.div_ceil(LIMITS.len());
    progress.event(ProgressEvent::Started { stage: STAGE, units: each * LIMITS.len() });
    let mut limits = Vec::new();
    for (steer, wanted_m) in LIMITS {
        let mut apart_m = Vec::new();
        for number in 0..each {
            let mut rng = Seed(request.seed).child(&format!("open loop {steer} {number}")).rng();
            let speed_mps = rng.range(2.0, 18.0);
            let controls = random_controls(&mut rng, steer);
            let scenario = plain_road(speed_mps);
            let rollout = metadrive
                .simulate(&scenario, &Drive::OpenLoop(controls.clone()))
                .map_err(|error| PipelineError::bad_input(error.to_string()))?;
            let theirs = rollout.ego_track().states.last().copied().unwrap_or_default();
            apart_m.push(drive(&scenario, &controls).distance(theirs.position()));
            progress.event(ProgressEvent::Advanced { stage: STAGE, unit: "MetaDrive", skipped: false });
        }
        apart_m.sort_by(f64::total_cmp);
        limits.push(OpenLoopLimit { steer, median_m: quantile(&apart_m, 0.5), apart_m, wanted_m });
    }
    progress.event(ProgressEvent::Finished { stage: STAGE });
    Ok(OpenLoop { format: "recrash.open-loop/1", seed: request.seed, limits })
}

/// Where the native vehicle is after these controls.
fn drive(scenario: &Scenario, controls: &[[f64; 2]]) -> recrash_model::geometry::Vec2 {
    let chassis = Chassis::new(&VehicleSpec::of(PartnerKind::PassengerCar), Surface::Dry);
    let mut state = VehicleState::new(scenario.ego().pose, scenario.ego().speed_mps);
    for &[steer, throttle] in controls {
        let command = state.command(&chassis, Controls { steer, throttle });
        for _ in 0..SUBSTEPS {
            state.advance(&chassis, &command);
        }
    }
    state.pose.position
}

/// Controls that change every 0.8 s: throttle, brake or coast, and any steering within the limit.
fn random_controls(rng: &mut Rng, limit: f64) -> Vec<[f64; 2]> {
    let mut controls = Vec::with_capacity(STEPS + HOLD_STEPS);
    while controls.len() < STEPS {
        let throttle = match rng.uniform() {
            draw if draw < 0.55 => rng.range(0.1, 1.0),
            draw if draw < 0.8 => -rng.range(0.05, 1.0),
            _ => 0.0,
        };
        let steer = rng.range(-limit, limit);
        controls.extend([[steer, throttle]; HOLD_STEPS]);
    }
    controls.truncate(STEPS);
    controls
}

/// A wide straight road with nobody else.
fn plain_road(speed_mps: f64) -> Scenario {
    let draft = ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: "open-loop".to_owned(),
        source: Source::default(),
        map: MapSpec::S(StraightMap { lanes: 4, lane_width_m: 3.5, approach_m: 60.0, length_m: 200.0 }),
        ego: EgoSpec { lane: 1, s_m: 5.0, speed_mps, target_speed_mps: speed_mps, ..EgoSpec::default() },
        partners: Vec::new(),
        obstacles: Vec::new(),
        traffic: Traffic::default(),
        environment: Environment::default(),
        duration_s: 0.1 * STEPS as f64,
        ..ScenarioDraft::default()
    };
    check(draft).unwrap_or_else(|problems| unreachable!("a plain road is fit to drive on: {problems:?}")).value
}
