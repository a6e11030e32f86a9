//! Where it happened.

use super::Reading;
use crate::lexicon::Lexicon;
use crate::token::number;
use recrash_model::account::{Fact, Place, PlaceKind, RoadFeature};
use recrash_model::template::RoadType;

/// Words behind a garage or a lot that name the way into it.
const WAYS_IN: [&str; 4] = ["entrance", "entry", "driveway", "gate"];

/// What words and columns tell of the place.
pub(crate) fn place(reading: &Reading<'_>) -> Place {
    let lexicon = Lexicon::get();
    let story = &reading.story;
    let record = reading.record;
    let mut place = Place::default();
    for (sentence, standing) in story.sentences.iter().zip(&story.standing) {
        if *standing || is_after(reading, sentence.first) {
            continue;
        }
        let words = &story.tokens[sentence.first..sentence.end];
        for (feature, at, length) in lexicon.features(words) {
            if !place.features.iter().any(|known| known.value == feature) {
                place.features.push(reading.told(feature, sentence.first + at, sentence.first + at + length));
            }
        }
        for (kind, at, length) in lexicon.places(words) {
            // Somebody turns into it.
            let way_in = words.get(at + length).is_some_and(|next| WAYS_IN.contains(&next.text.as_str()));
            // "exited a garage", "turned into a garage": there it came from, or went to.
            let way_out = at > 0
                && words[at.saturating_sub(4)..at].iter().any(|before| {
                    matches!(
                        before.text.as_str(),
                        "exited" | "exiting" | "leaving" | "into" | "out" | "enter" | "entered"
                    )
                });
            let aside = way_in || way_out && kind == PlaceKind::Garage;
            if place.kind.is_none() && !(aside && matches!(kind, PlaceKind::Garage | PlaceKind::ParkingLot)) {
                place.kind = Some(reading.told(kind, sentence.first + at, sentence.first + at + length));
            }
        }
        lanes(reading, &mut place, sentence.first, sentence.end);
    }
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
    place
}

/// Sentences behind the one of the contact tell of where they drove then.
fn is_after(reading: &Reading<'_>, token: usize) -> bool {
    token >= reading.until()
}

/// "the left of two lanes", "a two-lane road", "4-way".
fn lanes(reading: &Reading<'_>, place: &mut Place, first: usize, end: usize) {
    let tokens = &reading.story.tokens;
    for at in first..end {
        let Some(number) = number(&tokens[at].text) else { continue };
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
        let of = at > first && matches!(tokens[at - 1].text.as_str(), "of" | "a" | "with" | "has" | "the");
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
