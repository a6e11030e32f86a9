//! From where the partner came, seen from the ego before any turn.

use super::super::actors::Actor;
use super::super::pattern::Pattern;
use super::{MEETING, Relation, Sentence, details, only, words};
use recrash_model::narrative::{FactSource, LanePosition, Side};
use recrash_model::record::CrashRecord;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use regex::Regex;

static FROM: Pattern = Pattern::new(
    r"(?i)\b(?:(?:approach\w*|com(?:e|ing)|came|enter\w*|proceed\w*|travel\w*|driv\w+|emerg\w+|mov(?:ed|ing))(?: \w+){0,6}? )?from (?:the|its|their)(?: [\w']+ ?\w*'s?)? (?P<side>left|right)(?:[- ]hand)?(?: side| cross street)?\b",
);
/// What makes `from the left` a lane's place: `second lane from the left`, `from the left lane`.
static LANE_BEFORE: Pattern = Pattern::new(
    r"(?i)\b(?:second|third|fourth|2nd|3rd|4th|lanes?|one|two|three|\d)(?: (?:lane|most))? from the (?:left|right)",
);
static LANE_AFTER: Pattern = Pattern::new(r"(?i)^(?:[- ](?:hand|most))?(?: \w+){0,2} (?:lanes?|turn)\b");
static BESIDE_SIDED: Pattern = Pattern::new(
    r"(?i)\b(?P<a>left|right)(?:[- ]hand)?[ -]adjacent\b|\badjacent (?:\w+ )?lanes?,? (?:directly |immediately )?(?:to|on) (?:the|its) (?:\w+ \w*'s )?(?P<b>left|right)\b|\badjacent (?P<c>left|right)\b|\blanes? (?:\w+ ){0,2}(?:to|on) (?:the|its) (?P<d>left|right)\b|\b(?:to|on) the (?P<e>left|right)(?:[- ]hand)?(?: side)? of the\b|\b(?:to|on) its (?P<f>left|right)\b|\b(?:pass\w*|overt\w+)\b[^.]{0,40}?\bon (?:the|its) (?P<g>left|right)\b|\bfrom the (?P<h>left|right)(?:most)?(?:[- ]hand)? (?:\w+ )?lane\b|\b(?:pass\w*|overt\w+) to the (?P<i>left|right)\b",
);
static BESIDE: Pattern = Pattern::new(
    r"(?i)\badjacent (?:\w+ )?lanes?\b|\badjacent to\b|\bparallel\b|\b(?:next|neighbou?ring) lane\b|\bnext to\b|\balongside\b|\bside[- ]by[- ]side\b|\bside-?swip\w+|\bchang(?:ed|ing) lanes\b|\blane change\b|\bmerg(?:ed|ing)\b|\bcut(?:ting)? (?:in|off)\b|\bdrift\w*|\bencroach\w*|\binto (?:the )?[^.]{1,30}'s? lane\b",
);
static ONCOMING: Pattern = Pattern::new(
    r"(?i)\b(?:came|coming|come|traveling) the other way\b|^oncoming,|\boncoming (?:\w+ )?(?:vehicle|car|suv|van|truck|pickup|sedan|motorcycl\w+|bus|cyclist|driver|lane)\b|\b(?:from|in|on) the (?:opposite|oncoming|opposing)(?: (?:direction|side|lane|approach|road))?|\bopposite (?:side|direction)\b|\bopposing (?:direction|vehicle|lane|car)\b|\btowards? the (?:ego|av|waymo|zoox|cruise)\b|\bfrom the front\b|\bwrong side of the (?:street|road)\b|\bagainst (?:the flow of )?traffic\b",
);
static BEHIND: Pattern = Pattern::new(
    r"(?i)\b(?:from|directly|closely|immediately|travell?ing|following|stopped|driving|waiting|queued|was|vehicle|car|suv|truck|van|bus|right) behind\b|\bfollowing (?:closely |directly )?(?:the|behind)\b|\btrailing\b|\bfrom the rear\b|\brear[- ]?end(?:ed|ing)?\b",
);
static CROSSING: Pattern = Pattern::new(
    r"(?i)\bcross(?:ing)? (?:traffic|street|road)\b|\bperpendicular\b|\b(?:against|ran|running|through|disregard\w*|violat\w+) (?:a|the|its|their) (?:\w+ )?(?:red|stop)\b|\b(?:entered|entering|into|through|past)\b[^.]{0,60}? without (?:first )?stopping\b|\b(?:failed to|did not) (?:first )?stop (?:at|for)\b",
);
/// Out of a driveway or a parking place: across the ego's way.
static FROM_PROPERTY: Pattern = Pattern::new(
    r"(?i)\b(?:exit\w*|leav\w+|out|pull\w*|revers\w+|emerg\w+|enter\w*)(?: \w+){0,4}? (?:of|from|the|a|an|its) (?:\w+ ){0,3}?(?:driveway|parking (?:lot|stall|space|spot|garage)|alley(?:way)?|gas station)\b",
);
/// The side of the street the partner came from, as a compass point.
static STREET_SIDE: Pattern = Pattern::new(
    r"(?i)\b(?:from|on|off|at|in a [\w ]{3,30}? on) the (?P<side>north|south|east|west)(?:ern)?(?: \w+)? (?:side|curb|corner|sidewalk)\b",
);
static CROSSES: Pattern = Pattern::new(
    r"(?i)\b(?:cross(?:ed|ing|es)?|step\w*|walk\w*|ran|darted|emerg\w+|entered|entering|pull\w* (?:out|away))\b",
);
/// The side of the street the partner came from, as a hand.
static STREET_HAND: Pattern = Pattern::new(
    r"(?i)\bfrom (?:the|its|an?) (?:adjacent )?(?P<a>left|right)(?:[- ]hand)? (?:curb|sidewalk|shoulder|side of)\b|\b(?:driveway|alley(?:way)?|side street|parking (?:lot|space|stall|spot)) (?:on|to) (?:the|its) (?P<b>left|right)\b",
);
/// The ego about the partner: it is beside it.
static BESIDE_IT: Pattern =
    Pattern::new(r"(?i)\b(?:adjacent to|next to|alongside|passing|passed|overtaking|to pass|past) ?$");
