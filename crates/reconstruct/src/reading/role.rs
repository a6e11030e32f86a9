//! Which part somebody has in what the ego does. Of who is in a vehicle rules say it over what is told, and the first that says anything decides.

use crate::reading::story::{
    Story, cuts_in, is_in_turn_lane, is_parked, is_space, is_straight, parks_backwards, stands_in_lane, stays_close,
};
use crate::reading::words::{before_contact, span, text};
use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::queue::sets_off;
use crate::told::side::{Turning, is_on_foot};
use recrash_model::account::{
    Act, ActFact, ContactState, ControlDevice, KindGroup, LeftRight, Origin, Other, PlaceKind, SignalState, Source,
    StandReason,
};
use recrash_model::template::Movement;

/// What blocks a junction is named no more than so many bytes before the words for it: " that was ".
const BLOCKS_WITHIN: usize = 16;

/// Words for a place behind the junction.
const FAR_SIDE: [&str; 4] =
    ["across the intersection", "beyond the intersection", "past the intersection", "far side of the intersection"];

impl Story<'_> {
    /// The part of somebody; nothing where it has none.
    pub(super) fn role(&self, told: &Told, other: &Other) -> Option<Role> {
        // Who throws the partner is drawn there; and who comes afterwards is not.
        let later = !other.acts.is_empty() && other.acts.iter().all(|fact| fact.after_contact) && !self.is_near(other);
        if other.touched_partner || later {
            return None;
        }
        match other.kind.value.group() {
            // Who rides into the ego's lane from beside is in it.
            KindGroup::Cyclist if before_contact(other).any(|fact| fact.act == Act::LaneChange) => {
                Vehicle::of(self, told, other).role()
            }
            // Who stays at the side of an ego that drives on, and for whom it did nothing, is near alone.
            KindGroup::OnFoot
                if told.sv.state == ContactState::Moving && stays_close(other) && !self.is_near(other) =>
            {
                None
            }
            KindGroup::OnFoot | KindGroup::Cyclist => self.is_met(other).then_some(Role::Walker),
            KindGroup::Animal => self.is_met(other).then_some(Role::Animal),
            KindGroup::Car | KindGroup::Truck | KindGroup::Motorcycle => Vehicle::of(self, told, other).role(),
            _ => None,
        }
    }
}

/// What a rule says of somebody: its part, or that it has none.
type Verdict = Option<Role>;

/// It has none.
const NO_PART: Verdict = None;

/// Somebody in a vehicle, and what several rules ask of it.
struct Vehicle<'a> {
    story: &'a Story<'a>,
    told: &'a Told,
    other: &'a Other,
    /// The words that name it.
    words: String,
    place: Option<Origin>,
    /// Nothing is told that it did: of traffic without a deed it is told because the ego waits for it.
    acts_not: bool,
    /// It is named with the words that the ego slowed or stood.
    near: bool,
    /// The ego did something for somebody.
    reacts: bool,
    /// It stands: by what it did, or as the ego "was going around" it.
    stands: bool,
}

/// Whether somebody did one of these before the contact.
fn did(other: &Other, acts: &[Act]) -> bool {
    before_contact(other).any(|fact| acts.contains(&fact.act))
}

impl<'a> Vehicle<'a> {
    /// In this order: the first rule that says anything decides.
    const RULES: [fn(&Self) -> Option<Verdict>; 21] = [
        Self::first_to_go,
        Self::reason_to_go_out,
        Self::passed,
        Self::between,
        Self::screen,
        Self::parked,
        Self::in_the_way,
        Self::beside,
        Self::abreast,
        Self::backer,
        Self::in_turn_lane,
        Self::oncoming,
        Self::blocker,
        Self::awaited_traffic,
        Self::yielded_to_at_sign,
        Self::merger,
        Self::beyond,
        Self::through_junction,
        Self::elsewhere,
        Self::left_standing,
        Self::beyond_at_green,
    ];

