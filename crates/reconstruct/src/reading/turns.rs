//! How somebody is told to have turned, and by which way it came to its stop.

use crate::told::side::Turning;
use recrash_model::account::{Act, ActFact, Fact, LeftRight, Party, Source, StandReason, Standing, told};

/// Whether somebody who does this leaves the line that it drives on, without a turn.
pub(super) fn leaves_line(act: Act) -> bool {
    matches!(act, Act::LaneChange | Act::Drift | Act::Swerve | Act::PullOut | Act::PullOver | Act::Park)
}

/// What somebody who came to a stop did last before it, of what tells its way.
pub(super) fn last_way(party: &Party) -> Option<&ActFact> {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let last_stop = before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold)).map(|fact| fact.step).max();
    let stopping = told(&party.standing) == Some(Standing::Stopping);
    let came = stopping || told(&party.standing) == Some(Standing::CameToStop);
    // That it stood a column may tell alone.
    let stood = if stopping { u32::MAX } else { last_stop.or(came.then_some(u32::MAX))? };
    let goes_on = |fact: &ActFact| match (&fact.source, fact.act) {
        // "advanced", in its turn.
        (Source::Words { text, .. }, Act::Follow) => text.to_lowercase().starts_with("travel"),
        (_, act) => {
            leaves_line(act)
                || matches!(act, Act::Pass | Act::Turn | Act::UTurn | Act::Enter | Act::Reverse | Act::Follow)
        }
    };
    let goes_on = |fact: &ActFact| goes_on(fact) && !(stopping && fact.act == Act::Park);
    // A way from a stop that it had made to the next was driven, also where it was only begun.
    let first_stop = before().filter(|fact| matches!(fact.act, Act::Stop | Act::Hold)).map(|fact| fact.step).min();
    let begun = |fact: &&ActFact| {
        let between = first_stop.is_some_and(|first| first < fact.step) && leaves_line(fact.act);
        // So is a turn that it left off to stop.
        let left_off = fact.act == Act::Turn && came;
        let way = (between || left_off) && fact.step < stood;
        fact.begun && !fact.after_contact && way && stops_after(party, fact.step)
    };
    // Whom it had passed when it came back it passed before that.
    let earlier = |fact: &ActFact| fact.act == Act::Pass && fact.done && fact.side.is_none();
    let way = |fact: &&ActFact| came && fact.step < stood && goes_on(fact) && !earlier(fact);
    before().filter(way).chain(party.acts.iter().filter(begun)).max_by_key(|fact| fact.step)
}

/// Whether the next that is told of somebody's stands behind a step is that it came to a stop.
fn stops_after(party: &Party, step: u32) -> bool {
    let stands = |fact: &&ActFact| {
        matches!(fact.act, Act::Stop | Act::Hold) && !fact.after_contact && !fact.begun && fact.step > step
    };
    party.acts.iter().filter(stands).min_by_key(|fact| fact.step).is_some_and(|fact| fact.act == Act::Stop)
}

/// The turn that somebody had begun or done before it came to a stop. Who stops at a light or a sign has yet to turn.
pub(super) fn turned_before_its_stop(party: &Party) -> Turning {
    let entered = party.acts.iter().any(|fact| fact.act == Act::Enter && !fact.after_contact && !fact.begun);
    let at_line = |fact: &Fact<StandReason>| matches!(fact.value, StandReason::RedLight | StandReason::StopSign);
    let waits = party.reasons.iter().any(at_line) && !entered;
    let last = last_way(party).filter(|_| !waits);
    match last.filter(|fact| fact.act == Act::Turn).and_then(|fact| fact.side) {
        Some(LeftRight::Left) => Turning::Left,
        Some(LeftRight::Right) => Turning::Right,
        // It went straight on since.
        None if last.is_some_and(|fact| matches!(fact.act, Act::Follow | Act::Enter)) => turned_before(party),
        None => Turning::No,
    }
}

/// Whether somebody who came to a stop had turned, and gone straight on since.
pub(super) fn went_on_straight(party: &Party) -> bool {
    last_way(party).is_some_and(|fact| matches!(fact.act, Act::Follow | Act::Enter))
}

/// The turn that somebody who goes straight on since had done before.
pub(super) fn turned_before(party: &Party) -> Turning {
    let turn = |fact: &&ActFact| fact.act == Act::Turn && !fact.after_contact && !fact.begun;
    let stands = |fact: &ActFact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.after_contact;
    let turn = party.acts.iter().find(turn).filter(|turn| {
        party.controls.is_empty() && !party.acts.iter().any(|fact| stands(fact) && fact.step <= turn.step)
    });
    match turn.and_then(|fact| fact.side) {
        Some(LeftRight::Left) => Turning::Left,
        Some(LeftRight::Right) => Turning::Right,
        None => Turning::No,
    }
}
