//! Signals and signs in front of somebody, as the words tell them.

use super::Reading;
use super::undone::not_done;
use crate::frame::Frame;
use crate::lexicon::{Form, Lexicon, Meaning, Relation, Sense};
use crate::token::{Token, word};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Control, ControlDevice, Fact, Obeyed, SignalState, Source};

/// Signals and signs in front of somebody.
pub(super) fn controls(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Control>> {
    let mut all: Vec<Fact<Control>> = Vec::new();
    let mut turned = None;
    for (number, frame) in reading.story.frames.iter().enumerate() {
        let changes = light_changes(reading, frame, &all).filter(|_| !reading.is_after(number));
        if let Some(state) = changes {
            turned = Some((state, frame.first, frame.end));
            if let Some(control) = all.iter_mut().find(|control| control.value.device == ControlDevice::Signal) {
                control.value.state = Some(state);
            }
        }
        // "was rear-ended by a van at a red light": both were there.
        let struck = frame.is_contact() && frame.object == Some(actor);
        if frame.who != Some(actor) && !struck || reading.is_after(number) || frame.aside {
            continue;
        }
        let (first, end) = reading.window(number);
        let end = if struck { of_the_contact(reading, number, end) } else { in_its_queue(reading, number, end) };
        let ran =
            if frame.negated { not_done(reading, number, frame) } else { frame.act().filter(|_| frame.happened()) };
        let clause = Clause { reading, actor, number, first, end, struck, ran };
        for at in first..end {
            if let Some((control, length)) = clause.control(at) {
                clause.add(control, (at, length), &mut all);
            }
        }
    }
    if actor == SUBJECT {
        told_besides(reading, &mut all, turned);
    }
    all
}

/// Adds what is told of lights and signs in no clause of what the subject vehicle does.
fn told_besides(reading: &Reading<'_>, all: &mut Vec<Fact<Control>>, turned: Option<(SignalState, usize, usize)>) {
    let state = turned.map(|(state, ..)| state);
    had_a_light(reading, all);
    was_at_a_sign(reading, all);
    of_that_queue(reading, all, state);
    of_those_ahead(reading, all, state);
    let Some((state, first, end)) = turned else {
        told_alone(reading, all);
        light_changed(reading, all);
        return;
    };
    if all.iter().all(|control| control.value.device != ControlDevice::Signal) {
        all.push(reading.told(Control { device: ControlDevice::Signal, state: Some(state), obeyed: None }, first, end));
    }
}

/// What a frame tells of a light that changes.
fn light_changes(reading: &Reading<'_>, frame: &Frame, before: &[Fact<Control>]) -> Option<SignalState> {
    let of_others = || is_of_others(reading, told_in(reading, frame));
    match frame.sense {
        Sense::LightGreen | Sense::LightRed | Sense::LightYellow if of_others() => None,
        Sense::LightGreen if turns_on_red(reading) => None,
        // "waiting for the light to turn green": it is red.
        Sense::LightGreen if frame.form == Form::Base && !frame.happened() => Some(SignalState::Red),
        Sense::LightGreen if was_green(reading, frame, before) => Some(SignalState::Green),
        Sense::LightGreen => Some(SignalState::TurnedGreen),
        Sense::LightRed => Some(SignalState::TurnedRed),
        Sense::LightYellow => Some(SignalState::Yellow),
        _ => None,
    }
}

/// The words of what somebody did, or of how it was struck.
struct Clause<'a> {
    reading: &'a Reading<'a>,
    actor: Actor,
    /// Its frame, and its tokens.
    number: usize,
    first: usize,
    end: usize,
    /// It tells that it was struck.
    struck: bool,
    /// What it did, or is told not to have done.
    ran: Option<Act>,
}

