//! One side: kind, acts, state at the contact, reasons to stand, lane, direction, zones, speeds, signals.

use super::Reading;
use super::open::{doer, is_any_truck, turned_by_column};
use super::state::{partner_state, sv_speed, sv_state};
use crate::chunk::{Joint, Spot};
use crate::frame::{Frame, sided, zone_of};
use crate::lexicon::{Lexicon, Progress, Relation, Sense};
use crate::token::TokenKind;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{
    Account, Act, ActFact, ContactState, Control, ControlDevice, Fact, Kind, KindGroup, LaneWord, LeftRight, Obeyed,
    Party, SignalState, Source, Speed, SpeedMeaning, StandReason, Standing, told,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::record::{Coded, MPS_PER_MPH};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// What the words tell of one side.
pub(crate) fn party(reading: &Reading<'_>, actor: Actor) -> Party {
    let known = &reading.story.world.actors[actor];
    // Where it drove afterwards is no place of the crash.
    let end = reading
        .contacts
        .first
        .map_or(usize::MAX, |number| reading.story.sentences[reading.story.frames[number].sentence].end);
    let before = |first: usize| first < end;
    let (state, standing) = state(reading, actor);
    let kind = match (known.kind, known.kind_tokens) {
        (Some(kind), Some((first, end))) => Some(reading.told(kind, first, end)),
        (Some(kind), None) => Some(Fact::of_column(kind, "Make")),
        _ => None,
    };
    let mut party = Party {
        kind,
        movement: None,
        state,
        standing,
        reasons: Vec::new(),
        acts: acts(reading, actor),
        heading: known
            .heading
            .filter(|(_, first, _)| before(*first))
            .map(|(compass, first, end)| reading.told(compass, first, end)),
        heading_after: after(reading, actor),
        lane: known
            .lane
            .filter(|(_, first, _)| before(*first))
            .map(|(lane, first, end)| reading.told(lane, first, end)),
        speeds: speeds(reading, actor),
        zones: zones(reading, actor),
        controls: controls(reading, actor),
    };
    if told(&party.state).is_some_and(ContactState::stands) || (party.state.is_none() && actor == SUBJECT) {
        party.reasons = reasons(reading, actor);
    }
    party
}

fn after(reading: &Reading<'_>, actor: Actor) -> Option<Fact<recrash_model::account::Compass>> {
    let (_, frame) = reading
        .before(actor)
        .find(|(_, frame)| frame.onto && frame.heading.is_some() && frame.happened() && frame.act().is_some())?;
    frame.heading.map(|(compass, first, end)| reading.told(compass, first, end))
}

/// What somebody did, in order; the same act told twice in a row once.
pub(crate) fn acts(reading: &Reading<'_>, actor: Actor) -> Vec<ActFact> {
    let mut all: Vec<ActFact> = Vec::new();
    for (number, frame) in reading.story.frames.iter().enumerate() {
        let thrown = reading.contacts.earlier.contains(&number)
            && frame.object == Some(actor)
            && Some(actor) == reading.contacts.partner;
        let pushed = thrown || (frame.sense == Sense::Push && frame.object == Some(actor) && frame.happened());
        if doer(reading, frame) != Some(actor) && !pushed {
            continue;
        }
        let Some(act) = act_of(reading, number, frame, pushed) else { continue };
        let lane = reading.story.world.actors[actor].lane.and_then(|(lane, ..)| match lane {
            LaneWord::LeftTurn => Some(LeftRight::Left),
            LaneWord::RightTurn => Some(LeftRight::Right),
            _ => None,
        });
        let side = if sided(act) { frame.side.or_else(|| to_lane(reading, actor, frame, act)) } else { None };
        let side = side.or_else(|| into_turn_lane(reading, actor, frame, act));
        let side = side.or(lane.filter(|_| act == Act::Turn)).or_else(|| turned_by_column(reading, actor, act));
        let after_contact = reading.is_after(number);
        let fact = ActFact {
            act,
            side,
            step: number as u32,
            after_contact,
            begun: frame.progress == Progress::Tried,
            done: is_done(reading, frame),
            source: reading.of(frame),
        };
        let in_passing = frame.aside && all.iter().any(|known| known.act == act);
        match all.last_mut() {
            Some(last)
                if last.act == act
                    && last.after_contact == after_contact
                    && (last.side == side || side.is_none() || last.side.is_none()) =>
            {
                last.side = last.side.or(side);
                // The last word on it is that it was done.
                if fact.done {
                    (last.done, last.source) = (true, fact.source);
                }
            }
            _ if in_passing => {}
            _ => all.push(fact),
        }
    }
    all
}

/// "completed its left turn", "after it had turned".
fn is_done(reading: &Reading<'_>, frame: &Frame) -> bool {
    let first = reading.story.tokens.get(frame.first).map(|token| token.text.as_str()).unwrap_or_default();
    frame.joint == Some(Joint::After) || ["complet", "finish", "exit"].iter().any(|start| first.starts_with(start))
}

fn act_of(reading: &Reading<'_>, number: usize, frame: &Frame, pushed: bool) -> Option<Act> {
    if pushed {
        return Some(Act::Pushed);
    }
    if frame.negated {
        return not_done(reading, number, frame);
    }
    if frame.progress == Progress::Wished {
        return None;
    }
    // "When the light turned green, a car that was facing south proceeded": it stood.
    let moved = || {
        let before = frame.who.into_iter().flat_map(|who| reading.before(who)).take_while(|(other, _)| *other < number);
        before.filter(|(_, frame)| frame.happened()).filter_map(|(_, frame)| frame.act()).last()
    };
    if frame.sense == Sense::Face && turned_green(reading, frame) && moved().is_none() {
        return Some(Act::Hold);
    }
    let act = frame.act()?;
    let headline =
        reading.story.frames.iter().any(|other| other.sentence == frame.sentence && other.sense == Sense::Headline);
    if headline && act == Act::Follow {
        return None;
    }
    // Who goes on from a standstill sets off.
    let stood = || {
        let before = reading.before(frame.who?).take_while(|(other, _)| *other < number);
        let last =
            before.filter(|(_, frame)| frame.happened() && !frame.aside).filter_map(|(_, frame)| frame.act()).last()?;
        matches!(last, Act::Hold | Act::Stop).then_some(())
    };
    let keeps = reading.text[reading.story.tokens[frame.first].start..].to_lowercase();
    let goes_on = keeps.starts_with("continu") || keeps.starts_with("remain");
    // "Once the light turned green, it began to proceed, and a car behind it proceeded forward": so did that.
    let with_subject = || {
        let sets_off = |other: &Frame| {
            other.who == Some(SUBJECT) && other.sentence == frame.sentence && other.act() == Some(Act::SetOff)
        };
        let behind = |who: Actor| {
            let relations = &reading.story.world.actors[who].relations;
            relations.iter().any(|(relation, sentence)| *relation == Relation::Behind && *sentence == frame.sentence)
        };
        let goes = ["proceed", "start", "beg", "mov"].iter().any(|start| keeps.starts_with(start));
        let other = frame.who.filter(|who| *who != SUBJECT);
        let waits = goes && other.is_some_and(behind) && turned_green(reading, frame);
        waits && reading.story.frames.iter().any(sets_off)
    };
    // "proceeded forward out of a stall".
    let comes_out = matches!(frame.out_of, Some(Spot::Stall | Spot::Driveway | Spot::Curb));
    match act {
        Act::Follow | Act::SetOff | Act::Drift if comes_out => Some(Act::PullOut),
        Act::Follow if !goes_on && frame.sense != Sense::Approach && stood().is_some() => Some(Act::SetOff),
        Act::Follow if with_subject() => Some(Act::SetOff),
        // Who came along and was "beginning to enter" did not stand.
        Act::SetOff if keeps.chars().take(24).collect::<String>().contains("enter") && moved() == Some(Act::Follow) => {
            Some(Act::Enter)
        }
        // "passed through the junction" passes nobody.
        Act::Pass
            if frame.object.is_some_and(|object| {
                reading.story.world.actors[object].kind.is_some_and(|kind| kind.group() == KindGroup::Object)
            }) =>
        {
            Some(Act::Follow)
        }
        // So does "passed behind the van".
        Act::Pass
            if frame.who == Some(SUBJECT)
                && frame.object.is_none()
                && frame
                    .relations
                    .iter()
                    .all(|(relation, _)| matches!(relation, Relation::Ahead | Relation::Behind)) =>
        {
            Some(Act::Follow)
        }
        _ => Some(act),
    }
}

/// Whether the sentence tells that a light turned green.
fn turned_green(reading: &Reading<'_>, frame: &Frame) -> bool {
    let sentence = reading.story.sentences[frame.sentence];
    let words = &reading.story.tokens[sentence.first..sentence.end];
    let turns = |word: &str| ["turned", "turn", "turns", "changed", "became"].contains(&word);
    words.windows(4).any(|words| turns(&words[0].text) && words[1..].iter().any(|word| word.text == "green"))
}

/// What somebody did who did not stop or yield where it should.
fn not_done(reading: &Reading<'_>, number: usize, frame: &Frame) -> Option<Act> {
    let stops = matches!(frame.act(), Some(Act::Stop | Act::Slow)) || frame.sense == Sense::Yield;
    if !stops || frame.aside {
        return None;
    }
    let (first, end) = reading.window(number);
    let named = Lexicon::get().features(&reading.story.tokens[first..end]);
    use recrash_model::account::RoadFeature as F;
    if named.iter().any(|(feature, ..)| *feature == F::StopSign) {
        Some(Act::RunStop)
    } else if named.iter().any(|(feature, ..)| *feature == F::Signal) {
        Some(Act::RunRed)
    } else if frame.sense == Sense::Yield {
        Some(Act::FailToYield)
    } else {
        None
    }
}

/// The side to which the subject vehicle changed lanes, by the column, when it "proceeded into the right turn lane".
fn into_turn_lane(reading: &Reading<'_>, actor: Actor, frame: &Frame, act: Act) -> Option<LeftRight> {
    let column = reading.record.sv_movement.known() == Some(Movement::ChangingLanes);
    if act != Act::Enter || actor != SUBJECT || !column || !frame.happened() {
        return None;
    }
    let words: Vec<&str> =
        reading.story.tokens[frame.first..frame.end].iter().map(|token| token.text.as_str()).collect();
    let has = |word: &str| words.contains(&word);
    match (has("turn") && has("lane"), has("left"), has("right")) {
        (true, true, false) => Some(LeftRight::Left),
        (true, false, true) => Some(LeftRight::Right),
        _ => None,
    }
}

/// The side of a lane change that is told by lanes: from the left lane into the centre.
fn to_lane(reading: &Reading<'_>, actor: Actor, frame: &Frame, act: Act) -> Option<LeftRight> {
    if !matches!(act, Act::LaneChange | Act::Drift) {
        return None;
    }
    let own = reading.story.world.actors[actor].lane.map(|(lane, ..)| lane);
    let into = frame.lane.map(|(lane, ..)| lane);
    match (own, into) {
        (Some(LaneWord::Left), Some(LaneWord::Center)) => Some(LeftRight::Right),
        (Some(LaneWord::Right), Some(LaneWord::Center)) => Some(LeftRight::Left),
        (_, Some(LaneWord::Opposing)) => Some(LeftRight::Left),
        _ => None,
    }
}

/// State at the contact, and how long it had stood.
fn state(reading: &Reading<'_>, actor: Actor) -> (Option<Fact<ContactState>>, Option<Fact<Standing>>) {
    let mut state: Option<(ContactState, Source)> = None;
    let mut standing: Option<(Standing, Source)> = None;
    let contact = reading.contacts.first;
    let sentence = contact.map(|contact| reading.story.frames[contact].sentence);
    let mut moved = false;
    let mut since = (usize::MAX, 0);
    let mut spoken = 0;
    for (number, frame) in reading.story.frames.iter().enumerate() {
        if doer(reading, frame) != Some(actor) || !frame.happened() || reading.is_after(number) {
            continue;
        }
        let Some(act) = frame.act().filter(|act| *act != Act::OpenDoor && *act != Act::Leave) else { continue };
        if frame.aside && Some(frame.sentence) != sentence && state.is_some() {
            continue;
        }
        let headline =
            reading.story.frames.iter().any(|other| other.sentence == frame.sentence && other.sense == Sense::Headline);
        if headline && act == Act::Follow {
            continue;
        }
        let stands = state.as_ref().is_some_and(|(state, _)| state.stands());
        let parked = frame.sense == Sense::Parked
            || state.as_ref().is_some_and(|(state, _)| *state == ContactState::Parked && act == Act::Hold);
        let text = reading.text[reading.story.tokens[frame.first].start..].to_lowercase();
        let next = match act {
            Act::Hold | Act::Stop if parked => ContactState::Parked,
            Act::Hold | Act::Stop => ContactState::Stopped,
            Act::Park if text.starts_with("parked") => ContactState::Parked,
            Act::SetOff => ContactState::SettingOff,
            Act::Reverse => ContactState::Reversing,
            Act::Follow | Act::Enter if stands && text.starts_with("continu") => continue,
            // "was stopped at a light, heading west".
            Act::Follow | Act::Turn
                if stands && frame.form == crate::lexicon::Form::Ing && since == (frame.sentence, frame.clause) =>
            {
                continue;
            }
            Act::Follow if stands => ContactState::SettingOff,
            Act::Accelerate if state.as_ref().is_some_and(|(state, _)| *state == ContactState::SettingOff) => {
                ContactState::SettingOff
            }
            Act::Pushed | Act::Fall => continue,
            _ => ContactState::Moving,
        };
        // "was traveling at 1 mph, waiting for a gap".
        let words = &reading.story.tokens[spoken.min(frame.first)..frame.first];
        let rolls = act == Act::Hold
            && frame.form == crate::lexicon::Form::Ing
            && since.0 == frame.sentence
            && words.iter().any(|token| token.text == "mph");
        if rolls && state.as_ref().is_some_and(|(state, _)| !state.stands()) {
            continue;
        }
        since = (frame.sentence, frame.clause);
        spoken = frame.end;
        if next.stands() {
            let stopping = text.starts_with("slowing")
                || text.starts_with("stopping")
                || text.starts_with("coming to")
                || text.starts_with("braking");
            let how = if stopping {
                Standing::Stopping
            } else if moved || act == Act::Stop {
                Standing::CameToStop
            } else {
                Standing::FromTheStart
            };
            let was_stopping = standing.as_ref().is_some_and(|(how, _)| *how == Standing::Stopping);
            if how == Standing::Stopping || !stands || standing.is_none() {
                standing = Some((how, reading.of(frame)));
            } else if was_stopping {
                standing = Some((Standing::CameToStop, reading.of(frame)));
            }
        } else {
            moved = true;
            standing = None;
        }
        state = Some((next, reading.of(frame)));
    }
    // "had been waiting, jumped the light and hit it": who runs into another moves.
    let hits = contact.map(|number| &reading.story.frames[number]).filter(|frame| {
        let word = reading.story.tokens[frame.first].text.as_str();
        let runs = ["hit", "struck", "ran", "drove", "crash", "slam", "ram", "plow", "collid", "smash"];
        actor != SUBJECT
            && frame.who == Some(actor)
            && frame.object == Some(SUBJECT)
            && frame.sense == Sense::Contact
            && frame.with.is_none()
            && !frame.passive
            && runs.iter().any(|stem| word.starts_with(stem))
    });
    if let (Some(frame), Some((ContactState::Stopped, _))) = (hits, &state) {
        state = Some((ContactState::Moving, reading.of(frame)));
        standing = None;
    }
    let state = state.map(|(value, source)| Fact { value, source });
    (state, standing.map(|(value, source)| Fact { value, source }))
}

/// Why somebody stood: named with the last thing that made it stand.
pub(super) fn reasons(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<StandReason>> {
    let lexicon = Lexicon::get();
    let stands = |frame: &Frame| {
        matches!(frame.act(), Some(Act::Hold | Act::Stop | Act::Slow | Act::PullOver))
            || matches!(frame.sense, Sense::Yield | Sense::Parked)
    };
    let mut all: Vec<Fact<StandReason>> = Vec::new();
    let mut since = 0;
    for (number, frame) in reading.before(actor) {
        let moves = frame.happened()
            && matches!(
                frame.act(),
                Some(Act::SetOff | Act::Enter | Act::Turn | Act::Reverse | Act::LaneChange | Act::Follow | Act::Pass)
            );
        if moves && !frame.aside && number > since && !all.is_empty() {
            all.clear();
        }
        let waits = stands(frame) || (frame.progress == Progress::Wished && !all.is_empty());
        if !waits || frame.negated {
            continue;
        }
        since = number;
        let (first, end) = reading.window(number);
        let tokens = &reading.story.tokens;
        // A reason may stand before: "due to a queue, it stopped".
        let sentence = reading.story.sentences[frame.sentence];
        let begins = if all.is_empty() && !frame.aside { lead_in(reading, number).unwrap_or(first) } else { first };
        let end = end.min(sentence.end);
        for (reason, at, length) in lexicon.reasons(&tokens[begins..end]) {
            if !all.iter().any(|known| known.value == reason) {
                all.push(reading.told(reason, begins + at, begins + at + length));
            }
        }
        let behind = frame.relations.iter().find_map(|(relation, to)| {
            let to = (*to).filter(|to| *to != SUBJECT)?;
            (*relation == crate::lexicon::Relation::Behind).then_some(to)
        });
        let yields_to = match frame.sense {
            Sense::Yield => frame.object,
            Sense::Act(Act::Stop | Act::Slow | Act::Hold) => frame.object,
            _ => None,
        };
        if let Some(lead) = behind.or(yields_to)
            && reading.story.world.actors[lead].kind.is_some_and(Kind::is_vehicle)
        {
            let ahead = behind.is_some() || stands_still(reading, lead, number);
            let parked = reading.before(lead).any(|(_, frame)| frame.sense == Sense::Parked);
            let several = reading.story.world.actors[lead].several;
            let reason = if parked { StandReason::BlockedPath } else { StandReason::LeadVehicle };
            if ahead && !several && !all.iter().any(|known| known.value == reason) {
                all.push(Fact { value: reason, source: reading.of(frame) });
            }
        }
    }
    all.sort_by_key(|reason| rank(reason.value));
    all.truncate(2);
    all
}

fn stands_still(reading: &Reading<'_>, actor: Actor, number: usize) -> bool {
    reading
        .story
        .frames
        .iter()
        .skip(number)
        .take(3)
        .any(|frame| frame.who == Some(actor) && matches!(frame.act(), Some(Act::Hold | Act::Stop)))
}

/// Where the clause of a frame begins, where a reason leads it in.
fn lead_in(reading: &Reading<'_>, number: usize) -> Option<usize> {
    let frame = &reading.story.frames[number];
    let sentence = reading.story.sentences[frame.sentence];
    let before =
        reading.story.frames[..number].iter().rev().find(|other| other.sentence == frame.sentence && !other.aside);
    Some(before.map_or(sentence.first, |before| before.end)).filter(|first| *first < frame.first)
}

/// Which of several reasons says most.
fn rank(reason: StandReason) -> u8 {
    match reason {
        StandReason::PickupDropoff => 0,
        StandReason::BlockedJunction => 1,
        StandReason::Animal => 2,
        StandReason::EmergencyVehicle => 3,
        StandReason::Barrier => 4,
        StandReason::Queue => 5,
        StandReason::Pedestrian => 6,
        StandReason::RedLight => 7,
        StandReason::LeadVehicle => 8,
        StandReason::BlockedPath => 9,
        StandReason::Yield => 10,
        StandReason::StopSign => 11,
        StandReason::Parked => 12,
    }
}

/// Zones of the contact that is the crash.
fn zones(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<ContactZone>> {
    let Some(first) = reading.contacts.first else { return Vec::new() };
    let partner = reading.contacts.partner;
    let mut all: Vec<Fact<ContactZone>> = Vec::new();
    // What the crash told again leaves out stands where it was told first.
    let frames = || reading.story.frames.iter().enumerate();
    for (number, frame) in frames().skip(first).chain(frames().take(first)) {
        let pair = [frame.who, frame.object];
        let ours = frame.is_contact()
            && (pair.contains(&partner) && (pair.contains(&Some(SUBJECT)) || pair.contains(&None))
                // "causing a scrape on its door".
                || frame.sentence == reading.story.frames[first].sentence && pair == [None, Some(SUBJECT)]);
        let same = number == first || (all.is_empty() && ours);
        if !same {
            continue;
        }
        let piece = if frame.who == Some(actor) {
            frame.with.as_ref()
        } else if frame.object == Some(actor) || (frame.object.is_none() && actor == SUBJECT) {
            frame.on.as_ref()
        } else {
            None
        };
        let behind_run = frame.sense == crate::lexicon::Sense::RearEnd;
        let zone = piece.and_then(zone_of).or_else(|| {
            let struck = frame.object == Some(actor)
                || (frame.object.is_none() && frame.who.is_some() && frame.who != Some(actor));
            match (behind_run, struck) {
                (true, true) => Some(ContactZone::Rear),
                (true, false) => Some(ContactZone::Front),
                _ => None,
            }
        });
        let from_behind = frame.is_contact()
            && frame.relations.iter().any(|(relation, _)| *relation == crate::lexicon::Relation::Behind);
        let zone = zone.or_else(|| (from_behind && frame.object == Some(actor)).then_some(ContactZone::Rear));
        if let Some(zone) = zone {
            all.push(Fact { value: zone, source: reading.of(frame) });
        }
    }
    if all.is_empty() {
        let column = if actor == SUBJECT { &reading.record.sv_zones } else { &reading.record.cp_zones };
        all.extend(told_besides(reading, actor, first, column.is_empty()));
    }
    all
}

/// Where somebody was touched by what the sentence of the crash says of the damage, or the headline of a rear-end crash.
/// `alone`: no column tells more than the damage does.
fn told_besides(reading: &Reading<'_>, actor: Actor, first: usize, alone: bool) -> Option<Fact<ContactZone>> {
    let frames = &reading.story.frames;
    let crash = &frames[first];
    let damage = frames[first..].iter().find(|frame| {
        let whose = match frame.object.or(frame.who.filter(|who| *who == SUBJECT)) {
            // "collided with it, damaging its bumper": of the one that was struck.
            Some(owner) if frame.who == Some(owner) && owner != SUBJECT => SUBJECT,
            Some(owner) => owner,
            None => SUBJECT,
        };
        // "It made contact with a curb. This caused damage to its front right tire."
        let next = frame.sentence == crash.sentence + 1 && {
            let begins = &reading.story.tokens[reading.story.sentences[frame.sentence].first..];
            let word = |at: usize| begins.get(at).map_or("", |token| token.text.as_str());
            word(0) == "this" || word(0) == "the" && matches!(word(1), "contact" | "collision" | "impact")
        };
        let here = frame.sentence == crash.sentence || next;
        alone && frame.sense == Sense::Damage && here && whose == actor && !frame.negated
    });
    if let Some((frame, zone)) = damage.and_then(|frame| Some((frame, frame.on.as_ref().and_then(zone_of)?))) {
        return Some(Fact { value: zone, source: reading.of(frame) });
    }
    let headline = frames[..first].iter().rev().find(|frame| {
        frame.sense == Sense::RearEnd && frame.is_contact() && [frame.who, frame.object].contains(&Some(SUBJECT))
    })?;
    let zone = match (headline.object == Some(actor), headline.who == Some(actor)) {
        (true, false) => ContactZone::Rear,
        (false, true) => ContactZone::Front,
        _ => return None,
    };
    Some(Fact { value: zone, source: reading.of(headline) })
}

/// Signals and signs in front of somebody.
fn controls(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Control>> {
    let mut all: Vec<Fact<Control>> = Vec::new();
    let tokens = &reading.story.tokens;
    let mut turned_green = None;
    for (number, frame) in reading.story.frames.iter().enumerate() {
        let changes = match frame.sense {
            Sense::LightGreen if was_green(reading, frame, &all) => Some(SignalState::Green),
            Sense::LightGreen => Some(SignalState::TurnedGreen),
            Sense::LightRed => Some(SignalState::TurnedRed),
            Sense::LightYellow => Some(SignalState::Yellow),
            _ => None,
        };
        if let Some(state) = changes.filter(|_| !reading.is_after(number)) {
            turned_green = Some((state, frame.first, frame.end));
            if let Some(control) = all.iter_mut().find(|control| control.value.device == ControlDevice::Signal) {
                control.value.state = Some(state);
            }
        }
        if frame.who != Some(actor) || reading.is_after(number) || frame.aside {
            continue;
        }
        let (first, end) = reading.window(number);
        let ran = frame.act().filter(|_| frame.happened());
        let passed = not_done(reading, number, frame);
        let ran = if frame.negated { passed } else { ran };
        for at in first..end {
            let words: Vec<&str> = tokens[at..end.min(at + 4)].iter().map(|token| token.text.as_str()).collect();
            let found = match words.as_slice() {
                ["red", "light" | "signal" | "traffic", ..] | ["red", "left" | "right", "turn", ..] => {
                    Some((ControlDevice::Signal, Some(SignalState::Red), 2))
                }
                ["green", "light" | "signal" | "traffic" | "arrow", ..] => {
                    Some((ControlDevice::Signal, Some(SignalState::Green), 2))
                }
                ["yellow", "light" | "signal", ..] => Some((ControlDevice::Signal, Some(SignalState::Yellow), 2)),
                ["traffic", "light" | "signal", ..] => Some((ControlDevice::Signal, None, 2)),
                ["stop", "sign" | "signs", ..] => Some((ControlDevice::StopSign, None, 2)),
                ["four" | "4" | "three" | "3" | "all", "way", "stop", ..] => Some((ControlDevice::StopSign, None, 3)),
                ["yield", "sign", ..] => Some((ControlDevice::YieldSign, None, 2)),
                _ => None,
            };
            let Some((device, state, length)) = found else { continue };
            let broken = match device {
                ControlDevice::Signal => ran == Some(Act::RunRed),
                _ => ran == Some(Act::RunStop),
            };
            let obeyed = if broken {
                Some(Obeyed::No)
            } else if ran.is_some_and(|act| matches!(act, Act::Stop | Act::Hold)) && state != Some(SignalState::Green) {
                Some(Obeyed::Yes)
            } else {
                None
            };
            match all.iter_mut().find(|control| control.value.device == device) {
                Some(known) => {
                    known.value.state = known.value.state.or(state);
                    known.value.obeyed = if broken { Some(Obeyed::No) } else { known.value.obeyed.or(obeyed) };
                }
                None => all.push(reading.told(Control { device, state, obeyed }, at, at + length)),
            }
        }
    }
    if let (Some((state, first, end)), true) =
        (turned_green, actor == SUBJECT && all.iter().all(|control| control.value.device != ControlDevice::Signal))
    {
        all.push(reading.told(Control { device: ControlDevice::Signal, state: Some(state), obeyed: None }, first, end));
    }
    all
}

/// Whether a light "was green", and nobody tells that it had been red.
fn was_green(reading: &Reading<'_>, frame: &Frame, before: &[Fact<Control>]) -> bool {
    let words = &reading.story.tokens[frame.first..frame.end];
    let red = before.iter().any(|control| control.value.state == Some(SignalState::Red));
    !red && words.iter().any(|token| matches!(token.text.as_str(), "is" | "was" | "were"))
}

/// "slowed to about 6 mph", "accelerated to 5 mph": the words before the number, where nothing is told of a later speed.
fn slowed_to(before: &[crate::token::Token], frame: &Frame) -> bool {
    let to = before.iter().rev().find(|token| {
        !matches!(token.text.as_str(), "about" | "approximately" | "around" | "roughly" | "only" | "just" | "~")
    });
    matches!(frame.act(), Some(Act::Slow | Act::Accelerate))
        && frame.happened()
        && to.is_some_and(|token| token.text == "to")
}

/// Speeds that the words tell of somebody.
fn speeds(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Speed>> {
    let tokens = &reading.story.tokens;
    let mut all = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let joined = token.text.strip_suffix("mph").and_then(|number| number.parse::<f64>().ok());
        let unit = tokens.get(at + 1).map_or("", |next| next.text.as_str());
        let apart = token
            .text
            .parse::<f64>()
            .ok()
            .filter(|_| token.kind == TokenKind::Number && matches!(unit, "mph" | "miles"));
        let Some(mph) = joined.or(apart).filter(|mph| *mph < 200.0) else { continue };
        let last_frame = reading
            .story
            .frames
            .iter()
            .enumerate()
            .rev()
            .find(|(_, frame)| frame.first < at && !frame.aside && frame.who.is_some());
        let Some((number, frame)) = last_frame else { continue };
        let sentence = reading.story.sentences[frame.sentence];
        if frame.who != Some(actor) || !(sentence.first..sentence.end).contains(&at) || reading.is_after(number) {
            continue;
        }
        let near: Vec<&str> =
            tokens[at.saturating_sub(4)..tokens.len().min(at + 5)].iter().map(|token| token.text.as_str()).collect();
        let limit = near.iter().any(|word| matches!(*word, "zone" | "limit" | "posted"));
        let meaning = if limit {
            SpeedMeaning::Posted
        } else if frame.is_contact() || slowed_to(&tokens[at.saturating_sub(3)..at], frame) {
            SpeedMeaning::Impact
        } else {
            SpeedMeaning::Approach
        };
        all.push(reading.told(Speed { mps: mph * MPS_PER_MPH, meaning }, at, at + 2));
    }
    all
}

/// What only the columns tell, and the column speed; words win.
pub(crate) fn columns(reading: &Reading<'_>, account: &mut Account) {
    let record = reading.record;
    if let Some(mps) = record.sv_speed_mps {
        let speed = Speed { mps, meaning: SpeedMeaning::Impact };
        account.sv.speeds.push(Fact::of_column(speed, "SV Precrash Speed (MPH)"));
    }
    sv_state(reading, account);
    sv_speed(account);
    if account.sv.zones.is_empty() {
        account.sv.zones = ticked(reading, SUBJECT, &record.sv_zones, "SV Contact Area");
    }
    let partner_told = account.partner.is_some()
        || !matches!(record.partner, Coded::Blank | Coded::Unknown)
        || !record.cp_zones.is_empty();
    if !partner_told {
        return;
    }
    let partner = account.partner.get_or_insert_with(Party::default);
    if partner.zones.is_empty() {
        let actor = reading.contacts.partner.unwrap_or(usize::MAX);
        partner.zones = ticked(reading, actor, &record.cp_zones, "CP Contact Area");
    }
    let column = match record.partner {
        Coded::Known(kind) => Some(kind_of(kind)),
        _ => None,
    };
    let vague = partner.kind.as_ref().is_none_or(|kind| kind.value == Kind::Vehicle);
    // "The truck" is a pickup where the column says so, and "a commercial vehicle" is a van.
    let light = matches!(column, Some(Kind::Pickup | Kind::Van)) && partner.kind.as_ref().is_some_and(is_any_truck);
    if let (true, Some(kind)) = (vague || light, column) {
        partner.kind = Some(Fact::of_column(kind, "Crash With"));
    }
    // Something that neither a word of ours nor the column knows is no road user.
    if partner.kind.is_none() && nobody_else(reading) {
        partner.kind = Some(Fact::by_rule(Kind::Object, "something that has no name of a road user"));
    }
    if partner.state.is_none() {
        let state = match record.cp_movement.known() {
            Some(Movement::Stopped) => Some(ContactState::Stopped),
            Some(Movement::Parked) => Some(ContactState::Parked),
            Some(Movement::Backing) => Some(ContactState::Reversing),
            Some(_) => Some(ContactState::Moving),
            None => None,
        };
        partner.state = state.map(|state| Fact::of_column(state, "CP Pre-Crash Movement"));
    } else {
        partner_state(reading, account);
    }
}

/// Zones of a column; of a mirror its corner is the side.
fn ticked(reading: &Reading<'_>, actor: Actor, zones: &[ContactZone], name: &str) -> Vec<Fact<ContactZone>> {
    use ContactZone as Z;
    let frame = reading.contacts.first.map(|number| &reading.story.frames[number]);
    let piece = frame.and_then(|frame| {
        if frame.who == Some(actor) {
            frame.with.as_ref()
        } else if frame.object == Some(actor) {
            frame.on.as_ref()
        } else {
            None
        }
    });
    let mirror = piece.is_some_and(|piece| piece.mirror);
    let zone = |zone: ContactZone| match zone {
        Z::FrontLeft | Z::RearLeft if mirror => Z::Left,
        Z::FrontRight | Z::RearRight if mirror => Z::Right,
        zone => zone,
    };
    zones.iter().map(|known| Fact::of_column(zone(*known), name)).collect()
}

/// Whether the words tell a contact, and of no other road user.
fn nobody_else(reading: &Reading<'_>) -> bool {
    let story = &reading.story;
    let touches = |frame: &Frame| {
        frame.is_contact()
            || frame.sense == Sense::Headline
            || matches!(frame.act(), Some(Act::Fall)) && frame.who == Some(SUBJECT)
    };
    let known = |kind: Option<Kind>| kind.is_some_and(|kind| kind.group() != KindGroup::Object);
    story.frames.iter().any(touches) && !story.world.actors.iter().skip(1).any(|actor| known(actor.kind))
}

/// Words name an end or a side where the column ticks one corner of it: both are meant.
pub(crate) fn refine(zones: &mut Vec<Fact<ContactZone>>, column: &[ContactZone], name: &str) {
    if let ([told], [ticked]) = (zones.as_slice(), column)
        && super::steps(told.value, *ticked) == 1
    {
        zones.push(Fact::of_column(*ticked, name));
    }
}

fn kind_of(kind: PartnerKind) -> Kind {
    match kind {
        PartnerKind::PassengerCar => Kind::PassengerCar,
        PartnerKind::Suv => Kind::Suv,
        PartnerKind::Van => Kind::Van,
        PartnerKind::PickupTruck => Kind::Pickup,
        PartnerKind::HeavyTruck => Kind::HeavyTruck,
        PartnerKind::Bus => Kind::Bus,
        PartnerKind::Motorcycle => Kind::Motorcycle,
        PartnerKind::Cyclist => Kind::Bicycle,
        PartnerKind::Pedestrian => Kind::Pedestrian,
        PartnerKind::OtherNonMotorist => Kind::ScooterRider,
        PartnerKind::FirstResponder => Kind::FirstResponder,
        PartnerKind::Animal => Kind::Animal,
        PartnerKind::FixedObject => Kind::Object,
    }
}

/// Whether one of the zones of a side is wanted.
pub(crate) fn has_zone(party: &Party, wanted: impl Fn(ContactZone) -> bool) -> bool {
    party.zones.iter().any(|zone| wanted(zone.value))
}
