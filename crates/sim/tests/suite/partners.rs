//! What every kind of partner does on its way: it holds its line, and brakes no harder than its plan says.

use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Side;
use recrash_model::rollout::Rollout;
use recrash_model::scenario::{
    Approach, CurveMap, LateralMove, MapSpec, Obstacle, ObstacleKind, Policy, ScenarioDraft, Start, Turn,
};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::Plan;
use recrash_sim::{Ego, simulate};

use crate::common::{alone, checked, cross, lead, steady, straight};

/// Seconds behind a move or a bend after which the line is held again. [s]
const SETTLED_S: f64 = 12.0;

/// Every kind that moves, at speeds up to the fastest it may drive and no faster than `most`.
fn kinds_and_speeds(most: f64) -> Vec<(PartnerKind, f64)> {
    PartnerKind::ALL
        .into_iter()
        .flat_map(|kind| {
            let fastest = VehicleSpec::of(kind).max_speed_mps.min(most);
            [0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0].map(|share| (kind, ((share * fastest) * 100.0).floor() / 100.0))
        })
        .filter(|(_, speed)| *speed > 0.0)
        .collect()
}

fn holds(target_speed: f64) -> Policy {
    Policy::SuddenBrake { target_speed, brake_step: 0, brake_steps: 0, speed_kp: None }
}

/// The greatest heading error [deg] and offset [m] of the partner from `from_s` on, while it is on its path.
fn deviation(draft: ScenarioDraft, wanted_t_m: f64, from_s: f64) -> (f64, f64, f64) {
    let scenario = checked(draft);
    let path = scenario.partners()[0].path.clone();
    let rollout = simulate(&scenario, Ego::Idm);
    let mut segment = 0;
    let (mut heading, mut offset, mut last) = (0.0_f64, 0.0_f64, 0.0);
    for (step, state) in rollout.actors[1].states.iter().enumerate() {
        let point = path.project(state.position(), segment);
        segment = point.segment;
        if 0.1 * step as f64 >= from_s && point.s < path.length_m {
            let off = recrash_model::math::wrap_angle(state.heading - path.pose(point.s, 0.0).heading);
            heading = heading.max(off.to_degrees().abs());
            offset = offset.max((point.t - wanted_t_m).abs());
            last = 0.1 * step as f64;
        }
    }
    (heading, offset, last)
}

