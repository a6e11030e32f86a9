//! The generator: stories and a seed in, the text of a CSV file out.

mod entities;
mod stories;
mod story;
mod telling;

use entities::{BRIGHTLANE, ENTITIES, Entity, HAULWRIGHT};
use recrash_model::Seed;
use recrash_model::account::{ContactState, CrashType};
use recrash_model::record::Edition;
use recrash_model::seed::Rng;
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use recrash_records::published_header;
use story::Story;
use telling::{Facts, Partner, Place, between, chance, pick};

/// Seed of the committed sample.
const SEED: Seed = Seed(20_210_629);

const REDACTED: &str = "[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]";
const PERSONAL: &str = "[MAY CONTAIN PERSONALLY IDENTIFIABLE INFORMATION]";

/// Incidents whose narrative is withheld as a whole.
const WITHHELD_INCIDENTS: usize = 6;
/// Crash reports without any narrative.
const EMPTY_ROWS: usize = 3;

const MONTHS: [&str; 12] = [
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
];

/// One reported event, as the columns and the narrative tell it.
#[derive(Clone)]
struct Report {
    entity: &'static Entity,
    /// Who files it, and under what number of reports: the entity, or who copies it.
    filed_by: (&'static str, u32),
    number: usize,
    version: u32,
    incident: String,
    report_type: &'static str,
    road: RoadType,
    work_zone: bool,
    sv: Movement,
    cp: Option<Movement>,
    partner: Partner,
    city: &'static str,
    state: &'static str,
    year: u32,
    month: usize,
    minute: u32,
    lighting: &'static str,
    wet: bool,
    weather: &'static str,
    posted_mph: u32,
    sv_mph: Option<u32>,
    sv_zones: &'static [ContactZone],
    cp_zones: &'static [ContactZone],
    severity: &'static str,
    operator: &'static str,
    narrative: String,
}

/// The sample: a CSV file of the second edition, and what a reader should find in it.
pub struct Sample {
    pub csv: String,
    pub meant: Vec<Meant>,
}

/// What the story of an incident means.
#[derive(Debug, Clone)]
pub struct Meant {
    /// The incident, as in the column.
    pub incident: String,
    /// Its crash type.
    pub kind: CrashType,
    /// What the subject vehicle does at the contact.
    pub state: ContactState,
    /// The subject vehicle's movement, as told.
    pub movement: Movement,
}

/// The sample.
pub fn sample() -> Sample {
    let mut maker = Maker::default();
    for (kind, story) in stories::all().enumerate() {
        for way in 0..story.incidents {
            maker.add_incident(story, way, &format!("story {kind} {way}"));
        }
    }
    for row in 0..WITHHELD_INCIDENTS + EMPTY_ROWS {
        maker.add_withheld(row);
    }
    let Maker { mut reports, meant, .. } = maker;
    SEED.child("order").rng().shuffle(&mut reports);

    let columns: Vec<&str> = published_header(Edition::Second).collect();
    let mut rows: Vec<Vec<String>> = vec![columns.iter().map(|column| (*column).to_owned()).collect()];
    rows.extend(reports.iter().map(|report| report.cells(&columns)));
    for (at, narrative) in [(40, ""), (190, "Nothing to report for this month.")] {
        rows.insert(at, no_news(&columns, at, narrative));
    }
    Sample { csv: rows.iter().map(|row| line(row)).collect(), meant }
}

/// Makes the reports, one incident after the other.
#[derive(Default)]
struct Maker {
    reports: Vec<Report>,
    meant: Vec<Meant>,
    /// How many incidents there are on the highway, of the other entities, and of each entity.
    on_highway: usize,
    elsewhere: usize,
    of_entity: [usize; ENTITIES.len()],
}

impl Maker {
    /// Adds an incident: its report, and where it is its turn, a copy of it and a later version.
    fn add_incident(&mut self, story: &Story, way: usize, name: &str) {
        let mut rng = SEED.child(name).rng();
        let at = self.next_entity(story.road);
        let entity = &ENTITIES[at];
        let count = self.of_entity[at];
        self.of_entity[at] += 1;
        let mut first = report(&mut rng, story, way, entity, self.reports.len() + 1);
        // What the paper's templates can use stands in full.
        if !in_a_template(story) && is_due(count, entity.withholds) {
            let software =
                ["The software version was", "The system's plan at that time was", "The cause was found to be"];
            first.narrative = format!("{} {} {REDACTED}.", first.narrative, pick(&mut rng, &software));
        }
        self.meant.push(Meant {
            incident: first.incident.clone(),
            kind: story.kind,
            state: story.state,
            movement: match story.state {
                ContactState::Stopped => Movement::Stopped,
                ContactState::Parked => Movement::Parked,
                _ => story.sv,
            },
        });
        self.reports.push(first.clone());
        if entity.copied.is_some_and(|(_, share)| is_due(count, share)) {
            let number = self.reports.len() + 1;
            self.reports.push(copy(&first, number));
        }
        if is_due(count, entity.updates) {
            self.reports.push(later_version(&mut rng, &first));
        }
    }

