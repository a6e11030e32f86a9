//! What somebody did before the last thing that it does: it came and stood, moved up and stood again, or reversed first.

use crate::acts::Doing;
use crate::choices::Choices;
use crate::extras::STANDS_MPS;
use crate::kerb;
use crate::pace::{Pace, first_time, when};
use crate::side::{Side, Slant, Turning};
use crate::told::Told;
use recrash_model::account::{Act, ActFact, ContactState, Origin, Party, Standing, Striker};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::rollout::{ActorState, ActorTrack};
use recrash_model::scenario::{self, ActorPlan, Deed, Leg, Place};
use recrash_roads::Course;

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

/// So many phases are drawn, and so many are checked and drawn in any case, the last one counted.
const MOST_PHASES: usize = 8;
const CHECKED_PHASES: usize = 4;

/// The last of them, which are checked.
pub(crate) fn checked(phases: &[Phase]) -> &[Phase] {
    phases.split_at(phases.len().saturating_sub(CHECKED_PHASES)).1
}

/// What is told of them: the last things that somebody did before the contact, ended by what it does there. Empty where they say no
/// more than the state there, and that it came there or stood before.
pub(crate) fn told(party: &Party, state: ContactState) -> Vec<Phase> {
    let mut acts: Vec<&ActFact> = party.acts.iter().filter(|fact| !fact.after_contact).collect();
    acts.sort_by_key(|fact| fact.step);
    let stands = |fact: &&ActFact| matches!(fact.act, Act::Stop | Act::Hold) && !fact.begun;
    let last_stand = acts.iter().rposition(stands);
    let (mut list, mut went_on, mut slowed): (Vec<Phase>, bool, bool) = (Vec::new(), false, false);
    for (number, fact) in acts.iter().enumerate() {
        // Of what was begun, a way from one stop to the next was driven.
        let stops_next = acts[number..].iter().find(|fact| stands(fact)).is_some_and(|fact| fact.act == Act::Stop);
        if fact.begun && !(leaves_line(fact.act) && list.last() == Some(&Phase::Stands) && stops_next) {
            continue;
        }
        went_on |= fact.act == Act::Slow && !list.is_empty();
        slowed = fact.act == Act::Slow || slowed && fact.act != Act::Stop;
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
        // Who sets off as they touch stood before that, also where it is only told to have slowed.
        if fact.act == Act::SetOff && slowed && state == ContactState::SettingOff && list.last() == Some(&phase) {
            list.push(Phase::Stands);
        }
        // Who came to a stop came along before; so did who stood, went on and slowed for it.
        let goes_on = list.last() == Some(&Phase::Stands) && went_on && fact.act == Act::Stop;
        if list.is_empty() && fact.act == Act::Stop || goes_on {
            list.push(Phase::Drives);
        }
        went_on = false;
        if list.last() != Some(&phase) {
            list.push(phase);
        }
    }
    // The state at the contact decides how it ends: what is told of who stands behind its last stop was a plan, and a stop that is
    // told last of who moves was not reached.
    let last = Phase::of(state);
    let stopping = party.standing.as_ref().is_some_and(|fact| fact.value == Standing::Stopping);
    let behind = last_stand.map_or(&[][..], |at| &acts[at + 1..]);
    let reached = last_stand.is_some_and(|at| acts[at].act == Act::Hold) || behind.iter().any(|fact| goes_on(fact));
    if last == Phase::Stands && !stopping {
        // Who is told to have set off from there stands again.
        if !behind.iter().any(|fact| fact.act == Act::SetOff && !fact.begun) {
            let stands = list.iter().rposition(|phase| *phase == last).map_or(list.len(), |at| at + 1);
            list.truncate(stands);
        }
    } else if list.ends_with(&[last, Phase::Stands]) && !reached {
        list.pop();
    }
    if list.last() != Some(&last) {
        list.push(last);
    }
    let last = list.split_off(list.len().saturating_sub(MOST_PHASES));
    let before = &last[..last.len() - 1];
    if last.len() > 2 || before.contains(&Phase::Reverses) { last } else { Vec::new() }
}

