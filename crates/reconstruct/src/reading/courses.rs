//! What the acts tell of the ways of the two, beside their movements.

use crate::reading::order::steps;
use crate::reading::words::{before_contact, text};
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::phase::Phase;
use crate::told::queue::CREEPS_MPS;
use crate::told::side::{Side, Slant, Turning};
use crate::told::zones::side_of;
use recrash_model::account::{
    Account, Act, Act as Done, ActFact, ContactState, CrashType, KindGroup, LaneWord, LeftRight, Origin, Other, Party,
    SignalState, Source, Standing, Striker, told,
};
use recrash_model::template::Movement;

impl Told {
    /// What the acts tell of the ways beside the movements.
    pub(super) fn courses(&mut self, account: &Account, partner: &Party) {
        let sv = &account.sv;
        self.reactions(sv, partner);
        self.goes_round(sv);
        self.goes_round_other(account);
        let drives_on =
            |side: &Side| side.aside.is_some() && matches!(side.movement, Some(Movement::Straight | Movement::Passing));
        self.cp.changed_lanes |= self.changed_lanes_behind();
        // Straight ahead of the ego it has stopped before that did, wherever the words tell it.
        if self.backs_in_line() {
            self.cp.acts.iter_mut().filter(|doing| doing.comes_to_stand()).for_each(|doing| doing.after_other = None);
        }
        self.sv.dodges = (drives_on(&self.sv) || self.sv.stopped_aside.is_some()) && self.sv_aside().is_some();
        self.cp.dodges = drives_on(&self.cp) && self.cp_from_left_m().is_some();
        self.cp.slants = self.slants(sv, partner);
        self.turns_over(sv);
        self.turns_later_unsaid(sv);
        // Who runs into the rear of who turns, or waits to, ahead of it has yet to turn.
        let in_line = self.crash_type == CrashType::FrontToRear || self.is_thrown();
        let follows = self.origin == Origin::Behind && in_line;
        let turns = matches!(self.cp.turning, Turning::Left | Turning::Right);
        if follows && turns && matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff) {
            (self.cp.turning, self.cp.turns_later) = (Turning::No, true);
        }
        for side in [&mut self.sv, &mut self.cp].into_iter().filter(|side| side.turns_later) {
            side.acts.retain(|doing| !doing.is_turn());
        }
        if let Origin::Cross { side } = self.origin {
            self.cp.turns_wide = self.crash_type == CrashType::HeadOn;
            self.turns_unsaid(partner, side);
        }
    }

    /// How a partner that reverses came to be at an angle to the road.
    fn slants(&self, sv: &Party, partner: &Party) -> Option<Slant> {
        match self.origin {
            _ if self.cp.state != ContactState::Reversing => None,
            // Out of the crossing road it came along the ego's, turned into that, and stood there.
            Origin::Cross { side } => {
                turned_off(partner).map(|turned| Slant::Stood { side: Some(turned), oncoming: turned != side })
            }
            Origin::Ahead | Origin::Behind | Origin::Beside { .. } => {
                let before = || partner.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
                let reversed = before().find(|fact| fact.act == Act::Reverse).map(|fact| fact.step);
                let swing = before().rfind(|fact| matches!(fact.act, Act::Turn | Act::Drift | Act::Swerve));
                let stood = |fact: &ActFact| Slant::Stood { side: fact.side, oncoming: faces(sv, partner) };
                let swings = swing.and_then(|fact| match Some(fact.step) >= reversed {
                    true => Some(Slant::Swung),
                    false => (fact.act == Act::Turn).then(|| stood(fact)),
                });
                // Who backs into a stall of a lot swings round for it.
                let lot = self.place.is_lot();
                swings.or((lot && partner.did(Act::Park)).then_some(Slant::Swung))
            }
            _ => None,
        }
    }

    /// What is left of the ego's turn where it meets somebody in it, behind it or before it.
    fn turns_over(&mut self, sv: &Party) {
        let straight = self.sv.movement == Some(Movement::Straight);
        // Who meets a thing after a turn may be in it yet; not what lies across where it turned into.
        if self.thing.is_some() && !self.at_entrance && straight {
            self.sv.turned = false;
        }
        // Who comes from a side of an ego that drove into another junction after its turn does so from that side of its new road: one junction
        // is drawn, and the turn is not.
        let crosses = matches!(self.origin, Origin::Cross { .. });
        if self.sv.turned && straight && crosses && enters_after_turn(sv) {
            (self.sv.turning, self.sv.turned) = (Turning::No, false);
        }
        if lies_before_turn(self, sv) {
            (self.sv.turning, self.sv.turns_later) = (Turning::No, true);
        }
    }

    /// How a partner turns that comes along the crossing road and is told to drive on: as it did before; to meet the ego head-on, who comes from the
    /// left turns to the right.
    fn turns_unsaid(&mut self, partner: &Party, from: LeftRight) {
        let on = |movement: Movement| {
            matches!(
                movement,
                Movement::Straight | Movement::Passing | Movement::LaneDeparture | Movement::CrossingIntoOpposingLane
            )
        };
        let drives = self.cp.state == ContactState::Moving && self.cp.movement.is_none_or(on);
        if self.cp.turning != Turning::No || !drives {
            return;
        }
        let turn = partner.acts.iter().rfind(|fact| fact.act == Act::Turn && !fact.after_contact && !fact.begun);
        let by_type = self.cp.turns_wide.then(|| from.other());
        self.cp.turning = match turn.and_then(|fact| fact.side).or(by_type) {
            Some(LeftRight::Left) => Turning::Left,
            Some(LeftRight::Right) => Turning::Right,
            None => Turning::No,
        };
    }
}

