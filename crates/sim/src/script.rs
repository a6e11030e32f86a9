//! Scripted partners: the policies of `docs/models/policies.md`, with sideways moves.

use crate::chassis::Controls;
use crate::give_way::{Crossing, GiveWay, Manners};
use crate::metadrive_idm;
use crate::scene::Scene;
use crate::steering::LaneKeeper;
use recrash_model::math;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{DEFAULT_SPEED_KP, LateralMove, Partner, Policy};
use recrash_model::vehicle::VehicleSpec;

/// The wanted line may run at no more than this angle to the lane, for vehicles and for who walks. [rad]
const GREATEST_DRIFT: f64 = 0.5;
const GREATEST_DRIFT_ON_FOOT: f64 = 1.3;

/// A speed low enough to divide a sideways rate by. [m/s]
const SLOW_MPS: f64 = 1.0;

/// The state of a scripted partner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Script {
    plan: Plan,
    keeper: LaneKeeper,
    /// Where it started to the right of its lane. [m]
    start_t_m: f64,
    greatest_drift: f64,
    /// Its sideways moves: a range of the world's list.
    pub(crate) moves: (u32, u32),
    give_way: GiveWay,
}

/// What it does along its lane.
#[derive(Debug, Clone, Copy)]
enum Plan {
    /// Throttle for some steps, then a speed; full brake in a window of steps.
    Timed { throttle: f64, throttle_until: u32, speed_mps: f64, brake_from: u32, brake_until: u32, gain: f64 },
    /// MetaDrive's gap law.
    Follow { speed_mps: f64 },
    /// Stands until a step, then a speed.
    Wait { until: u32, speed_mps: f64 },
    /// A speed, but gives way.
    GiveWay { speed_mps: f64, manners: Manners },
}

impl Script {
    pub(crate) fn new(partner: &Partner, start_t_m: f64, moves: (u32, u32)) -> Self {
        let gain = |kp: Option<f64>| kp.unwrap_or(DEFAULT_SPEED_KP);
        let plan = match partner.policy {
            Policy::SuddenBrake { target_speed, brake_step, brake_steps, speed_kp } => Plan::Timed {
                throttle: 0.0,
                throttle_until: 0,
                speed_mps: target_speed,
                brake_from: brake_step,
                brake_until: brake_step.saturating_add(brake_steps),
                gain: gain(speed_kp),
            },
            Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, brake_step, brake_steps, speed_kp } => {
                Plan::Timed {
                    throttle: accel_mag,
                    throttle_until: accel_steps,
                    speed_mps: cruise_speed,
                    brake_from: brake_step,
                    brake_until: brake_step.saturating_add(brake_steps),
                    gain: gain(speed_kp),
                }
            }
            Policy::IdmNominal { target_speed_mps } => Plan::Follow { speed_mps: target_speed_mps },
            Policy::Stopped { depart_step, target_speed_mps } => {
                Plan::Wait { until: depart_step.unwrap_or(u32::MAX), speed_mps: target_speed_mps }
            }
            Policy::Yielding { target_speed_mps, gap_s } => {
                Plan::GiveWay { speed_mps: target_speed_mps, manners: Manners { gap_s } }
            }
        };
        let greatest_drift = if VehicleSpec::is_nimble(partner.kind) { GREATEST_DRIFT_ON_FOOT } else { GREATEST_DRIFT };
        Self { plan, keeper: LaneKeeper::new(), start_t_m, greatest_drift, moves, give_way: GiveWay::default() }
    }

    /// Whether something in its plan will still change its speed after this step.
    pub(crate) fn has_plans(&self, step: u32) -> bool {
        match self.plan {
            Plan::Timed { speed_mps, throttle_until, brake_until, .. } => {
                speed_mps > 0.0 || step < throttle_until || step < brake_until
            }
            Plan::Follow { .. } | Plan::GiveWay { .. } => false,
            Plan::Wait { until, speed_mps } => speed_mps > 0.0 && until != u32::MAX && step <= until,
        }
    }

    /// Decides. A `halted` partner (one that has touched another) brakes to a stand.
    pub(crate) fn decide(
        &mut self,
        scene: &Scene<'_>,
        me: usize,
        moves: &[LateralMove],
        crossings: &[Crossing],
        halted: bool,
    ) -> Controls {
        let seen = &scene.actors[me];
        let moves = &moves[self.moves.0 as usize..self.moves.1 as usize];
        let (t_m, rate_mps) = lateral_target(self.start_t_m, moves, f64::from(scene.step) * STEP_S);
        let drift = drift(rate_mps, seen.speed, self.greatest_drift);
        let lane = scene.path_lane(me);
        if let Plan::Wait { until, .. } = self.plan
            && scene.step < until
        {
            // Whoever waits holds the wheels straight; the controllers begin when it sets off.
            return Controls { steer: 0.0, throttle: stand(seen.speed) };
        }
        let throttle = if halted { stand(seen.speed) } else { self.throttle(scene, me, crossings) };
        Controls { steer: self.keeper.steer(scene.lanes.lane(lane), seen.pose, t_m, drift), throttle }.clipped()
    }

    fn throttle(&mut self, scene: &Scene<'_>, me: usize, crossings: &[Crossing]) -> f64 {
        let seen = &scene.actors[me];
        // MetaDrive knows speeds in single precision. Whether somebody who starts at the speed he wants coasts at first
        // (throttle 0) or rolls freely (a throttle of 1e-8) hangs on that last bit.
        let speed = f64::from(seen.speed as f32);
        let hold = |speed_mps: f64, gain: f64| gain * (speed_mps - speed);
        match self.plan {
            Plan::Timed { throttle, throttle_until, speed_mps, brake_from, brake_until, gain } => {
                if (brake_from..brake_until).contains(&scene.step) {
                    stand(seen.speed)
                } else if scene.step < throttle_until {
                    throttle
                } else {
                    hold(speed_mps, gain)
                }
            }
            Plan::Follow { speed_mps } => {
                let lead = metadrive_idm::lead_on(scene, me, seen.place.lane);
                metadrive_idm::throttle(seen.speed, speed_mps, seen.forward, seen.velocity, lead)
            }
            Plan::Wait { speed_mps, .. } => hold(speed_mps, DEFAULT_SPEED_KP),
            Plan::GiveWay { speed_mps, manners } => {
                let speed_mps = match self.give_way.stop_line(scene, me, crossings, speed_mps, manners) {
                    // Slows along the parabola that ends at the line.
                    Some(distance_m) => speed_mps.min((2.0 * GIVE_WAY_MPS2 * (distance_m - 0.5).max(0.0)).sqrt()),
                    None => speed_mps,
                };
                if speed_mps < 0.3 { stand(seen.speed) } else { hold(speed_mps, DEFAULT_SPEED_KP) }
            }
        }
    }
}

