//! What is said to a worker and what it answers: one JSON object a line, see `worker/metadrive_worker.py`.
//!
//! A run is told with every place resolved to a lane and a position on it, so that MetaDrive decides nothing.

use crate::worker::NotReady;
use crate::{METADRIVE_VERSION, MetadriveError};
use recrash_model::record::Surface;
use recrash_model::rollout::{
    ActorState, ActorTrack, EGO_ID, Event, EventKind, ROLLOUT_FORMAT, Role, Rollout, Termination, TerminationKind,
};
use recrash_model::scenario::{DEFAULT_SPEED_KP, LateralMove, MapSpec, ObstacleKind, Policy, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;
use recrash_model::{math, record::PartnerKind};
use recrash_roads::{Conflict, Placement, Scenario};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Who drives the ego.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// MetaDrive's own IDM policy, at the scenario's target speed.
    MetadriveIdm,
    /// Given controls, steering and throttle per step of 0.1 s, both -1 to 1; none behind their end.
    OpenLoop(Vec<[f64; 2]>),
}

impl Drive {
    fn name(&self) -> &'static str {
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
    pub(crate) run: &'a RunSpec,
}

/// A scenario, resolved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct RunSpec {
    map: MapSpec,
    ego: ActorSpec,
    partners: Vec<ActorSpec>,
    obstacles: Vec<ObstacleSpec>,
    duration_s: f64,
}

/// A road user.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ActorSpec {
    /// Lanes from where it starts: node, node, number.
    way: Vec<(String, String, u8)>,
    /// Start on the first of them. [m]
    s_m: f64,
    t_m: f64,
    speed_mps: f64,
    target_speed_mps: f64,
    body: BodySpec,
    #[serde(skip_serializing_if = "Option::is_none")]
    controls: Option<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    policy: Option<Value>,
    lateral: Vec<LateralMove>,
    crossings: Vec<CrossingSpec>,
}

/// Size and limits, as in [`VehicleSpec`].
#[derive(Debug, Clone, PartialEq, Serialize)]
struct BodySpec {
    length_m: f64,
    width_m: f64,
    chassis_length_m: f64,
    chassis_width_m: f64,
    front_axle_m: f64,
    rear_axle_m: f64,
    half_track_m: f64,
    acceleration_mps2: f64,
    brake_mps2: f64,
    speed_mps: f64,
    wheel_angle_rad: f64,
    friction: f64,
}

