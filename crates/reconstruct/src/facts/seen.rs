//! Whether a rollout holds the others who are told of, where and when they matter.

use crate::facts::contact::thrower;
use crate::facts::near::SLOWED_MPS;
use crate::facts::signals;
use crate::facts::things;
use crate::others::stand::{stands, stood_behind};
use crate::told::crash::Told;
use crate::told::near::Near;
use crate::told::others::{Extra, GIVEN_WAY, Role, Thrower};
use crate::told::queue::{leaves_lane, waits_ahead};
use crate::told::side::Turning;
use crate::usual::{LANE_M, RUNS_LEAST_MPS, STANDS_MPS};
use recrash_model::account::{ContactState, Kind, LeftRight, Origin, StandReason};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorTrack, Rollout};
use recrash_roads::Scenario;

/// Whoever stands ahead of an ego stands no farther ahead of its front, who crosses on foot, and who crosses or comes by in a vehicle.
/// An ego that moves could stop before them, braking so. [m, m/s^2]
const AHEAD_M: f64 = 8.0;
const CROSSING_M: f64 = 30.0;
const BRAKES_MPS2: f64 = 2.0;

/// For whom an ego slows on its way it does so in the last of that. [steps]
const LATE_STEPS: usize = 30;

/// Who stays close to the ego is no farther from its way when the two touch. [m]
const CLOSE_M: f64 = 4.0;

/// Who is parked beside the way is no farther off, ahead or behind. [m]
const PARKED_M: f64 = 40.0;

/// Behind whom an ego leaves its lane, it has so much more room for that. [m]
const OUT_M: f64 = 4.0;

/// An ego that is slower than this waits as it rolls. [m/s]
const CREEPS_MPS: f64 = 0.6;

/// Who stands in the next lane is no farther ahead or behind. [m]
const BESIDE_M: f64 = 10.0;

/// Who makes room for somebody goes so far aside. [m]
const ROOM_M: f64 = 0.3;

/// Who is passed between it and the ego is abreast of that by so much, and no more lanes aside. [m, lanes]
const OVERLAPS_M: f64 = 0.5;
const BESIDE_LANES: f64 = 2.4;

/// Whom the ego stands for while it comes comes so much nearer then; and who passes between two is no farther before them. [m]
const COMES_M: f64 = 2.0;

/// A line of sight is so wide. [m]
const SIGHT_M: f64 = 0.1;

/// A rollout, and when the two touch.
pub(crate) struct Seen<'a> {
    told: &'a Told,
    rollout: &'a Rollout,
    ego: &'a ActorTrack,
    until: usize,
}

/// Who comes along the crossing road is at such an angle to the ego's way, who comes towards it at more than that. [rad]
const ACROSS_RAD: (f64, f64) = (0.6, 2.5);
const TOWARDS_RAD: f64 = 2.0;

impl<'a> Seen<'a> {
    pub(crate) fn new(told: &'a Told, rollout: &'a Rollout, time_s: f64) -> Self {
        let ego = rollout.ego_track();
        Self { told, rollout, ego, until: ego.step_at(time_s) }
    }

    /// Whether all of the others who are told of are there as told; who is wanted, and who is there.
    pub(super) fn others(&self) -> (bool, String, String) {
        let words = |list: &[&Extra], throws: bool| {
            let words = list.iter().map(|extra| extra.words()).chain(throws.then_some("one throws the partner"));
            words.collect::<Vec<_>>().join(", ")
        };
        let named = self.told.wanted.iter().filter(|extra| !extra.of.is_empty() && !extra.is_assumed());
        let told: Vec<&Extra> = named.collect();
        let there: Vec<&Extra> = told.iter().copied().filter(|extra| self.holds(extra)).collect();
        let throws = self.throws() && self.told.throwers > 0;
        let count = there.iter().map(|extra| extra.of.len()).sum::<usize>() + usize::from(throws);
        let all = words(&told, self.told.throwers > 0);
        let expected = format!("{} more: {}", self.told.others, if all.is_empty() { "not known where" } else { &all });
        (count >= self.told.others, expected, format!("{count} more: {}", words(&there, throws)))
    }

