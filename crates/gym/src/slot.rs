//! One of many runs: an episode after the other.

use crate::kinematics::EgoFrame;
use crate::outputs::Row;
use crate::raster::Raster;
use crate::reward::{Memory, TERMS};
use crate::scene::Scene;
use crate::settings::{Autoreset, Settings};
use recrash_lab::judge;
use recrash_model::rollout::{Termination, TerminationKind};
use recrash_model::run::JudgedRun;
use recrash_model::seed::{Rng, Seed};
use recrash_sim::{Controls, Observation, Recorder, RolloutRecorder, Run, Seat};

/// What all slots share.
pub(crate) struct Shared<'a> {
    pub(crate) scenes: &'a [Scene],
    /// Sums of the scenes' weights.
    pub(crate) sums: &'a [f64],
    pub(crate) settings: &'a Settings,
}

/// A run, and the episode that it is.
#[derive(Debug)]
pub(crate) struct Slot {
    run: Run,
    rng: Rng,
    pub(crate) scene: usize,
    memory: Memory,
    recorder: Option<RolloutRecorder>,
    steps: u32,
    total: f64,
    begun: bool,
    pub(crate) ended: bool,
    /// The last episode that ended, where episodes are judged, and the scene that it was of.
    pub(crate) judged: Option<(usize, JudgedRun)>,
}

impl Slot {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            run: Run::new(&scene.scenario, Seat::Outside),
            rng: Seed(0).rng(),
            scene: 0,
            memory: Memory::default(),
            recorder: None,
            steps: 0,
            total: 0.0,
            begun: false,
            ended: true,
            judged: None,
        }
    }

    pub(crate) fn seed(&mut self, seed: Seed) {
        self.rng = seed.rng();
    }

    /// Whether it has ever begun an episode.
    pub(crate) fn is_begun(&self) -> bool {
        self.begun
    }

    /// Begins an episode: of this scene, or of one that is drawn.
    pub(crate) fn begin(&mut self, shared: &Shared<'_>, scene: Option<usize>) {
        self.scene = scene.unwrap_or_else(|| self.draw(shared.sums));
        let scene = &shared.scenes[self.scene];
        self.run.restore(&scene.start);
        self.memory = Memory::of(&self.run);
        self.recorder = shared.settings.judged_by.is_some().then(|| scene.before.clone());
        (self.steps, self.total, self.begun, self.ended) = (0, 0.0, true, false);
    }

    fn draw(&mut self, sums: &[f64]) -> usize {
        let at = self.rng.uniform() * sums.last().copied().unwrap_or(0.0);
        sums.partition_point(|&sum| sum <= at).min(sums.len().saturating_sub(1))
    }

    /// Begins an episode and shows it.
    pub(crate) fn reset(&mut self, shared: &Shared<'_>, scene: Option<usize>, row: &mut Row<'_>) {
        self.begin(shared, scene);
        row.clear();
        self.show(shared, row.numbers, row.bytes);
        *row.scene = self.scene as i32;
    }

    /// Goes on for a step by what `controls` answers to what there is.
    pub(crate) fn step(
        &mut self,
        shared: &Shared<'_>,
        controls: impl FnOnce(&Scene, &Observation<'_>) -> Controls,
        row: &mut Row<'_>,
    ) {
        if self.ended {
            return self.reset(shared, None, row);
        }
        let scene = &shared.scenes[self.scene];
        let controls = controls(scene, &self.run.observe());
        let ending = self.run.step(Some(controls));
        if let Some(recorder) = &mut self.recorder {
            recorder.step(self.run.decided());
            self.run.events().iter().for_each(|event| recorder.event(event));
        }
        let terms = self.memory.terms(scene, &self.run);
        let weights = shared.settings.reward.weights();
        let reward: f64 = terms.iter().zip(weights).map(|(term, weight)| term * weight).sum();
        self.steps += 1;
        self.total += reward;
        row.clear();
        for (slot, term) in row.terms.iter_mut().zip(terms) {
            *slot = term as f32;
        }
        debug_assert_eq!(row.terms.len(), TERMS.len());
        (*row.reward, *row.scene) = (reward, self.scene as i32);
        if let Some(termination) = ending {
            self.end(shared, termination, row);
        } else {
            self.show(shared, row.numbers, row.bytes);
        }
    }

    fn end(&mut self, shared: &Shared<'_>, termination: Termination, row: &mut Row<'_>) {
        let timeout = termination.kind == TerminationKind::Timeout;
        (*row.terminated, *row.truncated) = (!timeout, timeout);
        (*row.ending, *row.episode_steps, *row.episode_return) =
            (1 + termination.kind as u8, self.steps as i32, self.total);
        self.ended = true;
        if let (Some(mut recorder), Some(profile)) = (self.recorder.take(), &shared.settings.judged_by) {
            recorder.step(self.run.observe().states);
            recorder.end(termination);
            let scenario = &shared.scenes[self.scene].scenario;
            self.judged = recorder.finish().map(|rollout| (self.scene, judge(scenario, rollout, profile, None)));
        }
        if shared.settings.autoreset == Autoreset::SameStep {
            self.show(shared, row.final_numbers, row.final_bytes);
            self.begin(shared, None);
        }
        self.show(shared, row.numbers, row.bytes);
    }

    /// Its picture from above as it is now.
    pub(crate) fn paint(&self, scene: &Scene, raster: Raster, bytes: &mut [u8]) {
        let observation = self.run.observe();
        raster.write(scene, &observation, &EgoFrame::of(&observation), bytes);
    }

    fn show(&self, shared: &Shared<'_>, numbers: &mut [f32], bytes: &mut [u8]) {
        shared.settings.view.write(&shared.scenes[self.scene], &self.run.observe(), numbers, bytes);
    }
}
