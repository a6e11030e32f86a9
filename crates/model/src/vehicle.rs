//! Sizes and limits of road users, by kind.

use crate::record::PartnerKind;

/// Size and limits of one kind of road user. Sources: `docs/models/vehicles.md`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleSpec {
    /// Length of the box. [m]
    pub length_m: f64,
    /// Width of the box. [m]
    pub width_m: f64,
    /// From the centre of the box forward to the front axle. [m]
    pub front_axle_m: f64,
    /// From the centre of the box back to the rear axle. [m]
    pub rear_axle_m: f64,
    /// Acceleration at full throttle. [m/s^2]
    pub max_acceleration_mps2: f64,
    /// Deceleration at full brake. [m/s^2, positive]
    pub max_deceleration_mps2: f64,
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
    max_acceleration_mps2: 2.909,
    max_deceleration_mps2: 15.13,
    max_speed_mps: 80.0 / 3.6,
    max_wheel_angle_rad: 40.0 * std::f64::consts::PI / 180.0,
};

impl VehicleSpec {
    /// The vehicle of this kind. The ego is a passenger car.
    pub const fn of(kind: PartnerKind) -> Self {
        match kind {
            PartnerKind::PassengerCar => CAR,
            PartnerKind::Suv => Self { length_m: 4.87, width_m: 2.046, ..CAR },
            PartnerKind::Van => Self { length_m: 5.4, width_m: 2.0, ..CAR },
            PartnerKind::PickupTruck | PartnerKind::FirstResponder => Self { length_m: 5.74, width_m: 2.3, ..CAR },
            PartnerKind::HeavyTruck => Self { length_m: 9.0, width_m: 2.5, ..CAR },
            PartnerKind::Bus => Self { length_m: 12.0, width_m: 2.55, ..CAR },
            PartnerKind::Motorcycle => Self { length_m: 2.2, width_m: 0.8, ..CAR },
            PartnerKind::Cyclist => Self { length_m: 1.8, width_m: 0.6, ..CAR },
            PartnerKind::OtherNonMotorist => Self { length_m: 1.2, width_m: 0.6, ..CAR },
            PartnerKind::Pedestrian => Self { length_m: 0.5, width_m: 0.5, ..CAR },
            PartnerKind::Animal => Self { length_m: 1.0, width_m: 0.4, ..CAR },
            PartnerKind::FixedObject => Self { length_m: 1.0, width_m: 1.0, ..CAR },
        }
    }
}
