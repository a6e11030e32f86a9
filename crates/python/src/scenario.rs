//! Scenarios: read, checked, run and judged.

use crate::ego::PythonEgo;
use crate::errors::{Kind, error, of_library, to_json};
use crate::host::Host;
use crate::run::Run;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyType};
use recrash_model::profile::SystemProfile;
use recrash_model::run::JudgedRun;
use recrash_pipeline::{Options, PipelineError, load_profile, parse_scenario, read_scenario};
use recrash_roads::write_draft;
use recrash_sim::{RolloutRecorder, Runner};
use std::path::PathBuf;
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
    /// Reads and checks a scenario: the path of a file, or a dict as such a file has it. `crash_type` is told of its crash elsewhere.
    #[classmethod]
    #[pyo3(signature = (source, *, crash_type=None))]
    fn load(_: &Bound<'_, PyType>, source: &Bound<'_, PyAny>, crash_type: Option<String>) -> PyResult<Self> {
        let py = source.py();
        let read = if source.is_instance_of::<PyDict>() {
            let json = to_json(source)?;
            py.detach(|| parse_scenario(&json))
        } else {
            let path: PathBuf = source.extract()?;
            py.detach(|| read_scenario(&path))
        };
        read.map(|(scenario, remarks)| {
            Self::of(scenario, remarks.iter().map(ToString::to_string).collect(), crash_type)
        })
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

    /// Whether there is something to test: of a record whose ego was parked nobody takes over.
    #[getter]
    fn tested(&self) -> bool {
        self.scenario.draft().is_tested()
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

    /// Runs it and judges the run. `ego` is a name, a command, or an object that drives; `simulator` is `native` or `metadrive`,
    /// `python` the interpreter that has MetaDrive (this one without). MetaDrive takes seconds to start: `recrash.test` starts it
    /// once for many scenarios. Of a record whose ego was parked (`tested` is false) the recorded driver drives, whoever is named, and
    /// the run has neither `failed` nor `met`.
    #[pyo3(signature = (ego=None, *, seed=None, profile=None, simulator=None, python=None))]
    fn run(
        &self,
        py: Python<'_>,
        ego: Option<&Bound<'_, PyAny>>,
        seed: Option<u64>,
        profile: Option<&str>,
        simulator: Option<&str>,
        python: Option<PathBuf>,
    ) -> PyResult<Run> {
        if let Some(seed) = seed {
            return self.with_seed(py, seed)?.run(py, ego, None, profile, simulator, python);
        }
        let host = Host::of(py, simulator, python)?;
        match ego.filter(|ego| !ego.is_instance_of::<PyString>()) {
            Some(object) => host.must_be_native(py).and_then(|()| self.run_with(object, profile)),
            None => {
                let name: Option<String> = ego.map(|ego| ego.extract()).transpose()?;
                let judged = py.detach(|| {
                    let profile = system_profile(profile)?;
                    let simulator = host.start(name.as_deref().unwrap_or(&profile.ego), 1)?;
                    let run = recrash_lab::run_scenario(&self.scenario, &simulator, &profile, None)?;
                    Ok(self.judged(run, &profile))
                });
                judged.map_err(|failed: PipelineError| host.failed(py, &failed))
            }
        }
    }

    /// Its replay for a notebook, with the recorded driver.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("recrash._show")?.call_method1("scenario_html", (slf,))
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

    /// The type of the account it was reconstructed from.
    pub fn known_type(&self) -> Option<String> {
        self.crash_type.clone()
    }

    /// A run of it, with whether it came into the situation of its record.
    pub fn judged(&self, mut run: JudgedRun, profile: &SystemProfile) -> Run {
        recrash_pipeline::ask_for_situation(&self.scenario, &mut run, profile);
        Run::of(run, Some(Arc::clone(&self.scenario)))
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
        Ok(py.detach(|| self.judged(recrash_lab::judge(&self.scenario, rollout, &profile, None), &profile)))
    }
}

/// A profile by name or path; that of suites where none is named.
pub fn system_profile(name: Option<&str>) -> Result<SystemProfile, PipelineError> {
    load_profile(name.unwrap_or(&Options::default().profile))
}
