//! Each check of faithfulness, passed and failed by paths driven.

use crate::world::*;
use recrash_metrics::faithfulness_on;
use recrash_model::math::{FRAC_PI_2, PI};
use recrash_model::metrics::{Answer, CheckKind, CheckResult, CollisionKind, Expectation, Verdict};
use recrash_model::narrative::{FirstMover, Side};
use recrash_model::rollout::{ActorState, Role, Rollout};
use recrash_model::scenario::{Approach, MissingArm, Turn};
use recrash_model::template::{Movement, RoadType, Template};
use recrash_model::zones::ContactZone;
use recrash_roads::RoadNetwork;

fn expecting(road: RoadType, sv: Movement, cp: Movement) -> Expectation {
    Expectation {
        template: Template { road, sv, cp, work_zone: false },
        approach: None,
        side: None,
        order: None,
        sv_speed_mps: None,
        cp_speed_mps: None,
        sv_zones: Vec::new(),
        cp_zones: Vec::new(),
        excluded: Vec::new(),
        obstacles_named: false,
    }
}

fn verdict(network: &RoadNetwork, rollout: &Rollout, expectation: &Expectation) -> Verdict {
    let way = path(network, Approach::Same, Turn::Straight, 1);
    let metrics = measure(network, &way, 10.0, rollout);
    faithfulness_on(network, rollout, &metrics, expectation)
}

fn result(verdict: &Verdict, kind: CheckKind) -> CheckResult {
    let check = verdict.checks.iter().find(|check| check.kind == kind).expect("every kind is checked");
    check.result
}

fn observed(verdict: &Verdict, kind: CheckKind) -> &str {
    &verdict.checks.iter().find(|check| check.kind == kind).unwrap().observed
}

/// Two that would be at the place where their paths cross (or merge) at 6 s, cut short where they touch.
fn meeting(network: &RoadNetwork, ego: (Turn, u8), other: (Approach, Turn, u8), speed: f64, late_s: f64) -> Rollout {
    let way = path(network, Approach::Same, ego.0, ego.1);
    let other_way = path(network, other.0, other.1, other.2);
    let conflict = way.conflict(&other_way, WIDTH_M, WIDTH_M).expect("the paths meet");
    let start = |s: f64, at_s: f64| s - speed * at_s;
    rollout(
        drive(&way, start(conflict.s_a, 6.0), 140, |_| speed),
        vec![drive(&other_way, start(conflict.s_b, 6.0 + late_s), 140, |_| speed)],
    )
}

#[test]
fn a_crossing_at_an_intersection_passes_every_check() {
    let network = cross();
    let rollout = meeting(&network, (Turn::Straight, 1), (Approach::Left, Turn::Straight, 1), 8.0, 0.2);
    let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
    expectation.approach = Some(Approach::Left);
    expectation.sv_zones = vec![ContactZone::FrontLeft];
    expectation.cp_zones = vec![ContactZone::Front];
    expectation.excluded = vec![CollisionKind::RearEndByEgo, CollisionKind::RearEndOfEgo, CollisionKind::HeadOn];
    expectation.order = Some(FirstMover::Sv);
    (expectation.sv_speed_mps, expectation.cp_speed_mps) = (Some(8.0), Some(7.0));
    let verdict = verdict(&network, &rollout, &expectation);
    assert_eq!(verdict.faithful(), Answer::Yes, "{verdict:#?}");
    assert!(verdict.checks.iter().all(|check| check.result == CheckResult::Shown), "{verdict:#?}");
}

