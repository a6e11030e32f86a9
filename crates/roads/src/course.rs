//! Courses: the line that the rear axle of a road user with a plan follows, leg by leg, as one line with one `s`.
//!
//! `s` counts from the start in the direction of motion; in reverse gear the road user faces against it. What lies beside
//! the line is counted to the right of the road user. Equations: `docs/models/acts.md`.

use crate::centreline::{Centreline, SegmentShape};
use crate::curve::{Stretch, biarc};
use crate::lane::LaneId;
use crate::path::{LanePath, PathSegment};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;

/// A course.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// Its pieces, in order.
    pub pieces: Vec<CoursePiece>,
    /// Its legs, in order; at least one.
    pub legs: Vec<CourseLeg>,
    /// From the rear axle, which is on the line, forward to the centre of the box. [m]
    pub arm_m: f64,
    /// Stop lines on it; a yield sign has none.
    pub lines: Vec<StopLine>,
}

/// A straight piece or an arc of a course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoursePiece {
    /// Where it begins. [m]
    pub start_m: f64,
    /// [m]
    pub length_m: f64,
    /// Its line.
    pub shape: SegmentShape,
    /// The lane it belongs to, where it does.
    pub lane: Option<LaneId>,
    /// Where on that lane it begins. [m]
    pub lane_from_m: f64,
}

/// A leg of a course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CourseLeg {
    /// Where it ends. [m]
    pub end_m: f64,
    /// Whether it is driven in reverse gear.
    pub reverse: bool,
    /// Whether the road user stops at its end where nothing follows; else it goes straight on.
    pub ends: bool,
}

/// Where a course passes a stop line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopLine {
    /// Where the centre is when the front is at the line. [m]
    pub at_m: f64,
    /// Position in the scenario's list of control.
    pub control: usize,
}

/// The line at one place of a course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// [m]
    pub position: Vec2,
    /// Direction of motion.
    pub forward: Vec2,
    /// The same. [rad]
    pub heading: f64,
    /// Positive to the left of motion. [1/m]
    pub curvature: f64,
}

/// Offset beside a course's line, to the right of the road user, with its first two derivatives along the line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beside {
    /// [m]
    pub t_m: f64,
    /// [1]
    pub slope: f64,
    /// [1/m]
    pub bend: f64,
}

impl Course {
    /// A course that stays at a place.
    pub fn standing(centre: Pose, arm_m: f64) -> Self {
        let heading = centre.heading;
        let shape =
            SegmentShape::of_line(&Centreline::Straight { start: rear_of(centre, arm_m).position, heading }, 0.0);
        let piece = CoursePiece { start_m: 0.0, length_m: 0.0, shape, lane: None, lane_from_m: 0.0 };
        let leg = CourseLeg { end_m: 0.0, reverse: false, ends: true };
        Self { pieces: vec![piece], legs: vec![leg], arm_m, lines: Vec::new() }
    }

    /// A course without a leg, to add legs to.
    pub fn begin(arm_m: f64) -> Self {
        Self { arm_m, ..Self::default() }
    }

    /// Length of all legs. [m]
    pub fn length_m(&self) -> f64 {
        self.legs.last().map_or(0.0, |leg| leg.end_m)
    }

    /// The rear axle's pose at the end of what there is so far, as the road user faces there; `None` at the beginning.
    pub fn end_pose(&self) -> Option<Pose> {
        let leg = self.legs.last()?;
        let spot = self.spot(leg.end_m);
        let heading = if leg.reverse { math::wrap_angle(spot.heading + math::PI) } else { spot.heading };
        Some(Pose { position: spot.position, heading })
    }

    /// Adds a leg along a stretch of a path, both ends given for the rear axle; what lies outside of the path is driven along
    /// its tangent. A path against its lanes' direction belongs to none of them. [m]
    pub fn follow(&mut self, path: &LanePath, (from_m, to_m): (f64, f64), against: bool, reverse: bool, ends: bool) {
        if from_m < 0.0 {
            let before = (-from_m).min(to_m - from_m);
            self.straight(path.pose(from_m, 0.0), before);
        }
        for segment in &path.segments {
            let start = from_m.max(segment.start_m);
            let end = to_m.min(segment.start_m + segment.length_m);
            if end - start > 1e-9 {
                let shape = segment.shape.part(start - segment.start_m, end - segment.start_m);
                let lane = (!against).then_some((segment.lane, start - segment.start_m));
                self.push(shape, end - start, lane);
            }
        }
        if to_m > path.length_m {
            let from = from_m.max(path.length_m);
            self.straight(path.pose(from, 0.0), to_m - from);
        }
        self.end_leg(reverse, ends);
    }

