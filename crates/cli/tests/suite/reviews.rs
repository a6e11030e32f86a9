//! A language model holds replays against their reports: what it finds is told everywhere, and changes nothing else.

use crate::common::server::{Reply, Server};
use crate::common::{FEW, recrash};
use crate::live::{Folder, ledger, read, shares, shown};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Output;

/// The note that is given of the one replay that is called wrong. It must be escaped wherever it stands.
const NOTE: &str = "Told is a lane change,\n<b>shown</b> is none.";

/// A server that calls the replay of the first scenario wrong, by its report, and all others right.
fn server(wrong: &str) -> Server {
    let report = format!("Report {wrong}.");
    Server::start(move |request| {
        assert!(request.is("Hold the replay"), "{:?}", request.messages());
        let asked = request.messages()[1]["content"].as_str().unwrap();
        assert!(asked.contains("| ego 0.0 m along") && asked.contains("Events: "), "{asked}");
        let of = asked.contains(&report);
        let mut answer = json!({"who": "yes", "side": "yes", "order": "untold", "standstill": "yes", "striker": "yes", "zones": "yes"});
        answer["movements"] = json!(if of { "no" } else { "yes" });
        answer["note"] = json!(if of { NOTE } else { "" });
        Reply::Text(answer.to_string())
    })
}

/// A run of four cases by accounts.
pub(super) fn few_retold(out: &Path, tune_budget: &str, more: &[&str]) -> Output {
    recrash(&["run", "--profile", "open", "--records", FEW, "--budget", "4", "--tune-budget", tune_budget])
        .args(["--out", out.to_str().unwrap()])
        .args(more)
        .output()
        .unwrap()
}

/// What a run that went well printed.
pub(super) fn well(output: &Output) -> String {
    assert!(output.status.success(), "{}", shown(output));
    shown(output)
}

pub(super) fn cases(out: &Path) -> Vec<Value> {
    read(&out.join("summary.json"))["cases"].as_array().unwrap().clone()
}

fn run(out: &Path, more: &[&str]) -> Output {
    few_retold(out, "1", more)
}

fn done(out: &Path, more: &[&str]) -> String {
    well(&run(out, more))
}

/// All files of a suite but those that say how it was asked, with what they hold.
fn files(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![out.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                folders.push(entry);
            } else if !entry.ends_with("units.jsonl") {
                found.insert(entry.strip_prefix(out).unwrap().to_owned(), std::fs::read(&entry).unwrap());
            }
        }
    }
    found
}

#[test]
fn what_a_model_finds_beside_a_report_is_told_everywhere_and_asked_once() {
    let folder = Folder::new();
    let out = folder.suite();
    done(&out, &[]);
    let plain = files(&out);
    assert!(!plain.keys().any(|file| file.to_string_lossy().contains(".review.")));
    let told = cases(&out)[0]["told"].as_str().unwrap().to_owned();
    let (id, server) = (cases(&out)[0]["id"].as_str().unwrap().to_owned(), server(&told));
    let asked = ["--review", "scripted", "--base-url", &server.base_url];
    let text = done(&out, &asked);
    assert!(text.contains("scripted reads 4 of 4 replays beside their reports: about "), "{text}");
    assert!(
        text.contains("scripted reads 4 replays beside their reports: 3 show them, 1 does not: movements 1"),
        "{text}"
    );

    // Scenarios and runs are as they were.
    let now = files(&out);
    let made =
        |file: &&PathBuf| ["4-scenarios", "5-runs", "6-tuned", "7-tuned-runs"].iter().any(|of| file.starts_with(of));
    for file in plain.keys().filter(made) {
        assert_eq!(plain[file], now[file], "{}", file.display());
    }
    let reviews: Vec<Value> = cases(&out)
        .iter()
        .map(|case| read(&out.join(format!("5-runs/{}.review.json", case["id"].as_str().unwrap()))))
        .collect();
    assert_eq!(reviews.iter().filter(|review| review["review"]["movements"] == "no").count(), 1);
    let note = "Told is a lane change, <b>shown</b> is none.";
    assert_eq!(cases(&out)[0]["review"]["note"], note);
    assert_eq!(shares(&read(&out.join("summary.json")), "review"), [4, 0, 0]);
    let page = String::from_utf8(now[Path::new("report.html")].clone()).unwrap();
    assert!(
        page.contains("rules; scripted reviews") && page.contains("reviewed-wrong") && page.contains("read: wrong")
    );
    let case = std::fs::read_to_string(out.join(format!("report/{id}.js"))).unwrap();
    assert!(case.contains("does not show it (movements): ") && !case.contains("<b>shown"), "{case}");
    let results = std::fs::read_to_string(out.join("results.csv")).unwrap();
    assert!(results.contains(&format!("wrong,\"{note}\"")) && results.contains(",right,"), "{results}");

    // Nothing is asked again; an edited scenario is.
    let before = server.requests().len();
    assert_eq!(before, 4);
    done(&out, &asked);
    assert_eq!(server.requests().len(), before);
    let file = out.join(format!("4-scenarios/{id}.json"));
    let mut scenario = read(&file);
    scenario["duration_s"] = json!(scenario["duration_s"].as_f64().unwrap() + 1.0);
    scenario["ego"]["target_speed_mps"] = json!(9.0);
    let partner = scenario["actors"].as_array_mut().unwrap();
    partner[0]["size"] = json!({"length_m": 5.5, "width_m": 2.0});
    std::fs::write(&file, scenario.to_string()).unwrap();
    done(&out, &asked);
    assert_eq!(server.requests().len(), before + 1);

    // Without the model its findings go, and what was edited stays.
    done(&out, &["--discard-edits"]);
    assert_eq!(files(&out).keys().filter(|file| file.to_string_lossy().contains(".review.")).count(), 0);
    let (mut again, mut first) = (files(&out), plain);
    again.retain(|file, _| !file.starts_with("ledger"));
    first.retain(|file, _| !file.starts_with("ledger"));
    assert!(again.keys().eq(first.keys()), "{:?}", again.keys());
    for (file, content) in &first {
        assert_eq!(again[file], *content, "{}", file.display());
    }
}

