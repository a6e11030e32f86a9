//! Those in the ego's lane: who stands ahead, drives ahead and slows, comes into it, or lies there.

use crate::others::scene::{BESIDE_M, BRAKES_MPS2, MET_BEFORE_S, ROOM_BESIDE_M, ROUND_AHEAD_M, Scene};
use crate::others::stand::{stands, stood_behind};
use crate::pace::plain::{first_time, next, when};
use crate::told::astride::INSIDE_M;
use crate::told::doing::Doing;
use crate::told::others::{Extra, Role};
use crate::told::queue::{leaves_lane, waits_ahead};
use crate::told::side::{Turning, size_of};
use crate::usual::{LANE_M, LEAD_GAP_M, ROOM_M};
use recrash_model::account::{ContactState, ControlDevice, LaneLine, LaneWord, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::scenario::{ActorPlan, Deed, Leg, Place, Trigger};

/// From the front of an ego that leaves its lane behind somebody to that one, where it is touched. [m]
const CLEAR_M: f64 = 1.0;

/// Who drives ahead of the ego is so far ahead of it, and slows so much earlier. [m, s]
const HEADWAY_M: f64 = 7.0;
const EARLIER_S: f64 = 0.4;

/// Who stood ahead sets off so long before the one behind it does, to this speed. [s, m/s, m/s^2]
const SETS_OFF_BEFORE_S: f64 = 0.8;
const GOES_MPS: f64 = 8.0;
const GOES_MPS2: f64 = 1.5;

/// Who changes into the ego's lane is no slower, and takes so long. [m/s, s]
const MERGES_MPS: f64 = 5.0;
const MERGES_S: f64 = 3.5;

/// Who is on its way into a space at the kerb is so far out of the lane, with its rear to the kerb. [m, rad]
const HALF_PARKED_M: f64 = 1.5;
const HALF_PARKED_RAD: f64 = 0.4;

/// Who backs out of a space does so over this way, to where its rear is so far from the middle of the ego's lane. [m, m/s, m/s^2]
const BACKS_OUT_M: f64 = 4.0;
const BACKS_TO_M: f64 = -0.2;
const BACKS_MPS: f64 = 1.5;
const BACKS_MPS2: f64 = 1.5;

/// An ego that comes back into its lane has begun to when it has left its line by so much. [m]
const RETURNS_M: f64 = 0.1;

impl Scene<'_> {
    pub(super) fn lead(&self, extra: &Extra, length_m: f64) -> Option<ActorPlan> {
        let stand = stood_behind(extra, self.ego, self.until);
        let (step, room_m) = stand.map_or_else(|| self.stops(), |(from, _)| (from, 0.0));
        let (s_m, _) = self.at(step);
        let at_kerb = self.told.is_at_kerb() && self.ground.stands_m != 0.0;
        let behind_m = self.queue_m(s_m, at_kerb).unwrap_or_else(|| self.front_m() + room_m);
        let ahead_m = behind_m + LEAD_GAP_M + 0.5 * length_m;
        let pose = match self.told.sv_aside() {
            // In the lane, or in that into which the ego changes.
            Some(aside) => {
                let changes = aside.to_t_m.abs() >= LANE_M && !leaves_lane(self.told) && !extra.first;
                let lane_m = if changes { aside.to_t_m } else { 0.0 };
                // Clear of an ego that is on its way out.
                let met_m = self.at(self.until).0 + self.front_m() + 0.5 * length_m + CLEAR_M;
                let clear_m = if stand.is_some() && leaves_lane(self.told) { met_m } else { 0.0 };
                self.ground.pose((s_m + ahead_m + ROOM_M).max(clear_m), lane_m)
            }
            // In the lane beside one at the kerb.
            None if at_kerb => self.ground.pose(s_m + ahead_m, 0.0),
            None => self.ahead(step, ahead_m),
        };
        let pose = if extra.parks { self.half_parked(pose) } else { self.over_line(extra, pose) };
        // Before the light.
        let controlled = self.told.sv.control.is_some_and(|said| said.device == ControlDevice::Signal);
        let line_m = self.ground.first_m();
        let beyond = s_m + ahead_m + 0.5 * length_m > line_m;
        if controlled && self.ground.junction && s_m + self.front_m() < line_m && beyond {
            return None;
        }
        let along = Vec2::from_heading(pose.heading);
        let at = |ahead_m: f64| {
            let point = pose.position + along * ahead_m;
            Place::at(point.x, point.y, pose.heading.to_degrees())
        };
        let course = vec![Leg::Curve { to: at(90.0), reverse: false }];
        if extra.goes {
            let goes_s = (self.goes_s(step, stand) * 10.0).round() / 10.0;
            let acts = vec![when(goes_s, Deed::Speed { to_mps: GOES_MPS, rate_mps2: GOES_MPS2 })];
            return Some(ActorPlan { course, acts, ..ActorPlan::standing(at(0.0)) });
        }
        // Behind whom the ego moves up, that one has moved up before.
        let again = self.moves_up_yet(stand).filter(|_| extra.again);
        let before = || self.moved_up().filter(|_| !extra.parked && extra.role != Role::Thing);
        let Some((up_s, up_m)) = again.or_else(before) else { return Some(ActorPlan::standing(at(0.0))) };
        let speed_mps = 0.9 * (GOES_MPS2 * up_m).sqrt();
        let stop = Deed::Stop { rate_mps2: GOES_MPS2, at_m: Some(up_m) };
        let acts = vec![when(up_s, Deed::Speed { to_mps: speed_mps, rate_mps2: GOES_MPS2 }), next(stop)];
        let begins_m = if again.is_some() { 0.0 } else { -up_m };
        Some(ActorPlan { course, acts, ..ActorPlan::standing(at(begins_m)) })
    }

    /// Over the line of the road over which it is told to stand.
    fn over_line(&self, extra: &Extra, pose: Pose) -> Pose {
        let (s_m, _) = self.ground.beside(pose.position);
        match extra.astride.map(|over| over.line) {
            Some(LaneLine::Edge) => self.ground.pose(s_m, self.ground.lane_edges_m[1] - INSIDE_M),
            _ => pose,
        }
    }

    /// Half out of the lane, with its rear to the kerb on the right.
    fn half_parked(&self, pose: Pose) -> Pose {
        let right = Vec2::from_heading(pose.heading).left() * -HALF_PARKED_M;
        Pose { position: pose.position + right, heading: pose.heading + HALF_PARKED_RAD }
    }

    /// From the ego to the front of a partner that stands in the queue ahead of it, or beside it at the kerb. [m]
    fn queue_m(&self, s_m: f64, at_kerb: bool) -> Option<f64> {
        let beside = at_kerb && matches!(self.told.origin, Origin::Beside { .. });
        let track = self.partner.filter(|_| waits_ahead(self.told) || beside)?;
        let farthest = track.states[..=self.until].iter().map(|state| self.ground.beside(state.position()).0);
        Some(farthest.fold(s_m, f64::max) - s_m + 0.5 * track.length_m)
    }

    /// When who stands ahead of the ego drives on: before the ego does, else before the partner. [s]
    fn goes_s(&self, step: usize, stand: Option<(usize, usize)>) -> f64 {
        let ego = stand.map(|(_, to)| to).filter(|to| *to + 1 < self.until);
        let follows = ego.or_else(|| {
            let (from, to) = self.partner.and_then(|track| stands(track, self.until).last().copied())?;
            (to + 1 < self.until && (from > 0 || to > step)).then_some(to)
        });
        let follows_s = 0.1 * follows.unwrap_or(self.until.saturating_sub(12)) as f64;
        (follows_s - SETS_OFF_BEFORE_S).max(0.1 * step as f64 + 0.5)
    }

    /// When, and how far, the ego moved up before it stood for good. [s, m]
    fn moved_up(&self) -> Option<(f64, f64)> {
        let list = stands(self.ego, self.until);
        let [.., (_, before), (last, to)] = list.as_slice() else { return None };
        let up_m = self.at(*last).0 - self.at(*before).0;
        let up_s = (0.1 * *before as f64 - SETS_OFF_BEFORE_S).max(0.1);
        (to + 1 >= self.until && (1.0..20.0).contains(&up_m)).then_some(((up_s * 10.0).round() / 10.0, up_m))
    }

    /// When, and how far, who stands ahead moves up before an ego that sets off and is about to stand again. [s, m]
    fn moves_up_yet(&self, stand: Option<(usize, usize)>) -> Option<(f64, f64)> {
        let (_, to) = stand.filter(|(_, to)| to + 1 < self.until)?;
        let stops_m = 0.5 * self.mps(self.until) * self.mps(self.until) / BRAKES_MPS2;
        let up_s = (0.1 * to as f64 - SETS_OFF_BEFORE_S).max(0.1);
        let up_m = self.at(self.until).0 - self.at(to).0 + stops_m;
        (1.0..20.0).contains(&up_m).then_some(((up_s * 10.0).round() / 10.0, up_m))
    }

    /// It drives as the ego does, ahead of it and a little earlier.
    pub(super) fn slower(&self, length_m: f64) -> Option<ActorPlan> {
        let straight = self.told.sv.turning == Turning::No && self.told.sv_aside().is_none();
        let drives = self.recorded.speed_mps > 0.0 && !self.recorded.acts.is_empty();
        if !straight || !drives || self.told.sv.state == ContactState::Reversing {
            return None;
        }
        let (s_m, t_m) = self.at(0);
        let ahead_m = self.front_m() + HEADWAY_M + EARLIER_S * self.recorded.speed_mps + 0.5 * length_m;
        let place = |s_m: f64| {
            let pose = self.ground.pose(s_m, t_m);
            Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
        };
        let mut acts = self.recorded.acts.clone();
        for act in &mut acts {
            if let Some(Trigger::TimeS(time_s)) = &mut act.when {
                *time_s = (*time_s - EARLIER_S).max(0.1);
            }
        }
        (first_time(&acts) > 0.0).then(|| ActorPlan {
            speed_mps: self.recorded.speed_mps,
            course: vec![Leg::Curve { to: place(self.at(self.until).0 + ahead_m + 60.0), reverse: false }],
            acts,
            ..ActorPlan::standing(place(s_m + ahead_m))
        })
    }

    /// Who changes into the ego's lane ahead of it, out of the lane beside it, and is there at the contact.
    pub(super) fn merger(&self, extra: &Extra, length_m: f64) -> ActorPlan {
        let (s_m, t_m) = self.at(self.until);
        // In the lane that the ego leaves to make room.
        let t_m = self.told.sv_aside().map_or(t_m, |aside| aside.from_t_m);
        let speed_mps = self.mps(self.until).max(MERGES_MPS);
        let slows = self.told.sv.state.stands() || self.told.sv.acts.iter().any(Doing::slows);
        let room_m = if slows { self.stops().1 } else { 0.0 };
        let met_m = s_m + self.front_m() + room_m + 0.5 * length_m + ROUND_AHEAD_M;
        let leftmost = matches!(self.told.sv.lane, Some(LaneWord::Left | LaneWord::LeftTurn));
        let usual = if leftmost { LeftRight::Right } else { LeftRight::Left };
        let from_m = if extra.side.unwrap_or(usual) == LeftRight::Right { LANE_M } else { -LANE_M };
        let over_m = speed_mps * MERGES_S;
        let place = |s_m: f64| {
            let pose = self.ground.pose(s_m, t_m + from_m);
            Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
        };
        let until_s = self.told.contact_s;
        let shift = Deed::Shift { to_t_m: -from_m, over_m };
        ActorPlan {
            speed_mps,
            course: vec![Leg::Curve { to: place(met_m + 60.0), reverse: false }],
            acts: vec![when(((until_s - MERGES_S - MET_BEFORE_S) * 10.0).round() / 10.0, shift)],
            ..ActorPlan::standing(place(met_m - speed_mps * until_s))
        }
    }

    /// Who backs out of a space beside the road into the ego's lane, ahead of where that is at the contact.
    pub(super) fn backer(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> ActorPlan {
        let right = if extra.side == Some(LeftRight::Left) { -1.0 } else { 1.0 };
        let (step, room_m) = self.stops();
        let s_m = self.at(step).0.max(self.at(self.until).0) + self.front_m() + room_m + LEAD_GAP_M + 0.5 * width_m;
        let way = self.ground.pose(s_m, 0.0);
        let out = Vec2::from_heading(way.heading).left() * -right;
        let place = |t_m: f64| {
            let point = way.position + out * (t_m + 0.5 * length_m);
            Place::at(point.x, point.y, way.heading.to_degrees() - 90.0 * right)
        };
        let over_s = BACKS_OUT_M / BACKS_MPS + 1.0;
        let begins_s = (0.1 * step as f64 - over_s).max(0.5);
        let acts = vec![
            when((begins_s * 10.0).round() / 10.0, Deed::Speed { to_mps: BACKS_MPS, rate_mps2: BACKS_MPS2 }),
            next(Deed::Stop { rate_mps2: BACKS_MPS2, at_m: Some(BACKS_OUT_M) }),
        ];
        ActorPlan {
            course: vec![Leg::Curve { to: place(BACKS_TO_M - 1.0), reverse: true }],
            acts,
            ..ActorPlan::standing(place(BACKS_TO_M + BACKS_OUT_M))
        }
    }

    /// Whom the ego goes round: where it has left its line, ahead of it there, or beside it.
    pub(super) fn obstacle(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> ActorPlan {
        let line_m = self.told.sv_aside().map(|aside| aside.from_t_m);
        // In the lane into which the ego comes back, before that.
        if let Some(aside) = self.told.sv_aside().filter(|_| extra.behind) {
            // It may have begun in that lane itself.
            let outside = |step: &usize| (self.at(*step).1 - aside.from_t_m).abs() <= RETURNS_M;
            let from = (0..self.until).rev().find(outside).unwrap_or(self.until);
            let pose =
                self.ground.pose(self.at(from).0 - self.front_m() - 0.5 * length_m, aside.to_t_m.signum() * LANE_M);
            return ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees()));
        }
        // An ego that is on its way past it within its lane has it abreast.
        let beside = line_m.filter(|_| !self.told.rounds_other());
        let came_m = beside.unwrap_or_else(|| self.at(self.until).1);
        let line_m = beside.filter(|line_m| !extra.passed || (self.at(self.until).1 - line_m).abs() > BESIDE_M);
        let (s_m, t_m) = match line_m {
            Some(line_m) => {
                let left = (0..self.until).find(|step| (self.at(*step).1 - line_m).abs() > BESIDE_M);
                let ahead_m = self.front_m() + 0.5 * length_m;
                let room_m = if left.is_some() { ROOM_M } else { ROUND_AHEAD_M };
                (self.at(left.unwrap_or(self.until)).0 + ahead_m + room_m, line_m)
            }
            None => {
                let sign = if extra.side == Some(LeftRight::Left) { -1.0 } else { 1.0 };
                let beside_m = 0.5 * (size_of(&self.told.sv).1 + width_m) + ROOM_BESIDE_M;
                let t_m = came_m + sign * beside_m;
                (self.hides_m(t_m, length_m).unwrap_or_else(|| self.at(self.until).0), t_m)
            }
        };
        let pose = self.ground.pose(s_m, t_m);
        let turned_deg = if extra.opposite { 180.0 } else { 0.0 };
        ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees() + turned_deg))
    }
}
