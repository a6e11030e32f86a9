//! What does not move: roads with their strips, junctions, signals and signs, things.

use recrash_model::rollout::{Rollout, STEP_S};
use recrash_model::scenario::{
    Control, Device, GraphMap, JunctionSpec, LinePiece, MapSpec, RoadSpec, RoadStart, ScenarioDraft, Strip, StripKind,
    Turn,
};

/// The road map: a network in words, one of the paper's blocks in its own form.
pub(super) fn map(map: &MapSpec) -> Vec<String> {
    let MapSpec::G(network) = map else {
        return vec![format!("Road map: {}", serde_json::to_string(map).unwrap_or_default())];
    };
    let GraphMap { roads, junctions, areas } = network;
    let mut lines: Vec<String> = roads.iter().map(road).collect();
    lines.extend(junctions.iter().map(junction));
    lines.extend(areas.iter().map(|area| {
        let corners: Vec<String> = area.points.iter().map(|[x, y]| format!("({x:.1}, {y:.1})")).collect();
        format!("Area: {}, corners {} m", name_of(&area.kind), corners.join(", "))
    }));
    lines
}

fn road(road: &RoadSpec) -> String {
    let begins = match &road.start {
        RoadStart::At { x_m, y_m, heading_deg } => {
            format!("begins at x {x_m:.1} m, y {y_m:.1} m, its line points {heading_deg:.0} deg")
        }
        RoadStart::Arm { junction, bearing_deg, from_m } => format!(
            "leads away from junction '{junction}', its line begins {from_m:.1} m from the centre and points {bearing_deg:.0} deg"
        ),
        RoadStart::After { road } => format!("goes on where the line of road '{road}' ends"),
        RoadStart::IntoLane { road, lane } => format!("runs into lane {} of '{road}'", lane + 1),
        RoadStart::FromLane { road, lane } => format!("leaves from lane {} of '{road}'", lane + 1),
    };
    let line: Vec<String> = road.line.iter().map(piece).collect();
    let mut told = vec![format!("Road '{}' {begins}: {}", road.id, line.join(", then "))];
    told.push(format!("right of its line, driven along it, from the line outwards: {}", strips(&road.right)));
    told.push(format!("left of it, driven the other way: {}", strips(&road.left)));
    told.extend(road.crosswalks.iter().map(|walk| {
        format!("a crosswalk {:.1} m wide, its middle {:.1} m from where the line begins", walk.width_m, walk.s_m)
    }));
    told.extend(road.driveways.iter().map(|drive| {
        format!(
            "a driveway {:.1} m wide on the {}, its middle {:.1} m from where the line begins, {:.1} m deep",
            drive.width_m,
            name_of(&drive.side),
            drive.s_m,
            drive.depth_m
        )
    }));
    told.extend(road.speed_limit_mps.map(|mps| format!("posted {mps:.1} m/s")));
    told.join("; ")
}

fn piece(piece: &LinePiece) -> String {
    match piece {
        LinePiece::Straight { length_m } => format!("{length_m:.1} m straight"),
        LinePiece::Arc { length_m, radius_m, to } => {
            format!("{length_m:.1} m to the {} with a radius of {radius_m:.1} m", name_of(to))
        }
        LinePiece::Spiral { length_m, to, .. } => {
            format!("{length_m:.1} m of a bend to the {} that changes evenly", name_of(to))
        }
        LinePiece::Points { .. } => format!("{:.1} m through points", piece.length_m()),
    }
}

fn strips(strips: &[Strip]) -> String {
    if strips.is_empty() {
        return "nothing".to_owned();
    }
    let told = |strip: &Strip| {
        let kind = if strip.kind == StripKind::Driving { "lane" } else { strip.kind.name() };
        let (width_m, end_m) = strip.widths_m();
        let changes = if width_m == end_m { String::new() } else { format!(" to {end_m:.1}") };
        let turn = |turn: &Turn| match turn {
            Turn::Straight => "straight on",
            Turn::Left => "left",
            Turn::Right => "right",
        };
        let turns: Vec<&str> = strip.turns.iter().map(turn).collect();
        let only = if turns.is_empty() { String::new() } else { format!(" for {}", turns.join(" and ")) };
        let askew = strip.stall_angle_deg.map_or_else(String::new, |deg| format!(" at {deg:.0} deg"));
        format!("{kind} {width_m:.1}{changes} m{only}{askew}")
    };
    strips.iter().map(told).collect::<Vec<_>>().join(", ")
}

fn junction(junction: &JunctionSpec) -> String {
    let roads = |ids: &[String]| ids.iter().map(|id| format!("'{id}'")).collect::<Vec<_>>().join(", ");
    let mut told = format!("Junction '{}' at x {:.1} m, y {:.1} m", junction.id, junction.x_m, junction.y_m);
    if !junction.ends.is_empty() {
        told += &format!("; roads that end at it: {}", roads(&junction.ends));
    }
    if !junction.u_turns.is_empty() {
        told += &format!("; U-turns are possible on {}", roads(&junction.u_turns));
    }
    told
}

/// What stands at the roads' ends, signals with what they show when.
pub(super) fn controls(draft: &ScenarioDraft, rollout: &Rollout) -> Vec<String> {
    draft.control.iter().map(|control| control_in_words(control, rollout.termination.time_s)).collect()
}

fn control_in_words(control: &Control, end_s: f64) -> String {
    let (what, shows) = match &control.device {
        Device::StopSign {} => ("Stop sign", String::new()),
        Device::YieldSign {} => ("Yield sign", String::new()),
        Device::Signal { .. } => ("Signal", format!(": {}", states(&control.device, end_s))),
    };
    let lanes: Vec<String> = control.lanes.iter().map(|lane| (lane + 1).to_string()).collect();
    let lanes = if lanes.is_empty() { String::new() } else { format!(", for lane {} from the left", lanes.join(", ")) };
    let back =
        if control.set_back_m > 0.0 { format!(", {:.1} m before it", control.set_back_m) } else { String::new() };
    format!("{what} at the end of '{}'{back}{lanes}{shows}", control.at)
}

/// What a signal shows, and from when on.
fn states(device: &Device, end_s: f64) -> String {
    let mut told: Vec<String> = Vec::new();
    let mut last = None;
    for step in 0..=(end_s / STEP_S) as usize {
        let time_s = step as f64 * STEP_S;
        let shown = device.aspect(time_s);
        if let Some(aspect) = shown.filter(|_| shown != last) {
            told.push(format!("{} from {time_s:.1} s", aspect.label()));
            last = shown;
        }
    }
    told.join(", ")
}

/// The name of a value, as files have it.
fn name_of<T: serde::Serialize>(value: &T) -> String {
    serde_json::to_value(value)
        .ok()
        .and_then(|value| value.as_str().map(|name| name.replace('_', " ")))
        .unwrap_or_default()
}
