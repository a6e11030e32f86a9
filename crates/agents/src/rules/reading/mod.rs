//! What one record states: its columns and its narrative, as facts with their sources.

mod account;
mod approach;
mod collision;
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
    let collision = collision::read(record, sentences, relation.as_ref().map(|(relation, _)| *relation));
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