    /// Adds a crash report whose narrative is withheld, or empty.
    fn add_withheld(&mut self, row: usize) {
        let mut rng = SEED.child(&format!("withheld {row}")).rng();
        let kinds: Vec<&Story> = stories::all().collect();
        let entity = &ENTITIES[self.next_entity(RoadType::Street)];
        let story = pick(&mut rng, &kinds);
        let mut report = report(&mut rng, story, row, entity, self.reports.len() + 1);
        report.narrative = if row < WITHHELD_INCIDENTS { REDACTED.to_owned() } else { String::new() };
        self.reports.push(report);
    }

    /// The entity of the next incident: the shares come out as near as they can, after any number of incidents.
    fn next_entity(&mut self, road: RoadType) -> usize {
        if road == RoadType::Highway {
            self.on_highway += 1;
            if self.on_highway.is_multiple_of(2) {
                return HAULWRIGHT;
            }
        }
        self.elsewhere += 1;
        // The golden ratio spreads them evenly over every kind of story.
        let mut left = (self.elsewhere as f64 * 0.618_033_988_749_894_8).fract();
        for (at, entity) in ENTITIES.iter().enumerate() {
            if left < entity.share {
                return at;
            }
            left -= entity.share;
        }
        0
    }
}

/// Whether it is the turn of the incident after so many, where a share of them is wanted.
fn is_due(count: usize, share: f64) -> bool {
    ((count + 1) as f64 * share).floor() > (count as f64 * share).floor()
}

/// Whether the paper's profile has a template for it.
fn in_a_template(story: &Story) -> bool {
    matches!(story.road, RoadType::Intersection | RoadType::Highway | RoadType::TrafficCircle)
        && Movement::PAPER.contains(&story.sv)
        && story.cp.is_some_and(|cp| Movement::PAPER.contains(&cp))
}

/// A copy of a report by another company.
fn copy(original: &Report, number: usize) -> Report {
    let mut report = original.clone();
    let Some((copier, _)) = original.entity.copied else { return report };
    report.filed_by = (copier.name, copier.id_prefix);
    report.number = number;
    report.narrative = if copier.only_refers() {
        copier.opening.replace("{report}", &original.report_id())
    } else {
        let told = original.narrative.replace(original.entity.closing, "");
        format!("{}{told}{}", copier.opening, copier.closing)
    };
    report
}

/// A later version of a report.
fn later_version(rng: &mut Rng, original: &Report) -> Report {
    let mut report = original.clone();
    report.version += 1;
    report.report_type = pick(rng, &["10-Day Update", "10-Day Update", "Update"]);
    report.narrative = match rng.below(5) {
        0 => "No update to narrative. Please refer to the first version of this report.".to_owned(),
        1 => format!("The account is unchanged; the field on injuries was corrected. {}", report.narrative),
        2 => format!("After a look at the video this report was filed again. {}", report.narrative),
        3 => format!("{} A police report has since been received.", report.narrative),
        _ => report.narrative,
    };
    report
}

fn report(rng: &mut Rng, story: &Story, way: usize, entity: &'static Entity, number: usize) -> Report {
    let partner = telling::partner(rng, story.partners);
    let place: Place = telling::place(rng, story.road);
    let (sv_zones, cp_zones) = pick(rng, story.contacts);
    let sv_mph = between(rng, story.sv_mph);
    // Bicycles, scooters and shuttles are no racing cars.
    let slow = partner.0.starts_with("Non-Motorist") || partner.1.contains("golf");
    let cp_mph = between(rng, story.cp_mph).min(if slow { 16 } else { u32::MAX });
    let (year, month, minute) = (between(rng, (2022, 2024)), rng.below(12), between(rng, (5 * 60, 23 * 60 + 59)));
    let severity = match rng.below(100) {
        0..84 => "No Injuries Reported",
        84..93 => "Minor",
        93..95 => "Moderate",
        95 => "Serious",
        _ => "Unknown",
    };
    let facts = Facts {
        entity,
        partner,
        place: &place,
        month: MONTHS[month],
        year,
        clock: clock(minute),
        sv_mph,
        cp_mph,
        sv_zones,
        cp_zones,
        severity,
    };
    let narrative = telling::narrative(rng, story, way, &facts);
    let (weather, wet) = match rng.below(20) {
        0..14 => ("Weather - Clear", false),
        14..17 => ("Weather - Cloudy", false),
        17 => ("Weather - Fog/Smoke", false),
        _ => ("Weather - Rain", true),
    };
    let cp_zones_known = !(partner.0.starts_with("Non-Motorist") && chance(rng, 0.5));
    Report {
        entity,
        filed_by: (entity.name, entity.id_prefix),
        number,
        version: 1,
        incident: incident(rng),
        report_type: pick(rng, &["Monthly", "Monthly", "Monthly", "5-Day", "1-Day"]),
        road: story.road,
        work_zone: story.work_zone,
        sv: story.sv,
        cp: story.cp,
        partner,
        city: place.city,
        state: place.state,
        year,
        month,
        minute,
        lighting: lighting(rng, minute),
        wet,
        weather,
        posted_mph: posted_limit(story, sv_mph.max(cp_mph.min(40))),
        sv_mph: (!chance(rng, 0.02)).then_some(sv_mph),
        sv_zones,
        cp_zones: if cp_zones_known { cp_zones } else { &[] },
        severity,
        operator: entity.operator,
        narrative,
    }
}

/// Fifteen hexadecimal digits.
fn incident(rng: &mut Rng) -> String {
    format!("{:015x}", rng.next_u64() >> 4)
}

fn posted_limit(story: &Story, fastest_mph: u32) -> u32 {
    match story.road {
        RoadType::ParkingLot => 15,
        RoadType::Highway if story.work_zone => 55,
        RoadType::Highway => 65,
        _ if fastest_mph > 32 => 40,
        _ if fastest_mph > 22 => 30,
        _ => 25,
    }
}

fn lighting(rng: &mut Rng, minute: u32) -> &'static str {
    match minute {
        420..1080 => "Daylight",
        360..420 | 1080..1170 => "Dawn / Dusk",
        _ if chance(rng, 0.9) => "Dark - Lighted",
        _ => "Dark - Not Lighted",
    }
}

