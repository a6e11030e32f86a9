//! Whether somebody strays: goes another way than is told, or than anybody drives.

use crate::facts::contact::{first_touch, thrower};
use crate::facts::keeping::{self, ABSURD, is_for_narrow};
use crate::facts::movement;
use crate::facts::seen::Seen;
use crate::told::crash::Told;
use crate::told::layout::strip_of;
use crate::usual::{NARROW_M, STANDS_MPS};
use recrash_model::account::{Origin, Striker};
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Rollout, step_of};
use recrash_roads::{RoadPart, Scenario};

/// Whether one of the others who are drawn is elsewhere than it is wanted, or goes on at red.
pub(crate) fn others_stray(told: &Told, scenario: &Scenario, rollout: &Rollout) -> bool {
    let time_s = first_touch(rollout).map_or(told.contact_s, |touch| touch.time_s);
    !told.extras.is_empty() && Seen::new(told, rollout, time_s).strays(scenario)
}

/// Who turns back by more than this on its way swings. [deg]
const MOST_BACK_DEG: f64 = 30.0;

/// Who meets the other earlier or later than this has touched it elsewhere than was staged. [s]
const AS_STAGED_S: f64 = 0.15;

/// Whether a partner that drives along or across the road is beside it on its way to the contact, or swings one way and back the other, or
/// touches the ego before or after it was to.
/// Nobody tells that it did not.
pub(crate) fn strays(told: &Told, scenario: &Scenario, rollout: &Rollout) -> bool {
    let drives = !matches!(told.cp.kind, PartnerKind::Pedestrian | PartnerKind::Animal | PartnerKind::FixedObject);
    let on_road = matches!(
        told.origin,
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. }
    );
    let Some(touch) = first_touch(rollout).filter(|_| drives && on_road || told.edge.is_some()) else { return false };
    if (touch.time_s - told.contact_s).abs() > AS_STAGED_S {
        return true;
    }
    let Some(track) = touch.track else { return false };
    let until = track.step_at(touch.time_s);
    if told.comes_along_kerb() && !told.parks_behind() && comes_from_strip(scenario, track, until) {
        return true;
    }
    // Every second.
    let off = |state: &ActorState| !told.crosses_at_walk() && !scenario.network().on_road(state.position());
    let beside = track.states[..=until].iter().step_by(10).any(off);
    let oncoming = |state: &ActorState| movement::is_against(scenario, state) == Some(true);
    if told.keeps_direction() && track.states[..=until].iter().step_by(10).filter(|state| oncoming(state)).count() > 1 {
        return true;
    }
    let off_road = |other: usize| {
        let until = until_touched(rollout, &rollout.actors[other], touch.time_s);
        until.iter().step_by(10).any(|state| !scenario.network().on_road(state.position()))
    };
    if keeping::is_tight(told.cp.kind, until_touched(rollout, track, touch.time_s))
        || told.pushed && thrower(rollout, touch.time_s).is_some_and(off_road)
    {
        return true;
    }
    let turns = track.states[..=until].windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading));
    let (all, net) = turns.fold((0.0, 0.0), |(all, net), turn| (all + turn.abs(), net + turn));
    beside || (all - net.abs()).to_degrees() > MOST_BACK_DEG
}

/// Where somebody was until the contact, or until another touched it.
pub(super) fn until_touched<'a>(rollout: &Rollout, track: &'a ActorTrack, contact_s: f64) -> &'a [ActorState] {
    let number = rollout.actors.iter().position(|other| other.id == track.id);
    let touched = rollout.events.iter().find(|event| match event.kind {
        EventKind::Contact { a, b, .. } => number == Some(a) || number == Some(b),
        _ => false,
    });
    let until_s = touched.map_or(contact_s, |event| event.time_s.min(contact_s));
    track.until(until_s)
}

/// For how long the partner is off its lane.
pub(crate) fn off_lane_s(told: &Told, scenario: &Scenario, rollout: &Rollout) -> Option<f64> {
    let touch = first_touch(rollout)?;
    keeping::off_lane_s(told, scenario, touch.track.filter(|track| track.id == "cp")?, touch.time_s)
}

