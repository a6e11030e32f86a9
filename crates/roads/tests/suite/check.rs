//! The check, rule by rule: one draft that passes, and for each rule the smallest change that breaks it.

use recrash_model::geometry::OrientedBox;
use recrash_model::scenario::{Approach, SCENARIO_FORMAT, SCENARIO_FORMAT_1, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;
use recrash_model::{Diagnostic, Severity};
use recrash_roads::{check, read_draft, write_draft};
use serde_json::{Value, json};

fn crossing() -> Value {
    serde_json::from_str(include_str!("../drafts/crossing.json")).expect("valid JSON")
}

/// The draft with the values at these JSON pointers replaced or added.
fn with(changes: &[(&str, Value)]) -> ScenarioDraft {
    let mut value = crossing();
    for (pointer, new) in changes {
        let (parent, name) = pointer.rsplit_once('/').expect("a pointer");
        match value.pointer_mut(parent).expect("the parent exists") {
            Value::Object(object) => _ = object.insert(name.to_owned(), new.clone()),
            Value::Array(items) => match name.parse::<usize>() {
                Ok(index) if index < items.len() => items[index] = new.clone(),
                _ => items.push(new.clone()),
            },
            other => panic!("{other} has no parts"),
        }
    }
    serde_json::from_value(value).expect("the changed draft still has the right types")
}

fn remarks(draft: ScenarioDraft) -> Vec<Diagnostic> {
    match check(draft) {
        Ok(outcome) => outcome.diagnostics,
        Err(diagnostics) => diagnostics,
    }
}

/// Asserts that a change is refused with exactly one error, and gives it.
#[track_caller]
fn refused(changes: &[(&str, Value)], code: &str, path: &str) -> Diagnostic {
    let errors: Vec<_> = remarks(with(changes)).into_iter().filter(Diagnostic::is_error).collect();
    let [error] = errors.as_slice() else { panic!("not one error but {errors:#?}") };
    assert_eq!((error.code.as_str(), error.location.path.as_deref()), (code, Some(path)), "{error}");
    assert!(!error.hint.is_empty(), "no hint: {error}");
    error.clone()
}

#[track_caller]
fn accepted(changes: &[(&str, Value)]) -> recrash_roads::Scenario {
    match check(with(changes)) {
        Ok(outcome) => outcome.value,
        Err(diagnostics) => panic!("{diagnostics:#?}"),
    }
}

fn straight_map() -> Value {
    json!({"type": "S", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "length_m": 200.0})
}

fn ring_map() -> Value {
    json!({"type": "O", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 80.0, "exit_radius_m": 10.0,
           "inner_radius_m": 30.0})
}

#[test]
fn a_timed_start_lies_where_both_meet_after_their_target_speeds() {
    let scenario = accepted(&[]);
    let partner = &scenario.partners()[0];
    let conflict = partner.conflict.expect("they cross");
    // The ego needs (70 - 5) / 8 = 8.125 s to (70, 0); the partner 0.5 s more at 10 m/s: 86.25 m before its 100.5 m.
    assert!((conflict.s_a - 70.0).abs() < 1e-9 && (conflict.s_b - 100.5).abs() < 1e-9, "{conflict:?}");
    assert!((partner.s_m - (100.5 - 86.25)).abs() < 1e-9, "{}", partner.s_m);
    assert!((partner.pose.position.x - 70.0).abs() < 1e-9);
    assert!((partner.pose.position.y - (100.5 - partner.s_m)).abs() < 1e-9);
    assert_eq!(scenario.ego().pose.position.x, 5.0);
    assert_eq!(scenario.draft(), &with(&[]));
}

#[test]
fn an_obstacle_lies_on_the_ego_s_lane_as_given() {
    let scenario = accepted(&[]);
    let cone = &scenario.obstacles()[0];
    assert_eq!((cone.placed.pose.position.x, cone.placed.pose.position.y), (40.0, 1.75));
    assert_eq!((cone.placed.length_m, cone.placed.width_m), (0.4, 0.4));
}

#[test]
fn an_offset_start_counts_along_the_ego_s_road() {
    let start = json!({"delta_s_m": 20.0, "delta_t_m": 0.5});
    let same = accepted(&[("/partners/0/approach", json!("same")), ("/partners/0/start", start.clone())]);
    let pose = same.partners()[0].pose;
    assert!((pose.position.x - 25.0).abs() < 1e-9 && (pose.position.y + 0.5).abs() < 1e-9);
    let oncoming = accepted(&[
        ("/map", straight_map()),
        ("/partners/0/approach", json!("opposite")),
        ("/partners/0/start", start),
    ]);
    let pose = oncoming.partners()[0].pose;
    assert!((pose.position.x - 25.0).abs() < 1e-9 && (pose.position.y - 11.0).abs() < 1e-9, "{pose:?}");
}

#[test]
fn an_offset_in_a_curve_is_beside_the_ego_s_own_way() {
    let map = json!({"type": "C", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "radius_m": 50.0,
                     "angle_deg": 90.0, "direction": "left", "length_m": 40.0});
    let scenario = accepted(&[
        ("/map", map),
        ("/obstacles", json!([])),
        ("/partners/0/approach", json!("same")),
        ("/partners/0/lane_offset", json!(-1)),
        ("/partners/0/start", json!({"delta_s_m": 80.0})),
    ]);
    // 25 m into the curve of radius 50 is half a radian; the inner lane has radius 46.5.
    assert!((scenario.partners()[0].s_m - (60.0 + 0.5 * 46.5)).abs() < 1e-9);
}

#[test]
fn numbers_out_of_range_are_told_with_the_range() {
    let cases = [
        ("/duration_s", json!(0.5), "duration_s"),
        ("/duration_s", json!(121.0), "duration_s"),
        ("/map/approach_m", json!(19.0), "map.approach_m"),
        ("/map/arm_m", json!(1e300), "map.arm_m"),
        ("/map/lane_width_m", json!(-3.5), "map.lane_width_m"),
        ("/ego/speed_mps", json!(23.0), "ego.speed_mps"),
        ("/ego/target_speed_mps", json!(0.0), "ego.target_speed_mps"),
        ("/ego/s_m", json!(61.0), "ego.s_m"),
        ("/partners/0/speed_mps", json!(-1.0), "partners[0].speed_mps"),
        ("/partners/0/start", json!({"arrival_gap_s": 1e9}), "partners[0].start.arrival_gap_s"),
        ("/partners/0/policy/target_speed_mps", json!(0.0), "partners[0].policy.target_speed_mps"),
        ("/traffic", json!({"density": 1.5}), "traffic.density"),
        ("/obstacles/0/t_m", json!(99.0), "obstacles[0].t_m"),
    ];
    for (pointer, value, path) in cases {
        let error = refused(&[(pointer, value)], "scenario.range", path);
        assert!(error.hint.starts_with("allowed: "), "{error}");
    }
    refused(&[("/map/lanes", json!(0))], "scenario.range", "map.lanes");
    refused(&[("/map/lanes", json!(200))], "scenario.range", "map.lanes");
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut draft = with(&[]);
        draft.ego.target_speed_mps = value;
        let found = remarks(draft);
        assert_eq!(found[0].code, "scenario.not-finite");
        assert_eq!(found[0].location.path.as_deref(), Some("ego.target_speed_mps"));
    }
}

