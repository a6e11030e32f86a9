//! Accounts that a language model reads: what is taken, and what goes back to it. Everything here is made up.

use crate::support::{self, Script};

use recrash_agents::llm::{LanguageModel, Repairs};
use recrash_agents::{AgentError, Brief, Paraphrase};
use recrash_model::account::{ACCOUNT_FORMAT, Account, ContactState, CrashType, Origin, Party, Place, told};
use recrash_model::narrative::{FactValue, Origin as Whose};
use recrash_model::record::CrashRecord;
use recrash_model::scenario::{Approach, Author};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;
use serde_json::{Value, json};
use std::path::Path;

const TOLD: &str = "A GM test vehicle was driving straight on Elm Street in autonomous mode when a red sedan came from the left \
                    and failed to stop. The front of the test vehicle struck the right side of the sedan at 12 mph.";

fn record() -> CrashRecord {
    let template = support::template(RoadType::Intersection, Movement::Straight, Movement::Straight);
    CrashRecord {
        sv_zones: vec![ContactZone::Front],
        cp_zones: vec![ContactZone::Right],
        ..support::record(template, TOLD)
    }
}

/// What a reader gives that understands nothing.
fn nothing(record: &CrashRecord) -> Account {
    Account {
        format: ACCOUNT_FORMAT.into(),
        incident: "i".into(),
        report: record.id.clone(),
        reports: vec![record.id.clone()],
        text_hash: String::new(),
        words: 30,
        crash_type: None,
        role: None,
        striker: None,
        scenario: None,
        matrix: None,
        first_contact: None,
        place: Place::default(),
        sv: Party::default(),
        partner: None,
        came_from: None,
        ahead: None,
        order: None,
        driver: None,
        others: Vec::new(),
        door: None,
        injury: None,
        damage: None,
        partner_left: None,
        contradictions: Vec::new(),
        author: Author::Rules,
    }
}

fn quoted(value: impl Into<Value>, words: &str) -> Value {
    json!({"value": value.into(), "words": words, "column": null})
}

/// A good answer about [`record`].
fn good() -> Value {
    json!({
        "report": "1-1/1",
        "crash_type": "intersection",
        "sv": {
            "movement": quoted("straight", "driving straight"),
            "state": quoted("moving", "driving straight"),
            "speeds": [quoted(json!({"mps": 5.4, "meaning": "impact"}), "at 12 mph")],
            "zones": [{"value": "front", "words": null, "column": "SV Contact Area"}],
        },
        "partner": {
            "kind": quoted("passenger_car", "a red sedan"),
            "movement": {"value": "straight", "words": null, "column": "CP Pre-Crash Movement"},
            "zones": [quoted("right", "the right side of the sedan")],
        },
        "came_from": quoted(json!({"cross": {"side": "left"}}), "came from the left"),
        "striker": quoted("sv", "The front of the test vehicle struck the right side of the sedan"),
        "driver": quoted("system", "in autonomous mode"),
    })
}

/// The good answer with something else in it, by JSON pointer.
fn with(changes: &[(&str, Value)]) -> Value {
    let mut answer = good();
    for (pointer, value) in changes {
        *answer.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value.clone();
    }
    answer
}

/// Has the answers read, with so many repairs; gives the account, and how many answers went back.
fn read(script: &Script, max_repairs: usize) -> (Result<Account, AgentError>, usize) {
    let (record, profile, repairs) = (record(), support::paper(), Repairs::default());
    let (records, base) = ([&record], nothing(&record));
    let brief = Brief { account: Some(&base), ..support::brief("01", &records, &profile, 1) };
    let model = LanguageModel { model: "m", answers: script, max_repairs, repairs: &repairs };
    let account = model.read(&brief, &base);
    (account, repairs.all())
}

