//! Scenes of the gallery, and memory for results.

use recrash_gym::{Autoreset, Batch, Handles, Outputs, Reward, Scene, Settings, TERMS, View};
use recrash_roads::{Scenario, check, read_draft};
use std::path::Path;

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");

/// A case of the gallery.
pub fn scenario(name: &str) -> Scenario {
    let text = std::fs::read_to_string(Path::new(CASES).join(format!("{name}.json"))).unwrap();
    check(read_draft(&text).unwrap().value).unwrap().value
}

/// Every case of the gallery, in order.
pub fn gallery() -> Vec<Scenario> {
    let mut names: Vec<String> = Vec::new();
    for folder in ["acts", "control", "crashes", "kinds", "roads"] {
        for file in std::fs::read_dir(Path::new(CASES).join(folder)).unwrap() {
            let file = file.unwrap().file_name().into_string().unwrap();
            names.push(format!("{folder}/{}", file.trim_end_matches(".json")));
        }
    }
    names.sort();
    names.iter().map(|name| scenario(name)).collect()
}

pub fn settings(autoreset: Autoreset) -> Settings {
    Settings {
        view: View::Kinematic { neighbours: 4 },
        handles: Handles::Guided,
        reward: Reward::default(),
        autoreset,
        judged_by: None,
        threads: 1,
    }
}

pub fn batch(scenarios: &[Scenario], slots: usize, settings: Settings) -> Batch {
    let scenes = scenarios.iter().cloned().map(|scenario| Scene::new(scenario).unwrap()).collect();
    Batch::new(scenes, slots, settings).unwrap()
}

/// Memory for the results of a batch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Memory {
    pub numbers: Vec<f32>,
    pub bytes: Vec<u8>,
    pub final_numbers: Vec<f32>,
    pub final_bytes: Vec<u8>,
    pub rewards: Vec<f64>,
    pub terms: Vec<f32>,
    pub terminated: Vec<bool>,
    pub truncated: Vec<bool>,
    pub endings: Vec<u8>,
    pub scenes: Vec<i32>,
    pub episode_steps: Vec<i32>,
    pub episode_returns: Vec<f64>,
}

impl Memory {
    pub fn of(batch: &Batch) -> Self {
        let (slots, view) = (batch.slots(), &batch.settings().view);
        let finals = if batch.settings().autoreset == Autoreset::SameStep { slots } else { 0 };
        Self {
            numbers: vec![9.0; slots * view.numbers()],
            bytes: vec![9; slots * view.bytes()],
            final_numbers: vec![9.0; finals * view.numbers()],
            final_bytes: vec![9; finals * view.bytes()],
            rewards: vec![9.0; slots],
            terms: vec![9.0; slots * TERMS.len()],
            terminated: vec![false; slots],
            truncated: vec![false; slots],
            endings: vec![0; slots],
            scenes: vec![-1; slots],
            episode_steps: vec![0; slots],
            episode_returns: vec![0.0; slots],
        }
    }

    pub fn lend(&mut self) -> Outputs<'_> {
        Outputs {
            numbers: &mut self.numbers,
            bytes: &mut self.bytes,
            final_numbers: &mut self.final_numbers,
            final_bytes: &mut self.final_bytes,
            rewards: &mut self.rewards,
            terms: &mut self.terms,
            terminated: &mut self.terminated,
            truncated: &mut self.truncated,
            endings: &mut self.endings,
            scenes: &mut self.scenes,
            episode_steps: &mut self.episode_steps,
            episode_returns: &mut self.episode_returns,
        }
    }
}
