//! Many slots, stepped together.

use crate::handles::{ACTS, Handles};
use crate::outputs::Outputs;
use crate::raster::Raster;
use crate::reward::TERMS;
use crate::scene::Scene;
use crate::settings::{Autoreset, Settings};
use crate::slot::{Shared, Slot};
use crate::view::{View, ViewError};
use rayon::ThreadPool;
use recrash_model::run::JudgedRun;
use recrash_model::seed::Seed;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Fewer slots than this are not worth another thread.
const GRAIN: usize = 16;

/// A thread takes its share in about so many turns, so that none waits long for the last.
const TURNS: usize = 32;

/// So long threads stay awake for the next step: to be woken takes a tenth of a step of a thousand slots.
const AWAKE: Duration = Duration::from_micros(200);

/// What cannot be done.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BatchError {
    /// There is nothing to drive in.
    #[error("there is no scenario to drive in: a batch needs at least one")]
    NoScene,
    /// There is nobody to drive.
    #[error("a batch of 0 environments: it needs at least one")]
    NoSlot,
    /// The view is none.
    #[error(transparent)]
    View(#[from] ViewError),
    /// Something has another size.
    #[error("{what} has {got} entries, and {wanted} are wanted")]
    Size {
        /// What.
        what: &'static str,
        /// How many it should have.
        wanted: usize,
        /// How many it has.
        got: usize,
    },
    /// Weights of scenes that cannot be drawn by.
    #[error("the weight of scenario {scene} is {weight}: weights are 0 or more, and one of them is more")]
    Weight {
        /// Which scene.
        scene: usize,
        /// Its weight.
        weight: f64,
    },
    /// There is no such scene.
    #[error("environment {slot} is to drive in scenario {scene}, and there are {count}, counted from 0")]
    Scene {
        /// Which slot.
        slot: usize,
        /// The scene it names.
        scene: i64,
        /// How many there are.
        count: usize,
    },
    /// An action that is no number.
    #[error("the action of environment {slot} has {value} at position {position}: actions are numbers from -1 to 1")]
    NotFinite {
        /// Which slot.
        slot: usize,
        /// Which of its numbers.
        position: usize,
        /// The number.
        value: f32,
    },
    /// An act that there is not.
    #[error("the action of environment {slot} is {act}: actions are 0 to {}", ACTS.len() - 1)]
    NoSuchAct {
        /// Which slot.
        slot: usize,
        /// What it said.
        act: i64,
    },
    /// Actions of the other kind.
    #[error("these actions are of another kind than the environment's")]
    OtherKind,
    /// An episode is over.
    #[error("the episode of environment {slot} is over or was never begun; reset it first")]
    Ended {
        /// Which slot.
        slot: usize,
    },
    /// The threads could not be started.
    #[error("cannot start {0} threads; try with fewer")]
    Threads(usize),
}

