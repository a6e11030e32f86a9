//! Lanes as lanelets, and the junctions between them.

use super::{leaf, micro};
use crate::opendrive::DriveMap;
use crate::xml::Element;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::MapKind;
use recrash_roads::{Lane, LaneId, Road, RoadNetwork, RoadPart};

/// Angle between two points of a bound: 2 degrees, off by 6 mm on a radius of 40 m. [rad]
const BOUND_STEP_RAD: f64 = math::PI / 90.0;

/// Turns by less than this go straight on. [rad]
const STRAIGHT_RAD: f64 = math::PI / 6.0;

/// Every lane of the network as a lanelet, with the same number plus one.
pub(super) fn lanelets(network: &RoadNetwork) -> Vec<Element> {
    let map = DriveMap::new(network, &[]);
    network.lanes.iter().enumerate().map(|(position, lane)| lanelet(network, &map, lane_id(position), lane)).collect()
}

fn lanelet(network: &RoadNetwork, map: &DriveMap, id: LaneId, lane: &Lane) -> Element {
    let road = network.road(lane.road);
    let (drive, _) = map.lane(id);
    let inside = drive.junction.is_some();
    let count = road.lanes.len();
    let index = usize::from(lane.index);
    let solid = |is: bool| match (inside, is) {
        (true, _) => "no_marking",
        (false, true) => "solid",
        (false, false) => "dashed",
    };
    let mut element = Element::new("lanelet").with("id", number_of(id)).children([
        bound("leftBound", lane, -0.5, solid(index == 0)),
        bound("rightBound", lane, 0.5, solid(index + 1 == count)),
    ]);
    let before =
        (network.followers.iter().enumerate()).filter(|(_, next)| next.contains(&id)).map(|(from, _)| lane_id(from));
    element = element.children(before.map(|id| reference("predecessor", id)));
    element = element.children(network.followers[usize::from(id.0)].iter().map(|id| reference("successor", *id)));
    let left = match index {
        0 => {
            let other = if drive.forward == lane.road { drive.backward } else { Some(drive.forward) };
            other.map(|other| (network.road(other).lanes[0], "opposite"))
        }
        _ => Some((road.lanes[index - 1], "same")),
    };
    let right = road.lanes.get(index + 1).map(|&right| (right, "same"));
    for (name, neighbour) in [("adjacentLeft", left), ("adjacentRight", right)] {
        if let Some((neighbour, direction)) = neighbour {
            element = element.child(reference(name, neighbour).with("drivingDir", direction));
        }
    }
    let country = network.map.kind() == MapKind::Road;
    let mut types = vec![if country { "country" } else { "urban" }];
    if inside {
        types.push("intersection");
    }
    element.children(types.into_iter().map(|kind| leaf("laneletType", kind))).child(leaf("userOneWay", "vehicle"))
}

/// An edge of a lane, in its direction; `side` is -0.5 on the left and 0.5 on the right.
fn bound(name: &str, lane: &Lane, side: f64, marking: &str) -> Element {
    let turned = (lane.curvature() * lane.length_m).abs();
    let pieces = (turned / BOUND_STEP_RAD - 1e-9).ceil().max(1.0) as usize;
    let points = (0..=pieces).map(|piece| {
        let s = lane.length_m * piece as f64 / pieces as f64;
        point(lane.position(s, side * lane.width_at(s)))
    });
    Element::new(name).children(points).child(leaf("lineMarking", marking))
}

fn point(at: Vec2) -> Element {
    Element::new("point").children([leaf("x", &micro(at.x)), leaf("y", &micro(at.y))])
}

/// The junctions: per road that leads into one, where its lanes go.
pub(super) fn intersections(network: &RoadNetwork, first_id: usize) -> Vec<Element> {
    let map = DriveMap::new(network, &[]);
    let mut next_id = first_id + map.junctions.len();
    map.junctions
        .iter()
        .enumerate()
        .map(|(number, junction)| {
            let connecting: Vec<&Road> =
                junction.roads.iter().map(|&position| network.road(map.roads[position].forward)).collect();
            let mut nodes: Vec<&str> = Vec::new();
            for road in &connecting {
                if !nodes.contains(&road.from.as_str()) {
                    nodes.push(&road.from);
                }
            }
            let first_incoming = next_id;
            next_id += nodes.len();
            let headings: Vec<f64> = nodes
                .iter()
                .map(|node| {
                    connecting.iter().find(|road| road.from == **node).map_or(0.0, |road| start_heading(network, road))
                })
                .collect();
            let incomings = nodes.iter().enumerate().map(|(position, node)| {
                // Whoever comes from a quarter turn further anticlockwise comes from the right.
                let right = headings.iter().position(|heading| {
                    (math::wrap_angle(heading - headings[position]) - math::FRAC_PI_2).abs() < STRAIGHT_RAD
                });
                incoming(
                    network,
                    &connecting,
                    node,
                    first_incoming + position,
                    right.map(|other| first_incoming + other),
                )
            });
            Element::new("intersection").with("id", (first_id + number).to_string()).children(incomings)
        })
        .collect()
}

fn incoming(network: &RoadNetwork, connecting: &[&Road], node: &str, id: usize, left_of: Option<usize>) -> Element {
    let roads = network.roads.iter().filter(|road| road.to == node);
    let mut element = Element::new("incoming")
        .with("id", id.to_string())
        .children(roads.flat_map(|road| road.lanes.iter().map(|&lane| reference("incomingLanelet", lane))));
    for (name, wanted) in [("successorsRight", -1), ("successorsStraight", 0), ("successorsLeft", 1)] {
        let ways = connecting.iter().filter(|road| road.from == node && direction(network, road) == wanted);
        element = element.children(ways.flat_map(|road| road.lanes.iter().map(|&lane| reference(name, lane))));
    }
    match left_of {
        None => element,
        Some(other) => element.child(Element::new("isLeftOf").with("ref", other.to_string())),
    }
}

/// Where a way through a junction leads: -1 right, 0 straight on, 1 left. On a roundabout the ring is straight on, and
/// an exit is to the right.
fn direction(network: &RoadNetwork, road: &Road) -> i32 {
    if network.map.kind() == MapKind::Roundabout {
        let exits = network.roads.iter().any(|ring| ring.part == RoadPart::Ring && ring.to == road.from);
        return if exits && road.part == RoadPart::Inner { -1 } else { 0 };
    }
    let lane = network.lane(road.lanes[0]);
    let turned = lane.curvature() * lane.length_m;
    if turned > STRAIGHT_RAD {
        1
    } else if turned < -STRAIGHT_RAD {
        -1
    } else {
        0
    }
}

fn start_heading(network: &RoadNetwork, road: &Road) -> f64 {
    network.lane(road.lanes[0]).heading(0.0)
}

fn reference(name: &str, id: LaneId) -> Element {
    Element::new(name).with("ref", number_of(id))
}

fn number_of(id: LaneId) -> String {
    (u32::from(id.0) + 1).to_string()
}

fn lane_id(position: usize) -> LaneId {
    LaneId(u16::try_from(position).expect("a map has a few hundred lanes"))
}
