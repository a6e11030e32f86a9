//! The speeds of one side until the contact, as plain as they come: it stands, slows, gains speed or sets off.

use crate::told::side::Side;
use crate::told::speeds::{GAINS_MPS, STARTS_AND_SLOWS_MPS};
use crate::usual::HARD_MPS2;
use recrash_model::account::ContactState;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{Act, Deed, Trigger};

/// Deceleration of who comes to a stop before it is hit. [m/s^2]
pub(crate) const STOPPING_MPS2: f64 = 2.0;

/// Acceleration of who sets off. [m/s^2]
pub(crate) const SETS_OFF_MPS2: f64 = 1.2;

/// Acceleration of who stood before, and is under way at the contact. [m/s^2]
const STARTS_MPS2: f64 = 1.6;

/// Who backs no faster than this at the contact has come so far. [m/s, m]
const BACKS_SLOWLY_MPS: f64 = 0.6;
const BACKS_M: f64 = 1.5;

/// Nobody takes longer to set off. [s]
const LONGEST_START_S: f64 = 6.0;

/// The speeds of one side until the contact: speed at the start, acts, and what is driven until then. [m/s, m]
#[derive(Clone)]
pub(crate) struct Pace {
    pub(crate) speed_mps: f64,
    pub(crate) acts: Vec<Act>,
    pub(crate) driven_m: f64,
}

/// Stands from the start.
pub(crate) const STANDING: Pace = Pace { speed_mps: 0.0, acts: Vec::new(), driven_m: 0.0 };

pub(crate) fn when(time_s: f64, deed: Deed) -> Act {
    Act { id: None, when: Some(Trigger::TimeS(time_s)), delay_s: 0.0, deed }
}

pub(crate) fn next(deed: Deed) -> Act {
    Act { id: None, when: None, delay_s: 0.0, deed }
}

pub(crate) fn first_time(acts: &[Act]) -> f64 {
    acts.iter()
        .find_map(|act| match act.when {
            Some(Trigger::TimeS(time_s)) => Some(time_s),
            _ => None,
        })
        .unwrap_or(0.0)
}

/// When somebody has yet to drive so far to the contact. [s]
pub(crate) fn time_before(contact_s: f64, pace: &Pace, left_m: f64) -> f64 {
    let steps = (contact_s / STEP_S).round() as usize;
    let (mut speed_mps, mut driven_m) = (pace.speed_mps, vec![0.0]);
    for step in 0..steps {
        let begun = pace.acts.iter().rfind(|act| first_time(std::slice::from_ref(act)) <= STEP_S * step as f64 + 1e-9);
        if let Some(Deed::Speed { to_mps, rate_mps2 }) = begun.map(|act| act.deed.clone()) {
            let by_mps = rate_mps2 * STEP_S;
            speed_mps += (to_mps - speed_mps).clamp(-by_mps, by_mps);
        }
        driven_m.push(driven_m[step] + speed_mps * STEP_S);
    }
    let from = driven_m.iter().position(|driven| driven_m[steps] - driven <= left_m).unwrap_or(0);
    STEP_S * from as f64
}

/// From a stand to a speed within a distance, or less.
pub(crate) fn sets_off(contact_s: f64, speed_mps: f64, within_m: f64) -> Pace {
    let moving_s =
        ((2.0 * within_m / speed_mps.max(0.05)).min(speed_mps / SETS_OFF_MPS2) * 10.0).floor().max(2.0) / 10.0;
    let rate_mps2 = (speed_mps / moving_s).clamp(0.05, 8.0);
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m: 0.5 * speed_mps * moving_s }
}

/// How somebody's speed comes to what it is at the contact.
pub(crate) fn pace(contact_s: f64, side: &Side, rolling_mps: f64, stood_s: f64) -> Pace {
    match side.state {
        ContactState::Parked => STANDING,
        ContactState::Stopped => {
            let braking_s = rolling_mps / STOPPING_MPS2;
            let from_s = ((contact_s - stood_s - braking_s) * 10.0).floor() / 10.0;
            let driven_m = rolling_mps * from_s + 0.5 * rolling_mps * braking_s;
            let acts = vec![
                when(from_s, Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None }),
                next(Deed::Hold { for_s: None }),
            ];
            Pace { speed_mps: rolling_mps, acts, driven_m }
        }
        ContactState::Moving if side.slowed_from.is_some() && (side.stood_first || !side.phases.is_empty()) => {
            starts_and_slows(contact_s, side.speed_mps, 0.0).unwrap_or_else(|| slows(contact_s, side))
        }
        ContactState::Moving if side.stood_first || !side.phases.is_empty() => {
            let moving_s = ((side.speed_mps / STARTS_MPS2).min(LONGEST_START_S) * 10.0).ceil().max(5.0) / 10.0;
            let go = Deed::Speed { to_mps: side.speed_mps, rate_mps2: side.speed_mps / moving_s };
            let driven_m = 0.5 * side.speed_mps * moving_s;
            Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m }
        }
        // Who backs this slowly is seen to.
        ContactState::Reversing if side.speed_mps <= BACKS_SLOWLY_MPS => {
            start_over(contact_s, side.speed_mps, BACKS_M).unwrap_or(STANDING)
        }
        ContactState::SettingOff | ContactState::Reversing => {
            // So that it sets off at a step: the rate gives way.
            let moving_s = ((side.speed_mps / SETS_OFF_MPS2).min(LONGEST_START_S) * 10.0).ceil().max(5.0) / 10.0;
            let rate_mps2 = (side.speed_mps / moving_s).max(0.05);
            let driven_m = 0.5 * side.speed_mps * moving_s;
            let go = Deed::Speed { to_mps: side.speed_mps, rate_mps2 };
            Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m }
        }
        ContactState::Moving if side.slowed_from.is_some() => slows(contact_s, side),
        ContactState::Moving if side.gains => gains(contact_s, side.speed_mps),
        ContactState::Moving => {
            Pace { speed_mps: side.speed_mps, acts: Vec::new(), driven_m: side.speed_mps * contact_s }
        }
    }
}

