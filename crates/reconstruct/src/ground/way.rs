//! A road and the ego's way on it: where places lie along it and beside it.

use crate::ground::pieces::{APPROACH_M, corner_m};
use crate::told::aside::Aside;
use crate::told::astride::INSIDE_M;
use crate::told::crash::Told;
use crate::told::side::{Side, Turning, size_of};
use crate::usual::LANE_M;
use recrash_model::account::{LaneLine, LaneWord, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::{GraphMap, MapSpec, StripKind};
use recrash_roads::{LanePath, RoadNetwork};
use std::rc::Rc;
use std::sync::Arc;

/// Whose turn is over has turned by so much; places to try are so far behind that. [rad, m]
const TURNED_RAD: f64 = 1.3;
const AFTER_TURN_M: [f64; 4] = [0.0, 3.0, 6.0, 10.0];

/// A crosswalk is as wide as these places along the ego's way; and who turns into the road that has it has turned by so much. [m, sine]
const ALONG_WALK_M: [f64; 3] = [0.0, -0.8, 0.8];
const TURNED_SINE: f64 = 0.5;

/// Who crosses short of the crosswalk does so before where the junction begins. [m]
const SHORT_M: f64 = 2.0;

/// So far behind where the junction begins the lanes of others are looked for. [0.1 m]
const IN_LANES: u32 = 400;

/// Who stands at the right edge of its lane stands so far to the right of its middle. [m]
const LANE_EDGE_M: f64 = 0.6;

/// A road and the ego's way on it. Hundreds of ways of touching are tried on one: they share what is large.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ground {
    pub(crate) map: Rc<GraphMap>,
    /// Its network: a scenario on it need not build it again.
    pub(crate) network: Arc<RoadNetwork>,
    /// Roads of the ego's way.
    pub(crate) route: Vec<String>,
    pub(crate) lane: u8,
    /// The ego's way; and how far to the right of it the ego drives, whose lane does not lead where it turns. [m]
    pub(super) way: Rc<LanePath>,
    pub(crate) off_route_m: f64,
    /// Places along it to try. [m]
    pub(super) places: Vec<f64>,
    /// The same, of who comes straight. [m]
    straight_at: Vec<f64>,
    /// Whether crossing roads are there.
    pub(crate) junction: bool,
    /// In one direction, and in the other.
    pub(crate) lanes: usize,
    pub(crate) oncoming: usize,
    /// In each direction of the road that crosses.
    pub(crate) cross_lanes: usize,
    /// How wide a lane is. [m]
    pub(crate) lane_m: f64,
    /// From the ego's line to the middle of who is parked at the kerb on the left, and on the right. [m]
    pub(crate) kerbs_m: [f64; 2],
    /// From the ego's line to where it stands, to the right: it is parked at the kerb. [m]
    pub(crate) stands_m: f64,
    /// What lies beside the lanes of the partner's road, from them outwards.
    pub(crate) beside: Vec<StripKind>,
    /// From the ego's line to the outer edge of the lanes on the left, and on the right. [m]
    pub(crate) lane_edges_m: [f64; 2],
    /// From the ego's line to the middle of the nearest lane of those who come towards it. [m]
    pub(crate) opposing_m: f64,
    /// The drift that brings the ego to what stands at the edge of its road.
    pub(crate) drift: Option<Aside>,
}

impl Ground {
    pub(crate) fn places(&self) -> Vec<f64> {
        [self.places.as_slice(), &self.straight_at].concat()
    }

    /// Whether a place is tried for who comes straight alone.
    pub(crate) fn is_for_straight(&self, s_m: f64) -> bool {
        self.straight_at.contains(&s_m)
    }

    /// Which road of the map the ego comes along.
    pub(crate) fn own_road(&self) -> usize {
        let own = |id: &str| self.route[0].trim_end_matches(['+', '-']) == id;
        self.map.roads.iter().position(|road| own(&road.id)).unwrap_or(0)
    }

