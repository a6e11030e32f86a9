//! What stands or lies on roads: crosswalks, parking spaces, driveways, buildings; signals and signs.

use super::{DriveMap, FIRST_JUNCTION_ID, Named};
use crate::xml::{Element, rounded};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::{Control, Device, GraphMap};
use recrash_roads::RoadNetwork;
use recrash_roads::graph::{GroundArea, GroundKind, inner_edge_m};
use std::collections::BTreeMap;

/// Height of a building, assumed: two storeys. [m]
const BUILDING_M: f64 = 6.0;
/// Height of a kerb, assumed. [m]
const KERB_M: f64 = 0.15;
/// Height of the lower edge of a signal and of a sign: MUTCD 2009, 4D.15 (15 ft) and 2A.18 (7 ft). [m]
const SIGNAL_M: f64 = 4.6;
const SIGN_M: f64 = 2.1;
/// Beside the road's edge. [m] (Assumed.)
const BESIDE_M: f64 = 0.6;

/// The areas of a network as objects of their roads.
pub(super) fn areas(map: &GraphMap, network: &RoadNetwork, given_up_m: &[[f64; 2]], drive: &mut DriveMap) {
    let mut next = 1;
    for area in &network.areas {
        let (kind, name, height) = match area.kind {
            GroundKind::Crosswalk => ("crosswalk", "crosswalk", 0.0),
            GroundKind::Stall => ("parkingSpace", "parking space", 0.0),
            GroundKind::Driveway => ("patch", "driveway", 0.0),
            GroundKind::Paved => ("patch", "paved area", 0.0),
            GroundKind::Building => ("building", "building", BUILDING_M),
            // Corners of sidewalks are no islands.
            GroundKind::Island if area.name.starts_with("areas[") => ("trafficIsland", "island", KERB_M),
            GroundKind::Island | GroundKind::Junction => continue,
        };
        let road = road_of(map, network, area);
        let object = object(network, road, given_up_m[road], area, [kind, name], height, next);
        drive.roads[road].objects.push(object);
        next += 1;
    }
}

/// The road an area is named after, or the one it is nearest to.
fn road_of(map: &GraphMap, network: &RoadNetwork, area: &GroundArea) -> usize {
    let id = area.name.split(['.', '+', '-', '[']).next().unwrap_or_default();
    let own = map.roads.iter().position(|spec| spec.id == id).filter(|_| !area.name.starts_with("areas["));
    own.unwrap_or_else(|| {
        let apart = |road: &usize| {
            let line = &network.lines[*road];
            line.pose(line.local(area.middle.position).0).position.distance(area.middle.position)
        };
        (0..map.roads.len()).min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(0)
    })
}

