//! From a story to the words of a report: what the partner is called, where it happened, how it ended.

use super::entities::Entity;
use super::story::{From, Partners, Story};
use recrash_model::account::{ContactState, CrashType};
use recrash_model::seed::Rng;
use recrash_model::template::RoadType;
use recrash_model::zones::ContactZone;

/// One of `items`.
pub fn pick<T: Copy>(rng: &mut Rng, items: &[T]) -> T {
    items[rng.below(items.len())]
}

/// True with this probability.
pub fn chance(rng: &mut Rng, probability: f64) -> bool {
    rng.uniform() < probability
}

/// A whole number in `low..=high`.
pub fn between(rng: &mut Rng, (low, high): (u32, u32)) -> u32 {
    low + rng.below((high - low + 1) as usize) as u32
}

/// A partner: value of `Crash With`, as first named, as named after that.
pub type Partner = (&'static str, &'static str, &'static str);

const CARS: &[Partner] = &[
    ("Passenger Car", "a gray sedan", "the sedan"),
    ("Passenger Car", "a white hatchback", "the hatchback"),
    ("Passenger Car", "a passenger car", "the passenger car"),
    ("Passenger Car", "a rideshare sedan", "the sedan"),
    ("Passenger Car", "a compact car", "the compact car"),
    ("Passenger Car", "a blue coupe", "the coupe"),
    ("SUV", "an SUV", "the SUV"),
    ("SUV", "a black SUV", "the SUV"),
    ("SUV", "a mid-size sport utility vehicle", "the sport utility vehicle"),
];
const OTHERS: &[Partner] = &[
    ("Pickup Truck", "a pickup truck", "the pickup"),
    ("Pickup Truck", "a red pickup", "the pickup"),
    ("Pickup Truck", "a pickup truck", "the pickup truck"),
    ("Heavy Truck", "a box truck", "the box truck"),
    ("Heavy Truck", "a flatbed truck", "the flatbed truck"),
    ("Van", "a delivery van", "the van"),
    ("Van", "a minivan", "the minivan"),
    ("Bus", "a city bus", "the bus"),
    ("First Responder Vehicle", "a police car", "the police car"),
    ("Other, see Narrative", "a golf cart", "the golf cart"),
];
const TRUCKS: &[Partner] = &[
    ("Heavy Truck", "a tractor-trailer", "the tractor-trailer"),
    ("Heavy Truck", "a tanker truck", "the tanker"),
    ("Heavy Truck", "a dump truck", "the dump truck"),
];
pub const CYCLISTS: &[Partner] = &[
    ("Non-Motorist: Cyclist", "a cyclist", "the cyclist"),
    ("Non-Motorist: Cyclist", "a person on a bicycle", "the bicyclist"),
];
pub const SCOOTERS: &[Partner] = &[("Non-Motorist: Other", "a person on an electric scooter", "the scooter rider")];
pub const WALKERS: &[Partner] = &[("Non-Motorist: Pedestrian", "a pedestrian", "the pedestrian")];
pub const MOTORCYCLES: &[Partner] =
    &[("Motorcycle", "a motorcycle", "the motorcycle"), ("Motorcycle", "a moped", "the moped")];
pub const ANIMALS: &[Partner] =
    &[("Animal", "a deer", "the deer"), ("Animal", "a dog", "the dog"), ("Animal", "a coyote", "the coyote")];
pub const DELIVERY_ROBOTS: &[Partner] = &[("Other, see Narrative", "a delivery robot", "the delivery robot")];
pub const CARGO: &[Partner] = &[("Heavy Truck", "a flatbed truck", "the flatbed truck")];
pub const PARKED_CARS: &[Partner] = &[
    ("Passenger Car", "a parked sedan", "the parked sedan"),
    ("SUV", "a parked SUV", "the parked SUV"),
    ("Pickup Truck", "a parked pickup truck", "the parked pickup truck"),
];
pub const DEBRIS: &[Partner] = &[
    ("Other, see Narrative", "a piece of metal debris", "the debris"),
    ("Other Fixed Object", "a strip of tire", "the strip of tire"),
    ("Other, see Narrative", "a wooden pallet", "the pallet"),
    ("Other Fixed Object", "a fallen branch", "the branch"),
];
pub const LOOSE: &[Partner] = &[
    ("Other, see Narrative", "an empty shopping cart", "the shopping cart"),
    ("Other, see Narrative", "a trash can", "the trash can"),
];
pub const CURBS: &[Partner] =
    &[("Other Fixed Object", "the curb", "the curb"), ("Other Fixed Object", "a raised curb", "the curb")];
pub const POTHOLES: &[Partner] =
    &[("Other Fixed Object", "a pothole", "the pothole"), ("Other, see Narrative", "a deep pothole", "the pothole")];
pub const CHAINS: &[Partner] =
    &[("Other Fixed Object", "a chain", "the chain"), ("Other Fixed Object", "a metal chain", "the chain")];
pub const GATES: &[Partner] =
    &[("Other Fixed Object", "a gate arm", "the gate arm"), ("Other Fixed Object", "an automatic gate", "the gate")];
pub const CONES: &[Partner] = &[
    ("Other Fixed Object", "a traffic cone", "the traffic cone"),
    ("Other Fixed Object", "a construction barrel", "the barrel"),
];
pub const POLES: &[Partner] =
    &[("Pole / Tree", "a metal pole", "the pole"), ("Pole / Tree", "a sign post", "the sign post")];

pub const WIDE: &[Partner] = &[
    ("Heavy Truck", "a garbage truck", "the garbage truck"),
    ("Bus", "a city bus", "the bus"),
    ("Heavy Truck", "a box truck", "the box truck"),
    ("Heavy Truck", "a cement truck", "the cement truck"),
];

/// A partner of the kind the story can have.
pub fn partner(rng: &mut Rng, partners: Partners) -> Partner {
    match partners {
        Partners::Of(these) => pick(rng, these),
        Partners::Trucks if chance(rng, 0.6) => pick(rng, TRUCKS),
        _ if chance(rng, 0.75) => pick(rng, CARS),
        _ => pick(rng, OTHERS),
    }
}

/// Where it happened.
pub struct Place {
    pub city: &'static str,
    pub state: &'static str,
    street: &'static str,
    cross: &'static str,
    heading: usize,
}

const CITIES: &[(&str, &str)] = &[
    ("Port Alder", "CA"),
    ("Lakemont Springs", "AZ"),
    ("Cedar Flats", "TX"),
    ("New Avery", "GA"),
    ("Harlow Bay", "CA"),
    ("Saltmarsh City", "FL"),
];
const STREETS: &[&str] = &[
    "Alder Street",
    "Quarry Road",
    "Juniper Avenue",
    "Second Street",
    "Mill Lane",
    "Pe\u{f1}a Avenue",
    "Harbor Boulevard",
    "Observatory Way",
    "Foundry Street",
    "Canal Street",
    "Orchard Drive",
    "Kestrel Avenue",
];
const HIGHWAYS: &[&str] = &["Route 88", "the Ridge Expressway", "the Inland Freeway", "Route 215"];
const HEADINGS: [&str; 4] = ["northbound", "eastbound", "southbound", "westbound"];

/// An invented place for this kind of road.
pub fn place(rng: &mut Rng, road: RoadType) -> Place {
    let (city, state) = pick(rng, CITIES);
    let first = rng.below(STREETS.len());
    let second = (first + 1 + rng.below(STREETS.len() - 1)) % STREETS.len();
    let street = if road == RoadType::Highway { pick(rng, HIGHWAYS) } else { STREETS[first] };
    Place { city, state, street, cross: STREETS[second], heading: rng.below(4) }
}

/// What one telling needs to know.
pub struct Facts<'a> {
    pub entity: &'a Entity,
    pub partner: Partner,
    pub place: &'a Place,
    pub month: &'static str,
    pub year: u32,
    pub clock: String,
    pub sv_mph: u32,
    pub cp_mph: u32,
    pub sv_zones: &'a [ContactZone],
    pub cp_zones: &'a [ContactZone],
    pub severity: &'static str,
}

