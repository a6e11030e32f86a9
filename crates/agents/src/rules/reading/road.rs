//! Where it happened: the column, unless the narrative plainly says otherwise.

use super::super::pattern::Pattern;
use super::{MEETING, Relation, Sentence};
use recrash_model::labelled::RoadGroup;
use recrash_model::record::CrashRecord;
use recrash_model::template::{Movement, RoadType};

static IN_JUNCTION: Pattern = Pattern::new(
    r"(?i)\b(?:enter(?:ed|ing|s)?|through|into|within|inside|in the middle of|cross(?:ed|ing)|block(?:ed|ing)) (?:the|an|its) (?:\w+ )?intersection\b",
);
/// Where one crosses the way of a moving other, that there is a junction is enough. Who stands still waits before it.
static JUNCTION: Pattern = Pattern::new(r"(?i)\bintersection\b");
/// Short of the junction, or already out of it: the contact was not inside.
static SHORT_OF_JUNCTION: Pattern =
    Pattern::new(r"(?i)\b(?:before|prior to|without) (?:enter|cross|block)ing (?:the|an|its) (?:\w+ )?intersection\b");
static PAST_JUNCTION: Pattern = Pattern::new(
    r"(?i)\b(?:after (?:passing|driving|traveling|proceeding|going) through (?:the|an|its) (?:\w+ )?intersection|through (?:the|an|its) (?:\w+ )?intersection\b.*\btowards? the curb)\b",
);
/// Who comes out of one of these does not cross at the junction that the narrative names.
static BY_THE_STREET: Pattern = Pattern::new(r"(?i)\b(?:driveway|parking (?:lot|stall|space|garage))\b");
static GARAGE: Pattern = Pattern::new(r"(?i)\bparking (?:garage|structure)\b");

/// The kind of road of a record, given from where the partner came and what the ego did.
pub(super) fn road(
    record: &CrashRecord,
    sentences: &[Sentence],
    relation: Option<Relation>,
    sv_movement: Option<Movement>,
) -> Option<RoadGroup> {
    let turns = [record.sv_movement.known(), record.cp_movement.known()]
        .iter()
        .any(|movement| matches!(movement, Some(Movement::LeftTurn)));
    let crosses = match relation {
        _ if sv_movement == Some(Movement::Stopped) => false,
        Some(Relation::From(_) | Relation::Crossing) => true,
        Some(Relation::Oncoming) => turns,
        _ => false,
    };
    let column = record.road.known();
    let before_they_met = || {
        let met = sentences.iter().position(|sentence| MEETING.is_match(sentence.text));
        &sentences[..met.map_or(sentences.len(), |met| met + 1)]
    };
    match column {
        Some(RoadType::Street)
            if before_they_met().iter().any(|sentence| {
                in_junction(sentence.text)
                    || (crosses && JUNCTION.is_match(sentence.text) && !BY_THE_STREET.is_match(sentence.text))
            }) =>
        {
            Some(RoadGroup::Intersection)
        }
        Some(RoadType::ParkingLot) if sentences.iter().any(|sentence| GARAGE.is_match(sentence.text)) => {
            Some(RoadGroup::Other)
        }
        Some(column) => Some(column.into()),
        None => by_words(sentences),
    }
}

/// Whether a sentence puts somebody inside a junction, neither short of it nor past it.
fn in_junction(text: &str) -> bool {
    IN_JUNCTION.is_match(text) && !SHORT_OF_JUNCTION.is_match(text) && !PAST_JUNCTION.is_match(text)
}

static WORDS: [(Pattern, RoadGroup); 4] = [
    (Pattern::new(r"(?i)\b(?:parking lot|parking area|parking stall)\b"), RoadGroup::Parking),
    (Pattern::new(r"(?i)\b(?:highway|freeway|interstate|motorway|I-\d+)\b"), RoadGroup::Highway),
    (Pattern::new(r"(?i)\b(?:roundabout|traffic circle)\b"), RoadGroup::Circle),
    (Pattern::new(r"(?i)\bintersection\b"), RoadGroup::Intersection),
];

/// Where the column does not say, the first kind of road that the narrative names; a street where it names none.
fn by_words(sentences: &[Sentence]) -> Option<RoadGroup> {
    let named = WORDS.iter().find(|(words, _)| sentences.iter().any(|sentence| words.is_match(sentence.text)));
    named.map(|(_, road)| *road).or((!sentences.is_empty()).then_some(RoadGroup::Street))
}
