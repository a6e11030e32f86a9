//! What looks like a told thing, and is none: no more is told, or drawn, than the words say.

use crate::ways::{made, story};
use recrash_model::account::{Fact, PlaceKind};
use recrash_model::metrics::{Check, CheckKind};
use recrash_model::scenario::{MapSpec, RoadSpec, StripKind};
use recrash_reconstruct::Reconstruction;

const BEFORE_PARKED: &str = "The AV came to a complete stop ahead of a parked sedan. A van struck the rear of the parked sedan and pushed the parked sedan forward, \
                             and the front of the parked sedan made contact with the rear bumper of the AV.";

const TURNED: &str = "The AV turned right from Main Street onto Oak Street. A sedan reversing out of a driveway on the right made contact with the right side of \
                      the AV with its rear bumper.";

const OUT_BEFORE: &str = "The AV turned right out of a parking lot onto Main Street and drove on. At the intersection with Oak Street the AV stopped at a red \
                          light. A sedan behind the AV made contact with the rear bumper of the AV with its front bumper.";

const VALLEY: &str = "The AV was proceeding straight on Main Street through the intersection. A sedan coming from the left on Valley Street entered the \
                      intersection and its front made contact with the left side of the AV.";

const BRANCH: &str =
    "The AV was traveling on Main Street and struck a tree branch in the roadway with its front right corner.";

const PASSED: &str = "The AV was proceeding straight on Main Street and was passing a truck that was parked at the right curb. An oncoming van was proceeding \
                      straight and its left mirror made contact with the left mirror of the AV.";

const HIGHWAY: &str = "The AV was traveling straight on a narrow highway when a sedan behind the AV made contact with the rear bumper of the AV with its front \
                       bumper.";

const CONE: &str = "The AV was driving behind a van. A traffic cone tipped over ahead of the AV, and the AV struck the traffic cone with its front bumper.";

const FOUR_DOOR: &str = "The AV was stopped behind two four-door sedans at a red light when a van behind the AV made contact with the rear bumper of the AV \
                         with its front bumper.";

const FIRST_OF_TWO: &str = "The AV was traveling in lane 1 of 2 on Main Street when a sedan behind the AV made contact with the rear bumper of the AV with its \
                            front bumper.";

const WALKS_UP: &str = "The AV was reversing on Main Street. A pedestrian walking towards the AV from behind made contact with the rear bumper of the AV.";

fn check(made: &Reconstruction, kind: CheckKind) -> Option<&Check> {
    made.verdict.checks.iter().find(|check| check.kind == kind)
}

fn expected(text: &str, kind: CheckKind) -> String {
    check(&made(&story(text)), kind).map_or(String::new(), |check| check.expected.clone())
}

fn roads(made: &Reconstruction) -> &[RoadSpec] {
    match &made.draft.map {
        MapSpec::G(map) => &map.roads,
        other => panic!("{other:?}"),
    }
}

fn driving(road: &RoadSpec) -> usize {
    road.right.iter().chain(&road.left).filter(|strip| strip.kind == StripKind::Driving).count()
}

#[test]
fn who_came_to_a_stop_is_told_so_ahead_of_one_that_is_parked() {
    assert_eq!(expected(BEFORE_PARKED, CheckKind::SvState), "stopped");
}

#[test]
fn no_driveway_is_drawn_beside_the_road_that_the_ego_left() {
    let made = made(&story(TURNED));
    assert!(roads(&made).iter().all(|road| road.driveways.is_empty()), "{:?}", roads(&made));
}

#[test]
fn a_street_stays_one_behind_a_turn_out_of_a_lot_and_by_the_name_of_a_valley() {
    for text in [OUT_BEFORE, VALLEY] {
        let mut account = story(text);
        account.place.kind = Some(Fact::by_rule(PlaceKind::Intersection, "made for this test"));
        let made = made(&account);
        let lanes: Vec<usize> = roads(&made).iter().map(driving).collect();
        assert_eq!(lanes, [4; 4], "{text}");
    }
}

#[test]
fn a_branch_that_lies_in_the_road_reaches_in_from_no_side() {
    assert_eq!(expected(BRANCH, CheckKind::Approach), "");
}

#[test]
fn who_passes_one_at_the_kerb_need_not_leave_its_lane() {
    assert_eq!(expected(PASSED, CheckKind::SvMovement), "passing");
    let round = PASSED.replace("was passing a truck that was parked at the right curb", "drove around a stopped truck");
    assert_eq!(expected(&round, CheckKind::SvMovement), "passing, and aside");
}

#[test]
fn a_narrow_highway_has_lanes_of_one_width() {
    let mut account = story(HIGHWAY);
    account.place.kind = Some(Fact::by_rule(PlaceKind::Highway, "made for this test"));
    let made = made(&account);
    let strips = roads(&made)[0].right.iter().filter(|strip| strip.kind == StripKind::Driving);
    assert!(strips.map(|strip| strip.width_m).all(|width_m| width_m == roads(&made)[0].right[0].width_m));
    assert!(roads(&made)[0].right[0].width_m.is_none_or(|width_m| width_m > 3.0));
}

#[test]
fn a_cone_that_tips_over_came_off_nobody() {
    assert!(made(&story(CONE)).rollout.actors.iter().all(|track| track.id != "cp"));
}

#[test]
fn two_with_four_doors_are_two() {
    let made = made(&story(FOUR_DOOR));
    assert_eq!(made.rollout.actors.iter().filter(|track| track.id.starts_with("lead")).count(), 2);
}

#[test]
fn the_first_of_two_lanes_is_not_the_second() {
    assert_eq!(expected(FIRST_OF_TWO, CheckKind::SvLane), "the left lane");
}

#[test]
fn who_walks_up_to_an_ego_that_backs_does_not_cross() {
    assert_eq!(expected(WALKS_UP, CheckKind::Approach), "from behind");
    let across = WALKS_UP.replace("walking towards the AV from behind", "walking behind the AV");
    assert_eq!(expected(&across, CheckKind::Approach), "from behind, across");
}
