//! How both came to where they touch: courses and speeds, told backwards from the contact.

use crate::control;
use crate::door::Opening;
use crate::ground::Ground;
use crate::lateral::{self, PULL_OUT_M};
use crate::others::{self, Extra};
use crate::phases::{self, Lead, MOVES_UP_M, Phase};
use crate::things;
use crate::told::{Aside, Side, Told, Turning};
use crate::touch::{Staging, size_of};
use recrash_model::account::{Account, ContactState, ControlDevice, Obeyed, Origin};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorState, STEP_S};
use recrash_model::scenario::{
    Act, Actor, ActorPlan, Along, Author, Deed, EgoSpec, Leg, MapSpec, MissionStop, ObjectSpec, ObstacleKind, Part,
    Place, SCENARIO_FORMAT, ScenarioDraft, Size, Source, Trigger,
};
use recrash_model::template::Movement;
use recrash_roads::Course;

/// When they touch. [s]
pub(crate) const CONTACT_S: f64 = 9.0;

/// The system under test takes over this long before the contact, or before the ego began to stop. [s]
const HANDOVER_BEFORE_S: f64 = 5.0;

/// Before it began to brake for its stop, the ego still rolls for so long under the system under test. [s]
const ROLLS_S: f64 = 1.0;

/// Deceleration of who comes to a stop before it is hit. [m/s^2]
const STOPPING_MPS2: f64 = 2.0;

/// How long others who stopped have stood when they are hit. [s]
const STOOD_S: f64 = 2.0;

/// Acceleration of who sets off. [m/s^2]
const SETS_OFF_MPS2: f64 = 1.2;

/// Acceleration of who stood before, and is under way at the contact. [m/s^2]
const STARTS_MPS2: f64 = 1.6;

/// Speed of others on their way to a stop. [m/s]
const ROLLING_MPS: f64 = 7.0;

/// Who stood behind the ego before it set off has stood for so long. [s]
const WAITED_S: f64 = 1.0;

/// How long the ego has stood when somebody who came to a stop behind it sets off. [s]
const STOOD_LONG_S: f64 = 5.0;

/// The simulators' egos drive no faster: MetaDrive cuts the engine at 80 km/h. [m/s]
const FASTEST_EGO_MPS: f64 = 80.0 / 3.6;

/// Nobody takes longer to set off. [s]
const LONGEST_START_S: f64 = 6.0;

/// Who throws the partner at the ego runs into it at this speed over its own, this long before the contact, and this far from where
/// that is. [m/s, s, m]
const PUSH_MPS: f64 = 10.0;
const THROW_S: f64 = 0.25;
const THROW_M: f64 = 1.0;

/// Who touches the partner on its way is faster than it by so much. [m/s]
const NUDGE_MPS: f64 = 2.0;

/// A course goes on behind the place of the contact, so far that nobody slows for its end before it. [m]
fn beyond_m(speed_mps: f64) -> f64 {
    20.0 + 5.0 * speed_mps
}

/// The speeds of one side until the contact: speed at the start, acts, and what is driven until then. [m/s, m]
pub(crate) struct Pace {
    pub(crate) speed_mps: f64,
    pub(crate) acts: Vec<Act>,
    pub(crate) driven_m: f64,
}

/// Stands from the start.
const STANDING: Pace = Pace { speed_mps: 0.0, acts: Vec::new(), driven_m: 0.0 };

pub(crate) fn when(time_s: f64, deed: Deed) -> Act {
    Act { id: None, when: Some(Trigger::TimeS(time_s)), delay_s: 0.0, deed }
}

fn next(deed: Deed) -> Act {
    Act { id: None, when: None, delay_s: 0.0, deed }
}

/// How the ego's speed comes to what it is at the contact.
fn ego_pace(told: &Told) -> Pace {
    let waits_behind =
        told.origin == Origin::Behind && (told.cp.state == ContactState::SettingOff || told.cp.stood_first);
    pace(&told.sv, told.choices.rolling_mps, if waits_behind { STOOD_LONG_S } else { told.choices.stood_s })
}

