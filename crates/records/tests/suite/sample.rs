//! The built-in sample: what the generator writes, with the shares of the real file.

#[path = "../../examples/make_sample/generator/mod.rs"]
mod generator;

use crate::common::{one_per_incident, paper};
use recrash_model::account::{ContactState, CrashType};
use recrash_model::record::{CrashRecord, RecordSet, Redaction, RejectReason};
use recrash_model::template::Movement::{LeftTurn, RightTurn, Straight};
use recrash_model::template::RoadType::{Highway, Intersection, TrafficCircle};
use recrash_model::template::{Movement, Template};
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
    let written = generator::sample().csv;
    let difference = written.lines().zip(SAMPLE_CSV.lines()).position(|(left, right)| left != right);
    assert_eq!(
        difference, None,
        "run: cargo run -p recrash-records --example make_sample > crates/records/data/sample.csv"
    );
    assert_eq!(written.len(), SAMPLE_CSV.len());
    assert!(SAMPLE_CSV.len() < 504_000, "{} bytes", SAMPLE_CSV.len());
}

/// Percent of the incidents of both public files of 2026-01 that can be read, as `recrash read` counts them.
const CORPUS_TYPES: [(CrashType, f64); 11] = [
    (CrashType::Secondary, 2.6),
    (CrashType::Pedestrian, 1.5),
    (CrashType::Cyclist, 2.0),
    (CrashType::Motorcycle, 1.4),
    (CrashType::SingleVehicle, 11.5),
    (CrashType::Backing, 13.3),
    (CrashType::FrontToRear, 28.0),
    (CrashType::HeadOn, 6.6),
    (CrashType::Intersection, 9.8),
    (CrashType::Lateral, 18.2),
    (CrashType::Other, 5.2),
];

fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole as f64
}

fn assert_near(what: &str, found: f64, of_the_corpus: f64, within: f64) {
    assert!((found - of_the_corpus).abs() <= within, "{what}: {found:.1}, in the corpus {of_the_corpus:.1}");
}

#[test]
fn the_sample_has_the_corpus_shares_of_types_and_stops() {
    let meant = generator::sample().meant;
    for (kind, share) in CORPUS_TYPES {
        let count = meant.iter().filter(|story| story.kind == kind).count();
        assert!(count >= 4, "{kind:?}: {count}");
        assert_near(kind.label(), percent(count, meant.len()), share, 1.0);
    }
    let in_state = |state| percent(meant.iter().filter(|story| story.state == state).count(), meant.len());
    assert_near("stopped", in_state(ContactState::Stopped), 45.9, 2.0);
    assert_near("moving", in_state(ContactState::Moving), 39.4, 2.5);
    assert_near("parked", in_state(ContactState::Parked), 9.8, 2.5);
    assert_near("setting off", in_state(ContactState::SettingOff), 3.8, 1.0);
    assert_near("reversing", in_state(ContactState::Reversing), 1.1, 0.5);
}

#[test]
fn what_a_story_means_stands_in_its_columns() {
    let records = sample().records;
    for story in generator::sample().meant {
        let of_it: Vec<_> =
            records.iter().filter(|record| record.incident_id.as_ref() == Some(&story.incident)).collect();
        assert!(!of_it.is_empty(), "{}", story.incident);
        for record in of_it {
            // Who stops in the middle of a move is there as moving, as in the real file.
            let column = record.sv_movement.known();
            let stood = story.state == ContactState::Stopped && column.is_some_and(|sv| Movement::PAPER.contains(&sv));
            assert!(stood || column == Some(story.movement), "{}: {column:?}, meant {:?}", record.id, story.movement);
        }
    }
}

#[test]
fn the_sample_has_the_corpus_shares_of_entities_copies_versions_and_gaps() {
    let set = sample();
    let (records, rows) = (&set.records, set.records.len());
    let share = |wanted: &dyn Fn(&CrashRecord) -> bool| percent(records.iter().filter(|one| wanted(one)).count(), rows);
    // Waymo; Cruise; General Motors' copies; Transdev, mostly with copies of Waymo's; Zoox.
    assert_near("Northlight", share(&|one| one.entity == "Northlight Robotics, Inc."), 61.2, 3.0);
    assert_near("Calder", share(&|one| one.entity == "Calder Autonomy"), 7.5, 1.0);
    assert_near("Quill", share(&|one| one.entity == "Quill Motors of America"), 7.2, 2.0);
    assert_near("Tern", share(&|one| one.entity == "Tern Transit Services"), 6.8, 1.0);
    assert_near("Meridian", share(&|one| one.entity == "Meridian Drive LLC"), 5.3, 1.0);
    assert_near("later versions", share(&|one| one.id.version > 1), 14.6, 1.5);
    assert_near("withheld", share(&|one| one.redaction == Redaction::Redacted), 15.7, 1.5);
    assert_near("standing by speed", share(&|one| one.sv_speed_mps == Some(0.0)), 52.3, 3.0);

    let mut companies: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for record in records {
        let incident = record.incident_id.as_deref().unwrap_or(&record.id.report_id);
        companies.entry(incident).or_default().insert(&record.entity);
    }
    let copied = companies.values().filter(|entities| entities.len() > 1).count();
    assert_near("told by two companies", percent(copied, companies.len()), 17.9, 3.0);
    assert_near("rows of an incident", rows as f64 / companies.len() as f64, 1.4, 0.05);
}

