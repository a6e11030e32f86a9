//! Plans: what partners do along their lanes, and within which limits.

use crate::constants::{
    COMFORTABLE_MPS2, GREATEST_BRAKING_MPS2, GREATEST_DRIFT_ON_FOOT_RAD, GREATEST_DRIFT_RAD, SHARE_OF_BRAKES,
    STOPPING_MPS2,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::PHYSICS_STEP_S;
use recrash_model::scenario::{DEFAULT_SPEED_KP, Policy};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::{DRY_TYRE_FRICTION, GRAVITY_MPS2, VehicleSpec};
use serde::Serialize;

/// Bullet's tyres hold this much more along than across (`docs/models/vehicle.md`).
const ALONG_PER_ACROSS: f64 = 2.0;

/// Share of a wheel's sideways speed that one physics step takes away (`docs/models/vehicle.md`).
const DAMPING: f64 = 0.2;

/// Height of the centre of mass of a vehicle that has settled on its springs. [m]
const SETTLED_HEIGHT_M: f64 = 0.539;

/// What a partner does along its lane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum SpeedPlan {
    /// Throttle for some steps, then a speed; full brake in a window of steps.
    Timed {
        /// Throttle of the first part. [-1 to 1]
        throttle: f64,
        /// First step without it.
        throttle_until: u32,
        /// Speed to hold. [m/s]
        speed_mps: f64,
        /// First step of full braking.
        brake_from: u32,
        /// First step after it.
        brake_until: u32,
    },
    /// MetaDrive's gap law behind whoever is in front.
    Follow {
        /// Speed it wants. [m/s]
        speed_mps: f64,
    },
    /// Stands until a step, then a speed.
    Wait {
        /// The step at which it sets off; `None` is never.
        until: Option<u32>,
        /// Speed to hold then. [m/s]
        speed_mps: f64,
    },
    /// A speed, but gives way.
    GiveWay {
        /// Speed it wants. [m/s]
        speed_mps: f64,
        /// Time that must be left between two at a crossing. [s]
        gap_s: f64,
    },
}

/// What a partner does, and with which limits. Sizes are those of its kind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Plan {
    /// Along its lane.
    pub speed: SpeedPlan,
    /// Start to the right of its lane's centre. [m]
    pub start_t_m: f64,
    /// The wanted line runs at no more than this angle to the lane. [rad]
    pub greatest_drift_rad: f64,
    /// Acceleration per missing speed. [1/s]
    pub gain_per_s: f64,
    /// Acceleration at full throttle. [m/s^2]
    pub full_throttle_mps2: f64,
    /// Deceleration that full brakes ask for. [m/s^2]
    pub full_brake_mps2: f64,
    /// Deceleration with which it comes down to a speed. [m/s^2]
    pub comfortable_mps2: f64,
    /// Deceleration with which it stops at a place. [m/s^2]
    pub stopping_mps2: f64,
    /// The most it brakes outside of a window of full braking and of the gap law. [m/s^2]
    pub greatest_braking_mps2: f64,
    /// What its brakes and tyres reach in a window of full braking, about. [m/s^2]
    pub hardest_mps2: f64,
    /// Speed above which its engine is cut. [m/s]
    pub fastest_mps: f64,
    /// Greatest sideways acceleration. [m/s^2]
    pub sideways_mps2: f64,
    /// Distance of its axles. [m]
    pub wheelbase_m: f64,
    /// From its centre back to its rear axle. [m]
    pub rear_axle_m: f64,
    /// Sideways speed at which its tyres give a sideways acceleration: the ratio. [s]
    pub slip_s: f64,
    /// Wheel angle at full steering. [rad]
    pub full_wheel_rad: f64,
    /// Half of its length. [m]
    pub half_length_m: f64,
    /// Half of its width. [m]
    pub half_width_m: f64,
}

/// What matters to the pedals at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Number of the step, from 0.
    pub step: u32,
    /// Own speed. [m/s]
    pub speed_mps: f64,
    /// How far along its way its centre is. [m]
    pub s_m: f64,
    /// How far to the right of the lane's centre it is. [m]
    pub t_m: f64,
    /// How far to the right of the lane's centre it wants to be. [m]
    pub wanted_t_m: f64,
    /// Distance from its centre to where it has to give way now, if it has to. [m]
    pub give_way_m: Option<f64>,
    /// What the gap law says, for who follows. [throttle]
    pub gap_law: f64,
}

