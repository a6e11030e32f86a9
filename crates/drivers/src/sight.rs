//! What reference drivers see and make of it, in which steps, and what they have in common when they react.

/// Steps of the published simulation. [1/s]
pub const STEPS_PER_S: f64 = 10.0;
/// Jerk of a braking driver: 0.774 g within 0.6 s (unr157, Annex 4, Appendix 3), rounded as published. [m/s^3]
pub(crate) const BRAKING_JERK_MPS3: f64 = 12.65;
/// Full braking of a driver: 0.774 g (unr157, Annex 4, Appendix 3). [m/s^2]
pub(crate) const FULL_BRAKING_MPS2: f64 = 0.774 * 9.81;
/// From seeing the danger to braking (unr157, Annex 4, Appendix 3; mattas2022 uses it for all but the regulation's). [s]
pub(crate) const REACTION_TIME_S: f64 = 0.75;

/// One vehicle on the straight road, seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Place of its centre along the road. [m]
    pub along_m: f64,
    /// Place of its centre across the road. [m]
    pub across_m: f64,
    /// Speed along the road. [m/s]
    pub speed_mps: f64,
    /// Speed across the road. [m/s]
    pub lateral_mps: f64,
    /// [m]
    pub length_m: f64,
    /// [m]
    pub width_m: f64,
}

impl Body {
    /// Between the two along the road, bumper to bumper; negative where they overlap. [m]
    pub fn gap_m(&self, other: &Self) -> f64 {
        (self.along_m - other.along_m).abs() - self.length_m / 2.0 - other.length_m / 2.0
    }

    /// Between the two across the road, side to side; negative where they overlap. [m]
    pub fn lateral_gap_m(&self, other: &Self) -> f64 {
        (self.across_m - other.across_m).abs() - self.width_m / 2.0 - other.width_m / 2.0
    }

    /// Whether the two touch.
    pub fn touches(&self, other: &Self) -> bool {
        self.lateral_gap_m(other) < 0.0 && self.gap_m(other) < 0.0
    }
}

/// What a driver makes of what it sees in one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sees {
    /// It keeps its speed.
    NoDanger,
    /// It reacts.
    Danger,
    /// The other is in the lane, and far enough: there is nothing more to decide.
    Settled,
}
