//! Areas of a network that are no lanes: crosswalks, driveways, stalls, junctions, and those a map gives itself.

use super::strips::{self, LEFT, RIGHT};
use crate::curve::{self, Stretch};
use crate::ground::{GroundArea, GroundKind};
use crate::network::{NamedRoad, RoadNetwork};
use crate::path::LanePath;
use crate::reference_line::ReferenceLine;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::narrative::Side;
use recrash_model::scenario::{GraphMap, RoadSpec, Strip, StripKind};

/// Width of a stall of a parking lot along its row, across it: itte2009's usual 9 feet. [m]
const STALL_M: f64 = 2.7;

/// How far a chord may run beside its arc. [m]
const SAGITTA_M: f64 = 0.02;

/// The areas of a map, whose roads and junctions have been built.
pub(super) fn areas(map: &GraphMap, network: &RoadNetwork, mouths: &[Vec<Mouth>]) -> Vec<GroundArea> {
    let mut areas = Vec::new();
    for (number, area) in map.areas.iter().enumerate() {
        let points: Vec<Vec2> = area.points.iter().map(|[x, y]| Vec2::new(*x, *y)).collect();
        areas.push(area_of(area.kind.into(), format!("areas[{number}]"), points, 0.0));
    }
    for (junction, mouths) in map.junctions.iter().zip(mouths) {
        let points = corners(mouths, |mouth| mouth.paved).into_iter().flatten().collect();
        areas.push(area_of(GroundKind::Junction, junction.id.clone(), points, 0.0));
        let (kerbs, backs) = (corners(mouths, |mouth| mouth.paved), corners(mouths, |mouth| mouth.whole));
        for (number, (kerb, back)) in kerbs.into_iter().zip(backs).enumerate() {
            if mouths[number].sidewalk[1] && mouths[(number + 1) % mouths.len()].sidewalk[0] {
                let points = kerb.into_iter().chain(back.into_iter().rev()).collect();
                areas.push(area_of(GroundKind::Island, format!("{}.corners[{number}]", junction.id), points, 0.0));
            }
        }
    }
    for (spec, line) in map.roads.iter().zip(&network.lines) {
        for (number, crosswalk) in spec.crosswalks.iter().enumerate() {
            let half = 0.5 * crosswalk.width_m;
            let (from, to) = (crosswalk.s_m - half, crosswalk.s_m + half);
            let (right, left) =
                (paved_edge(spec, line, RIGHT, crosswalk.s_m), paved_edge(spec, line, LEFT, crosswalk.s_m));
            let points = [(from, right), (from, -left), (to, -left), (to, right)].map(|(s, t)| at(line, s, t)).to_vec();
            let heading = line.pose(crosswalk.s_m).heading + math::FRAC_PI_2;
            areas.push(area_of(GroundKind::Crosswalk, format!("{}.crosswalks[{number}]", spec.id), points, heading));
        }
        for (number, driveway) in spec.driveways.iter().enumerate() {
            let side = if driveway.side == Side::Right { RIGHT } else { LEFT };
            let edge = paved_edge(spec, line, side, driveway.s_m);
            let (from, to) = (driveway.s_m - 0.5 * driveway.width_m, driveway.s_m + 0.5 * driveway.width_m);
            let far = edge + driveway.depth_m;
            let points =
                [(from, edge), (from, far), (to, far), (to, edge)].map(|(s, t)| at(line, s, side * t)).to_vec();
            let heading = line.pose(driveway.s_m).heading + side * math::FRAC_PI_2;
            areas.push(area_of(GroundKind::Driveway, format!("{}.driveways[{number}]", spec.id), points, heading));
        }
    }
    for named in &network.named {
        stalls(map, network, named, &mut areas);
    }
    areas
}

fn area_of(kind: GroundKind, name: String, points: Vec<Vec2>, heading: f64) -> GroundArea {
    let sum = points.iter().fold(Vec2::default(), |sum, point| sum + *point);
    let position = sum * (1.0 / points.len().max(1) as f64);
    GroundArea { kind, name, middle: Pose { position, heading: math::wrap_angle(heading) }, points }
}

/// The point beside a reference line, `t` to the right. [m]
fn at(line: &ReferenceLine, s: f64, t: f64) -> Vec2 {
    curve::beside(line.pose(s), t).position
}

/// How far the outer edge of the outermost paved strip of a side is from the reference line. [m]
pub(crate) fn paved_edge(spec: &RoadSpec, line: &ReferenceLine, side: f64, s: f64) -> f64 {
    let strips = strips::side_of(spec, side);
    let paved = strips.iter().rposition(|strip| strip.kind.is_paved()).map_or(0, |last| last + 1);
    strips::inner_edge_m(strips, paved, s / line.length_m)
}

