//! Which words can say a fact. A quotation that holds none of them says something else, however true it is.

use crate::rules::pattern::Pattern;
use recrash_model::account::{
    ContactState, Driver, FirstContact, Kind, KindGroup, Origin, PlaceKind, Standing, Striker,
};
use recrash_model::narrative::FirstMover;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

static BEHIND: Pattern = Pattern::new(r"\b(behind|rear|follow|trail|back of)");
static AHEAD: Pattern = Pattern::new(r"\b(ahead|front|lead|stopp|slow|queue|parked|preced|stationary)");
static OPPOSITE: Pattern =
    Pattern::new(r"\b(opposite|opposing|oncoming|other way|toward|head-?on|(north|south|east|west)\w*bound)");
static LEFT: Pattern = Pattern::new(r"\b(left|driver'?s?[- ]side|north|south|east|west)");
static RIGHT: Pattern = Pattern::new(r"\b(right|passenger[- ]side|north|south|east|west)");
static BESIDE: Pattern = Pattern::new(
    r"\b(left|right|adjacent|next to|beside|alongside|lane|parallel|pass|overt|merg|side[- ]by[- ]side|side-?swip)",
);
static LOT: Pattern = Pattern::new(r"\b(stall|parking|parked|space|spot)");
static DRIVEWAY: Pattern = Pattern::new(r"\b(driveway|alley|lot|garage|station|entrance|exit)");
static KERB: Pattern = Pattern::new(r"\b(park|curb|kerb|pulled? (out|away)|shoulder)");
static SIDEWALK: Pattern = Pattern::new(r"\b(sidewalk|curb|kerb|crosswalk|pavement)");
static ABOVE: Pattern = Pattern::new(r"\b(above|fell|fall|drop|gate|arm|tree|branch|over)");

static ONWARD: Pattern = Pattern::new(
    r"\b(straight|through|proceed|travel|continu|cross|enter|driv|drove|going|went|mov|head|(north|south|east|west)\w*bound|pass|approach|follow|slow|brak)",
);
static LANE: Pattern = Pattern::new(r"\b(lane|merg|cut|drift|swerv|veer|encroach)");
static PASSING: Pattern = Pattern::new(r"\b(pass|overt|around|go by|went by)");
static TURNED_ROUND: Pattern = Pattern::new(r"u-?\s?turn");
static STOOD: Pattern = Pattern::new(r"\b(stop|station|stand|stood|wait|yield|idl|queue|rest|held|hold|halt|remain)");
static PARKED: Pattern = Pattern::new(r"\bpark");
static BACKWARDS: Pattern = Pattern::new(r"\b(back|revers)");
static PULLS_OUT: Pattern = Pattern::new(r"\b(enter|pull|exit|leav|left|depart|merg|out of)");
static SETS_OFF: Pattern = Pattern::new(r"\b(start|began|begin|set off|accelerat|proceed|resum|pull|creep|inch)");
static SLOWS: Pattern = Pattern::new(r"\b(stop|station|stand|stood|wait|park|slow|brak|yield|queue|halt)");

static MEETS: Pattern = Pattern::new(
    r"\b(contact|struck|strik|hit|collid|collision|impact|crash|bump|scrap|side-?swip|swip|clip|rear[- ]?end|touch|into|brush|graz)",
);
static FIRST: Pattern = Pattern::new(
    r"\b(first|before|after|already|ahead|behind|stopp|wait|station|yield|enter|cross|in front|path|complet|middle|late|then|when|contact|struck|hit|cut)",
);
static DRIVES: Pattern = Pattern::new(
    r"\b(autonom|ads?\b|automat|manual|driver|operator|engag|disengag|mode|control|took over|human|remote)",
);
static NUMBER: Pattern = Pattern::new(
    r"(\d+(?:\.\d+)?)[- ]*(mph|miles? (?:per|an) hour|km/h|kph|kilomet\w+ per hour|m/s|met\w+ per second)",
);

/// Whether words can say from where the partner came.
pub fn origin(from: Origin, words: &str) -> bool {
    use recrash_model::account::LeftRight;
    let side = |side: LeftRight| match side {
        LeftRight::Left => LEFT.is_match(words),
        LeftRight::Right => RIGHT.is_match(words),
    };
    match from {
        Origin::Behind => BEHIND.is_match(words),
        Origin::Ahead => AHEAD.is_match(words),
        Origin::Opposite => OPPOSITE.is_match(words),
        Origin::Beside { side: _ } => BESIDE.is_match(words),
        Origin::Cross { side: from } => side(from),
        Origin::Stall { .. } => LOT.is_match(words),
        Origin::Driveway { .. } => DRIVEWAY.is_match(words),
        Origin::Parked { .. } => KERB.is_match(words),
        Origin::Sidewalk { .. } => SIDEWALK.is_match(words),
        Origin::Above => ABOVE.is_match(words),
    }
}

