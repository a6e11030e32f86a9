//! State at the contact as the words tell it, how long somebody had stood, and why.

use super::acts::{avoids, begins_to_go_on, gains_speed, in_headline, sets_off_at_green};
use super::lanes::waits_to_change;
use super::speeds::is_of_last_contact;
use super::{Reading, flashback, nominal};
use crate::frame::Frame;
use crate::lexicon::{Form, Lexicon, Progress, Relation, Sense};
use crate::token::Token;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, ContactState, Fact, Kind, StandReason, Standing};

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
        if reading.doer(frame) != Some(actor) || !frame.happened() || reading.is_after(number) {
            continue;
        }
        let Some(act) = frame.act().filter(|act| !matches!(act, Act::OpenDoor | Act::Leave)) else { continue };
        let aside = frame.aside && Some(frame.sentence) != sentence && told.state.is_some();
        // "It was traveling at 0 mph", told behind the contact, is no act.
        let speed = || act == Act::Follow && is_of_last_contact(reading, frame.sentence);
        if aside || act == Act::Follow && in_headline(reading, frame) || speed() {
            continue;
        }
        if act == Act::Slow && told.stands() && avoids(reading, frame) || waits_to_change(reading, number, frame) {
            continue;
        }
        let act = match act {
            Act::SetOff if gains_speed(reading, number, frame) => Act::Accelerate,
            Act::SetOff if begins_to_go_on(reading, number, frame) => Act::Follow,
            Act::Follow if sets_off_at_green(reading, number, frame) => Act::SetOff,
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
        let Some(next) = self.next(frame, act, &text) else { return };
        // "was traveling at 1 mph, waiting for a gap".
        let words = &reading.story.tokens[self.spoken.min(frame.first)..frame.first];
        let rolls = act == Act::Hold
            && frame.form == Form::Ing
            && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence)
            && words.iter().any(|token| token.text == "mph");
        if rolls && self.state().is_some_and(|state| !state.stands()) {
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
            Act::Drift | Act::Swerve
                if self.state() == Some(ContactState::Reversing)
                    && self.since.is_some_and(|(sentence, _)| sentence == frame.sentence) =>
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
        // What happened while it stood is not why: "was stopped when an ambulance passed".
        let stood = frame.act() == Some(Act::Hold);
        let then = (frame.end..end).find(|at| stood && tokens[*at].text == "when").unwrap_or(end);
        let named = lexicon.reasons(&tokens[begins..then]);
        for (reason, at, length) in named.iter().copied() {
            // Words that say more say all: "waiting for the" of "waiting for the intersection to clear".
            let within = |(other, from, count): &(StandReason, usize, usize)| {
                *other != reason && rank(*other) < rank(reason) && *from < at + length && at < from + count
            };
            let place = reason == StandReason::Pedestrian && is_a_place(tokens, begins + at);
            if !place && !all.iter().any(|known| known.value == reason) && !named.iter().any(within) {
                all.push(reading.told(reason, begins + at, begins + at + length));
            }
        }
        if let Some((reason, at, length)) = blocked_by(reading, end)
            && !all.iter().any(|known| known.value == reason)
        {
            all.push(reading.told(reason, at, at + length));
        }
        let behind = frame.relations.iter().find_map(|(relation, to)| {
            let to = (*to).filter(|to| *to != SUBJECT)?;
            (*relation == Relation::Behind).then_some(to)
        });
        let yields_to = match frame.sense {
            Sense::Yield => frame.object,
            Sense::Act(Act::Stop | Act::Slow | Act::Hold) => frame.object,
            _ => None,
        };
        // Whom it met is in front of it only where that is told.
        let met = |lead: &Actor| {
            let ahead = |(relation, _): &(Relation, usize)| *relation == Relation::Ahead;
            Some(*lead) == reading.contacts.partner && !reading.story.world.actors[*lead].relations.iter().any(ahead)
        };
        if let Some(lead) = behind.or(yields_to.filter(|lead| !met(lead)))
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

/// "stopped behind a van that was blocking the intersection": what the clause about the van, which begins before this token, tells of the way.
fn blocked_by(reading: &Reading<'_>, behind: usize) -> Option<(StandReason, usize, usize)> {
    let tokens = &reading.story.tokens;
    let word = |back: usize| behind.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
    if !(matches!(word(2), "that" | "which") && matches!(word(1), "was" | "is" | "had")) {
        return None;
    }
    let ends = |token: &Token| matches!(token.text.as_str(), "," | "." | "and" | "when" | "as");
    let clause = tokens[behind..].iter().position(ends).map_or(tokens.len(), |length| behind + length);
    let named = Lexicon::get().reasons(&tokens[behind..clause]);
    let blocks = |reason: StandReason| matches!(reason, StandReason::BlockedJunction | StandReason::BlockedPath);
    let most = named.into_iter().filter(|(reason, ..)| blocks(*reason)).min_by_key(|(reason, ..)| rank(*reason));
    most.map(|(reason, at, length)| (reason, behind + at, length))
}

/// "just past the crosswalk", "short of the crosswalk": where, and for nobody.
fn is_a_place(tokens: &[Token], at: usize) -> bool {
    let word = |back: usize| at.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
    let article = usize::from(matches!(word(1), "the" | "a" | "its"));
    tokens[at].text == "crosswalk"
        && matches!(word(1 + article), "past" | "beyond" | "before" | "behind" | "over" | "near" | "of" | "after")
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
