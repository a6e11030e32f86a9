//! Who was at the place first, whom somebody passed, and what each did as the other came.

use crate::ways::{before_contact, made, partner, story};
use recrash_model::account::{Account, Fact, LeftRight, Obeyed, Speed, SpeedMeaning};
use recrash_model::math;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::narrative::FirstMover;
use recrash_model::scenario::Aspect;
use recrash_model::template::Movement;
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};

const BACKS_OUT: &str = "The AV was traveling north on Elm Street at 26 mph. A pickup truck reversed out of a driveway on the right, and the \
                         rear of the pickup truck made contact with the rear right of the AV.";

const ACROSS: &str = "The AV began to cross Elm Street, facing east, to enter a parking lot. The AV slowed to a stop in the northbound lane to \
                      yield to traffic. While the AV was stopped, a van traveling north on Elm Street in the opposing lane proceeded to \
                      pass the AV on the left, and the right side of the van made contact with the rear left side of the stationary AV.";

const SIGN_AHEAD: &str = "The AV was traveling north when it began to slow for a stop sign at the intersection with Oak Street. While the AV \
                          was slowing, a van reversed out of a parking stall on the left, and the rear right of the van made contact \
                          with the rear left of the AV.";

const SLOWED_BEHIND: &str = "The AV was traveling south when it began to slow for traffic ahead. As the AV was slowing, a sedan made contact \
                             with the rear of a van that was slowing behind the AV. The van was pushed forward, and the front of the van \
                             made contact with the rear of the AV.";

const OUT_OF_THE_TURN_LANE: &str = "The AV was traveling west in the right lane. A sedan traveling east in the center two-way left turn lane \
                                    drifted to its left, across one lane and into the lane of the AV, and the front left of the sedan \
                                    made contact with the front left of the AV.";

const INTO_THE_JUNCTION: &str = "The AV was stopped facing north at a green light at the intersection with Oak Street. The AV proceeded forward \
                                 into the intersection and then slowed to a stop. A sedan that was stopped behind the AV proceeded \
                                 forward, and the front of the sedan made contact with the rear of the stationary AV.";

const OUT_OF_A_QUEUE: &str = "The AV was traveling north in the right lane and began to slow for a red light. A sedan that was stopped in the left \
                              lane changed lanes to the right, and the front right of the sedan made contact with the left side of the AV.";

const OVER_A_SIGN: &str = "The AV was traveling north on Elm Street when it came to the intersection with Oak Street. A sedan exited a driveway \
                           on the right without stopping at the stop sign, turned right, and the front left of the sedan made contact \
                           with the right side of the AV.";

const OTHER_WAY_ROUND: &str = "The AV was traveling east on a narrow street when it approached a sedan parked on the left side of the road. The \
                               driver-side door of the sedan was opened, and the left side of the AV made contact with the left side \
                               door of the sedan.";

const STAYS_AT_RED: &str = "The AV came to a stop at a red light. The operator maneuvered the AV to the right into the turn lane, and the front \
                            right of the AV struck a sedan in that lane.";

fn check(made: &Reconstruction, kind: CheckKind) -> &Check {
    made.verdict.checks.iter().find(|check| check.kind == kind).expect("told")
}

fn at(mut account: Account, mps: f64) -> Account {
    account.sv.speeds = vec![Fact::of_column(Speed { mps, meaning: SpeedMeaning::Impact }, "SV Precrash Speed (MPH)")];
    account
}

#[test]
fn a_flank_that_passes_is_at_the_place_before_who_backs_slowly_to_it() {
    let account = story(BACKS_OUT);
    let shown = made(&account);
    assert!(check(&shown, CheckKind::Order).observed.starts_with("the ego, by 0."), "{:?}", shown.verdict);
    let mut other = account.clone();
    other.order = Some(Fact::by_rule(FirstMover::Cp, "a test"));
    let scenario = recrash_roads::check(shown.draft).expect("it ran").value;
    let checks = held_against(&other, &scenario, &shown.rollout).expect("it can be staged").checks;
    assert!(checks.iter().any(|check| check.kind == CheckKind::Order && check.result == CheckResult::NotShown));
}