/// Whether words can say a movement.
pub fn movement(movement: Movement, words: &str) -> bool {
    match movement {
        Movement::Straight => ONWARD.is_match(words),
        Movement::LeftTurn => words.contains("left"),
        Movement::RightTurn => words.contains("right"),
        Movement::UTurn => TURNED_ROUND.is_match(words),
        Movement::ChangingLanes | Movement::Merging | Movement::LaneDeparture => LANE.is_match(words),
        Movement::Passing => PASSING.is_match(words),
        Movement::Stopped | Movement::NmWaiting => STOOD.is_match(words),
        Movement::Parked | Movement::ParkingManeuver => PARKED.is_match(words),
        Movement::Backing => BACKWARDS.is_match(words),
        Movement::EnteringTraffic => PULLS_OUT.is_match(words),
        _ => words.split_whitespace().count() > 1,
    }
}

/// Whether words can say the state at the contact.
pub fn state(state: ContactState, words: &str) -> bool {
    match state {
        ContactState::Moving => {
            ONWARD.is_match(words) || LANE.is_match(words) || MEETS.is_match(words) || words.contains("turn")
        }
        ContactState::SettingOff => SETS_OFF.is_match(words),
        ContactState::Stopped => STOOD.is_match(words),
        ContactState::Parked => PARKED.is_match(words),
        ContactState::Reversing => BACKWARDS.is_match(words),
    }
}

/// Whether words can say how long somebody had stood.
pub fn standing(_: Standing, words: &str) -> bool {
    SLOWS.is_match(words)
}

/// Whether words can name a kind. Cars are called by their makes, things by their names.
pub fn kind(kind: Kind, words: &str) -> bool {
    let any = |names: &[&str]| names.iter().any(|name| words.contains(name));
    match kind.group() {
        KindGroup::Motorcycle => any(&["motor", "moped", "scooter"]),
        KindGroup::Cyclist => any(&["cycl", "bike"]),
        KindGroup::OnFoot => any(&[
            "pedestrian",
            "person",
            "people",
            "walk",
            "scooter",
            "skat",
            "wheelchair",
            "man",
            "woman",
            "individual",
            "child",
            "jogger",
            "runner",
        ]),
        KindGroup::Car | KindGroup::Truck | KindGroup::Animal | KindGroup::Object | KindGroup::Other => {
            words.chars().any(char::is_alphabetic)
        }
    }
}

/// Whether words can say who moved into whom, or what touched what.
pub fn contact<T: Contacts>(_: T, words: &str) -> bool {
    MEETS.is_match(words)
}

/// Facts about the contact.
pub trait Contacts {}

impl Contacts for Striker {}
impl Contacts for FirstContact {}

/// Whether words can say who was first.
pub fn order(_: FirstMover, words: &str) -> bool {
    FIRST.is_match(words)
}

/// Whether words can say who drove.
pub fn driver(_: Driver, words: &str) -> bool {
    DRIVES.is_match(words)
}

/// Whether words name this speed: the number, in the unit that stands there.
pub fn speed(mps: f64, words: &str) -> bool {
    if mps < 0.5 && STOOD.is_match(words) {
        return true;
    }
    NUMBER.captures_iter(words).any(|found| {
        let number: f64 = found[1].parse().unwrap_or(f64::NAN);
        let unit = match &found[2] {
            unit if unit.starts_with("m/") || unit.starts_with("met") => 1.0,
            unit if unit.starts_with('k') => 1.0 / 3.6,
            _ => 0.447_04,
        };
        (number * unit - mps).abs() <= 0.5
    })
}

/// Whether words can name a place on a vehicle.
pub fn zone(zone: ContactZone, words: &str) -> bool {
    let any = |names: &[&str]| names.iter().any(|name| words.contains(name));
    match zone {
        ContactZone::Front | ContactZone::FrontLeft | ContactZone::FrontRight => {
            any(&["front", "hood", "head", "bumper", "fender"])
        }
        ContactZone::Rear | ContactZone::RearLeft | ContactZone::RearRight => {
            any(&["rear", "back", "tail", "trunk", "bumper", "quarter"])
        }
        ContactZone::Left => any(&["left", "driver", "side", "door", "mirror"]),
        ContactZone::Right => any(&["right", "passenger", "side", "door", "mirror"]),
        ContactZone::Top => any(&["top", "roof", "sensor", "lidar"]),
        ContactZone::Bottom => any(&["bottom", "under", "chassis", "wheel", "tire", "tyre"]),
    }
}

/// Whether words can name a kind of place.
pub fn place(kind: PlaceKind, words: &str) -> bool {
    let any = |names: &[&str]| names.iter().any(|name| words.contains(name));
    match kind {
        PlaceKind::Intersection => any(&["intersect", "junction", "corner", "crosswalk", "signal", "light", "stop"]),
        PlaceKind::Highway => any(&["highway", "freeway", "interstate", "ramp", "expressway"]),
        PlaceKind::Circle => any(&["roundabout", "circle", "rotary"]),
        PlaceKind::ParkingLot => any(&["parking", "lot"]),
        PlaceKind::Garage => any(&["garage"]),
        PlaceKind::Alley => any(&["alley"]),
        PlaceKind::Driveway => any(&["driveway"]),
        PlaceKind::Street | PlaceKind::Other => true,
    }
}
