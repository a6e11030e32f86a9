//! Who is told to be in a lane beside the driving lanes is drawn there; and who is told a signal or a sign comes over its line.

use crate::ways::{before_contact, made, partner, story};
use recrash_model::account::{Account, ControlDevice, Fact, LaneWord, LeftRight, Origin, RoadFeature, SignalState};
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::scenario::{MapSpec, StripKind};
use recrash_model::zones::ContactZone;
use recrash_reconstruct::{Reconstruction, held_against};

const IN_BIKE_LANE: &str = "The AV was traveling east on Oak Street in the right lane. A cyclist was traveling in the bike lane to the right \
                            of the AV. As the AV was passing the cyclist, the cyclist veered left into the lane of the AV and the left \
                            side of the bicycle made contact with the right side of the AV.";

const OFF_SHOULDER: &str = "The AV was stopped facing north on Elm Street. An SUV that was parked on the right shoulder behind the AV pulled \
                            out of the shoulder and made contact with the rear right of the stationary AV.";

const INTO_ITS_LANE: &str = "The AV was traveling north in the left lane and was merging into the rightmost lane. The front of the AV made \
                             contact with the rear of a sedan that was stopped in the rightmost lane.";

const SLOW_AT_GREEN: &str = "The AV was traveling east on Oak Street through the intersection with Elm Street on a green light. A sedan \
                             traveling north on Elm Street entered the intersection on a red light and the front of the sedan made contact \
                             with the right side of the AV. The AV was traveling at 3 mph.";

const RAN_RED: &str = "The AV was traveling south on Elm Street and made a left turn onto Oak Street on a green arrow. A sedan traveling \
                       north on Elm Street failed to stop for the red light, entered the intersection, and the front of the sedan made \
                       contact with the right side of the AV.";

const FROM_STOP_SIGN: &str = "The AV was traveling south on Elm Street and began a left turn onto Oak Street. A sedan that was previously \
                              stopped at the stop sign on Oak Street, facing west, proceeded straight into the intersection, and the front \
                              of the sedan made contact with the left side of the AV.";

const GATE_TRACK: &str =
    "The AV was traveling east in a parking lot when the bottom of the AV made contact with an elevated gate track.";

fn result(checks: &[Check], kind: CheckKind) -> Option<CheckResult> {
    checks.iter().find(|check| check.kind == kind).map(|check| check.result)
}

fn strips(made: &Reconstruction) -> Vec<StripKind> {
    let MapSpec::G(map) = &made.draft.map else { panic!("a graph") };
    map.roads[0].right.iter().map(|strip| strip.kind).collect()
}

/// What is said of a fact where the partner is so far to the left of where it is drawn, all the time. [m]
fn moved(account: &Account, made: &Reconstruction, left_m: f64, kind: CheckKind) -> Option<CheckResult> {
    let scenario = recrash_roads::check(made.draft.clone()).expect("it ran").value;
    let mut rollout = made.rollout.clone();
    let track = rollout.actors.iter_mut().find(|track| track.id == "cp").expect("a partner");
    track.states.iter_mut().for_each(|state| state.y += left_m);
    result(&held_against(account, &scenario, &rollout).expect("it can be staged").checks, kind)
}

#[test]
fn a_cyclist_who_is_told_to_be_in_the_bicycle_lane_comes_along_one() {
    let account = story(IN_BIKE_LANE);
    let made = made(&account);
    assert!(strips(&made).contains(&StripKind::Bike));
    assert_eq!(result(&made.verdict.checks, CheckKind::CpLane), Some(CheckResult::Shown), "{:?}", made.verdict);
    assert_eq!(moved(&account, &made, 3.0, CheckKind::CpLane), Some(CheckResult::NotShown));
    assert_eq!(moved(&account, &made, -3.0, CheckKind::CpLane), Some(CheckResult::NotShown));
    // It keeps to it until shortly before the contact.
    let states = partner(&made).0;
    let halfway = &states[before_contact(&made) / 2];
    assert!((halfway.y - states[0].y).abs() < 0.1, "{} m", halfway.y - states[0].y);
}

