//! The paper's blocks as OpenDRIVE.

use super::{
    DriveJunction, DriveLane, DriveMap, DriveRoad, FIRST_JUNCTION_ID, LaneOn, Mark, Neighbour, Stretch, id_at,
    lane_number,
};
use recrash_model::geometry::Pose;
use recrash_model::scenario::{MapKind, MapSpec};
use recrash_roads::{Centreline, Lane, RoadId, RoadNetwork, RoadPart};

/// The network of a block.
pub(super) fn drive_map(network: &RoadNetwork) -> DriveMap {
    let junction_of = junctions(network);
    let mut block =
        Block { network, junction_of, roads: Vec::new(), lanes: vec![LaneOn::default(); network.lanes.len()] };
    for position in 0..network.roads.len() {
        let id = road_id(position);
        if !block.roads.iter().any(|known| known.backward == Some(id)) {
            block.road(position, id);
        }
    }
    block.finished()
}

struct Block<'a> {
    network: &'a RoadNetwork,
    junction_of: Vec<Option<u32>>,
    roads: Vec<BlockRoad>,
    lanes: Vec<LaneOn>,
}

/// The two directions of a road.
struct BlockRoad {
    /// Lanes -1, -2, ... in the direction of the reference line.
    forward: RoadId,
    /// Lanes 1, 2, ... against it.
    backward: Option<RoadId>,
    junction: Option<u32>,
    line: Stretch,
}

