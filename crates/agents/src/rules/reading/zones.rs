//! Where each was touched: the columns, put right by the narrative's words.

use super::super::actors::Actor;
use super::{MEETING, Sentence};
use recrash_model::zones::ContactZone;
use regex::{Captures, Regex};
use std::sync::LazyLock;

/// An end, a side, or both, in either order. The driver sits on the left.
const PLACE: &str = r"(?:(?P<end>front|rear|back)[- ]?)?(?:(?P<side>left|right|driver(?:'s|s)?|passenger(?:'s|s)?)(?:[- ]hand)?[- ]?)?(?:(?P<late>front|rear|back)[- ]?)?";
/// What may be touched there; several words, as in `rear driver side door`.
const PART: &str = r"(?P<part>(?:(?:sides?|corner|bumper|fender|doors?|mirror|panel|wheel|tire|head ?light|tail ?light|hatch|trunk|hood|window|end|portion|quarter|pod|sensor|area|fascia|radar|assembly|part|body)\b ?)*)";

fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("constant pattern")
}

/// `the front passenger side of the ...`, `the rear of the ...`: whose it is follows.
static PART_OF: LazyLock<Regex> = LazyLock::new(|| pattern(&format!(r"(?i)\b(?:the|its) {PLACE}{PART}(?:of|on) ?")));
/// `...'s rear bumper`: whose it is stands before.
static PART_AFTER: LazyLock<Regex> = LazyLock::new(|| pattern(&format!(r"(?i)^(?:'s|s'|\u{{2019}}s|s) {PLACE}{PART}")));
/// `striking the left rear fender`: it is the other's.
static PART_HIT: LazyLock<Regex> = LazyLock::new(|| {
    pattern(&format!(
        r"(?i)\b(?:struck|striking|hit|hitting|contacted|contacting|clipped|scraped) the {PLACE}{PART}(?P<owner>of\b)?"
    ))
});

/// The zones of an actor: those the narrative names, else `column`.
pub(super) fn zones(sentences: &[Sentence], actor: Actor, column: &[ContactZone]) -> Vec<ContactZone> {
    let told = told(sentences, actor);
    if told.is_empty() || told.iter().all(|place| place.vague && fits(column, place.zone)) {
        return column.to_vec();
    }
    let mut zones: Vec<ContactZone> = told.iter().map(|place| place.zone).collect();
    zones.sort_unstable();
    zones.dedup();
    zones
}

/// A place that was told.
struct Place {
    zone: ContactZone,
    /// Part of something that goes around a corner, as a bumper does.
    vague: bool,
}

/// Whether the column says as much as a vague place does.
fn fits(column: &[ContactZone], told: ContactZone) -> bool {
    column.iter().any(|zone| zone.steps_apart(told).is_some_and(|steps| steps <= 1))
}

/// The zones told of an actor in the first sentence of a meeting that tells any. What two others did to each other is
/// none of theirs.
fn told(sentences: &[Sentence], actor: Actor) -> Vec<Place> {
    let mut places: Vec<Place> = Vec::new();
    let other = if actor == Actor::Sv { Actor::Cp } else { Actor::Sv };
    let meets = |sentence: &&Sentence| sentence.mentions.includes(Actor::Sv) && MEETING.is_match(sentence.text);
    for sentence in sentences.iter().filter(meets) {
        for found in PART_OF.captures_iter(sentence.text) {
            let end = found.get_match().end();
            if sentence.mentions.object_after(end) == Some(actor) {
                places.extend(place(&found));
            }
        }
        for at in sentence.mentions.ends(actor) {
            places.extend(PART_AFTER.captures(&sentence.text[at..]).as_ref().and_then(place));
        }
        for found in PART_HIT.captures_iter(sentence.text).filter(|found| found.name("owner").is_none()) {
            let start = found.get_match().start();
            if sentence.mentions.subject_at(start) == Some(other) {
                places.extend(place(&found));
            }
        }
        if !places.is_empty() {
            break;
        }
    }
    places
}

fn place(found: &Captures) -> Option<Place> {
    use ContactZone::{Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};
    let word = |group: &str| found.name(group).map(|text| text.as_str().to_ascii_lowercase());
    let part = word("part").unwrap_or_default();
    let is = |names: &[&str]| names.iter().any(|name| part.contains(name));
    let front = word("end").or_else(|| word("late")).map(|end| end == "front");
    let left = word("side").map(|side| side.starts_with("left") || side.starts_with("driver"));
    let side = |left: bool| if left { Left } else { Right };
    let zone = match (front, left) {
        // Which corner is not told.
        (Some(_), None) if is(&["corner"]) => return None,
        (Some(true), None) => Front,
        (Some(false), None) => Rear,
        // A door is in the side, whichever it is.
        (_, Some(left)) if is(&["door"]) => side(left),
        (Some(true), Some(left)) => {
            if left {
                FrontLeft
            } else {
                FrontRight
            }
        }
        (Some(false), Some(left)) => {
            if left {
                RearLeft
            } else {
                RearRight
            }
        }
        // "To the left of" is no part of anybody.
        (None, _) if part.is_empty() => return None,
        (None, Some(left)) => side(left),
        (None, None) => return None,
    };
    let cornered = front.is_some() && left.is_some();
    Some(Place {
        zone,
        vague: !cornered && is(&["bumper", "fascia", "fender", "mirror", "wheel", "tire", "sensor", "pod"]),
    })
}
