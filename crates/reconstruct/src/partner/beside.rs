//! Lines beside the ego's from which the partner comes: the kerb, a strip, the lane that it leaves.

use crate::ground::way::Ground;
use crate::pace::plain::{Pace, start_over};
use crate::told::crash::Told;
use crate::told::side::{Turning, is_on_foot, size_of};
use crate::touch::lanes;
use crate::touch::staging::Staging;
use crate::usual::{LANE_M, RUNS_LEAST_MPS, WHEELED_M};
use recrash_model::account::{ContactState, LaneLine, LaneWord, LeftRight, Origin};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::StripKind;
use recrash_model::vehicle::VehicleSpec;

/// Who squeezes by comes along one line, and nearer to the ego on the last of its way alone. [m]
pub(super) const SQUEEZES_M: f64 = 10.0;

/// From how far away somebody pulls out at least. [m]
pub(super) const PULL_OUT_M: f64 = 8.0;

/// Length of a way out of the line, so that its bends have this radius at least. [m]
const LEAST_RADIUS_M: f64 = 10.0;

/// The line at the kerb that the partner stood on, to the left of the ego's line. [m]
fn kerb_y_m(told: &Told, staging: &Staging) -> Option<f64> {
    if told.pulls_out_opposite() {
        let strip = staging.ground.beside.contains(&StripKind::Parking) && !staging.ground.junction;
        return strip.then_some(staging.ground.kerbs_m[0]);
    }
    let Origin::Parked { side } = told.origin else { return None };
    if !told.stood_beside() {
        return None;
    }
    let [left_m, right_m] = staging.ground.kerbs_m;
    let on_left = side.map_or(staging.cp.heading < 0.0, |side| side == LeftRight::Left);
    let (kerb_m, cp_m) = if on_left { (left_m, staging.cp.position.y) } else { (right_m, -staging.cp.position.y) };
    // Before a junction the road has two directions: it came out into the leftmost lane.
    if on_left && staging.ground.junction && staging.ground.lane > 0 {
        return Some(staging.sv.position.y + f64::from(staging.ground.lane) * LANE_M);
    }
    let aside_m = kerb_m.max(cp_m);
    Some(if on_left { aside_m } else { -aside_m })
}

/// The pace of a partner that pulls out from the kerb: from a stand, as far away as its way needs.
pub(super) fn from_kerb(told: &Told, staging: &Staging) -> Option<Pace> {
    let aside_m = (kerb_y_m(told, staging)? - staging.cp.position.y).abs();
    let length_m = (4.0 * LEAST_RADIUS_M * aside_m).sqrt().max(PULL_OUT_M);
    start_over(told.contact_s, told.cp.speed_mps, length_m)
}

/// The line that a partner came along before it left it for the contact, to the left of the ego's line; nothing where it is
/// not told to have left one. [m]
pub(super) fn line_y_m(told: &Told, staging: &Staging) -> Option<f64> {
    if told.comes_across() {
        return None;
    }
    // Who backs into a space at the kerb stood beside it, in the lane.
    if told.cp.backs_in {
        return Some(0.0);
    }
    if told.comes_along_kerb() && staging.ground.stands_m > 0.0 {
        return Some(0.0);
    }
    let wrong_side = told.is_met_on_wrong_side(&staging.ground, staging.cp);
    if wrong_side && told.squeezes_by() {
        let half_m = 0.5 * staging.ground.lane_m;
        return Some(staging.cp.position.y.max(staging.ground.sv_pose(0.0).position.y - half_m) + half_m);
    }
    if told.squeezes_by() {
        let turn = math::wrap_angle(staging.cp.heading - staging.cp_came);
        return Some(staging.cp.position.y + 0.5 * SQUEEZES_M * math::sin(turn.abs()));
    }
    if told.comes_over || wrong_side {
        return Some(staging.ground.oncoming_y_m(told.cp.lane).max(staging.cp.position.y));
    }
    if told.drifts_on_wrong_way() {
        return Some(staging.cp.position.y + told.cp_from_left_m()?);
    }
    if told.leaves_opposite() {
        return Some(staging.ground.opposing_y_m());
    }
    kerb_y_m(told, staging)
        .or_else(|| told.strip_y_m(&staging.ground))
        .or_else(|| {
            let from_left_m = told.cp_from_left_m()?;
            // Another lane than the ego's, where nobody tells which: its own is beside a corner, too.
            let beside_ego = told.may_come_from_either() && told.sv.turning == Turning::No;
            let from = if beside_ego { staging.sv.position } else { staging.cp.position };
            let lane_m = |from_left_m: f64| {
                let left = (from, from_left_m);
                lanes::left_lane_m(&staging.ground, staging.cp_came, left).filter(|_| !told.back_straight)
            };
            // From the side on which a lane is, where none is told.
            let either = || told.may_come_from_either().then(|| lane_m(-from_left_m)).flatten();
            Some(lane_m(from_left_m).or_else(either).unwrap_or(staging.cp.position.y + from_left_m))
        })
        .or_else(|| beside(told).map(|side| staging.sv.position.y + side.sign() * LANE_M))
}

