//! Centre lines: straight or circular, and the same prepared for fast look-ups.

use recrash_model::geometry::Vec2;
use recrash_model::math;

/// A centre line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Centreline {
    /// A straight line.
    Straight {
        /// Beginning. [m]
        start: Vec2,
        /// Heading. [rad]
        heading: f64,
    },
    /// A circular arc.
    Arc {
        /// Centre of the circle. [m]
        centre: Vec2,
        /// Radius. [m]
        radius: f64,
        /// Angle of the beginning, seen from the centre. [rad]
        start_angle: f64,
        /// +1 anticlockwise (a left curve), -1 clockwise.
        turn: f64,
    },
}

impl Centreline {
    /// Its heading at s, in (-pi, pi]. [rad]
    pub fn heading(&self, s: f64) -> f64 {
        math::wrap_angle(match *self {
            Self::Straight { heading, .. } => heading,
            Self::Arc { radius, start_angle, turn, .. } => start_angle + turn * (s / radius + math::FRAC_PI_2),
        })
    }
}

/// A centre line with what would otherwise be computed again at every look-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SegmentShape {
    /// A straight line.
    Straight {
        /// Beginning. [m]
        start: Vec2,
        /// Unit vector of its direction.
        forward: Vec2,
        /// Heading. [rad]
        heading: f64,
    },
    /// A circular arc.
    Arc {
        /// Centre of the circle. [m]
        centre: Vec2,
        /// Radius. [m]
        radius: f64,
        /// Unit vector from the centre to the arc's middle.
        middle: Vec2,
        /// Heading at the arc's middle. [rad]
        middle_heading: f64,
        /// Half of the arc's length. [m]
        half_length: f64,
        /// +1 anticlockwise (a left curve), -1 clockwise.
        turn: f64,
    },
}

impl SegmentShape {
    /// That of a line of this length. [m]
    pub fn of_line(line: &Centreline, length_m: f64) -> Self {
        match *line {
            Centreline::Straight { start, heading } => {
                Self::Straight { start, forward: Vec2::from_heading(heading), heading }
            }
            Centreline::Arc { centre, radius, start_angle, turn } => {
                let half_length = 0.5 * length_m;
                Self::Arc {
                    centre,
                    radius,
                    middle: Vec2::from_heading(start_angle + turn * half_length / radius),
                    middle_heading: line.heading(half_length),
                    half_length,
                    turn,
                }
            }
        }
    }

    /// The part of it between two distances from its beginning. [m]
    pub fn part(&self, from_m: f64, to_m: f64) -> Self {
        match *self {
            Self::Straight { start, forward, heading } => {
                Self::Straight { start: start + forward * from_m, forward, heading }
            }
            Self::Arc { centre, radius, turn, .. } => {
                let half = 0.5 * (to_m - from_m);
                let (point, _, heading) = self.frame(from_m + half);
                Self::Arc {
                    centre,
                    radius,
                    middle: (point - centre) * (1.0 / radius),
                    middle_heading: heading,
                    half_length: half,
                    turn,
                }
            }
        }
    }

    /// The same line the other way. [m]
    pub(crate) fn reversed(&self, length_m: f64) -> Self {
        match *self {
            Self::Straight { forward, heading, .. } => {
                let heading = math::wrap_angle(heading + math::PI);
                Self::Straight { start: self.frame(length_m).0, forward: -forward, heading }
            }
            Self::Arc { centre, radius, middle, middle_heading, half_length, turn } => {
                let middle_heading = math::wrap_angle(middle_heading + math::PI);
                Self::Arc { centre, radius, middle, middle_heading, half_length, turn: -turn }
            }
        }
    }

    /// Curvature, positive to the left. [1/m]
    #[inline]
    pub fn curvature(&self) -> f64 {
        match *self {
            Self::Straight { .. } => 0.0,
            Self::Arc { radius, turn, .. } => turn / radius,
        }
    }

    /// Position, direction and heading on the centre line, `s` from the segment's beginning; an arc is continued as a
    /// circle. The heading is not wrapped. [m, rad]
    #[inline]
    pub fn frame(&self, s: f64) -> (Vec2, Vec2, f64) {
        match *self {
            Self::Straight { start, forward, heading } => (start + forward * s, forward, heading),
            Self::Arc { centre, radius, middle, middle_heading, half_length, turn } => {
                let angle = turn * (s - half_length) / radius;
                let (sin, cos) = math::sincos(angle);
                let outward = middle * cos + middle.left() * sin;
                (centre + outward * radius, outward.left() * turn, middle_heading + angle)
            }
        }
    }

    /// Heading of the centre line, as in [`Self::frame`]. [rad]
    #[inline]
    pub fn heading(&self, s: f64) -> f64 {
        match *self {
            Self::Straight { heading, .. } => heading,
            Self::Arc { radius, middle_heading, half_length, turn, .. } => {
                middle_heading + turn * (s - half_length) / radius
            }
        }
    }

    /// (s, t) of a point, `s` from the segment's beginning; an arc is continued as a circle. [m]
    #[inline]
    pub fn local(&self, point: Vec2) -> (f64, f64) {
        match *self {
            Self::Straight { start, forward, .. } => {
                let d = point - start;
                (d.dot(forward), -forward.cross(d))
            }
            Self::Arc { centre, radius, middle, half_length, turn, .. } => {
                let d = point - centre;
                let angle = math::atan2(middle.cross(d), middle.dot(d));
                (half_length + turn * angle * radius, turn * (d.length() - radius))
            }
        }
    }
}
