//! What one of the two is told to have done behind what the other did comes behind it; sides and places of acts are held to.

use crate::ways::{before_contact, made, partner, speeds, story};
use recrash_model::account::{Account, Act, Fact, LeftRight, Party};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::zones::ContactZone;

const BACKED: &str = "The AV was traveling north behind a box truck. The box truck stopped and began to reverse. The AV came to a stop, \
                      and the rear of the box truck made contact with the front of the AV.";

const STOOD: &str = "The AV was traveling west when it came to a stop behind a box truck that was stopped in the same lane. The box truck then \
                     began to reverse, and the rear of the box truck made contact with the front of the AV.";

const TURNED: &str = "The AV was traveling east in the right lane when a van traveling east in the left adjacent lane began to make a right turn \
                      across the path of the AV. As the van turned, the AV slowed to a stop. The right side of the van made contact with \
                      the front left of the stopped AV.";

const PASSED: &str = "The AV was stopped at a red light on Elm Street. A van that was stopped behind the AV passed the AV on the left, and the right side \
                      of the van made contact with the left side of the AV.";

const CREPT: &str = "The AV was stopped. An oncoming sedan slowly proceeded forward and the front of the sedan made contact with the \
                     front of the AV.";

const RACED: &str = "The AV was stopped at a red light. A sedan approached from behind at a high rate of speed and the front of the sedan made \
                     contact with the rear of the AV.";

const QUEUED: &str = "The AV was stopped at a red light. After the light turned green and the AV began to accelerate, a sedan behind the AV made \
                      contact with the rear of the AV.";

const TURNED_LATER: &str = "The AV was traveling north on Elm Street and stopped for a stop sign at the intersection with Oak Street. A van traveling west on \
                            Oak Street came to a stop at a stop sign. The AV then began to turn left. The van moved forward, and the front of the \
                            van made contact with the right side of the AV.";

const WENT_FIRST: &str = "The AV was stopped at a red light on Elm Street. The light turned green and the sedan behind the AV began moving forward. The AV \
                          then also began moving forward, and the front of the sedan made contact with the rear of the AV.";

const PULLED_OVER: &str = "The AV had pulled over to the curb on Elm Street to pick up a passenger. A sedan began to reverse out of a driveway on the right, and the \
                           rear of the sedan made contact with the right side of the stopped AV.";

fn after(party: &Party, act: Act) -> Option<u32> {
    party.acts.iter().find(|fact| fact.act == act).expect("told").after_other
}

fn step(party: &Party, act: Act) -> u32 {
    party.acts.iter().find(|fact| fact.act == act).expect("told").step
}

fn result(account: &Account, kind: CheckKind) -> (CheckResult, String) {
    let made = made(account);
    let check = made.verdict.checks.iter().find(|check| check.kind == kind).expect("told");
    (check.result, check.observed.clone())
}

#[test]
fn an_ego_that_stops_for_one_that_backs_stops_behind_that() {
    let account = story(BACKED);
    let partner = account.partner.as_ref().expect("told");
    assert_eq!(after(&account.sv, Act::Stop), Some(step(partner, Act::Reverse)));
    assert_eq!(result(&account, CheckKind::SvActs).0, CheckResult::Shown);
    // One that stands before the truck backs does not answer it.
    let mut scene = made(&account);
    let at = before_contact(&scene);
    scene.rollout.actors[0].states[30..=at].iter_mut().for_each(|state| (state.vx, state.vy) = (0.0, 0.0));
    let scenario = recrash_roads::check(scene.draft).expect("it can be drawn").value;
    let held = recrash_reconstruct::held_against(&account, &scenario, &scene.rollout).expect("told");
    let acts = held.checks.iter().find(|check| check.kind == CheckKind::SvActs).expect("told");
    assert_eq!(
        (acts.result, acts.observed.as_str()),
        (CheckResult::CannotBeShown, "too early against the other: stopped")
    );
}

#[test]
fn one_that_backs_when_the_ego_has_stopped_does_not_back_before() {
    let account = story(STOOD);
    let partner_acts = account.partner.as_ref().expect("told");
    assert_eq!(after(partner_acts, Act::Reverse), Some(step(&account.sv, Act::Stop)));
    let made = made(&account);
    let stands = speeds(&made).iter().position(|mps| *mps < 0.1).expect("it stands");
    let backs = partner(&made).0.iter().position(|state| state.speed() < -0.1).expect("it backs");
    assert!(backs + 5 >= stands, "it backs from {backs}, the ego stands from {stands}");
}

#[test]
fn an_ego_that_stops_as_a_van_turns_does_not_stand_before_the_turn() {
    let account = story(TURNED);
    assert!(after(&account.sv, Act::Stop).is_some());
    let made = made(&account);
    let (states, at) = (&partner(&made).0, before_contact(&made));
    let turns = states.iter().position(|state| (state.heading - states[0].heading).abs() > 0.02).expect("it turns");
    let stands = speeds(&made)[..=at].iter().position(|mps| *mps < 0.1).expect("it stands");
    // To a second: what begins little by little is seen late.
    assert!(turns <= stands + 10, "the van turns from {turns}, the ego stands from {stands}");
}

