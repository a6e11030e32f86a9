//! One run in numbers.

use recrash_model::cause::Cause;
use recrash_model::metrics::{Answer, Check, FindingKind};
use recrash_model::preventability::{Bracket, Preventability};
use recrash_model::run::JudgedRun;
use recrash_model::severity::Severity;
use serde::{Deserialize, Serialize};

/// One run in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunSummary {
    /// Least box gap to a scripted partner, or to a thing where nobody else is in the scene. [m]
    pub min_gap_m: Option<f64>,
    /// When. [s]
    pub min_gap_time_s: Option<f64>,
    /// Least distance of centres to a scripted partner. [m]
    pub min_centre_distance_m: Option<f64>,
    /// Contact with a road user: kind of collision.
    pub contact: Option<String>,
    /// Change of velocity of the ego and of the other in that contact; where there is none, in that with an obstacle. [m/s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delta_v_mps: Option<[f64; 2]>,
    /// Nobody sits in or on that other one: it is an animal, or a thing.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub nobody: bool,
    /// Probability that it injures somebody seriously, where a published curve covers it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub serious_injury: Option<f64>,
    /// What led to the failure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<Cause>,
    /// What reference drivers make of the contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preventability: Option<Bracket>,
    /// Whether the ego failed, by the profile's criteria.
    pub failed: bool,
    /// Kinds of findings, each once, failures first.
    #[serde(with = "labels")]
    pub findings: Vec<FindingKind>,
    /// Whether a system under test came into the situation of its record; absent where that was not asked of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub met: Option<bool>,
    /// Whether it is true to its record; absent where it is held against the situation alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faithful: Option<Answer>,
    /// Facts that are not shown: what is told and what was observed.
    pub unfaithful: Vec<String>,
    /// Facts that cannot be shown.
    #[serde(default)]
    pub unchecked: Vec<String>,
}

impl RunSummary {
    pub(crate) fn new(run: &JudgedRun) -> Self {
        let told = |c: &Check| format!("{}: expected {}, observed {}", c.kind.label(), c.expected, c.observed);
        Self {
            min_gap_m: run.min_gap_m(),
            min_gap_time_s: run.least_gap().map(|gap| gap.time_s),
            min_centre_distance_m: run.metrics.min_centre_distance.map(|d| d.value),
            contact: run.metrics.contact.as_ref().map(|contact| contact.kind.label().to_owned()),
            delta_v_mps: run
                .severity
                .as_ref()
                .map(|severity| [severity.first.delta_v_mps, severity.second.delta_v_mps]),
            nobody: run.severity.as_ref().is_some_and(|severity| severity.nobody.is_some()),
            serious_injury: run.severity.as_ref().and_then(Severity::serious_injury),
            cause: run.cause,
            preventability: run.preventability.as_ref().map(Preventability::bracket),
            failed: run.failed(),
            findings: run.finding_kinds(),
            met: run.situation_met(),
            faithful: run.situation_met().is_none().then(|| run.faithful()),
            unfaithful: run.verdict.failures().map(told).collect(),
            unchecked: run.verdict.unchecked().map(|check| check.kind.label().to_owned()).collect(),
        }
    }

    /// The kinds of findings, in words.
    pub fn findings_in_words(&self) -> String {
        self.findings.iter().map(|kind| kind.label()).collect::<Vec<_>>().join(", ")
    }

    /// Whether it failed by being struck while it stood, seldom by what it drove.
    pub fn struck_standing(&self) -> bool {
        self.failed && self.cause == Some(Cause::StruckStanding)
    }

    /// Whether the ego brakes harder than tyres let a vehicle, anywhere.
    pub fn brakes_beyond_tyres(&self) -> bool {
        self.findings.contains(&FindingKind::BrakingBeyondTyres)
    }

    /// What findings are ranked by: the greater change of velocity of the two, of a contact with an obstacle, an animal or a
    /// thing the ego's; 0 without any. [m/s]
    pub fn harm_mps(&self) -> f64 {
        match (self.delta_v_mps, &self.contact) {
            (Some([ego, other]), Some(_)) if !self.nobody => ego.max(other),
            (Some([ego, _]), _) => ego,
            (None, _) => 0.0,
        }
    }
}

/// Findings by their labels, as the file has them.
mod labels {
    use recrash_model::metrics::FindingKind;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(kinds: &[FindingKind], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(kinds.iter().map(|kind| kind.label()))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<FindingKind>, D::Error> {
        let labels = Vec::<String>::deserialize(from)?;
        let kind = |label: &String| {
            let known = FindingKind::ALL.into_iter().find(|kind| kind.label() == label);
            known.ok_or_else(|| Error::custom(format!("no finding is called \"{label}\"")))
        };
        labels.iter().map(kind).collect()
    }
}
