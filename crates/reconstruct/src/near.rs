//! Others who have no part in what the ego does: what is told of them, and whether a rollout shows it.

use crate::extras::STANDS_MPS;
use crate::ground::LANE_M;
use crate::others::{Extra, Role};
use recrash_model::account::{Act, ActFact, Kind, KindGroup, LeftRight, Origin, Other};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::ActorTrack;

/// Who is near is no farther from the ego; and who is beside it, ahead or behind. [m]
pub(crate) const NEAR_M: f64 = 40.0;
const ABREAST_M: f64 = 15.0;

/// Who drives has come so far, who slows has lost so much. [m, m/s]
const DROVE_M: f64 = 2.0;
pub(crate) const SLOWED_MPS: f64 = 0.8;

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
}

/// What is told of somebody who has no part in what the ego does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Near {
    /// Where it is; a crossing road of which nobody tells the side is either.
    pub(crate) place: Option<Origin>,
    pub(crate) across: bool,
    pub(crate) does: Does,
    /// How many such are there before it.
    pub(crate) number: usize,
}

impl Near {
    /// Nothing where something is told of it that is not drawn.
    pub(crate) fn of(other: &Other, words: &str, number: usize) -> Option<Self> {
        if !is_drawn(other) {
            return None;
        }
        if other.kind.value.group() == KindGroup::Object {
            let place = other.place.as_ref().map(|fact| fact.value);
            return Some(Self { place, across: false, does: Does::Stands, number });
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
        let across = place.is_none() && said(&["cross traffic", "crossing traffic"]);
        let before: Vec<&ActFact> =
            other.acts.iter().filter(|fact| !fact.after_contact && !fact.begun && fact.act != Act::Leave).collect();
        let one = |fact: &&ActFact| match fact.act {
            Act::Follow | Act::SetOff | Act::Accelerate => Some(Does::Drives),
            Act::Enter if matches!(place, Some(Origin::Ahead | Origin::Beside { .. })) => Some(Does::Drives),
            Act::Reverse => Some(Does::Backs),
            Act::Slow => Some(Does::Slows),
            Act::Hold | Act::Stop | Act::Park => Some(Does::Stands),
            Act::Pass => Some(Does::Passes),
            Act::LaneChange => Some(Does::Changes(fact.side)),
            Act::Turn if fact.side == Some(LeftRight::Left) && place == Some(Origin::Opposite) => Some(Does::TurnsLeft),
            _ => None,
        };
        let all: Vec<Does> = before.iter().map(one).collect::<Option<_>>()?;
        let deed = |does: &&Does| matches!(does, Does::Passes | Does::TurnsLeft | Does::Changes(_) | Does::Backs);
        let does = match all.iter().rev().find(deed) {
            Some(Does::Changes(side)) if matches!(place, None | Some(Origin::Ahead | Origin::Beside { .. })) => {
                Does::Changes(*side)
            }
            Some(Does::Passes) if matches!(place, None | Some(Origin::Behind | Origin::Beside { .. })) => Does::Passes,
            Some(Does::TurnsLeft) => Does::TurnsLeft,
            Some(Does::Backs) if !matches!(place, Some(Origin::Ahead | Origin::Behind | Origin::Beside { .. })) => {
                Does::Backs
            }
            Some(_) => return None,
            None => all.last().copied().unwrap_or(Does::Untold),
        };
        Some(Self { place, across, does, number })
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
    /// Whether somebody is near the ego up to the contact, where it is told, and does what is told.
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
                Some(Origin::Opposite) => facing(step) > 2.0 && left_m > 0.5 * LANE_M,
                Some(Origin::Beside { side }) => {
                    beside(step) && on_side(side, left_m) && ahead_m.abs() < ABREAST_M + 0.5 * track.length_m
                }
                Some(Origin::Cross { side }) => (0.6..2.5).contains(&facing(step)) && on_side(side, seen(0).1),
                _ => !self.across || (0.6..2.5).contains(&facing(step)),
            };
            near(step) && placed
        };
        let stays_ahead = self.place != Some(Origin::Ahead) || seen(until).0 > 0.0;
        let drove = state(0).position().distance(state(until).position()) > DROVE_M;
        let done = match self.does {
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
            Does::TurnsLeft => {
                let turned = math::wrap_angle(state(until).heading - state(0).heading);
                let crossed = (1..=until).any(|step| seen(step).1 <= 0.0 && seen(step - 1).1 > 0.0);
                facing(0) > 2.0 && turned > 0.7 && crossed
            }
        };
        stays_ahead && done && (0..=until).any(there)
    }
}

/// Whether somebody can be put somewhere near: no thing that moves, or that the ego goes over.
fn is_drawn(other: &Other) -> bool {
    let stands = |fact: &ActFact| fact.after_contact || matches!(fact.act, Act::Hold | Act::Park | Act::Drift);
    match (other.kind.value, other.kind.value.group()) {
        // What is fixed does nothing, whatever is told with it.
        (Kind::Wall | Kind::Pole | Kind::Sign, _) => true,
        (Kind::Barrier | Kind::Cone | Kind::Cart | Kind::Scooter, _) => other.acts.iter().all(stands),
        (_, KindGroup::Object | KindGroup::Other) => false,
        _ => true,
    }
}

impl Extra {
    /// Somebody who has no part in what the ego does.
    pub(crate) fn near(near: Near, of: usize, kind: Kind) -> Self {
        Self { of: vec![of], kind, near: Some(near), ..Self::of_reason(Role::Near) }
    }
}