/// The whole narrative of a story, told in the way of this number.
pub fn narrative(rng: &mut Rng, story: &Story, way: usize, facts: &Facts<'_>) -> String {
    let telling = story.tellings[way % story.tellings.len()];
    let (opening, impact) = (pick(rng, facts.entity.openings), pick(rng, story.impacts));
    let rolls = !matches!(story.state, ContactState::Stopped | ContactState::Parked);
    let taken_over = rolls && !facts.entity.taken_over.is_empty() && chance(rng, 0.6);
    let driver = pick(rng, if taken_over { facts.entity.taken_over } else { facts.entity.engaged });
    let on_foot = matches!(story.kind, CrashType::Cyclist | CrashType::Pedestrian);
    let outcome = outcome(rng, facts, story.cp.is_some() && !on_foot);
    let text = format!("{opening}{telling} {impact} {driver} {outcome}{}", facts.entity.closing);
    let filled = fill(rng, &text, story.from, facts);
    if chance(rng, 0.1) { with_a_slip(rng, &filled) } else { filled }
}

pub const IMPACTS: &[&str] = &[
    "The {cp_hit} of {it} made contact with the {sv_hit} of {sv}.",
    "Contact was between the {sv_hit} of {sv} and the {cp_hit} of {it}.",
    "{Sv} was touched at the {sv_hit} by the {cp_hit} of {it}.",
    "The impact was at the {sv_hit} of {sv}, with the {cp_hit} of {it}.",
    "Marks were found on the {sv_hit} of {sv} and on the {cp_hit} of the other vehicle.",
];
pub const IMPACTS_LIGHT: &[&str] = &[
    "{It} and {sv} made contact at the {sv_hit} of {sv}.",
    "Contact was with the {sv_hit} of {sv}. {It} fell and got up again.",
    "The {sv_hit} of {sv} was hit.",
];
pub const IMPACTS_OF_THINGS: &[&str] = &[
    "The {sv_hit} of {sv} made contact with {it}.",
    "Contact was with the {sv_hit} of {sv}.",
    "{Sv} stopped, and damage was found on its {sv_hit}.",
];
pub const IMPACTS_UNDERNEATH: &[&str] =
    &["The underside of {sv} was damaged.", "A tire of {sv} lost air.", "Damage was found on the underbody of {sv}."];
