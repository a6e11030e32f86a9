//! A driver who reacts after the time that people take, and brakes in full: for crossings too (green2000).

use super::Encounter;
use crate::sight::{BRAKING_JERK_MPS3, FULL_BRAKING_MPS2, STEPS_PER_S};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::preventability::InTheirPlace;

/// Its name in tables.
const NAME: &str = "reaction-time";
/// Until braking begins, where the leader's brake lights go on. [s]
const TO_BRAKE_LIGHTS_S: f64 = 1.25;
/// Until braking begins, where something moves into the way. [s]
const TO_A_SURPRISE_S: f64 = 1.5;
/// The way is a lane: half of its width. Assumed. [m]
const HALF_LANE_M: f64 = 1.75;
/// Braking from which on brake lights are on. Assumed. [m/s^2]
const BRAKE_LIGHTS_MPS2: f64 = 1.0;
/// Looks for a contact within a step.
const LOOKS: usize = 5;

/// What happens to it; `None` where it has nothing to react to: the other was in the lane from the start, and did not brake.
pub fn drive(encounter: &Encounter, afterwards_s: f64) -> Option<InTheirPlace> {
    let (onset, reaction_s) = onset(encounter)?;
    let begins = onset + (reaction_s * STEPS_PER_S).round() as usize;
    let mut place = InTheirPlace {
        driver: NAME.to_owned(),
        reacts_at_s: Some(encounter.begin_s + onset as f64 / STEPS_PER_S),
        closing_speed_mps: None,
    };
    let (mut along_m, mut speed_mps, mut braking_mps2) =
        (0.0, encounter.along_speed_mps(&encounter.egos[0].velocity()), 0.0);
    for step in 0..encounter.others.len() + (afterwards_s * STEPS_PER_S) as usize {
        if let Some(recorded) = encounter.egos.get(step).filter(|_| step <= begins) {
            along_m = encounter.along_m(recorded.position());
            speed_mps = encounter.along_speed_mps(&recorded.velocity());
        }
        if step >= begins {
            braking_mps2 = f64::min(braking_mps2 + BRAKING_JERK_MPS3 / STEPS_PER_S, FULL_BRAKING_MPS2);
        }
        let slower_mps = (speed_mps - braking_mps2 / STEPS_PER_S).max(0.0);
        for look in 0..LOOKS {
            let share = look as f64 / LOOKS as f64;
            let (pose, velocity) = other_at(encounter, step as f64 + share);
            let here_m = along_m + share * slower_mps / STEPS_PER_S;
            if encounter.ego_box(here_m).overlaps(&OrientedBox::new(
                pose,
                encounter.other_size[0],
                encounter.other_size[1],
            )) {
                place.closing_speed_mps = Some((speed_mps - encounter.along_speed_mps(&velocity)).max(0.0));
                return Some(place);
            }
        }
        speed_mps = slower_mps;
        along_m += speed_mps / STEPS_PER_S;
    }
    Some(place)
}

/// The step at which there is something to react to, and how long that takes. [s]
fn onset(encounter: &Encounter) -> Option<(usize, f64)> {
    let in_the_lane = |step: &usize| encounter.near_side_m(*step) <= HALF_LANE_M;
    let entered = (0..encounter.others.len()).find(in_the_lane)?;
    if entered > 0 {
        return Some((entered, TO_A_SURPRISE_S));
    }
    let speed_mps = |step: usize| encounter.along_speed_mps(&encounter.others[step].velocity());
    let brakes = |step: &usize| (speed_mps(*step - 1) - speed_mps(*step)) * STEPS_PER_S >= BRAKE_LIGHTS_MPS2;
    let braked = (1..encounter.others.len()).find(brakes).filter(|_| encounter.same_way)?;
    Some((braked, TO_BRAKE_LIGHTS_S))
}

/// The other at a time, between its places, and after the last one as it went then. [steps]
fn other_at(encounter: &Encounter, time: f64) -> (Pose, Vec2) {
    let last = encounter.others.len() - 1;
    let step = (time.floor() as usize).min(last);
    let state = &encounter.others[step];
    let position = match encounter.others.get(step + 1) {
        Some(next) => state.position() + (next.position() - state.position()) * (time - step as f64),
        None => state.position() + state.velocity() * ((time - step as f64) / STEPS_PER_S),
    };
    (Pose { position, heading: state.heading }, state.velocity())
}
