//! Where scenarios are run: the native simulator, or MetaDrive in an interpreter that has it.

use crate::errors::{Kind, error, input, of_library};
use pyo3::prelude::*;
use recrash_pipeline::{Patience, PipelineError, SimulatorKind, metadrive_egos, start_simulator};
use std::path::PathBuf;

/// Where scenarios are run.
pub struct Host {
    kind: SimulatorKind,
    python: PathBuf,
}

impl Host {
    /// A simulator by name; the native one where none is named.
    pub fn of(py: Python<'_>, simulator: Option<&str>, python: Option<PathBuf>) -> PyResult<Self> {
        let kind = simulator.map_or(Ok(SimulatorKind::Native), str::parse).map_err(|why| input(py, why))?;
        Ok(Self { kind, python: interpreter(py, python)? })
    }

    /// Starts it with an ego by name.
    pub fn start(&self, ego: &str, workers: usize) -> Result<Box<dyn recrash_pipeline::Simulator>, PipelineError> {
        start_simulator(self.kind, ego, &self.python, workers, Patience::default())
    }

    /// A Python object can be the ego there.
    pub fn must_be_native(&self, py: Python<'_>) -> PyResult<()> {
        match self.kind {
            SimulatorKind::Native => Ok(()),
            SimulatorKind::Metadrive => Err(input(
                py,
                format!(
                    "a Python object drives on the native simulator; MetaDrive runs its own egos: {}",
                    metadrive_egos().join(", ")
                ),
            )),
        }
    }

    /// What it could not run: the ego's fault only where the ego is no part of the simulator.
    pub fn failed(&self, py: Python<'_>, failed: &PipelineError) -> PyErr {
        match (self.kind, failed) {
            (SimulatorKind::Metadrive, PipelineError::Scenario { .. }) => error(py, Kind::Other, failed.to_string()),
            _ => of_library(py, failed),
        }
    }
}

/// The interpreter that has MetaDrive: this one where none is named.
pub fn interpreter(py: Python<'_>, given: Option<PathBuf>) -> PyResult<PathBuf> {
    match given {
        Some(python) => Ok(python),
        None => py.import("sys")?.getattr("executable")?.extract(),
    }
}
