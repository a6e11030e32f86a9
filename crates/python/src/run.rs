//! Judged runs.

use crate::errors::{input, of_library, to_python};
use crate::table::Table;
use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use recrash_model::rollout::STEP_S;
use recrash_model::run::JudgedRun;
use recrash_pipeline::{Column, parse_scenario};
use recrash_roads::{Scenario, write_draft};
use std::sync::Arc;

/// Numbers of a state, in the order of `Run.states`.
pub const STATE: [&str; 7] = ["x", "y", "heading", "vx", "vy", "steer", "throttle"];

/// What one ego did in one scenario, and what that says. It never changes.
#[pyclass(frozen, module = "recrash")]
pub struct Run {
    run: Arc<JudgedRun>,
    scenario: Option<Arc<Scenario>>,
}

#[pymethods]
impl Run {
    /// Names the run by its content.
    #[getter]
    fn id(&self) -> &str {
        &self.run.id
    }

    /// Name of the scenario.
    #[getter]
    fn scenario_id(&self) -> &str {
        &self.run.scenario_id
    }

    /// Name of the ego.
    #[getter]
    fn ego(&self) -> &str {
        &self.run.ego
    }

    /// Simulator and its version.
    #[getter]
    fn simulator(&self) -> &str {
        &self.run.simulator
    }

    /// FNV-1a over the bits of every state: two runs of one hash drove the same.
    #[getter]
    fn state_hash(&self) -> &str {
        &self.run.state_hash
    }

