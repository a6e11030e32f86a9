//! Measures of the ego behind another: time headway, deceleration rate to avoid a crash, required deceleration.
//!
//! Models, formulas and sources: `docs/models/following.md`.

use crate::scene::Along;

/// Slower than this, time headway means nothing. [m/s] (assumed)
const LEAST_SPEED_MPS: f64 = 1.0;

/// What lies farther ahead is not followed. [m] (assumed; about 5 s at 22 m/s)
const FARTHEST_M: f64 = 110.0;

/// The ego behind a leader in its corridor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Following {
    /// How far the ego goes along its way until its box touches the leader's. [m]
    pub gap_m: f64,
    /// Speed of the ego along its way. [m/s]
    pub speed_mps: f64,
    /// Speed of the leader along the ego's way. [m/s]
    pub leader_speed_mps: f64,
    /// Acceleration of the leader; negative when it brakes. [m/s^2]
    pub leader_acceleration_mps2: f64,
}

impl Following {
    /// Whether `other` leads the ego: ahead of it, across at least partly in front of it, and going its way. Speeds are
    /// those along the ego's way, where each of them is.
    pub fn find(
        ego: &Along,
        speed_mps: f64,
        other: &Along,
        leader_speed_mps: f64,
        leader_acceleration_mps2: f64,
    ) -> Option<Self> {
        if !other.goes_along() {
            return None;
        }
        let gap_m = ego.way_to_contact(other).filter(|&gap| gap <= FARTHEST_M)?;
        Some(Self { gap_m, speed_mps, leader_speed_mps, leader_acceleration_mps2 })
    }

    /// Time headway: `gap / v`. `None` below 1 m/s. [s]
    pub fn headway_s(&self) -> Option<f64> {
        (self.speed_mps >= LEAST_SPEED_MPS).then(|| self.gap_m / self.speed_mps)
    }

    /// Deceleration rate to avoid a crash: `(v - v_l)^2 / (2 gap)` while closing. [m/s^2]
    pub fn drac_mps2(&self) -> Option<f64> {
        let closing = self.speed_mps - self.leader_speed_mps;
        (closing > 0.0).then(|| closing * closing / (2.0 * self.gap_m))
    }

    /// Least constant deceleration with which the ego stays behind a leader that keeps its acceleration until it stands;
    /// 0 where none is needed. [m/s^2]
    pub fn required_deceleration_mps2(&self) -> f64 {
        let (v, leader, gap) = (self.speed_mps, self.leader_speed_mps.max(0.0), self.gap_m);
        let closing = v - leader;
        let braking = -self.leader_acceleration_mps2;
        if braking <= 0.0 {
            return if closing > 0.0 { (closing * closing / (2.0 * gap) - braking.abs()).max(0.0) } else { 0.0 };
        }
        let meets_while_leader_moves = closing > 0.0 && 2.0 * gap / closing <= leader / braking;
        if meets_while_leader_moves {
            braking + closing * closing / (2.0 * gap)
        } else {
            v * v / (2.0 * (gap + leader * leader / (2.0 * braking)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn behind(gap_m: f64, speed_mps: f64, leader_speed_mps: f64, leader_acceleration_mps2: f64) -> Following {
        Following { gap_m, speed_mps, leader_speed_mps, leader_acceleration_mps2 }
    }

    #[test]
    fn headway_is_gap_over_speed() {
        assert_eq!(behind(30.0, 20.0, 20.0, 0.0).headway_s(), Some(1.5));
        assert_eq!(behind(30.0, 0.9, 0.0, 0.0).headway_s(), None);
    }

    #[test]
    fn drac_at_10_mps_closing_and_25_m_is_2_mps2() {
        assert_eq!(behind(25.0, 20.0, 10.0, 0.0).drac_mps2(), Some(2.0));
        assert_eq!(behind(25.0, 10.0, 10.0, 0.0).drac_mps2(), None);
    }

    #[test]
    fn required_deceleration_behind_a_leader_at_constant_speed_is_the_drac() {
        assert_eq!(behind(25.0, 20.0, 10.0, 0.0).required_deceleration_mps2(), 2.0);
        assert_eq!(behind(25.0, 10.0, 15.0, 0.0).required_deceleration_mps2(), 0.0);
    }

    #[test]
    fn a_leader_that_accelerates_leaves_less_to_do() {
        assert_eq!(behind(25.0, 20.0, 10.0, 0.5).required_deceleration_mps2(), 1.5);
        assert_eq!(behind(25.0, 20.0, 10.0, 3.0).required_deceleration_mps2(), 0.0);
    }

    #[test]
    fn behind_a_leader_that_brakes_to_a_stop_the_stopping_distance_counts() {
        // Equal speeds 10 m/s, 5 m apart; the leader brakes with 5 m/s^2 and stands after 10 m: 15 m to stop in.
        let required = behind(5.0, 10.0, 10.0, -5.0).required_deceleration_mps2();
        assert!((required - 100.0 / 30.0).abs() < 1e-12, "{required}");
    }

    #[test]
    fn the_required_deceleration_just_avoids_the_contact() {
        for case in [
            behind(5.0, 10.0, 10.0, -5.0),
            behind(8.0, 20.0, 12.0, -1.0),
            behind(40.0, 20.0, 12.0, -3.0),
            behind(30.0, 15.0, 0.0, 0.0),
            behind(12.0, 9.0, 14.0, -6.0),
            behind(25.0, 20.0, 10.0, 0.5),
        ] {
            let required = case.required_deceleration_mps2();
            assert!(least_gap(case, required * 1.001) > 0.0, "{case:?} {required}");
            assert!(least_gap(case, required * 0.98) < 0.0, "{case:?} {required}");
        }
    }

    /// Drives both in steps of 1 ms to a standstill of the ego.
    fn least_gap(case: Following, deceleration: f64) -> f64 {
        let (mut gap, mut v, mut leader) = (case.gap_m, case.speed_mps, case.leader_speed_mps);
        let step = 1e-3;
        let mut least = gap;
        for _ in 0..200_000 {
            let (v_next, leader_next) =
                ((v - deceleration * step).max(0.0), (leader + case.leader_acceleration_mps2 * step).max(0.0));
            gap += 0.5 * (leader + leader_next - v - v_next) * step;
            (v, leader) = (v_next, leader_next);
            least = least.min(gap);
        }
        least
    }
}
