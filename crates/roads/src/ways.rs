//! Places and ways by name.

use crate::lane::LaneId;
use crate::network::RoadNetwork;
use crate::path::LanePath;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::scenario::Place;

/// A place, found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Centre and facing.
    pub pose: Pose,
    /// The lane it is on, along and to the right of it, where it names one. [m]
    pub on: Option<(LaneId, f64, f64)>,
}

/// Why a name means nothing here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WayError {
    /// What is wrong.
    pub message: String,
    /// How to mend it.
    pub hint: String,
}

impl RoadNetwork {
    /// Finds a place.
    ///
    /// # Errors
    /// It names no road or lane of this network, or lies beside its length.
    pub fn place(&self, place: &Place) -> Result<Placed, WayError> {
        match place {
            Place::Plane { x_m, y_m, heading_deg } => {
                let position = Vec2::new(*x_m, *y_m);
                Ok(Placed { pose: Pose { position, heading: heading_deg.to_radians() }, on: None })
            }
            Place::Lane { .. } => Err(WayError { message: "not yet".to_owned(), hint: String::new() }),
        }
    }

    /// A way against the direction of its lanes.
    ///
    /// # Errors
    /// There is none.
    pub fn way_against(&self, _: &[String], _: u8) -> Result<LanePath, WayError> {
        Err(WayError { message: "not yet".to_owned(), hint: String::new() })
    }

    /// The number of the lane of a road that passes nearest to a point.
    pub fn nearest_lane_of(&self, _: &str, _: Vec2) -> u8 {
        0
    }

    /// Where a named road begins along a way. [m]
    pub fn begins_on(&self, _: &LanePath, _: &str) -> f64 {
        0.0
    }

    /// Finds a way.
    ///
    /// # Errors
    /// There is none.
    pub fn way(&self, _: &[String], _: u8, _: Option<u8>) -> Result<LanePath, WayError> {
        Err(WayError { message: "not yet".to_owned(), hint: String::new() })
    }
}
