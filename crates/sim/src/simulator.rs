//! One run: sense, decide, move, collide, record.
//!
//! What is fixed during a run ([`Setting`]), what is true at a time ([`State`]) and what is scratch ([`Workspace`]) are
//! three types. All of them are kept from run to run, so that a step allocates nothing.

use crate::chassis::{Chassis, Controls, VehicleState, WheelCommand};
use crate::ego::Ego;
use crate::give_way::{Crossing, HalfSize};
use crate::idm::Idm;
use crate::lanes::{LaneIndex, LaneTable, Navigator, Progress};
use crate::metadrive_idm::MetadriveIdm;
use crate::recorder::{CastMember, Recorder};
use crate::scene::{Scene, Seen, SeenObstacle};
use crate::script::{Script, stand};
use crate::traffic;
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::math;
use recrash_model::record::{PartnerKind, Surface};
use recrash_model::rollout::{ActorState, Event, EventKind, Role, STEP_S, SUBSTEPS, Termination, TerminationKind};
use recrash_model::scenario::{LateralMove, Policy};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{LanePath, RoadId, Scenario};

/// MetaDrive's rule for having arrived: this near to the end of the route. [m]
const ARRIVAL_RANGE_M: f64 = 5.0;

/// Below this speed a road user stands. [m/s]
const STANDING_MPS: f64 = 0.3;

/// The ego is stuck when it has stood this long and nobody else moves or is about to; assumed. [steps]
const STUCK_STEPS: u32 = 200;

/// Steps and physics steps in a second. A time is a count divided by these, which gives the nearest number to the
/// decimal that people read.
const STEPS_PER_S: f64 = 10.0;
const PHYSICS_STEPS_PER_S: f64 = 50.0;

/// Runs scenarios one after the other.
#[derive(Debug, Default)]
pub struct Simulator {
    setting: Setting,
    state: State,
    workspace: Workspace,
}

/// What is fixed during a run.
#[derive(Debug, Default)]
struct Setting {
    lanes: LaneTable,
    cast: Vec<CastMember>,
    chassis: Vec<Chassis>,
    /// Roads of all actors' routes, one after the other, with the path's lane on each and where it begins. [m]
    routes: Vec<RoadId>,
    route_lanes: Vec<LaneIndex>,
    route_starts: Vec<f64>,
    obstacles: Vec<SeenObstacle>,
    moves: Vec<LateralMove>,
    crossings: Vec<Crossing>,
    duration_s: f64,
}

/// What is true at a time.
#[derive(Debug, Default)]
struct State {
    step: u32,
    bodies: Vec<VehicleState>,
    seen: Vec<Seen>,
    drivers: Vec<Driver>,
    /// Touched another road user and brakes for good.
    halted: Vec<bool>,
    /// Who has touched whom or what: one row per actor, road users first, then obstacles.
    touched: Vec<bool>,
    ego_contact: bool,
    traffic_released: bool,
    standing_steps: u32,
    diverged: bool,
}

/// Scratch.
#[derive(Debug, Default)]
struct Workspace {
    controls: Vec<Controls>,
    commands: Vec<WheelCommand>,
    states: Vec<ActorState>,
    /// Pairs that may touch during the step: an actor, and a column of `touched`.
    near: Vec<(u16, u16)>,
}

/// What decides for an actor.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one contiguous array without indirection")]
enum Driver {
    MetadriveIdm(MetadriveIdm),
    Idm(Idm),
    Script(Script),
}

impl Simulator {
    /// One without anything prepared.
    pub fn new() -> Self {
        Self::default()
    }

    /// Runs a scenario. It cannot fail: however a run goes, it ends with a [`Termination`].
    pub fn run<R: Recorder>(&mut self, scenario: &Scenario, ego: Ego, recorder: &mut R) -> Termination {
        self.prepare(scenario, ego);
        recorder.begin(scenario, ego, &self.setting.cast);
        self.sense();
        loop {
            if let Some(termination) = self.verdict() {
                self.workspace.controls.fill(Controls::default());
                self.record(recorder);
                recorder.end(termination);
                return termination;
            }
            self.decide();
            self.record(recorder);
            self.advance(recorder);
            self.state.step += 1;
            self.sense();
        }
    }

