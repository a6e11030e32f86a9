//! What is told of others who have no part in what the ego does.

use crate::reading::story::{is_in_turn_lane, is_parked, stands_in_lane};
use crate::reading::words::text;
use crate::told::near::{Does, First, Near};
use recrash_model::account::{Act, ActFact, Kind, KindGroup, LeftRight, Origin, Other};

impl Does {
    /// Whether it is more than to drive or to stand.
    const fn is_deed(self) -> bool {
        !matches!(self, Self::Untold | Self::Drives | Self::Slows | Self::Stands)
    }

    /// Whether it may be a part of a way with another deed.
    const fn is_of_one_way(self) -> bool {
        matches!(self, Self::Turns(_) | Self::PullsOut | Self::GoesAside(_) | Self::PullsOver(_) | Self::Crosses)
    }

    /// To which side it goes, where told.
    const fn side(self) -> Option<LeftRight> {
        match self {
            Self::Turns(side) | Self::Changes(side) | Self::GoesAside(side) | Self::PullsOver(side) => side,
            _ => None,
        }
    }

    /// Whether another is the same, told again: "changed lanes to the right", and "completed changing lanes".
    fn is_same(self, other: Self) -> bool {
        let alike = std::mem::discriminant(&self) == std::mem::discriminant(&other);
        alike && (self == other || self.side().is_none() || other.side().is_none())
    }

    /// The one of two that are the same whose side is told.
    const fn with_side_of(self, other: Self) -> Self {
        if self.side().is_some() { self } else { other }
    }

    /// How far it takes somebody, of two deeds on one way.
    const fn reach(self) -> u8 {
        match self {
            Self::Turns(_) | Self::TurnsLeft => 3,
            Self::PullsOut | Self::Passes | Self::Crosses => 2,
            Self::Changes(_) | Self::Backs => 1,
            _ => 0,
        }
    }

    /// Whether one who does this is drawn at a place.
    const fn fits(self, place: Option<Origin>) -> bool {
        use Origin as O;
        match self {
            Self::Changes(_) => matches!(place, None | Some(O::Ahead | O::Behind | O::Beside { .. })),
            Self::Passes => matches!(place, None | Some(O::Behind | O::Beside { .. })),
            Self::Backs => !matches!(place, Some(O::Ahead | O::Behind | O::Beside { .. })),
            _ => true,
        }
    }

    /// What an act tells of somebody at a place; nothing where it is not drawn.
    fn of(fact: &ActFact, place: Option<Origin>, (on_wheels, into_lane): (bool, bool)) -> Option<Self> {
        let at_kerb = matches!(place, None | Some(Origin::Ahead | Origin::Beside { .. } | Origin::Parked { .. }));
        let in_lanes = matches!(
            place,
            None | Some(Origin::Ahead | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. })
        );
        Some(match fact.act {
            Act::Follow | Act::SetOff | Act::Accelerate => Self::Drives,
            Act::Cross | Act::Enter | Act::PullOut if !on_wheels => Self::Crosses,
            Act::Enter if in_lanes => Self::Drives,
            Act::Cross if matches!(place, None | Some(Origin::Cross { .. } | Origin::Opposite)) => Self::Drives,
            Act::Pass if place == Some(Origin::Opposite) => Self::Drives,
            Act::Reverse => Self::Backs,
            Act::Slow => Self::Slows,
            Act::Hold | Act::Stop | Act::Park => Self::Stands,
            Act::Pass => Self::Passes,
            Act::LaneChange => Self::Changes(fact.side),
            Act::Turn if fact.side == Some(LeftRight::Left) && place == Some(Origin::Opposite) => Self::TurnsLeft,
            Act::Turn if in_lanes && on_wheels => Self::Turns(fact.side),
            Act::PullOut if at_kerb => Self::PullsOut,
            Act::Swerve if on_wheels && place == Some(Origin::Ahead) && into_lane => Self::Changes(fact.side),
            // From beside the ego towards that.
            Act::Drift | Act::Swerve if on_wheels => Self::GoesAside(fact.side.or(match place {
                Some(Origin::Beside { side }) => Some(side.other()),
                _ => None,
            })),
            Act::PullOver if on_wheels => Self::PullsOver(fact.side),
            _ => return None,
        })
    }
}

impl Near {
    /// Nothing where something is told of it that is not drawn.
    pub(super) fn of(other: &Other, words: &str, number: usize) -> Option<Self> {
        if !is_drawn(other) {
            return None;
        }
        if other.kind.value.group() == KindGroup::Object {
            return Some(Self::of_thing(other, number));
        }
        let said = |of: &[&str]| of.iter().any(|word| words.contains(word));
        let place = other.place.as_ref().map(|fact| fact.value).or_else(|| place_by_words(words));
        // Who is parked and reaches into a lane stands so.
        let parked = is_parked(other);
        let reaches = |fact: &ActFact| parked && fact.act == Act::Drift;
        let before: Vec<&ActFact> = other.acts.iter().filter(|fact| is_seen(fact) && !reaches(fact)).collect();
        let on_wheels = !matches!(other.kind.value.group(), KindGroup::OnFoot | KindGroup::Animal);
        let crosses = on_wheels && before.iter().any(|fact| fact.act == Act::Cross);
        let across = place.is_none() && (crosses || said(&["cross traffic", "cross-traffic", "crossing traffic"]));
        let wheels = (on_wheels, swerves_into_lane(other));
        let all = before.iter().map(|fact| Does::of(fact, place, wheels)).collect::<Option<Vec<Does>>>()?;
        let (does, also) = deeds(&all)?;
        let does = match does {
            Does::Untold if stands_untold(other, place) => Does::Stands,
            // "A gap in passing traffic".
            Does::Untold if said(&["passing"]) && Does::Passes.fits(place) => Does::Passes,
            does => does,
        };
        if !does.fits(place) || !also.is_none_or(|also| also.fits(place)) {
            return None;
        }
        let first = first(other, &before, does, (place, on_wheels));
        let in_lane = stands_in_lane(other);
        Some(Self { place, across, does, after_turn: false, in_lane, also, first, number })
    }