#[test]
fn movements_are_read_from_the_path_driven_not_from_its_end_alone() {
    use Movement::{LeftTurn, RightTurn, Straight};
    let network = cross();
    let cases = [
        // Driven to the end, past one that comes 4 s later.
        (Turn::Straight, 8.0, 4.0, Straight),
        (Turn::Left, 8.0, 4.0, LeftTurn),
        (Turn::Right, 6.0, 4.0, RightTurn),
        // Cut short by the contact in the junction.
        (Turn::Straight, 8.0, 0.0, Straight),
        (Turn::Left, 8.0, 0.0, LeftTurn),
        (Turn::Right, 6.0, 0.0, RightTurn),
    ];
    for (turn, speed, late_s, shown) in cases {
        // From the left straight through crosses or merges with all three.
        let rollout = meeting(&network, (turn, 1), (Approach::Left, Turn::Straight, 1), speed, late_s);
        for expected in [Straight, LeftTurn, RightTurn] {
            let verdict = verdict(&network, &rollout, &expecting(RoadType::Intersection, expected, Straight));
            let wanted = if expected == shown { CheckResult::Shown } else { CheckResult::NotShown };
            let text = observed(&verdict, CheckKind::SvMovement);
            assert_eq!(result(&verdict, CheckKind::SvMovement), wanted, "{turn:?} late {late_s}: {text}");
            assert_eq!(result(&verdict, CheckKind::CpMovement), CheckResult::Shown);
        }
    }
}

#[test]
fn the_partners_movement_is_read_from_its_path_for_every_way_through_a_junction() {
    use Movement::{LeftTurn, RightTurn, Straight};
    for (network, approaches) in [
        (cross(), vec![Approach::Left, Approach::Right, Approach::Opposite]),
        (tee(MissingArm::Right), vec![Approach::Left, Approach::Opposite]),
        (tee(MissingArm::Left), vec![Approach::Right, Approach::Opposite]),
    ] {
        let ego_way = path(&network, Approach::Same, Turn::Straight, 1);
        for approach in approaches {
            for (turn, shown) in [(Turn::Straight, Straight), (Turn::Left, LeftTurn), (Turn::Right, RightTurn)] {
                let Some(roads) = network.route(approach, turn) else { continue };
                let way = recrash_roads::LanePath::new(&network, roads, 1);
                // The ego stays far behind.
                let ego = drive(&ego_way, 5.0, 110, |_| 1.0);
                let rollout = rollout(ego, vec![drive(&way, 20.0, 110, |_| 8.0)]);
                for expected in [Straight, LeftTurn, RightTurn] {
                    let mut expectation = expecting(RoadType::Intersection, Straight, expected);
                    expectation.approach = Some(approach);
                    let verdict = verdict(&network, &rollout, &expectation);
                    let wanted = if expected == shown { CheckResult::Shown } else { CheckResult::NotShown };
                    let text = observed(&verdict, CheckKind::CpMovement);
                    assert_eq!(result(&verdict, CheckKind::CpMovement), wanted, "{approach:?} {turn:?}: {text}");
                    assert_eq!(result(&verdict, CheckKind::Approach), CheckResult::Shown, "{approach:?}");
                }
            }
        }
    }
}

#[test]
fn a_turn_not_yet_begun_is_not_shown() {
    let network = cross();
    let way = path(&network, Approach::Same, Turn::Left, 1);
    // Stops 10 m before the junction (60 m).
    let ego = drive(&way, 5.0, 60, |time| (9.0 - 9.0 * time / 10.0).max(0.0));
    let rollout = rollout(ego, vec![glide(55.0, 3.5, 0.0, 1.0, 60)]);
    let verdict =
        verdict(&network, &rollout, &expecting(RoadType::Intersection, Movement::LeftTurn, Movement::Straight));
    assert_eq!(result(&verdict, CheckKind::SvMovement), CheckResult::NotShown);
}

#[test]
fn standing_is_not_going_straight() {
    let network = cross();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let rollout = rollout(drive(&way, 20.0, 60, |_| 8.0), vec![glide(70.0, 20.0, -FRAC_PI_2, 0.0, 60)]);
    let straight = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
    assert_eq!(result(&verdict(&network, &rollout, &straight), CheckKind::CpMovement), CheckResult::NotShown);
    let stopped = expecting(RoadType::Intersection, Movement::Straight, Movement::Stopped);
    assert_eq!(result(&verdict(&network, &rollout, &stopped), CheckKind::CpMovement), CheckResult::Shown);
}

