//! What the words tell of somebody else: whether the ego acted for it, where it is, and what it is to the ego.

use crate::reading::turns::leaves_line;
use crate::reading::words::{before_contact, span, text};
use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::side::Turning;
use crate::told::zones::side_of;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, ControlDevice, Kind, KindGroup, LeftRight, Origin, Other, PlaceKind,
    SignalState, Source, StandReason,
};

/// Who is named no farther behind the words that the ego slowed or stood is whom it did so for; of who is on foot, and of animals, nor
/// farther before them. [byte]
const NAMED_WITHIN: usize = 70;
const NAMED_BEFORE: usize = 160;

/// Who is named no farther behind the words that the ego passed is whom it passed. [byte]
const PASSES_WITHIN: usize = 12;

/// Who is named no farther behind another is with that: " with ". [byte]
const WITH_WITHIN: usize = 8;

/// For whom the partner leaves its lane is named no farther behind the words for that: " to the left to go around ".
const GOES_OUT_WITHIN: usize = 30;

/// Whether somebody is told to be parked.
pub(super) fn is_parked(other: &Other) -> bool {
    text(&other.kind.source).contains("parked") || before_contact(other).any(|fact| text(&fact.source).contains("park"))
}

/// Whether somebody has a siren.
pub(super) fn has_siren(other: &Other) -> bool {
    matches!(other.kind.value, Kind::PoliceCar | Kind::Ambulance | Kind::FireTruck | Kind::FirstResponder)
}

/// Whether who is on foot is told last to stand or to stay, and not to have crossed.
pub(super) fn stays_close(other: &Other) -> bool {
    let crosses = before_contact(other).any(|fact| fact.act == Act::Cross);
    !crosses && before_contact(other).last().is_some_and(|fact| matches!(fact.act, Act::Hold | Act::Stop))
}

/// Whether somebody changes lanes into the ego's, and no words tell to which side that is: "a van cut in", "a van encroached".
pub(super) fn cuts_in(other: &Other) -> bool {
    let into = |fact: &ActFact| {
        let words = text(&fact.source);
        let says = |of: &[&str]| of.iter().any(|word| words.contains(word));
        let mut each = words.split(|letter: char| !letter.is_alphanumeric());
        let cuts = each.any(|word| matches!(word, "cut" | "cuts" | "cutting"));
        fact.act == Act::LaneChange && (cuts || says(&["in front of", "ahead of"]))
            || fact.act == Act::Drift && says(&["encroach"])
    };
    before_contact(other).any(into)
}

/// Whether words are for a place to park.
pub(super) fn is_space(words: &str) -> bool {
    ["parking", "space", "spot", "stall"].iter().any(|word| words.contains(word))
}

/// Whether somebody backs into a place to park: "stopped behind a van that was backing into a parking space".
pub(super) fn parks_backwards(other: &Other) -> bool {
    let into = |fact: &ActFact| {
        let words = text(&fact.source);
        fact.act == Act::Reverse && words.contains(" into ") && is_space(&words)
    };
    before_contact(other).any(into)
}

/// Words for one that stands in a lane.
const IN_LANE: [&str; 6] = ["in-lane", "in lane", "in the lane", "in its lane", "double-parked", "double parked"];

/// Whether one that is told opposite, in a lane for turns, and to do nothing stands there: "a truck in the opposing left turn lane".
pub(super) fn is_in_turn_lane(other: &Other) -> bool {
    let lane = |source: &Source| {
        let words = text(source);
        words.contains("turn lane") || words.contains("turn pocket") || words.contains("turning lane")
    };
    let there = other.place.as_ref().is_some_and(|fact| fact.value == Origin::Opposite && lane(&fact.source));
    there && !other.several && before_contact(other).next().is_none()
}

