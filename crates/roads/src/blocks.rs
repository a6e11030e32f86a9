//! The five blocks behind their approach road: geometry, node names and routes.
//!
//! Every block is drawn in the frame of an arm: the origin is the end of the rightmost lane that leads into the block,
//! x points into it, y to the left. Measures are those of MetaDrive 0.4.3, see `docs/models/roads.md`.

use crate::centreline::Centreline;
use crate::lane::{Lane, LaneId, RoadId};
use crate::network::{NamedRoad, Road, RoadNetwork, RoadPart, followers};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::narrative::Side;
use recrash_model::scenario::{Approach, ENTRANCE_LENGTH_M, MapSpec, MissingArm, RoundaboutMap, StripKind, Turn};

/// Radius of the rightmost lane's right turn at a junction; MetaDrive's constant. [m]
pub const JUNCTION_RADIUS_M: f64 = 10.0;

/// Angle of a roundabout's entry and exit arcs; MetaDrive's constant. [rad]
const ROUNDABOUT_ANGLE_RAD: f64 = math::PI / 3.0;

/// Builds the network of a map.
pub(crate) fn build(map: &MapSpec) -> RoadNetwork {
    let carriageway = map.carriageway();
    let mut builder = Builder {
        network: RoadNetwork {
            map: map.clone(),
            roads: Vec::new(),
            lanes: Vec::new(),
            followers: Vec::new(),
            named: Vec::new(),
            lines: Vec::new(),
            areas: Vec::new(),
        },
        lanes: carriageway.lanes,
        width: carriageway.lane_width_m,
    };
    let entrance = Stretch::straight(Frame::default(), ENTRANCE_LENGTH_M);
    let approach = Stretch::straight(entrance.end, (carriageway.approach_m - ENTRANCE_LENGTH_M).max(1.0));
    builder.both_ways(">", ">>", entrance, RoadPart::Approach, RoadPart::Departure);
    builder.both_ways(">>", ">>>", approach, RoadPart::Approach, RoadPart::Departure);
    match map {
        MapSpec::S(m) => {
            let straight = Stretch::straight(approach.end, m.length_m);
            builder.both_ways(">>>", "1S0_0_", straight, RoadPart::ArmOut, RoadPart::ArmIn);
        }
        MapSpec::C(m) => {
            let turn = if m.direction == Side::Left { 1.0 } else { -1.0 };
            let curve = Stretch::arc(approach.end, m.radius_m, m.angle_deg * math::PI / 180.0, turn);
            let tail = Stretch::straight(curve.end, m.length_m);
            builder.both_ways(">>>", "1C0_0_", curve, RoadPart::Inner, RoadPart::Inner);
            builder.both_ways("1C0_0_", "1C0_1_", tail, RoadPart::ArmOut, RoadPart::ArmIn);
        }
        MapSpec::X(m) => builder.junction(approach.end, m.arm_m),
        MapSpec::T(m) => builder.junction(approach.end, m.arm_m),
        MapSpec::O(m) => builder.roundabout(approach.end, m),
        MapSpec::G(_) => unreachable!("a network of roads is no block"),
    }
    builder.network.followers = followers(&builder.network.lanes, |_| true, |_| true);
    name_roads(&mut builder.network);
    builder.network
}

/// Names the roads as places do: `ego+` leads towards the block, the other arms' `+` away from it. On S and C the road
/// leads through the block.
fn name_roads(network: &mut RoadNetwork) {
    let letter = network.map.letter();
    let arms: Vec<(&str, Vec<String>)> = match letter {
        'S' | 'C' => [Approach::Same, Approach::Opposite]
            .map(|approach| route_nodes(&network.map, approach, Turn::Straight).unwrap_or_default())
            .into_iter()
            .zip(["ego+", "ego-"])
            .map(|(nodes, name)| (name, nodes))
            .collect(),
        _ => {
            let arms = Arms { letter, last_part: if letter == 'O' { 3 } else { 1 } };
            let near = arms.last_part - 1;
            let ego = [("ego+", arms.inward(0, near)), ("ego-", arms.outward(0, near))];
            let others = [("right+", "right-", 1), ("ahead+", "ahead-", 2), ("left+", "left-", 3)];
            ego.into_iter()
                .chain(others.into_iter().flat_map(|(away, towards, arm)| {
                    [(away, arms.outward(arm, near)), (towards, arms.inward(arm, near))]
                }))
                .collect()
        }
    };
    for (name, nodes) in arms {
        let pieces: Vec<RoadId> =
            nodes.windows(2).filter_map(|pair| network.road_between(&pair[0], &pair[1])).collect();
        if !pieces.is_empty() {
            network.named.push(NamedRoad {
                name: name.to_owned(),
                pieces,
                kind: StripKind::Driving,
                speed_limit_mps: None,
            });
        }
    }
}

