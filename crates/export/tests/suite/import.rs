//! OpenSCENARIO read back.

use crate::common::{CASES, draft, scenario, straight_on, two_parameters};
use proptest::prelude::*;
use recrash_export::{ExportOptions, Format, PartnersAs, export, import};
use recrash_model::Diagnostic;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{LateralMove, Policy, ScenarioDraft};
use recrash_sim::{Ego, simulate};

fn exported(draft: &ScenarioDraft, partners_as: PartnersAs) -> String {
    let scenario = recrash_roads::check(draft.clone()).unwrap().value;
    let rollout = straight_on(&scenario, 4);
    let options = ExportOptions { partners_as, ..ExportOptions::new(Format::OpenScenario) };
    let files = export(&scenario, Some(&rollout), &two_parameters(&scenario), &options).unwrap();
    let file = files.into_iter().find(|file| file.name == format!("{}.xosc", draft.id)).unwrap();
    String::from_utf8(file.content).unwrap()
}

/// Remarks on the file, rather than of the check on the scenario in it.
fn about_the_file(diagnostics: &[Diagnostic]) -> Vec<&Diagnostic> {
    diagnostics.iter().filter(|diagnostic| diagnostic.code.starts_with("openscenario.")).collect()
}

#[test]
fn what_was_written_is_read_back_without_a_remark() {
    for (name, json) in CASES {
        for partners_as in [PartnersAs::Actions, PartnersAs::Trajectory] {
            let read = import(&exported(&draft(json), partners_as)).unwrap_or_else(|e| panic!("{name}: {e:#?}"));
            assert_eq!(read.value.draft(), &draft(json), "{name}");
            assert_eq!(read.diagnostics, [], "{name} {partners_as:?}");
        }
    }
}

/// With what a simulator recorded, speeds are written as they were driven; that is no edit.
#[test]
fn what_depends_on_a_rollout_is_passed_over() {
    for (name, json) in CASES {
        let scenario = scenario(json);
        let rollout = simulate(&scenario, Ego::Idm);
        let files = export(&scenario, Some(&rollout), &[], &ExportOptions::new(Format::OpenScenario)).unwrap();
        let read = import(std::str::from_utf8(&files[1].content).unwrap()).unwrap();
        assert_eq!(about_the_file(&read.diagnostics), Vec::<&Diagnostic>::new(), "{name}");
    }
}

#[test]
fn what_cannot_be_run_names_element_and_line() {
    let text = exported(&draft(CASES[2].1), PartnersAs::Actions);
    let line_of = |words: &str| text.lines().position(|line| line.contains(words)).unwrap() as u64 + 1;
    let told = |changed: String| {
        assert_ne!(changed, text);
        let location = import(&changed).unwrap_err()[0].location.clone();
        (location.line.unwrap(), location.path.unwrap_or_default())
    };
    let speed = r#"name="partner1SpeedMps" parameterType="double" value=""#;
    let (line, path) = told(text.replace(speed, &format!("{speed}9")));
    assert_eq!(line, line_of(speed));
    assert_eq!(path, "OpenSCENARIO/ParameterDeclarations/partner1SpeedMps: partners[0].speed_mps");
    let (line, path) = told(text.replace(
        "&quot;turn&quot;:&quot;straight&quot;,&quot;lane_offset",
        "&quot;turn&quot;:&quot;up&quot;,&quot;lane_offset",
    ));
    assert_eq!(path, "OpenSCENARIO/Entities/ScenarioObject[cp1]: partners[0].turn");
    assert_eq!(line, line_of("&quot;id&quot;:&quot;cp1&quot;"));
}

/// A remark each for a thousand foreign parameters would hide what matters.
#[test]
fn many_remarks_are_counted() {
    let text = exported(&draft(CASES[0].1), PartnersAs::Actions);
    let foreign: String = (0..1000).map(|i| format!("<ParameterDeclaration name=\"x{i}\" value=\"1\"/>")).collect();
    let read =
        import(&text.replace("</ParameterDeclarations>", &format!("{foreign}</ParameterDeclarations>"))).unwrap();
    let remarks = about_the_file(&read.diagnostics);
    assert_eq!(remarks.len(), 21);
    assert!(remarks[20].message.starts_with("980 more"), "{}", remarks[20].message);
}

#[test]
fn a_scenario_read_back_gives_the_rollout_of_the_original_bit_for_bit() {
    for (name, json) in CASES {
        let original = simulate(&scenario(json), Ego::Idm);
        let read = import(&exported(&draft(json), PartnersAs::Actions)).unwrap().value;
        let again = simulate(&read, Ego::Idm);
        assert_eq!(original.state_hash, again.state_hash, "{name}");
    }
}

