//! Names, counts and ranges of everybody with a plan.

use crate::check::remarks::{At, Remarks, name, shown};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::{
    Actor, ActorPlan, Along, Control, Deed, Device, Leg, Part, PartKind, Place, ScenarioDraft, Size, Trigger,
};
use recrash_model::vehicle::VehicleSpec;
use std::collections::BTreeSet;

/// Acts of one plan, legs of one course, parts of one road user, at most.
const MOST_ACTS: usize = 64;
const MOST_LEGS: usize = 32;
const MOST_PARTS: usize = 8;

/// Checks ids, counts and ranges of everybody with a plan; whether geometry can be built from them.
pub(in crate::check) fn numbers(draft: &ScenarioDraft, remarks: &mut Remarks) -> bool {
    let before = remarks.errors();
    remarks.count("actors", draft.actors.len(), 32);
    remarks.count("objects", draft.objects.len(), 64);
    remarks.count("control", draft.control.len(), 32);
    remarks.number("after_contact_s", draft.after_contact_s, 0.0, 30.0, "s");
    let mut ids: BTreeSet<&str> = draft.partners.iter().map(|partner| partner.id.as_str()).collect();
    for (position, each) in draft.actors.iter().enumerate() {
        actor(each, format_args!("actors[{position}]"), &mut ids, remarks);
    }
    for (position, object) in draft.objects.iter().enumerate() {
        place(&object.at, format_args!("objects[{position}].at"), remarks);
        size(object.size, format_args!("objects[{position}].size"), remarks);
    }
    ego(draft, remarks);
    for (position, each) in draft.control.iter().enumerate() {
        control(each, format_args!("control[{position}]"), remarks);
    }
    remarks.errors() == before
}

/// A road user with a plan; its id is none of those before.
fn actor<'a>(actor: &'a Actor, path: At<'_>, ids: &mut BTreeSet<&'a str>, remarks: &mut Remarks) {
    name(format_args!("{path}.id"), &actor.id, 32, "_-", remarks);
    if actor.id == EGO_ID {
        remarks.error("scenario.id", format!("{path}.id"), "\"ego\" is the ego's own name", "choose another id");
    } else if !ids.insert(&actor.id) {
        let message = format!("somebody before has the id {:?} too", actor.id.chars().take(40).collect::<String>());
        remarks.error("scenario.duplicate-id", format!("{path}.id"), message, "give each road user its own id");
    }
    size(actor.size, format_args!("{path}.size"), remarks);
    if let Some(mass_kg) = actor.mass_kg {
        remarks.number(format_args!("{path}.mass_kg"), mass_kg, 0.1, 60_000.0, "kg");
    }
    parts(&actor.parts, path, remarks);
    plan(&actor.plan, actor.kind, format_args!("{path}.plan"), remarks);
}

/// The ego's body, its recorded driver, and where it is to stop.
fn ego(draft: &ScenarioDraft, remarks: &mut Remarks) {
    let ego = &draft.ego;
    size(ego.size, format_args!("ego.size"), remarks);
    parts(&ego.parts, format_args!("ego"), remarks);
    if let Some(recorded) = &ego.recorded {
        plan(recorded, ego.kind, format_args!("ego.recorded"), remarks);
    }
    if let Some(handover_s) = ego.handover_s {
        remarks.number("ego.handover_s", handover_s, 0.0, draft.duration_s.max(0.0), "s");
        if ego.recorded.is_none() {
            let hint = "give ego.recorded, or leave handover_s out";
            remarks.error("scenario.handover", "ego.handover_s", "there is nobody to take over from", hint);
        }
    }
    remarks.count("ego.stops", ego.stops.len(), 16);
    for (position, stop) in ego.stops.iter().enumerate() {
        remarks.number(format_args!("ego.stops[{position}].s_m"), stop.s_m, 0.0, 2000.0, "m");
        remarks.number(format_args!("ego.stops[{position}].t_m"), stop.t_m, -10.0, 10.0, "m");
        if let Some(for_s) = stop.for_s {
            remarks.number(format_args!("ego.stops[{position}].for_s"), for_s, 0.0, 120.0, "s");
        }
        if position > 0 && stop.s_m <= ego.stops[position - 1].s_m {
            let hint = format!("allowed: more than {} m", shown(ego.stops[position - 1].s_m));
            let at = format!("ego.stops[{position}].s_m");
            remarks.error("scenario.stops", at, "stops stand in the order of driving", hint);
        }
    }
}

/// A signal or a sign, and the phases of a signal.
fn control(control: &Control, path: At<'_>, remarks: &mut Remarks) {
    remarks.number(format_args!("{path}.set_back_m"), control.set_back_m, 0.0, 200.0, "m");
    let Device::Signal { program, offset_s } = &control.device else { return };
    remarks.number(format_args!("{path}.device.signal.offset_s"), *offset_s, 0.0, 3600.0, "s");
    if program.is_empty() || program.len() > 16 {
        let message = format!("the program has {} phases", program.len());
        let at = format!("{path}.device.signal.program");
        remarks.error("scenario.signal", at, message, "allowed: 1 to 16 phases");
    }
    for (number, phase) in program.iter().enumerate() {
        let at = format_args!("{path}.device.signal.program[{number}].for_s");
        remarks.number(at, phase.for_s, 0.1, 600.0, "s");
    }
}

