//! Random checked scenarios over everything that scenario files can say.

use recrash_model::Seed;
use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Side;
use recrash_model::scenario::{
    Approach, CrossMap, CurveMap, EgoSpec, Environment, LateralMove, MapSpec, MissingArm, Obstacle, ObstacleKind,
    Partner, Policy, RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source, Start, StraightMap, TeeMap, Traffic, Turn,
};
use recrash_model::seed::Rng;
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{Scenario, check};

/// Draws until one passes the check. About one in four does; a thousand in a row that do not would be a fault.
const MOST_DRAWS: u32 = 1000;

/// Maps and policies come in turn, so that each is there as often as the others.
const MAPS: usize = 5;
const POLICIES: usize = 5;

/// Share of scenarios with something beside the partners on or beside the road, and with background traffic.
const WITH_OBSTACLES: f64 = 0.25;
const WITH_TRAFFIC: f64 = 0.1;

/// Share of cars among the partners; the other kinds share the rest.
const CARS: f64 = 0.5;

const OTHER_KINDS: [PartnerKind; 11] = [
    PartnerKind::Suv,
    PartnerKind::Van,
    PartnerKind::PickupTruck,
    PartnerKind::HeavyTruck,
    PartnerKind::Bus,
    PartnerKind::Motorcycle,
    PartnerKind::Cyclist,
    PartnerKind::Pedestrian,
    PartnerKind::OtherNonMotorist,
    PartnerKind::FirstResponder,
    PartnerKind::Animal,
];

const TURNS: [Turn; 3] = [Turn::Straight, Turn::Left, Turn::Right];

/// Scenario number `number` of a seed: the same whatever else is drawn.
///
/// # Panics
/// Never, in practice: where a thousand draws in a row fail the check.
pub fn random_scenario(seed: u64, number: usize) -> Scenario {
    let seed = Seed(seed).child(&format!("scenario {number}"));
    (0..MOST_DRAWS)
        .find_map(|draw| {
            let mut rng = seed.child(&format!("draw {draw}")).rng();
            check(random_draft(&mut rng, number)).ok()
        })
        .unwrap_or_else(|| unreachable!("one in four draws passes the check"))
        .value
}

fn random_draft(rng: &mut Rng, number: usize) -> ScenarioDraft {
    let map = random_map(rng, number % MAPS);
    let lanes = map.carriageway().lanes;
    let turn = one_of(rng, &TURNS);
    // What the check allows on each way, nearly (docs/models/roads.md).
    let fastest = match (&map, turn) {
        (MapSpec::O(_), _) => 8.0,
        (MapSpec::S(_), _) | (MapSpec::X(_) | MapSpec::T(_), Turn::Straight) => 15.0,
        (MapSpec::C(_), _) => 12.0,
        _ => 9.5,
    };
    let target_speed_mps = rng.range(4.0, fastest);
    let speed_mps = if rng.uniform() < 0.7 { target_speed_mps } else { rng.range(0.0, target_speed_mps) };
    let ego = EgoSpec {
        turn,
        lane: rng.below(usize::from(lanes)) as u8,
        s_m: rng.range(5.0, 20.0),
        speed_mps,
        target_speed_mps,
        ..EgoSpec::default()
    };
    let partners = 1 + usize::from(rng.uniform() < 0.3);
    let partners = (0..partners)
        .map(|position| {
            let policy = if position == 0 { number / MAPS % POLICIES } else { rng.below(POLICIES) };
            random_partner(rng, position, policy, fastest)
        })
        .collect();
    let obstacles = if rng.uniform() < WITH_OBSTACLES { 1 + rng.below(4) } else { 0 };
    let obstacles = (0..obstacles).map(|_| random_obstacle(rng)).collect();
    let density = if rng.uniform() < WITH_TRAFFIC { rng.range(0.05, 0.3) } else { 0.0 };
    let surface = match rng.uniform() {
        draw if draw < 0.85 => Surface::Dry,
        draw if draw < 0.95 => Surface::Wet,
        _ => Surface::SnowIce,
    };
    ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: format!("random-{number:04}"),
        source: Source::default(),
        map,
        ego,
        partners,
        obstacles,
        traffic: Traffic { density, seed: rng.next_u64() >> 32 },
        environment: Environment { surface, ..Environment::default() },
        duration_s: 40.0,
        ..ScenarioDraft::default()
    }
}

fn random_map(rng: &mut Rng, which: usize) -> MapSpec {
    let (lanes, lane_width_m) = (1 + rng.below(3) as u8, if rng.below(2) == 0 { 3.5 } else { rng.range(3.0, 3.8) });
    let (approach_m, arm_m) = (rng.range(40.0, 90.0), rng.range(50.0, 140.0));
    match which {
        0 => MapSpec::S(StraightMap { lanes, lane_width_m, approach_m, length_m: rng.range(80.0, 250.0) }),
        1 => MapSpec::C(CurveMap {
            lanes,
            lane_width_m,
            approach_m,
            radius_m: rng.range(30.0, 80.0),
            angle_deg: rng.range(30.0, 120.0),
            direction: if rng.below(2) == 0 { Side::Left } else { Side::Right },
            length_m: rng.range(40.0, 100.0),
        }),
        2 => MapSpec::X(CrossMap { lanes, lane_width_m, approach_m, arm_m }),
        3 => {
            let missing = one_of(rng, &[MissingArm::Right, MissingArm::Ahead, MissingArm::Left]);
            MapSpec::T(TeeMap { lanes, lane_width_m, approach_m, arm_m, missing })
        }
        _ => MapSpec::O(RoundaboutMap {
            lanes,
            lane_width_m,
            approach_m,
            arm_m,
            exit_radius_m: rng.range(8.0, 15.0),
            inner_radius_m: rng.range(20.0, 40.0),
        }),
    }
}

