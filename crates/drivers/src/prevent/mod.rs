//! Reference drivers in the ego's place, in a contact that happened.
//!
//! A driver rides along as the ego drove, until it reacts; from then on it drives. The other does what it did until the
//! contact, and goes on as it went then.

mod reaction;

use crate::driver::{Conflict, Driver, ReferenceDriver};
use crate::sight::{Body, STEPS_PER_S};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::preventability::{InTheirPlace, Preventability};
use recrash_model::rollout::{ActorState, ActorTrack, Rollout};

/// What is looked at before the contact. [s]
const WINDOW_S: f64 = 15.0;
/// How long the drivers drive on after it. [s]
const AFTERWARDS_S: f64 = 15.0;
/// The ego's way is straight if it turns by less than this and goes aside by less than that. [rad, m]
const STRAIGHT_RAD: f64 = 5.0 * math::PI / 180.0;
const STRAIGHT_M: f64 = 1.0;
/// The other goes the ego's way if it heads within this of it. [rad]
const SAME_WAY_RAD: f64 = 45.0 * math::PI / 180.0;
/// The careful driver takes braking of the vehicle ahead from this on for a danger (unr157, Annex 4, Appendix 3). [m/s^2]
const DANGEROUS_BRAKING_MPS2: f64 = 5.0;

/// What reference drivers make of the ego's first contact; `None` where there is none. No driver covers a contact off a straight
/// way, or with somebody behind.
pub fn preventability(rollout: &Rollout) -> Option<Preventability> {
    let (actor, time_s, ego_at, other_at) = rollout.first_ego_contact()?;
    let (ego, other) = (rollout.actors.first()?, rollout.actors.get(actor)?);
    let forward = Vec2::from_heading(ego_at.heading);
    let closing_speed_mps = (ego_at.velocity() - other_at.velocity()).dot(forward);
    let ahead = (other_at.position() - ego_at.position()).dot(forward) > 0.0;
    let mut drivers = Vec::new();
    if let Some(encounter) = Encounter::new(ego, other, time_s).filter(|_| ahead) {
        drivers.extend(encounter.in_lane().map_or(Vec::new(), |lane| lane.drivers()));
        drivers.extend(reaction::drive(&encounter, AFTERWARDS_S));
    }
    Some(Preventability { closing_speed_mps, drivers })
}

/// The two before the contact, on a straight way of the ego's.
struct Encounter<'a> {
    /// When it begins. [s]
    begin_s: f64,
    egos: &'a [ActorState],
    others: &'a [ActorState],
    /// Where the ego is at first, and where it heads.
    start: Pose,
    /// Length and width. [m]
    ego_size: [f64; 2],
    other_size: [f64; 2],
    /// Whether the other heads the ego's way throughout.
    same_way: bool,
}

impl<'a> Encounter<'a> {
    fn new(ego: &'a ActorTrack, other: &'a ActorTrack, time_s: f64) -> Option<Self> {
        let end = ((time_s * STEPS_PER_S + 1e-6).floor() as usize + 1).min(ego.states.len()).min(other.states.len());
        let begin = end.saturating_sub((WINDOW_S * STEPS_PER_S) as usize);
        let (egos, others) = (ego.states.get(begin..end)?, other.states.get(begin..end)?);
        let start = egos.first()?.pose();
        let turned = |state: &ActorState| math::wrap_angle(state.heading - start.heading).abs();
        let encounter = Self {
            begin_s: begin as f64 / STEPS_PER_S,
            egos,
            others,
            start,
            ego_size: [ego.length_m, ego.width_m],
            other_size: [other.length_m, other.width_m],
            same_way: others.iter().all(|state| turned(state) < SAME_WAY_RAD),
        };
        let straight =
            |state: &ActorState| turned(state) < STRAIGHT_RAD && encounter.aside_m(state.position()).abs() < STRAIGHT_M;
        egos.iter().all(straight).then_some(encounter)
    }

    fn forward(&self) -> Vec2 {
        Vec2::from_heading(self.start.heading)
    }

    fn along_m(&self, position: Vec2) -> f64 {
        (position - self.start.position).dot(self.forward())
    }

    /// To the left of the ego's way. [m]
    fn aside_m(&self, position: Vec2) -> f64 {
        (position - self.start.position).dot(self.forward().left())
    }

    fn along_speed_mps(&self, velocity: &Vec2) -> f64 {
        velocity.dot(self.forward())
    }

    /// The ego's box when it has come so far.
    fn ego_box(&self, along_m: f64) -> OrientedBox {
        let pose = Pose { position: self.start.position + self.forward() * along_m, ..self.start };
        OrientedBox::new(pose, self.ego_size[0], self.ego_size[1])
    }

