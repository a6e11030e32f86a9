//! Road networks made of roads and junctions, as OpenDRIVE makes them: a reference line with strips on both sides, and
//! connections that a junction makes of itself.

use super::blocks::{Carriageway, Turn};
use crate::conflict::Side;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A road network. Traffic keeps to the right.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GraphMap {
    /// Roads, 1 to 48.
    pub roads: Vec<RoadSpec>,
    /// Junctions, at most 12.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub junctions: Vec<JunctionSpec>,
    /// Areas without lanes, at most 64.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub areas: Vec<AreaSpec>,
}

impl GraphMap {
    /// Lanes and width of its first road, and its length.
    pub(super) fn carriageway(&self) -> Carriageway {
        let road = self.roads.first();
        let lanes = || road.into_iter().flat_map(|road| &road.right).filter(|strip| strip.kind == StripKind::Driving);
        Carriageway {
            lanes: u8::try_from(lanes().count()).unwrap_or(u8::MAX),
            lane_width_m: lanes().next().map_or(0.0, |strip| strip.widths_m().0),
            approach_m: road.into_iter().flat_map(|road| &road.line).map(LinePiece::length_m).sum(),
        }
    }
}

impl LinePiece {
    /// Its length; of a line through points, that of the straight pieces between them. [m]
    pub fn length_m(&self) -> f64 {
        match self {
            Self::Straight { length_m } | Self::Arc { length_m, .. } | Self::Spiral { length_m, .. } => *length_m,
            Self::Points { points } => {
                let mut from = [0.0, 0.0];
                let mut length_m = 0.0;
                for to in points {
                    length_m += crate::math::hypot(to[0] - from[0], to[1] - from[1]);
                    from = *to;
                }
                length_m
            }
        }
    }
}

/// A road: a reference line, and strips to its right and left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoadSpec {
    /// Unique: letters, digits, `_`, at most 32.
    pub id: String,
    /// Where its reference line begins.
    pub start: RoadStart,
    /// The reference line, piece by piece, 1 to 64.
    pub line: Vec<LinePiece>,
    /// Strips to the right of the reference line, from it outwards, at most 12; lanes here lead along the line.
    #[serde(default)]
    pub right: Vec<Strip>,
    /// Strips to the left, from the line outwards; lanes here lead against the line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left: Vec<Strip>,
    /// Posted speed. [m/s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 60.0))]
    pub speed_limit_mps: Option<f64>,
    /// Crosswalks, at most 8.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub crosswalks: Vec<Crosswalk>,
    /// Driveways: drops in the kerb with a piece of road behind, at most 16.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub driveways: Vec<Driveway>,
}

/// Where a road's reference line begins, and which way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RoadStart {
    /// At a place in the plane.
    At {
        /// [m]
        #[schemars(range(min = -2000.0, max = 2000.0))]
        x_m: f64,
        /// [m]
        #[schemars(range(min = -2000.0, max = 2000.0))]
        y_m: f64,
        /// Anticlockwise from +x. [deg]
        #[schemars(range(min = -360.0, max = 360.0))]
        heading_deg: f64,
    },
    /// Where another road's reference line ends, going on the same way. Driving lanes of one number follow each other: they
    /// must meet there.
    After {
        /// That road.
        road: String,
    },
    /// At a junction, leading away from it.
    Arm {
        /// The junction.
        junction: String,
        /// Seen from the junction's centre, anticlockwise from +x. [deg]
        #[schemars(range(min = -360.0, max = 360.0))]
        bearing_deg: f64,
        /// From the junction's centre, 4 to 100. [m]
        #[schemars(range(min = 4.0, max = 100.0))]
        from_m: f64,
    },
    /// So that the first driving lane on its right ends where a lane of another road begins: a ramp that merges.
    IntoLane {
        /// That road with direction, such as `main+`.
        road: String,
        /// Its lane.
        lane: u8,
    },
    /// So that the first driving lane on its right begins where a lane of another road ends: a ramp that leaves.
    FromLane {
        /// That road with direction.
        road: String,
        /// Its lane.
        lane: u8,
    },
}

/// A piece of a reference line; each goes on where, and as, the one before it ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LinePiece {
    /// A straight line.
    Straight {
        /// 0.1 to 2000. [m]
        #[schemars(range(min = 0.1, max = 2000.0))]
        length_m: f64,
    },
    /// A circular arc.
    Arc {
        /// 0.1 to 2000. [m]
        #[schemars(range(min = 0.1, max = 2000.0))]
        length_m: f64,
        /// 4 to 10 000. [m]
        #[schemars(range(min = 4.0, max = 10000.0))]
        radius_m: f64,
        /// Which way it bends.
        to: Side,
    },
    /// A clothoid: the curvature changes evenly from one end to the other.
    Spiral {
        /// 1 to 500. [m]
        #[schemars(range(min = 1.0, max = 500.0))]
        length_m: f64,
        /// Radius at its beginning, 4 to 10 000; straight where not given. [m]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 4.0, max = 10000.0))]
        from_radius_m: Option<f64>,
        /// Radius at its end, 4 to 10 000; straight where not given. [m]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 4.0, max = 10000.0))]
        to_radius_m: Option<f64>,
        /// Which way it bends.
        to: Side,
    },
    /// A smooth line through points, in the frame of the end of the piece before: x along the line there, y to its left.
    Points {
        /// 1 to 64 points after the beginning, each coordinate within 500. [m]
        points: Vec<[f64; 2]>,
    },
}