    /// Puts everything where it starts.
    fn prepare(&mut self, scenario: &Scenario, ego: Ego) {
        self.setting.clear();
        self.state.clear();
        self.setting.lanes.prepare(scenario.network());
        let draft = scenario.draft();
        let surface = draft.environment.surface;
        self.setting.duration_s = draft.duration_s;
        for obstacle in scenario.obstacles() {
            let outline = obstacle.placed.outline();
            let lane = obstacle.lane.0;
            let s = self.setting.lanes.lane(lane).local(outline.centre).0;
            self.setting.obstacles.push(SeenObstacle { outline, lane, s });
        }

        let target_mps = draft.ego.target_speed_mps;
        let placement = scenario.ego();
        let driver = match ego {
            Ego::MetadriveIdm => Driver::MetadriveIdm(MetadriveIdm::new(target_mps)),
            Ego::Idm => Driver::Idm(Idm::new(&VehicleSpec::of(placement.kind), target_mps, surface)),
        };
        let at = (placement.pose, placement.speed_mps);
        self.cast(Role::Ego, placement.kind, &placement.path, placement.s_m, at, surface, driver);

        for (partner, placement) in draft.partners.iter().zip(scenario.partners()) {
            let first_move = self.setting.moves.len() as u32;
            self.setting.moves.extend_from_slice(&partner.lateral);
            let moves = (first_move, self.setting.moves.len() as u32);
            let driver = Driver::Script(Script::new(partner, placement.t_m, moves));
            let at = (placement.pose, placement.speed_mps);
            self.cast(Role::Partner, placement.kind, &placement.path, placement.s_m, at, surface, driver);
        }

        let spawns = traffic::place(scenario);
        for spawn in &spawns {
            let driver = Driver::MetadriveIdm(MetadriveIdm::new(traffic::TRAFFIC_SPEED_MPS));
            self.cast(Role::Traffic, spawn.kind, &spawn.path, 0.0, (spawn.pose, 0.0), surface, driver);
        }
        self.find_crossings(scenario, ego, &spawns);

        let (actors, obstacles) = (self.setting.cast.len(), self.setting.obstacles.len());
        self.state.touched.resize(actors * (actors + obstacles), false);
        self.workspace.controls.clear();
        self.workspace.controls.resize(actors, Controls::default());
        self.workspace.states.clear();
        self.workspace.states.resize(actors, ActorState::default());
        // Room for every pair, so that no step has to ask for more.
        self.workspace.near.clear();
        self.workspace.near.reserve(actors * (actors + obstacles));
        self.workspace.commands.clear();
        self.workspace.commands.reserve(actors);
    }

    /// Adds an actor.
    #[allow(clippy::too_many_arguments, reason = "one private caller, and each is one fact about the actor")]
    fn cast(
        &mut self,
        role: Role,
        kind: PartnerKind,
        path: &LanePath,
        s_m: f64,
        (pose, speed_mps): (Pose, f64),
        surface: Surface,
        driver: Driver,
    ) {
        let setting = &mut self.setting;
        let spec = VehicleSpec::of(kind);
        let first = setting.routes.len() as u32;
        setting.routes.extend_from_slice(&path.roads);
        setting.route_lanes.extend(path.segments.iter().map(|segment| segment.lane.0));
        setting.route_starts.extend(path.segments.iter().map(|segment| segment.start_m));
        let at = path.segment_at(s_m);
        let route = (first, setting.routes.len() as u32);
        let place = Navigator::new(route, at as u32, path.segments[at].lane.0);
        setting.chassis.push(Chassis::new(&spec, surface));
        setting.cast.push(CastMember { role, kind, length_m: spec.length_m, width_m: spec.width_m });
        self.state.bodies.push(VehicleState::new(pose, speed_mps));
        self.state.drivers.push(driver);
        self.state.halted.push(false);
        self.state.seen.push(Seen {
            pose,
            forward: Vec2::from_heading(pose.heading),
            velocity: Vec2::default(),
            speed: speed_mps,
            place,
            progress: Progress { at: first + at as u32, end: route.1, s: 0.0 },
            half_length: 0.5 * spec.length_m,
            half_width: 0.5 * spec.width_m,
            present: true,
        });
    }

    /// Finds where the paths of those who give way meet other paths.
    fn find_crossings(&mut self, scenario: &Scenario, ego: Ego, spawns: &[traffic::Spawn]) {
        let partners = scenario.partners().len();
        let path = |actor: usize| match actor {
            0 => &scenario.ego().path,
            _ if actor <= partners => &scenario.partners()[actor - 1].path,
            _ => &spawns[actor - 1 - partners].path,
        };
        let gives_way = |actor: usize| match actor {
            0 => ego == Ego::Idm,
            _ if actor <= partners => matches!(scenario.draft().partners[actor - 1].policy, Policy::Yielding { .. }),
            _ => false,
        };
        for me in (0..=partners).filter(|&actor| gives_way(actor)) {
            for other in (0..self.setting.cast.len()).filter(|&other| other != me) {
                let size = |actor: usize| {
                    let member = &self.setting.cast[actor];
                    HalfSize { length: 0.5 * member.length_m, width: 0.5 * member.width_m }
                };
                let (mine, theirs) = (size(me), size(other));
                let network = scenario.network();
                let conflict = path(me).conflict(path(other), network, 2.0 * mine.width, 2.0 * theirs.width);
                if let Some(conflict) = conflict {
                    self.setting.crossings.push(Crossing::new(
                        network,
                        (me, path(me), mine),
                        (other, path(other), theirs),
                        conflict,
                    ));
                }
            }
        }
    }

