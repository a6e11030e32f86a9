//! Suites that go by accounts, as a user of them meets them.

use crate::common::{Place, TOLD};
use serde_json::Value;

fn json(place: &Place, file: &str) -> Value {
    serde_json::from_slice(&std::fs::read(place.path(file)).unwrap()).unwrap()
}

fn cases(place: &Place) -> Vec<Value> {
    json(place, "suite/summary.json")["cases"].as_array().unwrap().clone()
}

#[test]
fn every_case_shows_its_own_crash_and_says_whether_the_system_met_it() {
    let place = Place::made(&["run", "--profile", "open", "--budget", "12", "--tune-budget", "6", "--seed", "3"]);
    let summary = json(&place, "suite/summary.json");
    let accounts = &summary["accounts"];
    let (told, readable) = (accounts["told"].as_u64().unwrap(), accounts["readable"].as_u64().unwrap());
    let untold: u64 = accounts["untold"].as_array().unwrap().iter().map(|of| of[1].as_u64().unwrap()).sum();
    assert!(told > 100 && told + untold == readable, "{told} of {readable}, {untold} not");
    assert_eq!(summary["usable"].as_u64().unwrap(), told);
    // The funnel counts the same incidents; who reports no crash is none of them.
    let left = |name: &str| {
        let funnel = summary["funnel"].as_array().unwrap();
        funnel.iter().find(|step| step["name"] == name).unwrap()["remaining"].as_u64().unwrap()
    };
    assert_eq!(left("one report an incident"), accounts["incidents"].as_u64().unwrap());
    assert_eq!((left("narrative readable"), left("told as it happened")), (readable, told));
    let (code, shown, _) = place.run(&["read", "--json"]);
    let read: Value = serde_json::from_str(&shown).unwrap();
    assert_eq!((code, read["incidents"].as_u64()), (0, accounts["incidents"].as_u64()));
    assert_eq!(read["accounts"].as_array().unwrap().len() as u64, readable);
    let cases = cases(&place);
    assert_eq!(cases.len(), 12);
    for case in &cases {
        assert_eq!(case["origin"]["is"], "own", "{case}");
        assert!(case["crash_type"].is_string() && case["failure"].is_null(), "{case}");
        assert_ne!(case["recorded"]["faithful"], "no", "{case}");
        // Who was parked is not tested; of everybody else it is said whether the situation was met.
        assert_eq!(case["tuned"].is_null(), case["situation_met"].is_null(), "{case}");
    }
    let junit = std::fs::read_to_string(place.path("suite/junit.xml")).unwrap();
    assert!(junit.contains("tests=\"12\"") && junit.contains("crash type: "), "{junit}");
    let page = std::fs::read_to_string(place.path("suite/report.html")).unwrap();
    for words in ["Crash types", "Situation met", "Why the others are not reconstructed", "Stated facts that are shown"]
    {
        assert!(page.contains(words), "{words}");
    }
    // Its braking is that of MetaDrive's vehicles: what it passes so is counted.
    let passed = cases.iter().filter(|case| case["situation_met"] == true && case["tuned"]["failed"] == false);
    let label = Value::from("braking beyond tyres");
    let brakes = |case: &&Value| case["tuned"]["findings"].as_array().unwrap().contains(&label);
    let (beyond, passed) = (passed.clone().filter(brakes).count(), passed.count());
    let told = format!("In <b>{beyond} of the {passed}</b> that it passes it brakes harder than tyres can");
    assert_eq!(page.contains(&told), beyond > 0, "{told}");
    assert!(page.contains("Passes beyond tyres") && passed > 0, "{beyond} of {passed}");
}

#[test]
fn a_second_run_does_nothing_and_any_number_of_threads_gives_the_same_bytes() {
    let place = Place::made(&TOLD);
    let first = std::fs::read(place.path("suite/summary.json")).unwrap();
    let (code, _, remarks) = place.run(&TOLD);
    assert_eq!(code, 0, "{remarks}");
    assert_eq!(std::fs::read(place.path("suite/summary.json")).unwrap(), first);
    let again = Place::new();
    let (code, _, remarks) = again.run(&[&TOLD[..], &["--threads", "1"]].concat());
    assert_eq!(code, 0, "{remarks}");
    for file in ["summary.json", "results.csv", "junit.xml", "1-accounts.json"] {
        let read = |place: &Place| std::fs::read(place.path(&format!("suite/{file}"))).unwrap();
        assert_eq!(read(&again), read(&place), "{file}");
    }
}

