//! What no verb of its own tells: a turn ("was stopped in the slip lane"), and that somebody on foot waits ("a man at the corner").

use super::Reading;
use crate::frame::Frame;
use crate::lexicon::{Lexicon, Meaning, Sense};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, ActFact, KindGroup, LeftRight};
use std::ops::Range;

/// The road to which a slip lane leads is named within so many words behind it. [tokens]
const ROAD_WITHIN: usize = 12;

/// Where somebody on foot waits, and for what, is said within so many words behind its name. [tokens]
const KERB_WITHIN: usize = 6;

/// "Yielded to two students at the north kerb", "to a boy about to cross": of whom no more is told, who stands there.
pub(super) fn waits_to_cross(reading: &Reading<'_>, actor: Actor, mut acts: Vec<ActFact>) -> Vec<ActFact> {
    let story = &reading.story;
    let known = &story.world.actors[actor];
    let Some((first, end)) = known.kind_tokens.filter(|_| acts.is_empty()) else { return acts };
    if known.kind.is_none_or(|kind| kind.group() != KindGroup::OnFoot) {
        return acts;
    }
    let ends = |at: &usize| !matches!(story.word(*at), "" | "." | "," | ";" | "and" | "while" | "when" | "as");
    let told = (end..end + KERB_WITHIN).take_while(ends);
    let at_kerb = matches!(story.word(end), "at" | "on" | "near" | "by" | "beside").then(|| {
        told.clone().find(|at| matches!(story.word(*at), "curb" | "kerb" | "corner" | "curbside" | "kerbside"))
    });
    let waits =
        matches!(story.word(end), "preparing" | "about" | "intending" | "ready" | "poised" | "looking" | "wanting");
    let to_cross = (waits && story.word(end + 1) == "to")
        .then(|| told.clone().find(|at| matches!(story.word(*at), "cross" | "step" | "walk" | "enter")));
    let Some(last) = at_kerb.flatten().or(to_cross.flatten()) else { return acts };
    let step = story.frames.iter().rposition(|frame| frame.first <= first).unwrap_or(0) as u32;
    let (after_contact, done, after_other, manner) = (false, false, None, None);
    let source = reading.words(end, last + 1);
    acts.push(ActFact {
        act: Act::Hold,
        side: None,
        step,
        after_contact,
        begun: false,
        done,
        after_other,
        manner,
        source,
    });
    acts
}

/// Whether somebody is told to have been in a turn, by no verb.
pub(super) fn is_in_turn(reading: &Reading<'_>, actor: Actor) -> bool {
    turn_of(reading, actor).is_some()
}

/// A turn that no verb tells.
struct Turned {
    words: Range<usize>,
    /// The frame with which it is told.
    number: usize,
    side: Option<LeftRight>,
    /// It was left off.
    begun: bool,
}

/// Adds the turn in which somebody was, where none is told with a verb: before it slowed or stood in it.
pub(super) fn add_turn(reading: &Reading<'_>, actor: Actor, all: &mut Vec<ActFact>) {
    let turns = |fact: &ActFact| fact.act.turns() && !fact.after_contact;
    if all.iter().any(turns) {
        return;
    }
    let Some(Turned { words, number, side, begun }) = turn_of(reading, actor) else { return };
    let waits = |fact: &ActFact| fact.act.slows() && !fact.after_contact;
    let before = all.iter().filter(|fact| !fact.after_contact).count();
    // Which it left off: to stand for the second time.
    let first = if begun { all.iter().rposition(waits) } else { all.iter().position(waits) };
    let at = first.unwrap_or(before);
    // It turned before it waited.
    if let Some(waiting) = all.get_mut(at).filter(|fact| waits(fact)) {
        waiting.step = waiting.step.max(1);
    }
    let step = all.get(at).filter(|fact| waits(fact)).map_or(number as u32, |fact| fact.step - 1);
    let source = reading.words(words.start, words.end);
    let (after_contact, done, after_other, manner) = (false, false, None, None);
    all.insert(at, ActFact { act: Act::Turn, side, step, after_contact, begun, done, after_other, manner, source });
}

