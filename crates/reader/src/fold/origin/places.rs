//! What the words say of the place that somebody comes from: a kerb, a stall, a side street, a side of the road.

use super::relation_to;
use crate::chunk::bound;
use crate::fold::Reading;
use crate::fold::types::turning;
use crate::frame::Frame;
use crate::lexicon::{Relation, Sense};
use crate::token::{MONTHS, word};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Account, Act, ActFact, Compass, LaneWord, LeftRight, PlaceKind, Source};
use recrash_model::template::RoadType;

/// The side of the road from which somebody comes, where its words name it: "from the north side of the street", "between cars on the
/// right side of the road".
pub(super) fn side_of_road(reading: &Reading<'_>, actor: Actor, account: &Account) -> Option<LeftRight> {
    let comes = |act: Option<Act>| {
        matches!(act, Some(Act::Enter | Act::Cross | Act::PullOut | Act::Follow | Act::Swerve | Act::Reverse))
    };
    side_of_road_of(reading, actor, after_its_turn(account), comes)
}

/// The same, of somebody who does what is asked for, seen by who drives that way.
pub(crate) fn side_of_road_of(
    reading: &Reading<'_>,
    actor: Actor,
    own: Option<Compass>,
    comes: impl Fn(Option<Act>) -> bool,
) -> Option<LeftRight> {
    reading.before(actor).filter(|(_, frame)| comes(frame.act())).find_map(|(number, _)| {
        let (first, end) = reading.window(number);
        (first..end).find_map(|at| side_named_at(reading, at, own))
    })
}

/// "left side of the street", "south sidewalk", of who goes west: the left one. A median is on the left.
pub(crate) fn side_named_at(reading: &Reading<'_>, at: usize, own: Option<Compass>) -> Option<LeftRight> {
    let compass = |at: usize| match reading.story.word(at) {
        "north" | "northern" => Some(Compass::North),
        "east" | "eastern" => Some(Compass::East),
        "south" | "southern" => Some(Compass::South),
        "west" | "western" => Some(Compass::West),
        _ => None,
    };
    let road = |at: usize| {
        (at..at + 5).any(|at| matches!(reading.story.word(at), "road" | "roadway" | "street" | "alley" | "lot"))
    };
    let kerb = matches!(reading.story.word(at + 1), "sidewalk" | "curb");
    match reading.story.word(at) {
        // "crossed from the center median".
        "median"
            if (1..=3).any(|back| {
                at.checked_sub(back).is_some_and(|at| matches!(reading.story.word(at), "from" | "off"))
            }) =>
        {
            Some(LeftRight::Left)
        }
        "left" if kerb || reading.story.word(at + 1) == "side" && road(at + 2) => Some(LeftRight::Left),
        "right" if kerb || reading.story.word(at + 1) == "side" && road(at + 2) => Some(LeftRight::Right),
        _ if kerb || reading.story.word(at + 1) == "side" => match own?.eighths_to(compass(at)?) {
            1..=3 => Some(LeftRight::Right),
            5..=7 => Some(LeftRight::Left),
            _ => None,
        },
        _ => None,
    }
}

/// "a van facing west on eastbound Elm Street", of who goes west: it is on the other side of the road.
pub(super) fn faces_against_its_side(reading: &Reading<'_>, actor: Actor, own: Option<Compass>) -> bool {
    let tokens = &reading.story.tokens;
    let Some((_, first, end)) = reading.story.world.actors[actor].heading.filter(|_| faces_only(reading, actor)) else {
        return false;
    };
    let on = |at: usize| tokens.get(at).is_some_and(|token| token.text == "on");
    let side = tokens.get(end + 1 + usize::from(tokens.get(end + 1).is_some_and(|next| next.text == "the")));
    let way = side.filter(|_| first < end && on(end)).and_then(|side| bound(&side.text));
    way.zip(own).is_some_and(|(way, own)| own.eighths_to(way) == 4)
}

/// Behind whom, or from between whom, somebody comes out: "emerged from behind the van".
pub(super) fn screen(reading: &Reading<'_>, number: usize, frame: &Frame) -> Option<Actor> {
    let (first, end) = reading.window(number);
    let words = &reading.story.tokens[first..end];
    let from = words
        .windows(2)
        .any(|pair| pair[0].text == "from" && matches!(pair[1].text.as_str(), "behind" | "between" | "in"));
    let place = |(relation, to): &(Relation, Option<Actor>)| {
        if matches!(relation, Relation::Behind | Relation::Ahead) { *to } else { None }
    };
    let hides = frame.relations.iter().find_map(place).or(frame.object);
    hides.filter(|hides| from && *hides != SUBJECT && frame.who != Some(*hides))
}

