//! Which words can say a fact. A quotation that holds none of them says something else, however true it is.

use crate::rules::pattern::Pattern;
use recrash_model::account::{
    Act, Compass, ContactState, Control, ControlDevice, Driver, FirstContact, Kind, KindGroup, LaneWord, Origin,
    PlaceKind, RoadFeature, StandReason, Striker,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

static BEHIND: Pattern = Pattern::new(r"\b(behind|rear|follow|trail|back of)");
static AHEAD: Pattern = Pattern::new(r"\b(ahead|front|lead|stopp|slow|queue|parked|preced|stationary)");
/// Things that lie or stand on somebody's way: their name is all that is told of where they are.
static LIES: Pattern = Pattern::new(
    r"\b(gate|barrier|bollard|pole|post|cone|debris|cur?b|kerb|median|island|wall|fence|tree|branch|pothole|sign|object|tire|tyre|wheel|pallet|box|ladder)",
);
static OPPOSITE: Pattern =
    Pattern::new(r"\b(opposite|opposing|oncoming|other way|toward|head-?on|(north|south|east|west)\w*bound)");
static LEFT: Pattern = Pattern::new(r"\b(left|driver'?s?[- ]side|north|south|east|west)");
static RIGHT: Pattern = Pattern::new(r"\b(right|passenger[- ]side|north|south|east|west)");
static BESIDE: Pattern = Pattern::new(
    r"\b(left|right|adjacent|next to|beside|alongside|lane|parallel|pass|overt|merg|side[- ]by[- ]side|side-?swip|graz)",
);
static LOT: Pattern = Pattern::new(r"\b(stall|parking|parked|space|spot)");
static DRIVEWAY: Pattern = Pattern::new(r"\b(driveway|alley|lot|garage|station|entrance|exit)");
static KERB: Pattern = Pattern::new(r"\b(park|curb|kerb|pulled? (out|away)|shoulder)");
static SIDEWALK: Pattern = Pattern::new(r"\b(sidewalk|curb|kerb|crosswalk|pavement)");
static ABOVE: Pattern = Pattern::new(r"\b(above|fell|fall|drop|gate|arm|tree|branch|over)");

static ONWARD: Pattern = Pattern::new(
    r"\b(straight|through|proceed|travel|continu|cross|enter|driv|drove|going|went|mov|head|(north|south|east|west)\w*bound|pass|approach|follow|slow|brak|com(e|ing)|came|traffic|flow|rode|rid|walk|run|ran|advanc|operat|oncoming|opposite|weav|return|clear)",
);
static LANE: Pattern = Pattern::new(r"\b(lane|merg|cut|drift|swerv|veer|encroach)");
static PASSING: Pattern =
    Pattern::new(r"\b(pass|overt|around|go(ing)? by|went by|past|alongside|next to|between|split|squeez)");
static TURNED_ROUND: Pattern = Pattern::new(r"u-?\s?turn");
static STOOD: Pattern =
    Pattern::new(r"\b(stop|station|stand|stood|wait|yield|idl|queue|rest|held|hold|halt|remain|paus)");
static PARKED: Pattern = Pattern::new(r"\bpark");
static BACKWARDS: Pattern = Pattern::new(r"\b(back|revers)");
static PULLS_OUT: Pattern = Pattern::new(r"\b(enter|pull|exit|leav|left|depart|merg|out of)");
static SETS_OFF: Pattern = Pattern::new(
    r"\b(start|began|begin|set off|accelerat|proceed|resum|pull|creep|inch|initiat|green|clear|releas|depart|left|leav)",
);
static SLOWS: Pattern = Pattern::new(r"\b(stop|station|stand|stood|wait|park|slow|brak|yield|queue|halt)");

static MEETS: Pattern = Pattern::new(
    r"\b(contact|struck|strik|hit|collid|collision|impact|crash|bump|scrap|side-?swip|swip|clip|rear[- ]?end|touch|into|brush|graz|on top of|r[au]n over|pinn)",
);
static DRIVES: Pattern = Pattern::new(
    r"\b(autonom|ads?\b|automat|manual|driver|operator|operation|level|engag|disengag|mode|control|took over|human|remote)",
);
static SPEED_CHANGE: Pattern = Pattern::new(r"\b(slow|brak|decel|stop|yield|halt|reduc|eas(ed|ing))");
static FASTER: Pattern = Pattern::new(r"\b(accel|speed|faster|hurr|race|sped)");
static SIDEWAYS: Pattern = Pattern::new(
    r"\b(lane|merg|cut|drift|swerv|veer|encroach|left|right|steer|mov|shift|cross|avoid|evas|evad|around|into|over|wide|swing|swung|nudg|weav|deflect|return)",
);
static TURNS: Pattern = Pattern::new(r"\b(turn|left|right|u-?\s?turn|maneuver|manoeuv|swing|swung)");
static ENTERS: Pattern = Pattern::new(
    r"\b(enter|into|emerg|cross|dart|step|ran|run|walk|rode|rid|approach|came|come|across|through|onto|in front|proceed)",
);
static SIGNAL: Pattern = Pattern::new(r"\b(red|green|yellow|amber|light|signal|phase|arrow)");
static STOP_SIGN: Pattern = Pattern::new(r"\bstop");
static YIELD: Pattern = Pattern::new(r"\b(yield|right[- ]of[- ]way|give way|gave way|without|fail)");
static PUSHED: Pattern = Pattern::new(
    r"\b(push|propel|forc|caus|into|struck|hit|throw|thrown|knock|spun|spin|contact|collid|impact|eject|deflect|shov|rear[- ]?end)",
);
static AGAINST: Pattern = Pattern::new(r"\b(wrong|oppos|against|oncoming)");
static FALLS: Pattern =
    Pattern::new(r"\b(fall|fell|drop|dislodg|lost|came off|detach|blew|blow|laid|lay|slid|tip|trip)");
static LOSES: Pattern =
    Pattern::new(r"\b(control|spin|spun|skid|slid|hydroplan|lost|slip|fish|overturn|tip|roll\w* (over|onto))");
static ROLLS: Pattern = Pattern::new(r"\b(roll|drift|unoccupied|slid|mov)");
static LEAVES: Pattern = Pattern::new(
    r"\b(left|leav|fled|flee|depart|drove (off|away)|continu|proceed|rode|ran|fail\w* to (stop|remain|exchange|stay)|without)",
);
static DIRECTION: Pattern = Pattern::new(r"\b(north|south|east|west)");
static BESIDE_LANE: Pattern = Pattern::new(
    r"\b(lane|shoulder|curb|kerb|sidewalk|bike|bicycle|bus|lot|side|park|pulled over|oppos|oncoming|line)",
);
static OVER_LINE: Pattern = Pattern::new(
    r"\b(lane|line|partial|partly|half|strad|encroach|over|into|across|curb|kerb|protrud|intrud|block|angle|stick|(center|centre|middle) of)",
);
static AHEAD_OF: Pattern = Pattern::new(r"\b(ahead|behind|front|lead|pass|overt|past|follow|back|approach|rear)");
static ARMS: Pattern = Pattern::new(r"\b(way|leg|arm|intersect|junction|four|three|t-|fork|driveway|street|road)");
static NUMBER: Pattern = Pattern::new(
    r"(\d+(?:\.\d+)?)[- ]*(mph|miles? (?:per|an) hour|km/h|kph|kilomet\w+ per hour|m/s|mps|met\w+ per second)",
);

/// Whether words can say from where the partner came.
pub fn origin(from: Origin, words: &str) -> bool {
    use recrash_model::account::LeftRight;
    let side = |side: LeftRight| match side {
        LeftRight::Left => LEFT.is_match(words),
        LeftRight::Right => RIGHT.is_match(words),
    };
    match from {
        Origin::Behind => BEHIND.is_match(words) || PASSING.is_match(words),
        Origin::Ahead => [&AHEAD, &MEETS, &PASSING, &LIES].iter().any(|pattern| pattern.is_match(words)),
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

/// Whether words can say where somebody else is: "behind a bus" says that the bus is ahead.
pub fn whereabouts(at: Origin, words: &str) -> bool {
    origin(at, words) || AHEAD_OF.is_match(words) || tells(words)
}

/// Whether words are of somebody who does something or is somewhere, and no bare name.
fn tells(words: &str) -> bool {
    let any = [&ONWARD, &LANE, &MEETS, &STOOD, &PARKED, &SIDEWAYS, &AHEAD_OF, &ENTERS, &TURNS, &YIELD];
    words.split_whitespace().count() > 2 && any.iter().any(|pattern| pattern.is_match(words))
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
            ONWARD.is_match(words) || SIDEWAYS.is_match(words) || MEETS.is_match(words) || TURNS.is_match(words)
        }
        ContactState::SettingOff => SETS_OFF.is_match(words),
        ContactState::Stopped => STOOD.is_match(words),
        ContactState::Parked => PARKED.is_match(words),
        ContactState::Reversing => BACKWARDS.is_match(words),
    }
}

/// Whether words can say how long somebody had stood.
pub fn slows(words: &str) -> bool {
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
            "passenger",
            "rider",
            "occupant",
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

/// Whether words can say that two touched.
pub fn meets(words: &str) -> bool {
    MEETS.is_match(words)
}

/// Facts about the contact.
pub trait Contacts {}

impl Contacts for Striker {}
impl Contacts for FirstContact {}

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
            unit if unit.starts_with("m/") || unit == "mps" || unit.starts_with("met") => 1.0,
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
        PlaceKind::Intersection => any(&[
            "intersect",
            "junction",
            "corner",
            "cross",
            "signal",
            "light",
            "stop",
            "turn",
            "right-of-way",
            "right of way",
        ]),
        PlaceKind::Highway => any(&["highway", "freeway", "interstate", "ramp", "expressway"]),
        PlaceKind::Circle => any(&["roundabout", "circle", "rotary"]),
        PlaceKind::ParkingLot => any(&["parking", "lot"]),
        PlaceKind::Garage => any(&["garage"]),
        PlaceKind::Alley => any(&["alley"]),
        PlaceKind::Driveway => any(&["driveway"]),
        PlaceKind::Street | PlaceKind::Other => true,
    }
}

