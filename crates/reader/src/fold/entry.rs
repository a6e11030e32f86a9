//! Who goes into or through an intersection, where the verb itself says another thing: "proceeded straight through the intersection",
//! "halfway through the intersection it began to slow".

use super::Reading;
use super::across::begins;
use crate::chunk::is_determiner;
use crate::frame::Frame;
use crate::token::word;
use recrash_model::account::{Act, ActFact, Source};

/// So many words stand between a verb and the intersection into which it leads, at most: "proceeded a short distance forward into the". [tokens]
const BETWEEN: usize = 10;

/// Behind these words it is told of something else, or of what is yet to come.
const ENDS: [&str; 16] = [
    ",",
    ";",
    "and",
    "or",
    "but",
    "when",
    "while",
    "as",
    "before",
    "prior",
    "for",
    "toward",
    "towards",
    "preparing",
    "waiting",
    "behind",
];

/// Words that stand before "intersection" in its name.
const OF_INTERSECTION: [&str; 18] = [
    "a",
    "an",
    "the",
    "this",
    "that",
    "same",
    "said",
    "four",
    "4",
    "three",
    "way",
    "t",
    "stop",
    "sign",
    "signalized",
    "signal",
    "controlled",
    "of",
];

/// And of a light there: "through a green traffic light at the intersection".
const OF_LIGHT: [&str; 6] = ["green", "yellow", "red", "light", "at", "in"];

/// Words that tell how far into an intersection.
const HOW_FAR: [&str; 8] = ["halfway", "midway", "partway", "partially", "partly", "almost", "nearly", "mostly"];

/// An entry that is told with what somebody else does, or with another act of its own.
pub(super) struct Entry {
    pub(super) fact: ActFact,
    /// It came before that act: "halfway through the intersection it began to slow".
    pub(super) before: bool,
}

/// The entry that stands beside an act, where its words tell one.
pub(super) fn beside(reading: &Reading<'_>, frame: &Frame, fact: &ActFact) -> Option<Entry> {
    if matches!(fact.act, Act::Enter | Act::Cross | Act::Turn | Act::UTurn | Act::Pushed) || fact.after_contact {
        return None;
    }
    let entry = |first: usize, end: usize, before: bool, begun: bool| Entry {
        fact: ActFact {
            act: Act::Enter,
            side: None,
            begun,
            done: false,
            manner: None,
            source: reading.words(first, end),
            ..fact.clone()
        },
        before,
    };
    if let Some((first, end)) = already_inside(reading, frame) {
        return Some(entry(first, end, true, false));
    }
    let stands = fact.act.stands();
    let moves = matches!(fact.act, Act::Follow | Act::SetOff | Act::Accelerate | Act::Slow);
    let end = behind_verb(reading, frame, stands).filter(|_| stands || moves)?;
    Some(entry(frame.first, end, stands, moves && (fact.begun || stays_begun(reading, frame))))
}

/// "traveling eastbound on Oak Street through the intersection", "stopped partway into the intersection": the token behind it.
fn behind_verb(reading: &Reading<'_>, frame: &Frame, stands: bool) -> Option<usize> {
    let tokens = &reading.story.tokens;
    let mut end = reading.story.sentences[frame.sentence].end.min(frame.end + BETWEEN);
    // The next verb is of another clause.
    let next = reading.story.frames.iter().map(|other| other.first).filter(|first| *first >= frame.end).min();
    end = end.min(next.unwrap_or(end));
    let into = (frame.first + 1..end).take_while(|&at| !ENDS.contains(&word(tokens, at))).find(|&at| {
        matches!(word(tokens, at), "into" | "through" | "across")
            && (!stands || HOW_FAR.contains(&word(tokens, at - 1)))
    })?;
    intersection(reading, into + 1, frame.sentence, &OF_LIGHT)
}

