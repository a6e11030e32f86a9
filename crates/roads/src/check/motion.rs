//! Speeds, kinds, policies and lateral moves: what a road user may do on its way.

use super::numbers::{MAX_SPEED_MPS, MAX_WANTED_MPS};
use super::remarks::{Remarks, shown};
use crate::centreline::Centreline;
use crate::network::{RoadNetwork, RoadPart};
use crate::path::LanePath;
use crate::scenario::Placement;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{MapSpec, Partner, Policy, ScenarioDraft, Start};
use recrash_model::vehicle::VehicleSpec;

/// Fastest through a right turn of a junction: above it MetaDrive's IDM leaves the road. METADRIVE, measured. [m/s]
const RIGHT_TURN_SPEED_MPS: f64 = 10.0;

/// Fastest through a left turn of a junction; same source. [m/s]
const LEFT_TURN_SPEED_MPS: f64 = 12.0;

/// Fastest in a roundabout; same source (8.33 m/s holds, 9 is unreliable). [m/s]
const ROUNDABOUT_SPEED_MPS: f64 = 8.35;

/// Lateral acceleration up to which the same policy keeps its lane in a curve: 17 m/s at R 50 m. [m/s^2]
const CURVE_LATERAL_MPS2: f64 = 17.0 * 17.0 / 50.0;

/// How far sideways of its lane's centre anybody may go, in lane widths.
const LATERAL_LANES: f64 = 1.5;

/// The fastest speed the map allows on a way, and why. [m/s]
pub(super) fn speed_limit(network: &RoadNetwork, way: &LanePath) -> (f64, &'static str) {
    let mut limit = (MAX_SPEED_MPS, "the fastest any vehicle drives");
    for (position, road) in way.roads.iter().enumerate() {
        let Centreline::Arc { radius, turn, .. } = network.lane(way.segments[position].lane).centreline else {
            continue;
        };
        let found = match (&network.map, network.road(*road).part) {
            (MapSpec::O(_), _) | (_, RoadPart::Ring) => (ROUNDABOUT_SPEED_MPS, "the fastest in a roundabout"),
            (MapSpec::C(_), _) => {
                ((CURVE_LATERAL_MPS2 * radius).sqrt(), "the fastest in a curve of this radius, sqrt(5.78 m/s^2 * R)")
            }
            _ if turn < 0.0 => (RIGHT_TURN_SPEED_MPS, "the fastest through a right turn"),
            _ => (LEFT_TURN_SPEED_MPS, "the fastest through a left turn"),
        };
        if found.0 < limit.0 {
            limit = found;
        }
    }
    limit
}

/// The ego's speed.
pub(super) fn ego(draft: &ScenarioDraft, network: &RoadNetwork, ego: &Placement, remarks: &mut Remarks) {
    let (limit, why) = speed_limit(network, &ego.path);
    // Of a network the numbers say how much it may want.
    let limit = if limit == MAX_SPEED_MPS && network.map.network().is_some() { MAX_WANTED_MPS } else { limit };
    if draft.ego.target_speed_mps > limit {
        let message =
            format!("the ego wants {} m/s on a way that allows {}", shown(draft.ego.target_speed_mps), shown(limit));
        remarks.error("scenario.speed", "ego.target_speed_mps", message, hint(limit, why));
    }
}

/// A partner's speeds, and room for its lateral moves.
pub(super) fn partner(
    draft: &ScenarioDraft,
    partner: &Partner,
    path: &str,
    network: &RoadNetwork,
    placement: &Placement,
    remarks: &mut Remarks,
) {
    let (limit, why) = speed_limit(network, &placement.path);
    let target = partner.policy.target_speed();
    if target > limit {
        let message = format!("the partner wants {} m/s on a way that allows {}", shown(target), shown(limit));
        remarks.error("scenario.speed", target_path(partner, path), message, hint(limit, why));
    }
    let shared = draft.map.carriageway();
    let lane = f64::from(network.lane(placement.path.segments[0].lane).index);
    let lanes_right = f64::from(shared.lanes) - 1.0 - lane;
    let half_width = 0.5 * VehicleSpec::of(partner.kind).width_m;
    let right_edge = (lanes_right + 0.5) * shared.lane_width_m;
    let left_edge = (lane + 0.5 + f64::from(shared.lanes)) * shared.lane_width_m;
    let mut offset = |at: String, t: f64| {
        if t.is_finite() && (t + half_width > right_edge || -t + half_width > left_edge) {
            let message = format!("at {} m from its lane's centre it leaves the road", shown(t));
            let hint = format!(
                "its box stays on the road from {} to {} m",
                shown(half_width - left_edge),
                shown(right_edge - half_width)
            );
            remarks.warn("scenario.leaves-road", at, message, hint);
        }
    };
    if let Start::Offset { delta_t_m, .. } = partner.start {
        offset(format!("{path}.start.delta_t_m"), delta_t_m);
    }
    for (position, step) in partner.lateral.iter().enumerate() {
        offset(format!("{path}.lateral[{position}].to_t_m"), step.to_t_m);
    }
}

