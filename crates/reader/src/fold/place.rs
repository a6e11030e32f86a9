//! Where it happened.

use super::Reading;
use crate::frame::Frame;
use crate::lexicon::Lexicon;
use crate::token::{Sentence, Token, number, word};
use crate::world::SUBJECT;
use recrash_model::account::{Act, Fact, Place, PlaceKind, RoadFeature, Source};
use recrash_model::template::RoadType;

/// Words behind a garage or a lot that name the way into it.
const WAYS_IN: [&str; 4] = ["entrance", "entry", "driveway", "gate"];

/// What words and columns tell of the place.
pub(crate) fn place(reading: &Reading<'_>) -> Place {
    let story = &reading.story;
    let mut place = Place::default();
    for (number, (sentence, standing)) in story.sentences.iter().zip(&story.standing).enumerate() {
        if *standing || is_after(reading, sentence.first) {
            continue;
        }
        features(reading, &mut place, *sentence);
        kerbs(reading, &mut place, number, *sentence);
        ways_off(reading, &mut place, *sentence);
        at_junctions(reading, &mut place, number, *sentence);
        in_slip_lanes(reading, &mut place, number, *sentence);
        kind(reading, &mut place, number, *sentence);
        lanes(reading, &mut place, sentence.first, sentence.end);
    }
    columns(reading, &mut place);
    place
}

/// Features of the road that a sentence names.
fn features(reading: &Reading<'_>, place: &mut Place, sentence: Sentence) {
    let words = &reading.story.tokens[sentence.first..sentence.end];
    for (feature, at, length) in Lexicon::get().features(words) {
        // "Through a narrow gap between two trucks" tells nothing of the street.
        let of_gap = feature == RoadFeature::NarrowStreet
            && words.get(at + length).is_some_and(|next| matches!(next.text.as_str(), "gap" | "space" | "margin"));
        if !of_gap && !place.features.iter().any(|known| known.value == feature) {
            place.features.push(reading.told(feature, sentence.first + at, sentence.first + at + length));
        }
    }
}

/// The kind of place that a sentence names first, unless somebody only turns into it or comes out of it.
fn kind(reading: &Reading<'_>, place: &mut Place, number: usize, sentence: Sentence) {
    let words = &reading.story.tokens[sentence.first..sentence.end];
    for (kind, at, length) in Lexicon::get().places(words) {
        // Somebody turns into it.
        let way_in = words.get(at + length).is_some_and(|next| WAYS_IN.contains(&next.text.as_str()));
        // "exited a garage", "turned into a garage", "came to the exit of a garage": there it came from, or went to.
        let way_out = at > 0
            && words[at.saturating_sub(4)..at].iter().any(|before| {
                matches!(
                    before.text.as_str(),
                    "exited" | "exiting" | "exit" | "leaving" | "into" | "out" | "enter" | "entered" | "entrance"
                )
            });
        let off_street = matches!(kind, PlaceKind::Alley | PlaceKind::Garage);
        let aside = way_in && (off_street || kind == PlaceKind::ParkingLot) || way_out && off_street;
        // "A van traveling in an alley pulled out", "a van driving through a garage", told of one that drives along a street.
        let of_other = off_street && is_told_of_another(reading, number, sentence.first + at);
        if place.kind.is_none() && !(of_other && column_is_road(reading)) && !aside {
            place.kind = Some(reading.told(kind, sentence.first + at, sentence.first + at + length));
        }
    }
}

/// What the columns tell of the place.
fn columns(reading: &Reading<'_>, place: &mut Place) {
    let record = reading.record;
    let column = record.road.known().map(|road| match road {
        RoadType::Intersection => PlaceKind::Intersection,
        RoadType::TrafficCircle => PlaceKind::Circle,
        RoadType::Highway => PlaceKind::Highway,
        RoadType::Street | RoadType::RuralRoad => PlaceKind::Street,
        RoadType::ParkingLot => PlaceKind::ParkingLot,
        RoadType::ParkingGarage => PlaceKind::Garage,
        RoadType::UnpavedRoad => PlaceKind::Other,
    });
    let finer = matches!(place.kind.as_ref().map(|kind| kind.value), Some(PlaceKind::Alley | PlaceKind::Garage));
    if let Some(column) = column.filter(|_| !finer) {
        place.kind = Some(Fact::of_column(column, "Roadway Type"));
    }
    if record.work_zone && !place.features.iter().any(|known| known.value == RoadFeature::WorkZone) {
        place.features.push(Fact::of_column(RoadFeature::WorkZone, "Roadway Description"));
    }
    place.posted_mps = record.posted_speed_mps.map(|limit| Fact::of_column(limit, "Posted Speed Limit (MPH)"));
    place.surface = record.surface.map(|surface| Fact::of_column(surface, "Roadway Surface"));
    place.lighting = record.lighting.map(|lighting| Fact::of_column(lighting, "Lighting"));
    place.weather = record.weather.iter().map(|weather| Fact::of_column(*weather, "Weather")).collect();
}

