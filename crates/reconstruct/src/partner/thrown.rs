//! Partners that another touched first, and who that is.

use crate::ego::pace::ego_paces;
use crate::ground::way::Ground;
use crate::pace::lead::{self, MOVES_UP_M};
use crate::pace::plain::{Pace, STANDING, STOPPING_MPS2, next, when};
use crate::partner::line::{LEAST_BEFORE_M, OwnWay, line_to};
use crate::told::crash::Told;
use crate::told::others::Thrower;
use crate::told::side::size_of;
use crate::told::sizes::size_of as size_of_kind;
use crate::touch::staging::Staging;
use crate::usual::{LANE_M, ROLLING_MPS, STOOD_S, beyond_m};
use recrash_model::account::{ContactState, Kind, LeftRight};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::scenario::{Act, Actor, ActorPlan, Deed, Leg, Place, Size};
use recrash_model::vehicle::VehicleSpec;
use recrash_model::zones::ContactZone;
use recrash_roads::Course;

/// Who throws the partner at the ego runs into it at this speed over its own, this long before the contact, and this far from where
/// that is. [m/s, s, m]
const PUSH_MPS: f64 = 10.0;
const THROW_S: f64 = 0.25;
const THROW_M: f64 = 1.0;

/// With less of that the partner does not come to the ego; and a usual speed on a street. [m/s]
const LEAST_THROW_MPS: f64 = 7.0;
const STREET_MPS: f64 = 11.2;

/// Who is pushed while it rolls towards an ego that stands does so at this speed. [m/s]
const PUSHED_ROLLING_MPS: f64 = 2.0;

/// The partner grazes who stands so long before the contact, with so much of its width. [s, m]
const GRAZES_S: f64 = 0.25;
const GRAZES_M: f64 = 0.05;

/// Who touches the partner on its way is faster than it by so much. [m/s]
const NUDGE_MPS: f64 = 2.0;

/// Who comes up behind the partner begins no nearer to its rear. [m]
const BEGINS_BEHIND_M: f64 = 2.0;

/// Who would be faster than the partner by more for that begins elsewhere. [m/s]
const MOST_NUDGE_MPS: f64 = 5.0;

/// Who comes over from beside the partner's line leaves its own so long before, on so much of its way at least; it touches so far beside the
/// middle, at this angle. [s, m, m, rad]
const COMES_OVER_S: f64 = 2.5;
const COMES_OVER_M: f64 = 10.0;
const CORNER_M: f64 = 0.5;
const CORNER_RAD: f64 = 0.1;

/// Who comes along the lane beside touches a flank no farther behind the partner than this; it is looked for in such steps, and in such parts
/// of a lane beside the ego. [m, m, -]
const BEHIND_M: f64 = 15.0;
const STEP_M: f64 = 0.1;
const LANE_PARTS: [f64; 3] = [1.0, 0.85, 0.7];

/// Whose touched parts are told is looked for there, so much ahead or behind; and from the middle of the lane beside towards the partner, in
/// so many such parts of a lane. [m, -]
const NEARBY_M: [f64; 5] = [0.0, -0.5, 0.5, -1.0, 1.0];
const PART_STEP: f64 = 0.05;
const MOST_STEPS_ASIDE: u8 = 10;

/// The plan of who runs into the rear of a partner and does not come along behind it: out of the lane beside, where that is told, and else out
/// of the next driving lane to one that stands beside the lanes. Until where it touches.
fn from_beside(
    told: &Told,
    staging: &Staging,
    touch: Pose,
    (kind, length_m): (PartnerKind, f64),
    (speed_mps, until_s): (f64, f64),
) -> Option<ActorPlan> {
    let ground = &staging.ground;
    let (s_m, t_m) = ground.beside(touch.position);
    let [_, right_m] = ground.lane_edges_m;
    let from_m = match told.thrower {
        Some(Thrower::Beside(LeftRight::Left)) => t_m - LANE_M,
        Some(Thrower::Beside(LeftRight::Right)) => t_m + LANE_M,
        _ if t_m > right_m => right_m - 0.5 * LANE_M,
        _ => return None,
    };
    if !has_lane(ground, from_m) {
        return None;
    }
    let sign = (t_m - from_m).signum();
    let aside = Vec2::from_heading(touch.heading).left() * (sign * CORNER_M);
    let end = Pose { position: touch.position + aside, heading: touch.heading - sign * CORNER_RAD };
    let leaves = ground.pose(s_m - (COMES_OVER_S * speed_mps).max(COMES_OVER_M), from_m);
    let arm_m = recrash_roads::arm_m(kind, length_m);
    let legs = |poses: &[Pose]| poses.iter().map(|to| Leg::Curve { to: at(*to), reverse: false }).collect();
    let before_m = speed_mps * until_s - way_m(arm_m, &[leaves, end])?;
    let plan = ActorPlan { speed_mps, course: legs(&[leaves, end]), ..ActorPlan::standing(at(back(leaves, before_m))) };
    (before_m > LEAST_BEFORE_M).then_some(plan)
}

