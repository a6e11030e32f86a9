//! What is told of the way to the contact is drawn; and a rollout without it does not pass for it.

use crate::common::account_of;
use recrash_model::account::{Account, Act};
use recrash_model::metrics::{CheckKind, CheckResult};
use recrash_model::rollout::ActorTrack;
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};

const MOVED_UP: &str = "The AV was stopped in a queue of traffic for a red light. The AV proceeded forward a short distance and came to \
                        a stop. A car approached from behind and the front of the car made contact with the rear of the \
                        stationary AV.";

const REVERSED_FIRST: &str = "The AV was traveling north behind a truck when the truck came to a stop and the AV stopped behind it. The \
                              AV reversed and came to a stop. The truck reversed and the rear of the truck made contact with \
                              the front of the stationary AV.";

/// The stories of this file, as they are shown.
pub fn shown() -> Vec<(String, Account, Reconstruction)> {
    let texts = [("moved up", MOVED_UP), ("reversed first", REVERSED_FIRST)];
    let told = texts.map(|(name, text)| (name.to_owned(), story(text)));
    told.into_iter().map(|(name, account)| (name, account.clone(), made(&account))).collect()
}

fn story(text: &str) -> Account {
    account_of(text).expect("a story")
}

/// A staging that shows all that is told.
fn made(account: &Account) -> Reconstruction {
    let made = reconstruct(account).expect("it can be staged");
    assert!(made.is_true(), "{:?}", made.verdict);
    made
}

/// What of an account is not shown by the staging of the same account without some of its facts.
fn missed(account: &Account, without: impl Fn(&mut Account)) -> Vec<CheckKind> {
    let mut less = account.clone();
    without(&mut less);
    assert!(less != *account, "nothing was taken away");
    let other = made(&less);
    let scenario = recrash_roads::check(other.draft).expect("it ran").value;
    let verdict = held_against(account, &scenario, &other.rollout).expect("it can be staged");
    verdict.checks.iter().filter(|check| check.result == CheckResult::NotShown).map(|check| check.kind).collect()
}

fn without_acts(account: &mut Account, acts: &[Act]) {
    account.sv.acts.retain(|fact| !acts.contains(&fact.act));
}

fn speeds(track: &ActorTrack) -> Vec<f64> {
    track.states.iter().take(90).map(|state| state.speed()).collect()
}

#[test]
fn an_ego_that_moved_up_stands_moves_and_stands_again() {
    let account = story(MOVED_UP);
    let shown = made(&account);
    let speeds = speeds(shown.rollout.ego_track());
    let stood = speeds.iter().position(|speed| *speed == 0.0).expect("it stands");
    let moved = stood + speeds[stood..].iter().position(|speed| *speed > 1.0).expect("it moves up");
    assert!(speeds[moved..].contains(&0.0), "{speeds:?}");
    // The system under test takes over where it stands before that.
    let handover_s = shown.draft.ego.handover_s.expect("a handover");
    assert_eq!(speeds[(handover_s * 10.0) as usize], 0.0, "{handover_s}: {speeds:?}");
    assert_eq!(missed(&account, |less| without_acts(less, &[Act::SetOff, Act::Stop])), [CheckKind::SvState]);
}

#[test]
fn an_ego_that_reversed_before_it_stood_reverses() {
    let account = story(REVERSED_FIRST);
    let shown = made(&account);
    assert!(speeds(shown.rollout.ego_track()).iter().any(|speed| *speed < -1.0));
    assert_eq!(missed(&account, |less| without_acts(less, &[Act::Reverse])), [CheckKind::SvState]);
}