    /// Whether somebody who is drawn is elsewhere than it is wanted, or drives against its red light.
    pub(super) fn strays(&self, scenario: &Scenario) -> bool {
        let thrower = self.thrower().filter(|_| self.told.pushed).map(|number| &self.rollout.actors[number]);
        let runs_red = |track: &ActorTrack| {
            let is_of_crash = track.id == "cp" || thrower.is_some_and(|thrower| std::ptr::eq(track, thrower));
            !is_of_crash && !std::ptr::eq(track, self.ego) && signals::runs_red(scenario, track)
        };
        let there = |extra: &&Extra| self.find(extra).is_some();
        self.told.extras.iter().filter(there).any(|extra| !self.holds(extra))
            || self.rollout.actors.iter().any(runs_red)
    }

    /// Whether the scene holds whom the ego stood for.
    pub(crate) fn reason(&self, reason: StandReason) -> bool {
        let is = |role: Role| self.told.wanted.iter().any(|extra| extra.role == role && self.holds(extra));
        match reason {
            StandReason::LeadVehicle if self.told.origin == Origin::Ahead => is(Role::Lead) || self.partner_leads(),
            // The queue ends behind the junction that the ego keeps clear.
            StandReason::Queue if self.told.wanted.iter().any(|extra| extra.role == Role::Beyond) => {
                is(Role::Lead) || is(Role::Beyond)
            }
            StandReason::Queue | StandReason::LeadVehicle => is(Role::Lead),
            StandReason::Pedestrian => is(Role::Walker),
            StandReason::Animal => is(Role::Animal),
            StandReason::Yield => {
                // Whom it keeps a junction clear for stand behind that.
                let beyond = self.told.reasons.contains(&StandReason::Queue) && is(Role::Beyond);
                beyond
                    || GIVEN_WAY.into_iter().any(is)
                    || self.told.origin == Origin::Ahead && self.partner_leads()
                    || self.wanted().any(|(extra, track)| {
                        extra.awaited && extra.near.is_some() && Near::is_waited_for(self.ego, track, self.until)
                    })
            }
            StandReason::BlockedJunction => is(Role::Beyond) || is(Role::Blocker),
            StandReason::BlockedPath => {
                is(Role::Lead)
                    || is(Role::Obstacle)
                    || is(Role::Thing)
                    || self.told.origin == Origin::Ahead && self.partner_leads()
            }
            StandReason::EmergencyVehicle => {
                let comes = |track: &ActorTrack| track.kind == PartnerKind::FirstResponder;
                self.wanted().any(|(_, track)| comes(track)) || self.partner_comes(comes)
            }
            StandReason::Parked => self.told.sv.state == ContactState::Parked || self.told.sv.came_to_park,
            _ => false,
        }
    }

    /// Those who are wanted and there as they are told, and the account names.
    fn wanted(&self) -> impl Iterator<Item = (&Extra, &'a ActorTrack)> {
        let named = self.told.wanted.iter().filter(|extra| !extra.of.is_empty());
        named.filter_map(|extra| Some((extra, self.find(extra).filter(|_| self.holds(extra))?)))
    }

    /// Whether the ego stands, and the partner comes to it then.
    fn partner_comes(&self, is: impl Fn(&ActorTrack) -> bool) -> bool {
        let Some(track) = self.rollout.actors.iter().find(|track| track.id == "cp" && is(track)) else { return false };
        let from = stands(self.ego, self.until).last().map_or(self.until, |(from, _)| *from);
        let gap_m = |step: usize| {
            let state = track.at(step);
            state.position().distance(self.ego.states[step].position())
        };
        from < self.until && gap_m(from) > gap_m(self.until) + COMES_M
    }

    /// Whether the partner stands ahead of the ego where that came to stand.
    fn partner_leads(&self) -> bool {
        let Some(track) = self.rollout.actors.iter().find(|track| track.id == "cp") else { return false };
        let from = stands(self.ego, self.until).first().map_or(self.until, |(from, _)| *from);
        let (ahead_m, left_m) = self.beside(track, from);
        let within_m = AHEAD_M + 0.5 * track.length_m;
        ahead_m > 0.0 && math::hypot(ahead_m, left_m) < within_m && left_m.abs() < LANE_M
    }