/// Whether words can say what somebody did. There are more verbs of driving than any list has: a clause of somebody who drives will do.
pub fn act(act: Act, words: &str) -> bool {
    let drives = matches!(
        act,
        Act::Follow
            | Act::SetOff
            | Act::Pass
            | Act::LaneChange
            | Act::Drift
            | Act::Swerve
            | Act::PullOut
            | Act::Enter
            | Act::Cross
    );
    let of_act = match act {
        Act::Follow => {
            ONWARD.is_match(words) || LANE.is_match(words) || MEETS.is_match(words) || BEHIND.is_match(words)
        }
        Act::Slow => SPEED_CHANGE.is_match(words),
        Act::Accelerate => FASTER.is_match(words),
        Act::Stop => STOOD.is_match(words) || PARKED.is_match(words),
        // "A van behind it", "two cars on the shoulder": who is told at a place and does nothing.
        Act::Hold => {
            STOOD.is_match(words) || PARKED.is_match(words) || AHEAD_OF.is_match(words) || BESIDE_LANE.is_match(words)
        }
        Act::SetOff => {
            SETS_OFF.is_match(words) || ONWARD.is_match(words) || ROLLS.is_match(words) || TURNS.is_match(words)
        }
        Act::Reverse => BACKWARDS.is_match(words),
        Act::Pass => PASSING.is_match(words) || AHEAD_OF.is_match(words),
        Act::LaneChange | Act::Drift | Act::Swerve => {
            SIDEWAYS.is_match(words) || PULLS_OUT.is_match(words) || TURNS.is_match(words)
        }
        Act::Turn => TURNS.is_match(words),
        Act::UTurn => TURNED_ROUND.is_match(words) || TURNS.is_match(words),
        Act::PullOut => PULLS_OUT.is_match(words) || SETS_OFF.is_match(words) || BACKWARDS.is_match(words),
        Act::PullOver => KERB.is_match(words) || words.contains("pull") || words.contains("side"),
        Act::Park => PARKED.is_match(words),
        Act::OpenDoor => words.contains("door") || words.contains("open"),
        Act::Cross | Act::Enter => ENTERS.is_match(words),
        Act::RunRed => SIGNAL.is_match(words),
        Act::RunStop => STOP_SIGN.is_match(words),
        Act::FailToYield => YIELD.is_match(words) || STOP_SIGN.is_match(words),
        Act::Pushed => PUSHED.is_match(words),
        Act::WrongWay => AGAINST.is_match(words),
        Act::Fall => FALLS.is_match(words),
        Act::LoseControl => LOSES.is_match(words),
        Act::Roll => ROLLS.is_match(words),
        Act::Leave => LEAVES.is_match(words),
    };
    of_act || (drives && tells(words))
}

