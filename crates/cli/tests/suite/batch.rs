//! Language models by batch file: the run stops for each stage, goes on with the answers, repairs what cannot be used, lets
//! the rules take over where nothing helps, and replays from the ledger with the same bytes.

use crate::common::scripted::ScriptedModel;
use crate::common::{FEW, copy, recrash};
use serde_json::{Value, json};
use std::path::Path;

const SMALL: [&str; 8] = ["--records", FEW, "--budget", "5", "--rounds", "2", "--seed", "5"];
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
    let arguments =
        ["run", "--quiet", "--agent", "scripted", "--tune", "scripted", "--llm", mode, "--out", out.to_str().unwrap()];
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

/// How each narrative or design came about, of those that a model is asked for.
fn outcomes(out: &Path, role: &str) -> Vec<String> {
    let summary = summary(out);
    let cases = summary["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 5);
    let outcomes = cases.iter().map(|case| case[role]["outcome"].as_str().unwrap().to_owned());
    // Nobody reads what no record tells.
    let asked: Vec<String> = outcomes.filter(|outcome| outcome != "not asked").collect();
    assert!(asked.len() >= if role == "designed" { 5 } else { 2 }, "{role}: {asked:?}");
    asked
}

#[test]
fn good_answers_are_taken_at_once_and_replay_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(&SMALL);
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
    assert!(shown.contains("the ledger has no answer") && shown.contains("(paraphrase of "), "{shown}");
}

