//! Where each was touched: the columns, put right by the narrative's words.

use super::super::actors::Actor;
use super::{MEETING, Sentence};
use recrash_model::record::ContactZone;
use regex::{Captures, Regex};
use std::sync::LazyLock;

/// An end, a side, or both, in either order. The driver sits on the left.
const PLACE: &str = r"(?:(?P<end>front|rear|back)[- ]?)?(?:(?P<side>left|right|driver(?:'s|s)?|passenger(?:'s|s)?)(?:[- ]hand)?[- ]?)?(?:(?P<late>front|rear|back)[- ]?)?";
/// What may be touched there.
const PART: &str = r"(?P<part>sides?|corner|bumper|fender|doors?|(?:side )?mirror|(?:quarter )?panel|wheel|tire|head ?light|tail ?light|hatch|trunk|hood|window|end|portion|quarter|sensor pod|sensor|area|fascia)";

fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("constant pattern")
}

/// `the front passenger side of the ...`, `the rear of the ...`: whose it is follows.
static PART_OF: LazyLock<Regex> =
    LazyLock::new(|| pattern(&format!(r"(?i)\b(?:the|its) {PLACE}(?:{PART} ?)*(?:of|on|to|behind) ?")));
/// `...'s rear bumper`: whose it is stands before.
static PART_AFTER: LazyLock<Regex> =
    LazyLock::new(|| pattern(&format!(r"(?i)^(?:'s|s'|\u{{2019}}s|s) {PLACE}{PART}?")));

/// The zones of an actor: those the narrative names, else `column`.
pub(super) fn zones(sentences: &[Sentence], actor: Actor, column: &[ContactZone]) -> Vec<ContactZone> {
    let told = told(sentences, actor);
    if told.is_empty() { column.to_vec() } else { told }
}

/// The zones told of an actor in the first sentence of a meeting that tells any. What two others did to each other is
/// none of theirs.
fn told(sentences: &[Sentence], actor: Actor) -> Vec<ContactZone> {
    let mut zones = Vec::new();
    let meets = |sentence: &&Sentence| sentence.mentions.includes(Actor::Sv) && MEETING.is_match(sentence.text);
    for sentence in sentences.iter().filter(meets) {
        for found in PART_OF.captures_iter(sentence.text) {
            let end = found.get(0).expect("group 0").end();
            if sentence.mentions.object_after(end) == Some(actor) {
                zones.extend(zone(&found));
            }
        }
        for at in sentence.mentions.ends(actor) {
            zones.extend(PART_AFTER.captures(&sentence.text[at..]).as_ref().and_then(zone));
        }
        if !zones.is_empty() {
            break;
        }
    }
    zones.sort_unstable();
    zones.dedup();
    zones
}

fn zone(found: &Captures) -> Option<ContactZone> {
    use ContactZone::{Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};
    let word = |group: &str| found.name(group).map(|text| text.as_str().to_ascii_lowercase());
    let part = word("part").unwrap_or_default();
    let front = word("end").or_else(|| word("late")).map(|end| end == "front");
    let left = word("side").map(|side| side.starts_with("left") || side.starts_with("driver"));
    Some(match (front, left) {
        // Which corner is not told.
        (Some(_), None) if part == "corner" => return None,
        (Some(true), None) => Front,
        (Some(false), None) => Rear,
        // A door is in the side, whichever it is.
        (_, Some(left)) if part.starts_with("door") => {
            if left {
                Left
            } else {
                Right
            }
        }
        (Some(true), Some(true)) => FrontLeft,
        (Some(true), Some(false)) => FrontRight,
        (Some(false), Some(true)) => RearLeft,
        (Some(false), Some(false)) => RearRight,
        // "To the left of" is no part of anybody, and of a fender the end is not told.
        (None, _) if part.is_empty() || ["fender", "wheel", "tire"].contains(&part.as_str()) => return None,
        (None, Some(true)) => Left,
        (None, Some(false)) => Right,
        (None, None) => return None,
    })
}
