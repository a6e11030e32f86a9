//! Two boxes: where they may be touched, and where one just touches the other.

use crate::told::crash::Told;
use crate::told::lies::Lies;
use crate::told::rig::Rig;
use crate::told::side::{Side, size_of};
use crate::told::zones::zones_off;
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::{ContactState, LeftRight};
use recrash_model::geometry::{OrientedBox, Pose, Shadows, Vec2};
use recrash_model::zones::ContactZone;

/// Points of a box's outline, by zone, where it may be touched: shares of half of its length and width.
pub(super) fn points(zone: ContactZone) -> &'static [(f64, f64)] {
    match zone {
        ContactZone::Front => &[(1.0, 0.0), (1.0, 0.3), (1.0, -0.3)],
        ContactZone::FrontLeft => &[(1.0, 1.0), (1.0, 0.75), (0.75, 1.0)],
        ContactZone::Left => &[(0.0, 1.0), (0.35, 1.0), (-0.35, 1.0)],
        ContactZone::RearLeft => &[(-1.0, 1.0), (-1.0, 0.75), (-0.75, 1.0)],
        ContactZone::Rear => &[(-1.0, 0.0), (-1.0, 0.3), (-1.0, -0.3)],
        ContactZone::RearRight => &[(-1.0, -1.0), (-1.0, -0.75), (-0.75, -1.0)],
        ContactZone::Right => &[(0.0, -1.0), (0.35, -1.0), (-0.35, -1.0)],
        ContactZone::FrontRight => &[(1.0, -1.0), (1.0, -0.75), (0.75, -1.0)],
        ContactZone::Top | ContactZone::Bottom => &[],
    }
}

/// Zones to try: the told ones, or all where none is told; then the neighbours of told ones, since a zone is told to a step.
pub(super) fn zone_pairs(told: &Told) -> Vec<(ContactZone, ContactZone)> {
    if let Some(pair) = across(told) {
        return vec![pair];
    }
    let all = || ContactZone::ALL[..8].to_vec();
    let of = |zones: &[ContactZone]| if zones.is_empty() { all() } else { zones.to_vec() };
    let near = |zones: &[ContactZone]| -> Vec<ContactZone> {
        all().into_iter().filter(|zone| !zones.contains(zone) && zones_off(zones, *zone) == 1).collect()
    };
    let flanks = [ContactZone::Left, ContactZone::Right];
    let (sv, cp) = (of(&told.sv.zones), if told.stands_across() { flanks.to_vec() } else { of(&told.cp.zones) });
    let (sv_near, cp_near) = (near(&told.sv.zones), near(&told.cp.zones));
    let mut pairs = Vec::new();
    if told.meets_chain().is_some() {
        pairs.extend(sv.iter().map(|zone| (*zone, ContactZone::Rear)));
    }
    for (first, second) in [(&sv, &cp), (&sv, &cp_near), (&sv_near, &cp), (&sv_near, &cp_near)] {
        pairs.extend(first.iter().flat_map(|&a| second.iter().map(move |&b| (a, b))));
    }
    pairs
}

/// Velocity at the contact. [m/s]
pub(super) fn velocity(side: &Side, heading: f64) -> Vec2 {
    velocity_along(side, Vec2::from_heading(heading))
}

/// The same of who faces along this. [m/s]
fn velocity_along(side: &Side, axis: Vec2) -> Vec2 {
    let backwards = if side.state == ContactState::Reversing { -1.0 } else { 1.0 };
    axis * (backwards * side.speed_mps)
}

/// The two with these headings, who close on each other: tried with many pairs of points that meet.
pub(super) struct Meeting {
    own: OrientedBox,
    /// The partner, wherever it is, and what it draws; its heading.
    other: OrientedBox,
    rig: Option<Rig>,
    heading: f64,
    /// Of the ego, and of the partner. [m/s]
    velocities: (Vec2, Vec2),
    /// The way by which the partner comes, seen from the ego.
    way: Vec2,
    /// When the two boxes overlap: never where their middles are farther apart. [m]
    shadows: Shadows,
    reach_m: f64,
}

impl Meeting {
    /// Nothing where the one does not come nearer to the other.
    pub(super) fn of(told: &Told, sv: Pose, heading: f64) -> Option<Self> {
        let (sv_length, sv_width) = size_of(&told.sv);
        let (cp_length, cp_width) =
            told.rig.map_or_else(|| size_of(&told.cp), |rig| (rig.trailer.length_m, rig.trailer.width_m));
        let own = OrientedBox::new(sv, sv_length, sv_width);
        let other = OrientedBox::new(Pose { heading, ..sv }, cp_length, cp_width);
        let velocities = (velocity_along(&told.sv, own.axis), velocity_along(&told.cp, other.axis));
        let closing = velocities.1 - velocities.0;
        let speed = closing.length();
        let way = closing * (1.0 / speed);
        let (shadows, reach_m) = (Shadows::of(&other, &own), other.radius() + own.radius());
        (speed >= 0.05).then_some(Self { own, other, rig: told.rig, heading, velocities, way, shadows, reach_m })
    }

