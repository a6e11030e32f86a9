//! What an account leaves open and a staging chooses.

use crate::usual::{ROLLING_MPS, STOOD_S};

/// Chosen numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Choices {
    /// The partner's speed at the contact, in shares of the usual one of its kind.
    pub(crate) partner_speed: f64,
    /// Speed of an ego that comes to a stop, before it brakes. [m/s]
    pub(crate) rolling_mps: f64,
    /// How long an ego that came to a stop has stood at the contact. [s]
    pub(crate) stood_s: f64,
    /// The last stand of the ego, and of the partner, began so much earlier than is usual. [s]
    pub(crate) longer_s: [f64; 2],
}

impl Default for Choices {
    fn default() -> Self {
        Self { partner_speed: 1.0, rolling_mps: ROLLING_MPS, stood_s: STOOD_S, longer_s: [0.0; 2] }
    }
}
