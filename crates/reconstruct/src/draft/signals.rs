//! Signals and signs, drawn as they are told.

use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::phase::Phase as Step;
use crate::told::side::{Side, Turning};
use recrash_model::account::{
    ContactState, Control as Said, ControlDevice, LeftRight, Obeyed, Origin, SignalState, StandReason,
};
use recrash_model::scenario::{Actor, ActorPlan, Aspect, Control, Deed, Device, Phase, StripKind, Trigger};
use recrash_model::template::Movement;

/// Longest phase. [s]
const ALWAYS_S: f64 = 600.0;

/// What has just changed has changed for so long at the contact: where the other waits for it, and where it drives on. [s]
const CHANGED_S: f64 = 3.0;
const CHANGED_BEFORE_DRIVING_S: f64 = 7.5;

/// A yellow light; the longest that there is, and the shortest, for who brakes for it. [s]
const YELLOW_S: f64 = 4.0;
const LONGEST_YELLOW_S: f64 = 5.0;
const SHORT_YELLOW_S: f64 = 3.0;

/// A light has turned yellow so long before who stops for it brakes, and is red so long before the contact at the latest. [s]
const YELLOW_BEFORE_BRAKING_S: f64 = 0.5;
const RED_BEFORE_CONTACT_S: f64 = 0.5;

/// Who came to a stop at red is seen to stand at red for so long, where there is time for it; and a light is green so long before the
/// first of the queue sets off, and before the contact, at the latest. [s]
const STANDS_AT_RED_S: f64 = 1.0;
const GREEN_AT_LEAST_S: f64 = 0.2;

/// The arm by which the partner comes. What stood before a driveway, a stall or the kerb is at no arm; at the ego's it would be a sign
/// that nobody told.
pub(crate) const fn arm_of(origin: Origin) -> &'static str {
    match origin {
        Origin::Cross { side: LeftRight::Left } => "left-",
        Origin::Cross { side: LeftRight::Right } => "right-",
        Origin::Opposite => "ahead-",
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } => "own-",
        _ => "",
    }
}

