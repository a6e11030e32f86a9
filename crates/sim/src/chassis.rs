//! The vehicle: a rigid body on four sprung wheels, as MetaDrive's physics engine moves it.
//!
//! MetaDrive's vehicles are Bullet raycast vehicles. Their behaviour (1.5 g of braking, yaw and slip that lag by 0.1 s, a
//! rear axle that lets go first) comes from a few simple rules about impulses at the wheels, applied every 0.02 s. The
//! same rules in the plane, plus heave, pitch and roll at small angles, follow the original to centimetres.
//! Equations, symbols and the comparison: `docs/models/vehicle.md`.
//!
//! What this does **not** do: nobody drives backwards, and who collides leaves its wheels for its momentum (`impact.rs`,
//! `contacts.rs`) where a plan or time after the contact asks for it; else a contact pushes nothing.

use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
pub use recrash_model::rollout::PHYSICS_STEP_S;
use recrash_model::rollout::Substeps;
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::{DRY_TYRE_FRICTION, GRAVITY_MPS2, VehicleSpec};
use recrash_plan::constants::SETTLED_HEIGHT_M;
use wide::f64x2;

/// Share of the sideways velocity at a wheel that one usual physics step takes away (Bullet, `resolveSingleBilateral`); another
/// step takes as much in the same time.
const CONTACT_DAMPING: f64 = 0.2;

/// Weight of the driving or braking impulse in the friction circle (Bullet, `btRaycastVehicle::updateFriction`): tyres
/// hold twice as much along as across. This is why full braking reaches 1.5 g.
const ALONG_WEIGHT: f64 = 0.5;

/// How much of the side force's arm below the centre of mass turns the body (`setRollInfluence`).
const ROLL_INFLUENCE: f64 = 0.5;

/// Spring stiffness of a wheel per mass of the vehicle (`SUSPENSION_STIFFNESS`). [1/s^2]
const SPRING_PER_S2: f64 = 40.0;

/// Damping of a wheel that moves up, per mass of the vehicle (`setWheelsDampingCompression`). [1/s]
const COMPRESSION_PER_S: f64 = 1.2;

/// Damping of a wheel that moves down, per mass of the vehicle (`setWheelsDampingRelaxation`). [1/s]
const RELAXATION_PER_S: f64 = 4.8;

/// Height of the centre of mass at which the springs are free: 0.4 m of spring and a wheel of 0.313 m that hangs 0.113 m
/// above it. [m]
const FREE_HEIGHT_M: f64 = 0.6;

/// Height of the centre of mass when a vehicle appears; it settles at 0.539 m within 0.6 s. [m]
const SPAWN_HEIGHT_M: f64 = 0.595;

/// Greatest force of one spring per mass of the vehicle: Bullet's 6000 N for MetaDrive's 1100 kg. [m/s^2]
const SPRING_LIMIT_MPS2: f64 = 6000.0 / 1100.0;

/// Rolling resistance when neither throttle nor brake is applied (`setBrake(2.0)` on 1100 kg). [m/s^2]
const COAST_MPS2: f64 = 4.0 * 2.0 / (1100.0 * PHYSICS_STEP_S);

/// Below this speed a vehicle that is not driven stands. Bullet jitters there instead, by up to 0.24 m/s, and creeps
/// backwards; that is not reproduced. [m/s]
const STANDSTILL_MPS: f64 = 0.05;

/// What a driver asks for, held for one step of 0.1 s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Controls {
    /// Steering, -1 to 1, left positive.
    pub steer: f64,
    /// Throttle (positive) or brake (negative), -1 to 1.
    pub throttle: f64,
}

impl Controls {
    /// The controls for an acceleration [m/s^2] and a wheel angle [rad, left positive] of this vehicle.
    ///
    /// Where the tyres hold (up to 8.2 m/s^2 of braking on a dry road), the vehicle follows within 0.1 s.
    pub fn of_acceleration(acceleration_mps2: f64, wheel_angle_rad: f64, spec: &VehicleSpec) -> Self {
        let full = if acceleration_mps2 >= 0.0 { spec.max_acceleration_mps2 } else { spec.brake_demand_mps2 };
        let steer = wheel_angle_rad / spec.max_wheel_angle_rad.max(1e-3);
        Self { steer, throttle: acceleration_mps2 / full.max(1e-3) }.clipped()
    }

