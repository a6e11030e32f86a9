//! Rows into incidents: versions, copies, boilerplate, two crashes under one id.

use crate::common::record;
use recrash_model::incident::{Incident, Telling};
use recrash_model::record::{CrashRecord, Redaction, YearMonth};
use recrash_reader::{account, incidents};

const STORY: &str = "The AV was stopped at a red light on Elm Street when a sedan approached the AV from behind and \
made contact with the rear bumper of the AV.";

fn of_incident(mut record: CrashRecord, incident: &str) -> CrashRecord {
    record.incident_id = Some(incident.to_owned());
    record
}

fn spoken(incident: &Incident) -> String {
    incident.spoken().unwrap().record.id.to_string()
}

#[test]
fn every_row_is_in_exactly_one_incident() {
    let rows = [
        of_incident(record("100-1", 1, STORY), "aa"),
        of_incident(record("200-7", 1, STORY), "aa"),
        record("100-2", 1, STORY),
        record("100-2", 2, STORY),
        record("100-3", 1, ""),
    ];
    let all = incidents(&rows);
    let counts: Vec<usize> = all.iter().map(|incident| incident.reports.len()).collect();
    assert_eq!(counts.iter().sum::<usize>(), rows.len());
    let ids: Vec<&str> = all.iter().map(|incident| incident.id.as_str()).collect();
    assert_eq!(ids, ["100-2", "100-3", "aa"]);
    assert_eq!(counts, [2, 1, 2]);
}

#[test]
fn reports_of_other_companies_on_other_days_are_no_versions_of_one_though_they_share_an_id() {
    let of = |entity: &str, month: u8| {
        let mut row = record("100-2", 1, STORY);
        row.entity = entity.to_owned();
        row.when = Some(YearMonth { year: 2025, month });
        row
    };
    let rows = [of("One", 1), of("Two", 2), of("One", 3), of("Three", 4), of("Two", 2)];
    let all = incidents(&rows);
    let told: Vec<(&str, usize)> = all.iter().map(|incident| (incident.id.as_str(), incident.reports.len())).collect();
    assert_eq!(told, [("100-2", 2), ("100-2#2", 2), ("100-2#3", 1)]);
}

#[test]
fn an_update_that_tells_nothing_does_not_speak() {
    let rows = [record("100-2", 1, STORY), record("100-2", 2, "No update to narrative.")];
    assert_eq!(spoken(&incidents(&rows)[0]), "100-2/1");
}

#[test]
fn a_later_version_that_tells_as_much_speaks() {
    let reversed = "The AV was traveling on Elm Street behind a sedan and made contact with the rear bumper of the sedan, \
which was stopped at a red light.";
    let rows = [record("100-2", 1, STORY), record("100-2", 2, reversed)];
    assert_eq!(spoken(&incidents(&rows)[0]), "100-2/2");
}

#[test]
fn a_later_version_that_tells_less_does_not() {
    let rows = [record("100-2", 1, STORY), record("100-2", 2, "The AV was in a crash on Elm Street.")];
    assert_eq!(spoken(&incidents(&rows)[0]), "100-2/1");
}

#[test]
fn boilerplate_points_to_the_report_it_names() {
    let boilerplate = "Northlight filed a report on this. We are submitting a duplicate of the redacted public copy of \
report 100-2-1, and have no independent knowledge of the facts.";
    let rows = [record("500-9", 1, boilerplate), record("100-2", 1, STORY)];
    let all = incidents(&rows);
    assert_eq!(all.len(), 1);
    assert_eq!(spoken(&all[0]), "100-2/1");
    let copy = all[0].reports.iter().find(|report| report.record.id.report_id == "500-9").unwrap();
    assert_eq!((copy.telling, copy.names.as_slice()), (Telling::Refers, ["100-2".to_owned()].as_slice()));
}

#[test]
fn a_copy_whose_incident_tells_its_own_story_is_not_moved_by_a_report_that_it_names() {
    let rows = [
        of_incident(record("500-9", 1, "No additional information. See 100-2-1."), "bb"),
        of_incident(record("300-3", 1, STORY), "bb"),
        of_incident(record("100-2", 1, STORY), "aa"),
    ];
    let all = incidents(&rows);
    assert_eq!(all.iter().map(|incident| incident.reports.len()).collect::<Vec<_>>(), [1, 2]);
}

#[test]
fn who_passes_on_another_company_s_narrative_joins_its_incident() {
    let copy = format!(
        "We incorporate nothing of our own; this submission incorporates the Report by reference (Report ID-100-2-). {STORY}"
    );
    let all = incidents(&[record("500-9", 1, &copy), record("100-2", 1, STORY)]);
    assert_eq!(all.len(), 1);
    assert_eq!(all[0].reports.len(), 2);
}

#[test]
fn two_crashes_under_one_id_are_split_by_their_times() {
    let at = |id: &str, minute: u16| {
        let mut row = of_incident(record(id, 1, STORY), "aa");
        row.time_of_day_min = Some(minute);
        row
    };
    let all = incidents(&[at("100-1", 600), at("100-2", 613)]);
    assert_eq!(all.iter().map(|incident| incident.id.as_str()).collect::<Vec<_>>(), ["aa", "aa#2"]);
    assert_eq!(incidents(&[at("100-1", 600), at("100-2", 603)]).len(), 1);
}

#[test]
fn what_changed_between_versions_is_kept() {
    let mut later = record("100-2", 2, STORY);
    later.sv_speed_mps = Some(3.0);
    let all = incidents(&[record("100-2", 1, STORY), later]);
    assert_eq!(all[0].reports[1].changed, ["SV Precrash Speed (MPH)"]);
    let masked = STORY.replace("Elm Street", "[XXX]");
    let all = incidents(&[record("100-2", 1, STORY), record("100-2", 1, &masked)]);
    assert_eq!(all[0].reports[1].changed, ["Narrative"]);
    assert_ne!(all[0].reports[0].text_hash, all[0].reports[1].text_hash);
}

#[test]
fn what_nobody_tells_is_no_account() {
    let mut withheld = record("100-2", 1, "[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]");
    withheld.redaction = Redaction::Redacted;
    for row in [withheld, record("100-3", 1, ""), record("100-4", 1, "Please refer to report 1-1.")] {
        let all = incidents(&[row]);
        assert!(all[0].speaker.is_none() && account(&all[0]).is_none());
    }
}

#[test]
fn the_order_of_rows_does_not_matter() {
    let rows: Vec<CrashRecord> =
        (0..8).map(|n| of_incident(record(&format!("100-{n}"), 1, STORY), ["a", "b", "c"][n % 3])).collect();
    let mut turned = rows.clone();
    turned.reverse();
    let ids = |rows: &[CrashRecord]| -> Vec<(String, Vec<String>)> {
        let of = |incident: &Incident| {
            (incident.id.clone(), incident.references().iter().map(ToString::to_string).collect())
        };
        incidents(rows).iter().map(of).collect()
    };
    assert_eq!(ids(&rows), ids(&turned));
}
