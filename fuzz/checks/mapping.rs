//! What holds for any bytes given as a mapping file and the tables it maps. Shared by the fuzz target and by a test over
//! its corpus.

use recrash_model::profile::SystemProfile;
use recrash_records::{IngestOptions, Mapping, SourceText, ingest_with};
use std::sync::LazyLock;

static PROFILE: LazyLock<SystemProfile> = LazyLock::new(|| {
    toml::from_str(include_str!("../../profiles/paper.toml")).expect("profiles/paper.toml is a profile")
});

/// The bytes are a mapping file and up to two tables, parted by zero bytes. Reading never panics; every row of the main
/// table is usable or rejected; an error names the mapping file, and a line of it where it names one.
pub fn check(bytes: &[u8]) {
    let mut parts = bytes.splitn(3, |byte| *byte == 0);
    let Ok(text) = std::str::from_utf8(parts.next().unwrap_or_default()) else { return };
    let mapping = match Mapping::parse(text, "mapping.toml") {
        Ok(mapping) => mapping,
        Err(error) => {
            assert!(error.line.is_none_or(|line| (1..=text.split('\n').count()).contains(&line)), "{error}");
            assert!(!error.message.is_empty());
            return;
        }
    };
    let names = ["accident.csv", "vehicle.csv"];
    let files: Vec<SourceText<'_>> =
        names.into_iter().zip(parts).map(|(name, bytes)| SourceText { name, bytes }).collect();
    let profile = PROFILE.clone();
    let options = IngestOptions { filter: None, mapping: Some(&mapping) };
    let Ok(outcome) = ingest_with(&files, &profile, &options) else { return };
    let set = outcome.value;
    let rows: usize = set.files.iter().map(|part| part.rows).sum();
    assert_eq!(rows, set.usable.len() + set.rejects.len());
    assert!(set.usable.iter().all(|&i| set.records.get(i).is_some_and(|record| record.template().is_some())));
}
