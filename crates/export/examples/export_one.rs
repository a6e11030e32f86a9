//! Exports scenario files: `export_one FOLDER FORMAT[,trajectory] SCENARIO.json...`. With the native simulator's rollout, and two
//! parameters of each scenario as a logical scenario.

use recrash_export::{ExportOptions, Format, PartnersAs, export};
use recrash_model::tuning::Parameter;
use recrash_sim::{Ego, simulate};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().expect("a folder");
    let format = arguments.next().expect("a format");
    let (name, recorded) = format.split_once(',').map_or((format.as_str(), false), |(name, _)| (name, true));
    let mut options = ExportOptions::new(name.parse::<Format>().expect("a format"));
    if recorded {
        options.partners_as = PartnersAs::Trajectory;
    }
    for path in arguments {
        let text = std::fs::read_to_string(&path).expect("a scenario file");
        let draft = recrash_roads::read_draft(&text).expect("a scenario").value;
        let scenario = recrash_roads::check(draft).unwrap_or_else(|found| panic!("{path}: {found:#?}")).value;
        // The crash as it is told, where it is.
        let ego = if scenario.recorded().is_some() { Ego::Recorded } else { Ego::MetadriveIdm };
        let rollout = simulate(&scenario, ego);
        let files = export(&scenario, Some(&rollout), &two_parameters(&scenario), &options).expect("exported");
        for file in files {
            std::fs::write(format!("{folder}/{}", file.name), file.content).expect("written");
        }
        let states = serde_json::to_vec(&rollout).expect("serialises");
        std::fs::write(format!("{folder}/{}.rollout.json", scenario.draft().id), states).expect("written");
    }
}

/// The ego's target speed and the first partner's start may move.
fn two_parameters(scenario: &recrash_roads::Scenario) -> Vec<Parameter> {
    let document = serde_json::to_value(scenario.draft()).expect("serialises");
    let pointers = [
        ("/ego/target_speed_mps", "m/s", 1.0),
        ("/partners/0/start/arrival_gap_s", "s", 0.5),
        ("/partners/0/start/delta_s_m", "m", 3.0),
    ];
    let found = pointers.into_iter().filter_map(|(pointer, unit, around)| {
        let start = document.pointer(pointer)?.as_f64()?;
        Some(Parameter {
            pointer: pointer.to_owned(),
            unit: unit.to_owned(),
            min: start - around,
            max: start + around,
            start,
            integer: false,
            reason: "an example".to_owned(),
        })
    });
    found.collect()
}
