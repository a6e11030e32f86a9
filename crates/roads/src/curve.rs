//! Lines and arcs, and what is made of them: spirals, smooth lines through points, connections between two poses.

use crate::centreline::Centreline;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;

/// A curve of less curvature than this is drawn straight: its circle's centre is so far that places lose digits. [1/m]
const STRAIGHT_CURVATURE: f64 = 1e-8;

/// How far the heading of the arcs may be from that of the spiral they stand for: less than 0.1 degrees. [rad]
const SPIRAL_HEADING_RAD: f64 = 1.5e-3;

/// The least radius of a turn that is drawn as line, arc and line. [m]
const NICE_RADIUS_M: f64 = 5.0;

/// Straight parts of a turn shorter than this become part of its arcs. [m]
const SHORT_LINE_M: f64 = 0.5;

/// A stretch of one curvature: a straight line or a circular arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Where it begins, and which way it leads there.
    pub start: Pose,
    /// Positive to the left; 0 is straight. [1/m]
    pub curvature: f64,
    /// Length. [m]
    pub length_m: f64,
}

impl Stretch {
    /// Place and direction, `s` from its beginning; continued at both ends. The heading is not wrapped. [m]
    pub fn pose(&self, s: f64) -> Pose {
        let half = 0.5 * self.curvature * s;
        let chord = if self.curvature == 0.0 { s } else { 2.0 * math::sin(half) / self.curvature };
        Pose {
            position: self.start.position + Vec2::from_heading(self.start.heading + half) * chord,
            heading: self.start.heading + 2.0 * half,
        }
    }

    /// (s, t) of a point; t is to the right, an arc is continued as a circle. [m]
    pub fn local(&self, point: Vec2) -> (f64, f64) {
        let forward = Vec2::from_heading(self.start.heading);
        let d = point - self.start.position;
        if self.curvature == 0.0 {
            return (d.dot(forward), -forward.cross(d));
        }
        let radius = 1.0 / self.curvature;
        let turned = Vec2::from_heading(self.start.heading + 0.5 * self.curvature * self.length_m);
        // Seen from the circle's centre, the arc's middle and the point.
        let (middle, out) = (-turned.left() * radius.signum(), d - forward.left() * radius);
        let angle = math::atan2(middle.cross(out), middle.dot(out)) * radius.signum();
        (0.5 * self.length_m + angle * radius.abs(), radius.signum() * (out.length() - radius.abs()))
    }

    /// Where it ends.
    pub fn end(&self) -> Pose {
        self.pose(self.length_m)
    }

    /// The part between two places. [m]
    pub fn part(&self, from_m: f64, to_m: f64) -> Self {
        Self { start: self.pose(from_m), curvature: self.curvature, length_m: to_m - from_m }
    }

    /// The same stretch, `t` to the right. [m]
    pub fn beside(&self, t: f64) -> Self {
        let stretched = 1.0 + self.curvature * t;
        Self {
            start: beside(self.start, t),
            curvature: self.curvature / stretched,
            length_m: self.length_m * stretched,
        }
    }

    /// The same stretch, the other way.
    pub fn reversed(&self) -> Self {
        Self { start: turned_round(self.end()), curvature: -self.curvature, length_m: self.length_m }
    }

    /// As a lane's centre line.
    pub(crate) fn centreline(&self) -> Centreline {
        let Pose { position: start, heading } = self.start;
        let heading = math::wrap_angle(heading);
        if self.curvature == 0.0 {
            return Centreline::Straight { start, heading };
        }
        let turn = self.curvature.signum();
        Centreline::Arc {
            centre: start + Vec2::from_heading(heading).left() * (1.0 / self.curvature),
            radius: 1.0 / self.curvature.abs(),
            start_angle: math::wrap_angle(heading - turn * math::FRAC_PI_2),
            turn,
        }
    }
}

/// The pose `t` to the right of another. [m]
pub(crate) fn beside(pose: Pose, t: f64) -> Pose {
    Pose { position: pose.position - Vec2::from_heading(pose.heading).left() * t, heading: pose.heading }
}

/// The pose facing the other way.
pub(crate) fn turned_round(pose: Pose) -> Pose {
    Pose { position: pose.position, heading: math::wrap_angle(pose.heading + math::PI) }
}