impl Clause<'_> {
    /// The word that stands so far before a token.
    fn before(&self, at: usize, back: usize) -> &str {
        at.checked_sub(back).map_or("", |at| self.reading.story.tokens[at].text.as_str())
    }

    /// The light or sign at this token, in front of who does what is told here, and how many tokens name it.
    fn control(&self, at: usize) -> Option<(Control, usize)> {
        let tokens = &self.reading.story.tokens;
        let words: Vec<&str> = tokens[at..self.end.min(at + 4)].iter().map(|token| token.text.as_str()).collect();
        let (device, state, length) = named(&words).or_else(|| shown(self.reading, at, self.end))?;
        let state = state.or_else(|| shown(self.reading, at + length - 1, self.end).and_then(|(_, state, _)| state));
        // "hit it at a red light", and not "hit it on a red light".
        let there = !self.struck || (1..4).any(|back| self.before(at, back) == "at");
        let denied = self.is_none(at) && !self.reading.story.frames[self.number].negated;
        if denied || !there || is_lamp(self.reading, (at, length)) {
            return None;
        }
        // "awaiting a green light": it is red.
        let awaited = (1..4).any(|back| self.before(at, back).starts_with("await"))
            || (2..5).any(|back| self.before(at, back).starts_with("wait") && self.before(at, back - 1) == "for");
        let state = if awaited && state == Some(SignalState::Green) { Some(SignalState::Red) } else { state };
        Some((Control { device, state, obeyed: self.obeyed(device, state) }, length))
    }

    /// "as there is no stop sign", "without a signal", "does not have a light", "only the side street has stop signs".
    fn is_none(&self, at: usize) -> bool {
        (1..3).any(|back| matches!(self.before(at, back), "no" | "without"))
            || (1..4).any(|back| self.before(at, back) == "have" && self.before(at, back + 1) == "not")
            || self.actor == SUBJECT && is_of_side_street(&self.reading.story.tokens[self.first..at])
    }

    /// Whether it kept to a light or a sign.
    fn obeyed(&self, device: ControlDevice, state: Option<SignalState>) -> Option<Obeyed> {
        let breaks = if device == ControlDevice::Signal { Act::RunRed } else { Act::RunStop };
        if self.ran == Some(breaks) {
            return Some(Obeyed::No);
        }
        let stops = self.ran.is_some_and(Act::stands) && state != Some(SignalState::Green);
        // "was slowing for a red light", and did not go on into the junction.
        let slows = || {
            self.ran == Some(Act::Slow)
                && state == Some(SignalState::Red)
                && !goes_in(self.reading, self.actor, self.number)
        };
        (stops || slows()).then_some(Obeyed::Yes)
    }

    /// Adds a light or a sign, or what it says more of one that is known.
    fn add(&self, control: Control, (at, length): (usize, usize), all: &mut Vec<Fact<Control>>) {
        let Some(known) = all.iter_mut().find(|known| known.value.device == control.device) else {
            all.push(self.reading.told(control, at, at + length));
            return;
        };
        // "waited at a red light and entered on a green light".
        let moves = matches!(self.ran, Some(Act::SetOff | Act::Enter | Act::Turn | Act::Follow));
        let turned = moves && (known.value.state, control.state) == (Some(SignalState::Red), Some(SignalState::Green));
        known.value.state = if turned { Some(SignalState::TurnedGreen) } else { known.value.state.or(control.state) };
        let broken = control.obeyed == Some(Obeyed::No);
        known.value.obeyed = if broken { Some(Obeyed::No) } else { known.value.obeyed.or(control.obeyed) };
    }
}

/// "a truck with a broken stop light", "the stop light of a van": a lamp of that.
pub(super) fn is_lamp(reading: &Reading<'_>, (at, length): (usize, usize)) -> bool {
    let tokens = &reading.story.tokens;
    let vehicle = |at: usize| {
        let kind = |meaning| matches!(meaning, Meaning::Kind(kind) if kind.is_vehicle());
        Lexicon::get().longest(tokens, at, kind).is_some()
    };
    let article = usize::from(matches!(word(tokens, at + length + 1), "a" | "an" | "the"));
    let of = word(tokens, at + length) == "of" && vehicle(at + length + 1 + article);
    let with = (1..5).any(|back| back < at && word(tokens, at - back) == "with" && vehicle(at - back - 1));
    let broken = at > 0 && matches!(word(tokens, at - 1), "broken" | "faulty" | "defective");
    word(tokens, at) == "stop" && matches!(word(tokens, at + 1), "light" | "signal") && (of || with || broken)
}

/// "where only the side street has" stop signs: none on the way of who has the right of way there. Of the words before a sign.
fn is_of_side_street(before: &[Token]) -> bool {
    let within = &before[before.len().saturating_sub(6)..];
    within.windows(3).any(|words| {
        let [one, two, three] = [0, 1, 2].map(|at| words[at].text.as_str());
        matches!(one, "side" | "cross" | "minor" | "intersecting")
            && matches!(two, "street" | "road" | "traffic")
            && matches!(three, "has" | "had" | "have" | "faces" | "faced")
    })
}

