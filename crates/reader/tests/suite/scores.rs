//! How often the reader agrees with people who read real records: `demand.csv` of `../shared`, whose records are all of the
//! developed half, and the developed half of `eval/labels.csv`, which draws as many records of each company. The floors are what it reached when it was written, less two records; who makes it worse is told.

use recrash_model::account::{Account, Driver, Fact, Origin, told};
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::zones::ContactZone;
use recrash_records::{SourceText, ingest};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Field of `demand.csv`, and the smallest share of agreement.
const FLOORS: [(&str, f64); 8] = [
    ("crash_type", 0.92),
    ("role", 0.93),
    ("striker", 0.95),
    ("sv_state", 0.96),
    ("standing", 0.96),
    ("cp_from", 0.90),
    ("human_drove_at_impact", 0.95),
    ("cp_kind", 0.92),
];

#[test]
fn the_reader_agrees_with_careful_readers() {
    let Some(labels) = recrash_testing::shared("data/demand.csv") else { return };
    let Some(folder) = recrash_testing::shared("data/nhtsa") else { return };
    let accounts = accounts(&folder);
    let mut reader = csv::Reader::from_path(labels).unwrap();
    let header = reader.headers().unwrap().clone();
    let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for row in reader.records() {
        let row = row.unwrap();
        let cell = |name: &str| header.iter().position(|known| known == name).map_or("", |at| &row[at]);
        let report = cell("report");
        assert!(is_developed(report), "{report} is held out");
        let Some(account) = accounts.get(report) else { panic!("no account of {report}") };
        for (field, _) in FLOORS {
            let Some(agrees) = agrees(field, &cell, account) else { continue };
            let count = counts.entry(field).or_default();
            *count = (count.0 + usize::from(agrees), count.1 + 1);
        }
    }
    let mut below = Vec::new();
    for (field, floor) in FLOORS {
        let (agreed, all) = counts[field];
        let share = agreed as f64 / all as f64;
        println!("{field:24} {agreed:4} of {all:4} {:.1} %", 100.0 * share);
        if share < floor {
            below.push(format!("{field}: {agreed} of {all}, below {floor}"));
        }
    }
    assert!(below.is_empty(), "{}", below.join("\n"));
}

/// Field of `labels.csv`, and the smallest share of agreement.
const LABEL_FLOORS: [(&str, f64); 6] = [
    ("sv_movement", 0.89),
    ("cp_movement", 0.88),
    ("approach", 0.85),
    ("order", 0.86),
    ("sv_zones", 0.97),
    ("cp_zones", 0.95),
];

#[test]
fn the_reader_agrees_with_the_labels_of_every_company() {
    let Some(folder) = recrash_testing::shared("data/nhtsa") else { return };
    let accounts = accounts(&folder);
    let mut reader = csv::Reader::from_reader(include_str!("../../../../eval/labels.csv").as_bytes());
    let header = reader.headers().unwrap().clone();
    let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for row in reader.records() {
        let row = row.unwrap();
        let cell = |name: &str| header.iter().position(|known| known == name).map_or("", |at| &row[at]);
        if cell("half") != "dev" {
            continue;
        }
        assert!(is_developed(cell("report")));
        // One of them only refers to a report that is in neither file.
        let Some(account) = accounts.get(cell("report")) else { continue };
        for (field, _) in LABEL_FLOORS {
            let Some(agrees) = agrees_with_label(field, cell(field), account) else { continue };
            let count = counts.entry(field).or_default();
            *count = (count.0 + usize::from(agrees), count.1 + 1);
        }
    }
    let mut below = Vec::new();
    for (field, floor) in LABEL_FLOORS {
        let (agreed, all) = counts[field];
        println!("{field:24} {agreed:4} of {all:4} {:.1} %", 100.0 * agreed as f64 / all as f64);
        if (agreed as f64) < floor * all as f64 {
            below.push(format!("{field}: {agreed} of {all}, below {floor}"));
        }
    }
    assert!(below.is_empty(), "{}", below.join("\n"));
}

/// Whether account and label agree; `None` where the labeller cannot tell.
fn agrees_with_label(field: &str, label: &str, account: &Account) -> Option<bool> {
    if matches!(label, "unknown" | "") {
        return None;
    }
    let partner = account.partner.as_ref();
    let near = |zones: &[Fact<ContactZone>]| {
        let labelled: Vec<ContactZone> =
            label.split(';').map(|zone| serde_json::from_value(zone.into()).unwrap()).collect();
        labelled.iter().any(|label| {
            zones
                .iter()
                .any(|zone| zone.value == *label || label.steps_apart(zone.value).is_some_and(|steps| steps <= 1))
        })
    };
    Some(match field {
        "sv_movement" => coded(&told(&account.sv.movement)) == label,
        "cp_movement" => coded(&partner.and_then(|partner| told(&partner.movement))) == label,
        "order" => coded(&told(&account.order)) == label,
        "sv_zones" => near(&account.sv.zones),
        "cp_zones" => near(partner.map_or(&[], |partner| partner.zones.as_slice())),
        "approach" => {
            let said = match told(&account.came_from) {
                Some(Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Parked { .. }) => {
                    "same".to_owned()
                }
                Some(Origin::Opposite) => "opposite".to_owned(),
                Some(Origin::Cross { side }) => coded(&Some(side)),
                Some(Origin::Stall { side } | Origin::Driveway { side } | Origin::Sidewalk { side }) => coded(&side),
                Some(Origin::Above) | None => "unknown".to_owned(),
            };
            said == label
        }
        _ => return None,
    })
}