#[test]
fn a_parameter_that_was_changed_counts() {
    let text = exported(&draft(CASES[2].1), PartnersAs::Actions);
    let changed = text
        .replace(
            "name=\"partner1StartArrivalGapS\" parameterType=\"double\" value=\"-0.4\"",
            "name=\"partner1StartArrivalGapS\" parameterType=\"double\" value=\"0.25\"",
        )
        .replace(
            "name=\"partner1PolicyBrakeStep\" parameterType=\"integer\" value=\"75\"",
            "name=\"partner1PolicyBrakeStep\" parameterType=\"integer\" value=\"60\"",
        );
    assert_ne!(text, changed);
    let read = import(&changed).unwrap();
    let mut expected = draft(CASES[2].1);
    expected.partners[0].start = recrash_model::scenario::Start::ArrivalGap { arrival_gap_s: 0.25 };
    let Policy::AccelThenBrake { brake_step, .. } = &mut expected.partners[0].policy else { unreachable!() };
    *brake_step = 60;
    assert_eq!(read.value.draft(), &expected);
    assert_eq!(read.diagnostics, []);
}

#[test]
fn a_change_that_is_not_read_is_told_with_its_place() {
    let text = exported(&draft(CASES[2].1), PartnersAs::Actions);
    let changed = text
        .replacen("laneId=\"2\"", "laneId=\"1\"", 1)
        .replace("<RoadCondition frictionScaleFactor=\"1\"", "<RoadCondition frictionScaleFactor=\"0.5\"");
    let read = import(&changed).unwrap();
    assert_eq!(read.value.draft(), &draft(CASES[2].1));
    let places: Vec<&str> = read.diagnostics.iter().filter_map(|d| d.location.path.as_deref()).collect();
    assert_eq!(places.len(), 2, "{:#?}", read.diagnostics);
    assert!(places.iter().any(|place| place.ends_with("RoadCondition/@frictionScaleFactor")), "{places:?}");
    assert!(places.iter().any(|place| place.contains("Private[cp1]") && place.ends_with("@laneId")), "{places:?}");
    assert!(read.diagnostics.iter().all(|d| d.code == "openscenario.edited" && !d.is_error()));
}

#[test]
fn a_changed_speed_or_recording_is_told_although_only_a_rollout_knows_it() {
    for (partners_as, what) in [(PartnersAs::Actions, "SpeedProfileEntry"), (PartnersAs::Trajectory, "Vertex")] {
        let text = exported(&draft(CASES[2].1), partners_as);
        let at = text.find(&format!("<{what} ")).unwrap();
        let time = at + text[at..].find("time=\"").unwrap() + "time=\"".len();
        let changed = format!("{}9{}", &text[..time], &text[time..]);
        let read = import(&changed).unwrap();
        assert_eq!(read.value.draft(), &draft(CASES[2].1));
        let told: Vec<_> = read.diagnostics.iter().map(|d| (d.code.as_str(), d.location.path.as_deref())).collect();
        assert_eq!(told, [("openscenario.edited", Some("OpenSCENARIO/Storyboard"))], "{what}");
    }
}

#[test]
fn a_partner_that_was_taken_out_is_gone() {
    let two = draft(CASES[1].1);
    let text = exported(&two, PartnersAs::Actions);
    let from = text.find("    <ScenarioObject name=\"oncoming\">").unwrap();
    let until = from + text[from..].find("</ScenarioObject>").unwrap() + "</ScenarioObject>\n".len();
    let read = import(&format!("{}{}", &text[..from], &text[until..])).unwrap();
    assert_eq!(read.value.draft().partners, two.partners[..1]);
    assert!(read.diagnostics.iter().any(|d| d.code == "openscenario.edited"), "its actions are left over");
    assert!(read.diagnostics.iter().any(|d| d.code == "openscenario.parameter"), "and its parameters");
}

