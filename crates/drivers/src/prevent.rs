//! Reference drivers in the ego's place, in a contact that happened.
//!
//! A driver rides along as the ego drove, until it sees danger; from then on it drives. The other does what it did until the
//! contact, and goes on as it went then.

use crate::driver::{Body, Conflict, Driver, ReferenceDriver, STEPS_PER_S};
use recrash_model::geometry::Vec2;
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
/// The other goes the ego's way if it heads within this of it. A vehicle that stands counts too. [rad]
const SAME_WAY_RAD: f64 = 45.0 * math::PI / 180.0;
/// The careful driver takes braking of the vehicle ahead from this on for a danger (unr157, Annex 4, Appendix 3). [m/s^2]
const DANGEROUS_BRAKING_MPS2: f64 = 5.0;

/// What reference drivers make of the ego's first contact; `None` where there is none. No driver covers a contact off a straight
/// way, with somebody who does not go the ego's way, or from behind.
pub fn preventability(rollout: &Rollout) -> Option<Preventability> {
    let (actor, time_s, ego_at, other_at) = rollout.first_ego_contact()?;
    let (ego, other) = (rollout.actors.first()?, rollout.actors.get(actor)?);
    let forward = Vec2::from_heading(ego_at.heading);
    let closing_speed_mps = (ego_at.velocity() - other_at.velocity()).dot(forward);
    let drivers = Scene::new(ego, other, (ego_at, other_at), time_s).map_or(Vec::new(), |scene| scene.drivers());
    Some(Preventability { closing_speed_mps, drivers })
}

/// The two before the contact, seen along and across the ego's way, the other to the left.
struct Scene {
    begin_s: f64,
    ego: Vec<Body>,
    other: Vec<Body>,
    conflict: Conflict,
    /// From which step on the one ahead brakes dangerously.
    brakes_from: Option<usize>,
}

impl Scene {
    fn new(ego: &ActorTrack, other: &ActorTrack, at: (ActorState, ActorState), time_s: f64) -> Option<Self> {
        let end = ((time_s * STEPS_PER_S + 1e-6).floor() as usize + 1).min(ego.states.len()).min(other.states.len());
        let begin = end.saturating_sub((WINDOW_S * STEPS_PER_S) as usize);
        let (egos, others) = (ego.states.get(begin..end)?, other.states.get(begin..end)?);
        let start = egos.first()?;
        let forward = Vec2::from_heading(start.heading);
        let turned = |state: &ActorState| math::wrap_angle(state.heading - start.heading).abs();
        let aside = |state: &ActorState| (state.position() - start.position()).dot(forward.left());
        let straight = |state: &ActorState| turned(state) < STRAIGHT_RAD && aside(state).abs() < STRAIGHT_M;
        let ahead = (at.1.position() - at.0.position()).dot(forward) > 0.0;
        if !ahead || !egos.iter().all(straight) || !others.iter().all(|state| turned(state) < SAME_WAY_RAD) {
            return None;
        }
        // The models know an other to the left that comes to the right.
        let side = if aside(others.first()?) < 0.0 { -1.0 } else { 1.0 };
        let seen = |track: &ActorTrack, state: &ActorState| Body {
            along_m: (state.position() - start.position()).dot(forward),
            across_m: side * aside(state),
            speed_mps: state.velocity().dot(forward),
            lateral_mps: side * state.velocity().dot(forward.left()),
            length_m: track.length_m,
            width_m: track.width_m,
        };
        let egos: Vec<Body> = egos.iter().map(|state| seen(ego, state)).collect();
        let others: Vec<Body> = others.iter().map(|state| seen(other, state)).collect();
        let conflict = if egos[0].lateral_gap_m(&others[0]) > 0.0 { Conflict::CutIn } else { Conflict::Ahead };
        let brakes = |pair: &[Body]| (pair[0].speed_mps - pair[1].speed_mps) * STEPS_PER_S >= DANGEROUS_BRAKING_MPS2;
        let brakes_from = others.windows(2).position(brakes).map(|step| step + 1);
        Some(Self { begin_s: begin as f64 / STEPS_PER_S, ego: egos, other: others, conflict, brakes_from })
    }

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
        let acts_from =
            if model == ReferenceDriver::Careful && self.conflict == Conflict::Ahead { self.brakes_from } else { None };
        let mut ego = self.ego[0];
        for step in 0..self.other.len() + (AFTERWARDS_S * STEPS_PER_S) as usize {
            if place.reacts_at_s.is_none()
                && let Some(recorded) = self.ego.get(step)
            {
                ego = *recorded;
            }
            let other = self.other_at(step);
            if ego.touches(&other) {
                place.closing_speed_mps = Some(ego.speed_mps - other.speed_mps);
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
