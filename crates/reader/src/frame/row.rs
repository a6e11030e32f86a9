//! What stands before and behind in the row of chunks, and what verbs and kinds allow.

use super::parser::{Carry, Parser};
use crate::chunk::{Article, Chunk, Joint, Noun, Placed};
use crate::lexicon::{Form, Relation, Sense};
use crate::token::TokenKind;
use crate::world::{Actor, SUBJECT, same_kind};
use recrash_model::account::{Act, Kind, KindGroup};

/// A verb where it stands.
#[derive(Clone, Copy)]
pub(super) struct Spoken<'a> {
    pub(super) sense: Sense,
    pub(super) form: Form,
    /// Chunks of the sentence.
    pub(super) all: &'a [Placed],
    /// Place of the verb among them.
    pub(super) at: usize,
}

impl<'a> Spoken<'a> {
    pub(super) fn placed(&self) -> &'a Placed {
        &self.all[self.at]
    }

    pub(super) fn word<'t>(&self, parser: &Parser<'t>) -> &'t str {
        parser.tokens[self.all[self.at].first].text.as_str()
    }

    pub(super) fn next(&self) -> Option<&'a Chunk> {
        self.all.get(self.at + 1).map(|placed| &placed.chunk)
    }

    pub(super) fn chunk_before(&self) -> Option<&'a Chunk> {
        self.at.checked_sub(1).map(|at| &self.all[at].chunk)
    }

    /// "double-parked" is one word as well.
    pub(super) fn is_bare(&self, parser: &Parser<'_>) -> bool {
        single(self.placed()) || self.sense == Sense::Act(Act::Park) && self.word(parser) != "pulled"
    }

    /// Whether it is done to somebody: "was struck", "was shoved back".
    pub(super) fn is_done_to(&self) -> bool {
        self.form == Form::Past
            && matches!(self.sense, Sense::Contact | Sense::RearEnd | Sense::ReverseContact | Sense::Push)
    }
}

/// Verbs of moving that may have somebody as their object.
const MOVES: [&str; 22] = [
    "drive", "drove", "driven", "driving", "move", "moved", "moving", "spin", "spun", "spinning", "slide", "slid",
    "sliding", "roll", "rolled", "rolling", "turned", "turning", "rotated", "threw", "thrown", "whirled",
];

