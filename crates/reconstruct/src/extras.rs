//! Where others than the two stand and drive, seen from how the ego and the partner come to the contact.

use crate::came::straight_plan;
use crate::ground::{Ground, LANE_M, corner_m};
use crate::others::{Extra, Role, leaves_lane, waits_ahead};
use crate::pace::{first_time, next, when};
use crate::side::{Turning, size_of as size_of_kind};
use crate::speeds::WALKS_MPS;
use crate::told::Told;
use crate::touch::{Staging, size_of};
use recrash_model::account::{ContactState, ControlDevice, LaneWord, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorTrack, Rollout};
use recrash_model::scenario::{Actor, ActorPlan, Deed, Leg, Place, Strip, StripKind, Trigger};
use recrash_model::vehicle::VehicleSpec;

/// From the ego's front to who stands ahead, and to who crosses on foot, also between the two. [m]
pub(crate) const LEAD_GAP_M: f64 = 2.5;
const WALKER_GAP_M: f64 = 3.0;
const CROSSER_GAP_M: f64 = 2.0;
const WALKER_BETWEEN_M: f64 = 0.5 * LEAD_GAP_M;

/// An ego that slows for somebody could stop before it, braking so, and has this much room besides. [m/s^2, m]
const BRAKES_MPS2: f64 = 2.5;
pub(crate) const ROOM_M: f64 = 2.0;

/// From the front of an ego that leaves its lane behind somebody to that one, where it is touched. [m]
const CLEAR_M: f64 = 1.0;

/// Who drives ahead of the ego is so far ahead of it, and slows so much earlier. [m, s]
const HEADWAY_M: f64 = 7.0;
const EARLIER_S: f64 = 0.4;

/// Who stood ahead sets off so long before the one behind it does, to this speed. [s, m/s, m/s^2]
const SETS_OFF_BEFORE_S: f64 = 0.8;
const GOES_MPS: f64 = 8.0;
const GOES_MPS2: f64 = 1.5;

/// From the stop line to the lane of who crosses from the left, and from the right. [m]
const CROSSING_LANES_M: [f64; 2] = [11.0, 15.0];

/// Who crosses, or comes by, does so before the contact: the ego stands for it, or slows; and before an ego that stood sets off, or
/// begins its turn. [s]
const CROSSES_BEFORE_S: f64 = 1.0;
const MET_BEFORE_S: f64 = 0.5;
const CLEARED_S: f64 = 0.8;

/// Who rides crosses so. [m/s]
const RIDES_MPS: f64 = 3.5;
const RUNS_MPS: f64 = 3.0;
const CROSSES_MPS: f64 = 7.0;

/// An animal that stays before an ego which stands comes to a stand so, and so far beyond the middle of its way: no farther than this
/// from that at the contact. [m/s^2, m]
const RUNS_STOPS_MPS2: f64 = 3.0;
const STAYS_BEYOND_M: f64 = 1.5;
const CLOSE_M: f64 = 4.0;

/// Who stays close to the ego stands so far ahead of its front, and beside its flank. [m]
const STAYS_AHEAD_M: f64 = 0.5;
const STAYS_BESIDE_M: f64 = 0.8;

/// From the ego's front to who is parked ahead at the kerb, and to whom it goes round. [m]
const PARKED_AHEAD_M: f64 = 9.0;
const ROUND_AHEAD_M: f64 = 6.0;

/// Who goes round somebody has left its line by so much, and leaves so much room beside it. [m]
const BESIDE_M: f64 = 2.4;
const ROOM_BESIDE_M: f64 = 0.6;

/// Who passes between two has so much room beside the one that it does not touch. [m]
const BETWEEN_M: f64 = 0.6;

/// Whom the partner passes before it comes in, it has passed so long before the contact, so far beside. [steps, m]
const PASSED_BEFORE: usize = 35;
const PASSED_BESIDE_M: f64 = 3.0;