#[test]
fn one_that_stands_across_is_passed_on_a_side_of_who_passes() {
    let mut account = story(ACROSS);
    let shown = made(&account);
    assert_eq!(check(&shown, CheckKind::CpActs).expected, "passed on the left");
    for fact in &mut account.partner.as_mut().expect("told").acts {
        fact.side = fact.side.map(LeftRight::other);
    }
    let scenario = recrash_roads::check(shown.draft).expect("it ran").value;
    let checks = held_against(&account, &scenario, &shown.rollout).expect("it can be staged").checks;
    let acts = checks.iter().find(|check| check.kind == CheckKind::CpActs);
    assert!(acts.is_none_or(|acts| acts.result != CheckResult::Shown || !acts.expected.contains("right")), "{acts:?}");
}

#[test]
fn who_slows_for_a_sign_has_yet_to_stand_at_it() {
    let shown = made(&at(story(SIGN_AHEAD), 1.0));
    let ego = &shown.rollout.ego_track().states[..=before_contact(&shown)];
    assert!(ego.iter().all(|state| state.speed() > 0.5) && ego[0].speed() > 3.0);
}

#[test]
fn who_is_thrown_behind_an_ego_that_slows_slows_behind_it() {
    let shown = made(&at(story(SLOWED_BEHIND), 0.5));
    let (states, _) = partner(&shown);
    assert!(states[0].x < shown.rollout.ego_track().states[0].x - 3.0 && states[0].speed() > 2.0, "{:?}", states[0]);
}

#[test]
fn who_is_on_the_wrong_side_by_a_column_comes_over_from_the_lane_that_words_tell() {
    let wrong = |text: &str| {
        let mut account = story(text);
        let partner = account.partner.as_mut().expect("told");
        partner.movement = Some(Fact::of_column(Movement::WrongWay, "CP Pre-Crash Movement"));
        made(&at(account, 6.7))
    };
    let shown = wrong(OUT_OF_THE_TURN_LANE);
    let (states, met) = partner(&shown);
    assert!((states[0].y - met.y).abs() > 1.5, "{met:?}");
    // Of one that is there from the start no lane of its own is told.
    let there = "The AV was traveling west. A sedan traveling east in the lane of the AV drifted to its right, and the front left of the sedan \
                 made contact with the front left of the AV.";
    assert_eq!(check(&wrong(there), CheckKind::CpMovement).expected, "wrong way");
}

#[test]
fn who_waited_behind_an_ego_that_comes_into_the_junction_stood_behind_where_that_did() {
    let shown = made(&story(INTO_THE_JUNCTION));
    let (ego, (states, _)) = (shown.rollout.ego_track(), partner(&shown));
    let gap_m = ego.states[0].x - states[0].x;
    assert!((5.0..9.0).contains(&gap_m), "{gap_m}");
}

#[test]
fn who_stood_beside_an_ego_that_slows_has_not_come_along_with_it() {
    let shown = made(&at(story(OUT_OF_A_QUEUE), 8.0));
    let (states, met) = partner(&shown);
    assert!(states.iter().any(|state| state.speed() == 0.0) && met.speed() > 1.0, "{met:?}");
}

#[test]
fn a_sign_before_a_driveway_cannot_be_shown() {
    let mut account = story(OVER_A_SIGN);
    account.partner.as_mut().expect("told").movement =
        Some(Fact::of_column(Movement::RightTurn, "CP Pre-Crash Movement"));
    assert_eq!(check(&made(&account), CheckKind::CpControl).result, CheckResult::CannotBeShown);
    // Of who comes by a road it is asked for.
    let by_road = "The AV was traveling north on Elm Street when a sedan traveling west on Oak Street ran a stop sign, and the front of the \
                   sedan made contact with the right side of the AV.";
    let shown = made(&story(by_road));
    assert_eq!(check(&shown, CheckKind::CpControl).result, CheckResult::Shown);
}

#[test]
fn who_is_parked_with_the_told_side_to_the_ego_faces_it() {
    let account = story(OTHER_WAY_ROUND);
    let shown = made(&account);
    assert!(math::cos(partner(&shown).1.heading) < -0.9);
}

#[test]
fn who_changes_lanes_before_its_line_does_so_at_red() {
    let mut account = story(STAYS_AT_RED);
    account.sv.movement = Some(Fact::of_column(Movement::ChangingLanes, "SV Pre-Crash Movement"));
    let made = reconstruct(&account).expect("it can be staged");
    let own = made.draft.control.iter().find(|control| control.at == "own-").expect("a light");
    assert_eq!(own.device.aspect(9.0), Some(Aspect::Red));
    assert!(account.sv.controls.iter().all(|control| control.value.obeyed == Some(Obeyed::Yes)));
}
