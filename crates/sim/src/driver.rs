//! The seat for a driver from outside: what it is told before every decision, and what it answers.
//!
//! The simulator stays free of processes and clocks; whoever implements [`EgoDriver`] may ask a program, a network or a
//! person. Such a driver may fail, and then the run ends with its error.

use crate::cast::CastMember;
use crate::chassis::Controls;
use crate::scene::Seen;
use recrash_model::geometry::Vec2;
use recrash_model::rollout::{ActorState, Termination};
use recrash_model::scenario::{Aspect, MissionStop};
use recrash_roads::{Scenario, StopLine};

/// Drives the ego from outside.
pub trait EgoDriver {
    /// Why there is no answer.
    type Error;

    /// Its name, for rollouts.
    fn name(&self) -> &str;

    /// A run begins. `cast` holds the ego, the partners in the scenario's order, then background traffic.
    ///
    /// # Errors
    /// The driver is not ready; there is no run.
    fn begin(&mut self, scenario: &Scenario, cast: &[CastMember]) -> Result<(), Self::Error>;

    /// Decides what to do for the next 0.1 s.
    ///
    /// # Errors
    /// There is no answer; the run ends.
    fn decide(&mut self, observation: &Observation<'_>) -> Result<Controls, Self::Error>;

    /// The run is over.
    ///
    /// # Errors
    /// The driver is gone.
    fn end(&mut self, termination: Termination) -> Result<(), Self::Error>;
}

/// The world before a decision. The driver sees everybody, through everything, without noise.
pub struct Observation<'a> {
    /// Number of the step, from 0.
    pub step: u32,
    /// Time. [s]
    pub time_s: f64,
    /// How far the ego has come along its route, from the route's beginning. [m]
    pub route_s_m: f64,
    /// How far it is to the right of its route. [m]
    pub route_t_m: f64,
    /// Everybody's state, in the order of the cast, the ego first; controls are those of the step before.
    pub states: &'a [ActorState],
    pub(crate) seen: &'a [Seen],
    /// What signals show, in the scenario's order of control; `None` for signs.
    pub signals: &'a [Option<Aspect>],
    /// Stop lines on the ego's route: where its centre is when its front is there, and what stands there.
    pub lines: &'a [StopLine],
    /// Stops of its task that lie ahead.
    pub stops: &'a [MissionStop],
    /// The recorded driver still drives: controls are not asked for yet.
    pub recorded: bool,
}

impl Observation<'_> {
    /// Whether an actor is in the world: background traffic that has driven off the map is not, nor who appears later.
    pub fn is_present(&self, actor: usize) -> bool {
        self.seen.get(actor).is_none_or(|seen| seen.present)
    }

    /// Unit vector of an actor's heading.
    pub fn forward(&self, actor: usize) -> Vec2 {
        match self.seen.get(actor) {
            Some(seen) => seen.forward,
            None => Vec2::from_heading(self.states[actor].heading),
        }
    }
}
