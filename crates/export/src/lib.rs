//! Scenarios in the formats of other tools.
mod opendrive;
mod xml;

use recrash_roads::RoadNetwork;
/// The map as OpenDRIVE 1.7.
pub fn opendrive_document(network: &RoadNetwork, name: &str) -> Vec<u8> {
    opendrive::DriveMap::new(network).document(network, name).document("recrash")
}
