//! What holds for any bytes given as a crash file. Shared by the fuzz target and by a test over its corpus.

use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_records::{SourceText, ingest};
use std::sync::LazyLock;

static PROFILE: LazyLock<SystemProfile> = LazyLock::new(|| {
    toml::from_str(include_str!("../../profiles/paper.toml")).expect("profiles/paper.toml is a profile")
});

/// Reading never panics, and every row in is usable or rejected: with every row counted, and with one report an incident.
pub fn check(bytes: &[u8]) {
    let mut profile = PROFILE.clone();
    for dedupe in [Dedupe::None, Dedupe::Incident] {
        profile.records.dedupe = dedupe;
        let Ok(outcome) = ingest(&[SourceText { name: "fuzz.csv", bytes }], &profile) else { continue };
        let set = outcome.value;
        let rows: usize = set.files.iter().map(|part| part.rows).sum();
        assert_eq!(rows, set.usable.len() + set.rejects.len());
        assert_eq!(set.funnel.first().map(|step| step.remaining), Some(rows));
        assert_eq!(set.funnel.last().map(|step| step.remaining), Some(set.usable.len()));
        assert!(set.usable.iter().all(|&i| set.records.get(i).is_some_and(|record| record.template().is_some())));
    }
}
