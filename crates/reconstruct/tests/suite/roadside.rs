//! What stands at the edge of the road stands there, and the ego comes to it; what lies across the way does.

use crate::things::thing;
use crate::ways::{before_contact, degrees_between, made, partner, story};
use recrash_model::account::{Account, Fact, LaneWord, Speed, SpeedMeaning, Striker};
use recrash_model::geometry::Vec2;
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::scenario::{MapSpec, ObstacleKind, Place, ScenarioDraft, StripKind};
use recrash_model::template::Movement;
use recrash_reconstruct::{Reconstruction, held_against};
use recrash_sim::{Ego, simulate};

const KERB: &str =
    "The AV was traveling north in the right lane of Elm Street when the front right of the AV struck the curb.";

const WIDE: &str = "The AV was traveling north on Elm Street. As the AV turned left onto Oak Street, the front right of the AV made contact with \
                    the right curb.";

const MEDIAN: &str = "The AV was traveling north in the left lane of Elm Street. The AV swerved to the left and the front left of the AV made \
                      contact with the median.";

const BIN: &str = "The AV was pulling over to the right side of the road and the front right of the AV made contact with a trash bin on the right \
                   side of the street.";

const PARKED: &str = "The AV was traveling east on Oak Street. The AV moved to the right and the front right of the AV made contact with the rear \
                      left of an SUV that was parked at the curb on the right side of the street.";

const DIAGONAL: &str = "The AV was traveling east when the front right of the AV made contact with the rear right of a diagonally parked car.";

const ALLEY: &str = "The AV was traveling west in an alley when the right side of the AV made contact with a wall.";

const AHEAD: &str = "The AV was traveling in a parking lot. As the AV turned right into a parking stall, the front of the AV made contact with \
                     a wall.";

const FIXED: &str =
    "The AV was traveling through a parking lot when the front left of the AV made contact with a fixed object.";

const WATER: &str =
    "The AV was traveling south on Elm Street when the front of the AV made contact with standing water.";

const DOOR: &str = "The AV was traveling west when the driver of a parked sedan on the right side of the street opened the front left door, and the \
                    door made contact with the front right of the AV.";

const HOLE: &str = "The AV was traveling north when the front left of the AV made contact with a pothole.";

const POLE: &str =
    "The AV was traveling north on Elm Street when the front of the AV made contact with a utility pole.";

const IN_TURN_LANE: &str = "The AV was traveling west in the left turn lane of Oak Street and the front of the AV made contact with a piece of \
                            debris.";

/// The stories of this file, as they are shown.
pub fn shown() -> Vec<(String, Account, Reconstruction)> {
    let texts = [KERB, WIDE, MEDIAN, BIN, PARKED, DIAGONAL, ALLEY, AHEAD, FIXED, WATER, DOOR, HOLE, POLE];
    texts.into_iter().map(|text| (text[..40].to_owned(), story(text), made(&story(text)))).collect()
}