/// The length and width of a body.
fn size(size: Option<Size>, path: At<'_>, remarks: &mut Remarks) {
    if let Some(size) = size {
        remarks.number(format_args!("{path}.length_m"), size.length_m, 0.05, 40.0, "m");
        remarks.number(format_args!("{path}.width_m"), size.width_m, 0.05, 20.0, "m");
    }
}

/// Where somebody or something stands.
fn place(place: &Place, path: At<'_>, remarks: &mut Remarks) {
    let heading_deg = match place {
        Place::Lane { along, t_m, heading_deg, .. } => {
            let (field, value) = match along {
                Along::FromStart(s_m) => ("s_m", s_m),
                Along::BeforeEnd(to_end_m) => ("to_end_m", to_end_m),
            };
            remarks.number(format_args!("{path}.{field}"), *value, -200.0, 2000.0, "m");
            remarks.number(format_args!("{path}.t_m"), *t_m, -50.0, 50.0, "m");
            heading_deg
        }
        Place::Plane { x_m, y_m, heading_deg } => {
            remarks.number(format_args!("{path}.x_m"), *x_m, -2000.0, 2000.0, "m");
            remarks.number(format_args!("{path}.y_m"), *y_m, -2000.0, 2000.0, "m");
            heading_deg
        }
    };
    remarks.number(format_args!("{path}.heading_deg"), *heading_deg, -360.0, 360.0, "deg");
}

/// What hangs on a body: trailers, doors, arms.
fn parts(parts: &[Part], path: At<'_>, remarks: &mut Remarks) {
    remarks.count(format_args!("{path}.parts"), parts.len(), MOST_PARTS);
    let mut ids = BTreeSet::new();
    for (position, part) in parts.iter().enumerate() {
        let at = |field: &str| format!("{path}.parts[{position}].{field}");
        name(format_args!("{path}.parts[{position}].id"), &part.id, 24, "_-", remarks);
        if !ids.insert(&part.id) {
            remarks.error("scenario.duplicate-id", at("id"), "a part before has this id too", "give each part its own");
        }
        remarks.number(format_args!("{path}.parts[{position}].x_m"), part.x_m, -20.0, 20.0, "m");
        remarks.number(format_args!("{path}.parts[{position}].y_m"), part.y_m, -10.0, 10.0, "m");
        remarks.number(format_args!("{path}.parts[{position}].length_m"), part.length_m, 0.02, 25.0, "m");
        remarks.number(format_args!("{path}.parts[{position}].width_m"), part.width_m, 0.02, 5.0, "m");
        if let Some(axle_m) = part.axle_m {
            remarks.number(format_args!("{path}.parts[{position}].axle_m"), axle_m, 0.5, 20.0, "m");
            if part.kind != PartKind::Trailer {
                remarks.error("scenario.part", at("axle_m"), "only a trailer has an axle", "leave it out");
            }
        }
    }
}

/// Where a plan begins, its course and its acts.
fn plan(plan: &ActorPlan, kind: PartnerKind, path: At<'_>, remarks: &mut Remarks) {
    let at = |field: &str| format!("{path}.{field}");
    let spec = VehicleSpec::of(kind);
    place(&plan.start, format_args!("{path}.start"), remarks);
    // A plan may be faster than the engine of the physics: the record says how fast it was.
    let fastest = top_speed_mps(kind);
    remarks.number(format_args!("{path}.speed_mps"), plan.speed_mps, 0.0, fastest, "m/s");
    remarks.number(format_args!("{path}.appears_s"), plan.appears_s, 0.0, 120.0, "s");
    remarks.count(format_args!("{path}.course"), plan.course.len(), MOST_LEGS);
    remarks.count(format_args!("{path}.acts"), plan.acts.len(), MOST_ACTS);
    if plan.course.is_empty() && plan.speed_mps > 0.0 {
        let hint = "give a course, such as [{\"lanes\": {\"roads\": [\"main+\"]}}], or speed_mps 0";
        remarks.error("scenario.course", at("course"), "it moves, and has nowhere to go", hint);
    }
    for (number, each) in plan.course.iter().enumerate() {
        leg(each, format_args!("{path}.course[{number}]"), remarks);
    }
    let hardest = spec.max_deceleration_mps2.max(spec.max_acceleration_mps2).max(1.0);
    for (number, act) in plan.acts.iter().enumerate() {
        remarks.number(format_args!("{path}.acts[{number}].delay_s"), act.delay_s, 0.0, 60.0, "s");
        if let Some(when) = &act.when {
            trigger(when, format_args!("{path}.acts[{number}].when"), remarks);
        }
        deed(&act.deed, format_args!("{path}.acts[{number}].do"), (fastest, hardest.min(12.0)), remarks);
    }
}

