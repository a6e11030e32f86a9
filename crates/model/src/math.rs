//! Float functions that give the same bits on every machine.
//!
//! The functions of `std` call the platform's maths library, whose last bit differs between systems. These are the pure
//! Rust ones of the `libm` crate. `clippy.toml` bans the others. Angles are in radians.

pub use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub use libm::{acos, asin, atan, atan2, cos, exp, hypot, log as ln, pow, sin, sincos, tan, tanh};

/// `x` squared.
#[inline]
pub fn sq(x: f64) -> f64 {
    x * x
}

/// The angle equal to `angle` in (-pi, pi]. [rad]
#[inline]
pub fn wrap_angle(angle: f64) -> f64 {
    let turns = (angle / TAU).round();
    let wrapped = angle - turns * TAU;
    if wrapped <= -PI { wrapped + TAU } else { wrapped }
}

/// The digits of `number` in `base`, mirrored at the point: the coordinate of that point of a Halton sequence (halton1960).
pub fn radical_inverse(base: u32, mut number: u32) -> f64 {
    let mut value = 0.0;
    let mut scale = 1.0 / f64::from(base);
    while number > 0 {
        value += scale * f64::from(number % base);
        number /= base;
        scale /= f64::from(base);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_points_in_base_two_and_three() {
        assert_eq!([1, 2, 3, 4].map(|number| radical_inverse(2, number)), [0.5, 0.25, 0.75, 0.125]);
        assert!((radical_inverse(3, 2) - 2.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn wraps_into_half_open_interval() {
        assert_eq!(wrap_angle(0.0), 0.0);
        assert!((wrap_angle(1.5 * PI) + 0.5 * PI).abs() < 1e-12);
        assert!((wrap_angle(-1.5 * PI) - 0.5 * PI).abs() < 1e-12);
        assert_eq!(wrap_angle(-PI), PI);
    }
}
