//! What somebody did at the contact and right before it: it stood, moved, slowed or gained speed.

use crate::told::crash::Told;
use crate::usual::STANDS_MPS;
use recrash_model::account::ContactState;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, step_of};
use recrash_model::scenario::MissionStop;
use recrash_roads::{RoadPart, Scenario};

/// Who stands no farther from a stop of its task stands at it. [m]
const AT_STOP_M: f64 = 1.0;

/// Whether the ego stands where its task has it stop.
pub(super) fn stands_at_stop(scenario: &Scenario, ego: &ActorTrack, time_s: f64) -> bool {
    let met = ego.at(step_of(time_s));
    let at = scenario.ego().path.project(met.position(), 0);
    let near = |stop: &MissionStop| math::hypot(at.s - stop.s_m, at.t - stop.t_m) < AT_STOP_M;
    met.stands() && scenario.draft().ego.stops.iter().any(near)
}

/// Who slowed has lost at least this, who gained speed has gained it, or a quarter. [m/s]
const CHANGED_MPS: f64 = 1.0;

/// Whether somebody slowed before a time, since it last stood, and whether it gained speed.
pub(super) fn changed(track: &ActorTrack, time_s: f64) -> (bool, bool) {
    let until = track.step_at(time_s);
    let now_mps = track.states[until].velocity().length();
    let stood = track.states[..until].iter().rposition(|state| state.stands()).unwrap_or(0);
    let any =
        |was: &dyn Fn(f64) -> bool| track.states[stood..=until].iter().any(|state| was(state.velocity().length()));
    (any(&|mps| mps > now_mps + CHANGED_MPS), any(&|mps| mps < now_mps - CHANGED_MPS.min(0.25 * now_mps)))
}

/// Who came along slowly was no faster than this share more. [1]
const SLOWLY_SHARE: f64 = 1.25;

/// Whether somebody came along no faster than so.
pub(super) fn came_slowly(track: &ActorTrack, time_s: f64, told_mps: f64) -> bool {
    fastest(track, time_s) <= SLOWLY_SHARE * told_mps
}

fn fastest(track: &ActorTrack, time_s: f64) -> f64 {
    track.until(time_s).iter().map(|state| state.velocity().length()).fold(0.0, f64::max)
}

/// Whether somebody stood before a time.
pub(super) fn stood(track: &ActorTrack, time_s: f64) -> bool {
    track.until(time_s).iter().any(|state| state.stands())
}

/// Whether somebody is in a state when it touches, and was before as the state says.
pub(super) fn state(told: ContactState, track: &ActorTrack, now: &ActorState, time_s: f64) -> bool {
    let step = step_of(time_s);
    let back = |seconds: f64| track.at(step.saturating_sub(step_of(seconds)));
    let speed = now.velocity().length();
    match told {
        ContactState::Moving => now.speed() > STANDS_MPS,
        ContactState::Reversing => now.speed() < -STANDS_MPS,
        ContactState::SettingOff => {
            now.speed() > STANDS_MPS
                && (1..=60).any(|tenth| back(0.1 * f64::from(tenth)).velocity().length() < STANDS_MPS)
        }
        ContactState::Stopped => speed < STANDS_MPS && back(1.0).velocity().length() < STANDS_MPS,
        ContactState::Parked => track.states[..=track.within(step)].iter().all(|state| state.stands()),
    }
}

impl Told {
    /// Whether who is told to stand beside the lanes does so: its middle is in no driving lane.
    pub(super) fn stands_so(&self, of_ego: bool, scenario: &Scenario, at: &ActorState) -> bool {
        let network = scenario.network();
        let in_lane = network
            .lane_at(at.position(), at.heading)
            .is_some_and(|lane| !matches!(network.road(network.lane(lane).road).part, RoadPart::Beside(_)));
        !(self.stands_beside(of_ego) && in_lane)
    }
}
