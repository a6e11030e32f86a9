//! Numbers with names: every number of a scenario that may be varied is an OpenSCENARIO parameter.

use crate::xml::{Element, number};
use recrash_model::scenario::ScenarioDraft;
use recrash_model::tuning::{Parameter, start_speeds};
use serde_json::Value;

/// A declared parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Declaration {
    /// JSON pointer into the scenario.
    pub pointer: String,
    /// Name: letters and digits only, because checkers take `_` inside `${...}` for an operator.
    pub name: String,
    /// Value in the scenario.
    pub value: f64,
    pub integer: bool,
    /// Bounds, where the number may be tuned.
    pub bounds: Option<(f64, f64)>,
}

/// The parameters of one scenario.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Declarations {
    pub list: Vec<Declaration>,
    /// First speeds that go with a target speed, and have no name of their own.
    together: Vec<(String, String)>,
}

impl Declarations {
    /// Those of a draft: the numbers of ego, partners and duration, and whatever else may be tuned.
    pub fn new(draft: &ScenarioDraft, tunable: &[Parameter]) -> Self {
        let document = serde_json::to_value(draft).unwrap_or(Value::Null);
        let mut list = Vec::new();
        for part in ["ego", "partners", "duration_s"] {
            collect(&format!("/{part}"), &document[part], &mut list);
        }
        let together = start_speeds(draft);
        list.retain(|declaration| !together.iter().any(|(start, _)| *start == declaration.pointer));
        for parameter in tunable {
            if list.iter().any(|known: &Declaration| known.pointer == parameter.pointer) {
                continue;
            }
            if let Some(value) = document.pointer(&parameter.pointer) {
                collect(&parameter.pointer, value, &mut list);
            }
        }
        for declaration in &mut list {
            let found = tunable.iter().find(|parameter| parameter.pointer == declaration.pointer);
            declaration.bounds = found.map(|parameter| (parameter.min, parameter.max));
        }
        Self { list, together }
    }

    /// `$name` of the number at a pointer, or the number itself where it has no name.
    pub fn reference(&self, pointer: &str, value: f64) -> String {
        match self.find(pointer) {
            Some(found) => format!("${}", found.name),
            None => number(value),
        }
    }

    /// The declaration of the number at a pointer, or of the one it goes with.
    pub fn find(&self, pointer: &str) -> Option<&Declaration> {
        let pointer = self.together.iter().find(|(start, _)| start == pointer).map_or(pointer, |(_, target)| target);
        self.list.iter().find(|known| known.pointer == pointer)
    }

    pub fn element(&self) -> Element {
        Element::new("ParameterDeclarations").children(self.list.iter().map(|declaration| {
            let element = Element::new("ParameterDeclaration")
                .with("name", &declaration.name)
                .with("parameterType", if declaration.integer { "integer" } else { "double" })
                .with("value", number(declaration.value));
            match declaration.bounds {
                None => element,
                Some((min, max)) => element.child(Element::new("ConstraintGroup").children([
                    Element::new("ValueConstraint").with("rule", "greaterOrEqual").with("value", number(min)),
                    Element::new("ValueConstraint").with("rule", "lessOrEqual").with("value", number(max)),
                ])),
            }
        }))
    }
}

/// Every number of a scenario's JSON that has a name, or would have one if it could be tuned.
pub(crate) fn numbers_below(document: &Value) -> Vec<Declaration> {
    let mut list = Vec::new();
    for part in ["ego", "partners", "obstacles", "duration_s"] {
        collect(&format!("/{part}"), &document[part], &mut list);
    }
    list
}

/// Numbers that are choices rather than quantities: a lane cannot be swept.
const CHOICES: [&str; 2] = ["lane", "lane_offset"];

fn collect(pointer: &str, value: &Value, list: &mut Vec<Declaration>) {
    match value {
        Value::Object(fields) => {
            for (key, field) in fields.iter().filter(|(key, _)| !CHOICES.contains(&key.as_str())) {
                collect(&format!("{pointer}/{key}"), field, list);
            }
        }
        Value::Array(items) => {
            for (position, item) in items.iter().enumerate() {
                collect(&format!("{pointer}/{position}"), item, list);
            }
        }
        Value::Number(found) => list.push(Declaration {
            pointer: pointer.to_owned(),
            name: name_of(pointer),
            value: found.as_f64().unwrap_or(0.0),
            integer: !found.is_f64(),
            bounds: None,
        }),
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

/// `/partners/0/start/arrival_gap_s` becomes `partner1StartArrivalGapS`: plural lists count from one.
pub(crate) fn name_of(pointer: &str) -> String {
    let mut name = String::new();
    for part in pointer.split(['/', '_']).filter(|part| !part.is_empty()) {
        if let Ok(position) = part.parse::<usize>() {
            name = name.strip_suffix('s').unwrap_or(&name).to_owned();
            name.push_str(&position.saturating_add(1).to_string());
        } else if name.is_empty() {
            name.push_str(part);
        } else {
            // A file that is read may hold any text here.
            let mut letters = part.chars();
            name.extend(letters.next().map(|first| first.to_ascii_uppercase()));
            name.push_str(letters.as_str());
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::name_of;

    #[test]
    fn any_text_of_a_file_that_is_read_has_a_name() {
        assert_eq!(name_of("/ego/\u{23a}t/18446744073709551615"), "ego\u{23a}t18446744073709551615");
    }

    #[test]
    fn names_are_read_from_left_to_right_and_hold_no_underscore() {
        assert_eq!(name_of("/partners/0/start/arrival_gap_s"), "partner1StartArrivalGapS");
        assert_eq!(name_of("/ego/speed_mps"), "egoSpeedMps");
        assert_eq!(name_of("/partners/1/lateral/0/to_t_m"), "partner2Lateral1ToTM");
        assert_eq!(name_of("/duration_s"), "durationS");
    }
}
