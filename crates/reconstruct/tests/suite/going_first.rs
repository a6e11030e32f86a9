//! Who comes over a crosswalk, who goes by before the ego sets off, and for whom the partner, or one ahead, leaves its lane.

use crate::others::track;
use crate::ways::{before_contact, made, partner, story};
use recrash_model::account::{Account, ActFact, Fact, Speed, SpeedMeaning};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_reconstruct::held_against;

const OVER_THE_CROSSWALK: &str = "The AV was traveling north on Elm Street through the intersection with Oak Street. A cyclist riding on the sidewalk entered the crosswalk from \
                                  the right, and the front of the AV made contact with the cyclist.";

const ALONG_THE_STREET: &str = "The AV was traveling north on Elm Street through the intersection with Oak Street. A cyclist traveling west on Oak Street entered the intersection \
                                from the right, and the front of the AV made contact with the cyclist.";

const GONE_BY: &str = "The AV was waiting to turn left at a signal. After a motorcycle and a taxi had gone by, the AV started its left turn. An oncoming sedan \
                       drove straight on, and the front of the sedan made contact with the right side of the AV.";

const ROUND_A_BUS: &str = "The AV was traveling in the left lane next to an SUV traveling in the right lane. The SUV began to change lanes to the left to go around a \
                           stopped bus, and the front left of the SUV made contact with the right side of the AV.";

const SLOW_TRUCK: &str = "The AV was traveling in the center of three lanes. A sedan in the right lane came up behind a slower heavy truck and began to change lanes \
                          to the left. The front left of the sedan made contact with the right side of the AV.";

const UNCOVERED: &str = "The AV was traveling west in the middle of three lanes. A person was walking in the same lane. A pickup truck ahead of the AV swerved to \
                         the left lane. The AV braked, and the front of the AV made contact with the person.";

/// How far from the middle of a junction of two lanes each way its crosswalks lie, before it and behind it. [m]
const CROSSWALK_M: std::ops::Range<f64> = 5.8..10.3;

fn at(mut account: Account, mps: f64) -> Account {
    account.sv.speeds = vec![Fact::of_column(Speed { mps, meaning: SpeedMeaning::Impact }, "SV Precrash Speed (MPH)")];
    account
}

#[test]
fn who_rides_over_a_crosswalk_keeps_to_it_and_who_comes_along_the_road_to_its_lane() {
    let shown = made(&at(story(OVER_THE_CROSSWALK), 6.0));
    let (states, met) = partner(&shown);
    let last = before_contact(&shown);
    assert!(CROSSWALK_M.contains(&met.x.abs()), "{met:?}");
    assert!(states[..=last].iter().all(|state| (state.x - met.x).abs() < 0.6), "it goes straight over");
    let (_, met) = partner(&made(&at(story(ALONG_THE_STREET), 6.0)));
    assert!(!CROSSWALK_M.contains(&met.x.abs()), "{met:?}");
}

#[test]
fn who_had_gone_by_is_past_an_ego_that_sets_off_to_turn_then() {
    let account = at(story(GONE_BY), 4.0);
    let shown = made(&account);
    let ego = shown.rollout.ego_track();
    let off = ego.states.iter().position(|state| state.speed() > 0.2).expect("it sets off");
    for id in ["oncoming", "near"] {
        let state = &track(&shown, id).states[off];
        assert!(state.x < ego.states[off].x && state.y > ego.states[off].y + 1.5, "{id}: {state:?}");
    }
    // One that is yet to come has not gone by.
    let scenario = recrash_roads::check(shown.draft).expect("it ran").value;
    let mut later = shown.rollout.clone();
    let near = later.actors.iter_mut().find(|track| track.id == "near").expect("drawn");
    near.states.iter_mut().for_each(|state| state.x += 60.0);
    let checks = held_against(&account, &scenario, &later).expect("it can be staged").checks;
    let others = checks.iter().find(|check| check.kind == CheckKind::Others).expect("told");
    assert_ne!(others.result, CheckResult::Shown, "{others:?}");
}

#[test]
fn for_whom_the_partner_leaves_its_lane_stands_or_is_slow_in_that_ahead_of_it() {
    for (text, slow) in [(ROUND_A_BUS, false), (SLOW_TRUCK, true)] {
        let shown = made(&at(story(text), 12.0));
        let ((states, met), last) = (partner(&shown), before_contact(&shown));
        let passed = &track(&shown, "passed").states[last];
        assert!((passed.y - states[0].y).abs() < 1.0 && passed.x > met.x, "{passed:?}");
        assert_eq!(passed.speed() > 1.0, slow);
        assert!(passed.speed() < met.speed() - 1.0, "{passed:?}");
    }
    // Told at another place it is no reason of the partner's.
    let mut account = at(story(ROUND_A_BUS), 12.0);
    let far = |fact: &mut ActFact| fact.source = Fact::by_rule((), "a test").source;
    account.partner.as_mut().expect("told").acts.iter_mut().for_each(far);
    assert!(made(&account).rollout.actors.iter().all(|track| track.id != "passed"));
}

#[test]
fn who_swerves_into_the_next_lane_ahead_was_in_the_ego_s() {
    let shown = made(&at(story(UNCOVERED), 9.0));
    let (near, ego, last) = (track(&shown, "near"), shown.rollout.ego_track(), before_contact(&shown));
    assert!((near.states[0].y - ego.states[0].y).abs() < 0.5 && near.states[0].x > ego.states[0].x);
    assert!(near.states[last].y - ego.states[last].y > 2.0, "{:?}", near.states[last]);
}