    /// Places the partner so that the two points meet, and takes it back to where the boxes just touch; the zones that then
    /// meet. `None` where they do not close on each other there.
    pub(super) fn touch(&self, sv_point: (f64, f64), cp_point: (f64, f64)) -> Option<(Pose, ContactZone, ContactZone)> {
        let (own, other) = (&self.own, &self.other);
        let met = own.to_world(Vec2::new(sv_point.0 * own.half_length, sv_point.1 * own.half_width));
        let centre =
            met - other.axis * (cp_point.0 * other.half_length) - other.axis.left() * (cp_point.1 * other.half_width);
        let at = |back_m: f64| centre - self.way * back_m;
        let (inside, outside) = self.just_touching(at)?;
        // They stay apart on the way there.
        if (1..=12).any(|step| self.overlap(at(outside + 0.25 * f64::from(step)))) {
            return None;
        }
        let at = |back_m: f64| OrientedBox { centre: at(back_m), ..*other };
        // Who draws a trailer gets by.
        let gets_by = |rig: Rig| (0..=60).all(|step| !rig.tractor(&at(inside + 0.25 * f64::from(step))).overlaps(own));
        if !self.rig.is_none_or(gets_by) {
            return None;
        }
        let touching = at(inside - 0.01);
        let geometry = contact_geometry(own, self.velocities.0, &touching, self.velocities.1);
        let cp = pose(self.rig, Pose { position: at(inside).centre, heading: self.heading });
        let cp_zone = self.rig.map_or(geometry.other_zone, |rig| rig.zone(&touching, &geometry));
        Some((cp, geometry.ego_zone, cp_zone))
    }

    /// Whether the two overlap, with the partner's middle here.
    fn overlap(&self, centre: Vec2) -> bool {
        let apart = self.own.centre - centre;
        apart.length_squared() <= self.reach_m * self.reach_m && self.shadows.meet(apart)
    }

    /// How far back the partner just touches, and how far it is just apart; nothing where it is not both. [m]
    fn just_touching(&self, at: impl Fn(f64) -> Vec2) -> Option<(f64, f64)> {
        let overlap = |back_m: f64| self.overlap(at(back_m));
        // Apart some way back, together here or a little later.
        let (mut inside, mut outside) = (-0.05, None);
        if !overlap(inside) {
            return None;
        }
        for step in 1..=24 {
            let back_m = -0.05 + 0.1 * f64::from(step);
            if !overlap(back_m) {
                outside = Some(back_m);
                break;
            }
            inside = back_m;
        }
        let mut outside = outside?;
        for _ in 0..30 {
            let middle = 0.5 * (inside + outside);
            if overlap(middle) { inside = middle } else { outside = middle }
        }
        Some((inside, outside))
    }
}

/// The zones that meet where something lies across the ego's way.
fn across(told: &Told) -> Option<(ContactZone, ContactZone)> {
    told.lies.and_then(Lies::size)?;
    Some(match told.sv.state {
        ContactState::Reversing => (ContactZone::Rear, ContactZone::Front),
        _ => (ContactZone::Front, ContactZone::Rear),
    })
}

/// Points of the ego's outline that are touched: by a hole where its wheels are.
pub(super) fn sv_points(told: &Told, zone: ContactZone) -> &'static [(f64, f64)] {
    match (told.lies, zone) {
        (Some(Lies::Hole), ContactZone::Front) => &[(1.0, 0.75), (1.0, -0.75)],
        (Some(Lies::Hole), ContactZone::FrontLeft) => &[(1.0, 0.75)],
        (Some(Lies::Hole), ContactZone::FrontRight) => &[(1.0, -0.75)],
        (Some(Lies::Bump | Lies::Edge | Lies::Water), _) => &points(zone)[..1],
        _ => points(zone),
    }
}

/// Points of the partner's outline that are touched: of a hole the middle of a side.
pub(super) fn cp_points(told: &Told, zone: ContactZone) -> &'static [(f64, f64)] {
    match (told.lies, zone) {
        (Some(Lies::Hole), ContactZone::Rear | ContactZone::Front) => &points(zone)[..1],
        (Some(Lies::Hole), _) => &[],
        _ if told.stands_across() => &points(zone)[..1],
        // Its end.
        _ if let Some(side) = told.reaches_in => match (side, zone) {
            (LeftRight::Right, ContactZone::RearLeft) | (LeftRight::Left, ContactZone::RearRight) => {
                &points(zone)[1..2]
            }
            _ => &[],
        },
        // Its middle hangs over the middle of the lane.
        (None, ContactZone::Rear) if told.meets_chain() == Some(LeftRight::Left) => &[(-1.0, 0.45)],
        (None, ContactZone::Rear) if told.meets_chain() == Some(LeftRight::Right) => &[(-1.0, -0.45)],
        _ => points(zone),
    }
}

/// The pose of who draws a trailer that is here.
fn pose(rig: Option<Rig>, trailer: Pose) -> Pose {
    let ahead_m = rig.map_or(0.0, |rig| rig.ahead_m());
    Pose { position: trailer.position + Vec2::from_heading(trailer.heading) * ahead_m, ..trailer }
}