/// Who changes into the ego's lane is no slower, and takes so long. [m/s, s]
const MERGES_MPS: f64 = 5.0;
const MERGES_S: f64 = 3.5;

/// Who backs out of a space does so over this way, to where its rear is so far from the middle of the ego's lane. [m, m/s, m/s^2]
const BACKS_OUT_M: f64 = 4.0;
const BACKS_TO_M: f64 = -0.2;
const BACKS_MPS: f64 = 1.5;
const BACKS_MPS2: f64 = 1.5;

/// An ego that comes back into its lane has begun to when it has left its line by so much. [m]
const RETURNS_M: f64 = 0.1;

/// Who drives in the next lane is so far ahead of the ego, and its course goes on so far. [m]
const ABREAST_M: f64 = 3.0;
const BEYOND_M: f64 = 160.0;

/// Who hides somebody who comes across stands so far short of it; the sine of the least angle across. [m, -]
const HIDES_M: f64 = 0.8;
const ACROSS: f64 = 0.7;

/// Slower than this is standing. [m/s]
pub(crate) const STANDS_MPS: f64 = 0.1;

/// When somebody stood until a step: first and last steps.
pub(crate) fn stands(track: &ActorTrack, until: usize) -> Vec<(usize, usize)> {
    let mut list: Vec<(usize, usize)> = Vec::new();
    for step in
        (0..=until.min(track.states.len() - 1)).filter(|step| track.states[*step].velocity().length() < STANDS_MPS)
    {
        match list.last_mut().filter(|(_, last)| last + 1 == step) {
            Some((_, last)) => *last = step,
            None => list.push((step, step)),
        }
    }
    list
}

/// When the ego stood behind somebody who stood ahead: last, or the time before that where this one drives on before it moves.
pub(crate) fn stood_behind(extra: &Extra, ego: &ActorTrack, until: usize) -> Option<(usize, usize)> {
    let list = stands(ego, until);
    let back = if extra.first && list.last().is_some_and(|(_, to)| to + 1 >= until) { 2 } else { 1 };
    list.len().checked_sub(back).or(list.len().checked_sub(1)).map(|at| list[at])
}

/// The two, as they come to the contact.
struct Scene<'a> {
    told: &'a Told,
    ground: &'a Ground,
    /// The ego's plan.
    recorded: &'a ActorPlan,
    ego: &'a ActorTrack,
    partner: Option<&'a ActorTrack>,
    /// The step of the contact.
    until: usize,
    /// When the ego stood last.
    stand: Option<(usize, usize)>,
}

/// Them, on the road; `alone`: the crash without them.
pub(crate) fn actors(told: &Told, staging: &Staging, recorded: &ActorPlan, alone: &Rollout) -> Vec<Actor> {
    let ego = alone.ego_track();
    let until = ((told.contact_s * 10.0).round() as usize).min(ego.states.len() - 1);
    let partner = alone.actors.iter().find(|track| track.id == "cp");
    let stand = stands(ego, until).last().copied();
    let scene = Scene { told, ground: &staging.ground, recorded, ego, partner, until, stand };
    told.extras.iter().flat_map(|extra| scene.actors(extra)).collect()
}

