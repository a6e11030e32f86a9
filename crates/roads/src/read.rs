//! Scenario files: JSON in and out, with errors that say where and how to mend.

use crate::json_place::add_lines;
use crate::near::nearest;
use crate::paper_dialect;
use recrash_model::scenario::{
    CrossMap, CurveMap, GraphMap, MapSpec, Policy, RoundaboutMap, SCENARIO_FORMAT, SCENARIO_FORMAT_1, ScenarioDraft,
    StraightMap, TeeMap,
};
use recrash_model::{Diagnostic, Location, Outcome, Severity};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// The longest scenario file that is read. [bytes]
pub const MAX_SCENARIO_BYTES: usize = 1 << 20;

/// Reads a draft from JSON: `recrash.scenario/2` or `/1`, or the paper's dialect, which is converted.
///
/// # Errors
/// One diagnostic per problem of syntax or type, with line and JSON path.
pub fn read_draft(json: &str) -> Result<Outcome<ScenarioDraft>, Vec<Diagnostic>> {
    if json.len() > MAX_SCENARIO_BYTES {
        let message = format!("the file has {} bytes; a scenario has at most {MAX_SCENARIO_BYTES}", json.len());
        let error = Diagnostic::new(Severity::Error, "scenario.too-large", Location::default(), message);
        return Err(vec![error.with_hint("is this a scenario file?")]);
    }
    let json = json.strip_prefix('\u{feff}').unwrap_or(json);
    let value: Value = serde_json::from_str(json).map_err(|error| vec![syntax_error(json, &error)])?;
    let Value::Object(object) = value else {
        let error = Diagnostic::error_at("scenario.type", "", "a scenario is a JSON object, { ... }");
        return Err(vec![error.with_hint("`recrash schema` prints the format")]);
    };
    let mut parts = Parts::default();
    let draft = if paper_dialect::speaks(&object) {
        paper_dialect::convert(&object, &mut parts)
    } else {
        native(&object, &mut parts)
    };
    add_lines(json, &mut parts.diagnostics);
    match draft {
        Some(value) if !parts.diagnostics.iter().any(Diagnostic::is_error) => {
            Ok(Outcome { value, diagnostics: parts.diagnostics })
        }
        _ => Err(parts.diagnostics),
    }
}

/// A draft as JSON: indented, fields in the order of the type, so that the same draft gives the same bytes.
pub fn write_draft(draft: &ScenarioDraft) -> String {
    let mut text = serde_json::to_string_pretty(draft).expect("a draft has only string keys");
    text.push('\n');
    text
}

/// The JSON Schema of `recrash.scenario/2`.
pub fn scenario_schema() -> Value {
    schemars::schema_for!(ScenarioDraft).to_value()
}

fn syntax_error(json: &str, error: &serde_json::Error) -> Diagnostic {
    let text = error.to_string();
    let message = text.split(" at line ").next().unwrap_or_default();
    let line = json.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let from = error.column().saturating_sub(4);
    let near: String = line.chars().skip(from).take(12).collect();
    let hint = if ["NaN", "nan", "Inf", "inf"].iter().any(|word| near.contains(word)) {
        "JSON has no NaN and no Infinity; write a finite number".to_owned()
    } else if message.contains("out of range") {
        "write a finite number".to_owned()
    } else if message.contains("trailing comma") {
        "leave out the last comma".to_owned()
    } else if near.trim().is_empty() {
        "is the file complete?".to_owned()
    } else {
        format!("look near `{}`", near.trim())
    };
    let location = Location { line: Some(error.line() as u64), ..Location::default() };
    let message = format!("not valid JSON: {message}, at column {}", error.column());
    Diagnostic::new(Severity::Error, "scenario.syntax", location, message).with_hint(hint)
}

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
                let message = error.into_inner().to_string();
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

    fn unknown_field(&mut self, path: &str, found: &str, known: &[&str]) {
        let shown: String = found.chars().take(60).collect();
        let hint = match nearest(found, known) {
            Some(meant) => format!("did you mean `{meant}`? known: {}", known.join(", ")),
            None => format!("known: {}", known.join(", ")),
        };
        self.error("scenario.unknown-field", path, format!("unknown field `{shown}`"), hint);
    }
}

fn join(path: &str, inner: &str) -> String {
    match (path.is_empty(), inner.is_empty()) {
        (_, true) => path.to_owned(),
        (true, false) => inner.to_owned(),
        (false, false) if inner.starts_with('[') => format!("{path}{inner}"),
        (false, false) => format!("{path}.{inner}"),
    }
}

/// The fields of a draft, in order, and whether each must be there.
const FIELDS: [(&str, bool); 14] = [
    ("format", true),
    ("id", true),
    ("source", true),
    ("map", true),
    ("ego", true),
    ("partners", false),
    ("actors", false),
    ("objects", false),
    ("control", false),
    ("obstacles", false),
    ("traffic", false),
    ("environment", false),
    ("duration_s", true),
    ("after_contact_s", false),
];

