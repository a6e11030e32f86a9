//! Metrics of rollouts whose numbers can be worked out by hand.

use crate::world::*;
use recrash_metrics::{EgoWay, findings, series};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math::FRAC_PI_2;
use recrash_model::metrics::{CollisionKind, FindingKind, Metrics};
use recrash_model::rollout::ActorState;
use recrash_model::rollout::{Event, EventKind, PlacedObstacle, Role, Rollout, TerminationKind};
use recrash_model::scenario::{Approach, ObstacleKind, Turn};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;

fn kinds(rollout: &Rollout, metrics: &Metrics) -> Vec<FindingKind> {
    findings(rollout, 0.0, metrics, &CRITERIA).iter().map(|finding| finding.kind).collect()
}

#[test]
fn closing_in_on_a_slower_leader() {
    // 20 m/s behind 15 m/s, 40 m between the bumpers, for 4 s: 20 m are left.
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let ego = drive(&way, 5.0, 41, |_| 20.0);
    let leader = drive(&way, 45.0 + LENGTH_M, 41, |_| 15.0);
    let metrics = measure(&network, &way, 20.0, &rollout(ego, vec![leader]));
    let partner = &metrics.partners[0];
    close(partner.min_gap.value, 20.0, 1e-9);
    close(partner.min_gap.time_s, 4.0, 1e-9);
    close(partner.min_centre_distance.value, 20.0 + LENGTH_M, 1e-9);
    close(partner.min_ttc.unwrap().value, 4.0, 1e-9);
    close(partner.min_headway.unwrap().value, 1.0, 1e-9);
    close(partner.max_drac.unwrap().value, 25.0 / 40.0, 1e-9);
    close(partner.max_required_deceleration.unwrap().value, 25.0 / 40.0, 1e-9);
    // A spot is reached least long after the leader left it at the end: 20 m behind it, at 15 m/s.
    close(partner.pet.unwrap().value, 20.0 / 15.0, 1e-6);
    assert!(metrics.contact.is_none());
    close(metrics.ego.distance_m, 80.0, 1e-9);
    close(metrics.ego.mean_speed_mps, 20.0, 1e-9);
    assert_eq!(metrics.ego.max_deceleration.value, 0.0);
}

#[test]
fn crossing_paths_that_miss() {
    // On X with an approach of 60 m the ego (right lane, y = 0) and one from the left (right lane, x = 70, downwards).
    let network = cross();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let other_way = path(&network, Approach::Left, Turn::Straight, 1);
    let crossing = way.conflict(&other_way, WIDTH_M, WIDTH_M).expect("they cross");
    close(crossing.point.x, 70.0, 1e-9);
    // The ego's centre at the crossing at 5.0 s, the other's 1.5 s later, both at 8 m/s.
    let ego = drive(&way, crossing.s_a - 40.0, 90, |_| 8.0);
    let other = drive(&other_way, crossing.s_b - 52.0, 90, |_| 8.0);
    let metrics = measure(&network, &way, 8.0, &rollout(ego, vec![other]));
    let partner = &metrics.partners[0];
    // Out: half a length and half the other's width behind the crossing. In: as much before it.
    let clear_s = (LENGTH_M + WIDTH_M) / 8.0;
    close(partner.pet.unwrap().value, 1.5 - clear_s, 1e-6);
    assert_eq!(partner.min_headway, None);
    assert_eq!(partner.max_drac, None);
    assert_eq!(partner.min_ttc, None);
}

