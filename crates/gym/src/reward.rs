//! What is good and bad in a step: terms that are measured, and weights that people choose.

use crate::kinematics::{others, thing};
use crate::scene::Scene;
use recrash_model::rollout::{Event, EventKind, STEP_S, TerminationKind};
use recrash_model::scenario::Aspect;
use recrash_sim::{Observation, Run};

/// Braking harder than this counts. [m/s^2]
const COMFORTABLE_MPS2: f64 = 3.0;

/// A gap below this is near: the limit of the paper's near misses. [m]
const NEAR_M: f64 = 2.0;

/// Names of the terms, in the order of their values.
pub const TERMS: [&str; 10] = [
    "progress",
    "braking",
    "red_light",
    "near",
    "contact",
    "closing_speed",
    "obstacle",
    "arrived",
    "off_road",
    "stuck",
];

/// Weights of the terms; the reward of a step is their weighted sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reward {
    /// Of the way come along the route in this step, as a share of what the target speed would give; -1 to 1.
    pub progress: f64,
    /// Of the deceleration beyond 3 m/s^2. [1 s^2/m]
    pub braking: f64,
    /// Of every stop line passed at red.
    pub red_light: f64,
    /// Of the share by which the gap to the nearest road user falls short of 2 m: 1 at a touch.
    pub near: f64,
    /// Of the first contact with a road user.
    pub contact: f64,
    /// Of the speed at which the two close on each other in that contact. [1 s/m]
    pub closing_speed: f64,
    /// Of every obstacle touched.
    pub obstacle: f64,
    /// Of the end of the route.
    pub arrived: f64,
    /// Of leaving the road.
    pub off_road: f64,
    /// Of standing for long with no reason.
    pub stuck: f64,
}

impl Default for Reward {
    /// Twenty seconds at the target speed weigh 10, half of what the slightest contact costs.
    fn default() -> Self {
        Self {
            progress: 0.05,
            braking: -0.01,
            red_light: -2.0,
            near: -0.2,
            contact: -20.0,
            closing_speed: -1.0,
            obstacle: -10.0,
            arrived: 5.0,
            off_road: -20.0,
            stuck: -10.0,
        }
    }
}

impl Reward {
    /// The weights, in the order of [`TERMS`].
    pub const fn weights(&self) -> [f64; TERMS.len()] {
        [
            self.progress,
            self.braking,
            self.red_light,
            self.near,
            self.contact,
            self.closing_speed,
            self.obstacle,
            self.arrived,
            self.off_road,
            self.stuck,
        ]
    }

    /// From weights in the order of [`TERMS`].
    pub const fn of_weights(weights: [f64; TERMS.len()]) -> Self {
        let [progress, braking, red_light, near, contact, closing_speed, obstacle, arrived, off_road, stuck] = weights;
        Self { progress, braking, red_light, near, contact, closing_speed, obstacle, arrived, off_road, stuck }
    }
}

/// The share by which the gap to the nearest road user falls short of [`NEAR_M`].
fn near(scene: &Scene, observation: &Observation<'_>) -> f64 {
    let own = thing(scene, observation, 0).outline;
    let reach_m = own.radius() + NEAR_M;
    let mut least_m = NEAR_M;
    others(scene, observation, |bound_m, number| {
        if bound_m < reach_m && usize::from(number) < scene.outlines.len() {
            least_m = least_m.min(own.gap(&thing(scene, observation, number).outline));
        }
    });
    1.0 - least_m / NEAR_M
}

/// What is remembered from step to step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Memory {
    route_s_m: f64,
    speed_mps: f64,
    touched: bool,
}

impl Memory {
    pub(crate) fn of(run: &Run) -> Self {
        let observation = run.observe();
        Self { route_s_m: observation.route_s_m, speed_mps: observation.states[0].speed(), touched: false }
    }

    /// The terms of the step that a run has just made, in the order of [`TERMS`].
    pub(crate) fn terms(&mut self, scene: &Scene, run: &Run) -> [f64; TERMS.len()] {
        let observation = run.observe();
        let speed_mps = observation.states[0].speed();
        let come_m = observation.route_s_m - self.route_s_m;
        let wanted_m = (scene.scenario.draft().ego.target_speed_mps * STEP_S).max(0.1);
        let deceleration_mps2 = (self.speed_mps.abs() - speed_mps.abs()) / STEP_S;
        let passed = |at_m: f64| self.route_s_m < at_m && at_m <= observation.route_s_m;
        // What was shown when the step began: who has passed just before red has not run it.
        let (control, before_s) =
            (&scene.scenario.draft().control, f64::from(observation.step.saturating_sub(1)) / 10.0);
        let reds = observation
            .lines
            .iter()
            .filter(|line| passed(line.at_m) && control[line.control].device.aspect(before_s) == Some(Aspect::Red));
        let mut terms = [0.0; TERMS.len()];
        terms[0] = (come_m / wanted_m).clamp(-1.0, 1.0);
        terms[2] = reds.count() as f64;
        for event in run.events() {
            match *event {
                Event { kind: EventKind::Contact { a, b, a_state, b_state }, .. } if a == 0 || b == 0 => {
                    if !self.touched {
                        terms[4] = 1.0;
                        terms[5] = (a_state.velocity() - b_state.velocity()).length();
                    }
                    self.touched = true;
                }
                Event { kind: EventKind::ObstacleContact { actor: 0, .. }, .. } => terms[6] += 1.0,
                _ => {}
            }
        }
        if !self.touched {
            terms[3] = near(scene, &observation);
            terms[1] = (deceleration_mps2 - COMFORTABLE_MPS2).max(0.0);
        }
        match run.termination().map(|termination| termination.kind) {
            Some(TerminationKind::Arrived) => terms[7] = 1.0,
            Some(TerminationKind::OffRoad) => terms[8] = 1.0,
            Some(TerminationKind::Stuck) => terms[9] = 1.0,
            _ => {}
        }
        (self.route_s_m, self.speed_mps) = (observation.route_s_m, speed_mps);
        terms
    }
}
