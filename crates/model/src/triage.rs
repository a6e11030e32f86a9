//! Triage: what a failure of the system under test is worth, told from how other egos fare in the same scenario.

use crate::metrics::{FindingKind, Timed};
use crate::rollout::TerminationKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The triages' format tag.
pub const TRIAGE_FORMAT: &str = "recrash.triage/1";

/// The ego that stands for a competent and careful driver.
pub const REFERENCE_EGO: &str = "reference";

/// What a failure is worth. Defined in `docs/models/triage.md`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FailureClass {
    /// The reference driver avoids it; somebody else fails too.
    Avoidable,
    /// Nobody but the system under test fails.
    Quirk,
    /// The reference driver fails, but somebody who reacts sooner or brakes harder does not.
    BeyondReference,
    /// Everybody fails.
    Unavoidable,
}

impl FailureClass {
    /// Every class, in the order of tables.
    pub const ALL: [Self; 4] = [Self::Avoidable, Self::Quirk, Self::BeyondReference, Self::Unavoidable];

    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Avoidable => "avoidable",
            Self::Quirk => "quirk",
            Self::BeyondReference => "beyond reference",
            Self::Unavoidable => "unavoidable",
        }
    }

    /// In one sentence.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Avoidable => "the careful reference driver avoids it, another ego fails as well",
            Self::Quirk => "only the system under test fails; every other ego avoids it",
            Self::BeyondReference => "the reference driver fails, an ego that reacts sooner avoids it",
            Self::Unavoidable => "every ego fails",
        }
    }
}

/// How another ego fared in the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EgoOutcome {
    /// Ego.
    pub ego: String,
    /// Whether it failed, by the profile's criteria.
    pub failed: bool,
    /// Kinds of its findings, each once, failures first.
    pub findings: Vec<FindingKind>,
    /// Its least box gap to a scripted partner. [m]
    pub min_gap: Option<Timed>,
    /// How its run ended.
    pub termination: TerminationKind,
    /// Hash of its states.
    pub state_hash: String,
}

/// The triage of one failure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Triage {
    /// Always [`TRIAGE_FORMAT`].
    pub format: String,
    /// What the failure is worth.
    pub class: FailureClass,
    /// How the other egos fared, in the simulator's order.
    pub others: Vec<EgoOutcome>,
}

impl Triage {
    /// The triage of a scenario that the system under test fails.
    pub fn new(others: Vec<EgoOutcome>) -> Self {
        let avoided = |outcome: &EgoOutcome| !outcome.failed;
        let class = if !others.is_empty() && others.iter().all(avoided) {
            FailureClass::Quirk
        } else if others.iter().any(|outcome| outcome.ego == REFERENCE_EGO && avoided(outcome)) {
            FailureClass::Avoidable
        } else if others.iter().any(avoided) {
            FailureClass::BeyondReference
        } else {
            FailureClass::Unavoidable
        };
        Self { format: TRIAGE_FORMAT.to_owned(), class, others }
    }

    /// Names of the egos that avoid it.
    pub fn avoided_by(&self) -> impl Iterator<Item = &str> {
        self.others.iter().filter(|outcome| !outcome.failed).map(|outcome| outcome.ego.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn class(others: &[(&str, bool)]) -> FailureClass {
        let outcome = |&(ego, failed): &(&str, bool)| EgoOutcome {
            ego: ego.to_owned(),
            failed,
            findings: Vec::new(),
            min_gap: None,
            termination: TerminationKind::Arrived,
            state_hash: String::new(),
        };
        Triage::new(others.iter().map(outcome).collect()).class
    }

    #[test]
    fn classes_are_those_of_the_page() {
        assert_eq!(class(&[("idm", false), ("reference", false)]), FailureClass::Quirk);
        assert_eq!(class(&[("idm", true), ("reference", false)]), FailureClass::Avoidable);
        assert_eq!(class(&[("idm", false), ("reference", true)]), FailureClass::BeyondReference);
        assert_eq!(class(&[("idm", true), ("reference", true)]), FailureClass::Unavoidable);
        assert_eq!(class(&[("metadrive-idm", true), ("idm", false), ("reference", false)]), FailureClass::Avoidable);
        // The reference itself under test.
        assert_eq!(class(&[("metadrive-idm", true), ("idm", false)]), FailureClass::BeyondReference);
        assert_eq!(class(&[]), FailureClass::Unavoidable);
    }
}
