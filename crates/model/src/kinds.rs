//! Kinds of road users, of records and of scenarios.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of crash partner (column `Crash With`), and of any road user in a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PartnerKind {
    /// `Passenger Car`.
    #[default]
    PassengerCar,
    /// `SUV`.
    Suv,
    /// `Van`.
    Van,
    /// `Pickup Truck`.
    PickupTruck,
    /// `Heavy Truck`.
    HeavyTruck,
    /// `Bus`.
    Bus,
    /// `Motorcycle`.
    Motorcycle,
    /// `Non-Motorist: Cyclist`.
    Cyclist,
    /// `Non-Motorist: Pedestrian`.
    Pedestrian,
    /// `Non-Motorist: Other` (scooters, skateboards).
    OtherNonMotorist,
    /// `First Responder Vehicle`.
    FirstResponder,
    /// `Animal`.
    Animal,
    /// `Other Fixed Object`, `Pole / Tree`.
    FixedObject,
}

impl PartnerKind {
    /// For tables and sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::PassengerCar => "passenger car",
            Self::Suv => "SUV",
            Self::Van => "van",
            Self::PickupTruck => "pickup truck",
            Self::HeavyTruck => "heavy truck",
            Self::Bus => "bus",
            Self::Motorcycle => "motorcycle",
            Self::Cyclist => "cyclist",
            Self::Pedestrian => "pedestrian",
            Self::OtherNonMotorist => "other non-motorist",
            Self::FirstResponder => "first responder",
            Self::Animal => "animal",
            Self::FixedObject => "fixed object",
        }
    }

    /// Whether somebody sits in or on it, or it is somebody.
    pub const fn has_people(self) -> bool {
        !matches!(self, Self::Animal | Self::FixedObject)
    }

    /// Every kind.
    pub const ALL: [Self; 13] = [
        Self::PassengerCar,
        Self::Suv,
        Self::Van,
        Self::PickupTruck,
        Self::HeavyTruck,
        Self::Bus,
        Self::Motorcycle,
        Self::Cyclist,
        Self::Pedestrian,
        Self::OtherNonMotorist,
        Self::FirstResponder,
        Self::Animal,
        Self::FixedObject,
    ];
}
