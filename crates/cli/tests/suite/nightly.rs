//! Frozen suites, their results and comparisons, as a test engineer meets them each night.

use crate::common::{FEW, MISSED, Place, SMALL, TOLD};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn cases(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(folder)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// A place with the hand-made crashes frozen in it.
fn frozen() -> Place {
    Place::made(&["freeze", text(&cases("crashes")), "--out", "frozen", "--quiet"])
}

/// A place with the first five of them, for what is not about what they tell.
fn five_frozen() -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("five")).unwrap();
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(cases("crashes")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for file in &files[..5] {
        std::fs::copy(file, place.path("five").join(file.file_name().unwrap())).unwrap();
    }
    let (code, _, errors) = place.run(&["freeze", "five", "--out", "frozen", "--quiet"]);
    assert_eq!(code, 0, "{errors}");
    place
}

fn test(place: &Place, extra: &[&str]) -> (i32, String, String) {
    place.run(&[&["test", "frozen"], extra].concat())
}

/// The example ego of the documentation, changed.
fn ego(place: &Place, name: &str, change: (&str, &str)) -> String {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples/ego.py");
    let program = std::fs::read_to_string(example).unwrap();
    let changed = program.replace(change.0, change.1);
    assert!(change.0 == change.1 || changed != program, "{name} is the example");
    std::fs::write(place.path(name), changed).unwrap();
    format!("cmd:python3 {name}")
}

const LOOKS: &str = "for other in step[\"actors\"] + world[\"obstacles\"]:\n";
const BLIND: &str = "feet = {each[\"id\"] for each in world[\"actors\"] if each[\"kind\"] in (\"pedestrian\", \"other_non_motorist\")}\n    \
                     for other in [each for each in step[\"actors\"] if each[\"id\"] not in feet] + world[\"obstacles\"]:\n";

#[test]
fn a_frozen_suite_runs_without_what_it_was_made_of_and_gives_the_same_bytes() {
    let place = Place::made(&SMALL);
    let (code, shown, errors) = place.run(&["freeze", "suite", "--out", "frozen"]);
    assert_eq!(code, 0, "{errors}");
    assert!(shown.contains("2 tests in frozen"), "{shown}");
    std::fs::remove_dir_all(place.path("suite")).unwrap();
    for (out, threads) in [("one.json", "1"), ("two.json", "2"), ("three.json", "8")] {
        let (code, _, errors) = test(&place, &["--out", out, "--threads", threads]);
        assert_eq!(code, 0, "{errors}");
    }
    let one = std::fs::read(place.path("one.json")).unwrap();
    assert!(["two.json", "three.json"].iter().all(|other| std::fs::read(place.path(other)).unwrap() == one));
    let results = json(&place.path("one.json"));
    let tests = results["tests"].as_array().unwrap();
    assert_eq!((tests.len(), &results["format"]), (2, &Value::from("recrash.results/1")));
    for test in tests {
        let outcome = &test["runs"][0]["outcome"];
        assert!(outcome["faithful"].is_string() && outcome["state_hash"].is_string(), "{test}");
        assert!(["own", "other", "invented"].contains(&test["about"]["provenance"].as_str().unwrap()), "{test}");
    }
}

#[test]
fn no_word_of_a_narrative_is_frozen_unless_it_is_asked_for() {
    let place = frozen();
    let with = place.run(&["freeze", text(&cases("crashes")), "--out", "told", "--with-narratives", "--quiet"]);
    assert_eq!(with.0, 0, "{}", with.2);
    let narratives = |folder: &str| -> Vec<String> {
        let files = std::fs::read_dir(place.path(folder).join("scenarios")).unwrap();
        files.map(|file| json(&file.unwrap().path())["source"]["narrative"].as_str().unwrap().to_owned()).collect()
    };
    assert!(narratives("frozen").iter().all(String::is_empty));
    assert!(narratives("told").iter().all(|text| !text.is_empty()));
    let content = |folder: &str| json(&place.path(folder).join("frozen.json"))["content"].clone();
    assert_eq!(content("frozen"), content("told"), "what is run is the same");
}

