//! Where who stands does so before anything happens, and from where who stood sets off.

use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;
use recrash_model::scenario::{Act, Deed, Leg, MapSpec, Place, ScenarioDraft};
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};
use recrash_sim::{Ego, simulate};

const PUSHED_PARKED: &str = "The AV was stopped on Elm Street for a passenger drop-off. Behind it a sedan was parked at the curb with no one inside. A pickup truck drifted to the \
                             right and ran into the back of the sedan, and the sedan was pushed into the rear of the AV.";

const ALL_WAY: &str = "The AV made its full stop at an all-way stop at the intersection of Elm Street and Oak Street and began to cross. A sedan that had stopped on the street \
                       to the left set off at the same moment. The left front corner of the AV and the right front corner of the sedan met.";

const INTO_A_GAP: &str = "The AV was traveling west on Elm Street when it pulled into a gap on the right and stopped to let an oncoming van go by. The left side of the van made \
                          contact with the left side of the stationary AV.";

const U_TURN: &str = "The AV was traveling west on Elm Street when a sedan that had been standing at the north curb set off and made a U-turn ahead of the AV. The front of the \
                      AV struck the left side of the sedan.";

const AISLE: &str = "The AV was traveling east in an aisle of a parking lot and came to a stop at the end of the aisle. An SUV traveling north in the crossing aisle turned \
                     left into the aisle of the AV, and the left side of the SUV made contact with the front left of the stationary AV.";

const ALONGSIDE: &str = "The AV was traveling in the middle of three lanes and moved toward the right lane. A sedan was already alongside in that lane, a little behind its \
                         midpoint. The right rear of the AV made contact with the front left of the sedan.";

fn junctions(made: &Reconstruction) -> usize {
    let MapSpec::G(map) = &made.draft.map else { panic!("a map of roads") };
    map.junctions.len()
}

/// Where somebody stood last before it touched.
fn stood_last(states: &[ActorState], last: usize) -> ActorState {
    *states[..last].iter().rfind(|state| state.velocity().length() < 0.1).expect("it stood")
}

#[test]
fn who_is_parked_stands_until_another_pushes_it() {
    let account = story(PUSHED_PARKED);
    let shown = made(&account);
    let (states, _) = partner(&shown);
    assert!(states[..80].iter().all(|state| state.velocity().length() < 0.1), "it stands");
    let ego = shown.rollout.ego_track().states[0];
    assert!(ego.y < -2.0 && (states[0].y - ego.y).abs() < 1.0, "both at the kerb: {ego:?}, {:?}", states[0]);
    // One that drove up is not one that was parked.
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let mut came = shown.rollout.clone();
    let cp = came.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
    cp.states[..40].iter_mut().for_each(|state| state.vx = 5.0);
    let verdict = held_against(&account, &scenario, &came).expect("it can be held");
    let state = verdict.checks.iter().find(|check| check.kind == CheckKind::CpState).expect("it is told");
    assert_eq!(state.result, CheckResult::NotShown, "{state:?}");
}

#[test]
fn where_all_stop_both_set_off_from_their_lines() {
    let shown = made(&story(ALL_WAY));
    let last = before_contact(&shown);
    let ego = stood_last(&shown.rollout.ego_track().states, last);
    let (states, met) = partner(&shown);
    let sedan = stood_last(states, last);
    // A junction of two lanes each way reaches 13 m to each side.
    assert!(ego.x < -13.0, "{ego:?}");
    assert!((sedan.y - met.y).abs() > 8.0, "{sedan:?}, {met:?}");
}

#[test]
fn who_pulls_into_a_gap_for_one_that_comes_does_so_on_the_right() {
    let shown = made(&story(INTO_A_GAP));
    let states = &shown.rollout.ego_track().states;
    assert!(states[before_contact(&shown)].y < states[0].y - 1.0, "{:?}", states[before_contact(&shown)]);
}

#[test]
fn who_turns_round_from_the_kerb_stood_there_and_needs_no_junction() {
    let shown = made(&story(U_TURN));
    let (states, met) = partner(&shown);
    assert_eq!(junctions(&shown), 0);
    assert!(states[0].y < -2.4 && states[0].velocity().length() < 0.1, "{:?}", states[0]);
    assert!(degrees_between(met.heading, states[0].heading) > 60.0, "{met:?}");
}

#[test]
fn aisles_cross_where_somebody_turns_out_of_one() {
    let shown = made(&story(AISLE));
    let (states, _) = partner(&shown);
    assert_eq!(junctions(&shown), 1);
    assert!(states[..60].iter().all(|state| state.velocity().length() > 1.0), "it comes along");
}

#[test]
fn who_was_alongside_already_is_so_as_the_ego_moves_over() {
    let shown = made(&story(ALONGSIDE));
    let ego = shown.rollout.ego_track();
    let moves = ego.states.iter().position(|state| state.heading.abs() > 0.01).expect("it moves over");
    let (states, _) = partner(&shown);
    let behind_m = ego.states[moves].x - states[moves].x;
    assert!((0.0..6.0).contains(&behind_m), "{behind_m} m behind");
}

