//! Partners that turn on their way: out of a lane, a stall or a driveway, round with the ego, or off the road.

use crate::pace::lead::STOPS_SHORT_M;
use crate::pace::plain::{Pace, first_time, when};
use crate::told::crash::Told;
use crate::told::side::{Side, Slant, Turning, size_of};
use crate::touch::lanes::{self, TURN_M, turn_m};
use crate::touch::staging::Staging;
use crate::usual::{LANE_M, SWINGS_OUT_RAD, TIGHTEST_M, WHEELED_M, swing_rad};
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::{ActorPlan, Deed, Leg, Place};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Course;

/// Who has turned into the ego's road meets it so far behind its turn, or farther. [m]
const BEHIND_TURN_M: f64 = 1.0;

/// Who turns drives straight on, and then by one bend to the contact, or into the ego's road and along it: where it begins, and the
/// poses that it drives by.
pub(super) fn turns_in(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let cp = staging.cp;
    let turn = math::wrap_angle(cp.heading - staging.cp_came);
    if !matches!(told.cp.turning, Turning::Left | Turning::Right) || told.cp.state == ContactState::Reversing {
        return None;
    }
    if let Some(found) = into_the_road(told, staging, pace, arm_m) {
        return Some(found);
    }
    let radius_m = turn_m(told).min(pace.driven_m / turn.abs());
    let came = staging.cp_came;
    bend_from_lane(told, staging, (cp, came, radius_m), pace, arm_m)
        .or_else(|| by_bend(bend_before(cp, came, radius_m, arm_m), vec![cp], pace, arm_m))
}

/// Along the middle of a lane, by a bend of about this radius, and straight on to a pose where it has to.
fn bend_from_lane(
    told: &Told,
    staging: &Staging,
    (end, came, radius_m): (Pose, f64, f64),
    pace: &Pace,
    arm_m: f64,
) -> Option<(Pose, Vec<Pose>)> {
    let bend = lanes::bend_from_lane(told, (&staging.ground, staging.sv), end, (came, radius_m))?;
    let poses = if bend.end.position.distance(end.position) > 0.1 { vec![bend.end, end] } else { vec![end] };
    by_bend(bend_before(bend.end, came, bend.radius_m, arm_m), poses, pace, arm_m)
}

/// Where a bend of this radius that ends in a pose begins.
fn bend_before(end: Pose, came: f64, radius_m: f64, arm_m: f64) -> Pose {
    let (turn, way) = (math::wrap_angle(end.heading - came), Vec2::from_heading(came));
    let axle = end.position - Vec2::from_heading(end.heading) * arm_m;
    let (along_m, aside_m) = (radius_m * math::sin(turn.abs()), radius_m * (1.0 - math::cos(turn)) * turn.signum());
    Pose { position: axle - way * (along_m - arm_m) - way.left() * aside_m, heading: came }
}

/// Straight on to where a bend begins, and by these poses then.
fn by_bend(bends: Pose, poses: Vec<Pose>, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let mut course = Course::begin(arm_m);
    let mut from = bends;
    for pose in &poses {
        if !course.curve(from, *pose, false) {
            return None;
        }
        from = *pose;
    }
    let before_m = pace.driven_m - course.length_m();
    let begin = Pose { position: bends.position - Vec2::from_heading(bends.heading) * before_m, ..bends };
    match before_m > 0.5 {
        true => Some((begin, [bends].into_iter().chain(poses).collect())),
        false => (before_m > -0.02).then_some((bends, poses)),
    }
}

