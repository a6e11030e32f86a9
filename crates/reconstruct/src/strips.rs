//! Lanes beside the driving lanes, where somebody is told to be in one: a bicycle lane, a shoulder, the lane at the kerb.

use crate::ground::Ground;
use crate::told::Told;
use recrash_model::account::{LaneWord, LeftRight, Origin};
use recrash_model::scenario::StripKind;
use recrash_roads::{RoadNetwork, RoadPart};

/// The strip that a word for a lane tells; nothing where it tells a driving lane.
pub(crate) const fn strip_of(word: LaneWord) -> Option<StripKind> {
    match word {
        LaneWord::Bike => Some(StripKind::Bike),
        LaneWord::Shoulder => Some(StripKind::Shoulder),
        LaneWord::Curb => Some(StripKind::Parking),
        _ => None,
    }
}

impl Told {
    /// The strip that the partner is told to be in, else the ego.
    pub(crate) fn strip(&self) -> Option<StripKind> {
        [self.cp.lane, self.sv.lane].into_iter().flatten().find_map(strip_of)
    }

    /// What lies beside the lanes, from them outwards, where else the usual strips lie there. A shoulder lies where others park.
    pub(crate) fn beside_lanes(&self, usual: &[StripKind]) -> Vec<StripKind> {
        let strip = self.strip().filter(|strip| !usual.contains(strip));
        let stays = |kind: &&StripKind| !(strip == Some(StripKind::Shoulder) && **kind == StripKind::Parking);
        strip.into_iter().chain(usual.iter().filter(stays).copied()).collect()
    }

    /// Whether the partner is told to have come along a strip beside the driving lanes, on the side where it is drawn.
    fn comes_along_strip(&self) -> Option<StripKind> {
        let strip = self.cp.lane.and_then(strip_of)?;
        let left = matches!(self.origin, Origin::Beside { side: LeftRight::Left });
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite);
        (along && !left).then_some(strip)
    }

    /// The line along the strip that the partner came along, to the left of the road's axis. [m]
    pub(crate) fn strip_y_m(&self, ground: &Ground) -> Option<f64> {
        let strip = self.comes_along_strip()?;
        let inner_m = ground.beside.iter().take_while(|kind| **kind != strip).map(|kind| kind.usual_width_m());
        let middle_m = inner_m.sum::<f64>() + 0.5 * strip.usual_width_m();
        let [left_m, right_m] = ground.lane_edges_m;
        let own_y_m = ground.sv_pose(0.0).position.y;
        let y_m = match self.origin {
            Origin::Opposite => own_y_m + left_m + middle_m,
            _ => own_y_m - right_m - middle_m,
        };
        ground.beside.contains(&strip).then_some(y_m)
    }
}

/// Whether a road of this part is the told strip; nothing where no such strip is drawn anywhere.
pub(crate) fn is_on(network: &RoadNetwork, part: RoadPart, strip: StripKind) -> Option<bool> {
    let drawn = network.roads.iter().any(|road| road.part == RoadPart::Beside(strip));
    drawn.then_some(part == RoadPart::Beside(strip))
}
