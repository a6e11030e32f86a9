//! Time to collision of two oriented boxes that keep their velocities and headings.
//!
//! Model, formula and sources: `docs/models/time-to-collision.md`.

use recrash_model::geometry::{OrientedBox, Vec2};

/// Time until two boxes touch when both keep velocity and heading: 0 when they touch already, `None` when they never
/// will. Velocities in m/s. [s]
///
/// Exact, not stepped: by the separating axis theorem the boxes touch at time `t` when their shadows overlap on the
/// four box axes; on each axis that is an interval of time, and the first instant common to all four is the answer.
pub fn time_to_collision(a: &OrientedBox, velocity_a: Vec2, b: &OrientedBox, velocity_b: Vec2) -> Option<f64> {
    let offset = b.centre - a.centre;
    let velocity = velocity_b - velocity_a;
    let (mut begin, mut end) = (0.0_f64, f64::INFINITY);
    for (axis, reach) in separating_axes(a, b) {
        let (distance, rate) = (axis.dot(offset), axis.dot(velocity));
        if !(distance.is_finite() && rate.is_finite()) {
            return None;
        }
        if rate == 0.0 {
            if distance.abs() > reach {
                return None;
            }
            continue;
        }
        let (one, other) = ((-reach - distance) / rate, (reach - distance) / rate);
        begin = begin.max(one.min(other));
        end = end.min(one.max(other));
        if begin > end {
            return None;
        }
    }
    Some(begin)
}

/// The four axes that can separate two boxes, each with the sum of the half shadows on it.
#[inline]
pub(crate) fn separating_axes(a: &OrientedBox, b: &OrientedBox) -> [(Vec2, f64); 4] {
    let cos = a.axis.dot(b.axis).abs();
    let sin = a.axis.cross(b.axis).abs();
    [
        (a.axis, a.half_length + b.half_length * cos + b.half_width * sin),
        (a.axis.left(), a.half_width + b.half_length * sin + b.half_width * cos),
        (b.axis, b.half_length + a.half_length * cos + a.half_width * sin),
        (b.axis.left(), b.half_width + a.half_length * sin + a.half_width * cos),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::geometry::Pose;
    use recrash_model::math;

    fn car(x: f64, y: f64, heading: f64) -> OrientedBox {
        OrientedBox::new(Pose { position: Vec2::new(x, y), heading }, 4.0, 2.0)
    }

    fn along(heading: f64, speed: f64) -> Vec2 {
        Vec2::from_heading(heading) * speed
    }

    #[test]
    fn behind_a_slower_car_it_is_gap_over_closing_speed() {
        // 20 m/s behind 10 m/s, 55.5 m between the bumpers.
        let ttc = time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 20.0), &car(59.5, 0.0, 0.0), along(0.0, 10.0));
        assert!((ttc.unwrap() - 5.55).abs() < 1e-12, "{ttc:?}");
    }

    #[test]
    fn behind_a_faster_car_there_is_none() {
        assert_eq!(
            time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 10.0), &car(20.0, 0.0, 0.0), along(0.0, 12.0)),
            None
        );
    }

    #[test]
    fn crossing_at_right_angles_the_later_of_the_two_arrivals_counts() {
        // The ego's front reaches the other's lane (x = 19) after 17 m; the other's front reaches the ego's lane (y = -1)
        // after 27 m. Both at 10 m/s: 2.7 s, while the ego is inside from 1.7 to 2.3 s only.
        let other = car(20.0, -30.0, math::FRAC_PI_2);
        assert_eq!(
            time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 10.0), &other, along(math::FRAC_PI_2, 10.0)),
            None
        );
        // 7 m nearer: it enters at 2.0 s.
        let other = car(20.0, -23.0, math::FRAC_PI_2);
        let ttc = time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 10.0), &other, along(math::FRAC_PI_2, 10.0));
        assert!((ttc.unwrap() - 2.0).abs() < 1e-12, "{ttc:?}");
    }

    #[test]
    fn side_by_side_at_the_same_speed_there_is_none_and_drifting_there_is_one() {
        let other = car(0.5, 3.5, 0.0);
        assert_eq!(time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 8.0), &other, along(0.0, 8.0)), None);
        // 1.5 m between the sides, drifting in at 0.5 m/s.
        let ttc = time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 8.0), &other, Vec2::new(8.0, -0.5));
        assert!((ttc.unwrap() - 3.0).abs() < 1e-12, "{ttc:?}");
    }

    #[test]
    fn touching_boxes_have_none_left() {
        assert_eq!(
            time_to_collision(&car(0.0, 0.0, 0.0), Vec2::default(), &car(4.0, 0.0, 0.0), Vec2::default()),
            Some(0.0)
        );
    }

    #[test]
    fn numbers_that_are_none_give_none() {
        let broken = car(f64::NAN, 0.0, 0.0);
        assert_eq!(time_to_collision(&car(0.0, 0.0, 0.0), along(0.0, 8.0), &broken, along(0.0, 8.0)), None);
    }
}
