//! Where the built-in egos have to stand: at red signals, stop signs, and the stops of their task.
//!
//! It is one rule for all of them, laid over what they would do otherwise: braking begins where a comfortable deceleration
//! suffices. Equations: `docs/models/control.md`.

use crate::chassis::Controls;
use crate::world::{Errand, Setting, State};
use recrash_model::math;
use recrash_model::scenario::{Aspect, Device};
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::constants::{
    HALT_MPS2, HALT_SHORT_M, PASSED_LINE_M, PULL_OVER_M, SIGN_STEPS, STANDING_MPS, STRAIGHT_BEFORE_M, YELLOW_MPS2,
};
use recrash_plan::hold_still;

/// The distance to the nearest place where it must stand now. [m]
pub(crate) fn nearest(setting: &Setting, state: &mut State, s_m: f64, speed_mps: f64) -> Option<f64> {
    let mut nearest: Option<f64> = None;
    let mut halt = |distance_m: f64| nearest = Some(nearest.map_or(distance_m, |least| least.min(distance_m)));
    let stands = speed_mps < STANDING_MPS;
    let errand = &mut state.errand;
    let mut at_sign = false;
    for line in &setting.ego_lines {
        let distance_m = line.at_m - s_m;
        if distance_m < -PASSED_LINE_M {
            continue;
        }
        let must_stand_first = match (&setting.control[line.control], state.signals[line.control]) {
            (Device::YieldSign {}, _) | (_, Some(Aspect::Green | Aspect::Dark)) => continue,
            (_, Some(Aspect::Yellow)) => {
                if math::sq(speed_mps) > 2.0 * YELLOW_MPS2 * distance_m.max(0.1) || distance_m < -HALT_SHORT_M {
                    continue;
                }
                false
            }
            (_, Some(Aspect::Red)) => {
                // Who is over the line goes on.
                if distance_m < -HALT_SHORT_M {
                    continue;
                }
                false
            }
            (_, Some(Aspect::FlashingRed) | None) => true,
        };
        if must_stand_first {
            if errand.free_to_m.is_some_and(|free_m| line.at_m <= free_m) {
                continue;
            }
            if stands && distance_m < 1.0 {
                errand.stood_at_sign += u32::from(!at_sign);
                at_sign = true;
                if errand.stood_at_sign >= SIGN_STEPS {
                    errand.free_to_m = Some(line.at_m);
                    continue;
                }
            }
        }
        halt(distance_m);
    }
    if !at_sign {
        errand.stood_at_sign = 0;
    }
    if let Some(distance_m) = next_stop(setting, errand, s_m, stands) {
        halt(distance_m);
    }
    nearest
}

/// The distance to the next stop of its task; counts how long it stands there. [m]
fn next_stop(setting: &Setting, errand: &mut Errand, s_m: f64, stands: bool) -> Option<f64> {
    let stop = setting.stops.get(usize::from(errand.stops_done))?;
    let distance_m = stop.s_m - s_m;
    if distance_m < -5.0 {
        (errand.stops_done, errand.stood_steps) = (errand.stops_done + 1, 0);
        return None;
    }
    if stands && distance_m < 1.0 {
        errand.stood_steps += 1;
        if stop.for_s.is_some_and(|for_s| f64::from(errand.stood_steps) * 0.1 >= for_s) {
            (errand.stops_done, errand.stood_steps) = (errand.stops_done + 1, 0);
            return None;
        }
    } else {
        errand.stood_steps = 0;
    }
    Some(distance_m)
}

/// Whether it stands where its task ends.
pub(crate) fn stays(setting: &Setting, state: &State) -> bool {
    let stop = setting.stops.get(usize::from(state.errand.stops_done));
    stop.is_some_and(|stop| stop.for_s.is_none()) && state.errand.stood_steps > 0
}

/// How far to the right of its lane's centre its task wants it here. [m]
pub(crate) fn pull_over_m(setting: &Setting, errand: &Errand, s_m: f64) -> f64 {
    let number = usize::from(errand.stops_done);
    let towards = |distance_m: f64| 1.0 - ((distance_m - STRAIGHT_BEFORE_M) / PULL_OVER_M).clamp(0.0, 1.0);
    let smooth = |x: f64| x * x * (3.0 - 2.0 * x);
    let next = setting.stops.get(number).map_or(0.0, |stop| stop.t_m * smooth(towards(stop.s_m - s_m)));
    let last = number.checked_sub(1).and_then(|last| setting.stops.get(last));
    let leaving = last.map_or(0.0, |stop| stop.t_m * smooth(towards(s_m - stop.s_m)));
    if next.abs() >= leaving.abs() { next } else { leaving }
}

/// Controls that also lead to a stand at a place this far ahead [m], braking by no more than the driver does anywhere.
pub(crate) fn before(
    controls: Controls,
    distance_m: f64,
    speed_mps: f64,
    spec: &VehicleSpec,
    hardest_mps2: f64,
) -> Controls {
    let left_m = distance_m - HALT_SHORT_M;
    let hardest = -hardest_mps2 / spec.brake_demand_mps2;
    if left_m <= 0.0 || (speed_mps < STANDING_MPS && left_m < 0.5) {
        return Controls { throttle: controls.throttle.min(hold_still(speed_mps).max(hardest)), ..controls };
    }
    let needed = math::sq(speed_mps) / (2.0 * left_m);
    // It never comes to the place faster than a comfortable stop allows.
    let allowed_mps = (2.0 * HALT_MPS2 * left_m).sqrt();
    if needed < 0.9 * HALT_MPS2 && speed_mps < 0.95 * allowed_mps {
        return controls;
    }
    let braking = (-needed / spec.brake_demand_mps2).max(hardest);
    Controls { throttle: controls.throttle.min(braking), ..controls }.clipped()
}
