//! Whether somebody near hinders nobody.

use crate::facts::{movement, signals};
use crate::usual::WHEELED_M;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Rollout};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Scenario;

/// Nobody comes closer to it. [m]
pub(super) const CLEAR_M: f64 = 0.5;

/// Whether somebody touches nobody, crosses no red light, is on the road where it is a vehicle, and all else is as without it.
pub(super) fn hinders_nobody(id: &str, scenario: &Scenario, (before, after): (&Rollout, &Rollout)) -> bool {
    let Some(track) = after.actors.iter().find(|track| track.id == id) else { return false };
    let contacts = |rollout: &Rollout| -> Vec<(String, String, f64)> {
        let name = |number: usize| rollout.actors[number].id.clone();
        let of = |event: &recrash_model::rollout::Event| match event.kind {
            EventKind::Contact { a, b, .. } => Some((name(a), name(b), event.time_s)),
            EventKind::ObstacleContact { actor, obstacle, .. } => {
                Some((name(actor), format!("obstacle {obstacle}"), event.time_s))
            }
            _ => None,
        };
        rollout.events.iter().filter_map(of).collect()
    };
    let first_s = contacts(after).first().map_or(f64::MAX, |(_, _, at_s)| *at_s);
    let of = |track: &ActorTrack, step: usize| {
        let state = track.at(step);
        OrientedBox::new(state.pose(), track.length_m, track.width_m)
    };
    let until = track.step_at(first_s + 1.0);
    let clear = |step: usize| {
        let own = of(track, step);
        after.actors.iter().all(|other| other.id == id || own.gap(&of(other, step)) > CLEAR_M)
            && after.obstacles.iter().all(|placed| own.gap(&placed.outline()) > CLEAR_M)
    };
    let drives = VehicleSpec::of(track.kind).length_m > WHEELED_M;
    let on_road = |step: usize| !drives || scenario.network().on_road(track.states[step].position());
    let met = after.ego_track().until(first_s);
    contacts(before) == contacts(after)
        && (0..=until).all(clear)
        && !is_cut_off(track, met)
        && !(drives && goes_wrong_way(scenario, track, met))
        && (0..=until).step_by(5).all(on_road)
        && !signals::runs_red(scenario, track)
}

/// Whose way an ego that turns left bars by this much of its turn, it has let by; farther ahead than this nobody minds. [rad, m/s, m]
const BARS_RAD: f64 = 0.15;
const COMES_MPS: f64 = 1.0;
const MINDS_M: f64 = 25.0;

/// Whether somebody comes towards an ego that turns left across its way as it is touched.
fn is_cut_off(track: &ActorTrack, ego: &[ActorState]) -> bool {
    let (first, last) = (&ego[0], &ego[ego.len() - 1]);
    let state = track.at(ego.len() - 1);
    let ahead_m = Vec2::from_heading(first.heading).dot(state.position() - last.position());
    let oncoming = math::wrap_angle(state.heading - first.heading).abs() > 2.0 && state.speed() > COMES_MPS;
    let turns = math::wrap_angle(last.heading - first.heading) > BARS_RAD;
    turns && oncoming && (0.0..MINDS_M).contains(&ahead_m)
}

/// Whether somebody who sets out the ego's way drives in a lane that leads the other way.
fn goes_wrong_way(scenario: &Scenario, track: &ActorTrack, ego: &[ActorState]) -> bool {
    let same_way = math::wrap_angle(track.states[0].heading - ego[0].heading).abs() < 1.0;
    let until = ego.len().min(track.states.len());
    let wrong = |state: &ActorState| state.speed() > COMES_MPS && movement::is_against(scenario, state) == Some(true);
    same_way && track.states[..until].iter().step_by(5).any(wrong)
}
