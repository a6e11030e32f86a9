//! Where one clause ends and the next begins: "and", "when", "after", "before", "because".

use super::parser::{Carry, Parser};
use crate::chunk::{Chunk, Joint, Placed};
use crate::lexicon::Form;

impl Parser<'_> {
    pub(super) fn joint(&mut self, joint: Joint, carry: &mut Carry, behind: &[Placed]) {
        let next = behind
            .iter()
            .take(3)
            .map(|placed| &placed.chunk)
            .find(|chunk| joint != Joint::And || !matches!(chunk, Chunk::Word));
        // "rolled across the street and into the van": one way.
        let into = matches!(behind.first().map(|placed| &placed.chunk), Some(Chunk::Preposition("into" | "against")));
        if joint == Joint::And && into && carry.frame.is_some() {
            (carry.preposition, carry.relation) = (None, None);
            return;
        }
        // "between the van and a parked car": the second of a pair, and no new clause.
        let noun = matches!(next, Some(Chunk::Noun(_) | Chunk::Piece(_)));
        let ends = behind.get(1).is_none_or(|placed| match placed.chunk {
            // "and the van, coming from the left, hit it".
            Chunk::Comma => !matches!(
                behind.get(2).map(|placed| &placed.chunk),
                Some(Chunk::Verb(_, Form::Ing) | Chunk::Not | Chunk::Relative)
            ),
            // "and the van then reversed" is a clause of its own.
            Chunk::Joint(joint) => joint != Joint::And || self.tokens[placed.first].text == "and",
            _ => false,
        });
        if joint == Joint::And && noun && (ends && carry.has_verb || std::mem::take(&mut carry.pair)) {
            carry.preposition = Some("and");
            return;
        }
        // "the van and the bus": nouns in a row.
        let nouns = joint == Joint::And
            && matches!(next, Some(Chunk::Noun(_) | Chunk::Piece(_)))
            && !carry.has_verb
            && !carry.after_comma
            && carry.subject.is_some();
        if nouns {
            carry.also = carry.subject.clone();
            return;
        }
        carry.also = None;
        self.leave_place(carry);
        carry.clause += 1;
        (carry.preposition, carry.relation, carry.be, carry.to) = (None, None, false, false);
        if joint != Joint::And || !matches!(next, Some(Chunk::Verb(..) | Chunk::Not | Chunk::Be)) {
            carry.stranger = false;
        }
        if joint != Joint::And {
            carry.joint = Some(joint);
            (carry.progress, carry.negated) = (None, false);
        }
        if joint == Joint::And && matches!(next, Some(Chunk::Verb(..) | Chunk::Not | Chunk::Be)) {
            // "did not slow down or stop" denies both.
            let or = behind.first().is_some_and(|next| next.first > 0 && self.tokens[next.first - 1].text == "or");
            carry.negated = or
                && matches!(next, Some(Chunk::Verb(_, Form::Base)))
                && carry.frame.is_some_and(|frame| self.frames[frame].negated);
            carry.row = true;
            if carry.relative {
                // "a van that was behind it and struck it" goes on with the van.
                carry.has_verb = true;
            }
            if !matches!(next, Some(Chunk::Verb(_, Form::Base))) {
                carry.progress = None;
            }
            return;
        }
        (carry.progress, carry.negated) = (None, false);
        carry.relative = false;
        carry.fresh = true;
        carry.frame = None;
        carry.governed = false;
        if joint != Joint::And && !matches!(next, Some(Chunk::Noun(_) | Chunk::Piece(_) | Chunk::Pronoun)) {
            // "while stopped", "before turning": of whom the clause is about, or of who is named next.
            carry.has_verb = carry.subject.is_some();
        }
    }
}
