//! What each of the two is told to have done before the contact, one act after the other.

use crate::reading::words::text;
use crate::told::doing::{Doing, least};
use crate::told::zones::side_of;
use recrash_model::account::{
    Act, ActFact, ContactState, Fact, Kind, LeftRight, Manner, Other as OtherParty, Party, Source, StandReason,
    told as told_of,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// What is told of somebody until the contact that can be seen, in order.
pub(super) fn told(party: &Party, state: ContactState) -> Vec<Doing> {
    let row = Row::of(party, state);
    let mut list: Vec<Doing> = Vec::new();
    let mut standing = false;
    for (number, fact) in row.acts.iter().enumerate() {
        let skipped = row.skips(number, &list, standing);
        let over = row.acts[number + 1..].iter().any(|later| later.act == Act::Turn);
        let (step, after_other) = (fact.step, fact.after_other);
        // "It then began to turn": it had set off for that, behind what the other did.
        let set_off = |implied| Doing { implied, ..Doing::plain(Act::SetOff, step, after_other) };
        if standing && !state.stands() && after_other.is_some() && sets_off_for(fact.act) {
            list.push(set_off(true));
        }
        // Who is told to have set off from there went on so.
        let goes = standing && fact.act == Act::Follow && state == ContactState::SettingOff;
        list.extend(goes.then(|| set_off(false)));
        standing = stands(fact.act) || standing && waits(fact) && !goes;
        if !skipped {
            let (side, begun, within_lane) = (fact.side, fact.begun, stays_in_lane(fact));
            let hard = is_hard(fact);
            list.push(Doing { side, begun, over, within_lane, hard, ..Doing::plain(fact.act, step, after_other) });
        }
    }
    // "Stopped at the kerb" of who pulls out: it stood there.
    if let [first, next, ..] = list.as_mut_slice()
        && (first.act, next.act) == (Act::Stop, Act::PullOut)
    {
        first.act = Act::Hold;
    }
    // Who moves at the contact was slowing to its last stop.
    if let Some(last) = list.last_mut().filter(|last| last.act == Act::Stop && !state.stands()) {
        last.begun = true;
    }
    list.dedup_by_key(|doing| (doing.act, doing.side, doing.begun));
    list
}

/// Whether somebody who does this stands then.
const fn stands(act: Act) -> bool {
    matches!(act, Act::Stop | Act::Hold | Act::PullOver | Act::Park)
}

/// Whether somebody who stands, and is told to do this, may stand yet.
const fn waits(fact: &ActFact) -> bool {
    match fact.act {
        Act::OpenDoor | Act::Slow | Act::Follow | Act::FailToYield => true,
        Act::SetOff | Act::Reverse => fact.begun,
        _ => false,
    }
}

/// Everything that is told of somebody until the contact, in order, and how it is there.
struct Row<'a> {
    party: &'a Party,
    state: ContactState,
    acts: Vec<&'a ActFact>,
    /// It came to a light or a sign.
    at_line: bool,
    /// It is touched, and not at its front: who touches with that was only about to pass.
    touches_beside: bool,
}

impl<'a> Row<'a> {
    /// What is told of somebody who is in this state at the contact.
    fn of(party: &'a Party, state: ContactState) -> Self {
        let mut acts: Vec<&ActFact> = party.acts.iter().filter(|fact| !fact.after_contact).collect();
        acts.sort_by_key(|fact| fact.step);
        let line = |fact: &Fact<StandReason>| matches!(fact.value, StandReason::RedLight | StandReason::StopSign);
        let at_line = party.reasons.iter().any(line) || !party.controls.is_empty();
        let touches_beside = !party.zones.is_empty() && party.zones.iter().all(|zone| !zone.value.is_front());
        Self { party, state, acts, at_line, touches_beside }
    }