/// The ego about the partner: it is behind it.
static AFTER_IT: Pattern = Pattern::new(
    r"(?i)\b(?:stopped|travell?ing|waiting|driving|following|slowed|slowing|queued|directly)?(?: in traffic| directly)? (?:behind|following) ?$",
);
/// The partner about the ego: it is ahead of it.
static AHEAD: Pattern = Pattern::new(
    r"(?i)\b(?:directly |immediately )?(?:in front of|ahead of)\b|\b(?:vehicle|car|truck|suv|van|motorcycle) (?:directly )?ahead\b",
);
static UNPROTECTED: Pattern =
    Pattern::new(r"(?i)\bunprotected left\b|\byield\w* (?:to|for) oncoming\b|\boncoming traffic\b");
static COMPASS: Pattern =
    Pattern::new(r"(?i)\b(?:(?P<a>north|south)[- ]?)?(?P<b>north|south|east|west)(?P<bound>[- ]?bound)?(?:ly)?\b");
static COMPASS_GOAL: Pattern =
    Pattern::new(r"(?i)\b(?:onto|on to|toward|towards|to|into|for)(?: the| go| head| proceed| travel| continue)*\s*$");
static COMPASS_VERB: Pattern = Pattern::new(
    r"(?i)\b(?:travel\w*|head\w*|driv\w+|proceed\w*|going|coming|moving|facing|straight|oriented|continu\w+|approach\w*)(?: (?:in an?|in the|due|straight))?\s*$",
);

static COMPASS_LEAVES: Pattern = Pattern::new(r"(?i)\b(?:proceeded|continued|fled|left|departed|drove|drove off)\s*$");

