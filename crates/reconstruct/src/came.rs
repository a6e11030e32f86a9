//! How both came to where they touch: courses and speeds, told backwards from the contact.

use crate::control;
use crate::door::Opening;
use crate::extras;
use crate::ground::{Ground, LANE_M};
use crate::kerb;
use crate::lanes;
use crate::lateral;
use crate::others::Role;
use crate::pace::{Pace, ego_paces, first_time, partner_paces, time_before, when};
use crate::phases;
use crate::side::{Side, Turning};
use crate::sweep;
use crate::things;
use crate::thrown;
use crate::told::{Aside, Told};
use crate::touch::{Staging, size_of};
use crate::trailer::Rig;
use recrash_model::account::{Account, ContactState, Origin, StandReason, told as told_of};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::rollout::{ActorState, STEP_S};
use recrash_model::scenario::{
    Act, Actor, ActorPlan, Along, Author, Deed, EgoSpec, Environment, Leg, MapSpec, MissionStop, ObjectSpec, Part,
    Place, SCENARIO_FORMAT, ScenarioDraft, Size, Source,
};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{Course, check_on};

/// The system under test takes over this long before the contact, or before the ego began to stop. [s]
const HANDOVER_BEFORE_S: f64 = 5.0;

/// Before it began to brake for its stop, the ego still rolls for so long under the system under test. [s]
const ROLLS_S: f64 = 1.0;

/// A system under test wants no less than this. [m/s]
const LEAST_WANTED_MPS: f64 = 2.0;

/// The simulation goes on for so long after the contact. [s]
const GOES_ON_S: f64 = 5.0;

/// A course goes on behind the place of the contact, so far that nobody slows for its end before it. [m]
pub(crate) fn beyond_m(speed_mps: f64) -> f64 {
    20.0 + 5.0 * speed_mps
}

/// The scenario of a staging.
pub(crate) fn draft(account: &Account, told: &Told, staging: &Staging) -> ScenarioDraft {
    let ground = &staging.ground;
    let mut recorded = ego_plan(told, ground, staging.sv_s_m, staging.sv);
    let lead = ego_paces(told, ground, staging.sv_s_m).0;
    let (mut actors, objects) = partner(told, staging);
    let mut parts = Vec::new();
    if let Some(door) = &staging.door {
        let cp = actors.iter_mut().find(|actor| actor.id == "cp");
        match cp.filter(|_| !door.of_sv) {
            Some(cp) => opens(told.contact_s, door, &mut cp.plan, &mut cp.parts),
            None => opens(told.contact_s, door, &mut recorded, &mut parts),
        }
    }
    let mut map = (*ground.map).clone();
    let begins = actors.iter().find(|actor| actor.id == "cp").map(|actor| &actor.plan.start);
    map.roads[0].driveways.extend(begins.and_then(|begins| kerb::driveway(told, ground, begins)));
    let control = control::devices(told, ground, &recorded, &actors);
    let handover_s = match told.sv.state {
        ContactState::Parked => None,
        _ if told.stays_at_kerb() => None,
        _ if let Some(lead) = &lead => Some(lead.handover_s(told.contact_s - HANDOVER_BEFORE_S)),
        // While it still rolls.
        ContactState::Stopped => {
            Some((first_time(&recorded.acts) - ROLLS_S).clamp(0.0, told.contact_s - HANDOVER_BEFORE_S))
        }
        _ => Some((told.contact_s - HANDOVER_BEFORE_S).max(0.0)),
    };
    let target_speed_mps = wanted_mps(told, &recorded);
    let id: String =
        account.incident.chars().filter(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_')).take(40).collect();
    let draft = ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: format!("incident-{id}"),
        source: Source {
            records: account.reports.clone(),
            origin: Some(recrash_model::narrative::Origin::Own),
            author: Author::Rules,
            ..Source::default()
        },
        map: MapSpec::G(map),
        environment: environment(account),
        ego: EgoSpec {
            kind: told.sv.kind,
            size: told.sv.size,
            lane: ground.lane,
            target_speed_mps,
            route: ground.route.clone(),
            recorded: Some(recorded),
            handover_s,
            stops: mission_stop(told, staging),
            parts,
            ..EgoSpec::default()
        },
        control,
        actors,
        objects,
        duration_s: told.contact_s + GOES_ON_S,
        ..ScenarioDraft::default()
    };
    with_others(told, staging, draft)
}

