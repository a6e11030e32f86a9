//! Networks of roads as OpenDRIVE.
//!
//! A road keeps its reference line, and has a lane for each of its strips. Across a junction every lane has a connecting road
//! of its own, whose reference line is the lane's centre line. Where more than two roads meet end to end (a ramp, a fork),
//! OpenDRIVE wants a junction too: the road that all others meet there gives up its last metre for it.

use super::objects;
use super::{
    DriveJunction, DriveLane, DriveMap, DriveRoad, FIRST_JUNCTION_ID, LaneOn, Mark, Named, Neighbour, id_at,
    lane_number,
};
use recrash_model::scenario::{Control, GraphMap, RoadSpec, RoadStart, Strip, StripKind};
use recrash_roads::graph::Stretch;
use recrash_roads::{LaneId, RoadId, RoadNetwork};
use std::collections::BTreeMap;

/// How much of a road becomes part of a junction of roads that meet end to end, at most. [m]
const MEETING_M: f64 = 1.0;

/// Reference lines that end this near to each other meet. [m]
const TOUCHING_M: f64 = 1e-3;

/// An end of a road: its position in the map, and whether it is the beginning.
type End = (usize, bool);

/// A lane of a road at one of its ends.
#[derive(Debug, Clone, Copy)]
struct LaneEnd {
    end: End,
    /// OpenDRIVE's number.
    number: i32,
}

/// The network of a map, with its signals and signs.
pub(super) fn drive_map(map: &GraphMap, network: &RoadNetwork, control: &[Control]) -> DriveMap {
    let mut graph = Graph::new(map, network);
    graph.meetings();
    for position in 0..map.roads.len() {
        graph.road(position);
    }
    graph.connections();
    let mut drive = DriveMap {
        roads: graph.roads,
        junctions: graph.junctions.into_iter().filter(|junction| !junction.roads.is_empty()).collect(),
        lanes: graph.lanes,
        controllers: Vec::new(),
    };
    objects::areas(map, network, &graph.given_up_m, &mut drive);
    objects::control(map, network, control, &graph.given_up_m, &graph.named, &graph.junction_at, &mut drive);
    drive
}

struct Graph<'a> {
    map: &'a GraphMap,
    network: &'a RoadNetwork,
    /// For each entry of [`RoadNetwork::named`].
    named: Vec<Named>,
    /// For each lane the named road it belongs to, its piece there and its place among the lanes.
    owners: BTreeMap<LaneId, (usize, usize, usize)>,
    /// How much each road has given up at its beginning and end. [m]
    given_up_m: Vec<[f64; 2]>,
    /// The junction at an end of a road.
    junction_at: BTreeMap<End, u32>,
    /// The one other road at an end of a road, with lanes that go on in its lanes.
    neighbours: BTreeMap<End, (End, BTreeMap<i32, i32>)>,
    roads: Vec<DriveRoad>,
    junctions: Vec<DriveJunction>,
    lanes: Vec<LaneOn>,
    /// Connections of roads that meet end to end: the junction, and the lanes.
    meeting_lanes: Vec<(u32, LaneId, LaneId, End)>,
}

impl<'a> Graph<'a> {
    fn new(map: &'a GraphMap, network: &'a RoadNetwork) -> Self {
        let named: Vec<Named> = network.named.iter().map(|road| names(map, &road.name, road.kind)).collect();
        let mut owners = BTreeMap::new();
        for (position, road) in network.named.iter().enumerate() {
            for (piece, id) in road.pieces.iter().enumerate() {
                for (index, lane) in network.road(*id).lanes.iter().enumerate() {
                    owners.insert(*lane, (position, piece, index));
                }
            }
        }
        let mut junctions = Vec::new();
        let mut junction_at = BTreeMap::new();
        for (number, junction) in map.junctions.iter().enumerate() {
            let id = FIRST_JUNCTION_ID + u32::try_from(number).expect("a map has few junctions");
            for (position, spec) in map.roads.iter().enumerate() {
                if matches!(&spec.start, RoadStart::Arm { junction: at, .. } if *at == junction.id) {
                    junction_at.insert((position, true), id);
                }
                if junction.ends.contains(&spec.id) {
                    junction_at.insert((position, false), id);
                }
            }
            let name = junction.id.clone();
            junctions.push(DriveJunction { id, name, roads: Vec::new(), controllers: Vec::new() });
        }
        Self {
            map,
            network,
            named,
            owners,
            given_up_m: vec![[0.0; 2]; map.roads.len()],
            junction_at,
            neighbours: BTreeMap::new(),
            roads: Vec::new(),
            junctions,
            lanes: vec![LaneOn::default(); network.lanes.len()],
            meeting_lanes: Vec::new(),
        }
    }

