//! Signals change in step with who stops and sets off at them, signs stand where they are told, and others are as many as told, and where.

use crate::others::{told, track};
use crate::ways::{before_contact, made, speeds};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::scenario::{Aspect, Device};
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};
use recrash_sim::{Ego, simulate};

const TURNED_GREEN: &str = "The AV was traveling north on Elm Street and came to a stop at a red light at the intersection with Oak Street. The light turned \
                            green. While the AV was stationary, a van approached from behind and the front of the van made contact with the rear of the AV.";
const TURNED_RED: &str = "The AV was traveling north on Elm Street and was coming to a stop as the light at the intersection with Oak Street turned red. A van \
                          approached from behind and the front of the van made contact with the rear of the AV.";
const ALL_WAY: &str = "The AV was stopped at a four-way stop at the intersection of Elm Street and Oak Street.";
const QUEUE: &str =
    "The AV came to a stop in a queue of traffic for a red light at the intersection of Elm Street and Oak Street.";
const WALKERS: &str =
    "The AV was traveling north on Elm Street and came to a stop to yield to two pedestrians crossing the street.";
const STAYS: &str = "The AV was traveling north on Elm Street and came to a stop for a pedestrian who entered the road and remained beside the AV.";
const DOG: &str = "The AV was traveling north on Elm Street and came to a stop to yield to a dog that ran into the road. While the AV was stationary, a van that \
                   had been stopped behind the AV set off and the front of the van made contact with the rear of the AV.";

fn fact(made: &Reconstruction, kind: CheckKind) -> &Check {
    made.verdict.checks.iter().find(|check| check.kind == kind).unwrap_or_else(|| panic!("{kind:?} is told"))
}

/// What the ego's light shows. [s]
fn shows(made: &Reconstruction, at_s: f64) -> Option<Aspect> {
    made.draft.control.iter().find(|control| control.at == "own-")?.device.aspect(at_s)
}

/// When the ego comes to a stand first. [s]
fn stands_s(made: &Reconstruction) -> f64 {
    0.1 * speeds(made).iter().position(|speed| *speed < 0.1).expect("it stands") as f64
}

#[test]
fn who_stopped_at_red_is_seen_to_stand_at_red_before_it_is_green() {
    let account = told(TURNED_GREEN);
    let shown = made(&account);
    let at_s = stands_s(&shown);
    assert_eq!(fact(&shown, CheckKind::SvControl).result, CheckResult::Shown, "{:?}", shown.verdict);
    assert_eq!(shows(&shown, at_s + 0.8), Some(Aspect::Red), "{at_s}");
    assert_eq!(shows(&shown, 0.1 * before_contact(&shown) as f64), Some(Aspect::Green));
    // A light that is green before the ego stands is not the one that it stopped for.
    let mut early = shown.draft.clone();
    for control in &mut early.control {
        if let Device::Signal { program, .. } = &mut control.device {
            program[0].for_s = at_s - 0.5;
        }
    }
    let scenario = recrash_roads::check(early).expect("it can run").value;
    let verdict = held_against(&account, &scenario, &simulate(&scenario, Ego::Recorded)).expect("it can be staged");
    let light = verdict.checks.iter().find(|check| check.kind == CheckKind::SvControl).expect("it is told");
    assert_eq!(light.result, CheckResult::NotShown, "{light:?}");
}

#[test]
fn who_stops_as_the_light_turns_red_brakes_for_its_yellow() {
    let shown = made(&told(TURNED_RED));
    assert_eq!(fact(&shown, CheckKind::SvControl).result, CheckResult::Shown, "{:?}", shown.verdict);
    let speeds = speeds(&shown);
    let brakes_s = 0.1 * speeds.iter().position(|speed| *speed < speeds[0] - 0.1).expect("it brakes") as f64;
    assert_eq!(shows(&shown, brakes_s), Some(Aspect::Yellow), "{brakes_s}");
    assert_eq!(shows(&shown, 0.1 * before_contact(&shown) as f64), Some(Aspect::Red));
}

#[test]
fn a_stop_for_all_has_a_sign_on_every_arm() {
    let shown = made(&told(ALL_WAY));
    let signs = |of: &Reconstruction| {
        of.draft.control.iter().filter(|control| matches!(control.device, Device::StopSign {})).count()
    };
    assert_eq!(signs(&shown), 4, "{:?}", shown.draft.control);
    assert_eq!(signs(&made(&told(&ALL_WAY.replace("four-way stop", "stop sign")))), 1);
}

#[test]
fn of_a_queue_two_stand_ahead_and_the_first_is_at_the_line() {
    let shown = made(&told(QUEUE));
    let last = before_contact(&shown);
    let front = |id: &str| track(&shown, id).states[last].x + 0.5 * track(&shown, id).length_m;
    let line_m = {
        let scenario = recrash_roads::check(shown.draft.clone()).expect("it ran").value;
        let own = shown.draft.control.iter().find(|control| control.at == "own-").expect("a signal").clone();
        scenario.network().stop_lines(&[own])[0][0].x
    };
    let (one, two) = (front("lead"), front("lead-2"));
    assert!(two > one + 4.0 && (0.0..2.0).contains(&(line_m - two)), "{one}, {two}, {line_m}");
}

#[test]
fn two_who_cross_are_two() {
    let shown = made(&told(WALKERS));
    let last = before_contact(&shown);
    let [one, two] = ["walker", "walker-2"].map(|id| track(&shown, id).states[last]);
    assert!(one.position().distance(two.position()) < 4.0, "{one:?}, {two:?}");
}

