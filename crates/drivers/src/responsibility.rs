//! Responsibility-sensitive safety (shalevshwartz2017), with the parameters of mattas2022.

use crate::sight::{Body, REACTION_TIME_S, Sees};
use recrash_model::math::sq;

/// Acceleration that the rear one may still have while it reacts. [m/s^2]
const ACCELERATION_MPS2: f64 = 3.0;
/// Braking of both. [m/s^2]
const BRAKING_MPS2: f64 = 6.0;
/// Sideways acceleration and braking. [m/s^2]
const LATERAL_MPS2: f64 = 1.0;
/// Room for swaying in the lane. [m]
const LATERAL_MARGIN_M: f64 = 0.3;

/// See [`crate::ReferenceDriver::following_distance_m`]: the safe distance still holds when the leader has braked for the
/// reaction time.
pub fn following_distance_m(speed_mps: f64) -> f64 {
    let leader_mps = (speed_mps - REACTION_TIME_S * BRAKING_MPS2).max(0.0);
    safe_distance_m(speed_mps, leader_mps) + 0.5 * BRAKING_MPS2 * sq(REACTION_TIME_S)
}

/// Distance from which the rear one can still stop behind the front one (shalevshwartz2017, lemma 2). [m]
fn safe_distance_m(rear_mps: f64, front_mps: f64) -> f64 {
    let reacted_mps = rear_mps + REACTION_TIME_S * ACCELERATION_MPS2;
    rear_mps * REACTION_TIME_S + ACCELERATION_MPS2 * sq(REACTION_TIME_S) / 2.0 + sq(reacted_mps) / (2.0 * BRAKING_MPS2)
        - sq(front_mps) / (2.0 * BRAKING_MPS2)
}

/// Way sideways until a vehicle that drifts has stopped drifting (shalevshwartz2017, lemma 4, of one vehicle). [m]
fn safe_lateral_distance_m(lateral_mps: f64) -> f64 {
    let reacted_mps = lateral_mps + LATERAL_MPS2 * REACTION_TIME_S;
    LATERAL_MARGIN_M
        + ((2.0 * lateral_mps + LATERAL_MPS2 * REACTION_TIME_S) * REACTION_TIME_S / 2.0).abs()
        + sq(reacted_mps) / (2.0 * LATERAL_MPS2)
}

/// Danger is a vehicle ahead that is too near both along and across.
pub fn sees(ego: &Body, other: &Body) -> Sees {
    let danger = ego.along_m <= other.along_m
        && ego.gap_m(other) < safe_distance_m(ego.speed_mps, other.speed_mps)
        && ego.lateral_gap_m(other) < safe_lateral_distance_m(other.lateral_mps.abs());
    if danger { Sees::Danger } else { Sees::NoDanger }
}
