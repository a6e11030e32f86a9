//! The generator: stories and a seed in, the text of a CSV file out.

mod others;
mod story;
mod telling;

use recrash_model::Seed;
use recrash_model::record::Edition;
use recrash_model::seed::Rng;
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use recrash_records::published_header;
use story::{STORIES, Story};
use telling::{ENTITIES, Entity, Facts, MANUFACTURER, Partner, Place, between, chance, pick};

/// Seed of the committed sample.
const SEED: Seed = Seed(20_210_629);

const REDACTED: &str = "[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]";
const PERSONAL: &str = "[MAY CONTAIN PERSONALLY IDENTIFIABLE INFORMATION]";

/// Rows with a withheld narrative.
const REDACTED_ROWS: usize = 52;
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
    number: usize,
    version: u32,
    incident: String,
    report_type: &'static str,
    road: RoadType,
    work_zone: bool,
    sv: Movement,
    cp: Movement,
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

/// The sample as a CSV file of the second edition.
pub fn sample_csv() -> String {
    let mut reports = Vec::new();
    for (kind, story) in STORIES.iter().enumerate() {
        add_rows(&mut reports, story, &format!("usable {kind}"));
    }
    for (kind, story) in others::OTHERS.iter().enumerate() {
        add_rows(&mut reports, story, &format!("other {kind}"));
    }
    for row in 0..REDACTED_ROWS + EMPTY_ROWS {
        let mut rng = SEED.child(&format!("withheld {row}")).rng();
        let story = &STORIES[rng.below(STORIES.len())];
        let mut report = report(&mut rng, story, reports.len() + 1);
        report.narrative = match row {
            _ if row >= REDACTED_ROWS => String::new(),
            _ if chance(&mut rng, 0.7) => REDACTED.to_owned(),
            _ => format!("{} The speed was {REDACTED}.", report.narrative),
        };
        reports.push(report);
    }
    SEED.child("order").rng().shuffle(&mut reports);

    let columns: Vec<&str> = published_header(Edition::Second).collect();
    let mut rows: Vec<Vec<String>> = vec![columns.iter().map(|column| (*column).to_owned()).collect()];
    rows.extend(reports.iter().map(|report| report.cells(&columns)));
    for (at, narrative) in [(40, ""), (190, "Nothing to report for this month.")] {
        rows.insert(at, no_news(&columns, at, narrative));
    }
    rows.iter().map(|row| line(row)).collect()
}

/// Adds the rows of one kind of story: about one in four is a later version or a manufacturer's copy of another.
fn add_rows(reports: &mut Vec<Report>, story: &'static Story, name: &str) {
    let repeats = story.rows / 4;
    let first = reports.len();
    for row in 0..story.rows - repeats {
        let mut rng = SEED.child(&format!("{name} {row}")).rng();
        let number = reports.len() + 1;
        reports.push(report(&mut rng, story, number));
    }
    for row in 0..repeats {
        let mut rng = SEED.child(&format!("{name} again {row}")).rng();
        let original = reports[first + row].clone();
        let number = reports.len() + 1;
        reports.push(repeat(&mut rng, original, number));
    }
}

/// A later version of a report, or a copy of it by another entity.
fn repeat(rng: &mut Rng, original: Report, number: usize) -> Report {
    let mut report = original;
    let (northlight, calder, tern) = (&ENTITIES[0], &ENTITIES[1], &ENTITIES[4]);
    if report.entity.name == calder.name {
        report.entity = &MANUFACTURER;
        report.number = number;
        report.narrative = format!("{}{}", MANUFACTURER.opening, report.narrative);
        return report;
    }
    if report.entity.name == northlight.name && chance(rng, 0.5) {
        report.entity = tern;
        report.number = number;
        report.narrative = report.narrative.replace(northlight.closing, tern.closing);
        return report;
    }
    report.version += 1;
    report.report_type = "10-Day Update";
    report.narrative = match rng.below(5) {
        0 => "No update to narrative. Please refer to the first version of this report.".to_owned(),
        1 => format!("The account is unchanged; the field on injuries was corrected. {}", report.narrative),
        2 => format!("After a look at the video this report was filed again. {}", report.narrative),
        3 => format!("{} A police report has since been received.", report.narrative),
        _ => report.narrative,
    };
    report
}

