//! Scripted partners: what they see, and what their plan asks for then (`recrash_plan`, `docs/models/policies.md`).

use crate::chassis::Controls;
use crate::give_way::GiveWay;
use crate::metadrive_idm;
use crate::scene::Scene;
use recrash_model::rollout::STEP_S;
use recrash_plan::constants::{PREVIEW_S, SEEN_LATE_S};
use recrash_plan::{Crossing, LaneKeeper, Line, Manners, Moment, Plan, SpeedPlan, Way, drift, gap_law, hold_still};

/// The state of a scripted partner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Script {
    plan: Plan,
    keeper: LaneKeeper,
    give_way: GiveWay,
    /// Its number in the world's list of ways.
    way: usize,
}

impl Script {
    pub(crate) fn new(plan: Plan, way: usize) -> Self {
        Self { plan, keeper: LaneKeeper::default(), give_way: GiveWay::default(), way }
    }

    /// Whether something in its plan will still change its speed after this step.
    pub(crate) fn has_plans(&self, step: u32) -> bool {
        self.plan.has_plans(step)
    }

    /// Decides. A `halted` partner (one that has touched another) brakes to a stand.
    pub(crate) fn decide(
        &mut self,
        scene: &Scene<'_>,
        me: usize,
        ways: &[Way],
        crossings: &[Crossing],
        halted: bool,
    ) -> Controls {
        let seen = &scene.actors[me];
        let way = &ways[self.way];
        if self.plan.waits(scene.step) {
            // Whoever waits holds the wheels straight; the controllers begin when it sets off.
            return Controls { steer: 0.0, throttle: hold_still(seen.speed) };
        }
        let (_, offset_m) = scene.lanes.lane(scene.path_lane(me)).local(seen.pose.position);
        let throttle = if halted { hold_still(seen.speed) } else { self.throttle(scene, me, way, offset_m, crossings) };
        Controls { steer: self.steer(scene, me, way, offset_m), throttle }.clipped()
    }

    fn steer(&mut self, scene: &Scene<'_>, me: usize, way: &Way, offset_m: f64) -> f64 {
        let seen = &scene.actors[me];
        let time_s = f64::from(scene.step) * STEP_S + PREVIEW_S - SEEN_LATE_S;
        let (wanted_m, rate_mps) = way.line(&self.plan, time_s);
        let s_m = scene.path_s(me);
        let line = Line {
            offset_m,
            here: scene.way_at(me, s_m),
            ahead: scene.way_at(me, s_m + seen.speed * PREVIEW_S),
            wanted_m,
            drift_rad: drift(rate_mps, seen.speed, self.plan.greatest_drift_rad),
        };
        self.keeper.steer(&self.plan, seen.pose.heading, seen.speed, &line)
    }

    fn throttle(&mut self, scene: &Scene<'_>, me: usize, way: &Way, offset_m: f64, crossings: &[Crossing]) -> f64 {
        let seen = &scene.actors[me];
        let (mut give_way_m, mut law) = (None, 0.0);
        match self.plan.speed {
            SpeedPlan::GiveWay { speed_mps, gap_s } => {
                give_way_m = self.give_way.stop_line(scene, me, crossings, speed_mps, Manners { gap_s });
            }
            SpeedPlan::Follow { speed_mps } => {
                let lead = metadrive_idm::lead_on(scene, me, seen.place.lane);
                law = gap_law(seen.speed, speed_mps, seen.forward, seen.velocity, lead);
            }
            SpeedPlan::Timed { .. } | SpeedPlan::Wait { .. } => {}
        }
        let time_s = f64::from(scene.step) * STEP_S;
        let now = Moment {
            step: scene.step,
            // MetaDrive knows speeds in single precision.
            speed_mps: f64::from(seen.speed as f32),
            s_m: scene.path_s(me),
            t_m: offset_m,
            wanted_t_m: way.line(&self.plan, time_s).0,
            give_way_m,
            gap_law: law,
        };
        self.plan.pedal(way, &now)
    }
}
