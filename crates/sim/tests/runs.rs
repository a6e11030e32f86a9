//! Promises about every run: it ends, it is finite, it repeats to the bit, and its steps allocate nothing.

use proptest::prelude::*;
use recrash_model::record::{PartnerKind, Surface};
use recrash_model::rollout::{Rollout, TerminationKind};
use recrash_model::scenario::{Approach, ScenarioDraft, Start, Turn};
use recrash_sim::{Ego, RolloutRecorder, Simulator, SummaryRecorder, simulate};

mod common;
use common::{alone, checked, random_draft, roundabout, steady, wide_cross};

fn assert_sound(rollout: &Rollout) {
    let steps = rollout.steps();
    assert_eq!(steps, (rollout.termination.time_s * 10.0).round() as usize + 1);
    assert_ne!(rollout.termination.kind, TerminationKind::Diverged);
    for track in &rollout.actors {
        assert_eq!(track.states.len(), steps, "{}", track.id);
        for state in &track.states {
            assert!([state.x, state.y, state.heading, state.speed].iter().all(|number| number.is_finite()));
            assert!(state.speed >= 0.0 && state.speed < 60.0, "{}", state.speed);
            assert!(state.steer.abs() <= 1.0 && state.throttle.abs() <= 1.0);
        }
    }
    assert!(rollout.events.is_sorted_by(|a, b| a.time_s <= b.time_s));
}

const KINDS: [PartnerKind; 13] = [
    PartnerKind::PassengerCar,
    PartnerKind::Suv,
    PartnerKind::Van,
    PartnerKind::PickupTruck,
    PartnerKind::HeavyTruck,
    PartnerKind::Bus,
    PartnerKind::Motorcycle,
    PartnerKind::Cyclist,
    PartnerKind::Pedestrian,
    PartnerKind::OtherNonMotorist,
    PartnerKind::FirstResponder,
    PartnerKind::Animal,
    PartnerKind::FixedObject,
];

