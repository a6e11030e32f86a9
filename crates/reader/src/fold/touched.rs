//! Where somebody was touched, as the words tell it.

use super::Reading;
use crate::chunk::Piece;
use crate::frame::{Frame, zone_of};
use crate::lexicon::{Relation, Sense};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, EarlierTouch, Fact, Kind};
use recrash_model::zones::ContactZone;

/// Zones of the contact that is the crash.
pub(super) fn zones(reading: &Reading<'_>, actor: Actor) -> Vec<Fact<ContactZone>> {
    let Some(first) = reading.contacts.first else { return dropped_wheel(reading, actor).into_iter().collect() };
    let partner = reading.contacts.partner;
    let mut all: Vec<Fact<ContactZone>> = Vec::new();
    // What the crash told again leaves out stands where it was told first.
    let frames = || reading.story.frames.iter().enumerate();
    for (number, frame) in frames().skip(first).chain(frames().take(first)) {
        let pair = [frame.who, frame.object];
        let ours = frame.is_contact()
            && (pair.contains(&partner) && (pair.contains(&Some(SUBJECT)) || pair.contains(&None))
                // "causing a scrape on its door".
                || frame.sentence == reading.story.frames[first].sentence && pair == [None, Some(SUBJECT)]
                // "It struck a plate. Contact was made at the underside."
                || frame.sense == Sense::ContactMade
                    && frame.sentence == reading.story.frames[first].sentence + 1
                    && pair == [None, Some(SUBJECT)]);
        let same = number == first || (all.is_empty() && ours);
        if !same {
            continue;
        }
        let piece = if frame.who == Some(actor) {
            frame.with.as_ref()
        } else if frame.object == Some(actor) || (frame.object.is_none() && actor == SUBJECT) {
            frame.on.as_ref()
        // "The two made contact, left side to left side."
        } else if pair == [None, None] {
            frame.with.as_ref()
        } else {
            None
        };
        let behind_run = frame.sense == Sense::RearEnd;
        // "the open rear door of the car": one of its sides, whichever.
        let car = || {
            let kind = reading.story.world.actors[actor].kind;
            matches!(kind, Some(Kind::PassengerCar | Kind::Suv | Kind::Pickup))
        };
        let side_door = |piece: &&Piece| piece.door && piece.open && zone_of(piece) == Some(ContactZone::Rear) && car();
        let zone = piece.filter(|piece| !side_door(piece)).and_then(zone_of).or_else(|| {
            let struck = frame.object == Some(actor)
                || (frame.object.is_none() && frame.who.is_some() && frame.who != Some(actor));
            match (behind_run, struck) {
                (true, true) => Some(ContactZone::Rear),
                (true, false) => Some(ContactZone::Front),
                _ => None,
            }
        });
        let from_behind =
            frame.is_contact() && frame.relations.iter().any(|(relation, _)| *relation == Relation::Behind);
        let zone = zone.or_else(|| (from_behind && frame.object == Some(actor)).then_some(ContactZone::Rear));
        if let Some(zone) = zone {
            let source = of_trailer(reading, actor, frame).map(|(first, end)| reading.words(first, end));
            all.push(Fact { value: zone, source: source.unwrap_or_else(|| reading.of(frame)) });
        }
    }
    if all.is_empty() {
        let column = if actor == SUBJECT { &reading.record.sv_zones } else { &reading.record.cp_zones };
        all.extend(told_besides(reading, actor, first, column.is_empty()));
    }
    all
}

/// "its front right wheel dropped off the paved road", "fell into the trench": where that wheel is. "came off" loses it.
fn dropped_wheel(reading: &Reading<'_>, actor: Actor) -> Option<Fact<ContactZone>> {
    const ROADS: [&str; 9] = ["road", "roadway", "pavement", "edge", "lane", "hole", "trench", "ditch", "asphalt"];
    let drops = |frame: &&Frame| {
        let behind = &reading.story.tokens[frame.end - 1..reading.story.sentences[frame.sentence].end];
        let (off, road) = (behind.iter().take(2), behind.iter().skip(1).take(DROPS_WITHIN));
        let down = off.into_iter().any(|token| matches!(token.text.as_str(), "off" | "into" | "in" | "down" | "from"));
        frame.act() == Some(Act::Fall)
            && frame.who == Some(SUBJECT)
            && frame.happened()
            && down
            && road.into_iter().any(|token| ROADS.contains(&token.text.as_str()))
    };
    let frame = reading.story.frames.iter().filter(|_| actor == SUBJECT).find(drops)?;
    let zone = frame.with.as_ref().and_then(zone_of)?;
    Some(Fact { value: zone, source: reading.of(frame) })
}

