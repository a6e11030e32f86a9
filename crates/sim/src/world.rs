//! The parts of a run: what is fixed in it, what is true at a time, and scratch; and how they are put together.

use crate::cast::CastMember;
use crate::chassis::{Chassis, Controls, VehicleState, WheelCommand};
use crate::ego::{Ego, Seat};
use crate::idm::Idm;
use crate::lanes::{LaneIndex, LaneTable, Navigator, Progress};
use crate::metadrive_idm::MetadriveIdm;
use crate::movement::{Loose, Mover};
use crate::reference::{Attention, Reference};
use crate::scene::{Seen, SeenObstacle};
use crate::script::Script;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorState, Event, Role, Substeps, Termination};
use recrash_model::scenario::{Aspect, Device, MissionStop, Part, Policy};
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::acts::{self, Attached, Glimpse, Names, PartState, Programme};
use recrash_plan::constants::EGO_OVERTAKE_TIMER_STEPS;
use recrash_plan::{Crossing, Plan, Way};
use recrash_roads::{Footprint, LanePath, Placement, RoadId, Scenario, StopLine, TRAFFIC_SPEED_MPS, TrafficPlacement};

/// What stands firm is taken for this heavy. [kg]
const FIRM_KG: f64 = 1e6;

/// A course shorter than this leads nowhere. [m]
const MOVES_M: f64 = 2.0;

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
    pub(crate) substeps: Substeps,
    /// Plans of acts, and for each actor which is its own.
    pub(crate) programmes: Vec<Programme>,
    pub(crate) programme_of: Vec<Option<u16>>,
    /// Whose plan goes on after a touch.
    pub(crate) outlasts_a_touch: Vec<bool>,
    /// The step at which the ego's seat takes over from its recorded driver.
    pub(crate) handover: u32,
    pub(crate) after_contact_s: f64,
    pub(crate) parts: Vec<Attached>,
    /// How far an actor's parts reach from its centre; 0 without any. [m]
    pub(crate) parts_reach_m: Vec<f64>,
    pub(crate) masses_kg: Vec<f64>,
    pub(crate) friction: f64,
    pub(crate) control: Vec<Device>,
    /// Stop lines on the ego's path.
    pub(crate) ego_lines: Vec<StopLine>,
    pub(crate) stops: Vec<MissionStop>,
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
    pub(crate) movers: Vec<Mover>,
    pub(crate) progress: Vec<acts::Progress>,
    pub(crate) loose: Vec<Loose>,
    pub(crate) parts: Vec<PartState>,
    /// What signals show; `None` for signs.
    pub(crate) signals: Vec<Option<Aspect>>,
    /// The ego's halts: which stop is next and how long it has been standing there, which stop line it has passed.
    pub(crate) errand: Errand,
    /// When the ego touched somebody first. [s]
    pub(crate) contact_s: f64,
}

/// How far the ego has come with its stops, and with the signs on its way.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Errand {
    /// Stops that are over.
    pub(crate) stops_done: u16,
    pub(crate) stood_steps: u32,
    /// It has stood at every sign up to here, and may pass it. [m]
    pub(crate) free_to_m: Option<f64>,
    pub(crate) stood_at_sign: u32,
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
            movers,
            progress,
            loose,
            parts,
            signals,
            errand,
            contact_s,
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
        self.movers.clone_from(movers);
        self.progress.clone_from(progress);
        self.loose.clone_from(loose);
        self.parts.clone_from(parts);
        self.signals.clone_from(signals);
        self.errand = *errand;
        self.contact_s = *contact_s;
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
    /// What plans see of everybody.
    pub(crate) glimpses: Vec<Glimpse>,
    /// Where everybody was before a physics step.
    pub(crate) before: Vec<Pose>,
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
    /// Nobody: it moves by its plan.
    Plan,
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
        self.glimpses.clear();
        self.glimpses.reserve(actors);
        self.before.clear();
        self.before.resize(actors, Pose::default());
        self.near.clear();
        self.near.reserve(pairs);
        self.events.clear();
        self.events.reserve(pairs + actors);
    }
}

