//! Map features: lanes with their centre lines, lines on the road, sidewalks, stop signs.

use super::pickle::Value;
use recrash_model::geometry::Vec2;
use recrash_model::scenario::{Device, StripKind};
use recrash_roads::graph::GroundKind;
use recrash_roads::{Lane, LaneId, LineKind, NamedRoad, Road, RoadNetwork, RoadPart, Scenario};

/// Points of a straight line are this far apart: learning simulators look at points, not at lines. [m]
const SPACING_M: f64 = 2.0;

/// The same on arcs, where a chord of 0.5 m runs less than 0.01 m beside an arc of 4 m radius. [m]
const SPACING_ON_ARCS_M: f64 = 0.5;

/// A lane's name among the features.
pub(super) fn lane_name(lane: LaneId) -> String {
    format!("lane{}", lane.0)
}

/// All features.
pub(super) fn features(scenario: &Scenario, origin: Vec2) -> Vec<(String, Value)> {
    let network = scenario.network();
    let mut found = Vec::new();
    for (number, road) in network.roads.iter().enumerate() {
        let of_road = |named: &&NamedRoad| named.pieces.iter().any(|piece| usize::from(piece.0) == number);
        let limit_mps = network.named.iter().find(of_road).and_then(|named| named.speed_limit_mps);
        for (position, &id) in road.lanes.iter().enumerate() {
            let feature = match road.part {
                RoadPart::Beside(StripKind::Sidewalk) => {
                    let polygon = polygon(network.lane(id), origin);
                    Value::dict([("type", "ROAD_EDGE_SIDEWALK".into()), ("polygon", polygon)])
                }
                RoadPart::Beside(StripKind::Median) => continue,
                _ => lane(network, road, position, limit_mps, origin),
            };
            found.push((lane_name(id), feature));
        }
    }
    for (position, line) in network.drawing().lines.iter().enumerate() {
        let kind = match line.kind {
            LineKind::Edge => "ROAD_EDGE_BOUNDARY",
            LineKind::LaneDivider => "ROAD_LINE_BROKEN_SINGLE_WHITE",
            LineKind::Centre => "ROAD_LINE_SOLID_SINGLE_YELLOW",
            LineKind::Stall => "ROAD_LINE_SOLID_SINGLE_WHITE",
            LineKind::Guide | LineKind::Stop => continue,
        };
        let feature = Value::dict([("type", kind.into()), ("polyline", points(line.points.iter().copied(), origin))]);
        found.push((format!("line{position}"), feature));
    }
    for (position, area) in network.areas.iter().enumerate() {
        let kind = match area.kind {
            GroundKind::Crosswalk => "CROSSWALK",
            GroundKind::Driveway => "DRIVEWAY",
            GroundKind::Island => "ROAD_EDGE_SIDEWALK",
            GroundKind::Paved | GroundKind::Junction | GroundKind::Stall | GroundKind::Building => continue,
        };
        let polygon = points(area.points.iter().copied(), origin);
        found.push((format!("area{position}"), Value::dict([("type", kind.into()), ("polygon", polygon)])));
    }
    for (position, (control, placement)) in scenario.draft().control.iter().zip(scenario.control()).enumerate() {
        if !matches!(control.device, Device::StopSign {}) {
            continue;
        }
        let lanes = placement.lines.iter().map(|(lane, _)| lane_name(*lane));
        let Some(&(first, s)) = placement.lines.first() else { continue };
        let at = network.lane(first).position(s, 0.0) - origin;
        let feature = Value::dict([
            ("type", "STOP_SIGN".into()),
            ("position", Value::Floats(vec![at.x as f32, at.y as f32, 0.0], 0)),
            ("lane", Value::texts(lanes)),
        ]);
        found.push((format!("stop{}", position + 1), feature));
    }
    found
}

fn lane(network: &RoadNetwork, road: &Road, position: usize, limit_mps: Option<f64>, origin: Vec2) -> Value {
    let id = road.lanes[position];
    let own = network.lane(id);
    let kind = match road.part {
        RoadPart::Inner => "LANE_SURFACE_UNSTRUCTURE",
        RoadPart::Beside(StripKind::Bike) => "LANE_BIKE_LANE",
        RoadPart::Beside(StripKind::Parking | StripKind::Stalls | StripKind::Shoulder) => "LANE_UNKNOWN",
        _ => "LANE_SURFACE_STREET",
    };
    let names = |lanes: &mut dyn Iterator<Item = LaneId>| Value::texts(lanes.map(lane_name).collect::<Vec<_>>());
    let before = network.followers.iter().enumerate().filter(|(_, next)| next.contains(&id));
    let mut entries = before.filter_map(|(lane, _)| u16::try_from(lane).ok().map(LaneId));
    let left = position.checked_sub(1).map(|left| road.lanes[left]);
    let right = road.lanes.get(position + 1).copied();
    let widths = vec![own.width_m as f32, own.end_width_m as f32];
    let mut feature = vec![
        ("type".to_owned(), kind.into()),
        ("polyline".to_owned(), points(along(own, 0.0).into_iter(), origin)),
        ("polygon".to_owned(), polygon(own, origin)),
        ("width".to_owned(), Value::Floats(widths, 0)),
        ("entry_lanes".to_owned(), names(&mut entries)),
        ("exit_lanes".to_owned(), names(&mut network.followers[usize::from(id.0)].iter().copied())),
        ("left_neighbor".to_owned(), names(&mut left.into_iter())),
        ("right_neighbor".to_owned(), names(&mut right.into_iter())),
    ];
    if let Some(limit_mps) = limit_mps {
        feature.push(("speed_limit_kmh".to_owned(), Value::Number(3.6 * limit_mps)));
    }
    Value::Dict(feature)
}

/// The line a share of its width to the right of a lane's centre.
fn along(lane: &Lane, share: f64) -> Vec<Vec2> {
    let spacing = if lane.curvature() == 0.0 { SPACING_M } else { SPACING_ON_ARCS_M };
    let pieces = (lane.length_m / spacing).ceil().clamp(1.0, 2000.0) as usize;
    let at = |piece: usize| lane.length_m * piece as f64 / pieces as f64;
    (0..=pieces).map(|piece| lane.position(at(piece), share * lane.width_at(at(piece)))).collect()
}

/// What a lane covers: along its right edge, and back along its left.
fn polygon(lane: &Lane, origin: Vec2) -> Value {
    let left = along(lane, -0.5).into_iter().rev();
    points(along(lane, 0.5).into_iter().chain(left), origin)
}

fn points(points: impl Iterator<Item = Vec2>, origin: Vec2) -> Value {
    let numbers = points.flat_map(|point| [(point.x - origin.x) as f32, (point.y - origin.y) as f32]);
    Value::Floats(numbers.collect(), 2)
}
