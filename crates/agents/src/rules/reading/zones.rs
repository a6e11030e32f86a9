//! Where each was touched, in the narrative's words.

use super::super::actors::Actor;
use super::{MEETING, Sentence};
use recrash_model::record::ContactZone;
use regex::Regex;
use std::sync::LazyLock;

/// A part of a vehicle: end, side, and what makes it a part. The driver sits on the left.
const PART: &str = r"(?:(?P<end>front|rear|back)[- ]?)?(?:(?P<side>left|right|driver'?s?|passenger'?s?)(?:[- ]hand)?[- ]?)?(?:(?P<late>front|rear|back)[- ]?)?(?:side|corner|bumper|fender|door|mirror|quarter panel|panel|wheel|tire|headlight|taillight|tail light|hatch|trunk|hood|window|end|portion|wheel well|sensor pod|sensor|of)?";

/// `the front passenger side of the ...`: whose it is follows.
static PART_OF: LazyLock<Regex> = LazyLock::new(|| {
    Regex::new(&format!(r"(?i)\bthe {PART}(?: (?:side|corner|bumper|fender|door|end|panel|mirror|portion|window|wheel))* ?(?:of|on) ?"))
        .expect("constant pattern")
});
/// `...'s rear bumper`, `its left side`: whose it is stands before.
static PART_AFTER: LazyLock<Regex> = LazyLock::new(|| {
    Regex::new(&format!(r"(?i)^(?:'s|s'|’s)? ?{PART}(?: (?:side|corner|bumper|fender|door|end|panel|mirror|window|wheel))*\b"))
        .expect("constant pattern")
});

/// The zones told of an actor in the sentence where the two meet; empty where none is told.
pub(super) fn told(sentences: &[Sentence], actor: Actor) -> Vec<ContactZone> {
    let mut zones = Vec::new();
    for sentence in sentences {
        if !MEETING.is_match(sentence.text) {
            continue;
        }
        for found in PART_OF.captures_iter(sentence.text) {
            let end = found.get(0).expect("group 0").end();
            if sentence.mentions.object_after(end) == Some(actor) {
                zones.extend(zone(&found));
            }
        }
        for at in sentence.mentions.ends(actor) {
            let rest = &sentence.text[at..];
            if rest.starts_with("'s ") || rest.starts_with("’s ") {
                zones.extend(PART_AFTER.captures(rest).as_ref().and_then(zone));
            }
        }
        if !zones.is_empty() {
            break;
        }
    }
    zones.sort_unstable();
    zones.dedup();
    zones
}

fn zone(found: &regex::Captures) -> Option<ContactZone> {
    use ContactZone::{Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};
    let word = |group: &str| found.name(group).map(|text| text.as_str().to_ascii_lowercase());
    let front = word("end").or_else(|| word("late")).map(|end| end == "front");
    let left = word("side").map(|side| side.starts_with("left") || side.starts_with("driver"));
    Some(match (front, left) {
        (Some(true), None) => Front,
        (Some(true), Some(true)) => FrontLeft,
        (Some(true), Some(false)) => FrontRight,
        (Some(false), None) => Rear,
        (Some(false), Some(true)) => RearLeft,
        (Some(false), Some(false)) => RearRight,
        (None, Some(true)) => Left,
        (None, Some(false)) => Right,
        (None, None) => return None,
    })
}