/// A crash is named so near before what it did to somebody: "the impact between those two vehicles rotated". [tokens]
const IMPACT_WITHIN: usize = 7;

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

    /// Whether a verb that nobody knows stands between who the clause is about and an object.
    pub(super) fn does_something(&self, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let token = &self.tokens[all[at].first];
        // "A wheel came off, hopped the barrier and hit it": the second verb of a row.
        let row = carry.after_comma
            && carry.has_verb
            && carry.joint.is_none()
            && at > 0
            && matches!(all[at - 1].chunk, Chunk::Comma);
        let subject = carry
            .subject
            .as_ref()
            .filter(|subject| row || subject.end == all[at].first && subject.piece.is_none() && !carry.has_verb);
        let object =
            matches!(all.get(at + 1).map(|next| &next.chunk), Some(Chunk::Noun(noun)) if noun.article != Article::None);
        token.kind == TokenKind::Word
            && !token.capital
            && token.text.len() > 4
            && token.text.ends_with("ed")
            && subject.is_some()
            && object
            && !carry.be
            && carry.preposition.is_none()
    }

    /// Whether a word that nobody knows stands where a contact is told: between the subject vehicle and another one, or in
    /// "was ...ed by".
    pub(super) fn may_touch(&self, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let token = &self.tokens[all[at].first];
        let apart =
            ["miss", "avoid", "notic", "observ", "clear", "own", "lease", "operat", "assist", "inspect", "view"];
        let unknown = token.kind == TokenKind::Word
            && !token.capital
            && token.text.len() > 4
            && token.text.ends_with("ed")
            && !apart.iter().any(|stem| token.text.starts_with(stem))
            && self.lexicon.longest(self.tokens, all[at].first, |_| true).is_none();
        let Some(subject) = carry.subject.as_ref().filter(|_| unknown) else { return false };
        let mut behind = all[at + 1..].iter().map(|placed| &placed.chunk);
        let next = behind.next();
        if carry.be {
            let doer = matches!(behind.next(), Some(Chunk::Noun(noun)) if !noun.subject && noun.kind.is_some());
            return subject.actor == SUBJECT && matches!(next, Some(Chunk::Preposition("by"))) && doer;
        }
        let preposition = matches!(next, Some(Chunk::Preposition("with" | "into" | "against" | "along" | "onto")));
        let object = if preposition { behind.next() } else { next };
        let touched = match object {
            Some(Chunk::Piece(piece)) => piece
                .owner
                .as_ref()
                .map_or(piece.its && preposition, |owner| owner.subject != (subject.actor == SUBJECT)),
            Some(Chunk::Noun(noun)) => noun.subject != (subject.actor == SUBJECT) && noun.kind.is_some() | noun.subject,
            _ => false,
        };
        touched && self.world.actors[subject.actor].acts() && !carry.has_verb
    }

    /// Whether a relative clause tells of a thing that the lexicon does not know: "the bracket that holds it".
    pub(super) fn of_a_word(&self, all: &[Placed], at: usize) -> bool {
        let Some(before) = at.checked_sub(2) else { return false };
        let word = |placed: &Placed| {
            let token = &self.tokens[placed.first];
            matches!(placed.chunk, Chunk::Word) && token.kind == TokenKind::Word && !token.capital
        };
        matches!(self.tokens[all[at].first].text.as_str(), "that" | "which")
            && word(&all[at - 1])
            && all[at - 1].end == all[at].first
            && matches!(self.tokens[all[before].first].text.as_str(), "a" | "an" | "the" | "its")
    }

    /// Whether the clause is about two vehicles at once: "the vehicles met", "the mirrors of the two vehicles touched each other".
    pub(super) fn of_both(&self, sense: Sense, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let Some(subject) =
            carry.subject.as_ref().filter(|_| sense == Sense::Contact && !carry.be && carry.also.is_none())
        else {
            return false;
        };
        let before = &self.tokens[subject.end.saturating_sub(3)..subject.end];
        let known = before.iter().any(|token| matches!(token.text.as_str(), "the" | "both"));
        let plural = before.last().is_some_and(|token| {
            matches!(token.text.as_str(), "vehicles" | "cars" | "trucks" | "two" | "mirrors" | "bumpers" | "they")
        });
        let object = matches!(all.get(at + 1).map(|next| &next.chunk), Some(Chunk::Noun(_) | Chunk::Pronoun));
        let each_other =
            self.tokens[all[at].end..].first().is_some_and(|next| matches!(next.text.as_str(), "each" | "one"));
        self.world.actors[subject.actor].several && known && plural && (!object || each_other)
    }

    /// Whether a side is that of the subject vehicle: "on the AV's right".
    pub(super) fn side_of_subject(&self, all: &[Placed], at: usize) -> bool {
        let Some(from) = at.checked_sub(3) else { return false };
        matches!(all[from].chunk, Chunk::Preposition("on" | "to" | "from" | "at"))
            && matches!(&all[from + 1].chunk, Chunk::Noun(noun) if noun.subject)
            && self.tokens[all[from + 2].first].text == "'s"
    }

    /// Whether a verb of moving has somebody as its object: "driving it forward into the van", "the impact moved the bus", "was driven
    /// into the rear".
    pub(super) fn drives_another(&self, verb: &Spoken<'_>, carry: &Carry) -> bool {
        let Spoken { sense, form, all, at } = *verb;
        if self.whirls_whom_it_struck(verb, carry) {
            return true;
        }
        let moves = MOVES.contains(&verb.word(self));
        if !moves || !single(&all[at]) && sense != Sense::Act(Act::Follow) {
            return false;
        }
        let behind = || {
            all[at + 1..].iter().take_while(|placed| {
                !matches!(placed.chunk, Chunk::Verb(..) | Chunk::Comma | Chunk::Joint(_) | Chunk::Be | Chunk::Relative)
            })
        };
        let into = |placed: &Placed| matches!(placed.chunk, Chunk::Preposition("into" | "onto" | "against"));
        let part = behind().any(|placed| {
            matches!(placed.chunk, Chunk::Piece(_)) || matches!(&placed.chunk, Chunk::Noun(noun) if noun.subject)
        });
        if carry.be && form == Form::Past {
            // "was driven forward into the rear of": no person who drives.
            let by = behind().any(|placed| matches!(placed.chunk, Chunk::Preposition("by")));
            return !by && part && behind().any(into);
        }
        let ahead = |placed: &Placed| {
            matches!(
                self.tokens[placed.first].text.as_str(),
                "forward" | "backward" | "backwards" | "back" | "sideways"
            )
        };
        moves_vehicle(verb.next(), carry)
            && (behind().any(into) && part
                || self.is_whirled_by_impact(verb)
                || behind().any(ahead) && carry.subject.as_ref().is_none_or(|subject| subject.person.is_none()))
    }

    /// "struck the car and spun it", "rammed it and turned it around".
    fn whirls_whom_it_struck(&self, verb: &Spoken<'_>, carry: &Carry) -> bool {
        carry.row
            && carry.frame.is_some_and(|frame| self.frames[frame].is_contact())
            && matches!(verb.next(), Some(Chunk::Pronoun))
            && ["spin", "spun", "turn", "threw", "whirl", "rotat"].iter().any(|stem| verb.word(self).starts_with(stem))
    }

    /// "The impact rotated the van", "the crash spun it": what does so is nobody who drives.
    fn is_whirled_by_impact(&self, verb: &Spoken<'_>) -> bool {
        let whirls = ["spun", "spin", "rotat", "whirl"].iter().any(|stem| verb.word(self).starts_with(stem));
        let before = self.tokens[..verb.placed().first].iter().rev().take(IMPACT_WITHIN);
        let mut clause = before.map(|token| token.text.as_str()).take_while(|word| !matches!(*word, "." | "," | "and"));
        whirls && clause.any(|word| matches!(word, "impact" | "collision" | "crash"))
    }

    /// Whether a verb that nobody knows stands between a part of one and a part of another: "its fender raked the side of the van".
    pub(super) fn touches_by_parts(&self, word: &str, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let met = matches!(word, "met" | "caught");
        // "the vehicles met rear bumper to rear bumper", "it and the van met at their front corners".
        let pair = carry.also.is_some() || self.of_both(Sense::Contact, all, at, carry);
        let mut clause =
            all[at + 1..].iter().take(4).take_while(|placed| !matches!(placed.chunk, Chunk::Comma | Chunk::Joint(_)));
        let parts = clause.any(|placed| matches!(placed.chunk, Chunk::Piece(_)));
        if word == "met" && pair && parts && !carry.has_verb {
            return true;
        }
        let into =
            matches!(all.get(at + 1).map(|next| &next.chunk), Some(Chunk::Preposition("into" | "against" | "along")));
        let whole = |actor: Actor| self.world.actors[actor].acts() || met || into;
        let part = carry.subject.as_ref().filter(|subject| {
            (subject.piece.is_some() && carry.last_is(Some(subject)))
                || subject.person.is_none() && subject.actor != SUBJECT && (met || into) && whole(subject.actor)
        });
        let past = word.len() > 3 && word.ends_with("ed") || met || matches!(word, "tore" | "bent" | "broke");
        let next =
            all[at + 1..].iter().take(3).find(|placed| !matches!(placed.chunk, Chunk::Word | Chunk::Preposition(_)));
        let other = next.is_some_and(|placed| match &placed.chunk {
            Chunk::Piece(piece) => piece.owner.as_ref().is_none_or(|owner| owner.subject) || piece.its,
            Chunk::Noun(noun) => noun.subject,
            _ => false,
        });
        past && other && part.is_some() && !carry.has_verb
    }

    /// "another vehicle turning left, a sedan, drove up", "was hit by another vehicle, a taxi", "struck an object, apparently a chair, in the road":
    /// what somebody is who was named by a word that says nothing of it.
    fn apposed_late(&self, noun: &Noun, all: &[Placed], at: usize, carry: &Carry) -> Option<Actor> {
        let kind =
            noun.kind.filter(|_| noun.article == Article::Indefinite && noun.occupant.is_none() && !noun.several)?;
        let comma = all[..at].iter().rposition(|placed| !matches!(placed.chunk, Chunk::Word))?;
        let between = all[comma + 1..at].iter().all(|placed| {
            let word = self.tokens[placed.first].text.as_str();
            word.ends_with("ly") || matches!(word, "perhaps" | "likely")
        });
        let ends = matches!(all.get(at + 1).map(|placed| &placed.chunk), None | Some(Chunk::Comma));
        let generic = |actor: Actor| {
            let known = self.world.actors[actor].kind.filter(|_| actor != SUBJECT && !self.world.actors[actor].several);
            known.is_some_and(|known| {
                // "Vehicle 2, a motorcycle, in front of it".
                let rides = known == Kind::Vehicle && kind.group() == KindGroup::Motorcycle;
                rides || matches!(known, Kind::Vehicle | Kind::Object | Kind::Animal) && same_kind(known, kind)
            })
        };
        if !matches!(all[comma].chunk, Chunk::Comma) || !between {
            return None;
        }
        let named = comma.checked_sub(1).map(|at| &all[at]);
        let just = carry.last.as_ref().filter(|last| {
            last.piece.is_none()
                && named.is_some_and(|named| named.end == last.end && matches!(named.chunk, Chunk::Noun(_)))
        });
        // "our test vehicle, a Prius running autonomously".
        let own = just.is_some_and(|last| last.actor == SUBJECT) && kind.is_vehicle() && !noun.names.is_empty();
        let describes = matches!(all.get(at + 1).map(|placed| &placed.chunk), Some(Chunk::Verb(_, Form::Ing)));
        if own && (ends || describes) {
            return Some(SUBJECT);
        }
        let goes_on =
            || matches!(all.get(at + 2).map(|placed| &placed.chunk), Some(Chunk::Verb(_, Form::Past) | Chunk::Be));
        let about = carry.subject.as_ref().filter(|_| !carry.has_verb && ends && goes_on());
        let apart = ends || comma + 1 < at;
        let named = just.filter(|_| apart).or(about).map(|mention| mention.actor);
        named.filter(|actor| generic(*actor))
    }

    /// Who a noun between commas says more of: "the subject vehicle, a box truck, stood".
    pub(super) fn apposed(&self, noun: &Noun, all: &[Placed], at: usize, carry: &Carry) -> Option<Actor> {
        if let Some(actor) = self.apposed_late(noun, all, at, carry) {
            return Some(actor);
        }
        let before = at.checked_sub(2).map(|two| (&all[two].chunk, &all[two + 1].chunk))?;
        let (Chunk::Noun(named), Chunk::Comma) = before else { return None };
        let subject = carry.subject.as_ref().filter(|_| !carry.has_verb)?;
        let definite = (named.article != Article::Indefinite || named.one_of) && named.occupant.is_none();
        let kinds = noun.article == Article::Indefinite && noun.occupant.is_none() && !noun.several;
        let same = carry.last_is(Some(subject)) && carry.after_comma && carry.main.as_ref() == Some(subject);
        let known = self.world.actors[subject.actor].kind;
        let fits = known
            .is_none_or(|known| noun.kind.is_some_and(|kind| same_kind(known, kind) || same_kind(kind, known)))
            || subject.actor == SUBJECT && noun.kind.is_some_and(Kind::is_vehicle);
        (definite && kinds && same && fits).then_some(subject.actor)
    }
}

