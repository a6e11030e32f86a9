//! What the check says of networks of roads.

use recrash_model::Diagnostic;
use recrash_roads::{check, scenario_schema};
use serde_json::{Value, json};

/// A junction of three arms with something of everything that has a range.
fn sample() -> Value {
    json!({
        "type": "G",
        "roads": [
            { "id": "west", "start": { "at": { "x_m": -120.0, "y_m": 0.0, "heading_deg": 0.0 } },
              "line": [{ "straight": { "length_m": 60.0 } }, { "arc": { "length_m": 20.0, "radius_m": 500.0, "to": "left" } },
                       { "spiral": { "length_m": 20.0, "from_radius_m": 500.0, "to_radius_m": 9000.0, "to": "left" } }],
              "right": [{ "kind": "driving", "width_m": 3.0, "end_width_m": 3.3 }, { "kind": "parking", "stall_m": 6.0 },
                        { "kind": "stalls", "stall_m": 2.5, "stall_angle_deg": 60.0 }],
              "left": [{ "kind": "driving" }], "speed_limit_mps": 13.0,
              "crosswalks": [{ "s_m": 50.0, "width_m": 3.0 }],
              "driveways": [{ "side": "right", "s_m": 30.0, "width_m": 4.0, "depth_m": 6.0 }] },
            { "id": "east", "start": { "arm": { "junction": "j", "bearing_deg": 0.0, "from_m": 20.0 } },
              "line": [{ "straight": { "length_m": 60.0 } }], "right": [{ "kind": "driving" }], "left": [{ "kind": "driving" }] },
            { "id": "north", "start": { "arm": { "junction": "j", "bearing_deg": 90.0, "from_m": 20.0 } },
              "line": [{ "straight": { "length_m": 60.0 } }], "right": [{ "kind": "driving" }], "left": [{ "kind": "driving" }] },
        ],
        "junctions": [{ "id": "j", "x_m": 0.0, "y_m": 1.0, "ends": ["west"] }],
    })
}

fn problems(map: Value) -> Vec<Diagnostic> {
    let draft = json!({
        "format": "recrash.scenario/2", "id": "network", "source": {}, "map": map, "duration_s": 20.0,
        "ego": { "s_m": 10.0, "lane": 0, "speed_mps": 5.0, "target_speed_mps": 10.0, "turn": "straight" },
    });
    let draft = serde_json::from_value(draft).expect("a draft");
    let all = match check(draft) {
        Ok(outcome) => outcome.diagnostics,
        Err(diagnostics) => diagnostics,
    };
    all.into_iter()
        .filter(|problem| problem.location.path.as_deref().is_some_and(|path| path.starts_with("map")))
        .collect()
}

fn told(map: Value) -> Vec<(String, String)> {
    problems(map).into_iter().map(|problem| (problem.code, problem.location.path.unwrap_or_default())).collect()
}

/// The one problem of the sample with another value at a place.
fn with(pointer: &str, value: Value) -> (String, String) {
    let mut map = sample();
    *map.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value;
    let told = told(map);
    assert_eq!(told.len(), 1, "{told:?}");
    told.into_iter().next().unwrap()
}

#[test]
fn the_sample_is_sound() {
    assert_eq!(told(sample()), []);
}

