//! What a suite's folder may count on: one run at a time, nothing left behind, nothing touched that is not its own.

use crate::common::{MISSED, Place, SMALL, TOLD, driving_ego, plain_recrash};
use std::path::Path;

/// A place with a small suite in `suite/`, and the words that make it again.
fn small_suite(more: &[&str]) -> (Place, Vec<String>) {
    let words = [&SMALL, more].concat();
    (Place::made(&words), words.into_iter().map(str::to_owned).collect())
}

fn run_again(place: &Place, words: &[String]) -> (i32, String) {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (code, _, error) = place.run(&words);
    (code, error)
}

#[test]
#[cfg(unix)]
fn a_second_run_in_the_folder_is_told_to_wait() {
    let (place, words) = small_suite(&[]);
    let folder = std::fs::File::open(place.path("suite")).unwrap();
    folder.lock().unwrap();
    let (code, error) = run_again(&place, &words);
    assert_eq!(code, 1, "{error}");
    assert!(error.contains("another recrash is at work in suite"), "{error}");
    let (code, _, error) = place.run(&["prompt", "paraphrase", "--quiet"]);
    assert_eq!(code, 0, "reading is no work: {error}");
    drop(folder);
    assert_eq!(run_again(&place, &words), (0, String::new()));
}

#[test]
fn a_prompt_is_shown_and_nothing_is_written() {
    let (place, _) = small_suite(&[]);
    let file = place.path("suite/suite.json");
    let edited = std::fs::read_to_string(&file).unwrap() + "\n\n";
    std::fs::write(&file, &edited).unwrap();
    let (code, _, error) = place.run(&["prompt", "design"]);
    assert_eq!(code, 0, "{error}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), edited);
}

#[test]
#[cfg(unix)]
fn what_a_killed_run_left_is_removed_and_nothing_else() {
    let (place, words) = small_suite(&[]);
    let beside = place.path("beside");
    std::fs::create_dir(&beside).unwrap();
    std::fs::write(beside.join(".recrash-mine"), "precious").unwrap();
    std::os::unix::fs::symlink(&beside, place.path("suite/linked")).unwrap();
    std::fs::create_dir(place.path("suite/.recrash-folder")).unwrap();
    std::fs::write(place.path("suite/6-tuned/.recrash-left"), "half").unwrap();
    assert_eq!(run_again(&place, &words), (0, String::new()));
    assert!(!place.path("suite/6-tuned/.recrash-left").exists());
    assert!(beside.join(".recrash-mine").exists() && place.path("suite/.recrash-folder").exists());
}

#[test]
fn a_folder_that_is_refused_stays_as_it_was() {
    let place = Place::new();
    let folder = place.path("mine");
    std::fs::create_dir_all(folder.join("deeper")).unwrap();
    let names = [".recrash-notes", ".recrash-rows.parquet.part", "notes.txt", "deeper/.recrash-notes"];
    names.iter().for_each(|name| std::fs::write(folder.join(name), "precious").unwrap());
    let words = [&SMALL[..], &["--out", "mine"]].concat();
    let (code, _, error) = place.run(&words);
    assert!(code == 2 && error.contains("holds files but no suite.json"), "{error}");
    assert!(names.iter().all(|name| folder.join(name).is_file()));
    // What is being written there is no reason to refuse it, and is left alone.
    ["notes.txt", "deeper/.recrash-notes"].iter().for_each(|name| std::fs::remove_file(folder.join(name)).unwrap());
    std::fs::remove_dir(folder.join("deeper")).unwrap();
    let (code, _, error) = place.run(&words);
    assert_eq!(code, 0, "{error}");
    assert!(names[..2].iter().all(|name| folder.join(name).is_file()));
}

#[test]
fn what_a_killed_export_left_is_removed_and_is_no_file_to_keep() {
    let (place, _) = small_suite(&[]);
    let folder = place.path("suite/exports/scenic");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(".recrash-left"), "half").unwrap();
    let (code, _, error) = place.run(&["export", "suite", "--to", "scenic", "--quiet"]);
    assert_eq!(code, 0, "{error}");
    assert!(!folder.join(".recrash-left").exists());
}