/// What can be said about a partner's script without its place.
pub(super) fn script(draft: &ScenarioDraft, partner: &Partner, path: &str, remarks: &mut Remarks) {
    let standing = matches!(partner.policy, Policy::Stopped { .. });
    if standing && partner.speed_mps > 0.0 {
        let message = format!("a stopped partner cannot start at {} m/s", shown(partner.speed_mps));
        remarks.error(
            "scenario.stopped-speed",
            format!("{path}.speed_mps"),
            message,
            "allowed: 0 with policy \"stopped\"",
        );
    }
    if partner.kind == PartnerKind::FixedObject && !matches!(partner.policy, Policy::Stopped { depart_step: None, .. })
    {
        let message = "a fixed object cannot move";
        let hint = "allowed: policy {\"type\": \"stopped\"} without depart_step; or make it an obstacle";
        remarks.error("scenario.kind", format!("{path}.policy"), message, hint);
    } else {
        let fastest = VehicleSpec::of(partner.kind).max_speed_mps;
        let why = "the fastest this kind of road user moves";
        if partner.speed_mps > fastest && !standing {
            let message = format!("speed_mps is {}, too fast for its kind", shown(partner.speed_mps));
            remarks.error("scenario.speed", format!("{path}.speed_mps"), message, hint(fastest, why));
        }
        let target = partner.policy.target_speed();
        if target > fastest {
            let message = format!("the partner wants {} m/s, too fast for its kind", shown(target));
            remarks.error("scenario.speed", target_path(partner, path), message, hint(fastest, why));
        }
    }
    lateral(draft, partner, path, remarks);
}

/// Lateral moves follow each other, and stay within a lane and a half.
fn lateral(draft: &ScenarioDraft, partner: &Partner, path: &str, remarks: &mut Remarks) {
    let bound = LATERAL_LANES * draft.map.carriageway().lane_width_m;
    let mut beyond = |at: String, t: f64| {
        // NaN and the wildly large were told with their range.
        if t.abs() > bound && t.abs() <= 10.0 {
            let message = format!("{} m is more than a lane and a half from the centre of its lane", shown(t));
            let hint =
                format!("allowed: {} to {} m; or start it in another lane (lane_offset)", shown(-bound), shown(bound));
            remarks.error("scenario.lateral-range", at, message, hint);
        }
    };
    if let Start::Offset { delta_t_m, .. } = partner.start {
        beyond(format!("{path}.start.delta_t_m"), delta_t_m);
    }
    for (position, step) in partner.lateral.iter().enumerate() {
        beyond(format!("{path}.lateral[{position}].to_t_m"), step.to_t_m);
    }
    for (position, pair) in partner.lateral.windows(2).enumerate() {
        let end = pair[0].start_s + pair[0].duration_s;
        if pair[1].start_s < end - 1e-9 {
            let message = format!("it begins at {} s, before the move before it ends", shown(pair[1].start_s));
            let at = format!("{path}.lateral[{}].start_s", position + 1);
            remarks.error("scenario.lateral-order", at, message, format!("allowed: {} s or later", shown(end)));
        }
    }
    if partner.kind == PartnerKind::FixedObject && !partner.lateral.is_empty() {
        let hint = "leave out its lateral moves";
        remarks.error("scenario.kind", format!("{path}.lateral"), "a fixed object cannot move", hint);
    }
}

fn hint(limit: f64, why: &str) -> String {
    format!("allowed: up to {} m/s ({why})", shown((limit * 1000.0).floor() / 1000.0))
}

/// Where a policy keeps the speed it wants.
fn target_path(partner: &Partner, path: &str) -> String {
    let field = match partner.policy {
        Policy::SuddenBrake { .. } => "target_speed",
        Policy::AccelThenBrake { .. } => "cruise_speed",
        Policy::IdmNominal { .. } | Policy::Stopped { .. } | Policy::Yielding { .. } => "target_speed_mps",
    };
    format!("{path}.policy.{field}")
}