/// Whether a chunk is one word.
pub(super) fn single(placed: &Placed) -> bool {
    placed.end == placed.first + 1
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

/// "was looking at his phone": nothing that is wished.
pub(super) fn looks_somewhere(all: &[Placed], at: usize) -> bool {
    let next = all.get(at + 1).map(|placed| &placed.chunk);
    matches!(next, Some(Chunk::Preposition(word)) if !matches!(*word, "to" | "for"))
}

/// Whether a finite verb stands behind in the same clause.
pub(super) fn another_finite(all: &[Placed], at: usize) -> bool {
    let chunk = |at: usize| all.get(at).map(|placed| &placed.chunk);
    for behind in at + 1..all.len() {
        match &all[behind].chunk {
            // "stopped to let it pass": "let" is its own past.
            Chunk::Verb(..) if matches!(all[behind - 1].chunk, Chunk::Preposition("to")) => {}
            Chunk::Verb(_, Form::Past | Form::Present) | Chunk::Be => return true,
            // "a van parked behind and to the left of it reversed".
            Chunk::Joint(Joint::And) if matches!(chunk(behind + 1), Some(Chunk::Relation(_))) => {}
            Chunk::Joint(_) | Chunk::Comma | Chunk::Relative => return false,
            _ => {}
        }
    }
    false
}

/// Whether a finite verb stands right behind a comma, up to the next word that joins clauses: "stopped behind it, set off".
pub(super) fn goes_on_behind_comma(behind: &[Placed]) -> bool {
    let clause: Vec<&Chunk> = behind
        .iter()
        .map(|placed| &placed.chunk)
        .take_while(|chunk| !matches!(chunk, Chunk::Joint(_)))
        .filter(|chunk| !matches!(chunk, Chunk::Word))
        .collect();
    let finite = |chunk: &Chunk| matches!(chunk, Chunk::Verb(_, Form::Past | Form::Present) | Chunk::Be);
    clause.windows(2).any(|pair| matches!(pair[0], Chunk::Comma) && finite(pair[1]))
}

pub(super) fn next_preposition(all: &[Placed], at: usize) -> Option<&'static str> {
    all[at + 1..].iter().take(4).find_map(|placed| match placed.chunk {
        Chunk::Preposition(word) => Some(word),
        _ => None,
    })
}

