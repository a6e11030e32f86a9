//! Greatest speeds.

use super::staging::Ground;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{MapKind, MapSpec, Turn};

/// A recorded speed below this is that of a vehicle that stood, or nearly did, which the rules do not stage; assumed. [m/s]
pub const LEAST_TOLD_SPEED_MPS: f64 = 1.0;

/// Greatest speed that lets a vehicle hold its lane, below the limits measured in MetaDrive (right turns 10, left turns
/// 12, roundabouts 8.3, straight 22.2 m/s) with a margin for the lanes' centre lines. [m/s]
pub fn most_speed(ground: Ground, turn: Turn) -> f64 {
    match (ground, turn) {
        (Ground::Circle, _) => 6.5,
        (Ground::Road, _) | (Ground::Junction, Turn::Straight) => 20.0,
        (Ground::Junction, Turn::Right) => 6.0,
        (Ground::Junction, Turn::Left) => 8.0,
    }
}

/// Greatest speed of a kind of road user; assumed. [m/s]
pub fn most_speed_of(kind: PartnerKind) -> f64 {
    match kind {
        PartnerKind::Cyclist => 6.0,
        PartnerKind::OtherNonMotorist => 5.0,
        PartnerKind::Pedestrian | PartnerKind::Animal => 1.8,
        _ => f64::INFINITY,
    }
}

/// What lies under a map.
pub fn ground_of(map: &MapSpec) -> Ground {
    match map.kind() {
        MapKind::Road => Ground::Road,
        MapKind::Junction => Ground::Junction,
        MapKind::Roundabout => Ground::Circle,
        MapKind::Network if map.network().is_some_and(|network| network.junctions.is_empty()) => Ground::Road,
        MapKind::Network => Ground::Junction,
    }
}
