//! The simulators behind one door: the native one, and MetaDrive in Python workers.

use crate::error::PipelineError;
use crate::external::{EgoCommand, ExternalEgo, Patience};
use crate::suite::Suite;
use recrash_metadrive::{Drive, METADRIVE_VERSION, Metadrive};
use recrash_model::rollout::Rollout;
use recrash_roads::Scenario;
use recrash_search::Searcher;
use recrash_sim::Ego;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Which simulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SimulatorKind {
    /// Ours.
    #[default]
    Native,
    /// MetaDrive.
    Metadrive,
}

impl SimulatorKind {
    /// Every simulator.
    pub const ALL: [Self; 2] = [Self::Native, Self::Metadrive];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Native => "native",
            Self::Metadrive => "metadrive",
        }
    }
}

impl std::str::FromStr for SimulatorKind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::ALL.map(Self::name).join(", ");
        Self::ALL
            .into_iter()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| format!("there is no simulator \"{name}\"; there are: {known}"))
    }
}

/// A simulator with the system under test in it.
pub enum Simulator {
    /// The native one.
    Native(Ego),
    /// The native one, with a program as the ego.
    External(Box<ExternalEgo>),
    /// MetaDrive, with its own IDM policy as the ego.
    Metadrive(Box<Metadrive>),
}

impl Simulator {
    /// Sets up a simulator. Python workers are started for MetaDrive alone, other programs for an ego `cmd:PROGRAM`.
    ///
    /// # Errors
    /// There is no such ego, its program does not speak the protocol, or Python or MetaDrive is missing.
    pub fn start(
        kind: SimulatorKind,
        ego: &str,
        python: &Path,
        workers: usize,
        patience: Patience,
    ) -> Result<Self, PipelineError> {
        if let Some(command) = EgoCommand::parse(ego).map_err(PipelineError::bad_input)? {
            return match kind {
                SimulatorKind::Native => Ok(Self::External(Box::new(ExternalEgo::start(command, patience)?))),
                SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
            };
        }
        let native: Ego = ego.parse().map_err(|e| PipelineError::bad_input(format!("{e}")))?;
        match kind {
            SimulatorKind::Native => Ok(Self::Native(native)),
            SimulatorKind::Metadrive if native == Ego::MetadriveIdm => {
                let options = recrash_metadrive::Options { workers, ..recrash_metadrive::Options::new(python) };
                let pool = Metadrive::start(options).map_err(|e| PipelineError::bad_input(e.to_string()))?;
                Ok(Self::Metadrive(Box::new(pool)))
            }
            SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
        }
    }

    /// Runs a scenario.
    ///
    /// # Errors
    /// [`PipelineError::Scenario`] where MetaDrive failed on it twice, or an external ego once. The native simulator with
    /// its own egos cannot fail.
    pub fn run(&self, scenario: &Scenario) -> Result<Rollout, PipelineError> {
        match self {
            Self::Native(ego) => Ok(recrash_sim::simulate(scenario, *ego)),
            Self::External(ego) => ego.run(scenario),
            Self::Metadrive(pool) => pool.simulate(scenario, &Drive::MetadriveIdm).map_err(|e| {
                PipelineError::scenario(&scenario.draft().id, crate::secrets::scrubber().scrub(&e.to_string()))
            }),
        }
    }
}

/// Checks what a run needs only after its models were asked, which may cost: the ego, its program, and the optimiser.
///
/// # Errors
/// One of them is not there.
pub fn check_choices(suite: &Suite) -> Result<(), PipelineError> {
    suite.options().searcher.parse::<Searcher>().map_err(PipelineError::bad_input)?;
    let (kind, ego) = (suite.options().simulator, suite.ego());
    match EgoCommand::parse(ego).map_err(PipelineError::bad_input)? {
        Some(_) if kind == SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
        Some(command) if !command.is_there() => Err(PipelineError::bad_input(format!(
            "the ego {command}: there is no such program; check its name and path"
        ))),
        Some(_) => Ok(()),
        None => match ego.parse::<Ego>().map_err(|e| PipelineError::bad_input(format!("{e}")))? {
            native if kind == SimulatorKind::Metadrive && native != Ego::MetadriveIdm => {
                Err(metadrive_only_runs_its_own(ego))
            }
            _ => Ok(()),
        },
    }
}

fn metadrive_only_runs_its_own(ego: &str) -> PipelineError {
    PipelineError::bad_input(format!(
        "MetaDrive {METADRIVE_VERSION} runs its own policy only: choose --ego metadrive-idm, or --sim native for {ego}"
    ))
}