/// What drivers answer, slot by slot.
#[derive(Debug, Clone, Copy)]
pub enum Actions<'a> {
    /// Two numbers each.
    Numbers(&'a [f32]),
    /// Positions in [`ACTS`].
    Acts(&'a [i64]),
}

/// Many runs.
#[derive(Debug)]
pub struct Batch {
    scenes: Vec<Scene>,
    sums: Vec<f64>,
    settings: Settings,
    slots: Vec<Slot>,
    /// Every slot can go on, whatever ends: it need not be looked for one that cannot.
    runs_on: bool,
    pool: Option<Pool>,
}

/// Threads beside the caller's.
#[derive(Debug)]
struct Pool {
    threads: ThreadPool,
    /// How many steps have begun.
    turns: Arc<AtomicUsize>,
}

impl Pool {
    /// Its threads wait a moment for the next step before they sleep.
    fn stay_awake(&self) {
        let (turns, now) = (Arc::clone(&self.turns), self.turns.load(Ordering::Acquire));
        self.threads.spawn_broadcast(move |_| {
            let begun = Instant::now();
            while turns.load(Ordering::Acquire) == now && begun.elapsed() < AWAKE {
                std::thread::yield_now();
            }
        });
    }
}

impl Batch {
    /// So many slots in these scenes.
    ///
    /// # Errors
    /// There are none, the view cannot be, or there are no threads.
    pub fn new(mut scenes: Vec<Scene>, slots: usize, settings: Settings) -> Result<Self, BatchError> {
        settings.view.check()?;
        let first = scenes.first().ok_or(BatchError::NoScene)?;
        if slots == 0 {
            return Err(BatchError::NoSlot);
        }
        let slots = (0..slots).map(|_| Slot::new(first)).collect();
        scenes.iter_mut().for_each(|scene| settings.view.prepare(scene));
        let pool = match settings.threads {
            0 | 1 => None,
            threads => {
                let built = rayon::ThreadPoolBuilder::new().num_threads(threads - 1).build();
                let threads = built.map_err(|_| BatchError::Threads(threads))?;
                Some(Pool { threads, turns: Arc::default() })
            }
        };
        let sums = (1..=scenes.len()).map(|number| number as f64).collect();
        Ok(Self { scenes, sums, settings, slots, runs_on: false, pool })
    }

    /// The scenes.
    pub fn scenes(&self) -> &[Scene] {
        &self.scenes
    }

    /// How it works.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// How many slots.
    pub fn slots(&self) -> usize {
        self.slots.len()
    }

    /// The last episode of a slot that ended, judged, and the scene that it was of; `None` before one has, and where none is
    /// judged.
    pub fn judged(&self, slot: usize) -> Option<(&Scene, &JudgedRun)> {
        let (scene, run) = self.slots.get(slot)?.judged.as_ref()?;
        Some((self.scenes.get(*scene)?, run))
    }

    /// A slot's picture from above as it is now, written row by row: see [`Raster`].
    ///
    /// # Errors
    /// The picture cannot be, there is no such slot, or the memory has another size.
    pub fn picture(&mut self, slot: usize, raster: Raster, bytes: &mut [u8]) -> Result<(), BatchError> {
        let view = View::Raster(raster);
        view.check()?;
        size("the memory for the picture", view.bytes(), bytes.len())?;
        let slots = self.slots.len();
        let slot = self.slots.get(slot).ok_or(BatchError::Size { what: "the batch", wanted: slot + 1, got: slots })?;
        view.prepare(&mut self.scenes[slot.scene]);
        slot.paint(&self.scenes[slot.scene], raster, bytes);
        Ok(())
    }

    /// Draws the scenes of later episodes by these weights, one for each.
    ///
    /// # Errors
    /// There are not as many as scenes, one is negative or no number, or all are 0.
    pub fn set_weights(&mut self, weights: &[f64]) -> Result<(), BatchError> {
        size("the list of weights", self.scenes.len(), weights.len())?;
        let mut sum = 0.0;
        let mut sums = Vec::with_capacity(weights.len());
        for (scene, &weight) in weights.iter().enumerate() {
            if !(0.0..=1e12).contains(&weight) {
                return Err(BatchError::Weight { scene, weight });
            }
            sum += weight;
            sums.push(sum);
        }
        if sum <= 0.0 {
            return Err(BatchError::Weight { scene: 0, weight: 0.0 });
        }
        self.sums = sums;
        Ok(())
    }

    /// Begins episodes: in every slot or those of the mask; in the scenes that are named for each slot, or in drawn ones.
    /// With a seed every slot's draws begin anew.
    ///
    /// # Errors
    /// Something has another size, or a scene is not there. Nothing has changed then.
    pub fn reset(
        &mut self,
        seed: Option<u64>,
        mask: Option<&[bool]>,
        scenes: Option<&[i64]>,
        mut outputs: Outputs<'_>,
    ) -> Result<(), BatchError> {
        self.check(&outputs)?;
        size("the mask", self.slots.len(), mask.map_or(self.slots.len(), <[bool]>::len))?;
        size("the list of scenarios", self.slots.len(), scenes.map_or(self.slots.len(), <[i64]>::len))?;
        let count = self.scenes.len();
        for (slot, &scene) in scenes.unwrap_or_default().iter().enumerate() {
            if !usize::try_from(scene).is_ok_and(|scene| scene < count) {
                return Err(BatchError::Scene { slot, scene, count });
            }
        }
        let shared = Shared { scenes: &self.scenes, sums: &self.sums, settings: &self.settings };
        for (number, slot) in self.slots.iter_mut().enumerate() {
            let (row, rest) = outputs.split_at(1, &shared.settings.view);
            outputs = rest;
            if let Some(seed) = seed {
                slot.seed(Seed(seed).child(&number.to_string()));
            }
            if mask.is_none_or(|mask| mask[number]) {
                let scene = scenes.and_then(|scenes| usize::try_from(scenes[number]).ok());
                slot.reset(&shared, scene, &mut row.into_row());
            }
        }
        Ok(())
    }

    /// Every slot goes on for a step.
    ///
    /// # Errors
    /// An action cannot be used, something has another size, or an episode is over and nobody has begun another. Nothing has
    /// changed then.
    pub fn step(&mut self, actions: Actions<'_>, outputs: Outputs<'_>) -> Result<(), BatchError> {
        self.check(&outputs)?;
        self.check_actions(actions)?;
        if !self.runs_on {
            let begins = self.settings.autoreset == Autoreset::NextStep;
            if let Some(slot) = self.slots.iter().position(|slot| slot.ended && !(begins && slot.is_begun())) {
                return Err(BatchError::Ended { slot });
            }
            self.runs_on = self.settings.autoreset != Autoreset::Disabled;
        }
        let shared = Shared { scenes: &self.scenes, sums: &self.sums, settings: &self.settings };
        let all = Part { slots: &mut self.slots, actions, outputs };
        match &self.pool {
            Some(pool) if all.slots.len() > GRAIN => {
                let threads = pool.threads.current_num_threads() + 1;
                let grain = (all.slots.len() / (TURNS * threads)).max(GRAIN);
                let rest = Mutex::new(Some(all));
                let busy = AtomicUsize::new(threads - 1);
                let work = |end| {
                    while let Some(part) = next(&rest, end, grain, &shared) {
                        part.step(&shared);
                    }
                };
                // The caller's thread does not wait until another is awake; and it begins at the other end, so that a slot
                // mostly stays with the thread that has its memory at hand.
                pool.turns.fetch_add(1, Ordering::Release);
                pool.threads.in_place_scope(|scope| {
                    (1..threads).for_each(|_| {
                        scope.spawn(|_| {
                            let _until_here = Busy(&busy);
                            work(End::Last);
                        });
                    });
                    work(End::First);
                    // The others are at their last few slots: to sleep and be woken takes longer than those.
                    while busy.load(Ordering::Acquire) > 0 {
                        std::thread::yield_now();
                    }
                });
                pool.stay_awake();
            }
            _ => all.step(&shared),
        }
        Ok(())
    }

    fn check_actions(&self, actions: Actions<'_>) -> Result<(), BatchError> {
        match actions {
            Actions::Numbers(numbers) if self.settings.handles.numbers() > 0 => {
                let each = self.settings.handles.numbers();
                size("the list of actions", each * self.slots.len(), numbers.len())?;
                match numbers.iter().position(|number| !number.is_finite()) {
                    None => Ok(()),
                    Some(at) => Err(BatchError::NotFinite { slot: at / each, position: at % each, value: numbers[at] }),
                }
            }
            Actions::Acts(acts) if self.settings.handles == Handles::Acts => {
                size("the list of actions", self.slots.len(), acts.len())?;
                match acts.iter().position(|act| !(0..ACTS.len() as i64).contains(act)) {
                    None => Ok(()),
                    Some(slot) => Err(BatchError::NoSuchAct { slot, act: acts[slot] }),
                }
            }
            _ => Err(BatchError::OtherKind),
        }
    }

    fn check(&self, outputs: &Outputs<'_>) -> Result<(), BatchError> {
        let (slots, view) = (self.slots.len(), &self.settings.view);
        let final_slots = if self.settings.autoreset == Autoreset::SameStep { slots } else { 0 };
        size("the memory for numbers", slots * view.numbers(), outputs.numbers.len())?;
        size("the memory for pictures", slots * view.bytes(), outputs.bytes.len())?;
        size("the memory for last numbers", final_slots * view.numbers(), outputs.final_numbers.len())?;
        size("the memory for last pictures", final_slots * view.bytes(), outputs.final_bytes.len())?;
        size("the memory for rewards", slots, outputs.rewards.len())?;
        size("the memory for terms", slots * TERMS.len(), outputs.terms.len())?;
        size("the memory for terminated", slots, outputs.terminated.len())?;
        size("the memory for truncated", slots, outputs.truncated.len())?;
        size("the memory for endings", slots, outputs.endings.len())?;
        size("the memory for scenes", slots, outputs.scenes.len())?;
        size("the memory for episode steps", slots, outputs.episode_steps.len())?;
        size("the memory for episode returns", slots, outputs.episode_returns.len())
    }
}

fn size(what: &'static str, wanted: usize, got: usize) -> Result<(), BatchError> {
    if wanted == got { Ok(()) } else { Err(BatchError::Size { what, wanted, got }) }
}

/// Some of the slots, with what belongs to them.
struct Part<'a> {
    slots: &'a mut [Slot],
    actions: Actions<'a>,
    outputs: Outputs<'a>,
}

