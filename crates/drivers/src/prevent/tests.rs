use super::*;
use crate::grid::{Concrete, Grid};
use crate::scene::{body, cutting_in, drive, gaining};
use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::preventability::Bracket;
use recrash_model::rollout::{Event, EventKind, ROLLOUT_FORMAT, Role, Termination, TerminationKind};

fn state(body: &Body) -> ActorState {
    let pose = Pose { position: Vec2::new(body.along_m, body.across_m), heading: 0.0 };
    ActorState { vy: body.lateral_mps, ..ActorState::moving(pose, body.speed_mps) }
}

fn track(id: &str, role: Role, states: Vec<ActorState>) -> ActorTrack {
    ActorTrack {
        id: id.to_owned(),
        role,
        part_of: None,
        kind: PartnerKind::PassengerCar,
        length_m: 4.3,
        width_m: 1.9,
        mass_kg: None,
        appears_s: 0.0,
        gone_s: None,
        states,
    }
}

/// The rollout of two until they first touch; `None` where they never do.
fn rollout(ego: &[Body], other: &[Body]) -> Option<Rollout> {
    let step = ego.iter().zip(other).position(|(ego, other)| ego.touches(other))?;
    let states = |bodies: &[Body]| bodies[..=step].iter().map(state).collect::<Vec<_>>();
    let time_s = step as f64 / STEPS_PER_S;
    let kind = EventKind::Contact { a: 0, b: 1, a_state: state(&ego[step]), b_state: state(&other[step]) };
    Some(Rollout {
        format: ROLLOUT_FORMAT.to_owned(),
        scenario_id: "test".to_owned(),
        simulator: "test".to_owned(),
        ego: "blind".to_owned(),
        actors: vec![track("ego", Role::Ego, states(ego)), track("cp1", Role::Partner, states(other))],
        obstacles: Vec::new(),
        events: vec![Event { time_s, kind }],
        termination: Termination { kind: TerminationKind::Contact, time_s },
        state_hash: String::new(),
    })
}

/// An ego that holds its speed. [m, m/s]
fn blind(along_m: f64, speed_mps: f64, steps: usize) -> Vec<Body> {
    (0..steps).map(|step| body(along_m + speed_mps * step as f64 / STEPS_PER_S, speed_mps)).collect()
}

#[test]
fn in_the_place_of_a_blind_ego_they_fare_as_on_the_grid() {
    let (mut compared, mut avoided) = (0, 0);
    for scenario in Grid::CutInFast.scenarios().iter().chain(&Grid::CutInSlow.scenarios()).step_by(37) {
        let Concrete::CutIn { ego_kmh, other_kmh, gap_m, lateral_mps } = *scenario else { panic!("{scenario:?}") };
        // Off the grid, where no time to collision is a limit to the last bit.
        let gap_m = gap_m + 0.0137;
        let scenario = &Concrete::CutIn { ego_kmh, other_kmh, gap_m, lateral_mps };
        let (ego_mps, other_mps) = (ego_kmh / 3.6, other_kmh / 3.6);
        let before = gaining(lateral_mps);
        let others: Vec<Body> = cutting_in(&before, other_mps, gap_m, lateral_mps).collect();
        let egos = blind(-ego_mps * before.len() as f64 / STEPS_PER_S, ego_mps, others.len());
        // What begins before the window is not known.
        let Some(rollout) = rollout(&egos, &others).filter(|rollout| rollout.termination.time_s < 15.0) else {
            continue;
        };
        let found = preventability(&rollout).expect("a contact");
        let (_, _, ego, other) = rollout.first_ego_contact().expect("a contact");
        if ego.x >= other.x {
            // Into the ego's side: at what is behind the ego's middle no model looks.
            assert_eq!(found.bracket(), Bracket::NotCovered);
            continue;
        }
        assert_eq!(found.drivers.len(), 5);
        assert!((found.closing_speed_mps - (ego_mps - other_mps)).abs() < 1e-9);
        for driver in ReferenceDriver::ALL {
            let here = found.drivers.iter().find(|place| place.driver == driver.name()).expect("it covers cut-ins");
            let crash = drive(scenario, driver);
            assert_eq!(here.closing_speed_mps.is_some(), crash.is_some(), "{scenario:?} {driver:?}");
            if let (Some(here), Some(there)) = (here.closing_speed_mps, crash) {
                assert!((here - (there.ego_mps - there.other_mps).max(0.0)).abs() < 1e-6, "{scenario:?} {driver:?}");
            }
            compared += 1;
            avoided += usize::from(crash.is_none());
        }
    }
    assert!(compared > 500 && avoided > 50, "{avoided} of {compared}");
}

