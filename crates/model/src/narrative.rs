//! Narratives: a short text about one conflict, and the facts it states, each with the words it came from.

pub use crate::conflict::{FirstMover, Side};
pub use crate::origin::Origin;

use crate::conflict::CollisionKind;
use crate::kinds::PartnerKind;
use crate::origin::RecordRef;
use crate::scenario::{Approach, Author, MissingArm, ObstacleKind};
use crate::template::{Movement, Template};
use crate::zones::ContactZone;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// The narratives' format tag.
pub const NARRATIVE_FORMAT: &str = "recrash.narrative/2";

/// One paraphrased narrative.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Narrative {
    /// Always [`NARRATIVE_FORMAT`].
    #[serde(deserialize_with = "known_format")]
    pub format: String,
    /// The scenario it is for.
    pub scenario_id: String,
    /// Its template.
    pub template: Template,
    /// Records it was made from; the pick is the first.
    pub records: Vec<RecordRef>,
    /// The text: plain sentences with only what matters to the scenario.
    pub text: String,
    /// What the text states.
    pub facts: Vec<Fact>,
    /// Whose crash it tells.
    pub origin: Origin,
    /// Who wrote it.
    pub author: Author,
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    crate::formats::known(deserializer, NARRATIVE_FORMAT)
}

impl Narrative {
    /// The record whose crash is told; none where it is invented.
    pub fn told_record(&self) -> Option<&RecordRef> {
        match &self.origin {
            Origin::Own => self.records.first(),
            Origin::Other { record, .. } => Some(record),
            Origin::Invented { .. } => None,
        }
    }

    /// The records it was made from: the told one first, so that no cut loses it.
    pub fn sources(&self) -> Vec<RecordRef> {
        let told = self.told_record();
        let others = self.records.iter().filter(|record| Some(*record) != told);
        told.into_iter().chain(others).cloned().collect()
    }
}

/// One fact and where it came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fact {
    /// What is stated.
    pub value: FactValue,
    /// Where it came from.
    pub source: FactSource,
}

/// What a fact states. `sv` is the ego, `cp` the crash partner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", tag = "fact")]
pub enum FactValue {
    /// From where the partner came, seen from the ego before any turn.
    Approach {
        /// Side.
        approach: Approach,
    },
    /// Movement of the ego.
    SvMovement {
        /// Movement.
        movement: Movement,
    },
    /// Movement of the partner.
    CpMovement {
        /// Movement.
        movement: Movement,
    },
    /// Kind of partner.
    Partner {
        /// Kind.
        kind: PartnerKind,
    },
    /// Speed of the ego before the conflict.
    SvSpeed {
        /// Speed. [m/s]
        speed_mps: f64,
    },
    /// Speed of the partner before the conflict.
    CpSpeed {
        /// Speed. [m/s]
        speed_mps: f64,
    },
    /// Lane of the ego.
    SvLane {
        /// Lane.
        lane: LanePosition,
    },
    /// Lane of the partner.
    CpLane {
        /// Lane.
        lane: LanePosition,
    },
    /// Lane of a partner on the ego's own road, seen from the ego.
    CpLaneOffset {
        /// Lanes to the right of the ego (negative: left).
        lanes: i8,
    },
    /// What the ego's signal or sign showed.
    SvSignal {
        /// Signal.
        signal: Signal,
    },
    /// What the partner's signal or sign showed.
    CpSignal {
        /// Signal.
        signal: Signal,
    },
    /// Who reached the place of the conflict first.
    Order {
        /// Who.
        first: FirstMover,
    },
    /// A sideways move of the partner out of its lane.
    CpLateral {
        /// Towards the partner's own left or right.
        towards: Side,
        /// What kind of move.
        kind: LateralKind,
    },
    /// Something the partner did along its lane.
    CpAction {
        /// What.
        action: LongitudinalAction,
    },
    /// Something the ego did along its lane.
    SvAction {
        /// What.
        action: LongitudinalAction,
    },
    /// Contact zones.
    Contact {
        /// On the ego.
        sv: Vec<ContactZone>,
        /// On the partner.
        cp: Vec<ContactZone>,
    },
    /// The kind of collision the record describes.
    Collision {
        /// Kind.
        kind: CollisionKind,
    },
    /// The intersection has three arms.
    ThreeWay {
        /// Which arm is missing, seen from the ego.
        missing: MissingArm,
    },
    /// Static obstacles.
    Obstacles {
        /// Kind.
        kind: ObstacleKind,
        /// On which side of the ego's lane.
        side: Side,
    },
}

impl FactValue {
    /// The ego's speed, of a fact that is one. [m/s]
    pub fn sv_speed(&self) -> Option<f64> {
        match self {
            Self::SvSpeed { speed_mps } => Some(*speed_mps),
            _ => None,
        }
    }

    /// The partner's speed, of a fact that is one. [m/s]
    pub fn cp_speed(&self) -> Option<f64> {
        match self {
            Self::CpSpeed { speed_mps } => Some(*speed_mps),
            _ => None,
        }
    }
}

/// A lane, counted on its own approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LanePosition {
    /// Leftmost.
    Leftmost,
    /// Between.
    Middle,
    /// Rightmost.
    Rightmost,
}

/// A traffic control as one road user sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Signal {
    /// Green light.
    Green,
    /// Yellow light.
    Yellow,
    /// Red light.
    Red,
    /// Stop sign.
    StopSign,
    /// Yield sign.
    YieldSign,
    /// No control named.
    Uncontrolled,
}

/// A sideways move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LateralKind {
    /// Part of the way over the line, not meant.
    Drift,
    /// A lane change.
    LaneChange,
    /// A lane change into a short gap before the other.
    CutIn,
    /// A turn that runs wide, or cuts the corner.
    WideTurn,
}

/// Something done along the lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LongitudinalAction {
    /// Braked or slowed.
    Braked,
    /// Braked hard or stopped suddenly.
    BrakedHard,
    /// Came to a stop.
    Stopped,
    /// Stood still before the conflict.
    WasStopped,
    /// Set off or sped up.
    Accelerated,
    /// Yielded to another road user.
    Yielded,
}

/// Where a fact came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", tag = "from")]
pub enum FactSource {
    /// A column of the record.
    Column {
        /// Record.
        record: RecordRef,
        /// Column name, or a common name for a group of columns.
        column: String,
        /// What stood there.
        text: String,
    },
    /// Words of the record's narrative.
    Words {
        /// Record.
        record: RecordRef,
        /// The words, as they stand there.
        words: String,
    },
    /// Assumed.
    Assumed {
        /// Why this value.
        why: String,
    },
}