/// The relation the narrative states, with the words. A side that is told outright comes before compass directions, a
/// crossing or opposite compass direction before words on lanes, and words on lanes before `from behind`, because the
/// weaker phrases are often about third parties.
pub(super) fn relation(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    let compass = by_compass(record, sentences);
    let told = from_side(record, sentences)
        .or_else(|| from_street_side(record, sentences))
        .or_else(|| compass.clone().filter(|(relation, _)| !matches!(relation, Relation::Beside(_) | Relation::Behind)))
        .or_else(|| beside_sided(record, sentences))
        .or_else(|| by_lane_numbers(record, sentences))
        .or_else(|| by_phrase(record, sentences, &ONCOMING, Relation::Oncoming))
        .or_else(|| by_phrase(record, sentences, &BEHIND, Relation::Behind))
        .or_else(|| by_phrase(record, sentences, &BESIDE, Relation::Beside(None)))
        .or_else(|| by_phrase(record, sentences, &FROM_PROPERTY, Relation::Crossing))
        .or_else(|| by_phrase(record, sentences, &CROSSING, Relation::Crossing))
        .or_else(|| by_told_lanes(record, sentences))
        .or_else(|| by_unprotected_turn(record, sentences))
        .or_else(|| by_object(record, sentences, &BESIDE_IT, Relation::Beside(None)))
        .or_else(|| by_object(record, sentences, &AFTER_IT, Relation::Behind))
        .or_else(|| ahead_of_ego(record, sentences))
        .or(compass);
    told.map(|(relation, source)| match relation {
        Relation::Beside(None) => {
            (Relation::Beside(side_from_zones(record).or_else(|| side_from_lanes(sentences))), source)
        }
        Relation::Crossing => match side_from_zones(record) {
            Some(side) => (Relation::From(side), source),
            None => (Relation::Crossing, source),
        },
        // Who came from behind and touched the side had come up beside it.
        Relation::Behind if !record.sv_zones.is_empty() && !record.sv_zones.iter().any(|zone| zone.is_rear()) => {
            match side_from_zones(record) {
                Some(side) if !record.sv_zones.contains(&ContactZone::Front) => (Relation::Beside(Some(side)), source),
                _ => (Relation::Behind, source),
            }
        }
        told => (told, source),
    })
}

/// On which side of the ego the partner was: the side of the ego that was touched; where it was its front, the side of
/// the partner tells (a partner from the left shows its right side).
pub fn side_from_zones(record: &CrashRecord) -> Option<Side> {
    use ContactZone::{FrontLeft, FrontRight, Left, RearLeft, RearRight, Right};
    let count = |zones: &[ContactZone], of: [ContactZone; 3]| zones.iter().filter(|z| of.contains(z)).count();
    let lefts = |zones: &[ContactZone]| count(zones, [FrontLeft, Left, RearLeft]);
    let rights = |zones: &[ContactZone]| count(zones, [FrontRight, Right, RearRight]);
    let (sv_left, sv_right) = (lefts(&record.sv_zones), rights(&record.sv_zones));
    let (cp_left, cp_right) = (lefts(&record.cp_zones), rights(&record.cp_zones));
    match sv_left.cmp(&sv_right).then(cp_right.cmp(&cp_left)) {
        std::cmp::Ordering::Greater => Some(Side::Left),
        std::cmp::Ordering::Less => Some(Side::Right),
        std::cmp::Ordering::Equal => None,
    }
}

/// A partner that turns off, told in another lane than the ego: it drove beside it.
fn by_told_lanes(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    let (left, right, _) = super::told_turns(sentences, Actor::Cp);
    let turns = left || right || record.cp_movement.known().is_some_and(|movement| movement != Movement::Straight);
    let side = side_from_lanes(sentences).filter(|_| turns)?;
    let (_, text) = details::told_lanes(sentences).1?;
    Some((Relation::Beside(Some(side)), words(record, text)))
}

