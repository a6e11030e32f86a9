//! Who walks or rides where people walk, along the kerb, or beside the ego comes that way.

use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::account::{Account, Fact, PlaceKind};
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

const RAN_OUT: &str = "The AV was traveling north on Elm Street. A pedestrian ran across the street from the right, and the front of the AV made \
                       contact with the pedestrian.";

const DEER: &str = "The AV was traveling north in the right lane of a highway. A deer ran across the road from the right, and the front of the AV made \
                    contact with the deer.";

const SIDEWALK_RIDER: &str = "The AV was traveling west on Oak Street through the intersection with Elm Street on a green light. A scooterist who was traveling \
                              south on the sidewalk of Elm Street entered the intersection against a red light and made contact with the right side of \
                              the AV.";

const SHORT_OF_WALK: &str = "The AV was traveling in the right lane of Elm Street, approaching the intersection with Oak Street. A pedestrian stepped off the \
                             right curb ahead of the crosswalk and walked into the right side of the AV.";

const BEHIND_BACKING: &str = "The AV was reversing in a parking lot. A man was walking behind the AV, and the rear bumper of the AV made contact with the man.";

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

#[test]
fn who_runs_stood_on_the_sidewalk_and_is_faster_than_who_walks() {
    let shown = made(&story(RAN_OUT));
    let (states, met) = partner(&shown);
    assert!(states[0].speed() == 0.0 && met.speed() > 2.5, "{:?} {met:?}", states[0]);
    let aside_m = shown.rollout.ego_track().states[0].y - states[0].y;
    assert!((4.0..9.0).contains(&aside_m), "{aside_m}");
    // Who walks is slower, and no rollout in which it walks shows that it ran.
    let walked = made(&story(&RAN_OUT.replace("ran across", "walked across")));
    assert!(partner(&walked).1.speed() < 2.0, "{:?}", partner(&walked).1);
    let scenario = recrash_roads::check(walked.draft).expect("it can be drawn").value;
    let held = held_against(&story(RAN_OUT), &scenario, &walked.rollout).expect("told");
    let state = held.checks.iter().find(|check| check.kind == CheckKind::CpState).expect("told");
    assert_eq!(state.result, CheckResult::NotShown, "{state:?}");
}

#[test]
fn an_animal_on_a_highway_comes_over_its_edge_and_by_no_other_road() {
    let account = story(DEER);
    let shown = made(&account);
    assert!(shown.draft.map.network().is_some_and(|map| map.junctions.is_empty()));
    assert_eq!(partner(&shown).0[0].speed(), 0.0);
}

#[test]
fn a_rider_along_the_sidewalk_of_the_crossing_road_keeps_to_it() {
    let shown = made(&story(SIDEWALK_RIDER));
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let lanes = scenario.network();
    let lane = |state: &ActorState| lanes.lane_at(state.position(), state.heading);
    let beside =
        |state: &ActorState| lane(state).is_none_or(|lane| lanes.road(lanes.lane(lane).road).part != RoadPart::Open);
    assert!(partner(&shown).0[..40].iter().all(beside));
    // Who came along the street did so in a lane.
    let street = made(&story(&SIDEWALK_RIDER.replace("on the sidewalk of Elm Street", "on Elm Street")));
    assert!(!beside(&partner(&street).0[0]), "{:?}", partner(&street).0[0]);
}

#[test]
fn who_steps_off_the_kerb_short_of_the_crosswalk_does_so_before_the_junction() {
    let met_m = |text: &str| {
        let mut account = story(text);
        account.place.kind = Some(Fact::by_rule(PlaceKind::Intersection, "made for this test"));
        let shown = made(&account);
        shown.rollout.ego_track().states[before_contact(&shown)].x
    };
    let walk = met_m(&SHORT_OF_WALK.replace("right curb ahead of the crosswalk", "right curb into the crosswalk"));
    assert!(met_m(SHORT_OF_WALK) < walk, "{walk}");
}

#[test]
fn who_walks_behind_an_ego_that_backs_crosses_behind_it() {
    let shown = made(&story(BEHIND_BACKING));
    let met = partner(&shown).1;
    assert!(degrees_between(met.heading, shown.rollout.ego_track().states[0].heading) > 45.0, "{met:?}");
    // Who stood there did not walk up to it.
    let stood = made(&story(&BEHIND_BACKING.replace("was walking behind", "was standing behind")));
    assert!(degrees_between(partner(&stood).1.heading, stood.rollout.ego_track().states[0].heading) < 45.0);
}