/// "(halfway) through the intersection", "while in the intersection", at the head of the sentence of which this is the first verb.
fn already_inside(reading: &Reading<'_>, frame: &Frame) -> Option<(usize, usize)> {
    let tokens = &reading.story.tokens;
    let first = reading.story.sentences[frame.sentence].first;
    let own = |other: &Frame| other.sentence == frame.sentence && other.first < frame.first;
    if reading.story.frames.iter().any(own) {
        return None;
    }
    let at = (first..frame.first).find(|&at| match word(tokens, at) {
        "into" | "through" => at > first && HOW_FAR.contains(&word(tokens, at - 1)),
        "in" | "inside" | "within" => at > first && matches!(word(tokens, at - 1), "while" | "still" | "already"),
        _ => false,
    })?;
    Some((at - 1, intersection(reading, at + 1, frame.sentence, &[])?))
}

/// The token behind "the intersection", where that begins here; these words may stand before it as well.
fn intersection(reading: &Reading<'_>, from: usize, sentence: usize, more: &[&str]) -> Option<usize> {
    let end = reading.story.sentences[sentence].end;
    let light = |at: usize| {
        reading.story.word(at) == "traffic" && at + 1 < end && matches!(reading.story.word(at + 1), "light" | "signal")
    };
    let in_name = |at: usize| {
        OF_INTERSECTION.contains(&reading.story.word(at))
            || more.contains(&reading.story.word(at))
            || !more.is_empty() && light(at)
    };
    let at = (from..end).find(|&at| !in_name(at))?;
    matches!(reading.story.word(at), "intersection" | "junction").then_some(at + 1)
}

/// "was parked in-lane", "stopped in the travel lane": the token behind it.
fn in_a_lane(reading: &Reading<'_>, frame: &Frame) -> Option<usize> {
    let end = reading.story.sentences[frame.sentence].end;
    let word = |at: usize| if at < end { reading.story.tokens[at].text.as_str() } else { "" };
    if word(frame.end) != "in" {
        return None;
    }
    let article = usize::from(matches!(word(frame.end + 1), "the" | "a" | "its" | "an"));
    let kind = usize::from(matches!(word(frame.end + 1 + article), "travel" | "driving" | "traffic"));
    let lane = frame.end + 1 + article + kind;
    (word(lane) == "lane").then_some(lane + 1)
}

/// "was standing at the right edge of the lane", "stopped on the edge of the road": the token behind the edge, or the lane.
fn at_the_edge(reading: &Reading<'_>, frame: &Frame) -> Option<usize> {
    let end = reading.story.sentences[frame.sentence].end;
    let word = |at: usize| if at < end { reading.story.tokens[at].text.as_str() } else { "" };
    let from = frame.end + usize::from(matches!(word(frame.end), "close" | "over"));
    if !matches!(word(from), "at" | "on" | "along" | "by" | "near" | "to") {
        return None;
    }
    let far = usize::from(word(from + 2) == "far");
    let right = usize::from(matches!(word(from + 2 + far), "right" | "righthand"));
    let hand = usize::from(right > 0 && word(from + 3 + far) == "hand");
    let edge = from + 2 + far + right + hand;
    let article = if matches!(word(edge + 2), "the" | "its") { 3 } else { 2 };
    match word(edge) {
        "edge" if word(edge + 1) == "of" && word(edge + article) == "lane" => Some(edge + article + 1),
        "edge" => Some(edge + 1),
        _ => None,
    }
}

/// The words of an act.
pub(super) fn words(reading: &Reading<'_>, frame: &Frame, act: Act) -> Source {
    let (first, end) = match act {
        Act::OpenDoor => of_door(reading, frame),
        _ => (frame.first, reach(reading, frame, act)),
    };
    reading.words(first, end)
}

/// So many words stand between a verb and the door that it opens, at most: "opened the front passenger side door". [tokens]
const TO_DOOR: usize = 6;

/// So many words stand between a door and the verb that tells that it opened: "the door on the left side of the van opened". [tokens]
const FROM_DOOR: usize = 8;

