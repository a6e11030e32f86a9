//! Paths: the lanes a vehicle follows one after the other, as one line with one `s`.

use crate::lane::LaneId;
use crate::network::{RoadId, RoadNetwork};
use recrash_model::geometry::{Pose, Vec2};

/// One lane of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSegment {
    /// The lane.
    pub lane: LaneId,
    /// The path's s where the lane begins. [m]
    pub start_m: f64,
}

/// Lanes with the same number on consecutive roads, as one line.
#[derive(Debug, Clone, PartialEq)]
pub struct LanePath {
    /// Roads, in order.
    pub roads: Vec<RoadId>,
    /// Lanes, in order, one per road.
    pub segments: Vec<PathSegment>,
    /// Length. [m]
    pub length_m: f64,
}

/// A point in a path's coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Along the path. [m]
    pub s: f64,
    /// To the right of it. [m]
    pub t: f64,
    /// Position in [`LanePath::segments`].
    pub segment: usize,
}

/// Where two paths meet: the first place where vehicles following them would touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conflict {
    /// Along the first path. [m]
    pub s_a: f64,
    /// Along the second path. [m]
    pub s_b: f64,
    /// Where the centre lines cross, or come within touching distance for good when they merge.
    pub point: Vec2,
    /// Whether the paths merge into one lane, rather than cross.
    pub merges: bool,
}

impl LanePath {
    /// The path along `roads` in lane number `lane`.
    pub fn new(_network: &RoadNetwork, _roads: Vec<RoadId>, _lane: u8) -> Self {
        unimplemented!()
    }

    /// Pose at (s, t), heading along the path.
    pub fn pose(&self, _network: &RoadNetwork, _s: f64, _t: f64) -> Pose {
        unimplemented!()
    }

    /// Coordinates of a point, looked for from segment `hint` on (a vehicle never goes back).
    pub fn project(&self, _network: &RoadNetwork, _point: Vec2, _hint: usize) -> PathPoint {
        unimplemented!()
    }

    /// The first conflict with another path, for vehicles of these widths. [m]
    pub fn conflict(&self, _other: &Self, _network: &RoadNetwork, _width: f64, _other_width: f64) -> Option<Conflict> {
        unimplemented!()
    }
}
