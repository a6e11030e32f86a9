//! On a real MetaDrive, where there is one: name its interpreter in `RECRASH_METADRIVE_PYTHON`.

use crate::common::{checked, crossing};
use recrash_metadrive::{Drive, Metadrive, Options, inspect};
use recrash_model::kinds::PartnerKind;
use recrash_model::math::wrap_angle;
use recrash_model::rollout::{EventKind, Role, Rollout, TerminationKind};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::Plan;
use recrash_roads::{Scenario, background_traffic};
use serde_json::json;
use std::sync::OnceLock;
use std::time::Duration;

fn options() -> Option<Options> {
    recrash_testing::named_by("RECRASH_METADRIVE_PYTHON").map(Options::new)
}

/// One pool for all tests: importing MetaDrive is what takes time.
pub fn start() -> Option<&'static Metadrive> {
    static POOL: OnceLock<Metadrive> = OnceLock::new();
    options().map(|options| POOL.get_or_init(|| Metadrive::start(options).unwrap_or_else(|error| panic!("{error}"))))
}

fn ego_contact(rollout: &Rollout) -> Option<f64> {
    rollout.first_ego_contact().map(|(_, time, ..)| time)
}

#[test]
fn a_crossing_at_the_same_time_is_a_contact_and_one_far_apart_is_not() {
    let Some(metadrive) = start() else { return };
    let together = checked(&crossing());
    let mut apart = crossing();
    apart["partners"][0]["start"]["arrival_gap_s"] = json!(-3.0);
    let rollouts: Vec<Rollout> = metadrive
        .simulate_all(&[together, checked(&apart)], &Drive::MetadriveIdm, &|_| {})
        .into_iter()
        .map(|result| result.unwrap_or_else(|error| panic!("{error}")))
        .collect();
    assert_eq!(rollouts[0].termination.kind, TerminationKind::Contact);
    // Both centres would be at the crossing after 65 m at 8 m/s; the boxes touch before.
    let time = ego_contact(&rollouts[0]).expect("a contact");
    assert!(time > 7.0 && time < 8.2, "{time}");
    assert_eq!(rollouts[1].termination.kind, TerminationKind::Arrived);
    assert!(rollouts[1].events.is_empty());
    assert_eq!(rollouts[0].simulator, "MetaDrive 0.4.3");
    let first = rollouts[0].ego_track().states[0];
    assert!((first.x - 5.0).abs() < 1e-3 && first.y.abs() < 1e-3 && (first.speed() - 8.0).abs() < 0.1, "{first:?}");
    assert!(rollouts[0].actors.iter().all(|actor| actor.states.len() == rollouts[0].steps()));
}

#[test]
fn the_same_scenario_gives_the_same_bits_in_any_order_and_on_any_worker() {
    let Some(mut options) = options() else { return };
    options.workers = 2;
    let metadrive = Metadrive::start(options).unwrap_or_else(|error| panic!("{error}"));
    let mut curve = crossing();
    curve["map"] = json!({"type": "C", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "radius_m": 50.0,
                          "angle_deg": 90.0, "direction": "left", "length_m": 40.0});
    curve["partners"][0]["approach"] = json!("same");
    curve["partners"][0]["start"] = json!({"delta_s_m": 15.0});
    let scenarios =
        [checked(&crossing()), checked(&curve), checked(&crossing()), checked(&curve), checked(&crossing())];
    let hashes: Vec<String> = metadrive
        .simulate_all(&scenarios, &Drive::MetadriveIdm, &|_| {})
        .into_iter()
        .map(|result| result.unwrap_or_else(|error| panic!("{error}")).state_hash)
        .collect();
    assert_eq!(hashes[0], hashes[2]);
    assert_eq!(hashes[0], hashes[4]);
    assert_eq!(hashes[1], hashes[3]);
    assert_ne!(hashes[0], hashes[1]);
}

