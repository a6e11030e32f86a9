//! Scenarios whose road users have plans: told by what was recorded.

use crate::common::{draft, scenario};
use recrash_export::{ExportError, ExportFile, ExportOptions, Format, export, import};
use recrash_sim::{Ego, simulate};

/// A car that stands at a red signal is hit from behind; others cross, park, walk, appear and leave.
const RED_LIGHT: &str = include_str!("../scenes/red-light.json");

/// Its files in a format, with the recorded driver in the ego's seat.
pub fn exported(format: Format) -> Vec<ExportFile> {
    let scenario = scenario(RED_LIGHT);
    let rollout = simulate(&scenario, Ego::Recorded);
    export(&scenario, Some(&rollout), &[], &ExportOptions::new(format)).expect("exported")
}

fn xosc() -> String {
    let files = exported(Format::OpenScenario);
    let file = files.into_iter().find(|file| file.name.ends_with(".xosc")).expect("a scenario file");
    String::from_utf8(file.content).expect("text")
}

#[test]
fn everybody_follows_what_was_recorded_and_the_ego_hands_over() {
    let scenario = scenario(RED_LIGHT);
    let rollout = simulate(&scenario, Ego::Recorded);
    let text = xosc();
    for track in &rollout.actors {
        assert!(text.contains(&format!("<ScenarioObject name=\"{}\">", track.id)), "{}", track.id);
        assert!(text.contains(&format!("<Trajectory name=\"{}: recorded\"", track.id)), "{}", track.id);
    }
    let present: usize =
        rollout.actors.iter().map(|track| (0..rollout.steps()).filter(|step| track.is_present(*step)).count()).sum();
    // Two more where ego and the one behind it touch between two steps.
    let vertices = text.matches("<Vertex ").count();
    assert!((present..=present + 2).contains(&vertices), "{vertices} of {present}");
    assert!(text.contains("<Condition name=\"ego: handover\""), "a system under test takes over at its time");
    assert!(text.contains("<AddEntityAction>") && text.contains("<EntityAction entityRef=\"cyclist\">"));
    // A program of 9, 20 and 3 s, from its beginning.
    let phases: Vec<&str> =
        text.split("<Phase ").skip(1).map(|rest| rest.split('>').next().unwrap_or_default()).collect();
    assert_eq!(
        phases,
        ["name=\"1 red\" duration=\"9\"", "name=\"2 green\" duration=\"20\"", "name=\"3 yellow\" duration=\"3\""]
    );
    assert!(text.contains("recrash.remark.1"), "what is not carried is told");
}

#[test]
fn the_whole_scenario_is_read_back() {
    let read = import(&xosc()).expect("read");
    assert_eq!(read.value.draft(), &draft(RED_LIGHT));
    assert_eq!(read.diagnostics, [], "nobody edited it");
}

#[test]
fn an_edit_of_what_was_recorded_is_told_and_not_read() {
    let text = xosc();
    for (from, to, part) in [
        ("<Dimensions width=\"1.8", "<Dimensions width=\"1.9", "OpenSCENARIO/Entities"),
        ("<Vertex time=\"1\"", "<Vertex time=\"1.01\"", "OpenSCENARIO/Storyboard"),
    ] {
        let edited = text.replacen(from, to, 1);
        assert_ne!(edited, text, "{from}");
        let read = import(&edited).expect("read");
        assert_eq!(read.value.draft(), &draft(RED_LIGHT));
        let told: Vec<_> =
            read.diagnostics.iter().map(|told| (told.code.as_str(), told.location.path.as_deref())).collect();
        assert_eq!(told, [("openscenario.edited", Some(part))]);
    }
}

#[test]
fn scenic_gets_everybody_with_what_was_recorded_and_says_what_it_does_not_carry() {
    let scenario = scenario(RED_LIGHT);
    let rollout = simulate(&scenario, Ego::Recorded);
    let files = exported(Format::Scenic);
    let text = std::str::from_utf8(&files[1].content).expect("text");
    assert_eq!(text.matches("with behavior ").count(), rollout.actors.len());
    for (at, track) in rollout.actors.iter().enumerate().skip(1) {
        assert!(text.contains(&format!("with name \"{}\"", track.id)), "{}", track.id);
        assert!(text.contains(&format!("with behavior Recorded(TRACK{at})")), "{}", track.id);
        assert!(text.contains(&format!("as \"contact with {}\"", track.id)), "{}", track.id);
    }
    assert_eq!(text.matches("\nnew Object at").count(), rollout.obstacles.len());
    assert!(text.contains(&format!("until seconds() >= {}\n", draft(RED_LIGHT).ego.handover_s.unwrap_or(0.0))));
    for remark in ["nobody reacts", "cyclist is not in the world before", "What signals show is not carried"] {
        assert!(text.contains(remark), "{remark}");
    }
}

#[test]
fn plans_need_a_rollout_and_metadrive_takes_them_as_they_are() {
    let scenario = scenario(RED_LIGHT);
    for format in [Format::OpenScenario, Format::Scenic, Format::ScenarioNet] {
        let error = export(&scenario, None, &[], &ExportOptions::new(format)).unwrap_err();
        assert_eq!(error, ExportError::NeedsRollout { scenario: "red-light".to_owned() });
    }
    let files = export(&scenario, None, &[], &ExportOptions::new(Format::MetaDrive)).expect("exported");
    let json: serde_json::Value = serde_json::from_slice(&files[0].content).expect("JSON");
    assert_eq!(json["run"]["scene"]["planned"].as_array().map(Vec::len), Some(5));
    assert!(json["run"]["scene"]["lanes"].as_array().is_some_and(|lanes| lanes.len() > 20));
}
