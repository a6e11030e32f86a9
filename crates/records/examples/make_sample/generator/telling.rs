//! From a story to the words of a report: who reports, what the partner is called, where it happened, how it ended.

use super::story::{From, Partners, Story};
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

/// A company that reports, with its ways. All are invented.
pub struct Entity {
    pub name: &'static str,
    pub operator: &'static str,
    pub id_prefix: u32,
    pub subject: &'static str,
    pub make: &'static str,
    pub model: &'static str,
    pub driver: &'static str,
    /// Masks streets and days as `[XXX]`, as NHTSA does.
    pub masks: bool,
    pub opening: &'static str,
    pub engaged: &'static [&'static str],
    pub closing: &'static str,
}

pub const ENTITIES: &[Entity] = &[
    Entity {
        name: "Northlight Robotics, Inc.",
        operator: "Northlight Robotics",
        id_prefix: 90101,
        subject: "the Northlight AV",
        make: "Northlight",
        model: "N3",
        driver: "None",
        masks: true,
        opening: "On {month} [XXX], {year} at {clock} a Northlight AV was in a crash with {cp} in {city}.\n",
        engaged: &[
            "The automated driving system was engaged.",
            "The ADS was driving throughout.",
            "The ADS was on and nobody was in the driver's seat.",
        ],
        closing: " Northlight will amend this report if it learns more.",
    },
    Entity {
        name: "Calder Autonomy",
        operator: "Calder Autonomy",
        id_prefix: 90102,
        subject: "the Calder test vehicle",
        make: "Quill",
        model: "Vantage",
        driver: "In-Vehicle (Commercial / Test)",
        masks: false,
        opening: "",
        engaged: &[
            "The vehicle was in autonomous mode with a test driver at the wheel.",
            "The test driver took over about one second before the contact.",
            "It was driving in autonomous mode.",
        ],
        closing: "",
    },
    Entity {
        name: "Meridian Drive LLC",
        operator: "Meridian Drive",
        id_prefix: 90103,
        subject: "the Meridian AV",
        make: "Meridian",
        model: "One",
        driver: "Remote (Commercial / Test)",
        masks: false,
        opening: "{city}, {street} near {cross}, {clock}. ",
        engaged: &["Level 4 operation was active.", "The AV was in driverless operation, watched from remote."],
        closing: " Logs and video have been kept.",
    },
    Entity {
        name: "Brightlane Mobility Co.",
        operator: "Brightlane Mobility",
        id_prefix: 90104,
        subject: "the shuttle",
        make: "Brightlane",
        model: "Loop 8",
        driver: "In-Vehicle and Remote (Commercial / Test)",
        masks: false,
        opening: "Shuttle on its route in {city}. ",
        engaged: &["An attendant was on board. The shuttle was in automated mode."],
        closing: " Service was paused for the day.",
    },
    Entity {
        name: "Tern Transit Services",
        operator: "Tern Transit Services",
        id_prefix: 90105,
        subject: "the AV",
        make: "Northlight",
        model: "N2",
        driver: "In-Vehicle (Commercial / Test)",
        masks: true,
        opening: "{clock} local time, {city}. ",
        engaged: &[
            "The safety operator had hands off the wheel and the ADS was engaged.",
            "The safety operator braked and steered shortly before the impact.",
        ],
        closing: " Tern Transit Services files this as the employer of the safety operator.",
    },
    Entity {
        name: "Haulwright Trucking Systems",
        operator: "Haulwright Trucking Systems",
        id_prefix: 90106,
        subject: "the Haulwright truck",
        make: "Oxbridge",
        model: "T780",
        driver: "In-Vehicle (Commercial / Test)",
        masks: true,
        opening: "",
        engaged: &["The truck was driving autonomously with a licensed driver on board."],
        closing: " The trailer was inspected and released.",
    },
];

