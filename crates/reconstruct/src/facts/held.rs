//! Told facts, held against a rollout: who was where when. Of the scenario only its roads, signals and stops are read.

use crate::facts::acts::{self, Did};
use crate::facts::astride::astride;
use crate::facts::contact::{
    self, MET_M, Touch, crash, first_touch, is_near, order, order_words, parts_that_touch, swung, toucher, zone_words,
};
use crate::facts::junction::Junction;
use crate::facts::lane::{lane, lane_words};
use crate::facts::movement::{self, Way};
use crate::facts::origin::{begins_elsewhere, comes_by_lane, origin, origin_words};
use crate::facts::seen::Seen;
use crate::facts::state::{came_slowly, changed, stands_at_stop, state, stood};
use crate::facts::strays::until_touched;
use crate::facts::{edge, keeping, phases, signals, things, thrown};
use crate::told::crash::Told;
use crate::told::layout::Counted;
use crate::told::phase;
use crate::told::rig::Rig;
use crate::told::side::Side;
use crate::touch::opening::{self, DOOR_M};
use crate::usual::{RUNS_LEAST_MPS, STANDS_MPS};
use recrash_metrics::contact::{ContactGeometry, contact_geometry};
use recrash_model::account::{
    Astride, ContactState, Control as Said, ControlDevice, Kind, Obeyed, Origin, StandReason, Striker,
};
use recrash_model::geometry::OrientedBox;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::{ActorState, ActorTrack, Rollout, step_of};
use recrash_roads::Scenario;

/// One of the two who touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Who {
    Ego,
    Partner,
}

/// What was found when a fact was held against a rollout.
pub(super) struct Found {
    pub(super) expected: String,
    pub(super) observed: String,
    pub(super) result: CheckResult,
}

/// The first touch of a rollout, beside what is told of it.
pub(super) struct Crash<'a> {
    pub(super) told: &'a Told,
    scenario: &'a Scenario,
    rollout: &'a Rollout,
    touch: Touch<'a>,
    ego_track: &'a ActorTrack,
    /// Who touched, where it is told to do more than to stand there.
    partner_track: Option<&'a ActorTrack>,
    ego_box: OrientedBox,
    /// A door or the like of the ego that touched, and one of the other.
    ego_part: Option<OrientedBox>,
    other_part: Option<OrientedBox>,
    geometry: ContactGeometry,
    /// The told trailer, where it is drawn as a part of its own.
    trailer: Option<Rig>,
}

impl<'a> Crash<'a> {
    pub(super) fn of(told: &'a Told, scenario: &'a Scenario, rollout: &'a Rollout) -> Option<Crash<'a>> {
        let touch = first_touch(rollout)?;
        let ego_track = rollout.ego_track();
        let ego_box = OrientedBox::new(touch.ego.pose(), ego_track.length_m, ego_track.width_m);
        let (ego_part, other_part) = parts_that_touch(rollout, &touch, &ego_box);
        let mut geometry = contact_geometry(
            ego_part.as_ref().unwrap_or(&ego_box),
            touch.ego.velocity(),
            other_part.as_ref().unwrap_or(&touch.other_box),
            touch.other.velocity(),
        );
        if let Some(part) = &ego_part {
            geometry.ego_zone = opening::zone_of(&ego_box, part);
        }
        let trailer = told.trailer_of.and_then(Rig::of).filter(|_| contact::is_drawn(rollout));
        if let Some(part) = &other_part {
            geometry.other_zone = match trailer {
                Some(rig) => rig.zone(part, &geometry),
                None => opening::zone_of(&touch.other_box, part),
            };
        }
        let partner_track = touch.track.filter(|_| !told.gate_swings);
        Some(Crash {
            told,
            scenario,
            rollout,
            touch,
            ego_track,
            partner_track,
            ego_box,
            ego_part,
            other_part,
            geometry,
            trailer,
        })
    }

    /// What is told of one of the two.
    fn side(&self, who: Who) -> &'a Side {
        match who {
            Who::Ego => &self.told.sv,
            Who::Partner => &self.told.cp,
        }
    }