#[test]
fn who_pulls_out_of_a_shoulder_stood_on_one() {
    let account = story(OFF_SHOULDER);
    let made = made(&account);
    assert!(strips(&made).contains(&StripKind::Shoulder) && !strips(&made).contains(&StripKind::Parking));
    assert_eq!(result(&made.verdict.checks, CheckKind::CpLane), Some(CheckResult::Shown), "{:?}", made.verdict);
    assert_eq!(moved(&account, &made, 3.0, CheckKind::CpLane), Some(CheckResult::NotShown));
}

#[test]
fn where_no_lane_beside_the_others_is_told_none_is_drawn() {
    let text = IN_BIKE_LANE.replace("in the bike lane to the right of the AV", "to the right of the AV");
    assert!(!strips(&made(&story(&text))).contains(&StripKind::Bike));
}

#[test]
fn who_merges_into_the_lane_of_the_other_comes_from_the_next_one() {
    let made = made(&story(INTO_ITS_LANE));
    assert_eq!(result(&made.verdict.checks, CheckKind::CpLane), Some(CheckResult::Shown), "{:?}", made.verdict);
    assert!(made.rollout.ego_track().states[0].y - partner(&made).0[0].y > 2.5);
}

#[test]
fn a_slow_ego_is_seen_to_come_over_the_line_of_its_green_light_and_the_other_over_its_red_one() {
    let account = story(SLOW_AT_GREEN);
    let made = made(&account);
    for kind in [CheckKind::SvControl, CheckKind::CpControl] {
        assert_eq!(result(&made.verdict.checks, kind), Some(CheckResult::Shown), "{:?}", made.verdict);
    }
    assert_eq!(moved(&account, &made, 0.0, CheckKind::CpControl), Some(CheckResult::Shown));
    let mut red = account;
    red.sv.controls.iter_mut().for_each(|fact| fact.value.state = Some(SignalState::Red));
    assert_eq!(moved(&red, &made, 0.0, CheckKind::SvControl), Some(CheckResult::NotShown));
}

#[test]
fn who_runs_red_from_ahead_has_a_light_of_its_own() {
    let made = made(&story(RAN_RED));
    for kind in [CheckKind::SvControl, CheckKind::CpControl] {
        assert_eq!(result(&made.verdict.checks, kind), Some(CheckResult::Shown), "{:?}", made.verdict);
    }
}

#[test]
fn who_was_stopped_at_a_sign_on_the_crossing_road_sets_off_from_its_line() {
    let account = story(FROM_STOP_SIGN);
    let told = account.partner.as_ref().map(|partner| partner.controls[0].value.device);
    assert_eq!(told, Some(ControlDevice::StopSign));
    let made = made(&account);
    assert_eq!(result(&made.verdict.checks, CheckKind::CpControl), Some(CheckResult::Shown), "{:?}", made.verdict);
    assert_eq!(moved(&account, &made, -8.0, CheckKind::CpControl), Some(CheckResult::NotShown));
}

#[test]
fn the_ego_drives_over_the_track_of_a_gate() {
    let mut account = story(GATE_TRACK);
    account.sv.zones = vec![Fact::by_rule(ContactZone::Bottom, "ticked")];
    let made = made(&account);
    assert_eq!(result(&made.verdict.checks, CheckKind::SvZones), Some(CheckResult::Shown), "{:?}", made.verdict);
    assert_eq!(made.draft.objects.len(), 1);
}

const TURN_LANE: &str = "The AV was traveling east on Oak Street in the left lane. A sedan was traveling in the left turn lane to the left of the \
                         AV. The sedan changed lanes to the right, and the front right of the sedan made contact with the left side of \
                         the AV.";

