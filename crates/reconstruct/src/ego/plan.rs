//! The ego's plan until the contact, and where that takes it.

use crate::ego::pace::ego_paces;
use crate::ground::way::Ground;
use crate::pace::lead::{Lead, before};
use crate::pace::plain::{Pace, first_time, time_before, when};
use crate::told::aside::Aside;
use crate::told::crash::Told;
use crate::told::side::size_of;
use crate::usual::{LANE_M, beyond_m};
use recrash_model::account::{AstrideWhen, ContactState};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::rollout::{ActorState, STEP_S};
use recrash_model::scenario::{
    Act, ActorPlan, Along, Deed, EgoSpec, Leg, MapSpec, Place, SCENARIO_FORMAT, ScenarioDraft,
};
use recrash_roads::check_on;

/// Before it began to brake for its stop, the ego still rolls for so long under the system under test. [s]
pub const ROLLS_S: f64 = 1.0;

/// The simulation goes on for so long after the contact. [s]
pub(crate) const GOES_ON_S: f64 = 5.0;

/// Where the ego is at the contact, when its centre has come so far along its way; nothing where it cannot come there. Who leaves its
/// line is driven there alone.
pub(crate) fn sv_at_contact(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<Pose> {
    let on_way = ground.sv_pose(sv_s_m);
    if ground.drift.or(told.sv_aside()).is_none() && !pulls_over(told, ground) {
        return Some(ground.pose(sv_s_m, ground.stands_m));
    }
    let alone = ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: "alone".to_owned(),
        map: MapSpec::G((*ground.map).clone()),
        ego: EgoSpec {
            kind: told.sv.kind,
            size: told.sv.size,
            lane: ground.lane,
            target_speed_mps: 10.0,
            route: ground.route.clone(),
            recorded: Some(ego_plan(told, ground, sv_s_m, on_way)),
            ..EgoSpec::default()
        },
        duration_s: told.contact_s + GOES_ON_S,
        ..ScenarioDraft::default()
    };
    let scenario = check_on(alone, Some(&ground.network)).ok()?.value;
    let rollout = recrash_sim::rehearse(&scenario, recrash_sim::Ego::Recorded);
    rollout.ego_track().states.get((told.contact_s / STEP_S).round() as usize).map(ActorState::pose)
}

/// How long a lane change or a drift takes, and the least and the most that is driven meanwhile. [s, m]
const ASIDE_S: f64 = 4.0;
const ASIDE_M: (f64, f64) = (14.0, 60.0);

/// Who was completing a lane change has driven so many times half of its way.
const MOSTLY_DONE: f64 = 1.5;

/// The same of who swerves from somebody. [s, m]
const SWERVES_S: f64 = 1.6;
const SWERVES_M: f64 = 8.0;

/// Who drove on after it had changed lanes has done so for so long. [s]
const DRIVES_ON_S: f64 = 1.5;

/// Who drifts to the edge of the road drives at least so many times as far as it drifts until then.
const DRIFTS_BY: f64 = 5.0;

/// The move out of the ego's line, half done at the contact, or done before it.
fn shift(told: &Told, aside: Aside, pace: &Pace, least_m: f64) -> Act {
    let (contact_s, speed_mps) = (told.contact_s, told.sv.speed_mps);
    let (over_s, from_m) = if told.sv.reacts { (SWERVES_S, SWERVES_M) } else { (ASIDE_S, ASIDE_M.0) };
    let half_m = (0.5 * over_s * speed_mps).clamp(0.5 * from_m, 0.5 * ASIDE_M.1).max(least_m);
    let drives = pace.speed_mps > 0.0;
    // Who changes lanes for somebody has just done so.
    let over_m = (2.0 * half_m).max(ASIDE_M.0);
    if told.sv.reacts && (aside.to_t_m - aside.from_t_m).abs() >= LANE_M && drives && over_m < pace.driven_m {
        let from_s = (time_before(contact_s, pace, over_m) * 10.0).round() / 10.0;
        return when(from_s, Deed::Shift { to_t_m: aside.to_t_m, over_m });
    }
    // Who was completing it has done most of it.
    let most_m = MOSTLY_DONE * half_m;
    if told.sv.completes && !aside.done && drives && speed_mps > 0.0 && most_m < pace.driven_m {
        let from_s = (time_before(contact_s, pace, most_m) * 10.0).round() / 10.0;
        return when(from_s, Deed::Shift { to_t_m: aside.to_t_m, over_m: 2.0 * half_m });
    }
    let (half_m, from_s) = if aside.done {
        (half_m, (contact_s - DRIVES_ON_S - 2.0 * half_m / speed_mps.max(0.1)).max(0.0))
    } else if drives && speed_mps == 0.0 {
        // It has done half of it where it comes to stand.
        let brakes_s = first_time(&pace.acts);
        let braking_m = pace.driven_m - pace.speed_mps * brakes_s;
        let half_m = (braking_m + pace.speed_mps * ROLLS_S).min(pace.driven_m);
        (half_m, (brakes_s - ROLLS_S).max(0.0))
    } else if half_m < pace.driven_m && drives && told.keeps_lane_beside(aside) {
        let done_m = share_done(told, aside, 2.0 * half_m) * 2.0 * half_m;
        (half_m, time_before(contact_s, pace, done_m))
    } else if half_m < pace.driven_m && (least_m > 0.0 || drives && contact_s * speed_mps < half_m) {
        (half_m, time_before(contact_s, pace, half_m))
    } else if half_m < pace.driven_m && drives {
        (half_m, contact_s - half_m / speed_mps)
    } else {
        let driven_m = pace.driven_m.max(1.0);
        (0.5 * over_from_stand(told, aside, driven_m), first_time(&pace.acts))
    };
    when((from_s * 10.0).round() / 10.0, Deed::Shift { to_t_m: aside.to_t_m, over_m: 2.0 * half_m })
}

