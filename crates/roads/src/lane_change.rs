//! Changes of lanes on a path: an S of two arcs from one lane to the one beside it.

use crate::curve::biarc;
use crate::lane::{Lane, LaneId};
use crate::network::{RoadNetwork, RoadPart};
use recrash_model::geometry::Pose;

/// A change of lanes is done within this distance before and behind its middle, where there is room. [m]
pub(crate) const HALF_CHANGE_M: f64 = 15.0;

/// The lines of a path along lanes, with the lane each belongs to.
pub(crate) fn pieces(network: &RoadNetwork, lanes: &[LaneId]) -> Vec<(LaneId, Lane)> {
    let mut done: Vec<(LaneId, Lane)> = Vec::with_capacity(lanes.len());
    // What a change may use up, from behind: everything since the last change or connection.
    let mut usable_m = 0.0;
    let mut position = 0;
    while position < lanes.len() {
        let road = network.lane(lanes[position]).road;
        let beside = lanes[position..].iter().take_while(|lane| network.lane(**lane).road == road).count();
        let count = if repeats(&lanes[position..position + beside]) { 1 } else { beside };
        let share = |lane: &Lane, number: usize| lane.length_m * number as f64 / count as f64;
        for number in 0..count {
            let id = lanes[position + number];
            let lane = network.lane(id);
            let (from, to) = (share(lane, number), share(lane, number + 1));
            if number > 0 {
                // Half of the part in the new lane stays for the next change.
                let whole = 0.5 * if number + 1 < count { to - from } else { 2.0 * (to - from) };
                let ahead_m = HALF_CHANGE_M.min(whole).min(to - from);
                let behind_m = HALF_CHANGE_M.min(usable_m);
                change(&mut done, (id, lane.part(from, to)), behind_m, ahead_m);
                usable_m = to - from - ahead_m;
                continue;
            }
            if matches!(network.road(road).part, RoadPart::Inner | RoadPart::Ring) {
                usable_m = 0.0;
            } else {
                usable_m += to - from;
            }
            done.push((id, if count == 1 { *lane } else { lane.part(from, to) }));
        }
        position += count;
    }
    done
}

/// Whether a road is passed more than once in the same lane, rather than its lanes changed.
fn repeats(lanes: &[LaneId]) -> bool {
    lanes.windows(2).any(|pair| pair[0] == pair[1])
}

/// Goes over from the line so far to a part of another lane.
fn change(done: &mut Vec<(LaneId, Lane)>, (id, lane): (LaneId, Lane), behind_m: f64, ahead_m: f64) {
    let pose = |lane: &Lane, s: f64| Pose { position: lane.position(s, 0.0), heading: lane.heading(s) };
    let mut left_m = behind_m;
    let mut from = None;
    while let Some((last, geometry)) = done.pop() {
        if left_m < geometry.length_m - 1e-9 {
            let kept = geometry.part(0.0, geometry.length_m - left_m);
            from = Some((last, pose(&kept, kept.length_m), geometry));
            done.push((last, kept));
            break;
        }
        left_m -= geometry.length_m;
        from = Some((last, pose(&geometry, 0.0), geometry));
        if left_m <= 1e-9 {
            break;
        }
    }
    if let Some((before, start, geometry)) = from
        && let Some(arcs) = biarc(start, pose(&lane, ahead_m))
    {
        for (arc, (owner, of)) in arcs.iter().zip([(before, geometry), (id, lane)]) {
            let (width_m, end_width_m) = (of.width_m, of.end_width_m);
            let shape = Lane { centreline: arc.centreline(), length_m: arc.length_m, width_m, end_width_m, ..of };
            done.push((owner, shape));
        }
    }
    if lane.length_m - ahead_m > 1e-9 {
        done.push((id, lane.part(ahead_m, lane.length_m)));
    }
}
