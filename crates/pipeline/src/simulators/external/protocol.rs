//! What is said to an external ego and what it answers: one JSON object a line, see `docs/ego-protocol.md`.

use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorState, STEP_S, Termination};
use recrash_model::scenario::{Aspect, MissionStop, ObstacleKind};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{Scenario, StopLine};
use recrash_sim::{CastMember, Controls, Observation};
use serde::{Deserialize, Serialize};

/// The protocol's name and version.
pub(crate) const PROTOCOL: &str = "recrash.ego/1";

/// Points of the route are this far apart at most. [m]
const ROUTE_SPACING_M: f64 = 1.0;

/// What recrash says.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Said<'a> {
    Hello { protocol: &'static str, recrash: &'static str },
    Reset(Box<Reset<'a>>),
    Step(Step<'a>),
    End(Termination),
}

/// A run begins.
#[derive(Debug, Serialize)]
pub(crate) struct Reset<'a> {
    scenario: &'a str,
    /// Of whatever is random in the ego.
    seed: u64,
    dt_s: f64,
    duration_s: f64,
    surface: Surface,
    target_speed_mps: f64,
    vehicle: Vehicle,
    /// Centre line of the way to drive.
    route: Vec<Vec2>,
    route_lanes: Vec<usize>,
    lanes: Vec<Lane>,
    actors: Vec<Actor>,
    obstacles: Vec<Obstacle>,
}

#[derive(Debug, Serialize)]
struct Vehicle {
    length_m: f64,
    width_m: f64,
    wheelbase_m: f64,
    max_acceleration_mps2: f64,
    max_deceleration_mps2: f64,
    max_wheel_angle_rad: f64,
    max_speed_mps: f64,
}

#[derive(Debug, Serialize)]
struct Lane {
    road: u16,
    number: u8,
    width_m: f64,
    centre: Vec<Vec2>,
}

#[derive(Debug, Serialize)]
struct Actor {
    id: String,
    kind: PartnerKind,
    length_m: f64,
    width_m: f64,
}

#[derive(Debug, Serialize)]
struct Obstacle {
    kind: ObstacleKind,
    x: f64,
    y: f64,
    heading: f64,
    length_m: f64,
    width_m: f64,
}

/// The world before a decision.
#[derive(Debug, Serialize)]
pub(crate) struct Step<'a> {
    step: u32,
    time_s: f64,
    ego: Ego,
    actors: Vec<Seen<'a>>,
    /// Signals and signs on the ego's route, in the scenario's order of control.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    signals: Vec<Shown>,
    /// Stops of its task that lie ahead.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    stops: Vec<MissionStop>,
    /// Its recorded driver still drives: the answer is not used yet.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    recorded: bool,
}

/// What stands at a stop line.
#[derive(Debug, Serialize)]
struct Shown {
    /// `green`, `yellow`, `red`, `flashing_red` or `dark`; `sign` of a stop or yield sign.
    shows: &'static str,
    /// Along the route, of the ego's centre when its front is at the line. [m]
    route_s_m: f64,
}

#[derive(Debug, Serialize)]
struct Ego {
    x: f64,
    y: f64,
    heading: f64,
    speed: f64,
    vx: f64,
    vy: f64,
    route_s_m: f64,
    route_t_m: f64,
}

#[derive(Debug, Serialize)]
struct Seen<'a> {
    id: &'a str,
    x: f64,
    y: f64,
    heading: f64,
    speed: f64,
    vx: f64,
    vy: f64,
}

/// What a program answers.
#[derive(Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Answer {
    Ready {
        #[serde(default)]
        protocol: Option<String>,
    },
    Control(Control),
    Error {
        message: String,
    },
}

/// Throttle and steering as the simulator has them, or an acceleration and a wheel angle.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(crate) enum Control {
    Pedals { throttle: f64, steer: f64 },
    Motion { acceleration_mps2: f64, wheel_angle_rad: f64 },
}

/// What an ego is told when a run begins, for one that lives in this process: JSON.
pub fn told_at_reset(scenario: &Scenario, cast: &[CastMember]) -> String {
    json(&Said::Reset(Box::new(Reset::new(scenario, cast))))
}

/// What it is told before every decision: JSON. `ids` are the names of all but the ego, in the order of the cast.
pub fn told_at_step(observation: &Observation<'_>, ids: &[String]) -> String {
    json(&Said::Step(Step::new(observation, ids)))
}

