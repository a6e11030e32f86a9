//! Road users with a plan: what they do is what the formulas say, to the centimetre.

use crate::common::{alone, checked, straight};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{EventKind, Role, Rollout, TerminationKind};
use recrash_model::scenario::{
    Act, Actor, ActorPlan, Aspect, Control, Deed, Device, Doing, Leg, MissionStop, Part, PartKind, Phase, Place,
    ScenarioDraft, Size, Trigger, Turn,
};
use recrash_sim::{Ego, Run, Seat, simulate};

/// A road of 300 m for a while; nothing happens on it but what plans ask for.
fn scene() -> ScenarioDraft {
    let mut draft = alone(straight(2, 300.0), Turn::Straight, 0, 0.0, 5.0);
    draft.duration_s = 30.0;
    // The ego stands out of the way.
    draft.ego.recorded = Some(ActorPlan::standing(Place::at(5.0, 3.5, 0.0)));
    draft
}

fn act(deed: Deed) -> Act {
    Act { id: None, when: None, delay_s: 0.0, deed }
}

fn when(trigger: Trigger, deed: Deed) -> Act {
    Act { when: Some(trigger), ..act(deed) }
}

fn straight_on(to_x: f64, y: f64) -> Leg {
    Leg::Curve { to: Place::at(to_x, y, 0.0), reverse: false }
}

fn actor(id: &str, x: f64, y: f64, speed_mps: f64, course: Vec<Leg>, acts: Vec<Act>) -> Actor {
    Actor {
        id: id.to_owned(),
        kind: PartnerKind::PassengerCar,
        size: None,
        mass_kg: None,
        parts: Vec::new(),
        plan: ActorPlan { speed_mps, course, acts, ..ActorPlan::standing(Place::at(x, y, 0.0)) },
    }
}

fn recorded(draft: ScenarioDraft) -> Rollout {
    simulate(&checked(draft), Ego::Recorded)
}

fn track<'a>(rollout: &'a Rollout, id: &str) -> &'a recrash_model::rollout::ActorTrack {
    rollout.actors.iter().find(|track| track.id == id).expect("somebody of this name")
}

#[test]
fn an_ego_is_touched_where_its_own_size_ends() {
    let mut draft = scene();
    draft.ego.kind = PartnerKind::HeavyTruck;
    draft.ego.size = Some(Size { length_m: 16.0, width_m: 2.6 });
    draft.ego.recorded = Some(ActorPlan::standing(Place::at(100.0, 0.0, 0.0)));
    draft.actors.push(actor("cp", 40.0, 0.0, 10.0, vec![straight_on(290.0, 0.0)], Vec::new()));
    let rollout = recorded(draft);
    assert_eq!((rollout.actors[0].length_m, rollout.actors[0].width_m), (16.0, 2.6));
    let touched = rollout.events.iter().find(|event| matches!(event.kind, EventKind::Contact { .. }));
    let front = 40.0 + 0.5 * track(&rollout, "cp").length_m;
    let due_s = (92.0 - front) / 10.0;
    assert!(touched.is_some_and(|event| (event.time_s - due_s).abs() < 0.03), "{:?}", rollout.events);
}

#[test]
fn who_stands_stands_exactly() {
    let mut draft = scene();
    let acts = vec![
        when(Trigger::TimeS(1.0), Deed::Stop { rate_mps2: 3.0, at_m: None }),
        act(Deed::Hold { for_s: Some(5.0) }),
        act(Deed::Speed { to_mps: 4.0, rate_mps2: 1.0 }),
    ];
    draft.actors.push(actor("cp", 20.0, 0.0, 6.0, vec![straight_on(250.0, 0.0)], acts));
    let rollout = recorded(draft);
    let states = &track(&rollout, "cp").states;
    // 6 m in the first second, 6^2 / 6 = 6 m of braking: exactly 12 m, from 3.0 s to 8.0 s.
    for state in &states[30..=80] {
        assert!((state.x - 32.0).abs() < 1e-9, "{}", state.x);
        assert_eq!((state.x, state.y), (states[30].x, states[30].y));
        assert_eq!((state.vx, state.vy), (0.0, 0.0));
    }
    // Then 4 m/s after 4 s.
    assert!((states[100].vx - 2.0).abs() < 1e-9 && (states[125].vx - 4.0).abs() < 1e-9);
    assert!((states[100].x - 34.0).abs() < 1e-9);
    assert!(rollout.actors[0].states.iter().all(|state| (state.x, state.y, state.vx) == (5.0, 3.5, 0.0)));
}

