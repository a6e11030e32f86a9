//! A checked scenario as MetaDrive's Python takes it: every place resolved to a lane and a position on it, every plan
//! and constant as data, so that MetaDrive decides nothing.

mod scene;

use scene::LaneNames;
pub use scene::{LaneLine, LaneShape, NO_HANDOVER, Planned, PlannedPart, Scene, handover};

use crate::constants::{Constants, EGO_OVERTAKE_TIMER_STEPS};
use crate::give_way::Crossing;
use crate::speed::{Plan, SpeedPlan};
use crate::way::Way;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{EGO_ID, Role};
use recrash_model::scenario::{MapSpec, ObstacleKind};
use recrash_model::vehicle::{DRY_TYRE_FRICTION, VehicleSpec};
use recrash_roads::{Footprint, LanePath, Scenario, TRAFFIC_SPEED_MPS, TrafficPlacement, background_traffic};
use serde::Serialize;

/// The Python that runs it: recrash's own worker, and the script that is exported.
pub const SCRIPT: &str = concat!(
    include_str!("../../python/run_metadrive.py"),
    "\n\n",
    include_str!("../../python/partners.py"),
    "\n\n",
    include_str!("../../python/scenes.py"),
);

/// MetaDrive's name of a lane: the nodes it lies between and its number, 0 the leftmost.
pub type LaneName = (String, String, u8);

/// A scenario, resolved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Run {
    /// What gives plans their meaning.
    pub constants: Constants,
    /// Roads.
    pub map: MapSpec,
    /// The ego.
    pub ego: Actor,
    /// The partners, in the scenario's order.
    pub partners: Vec<Actor>,
    /// Background traffic, numbered after the partners.
    pub traffic: Vec<Actor>,
    /// Static obstacles.
    pub obstacles: Vec<Obstacle>,
    /// How long it lasts at most. [s]
    pub duration_s: f64,
    /// What it has besides the paper's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<Scene>,
}

/// A road user.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Actor {
    /// Name.
    pub id: String,
    /// What it is to the scenario.
    pub role: Role,
    /// Kind.
    pub kind: PartnerKind,
    /// Lanes from the one it starts on.
    pub way: Vec<LaneName>,
    /// Of a way in a network of roads, for each lane: where its part of the way begins, and the part of the lane. [m]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub way_m: Vec<[f64; 3]>,
    /// Where that lane begins on its path. [m]
    pub begins_m: f64,
    /// Start on that lane. [m]
    pub s_m: f64,
    /// Start to the right of its centre. [m]
    pub t_m: f64,
    /// Speed at the start. [m/s]
    pub speed_mps: f64,
    /// Speed it wants. [m/s]
    pub target_speed_mps: f64,
    /// How long it has been following already by its overtaking timer, for MetaDrive's policy. [steps]
    pub overtake_timer_steps: u32,
    /// Size and limits.
    pub body: Body,
    /// Which policy of MetaDrive's drives the ego; its IDM policy where none is named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub policy: Option<EgoPolicy>,
    /// Given controls, steering and throttle per step; of an ego that is played.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controls: Option<Vec<[f64; 2]>>,
    /// What a partner does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan: Option<Plan>,
    /// What lies along its way.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partner_way: Option<Way>,
    /// Where a partner that gives way meets others' ways. A stretch without end has `null` for it.
    pub crossings: Vec<Crossing>,
}

/// A policy of MetaDrive's besides its IDM.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EgoPolicy {
    /// The PPO expert that it ships.
    Expert,
}

/// Size and limits, as in [`VehicleSpec`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(missing_docs, reason = "each is the field of its name there")]
pub struct Body {
    pub length_m: f64,
    pub width_m: f64,
    pub chassis_length_m: f64,
    pub chassis_width_m: f64,
    pub front_axle_m: f64,
    pub rear_axle_m: f64,
    pub half_track_m: f64,
    pub acceleration_mps2: f64,
    pub brake_mps2: f64,
    pub speed_mps: f64,
    pub wheel_angle_rad: f64,
    pub friction: f64,
}

/// A static obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Obstacle {
    /// Kind.
    pub kind: ObstacleKind,
    /// The lane it is registered to.
    pub lane: LaneName,
    /// Its middle. [m]
    pub x: f64,
    /// See [`Self::x`].
    pub y: f64,
    /// Its heading. [rad]
    pub heading: f64,
    /// Along its heading. [m]
    pub length_m: f64,
    /// Across it. [m]
    pub width_m: f64,
}

