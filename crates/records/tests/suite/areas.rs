//! Ticks of contact areas, which stand under each other's names in the files since June 2025.

use crate::common::builder::{header, row};
use crate::common::{CURRENT, codes, diagnostic, ingest_bytes, real_file};
use recrash_model::record::{CrashRecord, Edition};
use recrash_model::zones::ContactZone;

/// Rows of an edition, each with a tick of the SV, one of the CP, and a narrative.
fn records(edition: Edition, rows: &[[&str; 3]]) -> (Vec<CrashRecord>, bool) {
    let row = |(i, [sv, cp, narrative]): (usize, &[&str; 3])| {
        let (sv, cp) = (format!("SV Contact Area - {sv}"), format!("CP Contact Area - {cp}"));
        let changes = [(sv.as_str(), "Y"), (cp.as_str(), "Y"), ("Narrative", narrative)];
        row(edition, &format!("7-{i}"), &changes) + "\n"
    };
    let text = header(edition) + "\n" + &rows.iter().enumerate().map(row).collect::<String>();
    let outcome = ingest_bytes(text.as_bytes());
    let told = codes(&outcome.diagnostics).contains(&"records.contact-areas");
    (outcome.value.records, told)
}

const MOVED: [&str; 3] = ["Rear Right", "Front", "Its front left met the rear of the robotaxi."];
const AS_NAMED: [&str; 3] = ["Rear", "Front Left", "Its front left met the rear of the robotaxi."];
const SILENT: [&str; 3] = ["Front Left", "Rear Left", "The two touched."];

#[test]
fn ticks_since_june_2025_are_read_as_the_narratives_say_that_they_are_meant() {
    let (all, told) = records(Edition::Third, &[MOVED, SILENT, MOVED]);
    assert!(told);
    assert_eq!((&all[0].sv_zones[..], &all[0].cp_zones[..]), (&[ContactZone::Rear][..], &[ContactZone::FrontLeft][..]));
    assert_eq!(
        (&all[1].sv_zones[..], &all[1].cp_zones[..]),
        (&[ContactZone::FrontRight][..], &[ContactZone::RearRight][..])
    );
}

#[test]
fn ticks_that_the_narratives_agree_with_stay() {
    let (all, told) = records(Edition::Third, &[AS_NAMED, SILENT, AS_NAMED, MOVED]);
    assert!(!told);
    assert_eq!(
        (&all[1].sv_zones[..], &all[1].cp_zones[..]),
        (&[ContactZone::FrontLeft][..], &[ContactZone::RearLeft][..])
    );
}

#[test]
fn where_no_narrative_tells_they_are_as_in_all_published_files() {
    let (all, told) = records(Edition::Third, &[SILENT]);
    assert!(told);
    assert_eq!(all[0].sv_zones, [ContactZone::FrontRight]);
    let (all, told) = records(Edition::Third, &[["Left", "Top", "The two touched."]]);
    assert_eq!((told, &all[0].sv_zones[..]), (false, &[ContactZone::Left][..]));
}

#[test]
fn earlier_editions_are_read_as_named() {
    for edition in [Edition::First, Edition::Second] {
        let (all, told) = records(edition, &[MOVED, MOVED]);
        assert_eq!((told, &all[0].sv_zones[..]), (false, &[ContactZone::RearRight][..]));
    }
}

#[test]
fn the_published_file_is_read_as_its_narratives_say() {
    let Some(bytes) = real_file(CURRENT) else { return };
    let outcome = ingest_bytes(&bytes);
    let message = &diagnostic(&outcome, "records.contact-areas").message;
    assert!(message.contains("of the narratives that can tell 499 say so and 9 say otherwise"), "{message}");
}