    /// Length of the first road of the way. [m]
    pub(crate) fn first_m(&self) -> f64 {
        if self.junction { APPROACH_M } else { 2.0 * APPROACH_M }
    }

    /// How far along the ego's way a place is, and how far beside it. [m]
    pub(crate) fn beside(&self, place: Vec2) -> (f64, f64) {
        let found = self.way.project(place, 0);
        (found.s, found.t - self.off_route_m)
    }

    /// A pose along the ego's way, or beside it.
    pub(crate) fn pose(&self, s_m: f64, t_m: f64) -> Pose {
        self.way.pose(s_m, t_m + self.off_route_m)
    }

    /// Where a road user begins that drives so far to a place along the ego's way, beside the ego's line: its rear axle is on a
    /// line of its own, which is longer or shorter than the way where that bends. [m]
    pub(crate) fn before(&self, side: &Side, s_m: f64, t_m: f64, driven_m: f64) -> f64 {
        let arm_m = recrash_roads::arm_m(side.kind, size_of(side).0);
        self.way.before(s_m - arm_m, t_m + self.off_route_m, driven_m) + arm_m
    }

    /// Along the road where the ego's line is 0, of a street. [m]
    pub(crate) const fn begins_m(&self) -> f64 {
        APPROACH_M
    }

    /// The same, with the ego's front so far behind where the road begins that it turns into.
    pub(super) fn at_entry(self, ego_m: f64, behind_m: &[f64]) -> Self {
        let centre_y_m = self.centre_y_m();
        let entry_m = (0..1000)
            .map(|step| APPROACH_M + 0.05 * f64::from(step))
            .find(|s_m| (self.sv_pose(*s_m).position.y - centre_y_m).abs() >= corner_m(self.lanes))
            .unwrap_or(APPROACH_M);
        Self { places: behind_m.iter().map(|behind_m| entry_m - 0.5 * ego_m + behind_m).collect(), ..self }
    }

    /// The same, with the places first at which the touched part of the ego is on a crosswalk, in line with the sidewalk of the road that
    /// crosses: the near one, the far one where it has come into the junction, or that of the road that it turns into.
    pub(super) fn at_walk(mut self, told: &Told) -> Self {
        let walk = self.beside.iter().position(|kind| *kind == StripKind::Sidewalk);
        let short = told.crosses_before_walk();
        let Some(walk) = walk.filter(|_| self.junction && (short || told.crosses_at_walk())) else { return self };
        let strips_m: f64 = self.beside[..walk].iter().map(|kind| kind.usual_width_m()).sum();
        let walk_m = self.lanes as f64 * self.lane_m + strips_m + 0.5 * StripKind::Sidewalk.usual_width_m();
        let part_m = told.touched_ahead_m();
        let touched_m = match told.turns_over_walk() {
            Some(_) => {
                let centre_y_m = self.centre_y_m();
                let aside_m = |s_m: &f64| {
                    let pose = self.sv_pose(*s_m);
                    (pose.position.y + part_m * math::sin(pose.heading) - centre_y_m).abs()
                };
                let turned = |s_m: &f64| math::sin(self.sv_pose(*s_m).heading).abs() > TURNED_SINE;
                let steps = (0..600).map(|step| APPROACH_M + 0.1 * f64::from(step));
                steps.filter(turned).find(|s_m| aside_m(s_m) >= walk_m)
            }
            // Where the ego's road has kerbs.
            None if short => Some(APPROACH_M - SHORT_M - part_m),
            None if told.enters() => Some(APPROACH_M + corner_m(self.lanes) + walk_m - part_m),
            None => Some(APPROACH_M + corner_m(self.lanes) - walk_m - part_m),
        };
        let places = touched_m.into_iter().flat_map(|touched_m| ALONG_WALK_M.map(|along_m| touched_m + along_m));
        self.places = places.chain(self.places.iter().copied()).collect();
        self
    }

