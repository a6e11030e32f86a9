//! Lanes prepared for look-ups, and where a road user is on them.
//!
//! MetaDrive finds a vehicle's lane by a ray through the lanes' collision bodies, and prefers the lanes of the road the
//! vehicle is routed along. The bodies are a little larger than the lanes: up to a metre longer, and curves are convex
//! hulls. Which lane an object is "on" decides who sees whom (`docs/models/metadrive-idm.md`), so the bodies are
//! reproduced here.

use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::MapSpec;
use recrash_roads::graph::GroundArea;
use recrash_roads::path::SegmentShape;
use recrash_roads::{Centreline, RoadId, RoadNetwork};

/// Position of a lane in the network.
pub(crate) type LaneIndex = u16;

/// Two lanes follow each other where the end of one is nearer than this to the start of the other (MetaDrive,
/// `is_previous_lane_of`). [m]
const JOINT_M: f64 = 0.1;

/// Spacing of the points MetaDrive builds lane bodies from (`POLYGON_SAMPLE_RATE`). [m]
const BODY_SAMPLE_M: f64 = 1.0;

/// Collision margin of Bullet's convex hulls, by which a ray finds a lane a little beside it. [m]
const BODY_MARGIN_M: f64 = 0.04;

/// A lane with what would otherwise be computed again at every look-up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PreparedLane {
    shape: SegmentShape,
    /// `None` where it is straight: its body is as straight.
    hull: Option<Hull>,
    pub(crate) length_m: f64,
    half_width_m: f64,
    /// Change of half of its width along it.
    widens: f64,
    /// Where the lane's collision body ends, along the lane. [m]
    body_end_m: f64,
    start: Vec2,
    end: Vec2,
    pub(crate) road: u16,
    /// Number on its road, 0 is the leftmost.
    pub(crate) number: u8,
}

/// What the convex hull of an arc is bounded by.
#[derive(Debug, Clone, Copy)]
struct Hull {
    /// +1 anticlockwise (a left curve), -1 clockwise.
    turn: f64,
    /// Directions of travel at both ends.
    start_forward: Vec2,
    end_forward: Vec2,
    /// The straight inner edge: a point on it and its unit vector.
    chord: Vec2,
    chord_forward: Vec2,
}

impl PreparedLane {
    fn new(network: &RoadNetwork, index: usize) -> Self {
        let lane = &network.lanes[index];
        let (start, end) = (lane.position(0.0, 0.0), lane.position(lane.length_m, 0.0));
        // numpy's arange(0, length + 1, 1) ends with the length rounded up.
        let body_end_m = (lane.length_m / BODY_SAMPLE_M - 1e-9).ceil() * BODY_SAMPLE_M;
        let hull = match lane.centreline {
            Centreline::Straight { .. } => None,
            Centreline::Arc { turn, .. } => {
                let start_forward = Vec2::from_heading(lane.heading(0.0));
                let end_forward = Vec2::from_heading(lane.heading(lane.length_m));
                let inner = -turn * 0.5 * lane.width_m.max(lane.end_width_m);
                let chord = lane.position(0.0, inner) - start_forward * BODY_SAMPLE_M;
                let chord_end = lane.position(body_end_m, inner) + end_forward * BODY_SAMPLE_M;
                let along = chord_end - chord;
                Some(Hull { turn, start_forward, end_forward, chord, chord_forward: along * (1.0 / along.length()) })
            }
        };
        Self {
            shape: SegmentShape::of(lane),
            hull,
            length_m: lane.length_m,
            half_width_m: 0.5 * lane.width_m,
            widens: 0.5 * (lane.end_width_m - lane.width_m) / lane.length_m,
            body_end_m,
            start,
            end,
            road: lane.road.0,
            number: lane.index,
        }
    }

    /// (s, t) of a point; the lane is continued at both ends. [m]
    #[inline]
    pub(crate) fn local(&self, point: Vec2) -> (f64, f64) {
        self.shape.local(point)
    }

