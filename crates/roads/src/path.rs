//! Paths: the lanes a vehicle follows one after the other, as one line with one `s`.

use crate::lane::{Centreline, Lane, LaneId};
use crate::network::{RoadId, RoadNetwork};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::vehicle::VehicleSpec;

/// One lane of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSegment {
    /// The lane.
    pub lane: LaneId,
    /// The path's s where the lane begins. [m]
    pub start_m: f64,
    /// Its length on the path: the lane's, but where the path changes lanes. [m]
    pub length_m: f64,
    /// Its line: the lane's centre line but where the path changes lanes. Prepared for fast look-ups.
    pub shape: SegmentShape,
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

/// Lanes one behind the other, as one line.
#[derive(Debug, Clone, PartialEq)]
pub struct LanePath {
    /// The roads of the lanes.
    pub roads: Vec<RoadId>,
    /// Lanes, in order, and parts of lanes where the path changes from one to another.
    pub segments: Vec<PathSegment>,
    /// Length. [m]
    pub length_m: f64,
}

/// A point in a path's coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Along the path. [m]
    pub s: f64,
    /// To the right of it. [m]
    pub t: f64,
    /// Position in [`LanePath::segments`].
    pub segment: usize,
}

/// Where two paths meet: the first place where vehicles following them would touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conflict {
    /// Along the first path. [m]
    pub s_a: f64,
    /// Along the second path. [m]
    pub s_b: f64,
    /// Where the centre lines cross, or come within touching distance for good when they merge.
    pub point: Vec2,
    /// Whether the paths merge into one lane, rather than cross.
    pub merges: bool,
}

/// Length and width of a vehicle. [m]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// Length. [m]
    pub length_m: f64,
    /// Width. [m]
    pub width_m: f64,
}

impl Footprint {
    /// That of a kind of road user.
    pub const fn of(kind: PartnerKind) -> Self {
        let spec = VehicleSpec::of(kind);
        Self { length_m: spec.length_m, width_m: spec.width_m }
    }
}

/// Room left on both sides of a stretch where two vehicles can touch. [m]
const REACH_MARGIN_M: f64 = 0.5;

impl Conflict {
    /// How far before the conflict, and behind it where the paths cross, the centre of each vehicle can touch the other: half
    /// of the other's width cut at an angle, and half of its own length (`docs/models/policies.md`). [m]
    pub fn reaches(&self, a: (&LanePath, Footprint), b: (&LanePath, Footprint)) -> (f64, f64) {
        let angle = a.0.pose(self.s_a, 0.0).heading - b.0.pose(self.s_b, 0.0).heading;
        let (sin, cos) = math::sincos(angle);
        let (sin, cos) = (sin.abs().max(0.5), cos.abs());
        let reach = |mine: Footprint, theirs: Footprint| {
            0.5 * mine.length_m + 0.5 * (theirs.width_m + mine.width_m * cos) / sin + REACH_MARGIN_M
        };
        (reach(a.1, b.1), reach(b.1, a.1))
    }
}

impl SegmentShape {
    /// That of a lane.
    pub fn of(lane: &Lane) -> Self {
        Self::of_line(&lane.centreline, lane.length_m)
    }

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

impl LanePath {
    /// The path along `roads` in lane number `lane` (the rightmost where a road has fewer).
    ///
    /// # Panics
    /// Without roads.
    pub fn new(network: &RoadNetwork, roads: Vec<RoadId>, lane: u8) -> Self {
        assert!(!roads.is_empty(), "a path has at least one road");
        let mut segments = Vec::with_capacity(roads.len());
        let mut length_m = 0.0;
        for &road in &roads {
            let lanes = &network.road(road).lanes;
            let id = lanes[usize::from(lane).min(lanes.len() - 1)];
            let geometry = network.lane(id);
            segments.push(PathSegment {
                lane: id,
                start_m: length_m,
                length_m: geometry.length_m,
                shape: SegmentShape::of(geometry),
            });
            length_m += geometry.length_m;
        }
        Self { roads, segments, length_m }
    }