/// The same of who brakes hard: as late as it comes to the same speed at the same time, from farther off.
pub(crate) fn braked_hard(pace: Pace) -> Pace {
    let mut from_mps = pace.speed_mps;
    let mut last = None;
    for (number, act) in pace.acts.iter().enumerate() {
        let (to_mps, rate_mps2) = match act.deed {
            Deed::Speed { to_mps, rate_mps2 } => (to_mps, rate_mps2),
            Deed::Stop { rate_mps2, .. } => (0.0, rate_mps2),
            _ => continue,
        };
        if to_mps < from_mps && rate_mps2 < HARD_MPS2 {
            last = Some((number, from_mps, to_mps, rate_mps2));
        }
        from_mps = to_mps;
    }
    let Some((number, from_mps, to_mps, rate_mps2)) = last else { return pace };
    let by_mps = from_mps - to_mps;
    let later_s = (by_mps * (rate_mps2.recip() - HARD_MPS2.recip()) * 10.0).floor() / 10.0;
    let Some(Trigger::TimeS(from_s)) = pace.acts[number].when else { return pace };
    let rate_mps2 = by_mps / (by_mps / rate_mps2 - later_s);
    let deed = match pace.acts[number].deed {
        Deed::Stop { at_m, .. } => Deed::Stop { rate_mps2, at_m },
        _ => Deed::Speed { to_mps, rate_mps2 },
    };
    let mut acts = pace.acts;
    acts[number] = when(from_s + later_s, deed);
    Pace { acts, driven_m: pace.driven_m + 0.5 * later_s * by_mps, ..pace }
}

/// It brakes down to its speed at the contact.
pub(crate) fn slows(contact_s: f64, side: &Side) -> Pace {
    let (usual_mps, rate_mps2) = if side.reacts { (REACTS_BY_MPS, REACTS_MPS2) } else { (SLOWS_BY_MPS, SLOWS_MPS2) };
    let told_mps = side.slowed_from.and_then(|slowed| slowed.0).filter(|from| *from > side.speed_mps + 1.0);
    let from_mps = told_mps.unwrap_or(side.speed_mps + usual_mps).min(side.speed_mps + MOST_SLOWED_MPS);
    let by_mps = from_mps - side.speed_mps;
    let braking_s = (by_mps / rate_mps2 * 10.0).ceil() / 10.0;
    let brake = Deed::Speed { to_mps: side.speed_mps, rate_mps2: by_mps / braking_s };
    let on_s = if side.slowed_early { GOES_ON_S } else { 0.0 };
    let brakes_s = contact_s - on_s - braking_s;
    let driven_m = from_mps * brakes_s + 0.5 * (from_mps + side.speed_mps) * braking_s + side.speed_mps * on_s;
    Pace { speed_mps: from_mps, acts: vec![when(brakes_s, brake)], driven_m }
}

/// Who slowed, and then went on slowly, has done so for so long at the contact. [s]
const GOES_ON_S: f64 = 2.5;

/// It comes along as fast as the ego does, slows when that does, and goes on slowly.
pub(crate) fn slows_abreast(contact_s: f64, speed_mps: f64, ego: &Pace) -> Pace {
    let (from_s, by_mps) = (first_time(&ego.acts), ego.speed_mps - speed_mps);
    let braking_s = (by_mps / STOPPING_MPS2).min(contact_s - from_s);
    let brake = Deed::Speed { to_mps: speed_mps, rate_mps2: by_mps / braking_s };
    let driven_m = ego.speed_mps * from_s
        + 0.5 * (ego.speed_mps + speed_mps) * braking_s
        + speed_mps * (contact_s - from_s - braking_s);
    Pace { speed_mps: ego.speed_mps, acts: vec![when(from_s, brake)], driven_m }
}

