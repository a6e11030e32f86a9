//! The parts of a run: what is fixed in it, what is true at a time, and scratch; and how they are put together.

use crate::chassis::{Chassis, Controls, VehicleState, WheelCommand};
use crate::contacts::actor_state;
use crate::ego::Ego;
use crate::idm::Idm;
use crate::lanes::{LaneIndex, LaneTable, Navigator, Progress};
use crate::metadrive_idm::MetadriveIdm;
use crate::recorder::CastMember;
use crate::reference::{Attention, Reference};
use crate::run::Seat;
use crate::scene::{Seen, SeenObstacle};
use crate::script::Script;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorState, Event, Role, Termination};
use recrash_model::scenario::Policy;
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::constants::EGO_OVERTAKE_TIMER_STEPS;
use recrash_plan::{Crossing, Plan, Way};
use recrash_roads::{Footprint, LanePath, Placement, RoadId, Scenario, TRAFFIC_SPEED_MPS, TrafficPlacement};

/// What is fixed during a run.
#[derive(Debug, Default)]
pub(crate) struct Setting {
    pub(crate) lanes: LaneTable,
    pub(crate) cast: Vec<CastMember>,
    pub(crate) chassis: Vec<Chassis>,
    /// Roads of all actors' routes, one after the other, with the path's lane on each and where it begins. [m]
    pub(crate) routes: Vec<RoadId>,
    pub(crate) route_lanes: Vec<LaneIndex>,
    pub(crate) route_starts: Vec<f64>,
    pub(crate) obstacles: Vec<SeenObstacle>,
    /// The partners' ways.
    pub(crate) ways: Vec<Way>,
    pub(crate) crossings: Vec<Crossing>,
    pub(crate) duration_s: f64,
}

/// What is true at a time: all that has to be kept to go on from there.
#[derive(Debug, Default)]
pub(crate) struct State {
    pub(crate) step: u32,
    pub(crate) bodies: Vec<VehicleState>,
    pub(crate) seen: Vec<Seen>,
    pub(crate) drivers: Vec<Driver>,
    /// Touched another road user and brakes for good.
    pub(crate) halted: Vec<bool>,
    /// What the ego keeps in mind about each actor, where it is `reference`.
    pub(crate) attention: Vec<Attention>,
    /// Who has touched whom or what: one row per actor, road users first, then obstacles.
    pub(crate) touched: Vec<bool>,
    pub(crate) ego_contact: bool,
    pub(crate) traffic_released: bool,
    pub(crate) standing_steps: u32,
    pub(crate) diverged: bool,
    /// What everybody chose last.
    pub(crate) controls: Vec<Controls>,
    /// What can be observed: everybody's state, with the controls chosen last.
    pub(crate) states: Vec<ActorState>,
    pub(crate) termination: Option<Termination>,
}

impl Clone for State {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    /// Field by field, so that the memory is used again; what `derive` makes does not.
    fn clone_from(&mut self, source: &Self) {
        let Self {
            step,
            bodies,
            seen,
            drivers,
            halted,
            attention,
            touched,
            ego_contact,
            traffic_released,
            standing_steps,
            diverged,
            controls,
            states,
            termination,
        } = source;
        self.step = *step;
        self.bodies.clone_from(bodies);
        self.seen.clone_from(seen);
        self.drivers.clone_from(drivers);
        self.halted.clone_from(halted);
        self.attention.clone_from(attention);
        self.touched.clone_from(touched);
        self.ego_contact = *ego_contact;
        self.traffic_released = *traffic_released;
        self.standing_steps = *standing_steps;
        self.diverged = *diverged;
        self.controls.clone_from(controls);
        self.states.clone_from(states);
        self.termination = *termination;
    }
}

/// Scratch of a step, and what it leaves behind for whoever drives.
#[derive(Debug, Clone, Default)]
pub(crate) struct Workspace {
    pub(crate) commands: Vec<WheelCommand>,
    /// The states that the last step began with, and the controls chosen for it.
    pub(crate) decided: Vec<ActorState>,
    /// What happened in the last step.
    pub(crate) events: Vec<Event>,
    /// Pairs that may touch during the step: an actor, and a column of `touched`.
    pub(crate) near: Vec<(u16, u16)>,
}

/// What decides for an actor.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one contiguous array without indirection")]
pub(crate) enum Driver {
    MetadriveIdm(MetadriveIdm),
    Idm(Idm),
    Reference(Reference),
    Script(Script),
    /// Somebody outside the simulator, see [`crate::Run::step`].
    Outside,
}

impl Workspace {
    /// Makes room for a run, so that no step has to ask for more.
    pub(crate) fn prepare(&mut self, setting: &Setting) {
        let (actors, obstacles) = (setting.cast.len(), setting.obstacles.len());
        let pairs = actors * (actors + obstacles);
        self.commands.clear();
        self.commands.reserve(actors);
        self.decided.clear();
        self.decided.resize(actors, ActorState::default());
        self.near.clear();
        self.near.reserve(pairs);
        self.events.clear();
        self.events.reserve(pairs);
    }
}

