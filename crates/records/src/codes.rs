//! Code tables of the SGO columns, quoted from NHTSA's data dictionary (`data-element-definitions.pdf`, sections 3.2 to
//! 3.4) and, where an edition spells a value otherwise, from that edition. Left: the value as published.

use crate::text::same_code;
use recrash_model::kinds::PartnerKind;
use recrash_model::record::{Coded, Engagement, Severity};
use recrash_model::surroundings::{Lighting, Surface};
use recrash_model::template::{Movement, RoadType};

/// A code table: published value, meaning.
pub type Table<T> = [(&'static str, T)];

/// Field 52, `Roadway Type`.
pub const ROAD_TYPES: &Table<RoadType> = &[
    ("Intersection", RoadType::Intersection),
    ("Street", RoadType::Street),
    ("Highway / Freeway", RoadType::Highway),
    ("Parking Lot", RoadType::ParkingLot),
    ("Traffic Circle", RoadType::TrafficCircle),
    ("Rural Road", RoadType::RuralRoad),
    ("Parking Garage", RoadType::ParkingGarage),
    ("Unpaved Road", RoadType::UnpavedRoad),
];

/// Fields 74 and 86, `CP Pre-Crash Movement` and `SV Pre-Crash Movement` (the `NM` values of non-motorists in the first
/// only).
pub const MOVEMENTS: &Table<Movement> = &[
    ("Proceeding Straight", Movement::Straight),
    ("Stopped", Movement::Stopped),
    ("Making Left Turn", Movement::LeftTurn),
    ("Making Right Turn", Movement::RightTurn),
    ("Making U-Turn", Movement::UTurn),
    ("Backing", Movement::Backing),
    ("Passing", Movement::Passing),
    ("Changing Lanes", Movement::ChangingLanes),
    ("Merging", Movement::Merging),
    ("Parked", Movement::Parked),
    ("Parking Maneuver", Movement::ParkingManeuver),
    ("Entering Traffic", Movement::EnteringTraffic),
    ("Lane / Road Departure", Movement::LaneDeparture),
    ("Crossing into Opposing Lane", Movement::CrossingIntoOpposingLane),
    ("Traveling Wrong Way", Movement::WrongWay),
    ("NM Crossing Roadway", Movement::NmCrossing),
    ("NM Waiting to Cross Roadway", Movement::NmWaiting),
    ("NM Moving Alongside Roadway", Movement::NmAlongside),
    ("NM Moving on Sidewalk", Movement::NmOnSidewalk),
    ("NM in Roadway - Other", Movement::NmInRoadway),
];

/// Field 72, `Crash With`.
pub const PARTNERS: &Table<PartnerKind> = &[
    ("Passenger Car", PartnerKind::PassengerCar),
    ("SUV", PartnerKind::Suv),
    ("Pickup Truck", PartnerKind::PickupTruck),
    ("Heavy Truck", PartnerKind::HeavyTruck),
    ("Van", PartnerKind::Van),
    ("Bus", PartnerKind::Bus),
    ("Motorcycle", PartnerKind::Motorcycle),
    ("First Responder Vehicle", PartnerKind::FirstResponder),
    ("Non-Motorist: Cyclist", PartnerKind::Cyclist),
    ("Non-Motorist: Pedestrian", PartnerKind::Pedestrian),
    ("Non-Motorist: Scooter - Skateboard", PartnerKind::OtherNonMotorist),
    ("Non-Motorist: Other", PartnerKind::OtherNonMotorist),
    ("Animal", PartnerKind::Animal),
    ("Pole / Tree", PartnerKind::FixedObject),
    ("Other Fixed Object", PartnerKind::FixedObject),
];

/// Field 73, `Highest Injury Severity Alleged`. The third edition writes `W/` and `W/O`, the dictionary `With` and
/// `Without`.
pub const SEVERITIES: &Table<Severity> = &[
    ("No Injuries Reported", Severity::None),
    ("No Injured Reported", Severity::None),
    ("Property Damage. No Injured Reported", Severity::None),
    ("Property Damage, No Injury", Severity::None),
    ("Minor", Severity::Minor),
    ("Minor W/O Hospitalization", Severity::Minor),
    ("Minor W/ Hospitalization", Severity::Minor),
    ("Minor Without Hospitalization", Severity::Minor),
    ("Minor With Hospitalization", Severity::Minor),
    ("Moderate", Severity::Moderate),
    ("Moderate W/O Hospitalization", Severity::Moderate),
    ("Moderate W/ Hospitalization", Severity::Moderate),
    ("Moderate Without Hospitalization", Severity::Moderate),
    ("Moderate With Hospitalization", Severity::Moderate),
    ("Serious", Severity::Serious),
    ("Serious W/O Hospitalization", Severity::Serious),
    ("Serious W/ Hospitalization", Severity::Serious),
    ("Serious Without Hospitalization", Severity::Serious),
    ("Serious With Hospitalization", Severity::Serious),
    ("Fatality", Severity::Fatality),
];

/// `... Was Vehicle Towed?` and `... Any Air Bags Deployed?` (first and second edition). Who has no vehicle, or none with air
/// bags, had none towed and none deployed.
pub const YES_OR_NO: &Table<bool> = &[("Yes", true), ("No", false), ("Not Applicable", false)];

/// `Roadway Surface` (first and second edition; the third has flags).
pub const SURFACES: &Table<Surface> =
    &[("Dry", Surface::Dry), ("Wet", Surface::Wet), ("Snow / Slush / Ice", Surface::SnowIce)];

/// `Lighting` (first and second edition).
pub const LIGHTINGS: &Table<Lighting> = &[
    ("Daylight", Lighting::Daylight),
    ("Dawn / Dusk", Lighting::DawnDusk),
    ("Dark - Lighted", Lighting::DarkLighted),
    ("Dark - Not Lighted", Lighting::DarkNotLighted),
    ("Dark - Unknown Lighting", Lighting::DarkUnknown),
];

/// Field 21, `Automation System Engaged?`.
pub const ENGAGEMENTS: &Table<Engagement> = &[("ADS", Engagement::Ads), ("ADAS", Engagement::Adas)];

/// How sure it is that the system was engaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngagementStatus {
    /// Engaged, or said to be.
    Engaged,
    /// Not engaged in the 30 s before the crash.
    NotEngaged,
}

/// Field 22, `Engagement Status` (third edition).
pub const ENGAGEMENT_STATUSES: &Table<EngagementStatus> = &[
    ("Verified Engaged", EngagementStatus::Engaged),
    ("Alleged Engaged", EngagementStatus::Engaged),
    ("Verified Not Engaged", EngagementStatus::NotEngaged),
];

/// Whether the road lay in a work zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoadDescription {
    /// It did.
    WorkZone,
    /// Something else was worth a word.
    NoWorkZone,
}

