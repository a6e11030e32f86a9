//! Where two paths meet: crossings of lines and circles, and merges into one lane.

use crate::centreline::SegmentShape;
use crate::lane::LaneId;
use crate::path::{LanePath, PathSegment};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::vehicle::VehicleSpec;

/// Crossings this near to a place where paths part or join are that place: the curves are tangent there, and the last
/// bits of their parameters decide where the intersection falls. [m]
const TANGENT_M: f64 = 0.05;

/// Step of the march along a merge; far shorter than any vehicle. [m]
const MARCH_M: f64 = 0.25;

/// Halvings of a march step: 0.25 m / 2^40 is below 1e-12 m.
const HALVINGS: usize = 40;

/// Room left on both sides of a stretch where two vehicles can touch. [m]
const REACH_MARGIN_M: f64 = 0.5;

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

impl LanePath {
    /// The first conflict with another path, for vehicles of these widths. [m]
    ///
    /// What both paths share from their very beginning is not a conflict: vehicles there follow each other. Behind it,
    /// the first of: a crossing of the centre lines (exact, from lines and circles), and the place from which on this
    /// path stays within `(width + other_width) / 2` of the other until both go on in one lane.
    pub fn conflict(&self, other: &Self, width: f64, other_width: f64) -> Option<Conflict> {
        first_conflict(self, other, 0.5 * (width + other_width))
    }
}

/// The first conflict, see [`LanePath::conflict`]; `touching` is half the sum of the widths. [m]
fn first_conflict(a: &LanePath, b: &LanePath, touching: f64) -> Option<Conflict> {
    let shared = a.segments.iter().zip(&b.segments).take_while(|(x, y)| x.lane == y.lane).count();
    if shared == a.segments.len() || shared == b.segments.len() {
        return None;
    }
    let parted = a.segments[shared].start_m;
    // Paths that start in one node in different lanes run side by side; those that start in one lane part at `parted`.
    let after = if shared > 0 { parted + TANGENT_M } else { f64::NEG_INFINITY };
    let merge = merge_position(a, b, shared);
    let joined = merge.map(|(index, _)| a.segments[index].start_m);
    let mut first: Option<Conflict> = None;
    for x in &a.segments[shared..merge.map_or(a.segments.len(), |(index, _)| index)] {
        for y in &b.segments[shared..merge.map_or(b.segments.len(), |(_, index)| index)] {
            for (s_x, s_y) in intersections(x, y).into_iter().flatten() {
                let (s_a, s_b) = (x.start_m + s_x, y.start_m + s_y);
                let at_merge = joined.is_some_and(|joined| s_a > joined - TANGENT_M);
                if s_a < after || at_merge || first.is_some_and(|first| first.s_a <= s_a) {
                    continue;
                }
                first = Some(Conflict { s_a, s_b, point: a.pose(s_a, 0.0).position, merges: false });
            }
        }
    }
    first.or_else(|| merge.map(|(index_a, index_b)| merge_conflict(a, b, touching, shared, index_a, index_b)))
}

/// Positions in both paths of the first lane they share after having run apart.
fn merge_position(a: &LanePath, b: &LanePath, shared: usize) -> Option<(usize, usize)> {
    let lanes_of_b: Vec<LaneId> = b.segments.iter().map(|segment| segment.lane).collect();
    (shared..a.segments.len()).find_map(|index| {
        let in_b = lanes_of_b.iter().skip(shared).position(|lane| *lane == a.segments[index].lane)?;
        Some((index, shared + in_b))
    })
}

