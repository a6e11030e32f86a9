//! Rollouts: what happened in one simulation of one scenario.

use crate::geometry::{OrientedBox, Pose, Vec2};
use crate::kinds::PartnerKind;
use crate::scenario::ObstacleKind;
use crate::vehicle::VehicleSpec;
use serde::{Deserialize, Serialize};

/// The rollouts' format tag.
pub const ROLLOUT_FORMAT: &str = "recrash.rollout/2";

/// The format before it, which is still read: states had a speed along the heading in place of a velocity.
const ROLLOUT_FORMAT_1: &str = "recrash.rollout/1";

/// Time between two recorded states, and between two decisions. [s]
pub const STEP_S: f64 = 0.1;

/// Recorded states in a second.
const STEPS_PER_S: f64 = 10.0;

/// Number of the last state that was recorded by a time [s]. Times are multiplied, never divided by [`STEP_S`]: 9.1 / 0.1 is less than 91.
pub fn step_of(time_s: f64) -> usize {
    (time_s * STEPS_PER_S) as usize
}

/// Who is slower than this stands. [m/s]
pub const STANDS_MPS: f64 = 0.1;

/// Physics steps in one step, as MetaDrive has them.
pub const SUBSTEPS: usize = 5;

/// The usual physics step. [s]
pub const PHYSICS_STEP_S: f64 = STEP_S / SUBSTEPS as f64;

/// Physics steps in one step of a run: [`SUBSTEPS`], unless somebody asks whether the result hangs on that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(from = "u8", into = "u8")]
pub struct Substeps(u8);

impl Substeps {
    /// So many; one at least.
    pub const fn new(count: u8) -> Self {
        Self(if count == 0 { 1 } else { count })
    }

    /// How many.
    pub const fn count(self) -> u8 {
        self.0
    }

    /// How long one is. [s]
    pub fn step_s(self) -> f64 {
        STEP_S / f64::from(self.0)
    }
}

impl Default for Substeps {
    fn default() -> Self {
        Self::new(SUBSTEPS as u8)
    }
}

impl From<u8> for Substeps {
    fn from(count: u8) -> Self {
        Self::new(count)
    }
}

impl From<Substeps> for u8 {
    fn from(substeps: Substeps) -> Self {
        substeps.count()
    }
}

/// Where who is not in the world is taken for. [m]
const NOWHERE_M: f64 = 1e6;

/// Name of the ego in every list of actors; it is always the first.
pub const EGO_ID: &str = "ego";

/// One simulation. There is at least one actor, and all tracks are equally long, by a state or more: whatever is read is refused where it is
/// not so.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "RolloutOnDisk")]
pub struct Rollout {
    /// Always [`ROLLOUT_FORMAT`]: what was read of an older format is turned into this one.
    pub format: String,
    /// Scenario.
    pub scenario_id: String,
    /// Simulator and its version, such as `native 0.1.0`.
    pub simulator: String,
    /// Ego that was run.
    pub ego: String,
    /// Road users: the ego first, then the partners and the actors in the scenario's order, then background traffic, then
    /// parts of any of them.
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
    /// A box that belongs to another road user: a door, a mirror, a trailer.
    Part,
}

/// One road user over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ActorTrack {
    /// Name; [`EGO_ID`] for the ego.
    pub id: String,
    /// What it is to the scenario.
    pub role: Role,
    /// Of a part: its owner's position among the actors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part_of: Option<usize>,
    /// Kind.
    pub kind: PartnerKind,
    /// Length of its box. [m]
    pub length_m: f64,
    /// Width of its box. [m]
    pub width_m: f64,
    /// Its mass, where the scenario gives it one that is not its kind's. [kg]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// It is not in the world before this time. [s]
    #[serde(default, skip_serializing_if = "is_zero")]
    pub appears_s: f64,
    /// It is not in the world from this time on. [s]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gone_s: Option<f64>,
    /// One state per step, from time 0; before it appears and after it is gone, where it would be.
    pub states: Vec<ActorState>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// State of an actor at one step, and the controls it chose for the next.