#[test]
fn a_stop_at_a_place_is_there_to_the_millimetre() {
    let mut draft = scene();
    let acts = vec![act(Deed::Stop { rate_mps2: 2.5, at_m: Some(60.0) })];
    draft.actors.push(actor("cp", 20.0, 0.0, 9.7, vec![straight_on(250.0, 0.0)], acts));
    let rollout = recorded(draft);
    let states = &track(&rollout, "cp").states;
    let last = states.last().unwrap();
    assert!((last.x - 80.0).abs() < 1e-3 && last.vx == 0.0, "{last:?}");
    let hardest = states.windows(2).map(|pair| (pair[0].vx - pair[1].vx) / 0.1).fold(0.0, f64::max);
    assert!(hardest <= 2.5 + 1e-9 && hardest > 2.3, "{hardest}");
}

#[test]
fn reverse_gear_follows_the_way_it_came_by() {
    let there = Leg::Curve { to: Place::at(34.0, 3.0, 40.0), reverse: false };
    let back = Leg::Curve { to: Place::at(20.0, -3.0, 0.0), reverse: true };
    let mut draft = scene();
    draft.actors.push(actor("cp", 20.0, -3.0, 3.0, vec![there, back], Vec::new()));
    let rollout = recorded(draft);
    let states = &track(&rollout, "cp").states;
    let turns = states.iter().position(|state| state.speed() < 0.0).expect("it goes back");
    let last = states.last().unwrap();
    assert!((last.x - 20.0).abs() < 0.03 && (last.y + 3.0).abs() < 0.03, "{last:?}");
    assert!(math::wrap_angle(last.heading).abs() < 1e-3);
    // Every place on the way back lies on the line that it drove there.
    let line: Vec<Vec2> = states[..turns].iter().map(recrash_model::rollout::ActorState::position).collect();
    for state in &states[turns..] {
        let beside = line
            .windows(2)
            .map(|pair| {
                let way = pair[1] - pair[0];
                let share = ((state.position() - pair[0]).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
                state.position().distance(pair[0] + way * share)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(beside < 0.01, "{beside} beside at {state:?}");
    }
}

/// Where the gear changes the line goes back the other way; who stops there to the millimetre still faces as it came.
#[test]
fn who_stops_where_its_gear_changes_faces_as_it_did() {
    for (facing_deg, ahead) in [(0.0, 1.0), (180.0, -1.0)] {
        for steps in 0..60_u8 {
            let there_m = 9.0 + 0.173 * f64::from(steps);
            let place = |along_m: f64| Place::at(60.0 + ahead * along_m, 0.0, facing_deg);
            let leg = |along_m: f64, reverse: bool| Leg::Curve { to: place(along_m), reverse };
            let stop = Deed::Stop { rate_mps2: 1.7, at_m: Some(there_m) };
            let acts =
                vec![act(stop), act(Deed::Hold { for_s: Some(1.0) }), act(Deed::Speed { to_mps: 2.0, rate_mps2: 1.0 })];
            let mut draft = scene();
            draft.actors.push(actor(
                "cp",
                60.0,
                0.0,
                4.0,
                vec![leg(there_m, false), leg(2.0, true), leg(20.0, false)],
                acts,
            ));
            draft.actors[0].plan.start = place(0.0);
            let rollout = recorded(draft);
            let states = &track(&rollout, "cp").states;
            let turned =
                states.iter().position(|state| math::wrap_angle(state.heading - states[0].heading).abs() > 1e-6);
            assert_eq!(turned, None, "{there_m} m at {facing_deg} degrees");
            assert!((states.last().unwrap().x - (60.0 + 20.0 * ahead)).abs() < 0.05, "{there_m}: {:?}", states.last());
        }
    }
}

#[test]
fn a_follower_with_a_reaction_time_stops_where_the_formula_says() {
    for (speed, reaction, braking) in [(8.0, 0.7, 4.0), (13.0, 1.3, 5.5), (5.0, 2.0, 3.0)] {
        let mut draft = scene();
        let brake = vec![when(Trigger::TimeS(2.0), Deed::Stop { rate_mps2: 7.0, at_m: None })];
        draft.actors.push(actor("lead", 90.0, 0.0, speed, vec![straight_on(290.0, 0.0)], brake));
        let react = Act {
            delay_s: reaction,
            ..when(
                Trigger::Actor { actor: "lead".to_owned(), is: Doing::Braking },
                Deed::Stop { rate_mps2: braking, at_m: None },
            )
        };
        draft.actors.push(actor("cp", 20.0, 0.0, speed, vec![straight_on(290.0, 0.0)], vec![react]));
        let rollout = recorded(draft);
        let last = track(&rollout, "cp").states.last().unwrap();
        let formula = 20.0 + speed * (2.0 + reaction) + speed * speed / (2.0 * braking);
        assert!((last.x - formula).abs() < 0.02, "{} {formula}", last.x);
    }
}

#[test]
fn a_lane_change_ends_where_it_should_and_steers_smoothly() {
    let mut draft = scene();
    let acts = vec![when(Trigger::AtM(30.0), Deed::Shift { to_t_m: -3.5, over_m: 40.0 })];
    draft.actors.push(actor("cp", 20.0, 0.0, 10.0, vec![straight_on(280.0, 0.0)], acts));
    let rollout = recorded(draft);
    let states = &track(&rollout, "cp").states;
    let last = states.last().unwrap();
    assert!((last.y - 3.5).abs() < 1e-9 && last.heading.abs() < 1e-9);
    for pair in states.windows(2) {
        assert!((pair[1].heading - pair[0].heading).abs() < 0.05, "{pair:?}");
        // What is said of the speed is what the places say.
        let moved = (pair[1].position() - pair[0].position()).length() / 0.1;
        assert!((moved - pair[0].velocity().length()).abs() < 0.25, "{moved} {pair:?}");
    }
}

#[test]
fn a_queue_that_is_pushed_from_behind_reaches_the_ego() {
    let mut draft = scene();
    draft.ego.recorded = Some(ActorPlan::standing(Place::at(60.0, 0.0, 0.0)));
    draft.actors.push(actor("between", 54.5, 0.0, 0.0, Vec::new(), Vec::new()));
    draft.actors.push(actor("cp", 10.0, 0.0, 12.0, vec![straight_on(200.0, 0.0)], Vec::new()));
    let rollout = recorded(draft);
    let contacts: Vec<(usize, usize)> = rollout
        .events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Contact { a, b, .. } => Some((a, b)),
            EventKind::ObstacleContact { .. } | EventKind::Gone { .. } => None,
        })
        .collect();
    assert_eq!(contacts, [(1, 2), (0, 1)]);
    assert_eq!(rollout.termination.kind, TerminationKind::Contact);
    let (_, _, ego, other) = rollout.first_ego_contact().unwrap();
    assert_eq!(ego.vx, 0.0);
    // Equal masses and a restitution of 0.1: 6.6 m/s, less what half a metre of sliding takes.
    assert!(other.vx > 5.5 && other.vx < 6.6, "{}", other.vx);
}

/// A cone of this mass in the way of a car that holds 10 m/s. [kg]
fn cone_in_the_way(mass_kg: Option<f64>) -> Rollout {
    let mut draft = scene();
    let cone = actor("cone", 60.0, 0.0, 0.0, Vec::new(), Vec::new());
    let size = Some(Size { length_m: 0.4, width_m: 0.4 });
    draft.actors.push(Actor { kind: PartnerKind::FixedObject, size, mass_kg, ..cone });
    draft.actors.push(actor("car", 10.0, 0.0, 10.0, vec![straight_on(250.0, 0.0)], Vec::new()));
    draft.duration_s = 15.0;
    recorded(draft)
}

#[test]
fn a_blow_from_behind_passes_on_the_same_wherever_the_physics_step_catches_it() {
    // 25 cm of overlap at 15 m/s: in one physics step the car goes 30 cm farther in.
    let after = |x: f64| {
        let mut draft = scene();
        draft.after_contact_s = 1.0;
        draft.ego.recorded = Some(ActorPlan::standing(Place::at(60.0, 0.0, 0.0)));
        draft.actors.push(actor("cp", x, 1.852 - 0.25, 15.0, vec![straight_on(250.0, 1.852 - 0.25)], Vec::new()));
        let rollout = recorded(draft);
        let step = (rollout.first_ego_contact().expect("they touch").1 * 10.0).ceil() as usize;
        (rollout.actors[0].states[step].speed(), rollout.actors[1].states[step].speed())
    };
    let (ego, cp) = after(8.0);
    assert!(ego > 4.0 && cp < 10.0, "{ego} {cp}");
    for number in 1..7 {
        let (other_ego, other_cp) = after(8.0 + 0.05 * f64::from(number));
        assert!((other_ego - ego).abs() < 0.5 && (other_cp - cp).abs() < 0.5, "{number}: {other_ego} {other_cp}");
    }
}

#[test]
fn a_cone_is_pushed_aside_and_the_car_goes_on() {
    let rollout = cone_in_the_way(Some(4.5));
    let (car, cone) = (track(&rollout, "car"), track(&rollout, "cone"));
    let last = |track: &recrash_model::rollout::ActorTrack| *track.states.last().unwrap();
    assert_eq!(last(car).vx, 10.0);
    // With a restitution of 0.1 it flies off at 1.1 m / (1 + 4.5 / 1500) of the car's speed, and slides for v^2 / 2a.
    let v = 11.0 / (1.0 + 4.5 / 1500.0);
    assert!((last(cone).x - 60.0 - v * v / 7.0).abs() < 0.02, "{}", last(cone).x);
    assert_eq!((last(cone).vx, last(cone).vy), (0.0, 0.0));
    assert_eq!(cone.mass_kg(), Some(4.5));
}

#[test]
fn a_bollard_stands_firm_and_so_does_who_hits_it() {
    let rollout = cone_in_the_way(None);
    let (car, bollard) = (track(&rollout, "car"), track(&rollout, "cone"));
    assert!((bollard.states.last().unwrap().x - 60.0).abs() < 0.02);
    assert_eq!(car.states.last().unwrap().vx, 0.0);
    assert_eq!(bollard.mass_kg(), None);
}

#[test]
fn a_door_opens_into_who_passes() {
    let mut draft = scene();
    let door = Part {
        id: "door".to_owned(),
        kind: PartKind::Door,
        x_m: 0.6,
        y_m: 0.92,
        length_m: 1.0,
        width_m: 0.08,
        axle_m: None,
    };
    let open = Deed::Part { part: "door".to_owned(), to_deg: 70.0, over_s: 1.0 };
    let mut parked = actor("parked", 60.0, -2.6, 0.0, Vec::new(), vec![when(Trigger::TimeS(4.0), open)]);
    parked.parts.push(door);
    draft.actors.push(parked);
    draft.ego.recorded = Some(ActorPlan {
        speed_mps: 8.0,
        course: vec![straight_on(250.0, -0.3)],
        ..ActorPlan::standing(Place::at(20.0, -0.3, 0.0))
    });
    let rollout = recorded(draft.clone());
    assert_eq!(rollout.termination.kind, TerminationKind::Contact);
    assert_eq!(track(&rollout, "parked.door").role, Role::Part);
    assert_eq!(track(&rollout, "parked.door").part_of, Some(1));
    draft.actors[0].plan.acts.clear();
    assert_eq!(recorded(draft).termination.kind, TerminationKind::Timeout, "shut, it is passed");
}

#[test]
fn a_rider_opens_the_door_whoever_drives() {
    for ego in Ego::DRIVERS {
        let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 8.0, 8.0);
        draft.duration_s = 30.0;
        draft.ego.stops = vec![MissionStop { s_m: 80.0, t_m: 0.0, for_s: Some(20.0) }];
        draft.ego.parts.push(Part {
            id: "door".to_owned(),
            kind: PartKind::Door,
            x_m: -0.3,
            y_m: 0.93,
            length_m: 1.0,
            width_m: 0.08,
            axle_m: None,
        });
        let open = Deed::Part { part: "door".to_owned(), to_deg: 70.0, over_s: 1.0 };
        let stop = Deed::Stop { rate_mps2: 2.0, at_m: Some(60.0) };
        draft.ego.recorded = Some(ActorPlan {
            speed_mps: 8.0,
            course: vec![straight_on(350.0, 0.0)],
            acts: vec![act(stop), Act { delay_s: 2.0, ..act(open) }],
            ..ActorPlan::standing(Place::at(20.0, 0.0, 0.0))
        });
        draft.ego.handover_s = Some(1.0);
        let rollout = simulate(&checked(draft), ego);
        let (car, door) = (&rollout.actors[0].states, &track(&rollout, "ego.door").states);
        let open = |step: usize| math::wrap_angle(door[step].heading - car[step].heading - math::PI).abs() > 1.0;
        let opened = (0..car.len()).find(|step| open(*step)).expect("the door opens");
        let stood = (0..car.len()).find(|step| car[*step].speed() < 0.1).expect("it stops");
        assert!((20..45).contains(&(opened - stood)), "{ego}: {stood} {opened}");
    }
}

