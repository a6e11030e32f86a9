//! The numbers of the paper, on NHTSA's own files.

use crate::common::{ARCHIVE, CURRENT, one_per_incident, paper, real_file};
use recrash_model::profile::SystemProfile;
use recrash_model::record::{Coded, Edition, RecordSet, RejectReason};
use recrash_model::template::{Movement, RoadType, Template};
use recrash_model::{Outcome, Severity};
use recrash_records::{SourceText, ingest};
use std::collections::BTreeMap;

fn read(name: &str, bytes: &[u8], profile: &SystemProfile) -> Outcome<RecordSet> {
    ingest(&[SourceText { name, bytes }], profile).expect("NHTSA's file is readable")
}

fn remaining(set: &RecordSet) -> Vec<usize> {
    set.funnel.iter().map(|step| step.remaining).collect()
}

fn templates(set: &RecordSet) -> BTreeMap<Template, usize> {
    let mut counts = BTreeMap::new();
    for &i in &set.usable {
        *counts.entry(set.records[i].template().expect("usable records have a template")).or_insert(0) += 1;
    }
    counts
}

fn count(set: &RecordSet, wanted: impl Fn(&Template) -> bool) -> usize {
    templates(set).iter().filter(|(template, _)| wanted(template)).map(|(_, count)| count).sum()
}

#[test]
fn the_archive_gives_the_counts_of_the_paper() {
    let Some(bytes) = real_file(ARCHIVE) else { return };
    let Outcome { value: set, diagnostics } = read(ARCHIVE, &bytes, &paper());

    assert_eq!(remaining(&set), [2295, 1911, 235]);
    assert_eq!(set.funnel[1].lost, [(RejectReason::RedactedNarrative, 382), (RejectReason::EmptyNarrative, 2)]);
    let lost: usize = set.funnel[2].lost.iter().map(|(_, count)| count).sum();
    assert_eq!(lost, 1911 - 235);
    assert_eq!(set.usable.len() + set.rejects.len(), 2295);
    assert_eq!((set.files[0].edition, set.files[0].rows), (Edition::Second, 2295));
    assert_eq!(set.files[0].sha256.len(), 64);

    let road = |road| count(&set, |template| template.road == road);
    assert_eq!((road(RoadType::Intersection), road(RoadType::Highway), road(RoadType::TrafficCircle)), (214, 20, 1));
    let matrix = Movement::PAPER.map(|cp| Movement::PAPER.map(|sv| count(&set, |t| t.cp == cp && t.sv == sv)));
    assert_eq!(matrix, [[120, 26, 16], [36, 9, 1], [9, 4, 14]]);
    assert_eq!(templates(&set).len(), 14);
    let straight =
        Template { road: RoadType::Intersection, sv: Movement::Straight, cp: Movement::Straight, work_zone: false };
    assert_eq!(templates(&set)[&straight], 104);
    assert_eq!(templates(&set).values().max(), Some(&104));
    assert_eq!(count(&set, |template| template.work_zone), 9);

    let reports: std::collections::BTreeSet<_> = set.usable.iter().map(|&i| &set.records[i].id.report_id).collect();
    let incidents: std::collections::BTreeSet<_> = set.usable.iter().map(|&i| &set.records[i].incident_id).collect();
    assert_eq!((reports.len(), incidents.len()), (189, 161));
    for diagnostic in &diagnostics {
        println!("{diagnostic}");
        assert_eq!(diagnostic.severity, Severity::Note, "{diagnostic}");
    }
}

#[test]
fn the_current_file_adds_up() {
    let Some(bytes) = real_file(CURRENT) else { return };
    let Outcome { value: set, diagnostics } = read(CURRENT, &bytes, &paper());
    assert_eq!((set.files[0].edition, set.files[0].rows), (Edition::Third, 481));
    assert_eq!(set.usable.len() + set.rejects.len(), 481);
    assert_eq!(set.funnel[0].remaining, 481);
    assert_eq!(set.funnel[1].lost, [(RejectReason::RedactedNarrative, 21)]);
    assert_eq!(set.funnel[2].remaining, set.usable.len());
    assert!(set.usable.len() > 30, "{}", set.usable.len());
    assert_eq!(set.records.iter().filter(|record| record.work_zone).count(), 8);
    for diagnostic in &diagnostics {
        println!("{diagnostic}");
    }
}

#[test]
fn both_files_together_are_one_record_an_incident() {
    let (Some(archive), Some(current)) = (real_file(ARCHIVE), real_file(CURRENT)) else { return };
    let files = [SourceText { name: ARCHIVE, bytes: &archive }, SourceText { name: CURRENT, bytes: &current }];
    let Outcome { value: set, diagnostics } = ingest(&files, &one_per_incident()).unwrap();
    assert_eq!(remaining(&set), [2776, 1991, 1932, 196]);
    assert_eq!(set.usable.len() + set.rejects.len(), 2295 + 481);
    let mut incidents: Vec<_> = set.usable.iter().filter_map(|&i| set.records[i].incident_id.as_ref()).collect();
    let all = incidents.len();
    incidents.sort();
    incidents.dedup();
    assert_eq!(incidents.len(), all, "an incident stands twice");
    assert_eq!(set.funnel[1].lost, [(RejectReason::Merged, 785)]);
    let count = |code: &str| diagnostics.iter().filter(|diagnostic| diagnostic.code == code).count();
    assert!(count("records.narrative-lent") > 50, "versions that refer to earlier ones");
    assert!(count("records.refers-to-report") > 0, "reports that refer to other reports");
}

#[test]
fn no_code_and_no_column_of_the_real_files_is_unknown() {
    for name in [ARCHIVE, CURRENT] {
        let Some(bytes) = real_file(name) else { return };
        let outcome = read(name, &bytes, &paper());
        for code in ["records.unlisted-code", "records.unknown-column", "records.missing-column"] {
            assert!(outcome.diagnostics.iter().all(|d| d.code != code), "{:#?}", outcome.diagnostics);
        }
        for record in &outcome.value.records {
            assert!(!matches!(record.partner, Coded::Unlisted(_)), "{:?}", record.partner);
        }
    }
}
