//! What is said to a worker and what it answers: one JSON object a line, see `worker/metadrive_worker.py`.
//!
//! A run is told with every place resolved to a lane and a position on it, so that MetaDrive decides nothing.

use crate::METADRIVE_VERSION;
use crate::worker::NotReady;
use recrash_model::record::PartnerKind;
use recrash_model::rollout::{
    ActorState, ActorTrack, EGO_ID, Event, EventKind, ROLLOUT_FORMAT, Role, Rollout, Termination, TerminationKind,
};
use recrash_model::scenario::{DEFAULT_SPEED_KP, LateralMove, MapSpec, ObstacleKind, Policy, ScenarioDraft};
use recrash_model::vehicle::{DRY_TYRE_FRICTION, VehicleSpec};
use recrash_roads::{Footprint, LanePath, Scenario, TRAFFIC_SPEED_MPS, TrafficPlacement, background_traffic};
use serde::{Deserialize, Serialize};
use serde_json::Value;

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
    /// Background traffic, numbered after the partners.
    traffic: Vec<ActorSpec>,
    obstacles: Vec<ObstacleSpec>,
    duration_s: f64,
    /// Every road user, in the order of the tracks that come back.
    #[serde(skip)]
    cast: Vec<Member>,
}

/// Who a track belongs to.
#[derive(Debug, Clone, PartialEq)]
struct Member {
    id: String,
    role: Role,
    kind: PartnerKind,
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
    /// The wanted line may run at no more than this angle to the lane. [rad]
    greatest_drift_rad: f64,
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
pub(crate) fn run_spec(scenario: &Scenario, drive: &Drive) -> RunSpec {
    let draft = scenario.draft();
    let traffic = background_traffic(scenario);
    let ways = ways(scenario, &traffic);
    let actor = |number: usize, t_m: f64, speed_mps: f64, target_speed_mps: f64| {
        actor(scenario, &ways[number], t_m, speed_mps, target_speed_mps)
    };
    let mut ego = actor(0, scenario.ego().t_m, scenario.ego().speed_mps, draft.ego.target_speed_mps);
    if let Drive::OpenLoop(controls) = drive {
        ego.controls = Some(controls.clone());
    }
    let partners =
        draft.partners.iter().zip(scenario.partners()).enumerate().map(|(position, (partner, placement))| {
            let number = position + 1;
            let mut spec = actor(number, placement.t_m, placement.speed_mps, partner.policy.target_speed());
            spec.policy = Some(policy_value(&partner.policy));
            spec.lateral.clone_from(&partner.lateral);
            if matches!(partner.policy, Policy::Yielding { .. }) {
                spec.crossings = crossings(&ways, number);
            }
            spec
        });
    let first_traffic = draft.partners.len() + 1;
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
    RunSpec {
        map: draft.map.clone(),
        partners: partners.collect(),
        traffic: (first_traffic..ways.len()).map(|number| actor(number, 0.0, 0.0, TRAFFIC_SPEED_MPS)).collect(),
        ego,
        obstacles: obstacles.collect(),
        duration_s: draft.duration_s,
        cast: cast(draft, &ways),
    }
}

/// What a road user is and where its lanes lead: the ego, the partners, background traffic.
struct Way<'a> {
    kind: PartnerKind,
    path: &'a LanePath,
    s_m: f64,
}

impl Way<'_> {
    /// Position of the lane it starts on in its path.
    fn first(&self) -> usize {
        self.path.segment_at(self.s_m)
    }

    /// Where on the path the way of the worker begins: at the beginning of the lane it starts on. [m]
    fn begins_m(&self) -> f64 {
        self.path.segments[self.first()].start_m
    }
}

fn ways<'a>(scenario: &'a Scenario, traffic: &'a [TrafficPlacement]) -> Vec<Way<'a>> {
    let placed = std::iter::once(scenario.ego()).chain(scenario.partners());
    let placed = placed.map(|placement| Way { kind: placement.kind, path: &placement.path, s_m: placement.s_m });
    placed.chain(traffic.iter().map(|each| Way { kind: each.kind, path: &each.path, s_m: each.s_m })).collect()
}

