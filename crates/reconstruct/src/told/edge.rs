//! Questions to what is told of what stands at the edge of the road.

use crate::told::crash::Told;
use crate::told::side::Turning;
use recrash_model::account::{LeftRight, PlaceKind};
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;

impl Told {
    /// Whether the partner is parked along the road at whose edge it stands.
    pub(crate) fn is_parked_along(&self) -> bool {
        self.edge.is_some() && self.thing.is_none()
    }

    /// What lies beside the outermost lane on the side where the partner stands.
    pub(crate) fn beside_edge(&self) -> Vec<StripKind> {
        let lot = self.place.is_off_street();
        let parks = self.is_parked_along() || self.sv.movement == Some(Movement::ParkingManeuver) && !lot;
        match (parks, self.place) {
            (true, _) if self.diagonal => vec![StripKind::Stalls, StripKind::Sidewalk],
            (true, _) => vec![StripKind::Parking, StripKind::Sidewalk],
            (false, PlaceKind::Highway) if self.sv.movement != Some(Movement::Straight) => vec![StripKind::Shoulder],
            (false, PlaceKind::Highway) => Vec::new(),
            (false, _) if lot => Vec::new(),
            (false, _) => vec![StripKind::Sidewalk],
        }
    }

    /// Whether the edge is that of a median, which parts the two directions.
    pub(crate) fn edge_is_median(&self) -> bool {
        let street = self.place.is_street();
        self.edge == Some(LeftRight::Left) && self.thing.is_some() && (street || self.sv.turning != Turning::No)
    }
}

/// What is longer goes along the road. [m]
pub(crate) const LONG_M: f64 = 2.5;

/// What goes along the road is at no greater angle to it, and who is told to be parked diagonally at no smaller one. [deg]
pub(crate) const ALONG_DEG: f64 = 15.0;
