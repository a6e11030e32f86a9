//! One scenario per map in every format, as committed files reviewed by eye. `UPDATE_GOLDENS=1` writes them anew, and
//! fails all the same, so that nobody updates them unseen.

use crate::common::{CASES, scenario, straight_on, two_parameters};
use recrash_export::{ExportOptions, Format, PartnersAs, export};
use recrash_sim::{Ego, simulate};
use std::path::Path;

/// Steps of the recording: enough to see its shape.
const STEPS: usize = 3;

fn check(format: Format, partners_as: PartnersAs, folder: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens").join(folder);
    let update = std::env::var_os("UPDATE_GOLDENS").is_some();
    let mut different = Vec::new();
    for (name, json) in CASES {
        let scenario = scenario(json);
        let recorded = partners_as == PartnersAs::Trajectory || format == Format::CommonRoad;
        // Actions are fitted to what was driven; a recording is a recording, and short ones are enough to look at.
        let rollout = if recorded { straight_on(&scenario, STEPS) } else { simulate(&scenario, Ego::Idm) };
        let options = ExportOptions { partners_as, ..ExportOptions::new(format) };
        let files = export(&scenario, Some(&rollout), &two_parameters(&scenario), &options)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        // The map is the same in every export; the points of a sweep are counted elsewhere.
        let map_is_elsewhere = recorded || format == Format::Scenic;
        let files = files.into_iter().filter(|file| !file.name.ends_with(".points.xosc"));
        let files = files.filter(|file| !(map_is_elsewhere && file.name.ends_with(".xodr")));
        for file in files {
            let path = root.join(&file.name);
            if std::fs::read(&path).is_ok_and(|golden| golden == file.content) {
                continue;
            }
            different.push(file.name.clone());
            if update {
                std::fs::create_dir_all(&root).expect("a folder");
                std::fs::write(&path, &file.content).expect("written");
            }
        }
    }
    assert!(different.is_empty(), "{folder}: not as committed: {different:?}; UPDATE_GOLDENS=1 writes them anew");
}

#[test]
fn openscenario_with_actions() {
    check(Format::OpenScenario, PartnersAs::Actions, "openscenario");
}

#[test]
fn openscenario_with_trajectories() {
    check(Format::OpenScenario, PartnersAs::Trajectory, "openscenario-trajectory");
}

#[test]
fn scenic() {
    check(Format::Scenic, PartnersAs::Actions, "scenic");
}

#[test]
fn metadrive() {
    check(Format::MetaDrive, PartnersAs::Actions, "metadrive");
}

#[test]
fn commonroad() {
    check(Format::CommonRoad, PartnersAs::Actions, "commonroad");
}
