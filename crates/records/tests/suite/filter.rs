//! Filters: what they keep, what they refuse and where.

use crate::common::builder::{row, second};
use crate::common::{one_per_incident, paper};
use recrash_model::record::{Edition, RejectReason};
use recrash_records::{Filter, IngestOptions, SourceText, ingest_with};

/// Ids of the records that a filter keeps, of five.
fn kept(filter: &str) -> Vec<String> {
    let cells = |id: &str, changes: &[(&str, &str)]| row(Edition::Second, id, changes);
    let text = second(&[
        cells("1", &[("Incident Date", "JUN-2023"), ("Highest Injury Severity Alleged", "Minor")]),
        cells("2", &[("Incident Date", "JAN-2024"), ("Highest Injury Severity Alleged", "Serious")]),
        cells("3", &[("Roadway Type", "Street"), ("Reporting Entity", "Waymo LLC"), ("Weather - Rain", "Y")]),
        cells(
            "4",
            &[
                ("Roadway Description", "Work Zone"),
                ("SV Precrash Speed (MPH)", "25"),
                ("Weather - Snow", "Y"),
                ("Weather - Rain", "Y"),
            ],
        ),
        cells("5", &[("Roadway Type", "Unknown"), ("Highest Injury Severity Alleged", "No Injuries Reported")]),
    ]);
    let filter = Filter::parse(filter).unwrap_or_else(|error| panic!("{error}"));
    let options = IngestOptions { filter: Some(&filter), mapping: None };
    let set = ingest_with(&[SourceText { name: "t.csv", bytes: text.as_bytes() }], &paper(), &options).unwrap().value;
    let out = |row: u64| set.rejects.iter().any(|r| r.row == row && r.reason == RejectReason::FilteredOut);
    set.records.iter().filter(|r| !out(r.provenance.row)).map(|r| r.id.report_id.clone()).collect()
}

#[test]
fn comparisons_keep_what_they_say() {
    let cases: [(&str, &[&str]); 25] = [
        ("road = street", &["3"]),
        ("ROAD = Street", &["3"]),
        ("road = \"Street\"", &["3"]),
        ("road != intersection", &["3", "5"]),
        ("road = unknown", &["5"]),
        ("road in (street, unknown)", &["3", "5"]),
        ("severity >= minor", &["1", "2"]),
        ("severity < minor", &["5"]),
        ("severity != none", &["1", "2", "3", "4"]),
        ("severity = unknown", &["3", "4"]),
        ("entity contains \"waymo\"", &["3"]),
        ("entity contains northlight and not work_zone", &["1", "2", "5"]),
        ("entity = 'northlight robotics' and work_zone", &["4"]),
        ("work_zone = no", &["1", "2", "3", "5"]),
        ("year >= 2024", &["2"]),
        ("year < 2024", &["1"]),
        ("year = unknown", &["3", "4", "5"]),
        ("month = 6", &["1"]),
        ("sv_speed_mps > 10", &["4"]),
        ("weather = rain", &["3", "4"]),
        ("weather = rain and weather != snow", &["3"]),
        ("sv = left_turn and cp = straight and partner = suv", &["1", "2", "3", "4", "5"]),
        ("sv = \"left turn\"", &["1", "2", "3", "4", "5"]),
        ("not (road = intersection or year = unknown)", &[]),
        ("report in (1, 2) or report = 5 and year >= 2024", &["1", "2"]),
    ];
    for (filter, wanted) in cases {
        assert_eq!(kept(filter), wanted, "{filter}");
    }
}

#[test]
fn and_binds_stronger_than_or_and_brackets_strongest() {
    assert_eq!(kept("road = street or road = intersection and severity = serious"), ["2", "3"]);
    assert_eq!(kept("(road = street or road = intersection) and severity = serious"), ["2"]);
}

#[test]
fn mistakes_are_told_with_their_column() {
    let deep = "not ".repeat(100) + "work_zone";
    let cases: [(&str, usize, &str); 21] = [
        ("", 1, "expected the name of a field"),
        ("raod = street", 1, "did you mean \"road\""),
        ("speed = 3", 1, "allowed: report, incident"),
        ("road = stret", 8, "did you mean \"street\""),
        ("road = bridge", 8, "allowed: intersection, traffic_circle"),
        ("road street", 6, "expected =, !=, <"),
        ("road =", 7, "expected a value"),
        ("road = street year = 2024", 15, "expected \"and\", \"or\""),
        ("road < street", 8, "has no order"),
        ("severity < unknown", 12, "neither smaller nor greater"),
        ("year >= recent", 9, "\"recent\" is none"),
        ("year >= nan", 9, "is a number"),
        ("year contains 20", 6, "is no text"),
        ("entity < waymo", 10, "is a text"),
        ("(road = street", 15, "expected \")\""),
        ("road in street", 9, "expected \"(\""),
        ("road in (street, )", 18, "expected a value"),
        ("entity = \"Waymo", 10, "never closed"),
        ("road = street && work_zone", 15, "write \"and\""),
        ("road = street; work_zone", 14, "cannot read ';'"),
        (&deep, 257, "nested deeper"),
    ];
    for (filter, column, message) in cases {
        let error = Filter::parse(filter).expect_err(filter);
        assert_eq!(error.column, column, "{filter}: {error}");
        assert!(error.message.contains(message), "{filter}: {error}");
    }
    let shown = Filter::parse("year >= soon").unwrap_err().to_string();
    assert!(shown.ends_with("\n  year >= soon\n          ^"), "{shown}");
    assert!(Filter::parse(&"a".repeat(5000)).is_err());
}

#[test]
fn the_filter_is_a_step_of_the_funnel_behind_merging() {
    let text = second(&[
        row(Edition::Second, "1", &[("Same Incident ID", "x")]),
        row(Edition::Second, "2", &[("Same Incident ID", "x"), ("Roadway Type", "Street")]),
        row(Edition::Second, "3", &[("Roadway Type", "Street")]),
    ]);
    let filter = Filter::parse("road = intersection").unwrap();
    let options = IngestOptions { filter: Some(&filter), mapping: None };
    let files = [SourceText { name: "t.csv", bytes: text.as_bytes() }];
    let set = ingest_with(&files, &one_per_incident(), &options).unwrap().value;
    let steps: Vec<(&str, usize)> = set.funnel.iter().map(|step| (step.name.as_str(), step.remaining)).collect();
    let wanted = [
        ("rows", 3),
        ("one report an incident", 2),
        ("where road = intersection", 1),
        ("narrative readable", 1),
        ("expressible by the profile", 1),
    ];
    assert_eq!(steps, wanted);
    assert_eq!(set.funnel[2].lost, [(RejectReason::FilteredOut, 1)]);
}
