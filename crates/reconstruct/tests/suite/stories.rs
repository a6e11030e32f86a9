//! Mini narratives of our own are shown as they are told.

use crate::common::account_of;
use recrash_model::account::{Account, Control, ControlDevice, Fact};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_reconstruct::{Reconstruction, reconstruct, told_kinds};

const STORIES: &str = include_str!("../../../reader/tests/suite/stories.toml");

/// Name and account of every mini narrative that is one.
pub fn accounts() -> Vec<(String, Account)> {
    let table: toml::Table = toml::from_str(STORIES).expect("stories");
    let stories = table["story"].as_array().expect("stories").iter();
    stories
        .filter_map(|story| {
            let text = |field: &str| story[field].as_str().expect("text").to_owned();
            Some((text("name"), account_of(&text("text"))?))
        })
        .collect()
}

/// Those whose every checked fact is shown.
pub fn shown() -> Vec<(String, Account, Reconstruction)> {
    let made = accounts().into_iter().filter_map(|(name, account)| {
        let made = reconstruct(&account).ok().filter(Reconstruction::is_true)?;
        Some((name, account, made))
    });
    made.collect()
}

#[test]
fn most_mini_narratives_are_shown_as_told() {
    let all = accounts();
    let shown = shown();
    assert!(all.len() >= 242, "{}", all.len());
    let share = shown.len() as f64 / all.len() as f64;
    assert!(share >= 0.95, "{} of {}", shown.len(), all.len());
    for (name, _, made) in &shown {
        assert!(made.verdict.checks.len() >= 3, "{name}: {:?}", made.verdict);
        assert!(made.rollout.ego == "recorded");
    }
}

#[test]
fn every_stated_fact_has_a_verdict_and_nothing_else_has_one() {
    let more = [
        (
            "a chain across",
            "The AV was traveling north into a parking lot when the front of the AV made contact with a chain hung across the entrance.",
        ),
        (
            "a branch",
            "The AV was traveling north on Elm Street when a tree branch hanging into the lane from the right made contact with the right side of the AV.",
        ),
        (
            "about to turn",
            "The AV was stopped at a red light on Elm Street, waiting to turn left onto Oak Street. A van approached from behind and the front of the van \
                           made contact with the rear of the AV.",
        ),
    ];
    let more = more.into_iter().map(|(name, text)| (name.to_owned(), account_of(text).expect("a story")));
    for (name, account) in accounts().into_iter().chain(more) {
        let Ok(made) = reconstruct(&account) else { continue };
        let held: Vec<CheckKind> = made.verdict.checks.iter().map(|check| check.kind).collect();
        assert_eq!(held, told_kinds(&account), "{name}");
    }
}

#[test]
fn the_same_account_gives_the_same_bytes() {
    for (_, account, made) in shown().into_iter().step_by(9) {
        let again = reconstruct(&account).expect("as before");
        assert_eq!(again, made);
    }
}

#[test]
fn another_driver_takes_over_in_every_one() {
    for (name, _, made) in shown() {
        let scenario = recrash_roads::check(made.draft).expect("it ran").value;
        let tested = recrash_sim::simulate(&scenario, recrash_sim::Ego::Idm);
        let handover_s = scenario.draft().ego.handover_s.unwrap_or(0.0);
        for step in 0..=((handover_s * 10.0) as usize).min(made.rollout.steps() - 1) {
            let (told, other) = (&made.rollout.actors[0].states[step], &tested.actors[0].states[step]);
            assert_eq!(told.pose(), other.pose(), "{name} at step {step}");
        }
    }
}

#[test]
fn a_crash_with_a_door_is_shown_with_the_door() {
    let mut tried = 0;
    for (name, account) in accounts().into_iter().filter(|(_, account)| account.door.is_some()) {
        tried += 1;
        let made = reconstruct(&account).unwrap_or_else(|reason| panic!("{name}: {reason}"));
        assert!(made.is_true(), "{name}: {:?}", made.verdict);
        let by_door =
            made.verdict.checks.iter().any(|check| check.kind == CheckKind::Door && check.result == CheckResult::Shown);
        assert!(by_door, "{name}");
    }
    assert!(tried >= 2, "{tried}");
}

#[test]
fn a_sign_at_a_driveway_does_not_stand_before_the_ego() {
    let text = "The AV was traveling straight when a car pulled out of a driveway on its right, and the front of the AV made \
                contact with the left side of the car.";
    let mut account = account_of(text).expect("a story");
    let sign = Control { device: ControlDevice::StopSign, state: None, obeyed: None };
    account.partner.as_mut().expect("a partner").controls.push(Fact::by_rule(sign, "made for this test"));
    let made = reconstruct(&account).expect("it can be staged");
    assert!(made.draft.control.iter().all(|control| control.at != "own-"), "{:?}", made.draft.control);
}
