//! A frame of which nothing is known yet but who and what, and those of adjectives.

use super::Frame;
use super::parser::{Carry, Parser};
use crate::chunk::{Noun, Placed};
use crate::lexicon::{Adjective, Form, Progress, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::Act;

impl Parser<'_> {
    /// What the adjectives of a noun say of it.
    pub(super) fn attribute(&mut self, noun: &Noun, actor: Actor, placed: &Placed, carry: &Carry) {
        for adjective in &noun.adjectives {
            let (sense, side) = match adjective {
                Adjective::Stopped => (Sense::Act(Act::Hold), None),
                Adjective::Parked => (Sense::Parked, None),
                Adjective::Doing if actor != SUBJECT && !noun.several => match self.doing(placed) {
                    Some((act, side)) => (Sense::Act(act), side),
                    None => continue,
                },
                Adjective::Doing if actor == SUBJECT && self.rolls(placed) => (Sense::Act(Act::Follow), None),
                Adjective::Doing if actor == SUBJECT => match self.doing(placed) {
                    Some((Act::Turn, Some(side))) => (Sense::Act(Act::Turn), Some(side)),
                    _ => continue,
                },
                _ => continue,
            };
            let mut frame = self.frame(Some(actor), sense, Form::Past, placed, carry);
            (frame.aside, frame.state, frame.negated, frame.progress) = (true, true, false, Progress::Real);
            frame.side = side;
            self.frames.push(frame);
        }
    }

    pub(super) fn frame(&self, who: Option<Actor>, sense: Sense, form: Form, placed: &Placed, carry: &Carry) -> Frame {
        Frame {
            who,
            with: None,
            sense,
            form,
            object: None,
            on: None,
            side: match sense {
                Sense::Sided(_, side) => Some(side),
                _ => None,
            },
            relations: Vec::new(),
            heading: None,
            onto: false,
            lane: None,
            out_of: None,
            negated: carry.negated,
            progress: carry.progress.unwrap_or(Progress::Real),
            state: false,
            aside: false,
            joint: carry.joint,
            person: None,
            described: carry.relative,
            passive: false,
            clause: carry.clause,
            sentence: self.sentence,
            looks_back: self.looks_back,
            first: placed.first,
            end: placed.end,
        }
    }
}