pub const IMPACTS_OF_ANIMALS: &[&str] =
    &["Contact was with the {sv_hit} of {sv}.", "The {sv_hit} of {sv} made contact with {it}. {It} ran off."];
pub const IMPACTS_OF_DOORS: &[&str] = &[
    "The door was bent, and the {cp_hit} of {it} was scratched.",
    "The door of {sv} was damaged at its edge.",
    "The contact was between the door and {it}.",
];

/// How it ended; with or without another party to speak of.
fn outcome(rng: &mut Rng, facts: &Facts<'_>, other_party: bool) -> &'static str {
    match facts.severity {
        "Minor" => pick(
            rng,
            &[
                "A passenger complained of neck pain and declined transport.",
                "A minor injury was reported.",
                "One passenger had a bruised knee.",
            ],
        ),
        "Moderate" => "One person was taken to hospital with moderate injuries.",
        "Serious" => "One person was seriously injured.",
        "Unknown" => pick(rng, &["It is not known if anyone was hurt.", "No details of the other party are known."]),
        _ if other_party => pick(
            rng,
            &[
                "No injuries were reported.",
                "Nobody was hurt.",
                "Damage was minor and there were no injuries.",
                "Both drove away. No injuries.",
                "A sensor housing was damaged; no one was injured.",
                "Both vehicles were damaged. No injuries were reported at the scene.",
                "The other party left without giving details. No injuries are known.",
                "Police were called and no injuries were reported.",
            ],
        ),
        _ => pick(
            rng,
            &[
                "No injuries were reported.",
                "Nobody was hurt.",
                "There was minor damage and no injury.",
                "One vehicle was towed. No injuries.",
            ],
        ),
    }
}

fn fill(rng: &mut Rng, text: &str, from: From, facts: &Facts<'_>) -> String {
    let turned = match from {
        From::Same => 0,
        From::Left => 1,
        From::Opposite => 2,
        From::Right => 3,
    };
    let place = facts.place;
    let (street, cross) = if facts.entity.masks { ("[XXX]", "[XXX]") } else { (place.street, place.cross) };
    let values = [
        ("sv", facts.entity.subject.to_owned()),
        ("cp", facts.partner.1.to_owned()),
        ("it", facts.partner.2.to_owned()),
        ("heading", HEADINGS[place.heading].to_owned()),
        // Coming from the left of a northbound vehicle is heading east, the next in clockwise order.
        ("cp_heading", HEADINGS[(place.heading + turned) % 4].to_owned()),
        ("street", street.to_owned()),
        ("cross", cross.to_owned()),
        ("at", speed(rng, facts.sv_mph, 0.6)),
        ("cp_at", speed(rng, facts.cp_mph, 0.5)),
        ("llane", pick(rng, &["the left lane", "the center lane", "the leftmost lane"]).to_owned()),
        ("rlane", pick(rng, &["the right lane", "the center lane", "the rightmost lane"]).to_owned()),
        (
            "lane",
            pick(rng, &["the left lane", "the right lane", "the rightmost lane", "the only through lane"]).to_owned(),
        ),
        ("sv_hit", zones(rng, facts.sv_zones)),
        ("cp_hit", zones(rng, facts.cp_zones)),
        ("month", facts.month.to_owned()),
        ("year", facts.year.to_string()),
        ("clock", facts.clock.clone()),
        ("city", place.city.to_owned()),
    ];
    let mut filled = text.to_owned();
    for (name, value) in values {
        filled = filled.replace(&format!("{{{name}}}"), &value);
        let (first, rest) = name.split_at(1);
        let (value_first, value_rest) = value.split_at(value.chars().next().map_or(0, char::len_utf8));
        let capital = format!("{}{value_rest}", value_first.to_uppercase());
        filled = filled.replace(&format!("{{{}{rest}}}", first.to_uppercase()), &capital);
    }
    filled
}

fn speed(rng: &mut Rng, mph: u32, probability: f64) -> String {
    if mph == 0 || !chance(rng, probability) {
        return String::new();
    }
    match rng.below(4) {
        0 => format!(" at about {mph} mph"),
        1 => format!(" at approximately {mph} miles per hour"),
        2 => format!(" at {mph} MPH"),
        _ => format!(" at {mph} mph"),
    }
}

/// Zones in words; the widest bumper damage is called by its middle.
fn zones(rng: &mut Rng, zones: &[ContactZone]) -> String {
    use ContactZone::{Bottom, Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};
    if zones.contains(&Front) && zones.len() == 3 {
        return pick(rng, &["front", "whole front"]).to_owned();
    }
    if zones.contains(&Rear) && zones.len() == 3 {
        return pick(rng, &["rear", "rear bumper"]).to_owned();
    }
    let words: Vec<&str> = zones
        .iter()
        .map(|zone| match zone {
            Front => pick(rng, &["front", "front bumper"]),
            FrontLeft => pick(rng, &["front left corner", "left front fender", "front driver side"]),
            FrontRight => pick(rng, &["front right corner", "right front fender", "front passenger side"]),
            Left => pick(rng, &["left side", "driver side"]),
            Right => pick(rng, &["right side", "passenger side"]),
            Rear => pick(rng, &["rear", "rear bumper"]),
            RearLeft => pick(rng, &["rear left corner", "left rear quarter"]),
            RearRight => pick(rng, &["rear right corner", "right rear quarter"]),
            Bottom => "underside",
            _ => "body",
        })
        .collect();
    words.join(" and ")
}

/// A slip of the pen, as people make them.
fn with_a_slip(rng: &mut Rng, text: &str) -> String {
    const SLIPS: &[(&str, &str)] = &[
        ("intersection", "intersecton"),
        ("stopped", "stoped"),
        (" behind ", " behnd "),
        (" which ", " wich "),
        ("contact", "conact"),
        (" the ", " teh "),
        ("proceed", "procede"),
        ("approximately", "aproximately"),
    ];
    let (right, wrong) = pick(rng, SLIPS);
    text.replacen(right, wrong, 1)
}