/// The merge: from where on `a` is within touching distance of `b` until they are one.
fn merge_conflict(
    a: &LanePath,
    b: &LanePath,
    touching: f64,
    shared: usize,
    index_a: usize,
    index_b: usize,
) -> Conflict {
    let joined_a = a.segments[index_a].start_m;
    let joined_b = b.segments[index_b].start_m;
    let earliest = if shared > 0 { a.segments[shared].start_m } else { 0.0 };
    // Distance of a's centre line at s from b's, and where on b, before the place where they join.
    let distance = |s: f64| -> (f64, f64) {
        let point = a.pose(s, 0.0).position;
        nearest_before(b, index_b, point)
    };
    let mut inside = joined_a;
    let mut outside = None;
    while inside > earliest {
        let next = (inside - MARCH_M).max(earliest);
        if distance(next).0 > touching {
            outside = Some(next);
            break;
        }
        inside = next;
    }
    if let Some(mut outside) = outside {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if distance(middle).0 > touching { outside = middle } else { inside = middle }
        }
    }
    let s_b = if inside >= joined_a { joined_b } else { distance(inside).1 };
    Conflict { s_a: inside, s_b, point: a.pose(inside, 0.0).position, merges: true }
}

/// Distance of a point from the path before segment `end`, and the path's s there. [m]
fn nearest_before(path: &LanePath, end: usize, point: Vec2) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0);
    for segment in &path.segments[..end] {
        let (s, t) = segment.shape.local(point);
        let candidate = if (0.0..=segment.length_m).contains(&s) {
            (t.abs(), segment.start_m + s)
        } else {
            let nearer = if s < 0.0 { 0.0 } else { segment.length_m };
            (segment.shape.frame(nearer).0.distance(point), segment.start_m + nearer)
        };
        if candidate.0 < best.0 {
            best = candidate;
        }
    }
    best
}

/// Up to two intersections of two centre lines, as s from the beginnings of both.
fn intersections(x: &PathSegment, y: &PathSegment) -> [Option<(f64, f64)>; 2] {
    let points = match (x.shape, y.shape) {
        (SegmentShape::Straight { start: p, forward: u, .. }, SegmentShape::Straight { start: q, forward: v, .. }) => {
            let across = u.cross(v);
            // Parallel lines (the sine of their angle below a millionth) do not cross.
            if across.abs() < 1e-6 { [None; 2] } else { [Some(p + u * ((q - p).cross(v) / across)), None] }
        }
        (SegmentShape::Straight { start, forward, .. }, SegmentShape::Arc { centre, radius, .. })
        | (SegmentShape::Arc { centre, radius, .. }, SegmentShape::Straight { start, forward, .. }) => {
            line_and_circle(start, forward, centre, radius)
        }
        (SegmentShape::Arc { centre: p, radius: r, .. }, SegmentShape::Arc { centre: q, radius: s, .. }) => {
            two_circles(p, r, q, s)
        }
    };
    points.map(|point| {
        let point = point?;
        let (s_x, _) = x.shape.local(point);
        let (s_y, _) = y.shape.local(point);
        let on_both = (0.0..=x.length_m).contains(&s_x) && (0.0..=y.length_m).contains(&s_y);
        on_both.then_some((s_x, s_y))
    })
}

fn line_and_circle(start: Vec2, forward: Vec2, centre: Vec2, radius: f64) -> [Option<Vec2>; 2] {
    let foot = (centre - start).dot(forward);
    let off = forward.cross(centre - start);
    let half_chord_squared = math::sq(radius) - math::sq(off);
    if half_chord_squared < 0.0 {
        return [None; 2];
    }
    let half_chord = half_chord_squared.sqrt();
    [Some(start + forward * (foot - half_chord)), Some(start + forward * (foot + half_chord))]
}

fn two_circles(p: Vec2, r: f64, q: Vec2, s: f64) -> [Option<Vec2>; 2] {
    let d = p.distance(q);
    // Circles around one centre are parallel lanes.
    if d < 1e-6 {
        return [None; 2];
    }
    let axis = (q - p) * (1.0 / d);
    let along = (math::sq(d) + math::sq(r) - math::sq(s)) / (2.0 * d);
    let half_chord_squared = math::sq(r) - math::sq(along);
    if half_chord_squared < 0.0 {
        return [None; 2];
    }
    let half_chord = half_chord_squared.sqrt();
    let foot = p + axis * along;
    [Some(foot + axis.left() * half_chord), Some(foot - axis.left() * half_chord)]
}
