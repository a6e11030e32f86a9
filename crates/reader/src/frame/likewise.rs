//! What somebody does as another one did: "and so did the AV", "the van did likewise" or "followed suit", "as was a bus beside it".

use super::Frame;
use super::parser::Parser;
use crate::chunk::{Chunk, Placed};
use crate::world::{Actor, SUBJECT};

impl Parser<'_> {
    /// Tells of somebody what was told of another one.
    pub(super) fn did_likewise(&mut self, all: &[Placed], begun: usize) {
        for at in 0..all.len() {
            let Some((noun, behind)) = self.does_as_before(all, at) else { continue };
            let first = all[at].first;
            let Some(who) = self.named_here(&all[noun]) else { continue };
            let alike = |frame: &&Frame| {
                frame.who.is_some_and(|other| other != who)
                    && frame.act().is_some()
                    && frame.happened()
                    && !(frame.is_contact() || frame.passive || frame.aside)
                    && frame.sentence + 1 >= self.sentence
                    && frame.first < first
            };
            let Some(model) = self.frames.iter().rev().find(alike).cloned() else { continue };
            let twin = Frame {
                who: Some(who),
                object: None,
                relations: Vec::new(),
                sentence: self.sentence,
                first,
                end: all[behind].end,
                ..model
            };
            let place = self.frames[begun..]
                .iter()
                .position(|frame| frame.first > first)
                .map_or(self.frames.len(), |at| begun + at);
            self.frames.insert(place, twin);
            return;
        }
    }

    /// "so did the AV", "as was a van", "the AV did likewise": the noun, and the last chunk of it all.
    fn does_as_before(&self, all: &[Placed], at: usize) -> Option<(usize, usize)> {
        let word = |at: usize| all.get(at).map_or("", |placed| self.tokens[placed.first].text.as_str());
        let noun = |at: usize| all.get(at).is_some_and(|placed| matches!(placed.chunk, Chunk::Noun(_)));
        let ends = |at: usize| {
            let next = all.get(at).map(|placed| &placed.chunk);
            matches!(next, None | Some(Chunk::Comma | Chunk::Relation(_) | Chunk::Joint(_)))
                || matches!(word(at), "too")
        };
        let does = |at: usize| matches!(word(at), "did" | "was" | "were" | "had");
        if matches!(word(at), "so" | "as") && does(at + 1) && noun(at + 2) && ends(at + 3) {
            return Some((at + 2, at + 2));
        }
        // "a van behind it did likewise".
        let placed = matches!(all.get(at + 1).map(|placed| &placed.chunk), Some(Chunk::Relation(_)))
            && matches!(all.get(at + 2).map(|placed| &placed.chunk), Some(Chunk::Pronoun | Chunk::Noun(_)));
        let did = at + 1 + if placed { 2 } else { 0 };
        let likewise = word(did + 1) == "likewise" || word(did + 1) == "the" && word(did + 2) == "same";
        (noun(at) && word(did) == "did" && likewise).then_some((at, did + 1))
    }

    /// Who is meant by a noun of this sentence.
    fn named_here(&self, placed: &Placed) -> Option<Actor> {
        let Chunk::Noun(noun) = &placed.chunk else { return None };
        if noun.subject {
            return Some(SUBJECT);
        }
        let here = |actor: &Actor| {
            let known = &self.world.actors[*actor];
            known.sentence == Some(self.sentence) && known.kind == noun.kind && known.acts()
        };
        (1..self.world.actors.len()).filter(here).max_by_key(|actor| self.world.actors[*actor].last)
    }
}
