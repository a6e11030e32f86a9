//! Others than the two, as actors: each in the place that its part in what the ego does gives it.

use crate::others::crossing::RIDES_MPS;
use crate::others::scene::Scene;
use crate::others::stand::stands;
use crate::told::crash::Told;
use crate::told::others::{Extra, Role};
use crate::told::sizes::size_of as size_of_kind;
use crate::touch::staging::Staging;
use crate::usual::{RUNS_MPS, WALKS_MPS};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::Rollout;
use recrash_model::scenario::{Actor, ActorPlan};
use recrash_model::vehicle::VehicleSpec;

/// An animal that goes with somebody on foot is so much ahead of that. [s]
const LEADS_S: f64 = 1.0;

/// Those who have a part in what the ego does, on the road; `alone`: the crash without them.
pub(crate) fn actors(told: &Told, staging: &Staging, recorded: &ActorPlan, alone: &Rollout) -> Vec<Actor> {
    let ego = alone.ego_track();
    let until = ((told.contact_s * 10.0).round() as usize).min(ego.states.len() - 1);
    let partner = alone.actors.iter().find(|track| track.id == "cp");
    let stand = stands(ego, until).last().copied();
    let scene = Scene { told, ground: &staging.ground, recorded, ego, partner, until, stand };
    // For whom it slowed on its way it did not stand.
    let on_way = Scene { stand: None, ..scene };
    // Who had gone by crossed before an ego that stood set off first.
    let at_first = Scene { stand: stands(ego, until).first().copied(), ..scene };
    let of = |extra: &Extra| match (extra.late, extra.early) {
        (true, _) => on_way,
        (false, true) => at_first,
        (false, false) => scene,
    };
    told.extras.iter().flat_map(|extra| of(extra).actors(extra)).collect()
}

impl Scene<'_> {
    fn actors(&self, extra: &Extra) -> Vec<Actor> {
        let kind = match extra.role {
            Role::Animal => PartnerKind::Animal,
            _ => extra.kind.partner_kind().unwrap_or(PartnerKind::PassengerCar),
        };
        let size = size_of_kind(extra.kind);
        let spec = VehicleSpec::of(kind);
        let (length_m, width_m) = size.map_or((spec.length_m, spec.width_m), |size| (size.length_m, size.width_m));
        let plans = match extra.role {
            Role::Lead | Role::Thing => self.lead(extra, length_m).into_iter().collect(),
            Role::Slower => self.slower(length_m).into_iter().collect(),
            Role::Walker if extra.stays => vec![self.stays_close(extra)],
            Role::Walker if extra.runs => vec![self.crosses(extra, RUNS_MPS, self.clears_s())],
            Role::Walker if kind == PartnerKind::Pedestrian => vec![self.crosses(extra, WALKS_MPS, self.clears_s())],
            Role::Walker => vec![self.crosses(extra, RIDES_MPS, self.clears_s())],
            Role::Animal if extra.led => vec![self.crosses(extra, WALKS_MPS, self.clears_s() - LEADS_S)],
            Role::Animal => vec![self.runs(extra)],
            Role::Crosser => self.crosser(extra).into_iter().collect(),
            Role::Oncoming => self.oncoming().into_iter().collect(),
            Role::Kerb => self.parked(extra, length_m),
            Role::Obstacle => vec![self.obstacle(extra, (length_m, width_m))],
            Role::Passed => self.passed(extra, (length_m, width_m)).into_iter().collect(),
            Role::Blocker => self.blocker(length_m).into_iter().collect(),
            Role::Beyond => self.beyond(length_m).into_iter().collect(),
            Role::Screen => self.screen(extra, length_m).into_iter().collect(),
            Role::Merger => vec![self.merger(extra, length_m)],
            Role::Beside if extra.between => vec![self.passed_between(extra, (length_m, width_m))],
            Role::Beside => vec![self.stands_beside(extra, length_m)],
            Role::Backer => vec![self.backer(extra, (length_m, width_m))],
            Role::Abreast => vec![self.abreast(extra)],
            Role::Near => Vec::new(),
        };
        let name = |number: usize| if number == 0 { String::new() } else { format!("-{}", number + 1) };
        let actor = |(number, plan): (usize, ActorPlan)| Actor {
            id: extra.id() + &name(number),
            kind,
            size,
            mass_kg: None,
            parts: Vec::new(),
            plan,
        };
        plans.into_iter().enumerate().map(actor).collect()
    }
}
