//! A model that plays from a script: it answers with what the reader and the rules made of the same crash.

use super::{FEW, Place, recrash};
use serde_json::{Value, json};
use std::sync::OnceLock;

/// The model, with a suite that the rules made.
pub struct ScriptedModel {
    rules: Place,
    /// The accounts that the built-in reader makes of the few records.
    accounts: &'static [Value],
}

impl ScriptedModel {
    /// Makes the suite that it answers from.
    pub fn new(options: &[&str]) -> Self {
        static ACCOUNTS: OnceLock<Value> = OnceLock::new();
        let read = ACCOUNTS.get_or_init(|| {
            let read = recrash(&["read", FEW, "--json"]).output().unwrap();
            serde_json::from_slice(&read.stdout).unwrap()
        });
        let rules = Place::made(&[&["run", "--quiet"], options].concat());
        Self { rules, accounts: read["accounts"].as_array().unwrap() }
    }

    /// What became of the suite that the rules made.
    pub fn summary(&self) -> Value {
        self.read("summary.json".to_owned())
    }

    fn read(&self, file: String) -> Value {
        serde_json::from_slice(&std::fs::read(self.rules.path("suite").join(file)).unwrap()).unwrap()
    }

    /// A good answer to a conversation.
    pub fn answer(&self, messages: &[Value]) -> String {
        let asked = messages[1]["content"].as_str().unwrap();
        let id = scenario_id(asked);
        let good = if asked.starts_with("Read") {
            self.account(asked)
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

impl ScriptedModel {
    /// What the columns of the first report say, and the type that the reader finds.
    fn account(&self, asked: &str) -> Value {
        let line = asked.lines().find(|line| line.starts_with("Report ")).unwrap();
        let report = line.trim_start_matches("Report ").split(". ").next().unwrap();
        let column = |name: &str| {
            let value = line.split(&format!("{name}: ")).nth(1)?.split([';', '.', ',']).next()?;
            (!["unknown", "other", "none given", "not known"].contains(&value)).then(|| value.to_owned())
        };
        let fact = |name: &str, value: Value| json!({"value": value, "words": null, "column": name});
        let said = |name: &str| column(name).map(|value| fact(name, json!(value)));
        let zone = |name: &str| -> Vec<Value> {
            let code = column(name).map(|label| label.to_lowercase().replace(' ', "_"));
            code.into_iter().map(|code| fact(name, json!(code))).collect()
        };
        let of_report = |account: &&Value| account["report"] == report;
        let account = self.accounts.iter().find(of_report).unwrap_or_else(|| panic!("{report}"));
        json!({
            "report": report,
            "crash_type": account["crash_type"]["value"],
            "sv": {"movement": said("SV Pre-Crash Movement"), "zones": zone("SV Contact Area")},
            "partner": {"movement": said("CP Pre-Crash Movement"), "zones": zone("CP Contact Area")},
        })
    }
}

/// The scenario that a question is about.
pub fn scenario_id(asked: &str) -> &str {
    asked.split("scenario ").nth(1).unwrap().split(". ").next().unwrap().lines().next().unwrap().trim_end_matches('.')
}
