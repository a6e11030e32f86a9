//! Promises about every run: it ends, it is finite, it repeats to the bit, and its steps allocate nothing.

use proptest::prelude::*;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorState, Rollout, Substeps, Termination, TerminationKind};
use recrash_model::scenario::{Approach, ScenarioDraft, Start, Turn};
use recrash_model::surroundings::Surface;
use recrash_roads::{Scenario, background_traffic};
use recrash_sim::{
    CastMember, Controls, Ego, EgoDriver, Observation, RolloutRecorder, Runner, SummaryRecorder, simulate,
};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{alone, checked, random_draft, roundabout, steady, wide_cross};

fn assert_sound(rollout: &Rollout) {
    let steps = rollout.steps();
    assert_eq!(steps, (rollout.termination.time_s * 10.0).round() as usize + 1);
    assert_ne!(rollout.termination.kind, TerminationKind::Diverged);
    for track in &rollout.actors {
        assert_eq!(track.states.len(), steps, "{}", track.id);
        for state in &track.states {
            assert!(state.is_finite(), "{state:?}");
            assert!(state.velocity().length() < 60.0, "{state:?}");
            assert!(state.steer.abs() <= 1.0 && state.throttle.abs() <= 1.0);
        }
        // Nobody drives backwards here; who spun on ice slides backwards until it stands.
        for pair in track.states.windows(2).filter(|pair| pair[1].speed() < -0.1) {
            assert!(pair[1].velocity().length() < pair[0].velocity().length(), "{pair:?}");
        }
    }
    assert!(rollout.events.is_sorted_by(|a, b| a.time_s <= b.time_s));
}

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
                partner.kind = PartnerKind::ALL[(kind + position) % PartnerKind::ALL.len()];
            }
            draft.environment.surface = surface;
            // Another kind may be too large or too fast for where it is: then the check says so.
            if let Ok(scenario) = recrash_roads::check(draft) {
                for ego in Ego::DRIVERS {
                    assert_sound(&simulate(&scenario.value, ego));
                }
            }
        }
    }
}

#[test]
fn a_used_runner_gives_the_same_bits_as_a_new_one() {
    let mut runner = Runner::new();
    let drafts: Vec<_> = (0..200).filter_map(|number| random_draft(11, number)).take(10).collect();
    let fresh: Vec<Rollout> = drafts.iter().map(|draft| simulate(&checked(draft.clone()), Ego::Idm)).collect();
    // In another order, and with another ego in between.
    for (draft, expected) in drafts.iter().zip(&fresh).rev() {
        let scenario = checked(draft.clone());
        runner.run(&scenario, Ego::MetadriveIdm, &mut SummaryRecorder::new());
        let mut recorder = RolloutRecorder::new();
        runner.run(&scenario, Ego::Idm, &mut recorder);
        assert_eq!(recorder.finish().as_ref(), Some(expected));
    }
}