#[test]
fn the_command_that_runs_a_scenario_again_names_its_profile() {
    let place = Place::new();
    let paper = include_str!("../../../../profiles/paper.toml");
    std::fs::write(place.path("mine.toml"), paper.replace("min_gap_m = 2.0", "min_gap_m = 0.5")).unwrap();
    let (code, _, error) =
        place.run(&["run", "--quiet", "--budget", "2", "--tune-budget", "4", "--profile", "mine.toml"]);
    assert_eq!(code, 0, "{error}");
    let results = std::fs::read_to_string(place.path("suite/results.csv")).unwrap();
    let command = ".json --profile ../mine.toml --ego metadrive-idm";
    assert!(column(&results, "command").iter().all(|line| line.ends_with(command)), "{results}");
    assert_eq!(hashes_of_reruns(&place, &results), hashes(&results));
}

/// The state hashes of a table of results.
fn hashes(results: &str) -> Vec<String> {
    column(results, "state_hash")
}

fn column(results: &str, name: &str) -> Vec<String> {
    let mut table = csv::Reader::from_reader(results.as_bytes());
    let at = table.headers().unwrap().iter().position(|header| header == name).unwrap();
    table.records().map(|row| row.unwrap()[at].to_owned()).collect()
}

/// Runs every command of a table of results again, in the suite's folder as a shell would; gives the state hashes.
fn hashes_of_reruns(place: &Place, results: &str) -> Vec<String> {
    let program = assert_cmd::cargo::cargo_bin("recrash");
    let run = |command: String| {
        let command = command.replacen("recrash", &format!("'{}'", program.display()), 1) + " --json";
        let output = std::process::Command::new("sh").args(["-c", &command]).current_dir(place.path("suite")).output();
        let output = output.unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        let run: serde_json::Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{command}: {e} {error}"));
        run["rollout"]["state_hash"].as_str().unwrap().to_owned()
    };
    column(results, "command").into_iter().map(run).collect()
}

#[test]
#[cfg(unix)]
fn the_command_that_runs_a_scenario_again_finds_an_ego_by_its_relative_path() {
    let place = Place::new();
    std::fs::create_dir(place.path("my egos")).unwrap();
    std::fs::write(place.path("my egos/steady.py"), driving_ego(6.0)).unwrap();
    let program = "cmd:python3 'my egos/steady.py'";
    let (code, _, error) = place.run(&["run", "--quiet", "--budget", "2", "--tune-budget", "2", "--ego", program]);
    assert!([0, MISSED].contains(&code), "{error}");
    let results = std::fs::read_to_string(place.path("suite/results.csv")).unwrap();
    assert_eq!(hashes_of_reruns(&place, &results), hashes(&results));
}

#[test]
#[cfg(unix)]
fn nor_does_it_lose_an_ego_that_is_a_module_or_a_file_of_pythons() {
    let place = crate::egos::python_place(6.0);
    std::fs::write(place.path("mine.py"), "from my_stack import drive\n").unwrap();
    for ego in ["py:my_stack:drive", "py:mine:drive", "py:mine.py:drive"] {
        let (code, _, error) = place.run(&["run", "--quiet", "--budget", "1", "--tune-budget", "1", "--ego", ego]);
        assert!([0, MISSED].contains(&code), "{error}");
        let results = std::fs::read_to_string(place.path("suite/results.csv")).unwrap();
        assert_eq!(hashes_of_reruns(&place, &results), hashes(&results), "{ego}");
    }
}