#[test]
fn every_policy_map_and_kind_runs() {
    let Some(metadrive) = start() else { return };
    let policies = [
        json!({"type": "sudden_brake", "target_speed": 6.0, "brake_step": 20, "brake_steps": 10}),
        json!({"type": "accel_then_brake", "accel_mag": 0.4, "accel_steps": 20, "cruise_speed": 7.0, "brake_step": 50,
               "brake_steps": 10, "speed_kp": 0.5}),
        json!({"type": "idm_nominal", "target_speed_mps": 7.0}),
        json!({"type": "yielding", "target_speed_mps": 6.0, "gap_s": 1.5}),
        json!({"type": "stopped", "depart_step": 30, "target_speed_mps": 5.0}),
    ];
    let shared = json!({"lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": 120.0});
    let maps = [
        ("X", json!({}), "left"),
        ("T", json!({"missing": "right"}), "left"),
        ("O", json!({"exit_radius_m": 10.0, "inner_radius_m": 30.0}), "ring"),
    ];
    let kinds = ["passenger_car", "heavy_truck", "cyclist", "pedestrian", "motorcycle"];
    let mut scenarios = Vec::new();
    for (number, policy) in policies.iter().enumerate() {
        for (letter, extra, approach) in &maps {
            let mut draft = crossing();
            draft["id"] = json!(format!("{letter}-{number}"));
            draft["map"] = shared.clone();
            draft["map"]["type"] = json!(letter);
            for (name, value) in extra.as_object().expect("an object") {
                draft["map"][name] = value.clone();
            }
            draft["duration_s"] = json!(12.0);
            let partner = &mut draft["partners"][0];
            partner["approach"] = json!(approach);
            partner["turn"] = json!(if *letter == "T" { "left" } else { "straight" });
            partner["policy"] = policy.clone();
            partner["speed_mps"] = json!(if number == 4 { 0.0 } else { 2.0 });
            partner["start"]["arrival_gap_s"] = json!(-1.0);
            partner["lateral"] = json!([{"start_s": 1.0, "duration_s": 2.0, "to_t_m": 0.5}]);
            if *letter == "X" && number != 3 {
                partner["kind"] = json!(kinds[number]);
                for name in ["target_speed", "cruise_speed", "target_speed_mps"] {
                    if partner["policy"].get(name).is_some() {
                        partner["policy"][name] = json!(3.0);
                    }
                }
                let on_foot = kinds[number] == "pedestrian";
                partner["start"]["arrival_gap_s"] = json!(if on_foot { 0.0 } else { 1.0 });
            }
            draft["obstacles"] = json!([{"kind": "cone", "s_m": 52.0, "t_m": 1.75}]);
            scenarios.push(checked(&draft));
        }
    }
    for (scenario, result) in scenarios.iter().zip(metadrive.simulate_all(&scenarios, &Drive::MetadriveIdm, &|_| {})) {
        let rollout = result.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(rollout.actors.len(), 2);
        let track = &rollout.actors[1];
        let start = scenario.partners()[0].pose.position;
        assert!(track.states[0].position().distance(start) < 0.01, "{}: {start:?}", rollout.scenario_id);
        let wildest = track.states.iter().map(|state| state.speed()).fold(0.0, f64::max);
        assert!(wildest < 9.0, "{}: {wildest} m/s", rollout.scenario_id);
    }
}

#[test]
fn a_start_far_beside_the_lane_stays_there() {
    let Some(metadrive) = start() else { return };
    let mut draft = crossing();
    draft["partners"][0]["approach"] = json!("same");
    draft["partners"][0]["lane_offset"] = json!(-1);
    draft["partners"][0]["start"] = json!({"delta_s_m": 10.0, "delta_t_m": -4.0});
    let rollout = metadrive.simulate(&checked(&draft), &Drive::MetadriveIdm).unwrap_or_else(|error| panic!("{error}"));
    let states = &rollout.actors[1].states;
    assert!((states[0].y - 7.5).abs() < 0.01, "{:?}", states[0]);
    let later = states[30.min(states.len() - 1)];
    assert!((later.y - 7.5).abs() < 0.5 && later.x > 30.0, "it holds its offset: {later:?}");
}

