//! Others who have no part in what the ego does are near it, where they are told, and do what is told; and a rollout in which they do not
//! does not pass for it.

use crate::others::{shown_but, told, track};
use crate::ways::{before_contact, degrees_between, made};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::CheckKind;
use recrash_model::scenario::{Actor, ActorPlan, Deed, Place};

const SIREN: &str =
    "The AV was traveling westbound on Elm Street when it detected a siren from a nearby emergency vehicle and slowed.";
const LEADS: &str = "The AV was traveling east on Elm Street when a garbage truck ahead of the AV continued forward. The front of the AV made contact with \
                     a mattress in the road.";
const FOLLOWS: &str = "The AV was stopped behind an SUV on Elm Street. The SUV began to reverse, and the AV reversed until it came to a stop in front of a van \
                       behind it. The SUV continued to reverse and the rear of the SUV made contact with the front of the AV.";
const WATCHES: &str = "A pedestrian was standing on the sidewalk. The AV was traveling north on Elm Street.";
const PASSES: &str =
    "The AV was parked at the curb facing east on Elm Street when a pickup truck passed the AV on the left.";
const TURNS: &str = "The AV was traveling south on Elm Street and approached a green light at the intersection with Oak Street. A motorcycle traveling north on Elm Street \
                     turned left onto Oak Street, and the AV slowed to a stop.";

const CHANGES: &str = "The AV was traveling north in the rightmost lane of three lanes on Elm Street. An SUV in the leftmost lane changed lanes to the right \
                       in front of a sedan.";

const BACKS: &str = "The AV was traveling west on Elm Street and came to a stop behind a van. Another sedan in a nearby angled parking space reversed. The van began \
                     to reverse and the rear of the van made contact with the front of the AV.";
const ALONGSIDE: &str = "The AV was stopped at a red light in the left lane on Elm Street alongside an SUV in the right lane. When the light turned green, both the AV \
                         and the adjacent SUV proceeded into the intersection with Oak Street. A van traveling west on Oak Street ran the red light and the front left \
                         of the van made contact with the front right of the AV.";
const FENCE: &str =
    "The AV was traveling west and began to slow due to construction fencing that was intruding into its lane.";

fn far_off(actor: &mut Actor) {
    let start = match &actor.plan.start {
        Place::Plane { x_m, y_m, heading_deg, .. } => Place::at(x_m - 150.0, y_m + 90.0, *heading_deg),
        other => other.clone(),
    };
    actor.plan = ActorPlan::standing(start);
}

fn stands(actor: &mut Actor) {
    actor.plan = ActorPlan::standing(actor.plan.start.clone());
}

#[test]
fn who_is_told_nowhere_is_in_sight_and_said_to_be_assumed() {
    // Neither where it is nor what it does is told: nothing is looked at.
    let shown = made(&told(SIREN));
    assert!(shown.verdict.checks.iter().all(|check| check.kind != CheckKind::Others), "{:?}", shown.verdict);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert_eq!(near.kind, PartnerKind::FirstResponder);
    assert!(near.states[last].position().distance(ego.position()) < 45.0, "{:?}", near.states[last]);
    assert!(shown.assumed.iter().any(|words| words.contains("near")), "{:?}", shown.assumed);
}

