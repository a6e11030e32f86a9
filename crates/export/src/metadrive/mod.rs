//! MetaDrive: the scenario with everything resolved to MetaDrive's own terms, and a script that runs it.

use crate::ExportFile;
use recrash_model::narrative::Side;
use recrash_model::record::PartnerKind;
use recrash_model::rollout::STEP_S;
use recrash_model::scenario::{LateralMove, MapSpec, MissingArm, ObstacleKind, Policy, ScenarioDraft};
use recrash_model::vehicle::{DRY_TYRE_FRICTION, VehicleSpec};
use recrash_roads::{LaneId, Placement, Scenario};
use serde::Serialize;
use serde_json::{Value, json};

/// The format tag of the JSON file.
const METADRIVE_FORMAT: &str = "recrash.metadrive/1";

/// The same for every scenario.
const SCRIPT: &str = include_str!("run_metadrive.py");

/// MetaDrive's name of a lane: the nodes it lies between and its number, 0 the leftmost.
type LaneIndex = (String, String, u8);

#[derive(Serialize)]
struct MetaDriveScenario<'a> {
    format: &'static str,
    id: &'a str,
    title: String,
    records: Vec<String>,
    narrative: &'a str,
    map: Map,
    ego: Ego,
    partners: Vec<MetaDrivePartner<'a>>,
    obstacles: Vec<MetaDriveObstacle>,
    max_steps: u32,
    /// What MetaDrive has no place for.
    not_carried: Value,
}

#[derive(Serialize)]
struct Map {
    block: char,
    lanes: u8,
    lane_width_m: f64,
    approach_m: f64,
    arm_m: Option<f64>,
    parameters: Value,
}

#[derive(Serialize)]
struct RoadUser {
    length_m: f64,
    width_m: f64,
    front_axle_m: f64,
    rear_axle_m: f64,
    max_acceleration_mps2: f64,
    brake_demand_mps2: f64,
    max_speed_mps: f64,
    max_wheel_angle_deg: f64,
    tyre_friction: f64,
    spawn_lane: LaneIndex,
    spawn_s_m: f64,
    speed_mps: f64,
    way: Vec<LaneIndex>,
}

#[derive(Serialize)]
struct Ego {
    #[serde(flatten)]
    road_user: RoadUser,
    target_speed_mps: f64,
}

#[derive(Serialize)]
struct MetaDrivePartner<'a> {
    id: &'a str,
    kind: PartnerKind,
    #[serde(flatten)]
    road_user: RoadUser,
    t_m: f64,
    policy: &'a Policy,
    lateral: &'a [LateralMove],
    conflict: Option<WaysMeet>,
}

/// Where a partner's way meets the ego's, along each. [m]
#[derive(Serialize)]
struct WaysMeet {
    ego_s_m: f64,
    partner_s_m: f64,
}

#[derive(Serialize)]
struct MetaDriveObstacle {
    kind: ObstacleKind,
    lane: LaneIndex,
    x_m: f64,
    y_m: f64,
    heading_rad: f64,
}

/// The files of a scenario: it as JSON, and the script.
pub(crate) fn files(scenario: &Scenario) -> Vec<ExportFile> {
    let draft = scenario.draft();
    let content = serde_json::to_string_pretty(&resolved(scenario, draft)).unwrap_or_default() + "\n";
    vec![
        ExportFile { name: format!("{}.metadrive.json", draft.id), content: content.into_bytes() },
        ExportFile { name: "run_metadrive.py".to_owned(), content: SCRIPT.as_bytes().to_vec() },
    ]
}

