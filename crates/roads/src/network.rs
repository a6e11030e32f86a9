//! The road network of a map: nodes, roads between them, lanes on them; node for node MetaDrive's.

use crate::ground::GroundArea;
use crate::lane::{Lane, LaneId, RoadId};
use crate::reference_line::ReferenceLine;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::{MapSpec, StripKind};
use std::collections::BTreeMap;

/// A lane follows another where it begins this near to its end, and leads on the same way. [m]
const JOINT_M: f64 = 0.1;
/// See [`JOINT_M`]. [rad]
const JOINT_RAD: f64 = 5.0 / 180.0 * math::PI;

/// What a road is to the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RoadPart {
    /// The ego's approach (entrance included), towards the block.
    Approach,
    /// The same road away from the block.
    Departure,
    /// An arm of the block away from it; on S the straight behind the approach, on C the straight tail.
    ArmOut,
    /// An arm towards the block.
    ArmIn,
    /// Inside the block: a connector of a junction, a curve, an entry or exit of a roundabout.
    Inner,
    /// Part of a roundabout's ring.
    Ring,
    /// Driving lanes of a road of a network, outside of its junctions.
    Open,
    /// A strip beside the driving lanes: a lane of its own, which nobody is routed along unless a plan names it.
    Beside(StripKind),
}

/// A road: a bundle of parallel lanes from one node to another, in one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Road {
    /// MetaDrive's name of the node it starts at, such as `>>` or `1X0_0_`.
    pub from: String,
    /// MetaDrive's name of the node it ends at.
    pub to: String,
    /// What it is to the map.
    pub part: RoadPart,
    /// Its lanes, leftmost first.
    pub lanes: Vec<LaneId>,
}

/// A road in one direction, as places and plans name it: `main+`, `main-.bike`.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedRoad {
    /// Its name.
    pub name: String,
    /// The roads it consists of, one behind the other.
    pub pieces: Vec<RoadId>,
    /// What it is for.
    pub kind: StripKind,
    /// Posted speed. [m/s]
    pub speed_limit_mps: Option<f64>,
}

/// The road network of one map.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadNetwork {
    /// The map it was built from.
    pub map: MapSpec,
    /// Every road.
    pub roads: Vec<Road>,
    /// Every lane.
    pub lanes: Vec<Lane>,
    /// The lanes that follow each lane.
    pub followers: Vec<Vec<LaneId>>,
    /// Roads by name.
    pub named: Vec<NamedRoad>,
    /// The reference line of each road of a network of roads, in the map's order; none on the paper's blocks.
    pub lines: Vec<ReferenceLine>,
    /// Areas of a network of roads that are no lanes.
    pub areas: Vec<GroundArea>,
}

impl RoadNetwork {
    /// A lane.
    pub fn lane(&self, id: LaneId) -> &Lane {
        &self.lanes[usize::from(id.0)]
    }

    /// A road.
    pub fn road(&self, id: RoadId) -> &Road {
        &self.roads[usize::from(id.0)]
    }

    /// The road between two nodes.
    pub fn road_between(&self, from: &str, to: &str) -> Option<RoadId> {
        let position = self.roads.iter().position(|road| road.from == from && road.to == to)?;
        u16::try_from(position).ok().map(RoadId)
    }

    /// The lane a point lies on: of those whose direction is within 90 degrees of `heading` the one that fits best (the
    /// least of offset plus lane width times difference of heading), else of the others. `None` off the road.
    pub fn lane_at(&self, point: Vec2, heading: f64) -> Option<LaneId> {
        let mut best: Option<(bool, f64, usize)> = None;
        for (position, lane) in self.lanes.iter().enumerate().filter(|(_, lane)| !lane.is_far(point)) {
            let (s, t) = lane.local(point);
            if !(0.0..=lane.length_m).contains(&s) || t.abs() > 0.5 * lane.width_at(s) {
                continue;
            }
            let turned = math::wrap_angle(lane.heading(s) - heading).abs();
            let candidate = (turned > math::FRAC_PI_2, t.abs() + lane.width_at(s) * turned, position);
            let better = match best {
                None => true,
                Some(best) => (candidate.0, candidate.1) < (best.0, best.1),
            };
            if better {
                best = Some(candidate);
            }
        }
        best.and_then(|(_, _, position)| u16::try_from(position).ok().map(LaneId))
    }

    /// Whether a point lies where a motor vehicle may be: on a lane or paved strip, or on a paved area.
    pub fn on_road(&self, point: Vec2) -> bool {
        let paved = |lane: &Lane| !matches!(self.road(lane.road).part, RoadPart::Beside(kind) if !kind.is_paved());
        self.lanes.iter().any(|lane| paved(lane) && lane.contains(point))
            || self.areas.iter().any(|area| area.kind.is_paved() && area.contains(point))
    }

    /// The area with a name, such as `main.crosswalks[0]` or `lot+.stalls[3]`.
    pub fn area(&self, name: &str) -> Option<&GroundArea> {
        self.areas.iter().find(|area| area.name == name)
    }
}

/// The lanes that follow each lane: those of `starts` that begin where it ends, and lead on the same way. [`JOINT_M`]
pub(crate) fn followers(
    lanes: &[Lane],
    ends: impl Fn(usize) -> bool,
    starts: impl Fn(usize) -> bool,
) -> Vec<Vec<LaneId>> {
    let cell = |point: Vec2| ((point.x / JOINT_M).floor() as i64, (point.y / JOINT_M).floor() as i64);
    let mut near: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
    for (index, lane) in lanes.iter().enumerate().filter(|(index, _)| starts(*index)) {
        near.entry(cell(lane.position(0.0, 0.0))).or_default().push(index);
    }
    let follows = |lane: &Lane| {
        let (end, heading) = (lane.position(lane.length_m, 0.0), lane.heading(lane.length_m));
        let (x, y) = cell(end);
        let cells = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
        let mut list: Vec<LaneId> = cells
            .filter_map(|key| near.get(&key))
            .flatten()
            .filter(|index| {
                let other = &lanes[**index];
                other.position(0.0, 0.0).distance(end) <= JOINT_M
                    && math::wrap_angle(other.heading(0.0) - heading).abs() <= JOINT_RAD
            })
            .filter_map(|index| u16::try_from(*index).ok().map(LaneId))
            .collect();
        list.sort_unstable();
        list
    };
    lanes.iter().enumerate().map(|(index, lane)| if ends(index) { follows(lane) } else { Vec::new() }).collect()
}
