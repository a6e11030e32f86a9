//! The pool: several workers, faults mended, results in the order of the scenarios.

use crate::protocol::{Drive, rollout, run_spec};
use crate::worker::{Worker, WorkerFault};
use crate::{METADRIVE_VERSION, MetadriveError};
use recrash_model::rollout::Rollout;
use recrash_plan::metadrive::Run;
use recrash_roads::{RunError, Scenario, Simulator};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// A worker keeps every map it has built, 2.6 MB each; after this many it is replaced.
const MOST_MAPS: u64 = 150;

/// Where Python is, and how much of it to run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    /// The interpreter: a name to look for or a path.
    pub python: PathBuf,
    /// Workers at once, at least 1; each takes about 300 MB.
    pub workers: usize,
    /// How long a worker may take to import MetaDrive.
    pub start_patience: Duration,
    /// How long a worker may take for one scenario; a minute of simulated time takes about a second.
    pub run_patience: Duration,
}

impl Options {
    /// One worker on this interpreter, with patience for a slow machine.
    pub fn new(python: impl Into<PathBuf>) -> Self {
        Self {
            python: python.into(),
            workers: 1,
            start_patience: Duration::from_secs(120),
            run_patience: Duration::from_secs(120),
        }
    }
}

/// MetaDrive, ready to run scenarios. It may be shared between threads.
pub struct Metadrive {
    options: Options,
    drive: Drive,
    state: Mutex<State>,
    returned: Condvar,
    versions: (String, String),
}

#[derive(Default)]
struct State {
    idle: Vec<Worker>,
    busy: usize,
}

impl std::fmt::Debug for Metadrive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Metadrive").field("options", &self.options).field("versions", &self.versions).finish()
    }
}

impl Metadrive {
    /// Starts the first worker; the others follow when they are needed.
    ///
    /// # Errors
    /// When Python or MetaDrive is missing, or of another version.
    pub fn start(options: Options) -> Result<Self, MetadriveError> {
        let worker = Worker::start(&options.python, options.start_patience)?;
        let hello = worker.hello();
        let versions = (hello.python.clone(), hello.metadrive.clone().unwrap_or_default());
        let state = Mutex::new(State { idle: vec![worker], busy: 0 });
        Ok(Self { options, drive: Drive::MetadriveIdm, state, returned: Condvar::new(), versions })
    }

    /// The same pool with another driver in the ego's seat where it stands for a simulator with an ego; without, MetaDrive's IDM
    /// policy.
    #[must_use]
    pub fn driven_by(self, drive: Drive) -> Self {
        Self { drive, ..self }
    }

    /// Versions of Python and of MetaDrive.
    pub fn versions(&self) -> (&str, &str) {
        (&self.versions.0, &self.versions.1)
    }

    /// Runs one scenario, waiting for a free worker first. Where there is nothing to test, no policy takes over from the
    /// recorded driver.
    ///
    /// # Errors
    /// When it failed on two workers, or no new worker can be started.
    pub fn simulate(&self, scenario: &Scenario, drive: &Drive) -> Result<Rollout, MetadriveError> {
        let drive = if scenario.draft().is_tested() { drive } else { drive.of_nobody() };
        let refused = |why| MetadriveError::Refused { scenario: scenario.draft().id.clone(), why };
        let spec = run_spec(scenario, drive).map_err(refused)?;
        let first = match self.attempt(scenario, drive, &spec)? {
            Ok(rollout) => return Ok(rollout),
            // It would be refused again.
            Err(WorkerFault::Refused { why }) => return Err(refused(why)),
            Err(fault) => fault,
        };
        match self.attempt(scenario, drive, &spec)? {
            Ok(rollout) => Ok(rollout),
            Err(second) => Err(MetadriveError::Failed { scenario: scenario.draft().id.clone(), first, second }),
        }
    }

    /// Runs scenarios on all workers, and gives the results in the order of the scenarios. `done` is called with the
    /// number of results so far, from several threads.
    pub fn simulate_all(
        &self,
        scenarios: &[Scenario],
        drive: &Drive,
        done: &(dyn Fn(usize) + Sync),
    ) -> Vec<Result<Rollout, MetadriveError>> {
        let next = AtomicUsize::new(0);
        let finished = AtomicUsize::new(0);
        let results: Vec<Mutex<Option<Result<Rollout, MetadriveError>>>> =
            scenarios.iter().map(|_| Mutex::new(None)).collect();
        std::thread::scope(|scope| {
            for _ in 0..self.options.workers.max(1).min(scenarios.len()) {
                scope.spawn(|| {
                    while let Some(scenario) = {
                        let position = next.fetch_add(1, Ordering::Relaxed);
                        scenarios.get(position).map(|scenario| (position, scenario))
                    } {
                        let result = self.simulate(scenario.1, drive);
                        *results[scenario.0].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
                        done(finished.fetch_add(1, Ordering::Relaxed) + 1);
                    }
                });
            }
        });
        results
            .into_iter()
            .map(|result| result.into_inner().unwrap_or_else(PoisonError::into_inner))
            .map(|result| result.unwrap_or_else(|| unreachable!("every scenario was run")))
            .collect()
    }

    /// One attempt. A worker with a fault is not used again: what it has in its memory is not known.
    fn attempt(
        &self,
        scenario: &Scenario,
        drive: &Drive,
        spec: &Run,
    ) -> Result<Result<Rollout, WorkerFault>, MetadriveError> {
        let mut slot = Slot { pool: self, worker: self.take() };
        let worker = match &mut slot.worker {
            Some(worker) => worker,
            None => slot.worker.insert(Worker::start(&self.options.python, self.options.start_patience)?),
        };
        let result = worker.run(spec, self.options.run_patience).and_then(|done| {
            rollout(scenario, drive, spec, done)
                .ok_or_else(|| WorkerFault::Rubbish { beginning: "an answer to another scenario".to_owned() })
        });
        let fault = matches!(&result, Err(fault) if !matches!(fault, WorkerFault::Refused { .. }));
        if fault || worker.maps >= MOST_MAPS {
            slot.worker = None;
        }
        Ok(result)
    }

    /// Waits until a worker may be used; `None` when it has to be started.
    fn take(&self) -> Option<Worker> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        while state.busy >= self.options.workers.max(1) {
            state = self.returned.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.busy += 1;
        state.idle.pop()
    }
}

/// With the driver that was chosen as the ego.
impl Simulator for Metadrive {
    fn name(&self) -> &str {
        "MetaDrive"
    }

    fn version(&self) -> &str {
        METADRIVE_VERSION
    }

    fn ego(&self) -> &str {
        self.drive.name()
    }

    fn run(&self, scenario: &Scenario) -> Result<Rollout, RunError> {
        self.simulate(scenario, &self.drive).map_err(|error| RunError::new(scenario, error))
    }
}

/// The right to use one worker, given back when dropped.
struct Slot<'a> {
    pool: &'a Metadrive,
    worker: Option<Worker>,
}

impl Drop for Slot<'_> {
    fn drop(&mut self) {
        let mut state = self.pool.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.busy -= 1;
        state.idle.extend(self.worker.take());
        drop(state);
        self.pool.returned.notify_one();
    }
}