/// How far the partner's way is from what nobody tells otherwise: half seconds off its lane, weaving, and leaving whom it rubs along.
pub(crate) fn off_its_way(told: &Told, scenario: &Scenario, rollout: &Rollout) -> usize {
    let off_s = off_lane_s(told, scenario, rollout).unwrap_or(0.0);
    let touch =
        first_touch(rollout).and_then(|touch| Some((touch.track.filter(|track| track.id == "cp")?, touch.time_s)));
    let ego = rollout.ego_track();
    let weaves = |(track, time_s)| {
        keeping::weaves(told, track, time_s)
            + SWINGS * keeping::swings(told, track, time_s)
            + if keeping::is_before_turn(told, track, time_s) { SWINGS } else { 0 }
            + usize::from(keeping::leaves_whom_it_passes(told, ego, track, time_s))
            + if keeping::goes_out_of_way(told, ego, track, time_s) { ABSURD } else { 0 }
            + if keeping::drives_askew(told, ego, track) { ABSURD } else { 0 }
            + if told.is_beside_line(ego, track) || told.is_far_beside(ego, track) { ABSURD } else { 0 }
            + if strikes_as_told(told, rollout) == Some(false) { ABSURD } else { 0 }
            + if told.keeps_within_lanes() && is_over_edge(told, scenario, track, time_s) { OVER_EDGE } else { 0 }
    };
    (2.0 * off_s) as usize + touch.map_or(0, weaves)
}

/// That somebody swings out before its turn, or has not begun it, is worth a step from the told zones. [half seconds]
const SWINGS: usize = 3;

/// That nobody tells that it drove on the other side, or beside the lanes, is worse than four steps from the told zones. [half seconds]
const OVER_EDGE: usize = 3 * ABSURD;

/// Who strikes the other comes nearer to it by this. [m/s]
const CLOSES_MPS: f64 = 0.2;

/// Whether who is told in words to have struck the other comes nearer to that as they touch; nothing where words do not tell, or a door, a gate
/// or a third one takes part.
fn strikes_as_told(told: &Told, rollout: &Rollout) -> Option<bool> {
    let plain =
        told.thing.is_none() && told.door.is_none() && !told.pushed && told.rig.is_none() && told.edge.is_none();
    let (striker, touch) = (told.strikes.filter(|_| plain)?, first_touch(rollout)?);
    let ego = rollout.ego_track();
    let own = OrientedBox::new(touch.ego.pose(), ego.length_m, ego.width_m);
    let normal = own.contact_normal(&touch.other_box, touch.ego.velocity() - touch.other.velocity());
    let closing_mps = match striker {
        Striker::Sv => touch.ego.velocity().dot(normal),
        Striker::Cp => -touch.other.velocity().dot(normal),
        Striker::Both => return None,
    };
    Some(closing_mps >= CLOSES_MPS)
}

/// Who comes along the lanes has its flanks in those of its direction, but for so much, until so long before the contact. [m, s]
const OVER_EDGE_M: f64 = 0.3;
const OVER_EDGE_S: f64 = 3.0;

/// Whether somebody drove over the line between the directions, or over the edge of the lanes.
fn is_over_edge(told: &Told, scenario: &Scenario, track: &ActorTrack, contact_s: f64) -> bool {
    let network = scenario.network();
    let strip = told.cp.lane.and_then(strip_of);
    let flank_m = 0.5 * track.width_m - OVER_EDGE_M;
    let narrow = track.width_m < NARROW_M;
    let until = track.step_at(contact_s - OVER_EDGE_S);
    let first = track.states[0].heading;
    let on_its_road = |state: &&ActorState| math::wrap_angle(state.heading - first).abs() < LEAVES_ROAD_RAD;
    let driven = track.states[..=until].iter().step_by(5).take_while(on_its_road);
    driven.filter(|state| state.speed() > STANDS_MPS).any(|state| {
        let out = |side: f64| {
            let flank = state.position() + Vec2::from_heading(state.heading).left() * (side * flank_m);
            let Some(id) = network.lane_at(flank, state.heading) else { return true };
            let lane = network.lane(id);
            let along = math::wrap_angle(lane.heading(lane.local(flank).0) - state.heading).abs() < math::FRAC_PI_2;
            match network.road(lane.road).part {
                RoadPart::Inner => false,
                RoadPart::Beside(kind) => strip != Some(kind) && !(narrow && is_for_narrow(kind)),
                _ => !along,
            }
        };
        out(1.0) || out(-1.0)
    })
}

/// Who has turned by more has left its road. [rad]
const LEAVES_ROAD_RAD: f64 = 0.3;

/// Who drives beside the kerb until so long before the contact, with its flank by so much, comes from there. [s, m]
const BESIDE_S: f64 = 1.0;
const BESIDE_M: f64 = 0.3;

/// Whether somebody who comes along the lane beside which the ego is parked has driven where others park before it came to the ego.
fn comes_from_strip(scenario: &Scenario, track: &ActorTrack, until: usize) -> bool {
    let network = scenario.network();
    let flank_m = 0.5 * track.width_m - BESIDE_M;
    let before = until.saturating_sub(step_of(BESIDE_S));
    track.states[..before].iter().any(|state| {
        let flank = state.position() - Vec2::from_heading(state.heading).left() * flank_m;
        let lane = network.lane_at(flank, state.heading);
        lane.is_some_and(|lane| matches!(network.road(network.lane(lane).road).part, RoadPart::Beside(_)))
    })
}
