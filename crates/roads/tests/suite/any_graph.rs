//! Random networks: building one never panics, and what is built is sound.

use crate::graph::map;
use proptest::prelude::*;
use recrash_model::math::wrap_angle;
use recrash_roads::{LanePath, RoadNetwork, RoadPart};
use serde_json::{Value, json};

fn strip() -> impl Strategy<Value = Value> {
    let kinds = ["driving", "driving", "driving", "bike", "parking", "shoulder", "sidewalk", "median", "centre_turn"];
    (prop::sample::select(kinds.to_vec()), prop::option::of(2.0..4.5_f64), prop::option::weighted(0.2, 0.0..4.5_f64))
        .prop_map(|(kind, width, end)| {
            let mut strip = json!({ "kind": kind });
            if let Some(width) = width {
                strip["width_m"] = json!(width);
            }
            if let Some(end) = end {
                strip["end_width_m"] = json!(end);
            }
            strip
        })
}

fn piece() -> impl Strategy<Value = Value> {
    let side = || prop::sample::select(vec!["left", "right"]);
    prop_oneof![
        (1.0..80.0_f64).prop_map(|length| json!({ "straight": { "length_m": length } })),
        (1.0..60.0_f64, 15.0..200.0_f64, side())
            .prop_map(|(length, radius, to)| json!({ "arc": { "length_m": length, "radius_m": radius, "to": to } })),
        (5.0..80.0_f64, prop::option::of(20.0..300.0_f64), prop::option::of(20.0..300.0_f64), side()).prop_map(
            |(length, from, end, to)| {
                let mut spiral = json!({ "length_m": length, "to": to });
                if let Some(radius) = from {
                    spiral["from_radius_m"] = json!(radius);
                }
                if let Some(radius) = end {
                    spiral["to_radius_m"] = json!(radius);
                }
                json!({ "spiral": spiral })
            }
        ),
        prop::collection::vec((10.0..30.0_f64, -4.0..4.0_f64), 1..5).prop_map(|steps| {
            let mut x = 0.0;
            let points: Vec<[f64; 2]> = steps
                .into_iter()
                .map(|(dx, y)| {
                    x += dx;
                    [x, y]
                })
                .collect();
            json!({ "points": { "points": points } })
        }),
    ]
}

/// A junction with three to five arms, and roads that follow some of them.
fn any_map() -> impl Strategy<Value = Value> {
    let arm = (
        0.0..50.0_f64,
        12.0..45.0_f64,
        prop::collection::vec(piece(), 1..3),
        prop::collection::vec(strip(), 1..5),
        prop::collection::vec(strip(), 0..5),
        any::<bool>(),
    );
    (prop::collection::vec(arm, 3..=5), any::<bool>()).prop_map(|(arms, u_turns)| {
        let spread = 360.0 / arms.len() as f64;
        let mut roads = Vec::new();
        for (number, (turned, from_m, line, right, left, followed)) in arms.into_iter().enumerate() {
            let bearing = (spread * number as f64 + turned * 0.5) % 360.0;
            let mut right = right;
            right.insert(0, json!({ "kind": "driving" }));
            if followed {
                let narrow = |strips: &[Value]| -> Vec<Value> {
                    let strips = strips.iter().cloned().map(|mut strip| {
                        if let Some(end) = strip.as_object_mut().and_then(|fields| fields.remove("end_width_m")) {
                            strip["width_m"] = end;
                        }
                        strip
                    });
                    strips.collect()
                };
                roads.push(json!({
                    "id": format!("next{number}"), "start": { "after": { "road": format!("arm{number}") } },
                    "line": [{ "straight": { "length_m": 40.0 } }], "right": narrow(&right), "left": narrow(&left),
                }));
            }
            roads.push(json!({
                "id": format!("arm{number}"), "start": { "arm": { "junction": "j", "bearing_deg": bearing, "from_m": from_m } },
                "line": line, "right": right, "left": left,
            }));
        }
        // The first road has a lane to its right.
        roads.reverse();
        let u_turns: Vec<&str> = if u_turns { vec!["arm0"] } else { vec![] };
        json!({ "roads": roads, "junctions": [{ "id": "j", "u_turns": u_turns }] })
    })
}

/// Joints of a path are closer than a millimetre, and smooth but where a road follows another.
fn assert_continuous(path: &LanePath) {
    for pair in path.segments.windows(2) {
        let (end, _, heading) = pair[0].shape.frame(pair[0].length_m);
        let (start, _, next) = pair[1].shape.frame(0.0);
        assert!(end.distance(start) < 1e-3, "a gap of {} m", end.distance(start));
        assert!(wrap_angle(heading - next).abs() < 1e-4, "a kink of {} rad", wrap_angle(heading - next));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_built_is_sound(json in any_map()) {
        let Ok(network) = RoadNetwork::try_build(&map(json)) else { return Ok(()) };
        for road in &network.named {
            for lane in 0..network.lanes_of(road) {
                let path = network.lane_of(road, lane).unwrap();
                for pair in path.segments.windows(2) {
                    let (end, _, heading) = pair[0].shape.frame(pair[0].length_m);
                    let (start, _, next) = pair[1].shape.frame(0.0);
                    prop_assert!(end.distance(start) < 1e-6, "{}: {}", road.name, end.distance(start));
                    prop_assert!(wrap_angle(heading - next).abs() < 1e-6, "{}: {}", road.name, wrap_angle(heading - next));
                }
            }
        }
        for lane in &network.lanes {
            prop_assert!(lane.length_m > 0.0 && lane.length_m.is_finite() && lane.width_m >= 0.0);
            if network.road(lane.road).part == RoadPart::Inner {
                prop_assert!(lane.curvature().abs() < 1.0);
            }
        }
        let names: Vec<String> = network.named.iter().map(|road| road.name.clone()).collect();
        for from in names.iter().filter(|name| name.ends_with('-')) {
            for to in names.iter().filter(|name| name.ends_with('+')) {
                if let Ok(path) = network.way(&[from.clone(), to.clone()], 0, None) {
                    assert_continuous(&path);
                }
            }
        }
    }
}