/// The turn in which somebody is told to have been.
fn turn_of(reading: &Reading<'_>, actor: Actor) -> Option<Turned> {
    let until = reading.until().min(reading.story.tokens.len());
    (0..until).find_map(|at| {
        if let Some((words, side)) = left_off(reading, at) {
            let number = told_with(reading, actor, at)?;
            let waits = reading.story.frames[number].act().is_some_and(Act::slows);
            let goes = reading.before(actor).any(|(other, frame)| other < number && frame.act().is_some_and(goes_on));
            // What went back out of it is told of that.
            let back = reading.did(actor, Act::Reverse);
            return (waits && goes && !back).then_some(Turned { words, number, side, begun: true });
        }
        if let Some((words, side)) = stopped_within(reading, at) {
            let number = told_with(reading, actor, at)?;
            let stands = reading.story.frames[number].act().is_some_and(Act::stands);
            return stands.then_some(Turned { words, number, side, begun: false });
        }
        let words = slip_lane(reading, at).filter(|_| actor == SUBJECT)?;
        let number = told_with(reading, actor, at)?;
        Some(Turned { words, number, side: Some(LeftRight::Right), begun: false })
    })
}

/// Acts by which somebody comes into a turn.
const fn goes_on(act: Act) -> bool {
    matches!(act, Act::SetOff | Act::Follow | Act::Enter | Act::Accelerate)
}

/// "set off and came to a stop before the turn was completed", "before it could finish its left turn": it had begun that. The side of a turn
/// that was told before is its.
fn left_off(reading: &Reading<'_>, at: usize) -> Option<(Range<usize>, Option<LeftRight>)> {
    let tokens = &reading.story.tokens;
    if word(tokens, at) != "before" {
        return None;
    }
    let ends = |at: usize| ["complet", "finish", "conclu"].iter().any(|stem| word(tokens, at).starts_with(stem));
    let clause = at + 1..(at + LEFT_OFF_WITHIN).min(tokens.len());
    let clause = clause.take_while(|&at| !matches!(word(tokens, at), "," | "." | "when" | "and"));
    let clause: Vec<usize> = clause.collect();
    let turn = clause.iter().copied().find(|&at| word(tokens, at) == "turn")?;
    let end = clause.iter().copied().find(|&at| ends(at))?;
    // "before a truck could complete its left turn": that one's.
    let other = |at: usize| Lexicon::get().longest(tokens, at, |meaning| matches!(meaning, Meaning::Kind(_))).is_some();
    let whose = clause.iter().any(|&at| matches!(word(tokens, at), "the" | "its" | "that" | "this"))
        && !(at + 1..turn).any(other);
    let side = |at: usize| match word(tokens, at) {
        "left" => Some(LeftRight::Left),
        "right" => Some(LeftRight::Right),
        _ => None,
    };
    let told = || {
        let before =
            (1..at).rfind(|&at| word(tokens, at).starts_with("turn") && side(at - 1).or(side(at + 1)).is_some())?;
        side(before - 1).or(side(before + 1))
    };
    whose.then(|| (at..turn.max(end) + 1, side(turn - 1).or_else(told)))
}

/// "came to a stop midway through its right turn": it was in that.
fn stopped_within(reading: &Reading<'_>, at: usize) -> Option<(Range<usize>, Option<LeftRight>)> {
    let tokens = &reading.story.tokens;
    let into = match (word(tokens, at), word(tokens, at + 1), word(tokens, at + 2)) {
        ("midway" | "halfway" | "partway", "through" | "into", _) => at + 2,
        ("part", "way", "through" | "into") => at + 3,
        _ => return None,
    };
    // "partway into a left turn lane" is no turn.
    let turn = (into + 1..into + 4).find(|&at| {
        word(tokens, at) == "turn" && !matches!(word(tokens, at + 1), "lane" | "lanes" | "pocket" | "bay")
    })?;
    let side = (into..turn).find_map(|at| match word(tokens, at) {
        "left" => Some(LeftRight::Left),
        "right" => Some(LeftRight::Right),
        _ => None,
    });
    matches!(word(tokens, into), "its" | "the" | "a").then_some((at..turn + 1, side))
}

/// What was left off stands so near behind "before". [tokens]
const LEFT_OFF_WITHIN: usize = 9;

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
    let word = |at: usize| word(tokens, at);
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