#[test]
fn a_contact_at_a_crossing() {
    // The other's front meets the middle of the ego's left side.
    let network = cross();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let ego = drive(&way, 30.0, 90, |_| 8.0);
    // At 5.0 s the ego's centre is at x = 70. There the other's front has gone 0.1 m into its side.
    let reach = 0.5 * (LENGTH_M + WIDTH_M) - 0.1;
    let other = glide(70.0, reach + 5.0 * 5.0, -FRAC_PI_2, 5.0, 90);
    let rollout = rollout(ego, vec![other]);
    let metrics = measure(&network, &way, 8.0, &rollout);
    let contact = metrics.contact.clone().unwrap();
    close(contact.time_s, 5.0, 1e-9);
    assert_eq!((contact.ego_zone, contact.other_zone), (ContactZone::Left, ContactZone::Front));
    assert_eq!(contact.kind, CollisionKind::Angle);
    close(contact.relative_speed_mps, 89.0_f64.sqrt(), 1e-9);
    assert_eq!(metrics.min_gap.unwrap().value, 0.0);
    assert_eq!(metrics.partners[0].min_ttc.unwrap().value, 0.0);
    assert_eq!(metrics.partners[0].pet.unwrap().value, 0.0);
    assert_eq!(metrics.termination, TerminationKind::Contact);
    assert_eq!(kinds(&rollout, &metrics), [FindingKind::Contact]);
    let sentence = &findings(&rollout, 0.0, &metrics, &CRITERIA)[0].sentence;
    assert!(
        sentence.contains("cp1") && sentence.contains("left against front") && sentence.contains("9.4 m/s"),
        "{sentence}"
    );
}

#[test]
fn nothing_after_the_contact_counts() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // Full braking from the step after the contact on.
    let ego = drive(&way, 5.0, 60, |time| if time < 2.05 { 20.0 } else { 5.0 });
    let leader = drive(&way, 5.0 + LENGTH_M + 19.9, 60, |_| 10.0);
    let metrics = measure(&network, &way, 20.0, &rollout(ego, vec![leader]));
    close(metrics.contact.unwrap().time_s, 2.0, 1e-9);
    assert_eq!(metrics.ego.max_deceleration.value, 0.0);
    close(metrics.ego.distance_m, 40.0, 1e-9);
}

#[test]
fn a_near_miss_side_by_side_is_a_failure_and_wider_is_none() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    for (offset, expected) in [(-3.5, vec![FindingKind::NearMiss]), (-3.9, vec![])] {
        let ego = drive(&way, 40.0, 60, |_| 12.0);
        let other = drive_at(&way, 20.0, 60, |_| 20.0, |_| offset);
        let rollout = rollout(ego, vec![other]);
        let metrics = measure(&network, &way, 12.0, &rollout);
        close(metrics.min_gap.unwrap().value, -offset - WIDTH_M, 1e-9);
        assert_eq!(kinds(&rollout, &metrics), expected, "{offset}");
        assert_eq!(metrics.partners[0].pet, None);
    }
}

#[test]
fn who_is_put_beside_the_ego_and_stays_there_is_no_near_miss_and_who_comes_nearer_is_one() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    for (nearer_m, expected) in [(0.0, vec![]), (0.5, vec![FindingKind::NearMiss])] {
        let ego = drive(&way, 40.0, 60, |_| 12.0);
        let other = drive_at(&way, 40.0, 60, |_| 12.0, |time| -3.5 + nearer_m * (time / 4.0).min(1.0));
        let rollout = rollout(ego, vec![other]);
        let metrics = measure(&network, &way, 12.0, &rollout);
        assert_eq!(kinds(&rollout, &metrics), expected, "{nearer_m} m nearer");
    }
}

#[test]
fn hard_braking_behind_a_stopped_car_is_hard_but_no_phantom() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // 5 m/s^2 from 15 m/s: stands after 3 s and 22.5 m, 2.5 m behind the car 25 m ahead.
    let ego = drive(&way, 5.0, 60, |time| (15.0 - 5.0 * time).max(0.0));
    let parked = drive(&way, 30.0 + LENGTH_M, 60, |_| 0.0);
    let rollout = rollout(ego, vec![parked]);
    let metrics = measure(&network, &way, 15.0, &rollout);
    close(metrics.ego.max_deceleration.value, 5.0, 1e-6);
    assert_eq!(metrics.ego.phantom_braking, None);
    close(metrics.min_gap.unwrap().value, 2.5, 1e-9);
    assert_eq!(kinds(&rollout, &metrics), [FindingKind::HardBraking]);
}