    /// Somebody, and what is asked of it.
    fn of(story: &'a Story<'a>, told: &'a Told, other: &'a Other) -> Self {
        let acts_not = before_contact(other).next().is_none();
        let stands =
            did(other, &[Act::Hold, Act::Stop, Act::Park]) && !did(other, &[Act::SetOff, Act::Follow, Act::Reverse]);
        Self {
            story,
            told,
            other,
            words: text(&other.kind.source),
            place: other.place.as_ref().map(|fact| fact.value),
            acts_not,
            near: story.is_near(other),
            reacts: story.reactions().next().is_some(),
            stands: stands || acts_not && told.sv.goes_round && story.passes_at(other).is_some(),
        }
    }

    /// Its part; nothing where it has none.
    fn role(&self) -> Option<Role> {
        Self::RULES.iter().find_map(|rule| rule(self)).unwrap_or_else(|| self.ahead())
    }

    /// Whether the words that name it hold one of these.
    fn said(&self, of: &[&str]) -> bool {
        of.iter().any(|word| self.words.contains(word))
    }

    /// Whether it did one of these before the contact.
    fn did(&self, acts: &[Act]) -> bool {
        did(self.other, acts)
    }

    /// Whether the ego is told to have stood for this.
    fn because(&self, reason: StandReason) -> bool {
        self.told.reasons.contains(&reason)
    }

    /// Whether the ego stood in a queue, or behind another.
    fn queue(&self) -> bool {
        self.because(StandReason::Queue) || self.because(StandReason::LeadVehicle)
    }

    /// Whether it is told ahead of the ego, by a place or by its name.
    fn is_ahead(&self) -> bool {
        self.place == Some(Origin::Ahead) || self.said(&["lead", "preceding"])
    }

    /// Whether it is told beside the ego.
    fn is_beside(&self) -> bool {
        matches!(self.place, Some(Origin::Beside { .. }))
    }

    /// Whether it is told on the crossing road.
    fn is_across(&self) -> bool {
        matches!(self.place, Some(Origin::Cross { .. }))
    }

    /// "Traffic in the through lane to its right" goes the ego's way.
    fn is_alongside(&self) -> bool {
        self.is_beside() && self.other.place.as_ref().is_some_and(|fact| text(&fact.source).contains("lane"))
    }

    /// Whether a junction is told: by the place, or by a signal or a sign.
    fn at_junction(&self) -> bool {
        self.told.place == PlaceKind::Intersection || self.told.is_controlled()
    }

    /// Whether it is told to drive on: who drives elsewhere does not stand ahead.
    fn drives_on(&self) -> bool {
        self.did(&[Act::Follow]) && !self.did(&[Act::Hold, Act::Stop]) && !self.queue()
    }

    /// Whether it is traffic for which the ego stands.
    fn holds_ego(&self) -> bool {
        self.near && self.told.sv.state == ContactState::Stopped && self.other.several
    }

    /// Who goes by first before the ego sets off again.
    fn first_to_go(&self) -> Option<Verdict> {
        self.story.goes_first(self.told, self.other).then(|| Some(Story::first_from(self.told)))
    }

    /// For whom the partner leaves its lane.
    fn reason_to_go_out(&self) -> Option<Verdict> {
        self.story.is_reason_to_go_out(self.told, self.other).then_some(Some(Role::Passed))
    }

    /// Round whom the partner goes: it comes over from the opposite side, or passes where the ego is at the kerb.
    fn passed(&self) -> Option<Verdict> {
        let passes = |fact: &ActFact| matches!(fact.act, Act::Pass | Act::LaneChange) && !fact.after_contact;
        let (sv, partner) = (&self.told.sv, self.story.account.partner.as_ref());
        let at_kerb =
            sv.state == ContactState::Parked || sv.came_to_park || sv.movement == Some(Movement::EnteringTraffic);
        let goes_round =
            || self.told.comes_over || at_kerb && partner.is_some_and(|party| party.acts.iter().any(passes));
        let alone = self.stands && !self.other.several;
        let passed = alone && goes_round() && (!self.near || self.story.is_gone_round(self.other));
        passed.then_some(Some(Role::Passed))
    }