/// Whether somebody who does this drives, out of its line.
const fn leaves_line(act: Act) -> bool {
    matches!(act, Act::LaneChange | Act::Drift | Act::Swerve | Act::Turn | Act::UTurn | Act::PullOut)
}

/// Whether somebody who does this behind a stop has come to that: it went on from there, or was about to.
fn goes_on(fact: &ActFact) -> bool {
    leaves_line(fact.act) || matches!(fact.act, Act::SetOff | Act::Accelerate | Act::Pass | Act::Enter | Act::Cross)
}

/// A phase that is shorter than this on the way from one gear to the other is none. [steps]
const LEAST_STEPS: usize = 4;

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

/// Who changes gear stands between, told or not.
fn without_turnarounds(phases: &[Phase]) -> Vec<Phase> {
    let between = |at: usize| {
        let sides = (at.checked_sub(1).and_then(|before| phases.get(before)), phases.get(at + 1));
        matches!(sides, (Some(Phase::Drives), Some(Phase::Reverses)) | (Some(Phase::Reverses), Some(Phase::Drives)))
    };
    phases
        .iter()
        .enumerate()
        .filter(|(at, phase)| **phase != Phase::Stands || !between(*at))
        .map(|(_, phase)| *phase)
        .collect()
}

/// Whether somebody shows these phases last, and which it shows.
pub(crate) fn check(told: &[Phase], track: &ActorTrack, time_s: f64) -> (bool, String) {
    let shown = shown(track, (time_s * 10.0).floor() as usize);
    let seen = shown.split_at(shown.len().saturating_sub(told.len().max(1))).1;
    // Where nobody says that it stood between.
    let turns = told.windows(2).any(|pair| !pair.contains(&Phase::Stands));
    (shown.ends_with(told) || turns && without_turnarounds(&shown).ends_with(&without_turnarounds(told)), words(seen))
}

/// Whether the one who is told to have backed first did.
pub(crate) fn back_in_order(first: Striker, ego: &ActorTrack, partner: &ActorTrack, time_s: f64) -> bool {
    let until = (time_s * 10.0).floor() as usize;
    let backs = |track: &ActorTrack| track.states.iter().take(until + 1).position(|state| state.speed() < -STANDS_MPS);
    match (backs(ego), backs(partner)) {
        (Some(ego), Some(partner)) if first == Striker::Cp => partner < ego,
        (Some(ego), Some(partner)) => ego < partner,
        _ => false,
    }
}

/// For sentences.
pub(crate) fn words(phases: &[Phase]) -> String {
    phases.iter().map(|phase| phase.word()).collect::<Vec<_>>().join(", ")
}

/// Who moves up between two stands gains speed so fast. [m/s^2]
const MOVES_UP_MPS2: f64 = 1.2;

/// Who backs gains this speed in so long, and whoever moves between two stands loses its speed in so long. [m/s, s]
const BACKS_UP: (f64, f64) = (1.5, 1.2);
const BRAKES_S: f64 = 1.2;

/// It brakes for its first stop with so much: less than makes plans brake by themselves before they change gear. [m/s^2]
const BRAKES_MPS2: f64 = 1.8;

/// How far somebody moves up, where nothing tells it. [m]
pub(crate) const MOVES_UP_M: f64 = 2.9;

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
    /// It begins to reverse then, where it does. [s]
    pub(crate) backs_s: Option<f64>,
    /// It stands then: after it has reversed, or before it moves up. [s]
    stands_s: f64,
}

impl Lead {
    /// Whether it is also driven backwards.
    pub(crate) fn reverses(&self) -> bool {
        self.stretches.iter().any(|(_, reverse)| *reverse)
    }

    /// How far it goes, back and forth. [m]
    pub(crate) fn driven_m(&self) -> f64 {
        self.stretches.iter().map(|(length_m, reverse)| if *reverse { -length_m } else { *length_m }).sum()
    }

