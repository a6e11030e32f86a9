//! What a told signal shows, and when that changes: by who waits for it, brakes for it and sets off.

use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::phase::Phase as Step;
use crate::told::side::{Side, Turning};
use recrash_model::account::{ContactState, Control as Said, Obeyed, Origin, SignalState};
use recrash_model::scenario::{Actor, ActorPlan, Aspect, Deed, Phase, Trigger};
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

/// The told signal of one of the two, and who drives as it shows.
pub(super) struct Light<'a> {
    pub(super) told: &'a Told,
    /// Whose it is, and whether that is the ego.
    pub(super) side: &'a Side,
    pub(super) is_ego: bool,
    pub(super) said: Said,
    pub(super) ego: &'a ActorPlan,
    pub(super) actors: &'a [Actor],
}

impl Light<'_> {
    /// Its phases.
    pub(super) fn program(&self) -> Vec<Phase> {
        let (told, state) = (self.told, self.state());
        let braking = halts(self.ego).pop().filter(|halt| self.is_ego && halt.is_last);
        let off_s = self.first_off_s().filter(|at_s| told.contact_s - at_s < LONGEST_YELLOW_S);
        match (braking, state) {
            (Some(halt), Some(SignalState::TurnedRed)) => turns_red(halt.brakes_s, told.contact_s),
            // Who entered at yellow, and brakes in the junction, came to it then.
            (Some(halt), Some(SignalState::Yellow)) if told.enters() => turns_yellow(halt.brakes_s, YELLOW_S),
            // Who stops for it does so when it has turned yellow.
            (Some(halt), Some(SignalState::Yellow)) if told.stops_at_yellow() => {
                turns_yellow(halt.brakes_s, LONGEST_YELLOW_S)
            }
            // Who waited sets off when it turns yellow.
            (_, Some(SignalState::Yellow)) if let Some(off_s) = off_s => turns_yellow(off_s, LONGEST_YELLOW_S),
            _ => program(state, self.side, told.contact_s, self.changed_s(state).max(0.1)),
        }
    }

    /// What it shows at the contact: as told, or as follows from what the ego does at it.
    fn state(&self) -> Option<SignalState> {
        let (sv, said) = (&self.told.sv, self.said);
        let red = said.state == Some(SignalState::Red);
        // Who stood at red, and drives over its line without running it, does so at green; who changes lanes there stays before the line.
        let merges = matches!(sv.movement, Some(Movement::ChangingLanes | Movement::Merging)) && !self.told.enters();
        let obeyed = said.obeyed == Some(Obeyed::Yes);
        let drives_on = sv.state.stands() && sv.turning != Turning::No
            || sv.stood_first && obeyed && self.told.origin != Origin::Behind && !merges;
        let stood_there = self.is_ego && drives_on && red && self.told.keeps_red().is_none();
        // Who turns right, and gives way to crossing traffic, does so at red.
        let crossed = self.actors.iter().any(|actor| actor.id == Role::Crosser.id());
        let untold = said.state.is_none() && said.obeyed.is_none();
        match self.is_ego && crossed && untold && sv.turning == Turning::Right {
            true => Some(SignalState::Red),
            false if stood_there && sets_off_s(self.ego).is_some() => Some(SignalState::TurnedGreen),
            false => said.state,
        }
    }

    /// When the first sets off of all who wait in the ego's lane for its light. [s]
    fn first_off_s(&self) -> Option<f64> {
        let told = self.told;
        // Who waits in the ego's lane, ahead of it or behind it, waits for the same light; nobody backs because it is green.
        let in_lane = matches!(told.origin, Origin::Ahead | Origin::Behind) && !self.partner_backs();
        let waits = |actor: &&Actor| actor.id == Role::Lead.id() || in_lane && actor.id == "cp";
        let others = self.actors.iter().filter(waits).map(|actor| &actor.plan);
        // Who stood ahead, set off, and backs since did the first because it was green.
        let stood = told.cp.phases.starts_with(&[Step::Stands, Step::Drives]) && told.origin == Origin::Ahead;
        let backed = self.actors.iter().filter(|actor| stood && actor.id == "cp");
        let backed = backed.filter_map(|actor| goes_s(&actor.plan));
        // Nor did an ego that stands again when it turns green.
        let own = Some(self.ego).filter(|_| !told.green_late);
        let of_queue = others.chain(own).filter_map(sets_off_s).chain(backed);
        of_queue.filter(|_| self.is_ego).reduce(f64::min)
    }

    /// Whether the partner reverses at the contact.
    fn partner_backs(&self) -> bool {
        self.told.cp.state == ContactState::Reversing
    }

    /// The same, where it does so because it is green: not behind an ego that has yet to come to a stand, and stays. [s]
    fn off_at_green_s(&self) -> Option<f64> {
        let stays_s = halts(self.ego).pop().filter(|halt| halt.is_last && halt.stands_s < self.told.contact_s);
        let stays_s = stays_s.filter(|_| sets_off_s(self.ego).is_none()).map(|halt| halt.stands_s);
        self.first_off_s().filter(|off_s| stays_s.is_none_or(|stays_s| stays_s + GREEN_BEFORE_S < *off_s))
    }

    /// When it changes to what it shows at the contact. [s]
    fn changed_s(&self, state: Option<SignalState>) -> f64 {
        let (told, off_s) = (self.told, self.off_at_green_s());
        let changed_s = match off_s {
            Some(off_s) => off_s - GREEN_BEFORE_S,
            None if self.side.state.stands() => told.contact_s - CHANGED_S,
            None => told.contact_s - CHANGED_BEFORE_DRIVING_S,
        };
        if !self.is_ego || state != Some(SignalState::TurnedGreen) {
            return changed_s;
        }
        let before_s = off_s.unwrap_or(told.contact_s);
        let Some(halt) = halts(self.ego).into_iter().rfind(|halt| halt.stands_s < before_s) else {
            return changed_s;
        };
        // Before who stood ahead backs, which is told behind it.
        let backs = told.origin == Origin::Ahead && self.partner_backs() && off_s.is_none();
        let cp = self.actors.iter().find(|actor| backs && actor.id == "cp");
        let backs_s = cp.and_then(|actor| goes_s(&actor.plan));
        let latest_s = backs_s.map_or(before_s, |backs_s| backs_s.min(before_s)) - GREEN_AT_LEAST_S;
        // It stood at red first.
        changed_s.max((halt.stands_s + STANDS_AT_RED_S).min(latest_s))
    }
}

/// One phase that never ends.
pub(super) fn always(show: Aspect) -> Vec<Phase> {
    vec![Phase { show, for_s: ALWAYS_S }]
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
pub(super) fn opposite(program: &[Phase]) -> Vec<Phase> {
    let turned =
        |phase: &Phase| Phase { show: if phase.show == Aspect::Red { Aspect::Green } else { Aspect::Red }, ..*phase };
    program.iter().map(turned).collect()
}
