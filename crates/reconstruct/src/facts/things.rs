//! What the ego is told to have driven over or under, held against its way.

use crate::told::crash::Told;
use crate::told::lies::Lies;
use crate::told::zones::side_of;
use recrash_model::account::{ContactState, Kind, LeftRight};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
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
        let met = ego.at(since);
        let on = Vec2::from_heading(met.heading) * (met.speed().signum() * ONTO_M);
        let moves = !met.stands();
        return moves && body(Pose { position: met.position() + on, heading: met.heading }).overlaps(touched);
    }
    (since..ego.states.len()).any(|step| {
        let lying = thing.map_or(*touched, |track| track.outline(track.within(step)));
        body(ego.states[step].pose()).overlaps(&lying)
    })
}

/// What comes off somebody is no farther behind it at first, and no farther beside it; and has come so far away from it. [m]
const OFF_M: f64 = 2.0;
const OFF_BESIDE_M: f64 = 1.6;
const AWAY_M: f64 = 3.0;

/// Whether a thing comes along right behind somebody, and is left behind by it.
pub(super) fn comes_off(thing: &ActorTrack, owner: &ActorTrack, until: usize) -> bool {
    let gap = |step: usize| {
        let at = |track: &ActorTrack| track.at(step).pose();
        let (own, lost) = (at(owner), at(thing));
        let (ahead, way) = (Vec2::from_heading(own.heading), own.position - lost.position);
        (ahead.dot(way) - 0.5 * (thing.length_m + owner.length_m), ahead.cross(way).abs() < OFF_BESIDE_M)
    };
    let [(first_m, behind), (last_m, still_behind)] = [0, until].map(gap);
    behind && still_behind && (0.0..OFF_M).contains(&first_m) && last_m > AWAY_M
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

/// What bars the ego's way is across it within this angle. [deg]
const ACROSS_DEG: f64 = 30.0;

/// Whether what bars the ego's way is across it.
fn bars(told: &Told, ego: &OrientedBox, other: &OrientedBox) -> Option<(String, bool, String)> {
    let along = other.half_length > other.half_width;
    let long = if along { other.axis } else { other.axis.left() };
    let off_deg = math::acos(long.dot(ego.axis.left()).abs().min(1.0)).to_degrees();
    let seen = format!("at {off_deg:.0} degrees to its front");
    told.lies_across().then(|| (ACROSS.to_owned(), off_deg <= ACROSS_DEG, seen))
}

/// What reaches into the lane from beside it does so from farther aside than the ego's flank. [m]
const FROM_ASIDE_M: f64 = 1.0;

/// Whether what hangs or grows into the ego's lane comes from the told side.
fn reaches_in(told: &Told, ego: &OrientedBox, other: &OrientedBox) -> Option<(String, bool, String)> {
    let side = told.reaches_in?;
    let (sign, name) = (side.sign(), if side == LeftRight::Left { "left" } else { "right" });
    let farthest_m = other.corners().map(|corner| sign * ego.to_local(corner).y).into_iter().fold(f64::MIN, f64::max);
    let beside_m = farthest_m - ego.half_width;
    Some((
        format!("reaching in from the {name}"),
        beside_m > FROM_ASIDE_M,
        format!("to {beside_m:.1} m beside the ego"),
    ))
}

/// For sentences.
const ACROSS: &str = "across the ego's way";

/// How what the ego drives over, or into, is told to lie or to stand, whether it does, and how it does.
pub(super) fn check(told: &Told, ego: &OrientedBox, other: &OrientedBox) -> Option<(String, bool, String)> {
    let Some(lies) = told.lies else { return bars(told, ego, other).or_else(|| reaches_in(told, ego, other)) };
    let corners = other.corners().map(|corner| ego.to_local(corner).y);
    let least_m = corners.iter().copied().fold(f64::MAX, f64::min);
    let most_m = corners.iter().copied().fold(f64::MIN, f64::max);
    if lies.size().is_some() {
        let across = least_m < -ego.half_width && most_m > ego.half_width;
        let seen = format!("from {:.1} m to the right to {most_m:.1} m to the left", -least_m);
        return Some((ACROSS.to_owned(), across, seen));
    }
    let left_m = ego.to_local(other.centre).y;
    let there = (WHEELS_M.0..WHEELS_M.1).contains(&left_m.abs());
    let (side, of) = match side_of(&told.sv.zones) {
        Some(LeftRight::Left) => (" on the left", left_m > 0.0),
        Some(LeftRight::Right) => (" on the right", left_m < 0.0),
        None => ("", true),
    };
    Some((format!("under a wheel{side}"), there && of, format!("{left_m:.1} m to the left of the ego's middle")))
}
