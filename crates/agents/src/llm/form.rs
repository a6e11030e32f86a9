//! The form of an answer, held against its schema: everything that is wrong, with its place, at once.

use serde_json::{Map, Value};

/// Most problems that are told at once.
const MOST_PROBLEMS: usize = 24;

/// What in `value` does not fit `schema`, a sentence each; nothing where it fits.
pub fn problems(value: &Value, schema: &Value) -> Vec<String> {
    let mut form = Form { definitions: schema.get("$defs").and_then(Value::as_object), problems: Vec::new() };
    form.check("", value, schema);
    form.problems.truncate(MOST_PROBLEMS);
    form.problems
}

struct Form<'a> {
    definitions: Option<&'a Map<String, Value>>,
    problems: Vec<String>,
}

impl<'a> Form<'a> {
    fn tell(&mut self, path: &str, what: impl std::fmt::Display) {
        let place = if path.is_empty() { "the answer" } else { path };
        self.problems.push(format!("{place} {what}"));
    }

    /// The schema behind a reference.
    fn resolved(&self, schema: &'a Value) -> &'a Value {
        let name = schema.get("$ref").and_then(Value::as_str).and_then(|path| path.rsplit('/').next());
        name.and_then(|name| self.definitions?.get(name)).unwrap_or(schema)
    }

    fn check(&mut self, path: &str, value: &Value, schema: &'a Value) {
        let schema = self.resolved(schema);
        for alternatives in ["oneOf", "anyOf"].iter().filter_map(|word| schema.get(word)?.as_array()) {
            self.one_of(path, value, alternatives);
        }
        if let Some(constant) = schema.get("const").filter(|constant| *constant != value) {
            return self.tell(path, format_args!("is {}; it must be {constant}", shown(value)));
        }
        if let Some(allowed) = schema.get("enum").and_then(Value::as_array).filter(|allowed| !allowed.contains(value)) {
            let allowed: Vec<String> = allowed.iter().map(Value::to_string).collect();
            return self.tell(path, format_args!("is {}; it is one of {}", shown(value), allowed.join(", ")));
        }
        if let Some(wanted) = schema.get("type").filter(|wanted| !is_of(value, wanted)) {
            return self.tell(path, format_args!("is {}; it must be of type {wanted}", shown(value)));
        }
        match value {
            Value::Object(fields) => self.object(path, fields, schema),
            Value::Array(items) => self.array(path, items, schema),
            Value::Number(number) => self.number(path, number.as_f64().unwrap_or(f64::NAN), schema),
            Value::String(text) => {
                let longest = schema.get("maxLength").and_then(Value::as_u64);
                if longest.is_some_and(|longest| text.chars().count() as u64 > longest) {
                    self.tell(path, format_args!("is longer than {} characters", longest.unwrap_or(0)));
                }
            }
            Value::Null | Value::Bool(_) => {}
        }
    }

    fn object(&mut self, path: &str, fields: &Map<String, Value>, schema: &'a Value) {
        let known = schema.get("properties").and_then(Value::as_object);
        for name in schema.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str) {
            if !fields.contains_key(name) {
                self.tell(&within(path, name), "is missing");
            }
        }
        let closed = schema.get("additionalProperties") == Some(&Value::Bool(false));
        for (name, value) in fields {
            match known.and_then(|known| known.get(name)) {
                Some(inner) => self.check(&within(path, name), value, inner),
                None if closed => {
                    let names: Vec<&str> = known.into_iter().flat_map(Map::keys).map(String::as_str).collect();
                    self.tell(&within(path, name), format_args!("is no field; there are {}", names.join(", ")));
                }
                None => {}
            }
        }
    }

    fn array(&mut self, path: &str, items: &[Value], schema: &'a Value) {
        let bound = |word: &str| schema.get(word).and_then(Value::as_u64);
        if let Some(most) = bound("maxItems").filter(|most| items.len() as u64 > *most) {
            self.tell(path, format_args!("has {} entries; {most} are allowed", items.len()));
        }
        if let Some(least) = bound("minItems").filter(|least| (items.len() as u64) < *least) {
            self.tell(path, format_args!("has {} entries; at least {least} are needed", items.len()));
        }
        if let Some(inner) = schema.get("items") {
            for (at, item) in items.iter().enumerate() {
                self.check(&format!("{path}[{at}]"), item, inner);
            }
        }
    }