#[test]
fn ids_are_safe_for_file_names() {
    refused(&[("/id", json!(""))], "scenario.id", "id");
    refused(&[("/id", json!("../etc/passwd"))], "scenario.id", "id");
    refused(&[("/id", json!(".."))], "scenario.id", "id");
    refused(&[("/id", json!("a".repeat(81)))], "scenario.id", "id");
    refused(&[("/partners/0/id", json!("cp 1"))], "scenario.id", "partners[0].id");
    refused(&[("/partners/0/id", json!("ego"))], "scenario.id", "partners[0].id");
    refused(&[("/format", json!("recrash.scenario/3"))], "scenario.format", "format");
}

#[test]
fn partners_have_different_ids() {
    let mut second = crossing()["partners"][0].clone();
    second["approach"] = json!("right");
    second["start"]["arrival_gap_s"] = json!(-1.0);
    refused(&[("/partners/1", second)], "scenario.duplicate-id", "partners[1].id");
}

#[test]
fn turns_the_map_lacks_are_refused_with_those_it_has() {
    let error = refused(
        &[("/map", straight_map()), ("/ego/turn", json!("left")), ("/partners", json!([]))],
        "scenario.unreachable-turn",
        "ego.turn",
    );
    assert_eq!(error.hint, "allowed: straight");
    let tee =
        json!({"type": "T", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 80.0, "missing": "left"});
    let error = refused(&[("/map", tee)], "scenario.unreachable-turn", "partners[0].approach");
    assert_eq!(error.hint, "allowed: \"same\", \"opposite\", \"right\"");
    refused(&[("/partners/0/approach", json!("ring"))], "scenario.unreachable-turn", "partners[0].approach");
}

