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

/// The line it keeps to, seen from where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Its offset to the right of the lane's centre. [m]
    pub offset_m: f64,
    /// Heading [rad] and curvature [1/m] of the lane beside it, positive to the left.
    pub here: (f64, f64),
    /// The same where it will be after [`PREVIEW_S`].
    pub ahead: (f64, f64),
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
    /// Steering of a vehicle that points this way at this speed, in units of full steering, positive to the left; not
    /// clipped. [rad, m/s]
    pub fn steer(&mut self, plan: &Plan, heading_rad: f64, speed_mps: f64, line: &Line) -> f64 {
        let last_rad = self.last_heading_rad.replace(heading_rad);
        let yaw_rate = last_rad.map_or(0.0, |last| math::wrap_angle(heading_rad - last) / STEP_S);
        // Where the centre of a vehicle moves in a bend is not where it points: its rear axle follows inside, and the tyres
        // slip outwards.
        let arm_m = plan.rear_axle_m - plan.slip_s * speed_mps;
        let course =
            |heading: f64, (lane_rad, curvature): (f64, f64)| math::wrap_angle(heading + arm_m * curvature - lane_rad);
        let (here, ahead) = (course(heading_rad, line.here), course(heading_rad + yaw_rate * PREVIEW_S, line.ahead));
        let offset_m = line.offset_m - speed_mps * PREVIEW_S * math::sin(0.5 * (here + ahead));

        // With a course gain a and an offset gain b the deviation y obeys, per metre of way, y'' + (a + arm b) y' + b y = 0:
        // both poles at 1 / length.
        let length_m = (speed_mps * RETURN_S).max(RETURN_WHEELBASES * plan.wheelbase_m);
        let per_offset = 1.0 / math::sq(length_m);
        let per_course = (2.0 / length_m - arm_m * per_offset).max(1.0 / length_m);
        let back_rad = (line.wanted_m - offset_m) * per_offset / per_course;
        let wanted_rad = (line.drift_rad - back_rad).clamp(-plan.greatest_drift_rad, plan.greatest_drift_rad);
        let fed_forward = line.ahead.1 / (1.0 + line.ahead.1 * offset_m).max(0.1);
        let curvature = fed_forward + per_course * math::wrap_angle(wanted_rad - ahead);
        let most = plan.sideways_mps2 / math::sq(speed_mps.max(SLOW_MPS));
        math::atan2(plan.wheelbase_m * curvature.clamp(-most, most), 1.0) / plan.full_wheel_rad
    }
}
