//! No draft, however wild, makes the check panic; and what it lets pass keeps its promises.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use recrash_model::geometry::OrientedBox;
use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Side;
use recrash_model::scenario::*;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{check, read_draft, write_draft};

/// Any number at all, often a special one.
fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -50.0..350.0_f64,
        1 => any::<f64>(),
        1 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 1e-320]),
    ]
}

fn side() -> impl Strategy<Value = Side> {
    prop::sample::select(vec![Side::Left, Side::Right])
}

fn turn() -> impl Strategy<Value = Turn> {
    prop::sample::select(vec![Turn::Straight, Turn::Left, Turn::Right])
}

fn approach() -> impl Strategy<Value = Approach> {
    use Approach::{Left, Opposite, Right, Ring, Same};
    prop::sample::select(vec![Same, Opposite, Left, Right, Ring])
}

fn kind() -> impl Strategy<Value = PartnerKind> {
    use PartnerKind::{Animal, Bus, Cyclist, FixedObject, HeavyTruck, PassengerCar, Pedestrian};
    prop::sample::select(vec![
        PassengerCar,
        PassengerCar,
        PassengerCar,
        HeavyTruck,
        Bus,
        Cyclist,
        Pedestrian,
        Animal,
        FixedObject,
    ])
}

fn map(number: fn(f64, f64) -> BoxedStrategy<f64>, lanes: BoxedStrategy<u8>) -> impl Strategy<Value = MapSpec> {
    let numbers = (lanes, number(2.5, 4.5), number(20.0, 300.0), number(20.0, 300.0));
    (
        0..5,
        numbers,
        (number(15.0, 200.0), number(10.0, 135.0), side()),
        (number(5.0, 15.0), number(15.0, 45.0)),
        0..3_usize,
    )
        .prop_map(
            |(which, (lanes, lane_width_m, approach_m, long), (radius_m, angle_deg, direction), (exit, inner), arm)| {
                let missing = [MissingArm::Right, MissingArm::Ahead, MissingArm::Left][arm];
                match which {
                    0 => MapSpec::S(StraightMap { lanes, lane_width_m, approach_m, length_m: long }),
                    1 => MapSpec::C(CurveMap {
                        lanes,
                        lane_width_m,
                        approach_m,
                        radius_m,
                        angle_deg,
                        direction,
                        length_m: long,
                    }),
                    2 => MapSpec::X(CrossMap { lanes, lane_width_m, approach_m, arm_m: long }),
                    3 => MapSpec::T(TeeMap { lanes, lane_width_m, approach_m, arm_m: long, missing }),
                    _ => MapSpec::O(RoundaboutMap {
                        lanes,
                        lane_width_m,
                        approach_m,
                        arm_m: long,
                        exit_radius_m: exit,
                        inner_radius_m: inner,
                    }),
                }
            },
        )
}

fn start(number: fn(f64, f64) -> BoxedStrategy<f64>) -> impl Strategy<Value = Start> {
    prop_oneof![
        (number(-40.0, 150.0), number(-2.0, 2.0))
            .prop_map(|(delta_s_m, delta_t_m)| Start::Offset { delta_s_m, delta_t_m }),
        number(-5.0, 5.0).prop_map(|arrival_gap_s| Start::ArrivalGap { arrival_gap_s }),
    ]
}

fn policy(number: fn(f64, f64) -> BoxedStrategy<f64>) -> impl Strategy<Value = Policy> {
    let speed = number(1.0, 14.0);
    prop_oneof![
        (speed.clone(), any::<u32>(), 0..200_u32, prop::option::of(number(0.1, 1.0))).prop_map(
            |(target_speed, brake_step, brake_steps, speed_kp)| Policy::SuddenBrake {
                target_speed,
                brake_step: brake_step % 20_000,
                brake_steps,
                speed_kp,
            }
        ),
        (number(-1.0, 1.0), 0..100_u32, speed.clone()).prop_map(|(accel_mag, accel_steps, cruise_speed)| {
            Policy::AccelThenBrake {
                accel_mag,
                accel_steps,
                cruise_speed,
                brake_step: 5,
                brake_steps: 5,
                speed_kp: None,
            }
        }),
        speed.clone().prop_map(|target_speed_mps| Policy::IdmNominal { target_speed_mps }),
        (prop::option::of(0..500_u32), speed.clone())
            .prop_map(|(depart_step, target_speed_mps)| Policy::Stopped { depart_step, target_speed_mps }),
        (speed, number(0.0, 5.0)).prop_map(|(target_speed_mps, gap_s)| Policy::Yielding { target_speed_mps, gap_s }),
    ]
}

