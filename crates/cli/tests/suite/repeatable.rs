//! The same command gives the same bytes: for any number of threads, twice, and after a kill at any moment.

use crate::common::{FEW, Place, recrash};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// What every suite here is made of; its seed is 5 where nothing else is said.
const SMALL: [&str; 6] = ["--records", FEW, "--budget", "5", "--tune-budget", "12"];
/// By templates, and by accounts as where nothing is said.
const PROFILES: [&str; 2] = ["paper", "open"];

/// The options of a suite of this profile.
fn options<'a>(profile: &'a str, extra: &[&'a str]) -> Vec<&'a str> {
    let usual = [&SMALL[..], &["--seed", "5"]].concat();
    let is_free = |pair: &&[&str]| !extra.contains(&pair[0]);
    let usual = usual.chunks(2).filter(is_free).flatten().copied();
    usual.chain(["--profile", profile]).chain(extra.iter().copied()).collect()
}

fn run(out: &Path, profile: &str, extra: &[&str]) {
    let out = out.to_str().unwrap();
    recrash(&["run", "--quiet", "--out", out]).args(options(profile, extra)).assert().success();
}

/// A place with a suite that nobody disturbed.
fn undisturbed(profile: &str) -> Place {
    Place::made(&[&["run", "--quiet", "--threads", "2"][..], &options(profile, &[])].concat())
}

#[test]
fn one_thread_and_two_threads_write_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for profile in PROFILES {
        let (one, two) = (folder.path().join(profile), undisturbed(profile));
        run(&one, profile, &["--threads", "1"]);
        assert_same_files(&one, &two.path("suite"));
    }
}

#[test]
fn a_second_run_does_nothing_and_changes_nothing() {
    for profile in PROFILES {
        let place = undisturbed(profile);
        let out = place.path("suite");
        let before = files(&out);
        let output = recrash(&["run", "--out", out.to_str().unwrap()]).args(options(profile, &[])).assert().success();
        let shown = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
        assert_eq!(shown.matches("there already").count(), 9, "{shown}");
        assert!(files(&out) == before);
    }
}

#[test]
fn another_seed_writes_other_scenarios_and_leaves_none_of_the_old() {
    for profile in PROFILES {
        let place = undisturbed(profile);
        let (changed, fresh) = (place.path("suite"), place.path("fresh"));
        for out in [&changed, &fresh] {
            run(out, profile, &["--seed", "6"]);
        }
        assert_same_files(&changed, &fresh);
    }
}

/// Options that change a suite, each with its profile. Where other records are chosen from, the picks stay unless they are chosen anew.
const CHANGES: [(&str, &[&str]); 14] = [
    ("open", &["--budget", "3"]),
    ("open", &["--budget", "all"]),
    ("open", &["--tune-budget", "1"]),
    ("open", &["--ego", "reference"]),
    ("open", &["--aim", "severity"]),
    ("open", &["--searcher", "halton"]),
    ("open", &["--where", "road = intersection", "--reselect"]),
    ("open", &["--strategy", "k-center", "--weighting", "severity"]),
    ("paper", &["--budget", "3"]),
    ("paper", &["--ego", "idm"]),
    ("paper", &["--searcher", "halton", "--aim", "severity"]),
    ("paper", &["--dedupe", "none", "--reselect"]),
    ("paper", &["--invent"]),
    ("paper", &["--strategy", "kmeans", "--restarts", "2", "--dimensions", "3", "--template-weight", "2"]),
];

#[test]
fn a_suite_that_is_changed_by_an_option_is_the_one_that_is_made_with_it() {
    for (profile, extra) in CHANGES {
        let place = undisturbed(profile);
        let (changed, fresh) = (place.path("suite"), place.path("fresh"));
        for out in [&changed, &fresh] {
            let words = ["run", "--quiet", "--out", out.to_str().unwrap()];
            // With another ego not every scenario is true to its record.
            let output = recrash(&words).args(options(profile, extra)).output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(matches!(output.status.code(), Some(0 | 5)), "{profile} {extra:?}: {error}");
        }
        assert_same_files(&changed, &fresh);
    }
}

/// Kills the command as soon as a file is there and is not what it was, then runs it again to the end.
fn kill_when(out: &Path, profile: &str, extra: &[&str], file: &str) {
    let path = out.join(file);
    let stamp = || std::fs::metadata(&path).and_then(|is| is.modified()).ok();
    let before = stamp();
    let mut child = crate::common::plain_recrash()
        .args(["run", "--quiet", "--out", out.to_str().unwrap()])
        .args(options(profile, extra))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while stamp() == before && child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(120), "{file} never came");
        std::thread::sleep(Duration::from_micros(200));
    }
    // SIGKILL on Unix: nothing of the process runs after it.
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Moments of a run: a file of each stage.
fn moments(suite: &Path) -> Vec<String> {
    let files = files(suite);
    let is_scenario = |name: &&String| name.starts_with("4-scenarios/") && name.matches('.').count() == 1;
    let scenario = files.keys().find(is_scenario).unwrap();
    let id = scenario.trim_start_matches("4-scenarios/").trim_end_matches(".json");
    let told = files.keys().find(|name| name.starts_with(&format!("3-narratives/{id}."))).unwrap();
    let outcomes = "1-accounts.outcomes.jsonl".to_owned();
    let outcomes = files.contains_key(&outcomes).then_some(outcomes);
    let all = [
        "suite.json".to_owned(),
        "1-records.json".to_owned(),
        "2-selection.json".to_owned(),
        told.clone(),
        scenario.clone(),
        format!("5-runs/{id}.json"),
        format!("6-tuned/{id}.json"),
        "summary.json".to_owned(),
    ];
    outcomes.into_iter().chain(all).collect()
}

#[test]
fn a_run_killed_in_any_stage_goes_on_and_ends_with_the_same_bytes() {
    for profile in PROFILES {
        let folder = tempfile::tempdir().unwrap();
        let place = undisturbed(profile);
        let undisturbed = place.path("suite");
        let moments = moments(&undisturbed);
        let out = folder.path().join("killed");
        for moment in &moments {
            let _ = std::fs::remove_dir_all(&out);
            kill_when(&out, profile, &[], moment);
            run(&out, profile, &[]);
            assert_same_files(&undisturbed, &out);
        }
        // One folder killed again and again, each time a stage later.
        let _ = std::fs::remove_dir_all(&out);
        for moment in &moments {
            kill_when(&out, profile, &[], moment);
        }
        run(&out, profile, &[]);
        assert_same_files(&undisturbed, &out);
    }
}

#[test]
fn a_run_killed_while_it_makes_another_suite_of_a_suite_goes_on_as_well() {
    for profile in PROFILES {
        let place = undisturbed(profile);
        let (changed, fresh) = (place.path("suite"), place.path("fresh"));
        let extra = ["--seed", "6"];
        run(&fresh, profile, &extra);
        for moment in moments(&fresh).iter().skip_while(|moment| !moment.starts_with("3-")) {
            kill_when(&changed, profile, &extra, moment);
        }
        run(&changed, profile, &extra);
        assert_same_files(&fresh, &changed);
    }
}

#[test]
fn stages_one_by_one_give_what_run_gives() {
    let place = undisturbed("paper");
    let (whole, parts) = (place.path("suite"), place.path("parts"));
    let out = parts.to_str().unwrap();
    recrash(&["records", "--quiet", "--records", FEW, "--out", out]).assert().success();
    recrash(&["select", "--quiet", "--out", out]).args(options("paper", &[])).assert().success();
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