    /// From the middle of the ego's way to the other's nearest corner, across; negative where it lies across the middle. [m]
    fn near_side_m(&self, step: usize) -> f64 {
        let state = &self.others[step];
        let outline = OrientedBox::new(state.pose(), self.other_size[0], self.other_size[1]);
        let across = outline.corners().map(|corner| self.aside_m(corner));
        let [least, most] =
            [across.into_iter().fold(f64::INFINITY, f64::min), across.into_iter().fold(f64::NEG_INFINITY, f64::max)];
        f64::max(least, -most)
    }

    /// The same for the models of lanes; `None` where the other does not go the ego's way.
    fn in_lane(&self) -> Option<InLane> {
        // The models know an other to the left that comes to the right.
        let side = if self.aside_m(self.others[0].position()) < 0.0 { -1.0 } else { 1.0 };
        let seen = |[length_m, width_m]: [f64; 2], state: &ActorState| Body {
            along_m: self.along_m(state.position()),
            across_m: side * self.aside_m(state.position()),
            speed_mps: self.along_speed_mps(&state.velocity()),
            lateral_mps: side * state.velocity().dot(self.forward().left()),
            length_m,
            width_m,
        };
        let ego: Vec<Body> = self.egos.iter().map(|state| seen(self.ego_size, state)).collect();
        let other: Vec<Body> = self.others.iter().map(|state| seen(self.other_size, state)).collect();
        let conflict = if ego[0].lateral_gap_m(&other[0]) > 0.0 { Conflict::CutIn } else { Conflict::Ahead };
        let brakes = |pair: &[Body]| (pair[0].speed_mps - pair[1].speed_mps) * STEPS_PER_S >= DANGEROUS_BRAKING_MPS2;
        let brakes_from = other.windows(2).position(brakes).map(|step| step + 1);
        self.same_way.then_some(InLane { begin_s: self.begin_s, ego, other, conflict, brakes_from })
    }
}

/// The two seen along and across the ego's way.
struct InLane {
    begin_s: f64,
    ego: Vec<Body>,
    other: Vec<Body>,
    conflict: Conflict,
    /// From which step on the one ahead brakes dangerously.
    brakes_from: Option<usize>,
}

impl InLane {
    /// Every driver whose source covers the conflict.
    fn drivers(&self) -> Vec<InTheirPlace> {
        let cut_in = self.conflict == Conflict::CutIn;
        let covers = |driver: &ReferenceDriver| match driver {
            ReferenceDriver::Careful => cut_in || self.brakes_from.is_some(),
            ReferenceDriver::Fuzzy | ReferenceDriver::Responsibility => true,
            ReferenceDriver::Regulation => cut_in,
        };
        ReferenceDriver::ALL.into_iter().filter(covers).map(|driver| self.drive(driver)).collect()
    }

    fn drive(&self, model: ReferenceDriver) -> InTheirPlace {
        let mut driver = Driver::new(model, self.conflict);
        let mut place = InTheirPlace { driver: model.name().to_owned(), reacts_at_s: None, closing_speed_mps: None };
        // Who acts as soon as there is a danger ahead waits for it.
        let waits = model == ReferenceDriver::Careful && self.conflict == Conflict::Ahead;
        let acts_from = self.brakes_from.filter(|_| waits);
        let mut ego = self.ego[0];
        for step in 0..self.other.len() + (AFTERWARDS_S * STEPS_PER_S) as usize {
            if place.reacts_at_s.is_none()
                && let Some(recorded) = self.ego.get(step)
            {
                ego = *recorded;
            }
            let other = self.other_at(step);
            if ego.touches(&other) {
                place.closing_speed_mps = Some((ego.speed_mps - other.speed_mps).max(0.0));
                break;
            }
            if acts_from.is_some_and(|from| step < from) {
                continue;
            }
            let speed_mps = driver.next_speed_mps(&ego, &other);
            if driver.settled() {
                break;
            }
            if driver.reacts() && place.reacts_at_s.is_none() {
                place.reacts_at_s = Some(self.begin_s + step as f64 / STEPS_PER_S);
            }
            ego.speed_mps = speed_mps;
            ego.along_m += speed_mps / STEPS_PER_S;
        }
        place
    }

    /// The other at a step: as it was, or as it goes on from its last place.
    fn other_at(&self, step: usize) -> Body {
        let last = self.other.len() - 1;
        let mut other = self.other[step.min(last)];
        other.along_m += other.speed_mps * step.saturating_sub(last) as f64 / STEPS_PER_S;
        other
    }
}

#[cfg(test)]
mod tests;