    /// Adds a leg along a smooth curve to a pose of the centre. Whether there is such a curve.
    pub fn curve(&mut self, from_centre: Pose, to_centre: Pose, reverse: bool) -> bool {
        let from = self.end_pose().unwrap_or(rear_of(from_centre, self.arm_m));
        let to = rear_of(to_centre, self.arm_m);
        let turned = |pose: Pose| {
            let heading = if reverse { math::wrap_angle(pose.heading + math::PI) } else { pose.heading };
            Pose { heading, ..pose }
        };
        let (from, to) = (turned(from), turned(to));
        let Some(arcs) = biarc(from, to) else { return false };
        // More than half a circle is a loop.
        if arcs.iter().any(|arc| (arc.curvature * arc.length_m).abs() > math::PI) {
            return false;
        }
        for arc in &arcs {
            self.stretch_of(arc);
        }
        self.end_leg(reverse, true);
        true
    }

    /// Adds a leg from point to point. [m]
    pub fn walk(&mut self, from_centre: Pose, points: &[[f64; 2]]) {
        let mut from = self.end_pose().map_or(rear_of(from_centre, self.arm_m).position, |pose| pose.position);
        for &[x, y] in points {
            let to = Vec2::new(x, y);
            let way = to - from;
            if way.length() > 1e-6 {
                self.straight(Pose { position: from, heading: math::atan2(way.y, way.x) }, way.length());
            }
            from = to;
        }
        self.end_leg(false, true);
    }

    fn stretch_of(&mut self, stretch: &Stretch) {
        self.push(SegmentShape::of_line(&stretch.centreline(), stretch.length_m), stretch.length_m, None);
    }

    fn straight(&mut self, from: Pose, length_m: f64) {
        self.stretch_of(&Stretch { start: from, curvature: 0.0, length_m });
    }

    fn push(&mut self, shape: SegmentShape, length_m: f64, lane: Option<(LaneId, f64)>) {
        let start_m = self.pieces.last().map_or(0.0, |piece| piece.start_m + piece.length_m);
        let lane_from_m = lane.map_or(0.0, |(_, from_m)| from_m);
        let lane = lane.map(|(lane, _)| lane);
        self.pieces.push(CoursePiece { start_m, length_m, shape, lane, lane_from_m });
    }

    fn end_leg(&mut self, reverse: bool, ends: bool) {
        let end_m = self.pieces.last().map_or(0.0, |piece| piece.start_m + piece.length_m);
        self.legs.push(CourseLeg { end_m, reverse, ends });
    }

    /// The line as a path of lanes, to see where it meets others; what is on no lane has one of its own.
    pub fn as_path(&self) -> LanePath {
        let segments = self.pieces.iter().map(|piece| PathSegment {
            lane: piece.lane.unwrap_or(LaneId(u16::MAX)),
            start_m: piece.start_m,
            length_m: piece.length_m,
            shape: piece.shape,
        });
        LanePath { roads: Vec::new(), segments: segments.collect(), length_m: self.length_m() }
    }

    /// Position of the piece at `s`, looked for from `hint` on.
    #[inline]
    pub fn piece_at(&self, s_m: f64, hint: usize) -> usize {
        let last = self.pieces.len() - 1;
        let mut position = hint.min(last);
        while position > 0 && s_m < self.pieces[position].start_m {
            position -= 1;
        }
        while position < last && s_m > self.pieces[position].start_m + self.pieces[position].length_m {
            position += 1;
        }
        position
    }

    /// The line at `s`; before its beginning and behind its end it goes straight on.
    pub fn spot(&self, s_m: f64) -> Spot {
        self.spot_on(self.piece_at(s_m, 0), s_m)
    }

