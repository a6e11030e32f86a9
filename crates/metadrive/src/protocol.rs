//! What is said to a worker and what it answers: one JSON object a line, see `crates/plan/python/run_metadrive.py`.

use crate::METADRIVE_VERSION;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{
    ActorState, ActorTrack, Event, EventKind, ROLLOUT_FORMAT, Role, Rollout, STEP_S, Termination, TerminationKind,
};
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::metadrive::{Actor, EgoPolicy, NO_HANDOVER, Planned, PlannedPart, Run, handover};
use recrash_roads::Scenario;
use serde::{Deserialize, Serialize};

/// Who drives the ego.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// MetaDrive's own IDM policy, at the scenario's target speed.
    MetadriveIdm,
    /// The PPO expert that MetaDrive ships: a network over its own lasers and navigation, which knows no target speed.
    MetadriveExpert,
    /// The recorded driver to the end, where there is one; else MetaDrive's own policy.
    Recorded,
    /// Given controls, steering and throttle per step of 0.1 s, both -1 to 1; none behind their end. Only a contact or
    /// time ends such a run: it may leave the road.
    OpenLoop(Vec<[f64; 2]>),
}

impl Drive {
    /// Policies of MetaDrive's own that can be a system under test.
    pub const POLICIES: [Self; 2] = [Self::MetadriveIdm, Self::MetadriveExpert];

    /// Who drives where there is nothing to test: the recorded driver instead of a policy.
    pub(crate) fn of_nobody(&self) -> &Self {
        match self {
            Self::OpenLoop(_) => self,
            _ => &Self::Recorded,
        }
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::MetadriveIdm => "metadrive-idm",
            Self::MetadriveExpert => "metadrive-expert",
            Self::Recorded => "recorded",
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
    pub(crate) kind: String,
    pub(crate) detail: String,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Answer {
    pub(crate) id: u64,
    #[serde(default)]
    pub(crate) done: Option<Done>,
    #[serde(default)]
    pub(crate) error: Option<String>,
    /// What it cannot know, and goes on with.
    #[serde(default)]
    pub(crate) refused: Option<String>,
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
///
/// # Errors
/// What MetaDrive cannot hold.
pub(crate) fn run_spec(scenario: &Scenario, drive: &Drive) -> Result<Run, String> {
    let handover = if *drive == Drive::Recorded { NO_HANDOVER } else { handover(scenario) };
    let mut run = Run::new(scenario, handover)?;
    if let Drive::OpenLoop(controls) = drive {
        run.ego.controls = Some(controls.clone());
    }
    if *drive == Drive::MetadriveExpert {
        run.ego.policy = Some(EgoPolicy::Expert);
    }
    Ok(run)
}

/// A finished run as a rollout; `None` where the answer does not fit the scenario.
pub(crate) fn rollout(scenario: &Scenario, drive: &Drive, run: &Run, done: Done) -> Option<Rollout> {
    let steps = done.tracks.first()?.len();
    let tracks = empty_tracks(run);
    let fits = done.tracks.len() == tracks.len()
        && steps > 0
        && done.tracks.iter().all(|track| track.len() == steps)
        && done.time_s.is_finite();
    if !fits {
        return None;
    }
    let actors: Vec<ActorTrack> = tracks
        .into_iter()
        .zip(&done.tracks)
        .map(|(track, states)| ActorTrack {
            mass_kg: scenario.draft().actors.iter().find(|actor| actor.id == track.id).and_then(|actor| actor.mass_kg),
            states: states.iter().map(state).collect(),
            ..track
        })
        .collect();
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

/// Everybody's track without a state, in the order of rollouts.
fn empty_tracks(run: &Run) -> Vec<ActorTrack> {
    let (planned, parts) = run.scene.as_ref().map_or((&[][..], &[][..]), |scene| (&scene.planned, &scene.parts));
    let (scripted, traffic): (Vec<&Actor>, Vec<&Actor>) = run.actors().partition(|actor| actor.role != Role::Traffic);
    let driven = |actor: &Actor| {
        let size = VehicleSpec::of(actor.kind);
        track(&actor.id, actor.role, actor.kind, (size.length_m, size.width_m))
    };
    let by_plan = |planned: &Planned| ActorTrack {
        appears_s: f64::from(planned.appears) * STEP_S,
        gone_s: planned.gone.map(|step| f64::from(step) * STEP_S),
        ..track(&planned.id, Role::Partner, planned.kind, (planned.length_m, planned.width_m))
    };
    let of_part = |part: &PlannedPart| ActorTrack {
        part_of: Some(part.owner),
        ..track(&part.id, Role::Part, part.kind, (part.length_m, part.width_m))
    };
    let all = scripted.into_iter().map(driven).chain(planned.iter().map(by_plan));
    all.chain(traffic.into_iter().map(driven)).chain(parts.iter().map(of_part)).collect()
}

fn track(id: &str, role: Role, kind: PartnerKind, (length_m, width_m): (f64, f64)) -> ActorTrack {
    let id = id.to_owned();
    ActorTrack {
        id,
        role,
        part_of: None,
        kind,
        length_m,
        width_m,
        mass_kg: None,
        appears_s: 0.0,
        gone_s: None,
        states: Vec::new(),
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