#[test]
fn a_run_that_is_not_true_to_its_record_is_told_by_the_exit_code() {
    let (place, _) = small_suite(&[]);
    let (code, shown, error) = place.run(&["simulate", "suite"]);
    assert_eq!(code, 0, "a folder is a suite: {error}");
    assert!(shown.contains("simulate: 0 units done, 2 there already, in suite\nnext: recrash tune suite\n"), "{shown}");
    std::fs::write(place.path("stand.py"), driving_ego(0.0)).unwrap();
    let standing = ["--ego", "cmd:python3 stand.py"];
    let (code, _, error) = place.run(&[&["simulate", "suite"], &standing[..]].concat());
    assert_eq!(code, MISSED, "{error}");
    for words in ["2 scenarios are not true to the records they tell", "scenario.unfaithful", "intersection-"] {
        assert!(error.contains(words), "{words}: {error}");
    }
    let (code, told, _) = place.run(&[&["simulate", "--json"], &standing[..]].concat());
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    assert_eq!((code, told["unfaithful"].as_array().map(Vec::len)), (MISSED, Some(2)), "{told}");
    let (code, _, error) = place.run(&[&["tune", "--tune-budget", "1"], &standing[..]].concat());
    assert_eq!(code, MISSED, "{error}");
    let (code, _, error) = place.run(&["simulate", "suite", "--rollout", "x.json"]);
    assert_eq!(code, 2, "{error}");
    assert!(error.contains("suite is a folder"), "{error}");
    for option in [&["--budget", "3"][..], &["--tune-budget", "9"], &["--out", "elsewhere"], &["--reselect"]] {
        let (code, _, error) = place.run(&[&["simulate", "x.json"], option].concat());
        assert_eq!(code, 2, "{option:?}: {error}");
        assert!(error.contains("x.json is one scenario file"), "{error}");
    }
}

#[test]
fn a_stage_makes_no_suite_where_there_is_none() {
    let place = Place::new();
    for stage in ["narrate", "design", "simulate", "tune", "report", "ledger", "export --to scenic"] {
        let mut words: Vec<&str> = stage.split(' ').collect();
        match words[0] {
            "ledger" | "export" => words.insert(1, "siute"),
            _ => words.extend(["--out", "siute"]),
        }
        let (code, _, error) = place.run(&words);
        assert!(matches!(code, 1..=3), "{stage}: {error}");
        assert!(error.contains("siute"), "{stage}: {error}");
        assert!(!place.path("siute").exists(), "{stage} has made the folder");
        if words.contains(&"--out") {
            assert!(
                error.contains("there is no suite in siute") && error.contains("recrash run --out siute"),
                "{stage}: {error}"
            );
        }
    }
}

#[test]
fn a_missing_input_has_the_exit_code_that_the_help_tells() {
    let place = Place::new();
    let (_, help, _) = place.run(&["--help"]);
    let told = help.split("Exit codes:").nth(1).unwrap();
    let told = told.split("\n\n").next().unwrap().replace("\n", " ");
    assert!(told.contains("3 the input is not there or cannot be used"), "{told}");
    std::fs::write(place.path("map.toml"), include_str!("../../../../docs/mappings/crss.toml")).unwrap();
    let missing: [&[&str]; 7] = [
        &["records", "nowhere.csv"],
        &["records", "--mapping", "nowhere.toml"],
        &["records", "--profile", "nowhere.toml"],
        &["simulate", "nowhere.json"],
        &["import", "nowhere.json"],
        &["export", "nowhere.json", "--to", "scenic"],
        &["eval", "--labels", "nowhere.csv"],
    ];
    for words in missing {
        let (code, _, error) = place.run(words);
        assert_eq!(code, 3, "{words:?}: {error}");
    }
}

#[test]
fn a_suite_file_that_is_no_text_is_told_like_any_damaged_one() {
    let (place, words) = small_suite(&[]);
    std::fs::write(place.path("suite/suite.json"), [0xff, 0xfe, 0x00]).unwrap();
    let (code, error) = run_again(&place, &words);
    assert_eq!(code, 3, "{error}");
    assert!(error.contains("suite.json") && error.contains("choose another folder"), "{error}");
}

