//! What is told of others who have no part in what the ego does, held against a rollout.

use crate::told::near::{Does, First, Near};
use crate::usual::{LANE_M, STANDS_MPS};
use recrash_model::account::{LeftRight, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack};

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
        (0..=track.within(until)).any(|step| {
            let (own, other) = (&ego.states[step], &track.states[step]);
            let stands = own.stands();
            stands && !other.stands() && way.dot(other.position() - own.position()) > 0.0
        })
    }

    /// Whether somebody near does what is told, and is near the ego and where it is told while that does what is told with it: from where the
    /// ego leaves its line or its speed, and in the last seconds before the contact.
    pub(crate) fn holds(self, ego: &ActorTrack, track: &ActorTrack, until: usize) -> bool {
        let view = View::of(self, ego, track, until);
        view.stays_ahead()
            && view.came_to_it()
            && view.waits_yet()
            && view.does(self.does)
            && self.also.is_none_or(|also| view.does(also))
            && (acts_from(ego, until)..=until).any(|step| view.is_near(step) && view.is_placed(step))
    }
}

/// Somebody near and the ego, as a rollout shows them until the two touch.
struct View<'a> {
    near: Near,
    ego: &'a ActorTrack,
    track: &'a ActorTrack,
    until: usize,
    /// Where the ego heads as it came, before any turn; or behind that. [rad]
    came: f64,
    ahead: Vec2,
}

/// Whether that many metres to the left are on this side.
fn is_on_side(side: LeftRight, left_m: f64) -> bool {
    side.is_at(left_m)
}

impl<'a> View<'a> {
    /// The two as they are told and seen.
    fn of(near: Near, ego: &'a ActorTrack, track: &'a ActorTrack, until: usize) -> Self {
        let came = ego.states[if near.after_turn { until } else { 0 }].heading;
        Self { near, ego, track, until, came, ahead: Vec2::from_heading(came) }
    }

    /// Its state at a step, or its last one.
    fn state(&self, step: usize) -> &ActorState {
        self.track.at(step)
    }

    /// How fast it is. [m/s]
    fn mps(&self, step: usize) -> f64 {
        self.state(step).velocity().length()
    }

    /// How far ahead of the ego it is, and how far to the left. [m]
    fn seen(&self, step: usize) -> (f64, f64) {
        let way = self.state(step).position() - self.ego.states[step].position();
        (self.ahead.dot(way), self.ahead.cross(way))
    }

    /// How far ahead of the ego it is. [m]
    fn ahead_m(&self, step: usize) -> f64 {
        self.seen(step).0
    }

    /// How far to the left of the ego it is. [m]
    fn left_m(&self, step: usize) -> f64 {
        self.seen(step).1
    }

    /// From the ego's middle to its own, where one is right behind the other. [m]
    fn half_m(&self) -> f64 {
        0.5 * (self.ego.length_m + self.track.length_m)
    }

    /// How far it has turned away from how the ego heads. [rad]
    fn facing(&self, step: usize) -> f64 {
        math::wrap_angle(self.state(step).heading - self.came).abs()
    }

    /// How far it turns until the two touch, to the left. [rad]
    fn turned(&self) -> f64 {
        math::wrap_angle(self.state(self.until).heading - self.state(0).heading)
    }

    /// To the left of where it was at first, along the road, when the two touch. [m]
    fn aside_m(&self) -> f64 {
        self.ahead.cross(self.state(self.until).position() - self.state(0).position())
    }

    /// Whether it has come to another place when the two touch.
    fn drove(&self) -> bool {
        self.state(0).position().distance(self.state(self.until).position()) > DROVE_M
    }

    /// Whether it was faster before than when the two touch.
    fn slowed(&self) -> bool {
        (0..self.until).any(|step| self.mps(step) > self.mps(self.until) + SLOWED_MPS)
    }

    /// Whether it is near the ego.
    fn is_near(&self, step: usize) -> bool {
        let (ahead_m, left_m) = self.seen(step);
        math::hypot(ahead_m, left_m) - 0.5 * self.track.length_m < NEAR_M
    }

    /// Whether it is a lane or two beside the ego.
    fn is_beside(&self, step: usize) -> bool {
        (0.35 * LANE_M..2.2 * LANE_M).contains(&self.left_m(step).abs())
    }

    /// Whether it goes across the ego's way, by its heading.
    fn faces_across(&self, step: usize) -> bool {
        (0.6..2.5).contains(&self.facing(step))
    }

