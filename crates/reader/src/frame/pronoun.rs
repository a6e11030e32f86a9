//! Who is meant by `it`, `its` and a door that is nobody's.

use super::Frame;
use super::parser::{Carry, Parser};
use super::row::transitive;
use crate::chunk::{Chunk, Joint, Placed};
use crate::lexicon::{Form, Part, Relation, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Kind, KindGroup};

impl Parser<'_> {
    /// Who is meant by `it` and `its`.
    pub(super) fn its(&self, word: &str, carry: &Carry) -> Actor {
        // "The bus was shoved back, and its bumper touched": whom another one moves.
        let pushed = self.frames.last().filter(|frame| {
            carry.fresh && frame.sentence == self.sentence && frame.sense == Sense::Push && frame.happened()
        });
        if let Some(pushed) = pushed.and_then(|frame| frame.object) {
            return pushed;
        }
        let actor = self.of_sentence(matches!(word, "it" | "its" | "itself"), carry);
        let hits = carry.frame.is_some_and(|frame| hits_itself(&self.frames[frame], actor, carry));
        if hits { self.met_by(actor, carry) } else { actor }
    }

    /// Whom somebody meets, of whom no more is said than "it": one that the sentence has told of.
    fn met_by(&self, actor: Actor, carry: &Carry) -> Actor {
        self.pushed_on(actor, carry)
            .or_else(|| self.came_up_behind(actor))
            .or_else(|| self.fell_before(actor))
            .unwrap_or_else(|| {
                // "A motorcycle was eastbound when a van turned across it and clipped it": of a sentence without the subject vehicle.
                let apart = || self.world.actors[SUBJECT].sentence != Some(self.sentence);
                match actor {
                    SUBJECT => self.world.other().or(self.world.thing()).unwrap_or(actor),
                    _ if apart() => {
                        carry.mains.iter().rev().copied().find(|before| *before != actor).unwrap_or(SUBJECT)
                    }
                    _ => SUBJECT,
                }
            })
    }

    /// "ran into the sedan, driving it forward": whom it struck. "cut off the van, causing it to brake": whom it did that to.
    fn pushed_on(&self, actor: Actor, carry: &Carry) -> Option<Actor> {
        let push = carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.sense == Sense::Push)?;
        let causes = self.tokens[push.first].text.starts_with("caus");
        let mut before = self.frames.iter().rev().skip(1);
        let did =
            |frame: &&Frame| frame.sentence == self.sentence && frame.who == Some(actor) && frame.object.is_some();
        let struck = before.clone().find(|frame| did(frame) && frame.is_contact());
        let done_to = || before.find(|frame| causes && did(frame) && frame.happened());
        struck.or_else(done_to).and_then(|frame| frame.object)
    }

    /// "came up behind that van and hit its rear": of whom it came up behind.
    fn came_up_behind(&self, actor: Actor) -> Option<Actor> {
        let came = |frame: &&Frame| frame.sentence == self.sentence && frame.who == Some(actor) && !frame.is_contact();
        let frame = self.frames.iter().rev().take(2).find(came)?;
        let mut behind =
            frame.relations.iter().filter(|(relation, _)| *relation == Relation::Behind).filter_map(|(_, to)| *to);
        behind.next().filter(|other| *other != SUBJECT && *other != actor)
    }

    /// "A ladder fell off a truck and the AV ran over it": what fell.
    fn fell_before(&self, actor: Actor) -> Option<Actor> {
        let thing = |who: Actor| self.world.actors[who].kind.is_some_and(|kind| kind.group() == KindGroup::Object);
        let fell = |frame: &&Frame| {
            frame.sentence == self.sentence
                && frame.who.is_some_and(thing)
                && matches!(frame.act(), Some(Act::Fall | Act::Roll))
        };
        self.frames.iter().rev().find(fell).filter(|_| actor == SUBJECT)?.who
    }

    /// "struck the AV on its left rear corner": of whom it struck. "struck the AV with its front": of who strikes.
    pub(super) fn part_behind_object(&self, carry: &Carry) -> Option<Actor> {
        let frame = carry.frame.map(|frame| &self.frames[frame]).filter(|frame| frame.is_contact() && !carry.fresh)?;
        let object = frame.object.filter(|object| frame.who != Some(*object));
        let inserted = self.tokens.get(frame.end).is_some_and(|next| next.text == ",");
        match carry.preposition? {
            "with" if !frame.passive && (object.is_some() || inserted) => frame.who,
            "on" | "at" | "along" | "in" | "near" if frame.on.is_none() && frame.who.is_some() => object,
            _ => None,
        }
    }

    /// "A van struck the AV while it waited": who stands is the one that was struck.
    pub(super) fn waits_struck(&self, all: &[Placed], at: usize, carry: &Carry) -> Option<Actor> {
        let stands = all[at + 1..].iter().take(2).any(|placed| {
            matches!(placed.chunk, Chunk::Verb(Sense::Act(Act::Hold | Act::Stop | Act::Park) | Sense::Parked, _))
        });
        let meets = |frame: &&Frame| {
            frame.is_contact() || matches!(frame.sense, Sense::Approach | Sense::Act(Act::Pass)) && frame.happened()
        };
        let last = self.frames.last().filter(|frame| frame.sentence == self.sentence).filter(meets)?;
        let struck = !last.passive && last.object == Some(SUBJECT) && last.who != Some(SUBJECT);
        // "A truck backed into the AV as it went by".
        let passes = all[at + 1..].first().is_some_and(|placed| {
            matches!(placed.chunk, Chunk::Verb(Sense::Act(Act::Pass), _))
                && !matches!(all.get(at + 2).map(|next| &next.chunk), Some(Chunk::Noun(_) | Chunk::Piece(_)))
        });
        let from_a_stand = passes && {
            matches!(last.sense, Sense::ReverseContact | Sense::OpenDoorInto)
                || self.frames.iter().any(|frame| {
                    frame.sentence == self.sentence
                        && frame.who == last.who
                        && matches!(frame.act(), Some(Act::PullOut | Act::Reverse | Act::OpenDoor))
                })
        };
        let waits = stands || from_a_stand || self.goes_on_struck(last, all, at);
        (carry.fresh && carry.joint == Some(Joint::While) && waits && struck).then_some(SUBJECT)
    }

    /// "A van struck its rear as it was setting off", "A cyclist ran into the AV as it drove east": who was struck from behind went on, and
    /// so did who was on its way.
    fn goes_on_struck(&self, last: &Frame, all: &[Placed], at: usize) -> bool {
        let small = |placed: &&Placed| matches!(placed.chunk, Chunk::Be | Chunk::Word);
        let verb = at + 1 + all[at + 1..].iter().take(3).take_while(small).count();
        let Some(Chunk::Verb(sense, _)) = all.get(verb).map(|placed| &placed.chunk) else { return false };
        // "struck its rear as it drove around the AV": nobody drives around itself.
        let ends = |placed: &&Placed| !matches!(placed.chunk, Chunk::Comma | Chunk::Joint(_));
        let itself = all[verb + 1..].iter().take_while(ends).any(|placed| match &placed.chunk {
            Chunk::Noun(noun) => noun.subject,
            Chunk::Piece(piece) => piece.owner.as_ref().is_some_and(|owner| owner.subject),
            _ => false,
        });
        if itself {
            return false;
        }
        let words = &self.tokens[last.first..all[at].first];
        let behind = words.windows(2).any(|pair| pair[0].text == "from" && pair[1].text == "behind");
        let rear = last.on.as_ref().is_some_and(|piece| piece.parts.contains(&Part::Rear));
        let from_behind = (last.sense == Sense::RearEnd || rear || behind) && last.sense != Sense::ReverseContact;
        let forward = matches!(sense, Sense::Sided(Act::Turn, _))
            || matches!(
                sense,
                Sense::Act(Act::Enter | Act::Slow | Act::SetOff | Act::Turn | Act::Follow | Act::Accelerate)
            );
        let on_its_way = *sense == Sense::Act(Act::Follow)
            && all[verb + 1..].iter().take(3).any(|placed| matches!(placed.chunk, Chunk::Compass(_) | Chunk::Lane(_)));
        from_behind && forward || on_its_way
    }

    /// "It came up to a stopped van as it was riding between the lanes": who is called stopped does not ride; who came up does.
    pub(super) fn not_who_stands(&self, actor: Actor, all: &[Placed], at: usize, carry: &Carry) -> Actor {
        let moves =
            |placed: &Placed| matches!(placed.chunk, Chunk::Verb(Sense::Act(Act::Follow | Act::Pass), Form::Ing));
        let clause = carry.fresh && carry.joint == Some(Joint::While) && all[at + 1..].iter().take(2).any(moves);
        let here = || self.frames.iter().rev().take_while(|frame| frame.sentence == self.sentence);
        let called = here().find(|frame| frame.who == Some(actor));
        if !clause || actor == SUBJECT || !called.is_some_and(|frame| frame.aside && frame.act() == Some(Act::Hold)) {
            return actor;
        }
        let came = here().find(|frame| !frame.aside && frame.happened() && frame.who != Some(actor));
        came.and_then(|frame| frame.who).unwrap_or(actor)
    }

    /// "approached a gate as it had started to close": what closes or comes down is the gate that was named before.
    pub(super) fn closes(&self, all: &[Placed], at: usize) -> Option<Actor> {
        if self.tokens[all[at].first].text != "it" {
            return None;
        }
        // "as it had begun to close".
        let small = |placed: &&Placed| {
            matches!(placed.chunk, Chunk::Word | Chunk::Be | Chunk::Preposition("to") | Chunk::Verb(Sense::Other, _))
        };
        let verb = at + 1 + all[at + 1..].iter().take_while(small).count();
        let closes = all.get(verb).filter(|placed| matches!(placed.chunk, Chunk::Verb(Sense::Act(Act::Fall), _)))?;
        let words = &self.tokens[closes.first..closes.end];
        let swings = |token: &crate::token::Token| {
            ["clos", "lower", "descend", "swing", "swung", "coming", "came"]
                .iter()
                .any(|stem| token.text.starts_with(stem))
        };
        // "it closed the distance".
        let takes = matches!(all.get(verb + 1).map(|placed| &placed.chunk), Some(Chunk::Noun(_) | Chunk::Piece(_)));
        let another = self
            .tokens
            .get(closes.end)
            .is_some_and(|next| matches!(next.text.as_str(), "the" | "its" | "a" | "in" | "on"));
        if takes || another || !words.iter().any(swings) {
            return None;
        }
        let gate = |actor: &Actor| matches!(self.world.actors[*actor].kind, Some(Kind::Gate | Kind::Barrier));
        (1..self.world.actors.len()).filter(gate).max_by_key(|actor| self.world.actors[*actor].last)
    }

    /// "A truck struck a parked truck, and as a result the truck touched it": of two of a kind the one that was struck.
    pub(super) fn as_a_result(&self, actor: Actor, first: usize) -> Actor {
        let Some(last) = self.frames.iter().rev().find(|frame| frame.is_contact() && !frame.aside) else {
            return actor;
        };
        let Some(struck) = last.object.filter(|struck| *struck != SUBJECT && last.who == Some(actor)) else {
            return actor;
        };
        let alike = self.world.actors[struck].kind == self.world.actors[actor].kind;
        let words = &self.tokens[last.end.min(first)..first];
        let follows = words.iter().any(|token| matches!(token.text.as_str(), "result" | "force" | "causing"));
        if alike && follows { struck } else { actor }
    }

    /// Whose door was opened last.
    pub(super) fn door_of(&self) -> Option<Actor> {
        self.frames.iter().rev().find(|frame| frame.act() == Some(Act::OpenDoor) && frame.happened())?.who
    }

    /// Nobody is behind itself, or comes toward itself: "the car following it", "a van coming toward it".
    pub(super) fn not_itself(&self, actor: Actor, carry: &Carry) -> Actor {
        let frame = carry.frame.map(|frame| &self.frames[frame]);
        let doer = frame.and_then(|frame| frame.who).or(carry.subject.as_ref().map(|subject| subject.actor));
        let takes = frame.is_some_and(|frame| {
            frame.object.is_none()
                && !carry.fresh
                && !carry.after_comma
                && matches!(frame.act(), Some(Act::Follow | Act::Pass))
                && transitive(frame.sense)
        });
        // "slowed for it", "yielded to it": nobody does so for itself.
        let gives_way = frame.is_some_and(|frame| {
            matches!(frame.sense, Sense::Yield | Sense::Act(Act::Stop | Act::Hold | Act::Slow)) && !carry.fresh
        });
        let place = matches!(carry.preposition, Some("toward" | "towards" | "past" | "around" | "against"))
            || gives_way && matches!(carry.preposition, Some("for" | "to"));
        // "made contact with a van stopped behind it": it is the van that stands there.
        let of_object = frame.zip(carry.last.as_ref()).is_some_and(|(frame, last)| {
            carry.relation.is_some()
                && frame.is_contact()
                && frame.object == Some(last.actor)
                && last.actor != actor
                && last.piece.is_none()
        });
        if of_object
            || self.stands_with(carry)
            || doer != Some(actor)
            || !(carry.relation.is_some() || place || takes && carry.preposition.is_none())
        {
            return actor;
        }
        match actor {
            SUBJECT => self.world.other().unwrap_or(actor),
            _ => SUBJECT,
        }
    }

    /// "waited with a van behind it": the noun that stands behind "with" is placed, and not who waits.
    pub(super) fn stands_with(&self, carry: &Carry) -> bool {
        let Some(last) = carry.last.as_ref().filter(|last| last.piece.is_none() && last.actor != SUBJECT) else {
            return false;
        };
        let touches = carry
            .frame
            .is_some_and(|frame| self.frames[frame].is_contact() || self.frames[frame].sense == Sense::Headline);
        self.is_behind_with(last.end) && !touches && carry.governed | carry.frame.is_none()
    }

    /// Whether the noun that ends here stands behind "with": "with the large van".
    pub(super) fn is_behind_with(&self, end: usize) -> bool {
        let from = end.saturating_sub(5);
        // "with several cars ahead of it", "with traffic behind it".
        let article = |at: usize| {
            let word = self.tokens[at].text.as_str();
            matches!(
                word,
                "a" | "an" | "another" | "two" | "the" | "three" | "four" | "several" | "some" | "other" | "more"
            ) || matches!(word, "multiple" | "numerous" | "traffic" | "cars" | "vehicles")
        };
        let with = self.tokens[from..end].iter().rposition(|token| token.text == "with").map(|at| from + at);
        with.is_some_and(|with| with + 1 < end && article(with + 1))
    }

    /// Who the sentence is about, as far as it can be meant by a pronoun.
    fn of_sentence(&self, single: bool, carry: &Carry) -> Actor {
        let of_sentence = carry.main.as_ref().or(carry.subject.as_ref()).map(|mention| mention.actor);
        // "Vans stood on its right. It reversed": one thing is no group, and nobody who walks.
        let may_be = |actor: Actor| {
            let known = &self.world.actors[actor];
            actor == SUBJECT || !(single && (known.several || known.kind == Some(Kind::Pedestrian)))
        };
        match of_sentence {
            Some(actor) if (actor == SUBJECT || self.world.actors[actor].acts()) && may_be(actor) => actor,
            _ if may_be(self.world.pronoun()) => self.world.pronoun(),
            _ => SUBJECT,
        }
    }
}

/// "The van drifted over and hit its right side": nobody hits itself.
fn hits_itself(frame: &Frame, actor: Actor, carry: &Carry) -> bool {
    matches!(frame.sense, Sense::Contact | Sense::RearEnd | Sense::ReverseContact | Sense::Push)
        && frame.who == Some(actor)
        && frame.object.is_none()
        && !carry.fresh
        // "clipping the rear sensors with its mirror".
        && !(frame.on.is_some() && carry.preposition == Some("with"))
        // "was hit by its front bumper".
        || frame.is_contact() && frame.passive && frame.object == Some(actor) && frame.who.is_none()
}
