//! When somebody stood.

use crate::told::others::Extra;
use recrash_model::rollout::ActorTrack;

/// When somebody stood until a step: first and last steps.
pub(crate) fn stands(track: &ActorTrack, until: usize) -> Vec<(usize, usize)> {
    let mut list: Vec<(usize, usize)> = Vec::new();
    for step in (0..=track.within(until)).filter(|step| track.states[*step].stands()) {
        match list.last_mut().filter(|(_, last)| last + 1 == step) {
            Some((_, last)) => *last = step,
            None => list.push((step, step)),
        }
    }
    list
}

/// When the ego stood behind somebody who stood ahead: last, or the time before that where this one drives on before it moves.
pub(crate) fn stood_behind(extra: &Extra, ego: &ActorTrack, until: usize) -> Option<(usize, usize)> {
    let list = stands(ego, until);
    let back = if extra.first && list.last().is_some_and(|(_, to)| to + 1 >= until) { 2 } else { 1 };
    list.len().checked_sub(back).or(list.len().checked_sub(1)).map(|at| list[at])
}
