//! One concrete scenario, driven in the published geometry: a straight road, boxes of 4.3 by 1.9 m, ten steps a second, 35 s.
//!
//! A vehicle moves by its speed of the step that it moves to. Places are summed in the published order, because some grid points
//! lie on a limit to the last bit.

use crate::driver::{Conflict, Driver, ReferenceDriver};
use crate::grid::Concrete;
use crate::sight::{Body, STEPS_PER_S};
use recrash_model::vehicle::GRAVITY_MPS2;

const LENGTH_M: f64 = 4.3;
/// Width of every vehicle in the published grids. [m]
pub const WIDTH_M: f64 = 1.9;
/// Steps after the start of the scenario.
const STEPS: usize = 350;
/// Between the two that drive side by side before a cut-in. [m]
const LATERAL_GAP_M: f64 = 1.6;
/// How fast a vehicle that cuts in gains its lateral speed. [m/s^2]
const LATERAL_MPS2: f64 = 1.5;
/// How far a vehicle that leaves the lane goes aside. [m]
const LANE_CHANGE_M: f64 = 4.0;
/// Swaying in the lane; beyond it a vehicle leaves the lane (unr157, Annex 4, Appendix 3). [m]
const SWAYING_M: f64 = 0.375;
/// The vehicle that stands behind a cut-out is longer than the others, as published. [m]
const STANDING_LENGTH_M: f64 = 5.0;

/// The moment when the vehicle under test touches the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crash {
    /// Since the first step. [s]
    pub time_s: f64,
    /// Speed of the vehicle under test. [m/s]
    pub ego_mps: f64,
    /// Speed of the other along the road. [m/s]
    pub other_mps: f64,
}

/// Drives one scenario; the first touch, if any. `None` also where [`ReferenceDriver::following_distance_m`] knows no distance
/// to follow at: ask [`crate::Grid::drivers`] who covers what.
pub fn drive(scenario: &Concrete, model: ReferenceDriver) -> Option<Crash> {
    match *scenario {
        Concrete::CutIn { ego_kmh, other_kmh, gap_m, lateral_mps } => {
            cut_in(model, ego_kmh / 3.6, other_kmh / 3.6, gap_m, lateral_mps)
        }
        Concrete::CutOut { speed_kmh, gap_m, lateral_mps } => cut_out(model, speed_kmh / 3.6, gap_m, lateral_mps),
        Concrete::Following { speed_kmh, deceleration_g } => {
            following(model, speed_kmh / 3.6, GRAVITY_MPS2 * deceleration_g)
        }
    }
}

pub(crate) fn body(along_m: f64, speed_mps: f64) -> Body {
    Body { along_m, across_m: 0.0, speed_mps, lateral_mps: 0.0, length_m: LENGTH_M, width_m: WIDTH_M }
}

/// The vehicle under test and its driver.
struct Ego {
    body: Body,
    driver: Driver,
    crash: Option<Crash>,
}

impl Ego {
    fn new(model: ReferenceDriver, conflict: Conflict, along_m: f64, speed_mps: f64) -> Self {
        Self { body: body(along_m, speed_mps), driver: Driver::new(model, conflict), crash: None }
    }

    /// One step: it looks, is held against the other where both are, and moves on.
    fn step(&mut self, step: usize, other: &Body) {
        let speed_mps = self.driver.next_speed_mps(&self.body, other);
        if self.body.touches(other) {
            let time_s = step as f64 / STEPS_PER_S;
            self.crash = Some(Crash { time_s, ego_mps: self.body.speed_mps, other_mps: other.speed_mps });
        }
        self.body.speed_mps = speed_mps;
        self.body.along_m += speed_mps / STEPS_PER_S;
    }
}

/// Steps in which a vehicle with this lateral speed goes this far aside, and one more.
fn steps_aside(way_m: f64, lateral_mps: f64) -> usize {
    let way = STEPS_PER_S * way_m;
    ((way - way % lateral_mps) / lateral_mps).round() as usize + 1
}

/// Where a vehicle is after each step that it drives with these speeds, from the first step on.
fn summed(start_m: f64, speeds_mps: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    speeds_mps
        .scan(0.0, |sum, speed_mps| {
            *sum += speed_mps;
            Some(*sum)
        })
        .map(move |sum: f64| sum / STEPS_PER_S + start_m)
}

fn cut_in(model: ReferenceDriver, ego_mps: f64, other_mps: f64, gap_m: f64, lateral_mps: f64) -> Option<Crash> {
    let before: Vec<f64> = gaining(lateral_mps);
    let start_m = before.iter().fold(0.0, |sum, _| sum - ego_mps / STEPS_PER_S);
    let mut ego = Ego::new(model, Conflict::CutIn, start_m, ego_mps);
    let others = cutting_in(&before, other_mps, gap_m, lateral_mps);
    for (step, other) in others.enumerate().take(before.len() + STEPS) {
        if apart_for_good(&ego.body, &other) {
            break;
        }
        ego.step(step, &other);
        if ego.crash.is_some() || ego.driver.settled() {
            break;
        }
    }
    ego.crash
}