/// How the partner's does.
fn partner_pace(told: &Told) -> Pace {
    let cp = &told.cp;
    let ego = ego_pace(told);
    let rolling_mps = if cp.kind == PartnerKind::Pedestrian { 1.4 } else { 5.0 };
    let usual = pace(cp, rolling_mps, STOOD_S);
    // Who stood behind an ego that moved up stood behind where that was.
    let moved_up = told.sv.state.stands() && told.sv.phases.last.contains(&Phase::Drives);
    let behind_it = told.origin == Origin::Behind && (cp.state == ContactState::SettingOff || cp.stood_first);
    let usual = match start_over(cp.speed_mps, MOVES_UP_M + BEHIND_M) {
        Some(both_move_up) if moved_up && behind_it => both_move_up,
        _ => usual,
    };
    let ego_came = told.sv.phases.last.is_empty() || told.sv.phases.came;
    let same_way = matches!(told.origin, Origin::Behind | Origin::Ahead);
    let follows = matches!(told.origin, Origin::Behind | Origin::Beside { .. });
    let enters = cp.movement == Some(Movement::EnteringTraffic);
    match cp.state {
        // It came to a stop behind the ego before it set off.
        ContactState::SettingOff | ContactState::Moving
            if told.origin == Origin::Behind && ego_came && ego.driven_m > usual.driven_m && !usual.acts.is_empty() =>
        {
            let moving_s = CONTACT_S - first_time(&usual.acts);
            let braking_s = ROLLING_MPS / STOPPING_MPS2;
            let from_s = ((CONTACT_S - moving_s - WAITED_S - braking_s) * 10.0).floor() / 10.0;
            let mut acts = vec![when(from_s, Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None })];
            acts.extend(usual.acts);
            let driven_m = ROLLING_MPS * from_s + 0.5 * ROLLING_MPS * braking_s + usual.driven_m;
            Pace { speed_mps: ROLLING_MPS, acts, driven_m }
        }
        // It slows with the ego that it follows.
        ContactState::Moving if told.sv.slowed_from.is_some() && follows && usual.driven_m < ego.driven_m + 5.0 => {
            let from_mps = (ego.speed_mps + FOLLOWS_BY_MPS).max(cp.speed_mps);
            let braking_s = CONTACT_S - first_time(&ego.acts);
            let brake =
                Deed::Speed { to_mps: cp.speed_mps, rate_mps2: ((from_mps - cp.speed_mps) / braking_s).max(0.05) };
            let driven_m = from_mps * (CONTACT_S - braking_s) + 0.5 * (from_mps + cp.speed_mps) * braking_s;
            Pace { speed_mps: from_mps, acts: vec![when(CONTACT_S - braking_s, brake)], driven_m }
        }
        // Who is ahead and slower has not come from behind the ego: it has just set off.
        ContactState::Moving if same_way && told.origin == Origin::Ahead && usual.driven_m > ego.driven_m - 0.3 => {
            sets_off(cp.speed_mps, (0.8 * ego.driven_m).max(0.2))
        }
        ContactState::Reversing => start_over(cp.speed_mps, REVERSES_M).unwrap_or(usual),
        // Who comes from the kerb or out of a stall stood there.
        ContactState::Moving if told.stood_beside() || enters && from_stand(told.origin) => {
            let moving_s = (2.0 * PULL_OUT_M / cp.speed_mps * 10.0).round() / 10.0;
            let go = Deed::Speed { to_mps: cp.speed_mps, rate_mps2: cp.speed_mps / moving_s };
            Pace { speed_mps: 0.0, acts: vec![when(CONTACT_S - moving_s, go)], driven_m: 0.5 * cp.speed_mps * moving_s }
        }
        // Who stood and turned has room for its turn.
        ContactState::Moving if cp.stood_first && matches!(cp.turning, Turning::Left | Turning::Right) => {
            start_over(cp.speed_mps, TURNS_M).unwrap_or(usual)
        }
        ContactState::Stopped if told.origin == Origin::Ahead && usual.driven_m > ego.driven_m - 0.3 => STANDING,
        _ => usual,
    }
}

/// How far somebody who stood before it turned has driven at the contact. [m]
const TURNS_M: f64 = 8.0;

/// Who stands behind the ego stands so far behind it. [m]
const BEHIND_M: f64 = 2.0;

/// How far somebody has reversed at the contact. [m]
const REVERSES_M: f64 = 2.5;

fn from_stand(origin: Origin) -> bool {
    !matches!(origin, Origin::Cross { .. } | Origin::Behind | Origin::Opposite)
}

pub(crate) fn first_time(acts: &[Act]) -> f64 {
    acts.iter()
        .find_map(|act| match act.when {
            Some(Trigger::TimeS(time_s)) => Some(time_s),
            _ => None,
        })
        .unwrap_or(0.0)
}

