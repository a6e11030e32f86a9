//! The competent and careful driver: that it drives well, and that it reacts no sooner and no less than UN R157 says.

use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Side;
use recrash_model::rollout::{Rollout, TerminationKind};
use recrash_model::scenario::{
    Approach, LateralMove, MapSpec, MissingArm, Obstacle, ObstacleKind, Policy, ScenarioDraft, Start, Turn,
};
use recrash_model::surroundings::Surface;
use recrash_sim::{Ego, EmergencyResponse, simulate};

use crate::common::{alone, checked, cross, curve, lead, random_draft, roundabout, steady, straight, tee, wide_cross};

const CAR_LENGTH_M: f64 = 4.515;

fn run(draft: ScenarioDraft) -> Rollout {
    simulate(&checked(draft), Ego::Reference)
}

fn touches(rollout: &Rollout) -> bool {
    !rollout.events.is_empty()
}

fn ends(rollout: &Rollout) -> TerminationKind {
    rollout.termination.kind
}

fn hardest_braking(rollout: &Rollout) -> f64 {
    let states = &rollout.ego_track().states;
    states.windows(2).map(|pair| (pair[0].speed() - pair[1].speed()) / 0.1).fold(0.0, f64::max)
}

#[track_caller]
fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} +- {tolerance}");
}

fn standing(delta_s_m: f64) -> recrash_model::scenario::Partner {
    let mut partner = lead(delta_s_m, 0.0);
    partner.policy = Policy::Stopped { depart_step: None, target_speed_mps: 0.0 };
    partner
}

#[test]
fn arrives_on_every_map_by_every_turn_in_every_lane_without_hard_braking() {
    let maps: [MapSpec; 8] = [
        straight(2, 80.0),
        curve(2, Side::Left),
        curve(2, Side::Right),
        cross(2),
        tee(2, MissingArm::Right),
        tee(2, MissingArm::Ahead),
        tee(2, MissingArm::Left),
        roundabout(2),
    ];
    for (number, map) in maps.iter().enumerate() {
        for turn in [Turn::Straight, Turn::Left, Turn::Right] {
            for lane in 0..2 {
                let draft = alone(map.clone(), turn, lane, 6.0, 8.0);
                // A turn that the map does not have is refused by the check.
                let Ok(scenario) = recrash_roads::check(draft) else { continue };
                let rollout = simulate(&scenario.value, Ego::Reference);
                assert_eq!(ends(&rollout), TerminationKind::Arrived, "{number} {turn:?} {lane}");
                assert!(hardest_braking(&rollout) < 3.5, "{number} {turn:?} {lane}: {}", hardest_braking(&rollout));
            }
        }
    }
}

#[test]
fn follows_two_seconds_behind() {
    let mut draft = alone(straight(1, 500.0), Turn::Straight, 0, 6.0, 10.0);
    draft.duration_s = 80.0;
    draft.partners.push(lead(30.0, 6.0));
    let rollout = run(draft);
    let step = 600;
    let gap = rollout.actors[1].states[step].x - rollout.actors[0].states[step].x - CAR_LENGTH_M;
    // (2 m + 6 m/s 2 s) / sqrt(1 - 0.6^4) = 15.0 m.
    near(gap, 14.0 / 0.8704_f64.sqrt(), 0.3);
}

#[test]
fn stops_comfortably_behind_who_stands() {
    let mut draft = alone(straight(1, 100.0), Turn::Straight, 0, 10.0, 10.0);
    draft.partners.push(standing(80.0));
    let rollout = run(draft);
    assert!(!touches(&rollout));
    assert!(hardest_braking(&rollout) < 3.5, "{}", hardest_braking(&rollout));
    let last = rollout.ego_track().states.last().expect("states");
    let gap = rollout.actors[1].states[0].x - last.x - CAR_LENGTH_M;
    // 2 m, and 6 m to pull out again.
    assert!(gap > 7.0 && gap < 9.0, "{gap}");
}

#[test]
fn gives_way_at_any_timing_and_arrives() {
    for (approach, turn, speed) in [
        (Approach::Left, Turn::Straight, 8.33),
        (Approach::Right, Turn::Straight, 8.33),
        (Approach::Opposite, Turn::Left, 6.0),
    ] {
        for tenths in -25..=25 {
            let mut draft = alone(wide_cross(2), Turn::Straight, 1, 8.33, 8.33);
            let start = Start::ArrivalGap { arrival_gap_s: 0.1 * f64::from(tenths) };
            draft.partners.push(steady(approach, turn, start, speed));
            let rollout = run(draft);
            assert!(!touches(&rollout), "{approach:?} {tenths}");
            assert_eq!(ends(&rollout), TerminationKind::Arrived, "{approach:?} {tenths}");
        }
    }
}

