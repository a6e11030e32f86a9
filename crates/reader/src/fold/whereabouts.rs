//! Where others than the two are, seen from the subject vehicle.

use super::Reading;
use super::origin::{Clues, first_relation, side_of_lane, side_of_road_of};
use crate::frame::{Frame, zone_of};
use crate::lexicon::{Relation, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Fact, KindGroup, LaneWord, LeftRight, Origin};

/// Where somebody else is: as told; else in its lane, beside that of the subject vehicle, or by the directions of the two.
pub(crate) fn place_of(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Origin>> {
    let clues = Clues { reading, actor };
    let relation = first_relation(&clues);
    // Whom the subject vehicle goes around was in its way, and is beside it only then.
    let passed = |frame: &Frame| {
        frame.who == Some(SUBJECT)
            && frame.act() == Some(Act::Pass)
            && frame.object == Some(actor)
            && frame.side.is_some()
    };
    let relation = relation.filter(|relation| {
        !matches!(relation, Relation::Left | Relation::Right) || !reading.story.frames.iter().any(passed)
    });
    let value = match relation {
        Some(Relation::Behind) => Some(Origin::Behind),
        Some(Relation::Ahead) => Some(Origin::Ahead),
        Some(Relation::Left) => Some(Origin::Beside { side: LeftRight::Left }),
        Some(Relation::Right) => Some(Origin::Beside { side: LeftRight::Right }),
        Some(Relation::Opposite) => Some(Origin::Opposite),
        Some(Relation::Same | Relation::Beside) | None => None,
    };
    let told = value.zip(relation).map(|(value, relation)| Fact { value, source: clues.has(relation) });
    told.or_else(|| behind_partner(reading, actor))
        .or_else(|| in_queue(&clues))
        .or_else(|| in_other_lane(&clues))
        .or_else(|| by_directions(&clues))
        .or_else(|| at_side_of_road(&clues))
}

/// "a man standing on the south side of the road": left of who goes west.
fn at_side_of_road(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let (reading, actor) = (clues.reading, clues.actor);
    let own = reading.story.world.actors[SUBJECT].heading.map(|(compass, ..)| compass);
    let stands = |act: Option<Act>| matches!(act, Some(Act::Hold | Act::Stop));
    let walks = reading.story.world.actors[actor].kind.is_some_and(|kind| kind.group() == KindGroup::OnFoot);
    let turned = reading.did(SUBJECT, Act::Turn) || reading.did(SUBJECT, Act::UTurn);
    let side = side_of_road_of(reading, actor, own, stands).filter(|_| walks && !turned)?;
    let frame = reading.before(actor).find(|(_, frame)| stands(frame.act()))?.1;
    Some(Fact { value: Origin::Beside { side }, source: reading.of(frame) })
}

/// Who struck the rear of a partner that is behind came from behind too.
fn behind_partner(reading: &Reading<'_>, actor: Actor) -> Option<Fact<Origin>> {
    let partner = reading.contacts.partner?;
    let rear = |frame: &Frame| {
        let on = frame.on.as_ref().and_then(zone_of);
        frame.sense == Sense::RearEnd || on.is_some_and(|zone| zone.is_rear())
    };
    let struck = reading.contacts.earlier.iter().map(|number| &reading.story.frames[*number]);
    let frame =
        struck.into_iter().find(|frame| frame.who == Some(actor) && frame.object == Some(partner) && rear(frame))?;
    let behind = first_relation(&Clues { reading, actor: partner }) == Some(Relation::Behind);
    let across = by_directions(&Clues { reading, actor }).is_some();
    (behind && !across).then(|| Fact { value: Origin::Behind, source: reading.of(frame) })
}

/// The queue in which the subject vehicle stands is ahead of it.
fn in_queue(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let story = &clues.reading.story;
    let (first, end) = story.world.actors[clues.actor].kind_tokens?;
    let from = first.checked_sub(2)?;
    let queue = ["queue", "line"].contains(&story.tokens[from].text.as_str()) && story.tokens[from + 1].text == "of";
    let stands = |frame: &Frame| {
        let sentence = story.sentences[frame.sentence];
        let stands = matches!(frame.act(), Some(Act::Hold | Act::Stop)) && frame.who == Some(SUBJECT);
        stands
            && frame.first < first
            && first < sentence.end
            && !story.frames.iter().any(|other| between(frame, other, first))
    };
    let held = queue && story.frames.iter().any(stands);
    held.then(|| clues.reading.told(Origin::Ahead, from, end))
}

/// Whether a frame of somebody else stands between another frame and a token.
fn between(frame: &Frame, other: &Frame, token: usize) -> bool {
    other.who != frame.who && other.first > frame.first && other.first < token
}

/// Somebody in another lane than the subject vehicle, where that keeps its own.
fn in_other_lane(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let reading = clues.reading;
    let (own, _, _) = reading.story.world.actors[SUBJECT].lane?;
    if reading.did(SUBJECT, Act::LaneChange) || reading.did(SUBJECT, Act::Turn) {
        return None;
    }
    let beside = |side: LeftRight| Origin::Beside { side };
    if let Some((lane, first, end)) = reading.story.world.actors[clues.actor].lane {
        return Some(reading.told(beside(side_of_lane(own, lane)?), first, end));
    }
    // In the adjacent lane: of the leftmost one on the right.
    let side = match own {
        LaneWord::Left | LaneWord::LeftTurn => LeftRight::Right,
        LaneWord::Right | LaneWord::RightTurn => LeftRight::Left,
        _ => return None,
    };
    clues.any(Relation::Beside).then(|| Fact { value: beside(side), source: clues.has(Relation::Beside) })
}

/// Somebody who is told to go the other way, or across.
fn by_directions(clues: &Clues<'_>) -> Option<Fact<Origin>> {
    let actors = &clues.reading.story.world.actors;
    let ((own, ..), (other, first, end)) = (actors[SUBJECT].heading?, actors[clues.actor].heading?);
    let value = match own.eighths_to(other) {
        2 => Origin::Cross { side: LeftRight::Left },
        4 => Origin::Opposite,
        6 => Origin::Cross { side: LeftRight::Right },
        _ => return None,
    };
    Some(clues.reading.told(value, first, end))
}
