//! What the tests share: a builder of record sets, the paper's profile, and the real file where it is at hand.

use recrash_model::profile::SystemProfile;
use recrash_model::record::{
    Coded, CrashRecord, Edition, Engagement, Provenance, RecordRef, RecordSet, Redaction, Severity,
};
use recrash_model::template::{Movement, RoadType, Template};
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};

/// The paper's profile.
pub fn paper() -> SystemProfile {
    toml::from_str(include_str!("../../../../../profiles/paper.toml")).expect("profiles/paper.toml is a profile")
}

/// A template on an intersection without work zone.
pub fn crossing(sv: Movement, cp: Movement) -> Template {
    Template { road: RoadType::Intersection, sv, cp, work_zone: false }
}

/// Records of these templates and narratives, all usable.
pub fn record_set(records: &[(Template, &str)]) -> RecordSet {
    let records: Vec<CrashRecord> = records
        .iter()
        .enumerate()
        .map(|(i, (template, narrative))| CrashRecord {
            id: RecordRef { report_id: format!("T-{i}"), version: 1 },
            incident_id: None,
            entity: "Tester".to_owned(),
            vehicle: String::new(),
            when: None,
            time_of_day_min: None,
            place: String::new(),
            road: Coded::Known(template.road),
            work_zone: template.work_zone,
            surface: None,
            lighting: None,
            weather: Vec::new(),
            posted_speed_mps: None,
            partner: Coded::Blank,
            cp_movement: Coded::Known(template.cp),
            sv_movement: Coded::Known(template.sv),
            sv_speed_mps: None,
            sv_zones: Vec::new(),
            cp_zones: Vec::new(),
            severity: Coded::Known(Severity::None),
            towed: Default::default(),
            airbags: Default::default(),
            engagement: Coded::Known(Engagement::Ads),
            narrative: (*narrative).to_owned(),
            redaction: Redaction::Open,
            provenance: Provenance { file: "t.csv".to_owned(), edition: Edition::Second, row: i as u64 + 1 },
            reading: None,
        })
        .collect();
    let usable = (0..records.len()).collect();
    RecordSet {
        files: Vec::new(),
        records,
        usable,
        rejects: Vec::new(),
        funnel: Vec::new(),
        untold: Default::default(),
    }
}

/// Records of these templates, one narrative coordinate each, as a record set and the rows of an embedding.
pub fn on_a_line(records: &[(Template, f32)]) -> (RecordSet, Vec<[f32; 1]>) {
    let set: Vec<(Template, &str)> = records.iter().map(|(template, _)| (*template, "")).collect();
    (record_set(&set), records.iter().map(|(_, x)| [*x]).collect())
}

/// The built-in sample under the paper's profile.
pub fn sample() -> RecordSet {
    read(SAMPLE_NAME, SAMPLE_CSV.as_bytes())
}

/// NHTSA's file up to June 2025; where it is not there, the test is skipped.
pub fn real_file() -> Option<RecordSet> {
    let name = "ads-2021-06-to-2025-06.csv";
    let path = recrash_testing::shared(&format!("data/nhtsa/{name}"))?;
    Some(read(name, &std::fs::read(path).expect("a readable file")))
}

fn read(name: &str, bytes: &[u8]) -> RecordSet {
    ingest(&[SourceText { name, bytes }], &paper()).expect("a readable file").value
}