const BACKS_ALREADY: &str = "The AV was traveling south on Elm Street when it came to a stop to yield to an SUV. The SUV ahead was rolling backwards. The AV began to reverse. The SUV \
                             continued to roll backwards and the rear of the SUV made contact with the front of the AV.";

const COMES_OVER: &str = "The AV was traveling west on Elm Street. A heavy truck traveling east began maneuvering left into the path of the AV and the AV came to a stop. The truck \
                          continued and the front left of the truck made contact with the front left of the AV.";

const AS_IT_TURNS: &str = "The AV was traveling south on Elm Street when it began to slow for a left turn. As the AV began the left turn, a sedan that was stopped at the stop sign on \
                           Oak Street to the left proceeded straight into the intersection, and the front of the sedan made contact with the left side of the AV.";

/// The first step at which the ego has slowed.
fn brakes(made: &Reconstruction) -> usize {
    let states = &made.rollout.ego_track().states;
    states.iter().position(|state| state.speed() < states[0].speed() - 0.3).expect("it brakes")
}

#[test]
fn who_backs_as_the_ego_comes_does_so_before_that_brakes() {
    let shown = made(&story(BACKS_ALREADY));
    let (states, _) = partner(&shown);
    assert!(states[brakes(&shown)].speed() < -0.1, "{:?}", states[brakes(&shown)]);
    // "The AV came to a stop behind an SUV. The SUV then began to back": it stood first.
    let then =
        BACKS_ALREADY.replace("The SUV ahead was rolling backwards.", "The SUV ahead then began to roll backwards.");
    let later = made(&story(&then));
    let (states, _) = partner(&later);
    assert!(states[brakes(&later)].speed() > -0.1, "{:?}", states[brakes(&later)]);
}

#[test]
fn an_ego_that_stops_for_who_comes_over_brakes_when_that_has_begun_to() {
    let account = story(COMES_OVER);
    let shown = made(&account);
    let (states, _) = partner(&shown);
    let at = brakes(&shown) + 10;
    assert!((states[at].y - states[0].y).abs() > 0.05, "{:?}", states[at]);
    // One that comes over when the ego stands is not why it stopped.
    let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
    let mut late = shown.rollout.clone();
    let last = before_contact(&shown);
    let cp = late.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
    let y_m = cp.states[0].y;
    cp.states[..last - 12].iter_mut().for_each(|state| (state.y, state.heading) = (y_m, std::f64::consts::PI));
    let verdict = held_against(&account, &scenario, &late).expect("it can be held");
    let acts = verdict.checks.iter().find(|check| check.kind == CheckKind::SvActs).expect("they are told");
    assert_eq!(acts.result, CheckResult::CannotBeShown, "{acts:?}");
}

#[test]
fn who_is_told_to_set_off_as_the_ego_begins_its_turn_does_so_then() {
    let shown = made(&story(AS_IT_TURNS));
    let ego = &shown.rollout.ego_track().states;
    let turns = ego.iter().position(|state| state.heading.abs() > 0.05).expect("it turns");
    let (states, _) = partner(&shown);
    let off = states.iter().position(|state| state.speed() > 0.1).expect("it sets off");
    assert!(off + 10 > turns, "it sets off {} steps before", turns - off);
}

const PARKS_AHEAD: &str = "The AV was traveling north on Elm Street behind a van. The van came to a stop and parked in the lane. The front of the AV made contact \
                           with the rear of the parked van.";

/// Who is told to have come there and parked has not stood from the start; it stands at the contact, though.
#[test]
fn who_came_and_parked_stands_when_it_is_struck() {
    let account = story(PARKS_AHEAD);
    let made = reconstruct(&account).expect("it can be staged");
    let shown = |draft: &ScenarioDraft| {
        let scenario = recrash_roads::check(draft.clone()).expect("it can run").value;
        let verdict = held_against(&account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
        let result = |kind| verdict.checks.iter().find(|check| check.kind == kind).map(|check| check.result);
        [CheckKind::CpState, CheckKind::CpActs].map(|kind| result(kind) == Some(CheckResult::Shown))
    };
    assert_eq!(shown(&made.draft), [true, false], "the rules draw it as standing there: {:?}", made.draft.actors);
    // It comes 12 m and stops there; or it never does.
    let comes = |stops_after_m: f64| {
        let mut draft = made.draft.clone();
        let plan = &mut draft.actors.iter_mut().find(|actor| actor.id == "cp").expect("a partner").plan;
        let at = partner(&made).1.position();
        plan.start = Place::at(at.x - 12.0, at.y, 0.0);
        plan.speed_mps = 4.0;
        plan.course = vec![Leg::Curve { to: Place::at(at.x + 30.0, at.y, 0.0), reverse: false }];
        let stop = Deed::Stop { rate_mps2: 1.0, at_m: Some(stops_after_m) };
        plan.acts = vec![Act { id: None, when: None, delay_s: 0.0, deed: stop }];
        draft
    };
    assert_eq!(shown(&comes(12.0)), [true, true]);
    let mut rolls = comes(12.0);
    rolls.actors.iter_mut().find(|actor| actor.id == "cp").expect("a partner").plan.acts[0].deed =
        Deed::Speed { to_mps: 0.3, rate_mps2: 1.0 };
    assert!(!shown(&rolls)[0], "it rolls when it is struck, or is not struck");
}