#[test]
fn a_step_allocates_nothing() {
    let mut busy = alone(roundabout(2), Turn::Straight, 1, 5.0, 5.0);
    busy.traffic.density = 0.3;
    let mut crossing = alone(wide_cross(2), Turn::Straight, 1, 4.0, 4.0);
    crossing.partners.push(steady(Approach::Left, Turn::Straight, Start::ArrivalGap { arrival_gap_s: 4.5 }, 8.0));
    for mut draft in [busy, crossing] {
        for ego in Ego::DRIVERS {
            let mut runner = Runner::new();
            let mut recorder = SummaryRecorder::new();
            let mut allocations = |duration_s: f64| {
                draft.duration_s = duration_s;
                let scenario = checked(draft.clone());
                // The first run makes room.
                runner.run(&scenario, ego, &mut recorder);
                let counted = allocation_counter::measure(|| {
                    runner.run(&scenario, ego, &mut recorder);
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

/// One timer for all would have all of them overtake in the same step, in both simulators: their parity could not tell it.
#[test]
fn every_vehicle_of_background_traffic_has_an_overtaking_timer_of_its_own() {
    let timers = |seed| {
        let mut draft = alone(roundabout(2), Turn::Straight, 1, 7.0, 7.0);
        (draft.traffic.density, draft.traffic.seed) = (0.3, seed);
        let placed = background_traffic(&checked(draft));
        placed.iter().map(|vehicle| vehicle.overtake_timer_steps).collect::<Vec<_>>()
    };
    let mut drawn = timers(3);
    assert!(drawn.len() >= 8 && drawn.iter().all(|steps| *steps < 50), "{drawn:?}");
    assert_ne!(drawn, timers(4));
    drawn.sort_unstable();
    drawn.dedup();
    assert!(drawn.len() >= 6, "{drawn:?}");
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

/// Drives as a rollout was driven.
struct Replay<'a> {
    rollout: &'a Rollout,
    fails_at: usize,
}

impl EgoDriver for Replay<'_> {
    type Error = String;

    fn name(&self) -> &str {
        "replay"
    }

    fn begin(&mut self, scenario: &Scenario, cast: &[CastMember]) -> Result<(), String> {
        assert_eq!(cast.len(), self.rollout.actors.len());
        for (position, (member, track)) in cast.iter().zip(&self.rollout.actors).enumerate() {
            assert_eq!(member.id(scenario.draft(), position), track.id);
        }
        Ok(())
    }

    fn decide(&mut self, observation: &Observation<'_>) -> Result<Controls, String> {
        let step = observation.step as usize;
        assert_eq!(observation.time_s, step as f64 / 10.0);
        for (actor, (state, track)) in observation.states.iter().zip(&self.rollout.actors).enumerate() {
            assert_eq!(state.pose(), track.states[step].pose(), "{actor} at {step}");
            assert!(observation.is_present(actor));
        }
        if step == self.fails_at {
            return Err(format!("no answer at step {step}"));
        }
        let ActorState { steer, throttle, .. } = self.rollout.actors[0].states[step];
        Ok(Controls { steer, throttle })
    }

    fn end(&mut self, termination: Termination) -> Result<(), String> {
        assert_eq!(termination, self.rollout.termination);
        Ok(())
    }
}

#[test]
fn a_driver_from_outside_that_does_what_another_did_gets_the_same_bits() {
    let mut runner = Runner::new();
    for draft in (0..200).filter_map(|number| random_draft(12, number)).take(10) {
        let scenario = checked(draft);
        let rollout = simulate(&scenario, Ego::Idm);
        let mut recorder = RolloutRecorder::new();
        let mut replay = Replay { rollout: &rollout, fails_at: usize::MAX };
        let termination = runner.run_with(&scenario, &mut replay, &mut recorder);
        assert_eq!(termination, Ok(rollout.termination));
        let again = recorder.finish().expect("a rollout");
        assert_eq!((again.ego.as_str(), &again.state_hash), ("replay", &rollout.state_hash));
        assert_eq!(again.events, rollout.events);
    }
}

#[test]
fn a_driver_from_outside_without_an_answer_ends_the_run_with_its_error() {
    let scenario = checked(alone(wide_cross(2), Turn::Straight, 1, 8.0, 8.0));
    let rollout = simulate(&scenario, Ego::Idm);
    let mut replay = Replay { rollout: &rollout, fails_at: 17 };
    let outcome = Runner::new().run_with(&scenario, &mut replay, &mut SummaryRecorder::new());
    assert_eq!(outcome, Err("no answer at step 17".to_owned()));
}

/// What the goldens are taken of: the scenarios in `closed_loop.jsonl`, every sixth with background traffic, and random
/// ones with every kind of road user on every surface. The check may grow stricter after the scenarios were drawn.
fn golden_scenarios() -> Vec<Scenario> {
    let mut drafts = Vec::new();
    for (number, line) in include_str!("../fixtures/closed_loop.jsonl").lines().enumerate() {
        let value: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let mut draft: ScenarioDraft = serde_json::from_value(value["draft"].clone()).expect("a draft");
        if number % 6 == 5 {
            draft.traffic.density = 0.1;
        }
        drafts.push(draft);
    }
    for number in 0..500 {
        let Some(mut draft) = random_draft(31, number) else { continue };
        for (position, partner) in draft.partners.iter_mut().enumerate() {
            partner.kind = PartnerKind::ALL[(number as usize + position) % PartnerKind::ALL.len()];
        }
        draft.environment.surface = [Surface::Dry, Surface::Wet, Surface::SnowIce][number as usize % 3];
        drafts.push(draft);
    }
    drafts.into_iter().filter_map(|draft| recrash_roads::check(draft).ok()).map(|checked| checked.value).collect()
}

/// Every scenario with every ego.
fn usual(scenarios: &[Scenario]) -> Vec<(&Scenario, Ego, Substeps)> {
    let usual = Substeps::default();
    scenarios.iter().flat_map(|scenario| Ego::DRIVERS.map(|ego| (scenario, ego, usual))).collect()
}

/// Every scenario with one ego and one other physics step, each in turn.
fn in_other_steps(scenarios: &[Scenario]) -> Vec<(&Scenario, Ego, Substeps)> {
    let each = |(number, scenario)| {
        let substeps = Substeps::new([4, 8, 10][number / Ego::DRIVERS.len() % 3]);
        (scenario, Ego::DRIVERS[number % Ego::DRIVERS.len()], substeps)
    };
    scenarios.iter().enumerate().map(each).collect()
}

/// A line per run: name, ego, steps and state hash, from this many threads that share the work.
fn golden_lines(runs: &[(&Scenario, Ego, Substeps)], threads: usize) -> Vec<String> {
    let next = AtomicUsize::new(0);
    let lines: Mutex<Vec<(usize, String)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let mut runner = Runner::new();
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(&(scenario, ego, substeps)) = runs.get(number) else { return };
                    let mut recorder = RolloutRecorder::new();
                    runner = runner.stepping(substeps);
                    runner.run(scenario, ego, &mut recorder);
                    let rollout = recorder.finish().expect("a rollout");
                    let (id, steps, hash) = (&rollout.scenario_id, rollout.steps(), &rollout.state_hash);
                    let line = match substeps.count() {
                        5 => format!("{id} {ego} {steps} {hash}"),
                        count => format!("{id} {ego}, {count} physics steps, {steps} {hash}"),
                    };
                    lines.lock().expect("no thread has failed").push((number, line));
                }
            });
        }
    });
    let mut lines = lines.into_inner().expect("no thread has failed");
    lines.sort();
    lines.into_iter().map(|(_, line)| line).collect()
}