/// Whether a lane of the ego's direction lies there: neither a strip beside the lanes nor the other direction's. [m]
fn has_lane(ground: &Ground, t_m: f64) -> bool {
    let left_m = (f64::from(ground.lane) + 0.5) * LANE_M;
    t_m < ground.lane_edges_m[1] && t_m > -left_m
}

/// How long the way through some poses is. [m]
fn way_m(arm_m: f64, poses: &[Pose]) -> Option<f64> {
    let mut course = Course::begin(arm_m);
    poses.windows(2).all(|pair| course.curve(pair[0], pair[1], false)).then(|| course.length_m())
}

/// So far before a pose, straight. [m]
fn back(pose: Pose, by_m: f64) -> Pose {
    Pose { position: pose.position - Vec2::from_heading(pose.heading) * by_m, ..pose }
}

/// Where who comes along the lane beside the ego's touches a partner that is on its way then: its flank, or the corner at its rear.
fn flank(told: &Told, ground: &Ground, partner: &OrientedBox, (length_m, width_m): (f64, f64)) -> Option<Pose> {
    let Some(Thrower::Beside(side)) = told.thrower else { return None };
    let lane_m = -side.sign() * LANE_M;
    if !has_lane(ground, lane_m) {
        return None;
    }
    let (s_m, _) = ground.beside(partner.centre);
    let touches = |pose: &Pose| OrientedBox::new(*pose, length_m, width_m).overlaps(partner);
    if let Some(ahead_m) = touch_ahead_m(told, (2.0 * partner.half_length, length_m)) {
        let parts = (0..=MOST_STEPS_ASIDE).map(|step| 1.0 - PART_STEP * f64::from(step));
        let poses = parts.flat_map(|part| NEARBY_M.map(|by_m| ground.pose(s_m + ahead_m + by_m, part * lane_m)));
        return poses.into_iter().find(touches);
    }
    let steps = (BEHIND_M / STEP_M) as usize;
    let poses = LANE_PARTS
        .into_iter()
        .flat_map(|part| (0..steps).map(move |step| ground.pose(s_m - BEHIND_M + STEP_M * step as f64, part * lane_m)));
    poses.into_iter().find(touches)
}

/// How far ahead of the partner's middle that of the other is, whose flank its front meets, or whose front its flank, or which it rubs along;
/// nothing where its rear was met, or nobody tells where. Of both the length. [m]
fn touch_ahead_m(told: &Told, (partner_m, other_m): (f64, f64)) -> Option<f64> {
    let touch = told.touch.filter(|touch| !touch.of_partner.is_some_and(ContactZone::is_rear))?;
    let fronts = [touch.of_partner, touch.of_other].map(|zone| zone.is_some_and(ContactZone::is_front));
    Some(match fronts {
        [true, _] if touch.by_partner => 0.5 * partner_m,
        [true, true] => 0.5 * (partner_m - other_m),
        [_, true] if !touch.by_partner => -0.5 * other_m,
        _ => 0.0,
    })
}

fn at(pose: Pose) -> Place {
    Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
}

