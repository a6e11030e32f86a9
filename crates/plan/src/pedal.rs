//! What plans ask of the pedals.

use crate::constants::{
    CATCH_UP_S, COMMITTED_M, HOLD_BELOW_MPS, HOLD_BRAKE, LEAST_THROTTLE, STANDING_MPS, STOP_SHORT_M,
};
use crate::speed::{Moment, Plan, SpeedPlan};
use crate::way::Way;

impl Plan {
    /// Throttle and brake at a moment. [-1 to 1]
    pub fn pedal(&self, way: &Way, now: &Moment) -> f64 {
        let v = now.speed_mps;
        if self.waits(now.step) {
            return hold_still(v);
        }
        let wanted = match self.speed {
            SpeedPlan::Timed { brake_from, brake_until, .. } if (brake_from..brake_until).contains(&now.step) => {
                return hold_still(v);
            }
            SpeedPlan::Timed { throttle, throttle_until, .. } if now.step < throttle_until => self.meaning(throttle),
            SpeedPlan::Follow { .. } => self.meaning(now.gap_law),
            SpeedPlan::Timed { speed_mps, .. }
            | SpeedPlan::Wait { speed_mps, .. }
            | SpeedPlan::GiveWay { speed_mps, .. } => {
                if speed_mps < STANDING_MPS && v < HOLD_BELOW_MPS {
                    return HOLD_BRAKE;
                }
                (self.gain_per_s * (speed_mps - v)).max(-self.comfortable_mps2)
            }
        };
        let stop_m = [now.give_way_m, way.blocked_ahead(self, now)].into_iter().flatten().fold(f64::INFINITY, f64::min);
        let left_m = (stop_m - STOP_SHORT_M).max(0.0);
        let stops = stop_m >= -COMMITTED_M && stop_m.is_finite();
        let at_line_mps = (2.0 * self.stopping_mps2 * left_m).sqrt();
        if stops && at_line_mps < STANDING_MPS && v < HOLD_BELOW_MPS {
            return HOLD_BRAKE;
        }
        let mut acceleration = wanted;
        if stops {
            acceleration = acceleration.min(come_down(v, 0.0, left_m, self.stopping_mps2));
        }
        for bend in way.bends.iter().filter(|bend| bend.to_m > now.s_m) {
            let distance_m = (bend.from_m - now.s_m).max(0.0);
            acceleration = acceleration.min(come_down(v, bend.speed_mps, distance_m, self.comfortable_mps2));
        }
        // What a throttle or the gap law asks for is as hard as it is.
        let hardest = (-self.greatest_braking_mps2).min(wanted);
        let acceleration = acceleration.clamp(hardest, self.full_throttle_mps2.max(0.0));
        if acceleration < 0.0 {
            acceleration / self.full_brake_mps2
        } else {
            (acceleration / self.full_throttle_mps2.max(1e-3)).max(LEAST_THROTTLE)
        }
    }

    /// The acceleration that a pedal asks for. [m/s^2]
    fn meaning(&self, pedal: f64) -> f64 {
        let pedal = pedal.clamp(-1.0, 1.0);
        pedal * if pedal < 0.0 { self.full_brake_mps2 } else { self.full_throttle_mps2 }
    }

    /// The acceleration that a pedal gives at a speed, without the tyres' lag. [m/s^2]
    pub fn acceleration(&self, pedal: f64, speed_mps: f64) -> f64 {
        let most = if speed_mps > self.fastest_mps { 0.0 } else { self.full_throttle_mps2 };
        self.meaning(pedal).clamp(-self.hardest_mps2, most)
    }
}

/// The acceleration that leads down to a speed at a place, along the parabola that ends there: its slope, and what makes
/// up for a speed beside it. [m/s^2]
fn come_down(speed_mps: f64, target_mps: f64, distance_m: f64, deceleration_mps2: f64) -> f64 {
    let on_parabola = (target_mps * target_mps + 2.0 * deceleration_mps2 * distance_m).sqrt();
    let slope = if distance_m > 0.0 { deceleration_mps2 * speed_mps / on_parabola } else { 0.0 };
    (on_parabola - speed_mps) / CATCH_UP_S - slope
}

/// Brakes to a stand and holds it: fully while it moves, lightly then. [-1 to 1]
pub fn hold_still(speed_mps: f64) -> f64 {
    if speed_mps > HOLD_BELOW_MPS { -1.0 } else { HOLD_BRAKE }
}