    /// The same, with the places last at which the touched part of the ego is in the middle of a lane by which somebody comes straight across its
    /// way, so that who does need not bend for that.
    pub(super) fn in_their_lanes(mut self, told: &Told) -> Self {
        let ways = match told.origin {
            Origin::Opposite if told.sv.turning == Turning::Left => {
                Some((Vec2::new(0.0, 1.0), self.opposing_y_m(), self.oncoming))
            }
            Origin::Cross { side: LeftRight::Left } => {
                Some((Vec2::new(1.0, 0.0), (0.5 - self.lanes as f64) * LANE_M, self.lanes))
            }
            Origin::Cross { side: LeftRight::Right } => Some((Vec2::new(1.0, 0.0), 0.5 * LANE_M, self.lanes)),
            _ => None,
        };
        let straight = self.junction && told.cp.turning == Turning::No && !told.cp.state.stands();
        let Some((across, first_m, lanes)) = ways.filter(|_| straight && told.comes_along_lanes()) else { return self };
        let part_m = told.touched_ahead_m();
        let touched_m = |s_m: f64| {
            let pose = self.sv_pose(s_m);
            across.dot(pose.position + Vec2::from_heading(pose.heading) * part_m)
        };
        let found = (0..lanes).filter_map(|lane| {
            let lane_m = first_m + lane as f64 * LANE_M;
            (0..IN_LANES).map(|step| APPROACH_M + 0.1 * f64::from(step)).find(|s_m| touched_m(*s_m) >= lane_m)
        });
        self.straight_at = found.collect();
        self
    }

    /// The same, with the places first at which the ego's turn is over.
    pub(super) fn after_turn(mut self) -> Self {
        let turned = |s_m: &f64| self.sv_pose(*s_m).heading.abs() > TURNED_RAD;
        let over_m = (0..120).map(|step| APPROACH_M + 0.5 * f64::from(step)).find(turned);
        let places = over_m.iter().flat_map(|over_m| AFTER_TURN_M.map(|behind_m| over_m + behind_m));
        self.places = places.chain(self.places.iter().copied()).collect();
        self
    }

    /// The same, with an ego that drifts.
    pub(crate) fn drifting(&self, drift: Aside) -> Self {
        Self { drift: Some(drift), ..self.clone() }
    }

    /// The same, with an ego whose line is so far to the right of its lane's. [m]
    pub(crate) fn standing(&self, stands_m: f64) -> Self {
        Self { stands_m, ..self.clone() }
    }

    /// The same, with an ego that stands at the kerb.
    pub(super) fn at_kerb(self) -> Self {
        Self { stands_m: self.kerbs_m[1], ..self }
    }

    /// The same, with an ego that stands over a line of the road, or at the edge of its lane, where it is told to.
    pub(super) fn over_line(self, told: &Told) -> Self {
        let beside_m = 0.5 * self.lane_m - INSIDE_M;
        let [left, right] = [self.lane > 0, usize::from(self.lane) + 1 < self.lanes];
        let stands_m = match told.stands_over().map(|over| (over.line, over.side)) {
            // The left edge of a road with two directions is that of the other one.
            Some((LaneLine::Edge, Some(LeftRight::Left))) if self.oncoming == 0 => INSIDE_M - self.lane_edges_m[0],
            Some((LaneLine::Edge, Some(LeftRight::Right) | None)) => self.lane_edges_m[1] - INSIDE_M,
            Some((LaneLine::Centre, _)) if !left => -beside_m,
            Some((LaneLine::Lanes, Some(LeftRight::Left) | None)) if left => -beside_m,
            Some((LaneLine::Lanes, Some(LeftRight::Right) | None)) if right => beside_m,
            // Where others are parked or drive on its right it is in its lane.
            _ if told.sv.state.stands() && told.layout.sv.lane_edge && self.stands_m == 0.0 => LANE_EDGE_M,
            _ => return self,
        };
        Self { stands_m, ..self }
    }

    /// Where the middle of a junction is. [m]
    pub(crate) fn centre_y_m(&self) -> f64 {
        (self.lanes as f64 - 0.5) * self.lane_m
    }