/// What is done of a move into the next lane is looked for in such steps, and is half of its way at most; the ego has come out of its line by
/// so much at least. [-, m]
const SHARES: u32 = 50;
const LEAST_OUT_M: f64 = 1.2;

/// Whether the corner of an ego that has done such a share of its move into the lane of a partner which keeps the middle of that comes to the
/// other's flank.
fn comes_to_flank(told: &Told, aside: Aside, (share, over_m): (f64, f64)) -> bool {
    let ((length_m, width_m), (_, other_m)) = (size_of(&told.sv), size_of(&told.cp));
    let first_m = told.first_part_m(aside).unwrap_or(0.0).abs();
    let by_m = (aside.to_t_m - aside.from_t_m).abs() - first_m;
    let arm_m = recrash_roads::arm_m(told.sv.kind, length_m);
    let left = 1.0 - share;
    let done_m = by_m * share * share * share * (10.0 - 15.0 * share + 6.0 * share * share);
    let slope = by_m / over_m * 30.0 * share * share * left * left;
    let middle_m = done_m + slope * arm_m;
    middle_m >= LEAST_OUT_M && first_m + middle_m + 0.5 * (slope * length_m + width_m + other_m) >= LANE_M
}

/// The share of its move that such an ego has done as they touch.
fn share_done(told: &Told, aside: Aside, over_m: f64) -> f64 {
    let shares = (1..=SHARES).map(|step| 0.5 * f64::from(step) / f64::from(SHARES));
    shares.into_iter().find(|share| comes_to_flank(told, aside, (*share, over_m))).unwrap_or(0.5)
}

/// On how much of its way an ego makes its move that drives no farther from a stand until they touch. [m]
fn over_from_stand(told: &Told, aside: Aside, driven_m: f64) -> f64 {
    let shares = (1..=SHARES).map(|step| 0.5 * f64::from(step) / f64::from(SHARES));
    let mut ways = shares.map(|share| (share, driven_m / share));
    let found = ways.find(|way| told.keeps_lane_beside(aside) && comes_to_flank(told, aside, *way));
    found.map_or(2.0 * driven_m, |(_, over_m)| over_m)
}

/// Who leaves its line in two goes does the first part of that on so much of its way. [m]
const FIRST_PART_OVER_M: f64 = 12.0;

/// Who parks at the kerb comes along its lane, and leaves it on so much of its way; it is at the kerb so far before it stands. [m]
const PULLS_OVER_M: f64 = 20.0;
const AT_KERB_M: f64 = 1.0;

/// Whether the ego comes to the kerb where it is parked, or over the line where it stops.
fn pulls_over(told: &Told, ground: &Ground) -> bool {
    let over = told.stands_over().is_some_and(|over| over.when == AstrideWhen::Stop);
    told.sv.state == ContactState::Stopped && (told.is_at_kerb() || over) && ground.stands_m != 0.0
}

/// Who leaves a line and comes back to it does the first in so long, on so much of its way, and is on the other one for so long.
/// [s, m, s]
const GOES_OUT_S: (f64, f64) = (2.4, 4.0);
const GOES_OUT_M: (f64, f64) = (8.0, 30.0);
const IS_OUT_S: f64 = 0.5;

/// Puts before a lane change that it was one in the other direction first; false where there is none, or no time for it.
fn goes_out(aside: Aside, pace: &mut Pace) -> bool {
    let shift = pace.acts.iter().find(|act| matches!(act.deed, Deed::Shift { .. }));
    let Some(shift_s) = shift.map(|act| first_time(std::slice::from_ref(act))).filter(|_| aside.back) else {
        return false;
    };
    let takes_s = (shift_s - IS_OUT_S).clamp(GOES_OUT_S.0, GOES_OUT_S.1);
    let over_m = (takes_s * pace.speed_mps).clamp(GOES_OUT_M.0, GOES_OUT_M.1);
    let from_s = ((shift_s - IS_OUT_S - over_m / pace.speed_mps.max(0.1)) * 10.0).floor() / 10.0;
    let timed = pace.acts.iter().filter(|act| act.when.is_some());
    let drives = timed.map(|act| first_time(std::slice::from_ref(act))).all(|at_s| at_s >= shift_s);
    if from_s < 0.0 || !drives {
        return false;
    }
    pace.acts.insert(0, when(from_s, Deed::Shift { to_t_m: aside.from_t_m, over_m }));
    true
}

