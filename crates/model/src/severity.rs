//! How bad a contact is.

use crate::kinds::PartnerKind;
use crate::scenario::ObstacleKind;
use serde::{Deserialize, Serialize};

/// What a collision does at the place where two bodies touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Speed apart over speed together, across the plane of contact: 0 for none that is given back, 1 for all.
    pub restitution: f64,
    /// Greatest impulse along the plane of contact over that across it: 0 for smooth sides.
    pub friction: f64,
}

impl Impact {
    /// Of bodies that move on: cars at town speeds keep little of the closing speed; assumed between the 0.4 of very slow
    /// bumper contacts and the 0 to 0.1 of faster ones. Friction is assumed, car bodies are taken for 0.3 to 0.6.
    pub const OF_MOTION: Self = Self { restitution: 0.1, friction: 0.5 };

    /// Of the change of velocity by which risks are told: as above but without restitution, as in the reconstructions that
    /// the curves for occupants are fitted to (niehoff2006).
    pub const OF_SEVERITY: Self = Self { restitution: 0.0, ..Self::OF_MOTION };
}

impl Default for Impact {
    fn default() -> Self {
        Self::OF_SEVERITY
    }
}

/// One contact of two road users, or of one with an obstacle: what the collision does to both, by momentum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Severity {
    /// Magnitude of the relative velocity. [m/s]
    pub closing_speed_mps: f64,
    /// Its part across the plane in which the two touch; 0 where they only slide along each other. [m/s]
    pub normal_speed_mps: f64,
    /// Share of the narrower one's extent along that plane that both cover, 0 to 1.
    pub overlap: f64,
    /// The first, which is the ego where there is one.
    pub first: Suffered,
    /// The other.
    pub second: Suffered,
    /// What the other is, where it is an obstacle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<ObstacleKind>,
    /// What the other is, where it moves by a plan and nobody sits on it: an animal, debris, a cart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nobody: Option<PartnerKind>,
}

impl Severity {
    /// What findings are ranked by: the greater change of velocity of the two; of a contact with an obstacle, an animal or a thing, in which
    /// nobody sits, that of the first alone. [m/s]
    pub fn harm_mps(&self) -> f64 {
        match (self.obstacle, self.nobody) {
            (None, None) => self.first.delta_v_mps.max(self.second.delta_v_mps),
            _ => self.first.delta_v_mps,
        }
    }

    /// What the other is called in tables.
    pub fn other(&self) -> &'static str {
        let nobody = self.nobody.map_or("partner", PartnerKind::label);
        self.obstacle.map_or(nobody, ObstacleKind::label)
    }

    /// The greater probability that somebody on one of the two sides is at least seriously injured; `None` where no published
    /// curve covers the contact.
    pub fn serious_injury(&self) -> Option<f64> {
        let risks = self.first.risks.iter().chain(&self.second.risks);
        let serious = risks.filter(|risk| risk.outcome == InjuryOutcome::Mais3).map(|risk| risk.probability);
        serious.max_by(f64::total_cmp)
    }
}

/// What one road user suffers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Suffered {
    /// Its speed at the contact. [m/s]
    pub impact_speed_mps: f64,
    /// Its mass; absent for what stands firm. [kg]
    pub mass_kg: Option<f64>,
    /// Change of its velocity. [m/s]
    pub delta_v_mps: f64,
    /// Where the force comes from, on a clock whose 12 is straight ahead; absent without a force.
    pub force_clock: Option<u8>,
    /// Risks to the people in or on it, or to itself; empty where no published curve covers the contact.
    pub risks: Vec<InjuryRisk>,
}

/// Probability of one outcome for one person.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InjuryRisk {
    /// At least this.
    pub outcome: InjuryOutcome,
    /// 0 to 1.
    pub probability: f64,
    /// Who says so.
    pub curve: RiskCurve,
}

/// How badly somebody is hurt, at least: the worst injury on the Abbreviated Injury Scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InjuryOutcome {
    /// Minor.
    Mais1,
    /// Moderate.
    Mais2,
    /// Serious.
    Mais3,
    /// Severe.
    Mais4,
    /// Critical.
    Mais5,
    /// Dead.
    Fatal,
}

/// How far computed severity goes with what records report (`docs/models/severity.md`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeverityAgreement {
    /// Scenarios that tell their own crash with a contact of two road users.
    pub contacts: usize,
    /// Of those, the ones where the speeds of both at the contact are told, or they stood.
    pub speeds_told: usize,
    /// Rank correlations.
    pub ranks: Vec<RankAgreement>,
    /// Computed delta-v by reported injury, least harm first.
    pub by_injury: Vec<HarmLevel>,
}

/// A quantity against an outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RankAgreement {
    /// The quantity.
    pub measure: String,
    /// What the record reports.
    pub outcome: String,
    /// Incidents of which both are known.
    pub incidents: usize,
    /// Of those, the ones with any harm.
    pub harmed: usize,
    /// Spearman's rho, ties at their mean rank; `None` where all are alike.
    pub spearman: Option<Interval>,
    /// Kendall's tau-b; `None` where all are alike.
    pub kendall: Option<Interval>,
}

/// An estimate and its interval of 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Incidents of one reported injury.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HarmLevel {
    /// The injury that the record reports.
    pub injury: String,
    /// Incidents.
    pub incidents: usize,
    /// Median of the computed delta-v. [m/s]
    pub median_delta_v_mps: f64,
}

/// A published risk curve (`docs/models/severity.md`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RiskCurve {
    /// Occupants of light vehicles by delta-v, force from the front or from behind (wang2022).
    Wang2022,
    /// Pedestrians by the speed of the vehicle that strikes them with its front (tefft2013).
    Tefft2013,
    /// Pedestrians, cyclists, motorcyclists and car drivers who meet the front of a car, by closing speed and age (lubbe2022).
    Lubbe2022,
}

impl InjuryOutcome {
    /// Words for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::Mais1 => "minor injury",
            Self::Mais2 => "moderate injury",
            Self::Mais3 => "serious injury",
            Self::Mais4 => "severe injury",
            Self::Mais5 => "critical injury",
            Self::Fatal => "death",
        }
    }
}

impl RiskCurve {
    /// Key of its source in `docs/references.bib`.
    pub fn source(self) -> &'static str {
        match self {
            Self::Wang2022 => "wang2022",
            Self::Tefft2013 => "tefft2013",
            Self::Lubbe2022 => "lubbe2022",
        }
    }
}
