//! `docs/formats/coverage.md` lists every element that is written, and none that is not.

use crate::common::{CASES, draft, two_parameters};
use recrash_export::{ExportOptions, Format, export};
use recrash_model::kinds::PartnerKind;
use std::collections::BTreeSet;
use std::path::Path;

/// Names of the elements in the committed exports of some folders.
fn written(folders: &[&str], extension: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for folder in folders {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens").join(folder);
        for entry in std::fs::read_dir(&root).expect("a folder of goldens") {
            let path = entry.expect("an entry").path();
            if !path.to_string_lossy().ends_with(extension) {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a golden");
            names.extend(elements(&text));
        }
    }
    assert!(names.len() > 10, "{folders:?}");
    names
}

fn elements(xml: &str) -> impl Iterator<Item = String> {
    let parts = xml.split('<').skip(1).filter(|part| part.starts_with(|c: char| c.is_ascii_alphabetic()));
    parts.map(|part| part.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect())
}

/// Names of the elements of a scenario with a pedestrian, and of the points of its sweep.
fn written_for_a_pedestrian() -> BTreeSet<String> {
    let mut walking = draft(CASES[2].1);
    walking.partners[0].kind = PartnerKind::Pedestrian;
    walking.partners[0].speed_mps = 1.5;
    walking.partners[0].policy = recrash_model::scenario::Policy::IdmNominal { target_speed_mps: 1.5 };
    let scenario = recrash_roads::check(walking).expect("a pedestrian may cross").value;
    let options = ExportOptions::new(Format::OpenScenario);
    let files = export(&scenario, None, &two_parameters(&scenario), &options).expect("exported");
    let scenarios = files.iter().filter(|file| file.name.ends_with(".xosc"));
    scenarios.flat_map(|file| elements(std::str::from_utf8(&file.content).expect("text")).collect::<Vec<_>>()).collect()
}

/// Names of the elements of a scenario whose road users have plans.
fn written_for_a_scene() -> BTreeSet<String> {
    let files = crate::scenes::exported(Format::OpenScenario);
    let scenarios = files.iter().filter(|file| file.name.ends_with(".xosc"));
    scenarios.flat_map(|file| elements(std::str::from_utf8(&file.content).expect("text")).collect::<Vec<_>>()).collect()
}

/// Names in code font in a section of the page.
fn listed(section: &str) -> BTreeSet<String> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats/coverage.md");
    let text = std::fs::read_to_string(page).expect("the page");
    let from = text.find(&format!("## {section}\n")).unwrap_or_else(|| panic!("no section {section}"));
    let body = &text[from + 3..];
    let body = &body[..body.find("\n## ").unwrap_or(body.len())];
    body.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn openscenario() {
    let mut page = listed("OpenSCENARIO XML 1.3");
    page.remove("import");
    let mut found = written(&["openscenario", "openscenario-trajectory"], ".xosc");
    found.extend(written_for_a_pedestrian());
    found.extend(written_for_a_scene());
    assert_eq!(found, page);
}

#[test]
fn opendrive() {
    let mut found = written(&["openscenario"], ".xodr");
    for json in [include_str!("../networks/town.json"), include_str!("../networks/ramps.json")] {
        let scenario = recrash_roads::check(draft(json)).expect("a network passes the check").value;
        let files = export(
            &scenario,
            Some(&recrash_sim::simulate(&scenario, recrash_sim::Ego::Recorded)),
            &[],
            &ExportOptions::new(Format::OpenScenario),
        )
        .expect("exported");
        let map = files.iter().find(|file| file.name.ends_with(".xodr")).expect("a map");
        found.extend(elements(std::str::from_utf8(&map.content).expect("text")));
    }
    assert_eq!(found, listed("OpenDRIVE 1.7"));
}

#[test]
fn commonroad() {
    let mut page = listed("CommonRoad 2020a");
    for value in ["sunny", "day", "clear", "noon"] {
        page.remove(value);
    }
    assert_eq!(written(&["commonroad"], ".cr.xml"), page);
}