/// Brakes to a stand and holds it: fully while it moves, lightly then (MetaDrive's vehicles creep backwards under a full
/// brake).
pub(crate) fn stand(speed_mps: f64) -> f64 {
    if speed_mps > 0.5 { -1.0 } else { -0.1 }
}

/// Deceleration with which a partner stops to give way; assumed, a firm stop. [m/s^2]
const GIVE_WAY_MPS2: f64 = 3.0;

/// The angle to the lane, positive to the left, at which a partner at this speed moves sideways at this rate. [rad]
fn drift(rate_mps: f64, speed_mps: f64, greatest: f64) -> f64 {
    math::asin((-rate_mps / speed_mps.max(SLOW_MPS)).clamp(-1.0, 1.0)).clamp(-greatest, greatest)
}

/// Where a partner wants to be beside its lane, and how fast that moves, positive to the right. [m, m/s]
///
/// Each move goes from wherever the target is to its own, linearly; a move that begins before the last one has ended
/// takes over from there.
fn lateral_target(start_t_m: f64, moves: &[LateralMove], time_s: f64) -> (f64, f64) {
    let mut from = start_t_m;
    for (position, step) in moves.iter().enumerate() {
        if time_s < step.start_s {
            return (from, 0.0);
        }
        let rate = (step.to_t_m - from) / step.duration_s.max(1e-3);
        let next_start = moves.get(position + 1).map_or(f64::INFINITY, |next| next.start_s);
        let until = next_start.min(step.start_s + step.duration_s);
        if time_s < until {
            return (from + rate * (time_s - step.start_s), rate);
        }
        from += rate * (until - step.start_s).max(0.0);
    }
    (from, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lateral_moves_are_linear_and_hold_what_they_reached() {
        let moves = [
            LateralMove { start_s: 1.0, duration_s: 2.0, to_t_m: 3.0 },
            LateralMove { start_s: 5.0, duration_s: 1.0, to_t_m: 0.0 },
        ];
        assert_eq!(lateral_target(1.0, &moves, 0.5), (1.0, 0.0));
        assert_eq!(lateral_target(1.0, &moves, 2.0), (2.0, 1.0));
        assert_eq!(lateral_target(1.0, &moves, 4.0), (3.0, 0.0));
        assert_eq!(lateral_target(1.0, &moves, 5.5), (1.5, -3.0));
        assert_eq!(lateral_target(1.0, &moves, 9.0), (0.0, 0.0));
    }

    #[test]
    fn a_move_that_begins_early_takes_over_from_where_the_last_one_is() {
        let moves = [
            LateralMove { start_s: 0.0, duration_s: 4.0, to_t_m: 4.0 },
            LateralMove { start_s: 2.0, duration_s: 1.0, to_t_m: 0.0 },
        ];
        assert_eq!(lateral_target(0.0, &moves, 2.5), (1.0, -2.0));
    }
}
