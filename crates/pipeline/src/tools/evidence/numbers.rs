//! The numbers of the evidence, each with the formula that the checker works it out by.

use super::number::{Number, counted, find, holds, shown};
use super::{TestFacts, corpus};
use recrash_model::results::TestOutcome;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Quantile of the standard normal for 95 %, two-sided.
const Z95: f64 = 1.959_963_984_540_054;

/// Formulas of a contact whose greatest value is claimed.
const DELTA_V: [&str; 2] = ["ego_delta_v", "other_delta_v"];

/// All numbers: of each run, then counts and shares.
pub fn all(tests: &[TestFacts], reports: &BTreeMap<&'static str, Value>) -> Vec<Number> {
    let mut numbers: Vec<Number> = tests.iter().flat_map(of_run).collect();
    let runs = |filter: Value| ("runs.json", "tests", filter);
    let mut list = Counted { tests, numbers: &mut numbers };
    list.count("tests", runs(json!({})));
    for (id, verdict) in [("passed", "passed"), ("failed", "failed"), ("not_run", "not run")] {
        list.count(id, runs(json!({ "verdict": verdict })));
    }
    list.count("passed, not met", runs(json!({ "verdict": "passed", "met": false })));
    list.count("passed, beyond tyres", runs(json!({ "verdict": "passed", "beyond_tyres": true })));
    list.share("failed_share", "failed", "tests");
    for (field, of) in [
        ("crash_type", (|test: &TestFacts| Some(test.crash_type)) as fn(&TestFacts) -> Option<&'static str>),
        ("provenance", |test| Some(test.provenance)),
        ("cause", |test| test.cause),
        ("preventability", |test| test.preventability),
    ] {
        let values: BTreeSet<&str> = tests.iter().filter_map(of).collect();
        for value in values {
            let id = format!("{field}: {value}");
            list.count(&id, runs(json!({ field: value })));
            if matches!(field, "crash_type" | "provenance") {
                list.count(&format!("{id}, failed"), runs(json!({ field: value, "verdict": "failed" })));
            }
        }
    }
    numbers.push(greatest_delta_v(&numbers));
    for (report, value) in reports {
        match *report {
            corpus::NAME => corpus::numbers(value, &mut numbers),
            report => of_report(report, value, &mut numbers),
        }
    }
    numbers
}

/// Numbers of one run: what its rollout shows.
fn of_run(test: &TestFacts) -> Vec<Number> {
    let Some(outcome) = &test.outcome else { return Vec::new() };
    let number = |formula: &'static str, value: Value, unit: &'static str| Number {
        id: format!("{formula} of {}", test.id),
        formula,
        of: BTreeMap::from([("test", Value::from(test.id.as_str()))]),
        shown: shown(&value, unit),
        value,
        unit,
    };
    let TestOutcome { state_hash, duration_s, least_gap, contact, severity, .. } = outcome;
    let mut all = vec![
        number("state_hash", Value::from(state_hash.as_str()), ""),
        number("verdict", Value::from(test.verdict), ""),
        number("duration", Value::from(*duration_s), "s"),
    ];
    all.extend(least_gap.map(|gap| number("least_gap", Value::from(gap.value), "m")));
    if let (Some(contact), Some(severity)) = (contact, severity) {
        all.extend([
            number("contact_time", Value::from(contact.time_s), "s"),
            number("ego_speed", Value::from(contact.ego_speed_mps), "m/s"),
            number("other_speed", Value::from(contact.other_speed_mps), "m/s"),
            number("closing_speed", Value::from(contact.relative_speed_mps), "m/s"),
            number("ego_delta_v", Value::from(severity.first.delta_v_mps), "m/s"),
            number("other_delta_v", Value::from(severity.second.delta_v_mps), "m/s"),
        ]);
    }
    all
}

/// The greatest change of velocity in any contact.
fn greatest_delta_v(numbers: &[Number]) -> Number {
    let all = numbers.iter().filter(|number| DELTA_V.contains(&number.formula)).filter_map(|n| n.value.as_f64());
    let value = Value::from(all.fold(0.0, f64::max));
    Number {
        id: "greatest_delta_v".to_owned(),
        formula: "max",
        of: BTreeMap::from([("over", json!(DELTA_V))]),
        shown: shown(&value, "m/s"),
        value,
        unit: "m/s",
    }
}

/// Counts in a report of another command.
fn of_report(report: &str, value: &Value, numbers: &mut Vec<Number>) {
    let (list, counts): (&str, &[(&str, Value)]) = match report {
        "robustness" => (
            "failures",
            &[
                ("robustness: failures", json!({})),
                ("robustness: robust", json!({ "robust": true })),
                ("robustness: marginal", json!({ "marginal": true })),
                ("robustness: step artefacts", json!({ "step_artefact": true })),
                ("robustness: robust, fails on the second", json!({ "robust": true, "confirmed": true })),
                ("robustness: robust, passes on the second", json!({ "robust": true, "confirmed": false })),
                ("robustness: robust, not run on a second", json!({ "robust": true, "confirmed": null })),
            ],
        ),
        _ => (
            "pairs",
            &[
                ("parity: pairs", json!({})),
                ("parity: failed natively", json!({ "native/failed": true })),
                ("parity: failed on both", json!({ "native/failed": true, "metadrive/failed": true })),
            ],
        ),
    };
    let file = format!("reports/{report}.json");
    for (id, filter) in counts {
        let members = value[list].as_array().map_or(&[][..], Vec::as_slice);
        let count = members.iter().filter(|member| holds(member, filter)).count();
        numbers.push(counted(id, [&file, list], filter.clone(), count));
    }
    match report {
        "robustness" => shares(numbers, "robustness: robust share", "robustness: robust", "robustness: failures"),
        _ => shares(numbers, "parity: confirmed share", "parity: failed on both", "parity: failed natively"),
    }
}

/// Counts over the tests.
struct Counted<'a> {
    tests: &'a [TestFacts],
    numbers: &'a mut Vec<Number>,
}