/// The side from the lanes told of both.
fn side_from_lanes(sentences: &[Sentence]) -> Option<Side> {
    let (sv, cp) = details::told_lanes(sentences);
    let place = |lane| match lane {
        LanePosition::Leftmost => 0,
        LanePosition::Middle => 1,
        LanePosition::Rightmost => 2,
    };
    match place(cp?.0).cmp(&place(sv?.0)) {
        std::cmp::Ordering::Less => Some(Side::Left),
        std::cmp::Ordering::Greater => Some(Side::Right),
        std::cmp::Ordering::Equal => None,
    }
}

fn side(text: &str) -> Side {
    if text.eq_ignore_ascii_case("left") { Side::Left } else { Side::Right }
}

fn other(side: Side) -> Side {
    match side {
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    }
}

fn from_side(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    sentences.iter().find_map(|sentence| {
        FROM.captures_iter(sentence.text).find_map(|found| {
            let whole = found.get_match();
            let named = found.name("side")?;
            let lane = LANE_BEFORE.find_iter(sentence.text).any(|lane| lane.end() == named.end())
                || LANE_AFTER.is_match(&sentence.text[named.end()..]);
            let from = sentence.text[..named.start()].rfind("from").unwrap_or(whole.start());
            let about = sentence.mentions.subject_at(from);
            (!lane && about == Some(Actor::Cp))
                .then(|| (Relation::From(side(named.as_str())), words(record, whole.as_str().trim())))
        })
    })
}

fn beside_sided(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    sentences.iter().find_map(|sentence| {
        BESIDE_SIDED.captures_iter(sentence.text).find_map(|found| {
            let whole = found.get_match();
            if LANE_BEFORE.find_iter(sentence.text).any(|lane| lane.start() < whole.end() && whole.start() < lane.end())
            {
                return None;
            }
            let named = ["a", "b", "c", "d", "e", "f", "g", "h", "i"].iter().find_map(|group| found.name(group))?;
            let told = side(named.as_str());
            let told = match (sentence.mentions.subject_at(whole.start())?, found.name("e").is_some()) {
                (Actor::Cp, true) => {
                    (sentence.mentions.object_after(whole.end()) == Some(Actor::Sv)).then_some(told)?
                }
                (Actor::Sv, true) => {
                    (sentence.mentions.object_after(whole.end()) == Some(Actor::Cp)).then_some(other(told))?
                }
                (Actor::Cp, false) => told,
                (Actor::Sv, false) if found.name("a").is_some() && sentence.mentions.includes(Actor::Cp) => told,
                _ => return None,
            };
            Some((Relation::Beside(Some(told)), words(record, whole.as_str())))
        })
    })
}

static LANE_NUMBER: Pattern =
    Pattern::new(r"(?i)\blane (?:# ?|number |no\. ?)?(?P<n>[1-6])\b|\b(?:number|#) ?(?P<m>[1-6]) lane\b");

/// Lanes by number, counted from the left as on American roads.
fn by_lane_numbers(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    let mut lanes: [Option<(u32, &str)>; 2] = [None, None];
    for sentence in sentences {
        for found in LANE_NUMBER.captures_iter(sentence.text) {
            let whole = found.get_match();
            let number = found.name("n").or_else(|| found.name("m")).and_then(|m| m.as_str().parse().ok());
            let who = match sentence.mentions.subject_at(whole.start()) {
                Some(Actor::Sv) => 0,
                Some(Actor::Cp) => 1,
                _ => continue,
            };
            if let (Some(number), None) = (number, lanes[who]) {
                lanes[who] = Some((number, whole.as_str()));
            }
        }
    }
    let ((sv, _), (cp, text)) = (lanes[0]?, lanes[1]?);
    match cp.cmp(&sv) {
        std::cmp::Ordering::Less => Some((Relation::Beside(Some(Side::Left)), words(record, text))),
        std::cmp::Ordering::Greater => Some((Relation::Beside(Some(Side::Right)), words(record, text))),
        std::cmp::Ordering::Equal => None,
    }
}

