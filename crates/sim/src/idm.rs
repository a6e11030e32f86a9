//! The intelligent driver model in SI units, with eyes: `idm`.
//!
//! Car following by Treiber, Hennecke and Helbing (treiber2000). What is in the way is found by place, not by lane name:
//! vehicles that cut in, cones by where they lie. Where paths cross or merge it gives way unless there is time to go
//! first. It slows for curves. It keeps its lane: it does not overtake and does not steer around anything.
//! Equations and fields: `docs/models/idm.md`.

use crate::chassis::Controls;
use crate::give_way::GiveWay;
use crate::scene::Scene;
use crate::steering::LaneKeeper;
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::surroundings::Surface;
use recrash_model::vehicle::VehicleSpec;
use recrash_plan::{Crossing, Manners, Traveller};

/// Parameters of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdmParameters {
    /// Speed on a free road, `v0`. [m/s]
    pub desired_speed_mps: f64,
    /// Time headway, `T`. [s]
    pub time_headway_s: f64,
    /// Bumper-to-bumper gap at a standstill, `s0`. [m]
    pub minimum_gap_m: f64,
    /// Greatest acceleration, `a`. [m/s^2]
    pub acceleration_mps2: f64,
    /// Comfortable deceleration, `b`. [m/s^2, positive]
    pub comfortable_deceleration_mps2: f64,
    /// Hardest braking, on a dry road. [m/s^2, positive]
    pub hardest_deceleration_mps2: f64,
    /// Sideways acceleration it accepts in curves, on a dry road. [m/s^2]
    pub curve_mps2: f64,
}

impl IdmParameters {
    /// Treiber and Kesting's values for town traffic (treiber2013, table 11.2), with the braking of an alert driver:
    /// 8 m/s^2, what a car does on a dry road.
    pub const fn town(desired_speed_mps: f64) -> Self {
        Self {
            desired_speed_mps,
            time_headway_s: 1.0,
            minimum_gap_m: 2.0,
            acceleration_mps2: 1.5,
            comfortable_deceleration_mps2: 2.0,
            hardest_deceleration_mps2: 8.0,
            curve_mps2: 3.5,
        }
    }

    /// Acceleration at this speed, `gap` behind something that moves at `lead` along the same way. [m/s^2]
    ///
    /// `a (1 - (v/v0)^4 - (s*/s)^2)`, `s* = s0 + max(0, v T + v (v - v_lead) / (2 sqrt(a b)))`.
    #[inline]
    pub fn acceleration(&self, speed_mps: f64, lead: Option<(f64, f64)>) -> f64 {
        let free = 1.0 - math::sq(math::sq(speed_mps / self.desired_speed_mps.max(0.1)));
        let interaction =
            lead.map_or(0.0, |(gap_m, lead_mps)| math::sq(self.desired_gap(speed_mps, lead_mps) / gap_m.max(0.1)));
        self.acceleration_mps2 * (free - interaction)
    }

    /// The gap it wants, `s*`. [m]
    pub fn desired_gap(&self, speed_mps: f64, lead_mps: f64) -> f64 {
        let comfort = 2.0 * (self.acceleration_mps2 * self.comfortable_deceleration_mps2).sqrt();
        let dynamic = speed_mps * self.time_headway_s + speed_mps * (speed_mps - lead_mps) / comfort;
        self.minimum_gap_m + dynamic.max(0.0)
    }

    /// The gap at which it follows at constant speed; infinite from the desired speed on. [m]
    pub fn equilibrium_gap(&self, speed_mps: f64) -> f64 {
        let free = 1.0 - math::sq(math::sq(speed_mps / self.desired_speed_mps));
        if free <= 0.0 { f64::INFINITY } else { self.desired_gap(speed_mps, speed_mps) / free.sqrt() }
    }
}

/// It looks this far ahead. [m]
const SIGHT_M: f64 = 100.0;

/// Who moves sideways is taken for where he will be after this time. [s]
const ANTICIPATION_S: f64 = 0.5;

/// Room it wants on each side of itself. [m]
const SIDE_ROOM_M: f64 = 0.2;

/// Time it wants between itself and others at a crossing. [s]
const CROSSING_GAP_S: f64 = 1.0;

/// The state of one such driver.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Idm {
    parameters: IdmParameters,
    keeper: LaneKeeper,
    give_way: GiveWay,
    full_throttle_mps2: f64,
    full_brake_mps2: f64,
}

impl Idm {
    pub(crate) fn new(spec: &VehicleSpec, target_mps: f64, surface: Surface) -> Self {
        let mut parameters = IdmParameters::town(target_mps);
        let friction = surface.relative_friction();
        parameters.hardest_deceleration_mps2 *= friction;
        parameters.curve_mps2 *= friction;
        Self {
            parameters,
            keeper: LaneKeeper::new(),
            give_way: GiveWay::default(),
            full_throttle_mps2: spec.max_acceleration_mps2,
            full_brake_mps2: spec.brake_demand_mps2,
        }
    }

    /// The hardest that it brakes on this surface. [m/s^2]
    pub(crate) fn hardest_mps2(&self) -> f64 {
        self.parameters.hardest_deceleration_mps2
    }

