//! Signals and signs in front of somebody, as the words tell them.

use super::Reading;
use super::acts::not_done;
use crate::frame::Frame;
use crate::lexicon::{Form, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Control, ControlDevice, Fact, Obeyed, SignalState};

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
        ["right" | "left" | "turn", "on", "red", ..] | ["right" | "left", "turn", "on", "red", ..] => {
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