    /// The end of a road at which a lane of it ends or begins.
    fn lane_end(&self, lane: LaneId, begins: bool) -> Option<LaneEnd> {
        let &(position, piece, index) = self.owners.get(&lane)?;
        let named = &self.named[position];
        let last = self.network.named[position].pieces.len() - 1;
        if piece != if begins { 0 } else { last } {
            return None;
        }
        Some(LaneEnd { end: (named.road, begins != named.against), number: named.numbers[index] })
    }

    /// Finds the roads that meet end to end, and which ends of them need a junction.
    fn meetings(&mut self) {
        let mut pairs: Vec<(LaneEnd, LaneEnd, LaneId, LaneId)> = Vec::new();
        for (position, followers) in self.network.followers.iter().enumerate() {
            let lane = LaneId(u16::try_from(position).expect("a network counts its lanes so"));
            for next in followers {
                if let (Some(from), Some(to)) = (self.lane_end(lane, false), self.lane_end(*next, true)) {
                    pairs.push((from, to, lane, *next));
                }
            }
        }
        while let Some(first) = pairs.first() {
            // All ends that hang together.
            let mut ends = vec![first.0.end];
            while let Some(found) =
                pairs.iter().find_map(|(from, to, ..)| match (ends.contains(&from.end), ends.contains(&to.end)) {
                    (true, false) => Some(to.end),
                    (false, true) => Some(from.end),
                    _ => None,
                })
            {
                ends.push(found);
            }
            let (here, rest): (Vec<_>, Vec<_>) = pairs.into_iter().partition(|pair| ends.contains(&pair.0.end));
            pairs = rest;
            self.meeting(&ends, &here);
        }
    }

    fn meeting(&mut self, ends: &[End], pairs: &[(LaneEnd, LaneEnd, LaneId, LaneId)]) {
        let place = |(road, begins): End| {
            let line = &self.network.lines[road];
            line.pose(if begins { 0.0 } else { line.length_m }).position
        };
        if let &[a, b] = ends
            && a != b
            && place(a).distance(place(b)) < TOUCHING_M
        {
            for (own, other) in [(a, b), (b, a)] {
                let mut lanes = BTreeMap::new();
                for (from, to, ..) in pairs {
                    let (mine, theirs) = if from.end == own { (from, to) } else { (to, from) };
                    lanes.insert(mine.number, theirs.number);
                }
                self.neighbours.insert(own, (other, lanes));
            }
            return;
        }
        // The end that takes part in the most connections gives way.
        let count = |end: &End| pairs.iter().filter(|pair| pair.0.end == *end || pair.1.end == *end).count();
        let Some(&shared) = ends.iter().max_by_key(|end| (count(end), std::cmp::Reverse(**end))) else { return };
        let id = FIRST_JUNCTION_ID + u32::try_from(self.junctions.len()).expect("a map has few roads");
        let name = format!("{} {}", self.map.roads[shared.0].id, if shared.1 { "begins" } else { "ends" });
        self.junctions.push(DriveJunction { id, name, roads: Vec::new(), controllers: Vec::new() });
        for end in ends {
            self.junction_at.insert(*end, id);
        }
        let shortest = pairs
            .iter()
            .filter(|pair| pair.0.end == shared || pair.1.end == shared)
            .map(|pair| self.network.lane(if pair.0.end == shared { pair.2 } else { pair.3 }).length_m)
            .fold(f64::INFINITY, f64::min);
        self.given_up_m[shared.0][usize::from(!shared.1)] = MEETING_M.min(0.25 * shortest);
        for (from, to, lane, next) in pairs {
            if from.end == shared || to.end == shared {
                self.meeting_lanes.push((id, *lane, *next, shared));
            }
        }
    }