fn clock(minute: u32) -> String {
    let (hour, half) = (minute / 60, if minute < 720 { "AM" } else { "PM" });
    format!("{}:{:02} {half}", if hour % 12 == 0 { 12 } else { hour % 12 }, minute % 60)
}

impl Report {
    fn report_id(&self) -> String {
        format!("{}-{}", self.filed_by.1, self.number)
    }

    fn cells(&self, columns: &[&str]) -> Vec<String> {
        let cell = |column: &&str| self.ticked(column).map_or_else(|| self.cell(column), tick);
        columns.iter().map(cell).collect()
    }

    /// Whether a column of contact areas or of the weather is ticked; nothing of the other columns.
    fn ticked(&self, column: &str) -> Option<bool> {
        let zone = |zones: &[ContactZone], name: &str| zones.iter().any(|zone| zone.label() == name.to_lowercase());
        if let Some(name) = column.strip_prefix("SV Contact Area - ") {
            return Some(zone(self.sv_zones, name));
        }
        if let Some(name) = column.strip_prefix("CP Contact Area - ") {
            return Some(if name == "Unknown" { self.cp_zones.is_empty() } else { zone(self.cp_zones, name) });
        }
        column.starts_with("Weather - ").then_some(column == self.weather)
    }

    fn cell(&self, column: &str) -> String {
        let month = |month: usize, year: u32| format!("{}-{year}", MONTHS[month][..3].to_uppercase());
        let next = (self.month + 1) % 12;
        let next_year = if next == 0 { self.year + 1 } else { self.year };
        let monthly = |number: usize| if self.report_type == "Monthly" { number.to_string() } else { String::new() };
        let redacted = self.narrative.contains(REDACTED);
        match column {
            "Report ID" => self.report_id(),
            "Report Version" => self.version.to_string(),
            "Reporting Entity" => self.filed_by.0.to_owned(),
            "Report Type" => self.report_type.to_owned(),
            "Report Month" => monthly(next + 1),
            "Report Year" => monthly(next_year as usize),
            "Report Submission Date" => month(next, next_year),
            "VIN - Unknown" | "Mileage - Unknown" => "Y".to_owned(),
            "Serial Number" => "N/A".to_owned(),
            "Make" => self.entity.make.to_owned(),
            "Model" => self.entity.model.to_owned(),
            "Model Year" => (self.year - 1).to_string(),
            "Driver / Operator Type" => self.entity.driver.to_owned(),
            "ADS Equipped?" => "Yes".to_owned(),
            "Automation System Engaged?" => "ADS".to_owned(),
            "Operating Entity" => self.operator.to_owned(),
            "Source - Telematics" | "Data Availability - Video" => "Y".to_owned(),
            "Incident Date" | "Notice Received Date" => month(self.month, self.year),
            "Incident Time (24:00)" => format!("{:02}:{:02}", self.minute / 60, self.minute % 60),
            "Same Incident ID" => self.incident.clone(),
            "Latitude" | "Longitude" | "Address" | "Zip Code" => PERSONAL.to_owned(),
            "City" => self.city.to_owned(),
            // Published with a blank behind it.
            "State" => format!("{} ", self.state),
            "Roadway Type" => road(self.road).to_owned(),
            "Roadway Surface" => if self.wet { "Wet" } else { "Dry" }.to_owned(),
            "Roadway Description" => if self.work_zone { "Work Zone" } else { "No Unusual Conditions" }.to_owned(),
            "Posted Speed Limit (MPH)" => self.posted_mph.to_string(),
            "Lighting" => self.lighting.to_owned(),
            "Crash With" => self.partner.0.to_owned(),
            "Highest Injury Severity Alleged" => self.severity.to_owned(),
            "Property Damage?" => "Yes".to_owned(),
            "CP Pre-Crash Movement" => self.cp.map_or("Other, see Narrative", movement).to_owned(),
            "SV Pre-Crash Movement" => movement(self.sv).to_owned(),
            "SV Any Air Bags Deployed?" | "CP Any Air Bags Deployed?" => "No".to_owned(),
            "SV Precrash Speed (MPH)" => self.sv_mph.map(|mph| mph.to_string()).unwrap_or_default(),
            "SV Pre-crash Speed - Unknown" => tick(self.sv_mph.is_none()),
            "Within ODD?" => if redacted { REDACTED } else { "Yes" }.to_owned(),
            "Narrative" => self.narrative.clone(),
            "Narrative - CBI?" => tick(redacted),
            _ => String::new(),
        }
    }
}

