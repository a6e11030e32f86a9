//! A road network as lines and areas, for the report.

use recrash_model::geometry::Vec2;
use recrash_report::{LineKind, RoadDrawing, RoadLine};
use recrash_roads::{Centreline, Lane, Road, RoadNetwork, RoadPart};

/// Farthest two points of a drawn arc are apart. [m]
const ARC_STEP_M: f64 = 1.5;

/// Draws a network: asphalt under every lane, paint between and beside them.
pub fn drawing(network: &RoadNetwork) -> RoadDrawing {
    let surfaces = network.lanes.iter().map(|lane| {
        let half = 0.5 * lane.width_m;
        let mut outline = polyline(lane, -half);
        outline.extend(polyline(lane, half).into_iter().rev());
        outline
    });
    let lines = network.roads.iter().flat_map(|road| road_lines(network, road));
    RoadDrawing { surfaces: surfaces.collect(), lines: lines.collect() }
}

fn road_lines(network: &RoadNetwork, road: &Road) -> Vec<RoadLine> {
    let last = road.lanes.len().saturating_sub(1);
    let line = |kind, lane: &Lane, t: f64| RoadLine { kind, points: polyline(lane, t) };
    let lanes = road.lanes.iter().map(|&id| network.lane(id)).enumerate();
    lanes
        .flat_map(|(index, lane)| {
            let half = 0.5 * lane.width_m;
            match road.part {
                RoadPart::Inner => vec![line(LineKind::Guide, lane, 0.0)],
                RoadPart::Approach | RoadPart::Departure | RoadPart::ArmIn | RoadPart::ArmOut | RoadPart::Ring => {
                    let left = match (index, road.part) {
                        (0, RoadPart::Ring) => LineKind::Edge,
                        (0, _) => LineKind::Centre,
                        _ => LineKind::LaneDivider,
                    };
                    let mut lines = vec![line(left, lane, -half)];
                    if index == last && road.part != RoadPart::Ring {
                        lines.push(line(LineKind::Edge, lane, half));
                    }
                    lines
                }
            }
        })
        .collect()
}

/// Points of the line at `t` along a lane.
fn polyline(lane: &Lane, t: f64) -> Vec<Vec2> {
    let pieces = match lane.centreline {
        Centreline::Straight { .. } => 1,
        Centreline::Arc { .. } => (lane.length_m / ARC_STEP_M).ceil().max(2.0) as usize,
    };
    (0..=pieces).map(|i| lane.position(lane.length_m * i as f64 / pieces as f64, t)).collect()
}
