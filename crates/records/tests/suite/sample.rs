//! The built-in sample: what the generator writes, with the paper's counts.

#[path = "../../examples/make_sample/generator/mod.rs"]
mod generator;

use crate::common::{one_per_incident, paper};
use recrash_model::record::{CrashRecord, RecordSet, Redaction, RejectReason};
use recrash_model::template::Movement::{LeftTurn, RightTurn, Straight};
use recrash_model::template::RoadType::{Highway, Intersection, TrafficCircle};
use recrash_model::template::Template;
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};
use std::collections::{BTreeMap, BTreeSet};

const SAMPLE: SourceText<'_> = SourceText { name: SAMPLE_NAME, bytes: SAMPLE_CSV.as_bytes() };

fn sample() -> RecordSet {
    ingest(&[SAMPLE], &paper()).expect("the sample is readable").value
}

fn usable(set: &RecordSet) -> impl Iterator<Item = &CrashRecord> {
    set.usable.iter().map(|&i| &set.records[i])
}

#[test]
fn the_committed_sample_is_what_the_generator_writes() {
    let written = generator::sample_csv();
    let difference = written.lines().zip(SAMPLE_CSV.lines()).position(|(left, right)| left != right);
    assert_eq!(
        difference, None,
        "run: cargo run -p recrash-records --example make_sample > crates/records/data/sample.csv"
    );
    assert_eq!(written.len(), SAMPLE_CSV.len());
    assert!(SAMPLE_CSV.len() < 600_000, "{} bytes", SAMPLE_CSV.len());
}

#[test]
fn the_sample_has_the_papers_template_counts() {
    let template = |road, sv, cp, work_zone| Template { road, sv, cp, work_zone };
    let wanted = BTreeMap::from([
        (template(Intersection, Straight, Straight, false), 104),
        (template(Intersection, Straight, LeftTurn, false), 32),
        (template(Intersection, LeftTurn, Straight, false), 24),
        (template(Intersection, RightTurn, Straight, false), 16),
        (template(Intersection, RightTurn, RightTurn, false), 14),
        (template(Intersection, Straight, RightTurn, false), 9),
        (template(Intersection, LeftTurn, LeftTurn, false), 8),
        (template(Intersection, LeftTurn, RightTurn, false), 4),
        (template(Intersection, RightTurn, LeftTurn, false), 1),
        (template(Intersection, LeftTurn, Straight, true), 2),
        (template(Highway, Straight, Straight, false), 9),
        (template(Highway, Straight, Straight, true), 7),
        (template(Highway, Straight, LeftTurn, false), 4),
        (template(TrafficCircle, LeftTurn, LeftTurn, false), 1),
    ]);
    let set = sample();
    let mut counts = BTreeMap::new();
    for record in usable(&set) {
        *counts.entry(record.template().unwrap()).or_insert(0) += 1;
    }
    assert_eq!(counts, wanted);
    assert_eq!(set.usable.len(), 235);
}

#[test]
fn the_sample_reads_without_a_remark_and_adds_up() {
    let outcome = ingest(&[SAMPLE], &paper()).unwrap();
    assert_eq!(outcome.diagnostics, []);
    let set = outcome.value;
    assert_eq!(set.files[0].rows, set.usable.len() + set.rejects.len());
    let lost = |reason| set.rejects.iter().filter(|reject| reject.reason == reason).count();
    assert_eq!(lost(RejectReason::Malformed), 0);
    assert_eq!(lost(RejectReason::RedactedNarrative), 52);
    assert_eq!(lost(RejectReason::EmptyNarrative), 4);
    assert_eq!(lost(RejectReason::NotACrash), 1);
}

#[test]
fn the_sample_is_as_untidy_as_the_real_file() {
    let set = sample();
    let texts: BTreeSet<&str> = usable(&set).map(|record| record.narrative.as_str()).collect();
    assert!(texts.len() > 190, "{} different narratives", texts.len());
    let reports: BTreeSet<&str> = usable(&set).map(|record| record.id.report_id.as_str()).collect();
    let incidents: BTreeSet<&str> = usable(&set).filter_map(|record| record.incident_id.as_deref()).collect();
    assert!(reports.len() < 225 && incidents.len() < reports.len(), "{} {}", reports.len(), incidents.len());
    let some = |wanted: &dyn Fn(&CrashRecord) -> bool| usable(&set).filter(|record| wanted(record)).count();
    assert!(some(&|record| record.sv_speed_mps.is_none()) >= 8);
    assert!(some(&|record| record.narrative.contains("[XXX]")) >= 60);
    assert!(some(&|record| record.narrative.contains('\n')) >= 40);
    assert!(some(&|record| record.cp_zones.is_empty()) >= 5);
    assert!(usable(&set).map(|record| &record.entity).collect::<BTreeSet<_>>().len() >= 6);
    assert!(usable(&set).map(|record| &record.partner).collect::<BTreeSet<_>>().len() >= 9);
}

#[test]
fn no_placeholder_is_left_in_a_narrative() {
    for record in &sample().records {
        assert!(!record.narrative.contains(['{', '}']), "{}: {}", record.id, record.narrative);
    }
}

#[test]
fn merging_keeps_every_incident_once_and_lends_narratives() {
    let outcome = ingest(&[SAMPLE], &one_per_incident()).unwrap();
    let set = &outcome.value;
    let kept: Vec<&str> = usable(set).filter_map(|record| record.incident_id.as_deref()).collect();
    assert_eq!(kept.len(), set.usable.len(), "every sample record has an incident id");
    assert_eq!(kept.iter().collect::<BTreeSet<_>>().len(), kept.len());
    let before: BTreeSet<String> = usable(&sample()).filter_map(|record| record.incident_id.clone()).collect();
    assert_eq!(kept.len(), before.len(), "no incident is lost by merging");
    assert!(usable(set).all(|record| record.redaction == Redaction::Open));
    assert!(usable(set).all(|record| !record.narrative.starts_with("No update")));
    assert!(outcome.diagnostics.iter().any(|diagnostic| diagnostic.code == "records.narrative-lent"));
    assert!(usable(set).all(|record| record.entity != "Quill Motors of America"), "the operator's own report is kept");
}
