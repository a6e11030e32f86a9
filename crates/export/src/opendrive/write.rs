//! The OpenDRIVE document.

use super::{DriveJunction, DriveMap, DriveRoad, Neighbour, on_reference_line};
use crate::xml::{Element, rounded};
use recrash_model::scenario::MapSpec;
use recrash_roads::{RoadId, RoadNetwork};

impl DriveMap {
    /// The root element; `name` is the map's.
    pub fn document(&self, network: &RoadNetwork, name: &str) -> Element {
        Element::new("OpenDRIVE")
            .child(self.header(network, name))
            .children(self.roads.iter().map(|road| self.road(network, road)))
            .children(self.junctions.iter().map(|junction| self.junction(network, junction)))
    }

    fn header(&self, network: &RoadNetwork, name: &str) -> Element {
        let carriageway = network.map.carriageway();
        let margin = f64::from(carriageway.lanes) * carriageway.lane_width_m;
        let (mut west, mut east) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut south, mut north) = (f64::INFINITY, f64::NEG_INFINITY);
        for road in &self.roads {
            for quarter in 0..=4 {
                let point = on_reference_line(road, road.length_m * f64::from(quarter) / 4.0);
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

    fn road(&self, network: &RoadNetwork, road: &DriveRoad) -> Element {
        let nodes = network.road(road.forward);
        let mut element = Element::new("road")
            .with("name", &road.name)
            .with_number("length", rounded(road.length_m))
            .with("id", road.id.to_string())
            .with("junction", road.junction.map_or_else(|| "-1".to_owned(), |id| id.to_string()))
            .with("rule", "RHT");
        let ends = [("predecessor", road.predecessor), ("successor", road.successor)];
        if ends.iter().any(|(_, neighbour)| neighbour.is_some()) {
            element = element
                .child(Element::new("link").children(
                    ends.into_iter().filter_map(|(end, neighbour)| Some(neighbour_element(end, neighbour?))),
                ));
        }
        element
            .child(Element::new("type").with("s", "0").with("type", road_type(&network.map)))
            .child(plan_view(road))
            .child(Element::new("lanes").child(self.lane_section(network, road)))
            .child(
                Element::new("userData")
                    .with("code", "metadrive")
                    .with("value", format!("{} {}", nodes.from, nodes.to)),
            )
    }

    fn lane_section(&self, network: &RoadNetwork, road: &DriveRoad) -> Element {
        let mut section = Element::new("laneSection").with("s", "0");
        if let Some(backward) = road.backward {
            let count = network.road(backward).lanes.len();
            // OpenDRIVE lists lanes from left to right.
            let lanes = (0..count).rev().map(|index| self.lane_element(network, road, backward, index));
            section = section.child(Element::new("left").children(lanes));
        }
        let middle = match (road.junction, road.backward) {
            (Some(_), _) => road_mark("none", "standard", "none"),
            (None, Some(_)) => road_mark("solid", "yellow", "none"),
            (None, None) => road_mark("solid", "standard", "none"),
        };
        section = section.child(
            Element::new("center").child(Element::new("lane").with("id", "0").with("type", "none").child(middle)),
        );
        let count = network.road(road.forward).lanes.len();
        let lanes = (0..count).map(|index| self.lane_element(network, road, road.forward, index));
        section.child(Element::new("right").children(lanes))
    }

    fn lane_element(&self, network: &RoadNetwork, road: &DriveRoad, direction: RoadId, index: usize) -> Element {
        let lanes = &network.road(direction).lanes;
        let (_, number) = self.lane(lanes[index]);
        let mut lane =
            Element::new("lane").with("id", number.to_string()).with("type", "driving").with("level", "false");
        let link: Vec<Element> = [("predecessor", false), ("successor", true)]
            .into_iter()
            .filter_map(|(end, after)| {
                let linked = self.linked_lane(network, road, direction, index, after)?;
                Some(Element::new(end).with("id", linked.to_string()))
            })
            .collect();
        if !link.is_empty() {
            lane = lane.child(Element::new("link").children(link));
        }
        let outermost = index + 1 == lanes.len();
        let mark = match (road.junction, outermost) {
            (Some(_), _) => road_mark("none", "standard", "none"),
            (None, true) => road_mark("solid", "standard", "none"),
            (None, false) => road_mark("broken", "standard", "both"),
        };
        lane.child(
            Element::new("width")
                .with("sOffset", "0")
                .with_number("a", network.lane(lanes[index]).width_m)
                .with("b", "0")
                .with("c", "0")
                .with("d", "0"),
        )
        .child(mark)
    }

    /// The lane that continues a lane beyond a road's end (`after`: the end of the reference line), where that is one.
    fn linked_lane(
        &self,
        network: &RoadNetwork,
        road: &DriveRoad,
        direction: RoadId,
        index: usize,
        after: bool,
    ) -> Option<i32> {
        let neighbour = if after { road.successor } else { road.predecessor };
        let Some(Neighbour::Road { id, .. }) = neighbour else {
            return None;
        };
        let this = network.road(direction);
        let driven_on = (direction == road.forward) == after;
        let other = network.roads.iter().enumerate().find(|(position, candidate)| {
            let meets = if driven_on { candidate.from == this.to } else { candidate.to == this.from };
            let lane = network.roads[*position].lanes[0];
            meets && self.lane(lane).0.id == id
        })?;
        other.1.lanes.get(index).map(|&lane| self.lane(lane).1)
    }

    fn junction(&self, network: &RoadNetwork, junction: &DriveJunction) -> Element {
        let connections = junction.roads.iter().enumerate().map(|(number, &position)| {
            let road = &self.roads[position];
            let Some(Neighbour::Road { id: incoming, .. }) = road.predecessor else {
                unreachable!("a connecting road comes from a road");
            };
            let lanes = &network.road(road.forward).lanes;
            let links = (0..lanes.len()).filter_map(|index| {
                let from = self.linked_lane(network, road, road.forward, index, false)?;
                let (_, to) = self.lane(lanes[index]);
                Some(Element::new("laneLink").with("from", from.to_string()).with("to", to.to_string()))
            });
            Element::new("connection")
                .with("id", number.to_string())
                .with("incomingRoad", incoming.to_string())
                .with("connectingRoad", road.id.to_string())
                .with("contactPoint", "start")
                .children(links)
        });
        let name = if self.junctions.len() == 1 {
            "junction".to_owned()
        } else {
            let entry = junction.roads.iter().map(|&position| self.roads[position].name.as_str());
            entry.clone().find(|name| name.starts_with("entry")).unwrap_or("junction").to_owned()
        };
        Element::new("junction").with("name", name).with("id", junction.id.to_string()).children(connections)
    }
}

fn plan_view(road: &DriveRoad) -> Element {
    let shape = if road.curvature == 0.0 {
        Element::new("line")
    } else {
        Element::new("arc").with_number("curvature", rounded(road.curvature))
    };
    Element::new("planView").child(
        Element::new("geometry")
            .with("s", "0")
            .with_number("x", rounded(road.start.position.x))
            .with_number("y", rounded(road.start.position.y))
            .with_number("hdg", rounded(road.start.heading))
            .with_number("length", rounded(road.length_m))
            .child(shape),
    )
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

fn road_mark(kind: &str, color: &str, lane_change: &str) -> Element {
    Element::new("roadMark")
        .with("sOffset", "0")
        .with("type", kind)
        .with("weight", "standard")
        .with("color", color)
        .with("width", "0.15")
        .with("laneChange", lane_change)
}

fn road_type(map: &MapSpec) -> &'static str {
    match map {
        MapSpec::S(_) | MapSpec::C(_) => "rural",
        MapSpec::X(_) | MapSpec::T(_) | MapSpec::O(_) | MapSpec::G(_) => "town",
    }
}
