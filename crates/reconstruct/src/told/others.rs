//! What others than the two are to the ego, and who threw the partner at it.

use crate::told::near::{Does, Near};
use recrash_model::account::{Astride, Kind, LeftRight, Origin};

/// What somebody else is to the ego.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Stands ahead of it in its lane.
    Lead,
    /// Drives ahead of it, and slows.
    Slower,
    /// Somebody on foot or on a bicycle who crosses its way.
    Walker,
    /// An animal that does.
    Animal,
    /// A vehicle on the crossing road.
    Crosser,
    /// A vehicle that comes towards it, and passes it.
    Oncoming,
    /// Vehicles parked at the kerb.
    Kerb,
    /// Stands in the lane that the ego leaves, or beside its way: it goes round it.
    Obstacle,
    /// Stands in the lane that the partner leaves, or is slow there: it goes round it.
    Passed,
    /// Stands beside the ego's way, short of where the partner comes out from behind it.
    Screen,
    /// Changes from beside the ego into its lane, ahead of it.
    Merger,
    /// Stands across the junction, in the ego's way.
    Blocker,
    /// Stands behind the junction, in the ego's lane: there is no room for it.
    Beyond,
    /// Stands in the next lane, where the ego goes by or stands.
    Beside,
    /// Backs into the ego's lane from the side, ahead of it.
    Backer,
    /// Drives in the next lane as the ego does.
    Abreast,
    /// A thing that stands or lies in its lane, ahead of it.
    Thing,
    /// Has no part in what the ego does.
    Near,
}

impl Role {
    /// The name of its actor.
    pub(crate) const fn id(self) -> &'static str {
        match self {
            Self::Lead => "lead",
            Self::Slower => "slower",
            Self::Walker => "walker",
            Self::Animal => "animal",
            Self::Crosser => "crosser",
            Self::Oncoming => "oncoming",
            Self::Kerb => "kerb",
            Self::Obstacle => "obstacle",
            Self::Passed => "passed",
            Self::Screen => "screen",
            Self::Merger => "merger",
            Self::Blocker => "blocker",
            Self::Beyond => "beyond",
            Self::Beside => "beside",
            Self::Backer => "backer",
            Self::Abreast => "abreast",
            Self::Thing => "thing",
            Self::Near => "near",
        }
    }
}

impl Extra {
    /// For sentences.
    pub(crate) fn words(&self) -> &'static str {
        match self.role {
            Role::Near => self.near.map_or("", Near::words),
            Role::Lead if self.goes => "one stands ahead and drives on",
            Role::Lead if self.again => "one stands ahead, and again",
            Role::Lead => "one stands ahead",
            Role::Slower => "one ahead slows",
            Role::Walker if self.stays => "somebody stays close",
            Role::Walker => "somebody crosses",
            Role::Animal => "an animal crosses",
            Role::Crosser => "one comes along the crossing road",
            Role::Oncoming => "one comes by from ahead",
            Role::Beside => "one stands in the next lane",
            Role::Backer => "one backs into its lane ahead",
            Role::Abreast => "one drives in the next lane",
            Role::Thing => "a thing is in its lane ahead",
            Role::Kerb => "parked at the kerb",
            Role::Obstacle => "one stands that it goes round",
            Role::Passed if self.slow => "one is slow that the partner goes round",
            Role::Passed => "one stands that the partner goes round",
            Role::Screen => "one stands that hides the partner",
            Role::Merger => "one changes into its lane ahead",
            Role::Blocker => "one stands across the junction",
            Role::Beyond => "one stands behind the junction",
        }
    }
}

