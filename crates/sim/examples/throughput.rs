//! Runs one scenario again and again, for a profiler: `throughput crossing|roundabout|FILE RUNS`.

use recrash_model::scenario::{Approach, Start, Turn};
use recrash_sim::{Ego, Runner, SummaryRecorder};

#[path = "../tests/suite/common/mod.rs"]
mod common;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let runs: u64 = arguments.get(1).and_then(|runs| runs.parse().ok()).unwrap_or(1000);
    let file = arguments.first().and_then(|name| std::fs::read_to_string(name).ok());
    let draft = if let Some(json) = file {
        recrash_roads::read_draft(&json).expect("a scenario file").value
    } else if arguments.first().is_some_and(|name| name == "roundabout") {
        let mut draft = common::alone(common::roundabout(2), Turn::Straight, 1, 7.0, 7.0);
        draft.traffic.density = 0.3;
        draft
    } else {
        let mut draft = common::alone(common::wide_cross(2), Turn::Straight, 1, 8.0, 8.33);
        let start = Start::ArrivalGap { arrival_gap_s: 3.0 };
        draft.partners.push(common::steady(Approach::Opposite, Turn::Left, start, 8.0));
        draft
    };
    let scenario = common::checked(draft);
    let mut runner = Runner::new();
    let mut recorder = SummaryRecorder::new();
    let mut agent_steps = 0;
    for _ in 0..runs {
        runner.run(&scenario, Ego::MetadriveIdm, &mut recorder);
        agent_steps += recorder.summary.actors as u64 * u64::from(recorder.summary.steps);
    }
    println!("{agent_steps} agent-steps; divide by the user time of this process");
}
