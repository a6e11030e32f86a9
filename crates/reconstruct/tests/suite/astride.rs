//! Who is told to be partly in one lane and partly elsewhere is drawn over the line, and that is checked.

use crate::ways::{made, story};
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::rollout::ActorTrack;
use recrash_reconstruct::{Reconstruction, held_against};

const PARKED: &str = "The AV was parked facing north on Elm Street, partially in the right lane and partially in the parking lane. A van traveling \
                      north passed the AV on the left and the right side of the van made contact with the rear left of the AV.";

const BETWEEN: &str = "The AV was stopped in the right lane of Elm Street. A sedan traveling partially in the right lane and partially in the left \
                       lane approached the AV from behind and the front right of the sedan made contact with the rear left of the AV.";

const CENTRE: &str = "The AV was stopped facing north, partially on the double yellow line of Elm Street. A pickup traveling south passed the AV \
                      and its left side made contact with the left side of the AV.";

const LEAD: &str = "The AV was traveling north on Elm Street when it slowed to a stop for a taxi that was stopped partially in-lane ahead. A van \
                    approached the AV from behind and the front of the van made contact with the rear of the AV.";

const CHANGES: &str = "The AV was traveling in the right lane of Elm Street. The AV began a lane change to the left lane and came to a stop, partially \
                       in the right lane and partially in the left lane, for stopped traffic ahead. A van traveling in the left lane approached the \
                       AV from behind and the front right of the van made contact with the left side of the AV.";

fn check(made: &Reconstruction, kind: CheckKind) -> &Check {
    made.verdict.checks.iter().find(|check| check.kind == kind).expect("it is told")
}

fn shows(made: &Reconstruction, kind: CheckKind) {
    let check = check(made, kind);
    assert_eq!(check.result, CheckResult::Shown, "{check:?}");
    assert!(made.is_true(), "{:?}", made.verdict);
}

fn actor<'a>(made: &'a Reconstruction, id: &str) -> &'a ActorTrack {
    made.rollout.actors.iter().find(|track| track.id == id).expect("an actor")
}

#[test]
fn who_is_parked_partly_in_a_lane_reaches_out_of_the_parking_lane() {
    let made = made(&story(PARKED));
    shows(&made, CheckKind::SvAstride);
    // The edge of the lanes is 1.7 m to the right of the lane's middle.
    let ego = made.rollout.ego_track();
    let (left_m, right_m) = (ego.states[0].y + 0.5 * ego.width_m, ego.states[0].y - 0.5 * ego.width_m);
    assert!(left_m > -1.3 && right_m < -2.1, "{left_m} {right_m}");
}

#[test]
fn who_comes_along_between_two_lanes_does_so_from_the_start() {
    let made = made(&story(BETWEEN));
    shows(&made, CheckKind::CpAstride);
    let y = actor(&made, "cp").states.iter().take(80).map(|state| state.y).fold(f64::MAX, f64::min);
    assert!(y > 0.9, "{y}");
}

#[test]
fn who_stands_on_the_line_between_the_directions_does() {
    shows(&made(&story(CENTRE)), CheckKind::SvAstride);
}

#[test]
fn who_stands_ahead_partly_in_the_lane_does() {
    let made = made(&story(LEAD));
    shows(&made, CheckKind::OthersAstride);
    assert!(actor(&made, "lead").states[0].y < -1.0);
}

#[test]
fn who_stops_while_it_changes_lanes_is_between_them() {
    shows(&made(&story(CHANGES)), CheckKind::SvAstride);
}

#[test]
fn who_is_wholly_in_a_lane_or_beside_it_is_over_no_line() {
    let account = story(PARKED);
    for other in [
        PARKED.replace(" and partially in the parking lane", ""),
        PARKED.replace("partially in the right lane and ", ""),
    ]
    .map(|words| words.replace("partially ", ""))
    {
        let made = made(&story(&other));
        let scenario = recrash_roads::check(made.draft.clone()).unwrap().value;
        let held = held_against(&account, &scenario, &made.rollout).unwrap();
        let over = held.checks.iter().find(|check| check.kind == CheckKind::SvAstride).unwrap();
        assert_eq!(over.result, CheckResult::CannotBeShown, "{over:?} of {other}");
    }
}
