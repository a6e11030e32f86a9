//! Roads and their strips, piece by piece.

use crate::usual::LANE_M;
use recrash_model::scenario::{LinePiece, RoadSpec, RoadStart, Strip, StripKind};

/// Length of the ego's road before a junction, and of a street on each side of the contact. [m]
pub(super) const APPROACH_M: f64 = 320.0;

/// From a junction's centre to where its arms begin. [m]
const CORNER_M: f64 = 13.0;

pub(super) fn strips(driving: usize, beside: &[StripKind]) -> Vec<Strip> {
    strips_of(LANE_M, driving, beside)
}

/// The same with lanes of this width. [m]
pub(super) fn strips_of(lane_m: f64, driving: usize, beside: &[StripKind]) -> Vec<Strip> {
    let lane = Strip { width_m: Some(lane_m), ..Strip::of(StripKind::Driving) };
    let mut list = vec![lane; driving];
    list.extend(beside.iter().map(|kind| Strip::of(*kind)));
    list
}

pub(super) fn straight(id: &str, start: RoadStart, length_m: f64, right: Vec<Strip>, left: Vec<Strip>) -> RoadSpec {
    RoadSpec {
        id: id.to_owned(),
        start,
        line: vec![LinePiece::Straight { length_m }],
        right,
        left,
        speed_limit_mps: None,
        crosswalks: Vec::new(),
        driveways: Vec::new(),
    }
}

/// Strips on the other side of a median.
pub(super) fn behind_median(strips: Vec<Strip>) -> Vec<Strip> {
    [Strip::of(StripKind::Median)].into_iter().chain(strips).collect()
}

/// From a junction's centre to where its arms begin, wider with more lanes. [m]
pub(crate) fn corner_m(lanes: usize) -> f64 {
    CORNER_M + (lanes.max(2) - 2) as f64 * LANE_M
}
