//! What somebody did at the contact and right before it: it stood, moved, slowed or gained speed.

use crate::told::crash::Told;
use crate::usual::STANDS_MPS;
use recrash_model::account::ContactState;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, STEP_S};
use recrash_model::scenario::MissionStop;
use recrash_roads::{RoadPart, Scenario};

/// Who stands no farther from a stop of its task stands at it. [m]
const AT_STOP_M: f64 = 1.0;

/// Whether the ego stands where its task has it stop.
pub(super) fn stands_at_stop(scenario: &Scenario, ego: &ActorTrack, time_s: f64) -> bool {
    let met = &ego.states[((time_s / STEP_S) as usize).min(ego.states.len() - 1)];
    let at = scenario.ego().path.project(met.position(), 0);
    let near = |stop: &MissionStop| math::hypot(at.s - stop.s_m, at.t - stop.t_m) < AT_STOP_M;
    met.velocity().length() < STANDS_MPS && scenario.draft().ego.stops.iter().any(near)
}

/// Who slowed has lost at least this, who gained speed has gained it, or a quarter. [m/s]
const CHANGED_MPS: f64 = 1.0;

/// Whether somebody slowed before a time, since it last stood, and whether it gained speed.
pub(super) fn changed(track: &ActorTrack, time_s: f64) -> (bool, bool) {
    let until = ((time_s * 10.0).floor() as usize).min(track.states.len() - 1);
    let now_mps = track.states[until].velocity().length();
    let stood = track.states[..until].iter().rposition(|state| state.velocity().length() < STANDS_MPS).unwrap_or(0);
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
    let until = ((time_s * 10.0).floor() as usize).min(track.states.len() - 1);
    track.states[..=until].iter().map(|state| state.velocity().length()).fold(0.0, f64::max)
}

/// Whether somebody stood before a time.
pub(super) fn stood(track: &ActorTrack, time_s: f64) -> bool {
    let until = ((time_s * 10.0).floor() as usize).min(track.states.len() - 1);
    track.states[..=until].iter().any(|state| state.velocity().length() < STANDS_MPS)
}

/// Whether somebody is in a state when it touches, and was before as the state says.
pub(super) fn state(told: ContactState, track: &ActorTrack, now: &ActorState, time_s: f64) -> bool {
    let step = (time_s * 10.0).floor() as usize;
    let back = |seconds: f64| track.states[step.saturating_sub((seconds * 10.0) as usize).min(track.states.len() - 1)];
    let speed = now.velocity().length();
    match told {
        ContactState::Moving => now.speed() > STANDS_MPS,
        ContactState::Reversing => now.speed() < -STANDS_MPS,
        ContactState::SettingOff => {
            now.speed() > STANDS_MPS
                && (1..=60).any(|tenth| back(0.1 * f64::from(tenth)).velocity().length() < STANDS_MPS)
        }
        ContactState::Stopped => speed < STANDS_MPS && back(1.0).velocity().length() < STANDS_MPS,
        ContactState::Parked => {
            track.states[..=step.min(track.states.len() - 1)].iter().all(|state| state.velocity().length() < STANDS_MPS)
        }
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
