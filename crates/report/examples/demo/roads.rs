//! Three roads for the made-up suite, and paths on them: drawn by hand, close to the maps of the simulator.

use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_report::{LineKind, RoadDrawing, RoadLine};

/// Length of the approach road, as long as the arms. [m]
pub const APPROACH: f64 = 60.0;
/// Lane width. [m]
pub const LANE: f64 = 3.5;
/// Corner radius of the junction. [m]
const CORNER: f64 = 10.0;
/// Half of the four-lane road. [m]
const HALF: f64 = 2.0 * LANE;
/// Radius of the roundabout's middle lane line. [m]
const RING: f64 = 19.0;

/// Which way a path leaves the block.
#[derive(Clone, Copy, PartialEq)]
pub enum Way {
    /// Straight on.
    Straight,
    /// Left.
    Left,
    /// Right.
    Right,
}

/// From which arm a path comes, in quarter turns of the ego's approach.
#[derive(Clone, Copy, PartialEq)]
pub enum Arm {
    /// The ego's own.
    Same,
    /// The one on the left.
    Left,
    /// The one on the right.
    Right,
    /// The one ahead.
    Ahead,
}

/// A path with its length so far at each point.
pub struct Path {
    points: Vec<(f64, Vec2)>,
}

impl Path {
    fn new(points: Vec<Vec2>) -> Self {
        let mut so_far = 0.0;
        let mut last = points[0];
        let points = points
            .into_iter()
            .map(|point| {
                so_far += point.distance(last);
                last = point;
                (so_far, point)
            })
            .collect();
        Self { points }
    }

    /// Its length. [m]
    pub fn length(&self) -> f64 {
        self.points[self.points.len() - 1].0
    }

    /// Position and heading after `s` metres, `t` metres to the right.
    pub fn at(&self, s: f64, t: f64) -> (Vec2, f64) {
        let next = self.points.partition_point(|(length, _)| *length < s).clamp(1, self.points.len() - 1);
        let ((from, a), (to, b)) = (self.points[next - 1], self.points[next]);
        let along = (b - a) * (1.0 / (to - from));
        (a + along * (s - from) - along.left() * t, math::atan2(along.y, along.x))
    }
}

fn centre() -> Vec2 {
    Vec2::new(APPROACH + CORNER + HALF, 1.5 * LANE)
}

fn turned(point: Vec2, arm: Arm) -> Vec2 {
    let d = point - centre();
    centre()
        + match arm {
            Arm::Same => d,
            Arm::Left => Vec2::new(d.y, -d.x),
            Arm::Right => d.left(),
            Arm::Ahead => -d,
        }
}

fn arc(middle: Vec2, radius: f64, from: f64, to: f64) -> impl Iterator<Item = Vec2> {
    (0..=24).map(move |i| middle + Vec2::from_heading(from + (to - from) * f64::from(i) / 24.0) * radius)
}

/// A path over the four-way intersection.
pub fn crossing(arm: Arm, way: Way, lane: u8) -> Path {
    let y = f64::from(1 - lane) * LANE;
    let entry = Vec2::new(APPROACH, y);
    let mut points = vec![Vec2::new(0.0, y), entry];
    match way {
        Way::Straight => points.push(Vec2::new(2.0 * (APPROACH + CORNER + HALF), y)),
        Way::Left => {
            let radius = CORNER + LANE * f64::from(2 + lane);
            points.extend(arc(entry + Vec2::new(0.0, radius), radius, -math::FRAC_PI_2, 0.0));
            points.push(points[points.len() - 1] + Vec2::new(0.0, APPROACH));
        }
        Way::Right => {
            let radius = CORNER + LANE * f64::from(1 - lane);
            points.extend(arc(entry - Vec2::new(0.0, radius), radius, math::FRAC_PI_2, 0.0));
            points.push(points[points.len() - 1] - Vec2::new(0.0, APPROACH));
        }
    }
    Path::new(points.into_iter().map(|point| turned(point, arm)).collect())
}

/// A path on the straight road.
pub fn straight(lane: u8) -> Path {
    let y = f64::from(1 - lane) * LANE;
    Path::new(vec![Vec2::new(0.0, y), Vec2::new(3.0 * APPROACH, y)])
}