    /// Heading of the centre line; an arc is continued as a circle. Not wrapped. [rad]
    #[inline]
    pub(crate) fn heading(&self, s: f64) -> f64 {
        self.shape.heading(s)
    }

    /// Width at s. [m]
    #[inline]
    pub(crate) fn width_m(&self, s: f64) -> f64 {
        2.0 * self.half_width_m(s)
    }

    /// Half of the width at s; beyond an end, that at the end. [m]
    #[inline]
    fn half_width_m(&self, s: f64) -> f64 {
        self.half_width_m + self.widens * s.clamp(0.0, self.length_m)
    }

    /// Radius of the centre line; `None` where it is straight. [m]
    #[inline]
    pub(crate) fn radius(&self) -> Option<f64> {
        match self.shape {
            SegmentShape::Straight { .. } => None,
            SegmentShape::Arc { radius, .. } => Some(radius),
        }
    }

    /// Curvature of the centre line, positive to the left. [1/m]
    #[inline]
    pub(crate) fn curvature(&self) -> f64 {
        match self.shape {
            SegmentShape::Straight { .. } => 0.0,
            SegmentShape::Arc { radius, turn, .. } => turn / radius,
        }
    }

    /// How far beside the lane its coordinates still mean something: to an arc's centre. [m]
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.radius().map_or(f64::INFINITY, |radius| 0.9 * radius)
    }

    /// Whether a point with these lane coordinates lies on the lane proper.
    #[inline]
    fn holds(&self, s: f64, t: f64) -> bool {
        s >= 0.0 && s <= self.length_m && t.abs() <= self.half_width_m(s)
    }

    /// Whether a point lies on the lane's collision body.
    fn body_holds(&self, point: Vec2) -> bool {
        let (s, t) = self.local(point);
        match &self.hull {
            None => {
                s >= -BODY_MARGIN_M
                    && s <= self.body_end_m + BODY_MARGIN_M
                    && t.abs() <= self.half_width_m(s) + BODY_MARGIN_M
            }
            Some(hull) => {
                let beyond_end = self.body_end_m - self.length_m + BODY_SAMPLE_M;
                hull.turn * t <= self.half_width_m(s) + BODY_MARGIN_M
                    && (point - self.start).dot(hull.start_forward) >= -BODY_SAMPLE_M - BODY_MARGIN_M
                    && (point - self.end).dot(hull.end_forward) <= beyond_end + BODY_MARGIN_M
                    && hull.turn * hull.chord_forward.cross(point - hull.chord) <= BODY_MARGIN_M
            }
        }
    }

    /// The measure by which MetaDrive orders the lanes under a point. [m]
    fn misfit(&self, point: Vec2) -> f64 {
        let (s, t) = self.local(point);
        t.abs() + (s - self.length_m).max(0.0) + (-s).max(0.0)
    }

    /// Whether the other lane begins where this one ends.
    #[inline]
    pub(crate) fn leads_to(&self, other: &Self) -> bool {
        (self.end - other.start).length_squared() < JOINT_M * JOINT_M
    }
}

/// All lanes of a map.
#[derive(Debug, Clone, Default)]
pub(crate) struct LaneTable {
    map: Option<MapSpec>,
    lanes: Vec<PreparedLane>,
    /// Lanes of all roads, one road after the other, leftmost first.
    lanes_of_roads: Vec<LaneIndex>,
    /// Where each road's lanes begin in `lanes_of_roads`; one more at the end.
    first_lane: Vec<u16>,
    /// What else is to be driven on.
    paved: Vec<GroundArea>,
}

impl LaneTable {
    /// Makes this the table of `network`, which is no work where it already is.
    pub(crate) fn prepare(&mut self, network: &RoadNetwork) {
        if self.map.as_ref() == Some(&network.map) {
            return;
        }
        self.lanes.clear();
        self.lanes.extend((0..network.lanes.len()).map(|index| PreparedLane::new(network, index)));
        self.lanes_of_roads.clear();
        self.first_lane.clear();
        for road in &network.roads {
            self.first_lane.push(self.lanes_of_roads.len() as u16);
            self.lanes_of_roads.extend(road.lanes.iter().map(|lane| lane.0));
        }
        self.first_lane.push(self.lanes_of_roads.len() as u16);
        self.paved.clear();
        self.paved.extend(network.areas.iter().filter(|area| area.kind.is_paved()).cloned());
        self.map = Some(network.map.clone());
    }

