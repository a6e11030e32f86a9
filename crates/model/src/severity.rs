//! How bad a contact is.

use serde::{Deserialize, Serialize};

/// One contact of two road users: what the collision does to both, by momentum.
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
