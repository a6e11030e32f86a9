//! Who is partly in one lane and partly in another, or beside the lanes: over which line of the road its body reaches, and when.

use super::Reading;
use crate::chunk::bound;
use crate::frame::Frame;
use crate::lexicon::{Form, Lexicon, Meaning};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Astride, AstrideWhen, Compass, Fact, Kind, KindGroup, LaneLine, LeftRight};

/// A place that somebody is partly in, as it is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Region {
    /// A lane, or the road: which side of its own lane that is on, and whether it is told to be another one than that.
    Lane { side: Option<LeftRight>, other: bool },
    /// Beside the lanes: room to park, a bicycle lane, a shoulder; and on which side of the road that is.
    Beside(Option<LeftRight>),
    /// The other side of the road, or the middle of it.
    Over,
    /// A road or a lane that leads this way.
    Way(Compass),
}

/// A place that somebody is partly in, and the token behind its name.
type Named = (Region, usize);

/// A place is named in so many words, with its article. [tokens]
const NAME_WITHIN: usize = 10;

/// Over which line somebody's body is told to reach, up to the contact.
pub(super) fn astride(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Astride>> {
    if !reading.story.world.actors[actor].kind.is_none_or(Kind::is_vehicle) {
        return None;
    }
    let until = reading.until().min(reading.story.tokens.len());
    (0..until).find_map(|at| {
        let (first, second) = partly(reading, at)?;
        let end = second.unwrap_or(first).1;
        let frame = told_of(reading, at).filter(|frame| frame.who == Some(actor))?;
        if is_of_another(reading, frame, at) {
            return None;
        }
        let act = act_of(reading, (at, end), actor)?;
        let line = line(reading, (at, frame), act, (first.0, second.map(|named| named.0)))?;
        // "moved partly into the oncoming lane": it is so when they touch.
        let goes = matches!(
            reading.story.word(at.wrapping_sub(1)),
            "moved" | "shifted" | "edged" | "nudged" | "pulled" | "steered"
        );
        let when = if goes && !stands(act) { AstrideWhen::Contact } else { when(act, was_so(reading, at)) };
        Some(reading.told(Astride { line, side: side(line, first.0, second), when }, at, end))
    })
}

fn is_partly(word: &str) -> bool {
    matches!(word, "partially" | "partly" | "partway" | "halfway" | "half")
}

fn leads_in(word: &str) -> bool {
    matches!(word, "in" | "within" | "into" | "inside" | "on" | "across" | "over" | "onto")
}

/// "partially in the left lane and partially in the bike lane", "straddling two lanes", "on the double yellow line", "encroaching into the
/// lane": the places that are named from this token on.
fn partly(reading: &Reading<'_>, at: usize) -> Option<(Named, Option<Named>)> {
    if reading.story.word(at).starts_with("straddl") {
        let both = (at + 1..at + 4).any(|at| matches!(reading.story.word(at), "two" | "both" | "lanes"));
        let lane = Region::Lane { side: None, other: both };
        let named = region(reading, at + 1).unwrap_or((lane, at + 1));
        let plain = matches!(named.0, Region::Lane { .. } | Region::Way(_));
        return Some((if plain { (Region::Lane { side: None, other: true }, named.1) } else { named }, None));
    }
    if let Some(end) = in_middle(reading, at) {
        return Some(((Region::Over, end), None));
    }
    let reaches = ["encroach", "protrud", "intrud", "jut"].iter().any(|stem| reading.story.word(at).starts_with(stem));
    let reaches =
        reaches && (reading.story.word(at).ends_with("ing") || is_partly(reading.story.word(at.wrapping_sub(1))));
    if reaches && leads_in(reading.story.word(at + 1)) {
        return Some((region(reading, at + 2)?, None));
    }
    let line = reading.story.word(at) == "on" && (at + 1..at + 4).any(|at| is_yellow_line(reading, at));
    if line && !is_partly(reading.story.word(at.wrapping_sub(1))) {
        return Some((region(reading, at + 1).filter(|(region, _)| *region == Region::Over)?, None));
    }
    // "partially stopping within both lanes".
    let to = at + 1 + usize::from(reading.story.word(at + 1).starts_with("stop"));
    if !is_partly(reading.story.word(at)) || !leads_in(reading.story.word(to)) {
        return None;
    }
    let first = region(reading, to + 1)?;
    // "was halfway across the road": on its way to the other side.
    let road = (to + 1..first.1).any(|at| matches!(reading.story.word(at), "road" | "roadway" | "street"));
    if reading.story.word(to) == "across" && road {
        return None;
    }
    Some((first, and_partly(reading, first.1)))
}

/// "down the middle of the aisle", "in the center of the narrow roadway": who drives so is over the line between the directions.
fn in_middle(reading: &Reading<'_>, at: usize) -> Option<usize> {
    let word = |at: usize| reading.story.word(at);
    let leads = matches!(word(at), "in" | "down" | "up" | "along") && word(at + 1) == "the" && word(at + 3) == "of";
    let middle = leads && matches!(word(at + 2), "middle" | "center") && matches!(word(at + 4), "the" | "a" | "an");
    let road = |word: &str| matches!(word, "road" | "roadway" | "street" | "aisle" | "alley" | "driveway");
    let noun = (at + 5..at + 7).find(|&at| road(word(at))).filter(|_| middle)?;
    let drives = told_of(reading, at).is_some_and(|frame| frame.act() == Some(Act::Follow));
    drives.then_some(noun + 1)
}

/// "and partially in the parking lane", "and the bike lane", behind the first of two places.
fn and_partly(reading: &Reading<'_>, at: usize) -> Option<Named> {
    let within = (at..at + AND_WITHIN).take_while(|&at| !matches!(reading.story.word(at), "," | "."));
    let from = within.into_iter().find(|&at| reading.story.word(at) == "and")? + 1;
    let again = is_partly(reading.story.word(from)) || leads_in(reading.story.word(from));
    let from = from + usize::from(is_partly(reading.story.word(from)));
    let from = if leads_in(reading.story.word(from)) { from + 1 } else { from };
    let article = matches!(reading.story.word(from), "the" | "a" | "its") || leads_in(reading.story.word(from - 1));
    // "partly in the right lane and the left lane was blocked": another clause.
    let named = region(reading, from).filter(|_| article)?;
    (again || !is_verb(reading, named.1)).then_some(named)
}

/// Whether a finite verb stands at this token.
fn is_verb(reading: &Reading<'_>, at: usize) -> bool {
    let be = matches!(reading.story.word(at), "was" | "were" | "is" | "are" | "had" | "has" | "became" | "remained");
    let finite = |frame: &Frame| frame.first == at && matches!(frame.form, Form::Past | Form::Present);
    be || reading.story.frames.iter().any(finite)
}

/// Whether this word is the yellow of a line of the road: "the yellow center line", and not "a yellow light in the lane".
fn is_yellow_line(reading: &Reading<'_>, at: usize) -> bool {
    let line = |at: usize| matches!(reading.story.word(at), "line" | "lines" | "centerline" | "divider");
    let between = matches!(reading.story.word(at + 1), "center" | "dividing" | "lane");
    reading.story.word(at) == "yellow"
        && (line(at + 1) || between && line(at + 2) || at > 0 && reading.story.word(at - 1) == "double")
}

/// The name of a road may stand between a lane and "and": "in the northbound lane of Elm Street and". [tokens]
const AND_WITHIN: usize = 5;

/// The place that is named from this token on, up to its noun.
fn region(reading: &Reading<'_>, from: usize) -> Option<Named> {
    let of_side = |at: usize| reading.story.word(at) == "of" && reading.story.word(at - 1) == "side";
    let ends = |at: &usize| {
        let clause =
            matches!(reading.story.word(*at), "" | "." | "," | "and" | "when" | "while" | "as" | "with" | "for" | "to");
        let place = matches!(reading.story.word(*at), "in" | "of" | "from" | "at" | "light" | "signal" | "arrow");
        clause || place && !of_side(*at)
    };
    let mut end = from;
    let noun = loop {
        // "the second to the right lane", "the second from the right lane".
        let counted = matches!(reading.story.word(end), "to" | "from")
            && reading.story.word(end + 1) == "the"
            && reading.story.word(end.wrapping_sub(1)) == "second";
        if end == from + NAME_WITHIN || ends(&end) && !counted && !is_of_zone(reading, end) {
            return compass_road(reading, from);
        }
        let noun = reading.story.word(end);
        let lane = matches!(noun, "lane" | "lanes" | "line" | "lines" | "divider" | "roadway" | "road" | "street");
        let lane = lane || noun == "centerline";
        if lane || is_beside(noun) && reading.story.word(end + 1) != "lane" && !is_of_zone(reading, end + 1) {
            break end;
        }
        end += 1;
    };
    let names = |any: &[&str]| (from..=noun).any(|at| any.contains(&reading.story.word(at)));
    let end = noun
        + 1
        + usize::from(
            reading.story.word(noun) == "lane" && matches!(reading.story.word(noun + 1), "line" | "lines" | "divider"),
        );
    let beside = (from..=noun).any(|at| is_beside(reading.story.word(at)));
    let over = names(&["oncoming", "opposing", "opposite", "centerline", "divider"])
        || (from..=noun).any(|at| is_yellow_line(reading, at))
        || names(&["center"]) && names(&["two", "turn", "line", "lines"]);
    let way = (from..noun).find_map(|at| bound(reading.story.word(at)));
    let side = match (names(&["left"]), names(&["right"])) {
        (true, false) => Some(LeftRight::Left),
        (false, true) => Some(LeftRight::Right),
        _ => None,
    };
    let adjacent = names(&["adjacent", "next", "neighboring", "other"]);
    let owned =
        names(&["'s"]) || names(&["turn", "turning", "bus", "center", "middle", "second", "third", "same", "both"]);
    Some(match way {
        _ if beside => (Region::Beside(side), end),
        _ if over => (Region::Over, end),
        Some(way) => (Region::Way(way), end),
        None => (Region::Lane { side: side.filter(|_| adjacent), other: adjacent || owned }, end),
    })
}

/// "northbound Elm Street", of which the name is withheld: the road that leads that way.
fn compass_road(reading: &Reading<'_>, from: usize) -> Option<Named> {
    bound(reading.story.word(from)).map(|way| (Region::Way(way), from + 1))
}

/// What lies beside the lanes of a street, and along it.
fn is_beside(word: &str) -> bool {
    matches!(
        word,
        "parking"
            | "bike"
            | "bicycle"
            | "curb"
            | "shoulder"
            | "stall"
            | "zone"
            | "space"
            | "spot"
            | "sidewalk"
            | "gutter"
    )
}

/// "the pick-up, drop-off zone": a comma within the name of a zone.
fn is_of_zone(reading: &Reading<'_>, at: usize) -> bool {
    (at + 1..at + 4).any(|at| reading.story.word(at) == "zone") && matches!(reading.story.word(at), "," | "and")
}

/// Of whom the words at a token are told: who does what is told last before them in the sentence, else first behind them.
fn told_of<'a>(reading: &'a Reading<'_>, at: usize) -> Option<&'a Frame> {
    let sentence = reading.story.sentences.iter().position(|sentence| (sentence.first..sentence.end).contains(&at))?;
    let own = || reading.story.frames.iter().filter(move |frame| frame.sentence == sentence && frame.who.is_some());
    own()
        .filter(|frame| frame.first <= at)
        .max_by_key(|frame| frame.first)
        .or_else(|| own().min_by_key(|frame| frame.first))
}

/// "stopped as a man was halfway across the lane", "stood with a car partly in the lane beside it": whether somebody else is named between who
/// does what is told last and these words, in the same breath.
fn is_of_another(reading: &Reading<'_>, frame: &Frame, at: usize) -> bool {
    let tokens = &reading.story.tokens;
    let somebody = |meaning| {
        let alive = |kind: Kind| kind.is_vehicle() || !matches!(kind.group(), KindGroup::Object);
        matches!(meaning, Meaning::Kind(kind) if alive(kind))
    };
    let names = |at: usize| {
        let found = Lexicon::get().longest(tokens, at, somebody);
        // "with the rear of the vehicle partly in the lane": its own.
        let own = matches!((reading.story.word(at.wrapping_sub(1)), reading.story.word(at)), ("the", "vehicle"));
        found.is_some_and(|found| !own && !reading.story.word(at + found.length).starts_with("lane"))
    };
    let breath =
        (frame.end..at).rev().take_while(|&at| !matches!(reading.story.word(at), "," | "and" | "while" | "but"));
    breath.into_iter().any(names)
}

/// "and its rear was partially in the lane".
fn was_so(reading: &Reading<'_>, at: usize) -> bool {
    matches!(reading.story.word(at.wrapping_sub(1)), "was" | "were")
}

/// What somebody did last before these words; nothing of what takes it across the road, or of whose front alone is told in a lane, which is one
/// that it comes to.
fn act_of(reading: &Reading<'_>, (at, end): (usize, usize), actor: Actor) -> Option<Act> {
    let frame = told_of(reading, at)?;
    let own = |other: &&Frame| other.who == Some(actor) && other.sentence == frame.sentence && other.first <= at + 1;
    let acts = reading.story.frames.iter().filter(own).filter(|frame| frame.act().is_some() && !frame.negated);
    let last = acts.clone().max_by_key(|frame| frame.first).or(Some(frame).filter(|frame| frame.first > at))?;
    // "stopped, straddling two lanes": it stands so.
    let stood = acts.filter(|frame| frame.first < at).max_by_key(|frame| frame.first);
    let stood = stood.filter(|frame| last.first >= at && frame.act().is_some_and(stands));
    let last = stood.unwrap_or(last);
    let across =
        |word: &str| word.starts_with("perpendicular") || matches!(word, "sideways" | "driveway" | "intersection");
    let front = (last.first..at).any(|at| reading.story.word(at) == "front" && reading.story.word(at + 1) == "of");
    let across = front || (last.first..end).any(|at| across(reading.story.word(at)));
    last.act().filter(|act| ALONG.contains(act) && !across)
}

/// What leaves somebody standing.
const fn stands(act: Act) -> bool {
    matches!(act, Act::Hold | Act::Stop | Act::Park | Act::PullOver)
}

/// What somebody does along a road.
const ALONG: [Act; 9] =
    [Act::Hold, Act::Stop, Act::Park, Act::PullOver, Act::Follow, Act::Slow, Act::Drift, Act::Reverse, Act::Pass];

/// The line between the places that are named; of one alone, between that and where it would be.
fn line(
    reading: &Reading<'_>,
    (at, frame): (usize, &Frame),
    act: Act,
    (first, second): (Region, Option<Region>),
) -> Option<LaneLine> {
    let stands = stands(act) || act == Act::Drift && was_so(reading, at);
    Some(match (first, second) {
        (Region::Over, _) | (_, Some(Region::Over)) => LaneLine::Centre,
        (Region::Beside(_), _) | (_, Some(Region::Beside(_))) => LaneLine::Edge,
        (Region::Way(one), Some(Region::Way(other))) if one.eighths_to(other) == 4 => LaneLine::Centre,
        (_, Some(_)) => LaneLine::Lanes,
        (Region::Lane { other: true, .. }, None) if frame.who == Some(SUBJECT) || !at_kerb(reading, at) => {
            LaneLine::Lanes
        }
        // "was parked partially in the lane", and partly at the kerb.
        (Region::Lane { .. } | Region::Way(_), None) if stands && !changes(reading, frame) => LaneLine::Edge,
        _ => return None,
    })
}

/// Whether the kerb is named before these words in their sentence.
fn at_kerb(reading: &Reading<'_>, at: usize) -> bool {
    let sentence = reading.story.sentences.iter().find(|sentence| (sentence.first..sentence.end).contains(&at));
    sentence.is_some_and(|sentence| (sentence.first..at).any(|at| reading.story.word(at) == "curb"))
}

/// Whether somebody was on its way to another lane.
fn changes(reading: &Reading<'_>, frame: &Frame) -> bool {
    frame.who.is_some_and(|who| reading.before(who).any(|(_, other)| other.act() == Some(Act::LaneChange)))
}

/// On which side of its own lane the line is: of who reaches into the lane beside it, or beside the road.
fn side(line: LaneLine, first: Region, second: Option<Named>) -> Option<LeftRight> {
    match (line, first) {
        (LaneLine::Lanes, Region::Lane { side, .. }) if second.is_none() => side,
        (LaneLine::Edge, Region::Beside(side)) => side,
        (LaneLine::Edge, _) => match second {
            Some((Region::Beside(side), _)) => side,
            _ => None,
        },
        _ => None,
    }
}

/// When its body is over the line: of who drives so, from the start; of who drifts, only when they touch.
fn when(act: Act, was: bool) -> AstrideWhen {
    match act {
        _ if stands(act) || act == Act::Drift && was => AstrideWhen::Stop,
        Act::Follow | Act::Slow | Act::Pass => AstrideWhen::Start,
        _ => AstrideWhen::Contact,
    }
}