/// A thread that counts as busy until this is dropped, by a panic too.
struct Busy<'a>(&'a AtomicUsize);

impl Drop for Busy<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Release);
    }
}

/// Where slots are taken from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    First,
    Last,
}

/// The next slots at this end that nobody has taken; `None` when all are.
fn next<'a>(rest: &Mutex<Option<Part<'a>>>, end: End, slots: usize, shared: &Shared<'_>) -> Option<Part<'a>> {
    let mut rest = rest.lock().unwrap_or_else(PoisonError::into_inner);
    let Part { slots: all, actions, outputs } = rest.take()?;
    if all.len() <= slots {
        return Some(Part { slots: all, actions, outputs });
    }
    let at = if end == End::First { slots } else { all.len() - slots };
    let (first, second) = all.split_at_mut(at);
    let (first_actions, second_actions) = actions.split_at(at, shared.settings.handles);
    let (first_out, second_out) = outputs.split_at(at, &shared.settings.view);
    let first = Part { slots: first, actions: first_actions, outputs: first_out };
    let second = Part { slots: second, actions: second_actions, outputs: second_out };
    let (taken, left) = if end == End::First { (first, second) } else { (second, first) };
    *rest = Some(left);
    Some(taken)
}

impl Part<'_> {
    /// Every slot of it goes on for a step.
    fn step(self, shared: &Shared<'_>) {
        let Self { slots, actions, mut outputs } = self;
        for (number, slot) in slots.iter_mut().enumerate() {
            let (row, rest) = outputs.split_at(1, &shared.settings.view);
            outputs = rest;
            let handles = shared.settings.handles;
            slot.step(
                shared,
                |scene, observation| match actions {
                    Actions::Numbers(numbers) => {
                        let pair = [f64::from(numbers[2 * number]), f64::from(numbers[2 * number + 1])];
                        handles.of_numbers(pair, scene, observation)
                    }
                    Actions::Acts(acts) => Handles::of_act(acts[number] as usize, scene, observation),
                },
                &mut row.into_row(),
            );
        }
    }
}

impl<'a> Actions<'a> {
    fn split_at(self, slots: usize, handles: Handles) -> (Self, Self) {
        match self {
            Self::Numbers(numbers) => {
                let (first, second) = numbers.split_at(slots * handles.numbers());
                (Self::Numbers(first), Self::Numbers(second))
            }
            Self::Acts(acts) => {
                let (first, second) = acts.split_at(slots);
                (Self::Acts(first), Self::Acts(second))
            }
        }
    }
}
