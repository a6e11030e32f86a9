//! Others than the two: those for whom the ego stood.

use crate::came::straight_plan;
use crate::told::Told;
use crate::touch::{Staging, size_of};
use recrash_model::account::{Account, ContactState, Kind, KindGroup, Origin, Other as InStory, StandReason};
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorTrack, EventKind, Rollout};
use recrash_model::scenario::{Actor, ActorPlan, Place};
use recrash_model::vehicle::VehicleSpec;

/// Somebody that an ego stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extra {
    /// A vehicle that stands ahead of it.
    Lead,
    /// Somebody on foot who crosses its lane in front of it.
    Walker,
    /// An animal that does.
    Animal,
    /// A vehicle on the crossing road.
    Crosser,
}

impl Extra {
    /// The name of its actor.
    const fn id(self) -> &'static str {
        match self {
            Self::Lead => "lead",
            Self::Walker => "walker",
            Self::Animal => "animal",
            Self::Crosser => "crosser",
        }
    }
}

/// From the ego's front to who stands ahead, and to who crosses on foot, also between the two. [m]
const LEAD_GAP_M: f64 = 2.5;
const WALKER_GAP_M: f64 = 3.0;
const WALKER_BETWEEN_M: f64 = 0.5 * LEAD_GAP_M;

/// From the stop line to the lane of who crosses from the left. [m]
const CROSSING_LANE_M: f64 = 11.0;

/// Who crosses is in the ego's lane so long before the contact: the ego stands for it. [s]
const CROSSES_BEFORE_S: f64 = 1.0;

/// Speeds of those who cross. [m/s]
const WALKS_MPS: f64 = 1.4;
const RUNS_MPS: f64 = 3.0;
const CROSSES_MPS: f64 = 7.0;

/// Whoever stands ahead of an ego stands no farther ahead, and who crosses on foot, and in a vehicle. [m]
const AHEAD_M: f64 = 8.0;
const CROSSING_M: f64 = 30.0;

/// Why the ego stood. A crossing where nobody else is told of is nobody that it stood for, and the partner is not one of the others.
pub(crate) fn reasons(account: &Account) -> Vec<StandReason> {
    let any = |of: fn(Kind) -> bool| account.others.iter().any(|other| of(other.kind.value));
    let told = account.sv.reasons.iter().map(|fact| fact.value);
    told.filter(|reason| match reason {
        StandReason::Pedestrian => any(is_on_foot),
        StandReason::Animal => any(|kind| kind.group() == KindGroup::Animal),
        _ => true,
    })
    .collect()
}

/// Who threw the partner at the ego, where told.
pub(crate) fn pusher(account: &Account) -> Option<Kind> {
    account.others.iter().find(|other| other.touched_partner).map(|other| other.kind.value)
}

/// Two others than the ego who touch, whom nobody had touched before and of whom it is not told. Who throws the partner does so.
pub(crate) fn crash(told: &Told, rollout: &Rollout) -> Option<String> {
    let mut touched = vec![false; rollout.actors.len()];
    let id = |number: usize| rollout.actors[number].id.as_str();
    rollout.events.iter().find_map(|event| match event.kind {
        EventKind::Contact { a, b, .. } => {
            let throws = told.pushed && [id(a), id(b)].iter().all(|id| matches!(*id, "cp" | "pusher"));
            let untold = a > 0 && !touched[a] && !touched[b] && !throws;
            (touched[a], touched[b]) = (a > 0, true);
            untold.then(|| format!("{} and {} touch at {:.2} s", id(a), id(b), event.time_s))
        }
        _ => None,
    })
}

/// Whom the ego stood for, by the told reasons and the others of the story.
pub(crate) fn wanted(told: &Told, others: &[InStory]) -> Vec<Extra> {
    if told.sv.state != ContactState::Stopped || told.thing.is_some() {
        return Vec::new();
    }
    let on_foot = others.iter().any(|other| is_on_foot(other.kind.value));
    let vehicle = others.iter().any(|other| other.kind.value.is_vehicle());
    let mut list: Vec<Extra> = Vec::new();
    for reason in &told.reasons {
        let extra = match reason {
            StandReason::Queue | StandReason::LeadVehicle if told.origin != Origin::Ahead => Extra::Lead,
            StandReason::Pedestrian => Extra::Walker,
            StandReason::Animal => Extra::Animal,
            StandReason::Yield if on_foot => Extra::Walker,
            StandReason::Yield if vehicle => Extra::Crosser,
            _ => continue,
        };
        if !list.contains(&extra) {
            list.push(extra);
        }
    }
    list
}

fn is_on_foot(kind: Kind) -> bool {
    matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist)
}

