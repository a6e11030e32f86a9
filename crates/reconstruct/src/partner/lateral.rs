//! Partners that leave the kerb or their lane, and come by: from where they do, and when.

use crate::ego::pace::ego_paces;
use crate::ground::way::Ground;
use crate::pace::lead::Beside;
use crate::pace::plain::{Pace, first_time};
use crate::partner::beside::{SQUEEZES_M, STOOD_OUT_M, STOOD_RADIUS_M, line_y_m};
use crate::told::crash::Told;
use crate::told::side::Turning;
use crate::touch::lanes;
use crate::touch::staging::Staging;
use crate::usual::LANE_M;
use recrash_model::account::{Act, ContactState, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::StripKind;
use recrash_model::template::Movement;
use recrash_roads::Course;

/// Who leaves its lane has begun so long before the contact, on so much of its way at least and at most. [s, m]
const LEAVES_S: f64 = 2.5;
const LEAVES_M: (f64, f64) = (12.0, 60.0);

/// Who had come over when the ego braked for it did so on no longer way, and kept its lane for so long before. [m]
const CAME_OVER_M: f64 = 90.0;
const KEPT_M: f64 = 5.0;

/// A curve that ends at an angle to its line goes to one side alone where it is no longer than so many times what it goes aside, by that
/// angle: a cubic does. [1]
const UNBENT: f64 = 3.0;

/// Who comes over in front of an ego that stops for it began to so long before that slowed. [s]
const BEGUN_S: f64 = 0.7;

/// Who leaves its lane keeps it until then: where it begins, and the poses that it drives by to the contact.
pub(super) fn keeps_lane(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let leaves = matches!(
        told.cp.movement,
        Some(
            Movement::ChangingLanes | Movement::Merging | Movement::CrossingIntoOpposingLane | Movement::LaneDeparture
        )
    );
    let changed = told.origin == Origin::Behind && told.cp.changed_lanes;
    let leaves = leaves && !told.passes_from_behind() && !changed
        || told.comes_along_kerb() && staging.ground.stands_m > 0.0 && !told.passes_from_behind()
        || told.strip_y_m(&staging.ground).is_some() && told.cp.turning == Turning::No
        || told.drifts_on_wrong_way();
    let wrong_side = told.is_met_on_wrong_side(&staging.ground, staging.cp);
    let over = told.comes_over || wrong_side || told.squeezes_by();
    if !(leaves || told.cp.dodges || over) || told.cp.state != ContactState::Moving || pace.speed_mps == 0.0 {
        return None;
    }
    let (cp, came) = (staging.cp, Vec2::from_heading(staging.cp_came));
    let line_y_m = line_y_m(told, staging)?;
    let usual_m = (LEAVES_S * told.cp.speed_mps).clamp(LEAVES_M.0, LEAVES_M.1);
    // It had begun before the ego slowed.
    let since_m = pace.driven_m - pace.speed_mps * (first_time(&pace.acts) - BEGUN_S);
    if let Some(way) = over_before(told, staging, pace, (arm_m, line_y_m, usual_m)) {
        return Some(way);
    }
    let ego_brakes_s = || first_time(&ego_paces(told, &staging.ground, staging.sv_s_m).1.acts);
    let over_m = match told.gives_way_to_merge {
        true => since_m.max(usual_m),
        false if told.squeezes_by() && !wrong_side => SQUEEZES_M,
        false if told.squeezes_by() => (pace.driven_m - KEPT_M).clamp(usual_m, LEAVES_M.1),
        // It is half over when the ego brakes for it.
        false if told.slows_for_who_came_over() => {
            let since_s = 2.0 * (told.contact_s - ego_brakes_s());
            let driven_m =
                (pace.driven_m - pace.speed_mps * (told.contact_s - since_s)).max(told.cp.speed_mps * since_s);
            // On a longer way it would first go to the other side.
            let turn = math::wrap_angle(cp.heading - staging.cp_came).abs().max(AWAY_RAD);
            let bends_m = UNBENT * (cp.position.y - line_y_m).abs() / turn;
            driven_m.min(CAME_OVER_M).min(bends_m).min(pace.driven_m - KEPT_M).max(usual_m)
        }
        false if told.stops_for_who_comes_over() => {
            (told.cp.speed_mps * (told.contact_s - ego_brakes_s() + BEGUN_S)).clamp(usual_m, LEAVES_M.1)
        }
        false => usual_m,
    };
    let early = told.slows_for_who_came_over() || told.stops_for_who_comes_over();
    let halfway = early.then(|| goes_over_halfway(staging, pace, arm_m, (line_y_m, ego_brakes_s() - BEGUN_S)));
    if let Some(way) = halfway.flatten() {
        return Some(way);
    }
    let leaves = Pose { position: Vec2::new(cp.position.x - came.x * over_m, line_y_m), heading: staging.cp_came };
    let mut course = Course::begin(arm_m);
    let before_m = if course.curve(leaves, cp, false) { pace.driven_m - course.length_m() } else { return None };
    let begin = Pose { position: leaves.position - came * before_m, ..leaves };
    (before_m > 1.0).then(|| (begin, vec![leaves, cp]))
}

/// Who goes straight on since it came over is at no more to its way. [rad]
const STRAIGHT_RAD: f64 = 0.02;

/// Who comes towards the ego, and had come over when that braked for it, goes straight on since: where it begins, and the poses that it drives by.
fn over_before(
    told: &Told,
    staging: &Staging,
    pace: &Pace,
    (arm_m, line_y_m, over_m): (f64, f64, f64),
) -> Option<(Pose, Vec<Pose>)> {
    let straight = math::wrap_angle(staging.cp.heading - staging.cp_came).abs() < STRAIGHT_RAD;
    if told.origin != Origin::Opposite || !straight || !told.slows_for_who_came_over() {
        return None;
    }
    let brakes_s = first_time(&ego_paces(told, &staging.ground, staging.sv_s_m).1.acts);
    let since_m = told.cp.speed_mps * (told.contact_s - brakes_s);
    between_lines(staging, pace, arm_m, [(since_m + over_m, line_y_m), (since_m, staging.cp.position.y)])
}

/// Who comes over by a part first has half of that before it on so long a way at least, where it goes aside by so much at least. [m, m]
const HALF_OVER_M: f64 = 12.0;
const LEAST_OVER_M: f64 = 0.8;

/// Who came over when the ego braked goes aside by half first, from then on, and by the rest where it touches: in one bend that ends askew all of it
/// would come late. Of the line that it leaves where that is, and when it begins to. [m, s]
fn goes_over_halfway(
    staging: &Staging,
    pace: &Pace,
    arm_m: f64,
    (line_y_m, from_s): (f64, f64),
) -> Option<(Pose, Vec<Pose>)> {
    let (cp, aside_m) = (staging.cp, staging.cp.position.y - line_y_m);
    let turn = math::wrap_angle(cp.heading - staging.cp_came).abs().max(AWAY_RAD);
    let rest_m = (0.5 * UNBENT * aside_m.abs() / turn).max(HALF_OVER_M);
    let begun_m = (pace.driven_m - pace.speed_mps * from_s.max(0.0)).min(pace.driven_m - KEPT_M);
    let fits = aside_m.abs() > LEAST_OVER_M && begun_m > rest_m + HALF_OVER_M;
    fits.then(|| between_lines(staging, pace, arm_m, [(begun_m, line_y_m), (rest_m, line_y_m + 0.5 * aside_m)]))?
}

/// Who passes has come out of the ego's lane so far before the contact, and does so on so much of its way at most. [m]
const OUT_M: f64 = 6.0;
const COMES_OUT_M: f64 = 24.0;

/// Who comes out to pass has not gone to the other side by more than this before. [m]
const DIPS_M: f64 = 0.3;

/// Who is at more than this to its road, away from whom it passes, is on its way out. [rad]
const AWAY_RAD: f64 = 0.02;

/// Who comes from behind the ego and passes it comes out of its lane, goes along beside it, and then comes too near: where it begins, and
/// the poses that it drives by.
pub(super) fn comes_by(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    if !told.passes_from_behind() {
        return None;
    }
    let cp = staging.cp;
    let comes_in = math::wrap_angle(cp.heading - staging.cp_came);
    // Who stood close behind has less room for it.
    let stood = told.comes_round_from_stand();
    let (out_m, radius_m) = if stood { (STOOD_OUT_M, STOOD_RADIUS_M) } else { (OUT_M, LEAST_BY_RADIUS_M) };
    // Who touches on its way out does not go along beside the ego first.
    if stood && comes_in * (cp.position.y - staging.sv.position.y) > 0.0 {
        return None;
    }
    let out_y_m = cp.position.y - 0.5 * out_m * comes_in;
    // An ego that turns came along its line.
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    let leaves = told.sv_aside().is_some();
    let along = told.comes_along_kerb() || turns || leaves;
    let own_y_m = if along { staging.ground.sv_pose(0.0).position.y } else { staging.sv.position.y };
    let splits = told.splits_lanes();
    let own_y_m = match splits {
        Some(LeftRight::Left) => own_y_m + 0.5 * LANE_M,
        Some(LeftRight::Right) => own_y_m - 0.5 * LANE_M,
        None => own_y_m,
    };
    // Who is yet on its way out comes straight out of its lane, and does not go to the side of whom it passes for that first.
    let side = (cp.position.y - staging.sv.position.y).signum();
    if !stood && comes_in * side > AWAY_RAD && splits.is_none() {
        let late = lanes::from_lane(told, staging, pace, arm_m);
        if late.is_some() || (own_y_m - out_y_m) * side > DIPS_M {
            return late;
        }
    }
    let back_m = (pace.driven_m - 0.5).min(out_m + COMES_OUT_M);
    let bends_m = (4.0 * radius_m * (out_y_m - own_y_m).abs()).sqrt();
    if back_m - out_m < bends_m {
        return None;
    }
    between_lines(staging, pace, arm_m, [(back_m, own_y_m), (out_m, out_y_m)])
}

/// Who changed into the ego's lane behind it is back on its line so far before the contact, and took so long for it. [m]
const CHANGED_M: f64 = 8.0;
const CHANGES_OVER_M: f64 = 30.0;

/// Who changed lanes behind the ego, and then came straight on: from the lane that it left, the one on its left where there is one.
pub(super) fn changed_behind(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let ground = &staging.ground;
    if !told.cp.changed_lanes || told.origin != Origin::Behind || told.cp.state != ContactState::Moving {
        return None;
    }
    let from = match told.cp.aside {
        Some(to) => to.other(),
        None if ground.lane > 0 => LeftRight::Left,
        None if ground.lanes > 1 => LeftRight::Right,
        None => return None,
    };
    let line_y_m = staging.sv.position.y + from.sign() * LANE_M;
    between_lines(staging, pace, arm_m, [(CHANGED_M + CHANGES_OVER_M, line_y_m), (CHANGED_M, staging.cp.position.y)])
}

/// Who drew in to the kerb and comes out again stood beside the lane so far before the contact, and left its line so far before. [m]
const OUT_AGAIN_M: f64 = 9.0;
const DREW_IN_M: f64 = 24.0;

/// Who came along ahead of the ego, drew in to the kerb, and comes out from there without a stand: along the ego's lane, and where others
/// park.
pub(super) fn drew_in(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let (cp, ground) = (&told.cp, &staging.ground);
    let draws_in = cp.acts.iter().position(|doing| matches!(doing.act, Act::Park | Act::PullOver) && !doing.begun)?;
    let comes_out = cp.acts.iter().rposition(|doing| doing.is_aside() && doing.act != Act::PullOver)?;
    let drives = cp.state == ContactState::Moving && !cp.stood_first && told.origin == Origin::Ahead;
    if !drives || comes_out <= draws_in || !ground.beside.contains(&StripKind::Parking) {
        return None;
    }
    let own_y_m = ground.sv_pose(0.0).position.y;
    let kerb_y_m = match cp.acts[draws_in].side {
        Some(LeftRight::Left) => own_y_m + ground.kerbs_m[0],
        _ => own_y_m - ground.kerbs_m[1],
    };
    between_lines(staging, pace, arm_m, [(DREW_IN_M, own_y_m), (OUT_AGAIN_M, kerb_y_m)])
}

/// The lane from which somebody came over before it stopped ahead of the ego, or beside it: the told one, else the one on its left where
/// there is one.
pub(super) fn came_over(told: &Told, ground: &Ground, arm_m: f64) -> Option<Beside> {
    let from = match told.cp.came_over? {
        Some(to) => to.other(),
        None if ground.lane > 0 => LeftRight::Left,
        None if ground.lanes > 1 => LeftRight::Right,
        None => return None,
    };
    let along = matches!(told.origin, Origin::Ahead | Origin::Behind);
    along.then_some(Beside { left_m: from.sign() * LANE_M, arm_m })
}

/// Along one line until so far before the contact, over to another by so far, and on to the contact: where it begins, and the poses that it
/// drives by. Of each line how far before the contact and where beside the road's axis. [m]
fn between_lines(staging: &Staging, pace: &Pace, arm_m: f64, lines: [(f64, f64); 2]) -> Option<(Pose, Vec<Pose>)> {
    let (cp, came) = (staging.cp, Vec2::from_heading(staging.cp_came));
    let [leaves, joins] = lines.map(|(back_m, y_m)| Pose {
        position: Vec2::new(cp.position.x - came.x * back_m, y_m),
        heading: staging.cp_came,
    });
    let mut course = Course::begin(arm_m);
    if !(course.curve(leaves, joins, false) && course.curve(joins, cp, false)) {
        return None;
    }
    let before_m = pace.driven_m - course.length_m();
    let begin = Pose { position: leaves.position - came * before_m.max(0.0), ..leaves };
    (before_m > 0.02).then(|| (begin, vec![leaves, joins, cp]))
}

/// No bend of who comes out to pass is tighter. [m]
const LEAST_BY_RADIUS_M: f64 = 7.0;