/// The road off which a wheel drops is named so near behind. [tokens]
const DROPS_WITHIN: usize = 4;

/// How the partner and another touched before the crash: whose part met which of the other.
pub(super) fn earlier(reading: &Reading<'_>, frame: &Frame) -> Option<Fact<EarlierTouch>> {
    let by_partner = frame.who == reading.contacts.partner;
    let run = |zone: ContactZone| (frame.sense == Sense::RearEnd).then_some(zone);
    let of_who = frame.with.as_ref().and_then(zone_of).or(run(ContactZone::Front));
    let of_object = frame.on.as_ref().and_then(zone_of).or(run(ContactZone::Rear));
    let (of_partner, of_other) = if by_partner { (of_who, of_object) } else { (of_object, of_who) };
    let told = of_partner.is_some() || of_other.is_some();
    told.then(|| Fact { value: EarlierTouch { by_partner, of_partner, of_other }, source: reading.of(frame) })
}

/// Whether it is told that the trailer of somebody touched.
pub(super) fn by_trailer(reading: &Reading<'_>, actor: Actor) -> bool {
    let contact = reading.contacts.first.map(|number| &reading.story.frames[number]);
    contact.is_some_and(|frame| of_trailer(reading, actor, frame).is_some())
}

/// Words between the name of a part and "trailer", or between that and the verb, where it is the trailer's: "the left side of the long flat
/// trailer that the truck drew".
const OF_TRAILER_WITHIN: usize = 8;

/// Words for a part of a trailer.
const PARTS: [&str; 11] =
    ["side", "corner", "end", "rear", "front", "back", "left", "right", "driver", "passenger", "middle"];

/// The tokens of "the left side of its trailer", where that touches.
fn of_trailer(reading: &Reading<'_>, actor: Actor, frame: &Frame) -> Option<(usize, usize)> {
    let sentence = reading.story.sentences[frame.sentence];
    let (from, to) = if frame.who == Some(actor) {
        (frame.first.saturating_sub(2 * OF_TRAILER_WITHIN).max(sentence.first), frame.first)
    } else if frame.object == Some(actor) {
        (frame.first, frame.end)
    } else {
        return None;
    };
    // What stands behind another clause is told of that.
    let from = (from..to)
        .rfind(|&at| matches!(reading.story.word(at), "," | ";" | "and" | "when" | "as" | "while"))
        .map_or(from, |at| at + 1);
    let trailer = (from..to).rfind(|&at| reading.story.word(at) == "trailer")?;
    let part = |at: &usize| PARTS.contains(&reading.story.word(*at));
    let first = (trailer.saturating_sub(OF_TRAILER_WITHIN).max(from)..trailer).find(part)?;
    let article =
        first.checked_sub(1).filter(|at| *at >= from && matches!(reading.story.word(*at), "the" | "its" | "a"));
    (to - trailer <= OF_TRAILER_WITHIN).then(|| (article.unwrap_or(first), trailer + 1))
}