/// Who touched the partner on its way: it comes up from behind, or along the lane beside, and runs into it, right before the contact.
pub(super) fn nudger(told: &Told, staging: &Staging, own: OwnWay) -> Actor {
    let (cp, gear) = (&told.cp, if told.cp.state == ContactState::Reversing { -1.0 } else { 1.0 });
    let way = Vec2::from_heading(staging.cp.heading) * gear;
    let (kind, size, length_m) = pusher(told);
    let speed_mps = cp.speed_mps + NUDGE_MPS;
    let actor = |plan| Actor { id: "pusher".to_owned(), kind, size, mass_kg: None, parts: Vec::new(), plan };
    let before = Pose { position: staging.cp.position - way * (cp.speed_mps * THROW_S), ..staging.cp };
    let (partner_m, wide_m) = size_of(cp);
    let width_m = size.map_or(VehicleSpec::of(kind).width_m, |size| size.width_m);
    let partner = OrientedBox::new(before, partner_m, wide_m);
    if let Some(met) = flank(told, &staging.ground, &partner, (length_m, width_m)) {
        let along = Vec2::from_heading(met.heading);
        let start = Pose { position: met.position - along * (speed_mps * (told.contact_s - THROW_S)), ..met };
        let to = at(Pose { position: met.position + along * beyond_m(speed_mps), ..met });
        let course = vec![Leg::Curve { to, reverse: false }];
        return actor(ActorPlan { speed_mps, course, ..ActorPlan::standing(at(start)) });
    }
    let touches = staging.cp.position - way * (cp.speed_mps * THROW_S + 0.5 * (size_of(cp).0 + length_m));
    // It begins behind the partner, which may have slowed since.
    let driven_m = own.driven_m - cp.speed_mps * THROW_S + BEGINS_BEHIND_M;
    let least_mps = driven_m / (told.contact_s - THROW_S);
    let speed_mps = if least_mps > cp.speed_mps + MOST_NUDGE_MPS { speed_mps } else { speed_mps.max(least_mps) };
    let start = touches - way * (speed_mps * (told.contact_s - THROW_S));
    let degrees = staging.cp.heading.to_degrees() + if gear < 0.0 { 180.0 } else { 0.0 };
    let place = |point: Vec2| Place::at(point.x, point.y, degrees);
    // By the partner's way, where that came askew to its road there.
    let behind_m = (staging.cp.position - start).dot(way) - own.driven_m;
    let askew = math::wrap_angle(staging.cp.heading - own.begin.heading).abs() > ASKEW_RAD;
    let (from, course) = if askew && gear > 0.0 && behind_m > 0.0 {
        let Pose { position, heading } = own.begin;
        let from = position - Vec2::from_heading(heading) * behind_m;
        (Place::at(from.x, from.y, heading.to_degrees()), own.course)
    } else {
        let to = place(touches + way * beyond_m(speed_mps));
        (place(start), vec![Leg::Curve { to, reverse: false }])
    };
    actor(ActorPlan { speed_mps, course, ..ActorPlan::standing(from) })
}

/// Who drives ahead of the ego is looked for so far ahead of it at most; the partner has not touched it so long before, looked at in such
/// steps. [m, s, s]
const AHEAD_M: f64 = 16.0;
const BEFORE_S: f64 = 1.2;
const TICK_S: f64 = 0.05;

/// Who drives ahead in the ego's lane, as fast as that, and is touched by the partner on its way right before the contact.
pub(super) fn ahead(told: &Told, staging: &Staging) -> Option<Actor> {
    let (kind, size, length_m) = pusher(told);
    let width_m = size.map_or(VehicleSpec::of(kind).width_m, |size| size.width_m);
    let (partner_m, wide_m) = size_of(&told.cp);
    let (road, speed_mps) = (Vec2::from_heading(staging.sv.heading), told.sv.speed_mps);
    let way = Vec2::from_heading(staging.cp.heading) * told.cp.speed_mps;
    let back = |pose: Pose, mps: Vec2, before_s: f64| Pose { position: pose.position - mps * before_s, ..pose };
    // Where it would be at the contact.
    let there = |ahead_m: f64| Pose { position: staging.sv.position + road * ahead_m, ..staging.sv };
    let touched_s = |ahead_m: f64| {
        let ticks = (0..=(BEFORE_S / TICK_S) as usize).rev().map(|tick| TICK_S * tick as f64);
        ticks.into_iter().find(|before_s| {
            let other = OrientedBox::new(back(there(ahead_m), road * speed_mps, *before_s), length_m, width_m);
            other.overlaps(&OrientedBox::new(back(staging.cp, way, *before_s), partner_m, wide_m))
        })
    };
    // The farthest of those: its corner is grazed.
    let steps = (0..(AHEAD_M / GRAZES_M) as usize).rev().map(|step| GRAZES_M * step as f64);
    let found = steps.filter_map(|ahead_m| Some((ahead_m, touched_s(ahead_m).filter(|before_s| *before_s > 0.0)?)));
    let off_s = |(_, before_s): &(f64, f64)| (before_s - THROW_S).abs();
    let (ahead_m, _) = found.min_by(|one, other| off_s(one).total_cmp(&off_s(other)))?;
    let start = back(there(ahead_m), road * speed_mps, told.contact_s);
    let to = Pose { position: there(ahead_m).position + road * beyond_m(speed_mps), ..start };
    let course = if speed_mps > 0.0 { vec![Leg::Curve { to: at(to), reverse: false }] } else { Vec::new() };
    let plan = ActorPlan { speed_mps, course, ..ActorPlan::standing(at(start)) };
    Some(Actor { id: "pusher".to_owned(), kind, size, mass_kg: None, parts: Vec::new(), plan })
}

