//! What the rules read, case by case (`cases/narratives.toml`), and where it stands.

use crate::support;

use recrash_agents::{Brief, Paraphrase, Rules};
use recrash_model::narrative::{FactSource, Narrative, Origin};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use serde::Deserialize;
use serde_json::Value;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    #[serde(flatten)]
    told: support::Told,
    #[serde(default = "retold")]
    is: String,
    because: Option<String>,
    #[serde(default)]
    facts: Vec<String>,
    #[serde(default)]
    never: Vec<String>,
}

fn retold() -> String {
    "own".to_owned()
}

#[derive(Deserialize)]
struct Cases {
    case: Vec<Case>,
}

fn cases() -> Vec<Case> {
    toml::from_str::<Cases>(include_str!("../cases/narratives.toml")).expect("well-formed cases").case
}

/// Whether a narrative states a fact; numbers may differ in the sixth digit.
fn states(narrative: &Narrative, wanted: &Value) -> bool {
    let same = |a: &Value, b: &Value| match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-5,
        _ => a == b,
    };
    narrative.facts.iter().any(|fact| {
        let stated = serde_json::to_value(&fact.value).expect("a fact");
        let (Some(stated), Some(wanted)) = (stated.as_object(), wanted.as_object()) else { return false };
        stated.len() == wanted.len()
            && stated.iter().all(|(key, value)| wanted.get(key).is_some_and(|other| same(value, other)))
    })
}

#[test]
fn every_case_is_read_as_told() {
    let profile = support::paper();
    let mut wrong = Vec::new();
    for case in cases() {
        let narrative = support::narrate(&case.told.record(), &profile).value;
        let (is, reason) = match &narrative.origin {
            Origin::Own => ("own", ""),
            Origin::Other { reason, .. } => ("other", reason.as_str()),
            Origin::Invented { reason } => ("invented", reason.as_str()),
        };
        if is != case.is {
            wrong.push(format!("{}: is {is} ({reason})", case.name));
        }
        if case.because.as_ref().is_some_and(|because| !reason.contains(because.as_str())) {
            wrong.push(format!("{}: the reason is \"{reason}\"", case.name));
        }
        let json = |text: &String| serde_json::from_str::<Value>(text).expect("a fact as JSON");
        let facts = || narrative.facts.iter().map(|f| format!("\n    {f:?}")).collect::<String>();
        for fact in case.facts.iter().filter(|fact| !states(&narrative, &json(fact))) {
            wrong.push(format!("{}: does not state {fact}{}", case.name, facts()));
        }
        for fact in case.never.iter().filter(|fact| states(&narrative, &json(fact))) {
            wrong.push(format!("{}: states {fact}{}", case.name, facts()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn words_stand_in_the_narrative_as_they_are() {
    let profile = support::paper();
    let mut quoted = 0;
    for case in cases() {
        let record = case.told.record();
        for fact in support::narrate(&record, &profile).value.facts {
            if let FactSource::Words { record: from, words } = fact.source {
                assert_eq!(from, record.id);
                assert!(record.narrative.contains(&words), "{}: \"{words}\"", case.name);
                quoted += 1;
            }
        }
    }
    assert!(quoted > 60, "{quoted}");
}

#[test]
fn texts_are_two_to_five_sentences_of_our_own() {
    let profile = support::paper();
    for case in cases() {
        let narrative = support::narrate(&case.told.record(), &profile).value;
        let sentences = narrative.text.matches(". ").count() + 1;
        assert!((2..=5).contains(&sentences), "{}: {}", case.name, narrative.text);
        assert!(narrative.text.ends_with('.'));
        assert!(!narrative.text.contains(&case.told.text));
    }
}

#[test]
fn mph_stand_in_brackets_where_the_record_tells_them() {
    let record = support::record(
        support::template(RoadType::Intersection, Movement::Straight, Movement::Straight),
        "The AV was traveling at 20 mph. A car came from the right and hit it.",
    );
    let text = support::narrate(&record, &support::paper()).value.text;
    assert!(text.contains("8.9 m/s (20 mph)"), "{text}");
}

#[test]
fn what_is_known_to_be_untold_is_invented_and_says_why() {
    let template = support::template(RoadType::Intersection, Movement::Straight, Movement::Straight);
    let record = support::record(template, "A car came from the left and hit the AV.");
    let (profile, records) = (support::paper(), [&record]);
    let brief = support::brief("01-test", &records, &profile, 7);
    let narrate = |brief: &Brief| Rules.paraphrase(brief).expect("a narrative");
    assert_eq!(narrate(&brief).value.origin, Origin::Own);
    let outcome = narrate(&Brief { untold: Some("the account says otherwise"), ..brief });
    assert!(outcome.value.origin.reason().is_some_and(|why| why.starts_with("the account says otherwise; ")));
    assert_eq!((outcome.value.told_record(), outcome.diagnostics[0].code.as_ref()), (None, "narrative.invented"));
}

#[test]
fn an_ego_that_stood_is_not_retold_as_one_that_drove() {
    let template = support::template(RoadType::Intersection, Movement::Straight, Movement::Straight);
    let mut record = support::record(template, "A car came from the left and hit the AV.");
    record.sv_speed_mps = Some(0.4);
    let reason = support::narrate(&record, &support::paper()).value.origin.reason().map(str::to_owned);
    assert!(reason.as_ref().is_some_and(|why| why.contains("stood or crept, at 0.4 m/s")), "{reason:?}");
}

#[test]
fn an_alternative_binds_no_contact_zones() {
    let template = support::template(RoadType::Intersection, Movement::Straight, Movement::Straight);
    let profile = support::paper();
    let mut record = support::record(template, "A car came from the left and hit the AV.");
    record.sv_zones = vec![ContactZone::Left];
    let retold = support::narrate(&record, &profile).value;
    assert_eq!(recrash_agents::expectation(&retold, &record, &profile).sv_zones, record.sv_zones);
    record.narrative = "The AV was rear ended by a car.".into();
    let alternative = support::narrate(&record, &profile).value;
    let expectation = recrash_agents::expectation(&alternative, &record, &profile);
    assert!(expectation.sv_zones.is_empty());
    assert_eq!(expectation.excluded, profile.excludes.collisions);
}
