//! Told signals and signs, held against who drove past them when.

use crate::draft::signals::arm_of;
use crate::told::crash::{AtRed, Told};
use recrash_model::account::{Control as Said, ControlDevice, Obeyed, Origin, SignalState};
use recrash_model::geometry::Vec2;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::{ActorTrack, STEP_S};
use recrash_model::scenario::{Aspect, Control, Device};
use recrash_model::template::Movement;
use recrash_roads::{ControlPlacement, Scenario};

/// What changed within this time has just changed. [s]
const JUST_S: f64 = 10.0;

/// A light is yellow for so long at most. [s]
const YELLOW_S: f64 = 5.0;

/// Who stands no farther before a line stands at it. [m]
const AT_LINE_M: f64 = 8.0;

/// Who creeps over a line at red has its front no farther past it. [m]
const CREEPS_M: f64 = 3.0;

/// Who is no farther before a line comes to it. [m]
const COMES_TO_M: f64 = 40.0;

/// Who rolls over the line of a yield sign no faster than this, or slower by so much than so long before, slowed for it. Assumed: what one
/// can stop from within a car's length. [m/s], [m/s], [s]
const ROLLS_MPS: f64 = 4.5;
const SLOWED_BY_MPS: f64 = 1.0;
const SLOWS_S: f64 = 3.0;

/// A line is taken to be so much longer on both sides; for who rides along the sidewalk, and comes over the crosswalk, as far as that goes. [m]
const BESIDE_M: f64 = 1.5;
const BESIDE_WALK_M: f64 = 4.0;

/// A told signal or sign, for sentences.
pub(super) fn words(said: Said) -> String {
    let device = match said.device {
        ControlDevice::Signal => "signal",
        ControlDevice::StopSign => "stop sign",
        ControlDevice::YieldSign => "yield sign",
    };
    let state = match said.state {
        None => "",
        Some(SignalState::Red) => "red ",
        Some(SignalState::Yellow) => "yellow ",
        Some(SignalState::Green) => "green ",
        Some(SignalState::TurnedGreen) => "just green ",
        Some(SignalState::TurnedRed) => "just red ",
    };
    let obeyed = match said.obeyed {
        None => "",
        Some(Obeyed::Yes) => ", obeyed",
        Some(Obeyed::No) => ", not obeyed",
    };
    format!("{state}{device}{obeyed}")
}

/// The arm at which the partner's own signal or sign stands, where it comes by a crossing road; any other is not its own.
pub(super) fn own_arm(told: &Told, scenario: &Scenario) -> Option<&'static str> {
    let arm = Some(arm_of(told.origin)).filter(|_| matches!(told.origin, Origin::Cross { .. }));
    arm.filter(|arm| scenario.draft().control.iter().any(|control| control.at == *arm))
}

/// Whether the partner comes by a way that has no stop line in any scene: out of a driveway or a lot, or over a crosswalk.
pub(super) fn is_beside_road(told: &Told) -> bool {
    arm_of(told.origin).is_empty() || told.cp.movement == Some(Movement::NmCrossing)
}

/// What is seen of a signal or a sign of such a one: a line that no scene has cannot be shown.
pub(super) fn beside_road((result, observed): (CheckResult, String)) -> (CheckResult, String) {
    if observed == NONE { (CheckResult::CannotBeShown, observed) } else { (result, observed) }
}

/// No line of a signal or a sign is on somebody's way.
const NONE: &str = "none on its way";

/// A told signal or sign; the arm at which it stands, where that is known; and how who stood there at red may come over its line at red.
pub(super) struct Asked<'a> {
    pub(super) said: Said,
    pub(super) arm: Option<&'a str>,
    pub(super) at_red: Option<AtRed>,
    /// It comes along the sidewalk.
    pub(super) on_walk: bool,
    /// Who came to a stop did so for a light that had turned yellow.
    pub(super) stops_at_yellow: bool,
}

