//! Sizes and limits of road users, by kind.

use crate::kinds::PartnerKind;

/// The hardest that tyres let anybody brake on a dry road: 1 g. Peak coefficients of friction on dry asphalt are 0.8 to 0.9 (wong2008).
/// Vehicles of MetaDrive, and of the native simulator as they are, brake with up to 1.8 g. [m/s^2]
pub const TYRE_LIMIT_MPS2: f64 = GRAVITY_MPS2;

/// Standard gravity, as MetaDrive sets it. [m/s^2]
pub const GRAVITY_MPS2: f64 = 9.81;

/// Tyre friction of MetaDrive's vehicles (`wheel_friction`) on its only surface, taken for a dry road.
pub const DRY_TYRE_FRICTION: f64 = 0.9;

/// Size and limits of one kind of road user. Sources: `docs/models/vehicle.md`.
///
/// The outline is what others can touch; the chassis is what the physics turns and tilts. Two-wheelers and people move on
/// small chassis of their own, wide enough not to fall over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleSpec {
    /// Length of the outline. [m]
    pub length_m: f64,
    /// Width of the outline. [m]
    pub width_m: f64,
    /// From the centre of the outline forward to the front axle. [m]
    pub front_axle_m: f64,
    /// From the centre of the outline back to the rear axle. [m]
    pub rear_axle_m: f64,
    /// Half of the distance between left and right wheels. [m]
    pub half_track_m: f64,
    /// Length of the body whose inertia resists yaw and pitch. [m]
    pub chassis_length_m: f64,
    /// Width of that body. [m]
    pub chassis_width_m: f64,
    /// Height of that body. [m]
    pub chassis_height_m: f64,
    /// Acceleration at full throttle. [m/s^2]
    pub max_acceleration_mps2: f64,
    /// Deceleration at full brake on a dry road. [m/s^2, positive]
    pub max_deceleration_mps2: f64,
    /// Deceleration the brakes ask for at full brake; where it is more than the tyres hold, they decide. [m/s^2]
    pub brake_demand_mps2: f64,
    /// Sideways acceleration that its driver uses at most on a dry road; tyres hold 8.7. [m/s^2]
    pub sideways_mps2: f64,
    /// Speed at which the engine is cut. [m/s]
    pub max_speed_mps: f64,
    /// Wheel angle at full steering. [rad]
    pub max_wheel_angle_rad: f64,
}

/// MetaDrive's `StaticDefaultVehicle`, as measured.
const CAR: VehicleSpec = VehicleSpec {
    length_m: 4.515,
    width_m: 1.852,
    front_axle_m: 1.052_34,
    rear_axle_m: 1.416_6,
    half_track_m: 0.815,
    chassis_length_m: 4.515,
    chassis_width_m: 1.852,
    chassis_height_m: 1.19,
    max_acceleration_mps2: 2.909_090_909_090_909,
    max_deceleration_mps2: 15.13,
    brake_demand_mps2: 27.272_727_272_727_273,
    sideways_mps2: 8.0,
    max_speed_mps: 80.0 / 3.6,
    max_wheel_angle_rad: 40.0 * std::f64::consts::PI / 180.0,
};