/// The devices that are told, and on the other arms what goes with them.
pub(crate) fn devices(told: &Told, ground: &Ground, ego: &ActorPlan, actors: &[Actor]) -> Vec<Control> {
    if !ground.junction {
        return Vec::new();
    }
    let cp_arm = arm_of(told.origin);
    let crosses = matches!(cp_arm, "left-" | "right-");
    let at = |arm: &str, device: Device| Control { at: arm.to_owned(), set_back_m: 0.0, lanes: Vec::new(), device };
    let said = [("own-", &told.sv), (cp_arm, &told.cp)]
        .map(|(arm, side)| side.control.filter(|_| !arm.is_empty()).map(|said| (arm, side, said)));
    // Nobody comes to a line of a street that is one-way.
    let leads_in = |arm: &str| {
        let road = ground.map.roads.iter().find(|road| arm.strip_suffix('-') == Some(road.id.as_str()));
        road.is_some_and(|road| road.left.iter().any(|strip| strip.kind == StripKind::Driving))
    };
    let mut list: Vec<Control> = Vec::new();
    for (arm, _, said) in said.iter().flatten() {
        let device = match said.device {
            ControlDevice::Signal => continue,
            ControlDevice::StopSign => Device::StopSign {},
            ControlDevice::YieldSign => Device::YieldSign {},
        };
        if !list.iter().any(|control| control.at == *arm) {
            list.push(at(arm, device));
        }
    }
    // At a stop that is told to be one for all there is a sign on every arm.
    if told.all_way && list.iter().any(|control| matches!(control.device, Device::StopSign {})) {
        for arm in ["own-", "ahead-", "left-", "right-"] {
            if leads_in(arm) && !list.iter().any(|control| control.at == arm) {
                list.push(at(arm, Device::StopSign {}));
            }
        }
    }
    let signal = |said: &Option<(&'static str, &Side, Said)>| {
        let (_, side, said) = said.as_ref().filter(|(_, _, said)| said.device == ControlDevice::Signal)?;
        let is_ego = std::ptr::eq(*side, &told.sv);
        // Who waits in the ego's lane, ahead of it or behind it, waits for the same light.
        let in_lane = matches!(told.origin, Origin::Ahead | Origin::Behind);
        // Nobody backs because it is green.
        let in_lane = in_lane && told.cp.state != ContactState::Reversing;
        let waits = |actor: &&Actor| actor.id == Role::Lead.id() || in_lane && actor.id == "cp";
        let others = actors.iter().filter(waits).map(|actor| &actor.plan);
        // Who stood ahead, set off, and backs since did the first because it was green.
        let stood = told.cp.phases.starts_with(&[Step::Stands, Step::Drives]) && told.origin == Origin::Ahead;
        let backed = actors.iter().filter(|actor| stood && actor.id == "cp").filter_map(|actor| goes_s(&actor.plan));
        // Nor did an ego that stands again when it turns green.
        let own = Some(ego).filter(|_| !told.green_late);
        let of_queue = others.chain(own).filter_map(sets_off_s).chain(backed);
        let first_s = of_queue.filter(|_| is_ego).reduce(f64::min);
        let yellow_s = first_s.filter(|at_s| told.contact_s - at_s < LONGEST_YELLOW_S);
        // Who sets off behind an ego that has yet to come to a stand, and stays, does not do so because it is green.
        let stays_s = halts(ego).pop().filter(|halt| halt.is_last && halt.stands_s < told.contact_s);
        let stays_s = stays_s.filter(|_| sets_off_s(ego).is_none()).map(|halt| halt.stands_s);
        let first_s = first_s.filter(|first_s| stays_s.is_none_or(|stays_s| stays_s + GREEN_BEFORE_S < *first_s));
        let changed_s = match first_s {
            Some(sets_off_s) => sets_off_s - GREEN_BEFORE_S,
            None if side.state.stands() => told.contact_s - CHANGED_S,
            None => told.contact_s - CHANGED_BEFORE_DRIVING_S,
        };
        let before_s = first_s.unwrap_or(told.contact_s);
        let halt = is_ego.then(|| halts(ego).into_iter().rfind(|halt| halt.stands_s < before_s)).flatten();
        // Who stood at red, and drives over its line without running it, does so at green; who changes lanes there stays before the line.
        let merges = matches!(told.sv.movement, Some(Movement::ChangingLanes | Movement::Merging)) && !told.enters();
        let drives_on = told.sv.state.stands() && told.sv.turning != Turning::No
            || told.sv.stood_first && said.obeyed == Some(Obeyed::Yes) && told.origin != Origin::Behind && !merges;
        let stood_there = is_ego && drives_on && said.state == Some(SignalState::Red) && told.keeps_red().is_none();
        let state = if stood_there && sets_off_s(ego).is_some() { Some(SignalState::TurnedGreen) } else { said.state };
        // Who turns right, and gives way to crossing traffic, does so at red.
        let crossed = actors.iter().any(|actor| actor.id == Role::Crosser.id());
        let on_red = is_ego && crossed && said.state.is_none() && said.obeyed.is_none();
        let state = if on_red && told.sv.turning == Turning::Right { Some(SignalState::Red) } else { state };
        // Before who stood ahead backs, which is told behind it.
        let backs = |actor: &&Actor| {
            told.origin == Origin::Ahead
                && told.cp.state == ContactState::Reversing
                && actor.id == "cp"
                && first_s.is_none()
        };
        let backs_s = actors.iter().find(backs).and_then(|actor| goes_s(&actor.plan));
        let latest_s = backs_s.map_or(before_s, |backs_s| backs_s.min(before_s)) - GREEN_AT_LEAST_S;
        let changed_s = halt.filter(|_| state == Some(SignalState::TurnedGreen)).map_or(changed_s, |halt| {
            // It stood at red first.
            changed_s.max((halt.stands_s + STANDS_AT_RED_S).min(latest_s))
        });
        let braking = halts(ego).pop().filter(|halt| is_ego && halt.is_last);
        match (braking, state) {
            (Some(halt), Some(SignalState::TurnedRed)) => Some(turns_red(halt.brakes_s, told.contact_s)),
            // Who entered at yellow, and brakes in the junction, came to it then.
            (Some(halt), Some(SignalState::Yellow)) if told.enters() => Some(turns_yellow(halt.brakes_s, YELLOW_S)),
            // Who stops for it does so when it has turned yellow.
            (Some(halt), Some(SignalState::Yellow)) if told.stops_at_yellow() => {
                Some(turns_yellow(halt.brakes_s, LONGEST_YELLOW_S))
            }
            // Who waited sets off when it turns yellow.
            (_, Some(SignalState::Yellow)) if let Some(goes_s) = yellow_s => {
                Some(turns_yellow(goes_s, LONGEST_YELLOW_S))
            }
            _ => Some(program(state, side, told.contact_s, changed_s.max(0.1))),
        }
    };
    let (own, other) = (signal(&said[0]), signal(&said[1]));
    if own.is_none() && other.is_none() {
        return list;
    }
    // Two arms that face each other show the same, and the other two the opposite.
    let along = own.clone().or_else(|| other.clone().map(|of| if crosses { opposite(&of) } else { of }));
    let across = other.clone().filter(|_| crosses).or_else(|| along.as_deref().map(opposite));
    // Who comes by an ego that waits at red has green: all others have red then.
    let comes_by = actors.iter().any(|actor| actor.id == Role::Oncoming.id());
    // So has a partner that comes from there to an ego in the queue.
    let comes_by = comes_by || told.comes_through_red();
    let waits = comes_by && told.reasons.contains(&StandReason::RedLight) && other.is_none();
    if waits {
        let program = |show: Aspect| Some(vec![Phase { show, for_s: ALWAYS_S }]);
        let arms = [("own-", along), ("ahead-", program(Aspect::Green))];
        let arms = arms.into_iter().chain(["left-", "right-"].map(|arm| (arm, program(Aspect::Red))));
        list.extend(
            arms.filter_map(|(arm, program)| Some(at(arm, Device::Signal { program: program?, offset_s: 0.0 }))),
        );
        return list;
    }
    // A light of its own that is told of who comes from ahead may show something else.
    let ahead = said[1].as_ref().filter(|(arm, ..)| *arm == "ahead-").and_then(|_| signal(&said[1]));
    // Nobody comes from there at green while the ego turns left on an arrow.
    let arrow = told.layout.arrow && told.sv.turning == Turning::Left && !comes_by;
    let ahead = ahead.or_else(|| arrow.then(|| vec![Phase { show: Aspect::Red, for_s: ALWAYS_S }]));
    for (arms, program) in [(["own-", "ahead-"], along), (["left-", "right-"], across)] {
        for arm in arms {
            let program = if arm == "ahead-" { ahead.as_ref().or(program.as_ref()) } else { program.as_ref() };
            if let Some(program) =
                program.cloned().filter(|_| leads_in(arm) && !list.iter().any(|control| control.at == arm))
            {
                list.push(at(arm, Device::Signal { program, offset_s: 0.0 }));
            }
        }
    }
    list
}