/// Puts everything where it starts.
pub(crate) fn prepare(setting: &mut Setting, state: &mut State, scenario: &Scenario, seat: Seat, substeps: Substeps) {
    setting.clear();
    state.clear();
    setting.lanes.prepare(scenario.network());
    let draft = scenario.draft();
    let surface = draft.environment.surface;
    setting.duration_s = draft.duration_s;
    setting.substeps = substeps;
    for obstacle in scenario.obstacles() {
        let outline = obstacle.placed.outline();
        let lane = obstacle.lane.0;
        let s = setting.lanes.lane(lane).local(outline.centre).0;
        setting.obstacles.push(SeenObstacle { outline, lane, s });
    }

    enter_ego(setting, state, scenario, seat);
    enter_partners(setting, state, scenario);
    enter_actors(setting, state, scenario);
    let spawns = recrash_roads::background_traffic(scenario);
    enter_traffic(setting, state, surface, &spawns);
    setting.find_crossings(scenario, seat, &spawns);
    plan(setting, state, scenario, seat);

    let (actors, obstacles) = (state.bodies.len(), setting.obstacles.len());
    state.attention.resize(actors, Attention::default());
    state.touched.resize(actors * (actors + obstacles), false);
    state.controls.resize(actors, Controls::default());
    state.states.resize(setting.cast.len(), ActorState::default());
}

/// The ego, with whoever sits in its seat.
fn enter_ego(setting: &mut Setting, state: &mut State, scenario: &Scenario, seat: Seat) {
    let draft = scenario.draft();
    let (target_mps, surface) = (draft.ego.target_speed_mps, draft.environment.surface);
    let spec = VehicleSpec::of(scenario.ego().kind);
    let driver = match seat {
        Seat::Outside => Driver::Outside,
        Seat::BuiltIn(Ego::MetadriveIdm) => {
            Driver::MetadriveIdm(MetadriveIdm::new(target_mps, EGO_OVERTAKE_TIMER_STEPS))
        }
        Seat::BuiltIn(Ego::Idm) => Driver::Idm(Idm::new(&spec, target_mps, surface)),
        Seat::BuiltIn(Ego::Reference) => Driver::Reference(Reference::new(&spec, target_mps, surface)),
        Seat::BuiltIn(Ego::Recorded) => Driver::Plan,
    };
    enter(setting, state, surface, Entrance::of(Role::Ego, scenario.ego(), driver));
    setting.resize_last(scenario.ego_size_m());
    state.resize_last(scenario.ego_size_m());
}

/// The partners, each with its policy.
fn enter_partners(setting: &mut Setting, state: &mut State, scenario: &Scenario) {
    let draft = scenario.draft();
    let surface = draft.environment.surface;
    for (number, (partner, placement)) in draft.partners.iter().zip(scenario.partners()).enumerate() {
        let plan = Plan::new(partner.kind, &partner.policy, placement.t_m, surface);
        setting.ways.push(Way::new(scenario, number, &plan));
        let driver = Driver::Script(Script::new(plan, number));
        enter(setting, state, surface, Entrance::of(Role::Partner, placement, driver));
    }
}

/// Everybody with a plan; [`plan`] says where each goes.
fn enter_actors(setting: &mut Setting, state: &mut State, scenario: &Scenario) {
    let surface = scenario.draft().environment.surface;
    for placement in scenario.actors() {
        let entrance = Entrance {
            role: Role::Partner,
            kind: placement.kind,
            path: &scenario.ego().path,
            s_m: 0.0,
            pose: placement.pose,
            speed_mps: 0.0,
            driver: Driver::Plan,
        };
        enter(setting, state, surface, entrance);
        let size_m = (placement.length_m, placement.width_m);
        setting.resize_last(size_m);
        state.resize_last(size_m);
        if let Some(mass_kg) = setting.masses_kg.last_mut() {
            *mass_kg = placement.mass_kg.unwrap_or(FIRM_KG);
        }
    }
}

/// Background traffic, which drives as MetaDrive's does.
fn enter_traffic(setting: &mut Setting, state: &mut State, surface: Surface, spawns: &[TrafficPlacement]) {
    for spawn in spawns {
        let driver = Driver::MetadriveIdm(MetadriveIdm::new(TRAFFIC_SPEED_MPS, spawn.overtake_timer_steps));
        let TrafficPlacement { kind, ref path, pose, .. } = *spawn;
        let entrance = Entrance { role: Role::Traffic, kind, path, s_m: 0.0, pose, speed_mps: 0.0, driver };
        enter(setting, state, surface, entrance);
    }
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
    setting.chassis.push(Chassis::in_steps(&spec, surface, setting.substeps));
    let (length_m, width_m) = (spec.length_m, spec.width_m);
    setting.cast.push(CastMember { role, kind, length_m, width_m, owner: None, part: 0, appears: 0 });
    setting.masses_kg.push(VehicleSpec::mass_kg(kind).unwrap_or(FIRM_KG));
    setting.parts_reach_m.push(0.0);
    setting.programme_of.push(None);
    setting.outlasts_a_touch.push(false);
    state.movers.push(Mover::Wheels);
    state.loose.push(Loose::default());
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
        plan_s_m: None,
    });
}

