//! Obstacles: where they lie, and whether they leave a way through.

use super::remarks::{Remarks, shown};
use crate::lane::LaneId;
use crate::network::RoadNetwork;
use crate::scenario::{ObstaclePlacement, Placement};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::PlacedObstacle;
use recrash_model::scenario::{ObjectSpec, Obstacle, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;

/// Free space beside a car that drives past an obstacle, on both sides together. [m]
const PASSING_CLEARANCE_M: f64 = 0.3;

/// An obstacle's place in the world.
pub(super) fn place(
    obstacle: &Obstacle,
    position: usize,
    network: &RoadNetwork,
    ego: &Placement,
    remarks: &mut Remarks,
) -> Option<ObstaclePlacement> {
    if obstacle.s_m > ego.path.length_m {
        let message = format!("it lies {} m behind the end of the ego's way", shown(obstacle.s_m - ego.path.length_m));
        let hint = format!("allowed: s_m from 0 to {} m", shown((ego.path.length_m * 1000.0).floor() / 1000.0));
        remarks.error("scenario.obstacle-place", format!("obstacles[{position}].s_m"), message, hint);
        return None;
    }
    let pose = ego.path.pose(obstacle.s_m, obstacle.t_m);
    let (length_m, width_m) = obstacle.kind.size_m();
    let lane = network.lane_at(pose.position, pose.heading).unwrap_or_else(|| nearest_lane(network, pose.position));
    Some(ObstaclePlacement { placed: PlacedObstacle { kind: obstacle.kind, pose, length_m, width_m }, lane })
}

/// A thing's place in the world.
pub(super) fn place_object(
    object: &ObjectSpec,
    position: usize,
    network: &RoadNetwork,
    remarks: &mut Remarks,
) -> Option<ObstaclePlacement> {
    let pose = match network.place(&object.at) {
        Ok(placed) => placed.pose,
        Err(error) => {
            remarks.error("scenario.place", format!("objects[{position}].at"), error.message, error.hint);
            return None;
        }
    };
    let (length_m, width_m) = object.size.map_or(object.kind.size_m(), |size| (size.length_m, size.width_m));
    let lane = network.lane_at(pose.position, pose.heading).unwrap_or_else(|| nearest_lane(network, pose.position));
    Some(ObstaclePlacement { placed: PlacedObstacle { kind: object.kind, pose, length_m, width_m }, lane })
}

/// The lane whose centre line passes nearest to a point beside the road.
fn nearest_lane(network: &RoadNetwork, point: Vec2) -> LaneId {
    let mut best = (f64::INFINITY, 0);
    for (position, lane) in network.lanes.iter().enumerate() {
        let (s, _) = lane.local(point);
        let distance = lane.position(s.clamp(0.0, lane.length_m), 0.0).distance(point);
        if distance < best.0 {
            best = (distance, position);
        }
    }
    LaneId(u16::try_from(best.1).unwrap_or(0))
}

/// What an obstacle takes of the ego's carriageway, to the right of the ego's lane's centre. [m]
struct Taken {
    position: usize,
    s: f64,
    from: f64,
    to: f64,
}

/// Obstacles leave a way through: an error where in no lane of the ego's carriageway a car gets past, a warning where
/// the middle of the ego's own lane is blocked.
pub(super) fn way_through(draft: &ScenarioDraft, placed: &[Option<ObstaclePlacement>], remarks: &mut Remarks) {
    let shared = draft.map.carriageway();
    let car = VehicleSpec::of(PartnerKind::PassengerCar);
    let needed = car.width_m + PASSING_CLEARANCE_M;
    let taken: Vec<Taken> = placed
        .iter()
        .enumerate()
        .filter(|(_, obstacle)| obstacle.is_some())
        .map(|(position, _)| {
            let obstacle = &draft.obstacles[position];
            let half = 0.5 * obstacle.kind.size_m().1;
            Taken { position, s: obstacle.s_m, from: obstacle.t_m - half, to: obstacle.t_m + half }
        })
        .collect();
    let mut told_until = f64::NEG_INFINITY;
    for first in by_distance(&taken) {
        if first.s <= told_until {
            continue;
        }
        // What lies within a car's length is one row: there is no room to steer between.
        let mut row: Vec<&Taken> =
            taken.iter().filter(|each| each.s >= first.s && each.s <= first.s + car.length_m).collect();
        row.sort_by(|a, b| a.from.total_cmp(&b.from));
        let widest = (0..shared.lanes)
            .map(|lane| {
                let middle = (f64::from(lane) - f64::from(draft.ego.lane)) * shared.lane_width_m;
                widest_gap(&row, middle - 0.5 * shared.lane_width_m, middle + 0.5 * shared.lane_width_m)
            })
            .fold(0.0, f64::max);
        let blocking = row.iter().find(|each| blocks_own_lane(each, car.width_m));
        if widest < needed {
            let message = format!(
                "at {} m every lane of the ego's carriageway is blocked: the widest gap in one is {} m",
                shown(first.s),
                shown(widest)
            );
            let hint = format!(
                "allowed: in one lane a gap of {} m or more, or rows more than {} m apart",
                shown(needed),
                shown(car.length_m)
            );
            remarks.error("scenario.blocked", format!("obstacles[{}]", first.position), message, hint);
            told_until = first.s + car.length_m;
        } else if let Some(blocking) = blocking {
            let message =
                format!("at {} m the ego's lane is blocked; it must stop or leave its lane", shown(blocking.s));
            let hint = format!(
                "it leaves the lane free when its middle lies more than {} m to one side",
                shown(0.5 * car.width_m + 0.5 * (blocking.to - blocking.from))
            );
            remarks.warn("scenario.lane-blocked", format!("obstacles[{}]", blocking.position), message, hint);
            told_until = first.s + car.length_m;
        }
    }
}

/// The widest free gap between two edges of a lane; `row` is ordered by its left edges. [m]
fn widest_gap(row: &[&Taken], left: f64, right: f64) -> f64 {
    let mut free_from = left;
    let mut widest: f64 = 0.0;
    for each in row {
        widest = widest.max(each.from.min(right) - free_from);
        free_from = free_from.max(each.to);
    }
    widest.max(right - free_from)
}

fn blocks_own_lane(taken: &Taken, car_width_m: f64) -> bool {
    taken.from < 0.5 * car_width_m && taken.to > -0.5 * car_width_m
}

fn by_distance(taken: &[Taken]) -> Vec<&Taken> {
    let mut ordered: Vec<&Taken> = taken.iter().collect();
    ordered.sort_by(|a, b| a.s.total_cmp(&b.s).then(a.position.cmp(&b.position)));
    ordered
}
