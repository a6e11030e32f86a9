//! One run, driven step by step by whoever holds it: a test, a Python environment, a search, or [`crate::Runner`].
//!
//! A run is plain data in three parts, as rapier keeps them: what is fixed (the setting), what is true at a time (the
//! state, drivers and their memory in it), and scratch. To save a run is to copy the state: see [`Run::snapshot`].
//!
//! ```
//! # fn scenario() -> recrash_roads::Scenario {
//! #     let json = r#"{ "format": "recrash.scenario/1", "id": "doc", "source": {}, "duration_s": 3.0,
//! #         "map": { "type": "S", "lanes": 2, "lane_width_m": 3.5, "approach_m": 60.0, "length_m": 200.0 },
//! #         "environment": { "lighting": "daylight", "weather": "clear", "surface": "dry" },
//! #         "ego": { "lane": 1, "turn": "straight", "s_m": 5.0, "speed_mps": 8.0, "target_speed_mps": 8.0 },
//! #         "partners": [] }"#;
//! #     recrash_roads::check(recrash_roads::read_draft(json).expect("a draft").value).expect("a scenario").value
//! # }
//! use recrash_sim::{Controls, Run, Seat};
//!
//! let mut run = Run::new(&scenario(), Seat::Outside);
//! while run.termination().is_none() {
//!     let ego = run.observe().states[0];
//!     let throttle = if ego.speed() < 8.0 { 0.3 } else { 0.0 };
//!     run.step(Some(Controls { steer: 0.0, throttle }));
//! }
//! ```

use crate::cast::CastMember;
use crate::chassis::{Controls, VehicleState};
use crate::contacts::{collide, find_near};
use crate::driver::Observation;
use crate::ego::Seat;
use crate::halts;
use crate::movement::Mover;
use crate::scene::Scene;
use crate::world::{Driver, Setting, State, Workspace, prepare};
use recrash_model::geometry::Vec2;
use recrash_model::rollout::{ActorState, Event, EventKind, Role, STEP_S, Substeps, Termination, TerminationKind};
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::acts::{Glimpse, Sight};
use recrash_plan::constants::{STANDING_MPS, STUCK_STEPS};
use recrash_plan::hold_still;
use recrash_roads::Scenario;
use std::sync::Arc;

/// MetaDrive's rule for having arrived: this near to the end of the route. [m]
const ARRIVAL_RANGE_M: f64 = 5.0;

/// Steps in a second. A time is a count divided by this (or by physics steps in a second), which gives the nearest number to
/// the decimal that people read.
const STEPS_PER_S: f64 = 10.0;

/// One run of one scenario, at one time.
///
/// Copies are independent, and every copy goes on with the same bytes. A step allocates nothing.
#[derive(Debug, Clone)]
pub struct Run {
    /// Shared with copies and snapshots; never changed while it is.
    setting: Arc<Setting>,
    state: State,
    workspace: Workspace,
}

/// A run as it was at one time; see [`Run::snapshot`].
#[derive(Debug, Clone)]
pub struct Snapshot {
    setting: Arc<Setting>,
    state: State,
}

impl Run {
    /// A run at time 0.
    pub fn new(scenario: &Scenario, seat: Seat) -> Self {
        let mut run = Self::empty();
        run.reset(scenario, seat);
        run
    }

    /// One without anybody in it, to be reset.
    pub(crate) fn empty() -> Self {
        Self { setting: Arc::default(), state: State::default(), workspace: Workspace::default() }
    }

    /// Starts over at time 0, with this scenario or another; the memory is used again.
    pub fn reset(&mut self, scenario: &Scenario, seat: Seat) {
        self.reset_in(scenario, seat, Substeps::default());
    }

    /// The same with another physics step; decisions stay at every 0.1 s.
    pub fn reset_in(&mut self, scenario: &Scenario, seat: Seat, substeps: Substeps) {
        if Arc::get_mut(&mut self.setting).is_none() {
            self.setting = Arc::default();
        }
        if let Some(setting) = Arc::get_mut(&mut self.setting) {
            prepare(setting, &mut self.state, scenario, seat, substeps);
        }
        self.workspace.prepare(&self.setting);
        self.sense();
        self.conclude();
    }

