//! What stands before and behind in the row of chunks, and what verbs and kinds allow.

use super::parser::{Carry, Parser};
use crate::chunk::{Article, Chunk, Noun, Placed};
use crate::lexicon::{Form, Relation, Sense};
use crate::world::{Actor, SUBJECT, World, same_kind};
use recrash_model::account::{Act, Kind, KindGroup};

impl Parser<'_> {
    /// Whether words that nobody knows, written large or blacked out, stand before and behind.
    pub(super) fn names_on_both_sides(&self, all: &[Placed], at: usize) -> bool {
        let name = |placed: Option<&Placed>| {
            placed.is_some_and(|placed| {
                let token = &self.tokens[placed.first];
                matches!(placed.chunk, Chunk::Word) && (token.capital || token.text.contains("xxx"))
            })
        };
        at > 0 && name(all.get(at - 1)) && name(all.get(at + 1))
    }

    /// Whether a verb that nobody knows stands between a part of one and a part of another: "its fender raked the side of the van".
    pub(super) fn touches_by_parts(&self, word: &str, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let part = carry.subject.as_ref().filter(|subject| subject.piece.is_some() && carry.last_is(Some(subject)));
        let past =
            word.len() > 3 && word.ends_with("ed") || matches!(word, "met" | "caught" | "tore" | "bent" | "broke");
        let next =
            all[at + 1..].iter().take(3).find(|placed| !matches!(placed.chunk, Chunk::Word | Chunk::Preposition(_)));
        let other = next.is_some_and(|placed| match &placed.chunk {
            Chunk::Piece(piece) => piece.owner.as_ref().is_none_or(|owner| owner.subject) || piece.its,
            Chunk::Noun(noun) => noun.subject,
            _ => false,
        });
        past && other && part.is_some() && !carry.has_verb
    }

    /// Who a noun between commas says more of: "the subject vehicle, a box truck, stood".
    pub(super) fn apposed(&self, noun: &Noun, all: &[Placed], at: usize, carry: &Carry) -> Option<Actor> {
        let before = at.checked_sub(2).map(|two| (&all[two].chunk, &all[two + 1].chunk))?;
        let (Chunk::Noun(named), Chunk::Comma) = before else { return None };
        let subject = carry.subject.as_ref().filter(|_| !carry.has_verb)?;
        let definite = named.article != Article::Indefinite && named.occupant.is_none();
        let kinds = noun.article == Article::Indefinite && noun.occupant.is_none() && !noun.several;
        let same = carry.last_is(Some(subject)) && carry.after_comma && carry.main.as_ref() == Some(subject);
        let known = self.world.actors[subject.actor].kind;
        let fits = known
            .is_none_or(|known| noun.kind.is_some_and(|kind| same_kind(known, kind) || same_kind(kind, known)))
            || subject.actor == SUBJECT && noun.kind.is_some_and(Kind::is_vehicle);
        (definite && kinds && same && fits).then_some(subject.actor)
    }
}

pub(super) fn acts(kind: Option<Kind>) -> bool {
    kind.is_none_or(|kind| kind.group() != KindGroup::Object)
}

/// Whether the verb takes an object.
pub(super) fn transitive(sense: Sense) -> bool {
    matches!(
        sense,
        Sense::Contact
            | Sense::ContactMade
            | Sense::RearEnd
            | Sense::ReverseContact
            | Sense::OpenDoorInto
            | Sense::Headline
            | Sense::Approach
            | Sense::Push
            | Sense::See
            | Sense::Damage
            | Sense::Yield
            | Sense::ExitVehicle
            | Sense::Other
            | Sense::Tow
            | Sense::Act(Act::Pass | Act::Follow | Act::LaneChange | Act::OpenDoor | Act::Cross | Act::Slow)
    )
}

pub(super) fn next_is_verb(all: &[Placed], at: usize) -> bool {
    for placed in all[at + 1..].iter().take(3) {
        match &placed.chunk {
            Chunk::Verb(_, Form::Ing | Form::Base) => return true,
            Chunk::Preposition("to") | Chunk::Word | Chunk::Be => {}
            _ => return false,
        }
    }
    false
}

/// Whether a finite verb stands behind in the same clause.
pub(super) fn another_finite(all: &[Placed], at: usize) -> bool {
    for placed in &all[at + 1..] {
        match &placed.chunk {
            Chunk::Verb(_, Form::Past | Form::Present) | Chunk::Be => return true,
            Chunk::Joint(_) | Chunk::Comma | Chunk::Relative => return false,
            _ => {}
        }
    }
    false
}

pub(super) fn next_preposition(all: &[Placed], at: usize) -> Option<&'static str> {
    all[at + 1..].iter().take(4).find_map(|placed| match placed.chunk {
        Chunk::Preposition(word) => Some(word),
        _ => None,
    })
}

/// Where the words behind a noun say that it is, seen from the subject vehicle.
pub(super) fn relation_behind(all: &[Placed], at: usize, _world: &World) -> Option<Relation> {
    match (all.get(at + 1).map(|p| &p.chunk)?, all.get(at + 2).map(|p| &p.chunk)) {
        (Chunk::Relation(relation), Some(Chunk::Noun(noun))) if noun.subject => Some(*relation),
        _ => None,
    }
}