#[test]
fn a_careful_ego_is_told_what_the_order_says_about_it() {
    let place = Place::new();
    let (code, shown, error) = place.run(&["run", "--ego", "reference", "--tune-budget", "2"]);
    assert_eq!(code, MISSED, "{error}");
    assert_eq!(shown.matches("Who comes first is up to the ego as well").count(), 1, "{shown}");
    let cases = std::fs::read_dir(place.path("suite/report")).unwrap();
    let mut texts = cases.map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap());
    assert!(texts.any(|text| text.contains("Who comes first is up to the ego as well")));
}

/// The files of a folder, hidden ones too.
fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

#[test]
#[cfg(all(unix, feature = "parquet"))]
fn an_interrupted_sweep_leaves_nothing_behind() {
    let place = Place::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let sweep = crate::common::plain_recrash()
        .arg("sweep")
        .arg(root.join("crates/pipeline/benches/crossing.json"))
        .args(["-n", "1000000000", "--quiet", "--out", "rows.parquet"])
        .current_dir(place.folder())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let begun = (0..600).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        files(place.folder()) == [".recrash-rows.parquet.part"]
    });
    assert!(begun, "it does not begin");
    let told = std::process::Command::new("kill").args(["-INT", &sweep.id().to_string()]).status().unwrap();
    assert!(told.success());
    let ended = sweep.wait_with_output().unwrap();
    // Nothing of it was kept to go on with.
    assert_eq!((ended.status.code(), String::from_utf8_lossy(&ended.stderr).trim()), (Some(130), "interrupted"));
    assert_eq!(files(place.folder()), [""; 0]);
}

#[test]
fn a_crash_file_that_cannot_be_read_leaves_no_suite_behind() {
    let place = Place::new();
    std::fs::write(place.path("wrong.csv"), "a,b\n1,2\n").unwrap();
    for wrong in ["nope.csv", "wrong.csv"] {
        let (code, _, error) = place.run(&["run", "--quiet", "--records", wrong]);
        assert!(code != 0 && error.contains(wrong), "{error}");
        assert!(!place.path("suite").exists(), "{wrong}");
    }
    let (code, _, error) = place.run(&["records", "--quiet", "--out", "suite"]);
    assert_eq!(code, 0, "the corrected command goes: {error}");
    // A suite that is there stays as it is.
    let before = std::fs::read(place.path("suite/suite.json")).unwrap();
    let (code, _, _) = place.run(&["run", "--quiet", "--replace", "--records", "nope.csv"]);
    assert_ne!(code, 0);
    assert!(std::fs::read(place.path("suite/suite.json")).unwrap() == before);
}

#[test]
fn the_report_takes_the_folder_as_other_commands_do() {
    let (place, _) = small_suite(&[]);
    std::fs::rename(place.path("suite"), place.path("other")).unwrap();
    let (code, _, error) = place.run(&["report", "other", "--quiet"]);
    assert_eq!(code, 0, "{error}");
    assert_eq!(place.run(&["report", "other", "--out", "suite"]).0, 2);
}

/// What a run writes is told by the system, of a shell and of the programs that it waited for.
#[cfg(target_os = "linux")]
#[test]
fn a_run_writes_at_most_three_times_the_bytes_of_its_suite() {
    fn held(folder: &std::path::Path) -> u64 {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
        entries
            .map(|entry| if entry.path().is_dir() { held(&entry.path()) } else { entry.metadata().unwrap().len() })
            .sum()
    }
    for (words, more) in [(&SMALL[..], &["--profile", "paper"][..]), (&TOLD[..], &[][..])] {
        let place = Place::new();
        let recrash = plain_recrash();
        let output = std::process::Command::new("sh")
            .args(["-c", "\"$@\" >&2 && grep wchar /proc/$$/io", "sh"])
            .arg(recrash.get_program())
            .args(words)
            .args(more)
            .current_dir(place.folder())
            .output()
            .unwrap();
        let (told, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let written: u64 =
            told.trim().strip_prefix("wchar: ").unwrap_or_else(|| panic!("{told}{error}")).parse().unwrap();
        let held = held(&place.path("suite"));
        assert!(held <= written && written <= 3 * held, "{words:?}: {written} bytes written, {held} held");
    }
}