/// A strip of a road, beside another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strip {
    /// What it is for.
    pub kind: StripKind,
    /// Width at the road's beginning; that of its kind where not given. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 20.0))]
    pub width_m: Option<f64>,
    /// Width at the road's end, where it differs; it changes in an S, half of it on half of the way. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 20.0))]
    pub end_width_m: Option<f64>,
    /// Driving lanes: the turns it may take at the junction it leads into. By its place among the lanes where none is given:
    /// everybody straight on, the leftmost also left, the rightmost also right; where nothing lies straight on, the left
    /// half turns left and the right half right.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub turns: Vec<Turn>,
    /// Stalls: angle between the road and whoever is parked in them, 90 is across. [deg]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 90.0))]
    pub stall_angle_deg: Option<f64>,
    /// Stalls and parking bays: width of each along the road. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2.0, max = 20.0))]
    pub stall_m: Option<f64>,
}

/// What a strip is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StripKind {
    /// A lane of moving traffic.
    Driving,
    /// A centre lane from which both directions turn left.
    CentreTurn,
    /// A bicycle lane.
    Bike,
    /// Parking along the kerb.
    Parking,
    /// Stalls of a parking lot, at an angle to the aisle.
    Stalls,
    /// A paved shoulder.
    Shoulder,
    /// Between directions, or beside the lanes: not to be driven on.
    Median,
    /// A sidewalk behind a kerb.
    Sidewalk,
}

impl StripKind {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Driving,
        Self::CentreTurn,
        Self::Bike,
        Self::Parking,
        Self::Stalls,
        Self::Shoulder,
        Self::Median,
        Self::Sidewalk,
    ];

    /// Its name in a road's name, such as `bike` in `main+.bike`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Driving => "driving",
            Self::CentreTurn => "centre_turn",
            Self::Bike => "bike",
            Self::Parking => "parking",
            Self::Stalls => "stalls",
            Self::Shoulder => "shoulder",
            Self::Median => "median",
            Self::Sidewalk => "sidewalk",
        }
    }

    /// Its usual width: of town streets (nacto2013); stalls are 18 ft deep, as is usual in parking lots. [m]
    pub const fn usual_width_m(self) -> f64 {
        match self {
            Self::Driving | Self::CentreTurn => 3.3,
            Self::Bike => 1.8,
            Self::Parking => 2.4,
            Self::Stalls => 5.5,
            Self::Shoulder => 2.5,
            Self::Median => 1.5,
            Self::Sidewalk => 2.5,
        }
    }

    /// Whether a motor vehicle may be on it.
    pub const fn is_paved(self) -> bool {
        !matches!(self, Self::Median | Self::Sidewalk)
    }
}

impl Strip {
    /// Of a kind, with its usual width.
    pub const fn of(kind: StripKind) -> Self {
        Self { kind, width_m: None, end_width_m: None, turns: Vec::new(), stall_angle_deg: None, stall_m: None }
    }

    /// Its widths at the road's beginning and end. [m]
    pub fn widths_m(&self) -> (f64, f64) {
        let start = self.width_m.unwrap_or(self.kind.usual_width_m());
        (start, self.end_width_m.unwrap_or(start))
    }
}

/// Where pedestrians cross a road.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Crosswalk {
    /// Its middle, along the reference line. [m]
    #[schemars(range(min = 0.0, max = 2000.0))]
    pub s_m: f64,
    /// Its width along the road, 1 to 10. [m]
    #[schemars(range(min = 1.0, max = 10.0))]
    pub width_m: f64,
}

/// A driveway: a drop in the kerb, and a piece of private road across sidewalk and planting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Driveway {
    /// Which side of the reference line.
    pub side: Side,
    /// Its middle, along the reference line. [m]
    #[schemars(range(min = 0.0, max = 2000.0))]
    pub s_m: f64,
    /// Its width along the road, 2 to 20. [m]
    #[schemars(range(min = 2.0, max = 20.0))]
    pub width_m: f64,
    /// How far it reaches away from the edge of the outermost paved strip, 1 to 40. [m]
    #[schemars(range(min = 1.0, max = 40.0))]
    pub depth_m: f64,
}

/// A junction: arms are the roads that begin at it ([`RoadStart::Arm`]) or end at it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JunctionSpec {
    /// Unique: letters, digits, `_`, at most 32.
    pub id: String,
    /// Centre. [m]
    #[serde(default)]
    #[schemars(range(min = -2000.0, max = 2000.0))]
    pub x_m: f64,
    /// Centre. [m]
    #[serde(default)]
    #[schemars(range(min = -2000.0, max = 2000.0))]
    pub y_m: f64,
    /// Roads that end at it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ends: Vec<String>,
    /// U-turns are possible on these arms.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub u_turns: Vec<String>,
}

/// An area of the ground without lanes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaSpec {
    /// What it is.
    pub kind: AreaKind,
    /// Corners, 3 to 32, in order. [m]
    pub points: Vec<[f64; 2]>,
}

/// What an area of the ground is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AreaKind {
    /// Paved, to be driven on.
    Paved,
    /// Where pedestrians cross.
    Crosswalk,
    /// A raised island or a sidewalk.
    Island,
    /// A building or a wall.
    Building,
}