    /// Within the limits; not a number counts as nothing asked for.
    #[must_use]
    pub fn clipped(self) -> Self {
        let clip = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(-1.0, 1.0) };
        Self { steer: clip(self.steer), throttle: clip(self.throttle) }
    }
}

/// Constants of one vehicle, per unit of its mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chassis {
    /// Centre of mass to front axle. [m]
    front_axle_m: f64,
    /// Centre of mass to rear axle. [m]
    rear_axle_m: f64,
    /// Half of the track. [m]
    half_track_m: f64,
    /// Moments of inertia per mass about the vertical, the forward and the sideways axis, inverted. [1/m^2]
    yaw_per_m2: f64,
    roll_per_m2: f64,
    pitch_per_m2: f64,
    /// Friction of the tyres.
    friction: f64,
    /// Acceleration at full throttle. [m/s^2]
    engine_mps2: f64,
    /// Deceleration the brakes ask for at full brake; the tyres may give less. [m/s^2]
    brake_mps2: f64,
    /// Speed above which the engine is cut. [m/s]
    max_speed_mps: f64,
    /// Wheel angle at full steering. [rad]
    max_wheel_angle_rad: f64,
    /// Physics step. [s]
    step_s: f64,
    /// Share of the sideways velocity at a wheel that a physics step takes away.
    damping: f64,
}

impl Chassis {
    /// The constants of a vehicle on a surface, in the usual physics steps.
    pub fn new(spec: &VehicleSpec, surface: Surface) -> Self {
        Self::in_steps(spec, surface, Substeps::default())
    }

    /// The same in other physics steps.
    pub fn in_steps(spec: &VehicleSpec, surface: Surface, substeps: Substeps) -> Self {
        let inverse_inertia = |a: f64, b: f64| 12.0 / (math::sq(a) + math::sq(b));
        let (length, width, height) = (spec.chassis_length_m, spec.chassis_width_m, spec.chassis_height_m);
        Self {
            front_axle_m: spec.front_axle_m,
            rear_axle_m: spec.rear_axle_m,
            half_track_m: spec.half_track_m,
            yaw_per_m2: inverse_inertia(length, width),
            roll_per_m2: inverse_inertia(width, height),
            pitch_per_m2: inverse_inertia(length, height),
            friction: DRY_TYRE_FRICTION * surface.relative_friction(),
            engine_mps2: spec.max_acceleration_mps2,
            brake_mps2: spec.brake_demand_mps2,
            max_speed_mps: spec.max_speed_mps,
            max_wheel_angle_rad: spec.max_wheel_angle_rad,
            step_s: substeps.step_s(),
            damping: CONTACT_DAMPING * (substeps.step_s() / PHYSICS_STEP_S),
        }
    }
}

/// State of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleState {
    /// Where everybody sees it: one physics step behind the body, as MetaDrive publishes it.
    pub pose: Pose,
    /// Where the body is.
    body: Pose,
    /// Unit vector of the body's heading.
    axis: Vec2,
    /// Velocity of the centre, along the body and to its left. [m/s]
    forward_mps: f64,
    leftward_mps: f64,
    /// [rad/s]
    yaw_rate: f64,
    /// Height of the centre of mass and its rate. [m, m/s]
    height_m: f64,
    climb_mps: f64,
    /// Nose down. [rad, rad/s]
    pitch: f64,
    pitch_rate: f64,
    /// Right side down. [rad, rad/s]
    roll: f64,
    roll_rate: f64,
}

