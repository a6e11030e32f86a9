//! How fast the two drive as told: hard braking, at a run, slowly before a stop, at a high speed; and nobody slows for the end of its way.

use crate::ways::{before_contact, checks_without, made, partner, speeds, story};
use recrash_model::account::{Account, Manner};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorState;
use recrash_reconstruct::Reconstruction;

const BRAKED_HARD: &str = "The AV was traveling north on Elm Street. A van traveling south crossed over the center line into the AV's lane. The AV braked hard and \
                           the front of the van made contact with the front of the AV.";

const STOPPED_HARD: &str = "The AV was traveling north on Elm Street when it came to an abrupt stop for a dog. A sedan behind the AV made contact with the rear of the AV.";

const RAN: &str = "The AV was stopped at a red light on Elm Street. A pedestrian ran into the street from the right and made contact with the right side of the AV.";

const SLOWLY: &str = "The AV was traveling slowly north on Elm Street when it stopped to yield to a pedestrian. A sedan behind the AV made contact with the rear of the AV.";

const FAST: &str = "The AV was traveling on a highway in the center lane at 60 mph. A sedan approached from directly behind the AV at a high rate of speed and made contact with the \
                    rear of the AV.";

const PUSHED_FAST: &str = "The AV was stopped at a red light on Elm Street, and a sedan stopped behind it. A pickup truck approached at a high rate of speed and struck the \
                           sedan, which was pushed into the rear of the AV.";

const ACROSS_TURN: &str = "The AV was making a left turn at the intersection of Elm Street and Oak Street. An oncoming sedan in the right lane proceeded straight through the \
                           intersection and the front of the sedan made contact with the right rear of the AV.";

/// What somebody loses at most within 0.4 s. [m/s]
fn hardest(speeds: &[f64]) -> f64 {
    speeds.windows(5).map(|five| five[0] - five[4]).fold(0.0, f64::max)
}

fn without_manner(account: &mut Account) {
    let parties = [Some(&mut account.sv), account.partner.as_mut()].into_iter().flatten();
    parties.flat_map(|party| &mut party.acts).for_each(|fact| fact.manner = None);
    account.others.iter_mut().flat_map(|other| &mut other.acts).for_each(|fact| fact.manner = None);
}

/// The fact of this kind is not shown where nobody tells how it was done.
fn asks(text: &str, kind: CheckKind) {
    let check = checks_without(&story(text), without_manner).into_iter().find(|check| check.kind == kind).unwrap();
    assert_ne!(check.result, CheckResult::Shown, "{check:?}");
}

fn fastest(states: &[ActorState]) -> f64 {
    states.iter().map(|state| state.velocity().length()).fold(0.0, f64::max)
}

fn of<'a>(made: &'a Reconstruction, id: &str) -> &'a [ActorState] {
    let track = made.rollout.actors.iter().find(|track| track.id == id).expect("somebody");
    &track.states[..=before_contact(made)]
}

#[test]
fn who_brakes_hard_does() {
    for text in [BRAKED_HARD, STOPPED_HARD] {
        let hard = hardest(&speeds(&made(&story(text))));
        let plain = hardest(&speeds(&made(&story(
            &text.replace(" hard", "").replace("abrupt ", "").replace("an stop", "a stop"),
        ))));
        assert!(hard > 2.0 && plain < 1.2, "{hard} {plain}");
        asks(text, CheckKind::SvActs);
    }
}

#[test]
fn who_is_told_to_run_does() {
    let ran = fastest(of(&made(&story(RAN)), "cp"));
    assert!((2.2..4.0).contains(&ran), "{ran}");
    asks(RAN, CheckKind::CpState);
}

#[test]
fn who_came_slowly_to_its_stop_did() {
    let came = speeds(&made(&story(SLOWLY)));
    assert!(came[0] < 3.5 && came[0] > 1.0, "{}", came[0]);
    asks(SLOWLY, CheckKind::SvState);
    let usual = speeds(&made(&story(&SLOWLY.replace("slowly ", ""))));
    assert!(usual[0] > 5.0, "{}", usual[0]);
}

#[test]
fn who_is_fast_keeps_its_speed_and_its_line() {
    let made = made(&story(FAST));
    let (states, met) = partner(&made);
    let first = states[0].speed();
    assert!(first > 24.0 && first - met.speed() < 0.3, "{first} {}", met.speed());
    let aside = states.iter().map(|state| (state.y - states[0].y).abs()).fold(0.0, f64::max);
    assert!(aside < 0.2, "{aside}");
}

