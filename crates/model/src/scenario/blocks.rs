//! The paper's road maps: one block of MetaDrive's behind an approach road.

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

/// What all maps share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carriageway {
    /// Lanes in each direction, 1 to 4.
    pub lanes: u8,
    /// Lane width, 2.5 to 4.5. [m]
    pub lane_width_m: f64,
    /// Length of the approach road with its entrance (MetaDrive's `exit_length`), 20 to 300. [m]
    pub approach_m: f64,
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

/// A straight road with oncoming lanes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StraightMap {
    /// Lanes in each direction.
    pub lanes: u8,
    /// Lane width. [m]
    pub lane_width_m: f64,
    /// Length of the approach road. [m]
    pub approach_m: f64,
    /// Length of the straight behind it, 20 to 600. [m]
    pub length_m: f64,
}

/// A curve, then a straight tail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveMap {
    /// Lanes in each direction.
    pub lanes: u8,
    /// Lane width. [m]
    pub lane_width_m: f64,
    /// Length of the approach road. [m]
    pub approach_m: f64,
    /// Radius of the rightmost lane's centre line, 15 to 200. [m]
    pub radius_m: f64,
    /// Angle of the curve, 10 to 135. [deg]
    pub angle_deg: f64,
    /// Which way it bends.
    pub direction: crate::narrative::Side,
    /// Length of the straight tail, 10 to 300. [m]
    pub length_m: f64,
}

/// Four arms at right angles; the junction's corner radius is MetaDrive's 10 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrossMap {
    /// Lanes in each direction.
    pub lanes: u8,
    /// Lane width. [m]
    pub lane_width_m: f64,
    /// Length of the approach road. [m]
    pub approach_m: f64,
    /// Length of the other three arms, 20 to 300. [m]
    pub arm_m: f64,
}

/// A four-way intersection with one arm missing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TeeMap {
    /// Lanes in each direction.
    pub lanes: u8,
    /// Lane width. [m]
    pub lane_width_m: f64,
    /// Length of the approach road. [m]
    pub approach_m: f64,
    /// Length of the other two arms, 20 to 300. [m]
    pub arm_m: f64,
    /// Which arm is missing, seen from the ego.
    pub missing: MissingArm,
}

/// The missing arm of a three-way intersection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MissingArm {
    /// No road to the right (MetaDrive's `t_type` 0).
    Right,
    /// No road ahead (`t_type` 1).
    Ahead,
    /// No road to the left (`t_type` 2).
    Left,
}

/// A roundabout with four arms, driven anticlockwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoundaboutMap {
    /// Lanes in each direction.
    pub lanes: u8,
    /// Lane width. [m]
    pub lane_width_m: f64,
    /// Length of the approach road. [m]
    pub approach_m: f64,
    /// Length of the other three arms, 20 to 300. [m]
    pub arm_m: f64,
    /// Radius of entry and exit curves (rightmost lane), 5 to 15. [m]
    pub exit_radius_m: f64,
    /// Radius of the inner edge, 15 to 45. [m]
    pub inner_radius_m: f64,
}

/// Which way a vehicle leaves the block: at a roundabout, which exit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Turn {
    /// Straight on (roundabout: second exit).
    #[default]
    Straight,
    /// Left (roundabout: third exit).
    Left,
    /// Right (roundabout: first exit).
    Right,
}