#[test]
fn who_waits_for_its_own_touch_drives_on_and_may_touch_again() {
    let mut draft = scene();
    draft.after_contact_s = 20.0;
    draft.ego.recorded = Some(ActorPlan::standing(Place::at(60.0, 0.0, 0.0)));
    let leg = |x: f64, reverse: bool| Leg::Curve { to: Place::at(x, 0.0, 0.0), reverse };
    // Bumper to bumper is 4.515 m.
    let course = vec![leg(64.48, true), leg(66.0, false), leg(64.46, true)];
    let acts = vec![
        act(Deed::Speed { to_mps: 0.8, rate_mps2: 1.0 }),
        when(Trigger::Actor { actor: "cp".to_owned(), is: Doing::Hit }, Deed::Hold { for_s: Some(0.5) }),
        act(Deed::Speed { to_mps: 0.8, rate_mps2: 1.0 }),
    ];
    draft.actors.push(actor("cp", 67.0, 0.0, 0.0, course, acts));
    let contacts = |draft: ScenarioDraft| {
        let rollout = recorded(draft);
        rollout.events.iter().filter(|event| matches!(event.kind, EventKind::Contact { .. })).count()
    };
    assert_eq!(contacts(draft.clone()), 2);
    draft.actors[0].plan.acts.truncate(1);
    assert_eq!(contacts(draft), 1, "who waits for nothing is left to momentum");
}