/// A leg of a course.
fn leg(leg: &Leg, path: At<'_>, remarks: &mut Remarks) {
    match leg {
        Leg::Lanes { roads, until_m, .. } => {
            if roads.is_empty() || roads.len() > 24 {
                let message = format!("the leg names {} roads", roads.len());
                let hint = "allowed: 1 to 24, the first being the one it is on";
                remarks.error("scenario.course", format!("{path}.lanes.roads"), message, hint);
            }
            if let Some(until_m) = until_m {
                remarks.number(format_args!("{path}.lanes.until_m"), *until_m, -200.0, 2000.0, "m");
            }
        }
        Leg::Curve { to, .. } => place(to, format_args!("{path}.curve.to"), remarks),
        Leg::Path { points } => {
            if points.is_empty() || points.len() > 64 {
                let message = format!("the leg has {} points", points.len());
                remarks.error("scenario.course", format!("{path}.path.points"), message, "allowed: 1 to 64");
            }
            for (point, [x, y]) in points.iter().enumerate() {
                let at = format!("{path}.path.points[{point}]");
                remarks.number(&at, *x, -2000.0, 2000.0, "m");
                remarks.number(&at, *y, -2000.0, 2000.0, "m");
            }
        }
    }
}

/// When an act begins.
fn trigger(when: &Trigger, path: At<'_>, remarks: &mut Remarks) {
    match when {
        Trigger::TimeS(time_s) => {
            remarks.number(format_args!("{path}.time_s"), *time_s, 0.0, 120.0, "s");
        }
        Trigger::AtM(s_m) => {
            remarks.number(format_args!("{path}.at_m"), *s_m, 0.0, 5000.0, "m");
        }
        Trigger::Near { within_m, .. } => {
            remarks.number(format_args!("{path}.near.within_m"), *within_m, 0.0, 500.0, "m");
        }
        _ => {}
    }
}

/// What an act does.
fn deed(deed: &Deed, path: At<'_>, (fastest, hardest): (f64, f64), remarks: &mut Remarks) {
    match deed {
        Deed::Speed { to_mps, rate_mps2 } => {
            remarks.number(format_args!("{path}.speed.to_mps"), *to_mps, 0.0, fastest, "m/s");
            remarks.number(format_args!("{path}.speed.rate_mps2"), *rate_mps2, 0.05, hardest, "m/s^2");
        }
        Deed::Stop { rate_mps2, at_m } => {
            remarks.number(format_args!("{path}.stop.rate_mps2"), *rate_mps2, 0.05, hardest, "m/s^2");
            if let Some(at_m) = at_m {
                remarks.number(format_args!("{path}.stop.at_m"), *at_m, 0.0, 5000.0, "m");
            }
        }
        Deed::Hold { for_s } => {
            if let Some(for_s) = for_s {
                remarks.number(format_args!("{path}.hold.for_s"), *for_s, 0.0, 120.0, "s");
            }
        }
        Deed::Shift { to_t_m, over_m } => {
            remarks.number(format_args!("{path}.shift.to_t_m"), *to_t_m, -50.0, 50.0, "m");
            remarks.number(format_args!("{path}.shift.over_m"), *over_m, 0.5, 500.0, "m");
        }
        Deed::Follow { speed_mps, gap_m, headway_s, reaction_s, acceleration_mps2, braking_mps2, .. } => {
            remarks.number(format_args!("{path}.follow.speed_mps"), *speed_mps, 0.5, fastest.max(0.5), "m/s");
            remarks.number(format_args!("{path}.follow.gap_m"), *gap_m, 0.1, 50.0, "m");
            remarks.number(format_args!("{path}.follow.headway_s"), *headway_s, 0.0, 10.0, "s");
            remarks.number(format_args!("{path}.follow.reaction_s"), *reaction_s, 0.0, 2.4, "s");
            remarks.number(format_args!("{path}.follow.acceleration_mps2"), *acceleration_mps2, 0.1, 6.0, "m/s^2");
            remarks.number(format_args!("{path}.follow.braking_mps2"), *braking_mps2, 0.5, 12.0, "m/s^2");
        }
        Deed::Part { to_deg, over_s, .. } => {
            remarks.number(format_args!("{path}.part.to_deg"), *to_deg, -180.0, 180.0, "deg");
            remarks.number(format_args!("{path}.part.over_s"), *over_s, 0.1, 60.0, "s");
        }
        Deed::Obey { .. } | Deed::Leave {} => {}
    }
}

/// The fastest a plan may say of a kind: what is told of real ones, with room. [m/s]
fn top_speed_mps(kind: PartnerKind) -> f64 {
    match kind {
        PartnerKind::Pedestrian => 8.0,
        PartnerKind::OtherNonMotorist | PartnerKind::Cyclist => 20.0,
        PartnerKind::Animal => 18.0,
        // What comes off somebody is as fast as that.
        PartnerKind::FixedObject => 45.0,
        _ => 60.0,
    }
}