/// Whether somebody is told to have driven into a junction behind its turn: "turned right, and went on through the intersection with Oak Street".
fn enters_after_turn(party: &Party) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let turn = before().filter(|fact| fact.act == Act::Turn).map(|fact| fact.step).max();
    let goes = |fact: &ActFact| matches!(fact.act, Act::Enter | Act::Cross | Act::Follow);
    let junction = |fact: &ActFact| ["intersection", "junction"].iter().any(|word| text(&fact.source).contains(word));
    turn.is_some() && before().any(|fact| Some(fact.step) > turn && goes(fact) && junction(fact))
}

/// To which side somebody turned before it stood and reversed.
fn turned_off(party: &Party) -> Option<LeftRight> {
    let first = |of: fn(Act) -> bool| steps(party, of).into_iter().min();
    let stood = first(|act| matches!(act, Act::Stop | Act::Hold))?.min(first(|act| act == Act::Reverse)?);
    let turn = |fact: &&ActFact| fact.act == Act::Turn && !fact.after_contact && !fact.begun && fact.step < stood;
    party.acts.iter().rfind(turn).and_then(|fact| fact.side)
}

/// Whether the two are told to have gone in opposite directions.
pub(super) fn faces(sv: &Party, partner: &Party) -> bool {
    let ways = told(&sv.heading).zip(told(&partner.heading));
    ways.is_some_and(|(sv, partner)| (3..=5).contains(&sv.eighths_to(partner)))
}

/// Whether something lies in the lane for turns that the ego came along, and only a column tells that it turned.
fn lies_before_turn(told: &Told, sv: &Party) -> bool {
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    let lane = matches!(told.sv.lane, Some(LaneWord::LeftTurn | LaneWord::RightTurn));
    let by_words = sv.movement.as_ref().is_some_and(|fact| fact.source.is_told()) || sv.did(Act::Turn);
    turns && lane && !by_words && told.thing.is_some() && told.edge.is_none()
}

