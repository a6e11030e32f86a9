//! The one door from a draft to a runnable scenario.
//!
//! Every rule has a stable code, `scenario.*`; they are listed in `docs/models/roads.md`.

mod actors;
mod control;
mod graph;
mod motion;
mod numbers;
mod obstacles;
mod places;
mod remarks;

pub use actors::arm_m;

use crate::network::RoadNetwork;
use crate::scenario::{ActorPlacement, Placement, Scenario, ego_size_m};
use recrash_model::geometry::OrientedBox;
use recrash_model::rollout::EGO_ID;
use recrash_model::scenario::ScenarioDraft;
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
    let planned = actors::numbers(&draft, &mut remarks);
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
    let recorded = match &draft.ego.recorded {
        Some(plan) if planned => {
            let body = (draft.ego.kind, draft.ego.size, draft.ego.parts.as_slice());
            actors::placement(&network, &control, body, plan, "ego.recorded", &mut remarks)
        }
        _ => None,
    };
    let ego = match draft.map.network() {
        Some(_) => places::ego_on_roads(&draft, &network, recorded.as_ref(), &mut remarks),
        None => places::ego(&draft, &network, &mut remarks),
    };
    let Some(mut ego) = ego else {
        return Err(remarks.list);
    };
    if let Some(recorded) = &recorded {
        ego.pose = recorded.pose;
        ego.speed_mps = draft.ego.recorded.as_ref().map_or(0.0, |plan| plan.speed_mps);
        ego.s_m = ego.path.project(recorded.pose.position, 0).s.clamp(0.0, ego.path.length_m);
    }
    if draft.map.network().is_none() {
        motion::ego(&draft, &network, &ego, &mut remarks);
    }
    let mut partners = Vec::with_capacity(draft.partners.len());
    for (position, partner) in draft.partners.iter().enumerate() {
        let path = format!("partners[{position}]");
        motion::script(&draft, partner, &path, &mut remarks);
        if !fit.partners.get(position).copied().unwrap_or(false) {
            partners.push(None);
            continue;
        }
        let placed = places::partner(&draft, partner, &path, &network, &ego, &mut remarks);
        if let Some(placement) = &placed {
            motion::partner(&draft, partner, &path, &network, placement, &mut remarks);
        }
        partners.push(placed);
    }
    let placed_obstacles: Vec<_> = draft
        .obstacles
        .iter()
        .zip(&fit.obstacles)
        .enumerate()
        .map(
            |(position, (obstacle, fit))| {
                if *fit { obstacles::place(obstacle, position, &network, &ego, &mut remarks) } else { None }
            },
        )
        .collect();
    let mut planned_actors = Vec::with_capacity(draft.actors.len());
    let mut objects = Vec::with_capacity(draft.objects.len());
    if planned {
        let names = actors::Names::of(&draft);
        if let Some(plan) = &draft.ego.recorded {
            actors::references(&draft, &names, (EGO_ID, plan), &draft.ego.parts, "ego.recorded", &mut remarks);
        }
        for (position, actor) in draft.actors.iter().enumerate() {
            let path = format!("actors[{position}].plan");
            actors::references(&draft, &names, (&actor.id, &actor.plan), &actor.parts, &path, &mut remarks);
            let body = (actor.kind, actor.size, actor.parts.as_slice());
            let placed = actors::placement(&network, &control, body, &actor.plan, &path, &mut remarks);
            planned_actors.push(placed.map(|each| ActorPlacement { mass_kg: actor.mass_kg.or(each.mass_kg), ..each }));
        }
        for (position, object) in draft.objects.iter().enumerate() {
            objects.push(obstacles::place_object(object, position, &network, &mut remarks));
        }
    }
    if draft.actors.is_empty() && draft.objects.is_empty() && recorded.is_none() {
        places::overlaps(&draft, &ego, &partners, &placed_obstacles, &mut remarks);
    } else {
        actors::overlaps(&everybody(&draft, &ego, &partners, &planned_actors), &mut remarks);
    }
    obstacles::way_through(&draft, &placed_obstacles, &mut remarks);
    if remarks.list.iter().any(Diagnostic::is_error) {
        return Err(remarks.list);
    }
    let partners = partners.into_iter().flatten().collect();
    let actors = planned_actors.into_iter().flatten().collect();
    let obstacles = placed_obstacles.into_iter().chain(objects).flatten().collect();
    let scenario = Scenario { draft, network, ego, partners, obstacles, actors, recorded, control };
    Ok(Outcome { value: scenario, diagnostics: remarks.list })
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
