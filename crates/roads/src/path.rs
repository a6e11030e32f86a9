//! Paths: the lanes a vehicle follows one after the other, as one line with one `s`.

pub use crate::centreline::SegmentShape;
use crate::lane::{LaneId, RoadId};
use crate::network::RoadNetwork;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;

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

    /// Where somebody was on the path who has driven so far to `at_m`, `t_m` to the right of it all along: beside a bend its own
    /// line is longer or shorter. [m]
    pub fn before(&self, at_m: f64, t_m: f64, driven_m: f64) -> f64 {
        let (mut s_m, mut left_m) = (at_m, driven_m);
        let passed = self.segments.iter().rev().filter(|segment| segment.start_m < at_m && t_m != 0.0);
        for segment in passed {
            let end_m = segment.start_m + segment.length_m;
            let beyond_m = (s_m - end_m).max(0.0);
            let by = (1.0 + t_m * segment.shape.curvature()).max(0.05);
            let own_m = beyond_m + (s_m.min(end_m) - segment.start_m) * by;
            if left_m <= beyond_m {
                break;
            }
            if left_m <= own_m {
                return s_m.min(end_m) - (left_m - beyond_m) / by;
            }
            (left_m, s_m) = (left_m - own_m, segment.start_m);
        }
        s_m - left_m
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
}