/// From a stand to a speed within a distance, or less.
fn sets_off(speed_mps: f64, within_m: f64) -> Pace {
    let moving_s =
        ((2.0 * within_m / speed_mps.max(0.05)).min(speed_mps / SETS_OFF_MPS2) * 10.0).floor().max(2.0) / 10.0;
    let rate_mps2 = (speed_mps / moving_s).clamp(0.05, 8.0);
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Pace { speed_mps: 0.0, acts: vec![when(CONTACT_S - moving_s, go)], driven_m: 0.5 * speed_mps * moving_s }
}

/// How somebody's speed comes to what it is at the contact.
fn pace(side: &Side, rolling_mps: f64, stood_s: f64) -> Pace {
    match side.state {
        ContactState::Parked => STANDING,
        ContactState::Stopped => {
            let braking_s = rolling_mps / STOPPING_MPS2;
            let from_s = ((CONTACT_S - stood_s - braking_s) * 10.0).floor() / 10.0;
            let driven_m = rolling_mps * from_s + 0.5 * rolling_mps * braking_s;
            let acts = vec![
                when(from_s, Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None }),
                next(Deed::Hold { for_s: None }),
            ];
            Pace { speed_mps: rolling_mps, acts, driven_m }
        }
        ContactState::Moving if side.stood_first => {
            let moving_s = ((side.speed_mps / STARTS_MPS2).min(LONGEST_START_S) * 10.0).ceil().max(5.0) / 10.0;
            let go = Deed::Speed { to_mps: side.speed_mps, rate_mps2: side.speed_mps / moving_s };
            let driven_m = 0.5 * side.speed_mps * moving_s;
            Pace { speed_mps: 0.0, acts: vec![when(CONTACT_S - moving_s, go)], driven_m }
        }
        ContactState::SettingOff | ContactState::Reversing => {
            // So that it sets off at a step: the rate gives way.
            let moving_s = ((side.speed_mps / SETS_OFF_MPS2).min(LONGEST_START_S) * 10.0).ceil().max(5.0) / 10.0;
            let rate_mps2 = (side.speed_mps / moving_s).max(0.05);
            let driven_m = 0.5 * side.speed_mps * moving_s;
            let go = Deed::Speed { to_mps: side.speed_mps, rate_mps2 };
            Pace { speed_mps: 0.0, acts: vec![when(CONTACT_S - moving_s, go)], driven_m }
        }
        ContactState::Moving if side.slowed_from.is_some() => slows(side),
        ContactState::Moving => {
            Pace { speed_mps: side.speed_mps, acts: Vec::new(), driven_m: side.speed_mps * CONTACT_S }
        }
    }
}

/// It brakes down to its speed at the contact.
fn slows(side: &Side) -> Pace {
    let told_mps = side.slowed_from.and_then(|slowed| slowed.0).filter(|from| *from > side.speed_mps + 1.0);
    let from_mps = told_mps.unwrap_or(side.speed_mps + SLOWS_BY_MPS).min(side.speed_mps + MOST_SLOWED_MPS);
    let by_mps = from_mps - side.speed_mps;
    let braking_s = (by_mps / SLOWS_MPS2 * 10.0).ceil() / 10.0;
    let brake = Deed::Speed { to_mps: side.speed_mps, rate_mps2: by_mps / braking_s };
    let driven_m = from_mps * (CONTACT_S - braking_s) + 0.5 * (from_mps + side.speed_mps) * braking_s;
    Pace { speed_mps: from_mps, acts: vec![when(CONTACT_S - braking_s, brake)], driven_m }
}

/// Who follows an ego that slows is faster than it by so much before. [m/s]
const FOLLOWS_BY_MPS: f64 = 1.0;

/// Who slowed before the contact came faster by so much where nobody says from which speed, at most so much, and brakes so. [m/s, m/s,
/// m/s^2]
const SLOWS_BY_MPS: f64 = 4.0;
const MOST_SLOWED_MPS: f64 = 12.0;
const SLOWS_MPS2: f64 = 2.5;