    /// The line at `s` of this piece.
    #[inline]
    pub fn spot_on(&self, piece: usize, s_m: f64) -> Spot {
        let piece = &self.pieces[piece];
        let along = s_m - piece.start_m;
        let on_piece = along.clamp(0.0, piece.length_m);
        let (position, forward, heading) = piece.shape.frame(on_piece);
        let beyond = along - on_piece;
        let curvature = if beyond.abs() < 1e-6 { piece.shape.curvature() } else { 0.0 };
        Spot { position: position + forward * beyond, forward, heading, curvature }
    }

    /// How far somebody beside the line drives on its own line, on this piece, for each metre of the course: less than one on
    /// the inside of a bend, more on the outside. The offset is to the right of the road user. [m]
    #[inline]
    pub fn stretch(&self, piece: usize, s_m: f64, reverse: bool, t_m: f64) -> f64 {
        if t_m == 0.0 { 1.0 } else { stretch(self.spot_on(piece, s_m).curvature, reverse, t_m) }
    }

    /// Where somebody who keeps its offset beside the line is after it has driven so far on its own line. [m]
    pub fn after(&self, piece: usize, s_m: f64, reverse: bool, t_m: f64, driven_m: f64) -> f64 {
        if t_m == 0.0 {
            return s_m + driven_m;
        }
        let (mut at, mut s_m, mut left_m) = (piece, s_m, driven_m);
        while let Some(next) = self.pieces.get(at + 1) {
            let by = stretch(self.pieces[at].shape.curvature(), reverse, t_m);
            let own_m = (next.start_m - s_m).max(0.0) * by;
            if left_m <= own_m {
                return s_m + left_m / by;
            }
            (left_m, s_m, at) = (left_m - own_m, s_m.max(next.start_m), at + 1);
        }
        s_m + left_m / self.stretch(at, s_m, reverse, t_m)
    }

    /// How far it drives on its own line from one place of the course to one that is ahead; less than nothing where that is
    /// behind. [m]
    pub fn driven(&self, piece: usize, (from_m, to_m): (f64, f64), reverse: bool, t_m: f64) -> f64 {
        if t_m == 0.0 || to_m <= from_m {
            return to_m - from_m;
        }
        let bent_m = |piece: &CoursePiece| {
            let on_it_m = (piece.start_m + piece.length_m).min(to_m) - piece.start_m.max(from_m);
            on_it_m.max(0.0) * (stretch(piece.shape.curvature(), reverse, t_m) - 1.0)
        };
        to_m - from_m + self.pieces[piece..].iter().map(bent_m).sum::<f64>()
    }

    /// Pose of the centre, its velocity at a speed along the line, and its yaw rate. [m/s, rad/s]
    pub fn motion(&self, piece: usize, s_m: f64, reverse: bool, beside: Beside, speed_mps: f64) -> (Pose, Vec2, f64) {
        let spot = self.spot_on(piece, s_m);
        let gear = if reverse { -1.0 } else { 1.0 };
        let right = -(spot.forward.left() * gear);
        // d(rear axle) / ds.
        let stretch = stretch(spot.curvature, reverse, beside.t_m);
        let slope = beside.slope / stretch;
        let way = spot.forward * stretch + right * beside.slope;
        let turned = if beside.slope == 0.0 { 0.0 } else { math::atan(slope) };
        let facing = if reverse { spot.heading + math::PI + turned } else { spot.heading - turned };
        let slope_rate = (beside.bend * stretch - gear * spot.curvature * math::sq(beside.slope)) / math::sq(stretch);
        let turn_per_m = spot.curvature - gear * slope_rate / (1.0 + math::sq(slope));
        let heading = math::wrap_angle(facing);
        let axis = Vec2::from_heading(heading);
        let rear = spot.position + right * beside.t_m;
        let yaw_rate = turn_per_m * speed_mps;
        let velocity = way * speed_mps + axis.left() * (self.arm_m * yaw_rate);
        (Pose { position: rear + axis * self.arm_m, heading }, velocity, yaw_rate)
    }
}

/// Length of a line beside a bend, of that of the bend. The offset is to the right of who drives there, in this gear. [1/m, m]
#[inline]
fn stretch(curvature: f64, reverse: bool, t_m: f64) -> f64 {
    (1.0 + if reverse { -t_m } else { t_m } * curvature).max(LEAST_STRETCH)
}

/// Beyond the middle of a bend a line beside it would lead backwards.
const LEAST_STRETCH: f64 = 0.05;

