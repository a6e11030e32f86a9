//! The OpenDRIVE document.

use super::{DriveJunction, DriveLane, DriveMap, DriveRoad, Mark, Neighbour};
use crate::xml::{Element, rounded};
use recrash_model::math;
use recrash_model::scenario::{MapKind, MapSpec};
use recrash_roads::RoadNetwork;

impl DriveMap {
    /// The root element; `name` is the map's.
    pub fn document(&self, network: &RoadNetwork, name: &str) -> Element {
        Element::new("OpenDRIVE")
            .child(self.header(network, name))
            .children(self.roads.iter().map(|road| road_element(network, road)))
            .children(self.controllers.iter().cloned())
            .children(self.junctions.iter().map(|junction| self.junction(junction)))
    }

    fn header(&self, network: &RoadNetwork, name: &str) -> Element {
        let margin = match network.map.kind() {
            MapKind::Network => self.roads.iter().map(widest_side_m).fold(0.0, f64::max),
            _ => {
                let carriageway = network.map.carriageway();
                f64::from(carriageway.lanes) * carriageway.lane_width_m
            }
        };
        let (mut west, mut east) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut south, mut north) = (f64::INFINITY, f64::NEG_INFINITY);
        for road in &self.roads {
            let parts = 4 * road.line.len();
            for part in 0..=parts {
                let point = road.pose(road.length_m * part as f64 / parts as f64).position;
                (west, east) = (west.min(point.x - margin), east.max(point.x + margin));
                (south, north) = (south.min(point.y - margin), north.max(point.y + margin));
            }
        }
        Element::new("header")
            .with("revMajor", "1")
            .with("revMinor", "7")
            .with("name", name)
            .with("version", "1.00")
            .with_number("north", north.ceil())
            .with_number("south", south.floor())
            .with_number("east", east.ceil())
            .with_number("west", west.floor())
            .with("vendor", "recrash")
    }

    fn junction(&self, junction: &DriveJunction) -> Element {
        let connections = junction.roads.iter().enumerate().map(|(number, &position)| {
            let road = &self.roads[position];
            let Some(Neighbour::Road { id: incoming, .. }) = road.predecessor else {
                unreachable!("a connecting road comes from a road");
            };
            let links = road.right.iter().filter_map(|lane| {
                let (from, to) = (lane.predecessor?, lane.number);
                Some(Element::new("laneLink").with("from", from.to_string()).with("to", to.to_string()))
            });
            Element::new("connection")
                .with("id", number.to_string())
                .with("incomingRoad", incoming.to_string())
                .with("connectingRoad", road.id.to_string())
                .with("contactPoint", "start")
                .children(links)
        });
        let controllers = junction.controllers.iter().map(|id| Element::new("controller").with("id", id.to_string()));
        Element::new("junction")
            .with("name", &junction.name)
            .with("id", junction.id.to_string())
            .children(connections)
            .children(controllers)
    }
}

/// The widest that one side of a road is. [m]
fn widest_side_m(road: &DriveRoad) -> f64 {
    let width = |lanes: &[DriveLane]| -> f64 {
        lanes.iter().map(|lane| lane.widths.iter().map(|width| width[1]).fold(0.0, f64::max)).sum()
    };
    width(&road.left).max(width(&road.right))
}

