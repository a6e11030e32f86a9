//! The line by which the partner comes to the contact.

use crate::pace::plain::Pace;
use crate::partner::turns::{self, TIGHTEST_LENGTHS, is_tight, with_its_turn};
use crate::partner::{beside, lateral};
use crate::told::crash::Told;
use crate::told::side::{Turning, size_of};
use crate::touch::staging::Staging;
use crate::touch::{lanes, sweep};
use crate::usual::beyond_m;
use recrash_model::account::ContactState;
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::scenario::{ActorPlan, Leg, Place};
use recrash_roads::Course;

/// The partner's last way: its legs, where it begins, and how far it is.
pub(super) struct OwnWay {
    pub(crate) course: Vec<Leg>,
    pub(crate) begin: Pose,
    pub(crate) driven_m: f64,
}

/// The line by which the partner comes to the contact, as long as its pace needs. Of who turns as it touches a bend is the last of it.
pub(super) fn course_to(told: &Told, staging: &Staging, pace: Pace, at: impl Fn(Pose) -> Place) -> (ActorPlan, Pose) {
    if let Some(bend) = staging.bend.filter(|bend| bend.length_m + LEAST_BEFORE_M < pace.driven_m) {
        let before = Staging { cp: bend.from, bend: None, ..staging.clone() };
        let pace = Pace { acts: pace.acts.clone(), driven_m: pace.driven_m - bend.length_m, ..pace };
        let (mut plan, begin) = line_to(told, &before, pace, &at);
        let beyond = staging.cp.position + Vec2::from_heading(staging.cp.heading) * beyond_m(told.cp.speed_mps);
        plan.course.pop();
        plan.course.push(Leg::Curve { to: at(staging.cp), reverse: false });
        if sweep::can_be_driven(told, begin, &plan.course) {
            plan.course.push(Leg::Curve { to: at(Pose { position: beyond, ..staging.cp }), reverse: false });
            return (plan, begin);
        }
    }
    line_to(told, staging, pace, at)
}

/// Before its last bend somebody has come so far at least. [m]
pub(super) const LEAST_BEFORE_M: f64 = 1.0;

/// The same to where it touches, or begins its last bend.
pub(super) fn line_to(told: &Told, staging: &Staging, pace: Pace, at: impl Fn(Pose) -> Place) -> (ActorPlan, Pose) {
    if let Some(begin) = follows_from(told, staging, &pace) {
        let roads = staging.ground.route.clone();
        let course = vec![Leg::Lanes { roads, until_m: None, lane: None, against: false, reverse: false }];
        return (plan(pace, course, at(begin)), begin);
    }
    let cp = &told.cp;
    let arm_m = recrash_roads::arm_m(cp.kind, size_of(cp).0);
    let reverse = cp.state == ContactState::Reversing;
    // What comes off the vehicle ahead does not slow for the end of its course before it has come off.
    let fastest_mps = if told.dropped.is_some() { pace.speed_mps } else { cp.speed_mps };
    let on = motion(told, staging.cp.heading) * beyond_m(fastest_mps);
    let beyond = Pose { position: staging.cp.position + on, ..staging.cp };
    // Who drives over a line comes from there, where it can.
    let over = beside::over_y_m(told, staging).and_then(|y_m| fitted(told, staging, &pace, (true, Some(y_m))));
    let on_lanes = || {
        with_its_turn(told, staging, &pace, arm_m)
            .or_else(|| lateral::drew_in(told, staging, &pace, arm_m))
            .or_else(|| lateral::keeps_lane(told, staging, &pace, arm_m))
            .or_else(|| lateral::comes_by(told, staging, &pace, arm_m))
            .or_else(|| lateral::changed_behind(told, staging, &pace, arm_m))
            .or_else(|| turns::turns_in(told, staging, &pace, arm_m))
            .or_else(|| lanes::from_lane(told, staging, &pace, arm_m))
    };
    let leg = |pose: Pose| Leg::Curve { to: at(pose), reverse };
    if let Some((begin, mut course)) = if over.is_some() { None } else { on_lanes() } {
        course.push(beyond);
        let course = course.into_iter().map(leg).collect();
        return (plan(pace, course, at(begin)), begin);
    }
    let back = motion(told, staging.cp.heading) * pace.driven_m;
    let straight = || Pose { position: staging.cp.position - back, ..staging.cp };
    let fitted = over
        .or_else(|| fitted(told, staging, &pace, (true, None)))
        .or_else(|| fitted(told, staging, &pace, (false, None)))
        .filter(|begin| !whips(told, *begin, staging.cp));
    let begin = fitted.unwrap_or_else(straight);
    (plan(pace, vec![leg(staging.cp), leg(beyond)], at(begin)), begin)
}