    /// Freezes the world for the next decision.
    fn sense(&mut self) {
        let Self { setting, state, .. } = self;
        for ((seen, body), member) in state.seen.iter_mut().zip(&state.bodies).zip(&setting.cast) {
            if !body.is_finite() {
                state.diverged = true;
                continue;
            }
            seen.pose = body.pose;
            seen.forward = Vec2::from_heading(body.pose.heading);
            seen.velocity = body.velocity();
            seen.speed = body.speed();
            if seen.present {
                seen.place.localise(&setting.lanes, &setting.routes, body.pose.position, body.pose.heading);
                seen.progress.follow(&setting.lanes, &setting.route_lanes, &seen.place, body.pose.position);
                // Background traffic that has left the road goes on straight and is out of the game.
                seen.present = seen.place.on_road || member.role != Role::Traffic;
            }
        }
        let ego = &state.seen[0];
        state.traffic_released |= !ego.place.on_first_road();
        state.standing_steps = if ego.speed < STANDING_MPS { state.standing_steps + 1 } else { 0 };
    }

    /// Every actor decides on the same frozen world.
    fn decide(&mut self) {
        let Self { setting, state, workspace } = self;
        let scene = Scene {
            step: state.step,
            lanes: &setting.lanes,
            routes: &setting.routes,
            route_lanes: &setting.route_lanes,
            route_starts: &setting.route_starts,
            actors: &state.seen,
            obstacles: &setting.obstacles,
        };
        for (me, driver) in state.drivers.iter_mut().enumerate() {
            let halted = state.halted[me];
            workspace.controls[me] = if setting.cast[me].role == Role::Traffic && !state.traffic_released {
                Controls::default()
            } else {
                match driver {
                    Driver::MetadriveIdm(driver) if halted => {
                        Controls { throttle: stand(scene.actors[me].speed), ..driver.decide(&scene, me) }
                    }
                    Driver::MetadriveIdm(driver) => driver.decide(&scene, me),
                    Driver::Idm(driver) => driver.decide(&scene, me, &setting.crossings),
                    Driver::Script(script) => script.decide(&scene, me, &setting.moves, &setting.crossings, halted),
                }
            };
        }
    }

    /// Hands the states to the recorder, with the controls just chosen.
    fn record<R: Recorder>(&mut self, recorder: &mut R) {
        let Self { state, workspace, .. } = self;
        for ((slot, seen), controls) in workspace.states.iter_mut().zip(&state.seen).zip(&workspace.controls) {
            *slot = actor_state(seen.pose, seen.speed, *controls);
        }
        recorder.step(&workspace.states);
    }

    /// Moves everybody through one step, and notes who touches whom.
    fn advance<R: Recorder>(&mut self, recorder: &mut R) {
        let Self { setting, state, workspace } = self;
        workspace.commands.clear();
        for ((body, chassis), controls) in state.bodies.iter_mut().zip(&setting.chassis).zip(&workspace.controls) {
            workspace.commands.push(body.command(chassis, *controls));
        }
        find_near(setting, state, &mut workspace.near);
        for substep in 1..=SUBSTEPS {
            for ((body, chassis), command) in state.bodies.iter_mut().zip(&setting.chassis).zip(&workspace.commands) {
                body.advance(chassis, command);
            }
            if workspace.near.is_empty() {
                continue;
            }
            let time_s = (f64::from(state.step) * SUBSTEPS as f64 + substep as f64) / PHYSICS_STEPS_PER_S;
            collide(setting, state, workspace, time_s, recorder);
        }
    }

    /// Whether the run is over.
    fn verdict(&self) -> Option<Termination> {
        let (setting, state) = (&self.setting, &self.state);
        let time_s = f64::from(state.step) / STEPS_PER_S;
        let kind = if state.diverged {
            TerminationKind::Diverged
        } else if state.ego_contact {
            TerminationKind::Contact
        } else if self.has_arrived() {
            TerminationKind::Arrived
        } else if !state.seen[0].place.on_road {
            TerminationKind::OffRoad
        } else if state.standing_steps >= STUCK_STEPS && !self.anybody_moves() {
            TerminationKind::Stuck
        } else if time_s >= setting.duration_s - 0.5 * STEP_S {
            TerminationKind::Timeout
        } else {
            return None;
        };
        Some(Termination { kind, time_s })
    }

