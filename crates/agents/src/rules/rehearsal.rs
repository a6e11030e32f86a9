//! A rehearsal: both follow their lanes as told, and nobody reacts. It shows where and how they would meet, so that a
//! design can choose lanes and timing that make the told meeting happen. The simulator has the last word.

use recrash_model::geometry::{OrientedBox, Pose};
use recrash_model::math;
use recrash_model::metrics::CollisionKind;
use recrash_model::record::ContactZone;
use recrash_model::scenario::LateralMove;
use recrash_roads::{LanePath, RoadNetwork};

/// Time step: at 20 m/s a metre. [s]
const STEP_S: f64 = 0.05;
/// Farther apart than this the gap is not looked at. [m]
const FAR_M: f64 = 25.0;
/// Part of the length, and of the width, that a corner zone takes at each end (`docs/models/contact-zones.md`).
const CORNER_SHARE: f64 = 0.25;
/// Headings this near to each other, or to opposite, are in line (same page). [rad]
const ALIGNED_RAD: f64 = 30.0 * math::PI / 180.0;

/// How one of the two moves along its path.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// Lanes it follows.
    pub path: &'a LanePath,
    /// Half the length of its box. [m]
    pub half_length_m: f64,
    /// Half its width. [m]
    pub half_width_m: f64,
    /// Start along the path. [m]
    pub start_m: f64,
    /// Speed at the start. [m/s]
    pub start_mps: f64,
    /// With which it comes to its target speed. [m/s^2]
    pub acceleration_mps2: f64,
    /// Target speed, not below the first. [m/s]
    pub target_mps: f64,
    /// Start to the right of its lane's centre. [m]
    pub start_t_m: f64,
    /// A sideways move.
    pub lateral: Option<LateralMove>,
}

impl Motion<'_> {
    /// Distance driven after a time. [m]
    pub fn driven(&self, time_s: f64) -> f64 {
        let speeding_up_s = (self.target_mps - self.start_mps).max(0.0) / self.acceleration_mps2.max(0.1);
        let early = time_s.min(speeding_up_s);
        self.start_mps * early
            + 0.5 * self.acceleration_mps2 * early * early
            + self.target_mps.max(self.start_mps) * (time_s - early)
    }

    /// Offset to the right of the lane's centre, and how fast it grows. [m, m/s]
    fn offset(&self, time_s: f64) -> (f64, f64) {
        let Some(step) = self.lateral else { return (self.start_t_m, 0.0) };
        let share = ((time_s - step.start_s) / step.duration_s.max(0.1)).clamp(0.0, 1.0);
        let rate = if share > 0.0 && share < 1.0 { (step.to_t_m - self.start_t_m) / step.duration_s } else { 0.0 };
        (self.start_t_m + share * (step.to_t_m - self.start_t_m), rate)
    }

    fn outline(&self, network: &RoadNetwork, time_s: f64) -> OrientedBox {
        let (t, rate) = self.offset(time_s);
        let pose = self.path.pose(network, self.start_m + self.driven(time_s), t);
        let drift = math::atan2(-rate, self.target_mps.max(1.0));
        let pose = Pose { heading: pose.heading + drift, ..pose };
        OrientedBox::new(pose, 2.0 * self.half_length_m, 2.0 * self.half_width_m)
    }
}

/// How the two met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// When they touched, or came closest. [s]
    pub time_s: f64,
    /// Gap between the boxes then; nil where they touched. [m]
    pub gap_m: f64,
    /// Zone on the ego.
    pub ego_zone: ContactZone,
    /// Zone on the partner.
    pub partner_zone: ContactZone,
    /// How far each had turned by then, left positive. [rad]
    pub ego_turned: f64,
    /// How far the partner had turned.
    pub partner_turned: f64,
    /// How far the partner had moved sideways out of its lane. [m]
    pub partner_shifted_m: f64,
    /// Kind of collision, where it is one that profiles exclude.
    pub kind: Option<CollisionKind>,
}

