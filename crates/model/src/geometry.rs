//! Plane geometry: vectors, poses and oriented boxes.
//!
//! x points forward along the first road, y to the left, headings are radians anticlockwise from +x. [m, rad]

use crate::math;
use serde::{Deserialize, Serialize};
use std::ops::{Add, Mul, Neg, Sub};

/// A vector in the plane. [m]
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Vec2 {
    /// Forward.
    pub x: f64,
    /// Left.
    pub y: f64,
}

impl Vec2 {
    /// From its parts.
    #[inline]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The unit vector of a heading.
    #[inline]
    pub fn from_heading(heading: f64) -> Self {
        let (sin, cos) = math::sincos(heading);
        Self::new(cos, sin)
    }

    /// Inner product.
    #[inline]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The z part of the cross product: positive where `other` is to the left of `self`.
    #[inline]
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// Turned by 90 degrees to the left.
    #[inline]
    pub fn left(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Turned by an angle to the left. [rad]
    #[inline]
    pub fn turned(self, angle: f64) -> Self {
        let forward = Self::from_heading(angle);
        forward * self.x + forward.left() * self.y
    }

    /// Length squared.
    #[inline]
    pub fn length_squared(self) -> f64 {
        self.dot(self)
    }

    /// Length.
    #[inline]
    pub fn length(self) -> f64 {
        self.length_squared().sqrt()
    }

    /// Distance to another point.
    #[inline]
    pub fn distance(self, other: Self) -> f64 {
        (self - other).length()
    }
}

impl Add for Vec2 {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y)
    }
}
impl Sub for Vec2 {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y)
    }
}
impl Mul<f64> for Vec2 {
    type Output = Self;
    #[inline]
    fn mul(self, k: f64) -> Self {
        Self::new(self.x * k, self.y * k)
    }
}
impl Neg for Vec2 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}

/// Position and heading.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the centre of the box. [m]
    pub position: Vec2,
    /// Anticlockwise from +x. [rad]
    pub heading: f64,
}

/// A rectangle at any angle: the outline of a vehicle, a cone, a pedestrian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Centre. [m]
    pub centre: Vec2,
    /// Unit vector forward.
    pub axis: Vec2,
    /// Half of the length, along `axis`. [m]
    pub half_length: f64,
    /// Half of the width. [m]
    pub half_width: f64,
}

/// The longest physics step in which a run is made: boxes that touch now were apart so long before. [s]
const TOUCH_S: f64 = 0.025;

/// By so much two boxes may come to overlap within a step without closing: by turning, or by rounding. [m]
const SLACK_M: f64 = 0.01;

/// The shadows of two boxes in a direction that leads from the one to the other.
struct Touch {
    normal: Vec2,
    closing_mps: f64,
    /// Since when they overlap. [s]
    age_s: f64,
    /// By how much they overlapped a physics step before. [m]
    before_m: f64,
}

impl OrientedBox {
    /// The box of an actor of this size at this pose. Length and width in m.
    #[inline]
    pub fn new(pose: Pose, length: f64, width: f64) -> Self {
        Self {
            centre: pose.position,
            axis: Vec2::from_heading(pose.heading),
            half_length: 0.5 * length,
            half_width: 0.5 * width,
        }
    }

    /// The corners, anticlockwise from front left: front left, rear left, rear right, front right.
    #[inline]
    pub fn corners(&self) -> [Vec2; 4] {
        let f = self.axis * self.half_length;
        let l = self.axis.left() * self.half_width;
        [self.centre + f + l, self.centre - f + l, self.centre - f - l, self.centre + f - l]
    }

    /// A point in the box's own frame: x forward, y left of the centre.
    #[inline]
    pub fn to_local(&self, point: Vec2) -> Vec2 {
        let d = point - self.centre;
        Vec2::new(d.dot(self.axis), d.dot(self.axis.left()))
    }

    /// A point given in the box's own frame, in the world.
    #[inline]
    pub fn to_world(&self, local: Vec2) -> Vec2 {
        self.centre + self.axis * local.x + self.axis.left() * local.y
    }

    /// Radius of the circle around the box. [m]
    #[inline]
    pub fn radius(&self) -> f64 {
        (math::sq(self.half_length) + math::sq(self.half_width)).sqrt()
    }

    /// Whether the boxes share a point (separating axis theorem; touching counts).
    #[inline]
    pub fn overlaps(&self, other: &Self) -> bool {
        let d = other.centre - self.centre;
        let reach = self.radius() + other.radius();
        d.length_squared() <= reach * reach && Shadows::of(self, other).meet(d)
    }

    /// How far one of the boxes would have to move for them to be apart, 0 where they are. [m]
    pub fn depth(&self, other: &Self) -> f64 {
        let [along, across, along_other, across_other] = self.axis_overlaps(other);
        along.min(across).min(along_other).min(across_other).max(0.0)
    }

    /// By how much their shadows overlap on the two axes of each box; negative where they are apart. [m]
    #[inline]
    fn axis_overlaps(&self, other: &Self) -> [f64; 4] {
        Shadows::of(self, other).overlaps_m(other.centre - self.centre)
    }

