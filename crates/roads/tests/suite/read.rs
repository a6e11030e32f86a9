//! Scenario files: what is wrong is told with its path, its line and a hint.

use recrash_model::scenario::{Approach, MapSpec, ObstacleKind, Policy, Start, Turn};
use recrash_model::{Diagnostic, Severity};
use recrash_roads::{MAX_SCENARIO_BYTES, check, read_draft, scenario_schema};

const CROSSING: &str = include_str!("../drafts/crossing.json");

/// The errors of the crossing with one piece of its text replaced.
#[track_caller]
fn errors(from: &str, to: &str) -> Vec<Diagnostic> {
    assert!(CROSSING.contains(from), "{from}");
    read_draft(&CROSSING.replacen(from, to, 1)).expect_err("it is refused")
}

/// Code, path, line, message and hint of the only error.
#[track_caller]
fn only(from: &str, to: &str) -> (String, String, u64, String, String) {
    let found = errors(from, to);
    let [error] = found.as_slice() else { panic!("not one error but {found:#?}") };
    (
        error.code.clone(),
        error.location.path.clone().unwrap_or_default(),
        error.location.line.unwrap_or_default(),
        error.message.clone(),
        error.hint.clone(),
    )
}

#[test]
fn the_crossing_reads_and_passes_the_check() {
    let read = read_draft(CROSSING).expect("it reads");
    assert!(read.diagnostics.is_empty());
    assert!(check(read.value).is_ok());
    let with_mark = format!("\u{feff}{CROSSING}");
    assert!(read_draft(&with_mark).is_ok(), "a byte order mark is no error");
}

#[test]
fn an_unknown_field_names_the_one_that_was_probably_meant() {
    let (code, path, line, _, hint) =
        only("\"speed_mps\": 8.0, \"target_speed_mps\"", "\"speed_mps\": 8.0, \"target_sped_mps\"");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.unknown-field", "ego.target_sped_mps", 6));
    assert!(hint.starts_with("did you mean `target_speed_mps`?"), "{hint}");
    let (code, path, line, ..) = only("\"arm_m\"", "\"arms\"");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.unknown-field", "map.arms", 5));
    let (code, path, ..) = only("\"duration_s\": 40.0", "\"duration_s\": 40.0, \"weather\": \"rain\"");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.unknown-field", "weather"));
    let (code, path, line, ..) = only("\"type\": \"idm_nominal\"", "\"type\": \"idm_nominal\", \"brake\": 1");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.unknown-field", "partners[0].policy.brake", 16));
}

#[test]
fn a_field_of_another_type_of_map_names_that_type() {
    let (_, path, _, _, hint) = only("\"arm_m\"", "\"roads\"");
    assert_eq!(path, "map.roads");
    assert!(hint.starts_with("a map of type G has that field, and this one is of type X"), "{hint}");
}

#[test]
fn an_object_with_one_key_names_the_keys() {
    let text = r#"{"format": "recrash.scenario/2", "id": "a", "map": {"type": "G", "roads": [{"id": "main",
        "start": {"x_m": 0.0, "y_m": 0.0}, "line": [{"straight": {"length_m": 9.0}}], "right": []}]}}"#;
    let told = read_draft(text).expect_err("no start");
    let start = told.iter().find(|told| told.location.path.as_deref() == Some("map.roads[0].start")).expect("told");
    assert!(start.message.ends_with("one of at, after, arm, into_lane, from_lane"), "{start:?}");
}

#[test]
fn a_wrong_type_is_told_with_its_path_and_line() {
    let (code, path, line, message, hint) = only("\"speed_mps\": 9.0", "\"speed_mps\": \"fast\"");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.type", "partners[0].speed_mps", 15));
    assert!(message.contains("\"fast\""), "{message}");
    assert_eq!(hint, "write a number, without quotes");
    let (code, path, ..) = only("\"target_speed_mps\": 10.0", "\"target_speed_mps\": []");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.type", "partners[0].policy.target_speed_mps"));
    let (code, path, ..) = only("\"lane\": 1", "\"lane\": 1.5");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.type", "ego.lane"));
    let (code, path, ..) = only("\"lane\": 1", "\"lane\": -1");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.type", "ego.lane"));
    let (code, path, ..) = only("[{\"kind\": \"cone\", \"s_m\": 40.0, \"t_m\": -1.75}]", "{}");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.type", "obstacles"));
    let (code, path, line, ..) = only("{\"arrival_gap_s\": 0.5}", "{\"arrival_gap_s\": 0.5, \"delta_s_m\": 1}");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.type", "partners[0].start", 14));
}

