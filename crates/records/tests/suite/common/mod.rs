//! What the tests share: profiles, and the real files where they are at hand.

pub mod builder;

use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::record::RecordSet;
use recrash_model::{Diagnostic, Outcome};
use recrash_records::{SourceText, ingest};

pub const ARCHIVE: &str = "ads-2021-06-to-2025-06.csv";
pub const CURRENT: &str = "ads-2025-06-to-2026-01.csv";

/// The paper's profile.
pub fn paper() -> SystemProfile {
    toml::from_str(include_str!("../../../../../profiles/paper.toml")).expect("profiles/paper.toml is a profile")
}

/// The paper's profile with one record an incident.
pub fn one_per_incident() -> SystemProfile {
    let mut profile = paper();
    profile.records.dedupe = Dedupe::Incident;
    profile
}

/// A file of NHTSA's; where it is not there, the test is skipped.
pub fn real_file(name: &str) -> Option<Vec<u8>> {
    let path = recrash_testing::shared(&format!("data/nhtsa/{name}"))?;
    Some(std::fs::read(path).expect("a readable file"))
}

/// Ingests one text under the paper's profile.
pub fn ingest_bytes(bytes: &[u8]) -> Outcome<RecordSet> {
    ingest(&[SourceText { name: "test.csv", bytes }], &paper()).expect("a readable file")
}

/// Codes of the diagnostics, in order.
pub fn codes(diagnostics: &[Diagnostic]) -> Vec<&str> {
    diagnostics.iter().map(|diagnostic| diagnostic.code.as_str()).collect()
}

/// The one diagnostic with this code.
pub fn diagnostic<'a>(outcome: &'a Outcome<RecordSet>, code: &str) -> &'a Diagnostic {
    let mut found = outcome.diagnostics.iter().filter(|diagnostic| diagnostic.code == code);
    let one = found.next().unwrap_or_else(|| panic!("no {code} in {:#?}", outcome.diagnostics));
    assert!(found.next().is_none(), "more than one {code} in {:#?}", outcome.diagnostics);
    one
}
