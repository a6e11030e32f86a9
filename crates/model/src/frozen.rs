//! Frozen suites: tests that run anywhere, without the crash file and without the suite they come from.

use crate::account::CrashType;
use crate::hash::Fnv;
use crate::metrics::Expectation;
use crate::origin::{Origin, RecordRef};
use crate::profile::SystemProfile;
use crate::scenario::{ScenarioDraft, Source};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// File by which a folder is a frozen suite.
pub const FROZEN_FILE: &str = "frozen.json";
/// The frozen suites' format tag.
pub const FROZEN_FORMAT: &str = "recrash.frozen/1";

/// A frozen suite: what stands in its `frozen.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenSuite {
    /// Always [`FROZEN_FORMAT`].
    pub format: String,
    /// Version of recrash that froze it.
    pub recrash: String,
    /// Name by its content: tests, and what counts as a failure.
    pub content: String,
    /// The profile as it was: what counts as a failure, the limits, and the ego where none is named.
    pub profile: SystemProfile,
    /// Whether the scenarios hold the text of their narratives.
    pub narratives: bool,
    /// The tests, by id.
    pub tests: Vec<FrozenTest>,
}

/// One test of a frozen suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenTest {
    /// Its scenario's id; no two of a suite are the same.
    pub id: String,
    /// Name of what is run, by its content: two tests of one name run the same, whoever tells of them.
    pub content: String,
    /// Its scenario's file, from the suite's folder.
    pub scenario: String,
    /// SHA-256 of that file.
    pub sha256: String,
    /// The account's file, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub account: Option<FrozenFile>,
    /// Whose crash it is.
    pub about: About,
    /// What a rollout must show to be true to the record, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expectation: Option<Expectation>,
}

/// A file of a frozen suite.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenFile {
    /// From the suite's folder.
    pub file: String,
    /// SHA-256 of it.
    pub sha256: String,
}

/// Whose crash a test tells.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// Whose crash it is.
    pub provenance: Provenance,
    /// The record that is told; none of an invented crash.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub told: Option<RecordRef>,
    /// The incident.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub incident: Option<String>,
    /// Every report of it that is known.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reports: Vec<RecordRef>,
    /// Which of the eleven crash types it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crash_type: Option<CrashType>,
}

/// Whose crash a test tells, in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Provenance {
    /// The record's own.
    Own,
    /// Another real record's.
    Other,
    /// Nobody's.
    Invented,
    /// Nobody says.
    #[default]
    Unknown,
}

impl Provenance {
    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Other => "other",
            Self::Invented => "invented",
            Self::Unknown => "unknown",
        }
    }
}

impl About {
    /// What a scenario says of itself.
    pub fn of(source: &Source) -> Self {
        let (provenance, told) = match &source.origin {
            None => (Provenance::Unknown, None),
            Some(Origin::Own) => (Provenance::Own, source.records.first().cloned()),
            Some(Origin::Other { record, .. }) => (Provenance::Other, Some(record.clone())),
            Some(Origin::Invented { .. }) => (Provenance::Invented, None),
        };
        Self { provenance, told, incident: None, reports: source.records.clone(), crash_type: None }
    }

    /// Its crash type, for tables.
    pub fn crash_type_label(&self) -> &'static str {
        self.crash_type.map_or("not stated", CrashType::label)
    }
}

/// Sixteen hexadecimal digits that name what a scenario runs: everything in it but where it came from.
pub fn scenario_content(draft: &ScenarioDraft) -> String {
    let bare = ScenarioDraft { source: Source { seed: draft.source.seed, ..Source::default() }, ..draft.clone() };
    let mut hash = Fnv::default();
    hash.write(serde_json::to_string(&bare).expect("a scenario can be written").as_bytes());
    hash.hexadecimal()
}

impl FrozenSuite {
    /// The name of a suite by its content.
    pub fn content_of(profile: &SystemProfile, tests: &[FrozenTest]) -> String {
        let mut hash = Fnv::default();
        hash.write_text(&serde_json::to_string(&profile.failure).expect("limits can be written"));
        for test in tests {
            hash.write_text(&test.id);
            hash.write_text(&test.content);
        }
        hash.hexadecimal()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_what_is_run_does_not_depend_on_who_tells_it() {
        let draft = ScenarioDraft { id: "a".to_owned(), duration_s: 10.0, ..ScenarioDraft::default() };
        let mut told = draft.clone();
        told.source.narrative = "A car stood.".to_owned();
        assert_eq!(scenario_content(&draft), scenario_content(&told));
        told.duration_s = 11.0;
        assert_ne!(scenario_content(&draft), scenario_content(&told));
    }
}
