//! What one of the two is told to have done before the other, or before its own last act.

use recrash_model::account::{Act, ActFact, Origin, Party, SignalState, Source, StandReason, Standing, Striker, told};

/// Steps of the story in which somebody did such things before the contact.
pub(super) fn steps(party: &Party, of: fn(Act) -> bool) -> Vec<u32> {
    let before = party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun && of(fact.act));
    before.map(|fact| fact.step).collect()
}

/// Whether the partner that backs began to after the ego had set off; and whether before the ego stopped for it, or moved up.
pub(super) fn backs_behind(sv: &Party, partner: &Party, origin: Origin) -> (bool, bool) {
    let first = |party: &Party, of: fn(Act) -> bool| steps(party, of).into_iter().min();
    let Some(backs) = first(partner, |act| act == Act::Reverse) else { return (false, false) };
    let sets_off = steps(sv, |act| act == Act::SetOff).into_iter().max();
    let stops = first(sv, |act| matches!(act, Act::Stop | Act::Hold | Act::PullOver | Act::Park));
    let in_lane = matches!(origin, Origin::Ahead | Origin::Behind);
    let own = steps(sv, |act| act == Act::Reverse);
    let early = in_lane && own.is_empty() && stops_for_who_backs(sv, partner)
        || sets_off.is_some_and(|at| at > backs)
        || stops.is_some_and(|at| at > backs);
    // Who backs behind what the ego did did so when that stood.
    let last = partner.acts.iter().rfind(|fact| fact.act == Act::Reverse && !fact.after_contact);
    let answers = last.is_some_and(|fact| fact.after_other >= stops && fact.after_other.is_some());
    (sets_off.is_some_and(|at| at < backs), early && !answers)
}

/// Whether the ego is told to have slowed behind that one ahead of it backed: it saw it back.
pub(super) fn slows_behind(sv: &Party, partner: &Party, origin: Origin) -> bool {
    let backs = steps(partner, |act| act == Act::Reverse).into_iter().min();
    let slows = steps(sv, |act| matches!(act, Act::Slow | Act::Stop)).into_iter().min();
    origin == Origin::Ahead && backs.is_some() && backs < slows
}

/// Whether the ego stopped, or stood, for one that was reversing then: "came to a stop for a van that was backing up".
pub(super) fn stops_for_who_backs(sv: &Party, partner: &Party) -> bool {
    let before = |fact: &&ActFact| !fact.after_contact && !fact.begun;
    let words = |fact: &ActFact| match &fact.source {
        Source::Words { start, end, text } => Some((*start, *end, text.to_lowercase())),
        _ => None,
    };
    let backs = partner.acts.iter().filter(before).find(|fact| fact.act == Act::Reverse);
    // "Was stopped, yielding to a truck that was reversing".
    let yields = sv.reasons.iter().any(|fact| fact.value == StandReason::Yield);
    let stops = |fact: &&ActFact| matches!(fact.act, Act::Stop | Act::Slow) || yields && fact.act == Act::Hold;
    let stops = sv.acts.iter().filter(before).find(stops);
    // "Came to a stop behind a van. The van then began reversing."
    let then = backs.zip(stops).is_some_and(|(backs, stops)| backs.after_other >= Some(stops.step));
    let (backs, stops) = (backs.and_then(words), stops.and_then(words));
    let (Some((backs, _, text)), Some((_, stops, _))) = (backs.filter(|_| !then), stops) else { return false };
    let goes_on = ["reversing", "backing", "rolling", "drifting"].iter().any(|verb| text.starts_with(verb));
    goes_on && (0..SAME_BREATH).contains(&(backs as i64 - stops as i64))
}

/// The same of one in the ego's lane or coming along it, where the ego backed then too.
pub(super) fn backs_on_arrival(sv: &Party, partner: &Party, origin: Origin) -> bool {
    let first = |party: &Party, of: fn(Act) -> bool| steps(party, of).into_iter().min();
    let own = first(sv, |act| act == Act::Reverse);
    let came = first(sv, |act| matches!(act, Act::Follow | Act::Slow | Act::Stop));
    matches!(origin, Origin::Ahead | Origin::Behind) && own.is_some() && came < own && stops_for_who_backs(sv, partner)
}

/// What is told within so many bytes is told in one breath.
const SAME_BREATH: i64 = 130;

/// Whether one that stood at the contact did so before the partner began to do something: nothing is told of it behind that.
pub(super) fn stood_before(sv: &Party, partner: &Party) -> bool {
    let begins = |act: Act| {
        matches!(act, Act::Reverse | Act::SetOff | Act::PullOut | Act::Enter | Act::Turn | Act::Pass | Act::LaneChange)
    };
    let begun = steps(partner, begins).into_iter().min();
    // That it stood yet is told when it is struck.
    let last = steps(sv, |act| act != Act::Hold).into_iter().max();
    told(&sv.standing) == Some(Standing::FromTheStart) || last.is_some() && begun.is_some() && last < begun
}

/// Who of the two is told to have backed first.
pub(super) fn backs_first(sv: &Party, partner: &Party) -> Option<Striker> {
    let first = |party: &Party| {
        let backs = |fact: &&ActFact| fact.act == Act::Reverse && !fact.after_contact && !fact.begun;
        party.acts.iter().filter(backs).map(|fact| fact.step).min()
    };
    Some(if first(partner)? < first(sv)? { Striker::Cp } else { Striker::Sv })
}

/// Whether the ego's light is told to have turned green behind a stop to which it came after it had set off.
pub(super) fn turns_green_late(sv: &Party) -> bool {
    let begins = |source: &Source| match source {
        Source::Words { start, .. } => Some(*start),
        _ => None,
    };
    let stop = sv.acts.iter().rfind(|fact| fact.act == Act::Stop && !fact.after_contact);
    let moved_up = |stop: &&ActFact| sv.acts.iter().any(|fact| fact.act == Act::SetOff && fact.step < stop.step);
    let green = sv.controls.iter().find(|fact| fact.value.state == Some(SignalState::TurnedGreen));
    let at =
        green.and_then(|fact| begins(&fact.source)).zip(stop.filter(moved_up).and_then(|fact| begins(&fact.source)));
    at.is_some_and(|(green, stop)| stop < green)
}
