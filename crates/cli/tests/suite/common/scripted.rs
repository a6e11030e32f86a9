//! A model that plays from a script: it answers with what the rules wrote for the same scenario.

use super::recrash;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The model, with a suite that the rules made.
pub struct ScriptedModel {
    rules: PathBuf,
}

impl ScriptedModel {
    /// Makes the suite that it answers from.
    pub fn new(folder: &Path, options: &[&str]) -> Self {
        let rules = folder.join("rules");
        recrash(&["run", "--quiet", "--out", rules.to_str().unwrap()]).args(options).assert().success();
        Self { rules }
    }

    fn read(&self, file: String) -> Value {
        serde_json::from_slice(&std::fs::read(self.rules.join(file)).unwrap()).unwrap()
    }

    /// A good answer to a conversation.
    pub fn answer(&self, messages: &[Value]) -> String {
        let asked = messages[1]["content"].as_str().unwrap();
        let id = scenario_id(asked);
        let good = if asked.starts_with("Retell") {
            let narrative = self.read(format!("3-narratives/{id}.json"));
            let reason = narrative["origin"].get("reason").cloned().unwrap_or(Value::Null);
            json!({"text": narrative["text"], "facts": narrative["facts"], "replaces_record": reason})
        } else if asked.starts_with("Design") {
            self.read(format!("4-scenarios/{id}.json"))
        } else {
            assert!(asked.starts_with("Tune"), "{asked}");
            let log = self.read(format!("6-tuned/{id}.search.json"));
            let starts: Vec<Value> = log["parameters"].as_array().unwrap().iter().map(|p| p["start"].clone()).collect();
            json!({ "values": starts })
        };
        good.to_string()
    }
}

/// The scenario that a question is about.
pub fn scenario_id(asked: &str) -> &str {
    asked.split("scenario ").nth(1).unwrap().split(". ").next().unwrap().lines().next().unwrap().trim_end_matches('.')
}
