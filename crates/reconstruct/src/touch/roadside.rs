//! What stands at the edge of the road, and the ego that comes too near, by its turn or by a drift.

use crate::ego::pace::ego_paces;
use crate::ego::plan::sv_at_contact;
use crate::ground::way::Ground;
use crate::told::aside::Aside;
use crate::told::crash::Told;
use crate::told::edge::LONG_M;
use crate::told::side::size_of;
use crate::told::zones::zones_off;
use crate::touch::boxes::{Meeting, points};
use crate::touch::staging::Staging;
use crate::usual::LANE_M;
use recrash_model::account::LeftRight;
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use std::rc::Rc;

/// An ego that has stood, and driven no farther since, drifts by this share of it. [m]
const LEAST_DRIFT_M: f64 = 7.0;
const DRIFTS: f64 = 0.12;

/// One that is told to go aside is seen to: it has done half of this. [m]
const DODGES_M: f64 = 1.2;

/// No ego drifts by more to the contact. [m]
const FARTHEST_M: f64 = 5.0;

/// Ways in which the ego comes to the edge of its road and touches what stands there.
pub(super) fn stagings(told: &Told, ground: &Ground, side: LeftRight) -> Vec<Staging> {
    // Seen from the ego's line to the right, and from what stands there to the flank that is nearer.
    let right = -side.sign();
    let (corner, within) = ((1.0, -right), (1.0, -0.75 * right));
    let flank_only = !told.sv.zones.is_empty() && !told.sv.zones.iter().any(|zone| zone.is_front());
    let in_passing = told.is_parked_along() && told.sv.movement != Some(Movement::ParkingManeuver);
    let sv_points = match told.goes_along() || in_passing || flank_only {
        true => vec![corner],
        false => vec![within, corner],
    };
    let mut found = Vec::new();
    let mut trial = 0;
    for sv_s_m in ground.places() {
        for &sv_point in &sv_points {
            let Some((ground, sv)) = drifted(told, ground, sv_s_m, sv_point, right * told.edge_m()) else { continue };
            let ground = Rc::new(ground);
            let along = ground.pose(ground.beside(at(told, sv, sv_point)).0, 0.0).heading;
            for &(turned, cp_point) in &ways(told, right) {
                trial += 1;
                let heading = math::wrap_angle(along + turned);
                let touched = Meeting::of(told, sv, heading).and_then(|meeting| meeting.touch(sv_point, cp_point));
                let Some((cp, sv_seen, cp_seen)) = touched else { continue };
                let cp_off = if told.thing.is_some() { 0 } else { zones_off(&told.cp.zones, cp_seen) };
                let cost = (zones_off(&told.sv.zones, sv_seen) + cp_off, trial);
                found.push(Staging {
                    ground: Rc::clone(&ground),
                    sv_s_m,
                    sv,
                    cp,
                    cp_came: heading,
                    bend: None,
                    cp_follows_m: None,
                    door: None,
                    cost,
                });
            }
        }
    }
    found
}

/// How the partner may face, against the road, and where it may be touched; `near`: its flank that is nearer to the ego, where it faces as the
/// road goes. [rad]
fn ways(told: &Told, near: f64) -> Vec<(f64, (f64, f64))> {
    if told.diagonal {
        // Its rear to the road, and the corner of it that is nearest.
        return vec![(-0.25 * math::PI * near, (-1.0, near)), (-0.75 * math::PI * near, (-1.0, -near))];
    }
    if told.goes_along() {
        return [-0.5, 0.0, 0.5].map(|along| (0.0, (along, near))).to_vec();
    }
    if !told.is_parked_along() {
        return vec![(0.0, (-1.0, near))];
    }
    let zones = if told.cp.zones.is_empty() { &ContactZone::ALL[..8] } else { &told.cp.zones[..] };
    let on_flank = [(0.0, near), (math::PI, -near)].into_iter().flat_map(|(turned, near)| {
        let at = zones.iter().flat_map(|zone| points(*zone)).copied();
        at.filter(move |point| point.1 * near > 0.9).map(move |point| (turned, point))
    });
    let corners = [(0.0, near), (math::PI, -near)]
        .into_iter()
        .flat_map(|(turned, near)| [-1.0, 1.0].map(|end| (turned, (end, near))));
    on_flank.chain(corners).collect()
}

/// A point of the ego's outline, in shares of half of its length and width.
fn at(told: &Told, sv: Pose, point: (f64, f64)) -> Vec2 {
    let (length_m, width_m) = size_of(&told.sv);
    OrientedBox::new(sv, length_m, width_m).to_world(Vec2::new(point.0 * 0.5 * length_m, point.1 * 0.5 * width_m))
}

/// The ground with the drift that brings a point of the ego to a line beside its own at the contact, and where the ego is then.
fn drifted(told: &Told, ground: &Ground, sv_s_m: f64, point: (f64, f64), line_m: f64) -> Option<(Ground, Pose)> {
    let pace = ego_paces(told, ground, sv_s_m).1;
    // Who stood shortly before stands beside its line already.
    let stood = pace.speed_mps == 0.0 && pace.driven_m < LEAST_DRIFT_M;
    let least_m = if told.sv.aside.is_some() { DODGES_M } else { 0.0 };
    let by_m = (line_m.signum() * (DRIFTS * pace.driven_m).max(least_m), 1.0);
    let mut to_t_m = 2.0 * (line_m + point.1 * 0.5 * size_of(&told.sv).1);
    for _ in 0..12 {
        let (by_m, gain) = if stood { by_m } else { (to_t_m, 1.4) };
        let ground = ground.drifting(Aside { from_t_m: to_t_m - by_m, to_t_m, done: false, back: false });
        let sv = sv_at_contact(told, &ground, sv_s_m)?;
        let off_m = line_m - ground.beside(at(told, sv, point)).1;
        if off_m.abs() < 0.005 {
            return Some((ground, sv));
        }
        to_t_m += gain * off_m;
        if to_t_m.abs() > 2.0 * FARTHEST_M {
            return None;
        }
    }
    None
}

impl Told {
    /// From the middle of the outermost lane to the partner's flank: behind the strip beside it, but a small thing stands in that; who is parked
    /// stands by the lane, or in the middle of its strip where the ego pulls over too. [m]
    fn edge_m(&self) -> f64 {
        let strip = self.beside_edge().first().copied().filter(|strip| strip.is_paved() && !self.edge_is_median());
        let strip_m = strip.map_or(0.0, StripKind::usual_width_m);
        let width_m = size_of(&self.cp).1;
        let on_strip_m = match (self.is_parked_along(), self.sv.movement) {
            (true, Some(Movement::ParkingManeuver)) => (0.5 * (strip_m - width_m)).max(0.0),
            (true, _) => 0.0,
            (false, _) if strip_m > 0.0 && !self.goes_along() => strip_m - width_m,
            (false, _) => strip_m,
        };
        0.5 * LANE_M + on_strip_m
    }

    /// Whether the partner is a thing that goes along the road.
    fn goes_along(&self) -> bool {
        self.thing.is_some() && size_of(&self.cp).0 > LONG_M
    }
}
