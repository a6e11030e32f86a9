//! Egos on the command line: the reference driver, and programs of the user's, good and bad.

use crate::common::{MISSED, Place, SMALL, recrash};
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/cli").to_owned()
}

fn crossing() -> String {
    repository().join("crates/pipeline/benches/crossing.json").display().to_string()
}

fn example() -> String {
    format!("cmd:python3 '{}'", repository().join("docs/examples/ego.py").display())
}

/// Exit code, standard output, standard error.
fn run(arguments: &[&str]) -> (i32, String, String) {
    let output = recrash(arguments).output().expect("it runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().expect("no signal"), text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_reference_driver_and_a_program_drive_one_scenario() {
    for ego in ["reference", &example()] {
        let (code, shown, errors) = run(&["simulate", &crossing(), "--ego", ego, "--json"]);
        assert_eq!(code, 0, "{ego}: {errors}");
        let result: serde_json::Value = serde_json::from_str(&shown).expect("JSON");
        assert_eq!(result["rollout"]["ego"], ego);
        assert!(result["rollout"]["actors"][0]["states"].as_array().expect("states").len() > 20);
    }
}

#[test]
fn an_unknown_ego_lists_the_known_ones_and_metadrive_takes_no_program() {
    let (code, _, errors) = run(&["simulate", &crossing(), "--ego", "human"]);
    assert_eq!(code, 3);
    assert!(errors.contains("metadrive-idm, idm, reference"), "{errors}");
    let (code, _, errors) = run(&["simulate", &crossing(), "--ego", "cmd:true", "--sim", "metadrive"]);
    assert_eq!(code, 3);
    assert!(errors.contains("runs its own policies only"), "{errors}");
}

/// An ego that drives straight on, and gives up in one scenario.
const MOODY: &str = r#"
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "reset" and message["scenario"].startswith("intersection-straight-straight"):
        sys.exit("licence expired")
    if message["type"] == "step":
        answer = {"type": "control", "throttle": 0.3 if message["ego"]["speed"] < 6.0 else 0.0, "steer": 0.0}
    else:
        answer = {"type": "ready", "protocol": "recrash.ego/1"}
    if message["type"] != "end":
        print(json.dumps(answer), flush=True)
"#;

#[test]
fn a_suite_goes_on_where_a_program_fails_in_some_scenarios_and_tells_which() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("suite");
    let program = folder.path().join("ego.py");
    std::fs::write(&program, MOODY).expect("a script");
    let ego = format!("cmd:python3 {}", program.display());
    let arguments = ["run", "--out", out.to_str().expect("text"), "--budget", "2", "--tune-budget", "1", "--ego", &ego];
    let (code, _, errors) = run(&[&arguments[..], &["--json", "--ego-timeout", "30", "--threads", "1"]].concat());
    assert_eq!(code, MISSED, "{errors}");
    let summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).expect("a summary")).expect("JSON");
    let cases = summary["cases"].as_array().expect("cases");
    let (failed, others): (Vec<_>, Vec<_>) = cases.iter().partition(|case| !case["failure"].is_null());
    let why = failed[0]["failure"]["why"].as_str().expect("one failed");
    assert!(why.contains("exit status: 1") && why.contains("licence expired"), "{why}");
    assert!(failed.len() == 1 && others[0]["tuned"].is_object(), "{cases:?}");
}

#[test]
fn failures_are_triaged_by_the_other_egos() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("suite");
    let (code, shown, errors) = run(&["run", "--out", out.to_str().expect("text"), "--budget", "4"]);
    assert_eq!(code, 0, "{errors}");
    let summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).expect("a summary")).expect("JSON");
    let mut failed = 0;
    for case in summary["cases"].as_array().expect("cases") {
        let triage = &case["triage"];
        assert_eq!(triage.is_object(), case["tuned"]["failed"] == true, "{case}");
        if triage.is_object() {
            failed += 1;
            let egos: Vec<&str> =
                triage["others"].as_array().expect("others").iter().filter_map(|o| o["ego"].as_str()).collect();
            assert_eq!(egos, ["idm", "reference"]);
            let id = case["id"].as_str().expect("id");
            assert!(out.join(format!("7-tuned-runs/{id}.reference.json")).exists());
            assert!(shown.contains(&triage["class"].as_str().expect("class").replace('_', " ")), "{shown}");
        }
    }
    assert!(failed > 0, "metadrive-idm fails something");
    let csv = std::fs::read_to_string(out.join("results.csv")).expect("results");
    assert!(csv.lines().next().expect("a header").contains("failure_class,other_egos"));
}