#[test]
fn an_edited_account_is_kept_and_what_no_scene_shows_is_told() {
    let place = Place::made(&TOLD);
    let standing = cases(&place).into_iter().find(|case| case["crash_type"] == "front_to_rear").expect("there is one");
    let id = standing["id"].as_str().unwrap();
    let file = format!("suite/3-narratives/{id}.account.json");
    let mut account = json(&place, &file);
    // Front on rear, and now the ego is told to have been touched on its roof and came from nowhere else.
    account["crash_type"]["value"] = "head_on".into();
    account["came_from"]["value"] = "opposite".into();
    std::fs::write(place.path(&file), serde_json::to_string_pretty(&account).unwrap()).unwrap();
    let (code, shown, remarks) = place.run(&TOLD);
    assert_eq!(json(&place, &file)["crash_type"]["value"], "head_on", "the edit is kept");
    let after = cases(&place).into_iter().find(|case| case["id"] == *id).unwrap();
    let refused = after["failure"].is_object();
    assert_eq!(code, if refused { 5 } else { 0 }, "{remarks}");
    let edited = after["edited"].as_array().unwrap().len() == 1;
    assert!(edited && (refused || after["recorded"]["faithful"] != "no"), "{after}\n{shown}");
}

#[test]
fn an_edited_scenario_and_tuned_file_survive_a_run_which_goes_on_from_them() {
    let place = Place::made(&TOLD);
    let tested: Vec<String> = cases(&place)
        .into_iter()
        .filter(|case| !case["tuned"].is_null())
        .filter_map(|case| case["id"].as_str().map(str::to_owned))
        .collect();
    let [of_scenario, of_tuned] = [&tested[0], &tested[1]];
    let files = [format!("suite/4-scenarios/{of_scenario}.json"), format!("suite/6-tuned/{of_tuned}.json")];
    let runs = [format!("suite/5-runs/{of_scenario}.json"), format!("suite/7-tuned-runs/{of_tuned}.json")];
    let hashes = || runs.each_ref().map(|run| json(&place, run)["rollout"]["state_hash"].clone());
    let before = hashes();
    let edited = files.each_ref().map(|file| {
        let mut scenario = json(&place, file);
        // What the system under test wants, from the handover on.
        let target_mps = scenario["ego"]["target_speed_mps"].as_f64().unwrap();
        scenario["ego"]["target_speed_mps"] = (target_mps - 0.125).into();
        let bytes = serde_json::to_vec_pretty(&scenario).unwrap();
        std::fs::write(place.path(file), &bytes).unwrap();
        bytes
    });
    for _ in 0..2 {
        let (code, _, remarks) = place.run(&TOLD);
        assert_eq!(code, 0, "{remarks}");
        for (file, bytes) in files.iter().zip(&edited) {
            assert_eq!(&std::fs::read(place.path(file)).unwrap(), bytes, "{file}");
        }
        let now = hashes();
        assert!(now[0] != before[0] && now[1] != before[1], "{now:?}");
        let marked = cases(&place).into_iter().filter(|case| !case["edited"].as_array().unwrap().is_empty());
        let marked: Vec<String> = marked.map(|case| case["id"].as_str().unwrap().to_owned()).collect();
        assert_eq!(marked, [of_scenario.clone(), of_tuned.clone()]);
    }
}

#[test]
fn an_edited_scenario_that_is_not_as_told_ends_with_exit_code_5() {
    let place = Place::made(&TOLD);
    let id = cases(&place)
        .into_iter()
        .find(|case| !case["tuned"].is_null() && case["crash_type"] != "single_vehicle")
        .and_then(|case| case["id"].as_str().map(str::to_owned))
        .expect("there is one");
    let file = format!("suite/4-scenarios/{id}.json");
    let mut scenario = json(&place, &file);
    // Nobody is there any more.
    scenario["actors"] = Value::Array(Vec::new());
    std::fs::write(place.path(&file), serde_json::to_string_pretty(&scenario).unwrap()).unwrap();
    let (code, _, remarks) = place.run(&["simulate"]);
    assert_eq!(code, 5, "{remarks}");
    assert!(remarks.contains("not faithful") && remarks.contains(&id), "{remarks}");
    // A run of everything ends in the same way, and counts the suite's own runs.
    let other = cases(&place).into_iter().filter_map(|case| case["id"].as_str().map(str::to_owned));
    let other = other.into_iter().find(|other| *other != id).unwrap();
    std::fs::write(place.path(&format!("suite/4-scenarios/{other}.json")), "{").unwrap();
    let (code, shown, remarks) = place.run(&TOLD);
    assert_eq!(code, 5, "{remarks}");
    let told =
        "1 scenario is not true to the record it tells, and 1 scenario could not be run; the results are written";
    assert!(remarks.contains(told), "{remarks}");
    assert!(shown.contains("10 of the 12 in this suite show it, 1 not as told, 1 not run"), "{shown}");
    let page = std::fs::read_to_string(place.path("suite/report.html")).unwrap();
    let page: String = page.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect();
    assert!(page.contains("10 of the 12 in this suite show it, 1 not as told, 1 not run"));
    let (code, _, remarks) = place.run(&["simulate"]);
    assert!(code == 5 && remarks.contains(told), "{remarks}");
}