/// Who drives over a line has its middle no farther beside that. [m]
const OVER_WITHIN_M: f64 = 0.5;

/// The line along which a partner came that drives over one: over that between the directions, over the edge of the road on the told or touched
/// side, else over the nearest between lanes of its direction; nothing where there is no such line. [m]
pub(super) fn over_y_m(told: &Told, staging: &Staging) -> Option<f64> {
    let over = told.cp.astride.filter(|_| told.comes_over_line())?;
    let (ground, y_m) = (&staging.ground, staging.cp.position.y);
    let (own_y_m, lane, lane_m) = (ground.sv_pose(0.0).position.y, f64::from(ground.lane), ground.lane_m);
    // Lines lie so many lanes to the left of that beside the ego's; the last before those of the other direction is that between the two.
    let line = (y_m - own_y_m) / lane_m - 0.5;
    let (first, last) = match told.origin {
        Origin::Opposite => (lane + 1.0, lane + ground.oncoming as f64 - 1.0),
        _ => (lane + 1.0 - ground.lanes as f64, lane - 1.0),
    };
    let edge_m = match (over.line, over.side.or_else(|| told.touched_side())) {
        (LaneLine::Centre, _) => own_y_m + (lane + 0.5) * lane_m,
        (LaneLine::Lanes, _) if first <= last => own_y_m + (line.round().clamp(first, last) + 0.5) * lane_m,
        // The left edge of a road with two directions is that of the other one.
        (LaneLine::Edge, Some(LeftRight::Left)) if ground.oncoming == 0 => own_y_m + ground.lane_edges_m[0],
        (LaneLine::Edge, Some(LeftRight::Right)) => own_y_m - ground.lane_edges_m[1],
        _ => return None,
    };
    Some(y_m.clamp(edge_m - OVER_WITHIN_M, edge_m + OVER_WITHIN_M))
}

/// How far somebody drives who leaves its line for where it touches, in no tighter bend than who sets off steers; nothing of who walks. [m]
pub(super) fn room_m(told: &Told, staging: &Staging) -> f64 {
    let (cp, length_m) = (staging.cp, size_of(&told.cp).0);
    if VehicleSpec::of(told.cp.kind).length_m <= WHEELED_M {
        return 0.0;
    }
    let (turn, came) = (math::wrap_angle(cp.heading - staging.cp_came), Vec2::from_heading(staging.cp_came));
    let line_y_m = line_y_m(told, staging).filter(|_| told.cp.turning == Turning::No);
    // Its rear axle goes over from one line to the other.
    let arm_m = recrash_roads::arm_m(told.cp.kind, length_m);
    let swings_m = arm_m * math::sin(turn.abs());
    let aside_m = line_y_m.map_or(swings_m, |line_y_m| {
        let over = Vec2::new(0.0, cp.position.y - line_y_m) - Vec2::from_heading(cp.heading) * arm_m;
        came.cross(over).abs()
    });
    let radius_m = STOOD_RADIUS_M.max(STOOD_LENGTHS * length_m);
    (4.0 * radius_m * aside_m).sqrt() + radius_m * turn.abs()
}

