//! The line a partner drives through bends, as a trajectory without times: where it is, and not when.

use super::Context;
use super::driven::{Driven, corners};
use super::places::{reference_to_centre, start_along, world_position};
use crate::xml::Element;
use recrash_model::geometry::Pose;
use recrash_model::math::wrap_angle;
use recrash_model::scenario::Start;
use recrash_model::vehicle::VehicleSpec;

/// The polyline stays this near to the line, and so do the ends of a vehicle on it. [m]
const TOLERANCE_M: f64 = 0.005;

/// Points of the line where nothing was driven. [m]
const SPACING_M: f64 = 1.0;

/// Follows the line that was driven, for a partner that keeps to its way through a bend: its tyres take it off the lane's
/// centre, by up to a metre if it is long. `None` where there is no bend, or where sideways moves say more.
pub(super) fn line(context: &Context<'_>, position: usize, driven: &Driven, name: &str) -> Option<Element> {
    let partner = &context.scenario.draft().partners[position];
    let placement = &context.scenario.partners()[position];
    let keeps_to_its_way = matches!(partner.start, Start::ArrivalGap { .. }) && partner.lateral.is_empty();
    let off_centre = driven.places.iter().any(|place| place.t.abs() > TOLERANCE_M);
    if !keeps_to_its_way || !off_centre {
        return None;
    }
    // From the beginning of the way, so that a start may be moved along it, to its end.
    let path = &placement.path;
    let (first_s, last_s) = (driven.places[0].s, driven.places[driven.places.len() - 1].s);
    let stations = |from: f64, to: f64| {
        let count = ((to - from) / SPACING_M).max(0.0) as usize;
        (0..=count).map(move |step| path.pose(from + step as f64 * SPACING_M, 0.0))
    };
    let mut poses: Vec<Pose> = Vec::new();
    if first_s > SPACING_M {
        poses.extend(stations(0.0, first_s - SPACING_M));
    }
    poses.extend(&driven.poses);
    poses.extend(stations(last_s + 2.0 * SPACING_M, path.length_m));
    let vertices = simplified(&poses, 0.5 * VehicleSpec::of(partner.kind).length_m);
    let offset = start_along(context, position, -reference_to_centre(partner.kind));
    let vertices = vertices.into_iter().map(|pose| Element::new("Vertex").child(world_position(pose)));
    let shape = Element::new("Shape").child(Element::new("Polyline").children(vertices));
    Some(Element::new("PrivateAction").child(Element::new("RoutingAction").child(
        Element::new("FollowTrajectoryAction").with("initialDistanceOffset", offset).children([
            Element::new("Trajectory").with("name", name).with("closed", "false").child(shape),
            Element::new("TimeReference").child(Element::new("None")),
            Element::new("TrajectoryFollowingMode").with("followingMode", "position"),
        ]),
    )))
}

/// The poses that straight lines between them need; the ends of a vehicle reach `reach_m` from them.
fn simplified(poses: &[Pose], reach_m: f64) -> Vec<Pose> {
    let mut apart: Vec<Pose> = Vec::new();
    for pose in poses {
        if apart.last().is_none_or(|last| last.position.distance(pose.position) > TOLERANCE_M) {
            apart.push(*pose);
        }
    }
    let mut along = vec![0.0];
    for pair in apart.windows(2) {
        along.push(along[along.len() - 1] + pair[0].position.distance(pair[1].position));
    }
    let off = |first: usize, at: usize, last: usize| {
        let share = (along[at] - along[first]) / (along[last] - along[first]);
        let (a, b) = (apart[first], apart[last]);
        let position = a.position + (b.position - a.position) * share;
        let heading = a.heading + wrap_angle(b.heading - a.heading) * share;
        let turned = wrap_angle(heading - apart[at].heading).abs() * reach_m;
        let off = position.distance(apart[at].position).max(turned);
        (off, off / TOLERANCE_M)
    };
    let last = apart.len() - 1;
    let kept = [0].into_iter().chain(corners(0, last, &off)).chain([last]);
    kept.map(|position| apart[position]).collect()
}
