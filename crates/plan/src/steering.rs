//! Keeping to a line: one law for every wheelbase and speed.
//!
//! Feedback of course and offset at a previewed place, with the curvature of the line fed forward (snider2009, sections 2
//! to 5; rajamani2012, chapter 3). Behind the preview both poles of the deviation lie at 1 / (return length), so that it
//! dies away without swinging. The length grows with speed and with the wheelbase: that is what a controller with fixed
//! gains, such as MetaDrive's, lacks on two wheels.

use crate::constants::{PREVIEW_S, RETURN_S, RETURN_WHEELBASES, SLOW_MPS};
use crate::speed::Plan;
use recrash_model::math;
use recrash_model::rollout::STEP_S;

/// How a vehicle moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Where it points. [rad]
    pub heading_rad: f64,
    /// Velocity along its axle and to its left. [m/s]
    pub forward_mps: f64,
    /// See [`Self::forward_mps`].
    pub leftward_mps: f64,
}

/// The line it keeps to, seen from where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Its offset to the right of the lane's centre. [m]
    pub offset_m: f64,
    /// Heading of the lane beside it. [rad]
    pub heading_rad: f64,
    /// Heading of the lane where it will be after [`PREVIEW_S`]. [rad]
    pub ahead_rad: f64,
    /// Curvature of the lane there, positive to the left. [1/m]
    pub curvature_per_m: f64,
    /// Offset wanted then. [m]
    pub wanted_m: f64,
    /// Angle of the wanted line to the lane then, positive to the left. [rad]
    pub drift_rad: f64,
}

/// What has to be remembered between decisions.
#[derive(Debug, Clone, Copy, Default)]
pub struct LaneKeeper {
    last_heading_rad: Option<f64>,
}

impl LaneKeeper {
    /// Steering, in units of full steering, positive to the left; not clipped.
    pub fn steer(&mut self, plan: &Plan, motion: &Motion, line: &Line) -> f64 {
        let heading = motion.heading_rad;
        let yaw_rate = self.last_heading_rad.map_or(0.0, |last| math::wrap_angle(heading - last) / STEP_S);
        self.last_heading_rad = Some(heading);
        let speed = (math::sq(motion.forward_mps) + math::sq(motion.leftward_mps)).sqrt();
        let course = heading + math::atan2(motion.leftward_mps, motion.forward_mps.max(SLOW_MPS));
        let error = math::wrap_angle(course - line.heading_rad);
        let error_ahead = math::wrap_angle(course + yaw_rate * PREVIEW_S - line.ahead_rad);
        let offset = line.offset_m - speed * PREVIEW_S * math::sin(0.5 * (error + error_ahead));

        let length = (speed * RETURN_S).max(RETURN_WHEELBASES * plan.wheelbase_m);
        let back = (line.wanted_m - offset) / (2.0 * length);
        let wanted = (line.drift_rad - back).clamp(-plan.greatest_drift_rad, plan.greatest_drift_rad);
        let fed_forward = line.curvature_per_m / (1.0 + line.curvature_per_m * offset).max(0.1);
        let curvature = fed_forward + 2.0 / length * math::wrap_angle(wanted - error_ahead);
        let most = plan.sideways_mps2 / math::sq(speed.max(SLOW_MPS));
        let wheels = math::atan2(plan.wheelbase_m * curvature.clamp(-most, most), 1.0);
        wheels / plan.full_wheel_rad
    }
}