#[test]
fn who_pulls_out_of_the_kerb_goes_on_in_the_lane_beside_it() {
    let lanes = serde_json::json!([{ "kind": "driving" }, { "kind": "driving" }, { "kind": "parking" }]);
    let draft = serde_json::from_value(serde_json::json!({
        "format": "recrash.scenario/2", "id": "kerb", "source": {}, "duration_s": 10,
        "map": { "type": "G", "roads": [{
            "id": "main", "start": { "at": { "x_m": 0, "y_m": 0, "heading_deg": 0 } },
            "line": [{ "straight": { "length_m": 100 } }], "right": lanes }] },
        "ego": { "route": ["main+"], "target_speed_mps": 8, "recorded": { "start": { "road": "main+", "s_m": 90 } } },
        "actors": [{ "id": "cp", "plan": {
            "start": { "road": "main+.parking", "s_m": 10 }, "course": [{ "lanes": { "roads": ["main+"] } }],
            "acts": [{ "do": { "speed": { "to_mps": 5, "rate_mps2": 2 } } }, { "do": { "shift": { "to_t_m": 0, "over_m": 20 } } }] } }]
    }));
    let rollout = recorded(draft.unwrap());
    let states = &track(&rollout, "cp").states;
    // Two lanes of 3.3 m and half of the 2.4 m for parking; then the middle of the second lane.
    assert!((states[0].y + 7.8).abs() < 1e-9 && (states.last().unwrap().y + 4.95).abs() < 1e-9, "{:?}", states.last());
}

