//! Signals and signs in front of somebody, and speeds, as the words tell them.

use super::Reading;
use super::acts::not_done;
use crate::frame::Frame;
use crate::lexicon::{Form, Sense};
use crate::token::{Token, TokenKind};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Control, ControlDevice, Fact, Obeyed, SignalState, Speed, SpeedMeaning};
use recrash_model::record::MPS_PER_MPH;

/// Signals and signs in front of somebody.
pub(super) fn controls(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Control>> {
    let mut all: Vec<Fact<Control>> = Vec::new();
    let tokens = &reading.story.tokens;
    let mut turned_green = None;
    for (number, frame) in reading.story.frames.iter().enumerate() {
        let changes = match frame.sense {
            Sense::LightGreen | Sense::LightRed | Sense::LightYellow if is_of_others(reading, frame) => None,
            // "waiting for the light to turn green": it is red.
            Sense::LightGreen if frame.form == Form::Base && !frame.happened() => Some(SignalState::Red),
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
            let Some((device, state, length)) = named(&words) else { continue };
            // "as there is no stop sign", "without a signal", "does not have a light".
            let before = |back: usize| at.checked_sub(back).map_or("", |at| tokens[at].text.as_str());
            let none = (1..3).any(|back| matches!(before(back), "no" | "without"))
                || (1..4).any(|back| before(back) == "have" && before(back + 1) == "not");
            if none && !frame.negated {
                continue;
            }
            // "awaiting a green light": it is red.
            let awaited = (1..4).any(|back| before(back).starts_with("await"))
                || (2..5).any(|back| before(back).starts_with("wait") && before(back - 1) == "for");
            let state = if awaited && state == Some(SignalState::Green) { Some(SignalState::Red) } else { state };
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

/// The signal or sign that these words begin with, the state of it, and how many of them name it.
fn named(words: &[&str]) -> Option<(ControlDevice, Option<SignalState>, usize)> {
    Some(match words {
        // "a right-on-red".
        ["right" | "left", "on", "red", ..] | ["right" | "left", "turn", "on", "red", ..] => {
            (ControlDevice::Signal, Some(SignalState::Red), 3)
        }
        ["red", "light" | "signal" | "traffic", ..] | ["red", "left" | "right", "turn", ..] => {
            (ControlDevice::Signal, Some(SignalState::Red), 2)
        }
        ["green", "light" | "signal" | "traffic" | "arrow", ..] => (ControlDevice::Signal, Some(SignalState::Green), 2),
        ["yellow", "light" | "signal", ..] => (ControlDevice::Signal, Some(SignalState::Yellow), 2),
        ["traffic", "light" | "signal", ..] => (ControlDevice::Signal, None, 2),
        ["stop" | "sign", "controlled", ..] => (ControlDevice::StopSign, None, 2),
        ["stop", "sign" | "signs", ..] => (ControlDevice::StopSign, None, 2),
        ["four" | "4" | "three" | "3" | "all", "way", "stop", ..] => (ControlDevice::StopSign, None, 3),
        ["yield", "sign", ..] => (ControlDevice::YieldSign, None, 2),
        _ => return None,
    })
}

/// "The walk signal", "the van's light", "the light for the cross traffic": somebody else's.
fn is_of_others(reading: &Reading<'_>, frame: &Frame) -> bool {
    let sentence = reading.story.sentences[frame.sentence];
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens[at].text.as_str();
    let signal = (sentence.first..frame.first).rfind(|&at| matches!(word(at), "signal" | "light" | "lights"));
    let Some(at) = signal else { return false };
    let before = (sentence.first..at).rev().find(|&at| word(at) != "traffic");
    let walks = before.is_some_and(|at| matches!(word(at), "walk" | "pedestrian" | "crosswalk" | "bicycle"));
    let owner = before.filter(|&at| word(at) == "'s" && at > sentence.first).map(|at| &tokens[at - 1]);
    let owned = owner.is_some_and(|owner| !owner.capital && !matches!(owner.text.as_str(), "av" | "ads" | "vehicle"));
    let cross = |word: &str| {
        matches!(word, "cross" | "crossing" | "oncoming" | "opposing" | "opposite" | "other" | "pedestrians")
    };
    let of_cross = word(at + 1) == "for" && (at + 2..frame.first).take(3).any(|at| cross(word(at)));
    walks || owned || of_cross || is_of_other_lanes(reading, frame, at)
}

/// "The signal for traffic in the next lanes turned green, and the arrow of its own stayed red": not its own.
fn is_of_other_lanes(reading: &Reading<'_>, frame: &Frame, signal: usize) -> bool {
    let sentence = reading.story.sentences[frame.sentence];
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens[at].text.as_str();
    let for_traffic = word(signal + 1) == "for"
        && (signal + 2..frame.first).take(2).any(|at| matches!(word(at), "traffic" | "vehicles"));
    let until = tokens.len().min(reading.until());
    let stays_red = tokens[sentence.first.min(until)..until]
        .windows(2)
        .any(|pair| matches!(pair[0].text.as_str(), "remained" | "stayed" | "still") && pair[1].text == "red");
    for_traffic && stays_red
}

/// Whether a light "was green", and nobody tells that it had been red.
fn was_green(reading: &Reading<'_>, frame: &Frame, before: &[Fact<Control>]) -> bool {
    let words = &reading.story.tokens[frame.first..frame.end];
    let red = before.iter().any(|control| control.value.state == Some(SignalState::Red));
    !red && words.iter().any(|token| matches!(token.text.as_str(), "is" | "was" | "were"))
}

/// "slowed to about 6 mph", "accelerated to 5 mph": the words before the number, where nothing is told of a later speed. "Up to 10 mph" is
/// the most that it reached.
fn slowed_to(before: &[Token], frame: &Frame) -> bool {
    if before.windows(2).any(|pair| pair[0].text == "up" && pair[1].text == "to") {
        return false;
    }
    let to = before.iter().rev().find(|token| {
        !matches!(token.text.as_str(), "about" | "approximately" | "around" | "roughly" | "only" | "just" | "~")
    });
    matches!(frame.act(), Some(Act::Slow | Act::Accelerate))
        && frame.happened()
        && to.is_some_and(|token| token.text == "to")
}

/// "at the time of impact it was doing 30 mph", "was doing 30 mph at the moment of contact", "the crash signal was logged at 30 mph": no
/// other speed stands in between.
fn at_impact(tokens: &[Token], (first, end): (usize, usize), at: usize) -> bool {
    let word = |at: usize| tokens[at].text.as_str();
    let speed = |at: &usize| word(*at).ends_with("mph");
    let crash = |at: usize| matches!(word(at), "impact" | "crash" | "collision" | "contact");
    let mark = |at: usize| {
        let signal = at > first && crash(at - 1) && matches!(word(at), "signal" | "speed");
        let time = |at: usize| matches!(word(at), "time" | "moment" | "instant" | "point");
        signal || crash(at) && (first.max(at.saturating_sub(3))..at).any(time)
    };
    let before = || (first..at).rev().take_while(|at| !speed(at)).any(mark);
    let behind = || (at + 2..end.min(at + 9)).take_while(|at| !speed(at)).any(mark);
    let earlier = (first..end).any(|at| matches!(word(at), "before" | "prior"));
    !earlier && (before() || behind())
}

/// Whether somebody braked or stopped behind this frame, before the contact.
fn slows_later(reading: &Reading<'_>, actor: Actor, number: usize) -> bool {
    reading.before(actor).any(|(later, frame)| {
        later > number && frame.happened() && matches!(frame.act(), Some(Act::Slow | Act::Stop | Act::Hold))
    })
}

/// Speeds that the words tell of somebody.
pub(super) fn speeds(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<Speed>> {
    let tokens = &reading.story.tokens;
    let mut all = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let joined = token.text.strip_suffix("mph").and_then(|number| number.parse::<f64>().ok());
        let unit = tokens.get(at + 1).map_or("", |next| next.text.as_str());
        // "for 2 miles" is no speed.
        let an_hour =
            || tokens.get(at + 2).is_some_and(|next| matches!(next.text.as_str(), "per" | "an" | "hour" | "/"));
        let apart = token
            .text
            .parse::<f64>()
            .ok()
            .filter(|_| token.kind == TokenKind::Number && (unit == "mph" || unit == "miles" && an_hour()));
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
        let impact = at_impact(tokens, (sentence.first, sentence.end), at);
        let in_time = impact || !reading.is_after(number);
        if frame.who != Some(actor) || !(sentence.first..sentence.end).contains(&at) || !in_time {
            continue;
        }
        let near: Vec<&str> =
            tokens[at.saturating_sub(4)..tokens.len().min(at + 5)].iter().map(|token| token.text.as_str()).collect();
        let limit = near.iter().any(|word| matches!(*word, "zone" | "limit" | "posted"));
        let meaning = if limit {
            SpeedMeaning::Posted
        } else if frame.is_contact()
            || impact
            || slowed_to(&tokens[at.saturating_sub(4)..at], frame) && !slows_later(reading, actor, number)
        {
            SpeedMeaning::Impact
        } else {
            SpeedMeaning::Approach
        };
        all.push(reading.told(Speed { mps: mph * MPS_PER_MPH, meaning }, at, tokens.len().min(at + 2)));
    }
    all
}
