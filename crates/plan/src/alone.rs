//! What a plan does with nobody else on the road.

use crate::follow::gap_law;
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
        Self::after(plan, way, start_m, vec![start_mps], duration_s)
    }

    /// The speeds of a rollout, step by step, continued alone from where they end.
    ///
    /// # Panics
    /// Without a speed.
    pub fn after(plan: &Plan, way: &Way, start_m: f64, speeds_mps: Vec<f64>, duration_s: f64) -> Self {
        assert!(!speeds_mps.is_empty(), "it starts with a speed");
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
        let (wanted_t_m, _) = way.line(plan, f64::from(step) * STEP_S);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::way::{Bend, Blocked};
    use recrash_model::kinds::PartnerKind;
    use recrash_model::scenario::Policy;
    use recrash_model::surroundings::Surface;

    fn car(policy: &Policy, way: &Way, start_mps: f64, duration_s: f64) -> Alone {
        Alone::new(&Plan::new(PartnerKind::PassengerCar, policy, 0.0, Surface::Dry), way, 0.0, start_mps, duration_s)
    }

    fn holds(target_speed: f64) -> Policy {
        Policy::SuddenBrake { target_speed, brake_step: 0, brake_steps: 0, speed_kp: None }
    }

    fn hardest(alone: &Alone) -> f64 {
        alone.speeds().windows(2).map(|pair| (pair[0] - pair[1]) / STEP_S).fold(0.0, f64::max)
    }

    #[test]
    fn full_brake_from_ten_metres_per_second_takes_two_thirds_of_a_second() {
        let policy = Policy::SuddenBrake { target_speed: 10.0, brake_step: 0, brake_steps: 20, speed_kp: None };
        let alone = car(&policy, &Way::default(), 10.0, 2.0);
        // 10 / 15.13 = 0.66 s: moving after 0.6 s, standing after 0.7 s.
        assert!((alone.speed(0.6) - (10.0 - 0.6 * 15.13)).abs() < 1e-9);
        assert!(alone.speed(0.7) < 1e-9);
        assert_eq!(alone.speed(2.0), 0.0);
    }

    #[test]
    fn who_was_faster_than_its_cruise_speed_comes_down_comfortably() {
        let policy = Policy::AccelThenBrake {
            accel_mag: 1.0,
            accel_steps: 40,
            cruise_speed: 6.0,
            brake_step: 0,
            brake_steps: 0,
            speed_kp: None,
        };
        let alone = car(&policy, &Way::default(), 1.0, 20.0);
        // Four seconds of 2.909 m/s^2, then 2 m/s^2 at most.
        assert!((alone.speed(4.0) - (1.0 + 4.0 * 2.909)).abs() < 0.01);
        assert!(hardest(&alone) <= 2.0 + 1e-9, "{}", hardest(&alone));
        assert!((alone.speed(20.0) - 6.0).abs() < 0.01);
    }

    #[test]
    fn a_bend_is_reached_at_its_speed_with_comfortable_braking() {
        let bends = vec![Bend { from_m: 60.0, to_m: 80.0, speed_mps: 5.0 }];
        let alone = car(&holds(12.0), &Way { bends, ..Way::default() }, 12.0, 30.0);
        let there = (0..300).map(|step| f64::from(step) * STEP_S).find(|&time| alone.driven(time) >= 60.0);
        let there = there.expect("it gets there");
        assert!((alone.speed(there) - 5.0).abs() < 0.3, "{}", alone.speed(there));
        assert!(hardest(&alone) < 2.3, "{}", hardest(&alone));
        // And it goes on as before.
        assert!((alone.speed(30.0) - 12.0).abs() < 0.1);
    }

    #[test]
    fn who_meets_a_barrier_on_its_line_stops_before_it_and_who_meets_one_beside_it_drives_on() {
        let barrier = |left_m: f64| Way {
            blocked: vec![Blocked { from_m: 80.0, left_m, right_m: left_m + 2.0 }],
            ..Way::default()
        };
        let stops = car(&holds(10.0), &barrier(0.5), 10.0, 30.0);
        // Its front stays 0.5 m before: 80 - 2.2575 - 0.5.
        assert!((77.0..77.3).contains(&stops.driven(30.0)), "{}", stops.driven(30.0));
        assert!(hardest(&stops) < 3.5, "{}", hardest(&stops));
        assert!(car(&holds(10.0), &barrier(1.0), 10.0, 30.0).driven(30.0) > 299.0);
    }
}
