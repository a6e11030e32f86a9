//! What commands write outside a suite: never in the place of something that is read, of another output or of a device.

use crate::common::{Place, SMALL};
use recrash_records::SAMPLE_CSV;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Input that cannot be used.
const BAD_INPUT: i32 = 3;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/cli").to_owned()
}

/// An ego that drives on at 6 m/s.
const EGO: &str = r#"
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "step":
        answer = {"type": "control", "throttle": 0.3 if message["ego"]["speed"] < 6.0 else 0.0, "steer": 0.0}
    else:
        answer = {"type": "ready", "protocol": "recrash.ego/1"}
    if message["type"] != "end":
        print(json.dumps(answer), flush=True)
"#;

/// A place with every kind of input, and a small suite.
fn place() -> Place {
    let place = Place::made(&SMALL);
    let crossing = std::fs::read(repository().join("crates/pipeline/benches/crossing.json")).unwrap();
    std::fs::write(place.path("a.json"), crossing).unwrap();
    std::fs::write(place.path("a.csv"), SAMPLE_CSV).unwrap();
    std::fs::write(place.path("ego.py"), EGO).unwrap();
    std::fs::write(place.path("map.toml"), include_str!("../../../../docs/mappings/crss.toml")).unwrap();
    std::fs::write(place.path("mine.toml"), include_str!("../../../../profiles/paper.toml")).unwrap();
    std::fs::create_dir(place.path("sub")).unwrap();
    std::fs::rename(place.path("suite"), place.path("s")).unwrap();
    place
}

/// Every file of a folder with its content; links as what they point to.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if entry.file_type().unwrap().is_dir() {
            all.extend(contents(&path));
        } else {
            all.insert(path.clone(), std::fs::read(&path).unwrap_or_default());
        }
    }
    all
}