/// Leader and ego at 20 m/s, this far apart; the leader brakes after 2 s. [m, m/s^2]
fn braking_leader(gap_m: f64, deceleration_mps2: f64) -> Preventability {
    let mut speed_mps: f64 = 20.0;
    let mut along_m = gap_m + 4.3;
    let mut leaders = Vec::new();
    for step in 0..200 {
        leaders.push(body(along_m, speed_mps));
        speed_mps = if step < 20 { 20.0 } else { (speed_mps - deceleration_mps2 / STEPS_PER_S).max(0.0) };
        along_m += speed_mps / STEPS_PER_S;
    }
    preventability(&rollout(&blind(0.0, 20.0, 200), &leaders).expect("they touch")).expect("a contact")
}

#[test]
fn behind_a_leader_who_brakes_hard_good_drivers_stop_if_they_were_far_enough() {
    let far = braking_leader(45.0, 6.0);
    assert_eq!(far.bracket(), Bracket::AvoidedByAll);
    assert_eq!(far.mitigation(), Some((1.0, 1.0)));
    let names: Vec<&str> = far.drivers.iter().map(|place| place.driver.as_str()).collect();
    assert_eq!(names, ["careful", "fsm", "rss", "reaction-time"], "the regulation's own requirement is on cut-ins");
    let careful = &far.drivers[0];
    assert!(careful.reacts_at_s.is_some_and(|time_s| (2.0..2.3).contains(&time_s)), "{careful:?}");
    let near = braking_leader(3.0, 7.0);
    assert_eq!(near.bracket(), Bracket::AvoidedBySome, "{near:?}");
    let (least, most) = near.mitigation().expect("covered");
    assert!(least < 1.0 && most == 1.0, "{least} {most}");
}

#[test]
fn the_careful_drivers_source_says_nothing_of_a_leader_who_slows_gently() {
    let names: Vec<String> = braking_leader(20.0, 3.0).drivers.into_iter().map(|place| place.driver).collect();
    assert_eq!(names, ["fsm", "rss", "reaction-time"]);
}

#[test]
fn bends_blows_from_behind_and_what_lay_in_the_way_are_not_covered() {
    let standing = |body: Body, heading: f64| {
        let mut rollout = rollout(&blind(0.0, 10.0, 100), &vec![body; 100]).expect("they touch");
        for each in &mut rollout.actors[1].states {
            each.heading = heading;
        }
        preventability(&rollout).expect("a contact").bracket()
    };
    assert_ne!(standing(body(30.0, 0.0), 0.0), Bracket::NotCovered);
    assert_eq!(standing(body(30.0, 0.0), 1.5), Bracket::NotCovered);
    let from_behind = rollout(&vec![body(0.0, 0.0); 100], &blind(-30.0, 10.0, 100)).expect("they touch");
    assert_eq!(preventability(&from_behind).expect("a contact").bracket(), Bracket::NotCovered);
    let mut bend = rollout(&blind(0.0, 10.0, 100), &vec![body(30.0, 0.0); 100]).expect("they touch");
    bend.actors[0].states[3].heading = 0.3;
    assert_eq!(preventability(&bend).expect("a contact").bracket(), Bracket::NotCovered);
}

#[test]
fn a_cut_in_from_the_right_is_one_from_the_left_seen_in_a_mirror() {
    let others: Vec<Body> = cutting_in(&gaining(1.0), 10.0, 28.0, 1.0).collect();
    let mirrored: Vec<Body> =
        others.iter().map(|body| Body { across_m: -body.across_m, lateral_mps: -body.lateral_mps, ..*body }).collect();
    let of = |others: &[Body]| preventability(&rollout(&blind(0.0, 20.0, others.len()), others).expect("they touch"));
    assert_eq!(of(&others), of(&mirrored));
}

