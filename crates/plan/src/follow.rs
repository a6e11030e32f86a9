//! The gap law of MetaDrive's `IDMPolicy`, which `idm_nominal` partners, background traffic and the ego `metadrive-idm`
//! share. Its quirks are MetaDrive's own: `docs/models/metadrive-idm.md`.

use crate::constants::{ACCELERATION, DECELERATION, STANDSTILL_DISTANCE_M, TIME_HEADWAY_S};
use recrash_model::geometry::Vec2;
use recrash_model::math;

/// Metres per second to kilometres per hour.
const KMH_PER_MPS: f64 = 3.6;

/// What it asks for at exactly the speed it wants. MetaDrive's speed is the length of a velocity in single precision, which
/// is never exactly the wanted one: a throttle of 0 would let the vehicle coast, and this hair of a brake lets it roll.
const HAIR: f64 = -1e-15;

/// Somebody or something in front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lead {
    /// From centre to centre along the lane. [m]
    pub distance_m: f64,
    /// Its velocity. [m/s]
    pub velocity: Vec2,
    /// Its speed. [m/s]
    pub speed_mps: f64,
}

/// The throttle MetaDrive's IDM asks for; braking below 0, not clipped.
///
/// `1 - (v / v0)^10 - (d* / d)^2` with `d* = 10 + 1.5 v + v dv / (2 sqrt 5)`, where the speeds are in **km/h** and the
/// distances in metres. A negative `d*` (a lead that pulls away fast) is squared all the same, and brakes.
#[inline]
pub fn gap_law(speed_mps: f64, target_mps: f64, forward: Vec2, velocity: Vec2, lead: Option<Lead>) -> f64 {
    let ratio = speed_mps / if target_mps.abs() > 1e-2 { target_mps } else { 1e-2 };
    let free = ACCELERATION * (1.0 - tenth_power(ratio));
    let free = if free == 0.0 { HAIR } else { free };
    let Some(lead) = lead else { return free };
    let speed_kmh = speed_mps * KMH_PER_MPS;
    let closing_kmh = (velocity - lead.velocity).dot(forward) * KMH_PER_MPS;
    let comfort = 2.0 * (ACCELERATION * DECELERATION).sqrt();
    let wanted = STANDSTILL_DISTANCE_M + TIME_HEADWAY_S * speed_kmh + speed_kmh * closing_kmh / comfort;
    free - ACCELERATION * math::sq(wanted / lead.distance_m.max(1e-2))
}

/// `x^10` by multiplication.
#[inline]
fn tenth_power(x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    x4 * x4 * x2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 30 km/h in m/s.
    const THIRTY: f64 = 30.0 / 3.6;

    fn behind(distance_m: f64, lead_mps: f64) -> f64 {
        let lead = Lead { distance_m, velocity: Vec2::new(lead_mps, 0.0), speed_mps: lead_mps };
        gap_law(THIRTY, THIRTY, Vec2::new(1.0, 0.0), Vec2::new(THIRTY, 0.0), Some(lead))
    }

    #[test]
    fn a_free_road_is_driven_at_the_target_speed() {
        let alone = |speed| gap_law(speed, THIRTY, Vec2::new(1.0, 0.0), Vec2::new(speed, 0.0), None);
        assert_eq!(alone(0.0), 1.0);
        assert!(alone(THIRTY).abs() < 1e-12);
        assert!((alone(0.5 * THIRTY) - (1.0 - 1.0 / 1024.0)).abs() < 1e-12);
    }

    #[test]
    fn at_thirty_it_wants_fifty_five_metres_behind_an_equal() {
        // d* = 10 + 1.5 * 30; at that distance the interaction is -1.
        assert!((behind(55.0, THIRTY) + 1.0).abs() < 1e-12);
        assert!((behind(27.5, THIRTY) + 4.0).abs() < 1e-12);
    }

    #[test]
    fn at_thirty_it_wants_two_hundred_and_fifty_six_metres_behind_who_stands() {
        // d* = 55 + 30 * 30 / (2 sqrt 5) = 256.2; seen at 29.5 m that is the -76 once measured.
        assert!((behind(256.246_117_974_981_1, 0.0) + 1.0).abs() < 1e-9);
        assert!((behind(29.5, 0.0) + 75.5).abs() < 0.1);
    }

    #[test]
    fn a_lead_that_pulls_away_fast_is_braked_for() {
        // 55 + 30 * (30 - 60) / (2 sqrt 5) = -146: negative, and squared.
        assert!(behind(20.0, 2.0 * THIRTY) < -50.0);
    }
}
