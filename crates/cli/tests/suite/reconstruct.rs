//! `recrash reconstruct`, as a user of it meets it.

use crate::common::{FEW, Place};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[test]
fn shares_reasons_and_facts_are_shown_on_a_screen() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["reconstruct", "--records", FEW]);
    assert_eq!(code, 0, "{remarks}");
    for words in [
        "Readable incidents whose crash is reconstructed: no stated fact contradicted, nothing that the two did left out",
        "stated, but not drawn yet: lanes for buses",
        "Front to rear",
        "Why the others are not",
        "facts per 100",
        "stated facts in all readable incidents",
    ] {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
    assert_eq!(std::fs::read_dir(place.folder()).unwrap().count(), 0, "nothing is written that was not asked for");
}

#[test]
fn every_incident_is_shown_or_has_a_reason() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["reconstruct", "--json"]);
    assert_eq!(code, 0, "{remarks}");
    let value: Value = serde_json::from_str(&shown).unwrap();
    let all = value["reconstructions"].as_array().unwrap();
    assert_eq!(all.len() as u64, value["accounts"].as_u64().unwrap());
    for each in all {
        let facts = each["facts"].as_array().unwrap();
        // What the two did is to be seen; others, and why the ego stood, may be left open.
        let deeds = ["sv_movement", "cp_movement", "sv_acts", "cp_acts", "passed_on"];
        let is_missed = |fact: &Value| match fact["result"].as_str().unwrap() {
            "cannot_be_shown" => deeds.contains(&fact["kind"].as_str().unwrap()),
            result => result == "not_shown",
        };
        let missed = facts.iter().any(is_missed);
        assert_eq!(each["told"] == true, !facts.is_empty() && !missed, "{each}");
        assert_eq!(each["told"] == true, each["reason"].is_null(), "{each}");
    }
    let facts = all.iter().flat_map(|each| each["facts"].as_array().unwrap());
    let open: Vec<&Value> = facts.filter(|fact| fact["result"] == "cannot_be_shown").collect();
    let mut counted = 0;
    for share in value["facts"].as_array().unwrap() {
        let of_kind = open.iter().filter(|fact| fact["kind"] == share["fact"]).count() as u64;
        assert_eq!(share["not_drawn"].as_u64().unwrap(), of_kind, "{share}");
        counted += of_kind;
    }
    assert_eq!(counted, open.len() as u64, "every one has a row");
}

#[test]
fn what_is_written_shows_its_crash_and_takes_another_driver() {
    let place = Place::new();
    let (code, _, remarks) = place.run(&["reconstruct", "--records", FEW, "--to-dir", "scenes", "--quiet"]);
    assert_eq!(code, 0, "{remarks}");
    let mut files = scenes(&place.path("scenes"));
    files.sort();
    assert!(files.len() > 30, "{}", files.len());
    for file in files.iter().step_by(8) {
        for ego in ["recorded", "idm"] {
            let (code, shown, remarks) = place.run(&["simulate", file.to_str().unwrap(), "--ego", ego]);
            assert!([0, 5].contains(&code) && shown.contains("state hash"), "{ego}: {remarks}\n{shown}");
        }
    }
}

fn scenes(folder: &Path) -> Vec<PathBuf> {
    let all = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    all.filter(|file| file.extension().is_some_and(|ending| ending == "json")).collect()
}

fn rows(file: &Path) -> Vec<BTreeMap<String, String>> {
    csv::Reader::from_path(file).unwrap().deserialize().map(|row| row.unwrap()).collect()
}

#[test]
fn an_index_says_what_became_of_each_incident_and_how_the_two_touch() {
    let place = Place::new();
    let (code, shown, errors) = place.run(&["reconstruct", "--records", FEW, "--to-dir", "scenes", "--json"]);
    assert_eq!(code, 0, "{errors}");
    let value: Value = serde_json::from_str(&shown).unwrap();
    let index = rows(&place.path("scenes/index.csv"));
    assert_eq!(index.len() as u64, value["accounts"].as_u64().unwrap());
    let told = |row: &&BTreeMap<String, String>| row["standing"] == "shown";
    assert_eq!(index.iter().filter(told).count(), scenes(&place.path("scenes")).len());
    for row in &index {
        let each = value["reconstructions"].as_array().unwrap().iter().find(|each| each["incident"] == row["incident"]);
        let impact = &each.unwrap()["impact"];
        assert_eq!(told(&row), place.path(&format!("scenes/{}.json", row["scenario"])).is_file(), "{row:?}");
        for name in ["ego_impact_speed_mps", "other_impact_speed_mps", "delta_v_mps"] {
            assert_eq!(row[name].parse().ok(), impact[name].as_f64(), "{name}: {row:?}");
            assert!(row[name].is_empty() || told(&row), "{name}: {row:?}");
        }
    }
    assert!(index.iter().any(|row| row["ego_impact_speed_mps"].parse::<f64>().is_ok_and(|speed| speed > 1.0)));
}

#[test]
fn a_folder_may_be_filled_bit_by_bit_and_a_strangers_index_stays() {
    let place = Place::new();
    place.few_records(60);
    let run = |more: &[&str]| {
        place.run(&[&["reconstruct", "--records", "crashes.csv", "--quiet", "--to-dir", "scenes"], more].concat())
    };
    assert_eq!(run(&[]).0, 0);
    let whole = std::fs::read(place.path("scenes/index.csv")).unwrap();
    let report = rows(&place.path("scenes/index.csv"))[3]["report"].clone();
    assert_eq!(run(&["--report", &report]).0, 0);
    assert_eq!(std::fs::read(place.path("scenes/index.csv")).unwrap(), whole);
    std::fs::write(place.path("scenes/index.csv"), "mine,too\n1,2\n").unwrap();
    let (code, _, errors) = run(&[]);
    assert!(code == 3 && errors.contains("index.csv is there and differs"), "{code}: {errors}");
}

#[test]
fn a_report_that_is_not_there_is_told() {
    let place = Place::new();
    let (code, _, errors) = place.run(&["reconstruct", "--records", FEW, "--report", "nobody"]);
    assert_eq!(code, 3, "{errors}");
    assert!(errors.contains("no report nobody with a readable narrative"), "{errors}");
}

#[test]
fn a_scenario_that_somebody_edited_is_not_replaced() {
    let place = Place::new();
    place.few_records(60);
    let few = ["reconstruct", "--records", "crashes.csv", "--quiet", "--to-dir"];
    let write = || place.run(&[&few[..], &["scenes"]].concat());
    assert_eq!(write().0, 0);
    assert_eq!(write().0, 0, "the same again is no loss");
    let edited = scenes(&place.path("scenes")).remove(0);
    std::fs::write(&edited, "{}").unwrap();
    let (code, _, errors) = write();
    assert_eq!(code, 3, "{errors}");
    assert!(errors.contains("is there and differs"), "{errors}");
    assert_eq!(std::fs::read_to_string(&edited).unwrap(), "{}");
    std::fs::write(place.path("file"), "mine").unwrap();
    assert_eq!(place.run(&[&few[..], &["file"]].concat()).0, 3);
}
