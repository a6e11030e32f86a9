//! The road network of a map: nodes, roads between them, lanes on them; node for node MetaDrive's.

use crate::lane::{Lane, LaneId};
use recrash_model::scenario::{Approach, MapSpec, Turn};

/// Position of a road in [`RoadNetwork::roads`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RoadId(pub u16);

/// What a road is to the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RoadPart {
    /// The ego's approach (entrance included), towards the block.
    Approach,
    /// The same road away from the block.
    Departure,
    /// An arm of the block away from it.
    ArmOut,
    /// An arm towards the block.
    ArmIn,
    /// Inside the block: a connector of a junction, a curve, an entry or exit of a roundabout.
    Inner,
    /// Part of a roundabout's ring.
    Ring,
}

/// A road: a bundle of parallel lanes from one node to another, in one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Road {
    /// MetaDrive's name of the node it starts at, such as `>>` or `1X0_0_`.
    pub from: String,
    /// MetaDrive's name of the node it ends at.
    pub to: String,
    /// What it is to the map.
    pub part: RoadPart,
    /// Its lanes, leftmost first.
    pub lanes: Vec<LaneId>,
}

/// The road network of one map.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadNetwork {
    /// The map it was built from.
    pub map: MapSpec,
    /// Every road.
    pub roads: Vec<Road>,
    /// Every lane.
    pub lanes: Vec<Lane>,
}

impl RoadNetwork {
    /// Builds the network. The numbers of `map` must be in range (see [`crate::check()`]).
    pub fn build(_map: &MapSpec) -> Self {
        unimplemented!()
    }

    /// A lane.
    pub fn lane(&self, id: LaneId) -> &Lane {
        &self.lanes[usize::from(id.0)]
    }

    /// A road.
    pub fn road(&self, id: RoadId) -> &Road {
        &self.roads[usize::from(id.0)]
    }

    /// The roads a vehicle takes that comes from `approach` and turns `turn` (seen from itself), from the very
    /// beginning of its arm to the very end of its exit; `None` where the map has no such way.
    pub fn route(&self, _approach: Approach, _turn: Turn) -> Option<Vec<RoadId>> {
        unimplemented!()
    }
}
