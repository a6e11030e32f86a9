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
    // Who stood in its turn came there.
    let mut told = Told { moved: nominal::is_in_turn(reading, actor), ..Told::default() };
    for number in flashback::in_order(reading, actor).0 {
        let frame = &reading.story.frames[number];
        if reading.doer(frame) != Some(actor) || reading.is_after(number) {
            continue;
        }
        if told.state.is_none() && has_yet_to_stop(frame) {
            told.state = Some(Fact { value: ContactState::Moving, source: reading.of(frame) });
        }
        let act = frame.act().filter(|act| frame.happened() && !matches!(act, Act::OpenDoor | Act::Leave));
        if let Some(act) = act {
            told.take_in(reading, number, act);
        }
    }
    let contact = reading.contacts.first.map(|contact| &reading.story.frames[contact]);
    let hits = contact.filter(|frame| actor != SUBJECT && frame.who == Some(actor) && runs_into(reading, frame));
    if let (Some(frame), Some(ContactState::Stopped)) = (hits, told.state()) {
        told.state = Some(Fact { value: ContactState::Moving, source: reading.of(frame) });
        told.standing = None;
    }
    (told.state, told.standing)
}

/// An act as it counts for the state: who went on from a standstill set off, and who moved already did not.
fn as_it_counts(reading: &Reading<'_>, number: usize, act: Act) -> Act {
    let frame = &reading.story.frames[number];
    match act {
        Act::SetOff if gains_speed(reading, number, frame) => Act::Accelerate,
        Act::SetOff if begins_to_go_on(reading, number, frame) || drives_already(reading, number, frame) => Act::Follow,
        Act::Follow if sets_off_at_green(reading, number, frame) => Act::SetOff,
        Act::Follow | Act::Accelerate if leaves_rest(reading, frame) => Act::SetOff,
        act => act,
    }
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

    /// Takes in a frame of what somebody did before the contact.
    fn take_in(&mut self, reading: &Reading<'_>, number: usize, act: Act) {
        let frame = &reading.story.frames[number];
        // "was driving on after stopping at a sign": it drives.
        if is_behind_main(reading, frame) && self.is_in_sentence(frame) {
            self.moved |= act != Act::Hold;
            // "stopped after turning right": it came there.
            if self.stands() && self.moved && act != Act::Stop {
                self.standing = Some(Fact { value: Standing::CameToStop, source: reading.of(frame) });
            }
            return;
        }
        if self.is_told_besides(reading, number, act) {
            return;
        }
        let where_it_is = self.stands() && tells_where(reading, frame);
        if let Some(standing) = self.standing.as_mut().filter(|_| where_it_is) {
            // It had come there.
            *standing = Fact { value: Standing::CameToStop, source: reading.of(frame) };
        }
        let braked = act == Act::Slow && self.stands() && avoids(reading, frame);
        if !(braked || where_it_is || waits_to_change(reading, number, frame)) {
            self.add(reading, frame, as_it_counts(reading, number, act));
        }
    }

    /// Whether a frame was told in the sentence of the last one.
    fn is_in_sentence(&self, frame: &Frame) -> bool {
        self.since.is_some_and(|(sentence, _)| sentence == frame.sentence)
    }

    /// Whether a frame tells of no act by itself: an adjective in another sentence, a headline, a speed, who drove.
    fn is_told_besides(&self, reading: &Reading<'_>, number: usize, act: Act) -> bool {
        let frame = &reading.story.frames[number];
        let contact = reading.contacts.first.map(|contact| reading.story.frames[contact].sentence);
        // "It was traveling at 0 mph", told behind the contact, is no act.
        let speed = || is_of_last_contact(reading, frame.sentence);
        frame.aside && Some(frame.sentence) != contact && self.state.is_some()
            || act == Act::Follow && (in_headline(reading, frame) || speed() || names_mode(reading, number, frame))
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
            && self.is_in_sentence(frame)
            && words.iter().any(|token| token.text == "mph");
        if rolls && self.state().is_some_and(|state| !state.stands()) {
            return;
        }
        // "backed out and crossed the street, and its tail hit the AV": still backwards.
        let goes_on = matches!(act, Act::Cross | Act::Follow | Act::Enter | Act::Turn);
        let here = self.is_in_sentence(frame);
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
            _ if self.still_backs(frame, act, text) => return None,
            Act::Follow if self.stands() => ContactState::SettingOff,
            Act::Accelerate if self.state() == Some(ContactState::SettingOff) => ContactState::SettingOff,
            // "shifted into reverse and began to accelerate".
            Act::Accelerate if self.state() == Some(ContactState::Reversing) => return None,
            Act::Pushed | Act::Fall => return None,
            _ => ContactState::Moving,
        })
    }

    /// Whether who went backwards does so in the same sentence, and still goes backwards.
    fn still_backs(&self, frame: &Frame, act: Act, text: &str) -> bool {
        if self.state() != Some(ContactState::Reversing) || !self.is_in_sentence(frame) {
            return false;
        }
        match act {
            // "reversed and maneuvered to the right", "reversed out of a driveway and entered the lane".
            Act::Drift | Act::Swerve | Act::Park | Act::Enter => true,
            // "backed out and then merged into the lane": forward again.
            Act::LaneChange => frame.form == Form::Ing,
            // "kept backing and started to turn into a space".
            Act::Turn => {
                let clause = text.split('.').next();
                clause.is_some_and(|clause| clause.contains("parking") || clause.contains("space"))
            }
            // "An SUV reversing along the kerb approached".
            Act::Follow => frame.sense == Sense::Approach && text.starts_with("approach"),
            _ => false,
        }
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
