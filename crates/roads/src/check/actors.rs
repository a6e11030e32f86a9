//! Road users with a plan: names, ranges, where they start and go, and whether they can do what they are told.

use super::remarks::{At, Remarks, name, shown};
use crate::course::{Course, rear_of};
use crate::network::RoadNetwork;
use crate::path::LanePath;
use crate::place::PlaceError;
use crate::scenario::{ActorPlacement, ControlPlacement};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::{ActorPlan, Deed, Leg, Part, PartKind, Place, ScenarioDraft, Size, Trigger};
use recrash_model::vehicle::VehicleSpec;
use std::collections::BTreeSet;

/// Acts of one plan, legs of one course, parts of one road user, at most.
const MOST_ACTS: usize = 64;
const MOST_LEGS: usize = 32;
const MOST_PARTS: usize = 8;

/// Who is allowed to stand beside the start of who else: boxes may touch the air between them, and no more. [m]
const ROOM_M: f64 = 0.02;

/// The tightest bend of a course of who has an axle, by what its wheels can do, times this: a plan may cut it fine.
const TIGHTEST_SHARE: f64 = 0.9;

/// Who and what there is to be named.
pub(super) struct Names<'a> {
    actors: BTreeSet<&'a str>,
    controls: BTreeSet<&'a str>,
}

/// Checks ids, counts and ranges of everybody with a plan; whether geometry can be built from them.
pub(super) fn numbers(draft: &ScenarioDraft, remarks: &mut Remarks) -> bool {
    let before = remarks.errors();
    remarks.count("actors", draft.actors.len(), 32);
    remarks.count("objects", draft.objects.len(), 64);
    remarks.count("control", draft.control.len(), 32);
    remarks.number("after_contact_s", draft.after_contact_s, 0.0, 30.0, "s");
    let mut ids: BTreeSet<&str> = draft.partners.iter().map(|partner| partner.id.as_str()).collect();
    for (position, actor) in draft.actors.iter().enumerate() {
        let path = format!("actors[{position}]");
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
        parts(&actor.parts, format_args!("{path}"), remarks);
        plan(&actor.plan, actor.kind, format_args!("{path}.plan"), remarks);
    }
    for (position, object) in draft.objects.iter().enumerate() {
        place(&object.at, format_args!("objects[{position}].at"), remarks);
        size(object.size, format_args!("objects[{position}].size"), remarks);
    }
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
    for (position, control) in draft.control.iter().enumerate() {
        let path = format!("control[{position}]");
        remarks.number(format_args!("{path}.set_back_m"), control.set_back_m, 0.0, 200.0, "m");
        if let recrash_model::scenario::Device::Signal { program, offset_s } = &control.device {
            remarks.number(format_args!("{path}.device.signal.offset_s"), *offset_s, 0.0, 3600.0, "s");
            if program.is_empty() || program.len() > 16 {
                let message = format!("the program has {} phases", program.len());
                let at = format!("{path}.device.signal.program");
                remarks.error("scenario.signal", at, message, "allowed: 1 to 16 phases");
            }
            for (number, phase) in program.iter().enumerate() {
                remarks.number(
                    format_args!("{path}.device.signal.program[{number}].for_s"),
                    phase.for_s,
                    0.1,
                    600.0,
                    "s",
                );
            }
        }
    }
    remarks.errors() == before
}

impl Remarks {
    fn errors(&self) -> usize {
        self.list.iter().filter(|remark| remark.is_error()).count()
    }
}

fn size(size: Option<Size>, path: At<'_>, remarks: &mut Remarks) {
    if let Some(size) = size {
        remarks.number(format_args!("{path}.length_m"), size.length_m, 0.05, 40.0, "m");
        remarks.number(format_args!("{path}.width_m"), size.width_m, 0.05, 20.0, "m");
    }
}

