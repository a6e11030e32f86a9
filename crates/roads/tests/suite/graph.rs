//! Networks of roads: geometry against closed forms, ways and places by name, and random networks.

use recrash_model::geometry::Vec2;
use recrash_model::math::{FRAC_PI_2, PI, wrap_angle};
use recrash_model::scenario::{MapSpec, Place};
use recrash_roads::{Lane, LanePath, RoadNetwork, RoadPart};
use serde_json::{Value, json};

pub fn map(json: Value) -> MapSpec {
    let mut json = json;
    json["type"] = json!("G");
    serde_json::from_value(json).expect("a map")
}

pub fn network(json: Value) -> RoadNetwork {
    RoadNetwork::try_build(&map(json)).expect("a sound map")
}

fn drive(count: usize) -> Value {
    Value::Array(vec![json!({ "kind": "driving" }); count])
}

fn close(a: f64, b: f64, within: f64) -> bool {
    (a - b).abs() < within
}

fn names(list: &[&str]) -> Vec<String> {
    list.iter().map(|name| (*name).to_owned()).collect()
}

/// Asserts that a path has no gap and no kink.
fn continuous(path: &LanePath, gap_m: f64, kink_rad: f64) {
    for pair in path.segments.windows(2) {
        let (end, _, heading) = pair[0].shape.frame(pair[0].length_m);
        let (start, _, next) = pair[1].shape.frame(0.0);
        assert!(end.distance(start) < gap_m, "a gap of {} m at {} m", end.distance(start), pair[1].start_m);
        assert!(wrap_angle(heading - next).abs() < kink_rad, "a kink of {} rad", wrap_angle(heading - next));
        assert!(close(pair[0].start_m + pair[0].length_m, pair[1].start_m, 1e-9));
    }
}

/// A junction with arms in these directions, each with lanes in and out.
fn crossroads(bearings: &[f64], lanes: usize) -> Value {
    let roads: Vec<Value> = bearings
        .iter()
        .enumerate()
        .map(|(number, bearing)| {
            json!({
                "id": format!("arm{number}"),
                "start": { "arm": { "junction": "j", "bearing_deg": bearing, "from_m": 20.0 } },
                "line": [{ "straight": { "length_m": 80.0 } }],
                "right": drive(lanes), "left": drive(lanes),
            })
        })
        .collect();
    json!({ "roads": roads, "junctions": [{ "id": "j" }] })
}

