//! Scenarios: `recrash.scenario/1`, the JSON that designs, tunes, files and exports are made of.
//!
//! A [`ScenarioDraft`] is what anybody wrote: a person, a model, a search. `recrash_roads::check` is the only door from
//! a draft to a runnable scenario.
//!
//! Lateral offsets `t` are positive to the **right** of travel and lane 0 is the leftmost, as in MetaDrive.

use crate::kinds::PartnerKind;
use crate::narrative::Origin;
use crate::record::RecordRef;
use crate::surroundings::{Lighting, Surface, Weather};
use crate::template::Template;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The scenarios' format tag.
pub const SCENARIO_FORMAT: &str = "recrash.scenario/1";

/// Length of the entrance before the approach road, as in MetaDrive's first block. [m]
pub const ENTRANCE_LENGTH_M: f64 = 10.0;

/// A scenario that has not been checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenarioDraft {
    /// Always [`SCENARIO_FORMAT`].
    pub format: String,
    /// Unique in its suite: letters, digits, `.`, `_` and `-`, at most 80; used in file names.
    pub id: String,
    /// Where it came from.
    pub source: Source,
    /// Road map.
    pub map: MapSpec,
    /// The subject vehicle.
    pub ego: EgoSpec,
    /// Other road users with a script, at most 16.
    #[serde(default)]
    pub partners: Vec<Partner>,
    /// Static obstacles, at most 64.
    #[serde(default)]
    pub obstacles: Vec<Obstacle>,
    /// Random background traffic.
    #[serde(default)]
    pub traffic: Traffic,
    /// Surface, light and weather.
    #[serde(default)]
    pub environment: Environment,
    /// The rollout ends after this time at the latest, 1 to 120. [s]
    pub duration_s: f64,
}

/// Where a scenario came from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Crash records: the one that is told first, then the others that were looked at.
    #[serde(default)]
    pub records: Vec<RecordRef>,
    /// Whose crash it is; absent where nobody said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Template.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub template: Option<Template>,
    /// Narrative text.
    #[serde(default)]
    pub narrative: String,
    /// Who designed it.
    #[serde(default)]
    pub author: Author,
    /// Seed of its random choices.
    #[serde(default)]
    pub seed: u64,
}

/// Who wrote something.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Author {
    /// The built-in rules.
    #[default]
    Rules,
    /// A language model, by name.
    Model(String),
    /// A person.
    Person,
}