fn by_phrase(
    record: &CrashRecord,
    sentences: &[Sentence],
    phrase: &Regex,
    relation: Relation,
) -> Option<(Relation, FactSource)> {
    sentences.iter().find_map(|sentence| {
        phrase.find_iter(sentence.text).find_map(|found| {
            let inside = sentence.mentions.subject_at(found.end());
            let about = sentence.mentions.subject_at(found.start());
            let by_partner = about == Some(Actor::Cp) || (about.is_none() && inside == Some(Actor::Cp));
            let partner_named =
                relation == Relation::Oncoming && inside == Some(Actor::Cp) && sentence.mentions.includes(Actor::Cp);
            (by_partner || partner_named).then(|| (relation, words(record, found.as_str())))
        })
    })
}

/// What the ego's sentence says of the partner it names next: `passing the cyclist`.
fn by_object(
    record: &CrashRecord,
    sentences: &[Sentence],
    phrase: &Regex,
    relation: Relation,
) -> Option<(Relation, FactSource)> {
    sentences.iter().find_map(|sentence| {
        sentence.mentions.starts(Actor::Cp).find_map(|at| {
            let before = sentence.text[..at].trim_end_matches(|c: char| c.is_whitespace());
            let before =
                ["the", "a", "an", "another"].iter().find_map(|word| before.strip_suffix(word)).unwrap_or(before);
            let found = phrase.find(before)?;
            (sentence.mentions.subject_at(found.start()) == Some(Actor::Sv))
                .then(|| (relation, words(record, found.as_str().trim())))
        })
    })
}

/// A partner that is told ahead of the ego.
fn ahead_of_ego(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    sentences.iter().find_map(|sentence| {
        AHEAD.find_iter(sentence.text).find_map(|found| {
            let by_partner = sentence.mentions.subject_at(found.start()) == Some(Actor::Cp);
            let of_ego = sentence.mentions.object_after(found.end()).is_none_or(|actor| actor == Actor::Sv);
            (by_partner && of_ego).then(|| (Relation::Behind, words(record, found.as_str())))
        })
    })
}

/// The side of the street from which the partner came, by hand or by compass and the ego's heading.
fn from_street_side(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    let by_hand = sentences.iter().find_map(|sentence| {
        let found = STREET_HAND.captures(sentence.text)?;
        let hand = found.name("a").or_else(|| found.name("b"))?;
        let whole = found.get_match();
        (sentence.mentions.subject_at(whole.start()) == Some(Actor::Cp))
            .then(|| (Relation::From(side(hand.as_str())), words(record, whole.as_str())))
    });
    by_hand.or_else(|| {
        let sv = headings(sentences)[0]?;
        sentences
            .iter()
            .filter(|sentence| FROM_PROPERTY.is_match(sentence.text) || CROSSES.is_match(sentence.text))
            .find_map(|sentence| {
                let found = STREET_SIDE.captures(sentence.text)?;
                let whole = found.get_match();
                if sentence.mentions.subject_at(whole.start()) != Some(Actor::Cp) {
                    return None;
                }
                // Heading north, the east side is on the right.
                let relation = match (8 + eighths(None, &found["side"])? - sv.eighths) % 8 {
                    1..=3 => Relation::From(Side::Right),
                    5..=7 => Relation::From(Side::Left),
                    _ => return None,
                };
                Some((relation, words(record, whole.as_str())))
            })
    })
}

/// An unprotected left turn is one across oncoming traffic: where one of the two makes it and nothing else is said, the
/// other came towards it.
fn by_unprotected_turn(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    use recrash_model::template::Movement::{LeftTurn, Straight};
    let one_turns_left = matches!(
        (record.sv_movement.known(), record.cp_movement.known()),
        (Some(Straight), Some(LeftTurn)) | (Some(LeftTurn), Some(Straight))
    );
    let found = sentences.iter().find_map(|sentence| UNPROTECTED.find(sentence.text))?;
    one_turns_left.then(|| (Relation::Oncoming, words(record, found.as_str())))
}

