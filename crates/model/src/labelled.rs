//! What a labelled or scored account says of one record: in the terms of the labels in `eval/labels.csv`. What suites are
//! built from is [`crate::account::Account`].

use crate::metrics::CollisionKind;
use crate::narrative::FirstMover;
use crate::scenario::Approach;
use crate::template::{Movement, RoadType};
use crate::zones::ContactZone;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What happened in one record, as far as it can be told. `sv` is the subject vehicle, `cp` the crash partner.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LabelledAccount {
    /// Where it happened.
    pub road: Option<RoadGroup>,
    /// Movement of the subject vehicle just before the conflict.
    pub sv_movement: Option<Movement>,
    /// Movement of the partner just before the conflict.
    pub cp_movement: Option<Movement>,
    /// From where the partner came, seen from the subject vehicle before any turn.
    pub approach: Option<Approach>,
    /// Who was at the place of the conflict first.
    pub order: Option<FirstMover>,
    /// Where the subject vehicle was touched; empty where that is not told.
    pub sv_zones: Vec<ContactZone>,
    /// Where the partner was touched; empty where that is not told.
    pub cp_zones: Vec<ContactZone>,
    /// Kind of collision, where it is one of ours.
    pub collision: Option<CollisionKind>,
    /// Whether that kind is one the profile excludes.
    pub excluded: Option<bool>,
}

/// Kinds of road that a reader of a narrative can tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoadGroup {
    /// At a junction, or on its approach because of it.
    Intersection,
    /// A street.
    Street,
    /// A highway or freeway.
    Highway,
    /// A roundabout.
    Circle,
    /// A parking lot.
    Parking,
    /// Anything else: a garage, a rural or an unpaved road.
    Other,
}

impl From<RoadType> for RoadGroup {
    fn from(road: RoadType) -> Self {
        match road {
            RoadType::Intersection => Self::Intersection,
            RoadType::Street => Self::Street,
            RoadType::Highway => Self::Highway,
            RoadType::TrafficCircle => Self::Circle,
            RoadType::ParkingLot => Self::Parking,
            RoadType::ParkingGarage | RoadType::RuralRoad | RoadType::UnpavedRoad => Self::Other,
        }
    }
}
