//! What is told of others who have no part in what the ego does, held against a rollout.

use crate::told::near::{Does, First, Near};
use crate::usual::{LANE_M, STANDS_MPS};
use recrash_model::account::{LeftRight, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::ActorTrack;

/// Who is near is no farther from the ego; and who is beside it, ahead or behind. [m]
pub(crate) const NEAR_M: f64 = 40.0;
const ABREAST_M: f64 = 15.0;

/// Who drives has come so far, who slows has lost so much. [m, m/s]
const DROVE_M: f64 = 2.0;
pub(super) const SLOWED_MPS: f64 = 0.8;

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

impl Near {
    /// Whether somebody near moves while the ego stands, and is ahead of it then.
    pub(super) fn is_waited_for(ego: &ActorTrack, track: &ActorTrack, until: usize) -> bool {
        let way = Vec2::from_heading(ego.states[0].heading);
        (0..=until.min(track.states.len() - 1)).any(|step| {
            let (own, other) = (&ego.states[step], &track.states[step]);
            let stands = own.velocity().length() < STANDS_MPS;
            stands && other.velocity().length() > STANDS_MPS && way.dot(other.position() - own.position()) > 0.0
        })
    }

    /// Whether somebody near does what is told, and is near the ego and where it is told while that does what is told with it: from where the
    /// ego leaves its line or its speed, and in the last seconds before the contact.
    pub(crate) fn holds(self, ego: &ActorTrack, track: &ActorTrack, until: usize) -> bool {
        let state = |step: usize| &track.states[step.min(track.states.len() - 1)];
        let mps = |step: usize| state(step).velocity().length();
        // Seen from the ego as it came, before any turn; or behind that.
        let came = ego.states[if self.after_turn { until } else { 0 }].heading;
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
            First::Gone => {
                let sets_off = |step: &usize| ego.states[*step].velocity().length() > STANDS_MPS;
                let stood = (0..until).find(|step| !sets_off(step));
                let off = stood.and_then(|stood| (stood..until).find(sets_off));
                off.is_some_and(|off| match self.place {
                    Some(Origin::Cross { .. }) => seen(0).1 * seen(off).1 < 0.0,
                    _ => seen(0).0 > 0.0 && seen(off).0 < 0.0,
                })
            }
            First::Left => seen(until).1.abs() > 0.5 * LANE_M || seen(until).0 < -half_m,
        };
        // Who waits opposite, slows there, or goes aside, has not long gone by when the two touch.
        let waits = matches!(self.does, Does::Slows | Does::Stands | Does::GoesAside(_));
        let waits = self.place == Some(Origin::Opposite) && waits;
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

/// The side that a place beside the road is told to be on.
const fn place_side(place: Option<Origin>) -> Option<LeftRight> {
    match place {
        Some(Origin::Beside { side } | Origin::Cross { side }) => Some(side),
        Some(Origin::Parked { side } | Origin::Sidewalk { side }) => side,
        _ => None,
    }
}