/// The manufacturer that files copies of Calder's reports.
pub const MANUFACTURER: Entity = Entity {
    name: "Quill Motors of America",
    operator: "Calder Autonomy",
    id_prefix: 90107,
    subject: "the Calder test vehicle",
    make: "Quill",
    model: "Vantage",
    driver: "In-Vehicle (Commercial / Test)",
    masks: false,
    opening: "Quill Motors built the vehicle that Calder Autonomy operates, and passes on Calder's account below without \
              having looked into it. ",
    engaged: &["It was driving in autonomous mode."],
    closing: "",
};

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
    ("Van", "a delivery van", "the van"),
    ("Van", "a minivan", "the minivan"),
    ("Bus", "a city bus", "the bus"),
    ("Heavy Truck", "a box truck", "the box truck"),
    ("First Responder Vehicle", "a police car", "the police car"),
    ("Other, see Narrative", "a golf cart", "the golf cart"),
];
const TRUCKS: &[Partner] = &[
    ("Heavy Truck", "a tractor-trailer", "the tractor-trailer"),
    ("Heavy Truck", "a tanker truck", "the tanker"),
    ("Heavy Truck", "a dump truck", "the dump truck"),
];
const RIDERS: &[Partner] = &[
    ("Non-Motorist: Cyclist", "a cyclist", "the cyclist"),
    ("Non-Motorist: Cyclist", "a person on a bicycle", "the bicyclist"),
    ("Non-Motorist: Other", "a person on an electric scooter", "the scooter rider"),
    ("Non-Motorist: Other", "a skateboarder", "the skateboarder"),
];
const MOTORCYCLES: &[Partner] = &[
    ("Motorcycle", "a motorcycle", "the motorcycle"),
    ("Motorcycle", "a motor scooter", "the motor scooter"),
    ("Motorcycle", "a moped", "the moped"),
];

/// A partner of the kind the story can have.
pub fn partner(rng: &mut Rng, partners: Partners) -> Partner {
    let (rider, motorcycle, truck) = match partners {
        Partners::Motor => (0.0, 0.0, 0.0),
        Partners::Any => (0.25, 0.3, 0.0),
        Partners::Light => (0.5, 1.0, 0.0),
        Partners::Riders => (1.0, 0.0, 0.0),
        Partners::Trucks => (0.0, 0.0, 0.45),
    };
    if chance(rng, rider) {
        pick(rng, RIDERS)
    } else if chance(rng, motorcycle) {
        pick(rng, MOTORCYCLES)
    } else if chance(rng, truck) {
        pick(rng, TRUCKS)
    } else if chance(rng, 0.75) {
        pick(rng, CARS)
    } else {
        pick(rng, OTHERS)
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

/// The whole narrative of a story.
pub fn narrative(rng: &mut Rng, story: &Story, facts: &Facts<'_>) -> String {
    let telling = pick(rng, story.tellings);
    let impact =
        if facts.partner.0.starts_with("Non-Motorist") { pick(rng, IMPACTS_LIGHT) } else { pick(rng, IMPACTS) };
    let engaged = pick(rng, facts.entity.engaged);
    let outcome = outcome(rng, facts);
    let text = format!("{}{telling} {impact} {engaged} {outcome}{}", facts.entity.opening, facts.entity.closing);
    let filled = fill(rng, &text, story.from, facts);
    if chance(rng, 0.1) { with_a_slip(rng, &filled) } else { filled }
}

const IMPACTS: &[&str] = &[
    "The {cp_hit} of {it} made contact with the {sv_hit} of {sv}.",
    "Contact was between the {sv_hit} of {sv} and the {cp_hit} of {it}.",
    "{Sv} was touched at the {sv_hit} by the {cp_hit} of {it}.",
    "The impact was at the {sv_hit} of {sv}, with the {cp_hit} of {it}.",
    "Marks were found on the {sv_hit} of {sv} and on the {cp_hit} of the other vehicle.",
];
const IMPACTS_LIGHT: &[&str] = &[
    "{It} and {sv} made contact at the {sv_hit} of {sv}.",
    "Contact was with the {sv_hit} of {sv}. {It} fell and got up again.",
    "The {sv_hit} of {sv} was hit.",
];

fn outcome(rng: &mut Rng, facts: &Facts<'_>) -> &'static str {
    match facts.severity {
        "Minor" => pick(
            rng,
            &[
                "One person complained of neck pain and declined transport.",
                "A minor injury was reported.",
                "The other party had a bruised knee.",
            ],
        ),
        "Moderate" => "One person was taken to hospital with moderate injuries.",
        "Serious" => "One person was seriously injured.",
        "Unknown" => {
            pick(rng, &["The other party left without giving details.", "It is not known if anyone was hurt."])
        }
        _ => pick(
            rng,
            &[
                "No injuries were reported.",
                "Nobody was hurt.",
                "Damage was minor and there were no injuries.",
                "Both drove away. No injuries.",
                "A sensor housing was damaged; no one was injured.",
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
    use ContactZone::{Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};
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
