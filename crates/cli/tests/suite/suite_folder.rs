//! What a suite's folder may count on: one run at a time, nothing left behind, nothing touched that is not its own.

use crate::common::Place;
use std::path::Path;

/// A place with a small suite in `suite/`, and the words that make it again.
fn small_suite(more: &[&str]) -> (Place, Vec<String>) {
    let place = Place::new();
    let words = [&["run", "--quiet", "--budget", "2", "--tune-budget", "4"], more].concat();
    let (code, _, error) = place.run(&words);
    assert_eq!(code, 0, "{error}");
    (place, words.into_iter().map(str::to_owned).collect())
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
    let command = ".json --profile mine.toml --ego metadrive-idm";
    assert_eq!(results.lines().skip(1).filter(|line| !line.ends_with(command)).count(), 0, "{results}");
}

#[test]
fn a_suite_file_that_is_no_text_is_told_like_any_damaged_one() {
    let (place, words) = small_suite(&[]);
    std::fs::write(place.path("suite/suite.json"), [0xff, 0xfe, 0x00]).unwrap();
    let (code, error) = run_again(&place, &words);
    assert_eq!(code, 3, "{error}");
    assert!(error.contains("suite.json") && error.contains("choose another --out"), "{error}");
}

#[test]
fn a_careful_ego_is_told_what_the_order_says_about_it() {
    let place = Place::new();
    let (code, shown, error) = place.run(&["run", "--ego", "reference", "--tune-budget", "2"]);
    assert_eq!(code, 0, "{error}");
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
    let sweep = std::process::Command::new(assert_cmd::cargo::cargo_bin("recrash"))
        .arg("sweep")
        .arg(root.join("crates/pipeline/benches/crossing.json"))
        .args(["-n", "1000000000", "--quiet", "--out", "rows.parquet"])
        .current_dir(place.folder())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let begun = (0..600).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        files(place.folder()) == [".rows.parquet.part"]
    });
    assert!(begun, "it does not begin");
    let told = std::process::Command::new("kill").args(["-INT", &sweep.id().to_string()]).status().unwrap();
    assert!(told.success());
    let ended = sweep.wait_with_output().unwrap();
    // Nothing of it was kept to go on with.
    assert_eq!((ended.status.code(), String::from_utf8_lossy(&ended.stderr).trim()), (Some(130), "interrupted"));
    assert_eq!(files(place.folder()), [""; 0]);
}