#[test]
fn lanes_are_counted_after_the_offset() {
    refused(&[("/ego/lane", json!(2))], "scenario.lane", "ego.lane");
    let error = refused(&[("/partners/0/lane_offset", json!(1))], "scenario.lane", "partners[0].lane_offset");
    assert!(error.hint.starts_with("allowed: -1 to 0"), "{error}");
    refused(&[("/partners/0/lane_offset", json!(-128))], "scenario.lane", "partners[0].lane_offset");
}

#[test]
fn the_hint_on_an_arrival_gap_gives_bounds_that_are_themselves_accepted() {
    let error = refused(
        &[("/partners/0/start/arrival_gap_s", json!(20.0))],
        "scenario.arrival-gap",
        "partners[0].start.arrival_gap_s",
    );
    // All of it on the road (s = 2.2575) it needs 98.24 / 10 s, 1.699 s more than the ego; at the arm's end 20.5 / 10 s,
    // 6.075 s less.
    assert_eq!(error.hint, "allowed: arrival_gap_s from -6.075 to 1.699 s, or map.arm_m of 264 m");
    for gap in [-6.075, 1.699] {
        accepted(&[("/partners/0/start/arrival_gap_s", json!(gap))]);
    }
    accepted(&[("/partners/0/start/arrival_gap_s", json!(20.0)), ("/map/arm_m", json!(264.0))]);
    refused(
        &[("/partners/0/start/arrival_gap_s", json!(-7.0))],
        "scenario.arrival-gap",
        "partners[0].start.arrival_gap_s",
    );
}

#[test]
fn an_arrival_gap_needs_a_place_to_arrive_at() {
    refused(&[("/partners/0/approach", json!("same"))], "scenario.no-conflict", "partners[0].start.arrival_gap_s");
    let error =
        refused(&[("/partners/0/turn", json!("right"))], "scenario.no-conflict", "partners[0].start.arrival_gap_s");
    assert!(error.hint.ends_with("these do: straight, left"), "{error}");
    refused(
        &[("/partners/0/policy", json!({"type": "stopped"})), ("/partners/0/speed_mps", json!(0.0))],
        "scenario.no-arrival",
        "partners[0].start.arrival_gap_s",
    );
}

#[test]
fn offsets_are_for_the_ego_s_own_road() {
    let start = json!({"delta_s_m": 10.0});
    refused(&[("/partners/0/start", start)], "scenario.start-form", "partners[0].start");
    let behind = json!({"delta_s_m": -6.0});
    let error = refused(
        &[("/partners/0/approach", json!("same")), ("/partners/0/start", behind)],
        "scenario.start-off-road",
        "partners[0].start.delta_s_m",
    );
    assert!(error.hint.starts_with("allowed: delta_s_m from -2.742 to "), "{error}");
    // The arm ahead runs from x = 60 + 30.5 to 170.5; the ego starts at 5; half a car must be on it too.
    for (delta, fits) in [(85.0, false), (86.0, true), (163.2, true), (163.3, false)] {
        let changes = [("/partners/0/approach", json!("opposite")), ("/partners/0/start", json!({"delta_s_m": delta}))];
        assert_eq!(check(with(&changes)).is_ok(), fits, "{delta}");
    }
}

#[test]
fn the_ring_has_half_a_circle_before_the_entry() {
    let slow = |gap: f64| {
        [
            ("/map", ring_map()),
            ("/ego/target_speed_mps", json!(6.0)),
            ("/partners/0/approach", json!("ring")),
            ("/partners/0/policy/target_speed_mps", json!(5.0)),
            ("/partners/0/start/arrival_gap_s", json!(gap)),
        ]
    };
    let scenario = accepted(&slow(0.0));
    let partner = &scenario.partners()[0];
    let conflict = partner.conflict.expect("they merge");
    assert!(conflict.merges);
    let ego_time = (conflict.s_a - 5.0) / 6.0;
    assert!(((conflict.s_b - partner.s_m) / 5.0 - ego_time).abs() < 1e-9);
    refused(&slow(5.0), "scenario.arrival-gap", "partners[0].start.arrival_gap_s");
}

