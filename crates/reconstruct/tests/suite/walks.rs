//! Who walks or rides where people walk, along the kerb, or beside the ego comes that way.

use crate::ways::{before_contact, made, partner, story};
use recrash_model::account::Account;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;
use recrash_reconstruct::{Reconstruction, held_against};
use recrash_roads::RoadPart;

const OVER_CROSSWALK: &str = "The AV was traveling north on Elm Street through the intersection with Oak Street on a green light. A cyclist who was riding on \
                              the sidewalk entered the crosswalk from the right, and the front of the AV made contact with the left side of the bicycle.";

const BESIDE: &str = "The AV was traveling north in the right lane of Elm Street. A van was next to it in the left lane. The van changed lanes to \
                      the right, and the right side of the van made contact with the left side of the AV.";

const CAME_UP: &str = "The AV was traveling north in the right lane of Elm Street. A van came up next to it in the left lane. The van changed lanes to \
                       the right, and the right side of the van made contact with the left side of the AV.";

const ALONG_KERB: &str = "The AV was stopped at the right curb of Elm Street to pick up a passenger. A cyclist who was traveling straight behind the AV looked \
                          back, and the front wheel of the bicycle made contact with the rear bumper of the AV.";

const SQUEEZED: &str = "The AV was stopped at a red light on Elm Street. A motorcycle came up from behind, passed the AV on the right between the AV and the \
                        curb, and the left side of the motorcycle made contact with the right side of the AV.";

/// What a changed rollout shows of from where the partner came.
fn approach(account: &Account, made: Reconstruction, change: impl Fn(&mut [ActorState])) -> CheckResult {
    let mut made = made;
    change(&mut made.rollout.actors[1].states);
    let scenario = recrash_roads::check(made.draft).expect("it can be drawn").value;
    let held = held_against(account, &scenario, &made.rollout).expect("told");
    held.checks.iter().find(|check| check.kind == CheckKind::Approach).expect("told").result
}

/// How far ahead of the ego the partner is in a step. [m]
fn ahead_m(made: &Reconstruction, step: usize) -> f64 {
    partner(made).0[step].x - made.rollout.ego_track().states[step].x
}

#[test]
fn a_rider_of_the_sidewalk_comes_over_the_crosswalk_and_along_no_lane() {
    let account = story(OVER_CROSSWALK);
    let shown = made(&account);
    let states = partner(&shown).0;
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let lanes = scenario.network();
    // Straight across, before the lanes of the road that crosses.
    let lane = |state: &ActorState| lanes.lane_at(state.position(), state.heading);
    let beside =
        |state: &ActorState| lane(state).is_none_or(|lane| lanes.road(lanes.lane(lane).road).part != RoadPart::Open);
    let until = before_contact(&shown);
    assert!(states[..until].iter().all(beside));
    assert!((states[0].x - states[until].x).abs() < 0.5, "{:?} {:?}", states[0], states[until]);
    // Along a lane it is none of the sidewalk.
    let down_lane = |states: &mut [ActorState]| states[..40].iter_mut().for_each(|state| state.x = 3.0);
    assert_eq!(approach(&account, shown, down_lane), CheckResult::NotShown);
}

#[test]
fn who_was_next_to_the_ego_does_not_come_from_far_behind() {
    let account = story(BESIDE);
    let shown = made(&account);
    assert!(ahead_m(&shown, 60).abs() < 5.0, "{}", ahead_m(&shown, 60));
    let behind = |states: &mut [ActorState]| states[..=60].iter_mut().for_each(|state| state.x -= 8.0);
    assert_eq!(approach(&account, shown, behind), CheckResult::NotShown);
    // Who came up did not drive beside it.
    let came_up = made(&story(CAME_UP));
    assert!(ahead_m(&came_up, 60) < -5.0, "{}", ahead_m(&came_up, 60));
}

#[test]
fn a_rider_behind_who_stands_at_the_kerb_is_not_steered_into_it() {
    let shown = made(&story(ALONG_KERB));
    let (states, met) = partner(&shown);
    assert!(states[0].heading.abs() < 0.02 && met.heading.abs() < 0.02, "{met:?}");
    assert!((states[0].y - met.y).abs() < 0.3, "{:?} {met:?}", states[0]);
}

#[test]
fn who_is_narrow_has_no_free_lane_between_the_ego_and_the_kerb() {
    let shown = made(&story(SQUEEZED));
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let state = &shown.rollout.ego_track().states[before_contact(&shown)];
    let network = scenario.network();
    let lane = network.lane_at(state.position(), state.heading).expect("a lane");
    assert_eq!(network.road(network.lane(lane).road).lanes.last(), Some(&lane));
}
