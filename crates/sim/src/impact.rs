//! What a collision does to two bodies in the plane: impulses along and across the plane of contact (brach2005).
//!
//! Equations and constants: `docs/models/impact.md`.

use crate::movement::Loose;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::math;
use recrash_model::severity::Impact;

/// What the two do where they touch.
const IMPACT: Impact = Impact::OF_MOTION;

/// A body, as a collision sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Body {
    pub(crate) outline: OrientedBox,
    pub(crate) velocity: Vec2,
    /// [rad/s]
    pub(crate) yaw_rate: f64,
    /// [kg]
    pub(crate) mass_kg: f64,
}

impl Body {
    /// Moment of inertia of its box about the vertical. [kg m^2]
    fn inertia(&self) -> f64 {
        self.mass_kg * (math::sq(2.0 * self.outline.half_length) + math::sq(2.0 * self.outline.half_width)) / 12.0
    }

    fn at(&self, arm: Vec2) -> Vec2 {
        self.velocity + arm.left() * self.yaw_rate
    }
}

/// Velocities and yaw rates after the collision of two bodies that overlap; as before, where they part already.
pub(crate) fn collide(a: &Body, b: &Body) -> (Loose, Loose) {
    let keep = |body: &Body| Loose {
        pose: recrash_model::geometry::Pose {
            position: body.outline.centre,
            heading: math::atan2(body.outline.axis.y, body.outline.axis.x),
        },
        velocity: body.velocity,
        yaw_rate: body.yaw_rate,
    };
    let (mut first, mut second) = (keep(a), keep(b));
    let point = contact_point(&a.outline, &b.outline);
    let (arm_a, arm_b) = (point - a.outline.centre, point - b.outline.centre);
    let relative = a.at(arm_a) - b.at(arm_b);
    let normal = a.outline.contact_normal(&b.outline, relative);
    let closing = relative.dot(normal);
    if closing <= 0.0 {
        return (first, second);
    }
    let yielding = |direction: Vec2| {
        let turn = |arm: Vec2, body: &Body| math::sq(arm.cross(direction)) / body.inertia();
        1.0 / a.mass_kg + 1.0 / b.mass_kg + turn(arm_a, a) + turn(arm_b, b)
    };
    let push = (1.0 + IMPACT.restitution) * closing / yielding(normal);
    let along = normal.left();
    let most = IMPACT.friction * push;
    let rub = (relative.dot(along) / yielding(along)).clamp(-most, most);
    let impulse = normal * push + along * rub;
    first.velocity = first.velocity - impulse * (1.0 / a.mass_kg);
    first.yaw_rate -= arm_a.cross(impulse) / a.inertia();
    second.velocity = second.velocity + impulse * (1.0 / b.mass_kg);
    second.yaw_rate += arm_b.cross(impulse) / b.inertia();
    (first, second)
}

/// The middle of what two boxes share.
fn contact_point(a: &OrientedBox, b: &OrientedBox) -> Vec2 {
    // Corners of each that lie in the other.
    let inside = |outline: &OrientedBox, point: Vec2| {
        let local = outline.to_local(point);
        local.x.abs() <= outline.half_length + 1e-6 && local.y.abs() <= outline.half_width + 1e-6
    };
    let shared = a
        .corners()
        .into_iter()
        .filter(|corner| inside(b, *corner))
        .chain(b.corners().into_iter().filter(|corner| inside(a, *corner)));
    let (sum, count) = shared.fold((Vec2::default(), 0.0), |(sum, count), corner| (sum + corner, count + 1.0));
    if count > 0.0 { sum * (1.0 / count) } else { (a.centre + b.centre) * 0.5 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::geometry::Pose;

    fn body(x: f64, y: f64, degrees: f64, speed: f64, mass_kg: f64) -> Body {
        let heading = degrees.to_radians();
        let pose = Pose { position: Vec2::new(x, y), heading };
        Body {
            outline: OrientedBox::new(pose, 4.5, 1.8),
            velocity: Vec2::from_heading(heading) * speed,
            yaw_rate: 0.0,
            mass_kg,
        }
    }

    #[test]
    fn equal_cars_front_on_rear_share_the_speed() {
        let (behind, ahead) = collide(&body(0.0, 0.0, 0.0, 10.0, 1500.0), &body(4.49, 0.0, 0.0, 0.0, 1500.0));
        assert!((behind.velocity.x - 4.5).abs() < 1e-9 && (ahead.velocity.x - 5.5).abs() < 1e-9);
        assert!(behind.yaw_rate.abs() < 1e-9 && ahead.yaw_rate.abs() < 1e-9);
    }

    #[test]
    fn momentum_is_kept_and_energy_is_lost_in_any_collision() {
        for (a, b) in [
            (body(0.0, 0.0, 0.0, 12.0, 1500.0), body(3.0, 1.5, 70.0, 8.0, 9000.0)),
            (body(0.0, 0.0, 10.0, 5.0, 1500.0), body(1.0, 1.75, 15.0, 3.0, 80.0)),
            (body(0.0, 0.0, 0.0, 15.0, 1200.0), body(4.2, 0.9, 180.0, 15.0, 2400.0)),
        ] {
            let (first, second) = collide(&a, &b);
            let momentum = |x: Vec2, y: Vec2| x * a.mass_kg + y * b.mass_kg;
            let change = momentum(first.velocity, second.velocity) - momentum(a.velocity, b.velocity);
            assert!(change.length() < 1e-6, "{change:?}");
            let energy =
                |v: Vec2, w: f64, body: &Body| 0.5 * body.mass_kg * v.length_squared() + 0.5 * body.inertia() * w * w;
            let before = energy(a.velocity, 0.0, &a) + energy(b.velocity, 0.0, &b);
            let after = energy(first.velocity, first.yaw_rate, &a) + energy(second.velocity, second.yaw_rate, &b);
            assert!(after <= before + 1e-6, "{after} {before}");
        }
    }

    #[test]
    fn who_parts_already_is_left_alone() {
        let (a, b) = (body(0.0, 0.0, 0.0, 5.0, 1500.0), body(4.49, 0.0, 0.0, 6.0, 1500.0));
        let (first, second) = collide(&a, &b);
        assert_eq!((first.velocity, second.velocity), (a.velocity, b.velocity));
    }

    #[test]
    fn a_bumper_that_has_gone_far_in_beside_an_edge_is_still_a_blow_from_behind() {
        // 25 cm of overlap sideways, at 15 m/s, seen from 1 to 29 cm into the car: what one physics step may leave.
        let after = |depth_m: f64| {
            let (behind, ahead) =
                collide(&body(depth_m - 4.5, 1.55, 0.0, 15.0, 1500.0), &body(0.0, 0.0, 0.0, 0.0, 1500.0));
            (behind.velocity.x, ahead.velocity.x)
        };
        let (first_behind, first_ahead) = after(0.01);
        assert!(first_ahead > 5.0, "{first_ahead}");
        for centimetres in 2..30 {
            let (behind, ahead) = after(0.01 * f64::from(centimetres));
            assert!((behind - first_behind).abs() < 0.2 && (ahead - first_ahead).abs() < 0.2, "{behind} {ahead}");
        }
    }
}
