//! Ways and starts: which lanes each road user follows, and where on them it begins.

use super::remarks::{Remarks, shown};
use crate::conflict::Conflict;
use crate::network::{RoadNetwork, RoadPart};
use crate::path::LanePath;
use crate::scenario::{ActorPlacement, ObstaclePlacement, Placement};
use recrash_model::geometry::OrientedBox;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Approach, MapKind, MapSpec, Partner, ScenarioDraft, Start, Turn};
use recrash_model::vehicle::VehicleSpec;

/// Free space between the boxes of two road users at the start, at least. [m]
const SPAWN_GAP_M: f64 = 0.5;

/// Free space between a road user's box and an obstacle at the start, at least. [m]
const OBSTACLE_SPAWN_GAP_M: f64 = 0.2;

/// Somebody on foot may start this far from where its way meets the ego's: beside the ego's lane. [m]
const STEP_OUT_M: f64 = 3.0;

/// Room in a bend is looked for in steps of this, up to so many of them. [m]
const ROOM_STEP_M: f64 = 0.05;
const MOST_ROOM_STEPS: u32 = 20;

/// The longest arm a map may have. [m]
const LONGEST_ARM_M: f64 = 300.0;

/// Every approach and its name in a scenario file.
const APPROACHES: [(Approach, &str); 5] = [
    (Approach::Same, "same"),
    (Approach::Opposite, "opposite"),
    (Approach::Left, "left"),
    (Approach::Right, "right"),
    (Approach::Ring, "ring"),
];

/// Every turn and its name in a scenario file.
const TURNS: [(Turn, &str); 3] = [(Turn::Straight, "straight"), (Turn::Left, "left"), (Turn::Right, "right")];

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
    let (s_m, t_m) = match partner.start {
        Start::Offset { delta_s_m, delta_t_m } => {
            (offset_start(draft, partner, path, network, ego, &way, delta_s_m, remarks)?, delta_t_m)
        }
        Start::ArrivalGap { arrival_gap_s } => {
            let s = timed_start(draft, partner, path, network, ego, &way, conflict, arrival_gap_s, remarks)?;
            (s, room_in_bend(network, &way, partner.kind, s))
        }
    };
    let pose = way.pose(s_m, t_m);
    let speed_mps = partner.speed_mps;
    Some(Placement { kind: partner.kind, path: way, s_m, t_m, pose, speed_mps, conflict })
}

/// The first place on its way at which the whole of a road user stands on the road: half of its length, where the way
/// begins at the end of a road. [m]
fn first_place(network: &RoadNetwork, way: &LanePath, kind: PartnerKind) -> f64 {
    let half_m = 0.5 * VehicleSpec::of(kind).length_m;
    if network.on_road(way.pose(-half_m, 0.0).position) { 0.0 } else { half_m }
}

/// How far to the right of its lane's centre a road user starts that comes along a bend: as little to the inside as keeps
/// all of its corners on the road. A long one needs that at the outer edge. [m]
fn room_in_bend(network: &RoadNetwork, way: &LanePath, kind: PartnerKind, s: f64) -> f64 {
    let spec = VehicleSpec::of(kind);
    let inside = -way.curvature(s).signum();
    let fits = |t: f64| {
        let corners = OrientedBox::new(way.pose(s, t), spec.length_m, spec.width_m).corners();
        corners.into_iter().all(|corner| network.on_road(corner))
    };
    if way.curvature(s) == 0.0 {
        return 0.0;
    }
    let steps = (0..=MOST_ROOM_STEPS).map(|step| inside * ROOM_STEP_M * f64::from(step));
    steps.into_iter().find(|t| fits(*t)).unwrap_or(0.0)
}