/// What the ego does until the contact, and begins with, as a plan on this road.
pub(crate) fn ego_plan(told: &Told, ground: &Ground, sv_s_m: f64, sv: Pose) -> ActorPlan {
    let (mut lead, mut pace) = ego_paces(told, ground, sv_s_m);
    let pulls_over = pulls_over(told, ground) && lead.is_none() && pace.driven_m > PULLS_OVER_M;
    if pulls_over {
        pace.acts.insert(0, shift_over(&pace, ground.stands_m));
    }
    let aside = ground.drift.or(told.sv_aside());
    if let Some(aside) = aside {
        leave_line(told, (aside, ground.drift.is_some()), lead.as_mut(), &mut pace);
    }
    let reverses = told.sv.state == ContactState::Reversing;
    let mut pace = match lead {
        Some(lead) if reverses || lead.reverses() => {
            let (plan, begin) = along_line(told, pace, sv);
            return before(lead, plan, begin, None);
        }
        Some(lead) => lead.then(pace),
        None => pace,
    };
    let from_m = match aside {
        Some(aside) if goes_out(aside, &mut pace) => aside.to_t_m,
        Some(aside) => aside.from_t_m,
        None if pulls_over => 0.0,
        None => ground.stands_m,
    };
    if reverses {
        return along_line(told, pace, sv).0;
    }
    let course = if pace.driven_m == 0.0 {
        Vec::new()
    } else {
        vec![Leg::Lanes { roads: ground.route.clone(), until_m: None, lane: None, against: false, reverse: false }]
    };
    let start = start(ground, ground.before(&told.sv, sv_s_m, from_m, pace.driven_m), from_m);
    ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(start) }
}

/// Where the ego begins, so far along its way, beside the middle of its lane by so much: inside of the junction it is on no lane of its first road.
fn start(ground: &Ground, start_m: f64, from_m: f64) -> Place {
    if start_m > ground.first_m() {
        let pose = ground.pose(start_m, ground.drift.map_or(0.0, |drift| drift.from_t_m));
        return Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees());
    }
    Place::Lane {
        road: ground.route[0].clone(),
        lane: ground.lane,
        along: Along::FromStart(start_m),
        t_m: from_m,
        heading_deg: 0.0,
    }
}

/// The move of who pulls over, to so far to the right: it is there before it stands. [m]
fn shift_over(pace: &Pace, to_t_m: f64) -> Act {
    let brakes_s = first_time(&pace.acts);
    let braking_m = pace.driven_m - pace.speed_mps * brakes_s;
    let way_m = PULLS_OVER_M.max(braking_m + AT_KERB_M);
    let from_s = ((brakes_s - (way_m - braking_m) / pace.speed_mps) * 10.0).floor().max(0.0) / 10.0;
    when(from_s, Deed::Shift { to_t_m, over_m: way_m - AT_KERB_M })
}

/// Puts the ego's move out of its line among what it does: in two goes where it stands between, and before it stops for good. Who drifts to the edge
/// of the road does so on more of its way.
fn leave_line(told: &Told, (aside, drifts): (Aside, bool), mut lead: Option<&mut Lead>, pace: &mut Pace) {
    let by_m = (aside.to_t_m - aside.from_t_m).abs();
    let least_m = if drifts { DRIFTS_BY * by_m } else { 0.0 };
    let shift = shift(told, aside, pace, least_m);
    let first = told.first_part_m(aside).filter(|_| !drifts);
    if let Some((lead, first_m)) = lead.as_mut().filter(|lead| !lead.reverses()).zip(first) {
        lead.goes_aside(aside.from_t_m + first_m, FIRST_PART_OVER_M);
    }
    let stands = told.sv.state.stands();
    if let Some(lead) = lead.filter(|_| stands) {
        return lead.shifts(aside.to_t_m, told.sv.ways_since_aside());
    }
    // Acts begin in order.
    let from_s = first_time(std::slice::from_ref(&shift));
    let begun = pace.acts.partition_point(|act| first_time(std::slice::from_ref(act)) <= from_s);
    pace.acts.insert(if stands { 0 } else { begun }, shift);
}

/// The plan of an ego that goes to its place by the line on which it is there, forwards or backwards; and where it begins.
fn along_line(told: &Told, pace: Pace, sv: Pose) -> (ActorPlan, Pose) {
    let reverse = told.sv.state == ContactState::Reversing;
    let way = Vec2::from_heading(sv.heading) * if reverse { -1.0 } else { 1.0 };
    let at = |position: Vec2| Place::at(position.x, position.y, sv.heading.to_degrees());
    let to = sv.position + way * beyond_m(told.sv.speed_mps);
    let course = match pace.driven_m {
        0.0 => Vec::new(),
        _ => vec![Leg::Curve { to: at(to), reverse }],
    };
    let begin = Pose { position: sv.position - way * pace.driven_m, ..sv };
    let plan =
        ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(at(begin.position)) };
    (plan, begin)
}