#[test]
fn following_a_curve_is_going_straight() {
    for direction in [Side::Left, Side::Right] {
        let network = curve(direction);
        let way = path(&network, Approach::Same, Turn::Straight, 1);
        let oncoming = path(&network, Approach::Opposite, Turn::Straight, 1);
        for partner in [drive(&way, 30.0, 120, |_| 9.0), drive(&oncoming, 5.0, 120, |_| 9.0)] {
            let rollout = rollout(drive(&way, 5.0, 120, |_| 10.0), vec![partner]);
            let straight = expecting(RoadType::Highway, Movement::Straight, Movement::Straight);
            let shown = verdict(&network, &rollout, &straight);
            assert_eq!(result(&shown, CheckKind::SvMovement), CheckResult::Shown, "{shown:#?}");
            assert_eq!(result(&shown, CheckKind::CpMovement), CheckResult::Shown, "{shown:#?}");
            let turns = expecting(RoadType::Highway, Movement::LeftTurn, Movement::RightTurn);
            let not_shown = verdict(&network, &rollout, &turns);
            assert_eq!(result(&not_shown, CheckKind::SvMovement), CheckResult::NotShown, "{not_shown:#?}");
            assert_eq!(result(&not_shown, CheckKind::CpMovement), CheckResult::NotShown, "{not_shown:#?}");
        }
    }
}

#[test]
fn on_a_highway_a_move_into_the_next_lane_shows_the_turn_to_that_side() {
    let network = straight();
    let cut_in = |time: f64| 3.5 - 3.5 * ((time - 1.0) / 3.0).clamp(0.0, 1.0);
    let left_way = path(&network, Approach::Same, Turn::Straight, 0);
    let ego = drive(&left_way, 5.0, 60, |_| 14.0);
    let rollout = rollout(ego, vec![drive_at(&left_way, 22.0, 60, |_| 14.0, cut_in)]);
    for (movement, wanted) in [
        (Movement::LeftTurn, CheckResult::Shown),
        (Movement::RightTurn, CheckResult::NotShown),
        (Movement::ChangingLanes, CheckResult::Shown),
        (Movement::Straight, CheckResult::Shown),
    ] {
        let expectation = expecting(RoadType::Highway, Movement::Straight, movement);
        let verdict = verdict(&network, &rollout, &expectation);
        assert_eq!(result(&verdict, CheckKind::CpMovement), wanted, "{movement:?}: {verdict:#?}");
    }
}

#[test]
fn on_a_roundabout_the_way_around_counts() {
    use Movement::{LeftTurn, RightTurn, Straight};
    let network = circle();
    let far = || glide(-500.0, 0.0, 0.0, 1.0, 400);
    for (turn, shown) in [(Turn::Right, RightTurn), (Turn::Straight, Straight), (Turn::Left, LeftTurn)] {
        let way = path(&network, Approach::Same, turn, 1);
        // All the way out, and beyond the end of the map.
        let steps = ((way.length_m + 5.0) / 0.8) as usize;
        let rollout = rollout(drive(&way, 5.0, steps, |_| 8.0), vec![far()]);
        for expected in [Straight, LeftTurn, RightTurn] {
            let verdict = verdict(&network, &rollout, &expecting(RoadType::TrafficCircle, expected, Straight));
            let wanted = if expected == shown { CheckResult::Shown } else { CheckResult::NotShown };
            assert_eq!(result(&verdict, CheckKind::SvMovement), wanted, "{turn:?} {expected:?}: {verdict:#?}");
        }
    }
}