/// Surface, light and weather as they are told; of several weathers the first.
fn environment(account: &Account) -> Environment {
    let place = &account.place;
    Environment {
        surface: told_of(&place.surface).unwrap_or_default(),
        lighting: told_of(&place.lighting).unwrap_or_default(),
        weather: place.weather.first().map(|fact| fact.value).unwrap_or_default(),
    }
}

/// The speed that the system under test wants: the highest that the recorded driver had, or sets out for, on its way to the contact; who
/// stood, or slowed, wants to drive on. [m/s]
fn wanted_mps(told: &Told, recorded: &ActorPlan) -> f64 {
    let sets_out = recorded.acts.iter().filter_map(|act| match act.deed {
        Deed::Speed { to_mps, .. } => Some(to_mps),
        _ => None,
    });
    let stood = told.sv.state.stands() || told.sv.stood_first || told.sv.state == ContactState::SettingOff;
    let least_mps = if stood { told.choices.rolling_mps } else { LEAST_WANTED_MPS };
    sets_out.fold(recorded.speed_mps.max(least_mps), f64::max)
}

/// The same with the others of the story, who go by what the two do.
fn with_others(told: &Told, staging: &Staging, mut draft: ScenarioDraft) -> ScenarioDraft {
    let known = Some(&staging.ground.network);
    let alone = (!told.extras.is_empty()).then(|| check_on(draft.clone(), known).ok()).flatten();
    if let (Some(alone), Some(recorded)) = (alone, draft.ego.recorded.as_ref()) {
        let alone = recrash_sim::simulate(&alone.value, recrash_sim::Ego::Recorded);
        draft.actors.extend(extras::actors(told, staging, recorded, &alone));
        // Who waits ahead waits for the same light.
        draft.control = control::devices(told, &staging.ground, recorded, &draft.actors);
    }
    draft
}

/// Somebody opens a door.
fn opens(contact_s: f64, door: &Opening, plan: &mut ActorPlan, parts: &mut Vec<Part>) {
    let (to_deg, over_s) = (door.to_deg, Opening::OPENS_S);
    parts.push(door.part.clone());
    plan.acts.push(when(contact_s - door.before_s, Deed::Part { part: door.part.id.clone(), to_deg, over_s }));
}

/// Where the task of the system under test has it stop: where it stood for passengers, and where nothing in the scene makes it
/// stop. What made the recorded driver stop is then part of the task.
fn mission_stop(told: &Told, staging: &Staging) -> Vec<MissionStop> {
    let at_line = staging.ground.junction && told.sv.control.is_some();
    let lead = told.extras.iter().any(|extra| matches!(extra.role, Role::Lead | Role::Thing) && !extra.goes);
    let by_itself = told.sv.state == ContactState::Stopped && !lead && !at_line;
    let boards = told.sv.state.stands() && told.reasons.contains(&StandReason::PickupDropoff);
    if !by_itself && !boards {
        return Vec::new();
    }
    let (s_m, t_m) = staging.ground.beside(staging.sv.position);
    vec![MissionStop { s_m, t_m: t_m + staging.ground.off_route_m, for_s: None }]
}

/// Straight on at a speed.
pub(crate) fn straight_plan(start: Vec2, way: Vec2, (speed_mps, contact_s): (f64, f64)) -> ActorPlan {
    let degrees = math::atan2(way.y, way.x).to_degrees();
    let to = start + way * (speed_mps * contact_s + beyond_m(speed_mps));
    ActorPlan {
        speed_mps,
        course: vec![Leg::Curve { to: Place::at(to.x, to.y, degrees), reverse: false }],
        ..ActorPlan::standing(Place::at(start.x, start.y, degrees))
    }
}

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
    let rollout = recrash_sim::simulate(&scenario, recrash_sim::Ego::Recorded);
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
    } else if half_m < pace.driven_m && (least_m > 0.0 || drives && contact_s * speed_mps < half_m) {
        (half_m, time_before(contact_s, pace, half_m))
    } else if half_m < pace.driven_m && drives {
        (half_m, contact_s - half_m / speed_mps)
    } else {
        (pace.driven_m.max(1.0), first_time(&pace.acts))
    };
    when((from_s * 10.0).round() / 10.0, Deed::Shift { to_t_m: aside.to_t_m, over_m: 2.0 * half_m })
}