/// A straight line from a pose. [m]
pub(crate) const fn straight(start: Pose, length_m: f64) -> Stretch {
    Stretch { start, curvature: 0.0, length_m }
}

/// The arc from a pose that ends at a point, which may not be the pose's own.
fn arc_to(start: Pose, end: Vec2) -> Stretch {
    let chord = end - start.position;
    let forward = Vec2::from_heading(start.heading);
    let half = math::atan2(forward.cross(chord), forward.dot(chord));
    let length = chord.length();
    let curvature = 2.0 * math::sin(half) / length;
    if curvature.abs() < STRAIGHT_CURVATURE {
        let heading = math::atan2(chord.y, chord.x);
        return straight(Pose { position: start.position, heading }, length);
    }
    Stretch { start, curvature, length_m: 2.0 * half / curvature }
}

/// Two arcs that touch each other and lead from one pose to another: those whose ends are as far from where their
/// tangents meet. `None` where the poses are in one place, or only a loop leads from one to the other.
pub(crate) fn biarc(from: Pose, to: Pose) -> Option<[Stretch; 2]> {
    let (t1, t2) = (Vec2::from_heading(from.heading), Vec2::from_heading(to.heading));
    let v = to.position - from.position;
    let sum = v.dot(t1 + t2);
    let apart = 2.0 * (1.0 - t1.dot(t2));
    // The positive root of 2 d^2 (t1.t2 - 1) - 2 d v.(t1 + t2) + v.v, in the form that loses no digits.
    let divisor = sum + (math::sq(sum) + apart * v.length_squared()).sqrt();
    if v.length_squared() < 1e-12 || divisor < 1e-9 * v.length() {
        return None;
    }
    let d = v.length_squared() / divisor;
    let joint = (from.position + t1 * d + to.position - t2 * d) * 0.5;
    if joint.distance(from.position) < 1e-9 || joint.distance(to.position) < 1e-9 {
        return None;
    }
    let first = arc_to(from, joint);
    let second = arc_to(turned_round(to), joint).reversed();
    Some([first, second])
}

/// Stretches of one curvature behind each other become one.
pub(crate) fn joined(stretches: impl IntoIterator<Item = Stretch>) -> Vec<Stretch> {
    let mut list: Vec<Stretch> = Vec::new();
    for stretch in stretches {
        match list.last_mut() {
            Some(last) if (last.curvature - stretch.curvature).abs() < 1e-11 => last.length_m += stretch.length_m,
            _ => list.push(stretch),
        }
    }
    list
}

/// A spiral: its curvature changes evenly. Pairs of arcs between poses of the exact curve. [m, 1/m]
pub(crate) fn spiral(start: Pose, length_m: f64, from: f64, to: f64) -> Vec<Stretch> {
    let rate = (to - from) / length_m;
    // Over a length h two arcs between exact poses run rate h^2 / 24 beside the heading at most, where they touch.
    let longest = (24.0 * SPIRAL_HEADING_RAD / rate.abs().max(1e-9)).sqrt();
    let pieces = (length_m / longest).ceil().clamp(1.0, 500.0);
    let mut stretches = Vec::new();
    let mut pose = start;
    for piece in 0..pieces as u32 {
        let h = length_m / pieces;
        let curvature = from + rate * h * f64::from(piece);
        let next = along_spiral(pose, h, curvature, rate);
        match biarc(pose, next) {
            Some(pair) => stretches.extend(pair),
            None => stretches.push(Stretch { start: pose, curvature: curvature + 0.5 * rate * h, length_m: h }),
        }
        pose = next;
    }
    joined(stretches)
}

/// The pose `h` further on a spiral: Gauss and Legendre's quadrature with three nodes, on 16 parts.
fn along_spiral(start: Pose, h: f64, curvature: f64, rate: f64) -> Pose {
    const PARTS: u32 = 16;
    let node = 0.6_f64.sqrt();
    let heading = |s: f64| start.heading + curvature * s + 0.5 * rate * s * s;
    let mut position = start.position;
    let half = 0.5 * h / f64::from(PARTS);
    for part in 0..PARTS {
        let middle = half * f64::from(2 * part + 1);
        for (place, weight) in [(-node, 5.0), (0.0, 8.0), (node, 5.0)] {
            position = position + Vec2::from_heading(heading(middle + place * half)) * (half * weight / 9.0);
        }
    }
    Pose { position, heading: heading(h) }
}

