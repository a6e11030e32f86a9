//! What the command says when it is given something it cannot use: what, where and how to mend, and the exit code.

use crate::common::{MISSED, few, recrash};
use recrash_records::SAMPLE_CSV;
use std::path::{Path, PathBuf};

/// Wrong usage.
const USAGE: i32 = 2;
/// Input that cannot be used.
const BAD_INPUT: i32 = 3;
/// Files that cannot be read or written.
const FILES: i32 = 1;

struct Case {
    folder: tempfile::TempDir,
}

impl Case {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("suite")
    }

    /// Runs `recrash records FILE`, and gives its exit code and what it printed.
    fn records(&self, file: &Path) -> (i32, String) {
        self.run(&["records", file.to_str().unwrap(), "--out", self.out().to_str().unwrap()])
    }

    /// Runs `recrash simulate FILE`.
    fn simulate(&self, scenario: &str) -> (i32, String) {
        let file = self.file("scenario.json", scenario);
        self.run(&["simulate", file.to_str().unwrap()])
    }

    fn run(&self, arguments: &[&str]) -> (i32, String) {
        let output = recrash(arguments).output().unwrap();
        let shown = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(shown.lines().count() <= 60, "more than a screen:\n{shown}");
        assert!(!shown.contains("panicked"), "{shown}");
        (output.status.code().unwrap(), shown)
    }
}

fn assert_says(shown: &str, words: &[&str]) {
    for word in words {
        assert!(shown.contains(word), "does not say \"{word}\":\n{shown}");
    }
}

#[test]
fn no_such_crash_file() {
    let case = Case::new();
    let (code, shown) = case.records(Path::new("nowhere.csv"));
    assert_eq!(code, BAD_INPUT);
    assert_says(&shown, &["nowhere.csv", "check the path"]);
}

#[test]
fn an_empty_crash_file() {
    let case = Case::new();
    let (code, shown) = case.records(&case.file("empty.csv", ""));
    assert_eq!(code, BAD_INPUT);
    assert_says(&shown, &["empty.csv", "empty"]);
}

#[test]
fn a_crash_file_with_a_header_only() {
    let case = Case::new();
    let header = SAMPLE_CSV.lines().next().unwrap();
    let (code, shown) = case.records(&case.file("header.csv", header));
    assert_eq!(code, BAD_INPUT);
    assert_says(&shown, &["header.csv"]);
}