#[test]
fn a_good_answer_is_an_account_with_its_sources() {
    let (account, repairs) = read(&Script::new(&[good()]), 0);
    let account = account.unwrap();
    assert_eq!(repairs, 0);
    assert_eq!(told(&account.crash_type), Some(CrashType::Intersection));
    let from = account.came_from.unwrap();
    assert_eq!(from.value, Origin::Cross { side: recrash_model::account::LeftRight::Left });
    let recrash_model::account::Source::Words { start, end, text } = from.source else { panic!("{from:?}") };
    assert_eq!((&TOLD[start..end], text.as_str()), ("came from the left", "came from the left"));
    assert_eq!(told(&account.sv.state), Some(ContactState::Moving));
    assert_eq!(account.author, Author::Model("m".into()));
}

/// Three answers that version 0.1 took for the record's crash: none of them tells it.
#[test]
fn false_accounts_are_refused() {
    let none = json!({"report": "1-1/1", "crash_type": "intersection", "sv": {}});
    let elsewhere = with(&[("/report", json!("9-99/1"))]);
    let company = with(&[("/came_from", quoted(json!({"cross": {"side": "right"}}), "GM"))]);
    for (answer, why) in [
        (none, "it tells 0 facts"),
        (elsewhere, "report is 9-99/1; the report to read is 1-1/1"),
        (company, "came_from.words do not say it"),
    ] {
        let (account, _) = read(&Script::new(&[answer]), 0);
        let error = account.unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn every_fact_is_held_against_its_words_or_its_column() {
    for (pointer, value, why) in [
        ("/came_from/words", json!("came from the right"), "do not stand in the narrative"),
        ("/came_from/value", json!("behind"), "came_from.words do not say it"),
        ("/sv/movement/value", json!("left_turn"), "sv.movement.words do not say it"),
        ("/sv/speeds/0/value/mps", json!(12.0), "sv.speeds[0].words do not say it"),
        ("/partner/movement/value", json!("left_turn"), "the column CP Pre-Crash Movement of 1-1/1 says otherwise"),
        ("/partner/movement/column", json!("Weather"), "Weather is no column that tells it"),
        ("/sv/zones/0/value", json!("rear"), "the column SV Contact Area of 1-1/1 says otherwise"),
        ("/driver/words", json!("driving straight on"), "driver.words do not say it"),
        ("/crash_type", json!("cyclist"), "the partner is of another kind"),
        ("/crash_type", json!("front_to_rear"), "from a crossing road on the left has no such crash"),
    ] {
        let (account, _) = read(&Script::new(&[with(&[(pointer, value)])]), 0);
        let error = account.unwrap_err().to_string();
        assert!(error.contains(why), "{pointer}: {error}");
    }
}

/// Five conversations with a poor model: drafts, comments, forms that are wrong in several places, and facts nobody told. With two
/// repairs of each sort four of them end with an account.
#[test]
fn a_poor_model_is_understood_in_four_of_five() {
    let text = good().to_string();
    let draft = json!({"report": "1-1/1", "crash_type": "lateral", "sv": {}});
    let messy =
        format!("<think>Perhaps {draft}</think>Here you are:\n```json\n// read\n{},}}\n```", &text[..text.len() - 1]);
    let formless =
        with(&[("/crash_type", json!("crossing")), ("/sv/speeds/0/value/mps", json!(500)), ("/report", json!(7))]);
    let unknown = with(&[("/sv", json!({"position": 3, "zones": "front"}))]);
    let misquoted = with(&[("/came_from/words", json!("from the left side"))]);
    let conversations: [&[String]; 5] = [
        &[messy],
        &[formless.to_string(), text.clone()],
        &["I cannot say.".into(), unknown.to_string(), misquoted.to_string(), text.clone()],
        &[misquoted.to_string(), text.clone()],
        &[misquoted.to_string()],
    ];
    let scripts: Vec<Script> = conversations.iter().map(|lines| Script::new(lines)).collect();
    let read: Vec<(bool, usize)> =
        scripts.iter().map(|script| read(script, 2)).map(|(account, repairs)| (account.is_ok(), repairs)).collect();
    assert_eq!(read, [(true, 0), (true, 1), (true, 3), (true, 1), (false, 2)]);
    // All that is wrong with a form is told at once.
    let told = scripts[1].last_told();
    for part in [
        "crash_type is \"crossing\"; it is one of",
        "sv.speeds[0].value.mps is 500; 60 is the most",
        "report is 7; it must be of type",
    ] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
}

/// The account that these corrections make of the good one.
fn mended(corrections: Value) -> Result<Account, String> {
    let (record, profile, repairs) = (record(), support::paper(), Repairs::default());
    let draft = read(&Script::new(&[good()]), 0).0.unwrap();
    let script = Script::new(&[corrections]);
    let records = [&record];
    let brief = Brief { account: Some(&draft), ..support::brief("01", &records, &profile, 1) };
    let model = LanguageModel { model: "m", answers: &script, max_repairs: 0, repairs: &repairs };
    model.read(&brief, &draft).map_err(|error| error.to_string())
}

#[test]
fn what_a_model_does_not_correct_stays_as_it_was() {
    let draft = read(&Script::new(&[good()]), 0).0.unwrap();
    assert_eq!(mended(json!({"report": "1-1/1"})).unwrap(), draft);
    // A fact that the draft has keeps its words, whatever is quoted for it.
    let same = json!({"report": "1-1/1", "came_from": {"value": {"cross": {"side": "left"}}}});
    assert_eq!(mended(same).unwrap(), draft);
    let acts = |words: &str| {
        json!({"report": "1-1/1", "nobody_tells": ["driver", "sv.movement"], "partner": {"acts": [
            {"act": "enter", "side": "left", "step": 2, "words": "came from the left"},
            {"act": "run_stop", "step": 3, "words": words}]},
            "others": [{"kind": {"value": "passenger_car", "words": "a red sedan"}, "place": {"value": "ahead", "words": "came from"}}]})
    };
    let refused = mended(acts("failed to stop")).unwrap_err();
    assert!(refused.contains("others[0].place.words do not say it"), "{refused}");
    let mut right = acts("failed to stop");
    right["others"] = json!([]);
    let account = mended(right).unwrap();
    assert_eq!((&account.driver, &account.sv.movement, &account.sv.state), (&None, &None, &draft.sv.state));
    let partner = account.partner.unwrap();
    assert_eq!((partner.acts.len(), &partner.zones), (2, &draft.partner.unwrap().zones));
    let mut wrong = acts("was driving straight");
    wrong["others"] = json!([]);
    let refused = mended(wrong).unwrap_err();
    assert!(refused.contains("partner.acts[1].words do not say it"), "{refused}");
    let refused = mended(json!({"report": "1-1/1", "nobody_tells": ["sv.colour"]})).unwrap_err();
    assert!(refused.contains("sv.colour is no fact that can be taken out"), "{refused}");
}

#[test]
fn of_another_partner_nothing_of_the_draft_stays() {
    let other = json!({"report": "1-1/1", "another_partner": true,
        "partner": {"kind": quoted("passenger_car", "a red sedan")}, "came_from": quoted(json!({"cross": {"side": "left"}}), "from the left")});
    let account = mended(other).unwrap();
    let partner = account.partner.unwrap();
    assert!(partner.zones.is_empty() && partner.movement.is_none() && partner.kind.is_some());
    assert_eq!((&account.striker, &account.crash_type, &account.first_contact), (&None, &None, &None));
}

#[test]
fn words_that_stand_in_two_places_are_those_behind_the_act_before() {
    let twice = "A GM test vehicle stopped for a bus, and a red sedan passed it. It drove on, and stopped for a truck.";
    let record = CrashRecord { narrative: twice.to_owned(), ..record() };
    let (profile, repairs, base) = (support::paper(), Repairs::default(), nothing(&record));
    let acts = json!([{"act": "stop", "step": 1, "words": "stopped for"}, {"act": "follow", "step": 2, "words": "drove on"},
        {"act": "stop", "step": 3, "words": "stopped for"}]);
    let script = Script::new(&[json!({"report": "1-1/1", "sv": {"acts": acts}})]);
    let records = [&record];
    let brief = Brief { account: Some(&base), ..support::brief("01", &records, &profile, 1) };
    let model = LanguageModel { model: "m", answers: &script, max_repairs: 0, repairs: &repairs };
    let account = model.read(&brief, &base).unwrap();
    let at = |act: usize| match &account.sv.acts[act].source {
        recrash_model::account::Source::Words { start, .. } => *start,
        other => panic!("{other:?}"),
    };
    assert_eq!((at(0), at(2)), (twice.find("stopped for").unwrap(), twice.rfind("stopped for").unwrap()));
}

#[test]
fn what_a_model_reads_is_told_by_the_rules() {
    let (record, profile, repairs) = (record(), support::paper(), Repairs::default());
    let (records, base) = ([&record], nothing(&record));
    let brief = Brief { account: Some(&base), ..support::brief("01", &records, &profile, 1) };
    let script = Script::new(&[
        with(&[("/crash_type", json!("front_to_rear")), ("/came_from", quoted("behind", "came from"))]),
        good(),
    ]);
    let model = LanguageModel { model: "m", answers: &script, max_repairs: 1, repairs: &repairs };
    let narrative = model.paraphrase(&brief).unwrap().value;
    assert_eq!((&narrative.origin, &narrative.author, repairs.all()), (&Whose::Own, &Author::Model("m".into()), 1));
    let states = |value: &FactValue| narrative.facts.iter().any(|fact| fact.value == *value);
    assert!(states(&FactValue::Approach { approach: Approach::Left }), "{narrative:?}");
    assert!(states(&FactValue::SvSpeed { speed_mps: 5.4 }), "{narrative:?}");
}

#[test]
fn the_worked_examples_are_accounts_of_their_reports() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("prompts");
    for name in ["paraphrase_crossing.json", "paraphrase_rear_end.json"] {
        let example: Value = serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap();
        let quoted = &example["records"][0];
        let movement = |name: &str| serde_json::from_value(quoted[name].clone()).unwrap_or(Movement::Straight);
        let template = support::template(RoadType::Intersection, movement("sv_movement"), movement("cp_movement"));
        let mut record = support::record(template, quoted["narrative"].as_str().unwrap());
        record.id = recrash_model::record::RecordRef::try_from(quoted["id"].as_str().unwrap().to_owned()).unwrap();
        record.sv_speed_mps = quoted["sv_speed"].as_str().and_then(|speed| speed.split(' ').next()?.parse().ok());
        let (records, profile, repairs) = ([&record], support::paper(), Repairs::default());
        let read = |answer: &Value, base: &Account| {
            let brief = Brief { account: Some(base), ..support::brief("01", &records, &profile, 1) };
            let script = Script::new(std::slice::from_ref(answer));
            let model = LanguageModel { model: "m", answers: &script, max_repairs: 0, repairs: &repairs };
            model.read(&brief, base).unwrap_or_else(|e| panic!("{name}: {e}"))
        };
        // The draft is an account of the report, and the answer mends it.
        let draft = read(&example["draft"], &nothing(&record));
        let account = read(&example["answer"], &draft);
        assert!(account != draft, "{name}");
        assert!(account.came_from.is_some() && account.striker.is_some(), "{name}");
    }
}

#[test]
fn a_question_holds_every_report_of_the_incident_once_and_the_speaker_first() {
    let record = record();
    let mut other = CrashRecord { narrative: "A second account of the same crash.".into(), ..record.clone() };
    other.id.report_id = "2-2".into();
    let mut copy = record.clone();
    copy.id.report_id = "3-3".into();
    let (profile, base) = (support::paper(), nothing(&record));
    let records = [&other, &record, &copy];
    let brief = Brief { account: Some(&base), ..support::brief("01", &records, &profile, 1) };
    let question = recrash_agents::llm::paraphrase_question("m", &brief).unwrap();
    let text = &question.turns[0].text;
    let (first, second) = (text.find("Report 1-1/1").unwrap(), text.find("Report 2-2/1").unwrap());
    assert!(first < second && !text.contains("3-3/1"), "{text}");
    // The schema has the ranges, and goes beside the question once.
    assert!(question.schema.to_string().contains("\"maximum\":60") && !question.system.contains("\"maximum\""));
}
