//! `recrash eval`: on the invented sample with labels of our own, and on NHTSA's files where they are there.

use crate::common::recrash;
use serde_json::Value;
use std::path::PathBuf;

const HEADER: &str = "half,report,version,file,entity,road,sv_movement,cp_movement,approach,order,sv_zones,cp_zones,collision,excluded,note";
/// Right in every field that is known; its half is the developed one.
const DEV: &str = "dev,90103-311,1,sample,Acme,intersection,straight,straight,left,unknown,,,angle,no,";
/// Wrong on purpose: the partner came from the right.
const HELD_OUT: &str = "held-out,90101-317,1,sample,Acme,intersection,straight,straight,left,unknown,,,angle,no,";
const NOWHERE: &str = "dev,90104-99994,1,sample,Acme,street,unknown,unknown,unknown,unknown,,,unknown,unknown,";

struct Files {
    folder: tempfile::TempDir,
    records: PathBuf,
    labels: PathBuf,
}

fn files(labels: &[&str]) -> Files {
    let folder = tempfile::tempdir().unwrap();
    let records = folder.path().join("sample.csv");
    std::fs::write(&records, recrash_records::SAMPLE_CSV).unwrap();
    let path = folder.path().join("labels.csv");
    std::fs::write(&path, format!("{HEADER}\n{}\n", labels.join("\n"))).unwrap();
    Files { folder, records, labels: path }
}

fn eval(files: &Files, more: &[&str]) -> std::process::Output {
    let (records, labels) = (files.records.to_str().unwrap(), files.labels.to_str().unwrap());
    let agent = if more.contains(&"--agent") { &[][..] } else { &["--agent", "rules"] };
    recrash(&["eval", "--records", records, "--labels", labels]).args(agent).args(more).output().unwrap()
}

fn json(output: &std::process::Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn share(evaluation: &Value, half: &str, field: &str) -> f64 {
    let halves = evaluation["halves"].as_array().unwrap();
    let half = halves.iter().find(|entry| entry["half"] == half).unwrap();
    let fields = half["fields"].as_array().unwrap();
    fields.iter().find(|entry| entry["field"] == field).unwrap()["share"].as_f64().unwrap()
}

#[test]
fn scores_are_told_by_half_and_held_out_disagreements_only_where_they_are_asked_for() {
    let files = files(&[DEV, HELD_OUT]);
    let both = json(&eval(&files, &["--json"]));
    assert_eq!((share(&both, "dev", "approach"), share(&both, "held-out", "approach")), (1.0, 0.0));
    assert_eq!(both["disagreements"].as_array().unwrap().len(), 0, "{both:#}");
    let held_out = json(&eval(&files, &["--json", "--half", "held-out"]));
    let shown = &held_out["disagreements"][0];
    assert_eq!(
        (&shown["record"], &shown["label"], &shown["said"]),
        (&"90101-317/1".into(), &"left".into(), &"right".into())
    );
    let text = eval(&files, &[]);
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(text.find("held-out").unwrap() < text.find("1 dev").unwrap(), "the headline comes first: {text}");
}

#[test]
fn records_that_are_not_there_are_named_and_where_none_is_the_command_stops() {
    let some = eval(&files(&[DEV, NOWHERE]), &[]);
    assert!(some.status.success());
    assert!(String::from_utf8_lossy(&some.stderr).contains("90104-99994/1"));
    let none = eval(&files(&[NOWHERE]), &[]);
    assert_eq!(none.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&none.stderr).contains("90104-99994/1"));
}

#[test]
fn wrong_labels_are_told_by_row_and_column() {
    let wrong = DEV.replace(",left,", ",behind,");
    let output = eval(&files(&[&wrong]), &[]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("row 1") && told.contains("\"approach\"") && told.contains("behind"), "{told}");
}

#[test]
fn a_model_is_asked_by_batch_and_its_corrections_are_scored() {
    let mut files = files(&[]);
    files.labels = files.folder.path().join("accounts.csv");
    let row = "dev,90103-311,1,sample,intersection,responder,cp,moving,under_way,human,straight,straight,left,unknown,sv_and_partner,,,unknown,";
    std::fs::write(&files.labels, format!("{ACCOUNTS_HEADER}\n{row}\n")).unwrap();
    // The reader has another answer to who drove.
    assert_eq!(share(&json(&eval(&files, &["--agent", "reader", "--json"])), "dev", "driver"), 0.0);
    let out = files.folder.path().join("run");
    let more = ["--agent", "some-model", "--llm", "batch", "--out", out.to_str().unwrap(), "--json"];
    assert_eq!(eval(&files, &more).status.code(), Some(4));
    let request: Value = serde_json::from_str(&std::fs::read_to_string(out.join("requests.jsonl")).unwrap()).unwrap();
    let driver = serde_json::json!({"value": "human", "words": "Level 4 operation was active"});
    let answer = serde_json::json!({"report": "90103-311/1", "driver": driver});
    let line = serde_json::json!({
        "custom_id": request["custom_id"],
        "response": {"status_code": 200, "body": {"choices": [{"message": {"role": "assistant", "content": answer.to_string()}}],
            "usage": {"prompt_tokens": 1, "completion_tokens": 1, "total_tokens": 2}}},
        "error": null
    });
    std::fs::write(out.join("responses.jsonl"), format!("{line}\n")).unwrap();
    let scored = json(&eval(&files, &more));
    assert_eq!(share(&scored, "dev", "driver"), 1.0);
    // What the model does not tell is as the reader has it.
    assert_eq!((share(&scored, "dev", "came_from"), share(&scored, "dev", "crash_type")), (1.0, 1.0));
}

