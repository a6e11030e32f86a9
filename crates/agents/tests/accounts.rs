//! What the rules say of whole records, case by case (`cases/accounts.toml`).

mod support;

use recrash_agents::Rules;
use recrash_model::record::{Coded, PartnerKind};
use recrash_model::template::{Movement, RoadType, Template};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    text: String,
    #[serde(default = "intersection")]
    road: RoadType,
    #[serde(default = "straight")]
    sv: Movement,
    #[serde(default = "straight")]
    cp: Movement,
    #[serde(default)]
    partner: PartnerKind,
    #[serde(default)]
    sv_zones: Vec<String>,
    #[serde(default)]
    cp_zones: Vec<String>,
    /// JSON of what the account must hold.
    says: String,
}

fn intersection() -> RoadType {
    RoadType::Intersection
}
fn straight() -> Movement {
    Movement::Straight
}

#[derive(Deserialize)]
struct Cases {
    case: Vec<Case>,
}

#[test]
fn every_record_is_read_as_told() {
    let profile = support::paper();
    let mut wrong = Vec::new();
    for case in toml::from_str::<Cases>(include_str!("cases/accounts.toml")).expect("well-formed cases").case {
        let template = Template { road: case.road, sv: case.sv, cp: case.cp, work_zone: false };
        let mut record = support::record(template, &case.text);
        record.partner = Coded::Known(case.partner);
        record.sv_zones = support::zones(&case.sv_zones);
        record.cp_zones = support::zones(&case.cp_zones);
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