/// Who stood before a junction, and is in it at the contact, sets off from its stop line.
fn from_line(told: &Told, ground: &Ground, sv_s_m: f64) -> Option<Pace> {
    let sv = &told.sv;
    let stops = match sv.control.filter(|said| said.obeyed != Some(Obeyed::No)) {
        Some(said) => sv.state == ContactState::SettingOff || sv.stood_first || said.device == ControlDevice::StopSign,
        None => sv.stood_first,
    };
    let stops = stops && matches!(sv.state, ContactState::SettingOff | ContactState::Moving);
    let driven_m = sv_s_m - (ground.first_m() - 0.5 * size_of(sv).0 - AT_LINE_M);
    if !stops || !ground.junction {
        return None;
    }
    start_over(sv.speed_mps, driven_m)
}

/// Who stood beside the ego before a junction sets off from the same line.
fn beside_from_line(told: &Told, staging: &Staging) -> Option<Pace> {
    let (cp, ground) = (&told.cp, &staging.ground);
    if !cp.stood_first || !ground.junction || !matches!(told.origin, Origin::Beside { .. }) {
        return None;
    }
    let line_m = ground.first_m() - 0.5 * size_of(cp).0 - AT_LINE_M;
    start_over(cp.speed_mps, ground.beside(staging.cp.position).0 - line_m)
}

/// From a stand to a speed, and so far: it gains its speed on the way, or earlier and keeps it.
pub(crate) fn start_over(speed_mps: f64, driven_m: f64) -> Option<Pace> {
    if driven_m < 0.3 {
        return None;
    }
    let rate_mps2 = (0.5 * speed_mps * speed_mps / driven_m).max(SETS_OFF_MPS2);
    let gaining_s = speed_mps / rate_mps2;
    let moving_s = gaining_s + (driven_m - 0.5 * speed_mps * gaining_s) / speed_mps;
    if moving_s > CONTACT_S - 1.0 || rate_mps2 > STRONGEST_START_MPS2 {
        return None;
    }
    // It sets off at a step.
    let from_s = ((CONTACT_S - moving_s) * 10.0).round() / 10.0;
    let go = Deed::Speed { to_mps: speed_mps, rate_mps2 };
    Some(Pace { speed_mps: 0.0, acts: vec![when(from_s, go)], driven_m })
}

/// Nobody sets off harder. [m/s^2]
const STRONGEST_START_MPS2: f64 = 5.0;

/// Who stops at a line stops so far before it. [m]
const AT_LINE_M: f64 = 0.5;

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
            Some(cp) => opens(door, &mut cp.plan, &mut cp.parts),
            None => opens(door, &mut recorded, &mut parts),
        }
    }
    actors.extend(others::actors(told, staging));
    let control = control::devices(told, ground);
    let handover_s = match told.sv.state {
        ContactState::Parked => None,
        _ if let Some(lead) = &lead => Some(lead.handover_s(CONTACT_S - HANDOVER_BEFORE_S)),
        // While it still rolls.
        ContactState::Stopped => Some((first_time(&recorded.acts) - ROLLS_S).clamp(0.0, CONTACT_S - HANDOVER_BEFORE_S)),
        _ => Some((CONTACT_S - HANDOVER_BEFORE_S).max(0.0)),
    };
    let wanted_mps = told.sv.speed_mps.max(if told.sv.state.stands() { told.choices.rolling_mps } else { 2.0 });
    let target_speed_mps = wanted_mps.min(FASTEST_EGO_MPS);
    let id: String =
        account.incident.chars().filter(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_')).take(40).collect();
    ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: format!("incident-{id}"),
        source: Source {
            records: account.reports.clone(),
            origin: Some(recrash_model::narrative::Origin::Own),
            author: Author::Rules,
            ..Source::default()
        },
        map: MapSpec::G(ground.map.clone()),
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
        duration_s: 14.0,
        ..ScenarioDraft::default()
    }
}

/// Somebody opens a door.
fn opens(door: &Opening, plan: &mut ActorPlan, parts: &mut Vec<Part>) {
    let (to_deg, over_s) = (door.to_deg, Opening::OPENS_S);
    parts.push(door.part.clone());
    plan.acts.push(when(CONTACT_S - door.before_s, Deed::Part { part: door.part.id.clone(), to_deg, over_s }));
}

/// Where the task of the system under test has it stop: where it stood, unless something in the scene makes it stop there. What
/// made the recorded driver stop is then part of the task.
fn mission_stop(told: &Told, staging: &Staging) -> Vec<MissionStop> {
    let at_line = staging.ground.junction && told.sv.control.is_some();
    if told.sv.state != ContactState::Stopped || told.extras.contains(&Extra::Lead) || at_line {
        return Vec::new();
    }
    vec![MissionStop { s_m: staging.sv_s_m, t_m: 0.0, for_s: None }]
}

