//! Those who cross the ego's way, block it, or come towards it.

use crate::ground::pieces::corner_m;
use crate::others::scene::{MET_BEFORE_S, Scene};
use crate::pace::plain::when;
use crate::told::others::{Extra, Role};
use crate::told::side::size_of;
use crate::usual::{LEAD_GAP_M, ROOM_M, RUNS_MPS, beyond_m};
use recrash_model::account::LeftRight;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::{ActorPlan, Deed, Leg, Place, StripKind};

/// From the ego's front to who crosses, on foot or not. [m]
pub(super) const WALKER_GAP_M: f64 = 3.0;
const CROSSER_GAP_M: f64 = 2.0;

/// The same of an ego that has turned by more than this: less of it is in the way. [m, rad]
const TURNED_GAP_M: f64 = 1.5;
const TURNED_AWAY_RAD: f64 = 0.35;

/// From the ego's front to who is on foot between it and one that stands ahead. [m]
const WALKER_BETWEEN_M: f64 = 0.5 * LEAD_GAP_M;

/// From the stop line to the lane of who crosses from the left, and from the right. [m]
const CROSSING_LANES_M: [f64; 2] = [11.0, 15.0];

/// Who rides crosses so. [m/s]
pub(super) const RIDES_MPS: f64 = 3.5;
const CROSSES_MPS: f64 = 7.0;

/// An animal that stays before an ego which stands comes to a stand so, and so far beyond the middle of its way: no farther than this
/// from that at the contact. [m/s^2, m]
const RUNS_STOPS_MPS2: f64 = 3.0;
const STAYS_BEYOND_M: f64 = 1.5;
const CLOSE_M: f64 = 4.0;

/// Who stays close to the ego stands so far ahead of its front, and beside its flank. [m]
const STAYS_AHEAD_M: f64 = 0.5;
const STAYS_BESIDE_M: f64 = 0.8;

