//! `recrash read`, as a user of it meets it.

use crate::common::Place;
use recrash_records::SAMPLE_CSV;
use serde_json::Value;
use std::collections::BTreeMap;

/// A report id of the sample.
fn some_report() -> String {
    SAMPLE_CSV.lines().nth(1).unwrap().split(',').next().unwrap().trim_matches('"').to_owned()
}

#[test]
fn types_and_facts_are_shown_on_a_screen() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["read"]);
    assert_eq!(code, 0, "{remarks}");
    for words in ["Crash types", "Front to rear", "where it came from", "not stated", "449 reports = "] {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
    assert_eq!(std::fs::read_dir(place.folder()).unwrap().count(), 0, "nothing is written that was not asked for");
}

#[test]
fn accounts_are_given_whole_as_json() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["read", "--json"]);
    assert_eq!(code, 0, "{remarks}");
    let value: Value = serde_json::from_str(&shown).unwrap();
    let accounts = value["accounts"].as_array().unwrap();
    assert!(accounts.len() > 100 && accounts.iter().all(|account| account["format"] == "recrash.account/1"));
    assert!(accounts.iter().all(|account| account["report"].as_str().is_some_and(|id| id.contains('/'))));
}

#[test]
fn the_table_has_a_row_an_account() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["read", "--csv", "a.csv", "--json"]);
    assert_eq!(code, 0, "{remarks}");
    let accounts = serde_json::from_str::<Value>(&shown).unwrap()["accounts"].as_array().unwrap().len();
    let text = std::fs::read_to_string(place.path("a.csv")).unwrap();
    assert!(text.starts_with("incident,report,version,reports,crash_type,role,striker,"), "{text:.200}");
    assert_eq!(text.lines().count(), accounts + 1);
    // What the columns of the speaking report say goes along.
    let rows: Vec<BTreeMap<String, String>> =
        csv::Reader::from_reader(text.as_bytes()).deserialize().map(|row| row.unwrap()).collect();
    assert!(rows.iter().all(|row| !row["entity"].is_empty() && row["year"].parse::<u16>().is_ok()), "{:?}", rows[0]);
    for name in ["sv_speed_mps", "posted_speed_mps", "severity"] {
        assert!(rows.iter().any(|row| !row[name].is_empty()), "{name}");
    }
}

#[test]
fn one_report_is_shown_with_its_words() {
    let place = Place::new();
    let report = some_report();
    let (code, shown, remarks) = place.run(&["read", "--report", &report]);
    assert_eq!(code, 0, "{remarks}");
    for words in [report.as_str(), "Account", "crash_type", "sv.state", "\""] {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
    let (_, json, _) = place.run(&["read", "--report", &report, "--json"]);
    let value: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(value["account"]["format"], "recrash.account/1");
    assert!(value["told"].as_array().is_some_and(|told| !told.is_empty()));
}

#[test]
fn a_report_that_is_not_there_is_told() {
    let place = Place::new();
    let (code, _, remarks) = place.run(&["read", "--report", "1-1"]);
    assert_eq!(code, 3, "{remarks}");
    assert!(remarks.contains("no report 1-1 among 449 reports"), "{remarks}");
    // With its version or without, as tables and files write it.
    let shown = |id: &str| place.run(&["read", "--report", id, "--json"]).1;
    assert!(shown("90103-362/1").contains("90103-362/1") && shown("90103-362/1") == shown("90103-362"));
}

#[test]
fn the_filter_keeps_incidents() {
    let place = Place::new();
    let (code, shown, remarks) = place.run(&["read", "--where", "road = intersection", "--json"]);
    assert_eq!(code, 0, "{remarks}");
    let value: Value = serde_json::from_str(&shown).unwrap();
    let accounts = value["accounts"].as_array().unwrap();
    assert!(!accounts.is_empty() && accounts.iter().all(|account| account["place"]["kind"]["value"] == "intersection"));
}
