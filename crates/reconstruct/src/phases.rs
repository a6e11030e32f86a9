//! What the ego did before the last thing that it does: it stood, moved up and stood again, or reversed first.

use crate::came::{CONTACT_S, Pace, first_time, when};
use crate::told::Told;
use recrash_model::account::{Act, ActFact, ContactState, Party};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::rollout::{ActorState, ActorTrack};
use recrash_model::scenario::{self, ActorPlan, Deed, Leg, Place};

/// A part of the way to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    Stands,
    Drives,
    Reverses,
}

impl Phase {
    /// What somebody does in this state at the contact.
    const fn of(state: ContactState) -> Self {
        match state {
            ContactState::Stopped | ContactState::Parked => Self::Stands,
            ContactState::Moving | ContactState::SettingOff => Self::Drives,
            ContactState::Reversing => Self::Reverses,
        }
    }

    const fn word(self) -> &'static str {
        match self {
            Self::Stands => "stood",
            Self::Drives => "drove",
            Self::Reverses => "reversed",
        }
    }
}

/// So many phases are drawn and checked, the last one counted.
const MOST_PHASES: usize = 3;

/// The last things that somebody is told to have done before the contact.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Phases {
    /// They end in what it does at the contact; empty where they say no more than the state there and that it came there or stood
    /// before.
    pub(crate) last: Vec<Phase>,
    /// It came driving before the first of them.
    pub(crate) came: bool,
}

/// What is told of them.
pub(crate) fn told(party: &Party, state: ContactState) -> Phases {
    let mut acts: Vec<&ActFact> = party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun).collect();
    acts.sort_by_key(|fact| fact.step);
    let mut list: Vec<Phase> = Vec::new();
    for fact in acts {
        let phase = match fact.act {
            Act::Stop | Act::Hold => Phase::Stands,
            Act::SetOff
            | Act::Accelerate
            | Act::Enter
            | Act::Cross
            | Act::LaneChange
            | Act::Swerve
            | Act::Pass
            | Act::Turn
            | Act::UTurn
            | Act::PullOut
            | Act::PullOver => Phase::Drives,
            // Of who stood, these tell how it came there.
            Act::Follow | Act::Slow if list.is_empty() => Phase::Drives,
            Act::Reverse => Phase::Reverses,
            _ => continue,
        };
        if list.last() != Some(&phase) {
            list.push(phase);
        }
    }
    // The state at the contact decides how it ends: what is told of who stands behind its last stop was a plan, and a stop that is
    // told last of who moves was not reached.
    let last = Phase::of(state);
    if last == Phase::Stands {
        let stands = list.iter().rposition(|phase| *phase == last).map_or(list.len(), |at| at + 1);
        list.truncate(stands);
    } else if list.ends_with(&[last, Phase::Stands]) {
        list.pop();
    }
    if list.last() != Some(&last) {
        list.push(last);
    }
    let mut last = list.split_off(list.len().saturating_sub(MOST_PHASES));
    let mut came = !list.is_empty();
    // Everybody came from somewhere.
    if last.first() == Some(&Phase::Drives) {
        (last, came) = (last.split_off(1), true);
    }
    let says_more = last.len() == MOST_PHASES || last[..last.len().saturating_sub(1)].contains(&Phase::Reverses);
    if says_more { Phases { last, came } } else { Phases::default() }
}

/// A phase that is shorter than this on the way from one gear to the other is none. [steps]
const LEAST_STEPS: usize = 4;

/// Slower than this is standing. [m/s]
const STANDS_MPS: f64 = 0.1;