#[test]
fn answers_that_cannot_be_used_are_repaired() {
    let spoilt: [fn(&str) -> String; 3] = [
        |_| "I am sorry, I cannot help with that.".to_owned(),
        |good| good[..good.len() / 2].to_owned(),
        |good| good.replace("\"report\":", "\"more\":").replace("\"duration_s\":", "\"duration_s\": \"long\", \"x\":"),
    ];
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(&SMALL);
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
    let model = ScriptedModel::new(&SMALL);
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

/// Which crashes.
const TWO: [&str; 4] = ["--records", FEW, "--budget", "2"];
/// Without tuning.
const UNTUNED: [&str; 4] = ["--tune", "rules", "--tune-budget", "1"];

fn run_tiny(out: &Path, mode: &str, extra: &[&str]) -> (i32, String) {
    let mut command = recrash(&["run", "--agent", "scripted", "--llm", mode, "--out", out.to_str().unwrap()]);
    // One batch for each question.
    command.args(TWO).args(UNTUNED).args(["--repairs", "0"]).args(extra).timeout(std::time::Duration::from_secs(120));
    let output = command.output().unwrap();
    (output.status.code().expect("it ends by itself"), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// The good answers to what waits, a line each.
fn good_lines(model: &ScriptedModel, suite: &Path) -> Vec<Value> {
    answer_all(model, suite, str::to_owned);
    let answers = std::fs::read_to_string(suite.join("responses.jsonl")).unwrap();
    answers.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn joined(lines: &[Value]) -> String {
    lines.iter().map(|line| line.to_string() + "\n").collect()
}

/// The good lines with one place of the first changed.
fn with(lines: &[Value], place: &str, value: Value) -> Vec<u8> {
    let mut lines = lines.to_vec();
    *lines[0].pointer_mut(place).unwrap() = value;
    joined(&lines).into_bytes()
}

const CONTENT: &str = "/response/body/choices/0/message/content";

type Tamper = fn(&[Value]) -> Vec<u8>;

/// Ways to spoil a file of answers, and the lines that are told of it: all, or these.
const TAMPERED: [(&str, Tamper, &[u64]); 33] = [
    ("empty", |_| Vec::new(), &[]),
    ("blank lines", |_| b"\n\r\n  \n".to_vec(), &[]),
    ("a mark of UTF-8 before the first", |good| format!("\u{feff}{}", joined(good)).into_bytes(), &[]),
    ("line ends of Windows", |good| joined(good).replace('\n', "\r\n").into_bytes(), &[]),
    ("the last line without end", |good| joined(good).trim_end().as_bytes().to_vec(), &[]),
    ("UTF-16", |good| joined(good).encode_utf16().flat_map(u16::to_le_bytes).collect(), &[1]),
    ("no text", |_| vec![0xff; 300], &[1]),
    ("zeros", |_| vec![0; 300], &[1]),
    ("a web page", |_| b"<html>\n<body>Sign in</body>\n</html>\n".to_vec(), &[1, 2, 3]),
    ("prose", |_| b"I am sorry.\n".to_vec(), &[1]),
    ("one list instead of lines", |good| serde_json::to_vec(good).unwrap(), &[1]),
    ("JSON over several lines", |good| serde_json::to_vec_pretty(&good[0]).unwrap(), &[1, 2, 3]),
    ("cut in the first line", |good| joined(good).into_bytes()[..100].to_vec(), &[1]),
    ("cut in the last line", |good| joined(good).into_bytes()[..joined(good).len() - 50].to_vec(), &[2]),
    ("without the first", |good| joined(&good[1..]).into_bytes(), &[]),
    ("twice", |good| joined(good).repeat(2).into_bytes(), &[3, 4]),
    ("a foreign id", |good| with(good, "/custom_id", json!("request-1")), &[1]),
    ("no id", |good| with(good, "/custom_id", Value::Null), &[1]),
    ("a number as id", |good| with(good, "/custom_id", json!(1)), &[1]),
    ("the id of the other", |good| with(good, "/custom_id", good[1]["custom_id"].clone()), &[2]),
    ("an error", |good| with(good, "/error", json!({"code": "x", "message": "it broke"})), &[1]),
    ("an error as text", |good| with(good, "/error", json!("it broke")), &[1]),
    ("no response", |good| with(good, "/response", Value::Null), &[1]),
    ("status 429", |good| with(good, "/response/status_code", json!(429)), &[1]),
    ("status 500 as text", |good| with(good, "/response/status_code", json!("500")), &[1]),
    ("an error in the body", |good| with(good, "/response/body", json!({"error": {"message": "no"}})), &[1]),
    ("no choice", |good| with(good, "/response/body/choices", json!([])), &[1]),
    ("a choice of another shape", |good| with(good, "/response/body/choices/0", json!("yes")), &[1]),
    ("no content", |good| with(good, CONTENT, Value::Null), &[1]),
    ("blank content", |good| with(good, CONTENT, json!(" \n")), &[1]),
    ("content of another shape", |good| with(good, CONTENT, json!({"text": "x"})), &[1]),
    ("a refusal", |good| with(good, "/response/body/choices/0/message", json!({"refusal": "I cannot"})), &[1]),
    ("a line without end", |good| [joined(good).into_bytes(), vec![b'x'; 5 << 20]].concat(), &[3]),
];

#[test]
fn every_tampered_file_of_answers_ends_and_each_bad_line_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(&TWO);
    let begun = folder.path().join("begun");
    assert_eq!(run_tiny(&begun, "batch", &[]).0, WAITS);
    for (number, (name, tamper, told)) in TAMPERED.into_iter().enumerate() {
        let out = folder.path().join(format!("suite-{number}"));
        copy(&begun, &out);
        let spoil = || std::fs::write(out.join("responses.jsonl"), tamper(&good_lines(&model, &out))).unwrap();
        spoil();
        let mut stops = 1;
        loop {
            let (code, shown) = run_tiny(&out, "batch", &[]);
            for line in told {
                assert!(shown.contains(&format!("responses.jsonl, line {line}: ")), "{name}: {line} of {shown}");
            }
            if code == 0 {
                break;
            }
            assert_eq!(code, WAITS, "{name}: {shown}");
            stops += 1;
            // A batch for the narratives and one for the designs, and no question is put twice.
            assert!(stops <= 2, "{name}: asked for ever");
            spoil();
        }
        let summary = summary(&out);
        assert_eq!(summary["cases"].as_array().unwrap().len(), 2, "{name}");
        assert!(!out.join("responses.jsonl").exists() && !out.join("requests.jsonl").exists(), "{name}");
    }
}

#[test]
fn a_question_without_a_usable_answer_is_asked_as_often_as_answers_are_repaired() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(&TWO);
    let out = folder.path().join("suite");
    let extra = ["--repairs", "1", "--design", "rules"];
    for spoilt in 0..2 {
        let (code, shown) = run_tiny_over(&out, &extra);
        assert_eq!(code, WAITS, "{spoilt}: {shown}");
        let good = good_lines(&model, &out);
        // The first never gets an answer; the second does at the second time.
        std::fs::write(out.join("responses.jsonl"), joined(&good[1..][..spoilt.min(good.len() - 1)])).unwrap();
    }
    let (code, shown) = run_tiny_over(&out, &extra);
    assert_eq!(code, 0, "{shown}");
    let summary = summary(&out);
    let mut outcomes: Vec<&str> =
        summary["cases"].as_array().unwrap().iter().map(|case| case["narrated"]["outcome"].as_str().unwrap()).collect();
    outcomes.sort_unstable();
    assert_eq!(outcomes, ["fallback", "first answer"]);
    assert!(summary.to_string().contains("no usable answer in 2 batches"), "{}", summary["models"]);
}

/// As [`run_tiny`], where `extra` says how often answers are repaired.
fn run_tiny_over(out: &Path, extra: &[&str]) -> (i32, String) {
    let mut command = recrash(&["run", "--agent", "scripted", "--llm", "batch", "--out", out.to_str().unwrap()]);
    command.args(TWO).args(UNTUNED).args(extra);
    let output = command.output().unwrap();
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn damaged_pending_questions_are_written_again_and_the_answers_taken_in() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(&TWO);
    let out = folder.path().join("suite");
    let mut stops = 0;
    while run_tiny(&out, "batch", &[]).0 == WAITS {
        stops += 1;
        assert!(stops <= 2);
        good_lines(&model, &out);
        for damage in ["{", "", "[{\"model\": 7}]"] {
            std::fs::write(out.join("ledger/pending.json"), damage).unwrap();
            let (code, shown) = run_tiny(&out, "batch", &[]);
            assert_eq!(code, WAITS, "{shown}");
            assert!(shown.contains("pending.json") && shown.contains("the next run takes it in"), "{shown}");
        }
    }
    let summary = summary(&out);
    for case in summary["cases"].as_array().unwrap() {
        for role in ["narrated", "designed"] {
            assert_eq!(case[role]["outcome"], "first answer", "{case}");
        }
    }
}

#[test]
fn what_was_changed_in_the_ledger_does_not_replay() {
    let folder = tempfile::tempdir().unwrap();
    let model = ScriptedModel::new(&TWO);
    let out = folder.path().join("suite");
    while run_tiny(&out, "batch", &[]).0 == WAITS {
        good_lines(&model, &out);
    }
    let is_exchange = |path: &std::path::PathBuf| path.file_stem().is_some_and(|stem| stem.len() == 64);
    let kept: Vec<_> = std::fs::read_dir(out.join("ledger")).unwrap().map(|e| e.unwrap().path()).collect();
    let retold =
        |path: &&std::path::PathBuf| std::fs::read_to_string(path).unwrap().contains("\"role\": \"paraphrase\"");
    let file = kept.iter().filter(|path| is_exchange(path)).find(retold).expect("an exchange");
    let whole = std::fs::read_to_string(file).unwrap();
    let exchange: Value = serde_json::from_str(&whole).unwrap();
    let with = |place: &str, value: Value| {
        let mut changed = exchange.clone();
        *changed.pointer_mut(place).unwrap() = value;
        changed.to_string()
    };
    let answer = exchange["answer"].as_str().unwrap().to_owned() + " ";
    let replay = || {
        std::fs::remove_dir_all(out.join("3-narratives")).unwrap();
        run_tiny(&out, "replay", &[])
    };
    for changed in [with("/answer", json!(answer)), with("/question/system", json!("x")), whole[..200].to_owned()] {
        std::fs::write(file, changed).unwrap();
        let (code, shown) = replay();
        assert_eq!(code, 1, "{shown}");
        assert!(shown.contains(file.file_name().unwrap().to_str().unwrap()) && shown.contains("remove it"), "{shown}");
        std::fs::create_dir_all(out.join("3-narratives")).unwrap();
    }
    #[cfg(unix)]
    {
        std::fs::remove_file(file).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(file).status().unwrap().success());
        let (code, shown) = replay();
        assert_eq!(code, 1, "{shown}");
        assert!(shown.contains("no regular file"), "{shown}");
        std::fs::create_dir_all(out.join("3-narratives")).unwrap();
        std::fs::remove_file(file).unwrap();
    }
    std::fs::write(file, whole).unwrap();
    assert_eq!(replay().0, 0);
}
