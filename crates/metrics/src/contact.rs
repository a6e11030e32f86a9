//! Contact geometry: which zone of each box touched, and what kind of collision that is.
//!
//! Model, partition and reasons: `docs/models/contact-zones.md`.

use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::metrics::CollisionKind;
use recrash_model::polygon::ConvexPolygon;
use recrash_model::zones::ContactZone;

/// Boxes that do not overlap are moved together along the nearest line until they overlap by this. [m]
const TOUCH_DEPTH_M: f64 = 0.02;

/// Headings within this of each other are the same, within this of half a turn are opposite. [rad]
const ALIGNED_RAD: f64 = 30.0 * math::PI / 180.0;

/// Corner to corner on the same heading is a rear-end collision from this share of the narrower width on.
const REAR_END_LATERAL_SHARE: f64 = 0.5;

/// Front to front is a head-on collision from this share of the narrower width on (as in the small-overlap test).
const HEAD_ON_LATERAL_SHARE: f64 = 0.25;

/// Slower sideways motion of one vehicle relative to the other is none. [m/s]
const LATERAL_MOTION_MPS: f64 = 0.2;

/// Which zones touch, and the kind of collision. For boxes apart: those that would touch first if they were moved
/// together along the line between their nearest points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactGeometry {
    /// Zone on the ego.
    pub ego_zone: ContactZone,
    /// Zone on the other.
    pub other_zone: ContactZone,
    /// Kind of collision.
    pub kind: CollisionKind,
    /// Middle of the contact, in the world; on the ego where the boxes are apart. [m]
    pub point: Vec2,
}

/// Contact geometry of two boxes and their velocities. [m/s]
pub fn contact_geometry(
    ego: &OrientedBox,
    ego_velocity: Vec2,
    other: &OrientedBox,
    other_velocity: Vec2,
) -> ContactGeometry {
    let (moved, shared) = touching(ego, other);
    let point = shared.centroid().unwrap_or(ego.centre);
    let ego_zone = ContactZone::at(ego, point);
    let other_zone = ContactZone::at(&moved, point);
    let kind = collision_kind(ego, ego_zone, other, (&moved, other_zone), other_velocity - ego_velocity);
    ContactGeometry { ego_zone, other_zone, kind, point }
}

/// `other` where it overlaps `ego` by at least a little, moved along the nearest line, or as it is; and the part they share there.
fn touching(ego: &OrientedBox, other: &OrientedBox) -> (OrientedBox, ConvexPolygon) {
    let shared = ConvexPolygon::overlap(ego, other);
    if shared.area() > math::sq(TOUCH_DEPTH_M) {
        return (*other, shared);
    }
    let (on_ego, on_other, gap) = ego.nearest_points(other);
    let towards = if gap > 1e-9 { (on_ego - on_other) * (1.0 / gap) } else { unit(ego.centre - other.centre) };
    let moved = OrientedBox { centre: other.centre + towards * (gap.max(0.0) + TOUCH_DEPTH_M), ..*other };
    (moved, ConvexPolygon::overlap(ego, &moved))
}

fn unit(v: Vec2) -> Vec2 {
    let length = v.length();
    if length > 0.0 { v * (1.0 / length) } else { Vec2::new(1.0, 0.0) }
}

fn collision_kind(
    ego: &OrientedBox,
    ego_zone: ContactZone,
    other: &OrientedBox,
    (touching, other_zone): (&OrientedBox, ContactZone),
    relative_velocity: Vec2,
) -> CollisionKind {
    let turn = math::atan2(ego.axis.cross(other.axis), ego.axis.dot(other.axis)).abs();
    if turn <= ALIGNED_RAD {
        let share = lateral_overlap_share(ego, other);
        let sideways = relative_velocity.dot(ego.axis.left()).abs() > LATERAL_MOTION_MPS;
        // A thin overlap along the sides of two that drive side by side is no bumper in a bumper.
        let offset = other.centre - ego.centre;
        let across = ego.half_width + other.half_width - offset.dot(ego.axis.left()).abs();
        let along = ego.half_length + other.half_length - offset.dot(ego.axis).abs();
        let in_line = share >= REAR_END_LATERAL_SHARE || (share > 0.0 && !sideways && along <= across);
        return match () {
            () if in_line && ego_zone.is_front() && other_zone.is_rear() => CollisionKind::RearEndByEgo,
            () if in_line && ego_zone.is_rear() && other_zone.is_front() => CollisionKind::RearEndOfEgo,
            () => CollisionKind::Sideswipe,
        };
    }
    if turn >= math::PI - ALIGNED_RAD {
        let fronts = ego_zone.is_front() && other_zone.is_front();
        let blow = || {
            lateral_overlap_share(ego, other) >= HEAD_ON_LATERAL_SHARE
                || meets_with_ends(ego, touching, relative_velocity)
        };
        return if fronts && blow() { CollisionKind::HeadOn } else { CollisionKind::Sideswipe };
    }
    CollisionKind::Angle
}