fn object(
    network: &RoadNetwork,
    road: usize,
    [first, last]: [f64; 2],
    area: &GroundArea,
    [kind, name]: [&str; 2],
    height: f64,
    id: u32,
) -> Element {
    let line = &network.lines[road];
    let s = line.local(area.middle.position).0.clamp(first, line.length_m - last);
    let origin = line.pose(s);
    let t = Vec2::from_heading(origin.heading).cross(area.middle.position - origin.position);
    let place = origin.position + Vec2::from_heading(origin.heading).left() * t;
    let forward = Vec2::from_heading(area.middle.heading);
    let corners: Vec<(f64, f64)> = (area.points.iter())
        .map(|point| {
            let d = *point - place;
            (d.dot(forward), forward.cross(d))
        })
        .collect();
    let extent = |of: fn(&(f64, f64)) -> f64| {
        let values = corners.iter().map(of);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let outline = Element::new("outline").with("id", "0").with("outer", "true").with("closed", "true").children(
        corners.iter().map(|(u, v)| {
            Element::new("cornerLocal")
                .with_number("u", rounded(*u))
                .with_number("v", rounded(*v))
                .with("z", "0")
                .with_number("height", height)
        }),
    );
    let element = Element::new("object")
        .with("id", id.to_string())
        .with("name", name)
        .with("type", kind)
        .with_number("s", rounded(s - first))
        .with_number("t", rounded(t))
        .with("zOffset", "0")
        .with("orientation", "none")
        .with_number("hdg", rounded(math::wrap_angle(area.middle.heading - origin.heading)))
        .with("pitch", "0")
        .with("roll", "0")
        .with_number("length", rounded(extent(|corner| corner.0)))
        .with_number("width", rounded(extent(|corner| corner.1)))
        .with_number("height", height)
        .child(Element::new("outlines").child(outline));
    if kind == "parkingSpace" { element.child(Element::new("parkingSpace").with("access", "all")) } else { element }
}

/// A signal or sign beside a road, and the lanes it is for.
fn signal(device: &Control, own: &Named, id: u32, (s, t): (f64, f64)) -> Element {
    let (name, [kind, subtype, country], above, dynamic) = match device.device {
        Device::Signal { .. } => ("signal", ["1000001", "-1", "OpenDRIVE"], SIGNAL_M, "yes"),
        Device::StopSign {} => ("stop sign", ["R1-1", "-1", "US"], SIGN_M, "no"),
        Device::YieldSign {} => ("yield sign", ["R1-2", "-1", "US"], SIGN_M, "no"),
    };
    let element = Element::new("signal")
        .with_number("s", rounded(s))
        .with_number("t", rounded(t))
        .with("id", id.to_string())
        .with("name", name)
        .with("dynamic", dynamic)
        .with("orientation", if own.against { "-" } else { "+" })
        .with_number("zOffset", above)
        .with("country", country)
        .with("type", kind)
        .with("subtype", subtype)
        .with("value", "-1")
        .with("height", "0.75")
        .with("width", "0.75");
    let lanes =
        own.numbers.iter().enumerate().filter(|(lane, _)| {
            device.lanes.is_empty() || device.lanes.iter().any(|wanted| usize::from(*wanted) == *lane)
        });
    let validity = |(_, lane): (usize, &i32)| {
        Element::new("validity").with("fromLane", lane.to_string()).with("toLane", lane.to_string())
    };
    element.children(lanes.map(validity))
}

/// The controller of a signal.
fn controller(device: &Control, id: u32) -> Element {
    let controls = Element::new("control").with("signalId", id.to_string()).with("type", "0");
    Element::new("controller")
        .with("id", id.to_string())
        .with("name", format!("signal of {}", device.at))
        .with("sequence", "0")
        .child(controls)
}

/// Signals and signs, and a controller for each signal.
pub(super) fn control(
    map: &GraphMap,
    network: &RoadNetwork,
    control: &[Control],
    given_up_m: &[[f64; 2]],
    named: &[Named],
    junction_at: &BTreeMap<(usize, bool), u32>,
    drive: &mut DriveMap,
) {
    for (number, device) in control.iter().enumerate() {
        let Some(position) = network.named.iter().position(|road| road.name == device.at) else { continue };
        let own = &named[position];
        let (spec, line) = (&map.roads[own.road], &network.lines[own.road]);
        let [first, last] = given_up_m[own.road];
        let s = if own.against { device.set_back_m } else { line.length_m - device.set_back_m };
        let s = s.clamp(first, line.length_m - last);
        let strips = if own.against { &spec.left } else { &spec.right };
        let beside = inner_edge_m(strips, strips.len(), s / line.length_m) + BESIDE_M;
        let id = u32::try_from(number + 1).expect("a scenario has few devices");
        let place = (s - first, if own.against { beside } else { -beside });
        drive.roads[own.road].signals.push(signal(device, own, id, place));
        if matches!(device.device, Device::Signal { .. }) {
            drive.controllers.push(controller(device, id));
            let at = junction_at.get(&(own.road, own.against)).copied().unwrap_or(FIRST_JUNCTION_ID - 1);
            if let Some(junction) = drive.junctions.iter_mut().find(|junction| junction.id == at) {
                junction.controllers.push(id);
            }
        }
    }
}