    /// A road outside of junctions.
    fn road(&mut self, position: usize) {
        let (spec, line) = (&self.map.roads[position], &self.network.lines[position]);
        let [first, last] = self.given_up_m[position];
        let road = DriveRoad {
            id: id_at(position),
            name: spec.id.clone(),
            forward: self.first_road(position),
            backward: None,
            junction: None,
            line: line.part(first, line.length_m - last),
            length_m: line.length_m - first - last,
            lane_offset_m: None,
            predecessor: self.neighbour((position, true)),
            successor: self.neighbour((position, false)),
            left: self.drive_lanes(position, &spec.left, 1),
            right: self.drive_lanes(position, &spec.right, -1),
            middle: middle(spec),
            speed_limit_mps: spec.speed_limit_mps,
            nodes: None,
            objects: Vec::new(),
            signals: Vec::new(),
        };
        self.roads.push(road);
        self.lay_lanes(position);
    }

    /// What a road meets at one of its ends.
    fn neighbour(&self, end: End) -> Option<Neighbour> {
        match self.junction_at.get(&end) {
            Some(id) => Some(Neighbour::Junction(*id)),
            None => self
                .neighbours
                .get(&end)
                .map(|((other, at_start), _)| Neighbour::Road { id: id_at(*other), at_start: *at_start }),
        }
    }

    /// The lanes on one side of a road, from the middle outwards.
    fn drive_lanes(&self, position: usize, strips: &[Strip], side: i32) -> Vec<DriveLane> {
        let whole_m = self.network.lines[position].length_m;
        let [first, last] = self.given_up_m[position];
        (0..strips.len())
            .map(|index| {
                let number = side * lane_number(index);
                let linked = |begins: bool| self.neighbours.get(&(position, begins))?.1.get(&number).copied();
                DriveLane {
                    number,
                    kind: lane_type(strips[index].kind),
                    widths: widths(&strips[index], whole_m, first, whole_m - first - last),
                    predecessor: linked(true),
                    successor: linked(false),
                    mark: mark(strips[index].kind, strips.get(index + 1).map(|strip| strip.kind)),
                }
            })
            .collect()
    }

    /// Where on a road the lanes of the network lie that belong to it.
    fn lay_lanes(&mut self, position: usize) {
        let line = &self.network.lines[position];
        let [first, _] = self.given_up_m[position];
        for (named, road) in self.named.iter().zip(&self.network.named).filter(|(named, _)| named.road == position) {
            for piece in &road.pieces {
                for (lane, number) in self.network.road(*piece).lanes.iter().zip(&named.numbers) {
                    let geometry = self.network.lane(*lane);
                    let ends = [0.0, geometry.length_m].map(|s| line.local(geometry.position(s, 0.0)).0 - first);
                    self.lanes[usize::from(lane.0)] = LaneOn {
                        road: position,
                        number: *number,
                        against: named.against,
                        from_m: ends[0].min(ends[1]),
                        length_m: (ends[1] - ends[0]).abs(),
                    };
                }
            }
        }
    }

    /// The first road of the network that belongs to a road of the map.
    fn first_road(&self, position: usize) -> RoadId {
        let own = self.named.iter().position(|named| named.road == position);
        own.and_then(|own| self.network.named[own].pieces.first().copied()).unwrap_or(RoadId(0))
    }