fn native(object: &Map<String, Value>, parts: &mut Parts) -> Option<ScenarioDraft> {
    let known: Vec<&str> = FIELDS.iter().map(|(name, _)| *name).collect();
    for name in object.keys() {
        if !known.contains(&name.as_str()) {
            parts.unknown_field(name, name, &known);
        }
    }
    for (name, required) in FIELDS {
        if required && !object.contains_key(name) {
            let hint = if name == "format" {
                "write \"format\": \"recrash.scenario/2\""
            } else {
                "`recrash schema` prints every field"
            };
            parts.error("scenario.missing-field", name, format!("missing field `{name}`"), hint);
        }
    }
    let format: Option<String> = object.get("format").and_then(|value| parts.read(value, "format"));
    if let Some(format) = &format
        && ![SCENARIO_FORMAT, SCENARIO_FORMAT_1].contains(&format.as_str())
    {
        let shown: String = format.chars().take(60).collect();
        let message = format!(
            "format is {shown:?}; this program reads {SCENARIO_FORMAT:?}, {SCENARIO_FORMAT_1:?} and the paper's dialect"
        );
        parts.error("scenario.format", "format", message, "a later version of recrash may read it");
        return None;
    }
    let id = object.get("id").and_then(|value| parts.read(value, "id"));
    let source = object.get("source").and_then(|value| parts.read(value, "source"));
    let map = object.get("map").and_then(|value| map(value, parts));
    let ego = object.get("ego").and_then(|value| parts.read(value, "ego"));
    let partners = list(object, "partners", parts, |value, path, parts| {
        let Value::Object(fields) = value else { return parts.read(value, path) };
        let mut fields = fields.clone();
        let written = fields.get("policy").map(|value| policy(value, &format!("{path}.policy"), parts));
        if let Some(None) = written {
            // Any policy: so that what else is wrong with this partner is told too.
            fields.insert("policy".to_owned(), serde_json::json!({"type": "stopped"}));
        }
        let partner = parts.read(&Value::Object(fields), path);
        if matches!(written, Some(None)) { None } else { partner }
    });
    let obstacles = list(object, "obstacles", parts, |value, path, parts| parts.read(value, path));
    let traffic = optional(object, "traffic", parts);
    let environment = optional(object, "environment", parts);
    let duration_s = object.get("duration_s").and_then(|value| parts.read(value, "duration_s"));
    Some(ScenarioDraft {
        // A draft of the format before is one of this format too.
        format: format.map(|_| SCENARIO_FORMAT.to_owned())?,
        id: id?,
        source: source?,
        map: map?,
        ego: ego?,
        partners: partners?,
        actors: list(object, "actors", parts, |value, path, parts| parts.read(value, path))?,
        objects: list(object, "objects", parts, |value, path, parts| parts.read(value, path))?,
        control: list(object, "control", parts, |value, path, parts| parts.read(value, path))?,
        obstacles: obstacles?,
        traffic: traffic?,
        environment: environment?,
        duration_s: duration_s?,
        after_contact_s: optional(object, "after_contact_s", parts)?,
    })
}

fn optional<T: DeserializeOwned + Default>(object: &Map<String, Value>, name: &str, parts: &mut Parts) -> Option<T> {
    object.get(name).map_or_else(|| Some(T::default()), |value| parts.read(value, name))
}

fn list<T>(
    object: &Map<String, Value>,
    name: &str,
    parts: &mut Parts,
    mut read: impl FnMut(&Value, &str, &mut Parts) -> Option<T>,
) -> Option<Vec<T>> {
    let items = match object.get(name) {
        None => return Some(Vec::new()),
        Some(Value::Array(items)) => items,
        Some(_) => {
            parts.error("scenario.type", name, format!("{name} is a list"), "write [ ... ]");
            return None;
        }
    };
    let read: Vec<Option<T>> =
        items.iter().enumerate().map(|(position, value)| read(value, &format!("{name}[{position}]"), parts)).collect();
    read.into_iter().collect()
}

/// The map: by hand, because serde forgets the path inside a tagged enum.
fn map(value: &Value, parts: &mut Parts) -> Option<MapSpec> {
    let (kind, fields) = tagged(value, "map", &["S", "C", "X", "T", "O", "G"], MAP_HINT, parts)?;
    let fields = Value::Object(fields);
    match kind.as_str() {
        "S" => parts.read::<StraightMap>(&fields, "map").map(MapSpec::S),
        "C" => parts.read::<CurveMap>(&fields, "map").map(MapSpec::C),
        "X" => parts.read::<CrossMap>(&fields, "map").map(MapSpec::X),
        "T" => parts.read::<TeeMap>(&fields, "map").map(MapSpec::T),
        "O" => parts.read::<RoundaboutMap>(&fields, "map").map(MapSpec::O),
        _ => parts.read::<GraphMap>(&fields, "map").map(MapSpec::G),
    }
}

const MAP_HINT: &str = "allowed: S (straight), C (curve), X (four-way intersection), T (three-way intersection), O (roundabout), G (roads)";

/// The tag and the other fields of a tagged object.
fn tagged(
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