/// Whether a told signal or sign stood before somebody, showed what is told, and was obeyed or not as told. Who came to a stand for a
/// light that changed did so before it was green.
pub(super) fn check(
    Asked { said, arm, at_red, on_walk, stops_at_yellow }: Asked<'_>,
    scenario: &Scenario,
    track: &ActorTrack,
    contact_s: f64,
) -> (CheckResult, String) {
    let until = track.step_at(contact_s);
    let junction = scenario.draft().map.network().is_some_and(|map| !map.junctions.is_empty());
    if scenario.draft().control.is_empty() && !junction {
        return (CheckResult::CannotBeShown, "there is no junction to draw it at".to_owned());
    }
    let all = scenario.draft().control.iter().zip(scenario.control());
    let all = all.filter(|(control, _)| arm.is_none_or(|arm| control.at == arm));
    let beside_m = if on_walk { BESIDE_WALK_M } else { BESIDE_M };
    let met = all.filter_map(|(control, placed)| Some((control, line_of(scenario, (control, placed), beside_m)?)));
    let found = met.filter_map(|(control, line)| Some((control, passage(track, &line, until)?))).next();
    let Some((control, passage)) = found else {
        return (CheckResult::NotShown, NONE.to_owned());
    };
    let is_device = matches!(
        (&control.device, said.device),
        (Device::Signal { .. }, ControlDevice::Signal)
            | (Device::StopSign {}, ControlDevice::StopSign)
            | (Device::YieldSign {}, ControlDevice::YieldSign)
    );
    if !is_device {
        return (CheckResult::NotShown, "another device".to_owned());
    }
    let met = Met { device: &control.device, passage, contact_s };
    let (time_s, kept) = (met.time_s(), met.keeps(at_red, track));
    let obeyed = match said.obeyed {
        None => true,
        Some(Obeyed::Yes) => kept,
        Some(Obeyed::No) => !kept,
    };
    let color = met.shows(time_s).map_or(String::new(), |aspect| format!("{} ", aspect.label()));
    let did = match met.passage.crossed_s {
        None => "it stayed before the line".to_owned(),
        Some(at_s) => format!("it crossed the line at {at_s:.1} s"),
    };
    let shown = obeyed && said.state.is_none_or(|state| met.showed(state, stops_at_yellow));
    let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
    (result, format!("{color}at {time_s:.1} s, {did}"))
}

/// A signal or a sign, how somebody came by its line, and when the two touch. [s]
struct Met<'a> {
    device: &'a Device,
    passage: Passage,
    contact_s: f64,
}

impl Met<'_> {
    /// When it came over the line; at the contact it is before that. [s]
    fn time_s(&self) -> f64 {
        self.passage.crossed_s.unwrap_or(self.contact_s)
    }

    /// What the light shows then.
    fn shows(&self, at_s: f64) -> Option<Aspect> {
        self.device.aspect(at_s)
    }

    /// Whether the light showed one of these then, or within a time before.
    fn showed_within(&self, until_s: f64, within_s: f64, of: &[Aspect]) -> bool {
        let back = |tenth: i32| self.shows((until_s - 0.1 * f64::from(tenth)).max(0.0));
        (0..=(within_s * 10.0) as i32).any(|tenth| back(tenth).is_some_and(|seen| of.contains(&seen)))
    }

    /// Whether it came to a stand, where it did, when the light was not green.
    fn waited(&self) -> bool {
        let stood = &self.passage.stands_s;
        stood.is_empty() || stood.iter().any(|at_s| self.shows(*at_s) != Some(Aspect::Green))
    }

    /// Whether the light showed what is told of it.
    fn showed(&self, state: SignalState, stops_at_yellow: bool) -> bool {
        let (passage, contact_s) = (&self.passage, self.contact_s);
        let just = |was: &[Aspect]| self.showed_within(contact_s, JUST_S, was) && self.waited();
        match state {
            SignalState::Red => {
                let times = [Some(self.time_s()), passage.stood_s].into_iter().flatten();
                times.into_iter().any(|at_s| self.shows(at_s) == Some(Aspect::Red))
            }
            SignalState::Green => self.shows(self.time_s()) == Some(Aspect::Green),
            // It turned so before who stops for it came to a stand.
            SignalState::Yellow if stops_at_yellow && passage.crossed_s.is_none() => {
                let from_s = passage.stands_s.last().map_or(contact_s, |at_s| at_s - STEP_S);
                self.waited() && self.showed_within(from_s, YELLOW_S, &[Aspect::Yellow])
            }
            SignalState::Yellow => self.shows(self.time_s()) == Some(Aspect::Yellow),
            SignalState::TurnedGreen => self.shows(contact_s) == Some(Aspect::Green) && just(&[Aspect::Red]),
            SignalState::TurnedRed => {
                self.shows(contact_s) == Some(Aspect::Red) && just(&[Aspect::Green, Aspect::Yellow])
            }
        }
    }

    /// Whether it obeyed the signal or the sign: at red, as who stood there may come over the line.
    fn keeps(&self, at_red: Option<AtRed>, track: &ActorTrack) -> bool {
        let passage = &self.passage;
        match self.device {
            Device::StopSign {} => passage.crossed_s.is_none() || passage.stood_s.is_some(),
            Device::YieldSign {} => {
                passage.crossed_s.is_none_or(|at_s| passage.stood_s.is_some() || slowed(track, at_s))
            }
            Device::Signal { .. } => {
                let stood_at_red = passage.stood_s.is_some_and(|at_s| self.shows(at_s) == Some(Aspect::Red));
                let at_red = at_red.filter(|_| stood_at_red);
                let may = at_red.is_some_and(|how| how == AtRed::Turns || passage.past_m < CREEPS_M);
                may || passage.crossed_s.is_none_or(|at_s| self.shows(at_s) != Some(Aspect::Red))
            }
        }
    }
}

