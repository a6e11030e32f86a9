//! Whose door it is that somebody in a vehicle opens: "one of its passengers opened", "somebody opened a door of that car".

use super::Frame;
use crate::lexicon::Sense;
use crate::token::{Sentence, Token};
use crate::world::{Actor, SUBJECT, World};
use recrash_model::account::{Act, Kind, KindGroup};

/// Gives doors that are opened to the vehicles they belong to.
pub(super) fn settle(frames: &mut [Frame], tokens: &[Token], sentences: &[Sentence], world: &World) {
    for number in 0..frames.len() {
        let frame = &frames[number];
        if !matches!(frame.act(), Some(Act::OpenDoor)) || frame.passive {
            continue;
        }
        let who = frame.who;
        let of_them = one_of_them(frame, tokens, sentences) && who != Some(SUBJECT);
        let owner = if of_them {
            of_vehicle(frames, number, world)
        } else if one_of_ours(frame, tokens, sentences) {
            Some(SUBJECT)
        } else if who.is_some_and(|who| is_somebody(world, who)) {
            of_vehicle(frames, number, world)
        } else {
            None
        };
        let Some(owner) = owner.filter(|owner| Some(*owner) != who) else { continue };
        let sentence = frame.sentence;
        let somebody = who.filter(|who| is_somebody(world, *who));
        for other in frames[number..].iter_mut().filter(|other| other.sentence == sentence) {
            if of_them && other.who == who {
                other.who = Some(owner);
            }
            // "..., and it hit the vehicle": the door did.
            let door = other.is_contact() && somebody.is_some();
            if other.who == who && (door || other.act() == Some(Act::OpenDoor)) {
                (other.who, other.with) = (Some(owner), other.with.take().filter(|piece| piece.door));
            }
        }
    }
}

/// "hit that door", "caught the open door": it touches whose door was opened last.
pub(super) fn touched(frames: &mut [Frame], tokens: &[Token]) {
    let mut opened: Option<Actor> = None;
    for frame in frames {
        if frame.act() == Some(Act::OpenDoor) && frame.happened() {
            opened = frame.who.or(opened);
        }
        let door = || {
            let words = &tokens[frame.first..tokens.len().min(frame.end + 4)];
            let at = words.iter().position(|token| token.text == "door")?;
            at.checked_sub(1).map(|before| words[before].text.as_str())
        };
        let hits = frame.is_contact() && frame.object.is_none() && frame.who.is_some() && frame.who != opened;
        if hits && matches!(door(), Some("the" | "that" | "this" | "open" | "opened" | "opening")) {
            frame.object = opened;
        }
    }
}

/// "one of our passengers", "one of them" who got out of the subject vehicle.
fn one_of_ours(frame: &Frame, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let from = sentences[frame.sentence].first.max(frame.first.saturating_sub(6));
    let words: Vec<&str> = tokens[from..frame.first].iter().map(|token| token.text.as_str()).collect();
    let people = |word: &str| matches!(word, "passengers" | "riders" | "occupants" | "customers" | "them");
    let Some(at) = words.windows(2).rposition(|pair| pair == ["one", "of"]) else { return false };
    let rest = &words[at + 2..];
    rest.iter().any(|word| people(word)) && !rest.contains(&"of")
}

/// "the driver of one of them", "of one of those", of cars in a row: whose doors are no passenger's of ours.
fn one_of_them(frame: &Frame, tokens: &[Token], sentences: &[Sentence]) -> bool {
    let from = sentences[frame.sentence].first.max(frame.first.saturating_sub(6));
    let words: Vec<&str> = tokens[from..frame.first].iter().map(|token| token.text.as_str()).collect();
    words.windows(4).any(|four| matches!(four, ["of", "one", "of", "them" | "the" | "those" | "these"]))
}

/// Somebody on foot who was brought on by these words alone.
fn is_somebody(world: &World, actor: Actor) -> bool {
    let known = &world.actors[actor];
    actor != SUBJECT && known.kind == Some(Kind::Pedestrian) && !known.announced
}

/// The vehicle that the words name, else the one that was told of last as standing there.
fn of_vehicle(frames: &[Frame], number: usize, world: &World) -> Option<Actor> {
    let vehicle = |actor: Actor| {
        actor != SUBJECT
            && world.actors[actor].kind.is_some_and(|kind| matches!(kind.group(), KindGroup::Car | KindGroup::Truck))
    };
    let named = frames[number].object.filter(|actor| vehicle(*actor));
    named.or_else(|| {
        let stood = |frame: &&Frame| frame.sense == Sense::Parked || frame.act().is_some_and(Act::stands);
        frames[..number].iter().rev().filter(stood).filter_map(|frame| frame.who).find(|actor| vehicle(*actor))
    })
}