fn road_element(network: &RoadNetwork, road: &DriveRoad) -> Element {
    let mut element = Element::new("road")
        .with("name", &road.name)
        .with_number("length", rounded(road.length_m))
        .with("id", road.id.to_string())
        .with("junction", road.junction.map_or_else(|| "-1".to_owned(), |id| id.to_string()))
        .with("rule", "RHT");
    let ends = [("predecessor", road.predecessor), ("successor", road.successor)];
    if ends.iter().any(|(_, neighbour)| neighbour.is_some()) {
        let links = ends.into_iter().filter_map(|(end, neighbour)| Some(neighbour_element(end, neighbour?)));
        element = element.child(Element::new("link").children(links));
    }
    let mut kind = Element::new("type").with("s", "0").with("type", road_type(&network.map));
    if let Some(limit) = road.speed_limit_mps {
        kind = kind.child(Element::new("speed").with_number("max", limit).with("unit", "m/s"));
    }
    let mut lanes = Element::new("lanes");
    if let Some([from, to]) = road.lane_offset_m {
        lanes = lanes.child(polynomial("laneOffset", "s", [0.0, from, (to - from) / road.length_m, 0.0, 0.0]));
    }
    element = element.child(kind).child(plan_view(road)).child(lanes.child(lane_section(road)));
    for (name, list) in [("objects", &road.objects), ("signals", &road.signals)] {
        if !list.is_empty() {
            element = element.child(Element::new(name).children(list.iter().cloned()));
        }
    }
    match &road.nodes {
        Some(nodes) => element.child(Element::new("userData").with("code", "metadrive").with("value", nodes)),
        None => element,
    }
}

fn lane_section(road: &DriveRoad) -> Element {
    let mut section = Element::new("laneSection").with("s", "0");
    if !road.left.is_empty() {
        // OpenDRIVE lists lanes from left to right.
        section = section.child(Element::new("left").children(road.left.iter().rev().map(lane_element)));
    }
    let centre = Element::new("lane").with("id", "0").with("type", "none").child(road_mark(road.middle));
    section = section.child(Element::new("center").child(centre));
    if road.right.is_empty() {
        return section;
    }
    section.child(Element::new("right").children(road.right.iter().map(lane_element)))
}

fn lane_element(lane: &DriveLane) -> Element {
    let mut element =
        Element::new("lane").with("id", lane.number.to_string()).with("type", lane.kind).with("level", "false");
    let link: Vec<Element> = [("predecessor", lane.predecessor), ("successor", lane.successor)]
        .into_iter()
        .filter_map(|(end, linked)| Some(Element::new(end).with("id", linked?.to_string())))
        .collect();
    if !link.is_empty() {
        element = element.child(Element::new("link").children(link));
    }
    element.children(lane.widths.iter().map(|width| polynomial("width", "sOffset", *width))).child(road_mark(lane.mark))
}

/// A cubic polynomial from a place on.
fn polynomial(name: &str, place: &str, [from, a, b, c, d]: [f64; 5]) -> Element {
    Element::new(name)
        .with_number(place, rounded(from))
        .with_number("a", a)
        .with_number("b", b)
        .with_number("c", c)
        .with_number("d", d)
}

fn plan_view(road: &DriveRoad) -> Element {
    let mut s = 0.0;
    let mut view = Element::new("planView");
    for stretch in &road.line {
        let shape = if stretch.curvature == 0.0 {
            Element::new("line")
        } else {
            Element::new("arc").with_number("curvature", rounded(stretch.curvature))
        };
        view = view.child(
            Element::new("geometry")
                .with_number("s", rounded(s))
                .with_number("x", rounded(stretch.start.position.x))
                .with_number("y", rounded(stretch.start.position.y))
                .with_number("hdg", rounded(math::wrap_angle(stretch.start.heading)))
                .with_number("length", rounded(stretch.length_m))
                .child(shape),
        );
        s += stretch.length_m;
    }
    view
}

fn neighbour_element(end: &str, neighbour: Neighbour) -> Element {
    match neighbour {
        Neighbour::Road { id, at_start } => Element::new(end)
            .with("elementType", "road")
            .with("elementId", id.to_string())
            .with("contactPoint", if at_start { "start" } else { "end" }),
        Neighbour::Junction(id) => Element::new(end).with("elementType", "junction").with("elementId", id.to_string()),
    }
}

fn road_mark(mark: Mark) -> Element {
    Element::new("roadMark")
        .with("sOffset", "0")
        .with("type", mark.kind)
        .with("weight", "standard")
        .with("color", mark.colour)
        .with("width", "0.15")
        .with("laneChange", mark.lane_change)
}

fn road_type(map: &MapSpec) -> &'static str {
    if map.kind() == MapKind::Road { "rural" } else { "town" }
}
