//! The turn that no verb tells: "was stopped in the slip lane".

use super::Reading;
use crate::frame::Frame;
use crate::lexicon::{Lexicon, Meaning, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, ActFact, LeftRight};
use std::ops::Range;

/// The road to which a slip lane leads is named within so many words behind it. [tokens]
const ROAD_WITHIN: usize = 12;

/// Whether somebody is told to have been in a turn, by no verb.
pub(super) fn is_in_turn(reading: &Reading<'_>, actor: Actor) -> bool {
    turn_of(reading, actor).is_some()
}

/// Adds the turn in which somebody was, where none is told with a verb: before it slowed or stood in it.
pub(super) fn add_turn(reading: &Reading<'_>, actor: Actor, all: &mut Vec<ActFact>) {
    let turns = |fact: &ActFact| matches!(fact.act, Act::Turn | Act::UTurn) && !fact.after_contact;
    if all.iter().any(turns) {
        return;
    }
    let Some((words, number)) = turn_of(reading, actor) else { return };
    let waits = |fact: &ActFact| matches!(fact.act, Act::Stop | Act::Hold | Act::Slow) && !fact.after_contact;
    let before = all.iter().filter(|fact| !fact.after_contact).count();
    let at = all.iter().position(waits).unwrap_or(before);
    // It turned before it waited.
    if let Some(waiting) = all.get_mut(at).filter(|fact| waits(fact)) {
        waiting.step = waiting.step.max(1);
    }
    let step = all.get(at).filter(|fact| waits(fact)).map_or(number as u32, |fact| fact.step - 1);
    let source = reading.words(words.start, words.end);
    let (act, side) = (Act::Turn, Some(LeftRight::Right));
    let (after_contact, begun, done, after_other, manner) = (false, false, false, None, None);
    all.insert(at, ActFact { act, side, step, after_contact, begun, done, after_other, manner, source });
}

/// The words for the turn in which somebody is told to have been, and the frame with which that is told.
fn turn_of(reading: &Reading<'_>, actor: Actor) -> Option<(Range<usize>, usize)> {
    let until = reading.until().min(reading.story.tokens.len());
    (0..until).find_map(|at| {
        let words = slip_lane(reading, at).filter(|_| actor == SUBJECT)?;
        Some((words, told_with(reading, actor, at)?))
    })
}

/// The frame beside these words, where it is told of somebody: the last before them in their sentence, else the next behind them.
fn told_with(reading: &Reading<'_>, actor: Actor, at: usize) -> Option<usize> {
    let story = &reading.story;
    let sentence = story.sentences.iter().position(|sentence| (sentence.first..sentence.end).contains(&at))?;
    let here = |(_, frame): &(usize, &Frame)| frame.sentence == sentence && !frame.aside;
    let frames = || story.frames.iter().enumerate().filter(here);
    let before = frames().rfind(|(_, frame)| frame.first < at);
    if before.is_none() && actor == SUBJECT && was_in_mode(reading, story.sentences[sentence].first, at) {
        return frames().find(|(_, frame)| frame.first > at).map(|(number, _)| number);
    }
    let (number, frame) = before.or_else(|| frames().find(|(_, frame)| frame.first > at))?;
    // "It was hit by a van during its turn": its own.
    let subject = if frame.passive { frame.object.or(frame.who) } else { frame.who };
    let of = subject == Some(actor);
    // "while merging in a slip lane" is told with its own verb.
    let told = !matches!(frame.sense, Sense::Headline | Sense::Act(Act::LaneChange)) && !reading.is_after(number);
    // "a truck in the slip lane", "struck by a sedan in the slip lane": that one is there.
    let another = at.checked_sub(1).is_some_and(|last| is_of_others(reading, last));
    (of && told && !another && !frame.is_contact()).then_some(number)
}

/// "The AV was in autonomous mode in the slip lane when a van struck it": the words before the place are of the subject vehicle, and tell nothing
/// that it did.
fn was_in_mode(reading: &Reading<'_>, first: usize, at: usize) -> bool {
    let tokens = &reading.story.tokens;
    let own = |meaning| matches!(meaning, Meaning::Subject | Meaning::Company);
    let named = (first..at.min(first + 4)).any(|at| Lexicon::get().longest(tokens, at, own).is_some());
    let was = tokens[first..at].iter().any(|token| token.text == "was");
    named && was && tokens[at - 1].text == "mode"
}

/// Whether a token is the noun for somebody else.
fn is_of_others(reading: &Reading<'_>, at: usize) -> bool {
    Lexicon::get().longest(&reading.story.tokens, at, |meaning| matches!(meaning, Meaning::Kind(_))).is_some()
}

/// "in the slip lane from southbound Elm Street": where traffic keeps right, in a turn to the right. Onto a highway it is a ramp.
fn slip_lane(reading: &Reading<'_>, at: usize) -> Option<Range<usize>> {
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    if !matches!(word(at), "in" | "on" | "within" | "inside") {
        return None;
    }
    let article = usize::from(matches!(word(at + 1), "the" | "a" | "its" | "that" | "this"));
    let turn = if (word(at + 1 + article), word(at + 2 + article)) == ("right", "turn") { 2 } else { 0 };
    let slip = at + 1 + article + turn;
    let end = slip + 2;
    let clause = (end..end + ROAD_WITHIN).map(word).take_while(|word| !matches!(*word, "," | "." | "when" | ""));
    let mut clause = clause.collect::<Vec<_>>().into_iter();
    let ramp = clause.any(|word| matches!(word, "highway" | "freeway" | "interstate" | "ramp"));
    let slips = word(slip) == "slip" && matches!(word(slip + 1), "lane" | "lanes");
    (slips && !ramp).then_some(at..end)
}
