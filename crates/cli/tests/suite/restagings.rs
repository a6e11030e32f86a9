//! A language model looks at replays of what the rules staged, and changes what they do not show as told.

use crate::common::recrash;
use crate::common::server::{Reply, Server};
use crate::live::{Folder, ledger, read, shares, shown};
use crate::reviews::{cases, few_retold, well};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Output;

fn run(out: &Path, more: &[&str]) -> Output {
    few_retold(out, "6", more)
}

fn done(out: &Path, more: &[&str]) -> String {
    well(&run(out, more))
}

fn scenario(out: &Path, case: &Value) -> Value {
    read(&out.join(format!("4-scenarios/{}.json", case["id"].as_str().unwrap())))
}

/// A bystander far off the road.
fn bystander() -> Value {
    json!({"id": "bystander", "kind": "pedestrian", "plan": {"start": {"x_m": 0.0, "y_m": 60.0}}})
}

/// A server that answers the questions about these reports so, until it has seen a change, and is content with all others.
fn server(answers: Vec<(String, Value)>) -> Server {
    Server::start(move |request| {
        let turns = request.messages();
        let asked = turns[1]["content"].as_str().unwrap();
        assert!(asked.starts_with("Look at the replay of a scenario"), "{turns:?}");
        assert!(asked.contains("| ego 0.0 m along") && asked.contains("\"recorded\":"), "{asked}");
        let of = answers.iter().find(|(report, _)| asked.contains(&format!("Report {report}.")));
        let last = turns.last().unwrap()["content"].as_str().unwrap();
        let content = json!({"as_told": true, "note": ""});
        Reply::Text(
            of.filter(|_| !last.contains("misses no told fact"))
                .map_or(content, |(_, answer)| answer.clone())
                .to_string(),
        )
    })
}

#[test]
fn a_change_that_keeps_all_told_facts_is_taken_and_one_that_loses_them_is_not() {
    let (plain, folder) = (Folder::new(), Folder::new());
    done(&plain.suite(), &[]);
    let before = cases(&plain.suite());
    let ids = |out: &Path, case: &Value| -> Vec<String> {
        let all = scenario(out, case)["actors"].as_array().cloned().unwrap_or_default();
        all.iter().map(|actor| actor["id"].as_str().unwrap().to_owned()).collect()
    };
    let beside = (1..4).find(|at| ids(&plain.suite(), &before[*at]).contains(&"cp".to_owned())).expect("a partner");
    let report = |at: usize| before[at]["told"].as_str().unwrap().to_owned();
    let note = "Told is a bystander,\n<b>shown</b> is none.";
    let changed = json!({"as_told": false, "note": note, "actors": [bystander()]});
    let lost = json!({"as_told": false, "note": "nobody came", "without": ["cp"]});
    let server = server(vec![(report(0), changed), (report(beside), lost)]);
    let asked = ["--design", "scripted", "--repairs", "1", "--base-url", &server.base_url];
    let out = folder.suite();
    let text = done(&out, &asked);
    assert!(
        text.contains("scripted looks at 4 of 4 replays, and changes what they do not show as told: about "),
        "{text}"
    );
    let told =
        "scripted was asked about 4 replays of what the rules staged: 2 are as told, 1 it changed; 1 stay as the rules";
    assert!(text.contains(told), "{text}");

    let now = cases(&out);
    assert!(ids(&out, &now[0]).contains(&"bystander".to_owned()));
    for (at, case) in now.iter().enumerate() {
        assert_eq!(case["recorded"]["faithful"], before[at]["recorded"]["faithful"], "{case}");
        let (old, new) = (scenario(&plain.suite(), case), scenario(&out, case));
        assert_eq!(old == new, at != 0, "{at}");
    }
    // What a model staged is nobody's to vary: the tests run in it as it is.
    assert_eq!(scenario(&out, &now[0])["source"]["author"], json!({"model": "scripted"}));
    assert_eq!(now[0]["points"], 1);
    assert_eq!(now[0]["changed"]["what"], "Told is a bystander, <b>shown</b> is none.");
    assert_eq!(shares(&read(&out.join("summary.json")), "design"), [2, 1, 1]);
    let why = now[beside]["designed"]["why"].as_str().unwrap();
    assert!(why.contains("gave no usable answer") && now[beside]["changed"].is_null(), "{why}");
    let results = std::fs::read_to_string(out.join("results.csv")).unwrap();
    assert!(results.contains("\"Told is a bystander, <b>shown</b> is none.\""), "{results}");
    let id = now[0]["id"].as_str().unwrap();
    let page = std::fs::read_to_string(out.join(format!("report/{id}.js"))).unwrap();
    assert!(page.contains("and changed by ") && !page.contains("<b>shown"), "{page}");

    // Nothing is asked again; the ledger alone gives the same scenarios; `prompt` shows what was asked.
    let requests = server.requests().len();
    done(&out, &asked);
    assert_eq!(server.requests().len(), requests);
    let prompt = recrash(&["prompt", "restage", "--json", "--out", out.to_str().unwrap()]).output().unwrap();
    let prompt: Value = serde_json::from_slice(&prompt.stdout).unwrap_or_else(|e| panic!("{e}: {}", shown(&prompt)));
    assert!(ledger(&out).iter().any(|exchange| exchange["hash"] == prompt["hash"]));
    let other = Folder::new();
    std::fs::create_dir_all(other.suite().join("ledger")).unwrap();
    for file in std::fs::read_dir(out.join("ledger")).unwrap().map(|entry| entry.unwrap().path()) {
        std::fs::copy(&file, other.suite().join("ledger").join(file.file_name().unwrap())).unwrap();
    }
    std::fs::copy(out.join("suite.json"), other.suite().join("suite.json")).unwrap();
    done(&other.suite(), &["--design", "scripted", "--repairs", "1", "--llm", "replay"]);
    assert_eq!(scenario(&other.suite(), &now[0]), scenario(&out, &now[0]));

    // Without the model the rules' scenarios are back.
    done(&out, &["--design", "rules"]);
    for case in &before {
        assert_eq!(scenario(&out, case), scenario(&plain.suite(), case));
    }
}