#[test]
fn who_pushes_another_comes_as_fast_as_told() {
    let pusher = fastest(of(&made(&story(PUSHED_FAST)), "pusher"));
    assert!(pusher > 12.0, "{pusher}");
    asks(PUSHED_FAST, CheckKind::PassedOn);
    assert_eq!(story(PUSHED_FAST).others[0].acts[0].manner, Some(Manner::Fast));
}

#[test]
fn who_goes_straight_on_across_a_turn_does_not_bend_for_it() {
    let made = made(&story(ACROSS_TURN));
    let (states, met) = partner(&made);
    let bent = (met.heading - states[0].heading).to_degrees().abs();
    assert!(bent < 5.0, "{bent}");
}

/// The account of a report with this column speed. [m/s]
fn with_column(text: &str, mps: f64) -> Account {
    let mut record = crate::common::record("1-1", 1, text);
    record.sv_speed_mps = Some(mps);
    recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account")
}

const HIT_AT_A_LIGHT: &str = "The AV was stopped at a red light on Elm Street. A van approached from behind and the front of the van made contact with the rear of the AV.";

const HIT_ON_ITS_WAY: &str = "The AV was traveling north on Elm Street. A van approached from behind and the front of the van made contact with the rear of the AV.";

#[test]
fn a_speed_that_the_state_overrules_is_no_stated_fact() {
    for (text, mps, is_stated) in [
        (HIT_AT_A_LIGHT, 0.0, true),
        (HIT_AT_A_LIGHT, 1.34, false),
        (HIT_ON_ITS_WAY, 5.0, true),
        (HIT_ON_ITS_WAY, 0.0, false),
    ] {
        let account = with_column(text, mps);
        let made = made(&account);
        let held = made.verdict.checks.iter().any(|check| check.kind == CheckKind::SvSpeed);
        assert_eq!(held, is_stated, "{text} {mps}");
        assert_eq!(account.contradictions.is_empty(), is_stated, "{:?}", account.contradictions);
    }
}

#[test]
fn who_stands_does_not_show_a_speed_however_small() {
    let stands = made(&with_column(HIT_AT_A_LIGHT, 0.0));
    let mut moves = with_column(HIT_AT_A_LIGHT, 1.34);
    moves.sv.state = None;
    let scenario = recrash_roads::check(stands.draft).unwrap().value;
    let held = recrash_reconstruct::held_against(&moves, &scenario, &stands.rollout).unwrap();
    let speed = held.checks.iter().find(|check| check.kind == CheckKind::SvSpeed).unwrap();
    assert_eq!(speed.result, CheckResult::NotShown, "{speed:?}");
}

#[test]
fn an_order_that_is_not_shown_says_by_how_much_it_has_to_be() {
    let mut account = story(HIT_AT_A_LIGHT);
    account.order =
        Some(recrash_model::account::Fact::by_rule(recrash_model::narrative::FirstMover::Cp, "made for this test"));
    let stands = made(&story(HIT_AT_A_LIGHT));
    let scenario = recrash_roads::check(stands.draft).unwrap().value;
    let held = recrash_reconstruct::held_against(&account, &scenario, &stands.rollout).unwrap();
    let order = held.checks.iter().find(|check| check.kind == CheckKind::Order).unwrap();
    assert_eq!(order.expected, "the partner, by more than 0.10 s");
}

const FAST_IN_AN_ALLEY: &str = "The AV was stopped in an alley. A van approached from behind at a high rate of speed and the front of the van made contact with the \
                                rear of the AV.";

#[test]
fn who_is_fast_in_an_alley_is_not_as_fast_as_on_a_street() {
    let speed = |text: &str| partner(&made(&story(text))).1.speed();
    let (alley, lot) = (speed(FAST_IN_AN_ALLEY), speed(&FAST_IN_AN_ALLEY.replace("an alley", "a parking lot")));
    let street = speed(&FAST_IN_AN_ALLEY.replace("in an alley", "on Elm Street"));
    assert!(alley < 8.0 && (alley - lot).abs() < 0.5 && street > 12.0, "{alley} {lot} {street}");
}
