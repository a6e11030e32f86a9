//! Drivers on the grids of UN R157.

use crate::common::{Place, driving_ego};
use serde_json::Value;

fn crashes(check: &Value, grid: &str, driver: &str) -> u64 {
    let rows = check["grids"].as_array().expect("rows");
    let row = rows.iter().find(|row| row["grid"] == grid && row["driver"] == driver).expect("a row");
    row["crashes"].as_u64().expect("a number")
}

#[test]
fn the_reference_drivers_crash_as_often_as_published() {
    let place = Place::new();
    let (code, shown, told) = place.run(&["check-driver", "--json"]);
    assert_eq!(code, 0, "{told}");
    let check: Value = serde_json::from_str(&shown).expect("JSON");
    assert_eq!(crashes(&check, "cut-in-fast", "careful"), 3552);
    assert_eq!(crashes(&check, "cut-in-slow", "fsm"), 901);
    assert_eq!(crashes(&check, "cut-out", "rss"), 936);
    assert_eq!(crashes(&check, "following", "rss"), 21);
    let limits: Vec<String> = check["limits"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| format!("{:.2}", row["belted_s"].as_f64().expect("a number")))
        .collect();
    assert_eq!(limits, ["0.48", "0.71", "0.94", "1.18", "1.41", "1.64"]);
    let written = std::fs::read(place.path("check-driver/check-driver.json")).expect("the same as a file");
    assert_eq!(serde_json::from_slice::<Value>(&written).expect("JSON"), check);
    let verdicts = std::fs::read_to_string(place.path("check-driver/verdicts.csv")).expect("verdicts");
    assert_eq!(verdicts.lines().count(), 1 + 4 * (14_040 + 15_930) + 3 * (5_850 + 1_121));
    let plot = std::fs::read_to_string(place.path("check-driver/cut-out.svg")).expect("a plot");
    assert!(plot.starts_with("<svg") && plot.contains("130 km/h") && plot.ends_with("</svg>\n"));
}

#[test]
fn a_program_that_never_brakes_is_told_from_one_that_does() {
    let place = Place::new();
    std::fs::write(place.path("ego.py"), driving_ego(12.0)).expect("written");
    let of = |ego: &str| {
        let (code, shown, told) =
            place.run(&["check-driver", "--every", "300", "--ego", ego, "--json", "--out", "out"]);
        assert_eq!(code, 0, "{told}");
        let check: Value = serde_json::from_str(&shown).expect("JSON");
        let rows = check["grids"].as_array().expect("rows").iter().filter(|row| !row["avoided_by"].is_null());
        let (mut crashes, mut avoidable) = (0, 0);
        for row in rows {
            crashes += row["crashes"].as_u64().expect("a number");
            avoidable += row["avoided_by"]["all"].as_u64().expect("a number");
        }
        (crashes, avoidable)
    };
    let (blind, blind_avoidable) = of("cmd:python3 ego.py");
    let (idm, _) = of("idm");
    assert!(blind > 2 * idm + 5, "{blind} and {idm} crashes");
    assert!(blind_avoidable > 0);
}

#[test]
fn an_ego_that_is_not_there_stops_it_with_one_line() {
    let place = Place::new();
    let (code, _, told) = place.run(&["check-driver", "--ego", "nobody"]);
    assert_eq!(code, 3, "{told}");
    assert!(told.contains("no ego is called `nobody`") && told.lines().count() == 1, "{told}");
    assert!(!place.path("check-driver").exists());
}

#[test]
fn a_contact_is_told_with_its_severity_and_who_would_have_avoided_it() {
    let place = Place::new();
    let scenario = r#"{ "format": "recrash.scenario/1", "id": "braking-leader", "source": {}, "duration_s": 20.0,
        "map": { "type": "S", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "length_m": 300.0 },
        "ego": { "lane": 1, "turn": "straight", "s_m": 5.0, "speed_mps": 12.0, "target_speed_mps": 12.0 },
        "partners": [ { "id": "cp1", "approach": "same", "start": { "delta_s_m": 30.0 }, "speed_mps": 12.0,
            "policy": { "type": "sudden_brake", "target_speed": 0.0, "brake_step": 5, "brake_steps": 100 } } ] }"#;
    std::fs::write(place.path("scenario.json"), scenario).expect("written");
    std::fs::write(place.path("ego.py"), driving_ego(12.0)).expect("written");
    let (code, shown, told) = place.run(&["simulate", "scenario.json", "--ego", "cmd:python3 ego.py"]);
    assert_eq!(code, 0, "{told}");
    for words in [
        "the ego: delta-v 5.8",
        "force from 12 o'clock",
        "the partner: delta-v 5.8",
        "avoided by all reference drivers: careful avoids it",
    ] {
        assert!(shown.contains(words), "does not say \"{words}\":\n{shown}");
    }
}
