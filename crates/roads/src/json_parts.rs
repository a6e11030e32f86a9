//! Parts of a scenario file as their types: what is wrong with each is told with its path, and the others are read.

use crate::near::nearest;
use recrash_model::Diagnostic;
use recrash_model::scenario::Policy;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use serde_path_to_error::{Path, Segment};

/// What was read so far.
#[derive(Default)]
pub(crate) struct Parts {
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Parts {
    pub(crate) fn error(&mut self, code: &str, path: &str, message: impl Into<String>, hint: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error_at(code, path, message).with_hint(hint));
    }

    /// A part of the document as its type; at most one problem of each part is told.
    pub(crate) fn read<T: DeserializeOwned>(&mut self, value: &Value, path: &str) -> Option<T> {
        match serde_path_to_error::deserialize(value) {
            Ok(read) => Some(read),
            Err(error) => {
                let inner = error.path().to_string();
                let keys = if is_about_keys(error.inner()) { keys_at::<T>(value, error.path()) } else { Vec::new() };
                let message = error.into_inner().to_string();
                if !keys.is_empty() {
                    let message = format!("it is an object with one key, which is one of {}", keys.join(", "));
                    self.error(
                        "scenario.type",
                        &join(path, &inner),
                        message,
                        "`recrash schema` prints what each holds",
                    );
                    return None;
                }
                self.type_error(&join(path, if inner == "." { "" } else { &inner }), &message);
                None
            }
        }
    }

    fn type_error(&mut self, path: &str, message: &str) {
        if let Some(rest) = message.strip_prefix("unknown field ") {
            let (found, allowed) = rest.split_once(", expected ").unwrap_or((rest, ""));
            let known: Vec<&str> = allowed.split('`').skip(1).step_by(2).collect();
            self.unknown_field(path, found.trim_matches('`'), &known);
        } else if message.starts_with("missing field ") {
            self.error("scenario.missing-field", path, message, "`recrash schema` prints every field");
        } else if message.starts_with("unknown variant ") {
            let message = message.replace("unknown variant", "unknown value");
            self.error("scenario.unknown-value", path, message, "write one of the listed words");
        } else {
            let hint = if message.contains("invalid type: string") && message.contains("expected f64") {
                "write a number, without quotes"
            } else if message.contains("expected u") || message.contains("expected i") {
                "write a whole number"
            } else if message.contains("null") {
                "write a value, or leave the field out"
            } else {
                ""
            };
            self.error("scenario.type", path, message, hint);
        }
    }

    pub(crate) fn unknown_field(&mut self, path: &str, found: &str, known: &[&str]) {
        let shown: String = found.chars().take(60).collect();
        let hint = match nearest(found, known) {
            Some(meant) => format!("did you mean `{meant}`? known: {}", known.join(", ")),
            None => format!("known: {}", known.join(", ")),
        };
        self.error("scenario.unknown-field", path, format!("unknown field `{shown}`"), hint);
    }
}

/// Whether an object was given where one with a single key is wanted: serde names none of the keys.
fn is_about_keys(error: &serde_json::Error) -> bool {
    error.to_string().contains("expected map with a single key")
}

