//! OpenSCENARIO read back: the subset that recrash writes.
//!
//! The file says what it is in three ways, and each is read where it is exact: numbers from the parameter declarations
//! (so that a sweep or an edit of them counts), who takes part from the entities with their properties, the rest from
//! the properties of the header. What the storyboard says follows from those; it is compared with what recrash would
//! have written, and every difference is told, because it is not read.

use crate::openscenario::names::{Declaration, name_of, numbers_below};
use crate::openscenario::{PROPERTY, is_obstacle_name};
use crate::xml::{Element, parse};
use crate::{ExportOptions, Format};
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::{SCENARIO_FORMAT, ScenarioDraft};
use recrash_model::tuning::Parameter;
use recrash_model::{Diagnostic, Location, Outcome, Severity};
use serde_json::{Map, Number, Value};

/// The longest OpenSCENARIO file that is read. A recorded partner takes 350 bytes per step. [bytes]
pub const MAX_IMPORT_BYTES: usize = 32 << 20;

/// Differences that are told one by one.
const MOST_DIFFERENCES: usize = 20;

/// Parts of the story whose content depends on a rollout, which the file does not hold.
const FROM_ROLLOUT: [&str; 3] = ["SpeedProfileAction", "SpeedAction", "FollowTrajectoryAction"];

/// Reads a scenario back from OpenSCENARIO XML that recrash wrote.
///
/// # Errors
/// One diagnostic per problem: not XML, not OpenSCENARIO, not written by recrash, or a scenario that cannot be read.
pub fn import(xosc: &str) -> Result<Outcome<ScenarioDraft>, Vec<Diagnostic>> {
    if xosc.len() > MAX_IMPORT_BYTES {
        let message = format!("the file has {} bytes; at most {MAX_IMPORT_BYTES} are read", xosc.len());
        return Err(vec![problem("openscenario.too-large", "", message)]);
    }
    let root = parse(xosc).map_err(|(line, message)| {
        let location = Location { line: Some(line), ..Location::default() };
        vec![Diagnostic::new(Severity::Error, "openscenario.syntax", location, message)]
    })?;
    let (original, mut diagnostics) = described(&root)?;
    let mut current = original.clone();
    let declared = declared_numbers(&root, &original, &mut current, &mut diagnostics);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(diagnostics);
    }
    let read = |value: &Value| recrash_roads::read_draft(&value.to_string());
    let mut outcome = read(&current)?;
    if let Ok(original) = read(&original) {
        diagnostics.extend(differences_from(&root, original.value, &declared));
    }
    diagnostics.append(&mut outcome.diagnostics);
    Ok(Outcome { value: outcome.value, diagnostics })
}