    /// Connecting roads: across junctions, and where roads meet end to end.
    fn connections(&mut self) {
        for position in 0..self.network.lanes.len() {
            let lane = LaneId(u16::try_from(position).expect("a network counts its lanes so"));
            let Some(from) = self.lane_end(lane, false) else { continue };
            for first in &self.network.followers[position] {
                let mut chain = Vec::new();
                let mut at = *first;
                while !self.owners.contains_key(&at) {
                    chain.push(at);
                    let Some(next) = self.network.followers[usize::from(at.0)].first() else { break };
                    at = *next;
                }
                let Some(to) = self.lane_end(at, true).filter(|_| !chain.is_empty()) else { continue };
                let Some(id) = self.junction_at.get(&from.end).copied() else { continue };
                let line: Vec<Stretch> = chain.iter().map(|lane| self.network.lane(*lane).stretch()).collect();
                let ends = (self.network.lane(chain[0]), self.network.lane(chain[chain.len() - 1]));
                let widths = [ends.0.width_m, ends.1.end_width_m];
                let lane_road = self.connecting(id, (from, to), line, widths, self.network.lane(chain[0]).road);
                let mut s = 0.0;
                for lane in chain {
                    let length_m = self.network.lane(lane).length_m;
                    self.lanes[usize::from(lane.0)] =
                        LaneOn { road: lane_road, number: -1, against: false, from_m: s, length_m };
                    s += length_m;
                }
            }
        }
        for (id, lane, next, shared) in std::mem::take(&mut self.meeting_lanes) {
            let (Some(from), Some(to)) = (self.lane_end(lane, false), self.lane_end(next, true)) else { continue };
            let leads_in = to.end == shared;
            let geometry = self.network.lane(if leads_in { next } else { lane });
            let given_up = self.given_up_m[shared.0][usize::from(!shared.1)];
            // As long along the lane as along the reference line, by their shares.
            let on = self.lanes[usize::from(if leads_in { next.0 } else { lane.0 })];
            let part_m = given_up / on.length_m.max(given_up) * geometry.length_m;
            let [start, end] = if leads_in { [0.0, part_m] } else { [geometry.length_m - part_m, geometry.length_m] };
            let widths = [start, end].map(|s| geometry.width_at(s));
            let line = vec![geometry.stretch().part(start, end)];
            self.connecting(id, (from, to), line, widths, geometry.road);
        }
    }

    /// A connecting road of one lane along its centre line; its position.
    fn connecting(
        &mut self,
        junction: u32,
        (from, to): (LaneEnd, LaneEnd),
        line: Vec<Stretch>,
        widths: [f64; 2],
        forward: RoadId,
    ) -> usize {
        let position = self.roads.len();
        let length_m: f64 = line.iter().map(|stretch| stretch.length_m).sum();
        let neighbour = |end: End| Neighbour::Road { id: id_at(end.0), at_start: end.1 };
        let kind = match self.lane_kind(from) {
            StripKind::CentreTurn => StripKind::Driving,
            kind => kind,
        };
        let name = format!("{} to {}", self.map.roads[from.end.0].id, self.map.roads[to.end.0].id);
        self.roads.push(DriveRoad {
            id: id_at(position),
            name,
            forward,
            backward: None,
            junction: Some(junction),
            line,
            length_m,
            lane_offset_m: Some(widths.map(|width| 0.5 * width)),
            predecessor: Some(neighbour(from.end)),
            successor: Some(neighbour(to.end)),
            left: Vec::new(),
            right: vec![DriveLane {
                number: -1,
                kind: lane_type(kind),
                widths: vec![[0.0, widths[0], (widths[1] - widths[0]) / length_m, 0.0, 0.0]],
                predecessor: Some(from.number),
                successor: Some(to.number),
                mark: Mark::NONE,
            }],
            middle: Mark::NONE,
            speed_limit_mps: self.map.roads[from.end.0].speed_limit_mps,
            nodes: None,
            objects: Vec::new(),
            signals: Vec::new(),
        });
        if let Some(junction) = self.junctions.iter_mut().find(|known| known.id == junction) {
            junction.roads.push(position);
        }
        position
    }

