//! Drawings: every lane lies on asphalt, kerbs never cross a lane, two-way roads share one centre line.

use crate::common::{cross, curve, roundabout, straight, tee};
use recrash_model::geometry::Vec2;
use recrash_model::narrative::Side;
use recrash_model::scenario::{MapSpec, MissingArm};
use recrash_roads::{LineKind, RoadNetwork};

fn maps() -> Vec<MapSpec> {
    let mut maps = Vec::new();
    for lanes in [1, 2, 4] {
        maps.extend([
            straight(lanes),
            curve(lanes, Side::Left),
            curve(lanes, Side::Right),
            cross(lanes),
            roundabout(lanes),
        ]);
        maps.extend([MissingArm::Right, MissingArm::Ahead, MissingArm::Left].map(|missing| tee(lanes, missing)));
    }
    maps
}

/// Whether a point lies in a polygon: a ray to the right crosses its sides an odd number of times.
fn inside(polygon: &[Vec2], point: Vec2) -> bool {
    let mut odd = false;
    for (from, to) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        if (from.y > point.y) != (to.y > point.y) {
            let x = from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x);
            odd ^= point.x < x;
        }
    }
    odd
}

#[test]
fn every_lane_lies_on_asphalt() {
    for map in maps() {
        let network = RoadNetwork::build(&map);
        let drawing = network.drawing();
        for lane in &network.lanes {
            for (fraction, across) in [(0.03, 0.0), (0.5, 0.45), (0.5, -0.45), (0.97, 0.0)] {
                let point = lane.position(fraction * lane.length_m, across * lane.width_m);
                assert!(drawing.surfaces.iter().any(|area| inside(area, point)), "{map:?} {lane:?}");
            }
        }
    }
}

#[test]
fn no_edge_runs_through_the_middle_of_a_lane() {
    for map in maps() {
        let network = RoadNetwork::build(&map);
        for line in network.drawing().lines.iter().filter(|line| line.kind == LineKind::Edge) {
            for pair in line.points.windows(2) {
                let middle = (pair[0] + pair[1]) * 0.5;
                for lane in &network.lanes {
                    let (s, t) = lane.local(middle);
                    let within = s > 0.5 && s < lane.length_m - 0.5 && t.abs() < 0.5 * lane.width_m - 0.6;
                    assert!(!within, "{map:?}: an edge at {middle:?} on {lane:?}");
                }
            }
        }
    }
}

#[test]
fn a_straight_road_has_two_edges_a_centre_and_dividers() {
    let drawing = RoadNetwork::build(&straight(2)).drawing();
    let count = |kind| drawing.lines.iter().filter(|line| line.kind == kind).count();
    // Three roads behind each other, both ways.
    assert_eq!([count(LineKind::Edge), count(LineKind::Centre), count(LineKind::LaneDivider)], [6, 3, 6]);
    let (low, high) = drawing.bounds();
    assert!(
        low.distance(Vec2::new(0.0, -1.75)) < 1e-9 && high.distance(Vec2::new(140.0, 12.25)) < 1e-9,
        "{low:?} {high:?}"
    );
    for line in drawing.lines.iter().filter(|line| line.kind == LineKind::Centre) {
        assert!(line.points.iter().all(|point| (point.y - 5.25).abs() < 1e-9));
    }
}

#[test]
fn arcs_are_sampled_to_two_centimetres() {
    let network = RoadNetwork::build(&curve(1, Side::Left));
    let bend = network.lanes.iter().find(|lane| lane.curvature() > 0.0).expect("the curve");
    for pair in bend.polyline(0.0).windows(2) {
        let (_, t) = bend.local((pair[0] + pair[1]) * 0.5);
        assert!(t.abs() <= 0.02 && t.abs() > 0.001, "{t}");
    }
}
