//! The careful and competent human driver of UN R157 (unr157, Annex 4, Appendix 3).

use crate::sight::{Body, Sees};

/// Deceleration of a car whose driver has left the accelerator and does not brake yet (as published by mattas2022). [m/s^2]
pub const RELEASE_MPS2: f64 = 0.4;
/// A cut-in is a danger up to this time to collision (unr157, Annex 4, Appendix 3). [s]
const CRITICAL_TIME_TO_COLLISION_S: f64 = 2.0;
/// Time gap behind a leader of the same speed (unr157, Annex 4, Appendix 3). [s]
const TIME_GAP_S: f64 = 2.0;

/// See [`crate::ReferenceDriver::following_distance_m`].
pub fn following_distance_m(speed_mps: f64) -> f64 {
    TIME_GAP_S * speed_mps
}

/// Danger is a vehicle that is partly in the way and nearer than the critical time to collision. One that gets into the way
/// farther off is none, then and later.
pub fn sees(ego: &Body, other: &Body) -> Sees {
    if ego.along_m > other.along_m || ego.lateral_gap_m(other) > 0.0 {
        return Sees::NoDanger;
    }
    let gap_m = other.along_m - ego.along_m - ego.length_m / 2.0 - other.length_m / 2.0;
    if (gap_m / (ego.speed_mps - other.speed_mps)).abs() > CRITICAL_TIME_TO_COLLISION_S {
        Sees::Settled
    } else {
        Sees::Danger
    }
}
