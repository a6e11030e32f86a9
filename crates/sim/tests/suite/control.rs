//! Signals, signs and stops: what is seen of them, who stands at them for how long, and how hard who brakes for them.

use crate::acts::signal;
use crate::common::{alone, checked, curve, straight};
use crate::gallery::ROOT;
use recrash_model::kinds::PartnerKind;
use recrash_model::narrative::Side;
use recrash_model::rollout::{Rollout, TerminationKind};
use recrash_model::scenario::{Aspect, Control, Device, Environment, MissionStop, ScenarioDraft, Turn};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_sim::{Controls, Ego, EmergencyResponse, Run, Seat, simulate};

/// An ego at 10 m/s with 100 m to a line.
fn towards(control: Control) -> ScenarioDraft {
    let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 10.0, 10.0);
    draft.ego.s_m = 57.7;
    draft.control.push(control);
    draft
}

/// The hardest braking that the ego asks for; what it does is no more, to what it loses all at once when it stands.
fn hardest_braking(rollout: &Rollout) -> f64 {
    let states = &rollout.ego_track().states;
    let full_mps2 = VehicleSpec::of(PartnerKind::PassengerCar).brake_demand_mps2;
    let asked = states.iter().map(|state| -state.throttle * full_mps2).fold(0.0, f64::max);
    let done = states.windows(2).map(|pair| (pair[0].speed() - pair[1].speed()) / 0.1).fold(0.0, f64::max);
    assert!(done < asked + 0.6, "{done} {asked}");
    asked
}

#[test]
fn an_ego_from_outside_sees_what_a_signal_shows_now() {
    let draft = towards(signal(&[(Aspect::Red, 6.0), (Aspect::Green, 60.0)]));
    let mut run = Run::new(&checked(draft), Seat::Outside);
    let snapshot = run.snapshot();
    for round in 0..2 {
        for step in 0..=61 {
            let shown = if step < 60 { Aspect::Red } else { Aspect::Green };
            assert_eq!(run.observe().step, step);
            assert_eq!(run.observe().signals, [Some(shown)], "round {round}, step {step}");
            run.step(Some(Controls { steer: 0.0, throttle: -1.0 }));
        }
        run.restore(&snapshot);
    }
}

#[test]
fn no_ego_of_ours_brakes_harder_than_its_model() {
    let dry = EmergencyResponse::UN_R157.deceleration_mps2;
    for (ego, hardest_mps2) in [(Ego::Reference, dry), (Ego::Idm, 8.0)] {
        for (surface, share) in [(Surface::Dry, 1.0), (Surface::Wet, 0.7)] {
            let hardest = |draft: ScenarioDraft| {
                let environment = Environment { surface, ..draft.environment };
                hardest_braking(&simulate(&checked(ScenarioDraft { environment, ..draft }), ego))
            };
            // Without yellow, red comes at any distance from the line.
            for tenths in 70..110 {
                let draft = towards(signal(&[(Aspect::Green, 0.1 * f64::from(tenths)), (Aspect::Red, 60.0)]));
                let found = hardest(draft);
                assert!(found <= share * hardest_mps2 + 1e-6, "{ego} {surface:?} red after {tenths}: {found}");
            }
            // Faster than it wants to be, on a straight road and into a curve.
            let fast = hardest(alone(straight(2, 300.0), Turn::Straight, 1, 20.0, 8.0));
            let into_curve = hardest(alone(curve(2, Side::Left), Turn::Straight, 1, 22.0, 12.0));
            for found in [fast, into_curve] {
                assert!(found <= share * hardest_mps2 + 1e-6, "{ego} {surface:?}: {fast} {into_curve}");
            }
            assert!(ego != Ego::Reference || fast <= share * 3.4 + 1e-6, "comfortably: {fast}");
        }
    }
}

#[test]
fn a_yield_sign_asks_for_no_stop_of_who_obeys_control() {
    let json = std::fs::read_to_string(format!("{ROOT}/control/12-others-obey.json")).unwrap();
    let mut draft = recrash_roads::read_draft(&json).unwrap().value;
    let least_speed = |draft: &ScenarioDraft| {
        let rollout = simulate(&checked(draft.clone()), Ego::Recorded);
        let track = rollout.actors.iter().find(|track| track.id == "at_sign").unwrap();
        track.states[..50].iter().map(|state| state.speed()).fold(f64::INFINITY, f64::min)
    };
    assert_eq!(least_speed(&draft), 0.0);
    draft.control[2].device = Device::YieldSign {};
    assert!((least_speed(&draft) - 6.0).abs() < 1e-6, "{}", least_speed(&draft));
}

#[test]
fn the_seventeenth_line_counts_as_the_first() {
    for ego in Ego::DRIVERS {
        let mut draft = towards(signal(&[(Aspect::Red, 90.0)]));
        let sign = Control { device: Device::YieldSign {}, ..draft.control[0].clone() };
        draft.control.splice(0..0, vec![sign; 16]);
        let states = &simulate(&checked(draft), ego).actors[0].states;
        let front = states.last().unwrap().x + 0.5 * 4.515;
        assert!(front <= 160.0 && front > 156.5, "{ego}: {front}");
    }
}

#[test]
fn a_stop_that_was_left_early_counts_for_no_other() {
    let mut draft = alone(straight(2, 300.0), Turn::Straight, 1, 8.0, 8.0);
    let stop = |s_m: f64, for_s: Option<f64>| MissionStop { s_m, t_m: 0.0, for_s };
    draft.ego.stops = vec![stop(40.0, Some(5.0)), stop(200.0, None)];
    draft.duration_s = 20.0;
    let mut run = Run::new(&checked(draft), Seat::Outside);
    let mut stood = 0;
    let ended = loop {
        let observation = run.observe();
        let (s_m, speed_mps) = (observation.route_s_m, observation.states[0].speed());
        stood += u32::from(speed_mps < 0.1);
        // It stands near the first stop for 2 of its 5 s, and drives on.
        let throttle = match stood {
            0..20 if s_m > 28.0 => -0.1,
            0..20 => 0.1,
            _ => 0.4,
        };
        if let Some(termination) = run.step(Some(Controls { steer: 0.0, throttle })) {
            break termination.kind;
        }
    };
    let observation = run.observe();
    assert!(stood >= 20 && observation.stops.len() == 1, "{stood}: it stood, and has left the first stop behind");
    assert!(observation.route_s_m < 195.0 && observation.states[0].speed() > 3.0);
    assert_eq!(ended, TerminationKind::Timeout);
}
