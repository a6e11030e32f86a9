//! Scenarios: read, checked, run and judged.

use crate::ego::PythonEgo;
use crate::errors::{Kind, error, input, of_library, to_json};
use crate::run::Run;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyType};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_pipeline::{
    Options, Patience, PipelineError, Simulator, SimulatorKind, load_profile, parse_scenario, read_scenario, run_many,
    start_simulator,
};
use recrash_roads::write_draft;
use recrash_sim::{RolloutRecorder, Runner};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A checked scenario. It never changes.
#[pyclass(frozen, module = "recrash")]
#[derive(Clone)]
pub struct Scenario {
    pub scenario: Arc<recrash_roads::Scenario>,
    remarks: Vec<String>,
    crash_type: Option<String>,
}

#[pymethods]
impl Scenario {
    /// Reads and checks a scenario: the path of a file, or a dict as such a file has it.
    #[classmethod]
    fn load(_: &Bound<'_, PyType>, source: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = source.py();
        let read = if source.is_instance_of::<PyDict>() {
            let json = to_json(source)?;
            py.detach(|| parse_scenario(&json))
        } else {
            let path: PathBuf = source.extract()?;
            py.detach(|| read_scenario(&path))
        };
        read.map(|(scenario, remarks)| Self::of(scenario, remarks.iter().map(ToString::to_string).collect(), None))
            .map_err(|failed| of_library(py, &failed))
    }

    /// Its name.
    #[getter]
    pub fn id(&self) -> &str {
        &self.scenario.draft().id
    }

    /// Longest duration of a run. [s]
    #[getter]
    fn duration_s(&self) -> f64 {
        self.scenario.draft().duration_s
    }

    /// Reports of the crash that it tells, the fullest first.
    #[getter]
    fn reports(&self) -> Vec<String> {
        self.scenario.draft().source.records.iter().map(ToString::to_string).collect()
    }

    /// Template of the crash that it tells; `None` where nobody said.
    #[getter]
    fn template(&self) -> Option<String> {
        self.scenario.draft().source.template.map(|template| template.slug())
    }

    /// Type of the crash that it tells: that of the account it was reconstructed from, else its template; `None` where nobody said.
    #[getter]
    fn crash_type(&self) -> Option<String> {
        self.crash_type.clone().or_else(|| self.template())
    }

    /// Remarks on its file.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    /// Kinds of the other road users, in order.
    #[getter]
    fn kinds(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let draft = self.scenario.draft();
        let partners = draft.partners.iter().map(|partner| partner.kind);
        let kinds: Vec<_> = partners.chain(self.scenario.actors().iter().map(|actor| actor.kind)).collect();
        crate::errors::to_python(py, &kinds).map(Bound::unbind)
    }

    /// As its file has it.
    fn to_json(&self) -> String {
        write_draft(self.scenario.draft())
    }

    /// As its file has it.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        crate::errors::from_json(py, &self.to_json())
    }

    /// The same scenario with another seed of its background traffic.
    fn with_seed(&self, py: Python<'_>, seed: u64) -> PyResult<Self> {
        let mut draft = self.scenario.draft().clone();
        draft.traffic.seed = seed;
        let checked = recrash_roads::check(draft).map_err(|diagnostics| {
            let what = format!("{} with the seed {seed} is not a scenario that can be run", self.id());
            of_library(py, &PipelineError::BadInput { what, diagnostics })
        })?;
        Ok(Self::of(checked.value, self.remarks.clone(), self.crash_type.clone()))
    }

    /// Runs it and judges the run. `ego` is a name, a command, or an object that drives.
    #[pyo3(signature = (ego=None, *, seed=None, profile=None))]
    fn run(
        &self,
        py: Python<'_>,
        ego: Option<&Bound<'_, PyAny>>,
        seed: Option<u64>,
        profile: Option<&str>,
    ) -> PyResult<Run> {
        if let Some(seed) = seed {
            return self.with_seed(py, seed)?.run(py, ego, None, profile);
        }
        match ego.filter(|ego| !ego.is_instance_of::<PyString>()) {
            Some(object) => self.run_with(object, profile),
            None => {
                let name: Option<String> = ego.map(|ego| ego.extract()).transpose()?;
                let judged = py.detach(|| {
                    let profile = system_profile(profile)?;
                    let ego = name.as_deref().unwrap_or(&profile.ego);
                    let simulator = simulator(ego)?;
                    Ok(recrash_lab::run_scenario(&self.scenario, &simulator, &profile, None)?)
                });
                self.judged(judged.map_err(|failed: PipelineError| of_library(py, &failed))?)
            }
        }
    }

    fn __repr__(&self) -> String {
        format!("Scenario({:?}, {} s)", self.id(), self.duration_s())
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().scenario.draft() == self.scenario.draft())
    }

    fn __hash__(&self) -> u64 {
        let mut hash = recrash_model::hash::Fnv::default();
        hash.write(self.to_json().as_bytes());
        hash.finish()
    }

    /// Pickled as its JSON, so that it goes from process to process.
    #[allow(clippy::type_complexity, reason = "Python's protocol: a callable and its arguments")]
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String, Vec<String>, Option<String>))> {
        let restore = py.get_type::<Self>().getattr("_restore")?;
        Ok((restore, (self.to_json(), self.remarks.clone(), self.crash_type.clone())))
    }

    /// What `pickle` calls.
    #[staticmethod]
    fn _restore(py: Python<'_>, json: &str, remarks: Vec<String>, crash_type: Option<String>) -> PyResult<Self> {
        let (scenario, _) = parse_scenario(json).map_err(|failed| of_library(py, &failed))?;
        Ok(Self::of(scenario, remarks, crash_type))
    }
}