    /// A lane.
    #[inline]
    pub(crate) fn lane(&self, index: LaneIndex) -> &PreparedLane {
        &self.lanes[usize::from(index)]
    }

    /// The lanes of a road, leftmost first.
    #[inline]
    pub(crate) fn of_road(&self, road: RoadId) -> &[LaneIndex] {
        let road = usize::from(road.0);
        &self.lanes_of_roads[usize::from(self.first_lane[road])..usize::from(self.first_lane[road + 1])]
    }

    /// The lane among `candidates` under a point that fits best.
    fn best_of(&self, candidates: &[LaneIndex], point: Vec2) -> Option<LaneIndex> {
        let mut best = None;
        for &index in candidates {
            let lane = self.lane(index);
            if !lane.body_holds(point) {
                continue;
            }
            let misfit = lane.misfit(point);
            if best.is_none_or(|(least, _)| misfit < least) {
                best = Some((misfit, index));
            }
        }
        best.map(|(_, index)| index)
    }

    /// The lane that somebody with a plan is on, and the place along it: one of `way`, the ego's, before any other, by the
    /// lanes' true edges. MetaDrive's worker is told the same (`recrash_plan::metadrive`). [m]
    pub(crate) fn lane_of_plan(&self, way: &[LaneIndex], point: Vec2, heading: f64) -> Option<(LaneIndex, f64)> {
        let mut best: Option<(f64, LaneIndex, f64)> = None;
        for &index in way {
            let lane = self.lane(index);
            let (s, t) = lane.local(point);
            if lane.holds(s, t) && best.is_none_or(|(least, ..)| t.abs() < least) {
                best = Some((t.abs(), index, s));
            }
        }
        if let Some((_, index, s)) = best {
            return Some((index, s));
        }
        let mut best: Option<((bool, f64), LaneIndex, f64)> = None;
        for (index, lane) in self.lanes.iter().enumerate() {
            let (s, t) = lane.local(point);
            if !lane.holds(s, t) {
                continue;
            }
            let turned = math::wrap_angle(lane.heading(s) - heading).abs();
            let misfit = (turned > math::FRAC_PI_2, t.abs() + lane.width_m(s) * turned);
            if best.is_none_or(|(least, ..)| misfit < least) {
                best = Some((misfit, index as LaneIndex, s));
            }
        }
        best.map(|(_, index, s)| (index, s))
    }

    /// Whether a point lies on a paved area beside the lanes: a driveway, a forecourt.
    pub(crate) fn is_paved(&self, point: Vec2) -> bool {
        self.paved.iter().any(|area| area.contains(point))
    }

    /// Whether a point lies on any lane's body.
    fn on_any(&self, point: Vec2) -> bool {
        self.lanes.iter().any(|lane| lane.body_holds(point))
    }
}

/// Where a road user is along its route, as MetaDrive's navigation keeps it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Navigator {
    /// The route: a range of the world's list of roads.
    route: (u32, u32),
    /// Position of the current road on the route.
    at: u32,
    /// The lane it is on, or was on last.
    pub(crate) lane: LaneIndex,
    /// Coordinates on that lane. [m]
    pub(crate) s: f64,
    pub(crate) t: f64,
    /// Whether it is on any lane at all.
    pub(crate) on_road: bool,
}

/// A vehicle is on the next road of its route only within this distance from that road's beginning
/// (`CKPT_UPDATE_RANGE`). [m]
const NEXT_ROAD_RANGE_M: f64 = 5.0;

impl Navigator {
    /// At the road of the route that holds `s`, on lane number `number`.
    pub(crate) fn new(route: (u32, u32), at: u32, lane: LaneIndex) -> Self {
        Self { route, at, lane, s: 0.0, t: 0.0, on_road: true }
    }