impl Plan {
    /// The plan of a partner of this kind.
    pub fn new(kind: PartnerKind, policy: &Policy, start_t_m: f64, surface: Surface) -> Self {
        let spec = VehicleSpec::of(kind);
        let (speed, speed_kp) = match *policy {
            Policy::SuddenBrake { target_speed, brake_step, brake_steps, speed_kp } => (
                SpeedPlan::Timed {
                    throttle: 0.0,
                    throttle_until: 0,
                    speed_mps: target_speed,
                    brake_from: brake_step,
                    brake_until: brake_step.saturating_add(brake_steps),
                },
                speed_kp,
            ),
            Policy::AccelThenBrake { accel_mag, accel_steps, cruise_speed, brake_step, brake_steps, speed_kp } => (
                SpeedPlan::Timed {
                    throttle: accel_mag,
                    throttle_until: accel_steps,
                    speed_mps: cruise_speed,
                    brake_from: brake_step,
                    brake_until: brake_step.saturating_add(brake_steps),
                },
                speed_kp,
            ),
            Policy::IdmNominal { target_speed_mps } => (SpeedPlan::Follow { speed_mps: target_speed_mps }, None),
            Policy::Stopped { depart_step, target_speed_mps } => {
                (SpeedPlan::Wait { until: depart_step, speed_mps: target_speed_mps }, None)
            }
            Policy::Yielding { target_speed_mps, gap_s } => {
                (SpeedPlan::GiveWay { speed_mps: target_speed_mps, gap_s }, None)
            }
        };
        let friction = surface.relative_friction();
        let reaches_mps2 = spec.max_deceleration_mps2.min(GRAVITY_MPS2 * DRY_TYRE_FRICTION * friction);
        let at_most = |wanted: f64| wanted.min(SHARE_OF_BRAKES * reaches_mps2);
        let nimble = VehicleSpec::is_nimble(kind);
        Self {
            speed,
            start_t_m,
            greatest_drift_rad: if nimble { GREATEST_DRIFT_ON_FOOT_RAD } else { GREATEST_DRIFT_RAD },
            gain_per_s: speed_kp.unwrap_or(DEFAULT_SPEED_KP) * spec.max_acceleration_mps2,
            full_throttle_mps2: spec.max_acceleration_mps2,
            full_brake_mps2: spec.brake_demand_mps2,
            comfortable_mps2: at_most(COMFORTABLE_MPS2),
            stopping_mps2: at_most(STOPPING_MPS2),
            greatest_braking_mps2: GREATEST_BRAKING_MPS2.min(reaches_mps2),
            hardest_mps2: spec
                .max_deceleration_mps2
                .min(ALONG_PER_ACROSS * GRAVITY_MPS2 * DRY_TYRE_FRICTION * friction),
            fastest_mps: spec.max_speed_mps,
            sideways_mps2: spec.sideways_mps2 * friction,
            wheelbase_m: spec.front_axle_m + spec.rear_axle_m,
            rear_axle_m: spec.rear_axle_m,
            slip_s: slip_s(&spec),
            full_wheel_rad: spec.max_wheel_angle_rad,
            half_length_m: 0.5 * spec.length_m,
            half_width_m: 0.5 * spec.width_m,
        }
    }

    /// The speed it wants to hold. [m/s]
    pub fn speed_mps(&self) -> f64 {
        match self.speed {
            SpeedPlan::Timed { speed_mps, .. }
            | SpeedPlan::Follow { speed_mps }
            | SpeedPlan::Wait { speed_mps, .. }
            | SpeedPlan::GiveWay { speed_mps, .. } => speed_mps,
        }
    }

    /// Whether it still waits to set off.
    pub fn waits(&self, step: u32) -> bool {
        matches!(self.speed, SpeedPlan::Wait { until, .. } if until.is_none_or(|until| step < until))
    }

    /// Whether something in it will still change its speed after this step.
    pub fn has_plans(&self, step: u32) -> bool {
        match self.speed {
            SpeedPlan::Timed { speed_mps, throttle_until, brake_until, .. } => {
                speed_mps > 0.0 || step < throttle_until || step < brake_until
            }
            SpeedPlan::Follow { .. } | SpeedPlan::GiveWay { .. } => false,
            SpeedPlan::Wait { until, speed_mps } => speed_mps > 0.0 && until.is_some_and(|until| step <= until),
        }
    }
}

/// Sideways speed over sideways acceleration of a vehicle in a steady bend: each physics step takes a fifth of a wheel's
/// sideways speed away, times the mass that the wheel feels (`docs/models/vehicle.md`, "Grip"). [s]
fn slip_s(spec: &VehicleSpec) -> f64 {
    let sq = recrash_model::math::sq;
    let inertia = |a: f64, b: f64| (sq(a) + sq(b)) / 12.0;
    let yaw_m2 = inertia(spec.chassis_length_m, spec.chassis_width_m);
    let roll_m2 = inertia(spec.chassis_width_m, spec.chassis_height_m);
    let felt = |arm_m: f64| 1.0 / (1.0 + sq(arm_m) / yaw_m2 + sq(SETTLED_HEIGHT_M) / roll_m2);
    PHYSICS_STEP_S / (DAMPING * 2.0 * (felt(spec.front_axle_m) + felt(spec.rear_axle_m)))
}
