//! The paper's road maps: one block of MetaDrive's behind an approach road.

use crate::conflict::Side;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    pub direction: Side,
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