/// On which side of the subject vehicle somebody stands behind whom another comes out: as told, or where the oncoming traffic is.
pub(super) fn side_of_screen(reading: &Reading<'_>, actor: Actor, own: Option<Compass>) -> Option<LeftRight> {
    let known = &reading.story.world.actors[actor];
    let told = known.relations.iter().find_map(|(relation, _)| match relation {
        Relation::Left | Relation::Opposite => Some(LeftRight::Left),
        Relation::Right => Some(LeftRight::Right),
        _ => None,
    });
    let against = known.heading.is_some_and(|(heading, ..)| own.is_some_and(|own| own.eighths_to(heading) == 4));
    let opposing = against || known.lane.is_some_and(|(lane, ..)| lane == LaneWord::Opposing);
    let stands = |act: Option<Act>| act.is_some_and(Act::stands);
    told.or(opposing.then_some(LeftRight::Left)).or_else(|| side_of_road_of(reading, actor, own, stands))
}

/// Whether somebody is told to go uphill (or downhill).
pub(super) fn climbs(reading: &Reading<'_>, actor: Actor) -> Option<bool> {
    let tokens = &reading.story.tokens;
    reading.before(actor).find_map(|(number, frame)| {
        let (first, end) = reading.window(number);
        let goes = matches!(frame.act(), Some(Act::Follow | Act::SetOff | Act::Drift | Act::Pass));
        tokens[first..end].iter().filter(|_| goes).find_map(|token| match token.text.as_str() {
            "uphill" => Some(true),
            "downhill" => Some(false),
            _ => None,
        })
    })
}

/// Whether the words put somebody at the kerb.
pub(crate) fn at_curb(reading: &Reading<'_>, actor: Actor) -> bool {
    let tokens = &reading.story.tokens;
    reading.before(actor).any(|(number, _)| {
        let (first, end) = reading.window(number);
        tokens[first..end].iter().any(|token| matches!(token.text.as_str(), "curb" | "curbside" | "kerb" | "parallel"))
    })
}

/// Whether the words put somebody on a road that crosses.
pub(crate) fn on_side_street(reading: &Reading<'_>, actor: Actor) -> bool {
    let tokens = &reading.story.tokens;
    reading.before(actor).any(|(number, frame)| {
        let (first, end) = reading.window(number);
        // "A coupe on the cross street ran the light": between its name and its verb.
        let named = reading.story.world.actors[actor].kind_tokens.map_or(first, |(_, end)| end);
        let sentence = reading.story.sentences[frame.sentence];
        let first = if (sentence.first..first).contains(&named) { named } else { first };
        // "a cross-street taxi", "a taxi in the cross traffic".
        let own = reading.story.world.actors[actor].kind_tokens.map_or(first..first, |(from, to)| from..to);
        let crossing = |at: usize| {
            matches!(word(tokens, at), "cross" | "intersecting") && matches!(word(tokens, at + 1), "street" | "traffic")
        };
        own.into_iter().any(crossing)
            || (first..end).any(|at| {
                let road = matches!(word(tokens, at + 1), "street" | "road" | "streets")
                    || at > 0
                        && word(tokens, at - 1) == "the"
                        && word(tokens, at) == "cross"
                        && word(tokens, at + 1) == "traffic";
                let crosses =
                    matches!(word(tokens, at), "side" | "cross" | "crossing" | "intersecting" | "perpendicular");
                // "the street on its left".
                let there = matches!(word(tokens, at), "street" | "road")
                    && matches!(word(tokens, at + 1), "on" | "to")
                    && (at + 2..at + 4).any(|at| matches!(word(tokens, at), "left" | "right"));
                // "from the perpendicular left of it".
                let square = word(tokens, at) == "perpendicular" && matches!(word(tokens, at + 1), "left" | "right")
                    || matches!(word(tokens, at), "street" | "road") && word(tokens, at + 1) == "perpendicular";
                crosses && road || there || square
            })
    })
}

/// Whether the direction of somebody is the one that it faces, and not the one that it drives.
pub(super) fn faces_only(reading: &Reading<'_>, actor: Actor) -> bool {
    reading.story.world.actors[actor].heading.is_some_and(|(_, first, _)| {
        reading.story.tokens[first.saturating_sub(2)..first]
            .iter()
            .any(|token| matches!(token.text.as_str(), "facing" | "faced" | "oriented" | "pointed" | "pointing"))
    })
}

