//! Which simulator: the native one, with an ego of its own or a program, or MetaDrive in Python workers.

pub(crate) mod external;

use crate::error::PipelineError;
use external::{EgoCommand, ExternalEgo, Patience};
use recrash_metadrive::{METADRIVE_VERSION, Metadrive};
use recrash_sim::{Ego, Native};
use serde::{Deserialize, Serialize};
use std::path::Path;

pub use recrash_roads::Simulator;

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

/// Sets up a simulator with an ego in it, both chosen by name. Python workers are started for MetaDrive alone, other programs for
/// an ego `cmd:PROGRAM`.
///
/// # Errors
/// There is no such ego, its program does not speak the protocol, or Python or MetaDrive is missing.
pub fn start_simulator(
    kind: SimulatorKind,
    ego: &str,
    python: &Path,
    workers: usize,
    patience: Patience,
) -> Result<Box<dyn Simulator>, PipelineError> {
    if let Some(command) = EgoCommand::parse(ego).map_err(PipelineError::bad_input)? {
        return match kind {
            SimulatorKind::Native => Ok(Box::new(ExternalEgo::start(command, patience)?)),
            SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
        };
    }
    let native: Ego = ego.parse().map_err(|e| PipelineError::bad_input(format!("{e}")))?;
    match kind {
        SimulatorKind::Native => Ok(Box::new(Native::new(native))),
        SimulatorKind::Metadrive if native == Ego::MetadriveIdm => {
            let options = recrash_metadrive::Options { workers, ..recrash_metadrive::Options::new(python) };
            let pool = Metadrive::start(options).map_err(|e| PipelineError::bad_input(e.to_string()))?;
            Ok(Box::new(pool))
        }
        SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
    }
}

/// Whether this simulator can run this ego, and its program is there, without starting anything.
///
/// # Errors
/// It cannot, or is not.
pub(crate) fn check_simulator(kind: SimulatorKind, ego: &str) -> Result<(), PipelineError> {
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

/// The built-in egos on the native simulator, which others are held against.
pub(crate) fn built_in() -> Vec<Box<dyn Simulator>> {
    Ego::DRIVERS.into_iter().map(|ego| Box::new(Native::new(ego)) as Box<dyn Simulator>).collect()
}

fn metadrive_only_runs_its_own(ego: &str) -> PipelineError {
    PipelineError::bad_input(format!(
        "MetaDrive {METADRIVE_VERSION} runs its own policy only: choose the ego metadrive-idm, or the native simulator for {ego}"
    ))
}
