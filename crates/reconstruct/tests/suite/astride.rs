//! Who is told to be partly in one lane and partly elsewhere is drawn over the line, and that is checked.

use crate::ways::{made, story};
use recrash_model::account::{Astride, AstrideWhen, Fact, LaneLine, LaneWord, LeftRight};
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::rollout::ActorTrack;
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};

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

const NEVER_STOOD: &str = "The AV was traveling north on Elm Street. A truck ahead was straddling two lanes, drifted to the right and its right side made \
                           contact with the front left of the AV.";

#[test]
fn who_never_stood_is_over_no_line_where_it_stands() {
    let mut account = story(NEVER_STOOD);
    let over = Astride { line: LaneLine::Lanes, side: None, when: AstrideWhen::Stop };
    account.partner.as_mut().unwrap().astride = Some(Fact::by_rule(over, "made for this test"));
    let made = made(&account);
    let over = check(&made, CheckKind::CpAstride);
    assert_eq!((over.result, over.observed.as_str()), (CheckResult::CannotBeShown, "it did not stand"));
}

const LEFT_EDGE: &str = "The AV was parked facing north on Elm Street, a one-way street, partially in the left lane and partially in the parking lane. A van \
                         traveling north passed the AV on the right and the left side of the van made contact with the rear right of the AV.";

#[test]
fn who_is_over_the_left_edge_of_a_one_way_road_stands_there() {
    let mut account = story(LEFT_EDGE);
    let over = Astride { line: LaneLine::Edge, side: Some(LeftRight::Left), when: AstrideWhen::Stop };
    account.sv.astride = Some(Fact::by_rule(over, "made for this test"));
    let left = made(&account);
    shows(&left, CheckKind::SvAstride);
    let ego = left.rollout.ego_track();
    assert!(ego.states[0].y + 0.5 * ego.width_m > 2.0, "{:?}", ego.states[0]);
    // The other edge does not pass for it.
    let over = Astride { side: Some(LeftRight::Right), ..over };
    account.sv.astride = Some(Fact::by_rule(over, "made for this test"));
    let scenario = recrash_roads::check(left.draft).unwrap().value;
    let held = held_against(&account, &scenario, &left.rollout).unwrap();
    let seen = held.checks.iter().find(|check| check.kind == CheckKind::SvAstride).unwrap();
    assert_eq!(seen.result, CheckResult::CannotBeShown, "{seen:?}");
}

const OWN_LANES: &str = "The AV was traveling north on Elm Street. An oncoming truck was driving partially in the left lane and partially in the right lane, \
                         drifted to the left and struck the front left of the AV.";

#[test]
fn who_comes_towards_the_ego_between_two_lanes_of_its_own_is_not_over_the_line_between_the_directions() {
    let made = made(&story(OWN_LANES));
    let over = check(&made, CheckKind::CpAstride);
    assert!(over.expected.contains("between two lanes"), "{over:?}");
    assert_ne!(over.result, CheckResult::Shown, "{over:?}");
}

#[test]
fn whose_lane_it_is_depends_on_no_company() {
    for subject in ["AV", "Waymo AV", "Zoox AV", "Cruise AV", "ego vehicle", "test vehicle", "autonomous vehicle"] {
        let text = format!(
            "The {subject} was traveling north on Elm Street. An oncoming truck was driving partially in the {subject}'s lane \
             and its front left made contact with the front left of the {subject}."
        );
        let over = reconstruct(&story(&text)).unwrap();
        let over = check(&over, CheckKind::CpAstride);
        assert!(over.expected.contains("between the directions"), "{subject}: {over:?}");
    }
}

const SHOULDER: &str = "The AV was traveling in the left lane. A sedan behind was driving partially on the right shoulder, passed the AV on the right and \
                        its front left made contact with the rear right of the AV.";

#[test]
fn who_comes_along_the_edge_is_not_between_two_lanes() {
    let right = reconstruct(&story(SHOULDER)).unwrap();
    let over = check(&right, CheckKind::CpAstride);
    assert!(over.expected.contains("edge"), "{over:?}");
    let (first, ego) = (actor(&right, "cp").states[0], right.rollout.ego_track().states[0]);
    assert!(ego.y - first.y > 3.4 || over.result == CheckResult::CannotBeShown, "{first:?} {over:?}");
    // On the left of a road with two directions there is none.
    let left = SHOULDER
        .replace("right", "other")
        .replace("left", "right")
        .replace("other", "left")
        .replace("the right lane", "the left lane");
    let left = reconstruct(&story(&left)).unwrap();
    let first = actor(&left, "cp").states[0];
    assert!(first.y < left.rollout.ego_track().states[0].y + 2.0, "{first:?}");
    assert_eq!(check(&left, CheckKind::CpAstride).result, CheckResult::CannotBeShown);
}

#[test]
fn a_lane_is_told_of_who_is_between_two_at_the_start_alone() {
    let between = made(&story(BETWEEN));
    let scenario = recrash_roads::check(between.draft).unwrap().value;
    let mut account = story(BETWEEN);
    for (when, result) in [(AstrideWhen::Start, CheckResult::Shown), (AstrideWhen::Contact, CheckResult::NotShown)] {
        let partner = account.partner.as_mut().unwrap();
        partner.lane = Some(Fact::by_rule(LaneWord::Left, "made for this test"));
        partner.astride.as_mut().unwrap().value.when = when;
        let held = held_against(&account, &scenario, &between.rollout).unwrap();
        let lane = held.checks.iter().find(|check| check.kind == CheckKind::CpLane).unwrap();
        assert_eq!(lane.result, result, "{when:?}: {lane:?}");
    }
}
