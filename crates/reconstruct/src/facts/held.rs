//! Told facts, held against a rollout: who was where when. Of the scenario only its roads, signals and stops are read.

use crate::facts::acts::{self, Did};
use crate::facts::astride::astride;
use crate::facts::contact::{
    self, MET_M, Touch, crash, first_touch, is_near, order, parts_that_touch, swung, toucher, zone_words,
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
    Astride, ContactState, Control as Said, ControlDevice, Kind, LaneWord, Obeyed, Origin, StandReason, Striker,
};
use recrash_model::geometry::OrientedBox;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::rollout::{ActorState, ActorTrack, Rollout, STEP_S};
use recrash_roads::Scenario;

/// Every told fact.
pub(crate) fn facts(told: &Told, scenario: &Scenario, rollout: &Rollout) -> Vec<Check> {
    match Crash::of(told, scenario, rollout) {
        Some(crash) => crash.facts(),
        None => {
            let none = |kind| check(kind, false, "what is told of the contact", "no contact");
            told.kinds().into_iter().map(none).collect()
        }
    }
}

/// The first touch of a rollout, beside what is told of it.
struct Crash<'a> {
    told: &'a Told,
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
    fn of(told: &'a Told, scenario: &'a Scenario, rollout: &'a Rollout) -> Option<Crash<'a>> {
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

    fn facts(&self) -> Vec<Check> {
        let mut list = vec![self.contact(), self.partner()];
        list.extend(self.sv_zones());
        list.extend(self.cp_zones());
        list.extend(self.thing_moves());
        list.extend(self.states());
        list.extend(self.speeds());
        list.extend(self.passed_on());
        list.extend(self.movements());
        list.extend(self.acts());
        list.extend(self.approach());
        list.extend(self.order());
        list.extend(self.lanes());
        list.extend(self.astride());
        list.extend(self.controls());
        list.extend(self.reason());
        list.extend(self.others());
        list.extend(self.above_or_below());
        list.extend(self.door());
        list
    }

    fn contact(&self) -> Check {
        let by_partner = self.touch.track.is_none_or(|track| track.id == "cp");
        let undisturbed = self.told.pushed || toucher(self.rollout, &self.touch).is_none();
        let who = match (by_partner, undisturbed) {
            (true, true) => "the partner",
            (true, false) => "the partner, after another",
            (false, _) => "somebody else",
        };
        let crash = crash(self.told, self.rollout);
        let shown = by_partner && undisturbed && crash.is_none();
        let crash = crash.map_or(String::new(), |crash| format!("; {crash}"));
        let observed = format!("with {who} at {:.2} s{crash}", self.touch.time_s);
        check(CheckKind::Contact, shown, "a contact with the partner, and none of others", observed)
    }

    fn partner(&self) -> Check {
        let (told, seen) = (self.told.cp.kind, self.touch.kind);
        check(CheckKind::Partner, seen == told, told.label(), seen.label())
    }

    fn sv_zones(&self) -> Option<Check> {
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
        (!zones.is_empty()).then(|| check(CheckKind::SvZones, (near || over) && on_trailer, expected, observed))
    }

    fn cp_zones(&self) -> Option<Check> {
        let zones = &self.told.cp.zones;
        if zones.is_empty() || self.told.thing.is_some() {
            return None;
        }
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
        Some(check(CheckKind::CpZones, near && on_trailer, expected, observed))
    }

    /// Whether a thing that is told to swing or to slide does.
    fn thing_moves(&self) -> Option<Check> {
        if self.told.gate_swings {
            let part = self.other_part.as_ref().zip(self.touch.track);
            let swung = part.is_some_and(|(part, track)| swung(self.rollout, track, part, self.touch.time_s));
            let observed = if swung { "its arm swung" } else { "nothing swung" };
            return Some(check(CheckKind::CpState, swung, "swinging", observed));
        }
        let lies = self.told.is_sliding() && self.touch.track.is_none();
        lies.then(|| check(CheckKind::CpState, false, "moving", "it lies there"))
    }

    fn states(&self) -> impl Iterator<Item = Check> {
        let sv = Some((CheckKind::SvState, &self.told.sv, self.ego_track, &self.touch.ego));
        let cp = self.partner_track.map(|track| (CheckKind::CpState, &self.told.cp, track, &self.touch.other));
        let told = sv.into_iter().chain(cp).filter(|(_, side, ..)| side.state_told);
        told.map(|(kind, side, track, seen)| self.state(kind, side, track, seen))
    }

    fn state(&self, kind: CheckKind, side: &Side, track: &ActorTrack, seen: &ActorState) -> Check {
        let (told, time_s) = (self.told, self.touch.time_s);
        // Who is pushed moves when it touches; who was parked stood until then.
        let pushed = kind == CheckKind::CpState && told.pushed && told.thing.is_none();
        let stands = |state: &ActorState| state.velocity().length() < STANDS_MPS;
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
        let stands_so = told.stands_so(kind == CheckKind::SvState, self.scenario, seen);
        let backs_first = told.backs_first.filter(|_| kind == CheckKind::CpState && !told.sv.phases.is_empty());
        let in_order = backs_first.is_none_or(|first| phases::back_in_order(first, self.ego_track, track, time_s));
        let rolls_out = kind == CheckKind::CpState && told.rolls_out();
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
        check(kind, shown, expected, observed)
    }

    fn speeds(&self) -> impl Iterator<Item = Check> {
        let sides = [
            (CheckKind::SvSpeed, &self.told.sv, &self.touch.ego),
            (CheckKind::CpSpeed, &self.told.cp, &self.touch.other),
        ];
        sides.into_iter().filter_map(|(kind, side, seen)| {
            let told_mps = side.impact_mps?;
            let speed_mps = seen.velocity().length();
            let close = (speed_mps - told_mps).abs() <= 2.0_f64.max(0.25 * told_mps);
            let [of, at] = if side.came_so { ["as it came", " at the contact"] } else { ["at the contact", ""] };
            Some(check(kind, close, format!("{told_mps:.1} m/s {of}"), format!("{speed_mps:.1} m/s{at}")))
        })
    }

    fn passed_on(&self) -> Option<Check> {
        if !self.told.pushed {
            return None;
        }
        let before = toucher(self.rollout, &self.touch);
        let kind = self.told.pusher.and_then(Kind::partner_kind);
        let observed = before.map_or("touched by nobody before".to_owned(), |track| {
            format!("touched by another before: {}", track.kind.label().to_lowercase())
        });
        let comes_as_told = |by| {
            let step = (self.touch.time_s * 10.0) as usize;
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
        Some(Check { kind: CheckKind::PassedOn, expected, observed, result })
    }

    fn movements(&self) -> impl Iterator<Item = Check> {
        let sv = Some((CheckKind::SvMovement, &self.told.sv, self.ego_track, self.partner_track, self.touch.other));
        let cp = self.partner_track;
        let cp = cp.map(|track| (CheckKind::CpMovement, &self.told.cp, track, Some(self.ego_track), self.touch.ego));
        sv.into_iter().chain(cp).filter_map(|(kind, side, track, other, met)| {
            let (of_partner, time_s) = (kind == CheckKind::CpMovement, self.touch.time_s);
            let way = Way {
                scenario: self.scenario,
                track,
                other,
                met,
                time_s,
                keeps_lane: of_partner && self.told.keeps_its_lane(),
                road_rad: self.ego_track.states[0].heading,
                parks_at_kerb: of_partner && self.told.parks_behind(),
                crosses: of_partner && matches!(self.told.origin, Origin::Cross { .. }),
                came_along: of_partner && self.told.came_along_there(),
            };
            let slides = of_partner && keeping::slides(track.kind, until_touched(self.rollout, track, time_s));
            let seen = movement::check(side, &way);
            let (expected, result, observed) = if slides { as_nobody_drives(seen) } else { seen? };
            Some(Check { kind, expected, observed, result })
        })
    }

    /// What each of the two is told to have done.
    fn acts(&self) -> impl Iterator<Item = Check> {
        let enters = self.told.sv.enters() || self.told.cp.enters();
        let junction = enters.then(|| Junction::of(self.scenario)).flatten();
        // Where no junction is drawn nobody has entered one.
        let entered = |track| junction.as_ref().and_then(|inner| inner.entered(track));
        let did =
            |is_ego, told, track: Option<_>| track.map(|track| Did { is_ego, told, track, entered: entered(track) });
        let sv = did(true, self.told.sv.acts.as_slice(), Some(self.ego_track));
        let cp = did(false, self.told.cp.acts.as_slice(), self.partner_track);
        let both = [(CheckKind::SvActs, &sv, &cp), (CheckKind::CpActs, &cp, &sv)];
        let seen = both.map(|(kind, one, other)| {
            let one = one.as_ref().filter(|one| !one.told.is_empty())?;
            let (result, observed) = acts::check(one, other.as_ref(), self.touch.time_s);
            Some(Check { kind, expected: acts::words(one.told), observed, result })
        });
        seen.into_iter().flatten()
    }

    /// From where the partner came.
    fn approach(&self) -> Option<Check> {
        let (told, kind, touch) = (self.told, CheckKind::Approach, &self.touch);
        if let Some((expected, shown, observed)) = things::check(told, &self.ego_box, &touch.other_box) {
            return Some(check(kind, shown, expected, observed));
        }
        if let Some(side) = told.edge {
            let (shown, observed) = edge::check(told, side, self.scenario, &touch.ego, &touch.other_box);
            return Some(check(kind, shown, edge::words(side), observed));
        }
        let track = self.partner_track.filter(|_| told.origin_told)?;
        let (shown, observed) = origin(told, self.ego_track, track, touch.time_s);
        if comes_by_lane(told, self.scenario, track, touch.time_s) {
            return Some(check(kind, false, origin_words(told), observed + ", along a lane"));
        }
        if begins_elsewhere(told, self.scenario, track) {
            return Some(check(kind, false, origin_words(told), observed + ", beside the place"));
        }
        Some(check(kind, shown, origin_words(told), observed))
    }

    /// Who was there first.
    fn order(&self) -> Option<Check> {
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
        Some(check(CheckKind::Order, shown, first.words(), observed))
    }

    fn lanes(&self) -> impl Iterator<Item = Check> {
        let sides = [
            (CheckKind::SvLane, &self.told.sv, Some(self.ego_track)),
            (CheckKind::CpLane, &self.told.cp, self.partner_track),
        ];
        sides.into_iter().filter_map(|(kind, side, track)| {
            // Who is about to turn left is in the lane from which that is done.
            let of_ego = kind == CheckKind::SvLane;
            let to_come = || (of_ego && self.told.waits_to_turn_left()).then_some(LaneWord::LeftTurn);
            let (word, track) = (side.lane.filter(|_| !side.lane_to_come).or_else(to_come)?, track?);
            let counted = self.told.counted(of_ego);
            let expected = counted.map_or(lane_words(word).to_owned(), Counted::words);
            let seen = lane((self.told, word), self.scenario, [self.ego_track, track], self.touch.time_s);
            Some(held(kind, expected, seen))
        })
    }

    /// Whether those are over a line of the road who are told to be.
    fn astride(&self) -> impl Iterator<Item = Check> {
        let told = self.told;
        let sides = [
            (CheckKind::SvAstride, told.sv.astride, Some(self.ego_track)),
            (CheckKind::CpAstride, told.cp.astride.filter(|_| told.thing.is_none()), self.partner_track),
        ];
        let none = || (CheckResult::CannotBeShown, "not in the scene".to_owned());
        let seen = move |over: Astride, track: Option<&ActorTrack>| {
            track.map_or_else(none, |track| astride(over, self.scenario, track, self.touch.time_s))
        };
        let others = told.others_astride.iter().map(move |(number, over)| {
            let extra = told.wanted.iter().find(|extra| extra.of.contains(number));
            held(CheckKind::OthersAstride, over.words(), seen(*over, extra.and_then(|extra| self.seen().find(extra))))
        });
        let of_two = sides
            .into_iter()
            .filter_map(move |(kind, over, track)| Some(held(kind, over?.words(), seen(over?, track))));
        // Of several others the one that is not.
        of_two.chain(others.max_by_key(|check| check.result != CheckResult::Shown))
    }

    fn controls(&self) -> impl Iterator<Item = Check> {
        let sides = [
            (CheckKind::SvControl, &self.told.sv, Some(self.ego_track)),
            (CheckKind::CpControl, &self.told.cp, self.partner_track),
        ];
        sides.into_iter().filter_map(|(kind, side, track)| {
            let (said, track) = (side.control?, track?);
            let of_partner = kind == CheckKind::CpControl;
            let arm = signals::own_arm(self.told, self.scenario).filter(|_| of_partner);
            let at_red = self.told.keeps_red().filter(|_| !of_partner);
            let on_walk = of_partner && self.told.crosses_at_walk();
            let stops_at_yellow = !of_partner && self.told.stops_at_yellow();
            let asked = signals::Asked { said, arm, at_red, on_walk, stops_at_yellow };
            let seen = signals::check(asked, self.scenario, track, self.touch.time_s);
            let beside = of_partner && signals::is_beside_road(self.told);
            Some(held(kind, signals::words(said), if beside { signals::beside_road(seen) } else { seen }))
        })
    }

    /// Whether the scene holds what the ego stood for.
    fn reason(&self) -> Option<Check> {
        let reasons = &self.told.reasons;
        if !self.told.sv.state.stands() || reasons.is_empty() {
            return None;
        }
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
        Some(held(CheckKind::Reason, said.join(", "), seen))
    }

    fn others(&self) -> Option<Check> {
        if self.told.others == 0 {
            return None;
        }
        let (all, expected, observed) = self.seen().others();
        let result = if all { CheckResult::Shown } else { CheckResult::CannotBeShown };
        Some(held(CheckKind::Others, expected, (result, observed)))
    }

    /// Zones that are told to lie on the top or at the bottom, and nowhere else.
    fn above_or_below(&self) -> impl Iterator<Item = Check> {
        let sides = [(CheckKind::SvZones, &self.told.sv), (CheckKind::CpZones, &self.told.cp)];
        sides.into_iter().filter(|(_, side)| side.only_above_or_below).map(|(kind, _)| {
            let other_box = &self.touch.other_box;
            let under = self.told.is_driven_over()
                && things::goes_under(self.told, self.ego_track, self.partner_track, other_box, self.step());
            let seen = match under {
                true => (CheckResult::Shown, "the ego drives over it".to_owned()),
                false => (CheckResult::CannotBeShown, "the simulator has no height".to_owned()),
            };
            held(kind, "top or bottom".to_owned(), seen)
        })
    }

    fn door(&self) -> Option<Check> {
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
        Some(check(CheckKind::Door, by_door && !swings, expected, observed))
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
        (self.touch.time_s / STEP_S) as usize
    }
}

fn check(kind: CheckKind, shown: bool, expected: impl Into<String>, observed: impl Into<String>) -> Check {
    let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
    Check { kind, expected: expected.into(), observed: observed.into(), result }
}

fn held(kind: CheckKind, expected: String, (result, observed): (CheckResult, String)) -> Check {
    Check { kind, expected, observed, result }
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

/// What is said of a movement that nobody drives, whatever is told of it.
fn as_nobody_drives(check: Option<(String, CheckResult, String)>) -> (String, CheckResult, String) {
    let (expected, seen) = check.map_or_else(Default::default, |(expected, _, seen)| (expected, seen + ", "));
    let expected = if expected.is_empty() { "as somebody drives".to_owned() } else { expected };
    (expected, CheckResult::NotShown, seen + "as nobody drives")
}