impl RoadNetwork {
    /// The roads a vehicle takes that comes from `approach` and turns `turn` (seen from itself), from the very
    /// beginning of its arm to the very end of its exit; `None` where the map has no such way.
    ///
    /// [`Approach::Ring`] begins right behind the exit to the left arm ([`Turn::Left`]: a connector later, or it would
    /// pass a node twice); it passes the ego's entry and leaves by the exit right behind it ([`Turn::Right`]), the one
    /// after that ([`Turn::Straight`]) or the third ([`Turn::Left`]).
    pub fn route(&self, approach: Approach, turn: Turn) -> Option<Vec<RoadId>> {
        let nodes = route_nodes(&self.map, approach, turn)?;
        nodes.windows(2).map(|pair| self.road_between(&pair[0], &pair[1])).collect()
    }
}

/// The nodes of a way through the map, or `None` where the map has no such way.
fn route_nodes(map: &MapSpec, approach: Approach, turn: Turn) -> Option<Vec<String>> {
    match map {
        MapSpec::S(_) => road_nodes(approach, turn, &["1S0_0_"]),
        MapSpec::C(_) => road_nodes(approach, turn, &["1C0_0_", "1C0_1_"]),
        MapSpec::X(_) | MapSpec::T(_) => {
            let arms = Arms { letter: map.letter(), last_part: 1 };
            let from = arm_of(approach)?;
            let to = (from + exit_number(turn)) % 4;
            if missing_arm(map).is_some_and(|missing| missing == from || missing == to) {
                return None;
            }
            let mut nodes = arms.inward(from, 0);
            nodes.extend(arms.outward(to, 0));
            Some(nodes)
        }
        MapSpec::O(_) => {
            let arms = Arms { letter: 'O', last_part: 3 };
            let mut nodes;
            // Part i of the ring begins behind the entry of arm i and ends at the exit to arm i + 1.
            let (first_part, parts) = if approach == Approach::Ring {
                nodes = vec![arms.node(3, 0), arms.node(3, 1)];
                // As far back as no node comes twice: MetaDrive knows a place on a route by its node alone.
                if turn != Turn::Left {
                    nodes.insert(0, arms.node(2, 1));
                }
                (0, exit_number(turn))
            } else {
                let from = arm_of(approach)?;
                nodes = arms.inward(from, 2);
                (from, exit_number(turn))
            };
            for part in first_part..first_part + parts {
                nodes.push(arms.node(part % 4, 0));
                nodes.push(arms.node(part % 4, 1));
            }
            nodes.extend(arms.outward((first_part + parts) % 4, 2));
            Some(nodes)
        }
        MapSpec::G(_) => None,
    }
}

/// The missing arm of a T: 1 right, 2 ahead, 3 left.
fn missing_arm(map: &MapSpec) -> Option<usize> {
    match map {
        MapSpec::T(m) => Some(match m.missing {
            MissingArm::Right => 1,
            MissingArm::Ahead => 2,
            MissingArm::Left => 3,
        }),
        _ => None,
    }
}

/// Number of the arm a road user comes from, anticlockwise from the ego's: 0 ego, 1 right, 2 ahead, 3 left.
fn arm_of(approach: Approach) -> Option<usize> {
    match approach {
        Approach::Same => Some(0),
        Approach::Right => Some(1),
        Approach::Opposite => Some(2),
        Approach::Left => Some(3),
        Approach::Ring => None,
    }
}

/// How many arms further anticlockwise a turn leads.
fn exit_number(turn: Turn) -> usize {
    match turn {
        Turn::Right => 1,
        Turn::Straight => 2,
        Turn::Left => 3,
    }
}