/// "struck the parked van, damaging its bumper and left headlamp", of a column that ticks both corners of the front: the left one.
pub(super) fn keep_damaged_side(reading: &Reading<'_>, zones: &mut Vec<Fact<ContactZone>>) {
    use ContactZone as Z;
    let Some(crash) = reading.contacts.first.map(|number| &reading.story.frames[number]) else { return };
    let damages = |frame: &&Frame| {
        frame.sense == Sense::Damage
            && frame.sentence == crash.sentence
            && !frame.negated
            && frame.first > crash.first
            && (frame.object == Some(SUBJECT) || frame.on.is_some() && frame.object.is_none())
    };
    let Some(damage) = reading.story.frames.iter().find(damages) else { return };
    let end = reading.story.sentences[damage.sentence].end;
    let words = reading.story.tokens[damage.first..end].iter().map(|token| token.text.as_str());
    let words: Vec<&str> = words.take_while(|word| !matches!(*word, "other" | "while" | "when" | "which")).collect();
    let left = words.iter().any(|word| matches!(*word, "left" | "driver"));
    let right = words.iter().any(|word| matches!(*word, "right" | "passenger"));
    let on_left = |zone: Z| matches!(zone, Z::FrontLeft | Z::Left | Z::RearLeft);
    let on_right = |zone: Z| matches!(zone, Z::FrontRight | Z::Right | Z::RearRight);
    let ticked = |fact: &Fact<Z>| !fact.source.is_told();
    let both = zones.iter().any(|fact| on_left(fact.value)) && zones.iter().any(|fact| on_right(fact.value));
    if both && left != right && zones.iter().all(ticked) {
        zones.retain(|fact| if left { !on_right(fact.value) } else { !on_left(fact.value) });
    }
    // And where it ticks the corner of the other side alone, the words count.
    let corner = |zone: Z| matches!(zone, Z::FrontLeft | Z::FrontRight | Z::RearLeft | Z::RearRight);
    let wrong = |fact: &Fact<Z>| corner(fact.value) && if left { on_right(fact.value) } else { on_left(fact.value) };
    if left != right && !zones.is_empty() && zones.iter().all(|fact| ticked(fact) && wrong(fact)) {
        let end = |front: bool| {
            words.iter().any(|word| if front { *word == "front" } else { matches!(*word, "rear" | "back") })
        };
        let door = words.iter().any(|word| word.starts_with("door"));
        for fact in zones {
            let fronted = matches!(fact.value, Z::FrontLeft | Z::FrontRight);
            // "the left rear door", of the right front corner in the column: the words tell a side alone.
            let value = match (left, door || end(!fronted) && !end(fronted)) {
                (_, false) => mirrored(fact.value),
                (true, true) => Z::Left,
                (false, true) => Z::Right,
            };
            *fact = Fact { value, source: reading.of(damage) };
        }
    }
}

/// The zone on the other side.
const fn mirrored(zone: ContactZone) -> ContactZone {
    use ContactZone as Z;
    match zone {
        Z::Left => Z::Right,
        Z::Right => Z::Left,
        Z::FrontLeft => Z::FrontRight,
        Z::FrontRight => Z::FrontLeft,
        Z::RearLeft => Z::RearRight,
        Z::RearRight => Z::RearLeft,
        zone => zone,
    }
}

/// "the van's left door", and not "its left door".
fn names_owner(frame: &Frame) -> bool {
    frame.on.as_ref().is_some_and(|piece| piece.owner.is_some() && !piece.its)
}

/// Where somebody was touched by what the sentence of the crash says of the damage, or the headline of a rear-end crash.
/// `alone`: no column tells more than the damage does.
fn told_besides(reading: &Reading<'_>, actor: Actor, first: usize, alone: bool) -> Option<Fact<ContactZone>> {
    let frames = &reading.story.frames;
    let crash = &frames[first];
    let damage = frames[first..].iter().find(|frame| {
        let whose = match frame.object.or(frame.who.filter(|who| *who == SUBJECT)) {
            // "collided with it, damaging its bumper": of the one that was struck. "The two collided, damaging the van's bumper" names it.
            Some(owner) if frame.who == Some(owner) && owner != SUBJECT && !names_owner(frame) => SUBJECT,
            Some(owner) => owner,
            None => SUBJECT,
        };
        // "It made contact with a curb. This caused damage to its front right tire."
        let next = frame.sentence == crash.sentence + 1 && {
            let begins = &reading.story.tokens[reading.story.sentences[frame.sentence].first..];
            let word = |at: usize| word(begins, at);
            word(0) == "this" || word(0) == "the" && matches!(word(1), "contact" | "collision" | "impact")
        };
        let here = frame.sentence == crash.sentence || next;
        alone && frame.sense == Sense::Damage && here && whose == actor && !frame.negated
    });
    if let Some((frame, zone)) = damage.and_then(|frame| Some((frame, frame.on.as_ref().and_then(zone_of)?))) {
        return Some(Fact { value: zone, source: reading.of(frame) });
    }
    let headline = frames[..first].iter().rev().find(|frame| {
        frame.sense == Sense::RearEnd && frame.is_contact() && [frame.who, frame.object].contains(&Some(SUBJECT))
    })?;
    let zone = match (headline.object == Some(actor), headline.who == Some(actor)) {
        (true, false) => ContactZone::Rear,
        (false, true) => ContactZone::Front,
        _ => return None,
    };
    Some(Fact { value: zone, source: reading.of(headline) })
}