    /// How it ended: `arrived`, `contact`, `timeout`, `stuck`, `off_road` or `diverged`.
    #[getter]
    fn termination<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.rollout.termination.kind)
    }

    /// How long it lasted. [s]
    #[getter]
    fn duration_s(&self) -> f64 {
        self.run.rollout.termination.time_s
    }

    /// Whether the ego failed, by the profile's criteria; `None` where nobody was under test, as the ego was parked.
    #[getter]
    fn failed(&self) -> Option<bool> {
        (!self.run.parked).then(|| self.run.failed())
    }

    /// Whether it came into the situation of its record: as near as the recorded driver's crash asks; `None` where no recorded
    /// driver crashes, and of episodes of `recrash.gym`. A run that did not, and did not fail, says nothing of the ego.
    #[getter]
    fn met(&self) -> Option<bool> {
        self.run.situation_met()
    }

    /// What led to the failure, such as `braked_late`; `None` where it did not fail.
    #[getter]
    fn cause<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.cause)
    }

    /// Failures first, then odd behaviour: dicts with `kind`, `time_s`, `value`, `threshold` and `sentence`.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.findings)
    }

    /// Kinds of findings, each once, failures first: the words of `findings`, such as `near_miss`.
    #[getter]
    fn finding_kinds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.finding_kinds())
    }

    /// Change of the ego's velocity in its first contact with a road user, or else with an obstacle; `None` without one. [m/s]
    #[getter]
    fn delta_v_mps(&self) -> Option<f64> {
        self.run.severity.as_ref().map(|severity| severity.first.delta_v_mps)
    }

    /// Everything that was measured.
    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.metrics)
    }

    /// How bad the ego's first contact with a road user is, or else with an obstacle (`obstacle`); `None` without one.
    #[getter]
    fn severity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.severity)
    }

    /// Least gap between the ego's box and a partner's; `None` without one. [m]
    #[getter]
    fn min_gap_m(&self) -> Option<f64> {
        self.run.min_gap_m()
    }

    /// Road users: dicts with `id`, `role`, `kind`, `length_m`, `width_m`; the ego first.
    #[getter]
    fn actors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let described: Vec<_> = self.run.rollout.actors.iter().map(|track| {
            serde_json::json!({
                "id": track.id, "role": track.role, "kind": track.kind, "length_m": track.length_m, "width_m": track.width_m,
                "appears_s": track.appears_s, "gone_s": track.gone_s, "part_of": track.part_of,
            })
        }).collect();
        to_python(py, &described)
    }

    /// What happened: contacts and departures, in order of time.
    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.run.rollout.events)
    }

    /// Times of the states, shape (steps,). [s]
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let times = (0..self.run.rollout.steps()).map(|step| step as f64 * STEP_S);
        PyArray1::from_iter(py, times)
    }

    /// States of everybody, shape (steps, actors, 7): x, y [m], heading [rad], vx, vy [m/s], steer, throttle [-1 to 1].
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let (actors, steps) = (&self.run.rollout.actors, self.run.rollout.steps());
        let all = (0..steps).flat_map(|step| {
            actors.iter().flat_map(move |track| {
                let state = &track.states[step];
                [state.x, state.y, state.heading, state.vx, state.vy, state.steer, state.throttle]
            })
        });
        PyArray1::from_iter(py, all).reshape([steps, actors.len(), STATE.len()])
    }

    /// Tracks as a table: a row for each actor and step at which it is in the world.
    #[getter]
    fn tracks(&self, py: Python<'_>) -> PyResult<Table> {
        let actors = &self.run.rollout.actors;
        let rows: Vec<_> = actors
            .iter()
            .flat_map(|track| {
                track
                    .states
                    .iter()
                    .enumerate()
                    .filter(|(step, _)| track.is_present(*step))
                    .map(move |(step, state)| (track, step, state))
            })
            .collect();
        let number = |of: &dyn Fn(&(_, usize, &recrash_model::rollout::ActorState)) -> f64| {
            Column::Number(
                rows.iter()
                    .map(|row: &(&recrash_model::rollout::ActorTrack, _, _)| Some(of(&(row.0, row.1, row.2))))
                    .collect(),
            )
        };
        let columns = vec![
            ("actor", Column::Text(rows.iter().map(|(track, _, _)| Some(track.id.clone())).collect())),
            ("step", Column::Whole(rows.iter().map(|(_, step, _)| i64::try_from(*step).ok()).collect())),
            ("time_s", number(&|(_, step, _)| *step as f64 * STEP_S)),
            ("x_m", number(&|(_, _, state)| state.x)),
            ("y_m", number(&|(_, _, state)| state.y)),
            ("heading_rad", number(&|(_, _, state)| state.heading)),
            ("vx_mps", number(&|(_, _, state)| state.vx)),
            ("vy_mps", number(&|(_, _, state)| state.vy)),
            ("steer", number(&|(_, _, state)| state.steer)),
            ("throttle", number(&|(_, _, state)| state.throttle)),
        ];
        Table::of_columns(py, columns)
    }

    /// Time series for plots: `time_s`, `ego_speed_mps`, `ego_acceleration_mps2`, and for each partner `id`, `speed_mps`,
    /// `acceleration_mps2`, `gap_m`, `centre_distance_m` and `ttc_s` (`None` where the two would never touch).
    #[getter]
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let series = py.detach(|| recrash_metrics::series(&self.run.rollout));
        to_python(py, &series)
    }

    /// A still picture (SVG): the roads, everybody's way, and where all are at the start and at the first contact or the end;
    /// `None` where the scenario is not known.
    fn picture(&self, py: Python<'_>) -> Option<String> {
        let scenario = self.scenario.as_ref()?;
        Some(py.detach(|| recrash_pipeline::picture(scenario, &self.run.rollout)))
    }

    /// Its picture for a notebook.
    fn _repr_svg_(&self, py: Python<'_>) -> Option<String> {
        self.picture(py)
    }

    /// Its replay for a notebook.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("recrash._show")?.call_method1("run_html", (slf,))
    }

    /// What is drawn of the road: areas and lines of points.
    #[getter]
    fn drawing<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.scenario.as_ref().map(|scenario| scenario.drawing()))
    }

    /// Everything, as the suite's files have it.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &*self.run)
    }

    /// A run never changes: a copy is itself.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// A run never changes: a copy is itself.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Pickled as its JSON.
    #[allow(clippy::type_complexity, reason = "Python's protocol: a callable and its arguments")]
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String, Option<String>))> {
        let restore = py.get_type::<Self>().getattr("_restore")?;
        let run = serde_json::to_string(&*self.run).map_err(|error| input(py, error))?;
        Ok((restore, (run, self.scenario.as_ref().map(|scenario| write_draft(scenario.draft())))))
    }

    /// What `pickle` calls.
    #[staticmethod]
    fn _restore(py: Python<'_>, run: &str, scenario: Option<&str>) -> PyResult<Self> {
        let run = serde_json::from_str(run).map_err(|error| input(py, error))?;
        let parsed = scenario.map(parse_scenario).transpose().map_err(|failed| of_library(py, &failed))?;
        Ok(Self::of(run, parsed.map(|(scenario, _)| Arc::new(scenario))))
    }

    fn __repr__(&self) -> String {
        let (run, kinds) = (&self.run, self.run.finding_kinds());
        let found: Vec<&str> = kinds.iter().map(|kind| kind.label()).collect();
        let found = if found.is_empty() { "nothing found".to_owned() } else { found.join(", ") };
        format!("Run({:?}, ego={:?}, {:.1} s: {found})", run.scenario_id, run.ego, run.rollout.termination.time_s)
    }
}

impl Run {
    pub fn of(run: JudgedRun, scenario: Option<Arc<Scenario>>) -> Self {
        Self { run: Arc::new(run), scenario }
    }
}
