//! Smooth curves between two places: two arcs that touch (a biarc, bolton1975).

use crate::lane::Centreline;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;

/// A straight line or an arc, with its length. [m]
pub type Stroke = (Centreline, f64);

/// Below this a curve bends too little to be an arc. [m]
const STRAIGHT_M: f64 = 1e-9;

/// The curve from one pose to another, leaving and arriving as they are headed: one or two strokes, the arms of both
/// equally long. `None` where the poses lie so that no such curve exists without turning by more than half a circle.
pub fn between(from: Pose, to: Pose) -> Option<Vec<Stroke>> {
    let (start, end) = (Vec2::from_heading(from.heading), Vec2::from_heading(to.heading));
    let way = to.position - from.position;
    let sum = start + end;
    let bend = 2.0 * (1.0 - start.dot(end));
    let along = way.dot(sum);
    // Both arms are d long: |way - d (start + end)| = 2 d.
    let arm = if bend > 1e-12 {
        (-along + (math::sq(along) + bend * way.length_squared()).sqrt()) / bend
    } else {
        let along = way.dot(end);
        if along <= STRAIGHT_M {
            return None;
        }
        way.length_squared() / (4.0 * along)
    };
    if !arm.is_finite() || arm <= 0.0 {
        return None;
    }
    let middle = (from.position + to.position + (start - end) * arm) * 0.5;
    let first = arc(from.position, start, middle)?;
    // The second arc is the first of the way back.
    let back = arc(to.position, -end, middle)?;
    Some([Some(first), Some(reversed(back))].into_iter().flatten().filter(|(_, length_m)| *length_m > 1e-6).collect())
}

/// The arc that leaves a point in a direction and passes another; at most half a circle.
pub fn arc(from: Vec2, direction: Vec2, to: Vec2) -> Option<Stroke> {
    let way = to - from;
    let (along, aside) = (way.dot(direction), direction.cross(way));
    let heading = math::atan2(direction.y, direction.x);
    if aside.abs() <= STRAIGHT_M.max(1e-9 * way.length()) {
        return (along >= 0.0).then_some((Centreline::Straight { start: from, heading }, along.max(0.0)));
    }
    let radius = way.length_squared() / (2.0 * aside.abs());
    let turn = aside.signum();
    let centre = from + direction.left() * (turn * radius);
    let angle = 2.0 * math::atan2(aside.abs(), along);
    let start_angle = math::wrap_angle(heading - turn * math::FRAC_PI_2);
    (angle <= math::PI + 1e-9).then_some((Centreline::Arc { centre, radius, start_angle, turn }, radius * angle))
}

/// The same stroke the other way.
fn reversed((line, length_m): Stroke) -> Stroke {
    let line = match line {
        Centreline::Straight { start, heading } => Centreline::Straight {
            start: start + Vec2::from_heading(heading) * length_m,
            heading: math::wrap_angle(heading + math::PI),
        },
        Centreline::Arc { centre, radius, start_angle, turn } => Centreline::Arc {
            centre,
            radius,
            start_angle: math::wrap_angle(start_angle + turn * length_m / radius),
            turn: -turn,
        },
    };
    (line, length_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::SegmentShape;

    fn pose(x: f64, y: f64, degrees: f64) -> Pose {
        Pose { position: Vec2::new(x, y), heading: degrees.to_radians() }
    }

    /// Begins, joins and ends in place and direction.
    fn holds(from: Pose, to: Pose) {
        let strokes = between(from, to).expect("a curve");
        let mut at = from;
        for (line, length_m) in strokes {
            let shape = SegmentShape::of_line(&line, length_m);
            let (start, _, heading) = shape.frame(0.0);
            assert!(start.distance(at.position) < 1e-9, "{start:?} {at:?}");
            assert!(math::wrap_angle(heading - at.heading).abs() < 1e-9);
            let (end, _, heading) = shape.frame(length_m);
            at = Pose { position: end, heading };
        }
        assert!(at.position.distance(to.position) < 1e-9);
        assert!(math::wrap_angle(at.heading - to.heading).abs() < 1e-9);
    }

    #[test]
    fn curves_begin_and_end_as_they_are_asked_to() {
        holds(pose(0.0, 0.0, 0.0), pose(20.0, 3.5, 0.0));
        holds(pose(0.0, 0.0, 0.0), pose(10.0, 10.0, 90.0));
        holds(pose(3.0, -2.0, 30.0), pose(-8.0, 4.0, 200.0));
        holds(pose(0.0, 0.0, 0.0), pose(15.0, 0.0, 0.0));
    }

    #[test]
    fn a_quarter_turn_is_one_circle() {
        let strokes = between(pose(0.0, 0.0, 0.0), pose(10.0, 10.0, 90.0)).unwrap();
        for (line, _) in &strokes {
            assert!(matches!(line, Centreline::Arc { radius, .. } if (radius - 10.0).abs() < 1e-9), "{line:?}");
        }
        let length_m: f64 = strokes.iter().map(|(_, length_m)| length_m).sum();
        assert!((length_m - 5.0 * math::PI).abs() < 1e-9);
    }

    #[test]
    fn a_place_exactly_beside_cannot_be_reached() {
        assert!(between(pose(0.0, 0.0, 0.0), pose(0.0, 3.0, 0.0)).is_none());
        assert!(between(pose(0.0, 0.0, 0.0), pose(-5.0, 0.0, 0.0)).is_none());
    }
}
