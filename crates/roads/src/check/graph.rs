//! Names, counts and ranges of a network of roads; what its geometry says is in [`crate::graph`].

use super::remarks::{At, Remarks, name, shorten, shown};
use crate::graph::undirected;
use crate::near::near_names;
use recrash_model::scenario::{AreaSpec, GraphMap, JunctionSpec, LinePiece, RoadSpec, RoadStart, Strip, StripKind};

/// The most of each thing.
const MOST_ROADS: usize = 48;
const MOST_JUNCTIONS: usize = 12;
const MOST_AREAS: usize = 64;
const MOST_PIECES: usize = 64;
const MOST_STRIPS: usize = 12;
const MOST_CROSSWALKS: usize = 8;
const MOST_DRIVEWAYS: usize = 16;

/// A driving lane is at least this wide at its wider end. [m]
const LEAST_LANE_WIDTH_M: f64 = 2.0;

/// Any strip is at least this wide at its wider end. [m]
const LEAST_STRIP_WIDTH_M: f64 = 0.1;

/// Whether a network can be built from a map.
pub(super) fn numbers(map: &GraphMap, remarks: &mut Remarks) -> bool {
    let before = remarks.list.len();
    let counted = remarks.count("map.roads", map.roads.len(), MOST_ROADS)
        && remarks.count("map.junctions", map.junctions.len(), MOST_JUNCTIONS)
        && remarks.count("map.areas", map.areas.len(), MOST_AREAS);
    if map.roads.is_empty() {
        remarks.error("scenario.count", "map.roads", "there is no road", format!("allowed: 1 to {MOST_ROADS} roads"));
    }
    if !counted || map.roads.is_empty() {
        return false;
    }
    ids("map.roads", map.roads.iter().map(|road| road.id.as_str()), remarks);
    ids("map.junctions", map.junctions.iter().map(|junction| junction.id.as_str()), remarks);
    for (position, road) in map.roads.iter().enumerate() {
        self::road(map, road, format_args!("map.roads[{position}]"), remarks);
    }
    if map.roads.first().is_some_and(|road| !road.right.iter().any(|strip| strip.kind == StripKind::Driving)) {
        let message = "the first road has no driving lane to its right";
        let hint = "give map.roads[0].right a strip {\"kind\": \"driving\"}";
        remarks.error("scenario.no-lane", "map.roads[0].right", message, hint);
    }
    for (position, junction) in map.junctions.iter().enumerate() {
        self::junction(map, junction, format_args!("map.junctions[{position}]"), remarks);
    }
    for (position, area) in map.areas.iter().enumerate() {
        self::area(area, format_args!("map.areas[{position}]"), remarks);
    }
    remarks.list[before..].iter().all(|diagnostic| !diagnostic.is_error())
}

fn ids<'a>(list: &str, ids: impl Iterator<Item = &'a str>, remarks: &mut Remarks) {
    let mut known = std::collections::BTreeSet::new();
    for (position, id) in ids.enumerate() {
        let path = format!("{list}[{position}].id");
        name(&path, id, 32, "_", remarks);
        if !known.insert(id) {
            let message = format!("one before has the id {:?} too", shorten(id));
            remarks.error("scenario.duplicate-id", path, message, "give each its own id");
        }
    }
}

/// Says where an id is not known.
fn known<'a>(path: String, what: &str, id: &str, ids: impl Iterator<Item = &'a str>, remarks: &mut Remarks) -> bool {
    let ids: Vec<&str> = ids.collect();
    if ids.contains(&id) {
        return true;
    }
    let message = format!("there is no {what} {:?}", shorten(id));
    remarks.error("scenario.unknown-id", path, message, near_names(id, &ids));
    false
}

