//! The reader on mini narratives of our own: `stories.toml`, a case a behaviour, and `families.toml`, each kind of crash in many wordings.

use crate::common::{self, account_of, facts};
use recrash_model::record::Coded;
use recrash_model::template::Movement;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Deserialize)]
struct File {
    story: Vec<Story>,
}

#[derive(Deserialize)]
struct Story {
    name: String,
    text: String,
    expect: BTreeMap<String, String>,
}

fn stories() -> Vec<Story> {
    let files = [include_str!("stories.toml"), include_str!("families.toml")];
    files.iter().flat_map(|text| toml::from_str::<File>(text).unwrap().story).collect()
}

#[test]
fn every_story_is_read_as_told() {
    let stories = stories();
    assert!(stories.len() >= 140, "{} stories", stories.len());
    let mut wrong = Vec::new();
    for story in &stories {
        let account = account_of(&story.text).unwrap_or_else(|| panic!("{}: no account", story.name));
        let facts = facts(&account);
        for (name, expected) in &story.expect {
            let said = facts.get(name.as_str()).cloned().unwrap_or_default();
            if !expected.split('|').any(|value| value == said) {
                wrong.push(format!("{}: {name} is \"{said}\", not \"{expected}\"", story.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_told_fact_stands_in_the_narrative() {
    for story in &stories() {
        let account = account_of(&story.text).unwrap();
        let json = serde_json::to_value(&account).unwrap();
        common::each_source(&json, &mut |words| {
            let (start, end) = (words["start"].as_u64().unwrap() as usize, words["end"].as_u64().unwrap() as usize);
            assert_eq!(&story.text[start..end], words["text"].as_str().unwrap(), "{}", story.name);
        });
        let back: recrash_model::account::Account = serde_json::from_value(json).unwrap();
        assert_eq!(back, account);
    }
}

#[test]
fn a_turn_lane_is_gone_over_to_where_the_column_says_so() {
    let text = "The AV was traveling in the rightmost lane. While the AV proceeded into the right turn lane, an SUV approached the AV \
                from behind, and the front of the SUV made contact with the rear of the AV.";
    let mut record = common::record("1-1", 1, text);
    record.sv_movement = Coded::Known(Movement::ChangingLanes);
    let account = recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account");
    assert_eq!(facts(&account)["sv_acts"], "follow enter_right");
}