/// Who comes along a road of its own, as fast as this, runs into the partner so long before the contact; it is looked for from so far away.
/// [m/s, s, m]
const ACROSS_MPS: f64 = 7.0;
const ACROSS_S: f64 = 0.15;
const ACROSS_FROM_M: f64 = 15.0;

/// A zone at the front or the rear of somebody is so much of its length from its middle. [-]
const ZONE_PART: f64 = 0.3;

/// Who comes straight along the crossing road, or from the opposite direction, and runs into the told part of the partner right before the
/// contact; nothing where nobody tells from where it comes.
pub(super) fn across(told: &Told, staging: &Staging) -> Option<Actor> {
    let degrees: f64 = match told.thrower? {
        Thrower::Cross(LeftRight::Left) => -90.0,
        Thrower::Cross(LeftRight::Right) => 90.0,
        Thrower::Opposite => 180.0,
        Thrower::Beside(_) | Thrower::Ahead => return None,
    };
    let (kind, size, length_m) = pusher(told);
    let width_m = size.map_or(VehicleSpec::of(kind).width_m, |size| size.width_m);
    let (partner_m, wide_m) = size_of(&told.cp);
    let (way, along) = (Vec2::from_heading(degrees.to_radians()), Vec2::from_heading(staging.cp.heading));
    let before = Pose { position: staging.cp.position - along * (told.cp.speed_mps * ACROSS_S), ..staging.cp };
    let partner = OrientedBox::new(before, partner_m, wide_m);
    let part = match told.touch.and_then(|touch| touch.of_partner) {
        Some(zone) if zone.is_front() => ZONE_PART,
        Some(zone) if zone.is_rear() => -ZONE_PART,
        _ => 0.0,
    };
    let aims = before.position + along * (part * partner_m);
    let pose = |short_m: f64| Pose { position: aims - way * short_m, heading: degrees.to_radians() };
    let steps = (0..(ACROSS_FROM_M / STEP_M) as usize).map(|step| ACROSS_FROM_M - STEP_M * step as f64);
    let met = steps.map(pose).find(|pose| OrientedBox::new(*pose, length_m, width_m).overlaps(&partner))?;
    let start = back(met, ACROSS_MPS * (told.contact_s - ACROSS_S));
    let to = at(Pose { position: met.position + way * beyond_m(ACROSS_MPS), ..met });
    let course = vec![Leg::Curve { to, reverse: false }];
    let plan = ActorPlan { speed_mps: ACROSS_MPS, course, ..ActorPlan::standing(at(start)) };
    Some(Actor { id: "pusher".to_owned(), kind, size, mass_kg: None, parts: Vec::new(), plan })
}

