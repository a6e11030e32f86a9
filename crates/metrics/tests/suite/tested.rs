//! What a system under test answers for: where it had to stop, from when on it drives, and which lane it had to keep.

use crate::world::*;
use recrash_metrics::{EgoWay, findings, measure_on};
use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::metrics::{FindingKind, Metrics};
use recrash_model::rollout::{ActorState, Event, EventKind, Rollout};
use recrash_model::scenario::{Approach, Aspect, Device, MissionStop, Phase, Turn};
use recrash_roads::{LanePath, RoadNetwork};

fn own_lane(network: &RoadNetwork) -> LanePath {
    path(network, Approach::Same, Turn::Straight, 1)
}

fn kinds(way: &EgoWay<'_>, rollout: &Rollout) -> Vec<FindingKind> {
    let metrics = measure_on(way, rollout, &CRITERIA);
    findings(rollout, way.handover_s, &metrics, &CRITERIA).iter().map(|finding| finding.kind).collect()
}

fn signal(show: Aspect) -> Device {
    Device::Signal { program: vec![Phase { show, for_s: 60.0 }], offset_s: 0.0 }
}

#[test]
fn braking_for_a_signal_a_sign_or_a_stop_is_braking_for_something() {
    let network = straight();
    let path = own_lane(&network);
    // 3.5 m/s^2 from 15 m/s, from 35 m on: a stand at 67 m.
    let ego = drive(&path, 5.0, 90, |time| if time < 1.95 { 15.0 } else { (15.0 - 3.5 * (time - 2.0)).max(0.0) });
    let rollout = rollout(ego, vec![]);
    let plain = EgoWay::plain(&network, &path, 15.0);
    let stop = |s_m: f64| [MissionStop { s_m, t_m: 0.0, for_s: Some(2.0) }];
    let (red, green) = (signal(Aspect::Red), signal(Aspect::Green));
    let (sign, yields) = (Device::StopSign {}, Device::YieldSign {});
    let (near, passed) = (stop(68.0), stop(20.0));
    let at_line = |device| EgoWay { lines: vec![(68.0, device)], ..plain.clone() };
    for (way, is_phantom) in [
        (plain.clone(), true),
        (at_line(&red), false),
        (at_line(&sign), false),
        (at_line(&yields), false),
        (at_line(&green), true),
        (EgoWay { lines: vec![(300.0, &red)], ..plain.clone() }, true),
        (EgoWay { lines: vec![(20.0, &red)], ..plain.clone() }, true),
        (EgoWay { stops: &near, ..plain.clone() }, false),
        (EgoWay { stops: &passed, ..plain.clone() }, true),
    ] {
        assert_eq!(kinds(&way, &rollout).contains(&FindingKind::PhantomBraking), is_phantom, "{way:?}");
    }
}

#[test]
fn what_the_recorded_driver_did_before_the_handover_is_not_the_systems() {
    let network = straight();
    let path = own_lane(&network);
    // Until 3 s: braking for nothing, half out of its lane, 0.2 m beside a parked car at about 2 s, over a cone.
    let speed = |time: f64| if time < 0.95 { 10.0 } else { (10.0 - 5.0 * (time - 1.0)).max(6.0) };
    let beside = |time: f64| if (0.5..2.5).contains(&time) { 1.2 } else { 0.0 };
    let ego = drive_at(&path, 5.0, 90, speed, beside);
    let parked = drive_at(&path, 22.0, 90, |_| 0.0, |_| 1.2 + WIDTH_M + 0.2);
    let mut rollout = rollout(ego, vec![parked]);
    rollout.obstacles.push(cone(20.0, -1.0));
    let (obstacle, state) = (0, rollout.actors[0].states[20]);
    rollout.events.push(Event { time_s: 2.0, kind: EventKind::ObstacleContact { actor: 0, obstacle, state } });
    let whole = EgoWay::plain(&network, &path, 10.0);
    let from_5_s = EgoWay { handover_s: 5.0, ..whole.clone() };
    use FindingKind::{HardBraking, LaneDeparture, NearMiss, ObstacleContact, PhantomBraking};
    let all = kinds(&whole, &rollout);
    for kind in [NearMiss, ObstacleContact, HardBraking, LaneDeparture] {
        assert!(all.contains(&kind), "{all:?}");
    }
    assert_eq!(kinds(&from_5_s, &rollout), []);
    let metrics = measure_on(&from_5_s, &rollout, &CRITERIA);
    let gap = metrics.partners[0].min_gap;
    assert!(gap.time_s >= 5.0 && gap.value > 2.0 && metrics.obstacle_gaps[0].value > 2.0, "{metrics:?}");
    close(metrics.ego.mean_speed_mps, 6.0, 1e-9);
    // The record alone is measured whole.
    rollout.ego = "recorded".to_owned();
    assert_eq!(kinds(&from_5_s, &rollout), all);
    assert!(!all.contains(&PhantomBraking), "the cone and the car are reasons");
}