#[test]
fn who_drives_ahead_goes_on_ahead() {
    let shown = shown_but(LEADS, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert!(near.states[last].x > ego.x + 4.0 && near.states[last].speed() > 1.0, "{:?}", near.states[last]);
}

#[test]
fn who_is_behind_is_behind() {
    let shown = shown_but(FOLLOWS, "near", far_off);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!(near.states[last].x < shown.rollout.ego_track().states[last].x - 4.0);
}

#[test]
fn who_stands_beside_the_road_on_foot_is_off_the_lanes() {
    let shown = shown_but(WATCHES, "near", |near| near.kind = PartnerKind::Cyclist);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    assert!(near.states[last].speed() < 0.1 && !scenario.network().on_road(near.states[last].position()));
}

#[test]
fn who_passes_was_behind_and_is_ahead() {
    let shown = shown_but(PASSES, "near", far_off);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track();
    assert!(near.states[0].x < ego.states[0].x && near.states[last].x > ego.states[last].x);
    assert!(near.states[last].y > ego.states[last].y + 1.0, "on the left");
}

#[test]
fn who_turns_left_from_ahead_crosses_the_egos_line() {
    let shown = shown_but(TURNS, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[0];
    assert_eq!(near.kind, PartnerKind::Motorcycle);
    assert!(degrees_between(near.states[0].heading, ego.heading) > 150.0);
    assert!(near.states[0].y > ego.y && near.states[last].y < ego.y, "{:?}", near.states[last]);
}

#[test]
fn who_changes_lanes_does_so_to_the_told_side() {
    let shown = shown_but(CHANGES, "near", |near| {
        near.plan.acts.retain(|act| !matches!(act.deed, Deed::Shift { .. }));
    });
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[last];
    assert!(near.states[0].y > ego.y + 4.0 && near.states[last].y < near.states[0].y - 2.4, "{:?}", near.states[last]);
}

#[test]
fn who_backs_out_where_no_place_is_told_does_so_near() {
    let shown = shown_but(BACKS, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!((0..last).any(|step| near.states[step].speed() < -0.5), "{:?}", near.states[last]);
}

#[test]
fn who_drives_into_the_junction_beside_the_ego_is_beside_it() {
    let shown = shown_but(ALONGSIDE, "near", far_off);
    let (near, ego) = (track(&shown, "near"), shown.rollout.ego_track());
    assert!((0..before_contact(&shown)).any(|step| near.states[step].y < ego.states[step].y - 1.5));
}

#[test]
fn a_fence_that_is_told_of_stands_beside_the_way() {
    let shown = shown_but(FENCE, "near", far_off);
    let near = track(&shown, "near");
    assert_eq!(near.kind, PartnerKind::FixedObject);
    assert!(near.states.iter().all(|state| state.speed() == 0.0));
}

const LIES_AHEAD: &str = "The AV was traveling east on Elm Street when a sedan ahead of the AV continued forward. The front of the AV made contact with a dog that was lying in \
                          the road.";

#[test]
fn who_drives_ahead_of_something_that_lies_in_the_lane_has_gone_round_it_there() {
    let shown = made(&told(LIES_AHEAD));
    let (near, ego, last) = (track(&shown, "near"), shown.rollout.ego_track(), before_contact(&shown));
    assert!((near.states[0].y - ego.states[0].y).abs() < 0.5, "{:?}", near.states[0]);
    assert!(near.states[last].x > ego.states[last].x && (near.states[last].y - ego.states[last].y).abs() > 1.2);
}

const FOLLOWED: &str = "The AV was traveling north on Elm Street with a bus traveling behind the AV. The front of the AV made contact with a mattress in the road.";
const GAP: &str = "The AV was pulling out of a parking space at the right curb and came to a stop partly in the lane to wait for a gap in passing traffic. A van ahead of the \
                   AV reversed and the rear of the van made contact with the front right of the AV.";

#[test]
fn who_is_behind_an_ego_that_drives_follows_it() {
    let shown = shown_but(FOLLOWED, "near", far_off);
    let (near, ego, last) = (track(&shown, "near"), shown.rollout.ego_track(), before_contact(&shown));
    assert!((0..=last).all(|step| near.states[step].x < ego.states[step].x && near.states[step].speed() > 3.0));
}

#[test]
fn traffic_for_a_gap_in_which_the_ego_waits_goes_its_way() {
    let shown = shown_but(GAP, "near", stands);
    let (near, ego, last) = (track(&shown, "near"), shown.rollout.ego_track(), before_contact(&shown));
    assert!(degrees_between(near.states[0].heading, ego.states[0].heading) < 10.0, "{:?}", near.states[0]);
    assert!(near.states[0].x < ego.states[0].x && near.states[last].x > ego.states[last].x, "{:?}", near.states[last]);
}
