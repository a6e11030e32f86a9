//! What a case can be found, sorted and filtered by besides what its row shows: the record that is told, and words of
//! narratives.

use crate::view::{CaseRow, SuiteView};
use crate::words;
use recrash_model::record::{Coded, CrashRecord, RecordRef};
use std::collections::{BTreeMap, BTreeSet};

/// Longest list of words of one case: a suite of thousands stays small. [bytes]
const LONGEST_LIST: usize = 700;
/// Shortest word that is kept. [characters]
const SHORTEST_WORD: usize = 3;

/// The record that each case tells.
pub struct ToldRecords<'a>(Vec<Option<&'a CrashRecord>>);

impl<'a> ToldRecords<'a> {
    /// Of a suite, in its order.
    pub fn of(suite: &'a SuiteView) -> Self {
        let by_id: BTreeMap<&RecordRef, &CrashRecord> =
            suite.records.records.iter().map(|record| (&record.id, record)).collect();
        Self(suite.cases.iter().map(|case| by_id.get(case.told.as_ref()?).copied()).collect())
    }

    /// Of the case at this position; none where nobody's crash is told.
    pub fn at(&self, position: usize) -> Option<&'a CrashRecord> {
        self.0.get(position).copied().flatten()
    }
}

/// What kind of road user the ego met, as the record has it.
pub fn partner(record: &CrashRecord) -> String {
    coded(&record.partner)
}

/// The injury that the record alleges.
pub fn injury(record: &CrashRecord) -> String {
    match coded(&record.severity) {
        none if none == "none" => "no injury".to_owned(),
        other => other,
    }
}

fn coded<T: Copy + serde::Serialize>(value: &Coded<T>) -> String {
    words::coded(value, |value| words::name(&value)).unwrap_or_else(|_| "not filled in".to_owned())
}

/// Words of the narrative and of the record as filed, each once, in small letters.
pub fn words_of(case: &CaseRow, told: Option<&CrashRecord>) -> String {
    let texts = [case.narrative.as_str(), told.map_or("", |record| record.narrative.as_str())];
    let mut seen: BTreeSet<String> = BTreeSet::new();
    let mut list = String::new();
    for text in texts {
        let text = words::clean(text, words::LONGEST_TEXT).to_lowercase();
        for word in text.split(|c: char| !c.is_alphanumeric()).filter(|word| word.chars().count() >= SHORTEST_WORD) {
            if list.len() + word.len() >= LONGEST_LIST {
                return list;
            }
            if seen.insert(word.to_owned()) {
                if !list.is_empty() {
                    list.push(' ');
                }
                list.push_str(word);
            }
        }
    }
    list
}