/// The stalls and marked bays of a strip.
fn stalls(map: &GraphMap, network: &RoadNetwork, named: &NamedRoad, areas: &mut Vec<GroundArea>) {
    if !matches!(named.kind, StripKind::Stalls | StripKind::Parking) {
        return;
    }
    let Some((id, _)) = named.name.split_once(['+', '-']) else { return };
    let Some(spec) = map.roads.iter().find(|road| road.id == id) else { return };
    let side = if named.name[id.len()..].starts_with('+') { RIGHT } else { LEFT };
    let strips = strips::side_of(spec, side);
    let mut number = 0;
    for (lane, index) in strips::of_kind(strips, named.kind).into_iter().enumerate() {
        let path = LanePath::new(network, named.pieces.clone(), u8::try_from(lane).unwrap_or(u8::MAX));
        let width = strips[index].widths_m().0.min(strips[index].widths_m().1);
        let Some((each, angle)) = stall(&strips[index]) else { continue };
        let slant = if angle < math::FRAC_PI_2 - 1e-9 && angle > 1e-9 { width / math::tan(angle) } else { 0.0 };
        let count = ((path.length_m - slant) / each + 1e-9).floor().max(0.0) as u32;
        for stall in 0..count {
            let (from, to) = (each * f64::from(stall), each * f64::from(stall + 1));
            let half = 0.5 * width;
            let points = [(from, -half), (to, -half), (to + slant, half), (from + slant, half)]
                .map(|(s, t)| path.pose(s, t).position)
                .to_vec();
            let heading = path.pose(0.5 * (from + to + slant), 0.0).heading - angle;
            areas.push(area_of(GroundKind::Stall, format!("{}[{number}]", named.name), points, heading));
            number += 1;
        }
    }
}

/// Width of a strip's stalls along the road, and their angle to it; `None` where no stalls are marked. [m, rad]
fn stall(strip: &Strip) -> Option<(f64, f64)> {
    match strip.kind {
        StripKind::Stalls => {
            let angle = strip.stall_angle_deg.unwrap_or(90.0) * math::PI / 180.0;
            Some((strip.stall_m.unwrap_or(STALL_M), angle))
        }
        StripKind::Parking => strip.stall_m.map(|each| (each, 0.0)),
        _ => None,
    }
}

/// Where an arm of a junction begins.
pub(super) struct Mouth {
    /// At the reference line, facing away from the junction.
    pub(super) pose: Pose,
    /// How far the paved strips reach to the right and left of it. [m]
    pub(super) paved: [f64; 2],
    /// How far all strips reach. [m]
    pub(super) whole: [f64; 2],
    /// Whether there is a sidewalk to the right and left of it.
    pub(super) sidewalk: [bool; 2],
}

/// The edge of a junction between each arm and the next, anticlockwise: points from the left of one to the right of the
/// next. `reach` says how far an arm reaches to the right and left.
pub(super) fn corners(mouths: &[Mouth], reach: impl Fn(&Mouth) -> [f64; 2]) -> Vec<Vec<Vec2>> {
    (0..mouths.len())
        .map(|number| {
            let (own, next) = (&mouths[number], &mouths[(number + 1) % mouths.len()]);
            let from = curve::turned_round(curve::beside(own.pose, -reach(own)[1]));
            let to = curve::beside(next.pose, reach(next)[0]);
            let chord = from.position.distance(to.position);
            match curve::connection(from, to, true) {
                Some(line) if line.iter().map(|stretch| stretch.length_m).sum::<f64>() < 3.0 * chord => points(&line),
                _ => vec![from.position, to.position],
            }
        })
        .collect()
}

/// Points on a chain of stretches; arcs are sampled to 0.02 m.
pub(crate) fn points(stretches: &[Stretch]) -> Vec<Vec2> {
    let mut points = Vec::new();
    for stretch in stretches {
        let angle = 2.0 * math::acos((1.0 - SAGITTA_M * stretch.curvature.abs()).max(-1.0));
        let pieces = match stretch.curvature == 0.0 {
            true => 1,
            false => ((stretch.length_m * stretch.curvature.abs() / angle).ceil() as u32).clamp(1, 200),
        };
        for piece in 0..pieces {
            points.push(stretch.pose(stretch.length_m * f64::from(piece) / f64::from(pieces)).position);
        }
    }
    points.extend(stretches.last().map(|last| last.end().position));
    points
}