/// Nodes of a road without a junction, there and back.
fn road_nodes(approach: Approach, turn: Turn, block: &[&str]) -> Option<Vec<String>> {
    if turn != Turn::Straight {
        return None;
    }
    let there: Vec<String> = [">", ">>", ">>>"].iter().chain(block).map(|node| (*node).to_owned()).collect();
    match approach {
        Approach::Same => Some(there),
        Approach::Opposite => Some(there.iter().rev().map(|node| format!("-{node}")).collect()),
        Approach::Left | Approach::Right | Approach::Ring => None,
    }
}

/// Names of the nodes of a block with arms.
#[derive(Clone, Copy)]
struct Arms {
    letter: char,
    /// The part of a node at an arm's far end.
    last_part: usize,
}

impl Arms {
    fn node(self, index: usize, part: usize) -> String {
        format!("1{}{index}_{part}_", self.letter)
    }

    /// Nodes from the far end of an arm to the block; `near_part` is the part at its near end.
    fn inward(self, arm: usize, near_part: usize) -> Vec<String> {
        match arm {
            0 => [">", ">>", ">>>"].map(str::to_owned).to_vec(),
            _ => {
                vec![format!("-{}", self.node(arm - 1, self.last_part)), format!("-{}", self.node(arm - 1, near_part))]
            }
        }
    }

    /// Nodes from the block to the far end of an arm.
    fn outward(self, arm: usize, near_part: usize) -> Vec<String> {
        match arm {
            0 => ["->>>", "->>", "->"].map(str::to_owned).to_vec(),
            _ => vec![self.node(arm - 1, near_part), self.node(arm - 1, self.last_part)],
        }
    }
}

/// A place and a direction on the rightmost lane.
#[derive(Clone, Copy, Default)]
struct Frame {
    origin: Vec2,
    heading: f64,
}

impl Frame {
    /// The frame at (x, y) in this frame, turned by `angle` to the left.
    fn at(self, x: f64, y: f64, angle: f64) -> Self {
        let forward = Vec2::from_heading(self.heading);
        Self { origin: self.origin + forward * x + forward.left() * y, heading: math::wrap_angle(self.heading + angle) }
    }
}

/// A stretch of the rightmost lane of a road, and where it ends.
#[derive(Clone, Copy)]
struct Stretch {
    centreline: Centreline,
    length: f64,
    end: Frame,
}

impl Stretch {
    fn straight(start: Frame, length: f64) -> Self {
        Self {
            centreline: Centreline::Straight { start: start.origin, heading: start.heading },
            length,
            end: start.at(length, 0.0, 0.0),
        }
    }

    /// An arc of this radius and angle; `turn` is +1 to the left, -1 to the right.
    fn arc(start: Frame, radius: f64, angle: f64, turn: f64) -> Self {
        let centre = start.at(0.0, turn * radius, 0.0).origin;
        let start_angle = math::wrap_angle(start.heading - turn * math::FRAC_PI_2);
        let end = start.at(radius * math::sin(angle), turn * radius * (1.0 - math::cos(angle)), turn * angle);
        Self { centreline: Centreline::Arc { centre, radius, start_angle, turn }, length: radius * angle, end }
    }
}

struct Builder {
    network: RoadNetwork,
    lanes: u8,
    width: f64,
}

impl Builder {
    /// A road whose rightmost lane is `rightmost`.
    fn road(&mut self, from: &str, to: &str, rightmost: Stretch, part: RoadPart) {
        self.bundle(from, to, rightmost, part, false);
    }

    /// A road and the road beside it in the other direction, between the negative nodes.
    fn both_ways(&mut self, from: &str, to: &str, rightmost: Stretch, there: RoadPart, back: RoadPart) {
        self.bundle(from, to, rightmost, there, false);
        self.bundle(&format!("-{to}"), &format!("-{from}"), rightmost, back, true);
    }

