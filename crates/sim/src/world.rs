//! The world of one run: what is fixed in it, what is true at a time, and scratch; and how it is put together.

use crate::chassis::{Chassis, Controls, VehicleState, WheelCommand};
use crate::contacts::actor_state;
use crate::ego::Ego;
use crate::idm::Idm;
use crate::lanes::{LaneIndex, LaneTable, Navigator, Progress};
use crate::metadrive_idm::MetadriveIdm;
use crate::recorder::CastMember;
use crate::reference::{Attention, Reference};
use crate::scene::{Seen, SeenObstacle};
use crate::script::Script;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::record::{PartnerKind, Surface};
use recrash_model::rollout::{ActorState, Role};
use recrash_model::scenario::Policy;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::constants::EGO_OVERTAKE_TIMER_STEPS;
use recrash_plan::{Crossing, Plan, Way};
use recrash_roads::{Footprint, LanePath, RoadId, Scenario, TRAFFIC_SPEED_MPS, TrafficPlacement};

/// Everything about one run; kept from run to run for its memory.
#[derive(Debug, Default)]
pub(crate) struct World {
    pub(crate) setting: Setting,
    pub(crate) state: State,
    pub(crate) workspace: Workspace,
}

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

/// What is true at a time.
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
}

/// Scratch.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) controls: Vec<Controls>,
    pub(crate) commands: Vec<WheelCommand>,
    pub(crate) states: Vec<ActorState>,
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
    /// Somebody outside the simulator, see [`crate::EgoDriver`].
    Outside,
}

impl Workspace {
    /// Writes down everybody's state, with the controls chosen last.
    pub(crate) fn write_states(&mut self, seen: &[Seen]) {
        for ((slot, seen), controls) in self.states.iter_mut().zip(seen).zip(&self.controls) {
            *slot = actor_state(seen.pose, seen.velocity, *controls);
        }
    }
}

impl World {
    /// Puts everything where it starts; without an ego of the simulator's own, the driver is somebody outside.
    pub(crate) fn prepare(&mut self, scenario: &Scenario, ego: Option<Ego>) {
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
            None => Driver::Outside,
            Some(Ego::MetadriveIdm) => Driver::MetadriveIdm(MetadriveIdm::new(target_mps, EGO_OVERTAKE_TIMER_STEPS)),
            Some(Ego::Idm) => Driver::Idm(Idm::new(&VehicleSpec::of(placement.kind), target_mps, surface)),
            Some(Ego::Reference) => {
                Driver::Reference(Reference::new(&VehicleSpec::of(placement.kind), target_mps, surface))
            }
        };
        let at = (placement.pose, placement.speed_mps);
        self.cast(Role::Ego, placement.kind, &placement.path, placement.s_m, at, surface, driver);

        for (number, (partner, placement)) in draft.partners.iter().zip(scenario.partners()).enumerate() {
            let plan = Plan::new(partner.kind, &partner.policy, placement.t_m, surface);
            self.setting.ways.push(Way::new(scenario, number, &plan));
            let driver = Driver::Script(Script::new(plan, number));
            let at = (placement.pose, placement.speed_mps);
            self.cast(Role::Partner, placement.kind, &placement.path, placement.s_m, at, surface, driver);
        }

        let spawns = recrash_roads::background_traffic(scenario);
        for spawn in &spawns {
            let driver = Driver::MetadriveIdm(MetadriveIdm::new(TRAFFIC_SPEED_MPS, spawn.overtake_timer_steps));
            self.cast(Role::Traffic, spawn.kind, &spawn.path, 0.0, (spawn.pose, 0.0), surface, driver);
        }
        self.find_crossings(scenario, ego, &spawns);

        let (actors, obstacles) = (self.setting.cast.len(), self.setting.obstacles.len());
        self.state.attention.resize(actors, Attention::default());
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
    fn find_crossings(&mut self, scenario: &Scenario, ego: Option<Ego>, spawns: &[TrafficPlacement]) {
        let partners = scenario.partners().len();
        let path = |actor: usize| match actor {
            0 => &scenario.ego().path,
            _ if actor <= partners => &scenario.partners()[actor - 1].path,
            _ => &spawns[actor - 1 - partners].path,
        };
        let gives_way = |actor: usize| match actor {
            0 => matches!(ego, Some(Ego::Idm | Ego::Reference)),
            _ if actor <= partners => matches!(scenario.draft().partners[actor - 1].policy, Policy::Yielding { .. }),
            _ => false,
        };
        for me in (0..=partners).filter(|&actor| gives_way(actor)) {
            for other in (0..self.setting.cast.len()).filter(|&other| other != me) {
                let size = |actor: usize| {
                    let member = &self.setting.cast[actor];
                    Footprint { length_m: member.length_m, width_m: member.width_m }
                };
                let (mine, theirs) = (size(me), size(other));
                let conflict = path(me).conflict(path(other), mine.width_m, theirs.width_m);
                if let Some(conflict) = conflict {
                    self.setting.crossings.push(Crossing::new(
                        (me, path(me), mine),
                        (other, path(other), theirs),
                        conflict,
                    ));
                }
            }
        }
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
        self.ways.clear();
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
        self.attention.clear();
        self.touched.clear();
        self.ego_contact = false;
        self.traffic_released = false;
        self.standing_steps = 0;
        self.diverged = false;
    }
}
