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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_into_half_open_interval() {
        assert_eq!(wrap_angle(0.0), 0.0);
        assert!((wrap_angle(1.5 * PI) + 0.5 * PI).abs() < 1e-12);
        assert!((wrap_angle(-1.5 * PI) - 0.5 * PI).abs() < 1e-12);
        assert_eq!(wrap_angle(-PI), PI);
    }
}
