//! Others who have no part in what the ego does: what is told of them, and whether a rollout shows it.

use crate::extras::STANDS_MPS;
use crate::ground::LANE_M;
use crate::others::{Extra, Role, text};
use crate::told::Told;
use recrash_model::account::{Act, ActFact, Kind, KindGroup, LeftRight, Origin, Other, PlaceKind};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::ActorTrack;

/// Who is near is no farther from the ego; and who is beside it, ahead or behind. [m]
pub(crate) const NEAR_M: f64 = 40.0;
const ABREAST_M: f64 = 15.0;

/// Who drives has come so far, who slows has lost so much. [m, m/s]
const DROVE_M: f64 = 2.0;
pub(crate) const SLOWED_MPS: f64 = 0.8;

/// Who turns at a junction has turned by so much; who pulls out has come so far out of the space, who goes aside so far aside, and
/// who comes across so far across. [rad, m]
const TURNED_RAD: f64 = 0.7;
const OUT_M: f64 = 1.0;
const ASIDE_M: f64 = 0.4;
const ACROSS_M: f64 = 2.0;

/// The ego has left its line by this; what is told beside is so before the contact at the earliest; and who waits opposite is no farther
/// behind. [rad, steps, m]
const LEAVES_RAD: f64 = 0.1;
const LAST_STEPS: usize = 40;
const GONE_BY_M: f64 = 5.0;

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
    /// Whether it is more than to drive or to stand.
    const fn is_deed(self) -> bool {
        !matches!(self, Self::Untold | Self::Drives | Self::Slows | Self::Stands)
    }

    /// Whether it may be a part of a way with another deed.
    const fn is_of_one_way(self) -> bool {
        matches!(self, Self::Turns(_) | Self::PullsOut | Self::GoesAside(_) | Self::PullsOver(_) | Self::Crosses)
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
    fn of(fact: &ActFact, place: Option<Origin>, on_wheels: bool) -> Option<Self> {
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
            Act::Drift | Act::Swerve if on_wheels => Self::GoesAside(fact.side),
            Act::PullOver if on_wheels => Self::PullsOver(fact.side),
            _ => return None,
        })
    }
}

/// What is told of somebody who has no part in what the ego does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Near {
    /// Where it is; a crossing road of which nobody tells the side is either.
    pub(crate) place: Option<Origin>,
    pub(crate) across: bool,
    pub(crate) does: Does,
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
}

impl Near {
    /// Nothing where something is told of it that is not drawn.
    pub(crate) fn of(other: &Other, words: &str, number: usize) -> Option<Self> {
        if !is_drawn(other) {
            return None;
        }
        if other.kind.value.group() == KindGroup::Object {
            let place = other.place.as_ref().map(|fact| fact.value);
            let rolls = other.acts.iter().any(|fact| !fact.after_contact && moves(fact.act));
            let does = if rolls { Does::Crosses } else { Does::Stands };
            return Some(Self { place, across: false, does, also: None, first: First::Untold, number });
        }
        let said = |of: &[&str]| of.iter().any(|word| words.contains(word));
        let place = other.place.as_ref().map(|fact| fact.value).or_else(|| {
            if said(&["oncoming", "opposing"]) {
                Some(Origin::Opposite)
            } else if said(&["preceding", "leading", "lead "]) {
                Some(Origin::Ahead)
            } else if said(&["following", "trailing"]) {
                Some(Origin::Behind)
            } else {
                None
            }
        });
        let before: Vec<&ActFact> = other.acts.iter().filter(|fact| is_seen(fact)).collect();
        let on_wheels = !matches!(other.kind.value.group(), KindGroup::OnFoot | KindGroup::Animal);
        let crosses = on_wheels && before.iter().any(|fact| fact.act == Act::Cross);
        let across = place.is_none() && (crosses || said(&["cross traffic", "cross-traffic", "crossing traffic"]));
        let all: Vec<Does> = before.iter().map(|fact| Does::of(fact, place, on_wheels)).collect::<Option<_>>()?;
        let mut deeds: Vec<Does> = all.iter().copied().filter(|does| does.is_deed()).collect();
        deeds.dedup();
        let (does, also) = match deeds.as_slice() {
            [] => (all.last().copied().unwrap_or(Does::Untold), None),
            [one] => (*one, None),
            [.., last] if !deeds.iter().any(|does| does.is_of_one_way()) => (*last, None),
            // Of two the one that takes it farther is drawn, and both are looked for.
            &[first, last] if first.reach() >= last.reach() => (first, Some(last)),
            &[first, last] => (last, Some(first)),
            _ => return None,
        };
        // A queue stands.
        let queue = other.place.as_ref().is_some_and(|fact| text(&fact.source).contains("queue"));
        let does = if queue && does == Does::Untold { Does::Stands } else { does };
        if !does.fits(place) || !also.is_none_or(|also| also.fits(place)) {
            return None;
        }
        let drives = |fact: &&ActFact| matches!(fact.act, Act::Follow | Act::SetOff | Act::Enter | Act::Turn);
        let in_view = on_wheels && matches!(place, Some(Origin::Ahead | Origin::Opposite));
        let stood = before.first().is_some_and(|fact| matches!(fact.act, Act::Hold | Act::Stop | Act::Park));
        let left = other.acts.iter().any(|fact| fact.act == Act::Leave && !fact.after_contact && !fact.begun);
        let first = match does {
            Does::Stands if in_view && !stood && before.iter().copied().any(|fact| drives(&fact)) => First::Came,
            _ if left && !on_wheels => First::Left,
            _ => First::Untold,
        };
        Some(Self { place, across, does, also, first, number })
    }