    /// Half of its shadow in a direction. [m]
    pub fn reach(&self, direction: Vec2) -> f64 {
        self.half_length * self.axis.dot(direction).abs() + self.half_width * self.axis.left().dot(direction).abs()
    }

    /// Normal of the plane in which two boxes touch, from this one to the other: of the four sides' directions, the one on
    /// which their shadows came to overlap last, by the velocity of this one less that of the other.
    ///
    /// Boxes that touch were apart one physics step before, so a direction whose shadows overlap for longer is none on which
    /// they can have met. Where none is younger (flanks that slide along each other, a turn that brought them together), it is
    /// the direction on which they overlapped least a step before.
    pub fn contact_normal(&self, other: &Self, relative: Vec2) -> Vec2 {
        let apart = other.centre - self.centre;
        let touch = |direction: Vec2| {
            let normal = if apart.dot(direction) < 0.0 { -direction } else { direction };
            let depth_m = self.reach(normal) + other.reach(normal) - apart.dot(normal);
            let closing_mps = relative.dot(normal);
            Touch { normal, closing_mps, age_s: depth_m / closing_mps, before_m: depth_m - closing_mps * TOUCH_S }
        };
        let touches = [self.axis, self.axis.left(), other.axis, other.axis.left()].map(touch);
        let young = touches.iter().filter(|touch| touch.closing_mps > 1e-6 && touch.before_m <= SLACK_M);
        let last = young.min_by(|a, b| a.age_s.total_cmp(&b.age_s));
        let last = last.or_else(|| touches.iter().min_by(|a, b| a.before_m.total_cmp(&b.before_m)));
        last.map_or(self.axis, |touch| touch.normal)
    }

    /// The distance between the boxes, 0 when they touch or overlap. [m]
    pub fn gap(&self, other: &Self) -> f64 {
        if self.overlaps(other) {
            return 0.0;
        }
        self.nearest_points(other).2
    }

    /// The nearest points of two boxes that do not overlap, on self and on other, and their distance. [m]
    ///
    /// Two separate rectangles are nearest at a corner of one of them, so eight point-to-box distances suffice.
    pub fn nearest_points(&self, other: &Self) -> (Vec2, Vec2, f64) {
        let mut best = (self.centre, other.centre, f64::INFINITY);
        for corner in other.corners() {
            let near = self.clamp(corner);
            let distance = near.distance(corner);
            if distance < best.2 {
                best = (near, corner, distance);
            }
        }
        for corner in self.corners() {
            let near = other.clamp(corner);
            let distance = near.distance(corner);
            if distance < best.2 {
                best = (corner, near, distance);
            }
        }
        best
    }

    /// The point of the box nearest to `point`.
    fn clamp(&self, point: Vec2) -> Vec2 {
        let local = self.to_local(point);
        self.to_world(Vec2::new(
            local.x.clamp(-self.half_length, self.half_length),
            local.y.clamp(-self.half_width, self.half_width),
        ))
    }
}

/// The shadows of two boxes that keep their headings, on the two axes of each: what does not change as one moves past the other.
#[derive(Debug, Clone, Copy)]
pub struct Shadows {
    /// Each axis, with half of both shadows on it. [m]
    axes: [(Vec2, f64); 4],
}

impl Shadows {
    /// Those of two boxes, wherever they are.
    #[inline]
    pub fn of(one: &OrientedBox, other: &OrientedBox) -> Self {
        let c = one.axis.dot(other.axis).abs();
        let s = one.axis.cross(other.axis).abs();
        let (own_l, own_w) = (one.half_length, one.half_width);
        let (other_l, other_w) = (other.half_length, other.half_width);
        let axes = [
            (one.axis, own_l + other_l * c + other_w * s),
            (one.axis.left(), own_w + other_l * s + other_w * c),
            (other.axis, other_l + own_l * c + own_w * s),
            (other.axis.left(), other_w + own_l * s + own_w * c),
        ];
        Self { axes }
    }

    /// By how much they overlap on each axis, with the second box so far from the first; negative where they are apart. [m]
    #[inline]
    fn overlaps_m(&self, apart: Vec2) -> [f64; 4] {
        let on = |(axis, half_m): (Vec2, f64)| half_m - apart.dot(axis).abs();
        let [along, across, along_other, across_other] = self.axes;
        [on(along), on(across), on(along_other), on(across_other)]
    }