#[test]
fn a_file_that_is_no_csv() {
    let case = Case::new();
    let (code, shown) = case.records(&case.file("picture.csv", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0"));
    assert_eq!(code, BAD_INPUT);
    assert_says(&shown, &["picture.csv"]);
}

#[test]
fn a_crash_file_without_a_needed_column() {
    let case = Case::new();
    let text = SAMPLE_CSV.replacen("SV Pre-Crash Movement", "SV Movement", 1);
    let (code, shown) = case.records(&case.file("renamed.csv", text));
    assert_eq!(code, BAD_INPUT);
    assert_says(&shown, &["renamed.csv", "SV Pre-Crash Movement"]);
}

#[test]
fn rows_with_too_many_or_too_few_fields_are_named_and_the_rest_goes_on() {
    let case = Case::new();
    let few = std::fs::read_to_string(few()).unwrap();
    let text = format!("{}too,few,fields\n{}\n", ensure_line_end(&few), "x,".repeat(142));
    let (code, shown) = case.records(&case.file("ragged.csv", &text));
    assert_eq!(code, 0, "{shown}");
    let other = Case::new();
    let (_, clean) = other.records(&other.file("clean.csv", &few));
    let rows = rows_of(&clean);
    assert_eq!(rows_of(&shown), rows + 2);
    assert_says(&shown, &[&format!("row {}", rows + 1), &format!("row {}", rows + 2), "2 malformed row"]);
}

fn ensure_line_end(text: &str) -> String {
    format!("{}\n", text.trim_end_matches(['\r', '\n']))
}

/// Rows read, from the first step of the printed funnel.
fn rows_of(shown: &str) -> u64 {
    let after = shown.split("From rows to usable records").nth(1).unwrap();
    let numbers = after.split(|c: char| !c.is_ascii_digit()).filter(|word| !word.is_empty());
    numbers.map(|word| word.parse().unwrap()).next().unwrap()
}

const SCENARIO: &str = r#"{
  "format": "recrash.scenario/1", "id": "case",
  "map": {"type": "X", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 80.0},
  "ego": {"turn": "straight", "lane": 1, "s_m": 5.0, "speed_mps": 8.0, "target_speed_mps": 8.3},
  "source": {},
  "partners": [{"id": "cp1", "kind": "passenger_car", "approach": "left", "turn": "straight",
    "start": {"arrival_gap_s": -0.4}, "speed_mps": 8.0, "policy": {"type": "idm_nominal", "target_speed_mps": 8.0}}],
  "duration_s": 30.0
}"#;

#[test]
fn a_good_scenario_file_is_run_and_measured() {
    let (code, shown) = Case::new().simulate(SCENARIO);
    assert_eq!(code, 0, "{shown}");
    assert_says(&shown, &["metadrive-idm", "cp1", "min gap", "state hash"]);
}

#[test]
fn scenarios_that_cannot_be_run_name_the_place_and_what_is_allowed() {
    let cases: [(&str, &str, &str, &[&str]); 9] = [
        ("an unknown field", "\"lanes\": 2,", "\"lanes\": 2, \"colour\": 1,", &["map", "colour"]),
        (
            "a wrong type",
            "\"speed_mps\": 8.0, \"target",
            "\"speed_mps\": \"fast\", \"target",
            &["ego.speed_mps", "fast"],
        ),
        ("not a number", "\"duration_s\": 30.0", "\"duration_s\": NaN", &["line"]),
        ("an infinite number", "\"duration_s\": 30.0", "\"duration_s\": 1e999", &["line"]),
        ("a negative time", "\"duration_s\": 30.0", "\"duration_s\": -3.0", &["duration_s", "-3"]),
        ("an unknown map", "\"type\": \"X\"", "\"type\": \"Q\"", &["map", "Q", "S", "C", "T", "O"]),
        ("an unknown lane", "\"lane\": 1,", "\"lane\": 5,", &["ego.lane", "5"]),
        (
            "an absurd speed",
            "\"speed_mps\": 8.0, \"policy\"",
            "\"speed_mps\": 99.0, \"policy\"",
            &["partners[0].speed_mps", "99"],
        ),
        ("a missing field", "\"duration_s\": 30.0", "\"traffic\": {}", &["duration_s"]),
    ];
    for (what, from, to, words) in cases {
        assert!(SCENARIO.contains(from), "{what}: the case changes nothing");
        let (code, shown) = Case::new().simulate(&SCENARIO.replacen(from, to, 1));
        assert_eq!(code, BAD_INPUT, "{what}: {shown}");
        assert_says(&shown, words);
    }
}

#[test]
fn an_unreachable_turn_says_what_the_map_has() {
    let tee =
        r#"{"type": "T", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 80.0, "missing": "ahead"}"#;
    let cross = r#"{"type": "X", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 80.0}"#;
    assert!(SCENARIO.contains(cross));
    let (code, shown) = Case::new().simulate(&SCENARIO.replacen(cross, tee, 1));
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert_says(&shown, &["ego.turn", "straight", "left", "right"]);
}

#[test]
fn overlapping_spawns_name_both() {
    let from = r#""approach": "left", "turn": "straight",
    "start": {"arrival_gap_s": -0.4}"#;
    assert!(SCENARIO.contains(from));
    let to = r#""approach": "same", "turn": "straight", "start": {"delta_s_m": 2.0, "delta_t_m": 0.0}"#;
    let (code, shown) = Case::new().simulate(&SCENARIO.replacen(from, to, 1));
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert_says(&shown, &["partners[0].start", "ego"]);
}

#[test]
fn an_output_folder_that_cannot_be_written() {
    let case = Case::new();
    let file = case.file("a-file", "");
    let (code, shown) = case.run(&["run", "--out", file.join("suite").to_str().unwrap()]);
    assert_eq!(code, FILES, "{shown}");
    assert_says(&shown, &["cannot create", "a-file"]);
}

#[test]
fn an_output_folder_with_other_files_in_it_is_not_touched() {
    let case = Case::new();
    let precious = case.file("thesis.tex", "do not overwrite");
    let (code, shown) = case.run(&["run", "--out", case.folder.path().to_str().unwrap()]);
    assert_eq!(code, USAGE, "{shown}");
    assert_says(&shown, &["no suite.json", "--out"]);
    assert_eq!(std::fs::read_to_string(precious).unwrap(), "do not overwrite");
    assert_eq!(std::fs::read_dir(case.folder.path()).unwrap().count(), 1);
}

#[test]
fn a_stage_before_its_turn_names_the_one_that_is_missing() {
    let case = Case::new();
    let (code, shown) = case.run(&["design", "--out", case.out().to_str().unwrap()]);
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert_says(&shown, &["recrash run --out"]);
}

#[test]
fn unknown_names_list_the_known_ones() {
    let case = Case::new();
    let out = case.out();
    let out = out.to_str().unwrap();
    for (option, known) in
        [("--profile", "paper"), ("--ego", "metadrive-idm"), ("--searcher", "cma"), ("--strategy", "kmeans")]
    {
        let (code, shown) = case.run(&["run", "--out", out, option, "nonsense"]);
        assert!(code == BAD_INPUT || code == USAGE, "{option}: {shown}");
        assert_says(&shown, &["nonsense", known]);
    }
}

#[test]
fn a_damaged_suite_file_is_named() {
    let case = Case::new();
    let out = case.out();
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("suite.json"), "{\"format\": \"recr").unwrap();
    let (code, shown) = case.run(&["run", "--out", out.to_str().unwrap()]);
    assert_eq!(code, BAD_INPUT, "{shown}");
    // Without that file the folder would be refused as no suite: taking it away is no advice.
    assert_says(&shown, &["suite.json", "choose another folder"]);
}