/// "slowed for a red light but did not stop and entered the intersection": what it does behind this frame.
fn goes_in(reading: &Reading<'_>, actor: Actor, number: usize) -> bool {
    let goes = |frame: &Frame| {
        let runs = matches!(frame.act(), Some(Act::RunRed | Act::Enter | Act::Cross | Act::Turn | Act::Accelerate));
        runs && frame.happened() || not_done(reading, number, frame) == Some(Act::RunRed)
    };
    reading.before(actor).any(|(later, frame)| later > number && goes(frame))
}

/// "in a line of vehicles held by the red light", "stopped behind cars waiting at it": the light of those in whose queue somebody stands is its
/// own. The token up to which the words of such a stand go on.
pub(super) fn in_its_queue(reading: &Reading<'_>, number: usize, end: usize) -> usize {
    let story = &reading.story;
    let frame = &story.frames[number];
    let stands = frame.act().is_some_and(Act::stands) && frame.happened();
    let words = &story.tokens[frame.first..end.max(frame.first)];
    let line = words.iter().any(|token| matches!(token.text.as_str(), "line" | "queue" | "row" | "column"));
    let behind = frame.relations.iter().any(|(relation, to)| *relation == Relation::Behind && to.is_some());
    if !stands || !(line || behind) {
        return end;
    }
    let next = story.frames[number + 1..].iter().find(|next| next.first >= end && next.sentence == frame.sentence);
    let Some(queue) = next.filter(|next| next.who.is_some_and(|who| who != SUBJECT)) else { return end };
    let waits = queue.act().is_some_and(Act::stands) || story.tokens[queue.first].text == "held";
    let sentence = story.sentences[frame.sentence].end;
    let goes_on =
        |other: &&Frame| other.first > queue.first && other.sentence == frame.sentence && other.who != queue.who;
    let until = story.frames.iter().find(goes_on).map_or(sentence, |other| other.first);
    if waits { until.max(end) } else { end }
}

/// The words of a contact alone, up to the next verb.
fn of_the_contact(reading: &Reading<'_>, number: usize, end: usize) -> usize {
    let frames = &reading.story.frames;
    frames[number + 1..].iter().find(|next| next.first > frames[number].first).map_or(end, |next| end.min(next.first))
}

/// "The AV had a green light", "With a green light, it was driving": told in no clause of what it does.
fn had_a_light(reading: &Reading<'_>, all: &mut Vec<Fact<Control>>) {
    let story = &reading.story;
    let word = |at: usize| story.word(at);
    let until = reading.until().min(story.tokens.len());
    for at in 0..until {
        let named_here =
            matches!(word(at + 1), "a" | "the" | "its").then(|| named(&[word(at + 2), word(at + 3), word(at + 4)]));
        let Some(Some((device, state, length))) = named_here else { continue };
        let before = (at.saturating_sub(2)..at).map(word).collect::<Vec<_>>();
        let had =
            matches!(word(at), "had" | "having") && before.iter().any(|word| matches!(*word, "av" | "it" | "which"));
        let sentence = story.sentences.iter().position(|sentence| (sentence.first..sentence.end).contains(&at));
        let next = story.frames.iter().find(|frame| frame.first > at && Some(frame.sentence) == sentence);
        let fronted = word(at) == "with" && sentence.is_some_and(|sentence| story.sentences[sentence].first == at);
        let own = next.is_some_and(|next| next.who == Some(SUBJECT)) && (fronted || had);
        if own && all.iter().all(|known| known.value.device != device) {
            all.push(reading.told(Control { device, state, obeyed: None }, at + 2, at + 2 + length));
        }
    }
}

