//! Promises about runs with another physics step: the same physics and the same decisions, a little differently rounded off.

use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{Rollout, Substeps, TerminationKind};
use recrash_model::scenario::{ScenarioDraft, Turn};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Simulator;
use recrash_sim::{Chassis, Controls, Ego, Native, Run, Seat, VehicleState, simulate};

use crate::common::{alone, checked, lead, random_draft, straight, trials};

const OTHERS: [u8; 3] = [4, 8, 10];

fn run_in(native: &Native, draft: &ScenarioDraft, substeps: u8) -> Rollout {
    native.run_in(&checked(draft.clone()), Substeps::new(substeps)).expect("it can").expect("it never fails")
}

/// Where a car is after controls held for so long, and how fast; what others see is a physics step late.
fn driven(substeps: u8, speed_mps: f64, seconds: f64, steer: f64, throttle: f64) -> (Pose, f64) {
    let substeps = Substeps::new(substeps);
    let chassis = Chassis::in_steps(&VehicleSpec::of(PartnerKind::PassengerCar), Surface::Dry, substeps);
    let mut state = VehicleState::new(Pose::default(), speed_mps);
    for _ in 0..(seconds * 10.0).round() as u32 {
        let command = state.command(&chassis, Controls { steer, throttle });
        for _ in 0..substeps.count() {
            state.advance(&chassis, &command);
        }
    }
    let position = state.pose.position + state.velocity() * substeps.step_s();
    (Pose { position, ..state.pose }, state.speed())
}

#[test]
fn five_physics_steps_are_the_usual_ones_bit_by_bit() {
    let native = Native::new(Ego::Idm);
    let random = (0..60).filter_map(|number| random_draft(19, number));
    for draft in trials().into_iter().chain(random) {
        let usual = simulate(&checked(draft.clone()), Ego::Idm);
        assert_eq!(run_in(&native, &draft, 5), usual, "{}", draft.id);
        // A runner that has just had another step is as good as new.
        run_in(&native, &draft, 8);
        assert_eq!(native.run(&checked(draft.clone())).expect("it never fails"), usual, "{}", draft.id);
    }
}

#[test]
fn another_step_is_the_same_physics() {
    for (name, speed, seconds, steer, throttle, tolerance_m) in [
        ("rolls", 20.0, 2.0, 0.0, 1e-12, 1e-9),
        ("speeds up", 5.0, 3.0, 0.0, 0.6, 0.06),
        ("brakes", 20.0, 3.0, 0.0, -0.5, 0.25),
        ("coasts", 10.0, 3.0, 0.0, 0.0, 0.06),
        ("turns", 8.0, 3.0, 0.2, 1e-12, 0.25),
    ] {
        let usual = driven(5, speed, seconds, steer, throttle);
        for substeps in OTHERS {
            let other = driven(substeps, speed, seconds, steer, throttle);
            let apart_m = other.0.position.distance(usual.0.position);
            println!("{name}, {substeps} steps: {apart_m:.3} m, {:.3} m/s", other.1 - usual.1);
            assert!(apart_m <= tolerance_m, "{name}, {substeps} steps: {apart_m} m");
            assert!((other.1 - usual.1).abs() < 0.1, "{name}, {substeps} steps");
        }
    }
}

#[test]
fn decisions_and_records_stay_at_a_tenth_of_a_second_and_contacts_are_timed_to_the_step() {
    let mut draft = alone(straight(1, 200.0), Turn::Straight, 0, 12.0, 12.0);
    draft.partners.push(lead(30.0, 2.0));
    let rolling = Controls { steer: 0.0, throttle: 1e-12 };
    for substeps in [5].into_iter().chain(OTHERS) {
        let mut run = Run::new(&checked(draft.clone()), Seat::Outside);
        run.reset_in(&checked(draft.clone()), Seat::Outside, Substeps::new(substeps));
        let mut contact_s = None;
        let mut steps = 0_u32;
        while run.termination().is_none() {
            assert!((run.observe().time_s - f64::from(steps) / 10.0).abs() < 1e-12);
            run.step(Some(rolling));
            steps += 1;
            contact_s = contact_s.or(run.events().first().map(|event| event.time_s));
        }
        let contact_s = contact_s.expect("it drives into who is slow ahead");
        assert_eq!(run.termination().map(|end| end.kind), Some(TerminationKind::Contact));
        let count = contact_s * 10.0 * f64::from(substeps);
        assert!((count - count.round()).abs() < 1e-9, "{contact_s} s is no whole number of steps");
        // Closing by 10 m/s over 30 m less a car.
        assert!((contact_s - 2.55).abs() < 0.2, "{substeps} steps: {contact_s} s");
    }
}

#[test]
fn a_snapshot_goes_on_in_its_own_steps() {
    let scenario = checked(trials().swap_remove(0));
    let mut run = Run::new(&scenario, Seat::BuiltIn(Ego::Idm));
    run.reset_in(&scenario, Seat::BuiltIn(Ego::Idm), Substeps::new(8));
    for _ in 0..20 {
        run.step(None);
    }
    let kept = run.snapshot();
    let mut other = Run::new(&scenario, Seat::BuiltIn(Ego::Idm));
    other.restore(&kept);
    while run.termination().is_none() {
        run.step(None);
        other.step(None);
        assert_eq!(run.observe().states, other.observe().states);
    }
    assert_eq!(run.termination(), other.termination());
}
