//! Closed-form: a place on a lane is the same point of the plane in OpenDRIVE's terms and in ours.

use super::*;

const MAPS: [&str; 8] = [
    r#"{"type":"S","lanes":3,"lane_width_m":3.5,"approach_m":60,"length_m":200}"#,
    r#"{"type":"C","lanes":2,"lane_width_m":3.5,"approach_m":60,"radius_m":50,"angle_deg":90,"direction":"left","length_m":60}"#,
    r#"{"type":"C","lanes":4,"lane_width_m":3.2,"approach_m":60,"radius_m":30,"angle_deg":75,"direction":"right","length_m":60}"#,
    r#"{"type":"X","lanes":1,"lane_width_m":3.5,"approach_m":60,"arm_m":60}"#,
    r#"{"type":"X","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60}"#,
    r#"{"type":"T","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60,"missing":"left"}"#,
    r#"{"type":"T","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60,"missing":"right"}"#,
    r#"{"type":"O","lanes":2,"lane_width_m":3.5,"approach_m":60,"arm_m":60,"exit_radius_m":10,"inner_radius_m":30}"#,
];

fn networks() -> impl Iterator<Item = RoadNetwork> {
    MAPS.iter().map(|json| RoadNetwork::build(&serde_json::from_str(json).expect("a map")))
}

/// OpenDRIVE's definition: along the reference line, then t to its left; lane -k spans t from -(k - 1) w to -k w.
fn by_definition(map: &DriveMap, place: LanePlace, width: f64) -> Vec2 {
    let road = map.roads.iter().find(|road| road.id == place.road).expect("a road of the map");
    let heading = road.start.heading + place.s * road.curvature;
    let side = if place.lane < 0 { -1.0 } else { 1.0 };
    let t = side * (f64::from(place.lane.abs()) - 0.5) * width + place.offset;
    on_reference_line(road, place.s) + Vec2::from_heading(heading).left() * t
}

#[test]
fn every_lane_lies_where_ours_does() {
    for network in networks() {
        let map = DriveMap::new(&network);
        for (position, lane) in network.lanes.iter().enumerate() {
            let id = LaneId(u16::try_from(position).unwrap());
            for (share, t) in [(0.0, 0.0), (0.3, 1.2), (0.5, -0.7), (1.0, 0.0)] {
                let s = share * lane.length_m;
                let theirs = by_definition(&map, map.place(&network, id, s, t), lane.width_m);
                let ours = lane.position(s, t);
                assert!(theirs.distance(ours) < 1e-9, "lane {position} at {s}: {theirs:?} is not {ours:?}");
            }
        }
    }
}

#[test]
fn roads_and_junctions_of_each_map_are_counted_by_hand() {
    // Two-way roads: entrance, approach and what the block adds; connecting roads: ways through a junction.
    let expected = [(3, 0, 0), (4, 0, 0), (4, 0, 0), (5, 12, 1), (5, 12, 1), (4, 6, 1), (4, 6, 1), (9, 12, 4)];
    for (network, (roads, connecting, junctions)) in networks().zip(expected) {
        let map = DriveMap::new(&network);
        let inside = map.roads.iter().filter(|road| road.junction.is_some()).count();
        assert_eq!((map.roads.len() - inside, inside, map.junctions.len()), (roads, connecting, junctions));
    }
}

#[test]
fn neighbours_meet_in_a_point_and_know_each_other() {
    for network in networks() {
        let map = DriveMap::new(&network);
        for road in &map.roads {
            let end = on_reference_line(road, road.length_m);
            if let Some(Neighbour::Road { id, at_start }) = road.successor {
                let other = map.roads.iter().find(|other| other.id == id).expect("a road of the map");
                let theirs = if at_start { other.start.position } else { on_reference_line(other, other.length_m) };
                // Reference lines of one-way roads run along their left edge, those of two-way roads between the
                // directions: both are the left edge of the leftmost lane.
                assert!(end.distance(theirs) < 1e-9, "road {} ends at {end:?}, not at {theirs:?}", road.id);
                let back = if at_start { other.predecessor } else { other.successor };
                let knows = match back {
                    Some(Neighbour::Road { id, .. }) => id == road.id,
                    Some(Neighbour::Junction(junction)) => Some(junction) == road.junction,
                    None => false,
                };
                assert!(knows, "road {id} does not know road {}", road.id);
            }
        }
    }
}
