//! One run: sense, decide, move, collide, record.
//!
//! The order is written here and nowhere else. The memory of a run is kept for the next, so that a step allocates nothing.

use crate::chassis::Controls;
use crate::contacts::{collide, find_near};
use crate::driver::{EgoDriver, Observation};
use crate::ego::Ego;
use crate::recorder::{CastMember, Recorder};
use crate::scene::Scene;
use crate::world::{Driver, World};
use recrash_model::geometry::Vec2;
use recrash_model::rollout::{ActorState, Role, STEP_S, SUBSTEPS, Termination, TerminationKind};
use recrash_plan::constants::{STANDING_MPS, STUCK_STEPS};
use recrash_plan::hold_still;
use recrash_roads::Scenario;
use std::convert::Infallible;

/// MetaDrive's rule for having arrived: this near to the end of the route. [m]
const ARRIVAL_RANGE_M: f64 = 5.0;

/// Steps and physics steps in a second. A time is a count divided by these, which gives the nearest number to the
/// decimal that people read.
const STEPS_PER_S: f64 = 10.0;
const PHYSICS_STEPS_PER_S: f64 = 50.0;

/// Runs scenarios one after the other.
#[derive(Debug, Default)]
pub struct Simulator {
    world: World,
}

impl Simulator {
    /// One without anything prepared.
    pub fn new() -> Self {
        Self::default()
    }

    /// Runs a scenario. It cannot fail: however a run goes, it ends with a [`Termination`].
    pub fn run<R: Recorder>(&mut self, scenario: &Scenario, ego: Ego, recorder: &mut R) -> Termination {
        self.world.prepare(scenario, Some(ego));
        let Ok(termination) = self.drive(scenario, &mut BuiltIn(ego), recorder);
        termination
    }

    /// Runs a scenario with a driver from outside.
    ///
    /// # Errors
    /// The driver's own. What the recorder has of the run until then is not a whole one.
    pub fn run_with<D: EgoDriver, R: Recorder>(
        &mut self,
        scenario: &Scenario,
        driver: &mut D,
        recorder: &mut R,
    ) -> Result<Termination, D::Error> {
        self.world.prepare(scenario, None);
        self.drive(scenario, driver, recorder)
    }

    fn drive<D: EgoDriver, R: Recorder>(
        &mut self,
        scenario: &Scenario,
        driver: &mut D,
        recorder: &mut R,
    ) -> Result<Termination, D::Error> {
        driver.begin(scenario, &self.world.setting.cast)?;
        recorder.begin(scenario, driver.name(), &self.world.setting.cast);
        self.sense();
        loop {
            if let Some(termination) = self.verdict() {
                self.world.workspace.controls.fill(Controls::default());
                self.record(recorder);
                recorder.end(termination);
                driver.end(termination)?;
                return Ok(termination);
            }
            self.decide(driver)?;
            self.record(recorder);
            self.advance(recorder);
            self.world.state.step += 1;
            self.sense();
        }
    }

    /// Freezes the world for the next decision.
    fn sense(&mut self) {
        let World { setting, state, .. } = &mut self.world;
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
    fn decide<D: EgoDriver>(&mut self, outside: &mut D) -> Result<(), D::Error> {
        let World { setting, state, workspace } = &mut self.world;
        let scene = Scene {
            step: state.step,
            lanes: &setting.lanes,
            routes: &setting.routes,
            route_lanes: &setting.route_lanes,
            route_starts: &setting.route_starts,
            actors: &state.seen,
            obstacles: &setting.obstacles,
        };
        let asked = match state.drivers[0] {
            Driver::Outside => {
                workspace.write_states(&state.seen);
                Some(ask(outside, &scene, &workspace.states)?)
            }
            _ => None,
        };
        for (me, driver) in state.drivers.iter_mut().enumerate() {
            let halted = state.halted[me];
            workspace.controls[me] = if setting.cast[me].role == Role::Traffic && !state.traffic_released {
                Controls::default()
            } else {
                match driver {
                    Driver::MetadriveIdm(driver) if halted => {
                        Controls { throttle: hold_still(scene.actors[me].speed), ..driver.decide(&scene, me) }
                    }
                    Driver::MetadriveIdm(driver) => driver.decide(&scene, me),
                    Driver::Idm(driver) => driver.decide(&scene, me, &setting.crossings),
                    Driver::Reference(driver) => driver.decide(&scene, me, &setting.crossings, &mut state.attention),
                    Driver::Script(script) => script.decide(&scene, me, &setting.ways, &setting.crossings, halted),
                    Driver::Outside => asked.unwrap_or_default().clipped(),
                }
            };
        }
        Ok(())
    }

    /// Hands the states to the recorder, with the controls just chosen.
    fn record<R: Recorder>(&mut self, recorder: &mut R) {
        let World { state, workspace, .. } = &mut self.world;
        workspace.write_states(&state.seen);
        recorder.step(&workspace.states);
    }

    /// Moves everybody through one step, and notes who touches whom.
    fn advance<R: Recorder>(&mut self, recorder: &mut R) {
        let World { setting, state, workspace } = &mut self.world;
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
        let (setting, state) = (&self.world.setting, &self.world.state);
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
        let ego = &self.world.state.seen[0];
        if !ego.place.on_last_road() {
            return false;
        }
        let lanes = self.world.setting.lanes.of_road(ego.place.road(&self.world.setting.routes));
        lanes.iter().any(|&lane| {
            let lane = self.world.setting.lanes.lane(lane);
            let (s, t) = lane.local(ego.pose.position);
            (s - lane.length_m).abs() < ARRIVAL_RANGE_M && t.abs() <= 0.5 * lane.width_m()
        })
    }

    /// Whether anybody but the ego moves, or will because of its plan.
    fn anybody_moves(&self) -> bool {
        let state = &self.world.state;
        (1..state.seen.len()).any(|actor| {
            let plans = match &state.drivers[actor] {
                Driver::Script(script) => !state.halted[actor] && script.has_plans(state.step),
                Driver::MetadriveIdm(_) | Driver::Idm(_) | Driver::Reference(_) | Driver::Outside => false,
            };
            state.seen[actor].present && (plans || state.seen[actor].speed >= STANDING_MPS)
        })
    }
}

/// Asks the driver from outside.
fn ask<D: EgoDriver>(outside: &mut D, scene: &Scene<'_>, states: &[ActorState]) -> Result<Controls, D::Error> {
    let route_t_m = scene.lanes.lane(scene.path_lane(0)).local(scene.actors[0].pose.position).1;
    outside.decide(&Observation {
        step: scene.step,
        time_s: f64::from(scene.step) / STEPS_PER_S,
        route_s_m: scene.path_s(0),
        route_t_m,
        states,
        seen: scene.actors,
    })
}

/// A driver of the simulator's own, which is never asked from outside.
struct BuiltIn(Ego);

impl EgoDriver for BuiltIn {
    type Error = Infallible;

    fn name(&self) -> &str {
        self.0.name()
    }

    fn begin(&mut self, _: &Scenario, _: &[CastMember]) -> Result<(), Infallible> {
        Ok(())
    }

    fn decide(&mut self, _: &Observation<'_>) -> Result<Controls, Infallible> {
        Ok(Controls::default())
    }

    fn end(&mut self, _: Termination) -> Result<(), Infallible> {
        Ok(())
    }
}
