//! Rollouts by closed form: road users that follow a lane at constant speed, for tests a reader can check in his head.
#![allow(missing_docs)]

use recrash_metrics::EgoWay;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::Metrics;
use recrash_model::narrative::Side;
use recrash_model::profile::FailureCriteria;
use recrash_model::rollout::{
    ActorState, ActorTrack, EGO_ID, Event, EventKind, PlacedObstacle, ROLLOUT_FORMAT, Role, Rollout, STEP_S,
    Termination, TerminationKind,
};
use recrash_model::scenario::{
    Approach, CrossMap, CurveMap, MapSpec, MissingArm, ObstacleKind, RoundaboutMap, StraightMap, TeeMap, Turn,
};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{LanePath, RoadNetwork};

pub const LENGTH_M: f64 = VehicleSpec::of(PartnerKind::PassengerCar).length_m;
pub const WIDTH_M: f64 = VehicleSpec::of(PartnerKind::PassengerCar).width_m;

pub const CRITERIA: FailureCriteria = FailureCriteria {
    min_gap_m: 2.0,
    hard_braking_mps2: 4.0,
    phantom_braking_mps2: 3.0,
    oscillation_reversals: 4,
    oscillation_window_s: 5.0,
    lane_departure_m: 0.3,
};

pub fn straight() -> RoadNetwork {
    RoadNetwork::build(&MapSpec::S(StraightMap { lanes: 2, lane_width_m: 3.5, approach_m: 60.0, length_m: 500.0 }))
}

/// Rightmost lane of radius 50 m, a quarter of a circle.
pub fn curve(direction: Side) -> RoadNetwork {
    RoadNetwork::build(&MapSpec::C(CurveMap {
        lanes: 2,
        lane_width_m: 3.5,
        approach_m: 60.0,
        radius_m: 50.0,
        angle_deg: 90.0,
        direction,
        length_m: 100.0,
    }))
}

pub fn cross() -> RoadNetwork {
    RoadNetwork::build(&MapSpec::X(CrossMap { lanes: 2, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0 }))
}

pub fn tee(missing: MissingArm) -> RoadNetwork {
    RoadNetwork::build(&MapSpec::T(TeeMap { lanes: 2, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0, missing }))
}

pub fn circle() -> RoadNetwork {
    RoadNetwork::build(&MapSpec::O(RoundaboutMap {
        lanes: 2,
        lane_width_m: 3.5,
        approach_m: 60.0,
        arm_m: 60.0,
        exit_radius_m: 10.0,
        inner_radius_m: 30.0,
    }))
}

pub fn path(network: &RoadNetwork, approach: Approach, turn: Turn, lane: u8) -> LanePath {
    LanePath::new(network, network.route(approach, turn).expect("the map has this way"), lane)
}

/// States of one that follows `path` from `s_m` on: `speed(t)` is integrated exactly for constant and linear speeds.
pub fn drive(path: &LanePath, s_m: f64, steps: usize, speed: impl Fn(f64) -> f64) -> Vec<ActorState> {
    drive_at(path, s_m, steps, speed, |_| 0.0)
}

/// The same with an offset to the right of the lane over time; the heading follows the path driven.
pub fn drive_at(
    path: &LanePath,
    s_m: f64,
    steps: usize,
    speed: impl Fn(f64) -> f64,
    offset: impl Fn(f64) -> f64,
) -> Vec<ActorState> {
    let mut s = s_m;
    (0..steps)
        .map(|step| {
            let time = step as f64 * STEP_S;
            let here = path.pose(s, offset(time));
            let rate = (offset(time + 1e-4) - offset(time)) / 1e-4;
            let v = speed(time);
            let slant = if v > 0.5 { -math::atan(rate / v) } else { 0.0 };
            s += 0.5 * (v + speed(time + STEP_S)) * STEP_S;
            ActorState::moving(Pose { heading: here.heading + slant, ..here }, v)
        })
        .collect()
}

/// One at constant velocity, on no road at all.
pub fn glide(x: f64, y: f64, heading: f64, speed: f64, steps: usize) -> Vec<ActorState> {
    let go = Vec2::from_heading(heading) * speed;
    (0..steps)
        .map(|step| {
            let time = step as f64 * STEP_S;
            ActorState::moving(Pose { position: Vec2::new(x, y) + go * time, heading }, speed)
        })
        .collect()
}

pub fn actor(id: &str, role: Role, states: Vec<ActorState>) -> ActorTrack {
    ActorTrack {
        part_of: None,
        mass_kg: None,
        appears_s: 0.0,
        gone_s: None,
        id: id.to_owned(),
        role,
        kind: PartnerKind::PassengerCar,
        length_m: LENGTH_M,
        width_m: WIDTH_M,
        states,
    }
}

/// A rollout of the ego and partners `cp1`, `cp2`, ..., ended as a simulator would: at the first recorded overlap.
pub fn rollout(ego: Vec<ActorState>, partners: Vec<Vec<ActorState>>) -> Rollout {
    let mut actors = vec![actor(EGO_ID, Role::Ego, ego)];
    for (number, states) in partners.into_iter().enumerate() {
        actors.push(actor(&format!("cp{}", number + 1), Role::Partner, states));
    }
    let mut rollout = Rollout {
        format: ROLLOUT_FORMAT.to_owned(),
        scenario_id: "synthetic".to_owned(),
        simulator: "closed form".to_owned(),
        ego: "none".to_owned(),
        termination: Termination {
            kind: TerminationKind::Timeout,
            time_s: (actors[0].states.len().max(1) - 1) as f64 * STEP_S,
        },
        actors,
        obstacles: Vec::new(),
        events: Vec::new(),
        state_hash: String::new(),
    };
    end_at_contact(&mut rollout);
    rollout
}

fn end_at_contact(rollout: &mut Rollout) {
    for step in 0..rollout.steps() {
        for b in 1..rollout.actors.len() {
            let ego = rollout.actors[0].outline(step);
            if step < rollout.actors[b].states.len() && ego.overlaps(&rollout.actors[b].outline(step)) {
                let (a_state, b_state) = (rollout.actors[0].states[step], rollout.actors[b].states[step]);
                let time_s = step as f64 * STEP_S;
                rollout.events.push(Event { time_s, kind: EventKind::Contact { a: 0, b, a_state, b_state } });
                rollout.termination = Termination { kind: TerminationKind::Contact, time_s };
                return;
            }
        }
    }
}

pub fn cone(x: f64, y: f64) -> PlacedObstacle {
    PlacedObstacle {
        kind: ObstacleKind::Cone,
        pose: Pose { position: Vec2::new(x, y), heading: 0.0 },
        length_m: 0.4,
        width_m: 0.4,
    }
}

pub fn measure(network: &RoadNetwork, path: &LanePath, target_speed_mps: f64, rollout: &Rollout) -> Metrics {
    recrash_metrics::measure_on(&EgoWay::plain(network, path, target_speed_mps), rollout, &CRITERIA)
}

pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected} within {tolerance}");
}