    fn bundle(&mut self, from: &str, to: &str, rightmost: Stretch, part: RoadPart, oncoming: bool) {
        let road = RoadId(u16::try_from(self.network.roads.len()).expect("a map has a few dozen roads"));
        let mut ids = Vec::with_capacity(usize::from(self.lanes));
        for index in 0..self.lanes {
            let base = Lane {
                road,
                index,
                centreline: rightmost.centreline,
                length_m: rightmost.length,
                width_m: self.width,
                end_width_m: self.width,
            };
            let lane = if oncoming {
                base.beside(-f64::from(self.lanes + index) * self.width).reversed()
            } else {
                base.beside(-f64::from(self.lanes - 1 - index) * self.width)
            };
            ids.push(LaneId(u16::try_from(self.network.lanes.len()).expect("a map has a few hundred lanes")));
            self.network.lanes.push(lane);
        }
        self.network.roads.push(Road { from: from.to_owned(), to: to.to_owned(), part, lanes: ids });
    }

    /// From the rightmost lane of one direction to the leftmost edge lane of the other. [m]
    fn across(&self) -> f64 {
        f64::from(2 * self.lanes - 1) * self.width
    }

    /// X, or T without its missing arm. The arms are worked through anticlockwise: ego, right, ahead, left.
    fn junction(&mut self, ego: Frame, arm_m: f64) {
        let arms = Arms { letter: self.network.map.letter(), last_part: 1 };
        let missing = missing_arm(&self.network.map);
        let across = self.across();
        let mut frame = ego;
        for arm in 0..4 {
            let into = arms.inward(arm, 0).pop().expect("an arm has nodes");
            let right = Stretch::arc(frame, JUNCTION_RADIUS_M, math::FRAC_PI_2, -1.0);
            let turns = [
                (1, right),
                (2, Stretch::straight(frame, 2.0 * JUNCTION_RADIUS_M + across)),
                (3, Stretch::arc(frame, JUNCTION_RADIUS_M + across, math::FRAC_PI_2, 1.0)),
            ];
            for (steps, connector) in turns {
                let exit = (arm + steps) % 4;
                if missing != Some(arm) && missing != Some(exit) {
                    self.road(&into, &arms.outward(exit, 0)[0], connector, RoadPart::Inner);
                }
            }
            if arm < 3 && missing != Some(arm + 1) {
                let out = Stretch::straight(right.end, arm_m);
                self.both_ways(&arms.node(arm, 0), &arms.node(arm, 1), out, RoadPart::ArmOut, RoadPart::ArmIn);
            }
            // The next arm's rightmost incoming lane is the oncoming lane farthest from this arm's right exit.
            frame = right.end.at(0.0, across, math::PI);
        }
    }

    /// O: per arm an entry arc, a ring arc, then an exit arc or a connector to the next entry.
    fn roundabout(&mut self, ego: Frame, map: &RoundaboutMap) {
        let arms = Arms { letter: 'O', last_part: 3 };
        let across = self.across();
        let angle = ROUNDABOUT_ANGLE_RAD;
        let beneath = 0.5 * across + map.exit_radius_m;
        let connector_radius = beneath / math::cos(angle) - map.exit_radius_m;
        let mut frame = ego;
        for arm in 0..4 {
            let into = arms.inward(arm, 2).pop().expect("an arm has nodes");
            let exit = arms.outward((arm + 1) % 4, 2)[0].clone();
            let (start, end, next) = (arms.node(arm, 0), arms.node(arm, 1), arms.node((arm + 1) % 4, 0));
            let entry = Stretch::arc(frame, map.exit_radius_m, angle, -1.0);
            let ring = Stretch::arc(entry.end, across + map.inner_radius_m, 2.0 * angle - math::FRAC_PI_2, 1.0);
            let leave = Stretch::arc(ring.end, map.exit_radius_m, angle, -1.0);
            let connector = Stretch::arc(ring.end, connector_radius, math::PI - 2.0 * angle, 1.0);
            self.road(&into, &start, entry, RoadPart::Inner);
            self.road(&start, &end, ring, RoadPart::Ring);
            self.road(&end, &exit, leave, RoadPart::Inner);
            if arm < 3 {
                let out = Stretch::straight(leave.end, map.arm_m);
                self.both_ways(&arms.node(arm, 2), &arms.node(arm, 3), out, RoadPart::ArmOut, RoadPart::ArmIn);
            }
            self.road(&end, &next, connector, RoadPart::Ring);
            frame = leave.end.at(0.0, across, math::PI);
        }
    }
}
