//! The one door from a draft to a runnable scenario.
//!
//! Every rule has a stable code, `scenario.*`; they are listed in `docs/models/roads.md`.

mod actors;
mod control;
mod graph;
mod motion;
mod names;
mod numbers;
mod obstacles;
mod places;
mod remarks;
mod starts;

pub use actors::arm_m;
pub use numbers::MAX_WANTED_MPS;

use crate::network::RoadNetwork;
use crate::scenario::{ActorPlacement, ControlPlacement, ObstaclePlacement, Placement, Scenario, ego_size_m};
use recrash_model::geometry::OrientedBox;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::{Obstacle, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;
use recrash_model::{Diagnostic, Outcome};
use remarks::Remarks;
use std::sync::Arc;

/// Checks a draft. Gives every problem at once, each with its JSON path, the value, what is allowed and a hint.
///
/// # Errors
/// Diagnostics of which at least one is an error.
pub fn check(draft: ScenarioDraft) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    check_on(draft, None)
}

/// The same with a network that is known: it is built anew only where the draft's map is another. For many drafts on few maps.
///
/// # Errors
/// As [`check`].
pub fn check_on(draft: ScenarioDraft, known: Option<&Arc<RoadNetwork>>) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    let mut remarks = Remarks::default();
    let fit = numbers::check(&draft, &mut remarks);
    let plans_fit = actors::numbers(&draft, &mut remarks);
    // Geometry needs numbers it can be built from; what does not depend on it has been checked above in any case. And
    // each is compared with each other, so that thousands of them would be compared for hours.
    if !fit.counts || !fit.map || !fit.ego {
        return Err(remarks.list);
    }
    let built = match known.filter(|known| known.map == draft.map) {
        Some(known) => Ok(Arc::clone(known)),
        None => RoadNetwork::try_build(&draft.map).map(Arc::new),
    };
    let network = match built {
        Ok(network) => network,
        Err(problems) => {
            remarks.list.extend(problems);
            return Err(remarks.list);
        }
    };
    let control = control::place(&draft, &network, &mut remarks);
    let mut placing = Placing { draft: &draft, fit, plans_fit, network: &network, control: &control, remarks };
    let recorded = placing.recorded();
    let Some(ego) = placing.ego(recorded.as_ref()) else {
        return Err(placing.remarks.list);
    };
    let partners = placing.partners(&ego);
    let obstacles = placing.obstacles(&ego);
    let actors = placing.actors();
    let objects = placing.objects();
    let mut remarks = placing.remarks;
    if draft.actors.is_empty() && draft.objects.is_empty() && recorded.is_none() {
        places::overlaps(&draft, &ego, &partners, &obstacles, &mut remarks);
    } else {
        actors::overlaps(&everybody(&draft, &ego, &partners, &actors), &mut remarks);
    }
    obstacles::way_through(&draft, &obstacles, &mut remarks);
    if remarks.list.iter().any(Diagnostic::is_error) {
        return Err(remarks.list);
    }
    let partners = partners.into_iter().flatten().collect();
    let actors = actors.into_iter().flatten().collect();
    let obstacles = obstacles.into_iter().chain(objects).flatten().collect();
    let scenario = Scenario { draft, network, ego, partners, obstacles, actors, recorded, control };
    Ok(Outcome { value: scenario, diagnostics: remarks.list })
}

/// A draft whose map and ego can be built, being placed on its network.
struct Placing<'a> {
    draft: &'a ScenarioDraft,
    fit: numbers::Fit,
    /// Whether the numbers of everybody with a plan fit.
    plans_fit: bool,
    network: &'a RoadNetwork,
    control: &'a [ControlPlacement],
    remarks: Remarks,
}

