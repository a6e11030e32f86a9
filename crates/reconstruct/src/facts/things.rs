//! What the ego is told to have driven over or under, held against its way.

use crate::told::crash::Told;
use crate::told::lies::Lies;
use crate::told::zones::side_of;
use crate::usual::STANDS_MPS;
use recrash_model::account::{ContactState, Kind};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorTrack, STEP_S};
use recrash_model::zones::ContactZone;

/// What is so far inside the ego's outline is under it. [m]
const UNDER_M: f64 = 0.3;

/// What moves, and the ego drives over, comes under it within this way. [m]
const ONTO_M: f64 = 1.5;

/// Whether what lies on the road comes under the ego, clear of its edges, once it is touched; of an animal, or of what
/// fell off somebody, where it was then, as far as the ego's front comes over it at once: whoever is touched is pushed on, as nothing here has a
/// height.
pub(super) fn goes_under(
    told: &Told,
    ego: &ActorTrack,
    thing: Option<&ActorTrack>,
    touched: &OrientedBox,
    since: usize,
) -> bool {
    let body = |pose: Pose| OrientedBox::new(pose, ego.length_m - 2.0 * UNDER_M, ego.width_m - 2.0 * UNDER_M);
    if told.cp.kind == PartnerKind::Animal || told.dropped.is_some() {
        let met = &ego.states[since.min(ego.states.len() - 1)];
        let on = Vec2::from_heading(met.heading) * (met.speed().signum() * ONTO_M);
        let moves = met.velocity().length() > STANDS_MPS;
        return moves && body(Pose { position: met.position() + on, heading: met.heading }).overlaps(touched);
    }
    (since..ego.states.len()).any(|step| {
        let lying = thing.map_or(*touched, |track| track.outline(step.min(track.states.len() - 1)));
        body(ego.states[step].pose()).overlaps(&lying)
    })
}

/// Whether an ego that drives on is told to have been touched at its rear alone by a hole, or by what lies flat in its way.
fn passes_over(told: &Told) -> bool {
    let low = told.lies == Some(Lies::Hole) || told.thing == Some(Kind::Debris) && told.edge.is_none();
    low && told.sv.state == ContactState::Moving && told.sv.zones.iter().all(|zone| zone.is_rear())
}

/// Whether the told part of the ego's rear goes over what lies in its way, which its front has come over.
pub(super) fn rear_goes_over(told: &Told, ego: &ActorTrack, lying: &OrientedBox, since: usize) -> bool {
    let half_m = Vec2::new(0.5 * ego.length_m, 0.5 * ego.width_m);
    let over = |zone: &ContactZone, step: usize| {
        let left = match zone {
            ContactZone::RearLeft => 1.0,
            ContactZone::RearRight => -1.0,
            _ => 0.0,
        };
        let state = &ego.states[step];
        let (pose, on) = (state.pose(), state.velocity() * STEP_S);
        let along = Vec2::from_heading(pose.heading);
        let middle = pose.position - along * (0.75 * half_m.x) + along.left() * (left * half_m.y * 2.0 / 3.0);
        // As long as it comes until the next step.
        let part = Pose { position: middle + on * 0.5, ..pose };
        OrientedBox::new(part, 0.5 * half_m.x + on.length(), half_m.y * 2.0 / 3.0).overlaps(lying)
    };
    passes_over(told) && (since..ego.states.len()).any(|step| told.sv.zones.iter().any(|zone| over(zone, step)))
}

/// Nearer to the middle of the ego than this a hole is under no wheel; nor beside it by more. [m]
const WHEELS_M: (f64, f64) = (0.35, 1.3);

/// How what the ego drives over is told to lie, whether it does, and how it lies.
pub(super) fn check(told: &Told, ego: &OrientedBox, other: &OrientedBox) -> Option<(String, bool, String)> {
    let lies = told.lies?;
    let corners = other.corners().map(|corner| ego.to_local(corner).y);
    let least_m = corners.iter().copied().fold(f64::MAX, f64::min);
    let most_m = corners.iter().copied().fold(f64::MIN, f64::max);
    if lies.size().is_some() {
        let across = least_m < -ego.half_width && most_m > ego.half_width;
        let seen = format!("from {:.1} m to the right to {most_m:.1} m to the left", -least_m);
        return Some(("across the ego's way".to_owned(), across, seen));
    }
    let left_m = ego.to_local(other.centre).y;
    let there = (WHEELS_M.0..WHEELS_M.1).contains(&left_m.abs());
    let (side, of) = match side_of(&told.sv.zones) {
        Some(side) if side > 0.0 => (" on the left", left_m > 0.0),
        Some(_) => (" on the right", left_m < 0.0),
        None => ("", true),
    };
    Some((format!("under a wheel{side}"), there && of, format!("{left_m:.1} m to the left of the ego's middle")))
}