#[test]
fn on_the_ring_a_left_turn_is_shown_until_it_leaves_and_straight_until_the_second_exit() {
    use Movement::{LeftTurn, RightTurn, Straight};
    let network = circle();
    let way = path(&network, Approach::Same, Turn::Left, 0);
    let on_ring = way
        .segments
        .iter()
        .find(|segment| network.road(network.lane(segment.lane).road).part == recrash_roads::RoadPart::Ring);
    let joined = on_ring.unwrap().start_m;
    for (driven_m, wanted) in [
        (
            joined - 25.0,
            [(Straight, CheckResult::NotShown), (LeftTurn, CheckResult::NotShown), (RightTurn, CheckResult::NotShown)],
        ),
        (
            joined - 9.0,
            [(Straight, CheckResult::Shown), (LeftTurn, CheckResult::NotShown), (RightTurn, CheckResult::NotShown)],
        ),
        (
            joined + 10.0,
            [(Straight, CheckResult::Shown), (LeftTurn, CheckResult::Shown), (RightTurn, CheckResult::NotShown)],
        ),
        (
            joined + 100.0,
            [(Straight, CheckResult::NotShown), (LeftTurn, CheckResult::Shown), (RightTurn, CheckResult::NotShown)],
        ),
    ] {
        let steps = ((driven_m - 5.0) / 0.8) as usize;
        let far = glide(-500.0, 0.0, 0.0, 1.0, 400);
        let rollout = rollout(drive(&way, 5.0, steps, |_| 8.0), vec![far]);
        for (expected, wanted) in wanted {
            let verdict = verdict(&network, &rollout, &expecting(RoadType::TrafficCircle, expected, Straight));
            assert_eq!(result(&verdict, CheckKind::SvMovement), wanted, "{driven_m} {expected:?}: {verdict:#?}");
        }
    }
}

#[test]
fn who_starts_on_the_ring_turns_as_seen_from_the_egos_entry() {
    use Movement::{LeftTurn, RightTurn, Straight};
    let network = circle();
    for (turn, shown) in [(Turn::Right, RightTurn), (Turn::Straight, Straight), (Turn::Left, LeftTurn)] {
        let way = path(&network, Approach::Ring, turn, 1);
        let steps = ((way.length_m - 10.0) / 0.8) as usize;
        let ego = drive(&path(&network, Approach::Same, Turn::Straight, 1), 5.0, steps, |_| 0.2);
        let rollout = rollout(ego, vec![drive(&way, 5.0, steps, |_| 8.0)]);
        for expected in [Straight, LeftTurn, RightTurn] {
            let verdict = verdict(&network, &rollout, &expecting(RoadType::TrafficCircle, Straight, expected));
            let wanted = if expected == shown { CheckResult::Shown } else { CheckResult::NotShown };
            assert_eq!(result(&verdict, CheckKind::CpMovement), wanted, "{turn:?} {expected:?}: {verdict:#?}");
        }
    }
}

#[test]
fn two_side_by_side_on_the_ring_both_turn_left() {
    let network = circle();
    let way = path(&network, Approach::Same, Turn::Left, 0);
    let outer = path(&network, Approach::Ring, Turn::Left, 1);
    let ego = drive(&way, 40.0, 90, |_| 7.0);
    let partner = drive(&outer, 20.0, 90, |_| 7.0);
    let rollout = rollout(ego, vec![partner]);
    let mut expectation = expecting(RoadType::TrafficCircle, Movement::LeftTurn, Movement::LeftTurn);
    expectation.approach = Some(Approach::Ring);
    let shown = verdict(&network, &rollout, &expectation);
    for kind in [CheckKind::Road, CheckKind::SvMovement, CheckKind::CpMovement, CheckKind::Approach] {
        assert_eq!(result(&shown, kind), CheckResult::Shown, "{shown:#?}");
    }
    expectation.approach = Some(Approach::Left);
    assert_eq!(result(&verdict(&network, &rollout, &expectation), CheckKind::Approach), CheckResult::NotShown);
}

