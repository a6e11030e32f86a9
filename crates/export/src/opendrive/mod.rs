//! OpenDRIVE 1.7: the roads of the simulator, for others to drive on.
//!
//! On the paper's blocks the two directions of a road become one OpenDRIVE road whose reference line runs between them; the ways
//! through a junction are one-way connecting roads with all their lanes to the right. A roundabout is four ring roads and,
//! before each, a junction of the exit, the way on and the entry. A network of roads has its own reference lines.

mod blocks;
mod graph;
mod objects;
#[cfg(test)]
mod tests;
mod write;

use crate::xml::Element;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::scenario::{Control, MapSpec};
use recrash_roads::graph::Stretch;
use recrash_roads::{LaneId, RoadId, RoadNetwork};

/// Number of the first junction; roads are numbered from 1.
const FIRST_JUNCTION_ID: u32 = 101;

/// A network as OpenDRIVE sees it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DriveMap {
    pub roads: Vec<DriveRoad>,
    pub junctions: Vec<DriveJunction>,
    /// For each lane of the network where it is.
    lanes: Vec<LaneOn>,
    /// Controllers of signals.
    controllers: Vec<Element>,
}

/// Where a lane of the network is in OpenDRIVE.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct LaneOn {
    /// Position in [`DriveMap::roads`].
    road: usize,
    /// OpenDRIVE's number of the lane.
    number: i32,
    /// Whether it leads against the reference line.
    against: bool,
    /// The stretch of the reference line that it lies along: where that begins, and its length. [m]
    from_m: f64,
    length_m: f64,
}

/// A road with direction, as the network names it.
struct Named {
    /// Position in the map.
    road: usize,
    /// OpenDRIVE's numbers of its lanes.
    numbers: Vec<i32>,
    /// Whether it leads against the reference line.
    against: bool,
}

/// An OpenDRIVE road. Its id is its position in the list plus one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DriveRoad {
    pub id: u32,
    pub name: String,
    /// The first road of the network in the direction of the reference line.
    pub forward: RoadId,
    /// On a block the road of the other direction, where there is one.
    pub backward: Option<RoadId>,
    /// The junction it leads through.
    pub junction: Option<u32>,
    /// The reference line.
    line: Vec<Stretch>,
    /// Length of the reference line. [m]
    pub length_m: f64,
    /// How far to the left of the reference line the lanes begin, at its beginning and its end. [m]
    lane_offset_m: Option<[f64; 2]>,
    pub predecessor: Option<Neighbour>,
    pub successor: Option<Neighbour>,
    /// Lanes 1, 2, ...
    left: Vec<DriveLane>,
    /// Lanes -1, -2, ...
    right: Vec<DriveLane>,
    /// What is painted along the reference line.
    middle: Mark,
    /// Posted speed. [m/s]
    speed_limit_mps: Option<f64>,
    /// MetaDrive's names of its nodes.
    nodes: Option<String>,
    objects: Vec<Element>,
    signals: Vec<Element>,
}

/// A lane of an OpenDRIVE road.
#[derive(Debug, Clone, PartialEq)]
struct DriveLane {
    number: i32,
    /// OpenDRIVE's name of its type.
    kind: &'static str,
    /// From where along the road on, and the polynomial from there.
    widths: Vec<[f64; 5]>,
    predecessor: Option<i32>,
    successor: Option<i32>,
    /// At its outer edge.
    mark: Mark,
}

/// A road mark.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mark {
    kind: &'static str,
    colour: &'static str,
    lane_change: &'static str,
}

impl Mark {
    const NONE: Self = Self { kind: "none", colour: "standard", lane_change: "none" };
    const SOLID: Self = Self { kind: "solid", colour: "standard", lane_change: "none" };
    const BROKEN: Self = Self { kind: "broken", colour: "standard", lane_change: "both" };
    const CENTRE: Self = Self { kind: "solid", colour: "yellow", lane_change: "none" };
    const KERB: Self = Self { kind: "curb", colour: "standard", lane_change: "none" };
}

/// What a road's end touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Neighbour {
    /// A road, at its start or its end.
    Road { id: u32, at_start: bool },
    /// A junction.
    Junction(u32),
}

/// A junction and the roads through it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DriveJunction {
    pub id: u32,
    name: String,
    /// Positions of its connecting roads.
    pub roads: Vec<usize>,
    /// Ids of the controllers of its signals.
    controllers: Vec<u32>,
}

/// A place as OpenDRIVE and OpenSCENARIO name it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LanePlace {
    pub road: u32,
    pub lane: i32,
    /// Along the reference line. [m]
    pub s: f64,
    /// From the lane's centre to the left of the reference line's direction. [m]
    pub offset: f64,
}

impl DriveMap {
    /// Of a network with its signals and signs.
    pub fn new(network: &RoadNetwork, control: &[Control]) -> Self {
        match &network.map {
            MapSpec::G(map) => graph::drive_map(map, network, control),
            _ => blocks::drive_map(network),
        }
    }

    /// A lane's road and number.
    pub fn lane(&self, lane: LaneId) -> (&DriveRoad, i32) {
        let on = self.lanes[usize::from(lane.0)];
        (&self.roads[on.road], on.number)
    }

    /// The place at (s, t) of a lane.
    pub fn place(&self, network: &RoadNetwork, lane: LaneId, s: f64, t: f64) -> LanePlace {
        let on = self.lanes[usize::from(lane.0)];
        let road = &self.roads[on.road];
        let share = s / network.lane(lane).length_m;
        let (along, offset) = if on.against { (1.0 - share, t) } else { (share, -t) };
        LanePlace { road: road.id, lane: on.number, s: (on.from_m + along * on.length_m).max(0.0), offset }
    }
}

impl DriveRoad {
    /// Place and direction of its reference line. [m]
    fn pose(&self, s: f64) -> Pose {
        let mut left = s;
        for (number, stretch) in self.line.iter().enumerate() {
            if left <= stretch.length_m || number + 1 == self.line.len() {
                return stretch.pose(left);
            }
            left -= stretch.length_m;
        }
        Pose { position: Vec2::default(), heading: 0.0 }
    }
}

/// OpenDRIVE's id of the road at a position.
fn id_at(position: usize) -> u32 {
    u32::try_from(position + 1).expect("a map has at most some thousand roads")
}

/// 1 for the leftmost lane.
fn lane_number(index: usize) -> i32 {
    i32::try_from(index + 1).expect("a road has few lanes")
}
