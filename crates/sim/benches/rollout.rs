//! How fast rollouts are, in agent-steps (one road user through one step of 0.1 s) per second.
//!
//!     cargo bench -p recrash-sim

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use recrash_model::scenario::{Approach, Start, Turn};
use recrash_roads::Scenario;
use recrash_sim::{Ego, RolloutRecorder, Runner, SummaryRecorder};
use std::hint::black_box;

#[path = "../tests/suite/common/mod.rs"]
mod common;

/// The ego straight across an intersection, a partner that turns left in front of it, late enough to miss it.
fn crossing() -> Scenario {
    let mut draft = common::alone(common::wide_cross(2), Turn::Straight, 1, 8.0, 8.33);
    let start = Start::ArrivalGap { arrival_gap_s: 3.0 };
    draft.partners.push(common::steady(Approach::Opposite, Turn::Left, start, 8.0));
    common::checked(draft)
}

/// A roundabout full of background traffic.
fn busy_roundabout() -> Scenario {
    let mut draft = common::alone(common::roundabout(2), Turn::Straight, 1, 7.0, 7.0);
    draft.traffic.density = 0.3;
    common::checked(draft)
}

/// A junction with signals, which six road users with plans obey, two of them behind another, one behind the ego; and somebody
/// on foot. At least a million agent-steps per second are asked for.
fn signals() -> Scenario {
    let draft = recrash_roads::read_draft(include_str!("signals.json")).expect("a scenario file").value;
    common::checked(draft)
}

fn rollouts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rollout");
    for (name, scenario) in [("crossing", crossing()), ("busy_roundabout", busy_roundabout()), ("signals", signals())] {
        for ego in Ego::DRIVERS {
            let mut runner = Runner::new();
            let mut recorder = SummaryRecorder::new();
            runner.run(&scenario, ego, &mut recorder);
            let agent_steps = recorder.summary.actors as u64 * u64::from(recorder.summary.steps);
            group.throughput(Throughput::Elements(agent_steps));
            group.bench_function(format!("{name}/{ego}/summary"), |bencher| {
                bencher.iter(|| runner.run(black_box(&scenario), ego, &mut recorder));
            });
        }
    }
    let scenario = crossing();
    let mut runner = Runner::new();
    group.bench_function("crossing/metadrive-idm/everything", |bencher| {
        bencher.iter(|| {
            let mut recorder = RolloutRecorder::new();
            runner.run(black_box(&scenario), Ego::MetadriveIdm, &mut recorder);
            recorder.finish()
        });
    });
    group.finish();
}

criterion_group!(benches, rollouts);
criterion_main!(benches);