    /// The road it is routed along.
    #[inline]
    pub(crate) fn road(&self, routes: &[RoadId]) -> RoadId {
        routes[(self.route.0 + self.at) as usize]
    }

    /// The road after that.
    #[inline]
    pub(crate) fn next_road(&self, routes: &[RoadId]) -> Option<RoadId> {
        (!self.on_last_road()).then(|| routes[(self.route.0 + self.at + 1) as usize])
    }

    /// The next road that is another: a route that changes lanes names its road more than once.
    pub(crate) fn next_other_road(&self, routes: &[RoadId]) -> Option<RoadId> {
        let road = self.road(routes);
        routes[(self.route.0 + self.at) as usize..self.route.1 as usize].iter().copied().find(|next| *next != road)
    }

    /// Whether it is still where its route begins.
    #[inline]
    pub(crate) fn on_first_road(&self) -> bool {
        self.at == 0
    }

    /// Whether the route ends with the current road.
    #[inline]
    pub(crate) fn on_last_road(&self) -> bool {
        self.route.0 + self.at + 1 == self.route.1
    }

    /// Finds the lane under a point: one of the current road if there is any, else of the next, else any that leads
    /// the same way; where there is none, the lane stays what it was.
    pub(crate) fn localise(&mut self, table: &LaneTable, routes: &[RoadId], point: Vec2, heading: f64) {
        // Most of the time it is still on the lane it was on, and that is a lane of its road.
        let own = table.lane(self.lane);
        let (s, t) = own.local(point);
        (self.s, self.t) = (s, t);
        self.on_road = true;
        let road = self.road(routes);
        if own.road == road.0 && own.holds(s, t) {
            return;
        }
        let found = table
            .best_of(table.of_road(road), point)
            .or_else(|| self.next_road(routes).and_then(|next| table.best_of(table.of_road(next), point)))
            .or_else(|| {
                let forward = Vec2::from_heading(heading);
                let mut best = None;
                for (index, lane) in table.lanes.iter().enumerate() {
                    if !lane.body_holds(point) {
                        continue;
                    }
                    let (s, _) = lane.local(point);
                    let misfit = lane.misfit(point);
                    if Vec2::from_heading(lane.heading(s)).dot(forward) > 0.0
                        && best.is_none_or(|(least, _)| misfit < least)
                    {
                        best = Some((misfit, index as LaneIndex));
                    }
                }
                best.map(|(_, index)| index)
            });
        match found {
            Some(lane) => {
                self.lane = lane;
                (self.s, self.t) = table.lane(lane).local(point);
            }
            None => self.on_road = table.on_any(point),
        }
        self.follow_route(table, routes);
    }

    /// Goes on to the road of the route that the lane belongs to, if that lies ahead and has just been entered.
    fn follow_route(&mut self, table: &LaneTable, routes: &[RoadId]) {
        if self.s >= NEXT_ROAD_RANGE_M {
            return;
        }
        let road = table.lane(self.lane).road;
        let ahead = self.at + 1..self.route.1 - self.route.0;
        for at in ahead {
            if routes[(self.route.0 + at) as usize].0 == road {
                self.at = at;
                return;
            }
        }
    }
}

/// How far a road user has come along the path it was placed on, whatever lane it is on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    /// Position of the path's current lane in the world's list, and the position behind the path's last.
    pub(crate) at: u32,
    pub(crate) end: u32,
    /// Along that lane. [m]
    pub(crate) s: f64,
}

impl Progress {
    /// Goes on to the lane of the path beside this point; never back.
    #[inline]
    pub(crate) fn follow(&mut self, table: &LaneTable, path: &[LaneIndex], place: &Navigator, point: Vec2) {
        loop {
            let index = path[self.at as usize];
            let lane = table.lane(index);
            self.s = if index == place.lane { place.s } else { lane.local(point).0 };
            if self.s <= lane.length_m || self.at + 1 >= self.end {
                return;
            }
            self.at += 1;
        }
    }
}
