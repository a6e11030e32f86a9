//! Others are ahead, across or on the other side as they are told, and lights are what the two, and those who come through, go by.

use crate::others::{shown_but, told, track};
use crate::ways::{before_contact, made, speeds, story};
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::scenario::{Actor, ActorPlan, Aspect, Device, Leg, Place};
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};
use recrash_sim::{Ego, simulate};

const AT_YELLOW: &str = "The AV was traveling north on Elm Street. The traffic light at Oak Street changed to yellow, and the AV came to a stop. A van approached from \
                         behind and the front of the van made contact with the rear of the stationary AV.";
const COMES_OVER: &str = "The AV was stopped at a red light at the intersection of Elm Street and Oak Street, facing north. A sedan traveling south on Elm Street crossed over \
                          the center line and the front left of the sedan made contact with the front left of the AV.";
const RIGHT_AFTER_CROSS: &str = "The AV was stopped at a red light at the intersection of Elm Street and Oak Street. After cross traffic cleared, the AV began to turn right onto Oak \
                                 Street, and the front right of the AV made contact with a pedestrian who stepped off the curb on the right.";
const AHEAD_OF_BUS: &str = "The AV was traveling south on Elm Street when it began to change to the left lane in order to get ahead of a bus that was slowing for a stop. The left side of \
                            the AV made contact with the right side of a sedan traveling in the left lane.";
const SLOW_LINE: &str = "The AV was traveling in the right lane of Elm Street behind a line of slow traffic. The AV began to change lanes to the left, and the left side of the AV made \
                         contact with the front right of a sedan traveling in the left lane.";
const IN_FRONT: &str = "The AV was stopped on Elm Street, waiting for the cars in front to clear the next intersection. A sedan parked at the right curb pulled out, and the front left of the \
                        sedan made contact with the right side of the AV.";
const ROUND_TAXI: &str = "The AV was stopped beside the curb on Elm Street, heading north. On the southbound side a taxi was double parked. A van traveling south pulled out to the left around \
                          the taxi, and the front left of the van made contact with the front left of the AV.";
const ACROSS_JUNCTION: &str = "The AV was stopped facing east on Elm Street, yielding to a queue of stopped traffic ahead of the AV across the intersection with Oak Street, and the traffic light \
                               was green. A van approached from behind and the front of the van made contact with the rear of the stationary AV.";
const SECOND_IN_LINE: &str = "The AV was stopped at a red light at the intersection of Elm Street and Oak Street, second in line. A van approached from behind and the front of the van made \
                              contact with the rear of the stationary AV.";
const TWO_KINDS: &str = "The AV was waiting behind a delivery van and a sedan held by a red light at the intersection of Elm Street and Oak Street. A pickup approached from behind and the \
                         front of the pickup made contact with the rear of the stationary AV.";
const BUS_BESIDE: &str = "The AV was traveling west in the rightmost lane on Elm Street, approaching the intersection with Oak Street. A bus in the leftmost lane came to a stop. The AV entered \
                          the intersection as a pickup traveling east executed a left turn, and the front of the pickup made contact with the left side of the AV.";

const FROM_CROSS_STREET: &str = "The AV was traveling northbound on Elm Street, approaching the intersection with Oak Street. A sedan on the cross street did not stop and hit the side of an SUV that was \
                                 traveling southbound on Elm Street. The AV braked to a stop. The SUV was pushed across the center line, and the front left of the SUV made contact with \
                                 the front left of the stopped AV.";
const FAST: &str = "The AV came to a stop in a queue of traffic on Elm Street, and a sedan came to a stop behind the AV. An SUV approached from behind at a high rate of speed and made contact with \
                    the rear of the sedan, and the front of the sedan made contact with the rear of the stationary AV.";
const SLOWED_AHEAD: &str = "The AV was traveling east on Elm Street. A westbound SUV was slowing for a driveway when a pickup truck ran into it from behind. The SUV was thrown across the yellow \
                            line, and the front of the AV made contact with the front of the SUV.";