#[test]
fn a_lane_for_left_turns_lies_beside_the_left_lane_and_leads_the_same_way() {
    let mut account = story(TURN_LANE);
    account.sv.lane = Some(Fact::by_rule(LaneWord::Left, "a test"));
    account.came_from = Some(Fact::by_rule(Origin::Beside { side: LeftRight::Left }, "a test"));
    account.partner.as_mut().expect("a partner").lane = Some(Fact::by_rule(LaneWord::LeftTurn, "a test"));
    assert!(account.place.features.iter().any(|fact| fact.value == RoadFeature::TurnLane), "{:?}", account.place);
    let made = made(&account);
    // One lane more than a street has.
    assert_eq!(strips(&made).iter().filter(|kind| **kind == StripKind::Driving).count(), 3);
    for kind in [CheckKind::SvLane, CheckKind::CpLane] {
        assert_eq!(result(&made.verdict.checks, kind), Some(CheckResult::Shown), "{:?}", made.verdict);
    }
    let aside_m = partner(&made).0[0].y - made.rollout.ego_track().states[0].y;
    assert!((2.5..4.3).contains(&aside_m), "{aside_m} m to the left");
    // In the ego's lane it is in none for turns; and without one the ego's is not the left lane.
    assert_eq!(moved(&account, &made, -3.4, CheckKind::CpLane), Some(CheckResult::NotShown));
    let mut without = account;
    without.place.features.retain(|fact| fact.value != RoadFeature::TurnLane);
    assert_eq!(moved(&without, &made, 0.0, CheckKind::SvLane), Some(CheckResult::NotShown));
}

#[test]
fn a_lane_of_the_crossing_road_is_none_of_a_narrow_street() {
    let account = story(
        "The AV was stopped facing north on a narrow section of Elm Street for a red light at the intersection with Oak Street. A pickup truck traveling east in \
         the right lane of Oak Street turned right onto Elm Street, and the left side of the pickup truck made contact with the left side of the AV.",
    );
    assert!(account.place.features.iter().any(|fact| fact.value == RoadFeature::NarrowStreet));
    let shown = made(&account);
    let MapSpec::G(map) = &shown.draft.map else { panic!("a graph") };
    assert_eq!(map.roads[0].left.iter().filter(|strip| strip.kind == StripKind::Driving).count(), 1);
}

#[test]
fn who_is_parked_partly_in_the_lane_stands_on_its_edge() {
    let text = "The AV was parked partially in-lane at the curb facing north on Elm Street. A sedan traveling north passed the AV on the left and the right side of the \
                sedan made contact with the rear left of the stationary AV.";
    let beside_m = |text: &str| {
        let shown = made(&story(text));
        let (states, _) = partner(&shown);
        states[0].y - shown.rollout.ego_track().states[0].y
    };
    let (partly, wholly) = (beside_m(text), beside_m(&text.replace("partially in-lane at", "at")));
    assert!((0.8..2.0).contains(&partly) && wholly > partly + 1.0, "{partly} m, {wholly} m");
    let faces = text.replace(
        "partially in-lane at the curb facing north on Elm Street",
        "facing north on Elm Street, partially in the right lane",
    );
    let shown = made(&story(&faces));
    let lane = shown.verdict.checks.iter().find(|check| check.kind == CheckKind::SvLane).expect("a told lane");
    assert_eq!((lane.result, beside_m(&faces) < 2.0), (CheckResult::Shown, true), "{lane:?}");
}

#[test]
fn a_one_way_street_has_no_lanes_towards_the_ego_at_a_junction() {
    let shown = made(&story(
        "The AV was traveling north in the left lane of Elm Street, a one-way street, and came to a stop for a red light at the intersection with Oak Street. A sedan \
         approached from behind and the front of the sedan made contact with the rear of the stationary AV.",
    ));
    let MapSpec::G(map) = &shown.draft.map else { panic!("a graph") };
    let driving = |strips: &[recrash_model::scenario::Strip]| {
        strips.iter().filter(|strip| strip.kind == StripKind::Driving).count()
    };
    let [own, ahead] = ["own", "ahead"].map(|id| map.roads.iter().find(|road| road.id == id).expect("an arm"));
    assert_eq!([driving(&own.right), driving(&ahead.left)], [0, 0]);
    assert!(driving(&own.left) > 0 && driving(&ahead.right) > 0);
    assert!(shown.draft.control.iter().all(|control| control.at != "ahead-"));
}