/// A smooth line through points: at each the direction of the circle through it and its neighbours.
/// `None` where it would have to turn back in itself.
pub(crate) fn through(start: Pose, points: &[Vec2]) -> Option<Vec<Stretch>> {
    let mut stretches = Vec::new();
    let mut pose = start;
    for (index, point) in points.iter().enumerate() {
        let chord = *point - pose.position;
        let arriving = math::atan2(chord.y, chord.x);
        let heading = match points.get(index + 1) {
            Some(next) => {
                let onward = *next - *point;
                let bend = math::wrap_angle(math::atan2(onward.y, onward.x) - arriving);
                arriving + bend * chord.length() / (chord.length() + onward.length()).max(1e-9)
            }
            // The last is reached by one arc.
            None => arriving + math::wrap_angle(arriving - pose.heading),
        };
        let next = Pose { position: *point, heading };
        let pair = biarc(pose, next)?;
        if pair[0].length_m + pair[1].length_m > 3.0 * chord.length() {
            return None;
        }
        stretches.extend(pair);
        pose = next;
    }
    Some(joined(stretches))
}

/// The curve of a connection across a junction: line, arc and line where the tangents meet and leave room for a good
/// radius, two arcs elsewhere. `None` where neither leads there.
pub(crate) fn connection(from: Pose, to: Pose, turns: bool) -> Option<Vec<Stretch>> {
    let pair = biarc(from, to).map(joined);
    match (turns.then(|| line_arc_line(from, to)).flatten(), pair) {
        (Some(nice), Some(pair)) => {
            let best = least_radius_m(&nice) >= NICE_RADIUS_M || least_radius_m(&nice) >= least_radius_m(&pair);
            Some(if best { nice } else { pair })
        }
        (nice, pair) => nice.or(pair),
    }
}

/// The least radius in a chain. [m]
pub(crate) fn least_radius_m(stretches: &[Stretch]) -> f64 {
    stretches.iter().map(|stretch| 1.0 / stretch.curvature.abs()).fold(f64::INFINITY, f64::min)
}

