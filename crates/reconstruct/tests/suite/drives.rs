//! Partners drive as vehicles can, in lanes; and who slides or turns on the spot does not pass for one that drives.

use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::math;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;
use recrash_model::scenario::{Leg, Place};
use recrash_reconstruct::{Reconstruction, held_against};
use recrash_roads::{RoadPart, Scenario};
use recrash_sim::{Ego, simulate};

const SET_OFF: &str = "The AV was stopped at a stop sign on Elm Street. An oncoming van came to a stop in the opposite lane beside the AV. The \
                       van then proceeded forward, drifted into the AV's lane, and the front left corner of the van made contact with the left \
                       side of the stationary AV.";

const BY_ON_THE_RIGHT: &str = "The AV was stopped at a red light at the intersection of Elm Street and Oak Street. A sedan behind the AV passed \
                               the AV on the right, and the left side of the sedan made contact with the right side of the stationary AV.";

const BUS_LANE: &str = "The AV was traveling north on Elm Street when it came to a stop in traffic. A taxi passed the AV in the bus lane to the \
                        right of the AV, and the left side of the taxi made contact with the right side of the stationary AV.";

const STRUCK_ON_ITS_WAY: &str = "The AV was stopped at a red light on Elm Street. A sedan that was stopped behind the AV began to change lanes to the \
                                 left to go around the AV when the sedan was struck by a pickup truck, and the front right of the sedan then \
                                 made contact with the rear left corner of the stationary AV.";

/// By how much somebody turns at most for each metre that its middle goes. [1/m]
fn tightest(states: &[ActorState]) -> f64 {
    let moves = states.windows(2).filter(|pair| pair[0].position().distance(pair[1].position()) > 0.02);
    let bend = |pair: &[ActorState]| {
        math::wrap_angle(pair[1].heading - pair[0].heading).abs() / pair[0].position().distance(pair[1].position())
    };
    moves.map(bend).fold(0.0, f64::max)
}

#[test]
fn who_sets_off_beside_its_line_has_room_for_a_bend() {
    let made = made(&story(SET_OFF));
    let states = partner(&made).0;
    assert!(tightest(states) < 1.0 / 4.0, "{}", tightest(states));
}

/// The same with a partner that stood 0.5 m beside its line, and slides over on its way.
fn sliding(made: &Reconstruction) -> Scenario {
    let mut draft = made.draft.clone();
    let plan = &mut draft.actors.iter_mut().find(|actor| actor.id == "cp").expect("a partner").plan;
    let Place::Plane { y_m, .. } = &mut plan.start else { panic!("a place") };
    *y_m += 0.5;
    let Leg::Curve { to: Place::Plane { x_m, y_m, heading_deg }, reverse } = plan.course[0].clone() else {
        panic!("a curve")
    };
    let beside = Place::at(x_m - 0.9, y_m + 0.5, heading_deg);
    plan.course.insert(0, Leg::Curve { to: beside, reverse });
    recrash_roads::check(draft).expect("it runs").value
}

#[test]
fn who_slides_sideways_does_not_pass_for_one_that_drives() {
    let account = story(
        "The AV was stopped at a red light. A sedan that was stopped behind the AV proceeded forward, and the front of the sedan made \
         contact with the rear of the stationary AV.",
    );
    let sliding = sliding(&made(&account));
    let verdict = held_against(&account, &sliding, &simulate(&sliding, Ego::Recorded)).expect("it was staged");
    let missed = verdict.checks.iter().filter(|check| check.result == CheckResult::NotShown);
    let missed: Vec<_> = missed.map(|check| (check.kind, check.observed.ends_with("as nobody drives"))).collect();
    assert_eq!(missed, [(CheckKind::CpMovement, true)]);
}

/// Whether somebody's middle is in a lane for driving.
fn in_lane(made: &Reconstruction, state: &ActorState) -> bool {
    let scenario = recrash_roads::check(made.draft.clone()).expect("it ran").value;
    let network = scenario.network();
    let lane = network.lane_at(state.position(), state.heading);
    lane.is_some_and(|lane| !matches!(network.road(network.lane(lane).road).part, RoadPart::Beside(_)))
}

#[test]
fn who_passes_on_the_right_before_a_junction_does_so_in_a_lane() {
    let made = made(&story(BY_ON_THE_RIGHT));
    assert!(partner(&made).0.iter().all(|state| in_lane(&made, state)));
}

#[test]
fn who_passes_in_the_bus_lane_comes_along_that() {
    let made = made(&story(BUS_LANE));
    let states = partner(&made).0;
    assert!(states.iter().all(|state| state.y < -2.0), "{:?}", states[0]);
}

#[test]
fn who_strikes_the_partner_on_its_way_comes_along_the_road() {
    let made = made(&story(STRUCK_ON_ITS_WAY));
    let pusher = made.rollout.actors.iter().find(|track| track.id == "pusher").expect("it is drawn");
    let until = &pusher.states[..before_contact(&made) - 5];
    assert!(until.iter().all(|state| in_lane(&made, state)), "{:?}", until[0]);
    assert!(degrees_between(until[0].heading, 0.0) < 1.0, "{:?}", until[0]);
}
