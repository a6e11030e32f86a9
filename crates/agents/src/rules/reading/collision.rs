//! The kind of collision: as the words say it, else as columns and contact areas leave no other.

use super::{Relation, Sentence, column, only, words, zone_list};
use crate::rules::actors::Actor;
use crate::rules::pattern::Pattern;
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::FactSource;
use recrash_model::record::CrashRecord;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

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
pub(super) fn read(
    record: &CrashRecord,
    sentences: &[Sentence],
    relation: Option<Relation>,
) -> Option<(CollisionKind, FactSource)> {
    let told = sentences.iter().find_map(|sentence| told(record, sentence, relation));
    told.map(|(kind, text)| (kind, words(record, text))).or_else(|| by_columns(record, relation))
}

/// Whether the partner came across the ego's way or towards it, or went beside it: who does so is on neither's heels.
fn meets_elsewhere(relation: Option<Relation>) -> bool {
    use Relation::{Beside, Crossing, From, Oncoming};
    matches!(relation, Some(From(_) | Crossing | Oncoming | Beside(_)))
}

/// What a sentence says of it, and in which words: the first of these that it does.
fn told<'a>(
    record: &CrashRecord,
    sentence: &Sentence<'a>,
    relation: Option<Relation>,
) -> Option<(CollisionKind, &'a str)> {
    head_on(sentence)
        .or_else(|| rear_end(sentence))
        .or_else(|| struck_from_behind(record, sentence, relation))
        .or_else(|| hit_rear_of(sentence, relation))
}

/// "head-on"
fn head_on<'a>(sentence: &Sentence<'a>) -> Option<(CollisionKind, &'a str)> {
    let found = HEAD_ON.find(sentence.text)?;
    Some((CollisionKind::HeadOn, found.as_str()))
}

/// "rear-ended the other vehicle", "was rear-ended by"
fn rear_end<'a>(sentence: &Sentence<'a>) -> Option<(CollisionKind, &'a str)> {
    let found = REAR_END.find(sentence.text)?;
    let passive = REAR_ENDED_BY.is_match(&sentence.text[found.start()..]);
    let kind = match sentence.mentions.subject_at(found.start()) {
        Some(Actor::Sv) if !passive && sentence.mentions.object_after(found.end()) == Some(Actor::Cp) => {
            CollisionKind::RearEndByEgo
        }
        _ => CollisionKind::RearEndOfEgo,
    };
    Some((kind, found.as_str()))
}

/// "was struck from behind", "hit in the rear by the other vehicle"
fn struck_from_behind<'a>(
    record: &CrashRecord,
    sentence: &Sentence<'a>,
    relation: Option<Relation>,
) -> Option<(CollisionKind, &'a str)> {
    let found = STRUCK_FROM_BEHIND.find(sentence.text)?;
    let by_partner = sentence.mentions.object_after(found.end()) == Some(Actor::Cp);
    let kind = match sentence.mentions.subject_at(found.start()) {
        Some(Actor::Sv) => CollisionKind::RearEndOfEgo,
        _ if by_partner && !only(&record.sv_zones, ContactZone::is_front) => CollisionKind::RearEndOfEgo,
        Some(Actor::Cp) if !meets_elsewhere(relation) => CollisionKind::RearEndByEgo,
        _ => return None,
    };
    Some((kind, found.as_str()))
}

/// "contacted the rear bumper of"
fn hit_rear_of<'a>(sentence: &Sentence<'a>, relation: Option<Relation>) -> Option<(CollisionKind, &'a str)> {
    let found = HIT_REAR_OF.find(sentence.text).filter(|_| !meets_elsewhere(relation))?;
    let object = sentence.mentions.object_after(found.end());
    let kind = match (sentence.mentions.subject_at(found.start()), object) {
        (Some(Actor::Cp), Some(Actor::Sv)) => CollisionKind::RearEndOfEgo,
        (Some(Actor::Sv), Some(Actor::Cp)) => CollisionKind::RearEndByEgo,
        _ => return None,
    };
    Some((kind, found.as_str()))
}

/// What follows from contact areas, movements and how the two stood to each other.
fn by_columns(record: &CrashRecord, relation: Option<Relation>) -> Option<(CollisionKind, FactSource)> {
    let kind = rear_end_by_columns(record, relation).or_else(|| head_on_by_columns(record, relation))?;
    let text = format!("SV: {}; CP: {}", zone_list(&record.sv_zones), zone_list(&record.cp_zones));
    Some((kind, column(record, "SV and CP Contact Area", text)))
}

/// One follows the other, and rears and fronts met.
fn rear_end_by_columns(record: &CrashRecord, relation: Option<Relation>) -> Option<CollisionKind> {
    let (sv, cp) = (&record.sv_zones, &record.cp_zones);
    let behind = relation == Some(Relation::Behind);
    // Who comes backwards or out of a side street does not follow.
    let follows = |did: Option<Movement>| {
        !matches!(did, Some(Movement::Backing | Movement::ParkingManeuver | Movement::EnteringTraffic))
    };
    let both_follow = follows(record.sv_movement.known()) && follows(record.cp_movement.known());
    if record.partner.known().is_none() || meets_elsewhere(relation) || !both_follow {
        return None;
    }
    if (behind && sv.is_empty()) || (only(sv, ContactZone::is_rear) && (behind || only(cp, ContactZone::is_front))) {
        return Some(CollisionKind::RearEndOfEgo);
    }
    (only(sv, ContactZone::is_front) && only(cp, ContactZone::is_rear)).then_some(CollisionKind::RearEndByEgo)
}

/// Both went ahead, towards each other, and met with their fronts.
fn head_on_by_columns(record: &CrashRecord, relation: Option<Relation>) -> Option<CollisionKind> {
    let ahead = |did: Option<Movement>| {
        use Movement::{CrossingIntoOpposingLane, Stopped, Straight, WrongWay};
        matches!(did, Some(Straight | Stopped | WrongWay | CrossingIntoOpposingLane))
    };
    let fronts = |zones: &[ContactZone]| zones.is_empty() || zones.iter().any(|zone| zone.is_front());
    let both_ahead = ahead(record.sv_movement.known()) && ahead(record.cp_movement.known());
    let head_on =
        relation == Some(Relation::Oncoming) && both_ahead && fronts(&record.sv_zones) && fronts(&record.cp_zones);
    head_on.then_some(CollisionKind::HeadOn)
}