    /// Its track; nothing of a partner that only stands there.
    fn track(&self, who: Who) -> Option<&'a ActorTrack> {
        match who {
            Who::Ego => Some(self.ego_track),
            Who::Partner => self.partner_track,
        }
    }

    /// Its state when they touch.
    fn met(&self, who: Who) -> &ActorState {
        match who {
            Who::Ego => &self.touch.ego,
            Who::Partner => &self.touch.other,
        }
    }

    pub(super) fn contact(&self) -> Found {
        let by_partner = self.touch.track.is_none_or(|track| track.id == "cp");
        let undisturbed = self.told.pushed || toucher(self.rollout, &self.touch).is_none();
        // Of a stated movement this is said with that.
        let slides = self.told.cp.movement.is_none() && self.partner_slides();
        let who = match (by_partner, undisturbed) {
            (true, true) => "the partner",
            (true, false) => "the partner, after another",
            (false, _) => "somebody else",
        };
        let crash = crash(self.told, self.rollout);
        let shown = by_partner && undisturbed && crash.is_none() && !slides;
        let crash = crash.map_or(String::new(), |crash| format!("; {crash}"));
        let slides = if slides { ", which came as nobody drives" } else { "" };
        let observed = format!("with {who}{slides} at {:.2} s{crash}", self.touch.time_s);
        check(shown, "a contact with the partner, and none of others", observed)
    }

    pub(super) fn partner(&self) -> Found {
        let (told, seen) = (self.told.cp.kind, self.touch.kind);
        check(seen == told, told.label(), seen.label())
    }

    pub(super) fn sv_zones(&self) -> Found {
        if self.told.sv.only_above_or_below {
            return self.above_or_below();
        }
        let zones = &self.told.sv.zones;
        let near = is_near(zones, self.geometry.ego_zone, &self.ego_box, self.geometry.point);
        let on_trailer = !self.told.sv_trailer || contact::is_on_own_trailer(&self.ego_box, self.geometry.point);
        let over = !near && things::rear_goes_over(self.told, self.ego_track, &self.touch.other_box, self.step());
        let (mut expected, mut observed) = (zone_words(zones), self.geometry.ego_zone.label().to_owned());
        if over {
            observed += ", and the rear goes over it";
        }
        if self.told.sv_trailer {
            expected += ", on the trailer";
            observed += if on_trailer { ", on the trailer" } else { ", ahead of the trailer" };
        }
        check((near || over) && on_trailer, expected, observed)
    }

    pub(super) fn cp_zones(&self) -> Found {
        if self.told.cp.only_above_or_below {
            return self.above_or_below();
        }
        let zones = &self.told.cp.zones;
        let near = is_near(zones, self.geometry.other_zone, &self.touch.other_box, self.geometry.point);
        // Of one box, the part of it behind who draws it.
        let on_trailer = match self.trailer {
            Some(_) => self.other_part.is_some(),
            None => {
                let box_ = &self.touch.other_box;
                self.told.trailer_of.is_none() || contact::is_on_trailer(self.told, box_, self.geometry.point)
            }
        };
        let (mut expected, mut observed) = (zone_words(zones), self.geometry.other_zone.label().to_owned());
        if self.told.trailer_of.is_some() {
            expected += ", on the trailer";
            observed += if on_trailer { ", on the trailer" } else { ", ahead of the trailer" };
        }
        check(near && on_trailer, expected, observed)
    }

    /// Whether a thing that is told to swing or to slide does.
    fn thing_moves(&self) -> Option<Found> {
        if self.told.gate_swings {
            let part = self.other_part.as_ref().zip(self.touch.track);
            let swung = part.is_some_and(|(part, track)| swung(self.rollout, track, part, self.touch.time_s));
            let observed = if swung { "its arm swung" } else { "nothing swung" };
            return Some(check(swung, "swinging", observed));
        }
        let lies = self.told.is_sliding() && self.touch.track.is_none();
        lies.then(|| check(false, "moving", "it lies there"))
    }

    pub(super) fn cp_state(&self) -> Option<Found> {
        self.thing_moves().or_else(|| self.state(Who::Partner))
    }

    pub(super) fn state(&self, who: Who) -> Option<Found> {
        let (side, track, seen) = (self.side(who), self.track(who)?, self.met(who));
        let of_partner = who == Who::Partner;
        let (told, time_s) = (self.told, self.touch.time_s);
        // Who is pushed moves when it touches; who was parked stood until then.
        let pushed = of_partner && told.pushed && told.thing.is_none();
        let stands = |state: &ActorState| state.stands();
        let untouched = until_touched(self.rollout, track, time_s);
        let parked = match side.state == ContactState::Parked {
            true if side.comes_to_park() => untouched.last().is_some_and(stands),
            true => untouched.iter().all(stands),
            false => true,
        };
        let pushed = pushed && parked;
        let stood = stood(track, time_s);
        let (slowed, gained) = changed(track, time_s);
        let (as_told, phases) = phases::check(phase::checked(&side.phases), track, time_s);
        let stands_so = told.stands_so(!of_partner, self.scenario, seen);
        let backs_first = told.backs_first.filter(|_| of_partner && !told.sv.phases.is_empty());
        let in_order = backs_first.is_none_or(|first| phases::back_in_order(first, self.ego_track, track, time_s));
        let rolls_out = of_partner && told.rolls_out();
        let runs = !side.runs() || seen.velocity().length() > RUNS_LEAST_MPS;
        let shown = pushed
            || !(rolls_out && stood)
                && state(if side.comes_to_park() { ContactState::Stopped } else { side.state }, track, seen, time_s)
                && stands_so
                && runs
                && (stood || !side.stood_first)
                && (slowed || side.slowed_from.is_none())
                && (gained || !side.gains)
                && (side.rolled_mps.is_none_or(|mps| came_slowly(track, time_s, mps)))
                && as_told
                && in_order;
        let (mut expected, mut observed) = (side.state.label().to_owned(), format!("{:.2} m/s", seen.speed()));
        if !stands_so {
            expected += ", beside the lanes";
            observed += ", in a driving lane";
        }
        if let Some(first) = backs_first {
            expected += if first == Striker::Cp { ", backed first" } else { ", backed after the ego" };
            observed += if in_order { ", so it did" } else { ", so it did not" };
        }
        if rolls_out {
            expected += ", without a stop";
        }
        if side.runs() {
            expected += ", running";
        }
        if let Some(mps) = side.rolled_mps {
            expected += &format!(", before at {mps:.1} m/s");
        }
        if side.phases.is_empty() {
            expected += before(side.stood_first, side.slowed_from.is_some(), side.gains);
            observed += before(stood, slowed, gained);
        } else {
            expected += &format!(": {}", phase::words(phase::checked(&side.phases)));
            observed += &format!(": {phases}");
        }
        Some(check(shown, expected, observed))
    }

    pub(super) fn speed(&self, who: Who) -> Option<Found> {
        let side = self.side(who);
        let (told_mps, speed_mps) = (side.binding_mps()?, self.met(who).velocity().length());
        // However near it is: who stands does not move.
        let both = (told_mps < STANDS_MPS) == (speed_mps < STANDS_MPS);
        let close = both && (speed_mps - told_mps).abs() <= 2.0_f64.max(0.25 * told_mps);
        let [of, at] = if side.came_so { ["as it came", " at the contact"] } else { ["at the contact", ""] };
        Some(check(close, format!("{told_mps:.1} m/s {of}"), format!("{speed_mps:.1} m/s{at}")))
    }

    pub(super) fn passed_on(&self) -> Found {
        let before = toucher(self.rollout, &self.touch);
        let kind = self.told.pusher.and_then(Kind::partner_kind);
        let observed = before.map_or("touched by nobody before".to_owned(), |track| {
            format!("touched by another before: {}", track.kind.label().to_lowercase())
        });
        let comes_as_told = |by| {
            let step = step_of(self.touch.time_s);
            let met = self.partner_track;
            met.is_none_or(|met| thrown::comes_as_told(self.told, self.ego_track, [met, by], step))
        };
        let result = match before {
            Some(track) if kind.is_none_or(|kind| kind == track.kind) => match comes_as_told(track) {
                true => CheckResult::Shown,
                false => CheckResult::CannotBeShown,
            },
            // Who pushed a thing is not drawn.
            None if self.told.is_sliding() => CheckResult::CannotBeShown,
            _ => CheckResult::NotShown,
        };
        let whose = kind.map_or(String::new(), |kind| format!(": {}", kind.label().to_lowercase()));
        let expected = format!("another touched the partner first{whose}");
        Found { expected, observed, result }
    }

    pub(super) fn movement(&self, who: Who) -> Option<Found> {
        let (side, track, of_partner) = (self.side(who), self.track(who)?, who == Who::Partner);
        let (other, met) = match who {
            Who::Ego => (self.partner_track, self.touch.other),
            Who::Partner => (Some(self.ego_track), self.touch.ego),
        };
        let way = Way {
            scenario: self.scenario,
            track,
            other,
            met,
            time_s: self.touch.time_s,
            keeps_lane: of_partner && self.told.keeps_its_lane(),
            road_rad: self.ego_track.states[0].heading,
            parks_at_kerb: of_partner && self.told.parks_behind(),
            crosses: of_partner && matches!(self.told.origin, Origin::Cross { .. }),
            came_along: of_partner && self.told.came_along_there(),
        };
        let (expected, result, observed) = movement::check(side, &way)?;
        Some(match of_partner && self.partner_slides() {
            true => check(false, expected, observed + ", as nobody drives"),
            false => Found { expected, observed, result },
        })
    }

    /// Whether the partner turns on the spot, slides or jumps on its way to the contact.
    fn partner_slides(&self) -> bool {
        let slides =
            |track: &ActorTrack| keeping::slides(track.kind, until_touched(self.rollout, track, self.touch.time_s));
        self.partner_track.is_some_and(slides)
    }

    /// What one of the two is told to have done.
    pub(super) fn acts(&self, who: Who) -> Option<Found> {
        let enters = self.told.sv.enters() || self.told.cp.enters();
        let junction = enters.then(|| Junction::of(self.scenario)).flatten();
        // Where no junction is drawn nobody has entered one.
        let entered = |track| junction.as_ref().and_then(|inner| inner.entered(track));
        let did = |who: Who| {
            let (is_ego, told) = (who == Who::Ego, self.side(who).acts.as_slice());
            self.track(who).map(|track| Did { is_ego, told, track, entered: entered(track) })
        };
        let other = if who == Who::Ego { Who::Partner } else { Who::Ego };
        let one = did(who)?;
        let (result, observed) = acts::check(&one, did(other).as_ref(), self.touch.time_s);
        Some(Found { expected: acts::words(one.told), observed, result })
    }

    /// From where the partner came.
    pub(super) fn approach(&self) -> Option<Found> {
        let (told, touch) = (self.told, &self.touch);
        if let Some((expected, shown, observed)) = things::check(told, &self.ego_box, &touch.other_box) {
            return Some(check(shown, expected, observed));
        }
        if let Some(side) = told.edge {
            let (shown, observed) = edge::check(told, side, self.scenario, &touch.ego, &touch.other_box);
            return Some(check(shown, edge::words(side), observed));
        }
        let track = self.partner_track?;
        let (shown, observed) = origin(told, self.ego_track, track, touch.time_s);
        if comes_by_lane(told, self.scenario, track, touch.time_s) {
            return Some(check(false, origin_words(told), observed + ", along a lane"));
        }
        if begins_elsewhere(told, self.scenario, track) {
            return Some(check(false, origin_words(told), observed + ", beside the place"));
        }
        Some(check(shown, origin_words(told), observed))
    }

    /// Who was there first.
    pub(super) fn order(&self) -> Option<Found> {
        let (first, track) = (self.told.order?, self.partner_track?);
        // Who stands there holds what a door of its reaches; a door of the partner's comes there when it opens, and an ego within its reach
        // was there before.
        let actors = &self.rollout.actors;
        let number = actors.iter().position(|other| other.id == track.id);
        let door = actors.iter().find(|other| other.part_of.is_some() && other.part_of == number);
        let door = door.filter(|_| self.other_part.is_some());
        let ego_reach_m = if self.ego_part.is_some() || door.is_some() { DOOR_M } else { MET_M };
        let both = [(self.ego_track, ego_reach_m), (door.unwrap_or(track), MET_M)];
        let (shown, observed) = order(first, both, self.geometry.point, self.touch.time_s);
        Some(check(shown, order_words(first), observed))
    }

    pub(super) fn lane(&self, who: Who) -> Option<Found> {
        let (track, of_ego) = (self.track(who)?, who == Who::Ego);
        let word = self.told.lane_word(of_ego)?;
        let counted = self.told.counted(of_ego);
        let expected = counted.map_or(lane_words(word).to_owned(), Counted::words);
        Some(held(expected, lane((self.told, word), self.scenario, [self.ego_track, track], self.touch.time_s)))
    }

    /// Whether one of the two is over a line of the road, as it is told.
    pub(super) fn astride(&self, who: Who) -> Option<Found> {
        Some(self.is_over(self.side(who).astride?, self.track(who)))
    }

    fn is_over(&self, over: Astride, track: Option<&ActorTrack>) -> Found {
        let none = || (CheckResult::CannotBeShown, "not in the scene".to_owned());
        let seen = |track| astride(over, self.scenario, track, self.touch.time_s);
        held(over.words(), track.map_or_else(none, seen))
    }

    /// The same of others: of several the one that is not.
    pub(super) fn others_astride(&self) -> Option<Found> {
        let others = self.told.others_astride.iter().map(|(number, over)| {
            let extra = self.told.wanted.iter().find(|extra| extra.of.contains(number));
            self.is_over(*over, extra.and_then(|extra| self.seen().find(extra)))
        });
        others.max_by_key(|found| found.result != CheckResult::Shown)
    }

    pub(super) fn control(&self, who: Who) -> Option<Found> {
        let (said, track, of_partner) = (self.side(who).control?, self.track(who)?, who == Who::Partner);
        let arm = signals::own_arm(self.told, self.scenario).filter(|_| of_partner);
        let at_red = self.told.keeps_red().filter(|_| !of_partner);
        let on_walk = of_partner && self.told.crosses_at_walk();
        let stops_at_yellow = !of_partner && self.told.stops_at_yellow();
        let asked = signals::Asked { said, arm, at_red, on_walk, stops_at_yellow };
        let seen = signals::check(asked, self.scenario, track, self.touch.time_s);
        let beside = of_partner && signals::is_beside_road(self.told);
        Some(held(signals::words(said), if beside { signals::beside_road(seen) } else { seen }))
    }

    /// Whether the scene holds what the ego stood for.
    pub(super) fn reason(&self) -> Found {
        let reasons = &self.told.reasons;
        let controlled = |device: ControlDevice| {
            let said = Said { device, state: None, obeyed: Some(Obeyed::Yes) };
            let (arm, at_red) = (None, self.told.keeps_red());
            let asked = signals::Asked { said, arm, at_red, on_walk: false, stops_at_yellow: false };
            signals::check(asked, self.scenario, self.ego_track, self.touch.time_s).0 == CheckResult::Shown
        };
        let holds = |reason: &StandReason| match reason {
            StandReason::RedLight => controlled(ControlDevice::Signal),
            StandReason::StopSign => controlled(ControlDevice::StopSign),
            StandReason::PickupDropoff => stands_at_stop(self.scenario, self.ego_track, self.touch.time_s),
            other => self.seen().reason(*other),
        };
        let seen = match reasons.iter().all(holds) {
            true => (CheckResult::Shown, "in the scene".to_owned()),
            false => (CheckResult::CannotBeShown, "not in the scene".to_owned()),
        };
        let said: Vec<&str> = reasons.iter().map(|reason| reason.label()).collect();
        held(said.join(", "), seen)
    }

    pub(super) fn others(&self) -> Found {
        let (all, expected, observed) = self.seen().others();
        let result = if all { CheckResult::Shown } else { CheckResult::CannotBeShown };
        held(expected, (result, observed))
    }

    /// Zones that are told to lie on the top or at the bottom, and nowhere else.
    fn above_or_below(&self) -> Found {
        let other_box = &self.touch.other_box;
        let under = self.told.is_driven_over()
            && things::goes_under(self.told, self.ego_track, self.partner_track, other_box, self.step());
        let seen = match under {
            true => (CheckResult::Shown, "the ego drives over it".to_owned()),
            false => (CheckResult::CannotBeShown, "the simulator has no height".to_owned()),
        };
        held("top or bottom".to_owned(), seen)
    }

    pub(super) fn door(&self) -> Option<Found> {
        let (owner, of_ego, of_other) = (self.told.door?, self.ego_part.is_some(), self.other_part.is_some());
        let by_door = if owner == Striker::Sv { of_ego } else { of_other };
        let whose = |of_ego: bool| if of_ego { "the ego's door" } else { "the partner's door" };
        let stood = self.told.layout.stood_open.is_some();
        let swings = stood && by_door && self.door_swings();
        let observed = match of_ego || of_other {
            false => "bodies touched".to_owned(),
            true => format!("{}{}", whose(of_ego), if swings { ", as it opened" } else { "" }),
        };
        let expected = format!("{}{}", whose(owner == Striker::Sv), if stood { ", which stood open" } else { "" });
        Some(check(by_door && !swings, expected, observed))
    }

    /// Whether the door that touched was still opening.
    fn door_swings(&self) -> bool {
        let (owner, part) = match &self.ego_part {
            Some(part) => (Some(self.ego_track), Some(part)),
            None => (self.touch.track, self.other_part.as_ref()),
        };
        owner.zip(part).is_some_and(|(owner, part)| swung(self.rollout, owner, part, self.touch.time_s))
    }

    fn seen(&self) -> Seen<'_> {
        Seen::new(self.told, self.rollout, self.touch.time_s)
    }

    /// Number of the state in which they touch.
    fn step(&self) -> usize {
        step_of(self.touch.time_s)
    }
}

fn check(shown: bool, expected: impl Into<String>, observed: impl Into<String>) -> Found {
    let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
    Found { expected: expected.into(), observed: observed.into(), result }
}

fn held(expected: String, (result, observed): (CheckResult, String)) -> Found {
    Found { expected, observed, result }
}

/// What is said of how somebody came to the contact.
fn before(stood: bool, slowed: bool, gained: bool) -> &'static str {
    match (stood, slowed, gained) {
        (true, true, _) => ", had stood, then slowed",
        (true, ..) => ", had stood",
        (false, true, _) => ", had slowed",
        (false, false, true) => ", had gained speed",
        (false, false, false) => "",
    }
}
