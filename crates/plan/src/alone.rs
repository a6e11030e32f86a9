//! What a plan does with nobody else on the road.

use crate::follow::gap_law;
use crate::line::lateral_target;
use crate::speed::{Moment, Plan, SpeedPlan};
use crate::way::Way;
use recrash_model::geometry::Vec2;
use recrash_model::rollout::STEP_S;

/// Speeds and distances at every step of 0.1 s: the plan alone, on tyres that hold, without lag.
#[derive(Debug, Clone, PartialEq)]
pub struct Alone {
    speeds_mps: Vec<f64>,
    driven_m: Vec<f64>,
}

impl Alone {
    /// From a start along the way and a speed on.
    pub fn new(plan: &Plan, way: &Way, start_m: f64, start_mps: f64, duration_s: f64) -> Self {
        let mut alone = Self { speeds_mps: vec![start_mps], driven_m: vec![0.0] };
        let steps = (duration_s / STEP_S).ceil().clamp(0.0, 1e5) as u32;
        for step in 0..steps {
            alone.go_on(plan, way, start_m, step);
        }
        alone
    }

    /// The speeds of a rollout, continued alone from where they end.
    pub fn after(plan: &Plan, way: &Way, start_m: f64, speeds_mps: Vec<f64>, duration_s: f64) -> Self {
        let mut driven_m = vec![0.0];
        for pair in speeds_mps.windows(2) {
            driven_m.push(driven_m[driven_m.len() - 1] + 0.5 * (pair[0] + pair[1]) * STEP_S);
        }
        let known = speeds_mps.len() as u32;
        let mut alone = Self { speeds_mps, driven_m };
        for step in known..=(duration_s / STEP_S).ceil().clamp(0.0, 1e5) as u32 {
            alone.go_on(plan, way, start_m, step - 1);
        }
        alone
    }

    fn go_on(&mut self, plan: &Plan, way: &Way, start_m: f64, step: u32) {
        let last = self.speeds_mps.len() - 1;
        let (speed_mps, driven_m) = (self.speeds_mps[last], self.driven_m[last]);
        let (wanted_t_m, _) = lateral_target(plan.start_t_m, &way.moves, f64::from(step) * STEP_S);
        let ahead = Vec2::new(1.0, 0.0);
        let gap_law = match plan.speed {
            SpeedPlan::Follow { speed_mps: wanted } => gap_law(speed_mps, wanted, ahead, ahead * speed_mps, None),
            _ => 0.0,
        };
        let pedal = plan.pedal(
            way,
            &Moment {
                step,
                speed_mps,
                s_m: start_m + driven_m,
                t_m: wanted_t_m,
                wanted_t_m,
                give_way_m: None,
                gap_law,
            },
        );
        let after_mps = (speed_mps + plan.acceleration(pedal, speed_mps) * STEP_S).max(0.0);
        self.speeds_mps.push(after_mps);
        self.driven_m.push(driven_m + 0.5 * (speed_mps + after_mps) * STEP_S);
    }

    /// Speed at every step. [m/s]
    pub fn speeds(&self) -> &[f64] {
        &self.speeds_mps
    }

    /// Speed after a time. [m/s]
    pub fn speed(&self, time_s: f64) -> f64 {
        at(&self.speeds_mps, time_s)
    }

    /// Distance driven after a time; behind its end at the last speed. [m]
    pub fn driven(&self, time_s: f64) -> f64 {
        let end_s = (self.driven_m.len() - 1) as f64 * STEP_S;
        at(&self.driven_m, time_s) + (time_s - end_s).max(0.0) * self.speeds_mps[self.speeds_mps.len() - 1]
    }
}

fn at(values: &[f64], time_s: f64) -> f64 {
    let position = (time_s / STEP_S).max(0.0);
    let before = position.floor() as usize;
    let last = values.len() - 1;
    let (a, b) = (values[before.min(last)], values[(before + 1).min(last)]);
    a + (b - a) * (position - position.floor())
}