/// Where somebody who gives way meets somebody else's way; stretches count from where each way begins.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct CrossingSpec {
    other: usize,
    mine: (f64, f64),
    theirs: (f64, f64),
    merges: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct ObstacleSpec {
    kind: ObstacleKind,
    lane: (String, String, u8),
    x: f64,
    y: f64,
    heading: f64,
    length_m: f64,
    width_m: f64,
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
    /// Per actor, per step: x, y, heading, speed, steering, throttle.
    tracks: Vec<Vec<[f64; 6]>>,
    events: Vec<DoneEvent>,
    pub(crate) maps: u64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct DoneEvent {
    time_s: f64,
    a: usize,
    a_state: [f64; 6],
    #[serde(default)]
    b: Option<usize>,
    #[serde(default)]
    b_state: Option<[f64; 6]>,
    #[serde(default)]
    obstacle: Option<usize>,
}

/// Tyre friction of MetaDrive's vehicles on its only surface, taken for a dry road.
const DRY_FRICTION: f64 = 0.9;

/// Friction by surface, the native simulator's ratios (`docs/models/vehicle.md`).
fn friction(surface: Surface) -> f64 {
    DRY_FRICTION
        * match surface {
            Surface::Dry => 1.0,
            Surface::Wet => 0.7,
            Surface::SnowIce => 0.3,
        }
}

/// A scenario as a worker takes it.
pub(crate) fn run_spec(scenario: &Scenario, drive: &Drive) -> Result<RunSpec, MetadriveError> {
    let draft = scenario.draft();
    if draft.traffic.density >= 0.01 {
        let what = format!("background traffic (density {}) is not built there yet", draft.traffic.density);
        return Err(MetadriveError::Unsupported { scenario: draft.id.clone(), what });
    }
    let surface = draft.environment.surface;
    let mut ego = actor(scenario, scenario.ego(), draft.ego.target_speed_mps, surface);
    if let Drive::OpenLoop(controls) = drive {
        ego.controls = Some(controls.clone());
    }
    let partners =
        draft.partners.iter().zip(scenario.partners()).enumerate().map(|(position, (partner, placement))| {
            let mut spec = actor(scenario, placement, partner.policy.target_speed(), surface);
            spec.policy = Some(policy_value(&partner.policy));
            spec.lateral.clone_from(&partner.lateral);
            if matches!(partner.policy, Policy::Yielding { .. }) {
                spec.crossings = crossings(scenario, position + 1);
            }
            spec
        });
    let obstacles = scenario.obstacles().iter().map(|obstacle| {
        let lane = scenario.network().lane(obstacle.lane);
        let road = scenario.network().road(lane.road);
        let placed = obstacle.placed;
        ObstacleSpec {
            kind: placed.kind,
            lane: (road.from.clone(), road.to.clone(), lane.index),
            x: placed.pose.position.x,
            y: placed.pose.position.y,
            heading: placed.pose.heading,
            length_m: placed.length_m,
            width_m: placed.width_m,
        }
    });
    Ok(RunSpec {
        map: draft.map.clone(),
        partners: partners.collect(),
        ego,
        obstacles: obstacles.collect(),
        duration_s: draft.duration_s,
    })
}

/// The policy with every default written out.
fn policy_value(policy: &Policy) -> Value {
    let mut value = serde_json::to_value(policy).unwrap_or_default();
    if let Value::Object(fields) = &mut value {
        fields.entry("speed_kp").or_insert_with(|| DEFAULT_SPEED_KP.into());
    }
    value
}

fn actor(scenario: &Scenario, placement: &Placement, target_speed_mps: f64, surface: Surface) -> ActorSpec {
    let network = scenario.network();
    let first = placement.path.segment_at(placement.s_m);
    let way = placement.path.segments[first..].iter().map(|segment| {
        let lane = network.lane(segment.lane);
        let road = network.road(lane.road);
        (road.from.clone(), road.to.clone(), lane.index)
    });
    let size = VehicleSpec::of(placement.kind);
    ActorSpec {
        way: way.collect(),
        s_m: placement.s_m - placement.path.segments[first].start_m,
        t_m: placement.t_m,
        speed_mps: placement.speed_mps,
        target_speed_mps,
        body: BodySpec {
            length_m: size.length_m,
            width_m: size.width_m,
            chassis_length_m: size.chassis_length_m,
            chassis_width_m: size.chassis_width_m,
            front_axle_m: size.front_axle_m,
            rear_axle_m: size.rear_axle_m,
            half_track_m: size.half_track_m,
            acceleration_mps2: size.max_acceleration_mps2,
            brake_mps2: size.brake_demand_mps2,
            speed_mps: size.max_speed_mps,
            wheel_angle_rad: size.max_wheel_angle_rad,
            friction: friction(surface),
        },
        controls: None,
        policy: None,
        lateral: Vec::new(),
        crossings: Vec::new(),
    }
}

/// Where the way of an actor (0 is the ego) meets the others', see `docs/models/policies.md`.
fn crossings(scenario: &Scenario, me: usize) -> Vec<CrossingSpec> {
    let placements: Vec<&Placement> = std::iter::once(scenario.ego()).chain(scenario.partners()).collect();
    let begins = |placement: &Placement| placement.path.segments[placement.path.segment_at(placement.s_m)].start_m;
    let own = placements[me];
    let size = VehicleSpec::of(own.kind);
    let mut found = Vec::new();
    for (other, placement) in placements.iter().enumerate().filter(|(other, _)| *other != me) {
        let other_size = VehicleSpec::of(placement.kind);
        let network = scenario.network();
        let meets = own.path.conflict(&placement.path, network, size.width_m, other_size.width_m);
        let Some(conflict) = meets else { continue };
        let angle =
            own.path.pose(network, conflict.s_a, 0.0).heading - placement.path.pose(network, conflict.s_b, 0.0).heading;
        let mine = stretch(conflict.s_a - begins(own), &size, &other_size, angle, &conflict);
        let theirs = stretch(conflict.s_b - begins(placement), &other_size, &size, angle, &conflict);
        found.push(CrossingSpec { other, mine, theirs, merges: conflict.merges });
    }
    found
}

/// The stretch of a way on which the centre of `mine` may touch `theirs`.
fn stretch(s: f64, mine: &VehicleSpec, theirs: &VehicleSpec, angle: f64, conflict: &Conflict) -> (f64, f64) {
    let (sin, cos) = math::sincos(angle);
    let sin = sin.abs().max(0.5);
    let reach = 0.5 * mine.length_m + 0.5 * (theirs.width_m + mine.width_m * cos.abs()) / sin + 0.5;
    // JSON has no infinity; no map is this long.
    (s - reach, if conflict.merges { 1e9 } else { s + reach })
}

/// A finished run as a rollout; `None` where the answer does not fit the scenario.
pub(crate) fn rollout(scenario: &Scenario, drive: &Drive, done: Done) -> Option<Rollout> {
    let draft = scenario.draft();
    let steps = done.tracks.first()?.len();
    let fits = done.tracks.len() == draft.partners.len() + 1
        && steps > 0
        && done.tracks.iter().all(|track| track.len() == steps)
        && done.time_s.is_finite();
    if !fits {
        return None;
    }
    let actors: Vec<ActorTrack> =
        done.tracks.iter().enumerate().map(|(number, states)| track(scenario, draft, number, states)).collect();
    let events = done.events.iter().map(|each| event(each, actors.len(), scenario.obstacles().len()));
    Some(Rollout {
        format: ROLLOUT_FORMAT.to_owned(),
        scenario_id: draft.id.clone(),
        simulator: format!("MetaDrive {METADRIVE_VERSION}"),
        ego: drive.name().to_owned(),
        events: events.collect::<Option<_>>()?,
        obstacles: scenario.obstacles().iter().map(|obstacle| obstacle.placed).collect(),
        termination: Termination { kind: done.end, time_s: done.time_s },
        state_hash: Rollout::hash_states(&actors),
        actors,
    })
}

fn track(scenario: &Scenario, draft: &ScenarioDraft, number: usize, states: &[[f64; 6]]) -> ActorTrack {
    let partner = number.checked_sub(1);
    let kind = partner.map_or(PartnerKind::PassengerCar, |partner| scenario.partners()[partner].kind);
    let size = VehicleSpec::of(kind);
    ActorTrack {
        id: partner.map_or_else(|| EGO_ID.to_owned(), |partner| draft.partners[partner].id.clone()),
        role: if partner.is_some() { Role::Partner } else { Role::Ego },
        kind,
        length_m: size.length_m,
        width_m: size.width_m,
        states: states.iter().map(state).collect(),
    }
}

fn state([x, y, heading, speed, steer, throttle]: &[f64; 6]) -> ActorState {
    ActorState { x: *x, y: *y, heading: *heading, speed: *speed, steer: *steer, throttle: *throttle }
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
