//! OpenDRIVE 1.7: the roads of the simulator, for others to drive on.
//!
//! The two directions of a road become one OpenDRIVE road whose reference line runs between them; the ways through a
//! junction are one-way connecting roads with all their lanes to the right. A roundabout is four ring roads and, before
//! each, a junction of the exit, the way on and the entry.

#[cfg(test)]
mod tests;
mod write;

use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::MapSpec;
use recrash_roads::{Centreline, Lane, LaneId, RoadId, RoadNetwork, RoadPart};

/// Number of the first junction; roads are numbered from 1.
const FIRST_JUNCTION_ID: u32 = 101;

/// A network as OpenDRIVE sees it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DriveMap {
    pub roads: Vec<DriveRoad>,
    pub junctions: Vec<DriveJunction>,
    /// For each lane of the network: its road's position in `roads` and its OpenDRIVE number.
    lanes: Vec<(usize, i32)>,
}

/// An OpenDRIVE road. Its id is its position in the list plus one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DriveRoad {
    pub id: u32,
    pub name: String,
    /// Lanes -1, -2, ... in the direction of the reference line.
    pub forward: RoadId,
    /// Lanes 1, 2, ... against it.
    pub backward: Option<RoadId>,
    /// The junction it leads through.
    pub junction: Option<u32>,
    pub start: Pose,
    /// Curvature of the reference line, left positive. [1/m]
    pub curvature: f64,
    /// Length of the reference line. [m]
    pub length_m: f64,
    pub predecessor: Option<Neighbour>,
    pub successor: Option<Neighbour>,
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
    /// Positions of its connecting roads.
    pub roads: Vec<usize>,
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
    pub fn new(network: &RoadNetwork) -> Self {
        let junction_of = junctions(network);
        let mut roads: Vec<DriveRoad> = Vec::new();
        let mut lanes = vec![(0, 0); network.lanes.len()];
        for (position, road) in network.roads.iter().enumerate() {
            let id = road_id(position);
            if roads.iter().any(|known| known.backward == Some(id)) {
                continue;
            }
            let backward = if junction_of[position].is_some() {
                None
            } else {
                network.road_between(&opposite(&road.to), &opposite(&road.from))
            };
            let index = roads.len();
            for (number, &lane) in road.lanes.iter().enumerate() {
                lanes[usize::from(lane.0)] = (index, -lane_number(number));
            }
            for (number, &lane) in backward.iter().flat_map(|&back| network.road(back).lanes.iter().enumerate()) {
                lanes[usize::from(lane.0)] = (index, lane_number(number));
            }
            let (start, curvature, length_m) = reference_line(network.lane(road.lanes[0]));
            roads.push(DriveRoad {
                id: u32::try_from(index + 1).expect("a map has a few dozen roads"),
                name: name_of(network, id, junction_of[position].is_some()),
                forward: id,
                backward,
                junction: junction_of[position],
                start,
                curvature,
                length_m,
                predecessor: None,
                successor: None,
            });
        }
        let mut map = Self { roads, junctions: Vec::new(), lanes };
        map.link(network, &junction_of);
        map
    }

    /// Sets predecessors and successors, and lists the junctions.
    fn link(&mut self, network: &RoadNetwork, junction_of: &[Option<u32>]) {
        for position in 0..self.roads.len() {
            let forward = self.roads[position].forward;
            let ends = network.road(forward);
            let successor = self.neighbour(network, junction_of, position, &ends.to, true);
            let predecessor = self.neighbour(network, junction_of, position, &ends.from, false);
            let road = &mut self.roads[position];
            road.successor = successor;
            road.predecessor = predecessor;
            if let Some(id) = road.junction {
                match self.junctions.iter_mut().find(|junction| junction.id == id) {
                    Some(junction) => junction.roads.push(position),
                    None => self.junctions.push(DriveJunction { id, roads: vec![position] }),
                }
            }
        }
        self.junctions.sort_by_key(|junction| junction.id);
    }

    /// What lies at a node of a road, behind (`after`) or before it in its forward direction.
    fn neighbour(
        &self,
        network: &RoadNetwork,
        junction_of: &[Option<u32>],
        position: usize,
        node: &str,
        after: bool,
    ) -> Option<Neighbour> {
        let touching = network
            .roads
            .iter()
            .enumerate()
            .filter(|(_, road)| if after { road.from == node } else { road.to == node });
        let mut found = None;
        for (other, _) in touching {
            if self.roads[position].junction.is_none()
                && let Some(junction) = junction_of[other]
            {
                return Some(Neighbour::Junction(junction));
            }
            if junction_of[other].is_none() {
                found = Some(other);
            }
        }
        let id = road_id(found?);
        let drive = self.roads.iter().find(|road| road.forward == id || road.backward == Some(id))?;
        // Behind us we meet the beginning of a road driven forward, and the end of one driven against its line.
        Some(Neighbour::Road { id: drive.id, at_start: (drive.forward == id) == after })
    }

    /// A lane's road and number.
    pub fn lane(&self, lane: LaneId) -> (&DriveRoad, i32) {
        let (road, number) = self.lanes[usize::from(lane.0)];
        (&self.roads[road], number)
    }

    /// The place at (s, t) of a lane.
    pub fn place(&self, network: &RoadNetwork, lane: LaneId, s: f64, t: f64) -> LanePlace {
        let (road, number) = self.lane(lane);
        let share = s / network.lane(lane).length_m;
        let (along, offset) = if number < 0 { (share, -t) } else { (1.0 - share, t) };
        LanePlace { road: road.id, lane: number, s: along * road.length_m, offset }
    }
}

