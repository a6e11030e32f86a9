//! Areas of the ground that are no lanes, on a road network.

use recrash_model::geometry::{Pose, Vec2};
use recrash_model::scenario::AreaKind;

/// An area of the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundArea {
    /// What it is.
    pub kind: GroundKind,
    /// Where it comes from: `main.crosswalks[0]`, `main.driveways[1]`, `main+.stalls[4]`, `areas[2]`, a junction's id.
    pub name: String,
    /// Its middle. A crosswalk is walked this way or the other; a driveway leads this way onto the road; a stall is
    /// entered this way; elsewhere the heading says nothing.
    pub middle: Pose,
    /// Corners, in order. [m]
    pub points: Vec<Vec2>,
}

/// What an area of the ground is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GroundKind {
    /// Paved, to be driven on.
    Paved,
    /// Where a junction's arms meet: paved too.
    Junction,
    /// Where pedestrians cross.
    Crosswalk,
    /// A piece of private road.
    Driveway,
    /// A stall of a parking lot, or a bay along a kerb.
    Stall,
    /// A raised island or a sidewalk.
    Island,
    /// A building or a wall.
    Building,
}

impl GroundKind {
    /// Whether a motor vehicle may be on it.
    pub const fn is_paved(self) -> bool {
        !matches!(self, Self::Island | Self::Building)
    }
}

impl From<AreaKind> for GroundKind {
    fn from(kind: AreaKind) -> Self {
        match kind {
            AreaKind::Paved => Self::Paved,
            AreaKind::Crosswalk => Self::Crosswalk,
            AreaKind::Island => Self::Island,
            AreaKind::Building => Self::Building,
        }
    }
}

impl GroundArea {
    /// Whether a point lies on it: a ray to the right crosses its sides an odd number of times.
    pub fn contains(&self, point: Vec2) -> bool {
        let mut odd = false;
        for (from, to) in self.points.iter().zip(self.points.iter().cycle().skip(1)) {
            if (from.y > point.y) != (to.y > point.y) {
                let x = from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x);
                odd ^= point.x < x;
            }
        }
        odd
    }
}
