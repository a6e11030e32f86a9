//! Egos that are programs of the user's: child processes that speak JSON lines, as `docs/ego-protocol.md` says.
//!
//! One process serves one thread at a time and lives from scenario to scenario. Whatever a program does wrong (it hangs,
//! ends, prints rubbish) fails the scenario it was driving, with a reason; the process is ended, and the next scenario
//! gets a new one.

mod command;
mod fingerprint;
mod process;
mod protocol;

pub(crate) use command::PYTHON_PREFIX;
pub use command::{EGO_COMMAND_PREFIX, EgoCommand, default_python};
pub(crate) use fingerprint::FILES_UNKNOWN;
pub use process::{EgoFault, Patience};
pub use protocol::{told_at_reset, told_at_step};

use crate::error::PipelineError;
use process::EgoProcess;
use recrash_model::rollout::{Rollout, Substeps};
use recrash_roads::{AnswerTimes, RunError, Scenario, Simulator};
use recrash_sim::{Native, RolloutRecorder, Runner};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// What an ego is, for telling whether a result is of it as it is now: its name, and a program's files, which are read. `python`
/// runs one that is a class or function in Python.
///
/// # Errors
/// The command cannot be read.
pub(crate) fn identity(ego: &str, python: &Path) -> Result<Vec<String>, PipelineError> {
    let command = EgoCommand::parse(ego).map_err(PipelineError::bad_input)?;
    let made = command.map(|command| fingerprint::fingerprint(&command.interpreted_by(python)));
    Ok(made.unwrap_or_else(|| vec![ego.to_owned()]))
}

/// The native simulator with a program as the ego, ready to drive. It may be shared between threads.
pub struct ExternalEgo {
    command: EgoCommand,
    patience: Patience,
    idle: Mutex<Vec<EgoProcess>>,
    /// How long every decision so far was waited for. [us]
    waited_us: Mutex<Vec<u32>>,
}

impl ExternalEgo {
    /// Starts the first process; others follow when several threads need them.
    ///
    /// # Errors
    /// The program cannot be started, or does not speak the protocol.
    pub fn start(command: EgoCommand, patience: Patience) -> Result<Self, PipelineError> {
        let first = EgoProcess::start(&command, patience)
            .map_err(|fault| PipelineError::bad_input(format!("the ego {command}: {fault}")))?;
        Ok(Self { command, patience, idle: Mutex::new(vec![first]), waited_us: Mutex::default() })
    }

    fn rollout(&self, scenario: &Scenario, substeps: Substeps) -> Result<Rollout, RunError> {
        let failed = |fault: EgoFault| RunError::new(scenario, format!("the ego {fault}"));
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut process = match idle {
            Some(process) => process,
            None => EgoProcess::start(&self.command, self.patience).map_err(failed)?,
        };
        let mut recorder = RolloutRecorder::new();
        // A process with a fault is dropped, which ends it: what it has in its memory is not known.
        let run = Runner::new().stepping(substeps).run_with(scenario, &mut process, &mut recorder);
        self.waited_us.lock().unwrap_or_else(PoisonError::into_inner).extend(process.take_waited());
        run.map_err(failed)?;
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(process);
        Ok(recorder.finish().unwrap_or_else(|| unreachable!("a run begins and ends")))
    }
}

impl Simulator for ExternalEgo {
    fn name(&self) -> &str {
        Native::NAME
    }

    fn version(&self) -> &str {
        Native::VERSION
    }

    fn ego(&self) -> &str {
        self.command.as_str()
    }

    fn answer_times(&self) -> Option<AnswerTimes> {
        let mut waited = self.waited_us.lock().unwrap_or_else(PoisonError::into_inner).clone();
        waited.sort_unstable();
        let seconds = |us: &u32| f64::from(*us) * 1e-6;
        let (median_s, greatest_s) = (waited.get(waited.len() / 2).map(seconds)?, waited.last().map(seconds)?);
        Some(AnswerTimes { answers: waited.len(), median_s, greatest_s })
    }

    /// It fails where the program does: what that did, and at which step.
    fn run(&self, scenario: &Scenario) -> Result<Rollout, RunError> {
        self.rollout(scenario, Substeps::default())
    }

    fn run_in(&self, scenario: &Scenario, substeps: Substeps) -> Option<Result<Rollout, RunError>> {
        Some(self.rollout(scenario, substeps))
    }
}