#[test]
fn a_driveway_is_no_place_off_the_road() {
    let ends = |driveways: serde_json::Value| {
        let draft = serde_json::from_value(serde_json::json!({
            "format": "recrash.scenario/2", "id": "driveway", "source": {}, "duration_s": 1,
            "map": { "type": "G", "roads": [{
                "id": "main", "start": { "at": { "x_m": 0, "y_m": 0, "heading_deg": 0 } },
                "line": [{ "straight": { "length_m": 100 } }], "right": [{ "kind": "driving" }], "driveways": driveways }] },
            "ego": { "route": ["main+"], "target_speed_mps": 2,
                "recorded": { "start": { "x_m": 50, "y_m": -10, "heading_deg": 90 } } }
        }));
        simulate(&checked(draft.unwrap()), Ego::Idm).termination.kind
    };
    let driveway = serde_json::json!([{ "side": "right", "s_m": 50, "width_m": 6, "depth_m": 12 }]);
    assert_eq!(ends(driveway), TerminationKind::Timeout);
    assert_eq!(ends(serde_json::json!([])), TerminationKind::OffRoad);
}

#[test]
fn who_drives_beside_a_bend_keeps_its_speed_over_ground() {
    // 3 m to the right of its course, and to the left of it: 23 m and 17 m from the middle of a bend of 20 m.
    for to_t_m in [3.0, -3.0] {
        let mut draft = scene();
        let turn = Leg::Curve { to: Place::at(80.0, 10.0, 90.0), reverse: false };
        let on = Leg::Curve { to: Place::at(80.0, 60.0, 90.0), reverse: false };
        let stop = when(Trigger::AtM(40.0), Deed::Stop { rate_mps2: 2.0, at_m: Some(60.0) });
        let acts = vec![when(Trigger::TimeS(0.0), Deed::Shift { to_t_m, over_m: 20.0 }), stop];
        draft.actors.push(actor("cp", 20.0, -10.0, 8.0, vec![straight_on(60.0, -10.0), turn, on], acts));
        let rollout = recorded(draft);
        let states = &track(&rollout, "cp").states;
        let stood = states.iter().position(|state| state.speed() == 0.0).expect("it stops in the bend");
        // Until it brakes it has come 41 m in the first place; its centre swings 1.4 m ahead of an axle that turns.
        for state in &states[26..50] {
            assert!((state.velocity().length() - 8.0).abs() < 0.04, "{to_t_m}: {state:?}");
        }
        let driven_m: f64 = states.windows(2).map(|pair| pair[0].position().distance(pair[1].position())).sum();
        assert!(stood > 50 && driven_m > 55.0, "{stood} {driven_m}");
        for pair in states[26..=stood].windows(2) {
            assert!((pair[1].speed() - pair[0].speed()).abs() < 0.25, "{to_t_m}: {pair:?}");
        }
        let middle = Vec2::new(60.0, 10.0);
        let rear = states[stood].position() - Vec2::from_heading(states[stood].heading) * 1.4;
        assert!((rear.distance(middle) - (20.0 + to_t_m)).abs() < 0.3, "{rear:?}");
    }
}

