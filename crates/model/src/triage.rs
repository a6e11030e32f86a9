//! Triage: what a failure of the system under test is worth, told from how other egos fare in the same scenario.

use crate::metrics::{FindingKind, Timed};
use crate::rollout::TerminationKind;
use crate::run::{Crash, JudgedRun};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// The triages' format tag.
pub const TRIAGE_FORMAT: &str = "recrash.triage/3";

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
    /// Everybody fails as the system under test does.
    Unavoidable,
    /// Nobody gets through, but not all fail as the system under test does: whether its failure can be avoided is not told.
    Unclear,
}

impl FailureClass {
    /// Every class, in the order of tables.
    pub const ALL: [Self; 5] = [Self::Avoidable, Self::Quirk, Self::BeyondReference, Self::Unavoidable, Self::Unclear];

    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Avoidable => "avoidable",
            Self::Quirk => "quirk",
            Self::BeyondReference => "beyond reference",
            Self::Unavoidable => "unavoidable",
            Self::Unclear => "unclear",
        }
    }

    /// In one sentence, about the other egos in the same scenario. What the reference drivers of UN R157 make of a contact is
    /// another question: [`crate::preventability::Bracket`].
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Avoidable => "the ego `reference` avoids it, another ego fails as well",
            Self::Quirk => "only the system under test fails; every other ego avoids it",
            Self::BeyondReference => "the ego `reference` fails, one that reacts sooner avoids it",
            Self::Unavoidable => "every ego fails in the same way",
            Self::Unclear => "no ego gets through within what tyres give, but not all fail in the same way",
        }
    }
}

/// How another ego fared with what the system under test fails by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fared {
    /// Where the system under test crashes, it does not; else it does not fail at all.
    Avoids,
    /// The same, but by braking that tyres do not give: whether a vehicle can is not told.
    BeyondTyres,
    /// It fails in the same way: it crashes with the same one first, or comes as near.
    Alike,
    /// It fails in another way.
    Otherwise,
}

impl Fared {
    /// How the other run of a scenario that the system fails compares with the system's.
    pub fn of(system: &JudgedRun, other: &JudgedRun) -> Self {
        let crash = other.first_crash();
        let avoids = if other.brakes_beyond_tyres() { Self::BeyondTyres } else { Self::Avoids };
        let is_alike = match system.first_crash() {
            Some(_) if crash.is_none() => return avoids,
            None if !other.failed() => return avoids,
            Some(first) => crash == Some(first),
            None => {
                // Who touches somebody came near as well.
                let near = nearly_touched(system);
                let came_near = near.is_some()
                    && (nearly_touched(other) == near || crash.zip(near).is_some_and(|(crash, near)| crash == near));
                let stays = |run: &JudgedRun| run.failures().any(|kind| kind == FindingKind::Stuck);
                came_near || stays(system) && stays(other)
            }
        };
        if is_alike { Self::Alike } else { Self::Otherwise }
    }

    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Avoids => "avoids it",
            Self::BeyondTyres => "avoids it beyond tyres",
            Self::Alike => "does not",
            Self::Otherwise => "fails otherwise",
        }
    }
}

/// Whom the ego came nearest to, where it came too near to somebody.
fn nearly_touched(run: &JudgedRun) -> Option<Crash> {
    run.failures().find(|kind| *kind == FindingKind::NearMiss)?;
    let gaps = run.metrics.partners.iter().map(|partner| (partner.actor, partner.min_gap.value));
    gaps.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(actor, _)| Crash::RoadUser(actor))
}

/// How another ego fared in the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EgoOutcome {
    /// Ego.
    pub ego: String,
    /// Whether it failed, by the profile's criteria.
    pub failed: bool,
    /// How it fared with what the system under test fails by.
    pub fared: Fared,
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
    #[serde(deserialize_with = "known_format")]
    pub format: String,
    /// What the failure is worth.
    pub class: FailureClass,
    /// How the other egos fared, in the simulator's order.
    pub others: Vec<EgoOutcome>,
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    crate::formats::known(deserializer, TRIAGE_FORMAT)
}

impl Triage {
    /// The triage of a scenario that the system under test fails, of how the others fared there.
    pub fn new(others: Vec<EgoOutcome>) -> Self {
        let avoids = |other: &EgoOutcome| other.fared == Fared::Avoids;
        let class = if !others.is_empty() && others.iter().all(avoids) {
            FailureClass::Quirk
        } else if others.iter().any(|other| other.ego == REFERENCE_EGO && avoids(other)) {
            FailureClass::Avoidable
        } else if others.iter().any(avoids) {
            FailureClass::BeyondReference
        } else if others.iter().all(|other| other.fared == Fared::Alike) {
            FailureClass::Unavoidable
        } else {
            FailureClass::Unclear
        };
        Self { format: TRIAGE_FORMAT.to_owned(), class, others }
    }
}

#[cfg(test)]
mod tests {
    use super::Fared::{Alike, Avoids, BeyondTyres, Otherwise};
    use super::*;

    fn class(others: &[(&str, Fared)]) -> FailureClass {
        let outcome = |&(ego, fared): &(&str, Fared)| EgoOutcome {
            ego: ego.to_owned(),
            failed: fared != Avoids,
            fared,
            findings: Vec::new(),
            min_gap: None,
            termination: TerminationKind::Arrived,
            state_hash: String::new(),
        };
        Triage::new(others.iter().map(outcome).collect()).class
    }

    #[test]
    fn classes_are_those_of_the_page() {
        let of = |idm, reference| class(&[("idm", idm), ("reference", reference)]);
        assert_eq!(of(Avoids, Avoids), FailureClass::Quirk);
        assert_eq!(of(Alike, Avoids), FailureClass::Avoidable);
        assert_eq!(of(Otherwise, Avoids), FailureClass::Avoidable);
        assert_eq!(of(Avoids, Alike), FailureClass::BeyondReference);
        assert_eq!(of(Alike, Alike), FailureClass::Unavoidable);
        assert_eq!(class(&[]), FailureClass::Unavoidable);
    }

    #[test]
    fn who_crashes_with_another_does_not_make_a_failure_unavoidable() {
        assert_eq!(class(&[("idm", Alike), ("reference", Otherwise)]), FailureClass::Unclear);
        assert_eq!(class(&[("idm", Otherwise), ("reference", Otherwise)]), FailureClass::Unclear);
        assert_eq!(class(&[("idm", Avoids), ("reference", Otherwise)]), FailureClass::BeyondReference);
    }

    #[test]
    fn who_avoids_it_beyond_tyres_makes_a_failure_neither_avoidable_nor_unavoidable() {
        assert_eq!(class(&[("idm", BeyondTyres), ("reference", Alike)]), FailureClass::Unclear);
        assert_eq!(class(&[("idm", BeyondTyres), ("reference", BeyondTyres)]), FailureClass::Unclear);
        assert_eq!(class(&[("idm", BeyondTyres), ("reference", Avoids)]), FailureClass::Avoidable);
    }

    #[test]
    fn the_reference_itself_may_be_under_test() {
        assert_eq!(class(&[("metadrive-idm", Alike), ("idm", Avoids)]), FailureClass::BeyondReference);
    }
}