/// A profile whose templates go beyond what the rules can stage.
fn wide_profile() -> String {
    let paper = include_str!("../../../../profiles/paper.toml");
    paper.replace("sv_movements = [", "sv_movements = [\"stopped\", ")
}

#[test]
fn a_scenario_nobody_can_design_is_named_and_the_others_are_run() {
    let case = Case::new();
    let profile = case.file("wide.toml", wide_profile());
    let (out, profile) = (case.out(), profile.to_str().unwrap().to_owned());
    let out = out.to_str().unwrap();
    let run = || {
        let (code, shown) = case.run(&["run", "--quiet", "--budget", "30", "--profile", &profile, "--out", out]);
        assert_eq!(code, MISSED, "{shown}");
        std::fs::read_to_string(case.out().join("summary.json")).unwrap()
    };
    let first = run();
    let summary: serde_json::Value = serde_json::from_str(&first).unwrap();
    let cases = summary["cases"].as_array().unwrap();
    let (failed, whole): (Vec<_>, Vec<_>) = cases.iter().partition(|case| !case["failure"].is_null());
    assert!(!failed.is_empty() && whole.len() >= 14, "{} failed, {} whole", failed.len(), whole.len());
    for case in failed {
        assert_eq!((&case["failure"]["stage"], &case["first"]), (&"narrate".into(), &serde_json::Value::Null));
        assert!(case["failure"]["why"].as_str().unwrap().starts_with("the rules cannot stage"), "{case}");
    }
    let results = std::fs::read_to_string(case.out().join("results.csv")).unwrap();
    assert_eq!(results.lines().filter(|line| line.contains(",not run,")).count(), cases.len() - whole.len());
    let junit = std::fs::read_to_string(case.out().join("junit.xml")).unwrap();
    assert!(junit.contains("the rules cannot stage"), "{junit}");
    assert_eq!(run(), first, "the second run tries again, and comes to the same");
}

#[test]
fn a_run_without_any_scenario_is_an_error() {
    let case = Case::new();
    let profile = case.file("wide.toml", wide_profile());
    let filter = ["--where", "sv_movement = stopped"];
    let (profile, out) = (profile.to_str().unwrap().to_owned(), case.out());
    let (code, shown) =
        case.run(&[&["run", "-q", "--profile", &profile, "--out", out.to_str().unwrap()], &filter[..]].concat());
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert_says(&shown, &["no scenario could be run", "the rules cannot stage"]);
}

#[test]
fn a_report_is_of_one_system_and_one_set_of_records() {
    let case = Case::new();
    let out = case.out();
    let out = out.to_str().unwrap();
    let with = |words: &[&str]| case.run(&[words, &["--quiet", "--out", out]].concat());
    assert_eq!(with(&["run", "--budget", "2", "--tune-budget", "4"]).0, 0);
    // Whether another ego is true to the record is not asked here.
    let is_done = |code: i32| code == 0 || code == MISSED;
    assert!(is_done(with(&["simulate", "--ego", "idm"]).0));
    let told = std::fs::read(case.out().join("results.csv")).unwrap();
    let (code, shown) = with(&["report"]);
    assert_eq!(code, USAGE, "the tuned runs are of another ego: {shown}");
    assert_says(&shown, &["\"design\"", "recrash design --out"]);
    assert_eq!(std::fs::read(case.out().join("results.csv")).unwrap(), told);
    for stage in ["design", "simulate", "tune", "report"] {
        let (code, shown) = with(&[stage]);
        assert!(is_done(code), "{stage}: {shown}");
    }
    let (code, shown) = with(&["report", "--records", case.file("other.csv", SAMPLE_CSV).to_str().unwrap()]);
    assert_eq!(code, USAGE, "the records are of another file: {shown}");
    assert_says(&shown, &["records of the built-in sample", "--replace"]);
}