/// A road map: one block behind an approach road, with the geometry of MetaDrive's blocks.
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
    /// What all maps share.
    pub fn carriageway(&self) -> Carriageway {
        let (lanes, lane_width_m, approach_m) = match self {
            Self::S(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::C(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::X(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::T(m) => (m.lanes, m.lane_width_m, m.approach_m),
            Self::O(m) => (m.lanes, m.lane_width_m, m.approach_m),
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

/// The subject vehicle. It starts on the approach road.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EgoSpec {
    /// Which way it leaves the block.
    pub turn: Turn,
    /// Lane, 0 is the leftmost.
    pub lane: u8,
    /// Start along its lane, from the beginning of the map. [m]
    pub s_m: f64,
    /// Speed at the start. [m/s]
    pub speed_mps: f64,
    /// Speed it wants. [m/s]
    pub target_speed_mps: f64,
}

/// From where a partner comes, seen from the ego before any turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Approach {
    /// On the ego's own road, in its direction.
    Same,
    /// Towards the ego, on the opposite lanes of its road or from the arm ahead.
    Opposite,
    /// From the arm on the left (roundabout: the entry there).
    Left,
    /// From the arm on the right (roundabout: the entry there).
    Right,
    /// Already on the roundabout's ring, before the ego's entry.
    Ring,
}

/// A scripted road user.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Partner {
    /// Unique in the scenario: letters, digits, `_` and `-`, at most 32.
    pub id: String,
    /// Kind.
    #[serde(default)]
    pub kind: PartnerKind,
    /// From where it comes.
    pub approach: Approach,
    /// Which way it leaves the block, seen from itself.
    #[serde(default)]
    pub turn: Turn,
    /// Lanes to the right of the ego's lane number (negative: left), counted on its own road from the leftmost.
    #[serde(default)]
    pub lane_offset: i8,
    /// Where it starts.
    pub start: Start,
    /// Speed at the start. [m/s]
    pub speed_mps: f64,
    /// What it does along its lane.
    pub policy: Policy,
    /// Sideways moves, in order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lateral: Vec<LateralMove>,
}

/// Where a partner starts: one of two forms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "RawStart", into = "RawStart")]
#[schemars(with = "RawStart")]
pub enum Start {
    /// Relative to the ego (approaches `same` and `opposite`): ahead positive, right positive. [m]
    Offset {
        /// Ahead of the ego along its road, centre to centre; negative is behind. [m]
        delta_s_m: f64,
        /// To the right of the centre of the partner's own lane. [m]
        delta_t_m: f64,
    },
    /// By time: the partner reaches the conflict point this long after (+) or before (-) the ego, both holding their
    /// target speeds. [s]
    ArrivalGap {
        /// Seconds after the ego. [s]
        arrival_gap_s: f64,
    },
}

#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RawStart {
    /// Ahead of the ego along its road; with `delta_t_m`. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    delta_s_m: Option<f64>,
    /// To the right of the centre of the partner's own lane. [m]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    delta_t_m: Option<f64>,
    /// Seconds by which it reaches the conflict point after the ego; alone. [s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    arrival_gap_s: Option<f64>,
}

impl TryFrom<RawStart> for Start {
    type Error = String;

    fn try_from(raw: RawStart) -> Result<Self, String> {
        match raw {
            RawStart { delta_s_m: Some(delta_s_m), delta_t_m, arrival_gap_s: None } => {
                Ok(Self::Offset { delta_s_m, delta_t_m: delta_t_m.unwrap_or(0.0) })
            }
            RawStart { delta_s_m: None, delta_t_m: None, arrival_gap_s: Some(arrival_gap_s) } => {
                Ok(Self::ArrivalGap { arrival_gap_s })
            }
            _ => Err("a start is either {\"delta_s_m\", \"delta_t_m\"} or {\"arrival_gap_s\"}".to_owned()),
        }
    }
}

impl From<Start> for RawStart {
    fn from(start: Start) -> Self {
        match start {
            Start::Offset { delta_s_m, delta_t_m } => {
                Self { delta_s_m: Some(delta_s_m), delta_t_m: Some(delta_t_m), arrival_gap_s: None }
            }
            Start::ArrivalGap { arrival_gap_s } => {
                Self { delta_s_m: None, delta_t_m: None, arrival_gap_s: Some(arrival_gap_s) }
            }
        }
    }
}

/// Gain of the speed control where none is given. [throttle per m/s]
pub const DEFAULT_SPEED_KP: f64 = 0.3;

/// What a partner does along its lane. One step is 0.1 s. Names of the first three and their fields are the paper's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Policy {
    /// Holds a speed, brakes fully for some steps, holds the speed again.
    SuddenBrake {
        /// Speed to hold. [m/s]
        target_speed: f64,
        /// First step of braking.
        brake_step: u32,
        /// Steps of braking.
        brake_steps: u32,
        /// Gain of the speed control. [throttle per m/s]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        speed_kp: Option<f64>,
    },
    /// Holds a throttle, then a speed, brakes fully for some steps, holds the speed again.
    AccelThenBrake {
        /// Throttle of the first part, -1 to 1.
        accel_mag: f64,
        /// Steps of the first part.
        accel_steps: u32,
        /// Speed to hold then. [m/s]
        cruise_speed: f64,
        /// First step of braking.
        brake_step: u32,
        /// Steps of braking.
        brake_steps: u32,
        /// Gain of the speed control. [throttle per m/s]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        speed_kp: Option<f64>,
    },
    /// Follows its lane with the intelligent driver model.
    IdmNominal {
        /// Speed it wants. [m/s]
        target_speed_mps: f64,
    },
    /// Stands still, and sets off after a while.
    Stopped {
        /// Step at which it sets off; never, where not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        depart_step: Option<u32>,
        /// Speed it then wants. [m/s]
        #[serde(default)]
        target_speed_mps: f64,
    },
    /// Holds a speed, slows for whoever comes first at its conflict points, then goes on.
    Yielding {
        /// Speed it wants. [m/s]
        target_speed_mps: f64,
        /// It goes when the other is at least this long away. [s]
        gap_s: f64,
    },
}

impl Policy {
    /// The speed the partner wants to hold. [m/s]
    pub fn target_speed(&self) -> f64 {
        match *self {
            Self::SuddenBrake { target_speed, .. } => target_speed,
            Self::AccelThenBrake { cruise_speed, .. } => cruise_speed,
            Self::IdmNominal { target_speed_mps }
            | Self::Stopped { target_speed_mps, .. }
            | Self::Yielding { target_speed_mps, .. } => target_speed_mps,
        }
    }
}

/// A sideways move: the lateral target goes from where it is to `to_t_m`, linearly in time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LateralMove {
    /// When it begins. [s]
    pub start_s: f64,
    /// How long it takes, at least 0.5. [s]
    pub duration_s: f64,
    /// New offset from the centre of the lane the partner started in, right positive. [m]
    pub to_t_m: f64,
}

/// Kind of static obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ObstacleKind {
    /// Traffic cone, radius 0.2 m.
    Cone,
    /// Barrier, 2.0 m across the road and 0.3 m along it.
    Barrier,
    /// Warning triangle or sign, radius 0.5 m.
    Warning,
}

/// A static obstacle beside or on the ego's way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Kind.
    pub kind: ObstacleKind,
    /// Along the ego's route, from the beginning of the map. [m]
    pub s_m: f64,
    /// To the right of the centre of the ego's lane. [m]
    pub t_m: f64,
}

/// Random background traffic, as MetaDrive's.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Traffic {
    /// Vehicles per 10 m of spawn lane, 0 to 1.
    #[serde(default)]
    pub density: f64,
    /// Seed of placement and destinations.
    #[serde(default)]
    pub seed: u64,
}

/// Surface, light and weather.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Surface.
    #[serde(default)]
    pub surface: Surface,
    /// Light.
    #[serde(default)]
    pub lighting: Lighting,
    /// Weather.
    #[serde(default)]
    pub weather: Weather,
}
