//! Every lane of many maps against MetaDrive's own numbers (`oracle/metadrive_lanes.py` wrote the fixture).

use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::scenario::MapSpec;
use recrash_roads::{Lane, RoadNetwork};
use serde::Deserialize;

const FIXTURE: &str = include_str!("../fixtures/metadrive_lanes.json");

/// Allowed difference of any number; the fixture is rounded to 1e-9. [m, rad]
const TOLERANCE: f64 = 1e-6;

#[derive(Deserialize)]
struct Fixture {
    samples: Vec<f64>,
    maps: Vec<FixtureMap>,
}

#[derive(Deserialize)]
struct FixtureMap {
    map: MapSpec,
    lanes: Vec<FixtureLane>,
}

#[derive(Deserialize)]
struct FixtureLane {
    from: String,
    to: String,
    index: u8,
    length_m: f64,
    width_m: f64,
    points: Vec<[f64; 2]>,
    headings: Vec<f64>,
    right_edge: [f64; 2],
}

fn fixture() -> Fixture {
    serde_json::from_str(FIXTURE).expect("the fixture parses")
}

fn find<'a>(network: &'a RoadNetwork, wanted: &FixtureLane) -> &'a Lane {
    let road = network
        .road_between(&wanted.from, &wanted.to)
        .unwrap_or_else(|| panic!("{:?} lacks {} -> {}", network.map, wanted.from, wanted.to));
    network.lane(network.road(road).lanes[usize::from(wanted.index)])
}

#[test]
fn every_lane_lies_where_metadrive_puts_it() {
    let fixture = fixture();
    let mut compared = 0;
    for entry in &fixture.maps {
        let network = RoadNetwork::build(&entry.map);
        for wanted in &entry.lanes {
            let lane = find(&network, wanted);
            let name = format!("{} -> {} lane {} of {:?}", wanted.from, wanted.to, wanted.index, entry.map);
            assert_eq!(lane.index, wanted.index, "{name}");
            assert!((lane.length_m - wanted.length_m).abs() < TOLERANCE, "{name}: length {}", lane.length_m);
            assert!((lane.width_m - wanted.width_m).abs() < TOLERANCE, "{name}: width {}", lane.width_m);
            for ((fraction, point), heading) in fixture.samples.iter().zip(&wanted.points).zip(&wanted.headings) {
                let s = fraction * lane.length_m;
                let distance = lane.position(s, 0.0).distance(Vec2::new(point[0], point[1]));
                assert!(distance < TOLERANCE, "{name}: at {s} off by {distance} m");
                let turned = math::wrap_angle(lane.heading(s) - heading).abs();
                assert!(turned < TOLERANCE, "{name}: at {s} off by {turned} rad");
                compared += 1;
            }
            let edge = lane.position(0.5 * lane.length_m, 0.5 * lane.width_m);
            let distance = edge.distance(Vec2::new(wanted.right_edge[0], wanted.right_edge[1]));
            assert!(distance < TOLERANCE, "{name}: right edge off by {distance} m");
        }
    }
    assert!(compared > 5000, "only {compared} points were compared");
}

#[test]
fn no_lane_is_missing_and_none_is_invented() {
    for entry in &fixture().maps {
        let network = RoadNetwork::build(&entry.map);
        assert_eq!(network.lanes.len(), entry.lanes.len(), "{:?}", entry.map);
    }
}
