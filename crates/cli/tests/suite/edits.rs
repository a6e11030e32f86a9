//! What a person did in a suite is kept, and what nobody asked for is not replaced.

use crate::common::{FEW, MISSED, Place, copy, driving_ego};
use serde_json::Value;
use std::path::PathBuf;

const THREE: [&str; 8] = ["run", "--quiet", "--records", FEW, "--budget", "3", "--tune-budget", "4"];

fn run(place: &Place, words: &[&str]) -> String {
    let (code, out, error) = place.run(words);
    assert_eq!(code, 0, "{words:?}: {error}");
    out
}

/// Files of a folder of the suite that are scenarios, narratives or runs, in order.
fn files(place: &Place, folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(place.path("suite").join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let plain = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().matches('.').count() == 1;
    let mut files: Vec<PathBuf> = entries.filter(plain).collect();
    files.sort();
    files
}

fn read(path: &PathBuf) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

fn edit(path: &PathBuf, pointer: &str, value: Value) -> Vec<u8> {
    let mut document = read(path);
    *document.pointer_mut(pointer).unwrap() = value;
    let bytes = serde_json::to_vec_pretty(&document).unwrap();
    std::fs::write(path, &bytes).unwrap();
    bytes
}

/// A target speed of the ego a little below the file's: partners still have room to start.
fn slower(path: &PathBuf) -> Value {
    (read(path)["ego"]["target_speed_mps"].as_f64().unwrap() - 0.125).into()
}

fn hash_of(run: &PathBuf) -> Value {
    read(run)["rollout"]["state_hash"].clone()
}

#[test]
fn an_edited_narrative_scenario_and_tuned_file_survive_a_run_which_goes_on_from_them() {
    let place = Place::made(&THREE);
    let (narrative, scenario, tuned) = (
        files(&place, "3-narratives")[0].clone(),
        files(&place, "4-scenarios")[1].clone(),
        files(&place, "6-tuned")[2].clone(),
    );
    let runs = (files(&place, "5-runs")[1].clone(), files(&place, "7-tuned-runs")[2].clone());
    let before = (hash_of(&runs.0), hash_of(&runs.1));
    let edited = [
        edit(&narrative, "/text", "A person wrote this.".into()),
        edit(&scenario, "/ego/target_speed_mps", slower(&scenario)),
        edit(&tuned, "/ego/target_speed_mps", slower(&tuned)),
    ];
    let page = place.path("suite/report.html");
    for _ in 0..2 {
        run(&place, &THREE);
        for (file, bytes) in [&narrative, &scenario, &tuned].into_iter().zip(&edited) {
            assert_eq!(&std::fs::read(file).unwrap(), bytes, "{}", file.display());
        }
        // The stages after them went on from the edits.
        assert_ne!(hash_of(&runs.0), before.0);
        assert_ne!(hash_of(&runs.1), before.1);
        let told = std::fs::read_to_string(place.path("suite/summary.json")).unwrap();
        let summary: Value = serde_json::from_str(&told).unwrap();
        let marked =
            summary["cases"].as_array().unwrap().iter().filter(|case| !case["edited"].as_array().unwrap().is_empty());
        assert_eq!(marked.count(), 3, "{told}");
        assert!(std::fs::read_to_string(&page).unwrap().contains("edited by hand"));
    }
    run(&place, &[&THREE[..], &["--discard-edits"]].concat());
    for (file, bytes) in [&narrative, &scenario, &tuned].into_iter().zip(&edited) {
        assert_ne!(&std::fs::read(file).unwrap(), bytes, "{}", file.display());
    }
    assert_eq!((hash_of(&runs.0), hash_of(&runs.1)), before);
}

#[test]
fn where_the_journal_is_lost_nothing_is_written_over_an_edit() {
    let made = Place::made(&THREE);
    for (said, lose) in [
        ("it is gone, though there are files in", (|path| std::fs::remove_file(path).unwrap()) as fn(&PathBuf)),
        ("it is gone, though there are files in", |path| std::fs::write(path, "").unwrap()),
        ("line 1: ", |path| std::fs::write(path, "nonsense\n").unwrap()),
        ("it is no regular file", |path| {
            std::fs::remove_file(path).unwrap();
            std::fs::create_dir(path).unwrap();
        }),
    ] {
        let place = Place::new();
        copy(made.folder(), place.folder());
        let scenario = files(&place, "4-scenarios")[0].clone();
        let bytes = edit(&scenario, "/ego/target_speed_mps", slower(&scenario));
        let journal = place.path("suite/units.jsonl");
        lose(&journal);
        let (code, _, error) = place.run(&THREE);
        assert_eq!(code, 3, "{error}");
        for words in ["units.jsonl: ", said, "edited by hand", "--discard-edits"] {
            assert!(error.contains(words), "{words}: {error}");
        }
        assert_eq!(std::fs::read(&scenario).unwrap(), bytes);
        if journal.is_file() || !journal.exists() {
            run(&place, &[&THREE[..], &["--discard-edits"]].concat());
            assert_ne!(std::fs::read(&scenario).unwrap(), bytes);
            run(&place, &THREE);
        }
    }
}

#[test]
fn a_file_in_the_place_of_one_that_no_run_wrote_is_kept() {
    let place = Place::made(&THREE);
    let scenario = files(&place, "4-scenarios")[1].clone();
    let id = scenario.file_stem().unwrap().to_string_lossy().into_owned();
    let bytes = edit(&scenario, "/ego/target_speed_mps", slower(&scenario));
    // Its lines are lost, and those of the others are not.
    let journal = place.path("suite/units.jsonl");
    let lines = std::fs::read_to_string(&journal).unwrap();
    let others: Vec<&str> = lines.lines().filter(|line| !line.contains(&format!("\"design/{id}\""))).collect();
    std::fs::write(&journal, others.join("\n") + "\n").unwrap();
    for _ in 0..2 {
        run(&place, &THREE);
        assert_eq!(std::fs::read(&scenario).unwrap(), bytes);
        let edited = read(&place.path("suite/summary.json"))["cases"].to_string();
        assert!(edited.contains(&format!("4-scenarios/{id}.json")), "{edited}");
    }
    run(&place, &[&THREE[..], &["--discard-edits"]].concat());
    assert_ne!(std::fs::read(&scenario).unwrap(), bytes);
}

#[test]
fn a_log_that_is_gone_beside_an_edit_is_told_with_the_way_out() {
    let place = Place::made(&THREE);
    let scenario = files(&place, "4-scenarios")[0].clone();
    edit(&scenario, "/ego/target_speed_mps", slower(&scenario));
    std::fs::remove_file(scenario.with_extension("design.json")).unwrap();
    let (code, _, error) = place.run(&THREE);
    assert_eq!(code, 2, "{error}");
    for words in ["design.json: ", "which was edited and is kept", "--discard-edits"] {
        assert!(error.contains(words), "{words}: {error}");
    }
    run(&place, &[&THREE[..], &["--discard-edits"]].concat());
}

#[test]
fn an_edit_that_is_no_scenario_stops_its_case_alone_and_is_kept() {
    let place = Place::made(&THREE);
    let scenario = files(&place, "4-scenarios")[0].clone();
    std::fs::write(&scenario, "{\"format\": 3").unwrap();
    let (code, _, error) = place.run(&THREE);
    assert_eq!(code, MISSED, "the others go on: {error}");
    assert!(error.contains("1 scenario could not be run; the results are written"), "{error}");
    assert_eq!(std::fs::read(&scenario).unwrap(), b"{\"format\": 3");
    let summary = read(&place.path("suite/summary.json"));
    let failures: Vec<&Value> = summary["cases"].as_array().unwrap().iter().map(|case| &case["failure"]).collect();
    assert_eq!(failures.iter().filter(|failure| !failure.is_null()).count(), 1, "{failures:?}");
}

#[test]
fn a_narrative_of_a_format_that_nobody_knows_is_told_with_both_formats() {
    let place = Place::made(&THREE);
    let narrative = files(&place, "3-narratives")[0].clone();
    edit(&narrative, "/format", "recrash.narrative/9".into());
    assert_eq!(place.run(&THREE).0, MISSED);
    let summary = read(&place.path("suite/summary.json"));
    let cases = summary["cases"].as_array().unwrap();
    let failures: Vec<String> =
        cases.iter().filter(|case| !case["failure"].is_null()).map(|case| case["failure"].to_string()).collect();
    assert_eq!(failures.len(), 1, "the others go on: {failures:?}");
    let name = narrative.file_name().unwrap().to_string_lossy();
    for words in [&name, "format: ", "recrash.narrative/9", "recrash.narrative/2"] {
        assert!(failures[0].contains(words), "{words}: {}", failures[0]);
    }
}

#[test]
fn an_edited_case_that_leaves_the_suite_leaves_its_edit_there() {
    let place = Place::made(&THREE);
    let all = files(&place, "4-scenarios");
    let edited: Vec<Vec<u8>> = all.iter().map(|file| edit(file, "/ego/target_speed_mps", slower(file))).collect();
    let (code, _, error) = place.run(&["run", "--records", FEW, "--budget", "1", "--tune-budget", "4"]);
    assert_eq!(code, 0, "{error}");
    for (file, bytes) in all.iter().zip(&edited) {
        assert_eq!(&std::fs::read(file).unwrap(), bytes, "{}", file.display());
    }
    assert!(error.contains("edited by hand, and is kept"), "{error}");
}

#[test]
fn a_run_and_a_triage_edited_by_hand_are_made_again_by_a_run_and_refused_by_a_report() {
    let place = Place::made(&THREE);
    let folder = place.path("suite/7-tuned-runs");
    let entries = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let triage = entries.filter(|path| path.to_string_lossy().ends_with(".triage.json")).min().unwrap();
    let edits = [
        (files(&place, "7-tuned-runs")[0].clone(), "/judgement/findings", serde_json::json!([])),
        (triage, "/others", serde_json::json!([])),
    ];
    for (file, pointer, value) in edits {
        let made = std::fs::read(&file).unwrap();
        edit(&file, pointer, value);
        let (code, _, error) = place.run(&["report", "--quiet"]);
        assert_eq!(code, 2, "{error}");
        assert!(error.contains("changed by hand") && error.contains("recrash triage"), "{error}");
        run(&place, &THREE);
        assert_eq!(std::fs::read(&file).unwrap(), made, "{}", file.display());
    }
}

#[test]
fn a_report_right_after_an_edit_of_a_tuned_file_is_refused_and_shows_no_old_run() {
    let place = Place::made(&THREE);
    let tuned = files(&place, "6-tuned")[0].clone();
    edit(&tuned, "/ego/target_speed_mps", slower(&tuned));
    let page = std::fs::read(place.path("suite/report.html")).unwrap();
    let (code, _, error) = place.run(&["report", "--quiet"]);
    assert_eq!(code, 2, "{error}");
    assert!(error.contains("recrash triage"), "{error}");
    assert_eq!(std::fs::read(place.path("suite/report.html")).unwrap(), page);
}

#[test]
fn a_suite_of_other_records_or_of_another_profile_is_replaced_only_when_told() {
    let sample = ["run", "--quiet", "--budget", "3", "--tune-budget", "4"];
    let place = Place::made(&sample);
    std::fs::copy(FEW, place.path("mine.csv")).unwrap();
    let profile = include_str!("../../../../profiles/paper.toml").replace("name = \"paper\"", "name = \"other\"");
    std::fs::write(place.path("other.toml"), profile).unwrap();
    let saved = std::fs::read(place.path("suite/suite.json")).unwrap();
    for more in [["--records", "mine.csv"], ["--profile", "other.toml"]] {
        let words = [&sample[..], &more].concat();
        let (code, _, error) = place.run(&words);
        assert_eq!(code, 2, "{error}");
        assert!(error.contains("--replace"), "{error}");
        assert_eq!(std::fs::read(place.path("suite/suite.json")).unwrap(), saved);
    }
    run(&place, &[&sample[..], &["--records", "mine.csv", "--replace"]].concat());
    // And back: real records are not replaced by the sample either.
    let (code, _, error) = place.run(&sample);
    assert_eq!(code, 2, "{error}");
    // A second file beside the first is welcome.
    std::fs::copy(FEW, place.path("more.csv")).unwrap();
    run(&place, &[&sample[..], &["--records", "mine.csv", "--records", "more.csv"]].concat());
}

#[test]
fn one_row_more_keeps_the_ids_and_all_but_a_few_units() {
    let place = Place::new();
    let text = std::str::from_utf8(recrash_records::SAMPLE_CSV.as_bytes()).unwrap();
    std::fs::write(place.path("a.csv"), text).unwrap();
    let words = ["run", "--quiet", "--records", "a.csv", "--tune-budget", "4"];
    run(&place, &words);
    let units = || std::fs::read_to_string(place.path("suite/units.jsonl")).unwrap().lines().count();
    let (ids, before) = (files(&place, "4-scenarios"), units());
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.unwrap()).collect();
    let at = |name: &str| rows[0].iter().position(|column| column == name).unwrap();
    // A record of the largest group: in a small one it would be somebody to tell in place of the pick.
    let selection = read(&place.path("suite/2-selection.json"));
    let groups = selection["clusters"].as_array().unwrap().iter();
    let largest = groups.max_by_key(|group| group["members"].as_array().unwrap().len()).unwrap();
    let picked = largest["scenario_id"].as_str().unwrap().to_owned();
    let (report, incident) = (at("Report ID"), at("Same Incident ID"));
    let twin = rows[1..].iter().find(|row| picked.contains(&row[report])).unwrap();
    let new: csv::StringRecord = twin
        .iter()
        .enumerate()
        .map(|(column, cell)| match column {
            _ if column == report => "99999-1",
            _ if column == incident => "another incident",
            _ => cell,
        })
        .collect();
    let mut writer = csv::WriterBuilder::new().flexible(true).from_path(place.path("a.csv")).unwrap();
    for row in std::iter::once(&rows[0]).chain([&new]).chain(&rows[1..]) {
        writer.write_record(row).unwrap();
    }
    writer.flush().unwrap();
    run(&place, &words);
    assert_eq!(files(&place, "4-scenarios"), ids);
    let again = units() - before;
    assert!(again * 20 <= before, "{again} of {before} units were made again");
}

#[test]
fn a_changed_ego_script_gives_new_results() {
    let place = Place::new();
    let script = |speed_mps: f64| std::fs::write(place.path("ego.py"), driving_ego(speed_mps)).unwrap();
    let words = ["run", "--quiet", "--budget", "1", "--tune-budget", "1", "--ego", "cmd:python3 ego.py"];
    // Whether it shows what the record tells is another question.
    let run = || assert!([0, MISSED].contains(&place.run(&words).0));
    script(5.0);
    run();
    let first = files(&place, "5-runs");
    let before: Vec<Value> = first.iter().map(hash_of).collect();
    run();
    assert_eq!(first.iter().map(hash_of).collect::<Vec<_>>(), before);
    script(8.0);
    run();
    assert_ne!(first.iter().map(hash_of).collect::<Vec<_>>(), before);
}