impl Run {
    /// The run of a scenario, with MetaDrive's own policy for the ego from a step on: before it, its recorded driver drives.
    ///
    /// # Errors
    /// What MetaDrive cannot hold.
    pub fn new(scenario: &Scenario, handover: u32) -> Result<Self, String> {
        let scene = Scene::of(scenario, handover)?;
        let names = LaneNames::of(scenario);
        let traffic = background_traffic(scenario);
        let cast = cast(scenario, &traffic);
        let mut actors = cast.iter().map(|member| actor(scenario, &names, member)).collect::<Vec<_>>();
        let partners = scenario.draft().partners.iter().zip(scenario.partners()).enumerate();
        for (position, (partner, placement)) in partners {
            let surface = scenario.draft().environment.surface;
            let plan = Plan::new(partner.kind, &partner.policy, placement.t_m, surface);
            let spec = &mut actors[position + 1];
            if matches!(plan.speed, SpeedPlan::GiveWay { .. }) {
                spec.crossings = crossings(&cast, position + 1);
            }
            spec.partner_way = Some(Way::new(scenario, position, &plan));
            spec.plan = Some(plan);
        }
        let traffic = actors.split_off(1 + scenario.partners().len());
        let partners = actors.split_off(1);
        let obstacles = scenario.obstacles().iter().map(|obstacle| Obstacle {
            kind: obstacle.placed.kind,
            lane: names.name(obstacle.lane),
            x: obstacle.placed.pose.position.x,
            y: obstacle.placed.pose.position.y,
            heading: obstacle.placed.pose.heading,
            length_m: obstacle.placed.length_m,
            width_m: obstacle.placed.width_m,
        });
        Ok(Self {
            constants: Constants::ALL,
            map: scenario.draft().map.clone(),
            ego: actors.swap_remove(0),
            partners,
            traffic,
            obstacles: obstacles.collect(),
            duration_s: scenario.draft().duration_s,
            scene,
        })
    }

    /// Everybody, in the order of the tracks that come back.
    pub fn actors(&self) -> impl Iterator<Item = &Actor> {
        std::iter::once(&self.ego).chain(&self.partners).chain(&self.traffic)
    }
}

/// Somebody's part: the ego, the partners, background traffic.
struct Member<'a> {
    id: String,
    role: Role,
    kind: PartnerKind,
    path: &'a LanePath,
    s_m: f64,
    t_m: f64,
    speed_mps: f64,
    target_speed_mps: f64,
    overtake_timer_steps: u32,
}

fn cast<'a>(scenario: &'a Scenario, traffic: &'a [TrafficPlacement]) -> Vec<Member<'a>> {
    let draft = scenario.draft();
    let scripted = std::iter::once(scenario.ego()).chain(scenario.partners()).enumerate().map(|(number, placement)| {
        let partner = number.checked_sub(1).map(|position| &draft.partners[position]);
        Member {
            id: partner.map_or_else(|| EGO_ID.to_owned(), |partner| partner.id.clone()),
            role: if partner.is_some() { Role::Partner } else { Role::Ego },
            kind: placement.kind,
            path: &placement.path,
            s_m: placement.s_m,
            t_m: placement.t_m,
            speed_mps: placement.speed_mps,
            target_speed_mps: partner.map_or(draft.ego.target_speed_mps, |partner| partner.policy.target_speed()),
            overtake_timer_steps: EGO_OVERTAKE_TIMER_STEPS,
        }
    });
    let traffic = traffic.iter().enumerate().map(|(number, placement)| Member {
        id: format!("traffic{}", number + 1),
        role: Role::Traffic,
        kind: placement.kind,
        path: &placement.path,
        s_m: placement.s_m,
        t_m: 0.0,
        speed_mps: 0.0,
        target_speed_mps: TRAFFIC_SPEED_MPS,
        overtake_timer_steps: placement.overtake_timer_steps,
    });
    scripted.chain(traffic).collect()
}

fn actor(scenario: &Scenario, names: &LaneNames<'_>, member: &Member<'_>) -> Actor {
    let first = member.path.segment_at(member.s_m);
    let begins_m = member.path.segments[first].start_m;
    let size = VehicleSpec::of(member.kind);
    Actor {
        id: member.id.clone(),
        role: member.role,
        kind: member.kind,
        way: member.path.segments[first..].iter().map(|segment| names.name(segment.lane)).collect(),
        way_m: if scenario.draft().map.network().is_some() { way_m(scenario, member.path, first) } else { Vec::new() },
        begins_m,
        s_m: member.s_m - begins_m,
        t_m: member.t_m,
        speed_mps: member.speed_mps,
        target_speed_mps: member.target_speed_mps,
        overtake_timer_steps: member.overtake_timer_steps,
        body: Body {
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
        policy: None,
        controls: None,
        plan: None,
        partner_way: None,
        crossings: Vec::new(),
    }
}

/// Where each lane's part of a way begins, and the part of the lane. [m]
fn way_m(scenario: &Scenario, path: &LanePath, first: usize) -> Vec<[f64; 3]> {
    let parts = path.segments[first..].iter().map(|segment| {
        let lane = scenario.network().lane(segment.lane);
        let on_lane = |s: f64| lane.local(segment.shape.frame(s).0).0;
        [segment.start_m, on_lane(0.0), on_lane(segment.length_m)]
    });
    parts.collect()
}

/// Where the way of an actor meets the others'.
fn crossings(cast: &[Member<'_>], me: usize) -> Vec<Crossing> {
    let own = &cast[me];
    let size = Footprint::of(own.kind);
    cast.iter()
        .enumerate()
        .filter(|(other, _)| *other != me)
        .filter_map(|(other, member)| {
            let other_size = Footprint::of(member.kind);
            let conflict = own.path.conflict(member.path, size.width_m, other_size.width_m)?;
            Some(Crossing::new((me, own.path, size), (other, member.path, other_size), conflict))
        })
        .collect()
}