fn line_arc_line(from: Pose, to: Pose) -> Option<Vec<Stretch>> {
    let (t1, t2) = (Vec2::from_heading(from.heading), Vec2::from_heading(to.heading));
    let v = to.position - from.position;
    let across = t1.cross(t2);
    if across.abs() < 1e-3 {
        return None;
    }
    let (before, after) = (v.cross(t2) / across, t1.cross(v) / across);
    let tangent = before.min(after);
    let line = (before - after).abs();
    if tangent <= 0.0 || (line > 0.0 && line < SHORT_LINE_M) {
        return None;
    }
    let angle = math::wrap_angle(to.heading - from.heading);
    let radius = tangent / math::tan(0.5 * angle.abs());
    let mut stretches = Vec::with_capacity(2);
    let mut pose = from;
    if before > after {
        let lead = straight(pose, line);
        pose = lead.end();
        stretches.push(lead);
    }
    let arc = Stretch { start: pose, curvature: angle.signum() / radius, length_m: radius * angle.abs() };
    stretches.push(arc);
    if after > before {
        stretches.push(straight(Pose { position: arc.end().position, heading: to.heading }, line));
    }
    Some(stretches)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64, degrees: f64) -> Pose {
        Pose { position: Vec2::new(x, y), heading: degrees * math::PI / 180.0 }
    }

    fn end_error(stretches: &[Stretch], to: Pose) -> f64 {
        let end = stretches.last().unwrap().end();
        end.position.distance(to.position).max(math::wrap_angle(end.heading - to.heading).abs())
    }

    #[test]
    fn a_point_is_found_where_it_was_put() {
        for curvature in [0.0, 0.02, -0.05] {
            let stretch = Stretch { start: at(3.0, -2.0, 40.0), curvature, length_m: 30.0 };
            for (s, t) in [(0.0, 0.0), (12.0, 3.0), (29.0, -4.0), (33.0, 1.0), (-2.0, 1.0)] {
                let (found_s, found_t) = stretch.local(beside(stretch.pose(s), t).position);
                assert!((found_s - s).abs() < 1e-9 && (found_t - t).abs() < 1e-9, "{curvature} {s} {t}");
            }
        }
    }

    #[test]
    fn a_quarter_turn_between_equal_tangents_is_one_arc() {
        let to = at(10.0, 10.0, 90.0);
        let curve = connection(at(0.0, 0.0, 0.0), to, true).unwrap();
        assert_eq!(curve.len(), 1);
        assert!((curve[0].curvature - 0.1).abs() < 1e-12 && end_error(&curve, to) < 1e-12);
    }

    #[test]
    fn a_turn_with_one_longer_tangent_begins_or_ends_with_a_line() {
        let to = at(16.0, -10.0, -90.0);
        let curve = connection(at(0.0, 0.0, 0.0), to, true).unwrap();
        assert_eq!(curve.len(), 2);
        assert!((curve[0].length_m - 6.0).abs() < 1e-12 && (curve[1].curvature + 0.1).abs() < 1e-12);
        assert!(end_error(&curve, to) < 1e-12);
    }

    #[test]
    fn two_arcs_lead_to_any_pose_and_touch() {
        for (x, y, degrees) in [(30.0, 3.3, 0.0), (20.0, -5.0, 40.0), (0.0, 8.0, 180.0), (5.0, -12.0, 170.0)] {
            let pair = biarc(at(0.0, 0.0, 0.0), at(x, y, degrees)).unwrap();
            assert!(end_error(&pair[..1], pair[1].start) < 1e-9, "{x} {y}");
            assert!(end_error(&pair, at(x, y, degrees)) < 1e-9, "{x} {y}");
        }
        assert_eq!(biarc(at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0)), None);
        assert_eq!(biarc(at(0.0, 0.0, 0.0), at(-5.0, 0.0, 0.0)), None);
    }

    #[test]
    fn a_spiral_is_within_a_centimetre_and_a_tenth_of_a_degree_of_the_clothoid() {
        for (length, from, to) in [(60.0, 0.0, 0.02), (1.0, 0.0, 0.25), (500.0, 0.01, -0.05), (30.0, 1.0 / 15.0, 0.0)] {
            let arcs = spiral(Pose::default(), length, from, to);
            let exact = along_spiral_finely(length, from, (to - from) / length);
            let mut s = 0.0;
            for arc in &arcs {
                for part in 0..=4 {
                    let along = arc.length_m * f64::from(part) / 4.0;
                    let index = ((s + along) / length * 1e5).round() as usize;
                    let (mine, theirs) = (arc.pose(along), exact[index.min(100_000)]);
                    assert!(mine.position.distance(theirs.position) < 0.01, "{length} {from} {to} at {}", s + along);
                    assert!(math::wrap_angle(mine.heading - theirs.heading).abs() < 0.1_f64.to_radians());
                }
                s += arc.length_m;
            }
            assert!(end_error(&arcs, exact[100_000]) < 1e-6);
        }
    }

    fn along_spiral_finely(length: f64, curvature: f64, rate: f64) -> Vec<Pose> {
        let h = length / 1e5;
        let heading = |s: f64| curvature * s + 0.5 * rate * s * s;
        let mut position = Vec2::default();
        let mut poses = vec![Pose::default()];
        for step in 0..100_000 {
            let s = h * f64::from(step);
            position = position + Vec2::from_heading(heading(s + 0.5 * h)) * h;
            poses.push(Pose { position, heading: heading(s + h) });
        }
        poses
    }

    #[test]
    fn a_line_through_points_of_a_circle_is_that_circle() {
        let points: Vec<_> = (1..=4)
            .map(|n| {
                let angle = 0.3 * f64::from(n);
                Vec2::new(50.0 * math::sin(angle), 50.0 * (1.0 - math::cos(angle)))
            })
            .collect();
        let line = through(Pose::default(), &points).unwrap();
        assert!(line.iter().all(|stretch| (stretch.curvature - 0.02).abs() < 1e-9));
        assert!((line.iter().map(|stretch| stretch.length_m).sum::<f64>() - 60.0).abs() < 1e-6);
        assert_eq!(through(Pose::default(), &[Vec2::new(-10.0, 0.1)]), None);
    }
}
