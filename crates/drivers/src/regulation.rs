//! What UN R157 asks of the system itself in a cut-in (unr157, paragraph 5.2.5.2).

use crate::sight::{Body, STEPS_PER_S, Sees};

/// From seeing the danger to braking. [s]
pub const REACTION_TIME_S: f64 = 0.35;
/// Braking, at once and in full. [m/s^2]
pub const BRAKING_MPS2: f64 = 6.0;
/// A vehicle this near at the side is on its way into the lane (mattas2022). [m]
const LATERAL_GAP_M: f64 = 0.5;

/// Danger is a vehicle near the side whose time to collision is at most that of braking with 6 m/s^2 after 0.35 s, and one step.
pub fn sees(ego: &Body, other: &Body) -> Sees {
    if ego.along_m > other.along_m || ego.lateral_gap_m(other) > LATERAL_GAP_M {
        return Sees::NoDanger;
    }
    let closing_mps = ego.speed_mps - other.speed_mps;
    let limit_s = closing_mps / (2.0 * BRAKING_MPS2) + REACTION_TIME_S + 1.0 / STEPS_PER_S;
    if (ego.gap_m(other) / closing_mps).abs() > limit_s { Sees::NoDanger } else { Sees::Danger }
}