#[test]
fn who_is_told_to_pass_on_the_left_does_not_pass_on_the_right() {
    let account = story(PASSED);
    assert_eq!(result(&account, CheckKind::CpActs).0, CheckResult::Shown);
    // Told of the other side.
    let mut other = account.clone();
    let acts = &mut other.partner.as_mut().expect("told").acts;
    acts.iter_mut().for_each(|fact| fact.side = fact.side.map(LeftRight::other));
    other.sv.zones = vec![Fact::by_rule(ContactZone::Rear, "a test")];
    let scene = made(&account);
    let scenario = recrash_roads::check(scene.draft).expect("it can be drawn").value;
    let held = recrash_reconstruct::held_against(&other, &scenario, &scene.rollout).expect("told");
    let acts = held.checks.iter().find(|check| check.kind == CheckKind::CpActs).expect("told");
    assert_eq!(acts.observed, "not that it passed on the right");
}

#[test]
fn words_for_a_speed_bound_the_one_that_is_assumed() {
    let mps = |text: &str| {
        let made = made(&story(text));
        let says = made.assumed.iter().any(|said| said.contains("as it is told to be"));
        assert!(says, "{:?}", made.assumed);
        partner(&made).0[before_contact(&made)].speed().abs()
    };
    assert!(mps(CREPT) < 3.0);
    assert!(mps(RACED) > 15.0);
}

#[test]
fn who_is_told_behind_an_ego_that_sets_off_stood_close_behind_it() {
    let made = made(&story(QUEUED));
    let (states, ego) = (&partner(&made).0, &made.rollout.ego_track().states);
    let sets_off = ego.iter().position(|state| state.speed() > 0.1).expect("it sets off");
    let gap_m = ego[sets_off].x - states[sets_off].x - 5.0;
    assert!(gap_m < 6.0 && states[sets_off].speed() < 0.5, "{gap_m} m behind at {} m/s", states[sets_off].speed());
}

/// The first step at which somebody moves again who stood.
fn sets_off(states: &[recrash_model::rollout::ActorState]) -> usize {
    let stands = states.iter().position(|state| state.velocity().length() < 0.1).expect("it stands");
    stands + states[stands..].iter().position(|state| state.velocity().length() > 0.1).expect("it sets off")
}

#[test]
fn who_turns_when_the_other_has_stopped_sets_off_for_it_then() {
    let account = story(TURNED_LATER);
    assert_eq!(after(&account.sv, Act::Turn), Some(step(account.partner.as_ref().expect("told"), Act::Stop)));
    let made = made(&account);
    let other = &partner(&made).0;
    let stands = other.iter().position(|state| state.speed() < 0.1).expect("the van stands");
    let off = sets_off(&made.rollout.ego_track().states);
    assert!(off + 2 >= stands, "the AV sets off at {off}, the van stands from {stands}");
    let acts = result(&account, CheckKind::SvActs);
    assert_eq!(acts.0, CheckResult::Shown, "{acts:?}");
}

#[test]
fn an_ego_that_sets_off_behind_who_waited_behind_it_does_so_second() {
    let account = story(WENT_FIRST);
    let made = made(&account);
    let (ego, other) = (sets_off(&made.rollout.ego_track().states), sets_off(partner(&made).0));
    assert!(ego > other, "the AV sets off at {ego}, the sedan at {other}");
}

#[test]
fn who_had_pulled_over_stands_before_the_other_backs() {
    let account = story(PULLED_OVER);
    let partner_acts = account.partner.as_ref().expect("told");
    assert_eq!(after(partner_acts, Act::Reverse), Some(step(&account.sv, Act::PullOver)));
    let made = made(&account);
    let stands = speeds(&made).iter().position(|mps| *mps < 0.1).expect("it stands");
    let backs = partner(&made).0.iter().position(|state| state.speed() < -0.1).expect("it backs");
    assert!(backs + 5 >= stands, "it backs from {backs}, the AV stands from {stands}");
}

#[test]
fn an_ego_drives_as_slowly_as_is_told_of_it_or_of_who_runs_into_it() {
    let mps = |text: &str| {
        let made = made(&story(text));
        made.rollout.ego_track().states[before_contact(&made)].speed().abs()
    };
    let hit = "The AV was traveling north on Elm Street and slowing for traffic ahead when a van behind it made contact with the rear of the AV at \
               approximately 7 MPH.";
    assert!((0.3..2.0).contains(&mps(hit)), "{}", mps(hit));
    let then = format!("{hit} The AV was traveling at approximately 2 MPH.");
    assert!((0.5..1.4).contains(&mps(&then)), "{}", mps(&then));
    let came = "The AV was traveling north on Elm Street at less than 4 MPH. A van approached the AV from behind, and the front of the van made \
                contact with the rear of the AV.";
    assert!((1.3..2.3).contains(&mps(came)), "{}", mps(came));
    let stopping =
        "The AV was coming to a stop for traffic ahead when a van behind it made contact with the rear of the AV.";
    assert!((0.3..3.0).contains(&mps(stopping)), "{}", mps(stopping));
}