impl Scenario {
    pub fn of(scenario: recrash_roads::Scenario, remarks: Vec<String>, crash_type: Option<String>) -> Self {
        Self { scenario: Arc::new(scenario), remarks, crash_type }
    }

    /// A run of it.
    pub fn judged(&self, run: JudgedRun) -> PyResult<Run> {
        Ok(Run::of(run, Some(Arc::clone(&self.scenario))))
    }

    /// Runs it with a Python object in the ego's seat.
    fn run_with(&self, object: &Bound<'_, PyAny>, profile: Option<&str>) -> PyResult<Run> {
        let py = object.py();
        let profile = system_profile(profile).map_err(|failed| of_library(py, &failed))?;
        let mut ego = PythonEgo::new(object)?;
        let mut recorder = RolloutRecorder::new();
        Runner::new().run_with(&self.scenario, &mut ego, &mut recorder)?;
        let rollout =
            recorder.finish().ok_or_else(|| error(py, Kind::Other, format!("{}: nothing was recorded", self.id())))?;
        self.judged(py.detach(|| recrash_lab::judge(&self.scenario, rollout, &profile, None)))
    }
}

/// A profile by name or path; that of suites where none is named.
pub fn system_profile(name: Option<&str>) -> Result<SystemProfile, PipelineError> {
    load_profile(name.unwrap_or(&Options::default().profile))
}

/// The native simulator with an ego by name.
fn simulator(ego: &str) -> Result<Box<dyn Simulator>, PipelineError> {
    start_simulator(SimulatorKind::Native, ego, Path::new("python3"), 1, Patience::default())
}

/// Runs many scenarios with an ego by name, on all cores. What one fails of stands in its place.
#[pyfunction]
#[pyo3(signature = (scenarios, ego=None, profile=None))]
pub fn run_all<'py>(
    py: Python<'py>,
    scenarios: Vec<Bound<'py, Scenario>>,
    ego: Option<&str>,
    profile: Option<&str>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if scenarios.is_empty() {
        return Err(input(py, "there is no scenario to run"));
    }
    let each: Vec<&Scenario> = scenarios.iter().map(Bound::get).collect();
    let all: Vec<&recrash_roads::Scenario> = each.iter().map(|scenario| &*scenario.scenario).collect();
    let done = py.detach(|| {
        let profile = system_profile(profile)?;
        let simulator = simulator(ego.unwrap_or(&profile.ego))?;
        Ok(run_many(&all, &simulator, &profile))
    });
    let done = done.map_err(|failed: PipelineError| of_library(py, &failed))?;
    let result = |(scenario, done): (&&Scenario, Result<JudgedRun, PipelineError>)| match done {
        Ok(run) => Ok(Bound::new(py, scenario.judged(run)?)?.into_any()),
        Err(failed) => Ok(of_library(py, &failed).into_value(py).into_bound(py).into_any()),
    };
    each.iter().zip(done).map(result).collect()
}