/// Whether two that do not touch never will: the other keeps its speed, nobody here gains any, and who has passed the other
/// keeps its own.
fn apart_for_good(ego: &Body, other: &Body) -> bool {
    let falls_back =
        if ego.along_m > other.along_m { ego.speed_mps >= other.speed_mps } else { ego.speed_mps <= other.speed_mps };
    falls_back && ego.gap_m(other) > 0.0
}

/// Lateral speeds of the steps in which a vehicle that cuts in gains its own, towards the other lane. [m/s]
pub(crate) fn gaining(lateral_mps: f64) -> Vec<f64> {
    let gain_mps = LATERAL_MPS2 / STEPS_PER_S;
    (0..(lateral_mps / gain_mps).ceil() as u32).map(|step| -(f64::from(step) * gain_mps)).collect()
}

/// The vehicle that cuts in, step by step: while it gains lateral speed, at the moment when it has it, and from then on.
pub(crate) fn cutting_in(
    before_mps: &[f64],
    speed_mps: f64,
    gap_m: f64,
    lateral_mps: f64,
) -> impl Iterator<Item = Body> {
    let (along_m, across_m) = (gap_m + LENGTH_M, LATERAL_GAP_M + WIDTH_M);
    let at = move |along_m, across_m, lateral_mps| Body { across_m, lateral_mps, ..body(along_m, speed_mps) };
    // Backwards from where it has gained it.
    let (mut back_m, mut aside_m) = (0.0, 0.0);
    let mut gaining = vec![at(along_m, across_m, -lateral_mps)];
    for &before_mps in before_mps.iter().rev() {
        back_m -= speed_mps / STEPS_PER_S;
        aside_m -= before_mps / STEPS_PER_S;
        gaining.push(at(back_m + along_m, aside_m + across_m, before_mps));
    }
    gaining.reverse();
    let moving = if lateral_mps > 0.0 { steps_aside(across_m, lateral_mps) } else { 0 };
    let laterals = (0..STEPS).map(move |step| if step < moving { -lateral_mps } else { 0.0 });
    let places = summed(along_m, (0..STEPS).map(move |_| speed_mps)).zip(summed(across_m, laterals.clone()));
    gaining
        .into_iter()
        .chain(places.zip(laterals).map(move |((along_m, across_m), lateral_mps)| at(along_m, across_m, lateral_mps)))
}

fn cut_out(model: ReferenceDriver, speed_mps: f64, gap_m: f64, lateral_mps: f64) -> Option<Crash> {
    let along_m = model.following_distance_m(speed_mps)? + LENGTH_M;
    let standing = Body { length_m: STANDING_LENGTH_M, ..body(along_m + gap_m + LENGTH_M, 0.0) };
    let moving = steps_aside(LANE_CHANGE_M, lateral_mps);
    let laterals = (0..STEPS).map(|step| if step < moving { -lateral_mps } else { 0.0 });
    let leaders =
        summed(along_m, (0..STEPS).map(|_| speed_mps)).zip(summed(LANE_CHANGE_M, laterals.clone())).zip(laterals);
    let egos = summed(0.0, (0..STEPS).map(|_| speed_mps));

    let mut ego = Ego::new(model, Conflict::Ahead, 0.0, speed_mps);
    let mut wreck: Option<Body> = None;
    let mut looks = false;
    for (step, (((along_m, across_m), lateral_mps), undriven_m)) in leaders.zip(egos).enumerate().take(STEPS - 1) {
        if !looks {
            ego.body.along_m = undriven_m;
        }
        let leader = Body { across_m: across_m - LANE_CHANGE_M, lateral_mps, ..body(along_m, speed_mps) };
        if wreck.is_none() && leader.touches(&standing) {
            wreck = Some(Body { speed_mps: 0.0, lateral_mps: 0.0, ..leader });
        }
        if let Some(wreck) = &wreck {
            ego.step(step, wreck);
            looks = true;
        } else if leader.across_m < -SWAYING_M {
            ego.step(step, &standing);
            looks = true;
        }
        if ego.crash.is_some() {
            break;
        }
    }
    ego.crash
}

fn following(model: ReferenceDriver, speed_mps: f64, deceleration_mps2: f64) -> Option<Crash> {
    let along_m = model.following_distance_m(speed_mps)? + LENGTH_M;
    let speeds = (0..STEPS).map(|step| (speed_mps - step as f64 * deceleration_mps2 / STEPS_PER_S).max(0.0));
    let mut ego = Ego::new(model, Conflict::Ahead, speed_mps / STEPS_PER_S, speed_mps);
    for (step, (along_m, speed_mps)) in summed(along_m, speeds.clone()).zip(speeds).enumerate().take(STEPS - 1) {
        ego.step(step, &body(along_m, speed_mps));
        if ego.crash.is_some() {
            break;
        }
    }
    ego.crash
}