/// Who comes along the crossing road and turns into the ego's, towards it, does so in the junction and not where it meets the ego.
fn into_the_road(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let (cp, ground) = (staging.cp, &staging.ground);
    let towards = Vec2::from_heading(cp.heading).x < -0.8;
    let (Origin::Cross { side }, true, true) = (told.origin, ground.junction, towards) else { return None };
    // The lane nearest to the ego from the left, the one beside the middle from the right.
    let lane_m = match side {
        LeftRight::Left => -(ground.cross_lanes as f64 - 0.5) * LANE_M,
        LeftRight::Right => 0.5 * LANE_M,
    };
    let turned = Pose { heading: math::PI, ..cp };
    let bends = bend_before(turned, staging.cp_came, turn_m(told), arm_m);
    let behind_m = lane_m - bends.position.x;
    if behind_m < BEHIND_TURN_M {
        return None;
    }
    let by = |pose: Pose| Pose { position: pose.position + Vec2::new(behind_m, 0.0), ..pose };
    by_bend(by(bends), vec![by(turned), cp], pace, arm_m)
}

/// Who turns off the road and stops there comes along it with this speed, brakes by so much, and stands so long before it reverses.
/// [m/s, m/s^2, s]
const TURNS_OFF_MPS: f64 = 4.0;
const TURNS_OFF_MPS2: f64 = 2.0;
const TURNED_STANDS_S: f64 = 1.0;

/// The same plan of who reverses, with how it came there before: along the road, by a bend to where it stands. Nothing where it is not
/// told to have come, or has no time to.
pub(super) fn turns_off(
    told: &Told,
    staging: &Staging,
    begin: Pose,
    plan: &ActorPlan,
    arm_m: f64,
) -> Option<ActorPlan> {
    let crosses = matches!(told.origin, Origin::Cross { .. });
    let came_there = told.cp.came_there || crosses;
    let Some(Slant::Stood { oncoming, .. }) = told.cp.slants.filter(|_| came_there) else { return None };
    let came = if oncoming { math::PI } else { 0.0 };
    let stands_s = ((first_time(&plan.acts) - TURNED_STANDS_S) * 10.0).floor() / 10.0;
    let braking_s = TURNS_OFF_MPS / TURNS_OFF_MPS2;
    let driven_m = TURNS_OFF_MPS * (stands_s - 0.5 * braking_s);
    let pace = Pace { speed_mps: TURNS_OFF_MPS, acts: Vec::new(), driven_m: driven_m + STOPS_SHORT_M };
    let turn = math::wrap_angle(begin.heading - came).abs();
    let radius_m = TURN_M.min(driven_m / turn.max(0.1));
    let from_lane = bend_from_lane(told, staging, (begin, came, radius_m), &pace, arm_m);
    let bends = || by_bend(bend_before(begin, came, radius_m, arm_m), vec![begin], &pace, arm_m);
    let (start, poses) = from_lane.or_else(bends)?;
    let at = |pose: Pose| Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees());
    let legs = poses.into_iter().map(|pose| Leg::Curve { to: at(pose), reverse: false });
    let stop = when(stands_s - braking_s, Deed::Stop { rate_mps2: TURNS_OFF_MPS2, at_m: None });
    Some(ActorPlan {
        start: at(start),
        speed_mps: TURNS_OFF_MPS,
        course: legs.chain(plan.course.clone()).collect(),
        acts: [stop].into_iter().chain(plan.acts.clone()).collect(),
        ..plan.clone()
    })
}

/// Nothing on wheels bends its line tighter than so much of its length.
pub(super) const TIGHTEST_LENGTHS: f64 = 0.5;

/// Whether a line bends tighter than this somewhere.
pub(super) fn is_tight(course: &Course, tightest_m: f64) -> bool {
    let steps = (course.length_m() / PIECE_M * 10.0).ceil() as usize;
    let at = |step: usize| course.spot(course.length_m() * step as f64 / steps.max(1) as f64);
    (0..=steps).any(|step| at(step).curvature.abs() * tightest_m > 1.0)
}

/// The tightest bend that somebody drives; none of who walks or rides. [m]
fn tightest_m(side: &Side) -> f64 {
    let wheels = VehicleSpec::of(side.kind).length_m > WHEELED_M;
    if wheels { TIGHTEST_M.max(TIGHTEST_LENGTHS * size_of(side).0) } else { 0.0 }
}