fn place(place: &Place, path: At<'_>, remarks: &mut Remarks) {
    let heading_deg = match place {
        Place::Lane { along, t_m, heading_deg, .. } => {
            let (field, value) = match along {
                recrash_model::scenario::Along::FromStart(s_m) => ("s_m", s_m),
                recrash_model::scenario::Along::BeforeEnd(to_end_m) => ("to_end_m", to_end_m),
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
    for (number, leg) in plan.course.iter().enumerate() {
        match leg {
            Leg::Lanes { roads, until_m, .. } => {
                if roads.is_empty() || roads.len() > 24 {
                    let message = format!("the leg names {} roads", roads.len());
                    let hint = "allowed: 1 to 24, the first being the one it is on";
                    remarks.error("scenario.course", format!("{path}.course[{number}].lanes.roads"), message, hint);
                }
                if let Some(until_m) = until_m {
                    remarks.number(
                        format_args!("{path}.course[{number}].lanes.until_m"),
                        *until_m,
                        -200.0,
                        2000.0,
                        "m",
                    );
                }
            }
            Leg::Curve { to, .. } => place(to, format_args!("{path}.course[{number}].curve.to"), remarks),
            Leg::Path { points } => {
                if points.is_empty() || points.len() > 64 {
                    let message = format!("the leg has {} points", points.len());
                    let at = format!("{path}.course[{number}].path.points");
                    remarks.error("scenario.course", at, message, "allowed: 1 to 64");
                }
                for (point, [x, y]) in points.iter().enumerate() {
                    let at = format!("{path}.course[{number}].path.points[{point}]");
                    remarks.number(&at, *x, -2000.0, 2000.0, "m");
                    remarks.number(&at, *y, -2000.0, 2000.0, "m");
                }
            }
        }
    }
    let hardest = spec.max_deceleration_mps2.max(spec.max_acceleration_mps2).max(1.0);
    for (number, act) in plan.acts.iter().enumerate() {
        remarks.number(format_args!("{path}.acts[{number}].delay_s"), act.delay_s, 0.0, 60.0, "s");
        match &act.when {
            Some(Trigger::TimeS(time_s)) => {
                remarks.number(format_args!("{path}.acts[{number}].when.time_s"), *time_s, 0.0, 120.0, "s");
            }
            Some(Trigger::AtM(s_m)) => {
                remarks.number(format_args!("{path}.acts[{number}].when.at_m"), *s_m, 0.0, 5000.0, "m");
            }
            Some(Trigger::Near { within_m, .. }) => {
                remarks.number(format_args!("{path}.acts[{number}].when.near.within_m"), *within_m, 0.0, 500.0, "m");
            }
            _ => {}
        }
        deed(&act.deed, format_args!("{path}.acts[{number}].do"), (fastest, hardest.min(12.0)), remarks);
    }
}

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

impl<'a> Names<'a> {
    pub(super) fn of(draft: &'a ScenarioDraft) -> Self {
        let partners = draft.partners.iter().map(|partner| partner.id.as_str());
        let actors = partners.chain(draft.actors.iter().map(|actor| actor.id.as_str())).chain([EGO_ID]).collect();
        Self { actors, controls: draft.control.iter().map(|control| control.at.as_str()).collect() }
    }

    fn actor(&self, id: &str, path: String, remarks: &mut Remarks) {
        if !self.actors.contains(id) {
            let known: Vec<&str> = self.actors.iter().copied().collect();
            let shown: String = id.chars().take(40).collect();
            remarks.error(
                "scenario.unknown-actor",
                path,
                format!("nobody is called {shown:?}"),
                format!("there are: {}", known.join(", ")),
            );
        }
    }
}

/// Names in a plan mean somebody.
pub(super) fn references(
    draft: &ScenarioDraft,
    names: &Names<'_>,
    (own, plan): (&str, &ActorPlan),
    parts: &[Part],
    path: &str,
    remarks: &mut Remarks,
) {
    for (number, act) in plan.acts.iter().enumerate() {
        let at = |field: &str| format!("{path}.acts[{number}].{field}");
        match &act.when {
            Some(Trigger::Near { actor, .. }) => names.actor(actor, at("when.near.actor"), remarks),
            Some(Trigger::Actor { actor, .. }) => names.actor(actor, at("when.actor.actor"), remarks),
            Some(Trigger::Signal { at: control, .. }) if !names.controls.contains(control.as_str()) => {
                let known: Vec<&str> = names.controls.iter().copied().collect();
                let hint = format!("there is control at: {}", known.join(", "));
                remarks.error("scenario.unknown-control", at("when.signal.at"), "no signal stands there", hint);
            }
            Some(Trigger::Act { actor, act }) => {
                names.actor(actor, at("when.act.actor"), remarks);
                let other = match actor.as_str() {
                    EGO_ID => draft.ego.recorded.as_ref(),
                    id => draft.actors.iter().find(|other| other.id == id).map(|other| &other.plan),
                };
                if !other.is_some_and(|plan| plan.acts.iter().any(|other| other.id.as_ref() == Some(act))) {
                    let hint = "give the act an \"id\", and name it here";
                    remarks.error("scenario.unknown-act", at("when.act.act"), "it has no act of this name", hint);
                }
            }
            _ => {}
        }
        match &act.deed {
            Deed::Follow { actor, .. } => {
                names.actor(actor, at("do.follow.actor"), remarks);
                if actor == own {
                    let hint = "name whom it follows";
                    remarks.error("scenario.unknown-actor", at("do.follow.actor"), "nobody follows himself", hint);
                }
            }
            Deed::Part { part, .. } => {
                let known = parts.iter().find(|each| each.id == *part);
                if !known.is_some_and(|part| matches!(part.kind, PartKind::Door | PartKind::Arm)) {
                    let turning: Vec<&str> = parts
                        .iter()
                        .filter(|part| matches!(part.kind, PartKind::Door | PartKind::Arm))
                        .map(|part| part.id.as_str())
                        .collect();
                    let hint = format!("doors and arms of its own turn: {}", turning.join(", "));
                    remarks.error("scenario.unknown-part", at("do.part.part"), "it has no such part that turns", hint);
                }
            }
            _ => {}
        }
    }
}

/// Where somebody with a plan starts, and the line it follows.
pub(super) fn placement(
    network: &RoadNetwork,
    control: &[ControlPlacement],
    (kind, size, parts): (PartnerKind, Option<Size>, &[Part]),
    plan: &ActorPlan,
    path: &str,
    remarks: &mut Remarks,
) -> Option<ActorPlacement> {
    let spec = VehicleSpec::of(kind);
    let (length_m, width_m) = size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m));
    let arm_m = arm_m(kind, length_m);
    let start = match network.place(&plan.start) {
        Ok(start) => start,
        Err(error) => {
            remarks.error("scenario.place", format!("{path}.start"), error.message, error.hint);
            return None;
        }
    };
    let mut course = Course::begin(arm_m);
    let mut t_m = 0.0;
    for (number, leg) in plan.course.iter().enumerate() {
        let at = format!("{path}.course[{number}]");
        match leg {
            Leg::Lanes { roads, until_m, lane, against, reverse } => {
                let from = course.end_pose().map_or(start.pose, |rear| ahead(rear, arm_m));
                let first_lane = match (&plan.start, number) {
                    // Who stands on a strip beside the lanes follows the nearest of them.
                    (Place::Lane { road, lane, .. }, 0) if roads.first() == Some(road) => Some(*lane),
                    _ => None,
                };
                let found = lanes_leg(network, roads, first_lane, *lane, *against, from);
                let (way, along) = match found {
                    Ok(found) => found,
                    Err((message, hint)) => {
                        remarks.error("scenario.way", format!("{at}.lanes.roads"), message, hint);
                        return None;
                    }
                };
                let beside = way.project(from.position, 0);
                // Who faces along the line of motion has its rear axle behind, who drives backwards ahead.
                let arm = if *reverse { -arm_m } else { arm_m };
                if number == 0 {
                    let right = if *reverse { -1.0 } else { 1.0 };
                    t_m = beside.t * right;
                    let facing = way.pose(beside.s, 0.0).heading + if *reverse { math::PI } else { 0.0 };
                    let turned = math::wrap_angle(facing - start.pose.heading).abs();
                    if turned > 0.02 {
                        let message =
                            format!("it faces {} deg off the lanes it is to follow", shown(turned.to_degrees()));
                        let hint = "begin with a {\"curve\": ...} onto the lane, give heading_deg 0 (180 with \
                                    \"against\"), or set \"reverse\"";
                        remarks.error("scenario.facing", format!("{at}.lanes"), message, hint);
                        return None;
                    }
                }
                let from_m = beside.s - arm;
                let to_m = until_m.map_or(way.length_m, |until_m| along + until_m) - arm;
                if to_m <= from_m {
                    let message = format!("the leg would end {} m behind where it begins", shown(from_m - to_m));
                    remarks.error("scenario.way", format!("{at}.lanes.until_m"), message, "allowed: farther along");
                    return None;
                }
                course.follow(&way, (from_m, to_m), *against, *reverse, until_m.is_some());
            }
            Leg::Curve { to, reverse } => {
                let to = match network.place(to) {
                    Ok(to) => to.pose,
                    Err(error) => {
                        remarks.error("scenario.place", format!("{at}.curve.to"), error.message, error.hint);
                        return None;
                    }
                };
                if !course.curve(start.pose, to, *reverse) {
                    let hint = "allowed: a place ahead of where it begins (behind, with \"reverse\"), that needs no turn of \
                                more than half a circle; go there in two curves";
                    let message = "no smooth curve leads there";
                    remarks.error("scenario.curve", format!("{at}.curve.to"), message, hint);
                    return None;
                }
            }
            Leg::Path { points } => course.walk(start.pose, points),
        }
    }
    if course.legs.is_empty() {
        course = Course::standing(start.pose, arm_m);
    }
    tight_bends(&course, kind, path, remarks);
    let half_length_m = 0.5 * length_m;
    course.lines = stop_lines(&course, control, half_length_m);
    let pose =
        course.motion(0, 0.0, course.legs[0].reverse, crate::course::Beside { t_m, ..Default::default() }, 0.0).0;
    let mass_kg = VehicleSpec::mass_kg(kind);
    Some(ActorPlacement { kind, length_m, width_m, mass_kg, pose, course, t_m, parts: parts.to_vec() })
}

/// From the rear axle forward to the centre; who walks turns about its middle. [m]
pub fn arm_m(kind: PartnerKind, length_m: f64) -> f64 {
    let spec = VehicleSpec::of(kind);
    if VehicleSpec::is_nimble(kind) || kind == PartnerKind::FixedObject {
        0.0
    } else {
        spec.rear_axle_m * length_m / spec.length_m
    }
}

fn ahead(rear: Pose, arm_m: f64) -> Pose {
    rear_of(rear, -arm_m)
}

/// A way along lanes, and where it enters its last road. [m]
fn lanes_leg(
    network: &RoadNetwork,
    roads: &[String],
    first_lane: Option<u8>,
    last_lane: Option<u8>,
    against: bool,
    from: Pose,
) -> Result<(LanePath, f64), (String, String)> {
    let told = |error: PlaceError| (error.message, error.hint);
    let first_lane = match first_lane {
        Some(lane) => lane,
        None => nearest_lane(network, &roads[0], from.position).map_err(told)?,
    };
    let way = if against {
        network.way_against(roads, first_lane, last_lane)
    } else {
        network.way(roads, first_lane, last_lane)
    };
    let way = way.map_err(told)?;
    let last = network.named_road(&roads[roads.len() - 1], "roads").map_err(told)?;
    let pieces = &network.named[last].pieces;
    let enters = way.segments.iter().find(|segment| pieces.contains(&network.lane(segment.lane).road));
    let enters_m = enters.map_or(0.0, |segment| segment.start_m);
    Ok((way, enters_m))
}

/// The number of the lane of a road that passes nearest to a point.
fn nearest_lane(network: &RoadNetwork, road: &str, point: Vec2) -> Result<u8, PlaceError> {
    let road = &network.named[network.named_road(road, "roads[0]")?];
    let mut best = (f64::INFINITY, 0);
    for lane in 0..network.lanes_of(road) {
        let path = network.lane_of(road, lane)?;
        let beside = path.project(point, 0);
        let apart = path.pose(beside.s, 0.0).position.distance(point);
        if apart < best.0 {
            best = (apart, lane);
        }
    }
    Ok(best.1)
}

/// Bends that its wheels cannot follow.
fn tight_bends(course: &Course, kind: PartnerKind, path: &str, remarks: &mut Remarks) {
    let spec = VehicleSpec::of(kind);
    if course.arm_m == 0.0 {
        return;
    }
    let wheelbase_m = spec.front_axle_m + spec.rear_axle_m;
    let least_m = TIGHTEST_SHARE * wheelbase_m / math::tan(spec.max_wheel_angle_rad);
    let tightest = course.pieces.iter().map(|piece| piece.shape.curvature().abs()).fold(0.0, f64::max);
    if tightest * least_m > 1.0 {
        let message = format!("its course bends with a radius of {} m", shown(1.0 / tightest));
        let hint = format!("its kind turns with {} m or more; leave more room, or take two curves", shown(least_m));
        remarks.warn("scenario.tight-course", format!("{path}.course"), message, hint);
    }
}

fn stop_lines(course: &Course, control: &[ControlPlacement], half_length_m: f64) -> Vec<crate::course::StopLine> {
    let mut lines = Vec::new();
    for (number, placed) in control.iter().enumerate().filter(|(_, placed)| placed.stops) {
        for &(lane, line_m) in &placed.lines {
            for piece in course.pieces.iter().filter(|piece| piece.lane == Some(lane)) {
                let line = network_point(piece, line_m);
                if let Some(along_m) = line {
                    // The course is the rear axle's.
                    let at_m = piece.start_m + along_m - course.arm_m - half_length_m;
                    lines.push(crate::course::StopLine { at_m, control: number });
                }
            }
        }
    }
    lines.sort_by(|a, b| a.at_m.total_cmp(&b.at_m));
    lines
}

/// Where along a piece of a course a place along its lane lies; `None` off the piece. [m]
fn network_point(piece: &crate::course::CoursePiece, line_m: f64) -> Option<f64> {
    let along_m = line_m - piece.lane_from_m;
    (-1e-6..=piece.length_m + 1e-6).contains(&along_m).then_some(along_m)
}

/// Its box at the start.
pub(super) fn outline(placement: &ActorPlacement) -> OrientedBox {
    OrientedBox::new(placement.pose, placement.length_m, placement.width_m)
}

/// Nobody starts inside of somebody else.
pub(super) fn overlaps(placed: &[(String, String, OrientedBox)], remarks: &mut Remarks) {
    for (position, (_, path, own)) in placed.iter().enumerate() {
        for (name, _, other) in &placed[..position] {
            if own.depth(other) > ROOM_M && own.overlaps(other) {
                let message = format!("it starts on top of {name}");
                let hint = "move one of them, or let one appear later (appears_s)";
                remarks.error("scenario.spawn-overlap", format!("{path}.start"), message, hint);
            }
        }
    }
}