/// Controls, translated for the wheels once per step.
#[derive(Debug, Clone, Copy)]
pub struct WheelCommand {
    /// Sine and cosine of the front wheels' angle.
    sin: f64,
    cos: f64,
    /// Impulse of the engine on each wheel, per mass and physics step; 0 where it does not drive. [m/s]
    drive: f64,
    /// Greatest braking impulse on each wheel, per mass and physics step. [m/s]
    brake: f64,
    /// Inverse of the mass a wheel feels across its direction, without the part that depends on height: front left and
    /// right, and rear.
    across_front: f64x2,
    across_rear: f64,
    /// The part that depends on height squared: front, rear. [1/m^2]
    across_height: [f64; 2],
    /// Mass all wheels together feel along their direction.
    along: f64,
}

impl VehicleState {
    /// A vehicle that has just been put on the road.
    pub fn new(pose: Pose, speed_mps: f64) -> Self {
        Self {
            pose,
            body: pose,
            axis: Vec2::from_heading(pose.heading),
            forward_mps: speed_mps,
            leftward_mps: 0.0,
            yaw_rate: 0.0,
            height_m: SPAWN_HEIGHT_M,
            climb_mps: 0.0,
            pitch: 0.0,
            pitch_rate: 0.0,
            roll: 0.0,
            roll_rate: 0.0,
        }
    }

    /// A vehicle that has been on the road for a while: its springs carry it.
    pub(crate) fn rolling(pose: Pose, velocity: Vec2, yaw_rate: f64, step_s: f64) -> Self {
        let axis = Vec2::from_heading(pose.heading);
        // What others see lags by a physics step; so that it goes on without a break, the body is ahead by one.
        let body = Pose { position: pose.position + velocity * step_s, heading: pose.heading + yaw_rate * step_s };
        Self {
            body,
            forward_mps: velocity.dot(axis).max(0.0),
            leftward_mps: velocity.dot(axis.left()),
            yaw_rate,
            height_m: SETTLED_HEIGHT_M,
            ..Self::new(pose, 0.0)
        }
    }

    /// Puts the body where something else than its wheels has moved it.
    pub(crate) fn carry(&mut self, pose: Pose, velocity: Vec2, yaw_rate: f64) {
        (self.pose, self.body, self.axis) = (pose, pose, Vec2::from_heading(pose.heading));
        (self.forward_mps, self.leftward_mps) = (velocity.dot(self.axis), velocity.dot(self.axis.left()));
        self.yaw_rate = yaw_rate;
    }

    /// Speed over ground. [m/s]
    #[inline]
    pub fn speed(&self) -> f64 {
        (math::sq(self.forward_mps) + math::sq(self.leftward_mps)).sqrt()
    }

    /// Velocity over ground. [m/s]
    #[inline]
    pub fn velocity(&self) -> Vec2 {
        self.axis * self.forward_mps + self.axis.left() * self.leftward_mps
    }

    /// Rate of turn. [rad/s]
    #[inline]
    pub fn yaw_rate(&self) -> f64 {
        self.yaw_rate
    }

    /// Whether every number that others see is finite.
    pub fn is_finite(&self) -> bool {
        let sum = self.body.position.x + self.body.position.y + self.body.heading + self.forward_mps;
        (sum + self.leftward_mps + self.yaw_rate).is_finite()
    }

    /// What the controls mean for the wheels during the next step.
    pub fn command(&mut self, chassis: &Chassis, controls: Controls) -> WheelCommand {
        // Rotating the axis by small angles gathers rounding; once per step it is made exact again.
        self.axis = Vec2::from_heading(self.body.heading);
        let (sin, cos) = math::sincos(controls.steer * chassis.max_wheel_angle_rad);
        let per_wheel = 0.25 * chassis.step_s;
        let (drive, brake) = if controls.throttle < 0.0 {
            (0.0, -controls.throttle * chassis.brake_mps2 * per_wheel)
        } else if self.speed() > chassis.max_speed_mps {
            (0.0, COAST_MPS2 * per_wheel)
        } else {
            // With no throttle at all the rolling resistance acts; with any, it does not.
            (controls.throttle * chassis.engine_mps2 * per_wheel, COAST_MPS2 * per_wheel)
        };
        let arm = |y: f64| chassis.front_axle_m * cos + y * sin;
        let (sin2, cos2) = (math::sq(sin), math::sq(cos));
        WheelCommand {
            sin,
            cos,
            drive,
            brake,
            across_front: f64x2::new([
                1.0 + math::sq(arm(chassis.half_track_m)) * chassis.yaw_per_m2,
                1.0 + math::sq(arm(-chassis.half_track_m)) * chassis.yaw_per_m2,
            ]),
            across_rear: 1.0 + math::sq(chassis.rear_axle_m) * chassis.yaw_per_m2,
            across_height: [cos2 * chassis.roll_per_m2 + sin2 * chassis.pitch_per_m2, chassis.roll_per_m2],
            along: 1.0
                / (1.0
                    + math::sq(chassis.half_track_m) * chassis.yaw_per_m2
                    + math::sq(self.height_m) * chassis.pitch_per_m2),
        }
    }