#[test]
fn every_kind_at_every_speed_holds_its_line_after_a_sideways_move() {
    let mut bad = Vec::new();
    for (kind, speed) in kinds_and_speeds(22.2) {
        for to_t_m in [-1.0, 1.0] {
            let length = (speed * 20.0).max(60.0);
            let mut draft = alone(straight(3, length.min(600.0)), Turn::Straight, 1, 1.0, 1.0);
            let mut partner = lead(20.0, speed);
            partner.kind = kind;
            partner.policy = holds(speed);
            partner.lateral = vec![LateralMove { start_s: 1.0, duration_s: 1.5, to_t_m }];
            draft.partners.push(partner);
            let (heading, offset, last) = deviation(draft, to_t_m, 2.5 + SETTLED_S);
            if heading > 0.3 || offset > 0.05 || last < 2.5 + SETTLED_S {
                bad.push(format!("{kind:?} {speed} {to_t_m}: {heading:.3} deg, {offset:.3} m, to {last:.1} s"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn every_kind_at_every_speed_holds_its_line_behind_a_bend() {
    let mut bad = Vec::new();
    let sides = [Side::Left, Side::Right];
    let bends = sides.into_iter().flat_map(|direction| [(direction, 25.0), (direction, 50.0), (direction, 80.0)]);
    for (direction, radius_m) in bends {
        let most = (17.0 * 17.0 / 50.0_f64 * radius_m).sqrt();
        for (kind, speed) in kinds_and_speeds(most).into_iter().filter(|(_, speed)| *speed >= 1.0) {
            let length_m = (speed * 13.5).clamp(30.0, 300.0);
            let map = CurveMap {
                lanes: 2,
                lane_width_m: 3.5,
                approach_m: 60.0,
                radius_m,
                angle_deg: 45.0,
                direction,
                length_m,
            };
            let mut draft = alone(MapSpec::C(map), Turn::Straight, 0, 1.0, 1.0);
            let mut partner = lead(40.0, speed);
            partner.kind = kind;
            partner.policy = holds(speed);
            partner.lane_offset = 1;
            draft.partners.push(partner);
            draft.duration_s = 120.0;
            let path = checked(draft.clone()).partners()[0].path.clone();
            let behind_m = path.segments.iter().rev().take(1).map(|segment| segment.start_m).sum::<f64>();
            let (heading, offset, seen) = behind(draft, behind_m);
            if heading > 0.3 || offset > 0.05 || !seen {
                bad.push(format!("{kind:?} {speed} {direction:?} {radius_m}: {heading:.3} deg, {offset:.3} m, {seen}"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// The greatest heading error [deg] and offset [m] from [`SETTLED_S`] after this place of its path on, and whether it
/// got there.
fn behind(draft: ScenarioDraft, behind_m: f64) -> (f64, f64, bool) {
    let scenario = checked(draft.clone());
    let path = scenario.partners()[0].path.clone();
    let rollout = simulate(&scenario, Ego::Idm);
    let passed = rollout.actors[1].states.iter().position(|state| path.project(state.position(), 0).s > behind_m);
    let Some(step) = passed else { return (0.0, 0.0, false) };
    let from_s = 0.1 * step as f64 + SETTLED_S;
    let (heading, offset, last) = deviation(draft, 0.0, from_s);
    (heading, offset, last >= from_s)
}

#[test]
fn every_kind_at_every_speed_holds_its_line_behind_a_turn() {
    let mut bad = Vec::new();
    for (approach, turn, most) in [(Approach::Same, Turn::Right, 10.0), (Approach::Same, Turn::Left, 12.0)] {
        for (kind, speed) in kinds_and_speeds(most).into_iter().filter(|(_, speed)| *speed >= 1.0) {
            let MapSpec::X(mut map) = cross(2) else { unreachable!("a cross") };
            (map.approach_m, map.arm_m) = (60.0, (speed * 13.5).clamp(30.0, 300.0));
            let mut draft = alone(MapSpec::X(map), Turn::Straight, 0, 1.0, 1.0);
            let mut partner = steady(approach, turn, Start::Offset { delta_s_m: 40.0, delta_t_m: 0.0 }, speed);
            partner.kind = kind;
            partner.lane_offset = i8::from(turn == Turn::Right);
            draft.partners.push(partner);
            draft.duration_s = 120.0;
            let path = checked(draft.clone()).partners()[0].path.clone();
            let behind_m = path.segments.last().map_or(0.0, |segment| segment.start_m);
            let (heading, offset, seen) = behind(draft, behind_m);
            if heading > 0.3 || offset > 0.05 || !seen {
                bad.push(format!("{kind:?} {speed} {turn:?}: {heading:.3} deg, {offset:.3} m, {seen}"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// The hardest braking of the partner over 0.1 s. [m/s^2]
fn hardest(rollout: &Rollout) -> f64 {
    let states = &rollout.actors[1].states;
    states.windows(2).map(|pair| (pair[0].speed() - pair[1].speed()) / 0.1).fold(0.0, f64::max)
}

/// Its greatest sideways acceleration, as a mean over 0.3 s: that of the way it drives. [m/s^2]
fn sideways(rollout: &Rollout) -> f64 {
    let states = &rollout.actors[1].states;
    let turn = |step: usize| {
        let (a, b) = (&states[step], &states[step + 3]);
        let turned = recrash_model::math::wrap_angle(b.heading - a.heading) / 0.3;
        (turned * 0.5 * (a.speed() + b.speed())).abs()
    };
    (10..states.len().saturating_sub(3)).map(turn).fold(0.0, f64::max)
}

#[test]
fn who_set_off_comes_down_to_its_cruise_speed_without_slamming_the_brake() {
    for (kind, _) in kinds_and_speeds(22.2) {
        let cruise_speed = 0.5 * VehicleSpec::of(kind).max_speed_mps.min(12.0);
        let policy = Policy::AccelThenBrake {
            accel_mag: 1.0,
            accel_steps: 60,
            cruise_speed,
            brake_step: 0,
            brake_steps: 0,
            speed_kp: None,
        };
        let plan = Plan::new(kind, &policy, 0.0, Surface::Dry);
        let mut draft = alone(straight(3, 300.0), Turn::Straight, 1, 1.0, 1.0);
        let mut partner = lead(20.0, 0.0);
        (partner.kind, partner.policy) = (kind, policy);
        draft.partners.push(partner);
        let rollout = simulate(&checked(draft), Ego::Idm);
        assert!(hardest(&rollout) <= plan.comfortable_mps2 + 0.4, "{kind:?}: {}", hardest(&rollout));
        let end = rollout.actors[1].states[300].speed();
        assert!((end - cruise_speed).abs() < 0.1, "{kind:?}: {end} instead of {cruise_speed}");
    }
}

#[test]
fn every_kind_slows_for_a_turn_as_its_plan_says() {
    for (kind, speed) in kinds_and_speeds(10.0).into_iter().filter(|(_, speed)| *speed >= 1.0) {
        let plan = Plan::new(kind, &holds(speed), 0.0, Surface::Dry);
        let mut draft = alone(cross(2), Turn::Straight, 0, 1.0, 1.0);
        let mut partner = steady(Approach::Same, Turn::Right, Start::Offset { delta_s_m: 20.0, delta_t_m: 0.0 }, speed);
        (partner.kind, partner.lane_offset) = (kind, 1);
        draft.partners.push(partner);
        let rollout = simulate(&checked(draft), Ego::Idm);
        assert!(hardest(&rollout) <= plan.greatest_braking_mps2, "{kind:?} {speed}: {}", hardest(&rollout));
        assert!(sideways(&rollout) <= 1.15 * plan.sideways_mps2, "{kind:?} {speed}: {}", sideways(&rollout));
    }
}

#[test]
fn a_partner_stops_before_what_stands_on_its_line_and_passes_what_stands_beside_it() {
    for kind in [ObstacleKind::Barrier, ObstacleKind::Cone] {
        let meets = |t_m: f64| {
            let mut draft = alone(straight(3, 200.0), Turn::Straight, 1, 1.0, 1.0);
            draft.partners.push(lead(20.0, 12.0));
            draft.obstacles.push(Obstacle { kind, s_m: 120.0, t_m });
            simulate(&checked(draft), Ego::MetadriveIdm)
        };
        let stops = meets(0.5);
        assert!(stops.events.is_empty(), "{kind:?}: {:?}", stops.events);
        let last = stops.actors[1].states[300];
        // Its front is 0.5 m before the obstacle's near side.
        let place_m = 120.0 - 0.5 * kind.size_m().0 - 0.5 - 2.2575;
        assert!((last.x - place_m).abs() < 0.4 && last.speed() < 0.05, "{kind:?}: {last:?}");
        assert!(hardest(&stops) < 4.0, "{kind:?}: {}", hardest(&stops));
        assert!(meets(2.2).actors[1].states[150].x > 180.0, "{kind:?}");
    }
}
