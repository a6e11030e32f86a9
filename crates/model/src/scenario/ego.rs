//! The subject vehicle: where it starts, what it is asked to do, and how its recorded driver drove.

use super::blocks::Turn;
use super::plan::{ActorPlan, Part, Size};
use crate::kinds::PartnerKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The subject vehicle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EgoSpec {
    /// Which way it leaves the block; on a road network, see `route`.
    #[serde(default)]
    pub turn: Turn,
    /// Lane, 0 is the leftmost.
    #[serde(default)]
    pub lane: u8,
    /// Start along its lane, from the beginning of its route. [m]
    #[serde(default)]
    pub s_m: f64,
    /// Speed at the start. [m/s]
    #[serde(default)]
    pub speed_mps: f64,
    /// Speed it wants. [m/s]
    pub target_speed_mps: f64,
    /// Kind.
    #[serde(default, skip_serializing_if = "is_default")]
    pub kind: PartnerKind,
    /// Length and width, where they differ from its kind's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<Size>,
    /// On a road network: the roads it is to take, with direction, from the one it starts on. Between two of them the
    /// shortest way is taken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub route: Vec<String>,
    /// Where it is to stop on its route, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stops: Vec<MissionStop>,
    /// How its recorded driver drove: the crash as it is told. Its start and speed then count, in place of `s_m` and
    /// `speed_mps`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded: Option<ActorPlan>,
    /// The system under test takes over from the recorded driver at this time, with the same place, heading and speed. [s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 120.0))]
    pub handover_s: Option<f64>,
    /// What sticks out of its body: sensors, mirrors, doors.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Part>,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A stop that belongs to the ego's task: for a passenger, for a delivery, to park.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MissionStop {
    /// Where its centre is then, along its route. [m]
    #[schemars(range(min = 0.0, max = 2000.0))]
    pub s_m: f64,
    /// Where it is beside its lane's centre, to the right: it pulls over. [m]
    #[serde(default)]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub t_m: f64,
    /// How long it stays; for good where not given, and staying there is its end. [s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 120.0))]
    pub for_s: Option<f64>,
}