#[test]
fn who_appears_or_leaves_has_no_measures_while_it_is_not_there() {
    let network = straight();
    let path = own_lane(&network);
    let mut rollout = rollout(
        drive(&path, 5.0, 60, |_| 10.0),
        vec![glide(25.0, 30.0, 0.0, 0.0, 60), glide(25.0, 30.0, 0.0, 0.0, 60)],
    );
    (rollout.actors[1].appears_s, rollout.actors[1].gone_s) = (2.0, Some(4.0));
    rollout.actors[2].gone_s = Some(1.0);
    let metrics = measure_on(&EgoWay::plain(&network, &path, 10.0), &rollout, &CRITERIA);
    assert!(metrics.partners.iter().all(|partner| partner.pet.is_none()), "{metrics:?}");
    let late = EgoWay { handover_s: 2.0, ..EgoWay::plain(&network, &path, 10.0) };
    let seen: Vec<usize> =
        measure_on(&late, &rollout, &CRITERIA).partners.iter().map(|partner| partner.actor).collect();
    assert_eq!(seen, [1], "the other one had gone");
}

fn departure(way: &EgoWay<'_>, ego: Vec<ActorState>) -> f64 {
    let metrics: Metrics = measure_on(way, &rollout(ego, vec![]), &CRITERIA);
    metrics.ego.max_lane_departure.value
}

#[test]
fn pulling_over_as_told_is_no_departure_and_farther_is_one() {
    let network = straight();
    let path = own_lane(&network);
    let stops = [MissionStop { s_m: 80.0, t_m: 2.0, for_s: None }];
    let told = EgoWay { stops: &stops, ..EgoWay::plain(&network, &path, 10.0) };
    // Over 40 m to the right; at 80 m it stands.
    let to = |t_m: f64| {
        let speed = |time: f64| if time < 6.95 { 10.0 } else { (10.0 - 10.0 * (time - 7.0)).max(0.0) };
        drive_at(&path, 5.0, 110, speed, move |time| t_m * ((time - 4.0) / 3.0).clamp(0.0, 1.0))
    };
    close(departure(&told, to(2.0)), 0.0, 0.1);
    close(departure(&told, to(3.0)), 1.0, 0.2);
    assert!(departure(&EgoWay::plain(&network, &path, 10.0), to(2.0)) > 1.0);
    assert!(departure(&told, to(-2.0)) > 1.0, "the other side is not told");
}

#[test]
fn who_is_put_beside_its_lane_has_left_none_until_it_was_in_it() {
    let network = straight();
    let path = own_lane(&network);
    let way = EgoWay::plain(&network, &path, 10.0);
    let parked = drive_at(&path, 5.0, 60, |_| 0.0, |_| 3.0);
    assert_eq!(departure(&way, parked), 0.0);
    let in_and_out = drive_at(&path, 5.0, 90, |_| 10.0, |time| if time < 2.0 { 3.0 - 1.5 * time } else { 0.0 });
    assert_eq!(departure(&way, in_and_out), 0.0);
    let out_again = drive_at(&path, 5.0, 90, |_| 10.0, |time| (3.0 - 1.5 * time).max(0.0) + (time - 6.0).max(0.0));
    assert!(departure(&way, out_again) > 1.0);
}

#[test]
fn a_lane_is_as_wide_as_it_is_where_the_ego_is() {
    let mut network = straight();
    // From 3.5 m to twice that.
    let path = own_lane(&network);
    let lane = path.segments.last().unwrap().lane;
    network.lanes[usize::from(lane.0)].end_width_m = 7.0;
    let (s, length_m) = (path.length_m - 60.0, LENGTH_M);
    let ego = drive_at(&path, s, 40, |_| 10.0, |time| (0.8 * time).min(2.0));
    let way = EgoWay::plain(&network, &path, 10.0);
    let outline = OrientedBox::new(Pose::default(), length_m, WIDTH_M);
    assert!(2.0 + outline.half_width < 3.2, "within the lane there");
    assert_eq!(departure(&way, ego), 0.0);
}