    pub(crate) fn decide(&mut self, scene: &Scene<'_>, me: usize, crossings: &[Crossing]) -> Controls {
        let seen = &scene.actors[me];
        let steer = self.keeper.steer(scene.lanes.lane(scene.path_lane(me)), seen.pose, scene.ego_beside_m, 0.0);
        let parameters = &self.parameters;
        let mut acceleration = parameters.acceleration(seen.speed, None);
        let mut keep_off = |gap_m: f64, lead_mps: f64| {
            acceleration = acceleration.min(parameters.acceleration(seen.speed, Some((gap_m, lead_mps))));
        };
        for (gap_m, speed_mps) in in_the_way(scene, me) {
            keep_off(gap_m, speed_mps);
        }
        self.give_way.count_standing(scene, me);
        let manners = Manners { gap_s: CROSSING_GAP_S };
        for (crossing, distance) in
            self.give_way.stop_lines(scene, me, crossings, parameters.desired_speed_mps, manners)
        {
            // The line is for the bumper already; the usual room in front of it is not wanted twice.
            let waits = parameters.acceleration(seen.speed, Some((distance + 0.5 * parameters.minimum_gap_m, 0.0)));
            let follows = lead(scene, me, crossing).map(|lead| parameters.acceleration(seen.speed, Some(lead)));
            acceleration = acceleration.min(follows.map_or(waits, |follows| waits.max(follows)));
        }
        acceleration = acceleration.min(curve_limit(parameters, scene, me));
        acceleration = acceleration.max(-parameters.hardest_deceleration_mps2);
        let full = if acceleration >= 0.0 { self.full_throttle_mps2 } else { self.full_brake_mps2 };
        Controls { steer, throttle: acceleration / full.max(1e-3) }.clipped()
    }
}

/// Who is ahead where the two ways cross at a small angle, as if on the same way: bumper-to-bumper gap and speed.
fn lead(scene: &Scene<'_>, me: usize, crossing: &Crossing) -> Option<(f64, f64)> {
    let at = |actor: usize| Traveller { s_m: scene.path_s(actor), speed_mps: scene.actors[actor].speed };
    let other = at(crossing.other);
    let gap_m = crossing.lead(at(me), other)? - scene.actors[me].half_length - scene.actors[crossing.other].half_length;
    (gap_m > 0.0).then_some((gap_m, other.speed_mps))
}

/// Everything in the strip of road that this actor is about to drive: bumper-to-bumper gap and speed along the way.
fn in_the_way<'a>(scene: &'a Scene<'_>, me: usize) -> impl Iterator<Item = (f64, f64)> + 'a {
    let seen = &scene.actors[me];
    let actors = scene.actors.iter().enumerate().filter(move |&(other, actor)| other != me && actor.present).map(
        move |(_, actor)| (actor.pose.position, actor.forward, actor.half_length, actor.half_width, actor.velocity),
    );
    let obstacles = scene.obstacles.iter().map(|obstacle| {
        let outline = obstacle.outline;
        (outline.centre, outline.axis, outline.half_length, outline.half_width, Vec2::default())
    });
    actors.chain(obstacles).filter_map(move |(position, axis, half_length, half_width, velocity)| {
        let offset = position - seen.pose.position;
        if offset.length_squared() > SIGHT_M * SIGHT_M {
            return None;
        }
        let (distance, t, forward) = scene.ahead(me, position, SIGHT_M)?;
        let right = -forward.left();
        let half_across = half_length * axis.dot(right).abs() + half_width * axis.dot(right.left()).abs();
        let half_along = half_length * axis.dot(forward).abs() + half_width * axis.cross(forward).abs();
        let soon = t + ANTICIPATION_S * velocity.dot(right);
        // Who is moving out of the way still is in it.
        let nearest = if t * soon < 0.0 { 0.0 } else { t.abs().min(soon.abs()) };
        (nearest - half_across < seen.half_width + SIDE_ROOM_M && distance > 0.0)
            .then(|| ((distance - seen.half_length - half_along).max(0.1), velocity.dot(forward).max(0.0)))
    })
}

/// The acceleration at which every curve ahead is reached at a fitting speed. [m/s^2]
pub(crate) fn curve_limit(parameters: &IdmParameters, scene: &Scene<'_>, me: usize) -> f64 {
    let seen = &scene.actors[me];
    let s = scene.path_s(me);
    let mut limit = f64::INFINITY;
    for position in scene.rest_of_path(me) {
        let lane = scene.lanes.lane(scene.route_lanes[position]);
        let distance = (scene.route_starts[position] - s).max(0.0);
        if distance > SIGHT_M {
            break;
        }
        let Some(radius) = lane.radius() else { continue };
        let fitting_squared = parameters.curve_mps2 * radius;
        let over = math::sq(seen.speed) - fitting_squared;
        // Inside the curve: back to the fitting speed within about a second.
        let wanted = if distance > 1.0 {
            if over > 0.0 { -over / (2.0 * distance) } else { continue }
        } else {
            fitting_squared.sqrt() - seen.speed
        };
        // Far curves ask for little; braking begins when it would be comfortable.
        if distance <= 1.0 || wanted < -0.7 * parameters.comfortable_deceleration_mps2 {
            limit = limit.min(wanted);
        }
    }
    limit
}