#[test]
#[cfg(unix)]
fn a_program_behind_a_wrapper_that_hangs_is_left_by_nobody() {
    // A time that nobody else sleeps for.
    let ego = "cmd:sh -c 'sleep 64.193; true'";
    let (code, _, errors) = run(&["simulate", &crossing(), "--ego", ego, "--ego-timeout", "1"]);
    assert_eq!(code, 3, "{errors}");
    assert!(errors.contains("gave no answer to hello"), "{errors}");
    let told = std::process::Command::new("ps").args(["-A", "-o", "args"]).output().expect("ps");
    let left: Vec<String> = String::from_utf8_lossy(&told.stdout)
        .lines()
        .filter(|l| l.contains("sleep 64.193"))
        .map(str::to_owned)
        .collect();
    assert_eq!(left, [""; 0]);
}

#[test]
fn a_program_sees_what_the_user_names_and_no_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let (program, seen) = (folder.path().join("ego.py"), folder.path().join("seen"));
    let script = "import os, sys\nopen(sys.argv[1], 'w').write('\\n'.join(os.environ))\n";
    std::fs::write(&program, script).expect("a script");
    let ego = format!("cmd:python3 {} {}", program.display(), seen.display());
    let mut command = recrash(&["simulate", &crossing(), "--ego", &ego]);
    command.env("RECRASH_PASS_ENV", "STACK_*, NAMED_TOKEN").envs([("STACK_MODE", "x"), ("STACK_API_KEY", "x")]);
    command.envs([("NAMED_TOKEN", "x"), ("OPENAI_API_KEY", "x"), ("UNNAMED", "x")]).output().expect("it runs");
    let seen = std::fs::read_to_string(seen).expect("the program ran");
    let sees = |name: &str| seen.lines().any(|line| line == name);
    assert!(sees("PATH") && sees("STACK_MODE") && sees("NAMED_TOKEN"), "{seen}");
    assert!(!sees("STACK_API_KEY") && !sees("OPENAI_API_KEY") && !sees("UNNAMED"), "{seen}");
}

/// An ego that gives up in the second run of the first scenario that it sees, until it may go on.
const FAINT: &str = r#"
import json, pathlib, sys
seen, well = pathlib.Path("seen"), pathlib.Path("well")
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "reset":
        runs = seen.read_text().split() if seen.exists() else []
        seen.write_text(" ".join(runs + [message["scenario"]]))
        if runs and runs[0] == message["scenario"] and not well.exists():
            sys.exit("out of memory")
    if message["type"] == "step":
        answer = {"type": "control", "throttle": 0.3 if message["ego"]["speed"] < 6.0 else 0.0, "steer": 0.0}
    else:
        answer = {"type": "ready", "protocol": "recrash.ego/1"}
    if message["type"] != "end":
        print(json.dumps(answer), flush=True)
"#;

