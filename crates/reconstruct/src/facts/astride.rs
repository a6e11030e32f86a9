//! Told lines of the road that somebody's body is over, held against where it is.

use recrash_model::account::{Astride, AstrideWhen, LaneLine, LeftRight};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::{ActorState, ActorTrack};
use recrash_roads::{Lane, RoadNetwork, RoadPart, Scenario};

/// Who is over a line reaches over it by so much at least. [m]
pub(super) const LEAST_M: f64 = 0.35;

/// Who is at more than this to the lane lies across it. [sine]
const ACROSS: f64 = 0.7;

/// What lies behind a line is looked for so far behind it. [m]
const BEHIND_M: f64 = 0.1;

/// A line that a body reaches over: which, on which side of the lane that its middle is in, where that line is in the lane, to the right of
/// its middle, and by how much. [m]
struct Over {
    line: LaneLine,
    side: LeftRight,
    at_m: f64,
    by_m: f64,
}

/// Whether somebody's body is over the told line when it is told there; what it is over.
pub(super) fn astride(told: Astride, scenario: &Scenario, track: &ActorTrack, time_s: f64) -> (CheckResult, String) {
    let until = track.step_at(time_s);
    let stands = |step: &usize| track.states[*step].stands();
    let at = match told.when {
        AstrideWhen::Start => Some(0),
        AstrideWhen::Stop => (0..=until).rfind(stands),
        AstrideWhen::Contact => Some(until),
    };
    let cannot = |why: &str| (CheckResult::CannotBeShown, why.to_owned());
    let Some(state) = at.map(|at| &track.states[at]) else { return cannot("it did not stand") };
    let network = scenario.network();
    let Some((lane, lines)) = under(network, track, state) else { return cannot("along no lane") };
    let first = &track.states[0];
    let began = network.lane_at(first.position(), first.heading).map(|id| network.lane(id).road);
    if told.side.is_some() && began.is_some_and(|road| road != lane.road) {
        return cannot("on another road than it began on");
    }
    // Of the lane in which it began: who has come over the line by half is on the other side of it.
    let (began_m, gear) = (lane.local(first.position()).1, gear(lane, state));
    let on_side = |over: &Over| match told.side {
        None => true,
        Some(LeftRight::Left) => (over.at_m - began_m) * gear < 0.0,
        Some(LeftRight::Right) => (over.at_m - began_m) * gear > 0.0,
    };
    let shown = lines.iter().any(|over| over.line == told.line && on_side(over));
    let words = |over: &Over| {
        let line = match over.line {
            LaneLine::Edge => "the edge of the lanes",
            LaneLine::Lanes => "a line between lanes",
            LaneLine::Centre => "the line between the directions",
        };
        let side = if over.side == LeftRight::Left { "left" } else { "right" };
        format!("{:.1} m over {line} on its {side}", over.by_m)
    };
    let seen = lines.iter().map(words).collect::<Vec<_>>().join(", ");
    let result = if shown { CheckResult::Shown } else { CheckResult::CannotBeShown };
    (result, if seen.is_empty() { "over no line".to_owned() } else { seen })
}

/// 1 where somebody faces as its lane leads, else -1.
fn gear(lane: &Lane, state: &ActorState) -> f64 {
    let (s_m, _) = lane.local(state.position());
    if math::wrap_angle(state.heading - lane.heading(s_m)).abs() < math::FRAC_PI_2 { 1.0 } else { -1.0 }
}

/// The lane that the middle of a body is in, and the lines beside it that the body reaches over; nothing of who is across it, nor in a junction,
/// where no lines are.
fn under<'a>(network: &'a RoadNetwork, track: &ActorTrack, state: &ActorState) -> Option<(&'a Lane, Vec<Over>)> {
    let lane = network.lane(network.lane_at(state.position(), state.heading)?);
    let (s_m, t_m) = lane.local(state.position());
    let (way_rad, edge_m) = (lane.heading(s_m), 0.5 * lane.width_at(s_m));
    let sine = math::sin(state.heading - way_rad).abs();
    if sine > ACROSS || network.road(lane.road).part == RoadPart::Inner {
        return None;
    }
    let half_m = 0.5 * (track.width_m * (1.0 - sine * sine).sqrt() + track.length_m * sine);
    let way = Vec2::from_heading(way_rad);
    let over = |to_right: f64| {
        let (at_m, by_m) = (to_right * edge_m, to_right * t_m + half_m - edge_m);
        let behind = state.position() - way.left() * (at_m - t_m + to_right * BEHIND_M);
        let line = line_between(network, lane, (way_rad, behind))?;
        let left = (to_right < 0.0) == (gear(lane, state) > 0.0);
        let side = if left { LeftRight::Left } else { LeftRight::Right };
        (by_m >= LEAST_M).then_some(Over { line, side, at_m, by_m })
    };
    Some((lane, [-1.0, 1.0].into_iter().filter_map(over).collect()))
}

/// The line between a lane and what is behind it; nothing between two strips beside the lanes.
fn line_between(network: &RoadNetwork, lane: &Lane, (way_rad, behind): (f64, Vec2)) -> Option<LaneLine> {
    let beside = |lane: &Lane| matches!(network.road(lane.road).part, RoadPart::Beside(_));
    let next = network.lane_at(behind, way_rad).map(|id| network.lane(id));
    match (beside(lane), next) {
        (true, Some(next)) => (!beside(next)).then_some(LaneLine::Edge),
        (true, None) => None,
        (false, None) => Some(LaneLine::Edge),
        (false, Some(next)) if beside(next) => Some(LaneLine::Edge),
        (false, Some(next)) => {
            let turned = math::wrap_angle(next.heading(next.local(behind).0) - way_rad).abs();
            Some(if turned < math::FRAC_PI_2 { LaneLine::Lanes } else { LaneLine::Centre })
        }
    }
}
