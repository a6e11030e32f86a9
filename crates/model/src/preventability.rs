//! Whether the reference drivers of UN R157 would have prevented a contact, on its straight-road model. How other egos fare in
//! the whole scenario is another question: [`crate::triage`].

use serde::{Deserialize, Serialize};

/// What the reference drivers that cover a contact make of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Preventability {
    /// Closing speed along the road at the contact that happened. [m/s]
    pub closing_speed_mps: f64,
    /// One for each driver whose source covers the conflict; none where no source does.
    pub drivers: Vec<InTheirPlace>,
}

/// One reference driver in the ego's place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InTheirPlace {
    /// Driver.
    pub driver: String,
    /// When it sees danger; absent where it sees none until the contact. [s]
    pub reacts_at_s: Option<f64>,
    /// Closing speed along the road at its own contact; absent where it avoids it. [m/s]
    pub closing_speed_mps: Option<f64>,
}

/// The bracket over the drivers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bracket {
    /// Every driver that covers it avoids it.
    AvoidedByAll,
    /// Some do.
    AvoidedBySome,
    /// None does.
    AvoidedByNone,
    /// No driver's source covers it.
    NotCovered,
}

impl Preventability {
    /// What all of them together say.
    pub fn bracket(&self) -> Bracket {
        let avoid = self.drivers.iter().filter(|driver| driver.closing_speed_mps.is_none()).count();
        match avoid {
            _ if self.drivers.is_empty() => Bracket::NotCovered,
            0 => Bracket::AvoidedByNone,
            some if some < self.drivers.len() => Bracket::AvoidedBySome,
            _ => Bracket::AvoidedByAll,
        }
    }

    /// By how much the best and the worst of them lower the closing speed, 0 to 1; absent where none covers it.
    pub fn mitigation(&self) -> Option<(f64, f64)> {
        let left = |driver: &InTheirPlace| driver.closing_speed_mps.unwrap_or(0.0) / self.closing_speed_mps.max(1e-9);
        let lowered = self.drivers.iter().map(|driver| (1.0 - left(driver)).clamp(0.0, 1.0));
        let ends = |(least, most): (f64, f64), lowered: f64| (least.min(lowered), most.max(lowered));
        (!self.drivers.is_empty()).then(|| lowered.fold((1.0, 0.0), ends))
    }
}

impl Bracket {
    /// Words for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::AvoidedByAll => "avoided by all reference drivers",
            Self::AvoidedBySome => "avoided by some reference drivers",
            Self::AvoidedByNone => "avoided by no reference driver",
            Self::NotCovered => "not covered by any reference driver",
        }
    }
}