/// How somebody brakes by its plan.
#[derive(Clone, Copy)]
struct Halt {
    /// When it begins to, and when it stands; never where it drives on. [s]
    brakes_s: f64,
    stands_s: f64,
    /// It does not gain speed again.
    is_last: bool,
}

/// Every time that somebody brakes.
fn halts(plan: &ActorPlan) -> Vec<Halt> {
    let (mut list, mut speed_mps, mut free_s): (Vec<Halt>, f64, f64) = (Vec::new(), plan.speed_mps, 0.0);
    for act in &plan.acts {
        let begins_s = match act.when {
            Some(Trigger::TimeS(time_s)) => time_s,
            _ => free_s,
        };
        match act.deed {
            Deed::Stop { rate_mps2, at_m } if speed_mps > 0.0 => {
                let braking_s = speed_mps / rate_mps2;
                let brakes_s = begins_s + at_m.map_or(0.0, |at_m| (at_m / speed_mps - 0.5 * braking_s).max(0.0));
                free_s = brakes_s + braking_s;
                list.push(Halt { brakes_s, stands_s: free_s, is_last: true });
                speed_mps = 0.0;
            }
            Deed::Speed { to_mps, rate_mps2 } => {
                free_s = begins_s + (to_mps - speed_mps).abs() / rate_mps2;
                if let Some(halt) = list.last_mut().filter(|_| to_mps > speed_mps) {
                    halt.is_last = false;
                }
                if to_mps < speed_mps {
                    list.push(Halt { brakes_s: begins_s, stands_s: f64::MAX, is_last: true });
                }
                speed_mps = to_mps;
            }
            _ => {}
        }
    }
    list
}