/// A compass direction and where it stands.
#[derive(Clone, Copy)]
struct Heading<'a> {
    /// Clockwise from north. [eighths of a turn]
    eighths: u8,
    sentence: usize,
    start: usize,
    end: usize,
    text: &'a str,
}

/// The first heading told of the ego, and of the partner.
fn headings<'a>(sentences: &[Sentence<'a>]) -> [Option<Heading<'a>>; 2] {
    let mut headings: [Option<Heading>; 2] = [None, None];
    let mut met = false;
    for (number, sentence) in sentences.iter().enumerate() {
        let meeting = MEETING.find(sentence.text).map(|found| found.end());
        for found in COMPASS.captures_iter(sentence.text) {
            let whole = found.get_match();
            let before = &sentence.text[..whole.start()];
            let travels = found.name("bound").is_some() || COMPASS_VERB.is_match(before);
            let afterwards = met || meeting.is_some_and(|meeting| meeting <= whole.start());
            if !travels || COMPASS_GOAL.is_match(before) || (afterwards && COMPASS_LEAVES.is_match(before)) {
                continue;
            }
            let who = match sentence.mentions.subject_at(whole.start()) {
                Some(Actor::Sv) => 0,
                Some(Actor::Cp) => 1,
                _ => continue,
            };
            if let (None, Some(second)) = (headings[who], found.name("b")) {
                let (first, second) = (found.name("a").map(|m| m.as_str()), second.as_str());
                headings[who] = eighths(first, second).map(|eighths| Heading {
                    eighths,
                    sentence: number,
                    start: whole.start(),
                    end: whole.end(),
                    text: whole.as_str(),
                });
            }
        }
        met |= meeting.is_some();
    }
    headings
}

/// The relation from the compass directions of both.
fn by_compass(record: &CrashRecord, sentences: &[Sentence]) -> Option<(Relation, FactSource)> {
    let [Some(sv), Some(cp)] = headings(sentences) else { return None };
    // Who comes backwards faces whence it came.
    let backwards = if record.cp_movement.known() == Some(Movement::Backing) { 4 } else { 0 };
    let told = match (8 + cp.eighths - sv.eighths) % 8 {
        side @ (2 | 6) if (side + backwards) % 8 == 2 => Relation::From(Side::Left),
        2 | 6 => Relation::From(Side::Right),
        // Front and rear touch: one followed the other.
        0 if only(&record.sv_zones, ContactZone::is_rear) && only(&record.cp_zones, ContactZone::is_front) => {
            Relation::Behind
        }
        0 if only(&record.sv_zones, ContactZone::is_front) && record.cp_zones == [ContactZone::Rear] => {
            Relation::Behind
        }
        0 => Relation::Beside(None),
        4 => Relation::Oncoming,
        _ => return None,
    };
    let span = (sv.start.min(cp.start), sv.end.max(cp.end));
    let text = if sv.sentence == cp.sentence && span.1 - span.0 <= 200 {
        &sentences[sv.sentence].text[span.0..span.1]
    } else {
        cp.text
    };
    Some((told, words(record, text)))
}

fn eighths(first: Option<&str>, second: &str) -> Option<u8> {
    let first = first.map(str::to_ascii_lowercase);
    match (first.as_deref(), second.to_ascii_lowercase().as_str()) {
        (None, "north") => Some(0),
        (Some("north"), "east") => Some(1),
        (None, "east") => Some(2),
        (Some("south"), "east") => Some(3),
        (None, "south") => Some(4),
        (Some("south"), "west") => Some(5),
        (None, "west") => Some(6),
        (Some("north"), "west") => Some(7),
        _ => None,
    }
}
