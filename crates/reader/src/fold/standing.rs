//! State at the contact as the words tell it, and how long somebody had stood.

use super::acts::tells_where;
use super::counted::{
    avoids, begins_to_go_on, drives_already, gains_speed, in_headline, leaves_rest, names_mode, sets_off_at_green,
};
use super::lanes::waits_to_change;
use super::speeds::is_of_last_contact;
use super::{Reading, flashback, nominal};
use crate::chunk::Joint;
use crate::frame::Frame;
use crate::lexicon::{Form, Part, Progress, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, ContactState, Fact, Standing};

/// That somebody begins to be in a junction or a lane.
const ENTERS: [&str; 3] = ["beginning to enter", "began to enter", "begins to enter"];

/// What the frames up to here tell of the state of somebody.
#[derive(Default)]
struct Told {
    state: Option<Fact<ContactState>>,
    standing: Option<Fact<Standing>>,
    /// It moved before.
    moved: bool,
    /// Sentence and clause of the last frame, and the token behind it.
    since: Option<(usize, u32)>,
    spoken: usize,
}

/// State at the contact, and how long it had stood.
pub(super) fn state(reading: &Reading<'_>, actor: Actor) -> (Option<Fact<ContactState>>, Option<Fact<Standing>>) {
    let contact = reading.contacts.first.map(|contact| &reading.story.frames[contact]);
    let sentence = contact.map(|frame| frame.sentence);
    // Who stood in its turn came there.
    let mut told = Told { moved: nominal::is_in_turn(reading, actor), ..Told::default() };
    for number in flashback::in_order(reading, actor).0 {
        let frame = &reading.story.frames[number];
        if reading.doer(frame) == Some(actor)
            && told.state.is_none()
            && has_yet_to_stop(frame)
            && !reading.is_after(number)
        {
            told.state = Some(Fact { value: ContactState::Moving, source: reading.of(frame) });
        }
        if reading.doer(frame) != Some(actor) || !frame.happened() || reading.is_after(number) {
            continue;
        }
        let Some(act) = frame.act().filter(|act| !matches!(act, Act::OpenDoor | Act::Leave)) else { continue };
        // "was driving on after stopping at a sign": it drives.
        if is_behind_main(reading, frame) && told.since.is_some_and(|(sentence, _)| sentence == frame.sentence) {
            told.moved |= act != Act::Hold;
            // "stopped after turning right": it came there.
            if told.stands() && told.moved && act != Act::Stop {
                told.standing = Some(Fact { value: Standing::CameToStop, source: reading.of(frame) });
            }
            continue;
        }
        let aside = frame.aside && Some(frame.sentence) != sentence && told.state.is_some();
        // "It was traveling at 0 mph", told behind the contact, is no act.
        let speed = || act == Act::Follow && is_of_last_contact(reading, frame.sentence);
        let mode = || act == Act::Follow && names_mode(reading, number, frame);
        if aside || act == Act::Follow && in_headline(reading, frame) || speed() || mode() {
            continue;
        }
        let where_it_is = told.stands() && tells_where(reading, frame);
        if let Some(standing) = told.standing.as_mut().filter(|_| where_it_is) {
            // It had come there.
            *standing = Fact { value: Standing::CameToStop, source: reading.of(frame) };
        }
        let braked = act == Act::Slow && told.stands() && avoids(reading, frame);
        if braked || where_it_is || waits_to_change(reading, number, frame) {
            continue;
        }
        let act = match act {
            Act::SetOff if gains_speed(reading, number, frame) => Act::Accelerate,
            Act::SetOff if begins_to_go_on(reading, number, frame) || drives_already(reading, number, frame) => {
                Act::Follow
            }
            Act::Follow if sets_off_at_green(reading, number, frame) => Act::SetOff,
            Act::Follow | Act::Accelerate if leaves_rest(reading, frame) => Act::SetOff,
            act => act,
        };
        told.add(reading, frame, act);
    }
    let hits = contact.filter(|frame| actor != SUBJECT && frame.who == Some(actor) && runs_into(reading, frame));
    if let (Some(frame), Some(ContactState::Stopped)) = (hits, told.state()) {
        told.state = Some(Fact { value: ContactState::Moving, source: reading.of(frame) });
        told.standing = None;
    }
    (told.state, told.standing)
}