#[test]
fn a_bus_on_the_ring_starts_with_all_of_its_corners_on_the_road() {
    let mut map = ring_map();
    map["lanes"] = json!(1);
    let scenario = accepted(&[
        ("/map", map),
        ("/ego/lane", json!(0)),
        ("/ego/target_speed_mps", json!(6.0)),
        ("/partners/0/lane_offset", json!(0)),
        ("/partners/0/approach", json!("ring")),
        ("/partners/0/kind", json!("bus")),
        ("/partners/0/policy/target_speed_mps", json!(5.0)),
        ("/partners/0/start/arrival_gap_s", json!(-4.0)),
    ]);
    let bus = &scenario.partners()[0];
    let spec = VehicleSpec::of(bus.kind);
    let corners = OrientedBox::new(bus.pose, spec.length_m, spec.width_m).corners();
    assert!(corners.into_iter().all(|corner| scenario.network().on_road(corner)), "{bus:?}");
    assert!(bus.t_m.abs() <= 1.0, "{}", bus.t_m);
}

#[test]
fn spawns_keep_half_a_metre_apart() {
    let start =
        |delta: f64| [("/partners/0/approach", json!("same")), ("/partners/0/start", json!({"delta_s_m": delta}))];
    // Box length 4.515 m.
    refused(&start(5.0), "scenario.spawn-overlap", "partners[0].start");
    accepted(&start(5.02));
    let error = refused(&start(0.0), "scenario.spawn-overlap", "partners[0].start");
    assert_eq!(error.message, "it starts on top of the ego");
    refused(
        &[("/obstacles/0", json!({"kind": "cone", "s_m": 6.0, "t_m": 0.5}))],
        "scenario.obstacle-on-spawn",
        "obstacles[0]",
    );
}

#[test]
fn speeds_are_bounded_by_the_way() {
    let ego = |turn: &str, speed: f64| {
        [("/ego/turn", json!(turn)), ("/ego/target_speed_mps", json!(speed)), ("/partners", json!([]))]
    };
    accepted(&ego("right", 10.0));
    refused(&ego("right", 10.1), "scenario.speed", "ego.target_speed_mps");
    accepted(&ego("left", 12.0));
    refused(&ego("left", 12.1), "scenario.speed", "ego.target_speed_mps");
    accepted(&ego("straight", 22.0));
    let map = json!({"type": "C", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "radius_m": 50.0,
                     "angle_deg": 90.0, "direction": "left", "length_m": 40.0});
    accepted(&[("/map", map.clone()), ("/ego/target_speed_mps", json!(17.0)), ("/partners", json!([]))]);
    refused(
        &[("/map", map), ("/ego/target_speed_mps", json!(17.1)), ("/partners", json!([]))],
        "scenario.speed",
        "ego.target_speed_mps",
    );
    refused(
        &[("/map", ring_map()), ("/ego/target_speed_mps", json!(8.5)), ("/partners", json!([]))],
        "scenario.speed",
        "ego.target_speed_mps",
    );
    refused(
        &[
            ("/partners/0/kind", json!("pedestrian")),
            ("/partners/0/speed_mps", json!(2.0)),
            ("/partners/0/start/arrival_gap_s", json!(0.0)),
        ],
        "scenario.speed",
        "partners[0].policy.target_speed_mps",
    );
}

#[test]
fn a_pedestrian_steps_out_beside_the_ego_s_lane() {
    let walking = |gap: f64| {
        [
            ("/partners/0/kind", json!("pedestrian")),
            ("/partners/0/speed_mps", json!(1.4)),
            ("/partners/0/policy/target_speed_mps", json!(1.4)),
            ("/partners/0/start/arrival_gap_s", json!(gap)),
        ]
    };
    // The ego needs 8.125 s; 1.4 m/s * 8.125 s is 11.375 m, well inside the junction.
    let scenario = accepted(&walking(0.0));
    let partner = &scenario.partners()[0];
    assert!((partner.conflict.expect("they cross").s_b - partner.s_m - 11.375).abs() < 1e-9);
    refused(&walking(-6.5), "scenario.arrival-gap", "partners[0].start.arrival_gap_s");
}

#[test]
fn stopped_things_stand() {
    let start = ("/partners/0/start", json!({"delta_s_m": 30.0}));
    let same = ("/partners/0/approach", json!("same"));
    let stopped = ("/partners/0/policy", json!({"type": "stopped"}));
    refused(&[start.clone(), same.clone(), stopped.clone()], "scenario.stopped-speed", "partners[0].speed_mps");
    let standing = ("/partners/0/speed_mps", json!(0.0));
    accepted(&[start.clone(), same.clone(), stopped.clone(), standing.clone()]);
    let object = ("/partners/0/kind", json!("fixed_object"));
    accepted(&[start.clone(), same.clone(), stopped, standing, object.clone()]);
    refused(&[start, same, object], "scenario.kind", "partners[0].policy");
}

