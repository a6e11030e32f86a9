//! Promises about a run that somebody else drives: the same bytes whoever owns the loop, from any snapshot, in any memory.

use proptest::prelude::*;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorState, Event, Termination, TerminationKind};
use recrash_model::scenario::{Approach, Start, Turn};
use recrash_roads::Scenario;
use recrash_sim::{Controls, Ego, Run, Seat, Snapshot, simulate};

use crate::common::{alone, checked, random_draft, roundabout, steady, wide_cross};

/// What one step shows to whoever drives.
#[derive(Debug, Clone, PartialEq)]
struct Shown {
    decided: Vec<ActorState>,
    observed: Vec<ActorState>,
    events: Vec<Event>,
    termination: Option<Termination>,
}

/// Steps a run to its end; an ego from outside does `controls(step)`.
fn drive(run: &mut Run, controls: impl Fn(u32) -> Option<Controls>) -> Vec<Shown> {
    let mut all = Vec::new();
    while run.termination().is_none() {
        let termination = run.step(controls(run.observe().step));
        let (decided, observed) = (run.decided().to_vec(), run.observe().states.to_vec());
        all.push(Shown { decided, observed, events: run.events().to_vec(), termination });
    }
    all
}

/// Wild, and the same at every call.
fn swerving(step: u32) -> Option<Controls> {
    let turn = f64::from(step % 23) / 11.0 - 1.0;
    Some(Controls { steer: 0.2 * turn, throttle: if step % 17 < 12 { 0.4 } else { -0.6 } })
}

/// Somebody from outside, or one of the simulator's own.
fn seats() -> impl Strategy<Value = Seat> {
    prop_oneof![
        Just(Seat::Outside),
        Just(Seat::BuiltIn(Ego::MetadriveIdm)),
        Just(Seat::BuiltIn(Ego::Idm)),
        Just(Seat::BuiltIn(Ego::Reference))
    ]
}

fn any_scenario(seed: u64, kind: usize, density: f64) -> Option<Scenario> {
    let mut draft = (0..20).find_map(|number| random_draft(seed, number))?;
    draft.traffic.density = density;
    draft.traffic.seed = seed;
    for (position, partner) in draft.partners.iter_mut().enumerate() {
        partner.kind = PartnerKind::ALL[(kind + position) % PartnerKind::ALL.len()];
    }
    recrash_roads::check(draft).ok().map(|checked| checked.value)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn from_every_snapshot_a_run_goes_on_with_the_same_bytes(
        seed in any::<u64>(), seat in seats(), kind in 0..13_usize, busy in any::<bool>(), every in 1..40_usize,
    ) {
        let Some(scenario) = any_scenario(seed, kind, if busy { 0.3 } else { 0.0 }) else { return Ok(()) };
        let controls = |step: u32| if seat == Seat::Outside { swerving(step) } else { None };
        let undisturbed = drive(&mut Run::new(&scenario, seat), controls);

        let mut run = Run::new(&scenario, seat);
        let mut kept: Vec<(usize, Snapshot)> = Vec::new();
        for step in 0..undisturbed.len() {
            if step % every == 0 {
                kept.push((step, run.snapshot()));
            }
            run.step(controls(step as u32));
        }
        // Back in the run that went on, and in one that has never seen the scenario.
        let mut other = Run::new(&checked(alone(roundabout(2), Turn::Straight, 1, 5.0, 5.0)), Seat::BuiltIn(Ego::Idm));
        for (step, snapshot) in kept.iter().rev() {
            for run in [&mut run, &mut other] {
                run.restore(snapshot);
                prop_assert_eq!(run.observe().step as usize, *step);
                prop_assert_eq!(run.events(), &[]);
                prop_assert_eq!(&drive(run, controls)[..], &undisturbed[*step..]);
            }
        }
    }
}

#[test]
fn stepped_from_outside_a_built_in_ego_drives_as_in_the_loop_of_the_simulator() {
    for draft in (0..200).filter_map(|number| random_draft(13, number)).take(10) {
        let scenario = checked(draft);
        for ego in Ego::DRIVERS {
            let rollout = simulate(&scenario, ego);
            let mut run = Run::new(&scenario, Seat::BuiltIn(ego));
            let shown = drive(&mut run, |_| None);
            assert_eq!(shown.len() + 1, rollout.steps());
            for (actor, track) in rollout.actors.iter().enumerate() {
                let states = shown.iter().map(|shown| shown.decided[actor]).chain([run.observe().states[actor]]);
                assert_eq!(states.collect::<Vec<_>>(), track.states);
            }
            let events: Vec<Event> = shown.iter().flat_map(|shown| shown.events.clone()).collect();
            assert_eq!(events, rollout.events);
            assert_eq!(run.termination(), Some(rollout.termination));
        }
    }
}