/// Whether the scene holds whom the ego stood for.
pub(crate) fn holds(told: &Told, reason: StandReason, rollout: &Rollout, time_s: f64) -> bool {
    let crosses =
        |extra: Extra, within_m: f64| find(rollout, extra).any(|track| crosses(rollout, track, time_s, within_m));
    match reason {
        StandReason::Queue | StandReason::LeadVehicle => {
            find(rollout, Extra::Lead).any(|track| stands_ahead(rollout, track, time_s))
        }
        StandReason::Pedestrian => crosses(Extra::Walker, AHEAD_M),
        StandReason::Animal => crosses(Extra::Animal, AHEAD_M),
        StandReason::Yield => crosses(Extra::Walker, AHEAD_M) || crosses(Extra::Crosser, CROSSING_M),
        StandReason::Parked => told.sv.state == ContactState::Parked,
        _ => false,
    }
}

fn find(rollout: &Rollout, extra: Extra) -> impl Iterator<Item = &ActorTrack> {
    rollout.actors.iter().filter(move |track| track.id == extra.id())
}

fn stands_ahead(rollout: &Rollout, track: &ActorTrack, time_s: f64) -> bool {
    let ego = rollout.ego_track();
    let step = ((time_s * 10.0) as usize).min(ego.states.len() - 1);
    let state = &ego.states[step];
    let way = track.states[step.min(track.states.len() - 1)].position() - state.position();
    way.dot(Vec2::from_heading(state.heading)) > 0.0 && way.length() < AHEAD_M + ego.length_m
}

/// Whether somebody passes ahead of the ego, from one side of it to the other, while it stands before a time.
fn crosses(rollout: &Rollout, track: &ActorTrack, time_s: f64, within_m: f64) -> bool {
    let ego = rollout.ego_track();
    let until = ((time_s * 10.0) as usize).min(ego.states.len().min(track.states.len()) - 1);
    let beside = |step: usize| {
        let (state, other) = (&ego.states[step], &track.states[step]);
        let (ahead, way) = (Vec2::from_heading(state.heading), other.position() - state.position());
        (ahead.dot(way) - 0.5 * ego.length_m, ahead.cross(way))
    };
    (1..=until).any(|step| {
        let ((ahead_m, left_m), (_, before_m)) = (beside(step), beside(step - 1));
        let stands = ego.states[step].velocity().length() < 0.1;
        stands && (0.0..within_m).contains(&ahead_m) && left_m * before_m <= 0.0 && left_m != before_m
    })
}

/// Them, on the road.
pub(crate) fn actors(told: &Told, staging: &Staging) -> Vec<Actor> {
    // Who crosses has a road to cross on, ahead of the ego.
    let crossing = staging.ground.junction && crossing_m(staging) > 0.5 * size_of(&told.sv).0 + WALKER_GAP_M;
    let there = |extra: &&Extra| **extra != Extra::Crosser || crossing;
    told.extras.iter().filter(there).map(|extra| actor(*extra, told, staging)).collect()
}

/// From the ego to the lane of who crosses from the left. [m]
fn crossing_m(staging: &Staging) -> f64 {
    staging.ground.first_m() + CROSSING_LANE_M - staging.sv_s_m
}

fn actor(extra: Extra, told: &Told, staging: &Staging) -> Actor {
    let sv = staging.sv;
    let ahead = Vec2::from_heading(sv.heading);
    let front_m = 0.5 * size_of(&told.sv).0;
    let crossing = |ahead_m: f64, way: Vec2, speed_mps: f64| {
        let met = sv.position + ahead * ahead_m;
        straight_plan(met - way * (speed_mps * (told.contact_s - CROSSES_BEFORE_S)), way, (speed_mps, told.contact_s))
    };
    let gap_m = if told.extras.contains(&Extra::Lead) { WALKER_BETWEEN_M } else { WALKER_GAP_M };
    let (kind, plan) = match extra {
        Extra::Lead => {
            let car_m = VehicleSpec::of(PartnerKind::PassengerCar).length_m;
            let at = sv.position + ahead * (front_m + LEAD_GAP_M + 0.5 * car_m);
            let plan = ActorPlan::standing(Place::at(at.x, at.y, sv.heading.to_degrees()));
            (PartnerKind::PassengerCar, plan)
        }
        // From the kerb on the right.
        Extra::Walker => (PartnerKind::Pedestrian, crossing(front_m + gap_m, ahead.left(), WALKS_MPS)),
        Extra::Animal => (PartnerKind::Animal, crossing(front_m + gap_m, ahead.left(), RUNS_MPS)),
        Extra::Crosser => {
            let way = Vec2::from_heading(sv.heading - math::FRAC_PI_2);
            (PartnerKind::PassengerCar, crossing(crossing_m(staging), way, CROSSES_MPS))
        }
    };
    Actor { id: extra.id().to_owned(), kind, size: None, mass_kg: None, parts: Vec::new(), plan }
}