    /// Everybody in the run: the ego, the partners in the scenario's order, then background traffic.
    pub fn cast(&self) -> &[CastMember] {
        &self.setting.cast
    }

    /// The world as it is now.
    pub fn observe(&self) -> Observation<'_> {
        let (scene, state, setting) = (self.scene(), &self.state, &self.setting);
        Observation {
            step: state.step,
            time_s: f64::from(state.step) / STEPS_PER_S,
            route_s_m: scene.path_s(0),
            route_t_m: scene.lanes.lane(scene.path_lane(0)).local(state.seen[0].pose.position).1,
            states: &state.states,
            seen: &state.seen,
            signals: &state.signals,
            lines: &setting.ego_lines,
            stops: &setting.stops[usize::from(state.errand.stops_done).min(setting.stops.len())..],
            recorded: state.movers[0] == Mover::Plan,
        }
    }

    /// How the run has ended; `None` while it goes on.
    pub fn termination(&self) -> Option<Termination> {
        self.state.termination
    }

    /// Goes on for 0.1 s, and tells how the run has ended, if it has. A run that has ended stays as it is.
    ///
    /// `ego` is what the ego does. A built-in ego needs none; where there is some, it is overruled for this step, and goes on
    /// as if it had only watched. A seat without a driver and without controls rolls on.
    pub fn step(&mut self, ego: Option<Controls>) -> Option<Termination> {
        self.workspace.events.clear();
        if self.state.termination.is_none() {
            self.decide(ego);
            self.advance();
            self.state.step += 1;
            self.sense();
            self.conclude();
        }
        self.state.termination
    }

    /// The states that the last step began with, each with the controls chosen for it; those before a step was made are
    /// without meaning.
    pub fn decided(&self) -> &[ActorState] {
        &self.workspace.decided
    }

    /// What happened during the last step, in order of time.
    pub fn events(&self) -> &[Event] {
        &self.workspace.events
    }

    /// Keeps the run as it is now. [`Run::restore`] brings it back, into this run or any other.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { setting: Arc::clone(&self.setting), state: self.state.clone() }
    }

    /// Goes back to where the snapshot was taken; the scenario and the ego's seat become its own. Nothing is allocated where
    /// this run has had as many road users before.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        if !Arc::ptr_eq(&self.setting, &snapshot.setting) {
            self.setting = Arc::clone(&snapshot.setting);
        }
        self.state.clone_from(&snapshot.state);
        self.workspace.prepare(&self.setting);
    }

    fn scene(&self) -> Scene<'_> {
        scene(&self.setting, &self.state, 0.0)
    }

    /// Freezes the world for the next decision.
    fn sense(&mut self) {
        let (setting, state) = (&*self.setting, &mut self.state);
        let time_s = f64::from(state.step) / STEPS_PER_S;
        for (shown, device) in state.signals.iter_mut().zip(&setting.control) {
            *shown = device.aspect(time_s);
        }
        for (actor, ((seen, body), member)) in state.seen.iter_mut().zip(&state.bodies).zip(&setting.cast).enumerate() {
            if !body.is_finite() {
                state.diverged = true;
                continue;
            }
            seen.pose = body.pose;
            seen.forward = Vec2::from_heading(body.pose.heading);
            seen.velocity = body.velocity();
            seen.speed = body.speed();
            let programme = setting.programme_of[actor].filter(|_| state.movers[actor] != Mover::Wheels);
            if let Some(programme) = programme {
                let progress = &state.progress[usize::from(programme)];
                seen.present = progress.present;
                seen.plan_s_m = (actor > 0).then_some(progress.s_m);
            }
            if seen.present {
                seen.place.localise(&setting.lanes, &setting.routes, body.pose.position, body.pose.heading);
                seen.progress.follow(&setting.lanes, &setting.route_lanes, &seen.place, body.pose.position);
                // Background traffic that has left the road goes on straight and is out of the game.
                seen.present = seen.place.on_road || member.role != Role::Traffic;
            }
        }
        let ego = &state.seen[0];
        state.traffic_released |= !ego.place.on_first_road();
        let waits = state.movers[0] != Mover::Wheels || halts::stays(setting, state);
        state.standing_steps = if ego.speed < STANDING_MPS && !waits { state.standing_steps + 1 } else { 0 };
    }

    /// Everybody decides on the same frozen world.
    fn decide(&mut self, ego: Option<Controls>) {
        self.decide_plans();
        let (setting, state) = (&*self.setting, &mut self.state);
        let halt_m = if state.movers[0] == Mover::Wheels && (!setting.ego_lines.is_empty() || !setting.stops.is_empty())
        {
            let s_m = scene(setting, state, 0.0).path_s(0);
            let speed_mps = state.seen[0].speed;
            let beside_m = halts::pull_over_m(setting, &state.errand, s_m);
            Some((halts::nearest(setting, state, s_m, speed_mps), beside_m))
        } else {
            None
        };
        let State { drivers, halted, controls: chosen, attention, movers, seen, step, traffic_released, .. } = state;
        let scene = scene_of(setting, seen, *step, halt_m.map_or(0.0, |(_, beside_m)| beside_m));
        for (me, driver) in drivers.iter_mut().enumerate() {
            if movers[me] != Mover::Wheels {
                chosen[me] = Controls::default();
                continue;
            }
            let halted = halted[me];
            chosen[me] = if setting.cast[me].role == Role::Traffic && !*traffic_released {
                Controls::default()
            } else {
                match driver {
                    Driver::MetadriveIdm(driver) if halted => {
                        Controls { throttle: hold_still(scene.actors[me].speed), ..driver.decide(&scene, me) }
                    }
                    Driver::MetadriveIdm(driver) => driver.decide(&scene, me),
                    Driver::Idm(driver) => driver.decide(&scene, me, &setting.crossings),
                    Driver::Reference(driver) => driver.decide(&scene, me, &setting.crossings, attention),
                    Driver::Script(script) => script.decide(&scene, me, &setting.ways, &setting.crossings, halted),
                    Driver::Outside | Driver::Plan => Controls::default(),
                }
            };
        }
        if let (Some((Some(distance_m), _)), false) = (halt_m, matches!(drivers[0], Driver::Outside)) {
            let spec = VehicleSpec::of(setting.cast[0].kind);
            let hardest_mps2 = match &drivers[0] {
                Driver::Idm(driver) => driver.hardest_mps2(),
                Driver::Reference(driver) => driver.hardest_mps2(),
                // MetaDrive's brakes as hard as its vehicle does.
                _ => f64::INFINITY,
            };
            chosen[0] = halts::before(chosen[0], distance_m, scene.actors[0].speed, &spec, hardest_mps2);
        }
        if state.movers[0] == Mover::Wheels
            && let Some(controls) = ego
        {
            state.controls[0] = controls.clipped();
        }
        // The states change hands: these are the decided ones now, and the others are written over after the step.
        std::mem::swap(&mut state.states, &mut self.workspace.decided);
        for (decided, controls) in self.workspace.decided.iter_mut().zip(&state.controls) {
            (decided.steer, decided.throttle) = (controls.steer, controls.throttle);
        }
    }

    /// Everybody who has a plan looks at the same frozen world, and chooses an acceleration. The ego's seat takes over where
    /// its record ends.
    fn decide_plans(&mut self) {
        let (setting, state) = (&*self.setting, &mut self.state);
        let time_s = f64::from(state.step) / STEPS_PER_S;
        if setting.programmes.is_empty() {
            return;
        }
        let glimpses = &mut self.workspace.glimpses;
        glimpses.clear();
        for (actor, seen) in state.seen.iter().enumerate() {
            let progress = setting.programme_of[actor].map(|number| &state.progress[usize::from(number)]);
            let acceleration_mps2 = match (state.movers[actor], progress) {
                (Mover::Plan, Some(progress)) => progress.acceleration_mps2(),
                _ => pedal_mps2(setting.cast[actor].kind, state.controls[actor].throttle, seen.speed),
            };
            glimpses.push(Glimpse {
                outline: seen.outline(),
                velocity: seen.velocity,
                acceleration_mps2,
                hit: state.halted[actor],
                present: seen.present,
                begun: progress.map_or(0, |progress| progress.begun),
            });
        }
        let sight = Sight { step: state.step, all: glimpses, signals: &state.signals };
        for actor in 0..state.seen.len() {
            let Some(number) = setting.programme_of[actor] else { continue };
            if state.movers[actor] == Mover::Momentum {
                continue;
            }
            let (programme, progress) =
                (&setting.programmes[usize::from(number)], &mut state.progress[usize::from(number)]);
            if state.movers[actor] == Mover::Wheels {
                // Doors are opened by riders, whoever drives; and others wait for what was recorded.
                progress.be_driven(state.seen[actor].speed, STEP_S);
            } else if actor == 0 && state.step >= setting.handover {
                let (pose, velocity, yaw_rate) = programme.motion(progress);
                state.bodies[0] = VehicleState::rolling(pose, velocity, yaw_rate, setting.substeps.step_s());
                state.movers[0] = Mover::Wheels;
                continue;
            }
            let (parts, step) = (&mut state.parts, state.step);
            let was_present = progress.present;
            programme.decide(progress, actor, &sight, |part, to_rad, steps| {
                let own =
                    setting.parts.iter().zip(parts.iter_mut()).filter(|(each, _)| usize::from(each.owner) == actor);
                if let Some((_, moved)) = own.into_iter().nth(usize::from(part)) {
                    moved.turn(to_rad, step, steps);
                }
            });
            if was_present && !progress.present && state.movers[actor] == Mover::Plan {
                self.workspace.events.push(Event { time_s, kind: EventKind::Gone { actor } });
            }
        }
    }

    /// Moves everybody through one step, and notes who touches whom.
    fn advance(&mut self) {
        let (setting, state, workspace) = (&*self.setting, &mut self.state, &mut self.workspace);
        workspace.commands.clear();
        for ((body, chassis), controls) in state.bodies.iter_mut().zip(&setting.chassis).zip(&state.controls) {
            workspace.commands.push(body.command(chassis, *controls));
        }
        let all_on_wheels = setting.programmes.is_empty();
        find_near(setting, state, &mut workspace.near);
        let substeps = setting.substeps.count();
        for substep in 1..=substeps {
            if all_on_wheels {
                for ((body, chassis), command) in state.bodies.iter_mut().zip(&setting.chassis).zip(&workspace.commands)
                {
                    body.advance(chassis, command);
                }
            } else {
                state.move_all(setting, workspace);
            }
            if !setting.parts.is_empty() {
                state.move_parts(setting, workspace, substep);
            }
            if workspace.near.is_empty() {
                continue;
            }
            let physics_step = f64::from(state.step) * f64::from(substeps) + f64::from(substep);
            let time_s = physics_step / (STEPS_PER_S * f64::from(substeps));
            collide(setting, state, workspace, time_s);
        }
    }

    /// Decides whether the run is over, and writes down what can be observed. After the end nobody controls anything.
    fn conclude(&mut self) {
        self.state.termination = self.verdict();
        if self.state.termination.is_some() {
            self.state.controls.fill(Controls::default());
        }
        let parts = &self.setting.parts;
        self.state.write_states(parts);
    }

    /// Whether the run is over.
    fn verdict(&self) -> Option<Termination> {
        let (setting, state) = (&self.setting, &self.state);
        let time_s = f64::from(state.step) / STEPS_PER_S;
        // Neither its recorded driver nor a crash has an errand.
        let drives = state.movers[0] == Mover::Wheels && !state.ego_contact;
        let kind = if state.diverged {
            TerminationKind::Diverged
        } else if state.ego_contact && time_s >= state.contact_s + setting.after_contact_s {
            TerminationKind::Contact
        } else if drives && self.has_arrived() {
            TerminationKind::Arrived
        } else if drives && !state.seen[0].place.on_road && !setting.lanes.is_paved(state.seen[0].pose.position) {
            TerminationKind::OffRoad
        } else if state.standing_steps >= STUCK_STEPS && !self.anybody_moves() {
            TerminationKind::Stuck
        } else if time_s >= setting.duration_s - 0.5 * STEP_S {
            if state.ego_contact {
                TerminationKind::Contact
            } else if drives && halts::stays(setting, state) {
                TerminationKind::Arrived
            } else {
                TerminationKind::Timeout
            }
        } else {
            return None;
        };
        Some(Termination { kind, time_s })
    }

    /// MetaDrive's rule: within 5 m of the end of the route's last road, on any of its lanes.
    fn has_arrived(&self) -> bool {
        let (setting, ego) = (&self.setting, &self.state.seen[0]);
        if !ego.place.on_last_road() {
            return false;
        }
        let lanes = setting.lanes.of_road(ego.place.road(&setting.routes));
        lanes.iter().any(|&lane| {
            let lane = setting.lanes.lane(lane);
            let (s, t) = lane.local(ego.pose.position);
            (s - lane.length_m).abs() < ARRIVAL_RANGE_M && t.abs() <= 0.5 * lane.width_m(s)
        })
    }

    /// Whether anybody but the ego moves, or will because of its plan.
    fn anybody_moves(&self) -> bool {
        let state = &self.state;
        (1..state.seen.len()).any(|actor| {
            let plans = match &state.drivers[actor] {
                Driver::Script(script) => !state.halted[actor] && script.has_plans(state.step),
                Driver::MetadriveIdm(_) | Driver::Idm(_) | Driver::Reference(_) | Driver::Outside => false,
                Driver::Plan => match (state.movers[actor], self.setting.programme_of[actor]) {
                    (Mover::Plan, Some(number)) => {
                        let number = usize::from(number);
                        !self.setting.programmes[number].is_over(&state.progress[number])
                    }
                    _ => false,
                },
            };
            state.seen[actor].present && (plans || state.seen[actor].speed >= STANDING_MPS)
        })
    }
}

