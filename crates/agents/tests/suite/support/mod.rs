//! Records for tests.

use recrash_agents::llm::{Answers, AskError, Asked, Exchange, Question};
use recrash_agents::{Brief, Paraphrase, Rules};
use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::record::{Coded, CrashRecord, Edition, Engagement, Provenance, RecordRef, Redaction, Severity};
use recrash_model::template::{Movement, RoadType, Template};
use recrash_model::zones::ContactZone;
use recrash_model::{Outcome, Seed};
use serde::Deserialize;
use std::sync::Mutex;

/// A model's answer to a question, without what only a live one has.
pub fn exchange(question: &Question, answer: String) -> Exchange {
    Exchange {
        format: String::new(),
        hash: question.hash(),
        question: question.clone(),
        prompts: String::new(),
        answer,
        answer_sha256: None,
        asked: Asked::Batch,
        input_tokens: 0,
        output_tokens: 0,
        tokens_estimated: false,
        latency_s: None,
        retries: 0,
        cost_usd: None,
    }
}

/// The profile of the paper.
pub fn paper() -> SystemProfile {
    toml::from_str(include_str!("../../../../../profiles/paper.toml")).expect("a profile of ours")
}

/// A record of this template that tells this.
pub fn record(template: Template, narrative: &str) -> CrashRecord {
    CrashRecord {
        id: RecordRef { report_id: "1-1".into(), version: 1 },
        incident_id: None,
        entity: "Acme Robotics".into(),
        vehicle: "Acme One".into(),
        when: None,
        time_of_day_min: None,
        place: "Springfield".into(),
        road: Coded::Known(template.road),
        work_zone: template.work_zone,
        surface: None,
        lighting: None,
        weather: Vec::new(),
        posted_speed_mps: Some(11.176),
        partner: Coded::Known(PartnerKind::PassengerCar),
        cp_movement: Coded::Known(template.cp),
        sv_movement: Coded::Known(template.sv),
        sv_speed_mps: None,
        sv_zones: Vec::new(),
        cp_zones: Vec::new(),
        severity: Coded::Known(Severity::None),
        towed: Default::default(),
        airbags: Default::default(),
        engagement: Coded::Known(Engagement::Ads),
        narrative: narrative.into(),
        redaction: Redaction::Open,
        provenance: Provenance { file: "test.csv".into(), edition: Edition::Second, row: 1 },
        reading: None,
    }
}

/// A template without work zone.
pub fn template(road: RoadType, sv: Movement, cp: Movement) -> Template {
    Template { road, sv, cp, work_zone: false }
}

/// A brief for records of one template.
pub fn brief<'a>(id: &'a str, records: &'a [&'a CrashRecord], profile: &'a SystemProfile, seed: u64) -> Brief<'a> {
    let template = records[0].template().expect("a record of a template");
    Brief { scenario_id: id, template, records, untold: None, profile, account: None, seed: Seed(seed) }
}

/// The narrative of one record.
pub fn narrate(record: &CrashRecord, profile: &SystemProfile) -> Outcome<Narrative> {
    Rules.paraphrase(&brief("01-test", &[record], profile, 7)).expect("a narrative")
}

/// What a case file says of a record; where it says nothing, two cars go straight on at an intersection.
#[derive(Deserialize)]
pub struct Told {
    pub text: String,
    #[serde(default = "intersection")]
    road: RoadType,
    #[serde(default = "straight")]
    sv: Movement,
    #[serde(default = "straight")]
    cp: Movement,
    #[serde(default)]
    work_zone: bool,
    #[serde(default)]
    partner: PartnerKind,
    #[serde(default)]
    sv_zones: Vec<ContactZone>,
    #[serde(default)]
    cp_zones: Vec<ContactZone>,
    sv_speed_mps: Option<f64>,
}

fn intersection() -> RoadType {
    RoadType::Intersection
}
fn straight() -> Movement {
    Movement::Straight
}

impl Told {
    /// The record.
    pub fn record(&self) -> CrashRecord {
        let template = Template { road: self.road, sv: self.sv, cp: self.cp, work_zone: self.work_zone };
        CrashRecord {
            partner: Coded::Known(self.partner),
            sv_zones: self.sv_zones.clone(),
            cp_zones: self.cp_zones.clone(),
            sv_speed_mps: self.sv_speed_mps,
            ..record(template, &self.text)
        }
    }
}

/// Says one thing after the other, whatever it is asked; keeps what it was told.
pub struct Script {
    /// Yet to be said, the last first.
    lines: Mutex<Vec<String>>,
    /// What it was asked.
    asked: Mutex<Vec<Question>>,
}

impl Script {
    /// Says these.
    pub fn new<T: ToString>(lines: &[T]) -> Self {
        let lines = lines.iter().rev().map(T::to_string).collect();
        Self { lines: Mutex::new(lines), asked: Mutex::default() }
    }

    /// The last thing it was told.
    pub fn last_told(&self) -> String {
        self.asked.lock().unwrap().last().unwrap().turns.last().unwrap().text.clone()
    }
}

impl Answers for Script {
    fn answer(&self, question: &Question) -> Result<Exchange, AskError> {
        self.asked.lock().unwrap().push(question.clone());
        let mut lines = self.lines.lock().unwrap();
        let answer = if lines.len() > 1 { lines.pop().unwrap() } else { lines[0].clone() };
        Ok(exchange(question, answer))
    }
}