#[test]
fn lateral_moves_come_one_after_the_other_and_stay_near() {
    let moves = |second: f64, to: f64| {
        [(
            "/partners/0/lateral",
            json!([{"start_s": 1.0, "duration_s": 2.0, "to_t_m": 0.5},
                   {"start_s": second, "duration_s": 2.0, "to_t_m": to}]),
        )]
    };
    accepted(&moves(3.0, -5.25));
    refused(&moves(2.9, 0.0), "scenario.lateral-order", "partners[0].lateral[1].start_s");
    refused(&moves(3.0, 5.3), "scenario.lateral-range", "partners[0].lateral[1].to_t_m");
    let warned = remarks(with(&moves(3.0, 3.0)));
    assert_eq!(warned.len(), 1);
    assert_eq!((warned[0].severity, warned[0].code.as_str()), (Severity::Warning, "scenario.leaves-road"));
}

#[test]
fn obstacles_leave_a_way_through() {
    let cones = |places: &[(f64, f64)]| {
        let cones: Vec<_> = places.iter().map(|(s, t)| json!({"kind": "cone", "s_m": s, "t_m": t})).collect();
        [("/obstacles", json!(cones))]
    };
    assert!(remarks(with(&cones(&[(40.0, 1.75)]))).is_empty());
    let warned = remarks(with(&cones(&[(40.0, 0.0)])));
    assert_eq!((warned[0].severity, warned[0].code.as_str()), (Severity::Warning, "scenario.lane-blocked"));
    // Two lanes: -5.25 to 1.75 from the ego's lane's centre.
    refused(&cones(&[(40.0, 0.0), (40.0, -3.5)]), "scenario.blocked", "obstacles[0]");
    refused(&cones(&[(40.0, 0.0), (42.0, -3.5)]), "scenario.blocked", "obstacles[0]");
    assert!(check(with(&cones(&[(30.0, 0.0), (45.0, -3.5)]))).is_ok());
    assert!(check(with(&cones(&[(40.0, 0.9), (40.0, -3.5)]))).is_ok(), "2.45 m of the ego's lane are free");
    refused(&cones(&[(500.0, 0.0)]), "scenario.obstacle-place", "obstacles[0].s_m");
}

#[test]
fn a_left_curve_keeps_room_for_its_oncoming_lanes() {
    let map = |radius: f64, direction: &str| {
        json!({"type": "C", "lanes": 4, "lane_width_m": 3.5, "approach_m": 60.0, "radius_m": radius,
               "angle_deg": 90.0, "direction": direction, "length_m": 40.0})
    };
    let only = |map: Value| [("/map", map), ("/partners", json!([]))];
    refused(&only(map(29.0, "left")), "scenario.curve-too-tight", "map.radius_m");
    accepted(&only(map(29.5, "left")));
    accepted(&only(map(15.0, "right")));
}

#[test]
fn all_problems_are_told_at_once() {
    let draft = with(&[
        ("/id", json!("a b")),
        ("/ego/target_speed_mps", json!(99.0)),
        ("/duration_s", json!(0.0)),
        ("/partners/0/speed_mps", json!(-3.0)),
        ("/obstacles/0/s_m", json!(-1.0)),
    ]);
    assert_eq!(remarks(draft).iter().filter(|each| each.is_error()).count(), 5);
}

#[test]
fn writing_and_reading_a_draft_gives_it_back() {
    let mut draft = with(&[("/partners/0/approach", json!("right"))]);
    assert_eq!(draft.partners[0].approach, Approach::Right);
    // A draft of the format before is read as one of this.
    assert_eq!(draft.format, SCENARIO_FORMAT_1);
    draft.format = SCENARIO_FORMAT.to_owned();
    let read = read_draft(&write_draft(&draft)).expect("it reads what it writes");
    assert_eq!(read.value, draft);
    assert_eq!(write_draft(&read.value), write_draft(&draft));
}

#[test]
fn too_many_road_users_are_told_once_and_not_compared_with_each_other() {
    let same = crossing()["partners"][0].clone();
    let many: Vec<Value> = (0..100)
        .map(|number| {
            let mut partner = same.clone();
            partner["id"] = json!(format!("cp{number}"));
            partner
        })
        .collect();
    refused(&[("/partners", json!(many))], "scenario.count", "partners");
    let cone = crossing()["obstacles"][0].clone();
    refused(&[("/obstacles", json!(vec![cone; 1000]))], "scenario.count", "obstacles");
}