#[test]
fn a_trailer_cuts_the_corner() {
    let mut draft = scene();
    let turn = Leg::Curve { to: Place::at(40.0, 20.0, 90.0), reverse: false };
    let on = Leg::Curve { to: Place::at(40.0, 120.0, 90.0), reverse: false };
    let mut truck = actor("truck", 10.0, -10.0, 4.0, vec![straight_on(20.0, -10.0), turn, on], Vec::new());
    truck.parts.push(Part {
        id: "trailer".to_owned(),
        kind: PartKind::Trailer,
        x_m: -1.4,
        y_m: 0.0,
        length_m: 12.0,
        width_m: 2.5,
        axle_m: Some(9.0),
    });
    draft.actors.push(truck);
    draft.duration_s = 25.0;
    let rollout = recorded(draft);
    let (truck, trailer) = (track(&rollout, "truck"), track(&rollout, "truck.trailer"));
    // In a steady turn of radius R the axle of a trailer of length l runs on sqrt(R^2 - l^2): it lags behind the tractor.
    let bent = truck.states.iter().zip(&trailer.states).map(|(a, b)| math::wrap_angle(a.heading - b.heading));
    let most = bent.fold(0.0, f64::max);
    assert!(most > 0.2 && most < math::asin(9.0 / 20.0) + 0.02, "{most}");
    let (a, b) = (truck.states.last().unwrap(), trailer.states.last().unwrap());
    assert!(math::wrap_angle(a.heading - b.heading).abs() < 0.02, "it straightens out again");
}