/// A car crosses from the left at 10 m/s, its middle in the ego's way after this time; the ego comes at 15 m/s. [s]
fn crossing(in_the_way_s: f64, ego_at_m: f64) -> Preventability {
    let others: Vec<Body> = (0..100)
        .map(|step| {
            let across_m = 10.0 * (in_the_way_s - f64::from(step) / STEPS_PER_S);
            Body { across_m, lateral_mps: -10.0, ..body(60.0, 0.0) }
        })
        .collect();
    let egos = blind(ego_at_m, 15.0, 100);
    let step = egos.iter().zip(&others).position(|(ego, other)| {
        let outline = |body: &Body, heading: f64| {
            OrientedBox::new(Pose { position: Vec2::new(body.along_m, body.across_m), heading }, 4.3, 1.9)
        };
        outline(ego, 0.0).overlaps(&outline(other, -math::FRAC_PI_2))
    });
    let step = step.expect("they touch");
    let mut found = rollout(&blind(0.0, 10.0, 100), &vec![body(30.0, 0.0); 100]).expect("they touch");
    let turned = |body: &Body| ActorState { heading: -math::FRAC_PI_2, ..state(body) };
    found.actors[0].states = egos[..=step].iter().map(state).collect();
    found.actors[1].states = others[..=step].iter().map(turned).collect();
    let time_s = step as f64 / STEPS_PER_S;
    let kind = EventKind::Contact { a: 0, b: 1, a_state: state(&egos[step]), b_state: turned(&others[step]) };
    found.events = vec![Event { time_s, kind }];
    preventability(&found).expect("a contact")
}

#[test]
fn a_crossing_is_for_the_reaction_time_alone() {
    // From 15 m/s one stops within 22.5 m of reaction and 17.9 m of braking; the other needs 1.2 s from the edge of the lane.
    let found = crossing(3.0, 60.0 - 15.0 * 3.0);
    let names: Vec<&str> = found.drivers.iter().map(|place| place.driver.as_str()).collect();
    assert_eq!(names, ["reaction-time"]);
    let reacts_at_s = found.drivers[0].reacts_at_s.expect("it reacts");
    // Its front is in the lane 2.15 + 1.75 m before its middle is in the way.
    assert!((reacts_at_s - 2.7).abs() < 0.11, "{reacts_at_s}");
    assert_eq!(found.bracket(), Bracket::AvoidedByNone);
    assert!(found.mitigation().is_some_and(|(least, most)| least == most && most < 0.05));
}

#[test]
fn a_pedestrian_who_steps_into_the_lane_in_time_is_spared() {
    // In the lane after 2.5 s, in the way after 4.5 s; the ego, at 12 m/s, gets there so much later, less 0.2 s for its length.
    let of = |seconds_later: f64| {
        let walker = |step: usize| Body {
            across_m: 3.0 - 0.4 * step as f64 / STEPS_PER_S,
            lateral_mps: -0.4,
            length_m: 0.5,
            width_m: 0.5,
            ..body(80.0, 0.0)
        };
        let walkers: Vec<Body> = (0..100).map(walker).collect();
        let egos = blind(80.0 - 12.0 * (4.5 + seconds_later), 12.0, 100);
        let mut found = rollout(&egos, &walkers).expect("they touch");
        (found.actors[1].length_m, found.actors[1].width_m) = (0.5, 0.5);
        for state in &mut found.actors[1].states {
            state.heading = -math::FRAC_PI_2;
        }
        preventability(&found).expect("a contact")
    };
    // 1.5 s of reaction, then 13 m to a stand: 2.6 s before it would be there.
    let late = of(0.4);
    assert_eq!((late.drivers.len(), late.bracket()), (1, Bracket::AvoidedByNone));
    assert!(late.drivers[0].closing_speed_mps.is_some_and(|left| left > 5.0 && left < 11.0), "{late:?}");
    assert_eq!(of(1.0).bracket(), Bracket::AvoidedByAll);
}