/// Who stands at the kerb, and whom the partner grazes on its way, on the side away from the ego.
pub(super) fn grazed(told: &Told, staging: &Staging) -> Actor {
    let (kind, size, length_m) = pusher(told);
    let width_m = size.map_or(VehicleSpec::of(kind).width_m, |size| size.width_m);
    let (partner_m, wide_m) = size_of(&told.cp);
    let along = Vec2::from_heading(staging.cp.heading);
    let to_ego = along.cross(staging.sv.position - staging.cp.position).signum();
    let ahead_m = 0.5 * (partner_m + length_m) - told.cp.speed_mps * GRAZES_S;
    let beside_m = 0.5 * (width_m + wide_m) - GRAZES_M;
    let point = staging.cp.position + along * ahead_m - along.left() * (to_ego * beside_m);
    let plan = ActorPlan::standing(Place::at(point.x, point.y, staging.cp.heading.to_degrees()));
    Actor { id: "pusher".to_owned(), kind, size, mass_kg: None, parts: Vec::new(), plan }
}

/// Kind, size and length of who touches the partner: as told, else of a car.
fn pusher(told: &Told) -> (PartnerKind, Option<Size>, f64) {
    let kind = told.pusher.and_then(Kind::partner_kind).unwrap_or(PartnerKind::PassengerCar);
    let size = told.pusher.and_then(size_of_kind);
    (kind, size, size.map_or(VehicleSpec::of(kind).length_m, |size| size.length_m))
}

/// The pace of a partner that drives behind an ego which stood on its way, or slows: it does what that does.
fn as_the_ego(told: &Told, staging: &Staging) -> Option<Pace> {
    let (lead, pace) = ego_paces(told, &staging.ground, staging.sv_s_m);
    let changes = lead.is_some() || pace.speed_mps == 0.0 || told.sv.slowed_from.is_some();
    match lead {
        Some(lead) if lead.reverses() => None,
        Some(lead) => Some(lead.then(pace)),
        None => changes.then_some(pace),
    }
}

/// Who is told to have come fast does so. [m/s]
const PUSHES_FAST_MPS: f64 = 14.0;

/// How much faster than the partner is who throws it: of two that are alike half of it is left, where told; and no faster than is usual
/// on a street, where it can be. [m/s]
fn push_mps(told: &Told, partner_mps: f64) -> f64 {
    match told.cp.impact_mps {
        _ if told.pusher_fast => (told.fast_mps().max(PUSHES_FAST_MPS) - partner_mps).max(LEAST_THROW_MPS),
        Some(mps) => (2.0 * (mps - partner_mps)).clamp(LEAST_THROW_MPS, PUSH_MPS),
        None => (STREET_MPS - partner_mps).clamp(LEAST_THROW_MPS, PUSH_MPS),
    }
}

/// How the partner comes to where another runs into it: that comes with this speed, and drives so much faster than it from then on. [m/s]
struct Thrown {
    pace: Pace,
    pusher_mps: f64,
    rolls_mps: f64,
}

/// It stands behind the ego, or comes along behind it, and who runs into it does so at [`PUSH_MPS`] over its speed.
fn thrown_paces(told: &Told, staging: &Staging) -> Thrown {
    let cp = &told.cp;
    let rolls_mps = if told.pushed_rolling { PUSHED_ROLLING_MPS } else { 0.0 };
    let braking_s = (ROLLING_MPS - rolls_mps) / STOPPING_MPS2;
    let from_s = ((told.contact_s - STOOD_S - braking_s) * 10.0).floor() / 10.0;
    let driven_m = ROLLING_MPS * from_s + 0.5 * (ROLLING_MPS + rolls_mps) * braking_s;
    let moves_up = lead::lead(&cp.phases, told.contact_s - STOOD_S, ROLLING_MPS, MOVES_UP_M, 0.0);
    let ego_mps = if told.sv.state.stands() { 0.0 } else { told.sv.speed_mps };
    let push_mps = push_mps(told, ego_mps + rolls_mps);
    let rolling = |acts: Vec<Act>, driven_m: f64| Pace { speed_mps: ROLLING_MPS, acts, driven_m };
    let (pace, pusher_mps) = if told.sv.state == ContactState::Parked || cp.state == ContactState::Parked {
        (STANDING, push_mps)
    } else if let Some(pace) = as_the_ego(told, staging).filter(|_| ego_mps > 0.0) {
        (pace, ego_mps + push_mps)
    } else if ego_mps > 0.0 {
        (Pace { speed_mps: ego_mps, acts: Vec::new(), driven_m: ego_mps * told.contact_s }, ego_mps + push_mps)
    } else if rolls_mps > 0.0 {
        // It slows behind the ego, and rolls yet when it is pushed.
        let slow = vec![when(from_s, Deed::Speed { to_mps: rolls_mps, rate_mps2: STOPPING_MPS2 })];
        let rolled_m = rolls_mps * (told.contact_s - from_s - braking_s);
        (rolling(slow, driven_m + rolled_m), rolls_mps + push_mps)
    } else if let Some(lead) = moves_up.filter(|lead| !lead.reverses()) {
        // It stood behind the ego, moved up, and stands again.
        let (speed_mps, driven_m) = (lead.speed_mps, lead.driven_m());
        let acts = lead.acts.into_iter().chain([next(Deed::Hold { for_s: None })]).collect();
        (Pace { speed_mps, acts, driven_m }, push_mps)
    } else {
        let stop = Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None };
        (rolling(vec![when(from_s, stop), next(Deed::Hold { for_s: None })], driven_m), push_mps)
    };
    Thrown { pace, pusher_mps, rolls_mps: ego_mps + rolls_mps }
}

