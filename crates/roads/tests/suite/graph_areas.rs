//! Areas of networks, and how networks are drawn.

use crate::graph::network;
use recrash_model::geometry::Vec2;
use recrash_model::math::{FRAC_PI_2, PI};
use recrash_roads::graph::GroundKind;
use recrash_roads::{GroundShape, LineKind, RoadNetwork, RoadPart};
use serde_json::{Value, json};

/// A street along the x axis with something of everything.
fn street() -> RoadNetwork {
    network(json!({ "roads": [{
        "id": "main", "start": { "at": { "x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0 } },
        "line": [{ "straight": { "length_m": 60.0 } }],
        "right": [{ "kind": "driving", "width_m": 3.0 }, { "kind": "parking", "width_m": 2.0, "stall_m": 6.0 },
                  { "kind": "sidewalk", "width_m": 2.0 }],
        "left": [{ "kind": "driving", "width_m": 3.0 }, { "kind": "stalls", "width_m": 5.0, "stall_m": 3.0, "stall_angle_deg": 45.0 }],
        "crosswalks": [{ "s_m": 20.0, "width_m": 3.0 }],
        "driveways": [{ "side": "right", "s_m": 40.0, "width_m": 4.0, "depth_m": 6.0 }],
    }], "areas": [{ "kind": "building", "points": [[0.0, -10.0], [10.0, -10.0], [10.0, -20.0]] }] }))
}

fn close(a: Vec2, x: f64, y: f64) -> bool {
    a.distance(Vec2::new(x, y)) < 1e-9
}

#[test]
fn a_crosswalk_lies_across_all_that_is_paved() {
    let network = street();
    let crosswalk = network.area("main.crosswalks[0]").unwrap();
    assert_eq!(crosswalk.kind, GroundKind::Crosswalk);
    assert!(close(crosswalk.points[0], 18.5, -5.0) && close(crosswalk.points[2], 21.5, 8.0), "{crosswalk:?}");
    assert!(close(crosswalk.middle.position, 20.0, 1.5) && (crosswalk.middle.heading - FRAC_PI_2).abs() < 1e-9);
}

#[test]
fn a_driveway_leads_from_the_kerb_across_the_sidewalk() {
    let driveway = street().area("main.driveways[0]").unwrap().clone();
    assert!(close(driveway.points[0], 38.0, -5.0) && close(driveway.points[2], 42.0, -11.0), "{driveway:?}");
    assert!(close(driveway.middle.position, 40.0, -8.0) && (driveway.middle.heading - FRAC_PI_2).abs() < 1e-9);
}

#[test]
fn stalls_stand_in_a_row_and_are_entered_forwards() {
    let network = street();
    let names = |prefix: &str| network.areas.iter().filter(|area| area.name.starts_with(prefix)).count();
    assert_eq!(names("main+.parking["), 10);
    // 60 m less the 5 m by which the row leans forward, 3 m each.
    assert_eq!(names("main-.stalls["), 18);
    let bay = network.area("main+.parking[1]").unwrap();
    assert!(close(bay.middle.position, 9.0, -4.0) && bay.middle.heading.abs() < 1e-9);
    let stall = network.area("main-.stalls[0]").unwrap();
    // Against the line, so from its end: half of a stall and half of the lean along, in the middle of the strip.
    assert!(close(stall.middle.position, 60.0 - 1.5 - 2.5, 5.5), "{stall:?}");
    assert!((stall.middle.heading - 0.75 * PI).abs() < 1e-9);
}

#[test]
fn what_is_paved_is_road_and_a_sidewalk_is_not() {
    let network = street();
    for (x, y, road) in
        [(5.0, -1.5, true), (5.0, -4.0, true), (5.0, -6.0, false), (40.0, -8.0, true), (30.0, -8.0, false)]
    {
        assert_eq!(network.on_road(Vec2::new(x, y)), road, "{x} {y}");
    }
}

#[test]
fn a_junction_is_paved_between_its_arms() {
    let arm = |bearing: f64| -> Value {
        json!({ "id": format!("arm{bearing}"), "start": { "arm": { "junction": "j", "bearing_deg": bearing, "from_m": 15.0 } },
                "line": [{ "straight": { "length_m": 30.0 } }],
                "right": [{ "kind": "driving" }, { "kind": "sidewalk" }], "left": [{ "kind": "driving" }, { "kind": "sidewalk" }] })
    };
    let network = network(json!({ "roads": [arm(0.0), arm(90.0), arm(210.0)], "junctions": [{ "id": "j" }] }));
    for lane in network.lanes.iter().filter(|lane| network.road(lane.road).part == RoadPart::Inner) {
        for share in [0.02, 0.25, 0.5, 0.75, 0.98] {
            let (s, half) = (share * lane.length_m, 0.48 * lane.width_at(share * lane.length_m));
            assert!([-half, 0.0, half].iter().all(|t| network.on_road(lane.position(s, *t))), "{lane:?}");
        }
    }
    assert_eq!(network.areas.iter().filter(|area| area.name.starts_with("j.corners")).count(), 3);
    assert!(!network.on_road(Vec2::new(12.0, 12.0)));
}

#[test]
fn a_street_is_drawn_strip_by_strip() {
    let drawing = street().drawing();
    let shapes = |shape| drawing.areas.iter().filter(|area| area.shape == shape).count();
    assert_eq!(shapes(GroundShape::Parking), 2);
    assert_eq!(shapes(GroundShape::Sidewalk), 1);
    assert_eq!(shapes(GroundShape::Crosswalk), 13, "stripes of half a metre on 13 m");
    assert_eq!((shapes(GroundShape::Driveway), shapes(GroundShape::Building)), (1, 1));
    let lines = |kind| drawing.lines.iter().filter(|line| line.kind == kind).count();
    assert_eq!((lines(LineKind::Centre), lines(LineKind::Stall)), (1, 2 * 28));
    assert_eq!(drawing.surfaces.len(), 5, "four paved strips and the driveway");
}

#[test]
fn a_stop_line_lies_across_the_lanes_of_its_device() {
    let network = street();
    let control = json!([{ "at": "main+", "set_back_m": 2.0, "device": { "stop_sign": {} } }]);
    let lines = network.stop_lines(&serde_json::from_value::<Vec<_>>(control).unwrap());
    assert!(close(lines[0][0], 58.0, 0.0) && close(lines[0][1], 58.0, -3.0), "{lines:?}");
}