#[test]
fn braking_harder_than_tyres_give_is_found_and_on_a_wet_road_sooner() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    for (braking_mps2, surface, beyond) in
        [(9.7, Surface::Dry, false), (9.9, Surface::Dry, true), (6.8, Surface::Wet, false), (7.0, Surface::Wet, true)]
    {
        let ego = drive(&way, 5.0, 60, |time| (15.0 - braking_mps2 * time).max(0.0));
        let rollout = rollout(ego, vec![drive(&way, 40.0, 60, |_| 0.0)]);
        let way = EgoWay { surface, ..EgoWay::plain(&network, &way, 15.0) };
        let metrics = recrash_metrics::measure_on(&way, &rollout, &CRITERIA);
        let found = kinds(&rollout, &metrics).contains(&FindingKind::BrakingBeyondTyres);
        assert_eq!(found, beyond, "{braking_mps2} m/s^2, {surface:?}");
    }
}

#[test]
fn braking_on_an_empty_road_is_phantom_braking() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let braking = |time: f64| if time < 1.95 { 15.0 } else { (15.0 - 3.5 * (time - 2.0)).max(8.0) };
    let ego = drive(&way, 5.0, 60, braking);
    // One in the next lane, and one 70 m ahead at the same speed: neither is in the way.
    let beside = drive_at(&way, 25.0, 60, |_| 15.0, |_| -3.5);
    let far = drive(&way, 75.0 + LENGTH_M, 60, |_| 15.0);
    let rollout_free = rollout(ego.clone(), vec![beside, far]);
    let metrics = measure(&network, &way, 15.0, &rollout_free);
    let phantom = metrics.ego.phantom_braking.unwrap();
    close(phantom.value, 3.5, 1e-6);
    assert!(kinds(&rollout_free, &metrics).contains(&FindingKind::PhantomBraking));
    // The same with a reason each: a leader 30 m ahead that brakes as well, a cone ahead, one that is about to cross.
    let leader = rollout(ego.clone(), vec![drive(&way, 35.0 + LENGTH_M, 60, braking)]);
    assert_eq!(measure(&network, &way, 15.0, &leader).ego.phantom_braking, None);
    let mut coned = rollout(ego.clone(), vec![]);
    coned.obstacles.push(cone(75.0, 0.3));
    assert_eq!(measure(&network, &way, 15.0, &coned).ego.phantom_braking, None);
    let crossing = rollout(ego.clone(), vec![glide(70.0, 25.0, -FRAC_PI_2, 5.0, 60)]);
    assert_eq!(measure(&network, &way, 15.0, &crossing).ego.phantom_braking, None);
    // One that is still 30 m off the ego's lane, and crosses it 4 s later, well behind the place where the ego would be.
    let gives_way = rollout(ego.clone(), vec![glide(70.0, 34.0, -FRAC_PI_2, 6.0, 60)]);
    assert_eq!(measure(&network, &way, 15.0, &gives_way).ego.phantom_braking, None);
    let stays_off = rollout(ego.clone(), vec![glide(70.0, 64.0, -FRAC_PI_2, 6.0, 60)]);
    assert!(measure(&network, &way, 15.0, &stays_off).ego.phantom_braking.is_some());
    // Too fast is a reason, too.
    assert_eq!(measure(&network, &way, 7.0, &rollout_free).ego.phantom_braking, None);
    // A cone beside the lane is none.
    let mut beside = rollout(ego, vec![]);
    beside.obstacles.push(cone(75.0, -2.6));
    assert!(measure(&network, &way, 15.0, &beside).ego.phantom_braking.is_some());
}