impl Scene<'_> {
    /// When an animal runs across: the ego brakes for it, and comes to a stop then. [s]
    fn runs_s(&self) -> f64 {
        let came = self.stand.map(|(from, _)| 0.1 * from as f64 - MET_BEFORE_S).filter(|at_s| *at_s > 1.0);
        came.unwrap_or_else(|| self.clears_s())
    }

    /// Somebody who crosses the ego's way, from the kerb on the right where nobody tells from which.
    pub(super) fn crosses(&self, extra: &Extra, speed_mps: f64, at_s: f64) -> ActorPlan {
        let (step, room_m) = self.stops();
        let lead = self.told.extras.iter().any(|extra| extra.role == Role::Lead);
        let gap_m = if lead { WALKER_BETWEEN_M } else { WALKER_GAP_M } + room_m;
        let met = self.ahead(step, self.front_m() + gap_m);
        let left = Vec2::from_heading(met.heading).left();
        let way = if extra.side == Some(LeftRight::Left) { left * -1.0 } else { left };
        straight_plan(met.position - way * (speed_mps * at_s), way, (speed_mps, self.told.contact_s))
    }

    /// An animal that runs across, as the ego comes to a stop; before an ego that stands for longer it stays there.
    pub(super) fn runs(&self, extra: &Extra) -> ActorPlan {
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
    pub(super) fn stays_close(&self, extra: &Extra) -> ActorPlan {
        let (step, room_m) = self.stops();
        let met = self.ahead(step, self.front_m() + STAYS_AHEAD_M + room_m);
        let right = Vec2::from_heading(met.heading).left() * -1.0;
        let aside = if extra.side == Some(LeftRight::Left) { right * -1.0 } else { right };
        let at = met.position + aside * (0.5 * size_of(&self.told.sv).1 + STAYS_BESIDE_M);
        ActorPlan::standing(Place::at(at.x, at.y, met.heading.to_degrees() + 90.0))
    }

    /// A vehicle on the crossing road, ahead of the ego.
    pub(super) fn crosser(&self, extra: &Extra) -> Option<ActorPlan> {
        let (step, _) = self.stops();
        let lane_m = CROSSING_LANES_M[usize::from(extra.side == Some(LeftRight::Right))];
        let line = self.ground.sv_pose(self.ground.first_m());
        let ahead = Vec2::from_heading(line.heading);
        // An ego that waits in its turn has turned away from the lane.
        let ego = self.ego.states[step].pose();
        let front = ego.position + Vec2::from_heading(ego.heading) * self.front_m();
        let room_m = lane_m - ahead.dot(front - line.position);
        let turned = math::wrap_angle(ego.heading - line.heading).abs() > TURNED_AWAY_RAD;
        if !self.ground.junction || room_m < if turned { TURNED_GAP_M } else { CROSSER_GAP_M } {
            return None;
        }
        let way = if extra.side == Some(LeftRight::Right) { ahead.left() } else { ahead.left() * -1.0 };
        let from = line.position + ahead * lane_m - way * (CROSSES_MPS * self.clears_s());
        Some(straight_plan(from, way, (CROSSES_MPS, self.told.contact_s)))
    }

    /// A vehicle that stands across the junction: on the crossing road's lane that the ego comes to first, else where the ego that has come
    /// into the junction leaves room.
    pub(super) fn blocker(&self, length_m: f64) -> Option<ActorPlan> {
        let (step, _) = self.stops();
        let [first_m, _] = CROSSING_LANES_M;
        let line_m = self.ground.first_m();
        let lane_m = first_m.max(self.at(step).0 + self.front_m() - line_m + WALKER_GAP_M);
        let behind_m = 2.0 * corner_m(self.ground.lanes) - WALKER_GAP_M;
        if !self.ground.junction || lane_m > behind_m {
            return None;
        }
        let line = self.ground.sv_pose(line_m);
        let ahead = Vec2::from_heading(line.heading);
        let at = line.position + ahead * lane_m + ahead.left() * (0.2 * length_m);
        Some(ActorPlan::standing(Place::at(at.x, at.y, line.heading.to_degrees() - 90.0)))
    }

    /// A vehicle that stands right behind the junction in the ego's lane.
    pub(super) fn beyond(&self, length_m: f64) -> Option<ActorPlan> {
        let line = self.ground.sv_pose(self.ground.first_m());
        let ahead = Vec2::from_heading(line.heading);
        let way_m = 2.0 * corner_m(self.ground.lanes) + ROOM_M + 0.5 * length_m;
        let at = line.position + ahead * way_m;
        let before = self.at(self.stops().0).0 < self.ground.first_m();
        (self.ground.junction && before).then(|| ActorPlan::standing(Place::at(at.x, at.y, line.heading.to_degrees())))
    }

    /// A vehicle that comes towards the ego in its own lane, and passes it.
    pub(super) fn oncoming(&self) -> Option<ActorPlan> {
        let two_way =
            self.ground.map.roads[self.ground.own_road()].left.iter().any(|strip| strip.kind == StripKind::Driving);
        let (step, _) = self.stops();
        let road = self.ground.pose(self.at(step).0.min(self.ground.first_m()), -self.ground.opposing_m);
        let way = Vec2::from_heading(road.heading) * -1.0;
        let from = road.position - way * (CROSSES_MPS * self.clears_s());
        two_way.then(|| straight_plan(from, way, (CROSSES_MPS, self.told.contact_s)))
    }
}

/// Straight on at a speed.
fn straight_plan(start: Vec2, way: Vec2, (speed_mps, contact_s): (f64, f64)) -> ActorPlan {
    let degrees = math::atan2(way.y, way.x).to_degrees();
    let to = start + way * (speed_mps * contact_s + beyond_m(speed_mps));
    ActorPlan {
        speed_mps,
        course: vec![Leg::Curve { to: Place::at(to.x, to.y, degrees), reverse: false }],
        ..ActorPlan::standing(Place::at(start.x, start.y, degrees))
    }
}