    /// When it last sets off.
    pub(crate) fn sets_off_s(&self) -> Option<f64> {
        let goes = |act: &&scenario::Act| matches!(act.deed, Deed::Speed { to_mps, .. } if to_mps > 0.0);
        self.acts.iter().rfind(goes).map(|act| first_time(std::slice::from_ref(act)))
    }

    /// It leaves its line on its last way, of which half is done where that ends.
    pub(crate) fn shifts(&mut self, to_t_m: f64) {
        let Some((way_m, _)) = self.stretches.last().copied() else { return };
        let starts = |act: &scenario::Act| matches!(act.deed, Deed::Speed { to_mps, .. } if to_mps > 0.0);
        let at = self.acts.iter().rposition(starts).unwrap_or(0);
        let over_m = 2.0 * way_m;
        let shift = scenario::Act { deed: Deed::Shift { to_t_m, over_m }, ..self.acts[at].clone() };
        self.acts.insert(at, shift);
    }

    /// Forward all the way, and then the last pace.
    pub(crate) fn then(self, last: Pace) -> Pace {
        let before_m = self.driven_m();
        let acts = self.acts.into_iter().chain(last.acts).collect();
        Pace { speed_mps: self.speed_mps, acts, driven_m: before_m + last.driven_m }
    }

    /// When the system under test takes over: where the ego stands before it moves up, this late at most. No system reverses:
    /// where the ego did it is over then. [s]
    pub(crate) fn handover_s(&self, latest_s: f64) -> f64 {
        if self.reverses() { self.stands_s } else { self.stands_s.min(latest_s) }
    }
}

