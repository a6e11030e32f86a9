//! Scenarios for tests, benchmarks and the oracle.
#![allow(dead_code, reason = "each user takes some of these")]

use recrash_model::Seed;
use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Side;
use recrash_model::scenario::{
    Approach, Author, CrossMap, CurveMap, EgoSpec, Environment, LateralMove, MapSpec, MissingArm, Obstacle,
    ObstacleKind, Partner, Policy, RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source, Start, StraightMap, TeeMap,
    Traffic, Turn,
};
use recrash_model::seed::Rng;
use recrash_roads::{Scenario, check};

/// S with an approach of 60 m and this much behind it.
pub fn straight(lanes: u8, length_m: f64) -> MapSpec {
    MapSpec::S(StraightMap { lanes, lane_width_m: 3.5, approach_m: 60.0, length_m })
}

/// C of radius 50 m (of the rightmost lane) and 90 degrees.
pub fn curve(lanes: u8, direction: Side) -> MapSpec {
    MapSpec::C(CurveMap {
        lanes,
        lane_width_m: 3.5,
        approach_m: 60.0,
        radius_m: 50.0,
        angle_deg: 90.0,
        direction,
        length_m: 60.0,
    })
}

/// X with arms of 60 m.
pub fn cross(lanes: u8) -> MapSpec {
    MapSpec::X(CrossMap { lanes, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0 })
}

/// X with arms long enough for any start.
pub fn wide_cross(lanes: u8) -> MapSpec {
    MapSpec::X(CrossMap { lanes, lane_width_m: 3.5, approach_m: 60.0, arm_m: 150.0 })
}

/// T with arms of 60 m.
pub fn tee(lanes: u8, missing: MissingArm) -> MapSpec {
    MapSpec::T(TeeMap { lanes, lane_width_m: 3.5, approach_m: 60.0, arm_m: 60.0, missing })
}

/// O with exits of radius 10 m and an inner radius of 30 m.
pub fn roundabout(lanes: u8) -> MapSpec {
    MapSpec::O(RoundaboutMap {
        lanes,
        lane_width_m: 3.5,
        approach_m: 60.0,
        arm_m: 60.0,
        exit_radius_m: 10.0,
        inner_radius_m: 30.0,
    })
}

/// A scenario with nobody but the ego.
pub fn alone(map: MapSpec, turn: Turn, lane: u8, speed_mps: f64, target_speed_mps: f64) -> ScenarioDraft {
    ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: "test".to_owned(),
        source: Source { author: Author::Person, ..Source::default() },
        map,
        ego: EgoSpec { turn, lane, s_m: 5.0, speed_mps, target_speed_mps, ..EgoSpec::default() },
        partners: Vec::new(),
        obstacles: Vec::new(),
        traffic: Traffic::default(),
        environment: Environment::default(),
        duration_s: 40.0,
        ..ScenarioDraft::default()
    }
}

/// A car that holds a speed.
pub fn steady(approach: Approach, turn: Turn, start: Start, speed_mps: f64) -> Partner {
    Partner {
        id: "cp1".to_owned(),
        kind: PartnerKind::PassengerCar,
        approach,
        turn,
        lane_offset: 0,
        start,
        speed_mps,
        policy: Policy::SuddenBrake { target_speed: speed_mps, brake_step: 0, brake_steps: 0, speed_kp: None },
        lateral: Vec::new(),
    }
}

/// A car in the ego's lane, this far ahead.
pub fn lead(delta_s_m: f64, speed_mps: f64) -> Partner {
    steady(Approach::Same, Turn::Straight, Start::Offset { delta_s_m, delta_t_m: 0.0 }, speed_mps)
}

/// Checks a draft that must be fit to run.
#[track_caller]
pub fn checked(draft: ScenarioDraft) -> Scenario {
    match check(draft) {
        Ok(outcome) => outcome.value,
        Err(problems) => panic!("{problems:#?}"),
    }
}

/// Six scenarios of the kinds that matter: crossing, oncoming turn, merge, sideswipe past cones, same exit, braking lead.
pub fn trials() -> Vec<ScenarioDraft> {
    let named = |mut draft: ScenarioDraft, id: &str| {
        draft.id = id.to_owned();
        draft
    };

    let mut crossing = alone(wide_cross(2), Turn::Straight, 1, 8.33, 8.33);
    crossing.partners.push(steady(Approach::Left, Turn::Straight, Start::ArrivalGap { arrival_gap_s: 0.1 }, 8.0));

    let mut oncoming = alone(wide_cross(2), Turn::Straight, 1, 8.33, 8.33);
    let mut turning = steady(Approach::Opposite, Turn::Left, Start::ArrivalGap { arrival_gap_s: -0.2 }, 6.0);
    turning.policy = Policy::AccelThenBrake {
        accel_mag: 0.3,
        accel_steps: 10,
        cruise_speed: 6.5,
        brake_step: 90,
        brake_steps: 20,
        speed_kp: None,
    };
    oncoming.partners.push(turning);

    let mut merging = alone(roundabout(2), Turn::Straight, 1, 7.0, 7.0);
    merging.ego.s_m = 35.0;
    merging.partners.push(steady(Approach::Ring, Turn::Straight, Start::ArrivalGap { arrival_gap_s: 0.0 }, 6.5));

    let mut sideswipe = alone(straight(3, 200.0), Turn::Straight, 1, 12.0, 12.0);
    let mut drifting = lead(4.0, 12.0);
    drifting.lane_offset = -1;
    drifting.lateral = vec![LateralMove { start_s: 2.0, duration_s: 2.5, to_t_m: 3.5 }];
    sideswipe.partners.push(drifting);
    for number in 0..12 {
        let s_m = 60.0 + 8.0 * f64::from(number);
        sideswipe.obstacles.push(Obstacle { kind: ObstacleKind::Cone, s_m, t_m: 5.6 });
    }
    sideswipe.obstacles.push(Obstacle { kind: ObstacleKind::Barrier, s_m: 160.0, t_m: 4.0 });
    sideswipe.obstacles.push(Obstacle { kind: ObstacleKind::Warning, s_m: 50.0, t_m: 4.5 });

    let mut same_exit = alone(
        MapSpec::T(TeeMap { lanes: 2, lane_width_m: 3.5, approach_m: 60.0, arm_m: 150.0, missing: MissingArm::Ahead }),
        Turn::Right,
        1,
        7.0,
        7.0,
    );
    same_exit.partners.push(steady(Approach::Left, Turn::Straight, Start::ArrivalGap { arrival_gap_s: 0.2 }, 7.0));

    let mut curve_lead = alone(curve(2, Side::Left), Turn::Straight, 0, 8.33, 8.33);
    let mut braking = lead(15.0, 8.0);
    braking.policy = Policy::SuddenBrake { target_speed: 8.0, brake_step: 60, brake_steps: 30, speed_kp: None };
    curve_lead.partners.push(braking);

    vec![
        named(crossing, "trial-x-crossing-from-left"),
        named(oncoming, "trial-x-left-turn-from-opposite"),
        named(merging, "trial-o-merge-into-ring"),
        named(sideswipe, "trial-s-sideswipe-with-cones"),
        named(same_exit, "trial-t-same-exit"),
        named(curve_lead, "trial-c-lead-brakes"),
    ]
}