/// On which side of the ego's lane the partner comes along.
fn beside(told: &Told) -> Option<LeftRight> {
    match told.origin {
        // It keeps its lane where the ego changes lanes.
        Origin::Beside { side } => told.sv_aside().is_none().then_some(side),
        Origin::Behind if told.cp.lane == Some(LaneWord::Opposing) => Some(LeftRight::Left),
        _ => None,
    }
}

/// Who stood close behind the ego comes out of its lane so far before the contact, with no tighter bend, or of so much of its length. [m]
pub(super) const STOOD_OUT_M: f64 = 4.0;
pub(super) const STOOD_RADIUS_M: f64 = 5.5;
const STOOD_LENGTHS: f64 = 0.5;

impl Told {
    /// The line along the strip that the partner came along, to the left of the road's axis. [m]
    pub(super) fn strip_y_m(&self, ground: &Ground) -> Option<f64> {
        let strip = self.comes_along_strip()?;
        let inner_m = ground.beside.iter().take_while(|kind| **kind != strip).map(|kind| kind.usual_width_m());
        let middle_m = inner_m.sum::<f64>() + 0.5 * strip.usual_width_m();
        let [left_m, right_m] = ground.lane_edges_m;
        let own_y_m = ground.sv_pose(0.0).position.y;
        let y_m = match self.origin {
            Origin::Opposite => own_y_m + left_m + middle_m,
            _ => own_y_m - right_m - middle_m,
        };
        ground.beside.contains(&strip).then_some(y_m)
    }
}

/// Where no strip lies beside the lanes, who runs out stood so far beside them. [m]
const BESIDE_LANES_M: f64 = 1.0;

/// The pace of who runs across the road, on foot or as an animal: it stood on the outermost strip beside the lanes until then.
pub(super) fn runs_out(told: &Told, staging: &Staging) -> Option<Pace> {
    let fast = told.cp.speed_mps > RUNS_LEAST_MPS && told.cp.state == ContactState::Moving;
    let crosses = matches!(told.origin, Origin::Cross { .. }) && told.sv.turning == Turning::No;
    let sine = math::sin(staging.cp_came);
    if !(is_on_foot(told.cp.kind) && fast && crosses) || sine.abs() < SQUARE_SINE {
        return None;
    }
    let ground = &staging.ground;
    let strips_m: f64 = ground.beside.iter().map(|kind| kind.usual_width_m()).sum();
    let outermost_m = ground.beside.last().map_or(-2.0 * BESIDE_LANES_M, |kind| kind.usual_width_m());
    // Who goes to the left comes from the right.
    let edge_m = ground.lane_edges_m[usize::from(sine > 0.0)] + strips_m - 0.5 * outermost_m;
    let aside_m = (staging.cp.position.y - ground.sv_pose(0.0).position.y) * -sine.signum();
    start_over(told.contact_s, told.cp.speed_mps, (edge_m - aside_m) / sine.abs())
}

/// Who crosses the road so much along it is not square to it. [-]
const SQUARE_SINE: f64 = 0.7;

/// Nobody backs farther, or drives farther out of a driveway. [m]
const FARTHEST_M: f64 = 14.0;

/// How far somebody has come at the contact who began in a stall or in a driveway, behind the kerb. [m]
pub(super) fn out_m(told: &Told, staging: &Staging) -> f64 {
    let strip_m = StripKind::Parking.usual_width_m();
    let (half_m, position) = (0.5 * size_of(&told.cp).0, staging.cp.position);
    // It came from the side to which it faces, of who reverses.
    let gear = if told.cp.state == ContactState::Reversing { 1.0 } else { -1.0 };
    let sine = gear * math::sin(staging.cp_came);
    let lane_edge_m = staging.ground.kerbs_m[usize::from(sine < 0.0)] - 0.5 * strip_m;
    let begins_m = match told.origin {
        // In the middle of its stall.
        Origin::Stall { .. } => lane_edge_m + half_m.max(0.5 * StripKind::Stalls.usual_width_m()),
        Origin::Cross { .. } => lane_edge_m + half_m,
        _ => lane_edge_m + strip_m + half_m,
    };
    let aside_m = begins_m - position.y * sine.signum();
    (aside_m / sine.abs().max(0.3)).clamp(0.0, FARTHEST_M)
}