/// Lets both drive and tells how they meet between two times.
pub fn rehearse(network: &RoadNetwork, ego: &Motion, partner: &Motion, from_s: f64, until_s: f64) -> Option<Meeting> {
    let at_start = (ego.outline(network, 0.0), partner.outline(network, 0.0));
    let mut closest: Option<(f64, f64)> = None;
    let steps = ((until_s - from_s) / STEP_S).ceil().clamp(0.0, 2000.0) as u32;
    for step in 0..=steps {
        let time_s = from_s.max(0.0) + f64::from(step) * STEP_S;
        let (a, b) = (ego.outline(network, time_s), partner.outline(network, time_s));
        if a.centre.distance(b.centre) > FAR_M {
            continue;
        }
        let gap = if a.overlaps(&b) { 0.0 } else { a.nearest_points(&b).2 };
        if closest.is_none_or(|(least, _)| gap < least) {
            closest = Some((gap, time_s));
        }
        if gap <= 0.0 {
            break;
        }
    }
    let (gap_m, time_s) = closest?;
    // The last moment apart shows where they touch.
    let moment = if gap_m > 0.0 { time_s } else { (time_s - STEP_S).max(0.0) };
    let (a, b) = (ego.outline(network, moment), partner.outline(network, moment));
    let (on_ego, on_partner, _) = a.nearest_points(&b);
    let (ego_zone, partner_zone) = (zone_of(&a, on_ego), zone_of(&b, on_partner));
    let turned = |from: &OrientedBox, to: &OrientedBox| math::atan2(from.axis.cross(to.axis), from.axis.dot(to.axis));
    Some(Meeting {
        time_s,
        gap_m,
        ego_zone,
        partner_zone,
        ego_turned: turned(&at_start.0, &a),
        partner_turned: turned(&at_start.1, &b),
        partner_shifted_m: (partner.offset(moment).0 - partner.start_t_m).abs(),
        kind: kind_of(&a, ego_zone, &b, partner_zone),
    })
}

/// The zone of a point on a box's edge.
fn zone_of(outline: &OrientedBox, point: recrash_model::geometry::Vec2) -> ContactZone {
    let local = outline.to_local(point);
    let end = local.x.abs() >= outline.half_length * (1.0 - 2.0 * CORNER_SHARE);
    let side = local.y.abs() >= outline.half_width * (1.0 - 2.0 * CORNER_SHARE);
    match (end, side, local.x >= 0.0, local.y >= 0.0) {
        (true, true, true, true) => ContactZone::FrontLeft,
        (true, true, true, false) => ContactZone::FrontRight,
        (true, true, false, true) => ContactZone::RearLeft,
        (true, true, false, false) => ContactZone::RearRight,
        (true, false, true, _) => ContactZone::Front,
        (true, false, false, _) => ContactZone::Rear,
        (false, _, _, true) => ContactZone::Left,
        (false, _, _, false) => ContactZone::Right,
    }
}

fn kind_of(
    ego: &OrientedBox,
    ego_zone: ContactZone,
    partner: &OrientedBox,
    partner_zone: ContactZone,
) -> Option<CollisionKind> {
    use super::reading::{is_front, is_rear};
    let turn = math::atan2(ego.axis.cross(partner.axis), ego.axis.dot(partner.axis)).abs();
    let apart = (partner.centre - ego.centre).dot(ego.axis.left()).abs();
    let in_line = apart < ego.half_width + partner.half_width - 0.4 * ego.half_width;
    if turn <= ALIGNED_RAD && in_line {
        if is_front(ego_zone) && is_rear(partner_zone) {
            return Some(CollisionKind::RearEndByEgo);
        }
        if is_rear(ego_zone) && is_front(partner_zone) {
            return Some(CollisionKind::RearEndOfEgo);
        }
    }
    let head_on = turn >= math::PI - ALIGNED_RAD && is_front(ego_zone) && is_front(partner_zone) && in_line;
    head_on.then_some(CollisionKind::HeadOn)
}