///
/// The velocity is that of the centre, over ground: a vehicle that slips sideways does not move where it points.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "StateOnDisk")]
pub struct ActorState {
    /// Centre, forward. [m]
    pub x: f64,
    /// Centre, left. [m]
    pub y: f64,
    /// Heading. [rad]
    pub heading: f64,
    /// Velocity of the centre, forward. [m/s]
    pub vx: f64,
    /// Velocity of the centre, left. [m/s]
    pub vy: f64,
    /// Steering, -1 to 1, left positive (times the vehicle's greatest wheel angle).
    pub steer: f64,
    /// Throttle (positive) or brake (negative), -1 to 1.
    pub throttle: f64,
}

impl ActorState {
    /// At a place, moving along its heading at a speed [m/s], with no controls.
    pub fn moving(pose: Pose, speed_mps: f64) -> Self {
        let velocity = Vec2::from_heading(pose.heading) * speed_mps;
        Self {
            x: pose.position.x,
            y: pose.position.y,
            heading: pose.heading,
            vx: velocity.x,
            vy: velocity.y,
            ..Self::default()
        }
    }

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

    /// Velocity over ground. [m/s]
    #[inline]
    pub fn velocity(&self) -> Vec2 {
        Vec2::new(self.vx, self.vy)
    }

    /// Speed along the heading; negative backwards. [m/s]
    #[inline]
    pub fn speed(&self) -> f64 {
        self.velocity().dot(Vec2::from_heading(self.heading))
    }

    /// Whether it stands, however it points.
    #[inline]
    pub fn stands(&self) -> bool {
        self.velocity().length() < STANDS_MPS
    }

    /// Whether every number of it is finite.
    pub fn is_finite(&self) -> bool {
        self.numbers().iter().all(|number| number.is_finite())
    }

    fn numbers(&self) -> [f64; 7] {
        [self.x, self.y, self.heading, self.vx, self.vy, self.steer, self.throttle]
    }
}

impl ActorTrack {
    /// Its state at a step; behind the end the last one.
    pub fn at(&self, step: usize) -> &ActorState {
        &self.states[self.within(step)]
    }

    /// A step, or the last one where that is earlier.
    pub fn within(&self, step: usize) -> usize {
        step.min(self.states.len() - 1)
    }

    /// Number of the last state that was recorded by a time. [s]
    pub fn step_at(&self, time_s: f64) -> usize {
        self.within(step_of(time_s))
    }

    /// All states that were recorded by a time. [s]
    pub fn until(&self, time_s: f64) -> &[ActorState] {
        &self.states[..=self.step_at(time_s)]
    }

    /// Its mass; `None` for what stands firm. [kg]
    pub fn mass_kg(&self) -> Option<f64> {
        self.mass_kg.or(VehicleSpec::mass_kg(self.kind))
    }

    /// The actor's box at a step; far away from everything while it is not in the world.
    pub fn outline(&self, step: usize) -> OrientedBox {
        let mut pose = self.states[step].pose();
        if !self.is_present(step) {
            pose.position = Vec2::new(NOWHERE_M, NOWHERE_M);
        }
        OrientedBox::new(pose, self.length_m, self.width_m)
    }

    /// Whether it is in the world at a step.
    pub fn is_present(&self, step: usize) -> bool {
        let time_s = step as f64 * STEP_S;
        time_s >= self.appears_s - 1e-9 && self.gone_s.is_none_or(|gone_s| time_s < gone_s - 1e-9)
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
    /// An actor left the world because its plan says so.
    Gone {
        /// Actor.
        actor: usize,
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

impl TerminationKind {
    /// For tables and sentences.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Arrived => "arrived",
            Self::Contact => "contact",
            Self::Timeout => "timeout",
            Self::Stuck => "stuck",
            Self::OffRoad => "off road",
            Self::Diverged => "diverged",
        }
    }
}

impl Rollout {
    /// The same with the hash of its states.
    pub fn named(self) -> Self {
        Self { state_hash: Self::hash_states(&self.actors), ..self }
    }

