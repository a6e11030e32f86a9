//! What the rules say of whole records, case by case (`cases/accounts.toml`).

use crate::support;

use recrash_agents::Rules;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    #[serde(flatten)]
    told: support::Told,
    /// JSON of what the account must hold.
    says: String,
}

#[derive(Deserialize)]
struct Cases {
    case: Vec<Case>,
}

#[test]
fn every_record_is_read_as_told() {
    let profile = support::paper();
    let mut wrong = Vec::new();
    for case in toml::from_str::<Cases>(include_str!("../cases/accounts.toml")).expect("well-formed cases").case {
        let record = case.told.record();
        let account = serde_json::to_value(Rules.account(&record, &profile)).expect("an account");
        let says: serde_json::Value = serde_json::from_str(&case.says).expect("JSON");
        for (field, value) in says.as_object().expect("an object") {
            if account[field] != *value {
                wrong.push(format!("{}: {field} is {}, not {value}", case.name, account[field]));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
