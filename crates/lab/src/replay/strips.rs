//! On which strip of a road somebody is, and over which of its edges.

use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack};
use recrash_model::scenario::{GraphMap, LinePiece, RoadSpec, RoadStart, Strip, StripKind};

/// Whose body is at more than this to the road lies across it. [sine]
const ACROSS: f64 = 0.5;
/// Less than this over an edge nobody sees. [m]
const LEAST_OVER_M: f64 = 0.1;
/// The roads that the ego drives along in reconstructions: those it comes on, and the one that lies ahead.
const OWN_ROADS: [&str; 3] = ["main", "own", "ahead"];
/// The one of them that leads away from the junction.
const AHEAD: &str = "ahead";

/// Where a centre is beside the line of a straight road.
struct Beside {
    /// To the left of the line. [m]
    left_m: f64,
    /// Angle to the line. [sine, from 0]
    slant: f64,
    /// Whether it points along the line.
    forward: bool,
}

/// A strip with where it lies beside the road's line, nearer and farther edge. [m]
type Lying<'a> = (&'a Strip, f64, f64);

/// On which strip of which road a centre is, and over which edges of that its body reaches.
pub(super) fn stands_on(map: &GraphMap, actor: &ActorTrack, state: &ActorState) -> String {
    let found = map.roads.iter().find_map(|road| on_strip(map, road, actor, state));
    found.unwrap_or_else(|| match map.roads.iter().all(is_straight) {
        true => "in the junction, beside the roads or beyond their ends".to_owned(),
        false => "on no straight road".to_owned(),
    })
}

fn is_straight(road: &RoadSpec) -> bool {
    road.line.iter().all(|piece| matches!(piece, LinePiece::Straight { .. }))
}

/// Where a road's line begins, and its heading, where the road says so itself.
pub(super) fn beginning(map: &GraphMap, road: &RoadSpec) -> Option<(Vec2, f64)> {
    match &road.start {
        RoadStart::At { x_m, y_m, heading_deg } => Some((Vec2::new(*x_m, *y_m), heading_deg.to_radians())),
        RoadStart::Arm { junction, bearing_deg, from_m } => {
            let junction = map.junctions.iter().find(|known| known.id == *junction)?;
            let angle = bearing_deg.to_radians();
            Some((Vec2::new(junction.x_m, junction.y_m) + Vec2::from_heading(angle) * *from_m, angle))
        }
        RoadStart::After { .. } | RoadStart::IntoLane { .. } | RoadStart::FromLane { .. } => None,
    }
}

fn beside(map: &GraphMap, road: &RoadSpec, state: &ActorState) -> Option<Beside> {
    let (start, angle) = beginning(map, road).filter(|_| is_straight(road))?;
    let (from, way) = (state.position() - start, Vec2::from_heading(angle));
    let length_m: f64 = road.line.iter().map(LinePiece::length_m).sum();
    if !(0.0..=length_m).contains(&from.dot(way)) {
        return None;
    }
    let turned = state.heading - angle;
    Some(Beside { left_m: from.dot(way.left()), slant: math::sin(turned).abs(), forward: math::cos(turned) > 0.0 })
}

/// The strips of one side of a road, with where they lie beside its line.
fn lying(strips: &[Strip]) -> Vec<Lying<'_>> {
    let mut at_m = 0.0;
    let lies = |strip| {
        let near_m = at_m;
        at_m += Strip::widths_m(strip).0;
        (strip, near_m, at_m)
    };
    strips.iter().map(lies).collect()
}

fn on_strip(map: &GraphMap, road: &RoadSpec, actor: &ActorTrack, state: &ActorState) -> Option<String> {
    let found = beside(map, road, state)?;
    let on_left = found.left_m > 0.0;
    let strips = lying(if on_left { &road.left } else { &road.right });
    let holds = |(_, near_m, far_m): &&Lying| (*near_m..=*far_m).contains(&found.left_m.abs());
    let (strip, ..) = strips.iter().find(holds)?;
    let lanes: Vec<&Lying> = strips.iter().filter(|(strip, ..)| strip.kind == StripKind::Driving).collect();
    let what = match lanes.iter().position(holds).filter(|_| strip.kind == StripKind::Driving) {
        Some(number) => format!("lane {} of {} from the middle", number + 1, lanes.len()),
        None => format!("the {} strip", strip.kind.name()),
    };
    let over: String = reaches(road, actor, &found).into_iter().map(|reach| format!(", {reach}")).collect();
    Some(format!("road '{}', {}, {what}{over}", road.id, direction(road, on_left)))
}

/// Which way a side of a road is driven, as the ego's driver would say it: they who come to a junction drive on their own left of
/// the roads that lead away from it.
fn direction(road: &RoadSpec, on_left: bool) -> &'static str {
    let to_junction = on_left == !matches!(road.start, RoadStart::At { .. });
    match OWN_ROADS.contains(&road.id.as_str()) {
        true if to_junction == (road.id != AHEAD) => "along the ego's way",
        true => "against the ego's way",
        false if to_junction => "to the junction",
        false => "away from the junction",
    }
}

/// Over which edges of the strip that its centre is on a body reaches, by how much, and into what, by its own left and right.
fn reaches(road: &RoadSpec, actor: &ActorTrack, at: &Beside) -> Vec<String> {
    if at.slant > ACROSS {
        return Vec::new();
    }
    let half_m = 0.5 * (actor.width_m * (1.0 - math::sq(at.slant)).sqrt() + actor.length_m * at.slant);
    // Every strip from the right of the line to the left of it.
    let right = lying(&road.right).into_iter().map(|(strip, near_m, far_m)| (strip.kind, -far_m, -near_m));
    let left = lying(&road.left).into_iter().map(|(strip, near_m, far_m)| (strip.kind, near_m, far_m));
    let strips: Vec<(StripKind, f64, f64)> = left.chain(right).collect();
    let Some(own) = strips.iter().position(|(_, from_m, to_m)| (*from_m..=*to_m).contains(&at.left_m)) else {
        return Vec::new();
    };
    let (_, own_from_m, own_to_m) = strips[own];
    let mut found = Vec::new();
    for (number, (kind, from_m, to_m)) in strips.iter().enumerate() {
        let by_m = to_m.min(at.left_m + half_m) - from_m.max(at.left_m - half_m);
        if number == own || by_m < LEAST_OVER_M {
            continue;
        }
        let edge = if (*from_m >= own_to_m) == at.forward { "left" } else { "right" };
        let into = match kind {
            StripKind::Driving if (*from_m < 0.0) == (own_from_m < 0.0) => "the next lane".to_owned(),
            StripKind::Driving => "a lane of the other direction".to_owned(),
            _ => format!("the {} strip", kind.name()),
        };
        found.push(format!("{by_m:.1} m over its {edge} edge into {into}"));
    }
    found
}
