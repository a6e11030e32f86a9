//! What narratives, scenarios and metrics say of a conflict with the same words: its kind, a side, who was first.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of collision by geometry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CollisionKind {
    /// The ego runs into the rear of the partner.
    RearEndByEgo,
    /// The partner runs into the rear of the ego.
    RearEndOfEgo,
    /// Front to front, on opposite headings.
    HeadOn,
    /// Crossing or turning paths: front to side.
    Angle,
    /// Side to side, on about the same heading.
    Sideswipe,
}

impl CollisionKind {
    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::RearEndByEgo => "rear-end by the ego",
            Self::RearEndOfEgo => "rear-end of the ego",
            Self::HeadOn => "head-on",
            Self::Angle => "angle",
            Self::Sideswipe => "sideswipe",
        }
    }
}

/// Left or right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Left.
    Left,
    /// Right.
    Right,
}

/// Who reached the place of the conflict first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FirstMover {
    /// The ego.
    Sv,
    /// The partner.
    Cp,
    /// Both at about the same time.
    Both,
}

impl FirstMover {
    /// For tables and sentences.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sv => "the ego",
            Self::Cp => "the partner",
            Self::Both => "both at about the same time",
        }
    }
}