/// Whether somebody is told to stand in a lane, and not partly there: at no kerb.
pub(super) fn stands_in_lane(other: &Other) -> bool {
    let in_lane = |fact: &ActFact| {
        let words = text(&fact.source);
        IN_LANE.iter().any(|word| words.contains(word))
    };
    other.astride.is_none() && before_contact(other).any(in_lane)
}

/// Whether the ego stands on though its light has turned green, and lets in who comes from beside the road: the queue ahead, of which no
/// deed is told, has driven on.
pub(super) fn lets_in_at_green(told: &Told, other: &Other) -> bool {
    let green = told.sv.control.is_some_and(|said| said.state == Some(SignalState::TurnedGreen));
    let blocked = told.reasons.iter().any(|why| matches!(why, StandReason::BlockedJunction | StandReason::BlockedPath));
    let stays = told.sv.state == ContactState::Stopped && green && !blocked;
    stays && told.comes_from_aside() && before_contact(other).next().is_none()
}

/// Whether the road that the ego is on crosses another one there.
pub(super) fn is_at_junction(told: &Told) -> bool {
    told.place == PlaceKind::Intersection || told.is_controlled() || told.sv.turning != Turning::No
}

/// Whether the ego keeps its lane.
pub(super) fn is_straight(told: &Told) -> bool {
    told.sv.turning == Turning::No && told.sv_aside().is_none()
}

/// What the words tell of somebody else.
pub(super) struct Story<'a> {
    pub(super) account: &'a Account,
}