#[test]
fn a_batch_waits_for_them_and_a_model_that_tunes_is_refused() {
    let folder = Folder::new();
    let output = run(&folder.suite(), &["--design", "scripted", "--llm", "batch"]);
    assert_eq!(output.status.code(), Some(4), "{}", shown(&output));
    let requests = std::fs::read_to_string(folder.suite().join("requests.jsonl")).unwrap();
    assert_eq!(requests.lines().count(), 4, "a small suite has enough that the rules tell");
    let other = Folder::new();
    let output = run(&other.suite(), &["--tune", "scripted", "--llm", "batch"]);
    assert_eq!(output.status.code(), Some(3), "{}", shown(&output));
    assert!(
        shown(&output).contains("goes by accounts") && shown(&output).contains("variations are computed"),
        "{}",
        shown(&output)
    );
}

/// A told signal that is yellow, and green in what the rules stage; and a crash of which a told act is missed.
const UNSTAGED: [&str; 2] = ["90001-120", "90001-395"];

/// The scenario of a first question.
fn asked_about(asked: &str) -> Value {
    let text = asked.split_once("The scenario:\n").and_then(|(_, rest)| rest.lines().next());
    serde_json::from_str(text.unwrap()).unwrap()
}

#[test]
fn a_crash_that_the_rules_do_not_show_as_told_is_staged_by_the_model_and_not_told_where_it_misses_what_they_miss() {
    let server = Server::start(|request| {
        let turns = request.messages();
        let asked = turns[1]["content"].as_str().unwrap();
        let last = turns.last().unwrap()["content"].as_str().unwrap();
        if UNSTAGED.iter().any(|report| asked.contains(&format!("Report {report}"))) {
            assert!(asked.contains("As it is the scenario misses told facts"), "{asked}");
        }
        let is_content = !asked.contains(&format!("Report {}", UNSTAGED[0])) || last.contains("misses no told fact");
        if is_content {
            return Reply::Text(json!({"as_told": true, "note": ""}).to_string());
        }
        assert!(asked.contains("- CP signal or sign: yellow signal; shown is green"), "{asked}");
        let mut control = asked_about(asked)["control"].clone();
        for device in control.as_array_mut().unwrap() {
            device["device"]["signal"]["offset_s"] = json!(4.5);
        }
        Reply::Text(json!({"as_told": false, "note": "told is yellow, shown is green", "control": control}).to_string())
    });
    let folder = Folder::new();
    let stories = concat!(env!("CARGO_MANIFEST_DIR"), "/../../eval/stories.csv");
    let which = format!("report in (\"{}\", \"{}\", \"90001-102\")", UNSTAGED[0], UNSTAGED[1]);
    let run = |more: &[&str]| {
        let mut command =
            recrash(&["run", "--profile", "open", "--records", stories, "--where", &which, "--budget", "all"]);
        let output =
            command.args(["--tune-budget", "1", "--out", folder.suite().to_str().unwrap()]).args(more).output();
        well(&output.unwrap())
    };
    let told = || -> Vec<String> {
        let cases = cases(&folder.suite());
        cases.iter().map(|case| case["told"].as_str().unwrap().split('/').next().unwrap().to_owned()).collect()
    };
    run(&[]);
    assert_eq!(told(), ["90001-102"]);
    let asked = ["--design", "scripted", "--repairs", "2", "--base-url", &server.base_url];
    let text = run(&asked);
    assert!(text.contains("scripted stages 2 crashes that the rules do not show as told: about "), "{text}");
    assert!(text.contains("scripted staged 1 of 2 crashes that the rules do not show as told"), "{text}");
    let mut now = told();
    now.sort_unstable();
    assert_eq!(now, ["90001-102", UNSTAGED[0]]);
    let cases = cases(&folder.suite());
    let staged = cases.iter().find(|case| case["told"].as_str().unwrap().starts_with(UNSTAGED[0])).unwrap();
    assert_eq!(staged["changed"]["what"], "told is yellow, shown is green");
    // Why the ego stood is not drawn, as in what the rules stage.
    assert_eq!(staged["recorded"]["faithful"], "unchecked", "{staged}");
    let untold = read(&folder.suite().join("1-accounts.json"))["untold"].clone();
    assert_eq!(untold.as_array().unwrap().len(), 1);
    assert!(untold[0]["reason"].as_str().unwrap().contains("SV acts is not drawn"), "{untold}");

    let summary = read(&folder.suite().join("summary.json"));
    assert_eq!(shares(&summary, "design"), [1, 1, 1]);
    let design = summary["models"].as_array().unwrap().iter().find(|model| model["role"] == "design").unwrap();
    let why = design["reasons"][0]["why"].as_str().unwrap();
    assert!(why.contains("stays untold") && why.contains("told facts are missed"), "{why}");

    // A person's account is staged by the model as well.
    let edited = folder.suite().join(format!("3-narratives/{}.account.json", staged["id"].as_str().unwrap()));
    let before = std::fs::read_to_string(&edited).unwrap();
    let mut account: Value = serde_json::from_str(&before).unwrap();
    account["words"] = json!(account["words"].as_u64().unwrap() + 1);
    std::fs::write(&edited, account.to_string()).unwrap();
    run(&asked);
    assert_eq!(told().len(), 2);
    std::fs::write(&edited, before).unwrap();
    run(&asked);

    // Nothing is asked again, also where the runs begin anew; without the model it is not told any more.
    let requests = server.requests().len();
    let scenario = scenario(&folder.suite(), staged);
    std::fs::remove_file(folder.suite().join("1-accounts.stagings.json")).unwrap();
    run(&asked);
    assert_eq!(server.requests().len(), requests);
    assert_eq!(self::scenario(&folder.suite(), staged), scenario);
    run(&["--design", "rules"]);
    assert_eq!(told(), ["90001-102"]);
}