/// Who touches askew to its road was there only at the end: it, and who runs into it, came by its way. [rad]
const ASKEW_RAD: f64 = 0.05;

/// The partner, and another who runs into it from behind, or out of the lane from which it is told to come.
pub(super) fn thrown(told: &Told, staging: &Staging) -> Vec<Actor> {
    let cp = &told.cp;
    let Thrown { pace, pusher_mps, rolls_mps } = thrown_paces(told, staging);
    let way = Vec2::from_heading(staging.cp.heading);
    let pushed = Pose { position: staging.cp.position - way * THROW_M, ..staging.cp };
    let beyond = |speed_mps: f64| Leg::Curve {
        to: at(Pose { position: staging.cp.position + way * beyond_m(speed_mps), ..staging.cp }),
        reverse: false,
    };
    let (kind, size, pusher_m) = pusher(told);
    let until_m = 0.5 * (size_of(cp).0 + pusher_m) + pusher_mps * (told.contact_s - THROW_S);
    let behind_m = until_m + rolls_mps * THROW_S - pace.driven_m;
    let askew = math::wrap_angle(staging.cp.heading - staging.cp_came).abs() > ASKEW_RAD;
    let (begin, course) = match askew && pace.driven_m > LEAST_BEFORE_M {
        true => {
            let cp_follows_m = staging.cp_follows_m.map(|(at_m, beside_m)| (at_m - THROW_M, beside_m));
            let before = Staging { cp: pushed, cp_follows_m, bend: None, ..staging.clone() };
            let (plan, begin) = line_to(told, &before, pace.clone(), at);
            (begin, plan.course)
        }
        false => (Pose { position: pushed.position - way * pace.driven_m, ..staging.cp }, Vec::new()),
    };
    let on = |speed_mps: f64, from: Pose, acts: Vec<Act>| {
        let mut course = course.clone();
        if !matches!(course.last(), Some(Leg::Lanes { .. })) {
            course.pop();
            course.push(beyond(speed_mps));
        }
        ActorPlan { speed_mps, course, acts, ..ActorPlan::standing(at(from)) }
    };
    let from = Pose { position: begin.position - Vec2::from_heading(begin.heading) * behind_m, ..begin };
    let actor =
        |id: &str, kind, size, plan| Actor { id: id.to_owned(), kind, size, mass_kg: None, parts: Vec::new(), plan };
    let partner = match pace.driven_m {
        0.0 => ActorPlan::standing(at(begin)),
        _ => on(pace.speed_mps, begin, pace.acts),
    };
    let met = pushed.position - way * (rolls_mps * THROW_S + 0.5 * (size_of(cp).0 + pusher_m));
    let met = Pose { position: met, ..pushed };
    let until_s = told.contact_s - THROW_S;
    let beside = from_beside(told, staging, met, (kind, pusher_m), (pusher_mps, until_s)).filter(|_| course.is_empty());
    let pusher = match beside {
        Some(plan) => {
            let course = plan.course.into_iter().chain([beyond(pusher_mps)]).collect();
            ActorPlan { course, ..plan }
        }
        None => on(pusher_mps, from, Vec::new()),
    };
    vec![actor("cp", cp.kind, cp.size, partner), actor("pusher", kind, size, pusher)]
}