#[test]
fn enters_a_roundabout_behind_who_is_on_it() {
    for tenths in -16..=20 {
        let mut draft = alone(roundabout(1), Turn::Straight, 0, 7.0, 7.0);
        draft.ego.s_m = 35.0;
        let start = Start::ArrivalGap { arrival_gap_s: 0.1 * f64::from(tenths) };
        draft.partners.push(steady(Approach::Ring, Turn::Straight, start, 6.0));
        let rollout = run(draft);
        assert!(!touches(&rollout), "{tenths}: {:?}", rollout.events);
        assert_eq!(ends(&rollout), TerminationKind::Arrived, "{tenths}");
    }
}

/// Somebody steps onto the road 60 m ahead, and walks across it.
fn walks_across(start_s: f64) -> Rollout {
    let mut draft = alone(straight(2, 100.0), Turn::Straight, 1, 8.0, 8.0);
    let mut walking = lead(60.0, 0.3);
    walking.kind = PartnerKind::Pedestrian;
    walking.start = Start::Offset { delta_s_m: 60.0, delta_t_m: 3.0 };
    walking.policy = Policy::SuddenBrake { target_speed: 1.4, brake_step: 0, brake_steps: 0, speed_kp: None };
    walking.lateral = vec![LateralMove { start_s, duration_s: 5.0, to_t_m: -3.0 }];
    draft.partners.push(walking);
    run(draft)
}

#[test]
fn waits_for_who_walks_across_its_way_but_cannot_for_who_steps_out_too_late() {
    let touched: Vec<bool> = (0..=45).map(|fifths| touches(&walks_across(1.0 + 0.2 * f64::from(fifths)))).collect();
    // It would be there after about 7 s.
    assert!(touched[..23].iter().all(|&touch| !touch), "stepping out until 5.4 s: {touched:?}");
    assert!(touched[35..].iter().all(|&touch| !touch), "stepping out behind it, from 8 s on: {touched:?}");
    assert!(touched[23..35].iter().filter(|&&touch| touch).count() <= 4, "{touched:?}");
    assert_eq!(ends(&walks_across(3.0)), TerminationKind::Arrived);
}

#[test]
fn drives_around_cones_where_its_direction_has_room() {
    for lane in 0..2 {
        let mut draft = alone(straight(2, 150.0), Turn::Straight, lane, 8.33, 8.33);
        for number in 0..6 {
            let (s_m, t_m) = (80.0 + 6.0 * f64::from(number), 1.5 - 0.3 * f64::from(number));
            draft.obstacles.push(Obstacle { kind: ObstacleKind::Cone, s_m, t_m });
        }
        let passed = run(draft);
        assert!(!touches(&passed), "{lane}: {:?}", passed.events);
        assert_eq!(ends(&passed), TerminationKind::Arrived, "{lane}");
        let last = passed.ego_track().states.last().expect("states");
        near(last.y, if lane == 0 { 3.5 } else { 0.0 }, 0.4);
    }
}

#[test]
fn slows_for_a_cone_until_the_other_lane_is_free() {
    let slowest = |lane_offset: i8, delta_s_m: f64| {
        let mut draft = alone(straight(2, 200.0), Turn::Straight, 1, 8.0, 8.0);
        draft.obstacles.push(Obstacle { kind: ObstacleKind::Cone, s_m: 70.0, t_m: 0.0 });
        let mut other = lead(delta_s_m, 8.0);
        other.lane_offset = lane_offset;
        draft.partners.push(other);
        let rollout = run(draft);
        assert!(!touches(&rollout), "{:?}", rollout.events);
        assert_eq!(ends(&rollout), TerminationKind::Arrived);
        rollout.ego_track().states.iter().map(|state| state.speed()).fold(f64::INFINITY, f64::min)
    };
    let (free, taken) = (slowest(-1, 60.0), slowest(-1, 0.0));
    assert!(free > 7.0 && taken < 6.0, "{free} {taken}");
}

#[test]
fn passes_a_parked_car_by_the_other_lane_but_waits_while_somebody_is_there() {
    let mut draft = alone(straight(2, 200.0), Turn::Straight, 1, 8.33, 8.33);
    draft.partners.push(standing(80.0));
    let free = run(draft.clone());
    assert_eq!(ends(&free), TerminationKind::Arrived);
    assert!(!touches(&free));
    let mut beside = lead(-2.7, 8.0);
    beside.id = "cp2".to_owned();
    beside.lane_offset = -1;
    draft.partners.push(beside);
    let occupied = run(draft);
    assert!(!touches(&occupied), "{:?}", occupied.events);
    assert_eq!(ends(&occupied), TerminationKind::Arrived);
}

/// The ego at 15 m/s, somebody slower who cuts in from the left: the run, the step at which he is 0.375 m out of the
/// centre of his lane, and the gap then. [m]
fn cut_in(ahead_m: f64, slower_mps: f64) -> (Rollout, usize, f64) {
    let mut draft = alone(straight(2, 400.0), Turn::Straight, 1, 15.0, 15.0);
    let mut other = lead(ahead_m, 15.0 - slower_mps);
    other.lane_offset = -1;
    other.lateral = vec![LateralMove { start_s: 1.0, duration_s: 2.5, to_t_m: 3.5 }];
    draft.partners.push(other);
    let rollout = run(draft);
    let (ego, other) = (&rollout.actors[0].states, &rollout.actors[1].states);
    let noticed = other.iter().position(|state| state.y < 3.5 - 0.375).expect("he cuts in");
    let gap = other[noticed].x - ego[noticed].x - CAR_LENGTH_M;
    (rollout, noticed, gap)
}