#[test]
fn new_records_say_what_they_bring_and_leave_the_rest() {
    let place = Place::new();
    let run = || {
        let words = ["run", "--profile", "open", "--records", "crashes.csv", "--budget", "all", "--tune-budget", "1"];
        place.run(&words)
    };
    place.few_records(40);
    let (code, _, remarks) = run();
    assert_eq!(code, 0, "{remarks}");
    assert!(!remarks.contains("incidents are new"), "{remarks}");
    place.few_records(80);
    let (code, _, remarks) = run();
    assert_eq!(code, 0, "{remarks}");
    assert!(remarks.contains("readable incidents are new: "), "{remarks}");
    // What was reconstructed in the first run is not reconstructed again.
    let line = remarks.lines().find(|line| line.trim_start().starts_with("reconstruct ")).unwrap();
    let numbers: Vec<usize> =
        line.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse().ok()).collect();
    assert!(line.contains("there already") && numbers[2] * 3 > numbers[0], "{line}");
    let kept = std::fs::read(place.path("suite/1-accounts.json")).unwrap();
    std::fs::remove_file(place.path("suite/1-accounts.json")).unwrap();
    std::fs::remove_file(place.path("suite/1-accounts.outcomes.jsonl")).unwrap();
    let (code, _, again) = run();
    assert_eq!(code, 0, "{again}");
    assert!(std::fs::read(place.path("suite/1-accounts.json")).unwrap() == kept, "all of them made anew are the same");
    assert!(remarks.contains("never seen before") || remarks.contains("was seen before"), "{remarks}");
    // One row more makes its own case alone.
    let units = || std::fs::read_to_string(place.path("suite/units.jsonl")).unwrap().lines().count();
    let ids = || -> Vec<String> { cases(&place).iter().map(|case| case["id"].as_str().unwrap().to_owned()).collect() };
    let (known, before) = (ids(), units());
    place.few_records(81);
    let (code, _, remarks) = run();
    assert_eq!(code, 0, "{remarks}");
    let (now, again) = (ids(), units() - before);
    assert!(known.iter().all(|id| now.contains(id)), "{known:?} {now:?}");
    assert!(again > 0 && again * 20 <= before, "{again} of {before} units were made again");
}

#[test]
fn a_model_tunes_nothing_there() {
    let place = Place::new();
    let (code, _, remarks) = place.run(&["run", "--profile", "open", "--tune", "gpt-5-mini"]);
    assert!(code != 0 && remarks.contains("choose the profile paper"), "{code} {remarks}");
}

#[test]
fn an_account_of_a_format_that_nobody_knows_is_told_with_both_formats() {
    let place = Place::made(&TOLD);
    let id = cases(&place)[0]["id"].as_str().unwrap().to_owned();
    let file = format!("suite/3-narratives/{id}.account.json");
    let mut account = json(&place, &file);
    account["format"] = "recrash.account/9".into();
    std::fs::write(place.path(&file), account.to_string()).unwrap();
    let (code, _, remarks) = place.run(&TOLD);
    assert_eq!(code, 5, "the others go on: {remarks}");
    let failures: Vec<String> =
        cases(&place).iter().filter(|case| case["failure"].is_object()).map(|c| c["failure"].to_string()).collect();
    assert_eq!(failures.len(), 1, "{remarks}");
    for words in [&*format!("{id}.account.json"), "format: ", "recrash.account/9", "recrash.account/1"] {
        assert!(failures[0].contains(words), "{words}: {}", failures[0]);
    }
}