/// Straight on at a speed.
pub(crate) fn straight_plan(start: Vec2, way: Vec2, speed_mps: f64) -> ActorPlan {
    let degrees = math::atan2(way.y, way.x).to_degrees();
    let to = start + way * (speed_mps * CONTACT_S + beyond_m(speed_mps));
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
    if told.sv_aside().is_none() {
        return Some(on_way);
    }
    let alone = ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id: "alone".to_owned(),
        map: MapSpec::G(ground.map.clone()),
        ego: EgoSpec {
            kind: told.sv.kind,
            size: told.sv.size,
            lane: ground.lane,
            target_speed_mps: 10.0,
            route: ground.route.clone(),
            recorded: Some(ego_plan(told, ground, sv_s_m, on_way)),
            ..EgoSpec::default()
        },
        duration_s: 14.0,
        ..ScenarioDraft::default()
    };
    let scenario = recrash_roads::check(alone).ok()?.value;
    let rollout = recrash_sim::simulate(&scenario, recrash_sim::Ego::Recorded);
    rollout.ego_track().states.get((CONTACT_S / STEP_S).round() as usize).map(ActorState::pose)
}

/// How long a lane change or a drift takes, and the least and the most that is driven meanwhile. [s, m]
const ASIDE_S: f64 = 4.0;
const ASIDE_M: (f64, f64) = (14.0, 60.0);

/// The move out of the ego's line, half done at the contact.
fn shift(aside: Aside, pace: &Pace, speed_mps: f64) -> Act {
    let half_m = (0.5 * ASIDE_S * speed_mps).clamp(0.5 * ASIDE_M.0, 0.5 * ASIDE_M.1);
    let drives = pace.speed_mps > 0.0;
    let (half_m, from_s) = if half_m < pace.driven_m && drives {
        (half_m, CONTACT_S - half_m / speed_mps)
    } else {
        (pace.driven_m.max(1.0), first_time(&pace.acts))
    };
    when((from_s * 10.0).round() / 10.0, Deed::Shift { to_t_m: aside.to_t_m, over_m: 2.0 * half_m })
}

/// What the ego did before its last phase where that is told, and its last pace.
fn ego_paces(told: &Told, ground: &Ground, sv_s_m: f64) -> (Option<Lead>, Pace) {
    let usual = from_line(told, ground, sv_s_m).unwrap_or_else(|| ego_pace(told));
    match phases::lead(told, &usual) {
        Some(lead) if told.sv.state.stands() => (Some(lead), STANDING),
        lead => (lead, usual),
    }
}

fn ego_plan(told: &Told, ground: &Ground, sv_s_m: f64, sv: Pose) -> ActorPlan {
    let (lead, mut pace) = ego_paces(told, ground, sv_s_m);
    let aside = told.sv_aside();
    pace.acts.extend(aside.map(|aside| shift(aside, &pace, told.sv.speed_mps)));
    let reverses = told.sv.state == ContactState::Reversing;
    let pace = match lead {
        Some(lead) if reverses || lead.reverses() => {
            return phases::to_and_fro(lead, pace, sv, (reverses, beyond_m(told.sv.speed_mps)));
        }
        Some(lead) => lead.then(pace),
        None => pace,
    };
    let lane = |s_m: f64| Place::Lane {
        road: ground.route[0].clone(),
        lane: ground.lane,
        along: Along::FromStart(s_m),
        t_m: aside.map_or(0.0, |aside| aside.from_t_m),
        heading_deg: 0.0,
    };
    if reverses {
        let back = Vec2::from_heading(sv.heading);
        let start = sv.position + back * pace.driven_m;
        let to = sv.position - back * beyond_m(told.sv.speed_mps);
        let degrees = sv.heading.to_degrees();
        return ActorPlan {
            speed_mps: 0.0,
            course: vec![Leg::Curve { to: Place::at(to.x, to.y, degrees), reverse: true }],
            acts: pace.acts,
            ..ActorPlan::standing(Place::at(start.x, start.y, degrees))
        };
    }
    let start_m = sv_s_m - pace.driven_m;
    let course = if pace.driven_m == 0.0 {
        Vec::new()
    } else {
        vec![Leg::Lanes { roads: ground.route.clone(), until_m: None, lane: None, against: false, reverse: false }]
    };
    // Where it begins inside of the junction, it is on no lane of its first road.
    let start = if start_m > ground.first_m() {
        let pose = ground.sv_pose(start_m);
        Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
    } else {
        lane(start_m)
    };
    ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(start) }
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
        return (Vec::new(), vec![ObjectSpec { kind: obstacle_kind(thing), at: at(staging.cp), size }]);
    }
    if told.is_thrown() {
        return (thrown(told, staging), Vec::new());
    }
    let from_stand =
        things::pace(told).or_else(|| beside_from_line(told, staging)).or_else(|| lateral::from_kerb(told, staging));
    let pace = from_stand.unwrap_or_else(|| partner_pace(told));
    let actor = |plan: ActorPlan| Actor {
        id: "cp".to_owned(),
        kind: cp.kind,
        size: cp.size,
        mass_kg: None,
        parts: Vec::new(),
        plan,
    };
    if pace.driven_m == 0.0 {
        return (vec![actor(ActorPlan::standing(at(staging.cp)))], Vec::new());
    }
    let mut actors = vec![actor(course_to(told, staging, pace, at))];
    actors.extend((told.pushed && told.thing.is_none()).then(|| nudger(told, staging)));
    (actors, Vec::new())
}