/// Facts that are not shown where the scenario is another one.
fn missed(account: &Account, draft: ScenarioDraft) -> Vec<CheckKind> {
    let scenario = recrash_roads::check(draft).expect("it can be run").value;
    let verdict = held_against(account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
    verdict.checks.iter().filter(|check| check.result == CheckResult::NotShown).map(|check| check.kind).collect()
}

/// What is not shown where the thing stands so far to the left of its place, and is turned by so much.
fn moved(account: &Account, left_m: f64, turned_deg: f64) -> Vec<CheckKind> {
    let mut draft = made(account).draft;
    let Place::Plane { y_m, heading_deg, .. } = &mut draft.objects[0].at else { panic!("{:?}", draft.objects) };
    *y_m += left_m;
    *heading_deg += turned_deg;
    missed(account, draft)
}

/// Strips beside the driving lanes of the road that the ego came along, on its right and on its left.
fn strips(made: &Reconstruction, road: &str) -> [Vec<StripKind>; 2] {
    let MapSpec::G(map) = &made.draft.map else { panic!("{:?}", made.draft.map) };
    let road = map.roads.iter().find(|other| other.id == road).expect("the road");
    [&road.right, &road.left].map(|strips| strips.iter().map(|strip| strip.kind).collect())
}

#[test]
fn a_kerb_is_at_the_edge_of_the_outermost_lane() {
    let account = story(KERB);
    let shown = made(&account);
    let (object, _, y_m) = thing(&shown);
    assert!((y_m + 1.85).abs() < 0.05 && object.kind == ObstacleKind::Kerb, "{object:?}");
    assert_eq!(strips(&shown, "main")[0], [StripKind::Driving, StripKind::Driving, StripKind::Sidewalk]);
    // The ego drifts to it.
    let states = &shown.rollout.ego_track().states;
    let met = states[before_contact(&shown)];
    assert!(states[0].y.abs() < 0.01 && (-0.9..-0.3).contains(&met.y) && met.heading.abs() < 0.15, "{met:?}");
    // In the lane, or across it, it does not pass.
    assert!(moved(&account, 1.0, 0.0).contains(&CheckKind::Approach));
    assert!(moved(&account, 0.0, 40.0).contains(&CheckKind::Approach));
}

#[test]
fn a_kerb_is_not_at_the_edge_of_a_lane_between_others() {
    let mut account = story(KERB);
    account.sv.lane = Some(Fact::by_rule(LaneWord::Center, "made for this test"));
    assert!(made(&account).verdict.checks.iter().all(|check| check.kind != CheckKind::Approach));
}

#[test]
fn a_kerb_met_after_a_turn_is_that_of_the_road_entered() {
    let account = story(WIDE);
    let shown = made(&account);
    let (object, x_m, y_m) = thing(&shown);
    let Place::Plane { heading_deg, .. } = object.at else { panic!("{object:?}") };
    assert!((heading_deg - 90.0).abs() < 1.0 && x_m > 3.0 && y_m > 15.0, "{object:?}");
    let met = shown.rollout.ego_track().states[before_contact(&shown)];
    assert!(degrees_between(met.heading, 90.0_f64.to_radians()) < 25.0, "{met:?}");
}

#[test]
fn who_is_slow_at_the_end_of_a_turn_has_turned_before() {
    let mut account = story(WIDE);
    account.sv.speeds = vec![Fact::of_column(Speed { mps: 0.9, meaning: SpeedMeaning::Impact }, "made for this test")];
    let shown = made(&account);
    let states = &shown.rollout.ego_track().states;
    let met = states[before_contact(&shown)];
    assert!(states[0].heading.abs() < 0.01 && states[0].speed() > 2.0, "{:?}", states[0]);
    assert!(met.speed() < 1.5 && degrees_between(met.heading, 90.0_f64.to_radians()) < 25.0, "{met:?}");
}

#[test]
fn a_median_is_left_of_the_leftmost_lane() {
    let shown = made(&story(MEDIAN));
    let (_, _, y_m) = thing(&shown);
    assert!((y_m - 1.85).abs() < 0.05, "{y_m}");
    assert_eq!(strips(&shown, "main")[1][..2], [StripKind::Median, StripKind::Driving]);
}

#[test]
fn a_bin_stands_where_the_ego_pulls_over() {
    let account = story(BIN);
    let shown = made(&account);
    let (object, _, y_m) = thing(&shown);
    // At the end of the parking strip, which is 2.4 m wide.
    assert!(object.kind == ObstacleKind::Container && (-4.2..-3.5).contains(&y_m), "{object:?}");
    assert!(moved(&account, 2.0, 0.0).contains(&CheckKind::Approach));
}

#[test]
fn who_is_parked_at_the_kerb_stands_along_it() {
    let account = story(PARKED);
    let shown = made(&account);
    let (_, met) = partner(&shown);
    assert!(met.heading.abs() < 0.01 && (-3.0..-2.5).contains(&met.y), "{met:?}");
    let mut draft = shown.draft;
    let Place::Plane { y_m, heading_deg, .. } = &mut draft.actors[0].plan.start else { panic!("{:?}", draft.actors) };
    (*y_m, *heading_deg) = (*y_m + 1.2, *heading_deg + 30.0);
    assert!(missed(&account, draft).contains(&CheckKind::Approach));
}

#[test]
fn who_is_parked_diagonally_stands_in_a_stall() {
    let account = story(DIAGONAL);
    let shown = made(&account);
    let (_, met) = partner(&shown);
    let angle = degrees_between(met.heading, 0.0);
    assert!((30.0..150.0).contains(&angle), "{met:?}");
    assert!(strips(&shown, "main")[0].contains(&StripKind::Stalls));
    let mut draft = shown.draft;
    let Place::Plane { heading_deg, .. } = &mut draft.actors[0].plan.start else { panic!("{:?}", draft.actors) };
    *heading_deg = 180.0;
    assert!(missed(&account, draft).contains(&CheckKind::Approach));
}

#[test]
fn a_wall_stands_along_an_alley_and_across_the_end_of_a_stall() {
    let along = made(&story(ALLEY));
    let (_, _, y_m) = thing(&along);
    assert!((y_m + 1.85).abs() < 0.05 && strips(&along, "main")[0] == [StripKind::Driving], "{y_m}");
    let across = made(&story(AHEAD));
    let (object, x_m, y_m) = thing(&across);
    let Place::Plane { heading_deg, .. } = object.at else { panic!("{object:?}") };
    let met = across.rollout.ego_track().states[before_contact(&across)];
    let between = degrees_between(met.heading, heading_deg.to_radians());
    let ahead = Vec2::new(x_m, y_m) - met.position();
    assert!((60.0..120.0).contains(&between) && Vec2::from_heading(met.heading).cross(ahead).abs() < 0.5, "{object:?}");
    assert!(degrees_between(met.heading, (-90.0_f64).to_radians()) < 20.0, "{met:?}");
}

#[test]
fn what_is_fixed_stands_beside_the_aisle() {
    let shown = made(&story(FIXED));
    let (object, _, y_m) = thing(&shown);
    assert!(object.kind == ObstacleKind::Wall && y_m > 2.0, "{object:?}");
}

#[test]
fn water_lies_across_the_lane() {
    let account = story(WATER);
    let shown = made(&account);
    let (object, _, y_m) = thing(&shown);
    let size = object.size.expect("its size");
    assert!(size.width_m > 3.0 && size.length_m > 3.0 && y_m.abs() < 0.1, "{object:?}");
    assert_eq!(moved(&account, 1.0, 0.0), [CheckKind::Approach]);
}

#[test]
fn a_hole_under_no_wheel_or_another_one_does_not_pass() {
    let account = story(HOLE);
    assert!(moved(&account, -0.7, 0.0).contains(&CheckKind::Approach));
    assert!(moved(&account, -1.4, 0.0).contains(&CheckKind::Approach));
}

#[test]
fn a_pole_stands_in_no_lane() {
    let shown = made(&story(POLE));
    let (_, _, y_m) = thing(&shown);
    assert!(y_m < -1.7, "{y_m}");
}

#[test]
fn whose_door_opens_at_the_kerb_is_parked_along_it() {
    let account = story(DOOR);
    assert_eq!(account.door.as_ref().map(|fact| fact.value), Some(Striker::Cp));
    let shown = made(&account);
    let (_, met) = partner(&shown);
    assert!(met.heading.abs() < 0.01, "{met:?}");
}

#[test]
fn debris_in_the_lane_for_a_turn_is_met_before_it() {
    let mut account = story(IN_TURN_LANE);
    account.sv.movement = Some(Fact::of_column(Movement::LeftTurn, "SV Pre-Crash Movement"));
    let straight = made(&account).rollout;
    assert!(straight.ego_track().states[80].heading.abs() < 0.01);
    // Told in words it is met in the turn.
    account.sv.movement = story("The AV was turning left and made contact with debris.").sv.movement;
    let shown = made(&account);
    assert!(shown.rollout.ego_track().states[before_contact(&shown)].heading > 0.3);
}

#[test]
fn who_stood_and_goes_aside_to_the_kerb_is_seen_to() {
    let shown = made(&story(
        "The AV was traveling north and slowed to a stop for a cone in its lane. The AV proceeded forward and to the left to get around the cone, \
         and the front left of the AV made contact with a curb.",
    ));
    let ego = &shown.rollout.ego_track().states[..=before_contact(&shown)];
    let (first, last) = (ego[0], ego[ego.len() - 1]);
    assert!(last.y - first.y > 0.5 && ego.iter().any(|state| state.speed() == 0.0), "{last:?}");
}
