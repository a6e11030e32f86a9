//! A plan, made ready to be followed: names are numbers, times are steps.

use recrash_model::math;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{self, ActorPlan, Aspect, Doing, Part, Trigger};
use recrash_roads::Course;

/// A plan and its course.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Programme {
    /// The line.
    pub course: Course,
    /// What is done on it.
    pub acts: Vec<PlannedAct>,
    /// Speed at the start. [m/s]
    pub speed_mps: f64,
    /// Place beside the line at the start, to the right. [m]
    pub t_m: f64,
    /// Stops for signals and signs from the start on.
    pub obeys_control: bool,
    /// The first step at which it is there.
    pub appears: u32,
    /// Half of its length. [m]
    pub half_length_m: f64,
}

/// An act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedAct {
    /// When it begins; when the one before is done where not given.
    pub when: Option<When>,
    /// Steps from its trigger to its beginning.
    pub delay: u32,
    /// What is done.
    pub deed: Deed,
}

/// A trigger.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "as in `recrash_model::scenario::Trigger`, with numbers for names")]
pub enum When {
    Step(u32),
    At {
        s_m: f64,
    },
    Near {
        actor: u16,
        within_m: f64,
    },
    State {
        actor: u16,
        is: Doing,
    },
    Signal {
        control: u16,
        shows: Aspect,
    },
    Act {
        actor: u16,
        act: u8,
    },
    /// Refers to somebody or something that is not there: never.
    Never,
}

/// What is done.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "as in `recrash_model::scenario::Deed`, with numbers for names")]
pub enum Deed {
    Speed {
        to_mps: f64,
        rate_mps2: f64,
    },
    Stop {
        rate_mps2: f64,
        at_m: Option<f64>,
    },
    Hold {
        steps: Option<u32>,
    },
    Shift {
        to_t_m: f64,
        over_m: f64,
    },
    Follow {
        actor: u16,
        speed_mps: f64,
        gap_m: f64,
        headway_s: f64,
        reaction: u32,
        acceleration_mps2: f64,
        braking_mps2: f64,
    },
    Part {
        part: u8,
        to_rad: f64,
        steps: u32,
    },
    Obey {
        control: bool,
    },
    Leave,
}

/// What names in a plan mean.
pub trait Who {
    /// The number of a road user: 0 is the ego, then partners, then actors.
    fn actor(&self, id: &str) -> Option<u16>;
    /// The number of an act of a road user by its name.
    fn act(&self, actor: &str, act: &str) -> Option<u8>;
    /// The number of the control at the end of a road with direction.
    fn control(&self, at: &str) -> Option<u16>;
}

impl Programme {
    /// A plan on its course. `parts` are those of whoever has the plan, `half_length_m` half of its length.
    pub fn new(plan: &ActorPlan, course: Course, t_m: f64, parts: &[Part], half_length_m: f64, who: &impl Who) -> Self {
        Self {
            course,
            acts: plan.acts.iter().map(|act| planned(act, parts, who)).collect(),
            speed_mps: plan.speed_mps,
            t_m,
            obeys_control: plan.obeys_control,
            appears: steps(plan.appears_s),
            half_length_m,
        }
    }
}

fn planned(act: &scenario::Act, parts: &[Part], who: &impl Who) -> PlannedAct {
    let when = act.when.as_ref().map(|trigger| match trigger {
        Trigger::TimeS(time_s) => When::Step(steps(*time_s)),
        Trigger::AtM(s_m) => When::At { s_m: *s_m },
        Trigger::Near { actor, within_m } => {
            who.actor(actor).map_or(When::Never, |actor| When::Near { actor, within_m: *within_m })
        }
        Trigger::Actor { actor, is } => who.actor(actor).map_or(When::Never, |actor| When::State { actor, is: *is }),
        Trigger::Signal { at, shows } => {
            who.control(at).map_or(When::Never, |control| When::Signal { control, shows: *shows })
        }
        Trigger::Act { actor, act } => match (who.actor(actor), who.act(actor, act)) {
            (Some(actor), Some(act)) => When::Act { actor, act },
            _ => When::Never,
        },
    });
    let deed = match &act.deed {
        scenario::Deed::Speed { to_mps, rate_mps2 } => Deed::Speed { to_mps: *to_mps, rate_mps2: *rate_mps2 },
        scenario::Deed::Stop { rate_mps2, at_m } => Deed::Stop { rate_mps2: *rate_mps2, at_m: *at_m },
        scenario::Deed::Hold { for_s } => Deed::Hold { steps: for_s.map(steps) },
        scenario::Deed::Shift { to_t_m, over_m } => Deed::Shift { to_t_m: *to_t_m, over_m: *over_m },
        scenario::Deed::Follow { actor, speed_mps, gap_m, headway_s, reaction_s, acceleration_mps2, braking_mps2 } => {
            Deed::Follow {
                actor: who.actor(actor).unwrap_or(0),
                speed_mps: *speed_mps,
                gap_m: *gap_m,
                headway_s: *headway_s,
                reaction: steps(*reaction_s),
                acceleration_mps2: *acceleration_mps2,
                braking_mps2: *braking_mps2,
            }
        }
        scenario::Deed::Part { part, to_deg, over_s } => Deed::Part {
            part: parts.iter().position(|each| each.id == *part).and_then(|at| u8::try_from(at).ok()).unwrap_or(0),
            to_rad: to_deg * math::PI / 180.0,
            steps: steps(*over_s).max(1),
        },
        scenario::Deed::Obey { control } => Deed::Obey { control: *control },
        scenario::Deed::Leave {} => Deed::Leave,
    };
    PlannedAct { when, delay: steps(act.delay_s), deed }
}

/// Whole steps of 0.1 s.
fn steps(time_s: f64) -> u32 {
    (time_s / STEP_S).round().clamp(0.0, 1e6) as u32
}