#[test]
fn the_road_is_where_the_encounter_was() {
    let cross = cross();
    let at_junction = meeting(&cross, (Turn::Straight, 1), (Approach::Left, Turn::Straight, 1), 8.0, 0.2);
    let way = path(&cross, Approach::Same, Turn::Straight, 1);
    // Overtaken at the beginning of the approach, 55 m before the junction.
    let before = rollout(drive(&way, 5.0, 40, |_| 1.0), vec![drive_at(&way, 0.0, 40, |_| 5.0, |_| -3.5)]);
    let straight = straight();
    let plain_way = path(&straight, Approach::Same, Turn::Straight, 1);
    let plain = rollout(drive(&plain_way, 5.0, 40, |_| 10.0), vec![drive_at(&plain_way, 0.0, 40, |_| 14.0, |_| -3.5)]);
    let circle = circle();
    let ring_way = path(&circle, Approach::Same, Turn::Left, 1);
    let ring = rollout(drive(&ring_way, 40.0, 80, |_| 7.0), vec![drive(&ring_way, 55.0, 80, |_| 6.0)]);
    use RoadType::{Highway, Intersection, ParkingLot, Street, TrafficCircle};
    for (network, rollout, pass, fail) in [
        (&cross, &at_junction, vec![Intersection], vec![Highway, Street, TrafficCircle, ParkingLot]),
        (&cross, &before, vec![Highway, Street], vec![Intersection, TrafficCircle]),
        (&straight, &plain, vec![Highway, Street], vec![Intersection, TrafficCircle, ParkingLot]),
        (&circle, &ring, vec![TrafficCircle], vec![Intersection, Highway, Street]),
    ] {
        for (roads, wanted) in [(pass, CheckResult::Shown), (fail, CheckResult::NotShown)] {
            for road in roads {
                let expectation = expecting(road, Movement::Straight, Movement::Straight);
                let verdict = verdict(network, rollout, &expectation);
                assert_eq!(result(&verdict, CheckKind::Road), wanted, "{road:?} {verdict:#?}");
            }
        }
    }
    // Somebody turns off the highway: at a junction.
    let turning = expecting(Highway, Movement::Straight, Movement::LeftTurn);
    assert_eq!(result(&verdict(&cross, &at_junction, &turning), CheckKind::Road), CheckResult::Shown);
}

#[test]
fn obstacles_are_there_where_and_only_where_they_belong() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let mut rollout = rollout(drive(&way, 5.0, 60, |_| 10.0), vec![drive(&way, 45.0, 60, |_| 9.0)]);
    let mut expectation = expecting(RoadType::Highway, Movement::Straight, Movement::Straight);
    let check = |rollout: &Rollout, expectation: &Expectation| {
        result(&verdict(&network, rollout, expectation), CheckKind::WorkZone)
    };
    assert_eq!(check(&rollout, &expectation), CheckResult::Shown);
    expectation.template.work_zone = true;
    assert_eq!(check(&rollout, &expectation), CheckResult::NotShown);
    rollout.obstacles = vec![cone(500.0, 0.0)];
    assert_eq!(check(&rollout, &expectation), CheckResult::NotShown, "far from the way");
    rollout.obstacles = vec![cone(50.0, -1.75)];
    assert_eq!(check(&rollout, &expectation), CheckResult::Shown);
    expectation.template.work_zone = false;
    assert_eq!(check(&rollout, &expectation), CheckResult::NotShown);
    expectation.obstacles_named = true;
    assert_eq!(check(&rollout, &expectation), CheckResult::Shown);
}

#[test]
fn the_approach_is_where_the_partner_starts_and_heads() {
    use Approach::{Left, Opposite, Right, Ring, Same};
    let network = cross();
    let ego_way = path(&network, Same, Turn::Straight, 1);
    for approach in [Same, Opposite, Left, Right] {
        let way = path(&network, approach, Turn::Straight, 0);
        let rollout = rollout(drive(&ego_way, 5.0, 30, |_| 5.0), vec![drive(&way, 20.0, 30, |_| 5.0)]);
        for stated in [Same, Opposite, Left, Right, Ring] {
            let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
            expectation.approach = Some(stated);
            let wanted = if stated == approach { CheckResult::Shown } else { CheckResult::NotShown };
            assert_eq!(result(&verdict(&network, &rollout, &expectation), CheckKind::Approach), wanted, "{stated:?}");
        }
        let silent = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
        assert_eq!(result(&verdict(&network, &rollout, &silent), CheckKind::Approach), CheckResult::NotTold);
    }
    // On a curve the oncoming one starts at a right angle to the ego.
    let network = curve(Side::Left);
    let ego_way = path(&network, Same, Turn::Straight, 1);
    let rollout = rollout(
        drive(&ego_way, 5.0, 30, |_| 5.0),
        vec![drive(&path(&network, Opposite, Turn::Straight, 0), 5.0, 30, |_| 5.0)],
    );
    let mut expectation = expecting(RoadType::Highway, Movement::Straight, Movement::Straight);
    expectation.approach = Some(Opposite);
    assert_eq!(result(&verdict(&network, &rollout, &expectation), CheckKind::Approach), CheckResult::Shown);
}