fn cast(draft: &ScenarioDraft, ways: &[Way<'_>]) -> Vec<Member> {
    let partners = draft.partners.len();
    let member = |(number, way): (usize, &Way<'_>)| {
        let (id, role) = match number {
            0 => (EGO_ID.to_owned(), Role::Ego),
            _ if number <= partners => (draft.partners[number - 1].id.clone(), Role::Partner),
            _ => (format!("traffic{}", number - partners), Role::Traffic),
        };
        Member { id, role, kind: way.kind }
    };
    ways.iter().enumerate().map(member).collect()
}

/// The policy with every default written out.
fn policy_value(policy: &Policy) -> Value {
    let mut value = serde_json::to_value(policy).unwrap_or_default();
    if let Value::Object(fields) = &mut value {
        fields.entry("speed_kp").or_insert_with(|| DEFAULT_SPEED_KP.into());
    }
    value
}

fn actor(scenario: &Scenario, way: &Way<'_>, t_m: f64, speed_mps: f64, target_speed_mps: f64) -> ActorSpec {
    let network = scenario.network();
    let lanes = way.path.segments[way.first()..].iter().map(|segment| {
        let lane = network.lane(segment.lane);
        let road = network.road(lane.road);
        (road.from.clone(), road.to.clone(), lane.index)
    });
    let size = VehicleSpec::of(way.kind);
    ActorSpec {
        way: lanes.collect(),
        s_m: way.s_m - way.begins_m(),
        t_m,
        speed_mps,
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
            friction: DRY_TYRE_FRICTION * scenario.draft().environment.surface.relative_friction(),
        },
        controls: None,
        policy: None,
        lateral: Vec::new(),
        greatest_drift_rad: if VehicleSpec::is_nimble(way.kind) { 1.3 } else { 0.5 },
        crossings: Vec::new(),
    }
}

/// Where the way of an actor meets the others', see `docs/models/policies.md`.
fn crossings(ways: &[Way<'_>], me: usize) -> Vec<CrossingSpec> {
    let own = &ways[me];
    let size = VehicleSpec::of(own.kind);
    let mut found = Vec::new();
    for (other, way) in ways.iter().enumerate().filter(|(other, _)| *other != me) {
        let other_size = VehicleSpec::of(way.kind);
        let meets = own.path.conflict(way.path, size.width_m, other_size.width_m);
        let Some(conflict) = meets else { continue };
        let (reach, other_reach) =
            conflict.reaches((own.path, Footprint::of(own.kind)), (way.path, Footprint::of(way.kind)));
        // JSON has no infinity; no map is this long.
        let stretch = |s: f64, reach: f64| (s - reach, if conflict.merges { 1e9 } else { s + reach });
        let mine = stretch(conflict.s_a - own.begins_m(), reach);
        let theirs = stretch(conflict.s_b - way.begins_m(), other_reach);
        found.push(CrossingSpec { other, mine, theirs, merges: conflict.merges });
    }
    found
}

/// A finished run as a rollout; `None` where the answer does not fit the scenario.
pub(crate) fn rollout(scenario: &Scenario, drive: &Drive, spec: &RunSpec, done: Done) -> Option<Rollout> {
    let steps = done.tracks.first()?.len();
    let fits = done.tracks.len() == spec.cast.len()
        && steps > 0
        && done.tracks.iter().all(|track| track.len() == steps)
        && done.time_s.is_finite();
    if !fits {
        return None;
    }
    let actors: Vec<ActorTrack> =
        spec.cast.iter().zip(&done.tracks).map(|(member, states)| track(member, states)).collect();
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

fn track(member: &Member, states: &[[f64; 7]]) -> ActorTrack {
    let size = VehicleSpec::of(member.kind);
    ActorTrack {
        id: member.id.clone(),
        role: member.role,
        kind: member.kind,
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