    /// Between whom and the ego the partner passes.
    fn between(&self) -> Option<Verdict> {
        let between = self.stands && !self.other.several && self.story.is_between(self.told, self.other);
        between.then_some(Some(Role::Beside))
    }

    /// From behind whom, or from between whom where they are several, a partner came out that comes across: they are not told to drive or to be at
    /// a kerb.
    fn screen(&self) -> Option<Verdict> {
        let (told, other) = (self.told, self.other);
        let stays = before_contact(other).all(|fact| matches!(fact.act, Act::Hold | Act::Stop | Act::Park | Act::Slow));
        let at_kerb = is_parked(other) && !stands_in_lane(other);
        let beside = matches!(self.place, None | Some(Origin::Beside { .. } | Origin::Opposite));
        // Who pulls out on wheels comes along beside the lanes.
        let across = is_on_foot(told.cp.kind) || !matches!(told.origin, Origin::Parked { .. });
        let hides = other.hides && stays && beside && !at_kerb && across && told.comes_from_side().is_some();
        hides.then_some(Some(Role::Screen))
    }

    /// Who is parked: in the ego's way, in a lane, or at the kerb.
    fn parked(&self) -> Option<Verdict> {
        let (told, other, place) = (self.told, self.other, self.place);
        if !is_parked(other) || self.did(&[Act::PullOut, Act::SetOff, Act::Follow, Act::Reverse]) {
            return None;
        }
        let double = self.said(&["double"]) || stands_in_lane(other);
        let waits = self.because(StandReason::BlockedPath)
            || self.because(StandReason::LeadVehicle)
            || place == Some(Origin::Ahead);
        let named_before = double && place.is_none() && self.story.is_named_before(other);
        // Who stands in the lane of those who come towards the ego is not in its way.
        let blocks = (self.near && (waits || double) || named_before) && place != Some(Origin::Opposite);
        let there = place != Some(Origin::Opposite) || self.story.passes_at(other).is_some();
        let round = ego_goes_round(told) && there && told.thing.is_none_or(|thing| thing != other.kind.value);
        Some(match (other.several, round && !self.story.keeps_to_kerb(told, other, place)) {
            // A row of them that is double-parked in the lane towards the ego is at no kerb.
            (true, _) if double && place == Some(Origin::Opposite) => None,
            (true, _) => Some(Role::Kerb),
            (false, true) => Some(Role::Obstacle),
            (false, false) if blocks => Some(Role::Lead),
            // Who is double-parked, or parked in a lane, stands there.
            (false, false) if double => self.is_beside().then_some(Role::Beside),
            (false, false) => (!self.did(&[Act::Park])).then_some(Role::Kerb),
        })
    }

    /// Whom the ego passes on its way out of its line, and whom it has passed and come back behind.
    fn in_the_way(&self) -> Option<Verdict> {
        let (told, other, story) = (self.told, self.other, self.story);
        let passed = told.sv.state.stands() && story.passes_at(other).is_some()
            || story.is_back(other)
            || (story.goes_by(told, other) || told.rounds_other()) && matches!(self.place, None | Some(Origin::Ahead));
        (self.stands && !other.several && passed && told.sv_aside().is_some()).then_some(Some(Role::Obstacle))
    }

    /// Who stands in the next lane, whether or not the ego slows as it goes by.
    fn beside(&self) -> Option<Verdict> {
        let (told, other) = (self.told, self.other);
        // Nobody stands beside an ego that has come into the junction.
        let enters = told.sv.enters() && told.sv.state == ContactState::Moving;
        let beside = self.is_beside() || self.place.is_none() && self.story.passes_at(other).is_some();
        let stands = self.stands
            && beside
            && told.sv_aside().is_none()
            && !enters
            && !self.story.is_back(other)
            && !self.did(&[Act::LaneChange, Act::Enter, Act::PullOut, Act::Drift]);
        stands.then_some(Some(Role::Beside))
    }