    /// The path along lanes that follow each other. Where two lanes of one road do, the path changes from one to the other
    /// in an S of two arcs.
    ///
    /// # Panics
    /// Without lanes.
    pub fn of_lanes(network: &RoadNetwork, lanes: Vec<LaneId>) -> Self {
        assert!(!lanes.is_empty(), "a path has at least one lane");
        let pieces = crate::lane_change::pieces(network, &lanes);
        let mut path = Self { roads: Vec::with_capacity(pieces.len()), segments: Vec::new(), length_m: 0.0 };
        for (id, geometry) in pieces {
            path.roads.push(geometry.road);
            path.segments.push(PathSegment {
                lane: id,
                start_m: path.length_m,
                length_m: geometry.length_m,
                shape: SegmentShape::of(&geometry),
            });
            path.length_m += geometry.length_m;
        }
        path
    }

    /// The same line the other way. Its lanes are driven against their direction.
    pub fn reversed(&self) -> Self {
        let mut path = Self { roads: self.roads.clone(), segments: Vec::with_capacity(self.segments.len()), ..*self };
        path.roads.reverse();
        for segment in self.segments.iter().rev() {
            let start_m = self.length_m - segment.start_m - segment.length_m;
            path.segments.push(PathSegment { start_m, shape: segment.shape.reversed(segment.length_m), ..*segment });
        }
        path
    }

    /// Pose at (s, t), heading along the path. Before its beginning and behind its end the path goes straight on.
    #[inline]
    pub fn pose(&self, s: f64, t: f64) -> Pose {
        let segment = &self.segments[self.segment_at(s)];
        // Only the first and the last segment can be left; there the excess is driven along the tangent.
        let along = s - segment.start_m;
        let on_segment = along.clamp(0.0, segment.length_m);
        let (position, forward, heading) = segment.shape.frame(on_segment);
        Pose {
            position: position + forward * (along - on_segment) - forward.left() * t,
            heading: math::wrap_angle(heading),
        }
    }

    /// Position in [`Self::segments`] of the lane at `s`; the first before the path, the last behind it.
    #[inline]
    pub fn segment_at(&self, s: f64) -> usize {
        let after = self.segments.iter().skip(1).take_while(|segment| segment.start_m <= s).count();
        after.min(self.segments.len() - 1)
    }

    /// Curvature of the centre line at `s`, positive to the left. [1/m]
    #[inline]
    pub fn curvature(&self, s: f64) -> f64 {
        if s < 0.0 || s > self.length_m {
            return 0.0;
        }
        match self.segments[self.segment_at(s)].shape {
            SegmentShape::Straight { .. } => 0.0,
            SegmentShape::Arc { radius, turn, .. } => turn / radius,
        }
    }

    /// Coordinates of a point, looked for from segment `hint` on (a vehicle never goes back).
    #[inline]
    pub fn project(&self, point: Vec2, hint: usize) -> PathPoint {
        let last = self.segments.len() - 1;
        let mut position = hint.min(last);
        loop {
            let segment = &self.segments[position];
            let (s, t) = segment.shape.local(point);
            if s > segment.length_m && position < last {
                position += 1;
                continue;
            }
            if (0.0..=segment.length_m).contains(&s) {
                return PathPoint { s: segment.start_m + s, t, segment: position };
            }
            // Beyond an end: along the tangent there.
            let end = if s < 0.0 { 0.0 } else { segment.length_m };
            let (origin, forward, _) = segment.shape.frame(end);
            let d = point - origin;
            return PathPoint { s: segment.start_m + end + d.dot(forward), t: -forward.cross(d), segment: position };
        }
    }

    /// The first conflict with another path, for vehicles of these widths. [m]
    ///
    /// What both paths share from their very beginning is not a conflict: vehicles there follow each other. Behind it,
    /// the first of: a crossing of the centre lines (exact, from lines and circles), and the place from which on this
    /// path stays within `(width + other_width) / 2` of the other until both go on in one lane.
    pub fn conflict(&self, other: &Self, width: f64, other_width: f64) -> Option<Conflict> {
        crate::conflict::first_conflict(self, other, 0.5 * (width + other_width))
    }
}