    /// The same of one that drives ahead of the ego.
    pub(crate) const fn ahead(self) -> Self {
        Self { place: Some(Origin::Ahead), does: Does::Drives, ..self }
    }

    /// Whether somebody near moves while the ego stands, and is ahead of it then.
    pub(crate) fn is_waited_for(ego: &ActorTrack, track: &ActorTrack, until: usize) -> bool {
        let way = Vec2::from_heading(ego.states[0].heading);
        (0..=until.min(track.states.len() - 1)).any(|step| {
            let (own, other) = (&ego.states[step], &track.states[step]);
            let stands = own.velocity().length() < STANDS_MPS;
            stands && other.velocity().length() > STANDS_MPS && way.dot(other.position() - own.position()) > 0.0
        })
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

impl Near {
    /// Whether somebody near does what is told, and is near the ego and where it is told while that does what is told with it: from where the
    /// ego leaves its line or its speed, and in the last seconds before the contact.
    pub(crate) fn holds(self, ego: &ActorTrack, track: &ActorTrack, until: usize) -> bool {
        let state = |step: usize| &track.states[step.min(track.states.len() - 1)];
        let mps = |step: usize| state(step).velocity().length();
        // Seen from the ego as it came, before any turn.
        let came = ego.states[0].heading;
        let ahead = Vec2::from_heading(came);
        let seen = |step: usize| {
            let way = state(step).position() - ego.states[step].position();
            (ahead.dot(way), ahead.cross(way))
        };
        let half_m = 0.5 * (ego.length_m + track.length_m);
        let near = |step: usize| {
            let (ahead_m, left_m) = seen(step);
            math::hypot(ahead_m, left_m) - 0.5 * track.length_m < NEAR_M
        };
        let facing = |step: usize| math::wrap_angle(state(step).heading - came).abs();
        let on_side = |side: LeftRight, left_m: f64| (side == LeftRight::Left) == (left_m > 0.0);
        let beside = |step: usize| (0.35 * LANE_M..2.2 * LANE_M).contains(&seen(step).1.abs());
        let there = |step: usize| {
            let (ahead_m, left_m) = seen(step);
            let placed = match self.place {
                _ if self.does == Does::TurnsLeft => ahead_m > 0.0,
                Some(Origin::Ahead) => ahead_m > 0.0 && left_m.abs() < 2.2 * LANE_M,
                Some(Origin::Behind) => ahead_m < -half_m && left_m.abs() < 2.2 * LANE_M || self.does == Does::Passes,
                Some(Origin::Beside { .. }) if matches!(self.does, Does::Crosses | Does::PullsOut) => true,
                Some(Origin::Cross { .. }) if self.does == Does::Crosses => true,
                Some(Origin::Opposite) => facing(step) > 2.0 && left_m > 0.5 * LANE_M,
                Some(Origin::Beside { side }) => {
                    beside(step) && on_side(side, left_m) && ahead_m.abs() < ABREAST_M + 0.5 * track.length_m
                }
                Some(Origin::Cross { side }) => (0.6..2.5).contains(&facing(step)) && on_side(side, seen(0).1),
                _ => !self.across || (0.6..2.5).contains(&facing(step)),
            };
            near(step) && placed
        };
        let stays_ahead = self.place != Some(Origin::Ahead) || self.first == First::Left || seen(until).0 > 0.0;
        let first = match self.first {
            First::Untold => true,
            First::Came => state(0).position().distance(state(until).position()) > DROVE_M,
            First::Left => seen(until).1.abs() > 0.5 * LANE_M || seen(until).0 < -half_m,
        };
        // Who waits opposite, or slows there, has not long gone by when the two touch.
        let waits = self.place == Some(Origin::Opposite) && matches!(self.does, Does::Slows | Does::Stands);
        let waits_yet = !waits || seen(until).0 > -half_m - GONE_BY_M;
        let drove = state(0).position().distance(state(until).position()) > DROVE_M;
        // To the left of where it was at first, along the road.
        let aside_m = |step: usize| ahead.cross(state(step).position() - state(0).position());
        let done = |does: Does| match does {
            Does::Untold => true,
            Does::Drives => drove,
            Does::Backs => (0..=until).any(|step| state(step).speed() < -STANDS_MPS),
            Does::Slows => (0..until).any(|step| mps(step) > mps(until) + SLOWED_MPS),
            Does::Stands => (until.saturating_sub(10)..=until).all(|step| mps(step) < STANDS_MPS),
            Does::Passes => {
                let by = |step: &usize| seen(*step).0 < 0.0;
                (0..until).any(|step| by(&step)) && seen(until).0 > 0.0 && (0..until).any(beside)
            }
            Does::Changes(side) => {
                let moved_m =
                    seen(until).1 - seen(0).1 + ahead.cross(ego.states[until].position() - ego.states[0].position());
                moved_m.abs() > 0.7 * LANE_M && side.is_none_or(|side| on_side(side, moved_m))
            }
            Does::Turns(side) => {
                let turned = math::wrap_angle(state(until).heading - state(0).heading);
                turned.abs() > TURNED_RAD && side.is_none_or(|side| on_side(side, turned))
            }
            Does::PullsOut => {
                let stood = mps(0) < STANDS_MPS && seen(0).1.abs() > 0.5 * LANE_M;
                let own_side = place_side(self.place).is_none_or(|side| on_side(side, seen(0).1));
                stood && own_side && mps(until) > STANDS_MPS && aside_m(until).abs() > OUT_M
            }
            Does::GoesAside(side) | Does::PullsOver(side) => {
                let slowed = (0..until).any(|step| mps(step) > mps(until) + SLOWED_MPS);
                let drawn_up = slowed || matches!(does, Does::GoesAside(_));
                let own = Vec2::from_heading(state(0).heading).cross(state(until).position() - state(0).position());
                drawn_up && own.abs() > ASIDE_M && side.is_none_or(|side| on_side(side, own))
            }
            Does::Crosses => {
                let own_side = place_side(self.place).is_none_or(|side| on_side(side, seen(0).1));
                own_side && aside_m(until).abs() > ACROSS_M
            }
            Does::TurnsLeft => {
                let turned = math::wrap_angle(state(until).heading - state(0).heading);
                let crossed = (1..=until).any(|step| seen(step).1 <= 0.0 && seen(step - 1).1 > 0.0);
                facing(0) > 2.0 && turned > 0.7 && crossed
            }
        };
        let does = done(self.does) && self.also.is_none_or(done);
        stays_ahead && first && waits_yet && does && (acts_from(ego, until)..=until).any(there)
    }
}

/// From where the ego leaves its line or its speed, and no later than so long before the contact. [steps]
fn acts_from(ego: &ActorTrack, until: usize) -> usize {
    let first = &ego.states[0];
    let along = Vec2::from_heading(first.heading);
    let acts = |step: &usize| {
        let state = &ego.states[*step];
        let turned = math::wrap_angle(state.heading - first.heading).abs() > LEAVES_RAD;
        let aside = along.cross(state.position() - first.position()).abs() > ASIDE_M;
        turned || aside || (state.velocity().length() - first.velocity().length()).abs() > SLOWED_MPS
    };
    (0..until).find(acts).unwrap_or(until).min(until.saturating_sub(LAST_STEPS))
}

/// Whether an act of somebody who is near may be seen before the contact: that it did not yield is no way of its own.
fn is_seen(fact: &ActFact) -> bool {
    !fact.after_contact && !fact.begun && !matches!(fact.act, Act::Leave | Act::FailToYield)
}

/// Whether a thing that does this is told to come along.
const fn moves(act: Act) -> bool {
    matches!(act, Act::Follow | Act::Enter | Act::PullOut | Act::Cross | Act::Roll)
}

/// The side that a place beside the road is told to be on.
const fn place_side(place: Option<Origin>) -> Option<LeftRight> {
    match place {
        Some(Origin::Beside { side } | Origin::Cross { side }) => Some(side),
        Some(Origin::Parked { side } | Origin::Sidewalk { side }) => side,
        _ => None,
    }
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

impl Told {
    /// The same at a junction too, where somebody on a street crosses nearby, or turns.
    pub(crate) fn with_junction(self) -> Vec<Self> {
        let crossed = self.place == PlaceKind::Street && self.wanted.iter().any(Extra::is_at_junction);
        let at_one = crossed.then(|| Self { crossed_near: true, ..self.clone() });
        at_one.into_iter().chain([self]).collect()
    }
}

impl Extra {
    /// Whether it has no part in what the ego does, and is on a road that crosses the ego's, or turns into one.
    fn is_at_junction(&self) -> bool {
        let turns = |near: Near| matches!(near.does, Does::Turns(_) | Does::TurnsLeft);
        self.near.is_some_and(|near| near.across || matches!(near.place, Some(Origin::Cross { .. })) || turns(near))
    }

    /// Somebody who has no part in what the ego does.
    pub(crate) fn near(near: Near, of: usize, kind: Kind) -> Self {
        Self { of: vec![of], kind, near: Some(near), ..Self::of_reason(Role::Near) }
    }
}