impl Setting {
    /// Finds where the paths of those who give way meet other paths.
    fn find_crossings(&mut self, scenario: &Scenario, seat: Seat, spawns: &[TrafficPlacement]) {
        let (partners, planned) = (scenario.partners().len(), scenario.actors().len());
        let path = |actor: usize| match actor {
            0 => &scenario.ego().path,
            _ if actor <= partners => &scenario.partners()[actor - 1].path,
            _ => &spawns[actor - 1 - partners - planned].path,
        };
        let gives_way = |actor: usize| match actor {
            0 => matches!(seat, Seat::BuiltIn(Ego::Idm | Ego::Reference)),
            _ if actor <= partners => matches!(scenario.draft().partners[actor - 1].policy, Policy::Yielding { .. }),
            _ => false,
        };
        let size = |cast: &[CastMember], actor: usize| Footprint {
            length_m: cast[actor].length_m,
            width_m: cast[actor].width_m,
        };
        for me in (0..=partners).filter(|&actor| gives_way(actor)) {
            for other in (0..1 + partners).chain(1 + partners + planned..self.cast.len()).filter(|&other| other != me) {
                let (mine, theirs) = (size(&self.cast, me), size(&self.cast, other));
                if let Some(conflict) = path(me).conflict(path(other), mine.width_m, theirs.width_m) {
                    let crossing = Crossing::new((me, path(me), mine), (other, path(other), theirs), conflict);
                    self.crossings.push(crossing);
                }
            }
            for (position, placement) in scenario.actors().iter().enumerate() {
                let other = 1 + partners + position;
                let course = &placement.course;
                if course.length_m() < MOVES_M {
                    continue;
                }
                let way = course.as_path();
                let (mine, theirs) = (size(&self.cast, me), size(&self.cast, other));
                if let Some(conflict) = path(me).conflict(&way, mine.width_m, theirs.width_m) {
                    let mut crossing = Crossing::new((me, path(me), mine), (other, &way, theirs), conflict);
                    // Its place on its course is its rear axle's.
                    crossing.theirs.from -= course.arm_m;
                    crossing.theirs.to -= course.arm_m;
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
        self.programmes.clear();
        self.programme_of.clear();
        self.outlasts_a_touch.clear();
        self.handover = 0;
        self.after_contact_s = 0.0;
        self.parts.clear();
        self.parts_reach_m.clear();
        self.masses_kg.clear();
        self.control.clear();
        self.ego_lines.clear();
        self.stops.clear();
    }

    /// Makes the last actor so long and wide. [m]
    fn resize_last(&mut self, (length_m, width_m): (f64, f64)) {
        if let Some(member) = self.cast.last_mut() {
            (member.length_m, member.width_m) = (length_m, width_m);
        }
    }
}

/// Gives everybody who has a plan of acts their plan, and what belongs to them; lays out control and the ego's errand.
fn plan(setting: &mut Setting, state: &mut State, scenario: &Scenario, seat: Seat) {
    let draft = scenario.draft();
    setting.friction = draft.environment.surface.relative_friction();
    setting.after_contact_s = draft.after_contact_s;
    setting.control.extend(draft.control.iter().map(|control| control.device.clone()));
    setting.stops.extend_from_slice(&draft.ego.stops);
    setting.ego_lines.extend(scenario.ego_stop_lines());
    state.signals.resize(setting.control.len(), None);
    let names = Names(draft);
    if let (Some(placement), Some(recorded)) = (scenario.recorded(), &draft.ego.recorded) {
        let programme = Programme::new(
            recorded,
            placement.course.clone(),
            placement.t_m,
            &placement.parts,
            0.5 * placement.length_m,
            &names,
        );
        let handover_s = draft.ego.handover_s.unwrap_or(0.0);
        setting.handover = match seat {
            Seat::BuiltIn(Ego::Recorded) => u32::MAX,
            _ => (handover_s * 10.0).round() as u32,
        };
        follow_plan(setting, state, 0, programme);
    }
    for (position, (actor, placement)) in draft.actors.iter().zip(scenario.actors()).enumerate() {
        let number = 1 + draft.partners.len() + position;
        let half_length_m = 0.5 * placement.length_m;
        let (course, t_m) = (placement.course.clone(), placement.t_m);
        let programme = Programme::new(&actor.plan, course, t_m, &actor.parts, half_length_m, &names);
        follow_plan(setting, state, number, programme);
        attach(setting, state, number, &actor.parts);
    }
    attach(setting, state, 0, &draft.ego.parts);
}

fn follow_plan(setting: &mut Setting, state: &mut State, actor: usize, programme: Programme) {
    let progress = programme.start();
    let (pose, velocity, yaw_rate) = programme.motion(&progress);
    state.bodies[actor].carry(pose, velocity, yaw_rate);
    state.seen[actor].present = progress.present;
    setting.cast[actor].appears = programme.appears;
    setting.outlasts_a_touch[actor] = programme.outlasts_a_touch(actor as u16);
    setting.programme_of[actor] = u16::try_from(setting.programmes.len()).ok();
    setting.programmes.push(programme);
    state.progress.push(progress);
    state.movers[actor] = Mover::Plan;
}

/// Adds the parts of an actor, behind everybody in the cast.
fn attach(setting: &mut Setting, state: &mut State, owner: usize, parts: &[Part]) {
    let heading = state.bodies[owner].pose.heading;
    for (number, part) in parts.iter().enumerate() {
        let kind = setting.cast[owner].kind;
        let (length_m, width_m) = (part.length_m, part.width_m);
        let (owner_number, number) = (owner as u16, number as u16);
        let member = CastMember {
            role: Role::Part,
            kind,
            length_m,
            width_m,
            owner: Some(owner_number),
            part: number,
            appears: 0,
        };
        setting.cast.push(member);
        let attached = Attached { owner: owner_number, part: part.clone() };
        setting.parts_reach_m[owner] = setting.parts_reach_m[owner].max(attached.reach_m());
        setting.parts.push(attached);
        state.parts.push(PartState::resting(part, heading));
    }
}

impl State {
    /// Writes down everybody's state, with the controls chosen last.
    pub(crate) fn write_states(&mut self, parts: &[Attached]) {
        for ((slot, seen), controls) in self.states.iter_mut().zip(&self.seen).zip(&self.controls) {
            *slot = actor_state(seen.pose, seen.velocity, *controls);
        }
        for ((slot, attached), part) in self.states[self.seen.len()..].iter_mut().zip(parts).zip(&self.parts) {
            let owner = &self.seen[usize::from(attached.owner)];
            *slot = actor_state(attached.pose(part, owner.pose), owner.velocity, Controls::default());
        }
    }

    /// One physics step of everybody, each by what moves it.
    pub(crate) fn move_all(&mut self, setting: &Setting, workspace: &mut Workspace) {
        let step_s = setting.substeps.step_s();
        for actor in 0..self.bodies.len() {
            let before = self.bodies[actor].pose;
            workspace.before[actor] = before;
            match self.movers[actor] {
                Mover::Wheels => self.bodies[actor].advance(&setting.chassis[actor], &workspace.commands[actor]),
                Mover::Plan => {
                    let Some(number) = setting.programme_of[actor].map(usize::from) else { continue };
                    let (programme, progress) = (&setting.programmes[number], &mut self.progress[number]);
                    if !progress.present || progress.stands() {
                        continue;
                    }
                    programme.advance(progress, step_s);
                    let (pose, velocity, yaw_rate) = programme.motion(progress);
                    self.bodies[actor].carry(pose, velocity, yaw_rate);
                }
                Mover::Momentum => {
                    let loose = &mut self.loose[actor];
                    loose.advance(setting.friction, step_s);
                    self.bodies[actor].carry(loose.pose, loose.velocity, loose.yaw_rate);
                }
            }
        }
    }

    /// Turns doors and arms, and draws trailers on.
    pub(crate) fn move_parts(&mut self, setting: &Setting, workspace: &Workspace, substep: u8) {
        let step = f64::from(self.step) + f64::from(substep) / f64::from(setting.substeps.count());
        for (attached, part) in setting.parts.iter().zip(&mut self.parts) {
            part.swing(step);
            let owner = usize::from(attached.owner);
            attached.draw(part, workspace.before[owner], self.bodies[owner].pose);
        }
    }

    /// Makes the last actor so long and wide. [m]
    fn resize_last(&mut self, (length_m, width_m): (f64, f64)) {
        if let Some(seen) = self.seen.last_mut() {
            (seen.half_length, seen.half_width) = (0.5 * length_m, 0.5 * width_m);
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
        self.movers.clear();
        self.progress.clear();
        self.loose.clear();
        self.parts.clear();
        self.signals.clear();
        self.errand = Errand::default();
        self.contact_s = f64::INFINITY;
    }
}

/// A state as it is recorded.
pub(crate) fn actor_state(pose: Pose, velocity: Vec2, controls: Controls) -> ActorState {
    ActorState {
        x: pose.position.x,
        y: pose.position.y,
        heading: math::wrap_angle(pose.heading),
        vx: velocity.x,
        vy: velocity.y,
        steer: controls.steer,
        throttle: controls.throttle,
    }
}