/// What a light shows. [s]
fn shows(made: &Reconstruction, arm: &str, at_s: f64) -> Option<Aspect> {
    made.draft.control.iter().find(|control| control.at == arm)?.device.aspect(at_s)
}

fn at_contact_s(made: &Reconstruction) -> f64 {
    0.1 * before_contact(made) as f64
}

#[test]
fn who_stops_for_a_yellow_light_brakes_when_it_is_yellow() {
    let account = told(AT_YELLOW);
    let shown = made(&account);
    let speeds = speeds(&shown);
    let brakes_s = 0.1 * speeds.iter().position(|speed| *speed < speeds[0] - 0.1).expect("it brakes") as f64;
    assert_eq!(shows(&shown, "own-", brakes_s), Some(Aspect::Yellow), "{brakes_s}");
    // One that turns yellow when the ego stands is not what it stopped for.
    let mut late = shown.draft.clone();
    for control in &mut late.control {
        if let Device::Signal { program, .. } = &mut control.device {
            program[0].for_s = at_contact_s(&shown) - 0.5;
        }
    }
    let scenario = recrash_roads::check(late).expect("it can run").value;
    let verdict = held_against(&account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
    let light = verdict.checks.iter().find(|check| check.kind == CheckKind::SvControl).expect("it is told");
    assert_eq!(light.result, CheckResult::NotShown, "{light:?}");
}

#[test]
fn who_comes_through_the_junction_to_an_ego_at_red_does_so_at_green() {
    let shown = made(&story(COMES_OVER));
    let arms = ["own-", "ahead-", "left-"].map(|arm| shows(&shown, arm, 1.0));
    assert_eq!(arms, [Some(Aspect::Red), Some(Aspect::Green), Some(Aspect::Red)]);
}

#[test]
fn who_turns_right_at_red_once_cross_traffic_has_cleared_does_so_at_red() {
    let shown = reconstruct(&story(RIGHT_AFTER_CROSS)).expect("it can be staged");
    assert_eq!(shows(&shown, "own-", at_contact_s(&shown)), Some(Aspect::Red));
}

type Change = fn(&mut Actor);

/// It comes along the other side of the road, towards the ego.
fn comes_towards(actor: &mut Actor) {
    let Place::Plane { x_m, y_m, .. } = actor.plan.start else { return };
    let course = vec![Leg::Curve { to: Place::at(x_m - 200.0, y_m + 6.8, 180.0), reverse: false }];
    let start = Place::at(x_m + 40.0, y_m + 6.8, 180.0);
    actor.plan = ActorPlan { speed_mps: 12.0, course, ..ActorPlan::standing(start) };
}

/// It drives on from the start.
fn drives(actor: &mut Actor) {
    let Place::Plane { x_m, y_m, heading_deg } = actor.plan.start else { return };
    let to = Place::at(x_m + 200.0, y_m, heading_deg);
    (actor.plan.speed_mps, actor.plan.course) = (12.0, vec![Leg::Curve { to, reverse: false }]);
}

#[test]
fn for_whom_the_ego_changes_lanes_or_waits_is_ahead_of_it_in_its_lane() {
    let all: [(&str, &str, Change); 3] =
        [(AHEAD_OF_BUS, "near", comes_towards), (SLOW_LINE, "near", comes_towards), (IN_FRONT, "lead", drives)];
    for (text, id, otherwise) in all {
        let shown = shown_but(text, id, otherwise);
        let (first, ego) = (track(&shown, id).states[0], shown.rollout.ego_track().states[0]);
        assert!(first.x > ego.x && (first.y - ego.y).abs() < 1.0, "{text}: {first:?}");
        assert!(first.heading.abs() < 0.1, "{text}: {first:?}");
    }
}

#[test]
fn whom_an_oncoming_partner_goes_round_stands_in_its_lane() {
    let shown = made(&story(ROUND_TAXI));
    let (taxi, partner) = (track(&shown, "passed").states[0], track(&shown, "cp").states[0]);
    assert!((taxi.y - partner.y).abs() < 1.0 && taxi.x < partner.x, "{taxi:?}, {partner:?}");
    assert!(taxi.heading.abs() > 3.0 && taxi.speed() == 0.0, "{taxi:?}");
}

#[test]
fn a_queue_across_the_junction_stands_behind_it() {
    let shown = made(&told(ACROSS_JUNCTION));
    let last = before_contact(&shown);
    let ahead_m = track(&shown, "beyond").states[last].x - shown.rollout.ego_track().states[last].x;
    assert!(ahead_m > 20.0, "{ahead_m}");
    assert!(shown.rollout.actors.iter().all(|track| track.id != "lead"));
}

#[test]
fn ahead_of_the_second_in_line_one_stands() {
    let shown = made(&told(SECOND_IN_LINE));
    track(&shown, "lead");
    assert!(shown.rollout.actors.iter().all(|track| track.id != "lead-2"));
}

#[test]
fn two_of_two_kinds_stand_one_ahead_of_the_other() {
    let shown = made(&told(TWO_KINDS));
    let last = before_contact(&shown);
    let [van, sedan] = ["lead", "near"].map(|id| track(&shown, id).states[last]);
    assert!((van.y - sedan.y).abs() < 0.5 && (4.0..12.0).contains(&(sedan.x - van.x)), "{van:?}, {sedan:?}");
}

#[test]
fn who_stops_beside_an_ego_that_enters_the_junction_does_so_before_that() {
    let shown = made(&story(BUS_BESIDE));
    let (bus, ego) = (track(&shown, "near"), shown.rollout.ego_track());
    let last = before_contact(&shown);
    let aside_m = bus.states[last].y - ego.states[0].y;
    assert!((2.0..5.0).contains(&aside_m) && bus.states[last].x < ego.states[last].x, "{aside_m}");
}

#[test]
fn who_strikes_the_partner_from_the_cross_street_comes_along_that() {
    let turned = |actor: &mut Actor| {
        if let Place::Plane { heading_deg, .. } = &mut actor.plan.start {
            *heading_deg += 90.0;
        }
    };
    let shown = shown_but(FROM_CROSS_STREET, "pusher", turned);
    let (pusher, ego) = (track(&shown, "pusher").states[0], shown.rollout.ego_track().states[0]);
    assert!((pusher.heading + 1.57).abs() < 0.2 && pusher.y > ego.y + 10.0, "from the left: {pusher:?}");
}

/// A person, or a model, may give it any name.
#[test]
fn who_strikes_the_partner_first_is_known_by_that_and_not_by_its_name() {
    let account = told(FROM_CROSS_STREET);
    let mut draft = made(&account).draft;
    let pusher = draft.actors.iter_mut().find(|actor| actor.id == "pusher").expect("it is there");
    pusher.id = "truck-2".to_owned();
    let scenario = recrash_roads::check(draft).expect("it can run").value;
    let verdict = held_against(&account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
    let not_shown: Vec<&Check> = verdict.checks.iter().filter(|check| check.result != CheckResult::Shown).collect();
    assert!(not_shown.is_empty(), "{not_shown:?}");
}

#[test]
fn who_strikes_the_partner_fast_is_faster() {
    let usual = made(&told(&FAST.replace(" at a high rate of speed", "")));
    let [fast, usual] = [made(&told(FAST)), usual].map(|made| track(&made, "pusher").states[0].speed());
    assert!(fast > usual + 2.0, "{fast}, {usual}");
}

#[test]
fn who_strikes_the_rear_of_a_partner_that_slowed_came_behind_it() {
    let shown = reconstruct(&story(SLOWED_AHEAD)).expect("it can be staged");
    let [pusher, partner] = ["pusher", "cp"].map(|id| track(&shown, id).states[0]);
    assert!(pusher.x > partner.x + 4.0 && (pusher.y - partner.y).abs() < 5.0, "{pusher:?}, {partner:?}");
}