    /// The hash of all states, actor by actor: FNV-1a (64 bits) over the little-endian bits of x, y, heading, vx,
    /// vy, steer and throttle, in hexadecimal.
    pub fn hash_states(actors: &[ActorTrack]) -> String {
        let mut hash = crate::hash::Fnv::default();
        for state in actors.iter().flat_map(|track| &track.states) {
            for number in state.numbers() {
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

/// A rollout as files have it, of this format or the one before.
#[derive(Deserialize)]
struct RolloutOnDisk {
    format: String,
    scenario_id: String,
    simulator: String,
    ego: String,
    actors: Vec<ActorTrack>,
    obstacles: Vec<PlacedObstacle>,
    events: Vec<Event>,
    termination: Termination,
    state_hash: String,
}

impl TryFrom<RolloutOnDisk> for Rollout {
    type Error = String;

    fn try_from(read: RolloutOnDisk) -> Result<Self, String> {
        let state_hash = match read.format.as_str() {
            ROLLOUT_FORMAT => read.state_hash,
            // The hash is of what the states hold, and they hold something else now.
            ROLLOUT_FORMAT_1 => Self::hash_states(&read.actors),
            other => {
                return Err(format!(
                    "this is a rollout of format `{other}`; `{ROLLOUT_FORMAT}` and `{ROLLOUT_FORMAT_1}` can be read"
                ));
            }
        };
        check_tracks(&read.actors)?;
        Ok(Self {
            format: ROLLOUT_FORMAT.to_owned(),
            scenario_id: read.scenario_id,
            simulator: read.simulator,
            ego: read.ego,
            actors: read.actors,
            obstacles: read.obstacles,
            events: read.events,
            termination: read.termination,
            state_hash,
        })
    }
}

/// Whether there is an ego, and every track has as many states as its own.
fn check_tracks(actors: &[ActorTrack]) -> Result<(), String> {
    let Some(ego) = actors.first().filter(|ego| !ego.states.is_empty()) else {
        return Err("`actors` needs the ego first, with one state or more".to_owned());
    };
    let steps = ego.states.len();
    match actors.iter().find(|track| track.states.len() != steps) {
        Some(track) => Err(format!(
            "`actors`: `{}` has {} states and the ego {steps}; every track has one at each step",
            track.id,
            track.states.len()
        )),
        None => Ok(()),
    }
}

/// A state as files have it: with a velocity, or with a speed along the heading (format 1).
#[derive(Deserialize)]
struct StateOnDisk {
    x: f64,
    y: f64,
    heading: f64,
    vx: Option<f64>,
    vy: Option<f64>,
    speed: Option<f64>,
    steer: f64,
    throttle: f64,
}

impl TryFrom<StateOnDisk> for ActorState {
    type Error = String;

    fn try_from(read: StateOnDisk) -> Result<Self, String> {
        let StateOnDisk { x, y, heading, steer, throttle, .. } = read;
        let velocity = match (read.vx, read.vy, read.speed) {
            (Some(vx), Some(vy), None) => Vec2::new(vx, vy),
            (None, None, Some(speed)) => Vec2::from_heading(heading) * speed,
            _ => return Err("a state has `vx` and `vy`, or `speed` (format 1)".to_owned()),
        };
        Ok(Self { x, y, heading, vx: velocity.x, vy: velocity.y, steer, throttle })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn document(format: &str, state: serde_json::Value) -> serde_json::Value {
        json!({
            "format": format, "scenario_id": "case", "simulator": "native", "ego": "idm",
            "actors": [{
                "id": "ego", "role": "ego", "kind": "passenger_car", "length_m": 4.5, "width_m": 1.9, "states": [state],
            }],
            "obstacles": [], "events": [], "termination": { "kind": "timeout", "time_s": 0.0 }, "state_hash": "of a file",
        })
    }

    #[test]
    fn speed_is_the_part_of_the_velocity_along_the_heading() {
        let pose = Pose { position: Vec2::new(1.0, 2.0), heading: crate::math::FRAC_PI_2 };
        let state = ActorState::moving(pose, 5.0);
        assert!((state.speed() - 5.0).abs() < 1e-15 && state.vx.abs() < 1e-15 && (state.vy - 5.0).abs() < 1e-15);
        // 3 m/s to the side on top: no more speed along the heading.
        let slipping = ActorState { vx: 3.0, ..state };
        assert!((slipping.speed() - 5.0).abs() < 1e-15);
        assert!((slipping.velocity().length() - 34.0_f64.sqrt()).abs() < 1e-15);
        let backwards = ActorState { vx: 0.0, vy: -2.0, ..state };
        assert_eq!(backwards.speed(), -2.0);
    }

    #[test]
    fn a_rollout_is_read_as_it_was_written() {
        let state = json!({ "x": 1, "y": 2, "heading": 0.5, "vx": 3, "vy": 4, "steer": 0, "throttle": 1 });
        let read: Rollout = serde_json::from_value(document(ROLLOUT_FORMAT, state)).unwrap();
        assert_eq!((read.actors[0].states[0].vx, read.actors[0].states[0].vy), (3.0, 4.0));
        let again: Rollout = serde_json::from_value(serde_json::to_value(&read).unwrap()).unwrap();
        assert_eq!(again, read);
    }

    #[test]
    fn a_rollout_of_format_1_moves_along_its_headings() {
        let heading = crate::math::PI / 6.0;
        let state = json!({ "x": 1, "y": 2, "heading": heading, "speed": 10, "steer": 0, "throttle": 1 });
        let read: Rollout = serde_json::from_value(document("recrash.rollout/1", state)).unwrap();
        assert_eq!(read.format, ROLLOUT_FORMAT);
        let state = &read.actors[0].states[0];
        assert!((state.vx - 75.0_f64.sqrt()).abs() < 1e-12 && (state.vy - 5.0).abs() < 1e-12, "{state:?}");
        assert_eq!(read.state_hash, Rollout::hash_states(&read.actors));
    }

    #[test]
    fn every_time_of_a_step_falls_into_that_step() {
        for step in 0..=3000 {
            assert_eq!(step_of(step as f64 * STEP_S), step);
            assert_eq!(step_of(step as f64 / STEPS_PER_S), step);
        }
        assert_eq!(step_of(9.15), 91);
    }

    #[test]
    fn tracks_of_different_lengths_and_none_at_all_are_refused() {
        let state = json!({ "x": 1, "y": 2, "heading": 0.5, "vx": 3, "vy": 4, "steer": 0, "throttle": 1 });
        let mut read = document(ROLLOUT_FORMAT, state.clone());
        let mut other = read["actors"][0].clone();
        other["id"] = json!("cp");
        other["states"] = json!([state, state]);
        read["actors"].as_array_mut().unwrap().push(other);
        let error = serde_json::from_value::<Rollout>(read.clone()).unwrap_err().to_string();
        assert!(error.contains("`cp` has 2 states and the ego 1"), "{error}");
        read["actors"] = json!([]);
        let error = serde_json::from_value::<Rollout>(read).unwrap_err().to_string();
        assert!(error.contains("needs the ego first"), "{error}");
    }

    #[test]
    fn an_unknown_format_and_a_state_without_a_velocity_say_what_is_wrong() {
        let state = json!({ "x": 1, "y": 2, "heading": 0, "vx": 3, "vy": 4, "steer": 0, "throttle": 1 });
        let error = serde_json::from_value::<Rollout>(document("recrash.rollout/9", state)).unwrap_err().to_string();
        assert!(error.contains("`recrash.rollout/9`") && error.contains(ROLLOUT_FORMAT), "{error}");
        let state = json!({ "x": 1, "y": 2, "heading": 0, "vx": 3, "steer": 0, "throttle": 1 });
        let error = serde_json::from_value::<Rollout>(document(ROLLOUT_FORMAT, state)).unwrap_err().to_string();
        assert!(error.contains("`vx` and `vy`"), "{error}");
    }
}
