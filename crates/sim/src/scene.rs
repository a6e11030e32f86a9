//! The frozen world of one decision: what every actor sees, and nobody changes while others still decide.

use crate::lanes::{LaneIndex, LaneTable, Navigator, Progress};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_roads::RoadId;

/// A road user as others see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    pub(crate) pose: Pose,
    /// Unit vector of its heading.
    pub(crate) forward: Vec2,
    pub(crate) velocity: Vec2,
    /// [m/s]
    pub(crate) speed: f64,
    /// Where it is along its route, and on which lane.
    pub(crate) place: Navigator,
    /// Where it is along the path it was placed on.
    pub(crate) progress: Progress,
    pub(crate) half_length: f64,
    pub(crate) half_width: f64,
    /// Still in the world: background traffic that drove off the map is not.
    pub(crate) present: bool,
    /// Along its plan's course, where it moves by one; `None` of the ego, whose place is that on its route. [m]
    pub(crate) plan_s_m: Option<f64>,
}

impl Seen {
    /// Its box.
    pub(crate) fn outline(&self) -> OrientedBox {
        let (half_length, half_width) = (self.half_length, self.half_width);
        OrientedBox { centre: self.pose.position, axis: self.forward, half_length, half_width }
    }
}

/// An obstacle as others see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenObstacle {
    pub(crate) outline: OrientedBox,
    /// The lane it is registered to.
    pub(crate) lane: LaneIndex,
    /// Along that lane. [m]
    pub(crate) s: f64,
}

/// The frozen world.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    /// Number of the step, from 0.
    pub(crate) step: u32,
    pub(crate) lanes: &'a LaneTable,
    /// All actors' routes, one after the other.
    pub(crate) routes: &'a [RoadId],
    /// The lane of each road of `routes` that the actor was placed on.
    pub(crate) route_lanes: &'a [LaneIndex],
    /// Where each of these lanes begins along the actor's path. [m]
    pub(crate) route_starts: &'a [f64],
    pub(crate) actors: &'a [Seen],
    pub(crate) obstacles: &'a [SeenObstacle],
    /// How far to the right of its lane's centre the ego's task wants it. [m]
    pub(crate) ego_beside_m: f64,
}

impl Scene<'_> {
    /// The lanes of the road an actor is routed along, leftmost first.
    #[inline]
    pub(crate) fn lanes_of(&self, actor: usize) -> &[LaneIndex] {
        self.lanes.of_road(self.actors[actor].place.road(self.routes))
    }

    /// The lanes of the road after that, leftmost first; `None` on the last.
    pub(crate) fn lanes_after(&self, actor: usize) -> Option<&[LaneIndex]> {
        let next = self.actors[actor].place.next_other_road(self.routes)?;
        Some(self.lanes.of_road(next))
    }

    /// The lane of an actor's path that it is beside.
    #[inline]
    pub(crate) fn path_lane(&self, actor: usize) -> LaneIndex {
        self.route_lanes[self.actors[actor].progress.at as usize]
    }

    /// The lane an actor counts as on to a driver with MetaDrive's eyes, and its place along it; who moves by a plan may be
    /// beside all. [m]
    pub(crate) fn registered_lane(&self, actor: usize) -> Option<(LaneIndex, f64)> {
        let seen = &self.actors[actor];
        if seen.plan_s_m.is_none() {
            return Some((seen.place.lane, seen.place.s));
        }
        let ego_way = &self.route_lanes[..self.actors[0].progress.end as usize];
        self.lanes.lane_of_plan(ego_way, seen.pose.position, seen.pose.heading)
    }

    /// How far an actor has come along its path. [m]
    #[inline]
    pub(crate) fn path_s(&self, actor: usize) -> f64 {
        if let Some(s_m) = self.actors[actor].plan_s_m {
            return s_m;
        }
        let progress = &self.actors[actor].progress;
        self.route_starts[progress.at as usize] + progress.s
    }

    /// Positions in the world's list of the lane an actor is beside and of all that follow on its path.
    #[inline]
    pub(crate) fn rest_of_path(&self, actor: usize) -> std::ops::Range<usize> {
        let progress = &self.actors[actor].progress;
        progress.at as usize..progress.end as usize
    }

    /// Heading and curvature (positive to the left) of an actor's path at a place not behind the lane it is beside;
    /// behind the path's end it goes straight on. [rad, 1/m]
    pub(crate) fn way_at(&self, actor: usize, s_m: f64) -> (f64, f64) {
        let path = self.rest_of_path(actor);
        let after = path.clone().skip(1).take_while(|&position| self.route_starts[position] <= s_m).count();
        let position = path.start + after;
        let lane = self.lanes.lane(self.route_lanes[position]);
        let s = s_m - self.route_starts[position];
        if s > lane.length_m { (lane.heading(lane.length_m), 0.0) } else { (lane.heading(s), lane.curvature()) }
    }

    /// Where a point is along an actor's path: distance from its centre, offset to the right, and the way's direction
    /// there; `None` behind it, off its path's length, and where the path's next lane begins further away than `sight_m`.
    pub(crate) fn ahead(&self, actor: usize, point: Vec2, sight_m: f64) -> Option<(f64, f64, Vec2)> {
        let here = self.path_s(actor);
        let path = self.rest_of_path(actor);
        for position in path.clone() {
            let start = self.route_starts[position];
            if start - here > sight_m {
                return None;
            }
            let lane = self.lanes.lane(self.route_lanes[position]);
            let (s, t) = lane.local(point);
            let last = position + 1 == path.end;
            if s < 0.0 && position == path.start {
                return None;
            }
            if s >= 0.0 && (s <= lane.length_m || last) && t.abs() < lane.reach() {
                return Some((start + s - here, t, Vec2::from_heading(lane.heading(s))));
            }
        }
        None
    }
}
