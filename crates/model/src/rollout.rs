//! Rollouts: what happened in one simulation of one scenario.

use crate::geometry::{OrientedBox, Pose, Vec2};
use crate::record::PartnerKind;
use crate::scenario::ObstacleKind;
use serde::{Deserialize, Serialize};

/// The rollouts' format tag.
pub const ROLLOUT_FORMAT: &str = "recrash.rollout/1";

/// Time between two recorded states, and between two decisions. [s]
pub const STEP_S: f64 = 0.1;

/// Physics steps in one step.
pub const SUBSTEPS: usize = 5;

/// Name of the ego in every list of actors; it is always the first.
pub const EGO_ID: &str = "ego";

/// One simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rollout {
    /// Always [`ROLLOUT_FORMAT`].
    pub format: String,
    /// Scenario.
    pub scenario_id: String,
    /// Simulator and its version, such as `native 0.1.0`.
    pub simulator: String,
    /// Ego that was run.
    pub ego: String,
    /// Road users: the ego first, then the partners in the scenario's order, then background traffic.
    pub actors: Vec<ActorTrack>,
    /// Static obstacles, in the scenario's order.
    pub obstacles: Vec<PlacedObstacle>,
    /// What happened, in order of time.
    pub events: Vec<Event>,
    /// How it ended.
    pub termination: Termination,
    /// FNV-1a over the bits of every state, in hexadecimal.
    pub state_hash: String,
}

/// What an actor is to the scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Subject vehicle.
    Ego,
    /// Scripted crash partner.
    Partner,
    /// Background traffic.
    Traffic,
}

/// One road user over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ActorTrack {
    /// Name; [`EGO_ID`] for the ego.
    pub id: String,
    /// What it is to the scenario.
    pub role: Role,
    /// Kind.
    pub kind: PartnerKind,
    /// Length of its box. [m]
    pub length_m: f64,
    /// Width of its box. [m]
    pub width_m: f64,
    /// One state per step, from time 0.
    pub states: Vec<ActorState>,
}

/// State of an actor at one step, and the controls it chose for the next.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ActorState {
    /// Centre, forward. [m]
    pub x: f64,
    /// Centre, left. [m]
    pub y: f64,
    /// Heading. [rad]
    pub heading: f64,
    /// Speed along the heading. [m/s]
    pub speed: f64,
    /// Steering, -1 to 1, left positive (times the vehicle's greatest wheel angle).
    pub steer: f64,
    /// Throttle (positive) or brake (negative), -1 to 1.
    pub throttle: f64,
}

impl ActorState {
    /// Position.
    #[inline]
    pub fn position(&self) -> Vec2 {
        Vec2::new(self.x, self.y)
    }

    /// Position and heading.
    #[inline]
    pub fn pose(&self) -> Pose {
        Pose { position: self.position(), heading: self.heading }
    }
}

impl ActorTrack {
    /// The actor's box at a step.
    pub fn outline(&self, step: usize) -> OrientedBox {
        OrientedBox::new(self.states[step].pose(), self.length_m, self.width_m)
    }
}

/// A static obstacle in the world.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlacedObstacle {
    /// Kind.
    pub kind: ObstacleKind,
    /// Where.
    pub pose: Pose,
    /// Extent along its heading. [m]
    pub length_m: f64,
    /// Extent across. [m]
    pub width_m: f64,
}

impl PlacedObstacle {
    /// Its box.
    pub fn outline(&self) -> OrientedBox {
        OrientedBox::new(self.pose, self.length_m, self.width_m)
    }
}

/// Something that happened at one time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// When, to the physics step. [s]
    pub time_s: f64,
    /// What.
    pub kind: EventKind,
}

/// What happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "event")]
pub enum EventKind {
    /// Two road users touched for the first time.
    Contact {
        /// First actor's position in [`Rollout::actors`]; 0 is the ego.
        a: usize,
        /// Second actor's.
        b: usize,
        /// States of both at that time.
        a_state: ActorState,
        /// States of both at that time.
        b_state: ActorState,
    },
    /// An actor touched an obstacle for the first time.
    ObstacleContact {
        /// Actor.
        actor: usize,
        /// Position in [`Rollout::obstacles`].
        obstacle: usize,
        /// The actor's state at that time.
        state: ActorState,
    },
}

/// How a rollout ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Termination {
    /// Why.
    pub kind: TerminationKind,
    /// When. [s]
    pub time_s: f64,
}

/// Why a rollout ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TerminationKind {
    /// The ego reached the end of its route.
    Arrived,
    /// The ego touched another road user.
    Contact,
    /// The time was up.
    Timeout,
    /// The ego stood still for long with no reason to end.
    Stuck,
    /// The ego left the road.
    OffRoad,
    /// A state was no longer finite.
    Diverged,
}

impl Rollout {
    /// The hash of all states, actor by actor: FNV-1a (64 bits) over the little-endian bits of x, y, heading, speed,
    /// steer and throttle, in hexadecimal.
    pub fn hash_states(actors: &[ActorTrack]) -> String {
        let mut hash = crate::hash::Fnv::default();
        for state in actors.iter().flat_map(|track| &track.states) {
            for number in [state.x, state.y, state.heading, state.speed, state.steer, state.throttle] {
                hash.write(&number.to_bits().to_le_bytes());
            }
        }
        hash.hexadecimal()
    }

    /// The ego's track.
    pub fn ego_track(&self) -> &ActorTrack {
        &self.actors[0]
    }

    /// Number of recorded states of each actor.
    pub fn steps(&self) -> usize {
        self.actors[0].states.len()
    }

    /// An actor's first contact with anything: the time and its state then.
    pub fn first_contact_of(&self, actor: usize) -> Option<(f64, &ActorState)> {
        self.events.iter().find_map(|event| match &event.kind {
            EventKind::Contact { a, a_state, .. } if *a == actor => Some((event.time_s, a_state)),
            EventKind::Contact { b, b_state, .. } if *b == actor => Some((event.time_s, b_state)),
            EventKind::ObstacleContact { actor: who, state, .. } if *who == actor => Some((event.time_s, state)),
            _ => None,
        })
    }

    /// The ego's first contact with a road user: the other's position in `actors`, the time and both states.
    pub fn first_ego_contact(&self) -> Option<(usize, f64, ActorState, ActorState)> {
        self.events.iter().find_map(|event| match event.kind {
            EventKind::Contact { a: 0, b, a_state, b_state } => Some((b, event.time_s, a_state, b_state)),
            _ => None,
        })
    }
}
