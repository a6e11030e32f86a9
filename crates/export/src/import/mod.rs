//! OpenSCENARIO read back: the subset that recrash writes.
//!
//! The file says what it is in three ways, and each is read where it is exact: numbers from the parameter declarations
//! (so that a sweep or an edit of them counts), who takes part from the entities with their properties, the rest from
//! the properties of the header. What the storyboard says follows from those; it is compared with what recrash would
//! have written, and every difference is told, because it is not read.

mod differences;
mod origins;

use crate::openscenario::names::{Declaration, name_of, numbers_below};
use crate::openscenario::scene::{WHOLE, whole};
use crate::openscenario::{PROPERTY, is_obstacle_name};
use crate::xml::{Element, parse};
use origins::Origins;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::SCENARIO_FORMAT;
use recrash_model::tuning::start_speeds;
use recrash_model::{Diagnostic, Location, Outcome, Severity};
use recrash_roads::Scenario;
use serde_json::{Map, Number, Value};
use std::collections::BTreeMap;

/// The longest OpenSCENARIO file that is read. A recorded partner takes 350 bytes per step. [bytes]
pub const MAX_IMPORT_BYTES: usize = 8 << 20;

/// Remarks of one severity that are told one by one.
const MOST_REMARKS: usize = 20;

/// Reads a scenario back from OpenSCENARIO XML that recrash wrote, and checks it.
///
/// # Errors
/// One diagnostic per problem, with element and line: not XML, not OpenSCENARIO, not written by recrash, or a scenario
/// that cannot be run.
pub fn import(xosc: &str) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    if xosc.len() > MAX_IMPORT_BYTES {
        let message = format!("the file has {} bytes; at most {MAX_IMPORT_BYTES} are read", xosc.len());
        return Err(vec![Diagnostic::new(Severity::Error, "openscenario.too-large", Location::default(), message)]);
    }
    let root = parse(xosc).map_err(|(line, message)| {
        let location = Location { line: Some(line), ..Location::default() };
        vec![Diagnostic::new(Severity::Error, "openscenario.syntax", location, message)]
    })?;
    read(&root).map_err(shortened).map(|outcome| Outcome { diagnostics: shortened(outcome.diagnostics), ..outcome })
}

fn read(root: &Element) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    let mut origins = Origins::default();
    let original = described(root, &mut origins)?;
    let mut current = original.clone();
    let mut diagnostics = Vec::new();
    let declared = declared_numbers(root, &original, &mut current, &mut origins, &mut diagnostics);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(diagnostics);
    }
    keep_together(&original, &declared, &mut current);
    let scenario = checked(&current).map_err(|list| origins.place(list))?;
    // What the numbers were when the file was written; an edit may have made them unfit, and then nothing is compared.
    if let Ok(original) = checked(&original) {
        diagnostics.extend(differences::differences(root, &original.value, &declared));
    }
    diagnostics.extend(origins.place(scenario.diagnostics));
    Ok(Outcome { value: scenario.value, diagnostics })
}

/// A first speed that has no declaration goes with its target speed.
fn keep_together(original: &Value, declared: &[Declaration], current: &mut Value) {
    let Ok(draft) = serde_json::from_value(original.clone()) else { return };
    for (start, target) in start_speeds(&draft) {
        let speed = current.pointer(&target).cloned();
        if let (false, Some(speed)) = (declared.iter().any(|number| number.pointer == start), speed)
            && let Some(slot) = current.pointer_mut(&start)
        {
            *slot = speed;
        }
    }
}

fn checked(scenario: &Value) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    let draft = recrash_roads::read_draft(&scenario.to_string())?;
    let mut checked = recrash_roads::check(draft.value)?;
    checked.diagnostics.splice(0..0, draft.diagnostics);
    Ok(checked)
}