#[test]
fn speed_lost_without_the_brake_is_no_braking() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // Down and up by 0.5 m/s every second step, as steered wheels do.
    let wobble = |time: f64| if ((time / 0.2).round() as u32).is_multiple_of(2) { 10.0 } else { 9.5 };
    let mut states = drive(&way, 5.0, 60, wobble);
    let unknown = measure(&network, &way, 12.0, &rollout(states.clone(), vec![])).ego;
    close(unknown.max_deceleration.value, 5.0, 1e-9);
    assert!(unknown.max_reversals > 10, "without commands every deceleration is braking");
    states.iter_mut().for_each(|state| state.throttle = 0.1);
    let steered = measure(&network, &way, 12.0, &rollout(states.clone(), vec![])).ego;
    assert_eq!((steered.max_deceleration.value, steered.phantom_braking, steered.max_reversals), (0.0, None, 0));
    states.iter_mut().for_each(|state| state.throttle = -0.1);
    let braked = measure(&network, &way, 12.0, &rollout(states, vec![])).ego;
    close(braked.phantom_braking.unwrap().value, 5.0, 1e-9);
}

#[test]
fn a_lane_change_cut_short_by_a_contact_is_no_departure() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // Into the left lane over 3 s, and into the car there after 2 s.
    let change = |time: f64| -3.5 * (time / 3.0).min(1.0);
    let ego = drive_at(&way, 40.0, 60, |_| 10.0, change);
    let beside = drive_at(&way, 40.0, 60, |_| 10.0, |_| -3.5);
    let metrics = measure(&network, &way, 10.0, &rollout(ego.clone(), vec![beside]));
    assert!(metrics.contact.is_some_and(|contact| contact.time_s < 2.0));
    assert_eq!(metrics.ego.max_lane_departure.value, 0.0);
    // The same to the right, where there is no lane.
    let off = |time: f64| 3.5 * (time / 3.0).min(1.0);
    let ego = drive_at(&way, 40.0, 60, |_| 10.0, off);
    let beside = drive_at(&way, 40.0, 60, |_| 10.0, |_| 3.5);
    let metrics = measure(&network, &way, 10.0, &rollout(ego, vec![beside]));
    assert!(metrics.ego.max_lane_departure.value > 0.5);
}

#[test]
fn slowing_for_a_turn_is_no_phantom() {
    let network = cross();
    let slowing = |time: f64| (12.0 - 3.5 * time).max(6.0);
    for (turn, phantom) in [(Turn::Right, false), (Turn::Straight, true)] {
        let way = path(&network, Approach::Same, turn, 1);
        let ego = drive(&way, 35.0, 40, slowing);
        let metrics = measure(&network, &way, 12.0, &rollout(ego, vec![]));
        assert_eq!(metrics.ego.phantom_braking.is_some(), phantom, "{turn:?}");
    }
}

#[test]
fn oscillation_counts_changes_within_the_window() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // A triangle between 10 and 12 m/s, up for 1 s and down for 1 s: a change every second.
    let triangle = |time: f64| {
        let phase = (time / 2.0).fract();
        10.0 + if phase < 0.5 { 4.0 * phase } else { 4.0 * (1.0 - phase) }
    };
    let metrics = measure(&network, &way, 14.0, &rollout(drive(&way, 5.0, 101, triangle), vec![]));
    // Changes at 1, 2, ..., 9 s; six of them lie within 5 s.
    assert_eq!(metrics.ego.max_reversals, 6);
    let slow = |time: f64| 10.0 + 0.2 * triangle(time);
    let metrics = measure(&network, &way, 14.0, &rollout(drive(&way, 5.0, 101, slow), vec![]));
    assert_eq!(metrics.ego.max_reversals, 0, "0.4 m/s^2 is neither braking nor accelerating");
}