/// The phases that somebody shows until a step.
fn shown(track: &ActorTrack, until: usize) -> Vec<Phase> {
    let phase = |state: &ActorState| match state.speed() {
        speed if speed > STANDS_MPS => Phase::Drives,
        speed if speed < -STANDS_MPS => Phase::Reverses,
        _ => Phase::Stands,
    };
    let mut runs: Vec<(Phase, usize)> = Vec::new();
    for state in &track.states[..=until.min(track.states.len() - 1)] {
        match runs.last_mut().filter(|(last, _)| *last == phase(state)) {
            Some((_, steps)) => *steps += 1,
            None => runs.push((phase(state), 1)),
        }
    }
    let last = runs.len() - 1;
    let mut list: Vec<Phase> = Vec::new();
    for (number, (phase, steps)) in runs.into_iter().enumerate() {
        if (steps >= LEAST_STEPS || number == last) && list.last() != Some(&phase) {
            list.push(phase);
        }
    }
    list
}

/// Whether somebody shows these phases last, and which it shows.
pub(crate) fn check(told: &[Phase], track: &ActorTrack, time_s: f64) -> (bool, String) {
    let shown = shown(track, (time_s * 10.0).floor() as usize);
    let seen = shown.split_at(shown.len().saturating_sub(told.len().max(1))).1;
    (shown.ends_with(told), words(seen))
}

/// For sentences.
pub(crate) fn words(phases: &[Phase]) -> String {
    phases.iter().map(|phase| phase.word()).collect::<Vec<_>>().join(", ")
}

/// Who moves up between two stands, or backs, gains this speed in so long, and loses it in so long. [m/s, s]
const MOVES_UP: (f64, f64) = (2.0, 1.7);
const BACKS_UP: (f64, f64) = (1.5, 1.2);
const BRAKES_S: f64 = 1.2;

/// It brakes for its first stop with so much: less than makes plans brake by themselves before they change gear. [m/s^2]
const BRAKES_MPS2: f64 = 1.8;

/// How far somebody moves up. [m]
pub(crate) const MOVES_UP_M: f64 = 0.5 * MOVES_UP.0 * (MOVES_UP.1 + BRAKES_S);

/// It stands for so long between, and it rolls for so long before it brakes for its first stop. [s]
const STANDS_S: f64 = 1.0;
const ROLLS_S: f64 = 0.3;

/// Who has no time to come from a distance stands from the start. [s]
const LEAST_APPROACH_S: f64 = 1.0;

/// How somebody came from its first stop to its last phase.
pub(crate) struct Lead {
    pub(crate) speed_mps: f64,
    pub(crate) acts: Vec<scenario::Act>,
    /// What is driven before the last phase, and whether in reverse, in order. [m]
    stretches: Vec<(f64, bool)>,
    /// It stands then: after it has reversed, or before it moves up. [s]
    stands_s: f64,
}

impl Lead {
    /// Whether it is also driven backwards.
    pub(crate) fn reverses(&self) -> bool {
        self.stretches.iter().any(|(_, reverse)| *reverse)
    }

    /// Forward all the way, and then the last pace.
    pub(crate) fn then(self, last: Pace) -> Pace {
        let before_m: f64 = self.stretches.iter().map(|(length_m, _)| length_m).sum();
        let acts = self.acts.into_iter().chain(last.acts).collect();
        Pace { speed_mps: self.speed_mps, acts, driven_m: before_m + last.driven_m }
    }

    /// When the system under test takes over: where the ego stands before it moves up, this late at most. No system reverses:
    /// where the ego did it is over then. [s]
    pub(crate) fn handover_s(&self, latest_s: f64) -> f64 {
        if self.reverses() { self.stands_s } else { self.stands_s.min(latest_s) }
    }
}

