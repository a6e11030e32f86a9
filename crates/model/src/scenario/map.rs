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
