//! Where a partner wants to be beside its lane.

use crate::constants::{SHORTEST_MOVE_S, SLOW_MPS};
use recrash_model::math;
use recrash_model::scenario::LateralMove;

/// Where a partner wants to be beside its lane, and how fast that moves, positive to the right. [m, m/s]
///
/// Each move goes from wherever the target is to its own, linearly; a move that begins before the last one has ended
/// takes over from there.
pub fn lateral_target(start_t_m: f64, moves: &[LateralMove], time_s: f64) -> (f64, f64) {
    let mut from = start_t_m;
    for (position, step) in moves.iter().enumerate() {
        if time_s < step.start_s {
            return (from, 0.0);
        }
        let rate = (step.to_t_m - from) / step.duration_s.max(SHORTEST_MOVE_S);
        let next_start = moves.get(position + 1).map_or(f64::INFINITY, |next| next.start_s);
        let until = next_start.min(step.start_s + step.duration_s);
        if time_s < until {
            return (from + rate * (time_s - step.start_s), rate);
        }
        from += rate * (until - step.start_s).max(0.0);
    }
    (from, 0.0)
}

/// The angle to the lane, positive to the left, at which somebody at this speed moves sideways at this rate. [rad]
pub fn drift(rate_mps: f64, speed_mps: f64, greatest_rad: f64) -> f64 {
    if rate_mps == 0.0 {
        return -rate_mps;
    }
    math::asin((-rate_mps / speed_mps.max(SLOW_MPS)).clamp(-1.0, 1.0)).clamp(-greatest_rad, greatest_rad)
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

    #[test]
    fn one_metre_a_second_to_the_right_at_two_is_thirty_degrees_to_the_right() {
        assert!((drift(1.0, 2.0, 1.3) + std::f64::consts::FRAC_PI_6).abs() < 1e-12);
        assert_eq!(drift(-5.0, 5.0, 0.5), 0.5);
    }
}