/// Somebody else who has a part in what the ego does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extra {
    pub(crate) role: Role,
    /// Which of the account's others it is; none where only a reason to stand tells of it. More than one where they are the same.
    pub(crate) of: Vec<usize>,
    pub(crate) kind: Kind,
    /// Who stands ahead drives on before the ego or the partner does.
    pub(crate) goes: bool,
    /// Who stands ahead is told to be parking beside the lane.
    pub(crate) parks: bool,
    /// Is told to be parked.
    pub(crate) parked: bool,
    /// The partner, beside the ego, leaves its lane for it; and it drives slowly there, and does not stand.
    pub(crate) goes_out: bool,
    pub(crate) slow: bool,
    /// It does so before the ego moves between two stops.
    pub(crate) first: bool,
    /// It is told to stand again where the ego, which had set off, slows or stops: it moves up before that.
    pub(crate) again: bool,
    /// The ego, which had stood and drove on, slowed for it.
    pub(crate) late: bool,
    /// It had gone by before the ego, which stood and stops again, set off first.
    pub(crate) early: bool,
    /// The ego stands or slows for it, or it is not told that somebody else is the reason.
    pub(crate) awaited: bool,
    /// The ego has gone round it, and is back in its lane.
    pub(crate) behind: bool,
    /// The ego is told to pass who is parked, or stands: they are abreast.
    pub(crate) passed: bool,
    /// The partner is told to pass between the ego and it.
    pub(crate) between: bool,
    /// An animal that is named with somebody on foot who crosses: they go together.
    pub(crate) led: bool,
    /// Who comes across came out from behind it, or from between several.
    pub(crate) hides: bool,
    /// Who is on foot is told to stay where it is, and not to cross.
    pub(crate) stays: bool,
    /// Who is on foot is told to run.
    pub(crate) runs: bool,
    /// It is told on the opposite side, and faces as those do who come from there.
    pub(crate) opposite: bool,
    /// More than one; and how many are to be drawn.
    pub(crate) several: bool,
    pub(crate) number: usize,
    /// What those beside the first are, where they are not told by the same name: "a bus" in "traffic".
    pub(crate) more: Option<Kind>,
    /// On which side of the ego it is, or from which it comes, where told.
    pub(crate) side: Option<LeftRight>,
    /// Over which line of the road its body reaches, where told.
    pub(crate) astride: Option<Astride>,
    /// What is told of one who has no part in what the ego does.
    pub(crate) near: Option<Near>,
}

impl Extra {
    /// One of whom only a reason to stand tells.
    pub(crate) fn of_reason(role: Role) -> Self {
        Self {
            role,
            of: Vec::new(),
            kind: Kind::Vehicle,
            goes: false,
            parks: false,
            parked: false,
            goes_out: false,
            slow: false,
            first: false,
            again: false,
            late: false,
            early: false,
            awaited: true,
            behind: false,
            passed: false,
            between: false,
            led: false,
            hides: false,
            stays: false,
            runs: false,
            opposite: false,
            several: false,
            number: 2,
            more: None,
            side: None,
            astride: None,
            near: None,
        }
    }

    /// One of whom neither place nor deed is told: that it is somewhere near is assumed, and nothing of it can be looked at.
    pub(crate) fn is_assumed(&self) -> bool {
        self.near.is_some_and(|near| near.place.is_none() && !near.across && near.does == Does::Untold)
    }

    /// Of one whom nobody names, and who is there because the ego stood: that it is assumed.
    pub(crate) fn assumed(&self) -> Option<String> {
        let only = self.of.is_empty() && matches!(self.role, Role::Thing | Role::Crosser | Role::Oncoming);
        only.then(|| format!("what the ego stands for: {}", self.words()))
    }

    /// The name of its actor.
    pub(crate) fn id(&self) -> String {
        match self.near {
            Some(near) => near.id(),
            None if self.stays => "bystander".to_owned(),
            None => self.role.id().to_owned(),
        }
    }

    /// Whether it has no part in what the ego does, and is on a road that crosses the ego's, or turns into one.
    pub(crate) fn is_at_junction(&self) -> bool {
        let turns = |near: Near| matches!(near.does, Does::Turns(_) | Does::TurnsLeft);
        self.near.is_some_and(|near| near.across || matches!(near.place, Some(Origin::Cross { .. })) || turns(near))
    }

    /// Somebody who has no part in what the ego does.
    pub(crate) fn near(near: Near, of: usize, kind: Kind) -> Self {
        Self { of: vec![of], kind, near: Some(near), ..Self::of_reason(Role::Near) }
    }
}

/// From where who touched the partner first is told to come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Thrower {
    /// Along the lane beside, or out of it.
    Beside(LeftRight),
    /// It is ahead in the ego's lane.
    Ahead,
    /// Out of a crossing road.
    Cross(LeftRight),
    /// From the opposite direction.
    Opposite,
}

/// Those to whom an ego gives way.
pub(crate) const GIVEN_WAY: [Role; 8] =
    [Role::Walker, Role::Animal, Role::Crosser, Role::Oncoming, Role::Lead, Role::Merger, Role::Backer, Role::Blocker];