/// The half that rules may be written on: the SHA-256 of the id, taken as one integer, is even.
fn is_developed(report: &str) -> bool {
    Sha256::digest(report.as_bytes()).last().is_some_and(|byte| byte % 2 == 0)
}

/// Accounts by every report that they are of.
fn accounts(folder: &std::path::Path) -> BTreeMap<String, Account> {
    let names = ["ads-2021-06-to-2025-06.csv", "ads-2025-06-to-2026-01.csv"];
    let bytes: Vec<Vec<u8>> = names.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect();
    let sources: Vec<SourceText<'_>> =
        names.iter().zip(&bytes).map(|(name, bytes)| SourceText { name, bytes }).collect();
    let profile = include_str!("../../../../profiles/paper.toml");
    let mut profile: SystemProfile = toml::from_str(profile).unwrap();
    profile.records.dedupe = Dedupe::None;
    let records = ingest(&sources, &profile).unwrap().value.records;
    let incidents = recrash_reader::incidents(&records);
    assert_eq!(incidents.iter().map(|incident| incident.reports.len()).sum::<usize>(), records.len());
    let mut all = BTreeMap::new();
    for account in incidents.iter().filter_map(recrash_reader::account) {
        for report in &account.reports {
            all.insert(report.report_id.clone(), account.clone());
        }
    }
    all
}

fn coded<T: Serialize>(value: &Option<T>) -> String {
    match value.as_ref().map(|value| serde_json::to_value(value).unwrap()) {
        Some(serde_json::Value::String(text)) => text,
        Some(other) => other.to_string(),
        None => "unknown".to_owned(),
    }
}

/// Whether account and label agree; `None` where a careful reader cannot tell.
fn agrees<'a>(field: &str, cell: &dyn Fn(&str) -> &'a str, account: &Account) -> Option<bool> {
    let label = cell(if field == "standing" { "sv_state" } else { field });
    if matches!(label, "unknown" | "unclear" | "") {
        return None;
    }
    Some(match field {
        "crash_type" => coded(&told(&account.crash_type)) == label,
        "role" => coded(&told(&account.role)) == label,
        "striker" => coded(&told(&account.striker)) == label,
        "sv_state" => coded(&told(&account.sv.state)) == label,
        "standing" => {
            told(&account.sv.state).is_some_and(|state| state.stands()) == matches!(label, "stopped" | "parked")
        }
        "human_drove_at_impact" => (told(&account.driver) != Some(Driver::System)) == (label == "yes"),
        "cp_from" => {
            let said = origin(told(&account.came_from));
            let place = ["driveway", "parked"].into_iter().any(|place| label.starts_with(place) && said == place);
            // Where things lie is not labelled.
            said == label || place || (label == "none" && cell("crash_type") == "single_vehicle")
        }
        "cp_kind" => {
            let kind = account.partner.as_ref().and_then(|partner| told(&partner.kind));
            let said = coded(&kind);
            let same: &[&str] = match said.as_str() {
                "bicycle" => &["cyclist"],
                "e_bike" => &["ebike_cyclist"],
                "scooter_rider" => &["electric_scooter_rider"],
                "scooter" => &["scooter_left_on_road"],
                "pickup_with_trailer" => &["pickup"],
                "wall" => &["wall_and_pillar"],
                "cone" => &["pylon"],
                "barrier" => &["movable_barrier"],
                "debris" => &["road_debris"],
                "police_car" => &["police_car_unmarked"],
                "construction_vehicle" => &["asphalt_roller", "construction_truck"],
                "vehicle" => &["passenger_car"],
                _ => &[],
            };
            said == label || same.contains(&label)
        }
        _ => return None,
    })
}

fn origin(origin: Option<Origin>) -> String {
    match origin {
        None => "unknown".to_owned(),
        Some(Origin::Behind) => "same_behind".to_owned(),
        Some(Origin::Ahead) => "same_ahead".to_owned(),
        Some(Origin::Opposite) => "opposite".to_owned(),
        Some(Origin::Beside { side }) => format!("same_{}", coded(&Some(side))),
        Some(Origin::Cross { side }) => coded(&Some(side)),
        Some(Origin::Stall { .. }) => "stall".to_owned(),
        Some(Origin::Driveway { .. }) => "driveway".to_owned(),
        Some(Origin::Parked { .. }) => "parked".to_owned(),
        Some(Origin::Sidewalk { .. }) => "sidewalk".to_owned(),
        Some(Origin::Above) => "above".to_owned(),
    }
}
