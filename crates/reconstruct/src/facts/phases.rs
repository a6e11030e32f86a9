//! What somebody did until the contact, in steps, as it was driven.

use crate::told::phase::{Phase, words};
use crate::usual::STANDS_MPS;
use recrash_model::account::Striker;
use recrash_model::rollout::{ActorState, ActorTrack, step_of};

/// A phase that is shorter than this on the way from one gear to the other is none. [steps]
const LEAST_STEPS: usize = 4;

/// The phases that somebody shows until a step.
fn shown(track: &ActorTrack, until: usize) -> Vec<Phase> {
    let phase = |state: &ActorState| match state.speed() {
        speed if speed > STANDS_MPS => Phase::Drives,
        speed if speed < -STANDS_MPS => Phase::Reverses,
        _ => Phase::Stands,
    };
    let mut runs: Vec<(Phase, usize)> = Vec::new();
    for state in &track.states[..=track.within(until)] {
        match runs.last_mut().filter(|(last, _)| *last == phase(state)) {
            Some((_, steps)) => *steps += 1,
            None => runs.push((phase(state), 1)),
        }
    }
    let last = runs.len() - 1;
    let mut list: Vec<Phase> = Vec::new();
    for (number, (phase, steps)) in runs.into_iter().enumerate() {
        if (steps >= LEAST_STEPS || number == last) && list.last() != Some(&phase) {
            list.push(phase);
        }
    }
    list
}

/// Who changes gear stands between, told or not.
fn without_turnarounds(phases: &[Phase]) -> Vec<Phase> {
    let between = |at: usize| {
        let sides = (at.checked_sub(1).and_then(|before| phases.get(before)), phases.get(at + 1));
        matches!(sides, (Some(Phase::Drives), Some(Phase::Reverses)) | (Some(Phase::Reverses), Some(Phase::Drives)))
    };
    phases
        .iter()
        .enumerate()
        .filter(|(at, phase)| **phase != Phase::Stands || !between(*at))
        .map(|(_, phase)| *phase)
        .collect()
}

/// Whether somebody shows these phases last, and which it shows.
pub(super) fn check(told: &[Phase], track: &ActorTrack, time_s: f64) -> (bool, String) {
    let shown = shown(track, step_of(time_s));
    let seen = shown.split_at(shown.len().saturating_sub(told.len().max(1))).1;
    // Where nobody says that it stood between.
    let turns = told.windows(2).any(|pair| !pair.contains(&Phase::Stands));
    (shown.ends_with(told) || turns && without_turnarounds(&shown).ends_with(&without_turnarounds(told)), words(seen))
}

/// Whether the one who is told to have backed first did.
pub(super) fn back_in_order(first: Striker, ego: &ActorTrack, partner: &ActorTrack, time_s: f64) -> bool {
    let until = step_of(time_s);
    let backs = |track: &ActorTrack| track.states.iter().take(until + 1).position(|state| state.speed() < -STANDS_MPS);
    match (backs(ego), backs(partner)) {
        (Some(ego), Some(partner)) if first == Striker::Cp => partner < ego,
        (Some(ego), Some(partner)) => ego < partner,
        _ => false,
    }
}