/// A random draft over all maps, approaches, policies and obstacles; `None` where the draw is not fit to run.
pub fn random_draft(seed: u64, number: u32) -> Option<ScenarioDraft> {
    let mut rng = Seed(seed).child(&format!("draft {number}")).rng();
    let lanes = 1 + rng.below(3) as u8;
    let side = if rng.below(2) == 0 { Side::Left } else { Side::Right };
    let map = match rng.below(5) {
        0 => straight(lanes, 100.0 + 100.0 * rng.uniform()),
        1 => curve(lanes, side),
        2 => cross(lanes),
        3 => tee(lanes, [MissingArm::Right, MissingArm::Ahead, MissingArm::Left][rng.below(3)]),
        _ => roundabout(lanes),
    };
    let turns = [Turn::Straight, Turn::Left, Turn::Right];
    let turn = turns[rng.below(3)];
    let greatest = match (&map, turn) {
        (MapSpec::O(_), _) => 8.0,
        (MapSpec::X(_) | MapSpec::T(_), Turn::Straight) | (MapSpec::S(_) | MapSpec::C(_), _) => 14.0,
        _ => 9.0,
    };
    let speed = rng.range(4.0, greatest);
    let mut draft = alone(map, turn, rng.below(usize::from(lanes)) as u8, speed, speed);
    draft.id = format!("random-{seed}-{number}");
    draft.ego.s_m = rng.range(5.0, 20.0);
    for position in 0..1 + rng.below(2) {
        draft.partners.push(random_partner(&mut rng, position, greatest));
    }
    if rng.below(4) == 0 {
        for _ in 0..1 + rng.below(4) {
            let kind = [ObstacleKind::Cone, ObstacleKind::Barrier, ObstacleKind::Warning][rng.below(3)];
            draft.obstacles.push(Obstacle { kind, s_m: rng.range(30.0, 90.0), t_m: rng.range(-1.8, 1.8) });
        }
    }
    check(draft.clone()).ok().map(|_| draft)
}

fn random_partner(rng: &mut Rng, position: usize, greatest: f64) -> Partner {
    let approach = [Approach::Same, Approach::Opposite, Approach::Left, Approach::Right, Approach::Ring][rng.below(5)];
    let start = if rng.below(3) > 0 && approach != Approach::Same {
        Start::ArrivalGap { arrival_gap_s: rng.range(-2.0, 2.0) }
    } else {
        Start::Offset { delta_s_m: rng.range(-20.0, 60.0), delta_t_m: 0.0 }
    };
    let speed_mps = rng.range(3.0, greatest);
    let brake_step = 20 + rng.below(60) as u32;
    let brake_steps = rng.below(30) as u32;
    let policy = match rng.below(5) {
        0 => Policy::AccelThenBrake {
            accel_mag: rng.range(0.2, 1.0),
            accel_steps: rng.below(30) as u32,
            cruise_speed: speed_mps,
            brake_step,
            brake_steps,
            speed_kp: None,
        },
        1 => Policy::IdmNominal { target_speed_mps: speed_mps },
        2 => Policy::Stopped { depart_step: Some(brake_step), target_speed_mps: speed_mps },
        _ => Policy::SuddenBrake { target_speed: speed_mps, brake_step, brake_steps, speed_kp: None },
    };
    let lateral = if rng.below(4) == 0 {
        vec![LateralMove {
            start_s: rng.range(1.0, 4.0),
            duration_s: rng.range(1.5, 3.0),
            to_t_m: rng.range(-3.5, 3.5),
        }]
    } else {
        Vec::new()
    };
    let turn = [Turn::Straight, Turn::Left, Turn::Right][rng.below(3)];
    let lane_offset = [0, 0, -1, 1][rng.below(4)];
    let stopped = matches!(policy, Policy::Stopped { .. });
    Partner {
        id: format!("cp{}", position + 1),
        kind: PartnerKind::PassengerCar,
        approach,
        turn,
        lane_offset,
        start,
        speed_mps: if stopped { 0.0 } else { speed_mps },
        policy,
        lateral,
    }
}