#[test]
fn the_order_is_that_of_the_arrivals_where_the_paths_cross() {
    let network = cross();
    // The partner would be 1.2 s later at the crossing, or earlier; without contact 4 s.
    let check = |late_s: f64, told: FirstMover| {
        let rollout = meeting(&network, (Turn::Straight, 1), (Approach::Left, Turn::Straight, 1), 8.0, late_s);
        let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
        expectation.order = Some(told);
        result(&verdict(&network, &rollout, &expectation), CheckKind::Order)
    };
    use FirstMover::{Both, Cp, Sv};
    for late_s in [0.6, 1.2, 4.0] {
        assert_eq!(check(late_s, Sv), CheckResult::Shown, "{late_s}");
        assert_eq!(check(-late_s, Cp), CheckResult::Shown, "{late_s}");
        assert_eq!(check(late_s, Cp), CheckResult::NotShown, "{late_s}");
        assert_eq!(check(-late_s, Sv), CheckResult::NotShown, "{late_s}");
    }
    assert_eq!(check(0.2, Both), CheckResult::Shown);
    assert_eq!(check(4.0, Both), CheckResult::NotShown);
    // Side by side there is no crossing, so an order that is told is not shown.
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let beside = rollout(drive(&way, 5.0, 60, |_| 5.0), vec![drive_at(&way, 9.0, 60, |_| 5.0, |_| -3.5)]);
    let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
    expectation.order = Some(Sv);
    assert_eq!(result(&verdict(&network, &beside, &expectation), CheckKind::Order), CheckResult::NotShown);
}

#[test]
fn told_speeds_are_driven_within_a_tolerance() {
    let network = cross();
    let rollout = meeting(&network, (Turn::Straight, 1), (Approach::Left, Turn::Straight, 1), 10.0, 0.2);
    let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
    for (told, wanted) in [
        (10.0, CheckResult::Shown),
        // 10 m/s are 40 % more than 7.2 m/s and 38 % less than 16 m/s.
        (7.2, CheckResult::Shown),
        (16.0, CheckResult::Shown),
        (6.0, CheckResult::NotShown),
        (18.0, CheckResult::NotShown),
    ] {
        (expectation.sv_speed_mps, expectation.cp_speed_mps) = (Some(told), None);
        let ego = verdict(&network, &rollout, &expectation);
        assert_eq!(result(&ego, CheckKind::SvSpeed), wanted, "{told}");
        assert_eq!(result(&ego, CheckKind::CpSpeed), CheckResult::NotTold);
        (expectation.sv_speed_mps, expectation.cp_speed_mps) = (None, Some(told));
        assert_eq!(result(&verdict(&network, &rollout, &expectation), CheckKind::CpSpeed), wanted, "{told}");
    }
}

#[test]
fn a_partner_beside_the_ego_is_on_the_side_that_is_told() {
    for network in [straight(), cross(), curve(Side::Left)] {
        let way = path(&network, Approach::Same, Turn::Straight, 0);
        let on_right = rollout(drive(&way, 5.0, 40, |_| 8.0), vec![drive_at(&way, 12.0, 40, |_| 8.0, |_| 3.5)]);
        let check = |side: Option<Side>| {
            let mut expectation = expecting(RoadType::Highway, Movement::Straight, Movement::Straight);
            (expectation.approach, expectation.side) = (Some(Approach::Same), side);
            result(&verdict(&network, &on_right, &expectation), CheckKind::Approach)
        };
        assert_eq!(check(Some(Side::Right)), CheckResult::Shown);
        assert_eq!(check(Some(Side::Left)), CheckResult::NotShown);
        assert_eq!(check(None), CheckResult::Shown);
    }
}

