//! How the records are spread over the values of a field.

use crate::fields::{Field, FieldValue, UNKNOWN};
use recrash_model::record::{CrashRecord, RecordSet};
use serde::Serialize;
use std::collections::BTreeMap;

/// The fields whose spread is shown.
const SHOWN: [Field; 7] =
    [Field::Entity, Field::Road, Field::SvMovement, Field::CpMovement, Field::Partner, Field::Severity, Field::Year];

/// How often each value of a field occurs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Distribution {
    /// The field's name, or `month`.
    pub field: String,
    /// Values, most frequent first; months the latest first, `unknown` before them.
    pub values: Vec<ValueCount>,
}

/// How often a value occurs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ValueCount {
    /// The value, `unknown` where it is not known.
    pub value: String,
    /// Among all records that could be read.
    pub records: usize,
    /// Among those the profile can use.
    pub usable: usize,
}

/// The spread of entities, road types, movements, partner kinds, severity, years and months.
pub fn distributions(set: &RecordSet) -> Vec<Distribution> {
    let mut all: Vec<Distribution> =
        SHOWN.into_iter().map(|field| count(set, field.name(), |record| values(field, record))).collect();
    let mut months = count(set, "month", |record| vec![record.when.map_or(UNKNOWN.into(), |when| when.to_string())]);
    months.values.sort_by(|a, b| b.value.cmp(&a.value));
    all.push(months);
    all
}

fn count(set: &RecordSet, name: &str, values: impl Fn(&CrashRecord) -> Vec<String>) -> Distribution {
    let mut usable = vec![false; set.records.len()];
    set.usable.iter().for_each(|&i| usable[i] = true);
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for (record, usable) in set.records.iter().zip(usable) {
        for value in values(record) {
            let count = counts.entry(value).or_default();
            count.0 += 1;
            count.1 += usize::from(usable);
        }
    }
    let counted = counts.into_iter().map(|(value, (records, usable))| ValueCount { value, records, usable });
    let mut values: Vec<ValueCount> = counted.collect();
    values.sort_by(|a, b| b.records.cmp(&a.records).then_with(|| a.value.cmp(&b.value)));
    Distribution { field: name.to_owned(), values }
}

fn values(field: Field, record: &CrashRecord) -> Vec<String> {
    let known = match field.of(record) {
        FieldValue::Text(text) => vec![text.to_owned()],
        FieldValue::Whole(number) => number.iter().map(ToString::to_string).collect(),
        FieldValue::Codes(codes) => codes,
        FieldValue::Number(_) | FieldValue::Flag(_) => Vec::new(),
    };
    let known: Vec<String> = known.into_iter().filter(|value| !value.is_empty()).collect();
    if known.is_empty() { vec![UNKNOWN.to_owned()] } else { known }
}