impl Placing<'_> {
    /// The recorded driver of the ego, where the draft has one.
    fn recorded(&mut self) -> Option<ActorPlacement> {
        let ego = &self.draft.ego;
        let plan = ego.recorded.as_ref().filter(|_| self.plans_fit)?;
        let body = (ego.kind, ego.size, ego.parts.as_slice());
        actors::placement(self.network, self.control, body, plan, "ego.recorded", &mut self.remarks)
    }

    /// The ego on its way; where a driver was recorded, it starts as that one does.
    fn ego(&mut self, recorded: Option<&ActorPlacement>) -> Option<Placement> {
        let (draft, network) = (self.draft, self.network);
        let on_roads = draft.map.network().is_some();
        let mut ego = if on_roads {
            places::ego_on_roads(draft, network, recorded, &mut self.remarks)?
        } else {
            places::ego(draft, network, &mut self.remarks)?
        };
        if let Some(recorded) = recorded {
            ego.pose = recorded.pose;
            ego.speed_mps = draft.ego.recorded.as_ref().map_or(0.0, |plan| plan.speed_mps);
            ego.s_m = ego.path.project(recorded.pose.position, 0).s.clamp(0.0, ego.path.length_m);
        }
        if !on_roads {
            motion::ego(draft, network, &ego, &mut self.remarks);
        }
        Some(ego)
    }

    /// The partners, each where it fits.
    fn partners(&mut self, ego: &Placement) -> Vec<Option<Placement>> {
        let (draft, network, remarks) = (self.draft, self.network, &mut self.remarks);
        let mut partners = Vec::with_capacity(draft.partners.len());
        for (position, partner) in draft.partners.iter().enumerate() {
            let path = format!("partners[{position}]");
            motion::script(draft, partner, &path, remarks);
            if !self.fit.partners.get(position).copied().unwrap_or(false) {
                partners.push(None);
                continue;
            }
            let placed = places::partner(draft, partner, &path, network, ego, remarks);
            if let Some(placement) = &placed {
                motion::partner(draft, partner, &path, network, placement, remarks);
            }
            partners.push(placed);
        }
        partners
    }

    /// The obstacles beside the ego's way, each where it fits.
    fn obstacles(&mut self, ego: &Placement) -> Vec<Option<ObstaclePlacement>> {
        let place = |(position, (obstacle, fit)): (usize, (&Obstacle, &bool))| {
            if *fit { obstacles::place(obstacle, position, self.network, ego, &mut self.remarks) } else { None }
        };
        self.draft.obstacles.iter().zip(&self.fit.obstacles).enumerate().map(place).collect()
    }

    /// Everybody with a plan, and whether the plans, the recorded one too, name who is there; nobody where their numbers do not fit.
    fn actors(&mut self) -> Vec<Option<ActorPlacement>> {
        let mut placed = Vec::with_capacity(self.draft.actors.len());
        if !self.plans_fit {
            return placed;
        }
        let (draft, remarks) = (self.draft, &mut self.remarks);
        let names = actors::Names::of(draft);
        if let Some(plan) = &draft.ego.recorded {
            actors::references(draft, &names, (EGO_ID, plan), &draft.ego.parts, "ego.recorded", remarks);
        }
        for (position, actor) in draft.actors.iter().enumerate() {
            let path = format!("actors[{position}].plan");
            actors::references(draft, &names, (&actor.id, &actor.plan), &actor.parts, &path, remarks);
            let body = (actor.kind, actor.size, actor.parts.as_slice());
            let own = actors::placement(self.network, self.control, body, &actor.plan, &path, remarks);
            placed.push(own.map(|each| ActorPlacement { mass_kg: actor.mass_kg.or(each.mass_kg), ..each }));
        }
        placed
    }

    /// The things that lie about; none where the numbers of plans and things do not fit.
    fn objects(&mut self) -> Vec<Option<ObstaclePlacement>> {
        let objects = if self.plans_fit { self.draft.objects.as_slice() } else { &[] };
        let place = |(position, object)| obstacles::place_object(object, position, self.network, &mut self.remarks);
        objects.iter().enumerate().map(place).collect()
    }
}

/// Everybody who is there at the start: name, path and box.
fn everybody(
    draft: &ScenarioDraft,
    ego: &Placement,
    partners: &[Option<Placement>],
    actors: &[Option<ActorPlacement>],
) -> Vec<(String, String, OrientedBox)> {
    let outline = |placement: &Placement| {
        let size = VehicleSpec::of(placement.kind);
        OrientedBox::new(placement.pose, size.length_m, size.width_m)
    };
    let (length_m, width_m) = ego_size_m(draft, ego.kind);
    let own = OrientedBox::new(ego.pose, length_m, width_m);
    let mut all = vec![("the ego".to_owned(), "ego".to_owned(), own)];
    for (position, (partner, placed)) in draft.partners.iter().zip(partners).enumerate() {
        let name = format!("partner {:?}", partner.id);
        all.extend(placed.iter().map(|placed| (name.clone(), format!("partners[{position}]"), outline(placed))));
    }
    for (position, (actor, placed)) in draft.actors.iter().zip(actors).enumerate() {
        if actor.plan.appears_s == 0.0 {
            let name = format!("actor {:?}", actor.id);
            let path = format!("actors[{position}].plan");
            all.extend(placed.iter().map(|placed| (name.clone(), path.clone(), actors::outline(placed))));
        }
    }
    all
}
