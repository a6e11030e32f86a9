//! What is told of somebody who has no part in what the ego does.

use recrash_model::account::{LeftRight, Origin};

/// What somebody near is told to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Does {
    /// Nothing.
    Untold,
    Drives,
    Slows,
    Stands,
    /// Comes from behind and passes the ego.
    Passes,
    /// Comes from the opposite side and turns left across the ego's road.
    TurnsLeft,
    /// Changes lanes, to a side where told.
    Changes(Option<LeftRight>),
    Backs,
    /// Turns at the junction, to a side where told.
    Turns(Option<LeftRight>),
    /// Comes out of where it is parked.
    PullsOut,
    /// Leaves its line within the lane, to a side where told.
    GoesAside(Option<LeftRight>),
    /// Draws up at the edge of its lane, to a side where told.
    PullsOver(Option<LeftRight>),
    /// Walks, runs or rolls across the road.
    Crosses,
}

impl Does {
    /// Whether who does this beside the ego drives in a lane, or may.
    pub(crate) const fn is_in_lane(self) -> bool {
        matches!(self, Self::Untold | Self::Drives | Self::Slows | Self::Passes | Self::Changes(_) | Self::GoesAside(_))
    }
}

/// What is told of somebody who has no part in what the ego does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Near {
    /// Where it is; a crossing road of which nobody tells the side is either.
    pub(crate) place: Option<Origin>,
    pub(crate) across: bool,
    pub(crate) does: Does,
    /// It is told behind a turn of the ego that is over: on the road into which that turned.
    pub(crate) after_turn: bool,
    /// It is told to stand in a lane: at no kerb.
    pub(crate) in_lane: bool,
    /// Another deed on the same way.
    pub(crate) also: Option<Does>,
    /// How it comes to that.
    pub(crate) first: First,
    /// How many such are there before it.
    pub(crate) number: usize,
}

/// What somebody near did first, or last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum First {
    #[default]
    Untold,
    /// Who stands came along before.
    Came,
    /// Who was in the ego's way has left it.
    Left,
    /// It has gone by when the ego, which stood, sets off: past it, or from one side of its way to the other.
    Gone,
}

impl Near {
    /// The same of one that drives ahead of the ego.
    pub(crate) const fn ahead(self) -> Self {
        Self { place: Some(Origin::Ahead), does: Does::Drives, ..self }
    }

    /// The same of one that goes by before an ego that stood sets off, as others with that part do: towards it, or along the crossing road.
    pub(crate) const fn gone_first(self, oncoming: bool) -> Self {
        let from = if oncoming { Origin::Opposite } else { Origin::Cross { side: LeftRight::Left } };
        Self { place: Some(from), does: Does::Drives, first: First::Gone, ..self }
    }

    /// The name of its actor.
    pub(crate) fn id(self) -> String {
        if self.number == 0 { "near".to_owned() } else { format!("near-{}", self.number + 1) }
    }

    /// For sentences.
    pub(crate) const fn words(self) -> &'static str {
        match (self.does, self.place) {
            (Does::TurnsLeft, _) => "one turns left from ahead",
            (Does::Passes, _) => "one passes",
            (Does::Backs, _) => "one backs",
            (Does::Changes(_), _) => "one changes lanes",
            (Does::Turns(_), _) => "one turns",
            (Does::PullsOut, _) => "one pulls out",
            (Does::GoesAside(_), _) => "one goes aside",
            (Does::PullsOver(_), _) => "one pulls over",
            (Does::Crosses, _) => "one comes across",
            (_, Some(Origin::Ahead)) => "one is farther ahead",
            (_, Some(Origin::Behind)) => "one is behind",
            (_, Some(Origin::Opposite)) => "one is in the opposite lane",
            (_, Some(Origin::Beside { .. })) => "one is beside",
            (_, Some(Origin::Cross { .. })) => "one is on the crossing road",
            _ if self.across => "one is on the crossing road",
            _ => "one is near",
        }
    }
}