/// `Roadway Description` (first and second edition; the third has flags).
pub const ROAD_DESCRIPTIONS: &Table<RoadDescription> = &[
    ("No Unusual Conditions", RoadDescription::NoWorkZone),
    ("Work Zone", RoadDescription::WorkZone),
    ("Traffic Incident", RoadDescription::NoWorkZone),
    ("Missing / Degraded Markings", RoadDescription::NoWorkZone),
    ("Degraded Surface", RoadDescription::NoWorkZone),
];

/// `Report Type` of a row that reports no crash.
pub const NO_REPORT: &str = "No New or Updated Incident Reports";

/// Values that say "something else" and "not known", in every coded column.
const OTHERS: [&str; 2] = ["Other, see Narrative", "Other"];
const UNKNOWNS: [&str; 3] = ["Unknown", "Unknown, see Narrative", "Unk"];

/// Looks a cell up in its table.
pub fn look_up<T: Copy>(table: &Table<T>, cell: &str) -> Coded<T> {
    let cell = cell.trim();
    if cell.is_empty() {
        return Coded::Blank;
    }
    let as_published = table.iter().find(|(text, _)| *text == cell);
    if let Some((_, value)) = as_published.or_else(|| table.iter().find(|(text, _)| same_code(text, cell))) {
        return Coded::Known(*value);
    }
    if OTHERS.iter().any(|text| same_code(text, cell)) {
        Coded::Other
    } else if UNKNOWNS.iter().any(|text| same_code(text, cell)) {
        Coded::Unknown
    } else {
        Coded::Unlisted(cell.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_cell_has_its_meaning() {
        assert_eq!(look_up(ROAD_TYPES, "  traffic circle"), Coded::Known(RoadType::TrafficCircle));
        assert_eq!(look_up(MOVEMENTS, "Other, see Narrative"), Coded::Other);
        assert_eq!(look_up(ENGAGEMENTS, "Unknown, see Narrative"), Coded::Unknown);
        assert_eq!(look_up(MOVEMENTS, " "), Coded::Blank);
        assert_eq!(look_up(ROAD_TYPES, " Bridge "), Coded::Unlisted("Bridge".to_owned()));
    }
}
