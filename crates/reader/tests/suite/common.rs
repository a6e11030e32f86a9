//! What the reader's tests share: records around narratives, and accounts as plain words.

use recrash_model::account::{Account, Act, Astride, ControlDevice, Fact, Origin, Party, RoadFeature};
use recrash_model::record::{Coded, CrashRecord, Edition, Provenance, RecordRef, Redaction};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// A report with this narrative and empty columns.
pub fn record(id: &str, version: u32, narrative: &str) -> CrashRecord {
    CrashRecord {
        id: RecordRef { report_id: id.to_owned(), version },
        incident_id: None,
        entity: "Northlight Mobility".to_owned(),
        vehicle: "2024 Northlight One".to_owned(),
        when: None,
        time_of_day_min: None,
        place: String::new(),
        road: Coded::Blank,
        work_zone: false,
        surface: None,
        lighting: None,
        weather: Vec::new(),
        posted_speed_mps: None,
        partner: Coded::Blank,
        cp_movement: Coded::Blank,
        sv_movement: Coded::Blank,
        sv_speed_mps: None,
        sv_zones: Vec::new(),
        cp_zones: Vec::new(),
        severity: Coded::Blank,
        towed: Default::default(),
        airbags: Default::default(),
        engagement: Coded::Blank,
        narrative: narrative.to_owned(),
        redaction: if narrative.is_empty() { Redaction::Empty } else { Redaction::Open },
        provenance: Provenance { file: "made.csv".to_owned(), edition: Edition::Second, row: 1 },
        reading: None,
    }
}

/// The account of a narrative without columns.
pub fn account_of(narrative: &str) -> Option<Account> {
    let incidents = recrash_reader::incidents(&[record("1-1", 1, narrative)]);
    recrash_reader::account(&incidents[0])
}

fn coded<T: Serialize>(value: &T) -> String {
    match serde_json::to_value(value).unwrap() {
        Value::String(text) => text,
        other => other.to_string(),
    }
}

fn name<T: Serialize>(fact: &Option<Fact<T>>) -> String {
    fact.as_ref().map(|fact| coded(&fact.value)).unwrap_or_default()
}

fn origin(account: &Account) -> String {
    account.came_from.as_ref().map(|from| place(&from.value)).unwrap_or_default()
}

fn place(from: &Origin) -> String {
    let sided = |name: &str, side: &Option<recrash_model::account::LeftRight>| match side {
        Some(side) => format!("{name}_{}", coded(side)),
        None => name.to_owned(),
    };
    match from {
        Origin::Beside { side } => sided("beside", &Some(*side)),
        Origin::Cross { side } => sided("cross", &Some(*side)),
        Origin::Stall { side } => sided("stall", side),
        Origin::Driveway { side } => sided("driveway", side),
        Origin::Parked { side } => sided("parked", side),
        Origin::Sidewalk { side } => sided("sidewalk", side),
        plain => coded(plain),
    }
}

fn acts(party: &Party) -> String {
    let all: Vec<String> = party
        .acts
        .iter()
        .filter(|fact| !fact.after_contact)
        .map(|fact| match &fact.side {
            Some(side) => format!("{}_{}", coded(&fact.act), coded(side)),
            None => coded(&fact.act),
        })
        .collect();
    all.join(" ")
}

/// How what somebody did before the contact was done, where that is told.
fn manners(party: &Party) -> String {
    let before = party.acts.iter().filter(|fact| !fact.after_contact);
    let told = before.filter_map(|fact| Some(format!("{} {}", coded(&fact.act), coded(&fact.manner?))));
    told.collect::<Vec<_>>().join("; ")
}

fn over(fact: &Fact<Astride>) -> String {
    let side = fact.value.side.map(|side| format!("_{}", coded(&side))).unwrap_or_default();
    format!("{}{side} {}", coded(&fact.value.line), coded(&fact.value.when))
}

fn zones(party: &Party) -> String {
    party.zones.iter().map(|zone| coded(&zone.value)).collect::<Vec<_>>().join(" ")
}