impl Counted<'_> {
    fn count(&mut self, id: &str, (file, list, filter): (&str, &str, Value)) {
        let member = |test: &TestFacts| serde_json::to_value(test).unwrap_or_default();
        let count = self.tests.iter().filter(|test| holds(&member(test), &filter)).count();
        self.numbers.push(counted(id, [file, list], filter, count));
    }

    fn share(&mut self, id: &str, of: &str, among: &str) {
        shares(self.numbers, id, of, among);
    }
}

/// A share with its interval of 95 % (wilson1927).
fn shares(numbers: &mut Vec<Number>, id: &str, of: &str, among: &str) {
    let value = |name: &str| find(numbers, name).and_then(|number| number.value.as_f64()).unwrap_or(0.0);
    let (part, whole) = (value(of), value(among));
    let share = if whole > 0.0 { part / whole } else { 0.0 };
    let end = |sign: f64| {
        if whole == 0.0 {
            return if sign < 0.0 { 0.0 } else { 1.0 };
        }
        let extra = Z95 * Z95 / whole;
        let spread = Z95 * (share * (1.0 - share) / whole + extra / (4.0 * whole)).sqrt();
        (share + extra / 2.0 + sign * spread) / (1.0 + extra)
    };
    let (low, high) = (end(-1.0), end(1.0));
    let parts = [
        ("share", String::new(), share),
        ("wilson_low", ", at least".to_owned(), low),
        ("wilson_high", ", at most".to_owned(), high),
    ];
    for (formula, suffix, value) in parts {
        let value = Value::from(value);
        numbers.push(Number {
            id: format!("{id}{suffix}"),
            formula,
            of: BTreeMap::from([("of", Value::from(of)), ("among", Value::from(among))]),
            shown: shown(&value, "%"),
            value,
            unit: "%",
        });
    }
}