    /// Whether the boxes share a point, with the second so far from the first (separating axis theorem; touching counts).
    #[inline]
    pub fn meet(&self, apart: Vec2) -> bool {
        let [along, across, along_other, across_other] = self.overlaps_m(apart);
        along >= 0.0 && across >= 0.0 && along_other >= 0.0 && across_other >= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxed(x: f64, y: f64, heading: f64) -> OrientedBox {
        OrientedBox::new(Pose { position: Vec2::new(x, y), heading }, 4.0, 2.0)
    }

    #[test]
    fn gap_of_boxes_in_line_is_the_free_space_between_bumpers() {
        assert_eq!(boxed(0.0, 0.0, 0.0).gap(&boxed(10.0, 0.0, 0.0)), 6.0);
    }

    #[test]
    fn gap_of_boxes_side_by_side() {
        assert_eq!(boxed(0.0, 0.0, 0.0).gap(&boxed(1.0, 5.0, 0.0)), 3.0);
    }

    #[test]
    fn gap_of_a_crossing_box_counts_its_half_length() {
        let gap = boxed(0.0, 0.0, 0.0).gap(&boxed(0.0, 6.0, math::FRAC_PI_2));
        assert!((gap - 3.0).abs() < 1e-12, "{gap}");
    }

    #[test]
    fn gap_corner_to_corner_is_a_hypotenuse() {
        let gap = boxed(0.0, 0.0, 0.0).gap(&boxed(7.0, 6.0, 0.0));
        assert!((gap - 5.0).abs() < 1e-12, "{gap}");
    }

    #[test]
    fn depth_is_the_way_out_of_one_another() {
        let at = |x: f64, y: f64, heading: f64| OrientedBox::new(Pose { position: Vec2::new(x, y), heading }, 4.0, 2.0);
        assert!((at(0.0, 0.0, 0.0).depth(&at(3.7, 0.5, 0.0)) - 0.3).abs() < 1e-12);
        assert!((at(0.0, 0.0, 0.0).depth(&at(0.5, 1.9, 0.0)) - 0.1).abs() < 1e-12);
        assert!((at(0.0, 0.0, 0.0).depth(&at(2.8, 0.0, math::FRAC_PI_2)) - 0.2).abs() < 1e-12);
        assert_eq!(at(0.0, 0.0, 0.0).depth(&at(4.1, 0.0, 0.0)), 0.0);
    }

    #[test]
    fn a_flank_that_slides_along_a_corner_touches_with_its_side() {
        let ego = OrientedBox::new(Pose { position: Vec2::new(-1e-6, 0.0), heading: 0.0 }, 4.515, 1.852);
        // As it was recorded in a reconstruction: 4 degrees to the ego, beside it, and along its own heading.
        let pose = Pose { position: Vec2::new(-2.1727780110805615, 1.9574224003236895), heading: 0.06981317007977324 };
        let partner = OrientedBox::new(pose, 4.87, 2.046);
        assert!(ego.overlaps(&partner) && ego.depth(&partner) < 1e-4);
        for drift_mps in [-0.4, -0.001, 0.0, 0.001, 0.2] {
            let velocity = partner.axis * 7.82 - partner.axis.left() * drift_mps;
            let normal = ego.contact_normal(&partner, -velocity);
            assert!((normal - partner.axis.left()).length() < 1e-9, "{drift_mps}: {normal:?}");
        }
    }

    #[test]
    fn a_bumper_that_came_in_within_the_step_is_an_end_also_beside_a_thin_overlap_of_flanks() {
        let (behind, ahead) = (boxed(-3.9, 1.7, 0.0), boxed(0.0, 0.0, 0.0));
        assert_eq!(behind.contact_normal(&ahead, Vec2::new(8.0, 0.0)), Vec2::new(1.0, 0.0));
        // The same overlap, of which the ends are older than a step: the flanks came together.
        let slides = Vec2::new(2.0, -0.5);
        assert_eq!(boxed(-3.9, 1.995, 0.0).contact_normal(&ahead, slides), Vec2::new(0.0, -1.0));
    }

    #[test]
    fn what_turning_alone_brought_together_touches_where_it_overlapped_least() {
        // A rear that swings out: 4 cm into the flank beside it, at no velocity of the centre towards it.
        let (still, swings) = (boxed(0.0, 0.0, 0.0), boxed(1.0, 1.96, 0.0));
        assert_eq!(swings.contact_normal(&still, Vec2::new(6.0, 0.0)), Vec2::new(0.0, -1.0));
    }

    #[test]
    fn boxes_that_keep_their_headings_meet_where_they_overlap() {
        let (still, mut moves) = (boxed(1.0, 2.0, 0.4), boxed(0.0, 0.0, 2.1));
        let shadows = Shadows::of(&still, &moves);
        let mut met = 0;
        for (x, y) in (0..20).flat_map(|x| (0..20).map(move |y| (f64::from(x) * 0.5 - 4.0, f64::from(y) * 0.5 - 3.0))) {
            moves.centre = Vec2::new(x, y);
            let meet = shadows.meet(moves.centre - still.centre);
            assert_eq!(meet, still.overlaps(&moves), "({x}, {y})");
            met += usize::from(meet);
        }
        assert!((20..200).contains(&met), "{met}");
    }

    #[test]
    fn a_cross_of_two_boxes_overlaps_although_no_corner_is_inside() {
        let long = OrientedBox::new(Pose::default(), 10.0, 1.0);
        let across = OrientedBox::new(Pose { position: Vec2::default(), heading: math::FRAC_PI_2 }, 10.0, 1.0);
        assert!(long.overlaps(&across));
        assert_eq!(long.gap(&across), 0.0);
    }
}