/// Whether what stands at this token of a sentence is told of another than the subject vehicle.
fn is_told_of_another(reading: &Reading<'_>, number: usize, token: usize) -> bool {
    let here = reading.story.frames.iter().rfind(|frame| frame.sentence == number && frame.first <= token);
    here.is_some_and(|frame| frame.who.is_some_and(|who| who != SUBJECT) && frame.object != Some(SUBJECT))
}

/// Whether the column says that it was on a road.
fn column_is_road(reading: &Reading<'_>) -> bool {
    matches!(reading.record.road.known(), Some(RoadType::Street | RoadType::Intersection | RoadType::RuralRoad))
}

/// Words that lead to a kerb at which somebody stands.
const TO_KERB: [&str; 9] = ["at", "near", "by", "beside", "along", "against", "to", "toward", "towards"];

/// So many bytes stand between the words that somebody stood and those for the kerb, at most. [bytes]
const NEAR_STAND: usize = 50;

/// "was parked near the curb", "pulled toward the right curb and stopped": each mention of a kerb at which somebody stands, whatever else of
/// the kind was named before.
fn kerbs(reading: &Reading<'_>, place: &mut Place, number: usize, sentence: Sentence) {
    let tokens = &reading.story.tokens;
    let partly = (sentence.first..sentence.end).any(|at| matches!(word(tokens, at), "partially" | "partly"));
    for curb in (sentence.first..sentence.end).filter(|at| word(tokens, *at) == "curb" && !partly) {
        let Some(first) = leads_to_kerb(tokens, sentence.first, curb) else { continue };
        let (start, end) = (tokens[first].start, tokens[curb].end);
        let named = |fact: &Fact<RoadFeature>| {
            fact.value == RoadFeature::ParkingLane
                && matches!(&fact.source, Source::Words { start, end, .. } if *start < tokens[curb].end && tokens[curb].start < *end)
        };
        let stands = |frame: &Frame| {
            let (from, to) = (tokens[frame.first].start, tokens[frame.end - 1].end);
            let near = to <= start && start - to < NEAR_STAND || end <= from && from - end < NEAR_STAND;
            frame.sentence == number && near && frame.happened() && is_stand(frame.act())
        };
        if !place.features.iter().any(named) && reading.story.frames.iter().any(stands) {
            place.features.push(reading.told(RoadFeature::ParkingLane, first, curb + 1));
        }
    }
}

fn is_stand(act: Option<Act>) -> bool {
    matches!(act, Some(Act::Hold | Act::Stop | Act::Park | Act::PullOver))
}

/// The token of "at" in "at the northwest-bound curb", where these words lead to the kerb that is named here.
fn leads_to_kerb(tokens: &[Token], from: usize, curb: usize) -> Option<usize> {
    let tells = |at: &usize| {
        let compass = ["north", "south", "east", "west"].iter().any(|stem| word(tokens, *at).starts_with(stem));
        compass || matches!(word(tokens, *at), "left" | "right" | "near" | "bound" | "side" | "hand" | "outer")
    };
    let lane = tokens.get(curb + 1).is_some_and(|next| matches!(next.text.as_str(), "lane" | "cut" | "ramp"));
    let told = (from..curb).rev().take(2).take_while(tells).count();
    let article =
        curb.checked_sub(told + 1).filter(|at| *at >= from && matches!(word(tokens, *at), "the" | "a" | "its"));
    let at = article?.checked_sub(1)?;
    (!lane && at >= from && TO_KERB.contains(&word(tokens, at))).then_some(at)
}

/// Words that lead to a junction at which somebody is, and those of who is elsewhere: "near the intersection", "after the intersection".
const AT_JUNCTION: [&str; 8] = ["at", "for", "approach", "approached", "approaching", "reached", "reaching", "towards"];
const OFF_JUNCTION: [&str; 19] = [
    "prior",
    "leaving",
    "exiting",
    "clearing",
    "near",
    "after",
    "following",
    "pass",
    "passed",
    "passing",
    "past",
    "through",
    "of",
    "before",
    "beyond",
    "from",
    "behind",
    "entered",
    "between",
];