/// Whether words can say why somebody stood.
pub fn reason(reason: StandReason, words: &str) -> bool {
    let any = |names: &[&str]| names.iter().any(|name| words.contains(name));
    match reason {
        StandReason::PickupDropoff => any(&["passenger", "pick", "drop", "rider", "board", "exit", "deliver"]),
        StandReason::Yield => {
            YIELD.is_match(words) || SLOWS.is_match(words) || any(&["allow", "let ", "for ", "respon"])
        }
        StandReason::Queue | StandReason::LeadVehicle => any(&[
            "traffic", "queue", "congest", "line", "vehicle", "car", "truck", "van", "bus", "ahead", "front", "behind",
        ]),
        StandReason::RedLight => SIGNAL.is_match(words),
        StandReason::StopSign => STOP_SIGN.is_match(words),
        StandReason::Parked => PARKED.is_match(words),
        StandReason::Pedestrian => any(&[
            "pedest",
            "person",
            "people",
            "walk",
            "cycl",
            "bike",
            "scooter",
            "child",
            "man",
            "individual",
            "guard",
            "rider",
            "passenger",
            "step",
        ]),
        StandReason::BlockedPath => words.split_whitespace().count() > 1,
        StandReason::BlockedJunction => any(&["intersect", "junction", "crosswalk", "box", "block"]),
        StandReason::Animal => words.chars().any(char::is_alphabetic),
        StandReason::EmergencyVehicle => any(&["emergen", "police", "fire", "ambul", "siren", "respond", "law"]),
        StandReason::Barrier => any(&["rail", "gate", "toll", "train", "tram", "arm", "barrier", "crossing"]),
    }
}

