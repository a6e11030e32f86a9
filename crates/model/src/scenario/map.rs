//! Road maps: the paper's blocks, and networks of roads.

use super::blocks::{Carriageway, CrossMap, CurveMap, RoundaboutMap, StraightMap, TeeMap};
use super::graph::GraphMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A road map: one block behind an approach road, with the geometry of MetaDrive's blocks; or a network of roads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type")]
pub enum MapSpec {
    /// Straight road.
    S(StraightMap),
    /// Curve.
    C(CurveMap),
    /// Four-way intersection.
    X(CrossMap),
    /// Three-way intersection.
    T(TeeMap),
    /// Roundabout.
    O(RoundaboutMap),
    /// A network of roads and junctions.
    G(GraphMap),
}

/// What a map is, whatever its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapKind {
    /// A road without a junction: straight, or a curve.
    Road,
    /// A junction of three arms or four.
    Junction,
    /// A roundabout.
    Roundabout,
    /// A network of roads, with junctions or without.
    Network,
}

impl Default for MapSpec {
    /// A network without a road.
    fn default() -> Self {
        Self::G(GraphMap::default())
    }
}

impl MapSpec {
    /// What all maps share; of a network, that of its first road.
    pub fn carriageway(&self) -> Carriageway {
        let (lanes, lane_width_m, approach_m) = match self {
            Self::S(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::C(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::X(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::T(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::O(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::G(m) => return m.carriageway(),
        };
        Carriageway { lanes, lane_width_m, approach_m }
    }

    /// What it is.
    pub fn kind(&self) -> MapKind {
        match self {
            Self::S(_) | Self::C(_) => MapKind::Road,
            Self::X(_) | Self::T(_) => MapKind::Junction,
            Self::O(_) => MapKind::Roundabout,
            Self::G(_) => MapKind::Network,
        }
    }

    /// The network of roads; none where it is a block.
    pub fn network(&self) -> Option<&GraphMap> {
        match self {
            Self::G(map) => Some(map),
            _ => None,
        }
    }

    /// The letter of the map's block.
    pub fn letter(&self) -> char {
        match self {
            Self::S(_) => 'S',
            Self::C(_) => 'C',
            Self::X(_) => 'X',
            Self::T(_) => 'T',
            Self::O(_) => 'O',
            Self::G(_) => 'G',
        }
    }
}
