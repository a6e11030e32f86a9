//! Who hides somebody: behind whom, or from between whom, who is told of came out.

use super::Reading;
use super::ahead::is_told_of_subject;
use crate::frame::Frame;
use crate::token::{Token, word};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Kind};

/// Whether somebody stood in the line of sight to another one: the words of its first mention say so, or those that one came out from behind it.
pub(super) fn hides(reading: &Reading<'_>, actor: Actor, (first, end): (usize, usize)) -> bool {
    if !reading.story.world.actors[actor].kind.is_some_and(Kind::is_vehicle) {
        return false;
    }
    // "The AV pulled out from behind a van": it hides nobody from the subject vehicle.
    let named = is_come_out_of(reading, first) && !is_told_of_subject(reading, first);
    named || is_hidden_by(reading, first) || bars_view(reading, end) || is_left(reading, actor)
}

/// Words between "from behind" and a noun.
const SMALL: [&str; 13] =
    ["a", "an", "the", "two", "three", "of", "some", "several", "other", "another", "one", "its", "row"];

/// "came out from behind a van", "from between two of the waiting cars", "appeared from the left behind a bus".
fn is_come_out_of(reading: &Reading<'_>, first: usize) -> bool {
    let tokens = &reading.story.tokens;
    let behind = (first.saturating_sub(SMALL_WITHIN)..first.saturating_sub(1)).rev().find_map(|at| {
        let side = word(tokens, at + 1) == "the" && at + 3 < first && matches!(word(tokens, at + 2), "left" | "right");
        let next = at + if side { 3 } else { 1 };
        (word(tokens, at) == "from" && matches!(word(tokens, next), "behind" | "between")).then_some(next + 1)
    });
    let small = |token: &Token| SMALL.contains(&token.text.as_str());
    behind.is_some_and(|at| tokens[at..first].iter().all(small))
}

/// So many words back from a noun "from" may stand. [tokens]
const SMALL_WITHIN: usize = 7;

/// "hidden by a parked van", "obscured behind the bus", "its view was blocked by a van"; not "its lane was blocked by a van".
fn is_hidden_by(reading: &Reading<'_>, first: usize) -> bool {
    let tokens = &reading.story.tokens;
    let before = &tokens[first.saturating_sub(HIDDEN_WITHIN)..first];
    let words: Vec<&str> = before.iter().map(|token| token.text.as_str()).collect();
    let view = tokens[first.saturating_sub(VIEW_WITHIN)..first].iter().any(|token| is_view(&token.text));
    let hidden = |word: &str| match word {
        "hidden" | "obscured" | "occluded" | "concealed" | "screened" => true,
        word => matches!(word, "obstructed" | "blocked") && view,
    };
    let at = words.windows(2).position(|pair| hidden(pair[0]) && matches!(pair[1], "by" | "behind"));
    at.is_some_and(|at| words[at + 2..].iter().all(|word| SMALL.contains(word)))
}

/// So many words back from a noun "hidden" may stand. [tokens]
const HIDDEN_WITHIN: usize = 5;

/// "a truck in the next lane limited the view", "a bus blocking its view of the crosswalk": told in the clause that it begins.
fn bars_view(reading: &Reading<'_>, end: usize) -> bool {
    let tokens = &reading.story.tokens;
    let clause: Vec<&str> = tokens[end..].iter().map(|token| token.text.as_str()).take(VIEW_WITHIN).collect();
    let stop = clause.iter().position(|word| matches!(*word, "." | ";")).unwrap_or(clause.len());
    let bars =
        |word: &str| ["block", "obstruct", "limit", "obscur", "restrict"].iter().any(|stem| word.starts_with(stem));
    let view = |words: &[&str]| words.iter().take(VIEW_BEHIND).any(|word| is_view(word));
    (0..stop).any(|at| bars(clause[at]) && view(&clause[at + 1..stop]))
}

fn is_view(word: &str) -> bool {
    matches!(word, "view" | "sight" | "visibility")
}

/// Such words stand so near behind a noun, and the view so near behind them. [tokens]
const VIEW_WITHIN: usize = 16;
const VIEW_BEHIND: usize = 5;

/// "A van came from behind the truck", of a truck that is named before.
fn is_left(reading: &Reading<'_>, actor: Actor) -> bool {
    let comes = |frame: &Frame| {
        matches!(frame.act(), Some(Act::Enter | Act::Cross | Act::PullOut | Act::Follow)) && frame.who != Some(SUBJECT)
    };
    let words = |frame: &Frame| {
        let run = &reading.story.tokens[frame.first..(frame.end + 2).min(reading.story.tokens.len())];
        run.windows(2).any(|pair| pair[0].text == "from" && matches!(pair[1].text.as_str(), "behind" | "between"))
    };
    let frames = reading.story.frames.iter().enumerate().filter(|(number, _)| !reading.is_after(*number));
    let mut frames = frames.map(|(_, frame)| frame);
    frames.any(|frame| frame.object == Some(actor) && comes(frame) && frame.happened() && words(frame))
}
