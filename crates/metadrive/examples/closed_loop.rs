//! Renews what the native simulator is held against (`docs/models/metadrive-idm.md`): runs the drafts of the fixture on
//! MetaDrive, and writes one line each with how it ended and one position a second.
//!
//!     cargo run -p recrash-metadrive --example closed_loop -- PYTHON < OLD.jsonl > NEW.jsonl

use recrash_metadrive::{Drive, Metadrive, Options};
use recrash_model::rollout::{Role, Rollout, STEP_S};
use recrash_model::scenario::ScenarioDraft;
use recrash_roads::{Scenario, check};
use serde_json::{Value, json};
use std::io::BufRead;

/// Steps between two positions.
const POSITION_STEPS: usize = 10;

fn main() {
    let python = std::env::args().nth(1).expect("the Python that has MetaDrive");
    let drafts: Vec<ScenarioDraft> = std::io::stdin()
        .lock()
        .lines()
        .map(|line| {
            let mut line: Value = serde_json::from_str(&line.expect("text")).expect("JSON");
            serde_json::from_value(line["draft"].take()).expect("a draft")
        })
        .collect();
    let scenarios: Vec<Scenario> =
        drafts.into_iter().map(|draft| check(draft).unwrap_or_else(|problems| panic!("{problems:?}")).value).collect();
    let metadrive = Metadrive::start(Options::new(python)).unwrap_or_else(|error| panic!("{error}"));
    let rollouts = metadrive.simulate_all(&scenarios, &Drive::MetadriveIdm, &|_| {});
    for (scenario, rollout) in scenarios.iter().zip(rollouts) {
        println!("{}", line(scenario, &rollout.unwrap_or_else(|error| panic!("{error}"))));
    }
}

fn line(scenario: &Scenario, rollout: &Rollout) -> Value {
    let rounded = |value: f64, step: f64| (value / step).round() * step;
    let ego = rollout.ego_track();
    let partners = rollout.actors.iter().filter(|actor| actor.role == Role::Partner);
    let gaps = partners.flat_map(|partner| {
        (0..rollout.steps()).map(|step| (ego.outline(step).gap(&partner.outline(step)), step as f64 * STEP_S))
    });
    let (gap_m, time_s) = gaps.fold((f64::INFINITY, 0.0), |least, gap| if gap.0 < least.0 { gap } else { least });
    let positions: Vec<Vec<[f64; 2]>> = rollout
        .actors
        .iter()
        .map(|actor| {
            let every = actor.states.iter().step_by(POSITION_STEPS);
            every.map(|state| [rounded(state.x, 0.01), rounded(state.y, 0.01)]).collect()
        })
        .collect();
    json!({
        "draft": scenario.draft(),
        "id": scenario.draft().id,
        "end": rollout.termination.kind,
        "time_s": rollout.termination.time_s,
        "min_gap_m": rounded(gap_m, 1e-4),
        "min_gap_time_s": rounded(time_s, 0.1),
        "positions": positions,
    })
}