/// Whether the sentence goes on to say by whom: "was rear-ended, while it stood there, by a van".
pub(super) fn names_doer(all: &[Placed], at: usize) -> bool {
    (at + 1..all.len()).any(|by| {
        let next = all[by + 1..].iter().find(|placed| !matches!(placed.chunk, Chunk::Word));
        matches!(all[by].chunk, Chunk::Preposition("by"))
            && next.is_some_and(|placed| matches!(placed.chunk, Chunk::Noun(_) | Chunk::Piece(_)))
    })
}

/// Whether a vehicle is the object of a verb of moving, and not who does it.
fn moves_vehicle(object: Option<&Chunk>, carry: &Carry) -> bool {
    match object {
        Some(Chunk::Pronoun) => true,
        Some(Chunk::Noun(noun)) => {
            let vehicle = noun.subject || noun.kind.is_some_and(Kind::is_vehicle);
            let itself = noun.subject && carry.subject.as_ref().is_some_and(|subject| subject.actor == SUBJECT);
            noun.occupant.is_none() && vehicle && !noun.several && !itself
        }
        _ => false,
    }
}

/// Where the words behind a noun say that it is, seen from the subject vehicle.
pub(super) fn relation_behind(all: &[Placed], at: usize) -> Option<Relation> {
    let chunk = |at: usize| all.get(at).map(|placed| &placed.chunk);
    let further = behind_stand(all, at);
    match (chunk(further), chunk(further + 1)) {
        (Some(Chunk::Relation(Relation::Behind | Relation::Ahead)), Some(Chunk::Noun(noun))) if !noun.subject => {}
        (Some(Chunk::Relation(relation @ (Relation::Behind | Relation::Ahead))), _) => return Some(*relation),
        // "the vehicle traveling next to it".
        (Some(Chunk::Relation(relation)), Some(Chunk::Pronoun)) if further > at + 1 => return Some(*relation),
        _ => {}
    }
    // "the vehicle that was following it", "the vehicle trailing it".
    if let (Chunk::Verb(Sense::Act(Act::Follow), Form::Ing), Some(Chunk::Pronoun)) =
        (&all[further - 1].chunk, chunk(further))
    {
        return Some(Relation::Behind);
    }
    match (chunk(at + 1)?, chunk(at + 2)) {
        // "the vehicle coming the other way".
        (Chunk::Relation(Relation::Opposite), _) => Some(Relation::Opposite),
        (
            Chunk::Verb(Sense::Act(Act::Follow) | Sense::Approach, Form::Ing),
            Some(Chunk::Relation(Relation::Opposite)),
        ) => Some(Relation::Opposite),
        // "the vehicle next to it".
        (Chunk::Relation(relation), Some(Chunk::Pronoun)) => Some(*relation),
        // "the vehicle trailing the AV".
        (Chunk::Relative, Some(Chunk::Verb(Sense::Act(Act::Follow), Form::Past)))
            if matches!(chunk(at + 3), Some(Chunk::Pronoun))
                || matches!(chunk(at + 3), Some(Chunk::Noun(noun)) if noun.subject) =>
        {
            Some(Relation::Behind)
        }
        (Chunk::Verb(Sense::Act(Act::Follow), Form::Ing), Some(Chunk::Noun(noun)))
            if noun.subject && matches!(&all[at].chunk, Chunk::Noun(named) if named.occupant.is_none()) =>
        {
            Some(Relation::Behind)
        }
        (Chunk::Relation(relation), Some(Chunk::Noun(noun))) if noun.subject => Some(*relation),
        _ => None,
    }
}

