//! Where a file says something else than recrash would write for the scenario it describes: told, and not read.

use crate::openscenario::names::Declaration;
use crate::openscenario::scene::whole;
use crate::openscenario::{ENTITIES, LANES, STORYBOARD, WATCH};
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
    if holds_whole(root) {
        return changed(root);
    }
    let defaults = ExportOptions::new(Format::OpenScenario);
    let min_gap_m = watched_gap_m(root).unwrap_or(defaults.min_gap_m);
    let options = ExportOptions { min_gap_m, ..defaults };
    let expected = crate::openscenario::scenario_element(original, &parameters, &options);
    let mut list = Vec::new();
    for part in ["Entities", "Storyboard"] {
        if let (Some(found), Some(expected)) = (root.find(part), expected.find(part)) {
            compare(found, expected, &format!("OpenSCENARIO/{part}"), &mut list);
        }
    }
    if list.is_empty() {
        list = changed(root);
    }
    list
}

/// What the file calls too near, which is the profile's of whoever wrote it and no part of the scenario. [m]
fn watched_gap_m(root: &Element) -> Option<f64> {
    let watches = |story: &&Element| story.attribute("name").is_some_and(|name| name.starts_with(WATCH));
    let watch = root.find("Storyboard")?.all("Story").find(watches)?;
    watch.deep("RelativeDistanceCondition")?.attribute("value")?.parse().ok()
}

/// Whether the header holds the whole scenario: everybody follows what was recorded, and nothing can be compared with it.
fn holds_whole(root: &Element) -> bool {
    properties(root).is_some_and(|properties| whole(properties).is_some())
}

fn properties(root: &Element) -> Option<&Element> {
    root.find("FileHeader")?.find("Properties")
}

/// What depends on a rollout cannot be compared, but whether it is as it was written can be told.
fn changed(root: &Element) -> Vec<Diagnostic> {
    let written = |name: &str| {
        let found = properties(root)?.all("Property").find(|property| property.attribute("name") == Some(name))?;
        found.attribute("value")
    };
    let parts = [
        ("Entities", ENTITIES, "who takes part was changed since recrash wrote it; this is not read"),
        ("Storyboard", STORYBOARD, "what a road user does was changed since recrash wrote it; this is not read"),
    ];
    let other = parts.into_iter().filter_map(|(part, fingerprint, message)| {
        let (there, written) = (root.find(part)?, written(fingerprint)?);
        (there.fingerprint() != written).then(|| edited(there, &format!("OpenSCENARIO/{part}"), message.to_owned()))
    });
    other.collect()
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
