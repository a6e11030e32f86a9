//! Reviews: what a reader finds who holds a replay against the report of its crash, and knows nothing else.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Longest note of a review. [characters]
pub const LONGEST_NOTE: usize = 300;

/// Whether a replay shows what is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shown {
    /// It does.
    Yes,
    /// It shows something else.
    No,
    /// The report says nothing of it.
    Untold,
}

/// A replay held against its report, in seven questions.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Review {
    /// Who the ego touches first is of the told kind, and who else is told to have touched before that did.
    pub who: Shown,
    /// The partner comes from the told direction.
    pub side: Shown,
    /// Both do what is told of the time just before the contact, in the told sequence.
    pub movements: Shown,
    /// Who is told to have been at the place of the contact first was.
    pub order: Shown,
    /// Who is told to stand at the contact stands, who is told to move moves.
    pub standstill: Shown,
    /// Who is told to have hit the other does.
    pub striker: Shown,
    /// The touched parts are the told ones or next to them.
    pub zones: Shown,
    /// Where one of them is `no`: what is told and what is shown instead, in one sentence. Else empty.
    #[serde(default)]
    #[schemars(length(max = 300))]
    pub note: String,
}

impl Review {
    /// Every question by its name, in order.
    pub fn questions(&self) -> [(&'static str, Shown); 7] {
        [
            ("who", self.who),
            ("side", self.side),
            ("movements", self.movements),
            ("order", self.order),
            ("standstill", self.standstill),
            ("striker", self.striker),
            ("zones", self.zones),
        ]
    }

    /// What the replay shows otherwise than told.
    pub fn wrong(&self) -> impl Iterator<Item = &'static str> {
        self.questions().into_iter().filter(|(_, shown)| *shown == Shown::No).map(|(name, _)| name)
    }

    /// Whether the replay shows the crash that is told.
    pub fn is_right(&self) -> bool {
        self.wrong().next().is_none()
    }

    /// One word for tables.
    pub fn label(&self) -> &'static str {
        if self.is_right() { "right" } else { "wrong" }
    }
}

/// A review, and whose it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReviewBy {
    /// The language model that read.
    pub model: String,
    /// What it found.
    pub review: Review,
}