/// What everybody sees. The ego wants to be this far beside its lane's centre. [m]
fn scene<'a>(setting: &'a Setting, state: &'a State, ego_beside_m: f64) -> Scene<'a> {
    scene_of(setting, &state.seen, state.step, ego_beside_m)
}

fn scene_of<'a>(setting: &'a Setting, seen: &'a [crate::scene::Seen], step: u32, ego_beside_m: f64) -> Scene<'a> {
    Scene {
        step,
        lanes: &setting.lanes,
        routes: &setting.routes,
        route_lanes: &setting.route_lanes,
        route_starts: &setting.route_starts,
        actors: seen,
        obstacles: &setting.obstacles,
        ego_beside_m,
    }
}

/// The acceleration that a pedal asks for. [m/s^2]
fn pedal_mps2(kind: recrash_model::kinds::PartnerKind, throttle: f64, speed_mps: f64) -> f64 {
    let spec = VehicleSpec::of(kind);
    if throttle >= 0.0 {
        throttle * spec.max_acceleration_mps2
    } else if speed_mps < STANDING_MPS {
        0.0
    } else {
        throttle * spec.brake_demand_mps2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ego::Ego;
    use crate::lanes::LaneIndex;
    use crate::metadrive_idm::MetadriveIdm;
    use recrash_model::scenario::{EgoSpec, MapSpec, RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Traffic};
    use recrash_plan::constants::EGO_OVERTAKE_TIMER_STEPS;
    use recrash_plan::metadrive::{NO_HANDOVER, Run as Told};
    use recrash_roads::{LaneId, TRAFFIC_SPEED_MPS, background_traffic, check, read_draft};
    use std::path::{Path, PathBuf};

    /// All files below `cases/`.
    fn cases() -> Vec<PathBuf> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
        let folders = std::fs::read_dir(root).expect("there are cases").map(|entry| entry.unwrap().path());
        let files = folders.filter(|folder| folder.is_dir()).flat_map(|folder| std::fs::read_dir(folder).unwrap());
        files
            .map(|entry| entry.unwrap().path())
            .filter(|file| file.extension().is_some_and(|is| is == "json"))
            .collect()
    }

    /// Two drivers with the same eyes see the same people only where both are told the same lanes.
    #[test]
    fn who_moves_by_a_plan_is_on_the_lane_that_metadrive_is_told() {
        let (mut on_lanes, mut beside) = (0, 0);
        for file in cases() {
            let draft = read_draft(&std::fs::read_to_string(&file).unwrap()).unwrap().value;
            let scenario = check(draft).unwrap().value;
            let Some(told) = Told::new(&scenario, NO_HANDOVER).ok().and_then(|told| told.scene) else { continue };
            let mut way = scenario.ego().path.roads.clone();
            way.dedup();
            let name = |lane: LaneIndex| {
                let lane = scenario.network().lane(LaneId(lane));
                let road = scenario.network().road(lane.road);
                let (from, to) = match way.iter().position(|known| *known == lane.road) {
                    _ if scenario.draft().map.network().is_none() => (road.from.clone(), road.to.clone()),
                    Some(place) => (format!("way{place}"), format!("way{}", place + 1)),
                    None => (format!("road{}:0", lane.road.0), format!("road{}:1", lane.road.0)),
                };
                (from, to, lane.index)
            };
            let mut run = Run::new(&scenario, Seat::BuiltIn(Ego::Recorded));
            let known = told.ends.as_ref().map_or(u32::MAX, |(step, _)| *step);
            while run.termination().is_none() && run.state.step < known && !run.state.ego_contact {
                for (actor, planned) in (1 + scenario.partners().len()..).zip(&told.planned) {
                    if run.state.movers[actor] != Mover::Plan || !run.state.seen[actor].present {
                        continue;
                    }
                    let named = planned.lanes.iter().rfind(|(since, _)| *since <= run.state.step);
                    let named = named.and_then(|(_, lane)| lane.clone());
                    let ours = run.scene().registered_lane(actor).map(|(lane, _)| name(lane));
                    assert_eq!(ours, named, "{file:?}, {}, step {}", planned.id, run.state.step);
                    *if ours.is_some() { &mut on_lanes } else { &mut beside } += 1;
                }
                run.step(None);
            }
        }
        assert!(on_lanes > 1000 && beside > 100, "{on_lanes} {beside}");
    }

    /// Drawn for each of them, and of no use where a simulator takes one for all.
    #[test]
    fn who_drives_by_metadrive_s_policy_has_the_timer_of_its_placement_in_both_simulators() {
        let draft = ScenarioDraft {
            format: SCENARIO_FORMAT.into(),
            id: "test".into(),
            map: MapSpec::O(RoundaboutMap {
                lanes: 2,
                lane_width_m: 3.5,
                approach_m: 60.0,
                arm_m: 60.0,
                exit_radius_m: 10.0,
                inner_radius_m: 30.0,
            }),
            ego: EgoSpec { s_m: 5.0, speed_mps: 7.0, target_speed_mps: 7.0, ..EgoSpec::default() },
            traffic: Traffic { density: 0.3, seed: 3 },
            duration_s: 40.0,
            ..ScenarioDraft::default()
        };
        let scenario = check(draft).unwrap().value;
        let placed: Vec<u32> = background_traffic(&scenario).iter().map(|spawn| spawn.overtake_timer_steps).collect();
        assert!(placed.len() >= 4 && placed.iter().any(|steps| *steps != placed[0]), "{placed:?}");
        let told = Told::new(&scenario, NO_HANDOVER).unwrap();
        let timers: Vec<u32> = told.traffic.iter().map(|actor| actor.overtake_timer_steps).collect();
        assert_eq!((told.ego.overtake_timer_steps, timers), (EGO_OVERTAKE_TIMER_STEPS, placed.clone()));
        let run = Run::new(&scenario, Seat::BuiltIn(Ego::MetadriveIdm));
        let ego = MetadriveIdm::new(scenario.draft().ego.target_speed_mps, EGO_OVERTAKE_TIMER_STEPS);
        let traffic = placed.iter().map(|steps| MetadriveIdm::new(TRAFFIC_SPEED_MPS, *steps));
        let wanted: Vec<String> = std::iter::once(ego).chain(traffic).map(|driver| format!("{driver:?}")).collect();
        let policies = run.state.drivers.iter().filter_map(|driver| match driver {
            Driver::MetadriveIdm(policy) => Some(format!("{policy:?}")),
            _ => None,
        });
        assert_eq!(policies.collect::<Vec<_>>(), wanted);
    }
}
