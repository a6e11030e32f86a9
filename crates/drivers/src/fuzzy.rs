//! The fuzzy safety model (mattas2020, mattas2022; unr157 since its 01 series, Annex 3).

use crate::sight::{Body, FULL_BRAKING_MPS2, REACTION_TIME_S, STEPS_PER_S, Sees};
use recrash_model::math::sq;

/// Comfortable braking of the rear one. [m/s^2]
const COMFORTABLE_MPS2: f64 = 4.0;
/// Hardest braking of the rear one. [m/s^2]
const HARDEST_MPS2: f64 = 6.0;
/// Hardest braking of the one ahead. [m/s^2]
const LEADER_HARDEST_MPS2: f64 = 7.0;
/// Distance that is left when both stand. [m]
const STANDING_MARGIN_M: f64 = 2.0;
/// Room beyond which nothing is to fear. [m]
const SAFE_MARGIN_M: f64 = 2.0;

/// See [`crate::ReferenceDriver::following_distance_m`]: from here on nothing is to fear.
pub fn following_distance_m(speed_mps: f64) -> f64 {
    speed_mps * REACTION_TIME_S + sq(speed_mps) / (2.0 * COMFORTABLE_MPS2) - sq(speed_mps) / (2.0 * LEADER_HARDEST_MPS2)
        + SAFE_MARGIN_M
        + STANDING_MARGIN_M
}

/// How much is to fear from the one ahead if it brakes as hard as it can (proactive fuzzy safety), from 0 to 1.
fn proactive(gap_m: f64, rear_mps: f64, front_mps: f64) -> f64 {
    let left_m = gap_m - STANDING_MARGIN_M;
    let stops_within_m = |braking_mps2: f64| {
        rear_mps * REACTION_TIME_S + sq(rear_mps) / (2.0 * braking_mps2) - sq(front_mps) / (2.0 * LEADER_HARDEST_MPS2)
    };
    degree(left_m, stops_within_m(COMFORTABLE_MPS2) + SAFE_MARGIN_M, stops_within_m(HARDEST_MPS2))
}

/// How much is to fear if the one ahead keeps its speed and ours goes on as it does (critical fuzzy safety), from 0 to 1.
fn critical(gap_m: f64, rear_mps: f64, front_mps: f64, acceleration_mps2: f64) -> f64 {
    if rear_mps <= front_mps {
        return 0.0;
    }
    // Braking harder than is comfortable is not reckoned with.
    let goes_on_mps2 = acceleration_mps2.max(-COMFORTABLE_MPS2);
    if rear_mps + REACTION_TIME_S * goes_on_mps2 < front_mps {
        let equal_speed_within_m = sq(rear_mps - front_mps) / (acceleration_mps2 * 2.0).abs();
        return if gap_m < equal_speed_within_m { 1.0 } else { 0.0 };
    }
    let while_reacting_m = (rear_mps + goes_on_mps2 * REACTION_TIME_S / 2.0 - front_mps) * REACTION_TIME_S;
    let closing_mps = rear_mps + goes_on_mps2 * REACTION_TIME_S - front_mps;
    let equal_speed_within_m = |braking_mps2: f64| while_reacting_m + sq(closing_mps) / (braking_mps2 * 2.0);
    degree(gap_m, equal_speed_within_m(COMFORTABLE_MPS2), equal_speed_within_m(HARDEST_MPS2))
}

/// 0 above the safe distance, 1 below the unsafe one, and straight between.
fn degree(gap_m: f64, safe_m: f64, unsafe_m: f64) -> f64 {
    if gap_m > safe_m {
        0.0
    } else if gap_m < unsafe_m {
        1.0
    } else {
        (gap_m - safe_m) / (unsafe_m - safe_m)
    }
}

/// Danger is what is to fear of a vehicle that is in the way, or will be before it has been passed; and braking that is as hard
/// as the fear is great. [m/s^2]
pub fn sees(ego: &Body, other: &Body, acceleration_mps2: f64) -> (Sees, f64) {
    if ego.along_m > other.along_m || (ego.lateral_gap_m(other) > 0.0 && !comes_in(ego, other)) {
        return (Sees::NoDanger, 0.0);
    }
    let gap_m = ego.gap_m(other);
    let critical = critical(gap_m, ego.speed_mps, other.speed_mps, acceleration_mps2);
    let proactive = proactive(gap_m, ego.speed_mps, other.speed_mps);
    let braking_mps2 = if critical > 0.0 {
        critical * (HARDEST_MPS2 - COMFORTABLE_MPS2) + COMFORTABLE_MPS2
    } else {
        proactive * COMFORTABLE_MPS2
    };
    let sees = if critical + proactive == 0.0 { Sees::NoDanger } else { Sees::Danger };
    (sees, braking_mps2.min(FULL_BRAKING_MPS2))
}

/// Whether a vehicle at the side drifts towards ours, and gets there before ours has passed it, within one step.
fn comes_in(ego: &Body, other: &Body) -> bool {
    let towards_mps = -other.lateral_mps;
    if towards_mps <= 0.0 {
        return false;
    }
    let to_the_way_s = ego.lateral_gap_m(other) / towards_mps;
    let until_passed_m = (ego.along_m - other.along_m).abs() + ego.length_m / 2.0 + other.length_m / 2.0;
    to_the_way_s <= until_passed_m / (ego.speed_mps - other.speed_mps) + 1.0 / STEPS_PER_S
}