/// State hashes of all those scenarios with every ego, and with other physics steps: equal on every machine, in debug and release builds, for any
/// number of threads and any history of the runners. To renew them after a change of the model run with
/// `RECRASH_RENEW_GOLDENS=1`; that run fails.
#[test]
fn state_hashes_are_those_on_file_for_1_2_and_8_threads() {
    let scenarios = golden_scenarios();
    assert!(scenarios.len() >= 70, "only {} scenarios can still be run", scenarios.len());
    let runs = [usual(&scenarios), in_other_steps(&scenarios)].concat();
    let hashes = golden_lines(&runs, 1);
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/state_hashes.txt");
    if std::env::var_os("RECRASH_RENEW_GOLDENS").is_some() {
        std::fs::write(file, hashes.join("\n") + "\n").expect("the golden can be written");
        panic!("the golden has been renewed: look at the difference, then run again without RECRASH_RENEW_GOLDENS");
    }
    let golden = std::fs::read_to_string(file).unwrap_or_default();
    let golden: Vec<&str> = golden.lines().collect();
    let unknown: Vec<&String> = hashes.iter().filter(|hash| !golden.contains(&hash.as_str())).collect();
    assert!(unknown.is_empty(), "{} of {} are not on file: {unknown:#?}", unknown.len(), hashes.len());
    for threads in [2, 8] {
        assert_eq!(golden_lines(&runs, threads), hashes, "{threads} threads");
    }
}