/// Whether who crosses a line then had slowed for it.
fn slowed(track: &ActorTrack, crossed_s: f64) -> bool {
    let speed = |at_s: f64| track.states[(at_s.max(0.0) / STEP_S).round() as usize].velocity().length();
    speed(crossed_s) <= ROLLS_MPS || speed(crossed_s - SLOWS_S) - speed(crossed_s) >= SLOWED_BY_MPS
}

/// Whether somebody drives over a line while its signal is red.
pub(crate) fn runs_red(scenario: &Scenario, track: &ActorTrack) -> bool {
    let all = scenario.draft().control.iter().zip(scenario.control());
    let mut met = all.filter_map(|(control, placed)| Some((control, line_of(scenario, (control, placed), BESIDE_M)?)));
    met.any(|(control, line)| {
        let crossed_s = passage(track, &line, track.states.len() - 1).and_then(|passage| passage.crossed_s);
        crossed_s.is_some_and(|at_s| control.device.aspect(at_s) == Some(Aspect::Red))
    })
}

/// How somebody came by a stop line.
struct Passage {
    /// When its front crossed the line. [s]
    crossed_s: Option<f64>,
    /// When it stood at the line first. [s]
    stood_s: Option<f64>,
    /// When it came to stand on its way to the line. [s]
    stands_s: Vec<f64>,
    /// How far its front is past the line at last. [m]
    past_m: f64,
}

/// A stop line, and the direction across it.
struct Line {
    from: Vec2,
    to: Vec2,
    ahead: Vec2,
}

fn line_of(scenario: &Scenario, (control, placed): (&Control, &ControlPlacement), beside_m: f64) -> Option<Line> {
    let network = scenario.network();
    let [one, other] = *network.stop_lines(std::slice::from_ref(control)).first()?;
    let &(lane, at_m) = placed.lines.first()?;
    let along = (other - one) * (1.0 / (other - one).length().max(1e-9));
    let ahead = Vec2::from_heading(network.lane(lane).heading(at_m));
    Some(Line { from: one - along * beside_m, to: other + along * beside_m, ahead })
}

/// Whether somebody came along to this line until a step: it crossed it, or it is right before it.
fn passage(track: &ActorTrack, line: &Line, until: usize) -> Option<Passage> {
    let front = |step: usize| {
        let state = &track.states[step];
        state.position() + Vec2::from_heading(state.heading) * (0.5 * track.length_m)
    };
    let along = line.to - line.from;
    let length = along.length();
    let on = |point: Vec2| {
        let share = (point - line.from).dot(along) / (length * length);
        ((0.0..=1.0).contains(&share), (point - line.from).dot(line.ahead))
    };
    let last_m = on(front(until)).1;
    let mut stood_s = None;
    let mut stands_s = Vec::new();
    for step in 0..=until {
        let (beside, past_m) = on(front(step));
        let at_line = beside && (-AT_LINE_M..=0.5).contains(&past_m);
        let stands = |step: usize| track.states[step].stands();
        if at_line && stands(step) {
            stood_s = stood_s.or(Some(STEP_S * step as f64));
        }
        if stands(step) && beside && (-COMES_TO_M..=0.5).contains(&past_m) && (step == 0 || !stands(step - 1)) {
            stands_s.push(STEP_S * step as f64);
        }
        if step > 0 {
            let (was_beside, was_m) = on(front(step - 1));
            if was_m <= 0.0 && past_m > 0.0 && (beside || was_beside) {
                return Some(Passage { crossed_s: Some(STEP_S * step as f64), stood_s, stands_s, past_m: last_m });
            }
        }
    }
    let state = &track.states[until];
    let (beside, past_m) = on(front(until));
    let heads_there = Vec2::from_heading(state.heading).dot(line.ahead) > 0.5;
    (beside && heads_there && (-COMES_TO_M..=0.5).contains(&past_m)).then_some(Passage {
        crossed_s: None,
        stood_s,
        stands_s,
        past_m: last_m,
    })
}