#[test]
fn a_barrier_across_the_lane_is_touched_by_a_blind_ego() {
    let Some(metadrive) = start() else { return };
    let mut draft = crossing();
    draft["partners"] = json!([]);
    draft["obstacles"] = json!([{"kind": "barrier", "s_m": 30.0, "t_m": 1.0}]);
    draft["duration_s"] = json!(5.0);
    let drive = Drive::OpenLoop(vec![[0.0, 0.1]; 40]);
    let rollout = metadrive.simulate(&checked(&draft), &drive).unwrap_or_else(|error| panic!("{error}"));
    let event = rollout.events.first().expect("a contact");
    let EventKind::ObstacleContact { actor: 0, obstacle: 0, state } = event.kind else { panic!("{event:?}") };
    // The car's front reaches the barrier's near side when its centre is 2.2575 + 0.15 m before it.
    assert!((state.x - (30.0 - 2.4075)).abs() < 0.25, "{state:?}");
    assert_eq!(rollout.ego, "open-loop");
}

/// The same question is asked of the native simulator: `crates/sim/tests/suite/partners.rs`.
#[test]
fn a_partner_stops_before_a_cone_and_a_barrier_on_its_line_and_passes_one_beside_it() {
    let Some(metadrive) = start() else { return };
    let cases = [("cone", 0.0, true), ("barrier", 0.3, true), ("cone", -1.7, false)];
    let scenarios = cases.map(|(kind, t_m, _)| {
        let mut draft = crossing();
        draft["ego"] = json!({"turn": "straight", "lane": 1, "s_m": 5.0, "speed_mps": 0.0, "target_speed_mps": 1.0});
        draft["map"]["approach_m"] = json!(200.0);
        draft["partners"][0]["approach"] = json!("same");
        draft["partners"][0]["start"] = json!({"delta_s_m": 30.0});
        draft["obstacles"] = json!([{"kind": kind, "s_m": 120.0, "t_m": t_m}]);
        checked(&draft)
    });
    let runs = metadrive.simulate_all(&scenarios, &Drive::OpenLoop(vec![[0.0, -1.0]; 200]), &|_| {});
    for ((kind, t_m, stops), run) in cases.into_iter().zip(runs) {
        let rollout = run.unwrap_or_else(|error| panic!("{error}"));
        let touched = rollout.events.iter().any(|e| matches!(e.kind, EventKind::ObstacleContact { actor: 1, .. }));
        let last = rollout.actors[1].states.last().expect("states");
        assert!(!touched, "{kind} at {t_m}: {:?}", rollout.events);
        assert_eq!(last.speed() < 0.3 && last.x < 120.0, stops, "{kind} at {t_m}: {last:?}");
    }
}

#[test]
fn background_traffic_starts_where_it_is_placed_and_drives_when_the_ego_comes() {
    let Some(metadrive) = start() else { return };
    let mut draft = crossing();
    draft["map"]["arm_m"] = json!(40.0);
    draft["partners"] = json!([]);
    draft["traffic"] = json!({"density": 0.4, "seed": 1});
    draft["duration_s"] = json!(14.0);
    let scenario = checked(&draft);
    let placed = background_traffic(&scenario);
    assert!(placed.len() > 3, "{}", placed.len());
    let rollout = metadrive.simulate(&scenario, &Drive::MetadriveIdm).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(rollout.actors.len(), 1 + placed.len());
    let mut gone = 0;
    for (track, placement) in rollout.actors[1..].iter().zip(&placed) {
        assert_eq!((track.role, track.kind), (Role::Traffic, placement.kind));
        assert!(track.states[0].position().distance(placement.pose.position) < 0.01, "{}", track.id);
        // The entrance is 10 m long and the ego begins at 5 m with 8 m/s.
        assert!(track.states[5].speed() < 0.1, "{} moves at {} m/s", track.id, track.states[5].speed());
        assert!(track.states.windows(2).all(|pair| pair[0].position().distance(pair[1].position()) < 1.2));
        gone += usize::from(track.states[track.states.len() - 1].x < -3.0);
    }
    let fastest = rollout.actors[1..].iter().flat_map(|track| &track.states).map(|state| state.speed());
    assert!(fastest.fold(0.0, f64::max) > 5.0);
    assert!(rollout.termination.kind == TerminationKind::Contact || gone > 0, "{gone} have left the map");
}