#[test]
fn a_copy_goes_its_own_way() {
    let scenario = checked(alone(wide_cross(2), Turn::Straight, 1, 8.0, 8.0));
    let mut run = Run::new(&scenario, Seat::Outside);
    for _ in 0..10 {
        run.step(None);
    }
    let mut braking = run.clone();
    for _ in 0..20 {
        run.step(None);
        braking.step(Some(Controls { steer: 0.0, throttle: -1.0 }));
    }
    assert_eq!(braking.observe().states[0].speed(), 0.0);
    // 8 m/s less 3 s of rolling resistance, 0.36 m/s^2.
    assert!((run.observe().states[0].speed() - 6.91).abs() < 0.05, "{:?}", run.observe().states[0]);
}

#[test]
fn a_reset_run_is_as_a_new_one_also_while_its_last_snapshot_lives() {
    let drafts: Vec<_> = (0..200).filter_map(|number| random_draft(14, number)).take(6).collect();
    let mut run = Run::new(&checked(drafts[0].clone()), Seat::Outside);
    let mut kept = Vec::new();
    for draft in drafts {
        let scenario = checked(draft);
        run.step(swerving(0));
        kept.push((run.snapshot(), drive(&mut run.clone(), swerving)));
        run.reset(&scenario, Seat::BuiltIn(Ego::Idm));
        assert_eq!(drive(&mut run, |_| None), drive(&mut Run::new(&scenario, Seat::BuiltIn(Ego::Idm)), |_| None));
    }
    for (snapshot, expected) in kept {
        run.restore(&snapshot);
        assert_eq!(drive(&mut run, swerving), expected);
    }
}

#[test]
fn controls_overrule_a_built_in_ego() {
    let scenario = checked(alone(wide_cross(2), Turn::Straight, 1, 8.0, 8.0));
    let mut run = Run::new(&scenario, Seat::BuiltIn(Ego::Idm));
    for _ in 0..10 {
        run.step(Some(Controls { steer: 0.0, throttle: -1.0 }));
        assert_eq!(run.decided()[0].throttle, -1.0);
    }
    assert_eq!(run.observe().states[0].speed(), 0.0);
    // Then it drives again.
    let shown = drive(&mut run, |_| None);
    assert_eq!(shown.last().and_then(|shown| shown.termination).map(|end| end.kind), Some(TerminationKind::Arrived));
}

#[test]
fn a_run_that_has_ended_stays_as_it_is() {
    let mut draft = alone(wide_cross(2), Turn::Straight, 1, 8.0, 8.0);
    draft.duration_s = 2.0;
    let mut run = Run::new(&checked(draft), Seat::BuiltIn(Ego::Idm));
    let end = drive(&mut run, |_| None).last().and_then(|shown| shown.termination);
    assert_eq!(end, Some(Termination { kind: TerminationKind::Timeout, time_s: 2.0 }));
    let states = run.observe().states.to_vec();
    assert_eq!((states[0].steer, states[0].throttle), (0.0, 0.0));
    assert_eq!(run.step(swerving(0)), end);
    assert_eq!((run.observe().step, run.observe().states), (20, &states[..]));
}

#[test]
fn neither_step_nor_observe_nor_restore_allocates() {
    let mut busy = alone(roundabout(2), Turn::Straight, 1, 5.0, 5.0);
    busy.traffic.density = 0.3;
    let mut crossing = alone(wide_cross(2), Turn::Straight, 1, 8.0, 8.0);
    crossing.partners.push(steady(Approach::Left, Turn::Straight, Start::ArrivalGap { arrival_gap_s: 0.0 }, 8.0));
    for scenario in [checked(busy), checked(crossing)] {
        for seat in [Seat::Outside].into_iter().chain(Ego::DRIVERS.map(Seat::BuiltIn)) {
            let mut run = Run::new(&scenario, seat);
            let start = run.snapshot();
            let mut travelled = 0.0;
            let counted = allocation_counter::measure(|| {
                for _ in 0..2 {
                    while run.termination().is_none() {
                        travelled += run.observe().states[0].speed();
                        run.step(None);
                        travelled += run.events().len() as f64;
                    }
                    run.restore(&start);
                }
            });
            assert_eq!(counted.count_total, 0, "{seat:?}");
            assert!(travelled > 0.0);
        }
    }
}

#[test]
fn runs_and_snapshots_go_from_thread_to_thread() {
    fn shared<T: Send + Sync + Clone>() {}
    shared::<Run>();
    shared::<Snapshot>();
}

#[test]
fn a_vehicle_in_a_bend_does_not_move_where_it_points() {
    let mut run = Run::new(&checked(alone(wide_cross(2), Turn::Straight, 1, 3.0, 3.0)), Seat::Outside);
    for _ in 0..12 {
        run.step(Some(Controls { steer: 0.1, throttle: 0.1 }));
    }
    let ego = run.observe().states[0];
    // The rear axle rolls along; the centre, 1.4166 m before it, moves to the left of the axle: sin(slip) = 1.4166 / R, and R is
    // 35.6 m: 2.28 degrees, as in MetaDrive to 0.2.
    let slip = ego.velocity().turned(-ego.heading);
    let degrees = (slip.y / slip.x) * 180.0 / std::f64::consts::PI;
    assert!((degrees - 2.28).abs() < 0.2, "{degrees}");
    assert!(ego.speed() < ego.velocity().length());
}