/// The facts of an account by short names, in words.
pub fn facts(account: &Account) -> BTreeMap<&'static str, String> {
    let empty = Party::default();
    let partner = account.partner.as_ref().unwrap_or(&empty);
    let sv = &account.sv;
    let speeds: Vec<String> =
        sv.speeds.iter().map(|fact| format!("{:.1} {}", fact.value.mps, coded(&fact.value.meaning))).collect();
    let signal = sv.controls.iter().find(|control| control.value.device == ControlDevice::Signal);
    let others: Vec<String> = account.others.iter().map(|other| coded(&other.kind.value)).collect();
    let other_places: Vec<String> =
        account.others.iter().filter_map(|other| Some(place(&other.place.as_ref()?.value))).collect();
    let other_acts: Vec<String> = account
        .others
        .iter()
        .flat_map(|other| &other.acts)
        .filter(|fact| !fact.after_contact)
        .map(|fact| coded(&fact.act))
        .collect();
    let other_lines: Vec<String> =
        account.others.iter().filter_map(|other| Some(coded(&other.astride.as_ref()?.value.line))).collect();
    let hiding: Vec<String> =
        account.others.iter().filter(|other| other.hides).map(|other| coded(&other.kind.value)).collect();
    let matrix =
        account.matrix.as_ref().map(|fact| format!("{} {}", coded(&fact.value.object), coded(&fact.value.event)));
    let ran = partner.did(Act::RunRed) || partner.did(Act::RunStop);
    let feature = [RoadFeature::Roundabout, RoadFeature::Ramp]
        .into_iter()
        .find(|feature| account.place.features.iter().any(|known| known.value == *feature));
    let features: Vec<String> = account.place.features.iter().map(|feature| coded(&feature.value)).collect();
    let controls: Vec<String> = sv.controls.iter().map(|control| coded(&control.value.device)).collect();
    BTreeMap::from([
        ("crash_type", name(&account.crash_type)),
        ("role", name(&account.role)),
        ("striker", name(&account.striker)),
        ("scenario", name(&account.scenario)),
        ("matrix", matrix.unwrap_or_default()),
        ("first_contact", name(&account.first_contact)),
        ("came_from", origin(account)),
        ("order", name(&account.order)),
        ("driver", name(&account.driver)),
        ("door", name(&account.door)),
        ("left", if account.partner_left.is_some() { "yes".to_owned() } else { "no".to_owned() }),
        (
            "ahead",
            account.ahead.as_ref().map(|ahead| if ahead.value { "yes" } else { "no" }.to_owned()).unwrap_or_default(),
        ),
        ("place", name(&account.place.kind)),
        ("lanes", name(&account.place.lanes)),
        ("features", features.join(" ")),
        ("feature", feature.map(|feature| coded(&feature)).unwrap_or_default()),
        ("others", others.join(" ")),
        ("other_places", other_places.join(" ")),
        ("other_acts", other_acts.join(" ")),
        ("hiding", hiding.join(" ")),
        ("sv_kind", name(&sv.kind)),
        ("sv_lane", name(&sv.lane)),
        ("sv_turns_next", name(&sv.turns_next)),
        ("sv_astride", sv.astride.as_ref().map(over).unwrap_or_default()),
        ("cp_astride", partner.astride.as_ref().map(over).unwrap_or_default()),
        ("others_astride", other_lines.join(" ")),
        ("sv_heading", name(&sv.heading)),
        ("cp_heading", name(&partner.heading)),
        ("sv_controls", controls.join(" ")),
        ("sv_state", name(&sv.state)),
        ("standing", name(&sv.standing)),
        ("reason", sv.reasons.first().map(|reason| coded(&reason.value)).unwrap_or_default()),
        ("sv_movement", name(&sv.movement)),
        ("sv_acts", acts(sv)),
        ("sv_zones", zones(sv)),
        ("sv_speed", speeds.join("; ")),
        ("sv_signal", signal.and_then(|control| control.value.state).map(|state| coded(&state)).unwrap_or_default()),
        ("cp_kind", name(&partner.kind)),
        ("cp_state", name(&partner.state)),
        ("cp_movement", name(&partner.movement)),
        ("cp_lane", name(&partner.lane)),
        ("cp_acts", acts(partner)),
        ("sv_manner", manners(sv)),
        ("cp_manner", manners(partner)),
        ("cp_zones", zones(partner)),
        ("cp_ran", if ran { "yes".to_owned() } else { "no".to_owned() }),
    ])
}

/// Every source in an account that names words.
pub fn each_source(value: &Value, found: &mut dyn FnMut(&Value)) {
    match value {
        Value::Object(fields) => {
            if let Some(words) = fields.get("words").filter(|words| words.is_object()) {
                found(words);
            }
            fields.values().for_each(|inner| each_source(inner, found));
        }
        Value::Array(values) => values.iter().for_each(|inner| each_source(inner, found)),
        _ => {}
    }
}