/// Who parks at the kerb comes along its lane, and leaves it on so much of its way; it is at the kerb so far before it stands. [m]
const PULLS_OVER_M: f64 = 20.0;
const AT_KERB_M: f64 = 1.0;

/// Whether the ego comes to the kerb where it is parked.
fn pulls_over(told: &Told, ground: &Ground) -> bool {
    told.sv.state == ContactState::Stopped && told.is_at_kerb() && ground.stands_m != 0.0
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

fn ego_plan(told: &Told, ground: &Ground, sv_s_m: f64, sv: Pose) -> ActorPlan {
    let (mut lead, mut pace) = ego_paces(told, ground, sv_s_m);
    let pulls_over = pulls_over(told, ground) && lead.is_none() && pace.driven_m > PULLS_OVER_M;
    if pulls_over {
        let brakes_s = first_time(&pace.acts);
        let braking_m = pace.driven_m - pace.speed_mps * brakes_s;
        let way_m = PULLS_OVER_M.max(braking_m + AT_KERB_M);
        let from_s = ((brakes_s - (way_m - braking_m) / pace.speed_mps) * 10.0).floor().max(0.0) / 10.0;
        pace.acts.insert(0, when(from_s, Deed::Shift { to_t_m: ground.stands_m, over_m: way_m - AT_KERB_M }));
    }
    let aside = ground.drift.or(told.sv_aside());
    if let Some(aside) = aside {
        let by_m = (aside.to_t_m - aside.from_t_m).abs();
        let least_m = if ground.drift.is_some() { DRIFTS_BY * by_m } else { 0.0 };
        let shift = shift(told, aside, &pace, least_m);
        // It leaves its line before it stops for good.
        let at = match told.sv.state.stands() {
            true => 0,
            // Acts begin in order.
            false => {
                let from_s = first_time(std::slice::from_ref(&shift));
                pace.acts.partition_point(|act| first_time(std::slice::from_ref(act)) <= from_s)
            }
        };
        match lead.as_mut().filter(|_| told.sv.state.stands()) {
            Some(lead) => lead.shifts(aside.to_t_m),
            None => pace.acts.insert(at, shift),
        }
    }
    let reverses = told.sv.state == ContactState::Reversing;
    let mut pace = match lead {
        Some(lead) if reverses || lead.reverses() => {
            let (plan, begin) = along_line(told, pace, sv);
            return phases::before(lead, plan, begin, None);
        }
        Some(lead) => lead.then(pace),
        None => pace,
    };
    let from_m =
        aside.map_or(if pulls_over { 0.0 } else { ground.stands_m }, |aside| match goes_out(aside, &mut pace) {
            true => aside.to_t_m,
            false => aside.from_t_m,
        });
    let lane = |s_m: f64| Place::Lane {
        road: ground.route[0].clone(),
        lane: ground.lane,
        along: Along::FromStart(s_m),
        t_m: from_m,
        heading_deg: 0.0,
    };
    if reverses {
        return along_line(told, pace, sv).0;
    }
    let start_m = sv_s_m - pace.driven_m;
    let course = if pace.driven_m == 0.0 {
        Vec::new()
    } else {
        vec![Leg::Lanes { roads: ground.route.clone(), until_m: None, lane: None, against: false, reverse: false }]
    };
    // Where it begins inside of the junction, it is on no lane of its first road.
    let start = if start_m > ground.first_m() {
        let pose = ground.pose(start_m, ground.drift.map_or(0.0, |drift| drift.from_t_m));
        Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
    } else {
        lane(start_m)
    };
    ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(start) }
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

fn partner(told: &Told, staging: &Staging) -> (Vec<Actor>, Vec<ObjectSpec>) {
    let cp = &told.cp;
    let at = |pose: Pose| Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees());
    let (length_m, width_m) = size_of(cp);
    if let Some(thing) = told.thing
        && cp.state.stands()
        && staging.door.is_none()
    {
        let size = Some(Size { length_m, width_m });
        return (Vec::new(), vec![ObjectSpec { kind: things::obstacle_kind(thing, told), at: at(staging.cp), size }]);
    }
    if told.is_thrown() {
        return (thrown::thrown(told, staging), Vec::new());
    }
    let (lead, pace) = partner_paces(told, staging);
    let arm_m = recrash_roads::arm_m(cp.kind, length_m);
    let actor = |plan: ActorPlan| Actor {
        id: "cp".to_owned(),
        kind: cp.kind,
        size: cp.size,
        mass_kg: told.thing.filter(|_| !told.gate_swings).and_then(things::mass_kg),
        parts: told.rig.iter().map(Rig::part).collect(),
        plan,
    };
    let driven_m = pace.driven_m;
    let (plan, begin) = match driven_m {
        0.0 => (ActorPlan::standing(at(staging.cp)), staging.cp),
        _ => course_to(told, staging, pace, at),
    };
    let own = OwnWay { course: plan.course.clone(), begin, driven_m };
    let plan = match lead {
        Some(lead) => phases::before(lead, plan, begin, lateral::came_over(told, &staging.ground, arm_m)),
        None => lateral::turns_off(told, staging, begin, &plan, arm_m).unwrap_or(plan),
    };
    let stands = plan.course.is_empty();
    let mut actors = vec![actor(plan)];
    if stands {
        return (actors, Vec::new());
    }
    let toucher =
        || if told.pusher_stands { thrown::grazed(told, staging) } else { thrown::nudger(told, staging, own) };
    actors.extend((told.pushed && told.thing.is_none()).then(toucher));
    (actors, Vec::new())
}