fn road(map: &GraphMap, road: &RoadSpec, path: At<'_>, remarks: &mut Remarks) {
    start(map, road, format_args!("{path}.start"), remarks);
    if road.line.is_empty() {
        let hint = format!("allowed: 1 to {MOST_PIECES} pieces");
        remarks.error("scenario.count", format!("{path}.line"), "the line has no piece", hint);
    }
    if remarks.count(format_args!("{path}.line"), road.line.len(), MOST_PIECES) {
        for (number, piece) in road.line.iter().enumerate() {
            self::piece(piece, format_args!("{path}.line[{number}]"), remarks);
        }
    }
    for (side, strips) in [("right", &road.right), ("left", &road.left)] {
        if remarks.count(format_args!("{path}.{side}"), strips.len(), MOST_STRIPS) {
            for (number, strip) in strips.iter().enumerate() {
                self::strip(strip, format_args!("{path}.{side}[{number}]"), remarks);
            }
        }
    }
    if road.right.is_empty() && road.left.is_empty() {
        let hint = "give it strips to the right or to the left";
        remarks.error("scenario.count", format!("{path}.right"), "the road has no strip", hint);
    }
    if let Some(limit) = road.speed_limit_mps {
        remarks.number(format_args!("{path}.speed_limit_mps"), limit, 1.0, 60.0, "m/s");
    }
    let length_m: f64 = road.line.iter().map(LinePiece::length_m).sum();
    let along = |path: String, s_m: f64, remarks: &mut Remarks| {
        if remarks.number(&path, s_m, 0.0, 2000.0, "m") && s_m > length_m {
            let message = format!("{} m along a road of {} m", shown(s_m), shown(length_m));
            remarks.error("scenario.range", path, message, format!("allowed: 0 to {} m", shown(length_m)));
        }
    };
    if remarks.count(format_args!("{path}.crosswalks"), road.crosswalks.len(), MOST_CROSSWALKS) {
        for (number, crosswalk) in road.crosswalks.iter().enumerate() {
            let path = format!("{path}.crosswalks[{number}]");
            along(format!("{path}.s_m"), crosswalk.s_m, remarks);
            remarks.number(format_args!("{path}.width_m"), crosswalk.width_m, 1.0, 10.0, "m");
        }
    }
    if remarks.count(format_args!("{path}.driveways"), road.driveways.len(), MOST_DRIVEWAYS) {
        for (number, driveway) in road.driveways.iter().enumerate() {
            let path = format!("{path}.driveways[{number}]");
            along(format!("{path}.s_m"), driveway.s_m, remarks);
            remarks.number(format_args!("{path}.width_m"), driveway.width_m, 2.0, 20.0, "m");
            remarks.number(format_args!("{path}.depth_m"), driveway.depth_m, 1.0, 40.0, "m");
        }
    }
}

fn start(map: &GraphMap, road: &RoadSpec, path: At<'_>, remarks: &mut Remarks) {
    let roads = || map.roads.iter().map(|road| road.id.as_str());
    match &road.start {
        RoadStart::At { x_m, y_m, heading_deg } => {
            remarks.number(format_args!("{path}.at.x_m"), *x_m, -2000.0, 2000.0, "m");
            remarks.number(format_args!("{path}.at.y_m"), *y_m, -2000.0, 2000.0, "m");
            remarks.number(format_args!("{path}.at.heading_deg"), *heading_deg, -360.0, 360.0, "deg");
        }
        RoadStart::After { road } => {
            known(format!("{path}.after.road"), "road", road, roads(), remarks);
        }
        RoadStart::Arm { junction, bearing_deg, from_m } => {
            let junctions = map.junctions.iter().map(|junction| junction.id.as_str());
            known(format!("{path}.arm.junction"), "junction", junction, junctions, remarks);
            remarks.number(format_args!("{path}.arm.bearing_deg"), *bearing_deg, -360.0, 360.0, "deg");
            remarks.number(format_args!("{path}.arm.from_m"), *from_m, 4.0, 100.0, "m");
        }
        RoadStart::IntoLane { road: other, lane } => ramp(map, road, path, "into_lane", other, *lane, remarks),
        RoadStart::FromLane { road: other, lane } => ramp(map, road, path, "from_lane", other, *lane, remarks),
    }
}

fn ramp(map: &GraphMap, road: &RoadSpec, path: At<'_>, form: &str, other: &str, lane: u8, remarks: &mut Remarks) {
    let drives = |strips: &[Strip]| strips.iter().filter(|strip| strip.kind == StripKind::Driving).count();
    if drives(&road.right) == 0 {
        let message = "a road that begins or ends with a lane of another has a driving lane to its right";
        let hint = "give its right a strip {\"kind\": \"driving\"}";
        remarks.error("scenario.no-lane", path.to_string(), message, hint);
    }
    let at = format!("{path}.{form}.road");
    let Some(id) = undirected(other) else {
        let message = format!("the road {:?} has no direction", shorten(other));
        let hint = "write + behind it for the way it was drawn, - for the other way";
        remarks.error("scenario.unknown-id", at, message, hint);
        return;
    };
    if !known(at, "road", id, map.roads.iter().map(|road| road.id.as_str()), remarks) {
        return;
    }
    let Some(target) = map.roads.iter().find(|road| road.id == id) else { return };
    let lanes = drives(if other.ends_with('+') { &target.right } else { &target.left });
    if usize::from(lane) >= lanes {
        let message = format!("{:?} has {lanes} lanes", shorten(other));
        let hint = if lanes == 0 { "name another road".to_owned() } else { format!("allowed: 0 to {}", lanes - 1) };
        remarks.error("scenario.lane", format!("{path}.{form}.lane"), message, hint);
    }
}

