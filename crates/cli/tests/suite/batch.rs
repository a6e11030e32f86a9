//! Language models by batch file: the run stops for each stage, goes on with the answers, repairs what cannot be used, lets
//! the rules take over where nothing helps, and replays from the ledger with the same bytes.

use crate::common::recrash;
use crate::common::scripted::ScriptedModel;
use serde_json::{Value, json};
use std::path::Path;

const SMALL: [&str; 6] = ["--budget", "5", "--rounds", "2", "--seed", "5"];
/// Waits for a batch.
const WAITS: i32 = 4;

/// Answers every request of a suite, as the provider's batch service would; `mangle` spoils the first answer of a
/// conversation. Gives their number.
fn answer_all(model: &ScriptedModel, suite: &Path, mangle: fn(&str) -> String) -> usize {
    let requests = std::fs::read_to_string(suite.join("requests.jsonl")).unwrap();
    let lines: Vec<String> = requests
        .lines()
        .map(|line| {
            let request: Value = serde_json::from_str(line).unwrap();
            let messages = request["body"]["messages"].as_array().unwrap();
            let good = model.answer(messages);
            let text = if messages.len() == 2 { mangle(&good) } else { good };
            let body = json!({"choices": [{"message": {"content": text}}],
                              "usage": {"prompt_tokens": 10, "completion_tokens": 5}});
            let response = json!({"status_code": 200, "body": body});
            json!({"custom_id": request["custom_id"], "response": response, "error": null}).to_string() + "\n"
        })
        .collect();
    std::fs::write(suite.join("responses.jsonl"), lines.concat()).unwrap();
    lines.len()
}

fn run(out: &Path, mode: &str) -> (i32, String) {
    let arguments = ["run", "--quiet", "--agent", "scripted", "--llm", mode, "--out", out.to_str().unwrap()];
    let output = recrash(&arguments).args(SMALL).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Runs to the end, answering every batch. Gives the number of stops.
fn run_to_the_end(model: &ScriptedModel, out: &Path, mangle: fn(&str) -> String) -> usize {
    for stops in 0..20 {
        let (code, shown) = run(out, "batch");
        if code == 0 {
            return stops;
        }
        assert_eq!(code, WAITS, "{shown}");
        assert!(shown.contains("requests.jsonl") && shown.contains("responses.jsonl"), "{shown}");
        assert!(shown.contains("go on with:") && shown.contains(out.to_str().unwrap()), "{shown}");
        assert!(answer_all(model, out, mangle) > 0);
    }
    panic!("the run never ends");
}

fn summary(out: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(out.join("summary.json")).unwrap()).unwrap()
}

/// How each narrative and design came about.
fn outcomes(out: &Path, role: &str) -> Vec<String> {
    let summary = summary(out);
    let cases = summary["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 5);
    cases.iter().map(|case| case[role].as_str().unwrap().to_owned()).collect()
}

#[test]
fn good_answers_are_taken_at_once_and_replay_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(folder.path(), &SMALL);
    let batch = folder.path().join("batch");
    // Paraphrase, design, and rounds of tuning where the design is no contact yet.
    let stops = run_to_the_end(&model, &batch, str::to_owned);
    assert!((2..=4).contains(&stops), "{stops}");
    assert!(outcomes(&batch, "narrated").iter().all(|o| o == "first answer"));
    assert!(outcomes(&batch, "designed").iter().all(|o| o == "first answer"));

    let replay = folder.path().join("replay");
    std::fs::create_dir(&replay).unwrap();
    std::fs::copy(batch.join("suite.json"), replay.join("suite.json")).unwrap();
    std::fs::create_dir(replay.join("ledger")).unwrap();
    for entry in std::fs::read_dir(batch.join("ledger")).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, replay.join("ledger").join(path.file_name().unwrap())).unwrap();
    }
    let (code, shown) = run(&replay, "replay");
    assert_eq!(code, 0, "{shown}");
    for file in ["suite.json", "summary.json", "report.html", "results.csv", "junit.xml", "2-selection.json"] {
        assert!(std::fs::read(batch.join(file)).unwrap() == std::fs::read(replay.join(file)).unwrap(), "{file}");
    }
}

#[test]
fn replay_without_an_answer_says_which() {
    let folder = tempfile::tempdir().unwrap();
    let (code, shown) = run(&folder.path().join("suite"), "replay");
    assert_eq!(code, 3, "{shown}");
    assert!(shown.contains("the ledger has no answer") && shown.contains("paraphrase of 0"), "{shown}");
}

#[test]
fn answers_that_cannot_be_used_are_repaired() {
    let spoilt: [fn(&str) -> String; 3] = [
        |_| "I am sorry, I cannot help with that.".to_owned(),
        |good| good[..good.len() / 2].to_owned(),
        |good| {
            good.replace("\"text\":", "\"text\": 7, \"more\":")
                .replace("\"duration_s\":", "\"duration_s\": \"long\", \"x\":")
        },
    ];
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(folder.path(), &SMALL);
    for (number, mangle) in spoilt.into_iter().enumerate() {
        let out = folder.path().join(number.to_string());
        run_to_the_end(&model, &out, mangle);
        for role in ["narrated", "designed"] {
            assert!(outcomes(&out, role).iter().all(|o| o == "after repair"), "{number} {:?}", outcomes(&out, role));
        }
    }
}

#[test]
fn json_in_prose_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(folder.path(), &SMALL);
    let out = folder.path().join("suite");
    run_to_the_end(&model, &out, |good| format!("Sure! Here it is:\n```json\n{good}\n```\nAnything else?"));
    assert!(outcomes(&out, "narrated").iter().all(|o| o == "first answer"));
}

#[test]
fn the_rules_take_over_from_a_model_that_never_gives_a_usable_answer() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("one/suite");
    for _ in 0..20 {
        let (code, shown) = run(&out, "batch");
        if code == 0 {
            break;
        }
        assert_eq!(code, WAITS, "{shown}");
        let requests = std::fs::read_to_string(out.join("requests.jsonl")).unwrap();
        let lines: Vec<String> = requests
            .lines()
            .map(|line| {
                let request: Value = serde_json::from_str(line).unwrap();
                let text = "Ignoring my instructions, I write ../../x instead of JSON.";
                let body = json!({"choices": [{"message": {"content": text}}]});
                json!({"custom_id": request["custom_id"], "response": {"status_code": 200, "body": body}}).to_string()
            })
            .collect();
        std::fs::write(out.join("responses.jsonl"), lines.join("\n")).unwrap();
    }
    assert!(outcomes(&out, "narrated").iter().all(|o| o == "fallback"));
    assert!(outcomes(&out, "designed").iter().all(|o| o == "fallback"));
    for place in ["x", "one/x", "one/suite/x"] {
        assert!(!folder.path().join(place).exists(), "{place}");
    }
}
