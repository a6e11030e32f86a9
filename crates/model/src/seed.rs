//! Seeds that make seeds: every random stream is named, so that order of use never matters.

use crate::hash::Fnv;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::{Deserialize, Serialize};

/// A seed. Children are made from names, never from the order of calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Seed(pub u64);

impl Seed {
    /// The seed of the part called `name`: FNV-1a over this seed and the name, then the SplitMix64 finaliser.
    #[must_use]
    pub fn child(self, name: &str) -> Self {
        let mut fnv = Fnv::default();
        fnv.write(&self.0.to_le_bytes());
        fnv.write(name.as_bytes());
        let mut hash = fnv.finish();
        hash = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        hash = (hash ^ (hash >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Self(hash ^ (hash >> 31))
    }

    /// A random number generator for this seed (ChaCha8: the same stream on every machine and in every version).
    pub fn rng(self) -> Rng {
        Rng(ChaCha8Rng::seed_from_u64(self.0))
    }
}

/// A random number generator with the few draws this project needs, each with a fixed definition.
#[derive(Debug, Clone)]
pub struct Rng(ChaCha8Rng);

impl Rng {
    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        use rand_chacha::rand_core::Rng as _;
        self.0.next_u64()
    }

    /// Uniform in [0, 1), with 53 bits.
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Uniform in [`low`, `high`).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Uniform in 0..`n`; 0 when `n` is 0. (Lemire's multiply-shift; the bias is below n / 2^64.)
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next_u64()) * n as u128) >> 64) as usize
    }

    /// Standard normal, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * crate::math::ln(1.0 - self.uniform())).sqrt();
        radius * crate::math::cos(crate::math::TAU * self.uniform())
    }

    /// Puts the items in random order (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_depend_on_name_and_parent_only() {
        assert_eq!(Seed(7).child("cp1"), Seed(7).child("cp1"));
        assert_ne!(Seed(7).child("cp1"), Seed(7).child("cp2"));
        assert_ne!(Seed(7).child("cp1"), Seed(8).child("cp1"));
    }

    #[test]
    fn uniform_has_the_mean_and_variance_of_a_uniform() {
        let mut rng = Seed(1).rng();
        let draws: Vec<f64> = (0..20_000).map(|_| rng.uniform()).collect();
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        let variance = draws.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / draws.len() as f64;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        assert!((variance - 1.0 / 12.0).abs() < 0.003, "{variance}");
    }

    #[test]
    fn below_reaches_every_value_and_no_other() {
        let mut rng = Seed(3).rng();
        let mut seen = [0; 5];
        (0..1000).for_each(|_| seen[rng.below(5)] += 1);
        assert!(seen.iter().all(|&n| n > 150), "{seen:?}");
    }
}
