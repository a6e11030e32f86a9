//! Causes of failures: what the ego did, or did not do, that led to one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What led to a failure, told from the rollout alone. Rules and limits: `docs/models/causes.md`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// It did not react to somebody whose path crosses its own.
    IgnoredCrossing,
    /// It did not react to somebody who came towards it.
    IgnoredOncoming,
    /// It did not react to somebody ahead in its way.
    IgnoredAhead,
    /// It turned across the way of somebody who had a straight one.
    TurnedAcross,
    /// It moved sideways into somebody beside it.
    MovedInto,
    /// Somebody moved sideways into its way, and it did not react in time.
    MetCutIn,
    /// It followed so close that braking in time was not possible.
    FollowedTooClosely,
    /// It reacted, and too late.
    BrakedLate,
    /// It braked with nothing in its way, and was hit from behind.
    BrakedForNothing,
    /// It stood across a way on which others drive another way than it, and was hit.
    StoodInTheWay,
    /// It stood in its own way, and was hit.
    StruckStanding,
    /// It moved, and was hit from behind or from the side by somebody it could not have seen ahead.
    WasStruck,
    /// It hit a thing that stands or lies.
    HitObject,
    /// It left the road.
    LeftRoad,
    /// It stopped for good where nothing asked for it.
    StoppedForGood,
    /// It passed somebody too near.
    PassedTooNear,
}

impl Cause {
    /// Every cause, in the order in which the rules ask.
    pub const ALL: [Self; 16] = [
        Self::StoodInTheWay,
        Self::StruckStanding,
        Self::BrakedForNothing,
        Self::TurnedAcross,
        Self::MovedInto,
        Self::WasStruck,
        Self::MetCutIn,
        Self::IgnoredCrossing,
        Self::IgnoredOncoming,
        Self::IgnoredAhead,
        Self::FollowedTooClosely,
        Self::BrakedLate,
        Self::HitObject,
        Self::LeftRoad,
        Self::StoppedForGood,
        Self::PassedTooNear,
    ];

    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::IgnoredCrossing => "did not react to crossing traffic",
            Self::IgnoredOncoming => "did not react to oncoming traffic",
            Self::IgnoredAhead => "did not react to somebody ahead",
            Self::TurnedAcross => "turned across somebody's way",
            Self::MovedInto => "moved sideways into somebody",
            Self::MetCutIn => "did not react in time to a cut-in",
            Self::FollowedTooClosely => "followed too closely",
            Self::BrakedLate => "braked late",
            Self::BrakedForNothing => "braked for nothing, hit from behind",
            Self::StoodInTheWay => "stood where it blocks others",
            Self::StruckStanding => "was struck while it stood",
            Self::WasStruck => "was struck by somebody not ahead",
            Self::HitObject => "hit a thing on its way",
            Self::LeftRoad => "left the road",
            Self::StoppedForGood => "stopped for good for no reason",
            Self::PassedTooNear => "passed too near",
        }
    }
}