    /// Who drives in the next lane, and has room there, beside an ego that keeps its own.
    fn abreast(&self) -> Option<Verdict> {
        let told = self.told;
        let only_drives = |fact: &ActFact| matches!(fact.act, Act::Follow | Act::Enter | Act::SetOff | Act::Slow);
        let drives = self.did(&[Act::Follow, Act::Enter, Act::SetOff]) && before_contact(self.other).all(only_drives);
        let Some(Origin::Beside { side }) = self.place.filter(|_| drives) else { return None };
        let free = told.comes_from_side() != Some(side) && told.origin != Origin::Beside { side };
        // What came off it rolls out from beside it.
        let free = free || told.is_sliding();
        let ego_drives = matches!(told.sv.state, ContactState::Moving | ContactState::SettingOff);
        (free && ego_drives && is_straight(told)).then_some(Some(Role::Abreast))
    }

    /// Who backs beside the ego, or ahead of it out of a place to park: "a pickup reversing into its lane from a parking spot ahead".
    fn backer(&self) -> Option<Verdict> {
        let out = || {
            let words = self.other.place.as_ref().map(|fact| text(&fact.source)).unwrap_or_default();
            let behind = ["from", "out of"].iter().find_map(|out| words.split_once(&format!("{out} a ")));
            behind.is_some_and(|(_, behind)| is_space(behind)) && !parks_backwards(self.other)
        };
        let aside = self.is_beside() || self.place == Some(Origin::Ahead) && out();
        (self.did(&[Act::Reverse]) && aside && (self.near || self.reacts)).then_some(Some(Role::Backer))
    }

    /// Who waits opposite to turn itself comes towards nobody.
    fn in_turn_lane(&self) -> Option<Verdict> {
        is_in_turn_lane(self.other).then_some(NO_PART)
    }

    /// Who comes towards the ego, where that is told.
    fn oncoming(&self) -> Option<Verdict> {
        if self.place != Some(Origin::Opposite) && !self.said(&["oncoming", "opposing"]) {
            return None;
        }
        let only_passes = !self.did(&[Act::Hold, Act::Stop, Act::Turn, Act::LaneChange, Act::Park, Act::Reverse]);
        // Of who turns across it, it is told only because that waits for it.
        let waits = self.near || self.other.several && (self.told.sv.turning == Turning::Left || self.acts_not);
        // Who hides somebody stands there.
        let stays = self.other.hides && self.acts_not;
        Some((only_passes && !stays && (waits || self.did(&[Act::Follow]))).then_some(Role::Oncoming))
    }

    /// Crossing traffic that has not cleared the junction, and whom the words call a block there: "a van that was blocking the intersection".
    fn blocker(&self) -> Option<Verdict> {
        let stopped = self.told.sv.state == ContactState::Stopped;
        let crosses = self.said(&["cross", "bound traffic", "approaching traffic"]) || self.is_across();
        let held = self.other.several && crosses && self.did(&[Act::Hold]) && stopped;
        let named = || {
            let reasons = &self.story.account.sv.reasons;
            let reason = reasons.iter().find(|fact| fact.value == StandReason::BlockedJunction);
            let told = reason.and_then(|fact| span(&fact.source)).zip(span(&self.other.kind.source));
            told.is_some_and(|((start, _), (_, end))| (end..end + BLOCKS_WITHIN).contains(&start))
        };
        let blocks = held && self.at_junction() && !self.is_beside() && !self.queue()
            || !self.other.several && stopped && named();
        blocks.then_some(Some(Role::Blocker))
    }

