//! What the two do to each other, and in which order: who enters the junction, who passes whom, who comes out of whose lane.

use crate::others::told;
use crate::ways::{before_contact, checks_without, made, partner, story, without_acts};
use recrash_model::account::{Account, Act};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;
use recrash_model::scenario::Aspect;
use recrash_reconstruct::Reconstruction;

const ENTERED: &str = "The AV was traveling north on Elm Street and entered the intersection with Oak Street on a yellow light. The AV braked and came to a stop. \
                       A van approached from behind and the front of the van made contact with the rear of the stationary AV.";

const PASSED: &str = "The AV was traveling north on Elm Street and passed a street sweeper on the left. As the AV was passing the street sweeper, the street sweeper veered \
                      to the left and the front left of the street sweeper made contact with the right side of the AV.";

const COMES_OUT: &str = "The AV was stopped at a red light on Elm Street. A van that was stopped behind the AV changed lanes to the left, and the right side of the van \
                         made contact with the rear left of the AV.";

const MAKES_ROOM: &str = "The AV was traveling north on a narrow street. A van turned left from a side street on the right toward the AV. The AV moved over and came to a \
                          stop to give way, and the front left of the van made contact with the left side of the stationary AV.";

const CROSSED_OVER: &str = "The AV was traveling north on Elm Street. A van traveling south drifted into the lane of the AV. The AV then came to a stop, and the front of the van \
                            made contact with the front of the stationary AV.";

const STOOD_AND_PASSED: &str = "The AV was stopped on a narrow street to yield. A van traveling in the opposite direction came to a stop, then proceeded forward and passed the AV on the \
                                left, and the left side of the van made contact with the left side of the AV.";

fn acts(made: &Reconstruction, kind: CheckKind) -> (CheckResult, &str) {
    let check = made.verdict.checks.iter().find(|check| check.kind == kind).expect("told");
    (check.result, &check.expected)
}

fn ego(made: &Reconstruction) -> &[ActorState] {
    &made.rollout.ego_track().states[..=before_contact(made)]
}

/// From where the ego's road ends at the junction to its front, at a step. [m]
fn past_line_m(made: &Reconstruction, step: usize) -> f64 {
    let scenario = recrash_roads::check(made.draft.clone()).expect("it ran").value;
    let own = made.draft.control.iter().find(|control| control.at == "own-").expect("a signal").clone();
    let line_m = scenario.network().stop_lines(&[own])[0][0].x;
    ego(made)[step].x + 0.5 * made.rollout.ego_track().length_m - line_m
}

#[test]
fn who_entered_the_junction_stands_in_it_and_came_to_it_at_the_told_light() {
    let account = told(ENTERED);
    let shown = made(&account);
    assert_eq!(acts(&shown, CheckKind::SvActs).0, CheckResult::Shown, "{:?}", shown.verdict);
    assert!(acts(&shown, CheckKind::SvActs).1.contains("entered the junction"), "{:?}", account.sv.acts);
    assert!(past_line_m(&shown, before_contact(&shown)) > 1.0);
    let crosses = (0..ego(&shown).len()).find(|step| past_line_m(&shown, *step) > 0.0).expect("it does");
    let light = &shown.draft.control.iter().find(|control| control.at == "own-").expect("a signal").device;
    assert_eq!(light.aspect(0.1 * crosses as f64), Some(Aspect::Yellow));
    // One that stands before the line has not entered.
    let before = checks_without(&account, |less| without_acts(less, &[Act::Enter]));
    let check = before.iter().find(|check| check.kind == CheckKind::SvActs).expect("told");
    assert!(check.observed.contains("not that it entered the junction"), "{check:?}");
}

#[test]
fn an_ego_that_passes_the_partner_on_a_side_goes_round_it_there() {
    let account = story(PASSED);
    let shown = made(&account);
    let (result, expected) = acts(&shown, CheckKind::SvActs);
    assert!(result == CheckResult::Shown && expected.contains("passed on the left"), "{:?}", shown.verdict);
    let (other, ego) = (partner(&shown).0, ego(&shown));
    assert!(other[0].x > ego[0].x + 5.0, "it comes from behind");
    let aside_m = |step: usize| ego[step].y - ego[0].y;
    let level = (0..ego.len()).find(|step| ego[*step].x > other[*step].x - 4.0).expect("it comes up to it");
    assert!(aside_m(level) > 1.0, "{}", aside_m(level));
}

#[test]
fn who_stood_behind_the_ego_and_changes_lanes_comes_out_of_its_lane() {
    let account = story(COMES_OUT);
    let shown = made(&account);
    assert_eq!(acts(&shown, CheckKind::CpActs).0, CheckResult::Shown, "{:?}", shown.verdict);
    let (other, ego) = (partner(&shown).0, ego(&shown));
    let stood = (0..ego.len()).rfind(|step| other[*step].speed() < 0.1).expect("it stood");
    assert!((other[stood].y - ego[stood].y).abs() < 0.5 && other[stood].x < ego[stood].x - 5.0, "{:?}", other[stood]);
    assert!(other[ego.len() - 1].y - ego[ego.len() - 1].y > 0.8, "{:?}", other[ego.len() - 1]);
}

#[test]
fn who_makes_room_for_one_that_turned_towards_it_does_so_at_the_kerb() {
    let shown = made(&story(MAKES_ROOM));
    let ego = ego(&shown);
    assert!(ego[0].y - ego[ego.len() - 1].y > 0.5, "{:?}", ego[ego.len() - 1]);
}

#[test]
fn who_stops_for_one_that_comes_over_sees_it_come_before_it_brakes() {
    let account: Account = story(CROSSED_OVER);
    let shown = made(&account);
    let (other, ego) = (partner(&shown).0, ego(&shown));
    let brakes = ego.iter().position(|state| state.speed() < ego[0].speed() - 0.5).expect("it brakes");
    assert!(other[0].y - other[brakes].y > 0.02, "{:?}", other[brakes]);
}

#[test]
fn who_stood_before_it_passed_stood_short_of_the_ego() {
    let shown = made(&story(STOOD_AND_PASSED));
    let (result, expected) = acts(&shown, CheckKind::CpActs);
    assert!(result == CheckResult::Shown && expected.ends_with("passed on the left"), "{:?}", shown.verdict);
    let (other, ego) = (partner(&shown).0, ego(&shown));
    let stood = (0..ego.len()).rfind(|step| other[*step].speed() < 0.1).expect("it stood");
    assert!(other[stood].x - ego[stood].x > 4.5, "{:?}", other[stood]);
}