    pub(super) fn find(&self, extra: &Extra) -> Option<&'a ActorTrack> {
        let id = extra.id();
        self.rollout.actors.iter().find(|track| track.id == id)
    }

    /// Number of who touched the partner before the ego's contact.
    fn thrower(&self) -> Option<usize> {
        let contact_s = self.rollout.first_contact_of(0).map_or(f64::INFINITY, |(time_s, _)| time_s);
        thrower(self.rollout, contact_s)
    }

    /// Whether who is told to have thrown the partner touched it.
    fn throws(&self) -> bool {
        let number = self.thrower();
        let as_told = |number: usize| {
            let kind = self.told.pusher.and_then(Kind::partner_kind);
            let track = &self.rollout.actors[number];
            let stood = Self::mps(track, 0) < STANDS_MPS;
            let kind = kind.is_none_or(|kind| kind == track.kind);
            kind && (stood || !self.told.pusher_stands) && self.comes_from(track)
        };
        number.is_some_and(as_told)
    }

    /// Whether who threw the partner came from where it is told to: along the crossing road from a side, or towards the ego.
    fn comes_from(&self, track: &ActorTrack) -> bool {
        let (first, ego) = (&track.states[0], &self.ego.states[0]);
        let facing = math::wrap_angle(first.heading - ego.heading);
        match self.told.thrower {
            Some(Thrower::Cross(LeftRight::Left)) => (-ACROSS_RAD.1..-ACROSS_RAD.0).contains(&facing),
            Some(Thrower::Cross(LeftRight::Right)) => (ACROSS_RAD.0..ACROSS_RAD.1).contains(&facing),
            Some(Thrower::Opposite) => facing.abs() > TOWARDS_RAD,
            _ => true,
        }
    }

    /// Whether somebody is there, of its kind, and does its part.
    pub(crate) fn holds(&self, extra: &Extra) -> bool {
        let Some(track) = self.find(extra) else { return false };
        let as_told = extra.kind.partner_kind().is_none_or(|kind| kind == track.kind);
        as_told
            && self.loses(extra, track)
            && match extra.role {
                Role::Lead | Role::Thing => self.leads(extra, track),
                Role::Slower => self.slows_ahead(track),
                Role::Walker if extra.stays => self.stays_close(track) && self.is_on_side(extra, track),
                Role::Walker if extra.runs && !self.runs(track) => false,
                Role::Walker | Role::Animal => self.crosses(extra, track, AHEAD_M) && self.is_on_side(extra, track),
                Role::Crosser => self.crosses(extra, track, CROSSING_M) && self.is_on_side(extra, track),
                Role::Oncoming => self.comes_by(extra, track),
                Role::Beside => self.stands_beside(extra, track),
                Role::Backer => self.backs_out(extra, track),
                Role::Abreast => self.drives_beside(extra, track),
                Role::Kerb => {
                    self.is_parked(track) && self.is_on_side(extra, track) && (!extra.hides || self.hides(track))
                }
                Role::Obstacle => self.is_passed(extra, track),
                Role::Passed => self.partner_passes(extra, track),
                Role::Screen => self.hides(track),
                Role::Merger => self.merges(extra, track),
                Role::Blocker => self.blocks(track, true),
                Role::Beyond => self.blocks(track, false),
                Role::Near => extra.near.is_some_and(|near| near.holds(self.ego, track, self.until)),
            }
    }

    /// Whether what is told to have come off somebody does: "a ladder slid off the truck ahead of it".
    fn loses(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let its = self.told.dropped.is_some_and(|number| extra.of.contains(&number));
        let thing = self.rollout.actors.iter().find(|track| track.id == "cp").filter(|_| its);
        !its || thing.is_some_and(|thing| things::comes_off(thing, track, self.until))
    }

    /// Whether somebody runs on its way.
    fn runs(&self, track: &ActorTrack) -> bool {
        (0..=self.until).any(|step| Self::mps(track, step) > RUNS_LEAST_MPS)
    }

    fn mps(track: &ActorTrack, step: usize) -> f64 {
        track.at(step).velocity().length()
    }

    /// How far ahead of the ego's front somebody is at a step, and how far to its left. [m]
    fn beside(&self, track: &ActorTrack, step: usize) -> (f64, f64) {
        let (state, other) = (&self.ego.states[step], track.at(step));
        let (ahead, way) = (Vec2::from_heading(state.heading), other.position() - state.position());
        (ahead.dot(way) - 0.5 * self.ego.length_m, ahead.cross(way))
    }

    /// How far it takes the ego to stop. [m]
    fn stopping_m(&self, step: usize) -> f64 {
        0.5 * Self::mps(self.ego, step) * Self::mps(self.ego, step) / BRAKES_MPS2
    }

    /// Whether the ego stands at a step, or has slowed.
    fn gives_way(&self, step: usize) -> bool {
        let now_mps = Self::mps(self.ego, step);
        let was = (0..step).any(|before| Self::mps(self.ego, before) > now_mps + SLOWED_MPS);
        let will = (step..=self.until).any(|later| Self::mps(self.ego, later) < now_mps - SLOWED_MPS);
        now_mps < CREEPS_MPS || was || will
    }

    /// Whether somebody stands ahead where the ego stands or slows, and drives on before it does, where told.
    fn leads(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let (from, to) = stood_behind(extra, self.ego, self.until).unwrap_or((self.until, self.until));
        let (ahead_m, left_m) = self.beside(track, from);
        // Behind or beside a partner that stands in the queue too.
        let at_kerb = self.told.is_at_kerb() && matches!(self.told.origin, Origin::Beside { .. });
        let queue_m = match () {
            () if waits_ahead(self.told) || at_kerb => PARKED_M,
            () if leaves_lane(self.told) => OUT_M,
            () => 0.0,
        };
        let within_m = AHEAD_M + 0.5 * track.length_m + self.stopping_m(from) + queue_m;
        let there = ahead_m > 0.0 && math::hypot(ahead_m, left_m) < within_m && left_m.abs() < LANE_M;
        let stood = Self::mps(track, from) < STANDS_MPS;
        let goes = (from..=self.until).find(|step| Self::mps(track, *step) > 2.0 * STANDS_MPS);
        let ego_goes = to + 1 < self.until && self.gives_way(from);
        // Who stands again has moved up, and is close ahead yet.
        let close = self.beside(track, self.until).0 < AHEAD_M + 0.5 * track.length_m + self.stopping_m(self.until);
        let again = extra.again && ego_goes && close && Self::mps(track, self.until) < CREEPS_MPS;
        let in_order = match (extra.goes, goes) {
            (false, Some(goes)) if again => goes <= to + 1,
            // Who is told to move up has.
            (false, None) => !(extra.again && ego_goes),
            (false, Some(_)) => false,
            (true, Some(goes)) => !ego_goes || goes <= to + 1,
            (true, None) => false,
        };
        there && stood && in_order && self.beside(track, self.until).0 > 0.0
    }

    /// Whether somebody drives ahead in the ego's lane, and slows before the ego is touched.
    fn slows_ahead(&self, track: &ActorTrack) -> bool {
        let (mut ahead_m, mut left_m) = self.beside(track, self.until);
        // Of an ego that goes aside, in the lane in which it came.
        if self.told.sv_aside().is_some() {
            let last = track.within(self.until);
            let (first, there) = (&self.ego.states[0], track.states[last].position());
            let along = Vec2::from_heading(first.heading);
            ahead_m = along.dot(there - self.ego.states[self.until].position()) - 0.5 * self.ego.length_m;
            left_m = along.cross(there - first.position());
        }
        let slowed = (0..self.until).any(|step| Self::mps(track, step) > Self::mps(track, self.until) + SLOWED_MPS);
        (0.0..CROSSING_M).contains(&ahead_m) && left_m.abs() < 0.5 * LANE_M && slowed
    }

    /// Whether somebody passes ahead of the ego, from one side of it to the other, while it stands or slows before the contact.
    fn crosses(&self, extra: &Extra, track: &ActorTrack, within_m: f64) -> bool {
        // Who had gone by did so while the ego stood first.
        let set_off = extra.early.then(|| stands(self.ego, self.until).first().map(|(_, to)| *to)).flatten();
        let last = track.within(set_off.unwrap_or(self.until));
        (self.first_step(extra)..=last).any(|step| {
            let ((ahead_m, left_m), (_, before_m)) = (self.beside(track, step), self.beside(track, step - 1));
            let near = (0.0..within_m + self.stopping_m(step)).contains(&ahead_m);
            near && left_m * before_m <= 0.0 && left_m != before_m && self.gives_way(step)
        })
    }

    /// From when it may be met: for whom the ego slowed that had stood before, as it slows.
    fn first_step(&self, extra: &Extra) -> usize {
        if extra.late { self.until.saturating_sub(LATE_STEPS).max(1) } else { 1 }
    }

    /// Whether somebody is close to the ego, beside its way.
    fn is_close(&self, track: &ActorTrack, step: usize) -> bool {
        let (ahead_m, left_m) = self.beside(track, step);
        left_m.abs() < CLOSE_M && (-self.ego.length_m..AHEAD_M).contains(&ahead_m)
    }

    /// Whether somebody on foot stands close to the ego at the contact, and has not crossed its way.
    fn stays_close(&self, track: &ActorTrack) -> bool {
        Self::mps(track, self.until) < STANDS_MPS && self.is_close(track, self.until)
    }

    /// Whether somebody who crosses comes from the told side.
    fn is_on_side(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let (_, left_m) = self.beside(track, 0);
        extra.side.is_none_or(|side| side.is_at(left_m))
    }

    /// Whether somebody comes towards the ego, and passes it on its left while it stands or slows, where it is told to wait for it.
    fn comes_by(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let last = track.within(self.until);
        (1..=last).any(|step| {
            let ((ahead_m, left_m), (before_m, _)) = (self.beside(track, step), self.beside(track, step - 1));
            let facing = math::wrap_angle(track.states[step].heading - self.ego.states[0].heading).abs();
            let by = ahead_m <= 0.0 && before_m > 0.0 && facing > 2.0;
            by && step >= self.first_step(extra)
                && (1.5..4.0 * LANE_M).contains(&left_m)
                && (self.gives_way(step) || self.makes_room(extra, step) || !extra.awaited)
        })
    }

    /// Whether the ego has gone aside to the right for who comes towards it, at a step.
    fn makes_room(&self, extra: &Extra, step: usize) -> bool {
        let (first, met) = (&self.ego.states[0], self.ego.states[step.min(self.until)].position());
        let right_m = -Vec2::from_heading(first.heading).cross(met - first.position());
        extra.role == Role::Oncoming && self.told.sv.turning == Turning::No && right_m > ROOM_M
    }

    /// Whether somebody stands beside the ego's way all the time.
    fn is_parked(&self, track: &ActorTrack) -> bool {
        let (ahead_m, left_m) = self.beside(track, self.until);
        self.stays(track) && ahead_m.abs() < PARKED_M && left_m.abs() > 0.5 * LANE_M
    }

    fn stays(&self, track: &ActorTrack) -> bool {
        (0..=self.until).all(|step| Self::mps(track, step) < STANDS_MPS)
    }

    /// Whether somebody stands ahead of the ego all the time, across its way or along it.
    fn blocks(&self, track: &ActorTrack, across: bool) -> bool {
        let (mut ahead_m, mut left_m) = self.beside(track, self.until);
        let mut heading = self.ego.states[self.until].heading;
        // Of an ego that stands aslant, as it came along the road.
        if self.told.sv_aside().is_some() {
            heading = self.ego.states[0].heading;
            let (along, met) = (Vec2::from_heading(heading), self.ego.states[self.until].position());
            let way = track.states[0].position() - met;
            (ahead_m, left_m) = (along.dot(way) - 0.5 * self.ego.length_m, along.cross(way));
        }
        let facing = math::wrap_angle(track.states[0].heading - heading).abs();
        let stands = self.stays(track) && (across == (0.8..2.4).contains(&facing));
        stands && (0.0..PARKED_M).contains(&ahead_m) && left_m.abs() < LANE_M
    }

    /// Whether somebody stands in the next lane on the told side where the ego is touched.
    fn stands_beside(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let (ahead_m, left_m) = self.beside(track, self.until);
        let side = extra.side.is_none_or(|side| side.is_at(left_m));
        if extra.between {
            return self.stays(track) && side && self.is_passed_between(track);
        }
        let next = (0.5 * LANE_M..1.8 * LANE_M).contains(&left_m.abs());
        self.stays(track) && side && next && ahead_m.abs() < BESIDE_M + 0.5 * track.length_m
    }

    /// Whether somebody is abreast of the ego where that is touched, and the partner between the two, or about to come there.
    fn is_passed_between(&self, track: &ActorTrack) -> bool {
        let Some(partner) = self.rollout.actors.iter().find(|track| track.id == "cp") else { return false };
        let ((at_m, left_m), (by_m, by_left_m)) = (self.beside(track, self.until), self.beside(partner, self.until));
        let half_m = 0.5 * (self.ego.length_m + track.length_m);
        let abreast =
            (at_m + 0.5 * self.ego.length_m).abs() < half_m - OVERLAPS_M && left_m.abs() < BESIDE_LANES * LANE_M;
        let comes = (by_m - at_m).abs() < 0.5 * (partner.length_m + track.length_m) + COMES_M;
        abreast && comes && by_left_m * left_m > 0.0 && by_left_m.abs() < left_m.abs()
    }

    /// Whether somebody is in the next lane on the told side where the ego is touched, and has come along beside it.
    fn drives_beside(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let side = |left_m: f64| extra.side.is_none_or(|side| side.is_at(left_m));
        let next = |step: usize| {
            let (ahead_m, left_m) = self.beside(track, step);
            let aside = (0.5 * LANE_M..1.8 * LANE_M).contains(&left_m.abs());
            side(left_m) && aside && ahead_m.abs() < BESIDE_M + 0.5 * track.length_m
        };
        !self.stays(track) && next(0) && next(self.until)
    }

    /// Whether somebody goes backwards into the ego's lane, from the told side, and is ahead of it there.
    fn backs_out(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let (ahead_m, left_m) = self.beside(track, self.until);
        let side = extra.side.is_none_or(|side| side.is_at(self.beside(track, 0).1));
        let backs = (0..=self.until).any(|step| track.at(step).speed() < -STANDS_MPS);
        let comes = left_m.abs() < LANE_M + 0.5 * track.length_m && left_m.abs() + 1.0 < self.beside(track, 0).1.abs();
        backs && side && comes && (0.0..AHEAD_M + self.stopping_m(self.until) + PARKED_M).contains(&ahead_m)
    }

    /// Whether the partner goes round somebody who stands in the line on which it came, or is slower there.
    fn partner_passes(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let Some(partner) = self.rollout.actors.iter().find(|track| track.id == "cp") else { return false };
        let came = partner.states[0].pose();
        let along = Vec2::from_heading(came.heading);
        let aside = |of: Vec2| along.cross(of - came.position);
        let met = partner.at(self.until).position();
        let at = track.states[if extra.slow { track.within(self.until) } else { 0 }].position();
        let beside = (0..=self.until).any(|step| (aside(partner.states[step].position()) - aside(at)).abs() > 0.8);
        let in_line = aside(at).abs() < 0.5 * LANE_M && beside;
        let by = aside(at).abs() < 1.2 * LANE_M && along.dot(met - at) > 0.0;
        let slower = Self::mps(track, self.until) + SLOWED_MPS < Self::mps(partner, self.until);
        let pace = if extra.slow { !self.stays(track) && slower } else { self.stays(track) };
        pace && (in_line || by) && (at - met).length() < PARKED_M
    }

    /// Whether somebody stands all the time, and between the ego and the partner before they touch.
    fn hides(&self, track: &ActorTrack) -> bool {
        let Some(partner) = self.rollout.actors.iter().find(|track| track.id == "cp") else { return false };
        let outline = OrientedBox::new(track.states[0].pose(), track.length_m, track.width_m);
        let hidden = |step: usize| {
            let at = self.ego.states[step].position();
            let way = partner.at(step).position() - at;
            let middle = Pose { position: at + way * 0.5, heading: math::atan2(way.y, way.x) };
            outline.overlaps(&OrientedBox::new(middle, way.length(), SIGHT_M))
        };
        self.stays(track) && (0..self.until).any(hidden)
    }

    /// Whether somebody was beside the ego's lane, on the told side, and is in it ahead of the ego at the contact.
    fn merges(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let (ahead_m, left_m) = self.beside(track, self.until);
        let was = |step: usize| self.beside(track, step).1;
        let side = extra.side.is_none_or(|side| side.is_at(was(0)));
        let beside = (0..self.until).any(|step| was(step).abs() > 0.7 * LANE_M);
        // In the lane that the ego may have left to make room.
        let lane_m = if self.told.sv_aside().is_some() { 1.3 } else { 0.4 } * LANE_M;
        (0.0..CROSSING_M).contains(&ahead_m) && left_m.abs() < lane_m && beside && side
    }

    /// Whether the ego goes round somebody who stands: it came along its line, and leaves that to the other side; or it goes by.
    fn is_passed(&self, extra: &Extra, track: &ActorTrack) -> bool {
        let came = self.ego.states[0].pose();
        let ahead = Vec2::from_heading(came.heading);
        let way = track.states[0].position() - came.position;
        let moved = self.ego.states[self.until].position() - came.position;
        let (left_m, ego_left_m) = (ahead.cross(way), ahead.cross(moved));
        let in_line = left_m.abs() < 0.5 * LANE_M && (left_m - ego_left_m).abs() > 0.8;
        let by = left_m.abs() >= 0.5 * LANE_M && left_m.abs() < 1.5 * LANE_M;
        let side = extra.side.is_none_or(|side| side.is_at(left_m - ego_left_m));
        let (ahead_m, _) = self.beside(track, self.until);
        let near = ahead_m.abs() < CROSSING_M && (ahead_m < 0.0 || !extra.behind);
        self.stays(track) && ahead.dot(way) > 0.0 && near && (in_line || by) && side
    }
}