    /// Traffic that the ego waits for at a junction, before a turn or as that crosses: along the crossing road, or towards an ego that turns left.
    fn awaited_traffic(&self) -> Option<Verdict> {
        let (told, across) = (self.told, self.is_across());
        let turning = told.sv.turning != Turning::No;
        let (crosses, follows) = (self.said(&["cross"]), self.did(&[Act::Follow]));
        let for_turn = turning && crosses || across && (self.acts_not || follows);
        let for_turn = for_turn && !self.because(StandReason::BlockedJunction);
        let waits = self.near || self.other.several && for_turn;
        let waits = waits && !self.is_ahead() && !self.is_alongside() && !self.queue();
        let turns = turning || self.because(StandReason::StopSign);
        let yields = self.because(StandReason::Yield);
        let comes = crosses
            || self.said(&["bound traffic", "approaching traffic"])
            || self.is_beside()
            || across
            || turns && follows
            || yields;
        let turns_left =
            told.sv.turning == Turning::Left && !self.because(StandReason::StopSign) && !crosses && !across;
        let junction = told.place == PlaceKind::Intersection || turns || crosses || across;
        let role = if turns_left { Role::Oncoming } else { Role::Crosser };
        (waits && self.other.several && comes).then(|| junction.then_some(role))
    }

    /// At a stop sign whom the ego yields to, of whom no more is told, comes along the crossing road.
    fn yielded_to_at_sign(&self) -> Option<Verdict> {
        let sign = self.told.sv.control.is_some_and(|said| said.device == ControlDevice::StopSign);
        let lets_go = self.because(StandReason::Yield) || self.told.sv.enters();
        let untold = self.acts_not && self.place.is_none() && !self.is_ahead() && !self.queue();
        (sign && self.near && untold && lets_go).then_some(Some(Role::Crosser))
    }

    /// Who comes over into the lane of an ego that keeps it, or makes room.
    fn merger(&self) -> Option<Verdict> {
        let makes_room = self.story.makes_room(self.told, self.other);
        let merges = self.comes_over(makes_room) && !self.did(&[Act::Hold, Act::Stop, Act::Turn, Act::Cross]);
        let noticed = self.near || self.reacts || self.comes_in() || makes_room;
        let there = !self.other.several && self.place != Some(Origin::Behind);
        let keeps_lane = is_straight(self.told) || makes_room;
        (merges && noticed && there && keeps_lane).then_some(Some(Role::Merger))
    }

    /// Whether it comes over into the ego's lane, or was about to.
    fn comes_over(&self, makes_room: bool) -> bool {
        let (ahead, beside) = (self.is_ahead(), self.is_beside());
        self.did(&[Act::LaneChange])
            || cuts_in(self.other) && makes_room
            || self.did(&[Act::PullOut]) && !self.told.comes_from_aside()
            || beside && self.did(&[Act::Swerve, Act::SetOff])
            || (ahead && self.near || beside && (self.near || self.story.is_named_before(self.other)))
                && self.did(&[Act::Drift])
            || self.merges_yet()
    }

    /// Whether it was about to change lanes, or to come over from beside: "a van in the next lane headed towards its lane".
    fn merges_yet(&self) -> bool {
        let comes = |act: Act| act == Act::LaneChange || self.is_beside() && matches!(act, Act::Drift | Act::Swerve);
        self.other.acts.iter().any(|fact| comes(fact.act) && fact.begun && !fact.after_contact)
    }

    /// Whether it changes lanes towards the ego from the lane beside that: "a car in the lane to its right changed lanes to the left".
    fn comes_in(&self) -> bool {
        let next =
            |source: &Source| ["adjacent", "next", "beside", " of the "].iter().any(|word| text(source).contains(word));
        let place = self.other.place.as_ref().filter(|fact| next(&fact.source)).map(|fact| fact.value);
        before_contact(self.other).any(|fact| {
            let towards = |side: LeftRight| place == Some(Origin::Beside { side: side.other() });
            fact.act == Act::LaneChange && !fact.begun && fact.side.is_some_and(towards)
        })
    }