#[test]
fn the_ranges_are_those_of_the_schema() {
    let schema = scenario_schema();
    let definition = |name: &str, variant: Option<&str>| {
        let mut found = &schema["$defs"][name];
        if let Some(variant) = variant {
            let variants = found["oneOf"].as_array().expect("variants");
            found = variants.iter().find_map(|each| each["properties"].get(variant)).expect("the variant");
        }
        found["properties"].as_object().expect("fields").clone()
    };
    let mut tried = 0;
    for (pointer, name, variant) in [
        ("/roads/0", "RoadSpec", None),
        ("/roads/0/start/at", "RoadStart", Some("at")),
        ("/roads/1/start/arm", "RoadStart", Some("arm")),
        ("/roads/0/line/0/straight", "LinePiece", Some("straight")),
        ("/roads/0/line/1/arc", "LinePiece", Some("arc")),
        ("/roads/0/line/2/spiral", "LinePiece", Some("spiral")),
        ("/roads/0/right/0", "Strip", None),
        ("/roads/0/right/2", "Strip", None),
        ("/roads/0/crosswalks/0", "Crosswalk", None),
        ("/roads/0/driveways/0", "Driveway", None),
        ("/junctions/0", "JunctionSpec", None),
    ] {
        for (field, schema) in definition(name, variant) {
            let (Some(min), Some(max)) = (schema["minimum"].as_f64(), schema["maximum"].as_f64()) else { continue };
            let place = format!("{pointer}/{field}");
            if sample().pointer(&place).is_none() {
                continue;
            }
            tried += 1;
            for (value, outside) in [(min, false), (max, false), (min - 0.01, true), (max + 0.01, true)] {
                let mut map = sample();
                *map.pointer_mut(&place).expect("the field") = json!(value);
                let path = format!("map{place}").replace('/', ".");
                let path = (0..3).fold(path, |path, n| path.replace(&format!(".{n}"), &format!("[{n}]")));
                let told = problems(map);
                let told = told.iter().any(|problem| {
                    problem.location.path.as_deref() == Some(path.as_str()) && problem.message.ends_with("out of range")
                });
                assert_eq!(told, outside, "{path} = {value}");
            }
        }
    }
    assert_eq!(tried, 23, "every range of the schema is tried");
}

#[test]
fn what_hangs_together_is_checked() {
    let pair = |code: &str, path: &str| (code.to_owned(), path.to_owned());
    assert_eq!(with("/roads/1/id", json!("west")), pair("scenario.duplicate-id", "map.roads[1].id"));
    assert_eq!(with("/roads/1/id", json!("so east")), pair("scenario.id", "map.roads[1].id"));
    assert_eq!(
        with("/roads/1/start", json!({ "arm": { "junction": "k", "bearing_deg": 0.0, "from_m": 20.0 } })),
        pair("scenario.unknown-id", "map.roads[1].start.arm.junction")
    );
    assert_eq!(
        with("/roads/1/start", json!({ "after": { "road": "norht" } })),
        pair("scenario.unknown-id", "map.roads[1].start.after.road")
    );
    assert_eq!(
        with("/roads/1/start", json!({ "after": { "road": "east" } })),
        pair("scenario.start-unknown", "map.roads[1].start")
    );
    assert_eq!(
        with("/roads/1/start", json!({ "into_lane": { "road": "west+", "lane": 1 } })),
        pair("scenario.lane", "map.roads[1].start.into_lane.lane")
    );
    assert_eq!(with("/roads/0/right/0/kind", json!("bike")), pair("scenario.no-lane", "map.roads[0].right"));
    let bend = json!({ "arc": { "length_m": 10.0, "radius_m": 11.5, "to": "right" } });
    assert_eq!(with("/roads/0/line/1", bend), pair("scenario.curve-too-tight", "map.roads[0].line[1]"));
    assert_eq!(with("/roads/2/start/arm/bearing_deg", json!(5.0)), pair("scenario.arms-overlap", "map.roads[2].start"));
    assert_eq!(with("/roads/0/crosswalks/0/s_m", json!(101.0)).1, "map.roads[0].crosswalks[0].s_m");
    assert_eq!(with("/roads/1/left/0", json!({ "kind": "bike", "turns": ["left"] })).0, "scenario.strip");
    assert_eq!(with("/junctions/0/x_m", json!(200.0)), pair("scenario.junction", "map.junctions[0].ends[0]"));
}

#[test]
fn roads_that_follow_each_other_have_lanes_that_meet() {
    let mut map = sample();
    map["roads"].as_array_mut().unwrap().push(json!({
        "id": "on", "start": { "after": { "road": "east" } }, "line": [{ "straight": { "length_m": 30.0 } }],
        "right": [{ "kind": "median" }, { "kind": "driving" }],
    }));
    let problem = &problems(map)[0];
    assert_eq!(problem.code, "scenario.joint");
    assert_eq!(problem.message, "lane 0 of \"on+\" is 1.500 m beside that of \"east\", which it follows");
}
