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

/// A junction of four unequal arms; ramps, and a lane that is dropped.
fn network(name: &str) -> RoadNetwork {
    let json = match name {
        "town" => include_str!("../../tests/networks/town.json"),
        _ => include_str!("../../tests/networks/ramps.json"),
    };
    let scenario: serde_json::Value = serde_json::from_str(json).expect("a scenario");
    RoadNetwork::build(&serde_json::from_value(scenario["map"].clone()).expect("a map"))
}

/// OpenDRIVE's definition: along the reference line, then t to its left; lane -k lies behind lanes -1 to -(k - 1), which
/// begin at the lane offset.
fn by_definition(map: &DriveMap, place: LanePlace) -> Vec2 {
    let road = map.roads.iter().find(|road| road.id == place.road).expect("a road of the map");
    let width = |lane: &DriveLane| {
        let [from, a, b, c, d] =
            *lane.widths.iter().rev().find(|width| width[0] <= place.s + 1e-9).expect("a width at the beginning");
        let ds = place.s - from;
        a + ds * (b + ds * (c + ds * d))
    };
    let lanes = if place.lane < 0 { &road.right } else { &road.left };
    let own = usize::try_from(place.lane.abs()).unwrap() - 1;
    let inner: f64 = lanes[..own].iter().map(width).sum();
    let begins = road.lane_offset_m.map_or(0.0, |[from, to]| from + (to - from) * place.s / road.length_m);
    let pose = road.pose(place.s);
    let side = if place.lane < 0 { -1.0 } else { 1.0 };
    let t = begins + side * (inner + 0.5 * width(&lanes[own])) + place.offset;
    pose.position + Vec2::from_heading(pose.heading).left() * t
}

#[test]
fn every_lane_lies_where_ours_does() {
    for network in networks() {
        let map = DriveMap::new(&network, &[]);
        for (position, lane) in network.lanes.iter().enumerate() {
            let id = LaneId(u16::try_from(position).unwrap());
            for (share, t) in [(0.0, 0.0), (0.3, 1.2), (0.5, -0.7), (1.0, 0.0)] {
                let s = share * lane.length_m;
                let theirs = by_definition(&map, map.place(&network, id, s, t));
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
        let map = DriveMap::new(&network, &[]);
        let inside = map.roads.iter().filter(|road| road.junction.is_some()).count();
        assert_eq!((map.roads.len() - inside, inside, map.junctions.len()), (roads, connecting, junctions));
    }
}

#[test]
fn neighbours_meet_in_a_point_and_know_each_other() {
    for network in networks() {
        let map = DriveMap::new(&network, &[]);
        for road in &map.roads {
            let end = road.pose(road.length_m).position;
            if let Some(Neighbour::Road { id, at_start }) = road.successor {
                let other = map.roads.iter().find(|other| other.id == id).expect("a road of the map");
                let theirs = if at_start { other.pose(0.0).position } else { other.pose(other.length_m).position };
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

#[test]
fn every_lane_of_a_network_lies_where_ours_does() {
    for network in ["town", "ramps"].map(network) {
        let map = DriveMap::new(&network, &[]);
        for (position, lane) in network.lanes.iter().enumerate() {
            let id = LaneId(u16::try_from(position).unwrap());
            for share in [0.0, 0.3, 0.5, 1.0] {
                let (s, t) = (share * lane.length_m, 0.4);
                let place = map.place(&network, id, s, t);
                let length_m = map.roads[usize::try_from(place.road).unwrap() - 1].length_m;
                // A junction of ramps may have taken a metre at an end.
                if (1e-9..=length_m).contains(&place.s) {
                    // Where widths change, arcs stand for parabolas.
                    let off = by_definition(&map, place).distance(lane.position(s, t));
                    assert!(off < 0.05, "{off} m: lane {position} of {:?} at {s}", network.road(lane.road));
                }
            }
        }
    }
}

#[test]
fn roads_of_a_network_meet_directly_at_junctions_and_where_ramps_join() {
    let town = DriveMap::new(&network("town"), &[]);
    let road = |map: &DriveMap, name: &str| map.roads.iter().find(|road| road.name == name).unwrap().clone();
    let on = road(&town, "on");
    assert_eq!(on.predecessor, Some(Neighbour::Road { id: road(&town, "east").id, at_start: false }));
    let linked: Vec<_> = on.right.iter().chain(&on.left).map(|lane| (lane.number, lane.predecessor)).collect();
    assert_eq!(linked, [-1, -2, -3, 1, 2].map(|number| (number, Some(number))));
    // From the west one lane ahead, one left, one right and the bicycles; from the east the same with the turn lane in place of
    // the bicycles; from the north three and one back; from the south three.
    let junctions = |map: &DriveMap| -> Vec<(String, usize)> {
        map.junctions.iter().map(|junction| (junction.name.clone(), junction.roads.len())).collect()
    };
    assert_eq!(junctions(&town), [("j".to_owned(), 15)]);
    let ramps = DriveMap::new(&network("ramps"), &[]);
    assert_eq!(junctions(&ramps), [("merge begins".to_owned(), 3), ("leave ends".to_owned(), 3)]);
    assert_eq!(road(&ramps, "highway").successor, Some(Neighbour::Junction(ramps.junctions[0].id)));
    assert_eq!(road(&ramps, "merge").successor, Some(Neighbour::Road { id: road(&ramps, "leave").id, at_start: true }));
    assert!((road(&ramps, "merge").length_m - 99.0).abs() < 1e-9);
}

#[test]
fn signals_and_signs_stand_at_their_roads_ends() {
    let network = network("town");
    let control = r#"[{"at":"west+","set_back_m":5,"lanes":[0],"device":{"signal":{"program":[{"show":"green","for_s":10}]}}},
                      {"at":"north-","device":{"stop_sign":{}}}]"#;
    let map = DriveMap::new(&network, &serde_json::from_str::<Vec<_>>(control).expect("devices"));
    let signal = |road: &str| map.roads.iter().find(|known| known.name == road).unwrap().signals[0].clone();
    let value = |signal: &Element, name: &str| signal.attribute(name).unwrap().to_owned();
    let west = signal("west");
    assert_eq!([value(&west, "s"), value(&west, "orientation"), value(&west, "type")], ["80", "+", "1000001"]);
    assert_eq!(west.all("validity").map(|lanes| value(lanes, "fromLane")).collect::<Vec<_>>(), ["-1"]);
    let north = signal("north");
    assert_eq!([value(&north, "s"), value(&north, "orientation"), value(&north, "type")], ["0", "-", "R1-1"]);
    assert!(value(&north, "t").parse::<f64>().unwrap() > 0.0);
    assert_eq!((map.controllers.len(), map.junctions[0].controllers.clone()), (1, vec![1]));
    let objects = |road: &str| map.roads.iter().find(|known| known.name == road).unwrap().objects.clone();
    let kinds: Vec<_> = objects("west").iter().map(|object| value(object, "type")).collect();
    let count = |wanted: &str| kinds.iter().filter(|kind| *kind == wanted).count();
    assert_eq!(["crosswalk", "patch", "parkingSpace", "building"].map(count), [1, 1, 13, 1]);
}
