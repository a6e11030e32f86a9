//! Contact zones of a vehicle.

use crate::geometry::{OrientedBox, Vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One of the ten contact zones of a vehicle (the `... Contact Area - ...` columns).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactZone {
    /// Front.
    Front,
    /// Front left.
    FrontLeft,
    /// Left side.
    Left,
    /// Rear left.
    RearLeft,
    /// Rear.
    Rear,
    /// Rear right.
    RearRight,
    /// Right side.
    Right,
    /// Front right.
    FrontRight,
    /// Top.
    Top,
    /// Bottom.
    Bottom,
}

/// Part of the length, and of the width, that a corner zone takes at each end (`docs/models/contact-zones.md`).
const CORNER_SHARE: f64 = 0.25;

impl ContactZone {
    /// Every zone: the eight around the box anticlockwise from the front, then top and bottom.
    pub const ALL: [Self; 10] = [
        Self::Front,
        Self::FrontLeft,
        Self::Left,
        Self::RearLeft,
        Self::Rear,
        Self::RearRight,
        Self::Right,
        Self::FrontRight,
        Self::Top,
        Self::Bottom,
    ];

    /// The zone of a vehicle's outline that a point on or near its edge belongs to.
    pub fn at(outline: &OrientedBox, point: Vec2) -> Self {
        let local = outline.to_local(point);
        let (x, y) = (local.x.abs() / outline.half_length, local.y.abs() / outline.half_width);
        let corner_from = 1.0 - 2.0 * CORNER_SHARE;
        let at_side = y >= corner_from;
        // Deep inside, the nearer edge.
        let nearer_end = outline.half_length - local.x.abs() < outline.half_width - local.y.abs();
        let at_end = x >= corner_from || (!at_side && nearer_end);
        match (at_end, at_side, local.x >= 0.0, local.y >= 0.0) {
            (true, true, true, true) => Self::FrontLeft,
            (true, true, true, false) => Self::FrontRight,
            (true, true, false, true) => Self::RearLeft,
            (true, true, false, false) => Self::RearRight,
            (true, false, true, _) => Self::Front,
            (true, false, false, _) => Self::Rear,
            (false, _, _, true) => Self::Left,
            (false, _, _, false) => Self::Right,
        }
    }

    /// Front, front left or front right.
    pub fn is_front(self) -> bool {
        matches!(self, Self::Front | Self::FrontLeft | Self::FrontRight)
    }

    /// Rear, rear left or rear right.
    pub fn is_rear(self) -> bool {
        matches!(self, Self::Rear | Self::RearLeft | Self::RearRight)
    }

    /// Steps around the box between two zones, 0 to 4; `None` with top or bottom.
    pub fn steps_apart(self, other: Self) -> Option<u8> {
        let index = |zone: Self| Self::ALL[..8].iter().position(|&z| z == zone);
        let distance = index(self)?.abs_diff(index(other)?);
        Some(distance.min(8 - distance) as u8)
    }

    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::FrontLeft => "front left",
            Self::Left => "left",
            Self::RearLeft => "rear left",
            Self::Rear => "rear",
            Self::RearRight => "rear right",
            Self::Right => "right",
            Self::FrontRight => "front right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_are_neighbours_around_the_box() {
        assert_eq!(ContactZone::Front.steps_apart(ContactZone::FrontRight), Some(1));
        assert_eq!(ContactZone::Front.steps_apart(ContactZone::Rear), Some(4));
        assert_eq!(ContactZone::Left.steps_apart(ContactZone::Top), None);
    }
}
