//! Others who have no part in what the ego does turn, pull out, go aside, pull over or come across, as they are told to; and a rollout in
//! which they do not does not pass for it.

use crate::others::{shown_but, told, track};
use crate::ways::{before_contact, degrees_between, made};
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Actor, ActorPlan, Deed, MapSpec, StripKind};

const TURNS: &str = "The AV was traveling north on Elm Street toward the intersection with Oak Street. A van traveling west on Oak Street turned right onto \
                     Elm Street. The AV continued straight.";
const PULLS_OUT: &str = "The AV was traveling east on Elm Street. A pickup truck pulled out of a parking space on the right side of the street.";
const SWERVES: &str = "The AV was traveling north in the right lane of two lanes on Elm Street. An SUV in the left lane swerved to the left.";
const PULLS_OVER: &str = "The AV was traveling north on Elm Street. A box truck ahead pulled over to the right.";
const RUNS: &str =
    "The AV was traveling east on Elm Street. A ball rolled into the roadway from the left side of the street.";
const ON_FOOT: &str = "The AV was traveling east on Elm Street. A pedestrian crossed the street.";

const OVER_THE_LINE: &str = "The AV was traveling south on Elm Street when a pickup truck facing east on Oak Street began a left turn onto Elm Street and crossed over the centerline, \
                             drifting toward the AV. The AV drifted to the right and the front right of the AV made contact with the front left of a sedan that was parked \
                             at the curb.";

fn stands(actor: &mut Actor) {
    actor.plan = ActorPlan::standing(actor.plan.start.clone());
}

fn keeps_line(actor: &mut Actor) {
    actor.plan.acts.retain(|act| !matches!(act.deed, Deed::Shift { .. }));
}

#[test]
fn who_turns_from_the_crossing_road_does() {
    let shown = shown_but(TURNS, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track().states[0];
    assert!(degrees_between(near.states[0].heading, ego.heading + 0.5 * std::f64::consts::PI) < 10.0);
    assert!(degrees_between(near.states[last].heading, ego.heading) < 45.0, "{:?}", near.states[last]);
}

#[test]
fn who_pulls_out_stood_at_the_kerb() {
    let shown = shown_but(PULLS_OUT, "near", keeps_line);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert_eq!(near.states[0].speed(), 0.0);
    assert!(near.states[last].y > near.states[0].y + 1.0, "{:?}", near.states[last]);
}

#[test]
fn who_swerves_does_so_in_its_lane_to_the_told_side() {
    let shown = shown_but(SWERVES, "near", keeps_line);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let moved_m = near.states[last].y - near.states[0].y;
    assert!((0.4..1.2).contains(&moved_m), "{moved_m}");
}

#[test]
fn who_pulls_over_slows_and_goes_aside() {
    let shown = shown_but(PULLS_OVER, "near", keeps_line);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!(near.states[last].y < near.states[0].y - 0.4 && near.states[last].speed() < near.states[0].speed() - 1.0);
}

#[test]
fn what_rolls_into_the_road_comes_from_the_told_side() {
    let shown = shown_but(RUNS, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert_eq!(near.kind, PartnerKind::FixedObject);
    assert!(near.states[0].y > near.states[last].y + 2.0, "{:?}", near.states[last]);
}

#[test]
fn who_crosses_and_is_nobodys_reason_to_stop_crosses_nearby() {
    let shown = shown_but(ON_FOOT, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!((near.states[0].y - near.states[last].y).abs() > 2.0, "{:?}", near.states[last]);
}

#[test]
fn who_turns_and_drifts_does_both_at_a_junction_of_the_street() {
    let shown = shown_but(OVER_THE_LINE, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!(degrees_between(near.states[last].heading, near.states[0].heading) > 40.0, "{:?}", near.states[last]);
    let MapSpec::G(map) = &shown.draft.map else { panic!("a graph") };
    assert_eq!(map.junctions.len(), 1);
    assert!(map.roads[0].left.iter().any(|strip| strip.kind == StripKind::Parking));
}

const ROUND_IT: &str = "The AV was traveling south in the center lane of three lanes on Elm Street. A sedan ahead of the AV swerved to avoid a mattress, and the front of the AV \
                        made contact with the mattress.";
const LETS_BY: &str = "The AV was traveling south on Elm Street toward the intersection with Oak Street, about to make a left turn onto Oak Street. A sedan to the left of the AV \
                       passed the AV. The AV began to make the left turn, and a van behind the AV made contact with the rear right of the AV.";

#[test]
fn who_swerves_round_a_thing_ahead_was_in_the_egos_lane_and_leaves_it_late() {
    let shown = shown_but(ROUND_IT, "near", keeps_line);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track();
    let aside_m = |step: usize| (near.states[step].y - ego.states[0].y).abs();
    assert!(aside_m(0) < 0.5 && aside_m(last) > 1.2, "{:?}", near.states[last]);
    assert!(aside_m(last.saturating_sub(50)) < 0.5, "{:?}", near.states[last - 50]);
}

#[test]
fn what_rolls_into_the_road_lies_at_its_edge_before() {
    let shown = made(&told(RUNS));
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    assert!(near.states[0].speed() == 0.0 && near.states[0].y - near.states[last].y < 8.0, "{:?}", near.states[0]);
}

#[test]
fn an_ego_that_turns_left_lets_somebody_by_in_a_lane_on_its_left() {
    let shown = shown_but(LETS_BY, "near", stands);
    let (near, last) = (track(&shown, "near"), before_contact(&shown));
    let ego = shown.rollout.ego_track();
    assert!(near.states[0].x < ego.states[0].x && near.states[last].x > ego.states[last].x, "{:?}", near.states[last]);
    assert!((2.5..4.5).contains(&(near.states[0].y - ego.states[0].y)), "{:?}", near.states[0]);
}