/// The scenario as header and entities describe it, with the numbers it had when it was written.
fn described(root: &Element) -> Result<(Value, Vec<Diagnostic>), Vec<Diagnostic>> {
    if root.name != "OpenSCENARIO" {
        let message = format!("the root element is <{}>; it must be <OpenSCENARIO>", root.name);
        return Err(vec![problem("openscenario.root", &root.name, message)]);
    }
    let header = root.find("FileHeader");
    let Some(properties) = header.and_then(|header| header.find("Properties")) else {
        let message = "the header has no properties of recrash; only files that recrash wrote can be read back";
        return Err(vec![
            problem("openscenario.not-ours", "OpenSCENARIO/FileHeader", message)
                .with_hint("export one with `recrash export --to openscenario` to see what they look like"),
        ]);
    };
    let mut diagnostics = Vec::new();
    let mut scenario = Map::new();
    scenario.insert("format".to_owned(), SCENARIO_FORMAT.into());
    match property(properties, "recrash.id") {
        Some(id) => drop(scenario.insert("id".to_owned(), id.into())),
        None => diagnostics.push(missing("recrash.id")),
    }
    for part in ["source", "map", "traffic", "environment"] {
        let name = format!("recrash.{part}");
        match property(properties, &name).map(serde_json::from_str::<Value>) {
            Some(Ok(value)) => drop(scenario.insert(part.to_owned(), value)),
            Some(Err(error)) => diagnostics.push(bad_json(&name, &error)),
            None => diagnostics.push(missing(&name)),
        }
    }
    let (mut partners, mut obstacles) = (Vec::new(), Vec::new());
    for object in root.find("Entities").into_iter().flat_map(|entities| entities.all("ScenarioObject")) {
        let name = object.attribute("name").unwrap_or_default();
        let place = format!("OpenSCENARIO/Entities/ScenarioObject[{name}]");
        let own = object.children.iter().filter_map(|entity| entity.find("Properties"));
        let text = own.filter_map(|properties| property(properties, PROPERTY)).next();
        let value = match text.map(serde_json::from_str::<Value>) {
            Some(Ok(value)) => value,
            Some(Err(error)) => {
                diagnostics.push(bad_json(&place, &error));
                continue;
            }
            None => {
                let message = format!("it has no property \"{PROPERTY}\", so it is not a road user that recrash knows");
                diagnostics.push(problem("openscenario.foreign-entity", &place, message));
                continue;
            }
        };
        if name == EGO_ID {
            scenario.insert("ego".to_owned(), value);
        } else if is_obstacle_name(name) {
            obstacles.push(value);
        } else {
            partners.push(value);
        }
    }
    scenario.insert("partners".to_owned(), partners.into());
    scenario.insert("obstacles".to_owned(), obstacles.into());
    let duration = root.find("ParameterDeclarations").and_then(|list| declared_value(list, "durationS"));
    match duration.and_then(|text| text.parse::<f64>().ok()).and_then(Number::from_f64) {
        Some(seconds) => drop(scenario.insert("duration_s".to_owned(), Value::Number(seconds))),
        None => diagnostics.push(problem(
            "openscenario.parameter",
            "OpenSCENARIO/ParameterDeclarations",
            "there is no number durationS among the parameters",
        )),
    }
    if diagnostics.iter().any(Diagnostic::is_error) { Err(diagnostics) } else { Ok((scenario.into(), diagnostics)) }
}

