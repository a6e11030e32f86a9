//! State at the contact as the words tell it, how long somebody had stood, and why.

use super::acts::{
    avoids, begins_to_go_on, drives_already, gains_speed, in_headline, leaves_rest, names_mode, sets_off_at_green,
    tells_where,
};
use super::controls::{in_its_queue, is_lamp, shown};
use super::lanes::waits_to_change;
use super::speeds::is_of_last_contact;
use super::{Reading, flashback, nominal};
use crate::chunk::Joint;
use crate::frame::Frame;
use crate::lexicon::{COMPANY, Form, Lexicon, Meaning, Part, Progress, Relation, Sense};
use crate::token::Token;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, ContactState, Fact, Kind, KindGroup, SignalState, Source, StandReason, Standing};

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

/// Why somebody stood: named with the last thing that made it stand.
pub(super) fn reasons(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<StandReason>> {
    let lexicon = Lexicon::get();
    let stands = |frame: &Frame| {
        matches!(frame.act(), Some(Act::Hold | Act::Stop | Act::Slow | Act::PullOver))
            || frame.act() == Some(Act::Park) && frame.progress == Progress::Real
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
        let (own, end) = (end.min(sentence.end), in_its_queue(reading, number, end).min(sentence.end));
        // What happened while it stood is not why: "was stopped when an ambulance passed".
        let stood = frame.act() == Some(Act::Hold);
        let then = (frame.end..end).find(|at| stood && tokens[*at].text == "when").unwrap_or(end);
        let named = lexicon.reasons(&tokens[begins..then]);
        let red = (begins..then).find(|at| matches!(shown(reading, *at, then), Some((_, Some(SignalState::Red), _))));
        if let Some(at) = red.filter(|_| !all.iter().any(|known| known.value == StandReason::RedLight)) {
            all.push(reading.told(StandReason::RedLight, at, at + 1));
        }
        for (reason, at, length) in named.iter().copied() {
            // Words that say more say all: "waiting for the" of "waiting for the intersection to clear".
            let within = |(other, from, count): &(StandReason, usize, usize)| {
                *other != reason && rank(*other) < rank(reason) && *from < at + length && at < from + count
            };
            let place = reason == StandReason::Pedestrian && is_a_place(tokens, begins + at);
            // "slowing for a passenger car".
            let car = tokens.get(begins + at + length).is_some_and(|next| {
                matches!(next.text.as_str(), "car" | "cars" | "vehicle" | "vehicles" | "van" | "sedan" | "suv")
            });
            let place = place || car && reason == StandReason::PickupDropoff;
            let no_red = |at| is_lamp(reading, (at, length)) || shows_another_colour(reading, at, length);
            let not_red = reason == StandReason::RedLight && no_red(begins + at);
            // "behind a van that was letting out passengers": why the van stood.
            let of_queue = begins + at >= own && !matches!(reason, StandReason::RedLight | StandReason::Queue);
            let of_queue = of_queue || is_of_another(tokens, begins + at, reason);
            let of_queue = of_queue || reason == StandReason::Queue && is_behind_it(tokens, begins + at + length);
            if !place
                && !not_red
                && !of_queue
                && !all.iter().any(|known| known.value == reason)
                && !named.iter().any(within)
            {
                all.push(reading.told(reason, begins + at, begins + at + length));
            }
        }
        if let Some(reason) = because(reading, number).filter(|_| all.is_empty()) {
            all.push(reason);
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
        if let Some(reason) = yields_to.and_then(|to| reading.story.world.actors[to].kind).and_then(waits_for)
            && all.is_empty()
        {
            all.push(Fact { value: reason, source: reading.of(frame) });
        }
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
    let mut kept: Vec<Fact<StandReason>> = Vec::new();
    for reason in all {
        if !kept.iter().any(|other| is_within(&reason.source, &other.source)) {
            kept.push(reason);
        }
    }
    kept.truncate(2);
    kept
}

/// "let" of "to let out a passenger": words within those of another reason say nothing more.
fn is_within(words: &Source, others: &Source) -> bool {
    match (words, others) {
        (Source::Words { start, end, .. }, Source::Words { start: from, end: until, .. }) => {
            start >= from && end <= until && end - start < until - from
        }
        _ => false,
    }
}

/// "stopped because cars ahead had stopped", "so a woman could cross": why, told in the clause behind.
fn because(reading: &Reading<'_>, number: usize) -> Option<Fact<StandReason>> {
    let (story, frame) = (&reading.story, &reading.story.frames[number]);
    let other = |(_, next): &(usize, &Frame)| next.first > frame.first && !next.aside && next.who != frame.who;
    let here = |(_, next): &(usize, &Frame)| next.sentence == frame.sentence;
    let (at, next) = story.frames.iter().enumerate().skip(number + 1).take_while(here).find(other)?;
    // "as cars ahead were queued", and not "as a van hit it".
    let stands = matches!(next.act(), Some(Act::Stop | Act::Hold)) && next.happened();
    let queued = stands && next.who.is_some_and(|who| story.world.actors[who].several);
    let why = |token: &Token| matches!(token.text.as_str(), "because" | "since" | "so") || queued && token.text == "as";
    let joint = (frame.end..next.first.max(frame.end)).find(|at| why(&story.tokens[*at]))?;
    let who = next.who.filter(|_| !next.is_contact())?;
    let (_, end) = reading.window(at);
    let named = Lexicon::get().reasons(&story.tokens[joint..end]);
    if let Some((reason, from, length)) = named.into_iter().min_by_key(|(reason, ..)| rank(*reason)) {
        return Some(reading.told(reason, joint + from, joint + from + length));
    }
    let known = &story.world.actors[who];
    let kind = known.kind?;
    let stands = matches!(next.act(), Some(Act::Stop | Act::Hold | Act::Slow)) && next.happened();
    let ahead = known.relations.iter().any(|(relation, _)| *relation == Relation::Ahead);
    let value = match waits_for(kind) {
        Some(reason) => reason,
        None if !kind.is_vehicle() => return None,
        None if stands && known.several => StandReason::Queue,
        None if stands && ahead => StandReason::LeadVehicle,
        None if next.progress == Progress::Wished => StandReason::Yield,
        None => return None,
    };
    Some(Fact { value, source: reading.of(next) })
}

/// "stopped for a bus discharging riders": why the bus stood.
fn is_of_another(tokens: &[Token], at: usize, reason: StandReason) -> bool {
    let kind = |at: usize| Lexicon::get().longest(tokens, at, |meaning| matches!(meaning, Meaning::Kind(_))).is_some();
    let ing = tokens[at].text.ends_with("ing");
    reason == StandReason::PickupDropoff && ing && at.checked_sub(1).is_some_and(kind)
}

/// "was stopped at a red light with a line of vehicles behind it": it stands in no queue for that. The token behind "line of".
fn is_behind_it(tokens: &[Token], end: usize) -> bool {
    let word = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let several = matches!(word(end), "vehicles" | "cars" | "traffic" | "trucks");
    let at = end + usize::from(several);
    let own = matches!(
        (word(at + 1), word(at + 2)),
        ("it" | "them", _) | ("the", "av" | "vehicle" | "subject" | "ego" | COMPANY)
    );
    word(at) == "behind" && own
}

/// "stopped for a paramedic on foot": why, by whom it stops for.
fn waits_for(kind: Kind) -> Option<StandReason> {
    match kind {
        Kind::PoliceCar | Kind::Ambulance | Kind::FireTruck | Kind::FirstResponder => {
            Some(StandReason::EmergencyVehicle)
        }
        kind => match kind.group() {
            KindGroup::OnFoot | KindGroup::Cyclist => Some(StandReason::Pedestrian),
            KindGroup::Animal => Some(StandReason::Animal),
            _ => None,
        },
    }
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

/// "by a green traffic light": a light of which no red is told makes nobody stand.
fn shows_another_colour(reading: &Reading<'_>, at: usize, length: usize) -> bool {
    let tokens = &reading.story.tokens;
    let red = |token: &Token| token.text == "red" || token.text == "stoplight";
    let until = reading.until().min(tokens.len());
    let stop = tokens[at..at + length].iter().any(|token| token.text == "stop" || token.text == "stoplight");
    let green = tokens[..at].iter().any(|token| token.text == "green");
    green && !stop && !tokens[..until].iter().any(red)
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
    // "After dropping off a rider, it stopped", "vehicles were queued, so it stopped": why, told in a clause before.
    let riders = |other: &Frame| {
        let word = reading.story.tokens[other.first].text.as_str();
        let lets = ["drop", "pick", "let", "load", "unload"].iter().any(|stem| word.starts_with(stem));
        other.sense == Sense::Other && lets || other.sense == Sense::See
    };
    let queue = |other: &Frame| {
        let several = other.who.is_some_and(|who| reading.story.world.actors[who].several && who != SUBJECT);
        several && !other.is_contact() && matches!(other.act(), None | Some(Act::Hold | Act::Stop))
    };
    let mut before = reading.story.frames[..number].iter().rev();
    let before =
        before.find(|other| other.sentence == frame.sentence && !other.aside && !riders(other) && !queue(other));
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