/// What comes before the last phase of an ego whose phases are told: before it sets off, or before it stands.
pub(crate) fn lead(told: &Told, last: &Pace) -> Option<Lead> {
    let phases = &told.sv.phases.last;
    let before = phases.split_last().map(|(_, before)| before).filter(|before| !before.is_empty())?;
    let mut time_s = match told.sv.state.stands() {
        true => CONTACT_S - told.choices.stood_s,
        false if last.speed_mps > 0.0 => return None,
        false => first_time(&last.acts),
    };
    // From the end: what is done at which time.
    time_s = (time_s * 10.0).floor() / 10.0;
    let mut moves: Vec<(f64, (f64, f64), bool)> = Vec::new();
    for phase in before.iter().rev() {
        match phase {
            Phase::Stands => time_s -= STANDS_S,
            Phase::Drives | Phase::Reverses => {
                let reverse = *phase == Phase::Reverses;
                let way = if reverse { BACKS_UP } else { MOVES_UP };
                time_s -= way.1 + BRAKES_S;
                moves.push((time_s, way, reverse));
            }
        }
    }
    if time_s < 0.0 {
        return None;
    }
    moves.reverse();
    let reversed = moves.iter().rfind(|(_, _, reverse)| *reverse);
    let stands_s = match (reversed, moves.last()) {
        (Some((from_s, way, _)), _) => from_s + way.1 + BRAKES_S,
        (None, Some((from_s, ..))) => from_s - 0.5 * STANDS_S,
        (None, None) => time_s,
    };
    let mut lead = Lead { speed_mps: 0.0, acts: Vec::new(), stretches: Vec::new(), stands_s };
    if told.sv.phases.came && time_s >= LEAST_APPROACH_S {
        // It comes along, brakes, and stands.
        let stands_s = if before[0] == Phase::Stands { time_s } else { time_s - STANDS_S };
        let speed_mps = told.choices.rolling_mps.min(BRAKES_MPS2 * (stands_s - ROLLS_S)).max(0.5);
        let braking_s = (speed_mps / BRAKES_MPS2 * 10.0).ceil() / 10.0;
        let from_s = stands_s - braking_s;
        lead.acts.push(when(from_s, Deed::Stop { rate_mps2: speed_mps / braking_s, at_m: None }));
        lead.speed_mps = speed_mps;
        lead.stretches.push((speed_mps * (from_s + 0.5 * braking_s), false));
    }
    for (from_s, (speed_mps, gaining_s), reverse) in moves {
        lead.acts.push(when(from_s, Deed::Speed { to_mps: speed_mps, rate_mps2: speed_mps / gaining_s }));
        let stop = Deed::Stop { rate_mps2: speed_mps / BRAKES_S, at_m: None };
        lead.acts.push(when(from_s + gaining_s, stop));
        lead.stretches.push((0.5 * speed_mps * (gaining_s + BRAKES_S), reverse));
    }
    Some(lead)
}

/// The plan of an ego that changes gear: along the line that it stands on at the contact, back and forth.
pub(crate) fn to_and_fro(lead: Lead, last: Pace, at: Pose, (reverse, beyond_m): (bool, f64)) -> ActorPlan {
    let ahead = Vec2::from_heading(at.heading);
    let degrees = at.heading.to_degrees();
    let place = |x_m: f64| {
        let point = at.position + ahead * x_m;
        Place::at(point.x, point.y, degrees)
    };
    let gear = |reverse: bool| if reverse { -1.0 } else { 1.0 };
    let mut stretches = lead.stretches;
    if last.driven_m > 0.0 {
        stretches.push((last.driven_m, reverse));
    }
    let start_m = -stretches.iter().map(|(length_m, reverse)| gear(*reverse) * length_m).sum::<f64>();
    let mut x_m = start_m;
    let mut course = Vec::new();
    for (length_m, reverse) in stretches {
        x_m += gear(reverse) * length_m;
        // What goes on in the same gear is one leg.
        if matches!(course.last(), Some(Leg::Curve { reverse: before, .. }) if *before == reverse) {
            course.pop();
        }
        course.push(Leg::Curve { to: place(x_m), reverse });
    }
    if last.driven_m > 0.0 {
        course.pop();
        course.push(Leg::Curve { to: place(gear(reverse) * beyond_m), reverse });
    }
    let acts = lead.acts.into_iter().chain(last.acts).collect();
    ActorPlan { speed_mps: lead.speed_mps, course, acts, ..ActorPlan::standing(place(start_m)) }
}