fn json(said: &Said<'_>) -> String {
    serde_json::to_string(said).unwrap_or_else(|_| unreachable!("numbers and texts serialise"))
}

impl Control {
    pub(crate) fn controls(&self, spec: &VehicleSpec) -> Controls {
        match *self {
            Self::Pedals { throttle, steer } => Controls { steer, throttle }.clipped(),
            Self::Motion { acceleration_mps2, wheel_angle_rad } => {
                Controls::of_acceleration(acceleration_mps2, wheel_angle_rad, spec)
            }
        }
    }
}

impl<'a> Reset<'a> {
    pub(crate) fn new(scenario: &'a Scenario, cast: &[CastMember]) -> Self {
        let (draft, network, ego) = (scenario.draft(), scenario.network(), scenario.ego());
        let spec = VehicleSpec::of(ego.kind);
        let pieces = (ego.path.length_m / ROUTE_SPACING_M).ceil().max(1.0);
        let point = |piece: usize| ego.path.pose(ego.path.length_m * piece as f64 / pieces, 0.0).position;
        let actors = cast.iter().enumerate().skip(1).map(|(position, member)| Actor {
            id: member.id(draft, position),
            kind: member.kind,
            length_m: member.length_m,
            width_m: member.width_m,
        });
        let obstacles = scenario.obstacles().iter().map(|obstacle| Obstacle {
            kind: obstacle.placed.kind,
            x: obstacle.placed.pose.position.x,
            y: obstacle.placed.pose.position.y,
            heading: obstacle.placed.pose.heading,
            length_m: obstacle.placed.length_m,
            width_m: obstacle.placed.width_m,
        });
        let lanes = network.lanes.iter().map(|lane| Lane {
            road: lane.road.0,
            number: lane.index,
            width_m: lane.width_m,
            centre: lane.polyline(0.0),
        });
        Self {
            scenario: &draft.id,
            seed: draft.source.seed,
            dt_s: STEP_S,
            duration_s: draft.duration_s,
            surface: draft.environment.surface,
            target_speed_mps: draft.ego.target_speed_mps,
            vehicle: Vehicle {
                length_m: scenario.ego_size_m().0,
                width_m: scenario.ego_size_m().1,
                wheelbase_m: spec.front_axle_m + spec.rear_axle_m,
                max_acceleration_mps2: spec.max_acceleration_mps2,
                max_deceleration_mps2: spec.max_deceleration_mps2,
                max_wheel_angle_rad: spec.max_wheel_angle_rad,
                max_speed_mps: spec.max_speed_mps,
            },
            route: (0..=pieces as usize).map(point).collect(),
            route_lanes: ego.path.segments.iter().map(|segment| usize::from(segment.lane.0)).collect(),
            lanes: lanes.collect(),
            actors: actors.collect(),
            obstacles: obstacles.collect(),
        }
    }
}

impl<'a> Step<'a> {
    /// Of the actors those that are in the world; `ids` are the names of all but the ego.
    pub(crate) fn new(observation: &Observation<'_>, ids: &'a [String]) -> Self {
        let ActorState { x, y, heading, vx, vy, .. } = observation.states[0];
        let speed = observation.states[0].speed();
        let (route_s_m, route_t_m) = (observation.route_s_m, observation.route_t_m);
        let others = ids.iter().zip(observation.states.iter().enumerate().skip(1));
        let present = others.filter(|(_, (actor, _))| observation.is_present(*actor));
        Self {
            step: observation.step,
            time_s: observation.time_s,
            ego: Ego { x, y, heading, speed, vx, vy, route_s_m, route_t_m },
            signals: observation.lines.iter().map(|line| shown(line, observation.signals)).collect(),
            stops: observation.stops.to_vec(),
            recorded: observation.recorded,
            actors: present
                .map(|(id, (_, state))| {
                    let ActorState { x, y, heading, vx, vy, .. } = *state;
                    Seen { id, x, y, heading, speed: state.speed(), vx, vy }
                })
                .collect(),
        }
    }
}

fn shown(line: &StopLine, signals: &[Option<Aspect>]) -> Shown {
    let shows = match signals.get(line.control).copied().flatten() {
        None => "sign",
        Some(Aspect::Green) => "green",
        Some(Aspect::Yellow) => "yellow",
        Some(Aspect::Red) => "red",
        Some(Aspect::FlashingRed) => "flashing_red",
        Some(Aspect::Dark) => "dark",
    };
    Shown { shows, route_s_m: line.at_m }
}