    /// Whether it is where it is told.
    fn is_placed(&self, step: usize) -> bool {
        let (ahead_m, left_m) = self.seen(step);
        let does = self.near.does;
        match self.near.place {
            _ if does == Does::TurnsLeft => ahead_m > 0.0,
            Some(Origin::Ahead) => ahead_m > 0.0 && left_m.abs() < 2.2 * LANE_M,
            Some(Origin::Behind) => ahead_m < -self.half_m() && left_m.abs() < 2.2 * LANE_M || does == Does::Passes,
            Some(Origin::Beside { .. }) if matches!(does, Does::Crosses | Does::PullsOut) => true,
            Some(Origin::Cross { .. }) if does == Does::Crosses => true,
            Some(Origin::Opposite) => self.facing(step) > 2.0 && left_m > 0.5 * LANE_M,
            Some(Origin::Beside { side }) => {
                let abreast = ahead_m.abs() < ABREAST_M + 0.5 * self.track.length_m;
                self.is_beside(step) && is_on_side(side, left_m) && abreast
            }
            Some(Origin::Cross { side }) => self.faces_across(step) && is_on_side(side, self.left_m(0)),
            _ => !self.near.across || self.faces_across(step),
        }
    }

    /// Whether who is ahead is so when the two touch, where it is not told to have left.
    fn stays_ahead(&self) -> bool {
        let near = self.near;
        near.place != Some(Origin::Ahead) || near.first == First::Left || self.ahead_m(self.until) > 0.0
    }

    /// Whether it did first what is told, or last.
    fn came_to_it(&self) -> bool {
        let until = self.until;
        match self.near.first {
            First::Untold => true,
            First::Came => self.drove(),
            First::Gone => {
                let sets_off = |step: &usize| !self.ego.states[*step].stands();
                let stood = (0..until).find(|step| !sets_off(step));
                let off = stood.and_then(|stood| (stood..until).find(sets_off));
                off.is_some_and(|off| match self.near.place {
                    Some(Origin::Cross { .. }) => self.left_m(0) * self.left_m(off) < 0.0,
                    _ => self.ahead_m(0) > 0.0 && self.ahead_m(off) < 0.0,
                })
            }
            First::Left => self.left_m(until).abs() > 0.5 * LANE_M || self.ahead_m(until) < -self.half_m(),
        }
    }

    /// Whether who waits opposite, slows there, or goes aside, has not long gone by when the two touch.
    fn waits_yet(&self) -> bool {
        let waits = matches!(self.near.does, Does::Slows | Does::Stands | Does::GoesAside(_));
        let waits = self.near.place == Some(Origin::Opposite) && waits;
        !waits || self.ahead_m(self.until) > -self.half_m() - GONE_BY_M
    }

    /// Whether it is on the side where it is told when the story begins.
    fn is_on_own_side(&self) -> bool {
        place_side(self.near.place).is_none_or(|side| is_on_side(side, self.left_m(0)))
    }

    /// Whether it does this.
    fn does(&self, does: Does) -> bool {
        let until = self.until;
        match does {
            Does::Untold => true,
            Does::Drives => self.drove(),
            Does::Backs => (0..=until).any(|step| self.state(step).speed() < -STANDS_MPS),
            Does::Slows => self.slowed(),
            Does::Stands => (until.saturating_sub(10)..=until).all(|step| self.mps(step) < STANDS_MPS),
            Does::Passes => {
                let by = (0..until).any(|step| self.ahead_m(step) < 0.0);
                by && self.ahead_m(until) > 0.0 && (0..until).any(|step| self.is_beside(step))
            }
            Does::Changes(side) => {
                let ego_m = self.ahead.cross(self.ego.states[until].position() - self.ego.states[0].position());
                let moved_m = self.left_m(until) - self.left_m(0) + ego_m;
                moved_m.abs() > 0.7 * LANE_M && side.is_none_or(|side| is_on_side(side, moved_m))
            }
            Does::Turns(side) => {
                let turned = self.turned();
                turned.abs() > TURNED_RAD && side.is_none_or(|side| is_on_side(side, turned))
            }
            Does::PullsOut => {
                let stood = self.mps(0) < STANDS_MPS && self.left_m(0).abs() > 0.5 * LANE_M;
                stood && self.is_on_own_side() && self.mps(until) > STANDS_MPS && self.aside_m().abs() > OUT_M
            }
            Does::GoesAside(side) | Does::PullsOver(side) => {
                let drawn_up = matches!(does, Does::GoesAside(_)) || self.slowed();
                let first = self.state(0);
                let own = Vec2::from_heading(first.heading).cross(self.state(until).position() - first.position());
                drawn_up && own.abs() > ASIDE_M && side.is_none_or(|side| is_on_side(side, own))
            }
            Does::Crosses => self.is_on_own_side() && self.aside_m().abs() > ACROSS_M,
            Does::TurnsLeft => {
                let crossed = (1..=until).any(|step| self.left_m(step) <= 0.0 && self.left_m(step - 1) > 0.0);
                self.facing(0) > 2.0 && self.turned() > 0.7 && crossed
            }
        }
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