    /// Where the middle of the nearest lane of those is who come towards the ego. [m]
    pub(crate) fn opposing_y_m(&self) -> f64 {
        self.sv_pose(0.0).position.y + self.opposing_m
    }

    /// Where the middle of a told lane of those is who come towards the ego, else that of the nearest. [m]
    pub(crate) fn oncoming_y_m(&self, lane: Option<LaneWord>) -> f64 {
        let number = match lane {
            Some(LaneWord::Center) => self.oncoming / 2,
            Some(LaneWord::Right | LaneWord::RightTurn) => self.oncoming.saturating_sub(1),
            _ => 0,
        };
        self.opposing_y_m() + number as f64 * self.lane_m
    }

    pub(crate) fn sv_pose(&self, s_m: f64) -> Pose {
        self.pose(s_m, 0.0)
    }
}

/// Lanes in the ego's direction, the ego's, 0 is the leftmost, those of who comes towards it, and what lies beside them.
pub(super) struct Across {
    pub(super) lanes: usize,
    pub(super) lane: usize,
    pub(super) oncoming: usize,
    pub(super) beside: Vec<StripKind>,
    /// Lanes in each direction of the road that crosses; and how wide one is. [1, m]
    pub(super) cross_lanes: usize,
    pub(super) lane_m: f64,
}

impl Across {
    /// From the ego's line to the middle of who is parked at the kerb on the left, and on the right. [m]
    fn kerbs_m(&self) -> [f64; 2] {
        let moving = self.beside.iter().take_while(|kind| **kind == StripKind::Bike);
        let half_m = 0.5 * StripKind::Parking.usual_width_m() + moving.map(|kind| kind.usual_width_m()).sum::<f64>();
        self.lane_edges_m().map(|edge_m| edge_m + half_m)
    }

    /// From the ego's line to the outer edge of the lanes on the left, and on the right. [m]
    fn lane_edges_m(&self) -> [f64; 2] {
        [self.oncoming + self.lane, self.lanes - self.lane - 1].map(|between| (between as f64 + 0.5) * self.lane_m)
    }
}

pub(super) fn with_way(map: GraphMap, route: Vec<String>, across: Across, places: Vec<f64>, junction: bool) -> Ground {
    let network = RoadNetwork::build(&MapSpec::G(map.clone()));
    let lane = across.lane as u8;
    let way = network.way(&route, lane, None).expect("the ego's way is on the map that was drawn for it");
    let (kerbs_m, opposing_m) = (across.kerbs_m(), (across.lane + 1) as f64 * across.lane_m);
    // Of a road before a junction the rightmost lane lies on the x axis.
    let own_y_m = if junction { (across.lanes - across.lane - 1) as f64 * across.lane_m } else { 0.0 };
    let off_m = way.pose(APPROACH_M - 1.0, 0.0).position.y - own_y_m;
    let off_route_m = if off_m.abs() > 0.5 * across.lane_m { off_m } else { 0.0 };
    Ground {
        map: Rc::new(map),
        network: Arc::new(network),
        route,
        lane,
        way: Rc::new(way),
        off_route_m,
        places,
        straight_at: Vec::new(),
        junction,
        lanes: across.lanes,
        oncoming: across.oncoming,
        cross_lanes: across.cross_lanes,
        lane_m: across.lane_m,
        kerbs_m,
        lane_edges_m: across.lane_edges_m(),
        beside: across.beside,
        stands_m: 0.0,
        opposing_m,
        drift: None,
    }
}

impl Ground {
    /// Whether somebody of this width who stands here reaches into the lanes, by more than this.
    pub(crate) fn is_in_lanes(&self, at: Pose, width_m: f64, by_m: f64) -> bool {
        let (_, t_m) = self.beside(at.position);
        let edge_m = self.lane_edges_m[usize::from(t_m > 0.0)];
        t_m.abs() - 0.5 * width_m < edge_m - by_m
    }
}