/// Direction of the subject vehicle, after a turn that is done where no street is told.
pub(super) fn after_its_turn(account: &Account) -> Option<Compass> {
    let heading = account.sv.heading.as_ref()?.value;
    let mut turns = account.sv.acts.iter().filter(|fact| !fact.after_contact && matches!(fact.act, Act::Turn));
    let (only, more) = (turns.next(), turns.next());
    match only {
        Some(only) if more.is_none() && !turning(&account.sv) => match only.side {
            Some(LeftRight::Left) => Some(heading.turned(6)),
            Some(LeftRight::Right) => Some(heading.turned(2)),
            None => Some(heading),
        },
        _ => Some(heading),
    }
}

pub(super) fn passes_subject(reading: &Reading<'_>, actor: Actor) -> bool {
    reading
        .before(actor)
        .any(|(_, frame)| frame.act() == Some(Act::Pass) && frame.object.is_none_or(|object| object == SUBJECT))
}

/// "passed it by crossing into and driving in the opposing lane": where it went to pass, and not where it came from.
pub(super) fn goes_over_to_pass(reading: &Reading<'_>, actor: Actor) -> bool {
    let opposite = |frame: &Frame| frame.relations.iter().any(|(relation, _)| *relation == Relation::Opposite);
    let goes_over = |frame: &Frame| matches!(frame.act(), Some(Act::Drift | Act::LaneChange | Act::Enter));
    let frames = || reading.before(actor).filter(|(_, frame)| frame.happened());
    let went = |(there, frame): (usize, &Frame)| {
        let passed = frames().find(|(_, pass)| pass.act() == Some(Act::Pass) && pass.sentence == frame.sentence);
        passed.is_some_and(|(pass, _)| frames().any(|(over, frame)| (pass..=there).contains(&over) && goes_over(frame)))
    };
    let mut told = frames().filter(|(_, frame)| opposite(frame)).peekable();
    passes_subject(reading, actor) && told.peek().is_some() && told.all(went)
}

/// The subject vehicle stood behind it, or followed it.
pub(super) fn lead_of_subject(reading: &Reading<'_>, actor: Actor) -> bool {
    reading.before(SUBJECT).any(|(_, frame)| {
        frame.relations.contains(&(Relation::Behind, Some(actor)))
            || (frame.sense == Sense::Yield && frame.object == Some(actor))
    })
}

/// The words that place somebody in a stall.
pub(super) fn in_stall(reading: &Reading<'_>, actor: Actor) -> Option<Source> {
    stood_in(reading, actor, &["stall", "stalls", "space", "spot", "carport", "spaces"])
}

/// Where it stood in a place of one of these names.
pub(super) fn stood_in(reading: &Reading<'_>, actor: Actor, names: &[&str]) -> Option<Source> {
    let tokens = &reading.story.tokens;
    reading.before(actor).find_map(|(number, frame)| {
        let (first, end) = reading.window(number);
        let at = (first..end).find(|&at| names.contains(&tokens[at].text.as_str()))?;
        (frame.sense == Sense::Parked || frame.act() == Some(Act::Hold) || frame.sense == Sense::Face)
            .then(|| reading.words(frame.first, at + 1))
    })
}

/// "approaching from behind in the left adjacent lane", of one that goes over to the left: beside it, and behind at first.
pub(super) fn behind_in_next_lane(
    reading: &Reading<'_>,
    actor: Actor,
    account: &Account,
    side: LeftRight,
) -> Option<Source> {
    let goes = |fact: &ActFact| {
        let over = fact.act.leaves_line();
        over && !fact.after_contact && fact.side == Some(side)
    };
    let both = |frame: &Frame| {
        let has = |wanted: Relation| frame.relations.iter().any(|(relation, _)| *relation == wanted);
        has(Relation::Behind) && has(relation_to(side))
    };
    let (number, _) = reading.before(actor).find(|(_, frame)| both(frame))?;
    let (first, end) = reading.window(number);
    account.sv.acts.iter().any(goes).then(|| reading.words(first, end))
}

/// "drove along Elm Street when a van, turning left onto Elm Street, struck its rear": to which side it turned, and the words.
pub(super) fn turn_onto_its_street(reading: &Reading<'_>, actor: Actor) -> Option<(LeftRight, Source)> {
    let turns = |frame: &Frame| match frame.sense {
        Sense::Sided(Act::Turn, side) => Some(side),
        Sense::Act(Act::Turn) => frame.side,
        _ => None,
    };
    let (number, side) = reading.before(actor).find_map(|(number, frame)| Some((number, turns(frame)?)))?;
    let street = street_behind(reading, number, &["onto"])?;
    let along = ["on", "along", "down", "up"];
    let own = |number: usize| street_behind(reading, number, &along).is_some_and(|own| is_one_street(&own, &street));
    let drives = |frame: &Frame| frame.act() == Some(Act::Follow);
    let same = reading.before(SUBJECT).any(|(number, frame)| drives(frame) && own(number));
    let (first, end) = reading.window(number);
    same.then(|| (side, reading.words(first, end)))
}

