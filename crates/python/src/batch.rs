//! Many runs at once, in arrays of numpy's.

use crate::errors::{input, of_library};
use crate::run::{Run, STATE};
use crate::scenario::{Scenario, system_profile};
use numpy::{PyArray1, PyArray2, PyArray3, PyArray4, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use recrash_gym::{
    ACTS, Actions, Autoreset, BatchError, CHANNELS, FIELDS_ALWAYS, FIELDS_OF_OTHER, Handles, Outputs, Raster, Rays,
    Reward, Scene, Settings, TERMS, View,
};
use recrash_model::rollout::TerminationKind;
use std::sync::Arc;

/// Arrays that a batch writes into, made once.
struct Arrays {
    numbers: Py<PyArray2<f32>>,
    pictures: Py<PyArray4<u8>>,
    final_numbers: Py<PyArray2<f32>>,
    final_pictures: Py<PyArray4<u8>>,
    rewards: Py<PyArray1<f64>>,
    terms: Py<PyArray2<f32>>,
    terminated: Py<PyArray1<bool>>,
    truncated: Py<PyArray1<bool>>,
    endings: Py<PyArray1<u8>>,
    scenes: Py<PyArray1<i32>>,
    episode_steps: Py<PyArray1<i32>>,
    episode_returns: Py<PyArray1<f64>>,
}

impl Arrays {
    fn new(py: Python<'_>, batch: &recrash_gym::Batch) -> Self {
        let (slots, settings) = (batch.slots(), batch.settings());
        let finals = if settings.autoreset == Autoreset::SameStep { slots } else { 0 };
        let pixels = if let View::Raster(raster) = &settings.view { raster.pixels } else { 0 };
        let numbers = settings.view.numbers();
        let pictures = |slots| PyArray4::zeros(py, [slots, CHANNELS, pixels, pixels], false).unbind();
        Self {
            numbers: PyArray2::zeros(py, [slots, numbers], false).unbind(),
            pictures: pictures(slots),
            final_numbers: PyArray2::zeros(py, [finals, numbers], false).unbind(),
            final_pictures: pictures(finals),
            rewards: PyArray1::zeros(py, slots, false).unbind(),
            terms: PyArray2::zeros(py, [slots, TERMS.len()], false).unbind(),
            terminated: PyArray1::zeros(py, slots, false).unbind(),
            truncated: PyArray1::zeros(py, slots, false).unbind(),
            endings: PyArray1::zeros(py, slots, false).unbind(),
            scenes: PyArray1::zeros(py, slots, false).unbind(),
            episode_steps: PyArray1::zeros(py, slots, false).unbind(),
            episode_returns: PyArray1::zeros(py, slots, false).unbind(),
        }
    }

    /// Lends all of them to work that needs no Python.
    fn lend(
        &self,
        py: Python<'_>,
        work: impl FnOnce(Outputs<'_>) -> Result<(), BatchError> + Send,
    ) -> PyResult<Result<(), BatchError>> {
        let mut numbers = self.numbers.bind(py).try_readwrite()?;
        let mut pictures = self.pictures.bind(py).try_readwrite()?;
        let mut final_numbers = self.final_numbers.bind(py).try_readwrite()?;
        let mut final_pictures = self.final_pictures.bind(py).try_readwrite()?;
        let mut rewards = self.rewards.bind(py).try_readwrite()?;
        let mut terms = self.terms.bind(py).try_readwrite()?;
        let mut terminated = self.terminated.bind(py).try_readwrite()?;
        let mut truncated = self.truncated.bind(py).try_readwrite()?;
        let mut endings = self.endings.bind(py).try_readwrite()?;
        let mut scenes = self.scenes.bind(py).try_readwrite()?;
        let mut episode_steps = self.episode_steps.bind(py).try_readwrite()?;
        let mut episode_returns = self.episode_returns.bind(py).try_readwrite()?;
        let outputs = Outputs {
            numbers: numbers.as_slice_mut()?,
            bytes: pictures.as_slice_mut()?,
            final_numbers: final_numbers.as_slice_mut()?,
            final_bytes: final_pictures.as_slice_mut()?,
            rewards: rewards.as_slice_mut()?,
            terms: terms.as_slice_mut()?,
            terminated: terminated.as_slice_mut()?,
            truncated: truncated.as_slice_mut()?,
            endings: endings.as_slice_mut()?,
            scenes: scenes.as_slice_mut()?,
            episode_steps: episode_steps.as_slice_mut()?,
            episode_returns: episode_returns.as_slice_mut()?,
        };
        Ok(py.detach(|| work(outputs)))
    }
}

/// Many runs, stepped together.
#[pyclass(module = "recrash")]
pub struct Batch {
    batch: recrash_gym::Batch,
    arrays: Arrays,
}

#[pymethods]
impl Batch {
    /// `view` and `handles` are dicts and names as `recrash.gym` documents them; `profile` judges every episode, where `judges`.
    #[new]
    #[pyo3(signature = (scenarios, slots, view, handles, reward, autoreset, profile=None, judges=true, threads=1))]
    #[allow(clippy::too_many_arguments, reason = "one for each argument of the Python class")]
    fn new(
        py: Python<'_>,
        scenarios: Vec<Bound<'_, Scenario>>,
        slots: usize,
        view: &Bound<'_, PyDict>,
        handles: &str,
        reward: [f64; TERMS.len()],
        autoreset: &str,
        profile: Option<&str>,
        judges: bool,
        threads: usize,
    ) -> PyResult<Self> {
        let settings = Settings {
            view: view_of(view)?,
            handles: match handles {
                "pedals" => Handles::Pedals,
                "guided" => Handles::Guided,
                "acts" => Handles::Acts,
                other => {
                    let what = format!("there are no actions \"{other}\"; there are: pedals, guided, acts");
                    return Err(input(py, what));
                }
            },
            reward: Reward::of_weights(reward),
            autoreset: match autoreset {
                "next_step" => Autoreset::NextStep,
                "same_step" => Autoreset::SameStep,
                "disabled" => Autoreset::Disabled,
                other => {
                    let what = format!("there is no autoreset \"{other}\"; there are: next_step, same_step, disabled");
                    return Err(input(py, what));
                }
            },
            judged_by: judges.then(|| system_profile(profile)).transpose().map_err(|failed| of_library(py, &failed))?,
            threads,
        };
        let scenes: Result<Vec<Scene>, _> =
            scenarios.iter().map(|each| Scene::new((*each.get().scenario).clone())).collect();
        let scenes = scenes.map_err(|error| input(py, error))?;
        let batch = recrash_gym::Batch::new(scenes, slots, settings).map_err(|error| input(py, error))?;
        let arrays = Arrays::new(py, &batch);
        Ok(Self { batch, arrays })
    }

    /// Begins episodes in all slots or those of the mask, in the scenarios that are named or in drawn ones.
    #[pyo3(signature = (seed=None, mask=None, scenes=None))]
    fn reset(
        &mut self,
        py: Python<'_>,
        seed: Option<u64>,
        mask: Option<PyReadonlyArray1<'_, bool>>,
        scenes: Option<PyReadonlyArray1<'_, i64>>,
    ) -> PyResult<()> {
        let mask = mask.as_ref().map(|mask| mask.as_slice()).transpose()?;
        let scenes = scenes.as_ref().map(|scenes| scenes.as_slice()).transpose()?;
        let Self { batch, arrays } = self;
        arrays.lend(py, |outputs| batch.reset(seed, mask, scenes, outputs))?.map_err(|error| input(py, error))
    }

    /// Every slot goes on by 0.1 s. Actions: float32 of shape (slots, 2).
    fn step_numbers(&mut self, py: Python<'_>, actions: PyReadonlyArray2<'_, f32>) -> PyResult<()> {
        let actions = actions.as_slice()?;
        let Self { batch, arrays } = self;
        let done = arrays.lend(py, |outputs| batch.step(Actions::Numbers(actions), outputs))?;
        done.map_err(|error| input(py, error))
    }

    /// Every slot goes on by 0.1 s. Actions: int64 of shape (slots,).
    fn step_acts(&mut self, py: Python<'_>, actions: PyReadonlyArray1<'_, i64>) -> PyResult<()> {
        let actions = actions.as_slice()?;
        let Self { batch, arrays } = self;
        let done = arrays.lend(py, |outputs| batch.step(Actions::Acts(actions), outputs))?;
        done.map_err(|error| input(py, error))
    }

    /// A slot's picture from above as it is now, (channels, rows, columns).
    fn picture<'py>(
        &mut self,
        py: Python<'py>,
        slot: usize,
        pixels: usize,
        pixel_m: f64,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let picture = PyArray3::zeros(py, [CHANNELS, pixels, pixels], false);
        let painted = self.batch.picture(slot, Raster { pixels, pixel_m }, picture.try_readwrite()?.as_slice_mut()?);
        painted.map_err(|error| input(py, error))?;
        Ok(picture)
    }

    /// Draws scenarios by these weights from now on.
    fn set_weights(&mut self, py: Python<'_>, weights: Vec<f64>) -> PyResult<()> {
        self.batch.set_weights(&weights).map_err(|error| input(py, error))
    }

    /// The last episode of a slot that ended; `None` before one has, and where none is judged.
    fn judged(&self, slot: usize) -> Option<Run> {
        let (scene, run) = self.batch.judged(slot)?;
        Some(Run::of(run.clone(), Some(Arc::new(scene.scenario().clone()))))
    }

    /// Numbers of the observations, (slots, fields).
    #[getter]
    fn numbers(&self, py: Python<'_>) -> Py<PyArray2<f32>> {
        self.arrays.numbers.clone_ref(py)
    }

    /// Pictures of the observations, (slots, channels, rows, columns).
    #[getter]
    fn pictures(&self, py: Python<'_>) -> Py<PyArray4<u8>> {
        self.arrays.pictures.clone_ref(py)
    }

    /// Numbers of last observations, where the same step begins another episode.
    #[getter]
    fn final_numbers(&self, py: Python<'_>) -> Py<PyArray2<f32>> {
        self.arrays.final_numbers.clone_ref(py)
    }

    /// Pictures of last observations.
    #[getter]
    fn final_pictures(&self, py: Python<'_>) -> Py<PyArray4<u8>> {
        self.arrays.final_pictures.clone_ref(py)
    }

    /// Rewards, (slots,).
    #[getter]
    fn rewards(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.arrays.rewards.clone_ref(py)
    }

    /// Terms of the rewards, (slots, terms).
    #[getter]
    fn terms(&self, py: Python<'_>) -> Py<PyArray2<f32>> {
        self.arrays.terms.clone_ref(py)
    }

    /// Whose episode ended, (slots,).
    #[getter]
    fn terminated(&self, py: Python<'_>) -> Py<PyArray1<bool>> {
        self.arrays.terminated.clone_ref(py)
    }

    /// Whose time was up, (slots,).
    #[getter]
    fn truncated(&self, py: Python<'_>) -> Py<PyArray1<bool>> {
        self.arrays.truncated.clone_ref(py)
    }

    /// How episodes ended, (slots,): 0 not yet, else 1 and the position in `ENDINGS`.
    #[getter]
    fn endings(&self, py: Python<'_>) -> Py<PyArray1<u8>> {
        self.arrays.endings.clone_ref(py)
    }

    /// Positions of the scenarios of the last step, (slots,).
    #[getter]
    fn scenes(&self, py: Python<'_>) -> Py<PyArray1<i32>> {
        self.arrays.scenes.clone_ref(py)
    }

    /// Steps of episodes that ended, (slots,).
    #[getter]
    fn episode_steps(&self, py: Python<'_>) -> Py<PyArray1<i32>> {
        self.arrays.episode_steps.clone_ref(py)
    }

    /// Sums of rewards of episodes that ended, (slots,).
    #[getter]
    fn episode_returns(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.arrays.episode_returns.clone_ref(py)
    }
}

fn view_of(view: &Bound<'_, PyDict>) -> PyResult<View> {
    let py = view.py();
    let missing = |name: &str| input(py, format!("the observation has no \"{name}\""));
    let item = |name: &str| view.get_item(name)?.ok_or_else(|| missing(name));
    let kind: String = item("kind")?.extract()?;
    Ok(match kind.as_str() {
        "kinematic" => View::Kinematic { neighbours: item("neighbours")?.extract()? },
        "rays" => View::Rays(Rays::new(item("count")?.extract()?, item("range_m")?.extract()?)),
        "raster" => View::Raster(Raster { pixels: item("pixels")?.extract()?, pixel_m: item("pixel_m")?.extract()? }),
        other => {
            return Err(input(py, format!("there is no observation \"{other}\"; there are: kinematic, rays, raster")));
        }
    })
}

/// For each scenario whether it is held out: crash by crash, a share of them.
#[pyfunction]
pub fn held_out(py: Python<'_>, scenarios: Vec<Bound<'_, Scenario>>, share: f64) -> PyResult<Vec<bool>> {
    if !(0.0..=1.0).contains(&share) {
        return Err(input(py, format!("the share that is held out is {share}; it is 0 to 1")));
    }
    let all: Vec<&recrash_roads::Scenario> = scenarios.iter().map(|each| &*each.get().scenario).collect();
    Ok(recrash_gym::held_out(&all, share))
}

/// Names of what arrays hold.
pub fn add_constants(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let fields = |fields: &[recrash_gym::Field]| -> Vec<(&str, &str, f64)> {
        fields.iter().map(|field| (field.name, field.unit, field.scale)).collect()
    };
    const ENDINGS: [TerminationKind; 6] = [
        TerminationKind::Arrived,
        TerminationKind::Contact,
        TerminationKind::Timeout,
        TerminationKind::Stuck,
        TerminationKind::OffRoad,
        TerminationKind::Diverged,
    ];
    let mut names = vec![String::new(); ENDINGS.len()];
    for ending in ENDINGS {
        let name = serde_json::to_value(ending).ok().and_then(|value| value.as_str().map(str::to_owned));
        names[ending as usize] = name.unwrap_or_default();
    }
    module.add("ENDINGS", names)?;
    module.add("TERMS", TERMS)?;
    module.add("WEIGHTS", Reward::default().weights())?;
    module.add("STATE", STATE)?;
    module.add("FIELDS_ALWAYS", fields(&FIELDS_ALWAYS))?;
    module.add("FIELDS_OF_OTHER", fields(&FIELDS_OF_OTHER))?;
    let acts: Vec<(&str, f64, f64)> = ACTS.iter().map(|act| (act.name, act.acceleration_mps2, act.beside_m)).collect();
    module.add("ACTS", acts)
}
