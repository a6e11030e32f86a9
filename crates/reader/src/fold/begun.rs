//! How far an act came, where another clause tells it: "tried to back up, but could not".

use crate::chunk::Joint;
use crate::frame::{Frame, Story};
use crate::lexicon::{Form, Progress, Sense};
use crate::world::SUBJECT;
use recrash_model::account::Act;

/// Goes through the frames of a story.
pub(super) fn apply(story: &mut Story) {
    for number in 0..story.frames.len() {
        if was_denied(story, number) || is_before_it(story, number) {
            story.frames[number].progress = Progress::Wished;
        } else if goes_on_to_hit(story, number) {
            story.frames[number].progress = Progress::Real;
        } else if drives_off_at_green(story, number) {
            story.frames[number].sense = Sense::Act(Act::SetOff);
        }
    }
}

/// "tried to back up, but could not": nothing came of it. What "it could not complete" had begun.
fn was_denied(story: &Story, number: usize) -> bool {
    let frame = &story.frames[number];
    let moves = matches!(frame.act(), Some(Act::Reverse | Act::SetOff | Act::Follow | Act::PullOut | Act::Accelerate));
    if frame.progress != Progress::Tried || frame.negated || !moves {
        return false;
    }
    let end = story.sentences[frame.sentence].end;
    let words: Vec<&str> = story.tokens[frame.end..end].iter().take(8).map(|token| token.text.as_str()).collect();
    let Some(but) = words.iter().take(3).position(|word| matches!(*word, "but" | "yet")) else { return false };
    match &words[but + 1..] {
        ["could", "not", next, ..] | ["was" | "were", "unable", next, ..] => {
            matches!(*next, "." | "," | "and" | "in" | "to" | "as")
        }
        ["had", "no", "time" | "room", ..] | ["did", "not", "manage", ..] | ["failed", ..] => true,
        _ => false,
    }
}

/// "Before it had come to a halt, a van hit it", "stopped before it entered the junction": nobody did. "Passed a van before it turned" tells
/// one thing behind the other.
fn is_before_it(story: &Story, number: usize) -> bool {
    let frame = &story.frames[number];
    let clause = story.tokens[story.sentences[frame.sentence].first..frame.first].iter().rev();
    let words: Vec<&str> = clause.map(|token| token.text.as_str()).take_while(|word| *word != ",").collect();
    // "Before the crash, it had stopped."
    let Some(before) = words.iter().position(|word| *word == "before") else { return false };
    let had = words.iter().take(3).any(|word| matches!(*word, "had" | "could"));
    let moves = !matches!(frame.act(), None | Some(Act::Hold | Act::Slow | Act::Leave)) && !frame.is_contact();
    let inner = frame.joint == Some(Joint::Before) && before < BEFORE_WITHIN && frame.form != Form::Ing;
    if !moves || !inner {
        return false;
    }
    let waits = |other: &Frame| {
        let stops = other.act().is_some_and(Act::slows) || other.sense == Sense::Yield;
        stops && other.sentence == frame.sentence && other.who == frame.who && other.joint != frame.joint
    };
    let stops = frame.act() == Some(Act::Stop);
    had || !stops && frame.who.is_some() && story.frames.iter().any(waits)
}

/// "before the AV had" stands so near before its verb. [tokens]
const BEFORE_WITHIN: usize = 6;

/// "stopped behind it before rolling forward and bumping it": so it did.
fn goes_on_to_hit(story: &Story, number: usize) -> bool {
    let frame = &story.frames[number];
    let wished = frame.progress == Progress::Wished && frame.joint == Some(Joint::Before) && frame.form == Form::Ing;
    let hits = |next: &Frame| {
        let touches = matches!(next.sense, Sense::Contact | Sense::RearEnd) && next.object == Some(SUBJECT);
        touches && next.who == frame.who && next.sentence == frame.sentence && next.form == Form::Ing && !next.negated
    };
    wished && frame.act().is_some() && story.frames.get(number + 1).is_some_and(hits)
}

/// "It waited at a light; that turned green, and it drove off": it left nobody.
fn drives_off_at_green(story: &Story, number: usize) -> bool {
    let frame = &story.frames[number];
    if frame.act() != Some(Act::Leave) || !frame.happened() {
        return false;
    }
    let here = |other: &Frame| other.sentence == frame.sentence || other.sentence + 1 == frame.sentence;
    let green = story.frames[..number].iter().any(|other| here(other) && other.sense == Sense::LightGreen);
    let touched = story.frames[..number].iter().any(|other| other.is_contact() && other.object == Some(SUBJECT));
    green && !touched && story.tokens[frame.first].text.starts_with("dr")
}