/// A path over the roundabout.
pub fn roundabout(arm: Arm, way: Way) -> Path {
    let radius = RING + 0.5 * LANE;
    let quarters = match way {
        Way::Right => 0.0,
        Way::Straight => 1.0,
        Way::Left => 2.0,
    };
    let mut points = vec![Vec2::new(0.0, 0.0), Vec2::new(centre().x - radius - 8.0, 0.0)];
    let (from, to) = (1.2 * math::PI, (1.3 + 0.5 * quarters) * math::PI);
    points.extend(arc(centre(), radius, from, to));
    let exit = match way {
        Way::Right => Vec2::new(-0.5 * LANE * 3.0, -1.0),
        Way::Straight => Vec2::new(1.0, -1.5 * LANE),
        Way::Left => Vec2::new(1.5 * LANE, 1.0),
    };
    let far = |distance: f64| match way {
        Way::Right => centre() + Vec2::new(exit.x, -distance),
        Way::Straight => centre() + Vec2::new(distance, exit.y),
        Way::Left => centre() + Vec2::new(exit.x, distance),
    };
    points.push(far(radius + 8.0));
    points.push(far(APPROACH + radius));
    Path::new(points.into_iter().map(|point| turned(point, arm)).collect())
}

const ARMS: [Arm; 4] = [Arm::Same, Arm::Left, Arm::Right, Arm::Ahead];

fn line(kind: LineKind, points: Vec<Vec2>) -> RoadLine {
    RoadLine { kind, points }
}

fn arms(lines: &mut Vec<RoadLine>, surfaces: &mut Vec<Vec<Vec2>>, end: f64) {
    for arm in ARMS {
        let at = |x: f64, y: f64| turned(Vec2::new(x, centre().y + y), arm);
        surfaces.push(vec![at(0.0, -HALF), at(end, -HALF), at(end, HALF), at(0.0, HALF)]);
        for side in [-1.0, 1.0] {
            lines.push(line(LineKind::Edge, vec![at(0.0, side * HALF), at(end, side * HALF)]));
            lines.push(line(LineKind::LaneDivider, vec![at(0.0, side * LANE), at(end, side * LANE)]));
        }
        lines.push(line(LineKind::Centre, vec![at(0.0, 0.0), at(end, 0.0)]));
    }
}

/// The four-way intersection.
pub fn crossing_drawing() -> RoadDrawing {
    let (mut lines, mut surfaces) = (Vec::new(), Vec::new());
    arms(&mut lines, &mut surfaces, APPROACH);
    let mut junction = Vec::new();
    for arm in [Arm::Same, Arm::Left, Arm::Ahead, Arm::Right] {
        let middle = Vec2::new(APPROACH, centre().y + HALF + CORNER);
        let corner: Vec<Vec2> = arc(middle, CORNER, -math::FRAC_PI_2, 0.0).map(|p| turned(p, arm)).collect();
        lines.push(line(LineKind::Edge, corner.clone()));
        junction.extend(corner);
    }
    surfaces.push(junction);
    RoadDrawing { surfaces, areas: Vec::new(), lines }
}

/// The straight road.
pub fn straight_drawing() -> RoadDrawing {
    let (low, high, end) = (-0.5 * LANE, 3.5 * LANE, 3.0 * APPROACH);
    let across = |y: f64| vec![Vec2::new(0.0, y), Vec2::new(end, y)];
    RoadDrawing {
        areas: Vec::new(),
        surfaces: vec![vec![Vec2::new(0.0, low), Vec2::new(end, low), Vec2::new(end, high), Vec2::new(0.0, high)]],
        lines: vec![
            line(LineKind::Edge, across(low)),
            line(LineKind::LaneDivider, across(0.5 * LANE)),
            line(LineKind::Centre, across(1.5 * LANE)),
            line(LineKind::LaneDivider, across(2.5 * LANE)),
            line(LineKind::Edge, across(high)),
        ],
    }
}

/// The roundabout.
pub fn roundabout_drawing() -> RoadDrawing {
    let (mut lines, mut surfaces) = (Vec::new(), Vec::new());
    arms(&mut lines, &mut surfaces, centre().x - RING - LANE + 1.2);
    let circle = |radius: f64| arc(centre(), radius, 0.0, math::TAU).collect::<Vec<_>>();
    let mut ring = circle(RING + LANE);
    let mut hole = circle(RING - LANE);
    hole.reverse();
    ring.extend(hole);
    surfaces.push(ring);
    lines.push(line(LineKind::Edge, circle(RING - LANE)));
    lines.push(line(LineKind::LaneDivider, circle(RING)));
    RoadDrawing { surfaces, areas: Vec::new(), lines }
}