#[test]
fn no_cone_belongs_in_the_junction() {
    let network = cross();
    let mut rollout = meeting(&network, (Turn::Straight, 1), (Approach::Left, Turn::Straight, 1), 8.0, 0.2);
    let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
    expectation.template.work_zone = true;
    let check = |rollout: &Rollout| result(&verdict(&network, rollout, &expectation), CheckKind::WorkZone);
    rollout.obstacles = vec![cone(50.0, -1.75)];
    assert_eq!(check(&rollout), CheckResult::Shown);
    rollout.obstacles.push(cone(70.0, 0.0));
    assert_eq!(check(&rollout), CheckResult::NotShown);
}

#[test]
fn the_encounter_is_with_the_partner() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let expectation = expecting(RoadType::Highway, Movement::Straight, Movement::Straight);
    let check = |rollout: &Rollout| result(&verdict(&network, rollout, &expectation), CheckKind::Encounter);
    let ego = |speed: f64| drive(&way, 5.0, 60, |_| speed);
    let ahead = |s: f64, speed: f64| drive(&way, s, 60, |_| speed);
    assert_eq!(check(&rollout(ego(10.0), vec![ahead(30.0, 8.0)])), CheckResult::Shown);
    assert_eq!(check(&rollout(ego(10.0), vec![ahead(200.0, 8.0)])), CheckResult::NotShown, "never close");
    assert_eq!(check(&rollout(ego(10.0), vec![ahead(14.0, 12.0)])), CheckResult::NotShown, "closest at the start");
    assert_eq!(check(&rollout(ego(10.0), vec![])), CheckResult::NotShown, "nobody there");
    // Contact with the partner, and contact with somebody else.
    let mut both = rollout(ego(12.0), vec![ahead(30.0, 8.0), ahead(60.0, 11.0)]);
    assert_eq!(check(&both), CheckResult::Shown);
    both.actors[1].role = Role::Traffic;
    assert_eq!(check(&both), CheckResult::NotShown, "the contact was with traffic");
    // Traffic came closer without contact.
    let mut near = rollout(ego(10.0), vec![ahead(30.0, 8.0), ahead(16.0, 9.8)]);
    assert_eq!(check(&near), CheckResult::Shown);
    near.actors[2].role = Role::Traffic;
    assert_eq!(check(&near), CheckResult::NotShown);
}

#[test]
fn contact_zones_agree_within_one_step_around_the_box() {
    use ContactZone::{Front, FrontLeft, Left, Rear, Right, Top};
    let network = cross();
    let ego = || drive(&path(&network, Approach::Same, Turn::Straight, 1), 30.0, 90, |_| 8.0);
    let reach = 0.5 * (LENGTH_M + WIDTH_M);
    // Into the middle of the ego's left side at 5 s; then one that passes 1 m behind; then one far behind.
    let hit = rollout(ego(), vec![glide(70.0, reach - 0.1 + 25.0, -FRAC_PI_2, 5.0, 90)]);
    let near = rollout(ego(), vec![glide(70.0, reach + 8.0 * 5.6, -FRAC_PI_2, 8.0, 90)]);
    let far = rollout(ego(), vec![glide(70.0, reach + 8.0 * 8.0, -FRAC_PI_2, 8.0, 90)]);
    let check = |rollout: &Rollout, sv: &[ContactZone], cp: &[ContactZone]| {
        let mut expectation = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
        (expectation.sv_zones, expectation.cp_zones) = (sv.to_vec(), cp.to_vec());
        result(&verdict(&network, rollout, &expectation), CheckKind::ContactZones)
    };
    assert_eq!(check(&hit, &[Left], &[Front]), CheckResult::Shown);
    assert_eq!(check(&hit, &[FrontLeft], &[FrontLeft]), CheckResult::Shown);
    assert_eq!(check(&hit, &[Right, Left], &[Front]), CheckResult::Shown, "any of the record's zones");
    assert_eq!(check(&hit, &[Right], &[Front]), CheckResult::NotShown);
    assert_eq!(check(&hit, &[Left], &[Rear]), CheckResult::NotShown);
    assert_eq!(check(&hit, &[Left], &[]), CheckResult::Shown);
    assert_eq!(check(&hit, &[], &[]), CheckResult::NotTold);
    assert_eq!(check(&hit, &[Top], &[]), CheckResult::NotTold, "a plane has no top");
    let gap =
        |rollout: &Rollout| measure(&network, &path(&network, Approach::Same, Turn::Straight, 1), 8.0, rollout).min_gap;
    assert!(gap(&near).unwrap().value < 2.0 && gap(&near).unwrap().value > 0.0, "{:?}", gap(&near));
    assert_eq!(check(&near, &[Rear], &[Front]), CheckResult::Shown);
    assert_eq!(check(&near, &[FrontLeft], &[Front]), CheckResult::NotShown);
    assert!(gap(&far).unwrap().value > 2.0);
    assert_eq!(check(&far, &[FrontLeft], &[Front]), CheckResult::CannotBeShown);
}

