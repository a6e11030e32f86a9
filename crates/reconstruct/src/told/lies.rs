//! How something lies that the ego drives over.

use crate::usual::LANE_M;
use recrash_model::scenario::Size;

/// How something lies that the ego drives over, where its words say more than its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lies {
    /// A speed bump: across the lane.
    Bump,
    /// The edge of a raised pavement that the ego's underside scrapes: across the way where it turns in.
    Edge,
    /// A hole: under a wheel.
    Hole,
    /// Water: on the whole lane.
    Water,
}

/// Along the way, of a speed bump and of an edge. [m]
const BUMP_M: f64 = 0.4;
const EDGE_M: f64 = 0.3;

/// Along the way, of water that stands on the road. [m]
const WATER_M: f64 = 8.0;

impl Lies {
    /// Its size where it lies across the way.
    pub(crate) fn size(self) -> Option<Size> {
        match self {
            Self::Bump => Some(Size { length_m: BUMP_M, width_m: LANE_M }),
            Self::Edge => Some(Size { length_m: EDGE_M, width_m: LANE_M }),
            Self::Water => Some(Size { length_m: WATER_M, width_m: LANE_M }),
            Self::Hole => None,
        }
    }
}
