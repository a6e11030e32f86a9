//! One number of the evidence: its formula, what of, its value, and how claims say it.

use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// One number.
#[derive(Debug, Clone, Serialize)]
pub struct Number {
    /// Its name.
    pub id: String,
    /// How it is worked out.
    pub formula: &'static str,
    /// What of: a test, a list with conditions, other numbers.
    #[serde(flatten)]
    pub of: BTreeMap<&'static str, Value>,
    /// Its value.
    pub value: Value,
    /// `%` of a share, SI units else.
    pub unit: &'static str,
    /// As claims say it.
    pub shown: String,
}

/// The number of this name.
pub fn find<'a>(numbers: &'a [Number], id: &str) -> Option<&'a Number> {
    numbers.iter().find(|number| number.id == id)
}

/// Whether a member of a list has these values; a name may be a path.
pub fn holds(member: &Value, filter: &Value) -> bool {
    let wanted = filter.as_object().into_iter().flatten();
    wanted.into_iter().all(|(path, wanted)| {
        let found = path.split('/').try_fold(member, |value, name| value.get(name));
        found.unwrap_or(&Value::Null) == wanted
    })
}

/// A count of the members of a list with these values.
pub fn counted(id: &str, list: [&str; 2], filter: Value, count: usize) -> Number {
    let value = Value::from(count);
    Number {
        id: id.to_owned(),
        formula: "count",
        of: BTreeMap::from([("list", json!(list)), ("where", filter)]),
        shown: shown(&value, ""),
        value,
        unit: "",
    }
}

/// A value as claims say it.
pub fn shown(value: &Value, unit: &str) -> String {
    match (value, unit) {
        (Value::String(text), _) => text.clone(),
        (Value::Number(number), "") => number.to_string(),
        (value, "%") => format!("{:.1} %", 100.0 * value.as_f64().unwrap_or(0.0)),
        (value, unit) => format!("{:.2} {unit}", value.as_f64().unwrap_or(0.0)),
    }
}