#[test]
fn accounts_go_along_without_the_words_and_say_whether_the_situation_was_met() {
    let place = Place::made(&TOLD);
    let freeze = |out: &str, extra: &[&str]| {
        let (code, _, errors) = place.run(&[&["freeze", "suite", "--out", out, "--quiet"], extra].concat());
        assert_eq!(code, 0, "{errors}");
    };
    freeze("frozen", &[]);
    freeze("told", &["--with-narratives"]);
    let accounts = |folder: &str| -> Vec<String> {
        let files = std::fs::read_dir(place.path(folder).join("accounts")).unwrap();
        files.map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap()).collect()
    };
    let words =
        |text: &String| text.contains("\"text\": \"") && !text.replace("\"text\": \"\"", "").contains("\"text\": \"");
    assert!(!accounts("frozen").is_empty() && accounts("frozen").iter().all(words));
    assert!(!accounts("told").iter().any(words), "the words stand there where they are asked for");
    assert_eq!(test(&place, &["--ego", "idm", "--out", "r.json", "--quiet"]).0, 0);
    let results = json(&place.path("r.json"));
    for test in results["tests"].as_array().unwrap() {
        assert!(test["about"]["crash_type"].is_string() && test["about"]["incident"].is_string(), "{test}");
        assert!(test["runs"][0]["outcome"]["met"].is_boolean(), "{test}");
    }
}

