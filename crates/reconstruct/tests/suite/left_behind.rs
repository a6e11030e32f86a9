//! Others stand where they hide the partner, or are passed between; and the ego is not where they are told to be.

use crate::others::{shown_but, told, track};
use crate::ways::{before_contact, made, story};
use recrash_model::account::{ContactState, Origin};
use recrash_model::scenario::{Actor, ActorPlan, Place};
use recrash_reconstruct::Reconstruction;

const EMERGED: &str = "The AV was driving east at the intersection of Elm Street and Oak Street on a green light. An SUV that was traveling north emerged from behind a stopped bus and \
                       ran the red light, and the front of the AV made contact with the left side of the SUV.";
const FROM_BETWEEN: &str = "The AV was driving north when a boy ran out from between two parked vans on the left. The AV braked and the front left of the AV made contact with the boy.";
const AT_ITS_KERB: &str = "The AV was stopped in a line of cars for a red light, with a van parked at the curb. A woman came off the sidewalk on the right and ran into the right side of the AV.";
const OTHER_LANE: &str = "The AV was facing west and had stopped to yield, as a truck was double parked in the eastbound lane. An eastbound pickup truck drifted to the left and the left side of the \
                          pickup truck made contact with the left side of the AV.";
const GUTTER: &str = "The AV was stopped at a red light on Elm Street. A bicyclist rode up between the AV and the curb and the handlebar made contact with the right side of the AV.";
const DROVE_BY: &str = "The AV was driving north on Elm Street. A box truck stood in the lane with its hazards on. The AV moved to the left and was driving by the truck when a man stepped out into \
                        the street from the right, and the right side of the AV made contact with the man.";

/// Somebody is put so far to the left of where it is, by the map's axis.
fn aside(by_m: f64) -> impl Fn(&mut Actor) {
    move |actor| {
        let Place::Plane { x_m, y_m, heading_deg } = actor.plan.start.clone() else { panic!("on a plane") };
        actor.plan = ActorPlan { start: Place::at(x_m, y_m + by_m, heading_deg), ..actor.plan.clone() };
    }
}

/// Where somebody is at the contact, seen from the ego: ahead, and to the left. [m]
fn seen(shown: &Reconstruction, id: &str) -> (f64, f64) {
    let last = before_contact(shown);
    let (own, other) = (&shown.rollout.ego_track().states[last], &track(shown, id).states[last]);
    (other.x - own.x, other.y - own.y)
}

#[test]
fn who_hides_the_partner_stands_between_the_two() {
    let shown = shown_but(EMERGED, "screen", aside(30.0));
    let (_, left_m) = seen(&shown, "screen");
    assert!((-4.5..-2.5).contains(&left_m), "in the next lane, on the right: {left_m}");
}

#[test]
fn the_partner_comes_out_between_the_two_that_are_parked() {
    let shown = made(&told(FROM_BETWEEN));
    let cp = track(&shown, "cp").states[before_contact(&shown)].x;
    let mut along: Vec<f64> = ["kerb", "kerb-2"].map(|id| track(&shown, id).states[0].x - cp).into();
    along.sort_by(f64::total_cmp);
    assert!(along[0] < -2.0 && along[1] > 2.0, "{along:?}");
    let left = |id: &str| seen(&shown, id).1 > 3.0;
    assert!(left("kerb") && left("kerb-2"), "both are parked on the told side");
}

#[test]
fn the_kerb_at_which_another_is_parked_is_not_the_egos_place() {
    let shown = made(&story(AT_ITS_KERB));
    let (lead_m, lead_left_m) = seen(&shown, "lead");
    assert!(lead_m > 4.0 && lead_left_m.abs() < 0.5, "it stands in the queue: {lead_m} {lead_left_m}");
    assert!(seen(&shown, "kerb").1 < -2.0, "and the van beside that");
}

#[test]
fn who_is_double_parked_in_the_lane_of_those_who_come_is_not_ahead_of_the_ego() {
    let shown = made(&told(OTHER_LANE));
    assert!(shown.rollout.actors.iter().all(|track| track.id != "lead"));
}

#[test]
fn no_lane_is_where_somebody_squeezes_by_the_kerb() {
    let account = story(GUTTER);
    assert_eq!(account.came_from.as_ref().map(|fact| fact.value), Some(Origin::Behind));
    let shown = made(&account);
    let last = before_contact(&shown);
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let ego = shown.rollout.ego_track().states[last].position();
    let beside = ego - recrash_model::geometry::Vec2::new(0.0, 3.4);
    let parking = recrash_model::geometry::Vec2::new(0.0, 1.7);
    assert!(scenario.network().on_road(ego - parking) && !scenario.network().on_road(beside), "the rightmost lane");
}

#[test]
fn who_is_driven_by_stands_on_the_side_that_the_ego_leaves() {
    let account = story(DROVE_BY);
    assert_eq!(account.sv.state.as_ref().map(|fact| fact.value), Some(ContactState::Moving));
    let shown = made(&account);
    let (ahead_m, left_m) = seen(&shown, "obstacle");
    assert!(left_m < -1.5 && ahead_m.abs() < 15.0, "{ahead_m} {left_m}");
}
