//! The same command gives the same bytes: for any number of threads, twice, and after a kill at any moment.

use crate::common::{FEW, Place, recrash};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

const SMALL: [&str; 8] = ["--records", FEW, "--budget", "5", "--tune-budget", "12", "--seed", "5"];

fn run(out: &Path, extra: &[&str]) {
    let out = out.to_str().unwrap();
    recrash(&["run", "--quiet", "--out", out]).args(SMALL).args(extra).assert().success();
}

/// A place with a suite that nobody disturbed.
fn undisturbed() -> Place {
    Place::made(&[&["run", "--quiet", "--threads", "2"], &SMALL[..]].concat())
}

#[test]
fn one_thread_and_two_threads_write_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (one, two) = (folder.path().join("one"), undisturbed());
    run(&one, &["--threads", "1"]);
    assert_same_files(&one, &two.path("suite"));
}

#[test]
fn a_second_run_does_nothing_and_changes_nothing() {
    let place = undisturbed();
    let out = place.path("suite");
    let before = files(&out);
    let output = recrash(&["run", "--out", out.to_str().unwrap()]).args(SMALL).assert().success();
    let shown = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    assert_eq!(shown.matches("there already").count(), 9, "{shown}");
    assert!(files(&out) == before);
}

#[test]
fn another_seed_writes_other_scenarios_and_leaves_none_of_the_old() {
    let place = undisturbed();
    let (changed, fresh) = (place.path("suite"), place.path("fresh"));
    for out in [&changed, &fresh] {
        let other = ["--records", FEW, "--budget", "4", "--tune-budget", "24", "--seed", "6"];
        recrash(&["run", "--quiet", "--out", out.to_str().unwrap()]).args(other).assert().success();
    }
    assert_same_files(&changed, &fresh);
}

/// Kills the command as soon as a file is there, then runs it again to the end.
fn kill_when(out: &Path, file: &str) {
    let mut child = crate::common::plain_recrash()
        .args(["run", "--quiet", "--out", out.to_str().unwrap()])
        .args(SMALL)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !out.join(file).exists() && child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(120), "{file} never came");
        std::thread::sleep(Duration::from_micros(200));
    }
    // SIGKILL on Unix: nothing of the process runs after it.
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_run_killed_in_any_stage_goes_on_and_ends_with_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let place = undisturbed();
    let undisturbed = place.path("suite");
    let narrative = files(&undisturbed).keys().find(|name| name.starts_with("3-narratives/")).unwrap().clone();
    let id = narrative.trim_start_matches("3-narratives/").trim_end_matches(".json").to_owned();
    let moments = [
        "suite.json".to_owned(),
        "1-records.json".to_owned(),
        "2-selection.json".to_owned(),
        narrative,
        format!("4-scenarios/{id}.json"),
        format!("5-runs/{id}.json"),
        format!("6-tuned/{id}.json"),
        "summary.json".to_owned(),
    ];
    let out = folder.path().join("killed");
    for moment in &moments {
        let _ = std::fs::remove_dir_all(&out);
        kill_when(&out, moment);
        run(&out, &[]);
        assert_same_files(&undisturbed, &out);
    }
    // One folder killed again and again, each time a stage later.
    let _ = std::fs::remove_dir_all(&out);
    for moment in &moments {
        kill_when(&out, moment);
    }
    run(&out, &[]);
    assert_same_files(&undisturbed, &out);
}

#[test]
fn stages_one_by_one_give_what_run_gives() {
    let place = undisturbed();
    let (whole, parts) = (place.path("suite"), place.path("parts"));
    let out = parts.to_str().unwrap();
    recrash(&["records", "--quiet", "--records", FEW, "--out", out]).assert().success();
    recrash(&["select", "--quiet", "--out", out]).args(SMALL).assert().success();
    for stage in ["narrate", "design", "simulate", "tune", "report"] {
        recrash(&[stage, "--quiet", out]).assert().success();
    }
    assert_same_files(&whole, &parts);
}

/// Every file below a folder, with its content.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(&next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                // When and in which order units were done is of this disk, and no result.
                if name == "units.jsonl" {
                    continue;
                }
                all.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    all
}

/// Asserts that two folders hold the same files with the same bytes, and names the first that differs.
fn assert_same_files(left: &Path, right: &Path) {
    let (left, right) = (files(left), files(right));
    assert_eq!(left.keys().collect::<Vec<_>>(), right.keys().collect::<Vec<_>>());
    for (name, content) in &left {
        assert!(right[name] == *content, "{name} differs");
    }
}