/// Who touched the partner on its way: it comes up from behind and runs into it, right before the contact. What is told of that
/// first contact beside that there was one is not shown.
fn nudger(told: &Told, staging: &Staging) -> Actor {
    let (cp, gear) = (&told.cp, if told.cp.state == ContactState::Reversing { -1.0 } else { 1.0 });
    let way = Vec2::from_heading(staging.cp.heading) * gear;
    let car_m = recrash_model::vehicle::VehicleSpec::of(PartnerKind::PassengerCar).length_m;
    let speed_mps = cp.speed_mps + NUDGE_MPS;
    let touches = staging.cp.position - way * (cp.speed_mps * THROW_S + 0.5 * (size_of(cp).0 + car_m));
    let start = touches - way * (speed_mps * (CONTACT_S - THROW_S));
    let degrees = staging.cp.heading.to_degrees() + if gear < 0.0 { 180.0 } else { 0.0 };
    let place = |point: Vec2| Place::at(point.x, point.y, degrees);
    let plan = ActorPlan {
        speed_mps,
        course: vec![Leg::Curve { to: place(touches + way * beyond_m(speed_mps)), reverse: false }],
        ..ActorPlan::standing(place(start))
    };
    Actor {
        id: "pusher".to_owned(),
        kind: PartnerKind::PassengerCar,
        size: None,
        mass_kg: None,
        parts: Vec::new(),
        plan,
    }
}

/// The line by which the partner comes to the contact, as long as its pace needs.
fn course_to(told: &Told, staging: &Staging, pace: Pace, at: impl Fn(Pose) -> Place) -> ActorPlan {
    let cp = &told.cp;
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
        .or_else(|| lateral::turns_in(told, staging, &pace, arm_m));
    if let Some((begin, mut course)) = on_lanes {
        course.push(beyond);
        let course = course.into_iter().map(|pose| Leg::Curve { to: at(pose), reverse }).collect();
        return ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(at(begin)) };
    }
    let straight = || Pose { position: staging.cp.position - motion(staging.cp.heading) * pace.driven_m, ..staging.cp };
    let begin = fitted(true).or_else(|| fitted(false)).unwrap_or_else(straight);
    let course = vec![Leg::Curve { to: at(staging.cp), reverse }, Leg::Curve { to: at(beyond), reverse }];
    ActorPlan { speed_mps: pace.speed_mps, course, acts: pace.acts, ..ActorPlan::standing(at(begin)) }
}

