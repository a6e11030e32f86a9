//! Scenarios: `recrash.scenario/2`, the JSON that designs, tunes, files and exports are made of.
//!
//! A [`ScenarioDraft`] is what anybody wrote: a person, a model, a search. `recrash_roads::check` is the only door from
//! a draft to a runnable scenario.
//!
//! Lateral offsets `t` are positive to the **right** of travel and lane 0 is the leftmost, as in MetaDrive.

use crate::origin::{Origin, RecordRef};
use crate::surroundings::{Lighting, Surface, Weather};
use crate::template::Template;
mod blocks;
mod control;
mod ego;
mod graph;
mod map;
mod partner;
mod place;
mod plan;

pub use blocks::*;
pub use control::*;
pub use ego::*;
pub use graph::*;
pub use map::*;
pub use partner::*;
pub use place::*;
pub use plan::*;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The scenarios' format tag.
pub const SCENARIO_FORMAT: &str = "recrash.scenario/2";

/// The format before it, which is still read: a part of this one.
pub const SCENARIO_FORMAT_1: &str = "recrash.scenario/1";

/// Length of the entrance before the approach road, as in MetaDrive's first block. [m]
pub const ENTRANCE_LENGTH_M: f64 = 10.0;

/// A scenario that has not been checked.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
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
    /// Road users with one of the paper's policies, at most 16; on the paper's maps only.
    #[serde(default)]
    pub partners: Vec<Partner>,
    /// Road users with a plan, at most 32.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub actors: Vec<Actor>,
    /// Things that stand or lie anywhere, at most 64.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<ObjectSpec>,
    /// Signals and signs, at most 32.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub control: Vec<Control>,
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
    /// The rollout goes on for this long after the ego's first contact: for a crash of more than one. [s]
    #[serde(default, skip_serializing_if = "is_zero")]
    pub after_contact_s: f64,
}

/// Why a scenario in which nobody takes over is not tested.
pub const NOTHING_TO_TEST: &str = "its ego was parked, so there is nothing to test";

impl ScenarioDraft {
    /// Whether there is something to test: of a record whose ego was parked nobody takes over, and whoever is put into the
    /// ego's seat, the recorded driver drives to the end.
    pub fn is_tested(&self) -> bool {
        self.source.origin.is_none() || self.ego.recorded.is_none() || self.ego.handover_s.is_some()
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
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

impl Author {
    /// Whether the built-in rules wrote it.
    pub fn is_rules(&self) -> bool {
        *self == Self::Rules
    }
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