#[test]
fn leaving_the_lane_counts_and_changing_it_does_not() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let weave = |time: f64| if (2.0..4.0).contains(&time) { -1.5 } else { 0.0 };
    let steps = 80;
    let drift = drive_at(&way, 5.0, steps, |_| 10.0, weave);
    let mut level = drift.clone();
    level.iter_mut().for_each(|state| state.heading = 0.0);
    let metrics = measure(&network, &way, 10.0, &rollout(level, vec![]));
    close(metrics.ego.max_lane_departure.value, 1.5 + 0.5 * WIDTH_M - 1.75, 1e-9);
    // Into the left lane within 3 s, and on in it: a lane change.
    let change = |time: f64| -3.5 * (time / 3.0).min(1.0);
    let metrics = measure(&network, &way, 10.0, &rollout(drive_at(&way, 5.0, steps, |_| 10.0, change), vec![]));
    assert!(metrics.ego.max_lane_departure.value < 0.1, "{:?}", metrics.ego.max_lane_departure);
    // Off the road on the right: no lane there to change to.
    let off = |time: f64| 3.0 * (time / 3.0).min(1.0);
    let metrics = measure(&network, &way, 10.0, &rollout(drive_at(&way, 5.0, steps, |_| 10.0, off), vec![]));
    close(metrics.ego.max_lane_departure.value, 3.0 + 0.5 * WIDTH_M - 1.75, 0.2);
}

#[test]
fn cones_hit_and_missed() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let mut rollout = rollout(drive(&way, 5.0, 60, |_| 10.0), vec![]);
    // A cone 2 m to the right of the centre of the lane, one in the middle of it.
    rollout.obstacles = vec![cone(30.0, -2.0), cone(50.0, 0.0)];
    let state = rollout.actors[0].states[43];
    let hit = EventKind::ObstacleContact { actor: 0, obstacle: 1, state };
    rollout.events.push(Event { time_s: 4.26, kind: hit });
    let metrics = measure(&network, &way, 10.0, &rollout);
    close(metrics.obstacle_gaps[0].value, 2.0 - 0.2 - 0.5 * WIDTH_M, 1e-9);
    assert_eq!((metrics.obstacle_gaps[1].value, metrics.obstacle_gaps[1].time_s), (0.0, 4.26));
    assert_eq!(metrics.obstacles_hit, [1]);
    assert_eq!(kinds(&rollout, &metrics), [FindingKind::ObstacleContact]);
}

#[test]
fn what_stands_firm_takes_all_speed_of_who_strikes_it_and_a_light_thing_hardly_any() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // Struck square with the front at 10 m/s, the thing's middle ahead of the ego's.
    let struck = |kind: ObstacleKind, before_s: f64| {
        let mut rollout = rollout(drive(&way, 5.0, 60, |_| 10.0), vec![]);
        let state = rollout.actors[0].states[30];
        let (length_m, width_m) = kind.size_m();
        let ahead_m = 0.5 * LENGTH_M + 0.5 * length_m - 0.01;
        let position = state.position() + Vec2::from_heading(state.heading) * ahead_m;
        rollout.obstacles = vec![PlacedObstacle { kind, pose: Pose { position, ..state.pose() }, length_m, width_m }];
        let hit = EventKind::ObstacleContact { actor: 0, obstacle: 0, state };
        rollout.events.push(Event { time_s: 3.0, kind: hit });
        let way = EgoWay { handover_s: before_s, ..EgoWay::plain(&network, &way, 10.0) };
        let metrics = recrash_metrics::measure_on(&way, &rollout, &CRITERIA);
        recrash_metrics::severity_of(&rollout, &metrics)
    };
    let car_kg = VehicleSpec::mass_kg(PartnerKind::PassengerCar).expect("it is no wall");
    for kind in ObstacleKind::ALL.into_iter().filter(|kind| kind.stands_up()) {
        let found = struck(kind, 0.0).expect("it was struck");
        let share = kind.mass_kg().map_or(1.0, |mass_kg| mass_kg / (mass_kg + car_kg));
        close(found.first.delta_v_mps, 10.0 * share, 1e-6);
        close(found.second.delta_v_mps, if kind.mass_kg().is_some() { 10.0 * (1.0 - share) } else { 0.0 }, 1e-6);
        close(found.harm_mps(), found.first.delta_v_mps, 1e-9);
        assert_eq!((found.obstacle, found.first.force_clock, found.other()), (Some(kind), Some(12), kind.label()));
    }
    assert_eq!(struck(ObstacleKind::Pothole, 0.0), None, "nothing stands there");
    assert_eq!(struck(ObstacleKind::Wall, 4.0), None, "that was the recorded driver");
}