#[test]
fn a_missing_field_is_told() {
    let (code, path, _, message, _) = only("\"duration_s\": 40.0", "\"traffic\": {}");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.missing-field", "duration_s"));
    assert_eq!(message, "missing field `duration_s`");
    let (code, path, ..) = only("\"approach_m\": 60.0, ", "");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.missing-field", "map"));
    let (code, path, ..) = only(", \"target_speed_mps\": 10.0", "");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.missing-field", "partners[0].policy"));
}

#[test]
fn numbers_that_json_does_not_have_are_told() {
    for literal in ["NaN", "-NaN", "Infinity", "-Infinity"] {
        let (code, _, line, _, hint) = only("\"speed_mps\": 9.0", &format!("\"speed_mps\": {literal}"));
        assert_eq!((code.as_str(), line), ("scenario.syntax", 15), "{literal}");
        assert!(hint.contains("finite number"), "{literal}: {hint}");
    }
    let (code, _, line, _, hint) = only("\"speed_mps\": 9.0", "\"speed_mps\": 1e999");
    assert_eq!((code.as_str(), line), ("scenario.syntax", 15));
    assert!(hint.contains("finite number"), "{hint}");
}

#[test]
fn a_map_type_that_does_not_exist_is_told_with_those_that_do() {
    let (code, path, line, _, hint) = only("\"type\": \"X\"", "\"type\": \"Y\"");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.unknown-value", "map.type", 5));
    for letter in ["S (", "C (", "X (", "T (", "O ("] {
        assert!(hint.contains(letter), "{hint}");
    }
    let (code, path, _, _, hint) = only("idm_nominal", "idm");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.unknown-value", "partners[0].policy.type"));
    assert!(hint.contains("accel_then_brake"), "{hint}");
    let (code, path, ..) = only("\"approach\": \"left\"", "\"approach\": \"above\"");
    assert_eq!((code.as_str(), path.as_str()), ("scenario.unknown-value", "partners[0].approach"));
}

#[test]
fn several_problems_are_told_at_once() {
    let text = CROSSING
        .replace("\"type\": \"X\"", "\"type\": \"Y\"")
        .replace("\"t_m\": -1.75", "\"t_m\": \"left\"")
        .replace("\"lane_offset\": 0", "\"lane_offset\": \"0\"")
        .replace("idm_nominal", "idm");
    let codes: Vec<_> = read_draft(&text).expect_err("refused").into_iter().map(|each| each.code).collect();
    assert_eq!(codes, ["scenario.unknown-value", "scenario.unknown-value", "scenario.type", "scenario.type"]);
}

#[test]
fn files_that_are_no_scenarios_are_told_in_one_error() {
    for text in ["", " ", "{", "[1, 2]", "null", "3", "\"text\"", "{\"a\": }", "{}x", "\u{0}", "{\"a\": \"\\ud800\"}"] {
        let found = read_draft(text).expect_err("refused");
        assert!(!found.is_empty() && found[0].is_error(), "{text:?}");
    }
    assert_eq!(read_draft(&"[".repeat(100_000)).expect_err("too deep")[0].code, "scenario.syntax");
    assert_eq!(read_draft(&" ".repeat(MAX_SCENARIO_BYTES + 1)).expect_err("too long")[0].code, "scenario.too-large");
    let missing = read_draft("{}").expect_err("refused");
    assert_eq!(missing.len(), 6);
    let (code, path, line, ..) = only("recrash.scenario/1", "recrash.scenario/9");
    assert_eq!((code.as_str(), path.as_str(), line), ("scenario.format", "format", 2));
}

#[test]
fn the_schema_describes_the_crossing_s_fields() {
    let schema = scenario_schema();
    let read: serde_json::Value = serde_json::from_str(CROSSING).expect("valid JSON");
    for name in read.as_object().expect("an object").keys() {
        assert!(schema["properties"][name].is_object(), "{name}");
    }
}