fn surfaces() -> impl Strategy<Value = Surface> {
    prop_oneof![Just(Surface::Dry), Just(Surface::Wet), Just(Surface::SnowIce)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_checked_scenario_gives_a_rollout(seed in any::<u64>(), density in 0.0..1.0_f64, busy in any::<bool>(), kind in 0..13_usize, surface in surfaces()) {
        if let Some(mut draft) = (0..20).find_map(|number| random_draft(seed, number)) {
            if busy {
                draft.traffic.density = density;
                draft.traffic.seed = seed;
            }
            for (position, partner) in draft.partners.iter_mut().enumerate() {
                partner.kind = KINDS[(kind + position) % KINDS.len()];
            }
            draft.environment.surface = surface;
            // Another kind may be too large or too fast for where it is: then the check says so.
            if let Ok(scenario) = recrash_roads::check(draft) {
                for ego in Ego::ALL {
                    assert_sound(&simulate(&scenario.value, ego));
                }
            }
        }
    }
}

#[test]
fn a_used_simulator_gives_the_same_bits_as_a_new_one() {
    let mut simulator = Simulator::new();
    let drafts: Vec<_> = (0..200).filter_map(|number| random_draft(11, number)).take(10).collect();
    let fresh: Vec<Rollout> = drafts.iter().map(|draft| simulate(&checked(draft.clone()), Ego::Idm)).collect();
    // In another order, and with another ego in between.
    for (draft, expected) in drafts.iter().zip(&fresh).rev() {
        let scenario = checked(draft.clone());
        simulator.run(&scenario, Ego::MetadriveIdm, &mut SummaryRecorder::new());
        let mut recorder = RolloutRecorder::new();
        simulator.run(&scenario, Ego::Idm, &mut recorder);
        assert_eq!(recorder.finish().as_ref(), Some(expected));
    }
}

#[test]
fn a_step_allocates_nothing() {
    let mut busy = alone(roundabout(2), Turn::Straight, 1, 5.0, 5.0);
    busy.traffic.density = 0.3;
    let mut crossing = alone(wide_cross(2), Turn::Straight, 1, 4.0, 4.0);
    crossing.partners.push(steady(Approach::Left, Turn::Straight, Start::ArrivalGap { arrival_gap_s: 5.0 }, 8.0));
    for mut draft in [busy, crossing] {
        for ego in Ego::ALL {
            let mut simulator = Simulator::new();
            let mut recorder = SummaryRecorder::new();
            let mut allocations = |duration_s: f64| {
                draft.duration_s = duration_s;
                let scenario = checked(draft.clone());
                // The first run makes room.
                simulator.run(&scenario, ego, &mut recorder);
                let counted = allocation_counter::measure(|| {
                    simulator.run(&scenario, ego, &mut recorder);
                });
                (counted.count_total, recorder.summary.steps)
            };
            let (short, long) = (allocations(2.0), allocations(12.0));
            assert!(long.1 > short.1 + 50, "{short:?} {long:?}");
            assert_eq!(short.0, long.0, "allocations of a run do not depend on its length");
        }
    }
}

#[test]
fn background_traffic_fills_its_share_of_places_and_moves_when_the_ego_comes() {
    let count = |density: f64| {
        let mut draft = alone(roundabout(2), Turn::Straight, 1, 7.0, 7.0);
        draft.traffic.density = density;
        draft.traffic.seed = 3;
        simulate(&checked(draft), Ego::Idm)
    };
    assert_eq!(count(0.0).actors.len(), 1);
    let (few, many) = (count(0.1).actors.len(), count(0.3).actors.len());
    assert!(few > 3 && many > 2 * few, "{few} {many}");
    let rollout = count(0.2);
    let travelled = |id: usize| {
        let states = &rollout.actors[id].states;
        states[0].position().distance(states[states.len() - 1].position())
    };
    assert!((1..rollout.actors.len()).any(|actor| travelled(actor) > 20.0));
    // Nobody starts inside anybody.
    for a in 0..rollout.actors.len() {
        for b in a + 1..rollout.actors.len() {
            assert!(!rollout.actors[a].outline(0).overlaps(&rollout.actors[b].outline(0)), "{a} {b}");
        }
    }
}

#[test]
fn another_traffic_seed_is_another_traffic() {
    let with_seed = |seed| {
        let mut draft = alone(roundabout(2), Turn::Straight, 1, 7.0, 7.0);
        draft.traffic.density = 0.2;
        draft.traffic.seed = seed;
        simulate(&checked(draft), Ego::MetadriveIdm).state_hash
    };
    assert_eq!(with_seed(1), with_seed(1));
    assert_ne!(with_seed(1), with_seed(2));
}

#[test]
fn a_driver_who_looks_touches_far_fewer_than_one_who_does_not() {
    let contacts = |ego| {
        let drafts = (0..2000).filter_map(|number| random_draft(21, number)).take(100);
        drafts.filter(|draft| simulate(&checked(draft.clone()), ego).first_ego_contact().is_some()).count()
    };
    let (blind, looking) = (contacts(Ego::MetadriveIdm), contacts(Ego::Idm));
    assert!(blind >= 10 && 2 * looking <= blind, "{blind} {looking}");
}

/// State hashes of the scenarios in `closed_loop.jsonl`, every sixth with background traffic, with both egos: equal on
/// every machine, in debug and release builds, for any history of the simulator. To renew them after a change of the
/// model run with `RECRASH_RENEW_GOLDENS=1`; that run fails.
#[test]
fn state_hashes_are_those_on_file() {
    let mut hashes = Vec::new();
    for (number, line) in include_str!("fixtures/closed_loop.jsonl").lines().enumerate() {
        let value: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let mut draft: ScenarioDraft = serde_json::from_value(value["draft"].clone()).expect("a draft");
        if number % 6 == 5 {
            draft.traffic.density = 0.1;
        }
        // The check may grow stricter after the scenarios were drawn.
        let Ok(scenario) = recrash_roads::check(draft) else { continue };
        for ego in Ego::ALL {
            let rollout = simulate(&scenario.value, ego);
            hashes.push(format!("{} {ego} {} {}", rollout.scenario_id, rollout.steps(), rollout.state_hash));
        }
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/state_hashes.txt");
    if std::env::var_os("RECRASH_RENEW_GOLDENS").is_some() {
        std::fs::write(file, hashes.join("\n") + "\n").expect("the golden can be written");
        panic!("the golden has been renewed: look at the difference, then run again without RECRASH_RENEW_GOLDENS");
    }
    let golden = std::fs::read_to_string(file).unwrap_or_default();
    let golden: Vec<&str> = golden.lines().collect();
    assert!(hashes.len() >= 80, "only {} scenarios can still be run", hashes.len());
    let unknown: Vec<&String> = hashes.iter().filter(|hash| !golden.contains(&hash.as_str())).collect();
    assert!(unknown.is_empty(), "{} of {} are not on file: {unknown:#?}", unknown.len(), hashes.len());
}