    /// One physics step: the body moves with the velocity it has, then the wheels change the velocity.
    #[inline]
    pub fn advance(&mut self, chassis: &Chassis, command: &WheelCommand) {
        self.pose = self.body;
        self.integrate(chassis.step_s);
        let loads = self.spring(chassis);
        self.grip(chassis, command, loads);
        if command.drive == 0.0 && self.forward_mps <= STANDSTILL_MPS {
            self.forward_mps = 0.0;
            self.leftward_mps = 0.0;
            self.yaw_rate = 0.0;
        }
    }

    /// Positions from velocities (symplectic Euler, as Bullet's).
    #[inline]
    fn integrate(&mut self, dt: f64) {
        self.body.position = self.body.position + self.velocity() * dt;
        let turned = self.yaw_rate * dt;
        self.body.heading += turned;
        let (sin, cos) = small_sincos(turned);
        self.axis = self.axis * cos + self.axis.left() * sin;
        // The velocity keeps its direction in the world while the body turns under it.
        let (forward, leftward) = (self.forward_mps, self.leftward_mps);
        self.forward_mps = forward * cos + leftward * sin;
        self.leftward_mps = leftward * cos - forward * sin;
        self.climb_mps -= GRAVITY_MPS2 * dt;
        self.height_m += self.climb_mps * dt;
        self.pitch += self.pitch_rate * dt;
        self.roll += self.roll_rate * dt;
    }

    /// Springs and dampers: the load of the front and the rear wheels per mass of the vehicle, left and right, and what the
    /// loads do to heave, pitch and roll. [m/s^2]
    #[inline]
    fn spring(&mut self, chassis: &Chassis) -> [f64x2; 2] {
        let zero = f64x2::splat(0.0);
        let to_side = f64x2::new([chassis.half_track_m, -chassis.half_track_m]);
        let (rolled, rolling) = (to_side * self.roll, to_side * self.roll_rate);
        let load = |x: f64| {
            let squeeze = FREE_HEIGHT_M - (self.height_m - x * self.pitch + rolled);
            let rising = self.climb_mps - x * self.pitch_rate + rolling;
            let damping = rising.simd_lt(zero).select(f64x2::splat(COMPRESSION_PER_S), f64x2::splat(RELAXATION_PER_S));
            let load = clamp(SPRING_PER_S2 * squeeze - damping * rising, zero, f64x2::splat(SPRING_LIMIT_MPS2));
            squeeze.simd_lt(zero).select(zero, load)
        };
        let (front, rear) = (load(chassis.front_axle_m), load(-chassis.rear_axle_m));
        let ([fl, fr], [rl, rr]) = (front.to_array(), rear.to_array());
        let dt = chassis.step_s;
        self.climb_mps += (fl + fr + rl + rr) * dt;
        self.pitch_rate -=
            ((fl + fr) * chassis.front_axle_m - (rl + rr) * chassis.rear_axle_m) * chassis.pitch_per_m2 * dt;
        self.roll_rate += (fl + rl - fr - rr) * chassis.half_track_m * chassis.roll_per_m2 * dt;
        [front, rear]
    }

