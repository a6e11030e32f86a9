//! Who turns as it touches: the flank or a rear corner of a partner that drives on comes to the ego by its turn. The front of who passes
//! one that stands is by already; its rear cuts in behind that, or swings out.

use crate::ego::plan::sv_at_contact;
use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::side::size_of;
use crate::told::zones::zones_off;
use crate::touch::boxes::{points, velocity, zone_pairs};
use crate::touch::headings::headings;
use crate::touch::lanes::turn_m;
use crate::touch::staging::{Bend, Staging};
use crate::usual::WHEELED_M;
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::ContactState;
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::{Leg, Place};
use recrash_model::template::Movement;
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;
use recrash_roads::{Course, arm_m};
use std::rc::Rc;

/// Bends that are tried, to both sides, in parts of the tightest; and by how much they turn until the contact. [rad]
const BENDS: [f64; 2] = [1.0, 0.5];
const BY_RAD: [f64; 3] = [0.25, 0.5, 0.12];

/// Ways in which the partner touches as it turns, the first of them with this number, nearer to the told zones than so many steps; none of
/// who walks, stands, reverses or is thrown.
pub(super) fn stagings(told: &Told, ground: &Rc<Ground>, mut trial: usize, nearer: u32) -> Vec<Staging> {
    let drives = matches!(told.cp.state, ContactState::Moving | ContactState::SettingOff);
    let wheels = VehicleSpec::of(told.cp.kind).length_m > WHEELED_M;
    if !drives || !wheels || told.thing.is_some() || told.rig.is_some() || told.is_thrown() {
        return Vec::new();
    }
    let off = |sv: ContactZone, cp: ContactZone| zones_off(&told.sv.zones, sv) + zones_off(&told.cp.zones, cp);
    let pairs: Vec<_> = zone_pairs(told).into_iter().filter(|(sv, cp)| off(*sv, *cp) < nearer).collect();
    let mut found = Vec::new();
    for sv_s_m in ground.places() {
        let Some(sv) = sv_at_contact(told, ground, sv_s_m) else { continue };
        for (came, heading) in headings(told, sv.heading, sv.heading) {
            for (curvature, by_rad) in bends(told) {
                let length_m = by_rad / curvature.abs();
                if told.swings_out(ground, by_rad * curvature.signum()) {
                    continue;
                }
                let way = Way::of(told, sv, heading, (curvature, length_m));
                for &(sv_zone, cp_zone) in &pairs {
                    for (sv_point, cp_point) in
                        points(sv_zone).iter().flat_map(|a| points(cp_zone).iter().map(move |b| (*a, *b)))
                    {
                        trial += 1;
                        let Some((cp, seen)) = way.touch(told, sv_point, cp_point) else { continue };
                        let from = back(told, cp, curvature, length_m);
                        if told.has_own_lane()
                            && math::wrap_angle(from.heading - came) * beside(came, sv, cp) > AWAY_RAD
                        {
                            continue;
                        }
                        let off = off(seen.0, seen.1);
                        let trial = trial + if swings_out(told, sv, cp, curvature) { BENT } else { 0 };
                        let bend = Some(Bend { from, length_m });
                        found.push(Staging {
                            ground: Rc::clone(ground),
                            sv_s_m,
                            sv,
                            cp,
                            cp_came: came,
                            cp_follows_m: None,
                            bend,
                            door: None,
                            cost: (off, trial),
                        });
                    }
                }
            }
        }
    }
    found
}

/// Curvatures to the left, and by how much they turn. [1/m, rad]
fn bends(told: &Told) -> impl Iterator<Item = (f64, f64)> {
    let most = 1.0 / turn_m(told);
    let [tight, wide] = BENDS;
    // Who passes does so gently, where that shows as much.
    let passes = told.passes_from_behind() || told.cp.movement == Some(Movement::Passing);
    let parts = if passes { [wide, tight] } else { [tight, wide] };
    parts
        .into_iter()
        .flat_map(move |part| [part * most, -part * most])
        .flat_map(|bend| BY_RAD.map(|by_rad| (bend, by_rad)))
}

/// Who comes by in a lane of its own does not turn away from the ego by more than this, to turn to it then. [rad]
const AWAY_RAD: f64 = 0.02;

/// On which side of the ego somebody is by the way that it came: 1 left, -1 right.
fn beside(came: f64, sv: Pose, cp: Pose) -> f64 {
    Vec2::from_heading(came).cross(cp.position - sv.position).signum()
}

/// Whether somebody who passes would swing out of the ego's lane as late as it touches: it is out by then, and comes in.
fn swings_out(told: &Told, sv: Pose, cp: Pose, curvature: f64) -> bool {
    told.passes_from_behind() && curvature * (cp.position.y - sv.position.y) > 0.0
}

/// Where somebody was so far before, whose rear axle drives on a circle.
fn back(told: &Told, centre: Pose, curvature: f64, back_m: f64) -> Pose {
    let arm_m = arm_m(told.cp.kind, size_of(&told.cp).0);
    let moved = Moved::of(arm_m, centre.heading, curvature, back_m);
    Pose { position: centre.position + moved.by, heading: centre.heading - curvature * back_m }
}

/// Somebody so far before on its circle: where it was, seen from where it comes to, and the way it faced.
#[derive(Clone, Copy)]
struct Moved {
    by: Vec2,
    axis: Vec2,
}

