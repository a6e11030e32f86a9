//! From a map to its network: one of the paper's blocks, or roads and junctions.

use crate::network::RoadNetwork;
use crate::{blocks, graph};
use recrash_model::Diagnostic;
use recrash_model::scenario::MapSpec;

impl RoadNetwork {
    /// Builds the network of a map that is known to be sound: a block of the paper whose numbers are in range, or what
    /// [`crate::check()`] has let through.
    ///
    /// # Panics
    /// Where [`Self::try_build`] finds a problem.
    pub fn build(map: &MapSpec) -> Self {
        Self::try_build(map).expect("the map is sound")
    }

    /// Builds the network. The numbers of `map` must be in range (see [`crate::check()`]).
    ///
    /// # Errors
    /// What is wrong with a network of roads, each with its JSON path.
    pub fn try_build(map: &MapSpec) -> Result<Self, Vec<Diagnostic>> {
        match map {
            MapSpec::G(map) => graph::build(map),
            _ => Ok(blocks::build(map)),
        }
    }
}