/// Puts everything where it starts.
pub(crate) fn prepare(setting: &mut Setting, state: &mut State, scenario: &Scenario, seat: Seat) {
    setting.clear();
    state.clear();
    setting.lanes.prepare(scenario.network());
    let draft = scenario.draft();
    let surface = draft.environment.surface;
    setting.duration_s = draft.duration_s;
    for obstacle in scenario.obstacles() {
        let outline = obstacle.placed.outline();
        let lane = obstacle.lane.0;
        let s = setting.lanes.lane(lane).local(outline.centre).0;
        setting.obstacles.push(SeenObstacle { outline, lane, s });
    }

    let target_mps = draft.ego.target_speed_mps;
    let spec = VehicleSpec::of(scenario.ego().kind);
    let driver = match seat {
        Seat::Outside => Driver::Outside,
        Seat::BuiltIn(Ego::MetadriveIdm) => {
            Driver::MetadriveIdm(MetadriveIdm::new(target_mps, EGO_OVERTAKE_TIMER_STEPS))
        }
        Seat::BuiltIn(Ego::Idm) => Driver::Idm(Idm::new(&spec, target_mps, surface)),
        Seat::BuiltIn(Ego::Reference) => Driver::Reference(Reference::new(&spec, target_mps, surface)),
    };
    enter(setting, state, surface, Entrance::of(Role::Ego, scenario.ego(), driver));

    for (number, (partner, placement)) in draft.partners.iter().zip(scenario.partners()).enumerate() {
        let plan = Plan::new(partner.kind, &partner.policy, placement.t_m, surface);
        setting.ways.push(Way::new(scenario, number, &plan));
        let driver = Driver::Script(Script::new(plan, number));
        enter(setting, state, surface, Entrance::of(Role::Partner, placement, driver));
    }

    let spawns = recrash_roads::background_traffic(scenario);
    for spawn in &spawns {
        let driver = Driver::MetadriveIdm(MetadriveIdm::new(TRAFFIC_SPEED_MPS, spawn.overtake_timer_steps));
        let TrafficPlacement { kind, ref path, pose, .. } = *spawn;
        enter(
            setting,
            state,
            surface,
            Entrance { role: Role::Traffic, kind, path, s_m: 0.0, pose, speed_mps: 0.0, driver },
        );
    }
    setting.find_crossings(scenario, seat, &spawns);

    let (actors, obstacles) = (setting.cast.len(), setting.obstacles.len());
    state.attention.resize(actors, Attention::default());
    state.touched.resize(actors * (actors + obstacles), false);
    state.controls.resize(actors, Controls::default());
    state.states.resize(actors, ActorState::default());
}

/// An actor that is about to enter.
struct Entrance<'a> {
    role: Role,
    kind: PartnerKind,
    path: &'a LanePath,
    s_m: f64,
    pose: Pose,
    speed_mps: f64,
    driver: Driver,
}

impl<'a> Entrance<'a> {
    fn of(role: Role, placement: &'a Placement, driver: Driver) -> Self {
        let Placement { kind, ref path, s_m, pose, speed_mps, .. } = *placement;
        Self { role, kind, path, s_m, pose, speed_mps, driver }
    }
}

/// Adds an actor.
fn enter(setting: &mut Setting, state: &mut State, surface: Surface, actor: Entrance<'_>) {
    let Entrance { role, kind, path, s_m, pose, speed_mps, driver } = actor;
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
    state.bodies.push(VehicleState::new(pose, speed_mps));
    state.drivers.push(driver);
    state.halted.push(false);
    state.seen.push(Seen {
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

impl Setting {
    /// Finds where the paths of those who give way meet other paths.
    fn find_crossings(&mut self, scenario: &Scenario, seat: Seat, spawns: &[TrafficPlacement]) {
        let partners = scenario.partners().len();
        let path = |actor: usize| match actor {
            0 => &scenario.ego().path,
            _ if actor <= partners => &scenario.partners()[actor - 1].path,
            _ => &spawns[actor - 1 - partners].path,
        };
        let gives_way = |actor: usize| match actor {
            0 => matches!(seat, Seat::BuiltIn(Ego::Idm | Ego::Reference)),
            _ if actor <= partners => matches!(scenario.draft().partners[actor - 1].policy, Policy::Yielding { .. }),
            _ => false,
        };
        for me in (0..=partners).filter(|&actor| gives_way(actor)) {
            for other in (0..self.cast.len()).filter(|&other| other != me) {
                let size = |actor: usize| {
                    let member = &self.cast[actor];
                    Footprint { length_m: member.length_m, width_m: member.width_m }
                };
                let (mine, theirs) = (size(me), size(other));
                if let Some(conflict) = path(me).conflict(path(other), mine.width_m, theirs.width_m) {
                    let crossing = Crossing::new((me, path(me), mine), (other, path(other), theirs), conflict);
                    self.crossings.push(crossing);
                }
            }
        }
    }

    fn clear(&mut self) {
        self.cast.clear();
        self.chassis.clear();
        self.routes.clear();
        self.route_lanes.clear();
        self.route_starts.clear();
        self.obstacles.clear();
        self.ways.clear();
        self.crossings.clear();
    }
}

impl State {
    /// Writes down everybody's state, with the controls chosen last.
    pub(crate) fn write_states(&mut self) {
        for ((slot, seen), controls) in self.states.iter_mut().zip(&self.seen).zip(&self.controls) {
            *slot = actor_state(seen.pose, seen.velocity, *controls);
        }
    }

    fn clear(&mut self) {
        self.step = 0;
        self.bodies.clear();
        self.seen.clear();
        self.drivers.clear();
        self.halted.clear();
        self.attention.clear();
        self.touched.clear();
        self.ego_contact = false;
        self.traffic_released = false;
        self.standing_steps = 0;
        self.diverged = false;
        self.controls.clear();
        self.states.clear();
        self.termination = None;
    }
}