impl VehicleSpec {
    /// The vehicle of this kind. The ego is a passenger car.
    pub const fn of(kind: PartnerKind) -> Self {
        match kind {
            PartnerKind::PassengerCar => CAR,
            // MetaDrive's LVehicle and XLVehicle in outline.
            PartnerKind::Suv => Self { length_m: 4.87, width_m: 2.046, ..CAR },
            PartnerKind::PickupTruck | PartnerKind::FirstResponder => Self { length_m: 5.74, width_m: 2.3, ..CAR },
            PartnerKind::Van => Self { length_m: 5.4, width_m: 2.0, ..CAR },
            // AASHTO's single-unit truck SU-30 (9.1 m, wheelbase 6.1 m) and city bus (12.2 m, wheelbase 7.6 m).
            // Sideways: a loaded truck may tip over from 0.35 g on (winkler1999), its driver keeps well below; passengers who
            // stand are given 0.2 g (aashto2018).
            PartnerKind::HeavyTruck => Self { sideways_mps2: 2.5, ..Self::heavy(9.1, 2.4, 6.1, 1.1, 6.0) },
            PartnerKind::Bus => Self { sideways_mps2: 2.0, ..Self::heavy(12.2, 2.6, 7.6, 1.0, 6.0) },
            PartnerKind::Motorcycle => Self::light([2.2, 0.8], 1.4, [2.909, 8.0], 80.0 / 3.6),
            // Who leans by 25 degrees turns with 4.5 m/s^2; assumed.
            PartnerKind::Cyclist => Self { sideways_mps2: 4.5, ..Self::light([1.8, 0.6], 1.1, [1.0, 3.4], 9.0) },
            PartnerKind::OtherNonMotorist => {
                Self { sideways_mps2: 4.5, ..Self::light([1.2, 0.6], 0.9, [1.0, 3.4], 7.0) }
            }
            PartnerKind::Pedestrian => Self::light([0.5, 0.5], 0.5, [1.5, 3.0], 3.0),
            // Long enough that it does not tip over when it brakes with 5 m/s^2.
            PartnerKind::Animal => Self::light([1.0, 0.4], 0.9, [2.909, 5.0], 12.0),
            PartnerKind::FixedObject => Self::light([1.0, 1.0], 0.9, [0.0, 8.0], 0.0),
        }
    }

    /// A long vehicle: its body, and so its inertia, is as long as its outline.
    const fn heavy(length_m: f64, width_m: f64, wheelbase_m: f64, acceleration: f64, deceleration: f64) -> Self {
        Self {
            length_m,
            width_m,
            // Axles so that the centre of the outline lies a little ahead of the middle of the wheelbase, as the car's.
            front_axle_m: 0.45 * wheelbase_m,
            rear_axle_m: 0.55 * wheelbase_m,
            half_track_m: 1.0,
            chassis_length_m: length_m,
            chassis_width_m: width_m,
            max_acceleration_mps2: acceleration,
            max_deceleration_mps2: deceleration,
            brake_demand_mps2: deceleration,
            ..CAR
        }
    }

    /// A light road user: outline, wheelbase, acceleration and deceleration, top speed.
    const fn light(outline: [f64; 2], wheelbase_m: f64, limits: [f64; 2], max_speed_mps: f64) -> Self {
        Self {
            length_m: outline[0],
            width_m: outline[1],
            front_axle_m: 0.5 * wheelbase_m,
            rear_axle_m: 0.5 * wheelbase_m,
            half_track_m: 0.4,
            // As long as the wheelbase, so that yaw follows the steering as quickly as a car's.
            chassis_length_m: wheelbase_m,
            chassis_width_m: 0.8,
            max_acceleration_mps2: limits[0],
            max_deceleration_mps2: limits[1],
            brake_demand_mps2: limits[1],
            max_speed_mps,
            ..CAR
        }
    }

    /// Mass of a road user with who is in or on it; `None` for what stands firm. [kg]
    pub const fn mass_kg(kind: PartnerKind) -> Option<f64> {
        match kind {
            // Mean of new cars and of all new light vehicles in the United States, 2017 to 2022 (iihs2025).
            PartnerKind::PassengerCar => Some(1500.0),
            PartnerKind::Suv | PartnerKind::Van => Some(1814.0),
            // The pickup and the single-unit truck that roadside barriers are tested with (mash2016: 2270P, 10000S).
            PartnerKind::PickupTruck | PartnerKind::FirstResponder => Some(2270.0),
            PartnerKind::HeavyTruck => Some(10_000.0),
            // A city bus of 12 m without passengers; assumed, as are those below.
            PartnerKind::Bus => Some(13_600.0),
            PartnerKind::Motorcycle => Some(300.0),
            PartnerKind::Cyclist => Some(95.0),
            PartnerKind::OtherNonMotorist => Some(90.0),
            PartnerKind::Pedestrian => Some(80.0),
            PartnerKind::Animal => Some(70.0),
            PartnerKind::FixedObject => None,
        }
    }

    /// Whether this kind can turn on the spot, almost: it walks, or steps on and off what it rides.
    pub const fn is_nimble(kind: PartnerKind) -> bool {
        matches!(kind, PartnerKind::Pedestrian | PartnerKind::Animal | PartnerKind::OtherNonMotorist)
    }
}