/// So many words before "door" tell which one it is. [tokens]
const NAME_OF_DOOR: usize = 5;

/// The tokens of an opening with those of the door: "opened the rear driver side door", "the front door of the van opened".
pub(super) fn of_door(reading: &Reading<'_>, frame: &Frame) -> (usize, usize) {
    let door = |at: &usize| matches!(reading.story.word(*at), "door" | "doors");
    let other = |at: &usize| {
        matches!(reading.story.word(*at), "," | "and" | "into" | "when" | "while" | "as" | "then" | "after")
    };
    let sentence = reading.story.sentences[frame.sentence];
    let next = reading.story.frames.iter().map(|other| other.first).filter(|first| *first >= frame.end).min();
    let end = sentence.end.min(frame.end + TO_DOOR).min(next.unwrap_or(sentence.end));
    if (frame.first..frame.end).any(|at| door(&at)) {
        return (frame.first, frame.end);
    }
    if let Some(behind) = (frame.end..end).take_while(|at| !other(at)).find(door) {
        return (frame.first, behind + 1);
    }
    let mut before = (sentence.first..frame.first).rev().take(FROM_DOOR).take_while(|at| !other(at));
    let Some(named) = before.find(door) else { return (frame.first, frame.end) };
    let name = (sentence.first..named).rev().take(NAME_OF_DOOR);
    let first = name.take_while(|at| !other(at) && !is_determiner(reading.story.word(*at))).last().unwrap_or(named);
    (first, frame.end)
}

/// The token behind the words of an act: of who goes into or through an intersection, or stands in a lane, up to that word.
fn reach(reading: &Reading<'_>, frame: &Frame, act: Act) -> usize {
    if act.rests() {
        return in_a_lane(reading, frame).or_else(|| at_the_edge(reading, frame)).unwrap_or(frame.end);
    }
    if matches!(act, Act::Drift | Act::Swerve) {
        return within_its_lane(reading, frame).unwrap_or(frame.end);
    }
    let end = reading.story.sentences[frame.sentence].end;
    let from = frame.end + usize::from(frame.end < end && matches!(reading.story.word(frame.end), "into" | "through"));
    let behind = if act == Act::Enter { intersection(reading, from, frame.sentence, &OF_LIGHT) } else { None };
    behind.unwrap_or(frame.end)
}

/// So many words stand between a verb and those for the lane that is not left, at most: "shifted about two feet to the left within". [tokens]
const BEFORE_WITHIN: usize = 8;

/// The end of the words that tell that somebody went aside and did not leave its lane: "moved to the right within its lane".
fn within_its_lane(reading: &Reading<'_>, frame: &Frame) -> Option<usize> {
    let end = reading.story.sentences[frame.sentence].end;
    let words: Vec<&str> = reading.story.tokens[frame.first..end]
        .iter()
        .map(|token| token.text.as_str())
        .take(BEFORE_WITHIN + 5)
        .collect();
    let within = words.iter().position(|word| *word == "within").filter(|at| *at <= BEFORE_WITHIN)?;
    let plain = !words[..within].iter().any(|word| ENDS.contains(word) && !matches!(*word, "toward" | "towards"));
    let lane = match words[within + 1..] {
        ["its" | "the" | "their", "lane", ..] => within + 3,
        ["its" | "the" | "their", "own" | "travel", "lane", ..] => within + 4,
        _ => return None,
    };
    plain.then_some(frame.first + lane)
}

/// "began to proceed through the intersection", and not "and came to a stop" there.
fn stays_begun(reading: &Reading<'_>, frame: &Frame) -> bool {
    let who = reading.doer(frame);
    let goes_on = |later: &Frame| {
        later.sentence == frame.sentence
            && later.first > frame.first
            && reading.doer(later) == who
            && later.happened()
            && later.act().is_some_and(Act::slows)
    };
    begins(reading, frame) && !reading.story.frames.iter().any(goes_on)
}