/// Whether words can name a direction.
pub fn compass(_: Compass, words: &str) -> bool {
    DIRECTION.is_match(words)
}

/// Whether words can name a lane.
pub fn lane(_: LaneWord, words: &str) -> bool {
    BESIDE_LANE.is_match(words)
}

/// Whether words can say that a body reaches over a line.
pub fn astride(words: &str) -> bool {
    OVER_LINE.is_match(words)
}

/// Whether words can say who was ahead of whom.
pub fn ahead(words: &str) -> bool {
    AHEAD_OF.is_match(words) || BESIDE.is_match(words)
}

/// Whether words can say how many arms a junction has.
pub fn arms(words: &str) -> bool {
    ARMS.is_match(words)
}

/// Whether words can name a signal or sign.
pub fn control(control: Control, words: &str) -> bool {
    match control.device {
        ControlDevice::Signal => SIGNAL.is_match(words),
        ControlDevice::StopSign => STOP_SIGN.is_match(words) || words.contains("sign"),
        ControlDevice::YieldSign => YIELD.is_match(words),
    }
}

/// Whether words can name what a road has.
pub fn feature(feature: RoadFeature, words: &str) -> bool {
    let stems: &[&str] = match feature {
        RoadFeature::Intersection => &[
            "intersect",
            "junction",
            "corner",
            "turn",
            "cross",
            "right-of-way",
            "right of way",
            "traffic light",
            "red light",
        ],
        RoadFeature::Signal => &["signal", "light", "green", "red"],
        RoadFeature::StopSign => &["stop"],
        RoadFeature::YieldSign => &["yield"],
        RoadFeature::ParkingLane => &["park"],
        RoadFeature::TurnLane => &["turn"],
        RoadFeature::BusLane => &["bus", "transit"],
        RoadFeature::BikeLane => &["bike", "bicycle", "cycl"],
        RoadFeature::CarpoolLane => &["carpool", "hov", "occupancy"],
        RoadFeature::Driveway => &["driveway", "entrance", "exit"],
        RoadFeature::ParkingLot => &["lot", "parking"],
        RoadFeature::Garage => &["garage"],
        RoadFeature::Stall => &["stall", "space", "spot"],
        RoadFeature::Crosswalk => &["crosswalk"],
        RoadFeature::Sidewalk => &["sidewalk"],
        RoadFeature::Ramp => &["ramp"],
        RoadFeature::Merge => &["merg"],
        RoadFeature::NarrowStreet => &["narrow", "single lane", "one lane"],
        RoadFeature::OneWay => &["one-way", "one way"],
        RoadFeature::CulDeSac => &["cul", "dead", "court"],
        RoadFeature::Median => &["median", "island"],
        RoadFeature::Gate => &["gate"],
        RoadFeature::Alley => &["alley"],
        RoadFeature::WorkZone => &["work", "construction", "cone"],
        RoadFeature::Shoulder => &["shoulder"],
        RoadFeature::DoubleYellowLine => &["yellow"],
        RoadFeature::Roundabout => &["roundabout", "circle", "rotary"],
        RoadFeature::Rails => &["rail", "track"],
        RoadFeature::Bend => &["bend", "curve"],
        RoadFeature::Slope => &["hill", "slope", "grade", "incline"],
    };
    stems.iter().any(|stem| words.contains(stem))
}