fn random_partner(rng: &mut Rng, position: usize, policy: usize, fastest: f64) -> Partner {
    let kind = if rng.uniform() < CARS { PartnerKind::PassengerCar } else { one_of(rng, &OTHER_KINDS) };
    let approach = one_of(rng, &[Approach::Same, Approach::Opposite, Approach::Left, Approach::Right, Approach::Ring]);
    let start = if approach != Approach::Same && rng.uniform() < 0.75 {
        Start::ArrivalGap { arrival_gap_s: rng.range(-2.0, 2.0) }
    } else {
        Start::Offset { delta_s_m: rng.range(-25.0, 60.0), delta_t_m: 0.0 }
    };
    let fastest = fastest.min(0.95 * VehicleSpec::of(kind).max_speed_mps);
    let speed_mps = rng.range(0.3 * fastest, fastest);
    let (brake_step, brake_steps) = (20 + rng.below(60) as u32, rng.below(30) as u32);
    let speed_kp = (rng.below(4) == 0).then(|| rng.range(0.1, 0.6));
    let policy = match policy {
        0 => Policy::SuddenBrake { target_speed: speed_mps, brake_step, brake_steps, speed_kp },
        1 => Policy::AccelThenBrake {
            accel_mag: rng.range(0.2, 1.0),
            accel_steps: rng.below(30) as u32,
            cruise_speed: speed_mps,
            brake_step,
            brake_steps,
            speed_kp,
        },
        2 => Policy::IdmNominal { target_speed_mps: speed_mps },
        3 => {
            let depart_step = (rng.uniform() < 0.7).then_some(brake_step);
            Policy::Stopped { depart_step, target_speed_mps: if depart_step.is_some() { speed_mps } else { 0.0 } }
        }
        _ => Policy::Yielding { target_speed_mps: speed_mps, gap_s: rng.range(0.5, 3.0) },
    };
    let lateral = if rng.uniform() < 0.25 {
        let duration_s = rng.range(1.5, 3.0);
        vec![LateralMove { start_s: rng.range(0.5, 4.0), duration_s, to_t_m: rng.range(-3.5, 3.5) }]
    } else {
        Vec::new()
    };
    Partner {
        id: format!("cp{}", position + 1),
        kind,
        approach,
        turn: one_of(rng, &TURNS),
        lane_offset: one_of(rng, &[0, 0, -1, 1]),
        start,
        speed_mps: if matches!(policy, Policy::Stopped { .. }) { 0.0 } else { speed_mps },
        policy,
        lateral,
    }
}

fn random_obstacle(rng: &mut Rng) -> Obstacle {
    let kind = one_of(rng, &[ObstacleKind::Cone, ObstacleKind::Barrier, ObstacleKind::Warning]);
    Obstacle { kind, s_m: rng.range(30.0, 100.0), t_m: rng.range(-2.0, 2.0) }
}

fn one_of<T: Copy>(rng: &mut Rng, items: &[T]) -> T {
    items[rng.below(items.len())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_scenario_depends_on_its_seed_and_number_alone() {
        assert_eq!(random_scenario(7, 3), random_scenario(7, 3));
        assert_ne!(random_scenario(7, 3).draft(), random_scenario(8, 3).draft());
        assert_ne!(random_scenario(7, 3).draft(), random_scenario(7, 8).draft());
    }

    #[test]
    fn two_hundred_hold_every_map_turn_approach_policy_kind_and_obstacle() {
        let mut seen: BTreeSet<String> = BTreeSet::new();
        for number in 0..200 {
            let scenario = random_scenario(1, number);
            let draft = scenario.draft();
            seen.insert(draft.map.letter().to_string());
            seen.insert(format!("ego {:?}", draft.ego.turn));
            seen.extend(draft.partners.iter().map(|partner| format!("{:?}", partner.approach)));
            seen.extend(draft.partners.iter().map(|partner| format!("{:?}", partner.kind)));
            seen.insert(crate::parity::compare::policy_name(&draft.partners[0].policy).to_owned());
            seen.extend(draft.obstacles.iter().map(|obstacle| format!("{:?}", obstacle.kind)));
            seen.insert(format!("{:?}", draft.environment.surface));
            seen.insert(if draft.traffic.density > 0.0 { "traffic" } else { "no traffic" }.to_owned());
        }
        // Maps, turns, approaches, kinds, policies, obstacles, surfaces, traffic or none.
        assert_eq!(seen.len(), 5 + 3 + 5 + 12 + 5 + 3 + 3 + 2, "{seen:?}");
    }
}
