//! Lanes: a straight or circular centre line with a width.

use crate::centreline::{Centreline, SegmentShape};
use crate::curve::Stretch;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;

/// Position of a lane in [`crate::RoadNetwork::lanes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LaneId(pub u16);

/// Position of a road in [`crate::RoadNetwork::roads`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RoadId(pub u16);

/// More than rounding takes a point off a lane. [m]
const SPARE_M: f64 = 0.01;

/// A lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lane {
    /// Its road.
    pub road: RoadId,
    /// Number on its road, 0 is the leftmost.
    pub index: u8,
    /// Centre line.
    pub centreline: Centreline,
    /// Length of the centre line. [m]
    pub length_m: f64,
    /// Width at its beginning. [m]
    pub width_m: f64,
    /// Width at its end; it changes evenly. [m]
    pub end_width_m: f64,
}

impl Lane {
    /// Width at s; beyond an end, that at the end. [m]
    #[inline]
    pub fn width_at(&self, s: f64) -> f64 {
        if self.width_m == self.end_width_m {
            return self.width_m;
        }
        self.width_m + (self.end_width_m - self.width_m) * (s / self.length_m).clamp(0.0, 1.0)
    }

    /// The point at (s, t). `s` may lie outside the lane: it is then continued.
    pub fn position(&self, s: f64, t: f64) -> Vec2 {
        match self.centreline {
            Centreline::Straight { start, heading } => {
                let forward = Vec2::from_heading(heading);
                start + forward * s - forward.left() * t
            }
            Centreline::Arc { centre, radius, start_angle, turn } => {
                centre + Vec2::from_heading(start_angle + turn * s / radius) * (radius + turn * t)
            }
        }
    }

    /// Heading of the centre line at s, in (-pi, pi]. [rad]
    pub fn heading(&self, s: f64) -> f64 {
        self.centreline.heading(s)
    }

    /// (s, t) of a point. On an arc, s is continuous around the lane's middle.
    pub fn local(&self, point: Vec2) -> (f64, f64) {
        SegmentShape::of(self).local(point)
    }

    /// Curvature of the centre line, positive to the left. [1/m]
    pub fn curvature(&self) -> f64 {
        match self.centreline {
            Centreline::Straight { .. } => 0.0,
            Centreline::Arc { radius, turn, .. } => turn / radius,
        }
    }

    /// Its centre line as a stretch of one curvature.
    pub fn stretch(&self) -> Stretch {
        let start = Pose { position: self.position(0.0, 0.0), heading: self.heading(0.0) };
        Stretch { start, curvature: self.curvature(), length_m: self.length_m }
    }

    /// Whether a point is too far off to lie on the lane: most are, of which this is told at a fraction of the price.
    pub fn is_far(&self, point: Vec2) -> bool {
        let beside_m = 0.5 * self.width_m.max(self.end_width_m) + SPARE_M;
        match self.centreline {
            Centreline::Straight { start, .. } => point.distance(start) > self.length_m + beside_m,
            Centreline::Arc { centre, radius, .. } => (point.distance(centre) - radius).abs() > beside_m,
        }
    }

    /// Whether a point lies on the lane, its edges included.
    pub fn contains(&self, point: Vec2) -> bool {
        if self.is_far(point) {
            return false;
        }
        let (s, t) = self.local(point);
        (0.0..=self.length_m).contains(&s) && t.abs() <= 0.5 * self.width_at(s)
    }

    /// The same stretch, `t` to the right. [m]
    pub(crate) fn beside(&self, t: f64) -> Self {
        match self.centreline {
            Centreline::Straight { heading, .. } => {
                Self { centreline: Centreline::Straight { start: self.position(0.0, t), heading }, ..*self }
            }
            Centreline::Arc { centre, radius, start_angle, turn } => {
                let shifted = radius + turn * t;
                Self {
                    centreline: Centreline::Arc { centre, radius: shifted, start_angle, turn },
                    length_m: self.length_m * shifted / radius,
                    ..*self
                }
            }
        }
    }

    /// The part between two places. [m]
    pub(crate) fn part(&self, from_m: f64, to_m: f64) -> Self {
        let centreline = match self.centreline {
            Centreline::Straight { heading, .. } => Centreline::Straight { start: self.position(from_m, 0.0), heading },
            Centreline::Arc { centre, radius, start_angle, turn } => {
                Centreline::Arc { centre, radius, start_angle: start_angle + turn * from_m / radius, turn }
            }
        };
        let (width_m, end_width_m) = (self.width_at(from_m), self.width_at(to_m));
        Self { centreline, length_m: to_m - from_m, width_m, end_width_m, ..*self }
    }

    /// The same stretch driven the other way.
    pub(crate) fn reversed(&self) -> Self {
        let centreline = match self.centreline {
            Centreline::Straight { heading, .. } => Centreline::Straight {
                start: self.position(self.length_m, 0.0),
                heading: math::wrap_angle(heading + math::PI),
            },
            Centreline::Arc { centre, radius, start_angle, turn } => Centreline::Arc {
                centre,
                radius,
                start_angle: math::wrap_angle(start_angle + turn * self.length_m / radius),
                turn: -turn,
            },
        };
        Self { centreline, width_m: self.end_width_m, end_width_m: self.width_m, ..*self }
    }
}

impl SegmentShape {
    /// That of a lane.
    pub fn of(lane: &Lane) -> Self {
        Self::of_line(&lane.centreline, lane.length_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_of_a_lane_is_far_from_it_and_most_others_are() {
        let straight = Centreline::Straight { start: Vec2::new(3.0, -2.0), heading: 0.7 };
        let arc = |turn: f64| Centreline::Arc { centre: Vec2::new(-4.0, 6.0), radius: 12.0, start_angle: 2.0, turn };
        for centreline in [straight, arc(1.0), arc(-1.0)] {
            let lane = Lane { road: RoadId(0), index: 0, centreline, length_m: 15.0, width_m: 3.5, end_width_m: 2.5 };
            for (s, t) in (0..=30).flat_map(|s| [-0.5, 0.0, 0.5].map(|t| (0.5 * f64::from(s), t))) {
                let point = lane.position(s, t * lane.width_at(s));
                assert!(!lane.is_far(point), "{centreline:?}, {s} m, {t}");
            }
            let around =
                (-20..20).flat_map(|x| (-20..20).map(move |y| Vec2::new(2.0 * f64::from(x), 2.0 * f64::from(y))));
            assert!(around.filter(|point| lane.is_far(*point)).count() > 1000, "{centreline:?}");
        }
    }
}
