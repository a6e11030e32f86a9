//! What stands behind a verb and belongs to it: parts, sides, where somebody is.

use super::parser::{Carry, Parser};
use super::sided;
use crate::chunk::{Chunk, Piece, Placed, is_along_a_side};
use crate::lexicon::{Form, Part, Relation, Sense};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Kind, LeftRight};

/// "on its left side, at the rear bumper": so near stands the end of a side that was touched. [tokens]
const END_WITHIN: usize = 3;

/// A relation where it stands.
struct Here<'a> {
    relation: Relation,
    placed: &'a Placed,
    next: Option<&'a Chunk>,
    /// Whom it is seen from is named next.
    governs: bool,
}

impl Here<'_> {
    /// "to the left" is a side of what is done there, or a place.
    const fn side(&self) -> Option<LeftRight> {
        match self.relation {
            Relation::Left => Some(LeftRight::Left),
            Relation::Right => Some(LeftRight::Right),
            _ => None,
        }
    }
}

impl Parser<'_> {
    /// A part whose owner is not said: "made contact with the rear bumper".
    pub(super) fn loose_piece(&mut self, piece: &Piece, placed: &Placed, carry: &mut Carry) {
        let Some(frame) = carry.frame else {
            return;
        };
        let touches =
            matches!(self.frames[frame].sense, Sense::Contact | Sense::ContactMade | Sense::Damage | Sense::RearEnd);
        if touches && self.frames[frame].on.is_none() {
            self.frames[frame].on = Some(piece.clone());
            self.frames[frame].end = placed.end;
            // "made contact, left side to left side".
            let words =
                |from: usize, to: usize| self.tokens.get(from..to).unwrap_or_default().iter().map(|token| &token.text);
            let (to, long) = (placed.end, placed.end - placed.first);
            let both = self.tokens.get(to).is_some_and(|next| matches!(next.text.as_str(), "to" | "against"))
                && words(to + 1, to + 1 + long).eq(words(placed.first, placed.end));
            if both && piece.side().is_some() && self.frames[frame].with.is_none() {
                self.frames[frame].with = Some(piece.clone());
            }
        }
        // "was hit on its left side, at the rear bumper": where on that side.
        let words = |from: usize, to: usize| self.tokens[from.min(to)..to].iter().map(|token| token.text.as_str());
        let between = words(self.frames[frame].end, placed.first)
            .all(|word| matches!(word, "," | "at" | "on" | "and" | "in" | "side"));
        let inner = words(placed.first, placed.end).any(is_along_a_side);
        let near = touches && between && !inner && placed.first <= self.frames[frame].end + END_WITHIN;
        let end: Vec<Part> =
            piece.parts.iter().copied().filter(|part| matches!(part, Part::Front | Part::Rear)).collect();
        if let Some(on) = self.frames[frame].on.as_mut().filter(|on| near && on.parts.len() == 1 && on.side().is_some())
            && piece.side().is_none()
        {
            on.parts.extend(end);
        }
        (carry.preposition, carry.relation) = (None, None);
    }

    /// Where somebody is: of the frame, or of the noun before.
    pub(super) fn relate(&mut self, relation: Relation, to: Option<Actor>, carry: &mut Carry) {
        let named = self
            .is_behind_its_noun(to, carry)
            .or_else(|| self.touched_there(relation, to, carry))
            .or_else(|| self.passed_there(relation, to, carry));
        if let Some(named) = named {
            return self.note(named, relation);
        }
        let Some(who) = self.whose_place(relation, to, carry) else { return };
        if self.approaches_another(relation, to, carry)
            || self.ends_there(who, relation, carry)
            || self.leads_past(relation, to, carry)
        {
            return;
        }
        match to {
            Some(SUBJECT) | None if who != SUBJECT => self.note(who, relation),
            Some(other) if who == SUBJECT && other != SUBJECT => {
                let turned = match relation {
                    Relation::Behind => Relation::Ahead,
                    Relation::Ahead => Relation::Behind,
                    Relation::Left => Relation::Right,
                    Relation::Right => Relation::Left,
                    same => same,
                };
                self.note(other, turned);
            }
            Some(other) if who != SUBJECT && who != other => {
                self.world.actors[who].seen_from.push((relation, other));
            }
            _ => {}
        }
    }

    /// "with a van behind it": of the noun that stands behind "with".
    fn is_behind_its_noun(&self, to: Option<Actor>, carry: &Carry) -> Option<Actor> {
        let last = carry.last.as_ref().filter(|_| to.is_none_or(|to| to == SUBJECT) && self.stands_with(carry))?;
        Some(last.actor)
    }

    /// "made contact with the van ahead", "made contact with a van behind it": the van.
    fn touched_there(&self, relation: Relation, to: Option<Actor>, carry: &Carry) -> Option<Actor> {
        let frame = &self.frames[carry.frame?];
        let last = carry.last.as_ref().map(|last| last.actor).filter(|last| *last != SUBJECT)?;
        let behind_it = to == Some(SUBJECT) && relation == Relation::Behind;
        let there = to.is_none() && matches!(relation, Relation::Ahead | Relation::Left | Relation::Right);
        let touched = frame.is_contact() && frame.who == Some(SUBJECT) && frame.object == Some(last);
        (touched && (behind_it || there)).then_some(last)
    }

    /// "was waiting to pass a van in front", "went around one directly ahead of it": whom it was to pass.
    fn passed_there(&self, relation: Relation, to: Option<Actor>, carry: &Carry) -> Option<Actor> {
        let frame = &self.frames[carry.frame?];
        let object = frame.object.filter(|object| *object != SUBJECT)?;
        let passes = frame.act() == Some(Act::Pass) && relation == Relation::Ahead && frame.who == Some(SUBJECT);
        let of_it = to.is_none_or(|to| to == SUBJECT || to == object);
        let named_last = carry.last.as_ref().is_some_and(|last| last.actor == object);
        (passes && !frame.described && of_it && named_last).then_some(object)
    }

    /// Whose place it is that is told here; a frame that does not tell it of its object keeps it.
    fn whose_place(&mut self, relation: Relation, to: Option<Actor>, carry: &mut Carry) -> Option<Actor> {
        if let Some(frame) = carry.frame {
            // "stopped behind a van": who stopped. "yield to a car ahead of the van": the car.
            let governed = || carry.governed_object(&self.frames[frame]) && !self.comes_over(frame, relation, carry);
            let of_object = carry.last.is_some() && (self.is_off_one_ahead(relation, carry) || governed());
            if of_object || self.is_of_passed(to, carry) {
                return carry.last.as_ref().map(|last| last.actor);
            }
            self.frames[frame].relations.push((relation, to));
            return self.frames[frame].who.or_else(|| self.drives_there(&self.frames[frame], carry));
        }
        if let Some(subject) = &carry.subject {
            return Some(subject.actor);
        }
        if let Some(last) = carry.last.as_ref().filter(|last| to == Some(SUBJECT) && self.is_of_row(last.end)) {
            return Some(last.actor);
        }
        if carry.main.is_none() && to.is_none_or(|to| to == SUBJECT) {
            // "To its right and behind it, a van": beside it first.
            carry.lead.get_or_insert(relation);
        }
        None
    }

    /// "fell off the vehicle ahead of it": that vehicle.
    fn is_off_one_ahead(&self, relation: Relation, carry: &Carry) -> bool {
        relation == Relation::Ahead && self.fell_off_last(carry)
    }

    /// "approached the car from behind": behind the car.
    fn approaches_another(&self, relation: Relation, to: Option<Actor>, carry: &Carry) -> bool {
        carry.frame.is_some_and(|frame| {
            let frame = &self.frames[frame];
            let other = frame.object.filter(|object| *object != SUBJECT && Some(*object) != frame.who);
            frame.sense == Sense::Approach
                && relation == Relation::Behind
                && to.is_none()
                && other.is_some_and(|other| self.world.actors[other].acts())
        })
    }

    /// "turned in front of it", "passed it and cut back in ahead of it": where the act ends, and not where it was.
    fn ends_there(&self, who: Actor, relation: Relation, carry: &Carry) -> bool {
        if relation != Relation::Ahead {
            return false;
        }
        let act = carry.frame.and_then(|frame| self.frames[frame].act());
        let across = matches!(
            act,
            Some(
                Act::Turn
                    | Act::UTurn
                    | Act::Cross
                    | Act::Pass
                    | Act::PullOut
                    | Act::Enter
                    | Act::LaneChange
                    | Act::Swerve
                    | Act::LoseControl
                    | Act::Fall
                    | Act::Roll
            )
        );
        let passed = |before: &super::Frame| {
            before.sentence == self.sentence && before.who == Some(who) && before.act() == Some(Act::Pass)
        };
        across && !self.is_off_one_ahead(relation, carry)
            || act == Some(Act::LaneChange) && self.frames.iter().any(passed)
    }

    /// "passing behind it", "crossed behind it": where its path lies, and not where it came from.
    fn leads_past(&self, relation: Relation, to: Option<Actor>, carry: &Carry) -> bool {
        let path = |frame: &super::Frame| {
            matches!(frame.act(), Some(Act::Pass | Act::Cross))
                && self.tokens[frame.end.min(self.tokens.len() - 1)].text == "behind"
        };
        relation == Relation::Behind
            && to == Some(SUBJECT)
            && carry.frame.is_some_and(|frame| path(&self.frames[frame]))
    }

    /// "changing into the AV's lane from the left": who comes from there, and not whose lane it is.
    fn comes_over(&self, frame: usize, relation: Relation, carry: &Carry) -> bool {
        let of_subject = carry.last.as_ref().is_some_and(|last| last.actor == SUBJECT);
        let aside = matches!(relation, Relation::Left | Relation::Right);
        let over = matches!(
            self.frames[frame].act(),
            Some(Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter | Act::PullOut | Act::Turn)
        );
        of_subject && aside && over
    }

    /// "Tires fell off a trailer pulled by a van traveling ahead of it": of tires the sentence is, and the van travels there.
    fn drives_there(&self, frame: &super::Frame, carry: &Carry) -> Option<Actor> {
        let last = carry.last.as_ref().filter(|last| last.end == frame.first && last.piece.is_none())?;
        let drives = self.world.actors[last.actor].kind.is_some_and(Kind::is_vehicle);
        (carry.stranger && drives && frame.form == Form::Ing && frame.act() == Some(Act::Follow)).then_some(last.actor)
    }

    /// "passing a line of cars behind the truck": the cars are, where the truck is none of the two.
    fn is_of_passed(&self, to: Option<Actor>, carry: &Carry) -> bool {
        let (Some(frame), Some(last), Some(to)) = (carry.frame, &carry.last, to) else { return false };
        let frame = &self.frames[frame];
        let third = to != SUBJECT && to != last.actor && frame.who != Some(to);
        // "passed it and the car behind it": the car.
        let second = frame.object == Some(to) && carry.governed && last.actor != SUBJECT;
        if second && frame.act() == Some(Act::Pass) && frame.who != Some(last.actor) && last.actor != to {
            return true;
        }
        third && frame.act() == Some(Act::Pass) && frame.object == Some(last.actor) && last.actor != SUBJECT
    }

    /// Whether something is told to fall off the vehicle that was named last.
    fn fell_off_last(&self, carry: &Carry) -> bool {
        let (Some(frame), Some(last)) = (carry.frame, &carry.last) else { return false };
        let frame = &self.frames[frame];
        // "came out from under the van ahead of it".
        let under = self.tokens[frame.first..last.end.max(frame.first)]
            .iter()
            .any(|token| matches!(token.text.as_str(), "under" | "underneath" | "beneath"));
        (frame.act() == Some(Act::Fall) || frame.act() == Some(Act::Enter) && under)
            && carry.governed
            && frame.who != Some(last.actor)
            && self.world.actors[last.actor].kind.is_some_and(|kind| kind.is_vehicle())
    }

    pub(super) fn follows(&mut self, who: Option<Actor>, whom: Actor) {
        match who {
            Some(SUBJECT) if whom != SUBJECT => self.note(whom, Relation::Ahead),
            Some(who) if whom == SUBJECT && who != SUBJECT => self.note(who, Relation::Behind),
            _ => {}
        }
    }

    pub(super) fn note(&mut self, actor: Actor, relation: Relation) {
        self.world.actors[actor].place(relation, self.sentence);
    }

    /// A relation waits for its noun, or tells a side of what is done, or where somebody is.
    pub(super) fn relation(&mut self, relation: Relation, placed: &Placed, carry: &mut Carry, next: Option<&Chunk>) {
        let here = Here { relation, placed, next, governs: self.governs(placed, carry, next) };
        if self.goes_ahead(&here, carry) || self.is_on_a_part(&here, carry) || self.is_at_a_place(&here, carry) {
            return;
        }
        if self.goes_to_side(&here, carry) {
            return;
        }
        self.leaves_lane(here.side(), placed, carry);
        if self.is_struck_on_side(&here, carry) {
            return;
        }
        if here.governs {
            carry.relation = Some(relation);
            carry.preposition = None;
        } else {
            self.relate(relation, None, carry);
        }
    }

    /// Whether whom a relation is seen from is named next: "behind the van".
    fn governs(&self, placed: &Placed, carry: &Carry, next: Option<&Chunk>) -> bool {
        let named = match next {
            Some(Chunk::Noun(_) | Chunk::Pronoun) => true,
            Some(Chunk::Piece(piece)) => piece.owner.is_some() || piece.its,
            _ => false,
        };
        // "From an alley on the left a van came".
        let indefinite = matches!(next, Some(Chunk::Noun(noun)) if noun.article == crate::chunk::Article::Indefinite);
        let side = matches!(self.tokens[placed.end - 1].text.as_str(), "left" | "right" | "ahead" | "rear" | "lane");
        let begins = indefinite && side && carry.frame.is_none() && carry.subject.is_none();
        named && !self.is_possessed(placed) && !begins
    }

    /// "going by it on its left a cyclist slipped": whose left it is stands there.
    fn is_possessed(&self, placed: &Placed) -> bool {
        self.tokens[placed.first..placed.end].iter().any(|token| matches!(token.text.as_str(), "its" | "'s"))
    }

    /// "drove straight ahead", "pulled ahead and": so it went, and nobody is there.
    fn goes_ahead(&self, here: &Here<'_>, carry: &Carry) -> bool {
        let placed = here.placed;
        let goes = |frame: &super::Frame| {
            let along = matches!(frame.act(), Some(Act::Follow | Act::SetOff | Act::Accelerate));
            let straight =
                |token: &crate::token::Token| matches!(token.text.as_str(), "straight" | "right" | "on" | "slowly");
            along && frame.form == Form::Past && self.tokens[frame.end..placed.first].iter().all(straight)
        };
        let ahead = placed.end == placed.first + 1 && self.tokens[placed.first].text == "ahead";
        ahead && !here.governs && carry.frame.is_some_and(|frame| goes(&self.frames[frame]))
    }

    /// "hit the van behind the front wheel": where on the van.
    fn is_on_a_part(&self, here: &Here<'_>, carry: &Carry) -> bool {
        let part = matches!(here.next, Some(Chunk::Piece(piece)) if piece.owner.is_none() && !piece.its);
        let touches = carry.frame.is_some_and(|frame| self.frames[frame].is_contact());
        part && touches && matches!(here.relation, Relation::Behind | Relation::Ahead)
    }

    /// "behind [XXX]", "next to the mall": places.
    fn is_at_a_place(&self, here: &Here<'_>, carry: &Carry) -> bool {
        let placed = here.placed;
        let last = self.tokens[placed.end - 1].text.as_str();
        let needs_noun = matches!(last, "of" | "to" | "alongside" | "beside")
            || (last == "behind" && placed.end == placed.first + 1);
        if !needs_noun || !matches!(here.next, Some(Chunk::Word)) {
            return false;
        }
        let of_street = (placed.first..placed.end).any(|at| self.tokens[at].text == "side")
            && self.tokens.get(placed.end).is_some_and(|next| next.capital);
        // "passing on the left of a line of cars": the side on which it passes.
        let passes = carry.frame.is_some_and(|frame| self.frames[frame].act() == Some(Act::Pass));
        let row = last == "of" && passes && self.is_row(placed.end);
        !self.of_road(placed.end) && !of_street && !row
    }

    /// "turned to the left", "passed on its right": a side of what is done there.
    fn goes_to_side(&mut self, here: &Here<'_>, carry: &mut Carry) -> bool {
        let (Some(side), Some(frame)) = (here.side(), carry.frame) else { return false };
        let taken = &self.frames[frame];
        let takes_side = taken.act().is_some_and(sided)
            && !self.is_side_of_a_place(here, frame)
            && taken.sense != Sense::Parked
            && taken.side.is_none();
        if !takes_side {
            return false;
        }
        // "overtaking it from the left adjacent lane": there it was, too.
        let who = taken.who.filter(|who| *who != SUBJECT && taken.object == Some(SUBJECT));
        if let Some(who) = who.filter(|_| self.is_from_a_lane(here.placed)) {
            self.note(who, here.relation);
        }
        (self.frames[frame].side, self.frames[frame].end) = (Some(side), here.placed.end);
        if here.governs {
            carry.relation = None;
            carry.preposition = Some("around");
        }
        true
    }

    /// "pulled out of a driveway on the right", "merged from a ramp on the right": a place, and no side of what is done.
    fn is_side_of_a_place(&self, here: &Here<'_>, frame: usize) -> bool {
        let (placed, frame) = (here.placed, &self.frames[frame]);
        let first = self.tokens[placed.first].text.as_str();
        // "pulled into the lane on its left": over to that side.
        let of_lane = matches!(frame.act(), Some(Act::LaneChange | Act::Drift))
            && first == "on"
            && frame.end == placed.first
            && self.tokens[placed.first - 1].text == "lane";
        let located = matches!(first, "on" | "from" | "in") && !of_lane;
        match frame.act() {
            Some(Act::Park | Act::PullOver) => here.governs,
            // "fell to the left", and not "fell to the left of the van".
            Some(Act::Fall | Act::PullOut) => located || here.governs,
            Some(Act::LaneChange | Act::Drift | Act::Swerve | Act::Turn | Act::UTurn) => located,
            _ => false,
        }
    }

    /// "struck the AV on the passenger side": where it was struck.
    fn is_struck_on_side(&mut self, here: &Here<'_>, carry: &Carry) -> bool {
        let (Some(side), Some(frame), false) = (here.side(), carry.frame, here.governs) else { return false };
        let (placed, taken) = (here.placed, &self.frames[frame]);
        let struck = taken.is_contact() && taken.object.is_some() && taken.on.is_none();
        let of_side = || {
            let next = || self.tokens.get(placed.end).is_some_and(|next| next.text == "side");
            self.tokens[placed.end - 1].text == "side" || self.is_possessed(placed) && (taken.passive || next())
        };
        let on_side = struck && self.tokens[placed.first].text == "on" && of_side();
        if on_side {
            let part = if side == LeftRight::Left { Part::Left } else { Part::Right };
            (self.frames[frame].on, self.frames[frame].end) = (Some(Piece::of(part)), placed.end);
        }
        on_side
    }

    /// "from the right adjacent lane".
    fn is_from_a_lane(&self, placed: &Placed) -> bool {
        let words = &self.tokens[placed.first..placed.end];
        words[0].text == "from" && words.iter().any(|token| token.text == "lane")
    }

    /// "moved over from the right adjacent lane": to the left.
    fn leaves_lane(&mut self, side: Option<LeftRight>, placed: &Placed, carry: &Carry) {
        let (Some(side), Some(frame), true) = (side, carry.frame, self.is_from_a_lane(placed)) else { return };
        let taken = &mut self.frames[frame];
        if taken.act().is_some_and(Act::leaves_line) && taken.side.is_none() {
            taken.side = Some(side.other());
        }
    }

    /// "a line of cars".
    fn is_row(&self, at: usize) -> bool {
        let at = at + usize::from(matches!(word(self.tokens, at), "a" | "the"));
        matches!(word(self.tokens, at), "line" | "row" | "queue" | "column" | "string")
            && word(self.tokens, at + 1) == "of"
    }

    /// Whether a noun that ends here is one of "a line of cars", "the queue of stopped vehicles".
    fn is_of_row(&self, end: usize) -> bool {
        let words = &self.tokens[end.saturating_sub(4)..end];
        words.windows(2).any(|pair| {
            matches!(pair[0].text.as_str(), "line" | "row" | "queue" | "column" | "string") && pair[1].text == "of"
        })
    }

    /// "on the left side of the roadway".
    pub(super) fn of_road(&self, at: usize) -> bool {
        self.tokens.get(at..(at + 3).min(self.tokens.len())).unwrap_or_default().iter().any(|token| {
            matches!(
                token.text.as_str(),
                "road"
                    | "roadway"
                    | "street"
                    | "alley"
                    | "alleyway"
                    | "driveway"
                    | "lane"
                    | "highway"
                    | "path"
                    | "aisle"
                    | "ramp"
                    | "avenue"
            )
        })
    }

    pub(super) fn side(&mut self, side: LeftRight, carry: &Carry) {
        // "moved left": over.
        if let Some(frame) = carry.frame
            && self.frames[frame].sense == Sense::Act(Act::Follow)
            && !self.is_turning(frame)
            && ["mov", "slid", "swung"].iter().any(|stem| self.tokens[self.frames[frame].first].text.starts_with(stem))
        {
            self.frames[frame].sense = Sense::Act(Act::Drift);
        }
        if let Some(frame) = carry.frame
            && self.frames[frame].act().is_some_and(sided)
            && self.frames[frame].side.is_none()
        {
            self.frames[frame].side = Some(side);
        }
    }

    /// "turned at the corner, moving left": the act before it, of the same sentence, is a turn.
    fn is_turning(&self, frame: usize) -> bool {
        let taken = &self.frames[frame];
        let mut before = self.frames[..frame].iter().rev().take_while(|before| before.sentence == taken.sentence);
        before.any(|before| before.who == taken.who && before.act() == Some(Act::Turn))
    }
}
