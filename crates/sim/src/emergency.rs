//! How a competent and careful human driver reacts to a danger, after UN Regulation No. 157 (unr157).
//!
//! Nothing happens while the danger is perceived and judged, and while the foot goes to the brake; then the deceleration
//! grows linearly to its greatest value. Equations and fields: `docs/models/reference.md`.

use recrash_model::math;

/// Timing and strength of the reaction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmergencyResponse {
    /// From the danger until it is understood (risk evaluation time). [s]
    pub evaluation_s: f64,
    /// From there until braking begins. [s]
    pub delay_s: f64,
    /// From there until braking is full. [s]
    pub ramp_s: f64,
    /// Full braking. [m/s^2, positive]
    pub deceleration_mps2: f64,
}

impl EmergencyResponse {
    /// The figures of UN R157, Annex 4, Appendix 3, table 1: 0.4 s, 0.75 s, and 0.6 s to 0.774 g on a dry road.
    pub const UN_R157: Self = Self { evaluation_s: 0.4, delay_s: 0.75, ramp_s: 0.6, deceleration_mps2: 0.774 * 9.81 };

    /// The same driver where tyres hold this share of what they hold on a dry road.
    #[must_use]
    pub fn on(self, friction: f64) -> Self {
        Self { deceleration_mps2: self.deceleration_mps2 * friction, ..self }
    }

    /// From the danger until braking begins. [s]
    pub fn onset_s(&self) -> f64 {
        self.evaluation_s + self.delay_s
    }

    /// Deceleration at a time after the danger. [m/s^2]
    pub fn deceleration(&self, since_s: f64) -> f64 {
        self.deceleration_mps2 * ((since_s - self.onset_s()) / self.ramp_s).clamp(0.0, 1.0)
    }

    /// What is driven from the danger until a speed is gone; of a closing speed, the gap that is used up. [m]
    ///
    /// `v T + v r - a r^2 / 6 + (v - a r / 2)^2 / (2 a)` with onset T, ramp r and deceleration a; where the speed is gone
    /// during the ramp, after `x = sqrt(2 v r / a)`, `v T + v x - a x^3 / (6 r)`.
    pub fn braking_distance(&self, speed_mps: f64) -> f64 {
        let (v, r, a) = (speed_mps, self.ramp_s, self.deceleration_mps2);
        let before = v * self.onset_s();
        if v <= 0.5 * a * r {
            let x = (2.0 * v * r / a).sqrt();
            before + v * x - a * x * x * x / (6.0 * r)
        } else {
            before + v * r - a * r * r / 6.0 + math::sq(v - 0.5 * a * r) / (2.0 * a)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIVER: EmergencyResponse = EmergencyResponse::UN_R157;

    #[test]
    fn nothing_happens_for_1_15_s_and_braking_is_full_after_1_75_s() {
        assert_eq!(DRIVER.deceleration(0.0), 0.0);
        assert_eq!(DRIVER.deceleration(1.149), 0.0);
        assert!((DRIVER.deceleration(1.45) - 0.5 * 0.774 * 9.81).abs() < 1e-12);
        assert!((DRIVER.deceleration(1.76) - 7.592_94).abs() < 1e-9);
        assert_eq!(DRIVER.on(0.3).deceleration(9.0), 0.3 * DRIVER.deceleration(9.0));
    }

    #[test]
    fn from_sixty_kilometres_an_hour_it_stops_within_42_metres() {
        // 16.667 * 1.15 = 19.167; 16.667 * 0.6 - 7.593 * 0.06 = 9.544; (16.667 - 2.278)^2 / 15.186 = 13.634.
        assert!(
            (DRIVER.braking_distance(60.0 / 3.6) - 42.345).abs() < 0.005,
            "{}",
            DRIVER.braking_distance(60.0 / 3.6)
        );
        assert_eq!(DRIVER.braking_distance(0.0), 0.0);
    }

    #[test]
    fn the_distance_is_what_the_deceleration_integrates_to() {
        for speed in [0.5, 2.0, 2.277, 2.279, 8.0, 22.0] {
            let (mut v, mut s, dt) = (speed, 0.0, 1e-5);
            let mut step = 0.0;
            while v > 0.0 {
                s += v * dt;
                v -= DRIVER.deceleration(step * dt) * dt;
                step += 1.0;
            }
            assert!((s - DRIVER.braking_distance(speed)).abs() < 2e-3, "{speed}: {s}");
        }
    }
}
