//! The one door from a draft to a runnable scenario.
//!
//! Every rule has a stable code, `scenario.*`; they are listed in `docs/models/roads.md`.

mod graph;
mod motion;
mod numbers;
mod obstacles;
mod places;

use crate::network::RoadNetwork;
use crate::scenario::Scenario;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::{Diagnostic, Outcome};
use std::sync::Arc;

/// Checks a draft. Gives every problem at once, each with its JSON path, the value, what is allowed and a hint.
///
/// # Errors
/// Diagnostics of which at least one is an error.
pub fn check(draft: ScenarioDraft) -> Result<Outcome<Scenario>, Vec<Diagnostic>> {
    let mut remarks = Remarks::default();
    let fit = numbers::check(&draft, &mut remarks);
    // Geometry needs numbers it can be built from; what does not depend on it has been checked above in any case. And
    // each is compared with each other, so that thousands of them would be compared for hours.
    if !fit.counts || !fit.map || !fit.ego {
        return Err(remarks.list);
    }
    let network = match RoadNetwork::try_build(&draft.map) {
        Ok(network) => Arc::new(network),
        Err(problems) => {
            remarks.list.extend(problems);
            return Err(remarks.list);
        }
    };
    let Some(ego) = places::ego(&draft, &network, &mut remarks) else {
        return Err(remarks.list);
    };
    motion::ego(&draft, &network, &ego, &mut remarks);
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
    places::overlaps(&draft, &ego, &partners, &placed_obstacles, &mut remarks);
    obstacles::way_through(&draft, &placed_obstacles, &mut remarks);
    if remarks.list.iter().any(Diagnostic::is_error) {
        return Err(remarks.list);
    }
    let partners = partners.into_iter().flatten().collect();
    let obstacles = placed_obstacles.into_iter().flatten().collect();
    Ok(Outcome { value: Scenario { draft, network, ego, partners, obstacles }, diagnostics: remarks.list })
}

/// The diagnostics of one check.
#[derive(Default)]
struct Remarks {
    list: Vec<Diagnostic>,
}

impl Remarks {
    fn error(&mut self, code: &str, path: impl Into<String>, message: impl Into<String>, hint: impl Into<String>) {
        self.list.push(Diagnostic::error_at(code, path, message).with_hint(hint));
    }

    fn warn(&mut self, code: &str, path: impl Into<String>, message: impl Into<String>, hint: impl Into<String>) {
        self.list.push(Diagnostic::warning_at(code, path, message).with_hint(hint));
    }
}

/// A number for a message: at most three decimals, as short as possible.
fn shown(value: f64) -> String {
    if !value.is_finite() {
        return format!("{value}");
    }
    if value != 0.0 && !(1e-3..1e9).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
