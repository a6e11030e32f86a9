//! Scenario files: JSON in and out, with errors that say where and how to mend.

use crate::json_parts::{Parts, policy, tagged};
use crate::json_place::add_lines;
use crate::paper_dialect;
use recrash_model::scenario::{
    CrossMap, CurveMap, GraphMap, MapSpec, Partner, RoundaboutMap, SCENARIO_FORMAT, SCENARIO_FORMAT_1, ScenarioDraft,
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

/// Says which fields there are none of, and which are missing.
fn check_fields(object: &Map<String, Value>, parts: &mut Parts) {
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
}

/// A draft in the format of this program.
fn native(object: &Map<String, Value>, parts: &mut Parts) -> Option<ScenarioDraft> {
    check_fields(object, parts);
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
    let partners = list(object, "partners", parts, partner);
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

/// A partner; its policy by hand, because serde forgets the path inside a tagged enum.
fn partner(value: &Value, path: &str, parts: &mut Parts) -> Option<Partner> {
    let Value::Object(fields) = value else { return parts.read(value, path) };
    let mut fields = fields.clone();
    let written = fields.get("policy").map(|value| policy(value, &format!("{path}.policy"), parts));
    if let Some(None) = written {
        // Any policy: so that what else is wrong with this partner is told too.
        fields.insert("policy".to_owned(), serde_json::json!({"type": "stopped"}));
    }
    let partner = parts.read(&Value::Object(fields), path);
    if matches!(written, Some(None)) { None } else { partner }
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
    let (kind, fields) = tagged(value, "map", &MAP_TYPES, MAP_HINT, parts)?;
    let before = parts.diagnostics.len();
    let stray: Vec<String> = fields.keys().filter(|field| !knows(&kind, field)).cloned().collect();
    let fields = Value::Object(fields);
    let map = map_of(&kind, &fields, parts);
    for told in parts.diagnostics[before..].iter_mut().filter(|told| told.code == "scenario.unknown-field") {
        let field = stray.iter().find(|field| told.location.path.as_deref() == Some(&format!("map.{field}")));
        let types =
            field.map_or_else(Vec::new, |field| MAP_TYPES.into_iter().filter(|kind| knows(kind, field)).collect());
        if !types.is_empty() {
            let types = types.join(", ");
            told.hint = format!("a map of type {types} has that field, and this one is of type {kind}; {}", told.hint);
        }
    }
    map
}

const MAP_TYPES: [&str; 6] = ["S", "C", "X", "T", "O", "G"];

/// Whether a type of map has a field.
fn knows(kind: &str, field: &str) -> bool {
    fn has<T: DeserializeOwned>(field: &str) -> bool {
        let fields = Value::Object([(field.to_owned(), Value::Null)].into_iter().collect());
        serde_json::from_value::<T>(fields).err().is_none_or(|error| !error.to_string().starts_with("unknown field"))
    }
    match kind {
        "S" => has::<StraightMap>(field),
        "C" => has::<CurveMap>(field),
        "X" => has::<CrossMap>(field),
        "T" => has::<TeeMap>(field),
        "O" => has::<RoundaboutMap>(field),
        _ => has::<GraphMap>(field),
    }
}

fn map_of(kind: &str, fields: &Value, parts: &mut Parts) -> Option<MapSpec> {
    match kind {
        "S" => parts.read::<StraightMap>(fields, "map").map(MapSpec::S),
        "C" => parts.read::<CurveMap>(fields, "map").map(MapSpec::C),
        "X" => parts.read::<CrossMap>(fields, "map").map(MapSpec::X),
        "T" => parts.read::<TeeMap>(fields, "map").map(MapSpec::T),
        "O" => parts.read::<RoundaboutMap>(fields, "map").map(MapSpec::O),
        _ => parts.read::<GraphMap>(fields, "map").map(MapSpec::G),
    }
}

const MAP_HINT: &str = "allowed: S (straight), C (curve), X (four-way intersection), T (three-way intersection), O (roundabout), G (roads)";