    /// MetaDrive's rule: within 5 m of the end of the route's last road, on any of its lanes.
    fn has_arrived(&self) -> bool {
        let ego = &self.state.seen[0];
        if !ego.place.on_last_road() {
            return false;
        }
        let lanes = self.setting.lanes.of_road(ego.place.road(&self.setting.routes));
        lanes.iter().any(|&lane| {
            let lane = self.setting.lanes.lane(lane);
            let (s, t) = lane.local(ego.pose.position);
            (s - lane.length_m).abs() < ARRIVAL_RANGE_M && t.abs() <= 0.5 * lane.width_m()
        })
    }

    /// Whether anybody but the ego moves, or will because of its plan.
    fn anybody_moves(&self) -> bool {
        let state = &self.state;
        (1..state.seen.len()).any(|actor| {
            let plans = match &state.drivers[actor] {
                Driver::Script(script) => !state.halted[actor] && script.has_plans(state.step),
                Driver::MetadriveIdm(_) | Driver::Idm(_) => false,
            };
            state.seen[actor].present && (plans || state.seen[actor].speed >= STANDING_MPS)
        })
    }
}

impl Setting {
    fn clear(&mut self) {
        self.cast.clear();
        self.chassis.clear();
        self.routes.clear();
        self.route_lanes.clear();
        self.route_starts.clear();
        self.obstacles.clear();
        self.moves.clear();
        self.crossings.clear();
    }
}

impl State {
    fn clear(&mut self) {
        self.step = 0;
        self.bodies.clear();
        self.seen.clear();
        self.drivers.clear();
        self.halted.clear();
        self.touched.clear();
        self.ego_contact = false;
        self.traffic_released = false;
        self.standing_steps = 0;
        self.diverged = false;
    }
}

fn actor_state(pose: Pose, speed: f64, controls: Controls) -> ActorState {
    ActorState {
        x: pose.position.x,
        y: pose.position.y,
        heading: math::wrap_angle(pose.heading),
        speed,
        steer: controls.steer,
        throttle: controls.throttle,
    }
}

/// The pairs that may touch within the next step: those whose circles, widened by what both can drive, overlap.
fn find_near(setting: &Setting, state: &State, near: &mut Vec<(u16, u16)>) {
    near.clear();
    let actors = state.seen.len();
    let columns = actors + setting.obstacles.len();
    let radius = |seen: &Seen| (math::sq(seen.half_length) + math::sq(seen.half_width)).sqrt();
    for (a, first) in state.seen.iter().enumerate().filter(|(_, seen)| seen.present) {
        let reach = radius(first) + (first.speed + 1.0) * STEP_S;
        for (b, second) in state.seen.iter().enumerate().skip(a + 1).filter(|(_, seen)| seen.present) {
            let reach = reach + radius(second) + (second.speed + 1.0) * STEP_S;
            let offset = second.pose.position - first.pose.position;
            if offset.length_squared() <= reach * reach && !state.touched[a * columns + b] {
                near.push((a as u16, b as u16));
            }
        }
        for (position, obstacle) in setting.obstacles.iter().enumerate() {
            let reach = reach + obstacle.outline.radius();
            let offset = obstacle.outline.centre - first.pose.position;
            if offset.length_squared() <= reach * reach && !state.touched[a * columns + actors + position] {
                near.push((a as u16, (actors + position) as u16));
            }
        }
    }
}

/// Notes every first contact at this physics step.
fn collide<R: Recorder>(
    setting: &Setting,
    state: &mut State,
    workspace: &mut Workspace,
    time_s: f64,
    recorder: &mut R,
) {
    let actors = state.seen.len();
    let columns = actors + setting.obstacles.len();
    workspace.near.retain(|&(a, b)| {
        let (a, b) = (usize::from(a), usize::from(b));
        let outline = |actor: usize| {
            let member = &setting.cast[actor];
            OrientedBox::new(state.bodies[actor].pose, member.length_m, member.width_m)
        };
        let state_of = |actor: usize| {
            let body = &state.bodies[actor];
            actor_state(body.pose, body.speed(), workspace.controls[actor])
        };
        let kind = if b < actors {
            // Circles first: the boxes cost a sine and a cosine each.
            let (first, second) = (&state.seen[a], &state.seen[b]);
            let reach = first.half_length + first.half_width + second.half_length + second.half_width;
            let offset = state.bodies[b].pose.position - state.bodies[a].pose.position;
            if offset.length_squared() > reach * reach || !outline(a).overlaps(&outline(b)) {
                return true;
            }
            EventKind::Contact { a, b, a_state: state_of(a), b_state: state_of(b) }
        } else {
            let obstacle = b - actors;
            if !outline(a).overlaps(&setting.obstacles[obstacle].outline) {
                return true;
            }
            EventKind::ObstacleContact { actor: a, obstacle, state: state_of(a) }
        };
        state.touched[a * columns + b] = true;
        if b < actors {
            state.halted[a] = true;
            state.halted[b] = true;
            state.ego_contact |= a == 0;
        }
        recorder.event(&Event { time_s, kind });
        false
    });
}