/// The bounds are the targets of the evaluation, as totals (`docs/models/evaluation.md`).
#[test]
fn the_rules_read_the_held_out_half_as_well_as_the_documentation_says() {
    let Some(shared) = recrash_testing::shared("data/nhtsa") else { return };
    let files = ["ads-2021-06-to-2025-06.csv", "ads-2025-06-to-2026-01.csv"].map(|name| shared.join(name));
    let names = files.each_ref().map(|path| path.to_str().unwrap());
    let evaluation = json(
        &recrash(&["eval", "--agent", "rules", "--json", "--records", names[0], "--records", names[1]])
            .output()
            .unwrap(),
    );
    for (field, least) in [
        ("road", 0.95),
        ("approach", 0.85),
        ("sv_movement", 0.85),
        ("cp_movement", 0.85),
        ("sv_zones", 0.9),
        ("cp_zones", 0.9),
        ("excluded", 0.85),
    ] {
        let share = share(&evaluation, "held-out", field);
        assert!(share >= least, "{field}: {share}");
    }
}

const ACCOUNTS_HEADER: &str = "half,report,version,file,crash_type,role,striker,sv_state,sv_since,driver,sv_movement,cp_movement,came_from,order,first_contact,sv_zones,cp_zones,sv_impact_mps,note";

#[test]
fn the_reader_is_scored_on_labels_of_accounts_and_those_only() {
    let mut files = files(&[DEV]);
    let refused = eval(&files, &["--agent", "reader"]);
    assert_eq!(refused.status.code(), Some(3), "labels of records are not of accounts");
    files.labels = files.folder.path().join("accounts.csv");
    let row = "dev,90103-311,1,sample,intersection,responder,cp,moving,under_way,unknown,straight,none,left,unknown,sv_and_partner,,,unknown,";
    std::fs::write(&files.labels, format!("{ACCOUNTS_HEADER}\n{row}\n")).unwrap();
    let scored = json(&eval(&files, &["--agent", "reader", "--json"]));
    assert_eq!((share(&scored, "dev", "came_from"), share(&scored, "dev", "crash_type")), (1.0, 1.0));
    // Its partner is a vehicle, and has a movement.
    assert_eq!(share(&scored, "dev", "cp_movement"), 0.0);
    let half = &scored["halves"][0];
    let field = |name: &str| {
        half["fields"]
            .as_array()
            .unwrap()
            .iter()
            .find(|field| field["field"] == name)
            .unwrap_or_else(|| panic!("{name}"))
            .clone()
    };
    // What the label does not know counts neither way, and of labels of one's own no second reader is known.
    assert_eq!((&field("driver")["scored"], &field("driver")["unknown"]), (&0.into(), &1.into()));
    assert!(field("role").get("readers").is_none(), "{half:#}");
}

/// The bounds are what the reader reached when it was last mended, less two records, as totals (`docs/models/evaluation.md`).
#[test]
fn the_reader_reads_the_held_out_half_as_well_as_the_documentation_says() {
    let Some(shared) = recrash_testing::shared("data/nhtsa") else { return };
    let files = ["ads-2021-06-to-2025-06.csv", "ads-2025-06-to-2026-01.csv"].map(|name| shared.join(name));
    let names = files.each_ref().map(|path| path.to_str().unwrap());
    let arguments = ["eval", "--half", "held-out", "--records", names[0], "--records", names[1]];
    let text = recrash(&arguments).output().unwrap();
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(text.contains("two readers agree") && text.contains("163/165"), "{text}");
    let evaluation = json(&recrash(&[&arguments[..], &["--json"]].concat()).output().unwrap());
    for (field, least) in FLOORS {
        let share = share(&evaluation, "held-out", field);
        assert!(share >= least, "{field}: {share}");
    }
}

/// Reports of our own writing, by people who saw no program: they need no crash file. The bounds are what the reader reached, less three.
#[test]
fn the_reader_reads_invented_reports_as_well_as_the_documentation_says() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../eval");
    let (records, labels) = (folder.join("stories.csv"), folder.join("stories-labels.csv"));
    let (records, labels) = (records.to_str().unwrap(), labels.to_str().unwrap());
    let arguments = ["eval", "--agent", "reader", "--half", "dev", "--records", records, "--labels", labels, "--json"];
    let evaluation = json(&recrash(&arguments).output().unwrap());
    for (field, least) in STORY_FLOORS {
        let share = share(&evaluation, "dev", field);
        assert!(share >= least, "{field}: {share}");
    }
}

const STORY_FLOORS: [(&str, f64); 10] = [
    ("crash_type", 0.92),
    ("role", 0.90),
    ("striker", 0.92),
    ("sv_state", 0.97),
    ("driver", 0.96),
    ("sv_movement", 0.95),
    ("cp_movement", 0.86),
    ("came_from", 0.89),
    ("order", 0.91),
    ("first_contact", 0.94),
];

const FLOORS: [(&str, f64); 14] = [
    ("crash_type", 0.84),
    ("role", 0.87),
    ("striker", 0.87),
    ("sv_state", 0.92),
    ("sv_since", 0.79),
    ("driver", 0.93),
    ("sv_movement", 0.84),
    ("cp_movement", 0.79),
    ("came_from", 0.69),
    ("order", 0.90),
    ("first_contact", 0.90),
    ("sv_zones", 0.93),
    ("cp_zones", 0.94),
    ("sv_impact_mps", 0.97),
];