/// The start of a partner given relative to the ego.
#[allow(clippy::too_many_arguments, reason = "the parts of one check, used once")]
fn offset_start(
    draft: &ScenarioDraft,
    partner: &Partner,
    path: &str,
    network: &RoadNetwork,
    ego: &Placement,
    way: &LanePath,
    delta_s_m: f64,
    remarks: &mut Remarks,
) -> Option<f64> {
    let at = format!("{path}.start.delta_s_m");
    let along = draft.ego.s_m + delta_s_m;
    let (s, last) = match partner.approach {
        Approach::Same => {
            // Lanes of one approach are equally long; behind it, beside the ego's own way, as far as that is the same.
            let beside = along > draft.map.carriageway().approach_m && way.roads == ego.path.roads;
            let s = if beside && along <= ego.path.length_m {
                way.project(ego.path.pose(along, 0.0).position, 0).s
            } else {
                along
            };
            (s, way.length_m)
        }
        Approach::Opposite => {
            if draft.map.kind() == MapKind::Road {
                let beside = ego.path.pose(along, 0.0).position;
                (way.project(beside, 0).s, way.length_m)
            } else {
                // The arm ahead lies in line with the approach: there the distance is that along the x axis.
                (way.pose(0.0, 0.0).position.x - along, arm_length(network, way))
            }
        }
        Approach::Left | Approach::Right | Approach::Ring => {
            let message = format!(
                "delta_s_m counts along the ego's own road, but the partner comes from \"{}\"",
                approach_name(partner.approach)
            );
            let hint = "use start: {\"arrival_gap_s\": seconds} (0 is a collision course), \
                        or approach \"same\" or \"opposite\"";
            remarks.error("scenario.start-form", format!("{path}.start"), message, hint);
            return None;
        }
    };
    let first = first_place(network, way, partner.kind);
    // A hair outside is rounding.
    if s < first - 1e-9 || s > last + 1e-9 {
        let (least, most) = match partner.approach {
            Approach::Opposite => (delta_s_m + s - last, delta_s_m + s - first),
            _ => (delta_s_m - s + first, delta_s_m - s + last),
        };
        let message = format!(
            "{} m {} the ego is no place on the partner's way",
            shown(delta_s_m.abs()),
            if delta_s_m < 0.0 { "behind" } else { "ahead of" }
        );
        let (least, most) = (shown(round_up(least)), shown(round_down(most)));
        let hint = format!("allowed: delta_s_m from {least} to {most} m, or a longer map");
        remarks.error("scenario.start-off-road", at, message, hint);
        return None;
    }
    Some(s.clamp(first, last))
}

/// The start of a partner given by when it reaches the conflict.
#[allow(clippy::too_many_arguments, reason = "the parts of one check, used once")]
fn timed_start(
    draft: &ScenarioDraft,
    partner: &Partner,
    path: &str,
    network: &RoadNetwork,
    ego: &Placement,
    way: &LanePath,
    conflict: Option<Conflict>,
    arrival_gap_s: f64,
    remarks: &mut Remarks,
) -> Option<f64> {
    let at = format!("{path}.start.arrival_gap_s");
    let Some(conflict) = conflict else {
        let message = format!(
            "the way of a partner from \"{}\" turning {} never meets the ego's ({}), so there is no arrival to time",
            approach_name(partner.approach),
            turn_name(partner.turn),
            turn_name(draft.ego.turn)
        );
        let hint = match partner.approach {
            Approach::Same | Approach::Opposite => {
                "use start: {\"delta_s_m\", \"delta_t_m\"} relative to the ego, or another turn".to_owned()
            }
            _ => format!(
                "choose a turn that crosses the ego's way or merges with it; these do: {}",
                meeting_turns(partner, network, ego)
            ),
        };
        remarks.error("scenario.no-conflict", at, message, hint);
        return None;
    };
    let target = partner.policy.target_speed();
    if target < 0.1 {
        let message = "the partner wants to stand still, so it never arrives";
        let hint = "give the policy a target speed, or place the partner with delta_s_m";
        remarks.error("scenario.no-arrival", at, message, hint);
        return None;
    }
    let ego_time = (conflict.s_a - draft.ego.s_m) / draft.ego.target_speed_mps;
    if ego_time <= 0.0 {
        let message =
            format!("the ego starts {} m behind the place of the conflict", shown(draft.ego.s_m - conflict.s_a));
        remarks.error(
            "scenario.no-arrival",
            "ego.s_m",
            message,
            format!("allowed: ego.s_m below {} m", shown(conflict.s_a)),
        );
        return None;
    }
    let s = conflict.s_b - target * (ego_time + arrival_gap_s);
    let arm = match partner.kind {
        // People and animals step onto the road anywhere: for them the arm ends right beside the ego's lane.
        PartnerKind::Pedestrian | PartnerKind::OtherNonMotorist | PartnerKind::Animal => conflict.s_b - STEP_OUT_M,
        _ => arm_length(network, way).min(conflict.s_b),
    };
    let first = first_place(network, way, partner.kind).min(arm);
    if (first..=arm).contains(&s) {
        return Some(s);
    }
    let earliest = (conflict.s_b - arm) / target - ego_time;
    let latest = (conflict.s_b - first) / target - ego_time;
    let message = format!(
        "to reach the conflict {} s {} the ego (which needs {} s) at {} m/s, the partner would have to start {}",
        shown(arrival_gap_s.abs()),
        if arrival_gap_s < 0.0 { "before" } else { "after" },
        shown(ego_time),
        shown(target),
        if s < first {
            format!("{} m before the first place on its arm that has room for all of it", shown(first - s))
        } else {
            format!("{} m behind the end of its arm", shown(s - arm))
        }
    );
    let mut hint =
        format!("allowed: arrival_gap_s from {} to {} s", shown(round_up(earliest)), shown(round_down(latest)));
    if s < first {
        let length = match (&draft.map, partner.approach) {
            (MapSpec::X(m), Approach::Left | Approach::Right | Approach::Opposite) => Some(m.arm_m),
            (MapSpec::T(m), Approach::Left | Approach::Right | Approach::Opposite) => Some(m.arm_m),
            (MapSpec::O(m), Approach::Left | Approach::Right | Approach::Opposite) => Some(m.arm_m),
            _ => None,
        };
        match length.map(|arm_m| (arm_m + first - s).ceil()) {
            Some(needed) if needed <= LONGEST_ARM_M => hint.push_str(&format!(", or map.arm_m of {} m", shown(needed))),
            _ => hint.push_str(", or a slower partner, or an ego that starts nearer to the conflict"),
        }
    } else {
        hint.push_str(", or a faster partner, or an ego that starts farther from the conflict");
    }
    remarks.error("scenario.arrival-gap", at, message, hint);
    None
}

