//! What stands behind a verb and belongs to it: where somebody is, directions, sides, lanes, places.

use super::parser::{Carry, Parser};
use super::sided;
use crate::chunk::{Chunk, Piece, Placed, Spot, is_along_a_side};
use crate::lexicon::{Form, Part, Relation, Sense};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Compass, Kind, KindGroup, LaneWord, LeftRight};

/// "on its left side, at the rear bumper": so near stands the end of a side that was touched. [tokens]
const END_WITHIN: usize = 3;

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
        if let Some(last) = carry.last.clone().filter(|_| to.is_none_or(|to| to == SUBJECT) && self.stands_with(carry))
        {
            return self.note(last.actor, relation);
        }
        // "fell off the vehicle ahead of it": that vehicle.
        let fell_off = relation == Relation::Ahead && self.fell_off_last(carry);
        let mut who = None;
        if let Some(frame) = carry.frame {
            // "made contact with the van ahead": the van.
            // "made contact with a van behind it": the van.
            let named = to == Some(SUBJECT) && relation == Relation::Behind;
            if let (true, Some(last)) = (to.is_none() || named, &carry.last)
                && self.frames[frame].is_contact()
                && self.frames[frame].who == Some(SUBJECT)
                && self.frames[frame].object == Some(last.actor)
                && last.actor != SUBJECT
                && (named || matches!(relation, Relation::Ahead | Relation::Left | Relation::Right))
            {
                return self.note(last.actor, relation);
            }
            // "was waiting to pass a van in front", "went around one directly ahead of it": whom it was to pass.
            let taken = &self.frames[frame];
            let wished = taken.act() == Some(Act::Pass) && relation == Relation::Ahead && taken.who == Some(SUBJECT);
            if let (true, Some(object)) = (wished && !taken.described, taken.object.filter(|object| *object != SUBJECT))
                && to.is_none_or(|to| to == SUBJECT || to == object)
                && carry.last.as_ref().is_some_and(|last| last.actor == object)
            {
                return self.note(object, relation);
            }
            // "stopped behind a van": who stopped. "yield to a car ahead of the van": the car.
            let governed = || carry.governed_object(&self.frames[frame]) && !self.comes_over(frame, relation, carry);
            let of_object = carry.last.is_some() && (fell_off || governed());
            if of_object || self.is_of_passed(to, carry) {
                who = carry.last.as_ref().map(|last| last.actor);
            } else {
                self.frames[frame].relations.push((relation, to));
                who = self.frames[frame].who.or_else(|| self.drives_there(&self.frames[frame], carry));
            }
        } else if let Some(subject) = &carry.subject {
            who = Some(subject.actor);
        } else if let Some(last) = carry.last.as_ref().filter(|last| to == Some(SUBJECT) && self.is_of_row(last.end)) {
            who = Some(last.actor);
        } else if carry.main.is_none() && to.is_none_or(|to| to == SUBJECT) {
            // "To its right and behind it, a van": beside it first.
            carry.lead.get_or_insert(relation);
        }
        let Some(who) = who else { return };
        // "approached the car from behind": behind the car.
        let of_another = carry.frame.is_some_and(|frame| {
            let frame = &self.frames[frame];
            let other = frame.object.filter(|object| *object != SUBJECT && Some(*object) != frame.who);
            frame.sense == Sense::Approach
                && relation == Relation::Behind
                && to.is_none()
                && other.is_some_and(|other| self.world.actors[other].acts())
        });
        if of_another {
            return;
        }
        // "turned in front of it", "passed in front of it": where the act ends, and not where it was.
        let across = carry.frame.and_then(|frame| self.frames[frame].act());
        let ends_there = matches!(
            across,
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
        // "passed it and cut back in ahead of it".
        let passed = across == Some(Act::LaneChange)
            && self.frames.iter().any(|before| {
                before.sentence == self.sentence && before.who == Some(who) && before.act() == Some(Act::Pass)
            });
        if relation == Relation::Ahead && (ends_there && !fell_off || passed) {
            return;
        }
        // "passing behind it", "crossed behind it": where its path lies, and not where it came from.
        let path = carry.frame.map(|frame| &self.frames[frame]).is_some_and(|frame| {
            matches!(frame.act(), Some(Act::Pass | Act::Cross))
                && self.tokens[frame.end.min(self.tokens.len() - 1)].text == "behind"
        });
        if relation == Relation::Behind && path && to == Some(SUBJECT) {
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

    pub(super) fn relation(&mut self, relation: Relation, placed: &Placed, carry: &mut Carry, next: Option<&Chunk>) {
        let governs = match next {
            Some(Chunk::Noun(_) | Chunk::Pronoun) => true,
            Some(Chunk::Piece(piece)) => piece.owner.is_some() || piece.its,
            _ => false,
        };
        // "going by it on its left a cyclist slipped": whose left it is stands there.
        let possessed =
            self.tokens[placed.first..placed.end].iter().any(|token| matches!(token.text.as_str(), "its" | "'s"));
        // "From an alley on the left a van came".
        let indefinite = matches!(next, Some(Chunk::Noun(noun)) if noun.article == crate::chunk::Article::Indefinite);
        let side = matches!(self.tokens[placed.end - 1].text.as_str(), "left" | "right" | "ahead" | "rear" | "lane");
        let begins = indefinite && side && carry.frame.is_none() && carry.subject.is_none();
        let governs = governs && !possessed && !begins;
        // "drove straight ahead", "pulled ahead and": so it went, and nobody is there.
        let goes = carry.frame.map(|frame| &self.frames[frame]).is_some_and(|frame| {
            let along = matches!(frame.act(), Some(Act::Follow | Act::SetOff | Act::Accelerate));
            let straight =
                |token: &crate::token::Token| matches!(token.text.as_str(), "straight" | "right" | "on" | "slowly");
            along && frame.form == Form::Past && self.tokens[frame.end..placed.first].iter().all(straight)
        });
        if goes && !governs && placed.end == placed.first + 1 && self.tokens[placed.first].text == "ahead" {
            return;
        }
        // "hit the van behind the front wheel": where on the van.
        let part = matches!(next, Some(Chunk::Piece(piece)) if piece.owner.is_none() && !piece.its);
        let touches = carry.frame.is_some_and(|frame| self.frames[frame].is_contact());
        if part && touches && matches!(relation, Relation::Behind | Relation::Ahead) {
            return;
        }
        // "behind [XXX]", "next to the mall": places.
        let last = self.tokens[placed.end - 1].text.as_str();
        let needs_noun = matches!(last, "of" | "to" | "alongside" | "beside")
            || (last == "behind" && placed.end == placed.first + 1);
        let of_street = (placed.first..placed.end).any(|at| self.tokens[at].text == "side")
            && self.tokens.get(placed.end).is_some_and(|next| next.capital);
        // "passing on the left of a line of cars": the side on which it passes.
        let passes = carry.frame.is_some_and(|frame| self.frames[frame].act() == Some(Act::Pass));
        let row = last == "of" && passes && self.is_row(placed.end);
        if needs_noun && matches!(next, Some(Chunk::Word)) && !self.of_road(placed.end) && !of_street && !row {
            return;
        }
        // "to the left" is a side of what is done there, or a place.
        let side = match relation {
            Relation::Left => Some(LeftRight::Left),
            Relation::Right => Some(LeftRight::Right),
            _ => None,
        };
        // "pulled out of a driveway on the right", "merged from a ramp on the right": a place, and no side.
        // "pulled into the lane on its left": over to that side.
        let of_lane = carry.frame.is_some_and(|frame| {
            let over = matches!(self.frames[frame].act(), Some(Act::LaneChange | Act::Drift));
            over && self.tokens[placed.first].text == "on"
                && self.frames[frame].end == placed.first
                && self.tokens[placed.first - 1].text == "lane"
        });
        let located = matches!(self.tokens[placed.first].text.as_str(), "on" | "from" | "in") && !of_lane;
        let stays = |act: Option<Act>| match act {
            Some(Act::Park | Act::PullOver) => governs,
            // "fell to the left", and not "fell to the left of the van".
            Some(Act::Fall) => located || governs,
            Some(Act::PullOut | Act::LaneChange | Act::Drift | Act::Swerve | Act::Turn | Act::UTurn) => {
                located || (act == Some(Act::PullOut) && governs)
            }
            _ => false,
        };
        if let (Some(side), Some(frame)) = (side, carry.frame)
            && self.frames[frame].act().is_some_and(sided)
            && !stays(self.frames[frame].act())
            && self.frames[frame].sense != Sense::Parked
            && self.frames[frame].side.is_none()
        {
            self.frames[frame].side = Some(side);
            self.frames[frame].end = placed.end;
            // "overtaking it from the left adjacent lane": there it was, too.
            let who =
                self.frames[frame].who.filter(|who| *who != SUBJECT && self.frames[frame].object == Some(SUBJECT));
            let words = &self.tokens[placed.first..placed.end];
            let lane = words[0].text == "from" && words.iter().any(|token| token.text == "lane");
            if let Some(who) = who.filter(|_| lane) {
                self.note(who, relation);
            }
            if governs {
                carry.relation = None;
                carry.preposition = Some("around");
            }
            return;
        }
        self.leaves_lane(side, placed, carry);
        // "struck the AV on the passenger side": where it was struck.
        let struck = |frame: &super::Frame| frame.is_contact() && frame.object.is_some() && frame.on.is_none();
        if let (Some(part), Some(frame), false) = (
            match relation {
                Relation::Left => Some(Part::Left),
                Relation::Right => Some(Part::Right),
                _ => None,
            },
            carry.frame,
            governs,
        ) && struck(&self.frames[frame])
            && self.tokens[placed.first].text == "on"
            && (self.tokens[placed.end - 1].text == "side"
                || possessed
                    && (self.frames[frame].passive
                        || self.tokens.get(placed.end).is_some_and(|next| next.text == "side")))
        {
            self.frames[frame].on = Some(Piece::of(part));
            self.frames[frame].end = placed.end;
            return;
        }
        if governs {
            carry.relation = Some(relation);
            carry.preposition = None;
        } else {
            self.relate(relation, None, carry);
        }
    }

    /// "moved over from the right adjacent lane": to the left.
    fn leaves_lane(&mut self, side: Option<LeftRight>, placed: &Placed, carry: &Carry) {
        let words = &self.tokens[placed.first..placed.end];
        let lane = words[0].text == "from" && words.iter().any(|token| token.text == "lane");
        let (Some(side), Some(frame), true) = (side, carry.frame, lane) else { return };
        let taken = &mut self.frames[frame];
        if matches!(taken.act(), Some(Act::LaneChange | Act::Drift | Act::Swerve)) && taken.side.is_none() {
            taken.side = Some(side.other());
        }
    }

    /// "a line of cars".
    fn is_row(&self, at: usize) -> bool {
        let word = |at: usize| self.tokens.get(at).map_or("", |token| token.text.as_str());
        let at = at + usize::from(matches!(word(at), "a" | "the"));
        matches!(word(at), "line" | "row" | "queue" | "column" | "string") && word(at + 1) == "of"
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

    pub(super) fn compass(&mut self, compass: Compass, placed: &Placed, carry: &mut Carry) {
        // "off the south sidewalk" is a place.
        let place = self.tokens.get(placed.end).is_some_and(|next| {
            matches!(
                next.text.as_str(),
                "sidewalk" | "side" | "curb" | "corner" | "crosswalk" | "leg" | "end" | "shoulder"
            )
        });
        // "blocking the view toward the west": a way to look.
        let before = &self.tokens[placed.first.saturating_sub(4)..placed.first];
        if place || before.iter().any(|token| matches!(token.text.as_str(), "view" | "sight" | "visibility")) {
            return;
        }
        // "at the junction with the westbound Route 9", "drove across the westbound lanes": not its own.
        let road = || {
            self.tokens[placed.end..].iter().take(4).any(|next| {
                matches!(next.text.as_str(), "interstate" | "highway" | "freeway" | "route" | "exit" | "ramp" | "ramps")
            })
        };
        let of_road = match carry.preposition {
            Some("with" | "across" | "over") => true,
            Some("at" | "near") => road(),
            _ => false,
        };
        if of_road || self.is_crossed(placed, carry) {
            carry.preposition = None;
            return;
        }
        // "turned left off northbound Elm Street".
        let turns = carry.frame.is_some_and(|frame| self.frames[frame].act() == Some(Act::Turn));
        // "which came from the north": the verb has that word.
        let the = usize::from(before.last().is_some_and(|token| token.text == "the"));
        let came = before.iter().rev().nth(the).is_some_and(|token| token.text == "from");
        let from = carry.preposition == Some("from") || came || turns && carry.preposition == Some("off");
        // "arrived from the west" goes east.
        // "from south to north" goes north.
        let pair = placed.end == placed.first + 3 && self.tokens[placed.first + 1].text == "to";
        let from = from && !pair;
        let bare = matches!(self.tokens[placed.first].text.as_str(), "north" | "south" | "east" | "west");
        let compass = if from && bare { compass.turned(4) } else { compass };
        let stands = (compass, placed.first, placed.end);
        if let Some(other) = self.named_in_lane(placed, carry) {
            self.world.actors[other].heading.get_or_insert(stands);
            carry.preposition = None;
            return;
        }
        // "driving to the north": so it drove.
        let drives =
            carry.frame.is_none_or(|frame| matches!(self.frames[frame].act(), Some(Act::Follow | Act::SetOff)));
        let to = drives && placed.first > 0 && self.tokens[placed.first - 1].text == "the";
        // "with its nose to the north": so it faces.
        let nose = carry.last.as_ref().filter(|last| {
            let front = last.piece.as_ref().is_some_and(|piece| piece.parts == [Part::Front]);
            front && (last.end + 1..=last.end + 2).contains(&placed.first) && carry.preposition == Some("to")
        });
        if let Some(nose) = nose {
            self.world.actors[nose.actor].heading.get_or_insert(stands);
            carry.preposition = None;
            return;
        }
        let onto = matches!(carry.preposition, Some("onto" | "into")) || carry.preposition == Some("to") && !to;
        let (governed, there) = (carry.preposition.is_some(), matches!(carry.preposition, Some("at" | "near")));
        carry.preposition = None;
        // Behind a noun that is an object: "a truck facing east" has its own frame; "yield to a van northbound on ..." is rare.
        if let Some(turn) = carry.frame.and_then(|frame| self.turned_to_go(frame)) {
            (self.frames[turn].heading, self.frames[turn].onto) = (Some(stands), true);
            return;
        }
        match carry.frame {
            Some(frame) => {
                let taken = &mut self.frames[frame];
                if let (true, Some(who)) = (from, taken.who) {
                    self.world.actors[who].heading.get_or_insert(stands);
                    return;
                }
                let turns =
                    matches!(taken.act(), Some(Act::Turn | Act::UTurn | Act::PullOut | Act::Enter | Act::LaneChange));
                if taken.heading.is_none() {
                    taken.heading = Some(stands);
                    taken.onto = !from && (onto || (turns && taken.act() != Some(Act::Enter)));
                }
                let (who, onto) = (taken.who, taken.onto);
                // "It and a van were traveling north": both.
                for who in who.into_iter().chain(carry.also.as_ref().map(|also| also.actor)).filter(|_| !onto) {
                    self.world.actors[who].heading.get_or_insert(stands);
                }
            }
            None => match &carry.subject {
                Some(subject) => {
                    for who in [Some(subject), carry.also.as_ref()].into_iter().flatten() {
                        self.world.actors[who.actor].heading.get_or_insert(stands);
                    }
                }
                // "With it northbound in the bus lane": who stands behind "with".
                None if carry
                    .last
                    .as_ref()
                    .is_some_and(|last| last.end == placed.first && self.is_behind_with(last.end)) =>
                {
                    let actor = carry.last.as_ref().map_or(SUBJECT, |last| last.actor);
                    self.world.actors[actor].heading.get_or_insert(stands);
                }
                None if carry.main.is_none() && !(from && bare || onto || there) => {
                    carry.lead_heading = carry.lead_heading.or(Some((stands, governed)));
                }
                None => {}
            },
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
        let word = |at: usize| self.tokens.get(at).map_or("", |token| token.text.as_str());
        let lane = matches!(word(placed.end), "lane" | "lanes" | "direction");
        let last = carry.last.as_ref().filter(|last| lane && last.piece.is_none() && last.actor != SUBJECT)?;
        let behind =
            matches!(word(last.end), "in" | "on") && word(last.end + 1) == "the" && last.end + 2 == placed.first;
        let frame = &self.frames[carry.frame?];
        let known = frame.who.is_some_and(|who| who != last.actor && self.world.actors[who].heading.is_some());
        (behind && known).then_some(last.actor)
    }

    /// Whether a direction is that of a lane which somebody crosses, or stops in on its way across.
    fn is_crossed(&self, placed: &Placed, carry: &Carry) -> bool {
        let lane = self.tokens.get(placed.end).is_some_and(|next| matches!(next.text.as_str(), "lane" | "lanes"));
        let who = carry.frame.and_then(|frame| self.frames[frame].who).or(carry.subject.as_ref().map(|who| who.actor));
        let crosses = |frame: &super::Frame| {
            frame.who == who
                && frame.happened()
                && frame.act() == Some(Act::Cross)
                && frame.sentence + 1 >= self.sentence
        };
        lane && who.is_some() && self.frames.iter().any(crosses)
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

    /// "out of a parking spot of the oncoming lane": where the spot is.
    fn is_lane_of_a_place(&self, first: usize) -> bool {
        let word = |back: usize| first.checked_sub(back).map_or("", |at| self.tokens[at].text.as_str());
        let article = usize::from(crate::chunk::is_determiner(word(1)));
        let place = matches!(word(2 + article), "space" | "spot" | "stall" | "spaces" | "driveway" | "garage" | "bay");
        place && matches!(word(1 + article), "of" | "along" | "off" | "beside" | "by")
    }

    /// "turned without checking the oncoming lane": who looks at a lane is not in it for that.
    fn is_looked_at(&self, first: usize) -> bool {
        let word = |back: usize| first.checked_sub(back).map_or("", |at| self.tokens[at].text.as_str());
        let verb = word(1 + usize::from(crate::chunk::is_determiner(word(1))));
        ["check", "watch", "scan", "monitor", "observ"].iter().any(|stem| verb.starts_with(stem))
    }

    pub(super) fn lane(&mut self, lane: LaneWord, placed: &Placed, carry: &mut Carry, next: Option<&Chunk>) {
        let fronted = matches!(next, Some(Chunk::Noun(_) | Chunk::Pronoun | Chunk::Piece(_)));
        // "kept to the right lane": it is in it.
        let kept = carry.frame.is_some_and(|frame| {
            ["keep", "kept", "stay", "stick", "stuck"]
                .iter()
                .any(|stem| self.tokens[self.frames[frame].first].text.starts_with(stem))
        });
        let into = (matches!(carry.preposition, Some("into" | "onto" | "to")) || carry.to) && !kept;
        let from = matches!(carry.preposition, Some("from" | "out"));
        // "was part way across the bicycle lane": not its own.
        if matches!(carry.preposition, Some("across" | "over" | "past" | "between")) {
            carry.preposition = None;
            return;
        }
        let preposition = carry.preposition.take();
        carry.to = false;
        // "nudged toward the shoulder", "in the direction of the shoulder": not there.
        let toward = matches!(preposition, Some("toward" | "towards"))
            || self.tokens[placed.first.saturating_sub(4)..placed.first]
                .windows(2)
                .any(|pair| pair[0].text == "direction" && pair[1].text == "of");
        let over = carry.frame.and_then(|frame| self.frames[frame].act());
        let moves = matches!(over, Some(Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter));
        if toward && (lane == LaneWord::Shoulder || !moves)
            || self.is_lane_of_a_place(placed.first)
            || self.is_lane_of_others(placed.first)
            || self.is_astride(placed)
            || self.is_looked_at(placed.first)
        {
            return;
        }
        // "passed it in order to reach the left turn lane": not there yet.
        let aims = carry.frame.map(|frame| &self.frames[frame]);
        if preposition.is_none() && aims.is_some_and(|frame| frame.sense == Sense::Approach && frame.form == Form::Base)
        {
            return;
        }
        let stands = (lane, placed.first, placed.end);
        if let Some(other) = self.met_in_lane(placed, carry).filter(|_| preposition == Some("in")) {
            self.world.actors[other].lane.get_or_insert(stands);
            return;
        }
        let Some(frame) = carry.frame else {
            match &carry.subject {
                // "and in the right lane a van": who is named next.
                Some(_) if carry.fresh && fronted && matches!(preposition, Some("in" | "within" | "from")) => {
                    carry.lead_lane = Some(stands);
                }
                Some(subject) => _ = self.world.actors[subject.actor].lane.get_or_insert(stands),
                // "With it in the bus lane".
                None if carry
                    .last
                    .as_ref()
                    .is_some_and(|last| last.end + 4 > placed.first && self.is_behind_with(last.end)) =>
                {
                    let actor = carry.last.as_ref().map_or(SUBJECT, |last| last.actor);
                    self.world.actors[actor].lane.get_or_insert(stands);
                }
                None if carry.main.is_none()
                    && matches!(preposition, Some("in" | "within" | "from" | "on" | "out")) =>
                {
                    carry.lead_lane.get_or_insert(stands);
                }
                None => {}
            }
            return;
        };
        // "came out of the right lane", "pulled out of the left one": it changed lanes.
        let driven = matches!(lane, LaneWord::Left | LaneWord::Right | LaneWord::Center);
        let out = preposition == Some("out") || from && self.frames[frame].act() == Some(Act::PullOut);
        if driven && out && matches!(self.frames[frame].act(), Some(Act::PullOut | Act::Follow | Act::Drift)) {
            self.frames[frame].sense = Sense::Act(Act::LaneChange);
        }
        let side = match lane {
            LaneWord::Left | LaneWord::LeftTurn => Some(LeftRight::Left),
            LaneWord::Right | LaneWord::RightTurn => Some(LeftRight::Right),
            _ => None,
        };
        let taken = &mut self.frames[frame];
        let moves = matches!(taken.act(), Some(Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter));
        if moves && taken.side.is_none() && side.is_some() && !from {
            taken.side = side;
            return;
        }
        if moves && from && taken.side.is_none() && side.is_some() {
            taken.side = side.map(LeftRight::other);
        }
        taken.lane.get_or_insert(stands);
        let who = taken.who;
        // "Turned to enter the center lane": it was not there before.
        let purpose = taken.first.checked_sub(1).is_some_and(|at| self.tokens[at].text == "to");
        let stepped = lane != LaneWord::Opposing && (taken.first..taken.end).any(|at| self.tokens[at].text == "into");
        let (enters, first) = (taken.act() == Some(Act::Enter) && preposition.is_none(), taken.first);
        // "drifted over and entered the parking lane".
        let strip = matches!(lane, LaneWord::Curb | LaneWord::Bike | LaneWord::Shoulder);
        let came = strip
            && self.frames.iter().any(|before| before.first < first && before.who == who && before.act().is_some());
        let enters = enters && (purpose || came) || stepped;
        // "It and a van were in the left lane": both.
        let also = carry.also.as_ref().map(|also| also.actor);
        for who in who.into_iter().chain(also).filter(|_| !(into || enters) || from) {
            self.world.actors[who].lane.get_or_insert(stands);
        }
    }

    /// "slowed to yield to a taxi in the rightmost lane", "touched the side of a van in the turn lane": of whom the lane is told. Who stops
    /// behind traffic in a lane is in that lane too.
    fn met_in_lane(&self, placed: &Placed, carry: &Carry) -> Option<Actor> {
        let word = |at: usize| self.tokens.get(at).map_or("", |token| token.text.as_str());
        let last = carry.last.as_ref().filter(|last| last.actor != SUBJECT && last.person.is_none())?;
        let frame = &self.frames[carry.frame?];
        let met = matches!(frame.sense, Sense::Yield | Sense::See | Sense::Act(Act::Slow)) || frame.is_contact();
        let at_once = word(last.end) == "in" && last.end + 2 >= placed.first;
        let known = &self.world.actors[last.actor];
        let own = frame.who == Some(SUBJECT) && frame.object == Some(last.actor) && !known.several;
        (met && at_once && own && known.kind.is_some_and(Kind::is_vehicle)).then_some(last.actor)
    }

    /// Whether a lane is that of others between whom somebody comes out, of a place in it, or one that the own is adjacent to: "from a gap
    /// between vehicles in the left lane", "passing traffic in the center lane", "a parking spot in the curb lane", "in the lane adjacent to the rightmost, bus-only lane".
    fn is_lane_of_others(&self, first: usize) -> bool {
        let text = |back: usize| first.checked_sub(back).map_or("", |at| self.tokens[at].text.as_str());
        // "oncoming traffic in the following left lane".
        let told = usize::from(matches!(text(1), "following" | "other" | "nearest" | "closest" | "respective"));
        let article = told + usize::from(text(1 + told) == "the");
        let (before, noun, by) = (text(1 + article), text(2 + article), text(3 + article));
        let between_them = by == "between" && ["vehicles", "cars"].contains(&noun);
        let passing = noun == "traffic" && ["passing", "cross", "oncoming"].contains(&by);
        let in_it = before == "in" && (between_them || passing || ["spot", "space"].contains(&noun));
        let between = |back: &usize| ["the", "rightmost", "leftmost", "right", "left", ",", "-"].contains(&text(*back));
        let behind = (1..6).take_while(between).count() + 1;
        // "one lane to the left of the rightmost lane".
        let beside = text(1) == "the"
            && (text(2) == "of" && matches!(text(3), "left" | "right") || text(2) == "from" && text(3) == "over");
        in_it || beside || text(behind) == "to" && ["adjacent", "next"].contains(&text(behind + 1))
    }

    /// "partially in the left lane and partially in the AV's lane": between the two, and so in that of the subject vehicle no less.
    fn is_astride(&self, placed: &Placed) -> bool {
        let partly = |at: Option<usize>| {
            at.and_then(|at| self.tokens.get(at))
                .is_some_and(|token| matches!(token.text.as_str(), "partially" | "partly"))
        };
        let word = |at: usize| self.tokens.get(at).map_or("", |token| token.text.as_str());
        let one = partly(placed.first.checked_sub(3)) && word(placed.first - 1) == "the";
        let other = word(placed.end) == "and" && partly(Some(placed.end + 1));
        let own = (placed.end + 3..placed.end + 9)
            .any(|at| word(at) == "'s" && word(at + 1) == "lane" || word(at) == "same" && word(at + 1) == "lane");
        one && other && own
    }

    pub(super) fn spot(&mut self, spot: Spot, placed: &Placed, carry: &mut Carry) {
        let word = carry.preposition.take();
        carry.to = false;
        if spot == Spot::Sidewalk && matches!(word, Some("on" | "along" | "up")) {
            self.rides_on_sidewalk(placed, carry);
        }
        let Some(frame) = carry.frame else {
            // "From an alley a van nosed out".
            if matches!(word, Some("from" | "out")) && carry.subject.is_none() {
                carry.out_of = Some(spot);
            }
            return;
        };
        let taken = &mut self.frames[frame];
        let moves = matches!(
            taken.act(),
            Some(
                Act::Reverse
                    | Act::PullOut
                    | Act::Enter
                    | Act::Follow
                    | Act::SetOff
                    | Act::Turn
                    | Act::Drift
                    | Act::Cross
                    | Act::Swerve
                    | Act::Accelerate
            )
        ) || taken.sense == Sense::Approach;
        // "merged onto Elm Street out of a driveway": it pulled out.
        let merges = taken.act() == Some(Act::LaneChange) && self.tokens[taken.first].text.starts_with("merg");
        if merges && matches!(word, Some("out" | "from")) && matches!(spot, Spot::Driveway | Spot::Stall | Spot::Curb) {
            (taken.sense, taken.out_of) = (Sense::Act(Act::PullOut), Some(spot));
            return;
        }
        let says_out = (taken.first..taken.end).any(|at| self.tokens[at].text == "out");
        let leaves = match word {
            Some("out") => moves || taken.sense == Sense::Other,
            Some("from") => moves,
            Some("of") => moves && says_out,
            Some("into" | "onto" | "to" | "in" | "at" | "on" | "near" | "through" | "towards" | "toward") => false,
            // "departing a shopping center".
            _ if taken.act() == Some(Act::SetOff) => self.tokens[taken.first].text.starts_with("depart"),
            _ => matches!(taken.act(), Some(Act::PullOut | Act::Reverse)),
        };
        if leaves && taken.happened() {
            taken.out_of.get_or_insert(spot);
        }
    }

    /// "a cyclist riding along the sidewalk": that strip is its lane.
    fn rides_on_sidewalk(&mut self, placed: &Placed, carry: &Carry) {
        let Some(frame) = carry.frame.map(|frame| &self.frames[frame]) else { return };
        let Some(who) = frame.who.filter(|who| *who != SUBJECT && frame.happened()) else { return };
        let travels = matches!(frame.act(), Some(Act::Follow | Act::Pass)) && frame.sense != Sense::Parked;
        let light = |kind: Kind| matches!(kind.group(), KindGroup::Cyclist | KindGroup::OnFoot);
        let known = &mut self.world.actors[who];
        if travels && known.kind.is_some_and(light) && !known.several {
            known.lane.get_or_insert((LaneWord::Sidewalk, placed.first, placed.end));
        }
    }
}