/// Who turns with the ego, behind it or beside it, comes by its way: where it begins, and the poses that it drives by to the contact.
fn with_its_turn(told: &Told, staging: &Staging, pace: &Pace, arm_m: f64) -> Option<(Pose, Vec<Pose>)> {
    let (ground, cp) = (&staging.ground, staging.cp);
    let reverses = told.cp.state == ContactState::Reversing;
    if !matches!(told.origin, Origin::Behind | Origin::Beside { .. }) || told.sv.turning == Turning::No || reverses {
        return None;
    }
    let (met_m, beside_m) = ground.beside(cp.position);
    [3.0, 5.0, 8.0].into_iter().find_map(|joins_m| {
        let last_m = met_m - joins_m;
        let mut join = Course::begin(arm_m);
        if !join.curve(ground.pose(last_m, beside_m), cp, false) {
            return None;
        }
        let begin_m = last_m - (pace.driven_m - join.length_m());
        let turn_m = (last_m - ground.first_m()).max(0.0);
        let steps = (turn_m / PIECE_M).ceil() as usize;
        let on_way = (0..=steps).map(|step| last_m - turn_m * (1.0 - step as f64 / steps.max(1) as f64));
        let on_way = on_way.filter(|s_m| *s_m > begin_m + 0.5).map(|s_m| ground.pose(s_m, beside_m));
        (begin_m < last_m - 1.0).then(|| (ground.pose(begin_m, beside_m), on_way.chain([cp]).collect()))
    })
}

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
    let pulls_out = aside && !turns && told.origin == Origin::Behind && told.cp.movement == Some(Movement::Passing);
    if pulls_out {
        // Out of the ego's lane.
        position.y = staging.sv.position.y;
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

/// The partner stands behind the ego, or comes along behind it, and another runs into it: a car at [`PUSH_MPS`] over its speed.
fn thrown(told: &Told, staging: &Staging) -> Vec<Actor> {
    let cp = &told.cp;
    let way = Vec2::from_heading(staging.cp.heading);
    let degrees = staging.cp.heading.to_degrees();
    let at = |back_m: f64| staging.cp.position - way * back_m;
    let place = |point: Vec2| Place::at(point.x, point.y, degrees);
    let on = |speed_mps: f64, from: Vec2, acts: Vec<Act>| ActorPlan {
        speed_mps,
        course: vec![Leg::Curve { to: place(staging.cp.position + way * beyond_m(speed_mps)), reverse: false }],
        acts,
        ..ActorPlan::standing(place(from))
    };
    let actor =
        |id: &str, kind, size, plan| Actor { id: id.to_owned(), kind, size, mass_kg: None, parts: Vec::new(), plan };
    let braking_s = ROLLING_MPS / STOPPING_MPS2;
    let from_s = ((CONTACT_S - STOOD_S - braking_s) * 10.0).floor() / 10.0;
    let driven_m = ROLLING_MPS * from_s + 0.5 * ROLLING_MPS * braking_s;
    let ego_drives_mps = if told.sv.state.stands() { 0.0 } else { told.sv.speed_mps };
    let (partner, pusher_mps) = if told.sv.state == ContactState::Parked {
        (ActorPlan::standing(place(at(THROW_M))), PUSH_MPS)
    } else if ego_drives_mps > 0.0 {
        (on(ego_drives_mps, at(THROW_M + ego_drives_mps * CONTACT_S), Vec::new()), ego_drives_mps + PUSH_MPS)
    } else {
        let stop =
            vec![when(from_s, Deed::Stop { rate_mps2: STOPPING_MPS2, at_m: None }), next(Deed::Hold { for_s: None })];
        (on(ROLLING_MPS, at(THROW_M + driven_m), stop), PUSH_MPS)
    };
    let (length_m, car_m) =
        (size_of(cp).0, recrash_model::vehicle::VehicleSpec::of(PartnerKind::PassengerCar).length_m);
    let until_m = THROW_M + 0.5 * (length_m + car_m) + pusher_mps * (CONTACT_S - THROW_S);
    let behind_m = until_m + ego_drives_mps * THROW_S;
    vec![
        actor("cp", cp.kind, cp.size, partner),
        actor("pusher", PartnerKind::PassengerCar, None, on(pusher_mps, at(behind_m), Vec::new())),
    ]
}

fn obstacle_kind(kind: recrash_model::account::Kind) -> ObstacleKind {
    use recrash_model::account::Kind;
    match kind {
        Kind::Wall => ObstacleKind::Wall,
        Kind::Pole => ObstacleKind::Pole,
        Kind::Curb => ObstacleKind::Kerb,
        Kind::Gate => ObstacleKind::Gate,
        Kind::Chain => ObstacleKind::Chain,
        Kind::Barrier => ObstacleKind::Barrier,
        Kind::Cone => ObstacleKind::Cone,
        Kind::Sign => ObstacleKind::Warning,
        Kind::Pothole => ObstacleKind::Pothole,
        _ => ObstacleKind::Debris,
    }
}
