//! What is said to a worker and what it answers: one JSON object a line, see `crates/plan/python/run_metadrive.py`.

use crate::METADRIVE_VERSION;
use crate::worker::NotReady;
use recrash_model::rollout::{
    ActorState, ActorTrack, Event, EventKind, ROLLOUT_FORMAT, Rollout, Termination, TerminationKind,
};
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::metadrive::{Actor, Run};
use recrash_roads::Scenario;
use serde::{Deserialize, Serialize};

/// Who drives the ego.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// MetaDrive's own IDM policy, at the scenario's target speed.
    MetadriveIdm,
    /// Given controls, steering and throttle per step of 0.1 s, both -1 to 1; none behind their end. Only a contact or
    /// time ends such a run: it may leave the road.
    OpenLoop(Vec<[f64; 2]>),
}

impl Drive {
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::MetadriveIdm => "metadrive-idm",
            Self::OpenLoop(_) => "open-loop",
        }
    }
}

/// A request.
#[derive(Debug, Serialize)]
pub(crate) struct Request<'a> {
    pub(crate) id: u64,
    pub(crate) run: &'a Run,
}

/// Anything a worker says.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(crate) enum Message {
    Hello { hello: Hello },
    Answer(Answer),
}

/// What a worker says first.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
pub(crate) struct Hello {
    pub(crate) python: String,
    pub(crate) metadrive: Option<String>,
    pub(crate) problem: Option<Problem>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub(crate) struct Problem {
    kind: String,
    detail: String,
}

impl Problem {
    pub(crate) fn reason(&self, hello: &Hello) -> NotReady {
        match self.kind.as_str() {
            "metadrive_missing" => NotReady::Missing { python: hello.python.clone() },
            "metadrive_version" => NotReady::Version { found: hello.metadrive.clone().unwrap_or_default() },
            _ => NotReady::Import { detail: self.detail.clone() },
        }
    }
}

#[derive(Debug, Deserialize)]
pub(crate) struct Answer {
    pub(crate) id: u64,
    #[serde(default)]
    pub(crate) done: Option<Done>,
    #[serde(default)]
    pub(crate) error: Option<String>,
}

/// A finished run.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(crate) struct Done {
    end: TerminationKind,
    time_s: f64,
    /// Per actor, per step: x, y, heading, velocity along x and y, steering, throttle.
    tracks: Vec<Vec<[f64; 7]>>,
    events: Vec<DoneEvent>,
    pub(crate) maps: u64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct DoneEvent {
    time_s: f64,
    a: usize,
    a_state: [f64; 7],
    #[serde(default)]
    b: Option<usize>,
    #[serde(default)]
    b_state: Option<[f64; 7]>,
    #[serde(default)]
    obstacle: Option<usize>,
}

/// A scenario as a worker takes it.
pub(crate) fn run_spec(scenario: &Scenario, drive: &Drive) -> Run {
    let mut run = Run::new(scenario);
    if let Drive::OpenLoop(controls) = drive {
        run.ego.controls = Some(controls.clone());
    }
    run
}

/// A finished run as a rollout; `None` where the answer does not fit the scenario.
pub(crate) fn rollout(scenario: &Scenario, drive: &Drive, run: &Run, done: Done) -> Option<Rollout> {
    let steps = done.tracks.first()?.len();
    let fits = done.tracks.len() == run.actors().count()
        && steps > 0
        && done.tracks.iter().all(|track| track.len() == steps)
        && done.time_s.is_finite();
    if !fits {
        return None;
    }
    let actors: Vec<ActorTrack> = run.actors().zip(&done.tracks).map(|(actor, states)| track(actor, states)).collect();
    let events = done.events.iter().map(|each| event(each, actors.len(), scenario.obstacles().len()));
    Some(Rollout {
        format: ROLLOUT_FORMAT.to_owned(),
        scenario_id: scenario.draft().id.clone(),
        simulator: format!("MetaDrive {METADRIVE_VERSION}"),
        ego: drive.name().to_owned(),
        events: events.collect::<Option<_>>()?,
        obstacles: scenario.obstacles().iter().map(|obstacle| obstacle.placed).collect(),
        termination: Termination { kind: done.end, time_s: done.time_s },
        state_hash: Rollout::hash_states(&actors),
        actors,
    })
}

fn track(actor: &Actor, states: &[[f64; 7]]) -> ActorTrack {
    let size = VehicleSpec::of(actor.kind);
    ActorTrack {
        part_of: None,
        appears_s: 0.0,
        gone_s: None,
        id: actor.id.clone(),
        role: actor.role,
        kind: actor.kind,
        length_m: size.length_m,
        width_m: size.width_m,
        states: states.iter().map(state).collect(),
    }
}

fn state(&[x, y, heading, vx, vy, steer, throttle]: &[f64; 7]) -> ActorState {
    ActorState { x, y, heading, vx, vy, steer, throttle }
}

fn event(done: &DoneEvent, actors: usize, obstacles: usize) -> Option<Event> {
    let kind = match (done.b, done.b_state, done.obstacle) {
        (Some(b), Some(b_state), None) if done.a < actors && b < actors => {
            EventKind::Contact { a: done.a, b, a_state: state(&done.a_state), b_state: state(&b_state) }
        }
        (None, None, Some(obstacle)) if done.a < actors && obstacle < obstacles => {
            EventKind::ObstacleContact { actor: done.a, obstacle, state: state(&done.a_state) }
        }
        _ => return None,
    };
    Some(Event { time_s: done.time_s, kind })
}