    /// Traffic that stands behind the junction: "a queue of stopped traffic across the junction".
    fn beyond(&self) -> Option<Verdict> {
        let far = || {
            self.other.place.as_ref().is_some_and(|fact| {
                let words = text(&fact.source);
                FAR_SIDE.iter().any(|side| words.contains(side))
            })
        };
        let straight = self.told.sv.turning == Turning::No && self.told.origin == Origin::Behind;
        let beyond = self.because(StandReason::BlockedJunction) || straight && far();
        (self.holds_ego() && beyond).then_some(Some(Role::Beyond))
    }

    /// Traffic for which the ego stands at a junction, and which drives: not ahead, nor the ego's way.
    fn through_junction(&self) -> Option<Verdict> {
        let through = self.holds_ego() && !self.queue() && self.at_junction() && !self.is_alongside();
        (through && self.drives_on() && !self.is_ahead()).then_some(Some(Role::Blocker))
    }

    /// Who is not ahead of the ego, leaves its lane, or drives elsewhere has no part.
    fn elsewhere(&self) -> Option<Verdict> {
        let there = self.near && !self.is_beside() || self.is_ahead() && self.reacts;
        let leaves = self.did(&[Act::LaneChange, Act::Enter, Act::PullOut, Act::Cross, Act::Pass, Act::Drift])
            || self.did(&[Act::Reverse]) && !parks_backwards(self.other);
        let elsewhere = self.drives_on() && !self.is_ahead();
        (!there || leaves || elsewhere || self.place == Some(Origin::Behind)).then_some(NO_PART)
    }

    /// Who stands somewhere, and is not told to have gone, stands yet when the ego drives on: not in its lane.
    fn left_standing(&self) -> Option<Verdict> {
        let holds = |fact: &ActFact| matches!(fact.act, Act::Hold | Act::Park);
        let only_holds = !self.acts_not && before_contact(self.other).all(holds) && self.place.is_none();
        let goes_on = sets_off(self.told) && is_straight(self.told) && !self.told.is_controlled();
        (only_holds && goes_on && !self.queue()).then_some(NO_PART)
    }

    /// At green nobody stands before the line: who stops ahead does so behind the junction.
    fn beyond_at_green(&self) -> Option<Verdict> {
        let (told, sv) = (self.told, &self.told.sv);
        let drawn = matches!(told.place, PlaceKind::Street | PlaceKind::Intersection);
        let behind = drawn && !matches!(told.origin, Origin::Cross { .. });
        let green = sv.control.is_some_and(|said| said.state == Some(SignalState::Green));
        let stands = sv.state == ContactState::Stopped && sv.turning == Turning::No;
        (green && self.other.several && behind && stands && !self.queue()).then_some(Some(Role::Beyond))
    }

    /// Who is left is ahead of the ego: it slows there, or stands.
    fn ahead(&self) -> Verdict {
        let (told, queue) = (self.told, self.queue());
        let slows =
            self.said(&["slow"]) || self.did(&[Act::Slow, Act::Turn, Act::Park, Act::Stop]) && !self.did(&[Act::Hold]);
        match told.sv.state == ContactState::Moving && !sets_off(told) {
            true if slows => Some(Role::Slower),
            // Who drives on ahead stands nowhere.
            true if self.drives_on() => None,
            // Of whom no deed is told, and for whom an ego that drives did nothing, nobody says that it stands.
            true if self.acts_not && !self.near && !queue && told.sv.turning == Turning::No => None,
            _ => Some(Role::Lead),
        }
    }
}

/// Whether the ego goes round something.
fn ego_goes_round(told: &Told) -> bool {
    told.sv_aside().is_some_and(|aside| aside.from_t_m == 0.0 && told.sv.movement != Some(Movement::ParkingManeuver))
        || told.sv.movement == Some(Movement::Passing)
}
