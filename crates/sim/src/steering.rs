//! Lane keeping as MetaDrive's policies do it: two PID controllers, one on heading, one on the offset from the lane.

use crate::lanes::PreparedLane;
use recrash_model::geometry::Pose;
use recrash_model::math;

/// How far ahead on the lane the wanted heading is read. [m]
const LOOK_AHEAD_M: f64 = 1.0;

/// A PID controller that counts in steps of 0.1 s: its integral is a plain sum and its derivative a plain difference, so
/// the gains carry no unit of time. It is never reset, not even where the lane changes under it.
#[derive(Debug, Clone, Copy)]
struct Pid {
    proportional: f64,
    integral: f64,
    derivative: f64,
    sum: f64,
    last: f64,
}

impl Pid {
    const fn new(proportional: f64, integral: f64, derivative: f64) -> Self {
        Self { proportional, integral, derivative, sum: 0.0, last: 0.0 }
    }

    fn respond(&mut self, error: f64) -> f64 {
        self.sum += error;
        let change = error - self.last;
        self.last = error;
        self.proportional * error + self.integral * self.sum + self.derivative * change
    }
}

/// Keeps a vehicle on a lane, or beside its centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaneKeeper {
    heading: Pid,
    lateral: Pid,
}

impl LaneKeeper {
    /// With MetaDrive's gains: steering per radian and per metre.
    pub(crate) const fn new() -> Self {
        Self { heading: Pid::new(1.7, 0.01, 3.5), lateral: Pid::new(0.3, 0.002, 0.05) }
    }

    /// Steering towards the line `t_m` to the right of the lane's centre, in units of full steering; not clipped.
    ///
    /// `drift` is the angle to the left of the lane at which the wanted line itself runs. [rad]
    #[inline]
    pub(crate) fn steer(&mut self, lane: &PreparedLane, pose: Pose, t_m: f64, drift: f64) -> f64 {
        let (s, t) = lane.local(pose.position);
        let heading = lane.heading(s + LOOK_AHEAD_M) + drift;
        self.heading.respond(math::wrap_angle(heading - pose.heading)) + self.lateral.respond(t - t_m)
    }
}