#[test]
fn every_kind_of_road_user_drives_walks_or_stands() {
    let Some(metadrive) = start() else { return };
    for kind in PartnerKind::ALL {
        let mut draft = crossing();
        let fixed = kind == PartnerKind::FixedObject;
        let speed = if fixed { 0.0 } else { 2.0 };
        draft["duration_s"] = json!(3.0);
        draft["partners"][0]["kind"] = serde_json::to_value(kind).expect("a word");
        draft["partners"][0]["approach"] = json!("same");
        draft["partners"][0]["start"] = json!({"delta_s_m": 45.0});
        draft["partners"][0]["speed_mps"] = json!(speed);
        draft["partners"][0]["policy"] = if fixed {
            json!({"type": "stopped"})
        } else {
            json!({"type": "sudden_brake", "target_speed": 2.0, "brake_step": 20, "brake_steps": 100})
        };
        let rollout = metadrive
            .simulate(&checked(&draft), &Drive::MetadriveIdm)
            .unwrap_or_else(|error| panic!("{kind:?}: {error}"));
        let states = &rollout.actors[1].states;
        let (first, last) = (states[0], states[states.len() - 1]);
        // Two seconds at 2 m/s, then a stop of about a metre; below 0.5 m/s the brake is light.
        let way = last.x - first.x;
        let wanted = if fixed { -0.1..0.1 } else { 3.7..5.2 };
        assert!(wanted.contains(&way), "{kind:?} went {way} m");
        assert!((last.y - first.y).abs() < 0.1 && last.speed() < 0.5, "{kind:?}: {last:?}");
    }
}

/// As `crates/sim/tests/suite/behaviour.rs` says of ours: until the kick at the next road, or until rounding alone ends it.
#[test]
fn at_exactly_the_speed_it_wants_the_ego_rolls_on_as_ours_does() {
    let Some(metadrive) = start() else { return };
    for speed in [1.0, 2.0, 8.0] {
        let mut draft = crossing();
        draft["partners"] = json!([]);
        draft["duration_s"] = json!(6.0);
        (draft["ego"]["speed_mps"], draft["ego"]["target_speed_mps"]) = (json!(speed), json!(speed));
        let rollout = metadrive.simulate(&checked(&draft), &Drive::MetadriveIdm).unwrap();
        let before_the_kick = ((4.0 / speed / 0.1) as usize).min(13);
        let speeds: Vec<f64> = rollout.ego_track().states.iter().map(|state| state.speed()).collect();
        assert!(speeds[..before_the_kick].iter().all(|now| (now - speed).abs() < 1e-4), "{speed}: {speeds:?}");
    }
}