/// The plan of who has this pace, begins there and goes by these legs.
fn plan(pace: Pace, course: Vec<Leg>, begin: Place) -> ActorPlan {
    ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(begin) }
}

/// Where a partner begins that follows the ego's way, where that is on its first road.
fn follows_from(told: &Told, staging: &Staging, pace: &Pace) -> Option<Pose> {
    let (at_m, beside_m) = staging.cp_follows_m?;
    let begin_m = staging.ground.before(&told.cp, at_m, beside_m, pace.driven_m);
    (0.0..staging.ground.first_m()).contains(&begin_m).then(|| staging.ground.pose(begin_m, beside_m))
}

/// Where a partner that faces so moves to, one metre on.
fn motion(told: &Told, heading: f64) -> Vec2 {
    let gear = if told.cp.state == ContactState::Reversing { -1.0 } else { 1.0 };
    Vec2::from_heading(heading) * gear
}

/// The curve from a pose to another one by which the partner drives, where it can.
fn curve(told: &Told, from: Pose, to: Pose) -> Option<Course> {
    let mut course = Course::begin(recrash_roads::arm_m(told.cp.kind, size_of(&told.cp).0));
    course.curve(from, to, told.cp.state == ContactState::Reversing).then_some(course)
}

/// Where the partner begins on a line that is as long as what it drives: as far back as makes it so.
fn fitted(told: &Told, staging: &Staging, pace: &Pace, from: (bool, Option<f64>)) -> Option<Pose> {
    let length = |begin: Pose| curve(told, begin, staging.cp).map(|course| course.length_m());
    let mut back_m = pace.driven_m;
    for _ in 0..30 {
        let found = length(start(told, staging, back_m, from))?;
        back_m = (back_m + pace.driven_m - found).max(0.1);
    }
    let begin = start(told, staging, back_m, from);
    length(begin).is_some_and(|found| (found - pace.driven_m).abs() < 0.02).then_some(begin)
}

/// Whether what is long would whip round in reverse: it cannot, and comes straight.
fn whips(told: &Told, begin: Pose, to: Pose) -> bool {
    let length_m = size_of(&told.cp).0;
    let long = told.cp.state == ContactState::Reversing && length_m > LONG_M;
    long && curve(told, begin, to).is_some_and(|course| is_tight(&course, TIGHTEST_LENGTHS * length_m))
}

/// What is longer than this does not whip round in reverse. [m]
const LONG_M: f64 = 6.0;

/// Where the partner begins, this far back, headed as it came: in the lane it comes from, or so that an arc leads to the contact.
fn start(told: &Told, staging: &Staging, back_m: f64, (aside, over_y_m): (bool, Option<f64>)) -> Pose {
    let came = staging.cp_came;
    let way = motion(told, came);
    let turn = math::wrap_angle(staging.cp.heading - came);
    let mut position = staging.cp.position - way * back_m;
    let turns = told.cp.turning != Turning::No && turn.abs() > 0.1;
    let line_y_m = over_y_m.or_else(|| beside::line_y_m(told, staging)).filter(|_| aside && !turns);
    let pulls_out = aside && !turns && told.passes_from_behind() && over_y_m.is_none();
    if pulls_out {
        // Out of the ego's lane, which that may have left.
        let left = told.sv_aside().is_some();
        let own_y_m = if left { staging.ground.sv_pose(0.0).position.y } else { staging.sv.position.y };
        position.y = if told.comes_along_kerb() { 0.0 } else { own_y_m };
    } else if let Some(line_y_m) = line_y_m {
        position.y = line_y_m;
    } else if turn.abs() > 0.01 {
        // An arc of a usual radius before the contact: beside the line of the contact, by what the arc gains.
        let radius = if turns { 8.0_f64 } else { 15.0 }.min(back_m / turn.abs());
        let (gain, along) = (radius * (1.0 - math::cos(turn)), radius * math::sin(turn.abs()));
        position = staging.cp.position
            - way * (along + (back_m - radius * turn.abs()).max(0.0))
            - way.left() * (gain * turn.signum());
    }
    Pose { position, heading: came }
}
