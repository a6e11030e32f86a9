//! Sizes of kinds that are longer or shorter than the group they belong to.

use recrash_model::account::Kind;
use recrash_model::scenario::Size;

/// Sizes of kinds that are longer or shorter than the group they belong to; usual ones, assumed. [m]
pub(crate) fn size_of(kind: Kind) -> Option<Size> {
    let size = |length_m: f64, width_m: f64| Some(Size { length_m, width_m });
    match kind {
        Kind::SemiTrailerTruck => size(16.0, 2.6),
        Kind::BoxTruck | Kind::FoodTruck => size(7.5, 2.4),
        Kind::PickupWithTrailer => size(11.0, 2.1),
        Kind::Ambulance => size(6.8, 2.3),
        Kind::FireTruck => size(10.0, 2.5),
        Kind::Tram => size(22.0, 2.6),
        Kind::Forklift => size(3.0, 1.2),
        Kind::ConstructionVehicle => size(6.0, 2.4),
        Kind::PoliceCar | Kind::FirstResponder => size(4.9, 2.0),
        Kind::Trailer => size(5.0, 2.2),
        Kind::DeliveryRobot | Kind::Cart | Kind::Scooter => size(0.8, 0.6),
        Kind::Wall | Kind::Curb => size(6.0, 0.3),
        Kind::Gate | Kind::Chain | Kind::Barrier => size(0.2, 4.0),
        Kind::Pole | Kind::Sign | Kind::Cone => size(0.3, 0.3),
        Kind::Debris | Kind::LooseWheel | Kind::TreeBranch | Kind::Cargo | Kind::Object | Kind::Pothole => {
            size(0.6, 0.6)
        }
        _ => None,
    }
}
