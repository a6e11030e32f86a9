//! Small convex polygons on the stack: cut by half-planes, area and centroid.

use crate::geometry::{OrientedBox, Vec2};

/// A box cut by eight half-planes has twelve corners at most.
const CAPACITY: usize = 16;

/// A convex polygon, anticlockwise, of sixteen corners at most.
#[derive(Debug, Clone, Copy)]
pub struct ConvexPolygon {
    corners: [Vec2; CAPACITY],
    len: usize,
}

impl ConvexPolygon {
    /// From four corners, anticlockwise.
    pub fn quad(corners: [Vec2; 4]) -> Self {
        let mut all = [Vec2::default(); CAPACITY];
        all[..4].copy_from_slice(&corners);
        Self { corners: all, len: 4 }
    }

    /// The corners, anticlockwise; empty where nothing is left.
    pub fn corners(&self) -> &[Vec2] {
        &self.corners[..self.len]
    }

    /// What is left on the side where `normal . p <= limit` (Sutherland and Hodgman 1974).
    #[must_use]
    pub fn cut(&self, normal: Vec2, limit: f64) -> Self {
        let mut out = Self { corners: [Vec2::default(); CAPACITY], len: 0 };
        for i in 0..self.len {
            let here = self.corners[i];
            let next = self.corners[if i + 1 == self.len { 0 } else { i + 1 }];
            let (depth_here, depth_next) = (normal.dot(here) - limit, normal.dot(next) - limit);
            if depth_here <= 0.0 {
                out.push(here);
            }
            if (depth_here < 0.0 && depth_next > 0.0) || (depth_here > 0.0 && depth_next < 0.0) {
                out.push(here + (next - here) * (depth_here / (depth_here - depth_next)));
            }
        }
        out
    }

    /// The part two boxes share.
    pub fn overlap(a: &OrientedBox, b: &OrientedBox) -> Self {
        let mut polygon = Self::quad(a.corners());
        for (axis, half) in [(b.axis, b.half_length), (b.axis.left(), b.half_width)] {
            let at = axis.dot(b.centre);
            polygon = polygon.cut(axis, at + half).cut(-axis, half - at);
        }
        polygon
    }

    /// Area. [m^2]
    pub fn area(&self) -> f64 {
        let origin = self.corners[0];
        (1..self.len.saturating_sub(1))
            .map(|i| 0.5 * (self.corners[i] - origin).cross(self.corners[i + 1] - origin))
            .sum()
    }

    /// Centre of the area; the mean of the corners where the area is nil; `None` where nothing is left.
    pub fn centroid(&self) -> Option<Vec2> {
        if self.len == 0 {
            return None;
        }
        let origin = self.corners[0];
        let (mut weighted, mut doubled_area) = (Vec2::default(), 0.0);
        for i in 1..self.len.saturating_sub(1) {
            let (a, b) = (self.corners[i] - origin, self.corners[i + 1] - origin);
            let part = a.cross(b);
            weighted = weighted + (a + b) * part;
            doubled_area += part;
        }
        if doubled_area > 1e-12 {
            return Some(origin + weighted * (1.0 / (3.0 * doubled_area)));
        }
        self.mean_corner()
    }

    /// The mean of the corners; `None` where nothing is left.
    pub fn mean_corner(&self) -> Option<Vec2> {
        let sum = self.corners().iter().fold(Vec2::default(), |sum, &corner| sum + corner);
        (self.len > 0).then(|| sum * (1.0 / self.len as f64))
    }

    /// A corner that would not fit is left out: it cannot happen with eight cuts of a box, and must not panic.
    fn push(&mut self, corner: Vec2) {
        if self.len < CAPACITY {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::math;

    fn boxed(x: f64, y: f64, heading: f64, length: f64, width: f64) -> OrientedBox {
        OrientedBox::new(Pose { position: Vec2::new(x, y), heading }, length, width)
    }

    #[test]
    fn overlap_of_two_shifted_boxes_is_their_common_rectangle() {
        let common = ConvexPolygon::overlap(&boxed(0.0, 0.0, 0.0, 4.0, 2.0), &boxed(3.0, 1.0, 0.0, 4.0, 2.0));
        assert!((common.area() - 1.0).abs() < 1e-12);
        let centre = common.centroid().unwrap();
        assert!(centre.distance(Vec2::new(1.5, 0.5)) < 1e-12, "{centre:?}");
    }

    #[test]
    fn overlap_of_a_cross_is_the_square_in_the_middle() {
        let common =
            ConvexPolygon::overlap(&boxed(0.0, 0.0, 0.0, 6.0, 2.0), &boxed(0.5, 0.0, math::FRAC_PI_2, 6.0, 2.0));
        assert!((common.area() - 4.0).abs() < 1e-12);
        assert!(common.centroid().unwrap().distance(Vec2::new(0.5, 0.0)) < 1e-12);
    }

    #[test]
    fn overlap_with_a_square_turned_by_45_degrees_is_a_regular_octagon() {
        let common =
            ConvexPolygon::overlap(&boxed(0.0, 0.0, 0.0, 2.0, 2.0), &boxed(0.0, 0.0, math::PI / 4.0, 2.0, 2.0));
        assert_eq!(common.corners().len(), 8);
        assert!((common.area() - 8.0 * (2.0_f64.sqrt() - 1.0)).abs() < 1e-12, "{}", common.area());
    }

    #[test]
    fn boxes_apart_share_nothing() {
        let common = ConvexPolygon::overlap(&boxed(0.0, 0.0, 0.0, 4.0, 2.0), &boxed(9.0, 1.0, 0.3, 4.0, 2.0));
        assert_eq!(common.centroid(), None);
        assert_eq!(common.area(), 0.0);
    }
}
