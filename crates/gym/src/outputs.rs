//! Where results go: the caller's memory, slot by slot.

use crate::reward::TERMS;
use crate::view::View;

/// Where results go, slot by slot.
#[derive(Debug)]
pub struct Outputs<'a> {
    /// Numbers of the view.
    pub numbers: &'a mut [f32],
    /// Bytes of the view's picture.
    pub bytes: &'a mut [u8],
    /// Numbers of the last observation of an episode that ended, where the same step begins another; else empty.
    pub final_numbers: &'a mut [f32],
    /// The same of its picture.
    pub final_bytes: &'a mut [u8],
    /// Weighted sum of the terms.
    pub rewards: &'a mut [f64],
    /// Terms of the reward, in the order of [`TERMS`].
    pub terms: &'a mut [f32],
    /// The episode has ended.
    pub terminated: &'a mut [bool],
    /// Its time was up.
    pub truncated: &'a mut [bool],
    /// How it ended: 0 not yet, else 1 and the kind's position in its list.
    pub endings: &'a mut [u8],
    /// Position of the scene of the step.
    pub scenes: &'a mut [i32],
    /// Steps of the episode that has ended.
    pub episode_steps: &'a mut [i32],
    /// Sum of its rewards.
    pub episode_returns: &'a mut [f64],
}

impl<'a> Outputs<'a> {
    pub(crate) fn split_at(self, slots: usize, view: &View) -> (Self, Self) {
        let finals = if self.final_numbers.is_empty() { 0 } else { slots };
        let (numbers, more_numbers) = self.numbers.split_at_mut(slots * view.numbers());
        let (bytes, more_bytes) = self.bytes.split_at_mut(slots * view.bytes());
        let (final_numbers, more_final_numbers) = self.final_numbers.split_at_mut(finals * view.numbers());
        let (final_bytes, more_final_bytes) = self.final_bytes.split_at_mut(finals * view.bytes());
        let (rewards, more_rewards) = self.rewards.split_at_mut(slots);
        let (terms, more_terms) = self.terms.split_at_mut(slots * TERMS.len());
        let (terminated, more_terminated) = self.terminated.split_at_mut(slots);
        let (truncated, more_truncated) = self.truncated.split_at_mut(slots);
        let (endings, more_endings) = self.endings.split_at_mut(slots);
        let (scenes, more_scenes) = self.scenes.split_at_mut(slots);
        let (episode_steps, more_episode_steps) = self.episode_steps.split_at_mut(slots);
        let (episode_returns, more_episode_returns) = self.episode_returns.split_at_mut(slots);
        (
            Outputs {
                numbers,
                bytes,
                final_numbers,
                final_bytes,
                rewards,
                terms,
                terminated,
                truncated,
                endings,
                scenes,
                episode_steps,
                episode_returns,
            },
            Outputs {
                numbers: more_numbers,
                bytes: more_bytes,
                final_numbers: more_final_numbers,
                final_bytes: more_final_bytes,
                rewards: more_rewards,
                terms: more_terms,
                terminated: more_terminated,
                truncated: more_truncated,
                endings: more_endings,
                scenes: more_scenes,
                episode_steps: more_episode_steps,
                episode_returns: more_episode_returns,
            },
        )
    }

    /// Of one slot.
    pub(crate) fn into_row(self) -> Row<'a> {
        Row {
            numbers: self.numbers,
            bytes: self.bytes,
            final_numbers: self.final_numbers,
            final_bytes: self.final_bytes,
            reward: &mut self.rewards[0],
            terms: self.terms,
            terminated: &mut self.terminated[0],
            truncated: &mut self.truncated[0],
            ending: &mut self.endings[0],
            scene: &mut self.scenes[0],
            episode_steps: &mut self.episode_steps[0],
            episode_return: &mut self.episode_returns[0],
        }
    }
}

/// Where the results of one slot go.
pub(crate) struct Row<'a> {
    pub(crate) numbers: &'a mut [f32],
    pub(crate) bytes: &'a mut [u8],
    pub(crate) final_numbers: &'a mut [f32],
    pub(crate) final_bytes: &'a mut [u8],
    pub(crate) reward: &'a mut f64,
    pub(crate) terms: &'a mut [f32],
    pub(crate) terminated: &'a mut bool,
    pub(crate) truncated: &'a mut bool,
    pub(crate) ending: &'a mut u8,
    pub(crate) scene: &'a mut i32,
    pub(crate) episode_steps: &'a mut i32,
    pub(crate) episode_return: &'a mut f64,
}

impl Row<'_> {
    /// Nothing has happened.
    pub(crate) fn clear(&mut self) {
        self.terms.fill(0.0);
        (*self.reward, *self.terminated, *self.truncated) = (0.0, false, false);
        (*self.ending, *self.episode_steps, *self.episode_return) = (0, 0, 0.0);
    }
}
