//! Networks of roads, plans and control on a real MetaDrive.

use crate::common::checked;
use crate::real_metadrive::start;
use recrash_metadrive::{Drive, MetadriveError};
use recrash_model::rollout::{Role, TerminationKind};
use recrash_roads::Scenario;
use serde_json::{Value, json};

/// A two-way street that bends, with a signal and a sidewalk; the ego is recorded at 10 m/s for 2 s.
fn street() -> Value {
    json!({
        "format": "recrash.scenario/2", "id": "street", "source": {}, "duration_s": 14,
        "map": {"type": "G", "roads": [
            {"id": "main", "start": {"at": {"x_m": 0, "y_m": 0, "heading_deg": 0}},
             "line": [{"straight": {"length_m": 60}}, {"arc": {"length_m": 40, "radius_m": 60, "to": "left"}}],
             "right": [{"kind": "driving"}, {"kind": "parking"}, {"kind": "sidewalk"}], "left": [{"kind": "driving"}]},
            {"id": "next", "start": {"after": {"road": "main"}}, "line": [{"straight": {"length_m": 60}}],
             "right": [{"kind": "driving"}], "left": [{"kind": "driving"}]}]},
        "control": [{"at": "main+", "set_back_m": 20, "device": {"signal": {"program": [{"show": "red", "for_s": 30}]}}}],
        "ego": {"route": ["main+", "next+"], "target_speed_mps": 10, "handover_s": 2,
                "recorded": {"start": {"road": "main+", "s_m": 10}, "speed_mps": 10,
                             "course": [{"lanes": {"roads": ["main+", "next+"]}}]}},
        "actors": []
    })
}

fn oncoming() -> Value {
    json!({"id": "cp", "kind": "van", "plan": {"start": {"road": "main-", "s_m": 20}, "speed_mps": 8,
           "course": [{"lanes": {"roads": ["main-"]}}]}})
}

#[test]
fn plans_are_replayed_and_the_ego_stops_at_a_red_signal_after_the_handover() {
    let Some(metadrive) = start() else { return };
    let mut draft = street();
    draft["actors"] = json!([oncoming(), {"id": "walker", "kind": "pedestrian", "plan": {"appears_s": 1.0,
        "start": {"x_m": 30, "y_m": -7, "heading_deg": 0}, "speed_mps": 1.4, "course": [{"path": {"points": [[45, -7]]}}]}}]);
    let scenario = checked(&draft);
    let rollout = metadrive.simulate(&scenario, &Drive::MetadriveIdm).unwrap_or_else(|error| panic!("{error}"));
    let (ego, cp, walker) = (&rollout.actors[0], &rollout.actors[1], &rollout.actors[2]);
    for step in 0..20 {
        let wanted = 10.0 + f64::from(step as u32);
        assert!((ego.states[step].x - wanted).abs() < 1e-3, "recorded: {:?}", ego.states[step]);
    }
    let (before, after) = (ego.states[20], ego.states[21]);
    assert!((after.speed() - before.speed()).abs() < 0.5 && after.x - before.x < 1.2, "{before:?} {after:?}");
    // The line is 20 m before the lane's end, on the outside of the bend; the front stays 0.3 m before it.
    let last = ego.states[ego.states.len() - 1];
    assert!(last.speed() < 0.1, "{last:?}");
    let lane = scenario.network().lane_at(last.position(), last.heading).expect("on the road");
    let along = 60.0 + scenario.network().lane(lane).local(last.position()).0;
    let line = 60.0 + 40.0 * (60.0 + 1.65) / 60.0 - 20.0;
    assert!((line - 0.8..line + 0.05).contains(&(along + 2.2575)), "{along}");
    assert_eq!(rollout.termination.kind, TerminationKind::Timeout);
    // It has 8 m/s along the bend, and then along the straight.
    let way: f64 = cp.states[..60].windows(2).map(|pair| pair[0].position().distance(pair[1].position())).sum();
    assert!((way - 0.1 * 59.0 * 8.0).abs() < 0.02, "{way}");
    assert_eq!((cp.role, cp.id.as_str(), walker.appears_s), (Role::Partner, "cp", 1.0));
}

#[test]
fn a_door_of_a_parked_car_is_touched() {
    let Some(metadrive) = start() else { return };
    let mut draft = street();
    draft["control"] = json!([]);
    draft["actors"] = json!([{"id": "parked",
        "parts": [{"id": "door", "kind": "door", "x_m": 0.6, "y_m": 0.9, "length_m": 1.1, "width_m": 0.1}],
        "plan": {"start": {"road": "main+.parking", "s_m": 40, "t_m": -0.2},
                 "acts": [{"when": {"time_s": 0.5}, "do": {"part": {"part": "door", "to_deg": 70, "over_s": 0.5}}}]}}]);
    let rollout = metadrive.simulate(&checked(&draft), &Drive::Recorded).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(rollout.termination.kind, TerminationKind::Contact);
    let (other, time_s, state, _) = rollout.first_ego_contact().expect("a contact");
    assert_eq!(rollout.actors[other].id, "parked");
    // Its front reaches the door's end, 0.6 - 1.1 cos 70 deg m ahead of the middle of the car.
    let end = 40.0 + 0.6 - 1.1 * 0.342;
    assert!((state.x + 2.2575 - end).abs() < 0.35, "{state:?} at {time_s} s");
    let part = rollout.actors.last().expect("parts come last");
    assert_eq!((part.role, part.part_of, part.id.as_str()), (Role::Part, Some(1), "parked.door"));
    assert_eq!(part.states.len(), rollout.steps());
}

#[test]
fn what_nobody_can_replay_is_refused_by_name() {
    let Some(metadrive) = start() else { return };
    let mut watching = street();
    watching["actors"] = json!([oncoming()]);
    watching["actors"][0]["plan"]["acts"] =
        json!([{"when": {"near": {"actor": "ego", "within_m": 1}}, "do": {"stop": {"rate_mps2": 4}}}]);
    let told = |scenario: &Scenario| match metadrive.simulate(scenario, &Drive::MetadriveIdm) {
        Err(error @ MetadriveError::Refused { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let told_of_the_act = told(&checked(&watching));
    assert!(told_of_the_act.contains("`street`") && told_of_the_act.contains("act 1 of cp"), "{told_of_the_act}");
    // With the recorded driver to the end there is nothing to know.
    let recorded = metadrive.simulate(&checked(&watching), &Drive::Recorded);
    assert_eq!(recorded.unwrap_or_else(|error| panic!("{error}")).ego, "recorded");
    let mut pushing = street();
    pushing["actors"] = json!([oncoming(), oncoming()]);
    pushing["actors"][1]["id"] = json!("behind");
    pushing["actors"][1]["plan"]["start"]["s_m"] = json!(8);
    pushing["actors"][1]["plan"]["speed_mps"] = json!(14);
    let told_of_the_push = told(&checked(&pushing));
    assert!(told_of_the_push.contains("cp and behind push each other"), "{told_of_the_push}");
}
