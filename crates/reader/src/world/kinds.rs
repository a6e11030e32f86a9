//! What kinds of road users and things may mean the same.

use crate::chunk::Noun;
use crate::lexicon::{Adjective, Relation};
use recrash_model::account::{Kind, KindGroup};

/// Trucks that are called by both words.
pub(super) fn is_big_truck(kind: Kind) -> bool {
    matches!(kind, Kind::HeavyTruck | Kind::SemiTrailerTruck)
}

/// Whether it is called a truck: "the truck" is a box truck rather than the bus that was named since.
pub(super) fn is_truck(kind: Kind) -> bool {
    kind.group() == KindGroup::Truck && !matches!(kind, Kind::Bus | Kind::SchoolBus | Kind::Tram)
}

/// Whether nobody calls it a passenger vehicle.
pub fn is_no_passenger_vehicle(kind: Kind) -> bool {
    matches!(kind, Kind::Bus | Kind::SchoolBus | Kind::Tram | Kind::SemiTrailerTruck | Kind::GarbageTruck)
        || kind.group() == KindGroup::Motorcycle
}

/// Whether somebody of this kind does things.
pub(super) fn acts(kind: Kind) -> bool {
    !matches!(kind.group(), KindGroup::Object)
}

/// Where an adjective says that somebody is: "the oncoming van".
pub(super) fn relation_of(noun: &Noun) -> Option<Relation> {
    noun.adjectives.iter().find_map(|adjective| match adjective {
        Adjective::Oncoming => Some(Relation::Opposite),
        Adjective::Following => Some(Relation::Behind),
        Adjective::Lead => Some(Relation::Ahead),
        _ => None,
    })
}

/// Whether what somebody is called cannot be another name of whom is known by these: "a white van", "the red one".
pub(super) fn contradicts(known: &[String], said: &[String]) -> bool {
    !known.is_empty() && !said.is_empty() && !known.iter().any(|name| said.contains(name))
}

/// Whether "a" noun of the second kind can bring on somebody who was announced as the first.
pub(super) fn introduces(announced: Kind, said: Kind) -> bool {
    let generic = matches!(announced, Kind::Vehicle | Kind::HeavyTruck | Kind::FirstResponder | Kind::PassengerCar)
        || announced.group() == KindGroup::Object;
    announced == said
        || said == Kind::Vehicle
        || announced == Kind::SemiTrailerTruck && said == Kind::HeavyTruck
        || (same_kind(announced, said)
            && (generic || !matches!(said, Kind::HeavyTruck | Kind::PassengerCar | Kind::Object)))
}

/// Whether a noun of the second kind can mean somebody known by the first.
pub fn same_kind(known: Kind, said: Kind) -> bool {
    // "The scooter" of a riderless one.
    let empty = known == Kind::Scooter && matches!(said, Kind::ScooterRider | Kind::Bicycle | Kind::EBike);
    if known == said || empty {
        return true;
    }
    let (one, other) = (known.group(), said.group());
    match said {
        Kind::Vehicle => known.is_vehicle() || matches!(one, KindGroup::Motorcycle),
        Kind::HeavyTruck => {
            one == KindGroup::Truck || matches!(known, Kind::Pickup | Kind::PickupWithTrailer | Kind::Vehicle)
        }
        Kind::PassengerCar => matches!(known, Kind::Vehicle | Kind::PoliceCar),
        Kind::Trailer => matches!(
            known,
            Kind::SemiTrailerTruck
                | Kind::PickupWithTrailer
                | Kind::HeavyTruck
                | Kind::BoxTruck
                | Kind::ConstructionVehicle
        ),
        Kind::Object | Kind::Debris => one == KindGroup::Object,
        Kind::Pedestrian => one == KindGroup::OnFoot,
        Kind::Scooter => known == Kind::Moped,
        Kind::Pickup if known == Kind::PickupWithTrailer => true,
        _ if known == Kind::Vehicle => said.is_vehicle(),
        _ if known == Kind::HeavyTruck => other == KindGroup::Truck,
        Kind::Pickup => known == Kind::PickupWithTrailer,
        Kind::Minivan | Kind::Van => matches!(known, Kind::Van | Kind::Minivan),
        Kind::SemiTrailerTruck => known == Kind::Trailer,
        // No fire engine is the SUV of the headline.
        Kind::PoliceCar => matches!(known, Kind::FirstResponder | Kind::PassengerCar | Kind::Suv),
        Kind::Ambulance => matches!(known, Kind::FirstResponder | Kind::Van),
        Kind::FireTruck => known == Kind::FirstResponder,
        Kind::FirstResponder => matches!(known, Kind::PoliceCar | Kind::Ambulance | Kind::FireTruck),
        Kind::Bus | Kind::SchoolBus => matches!(known, Kind::Bus | Kind::SchoolBus),
        _ => one == other && matches!(one, KindGroup::Motorcycle | KindGroup::Cyclist),
    }
}