#[test]
fn a_wall_along_its_way_takes_what_goes_across_it_and_a_contact_with_a_road_user_comes_first() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let mut rollout = rollout(drive(&way, 5.0, 60, |_| 10.0), vec![]);
    // At 10 m/s it goes 1 m/s sideways into a wall along its right side, 6 m long, abreast of its middle.
    let mut state = rollout.actors[0].states[30];
    let (forward, left) = (Vec2::from_heading(state.heading), Vec2::from_heading(state.heading).left());
    let velocity = forward * 10.0 - left;
    (state.vx, state.vy) = (velocity.x, velocity.y);
    let position = state.position() - left * (0.5 * WIDTH_M + 0.14);
    let pose = Pose { position, ..state.pose() };
    rollout.obstacles = vec![PlacedObstacle { kind: ObstacleKind::Wall, pose, length_m: 6.0, width_m: 0.3 }];
    rollout.events.push(Event { time_s: 3.0, kind: EventKind::ObstacleContact { actor: 0, obstacle: 0, state } });
    let of = |rollout: &Rollout| recrash_metrics::severity_of(rollout, &measure(&network, &way, 10.0, rollout));
    let found = of(&rollout).expect("it scrapes along");
    close(found.normal_speed_mps, 1.0, 1e-9);
    // Friction of half the blow drags it back.
    close(found.first.delta_v_mps, 1.25_f64.sqrt(), 1e-6);
    let mut later = rollout.clone();
    let (a_state, b_state) = (later.actors[0].states[50], later.actors[0].states[50]);
    later.actors.push(later.actors[0].clone());
    later.events.push(Event { time_s: 5.0, kind: EventKind::Contact { a: 0, b: 1, a_state, b_state } });
    assert_eq!(of(&later).map(|severity| severity.obstacle), Some(None));
}

#[test]
fn nobody_sits_in_an_animal_or_in_debris_that_moves_by_a_plan() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let struck = |kind: PartnerKind, mass_kg: Option<f64>| {
        let mut rollout = rollout(drive(&way, 5.0, 60, |_| 10.0), vec![drive(&way, 60.0, 60, |_| 0.0)]);
        let (a_state, mut b_state) = (rollout.actors[0].states[30], rollout.actors[1].states[30]);
        (rollout.actors[1].kind, rollout.actors[1].mass_kg) = (kind, mass_kg);
        b_state.x = a_state.x + LENGTH_M - 0.01;
        rollout.events.push(Event { time_s: 3.0, kind: EventKind::Contact { a: 0, b: 1, a_state, b_state } });
        recrash_metrics::severity_of(&rollout, &measure(&network, &way, 10.0, &rollout)).expect("they touch")
    };
    for (kind, mass_kg) in [(PartnerKind::Animal, None), (PartnerKind::FixedObject, Some(20.0))] {
        let found = struck(kind, mass_kg);
        assert!(found.second.delta_v_mps > 9.0 && found.first.delta_v_mps < 1.0, "{found:?}");
        assert_eq!((found.harm_mps(), found.other()), (found.first.delta_v_mps, kind.label()));
    }
    let found = struck(PartnerKind::Pedestrian, None);
    assert_eq!((found.harm_mps(), found.other()), (found.second.delta_v_mps, "partner"));
}