#[test]
fn the_handover_is_continuous() {
    for ego in Ego::DRIVERS {
        let mut draft = scene();
        let acts = vec![when(Trigger::TimeS(1.0), Deed::Speed { to_mps: 4.5, rate_mps2: 2.25 })];
        draft.ego.recorded = Some(ActorPlan {
            speed_mps: 9.0,
            course: vec![straight_on(80.0, 0.0), Leg::Curve { to: Place::at(120.0, 3.5, 0.0), reverse: false }],
            acts,
            ..ActorPlan::standing(Place::at(20.0, 0.0, 0.0))
        });
        draft.ego.lane = 1;
        draft.ego.handover_s = Some(3.0);
        let told = recorded(draft.clone());
        let tested = simulate(&checked(draft), ego);
        for step in 0..=30 {
            assert_eq!(told.actors[0].states[step].pose(), tested.actors[0].states[step].pose(), "{ego} {step}");
        }
        for pair in tested.actors[0].states[28..36].windows(2) {
            let moved = pair[1].position().distance(pair[0].position());
            assert!((moved - 0.1 * pair[0].velocity().length()).abs() < 0.08, "{ego}: {pair:?}");
            assert!(math::wrap_angle(pair[1].heading - pair[0].heading).abs() < 0.02);
            assert!((pair[1].speed() - pair[0].speed()).abs() < 1.0);
        }
    }
}

pub(crate) fn signal(program: &[(Aspect, f64)]) -> Control {
    let program = program.iter().map(|&(show, for_s)| Phase { show, for_s }).collect();
    Control {
        at: "ego+".to_owned(),
        set_back_m: 200.0,
        lanes: Vec::new(),
        device: Device::Signal { program, offset_s: 0.0 },
    }
}

#[test]
fn every_built_in_ego_stops_for_red_and_goes_at_green() {
    for ego in Ego::DRIVERS {
        let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 10.0, 10.0);
        draft.control.push(signal(&[(Aspect::Red, 25.0), (Aspect::Green, 60.0)]));
        draft.duration_s = 60.0;
        let rollout = simulate(&checked(draft), ego);
        let states = &rollout.actors[0].states;
        // The line lies 200 m before the end of 360 m.
        let front = states[249].x + 0.5 * 4.515;
        assert!(states[249].speed() < 0.1 && front <= 160.0 && front > 156.5, "{ego}: {front} {}", states[249].speed());
        assert_eq!(rollout.termination.kind, TerminationKind::Arrived, "{ego}");
    }
}

