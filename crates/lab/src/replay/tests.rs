use super::*;
use recrash_model::scenario::GraphMap;
use recrash_roads::Simulator;
use recrash_sim::{Ego, Native};

/// The replay of one of the hand-made cases, with its recorded driver.
fn replay(json: &str) -> String {
    let draft = recrash_roads::read_draft(json).expect("a scenario of ours").value;
    let scenario = recrash_roads::check(draft).expect("it can be run").value;
    let rollout = Native::new(Ego::Recorded).run(&scenario).expect("the native simulator runs everything");
    in_words(scenario.draft(), &rollout) + &in_the_plane(&rollout)
}

#[track_caller]
fn tells(replay: &str, parts: &[&str]) {
    for part in parts {
        assert!(replay.contains(part), "{part}:\n{replay}");
    }
}

#[test]
fn who_stands_at_a_signal_and_who_comes_from_behind_is_told() {
    let told = replay(include_str!("../../../../cases/crashes/01-rear-end-at-red.json"));
    tells(
        &told,
        &[
            "Road 'west' ",
            "Junction 'c' at x 0.0 m, y 0.0 m",
            "Signal at the end of 'west-': red from 0.0 s",
            "Road users: ego: passenger car, 4.51 x 1.85 m; cp: passenger car, ",
            "Centres at the start: ego: road 'west', to the junction, lane 1 of 1 from the middle; ",
            " 0.0 s | ego 0.0 m along, +0.0 m to the left of where it began, turned +0 deg, ",
            " behind, ",
            "ego and cp touch: rear of ego on front of cp",
            "It ends at ",
            "Centres in the plane (x m, y m, heading deg):\n 0.0 s: ego (",
            "The contact of ego and cp is 2.2 m behind and ",
        ],
    );
    assert_eq!(told, replay(include_str!("../../../../cases/crashes/01-rear-end-at-red.json")));
}

#[test]
fn doors_arms_and_things_are_told() {
    tells(
        &replay(include_str!("../../../../cases/crashes/06-door-opened-into-traffic.json")),
        &["Door of ", " deg from shut"],
    );
    tells(
        &replay(include_str!("../../../../cases/crashes/35-ego-backs-into-a-pole.json")),
        &["ego and pole touch: rear of ego on ", "pole: fixed object, ", "in reverse"],
    );
    tells(
        &replay(include_str!("../../../../cases/crashes/22-gate-arm-comes-down.json")),
        &["Arm of gate: begins to turn at ", "gate.arm: fixed object, 3.60 x 0.10 m, part of gate", "), gate.arm ("],
    );
    tells(
        &replay(include_str!("../../../../cases/kinds/22-pole-wall-kerb.json")),
        &[
            "Thing 0 is a pole, 0.30 m long",
            "Centres at the end: ego: ",
            "nobody touches anybody or anything",
            "Least gap of ego and thing ",
        ],
    );
}

/// A place of a road's cross-section, and how far the body reaches over its edges.
#[test]
fn a_body_over_a_line_is_told_with_what_it_reaches_into() {
    let map: GraphMap = serde_json::from_value(serde_json::json!({"roads": [{
        "id": "main", "start": {"at": {"x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0}}, "line": [{"straight": {"length_m": 100.0}}],
        "right": [{"kind": "driving"}, {"kind": "driving"}, {"kind": "parking"}], "left": [{"kind": "driving"}],
    }]}))
    .unwrap();
    let rollout = |y: f64| {
        let state = ActorState { x: 50.0, y, vx: 5.0, ..ActorState::default() };
        let actor = ActorTrack {
            id: "cp".into(),
            role: Role::Partner,
            part_of: None,
            kind: PartnerKind::PassengerCar,
            length_m: 4.5,
            width_m: 1.9,
            mass_kg: None,
            appears_s: 0.0,
            gone_s: None,
            states: vec![state],
        };
        strips::stands_on(&map, &actor, &state)
    };
    assert_eq!(rollout(-1.65), "road 'main', along the ego's way, lane 1 of 2 from the middle");
    let over = "road 'main', along the ego's way, lane 2 of 2 from the middle, 0.5 m over its right edge into the parking strip";
    assert_eq!(rollout(-6.15), over);
    assert_eq!(
        rollout(-0.4),
        "road 'main', along the ego's way, lane 1 of 2 from the middle, 0.5 m over its left edge into a lane of the other direction"
    );
    assert_eq!(rollout(-8.0), "road 'main', along the ego's way, the parking strip");
    assert_eq!(rollout(20.0), "in the junction, beside the roads or beyond their ends");
}