#[test]
fn incidents_and_crash_types_go_along() {
    let place = Place::new();
    let (code, told, errors) = place.run(&["reconstruct", "--records", FEW, "--to-dir", "scenes", "--json"]);
    assert_eq!(code, 0, "{errors}");
    std::fs::write(place.path("told.json"), told).unwrap();
    let (code, _, errors) = place.run(&["freeze", "scenes", "--about", "told.json", "--out", "frozen", "--quiet"]);
    assert_eq!(code, 0, "{errors}");
    let suite = json(&place.path("frozen/frozen.json"));
    for test in suite["tests"].as_array().unwrap() {
        let about = &test["about"];
        assert!(about["incident"].is_string() && about["crash_type"].is_string(), "{test}");
        assert!(about["provenance"] == "own" && !about["reports"].as_array().unwrap().is_empty(), "{test}");
    }
    let (code, shown, errors) = test(&place, &["--ego", "idm"]);
    assert_eq!(code, 0, "{errors}");
    for words in [
        "Front to rear",
        "Intersection",
        "Causes: one finding each",
        "most harmful first",
        "of contacts, reference drivers of UN R157",
        "failed: ",
    ] {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
}

/// Whether each scenario fails with an ego, by the command that runs one scenario.
fn failing(place: &Place, ego: &str, ids: &BTreeSet<String>) -> BTreeMap<String, bool> {
    const FAILURES: [&str; 5] = ["contact", "obstacle_contact", "near_miss", "off_road", "stuck"];
    let fails = |id: &String| {
        let file = format!("frozen/scenarios/{id}.json");
        let (code, run, errors) = place.run(&["simulate", &file, "--ego", ego, "--json"]);
        assert_eq!(code, 0, "{errors}");
        let run: Value = serde_json::from_str(&run).unwrap();
        let findings = run["judgement"]["findings"].as_array().unwrap().clone();
        findings.iter().any(|finding| FAILURES.contains(&finding["kind"].as_str().unwrap()))
    };
    ids.iter().map(|id| (id.clone(), fails(id))).collect()
}

#[test]
fn two_versions_of_an_ego_differ_in_exactly_the_scenarios_that_changed() {
    let place = frozen();
    let base = ego(&place, "base.py", ("", ""));
    let blind = ego(&place, "blind.py", (LOOKS, BLIND));
    let early = ego(&place, "early.py", ("1.5 * me[\"speed\"]", "2.5 * me[\"speed\"]"));
    for (name, ego) in [("base", &base), ("blind", &blind), ("early", &early)] {
        let out = format!("{name}.json");
        assert_eq!(test(&place, &["--ego", ego, "--out", &out, "--quiet"]).0, 0);
    }
    let results = json(&place.path("base.json"));
    let tests = results["tests"].as_array().unwrap();
    let ids: BTreeSet<String> = tests.iter().map(|test| test["id"].as_str().unwrap().to_owned()).collect();
    let on_foot: BTreeSet<String> = ids
        .iter()
        .filter(|id| {
            let scenario = std::fs::read_to_string(place.path(&format!("frozen/scenarios/{id}.json"))).unwrap();
            scenario.contains("\"pedestrian\"") || scenario.contains("\"other_non_motorist\"")
        })
        .cloned()
        .collect();
    let before = failing(&place, &base, &ids);
    let mut all = BTreeSet::new();
    for (name, ego) in [("blind", &blind), ("early", &early)] {
        let out = format!("{name}.json");
        let (code, compared, errors) = place.run(&["compare", "base.json", &out, "--json", "--fail-on", "added"]);
        assert_eq!(code, 0, "{errors}");
        let compared: Value = serde_json::from_str(&compared).unwrap();
        let of = |change: &str| -> BTreeSet<String> {
            let tests = compared["tests"].as_array().unwrap().iter();
            tests.filter(|test| test["change"] == change).map(|test| test["id"].as_str().unwrap().to_owned()).collect()
        };
        let now = failing(&place, ego, &ids);
        let turned = |from: bool, to: bool| -> BTreeSet<String> {
            ids.iter().filter(|id| before[*id] == from && now[*id] == to).cloned().collect()
        };
        assert_eq!(of("broken"), turned(false, true), "{name}");
        assert_eq!(of("fixed"), turned(true, false), "{name}");
        if name == "blind" {
            assert!(!of("broken").is_empty() || !of("worse").is_empty());
            let changed: BTreeSet<String> = ids.difference(&of("same")).cloned().collect();
            assert!(changed.is_subset(&on_foot), "{changed:?}");
        } else {
            assert!(!of("fixed").is_empty() || !of("better").is_empty());
        }
        all.extend(of("broken").into_iter().chain(of("worse")));
        let again = place.run(&["compare", "base.json", &out, "--json"]).1;
        assert_eq!(again, serde_json::to_string_pretty(&compared).unwrap() + "\n", "the same bytes twice");
    }
    assert!(!all.is_empty());
    let fail_on = |new: &str| place.run(&["compare", "base.json", new, "--fail-on", "broken,worse", "--quiet"]).0;
    assert_eq!((fail_on("blind.json"), fail_on("base.json")), (5, 0));
}

#[test]
fn junit_is_red_for_what_got_worse_alone() {
    let place = frozen();
    assert_eq!(test(&place, &["--ego", "idm", "--out", "base.json", "--quiet"]).0, 0);
    let with = |ego: &str, name: &str| {
        let extra = ["--ego", ego, "--baseline", "base.json", "--junit", name, "--markdown", "m.md", "--quiet"];
        let (code, _, errors) = test(&place, &extra);
        assert_eq!(code, 0, "{errors}");
        std::fs::read_to_string(place.path(name)).unwrap()
    };
    let same = with("idm", "same.xml");
    assert!(!same.contains("<failure") && same.contains("known failure: the baseline fails as well"), "{same}");
    let other = with("metadrive-idm", "other.xml");
    assert!(other.contains("<failure type=\"broken\"") && other.contains("known failure"), "{other}");
    let summary = std::fs::read_to_string(place.path("m.md")).unwrap();
    assert!(summary.contains("# `metadrive-idm` against `idm`") && summary.contains("## Broken ("), "{summary}");
    assert_eq!(test(&place, &["--ego", "idm", "--junit", "alone.xml", "--fail-on", "broken", "--quiet"]).0, 5);
    assert!(std::fs::read_to_string(place.path("alone.xml")).unwrap().contains("<failure type=\"failed\""));
}

#[test]
fn annotations_and_tables_are_as_their_readers_want_them() {
    let place = frozen();
    for (ego, out) in [("idm", "base.json"), ("metadrive-idm", "new.json")] {
        assert_eq!(test(&place, &["--ego", ego, "--out", out, "--quiet"]).0, 0);
    }
    let (_, shown, _) = place.run(&["compare", "base.json", "new.json", "--github", "--quiet"]);
    assert!(shown.lines().all(|line| line.starts_with("::")), "{shown}");
    for level in ["::error ", "::warning ", "::notice "] {
        assert!(shown.lines().filter(|line| line.starts_with(level)).count() <= 10, "GitHub shows ten: {shown}");
    }
    assert!(
        shown.contains("::error title=broken%3A ") && shown.contains("::notice title=recrash::36 tests"),
        "{shown}"
    );
    for columns in ["60", "80", "120"] {
        let mut command = crate::common::recrash(&["compare", "base.json", "new.json"]);
        let output = command.current_dir(place.folder()).env("COLUMNS", columns).output().unwrap();
        let shown = String::from_utf8(output.stdout).unwrap();
        let widest = shown.lines().filter(|line| !line.contains("not shown in")).map(|line| line.chars().count()).max();
        assert!(widest.unwrap() <= columns.parse().unwrap(), "{columns}:\n{shown}");
    }
}

/// An ego that stops at random, by the seed it is told.
const RANDOM: &str = r#"
import json, random, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "reset":
        stops = random.Random(message["seed"]).random() < 0.5
    if message["type"] == "step":
        answer = {"type": "control", "throttle": -1.0 if stops else 0.2, "steer": 0.0}
    else:
        answer = {"type": "ready", "protocol": "recrash.ego/1"}
    if message["type"] != "end":
        print(json.dumps(answer), flush=True)
"#;

#[test]
fn an_ego_that_is_random_is_flaky_and_not_broken() {
    let place = frozen();
    std::fs::write(place.path("random.py"), RANDOM).unwrap();
    for out in ["one.json", "two.json"] {
        let extra = ["--ego", "cmd:python3 random.py", "--seeds", "6", "--out", out, "--quiet"];
        assert_eq!(test(&place, &extra).0, 0);
    }
    assert_eq!(std::fs::read(place.path("one.json")).unwrap(), std::fs::read(place.path("two.json")).unwrap());
    let (code, compared, _) = place.run(&["compare", "one.json", "two.json", "--fail-on", "broken,worse", "--json"]);
    let compared: Value = serde_json::from_str(&compared).unwrap();
    let flaky: Vec<&Value> =
        compared["tests"].as_array().unwrap().iter().filter(|test| test["change"] == "flaky").collect();
    assert!(code == 0 && !flaky.is_empty(), "{compared}");
    assert!(flaky.iter().all(|test| test["p"].as_f64().unwrap() > 0.05), "{flaky:?}");
}

/// An ego that drives faster in each of its runs.
const LEARNING: &str = r#"
import json, pathlib, sys
runs = pathlib.Path("runs")
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "reset":
        count = int(runs.read_text()) + 1 if runs.exists() else 0
        runs.write_text(str(count))
    if message["type"] == "step":
        slow = message["ego"]["speed"] < 2.0 + 0.1 * count
        answer = {"type": "control", "throttle": 0.3 if slow else -0.2, "steer": 0.0}
    else:
        answer = {"type": "ready", "protocol": "recrash.ego/1"}
    if message["type"] != "end":
        print(json.dumps(answer), flush=True)
"#;

#[test]
fn an_ego_that_does_not_repeat_is_told_and_written_down() {
    let place = frozen();
    std::fs::write(place.path("learning.py"), LEARNING).unwrap();
    std::fs::write(place.path("steady.py"), crate::common::driving_ego(6.0)).unwrap();
    let results = |name: &str| -> (Value, String) {
        let ego = format!("cmd:python3 {name}");
        let (code, shown, errors) = test(&place, &["--threads", "1", "--ego", &ego, "--out", "results.json"]);
        assert_eq!(code, 0, "{errors}");
        assert!(errors.contains("answer times of the ego: median "), "{errors}");
        (serde_json::from_slice(&std::fs::read(place.path("results.json")).unwrap()).unwrap(), shown)
    };
    let (steady, shown) = results("steady.py");
    assert!(steady["unrepeated"].is_null() && !shown.contains("does not repeat"), "{shown}");
    let (learning, shown) = results("learning.py");
    assert_eq!(learning["unrepeated"]["test"], learning["tests"][0]["id"], "{shown}");
    assert!(shown.contains("warning: the ego does not repeat"), "{shown}");
    // Such results can be read again.
    let (code, _, errors) = place.run(&["compare", "results.json", "results.json"]);
    assert_eq!(code, 0, "{errors}");

    let run = ["run", "--records", FEW, "--budget", "2", "--tune-budget", "1", "--threads", "1", "--out", "learnt"];
    let (code, shown, errors) = place.run(&[&run[..], &["--ego", "cmd:python3 learning.py"]].concat());
    assert!([0, MISSED].contains(&code), "{errors}");
    assert!(shown.contains("warning: the ego does not repeat"), "{shown}");
    let summary: Value = serde_json::from_slice(&std::fs::read(place.path("learnt/summary.json")).unwrap()).unwrap();
    assert!(summary["cases"].as_array().unwrap().iter().any(|case| case["unrepeated"] == true), "{summary}");
}

#[test]
fn what_is_wrong_with_a_file_is_told_with_its_place() {
    let place = frozen();
    let spoil = |name: &str, from: &str, to: &str, wanted: &[&str], command: &[&str]| {
        let file = place.path(name);
        let good = std::fs::read_to_string(&file).unwrap();
        let bad = good.replacen(from, to, 1);
        assert_ne!(good, bad, "{from}");
        std::fs::write(&file, bad).unwrap();
        let (code, _, errors) = place.run(command);
        assert_eq!(code, 3, "{errors}");
        assert!(wanted.iter().all(|words| errors.contains(words)) && errors.len() < 2000, "{wanted:?}: {errors}");
        std::fs::write(&file, good).unwrap();
    };
    let run = ["test", "frozen", "--ego", "idm"];
    let list = "frozen/frozen.json";
    spoil(list, "\"unknown\"", "\"stolen\"", &["tests[0].about.provenance", "stolen"], &run);
    spoil(list, "recrash.frozen/1", "recrash.frozen/9", &["recrash.frozen/9", "\"recrash.frozen/1\" is read"], &run);
    spoil(list, "\"scenarios/", "\"../scenarios/", &["tests[0].scenario", "leads out"], &run);
    spoil(list, "\"min_gap_m\": 2.0", "\"min_gap_m\": 0.1", &["content", "freeze the suite again"], &run);
    let scenario = "frozen/scenarios/crashes-01-rear-end-at-red.json";
    spoil(scenario, "\"duration_s\"", " \"duration_s\"", &["tests[0].sha256", "is not as it was frozen"], &run);
    assert_eq!(test(&place, &["--ego", "idm", "--out", "r.json", "--quiet"]).0, 0);
    let compare = ["compare", "r.json", "r.json"];
    spoil("r.json", "\"failed\"", "7", &["tests[", "verdict"], &compare);
    spoil("r.json", "\"runs\": [", "\"runs\": 3, \"x\": [", &["tests[0].runs", "invalid type"], &compare);
    spoil("r.json", "{", "{{", &["it is no results file"], &compare);
    assert_eq!(place.run(&["test", "nowhere"]).0, 3);
    assert_eq!(place.run(&["compare", "nowhere", "r.json"]).0, 3);
    let (code, _, errors) = place.run(&["compare", "r.json", "r.json", "--fail-on", "slower"]);
    assert!(code == 2 && errors.contains("there are: broken, worse"), "{errors}");
}

#[test]
fn a_folder_that_holds_something_else_is_left_alone() {
    let place = frozen();
    std::fs::create_dir(place.path("mine")).unwrap();
    std::fs::write(place.path("mine/thesis.txt"), "mine").unwrap();
    let source = cases("acts");
    let freeze = |out: &str, extra: &[&str]| place.run(&[&["freeze", text(&source), "--out", out], extra].concat()).0;
    assert_eq!((freeze("mine", &[]), freeze("mine", &["--replace"]), freeze("frozen", &[])), (3, 3, 3));
    assert_eq!(freeze("frozen", &["--replace"]), 0);
    let (_, _, told) = place.run(&["freeze", text(&source), "--out", "frozen"]);
    assert!(told.contains("--replace"), "{told}");
    assert!(!place.path("frozen/scenarios/crashes-01-rear-end-at-red.json").exists(), "the old suite's are gone");
    assert_eq!(test(&place, &["--ego", "idm", "--quiet"]).0, 0);
    let (code, _, errors) = test(&place, &["--ego", "idm", "--out", "frozen/frozen.json"]);
    assert!(code == 3 && errors.contains("is read"), "{errors}");
    let (code, _, errors) = place.run(&["freeze", text(&source), text(&source), "--out", "twice"]);
    assert!(code == 3 && errors.contains("two scenarios have the id"), "{errors}");
}

#[test]
fn robustness_is_told_for_every_failure_and_repeats() {
    let place = frozen();
    let report = |out: &str| {
        let (code, shown, errors) = place.run(&["robustness", "frozen", "--ego", "idm", "--tries", "5", "--out", out]);
        assert_eq!(code, 0, "{errors}");
        assert!(shown.contains("still fails") && shown.contains("are robust"), "{shown}");
        std::fs::read_to_string(place.path(out)).unwrap()
    };
    assert_eq!(report("one.json"), report("two.json"));
    let robust = json(&place.path("one.json"));
    assert_eq!(test(&place, &["--ego", "idm", "--out", "r.json", "--quiet"]).0, 0);
    let results = json(&place.path("r.json"));
    let failed: Vec<&Value> = results["tests"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|test| test["runs"][0]["verdict"] == "failed")
        .map(|test| &test["id"])
        .collect();
    let told: Vec<&Value> = robust["failures"].as_array().unwrap().iter().map(|each| &each["id"]).collect();
    assert_eq!(told, failed);
}

#[test]
fn a_minimal_failure_fails_and_its_twin_passes() {
    let place = frozen();
    let id = "crashes-18-cyclist-from-behind";
    let (code, shown, errors) = place.run(&["minimise", "frozen", "--ego", "idm", "--only", id, "--out", "minimal"]);
    assert_eq!(code, 0, "{errors}");
    assert!(shown.contains("nearest that") && shown.contains("1 failures in minimal"), "{shown}");
    let fails = |file: &str| {
        let (code, shown, errors) = place.run(&["simulate", file, "--ego", "idm"]);
        assert_eq!(code, 0, "{errors}");
        shown.contains("FAIL")
    };
    assert!(fails(&format!("minimal/{id}.json")) && !fails(&format!("minimal/{id}.passes.json")));
    let again = || place.run(&["minimise", "frozen", "--ego", "idm", "--only", id, "--out", "minimal", "--quiet"]);
    assert_eq!(again().0, 0, "the same again is no loss");
    std::fs::write(place.path(&format!("minimal/{id}.json")), "mine").unwrap();
    let (code, _, errors) = again();
    assert!(code == 3 && errors.contains("is there and differs"), "{errors}");
    assert_eq!(std::fs::read_to_string(place.path(&format!("minimal/{id}.json"))).unwrap(), "mine");
    let (code, _, errors) = place.run(&["minimise", "frozen", "--ego", "idm", "--only", "nobody", "--out", "m"]);
    assert!(code == 3 && errors.contains("no test nobody"), "{errors}");
}

#[test]
fn evidence_is_of_the_runs_that_are_given() {
    let place = frozen();
    assert_eq!(test(&place, &["--ego", "idm", "--out", "idm.json", "--quiet"]).0, 0);
    let evidence = |ego: &str, out: &str| {
        place.run(&["evidence", "frozen", "--ego", ego, "--results", "idm.json", "--out", out, "--quiet"])
    };
    let (code, _, errors) = evidence("idm", "evidence");
    assert_eq!(code, 0, "{errors}");
    let checked = std::process::Command::new("python3").arg(place.path("evidence/check.py")).output().unwrap();
    let shown = String::from_utf8_lossy(&checked.stdout).into_owned();
    assert!(checked.status.success() && shown.contains("numbers come out as they are told"), "{shown}");
    let (code, _, errors) = evidence("metadrive-idm", "other");
    assert!(code == 3 && errors.contains("the results are no evidence"), "{errors}");
    assert!(!place.path("other").exists(), "no half of a folder is in the way of the next try");
    std::fs::create_dir(place.path("mine")).unwrap();
    let (code, _, errors) = evidence("idmm", "mine");
    assert!(code == 3 && errors.contains("idmm"), "{errors}");
    assert!(place.path("mine").is_dir(), "the user's empty folder stays");
    assert_eq!(evidence("idm", "mine").0, 0);
    assert!(place.path("mine/manifest.json").is_file());
    let left = std::fs::read_dir(place.folder()).unwrap().map(|entry| entry.unwrap().file_name());
    assert_eq!(left.filter(|name| name.to_string_lossy().starts_with('.')).count(), 0);
    let (code, _, errors) = evidence("idm", "evidence");
    assert!(code == 3 && errors.contains("it holds something else"), "{errors}");
    assert_eq!(place.run(&["robustness", "frozen", "--tries", "1", "--out", "of-another.json", "--quiet"]).0, 0);
    let with = ["evidence", "frozen", "--ego", "idm", "--with", "of-another.json", "--out", "other", "--quiet"];
    let (code, _, errors) = place.run(&with);
    assert!(code == 3 && errors.contains("it is of another ego"), "{errors}");
}

#[test]
fn the_checker_takes_the_mass_that_a_road_user_has_of_its_own() {
    let place = Place::new();
    let mut scenario = json(&cases("crashes").join("18-cyclist-from-behind.json"));
    let cyclist = scenario["actors"].as_array().unwrap().iter().position(|actor| actor["kind"] == "cyclist").unwrap();
    scenario["actors"][cyclist]["mass_kg"] = 400.0.into();
    std::fs::write(place.path("heavy.json"), scenario.to_string()).unwrap();
    let (code, _, errors) = place.run(&["freeze", "heavy.json", "--out", "frozen", "--quiet"]);
    assert_eq!(code, 0, "{errors}");
    assert_eq!(place.run(&["evidence", "frozen", "--ego", "idm", "--out", "evidence", "--quiet"]).0, 0);
    let checked = std::process::Command::new("python3").arg(place.path("evidence/check.py")).output().unwrap();
    let shown = String::from_utf8_lossy(&checked.stdout).into_owned();
    assert!(checked.status.success() && shown.contains("numbers come out as they are told"), "{shown}");
    let numbers = std::fs::read_to_string(place.path("evidence/numbers.json")).unwrap();
    assert!(numbers.contains("other_delta_v"), "somebody is touched: {numbers}");
}

#[test]
fn a_night_that_could_not_be_run_is_not_green() {
    let place = five_frozen();
    let base = ego(&place, "base.py", ("", ""));
    assert_eq!(test(&place, &["--ego", &base, "--out", "base.json", "--quiet"]).0, 0);
    let dies = ego(&place, "dies.py", ("answer = control(world, message)", "sys.exit(3)"));
    let compared = ["--ego", &dies, "--baseline", "base.json", "--out", "new.json", "--quiet"];
    let (code, _, errors) = test(&place, &[&compared[..], &["--fail-on", "broken,worse"]].concat());
    assert!(code == 5 && errors.contains("5 not run of 5 tests"), "{errors}");
    let (code, shown, errors) = test(&place, &compared[..6]);
    assert!(
        code == 5 && errors.contains("none of 5 tests could be run"),
        "also where nothing is to be failed on: {errors}"
    );
    assert!(shown.contains("not run: ") && shown.contains("and 2 more"), "{shown}");
    let first_night = |ego: &str| test(&place, &["--ego", ego, "--fail-on", "not_run", "--quiet"]).0;
    assert_eq!((first_night(&dies), first_night(&base)), (5, 0), "a failure is no news on the first night");
    let fail_on = ["compare", "base.json", "new.json", "--fail-on", "broken", "--quiet"];
    assert_eq!(place.run(&fail_on).0, 5);
    let (code, _, errors) = place.run(&["compare", "new.json", "base.json", "--fail-on", "broken", "--quiet"]);
    assert!(code == 3 && errors.contains("no test could be run for the baseline"), "nothing would be red: {errors}");
}

#[test]
fn a_baseline_that_says_nothing_of_the_suite_is_refused() {
    let place = frozen();
    let other = place.run(&["freeze", text(&cases("acts")), "--out", "other", "--quiet"]);
    assert_eq!(other.0, 0, "{}", other.2);
    assert_eq!(place.run(&["test", "other", "--ego", "idm", "--out", "other.json", "--quiet"]).0, 0);
    let compared = ["--ego", "idm", "--baseline", "other.json", "--fail-on", "broken", "--quiet"];
    let (code, _, errors) = test(&place, &compared);
    assert!(code == 3 && errors.contains("there is nothing to compare"), "{errors}");
    let (code, _, errors) = test(&place, &["--ego", "idm", "--baseline", "nowhere.json", "--out", "r.json", "--quiet"]);
    assert!(code == 3 && errors.contains("nowhere.json") && !place.path("r.json").exists(), "{errors}");
    let (code, _, errors) = test(&place, &["--ego", "idm", "--github", "--quiet"]);
    assert!(code == 2 && errors.contains("--github is of a comparison"), "{errors}");
    let (code, _, errors) = place.run(&["freeze", "frozen", "--out", "again"]);
    assert!(code == 3 && errors.contains("it is a frozen suite already"), "{errors}");
}

#[test]
fn a_page_plays_what_changed_and_starts_no_program_that_only_a_file_names() {
    let place = frozen();
    for (ego, out) in [("idm", "base.json"), ("metadrive-idm", "new.json")] {
        assert_eq!(test(&place, &["--ego", ego, "--out", out, "--quiet"]).0, 0);
    }
    let page =
        |base: &str| place.run(&["compare", base, "new.json", "--suite", "frozen", "--page", "page.html", "--quiet"]);
    let (code, _, errors) = page("base.json");
    assert_eq!(code, 0, "{errors}");
    let shown = std::fs::read_to_string(place.path("page.html")).unwrap();
    assert!(shown.contains("metadrive-idm against idm") && shown.contains("Side by side"));
    assert!(shown.contains("recrash compare base.json new.json --suite frozen --page page.html"));
    assert!(shown.contains("href=\"#pair-0\"") && shown.contains("id=\"pair-0\""), "the list leads to what is played");
    let stranger = std::fs::read_to_string(place.path("base.json")).unwrap().replace("\"idm\"", "\"cmd:touch owned\"");
    std::fs::write(place.path("stranger.json"), stranger).unwrap();
    let (code, _, errors) = page("stranger.json");
    assert!(code == 2 && errors.contains("touch owned") && errors.contains("--base-ego"), "{errors}");
    assert!(!place.path("owned").exists());
}