/// What comes before the last phase of somebody, which begins then: before it sets off, or before it stands. [s]
/// `moves_up_m`: how far it moves between two stands; `longer_s`: so much longer it stands where it stood first.
pub(crate) fn lead(
    phases: &[Phase],
    mut time_s: f64,
    rolling_mps: f64,
    moves_up_m: f64,
    longer_s: f64,
) -> Option<Lead> {
    let before = phases.split_last().map(|(_, before)| before).filter(|before| !before.is_empty())?;
    let (came, before) = match before.split_first() {
        Some((Phase::Drives, rest)) => (true, rest),
        _ => (false, before),
    };
    // From the end: what is done at which time.
    time_s = (time_s * 10.0).floor() / 10.0;
    let mut moves: Vec<(f64, (f64, f64), bool)> = Vec::new();
    for phase in before.iter().rev() {
        match phase {
            Phase::Stands => time_s -= STANDS_S,
            Phase::Drives | Phase::Reverses => {
                let reverse = *phase == Phase::Reverses;
                let way = if reverse { BACKS_UP } else { moves_up(moves_up_m) };
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
    let backs_s = moves.iter().find(|(_, _, reverse)| *reverse).map(|(from_s, ..)| *from_s);
    let mut lead = Lead { backs_s, speed_mps: 0.0, acts: Vec::new(), stretches: Vec::new(), stands_s };
    if came && time_s - longer_s >= LEAST_APPROACH_S {
        // It comes along, brakes, and stands.
        let stands_s = if before.first() == Some(&Phase::Stands) { time_s } else { time_s - STANDS_S } - longer_s;
        let speed_mps = rolling_mps.min(BRAKES_MPS2 * (stands_s - ROLLS_S)).max(0.5);
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

/// The speed that somebody gains who moves up so far between two stands, and how long it gains it. [m/s, s]
fn moves_up(way_m: f64) -> (f64, f64) {
    let gained_mps = 0.5 * MOVES_UP_MPS2 * ((BRAKES_S * BRAKES_S + 8.0 * way_m / MOVES_UP_MPS2).sqrt() - BRAKES_S);
    let gaining_s = (gained_mps / MOVES_UP_MPS2 * 10.0).round().max(1.0) / 10.0;
    (2.0 * way_m / (gaining_s + BRAKES_S), gaining_s)
}

/// Who changes gear stops so far before the end of a leg: a hair behind it, it would stand on the next one. [m]
pub(crate) const STOPS_SHORT_M: f64 = 0.002;

/// Who came over from another line before its first stop was on its own so far before that, and took so long at least and at most. [m]
const CAME_OVER_M: f64 = 4.0;
const COMES_OVER_M: (f64, f64) = (12.0, 30.0);

/// Another line, so far to the left of the one on which somebody stops; and the arm of who comes over from it. [m]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beside {
    pub(crate) left_m: f64,
    pub(crate) arm_m: f64,
}

impl Beside {
    /// The way from there to the own line, of a first stretch of this length: so much longer it is than straight on, and from where along
    /// that to where it goes over. [m]
    fn over(self, length_m: f64) -> Option<(f64, [f64; 2])> {
        let joins_m = length_m - CAME_OVER_M;
        let leaves_m = (joins_m - COMES_OVER_M.1).max(1.0);
        let at = |x_m: f64, y_m: f64| Pose { position: Vec2::new(x_m, y_m), heading: 0.0 };
        let mut course = Course::begin(self.arm_m);
        let over = course.curve(at(leaves_m, self.left_m), at(joins_m, 0.0), false);
        let longer_m = course.length_m() - (joins_m - leaves_m);
        (over && joins_m - leaves_m >= COMES_OVER_M.0 && longer_m < leaves_m).then_some((longer_m, [leaves_m, joins_m]))
    }
}

/// The same plan with what came before it: along the line on which it begins, back and forth; `from`: it came over from another line.
pub(crate) fn before(lead: Lead, plan: ActorPlan, begin: Pose, from: Option<Beside>) -> ActorPlan {
    let ahead = Vec2::from_heading(begin.heading);
    let degrees = begin.heading.to_degrees();
    let beside = |x_m: f64, left_m: f64| {
        let point = begin.position + ahead * x_m + ahead.left() * left_m;
        Place::at(point.x, point.y, degrees)
    };
    let place = |x_m: f64| beside(x_m, 0.0);
    let gear = |reverse: bool| if reverse { -1.0 } else { 1.0 };
    let start_m = -lead.driven_m();
    let first = lead.stretches.first().filter(|(_, reverse)| lead.speed_mps > 0.0 && !reverse);
    let over = from.zip(first).and_then(|(from, (length_m, _))| Some((from.left_m, from.over(*length_m)?)));
    let start = over.map_or(place(start_m), |(left_m, (longer_m, _))| beside(start_m + longer_m, left_m));
    let (mut x_m, mut course) = (start_m, Vec::new());
    if let Some((left_m, (_, [leaves_m, joins_m]))) = over {
        let to = [beside(start_m + leaves_m, left_m), place(start_m + joins_m)];
        course.extend(to.map(|to| Leg::Curve { to, reverse: false }));
    }
    let own = course.len();
    for (length_m, reverse) in &lead.stretches {
        x_m += gear(*reverse) * length_m;
        // What goes on in the same gear is one leg.
        if matches!(course[own..].last(), Some(Leg::Curve { reverse: before, .. }) if before == reverse) {
            course.pop();
        }
        course.push(Leg::Curve { to: place(x_m + gear(*reverse) * STOPS_SHORT_M), reverse: *reverse });
    }
    course.extend(plan.course);
    let acts = lead.acts.into_iter().chain(plan.acts).collect();
    ActorPlan { speed_mps: lead.speed_mps, course, acts, start, ..plan }
}

/// When they touch, and when where more is told of what they did before. [s]
pub(crate) const CONTACT_S: f64 = 9.0;
const LATE_CONTACT_S: f64 = 12.0;

/// Each step more than are checked takes so much longer. [s]
const PHASE_S: f64 = 2.0;

/// Who drives through a junction comes along for so far, and so long at most. [m, s]
const OVER_LINE_M: f64 = 19.5;
const LATEST_CONTACT_S: f64 = 22.0;

/// How much longer the ego and the partner stand, and how fast the partner is, where that brings what they do into the told order. [s]
const OTHER_TIMES: [([f64; 2], f64); 8] = [
    ([-0.8, 0.0], 1.0),
    ([2.0, 0.0], 1.0),
    ([0.0, 2.0], 1.0),
    ([-0.8, 0.0], 0.6),
    ([4.0, 0.0], 1.0),
    ([0.0, 4.0], 1.0),
    ([7.0, 0.0], 1.0),
    ([0.0, 7.0], 1.0),
];

impl Told {
    /// What the two did before, and when they touch then, as far as it can be drawn: of who comes from beside the road, or stood across it, the state says enough.
    pub(crate) fn phases(&mut self) {
        let along = matches!(
            self.origin,
            Origin::Ahead | Origin::Behind | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. }
        );
        if !along || matches!(self.cp.slants, Some(Slant::Stood { .. })) {
            self.cp.phases.clear();
        }
        if self.cp.backs_in && self.cp.phases.is_empty() {
            self.cp.phases = kerb::BACKED_IN.to_vec();
        }
        // Who came back into the lane in which it stopped had left it before.
        let came_back = self.sv.returns && self.sv.stopped_aside == Some(Act::LaneChange);
        // So does who comes to the kerb, and is passed there.
        let to_kerb = self.sv.state == ContactState::Stopped && self.is_at_kerb() && !self.stays_at_kerb();
        let more = to_kerb || !self.sv.phases.is_empty() || !self.cp.phases.is_empty() || self.backs_out() || came_back;
        let steps = self.sv.phases.len().max(self.cp.phases.len()).saturating_sub(CHECKED_PHASES) as f64;
        self.contact_s = if more { LATE_CONTACT_S + steps * PHASE_S } else { CONTACT_S };
        // Who is slow has come over the line of its signal or sign.
        let drives = self.sv.state == ContactState::Moving && self.sv.slowed_from.is_none() && !self.sv.stood_first;
        let over_line = self.sv.control.is_some() && drives && self.origin != Origin::Behind;
        // So has who stood before its turn.
        let turns = matches!(self.sv.turning, Turning::Left | Turning::Right);
        let from_line = turns && self.sv.stood_first && self.sv.slowed_from.is_none();
        if let Some(mps) = self.sv.impact_mps.filter(|_| over_line && self.sv.turning == Turning::No || from_line) {
            self.contact_s =
                (OVER_LINE_M / mps.max(0.4)).ceil().clamp(self.contact_s, LATEST_CONTACT_S.max(self.contact_s));
        }
    }

    /// The same at other times, to try where what one of the two did before or behind the other is not shown as it is told: the ego's acts
    /// come later against the partner's where that stands for longer, or the ego for a shorter time; the partner's, where the ego stands for
    /// longer; who is slower may be for both. Of each whether it is for the ego's acts, and for the partner's.
    pub(crate) fn in_other_times(&self) -> impl Iterator<Item = (Self, [bool; 2])> {
        let differs = self.sv.acts.iter().chain(&self.cp.acts).any(Doing::is_behind_other);
        let tried = OTHER_TIMES.into_iter().filter(move |_| differs);
        tried.map(|(longer_s, slower)| {
            let mut told = self.clone();
            told.contact_s += longer_s[0].max(longer_s[1]).max(0.0);
            let choices = Choices { longer_s, partner_speed: slower * self.choices.partner_speed, ..self.choices };
            (told.choosing(choices), [longer_s[0] <= 0.0, longer_s[0] > 0.0 || slower < 1.0])
        })
    }

    /// The same with the last steps alone that are checked, where there are more.
    pub(crate) fn in_fewer_steps(&self) -> Option<Self> {
        let long = |side: &Side| side.phases.len() > CHECKED_PHASES;
        let mut told = (long(&self.sv) || long(&self.cp)).then(|| self.clone())?;
        for side in [&mut told.sv, &mut told.cp] {
            side.phases = checked(&side.phases).to_vec();
        }
        told.phases();
        Some(told)
    }
}
