//! What a partner's way asks of it: bends, and things that lie on it.

use crate::constants::{BRUSHES_M, COMMITTED_M, SHARE_IN_BENDS, SHORTEST_MOVE_S};
use crate::line::lateral_target;
use crate::speed::{Moment, Plan};
use recrash_model::scenario::LateralMove;
use recrash_roads::path::SegmentShape;
use recrash_roads::{LanePath, Scenario};
use serde::Serialize;

/// Obstacles farther beside a way than this are not on it, whatever moves there are. [m]
const WIDE_M: f64 = 15.0;

/// What is fixed along a partner's way. All positions are along its path, offsets to the right of it.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Way {
    /// Its sideways moves.
    pub moves: Vec<LateralMove>,
    /// The time over which the corners of their line are rounded. [s]
    pub blend_s: f64,
    /// Bends, in order.
    pub bends: Vec<Bend>,
    /// Obstacles on it or beside it.
    pub blocked: Vec<Blocked>,
}

/// A bend, and how fast it is driven.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bend {
    /// Its beginning. [m]
    pub from_m: f64,
    /// Its end. [m]
    pub to_m: f64,
    /// The speed at which it is driven, at most. [m/s]
    pub speed_mps: f64,
}

/// Room that an obstacle takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Blocked {
    /// Its near end. [m]
    pub from_m: f64,
    /// Its left edge. [m]
    pub left_m: f64,
    /// Its right edge. [m]
    pub right_m: f64,
}

impl Way {
    /// The way of a partner of a checked scenario.
    pub fn new(scenario: &Scenario, position: usize, plan: &Plan) -> Self {
        let path = &scenario.partners()[position].path;
        let blocked = scenario.obstacles().iter().filter_map(|each| blocked(path, each)).collect();
        Self { blocked, ..Self::along(path, plan, scenario.draft().partners[position].lateral.clone()) }
    }

    /// A way without anything on it.
    pub fn along(path: &LanePath, plan: &Plan, moves: Vec<LateralMove>) -> Self {
        let blend_s = blend_s(plan, &moves);
        Self { moves, blend_s, bends: bends(path, plan), blocked: Vec::new() }
    }

    /// Where the partner wants to be beside its lane, and how fast that moves, positive to the right: the line of its moves,
    /// each corner rounded as its sideways acceleration needs. [m, m/s]
    pub fn line(&self, plan: &Plan, time_s: f64) -> (f64, f64) {
        let at = |time_s: f64| lateral_target(plan.start_t_m, &self.moves, time_s);
        if self.blend_s <= 0.0 {
            return at(time_s);
        }
        let half_s = 0.5 * self.blend_s;
        let (before, now, after) = (at(time_s - half_s).0, at(time_s).0, at(time_s + half_s).0);
        ((before + 4.0 * now + after) / 6.0, (after - before) / self.blend_s)
    }

    /// Distance from the partner's centre to where its front would touch the first obstacle that lies on its line. [m]
    pub(crate) fn blocked_ahead(&self, plan: &Plan, now: &Moment) -> Option<f64> {
        let reach_m = plan.half_width_m - BRUSHES_M;
        let (left, right) = (now.t_m.min(now.wanted_t_m), now.t_m.max(now.wanted_t_m));
        self.blocked
            .iter()
            .filter(|each| each.left_m < right + reach_m && each.right_m > left - reach_m)
            .map(|each| each.from_m - plan.half_length_m - now.s_m)
            .filter(|ahead| *ahead >= -COMMITTED_M)
            .reduce(f64::min)
    }
}

/// The time in which its sideways acceleration turns one of its moves into the next, at most the shortest of them. [s]
fn blend_s(plan: &Plan, moves: &[LateralMove]) -> f64 {
    let mut from_m = plan.start_t_m;
    let mut fastest_mps: f64 = 0.0;
    for step in moves {
        fastest_mps = fastest_mps.max(((step.to_t_m - from_m) / step.duration_s.max(SHORTEST_MOVE_S)).abs());
        from_m = step.to_t_m;
    }
    let shortest_s = moves.iter().map(|step| step.duration_s).fold(f64::INFINITY, f64::min);
    if fastest_mps > 0.0 { (fastest_mps / plan.sideways_mps2).min(shortest_s) } else { 0.0 }
}

fn bends(path: &LanePath, plan: &Plan) -> Vec<Bend> {
    path.segments
        .iter()
        .filter_map(|segment| match segment.shape {
            SegmentShape::Straight { .. } => None,
            SegmentShape::Arc { radius, .. } => Some(Bend {
                from_m: segment.start_m,
                to_m: segment.start_m + segment.length_m,
                speed_mps: (SHARE_IN_BENDS * plan.sideways_mps2 * radius).sqrt(),
            }),
        })
        .collect()
}

fn blocked(path: &LanePath, obstacle: &recrash_roads::ObstaclePlacement) -> Option<Blocked> {
    let places = obstacle.placed.outline().corners().map(|corner| path.project(corner, 0));
    let least = |pick: fn(&recrash_roads::PathPoint) -> f64| places.iter().map(pick).fold(f64::INFINITY, f64::min);
    let (from_m, to_m) = (least(|place| place.s), -least(|place| -place.s));
    let (left_m, right_m) = (least(|place| place.t), -least(|place| -place.t));
    let beside = to_m > 0.0 && from_m < path.length_m && left_m < WIDE_M && right_m > -WIDE_M;
    beside.then_some(Blocked { from_m, left_m, right_m })
}