    /// Whether an act shows nothing, behind what somebody is listed to have done, and who may be standing then.
    fn skips(&self, number: usize, list: &[Doing], standing: bool) -> bool {
        let (fact, state) = (self.acts[number], self.state);
        let stood = list.iter().any(|doing| stands(doing.act) || doing.act == Act::Reverse);
        let later = |of: fn(Act) -> bool| self.acts[number..].iter().any(|later| of(later.act));
        match fact.act {
            // Who was told to begin or go on while it drove drives already.
            Act::SetOff => !standing && (stood || state != ContactState::SettingOff) || fact.begun && state.stands(),
            // It stands there.
            Act::Stop if standing => true,
            // Who turned on its way to a light or a sign did so on another road, or has yet to.
            Act::Turn => {
                self.at_line && !stood && later(stands)
                    || turns_again(fact, &self.acts)
                    || leaves_before(fact, self.party)
            }
            Act::Park => list.last().is_some_and(|last| stands(last.act)),
            // So did who came out of a lot and drove along since; and who runs a red light came out of a street.
            Act::PullOut => {
                let straight = told_of(&self.party.movement) == Some(Movement::Straight);
                list.is_empty() && (straight || later(|act| act == Act::RunRed))
            }
            // What somebody who stands, or had yet to, tried to.
            Act::Reverse => fact.begun && state.stands(),
            // Who had only begun to pass on a side has gone out to it.
            Act::Pass if fact.begun => fact.side.is_none() || state.stands(),
            Act::Pass => !self.touches_beside,
            Act::Enter => fact.begun || !is_of_junction(fact),
            act => least(act).is_none(),
        }
    }
}

/// Whether somebody is told to have braked hard.
pub(super) fn is_hard(fact: &ActFact) -> bool {
    matches!(fact.act, Act::Slow | Act::Stop) && fact.manner == Some(Manner::Fast)
}

/// Whether somebody is told to have gone aside and not to have left its lane: "moved to the right within its lane".
fn stays_in_lane(fact: &ActFact) -> bool {
    matches!(fact.act, Act::Drift | Act::Swerve) && text(&fact.source).contains("within")
}

/// Whether somebody is told to have turned to the other side after this turn: that was the road on which it came, and which it left.
fn turns_again(turn: &ActFact, acts: &[&ActFact]) -> bool {
    let later = acts.iter().filter(|fact| fact.act == Act::Turn && fact.step > turn.step);
    turn.side.is_some_and(|side| later.into_iter().any(|later| later.side == Some(side.other())))
}

/// Whether a turn was over before somebody parked, or pulled over: that was another road, or is not where it did that.
fn leaves_before(turn: &ActFact, party: &Party) -> bool {
    let parks = told_of(&party.movement) == Some(Movement::ParkingManeuver);
    let later = |fact: &ActFact| matches!(fact.act, Act::Park | Act::PullOver) && fact.step > turn.step;
    parks && turn.done && party.acts.iter().any(|fact| later(fact) && !fact.after_contact)
}

/// Whether somebody who stood has set off to do this.
const fn sets_off_for(act: Act) -> bool {
    matches!(act, Act::Turn | Act::UTurn | Act::Pass | Act::Enter | Act::Cross | Act::LaneChange | Act::Accelerate)
}

/// Whether the ego is told to have passed the partner: by its name, and nobody else has that.
pub(super) fn passes_partner(sv: &Party, partner: &Party, others: &[OtherParty]) -> bool {
    let last_word = |text: &str| text.to_lowercase().split_whitespace().next_back().map(str::to_owned);
    let name = |fact: &Fact<Kind>| match &fact.source {
        Source::Words { text, .. } => last_word(text),
        _ => None,
    };
    let Some(partner) = partner.kind.as_ref().and_then(name) else { return false };
    let named = |fact: &&ActFact| match &fact.source {
        Source::Words { text, .. } => text.to_lowercase().contains(&partner),
        _ => false,
    };
    let mut passed = sv.acts.iter().filter(|fact| fact.act == Act::Pass && !fact.after_contact);
    partner != "av"
        && passed.any(|fact| named(&fact))
        && !others.iter().any(|other| name(&other.kind).as_ref() == Some(&partner))
}

/// Whether somebody is told to have come through a junction, and not to have turned or entered another since.
pub(super) fn has_crossed(party: &Party) -> bool {
    let ways = |fact: &&ActFact| matches!(fact.act, Act::Enter | Act::Turn | Act::UTurn) && !fact.after_contact;
    party.acts.iter().rfind(ways).is_some_and(|fact| fact.act == Act::Enter && fact.done && is_of_junction(fact))
}

/// Whether somebody is told to have entered a junction, and not a road or a lane, nor to have begun to.
fn is_of_junction(fact: &ActFact) -> bool {
    let Source::Words { text, .. } = &fact.source else { return false };
    let text = text.to_lowercase();
    ["intersection", "junction"].iter().any(|word| text.contains(word)) && !text.starts_with("beginning")
}

/// Who passes last passes on the side on which the ego is touched: what is told of the other side was said of something else.
pub(super) fn passes_where_touched(acts: &mut [Doing], ego_zones: &[ContactZone]) {
    let touched = side_of(ego_zones);
    if let Some(last) = acts.last_mut().filter(|doing| doing.is_pass() && touched == doing.side.map(LeftRight::other)) {
        last.side = None;
    }
}