    /// Tyres: what the engine or the brake wants along each wheel and what keeps it from slipping sideways, both within
    /// the friction circle, applied as impulses.
    #[inline]
    fn grip(&mut self, chassis: &Chassis, command: &WheelCommand, loads: [f64x2; 2]) {
        let (sin, cos, height) = (command.sin, command.cos, self.height_m);
        let (front, rear, track) = (chassis.front_axle_m, chassis.rear_axle_m, chassis.half_track_m);

        // Velocity of the contact points: along the body left and right, to the left front and rear.
        let along = self.forward_mps - self.pitch_rate * height - f64x2::new([track, -track]) * self.yaw_rate;
        let sideways = self.leftward_mps + self.roll_rate * height;
        let (sideways_front, sideways_rear) = (sideways + front * self.yaw_rate, sideways - rear * self.yaw_rate);

        // Impulses per mass: front and rear, each left and right.
        let height2 = math::sq(height);
        let mass_front = 1.0 / (command.across_front + height2 * command.across_height[0]);
        let mass_rear = 1.0 / (command.across_rear + height2 * command.across_height[1]);
        let mut side = [
            -chassis.damping * mass_front * (sideways_front * cos - along * sin),
            f64x2::splat(-chassis.damping * mass_rear * sideways_rear),
        ];
        let mut push = [f64x2::splat(command.drive); 2];
        if command.drive == 0.0 {
            let stop = -0.25 * command.along;
            let limit = f64x2::splat(command.brake);
            push =
                [clamp(stop * (along * cos + sideways_front * sin), -limit, limit), clamp(stop * along, -limit, limit)];
        }
        for axle in 0..2 {
            let hold = loads[axle] * chassis.friction * chassis.step_s;
            let weighted = ALONG_WEIGHT * push[axle];
            let wanted = weighted * weighted + side[axle] * side[axle];
            let slips = wanted.simd_gt(hold * hold);
            if slips.any() {
                let share = slips.select(hold / wanted.sqrt(), f64x2::splat(1.0));
                push[axle] *= share;
                side[axle] *= share;
            }
        }

        let ([push_fl, push_fr], [side_fl, side_fr]) = (push[0].to_array(), side[0].to_array());
        let ([push_rl, push_rr], [side_rl, side_rr]) = (push[1].to_array(), side[1].to_array());
        let (push_front, side_front) = (push_fl + push_fr, side_fl + side_fr);
        let (push_rear, side_rear) = (push_rl + push_rr, side_rl + side_rr);
        let forward_front = push_front * cos - side_front * sin;
        let leftward_front = push_front * sin + side_front * cos;
        let forward_left_minus_right = (push_fl - push_fr) * cos - (side_fl - side_fr) * sin + (push_rl - push_rr);
        self.forward_mps += forward_front + push_rear;
        self.leftward_mps += leftward_front + side_rear;
        self.yaw_rate +=
            (front * leftward_front - rear * side_rear - track * forward_left_minus_right) * chassis.yaw_per_m2;
        let side_height = height * ROLL_INFLUENCE;
        self.pitch_rate -=
            (height * (push_front * cos + push_rear) - side_height * side_front * sin) * chassis.pitch_per_m2;
        self.roll_rate +=
            (height * push_front * sin + side_height * (side_front * cos + side_rear)) * chassis.roll_per_m2;
    }
}

/// As `f64::clamp` of both, with the same zeros on every machine.
#[inline]
fn clamp(x: f64x2, least: f64x2, most: f64x2) -> f64x2 {
    let x = x.simd_lt(least).select(least, x);
    x.simd_gt(most).select(most, x)
}

/// Sine and cosine of an angle below 0.1 rad, by series; the error is below 1e-13.
#[inline]
fn small_sincos(x: f64) -> (f64, f64) {
    let x2 = x * x;
    (
        x * (1.0 - x2 * (1.0 / 6.0) * (1.0 - x2 * (1.0 / 20.0) * (1.0 - x2 * (1.0 / 42.0)))),
        1.0 - 0.5 * x2 * (1.0 - x2 * (1.0 / 12.0) * (1.0 - x2 * (1.0 / 30.0))),
    )
}
