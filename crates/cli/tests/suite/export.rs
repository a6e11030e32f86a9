//! Exports and imports as a user meets them: folders, exit codes, and the way there and back.

use crate::common::{FEW, MISSED, Place, recrash};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Wrong usage.
const USAGE: i32 = 2;
/// Input that cannot be used.
const BAD_INPUT: i32 = 3;

const FOUR: [&str; 10] = ["run", "--quiet", "--records", FEW, "--budget", "4", "--tune-budget", "12", "--seed", "5"];

/// A scenario in the paper's own dialect.
const DIALECT: &str = r#"{"id": "dialect", "map_type": "X", "ego_turn": "straight", "lead_turn": "straight",
  "partners": [{"direction": "same", "delta_s_m": 20.0, "delta_t_m": 0.0, "policy": "sudden_brake",
    "params": {"target_speed": 6.0, "brake_step": 30, "brake_steps": 20}}]}"#;

/// A small suite, and a folder for what is made of it.
struct Case {
    place: Place,
}

impl Case {
    fn with_suite() -> Self {
        Self { place: Place::made(&FOUR) }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.place.path(name)
    }

    /// The tuned scenarios, by id.
    fn scenarios(&self) -> Vec<(String, PathBuf)> {
        let names = names_in(&self.path("suite/6-tuned"));
        let ids = names.iter().filter_map(|name| name.strip_suffix(".search.json"));
        ids.map(|id| (id.to_owned(), self.path(&format!("suite/6-tuned/{id}.json")))).collect()
    }

    /// Runs the command in this folder; gives its exit code and what it printed.
    fn run(&self, arguments: &[&str]) -> (i32, String) {
        let output = recrash(arguments).current_dir(self.place.folder()).output().unwrap();
        let shown = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(!shown.contains("panicked"), "{shown}");
        (output.status.code().unwrap(), shown)
    }

    fn json(&self, arguments: &[&str]) -> Value {
        let output = recrash(arguments).arg("--json").current_dir(self.place.folder()).output().unwrap();
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{arguments:?}: {error}: {output:?}"))
    }
}

