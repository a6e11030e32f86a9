//! Words that are nothing of the grammar: what they still say of those around them.

use super::parser::{Carry, Mention, Parser};
use crate::chunk::{Chunk, Placed, is_determiner};
use crate::lexicon::{Form, Progress, Sense};
use crate::token::{is_crash_noun, word};
use recrash_model::account::Kind;

/// Participles of a thing that a vehicle carries or draws.
const ATTACHED: [&str; 8] =
    ["attached", "hitched", "hooked", "coupled", "connected", "strapped", "secured", "fastened"];

/// Words that nobody knows between "pulling" and the trailer. [chunks]
const TRAILER_WITHIN: usize = 4;

impl Parser<'_> {
    /// Whether something is told to be "attached to" who is named next.
    pub(super) fn is_attached(&self, all: &[Placed], at: usize) -> bool {
        let end = all[at].end;
        ATTACHED.contains(&word(self.tokens, all[at].first))
            && end == all[at].first + 1
            && word(self.tokens, end) == "to"
    }

    /// "a pickup pulling a wide horse trailer", "a horse trailer pulled by a pickup": it is drawn there.
    fn draws_a_trailer(&self, all: &[Placed], at: usize, carry: &Carry) -> bool {
        let word = self.tokens[all[at].first].text.as_str();
        let mut behind = all[at + 1..].iter().take(TRAILER_WITHIN).map(|placed| &placed.chunk);
        let by = matches!(behind.clone().next(), Some(Chunk::Preposition("by")));
        let next = behind.find(|chunk| !matches!(chunk, Chunk::Word));
        let draws = matches!(next, Some(Chunk::Noun(noun)) if noun.kind == Some(Kind::Trailer));
        let last = carry.last.as_ref().and_then(|last| self.world.actors[last.actor].kind);
        match word {
            "pulling" | "pulls" | "drawing" | "dragging" | "drew" => draws,
            "pulled" | "drawn" => draws || by && last == Some(Kind::Trailer),
            _ => false,
        }
    }

    /// Whether a comma before it still stands before what follows.
    pub(super) fn word(&mut self, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        let placed = &all[at];
        let token = &self.tokens[placed.first];
        let word = token.text.as_str();
        if let Some((sense, form)) = self.tells_event(word, all, at, carry) {
            self.verb(sense, form, all, at, carry);
            return false;
        }
        let next = all.get(at + 1).map(|placed| &placed.chunk);
        // "a dolly attached to the back of the truck": they are one.
        if self.is_attached(all, at) {
            carry.attached = carry.last.as_ref().filter(|last| last.piece.is_none()).map(|last| last.actor);
        }
        if let Some(progress) = self.says_how_far(word, placed, next) {
            (carry.progress, carry.began) = (Some(progress), true);
        }
        // "Data of the trip shows the AV driving": the AV begins a clause.
        if matches!(word, "shows" | "showed") {
            (carry.preposition, carry.relation) = (None, None);
        }
        if word == "involving" && self.involves(all, at, carry) {
            return true;
        }
        if word == "where" {
            begin_place(all, at, carry);
        }
        // "The Fusion" of "a red Ford Fusion".
        if token.capital
            && placed.first > 0
            && self.tokens[placed.first - 1].text == "the"
            && let Some(actor) = self.world.by_name(word)
        {
            self.mention(Mention { actor, piece: None, person: None, end: placed.end }, placed, carry, next);
            return false;
        }
        // "a child chasing a ball": who chases goes on.
        let beside_noun = at > 0 && matches!(all[at - 1].chunk, Chunk::Noun(_));
        if word.ends_with("ing") && beside_noun && matches!(next, Some(Chunk::Noun(_))) {
            carry.preposition = Some("of");
            return true;
        }
        // "whose driver was texting ran into it": a verb that nobody knows is behind "was".
        let done = (word.ends_with("ing") || word.ends_with("ed"))
            && carry.be
            && matches!(next, Some(Chunk::Verb(_, Form::Past)));
        if done && at > 0 && matches!(all[at - 1].chunk, Chunk::Be) {
            (carry.be, carry.governed) = (false, false);
        }
        let waits = carry.preposition.is_some() || carry.relation.is_some();
        // "at about 6 mph its bumper touched", "at this time", "on Elm Street".
        let measures =
            matches!(word, "mph" | "miles" | "feet" | "seconds" | "a.m" | "p.m" | "am" | "pm" | "mode" | "time");
        carry.filled |= waits && (measures || is_determiner(word) || token.capital);
        // "a panel fell off".
        let clause = carry.fresh || carry.after_comma && carry.has_verb && carry.joint.is_some();
        let begins = matches!(word, "a" | "an" | "the" | "several" | "some" | "two" | "one");
        carry.stranger |= clause && !waits && begins && matches!(next, Some(Chunk::Word));
        true
    }

    /// The verb that a word is which nobody knows, by what stands around it.
    fn tells_event(&self, word: &str, all: &[Placed], at: usize, carry: &Carry) -> Option<(Sense, Form)> {
        if self.touches_by_parts(word, all, at, carry) || self.guesses && self.may_touch(all, at, carry) {
            return Some((Sense::Contact, Form::Past));
        }
        // "The AV misjudged a van's speed and turned": what it did to the van.
        if self.does_something(all, at, carry) {
            return Some((Sense::Other, Form::Past));
        }
        let form = if word.ends_with("ing") { Form::Ing } else { Form::Past };
        self.draws_a_trailer(all, at, carry).then_some((Sense::Tow, form))
    }

    /// "about to", "in the process of": how far the next verb came.
    fn says_how_far(&self, word: &str, placed: &Placed, next: Option<&Chunk>) -> Option<Progress> {
        // "time to turn" is no turn; "at which time it turned" is one.
        let waits_for = !matches!(word, "about" | "time" | "space" | "room" | "set" | "order" | "ready" | "route")
            || matches!(next, Some(Chunk::Preposition("to" | "for")));
        // "nudged over in order to get by": a purpose like any other.
        let in_order = word == "order" && placed.first > 0 && self.tokens[placed.first - 1].text == "in";
        self.lexicon.progress(word).filter(|_| waits_for && !in_order)
    }

    /// "a collision occurred involving two vans", "A collision involving it and a van occurred on Elm Street": between them.
    fn involves(&mut self, all: &[Placed], at: usize, carry: &mut Carry) -> bool {
        let told = |frame: usize| self.frames[frame].sense == Sense::ContactMade && self.frames[frame].who.is_none();
        let noun = all[at].first.checked_sub(1).map_or("", |before| self.tokens[before].text.as_str());
        let crash = is_crash_noun(noun);
        if carry.frame.is_some_and(told) {
            carry.preposition = Some("between");
            return true;
        }
        let begins = crash && carry.frame.is_none() && carry.main.is_none();
        if begins {
            self.verb(Sense::ContactMade, Form::Past, all, at, carry);
            carry.preposition = Some("between");
        }
        begins
    }
}

/// "the junction where Elm Street merges with Oak Street": nobody of the story does that.
fn begin_place(all: &[Placed], at: usize, carry: &mut Carry) {
    // "moved into the left lane, where a van was driving": in that lane.
    let back = at - usize::from(at > 0 && matches!(all[at - 1].chunk, Chunk::Comma));
    if let Some(Placed { chunk: Chunk::Lane(lane), first, end }) = back.checked_sub(1).map(|lane| &all[lane]) {
        carry.lead_lane = Some((*lane, *first, *end));
    }
    (carry.subject, carry.frame, carry.has_verb) = (None, None, false);
    (carry.place, carry.fresh) = (true, true);
}
