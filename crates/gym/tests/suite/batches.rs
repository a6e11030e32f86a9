//! Episodes: what begins and ends them, and that they are the simulator's runs.

use crate::common::{Memory, batch, gallery, scenario, settings};
use recrash_gym::{Actions, Autoreset, BatchError, Handles, Reward, Scene, Settings, TERMS};
use recrash_model::profile::SystemProfile;
use recrash_model::rollout::TerminationKind;
use recrash_model::scenario::{Aspect, Device, Phase};
use recrash_sim::{Controls, Ego, EgoDriver, Observation, RolloutRecorder, Run, Runner, Seat, simulate};

/// Answers from a list.
struct Replayed(Vec<[f32; 2]>);

impl EgoDriver for Replayed {
    type Error = std::convert::Infallible;

    fn name(&self) -> &str {
        "gym"
    }

    fn begin(&mut self, _: &recrash_roads::Scenario, _: &[recrash_sim::CastMember]) -> Result<(), Self::Error> {
        Ok(())
    }

    fn decide(&mut self, observation: &Observation<'_>) -> Result<Controls, Self::Error> {
        let [steer, throttle] = self.0[observation.step as usize].map(f64::from);
        Ok(Controls { steer, throttle })
    }

    fn end(&mut self, _: recrash_model::rollout::Termination) -> Result<(), Self::Error> {
        Ok(())
    }
}

fn profile() -> SystemProfile {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../profiles/paper.toml")).unwrap();
    toml::from_str(&text).unwrap()
}

fn judging() -> Settings {
    Settings { judged_by: Some(profile()), handles: Handles::Pedals, ..settings(Autoreset::Disabled) }
}

#[test]
fn an_episode_is_the_run_that_the_simulator_gives_on_the_whole_gallery() {
    for scenario in gallery() {
        // What IDM does in it, as an action has it: in single precision.
        let controls: Vec<[f32; 2]> = simulate(&scenario, Ego::Idm).actors[0]
            .states
            .iter()
            .map(|state| [state.steer as f32, state.throttle as f32])
            .collect();
        let longest = [controls.clone(), vec![[0.0, -0.1]; 1300]].concat();
        let mut recorder = RolloutRecorder::new();
        let _ = Runner::new().run_with(&scenario, &mut Replayed(longest.clone()), &mut recorder);
        let expected = recorder.finish().unwrap();

        let mut batch = batch(std::slice::from_ref(&scenario), 1, judging());
        let mut memory = Memory::of(&batch);
        batch.reset(Some(1), None, None, memory.lend()).unwrap();
        let (before, mut step) = (recorded_steps(&scenario), 0);
        // The episode begins at the handover; the steps before it are the recorded driver's.
        while batch.judged(0).is_none() {
            batch.step(Actions::Numbers(&longest[before + step]), memory.lend()).unwrap();
            step += 1;
        }
        let (_, judged) = batch.judged(0).unwrap();
        assert_eq!(judged.state_hash, expected.state_hash, "{}", expected.scenario_id);
        assert_eq!(judged.rollout, expected);
        assert_eq!(memory.episode_steps[0] as usize, step);
        assert_eq!(memory.truncated[0], expected.termination.kind == TerminationKind::Timeout);
        assert_eq!(memory.terminated[0], !memory.truncated[0]);
        assert_eq!(usize::from(memory.endings[0]), 1 + expected.termination.kind as usize);
    }
}

#[test]
fn who_passes_in_the_step_before_red_has_not_run_it() {
    // The steps in which a line was passed at red, where green lasts so many steps.
    let reds = |green: usize| {
        let mut draft = scenario("control/01-green").draft().clone();
        draft.ego.handover_s = Some(0.0);
        let phase = |show: Aspect, for_s: f64| Phase { show, for_s };
        let program = vec![phase(Aspect::Green, green as f64 / 10.0), phase(Aspect::Red, 60.0)];
        draft.control[0].device = Device::Signal { program, offset_s: 0.0 };
        let mut batch = batch(&[recrash_roads::check(draft).unwrap().value], 1, settings(Autoreset::Disabled));
        let mut memory = Memory::of(&batch);
        batch.reset(Some(1), None, None, memory.lend()).unwrap();
        let mut found = Vec::new();
        for step in 1.. {
            batch.step(Actions::Numbers(&[0.0, 0.0]), memory.lend()).unwrap();
            found.extend((memory.terms[2] > 0.0).then_some(step));
            if memory.endings[0] != 0 {
                break;
            }
        }
        found
    };
    let passed = reds(1)[0];
    assert!(passed > 5);
    assert_eq!((reds(passed - 1), reds(passed)), (vec![passed], Vec::new()));
}