/// Three decimals upwards, so that the number in a hint is itself allowed.
fn round_up(value: f64) -> f64 {
    (value * 1000.0).ceil() / 1000.0
}

/// Three decimals downwards.
fn round_down(value: f64) -> f64 {
    (value * 1000.0).floor() / 1000.0
}

/// Length of the part of a way on which a partner may start: its arm, on the ring up to the ego's entry, on a road
/// without a junction all of it. [m]
fn arm_length(network: &RoadNetwork, way: &LanePath) -> f64 {
    if network.map.kind() == MapKind::Road {
        return way.length_m;
    }
    let on_ring = network.road(way.roads[0]).part == RoadPart::Ring;
    let leaves = |position: usize| {
        let road = network.road(way.roads[position]);
        if on_ring { road.from == "1O0_0_" } else { !matches!(road.part, RoadPart::Approach | RoadPart::ArmIn) }
    };
    (0..way.roads.len()).find(|position| leaves(*position)).map_or(way.length_m, |end| way.segments[end].start_m)
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

/// The turns of a partner whose way meets the ego's, for a message.
fn meeting_turns(partner: &Partner, network: &RoadNetwork, ego: &Placement) -> String {
    let width = VehicleSpec::of(PartnerKind::PassengerCar).width_m;
    let other_width = VehicleSpec::of(partner.kind).width_m;
    let meets = |turn: Turn| {
        let route = network.route(partner.approach, turn)?;
        let lanes = network.road(route[0]).lanes.len();
        (0..lanes).find(|lane| {
            let lane = u8::try_from(*lane).unwrap_or(0);
            ego.path.conflict(&LanePath::new(network, route.clone(), lane), width, other_width).is_some()
        })
    };
    let found: Vec<&str> = TURNS.iter().filter(|(turn, _)| meets(*turn).is_some()).map(|(_, name)| *name).collect();
    if found.is_empty() { "none from there".to_owned() } else { found.join(", ") }
}

fn approach_name(approach: Approach) -> &'static str {
    APPROACHES.iter().find(|(each, _)| *each == approach).map_or("", |(_, name)| name)
}

fn turn_name(turn: Turn) -> &'static str {
    TURNS.iter().find(|(each, _)| *each == turn).map_or("", |(_, name)| name)
}

fn map_name(map: &MapSpec) -> &'static str {
    match map {
        MapSpec::S(_) => "a straight road (map S)",
        MapSpec::C(_) => "a curve (map C)",
        MapSpec::X(_) => "a four-way intersection (map X)",
        MapSpec::T(_) => "this three-way intersection (map T)",
        MapSpec::O(_) => "a roundabout (map O)",
        MapSpec::G(_) => "a network of roads (map G)",
    }
}