impl Told {
    /// Whose turn no words tell has yet to begin it where it slows or stands and is hit from behind, or by who passes it. So has who is told to have
    /// come along, or slowed, and nothing else, where it is run into from behind; and by words for a way to the turn, "approaching", "slowing",
    /// where it is hit from behind, or by who turns the same way across it. Beside who came along it may have begun to.
    fn turns_later_unsaid(&mut self, sv: &Party) {
        let unsaid = sv.movement.as_ref().is_some_and(|movement| !matches!(movement.source, Source::Words { .. }))
            && !sv.acts.iter().any(|fact| fact.act == Act::Turn);
        let turns = matches!(self.sv.turning, Turning::Left | Turning::Right);
        let slows =
            self.sv.slowed_from.is_some() || matches!(self.sv.state, ContactState::Stopped | ContactState::SettingOff);
        let passed = self.cp.movement == Some(Movement::Passing) && self.cp.turning == Turning::No;
        let behind = self.origin == Origin::Behind;
        let into_rear = behind && self.crash_type == CrashType::FrontToRear;
        let before = || sv.acts.iter().filter(|fact| !fact.after_contact);
        let comes_along = before().next().is_some() && before().all(|fact| matches!(fact.act, Act::Follow | Act::Slow));
        let mut words = before().map(|fact| &fact.source).chain(sv.state.iter().map(|fact| &fact.source)).map(text);
        let nears = before().any(|fact| fact.act == Act::Slow) || words.any(|words| words.contains("approach"));
        let across = matches!(self.origin, Origin::Beside { .. }) && self.cp.turning == self.sv.turning;
        let before_turn = comes_along && (into_rear || nears && (behind || across));
        // Who walks over the crosswalk before it does so before the turn.
        let walks = self.crosses_at_walk() && sv.did(Act::SetOff);
        if unsaid && (slows && (into_rear || behind && passed || walks) || turns && before_turn) {
            self.sv.turns_later = turns && !self.enters();
        }
    }

    /// An ego that stands ahead of one that is parked, which another pushes into it, stood there when the story begins: no way leads there past that.
    /// Not one that is told to have come to a stop there, or to have moved.
    pub(super) fn stands_before_parked(&mut self, sv: &Party) {
        let parked = self.cp.state == ContactState::Parked && self.cp.state_told && self.is_thrown();
        let still =
            sv.acts.iter().filter(|fact| !fact.after_contact).all(|fact| matches!(fact.act, Act::Hold | Act::Park));
        let only_stood = still && told(&sv.standing) != Some(Standing::CameToStop);
        if parked && only_stood && self.sv.state == ContactState::Stopped && !self.sv.phases.contains(&Phase::Drives) {
            self.sv.state = ContactState::Parked;
            self.sv.acts.clear();
            self.sv.phases.clear();
        }
    }