/// "The stationary AV was in autonomous mode at the stop sign": told with no verb but "was", behind what is told of it.
fn was_at_a_sign(reading: &Reading<'_>, all: &mut Vec<Fact<Control>>) {
    let story = &reading.story;
    let word = |at: usize| story.word(at);
    for at in 1..reading.until().min(story.tokens.len()) {
        let words: Vec<&str> = (at..at + 4).map(word).collect();
        let Some((device, state, length)) = named(&words) else { continue };
        let article = usize::from(matches!(word(at - 1), "a" | "the" | "its"));
        let there = at > article && word(at - 1 - article) == "at";
        let Some(sentence) = story.sentences.iter().find(|sentence| (sentence.first..sentence.end).contains(&at))
        else {
            continue;
        };
        let before =
            || story.frames.iter().enumerate().filter(|(_, frame)| frame.first < at && frame.first >= sentence.first);
        let covered =
            before().any(|(number, frame)| frame.who.is_some() && reading.window(number).1 > at && !frame.aside);
        let last = before().next_back().map(|(_, frame)| frame);
        let stood = |frame: &Frame| frame.act().is_some_and(Act::stands) && frame.happened();
        let own = last.filter(|frame| frame.who == Some(SUBJECT) && stood(frame));
        // "stopped behind a van which was at the stop sign", "stopped and a van was at the sign": that was.
        let other = |at: usize| {
            let vehicle = |meaning: Meaning| matches!(meaning, Meaning::Kind(_));
            matches!(word(at), "which" | "that" | "who") || Lexicon::get().longest(&story.tokens, at, vehicle).is_some()
        };
        let was = own.is_some_and(|frame| (frame.end..at).any(|at| word(at) == "was") && !(frame.end..at).any(other));
        if there && was && !covered && all.iter().all(|known| known.value.device != device) {
            all.push(reading.told(Control { device, state, obeyed: Some(Obeyed::Yes) }, at, at + length));
        }
    }
}

/// "Traffic had queued at a red light, and the AV was standing in that line": the light of the line is its own.
fn of_that_queue(reading: &Reading<'_>, all: &mut Vec<Fact<Control>>, turned: Option<SignalState>) {
    let tokens = &reading.story.tokens;
    let word = |at: usize| word(tokens, at);
    let line = |at: &usize| {
        matches!(word(*at), "that" | "this" | "the")
            && matches!(word(at + 1), "queue" | "line")
            && *at > 0
            && word(at - 1) == "in"
    };
    for sentence in reading.story.sentences.iter().filter(|sentence| sentence.first < reading.until()) {
        let Some(queue) = (sentence.first..sentence.end).find(line) else { continue };
        let queued = (sentence.first..queue)
            .any(|at| word(at).starts_with("queue") || word(at) == "line" || word(at) == "lined");
        let light = (sentence.first..queue).find_map(|at| {
            let words: Vec<&str> = (at..at + 4).map(word).collect();
            named(&words).map(|(device, state, length)| (at, device, state, length))
        });
        if let (true, Some((at, device, state, length))) = (queued, light)
            && all.iter().all(|known| known.value.device != device)
        {
            let state = turned.filter(|_| device == ControlDevice::Signal).or(state);
            all.push(reading.told(Control { device, state, obeyed: Some(Obeyed::Yes) }, at, at + length));
        }
    }
}

/// "Cars ahead of it were stopped at a red light, so it stopped too": the light of those ahead is its own.
fn of_those_ahead(reading: &Reading<'_>, all: &mut Vec<Fact<Control>>, turned: Option<SignalState>) {
    let story = &reading.story;
    let word = |at: usize| story.word(at);
    let stands = |frame: &Frame| frame.act().is_some_and(Act::stands) && frame.happened();
    let ahead = |who: Actor| {
        who != SUBJECT && story.world.actors[who].relations.iter().any(|(relation, _)| *relation == Relation::Ahead)
    };
    let signal = |control: &Fact<Control>| control.value.device == ControlDevice::Signal;
    // "stopped for a dog": what it stopped for is no light.
    let own_cause = |number: usize, who: Option<Actor>| {
        let (first, end) = reading.window(number);
        let shared = |at: usize| {
            let near = (at + 1..at + 5).map(word);
            near.into_iter().any(|word| {
                matches!(
                    word,
                    "light" | "signal" | "traffic" | "queue" | "red" | "them" | "stopped" | "vehicles" | "cars"
                )
            })
        };
        let cause = |at: usize| matches!(word(at), "for" | "because" | "due" | "avoid") && !shared(at);
        story.frames[number].object.is_none_or(|object| Some(object) != who) && (first..end).any(cause)
    };
    for (number, frame) in story.frames.iter().enumerate().filter(|(number, _)| !reading.is_after(*number)) {
        let stops_behind = |(number, next): (usize, &Frame)| {
            let near = next.who == Some(SUBJECT) && stands(next) && next.sentence <= frame.sentence + 1;
            near && !own_cause(number, frame.who)
        };
        let followed = story.frames.iter().enumerate().skip(number + 1).take(4).any(stops_behind);
        if !(frame.who.is_some_and(ahead) && stands(frame) && followed) || all.iter().any(signal) {
            continue;
        }
        let (first, end) = reading.window(number);
        // "at a red light at the next intersection", "on the cross street": none of its own.
        let elsewhere = |at: usize| {
            let cross = word(at) == "cross" && matches!(word(at + 1), "street" | "road" | "traffic");
            cross || word(at) == "next" && !matches!(word(at + 1), "to" | "lane")
        };
        if (first..end).any(elsewhere) {
            continue;
        }
        let light = (first..end).find_map(|at| {
            let words: Vec<&str> = (at..(at + 4).min(end)).map(word).collect();
            named(&words).map(|(device, state, length)| (at, device, state, length))
        });
        if let Some((at, device, state, length)) = light.filter(|(_, device, ..)| *device == ControlDevice::Signal) {
            let state = turned.or(state);
            all.push(reading.told(Control { device, state, obeyed: Some(Obeyed::Yes) }, at, at + length));
        }
    }
}