/// The scenario as header and entities describe it, with the numbers it had when it was written.
fn described(root: &Element, origins: &mut Origins) -> Result<Value, Vec<Diagnostic>> {
    if root.name != "OpenSCENARIO" {
        let message = format!("the root element is <{}>; it must be <OpenSCENARIO>", root.name);
        return Err(vec![problem("openscenario.root", root, &root.name, message)]);
    }
    let header = root.find("FileHeader");
    let Some(properties) = header.and_then(|header| header.find("Properties")) else {
        let message = "the header has no properties of recrash; only files that recrash wrote can be read back";
        return Err(vec![
            problem("openscenario.not-ours", header.unwrap_or(root), "OpenSCENARIO/FileHeader", message)
                .with_hint("export a scenario to OpenSCENARIO to see what they look like"),
        ]);
    };
    if let Some(text) = whole(properties) {
        let place = format!("OpenSCENARIO/FileHeader/Properties/{WHOLE}");
        return serde_json::from_str(text).map_err(|error| vec![bad_json(&place, properties, &error)]);
    }
    let mut diagnostics = Vec::new();
    let mut scenario = Map::new();
    scenario.insert("format".to_owned(), SCENARIO_FORMAT.into());
    for part in ["id", "source", "map", "traffic", "environment"] {
        let name = format!("recrash.{part}");
        let place = format!("OpenSCENARIO/FileHeader/Properties/{name}");
        let Some((element, text)) = property(properties, &name) else {
            let message = "it is missing; only files that recrash wrote can be read back";
            diagnostics.push(problem("openscenario.not-ours", properties, &place, message));
            continue;
        };
        origins.add(part, &place, element);
        // The id stands there as it is, the rest as JSON.
        match if part == "id" { Ok(Value::from(text)) } else { serde_json::from_str(text) } {
            Ok(value) => drop(scenario.insert(part.to_owned(), value)),
            Err(error) => diagnostics.push(bad_json(&place, element, &error)),
        }
    }
    entities(root, &mut scenario, origins, &mut diagnostics);
    let list = root.find("ParameterDeclarations");
    let duration = list.and_then(|list| declaration_of(list, "durationS")?.attribute("value")?.parse::<f64>().ok());
    match duration.and_then(Number::from_f64) {
        Some(seconds) => drop(scenario.insert("duration_s".to_owned(), Value::Number(seconds))),
        None => diagnostics.push(problem(
            "openscenario.parameter",
            list.unwrap_or(root),
            "OpenSCENARIO/ParameterDeclarations",
            "there is no number durationS among the parameters",
        )),
    }
    if diagnostics.iter().any(Diagnostic::is_error) { Err(diagnostics) } else { Ok(scenario.into()) }
}

/// Ego, partners and obstacles as their entities describe them.
fn entities(
    root: &Element,
    scenario: &mut Map<String, Value>,
    origins: &mut Origins,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let (mut partners, mut obstacles) = (Vec::new(), Vec::new());
    for object in root.find("Entities").into_iter().flat_map(|entities| entities.all("ScenarioObject")) {
        let name = object.attribute("name").unwrap_or_default();
        let place = format!("OpenSCENARIO/Entities/ScenarioObject[{name}]");
        let own = object.children.iter().filter_map(|entity| entity.find("Properties"));
        let Some((element, text)) = own.filter_map(|properties| property(properties, PROPERTY)).next() else {
            let message = format!("it has no property \"{PROPERTY}\", so it is not a road user that recrash knows");
            diagnostics.push(problem("openscenario.foreign-entity", object, &place, message));
            continue;
        };
        let value: Value = match serde_json::from_str(text) {
            Ok(value) => value,
            Err(error) => {
                diagnostics.push(bad_json(&place, element, &error));
                continue;
            }
        };
        if name == EGO_ID {
            origins.add("ego", &place, element);
            scenario.insert("ego".to_owned(), value);
        } else if is_obstacle_name(name) {
            origins.add(&format!("obstacles[{}]", obstacles.len()), &place, element);
            obstacles.push(value);
        } else {
            origins.add(&format!("partners[{}]", partners.len()), &place, element);
            partners.push(value);
        }
    }
    scenario.insert("partners".to_owned(), partners.into());
    scenario.insert("obstacles".to_owned(), obstacles.into());
}

