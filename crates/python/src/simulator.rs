//! Simulators: the native one, or MetaDrive, each with an ego by name.

use crate::errors::{input, of_library};
use crate::host::Host;
use crate::run::Run;
use crate::scenario::{Scenario, system_profile};
use pyo3::prelude::*;
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_pipeline::{PipelineError, run_many};
use std::path::PathBuf;
use std::sync::Arc;

/// A simulator with an ego in it, for many scenarios: what takes seconds to start (MetaDrive, an ego that is a program) is started
/// once.
#[pyclass(frozen, module = "recrash._recrash")]
pub struct Simulator {
    host: Host,
    profile: SystemProfile,
    threads: usize,
    simulator: Box<dyn recrash_pipeline::Simulator>,
}

#[pymethods]
impl Simulator {
    /// Starts it. `threads` scenarios run at a time: as many as there are cores without.
    #[new]
    #[pyo3(signature = (ego=None, profile=None, simulator=None, python=None, threads=None))]
    fn new(
        py: Python<'_>,
        ego: Option<&str>,
        profile: Option<&str>,
        simulator: Option<&str>,
        python: Option<PathBuf>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let host = Host::of(py, simulator, python)?;
        let threads = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
        let started = py.detach(|| {
            let profile = system_profile(profile)?;
            let simulator = host.start(ego.unwrap_or(&profile.ego), threads)?;
            Ok((profile, simulator))
        });
        let (profile, simulator) = started.map_err(|failed: PipelineError| of_library(py, &failed))?;
        Ok(Self { host, profile, threads, simulator })
    }

    /// Name of the ego.
    #[getter]
    fn ego(&self) -> &str {
        self.simulator.ego()
    }

    /// Runs scenarios and judges the runs, in their order. What one fails of stands in its place.
    fn run_all<'py>(&self, py: Python<'py>, scenarios: Vec<Bound<'py, Scenario>>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        if scenarios.is_empty() {
            return Err(input(py, "there is no scenario to run"));
        }
        let each: Vec<&Scenario> = scenarios.iter().map(Bound::get).collect();
        let all: Vec<&recrash_roads::Scenario> = each.iter().map(|scenario| &*scenario.scenario).collect();
        let done = py.detach(|| run_many(&all, &self.simulator, &self.profile, self.threads));
        let done = done.map_err(|failed| of_library(py, &failed))?;
        let result = |(scenario, done): (&&Scenario, Result<JudgedRun, PipelineError>)| match done {
            Ok(run) => Ok(Bound::new(py, Run::of(run, Some(Arc::clone(&scenario.scenario))))?.into_any()),
            Err(failed) => Ok(self.host.failed(py, &failed).into_value(py).into_bound(py).into_any()),
        };
        each.iter().zip(done).map(result).collect()
    }
}
