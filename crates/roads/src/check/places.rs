//! Ways: which lanes each road user follows, and who stands in the way of whom at the start.

use super::names::{APPROACHES, TURNS, approach_name, map_name, turn_name};
use super::remarks::{Remarks, shown};
use super::starts::Entry;
use crate::network::RoadNetwork;
use crate::path::LanePath;
use crate::scenario::{ActorPlacement, ObstaclePlacement, Placement};
use recrash_model::geometry::OrientedBox;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Approach, Partner, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;

/// Free space between the boxes of two road users at the start, at least. [m]
const SPAWN_GAP_M: f64 = 0.5;

/// Free space between a road user's box and an obstacle at the start, at least. [m]
const OBSTACLE_SPAWN_GAP_M: f64 = 0.2;

/// The ego's placement.
pub(super) fn ego(draft: &ScenarioDraft, network: &RoadNetwork, remarks: &mut Remarks) -> Option<Placement> {
    let lanes = draft.map.carriageway().lanes;
    let lane_fits = draft.ego.lane < lanes;
    if !lane_fits {
        let message = format!("lane is {}, but the map has {lanes} in each direction", draft.ego.lane);
        remarks.error("scenario.lane", "ego.lane", message, format!("allowed: 0 (leftmost) to {}", lanes - 1));
    }
    let Some(route) = network.route(Approach::Same, draft.ego.turn) else {
        let turns = turns_of(network, Approach::Same);
        let message = format!("the ego cannot turn {} on {}", turn_name(draft.ego.turn), map_name(&draft.map));
        remarks.error("scenario.unreachable-turn", "ego.turn", message, format!("allowed: {turns}"));
        return None;
    };
    if !lane_fits {
        return None;
    }
    let path = LanePath::new(network, route, draft.ego.lane);
    let pose = path.pose(draft.ego.s_m, 0.0);
    Some(Placement {
        kind: draft.ego.kind,
        path,
        s_m: draft.ego.s_m,
        t_m: 0.0,
        pose,
        speed_mps: draft.ego.speed_mps,
        conflict: None,
    })
}

/// The ego's placement on a network of roads.
pub(super) fn ego_on_roads(
    draft: &ScenarioDraft,
    network: &RoadNetwork,
    recorded: Option<&ActorPlacement>,
    remarks: &mut Remarks,
) -> Option<Placement> {
    let ego = &draft.ego;
    let refuse = |remarks: &mut Remarks, code: &str, path: &str, message: &str, hint: &str| {
        remarks.error(code, path, message, hint);
    };
    if !draft.partners.is_empty() {
        let hint = "write them as actors, with a plan";
        refuse(remarks, "scenario.map-form", "partners", "partners with a policy drive on the paper's maps only", hint);
    }
    if !draft.obstacles.is_empty() {
        let hint = "write them as objects, with a place";
        refuse(remarks, "scenario.map-form", "obstacles", "obstacles lie beside a block's way only", hint);
    }
    if draft.traffic.density > 0.0 {
        let hint = "leave traffic out, or use actors";
        refuse(
            remarks,
            "scenario.map-form",
            "traffic.density",
            "background traffic drives on the paper's maps only",
            hint,
        );
    }
    if ego.route.is_empty() {
        let hint = "name the roads it takes, with direction, from the one it starts on: [\"west-\", \"east+\"]";
        refuse(remarks, "scenario.missing-field", "ego.route", "on a network of roads the ego has a route", hint);
        return None;
    }
    let path = match network.way(&ego.route, ego.lane, None) {
        Ok(path) => path,
        Err(error) => {
            remarks.error("scenario.way", "ego.route", error.message, error.hint);
            return None;
        }
    };
    if recorded.is_none() && ego.s_m > path.length_m {
        let message = format!("it starts {} m behind the end of its route", shown(ego.s_m - path.length_m));
        remarks.error("scenario.place", "ego.s_m", message, format!("allowed: 0 to {} m", shown(path.length_m)));
        return None;
    }
    let pose = path.pose(ego.s_m, 0.0);
    let (kind, s_m, speed_mps) = (ego.kind, ego.s_m, ego.speed_mps);
    Some(Placement { kind, path, s_m, t_m: 0.0, pose, speed_mps, conflict: None })
}