#[test]
fn who_takes_over_sees_how_far_it_has_come_along_its_route() {
    for ego in Ego::DRIVERS {
        let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 10.0, 10.0);
        let start = ActorPlan::standing(Place::at(60.0, 0.0, 0.0));
        draft.ego.recorded = Some(ActorPlan { speed_mps: 10.0, course: vec![straight_on(350.0, 0.0)], ..start });
        draft.ego.handover_s = Some(2.0);
        draft.control.push(signal(&[(Aspect::Red, 60.0)]));
        let rollout = simulate(&checked(draft), ego);
        // The line lies at 160 m, the course began at 60 m.
        let front = rollout.actors[0].states.last().unwrap().x + 0.5 * 4.515;
        assert!(front <= 160.0 && front > 156.5, "{ego}: {front}");
    }
}

#[test]
fn who_appears_later_begins_at_its_start() {
    let mut draft = scene();
    draft.actors.push(actor("wheel", 30.0, 0.0, 6.0, vec![straight_on(250.0, 0.0)], Vec::new()));
    draft.actors[0].plan.appears_s = 4.0;
    let rollout = recorded(draft);
    let states = &track(&rollout, "wheel").states;
    assert!(states[..=40].iter().all(|state| state.x == 30.0), "{:?}", states[40]);
    assert!((states[50].x - 36.0).abs() < 1e-9, "{:?}", states[50]);
}

#[test]
fn a_stop_of_the_task_is_made_and_left_again() {
    for ego in Ego::DRIVERS {
        let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 8.0, 8.0);
        draft.ego.stops = vec![MissionStop { s_m: 120.0, t_m: 1.0, for_s: Some(6.0) }];
        draft.duration_s = 80.0;
        let rollout = simulate(&checked(draft), ego);
        let states = &rollout.actors[0].states;
        let standing: Vec<_> = states.iter().filter(|state| state.speed() < 0.1).collect();
        assert!(standing.len() >= 58 && standing.len() < 90, "{ego}: {}", standing.len());
        assert!(standing.iter().all(|state| (state.x - 119.5).abs() < 1.0), "{ego}: {:?}", standing.last());
        assert!((standing.last().unwrap().y + 1.0).abs() < 0.25, "{ego}: {:?}", standing.last());
        assert_eq!(rollout.termination.kind, TerminationKind::Arrived, "{ego}");
    }
}

#[test]
fn snapshots_go_on_with_the_same_bytes() {
    let mut draft = scene();
    draft.after_contact_s = 2.0;
    draft.ego.recorded = Some(ActorPlan::standing(Place::at(60.0, 0.0, 0.0)));
    draft.actors.push(actor("between", 54.0, 0.0, 0.0, Vec::new(), Vec::new()));
    let follow = Deed::Follow {
        actor: "between".to_owned(),
        speed_mps: 14.0,
        gap_m: 2.0,
        headway_s: 0.3,
        reaction_s: 2.0,
        acceleration_mps2: 2.0,
        braking_mps2: 4.0,
    };
    draft.actors.push(actor("cp", 8.0, 0.0, 14.0, vec![straight_on(200.0, 0.0)], vec![act(follow)]));
    let scenario = checked(draft);
    let mut whole = Run::new(&scenario, Seat::BuiltIn(Ego::Recorded));
    let mut snapshots = Vec::new();
    let mut states = Vec::new();
    while whole.termination().is_none() {
        snapshots.push(whole.snapshot());
        whole.step(None);
        states.push(whole.observe().states.to_vec());
    }
    assert!(states.len() > 30);
    let mut again = Run::new(&scenario, Seat::BuiltIn(Ego::Idm));
    for (step, snapshot) in snapshots.iter().enumerate().step_by(3) {
        again.restore(snapshot);
        for expected in &states[step..] {
            again.step(None);
            assert_eq!(again.observe().states, expected.as_slice());
        }
    }
}