/// "stood at a red light. Once the light had changed, it moved off": it turned green, though nobody tells to what.
fn light_changed(reading: &Reading<'_>, all: &mut [Fact<Control>]) {
    let tokens = &reading.story.tokens;
    let red = |control: &&mut Fact<Control>| {
        control.value.device == ControlDevice::Signal && control.value.state == Some(SignalState::Red)
    };
    let Some(control) = all.iter_mut().find(red) else { return };
    let goes = |frame: &Frame| {
        matches!(frame.act(), Some(Act::SetOff | Act::Enter | Act::Turn | Act::Follow)) && frame.happened()
    };
    let changes = |at: usize| {
        let had = usize::from(matches!(word(tokens, at + 1), "had" | "then"));
        let colour = matches!(word(tokens, at + had + 2), "to" | "from" | "red" | "yellow" | "green");
        matches!(word(tokens, at), "light" | "signal" | "lights" | "signals")
            && matches!(word(tokens, at + had + 1), "changed" | "changes" | "cycled" | "switched")
            && !colour
    };
    let red_at = match &control.source {
        Source::Words { start, .. } => *start,
        _ => 0,
    };
    let sentence = |at: usize| reading.story.sentences.iter().position(|run| (run.first..run.end).contains(&at));
    // "The light changed. It stopped at the red light": to red.
    let stops = |frame: &Frame| frame.act() == Some(Act::Stop) && frame.happened();
    let own = |at: usize| {
        let first = sentence(at).map_or(at, |number| reading.story.sentences[number].first);
        let behind = || reading.before(SUBJECT).map(|(_, frame)| frame).filter(|frame| frame.first > at);
        let next = behind().find(|frame| goes(frame) || stops(frame)).is_some_and(goes);
        next && tokens[at].start > red_at && !is_of_others(reading, (first, at + 1))
    };
    if (0..reading.until().min(tokens.len())).any(|at| changes(at) && own(at)) {
        control.value.state = Some(SignalState::TurnedGreen);
    }
}

/// "The signal was red for the AV as it came": told in no clause of anybody.
fn told_alone(reading: &Reading<'_>, all: &mut Vec<Fact<Control>>) {
    let story = &reading.story;
    if all.iter().any(|control| control.value.device == ControlDevice::Signal) {
        return;
    }
    let of_nobody = |at: usize| {
        let over = |(number, frame): (usize, &Frame)| {
            let (first, end) = reading.window(number);
            frame.who.is_some() && (first..end).contains(&at)
        };
        !story.frames.iter().enumerate().any(over)
    };
    let until = reading.until().min(story.tokens.len());
    let told = (0..until).find_map(|at| {
        let sentence = story.sentences.iter().find(|sentence| (sentence.first..sentence.end).contains(&at))?;
        let (device, state, length) = shown(reading, at, sentence.end)?;
        let near = at.saturating_sub(3).max(sentence.first)..sentence.end.min(at + length + 4);
        let own = story.tokens[near].iter().any(|token| matches!(token.text.as_str(), "av" | "it" | "its"));
        let others = is_of_others(reading, (sentence.first, at + length));
        (own && of_nobody(at) && !others).then_some((device, state, at, length))
    });
    if let Some((device, state, at, length)) = told {
        all.push(reading.told(Control { device, state, obeyed: None }, at, at + length));
    }
}