/// At a speed, and then to a stop: so far.
pub(crate) fn stops_over(speed_mps: f64, driven_m: f64) -> Option<Pace> {
    let braking_s = speed_mps / STOPPING_MPS2;
    let from_s = driven_m / speed_mps - 0.5 * braking_s;
    let stop = when(from_s, Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None });
    let acts = vec![stop, next(Deed::Hold { for_s: None })];
    (from_s > 0.0).then_some(Pace { speed_mps, acts, driven_m })
}

/// From a stand up to more than its speed at the contact, and down to that: so far, by less where that takes farther, or as far as the
/// usual takes.
pub(crate) fn starts_and_slows(contact_s: f64, speed_mps: f64, driven_m: f64) -> Option<Pace> {
    let by_less = [1.0, 0.75, 0.5].map(|share| share * STARTS_AND_SLOWS_MPS);
    let least = |by_mps: f64| {
        let from_mps = speed_mps + by_mps;
        let gaining_s = (from_mps / STARTS_MPS2 * 10.0).ceil() / 10.0;
        let braking_s = (by_mps / SLOWS_MPS2 * 10.0).ceil() / 10.0;
        let least_m = 0.5 * from_mps * gaining_s + 0.5 * (from_mps + speed_mps) * braking_s;
        (from_mps, gaining_s, braking_s, least_m)
    };
    let fits = by_less.into_iter().find(|by_mps| least(*by_mps).3 <= driven_m).unwrap_or(STARTS_AND_SLOWS_MPS);
    let (from_mps, gaining_s, braking_s, least_m) = least(fits);
    let keeps_s = ((driven_m.max(least_m) - least_m) / from_mps * 10.0).round() / 10.0;
    let begins_s = contact_s - gaining_s - keeps_s - braking_s;
    let acts = vec![
        when(begins_s, Deed::Speed { to_mps: from_mps, rate_mps2: from_mps / gaining_s }),
        when(contact_s - braking_s, Deed::Speed { to_mps: speed_mps, rate_mps2: fits / braking_s }),
    ];
    let driven_m = least_m + from_mps * keeps_s;
    (begins_s > 1.0).then_some(Pace { speed_mps: 0.0, acts, driven_m })
}

/// It gains speed until the contact.
fn gains(contact_s: f64, speed_mps: f64) -> Pace {
    let by_mps = GAINS_MPS.min(0.5 * speed_mps);
    let (from_mps, gaining_s) = (speed_mps - by_mps, (by_mps / STARTS_MPS2 * 10.0).ceil() / 10.0);
    let gain = Deed::Speed { to_mps: speed_mps, rate_mps2: by_mps / gaining_s };
    let driven_m = from_mps * (contact_s - gaining_s) + 0.5 * (from_mps + speed_mps) * gaining_s;
    Pace { speed_mps: from_mps, acts: vec![when(contact_s - gaining_s, gain)], driven_m }
}

/// Who slowed before the contact came faster by so much where nobody says from which speed, at most so much, and brakes so. [m/s, m/s,
/// m/s^2]
const SLOWS_BY_MPS: f64 = 4.0;
const MOST_SLOWED_MPS: f64 = 12.0;
const SLOWS_MPS2: f64 = 2.5;

/// The same of who brakes hard because another turns across its way. [m/s, m/s^2]
const REACTS_BY_MPS: f64 = 3.0;
const REACTS_MPS2: f64 = 5.0;

/// From a stand to a speed, and so far: it gains its speed on the way, or earlier and keeps it.
pub(crate) fn start_over(contact_s: f64, speed_mps: f64, driven_m: f64) -> Option<Pace> {
    if driven_m < 0.3 {
        return None;
    }
    let rate_mps2 = (0.5 * speed_mps * speed_mps / driven_m).max(SETS_OFF_MPS2);
    let gaining_s = speed_mps / rate_mps2;
    let moving_s = gaining_s + (driven_m - 0.5 * speed_mps * gaining_s) / speed_mps;
    if moving_s > contact_s - 1.0 || rate_mps2 > STRONGEST_START_MPS2 {
        return None;
    }
    // It sets off at a step.
    let from_s = ((contact_s - moving_s) * 10.0).round() / 10.0;
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Some(Pace { speed_mps: 0.0, acts: vec![when(from_s, go)], driven_m })
}

/// From a stand to a speed, so far and in so long.
pub(crate) fn start_after(contact_s: f64, speed_mps: f64, driven_m: f64, moving_s: f64) -> Option<Pace> {
    let moving_s = (moving_s * 10.0).floor() / 10.0;
    let gaining_s = 2.0 * (moving_s - driven_m / speed_mps);
    let rate_mps2 = speed_mps / gaining_s;
    if !(0.1..=moving_s).contains(&gaining_s) || rate_mps2 > STRONGEST_START_MPS2 || moving_s > contact_s - 1.0 {
        return None;
    }
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Some(Pace { speed_mps: 0.0, acts: vec![when(contact_s - moving_s, go)], driven_m })
}

/// Nobody sets off harder. [m/s^2]
const STRONGEST_START_MPS2: f64 = 5.0;
