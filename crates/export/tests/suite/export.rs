//! What every export holds to, whatever its format.

use crate::common;

use crate::common::{CASES, scenario, straight_on, two_parameters};
use recrash_export::{ExportError, ExportOptions, Format, PartnersAs, export};
use recrash_model::narrative::Origin;
use recrash_model::record::RecordRef;

#[test]
fn formats_are_known_by_name_and_nothing_else_is() {
    for format in Format::ALL {
        assert_eq!(format.name().parse(), Ok(format));
    }
    let error = "opendrive".parse::<Format>().unwrap_err();
    assert!(error.contains("openscenario, scenic, metadrive, commonroad, scenarionet"), "{error}");
}

#[test]
fn the_same_scenario_gives_the_same_bytes() {
    for (name, json) in CASES {
        let (first, second) = (scenario(json), scenario(json));
        let rollout = straight_on(&first, 5);
        for format in Format::ALL {
            let options = ExportOptions::new(format);
            let one = export(&first, Some(&rollout), &two_parameters(&first), &options);
            let two = export(&second, Some(&rollout), &two_parameters(&second), &options);
            assert_eq!(one, two, "{name} as {}", format.name());
        }
    }
}

#[test]
fn recorded_partners_need_a_rollout() {
    let scenario = scenario(CASES[0].1);
    let recorded = ExportOptions { partners_as: PartnersAs::Trajectory, ..ExportOptions::new(Format::OpenScenario) };
    for options in [recorded, ExportOptions::new(Format::CommonRoad), ExportOptions::new(Format::ScenarioNet)] {
        let error = export(&scenario, None, &[], &options).unwrap_err();
        assert_eq!(error, ExportError::NeedsRollout { scenario: "s-cut-in".to_owned() });
    }
}

#[test]
fn every_file_begins_with_title_and_source_records() {
    for (name, json) in CASES {
        let scenario = scenario(json);
        let rollout = straight_on(&scenario, 2);
        for format in Format::ALL {
            let files = export(&scenario, Some(&rollout), &[], &ExportOptions::new(format)).unwrap();
            assert!(!files.is_empty());
            for file in files.iter().filter(|file| file.name != "run_metadrive.py") {
                let text = String::from_utf8_lossy(&file.content);
                // What a pickle says of itself stands at its end.
                let lines = if format == Format::ScenarioNet { usize::MAX } else { 8 };
                let head: String = text.lines().take(lines).collect();
                let record = scenario.draft().source.records[0].to_string();
                assert!(head.contains(name) && head.contains(&record), "{}: {head}", file.name);
            }
        }
    }
}

#[test]
fn every_file_says_whose_crash_it_tells() {
    let reason = || "a test".to_owned();
    let other = RecordRef::try_from("30270-99/2".to_owned()).expect("a report");
    let of = [
        (Some(Origin::Own), "own record"),
        (Some(Origin::Other { record: other, reason: reason() }), "another record, 30270-99/2"),
        (Some(Origin::Invented { reason: reason() }), "invented, no record"),
    ];
    for (origin, told) in of {
        let mut draft = common::draft(CASES[0].1);
        draft.source.origin = origin;
        let scenario = recrash_roads::check(draft).unwrap().value;
        let rollout = straight_on(&scenario, 2);
        for format in Format::ALL {
            let files = export(&scenario, Some(&rollout), &[], &ExportOptions::new(format)).unwrap();
            for file in files.iter().filter(|file| file.name != "run_metadrive.py") {
                assert!(String::from_utf8_lossy(&file.content).contains(told), "{}: {told}", file.name);
            }
        }
    }
}

#[test]
fn hostile_text_stays_text() {
    let mut draft = common::draft(CASES[2].1);
    draft.source.narrative = "--> ]]> \" \"\"\" ''' <a b=\"c\"> & \\ \u{1} \n import os -- ---".to_owned();
    let scenario = recrash_roads::check(draft).unwrap().value;
    let rollout = straight_on(&scenario, 2);
    for format in Format::ALL {
        for file in export(&scenario, Some(&rollout), &[], &ExportOptions::new(format)).unwrap() {
            let text = String::from_utf8_lossy(&file.content);
            if format == Format::ScenarioNet {
                let length = u32::try_from(scenario.draft().source.narrative.len()).unwrap();
                let told =
                    [b"X".as_slice(), &length.to_le_bytes(), scenario.draft().source.narrative.as_bytes()].concat();
                assert!(
                    file.content.windows(told.len()).any(|window| window == told),
                    "a text with its length before it"
                );
            } else if file.name.ends_with(".scenic") {
                assert_eq!(text.matches("\"\"\"").count() % 2, 0, "{}", file.name);
                assert!(!text.lines().any(|line| line.trim_start().starts_with("import os")), "{}", file.name);
            } else if !file.name.ends_with(".py") && !file.name.ends_with(".json") {
                let comment = &text[text.find("<!--").unwrap() + 4..text.find("-->").unwrap()];
                assert!(!comment.contains("--") && !comment.contains('\u{1}'), "{}: {comment}", file.name);
                assert!(text.contains("-->\n<"), "{}: the comment ends where it should", file.name);
            }
        }
    }
}

#[test]
fn every_point_of_the_sweep_is_in_range_and_the_first_is_the_scenario() {
    for (name, json) in CASES {
        let scenario = scenario(json);
        let parameters = two_parameters(&scenario);
        let files = export(&scenario, None, &parameters, &ExportOptions::new(Format::OpenScenario)).unwrap();
        let points = files.iter().find(|file| file.name.ends_with(".points.xosc")).unwrap();
        let text = String::from_utf8(points.content.clone()).unwrap();
        let sets: Vec<&str> = text.split("<ParameterValueSet>").skip(1).collect();
        assert!(sets.len() > 10, "{name}: {} points", sets.len());
        for (number, set) in sets.iter().enumerate() {
            for parameter in &parameters {
                let key = format!("parameterRef=\"{}\" value=\"", recrash_export::parameter_name(&parameter.pointer));
                let from = set.find(&key).unwrap() + key.len();
                let value: f64 = set[from..].split('"').next().unwrap().parse().unwrap();
                assert!((parameter.min..=parameter.max).contains(&value), "{name} point {number}: {value}");
                if number == 0 {
                    assert_eq!(value, parameter.start);
                }
            }
        }
    }
}

#[test]
fn friction_of_the_surface_is_written() {
    use recrash_model::surroundings::Surface;
    for surface in [Surface::Dry, Surface::Wet, Surface::SnowIce] {
        let mut draft = common::draft(CASES[2].1);
        draft.environment.surface = surface;
        let scenario = recrash_roads::check(draft).unwrap().value;
        let files = export(&scenario, None, &[], &ExportOptions::new(Format::OpenScenario)).unwrap();
        let text = String::from_utf8(files[1].content.clone()).unwrap();
        let written = format!("frictionScaleFactor=\"{}\"", surface.relative_friction());
        assert!(text.contains(&written), "{surface:?}: no {written}");
    }
}
