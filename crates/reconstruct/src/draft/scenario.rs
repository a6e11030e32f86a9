//! The scenario of a staging.

use crate::draft::signals;
use crate::ego::pace::ego_paces;
use crate::ego::plan::{GOES_ON_S, ROLLS_S, ego_plan};
use crate::ground::pieces::corner_m;
use crate::ground::way::Ground;
use crate::others::actors;
use crate::pace::lead::Lead;
use crate::pace::plain::{first_time, when};
use crate::partner::plan::partner;
use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::side::Turning;
use crate::touch::opening::Opening;
use crate::touch::staging::Staging;
use recrash_model::account::{Account, ContactState, LeftRight, Origin, PlaceKind, StandReason, told as told_of};
use recrash_model::narrative::Side;
use recrash_model::scenario::{
    ActorPlan, Author, Deed, Driveway, EgoSpec, Environment, MapSpec, MissionStop, Part, Place, SCENARIO_FORMAT,
    ScenarioDraft, Source,
};
use recrash_roads::check_on;

/// The system under test takes over this long before the contact, or before the ego began to stop. [s]
pub const HANDOVER_BEFORE_S: f64 = 5.0;

/// A system under test wants no less than this. [m/s]
const LEAST_WANTED_MPS: f64 = 2.0;

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
    map.roads[ground.own_road()].driveways.extend(begins.and_then(|begins| driveway(told, ground, begins)));
    let control = signals::devices(told, ground, &recorded, &actors);
    let handover_s = handover_s(told, lead.as_ref(), &recorded);
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

/// When the system under test takes over; never from an ego that stays parked. [s]
fn handover_s(told: &Told, lead: Option<&Lead>, recorded: &ActorPlan) -> Option<f64> {
    let usual_s = told.contact_s - HANDOVER_BEFORE_S;
    match told.sv.state {
        ContactState::Parked => None,
        _ if told.stays_at_kerb() => None,
        _ if let Some(lead) = lead => Some(lead.handover_s(usual_s)),
        // While it still rolls.
        ContactState::Stopped => Some((first_time(&recorded.acts) - ROLLS_S).clamp(0.0, usual_s)),
        _ => Some(usual_s.max(0.0)),
    }
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
    let least_mps = if stood { told.rolling_mps() } else { LEAST_WANTED_MPS };
    sets_out.fold(recorded.speed_mps.max(least_mps), f64::max)
}

/// The same with the others of the story, who go by what the two do.
fn with_others(told: &Told, staging: &Staging, mut draft: ScenarioDraft) -> ScenarioDraft {
    let known = Some(&staging.ground.network);
    let alone = (!told.extras.is_empty()).then(|| check_on(draft.clone(), known).ok()).flatten();
    if let (Some(alone), Some(recorded)) = (alone, draft.ego.recorded.as_ref()) {
        let alone = recrash_sim::rehearse(&alone.value, recrash_sim::Ego::Recorded);
        draft.actors.extend(actors::actors(told, staging, recorded, &alone));
        // Who waits ahead waits for the same light.
        draft.control = signals::devices(told, &staging.ground, recorded, &draft.actors);
    }
    draft
}

/// Somebody opens a door.
fn opens(contact_s: f64, door: &Opening, plan: &mut ActorPlan, parts: &mut Vec<Part>) {
    let (to_deg, over_s) = (door.to_deg, Opening::OPENS_S);
    parts.push(door.part.clone());
    plan.acts
        .push(when((contact_s - door.before_s).max(0.0), Deed::Part { part: door.part.id.clone(), to_deg, over_s }));
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

/// Width of a driveway, and how far it reaches behind the kerb. [m]
const DRIVEWAY_M: (f64, f64) = (7.0, 9.0);

/// None reaches farther: who begins behind its end has not come out of it. [m]
const DEEPEST_M: f64 = 20.0;

/// The driveway where a partner begins that comes out of one, beside the road that the ego is on.
fn driveway(told: &Told, ground: &Ground, begins: &Place) -> Option<Driveway> {
    let (Place::Plane { x_m, y_m, .. }, Origin::Driveway { side }) = (begins, told.origin) else { return None };
    // Of an ego that turns it is beside the road to which that turns.
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    let from_own_m = y_m - ground.sv_pose(0.0).position.y;
    let of_ego = LeftRight::of_left(from_own_m);
    // The line of a road before a junction begins at that, and leads away from it.
    let (left, s_m) = match ground.junction {
        true => (of_ego == LeftRight::Right, -x_m - corner_m(ground.lanes)),
        false => (of_ego == LeftRight::Left, x_m + ground.begins_m()),
    };
    let there = !turns && told.place != PlaceKind::Highway && side.is_none_or(|side| side == of_ego);
    let (side, there) = (if left { Side::Left } else { Side::Right }, there && s_m > 0.5 * DRIVEWAY_M.0);
    // Who rolls out of it begins deep in it.
    let begins_m = from_own_m.abs() - ground.lane_edges_m[usize::from(from_own_m < 0.0)];
    let depth_m = if told.rolls_out() { begins_m.clamp(DRIVEWAY_M.1, DEEPEST_M) } else { DRIVEWAY_M.1 };
    there.then_some(Driveway { side, s_m, width_m: DRIVEWAY_M.0, depth_m })
}
