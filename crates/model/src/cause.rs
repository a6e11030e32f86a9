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
            Self::IgnoredAhead => "did not react to a road user ahead",
            Self::TurnedAcross => "turned across another's way",
            Self::MovedInto => "moved sideways into a road user",
            Self::MetCutIn => "did not react in time to a cut-in",
            Self::FollowedTooClosely => "followed too closely",
            Self::BrakedLate => "braked late",
            Self::BrakedForNothing => "braked for nothing, hit from behind",
            Self::StoodInTheWay => "stood where it blocks others",
            Self::StruckStanding => "was struck while it stood",
            Self::WasStruck => "was struck from behind or beside",
            Self::HitObject => "hit an object on its way",
            Self::LeftRoad => "left the road",
            Self::StoppedForGood => "stopped for good for no reason",
            Self::PassedTooNear => "passed too near",
        }
    }
}

/// Failures by how they came about, as every headline counts them. Somebody who drives into an ego that has stood for long has nothing
/// to do with what it drove, and into one that slows, rolls or has just stopped, from where it does not look, hardly has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Failures {
    /// It was struck while it stood.
    pub struck_standing: usize,
    /// It was struck while it moved or had just stopped, by somebody it could not have seen ahead.
    pub struck_moving: usize,
    /// Any other, by what it did or did not do.
    pub otherwise: usize,
}

impl Failures {
    /// Of the causes of failures.
    pub fn of(causes: impl IntoIterator<Item = Option<Cause>>) -> Self {
        let mut counts = Self::default();
        for cause in causes {
            match cause {
                Some(Cause::StruckStanding) => counts.struck_standing += 1,
                Some(Cause::WasStruck) => counts.struck_moving += 1,
                _ => counts.otherwise += 1,
            }
        }
        counts
    }

    /// All of them.
    pub fn total(self) -> usize {
        self.struck_standing + self.struck_moving + self.otherwise
    }

    /// Each count that there is with its words, in the order of sentences.
    pub fn told(self) -> impl Iterator<Item = (usize, &'static str)> {
        let all = [
            (self.struck_standing, "struck while it stood"),
            (self.struck_moving, "struck from behind or beside while it moved or had just stopped"),
            (self.otherwise, "otherwise"),
        ];
        all.into_iter().filter(|(count, _)| *count > 0)
    }
}

impl std::fmt::Display for Failures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let told: Vec<String> = self.told().map(|(count, words)| format!("{count} {words}")).collect();
        f.write_str(&told.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_struck_as_it_slows_is_not_counted_with_what_it_drove() {
        let causes = [Some(Cause::WasStruck), Some(Cause::StruckStanding), Some(Cause::BrakedLate), None];
        let counts = Failures::of(causes);
        assert_eq!((counts.struck_standing, counts.struck_moving, counts.otherwise, counts.total()), (1, 1, 2, 4));
        let words =
            "1 struck while it stood, 1 struck from behind or beside while it moved or had just stopped, 2 otherwise";
        assert_eq!(counts.to_string(), words);
        assert_eq!(Failures { otherwise: 2, ..Failures::default() }.to_string(), "2 otherwise");
    }
}