    /// Whether the partner has changed lanes behind the ego, and that slowed or stopped then: it comes straight on since.
    fn changed_lanes_behind(&self) -> bool {
        let merges = matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging));
        let drives = self.cp.state == ContactState::Moving && !self.cp.stood_first && !self.cp.passes;
        let last = self.cp.acts.iter().rfind(|doing| doing.goes_aside());
        let done = last.is_some_and(|doing| doing.act == Act::LaneChange && !doing.begun);
        let answered = self.sv.acts.iter().any(|doing| doing.answers_done(&self.cp.acts));
        self.origin == Origin::Behind && merges && drives && done && answered && !self.pushed
    }

    /// Whether the ego came to a stop for a partner beside it that had begun to come over into its lane.
    pub(super) fn stops_for_merge(&self, sv: &Party, partner: &Party) -> bool {
        let step = |party: &Party, of: fn(Act) -> bool| {
            let before = party.acts.iter().filter(|fact| !fact.after_contact && of(fact.act));
            before.map(|fact| fact.step).min()
        };
        let over = step(partner, |act| matches!(act, Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter));
        let slows = step(sv, |act| matches!(act, Act::Slow | Act::Stop));
        let came = told(&sv.standing) == Some(Standing::CameToStop) && self.sv.state == ContactState::Stopped;
        let merges = matches!(self.cp.movement, Some(Movement::ChangingLanes | Movement::Merging));
        let drives = self.cp.state == ContactState::Moving && !self.cp.stood_first && self.cp.phases.is_empty();
        let simple = self.sv.phases.is_empty() && self.thing.is_none() && self.cp.turning == Turning::No;
        let beside = matches!(self.origin, Origin::Beside { .. }) && self.ahead != Some(false);
        came && merges && drives && simple && beside && over.is_some() && over < slows
    }

    /// Whether the partner is told to have been behind an ego that stood and set off, and nothing tells that it came up to it.
    pub(super) fn was_in_queue(&self, account: &Account, partner: &Party) -> bool {
        // Also one that moved up a little, and stands again.
        let moved_up = self.sv.phases.ends_with(&[Phase::Stands, Phase::Drives, Phase::Stands]);
        let went = self.sv.state == ContactState::SettingOff
            || self.sv.state == ContactState::Moving && self.sv.stood_first && self.sv.turning == Turning::No
            || self.sv.state == ContactState::Stopped && moved_up && self.sv.turning == Turning::No
            || self.slowed_until_green();
        let plain = self.cp.state == ContactState::Moving && !self.cp.stood_first && self.cp.turning == Turning::No;
        let straight = matches!(self.cp.movement, None | Some(Movement::Straight)) && self.cp.manner.is_none();
        let words = |source: &Source| match source {
            Source::Words { text, .. } => text.to_lowercase(),
            _ => String::new(),
        };
        let place = account.came_from.as_ref().map_or(String::new(), |fact| words(&fact.source));
        let comes = |text: &str| ["approach", "came", "coming", "from behind"].iter().any(|word| text.contains(word));
        let acts = &mut partner.acts.iter().filter(|fact| !fact.after_contact);
        let only_there = acts.all(|fact| fact.act == Done::Follow && !comes(&words(&fact.source)));
        self.origin == Origin::Behind
            && went
            && plain
            && straight
            && !self.pushed
            && only_there
            && ["behind", "trailing", "following"].iter().any(|word| place.contains(word))
            && !["approach", "from behind", "came up", "coming up"].iter().any(|word| place.contains(word))
    }

    /// Whether the ego slowed for a light, goes on straight as that has turned green, and is slow yet: who was behind it then waited there too.
    fn slowed_until_green(&self) -> bool {
        let sv = &self.sv;
        let green = sv.control.is_some_and(|control| control.state == Some(SignalState::TurnedGreen));
        let slow = sv.impact_mps.is_some_and(|mps| mps < CREEPS_MPS) && sv.slowed_from.is_some();
        sv.state == ContactState::Moving && green && slow && sv.turning == Turning::No
    }

    /// "Was maneuvering around the parked truck": out of its line, away from the touched side where no other is told.
    fn goes_round_standing(&mut self, sv: &Party) {
        let pass = sv.acts.iter().rfind(|fact| fact.act == Act::Pass && !fact.after_contact);
        let Some(pass) = pass.filter(|fact| text(&fact.source).contains("around")) else { return };
        let stands = self.cp.state.stands() && self.thing.is_none() && self.sv.state == ContactState::Moving;
        let touched = side_of(&self.sv.zones);
        let there = match self.origin {
            Origin::Ahead | Origin::Parked { side: None } => touched,
            Origin::Beside { side } | Origin::Parked { side: Some(side) } => Some(side),
            _ => return,
        };
        let to = pass.side.or(there.map(LeftRight::other)).unwrap_or(LeftRight::Left);
        let free = self.sv.movement == Some(Movement::Passing) && self.sv.aside.is_none();
        if stands && free && touched != Some(to) && self.sv.turning == Turning::No {
            (self.sv.aside, self.sv.goes_round) = (Some(to), !pass.begun);
        }
    }

    /// "Moved partly into the oncoming lane to pass a stopped truck", as somebody came towards it: out of its line to the left, round that one.
    fn goes_round_other(&mut self, account: &Account) {
        let pass = account.sv.acts.iter().rfind(|fact| fact.act == Act::Pass && !fact.after_contact);
        let goes = matches!(self.sv.movement, Some(Movement::Passing | Movement::Straight | Movement::LaneDeparture));
        let drives = self.sv.state == ContactState::Moving && self.sv.turning == Turning::No && goes;
        let to_left = self.sv.aside != Some(LeftRight::Right) && !self.sv.acts.iter().any(Doing::is_pass);
        let met = self.origin == Origin::Opposite && self.cp.turning == Turning::No && !self.comes_over;
        let stands = |other: &&Other| {
            let place = told(&other.place);
            let still = before_contact(other).all(|fact| matches!(fact.act, Act::Hold | Act::Stop | Act::Park));
            let vehicle = matches!(other.kind.value.group(), KindGroup::Car | KindGroup::Truck);
            vehicle && still && !other.several && matches!(place, None | Some(Origin::Ahead | Origin::Beside { .. }))
        };
        let ego_side = account.others.iter().filter(stands).count() == 1;
        // It is told to leave its line; or to go round somebody who is in that, not at the kerb.
        let at_kerb = |other: &Other| {
            let words =
                before_contact(other).map(|fact| &fact.source).chain(other.place.iter().map(|fact| &fact.source));
            words.map(text).any(|words| {
                ["curb", "kerb"].iter().any(|kerb| words.contains(kerb))
                    || words.contains("parked") && !words.contains("double")
            })
        };
        let aside = |fact: &ActFact| {
            !fact.after_contact && matches!(fact.act, Act::Drift | Act::Swerve | Act::LaneChange | Act::Enter)
        };
        let over = account.sv.acts.iter().any(aside) || account.sv.astride.is_some();
        let round = pass.is_some_and(|fact| text(&fact.source).contains("around"))
            && !account.others.iter().filter(stands).any(at_kerb);
        let leaves = over || round || self.sv.aside.is_some() || self.sv.movement == Some(Movement::LaneDeparture);
        if pass.is_some() && leaves && drives && to_left && met && ego_side && self.thing.is_none() {
            self.sv.movement = Some(Movement::Passing);
            (self.sv.aside, self.sv.goes_round) = (Some(LeftRight::Left), true);
        }
    }

    /// What the ego did because of the partner: when, and to which side.
    fn reactions(&mut self, sv: &Party, partner: &Party) {
        if self.sv.state != ContactState::Moving || self.thing.is_some() {
            return;
        }
        let turns = steps(partner, |act| matches!(act, Act::Turn | Act::PullOut | Act::Enter)).into_iter().min();
        let answers = |act| matches!(act, Act::Slow | Act::Swerve | Act::Drift | Act::LaneChange);
        let reacts = steps(sv, answers).into_iter().min();
        let turning = matches!(self.cp.turning, Turning::Left | Turning::Right);
        self.sv.reacts = turning && !self.cp.stood_first && turns.is_some() && turns < reacts;
        // Who swerves from somebody that comes at it, or steers aside and keeps its way, does so away from it.
        let swerves = !steps(sv, |act| act == Act::Swerve).is_empty();
        let goes_on = matches!(self.sv.movement, Some(Movement::Straight | Movement::Passing));
        let steers = goes_on && !steps(sv, |act| act == Act::Drift).is_empty();
        let departs = self.sv.movement == Some(Movement::LaneDeparture);
        if (swerves && (goes_on || departs) || steers) && self.sv.aside.is_none() && self.striker == Some(Striker::Cp) {
            self.sv.aside = match self.origin {
                Origin::Beside { side } | Origin::Cross { side } => Some(side.other()),
                _ => side_of(&self.sv.zones).map(LeftRight::other),
            };
        }
    }

    /// The ego that passes the partner on the other side goes round it there; so does one that goes round who stands.
    fn goes_round(&mut self, sv: &Party) {
        self.goes_round_standing(sv);
        let pass = sv.acts.iter().rfind(|fact| fact.act == Act::Pass && !fact.after_contact && !fact.begun);
        let Some(to) = pass.and_then(|fact| fact.side).filter(|_| self.sv.acts.iter().any(Doing::is_pass)) else {
            return;
        };
        let beside =
            matches!(self.origin, Origin::Beside { side } | Origin::Parked { side: Some(side) } if side == to.other());
        if beside && self.sv.movement == Some(Movement::Passing) && self.sv.aside.is_none() {
            (self.sv.aside, self.sv.goes_round) = (Some(to), true);
        }
    }
}