impl Moved {
    fn of(arm_m: f64, heading: f64, curvature: f64, back_m: f64) -> Self {
        let (turned, way) = (curvature * back_m, Vec2::from_heading);
        let chord = way(heading - 0.5 * turned) * (2.0 * math::sin(0.5 * turned) / curvature);
        let axis = way(heading - turned);
        Self { by: axis * arm_m - way(heading) * arm_m - chord, axis }
    }
}

/// Whether no bend of a line is tighter than the partner drives.
pub(crate) fn can_be_driven(told: &Told, begin: Pose, legs: &[Leg]) -> bool {
    let length_m = size_of(&told.cp).0;
    let mut course = Course::begin(arm_m(told.cp.kind, length_m));
    let curves = legs.iter().all(|leg| match leg {
        Leg::Curve { to: Place::Plane { x_m, y_m, heading_deg }, .. } => {
            let heading = heading_deg * math::PI / 180.0;
            course.curve(begin, Pose { position: Vec2::new(*x_m, *y_m), heading }, false)
        }
        _ => false,
    });
    let steps = (course.length_m() / STEP_M).ceil() as usize;
    let bent = |step: usize| course.spot(STEP_M * step as f64).curvature.abs();
    let most = 1.0 / TIGHTEST_SWEEP_M.max(TIGHTEST_LENGTHS * length_m);
    curves && (0..=steps).all(|step| bent(step) <= most)
}

/// Nobody who turns as it touches drives a tighter bend, or one tighter than so many of its lengths. [m]
const TIGHTEST_SWEEP_M: f64 = 5.0;
const TIGHTEST_LENGTHS: f64 = 0.5;

/// The partner's bend, seen from the ego that moves meanwhile: tried with many pairs of points that meet.
struct Way {
    own: OrientedBox,
    own_mps: Vec2,
    /// The partner where the bend ends: heading, and axis and size of its box.
    heading: f64,
    ends: OrientedBox,
    cp_mps: f64,
    arm_m: f64,
    curvature: f64,
    /// By steps back from [`AHEAD_M`] before its end, as far as the bend is long.
    steps: Vec<Moved>,
}

impl Way {
    fn of(told: &Told, sv: Pose, heading: f64, (curvature, length_m): (f64, f64)) -> Self {
        let ((sv_length, sv_width), (cp_length, cp_width)) = (size_of(&told.sv), size_of(&told.cp));
        let ends = OrientedBox::new(Pose { heading, ..sv }, cp_length, cp_width);
        let mut way = Self {
            own: OrientedBox::new(sv, sv_length, sv_width),
            own_mps: velocity(&told.sv, sv.heading),
            heading,
            ends,
            cp_mps: told.cp.speed_mps.max(0.1),
            arm_m: arm_m(told.cp.kind, cp_length),
            curvature,
            steps: Vec::new(),
        };
        let most = 2 * (length_m / STEP_M).ceil() as usize;
        way.steps = (0..=most).map(|step| way.moved(STEP_M * step as f64 - AHEAD_M)).collect();
        way
    }

    /// So far back, with the ego's own way taken off.
    fn moved(&self, back_m: f64) -> Moved {
        let moved = Moved::of(self.arm_m, self.heading, self.curvature, back_m);
        Moved { by: moved.by + self.own_mps * (back_m / self.cp_mps), ..moved }
    }

    /// Places the partner so that the two points meet, and takes it back along its bend to where the boxes just touch; the zones that
    /// then meet.
    fn touch(
        &self,
        told: &Told,
        sv_point: (f64, f64),
        cp_point: (f64, f64),
    ) -> Option<(Pose, (ContactZone, ContactZone))> {
        let (own, ends) = (&self.own, &self.ends);
        let met = own.to_world(Vec2::new(sv_point.0 * own.half_length, sv_point.1 * own.half_width));
        let centre =
            met - ends.axis * (cp_point.0 * ends.half_length) - ends.axis.left() * (cp_point.1 * ends.half_width);
        let at = |moved: Moved| OrientedBox { centre: centre + moved.by, axis: moved.axis, ..*ends };
        let apart = |moved: Moved| !at(moved).overlaps(own);
        if apart(self.steps[0]) {
            return None;
        }
        let most = self.steps.len() / 2;
        let clear = (1..=most).find(|step| apart(self.steps[*step]))?;
        // They stay apart on the way there.
        if self.steps[clear..=clear + most].iter().any(|moved| !apart(*moved)) {
            return None;
        }
        let (mut inside, mut outside) = (-AHEAD_M, STEP_M * clear as f64 - AHEAD_M);
        for _ in 0..30 {
            let middle = 0.5 * (inside + outside);
            if apart(self.moved(middle)) { outside = middle } else { inside = middle }
        }
        let cp = Pose { position: centre + self.moved(inside).by, heading: self.heading - self.curvature * inside };
        let touching = at(self.moved(inside - 0.02));
        let geometry = contact_geometry(own, self.own_mps, &touching, velocity(&told.cp, cp.heading));
        Some((cp, (geometry.ego_zone, geometry.other_zone)))
    }
}

/// The points meet so far ahead at most; and the way there is looked at in steps of this. [m]
const AHEAD_M: f64 = 0.1;
const STEP_M: f64 = 0.1;

/// Of ways of touching that fit alike, those are tried first to which the partner comes along a lane; more than there are ways. [trials]
pub(super) const BENT: usize = 1_000_000;