#[test]
fn the_ledger_alone_gives_the_same_bytes_and_a_batch_waits_for_reviews() {
    let folder = Folder::new();
    let out = folder.suite();
    let server = server("none");
    done(&out, &["--review", "scripted", "--base-url", &server.base_url]);
    assert!(ledger(&out).iter().all(|exchange| exchange["question"]["purpose"]["role"] == "review"));
    let other = Folder::new();
    std::fs::create_dir_all(other.suite().join("ledger")).unwrap();
    for file in std::fs::read_dir(out.join("ledger")).unwrap().map(|entry| entry.unwrap().path()) {
        std::fs::copy(&file, other.suite().join("ledger").join(file.file_name().unwrap())).unwrap();
    }
    std::fs::copy(out.join("suite.json"), other.suite().join("suite.json")).unwrap();
    done(&other.suite(), &["--review", "scripted", "--llm", "replay"]);
    assert_eq!(files(&out), files(&other.suite()));
    // What `prompt` shows is what was asked.
    let prompt = recrash(&["prompt", "review", "--json", "--out", out.to_str().unwrap()]).output().unwrap();
    let prompt: Value = serde_json::from_slice(&prompt.stdout).unwrap_or_else(|e| panic!("{e}: {}", shown(&prompt)));
    assert!(ledger(&out).iter().any(|exchange| exchange["hash"] == prompt["hash"]));

    let batch = Folder::new();
    let output = run(&batch.suite(), &["--review", "scripted", "--llm", "batch"]);
    assert_eq!(output.status.code(), Some(4), "{}", shown(&output));
    let requests = std::fs::read_to_string(batch.suite().join("requests.jsonl")).unwrap();
    assert_eq!(requests.lines().count(), 4);
}

#[test]
fn what_is_no_review_is_told_and_suites_of_templates_have_none() {
    let folder = Folder::new();
    let server = Server::start(|_| Reply::Text("no idea".into()));
    let text = done(&folder.suite(), &["--review", "scripted", "--repairs", "0", "--base-url", &server.base_url]);
    assert!(text.contains("scripted reads 0 replays") && text.contains("not reviewed: "), "{text}");
    let all = cases(&folder.suite());
    assert!(all.iter().all(|case| case["review"].is_null() && case["reviewed"]["outcome"] == "fallback"), "{all:?}");
    let results = std::fs::read_to_string(folder.suite().join("results.csv")).unwrap();
    assert!(results.lines().nth(1).unwrap().ends_with(",,"), "{results}");

    let other = Folder::new();
    let output = recrash(&["run", "--profile", "paper", "--records", FEW, "--review", "scripted"])
        .args(["--base-url", &server.base_url, "--out", other.suite().to_str().unwrap()])
        .output()
        .unwrap();
    assert!(!output.status.success() && shown(&output).contains("goes by templates"), "{}", shown(&output));
}