#[test]
fn who_stays_close_does_not_cross() {
    let account = told(STAYS);
    let shown = made(&account);
    assert!(fact(&shown, CheckKind::Others).expected.contains("stays close"), "{:?}", account.others);
    assert_eq!(fact(&shown, CheckKind::Others).result, CheckResult::Shown, "{:?}", shown.verdict);
    let (walker, ego) = (track(&shown, "bystander"), shown.rollout.ego_track());
    let last = before_contact(&shown);
    assert!(walker.kind == PartnerKind::Pedestrian && walker.states[last].speed() < 0.1);
    let aside_m = walker.states[last].y - ego.states[last].y;
    assert!((1.0..4.0).contains(&aside_m.abs()), "{aside_m}");
}

#[test]
fn an_animal_for_which_the_ego_stands_is_before_it_yet() {
    let shown = made(&told(DOG));
    let (animal, ego) = (track(&shown, "animal"), shown.rollout.ego_track());
    let last = before_contact(&shown);
    assert!((animal.states[last].y - ego.states[last].y).abs() < 4.0, "{:?}", animal.states[last]);
}

const AT_YELLOW: &str = "The AV was stopped at the intersection of Elm Street and Oak Street facing a green light. When the light turned yellow, a sedan that \
                         had been stopped behind the AV passed the AV on the left, and the right side of the sedan made contact with the rear \
                         left of the stationary AV.";
const RIGHT_ON_RED: &str = "The AV was traveling north on Elm Street and came to a stop at a red light at the intersection with Oak Street. The AV began to \
                            turn right onto Oak Street and came to a stop. A van approached from behind and the front of the van made contact with the \
                            rear of the stationary AV.";
const CREPT_IN: &str = "The AV was traveling north on Elm Street and came to a stop at a red light at the intersection with Oak Street. The AV entered the \
                        intersection and came to a stop. A van approached from behind and the front of the van made contact with the rear of the \
                        stationary AV.";

#[test]
fn who_waits_and_sets_off_at_yellow_does_so_when_it_is_yellow() {
    let shown = made(&told(AT_YELLOW));
    let states = crate::ways::partner(&shown).0;
    let goes_s = 0.1 * states.iter().rposition(|state| state.speed() < 0.1).expect("it stands") as f64;
    assert_eq!(shows(&shown, goes_s), Some(Aspect::Yellow), "{goes_s}");
    assert_eq!(shows(&shown, 0.1 * before_contact(&shown) as f64), Some(Aspect::Yellow));
}

#[test]
fn who_stood_at_red_may_turn_right_or_creep_over_its_line_at_red() {
    for text in [RIGHT_ON_RED, CREPT_IN] {
        let shown = made(&told(text));
        assert!(shown.missed().is_none(), "{:?}", shown.missed());
        assert_eq!(shows(&shown, 0.1 * before_contact(&shown) as f64), Some(Aspect::Red), "{text}");
        assert!(fact(&shown, CheckKind::SvControl).observed.contains("crossed"), "{text}");
    }
    // Who turns left does so at green.
    let left = made(&told(&RIGHT_ON_RED.replace("turn right", "turn left")));
    assert_eq!(shows(&left, 0.1 * before_contact(&left) as f64), Some(Aspect::Green));
}

#[test]
fn who_turns_left_on_an_arrow_has_red_ahead_of_it() {
    let text = "The AV was traveling south on Elm Street and was making a left turn onto Oak Street on a green arrow. A sedan traveling north on Elm Street entered the \
                intersection and the front of the sedan made contact with the front right of the AV.";
    let ahead = |text: &str| {
        let shown = made(&told(text));
        let at_s = 0.1 * before_contact(&shown) as f64;
        shown
            .draft
            .control
            .iter()
            .find(|control| control.at == "ahead-")
            .and_then(|control| control.device.aspect(at_s))
    };
    assert_eq!(ahead(text), Some(Aspect::Red));
    assert_eq!(ahead(&text.replace("green arrow", "green light")), Some(Aspect::Green));
}

const INTO_THE_JUNCTION: &str = "The AV was stopped at a red light at the intersection of Elm Street and Oak Street. The AV then drove straight into the intersection \
                                 and stopped in the intersection for a pedestrian. A sedan coming from the right struck the right side of the AV with its front.";

const RIGHT_AT_GREEN: &str = "The AV was stopped at a red light. After the light changed, the AV began turning right when a sedan approached from behind and the front of \
                              the sedan made contact with the rear of the AV.";

#[test]
fn who_drives_far_over_its_line_at_red_or_turned_right_as_it_changed_has_not_kept_red() {
    let far = reconstruct(&told(INTO_THE_JUNCTION)).expect("it can be staged");
    let crossed = fact(&far, CheckKind::SvControl).observed.contains("crossed");
    assert!(!crossed || fact(&far, CheckKind::SvControl).result == CheckResult::NotShown, "{:?}", far.verdict);
    let green = reconstruct(&told(RIGHT_AT_GREEN)).expect("it can be staged");
    let light = fact(&green, CheckKind::SvControl);
    let at_green = shows(&green, 0.1 * before_contact(&green) as f64) == Some(Aspect::Green);
    assert!(at_green || light.result == CheckResult::NotShown, "{light:?}");
}