/// "had been waiting, jumped the light and hit it": who runs into another moves.
fn runs_into(reading: &Reading<'_>, frame: &Frame) -> bool {
    let word = reading.story.tokens[frame.first].text.as_str();
    let runs = ["hit", "struck", "ran", "drove", "crash", "slam", "ram", "plow", "collid", "smash"];
    frame.object == Some(SUBJECT)
        && frame.sense == Sense::Contact
        && frame.with.is_none()
        && !frame.passive
        && runs.iter().any(|stem| word.starts_with(stem))
}

impl Told {
    fn state(&self) -> Option<ContactState> {
        self.state.as_ref().map(|state| state.value)
    }

    fn stands(&self) -> bool {
        self.state().is_some_and(ContactState::stands)
    }

    /// Adds what one frame tells.
    fn add(&mut self, reading: &Reading<'_>, frame: &Frame, act: Act) {
        let text = reading.text[reading.story.tokens[frame.first].start..].to_lowercase();
        // "Having stopped at a sign, it was driving on."
        let own = ["was", "were"].contains(&word_before(reading, frame, 1)) && word_before(reading, frame, 2) != "and";
        let Some(next) =
            self.next(frame, act, &text).or(Some(ContactState::Moving).filter(|_| act == Act::Follow && own))
        else {
            return;
        };
        // "was traveling at 1 mph, waiting for a gap".
        let words = &reading.story.tokens[self.spoken.min(frame.first)..frame.first];
        let rolls = act == Act::Hold
            && frame.form == Form::Ing
            && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence)
            && words.iter().any(|token| token.text == "mph");
        if rolls && self.state().is_some_and(|state| !state.stands()) {
            return;
        }
        // "backed out and crossed the street, and its tail hit the AV": still backwards.
        let goes_on = matches!(act, Act::Cross | Act::Follow | Act::Enter | Act::Turn);
        let here = self.since.is_some_and(|(sentence, _)| sentence == frame.sentence);
        if goes_on && here && self.state() == Some(ContactState::Reversing) && touches_with_rear(reading, frame) {
            return;
        }
        self.since = Some((frame.sentence, frame.clause));
        self.spoken = frame.end;
        if next.stands() {
            self.stand(reading, frame, act, &text);
        } else {
            self.moved = true;
            self.standing = None;
        }
        self.state = Some(Fact { value: next, source: reading.of(frame) });
    }

    /// The state that an act leads to; `None` where it changes nothing.
    fn next(&self, frame: &Frame, act: Act, text: &str) -> Option<ContactState> {
        let parked = frame.sense == Sense::Parked || self.state() == Some(ContactState::Parked) && act == Act::Hold;
        let same_clause = frame.form == Form::Ing && self.since == Some((frame.sentence, frame.clause));
        Some(match act {
            Act::Hold | Act::Stop if parked => ContactState::Parked,
            Act::Hold | Act::Stop => ContactState::Stopped,
            Act::Park if text.starts_with("parked") => ContactState::Parked,
            // Who comes along and "was beginning to enter" the junction had not stood.
            Act::SetOff if self.state().is_some() && !self.stands() && ENTERS.iter().any(|so| text.starts_with(so)) => {
                ContactState::Moving
            }
            Act::SetOff => ContactState::SettingOff,
            Act::Reverse => ContactState::Reversing,
            Act::Follow | Act::Enter if self.stands() && text.starts_with("continu") => return None,
            // "was stopped at a light, heading west".
            Act::Follow | Act::Turn if self.stands() && same_clause => return None,
            // "reversed and maneuvered to the right": backwards.
            Act::Drift | Act::Swerve | Act::Park | Act::LaneChange
                if self.state() == Some(ContactState::Reversing)
                    // "backed out and then merged into the lane": forward again.
                    && (act != Act::LaneChange || frame.form == Form::Ing)
                    && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence) =>
            {
                return None;
            }
            // "kept backing and started to turn into a space": backwards.
            Act::Turn
                if self.state() == Some(ContactState::Reversing)
                    && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence)
                    && text
                        .split('.')
                        .next()
                        .is_some_and(|clause| clause.contains("parking") || clause.contains("space")) =>
            {
                return None;
            }
            // "An SUV reversing along the kerb approached".
            Act::Follow
                if self.state() == Some(ContactState::Reversing)
                    && frame.sense == Sense::Approach
                    && text.starts_with("approach")
                    && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence) =>
            {
                return None;
            }
            // "reversed out of a driveway and entered the lane": backwards.
            Act::Enter
                if self.state() == Some(ContactState::Reversing)
                    && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence) =>
            {
                return None;
            }
            Act::Follow if self.stands() => ContactState::SettingOff,
            Act::Accelerate if self.state() == Some(ContactState::SettingOff) => ContactState::SettingOff,
            // "shifted into reverse and began to accelerate".
            Act::Accelerate if self.state() == Some(ContactState::Reversing) => return None,
            Act::Pushed | Act::Fall => return None,
            _ => ContactState::Moving,
        })
    }

    /// How long it has stood.
    fn stand(&mut self, reading: &Reading<'_>, frame: &Frame, act: Act, text: &str) {
        let stopping = ["slowing", "stopping", "coming to", "braking"].iter().any(|start| text.starts_with(start));
        let stopping = stopping && frame.joint != Some(Joint::After) || stops_meanwhile(reading, frame, act);
        let how = if stopping {
            Standing::Stopping
        } else if self.moved || act == Act::Stop {
            Standing::CameToStop
        } else {
            Standing::FromTheStart
        };
        let before = self.standing.as_ref().map(|standing| standing.value);
        let how = match before {
            _ if how == Standing::Stopping || !self.stands() => how,
            None => how,
            Some(Standing::Stopping) => Standing::CameToStop,
            Some(_) => return,
        };
        self.standing = Some(Fact { value: how, source: reading.of(frame) });
    }
}