/// Puts the declared numbers in their places, and gives their declarations as written.
fn declared_numbers(
    root: &Element,
    original: &Value,
    current: &mut Value,
    origins: &mut Origins,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Declaration> {
    let known: BTreeMap<String, Declaration> =
        numbers_below(original).into_iter().map(|number| (number.name.clone(), number)).collect();
    let mut found = Vec::new();
    for declaration in root.find("ParameterDeclarations").into_iter().flat_map(|list| list.all("ParameterDeclaration"))
    {
        let name = declaration.attribute("name").unwrap_or_default();
        let place = format!("OpenSCENARIO/ParameterDeclarations/{name}");
        if name == "egoControllerActive" {
            continue;
        }
        let Some(number) = known.get(name) else {
            let message = "no number of the scenario has this name; it is not read";
            let location = at(declaration, &place);
            diagnostics.push(Diagnostic::new(Severity::Warning, "openscenario.parameter", location, message));
            continue;
        };
        let text = declaration.attribute("value").unwrap_or_default();
        let value = match text.parse::<f64>() {
            Ok(value) if number.integer && value >= 0.0 && value.fract() == 0.0 && value < 4e9 => {
                Some(Number::from(value as u64))
            }
            Ok(value) if !number.integer => Number::from_f64(value),
            _ => None,
        };
        match value {
            Some(value) => {
                if let Some(slot) = current.pointer_mut(&number.pointer) {
                    *slot = Value::Number(value);
                }
                origins.add_number(&number.pointer, &place, declaration);
                found.push(Declaration { bounds: bounds(declaration), ..number.clone() });
            }
            None => {
                let wanted = if number.integer { "a whole number from 0" } else { "a finite number" };
                let message = format!("\"{text}\" is no value for it; it must be {wanted}");
                diagnostics.push(problem("openscenario.parameter", declaration, &place, message));
            }
        }
    }
    found
}

fn bounds(declaration: &Element) -> Option<(f64, f64)> {
    let group = declaration.find("ConstraintGroup")?;
    let limit = |rule: &str| {
        let constraint = group.all("ValueConstraint").find(|c| c.attribute("rule") == Some(rule))?;
        constraint.attribute("value")?.parse().ok()
    };
    Some((limit("greaterOrEqual")?, limit("lessOrEqual")?))
}

/// A property's element and value.
fn property<'a>(properties: &'a Element, name: &str) -> Option<(&'a Element, &'a str)> {
    let found = properties.all("Property").find(|found| found.attribute("name") == Some(name))?;
    Some((found, found.attribute("value")?))
}

fn declaration_of<'a>(list: &'a Element, name: &str) -> Option<&'a Element> {
    list.all("ParameterDeclaration").find(|found| found.attribute("name") == Some(name))
}

fn at(element: &Element, place: &str) -> Location {
    Location { line: Some(element.line), ..Location::at_path(place) }
}

fn problem(code: &str, element: &Element, place: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Severity::Error, code, at(element, place), message)
}

fn bad_json(place: &str, element: &Element, error: &serde_json::Error) -> Diagnostic {
    problem("openscenario.property", element, place, format!("the property is not JSON: {error}"))
}

/// The first remarks of each severity, and how many more there are.
fn shortened(mut list: Vec<Diagnostic>) -> Vec<Diagnostic> {
    for severity in [Severity::Error, Severity::Warning, Severity::Note] {
        let mut count = 0_usize;
        list.retain(|diagnostic| {
            count += usize::from(diagnostic.severity == severity);
            diagnostic.severity != severity || count <= MOST_REMARKS
        });
        if count > MOST_REMARKS {
            let message = format!("{} more remarks like these", count - MOST_REMARKS);
            list.push(Diagnostic::new(severity, "openscenario.more", Location::default(), message));
        }
    }
    list
}

/// The name a pointer has as a parameter; for documentation and tests.
pub fn parameter_name(pointer: &str) -> String {
    name_of(pointer)
}