#[test]
fn an_account_that_somebody_spoiled_stops_its_case_alone_until_it_is_mended() {
    let place = Place::made(&TOLD);
    let id = cases(&place)[0]["id"].as_str().unwrap().to_owned();
    let file = place.path(&format!("suite/3-narratives/{id}.account.json"));
    let whole = std::fs::read(&file).unwrap();
    std::fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    let (code, shown, remarks) = place.run(&TOLD);
    assert_eq!(code, 5, "{remarks}");
    assert!(shown.contains("11 of the 12 in this suite show it, 1 not run"), "{shown}");
    assert!(shown.contains("1 not run (design: "), "{shown}");
    let failed: Vec<bool> = cases(&place).iter().map(|case| case["failure"].is_object()).collect();
    assert_eq!(failed.iter().filter(|failed| **failed).count(), 1, "{remarks}");
    assert!(failed[0] && remarks.contains(&format!("{id}.account.json")), "{remarks}");
    // A word that there is not: where, and what was probably meant.
    let text = String::from_utf8(whole.clone()).unwrap();
    let (before, behind) = text.split_once("\"crash_type\"").unwrap();
    let typed = before.to_owned() + "\"crash_type\"" + &behind.replacen("\"value\": \"", "\"value\": \"x_", 1);
    let line = typed.lines().position(|line| line.contains("\"x_")).unwrap() + 1;
    std::fs::write(&file, &typed).unwrap();
    let (_, _, remarks) = place.run(&TOLD);
    let words = [
        &*format!(".account.json: line {line}, crash_type.value: there is no word `x_"),
        "did you mean",
        "discard-edits",
    ];
    assert!(words.iter().all(|words| remarks.contains(words)), "{remarks}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), typed);
    std::fs::write(&file, whole).unwrap();
    let (code, _, remarks) = place.run(&TOLD);
    assert_eq!(code, 0, "{remarks}");
    assert!(cases(&place).iter().all(|case| case["failure"].is_null()), "{remarks}");
}

#[test]
fn as_told_is_the_crash_as_reconstructed_and_its_row_says_how_to_run_it_again() {
    let place = Place::new();
    // With this seed tuning keeps another scenario of one of the twelve.
    let mut arguments = TOLD;
    arguments[10] = "2";
    let (code, _, errors) = place.run(&arguments);
    assert_eq!(code, 0, "{errors}");
    let hash = |file: &str| json(&place, &format!("suite/{file}"))["judgement"]["state_hash"].clone();
    let table = std::fs::read(place.path("suite/results.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(&table[..]);
    let header = reader.headers().unwrap().clone();
    let mut told = [0; 2];
    for row in reader.records().map(Result::unwrap) {
        let cell = |name: &str| &row[header.iter().position(|column| column == name).unwrap()];
        let (id, run) = (cell("scenario"), cell("run"));
        let (kept, scenario) = match run {
            "as told" => (format!("5-runs/{id}.recorded.json"), format!("4-scenarios/{id}.json")),
            "as told, tuned" => (format!("7-tuned-runs/{id}.recorded.json"), format!("6-tuned/{id}.json")),
            _ => continue,
        };
        told[usize::from(run != "as told")] += 1;
        assert_eq!(hash(&kept), cell("state_hash"), "{run} of {id}");
        assert!(cell("command").contains(&format!("simulate {scenario} ")), "{}", cell("command"));
        let (_, again, _) = place.run(&["simulate", &format!("suite/{scenario}"), "--ego", "recorded", "--json"]);
        let again: Value = serde_json::from_str(&again).unwrap();
        assert_eq!(again["judgement"]["state_hash"], cell("state_hash"), "{run} of {id}");
    }
    assert!(told[0] == 12 && told[1] > 0, "{told:?}");
}

#[test]
fn of_a_parked_ego_it_is_said_that_nobody_takes_over() {
    let place = Place::made(&TOLD);
    let tested = cases(&place).into_iter().find(|case| case["tuned"].is_object()).expect("there is one");
    let mut scenario = json(&place, &format!("suite/4-scenarios/{}.json", tested["id"].as_str().unwrap()));
    scenario["ego"].as_object_mut().unwrap().remove("handover_s").expect("it is tested");
    std::fs::write(place.path("parked.json"), scenario.to_string()).unwrap();
    let (code, run, _) = place.run(&["simulate", "parked.json", "--ego", "idm", "--json"]);
    let run: Value = serde_json::from_str(&run).unwrap();
    assert_eq!((code, &run["judgement"]["ego"], &run["judgement"]["parked"]), (0, &"recorded".into(), &true.into()));
    let (_, shown, remarks) = place.run(&["simulate", "parked.json", "--ego", "idm"]);
    assert!(remarks.contains("its ego was parked, so there is nothing to test") && !shown.contains("FAIL"), "{shown}");
    let (code, _, errors) = place.run(&["sweep", "parked.json", "--out", "a.parquet", "-n", "2"]);
    assert!(code == 3 && errors.contains("its ego was parked, so there is nothing to test"), "{code}: {errors}");
}