/// Whether who does this touches the other with its rear, in the same sentence.
fn touches_with_rear(reading: &Reading<'_>, frame: &Frame) -> bool {
    let Some(contact) = reading.contacts.first.map(|number| &reading.story.frames[number]) else { return false };
    let rear = contact.with.as_ref().is_some_and(|piece| piece.parts.contains(&Part::Rear));
    rear && contact.who == frame.who && contact.sentence == frame.sentence
}

/// "was about to stop", "had not yet stopped": it moves.
fn has_yet_to_stop(frame: &Frame) -> bool {
    let stops = matches!(frame.act(), Some(Act::Stop | Act::Slow)) && !frame.aside;
    let meant = frame.progress == Progress::Wished && matches!(frame.joint, None | Some(Joint::While));
    frame.who == Some(SUBJECT) && stops && (meant != frame.negated)
}

/// The word that stands so far before a frame.
fn word_before<'a>(reading: &'a Reading<'_>, frame: &Frame, back: usize) -> &'a str {
    frame.first.checked_sub(back).map_or("", |at| reading.story.tokens[at].text.as_str())
}

/// "was driving on after stopping": what is told behind "after" came first.
fn is_behind_main(reading: &Reading<'_>, frame: &Frame) -> bool {
    let before = word_before(reading, frame, 1);
    let after = frame.form == Form::Ing && frame.joint == Some(Joint::After) && matches!(before, "after" | "following");
    // "stopped, having turned left".
    after || before == "having" && word_before(reading, frame, 2) == ","
}

/// "As it came to a stop, a cyclist hit it": it had yet to stand. With something told in between it had come to stand.
fn stops_meanwhile(reading: &Reading<'_>, frame: &Frame, act: Act) -> bool {
    let frames = &reading.story.frames;
    let Some(number) = reading.contacts.first.filter(|_| act == Act::Stop && frame.form == Form::Past) else {
        return false;
    };
    let contact = &frames[number];
    let (first, end) = (frame.first.min(contact.first), frame.first.max(contact.first));
    let between =
        |other: &&Frame| other.first > first && other.first < end && !other.aside && other.sense != frame.sense;
    let from = reading.story.sentences[frame.sentence].first.max(frame.first.saturating_sub(STOPS_WITHIN));
    let as_it = reading.story.tokens[from..frame.first].iter().any(|token| token.text == "as");
    as_it
        && frame.who == Some(SUBJECT)
        && frame.joint == Some(Joint::While)
        && contact.joint != Some(Joint::While)
        && frame.sentence == contact.sentence
        && contact.is_contact()
        && !frames.iter().any(|other| between(&other))
}

/// "as the AV" stands so near before its verb. [tokens]
const STOPS_WITHIN: usize = 5;