/// The rear axle's pose of a centre's. [m]
pub fn rear_of(centre: Pose, arm_m: f64) -> Pose {
    Pose { position: centre.position - Vec2::from_heading(centre.heading) * arm_m, ..centre }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f64, y: f64, degrees: f64) -> Pose {
        Pose { position: Vec2::new(x, y), heading: degrees.to_radians() }
    }

    #[test]
    fn who_reverses_along_the_way_it_came_is_where_it_was() {
        let (start, end) = (pose(0.0, 0.0, 0.0), pose(8.0, 6.0, 80.0));
        let mut there = Course::begin(1.4);
        assert!(there.curve(start, end, false));
        let mut back = Course::begin(1.4);
        assert!(back.curve(end, start, true));
        let length_m = there.length_m();
        assert!((back.length_m() - length_m).abs() < 1e-9);
        for step in 0..20 {
            let s = length_m * (f64::from(step) + 0.4) / 20.0;
            let (forth, v, _) = there.motion(there.piece_at(s, 0), s, false, Beside::default(), 2.0);
            let s = length_m - s;
            let (returning, w, _) = back.motion(back.piece_at(s, 0), s, true, Beside::default(), 2.0);
            assert!(forth.position.distance(returning.position) < 1e-9, "{forth:?} {returning:?}");
            assert!(math::wrap_angle(forth.heading - returning.heading).abs() < 1e-9);
            assert!((v + w).length() < 1e-6, "opposite velocities: {v:?} {w:?}");
        }
    }

    #[test]
    fn who_drives_beside_a_bend_comes_as_far_as_it_drives() {
        let mut course = Course::begin(0.0);
        course.straight(pose(0.0, 0.0, 0.0), 10.0);
        course.stretch_of(&Stretch { start: pose(10.0, 0.0, 0.0), curvature: 0.1, length_m: 8.0 });
        let end = course.spot(18.0);
        course.straight(Pose { position: end.position, heading: end.heading }, 10.0);
        course.end_leg(false, true);
        for (t_m, on_bend_m) in [(3.0, 8.0 * 1.3), (-3.0, 8.0 * 0.7), (0.0, 8.0)] {
            let whole_m = 10.0 + on_bend_m + 10.0;
            assert!((course.driven(0, (0.0, 28.0), false, t_m) - whole_m).abs() < 1e-9);
            assert!((course.after(0, 0.0, false, t_m, whole_m) - 28.0).abs() < 1e-9);
            // In pieces it is as far as in one go.
            let mut s_m = 0.0;
            for _ in 0..100 {
                let piece = course.piece_at(s_m, 0);
                s_m = course.after(piece, s_m, false, t_m, 0.01 * whole_m);
            }
            assert!((s_m - 28.0).abs() < 1e-9, "{s_m}");
            assert_eq!(course.after(2, 27.0, false, t_m, 5.0), 32.0, "behind its end it goes straight on");
        }
    }

    #[test]
    fn velocity_is_what_the_places_say() {
        let mut course = Course::begin(1.4);
        assert!(course.curve(pose(0.0, 0.0, 0.0), pose(12.0, 9.0, 70.0), false));
        for (s, beside) in [
            (2.0, Beside::default()),
            (5.0, Beside { t_m: 1.0, ..Beside::default() }),
            (9.0, Beside { t_m: 0.5, slope: 0.2, bend: 0.03 }),
        ] {
            let at = |d: f64| {
                let beside = Beside {
                    t_m: beside.t_m + beside.slope * d + 0.5 * beside.bend * d * d,
                    slope: beside.slope + beside.bend * d,
                    ..beside
                };
                course.motion(course.piece_at(s + d, 0), s + d, false, beside, 3.0)
            };
            let h = 1e-5;
            let (_, velocity, yaw_rate) = at(0.0);
            let (before, after) = (at(-h).0, at(h).0);
            let measured = (after.position - before.position) * (3.0 / (2.0 * h));
            assert!((measured - velocity).length() < 1e-4, "{measured:?} {velocity:?}");
            let turned = math::wrap_angle(after.heading - before.heading) * 3.0 / (2.0 * h);
            assert!((turned - yaw_rate).abs() < 1e-4, "{turned} {yaw_rate}");
        }
    }
}