#[test]
fn a_judged_run_is_of_its_own_scene_where_several_have_one_name() {
    let scenarios = [6.0, 4.0, 5.0].map(|duration_s| {
        let mut draft = scenario("roads/24-block-straight").draft().clone();
        draft.duration_s = duration_s;
        recrash_roads::check(draft).unwrap().value
    });
    let mut batch = batch(&scenarios, 3, judging());
    let mut memory = Memory::of(&batch);
    batch.reset(Some(1), None, Some(&[2, 0, 1]), memory.lend()).unwrap();
    let mut left = 3;
    while left > 0 {
        batch.step(Actions::Numbers(&[0.0, -1.0, 0.0, -1.0, 0.0, -1.0]), memory.lend()).unwrap();
        for slot in (0..3).filter(|slot| memory.endings[*slot] != 0) {
            let (scene, run) = batch.judged(slot).unwrap();
            assert_eq!(scene.scenario().draft().duration_s, [5.0, 6.0, 4.0][slot]);
            assert_eq!(run.rollout.termination.time_s, [5.0, 6.0, 4.0][slot]);
            left -= 1;
        }
        if (0..3).any(|slot| memory.endings[slot] != 0) {
            let mask: Vec<bool> = memory.endings.iter().map(|ending| *ending != 0).collect();
            batch.reset(None, Some(&mask), None, memory.lend()).unwrap();
        }
    }
}

/// Steps that the recorded driver drives.
fn recorded_steps(scenario: &recrash_roads::Scenario) -> usize {
    let mut run = Run::new(scenario, Seat::Outside);
    if !run.observe().recorded {
        return 0;
    }
    while run.observe().recorded {
        run.step(None);
    }
    // The seat's controls count in the step of the handover.
    run.observe().step as usize - 1
}

#[test]
fn the_same_seed_and_actions_give_the_same_for_any_number_of_threads() {
    let scenarios: Vec<_> = gallery().into_iter().step_by(3).collect();
    let drive = |threads: usize, seed: u64| {
        let mut batch = batch(&scenarios, 100, Settings { threads, ..settings(Autoreset::SameStep) });
        let mut memory = Memory::of(&batch);
        batch.reset(Some(seed), None, None, memory.lend()).unwrap();
        let mut all = vec![memory.clone()];
        for step in 0..150_usize {
            let actions: Vec<f32> = (0..200).map(|n| ((n * 7 + step * 3) % 21) as f32 / 10.0 - 1.0).collect();
            batch.step(Actions::Numbers(&actions), memory.lend()).unwrap();
            all.push(memory.clone());
        }
        all
    };
    let alone = drive(1, 5);
    assert!(alone == drive(3, 5));
    assert!(alone != drive(1, 6));
    assert!(alone.iter().any(|memory| memory.endings.iter().any(|ending| *ending > 0)));
}

/// Steps with full brakes until somebody's episode ends; the memory before the last step, and after it.
fn until_the_end(batch: &mut recrash_gym::Batch) -> (Memory, Memory) {
    let mut memory = Memory::of(batch);
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    let actions = vec![0.0; 2 * batch.slots()];
    loop {
        let before = memory.clone();
        batch.step(Actions::Numbers(&actions), memory.lend()).unwrap();
        if memory.endings[0] > 0 {
            return (before, memory);
        }
    }
}

