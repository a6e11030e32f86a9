//! What one record states: its columns and its narrative, as facts with their sources.

mod account;
mod approach;
mod details;
mod movement;
mod of_account;
mod order;
mod road;
mod zones;

pub use account::account;
pub use of_account::reading_of_account;

pub use approach::side_from_zones;

use super::actors::{Actor, Cast, Mentions};
use super::pattern::Pattern;
use super::text::telling_sentences;
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{Fact, FactSource, FactValue, Side};
use recrash_model::record::CrashRecord;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// A sentence and whom it mentions.
#[derive(Debug, Clone)]
pub(super) struct Sentence<'a> {
    pub(super) text: &'a str,
    pub(super) mentions: Mentions,
}

/// How the partner stood to the ego before the conflict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// It came from this side.
    From(Side),
    /// It came from a cross street; from which side is not said.
    Crossing,
    /// It came towards the ego.
    Oncoming,
    /// It went beside the ego in the same direction, on this side where it is said.
    Beside(Option<Side>),
    /// It followed the ego, or led it, in the same lane.
    Behind,
}

/// What one record states.
#[derive(Debug, Clone)]
pub struct Reading<'a> {
    /// The record.
    pub record: &'a CrashRecord,
    /// From where the partner came, and where that is said.
    pub relation: Option<(Relation, FactSource)>,
    /// The kind of collision, where it is told or follows from the contact areas.
    pub collision: Option<(CollisionKind, FactSource)>,
    /// A turn the narrative tells of that is another than the column's, in words for a reason.
    pub contradiction: Option<String>,
    /// Whether the narrative tells anything about how the two met.
    pub tells: bool,
    /// Everything else it states.
    pub facts: Vec<Fact>,
}

pub(super) static MEETING: Pattern = Pattern::new(
    r"(?i)\b(?:contact\w*|struck|strik\w+|hit|hitting|collid\w+|sideswip\w+|side-swip\w+|clipped|scrap\w+|impacted|impacting|rear[- ]?end\w*|ran into|crash\w+ into|bumped)\b",
);

static TURN: Pattern = Pattern::new(
    r"(?i)\b(?:making|made|makes?|initiat\w+|execut\w+|complet\w+|perform\w+|attempt\w+|began|beginning) (?:\w+ ){0,4}?(?P<a>left|right)(?:[- ]hand)?[- ]turn\b|\b(?:turned|turning|turns) (?:\w+ )?(?P<b>left|right)\b",
);

/// Before a turn: it was over before anything happened.
static DONE_BEFORE: Pattern = Pattern::new(r"(?i)\b(?:having|had|after|following)(?: just| recently)?\s*$");

static STRAIGHT: Pattern = Pattern::new(
    r"(?i)\bstraight\b|\bthrough (?:the|an|its) (?:\w+ )?(?:intersection|light|signal)|\bproceed\w* (?:into|through|across)|\bcontinu\w+|\bcross(?:ed|ing) the intersection|\bentered the intersection|\bthrough traffic|\bwith the flow of traffic|\bright of way",
);

/// Reads a record.
pub fn read(record: &CrashRecord) -> Reading<'_> {
    reading_of(record, &read_sentences(record))
}

/// The sentences that tell about the crash, each with whom it mentions.
fn read_sentences(record: &CrashRecord) -> Vec<Sentence<'_>> {
    let texts = telling_sentences(&record.narrative);
    let cast = Cast::new(record, &texts);
    texts.into_iter().map(|text| Sentence { text, mentions: cast.mentions(text) }).collect()
}