impl Scene<'_> {
    fn actors(&self, extra: &Extra) -> Vec<Actor> {
        let kind = match extra.role {
            Role::Animal => PartnerKind::Animal,
            _ => extra.kind.partner_kind().unwrap_or(PartnerKind::PassengerCar),
        };
        let size = size_of_kind(extra.kind);
        let spec = VehicleSpec::of(kind);
        let (length_m, width_m) = size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m));
        let plans = match extra.role {
            Role::Lead | Role::Thing => self.lead(extra, length_m).into_iter().collect(),
            Role::Slower => self.slower(length_m).into_iter().collect(),
            Role::Walker if extra.stays => vec![self.stays_close(extra)],
            Role::Walker if kind == PartnerKind::Pedestrian => vec![self.crosses(extra, WALKS_MPS, self.clears_s())],
            Role::Walker => vec![self.crosses(extra, RIDES_MPS, self.clears_s())],
            Role::Animal => vec![self.runs(extra)],
            Role::Crosser => self.crosser(extra).into_iter().collect(),
            Role::Oncoming => self.oncoming().into_iter().collect(),
            Role::Kerb => self.parked(extra, length_m),
            Role::Obstacle => vec![self.obstacle(extra, (length_m, width_m))],
            Role::Passed => self.passed(length_m).into_iter().collect(),
            Role::Blocker => self.blocker(length_m).into_iter().collect(),
            Role::Beyond => self.beyond(length_m).into_iter().collect(),
            Role::Merger => vec![self.merger(extra, length_m)],
            Role::Beside if extra.between => vec![self.passed_between(extra, (length_m, width_m))],
            Role::Beside => vec![self.stands_beside(extra, length_m)],
            Role::Backer => vec![self.backer(extra, (length_m, width_m))],
            Role::Abreast => vec![self.abreast(extra)],
            Role::Near => Vec::new(),
        };
        let name = |number: usize| if number == 0 { String::new() } else { format!("-{}", number + 1) };
        let actor = |(number, plan): (usize, ActorPlan)| Actor {
            id: extra.role.id().to_owned() + &name(number),
            kind,
            size,
            mass_kg: None,
            parts: Vec::new(),
            plan,
        };
        plans.into_iter().enumerate().map(actor).collect()
    }

    fn front_m(&self) -> f64 {
        0.5 * size_of(&self.told.sv).0
    }

    fn mps(&self, step: usize) -> f64 {
        self.ego.states[step].velocity().length()
    }

    /// How far along its way the ego is, and how far to the right of it. [m]
    fn at(&self, step: usize) -> (f64, f64) {
        self.ground.beside(self.ego.states[step].position())
    }

    /// A place so far ahead of where the ego is: along its way, or straight ahead where it has left that.
    fn ahead(&self, step: usize, ahead_m: f64) -> Pose {
        let (s_m, t_m) = self.at(step);
        let pose = self.ego.states[step].pose();
        let way = self.ground.pose(s_m, 0.0);
        match math::wrap_angle(way.heading - pose.heading).abs() < 0.1 {
            true => self.ground.pose(s_m + ahead_m, t_m),
            false => Pose { position: pose.position + Vec2::from_heading(pose.heading) * ahead_m, ..pose },
        }
    }

    /// Where the ego stands or slows for somebody, and how far ahead of it that one is at least. [m]
    fn stops(&self) -> (usize, f64) {
        match self.stand {
            Some((from, _)) => (from, 0.0),
            None => (self.until, ROOM_M + 0.5 * self.mps(self.until) * self.mps(self.until) / BRAKES_MPS2),
        }
    }

    /// Whether the ego stood, and drives at the contact.
    fn sets_off(&self) -> Option<usize> {
        self.stand.map(|(_, to)| to).filter(|to| *to + 1 < self.until)
    }

    /// When somebody crosses ahead, or comes by. [s]
    fn clears_s(&self) -> f64 {
        let (until_s, turning) = (0.1 * self.until as f64, self.told.sv.turning != Turning::No);
        let came = self.ego.states[0].heading;
        let turns = |step: &usize| math::wrap_angle(self.ego.states[*step].heading - came).abs() > 0.15;
        let turned = (0..self.until).find(turns).filter(|_| turning && !self.told.sv.state.stands());
        match (self.sets_off(), turned) {
            (Some(to), _) => 0.1 * to as f64 - CLEARED_S,
            (None, Some(turned)) => 0.1 * turned as f64 - MET_BEFORE_S,
            (None, None) if self.stand.is_some() => until_s - CROSSES_BEFORE_S,
            (None, None) => until_s - MET_BEFORE_S,
        }
        .max(1.0)
    }

    /// When an animal runs across: the ego brakes for it, and comes to a stop then. [s]
    fn runs_s(&self) -> f64 {
        let came = self.stand.map(|(from, _)| 0.1 * from as f64 - MET_BEFORE_S).filter(|at_s| *at_s > 1.0);
        came.unwrap_or_else(|| self.clears_s())
    }

    fn lead(&self, extra: &Extra, length_m: f64) -> Option<ActorPlan> {
        let stand = stood_behind(extra, self.ego, self.until);
        let (step, room_m) = stand.map_or_else(|| self.stops(), |(from, _)| (from, 0.0));
        let (s_m, _) = self.at(step);
        let at_kerb = self.told.is_at_kerb() && self.ground.stands_m != 0.0;
        let behind_m = self.queue_m(s_m, at_kerb).unwrap_or_else(|| self.front_m() + room_m);
        let ahead_m = behind_m + LEAD_GAP_M + 0.5 * length_m;
        let pose = match self.told.sv_aside() {
            // In the lane, or in that into which the ego changes.
            Some(aside) => {
                let changes = aside.to_t_m.abs() >= LANE_M && !leaves_lane(self.told);
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
    fn slower(&self, length_m: f64) -> Option<ActorPlan> {
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

    /// Somebody who crosses the ego's way, from the kerb on the right where nobody tells from which.
    fn crosses(&self, extra: &Extra, speed_mps: f64, at_s: f64) -> ActorPlan {
        let (step, room_m) = self.stops();
        let lead = self.told.extras.iter().any(|extra| extra.role == Role::Lead);
        let gap_m = if lead { WALKER_BETWEEN_M } else { WALKER_GAP_M } + room_m;
        let met = self.ahead(step, self.front_m() + gap_m);
        let left = Vec2::from_heading(met.heading).left();
        let way = if extra.side == Some(LeftRight::Left) { left * -1.0 } else { left };
        straight_plan(met.position - way * (speed_mps * at_s), way, (speed_mps, self.told.contact_s))
    }

    /// An animal that runs across, as the ego comes to a stop; before an ego that stands for longer it stays there.
    fn runs(&self, extra: &Extra) -> ActorPlan {
        let runs_s = self.runs_s();
        let plan = self.crosses(extra, RUNS_MPS, runs_s);
        let stays = self.sets_off().is_none() && self.stand.is_some();
        if !stays || (self.told.contact_s - runs_s) * RUNS_MPS < CLOSE_M {
            return plan;
        }
        let stop = Deed::Stop { rate_mps2: RUNS_STOPS_MPS2, at_m: Some(RUNS_MPS * runs_s + STAYS_BEYOND_M) };
        ActorPlan { acts: vec![when(0.1, stop)], ..plan }
    }

    /// Somebody on foot who stands close to the ego, beside its way: on the right where nobody tells on which side.
    fn stays_close(&self, extra: &Extra) -> ActorPlan {
        let (step, room_m) = self.stops();
        let met = self.ahead(step, self.front_m() + STAYS_AHEAD_M + room_m);
        let right = Vec2::from_heading(met.heading).left() * -1.0;
        let aside = if extra.side == Some(LeftRight::Left) { right * -1.0 } else { right };
        let at = met.position + aside * (0.5 * size_of(&self.told.sv).1 + STAYS_BESIDE_M);
        ActorPlan::standing(Place::at(at.x, at.y, met.heading.to_degrees() + 90.0))
    }

    /// A vehicle on the crossing road, ahead of the ego.
    fn crosser(&self, extra: &Extra) -> Option<ActorPlan> {
        let (step, _) = self.stops();
        let lane_m = CROSSING_LANES_M[usize::from(extra.side == Some(LeftRight::Right))];
        let line = self.ground.sv_pose(self.ground.first_m());
        let ahead = Vec2::from_heading(line.heading);
        // An ego that waits in its turn has turned away from the lane.
        let ego = self.ego.states[step].pose();
        let front = ego.position + Vec2::from_heading(ego.heading) * self.front_m();
        let room_m = lane_m - ahead.dot(front - line.position);
        if !self.ground.junction || room_m < CROSSER_GAP_M {
            return None;
        }
        let way = if extra.side == Some(LeftRight::Right) { ahead.left() } else { ahead.left() * -1.0 };
        let from = line.position + ahead * lane_m - way * (CROSSES_MPS * self.clears_s());
        Some(straight_plan(from, way, (CROSSES_MPS, self.told.contact_s)))
    }

    /// A vehicle that stands across the junction, on the crossing road's lane that the ego comes to first.
    fn blocker(&self, length_m: f64) -> Option<ActorPlan> {
        let (step, _) = self.stops();
        let [lane_m, _] = CROSSING_LANES_M;
        let room_m = self.ground.first_m() + lane_m - self.at(step).0 - self.front_m();
        if !self.ground.junction || room_m < WALKER_GAP_M {
            return None;
        }
        let line = self.ground.sv_pose(self.ground.first_m());
        let ahead = Vec2::from_heading(line.heading);
        let at = line.position + ahead * lane_m + ahead.left() * (0.2 * length_m);
        Some(ActorPlan::standing(Place::at(at.x, at.y, line.heading.to_degrees() - 90.0)))
    }

    /// A vehicle that stands right behind the junction in the ego's lane.
    fn beyond(&self, length_m: f64) -> Option<ActorPlan> {
        let line = self.ground.sv_pose(self.ground.first_m());
        let ahead = Vec2::from_heading(line.heading);
        let way_m = 2.0 * corner_m(self.ground.lanes) + ROOM_M + 0.5 * length_m;
        let at = line.position + ahead * way_m;
        let before = self.at(self.stops().0).0 < self.ground.first_m();
        (self.ground.junction && before).then(|| ActorPlan::standing(Place::at(at.x, at.y, line.heading.to_degrees())))
    }

    /// A vehicle that comes towards the ego in its own lane, and passes it.
    fn oncoming(&self) -> Option<ActorPlan> {
        let two_way = self.ground.map.roads[0].left.iter().any(|strip| strip.kind == StripKind::Driving);
        let (step, _) = self.stops();
        let road = self.ground.pose(self.at(step).0.min(self.ground.first_m()), -self.ground.opposing_m);
        let way = Vec2::from_heading(road.heading) * -1.0;
        let from = road.position - way * (CROSSES_MPS * self.clears_s());
        two_way.then(|| straight_plan(from, way, (CROSSES_MPS, self.told.contact_s)))
    }

    /// Who is parked at the kerb ahead of the ego, on both sides where nobody tells on which; in a lot in a stall.
    fn parked(&self, extra: &Extra, length_m: f64) -> Vec<ActorPlan> {
        let road = &self.ground.map.roads[0];
        // The ego goes against the line of a road that is drawn from the junction.
        let (right, left) = if self.ground.junction { (&road.left, &road.right) } else { (&road.right, &road.left) };
        let is = |strips: &[Strip], kind: StripKind| strips.iter().any(|strip| strip.kind == kind);
        let stalls = is(right, StripKind::Stalls);
        let has = |strips: &[Strip]| is(strips, StripKind::Parking) || is(strips, StripKind::Stalls);
        let ahead_m = self.at(self.until).0 + self.front_m() + PARKED_AHEAD_M + 0.5 * length_m;
        // Nobody is parked in a junction.
        let before_m = if self.ground.junction { self.ground.first_m() - PARKED_AHEAD_M } else { f64::INFINITY };
        let wider_m = 0.5 * (StripKind::Stalls.usual_width_m() - StripKind::Parking.usual_width_m());
        let [left_m, right_m] = self.ground.kerbs_m.map(|kerb_m| kerb_m + if stalls { wider_m } else { 0.0 });
        let two_way = is(left, StripKind::Driving);
        let turned_deg = if stalls { 90.0 } else { 0.0 };
        let sides = [
            (LeftRight::Right, has(right), right_m, turned_deg),
            (LeftRight::Left, has(left), -left_m, if two_way && !stalls { 180.0 } else { turned_deg }),
        ];
        let told = |side: LeftRight| extra.side.is_none_or(|told| told == side);
        let plan = |(_, _, t_m, turned_deg): (LeftRight, bool, f64, f64)| {
            let hides_m = self.hides_m(t_m, length_m).filter(|_| turned_deg != 90.0);
            let pose = self.ground.pose(hides_m.unwrap_or(ahead_m).min(before_m), t_m);
            ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees() + turned_deg))
        };
        sides.into_iter().filter(|(side, is, ..)| *is && told(*side)).map(plan).collect()
    }

    /// Whom the partner goes round: in the line on which it came, where it has left that, or ahead of where it touches the ego.
    fn passed(&self, length_m: f64) -> Option<ActorPlan> {
        let track = self.partner?;
        let (came, met) = (track.states[0].pose(), track.states[self.until.min(track.states.len() - 1)].pose());
        let along = Vec2::from_heading(came.heading);
        let left = track.states[..=self.until]
            .iter()
            .find(|state| along.cross(state.position() - came.position).abs() > BESIDE_M);
        // Beside the line, on the ego's side, where it passes before it comes in.
        let before = self.until.saturating_sub(PASSED_BEFORE).min(track.states.len() - 1);
        let over = self.told.comes_over;
        let aside_m = if over { 0.0 } else { PASSED_BESIDE_M };
        let to_ego = along.cross(self.ego.states[self.until].position() - came.position).signum();
        let on_m = match left {
            _ if !over => along.dot(track.states[before].position() - came.position),
            Some(state) => along.dot(state.position() - came.position),
            None => along.dot(met.position - came.position) + 0.5 * (track.length_m + length_m) + ROUND_AHEAD_M,
        };
        let at = came.position + along * on_m + along.left() * (to_ego * aside_m);
        (on_m > 0.0).then(|| ActorPlan::standing(Place::at(at.x, at.y, came.heading.to_degrees())))
    }

    /// Who changes into the ego's lane ahead of it, out of the lane beside it, and is there at the contact.
    fn merger(&self, extra: &Extra, length_m: f64) -> ActorPlan {
        let (s_m, t_m) = self.at(self.until);
        // In the lane that the ego leaves to make room.
        let t_m = self.told.sv_aside().map_or(t_m, |aside| aside.from_t_m);
        let speed_mps = self.mps(self.until).max(MERGES_MPS);
        let met_m = s_m + self.front_m() + self.stops().1 + 0.5 * length_m + ROUND_AHEAD_M;
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

    /// Where a partner that comes across passes a line beside the ego's way. [m]
    fn crossing_m(&self, t_m: f64) -> Option<f64> {
        let track = self.partner?;
        let at = |step: usize| self.ground.beside(track.states[step].position());
        let last = self.until.min(track.states.len() - 1);
        let across = |step: usize| {
            let (s_m, now_m) = at(step);
            let turned = math::wrap_angle(track.states[step].heading - self.ground.pose(s_m, 0.0).heading);
            (at(step - 1).1 - t_m) * (now_m - t_m) <= 0.0 && math::sin(turned).abs() > ACROSS
        };
        (1..=last).find(|step| across(*step)).map(|step| at(step).0)
    }

    /// From which side a partner comes that begins beside the ego's lane.
    fn partner_from(&self) -> Option<LeftRight> {
        let (_, t_m) = self.ground.beside(self.partner?.states[0].position());
        (t_m.abs() > LANE_M).then_some(if t_m < 0.0 { LeftRight::Left } else { LeftRight::Right })
    }

    /// Who hides a partner that comes across stands short of where that comes out. [m]
    fn hides_m(&self, t_m: f64, length_m: f64) -> Option<f64> {
        let (partner_m, wide_m) = size_of(&self.told.cp);
        let half_m = 0.5 * partner_m.min(wide_m.max(1.0));
        Some(self.crossing_m(t_m)? - half_m - HIDES_M - 0.5 * length_m)
    }

    /// Who stands in the next lane where the ego is at the contact; ahead of a partner that is there too, and short of where one
    /// comes across.
    fn stands_beside(&self, extra: &Extra, length_m: f64) -> ActorPlan {
        let usual = self.told.comes_from_side().or_else(|| self.partner_from()).unwrap_or(LeftRight::Right);
        let side = extra.side.unwrap_or(usual);
        let t_m = if side == LeftRight::Right { LANE_M } else { -LANE_M };
        let (s_m, _) = self.at(self.until);
        let there = |track: &ActorTrack| {
            let state = &track.states[self.until.min(track.states.len() - 1)];
            let (at_m, beside_m) = self.ground.beside(state.position());
            let on_side = beside_m * t_m > 0.0 && beside_m.abs() > 0.6 * LANE_M;
            on_side.then_some((at_m + 0.5 * track.length_m + ROOM_M + 0.5 * length_m).max(s_m))
        };
        let stands_m = self.hides_m(t_m, length_m).or_else(|| self.partner.and_then(there)).unwrap_or(s_m);
        let pose = self.ground.pose(stands_m, t_m);
        ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees()))
    }

    /// Who stands abreast of the ego, and leaves a partner that passes between the two the room that it takes.
    fn passed_between(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> ActorPlan {
        let usual = self.told.comes_from_side().or_else(|| self.partner_from()).unwrap_or(LeftRight::Right);
        let sign = if extra.side.unwrap_or(usual) == LeftRight::Right { 1.0 } else { -1.0 };
        let (s_m, t_m) = self.at(self.until);
        let taken_m = |track: &ActorTrack| {
            let outlines = (0..=self.until.min(track.states.len() - 1)).map(|step| track.outline(step));
            let abreast = outlines.filter(|outline| {
                let along_m = (self.ground.beside(outline.centre).0 - s_m).abs();
                along_m < 0.5 * (track.length_m + length_m) + LEAD_GAP_M
            });
            let edges = abreast.flat_map(|outline| outline.corners().map(|corner| self.ground.beside(corner).1));
            edges.map(|edge_m| sign * (edge_m - t_m)).fold(0.0, f64::max)
        };
        let room_m = self.partner.map_or(0.0, taken_m) + BETWEEN_M + 0.5 * width_m;
        let pose = self.ground.pose(s_m, t_m + sign * room_m.max(LANE_M));
        // Beside one that comes towards the ego it stands as that drives.
        let turned_deg = if self.told.origin == Origin::Opposite { 180.0 } else { 0.0 };
        ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees() + turned_deg))
    }

    /// Who drives in the next lane as the ego does, a little ahead.
    fn abreast(&self, extra: &Extra) -> ActorPlan {
        let (s_m, t_m) = self.at(0);
        let t_m = t_m + if extra.side == Some(LeftRight::Left) { -LANE_M } else { LANE_M };
        let place = |s_m: f64| {
            let pose = self.ground.pose(s_m, t_m);
            Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
        };
        ActorPlan {
            speed_mps: self.recorded.speed_mps,
            course: vec![Leg::Curve { to: place(self.at(self.until).0 + ABREAST_M + BEYOND_M), reverse: false }],
            acts: self.recorded.acts.clone(),
            ..ActorPlan::standing(place(s_m + ABREAST_M))
        }
    }

    /// Who backs out of a space beside the road into the ego's lane, ahead of where that is at the contact.
    fn backer(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> ActorPlan {
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
    fn obstacle(&self, extra: &Extra, (length_m, width_m): (f64, f64)) -> ActorPlan {
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
                let (s_m, t_m) = self.at(self.until);
                (s_m, t_m + sign * beside_m)
            }
        };
        let pose = self.ground.pose(s_m, t_m);
        ActorPlan::standing(Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees()))
    }
}