#[test]
fn what_is_not_ours_is_refused_in_plain_words() {
    let code = |text: &str| import(text).unwrap_err()[0].code.clone();
    assert_eq!(code("no XML at all"), "openscenario.syntax");
    assert_eq!(code("<OpenSCENARIO><FileHeader></OpenSCENARIO>"), "openscenario.syntax");
    assert_eq!(code("<OpenDRIVE/>"), "openscenario.root");
    assert_eq!(code("<OpenSCENARIO><FileHeader revMajor=\"1\"/></OpenSCENARIO>"), "openscenario.not-ours");
    assert_eq!(code("<!DOCTYPE x [<!ENTITY a \"b\">]><OpenSCENARIO/>"), "openscenario.syntax");
    let ours = exported(&draft(CASES[0].1), PartnersAs::Actions);
    assert_eq!(
        code(&ours.replace(
            "value=\"20\"/>\n    <ParameterDeclaration name=\"egoC",
            "value=\"x\"/>\n    <ParameterDeclaration name=\"egoC"
        )),
        "openscenario.parameter"
    );
    assert_eq!(code(&ours.replacen("recrash.scenario/1", "other", 1)), "openscenario.foreign-entity");
    let deep = "<a>".repeat(100) + &"</a>".repeat(100);
    assert_eq!(code(&deep), "openscenario.syntax");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Numbers of any size keep their bits on the way.
    #[test]
    fn numbers_keep_their_bits(speed in 1.0_f64..15.0, gap in -0.6_f64..0.3, start in 0.0_f64..20.0, to in -1.5_f64..1.5) {
        let mut changed = draft(CASES[2].1);
        changed.ego.speed_mps = speed;
        changed.ego.s_m = start;
        changed.partners[0].start = recrash_model::scenario::Start::ArrivalGap { arrival_gap_s: gap };
        changed.partners[0].lateral = vec![LateralMove { start_s: speed, duration_s: 1.0 / 3.0 + 0.5, to_t_m: to }];
        prop_assume!(recrash_roads::check(changed.clone()).is_ok());
        let read = import(&exported(&changed, PartnersAs::Actions)).unwrap();
        prop_assert_eq!(read.value.draft(), &changed);
        prop_assert_eq!(about_the_file(&read.diagnostics), Vec::<&Diagnostic>::new());
    }

    /// Maps of any measures, and road users anywhere on them: every format is written, and ours is read back. About
    /// two in five pass the check.
    #[test]
    fn any_scenario_that_passes_the_check_is_exported(
        case in 0_usize..5,
        lanes in 1_u8..5,
        lane in 0_u8..4,
        width in 2.5_f64..4.5,
        approach in 20.0_f64..300.0,
        s in 0.0_f64..200.0,
        gap in -2.0_f64..2.0,
        kind in 0_usize..13,
    ) {
        let mut changed = draft(CASES[case].1);
        let mut map = serde_json::to_value(&changed.map).unwrap();
        map["lanes"] = lanes.into();
        map["lane_width_m"] = width.into();
        map["approach_m"] = approach.into();
        changed.map = serde_json::from_value(map).unwrap();
        changed.ego.lane = lane.min(lanes - 1);
        changed.ego.s_m = s;
        changed.partners.truncate(1);
        changed.partners[0].lane_offset = 0;
        changed.partners[0].kind = PartnerKind::ALL[kind];
        if let recrash_model::scenario::Start::ArrivalGap { arrival_gap_s } = &mut changed.partners[0].start {
            *arrival_gap_s = gap;
        }
        changed.obstacles.clear();
        let Ok(checked) = recrash_roads::check(changed.clone()) else { return Ok(()) };
        let rollout = straight_on(&checked.value, 3);
        for format in Format::ALL {
            let options = ExportOptions::new(format);
            let files = export(&checked.value, Some(&rollout), &two_parameters(&checked.value), &options).unwrap();
            // The bytes of a pickle's numbers may spell anything: what writes them holds them to be finite.
            for file in files.iter().filter(|file| !file.name.ends_with(".pkl")) {
                let text = String::from_utf8_lossy(&file.content);
                prop_assert!(!text.contains("NaN") && !text.contains("\"inf"), "{}", file.name);
            }
        }
        let read = import(&exported(&changed, PartnersAs::Actions)).unwrap();
        prop_assert_eq!(read.value.draft(), &changed);
        prop_assert_eq!(about_the_file(&read.diagnostics), Vec::<&Diagnostic>::new());
    }

    /// A file that was cut or garbled anywhere is read or refused; nothing panics.
    #[test]
    fn no_damage_makes_it_panic(at in 0.0_f64..1.0, length in 0_usize..40, put in ".{0,20}") {
        let text = exported(&draft(CASES[1].1), PartnersAs::Actions);
        let from = text.floor_char_boundary((at * text.len() as f64) as usize);
        let until = text.ceil_char_boundary((from + length).min(text.len()));
        let _ = import(&format!("{}{put}{}", &text[..from], &text[until..]));
    }
}