fn reading_of<'a>(record: &'a CrashRecord, sentences: &[Sentence<'a>]) -> Reading<'a> {
    let relation = approach::relation(record, sentences);
    let partner_named = sentences.iter().any(|sentence| sentence.mentions.includes(Actor::Cp));
    let meets = partner_named && sentences.iter().any(|sentence| MEETING.is_match(sentence.text));
    let collision = collision(record, sentences, relation.as_ref().map(|(relation, _)| *relation));
    Reading {
        record,
        tells: meets || relation.is_some(),
        contradiction: contradiction(record, sentences),
        facts: facts(record, sentences, relation.as_ref().map(|(relation, _)| *relation)),
        relation,
        collision,
    }
}

/// Words of a record's narrative.
pub(super) fn words(record: &CrashRecord, words: &str) -> FactSource {
    FactSource::Words { record: record.id.clone(), words: words.to_owned() }
}

/// A column of a record.
pub(super) fn column(record: &CrashRecord, column: &str, text: impl Into<String>) -> FactSource {
    FactSource::Column { record: record.id.clone(), column: column.to_owned(), text: text.into() }
}

/// Zone names for a sentence, such as `front left, left`.
pub(super) fn zone_list(zones: &[ContactZone]) -> String {
    zones.iter().map(|zone| zone.label()).collect::<Vec<_>>().join(", ")
}

fn facts(record: &CrashRecord, sentences: &[Sentence], relation: Option<Relation>) -> Vec<Fact> {
    let mut facts = Vec::new();
    let mut add = |value, source| facts.push(Fact { value, source });
    if let Some(movement) = record.sv_movement.known() {
        add(FactValue::SvMovement { movement }, column(record, "SV Pre-Crash Movement", movement.label()));
    }
    if let Some(movement) = record.cp_movement.known() {
        add(FactValue::CpMovement { movement }, column(record, "CP Pre-Crash Movement", movement.label()));
    }
    details::read(record, sentences, relation, &mut add);
    let zones = (!record.sv_zones.is_empty(), !record.cp_zones.is_empty());
    if zones != (false, false) {
        let text = format!("SV: {}; CP: {}", zone_list(&record.sv_zones), zone_list(&record.cp_zones));
        let contact = FactValue::Contact { sv: record.sv_zones.clone(), cp: record.cp_zones.clone() };
        add(contact, column(record, "SV and CP Contact Area", text.clone()));
        let met = order::Met {
            relation,
            collision: None,
            movements: (record.sv_movement.known(), record.cp_movement.known()),
            zones: (&record.sv_zones, &record.cp_zones),
        };
        if let Some(first) = order::first(&met) {
            add(FactValue::Order { first }, column(record, "SV and CP Contact Area", text));
        }
    }
    facts
}

/// Whether there are zones and all of them are of this sort.
pub fn only(zones: &[ContactZone], sort: fn(ContactZone) -> bool) -> bool {
    !zones.is_empty() && zones.iter().all(|zone| sort(*zone))
}

static REAR_END: Pattern = Pattern::new(r"(?i)\brear[- ]?end(?:ed|ing|s)?\b");
static REAR_ENDED_BY: Pattern = Pattern::new(r"(?i)^rear[- ]?ended(?: \w+)? by\b");
static STRUCK_FROM_BEHIND: Pattern = Pattern::new(
    r"(?i)\b(?:struck|hit|impacted|contacted|bumped) (?:from|in|on|at)(?: the| its)? (?:behind|rear|back)\b",
);
static HEAD_ON: Pattern = Pattern::new(r"(?i)\bhead[- ]on\b");
static HIT_REAR_OF: Pattern = Pattern::new(
    r"(?i)\b(?:contact\w*|struck|hit|collided|impacted|bumped)\b(?: with)?(?: into)? (?:the )?(?:rear|back)(?:[- ]end| bumper)?(?: bumper)?(?: of)?",
);

/// The kind of collision, where it is one of those a profile may exclude.
fn collision(
    record: &CrashRecord,
    sentences: &[Sentence],
    relation: Option<Relation>,
) -> Option<(CollisionKind, FactSource)> {
    let crosses = matches!(relation, Some(Relation::From(_) | Relation::Crossing | Relation::Oncoming));
    let beside = matches!(relation, Some(Relation::Beside(_)));
    for sentence in sentences {
        if let Some(found) = HEAD_ON.find(sentence.text) {
            return Some((CollisionKind::HeadOn, words(record, found.as_str())));
        }
        if let Some(found) = REAR_END.find(sentence.text) {
            let passive = REAR_ENDED_BY.is_match(&sentence.text[found.start()..]);
            let kind = match sentence.mentions.subject_at(found.start()) {
                Some(Actor::Sv) if !passive && sentence.mentions.object_after(found.end()) == Some(Actor::Cp) => {
                    CollisionKind::RearEndByEgo
                }
                _ => CollisionKind::RearEndOfEgo,
            };
            return Some((kind, words(record, found.as_str())));
        }
        if let Some(found) = STRUCK_FROM_BEHIND.find(sentence.text) {
            let by_partner = sentence.mentions.object_after(found.end()) == Some(Actor::Cp);
            let kind = match sentence.mentions.subject_at(found.start()) {
                Some(Actor::Sv) => Some(CollisionKind::RearEndOfEgo),
                _ if by_partner && !only(&record.sv_zones, ContactZone::is_front) => Some(CollisionKind::RearEndOfEgo),
                Some(Actor::Cp) if !crosses && !beside => Some(CollisionKind::RearEndByEgo),
                _ => None,
            };
            if let Some(kind) = kind {
                return Some((kind, words(record, found.as_str())));
            }
        }
        if let Some(found) = HIT_REAR_OF.find(sentence.text).filter(|_| !crosses && !beside) {
            let object = sentence.mentions.object_after(found.end());
            let kind = match (sentence.mentions.subject_at(found.start()), object) {
                (Some(Actor::Cp), Some(Actor::Sv)) => Some(CollisionKind::RearEndOfEgo),
                (Some(Actor::Sv), Some(Actor::Cp)) => Some(CollisionKind::RearEndByEgo),
                _ => None,
            };
            if let Some(kind) = kind {
                return Some((kind, words(record, found.as_str())));
            }
        }
    }
    let zones = || {
        let text = format!("SV: {}; CP: {}", zone_list(&record.sv_zones), zone_list(&record.cp_zones));
        column(record, "SV and CP Contact Area", text)
    };
    let (sv, cp) = (&record.sv_zones, &record.cp_zones);
    let behind = relation == Some(Relation::Behind);
    let (sv_did, cp_did) = (record.sv_movement.known(), record.cp_movement.known());
    // Who comes backwards or out of a side street does not follow.
    let follows = |did: Option<Movement>| {
        !matches!(did, Some(Movement::Backing | Movement::ParkingManeuver | Movement::EnteringTraffic))
    };
    if record.partner.known().is_some() && !crosses && !beside && follows(sv_did) && follows(cp_did) {
        if (behind && sv.is_empty()) || (only(sv, ContactZone::is_rear) && (behind || only(cp, ContactZone::is_front)))
        {
            return Some((CollisionKind::RearEndOfEgo, zones()));
        }
        if only(sv, ContactZone::is_front) && only(cp, ContactZone::is_rear) {
            return Some((CollisionKind::RearEndByEgo, zones()));
        }
    }
    let ahead = |did: Option<Movement>| {
        use Movement::{CrossingIntoOpposingLane, Stopped, Straight, WrongWay};
        matches!(did, Some(Straight | Stopped | WrongWay | CrossingIntoOpposingLane))
    };
    let fronts = |zones: &[ContactZone]| zones.is_empty() || zones.iter().any(|zone| zone.is_front());
    let head_on = relation == Some(Relation::Oncoming) && ahead(sv_did) && ahead(cp_did) && fronts(sv) && fronts(cp);
    head_on.then(|| (CollisionKind::HeadOn, zones()))
}

/// Whether a left turn, a right turn and going straight are told of an actor.
fn told_turns(sentences: &[Sentence], actor: Actor) -> (bool, bool, bool) {
    let (mut left, mut right, mut straight) = (false, false, false);
    for sentence in sentences {
        for found in TURN.captures_iter(sentence.text) {
            let at = found.get_match().start();
            if DONE_BEFORE.is_match(&sentence.text[..at]) {
                continue;
            }
            let together = sentence.text[..at].contains("both ") && sentence.mentions.includes(actor);
            if together || sentence.mentions.subject_at(at) == Some(actor) {
                let side = found.name("a").or_else(|| found.name("b")).map_or("", |m| m.as_str());
                left |= side.eq_ignore_ascii_case("left");
                right |= side.eq_ignore_ascii_case("right");
            }
        }
        for found in STRAIGHT.find_iter(sentence.text) {
            straight |= sentence.mentions.subject_at(found.start()) == Some(actor);
        }
    }
    (left, right, straight)
}

/// A turn the narrative tells of, where the column says otherwise and no words bear the column out.
fn contradiction(record: &CrashRecord, sentences: &[Sentence]) -> Option<String> {
    let against = |actor: Actor, movement: Option<Movement>| {
        let (left, right, straight) = told_turns(sentences, actor);
        match movement? {
            Movement::Straight if !straight && left != right => Some(if left { "left" } else { "right" }),
            Movement::LeftTurn if right && !left => Some("right"),
            Movement::RightTurn if left && !right => Some("left"),
            _ => None,
        }
    };
    let sentence = |who: &str, side: &str, movement: Movement| {
        format!("the narrative says that {who} turned {side}, the column says \"{}\"", movement.label())
    };
    if let (Some(side), Some(movement)) = (against(Actor::Sv, record.sv_movement.known()), record.sv_movement.known()) {
        return Some(sentence("the ego", side, movement));
    }
    match (against(Actor::Cp, record.cp_movement.known()), record.cp_movement.known()) {
        (Some(side), Some(movement)) => Some(sentence("the partner", side, movement)),
        _ => None,
    }
}