#[test]
fn the_paper_s_dialect_is_converted_with_a_note() {
    let text = r#"{
        "map_type": "I", "ego_turn": "left", "lead_turn": "straight", "target_speed": 8.0, "traffic_density": 0.1,
        "cps": [
            {"id": "cp1", "direction": "opposite", "lane_offset": -1, "delta_s_m": 90, "delta_t_m": 0.2,
             "policy": "accel_then_brake",
             "params": {"accel_mag": 0.5, "accel_steps": 20, "cruise_speed": 9.0, "brake_step": 60.0, "brake_steps": 10}},
            {"direction": "same", "lane_offset": 1, "delta_s_m": -20.0, "policy":
             {"type": "idm_nominal", "params": {"target_speed_mps": 7.0}}}
        ],
        "cones": [{"delta_s_m": 20, "delta_t_m": 1.75}]
    }"#;
    let read = read_draft(text).expect("it reads");
    let [note] = read.diagnostics.as_slice() else { panic!("{:#?}", read.diagnostics) };
    assert_eq!((note.severity, note.code.as_str()), (Severity::Note, "scenario.paper-dialect"));
    let draft = read.value;
    assert!(matches!(draft.map, MapSpec::X(_)));
    assert_eq!((draft.ego.turn, draft.ego.lane, draft.ego.target_speed_mps), (Turn::Left, 1, 8.0));
    assert_eq!(draft.ego.s_m, 25.0, "room for the partner 20 m behind");
    assert_eq!(draft.traffic.density, 0.1);
    let [first, second] = draft.partners.as_slice() else { panic!("{:?}", draft.partners) };
    assert_eq!((first.approach, first.turn, first.lane_offset), (Approach::Opposite, Turn::Straight, -1));
    assert_eq!(first.start, Start::Offset { delta_s_m: 90.0, delta_t_m: 0.2 });
    assert!(matches!(first.policy, Policy::AccelThenBrake { brake_step: 60, brake_steps: 10, .. }));
    assert_eq!((second.id.as_str(), second.approach, second.speed_mps), ("cp2", Approach::Same, 7.0));
    assert_eq!((draft.obstacles[0].kind, draft.obstacles[0].s_m), (ObstacleKind::Cone, 45.0));
    let scenario = check(draft).unwrap_or_else(|errors| panic!("{errors:#?}")).value;
    assert!((scenario.partners()[0].pose.position.x - 115.0).abs() < 1e-9);
}

#[test]
fn one_partner_may_stand_flat_in_the_paper_s_dialect() {
    let text = r#"{"map": "S", "direction": "same", "lane_offset": 0, "delta_s_m": 15, "policy": "sudden_brake",
                   "params": {"target_speed": 8, "brake_step": 30, "brake_steps": 20}, "colour": "red"}"#;
    let read = read_draft(text).expect("it reads");
    assert_eq!(read.value.partners.len(), 1);
    let warned: Vec<_> = read.diagnostics.iter().filter(|each| each.severity == Severity::Warning).collect();
    assert_eq!(warned.len(), 1);
    assert_eq!(warned[0].location.path.as_deref(), Some("colour"));
    assert!(check(read.value).is_ok());
}

#[test]
fn every_map_letter_of_the_paper_gives_a_draft_that_passes() {
    for letter in ["X", "I", "T", "O", "C", "S"] {
        let text = format!(
            r#"{{"map": "{letter}", "ego_turn": "straight", "direction": "same", "delta_s_m": 20,
                "target_speed": 8.0, "policy": "idm_nominal", "params": {{"target_speed_mps": 6}}}}"#
        );
        let read = read_draft(&text).expect("it reads");
        assert!(check(read.value).is_ok(), "{letter}");
    }
}

#[test]
fn mistakes_in_the_paper_s_dialect_are_told() {
    let cases = [
        (r#"{"map": "Q", "ego_turn": "left"}"#, "scenario.unknown-value", "map"),
        (r#"{"map": "X", "ego_turn": "around"}"#, "scenario.unknown-value", "ego_turn"),
        (r#"{"map": "X", "direction": "up", "policy": "idm_nominal"}"#, "scenario.unknown-value", "direction"),
        (r#"{"map": "X", "direction": "same", "policy": "fly"}"#, "scenario.unknown-value", "policy.type"),
        (r#"{"map": "X", "direction": "same", "policy": "idm_nominal"}"#, "scenario.missing-field", "policy"),
        (r#"{"map": "X", "direction": "same"}"#, "scenario.missing-field", ""),
        (r#"{"map": "X", "cps": [3]}"#, "scenario.type", "cps[0]"),
        (r#"{"map": "X", "cps": {}}"#, "scenario.type", "cps"),
        (r#"{"map": "X", "cones": [{}]}"#, "scenario.missing-field", "cones[0]"),
        (r#"{"map": "X", "traffic_density": "high"}"#, "scenario.type", "traffic_density"),
        (r#"{"map": "X", "direction": "same", "lane_offset": 0.5}"#, "scenario.type", "lane_offset"),
    ];
    for (text, code, path) in cases {
        let found = read_draft(text).expect_err(text);
        assert_eq!(
            (found[0].code.as_str(), found[0].location.path.as_deref()),
            (code, Some(path)),
            "{text}: {found:?}"
        );
    }
}
