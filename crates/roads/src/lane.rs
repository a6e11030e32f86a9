//! Lanes: a straight or circular centre line with a width.

use crate::network::RoadId;
use recrash_model::geometry::Vec2;

/// Position of a lane in [`crate::RoadNetwork::lanes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LaneId(pub u16);

/// A centre line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Centreline {
    /// A straight line.
    Straight {
        /// Beginning. [m]
        start: Vec2,
        /// Heading. [rad]
        heading: f64,
    },
    /// A circular arc.
    Arc {
        /// Centre of the circle. [m]
        centre: Vec2,
        /// Radius. [m]
        radius: f64,
        /// Angle of the beginning, seen from the centre. [rad]
        start_angle: f64,
        /// +1 anticlockwise (a left curve), -1 clockwise.
        turn: f64,
    },
}

/// A lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lane {
    /// Its road.
    pub road: RoadId,
    /// Number on its road, 0 is the leftmost.
    pub index: u8,
    /// Centre line.
    pub centreline: Centreline,
    /// Length of the centre line. [m]
    pub length_m: f64,
    /// Width. [m]
    pub width_m: f64,
}

impl Lane {
    /// The point at (s, t). `s` may lie outside the lane: it is then continued.
    pub fn position(&self, _s: f64, _t: f64) -> Vec2 {
        unimplemented!()
    }

    /// Heading of the centre line at s. [rad]
    pub fn heading(&self, _s: f64) -> f64 {
        unimplemented!()
    }

    /// (s, t) of a point. On an arc, s is continuous around the lane's middle.
    pub fn local(&self, _point: Vec2) -> (f64, f64) {
        unimplemented!()
    }
}
