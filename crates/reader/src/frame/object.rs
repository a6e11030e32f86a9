//! A noun behind a preposition: by whom it was done, into whom it went, for whom it waited. One function for each group of
//! prepositions, which [`Parser::object_of`] names.

use super::parser::{Carry, Mention, Parser};
use super::row::transitive;
use super::zone_of;
use crate::chunk::{Chunk, Piece, Placed};
use crate::lexicon::{Form, Meaning, Progress, Relation, Sense};
use crate::token::TokenKind;
use crate::token::{Token, word};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Kind, KindGroup, LeftRight};

impl Parser<'_> {
    /// A noun behind a preposition.
    pub(super) fn object_of(&mut self, preposition: &str, mention: &Mention, placed: &Placed, carry: &mut Carry) {
        // "a cyclist between the van and the curb": a pair, whatever verb comes.
        carry.pair |= preposition == "between" && carry.frame.is_none() && !self.world.actors[mention.actor].several;
        // "and, with its tail, struck the wall": with which part it does what stands behind.
        let own = carry.subject.as_ref().is_some_and(|subject| subject.actor == mention.actor);
        if preposition == "with" && own && !carry.frame.is_some_and(|frame| self.frames[frame].is_contact()) {
            carry.with = mention.piece.clone().filter(|piece| piece.its && zone_of(piece).is_some());
        }
        let Some(frame) = carry.frame else { return };
        match preposition {
            "by" if self.frames[frame].sense == Sense::Tow => self.towed_by(frame, mention.actor, carry),
            "by" => self.done_by(frame, mention, placed, carry),
            "in" if mention.piece.is_some() && self.frames[frame].is_contact() => {
                self.met(frame, preposition, mention, placed, carry);
            }
            "into" | "against" => self.into(frame, preposition, mention, placed, carry),
            "off" if !self.frames[frame].is_contact() => {}
            // "came out from behind a van", "from between two vans".
            "behind" | "between"
                if matches!(self.frames[frame].act(), Some(Act::Enter | Act::Cross | Act::PullOut))
                    || self.comes_from_behind(frame, mention) =>
            {
                self.frames[frame].object.get_or_insert(mention.actor);
            }
            "at" if self.comes_at(frame, mention) => self.comes_toward(frame, mention),
            "onto" | "with" | "between" | "and" | "upon" | "on" | "at" | "along" | "near" | "to" | "off" => {
                self.met(frame, preposition, mention, placed, carry);
            }
            "under" if self.rolls_under(frame, mention) => {
                self.touch(frame, self.frames[frame].who, mention, placed, carry);
            }
            "for" if self.waits_for(self.standing_before(frame), mention.actor) => {
                let frame = self.standing_before(frame);
                if !self.comes_across(mention.actor, placed.end) && !self.at_yield_line(frame, placed) {
                    self.note(mention.actor, Relation::Ahead);
                }
                self.frames[frame].object.get_or_insert(mention.actor);
            }
            "toward" | "towards" => self.comes_toward(frame, mention),
            "around" | "past" if self.goes_past(frame, mention) => {
                let taken = &mut self.frames[frame];
                taken.sense = Sense::Act(Act::Pass);
                (taken.object, taken.end) = (Some(mention.actor), placed.end);
                // "around the left side of it".
                taken.side = taken.side.or(mention.piece.as_ref().and_then(Piece::side));
                // "around and to the left of it": it is on the right.
                if let (Some(SUBJECT), Some(side)) = (taken.who, taken.side) {
                    let other = if side == LeftRight::Left { Relation::Right } else { Relation::Left };
                    self.note(mention.actor, other);
                }
            }
            "of" | "for" | "in" | "through" | "around" | "past" | "across" | "from" | "under" | "over" => {
                let taken = &mut self.frames[frame];
                if taken.object.is_none() && transitive(taken.sense) && !taken.is_contact() {
                    taken.object = Some(mention.actor);
                }
            }
            _ => {}
        }
    }

    /// "came from behind the truck", of another than the subject vehicle: nobody sees it before.
    fn comes_from_behind(&self, frame: usize, mention: &Mention) -> bool {
        let taken = &self.frames[frame];
        let from = self.tokens.get(taken.end.saturating_sub(1)..taken.end + 2).unwrap_or_default();
        let from = from.windows(2).any(|pair| pair[0].text == "from" && pair[1].text == "behind");
        let others = mention.actor != SUBJECT && taken.who != Some(SUBJECT) && taken.who != Some(mention.actor);
        taken.act() == Some(Act::Follow) && from && others
    }

    /// "proceeded slowly past two workers", "steered around the truck".
    fn goes_past(&self, frame: usize, mention: &Mention) -> bool {
        let taken = &self.frames[frame];
        let moves = matches!(
            taken.sense,
            Sense::Act(Act::Follow | Act::SetOff | Act::Drift | Act::Accelerate | Act::Pass | Act::PullOut)
        );
        let rides = |kind: Kind| kind.group() != KindGroup::Object;
        let by = mention.actor == SUBJECT || self.world.actors[mention.actor].kind.is_some_and(rides);
        let whole = mention.piece.as_ref().is_none_or(|piece| piece.side().is_some());
        moves && by && taken.who.is_some_and(|who| who != mention.actor) && whole
    }

    /// "was towed by a truck".
    fn towed_by(&mut self, frame: usize, actor: Actor, carry: &mut Carry) {
        let Some(towed) = self.frames[frame].who else { return };
        // "A trailer pulled by a pickup went by": the two of them.
        let told = [&mut carry.subject, &mut carry.main].into_iter().flatten();
        told.filter(|mention| mention.actor == towed).for_each(|mention| mention.actor = actor);
        self.world.tow(actor, towed);
        self.world.actors[actor].announced |= self.world.actors[towed].announced;
        (self.frames[frame].object, self.frames[frame].who) = (Some(towed), Some(actor));
    }

    /// "was struck by a van", "was passed by a van".
    fn done_by(&mut self, frame: usize, mention: &Mention, placed: &Placed, carry: &mut Carry) {
        let frame = self.waiting_for_doer(frame);
        let taken = &mut self.frames[frame];
        let done_to = taken.form == Form::Past
            && matches!(
                taken.sense,
                Sense::Contact | Sense::RearEnd | Sense::Push | Sense::ReverseContact | Sense::ContactMade
            );
        let passed = taken.passive
            && matches!(taken.sense, Sense::Approach | Sense::Act(Act::Follow | Act::Pass | Act::LaneChange));
        // "The door was opened by a passenger of the van": of the van.
        if taken.sense == Sense::Act(Act::OpenDoor) && taken.form == Form::Past && mention.person.is_some() {
            taken.who = Some(mention.actor);
            carry.subject = Some(Mention { piece: Some(Piece::a_door()), person: None, ..mention.clone() });
            return;
        }
        if !done_to && !passed {
            return;
        }
        if taken.sense != Sense::ContactMade && taken.object.is_none() {
            taken.object = taken.who;
            taken.on = taken.with.take();
        }
        taken.who = Some(mention.actor);
        taken.with.clone_from(&mention.piece);
        (taken.passive, taken.end) = (true, placed.end);
        self.is_placed_by_doer(frame, mention, passed);
        self.was_reduced(frame, done_to, carry);
        // Nobody strikes itself: "the car behind it was struck by the car that followed".
        if self.frames[frame].object == Some(mention.actor) && mention.actor != SUBJECT {
            self.frames[frame].who = Some(self.world.twin(mention.actor));
        }
        self.followed_by(frame, mention, carry);
        carry.governed |= carry.relative || carry.subject.is_some();
    }

    /// "was approached from behind by a van": who came from there.
    fn is_placed_by_doer(&mut self, frame: usize, mention: &Mention, passed: bool) {
        let taken = &self.frames[frame];
        let of_subject = passed && taken.object == Some(SUBJECT) && mention.actor != SUBJECT;
        let places: Vec<Relation> =
            taken.relations.iter().filter(|(_, to)| of_subject && to.is_none()).map(|(place, _)| *place).collect();
        places.into_iter().for_each(|place| self.note(mention.actor, place));
    }

    /// "A stone kicked up by a truck struck it": the stone did.
    fn was_reduced(&self, frame: usize, done_to: bool, carry: &mut Carry) {
        let first = self.frames[frame].first;
        let be = self.tokens[first.saturating_sub(3)..first].iter().any(|token| {
            matches!(
                token.text.as_str(),
                "was" | "were" | "is" | "are" | "been" | "being" | "be" | "got" | "and" | "," | "then"
            )
        });
        let of_subject = carry
            .subject
            .as_ref()
            .is_some_and(|subject| self.frames[frame].object == Some(subject.actor) && subject.end == first);
        if done_to && !be && of_subject {
            (carry.reduced, carry.has_verb) = (true, false);
        }
    }

    /// "A ball, followed by a dog, rolled out": so did the dog.
    fn followed_by(&mut self, frame: usize, mention: &Mention, carry: &mut Carry) {
        let (sense, object, first) = (self.frames[frame].sense, self.frames[frame].object, self.frames[frame].first);
        let (Sense::Act(Act::Follow), Some(followed)) = (sense, object) else { return };
        self.follows(Some(mention.actor), followed);
        let be = self.tokens[first.saturating_sub(2)..first]
            .iter()
            .any(|token| matches!(token.text.as_str(), "was" | "were" | "is" | "are" | "been" | "being"));
        if !be && carry.subject.as_ref().is_some_and(|subject| subject.actor == followed) {
            (carry.also, carry.has_verb) = (Some(mention.clone()), false);
        }
    }

    /// "was struck while it stood there by a van": the passive verb that still waits for who did it.
    fn waiting_for_doer(&self, frame: usize) -> usize {
        let passive = |number: &usize| {
            let frame = &self.frames[*number];
            frame.sentence == self.sentence && frame.passive && frame.is_contact()
        };
        if passive(&frame) {
            return frame;
        }
        let waits = |number: &usize| self.frames[*number].who.is_none();
        (0..frame).rev().take(3).find(passive).filter(waits).unwrap_or(frame)
    }

    /// "slid on into the rear of the van", "came to rest with its nose against it".
    fn into(&mut self, frame: usize, preposition: &str, mention: &Mention, placed: &Placed, carry: &mut Carry) {
        let whole = self.tokens.get(placed.end).is_none_or(not_possessive);
        if self.frames[frame].sense != Sense::Push && whole && self.runs_into(frame, mention) {
            return self.touch(frame, self.frames[frame].who, mention, placed, carry);
        }
        self.met(frame, preposition, mention, placed, carry);
    }

    /// "made contact with the van", "a collision between the van and the bus", "yielded to the van", "swerved onto it".
    fn met(&mut self, frame: usize, preposition: &str, mention: &Mention, placed: &Placed, carry: &mut Carry) {
        let actor = mention.actor;
        if self.frames[frame].sense == Sense::Push && preposition != "with" {
            // Pushed into somebody: who was pushed touches them.
            return self.touch(frame, self.frames[frame].object, mention, placed, carry);
        }
        let taken = &mut self.frames[frame];
        let headline = taken.sense == Sense::Headline;
        let contact = matches!(
            taken.sense,
            Sense::Contact | Sense::ContactMade | Sense::ReverseContact | Sense::OpenDoorInto | Sense::RearEnd
        );
        let moves = matches!(
            taken.act(),
            Some(
                Act::Swerve
                    | Act::Drift
                    | Act::Turn
                    | Act::LaneChange
                    | Act::Reverse
                    | Act::Roll
                    | Act::Fall
                    | Act::Slow
            )
        );
        if taken.sense == Sense::ContactMade && preposition == "between" {
            taken.who = Some(actor);
            taken.with.clone_from(&mention.piece);
            carry.pair = true;
            // "a collision between two vans": of each of them with the other.
            taken.object = self.world.actors[actor].several.then_some(actor);
        } else if (contact || headline) && taken.object.is_none() && taken.who != Some(actor) {
            taken.object = Some(actor);
            taken.on.clone_from(&mention.piece);
            taken.end = placed.end;
            self.world.actors[actor].announced |= headline && actor != SUBJECT;
        } else if contact && preposition == "with" && taken.who == Some(actor) && !taken.passive {
            // "struck its rear with the front of the van".
            // "struck, with its front, the rear of it".
            let inserted = self.tokens[taken.end].text == ",";
            let struck = taken.object.is_some() || taken.on.is_some() || inserted;
            let piece = mention.piece.as_ref().filter(|piece| struck && zone_of(piece).is_some());
            taken.with = piece.cloned().or(taken.with.take());
        } else if contact && taken.object == Some(actor) && taken.on.is_none() {
            taken.on.clone_from(&mention.piece);
            taken.end = placed.end;
        } else if (taken.sense == Sense::Yield || moves) && taken.object.is_none() {
            taken.object = Some(actor);
        }
    }

    /// "a bucket rolled under its front end".
    fn rolls_under(&self, frame: usize, mention: &Mention) -> bool {
        let frame = &self.frames[frame];
        mention.actor == SUBJECT
            && mention.piece.is_some()
            && frame.who.is_some_and(|who| who != SUBJECT)
            && matches!(frame.act(), Some(Act::Roll | Act::Fall | Act::Drift | Act::Follow))
    }

    /// "stopped for a van": it was ahead.
    fn waits_for(&self, frame: usize, actor: Actor) -> bool {
        let (frame, known) = (&self.frames[frame], &self.world.actors[actor]);
        matches!(frame.sense, Sense::Act(Act::Stop | Act::Hold))
            && frame.who == Some(SUBJECT)
            && known.kind.is_some_and(Kind::is_vehicle)
            && !known.several
    }

    /// "stood facing north for a van": the verb of standing before.
    fn standing_before(&self, frame: usize) -> usize {
        let Some(before) = frame.checked_sub(1) else { return frame };
        let (facing, stands) = (&self.frames[frame], &self.frames[before]);
        let same = (facing.sentence, facing.who) == (stands.sentence, stands.who);
        let stood = stands.act().is_some_and(Act::stands);
        if facing.sense == Sense::Face && same && stood { before } else { frame }
    }

    /// "stopped for an oncoming van", "for a van coming the other way", "halted, heading south, for a northbound van": not ahead in its lane.
    fn comes_across(&self, actor: Actor, end: usize) -> bool {
        let known = &self.world.actors[actor];
        let opposite = known.relations.iter().any(|(place, _)| *place == Relation::Opposite);
        let other_way = match (known.heading, self.world.actors[SUBJECT].heading) {
            (Some((theirs, ..)), Some((own, ..))) => theirs != own,
            _ => false,
        };
        let clause = self.tokens[end..].iter().take(OTHER_WAY_WITHIN).take_while(|token| token.kind != TokenKind::Mark);
        let behind = (end..end + clause.count()).any(|at| {
            let found = self
                .lexicon
                .longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Relation(Relation::Opposite)));
            found.is_some() || matches!(self.tokens[at].text.as_str(), "toward" | "towards")
        });
        opposite || other_way || behind
    }

    /// "had waited at the yield line for a van": that comes across its way. Who is waited for "to go" stands ahead.
    fn at_yield_line(&self, frame: usize, placed: &Placed) -> bool {
        let words = &self.tokens[self.frames[frame].first.min(placed.first)..placed.first];
        let next = |at: usize| word(self.tokens, placed.end + at);
        let goes = next(0) == "to" && matches!(next(1), "go" | "move" | "proceed" | "advance");
        let line = |pair: &[Token]| pair[0].text == "yield" && matches!(pair[1].text.as_str(), "line" | "sign");
        !goes && words.windows(2).any(line)
    }

    /// "a motorcycle came at it".
    fn comes_at(&self, frame: usize, mention: &Mention) -> bool {
        let taken = &self.frames[frame];
        let comes = ["came", "coming", "comes", "rode", "riding", "drove", "headed"];
        let whole = mention.actor == SUBJECT && mention.piece.is_none();
        whole && comes.contains(&self.tokens[taken.first].text.as_str()) && taken.act() == Some(Act::Follow)
    }

    /// "a truck coming towards it".
    fn comes_toward(&mut self, frame: usize, mention: &Mention) {
        let taken = &self.frames[frame];
        let comes = matches!(taken.sense, Sense::Act(Act::Follow) | Sense::Approach) && taken.happened();
        let rides =
            |kind: Kind| kind.is_vehicle() || matches!(kind.group(), KindGroup::Motorcycle | KindGroup::Cyclist);
        let Some(who) = taken.who.filter(|who| *who != SUBJECT) else { return };
        let toward = mention.actor == SUBJECT && mention.piece.is_none();
        if toward && comes && self.world.actors[who].kind.is_some_and(rides) {
            self.note(who, Relation::Opposite);
            self.frames[frame].relations.push((Relation::Opposite, Some(SUBJECT)));
        }
    }

    /// Who is pushed, or drives on, into somebody touches them.
    fn touch(&mut self, frame: usize, who: Option<Actor>, mention: &Mention, placed: &Placed, carry: &Carry) {
        let before = &self.frames[frame];
        let (negated, progress) = (before.negated, before.progress);
        let words = Placed { chunk: Chunk::Word, first: before.first, end: placed.end };
        let with = before.with.clone();
        let mut contact = self.frame(who, Sense::Contact, Form::Past, &words, carry);
        contact.object = Some(mention.actor);
        contact.on.clone_from(&mention.piece);
        (contact.negated, contact.with) = (negated, with);
        contact.progress = if negated { progress } else { Progress::Real };
        self.frames.push(contact);
    }

    /// Whether somebody moves into a part of another, or into another that is named as a whole.
    fn runs_into(&self, frame: usize, mention: &Mention) -> bool {
        let frame = &self.frames[frame];
        let moves = matches!(
            frame.act(),
            Some(
                Act::Follow
                    | Act::SetOff
                    | Act::Drift
                    | Act::Swerve
                    | Act::Roll
                    | Act::Fall
                    | Act::LoseControl
                    | Act::Accelerate
                    | Act::LaneChange
                    | Act::Slow
            )
        );
        let apart = frame.who.is_some_and(|who| who != mention.actor);
        let rides = self.world.actors[mention.actor].kind.is_none_or(|kind| kind.group() != KindGroup::Object);
        let named = mention.actor == SUBJECT || mention.piece.is_some();
        moves && apart && rides && named && mention.person.is_none() && frame.happened() && frame.object.is_none()
    }
}

/// "for a van that was coming the other way": so near stands which way it came. [tokens]
const OTHER_WAY_WITHIN: usize = 6;

/// Whether what stands before this word is named for itself, and not "the van's lane", "the AVs path".
fn not_possessive(token: &crate::token::Token) -> bool {
    !matches!(token.text.as_str(), "'s" | "lane" | "lanes" | "path" | "way" | "right")
}
