//! Why a crash is not told.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Why the crash of an account is not told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Untold {
    /// Nobody says what happened: no partner, no contact.
    NoAccount,
    /// The two never touched: others crashed.
    OthersOnly,
    /// The place cannot be drawn yet: a roundabout.
    Place,
    /// It came from above, or touched the roof alone.
    FromAbove,
    /// No way of touching fits the told zones, states and directions.
    NoContact,
    /// What fits has no room on the road that is told.
    NoRoom,
    /// It was staged, and the rollout does not show every told fact.
    NotShown,
}

impl Untold {
    /// For tables.
    pub const fn label(self) -> &'static str {
        match self {
            Self::NoAccount => "no account of a contact",
            Self::OthersOnly => "the subject vehicle was not touched",
            Self::Place => "the place cannot be drawn yet",
            Self::FromAbove => "it came from above",
            Self::NoContact => "no contact fits the told zones and directions",
            Self::NoRoom => "no room on the told road",
            Self::NotShown => "a told fact is not shown",
        }
    }
}

impl fmt::Display for Untold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.label())
    }
}

impl std::error::Error for Untold {}