/// The chunk behind a noun, and behind the words that say only that it drives or stands: "the vehicle traveling behind was unable to stop",
/// "the car that was stopped behind it".
fn behind_stand(all: &[Placed], at: usize) -> usize {
    let only_stands = |at: usize| {
        let before = &all[at - 1].chunk;
        match all.get(at).map(|placed| &placed.chunk) {
            Some(Chunk::Verb(Sense::Act(Act::Follow) | Sense::Approach, Form::Ing) | Chunk::Relative | Chunk::Be) => {
                true
            }
            // "the car that was stopped behind it".
            Some(Chunk::Verb(Sense::Act(Act::Stop | Act::Hold), _))
                if matches!(before, Chunk::Be | Chunk::Relative) =>
            {
                true
            }
            // "the vehicle waiting in front of it".
            Some(Chunk::Verb(Sense::Act(Act::Hold), Form::Ing)) => matches!(before, Chunk::Noun(_)),
            // "The van stopped in front of it reversed": its verb stands behind.
            Some(Chunk::Verb(Sense::Act(Act::Stop | Act::Hold) | Sense::Parked, Form::Past))
                if matches!(before, Chunk::Noun(_)) =>
            {
                another_finite(all, at)
            }
            // "the car that had been behind it".
            Some(Chunk::Word) => matches!(before, Chunk::Relative),
            _ => false,
        }
    };
    let mut further = at + 1;
    while further < at + 4 && only_stands(further) {
        further += 1;
    }
    further
}
