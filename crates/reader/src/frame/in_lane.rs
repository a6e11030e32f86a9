//! Lanes and places behind a verb or a noun: "in the left lane", "out of a driveway".

use super::Frame;
use super::parser::{Carry, Parser};
use crate::chunk::{Chunk, Placed, Spot};
use crate::lexicon::{Form, Sense};
use crate::token::word;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Act, Kind, KindGroup, LaneWord, LeftRight};

/// A lane where it stands.
struct InLane {
    /// With its tokens.
    stands: (LaneWord, usize, usize),
    /// The preposition before it.
    preposition: Option<&'static str>,
    /// It is one into which somebody goes.
    into: bool,
    /// It is one from which somebody comes.
    from: bool,
}

impl InLane {
    /// The side on which a lane of this name lies.
    const fn side(&self) -> Option<LeftRight> {
        match self.stands.0 {
            LaneWord::Left | LaneWord::LeftTurn => Some(LeftRight::Left),
            LaneWord::Right | LaneWord::RightTurn => Some(LeftRight::Right),
            _ => None,
        }
    }
}

/// Whether an act goes from one lane into another.
const fn moves_over(act: Option<Act>) -> bool {
    matches!(act, Some(Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter))
}

impl Parser<'_> {
    /// A lane is where somebody drives, where it goes, or the lane of others.
    pub(super) fn lane(&mut self, lane: LaneWord, placed: &Placed, carry: &mut Carry, next: Option<&Chunk>) {
        let into = (matches!(carry.preposition, Some("into" | "onto" | "to")) || carry.to) && !self.keeps_to(carry);
        let from = matches!(carry.preposition, Some("from" | "out"));
        // "was part way across the bicycle lane": not its own.
        if matches!(carry.preposition, Some("across" | "over" | "past" | "between")) {
            carry.preposition = None;
            return;
        }
        let preposition = carry.preposition.take();
        carry.to = false;
        let here = InLane { stands: (lane, placed.first, placed.end), preposition, into, from };
        if self.only_goes_toward(&here, carry)
            || self.is_lane_of_a_place(placed.first)
            || self.is_lane_of_others(placed.first)
            || self.is_astride(placed)
            || self.is_looked_at(placed.first)
            || self.aims_at_lane(&here, carry)
        {
            return;
        }
        if let Some(other) = self.met_in_lane(placed, carry).filter(|_| preposition == Some("in")) {
            self.world.actors[other].lane.get_or_insert(here.stands);
            return;
        }
        let Some(frame) = carry.frame else {
            let fronted = matches!(next, Some(Chunk::Noun(_) | Chunk::Pronoun | Chunk::Piece(_)));
            return self.clause_in_lane(&here, fronted, carry);
        };
        if self.changes_side(frame, &here) {
            return;
        }
        let taken = &mut self.frames[frame];
        taken.lane.get_or_insert(here.stands);
        let who = taken.who;
        let goes_in = (here.into || self.enters_lane(frame, &here)) && !from;
        // "It and a van were in the left lane": both.
        let also = carry.also.as_ref().map(|also| also.actor);
        for who in who.into_iter().chain(also).filter(|_| !goes_in) {
            self.world.actors[who].lane.get_or_insert(here.stands);
        }
    }

    /// "kept to the right lane": it is in it.
    fn keeps_to(&self, carry: &Carry) -> bool {
        carry.frame.is_some_and(|frame| {
            ["keep", "kept", "stay", "stick", "stuck"]
                .iter()
                .any(|stem| self.tokens[self.frames[frame].first].text.starts_with(stem))
        })
    }

    /// "nudged toward the shoulder", "in the direction of the shoulder": not there.
    fn only_goes_toward(&self, here: &InLane, carry: &Carry) -> bool {
        let (lane, first, _) = here.stands;
        let toward = matches!(here.preposition, Some("toward" | "towards"))
            || self.tokens[first.saturating_sub(4)..first]
                .windows(2)
                .any(|pair| pair[0].text == "direction" && pair[1].text == "of");
        let act = carry.frame.and_then(|frame| self.frames[frame].act());
        toward && (lane == LaneWord::Shoulder || !moves_over(act))
    }

    /// "passed it in order to reach the left turn lane": not there yet.
    fn aims_at_lane(&self, here: &InLane, carry: &Carry) -> bool {
        let aims = |frame: &Frame| frame.sense == Sense::Approach && frame.form == Form::Base;
        here.preposition.is_none() && carry.frame.is_some_and(|frame| aims(&self.frames[frame]))
    }

    /// A lane before any verb: of whom the clause is about, or of who is named next.
    fn clause_in_lane(&mut self, here: &InLane, fronted: bool, carry: &mut Carry) {
        let (preposition, stands) = (here.preposition, here.stands);
        if let Some(subject) = &carry.subject {
            // "and in the right lane a van": who is named next.
            if carry.fresh && fronted && matches!(preposition, Some("in" | "within" | "from")) {
                carry.lead_lane = Some(stands);
            } else {
                self.world.actors[subject.actor].lane.get_or_insert(stands);
            }
            return;
        }
        // "With it in the bus lane".
        let with = |end: usize| end + 4 > stands.1 && self.is_behind_with(end);
        if let Some(last) = carry.last.as_ref().filter(|last| with(last.end)) {
            self.world.actors[last.actor].lane.get_or_insert(stands);
        } else if carry.main.is_none() && matches!(preposition, Some("in" | "within" | "from" | "on" | "out")) {
            carry.lead_lane.get_or_insert(stands);
        }
    }

    /// "moved into the left lane", "came out of the right lane": the side to which it went. Whether the lane tells no more than that.
    fn changes_side(&mut self, frame: usize, here: &InLane) -> bool {
        let taken = &mut self.frames[frame];
        // "came out of the right lane", "pulled out of the left one": it changed lanes.
        let driven = matches!(here.stands.0, LaneWord::Left | LaneWord::Right | LaneWord::Center);
        let out = here.preposition == Some("out") || here.from && taken.act() == Some(Act::PullOut);
        if driven && out && matches!(taken.act(), Some(Act::PullOut | Act::Follow | Act::Drift)) {
            taken.sense = Sense::Act(Act::LaneChange);
        }
        let Some(side) = here.side().filter(|_| moves_over(taken.act()) && taken.side.is_none()) else { return false };
        taken.side = Some(if here.from { side.other() } else { side });
        !here.from
    }

    /// "turned to enter the center lane", "drifted over and entered the parking lane": it was not there before.
    fn enters_lane(&self, frame: usize, here: &InLane) -> bool {
        let (taken, lane) = (&self.frames[frame], here.stands.0);
        let stepped = lane != LaneWord::Opposing && (taken.first..taken.end).any(|at| self.tokens[at].text == "into");
        if stepped || taken.act() != Some(Act::Enter) || here.preposition.is_some() {
            return stepped;
        }
        let purpose = taken.first.checked_sub(1).is_some_and(|at| self.tokens[at].text == "to");
        let strip = matches!(lane, LaneWord::Curb | LaneWord::Bike | LaneWord::Shoulder);
        let came = |before: &Frame| before.first < taken.first && before.who == taken.who && before.act().is_some();
        purpose || strip && self.frames.iter().any(came)
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

    /// "slowed to yield to a taxi in the rightmost lane", "touched the side of a van in the turn lane": of whom the lane is told. Who stops
    /// behind traffic in a lane is in that lane too.
    fn met_in_lane(&self, placed: &Placed, carry: &Carry) -> Option<Actor> {
        let last = carry.last.as_ref().filter(|last| last.actor != SUBJECT && last.person.is_none())?;
        let frame = &self.frames[carry.frame?];
        let met = matches!(frame.sense, Sense::Yield | Sense::See | Sense::Act(Act::Slow)) || frame.is_contact();
        let at_once = word(self.tokens, last.end) == "in" && last.end + 2 >= placed.first;
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
        let one = partly(placed.first.checked_sub(3)) && word(self.tokens, placed.first - 1) == "the";
        let other = word(self.tokens, placed.end) == "and" && partly(Some(placed.end + 1));
        let own = (placed.end + 3..placed.end + 9).any(|at| {
            word(self.tokens, at) == "'s" && word(self.tokens, at + 1) == "lane"
                || word(self.tokens, at) == "same" && word(self.tokens, at + 1) == "lane"
        });
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
