//! Triage: what a failure of the system under test is worth, told from how other egos fare in the same scenario.

use crate::metrics::{FindingKind, Timed};
use crate::rollout::TerminationKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The triages' format tag.
pub const TRIAGE_FORMAT: &str = "recrash.triage/1";

/// The ego that stands for a competent and careful driver.
pub const REFERENCE_EGO: &str = "reference";

/// What a failure of the system under test is worth. Defined in `docs/models/triage.md`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FailureClass {
    /// The ego `reference` avoids it; somebody else fails too.
    Avoidable,
    /// Nobody but the system under test fails.
    Quirk,
    /// The ego `reference` fails, but somebody who reacts sooner or brakes harder does not.
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

    /// In one sentence, about the other egos in the same scenario. What the reference drivers of UN R157 make of a contact is
    /// another question: [`crate::preventability::Bracket`].
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Avoidable => "the ego `reference` avoids it, another ego fails as well",
            Self::Quirk => "only the system under test fails; every other ego avoids it",
            Self::BeyondReference => "the ego `reference` fails, one that reacts sooner avoids it",
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
    /// Whether it avoids the failure: where the system under test crashes, it does not; else it does not fail at all.
    pub avoids: bool,
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
    /// The triage of a scenario that the system under test fails with findings of these kinds.
    pub fn new(system: &[FindingKind], mut others: Vec<EgoOutcome>) -> Self {
        let crashes = |kinds: &[FindingKind]| kinds.iter().any(|kind| kind.is_crash());
        for other in &mut others {
            other.avoids = if crashes(system) { !crashes(&other.findings) } else { !other.failed };
        }
        let class = if !others.is_empty() && others.iter().all(|other| other.avoids) {
            FailureClass::Quirk
        } else if others.iter().any(|other| other.ego == REFERENCE_EGO && other.avoids) {
            FailureClass::Avoidable
        } else if others.iter().any(|other| other.avoids) {
            FailureClass::BeyondReference
        } else {
            FailureClass::Unavoidable
        };
        Self { format: TRIAGE_FORMAT.to_owned(), class, others }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use FindingKind::{Contact, HardBraking, NearMiss};

    fn class(system: FindingKind, others: &[(&str, FindingKind)]) -> FailureClass {
        let outcome = |&(ego, finding): &(&str, FindingKind)| EgoOutcome {
            ego: ego.to_owned(),
            failed: finding.is_failure(),
            avoids: false,
            findings: vec![finding],
            min_gap: None,
            termination: TerminationKind::Arrived,
            state_hash: String::new(),
        };
        Triage::new(&[system], others.iter().map(outcome).collect()).class
    }

    #[test]
    fn classes_are_those_of_the_page() {
        let of = |idm, reference| class(Contact, &[("idm", idm), ("reference", reference)]);
        assert_eq!(of(HardBraking, HardBraking), FailureClass::Quirk);
        assert_eq!(of(Contact, HardBraking), FailureClass::Avoidable);
        assert_eq!(of(HardBraking, Contact), FailureClass::BeyondReference);
        assert_eq!(of(Contact, Contact), FailureClass::Unavoidable);
        assert_eq!(class(Contact, &[]), FailureClass::Unavoidable);
    }

    #[test]
    fn who_only_comes_near_avoids_a_crash_but_not_a_near_miss() {
        let others = [("idm", NearMiss), ("reference", NearMiss)];
        assert_eq!(class(Contact, &others), FailureClass::Quirk);
        assert_eq!(class(NearMiss, &others), FailureClass::Unavoidable);
    }

    #[test]
    fn the_reference_itself_may_be_under_test() {
        assert_eq!(class(Contact, &[("metadrive-idm", Contact), ("idm", NearMiss)]), FailureClass::BeyondReference);
    }
}