#[test]
fn a_gap_is_that_to_the_nearest_part() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // Its trailer ends 6 m behind the one ahead.
    let mut rollout = rollout(drive(&way, 5.0, 20, |_| 10.0), vec![drive(&way, 45.0, 20, |_| 10.0)]);
    rollout.actors.push(actor("cp.trailer", Role::Part, drive(&way, 39.0, 20, |_| 10.0)));
    rollout.actors[2].part_of = Some(1);
    let metrics = measure(&network, &way, 10.0, &rollout);
    close(metrics.min_gap.unwrap().value, 34.0 - LENGTH_M, 1e-9);
    close(metrics.partners[0].min_gap.value, 34.0 - LENGTH_M, 1e-9);
    close(metrics.partners[0].min_centre_distance.value, 40.0, 1e-9);
    close(series(&rollout).partners[0].gap_m[5], 34.0 - LENGTH_M, 1e-9);
    // Something that the ego carries in front of it.
    rollout.actors.push(actor("ego.plough", Role::Part, drive(&way, 7.0, 20, |_| 10.0)));
    rollout.actors[3].part_of = Some(0);
    let metrics = measure(&network, &way, 10.0, &rollout);
    close(metrics.min_gap.unwrap().value, 32.0 - LENGTH_M, 1e-9);
}

#[test]
fn scripted_partners_count_before_background_traffic() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let mut rollout =
        rollout(drive(&way, 5.0, 20, |_| 10.0), vec![drive(&way, 45.0, 20, |_| 10.0), drive(&way, 25.0, 20, |_| 10.0)]);
    rollout.actors[2].role = Role::Traffic;
    let metrics = measure(&network, &way, 10.0, &rollout);
    close(metrics.min_gap.unwrap().value, 40.0 - LENGTH_M, 1e-9);
    rollout.actors[1].role = Role::Traffic;
    let metrics = measure(&network, &way, 10.0, &rollout);
    close(metrics.min_gap.unwrap().value, 20.0 - LENGTH_M, 1e-9);
    assert!(kinds(&rollout, &metrics).is_empty(), "traffic makes no near miss of the scenario");
}

#[test]
fn stuck_and_off_road_are_failures() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let mut rollout = rollout(drive(&way, 5.0, 121, |time| if time < 1.95 { 10.0 } else { 0.0 }), vec![]);
    rollout.termination.kind = TerminationKind::Stuck;
    let metrics = measure(&network, &way, 10.0, &rollout);
    let found = findings(&rollout, 0.0, &metrics, &CRITERIA);
    let stuck = found.iter().find(|finding| finding.kind == FindingKind::Stuck).unwrap();
    close(stuck.value, 10.1, 1e-9);
    rollout.termination.kind = TerminationKind::OffRoad;
    let metrics = measure(&network, &way, 10.0, &rollout);
    assert!(kinds(&rollout, &metrics).contains(&FindingKind::OffRoad));
}

#[test]
fn series_have_one_value_per_step() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let ego = drive(&way, 5.0, 31, |time| 20.0 - 2.0 * time);
    let leader = drive(&way, 45.0 + LENGTH_M, 31, |_| 15.0);
    let series = series(&rollout(ego, vec![leader]));
    assert_eq!(series.time_s.len(), 31);
    close(series.time_s[30], 3.0, 1e-12);
    assert!(series.ego_acceleration_mps2.iter().all(|a| (a + 2.0).abs() < 1e-9));
    let partner = &series.partners[0];
    for all in [&partner.gap_m, &partner.centre_distance_m, &partner.speed_mps, &partner.acceleration_mps2] {
        assert_eq!(all.len(), 31);
    }
    close(partner.gap_m[10], 40.0 - 4.0, 1e-9);
    close(partner.ttc_s[10].unwrap(), 36.0 / 3.0, 1e-9);
    assert_eq!(partner.ttc_s[30], None);
    let text = serde_json::to_string(&series).unwrap();
    assert_eq!(serde_json::from_str::<recrash_model::metrics::Series>(&text).unwrap(), series);
}