#[test]
fn excluded_kinds_of_collision_are_found_in_contacts_and_near_misses() {
    use CollisionKind::{Angle, HeadOn, RearEndByEgo, RearEndOfEgo, Sideswipe};
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let ego = |speed: f64| drive(&way, 40.0, 40, |_| speed);
    let slowing = |to: f64| move |time: f64| (14.0 - 3.0 * time).max(to);
    let rear_end = rollout(ego(14.0), vec![drive(&way, 60.0, 40, |_| 8.0)]);
    let hit_from_behind = rollout(ego(8.0), vec![drive(&way, 20.0, 40, |_| 14.0)]);
    let nearly: Vec<ActorState> = drive(&way, 46.0, 40, slowing(13.0));
    let nearly_rear_end = rollout(drive(&way, 40.0, 40, slowing(13.0)), vec![nearly]);
    let head_on = rollout(ego(10.0), vec![glide(80.0, 0.5, PI, 8.0, 40)]);
    let passing = rollout(ego(10.0), vec![drive_at(&way, 30.0, 40, |_| 14.0, |_| -3.5)]);
    let free = rollout(ego(10.0), vec![drive(&way, 90.0, 40, |_| 10.0)]);
    let check = |rollout: &Rollout, excluded: &[CollisionKind]| {
        let mut expectation = expecting(RoadType::Highway, Movement::Straight, Movement::Straight);
        expectation.excluded = excluded.to_vec();
        result(&verdict(&network, rollout, &expectation), CheckKind::ExcludedCollision)
    };
    for (rollout, kind) in [
        (&rear_end, RearEndByEgo),
        (&hit_from_behind, RearEndOfEgo),
        (&nearly_rear_end, RearEndByEgo),
        (&head_on, HeadOn),
        (&passing, Sideswipe),
    ] {
        assert_eq!(check(rollout, &[kind]), CheckResult::NotShown, "{kind:?}");
        let others: Vec<_> =
            [Angle, HeadOn, RearEndByEgo, RearEndOfEgo, Sideswipe].into_iter().filter(|&other| other != kind).collect();
        assert_eq!(check(rollout, &others), CheckResult::Shown, "{kind:?}");
    }
    assert_eq!(check(&free, &[RearEndByEgo]), CheckResult::Shown);
    assert_eq!(check(&free, &[]), CheckResult::NotTold);
}

#[test]
fn a_rollout_without_states_is_not_faithful() {
    let network = cross();
    let empty = rollout(Vec::new(), Vec::new());
    let told = expecting(RoadType::Intersection, Movement::Straight, Movement::Straight);
    assert_eq!(verdict(&network, &empty, &told).faithful(), Answer::No);
}

#[test]
fn what_comes_after_an_encounter_is_no_told_speed() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // It creeps past a standing car at 2 s, and then drives on at 15 m/s.
    let ego = drive_at(&way, 20.0, 90, |time| if time < 4.0 { 3.0 } else { 15.0 }, |_| -3.5);
    let standing = drive(&way, 26.0, 90, |_| 0.0);
    let rollout = rollout(ego, vec![standing]);
    let mut expectation = expecting(RoadType::Street, Movement::Straight, Movement::Stopped);
    expectation.sv_speed_mps = Some(3.0);
    let verdict = verdict(&network, &rollout, &expectation);
    assert_eq!(observed(&verdict, CheckKind::SvSpeed), "up to 3.0 m/s");
    assert_eq!(result(&verdict, CheckKind::SvSpeed), CheckResult::Shown);
}