/// Puts the declared numbers in their places, and gives their declarations as written.
fn declared_numbers(
    root: &Element,
    original: &Value,
    current: &mut Value,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Declaration> {
    let known = numbers_below(original);
    let mut found = Vec::new();
    for declaration in root.find("ParameterDeclarations").into_iter().flat_map(|list| list.all("ParameterDeclaration"))
    {
        let name = declaration.attribute("name").unwrap_or_default();
        let place = format!("OpenSCENARIO/ParameterDeclarations/{name}");
        if name == "egoControllerActive" {
            continue;
        }
        let Some(number) = known.iter().find(|number| number.name == name) else {
            let message = "no number of the scenario has this name; it is not read".to_owned();
            diagnostics.push(Diagnostic::warning_at("openscenario.parameter", place, message));
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
                let declared = Declaration { bounds: bounds(declaration), ..number.clone() };
                found.push(declared);
            }
            None => {
                let wanted = if number.integer { "a whole number from 0" } else { "a finite number" };
                let message = format!("\"{text}\" is no value for it; it must be {wanted}");
                diagnostics.push(problem("openscenario.parameter", &place, message));
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

/// Where the file says something else than recrash would write for the scenario it describes.
fn differences_from(root: &Element, original: ScenarioDraft, declared: &[Declaration]) -> Vec<Diagnostic> {
    let Ok(checked) = recrash_roads::check(original) else {
        return Vec::new();
    };
    // Numbers that only tuning names would otherwise be written as they are.
    let parameters: Vec<Parameter> = declared
        .iter()
        .filter(|declaration| declaration.bounds.is_some() || declaration.pointer.starts_with("/obstacles"))
        .map(|declaration| {
            let (min, max) = declaration.bounds.unwrap_or((declaration.value, declaration.value));
            Parameter {
                pointer: declaration.pointer.clone(),
                unit: String::new(),
                min,
                max,
                start: declaration.value,
                integer: declaration.integer,
                reason: String::new(),
            }
        })
        .collect();
    let options = ExportOptions::new(Format::OpenScenario);
    let expected = crate::openscenario::scenario_element(&checked.value, &parameters, &options);
    let mut list = Vec::new();
    for part in ["Entities", "Storyboard"] {
        if let (Some(found), Some(expected)) = (root.find(part), expected.find(part)) {
            compare(found, expected, &format!("OpenSCENARIO/{part}"), &mut list);
        }
    }
    let more = list.len().saturating_sub(MOST_DIFFERENCES);
    list.truncate(MOST_DIFFERENCES);
    if more > 0 {
        let message = format!("{more} more differences of this kind");
        list.push(Diagnostic::new(Severity::Warning, "openscenario.edited", Location::default(), message));
    }
    list
}

fn compare(found: &Element, expected: &Element, place: &str, list: &mut Vec<Diagnostic>) {
    if place.contains("/Story[") && FROM_ROLLOUT.contains(&found.name.as_str()) {
        return;
    }
    // A partner that follows its recording has other actions, which are not read at all.
    if recorded(found) {
        return;
    }
    for (name, value) in &expected.attributes {
        let other = found.attribute(name);
        if other != Some(value) {
            let message = format!(
                "it holds {}, but the scenario that the properties describe has \"{value}\" there; this is not read",
                other.map_or_else(|| "nothing".to_owned(), |other| format!("\"{other}\""))
            );
            list.push(edited(&format!("{place}/@{name}"), message));
        }
    }
    let (have, want) = (named(&found.children), named(&expected.children));
    for (key, child) in &have {
        match want.iter().find(|(other, _)| other == key) {
            Some((_, other)) => compare(child, other, &format!("{place}/{key}"), list),
            None => list.push(edited(
                &format!("{place}/{key}"),
                "recrash writes nothing like it there; it is not read".to_owned(),
            )),
        }
    }
    for (key, _) in want.iter().filter(|(key, _)| !have.iter().any(|(other, _)| other == key)) {
        let message = "it is missing, but the scenario that the properties describe has it".to_owned();
        list.push(edited(&format!("{place}/{key}"), message));
    }
}

/// Whether an element holds a partner's recorded way, or the start that belongs to it.
fn recorded(element: &Element) -> bool {
    let starts_in_the_world =
        element.name == "Private" && element.children.len() == 2 && element.deep("WorldPosition").is_some();
    starts_in_the_world || (element.name == "ManeuverGroup" && element.deep("FollowTrajectoryAction").is_some())
}

/// Children by what tells them apart: element, name or reference, and how many like it came before.
fn named(children: &[Element]) -> Vec<(String, &Element)> {
    let mut list: Vec<(String, &Element)> = Vec::with_capacity(children.len());
    let mut before: Option<(String, usize)> = None;
    for child in children {
        let own = child.attribute("name").or_else(|| child.attribute("entityRef"));
        let base = own.map_or_else(|| child.name.clone(), |name| format!("{}[{name}]", child.name));
        let count = match &before {
            Some((last, count)) if *last == base => count + 1,
            _ => 1,
        };
        let key = if count == 1 { base.clone() } else { format!("{base}[{count}]") };
        before = Some((base, count));
        list.push((key, child));
    }
    list
}

fn property<'a>(properties: &'a Element, name: &str) -> Option<&'a str> {
    properties.all("Property").find(|found| found.attribute("name") == Some(name))?.attribute("value")
}

fn declared_value<'a>(list: &'a Element, name: &str) -> Option<&'a str> {
    list.all("ParameterDeclaration").find(|found| found.attribute("name") == Some(name))?.attribute("value")
}

fn problem(code: &str, place: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error_at(code, place, message)
}

fn edited(place: &str, message: String) -> Diagnostic {
    Diagnostic::warning_at("openscenario.edited", place, message).with_hint(
        "change the parameter declarations or the properties instead, or simulate with the tool you edit for",
    )
}

fn missing(name: &str) -> Diagnostic {
    let message = format!("the header has no property \"{name}\"; only files that recrash wrote can be read back");
    problem("openscenario.not-ours", "OpenSCENARIO/FileHeader/Properties", message)
}

fn bad_json(place: &str, error: &serde_json::Error) -> Diagnostic {
    problem("openscenario.property", place, format!("the property is not JSON: {error}"))
}

/// The name a pointer has as a parameter; for documentation and tests.
pub fn parameter_name(pointer: &str) -> String {
    name_of(pointer)
}