impl Block<'_> {
    fn road(&mut self, position: usize, id: RoadId) {
        let (network, junction) = (self.network, self.junction_of[position]);
        let road = network.road(id);
        let backward = match junction {
            Some(_) => None,
            None => network.road_between(&opposite(&road.to), &opposite(&road.from)),
        };
        let index = self.roads.len();
        let line = reference_line(network.lane(road.lanes[0]));
        let mut put = |lane: recrash_roads::LaneId, number: i32| {
            let on = LaneOn { road: index, number, against: number > 0, from_m: 0.0, length_m: line.length_m };
            self.lanes[usize::from(lane.0)] = on;
        };
        for (number, &lane) in road.lanes.iter().enumerate() {
            put(lane, -lane_number(number));
        }
        for (number, &lane) in backward.iter().flat_map(|&back| network.road(back).lanes.iter().enumerate()) {
            put(lane, lane_number(number));
        }
        self.roads.push(BlockRoad { forward: id, backward, junction, line });
    }

    fn finished(self) -> DriveMap {
        let mut junctions: Vec<DriveJunction> = Vec::new();
        let mut roads: Vec<DriveRoad> = Vec::with_capacity(self.roads.len());
        for (position, road) in self.roads.iter().enumerate() {
            let ends = self.network.road(road.forward);
            let successor = self.neighbour(position, &ends.to, true);
            let predecessor = self.neighbour(position, &ends.from, false);
            if let Some(id) = road.junction {
                match junctions.iter_mut().find(|junction| junction.id == id) {
                    Some(junction) => junction.roads.push(position),
                    None => junctions.push(DriveJunction {
                        id,
                        name: "junction".to_owned(),
                        roads: vec![position],
                        controllers: Vec::new(),
                    }),
                }
            }
            let lanes = |direction: RoadId| -> Vec<DriveLane> {
                (0..self.network.road(direction).lanes.len())
                    .map(|index| self.lane(road, direction, index, [predecessor, successor]))
                    .collect()
            };
            let middle = match (road.junction, road.backward) {
                (Some(_), _) => Mark::NONE,
                (None, Some(_)) => Mark::CENTRE,
                (None, None) => Mark::SOLID,
            };
            roads.push(DriveRoad {
                id: id_at(position),
                name: name_of(self.network, road.forward, road.junction.is_some()),
                forward: road.forward,
                backward: road.backward,
                junction: road.junction,
                line: vec![road.line],
                length_m: road.line.length_m,
                lane_offset_m: None,
                predecessor,
                successor,
                left: road.backward.map(lanes).unwrap_or_default(),
                right: lanes(road.forward),
                middle,
                speed_limit_mps: None,
                nodes: Some(format!("{} {}", ends.from, ends.to)),
                objects: Vec::new(),
                signals: Vec::new(),
            });
        }
        junctions.sort_by_key(|junction| junction.id);
        if junctions.len() > 1 {
            for junction in &mut junctions {
                let mut names = junction.roads.iter().map(|&position| roads[position].name.as_str());
                if let Some(name) = names.find(|name| name.starts_with("entry")) {
                    junction.name = name.to_owned();
                }
            }
        }
        DriveMap { roads, junctions, lanes: self.lanes, controllers: Vec::new() }
    }

    fn lane(&self, road: &BlockRoad, direction: RoadId, index: usize, ends: [Option<Neighbour>; 2]) -> DriveLane {
        let lanes = &self.network.road(direction).lanes;
        let linked = |after: bool| self.linked_lane(road, direction, index, ends[usize::from(after)], after);
        DriveLane {
            number: self.lanes[usize::from(lanes[index].0)].number,
            kind: "driving",
            widths: vec![[0.0, self.network.lane(lanes[index]).width_m, 0.0, 0.0, 0.0]],
            predecessor: linked(false),
            successor: linked(true),
            mark: match (road.junction, index + 1 == lanes.len()) {
                (Some(_), _) => Mark::NONE,
                (None, true) => Mark::SOLID,
                (None, false) => Mark::BROKEN,
            },
        }
    }

    /// The lane that continues a lane beyond a road's end (`after`: the end of the reference line), where that is one.
    fn linked_lane(
        &self,
        road: &BlockRoad,
        direction: RoadId,
        index: usize,
        neighbour: Option<Neighbour>,
        after: bool,
    ) -> Option<i32> {
        let Some(Neighbour::Road { id, .. }) = neighbour else {
            return None;
        };
        let this = self.network.road(direction);
        let driven_on = (direction == road.forward) == after;
        let other = self.network.roads.iter().find(|candidate| {
            let meets = if driven_on { candidate.from == this.to } else { candidate.to == this.from };
            meets && id_at(self.lanes[usize::from(candidate.lanes[0].0)].road) == id
        })?;
        other.lanes.get(index).map(|lane| self.lanes[usize::from(lane.0)].number)
    }

    /// What lies at a node of a road, behind (`after`) or before it in its forward direction.
    fn neighbour(&self, position: usize, node: &str, after: bool) -> Option<Neighbour> {
        let touching = self
            .network
            .roads
            .iter()
            .enumerate()
            .filter(|(_, road)| if after { road.from == node } else { road.to == node });
        let mut found = None;
        for (other, _) in touching {
            if self.roads[position].junction.is_none()
                && let Some(junction) = self.junction_of[other]
            {
                return Some(Neighbour::Junction(junction));
            }
            if self.junction_of[other].is_none() {
                found = Some(other);
            }
        }
        let id = road_id(found?);
        let drive = self.roads.iter().position(|road| road.forward == id || road.backward == Some(id))?;
        // Behind us we meet the beginning of a road driven forward, and the end of one driven against its line.
        Some(Neighbour::Road { id: id_at(drive), at_start: (self.roads[drive].forward == id) == after })
    }
}

/// The reference line of a road whose leftmost lane is `lane`: that lane's left edge.
fn reference_line(lane: &Lane) -> Stretch {
    let edge = -0.5 * lane.width_m;
    let start = Pose { position: lane.position(0.0, edge), heading: lane.heading(0.0) };
    match lane.centreline {
        Centreline::Straight { .. } => Stretch { start, curvature: 0.0, length_m: lane.length_m },
        Centreline::Arc { radius, turn, .. } => {
            let at_edge = radius + turn * edge;
            Stretch { start, curvature: turn / at_edge, length_m: lane.length_m * at_edge / radius }
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
        (RoadPart::Inner, true) if network.map.kind() == MapKind::Roundabout => {
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
