//! Partners with one of the paper's policies, on the paper's maps; and obstacles beside the ego's way.

use super::blocks::Turn;
use super::place::Place;
use super::plan::Size;
use crate::kinds::PartnerKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Pole, bollard or tree.
    Pole,
    /// Wall or fence.
    Wall,
    /// Gate, or the arm of one.
    Gate,
    /// Chain or cable across the way.
    Chain,
    /// Something that lies on the road: debris, a wheel, a branch, a scooter that was laid down.
    Debris,
    /// A kerb.
    Kerb,
    /// A pothole, a drain, a plate.
    Pothole,
    /// A container, a dumpster, a large box.
    Container,
}

impl ObstacleKind {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Cone,
        Self::Barrier,
        Self::Warning,
        Self::Pole,
        Self::Wall,
        Self::Gate,
        Self::Chain,
        Self::Debris,
        Self::Kerb,
        Self::Pothole,
        Self::Container,
    ];

    /// For sentences, with its article: `a cone`, `debris`.
    pub fn with_article(self) -> String {
        match self {
            Self::Debris => self.label().to_owned(),
            _ => format!("a {}", self.label()),
        }
    }

    /// For sentences.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Cone => "cone",
            Self::Barrier => "barrier",
            Self::Warning => "warning sign",
            Self::Pole => "pole",
            Self::Wall => "wall",
            Self::Gate => "gate",
            Self::Chain => "chain",
            Self::Debris => "debris",
            Self::Kerb => "kerb",
            Self::Pothole => "pothole",
            Self::Container => "container",
        }
    }

    /// Extent along and across its heading. Usual sizes, assumed but for MetaDrive's first three. [m]
    pub const fn size_m(self) -> (f64, f64) {
        match self {
            Self::Cone => (0.4, 0.4),
            Self::Barrier => (0.3, 2.0),
            Self::Warning => (1.0, 1.0),
            Self::Pole => (0.3, 0.3),
            Self::Wall => (6.0, 0.3),
            Self::Gate => (0.15, 4.0),
            Self::Chain => (0.05, 6.0),
            Self::Debris => (0.6, 0.6),
            Self::Kerb => (6.0, 0.15),
            Self::Pothole => (0.8, 0.8),
            Self::Container => (3.5, 1.8),
        }
    }

    /// Height; the plane model has none, exports want one. Usual sizes, assumed. [m]
    pub const fn height_m(self) -> f64 {
        match self {
            Self::Cone => 0.75,
            Self::Barrier | Self::Gate => 1.0,
            Self::Warning | Self::Chain => 0.8,
            Self::Pole => 4.0,
            Self::Wall => 2.0,
            Self::Debris => 0.3,
            Self::Kerb => 0.15,
            Self::Pothole => 0.01,
            Self::Container => 1.8,
        }
    }

    /// Mass of what gives way where it is hit; `None` for what stands firm, and is taken for infinitely heavy. Usual masses, assumed. [kg]
    pub const fn mass_kg(self) -> Option<f64> {
        match self {
            Self::Cone => Some(5.0),
            Self::Warning | Self::Debris => Some(20.0),
            Self::Barrier
            | Self::Pole
            | Self::Wall
            | Self::Gate
            | Self::Chain
            | Self::Kerb
            | Self::Pothole
            | Self::Container => None,
        }
    }

    /// Whether it stands up, so that something can strike against it: a hole and a plate in the road do not.
    pub const fn stands_up(self) -> bool {
        !matches!(self, Self::Pothole)
    }
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

/// A thing that stands or lies somewhere, at most until somebody pushes it aside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectSpec {
    /// Kind.
    pub kind: ObstacleKind,
    /// Where its middle is; its length runs along its heading.
    pub at: Place,
    /// Length and width, where they differ from its kind's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<Size>,
}
