//! Directions behind a verb or a noun: "traveling north", "northbound in the bus lane".

use super::Frame;
use super::parser::{Carry, Parser};
use crate::chunk::Placed;
use crate::lexicon::{Form, Part};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Compass};

/// A direction where it stands.
struct Heading {
    /// With its tokens.
    stands: (Compass, usize, usize),
    /// It is told from where: "came from the north".
    from: bool,
    /// It is told by its bare name: "north", and not "northbound".
    bare: bool,
    /// It is that of the road it goes into.
    onto: bool,
    /// A preposition stands before it.
    governed: bool,
    /// It is that of a place: "at", "near".
    there: bool,
}

impl Parser<'_> {
    /// A direction is of the verb, of whom the clause is about, or of who is named next.
    pub(super) fn compass(&mut self, compass: Compass, placed: &Placed, carry: &mut Carry) {
        if self.is_of_a_place(placed) {
            return;
        }
        if self.is_of_a_road(placed, carry) || self.is_crossed(placed, carry) {
            carry.preposition = None;
            return;
        }
        let from = self.comes_from_there(placed, carry);
        let bare = matches!(self.tokens[placed.first].text.as_str(), "north" | "south" | "east" | "west");
        // "arrived from the west" goes east.
        let compass = if from && bare { compass.turned(4) } else { compass };
        let stands = (compass, placed.first, placed.end);
        if let Some(other) = self.named_in_lane(placed, carry).or_else(|| nose_of(placed, carry)) {
            self.world.actors[other].heading.get_or_insert(stands);
            carry.preposition = None;
            return;
        }
        let heading = Heading {
            stands,
            from,
            bare,
            onto: self.leads_onto(placed, carry),
            governed: carry.preposition.is_some(),
            there: matches!(carry.preposition, Some("at" | "near")),
        };
        carry.preposition = None;
        // Behind a noun that is an object: "a truck facing east" has its own frame; "yield to a van northbound on ..." is rare.
        if let Some(turn) = carry.frame.and_then(|frame| self.turned_to_go(frame)) {
            (self.frames[turn].heading, self.frames[turn].onto) = (Some(stands), true);
            return;
        }
        match carry.frame {
            Some(frame) => self.heads(frame, &heading, carry),
            None => self.clause_heads(&heading, carry),
        }
    }

    /// "off the south sidewalk" is a place, "blocking the view toward the west" a way to look.
    fn is_of_a_place(&self, placed: &Placed) -> bool {
        let place = self.tokens.get(placed.end).is_some_and(|next| {
            matches!(
                next.text.as_str(),
                "sidewalk" | "side" | "curb" | "corner" | "crosswalk" | "leg" | "end" | "shoulder"
            )
        });
        let before = &self.tokens[placed.first.saturating_sub(4)..placed.first];
        place || before.iter().any(|token| matches!(token.text.as_str(), "view" | "sight" | "visibility"))
    }

    /// "at the junction with the westbound Route 9", "drove across the westbound lanes": not its own.
    fn is_of_a_road(&self, placed: &Placed, carry: &Carry) -> bool {
        let road = || {
            self.tokens[placed.end..].iter().take(4).any(|next| {
                matches!(next.text.as_str(), "interstate" | "highway" | "freeway" | "route" | "exit" | "ramp" | "ramps")
            })
        };
        match carry.preposition {
            Some("with" | "across" | "over") => true,
            Some("at" | "near") => road(),
            _ => false,
        }
    }

    /// "which came from the north", "turned left off northbound Elm Street"; but "from south to north" goes north.
    fn comes_from_there(&self, placed: &Placed, carry: &Carry) -> bool {
        let before = &self.tokens[placed.first.saturating_sub(4)..placed.first];
        let turns = carry.frame.is_some_and(|frame| self.frames[frame].act() == Some(Act::Turn));
        // The verb has that word.
        let the = usize::from(before.last().is_some_and(|token| token.text == "the"));
        let came = before.iter().rev().nth(the).is_some_and(|token| token.text == "from");
        let from = carry.preposition == Some("from") || came || turns && carry.preposition == Some("off");
        let pair = placed.end == placed.first + 3 && self.tokens[placed.first + 1].text == "to";
        from && !pair
    }

    /// "onto northbound Elm Street", "to northbound Elm Street". "driving to the north": so it drove.
    fn leads_onto(&self, placed: &Placed, carry: &Carry) -> bool {
        let drives =
            carry.frame.is_none_or(|frame| matches!(self.frames[frame].act(), Some(Act::Follow | Act::SetOff)));
        let to = drives && placed.first > 0 && self.tokens[placed.first - 1].text == "the";
        matches!(carry.preposition, Some("onto" | "into")) || carry.preposition == Some("to") && !to
    }

    /// "traveling north", "turned onto northbound Elm Street": of the frame, and of who does it.
    fn heads(&mut self, frame: usize, heading: &Heading, carry: &Carry) {
        let (stands, taken) = (heading.stands, &mut self.frames[frame]);
        if let (true, Some(who)) = (heading.from, taken.who) {
            self.world.actors[who].heading.get_or_insert(stands);
            return;
        }
        let turns = matches!(taken.act(), Some(Act::Turn | Act::UTurn | Act::PullOut | Act::Enter | Act::LaneChange));
        if taken.heading.is_none() {
            taken.heading = Some(stands);
            taken.onto = !heading.from && (heading.onto || (turns && taken.act() != Some(Act::Enter)));
        }
        let (who, onto) = (taken.who, taken.onto);
        // "It and a van were traveling north": both.
        for who in who.into_iter().chain(carry.also.as_ref().map(|also| also.actor)).filter(|_| !onto) {
            self.world.actors[who].heading.get_or_insert(stands);
        }
    }

    /// A direction before any verb: of whom the clause is about, or of who is named next.
    fn clause_heads(&mut self, heading: &Heading, carry: &mut Carry) {
        if let Some(subject) = &carry.subject {
            for who in [Some(subject), carry.also.as_ref()].into_iter().flatten() {
                self.world.actors[who.actor].heading.get_or_insert(heading.stands);
            }
            return;
        }
        // "With it northbound in the bus lane": who stands behind "with".
        let with = |end: usize| end == heading.stands.1 && self.is_behind_with(end);
        if let Some(last) = carry.last.as_ref().filter(|last| with(last.end)) {
            self.world.actors[last.actor].heading.get_or_insert(heading.stands);
        } else if carry.main.is_none() && !(heading.from && heading.bare || heading.onto || heading.there) {
            carry.lead_heading = carry.lead_heading.or(Some((heading.stands, heading.governed)));
        }
    }

    /// "turned left to go west", "a right turn so as to continue east": the turn whose way this is.
    fn turned_to_go(&self, frame: usize) -> Option<usize> {
        let turn = frame.checked_sub(1)?;
        let (before, goes) = (&self.frames[turn], &self.frames[frame]);
        let turns = matches!(before.act(), Some(Act::Turn)) && before.heading.is_none();
        let verb = self.tokens[goes.first].text.as_str();
        let on = goes.form == Form::Base && matches!(verb, "go" | "continue" | "head" | "proceed" | "travel" | "drive");
        let one = before.who == goes.who && before.sentence == goes.sentence;
        (turns && on && one && goes.act() == Some(Act::Follow)).then_some(turn)
    }

    /// "It slowed for cars in the eastbound lane": whom the lane is told of, where the direction of who slowed is known.
    fn named_in_lane(&self, placed: &Placed, carry: &Carry) -> Option<Actor> {
        let lane = matches!(word(self.tokens, placed.end), "lane" | "lanes" | "direction");
        let last = carry.last.as_ref().filter(|last| lane && last.piece.is_none() && last.actor != SUBJECT)?;
        let behind = matches!(word(self.tokens, last.end), "in" | "on")
            && word(self.tokens, last.end + 1) == "the"
            && last.end + 2 == placed.first;
        let frame = &self.frames[carry.frame?];
        let known = frame.who.is_some_and(|who| who != last.actor && self.world.actors[who].heading.is_some());
        (behind && known).then_some(last.actor)
    }

    /// Whether a direction is that of a lane which somebody crosses, or stops in on its way across.
    fn is_crossed(&self, placed: &Placed, carry: &Carry) -> bool {
        let lane = self.tokens.get(placed.end).is_some_and(|next| matches!(next.text.as_str(), "lane" | "lanes"));
        let who = carry.frame.and_then(|frame| self.frames[frame].who).or(carry.subject.as_ref().map(|who| who.actor));
        let crosses = |frame: &Frame| {
            frame.who == who
                && frame.happened()
                && frame.act() == Some(Act::Cross)
                && frame.sentence + 1 >= self.sentence
        };
        lane && who.is_some() && self.frames.iter().any(crosses)
    }
}

/// "with its nose to the north": who faces so.
fn nose_of(placed: &Placed, carry: &Carry) -> Option<Actor> {
    let nose = carry.last.as_ref().filter(|last| {
        let front = last.piece.as_ref().is_some_and(|piece| piece.parts == [Part::Front]);
        front && (last.end + 1..=last.end + 2).contains(&placed.first) && carry.preposition == Some("to")
    });
    nose.map(|nose| nose.actor)
}
