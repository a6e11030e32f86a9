//! Where a file says something else than recrash would write for the scenario it describes: told, and not read.

use crate::openscenario::names::Declaration;
use crate::openscenario::{LANES, STORYBOARD};
use crate::xml::Element;
use crate::{ExportOptions, Format};
use recrash_model::tuning::Parameter;
use recrash_model::{Diagnostic, Location, Severity};
use recrash_roads::Scenario;

/// Parts of the story whose content depends on a rollout, which the file does not hold: how fast a partner is, and where
/// across its lane.
fn from_rollout(element: &Element) -> bool {
    let across = || element.attribute("name").is_some_and(|name| name.ends_with(LANES));
    match element.name.as_str() {
        "SpeedProfileAction" | "SpeedAction" => true,
        "Maneuver" => across(),
        _ => false,
    }
}

/// The differences between a file and what recrash would write for `original`, the scenario its properties describe.
pub(super) fn differences(root: &Element, original: &Scenario, declared: &[Declaration]) -> Vec<Diagnostic> {
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
    let expected = crate::openscenario::scenario_element(original, &parameters, &options);
    let mut list = Vec::new();
    for part in ["Entities", "Storyboard"] {
        if let (Some(found), Some(expected)) = (root.find(part), expected.find(part)) {
            compare(found, expected, &format!("OpenSCENARIO/{part}"), &mut list);
        }
    }
    // What depends on a rollout cannot be compared, but whether it is as it was written can be told.
    let written = root.find("FileHeader").and_then(|header| header.find("Properties")).and_then(|properties| {
        properties.all("Property").find(|property| property.attribute("name") == Some(STORYBOARD))?.attribute("value")
    });
    if let (Some(storyboard), Some(written), true) = (root.find("Storyboard"), written, list.is_empty())
        && storyboard.fingerprint() != written
    {
        let message = "what a partner does was changed since recrash wrote it; this is not read".to_owned();
        list.push(edited(storyboard, "OpenSCENARIO/Storyboard", message));
    }
    list
}

fn compare(found: &Element, expected: &Element, place: &str, list: &mut Vec<Diagnostic>) {
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
            list.push(edited(found, &format!("{place}/@{name}"), message));
        }
    }
    let in_story = place.contains("/Story[");
    let compared = |child: &&Element| !(in_story && from_rollout(child));
    let have = named(found.children.iter().filter(compared));
    let want = named(expected.children.iter().filter(compared));
    for (key, child) in &have {
        match want.iter().find(|(other, _)| other == key) {
            Some((_, other)) => compare(child, other, &format!("{place}/{key}"), list),
            None => list.push(edited(
                child,
                &format!("{place}/{key}"),
                "recrash writes nothing like it there; it is not read".to_owned(),
            )),
        }
    }
    for (key, _) in want.iter().filter(|(key, _)| !have.iter().any(|(other, _)| other == key)) {
        let message = "it is missing, but the scenario that the properties describe has it".to_owned();
        list.push(edited(found, &format!("{place}/{key}"), message));
    }
}

/// Whether an element holds a partner's recorded way, or the start that belongs to it.
fn recorded(element: &Element) -> bool {
    let starts_in_the_world =
        element.name == "Private" && element.children.len() == 2 && element.deep("WorldPosition").is_some();
    starts_in_the_world || (element.name == "ManeuverGroup" && element.deep("Timing").is_some())
}

/// Children by what tells them apart: element, name or reference, and how many like it came before.
fn named<'a>(children: impl Iterator<Item = &'a Element>) -> Vec<(String, &'a Element)> {
    let mut list: Vec<(String, &Element)> = Vec::new();
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

fn edited(element: &Element, place: &str, message: String) -> Diagnostic {
    let location = Location { line: Some(element.line), ..Location::at_path(place) };
    Diagnostic::new(Severity::Warning, "openscenario.edited", location, message).with_hint(
        "change the parameter declarations or the properties instead, or simulate with the tool you edit for",
    )
}