fn partner(number: fn(f64, f64) -> BoxedStrategy<f64>) -> impl Strategy<Value = Partner> {
    let moves = prop::collection::vec(
        (number(0.0, 20.0), number(0.5, 4.0), number(-3.0, 3.0))
            .prop_map(|(start_s, duration_s, to_t_m)| LateralMove { start_s, duration_s, to_t_m }),
        0..3,
    );
    ("[a-z0-9]{1,6}", kind(), approach(), turn(), -1..2_i8, start(number), number(0.0, 12.0), policy(number), moves)
        .prop_map(|(id, kind, approach, turn, lane_offset, start, speed_mps, policy, lateral)| Partner {
            id,
            kind,
            approach,
            turn,
            lane_offset,
            start,
            speed_mps,
            policy,
            lateral,
        })
}

fn draft(number: fn(f64, f64) -> BoxedStrategy<f64>, lanes: BoxedStrategy<u8>) -> impl Strategy<Value = ScenarioDraft> {
    let ego = (turn(), 0..3_u8, number(0.0, 20.0), number(0.0, 10.0), number(2.0, 10.0)).prop_map(
        |(turn, lane, s_m, speed_mps, target_speed_mps)| EgoSpec {
            turn,
            lane,
            s_m,
            speed_mps,
            target_speed_mps,
            ..EgoSpec::default()
        },
    );
    let obstacles = prop::collection::vec(
        (number(25.0, 100.0), number(-6.0, 6.0)).prop_map(|(s_m, t_m)| Obstacle {
            kind: ObstacleKind::Barrier,
            s_m,
            t_m,
        }),
        0..4,
    );
    let partners = prop::collection::vec(partner(number), 0..4);
    (map(number, lanes), ego, partners, obstacles, number(1.0, 120.0), number(0.0, 1.0), "[a-z./]{0,9}").prop_map(
        |(map, ego, partners, obstacles, duration_s, density, id)| ScenarioDraft {
            format: SCENARIO_FORMAT.to_owned(),
            id,
            source: serde_json::from_value(serde_json::json!({})).expect("all fields have defaults"),
            map,
            ego,
            partners,
            obstacles,
            traffic: Traffic { density, seed: 1 },
            environment: Environment::default(),
            duration_s,
            ..ScenarioDraft::default()
        },
    )
}

fn wild_draft() -> impl Strategy<Value = ScenarioDraft> {
    draft(|_, _| wild().boxed(), prop_oneof![1..5_u8, any::<u8>()].boxed())
}

fn sane_draft() -> impl Strategy<Value = ScenarioDraft> {
    draft(|from, to| (from..=to).boxed(), (1..5_u8).boxed())
}

fn outline(placement: &recrash_roads::Placement) -> OrientedBox {
    let size = VehicleSpec::of(placement.kind);
    OrientedBox::new(placement.pose, size.length_m, size.width_m)
}

/// What every checked scenario promises to the simulator.
fn keeps_its_promises(scenario: &recrash_roads::Scenario) {
    let everyone: Vec<_> = std::iter::once(scenario.ego()).chain(scenario.partners()).collect();
    for (position, one) in everyone.iter().enumerate() {
        assert!(one.pose.position.x.is_finite() && one.pose.position.y.is_finite() && one.pose.heading.is_finite());
        assert!((0.0..=one.path.length_m).contains(&one.s_m));
        assert!(one.path.length_m.is_finite() && one.path.segments.iter().all(|each| each.length_m > 0.0));
        for other in &everyone[..position] {
            assert!(outline(one).gap(&outline(other)) >= 0.5);
        }
        if let Some(conflict) = one.conflict {
            assert!((0.0..=scenario.ego().path.length_m).contains(&conflict.s_a));
            assert!((0.0..=one.path.length_m).contains(&conflict.s_b));
        }
    }
    assert_eq!(scenario.partners().len(), scenario.draft().partners.len());
    assert_eq!(scenario.obstacles().len(), scenario.draft().obstacles.len());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_numbers_are_checked_without_a_panic(draft in wild_draft()) {
        match check(draft.clone()) {
            Ok(outcome) => keeps_its_promises(&outcome.value),
            Err(remarks) => prop_assert!(remarks.iter().any(recrash_model::Diagnostic::is_error)),
        }
        // Numbers that JSON lacks are written as null, which reading refuses.
        let _ = read_draft(&write_draft(&draft));
    }

    #[test]
    fn numbers_in_range_are_placed_or_refused(draft in sane_draft()) {
        if let Ok(outcome) = check(draft) {
            keeps_its_promises(&outcome.value);
        }
    }

    #[test]
    fn any_text_is_read_without_a_panic(text in "\\PC{0,200}", at in 0..900_usize) {
        let _ = read_draft(&text);
        let whole = include_str!("../drafts/crossing.json");
        let cut: String = whole.chars().take(at).chain(text.chars()).chain(whole.chars().skip(at)).collect();
        let _ = read_draft(&cut);
    }
}

#[test]
fn the_random_drafts_are_not_all_refused() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let accepted = (0..400)
        .filter(|_| {
            let mut drawn = sane_draft().new_tree(&mut runner).expect("a draft").current();
            drawn.id = "x".to_owned();
            drawn.partners.truncate(1);
            check(drawn).is_ok()
        })
        .count();
    assert!(accepted > 20, "only {accepted} of 400");
}