fn resolved<'a>(scenario: &'a Scenario, draft: &'a ScenarioDraft) -> MetaDriveScenario<'a> {
    let partners = draft.partners.iter().zip(scenario.partners()).map(|(partner, placement)| MetaDrivePartner {
        id: &partner.id,
        kind: partner.kind,
        road_user: road_user(scenario, placement),
        t_m: placement.t_m,
        policy: &partner.policy,
        lateral: &partner.lateral,
        conflict: placement.conflict.map(|conflict| WaysMeet { ego_s_m: conflict.s_a, partner_s_m: conflict.s_b }),
    });
    let obstacles = draft.obstacles.iter().zip(scenario.obstacles()).map(|(obstacle, place)| MetaDriveObstacle {
        kind: obstacle.kind,
        lane: lane_index(scenario, place.lane),
        x_m: place.placed.pose.position.x,
        y_m: place.placed.pose.position.y,
        heading_rad: place.placed.pose.heading,
    });
    MetaDriveScenario {
        format: METADRIVE_FORMAT,
        id: &draft.id,
        title: crate::title(draft),
        records: draft.source.records.iter().map(ToString::to_string).collect(),
        narrative: &draft.source.narrative,
        map: map(&draft.map),
        ego: Ego { road_user: road_user(scenario, scenario.ego()), target_speed_mps: draft.ego.target_speed_mps },
        partners: partners.collect(),
        obstacles: obstacles.collect(),
        // At least one step; a checked scenario lasts two minutes at most.
        max_steps: (draft.duration_s / STEP_S).ceil().clamp(1.0, 1e6) as u32,
        not_carried: json!({ "environment": draft.environment, "traffic": draft.traffic }),
    }
}

fn road_user(scenario: &Scenario, placement: &Placement) -> RoadUser {
    let spec = VehicleSpec::of(placement.kind);
    let segment = &placement.path.segments[placement.path.segment_at(placement.s_m)];
    RoadUser {
        length_m: spec.length_m,
        width_m: spec.width_m,
        front_axle_m: spec.front_axle_m,
        rear_axle_m: spec.rear_axle_m,
        max_acceleration_mps2: spec.max_acceleration_mps2,
        brake_demand_mps2: spec.brake_demand_mps2,
        max_speed_mps: spec.max_speed_mps,
        max_wheel_angle_deg: spec.max_wheel_angle_rad.to_degrees(),
        tyre_friction: DRY_TYRE_FRICTION * scenario.draft().environment.surface.relative_friction(),
        spawn_lane: lane_index(scenario, segment.lane),
        spawn_s_m: placement.s_m - segment.start_m,
        speed_mps: placement.speed_mps,
        way: placement.path.segments.iter().map(|segment| lane_index(scenario, segment.lane)).collect(),
    }
}

fn lane_index(scenario: &Scenario, id: LaneId) -> LaneIndex {
    let lane = scenario.network().lane(id);
    let road = scenario.network().road(lane.road);
    (road.from.clone(), road.to.clone(), lane.index)
}

/// Block parameters as MetaDrive names them.
fn map(spec: &MapSpec) -> Map {
    let carriageway = spec.carriageway();
    let (arm_m, parameters) = match spec {
        MapSpec::S(m) => (None, json!({ "length": m.length_m })),
        MapSpec::C(m) => {
            let dir = i32::from(m.direction != Side::Left);
            (None, json!({ "length": m.length_m, "radius": m.radius_m, "angle": m.angle_deg, "dir": dir }))
        }
        MapSpec::X(m) => (Some(m.arm_m), json!({ "change_lane_num": 0, "decrease_increase": 0 })),
        MapSpec::T(m) => {
            let t_type = match m.missing {
                MissingArm::Right => 0,
                MissingArm::Ahead => 1,
                MissingArm::Left => 2,
            };
            (Some(m.arm_m), json!({ "t_type": t_type, "change_lane_num": 0, "decrease_increase": 0 }))
        }
        MapSpec::O(m) => {
            (Some(m.arm_m), json!({ "exit_radius": m.exit_radius_m, "inner_radius": m.inner_radius_m, "angle": 60 }))
        }
    };
    Map {
        block: spec.letter(),
        lanes: carriageway.lanes,
        lane_width_m: carriageway.lane_width_m,
        approach_m: carriageway.approach_m,
        arm_m,
        parameters,
    }
}
