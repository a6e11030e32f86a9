//! Templates: one combination of the categorical columns ("meta variables") a simulator can express.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of road, from the column `Roadway Type`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoadType {
    /// `Intersection`.
    Intersection,
    /// `Traffic Circle`: a roundabout.
    TrafficCircle,
    /// `Highway / Freeway`.
    Highway,
    /// `Street`.
    Street,
    /// `Parking Lot`.
    ParkingLot,
    /// `Rural Road`.
    RuralRoad,
    /// `Parking Garage`.
    ParkingGarage,
    /// `Unpaved Road`.
    UnpavedRoad,
}

impl RoadType {
    /// Every value, in the order of tables.
    pub const ALL: [Self; 8] = [
        Self::Intersection,
        Self::Highway,
        Self::TrafficCircle,
        Self::Street,
        Self::ParkingLot,
        Self::RuralRoad,
        Self::ParkingGarage,
        Self::UnpavedRoad,
    ];

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Intersection => "Intersection",
            Self::TrafficCircle => "Traffic circle",
            Self::Highway => "Highway / freeway",
            Self::Street => "Street",
            Self::ParkingLot => "Parking lot",
            Self::RuralRoad => "Rural road",
            Self::ParkingGarage => "Parking garage",
            Self::UnpavedRoad => "Unpaved road",
        }
    }

    /// For identifiers and file names.
    pub fn slug(self) -> &'static str {
        match self {
            Self::Intersection => "intersection",
            Self::TrafficCircle => "circle",
            Self::Highway => "highway",
            Self::Street => "street",
            Self::ParkingLot => "parking",
            Self::RuralRoad => "rural",
            Self::ParkingGarage => "garage",
            Self::UnpavedRoad => "unpaved",
        }
    }
}

/// What a vehicle was doing before the crash, from the columns `... Pre-Crash Movement`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Movement {
    /// `Proceeding Straight`.
    Straight,
    /// `Making Left Turn`.
    LeftTurn,
    /// `Making Right Turn`.
    RightTurn,
    /// `Making U-Turn`.
    UTurn,
    /// `Changing Lanes`.
    ChangingLanes,
    /// `Merging`.
    Merging,
    /// `Passing`.
    Passing,
    /// `Stopped`.
    Stopped,
    /// `Parked`.
    Parked,
    /// `Parking Maneuver`.
    ParkingManeuver,
    /// `Backing`.
    Backing,
    /// `Entering Traffic`.
    EnteringTraffic,
    /// `Lane / Road Departure`.
    LaneDeparture,
    /// `Crossing into Opposing Lane`.
    CrossingIntoOpposingLane,
    /// `Traveling Wrong Way`.
    WrongWay,
    /// `NM Crossing Roadway`: a non-motorist moving across the roadway.
    NmCrossing,
    /// `NM Waiting to Cross Roadway`.
    NmWaiting,
    /// `NM Moving Alongside Roadway`: along the side of the roadway, not on a sidewalk.
    NmAlongside,
    /// `NM Moving on Sidewalk`.
    NmOnSidewalk,
    /// `NM in Roadway - Other`: a non-motorist moving in the roadway, with or against the flow.
    NmInRoadway,
}

impl Movement {
    /// The three movements of the paper, in the order of its tables.
    pub const PAPER: [Self; 3] = [Self::Straight, Self::LeftTurn, Self::RightTurn];

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Straight => "Proceeding straight",
            Self::LeftTurn => "Left turn",
            Self::RightTurn => "Right turn",
            Self::UTurn => "U-turn",
            Self::ChangingLanes => "Changing lanes",
            Self::Merging => "Merging",
            Self::Passing => "Passing",
            Self::Stopped => "Stopped",
            Self::Parked => "Parked",
            Self::ParkingManeuver => "Parking",
            Self::Backing => "Backing",
            Self::EnteringTraffic => "Entering traffic",
            Self::LaneDeparture => "Lane departure",
            Self::CrossingIntoOpposingLane => "Crossing into opposing lane",
            Self::WrongWay => "Wrong way",
            Self::NmCrossing => "Crossing (non-motorist)",
            Self::NmWaiting => "Waiting to cross (non-motorist)",
            Self::NmAlongside => "Alongside the road (non-motorist)",
            Self::NmOnSidewalk => "On the sidewalk (non-motorist)",
            Self::NmInRoadway => "In the road (non-motorist)",
        }
    }

    /// For identifiers and file names.
    pub fn slug(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::LeftTurn => "left",
            Self::RightTurn => "right",
            Self::UTurn => "uturn",
            Self::ChangingLanes => "lanechange",
            Self::Merging => "merging",
            Self::Passing => "passing",
            Self::Stopped => "stopped",
            Self::Parked => "parked",
            Self::ParkingManeuver => "parking",
            Self::Backing => "backing",
            Self::EnteringTraffic => "entering",
            Self::LaneDeparture => "departure",
            Self::CrossingIntoOpposingLane => "opposing",
            Self::WrongWay => "wrongway",
            Self::NmCrossing => "nmcrossing",
            Self::NmWaiting => "nmwaiting",
            Self::NmAlongside => "nmalongside",
            Self::NmOnSidewalk => "nmsidewalk",
            Self::NmInRoadway => "nminroad",
        }
    }
}

/// A template: the paper's four meta variables. `sv` is the subject vehicle (the ego), `cp` the crash partner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Template {
    /// Road type.
    pub road: RoadType,
    /// Movement of the subject vehicle.
    pub sv: Movement,
    /// Movement of the crash partner.
    pub cp: Movement,
    /// Whether the crash lay in a work zone.
    pub work_zone: bool,
}

impl Template {
    /// For identifiers and file names, such as `intersection-straight-left-wz`: road, SV, CP, work zone.
    pub fn slug(&self) -> String {
        let zone = if self.work_zone { "-wz" } else { "" };
        format!("{}-{}-{}{zone}", self.road.slug(), self.sv.slug(), self.cp.slug())
    }
}

impl std::fmt::Display for Template {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let zone = if self.work_zone { ", work zone" } else { "" };
        write!(
            f,
            "{}, SV {}, CP {}{zone}",
            self.road.label(),
            self.sv.label().to_lowercase(),
            self.cp.label().to_lowercase()
        )
    }
}