/// Who turns with the ego, behind it or beside it, comes by its way: where it begins, and the poses that it drives by to the contact.
pub(super) fn with_its_turn(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let (ground, cp) = (&staging.ground, staging.cp);
    let reverses = told.cp.state == ContactState::Reversing;
    if !matches!(told.origin, Origin::Behind | Origin::Beside { .. }) || told.sv.turning == Turning::No || reverses {
        return None;
    }
    // It goes straight on: from beside where no turn is told, from behind where it has not turned as the ego does.
    let as_ego = if told.sv.turning == Turning::Right { -1.0 } else { 1.0 };
    let turned = math::wrap_angle(cp.heading - staging.cp_came);
    let goes_on = match told.origin {
        Origin::Behind => as_ego * turned < STRAIGHT_RAD,
        // Who is beside one that has turned comes by its way yet.
        _ if told.sv.turned => told.cp.turning == Turning::No && turned.abs() < STRAIGHT_RAD,
        _ => told.cp.turning == Turning::No,
    };
    if goes_on {
        return None;
    }
    let (met_m, beside_m) = ground.beside(cp.position);
    // Who comes behind it comes along its lane, and who turns beside it along the next one.
    let abreast = matches!(told.origin, Origin::Beside { .. }) && told.cp.turning == told.sv.turning;
    let beside_m = match told.origin {
        Origin::Behind => beside_m.clamp(-FOLLOWS_BESIDE_M, FOLLOWS_BESIDE_M),
        _ if abreast => beside_m.signum() * LANE_M,
        _ => beside_m,
    };
    let joins: &[f64] = if abreast { &[12.0, 9.0, 15.0, 6.0] } else { &[3.0, 5.0, 8.0, 12.0, 16.0] };
    let by = |joins_m: f64, swings: bool| {
        let last_m = met_m - joins_m;
        let mut join = Course::begin(arm_m);
        let drawn = join.curve(ground.pose(last_m, beside_m), cp, false);
        if !drawn || is_tight(&join, tightest_m(&told.cp)) || swings_out(&join) != swings {
            return None;
        }
        let turn_m = (last_m - ground.first_m()).max(0.0);
        let steps = (turn_m / PIECE_M).ceil() as usize;
        let on_way = (0..=steps).map(|step| last_m - turn_m * (1.0 - step as f64 / steps.max(1) as f64));
        // Beside the middle of the lane the turn is shorter, or longer.
        let mut turn = Course::begin(arm_m);
        let mut pieces = on_way.clone().map(|s_m| ground.pose(s_m, beside_m));
        let first = pieces.next().unwrap_or(cp);
        let turns_m = if pieces.all(|pose| turn.curve(first, pose, false)) { turn.length_m() } else { turn_m };
        let begin_m = last_m - turn_m - (pace.driven_m - join.length_m() - turns_m);
        let on_way = on_way.filter(|s_m| *s_m > begin_m + 0.5).map(|s_m| ground.pose(s_m, beside_m));
        (begin_m < last_m - 1.0).then(|| (ground.pose(begin_m, beside_m), on_way.chain([cp]).collect()))
    };
    let first = |swings: bool| joins.iter().find_map(|joins_m| by(*joins_m, swings));
    first(false).or_else(|| first(true))
}

/// Whether a line that turns swings out to the other side first.
fn swings_out(line: &Course) -> bool {
    let steps = (line.length_m() / PIECE_M * 10.0).ceil() as usize;
    let headings = (0..=steps).map(|step| line.spot(line.length_m() * step as f64 / steps.max(1) as f64).heading);
    swing_rad(headings) > SWINGS_OUT_RAD
}

/// Who has turned by no more than this comes straight. [rad]
const STRAIGHT_RAD: f64 = 0.15;

/// Who follows through a turn is no farther beside the middle of the lane. [m]
const FOLLOWS_BESIDE_M: f64 = 0.8;

/// The way through a turn is drawn in pieces of about this length. [m]
const PIECE_M: f64 = 3.0;
