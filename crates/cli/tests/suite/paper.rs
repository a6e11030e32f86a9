//! The published method on NHTSA's file: its numbers, and whose crashes its scenarios are.

use crate::common::Place;
use serde_json::Value;

fn read(place: &Place, file: &str) -> Value {
    serde_json::from_slice(&std::fs::read(place.path(file)).unwrap()).unwrap()
}

#[test]
fn own_records_are_told_first_and_the_others_are_named_invented() {
    let Some(file) = recrash_testing::shared("data/nhtsa/ads-2021-06-to-2025-06.csv") else { return };
    let place = Place::new();
    let (code, _, error) =
        place.run(&["run", "--quiet", "--profile", "paper", "--records", file.to_str().unwrap(), "--out", "suite"]);
    assert_eq!(code, 0, "{error}");
    let (summary, records) = (read(&place, "suite/summary.json"), read(&place, "suite/1-records.json"));
    let funnel = summary["funnel"].to_string();
    assert!(funnel.contains("\"remaining\":1911") && funnel.contains("\"remaining\":235"), "{funnel}");
    let cases = summary["cases"].as_array().unwrap();
    let (own, invented): (Vec<&Value>, Vec<&Value>) = cases.iter().partition(|case| case["origin"]["is"] == "own");
    assert!(cases.len() == 20 && own.len() >= 17, "{} of {}", own.len(), cases.len());
    assert!(invented.iter().all(|case| case["origin"]["is"] == "invented" && case["told"].is_null()), "{invented:?}");
    assert!(own.iter().all(|case| case["tuned"]["faithful"] == "yes"), "{own:?}");
    let incidents: std::collections::BTreeSet<String> = own.iter().map(|case| case["told"].to_string()).collect();
    assert_eq!(incidents.len(), own.len(), "no crash is told twice");

    // Speed of the ego at the contact against the column's.
    let speed_of = |told: &Value| {
        let all = records["records"].as_array().unwrap();
        let name = |record: &Value| match &record["id"] {
            Value::String(id) => id.clone(),
            id => format!("{}/{}", id["report_id"].as_str().unwrap(), id["version"]),
        };
        all.iter().find(|record| Some(name(record).as_str()) == told.as_str())?["sv_speed_mps"].as_f64()
    };
    let mut misses: Vec<f64> = own
        .iter()
        .filter_map(|case| {
            let run = read(&place, &format!("suite/7-tuned-runs/{}.json", case["id"].as_str()?));
            let driven = run["judgement"]["metrics"]["contact"]["ego_speed_mps"].as_f64()?;
            Some((driven - speed_of(&case["told"])?).abs())
        })
        .collect();
    misses.sort_by(f64::total_cmp);
    assert!(misses.len() >= 12 && misses[misses.len() / 2] <= 2.0, "{misses:?}");
}
