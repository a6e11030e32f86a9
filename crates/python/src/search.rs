//! Sweeps and searches around scenarios that stand in no file.

use crate::errors::{input, of_library, to_python};
use crate::host::Host;
use crate::run::Run;
use crate::scenario::{Scenario, system_profile};
use crate::table::Table;
use pyo3::prelude::*;
use recrash_pipeline::{PipelineError, SweepPoints, Vary, tune_scenario};

/// What varies around scenarios: any rollout of it is made of its number alone, on any machine and in any order.
#[pyclass(frozen, module = "recrash._recrash")]
pub struct Points {
    points: SweepPoints,
    ego: String,
}

#[pymethods]
impl Points {
    /// Around these scenarios: `vary` (`"/partners/0/speed_mps=5:12"`) in each of them, what a search would move without it.
    #[new]
    #[pyo3(signature = (scenarios, vary, ego=None, profile=None, seed=0))]
    fn new(
        py: Python<'_>,
        scenarios: Vec<Bound<'_, Scenario>>,
        vary: Vec<String>,
        ego: Option<String>,
        profile: Option<&str>,
        seed: u64,
    ) -> PyResult<Self> {
        let vary: Result<Vec<Vary>, String> = vary.iter().map(|each| each.parse()).collect();
        let vary = vary.map_err(|why| input(py, why))?;
        let each: Vec<&recrash_roads::Scenario> = scenarios.iter().map(|one| &*one.get().scenario).collect();
        let made = || {
            let profile = system_profile(profile)?;
            let ego = ego.unwrap_or_else(|| profile.ego.clone());
            Ok(Self { points: SweepPoints::around(&each, &vary, profile, seed)?, ego })
        };
        made().map_err(|failed: PipelineError| of_library(py, &failed))
    }

    /// The ego that drives.
    #[getter]
    fn ego(&self) -> &str {
        &self.ego
    }

    /// Rollouts `begin` to `end` (which is not among them), a row each; on as many threads as there are cores, or as are given.
    #[pyo3(signature = (begin, end, threads=0))]
    fn rows(&self, py: Python<'_>, begin: u64, end: u64, threads: usize) -> PyResult<Table> {
        let host = Host::of(py, None, None)?;
        let done = py.detach(|| self.points.table(begin..end, &host.start(&self.ego, 1)?, threads));
        Table::of_named(py, done.map_err(|failed: PipelineError| of_library(py, &failed))?)
    }

    /// The scenario of one rollout.
    fn scenario(&self, py: Python<'_>, number: u64) -> PyResult<Scenario> {
        let checked = self.points.draft(number).and_then(|draft| {
            recrash_roads::check(draft).map_err(|diagnostics| PipelineError::BadInput {
                what: format!("rollout {number} is not a scenario that can be run"),
                diagnostics,
            })
        });
        let checked = checked.map_err(|failed| of_library(py, &failed))?;
        Ok(Scenario::of(checked.value, Vec::new(), None))
    }
}

/// Searches the nearest failure around a scenario: the tuned scenario, the ego's run in it, and what was tried.
#[pyfunction]
#[pyo3(signature = (scenario, ego=None, profile=None, budget=160, seed=0, searcher="cma"))]
pub fn tune_one<'py>(
    py: Python<'py>,
    scenario: &Bound<'py, Scenario>,
    ego: Option<&str>,
    profile: Option<&str>,
    budget: usize,
    seed: u64,
    searcher: &str,
) -> PyResult<(Scenario, Run, Bound<'py, PyAny>)> {
    let (host, of) = (Host::of(py, None, None)?, scenario.get());
    let tuned = py.detach(|| {
        let profile = system_profile(profile)?;
        let simulator = host.start(ego.unwrap_or(&profile.ego), 1)?;
        let tuned = tune_scenario(&of.scenario, &simulator, &profile, searcher, budget, seed)?;
        let made = Scenario::of(tuned.scenario, Vec::new(), of.known_type());
        let run = made.judged(tuned.run, &profile);
        Ok((made, run, tuned.log))
    });
    let (made, run, log) = tuned.map_err(|failed: PipelineError| of_library(py, &failed))?;
    Ok((made, run, to_python(py, &log)?))
}