/// A light that turns yellow for who then brakes, and red.
fn turns_red(brakes_s: f64, contact_s: f64) -> Vec<Phase> {
    let red_s = (brakes_s - YELLOW_BEFORE_BRAKING_S + SHORT_YELLOW_S).min(contact_s - RED_BEFORE_CONTACT_S);
    vec![
        Phase { show: Aspect::Green, for_s: (red_s - SHORT_YELLOW_S).max(0.1) },
        Phase { show: Aspect::Yellow, for_s: SHORT_YELLOW_S },
        Phase { show: Aspect::Red, for_s: ALWAYS_S },
    ]
}

/// A light that turns yellow right before somebody brakes who comes over its line nevertheless, or sets off.
fn turns_yellow(acts_s: f64, for_s: f64) -> Vec<Phase> {
    vec![
        Phase { show: Aspect::Green, for_s: (acts_s - YELLOW_BEFORE_BRAKING_S).max(0.1) },
        Phase { show: Aspect::Yellow, for_s },
        Phase { show: Aspect::Red, for_s: ALWAYS_S },
    ]
}

/// When the ego sets off last, where it does. [s]
fn sets_off_s(ego: &ActorPlan) -> Option<f64> {
    let (mut stands, mut last) = (ego.speed_mps == 0.0, None);
    for act in &ego.acts {
        match act.deed {
            Deed::Stop { .. } => stands = true,
            Deed::Speed { to_mps, .. } if to_mps > 0.0 && stands => {
                (stands, last) = (false, act.when.as_ref());
            }
            _ => {}
        }
    }
    match last? {
        Trigger::TimeS(time_s) => Some(*time_s),
        _ => None,
    }
}

/// When somebody that stands first sets off. [s]
fn goes_s(plan: &ActorPlan) -> Option<f64> {
    let goes = |act: &&recrash_model::scenario::Act| matches!(act.deed, Deed::Speed { to_mps, .. } if to_mps > 0.0);
    plan.acts.iter().find(goes).and_then(|act| match act.when {
        Some(Trigger::TimeS(time_s)) => Some(time_s),
        _ => None,
    })
}

/// A signal has turned green so long before the ego that waited for it sets off. [s]
const GREEN_BEFORE_S: f64 = 0.5;

/// A program that shows at the contact what is told.
fn program(state: Option<SignalState>, side: &Side, contact_s: f64, changed_s: f64) -> Vec<Phase> {
    let phase = |show: Aspect, for_s: f64| Phase { show, for_s };
    match state {
        Some(SignalState::Red) => vec![phase(Aspect::Red, ALWAYS_S)],
        Some(SignalState::Green) => vec![phase(Aspect::Green, ALWAYS_S)],
        Some(SignalState::TurnedGreen) => vec![phase(Aspect::Red, changed_s), phase(Aspect::Green, ALWAYS_S)],
        Some(SignalState::Yellow) => vec![
            phase(Aspect::Green, contact_s - 0.5 * YELLOW_S),
            phase(Aspect::Yellow, YELLOW_S),
            phase(Aspect::Red, ALWAYS_S),
        ],
        Some(SignalState::TurnedRed) => vec![
            phase(Aspect::Green, (changed_s - YELLOW_S).max(0.1)),
            phase(Aspect::Yellow, YELLOW_S),
            phase(Aspect::Red, ALWAYS_S),
        ],
        None if side.state.stands() => vec![phase(Aspect::Red, ALWAYS_S)],
        None => vec![phase(Aspect::Green, ALWAYS_S)],
    }
}

/// Red for green and the other way round.
fn opposite(program: &[Phase]) -> Vec<Phase> {
    let turned =
        |phase: &Phase| Phase { show: if phase.show == Aspect::Red { Aspect::Green } else { Aspect::Red }, ..*phase };
    program.iter().map(turned).collect()
}