#[test]
fn the_sample_holds_every_template_of_the_paper() {
    let template = |road, sv, cp, work_zone| Template { road, sv, cp, work_zone };
    let wanted = BTreeMap::from([
        (template(Intersection, Straight, Straight, false), 31),
        (template(Intersection, Straight, LeftTurn, false), 9),
        (template(Intersection, LeftTurn, Straight, false), 8),
        (template(Highway, Straight, Straight, false), 7),
        (template(Intersection, RightTurn, Straight, false), 7),
        (template(Intersection, LeftTurn, LeftTurn, false), 6),
        (template(Highway, Straight, Straight, true), 4),
        (template(Intersection, RightTurn, RightTurn, false), 4),
        (template(Intersection, Straight, RightTurn, false), 4),
        (template(Highway, Straight, LeftTurn, false), 3),
        (template(TrafficCircle, LeftTurn, LeftTurn, false), 2),
        (template(Intersection, LeftTurn, RightTurn, false), 1),
        (template(Intersection, LeftTurn, Straight, true), 1),
        (template(Intersection, RightTurn, LeftTurn, false), 1),
    ]);
    let set = sample();
    let mut counts = BTreeMap::new();
    for record in usable(&set) {
        *counts.entry(record.template().unwrap()).or_insert(0) += 1;
    }
    assert_eq!(counts, wanted);
}

#[test]
fn the_sample_reads_without_a_remark_and_adds_up() {
    let outcome = ingest(&[SAMPLE], &paper()).unwrap();
    assert_eq!(outcome.diagnostics, []);
    let set = outcome.value;
    assert_eq!(set.files[0].rows, set.usable.len() + set.rejects.len());
    let lost = |reason| set.rejects.iter().filter(|reject| reject.reason == reason).count();
    assert_eq!(lost(RejectReason::Malformed), 0);
    assert_eq!(lost(RejectReason::RedactedNarrative), 68);
    assert_eq!(lost(RejectReason::EmptyNarrative), 4);
    assert_eq!(lost(RejectReason::NotACrash), 1);
}

#[test]
fn the_sample_is_as_untidy_as_the_real_file() {
    let records = sample().records;
    let open: Vec<&CrashRecord> = records.iter().filter(|record| record.redaction == Redaction::Open).collect();
    let texts: BTreeSet<&str> = open.iter().map(|record| record.narrative.as_str()).collect();
    assert!(texts.len() > 330 && texts.len() < open.len(), "{} different of {} narratives", texts.len(), open.len());
    let some = |wanted: &dyn Fn(&CrashRecord) -> bool| records.iter().filter(|record| wanted(record)).count();
    assert!(some(&|record| record.sv_speed_mps.is_none()) >= 3);
    assert!(some(&|record| record.narrative.contains("[XXX]")) >= 240);
    assert!(some(&|record| record.narrative.contains('\n')) >= 240);
    assert!(some(&|record| record.narrative.starts_with("No update")) >= 5);
    assert!(some(&|record| record.cp_zones.is_empty()) >= 40);
    assert!(records.iter().map(|record| &record.entity).collect::<BTreeSet<_>>().len() >= 11);
    assert!(records.iter().map(|record| &record.partner).collect::<BTreeSet<_>>().len() >= 13);
}

#[test]
fn the_sample_tells_a_story_in_many_ways() {
    let mut openings: BTreeMap<String, usize> = BTreeMap::new();
    for record in sample().records.iter().filter(|record| record.id.version == 1 && record.narrative.len() > 200) {
        // What follows the first line, where the company has one, and no compass directions.
        let told = record.narrative.split_once('\n').map_or(record.narrative.as_str(), |(_, told)| told);
        let words: Vec<&str> = told.split_whitespace().filter(|word| !word.ends_with("bound")).take(12).collect();
        *openings.entry(words.join(" ")).or_default() += 1;
    }
    let (most, times) = openings.iter().max_by_key(|(_, times)| **times).unwrap();
    assert!(openings.len() > 200 && *times <= 8, "{} ways to begin; {times} times: {most}", openings.len());
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
