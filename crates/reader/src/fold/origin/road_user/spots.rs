//! Rules of [`super`] for who comes out of a place beside the road: a stall, a driveway, the kerb.

use super::{Case, Told, by_rule, only, told_as};
use crate::chunk::Spot;
use crate::fold::origin::fallback::square_front;
use crate::fold::origin::lane_side;
use crate::fold::origin::places::{at_curb, in_stall, is_across, side_named, side_of_road, side_of_road_of, stood_in};
use crate::frame::Frame;
use crate::lexicon::{Relation, Sense};
use crate::token::word;
use crate::world::SUBJECT;
use recrash_model::account::{Act, ActFact, ContactState, KindGroup, LeftRight, Origin, Source, told};
use recrash_model::zones::ContactZone as Z;

impl Case<'_> {
    /// "pulled out of a stall", "came from a driveway".
    pub(super) fn out_of_a_place(&self) -> Told {
        let (number, frame) = self.frames().find(|(_, frame)| frame.out_of.is_some())?;
        if self.drove_on(number) {
            return None;
        }
        if let Some(stood) = self.stood_after(number) {
            return told_as(Origin::Ahead, stood);
        }
        let of_road = || side_of_road(self.reading, self.actor, self.account);
        let drives_out = matches!(frame.out_of, Some(Spot::Driveway));
        let side = self.side.or_else(|| if drives_out { of_road() } else { None }).or(self.touched);
        let origin = match frame.out_of? {
            Spot::Stall => self.out_of_a_stall(number),
            Spot::SideStreet if side.is_some() => side.map_or(Origin::Opposite, |side| Origin::Cross { side }),
            Spot::Driveway | Spot::SideStreet => Origin::Driveway { side },
            Spot::Curb => Origin::Parked { side },
            Spot::Sidewalk => Origin::Sidewalk { side },
        };
        let (first, end) = self.reading.window(number);
        told_as(origin, self.reading.words(first, end))
    }

    /// "stopped behind a truck that had left a driveway and stood across the road": where it stood as the subject vehicle came up to it.
    fn stood_after(&self, number: usize) -> Option<Source> {
        let stands = |frame: &Frame| frame.act().is_some_and(Act::stands) && frame.sense != Sense::Parked;
        let stood = self.frames().any(|(later, frame)| later > number && stands(frame));
        let behind = |frame: &Frame| frame.relations.contains(&(Relation::Behind, Some(self.actor)));
        let mut own = self.reading.before(SUBJECT).filter(|(_, frame)| frame.happened() && behind(frame));
        let (came, _) = own.next().filter(|_| stood)?;
        let (first, end) = self.reading.window(came);
        Some(self.reading.words(first, end))
    }

    fn out_of_a_stall(&self, number: usize) -> Origin {
        // "left a row of parked cars to pass behind it": across its rear, from the side that it touches with.
        let behind_it = self.passes_behind().and_then(|fact| match fact.value {
            Origin::Cross { side } => Some(side),
            _ => None,
        });
        let side = behind_it.or(self.side_or_touched());
        let curb = at_curb(self.reading, self.actor);
        if self.did(Act::Reverse) {
            // Parked behind it, and backwards into its rear.
            if self.parked
                && self.behind_first()
                && self.side.is_none()
                && only(&self.account.sv, Z::is_rear)
                && only(self.partner, Z::is_rear)
            {
                return Origin::Behind;
            }
            // Out of a spot at the kerb, backwards: it was ahead of who is touched in front.
            if square_front(self.account) && (curb || self.ahead && !is_across(self.reading, number, self.account)) {
                return Origin::Ahead;
            }
            // Both go backwards, and meet at their rears.
            if self.sv_reverses() && only(&self.account.sv, Z::is_rear) {
                return Origin::Behind;
            }
        } else if self.parked && self.behind_first() {
            // Out of the space behind it, or a row of them there.
            return Origin::Behind;
        }
        if curb { Origin::Parked { side } } else { Origin::Stall { side } }
    }

    /// "was parked in a stall and turned out".
    pub(super) fn stood_in_a_stall(&self) -> Told {
        let reverses = self.did(Act::Reverse);
        let leaves =
            reverses || [Act::Turn, Act::PullOut, Act::SetOff, Act::Follow].into_iter().any(|act| self.did(act));
        // Parked ahead of it, and backwards: no stall across.
        let along = reverses && self.ahead && square_front(self.account);
        if !self.parked || !leaves || along {
            return None;
        }
        let source = in_stall(self.reading, self.actor)?;
        // Backwards out of one that is behind it, into its rear. "Behind it and to its right" is beside its way.
        let at_rear = only(&self.account.sv, Z::is_rear) && only(self.partner, Z::is_rear);
        let square = self.square_side();
        let along = at_rear && self.side.is_none() && square.is_none();
        if self.behind_first() && (!reverses || along) {
            return told_as(Origin::Behind, source);
        }
        told_as(Origin::Stall { side: self.side.or(square).or(self.touched) }, source)
    }

    /// It stood in a driveway, and came out of it: backwards, or "was stopped facing north in a driveway and began to turn left".
    pub(super) fn stood_in_a_driveway(&self) -> Told {
        let backs = self.parked && self.did(Act::Reverse);
        let source = stood_in(self.reading, self.actor, &["driveway", "driveways"])?;
        // "turned into a driveway and was stopped there" came out of none.
        let drives = self.partner.acts.iter().any(|fact| {
            let leaves = matches!(fact.act, Act::Turn | Act::PullOut | Act::SetOff) && !fact.after_contact;
            leaves && is_behind(&fact.source, &source)
        });
        if !backs && (!drives || self.did(Act::Reverse) || self.behind_first()) {
            return None;
        }
        let across = self.clues.any(Relation::Opposite).then_some(LeftRight::Left);
        let stands = |act: Option<Act>| matches!(act, Some(Act::Hold | Act::Park));
        let own = self.account.sv.heading.as_ref().map(|fact| fact.value);
        let of_road = || side_of_road_of(self.reading, self.actor, own, stands).filter(|_| !backs);
        told_as(Origin::Driveway { side: self.side.or(across).or_else(of_road).or(self.touched) }, source)
    }

    /// A door of a parked one.
    pub(super) fn opens_a_door(&self) -> Told {
        // "was stopped in a curbside parking spot".
        let stands = told(&self.partner.state).is_some_and(ContactState::stands);
        let at_the_kerb = || at_curb(self.reading, self.actor) || in_stall(self.reading, self.actor).is_some();
        if !(self.parked || stands && at_the_kerb()) || !self.did(Act::OpenDoor) {
            return None;
        }
        let opens = |frame: &Frame| frame.sense == Sense::Parked || frame.act() == Some(Act::OpenDoor);
        told_as(Origin::Parked { side: self.side_or_touched() }, self.clues.source(opens))
    }

    /// "pulled out from the kerb".
    pub(super) fn leaves_the_kerb(&self) -> Told {
        let (number, _) = self.frames().find(|(_, frame)| frame.act() == Some(Act::PullOut))?;
        let elsewhere = self.behind_first() || matches!(self.turn, Some(2 | 6));
        if self.drove_on(number) || !self.parked && elsewhere {
            return None;
        }
        // "stopped in the left lane after it had left the kerb": where it stood.
        let acts = &self.partner.acts;
        let left = acts.iter().position(|fact| fact.act == Act::PullOut && !fact.after_contact);
        let stands = |fact: &ActFact| fact.act.stands() && !fact.after_contact;
        let stood = left.is_some_and(|left| acts[left + 1..].iter().any(stands));
        if let (true, Some(side)) = (stood, lane_side(self.account)) {
            return by_rule(Origin::Beside { side }, "lanes of both");
        }
        // "A dog came out from between parked cars on the left".
        let group = told(&self.partner.kind).map(|kind| kind.group());
        if group == Some(KindGroup::Animal) {
            let side = self.side_or_touched().or_else(|| side_named(self.reading, number))?;
            return told_as(Origin::Cross { side }, self.words_of(Act::PullOut));
        }
        told_as(Origin::Parked { side: self.side_of_its_kerb() }, self.words_of(Act::PullOut))
    }

    /// On which side the kerb is at which it stood: "standing at the north curb", of who goes west, at its right.
    fn side_of_its_kerb(&self) -> Option<LeftRight> {
        let stands = |act: Option<Act>| matches!(act, Some(Act::Hold | Act::Park));
        let way = self.account.sv.heading.as_ref().map(|fact| fact.value);
        self.side.or_else(|| side_of_road_of(self.reading, self.actor, way, stands)).or(self.touched)
    }

    /// "a van parked on the north curb went backwards", of who goes west: out of the row at its right.
    pub(super) fn backs_from_a_named_kerb(&self) -> Told {
        let stands = |act: Option<Act>| matches!(act, Some(Act::Hold | Act::Park));
        let own = self.account.sv.heading.as_ref().map(|fact| fact.value);
        if !(self.parked && self.did(Act::Reverse) && at_curb(self.reading, self.actor)) || self.behind_first() {
            return None;
        }
        let side = side_of_road_of(self.reading, self.actor, own, stands)?;
        // Who faces the other way, as one at the left kerb does unless it is told, leaves the other end of its place.
        let turned = own.zip(self.heading).map(|(own, other)| own.eighths_to(other.value));
        let same = turned.map_or(side == LeftRight::Right, |turned| matches!(turned, 0 | 1 | 7));
        if same { told_as(Origin::Parked { side: Some(side) }, self.words_of(Act::Reverse)) } else { None }
    }

    /// "A car that had been stopped along the curb merged into the lane", "a taxi at the right curb made a U-turn".
    pub(super) fn goes_over_from_the_kerb(&self) -> Told {
        let goes = |frame: &Frame| frame.happened() && matches!(frame.act(), Some(Act::LaneChange | Act::UTurn));
        let (_, frame) = self.frames().find(|(_, frame)| goes(frame))?;
        let (_, named) = self.reading.story.world.actors[self.actor].kind_tokens?;
        let sentence = self.reading.story.sentences[frame.sentence];
        // A headline may have named it before: then from what is told of it first here.
        let own = self.frames().find(|(_, own)| own.sentence == frame.sentence).map(|(_, own)| own.first);
        let named = if named < sentence.first { own? } else { named };
        if self.behind_first() || !(sentence.first..=frame.first).contains(&named) {
            return None;
        }
        let words = &self.reading.story.tokens[named..frame.first];
        let others =
            self.reading.story.frames.iter().any(|other| {
                (named..frame.first).contains(&other.first) && other.who.is_some_and(|who| who != self.actor)
            });
        let curb =
            (0..words.len()).any(|at| matches!(word(words, at), "curb" | "curbside") && word(words, at + 1) != "lane");
        let drove = words.iter().any(|token| matches!(token.text.as_str(), "traveling" | "driving" | "passing"));
        if others || drove || !curb {
            return None;
        }
        told_as(Origin::Parked { side: self.side_of_its_kerb() }, self.words_of(frame.act()?))
    }
}

/// Whether words stand behind others.
fn is_behind(words: &Source, others: &Source) -> bool {
    match (words, others) {
        (Source::Words { start, .. }, Source::Words { end, .. }) => start >= end,
        _ => true,
    }
}