/// What a model reads may be right, though the rules do not show it; where nobody stages it, the reader's account stays, and its name.
#[test]
fn a_reading_that_nobody_stages_is_taken_back_and_said() {
    let server = Server::start(|request| {
        let asked = request.messages()[1]["content"].as_str().unwrap();
        if asked.starts_with("Look at the replay") {
            return Reply::Text(json!({"as_told": true, "note": ""}).to_string());
        }
        let acts = json!([
            {"act": "follow", "step": 0, "words": "operating"},
            {"act": "stop", "step": 1, "words": "come to a stop"},
            {"act": "swerve", "side": "right", "step": 3, "words": "at the right curb"},
        ]);
        Reply::Text(json!({"report": "90001-102/1", "sv": {"acts": acts}}).to_string())
    });
    let folder = Folder::new();
    let stories = concat!(env!("CARGO_MANIFEST_DIR"), "/../../eval/stories.csv");
    let mut command =
        recrash(&["run", "--profile", "open", "--records", stories, "--budget", "all", "--tune-budget", "1"]);
    command.args(["--where", "report = \"90001-102\"", "--paraphrase", "scripted", "--model-reads", "all"]);
    command.args(["--design", "scripted", "--repairs", "1", "--base-url", &server.base_url]);
    well(&command.args(["--out", folder.suite().to_str().unwrap()]).output().unwrap());
    let summary = read(&folder.suite().join("summary.json"));
    assert_eq!(summary["cases"].as_array().unwrap().len(), 1, "the reader's account is told");
    assert_eq!(shares(&summary, "paraphrase"), [0, 0, 1]);
    let readers = read(&folder.suite().join("1-accounts.agents.json")).to_string();
    assert!(readers.contains("and no model stages it"), "{readers}");
}
