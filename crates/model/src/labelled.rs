//! What a labelled or scored account says of one record: in the terms of the labels in `eval/labels.csv` and
//! `eval/accounts.csv`. What suites are built from is [`crate::account::Account`].

use crate::account::{ContactState, CrashType, Driver, FirstContact, Role, Striker};
use crate::conflict::{CollisionKind, FirstMover};
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
    /// Crash type.
    pub crash_type: Option<CrashType>,
    /// Whose move brought the conflict about.
    pub role: Option<Role>,
    /// Who moved into whom.
    pub striker: Option<Striker>,
    /// Whether the subject vehicle stood at the contact.
    pub sv_state: Option<Stance>,
    /// Since when it stood or moved.
    pub sv_since: Option<Since>,
    /// Who drove it at the contact.
    pub driver: Option<Driver>,
    /// The partner is a thing or an animal, of which no movement is asked.
    pub cp_unmoved: bool,
    /// From where the partner came, finer than `approach`.
    pub came_from: Option<CameFrom>,
    /// First harmful contact.
    pub first_contact: Option<FirstContact>,
    /// Speed of the subject vehicle at the contact. [m/s]
    pub sv_impact_mps: Option<f64>,
}

/// Whether somebody stood at the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stance {
    /// It stood.
    Standing,
    /// It moved.
    Moving,
}

impl From<ContactState> for Stance {
    fn from(state: ContactState) -> Self {
        if state.stands() { Self::Standing } else { Self::Moving }
    }
}

/// Since when somebody stood or moved at the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Since {
    /// It was parked.
    Parked,
    /// It had stood for a while.
    Long,
    /// It had only just come to a stop.
    Just,
    /// It had only just begun to move.
    SettingOff,
    /// It moved, and had done so for a while.
    UnderWay,
}

/// From where somebody came, seen from the subject vehicle before any turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CameFrom {
    /// From behind, in its lane.
    Behind,
    /// From ahead, going or facing the same way, or standing there.
    Ahead,
    /// From the next lane on the left.
    BesideLeft,
    /// From the next lane on the right.
    BesideRight,
    /// From the opposite direction.
    Opposite,
    /// From a crossing road, a driveway, a stall or the kerb on the left.
    Left,
    /// From a crossing road, a driveway, a stall or the kerb on the right.
    Right,
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
