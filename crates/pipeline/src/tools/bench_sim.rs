//! The speed of both simulators on the same scenarios, in one run.

use crate::error::PipelineError;
use crate::progress::{Progress, ProgressEvent};
use crate::tools::parity::{random_scenario, start};
use recrash_metadrive::Drive;
use recrash_roads::Scenario;
use recrash_sim::{Ego, Runner, SummaryRecorder};
use serde::Serialize;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What is asked for: agent-steps per second of one core, times MetaDrive's, and times one thread's on two.
const WANTED_PER_CORE: f64 = 2e6;
const WANTED_TIMES_METADRIVE: f64 = 1000.0;
const WANTED_TIMES_ONE_THREAD: f64 = 1.8;

/// Times that MetaDrive runs every scenario.
const METADRIVE_PASSES: usize = 2;

/// What to measure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SimBenchRequest {
    /// Random scenarios that both run.
    pub count: usize,
    /// Their seed.
    pub seed: u64,
    /// Measurements of the native simulator. The fastest counts: other work on the machine can only slow one down.
    pub rounds: usize,
    /// How long one measurement takes at least.
    pub least: Duration,
    /// Python interpreter with MetaDrive.
    pub python: PathBuf,
}

/// Speeds. An agent-step is one road user over 0.1 s: five physics steps and one decision.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SimBench {
    /// Always `recrash.bench-sim/1`.
    pub format: &'static str,
    /// Scenarios.
    pub scenarios: usize,
    /// Agent-steps of all of them, once each.
    pub agent_steps: u64,
    /// Native, one thread: the fastest of the rounds. [agent-steps/s]
    pub one_thread: f64,
    /// Native, two threads, each with scenarios of its own. [agent-steps/s]
    pub two_threads: f64,
    /// MetaDrive, one worker, setting up each scenario included: the faster of two passes, the second of which finds
    /// every map built. [agent-steps/s]
    pub metadrive: Option<f64>,
    /// MetaDrive's version, or why there is no figure of it.
    pub metadrive_note: String,
    /// Cores the machine says it has.
    pub cores: usize,
}

impl SimBench {
    /// One thread over MetaDrive.
    pub fn times_metadrive(&self) -> Option<f64> {
        self.metadrive.map(|metadrive| self.one_thread / metadrive)
    }

    /// Two threads over one.
    pub fn times_one_thread(&self) -> f64 {
        self.two_threads / self.one_thread
    }

    /// What is asked for: what, the figure (absent without MetaDrive), how much, and whether it is reached.
    pub fn asked(&self) -> Vec<(&'static str, Option<f64>, f64, bool)> {
        let row = |what, figure: Option<f64>, wanted: f64| (what, figure, wanted, figure.is_none_or(|f| f >= wanted));
        vec![
            row("agent-steps per second and core", Some(self.one_thread), WANTED_PER_CORE),
            row("times MetaDrive, one thread", self.times_metadrive(), WANTED_TIMES_METADRIVE),
            row("times one thread, two threads", Some(self.times_one_thread()), WANTED_TIMES_ONE_THREAD),
        ]
    }
}

/// Measures both simulators. Without MetaDrive the native figures stand alone, with a note.
///
/// # Errors
/// MetaDrive is there but fails on every scenario.
pub fn bench_sim(request: &SimBenchRequest, progress: &dyn Progress) -> Result<SimBench, PipelineError> {
    const STAGE: &str = "bench";
    let scenarios: Vec<Scenario> = (0..request.count).map(|number| random_scenario(request.seed, number)).collect();
    progress.event(ProgressEvent::Started { stage: STAGE, units: request.rounds + METADRIVE_PASSES * scenarios.len() });
    let agent_steps = run_all(&scenarios, &mut Runner::new());
    let (mut one, mut two) = (Vec::new(), Vec::new());
    for _ in 0..request.rounds {
        // In turn, so that other work on the machine meets both.
        one.push(native(&scenarios, 1, request.least));
        two.push(native(&scenarios, 2, request.least));
        progress.event(ProgressEvent::Advanced { stage: STAGE, unit: "native", skipped: false });
    }
    let (metadrive, metadrive_note) = match start(&request.python, 1) {
        Err(why) => (None, why.to_string()),
        Ok(pool) => {
            let mut fastest: f64 = 0.0;
            for _ in 0..METADRIVE_PASSES {
                let begun = Instant::now();
                let mut steps = 0;
                for scenario in &scenarios {
                    if let Ok(rollout) = pool.simulate(scenario, &Drive::MetadriveIdm) {
                        steps += (rollout.actors.len() * rollout.steps()) as u64;
                    }
                    progress.event(ProgressEvent::Advanced { stage: STAGE, unit: "MetaDrive", skipped: false });
                }
                fastest = fastest.max(steps as f64 / begun.elapsed().as_secs_f64());
            }
            if fastest == 0.0 {
                return Err(PipelineError::bad_input("MetaDrive failed on every scenario"));
            }
            let (python, version) = pool.versions();
            (Some(fastest), format!("MetaDrive {version} on Python {python}"))
        }
    };
    progress.event(ProgressEvent::Finished { stage: STAGE });
    Ok(SimBench {
        format: "recrash.bench-sim/1",
        scenarios: scenarios.len(),
        agent_steps,
        one_thread: fastest(&one),
        two_threads: fastest(&two),
        metadrive,
        metadrive_note,
        cores: std::thread::available_parallelism().map_or(1, usize::from),
    })
}

/// Agent-steps per second of so many threads, each running all scenarios again and again.
fn native(scenarios: &[Scenario], threads: usize, least: Duration) -> f64 {
    let begun = Instant::now();
    let steps: u64 = std::thread::scope(|scope| {
        let work = || {
            let mut runner = Runner::new();
            let mut steps = 0;
            while begun.elapsed() < least {
                steps += run_all(scenarios, &mut runner);
            }
            steps
        };
        let all: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        all.into_iter().map(|thread| thread.join().unwrap_or(0)).sum()
    });
    steps as f64 / begun.elapsed().as_secs_f64()
}

/// Runs every scenario once; gives the agent-steps.
fn run_all(scenarios: &[Scenario], runner: &mut Runner) -> u64 {
    let mut recorder = SummaryRecorder::new();
    let run = |scenario| {
        runner.run(scenario, Ego::MetadriveIdm, &mut recorder);
        recorder.summary.actors as u64 * u64::from(recorder.summary.steps)
    };
    scenarios.iter().map(run).sum()
}

fn fastest(figures: &[f64]) -> f64 {
    figures.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::NoProgress;

    #[test]
    fn without_metadrive_the_native_figures_stand_alone() {
        let request = SimBenchRequest {
            count: 3,
            seed: 1,
            rounds: 1,
            least: Duration::from_millis(20),
            python: "no-such-python".into(),
        };
        let bench = bench_sim(&request, &NoProgress).expect("it needs no MetaDrive");
        assert!(bench.one_thread > 0.0 && bench.two_threads > 0.0 && bench.agent_steps > 100);
        assert!(bench.metadrive.is_none() && bench.metadrive_note.contains("no-such-python"));
    }
}