#[test]
fn an_output_never_replaces_an_input_or_another_output() {
    let place = place();
    std::fs::hard_link(place.path("a.csv"), place.path("hard.csv")).unwrap();
    std::fs::create_dir_all(place.path("exports/scenic")).unwrap();
    std::fs::hard_link(place.path("a.json"), place.path("exports/scenic/bench-crossing.scenic")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("a.csv", place.path("soft.csv")).unwrap();
    let absolute = place.path("a.csv").display().to_string();
    let narrated = std::fs::read_dir(place.path("s/3-narratives")).unwrap().map(|entry| entry.unwrap().file_name());
    let mut ids: Vec<String> =
        narrated.map(|name| name.to_string_lossy().split('.').next().unwrap().to_owned()).collect();
    ids.sort();
    let tuned = format!("s/6-tuned/{}.json", ids[0]);
    let tuned = tuned.as_str();
    assert!(place.path(tuned).exists());
    let mut forms: Vec<Vec<&str>> = vec![
        vec!["records", "a.csv", "--csv", "a.csv"],
        vec!["records", "a.csv", "--csv", "./a.csv"],
        vec!["records", "a.csv", "--csv", "sub/../a.csv"],
        vec!["records", "a.csv", "--csv", &absolute],
        vec!["records", "a.csv", "--csv", "hard.csv"],
        vec!["records", "--records", "hard.csv", "--csv", "a.csv"],
        vec!["records", "a.csv", "--profile", "mine.toml", "--csv", "mine.toml"],
        vec!["records", "a.csv", "--mapping", "map.toml", "--csv", "map.toml"],
        vec!["records", "a.csv", "--out", "s", "--csv", "s/suite.json"],
        vec!["simulate", "a.json", "--rollout", "a.json"],
        vec!["simulate", "a.json", "--profile", "mine.toml", "--rollout", "mine.toml"],
        vec!["simulate", "a.json", "--ego", "cmd:python3 ego.py", "--rollout", "ego.py"],
        vec!["import", "a.json", "--force", "--out", "sub/../a.json"],
        vec!["export", "a.json", "--to", "scenic", "--force"],
    ];
    #[cfg(unix)]
    forms.push(vec!["records", "a.csv", "--csv", "soft.csv"]);
    #[cfg(feature = "parquet")]
    forms.extend([
        vec!["records", "a.csv", "--parquet", "a.csv"],
        vec!["records", "a.csv", "--csv", "new", "--parquet", "new"],
        vec!["records", "a.csv", "--csv", "new", "--parquet", "sub/../new"],
        vec!["sweep", "a.json", "-n", "2", "--out", "a.json"],
        vec!["sweep", "a.json", "-n", "2", "--rollout", "1", "--out", "./a.json"],
        vec!["sweep", "s", "-n", "2", "--out", "s/suite.json"],
        vec!["sweep", "s", "-n", "2", "--out", tuned],
        vec!["sweep", "a.json", "-n", "2", "--profile", "mine.toml", "--out", "mine.toml"],
    ]);
    let before = contents(place.folder());
    for form in &forms {
        let (code, _, error) = place.run(form);
        assert_eq!(code, BAD_INPUT, "{form:?}: {error}");
        let target = form.iter().rev().find(|word| !word.starts_with('-')).unwrap();
        let told = if form[0] == "export" { "exports/scenic/bench-crossing.scenic" } else { target };
        let why = ["is read", "as well"].iter().any(|why| error.contains(why));
        assert!(error.contains(told) && why && error.contains("name "), "{form:?}: {error}");
        assert!(contents(place.folder()) == before, "{form:?} has changed a file");
    }
    assert!(forms.len() >= 14);
}

#[test]
fn other_files_are_replaced_and_links_are_followed() {
    let place = place();
    std::fs::write(place.path("old.csv"), "old").unwrap();
    let (code, _, error) = place.run(&["records", "a.csv", "--csv", "old.csv"]);
    assert_eq!(code, 0, "{error}");
    let table = std::fs::read(place.path("old.csv")).unwrap();
    assert!(table.starts_with(b"report,"));
    let (code, _, error) = place.run(&["simulate", "a.json", "--rollout", "rollout.json"]);
    assert_eq!(code, 0, "{error}");
    #[cfg(unix)]
    {
        std::fs::write(place.path("sub/real.csv"), "old").unwrap();
        std::os::unix::fs::symlink("sub/real.csv", place.path("link.csv")).unwrap();
        let (code, _, error) = place.run(&["records", "a.csv", "--csv", "link.csv"]);
        assert_eq!(code, 0, "{error}");
        assert!(std::fs::read(place.path("sub/real.csv")).unwrap() == table);
        assert!(std::fs::symlink_metadata(place.path("link.csv")).unwrap().is_symlink());
    }
}

#[test]
#[cfg(target_os = "linux")]
fn devices_and_fifos_are_written_to_and_stay_what_they_are() {
    use std::os::unix::fs::FileTypeExt;
    let place = place();
    let fifo = place.path("fifo");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    // A link to the device: where something replaces it after all, the machine keeps its own.
    std::os::unix::fs::symlink("/dev/null", place.path("null")).unwrap();
    let forms: [&[&str]; 4] = [
        &["records", "a.csv", "--csv", "fifo"],
        &["simulate", "a.json", "--rollout", "fifo"],
        &["import", "a.json", "--out", "fifo"],
        #[cfg(feature = "parquet")]
        &["sweep", "a.json", "-n", "10", "--out", "fifo"],
        #[cfg(not(feature = "parquet"))]
        &["records", "a.csv", "--csv", "fifo"],
    ];
    for form in forms {
        let reader = std::thread::spawn({
            let fifo = fifo.clone();
            move || std::fs::read(fifo).unwrap()
        });
        let (code, _, error) = place.run(form);
        assert_eq!(code, 0, "{form:?}: {error}");
        assert!(std::fs::metadata(&fifo).unwrap().file_type().is_fifo(), "{form:?}");
        assert!(reader.join().unwrap().len() > 500, "{form:?}");
        let null: Vec<&str> = form.iter().map(|word| if *word == "fifo" { "null" } else { word }).collect();
        let (code, _, error) = place.run(&null);
        assert_eq!(code, 0, "{form:?}: {error}");
        assert!(std::fs::symlink_metadata(place.path("null")).unwrap().is_symlink(), "{form:?}");
    }
    let (code, shown, error) = place.run(&["records", "a.csv", "--quiet", "--csv", "/dev/stdout"]);
    assert_eq!(code, 0, "{error}");
    assert!(shown.starts_with("report,") && shown.lines().count() > 88, "{shown}");
}

#[test]
#[cfg(target_os = "linux")]
fn paths_that_are_no_text_work_or_are_refused_with_a_word() {
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;
    let place = place();
    let odd = |name: &[u8]| -> OsString { OsStr::from_bytes(&[b"odd-\xff-", name].concat()).to_owned() };
    for name in ["a.csv", "a.json", "map.toml"] {
        std::fs::copy(place.path(name), place.folder().join(odd(name.as_bytes()))).unwrap();
    }
    let run = |words: &[&str]| {
        let mut command = crate::common::recrash(&[]);
        command.current_dir(place.folder());
        for word in words {
            command.arg(word.strip_prefix("odd-").map_or_else(|| word.into(), |name| odd(name.as_bytes())));
        }
        let output = command.output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!error.contains("panicked"), "{words:?}: {error}");
        (output.status.code().unwrap(), output.stdout, error)
    };
    let kept = ["--budget", "2", "--tune-budget", "1", "--out", "kept"];
    let refused: [&[&str]; 3] =
        [&["--records", "odd-a.csv"], &["--mapping", "odd-map.toml"], &["--model-dir", "odd-dir"]];
    for options in refused {
        let (code, _, error) = run(&[&["run"], options, &kept].concat());
        assert_eq!(code, BAD_INPUT, "{options:?}: {error}");
        assert!(error.contains("not UTF-8") && error.contains("rename it"), "{options:?}: {error}");
        assert!(!place.path("kept").exists(), "{options:?}");
    }
    let works: [&[&str]; 7] = [
        &["records", "odd-a.csv", "--csv", "odd-b.csv"],
        &["simulate", "odd-a.json", "--rollout", "odd-b.json"],
        &["import", "odd-a.json", "--force", "--out", "odd-c.json"],
        &["export", "odd-a.json", "--to", "scenic", "--to-dir", "odd-exports"],
        &["run", "--budget", "2", "--tune-budget", "1", "--out", "odd-suite"],
        &["doctor", "--model-dir", "odd-dir", "--python", "odd-python"],
        #[cfg(feature = "parquet")]
        &["sweep", "odd-a.json", "-n", "2", "--out", "odd-d"],
        #[cfg(not(feature = "parquet"))]
        &["records", "odd-a.csv"],
    ];
    for words in works {
        let (code, shown, error) = run(&[words, &["--json"]].concat());
        assert_eq!(code, 0, "{words:?}: {error}");
        serde_json::from_slice::<serde_json::Value>(&shown).unwrap_or_else(|e| panic!("{words:?}: {e}"));
    }
    let elsewhere: [&[&str]; 7] = [
        &["model", "show", "--python", "odd-python", "--json"],
        &["eval", "--agent", "rules", "--records", "odd-a.csv", "--labels", "odd-labels", "--out", "odd-eval"],
        &["fetch", "--base-url", "http://127.0.0.1:1", "--cache", "odd-cache"],
        &["ledger", "odd-nowhere"],
        &["parity", "odd-nowhere"],
        &["prompt", "design", "--out", "odd-nowhere"],
        &["bench", "embed", "--model-dir", "odd-dir"],
    ];
    for words in elsewhere {
        run(words);
    }
}