#[test]
fn the_next_step_begins_another_episode_and_passes_over_its_action() {
    let scenarios = [scenario("acts/06-speed")];
    let mut batch = batch(&scenarios, 1, settings(Autoreset::NextStep));
    let mut begun = Memory::of(&batch);
    batch.reset(Some(1), None, None, begun.lend()).unwrap();
    let (_, ended) = until_the_end(&mut batch);
    assert!(ended.terminated[0] || ended.truncated[0]);
    assert_ne!(ended.numbers, begun.numbers);
    let mut memory = Memory::of(&batch);
    batch.step(Actions::Numbers(&[1.0, 1.0]), memory.lend()).unwrap();
    assert_eq!((&memory.numbers, memory.rewards[0], memory.endings[0]), (&begun.numbers, 0.0, 0));
    assert_eq!((memory.terminated[0], memory.truncated[0]), (false, false));
}

#[test]
fn the_same_step_begins_another_episode_and_keeps_the_last_observation() {
    let scenarios = [scenario("acts/06-speed")];
    let (_, ended) = until_the_end(&mut batch(&scenarios, 1, settings(Autoreset::NextStep)));
    let mut same = batch(&scenarios, 1, settings(Autoreset::SameStep));
    let mut begun = Memory::of(&same);
    same.reset(Some(1), None, None, begun.lend()).unwrap();
    let (_, memory) = until_the_end(&mut same);
    assert_eq!(memory.numbers, begun.numbers);
    assert_eq!(memory.final_numbers, ended.numbers);
    assert_eq!(memory.rewards, ended.rewards);
}

#[test]
fn without_autoreset_an_episode_that_is_over_wants_a_reset_of_its_own() {
    let scenarios = [scenario("acts/06-speed"), scenario("roads/17-roundabout")];
    let mut batch = batch(&scenarios, 2, settings(Autoreset::Disabled));
    let mut memory = Memory::of(&batch);
    let actions = [0.0; 4];
    assert_eq!(batch.step(Actions::Numbers(&actions), memory.lend()), Err(BatchError::Ended { slot: 0 }));
    batch.reset(None, None, Some(&[0, 1]), memory.lend()).unwrap();
    assert_eq!(memory.scenes, [0, 1]);
    while memory.endings == [0, 0] {
        batch.step(Actions::Numbers(&actions), memory.lend()).unwrap();
    }
    let over = memory.endings.iter().position(|ending| *ending > 0).unwrap();
    assert_eq!(batch.step(Actions::Numbers(&actions), memory.lend()), Err(BatchError::Ended { slot: over }));
    let other = memory.numbers[(1 - over) * 67..][..67].to_vec();
    batch.reset(None, Some(&[over == 0, over == 1]), None, memory.lend()).unwrap();
    assert_eq!(memory.numbers[(1 - over) * 67..][..67], other);
    assert_eq!(batch.step(Actions::Numbers(&actions), memory.lend()), Ok(()));
}

#[test]
fn scenes_are_drawn_by_their_weights() {
    let scenarios: Vec<_> = ["acts/01-lanes", "acts/06-speed", "acts/08-hold"].map(scenario).into();
    let mut batch = batch(&scenarios, 3000, settings(Autoreset::NextStep));
    let mut memory = Memory::of(&batch);
    let mut drawn = |batch: &mut recrash_gym::Batch| {
        batch.reset(Some(3), None, None, memory.lend()).unwrap();
        [0, 1, 2].map(|scene| memory.scenes.iter().filter(|drawn| **drawn == scene).count())
    };
    for count in drawn(&mut batch) {
        assert!((count as i64 - 1000).abs() < 120, "{count}");
    }
    batch.set_weights(&[0.0, 3.0, 1.0]).unwrap();
    let [none, many, few] = drawn(&mut batch);
    assert_eq!(none, 0);
    assert!((many as i64 - 2250).abs() < 120 && (few as i64 - 750).abs() < 120, "{many} {few}");
    assert!(batch.set_weights(&[1.0]).unwrap_err().to_string().contains("has 1 entries, and 3 are wanted"));
    for weights in [[0.0, 0.0, 0.0], [1.0, -1.0, 1.0], [1.0, f64::NAN, 1.0]] {
        assert!(matches!(batch.set_weights(&weights), Err(BatchError::Weight { .. })));
    }
}