#[test]
fn a_cut_in_is_braked_for_after_1_15_s_and_fully_after_1_75_s() {
    let (rollout, noticed, gap) = cut_in(26.4, 6.5);
    // Less than two seconds to a collision, and more than the 12.1 m it takes to avoid it.
    assert!(gap < 13.0 && gap > EmergencyResponse::UN_R157.braking_distance(6.5) + 0.5, "{gap}");
    assert!(!touches(&rollout));
    let ego = &rollout.actors[0].states;
    assert!((0..=11).all(|step| ego[noticed + step].throttle > -0.01), "no braking for 1.15 s");
    assert!((5..=11).all(|step| ego[noticed + step].throttle <= 0.0), "off the throttle after 0.4 s");
    let braking = |step: usize| (ego[noticed + step].speed() - ego[noticed + step + 1].speed()) / 0.1;
    // In the middle of the step that begins after 1.4 s: (1.45 - 1.15) / 0.6 of 7.593 m/s^2; from 1.75 s on all of it.
    near(braking(14), 3.80, 0.3);
    near(braking(18), 7.593, 0.1);
}

#[test]
fn cut_ins_are_avoided_down_to_the_distance_that_the_reaction_takes() {
    for slower in [5.0, 6.5, 8.0] {
        let limit = EmergencyResponse::UN_R157.braking_distance(slower);
        let mut outcomes = [false; 2];
        for tenths in -40..=40 {
            let ahead = limit + 0.1 * f64::from(tenths) + CAR_LENGTH_M + 1.5 * slower;
            let (rollout, _, gap) = cut_in(ahead, slower);
            let to_spare = gap - limit;
            // A decision comes every 0.1 s, which is worth up to 0.8 m here.
            if to_spare.abs() > 0.8 {
                assert_eq!(touches(&rollout), to_spare < 0.0, "{slower} m/s: {to_spare:.2} m to spare");
                outcomes[usize::from(to_spare < 0.0)] = true;
            }
        }
        assert_eq!(outcomes, [true; 2], "both sides of the limit were tried");
    }
}

#[test]
fn lets_somebody_in_who_comes_over_from_beside() {
    // He is ahead by half a length, beside, or behind by half a length, and comes over slowly.
    for ahead_m in [2.5, 0.0, -2.5] {
        let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 8.0, 8.0);
        let mut other = lead(ahead_m, 8.0);
        other.lane_offset = -1;
        other.lateral = vec![LateralMove { start_s: 2.0, duration_s: 9.0, to_t_m: 3.5 }];
        draft.partners.push(other);
        assert!(!touches(&run(draft)), "{ahead_m}");
    }
}

#[test]
fn cannot_help_somebody_who_swerves_into_its_side() {
    let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 8.0, 8.0);
    let mut other = lead(0.0, 8.0);
    other.lane_offset = -1;
    other.lateral = vec![LateralMove { start_s: 2.0, duration_s: 1.0, to_t_m: 3.5 }];
    draft.partners.push(other);
    assert!(touches(&run(draft)));
}

#[test]
fn a_lead_that_brakes_fully_is_not_hit_from_two_seconds_behind() {
    for speed in [8.0, 12.0, 16.0, 20.0] {
        let mut draft = alone(straight(1, 500.0), Turn::Straight, 0, speed, speed);
        let mut braking = lead(2.0 * speed + CAR_LENGTH_M, speed);
        braking.policy = Policy::SuddenBrake { target_speed: speed, brake_step: 20, brake_steps: 60, speed_kp: None };
        draft.partners.push(braking);
        assert!(!touches(&run(draft)), "{speed}");
    }
}

#[test]
fn brakes_less_on_ice() {
    let mut draft = alone(straight(1, 300.0), Turn::Straight, 0, 10.0, 10.0);
    draft.environment.surface = Surface::SnowIce;
    draft.partners.push(standing(150.0));
    let rollout = run(draft);
    assert!(!touches(&rollout));
    assert!(hardest_braking(&rollout) < 0.774 * 9.81 * 0.3 + 0.2, "{}", hardest_braking(&rollout));
}

#[test]
fn touches_fewer_than_the_others_in_random_scenarios() {
    let contacts = |ego| {
        let drafts = (0..2000).filter_map(|number| random_draft(21, number)).take(100);
        drafts.filter(|draft| simulate(&checked(draft.clone()), ego).first_ego_contact().is_some()).count()
    };
    let counts = Ego::DRIVERS.map(contacts);
    assert!(3 * counts[2] <= counts[0], "{:?} {counts:?}", Ego::NAMES);
}