/// The partner's last way: its legs, where it begins, and how far it is.
pub(crate) struct OwnWay {
    pub(crate) course: Vec<Leg>,
    pub(crate) begin: Pose,
    pub(crate) driven_m: f64,
}

/// The line by which the partner comes to the contact, as long as its pace needs. Of who turns as it touches a bend is the last of it.
fn course_to(told: &Told, staging: &Staging, pace: Pace, at: impl Fn(Pose) -> Place) -> (ActorPlan, Pose) {
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
pub(crate) const LEAST_BEFORE_M: f64 = 1.0;

/// The same to where it touches, or begins its last bend.
pub(crate) fn line_to(told: &Told, staging: &Staging, pace: Pace, at: impl Fn(Pose) -> Place) -> (ActorPlan, Pose) {
    let cp = &told.cp;
    let ground = &staging.ground;
    if let Some(begin_m) = staging.cp_follows_m.map(|at_m| at_m - pace.driven_m)
        && (0.0..ground.first_m()).contains(&begin_m)
    {
        let legs =
            vec![Leg::Lanes { roads: ground.route.clone(), until_m: None, lane: None, against: false, reverse: false }];
        let begin = ground.sv_pose(begin_m);
        let plan =
            ActorPlan { speed_mps: pace.speed_mps, course: legs, acts: pace.acts, ..ActorPlan::standing(at(begin)) };
        return (plan, begin);
    }
    let reverse = cp.state == ContactState::Reversing;
    let gear = if reverse { -1.0 } else { 1.0 };
    let arm_m = recrash_roads::arm_m(cp.kind, size_of(cp).0);
    let motion = |heading: f64| Vec2::from_heading(heading) * gear;
    let beyond =
        Pose { position: staging.cp.position + motion(staging.cp.heading) * beyond_m(cp.speed_mps), ..staging.cp };
    let length = |start: Pose| -> Option<f64> {
        let mut course = Course::begin(arm_m);
        course.curve(start, staging.cp, reverse).then(|| course.length_m())
    };
    // As far back as makes the line as long as what is driven.
    let fitted = |aside: bool| -> Option<Pose> {
        let mut back_m = pace.driven_m;
        for _ in 0..30 {
            let found = length(start(told, staging, back_m, aside, motion))?;
            back_m = (back_m + pace.driven_m - found).max(0.1);
        }
        let begin = start(told, staging, back_m, aside, motion);
        length(begin).is_some_and(|found| (found - pace.driven_m).abs() < 0.02).then_some(begin)
    };
    let on_lanes = with_its_turn(told, staging, &pace, arm_m)
        .or_else(|| lateral::keeps_lane(told, staging, &pace, arm_m))
        .or_else(|| lateral::comes_by(told, staging, &pace, arm_m))
        .or_else(|| lateral::changed_behind(told, staging, &pace, arm_m))
        .or_else(|| lateral::turns_in(told, staging, &pace, arm_m))
        .or_else(|| lanes::from_lane(told, staging, &pace, arm_m));
    if let Some((begin, mut course)) = on_lanes {
        course.push(beyond);
        let course = course.into_iter().map(|pose| Leg::Curve { to: at(pose), reverse }).collect();
        let plan = ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(at(begin)) };
        return (plan, begin);
    }
    let straight = || Pose { position: staging.cp.position - motion(staging.cp.heading) * pace.driven_m, ..staging.cp };
    // What is long cannot whip round: it comes straight.
    let length_m = size_of(cp).0;
    let whips = |begin: &Pose| {
        let mut course = Course::begin(arm_m);
        let long = reverse && length_m > LONG_M;
        long && course.curve(*begin, staging.cp, reverse) && is_tight(&course, TIGHTEST_LENGTHS * length_m)
    };
    let fitted = fitted(true).or_else(|| fitted(false)).filter(|begin| !whips(begin));
    let begin = fitted.unwrap_or_else(straight);
    let course = vec![Leg::Curve { to: at(staging.cp), reverse }, Leg::Curve { to: at(beyond), reverse }];
    let plan = ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(at(begin)) };
    (plan, begin)
}