/// "It drove on Elm Street when a van traveling on Oak Street struck it", at a junction: the words for the other street.
pub(super) fn drives_on_another(reading: &Reading<'_>, actor: Actor) -> Option<Source> {
    let drives = |frame: &Frame| frame.act() == Some(Act::Follow) && frame.happened() && !frame.aside;
    let named = |actor: Actor| {
        let told = reading.before(actor).filter(|(_, frame)| drives(frame));
        told.filter_map(|(number, _)| Some((number, street_behind(reading, number, &["on", "along", "down", "up"])?)))
            .next()
    };
    let ((_, own), (number, other)) = (named(SUBJECT)?, named(actor)?);
    let features = &story_words(reading);
    let junction = features.contains(&"intersection") || reading.record.road.known() == Some(RoadType::Intersection);
    let (first, end) = reading.window(number);
    (!is_one_street(&own, &other) && junction).then(|| reading.words(first, end))
}

/// The words of the story up to the contact.
fn story_words<'a>(reading: &'a Reading<'_>) -> Vec<&'a str> {
    let end = reading.until().min(reading.story.tokens.len());
    reading.story.tokens[..end].iter().map(|token| token.text.as_str()).collect()
}

/// "on Monday", "on March 3".
fn is_date(word: &str) -> bool {
    const DAYS: [&str; 7] = ["monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday"];
    DAYS.contains(&word) || MONTHS.contains(&word)
}

/// Words of a name that tell one part of a street from another.
const DIRECTIONS: [&str; 16] = [
    "north",
    "south",
    "east",
    "west",
    "northeast",
    "northwest",
    "southeast",
    "southwest",
    "n",
    "s",
    "e",
    "w",
    "ne",
    "nw",
    "se",
    "sw",
];

/// Whether two names are of one street: "Alder Street" may be called Alder.
fn is_one_street(one: &[&str], other: &[&str]) -> bool {
    one.iter().zip(other).all(|(one, other)| one == other)
}

/// So many words of a street's name are held against another's.
const STREET_WORDS: usize = 2;

/// The name of a street behind one of these words, in the words of a frame.
fn street_behind<'a>(reading: &'a Reading<'_>, number: usize, words: &[&str]) -> Option<Vec<&'a str>> {
    let (first, end) = reading.window(number);
    let tokens = &reading.story.tokens[first..end];
    let at = tokens.iter().position(|token| words.contains(&token.text.as_str()))?;
    let bound = usize::from(tokens.get(at + 1).is_some_and(|next| next.text.ends_with("bound")));
    let run = tokens[at + 1 + bound..].iter().take_while(|token| token.capital).map(|token| token.text.as_str());
    // "West Elm Street" may be called Elm Street.
    let name: Vec<&str> = run.filter(|word| !DIRECTIONS.contains(word)).take(STREET_WORDS).collect();
    let hidden = |word: &&str| is_date(word) || word.contains("xxx") || word.contains("redacted");
    (!name.is_empty() && !name.iter().any(hidden)).then_some(name)
}

/// "reversed out of an angled space", "out of a space in a parking lot": it stood across the way.
pub(super) fn is_across(reading: &Reading<'_>, number: usize, account: &Account) -> bool {
    let (first, end) = reading.window(number);
    let has =
        |wanted: &[&str]| reading.story.tokens[first..end].iter().any(|token| wanted.contains(&token.text.as_str()));
    let kind = account.place.kind.as_ref().map(|kind| kind.value);
    let lot = matches!(kind, Some(PlaceKind::ParkingLot | PlaceKind::Garage));
    !has(&["parallel"]) && (lot || has(&["angled", "perpendicular", "diagonal", "diagonally"]))
}

/// The one side that stands in the words of a frame: "from between cars in the leftmost lane".
pub(super) fn side_named(reading: &Reading<'_>, number: usize) -> Option<LeftRight> {
    let (first, end) = reading.window(number);
    let has = |stem: &str| reading.story.tokens[first..end].iter().any(|token| token.text.starts_with(stem));
    match (has("left"), has("right")) {
        (true, false) => Some(LeftRight::Left),
        (false, true) => Some(LeftRight::Right),
        _ => None,
    }
}