#[test]
fn every_kind_holds_its_line_after_a_sideways_move_and_brakes_no_harder_than_planned() {
    let Some(metadrive) = start() else { return };
    let moving = PartnerKind::ALL.into_iter().filter(|kind| *kind != PartnerKind::FixedObject);
    let cases: Vec<(PartnerKind, f64)> = moving
        .flat_map(|kind| {
            let fastest = VehicleSpec::of(kind).max_speed_mps.min(22.2);
            [0.3, 0.65, 1.0].map(|share| (kind, (share * fastest * 100.0).floor() / 100.0))
        })
        .collect();
    // To the right and to the left by turns, so that every kind goes both ways.
    let to_t_m = |number: usize| if number.is_multiple_of(2) { 1.0 } else { -1.0 };
    let scenarios: Vec<Scenario> = cases
        .iter()
        .enumerate()
        .map(|(number, (kind, speed))| {
            let mut draft = crossing();
            draft["map"] = json!({"type": "S", "lanes": 3, "lane_width_m": 3.5, "approach_m": 60.0, "length_m": 400.0});
            draft["duration_s"] = json!(15.5);
            draft["ego"] =
                json!({"turn": "straight", "lane": 1, "s_m": 5.0, "speed_mps": 1.0, "target_speed_mps": 1.0});
            let partner = &mut draft["partners"][0];
            partner["kind"] = serde_json::to_value(kind).expect("a word");
            partner["approach"] = json!("same");
            partner["start"] = json!({"delta_s_m": 20.0});
            partner["speed_mps"] = json!(speed);
            partner["policy"] =
                json!({"type": "sudden_brake", "target_speed": speed, "brake_step": 0, "brake_steps": 0});
            partner["lateral"] = json!([{"start_s": 1.0, "duration_s": 1.5, "to_t_m": to_t_m(number)}]);
            checked(&draft)
        })
        .collect();
    let mut bad = Vec::new();
    let rollouts = metadrive.simulate_all(&scenarios, &Drive::MetadriveIdm, &|_| {});
    for (number, ((kind, speed), rollout)) in cases.iter().zip(rollouts).enumerate() {
        let rollout = rollout.unwrap_or_else(|error| panic!("{kind:?}: {error}"));
        let states = &rollout.actors[1].states;
        let late = states.iter().skip(145);
        let wanted_y = states[0].y - to_t_m(number);
        let off_m = late.clone().map(|state| (state.y - wanted_y).abs()).fold(0.0, f64::max);
        let off_deg = late.map(|state| state.heading.to_degrees().abs()).fold(0.0, f64::max);
        let hardest = states.windows(2).map(|pair| (pair[0].speed() - pair[1].speed()) / 0.1).fold(0.0, f64::max);
        if states.len() < 150 || off_m > 0.05 || off_deg > 0.3 || hardest > 2.5 {
            bad.push(format!("{kind:?} {speed}: {off_m:.3} m, {off_deg:.3} deg, {hardest:.1} m/s^2"));
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn every_kind_holds_its_line_behind_a_bend_and_behind_a_turn_and_brakes_no_harder_than_planned() {
    let Some(metadrive) = start() else { return };
    let moving = PartnerKind::ALL.into_iter().filter(|kind| *kind != PartnerKind::FixedObject);
    let cases: Vec<(PartnerKind, f64, &str)> = moving
        .enumerate()
        .map(|(number, kind)| {
            let speed = (VehicleSpec::of(kind).max_speed_mps.min(10.0) * 100.0).floor() / 100.0;
            (kind, speed, ["left", "right", "turn"][number % 3])
        })
        .collect();
    let scenarios: Vec<Scenario> = cases
        .iter()
        .map(|(kind, speed, way)| {
            let length_m = (speed * 13.5).max(30.0);
            let mut draft = crossing();
            draft["map"] = match *way {
                "turn" => json!({"type": "X", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "arm_m": length_m}),
                direction => json!({"type": "C", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "radius_m": 50.0,
                                    "angle_deg": 45.0, "direction": direction, "length_m": length_m}),
            };
            draft["duration_s"] = json!(60.0);
            draft["ego"] =
                json!({"turn": "straight", "lane": 0, "s_m": 5.0, "speed_mps": 1.0, "target_speed_mps": 1.0});
            let partner = &mut draft["partners"][0];
            partner["kind"] = serde_json::to_value(kind).expect("a word");
            partner["approach"] = json!("same");
            partner["turn"] = json!(if *way == "turn" { "right" } else { "straight" });
            partner["lane_offset"] = json!(1);
            partner["start"] = json!({"delta_s_m": 40.0});
            partner["speed_mps"] = json!(speed);
            partner["policy"] =
                json!({"type": "sudden_brake", "target_speed": speed, "brake_step": 0, "brake_steps": 0});
            checked(&draft)
        })
        .collect();
    let mut bad = Vec::new();
    let rollouts = metadrive.simulate_all(&scenarios, &Drive::MetadriveIdm, &|_| {});
    for ((scenario, (kind, speed, way)), rollout) in scenarios.iter().zip(&cases).zip(rollouts) {
        let states = &rollout.unwrap_or_else(|error| panic!("{kind:?}: {error}")).actors[1].states;
        let path = &scenario.partners()[0].path;
        let bend_m = path.segments.last().map_or(0.0, |segment| segment.start_m);
        let behind =
            states.iter().position(|state| path.project(state.position(), 0).s > bend_m).unwrap_or(states.len());
        let late: Vec<_> = states.iter().skip(behind + 120).collect();
        let (mut off_m, mut off_deg) = (0.0_f64, 0.0_f64);
        for state in &late {
            let place = path.project(state.position(), 0);
            if place.s < path.length_m {
                let off = wrap_angle(state.heading - path.pose(place.s, 0.0).heading);
                (off_m, off_deg) = (off_m.max(place.t.abs()), off_deg.max(off.to_degrees().abs()));
            }
        }
        let plan = Plan::new(*kind, &scenario.draft().partners[0].policy, 0.0, Surface::Dry);
        let hardest = states.windows(2).map(|pair| (pair[0].speed() - pair[1].speed()) / 0.1).fold(0.0, f64::max);
        if late.is_empty() || off_m > 0.05 || off_deg > 0.3 || hardest > plan.greatest_braking_mps2 + 0.1 {
            let seen = late.len();
            bad.push(format!(
                "{kind:?} {speed} {way}: {off_m:.3} m, {off_deg:.3} deg in {seen} states, {hardest:.1} m/s^2"
            ));
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// A run of two minutes whose worker is killed while it is at it.
#[cfg(unix)]
#[test]
fn a_worker_killed_during_a_run_is_replaced_and_the_result_is_the_same() {
    use std::os::unix::fs::PermissionsExt;
    let Some(options) = options() else { return };
    let mut draft = crossing();
    draft["map"] = json!({"type": "S", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "length_m": 600.0});
    draft["ego"]["speed_mps"] = json!(5.0);
    draft["ego"]["target_speed_mps"] = json!(5.0);
    draft["partners"] = json!([]);
    draft["duration_s"] = json!(120.0);
    let scenario = checked(&draft);

    // In place of Python: notes its process and becomes Python.
    let folder = tempfile::tempdir().expect("a folder");
    let (aside, wrapper, pids) =
        (folder.path().join("aside"), folder.path().join("python"), folder.path().join("pids"));
    let text = format!("#!/bin/sh\necho $$ >> '{}'\nexec '{}' \"$@\"\n", pids.display(), options.python.display());
    std::fs::write(&aside, text).expect("a writable folder");
    std::fs::set_permissions(&aside, std::fs::Permissions::from_mode(0o755)).expect("its owner's");
    std::fs::rename(&aside, &wrapper).expect("the same folder");
    let metadrive = Metadrive::start(Options::new(wrapper)).unwrap_or_else(|error| panic!("{error}"));
    let workers = || std::fs::read_to_string(&pids).expect("a worker has started");
    let first = workers().trim().to_owned();
    let killed = std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(300));
            let status = std::process::Command::new("kill").args(["-9", &first]).status().expect("a shell has kill");
            assert!(status.success(), "the worker had ended already");
        });
        metadrive.simulate(&scenario, &Drive::MetadriveIdm).unwrap_or_else(|error| panic!("{error}"))
    });
    assert_eq!(workers().lines().count(), 2, "a second worker was started");
    let again = metadrive.simulate(&scenario, &Drive::MetadriveIdm).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(killed.state_hash, again.state_hash);
    assert_eq!(workers().lines().count(), 2);
}

#[test]
fn the_doctor_tells_both_versions() {
    let Some(options) = options() else { return };
    let found = inspect(&options.python, Duration::from_secs(120));
    assert_eq!(found.metadrive.as_deref(), Some("0.4.3"));
    assert!(found.to_string().ends_with(", ready"), "{found}");
}
