//! Road users with a plan: whom they name, where they start and go, and whether they can do what they are told.

mod course;
mod numbers;

pub(super) use course::placement;
pub(super) use numbers::numbers;

use super::remarks::Remarks;
use crate::scenario::ActorPlacement;
use recrash_model::geometry::OrientedBox;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::{ActorPlan, Deed, Part, PartKind, ScenarioDraft, Trigger};
use recrash_model::vehicle::VehicleSpec;
use std::collections::BTreeSet;

/// Who is allowed to stand beside the start of who else: boxes may touch the air between them, and no more. [m]
const ROOM_M: f64 = 0.02;

/// Who and what there is to be named.
pub(super) struct Names<'a> {
    actors: BTreeSet<&'a str>,
    controls: BTreeSet<&'a str>,
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

/// From the rear axle forward to the centre; who walks turns about its middle. [m]
pub fn arm_m(kind: PartnerKind, length_m: f64) -> f64 {
    let spec = VehicleSpec::of(kind);
    if VehicleSpec::is_nimble(kind) || kind == PartnerKind::FixedObject {
        0.0
    } else {
        spec.rear_axle_m * length_m / spec.length_m
    }
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
