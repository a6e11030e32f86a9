//! The worked examples in the prompts are what they say: each passes through the very door that a model's answer passes,
//! and what can be run was run.

use crate::support;

use recrash_agents::llm::{Answers, AskError, Exchange, LanguageModel, Question, Repairs, TuneBrief};
use recrash_agents::{Design, expectation};
use recrash_metrics::{faithfulness, measure};
use recrash_model::metrics::{Check, Expectation, Metrics};
use recrash_model::narrative::{Fact, FactSource, FactValue, NARRATIVE_FORMAT, Narrative, Origin};
use recrash_model::record::{CrashRecord, RecordRef};
use recrash_model::scenario::{Approach, Author, SCENARIO_FORMAT, ScenarioDraft};
use recrash_model::template::Template;
use recrash_model::tuning::{Parameter, apply};
use recrash_sim::{Ego, simulate};
use serde_json::{Value, json};
use std::path::Path;

/// Answers every question with one text.
struct Says(String);

impl Answers for Says {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        Ok(support::exchange(question, self.0.clone()))
    }
}

/// The examples of a role, by name.
fn examples(role: &str) -> Vec<(String, Value)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("prompts");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of_role = |path: &Path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name.starts_with(role) && name.ends_with(".json")).then_some(name)
    };
    let mut found: Vec<(String, Value)> = files
        .filter_map(|path| Some((of_role(&path)?, serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap())))
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(!found.is_empty());
    found
}

/// The record that an example quotes.
fn record(example: &Value) -> CrashRecord {
    let template: Template = serde_json::from_value(example["template"].clone()).unwrap();
    let quoted = &example["records"][0];
    let mut record = support::record(template, quoted["narrative"].as_str().unwrap_or_default());
    if let Some(id) = quoted["id"].as_str() {
        record.id = RecordRef::try_from(id.to_owned()).unwrap();
    }
    record
}

fn narrative(text: &str, template: Template, approach: Approach) -> Narrative {
    let fact = |value| Fact { value, source: FactSource::Assumed { why: "told".into() } };
    Narrative {
        format: NARRATIVE_FORMAT.into(),
        scenario_id: "example".into(),
        template,
        records: Vec::new(),
        text: text.into(),
        facts: vec![fact(FactValue::Approach { approach })],
        origin: Origin::Invented { reason: "an example".into() },
        author: Author::Person,
    }
}

/// Runs a draft: what was measured, and the checks of faithfulness that fail.
fn run(draft: ScenarioDraft, expected: &Expectation) -> (Metrics, Vec<Check>) {
    let scenario = recrash_roads::check(draft).expect("it can be run").value;
    let rollout = simulate(&scenario, Ego::MetadriveIdm);
    let metrics = measure(&scenario, &rollout, &support::paper().failure);
    let verdict = faithfulness(&scenario, &rollout, &metrics, expected);
    let failures = verdict.failures().cloned().collect();
    (metrics, failures)
}

#[test]
fn every_design_is_taken_at_once_runs_is_faithful_and_comes_close() {
    for (name, example) in examples("design") {
        let (record, profile, repairs) = (record(&example), support::paper(), Repairs::default());
        let approach: Approach = serde_json::from_value(example["approach"].clone()).unwrap();
        let text = example["narrative"].as_str().unwrap();
        let narrative = narrative(text, record.template().unwrap(), approach);
        let answers = Says(example["answer"].to_string());
        let model = LanguageModel { model: "m", answers: &answers, max_repairs: 0, repairs: &repairs };
        let draft = model.design(&support::brief("01", &[&record], &profile, 1), &narrative, &[]);
        let draft = draft.unwrap_or_else(|e| panic!("{name}: {e}"));
        let (metrics, failures) = run(draft, &expectation(&narrative, &record, &profile));
        assert!(failures.is_empty(), "{name}: {failures:?}");
        let gap = metrics.min_gap.unwrap();
        assert!(gap.value < 4.0, "{name}: {gap:?}");
    }
}

#[test]
fn the_tuned_values_come_closer_than_every_try_and_the_tries_are_what_they_were() {
    for (name, example) in examples("tune") {
        let mut scenario = example["scenario"].clone();
        for (field, value) in [("format", json!(SCENARIO_FORMAT)), ("id", json!("example")), ("source", json!({}))] {
            scenario[field] = value;
        }
        let draft = recrash_roads::read_draft(&scenario.to_string()).unwrap().value;
        let parameters: Vec<Parameter> = serde_json::from_value(example["parameters"].clone()).unwrap();
        let template: Template = serde_json::from_value(examples("design")[0].1["template"].clone()).unwrap();
        let (record, profile, repairs) = (support::record(template, ""), support::paper(), Repairs::default());
        let narrative = narrative(example["narrative"].as_str().unwrap(), template, Approach::Left);
        let expected = expectation(&narrative, &record, &profile);
        let gap = |values: &[f64]| {
            let (metrics, failures) = run(apply(&draft, &parameters, values).unwrap(), &expected);
            assert!(failures.is_empty(), "{name} {values:?}: {failures:?}");
            metrics.min_gap.unwrap()
        };
        let (metrics, _) = run(draft.clone(), &expected);
        let answers = Says(example["answer"].to_string());
        let model = LanguageModel { model: "m", answers: &answers, max_repairs: 0, repairs: &repairs };
        let told = TuneBrief {
            narrative: &narrative,
            draft: &draft,
            metrics: &metrics,
            parameters: &parameters,
            history: &[],
        };
        let records = [&record];
        let brief = support::brief("01", &records, &profile, 1);
        let question = recrash_agents::llm::tune_question("m", &brief, &told).unwrap();
        let run_line = question.turns[0].text.lines().find(|line| line.starts_with("The design's run: ")).unwrap();
        assert_eq!(format!("The design's run: {}", example["metrics"].as_str().unwrap()), run_line, "{name}");
        let best = gap(&model.propose(&brief, &told).unwrap_or_else(|e| panic!("{name}: {e}")));
        for tried in example["tries"].as_array().unwrap() {
            let values: Vec<f64> = serde_json::from_value(tried["values"].clone()).unwrap();
            let gap = gap(&values);
            assert_eq!(tried["gap"], format!("{:.2} m at {:.1} s", gap.value, gap.time_s), "{name} {values:?}");
            assert!(best.value < gap.value, "{name}: {best:?} against {gap:?}");
        }
    }
}