/// Nothing on wheels, longer than the first, bends its line tighter than the second, or than so much of its length. [m]
pub(crate) const WHEELED_M: f64 = 2.5;
pub(crate) const TIGHTEST_M: f64 = 4.5;
const TIGHTEST_LENGTHS: f64 = 0.5;

/// What is longer than this does not whip round in reverse. [m]
const LONG_M: f64 = 6.0;

/// Whether a line bends tighter than this somewhere.
fn is_tight(course: &Course, tightest_m: f64) -> bool {
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
fn with_its_turn(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let (ground, cp) = (&staging.ground, staging.cp);
    let reverses = told.cp.state == ContactState::Reversing;
    if !matches!(told.origin, Origin::Behind | Origin::Beside { .. }) || told.sv.turning == Turning::No || reverses {
        return None;
    }
    // It goes straight on.
    let goes_on = told.origin == Origin::Behind || told.cp.turning == Turning::No;
    if goes_on && math::wrap_angle(cp.heading - staging.cp_came).abs() < STRAIGHT_RAD {
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
    joins.iter().find_map(|&joins_m| {
        let last_m = met_m - joins_m;
        let mut join = Course::begin(arm_m);
        if !join.curve(ground.pose(last_m, beside_m), cp, false) || is_tight(&join, tightest_m(&told.cp)) {
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
    })
}

/// Who has turned by no more than this comes straight. [rad]
const STRAIGHT_RAD: f64 = 0.15;

/// Who follows through a turn is no farther beside the middle of the lane. [m]
const FOLLOWS_BESIDE_M: f64 = 0.8;

/// The way through a turn is drawn in pieces of about this length. [m]
const PIECE_M: f64 = 3.0;

/// Where the partner begins, this far back, headed as it came: in the lane it comes from, or so that an arc leads to the contact.
fn start(told: &Told, staging: &Staging, back_m: f64, aside: bool, motion: impl Fn(f64) -> Vec2) -> Pose {
    let came = staging.cp_came;
    let way = motion(came);
    let turn = math::wrap_angle(staging.cp.heading - came);
    let mut position = staging.cp.position - way * back_m;
    let turns = told.cp.turning != Turning::No && turn.abs() > 0.1;
    let line_y_m = lateral::line_y_m(told, staging).filter(|_| aside && !turns);
    let pulls_out = aside && !turns && told.passes_from_behind();
    if pulls_out {
        // Out of the ego's lane.
        position.y = if told.comes_along_kerb() { 0.0 } else { staging.sv.position.y };
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