#[test]
fn broken_rollouts_do_not_panic() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let mut none = rollout(drive(&way, 5.0, 5, |_| 10.0), vec![drive(&way, 45.0, 3, |_| 10.0)]);
    let metrics = measure(&network, &way, 10.0, &none);
    assert_eq!(metrics.partners.len(), 1);
    none.actors[0].states[2].x = f64::NAN;
    none.actors[1].states[0].vx = f64::INFINITY;
    let metrics = measure(&network, &way, 10.0, &none);
    assert!(metrics.partners.is_empty() && metrics.min_gap.is_none());
    let text = serde_json::to_string(&metrics).unwrap();
    assert_eq!(serde_json::from_str::<Metrics>(&text).unwrap(), metrics);
    none.events.push(Event {
        time_s: 0.1,
        kind: EventKind::Contact { a: 0, b: 9, a_state: Default::default(), b_state: Default::default() },
    });
    none.actors[0].states.clear();
    none.obstacles.push(cone(3.0, 0.0));
    let metrics = measure(&network, &way, 10.0, &none);
    assert!(findings(&none, 0.0, &metrics, &CRITERIA).is_empty());
    none.actors.clear();
    assert!(measure(&network, &way, 10.0, &none).contact.is_none());
    assert!(series(&none).time_s.is_empty());
}

#[test]
fn the_gap_to_a_turned_leader_ends_at_its_corner_and_not_at_its_shadow() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let ego = drive(&way, 5.0, 1, |_| 10.0);
    // It cuts out to the left by 30 degrees, 12 m ahead; its rear right corner alone is still in the ego's way, by a hair.
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    let y = ego[0].y + 0.5 * WIDTH_M + 0.5 * LENGTH_M * sin + 0.5 * WIDTH_M * cos - 1e-6;
    let leader = glide(ego[0].x + 12.0, y, FRAC_PI_2 / 3.0, 5.0, 1);
    let metrics = measure(&network, &way, 10.0, &rollout(ego, vec![leader]));
    let gap = 12.0 - 0.5 * LENGTH_M - (0.5 * LENGTH_M * cos - 0.5 * WIDTH_M * sin);
    let drac = (10.0 - 5.0 * cos) * (10.0 - 5.0 * cos) / (2.0 * gap);
    close(metrics.partners[0].max_drac.unwrap().value, drac, 1e-5);
    close(metrics.partners[0].min_headway.unwrap().value, gap / 10.0, 1e-5);
}

#[test]
fn who_slides_sideways_comes_nearer_though_he_points_along() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    let ego = drive(&way, 5.0, 10, |_| 8.0);
    let slide = |state: &ActorState| ActorState { vy: -0.5, ..*state };
    let beside: Vec<ActorState> = glide(ego[0].x, ego[0].y + WIDTH_M + 1.5, 0.0, 8.0, 1).iter().map(slide).collect();
    let metrics = measure(&network, &way, 8.0, &rollout(ego, vec![beside]));
    // 1.5 m between the sides at 0.5 m/s.
    close(metrics.partners[0].min_ttc.unwrap().value, 3.0, 1e-9);
}

#[test]
fn braking_that_a_rollout_begins_with_is_no_phantom() {
    let network = straight();
    let way = path(&network, Approach::Same, Turn::Straight, 1);
    // 2 g for two steps, from the beginning or after a second.
    let braking = |from_s: f64| move |time: f64| 15.0 - 19.6 * (time - from_s).clamp(0.0, 0.2);
    let phantom = |from_s: f64| {
        let ego = drive(&way, 5.0, 40, braking(from_s));
        measure(&network, &way, 15.0, &rollout(ego, vec![])).ego.phantom_braking
    };
    assert_eq!(phantom(0.0), None);
    close(phantom(1.0).unwrap().value, 19.6, 1e-6);
}
