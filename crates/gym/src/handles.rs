//! What a driver answers, as controls of the vehicle.

use crate::scene::Scene;
use recrash_model::math;
use recrash_sim::{Controls, Observation};

/// Which kind of answer a driver gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Handles {
    /// Two numbers from -1 to 1: steering (left positive, 1 at the greatest wheel angle) and throttle (negative brakes).
    Pedals,
    /// Two numbers from -1 to 1: acceleration (1 the most the engine gives, -1 the most the brakes ask for), and the place
    /// beside the route to steer to (1 is `WIDEST_M` to the right).
    Guided,
    /// A position in [`ACTS`].
    Acts,
}

/// One of a few things to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Act {
    /// For people.
    pub name: &'static str,
    /// Acceleration. [m/s^2]
    pub acceleration_mps2: f64,
    /// The place beside the route to steer to, to the right. [m]
    pub beside_m: f64,
}

/// A swerve goes this far to the side: half of a lane. [m]
const SWERVE_M: f64 = 1.75;

/// The widest place beside the route of [`Handles::Guided`]: a lane's width. [m]
pub const WIDEST_M: f64 = 3.5;

/// What there is to choose from: four accelerations, each on the route, to its left and to its right.
pub const ACTS: [Act; 12] = [
    act("keep", 0.0, 0.0),
    act("accelerate", 2.0, 0.0),
    act("slow", -2.5, 0.0),
    act("brake", -8.0, 0.0),
    act("left", 0.0, -SWERVE_M),
    act("accelerate left", 2.0, -SWERVE_M),
    act("slow left", -2.5, -SWERVE_M),
    act("brake left", -8.0, -SWERVE_M),
    act("right", 0.0, SWERVE_M),
    act("accelerate right", 2.0, SWERVE_M),
    act("slow right", -2.5, SWERVE_M),
    act("brake right", -8.0, SWERVE_M),
];

const fn act(name: &'static str, acceleration_mps2: f64, beside_m: f64) -> Act {
    Act { name, acceleration_mps2, beside_m }
}

impl Handles {
    /// How many numbers an answer has; none where it is a position in [`ACTS`].
    pub const fn numbers(self) -> usize {
        match self {
            Self::Pedals | Self::Guided => 2,
            Self::Acts => 0,
        }
    }

    /// Controls of an answer of two numbers.
    pub(crate) fn of_numbers(
        self,
        [first, second]: [f64; 2],
        scene: &Scene,
        observation: &Observation<'_>,
    ) -> Controls {
        if self == Self::Pedals {
            return Controls { steer: first, throttle: second }.clipped();
        }
        let steer = steering(scene, observation, second.clamp(-1.0, 1.0) * WIDEST_M);
        Controls { steer, throttle: first }.clipped()
    }

    /// Controls of one of [`ACTS`].
    pub(crate) fn of_act(number: usize, scene: &Scene, observation: &Observation<'_>) -> Controls {
        let act = ACTS[number];
        let throttle = Controls::of_acceleration(act.acceleration_mps2, 0.0, &scene.vehicle).throttle;
        Controls { steer: steering(scene, observation, act.beside_m), throttle }
    }
}

/// Pure pursuit of a line beside the route (coulter1992): an arc from the rear axle to a point of it.
fn steering(scene: &Scene, observation: &Observation<'_>, beside_m: f64) -> f64 {
    let (ego, forward) = (&observation.states[0], observation.forward(0));
    let ahead_m = 4.0 + 0.6 * ego.speed().max(0.0);
    let (point, direction) = scene.way.at(observation.route_s_m + ahead_m);
    let target = point - direction.left() * beside_m;
    let rear = ego.position() - forward * scene.vehicle.rear_axle_m;
    let apart = target - rear;
    let curvature = 2.0 * forward.cross(apart) / apart.length_squared().max(1.0);
    let wheelbase_m = scene.vehicle.front_axle_m + scene.vehicle.rear_axle_m;
    math::atan(wheelbase_m * curvature) / scene.vehicle.max_wheel_angle_rad.max(1e-3)
}