/// A cell of a column that is ticked or not.
fn tick(yes: bool) -> String {
    if yes { "Y".to_owned() } else { String::new() }
}

/// A row that says that there is nothing to report.
fn no_news(columns: &[&str], number: usize, narrative: &str) -> Vec<String> {
    let cell = |column: &str| match column {
        "Report ID" => format!("{}-{}", ENTITIES[BRIGHTLANE].id_prefix, 900 + number),
        "Report Version" => "1".to_owned(),
        "Reporting Entity" => ENTITIES[BRIGHTLANE].name.to_owned(),
        "Report Type" => "No New or Updated Incident Reports".to_owned(),
        "Same Incident ID" => " ".to_owned(),
        "Narrative" => narrative.to_owned(),
        _ => String::new(),
    };
    columns.iter().map(|column| cell(column)).collect()
}

fn road(road: RoadType) -> &'static str {
    match road {
        RoadType::Intersection => "Intersection",
        RoadType::TrafficCircle => "Traffic Circle",
        RoadType::Highway => "Highway / Freeway",
        RoadType::Street => "Street",
        RoadType::ParkingLot => "Parking Lot",
        _ => "Rural Road",
    }
}

fn movement(movement: Movement) -> &'static str {
    match movement {
        Movement::Straight => "Proceeding Straight",
        Movement::LeftTurn => "Making Left Turn",
        Movement::RightTurn => "Making Right Turn",
        Movement::ChangingLanes => "Changing Lanes",
        Movement::Stopped => "Stopped",
        Movement::Parked => "Parked",
        Movement::Backing => "Backing",
        Movement::LaneDeparture => "Lane / Road Departure",
        Movement::NmCrossing => "NM Crossing Roadway",
        Movement::NmInRoadway => "NM in Roadway - Other",
        Movement::Passing => "Passing",
        Movement::Merging => "Merging",
        Movement::EnteringTraffic => "Entering Traffic",
        Movement::ParkingManeuver => "Parking Maneuver",
        Movement::CrossingIntoOpposingLane => "Crossing into Opposing Lane",
        Movement::WrongWay => "Traveling Wrong Way",
        _ => "Other, see Narrative",
    }
}

/// One line of CSV: quoted where it must be.
fn line(cells: &[String]) -> String {
    let quoted = cells.iter().map(|cell| {
        if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
    });
    quoted.collect::<Vec<_>>().join(",") + "\n"
}
