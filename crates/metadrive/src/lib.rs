//! MetaDrive 0.4.3 as a second simulator, for the same checked scenarios and with the same result, a [`Rollout`](recrash_model::rollout::Rollout).
//!
//! MetaDrive lives in Python. [`Metadrive`] keeps long-lived worker processes that speak JSON lines; the script they run
//! is part of this crate. A worker that hangs, dies or prints rubbish is replaced, its scenario tried once more and then
//! given back as failed. How the world is set up there, and where it differs from the native simulator:
//! `docs/models/metadrive-backend.md`.
//!
//! This is the one stage crate that starts processes and threads. It reads no environment: where Python is comes in
//! [`Options`].
//!
//! ```no_run
//! # fn scenarios() -> Vec<recrash_roads::Scenario> { Vec::new() }
//! use recrash_metadrive::{Drive, Metadrive, Options};
//!
//! let metadrive = Metadrive::start(Options::new("python3"))?;
//! for rollout in metadrive.simulate_all(&scenarios(), &Drive::MetadriveIdm, &|_done| {}) {
//!     println!("{:?}", rollout?.termination);
//! }
//! # Ok::<(), recrash_metadrive::MetadriveError>(())
//! ```

mod doctor;
mod pool;
mod protocol;
mod worker;

pub use doctor::{Inspection, inspect};
pub use pool::{Metadrive, Options};
pub use protocol::Drive;
pub use worker::{NotReady, WorkerFault};

use std::path::PathBuf;

/// The version of MetaDrive the worker is written for.
pub const METADRIVE_VERSION: &str = "0.4.3";

/// How to get it.
pub const INSTALL_HINT: &str = "pip install metadrive-simulator==0.4.3 (Python 3.7 to 3.11)";

/// Why there is no rollout.
#[derive(Debug, thiserror::Error)]
pub enum MetadriveError {
    /// The interpreter could not be started.
    #[error("cannot start Python as `{}`: {reason}; install Python 3.7 to 3.11, or name another interpreter", python.display())]
    NoPython {
        /// What was tried.
        python: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// Python runs, but MetaDrive cannot be used.
    #[error("{reason}")]
    NotReady {
        /// Why.
        reason: NotReady,
    },
    /// What happens in a scenario cannot happen, or cannot be known, on MetaDrive.
    #[error("scenario `{scenario}` cannot be held by MetaDrive: {why}; run it on the native simulator")]
    Refused {
        /// The scenario's id.
        scenario: String,
        /// What it is that cannot be held.
        why: String,
    },
    /// A scenario failed twice, the second time on a new worker.
    #[error("scenario `{scenario}` failed twice on MetaDrive: {first}; then: {second}")]
    Failed {
        /// The scenario's id.
        scenario: String,
        /// The first time.
        first: WorkerFault,
        /// The second time.
        second: WorkerFault,
    },
}

impl MetadriveError {
    /// Whether it is the scenario that cannot be held, and not a fault.
    pub fn is_refused(&self) -> bool {
        matches!(self, Self::Refused { .. })
    }

    /// Whether it can be mended by installing MetaDrive: Python runs, and the package is not there.
    pub fn is_missing(&self) -> bool {
        matches!(self, Self::NotReady { reason: NotReady::Missing { .. } })
    }
}