    fn number(&mut self, path: &str, number: f64, schema: &Value) {
        let bound = |word: &str| schema.get(word).and_then(Value::as_f64);
        if let Some(least) = bound("minimum").filter(|least| number < *least) {
            self.tell(path, format_args!("is {number}; {least} is the least"));
        }
        if let Some(most) = bound("maximum").filter(|most| number > *most) {
            self.tell(path, format_args!("is {number}; {most} is the most"));
        }
    }

    /// Fits one of them; else what is wrong with the one it is nearest to.
    fn one_of(&mut self, path: &str, value: &Value, alternatives: &'a [Value]) {
        let mut best: Option<((bool, usize), Vec<String>)> = None;
        for alternative in alternatives {
            let mut attempt = Form { definitions: self.definitions, problems: Vec::new() };
            attempt.check(path, value, alternative);
            if attempt.problems.is_empty() {
                return;
            }
            // The alternative whose tag it has is the one that was meant.
            let distance = (!self.has_tag_of(value, alternative), attempt.problems.len());
            if best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, attempt.problems));
            }
        }
        self.problems.extend(best.into_iter().flat_map(|(_, problems)| problems));
    }

    /// Whether every constant field of an alternative is the value's.
    fn has_tag_of(&self, value: &Value, alternative: &'a Value) -> bool {
        let fields = self.resolved(alternative).get("properties").and_then(Value::as_object);
        fields.is_some_and(|fields| {
            let mut constants = fields.iter().filter_map(|(name, inner)| Some((name, inner.get("const")?))).peekable();
            constants.peek().is_some() && constants.all(|(name, constant)| value.get(name) == Some(constant))
        })
    }
}

fn within(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Object(_) => "an object".to_owned(),
        Value::Array(_) => "a list".to_owned(),
        other => other.to_string().chars().take(60).collect(),
    }
}

fn is_of(value: &Value, wanted: &Value) -> bool {
    let is = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        _ => true,
    };
    match wanted {
        Value::Array(names) => names.iter().filter_map(Value::as_str).any(is),
        name => name.as_str().is_none_or(is),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn schema() -> Value {
        json!({"type": "object", "additionalProperties": false, "required": ["lane", "turn"],
            "properties": {
                "lane": {"type": "integer", "minimum": 0, "maximum": 3},
                "turn": {"$ref": "#/$defs/Turn"},
                "start": {"oneOf": [
                    {"type": "object", "properties": {"is": {"const": "gap"}, "gap_s": {"type": "number", "maximum": 9}},
                     "required": ["is", "gap_s"], "additionalProperties": false},
                    {"type": "object", "properties": {"is": {"const": "offset"}, "ahead_m": {"type": "number"}},
                     "required": ["is", "ahead_m"], "additionalProperties": false}]},
                "note": {"anyOf": [{"type": "string", "maxLength": 3}, {"type": "null"}]}},
            "$defs": {"Turn": {"type": "string", "enum": ["left", "right"]}}})
    }

    #[test]
    fn what_fits_has_no_problem() {
        let good = json!({"lane": 1, "turn": "left", "start": {"is": "gap", "gap_s": 1.5}, "note": null});
        assert_eq!(problems(&good, &schema()), Vec::<String>::new());
    }

    #[test]
    fn everything_that_is_wrong_is_told_at_once_with_its_place() {
        let bad = json!({"lane": 7, "turn": "up", "colour": 1, "start": {"is": "gap", "gap_s": 20}, "note": "long"});
        let told = problems(&bad, &schema()).join("\n");
        for part in [
            "lane is 7; 3 is the most",
            "turn is \"up\"; it is one of \"left\", \"right\"",
            "colour is no field",
            "start.gap_s is 20; 9 is the most",
            "note is longer than 3 characters",
        ] {
            assert!(told.contains(part), "{part}:\n{told}");
        }
        assert_eq!(problems(&json!({}), &schema()), ["lane is missing", "turn is missing"]);
        assert!(problems(&json!([]), &schema())[0].contains("the answer is a list"));
    }
}
