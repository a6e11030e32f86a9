//! One incident, one record: versions, copies, and narratives that point elsewhere.

use crate::common::builder::{row, second};
use crate::common::{codes, one_per_incident};
use recrash_model::Outcome;
use recrash_model::record::{Edition, RecordSet, RejectReason};
use recrash_records::{SourceText, ingest};

const WITHHELD: &str = "[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]";

fn report(id: &str, changes: &[(&str, &str)]) -> String {
    row(Edition::Second, id, changes)
}

/// The kept records as `id/version: narrative`, and the whole outcome.
fn kept(rows: &[String]) -> (Vec<String>, Outcome<RecordSet>) {
    let text = second(rows);
    let files = [SourceText { name: "test.csv", bytes: text.as_bytes() }];
    let outcome = ingest(&files, &one_per_incident()).unwrap();
    let set = &outcome.value;
    let records = set.usable.iter().map(|&i| format!("{}: {}", set.records[i].id, set.records[i].narrative)).collect();
    (records, outcome)
}

#[test]
fn the_newest_version_stays_wherever_it_stands() {
    let rows = [
        report("1-1", &[("Report Version", "2"), ("Narrative", "Second.")]),
        report("1-1", &[("Report Version", "10"), ("Narrative", "Tenth.")]),
        report("1-1", &[("Narrative", "First.")]),
    ];
    let (records, outcome) = kept(&rows);
    assert_eq!(records, ["1-1/10: Tenth."]);
    assert_eq!(outcome.value.rejects.iter().map(|reject| reject.row).collect::<Vec<_>>(), [1, 3]);
    assert!(outcome.value.rejects.iter().all(|reject| reject.reason == RejectReason::Merged));
}

#[test]
fn a_version_without_a_story_takes_that_of_the_latest_that_has_one() {
    for empty in ["No update to narrative. Please refer to the first report.", WITHHELD, ""] {
        let rows = [
            report("1-1", &[("Narrative", "First.")]),
            report("1-1", &[("Report Version", "2"), ("Narrative", "Second.")]),
            report("1-1", &[("Report Version", "3"), ("Narrative", empty)]),
        ];
        let (records, outcome) = kept(&rows);
        assert_eq!(records, ["1-1/3: Second."], "{empty}");
        assert_eq!(codes(&outcome.diagnostics), ["records.narrative-lent"]);
    }
}

#[test]
fn a_report_that_only_refers_to_another_gives_way_to_it() {
    let rows = [
        report("700-1", &[("Narrative", "Please refer to the description in report 800-2-1.")]),
        report("800-2", &[("Narrative", "The van turned.")]),
    ];
    let (records, outcome) = kept(&rows);
    assert_eq!(records, ["800-2/1: The van turned."]);
    assert_eq!(codes(&outcome.diagnostics), ["records.refers-to-report"]);
}

#[test]
fn the_operators_own_report_is_preferred_to_a_copy() {
    let by = |entity, narrative| {
        let cells = [
            ("Reporting Entity", entity),
            ("Operating Entity", "Calder"),
            ("Same Incident ID", "aa"),
            ("Narrative", narrative),
        ];
        report(if entity == "Calder Autonomy" { "2-2" } else { "1-1" }, &cells)
    };
    let (records, _) = kept(&[by("Quill Motors", "Copied."), by("Calder Autonomy", "Own.")]);
    assert_eq!(records, ["2-2/1: Own."]);
    let (records, _) = kept(&[by("Quill Motors", "Copied."), by("Calder Autonomy", WITHHELD)]);
    assert_eq!(records, ["1-1/1: Copied."], "a readable copy before a withheld original");
}

#[test]
fn reports_without_an_incident_id_are_never_merged() {
    let blank = [("Same Incident ID", " ")];
    let (records, _) = kept(&[report("1-1", &blank), report("1-2", &blank)]);
    assert_eq!(records.len(), 2);
}
