//! What moves a road user: wheels, a plan, or nothing but its momentum after a collision.

use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;

/// What moves a road user now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Mover {
    /// Four wheels, an engine and brakes.
    #[default]
    Wheels,
    /// A plan of acts, exactly.
    Plan,
    /// Its momentum.
    Momentum,
}

/// Deceleration of who slides and brakes after a collision on a dry road: half of what locked wheels give, since not every
/// wheel is locked; assumed. [m/s^2]
const AFTER_CRASH_MPS2: f64 = 3.5;

/// A turn left by a collision goes down to 1/e in this time; assumed. [s]
const TURNS_FOR_S: f64 = 0.3;

/// A body after a collision.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Loose {
    pub(crate) pose: Pose,
    pub(crate) velocity: Vec2,
    /// [rad/s]
    pub(crate) yaw_rate: f64,
}

impl Loose {
    /// Slides on; stands exactly in the end. [s]
    pub(crate) fn advance(&mut self, friction: f64, time_s: f64) {
        let speed = self.velocity.length();
        let lost = AFTER_CRASH_MPS2 * friction * time_s;
        if speed <= lost {
            let until_s = speed / (AFTER_CRASH_MPS2 * friction);
            self.pose.position = self.pose.position + self.velocity * (0.5 * until_s);
            *self = Self { velocity: Vec2::default(), yaw_rate: 0.0, ..*self };
            return;
        }
        let slower = self.velocity * ((speed - lost) / speed);
        self.pose.position = self.pose.position + (self.velocity + slower) * (0.5 * time_s);
        self.pose.heading = math::wrap_angle(self.pose.heading + self.yaw_rate * time_s);
        self.velocity = slower;
        self.yaw_rate *= 1.0 - time_s / TURNS_FOR_S;
    }
}