fn names_in(folder: &Path) -> BTreeSet<String> {
    std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn every_scenario_of_a_suite_comes_back_with_the_state_hash_it_had() {
    let case = Case::with_suite();
    for (how, target) in [("actions", "acting"), ("trajectory", "recorded")] {
        let (code, shown) = case.run(&["export", "suite", "--to", "openscenario", "--as", how, "--to-dir", target]);
        assert_eq!(code, 0, "{shown}");
        for (id, _) in case.scenarios() {
            let source = format!("{target}/openscenario/{id}.xosc");
            let text = std::fs::read_to_string(case.path(&source)).unwrap();
            assert_eq!(text.contains("<FollowTrajectoryAction>"), how == "trajectory", "{source}");
            let copy = format!("{target}-{id}.json");
            let imported = case.json(&["import", &source, "--out", &copy, "--simulate"]);
            let run: Value =
                serde_json::from_slice(&std::fs::read(case.path(&format!("suite/7-tuned-runs/{id}.json"))).unwrap())
                    .unwrap();
            assert_eq!(imported["run"]["rollout"]["state_hash"], run["rollout"]["state_hash"], "{source}");
            let again = case.json(&["simulate", &copy]);
            assert_eq!(again["rollout"]["state_hash"], run["rollout"]["state_hash"], "{copy}");
            let remarks = imported["imported"]["diagnostics"].as_array().unwrap();
            let edits = remarks.iter().filter(|remark| remark["code"].as_str().unwrap().starts_with("openscenario"));
            assert_eq!(edits.collect::<Vec<_>>(), Vec::<&Value>::new(), "{source}");
        }
    }
    let (code, shown) = case.run(&["export", "suite", "--to", "openscenario", "--designed", "--to-dir", "before"]);
    assert_eq!(code, 0, "{shown}");
    for (id, _) in case.scenarios() {
        let imported = case.json(&[
            "import",
            &format!("before/openscenario/{id}.xosc"),
            "--out",
            &format!("{id}.json"),
            "--simulate",
        ]);
        let designed = case.json(&["simulate", &format!("suite/4-scenarios/{id}.json")]);
        assert_eq!(imported["run"]["rollout"]["state_hash"], designed["rollout"]["state_hash"], "{id}");
    }
}

#[test]
fn a_close_call_is_what_the_suite_s_profile_calls_one() {
    let case = Case { place: Place::new() };
    let profile = include_str!("../../../../profiles/paper.toml").replace("min_gap_m = 2.0", "min_gap_m = 0.625");
    std::fs::write(case.path("mine.toml"), profile).unwrap();
    let run = ["run", "--quiet", "--profile", "mine.toml", "--records", FEW, "--budget", "1", "--tune-budget", "1"];
    let (code, shown) = case.run(&run);
    assert_eq!(code, 0, "{shown}");
    std::fs::write(case.path("dialect.json"), DIALECT).unwrap();
    for (source, wanted) in [("suite", "value=\"0.625\""), ("dialect.json", "value=\"0.3\"")] {
        let (code, shown) = case.run(&["export", source, "--to", "openscenario", "--to-dir", "out", "--force"]);
        assert_eq!(code, 0, "{shown}");
        let names = names_in(&case.path("out/openscenario"));
        let scenario = |name: &String| name.strip_suffix(".xosc").is_some_and(|stem| !stem.contains('.'));
        let file = names.into_iter().find(scenario).unwrap();
        let text = std::fs::read_to_string(case.path("out/openscenario").join(&file)).unwrap();
        let conditions = text.split("<RelativeDistanceCondition").skip(1);
        let gaps: Vec<&str> = conditions.filter_map(|rest| rest.split('>').next()).collect();
        assert!(!gaps.is_empty() && gaps.iter().all(|gap| gap.contains(wanted)), "{source}: {gaps:?}");
        // Another profile's gap is no edit of the file.
        let imported = case.json(&["import", &format!("out/openscenario/{file}"), "--out", "copy.json", "--force"]);
        let remarks = imported["imported"]["diagnostics"].as_array().unwrap();
        assert!(remarks.iter().all(|remark| remark["code"] != "openscenario.edited"), "{source}: {remarks:?}");
        std::fs::remove_dir_all(case.path("out")).unwrap();
    }
}

#[test]
fn a_damaged_scenario_is_named_and_the_rest_is_exported() {
    let case = Case::with_suite();
    let scenarios = case.scenarios();
    let (damaged, file) = &scenarios[0];
    std::fs::write(file, "{ damaged").unwrap();
    let (code, shown) = case.run(&["export", "suite", "--to", "metadrive,commonroad"]);
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert!(shown.contains("1 scenario was not exported; the other 3 were"), "{shown}");
    assert!(shown.contains(&format!("{damaged}.json")) && shown.contains("line 1"), "{shown}");
    let written = names_in(&case.path("suite/exports/commonroad"));
    let rest: BTreeSet<String> = scenarios[1..].iter().map(|(id, _)| format!("{id}.cr.xml")).collect();
    assert_eq!(written, rest);

    let one = file.to_str().unwrap();
    let (code, shown) = case.run(&["export", one, "--to", "scenic", "--to-dir", "one"]);
    assert_eq!(code, BAD_INPUT);
    assert!(shown.contains("the scenario was not exported") && !shown.contains("other"), "{shown}");
}

#[test]
fn an_unknown_format_and_a_folder_that_is_no_suite_are_refused() {
    let case = Case { place: Place::new() };
    let (code, shown) = case.run(&["export", "suite", "--to", "opendrive"]);
    assert_eq!(code, USAGE);
    assert!(
        shown.contains("opendrive") && shown.contains("openscenario, scenic, metadrive, commonroad, scenarionet"),
        "{shown}"
    );
    std::fs::create_dir(case.path("empty")).unwrap();
    let (code, shown) = case.run(&["export", "empty", "--to", "scenic"]);
    assert_eq!(code, BAD_INPUT);
    assert!(shown.contains("empty") && shown.contains("suite.json"), "{shown}");
    // Settings of somebody's are no scenario.
    std::fs::write(case.path("empty/settings.json"), "{}").unwrap();
    assert_eq!(case.run(&["export", "empty", "--to", "scenic"]).0, BAD_INPUT);
}

#[test]
fn a_file_with_other_content_is_left_alone_and_files_of_other_names_are_no_hindrance() {
    let case = Case { place: Place::new() };
    std::fs::write(case.path("dialect.json"), DIALECT).unwrap();
    std::fs::create_dir_all(case.path("exports/scenic")).unwrap();
    std::fs::write(case.path("exports/scenic/dialect.scenic"), "mine").unwrap();
    let export = ["export", "dialect.json", "--to", "commonroad,scenic"];
    let (code, shown) = case.run(&export);
    assert_eq!(code, BAD_INPUT);
    assert!(shown.contains("scenic") && shown.contains("--force") && shown.contains("--to-dir"), "{shown}");
    assert_eq!(std::fs::read_to_string(case.path("exports/scenic/dialect.scenic")).unwrap(), "mine");
    assert!(!case.path("exports/commonroad").exists(), "nothing is written before the question is settled");
    let (code, shown) = case.run(&[&export[..], &["--force"]].concat());
    assert_eq!(code, 0, "{shown}");
    assert_ne!(std::fs::read_to_string(case.path("exports/scenic/dialect.scenic")).unwrap(), "mine");
    // A second scenario goes into the same folder.
    std::fs::write(case.path("second.json"), DIALECT.replace("\"dialect\"", "\"second\"")).unwrap();
    for _ in 0..2 {
        let (code, shown) = case.run(&["export", "second.json", "--to", "commonroad,scenic"]);
        assert_eq!(code, 0, "{shown}");
    }
    assert!(case.path("exports/scenic/dialect.scenic").exists() && case.path("exports/scenic/second.scenic").exists());
}

#[test]
fn a_format_that_cannot_hold_a_scenario_withholds_no_other() {
    let case = Case { place: Place::new() };
    let (code, shown) = case.run(&["reconstruct", FEW, "--to-dir", "scenes"]);
    assert_eq!(code, 0, "{shown}");
    let mut scenarios = names_in(&case.path("scenes"));
    scenarios.retain(|name| name.ends_with(".json"));
    // A folder of scenario files is exported as it is.
    let (code, shown) = case.run(&["export", "scenes", "--to", "openscenario,metadrive", "--to-dir", "out"]);
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert!(
        shown.contains("not exported to metadrive: ") && !shown.contains("not exported to openscenario"),
        "{shown}"
    );
    assert!(shown.contains(" not exported in every format; everything else was written"), "{shown}");
    let written = names_in(&case.path("out/openscenario"));
    for name in &scenarios {
        assert!(written.contains(&name.replace(".json", ".xosc")), "{name}: {written:?}");
    }
    let report = case.json(&["export", "scenes", "--to", "openscenario,metadrive", "--to-dir", "out"]);
    assert_eq!(report["scenarios"].as_u64(), Some(scenarios.len() as u64), "{report}");
    assert_eq!(report["partial"].as_u64(), report["failures"].as_array().map(|all| all.len() as u64), "{report}");
}

/// An ego whose runs are in the suite is not started again for an export.
#[test]
fn an_export_takes_the_runs_of_the_suite() {
    let case = Case { place: Place::new() };
    let count = "import pathlib, sys\npathlib.Path('started').open('a').write('x')\n";
    std::fs::write(case.path("ego.py"), count.to_owned() + &crate::common::driving_ego(6.0)).unwrap();
    let started = || std::fs::read_to_string(case.path("started")).map_or(0, |text| text.len());
    let run = ["run", "--quiet", "--records", FEW, "--budget", "2", "--tune-budget", "1", "--threads", "1"];
    let (code, shown) = case.run(&[&run[..], &["--ego", "cmd:python3 ego.py"]].concat());
    assert!([0, MISSED].contains(&code) && started() == 1, "one process for all stages: {shown}");
    let (code, shown) = case.run(&["export", "suite", "--to", "openscenario", "--as", "trajectory"]);
    assert_eq!((code, started()), (0, 1), "{shown}");
    // A changed ego is another one: it drives again, once for all scenarios, where it is trusted.
    std::fs::write(case.path("ego.py"), count.to_owned() + &crate::common::driving_ego(5.0)).unwrap();
    let export = ["export", "suite", "--to", "openscenario", "--as", "trajectory", "--to-dir", "other"];
    let (code, shown) = case.run(&export);
    assert!(code != 0 && shown.contains("--trust") && started() == 1, "{shown}");
    let (code, shown) = case.run(&[&export[..], &["--trust"]].concat());
    assert_eq!((code, started()), (0, 2), "{shown}");
}

#[test]
fn an_interrupted_export_goes_on() {
    let case = Case::with_suite();
    let export = ["export", "suite", "--to", "openscenario,scenic,metadrive"];
    assert_eq!(case.run(&export).0, 0);
    let files = |format: &str| names_in(&case.path(&format!("suite/exports/{format}")));
    let whole: Vec<_> = ["openscenario", "scenic", "metadrive"].map(files).into();
    // As it would be after an interruption: some files of one folder, none of another.
    std::fs::remove_dir_all(case.path("suite/exports/metadrive")).unwrap();
    for name in files("scenic").iter().take(2) {
        std::fs::remove_file(case.path("suite/exports/scenic").join(name)).unwrap();
    }
    let (code, shown) = case.run(&export);
    assert_eq!(code, 0, "{shown}");
    assert_eq!(["openscenario", "scenic", "metadrive"].map(files).to_vec(), whole);
    let edited = case.path("suite/exports/scenic").join(files("scenic").first().unwrap());
    std::fs::write(&edited, "mine").unwrap();
    let (code, shown) = case.run(&export);
    assert_eq!(code, BAD_INPUT, "{shown}");
    assert!(
        shown.contains("scenic is there already, and holds something else") && shown.contains("--force"),
        "{shown}"
    );
    assert_eq!(std::fs::read_to_string(&edited).unwrap(), "mine");
}

#[test]
fn the_papers_dialect_is_imported_and_run() {
    let case = Case { place: Place::new() };
    std::fs::write(case.path("theirs.json"), DIALECT).unwrap();
    let (code, shown) = case.run(&["import", "theirs.json", "--simulate"]);
    assert_eq!(code, 0, "{shown}");
    assert!(shown.contains("dialect.json") && shown.contains("state hash"), "{shown}");
    let written: Value = serde_json::from_slice(&std::fs::read(case.path("dialect.json")).unwrap()).unwrap();
    assert_eq!(written["format"], "recrash.scenario/2");
    assert_eq!(written["partners"][0]["policy"]["brake_step"], 30);

    let (code, shown) = case.run(&["import", "theirs.json"]);
    assert_eq!(code, BAD_INPUT);
    assert!(shown.contains("dialect.json") && shown.contains("--force") && shown.contains("--out"), "{shown}");
    let (code, shown) = case.run(&["import", "theirs.json", "--out", "new.json"]);
    assert_eq!(code, 0, "{shown}");
    assert!(shown.contains("recrash simulate new.json"), "{shown}");
}

#[test]
fn what_cannot_be_imported_says_where_and_why() {
    let case = Case { place: Place::new() };
    let cases: [(&str, &[u8], &[&str]); 6] = [
        ("cut.xosc", b"<?xml version=\"1.0\"?>\n<OpenSCENARIO>\n  <FileHeader", &["line 3"]),
        (
            "other.xosc",
            b"<OpenSCENARIO>\n<FileHeader revMajor=\"1\"/></OpenSCENARIO>",
            &["line 2", "FileHeader", "recrash"],
        ),
        ("map.xosc", b"<OpenDRIVE/>", &["line 1", "<OpenDRIVE>", "<OpenSCENARIO>"]),
        ("bytes.xosc", b"\xff\xfe\x00", &["not a text file"]),
        ("empty.json", b"", &["line 1", "is the file complete"]),
        ("dialect.json", b"{\"map_type\": \"Q\"}", &["map", "\"Q\""]),
    ];
    for (name, content, words) in cases {
        std::fs::write(case.path(name), content).unwrap();
        let (code, shown) = case.run(&["import", name, "--out", "never.json"]);
        assert_eq!(code, BAD_INPUT, "{name}: {shown}");
        assert!(shown.contains(name) && words.iter().all(|word| shown.contains(word)), "{name} {words:?}: {shown}");
    }
    let (code, shown) = case.run(&["import", "nowhere.xosc"]);
    assert_eq!(code, BAD_INPUT);
    assert!(shown.contains("nowhere.xosc") && shown.contains("check the path"), "{shown}");
    assert!(!case.path("never.json").exists());
}
