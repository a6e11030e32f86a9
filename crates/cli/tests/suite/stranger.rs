//! A suite from a stranger is data: whatever is in it, nothing outside it changes and no program starts.
#![cfg(unix)]

use crate::common::{Place, SMALL, TOLD, copy};
use serde_json::Value;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

/// Commands that work on a suite.
const COMMANDS: [&[&str]; 9] = [
    &["narrate"],
    &["design"],
    &["simulate"],
    &["tune"],
    &["triage"],
    &["report"],
    &SMALL,
    &["export", "suite", "--to", "openscenario"],
    &["sweep", "suite", "-n", "2", "--out", "out.parquet"],
];

/// The same, where a suite goes by accounts.
const TOLD_COMMANDS: [&[&str]; 3] = [&TOLD, &["simulate"], &["report"]];

/// What a stranger does to a suite in a folder, with a folder beside it that holds somebody's files.
type Form = (&'static str, fn(&Path, &Path));

fn json(path: PathBuf, change: impl FnOnce(&mut Value)) {
    let mut document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    change(&mut document);
    fs::write(path, document.to_string()).unwrap();
}

/// Makes every unit of the journal say that it wrote this file as well.
fn claim(suite: &Path, name: &str) {
    let journal = suite.join("units.jsonl");
    let lines = fs::read_to_string(&journal).unwrap();
    let claimed = lines.lines().map(|line| {
        let mut line: Value = serde_json::from_str(line).unwrap();
        line["made"]["inputs"] = "other".into();
        line["made"]["outputs"][name] = serde_json::json!({ "hash": "00", "size": 1, "changed_ns": 1 });
        line.to_string() + "\n"
    });
    let text: String = claimed.collect();
    fs::write(journal, text).unwrap();
}

fn scenario_id(suite: &Path, id: &str) {
    json(suite.join("2-selection.json"), |selection| selection["clusters"][0]["scenario_id"] = id.into());
}

/// Puts a link in the place of a folder or a file of the suite.
fn linked(suite: &Path, name: &str, to: &Path) {
    let path = suite.join(name);
    let _ = fs::remove_dir_all(&path).or_else(|_| fs::remove_file(&path));
    symlink(to, path).unwrap();
}

fn first(suite: &Path, folder: &str) -> PathBuf {
    let mut files: Vec<PathBuf> =
        fs::read_dir(suite.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files[0].clone()
}

fn fifo(path: &Path) {
    let _ = fs::remove_file(path);
    assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
}

fn ego(suite: &Path, program: &str) {
    json(suite.join("suite.json"), |saved| saved["options"]["ego"] = program.into());
}

const FORMS: [Form; 22] = [
    ("outputs with ../", |suite, _| claim(suite, "../beside/precious")),
    ("outputs with ../ behind a folder", |suite, _| claim(suite, "6-tuned/../../beside/precious")),
    ("outputs that are absolute", |suite, beside| claim(suite, &beside.join("precious").to_string_lossy())),
    ("outputs two folders deep", |suite, _| claim(suite, "a/b/c")),
    ("outputs with a backslash", |suite, _| claim(suite, "..\\beside\\precious")),
    ("an id with ../", |suite, _| scenario_id(suite, "../../beside/precious")),
    ("an id that is absolute", |suite, beside| scenario_id(suite, &beside.join("x").to_string_lossy())),
    ("an id that is a folder", |suite, _| scenario_id(suite, "..")),
    ("an id of nothing", |suite, _| scenario_id(suite, "")),
    ("an id that is hidden", |suite, _| scenario_id(suite, ".ssh")),
    ("a folder that is a link", |suite, beside| linked(suite, "6-tuned", beside)),
    ("a folder of runs that is a link", |suite, beside| linked(suite, "5-runs", beside)),
    ("the page's folder is a link", |suite, beside| linked(suite, "report", beside)),
    ("the exports' folder is a link", |suite, beside| linked(suite, "exports", beside)),
    ("a journal that is a link", |suite, beside| linked(suite, "units.jsonl", &beside.join("precious"))),
    ("a page that is a link", |suite, beside| linked(suite, "report.html", &beside.join("precious"))),
    ("a scenario that is a link", |suite, beside| {
        let file = first(suite, "4-scenarios");
        fs::remove_file(&file).unwrap();
        symlink(beside.join("precious"), file).unwrap();
    }),
    ("a scenario that is a FIFO", |suite, _| fifo(&first(suite, "4-scenarios"))),
    ("records that are a FIFO", |suite, _| fifo(&suite.join("1-records.json"))),
    ("a journal that is a FIFO", |suite, _| fifo(&suite.join("units.jsonl"))),
    ("an ego that is a program", |suite, beside| ego(suite, &format!("cmd:touch {}", beside.join("ran").display()))),
    ("an ego that is a shell", |suite, beside| {
        ego(suite, &format!("cmd:sh -c 'touch {}'", beside.join("ran").display()))
    }),
];

const TOLD_FORMS: [Form; 5] = [
    ("accounts that are a FIFO", |suite, _| fifo(&suite.join("1-accounts.json"))),
    ("an account that is a link", |suite, beside| {
        let file = first(suite, "3-narratives");
        assert!(file.to_string_lossy().ends_with(".account.json"), "{file:?}");
        fs::remove_file(&file).unwrap();
        symlink(beside.join("precious"), file).unwrap();
    }),
    ("a tuned scenario that is a link", |suite, beside| {
        let file = first(suite, "6-tuned");
        fs::remove_file(&file).unwrap();
        symlink(beside.join("precious"), file).unwrap();
    }),
    ("outputs with ../", |suite, _| claim(suite, "../beside/precious")),
    ("an ego that is a program", |suite, beside| ego(suite, &format!("cmd:touch {}", beside.join("ran").display()))),
];

/// Names and contents of everything in a folder.
fn state(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|p| (p.clone(), fs::read(&p).unwrap()))
        .collect();
    all.sort();
    all
}

/// Spoils a suite in each form and works on it with each command.
fn keeps_to_itself(made: &Place, forms: &[Form], commands: &[&[&str]]) {
    for (form, spoil) in forms {
        for command in commands {
            let place = Place::new();
            copy(&made.path("suite"), &place.path("suite"));
            let beside = place.path("beside");
            fs::create_dir(&beside).unwrap();
            fs::write(beside.join("precious"), "mine").unwrap();
            spoil(&place.path("suite"), &beside);
            let before = state(&beside);
            // Whatever it says, it ends; the test's own patience would end with a hang.
            let (code, _, error) = place.run_within(command, 60);
            assert!(code != 101 && code != 124, "{form}, {command:?}: {code} {error}");
            assert_eq!(state(&beside), before, "{form}, {command:?}: {error}");
        }
    }
}

#[test]
fn a_hostile_suite_changes_nothing_outside_itself_and_runs_nothing() {
    keeps_to_itself(&Place::made(&SMALL), &FORMS, &COMMANDS);
}

#[test]
fn nor_does_one_that_goes_by_accounts() {
    keeps_to_itself(&Place::made(&TOLD), &TOLD_FORMS, &TOLD_COMMANDS);
}

#[test]
fn a_program_that_the_suite_names_starts_when_the_caller_trusts_it() {
    let place = Place::made(&SMALL);
    let ran = place.path("ran");
    ego(&place.path("suite"), &format!("cmd:touch {}", ran.display()));
    let (code, _, error) = place.run(&["simulate", "--quiet"]);
    assert!(code == 2 && error.contains("--trust") && !ran.exists(), "{error}");
    let (_, _, error) = place.run(&["simulate", "--quiet", "--trust"]);
    assert!(ran.exists(), "{error}");
}

#[test]
fn a_model_that_the_suite_names_is_asked_when_the_caller_names_it_and_not_when_another_is_named() {
    let place = Place::made(&SMALL);
    json(place.path("suite").join("suite.json"), |saved| saved["options"]["cast"]["design"] = "gpt-5-pro".into());
    let nowhere = ["design", "--quiet", "--retries", "0", "--base-url", "http://127.0.0.1:9"];
    let run = |named: &[&str]| place.run(&[&nowhere[..], named].concat());
    for named in [
        &[][..],
        &["--tune", "rules"],
        &["--paraphrase", "rules"],
        &["--review", "nobody"],
        &["--paraphrase", "other", "--tune", "gpt-5"],
        &["--ego", "idm"],
    ] {
        let (code, _, error) = run(named);
        assert!(code != 0 && error.contains("wants to ask the language model gpt-5-pro"), "{named:?}: {code} {error}");
    }
    // Nobody is at that address.
    for allowed in [&["--design", "gpt-5-pro"][..], &["--trust"]] {
        let (code, _, error) = run(allowed);
        assert!(code == 3 && error.contains("gpt-5-pro did not answer"), "{allowed:?}: {code} {error}");
    }
}
