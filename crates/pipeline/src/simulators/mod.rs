//! Which simulator: the native one, with an ego of its own or a program, or MetaDrive in Python workers.

pub(crate) mod external;

use crate::error::PipelineError;
use external::{EgoCommand, ExternalEgo, Patience};
use recrash_metadrive::{Drive, METADRIVE_VERSION, Metadrive};
use recrash_sim::{Ego, Native};
use serde::{Deserialize, Serialize};
use std::path::Path;

pub use recrash_roads::Simulator;

/// Egos that drive on MetaDrive: policies of its own.
pub fn metadrive_egos() -> [&'static str; 2] {
    Drive::POLICIES.map(|drive| drive.name())
}

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

/// Sets up a simulator with an ego in it, both chosen by name. Python workers are started for MetaDrive and an ego
/// `py:MODULE:NAME`, other programs for an ego `cmd:PROGRAM`.
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
            SimulatorKind::Native => Ok(Box::new(ExternalEgo::start(command.interpreted_by(python), patience)?)),
            SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
        };
    }
    match kind {
        SimulatorKind::Native => Ok(Box::new(Native::new(native_ego(ego)?))),
        SimulatorKind::Metadrive => {
            let drive = metadrive_policy(ego)?;
            let options = recrash_metadrive::Options { workers, ..recrash_metadrive::Options::new(python) };
            let pool = Metadrive::start(options).map_err(|e| PipelineError::bad_input(e.to_string()))?;
            Ok(Box::new(pool.driven_by(drive)))
        }
    }
}

/// Whether an ego is one of MetaDrive's that the native simulator does not have.
pub(crate) fn drives_on_metadrive_alone(ego: &str) -> bool {
    metadrive_egos().contains(&ego) && ego != Ego::MetadriveIdm.name()
}

/// An ego of the native simulator.
fn native_ego(ego: &str) -> Result<Ego, PipelineError> {
    if drives_on_metadrive_alone(ego) {
        let text = format!("{ego} drives on MetaDrive alone: choose the simulator metadrive for it");
        return Err(PipelineError::bad_input(text));
    }
    ego.parse().map_err(|e| PipelineError::bad_input(format!("{e}")))
}

/// A policy of MetaDrive's own.
fn metadrive_policy(ego: &str) -> Result<Drive, PipelineError> {
    match Drive::POLICIES.into_iter().find(|drive| drive.name() == ego) {
        Some(drive) => Ok(drive),
        None => native_ego(ego).and_then(|_| Err(metadrive_only_runs_its_own(ego))),
    }
}

/// Whether this simulator can run this ego, and its program is there, without starting anything.
///
/// # Errors
/// It cannot, or is not.
pub(crate) fn check_simulator(kind: SimulatorKind, ego: &str, python: &Path) -> Result<(), PipelineError> {
    let command = EgoCommand::parse(ego).map_err(PipelineError::bad_input)?;
    match command.map(|command| command.interpreted_by(python)) {
        Some(_) if kind == SimulatorKind::Metadrive => Err(metadrive_only_runs_its_own(ego)),
        Some(command) if !command.is_there() => Err(PipelineError::bad_input(format!(
            "the ego {command}: there is no such program; check its name and path"
        ))),
        Some(_) => Ok(()),
        None => match kind {
            SimulatorKind::Native => native_ego(ego).map(drop),
            SimulatorKind::Metadrive => metadrive_policy(ego).map(drop),
        },
    }
}

/// The built-in egos on the native simulator, which others are held against.
pub(crate) fn built_in() -> Vec<Box<dyn Simulator>> {
    Ego::DRIVERS.into_iter().map(|ego| Box::new(Native::new(ego)) as Box<dyn Simulator>).collect()
}

fn metadrive_only_runs_its_own(ego: &str) -> PipelineError {
    PipelineError::bad_input(format!(
        "MetaDrive {METADRIVE_VERSION} runs its own policies only: choose the ego {}, or the native simulator for {ego}",
        metadrive_egos().join(" or ")
    ))
}