    /// A thing lies there, or comes along.
    fn of_thing(other: &Other, number: usize) -> Self {
        let place = other.place.as_ref().map(|fact| fact.value);
        let fixed = matches!(other.kind.value, Kind::Wall | Kind::Pole | Kind::Sign);
        let rolls = !fixed && other.acts.iter().any(|fact| !fact.after_contact && moves(fact.act));
        let does = if rolls { Does::Crosses } else { Does::Stands };
        let (across, in_lane, also, first) = (false, false, None, First::Untold);
        Self { place, across, does, after_turn: false, in_lane, also, first, number }
    }
}

/// Where somebody is by the words that name it.
fn place_by_words(words: &str) -> Option<Origin> {
    let places: [(&[&str], Origin); 3] = [
        (&["oncoming", "opposing"], Origin::Opposite),
        (&["preceding", "leading", "lead "], Origin::Ahead),
        (&["following", "trailing"], Origin::Behind),
    ];
    places.into_iter().find(|(of, _)| of.iter().any(|word| words.contains(word))).map(|(_, place)| place)
}

/// "A truck ahead of it swerved into the left lane": it was in the ego's before.
fn swerves_into_lane(other: &Other) -> bool {
    other.place.as_ref().is_some_and(|fact| {
        let words = text(&fact.source);
        ["to the left lane", "to the right lane", "to the next lane"].iter().any(|lane| words.contains(lane))
    })
}

/// The deed of all that somebody does, and another one on the same way, where they can be drawn.
fn deeds(all: &[Does]) -> Option<(Does, Option<Does>)> {
    let mut deeds: Vec<Does> = Vec::new();
    for does in all.iter().copied().filter(|does| does.is_deed()) {
        match deeds.last_mut().filter(|last| last.is_same(does)) {
            Some(last) => *last = last.with_side_of(does),
            None => deeds.push(does),
        }
    }
    match deeds.as_slice() {
        [] => Some((all.last().copied().unwrap_or(Does::Untold), None)),
        [one] => Some((*one, None)),
        [.., last] if !deeds.iter().any(|does| does.is_of_one_way()) => Some((*last, None)),
        // Of two the one that takes it farther is drawn, and both are looked for.
        &[first, last] if first.reach() >= last.reach() => Some((first, Some(last))),
        &[first, last] => Some((last, Some(first))),
        _ => None,
    }
}

/// Whether somebody of whom no deed is told stands: in a queue, in a lane for turns, or opposite, where it hid somebody: "a truck in the opposing
/// lane blocked its view of who came from behind that."
fn stands_untold(other: &Other, place: Option<Origin>) -> bool {
    let queue = other.place.as_ref().is_some_and(|fact| text(&fact.source).contains("queue"));
    queue || is_in_turn_lane(other) || other.hides && place == Some(Origin::Opposite)
}

/// What somebody who does this did first, or last.
fn first(other: &Other, before: &[&ActFact], does: Does, (place, on_wheels): (Option<Origin>, bool)) -> First {
    let drives = |fact: &&ActFact| matches!(fact.act, Act::Follow | Act::SetOff | Act::Enter | Act::Turn);
    let in_view = on_wheels && matches!(place, Some(Origin::Ahead | Origin::Opposite));
    let stood = before.first().is_some_and(|fact| matches!(fact.act, Act::Hold | Act::Stop | Act::Park));
    let left = other.acts.iter().any(|fact| fact.act == Act::Leave && !fact.after_contact && !fact.begun);
    match does {
        Does::Stands if in_view && !stood && before.iter().any(drives) => First::Came,
        _ if left && !on_wheels => First::Left,
        _ => First::Untold,
    }
}

/// Whether an act of somebody who is near may be seen before the contact: that it did not yield is no way of its own.
fn is_seen(fact: &ActFact) -> bool {
    !fact.after_contact && !fact.begun && !matches!(fact.act, Act::Leave | Act::FailToYield)
}

/// Whether a thing that does this is told to come along.
const fn moves(act: Act) -> bool {
    matches!(act, Act::Follow | Act::Enter | Act::PullOut | Act::Cross | Act::Roll)
}

/// Whether somebody can be put somewhere near: nothing that the ego goes over.
fn is_drawn(other: &Other) -> bool {
    let stands = |fact: &ActFact| fact.after_contact || matches!(fact.act, Act::Hold | Act::Park | Act::Drift);
    let lies = |fact: &ActFact| stands(fact) || fact.act == Act::Fall || moves(fact.act);
    match (other.kind.value, other.kind.value.group()) {
        // What is fixed does nothing, whatever is told with it.
        (Kind::Wall | Kind::Pole | Kind::Sign, _) => true,
        (Kind::Barrier | Kind::Cone | Kind::Scooter, _) => other.acts.iter().all(stands),
        (Kind::Debris | Kind::LooseWheel | Kind::TreeBranch | Kind::Cargo | Kind::Cart | Kind::Object, _) => {
            other.acts.iter().all(lies)
        }
        (_, KindGroup::Object | KindGroup::Other) => false,
        _ => true,
    }
}