#[test]
fn who_was_driven_and_gives_no_answer_in_triage_stays_driven() {
    let place = Place::new();
    std::fs::write(place.path("ego.py"), FAINT).expect("a script");
    let arguments =
        ["run", "--profile", "open", "--records", crate::common::FEW, "--budget", "4", "--tune-budget", "1"];
    let arguments = [&arguments[..], &["--threads", "1", "--ego", "cmd:python3 ego.py"]].concat();
    let (code, shown, errors) = place.run(&arguments);
    assert_eq!(code, MISSED, "{errors}");
    let summary = || -> serde_json::Value {
        serde_json::from_str(&std::fs::read_to_string(place.path("suite/summary.json")).expect("a summary"))
            .expect("JSON")
    };
    let cases = summary()["cases"].as_array().expect("cases").clone();
    let fainted: Vec<_> = cases.iter().filter(|case| !case["failure"].is_null()).collect();
    assert!(fainted.len() == 1 && fainted[0]["failure"]["stage"] == "triage", "{cases:?}");
    assert!(fainted[0]["first"].is_object() && fainted[0]["situation_met"].is_boolean(), "{}", fainted[0]);
    let tested = cases.iter().filter(|case| case["first"].is_object()).count();
    for words in [
        format!("{} scenarios: {tested} driven", cases.len()),
        "1 driven as reconstructed, with no answer after that".to_owned(),
        format!("not answered: {}: triage: ", fainted[0]["id"].as_str().expect("an id")),
    ] {
        assert!(shown.contains(&words), "{words}: {shown}");
    }
    assert!(!shown.contains("not run") && !shown.contains("NOT RUN"), "{shown}");
    // It is asked again by the next run.
    std::fs::write(place.path("well"), "").expect("a file");
    let (code, shown, errors) = place.run(&arguments);
    assert!(code == 0 && !shown.contains("no answer after that"), "{errors} {shown}");
}

/// A folder with the module of the package that speaks for egos in Python, and an ego `my_stack` beside it.
pub(super) fn python_place(speed_mps: f64) -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("recrash")).expect("a folder");
    std::fs::write(place.path("recrash/__init__.py"), "").expect("a module");
    std::fs::copy(repository().join("python/recrash/ego.py"), place.path("recrash/ego.py")).expect("a module");
    std::fs::create_dir(place.path("my_stack")).expect("a folder");
    std::fs::write(place.path("my_stack/__init__.py"), "from my_stack.planner import drive\n").expect("a module");
    planner(&place, speed_mps);
    place
}

fn planner(place: &Place, speed_mps: f64) {
    let text = format!(
        "def drive(seen):\n    slow = seen['ego']['speed'] < {speed_mps:?}\n    return {{'throttle': 0.3 if slow else -0.2, 'steer': 0.0}}\n"
    );
    std::fs::write(place.path("my_stack/planner.py"), text).expect("a module");
}

#[test]
fn runs_of_an_ego_that_is_a_module_are_made_again_where_its_package_has_changed() {
    let place = python_place(6.0);
    let arguments = [&SMALL[..], &["--ego", "py:my_stack:drive"]].concat();
    let done = |shown: &str| shown.contains("simulate: 0 units done, 2 there already");
    let (code, _, errors) = place.run(&arguments);
    assert!([0, MISSED].contains(&code), "{errors}");
    let (_, shown, errors) = place.run(&["simulate", "suite"]);
    assert!(errors.contains("--trust"), "{shown} {errors}");
    let simulate = || place.run(&["simulate", "suite", "--ego", "py:my_stack:drive"]).1;
    assert!(done(&simulate()));
    planner(&place, 3.0);
    assert!(!done(&simulate()), "a changed file of its package");
    assert!(done(&simulate()));
}

#[test]
#[cfg(unix)]
fn the_interpreter_that_is_named_runs_an_ego_that_is_a_module() {
    use std::os::unix::fs::PermissionsExt;
    let place = python_place(6.0);
    let python = place.path("my-python");
    std::fs::write(&python, "#!/bin/sh\ntouch used\nexec python3 \"$@\"\n").expect("a script");
    std::fs::set_permissions(&python, std::fs::Permissions::from_mode(0o755)).expect("its owner's");
    let ego = ["simulate", &crossing(), "--ego", "py:my_stack:drive"];
    let (code, _, errors) = place.run(&[&ego[..], &["--python", "./my-python"]].concat());
    assert!(code == 0 && place.path("used").exists(), "{errors}");
    let (code, _, errors) = place.run(&[&ego[..], &["--python", "no-such-python"]].concat());
    assert!(code == 3 && errors.contains("no-such-python"), "{errors}");
}