#[test]
fn bad_actions_are_told_with_their_place_and_change_nothing() {
    let scenarios = [scenario("acts/06-speed")];
    let mut batch = batch(&scenarios, 2, settings(Autoreset::NextStep));
    let mut memory = Memory::of(&batch);
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    let kept = memory.clone();
    let error = batch.step(Actions::Numbers(&[0.0, 0.0, 0.0, f32::NAN]), memory.lend()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the action of environment 1 has NaN at position 1: actions are numbers from -1 to 1"
    );
    let error = batch.step(Actions::Numbers(&[0.0; 3]), memory.lend()).unwrap_err();
    assert_eq!(error.to_string(), "the list of actions has 3 entries, and 4 are wanted");
    assert_eq!(batch.step(Actions::Acts(&[0, 0]), memory.lend()), Err(BatchError::OtherKind));
    assert_eq!(memory, kept);
    let other = Settings { handles: Handles::Acts, ..settings(Autoreset::NextStep) };
    let mut batch = crate::common::batch(&scenarios, 2, other);
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    let error = batch.step(Actions::Acts(&[0, 12]), memory.lend()).unwrap_err();
    assert_eq!(error.to_string(), "the action of environment 1 is 12: actions are 0 to 11");
}

#[test]
fn a_scenario_without_a_handover_is_no_scene() {
    let mut draft = scenario("acts/06-speed").draft().clone();
    draft.ego.handover_s = Some(draft.duration_s);
    let error = Scene::new(recrash_roads::check(draft).unwrap().value).unwrap_err().to_string();
    assert!(error.contains("acts-06-speed") && error.contains("handover_s"), "{error}");
}

#[test]
fn terms_say_what_happened_and_weights_make_the_reward_of_them() {
    // It runs into the car ahead, at a speed that the rollout knows.
    let scenario = scenario("crashes/32-lead-reverses");
    let reward = Reward { contact: -7.0, closing_speed: -2.0, ..Reward::of_weights([0.0; TERMS.len()]) };
    let mut batch = batch(&[scenario], 1, Settings { reward, ..judging() });
    let mut memory = Memory::of(&batch);
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    let mut sums = [0.0; TERMS.len()];
    let mut total = 0.0;
    while memory.endings[0] == 0 {
        batch.step(Actions::Numbers(&[0.0, 0.3]), memory.lend()).unwrap();
        sums.iter_mut().zip(&memory.terms).for_each(|(sum, term)| *sum += f64::from(*term));
        total += memory.rewards[0];
    }
    let (_, _, ego, other) = batch.judged(0).unwrap().1.rollout.first_ego_contact().unwrap();
    let closing = (ego.velocity() - other.velocity()).length();
    assert_eq!(sums[4], 1.0);
    assert!((sums[5] - closing).abs() < 1e-6 && closing > 1.0, "{closing}");
    assert!((total - (-7.0 - 2.0 * closing)).abs() < 1e-6);
    assert!((memory.episode_returns[0] - total).abs() < 1e-12);
    assert!(sums[3] > 0.0);
    // As far as it came, in shares of the way at the target speed.
    assert!(sums[0] > 5.0);
}

#[test]
fn a_step_allocates_nothing() {
    let scenarios: Vec<_> =
        ["crashes/01-rear-end-at-red", "roads/17-roundabout", "control/04-red-then-green"].map(scenario).into();
    let mut batch = batch(&scenarios, 8, settings(Autoreset::SameStep));
    let mut memory = Memory::of(&batch);
    let actions = [0.1; 16];
    batch.reset(Some(1), None, None, memory.lend()).unwrap();
    // Every slot has had every scene.
    for _ in 0..4000 {
        batch.step(Actions::Numbers(&actions), memory.lend()).unwrap();
    }
    let counted = allocation_counter::measure(|| {
        for _ in 0..500 {
            batch.step(Actions::Numbers(&actions), memory.lend()).unwrap();
        }
    });
    assert_eq!(counted.count_total, 0);
}