/// "the signal, which was flashing red", "a light showing green", "where the light was red": the light at this token, and its colour.
pub(super) fn shown(
    reading: &Reading<'_>,
    at: usize,
    end: usize,
) -> Option<(ControlDevice, Option<SignalState>, usize)> {
    let tokens = &reading.story.tokens;
    let word = |at: usize| word(tokens, at);
    let before = at.checked_sub(1).map_or("", word);
    if !matches!(word(at), "light" | "signal" | "lights" | "signals") || OTHER_LIGHTS.contains(&before) {
        return None;
    }
    // "the light at Birch Street was red".
    let street = |at: usize| {
        tokens[at].capital
            || word(at).contains("xxx")
            || matches!(
                word(at),
                "street" | "avenue" | "road" | "drive" | "boulevard" | "ahead" | "there" | "on" | "of"
            )
    };
    let colour = (at + 1..end.min(at + COLOUR_WITHIN)).find(|&at| !BEFORE_COLOUR.contains(&word(at)) && !street(at))?;
    let state = match word(colour) {
        "red" => SignalState::Red,
        "green" => SignalState::Green,
        "yellow" | "amber" => SignalState::Yellow,
        _ => return None,
    };
    // "where the light was red for cross traffic".
    let of_cross =
        (colour + 1..colour + 4).any(|at| matches!(word(at), "cross" | "crossing" | "oncoming" | "opposing"));
    let plain = colour > at + 1 && !matches!(word(colour - 1), "a" | "the") && !of_cross;
    plain.then_some((ControlDevice::Signal, Some(state), colour + 1 - at))
}

/// Words between a light and its colour: "the signal, which was flashing red".
const BEFORE_COLOUR: [&str; 35] = [
    "av",
    "being",
    "now",
    "was",
    "is",
    "which",
    "that",
    "had",
    "been",
    "were",
    ",",
    "showed",
    "showing",
    "shows",
    "show",
    "displaying",
    "displayed",
    "flashing",
    "solid",
    "steady",
    "still",
    "facing",
    "it",
    "its",
    "way",
    "for",
    "them",
    "then",
    "at",
    "the",
    "time",
    "a",
    "stayed",
    "remained",
    "burning",
];

/// Words before a light that is none of the road: "its brake light", "a walk signal", "the van's turn signal", "the light of the cross street".
const OTHER_LIGHTS: [&str; 11] =
    ["walk", "pedestrian", "crosswalk", "brake", "tail", "turn", "warning", "hazard", "'s", "head", "cross"];

/// The colour of a light stands so near behind it. [tokens]
const COLOUR_WITHIN: usize = 10;

/// The signal or sign that these words begin with, the state of it, and how many of them name it.
fn named(words: &[&str]) -> Option<(ControlDevice, Option<SignalState>, usize)> {
    Some(match words {
        // "a right-on-red".
        ["right" | "left" | "turn", "on", "red", ..] | ["right" | "left", "turn", "on", "red", ..] => {
            (ControlDevice::Signal, Some(SignalState::Red), 3)
        }
        ["on", "red", rest @ ..] if !matches!(rest.first(), Some(&("light" | "signal" | "traffic"))) => {
            (ControlDevice::Signal, Some(SignalState::Red), 2)
        }
        ["on" | "at", "a", "red", rest @ ..]
            if !matches!(
                rest.first(),
                Some(&("light" | "signal" | "traffic" | "car" | "truck" | "curb" | "van" | "arrow"))
            ) =>
        {
            (ControlDevice::Signal, Some(SignalState::Red), 3)
        }
        ["red", "light" | "signal" | "traffic" | "arrow", ..] | ["red", "left" | "right", "turn", ..] => {
            (ControlDevice::Signal, Some(SignalState::Red), 2)
        }
        ["green", "light" | "signal" | "traffic" | "arrow" | "showing", ..]
        | ["green", "left" | "right", "turn", ..] => (ControlDevice::Signal, Some(SignalState::Green), 2),
        ["yellow", "light" | "signal", ..] => (ControlDevice::Signal, Some(SignalState::Yellow), 2),
        ["traffic" | "stop", "light" | "signal", ..] => (ControlDevice::Signal, None, 2),
        ["at" | "for", "the" | "a" | "that", "light" | "signal" | "stoplight", rest @ ..]
            if !matches!(
                rest.first(),
                Some(&("rail" | "pole" | "post" | "speed" | "pace" | "from" | "truck" | "vehicle"))
            ) =>
        {
            (ControlDevice::Signal, None, 3)
        }
        ["at" | "for", "the", "sign", rest @ ..]
            if !matches!(rest.first(), Some(&("pole" | "post" | "company" | "shop"))) =>
        {
            (ControlDevice::StopSign, None, 3)
        }
        ["stop", "at" | "for", "the", "sign", ..] => (ControlDevice::StopSign, None, 4),
        ["stop" | "sign", "controlled", ..] => (ControlDevice::StopSign, None, 2),
        ["stop", "sign" | "signs", ..] => (ControlDevice::StopSign, None, 2),
        ["four" | "4" | "three" | "3" | "all", "way", "stop", ..] => (ControlDevice::StopSign, None, 3),
        ["yield", "sign", ..] => (ControlDevice::YieldSign, None, 2),
        _ => return None,
    })
}