/// A partner's placement, where it has one.
pub(super) fn partner(
    draft: &ScenarioDraft,
    partner: &Partner,
    path: &str,
    network: &RoadNetwork,
    ego: &Placement,
    remarks: &mut Remarks,
) -> Option<Placement> {
    let lanes = draft.map.carriageway().lanes;
    let number = i16::from(draft.ego.lane) + i16::from(partner.lane_offset);
    let lane = u8::try_from(number).ok().filter(|lane| *lane < lanes);
    if lane.is_none() {
        let message = format!(
            "lane_offset {} from the ego's lane {} is lane {number}, but the map has {lanes} in each direction",
            partner.lane_offset, draft.ego.lane
        );
        let (least, most) = (-i16::from(draft.ego.lane), i16::from(lanes) - 1 - i16::from(draft.ego.lane));
        remarks.error(
            "scenario.lane",
            format!("{path}.lane_offset"),
            message,
            format!("allowed: {least} to {most} (negative is left of the ego's lane)"),
        );
    }
    let Some(route) = network.route(partner.approach, partner.turn) else {
        unreachable_way(draft, partner, path, network, remarks);
        return None;
    };
    let way = LanePath::new(network, route, lane?);
    let width = VehicleSpec::of(PartnerKind::PassengerCar).width_m;
    let conflict = ego.path.conflict(&way, width, VehicleSpec::of(partner.kind).width_m);
    let (s_m, t_m) = Entry { draft, partner, path, network, ego, way: &way }.start(conflict.as_ref(), remarks)?;
    let pose = way.pose(s_m, t_m);
    let speed_mps = partner.speed_mps;
    Some(Placement { kind: partner.kind, path: way, s_m, t_m, pose, speed_mps, conflict })
}

/// Road users and obstacles may not overlap at the start.
pub(super) fn overlaps(
    draft: &ScenarioDraft,
    ego: &Placement,
    partners: &[Option<Placement>],
    obstacles: &[Option<ObstaclePlacement>],
    remarks: &mut Remarks,
) {
    let outline = |placement: &Placement| {
        let size = VehicleSpec::of(placement.kind);
        OrientedBox::new(placement.pose, size.length_m, size.width_m)
    };
    let mut placed = vec![("the ego".to_owned(), "ego".to_owned(), outline(ego))];
    for (position, partner) in partners.iter().enumerate() {
        let Some(partner) = partner else { continue };
        let path = format!("partners[{position}]");
        let own = outline(partner);
        for (name, _, other) in &placed {
            let gap = own.gap(other);
            if gap < SPAWN_GAP_M {
                let message = if own.overlaps(other) {
                    format!("it starts on top of {name}")
                } else {
                    format!("it starts {} m beside {name}", shown(gap))
                };
                let hint = format!(
                    "allowed: {SPAWN_GAP_M} m or more between the boxes; move it along the road, or into another lane"
                );
                remarks.error("scenario.spawn-overlap", format!("{path}.start"), message, hint);
            }
        }
        let id: String = draft.partners[position].id.chars().take(32).collect();
        placed.push((format!("partner {id:?}"), path, own));
    }
    for (position, obstacle) in obstacles.iter().enumerate() {
        let Some(obstacle) = obstacle else { continue };
        for (name, _, other) in &placed {
            if obstacle.placed.outline().gap(other) < OBSTACLE_SPAWN_GAP_M {
                let message = format!("it lies where {name} starts");
                let hint = format!("allowed: {OBSTACLE_SPAWN_GAP_M} m or more away from every road user's box");
                remarks.error("scenario.obstacle-on-spawn", format!("obstacles[{position}]"), message, hint);
            }
        }
    }
}

fn unreachable_way(draft: &ScenarioDraft, partner: &Partner, path: &str, network: &RoadNetwork, remarks: &mut Remarks) {
    let turns = turns_of(network, partner.approach);
    if turns.is_empty() {
        let ways: Vec<String> = APPROACHES
            .iter()
            .filter(|(approach, _)| !turns_of(network, *approach).is_empty())
            .map(|(_, name)| format!("\"{name}\""))
            .collect();
        let message =
            format!("nobody can come from \"{}\" on {}", approach_name(partner.approach), map_name(&draft.map));
        let mut hint = format!("allowed: {}", ways.join(", "));
        if partner.kind == PartnerKind::Pedestrian {
            hint.push_str("; someone who crosses a road without a junction is approach \"same\" with a lateral move");
        }
        remarks.error("scenario.unreachable-turn", format!("{path}.approach"), message, hint);
    } else {
        let message = format!(
            "a partner from \"{}\" cannot turn {} on {}",
            approach_name(partner.approach),
            turn_name(partner.turn),
            map_name(&draft.map)
        );
        remarks.error("scenario.unreachable-turn", format!("{path}.turn"), message, format!("allowed: {turns}"));
    }
}

/// The turns that exist from an approach, for a message.
fn turns_of(network: &RoadNetwork, approach: Approach) -> String {
    let found: Vec<&str> =
        TURNS.iter().filter(|(turn, _)| network.route(approach, *turn).is_some()).map(|(_, name)| *name).collect();
    found.join(", ")
}