fn piece(piece: &LinePiece, path: At<'_>, remarks: &mut Remarks) {
    match piece {
        LinePiece::Straight { length_m } => {
            remarks.number(format_args!("{path}.straight.length_m"), *length_m, 0.1, 2000.0, "m");
        }
        LinePiece::Arc { length_m, radius_m, to: _ } => {
            remarks.number(format_args!("{path}.arc.length_m"), *length_m, 0.1, 2000.0, "m");
            remarks.number(format_args!("{path}.arc.radius_m"), *radius_m, 4.0, 10_000.0, "m");
        }
        LinePiece::Spiral { length_m, from_radius_m, to_radius_m, to: _ } => {
            remarks.number(format_args!("{path}.spiral.length_m"), *length_m, 1.0, 500.0, "m");
            for (field, radius) in [("from_radius_m", from_radius_m), ("to_radius_m", to_radius_m)] {
                if let Some(radius) = radius {
                    remarks.number(format_args!("{path}.spiral.{field}"), *radius, 4.0, 10_000.0, "m");
                }
            }
        }
        LinePiece::Points { points } => {
            self::points(points, 1, 64, 500.0, format_args!("{path}.points.points"), remarks)
        }
    }
}

fn points(points: &[[f64; 2]], least: usize, most: usize, reach_m: f64, path: At<'_>, remarks: &mut Remarks) {
    if points.len() < least {
        let message = format!("{} points", points.len());
        remarks.error("scenario.count", path.to_string(), message, format!("allowed: {least} to {most}"));
    }
    if remarks.count(path, points.len(), most) {
        for (number, point) in points.iter().enumerate() {
            for (axis, value) in point.iter().enumerate() {
                remarks.number(format_args!("{path}[{number}][{axis}]"), *value, -reach_m, reach_m, "m");
            }
        }
    }
}

fn strip(strip: &Strip, path: At<'_>, remarks: &mut Remarks) {
    let mut fits = true;
    for (field, width) in [("width_m", strip.width_m), ("end_width_m", strip.end_width_m)] {
        if let Some(width) = width {
            fits &= remarks.number(format_args!("{path}.{field}"), width, 0.0, 20.0, "m");
        }
    }
    let least = if strip.kind == StripKind::Driving { LEAST_LANE_WIDTH_M } else { LEAST_STRIP_WIDTH_M };
    let widest = strip.widths_m().0.max(strip.widths_m().1);
    if fits && widest < least {
        let message = format!("the {} strip is {} m wide", strip.kind.name(), shown(widest));
        let hint = format!("allowed: from {least} m at its wider end");
        remarks.error("scenario.range", format!("{path}.width_m"), message, hint);
    }
    let mut only = |field: &str, given: bool, kinds: &[StripKind]| {
        if given && !kinds.contains(&strip.kind) {
            let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
            let message = format!("a {} strip has no {field}", strip.kind.name());
            let hint = format!("leave it out; it is for: {}", names.join(", "));
            remarks.error("scenario.strip", format!("{path}.{field}"), message, hint);
        }
    };
    only("turns", !strip.turns.is_empty(), &[StripKind::Driving]);
    only("stall_angle_deg", strip.stall_angle_deg.is_some(), &[StripKind::Stalls]);
    only("stall_m", strip.stall_m.is_some(), &[StripKind::Stalls, StripKind::Parking]);
    if let Some(angle) = strip.stall_angle_deg {
        remarks.number(format_args!("{path}.stall_angle_deg"), angle, 0.0, 90.0, "deg");
    }
    if let Some(width) = strip.stall_m {
        remarks.number(format_args!("{path}.stall_m"), width, 2.0, 20.0, "m");
    }
}

fn junction(map: &GraphMap, junction: &JunctionSpec, path: At<'_>, remarks: &mut Remarks) {
    remarks.number(format_args!("{path}.x_m"), junction.x_m, -2000.0, 2000.0, "m");
    remarks.number(format_args!("{path}.y_m"), junction.y_m, -2000.0, 2000.0, "m");
    for (field, list) in [("ends", &junction.ends), ("u_turns", &junction.u_turns)] {
        if remarks.count(format_args!("{path}.{field}"), list.len(), MOST_ROADS) {
            for (number, id) in list.iter().enumerate() {
                let roads = map.roads.iter().map(|road| road.id.as_str());
                known(format!("{path}.{field}[{number}]"), "road", id, roads, remarks);
            }
        }
    }
}

fn area(area: &AreaSpec, path: At<'_>, remarks: &mut Remarks) {
    points(&area.points, 3, 32, 2000.0, format_args!("{path}.points"), remarks);
}