/// From where to where a sentence tells of a light, up to the verb of this frame.
fn told_in(reading: &Reading<'_>, frame: &Frame) -> (usize, usize) {
    (reading.story.sentences[frame.sentence].first, frame.first)
}

/// "turned right on red. A van came through on the green": that one's.
pub(super) fn turns_on_red(reading: &Reading<'_>) -> bool {
    let red = |frame: &Frame| {
        let words = &reading.story.tokens[frame.first..reading.story.sentences[frame.sentence].end];
        let turn = words.iter().take(ON_RED_WITHIN).position(|token| token.text == "on");
        turn.is_some_and(|on| words.get(on + 1).is_some_and(|token| token.text == "red"))
    };
    let turns = |frame: &Frame| matches!(frame.act(), Some(Act::Turn | Act::SetOff)) && frame.happened();
    reading.before(SUBJECT).any(|(_, frame)| turns(frame) && red(frame))
}

/// So many words after the verb of a turn, at most, stand those that it was made at red: "went to turn right on red". [tokens]
const ON_RED_WITHIN: usize = 7;

/// "The walk signal", "the van's light", "the light for the cross traffic": somebody else's.
fn is_of_others(reading: &Reading<'_>, (first, told): (usize, usize)) -> bool {
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens[at].text.as_str();
    let signal = (first..told).rfind(|&at| matches!(word(at), "signal" | "light" | "lights"));
    let Some(at) = signal else { return false };
    let before = (first..at).rev().find(|&at| word(at) != "traffic");
    let walks = before.is_some_and(|at| matches!(word(at), "walk" | "pedestrian" | "crosswalk" | "bicycle"));
    let owner = before.filter(|&at| word(at) == "'s" && at > first).map(|at| &tokens[at - 1]);
    let owned = owner.is_some_and(|owner| !owner.capital && !matches!(owner.text.as_str(), "av" | "ads" | "vehicle"));
    let cross = |word: &str| {
        matches!(word, "cross" | "crossing" | "oncoming" | "opposing" | "opposite" | "other" | "pedestrians")
    };
    let of_cross = word(at + 1) == "for" && (at + 2..told).take(3).any(|at| cross(word(at)));
    walks || owned || of_cross || is_of_other_lanes(reading, (first, told), at)
}

/// "The signal for traffic in the next lanes turned green, and the arrow of its own stayed red": not its own.
fn is_of_other_lanes(reading: &Reading<'_>, (first, told): (usize, usize), signal: usize) -> bool {
    let tokens = &reading.story.tokens;
    let for_traffic = word(tokens, signal + 1) == "for"
        && (signal + 2..told).take(2).any(|at| matches!(word(tokens, at), "traffic" | "vehicles"));
    let until = tokens.len().min(reading.until());
    let stays_red = tokens[first.min(until)..until]
        .windows(2)
        .any(|pair| matches!(pair[0].text.as_str(), "remained" | "stayed" | "still") && pair[1].text == "red");
    for_traffic && stays_red
}

/// Whether a light "was green", and nobody tells that it had been red.
fn was_green(reading: &Reading<'_>, frame: &Frame, before: &[Fact<Control>]) -> bool {
    let words = &reading.story.tokens[frame.first..frame.end];
    let red = before.iter().any(|control| control.value.state == Some(SignalState::Red));
    !red && words
        .iter()
        .any(|token| matches!(token.text.as_str(), "is" | "was" | "were" | "showing" | "showed" | "shows"))
}