fn report(rng: &mut Rng, story: &Story, number: usize) -> Report {
    let highway = story.road == RoadType::Highway;
    let entity = match rng.below(100) {
        0..50 if highway => &ENTITIES[5],
        0..42 => &ENTITIES[0],
        42..68 => &ENTITIES[1],
        68..82 => &ENTITIES[2],
        82..90 if !highway => &ENTITIES[3],
        _ => &ENTITIES[4],
    };
    let partner = telling::partner(rng, story.partners);
    let place: Place = telling::place(rng, story.road);
    let (sv_zones, cp_zones) = pick(rng, story.contacts);
    let sv_mph = between(rng, story.sv_mph);
    // Bicycles, scooters and shuttles are no racing cars.
    let slow = partner.0.starts_with("Non-Motorist") || partner.1.contains("golf");
    let cp_mph = between(rng, story.cp_mph).min(if slow { 16 } else { u32::MAX });
    let (year, month, minute) = (between(rng, (2022, 2024)), rng.below(12), between(rng, (5 * 60, 23 * 60 + 59)));
    let severity = match rng.below(100) {
        0..80 => "No Injuries Reported",
        80..91 => "Minor",
        91..94 => "Moderate",
        94 => "Serious",
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
    let narrative = telling::narrative(rng, story, &facts);
    let (weather, wet) = match rng.below(20) {
        0..14 => ("Weather - Clear", false),
        14..17 => ("Weather - Cloudy", false),
        17 => ("Weather - Fog/Smoke", false),
        _ => ("Weather - Rain", true),
    };
    let cp_zones_known = !(partner.0.starts_with("Non-Motorist") && chance(rng, 0.5));
    Report {
        entity,
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
        sv_mph: (!chance(rng, 0.06)).then_some(sv_mph),
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
    fn cells(&self, columns: &[&str]) -> Vec<String> {
        let month = |month: usize, year: u32| format!("{}-{year}", MONTHS[month][..3].to_uppercase());
        let next = (self.month + 1) % 12;
        let next_year = if next == 0 { self.year + 1 } else { self.year };
        let tick = |yes: bool| if yes { "Y".to_owned() } else { String::new() };
        let zone =
            |zones: &[ContactZone], name: &str| tick(zones.iter().any(|zone| zone.label() == name.to_lowercase()));
        let redacted = self.narrative.contains(REDACTED);
        let cell = |column: &str| -> String {
            if let Some(name) = column.strip_prefix("SV Contact Area - ") {
                return zone(self.sv_zones, name);
            }
            if let Some(name) = column.strip_prefix("CP Contact Area - ") {
                return if name == "Unknown" { tick(self.cp_zones.is_empty()) } else { zone(self.cp_zones, name) };
            }
            if column.starts_with("Weather - ") {
                return tick(column == self.weather);
            }
            match column {
                "Report ID" => format!("{}-{}", self.entity.id_prefix, self.number),
                "Report Version" => self.version.to_string(),
                "Reporting Entity" => self.entity.name.to_owned(),
                "Report Type" => self.report_type.to_owned(),
                "Report Month" => {
                    if self.report_type == "Monthly" {
                        (next + 1).to_string()
                    } else {
                        String::new()
                    }
                }
                "Report Year" => {
                    if self.report_type == "Monthly" {
                        next_year.to_string()
                    } else {
                        String::new()
                    }
                }
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
                "CP Pre-Crash Movement" => movement(self.cp).to_owned(),
                "SV Pre-Crash Movement" => movement(self.sv).to_owned(),
                "SV Any Air Bags Deployed?" | "CP Any Air Bags Deployed?" => "No".to_owned(),
                "SV Precrash Speed (MPH)" => self.sv_mph.map(|mph| mph.to_string()).unwrap_or_default(),
                "SV Pre-crash Speed - Unknown" => tick(self.sv_mph.is_none()),
                "Within ODD?" => if redacted { REDACTED } else { "Yes" }.to_owned(),
                "Narrative" => self.narrative.clone(),
                "Narrative - CBI?" => tick(redacted),
                _ => String::new(),
            }
        };
        columns.iter().map(|column| cell(column)).collect()
    }
}

/// A row that says that there is nothing to report.
fn no_news(columns: &[&str], number: usize, narrative: &str) -> Vec<String> {
    let cell = |column: &str| match column {
        "Report ID" => format!("{}-{}", ENTITIES[4].id_prefix, 900 + number),
        "Report Version" => "1".to_owned(),
        "Reporting Entity" => ENTITIES[4].name.to_owned(),
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
        Movement::UTurn => "Making U-Turn",
        Movement::ChangingLanes => "Changing Lanes",
        Movement::Stopped => "Stopped",
        Movement::Parked => "Parked",
        Movement::Backing => "Backing",
        Movement::LaneDeparture => "Lane / Road Departure",
        Movement::NmCrossing => "NM Crossing Roadway",
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