/// "in a queue of traffic at the intersection", "as it approached the junction": each junction at which the subject vehicle is told to be.
fn at_junctions(reading: &Reading<'_>, place: &mut Place, number: usize, sentence: Sentence) {
    let named =
        |at: &usize| matches!(reading.story.word(*at), "intersection" | "junction" | "t-intersection" | "t-junction");
    for at in (sentence.first..sentence.end).filter(named) {
        if let Some(lead) = leads_there(reading, number, (sentence.first, at), &AT_JUNCTION) {
            place.features.push(reading.told(RoadFeature::Intersection, lead, at + 1));
        }
    }
}

/// "was stopped in the right turn slip lane": each slip lane in which the subject vehicle is told to be.
fn in_slip_lanes(reading: &Reading<'_>, place: &mut Place, number: usize, sentence: Sentence) {
    for at in (sentence.first..sentence.end).filter(|at| matches!(reading.story.word(*at), "slip" | "channelized")) {
        let lane = (at + 1..at + 5).find(|at| reading.story.word(*at) == "lane");
        let lead = leads_there(reading, number, (sentence.first, at), &["in", "on", "into"]);
        if let Some((lane, lead)) = lane.zip(lead) {
            place.features.push(reading.told(RoadFeature::Merge, lead, lane + 1));
        }
    }
}

/// The token of the words before a place that lead the subject vehicle there: of those that lead elsewhere too the last.
fn leads_there(reading: &Reading<'_>, number: usize, (from, at): (usize, usize), leads: &[&str]) -> Option<usize> {
    let before = (at.saturating_sub(6).max(from)..at).rev().take_while(|at| reading.story.word(*at) != ",");
    let tells =
        |at: &usize| leads.contains(&reading.story.word(*at)) || OFF_JUNCTION.contains(&reading.story.word(*at));
    let lead = before.into_iter().find(tells)?;
    (leads.contains(&reading.story.word(lead)) && !is_told_of_another(reading, number, lead)).then_some(lead)
}

/// So many words lie between a turn and the way off the street at which it is made, at most. [tokens]
const NEAR_TURN: usize = 12;

/// "turned left into a parking lot", "a right turn into an alley", "was turning out of a driveway", "left a garage and turned right": each way off
/// the street by which somebody turns, with the words for that, whatever of the kind was named before.
fn ways_off(reading: &Reading<'_>, place: &mut Place, sentence: Sentence) {
    let tokens = &reading.story.tokens[sentence.first..sentence.end];
    for (feature, at, length) in Lexicon::get().features(tokens) {
        let way = matches!(
            feature,
            RoadFeature::Driveway | RoadFeature::ParkingLot | RoadFeature::Garage | RoadFeature::Alley
        );
        if let Some((first, end)) = way.then(|| turns_off(tokens, at, at + length)).flatten() {
            place.features.push(reading.told(feature, sentence.first + first, sentence.first + end));
        }
    }
}

/// The words from a turn to the way off the street into which it leads, or out of which; or from that to the turn behind it.
fn turns_off(tokens: &[Token], at: usize, end: usize) -> Option<(usize, usize)> {
    let turns = |at: &usize| {
        matches!(word(tokens, *at), "turn" | "turns" | "turned" | "turning")
            && (*at == 0 || word(tokens, *at - 1) != "-")
    };
    // "in the left lane" leaves nothing.
    let left = |at: usize| word(tokens, at) == "left" && matches!(word(tokens, at + 1), "a" | "an" | "the" | "its");
    let leaves = |at: usize| matches!(word(tokens, at), "exit" | "exited" | "exiting" | "leaving") || left(at);
    let leads = |at: usize| {
        matches!(word(tokens, at), "into" | "toward" | "towards" | "from") || leaves(at) && word(tokens, at) != "left"
    };
    let out = |at: usize| word(tokens, at) == "out" && word(tokens, at + 1) == "of";
    // "toward the left lane next to a parking lot" leads to the lane.
    let same_clause = |at: &usize| {
        !matches!(word(tokens, *at), "," | ";" | "when" | "while" | "as" | "near" | "next" | "beside" | "past" | "by")
    };
    let before = (at.saturating_sub(NEAR_TURN)..at).rev().take_while(same_clause).find(turns);
    if let Some(first) = before.filter(|first| (*first..at).any(|at| leads(at) || out(at))) {
        return Some((first, end));
    }
    let first = (at.saturating_sub(5)..at).rev().take_while(same_clause).find(|at| leaves(*at))?;
    let last = (end..end + 4).take_while(|at| word(tokens, *at) != ".").find(turns)?;
    Some((first, last + 1))
}