/// Whether two who touch do so with their ends, and close on each other there by half of their relative velocity or more: corners that
/// catch each other do not slide past.
fn meets_with_ends(ego: &OrientedBox, touching: &OrientedBox, relative_velocity: Vec2) -> bool {
    let closing = -relative_velocity;
    let normal = ego.contact_normal(touching, closing);
    2.0 * math::sq(normal.dot(ego.axis)) > 1.0 && 2.0 * closing.dot(normal) >= closing.length()
}

/// How much of the narrower one's width the two share, seen along the ego's heading; negative where they are apart.
fn lateral_overlap_share(ego: &OrientedBox, other: &OrientedBox) -> f64 {
    // The bare width of the other, not its shadow: a car at 20 degrees is not twice as wide to the one behind it.
    let apart = (other.centre - ego.centre).dot(ego.axis.left()).abs();
    let shared = (ego.half_width + other.half_width - apart).min(2.0 * ego.half_width.min(other.half_width));
    shared / (2.0 * ego.half_width.min(other.half_width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactZone as Z;
    use recrash_model::geometry::Pose;

    /// 4 m x 2 m: corner zones take 1 m of the length and 0.5 m of the width.
    fn car(x: f64, y: f64, degrees: f64) -> OrientedBox {
        let heading = degrees * math::PI / 180.0;
        OrientedBox::new(Pose { position: Vec2::new(x, y), heading }, 4.0, 2.0)
    }

    /// The ego stands at the origin heading along x; both go at `speeds` along their headings.
    fn geometry(other: (f64, f64, f64), speeds: (f64, f64)) -> (Z, Z, CollisionKind) {
        let (ego, other) = (car(0.0, 0.0, 0.0), car(other.0, other.1, other.2));
        let found = contact_geometry(&ego, ego.axis * speeds.0, &other, other.axis * speeds.1);
        (found.ego_zone, found.other_zone, found.kind)
    }

    #[test]
    fn a_point_on_each_part_of_the_edge_has_its_zone() {
        let around = [
            (2.0, 0.0, Z::Front),
            (2.0, 0.4, Z::Front),
            (2.0, 0.6, Z::FrontLeft),
            (1.1, 1.0, Z::FrontLeft),
            (0.9, 1.0, Z::Left),
            (-0.9, 1.0, Z::Left),
            (-1.5, 1.0, Z::RearLeft),
            (-2.0, 0.8, Z::RearLeft),
            (-2.0, 0.0, Z::Rear),
            (-2.0, -0.6, Z::RearRight),
            (-1.1, -1.0, Z::RearRight),
            (0.0, -1.0, Z::Right),
            (1.5, -1.0, Z::FrontRight),
            (2.0, -0.8, Z::FrontRight),
        ];
        for (x, y, zone) in around {
            assert_eq!(ContactZone::at(&car(0.0, 0.0, 0.0), Vec2::new(x, y)), zone, "({x}, {y})");
            // The same on a box that lies elsewhere at another angle.
            let turned = car(30.0, -7.0, 130.0);
            assert_eq!(ContactZone::at(&turned, turned.to_world(Vec2::new(x, y))), zone, "({x}, {y}) turned");
        }
    }

    #[test]
    fn deep_inside_the_nearer_edge_decides() {
        assert_eq!(ContactZone::at(&car(0.0, 0.0, 0.0), Vec2::new(0.2, 0.3)), Z::Left);
        assert_eq!(ContactZone::at(&car(0.0, 0.0, 0.0), Vec2::new(0.2, -0.3)), Z::Right);
    }

    #[test]
    fn in_line_it_is_a_rear_end_collision() {
        assert_eq!(geometry((3.9, 0.0, 0.0), (10.0, 5.0)), (Z::Front, Z::Rear, CollisionKind::RearEndByEgo));
        assert_eq!(geometry((-3.9, 0.0, 0.0), (5.0, 10.0)), (Z::Rear, Z::Front, CollisionKind::RearEndOfEgo));
        // Shifted by 0.8 m: 60 % of the width.
        assert_eq!(geometry((3.9, 0.8, 5.0), (10.0, 5.0)).2, CollisionKind::RearEndByEgo);
    }

    #[test]
    fn oncoming_fronts_are_a_head_on_collision_and_oncoming_sides_a_sideswipe() {
        assert_eq!(geometry((3.9, 0.0, 180.0), (10.0, 5.0)), (Z::Front, Z::Front, CollisionKind::HeadOn));
        assert_eq!(geometry((3.9, 1.2, 175.0), (10.0, 5.0)), (Z::FrontLeft, Z::FrontLeft, CollisionKind::HeadOn));
        // Corners that catch each other, as the velocities say, and such that have slid past each other's ends.
        assert_eq!(geometry((3.9, 1.8, 180.0), (10.0, 5.0)), (Z::FrontLeft, Z::FrontLeft, CollisionKind::HeadOn));
        assert_eq!(geometry((3.5, 1.95, 176.0), (10.0, 5.0)), (Z::FrontLeft, Z::FrontLeft, CollisionKind::Sideswipe));
        assert_eq!(geometry((0.0, 1.9, 178.0), (10.0, 5.0)), (Z::Left, Z::Left, CollisionKind::Sideswipe));
    }

    #[test]
    fn into_the_side_is_an_angle_collision() {
        // The other comes from the right and hits the middle of the ego's right side.
        assert_eq!(geometry((0.0, -2.9, 90.0), (10.0, 5.0)), (Z::Right, Z::Front, CollisionKind::Angle));
        // The ego hits the right side of one that crosses to the right.
        assert_eq!(geometry((2.9, 0.0, -90.0), (10.0, 5.0)), (Z::Front, Z::Right, CollisionKind::Angle));
        // The ego's front left corner meets the rear left corner of one that crosses to the left.
        assert_eq!(geometry((2.9, 2.6, 90.0), (10.0, 5.0)), (Z::FrontLeft, Z::RearLeft, CollisionKind::Angle));
    }

    #[test]
    fn side_to_side_is_a_sideswipe() {
        assert_eq!(geometry((0.3, 1.95, -3.0), (10.0, 10.0)), (Z::FrontLeft, Z::Right, CollisionKind::Sideswipe));
        // Exactly side by side: the middle of the shared length.
        assert_eq!(geometry((0.0, 1.95, 0.0), (10.0, 10.0)), (Z::Left, Z::Right, CollisionKind::Sideswipe));
        assert_eq!(geometry((2.0, 1.95, 0.0), (10.0, 10.0)), (Z::FrontLeft, Z::RearRight, CollisionKind::Sideswipe));
    }

    #[test]
    fn a_cut_in_that_clips_the_corner_is_a_sideswipe_and_no_rear_end_collision() {
        // 0.2 m of overlap across (10 %), the partner moves in at 10 m/s x sin(8 deg) = 1.4 m/s.
        assert_eq!(geometry((3.9, 1.8, -8.0), (10.0, 10.0)).2, CollisionKind::Sideswipe);
        // The same place without motion across: an offset rear-end collision.
        assert_eq!(geometry((3.9, 1.8, 0.0), (10.0, 5.0)).2, CollisionKind::RearEndByEgo);
        // The partner's tail, moved in by more than half the width.
        assert_eq!(geometry((3.9, 0.5, -8.0), (10.0, 5.0)).2, CollisionKind::RearEndByEgo);
    }

    #[test]
    fn boxes_apart_are_moved_together_first() {
        // 1.5 m between the bumpers; 1.5 m between the sides; in the next lane and ahead.
        assert_eq!(geometry((5.5, 0.0, 0.0), (10.0, 5.0)), (Z::Front, Z::Rear, CollisionKind::RearEndByEgo));
        assert_eq!(geometry((0.0, 3.5, 0.0), (10.0, 5.0)), (Z::Left, Z::Right, CollisionKind::Sideswipe));
        assert_eq!(geometry((5.0, 3.5, 0.0), (10.0, 5.0)).2, CollisionKind::Sideswipe);
        assert_eq!(geometry((0.0, 3.5, 180.0), (10.0, 5.0)), (Z::Left, Z::Left, CollisionKind::Sideswipe));
    }

    #[test]
    fn heading_differences_just_inside_and_outside_thirty_degrees() {
        assert_eq!(geometry((3.6, 0.0, 29.0), (10.0, 5.0)).2, CollisionKind::RearEndByEgo);
        assert_eq!(geometry((3.6, 0.0, 31.0), (10.0, 5.0)).2, CollisionKind::Angle);
        assert_eq!(geometry((3.6, 0.0, 151.0), (10.0, 5.0)).2, CollisionKind::HeadOn);
        assert_eq!(geometry((3.6, 0.0, 149.0), (10.0, 5.0)).2, CollisionKind::Angle);
    }
}