    fn lane_kind(&self, lane: LaneEnd) -> StripKind {
        let spec = &self.map.roads[lane.end.0];
        let strips = if lane.number < 0 { &spec.right } else { &spec.left };
        strips.get(lane.number.unsigned_abs() as usize - 1).map_or(StripKind::Driving, |strip| strip.kind)
    }
}

/// What a road with direction is called in the network.
fn names(map: &GraphMap, name: &str, kind: StripKind) -> Named {
    let (id, rest) = name.split_once(['+', '-']).unwrap_or((name, ""));
    let road = map.roads.iter().position(|spec| spec.id == id).unwrap_or(0);
    let against =
        name[name.len() - rest.len()..].is_empty() && name.ends_with('-') || name[id.len()..].starts_with('-');
    let spec = &map.roads[road];
    let of = |strips: &[Strip], side: i32| -> Vec<i32> {
        (0..strips.len()).filter(|index| strips[*index].kind == kind).map(|index| side * lane_number(index)).collect()
    };
    let (right, left) = (of(&spec.right, -1), of(&spec.left, 1));
    let own = if against { &left } else { &right };
    // A centre turn lane on one side is one of both directions.
    let numbers = if kind == StripKind::CentreTurn && own.is_empty() { [right, left].concat() } else { own.clone() };
    Named { road, numbers, against }
}

/// OpenDRIVE's type of a lane.
const fn lane_type(kind: StripKind) -> &'static str {
    match kind {
        StripKind::Driving => "driving",
        StripKind::CentreTurn => "bidirectional",
        StripKind::Bike => "biking",
        StripKind::Parking | StripKind::Stalls => "parking",
        StripKind::Shoulder => "shoulder",
        StripKind::Median => "median",
        StripKind::Sidewalk => "sidewalk",
    }
}

/// The polynomials of a strip's width on the part of its road that begins at `from_m` and is `length_m` long: an S made of two
/// parabolas over the whole road. [m]
fn widths(strip: &Strip, whole_m: f64, from_m: f64, length_m: f64) -> Vec<[f64; 5]> {
    let (start, end) = strip.widths_m();
    let change = end - start;
    if change == 0.0 {
        return vec![[0.0, start, 0.0, 0.0, 0.0]];
    }
    let bend = 2.0 * change / (whole_m * whole_m);
    let mut list = Vec::new();
    if from_m < 0.5 * whole_m {
        list.push([0.0, start + bend * from_m * from_m, 2.0 * bend * from_m, bend, 0.0]);
    }
    if from_m + length_m > 0.5 * whole_m {
        let at = (0.5 * whole_m).max(from_m);
        let left = whole_m - at;
        list.push([at - from_m, end - bend * left * left, 2.0 * bend * left, -bend, 0.0]);
    }
    list
}

/// What is painted at the outer edge of a strip.
fn mark(own: StripKind, outer: Option<StripKind>) -> Mark {
    match (own, outer) {
        (StripKind::Driving, Some(StripKind::Driving)) => Mark::BROKEN,
        (StripKind::CentreTurn, _) | (_, Some(StripKind::CentreTurn)) => Mark::CENTRE,
        (_, Some(StripKind::Sidewalk | StripKind::Median)) if own.is_paved() => Mark::KERB,
        _ if own.is_paved() => Mark::SOLID,
        _ => Mark::NONE,
    }
}

/// What is painted along the reference line.
fn middle(spec: &RoadSpec) -> Mark {
    let first = |strips: &[Strip]| strips.first().map(|strip| strip.kind);
    match (first(&spec.right), first(&spec.left)) {
        (Some(StripKind::CentreTurn), _) | (_, Some(StripKind::CentreTurn)) => Mark::CENTRE,
        (Some(StripKind::Driving), Some(StripKind::Driving)) => Mark::CENTRE,
        (right, left) if right.into_iter().chain(left).any(StripKind::is_paved) => Mark::SOLID,
        _ => Mark::NONE,
    }
}