/// Sentences behind the one of the contact tell of where they drove then.
fn is_after(reading: &Reading<'_>, token: usize) -> bool {
    token >= reading.until()
}

/// "a T-intersection", "the T junction": three roads meet.
fn is_tee(tokens: &[Token], at: usize) -> bool {
    let word = |ahead: usize| word(tokens, at + ahead);
    let joined = matches!(word(0), "t-intersection" | "t-junction");
    let behind = if word(1) == "-" { word(2) } else { word(1) };
    joined || matches!(word(0), "t" | "tee") && matches!(behind, "intersection" | "junction")
}

/// "the left of two lanes", "a two-lane road", "4-way".
fn lanes(reading: &Reading<'_>, place: &mut Place, first: usize, end: usize) {
    let tokens = &reading.story.tokens;
    for at in first..end {
        if place.arms.is_none() && is_tee(tokens, at) {
            place.arms = Some(reading.told(3, at, at + 1));
        }
        // "in the single lane".
        let word = |ahead: usize| word(tokens, at + ahead);
        // "a single lane change", "a single lane of traffic" tell nothing of the road.
        let of_lane = matches!(word(2), "change" | "changes" | "shift" | "merge" | "closure")
            || (word(2), word(3)) == ("of", "traffic");
        // "the only lane that was open" is one of several.
        let of_some = matches!(word(2), "that" | "which" | "open" | "not" | "available");
        let only = (word(0), word(1)) == ("only", "lane") && at > first && tokens[at - 1].text == "the" && !of_some;
        let single = (word(0) == "single" && !of_lane || only).then_some(1);
        let Some(number) = number(&tokens[at].text).or(single) else { continue };
        let next: Vec<&str> = tokens[at + 1..end.min(at + 5)].iter().map(|token| token.text.as_str()).collect();
        let lanes = next.iter().position(|word| matches!(*word, "lanes" | "lane"));
        let plain = lanes.is_some_and(|lanes| {
            next[..lanes].iter().all(|word| {
                matches!(
                    *word,
                    "through"
                        | "travel"
                        | "northbound"
                        | "southbound"
                        | "eastbound"
                        | "westbound"
                        | "traffic"
                        | "total"
                )
            })
        });
        // "a one-way, one-lane street".
        let word =
            |back: usize| at.checked_sub(back).filter(|at| *at >= first).map_or("", |at| tokens[at].text.as_str());
        let of = matches!(word(1), "of" | "a" | "with" | "has" | "the") || (word(2), word(1)) == ("way", ",");
        let number = if is_both_ways(reading, (first, at, end)) { number / 2 } else { number };
        if plain && of && place.lanes.is_none() && (1..=8).contains(&number) {
            place.lanes = Some(reading.told(number, at, at + 2));
        }
        let arms = matches!(next.first(), Some(&"way"))
            && matches!(next.get(1), Some(&("stop" | "intersection" | "junction")));
        if arms && place.arms.is_none() && (3..=8).contains(&number) {
            place.arms = Some(reading.told(number, at, at + 3));
        }
    }
}

/// "a two-lane road", "a four-lane highway": half of them lead each way; not "a two-lane one-way street", "the right lane of a two-lane road".
fn is_both_ways(reading: &Reading<'_>, (first, at, end): (usize, usize, usize)) -> bool {
    let road = matches!(reading.story.word(at + 2), "road" | "street" | "highway" | "stretch")
        && reading.story.word(at + 1) == "lane";
    let told = |words: (&str, &str)| {
        reading.story.tokens.windows(2).any(|pair| (pair[0].text.as_str(), pair[1].text.as_str()) == words)
    };
    // "in the left lane of a two-lane road. A van in the right lane": both lead one way.
    let two = matches!(reading.story.word(at), "two" | "2") && told(("left", "lane")) && told(("right", "lane"));
    let one_way = two || told(("one", "way"));
    let of_lane = (first.max(at.saturating_sub(3))..at).any(|at| matches!(reading.story.word(at), "lane" | "lanes"));
    let way = (at + 3..end.min(at + 5)).any(|at| crate::chunk::bound(reading.story.word(at)).is_some());
    let any = at > first && reading.story.word(at - 1) == "a";
    road && any && matches!(reading.story.word(at), "two" | "2" | "four" | "4") && !one_way && !of_lane && !way
}