impl Story<'_> {
    /// What the ego did for somebody: where the words stand. That it stood when it was struck, said with its name, is nothing of that.
    pub(super) fn reactions(&self) -> impl Iterator<Item = (usize, usize)> {
        let reacts = |fact: &&ActFact| {
            let acts = matches!(fact.act, Act::Slow | Act::Stop | Act::Hold | Act::Swerve | Act::Drift);
            let named = ["the ", "a ", "its "].iter().any(|article| text(&fact.source).starts_with(article));
            acts && !fact.after_contact && !named
        };
        let acts = self.account.sv.acts.iter().filter(reacts).map(|fact| &fact.source);
        acts.chain(self.account.sv.reasons.iter().map(|fact| &fact.source)).filter_map(span)
    }

    /// Whether somebody is named with the words that the ego slowed or stood, or what it did is told with them: the headline may have
    /// named it.
    pub(super) fn is_near(&self, other: &Other) -> bool {
        let acts = before_contact(other).map(|fact| &fact.source).filter(|_| self.is_of_headline(other));
        let named: Vec<(usize, usize)> = [&other.kind.source].into_iter().chain(acts).filter_map(span).collect();
        let near = |(start, end): (usize, usize)| {
            named.iter().any(|(first, last)| *first <= end + NAMED_WITHIN && (*first >= start || *last > start))
        };
        self.reactions().any(near)
    }

    /// Whether somebody is named before all that the ego is told to have done.
    fn is_of_headline(&self, other: &Other) -> bool {
        let begins = self.account.sv.acts.iter().filter_map(|fact| span(&fact.source)).map(|(start, _)| start).min();
        span(&other.kind.source).zip(begins).is_some_and(|((named, _), begins)| named < begins)
    }

    /// Whether somebody is named with the words that an ego which had stood slowed again, on its way, or is told to have set out between.
    pub(super) fn is_slowed_for_later(&self, told: &Told, other: &Other) -> bool {
        let last = self.account.sv.acts.iter().rfind(|fact| !fact.after_contact);
        let slows = last.filter(|fact| fact.act == Act::Slow && told.sv.state == ContactState::Moving);
        let Some((slows, (_, end))) = slows.and_then(|fact| Some((fact.step, span(&fact.source)?))) else {
            return false;
        };
        let named = span(&other.kind.source).is_some_and(|(start, _)| (end..end + NAMED_WITHIN).contains(&start));
        let off = self.account.sv.acts.iter().filter(|fact| fact.act == Act::SetOff).map(|fact| fact.step).max();
        let begins = before_contact(other).map(|fact| fact.step).min();
        let between = off.zip(begins).is_some_and(|(off, begins)| off < begins && begins <= slows);
        (named || between) && told.sv.stood_first
    }

    /// Whether the words that tell where somebody is tell that the ego, which had stood, slowed again: "it moved off, and slowed for the
    /// traffic ahead".
    pub(super) fn is_placed_as_it_slows(&self, told: &Told, other: &Other) -> bool {
        let last = self.account.sv.acts.iter().rfind(|fact| !fact.after_contact).filter(|fact| fact.act == Act::Slow);
        let slows = last.filter(|_| told.sv.state == ContactState::Moving && told.sv.stood_first);
        let place = other.place.as_ref().and_then(|fact| span(&fact.source));
        let both = slows.and_then(|fact| span(&fact.source)).zip(place);
        both.is_some_and(|((start, end), (first, last))| first <= start && end <= last)
    }

    /// Whether somebody with a siren comes along another way, and is named before the words that the ego stood for it.
    pub(super) fn comes_with_siren(&self, other: &Other) -> bool {
        let comes =
            matches!(other.place.as_ref().map(|fact| fact.value), Some(Origin::Cross { .. } | Origin::Opposite));
        has_siren(other) && comes && self.is_named_before(other)
    }

    /// Whether traffic is named before the ego, which stood, set off, and that stands again for something else: "after cross traffic
    /// cleared, it entered the intersection and stopped for a woman".
    pub(super) fn is_gone_before(&self, other: &Other) -> bool {
        let ego = || self.account.sv.acts.iter().filter(|fact| !fact.after_contact);
        let goes = |fact: &&ActFact| matches!(fact.act, Act::SetOff | Act::Enter | Act::Follow);
        let stood = ego().find(|fact| matches!(fact.act, Act::Hold | Act::Stop)).map(|fact| fact.step);
        let Some(stood) = stood else { return false };
        let Some(off) = ego().filter(goes).find(|fact| fact.step > stood) else { return false };
        let again = ego().any(|fact| fact.step > off.step && matches!(fact.act, Act::Slow | Act::Stop | Act::Hold));
        let named = span(&other.kind.source).zip(span(&off.source));
        let between = named.is_some_and(|((_, end), (off, _))| end <= off && off < end + NAMED_WITHIN);
        again && between && !self.is_near(other) && before_contact(other).next().is_none()
    }

    /// Whether somebody is told to have gone by while the ego stood, and no more, before it set off or turned: "after a bus had gone by, it
    /// started its turn"; or is named for that stop alone, as another of them is: "it had waited for a van and a bus".
    pub(super) fn goes_first(&self, told: &Told, other: &Other) -> bool {
        let ego = || self.account.sv.acts.iter().filter(|fact| !fact.after_contact);
        let goes = |fact: &&ActFact| matches!(fact.act, Act::SetOff | Act::Enter | Act::Turn);
        let Some(stood) = ego().find(|fact| matches!(fact.act, Act::Hold | Act::Stop)) else { return false };
        let Some(off) = ego().filter(goes).find(|fact| fact.step > stood.step) else { return false };
        let by = |fact: &ActFact| {
            let words = text(&fact.source);
            let plain = ["by", "passed", "through", "first"].iter().any(|word| words.ends_with(word));
            fact.act == Act::Pass && fact.done && plain && (stood.step..off.step).contains(&fact.step)
        };
        let passes = |other: &Other| before_contact(other).next().is_some() && before_contact(other).all(by);
        let named = span(&stood.source).zip(span(&off.source)).zip(span(&other.kind.source));
        let between = named.is_some_and(|(((_, stood), (off, _)), (first, end))| stood <= first && end <= off);
        let alike = between && before_contact(other).next().is_none() && self.account.others.iter().any(passes);
        is_at_junction(told) && other.place.is_none() && (passes(other) || alike)
    }

    /// Where those come from who go first: towards an ego that turns left at no stop sign, else along the crossing road.
    pub(super) fn first_from(told: &Told) -> Role {
        let sign = told.sv.control.is_some_and(|said| said.device == ControlDevice::StopSign);
        let left = told.sv.turning == Turning::Left || told.waits_to_turn_left();
        if left && !sign { Role::Oncoming } else { Role::Crosser }
    }

    /// Whether somebody on foot, or an animal, is whom the ego slowed or stood for.
    pub(super) fn is_met(&self, other: &Other) -> bool {
        let Some((named, _)) = span(&other.kind.source) else { return false };
        let turns = self.account.sv.acts.iter().filter(|fact| fact.act == Act::Turn && !fact.after_contact);
        let turns = turns
            .filter_map(|fact| span(&fact.source))
            .any(|(start, end)| (start..end + NAMED_BEFORE).contains(&named));
        let reacts = self.reactions().next().is_some();
        let crosses =
            |fact: &ActFact| matches!(fact.act, Act::Cross | Act::Enter | Act::RunRed | Act::PullOut | Act::UTurn);
        self.is_near(other) || reacts && before_contact(other).any(crosses) || self.is_named_before(other) || turns
    }

    /// Whether somebody is told behind a turn that the ego has done: "after it turned right, it drove past an oncoming van".
    pub(super) fn is_after_turn(&self, told: &Told, other: &Other) -> bool {
        let turn = self.account.sv.acts.iter().rfind(|fact| fact.act == Act::Turn && !fact.after_contact);
        let turned = turn.filter(|fact| !fact.begun && told.sv.turned).and_then(|fact| span(&fact.source));
        turned.zip(span(&other.kind.source)).is_some_and(|((_, end), (named, _))| end < named)
    }

    /// Whether somebody is named a little before the words that the ego slowed or stood.
    pub(super) fn is_named_before(&self, other: &Other) -> bool {
        let named = span(&other.kind.source);
        named.is_some_and(|(_, end)| self.reactions().any(|(start, _)| (end..end + NAMED_BEFORE).contains(&start)))
    }

    /// Whether who stood drove on, and is not told to have stopped again; and whether it did so before the ego did.
    pub(super) fn drives_on(&self, other: &Other) -> Option<bool> {
        let stood = |fact: &&ActFact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.after_contact;
        let since = self.account.sv.acts.iter().chain(&other.acts).filter(stood).map(|fact| fact.step).min()?;
        let drives = |fact: &&ActFact| {
            fact.step > since && matches!(fact.act, Act::SetOff | Act::Follow | Act::Accelerate | Act::Leave)
        };
        let at = before_contact(other).find(drives)?.step;
        let stops = |fact: &ActFact| matches!(fact.act, Act::Hold | Act::Stop) && fact.step > at;
        if before_contact(other).any(stops) {
            return None;
        }
        let moves = |fact: &&ActFact| {
            let moves = matches!(fact.act, Act::SetOff | Act::Follow | Act::Enter | Act::LaneChange | Act::Turn);
            moves && fact.step > since && !fact.after_contact
        };
        Some(self.account.sv.acts.iter().find(moves).is_some_and(|fact| at < fact.step))
    }

    /// Whether somebody ahead is only told to have gone on, before the ego came to the stop in which it stands, for no queue or vehicle ahead.
    /// An ego that had stood before did so behind that one.
    pub(super) fn has_gone(&self, told: &Told, other: &Other) -> bool {
        let waits = |reason: &StandReason| matches!(reason, StandReason::Queue | StandReason::LeadVehicle);
        let stop = self.account.sv.acts.iter().rfind(|fact| fact.act == Act::Stop && !fact.after_contact);
        let last = before_contact(other).map(|fact| fact.step).max();
        let stops = told.sv.state == ContactState::Stopped && !told.reasons.iter().any(waits);
        let goes = before_contact(other).all(|fact| matches!(fact.act, Act::SetOff | Act::Follow | Act::Accelerate));
        let stood = |fact: &ActFact| matches!(fact.act, Act::Stop | Act::Hold) && last.is_some_and(|at| fact.step < at);
        let stood = self.account.sv.acts.iter().any(stood);
        stops && goes && !stood && last.is_some_and(|last| stop.is_some_and(|stop| last < stop.step))
    }

    /// Whether somebody slows, stands, or comes to a stop, behind that the ego set off, and the ego slows or stops again.
    pub(super) fn stands_again(&self, other: &Other) -> bool {
        let ego = || self.account.sv.acts.iter().filter(|fact| !fact.after_contact);
        let Some(off) = ego().filter(|fact| fact.act == Act::SetOff).map(|fact| fact.step).max() else { return false };
        let slows = ego().any(|fact| fact.step > off && matches!(fact.act, Act::Slow | Act::Stop));
        let last = before_contact(other).max_by_key(|fact| fact.step);
        slows && last.is_some_and(|fact| fact.step > off && matches!(fact.act, Act::Hold | Act::Stop | Act::Slow))
    }

    /// Whether the words for what the partner did name somebody as whom it went round: "pulled out around the taxi".
    pub(super) fn is_gone_round(&self, other: &Other) -> bool {
        let partner = self.account.partner.iter().flat_map(|partner| &partner.acts);
        let mut passes = partner.filter(|fact| fact.act == Act::Pass && !fact.after_contact);
        passes.any(|fact| self.is_called(other, &text(&fact.source)))
    }

    /// Whether somebody of whom no place is told is named right behind the words that the partner passed: "ran the light, passing ahead of a van
    /// that had stopped for it", of a partner that crosses.
    pub(super) fn is_passed_by_partner(&self, other: &Other) -> bool {
        let partner = self.account.partner.iter().flat_map(|partner| &partner.acts);
        let passes = |fact: &&ActFact| !fact.after_contact && text(&fact.source).starts_with("pass");
        let mut ends = partner.filter(passes).filter_map(|fact| Some(span(&fact.source)?.1));
        let named = span(&other.kind.source);
        named.is_some_and(|(first, _)| ends.any(|end| (end..=end + GOES_OUT_WITHIN).contains(&first)))
    }

    /// With whom an animal goes of which no more is told: "a man with a dog".
    pub(super) fn led_by(&self, other: &Other) -> Option<&Other> {
        let (first, _) = span(&other.kind.source)?;
        let with = |who: &&Other| {
            let near = span(&who.kind.source).is_some_and(|(_, end)| (end..end + WITH_WITHIN).contains(&first));
            near && who.kind.value.group() == KindGroup::OnFoot && before_contact(who).next().is_some()
        };
        let alone = other.place.is_none() && before_contact(other).next().is_none();
        self.account.others.iter().find(with).filter(|_| alone)
    }

    /// Whether somebody who stands, or is slow, is told right behind the words that the partner came up or left its lane beside the ego: "came up
    /// behind a slow truck and changed lanes", "changed lanes to go around a stopped bus".
    pub(super) fn is_reason_to_go_out(&self, told: &Told, other: &Other) -> bool {
        let goes = |fact: &&ActFact| matches!(fact.act, Act::Follow | Act::LaneChange | Act::Pass | Act::Slow);
        let Some(partner) = self.account.partner.as_ref() else { return false };
        let leaves = partner.acts.iter().any(|fact| fact.act == Act::LaneChange && !fact.after_contact);
        let acts = partner.acts.iter().filter(|fact| !fact.after_contact).filter(goes);
        let ends: Vec<usize> = acts.filter_map(|fact| Some(span(&fact.source)?.1)).collect();
        let behind = |(start, _)| ends.iter().any(|end| (*end..=end + GOES_OUT_WITHIN).contains(&start));
        let holds = |fact: &ActFact| matches!(fact.act, Act::Hold | Act::Park | Act::Stop);
        let words = text(&other.kind.source);
        let slow = words.contains("slow");
        let still = before_contact(other).next().is_some() && before_contact(other).all(holds);
        let beside = matches!(told.origin, Origin::Beside { .. }) && told.cp.state == ContactState::Moving;
        let there =
            other.place.is_none() && !other.several && (still || slow && before_contact(other).next().is_none());
        beside && leaves && there && span(&other.kind.source).is_some_and(behind)
    }

    /// Whether the partner is told to pass between the ego and somebody: who is named right behind that; where nobody is, and the partner
    /// goes the ego's way, anybody.
    pub(super) fn is_between(&self, told: &Told, other: &Other) -> bool {
        let between =
            |fact: &&ActFact| fact.act == Act::Pass && !fact.after_contact && text(&fact.source).contains("between");
        let acts = self.account.partner.iter().flat_map(|partner| &partner.acts).filter(between);
        let ends: Vec<usize> = acts.filter_map(|fact| Some(span(&fact.source)?.1)).collect();
        let named = |other: &Other| {
            let behind = |(start, _)| ends.iter().any(|end| (*end..=end + PASSES_WITHIN).contains(&start));
            span(&other.kind.source).is_some_and(behind)
        };
        match told.origin {
            Origin::Behind | Origin::Beside { .. } if !self.account.others.iter().any(named) => !ends.is_empty(),
            Origin::Behind | Origin::Beside { .. } | Origin::Opposite => named(other),
            _ => false,
        }
    }

    /// Whether words name somebody: of several with that name the first that is told of.
    fn is_called(&self, other: &Other, words: &str) -> bool {
        let name = |other: &Other| text(&other.kind.source).split_whitespace().next_back().map(str::to_owned);
        let Some(called) = name(other).filter(|name| words.split_whitespace().any(|word| word == name)) else {
            return false;
        };
        let partner = self.account.partner.as_ref().and_then(|party| party.kind.as_ref());
        let of_partner = partner.is_some_and(|kind| text(&kind.source).split_whitespace().next_back() == Some(&called));
        let first = self.account.others.iter().find(|another| name(another).as_ref() == Some(&called));
        !of_partner && first.is_some_and(|first| std::ptr::eq(first, other))
    }

    /// The step at which the ego is told to pass somebody.
    pub(super) fn passes_at(&self, other: &Other) -> Option<u32> {
        let passes = |fact: &&ActFact| fact.act == Act::Pass && !fact.after_contact && !fact.begun;
        let acts = before_contact(other).map(|fact| &fact.source);
        let named: Vec<usize> =
            [&other.kind.source].into_iter().chain(acts).filter_map(|source| Some(span(source)?.0)).collect();
        let of = |fact: &&ActFact| {
            let within =
                |(start, end): (usize, usize)| named.iter().any(|at| (start..=end + PASSES_WITHIN).contains(at));
            span(&fact.source).is_some_and(within) || self.is_called(other, &text(&fact.source))
        };
        self.account.sv.acts.iter().filter(passes).find(of).map(|fact| fact.step)
    }

    /// Whether one that is parked is not in the way of an ego that goes round something: it is parked on the side to which that goes first, and
    /// not told to be passed, or the ego keeps its lane, nor is told to go round it, and the partner is beside that.
    pub(super) fn keeps_to_kerb(&self, told: &Told, other: &Other, place: Option<Origin>) -> bool {
        let side = match place {
            Some(Origin::Beside { side } | Origin::Parked { side: Some(side) }) => Some(side),
            _ => None,
        };
        let aside = |fact: &&ActFact| leaves_line(fact.act) && !fact.after_contact;
        let first = self.account.sv.acts.iter().filter(aside).find_map(|fact| fact.side).or(told.sv.aside);
        let beside = matches!(told.origin, Origin::Beside { .. } | Origin::Parked { side: Some(_) });
        let keeps = told.sv_aside().is_none() && told.thing.is_none() && beside;
        let passed = self.passes_at(other);
        let round = |fact: &ActFact| fact.act == Act::Pass && text(&fact.source).contains("around");
        let goes_round = passed.is_some() && self.account.sv.acts.iter().any(round);
        passed.is_none() && side.is_some() && side == first || keeps && !goes_round
    }

    /// Whether the ego has passed somebody, and is told to have come back into its lane then.
    pub(super) fn is_back(&self, other: &Other) -> bool {
        let Some(passed) = self.passes_at(other) else { return false };
        let changes = |fact: &&ActFact| fact.act == Act::LaneChange && !fact.after_contact && !fact.begun;
        let changes: Vec<&ActFact> = self.account.sv.acts.iter().filter(changes).collect();
        match changes.as_slice() {
            [.., last] if last.step > passed => true,
            // "It merged to the right, and merged back to the left after passing the truck."
            [.., one, last] => one.side.is_some() && last.side == one.side.map(LeftRight::other),
            _ => false,
        }
    }

    /// Whether the ego is on its way past somebody where it is touched.
    pub(super) fn goes_by(&self, told: &Told, other: &Other) -> bool {
        told.sv.state == ContactState::Moving && self.passes_at(other).is_some() && !self.is_back(other)
    }

    /// Whether the ego moves over in its lane, or out of it, away from the side from which somebody comes.
    pub(super) fn makes_room(&self, told: &Told, other: &Other) -> bool {
        let away = told.sv.aside.map(LeftRight::other).filter(|_| told.sv.turning == Turning::No);
        away.is_some() && away == self.came_from(told, other)
    }

    /// From which side somebody changes lanes: who cuts in, and is not told from where, does so from the side from which the ego swerves.
    fn came_from(&self, told: &Told, other: &Other) -> Option<LeftRight> {
        let changes =
            before_contact(other).find(|fact| matches!(fact.act, Act::LaneChange | Act::PullOut | Act::Swerve));
        match other.place.as_ref().map(|fact| fact.value) {
            Some(Origin::Beside { side }) => Some(side),
            _ => changes
                .and_then(|fact| fact.side)
                .or_else(|| told.sv.aside.filter(|_| cuts_in(other)))
                .map(LeftRight::other),
        }
    }

    /// On which side of the ego somebody is, or from which it comes.
    pub(super) fn side(&self, role: Role, told: &Told, other: &Other) -> Option<LeftRight> {
        let passes = self.account.sv.acts.iter().find(|fact| fact.act == Act::Pass && !fact.after_contact);
        let passed = passes.and_then(|fact| fact.side).or(told.sv.aside).map(LeftRight::other);
        match other.place.as_ref().map(|fact| fact.value) {
            Some(Origin::Beside { side } | Origin::Cross { side }) => Some(side),
            _ if role == Role::Animal && self.led_by(other).is_some() => {
                self.led_by(other).and_then(|who| self.side(Role::Walker, told, who))
            }
            // From between them somebody came out.
            _ if role == Role::Kerb && other.hides && told.comes_from_side().is_some() => told.comes_from_side(),
            // One that is parked is where the partner comes from, or on the right.
            _ if role == Role::Kerb && !other.several => match told.origin {
                Origin::Parked { side } | Origin::Driveway { side } | Origin::Sidewalk { side } => side,
                _ => None,
            }
            .or(Some(LeftRight::Right)),
            // Who changes to its right comes from the left.
            // From the lane beside it of which is told.
            _ if role == Role::Merger => self.came_from(told, other).or(match told.origin {
                Origin::Beside { side } => Some(side),
                _ => None,
            }),
            _ if role == Role::Obstacle && self.is_back(other) => None,
            // On the side where the partner touches the ego.
            _ if role == Role::Beside && self.is_between(told, other) => side_of(&told.sv.zones),
            _ => passed.filter(|_| matches!(role, Role::Obstacle | Role::Beside)),
        }
    }
}
