//! What somebody is told to have done before the last thing that it does.

use crate::told::phase::Phase;
use recrash_model::account::{Act, ActFact, ContactState, Party, Standing};

impl Phase {
    /// What somebody does in this state at the contact.
    const fn of(state: ContactState) -> Self {
        match state {
            ContactState::Stopped | ContactState::Parked => Self::Stands,
            ContactState::Moving | ContactState::SettingOff => Self::Drives,
            ContactState::Reversing => Self::Reverses,
        }
    }
}

/// So many phases are drawn, the last one counted.
const MOST_PHASES: usize = 8;

/// What is told of them: the last things that somebody did before the contact, ended by what it does there. Empty where they say no
/// more than the state there, and that it came there or stood before.
pub(super) fn told(party: &Party, state: ContactState) -> Vec<Phase> {
    let mut acts: Vec<&ActFact> = party.acts.iter().filter(|fact| !fact.after_contact).collect();
    acts.sort_by_key(|fact| fact.step);
    let stands = |fact: &&ActFact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.begun;
    let last_stand = acts.iter().rposition(stands);
    let (mut list, mut went_on, mut slowed): (Vec<Phase>, bool, bool) = (Vec::new(), false, false);
    for (number, fact) in acts.iter().enumerate() {
        // Of what was begun, a way from one stop to the next was driven.
        let stops_next = acts[number..].iter().find(|fact| stands(fact)).is_some_and(|fact| fact.act == Act::Stop);
        if fact.begun && !(drives_aside(fact.act) && list.last() == Some(&Phase::Stands) && stops_next) {
            continue;
        }
        went_on |= fact.act == Act::Slow && !list.is_empty();
        slowed = fact.act == Act::Slow || slowed && fact.act != Act::Stop;
        let Some(phase) = phase(fact.act, list.last().copied(), stops_next) else { continue };
        // Who sets off as they touch stood before that, also where it is only told to have slowed.
        if fact.act == Act::SetOff && slowed && state == ContactState::SettingOff && list.last() == Some(&phase) {
            list.push(Phase::Stands);
        }
        // Who came to a stop came along before; so did who stood, went on and slowed for it.
        let goes_on = list.last() == Some(&Phase::Stands) && went_on && fact.act == Act::Stop;
        if list.is_empty() && fact.act == Act::Stop || goes_on {
            list.push(Phase::Drives);
        }
        went_on = false;
        if list.last() != Some(&phase) {
            list.push(phase);
        }
    }
    end(&mut list, &acts, last_stand, (party, Phase::of(state)));
    let last = list.split_off(list.len().saturating_sub(MOST_PHASES));
    let before = &last[..last.len() - 1];
    if last.len() > 2 || before.contains(&Phase::Reverses) { last } else { Vec::new() }
}

/// What somebody does by an act, behind what it did last; and whether the next stop that is told is one to which it came.
fn phase(act: Act, last: Option<Phase>, stops_next: bool) -> Option<Phase> {
    match act {
        Act::Stop | Act::Hold => Some(Phase::Stands),
        Act::SetOff
        | Act::Accelerate
        | Act::Enter
        | Act::Cross
        | Act::LaneChange
        | Act::Swerve
        | Act::Pass
        | Act::Turn
        | Act::UTurn
        | Act::PullOut
        | Act::PullOver => Some(Phase::Drives),
        // Of who stood, these tell how it came there.
        Act::Follow | Act::Slow if last.is_none() => Some(Phase::Drives),
        // Between two stands it drove aside.
        Act::Drift if last == Some(Phase::Stands) && stops_next => Some(Phase::Drives),
        Act::Reverse => Some(Phase::Reverses),
        _ => None,
    }
}

/// Ends the phases with what somebody does at the contact: what is told of who stands behind its last stop was a plan, and a stop that is told last
/// of who moves was not reached.
fn end(list: &mut Vec<Phase>, acts: &[&ActFact], last_stand: Option<usize>, (party, last): (&Party, Phase)) {
    let stopping = party.standing.as_ref().is_some_and(|fact| fact.value == Standing::Stopping);
    let behind = last_stand.map_or(&[][..], |at| &acts[at + 1..]);
    let reached = last_stand.is_some_and(|at| acts[at].act == Act::Hold) || behind.iter().any(|fact| goes_on(fact));
    if last == Phase::Stands && !stopping {
        // Who is told to have set off from there stands again.
        if !behind.iter().any(|fact| fact.act == Act::SetOff && !fact.begun) {
            let stands = list.iter().rposition(|phase| *phase == last).map_or(list.len(), |at| at + 1);
            list.truncate(stands);
        }
    } else if list.ends_with(&[last, Phase::Stands]) && !reached {
        list.pop();
    }
    if list.last() != Some(&last) {
        list.push(last);
    }
}

/// Whether somebody who does this drives, out of its line.
const fn drives_aside(act: Act) -> bool {
    matches!(act, Act::LaneChange | Act::Drift | Act::Swerve | Act::Turn | Act::UTurn | Act::PullOut)
}

/// Whether somebody who does this behind a stop has come to that: it went on from there, or was about to.
fn goes_on(fact: &ActFact) -> bool {
    drives_aside(fact.act) || matches!(fact.act, Act::SetOff | Act::Accelerate | Act::Pass | Act::Enter | Act::Cross)
}