/// The reference line of a road whose leftmost lane is `lane`: that lane's left edge.
fn reference_line(lane: &Lane) -> (Pose, f64, f64) {
    let edge = -0.5 * lane.width_m;
    let start = Pose { position: lane.position(0.0, edge), heading: lane.heading(0.0) };
    match lane.centreline {
        Centreline::Straight { .. } => (start, 0.0, lane.length_m),
        Centreline::Arc { radius, turn, .. } => {
            let at_edge = radius + turn * edge;
            (start, turn / at_edge, lane.length_m * at_edge / radius)
        }
    }
}

/// For each road of the network the junction it leads through: connecting roads that share a node share a junction.
fn junctions(network: &RoadNetwork) -> Vec<Option<u32>> {
    let connects: Vec<bool> = network
        .roads
        .iter()
        .map(|road| match road.part {
            RoadPart::Inner => !matches!(network.map, MapSpec::C(_)),
            // Of the ring, what lies between an exit and the next entry is part of a junction.
            RoadPart::Ring => {
                network.roads.iter().filter(|other| other.from == road.from).count() > 1
                    && network.roads.iter().filter(|other| other.to == road.to).count() > 1
            }
            RoadPart::Approach | RoadPart::Departure | RoadPart::ArmOut | RoadPart::ArmIn => false,
            RoadPart::Open | RoadPart::Beside(_) => false,
        })
        .collect();
    let mut junction_of = vec![None; network.roads.len()];
    let mut next = FIRST_JUNCTION_ID;
    for first in 0..network.roads.len() {
        if !connects[first] || junction_of[first].is_some() {
            continue;
        }
        junction_of[first] = Some(next);
        // Spread to every connecting road that shares a node, until nothing changes.
        loop {
            let joined = (0..network.roads.len()).find(|&candidate| {
                connects[candidate]
                    && junction_of[candidate].is_none()
                    && (0..network.roads.len()).any(|member| {
                        let (a, b) = (&network.roads[candidate], &network.roads[member]);
                        junction_of[member] == Some(next) && (a.from == b.from || a.to == b.to)
                    })
            });
            match joined {
                Some(candidate) => junction_of[candidate] = Some(next),
                None => break,
            }
        }
        next += 1;
    }
    junction_of
}

fn road_id(position: usize) -> RoadId {
    RoadId(u16::try_from(position).expect("a map has a few dozen roads"))
}

/// 1 for the leftmost lane.
fn lane_number(index: usize) -> i32 {
    i32::try_from(index + 1).expect("a road has at most four lanes")
}

/// The node on the other side of the road.
fn opposite(node: &str) -> String {
    node.strip_prefix('-').map_or_else(|| format!("-{node}"), str::to_owned)
}

/// What a person would call a road.
fn name_of(network: &RoadNetwork, id: RoadId, connecting: bool) -> String {
    let road = network.road(id);
    match (road.part, connecting) {
        (RoadPart::Approach | RoadPart::Departure, _) => {
            let stretch = if road.from == ">" { "entrance" } else { "approach" };
            stretch.to_owned()
        }
        (RoadPart::ArmOut | RoadPart::ArmIn, _) => match network.map {
            MapSpec::S(_) => "straight".to_owned(),
            MapSpec::C(_) => "tail".to_owned(),
            _ => format!("{} arm", arm(&road.from)),
        },
        (RoadPart::Inner, false) => "curve".to_owned(),
        (RoadPart::Inner, true) if matches!(network.map, MapSpec::O(_)) => {
            if is_ring_node(&road.from) {
                format!("exit to the {} arm", arm(&road.to))
            } else {
                format!("entry from the {} arm", arm(&road.from))
            }
        }
        (RoadPart::Inner, true) => format!("{} arm to {} arm", arm(&road.from), arm(&road.to)),
        (RoadPart::Ring, false) => format!("ring behind the {} entry", ring_entry(&road.from)),
        (RoadPart::Open, _) => road.from.clone(),
        (RoadPart::Beside(kind), _) => format!("{} {}", road.from, kind.name()),
        (RoadPart::Ring, true) => format!("ring before the {} entry", ring_entry(&road.to)),
    }
}

/// Nodes of the ring are `1O{i}_0_` and `1O{i}_1_`, `i` being the number of the entry before them.
fn is_ring_node(node: &str) -> bool {
    node.starts_with("1O") && (node.ends_with("_0_") || node.ends_with("_1_"))
}

fn ring_entry(node: &str) -> &'static str {
    match node.as_bytes().get(2) {
        Some(b'0') => "ego's",
        Some(b'1') => "right",
        Some(b'2') => "far",
        _ => "left",
    }
}

/// The arm a node lies on, seen from the ego.
fn arm(node: &str) -> &'static str {
    let node = node.trim_start_matches('-');
    match node.as_bytes().get(2) {
        _ if node.starts_with('>') => "ego's",
        Some(b'0') => "right",
        Some(b'1') => "far",
        _ => "left",
    }
}

/// A point of a road's reference line, for the file's bounding box.
fn on_reference_line(road: &DriveRoad, s: f64) -> Vec2 {
    let heading = road.start.heading;
    if road.curvature == 0.0 {
        return road.start.position + Vec2::from_heading(heading) * s;
    }
    let radius = 1.0 / road.curvature;
    let turned = heading + s * road.curvature;
    road.start.position
        + Vec2::new(math::sin(turned) - math::sin(heading), math::cos(heading) - math::cos(turned)) * radius
}
