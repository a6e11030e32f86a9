//! Schemas in the words that every provider's structured output knows: fewer than JSON Schema has.

use serde_json::{Map, Value, json};

/// The same schema without what constrained decoding refuses: alternatives of constant strings become an `enum` (what each
/// means moves into the description), and formats of numbers, such as `uint8`, go.
pub fn plain(schema: Value) -> Value {
    match schema {
        Value::Array(items) => items.into_iter().map(plain).collect(),
        Value::Object(fields) => Value::Object(plain_object(fields)),
        other => other,
    }
}

fn plain_object(fields: Map<String, Value>) -> Map<String, Value> {
    let constants = fields.get("oneOf").and_then(Value::as_array).and_then(|items| constants(items));
    let mut plainer = Map::new();
    for (name, value) in fields {
        match (name.as_str(), &constants) {
            ("$schema" | "format", _) if value.is_string() => {}
            ("oneOf", Some(_)) => {}
            _ => {
                plainer.insert(name, plain(value));
            }
        }
    }
    if let Some((names, meanings)) = constants {
        let own = plainer.get("description").and_then(Value::as_str).unwrap_or_default();
        let description = format!("{own} {meanings}").trim().to_owned();
        plainer.insert("type".into(), json!("string"));
        plainer.insert("enum".into(), json!(names));
        plainer.insert("description".into(), json!(description));
    }
    plainer
}

/// The constants of alternatives that are nothing else, and what they mean.
fn constants(items: &[Value]) -> Option<(Vec<String>, String)> {
    let name = |item: &Value| item.get("const")?.as_str().map(str::to_owned);
    let names: Vec<String> = items.iter().map(name).collect::<Option<_>>()?;
    let meaning = |item: &Value| Some(format!("{}: {}", item["const"].as_str()?, item["description"].as_str()?));
    let meanings: Vec<String> = items.iter().filter_map(meaning).collect();
    Some((names, meanings.join(" ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_become_an_enum_and_formats_of_numbers_go() {
        let side = json!({"description": "A side.", "oneOf": [
            {"const": "left", "description": "There.", "type": "string"}, {"const": "right", "type": "string"}]});
        let schema =
            json!({"$schema": "x", "properties": {"format": {"type": "number", "format": "double"}, "side": side}});
        let plainer = plain(schema);
        assert_eq!(plainer["properties"]["format"], json!({"type": "number"}));
        assert_eq!(
            plainer["properties"]["side"],
            json!({"type": "string", "enum": ["left", "right"], "description": "A side. left: There."})
        );
        assert!(plainer.get("$schema").is_none());
    }

    #[test]
    fn tagged_alternatives_stay() {
        let schema = json!({"oneOf": [{"properties": {"is": {"const": "a"}}}, {"properties": {"is": {"const": "b"}}}]});
        assert_eq!(plain(schema.clone()), schema);
    }
}