/// The keys that an object with a single key may have at this place of a document.
fn keys_at<T: DeserializeOwned>(value: &Value, path: &Path) -> Vec<String> {
    let mut asked = value.clone();
    let mut place = &mut asked;
    for segment in path {
        let inner = match segment {
            Segment::Seq { index } => place.get_mut(*index),
            Segment::Map { key } => place.get_mut(key),
            Segment::Enum { variant } => place.get_mut(variant),
            Segment::Unknown => None,
        };
        match inner {
            Some(inner) => place = inner,
            None => return Vec::new(),
        }
    }
    // No type has such a key: the answer lists those that there are.
    *place = serde_json::json!({ "?": null });
    let told = serde_json::from_value::<T>(asked).err().map(|error| error.to_string()).unwrap_or_default();
    let listed = told.strip_prefix("unknown variant `?`, expected ").unwrap_or_default();
    listed.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn join(path: &str, inner: &str) -> String {
    match (path.is_empty(), inner.is_empty()) {
        (_, true) => path.to_owned(),
        (true, false) => inner.to_owned(),
        (false, false) if inner.starts_with('[') => format!("{path}{inner}"),
        (false, false) => format!("{path}.{inner}"),
    }
}

/// The tag and the other fields of a tagged object.
pub(crate) fn tagged(
    value: &Value,
    path: &str,
    kinds: &[&str],
    hint: &str,
    parts: &mut Parts,
) -> Option<(String, Map<String, Value>)> {
    let Value::Object(fields) = value else {
        parts.error("scenario.type", path, format!("{path} is an object with a \"type\""), hint);
        return None;
    };
    let mut fields = fields.clone();
    let at = format!("{path}.type");
    match fields.remove("type") {
        Some(Value::String(kind)) if kinds.contains(&kind.as_str()) => Some((kind, fields)),
        Some(Value::String(kind)) => {
            let shown: String = kind.chars().take(60).collect();
            parts.error("scenario.unknown-value", &at, format!("there is no type {shown:?}"), hint);
            None
        }
        Some(_) => {
            parts.error("scenario.type", &at, "the type is a word in quotes", hint);
            None
        }
        None => {
            parts.error("scenario.missing-field", path, "missing field `type`", hint);
            None
        }
    }
}

/// What a policy's field holds.
#[derive(Clone, Copy, PartialEq)]
enum Holds {
    Number,
    Steps,
}

/// The fields of a policy: name, what it holds, whether it must be there.
type PolicyFields = &'static [(&'static str, Holds, bool)];

const POLICIES: [(&str, PolicyFields); 5] = [
    (
        "sudden_brake",
        &[
            ("target_speed", Holds::Number, true),
            ("brake_step", Holds::Steps, true),
            ("brake_steps", Holds::Steps, true),
            ("speed_kp", Holds::Number, false),
        ],
    ),
    (
        "accel_then_brake",
        &[
            ("accel_mag", Holds::Number, true),
            ("accel_steps", Holds::Steps, true),
            ("cruise_speed", Holds::Number, true),
            ("brake_step", Holds::Steps, true),
            ("brake_steps", Holds::Steps, true),
            ("speed_kp", Holds::Number, false),
        ],
    ),
    ("idm_nominal", &[("target_speed_mps", Holds::Number, true)]),
    ("stopped", &[("depart_step", Holds::Steps, false), ("target_speed_mps", Holds::Number, false)]),
    ("yielding", &[("target_speed_mps", Holds::Number, true), ("gap_s", Holds::Number, true)]),
];

/// A policy: by hand, for the same reason as the map.
pub(crate) fn policy(value: &Value, path: &str, parts: &mut Parts) -> Option<Policy> {
    let kinds = POLICIES.map(|(kind, _)| kind);
    let hint = format!("allowed: {}", kinds.join(", "));
    let (kind, fields) = tagged(value, path, &kinds, &hint, parts)?;
    let (_, known) = POLICIES.iter().find(|(name, _)| *name == kind)?;
    let names: Vec<&str> = known.iter().map(|(name, _, _)| *name).collect();
    let before = parts.diagnostics.len();
    for (name, value) in &fields {
        let at = format!("{path}.{name}");
        match known.iter().find(|(known, _, _)| known == name) {
            None => parts.unknown_field(&at, name, &names),
            Some((_, Holds::Steps, _)) if value.as_u64().is_none_or(|steps| u32::try_from(steps).is_err()) => {
                let message = format!("{name} is {}, not a number of steps", brief(value));
                parts.error("scenario.type", &at, message, "write a whole number of steps of 0.1 s, from 0");
            }
            Some((_, Holds::Number, required)) if !(value.is_number() || (value.is_null() && !required)) => {
                parts.error(
                    "scenario.type",
                    &at,
                    format!("{name} is {}, not a number", brief(value)),
                    "write a number, without quotes",
                );
            }
            Some(_) => {}
        }
    }
    for (name, _, required) in *known {
        if *required && !fields.contains_key(*name) {
            let message = format!("missing field `{name}` of policy {kind}");
            parts.error("scenario.missing-field", path, message, format!("its fields: {}", names.join(", ")));
        }
    }
    if parts.diagnostics.len() > before { None } else { parts.read(value, path) }
}

/// A value for a message.
pub(crate) fn brief(value: &Value) -> String {
    value.to_string().chars().take(40).collect()
}