#[test]
fn lanes_of_a_bend_are_exact_offsets_of_its_line() {
    let network = network(json!({ "roads": [{
        "id": "main", "start": { "at": { "x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0 } },
        "line": [
            { "straight": { "length_m": 50.0 } },
            { "arc": { "length_m": 50.0 * FRAC_PI_2, "radius_m": 50.0, "to": "left" } },
            { "straight": { "length_m": 30.0 } },
        ],
        "right": [{ "kind": "driving", "width_m": 3.0 }, { "kind": "driving", "width_m": 3.0 }, { "kind": "sidewalk", "width_m": 2.0 }],
        "left": [{ "kind": "driving", "width_m": 3.0 }, { "kind": "bike", "width_m": 2.0 }],
    }] }));
    let length = |road: &str, lane| {
        let position = network.named_road(road, "road").unwrap();
        let path = network.lane_of(&network.named[position], lane).unwrap();
        continuous(&path, 1e-6, 1e-6);
        path.length_m
    };
    for (road, lane, right_m) in
        [("main+", 0, 1.5), ("main+", 1, 4.5), ("main+.sidewalk", 0, 7.0), ("main-", 0, -1.5), ("main-.bike", 0, -4.0)]
    {
        assert!(close(length(road, lane), 80.0 + FRAC_PI_2 * (50.0 + right_m), 1e-9), "{road} {lane}");
    }
    let at = network.place(&Place::on("main-", 10.0)).unwrap();
    assert!(at.pose.position.distance(Vec2::new(100.0 - 1.5, 70.0)) < 1e-9, "{:?}", at.pose);
    assert!(close(at.pose.heading, -FRAC_PI_2, 1e-9));
}

#[test]
fn a_lane_that_narrows_to_nothing_ends_in_the_middle_of_its_last_width() {
    let network = network(json!({ "roads": [{
        "id": "drop", "start": { "at": { "x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0 } },
        "line": [{ "straight": { "length_m": 80.0 } }],
        "right": [{ "kind": "driving", "width_m": 3.0 }, { "kind": "driving", "width_m": 3.0, "end_width_m": 0.0 },
                  { "kind": "shoulder", "width_m": 2.0 }],
    }] }));
    let lane = |name: &str, number| {
        let position = network.named_road(name, "road").unwrap();
        network.lane_of(&network.named[position], number).unwrap()
    };
    let (kept, dropped, shoulder) = (lane("drop+", 0), lane("drop+", 1), lane("drop+.shoulder", 0));
    for path in [&kept, &dropped, &shoulder] {
        continuous(path, 1e-6, 1e-6);
    }
    let end = |path: &LanePath| path.pose(path.length_m, 0.0);
    assert!(close(kept.length_m, 80.0, 1e-9));
    assert!(close(end(&dropped).position.y, -3.0, 1e-9) && close(end(&dropped).heading, 0.0, 1e-9));
    assert!(close(end(&shoulder).position.y, -4.0, 1e-9));
    // Half of the change on half of the way.
    let middle = network.lane_at(Vec2::new(39.99, -3.75), 0.0).map(|id| *network.lane(id)).unwrap();
    assert!(close(middle.width_at(middle.length_m), 1.5, 0.01), "{middle:?}");
    let widths: Vec<f64> = dropped.segments.iter().map(|segment| network.lane(segment.lane).width_m).collect();
    assert!(widths.windows(2).all(|pair| pair[0] > pair[1]), "{widths:?}");
}

#[test]
fn a_right_turn_between_lanes_is_a_quarter_circle_and_a_left_turn_a_wider_one() {
    let network = network(crossroads(&[0.0, 90.0, 180.0, 270.0], 1));
    let length = |from: &str, to: &str| {
        let path = network.way(&names(&[from, to]), 0, None).unwrap();
        continuous(&path, 1e-6, 1e-6);
        path.length_m - 160.0
    };
    // 20 m from the centre to each arm, lanes 1.65 m beside its line.
    assert!(close(length("arm2-", "arm3+"), FRAC_PI_2 * (20.0 - 1.65), 1e-9));
    assert!(close(length("arm2-", "arm0+"), 40.0, 1e-9));
    assert!(close(length("arm2-", "arm1+"), FRAC_PI_2 * (20.0 + 1.65), 1e-9));
}

#[test]
fn lanes_turn_as_their_place_says_and_as_is_written() {
    let mut written = crossroads(&[0.0, 90.0, 180.0, 270.0], 2);
    let leads = |network: &RoadNetwork, lane: u8, to: &str| {
        let path = network.way(&names(&["arm2-", to]), lane, None).unwrap();
        continuous(&path, 1e-6, 1e-6);
        let numbers: Vec<u8> = path.segments.iter().map(|segment| network.lane(segment.lane).index).collect();
        (numbers[0], *numbers.last().unwrap(), path.segments.len())
    };
    let usual = network(written.clone());
    assert_eq!(leads(&usual, 0, "arm1+"), (0, 0, 3));
    assert_eq!(leads(&usual, 1, "arm3+"), (1, 1, 3));
    assert_eq!(leads(&usual, 1, "arm0+"), (1, 1, 3));
    // From the wrong lane, lanes are changed first.
    assert_eq!(leads(&usual, 1, "arm1+"), (1, 0, 6));
    written["roads"][2]["left"] = json!([
        { "kind": "driving", "turns": ["left"] }, { "kind": "driving", "turns": ["straight", "right"] },
    ]);
    let turned = network(written);
    assert_eq!(leads(&turned, 1, "arm0+"), (1, 0, 4), "the first lane that goes straight on goes to the first lane");
    assert_eq!(leads(&turned, 0, "arm1+"), (0, 0, 3));
}

#[test]
fn ways_against_the_lanes_pass_the_roads_in_the_order_given() {
    let network = network(crossroads(&[0.0, 90.0, 180.0, 270.0], 1));
    let along = network.way(&names(&["arm2-", "arm0+"]), 0, None).unwrap();
    let against = network.way_against(&names(&["arm0+", "arm2-"]), 0, None).unwrap();
    continuous(&against, 1e-6, 1e-6);
    for s in [0.0, 10.0, 90.0, 100.0, 180.0] {
        let (a, b) = (along.pose(along.length_m - s, 0.5), against.pose(s, -0.5));
        assert!(a.position.distance(b.position) < 1e-9, "{a:?} {b:?}");
        assert!(close(wrap_angle(a.heading - b.heading).abs(), PI, 1e-9));
    }
}

#[test]
fn places_and_ways_say_what_is_known() {
    let network = network(crossroads(&[0.0, 120.0, 240.0], 1));
    let place = |road: &str, s_m| network.place(&Place::on(road, s_m)).unwrap_err();
    assert_eq!(place("arn1+", 3.0).message, "there is no road \"arn1+\"");
    assert!(place("arn1+", 3.0).hint.starts_with("did you mean `arm1+`? known: arm0+, arm0-"));
    assert_eq!(place("arm1+", 131.0).message, "131 m is no place on \"arm1+\", which is 80.0 m long");
    assert_eq!(place("arm1+", 131.0).hint, "allowed: -50 to 130.0 m");
    let lane = network.way(&names(&["arm1+"]), 1, None).unwrap_err();
    assert_eq!((lane.field.as_str(), lane.hint.as_str()), ("lane", "allowed: 0"));
    let back = network.way(&names(&["arm1-", "arm1+"]), 0, None).unwrap_err();
    assert_eq!(back.message, "no way leads from \"arm1-\" to \"arm1+\"");
    assert_eq!((back.field.as_str(), back.hint.as_str()), ("roads[1]", "these follow it: arm0+, arm2+"));
}

#[test]
fn a_ramp_ends_where_its_lane_of_the_other_road_begins() {
    let network = network(json!({ "roads": [
        { "id": "highway", "start": { "at": { "x_m": 0.0, "y_m": 0.0, "heading_deg": 10.0 } },
          "line": [{ "straight": { "length_m": 200.0 } }], "right": drive(2) },
        { "id": "merge", "start": { "after": { "road": "highway" } }, "line": [{ "straight": { "length_m": 150.0 } }],
          "right": [{ "kind": "driving" }, { "kind": "driving" }, { "kind": "driving", "end_width_m": 0.0 }] },
        { "id": "ramp", "start": { "into_lane": { "road": "merge+", "lane": 2 } },
          "line": [{ "straight": { "length_m": 50.0 } }, { "spiral": { "length_m": 60.0, "to_radius_m": 150.0, "to": "left" } }],
          "right": drive(1) },
    ] }));
    let merged = network.way(&names(&["ramp+", "merge+"]), 0, None).unwrap();
    continuous(&merged, 1e-6, 1e-6);
    assert_eq!(network.lane(merged.segments.last().unwrap().lane).index, 2);
    let ahead = network.way(&names(&["highway+", "merge+"]), 1, None).unwrap();
    continuous(&ahead, 1e-6, 1e-6);
    assert!(close(ahead.length_m, 350.0, 1e-9));
    let changed = network.way(&names(&["ramp+", "merge+"]), 0, Some(1)).unwrap();
    continuous(&changed, 1e-6, 1e-6);
    assert_eq!(network.lane(changed.segments.last().unwrap().lane).index, 1);
}

#[test]
fn a_lane_that_narrows_to_nothing_leads_nowhere() {
    let mut json = json!({ "roads": [
        { "id": "drop", "start": { "at": { "x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0 } }, "line": [{ "straight": { "length_m": 80.0 } }],
          "right": [{ "kind": "driving" }, { "kind": "driving", "end_width_m": 0.0 }] },
        { "id": "grow", "start": { "after": { "road": "drop" } }, "line": [{ "straight": { "length_m": 80.0 } }],
          "right": [{ "kind": "driving" }, { "kind": "driving", "width_m": 0.0, "end_width_m": 3.3 }] },
    ] });
    let dropped = network(json.clone());
    let path = dropped.way(&names(&["drop+", "grow+"]), 1, Some(1)).unwrap();
    continuous(&path, 1e-6, 1e-6);
    let at_joint = path.segment_at(80.0);
    assert_eq!(
        dropped.lane(path.segments[at_joint].lane).index,
        0,
        "two changes: off the lane that ends, onto the new one"
    );
    json["roads"].as_array_mut().unwrap().push(json!({
        "id": "ramp", "start": { "into_lane": { "road": "grow+", "lane": 1 } }, "line": [{ "straight": { "length_m": 30.0 } }],
        "right": [{ "kind": "driving" }],
    }));
    let problems = RoadNetwork::try_build(&map(json)).unwrap_err();
    assert_eq!(
        (problems[0].code.as_str(), problems[0].location.path.as_deref()),
        ("scenario.joint", Some("map.roads[2].start"))
    );
}

#[test]
fn blocks_have_the_names_of_the_format() {
    let named = |map: &MapSpec| {
        let network = RoadNetwork::build(map);
        network.named.iter().map(|road| road.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(named(&crate::common::straight(2)), ["ego+", "ego-"]);
    assert_eq!(
        named(&crate::common::cross(1)),
        ["ego+", "ego-", "right+", "right-", "ahead+", "ahead-", "left+", "left-"]
    );
    let network = RoadNetwork::build(&crate::common::cross(1));
    let way = network.way(&names(&["ego+", "left+"]), 0, None).unwrap();
    assert!(close(way.length_m, 60.0 + 60.0 + FRAC_PI_2 * 13.5, 1e-9));
    let round = RoadNetwork::build(&crate::common::roundabout(2));
    let way = round.way(&names(&["ego+", "left+"]), 1, Some(1)).unwrap();
    continuous(&way, 1e-6, 1e-6);
}

#[test]
fn every_connection_leads_from_the_end_of_a_lane_to_the_beginning_of_another() {
    let network = network(crossroads(&[0.0, 70.0, 160.0, 230.0, 300.0], 2));
    let followers = &network.followers;
    let leads_in = |lane: &Lane| network.road(lane.road).part == RoadPart::Inner;
    for (index, lane) in network.lanes.iter().enumerate() {
        if !leads_in(lane) {
            continue;
        }
        assert!(!followers[index].is_empty(), "a connection ends nowhere");
        assert!(followers.iter().flatten().any(|id| usize::from(id.0) == index), "a connection begins nowhere");
    }
}
