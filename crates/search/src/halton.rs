//! The Halton sequence, shifted at random (Cranley and Patterson 1976): even coverage of a box for any number of points.

use crate::Optimiser;
use recrash_model::Seed;
use recrash_model::math::radical_inverse;

/// Bases: the first primes. More dimensions than bases use random numbers for the rest.
const BASES: [u32; 16] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53];

/// Points of the shifted sequence, one after the other.
#[derive(Clone)]
pub struct Halton {
    shift: Vec<f64>,
    next: u32,
    seed: Seed,
}

impl Halton {
    /// A sequence of its own for each seed.
    pub fn new(dimensions: usize, seed: Seed) -> Self {
        let mut rng = seed.child("halton").rng();
        Self { shift: (0..dimensions).map(|_| rng.uniform()).collect(), next: 1, seed }
    }

    /// The next point.
    pub fn next_point(&mut self) -> Vec<f64> {
        let number = self.next;
        self.next += 1;
        let mut extra = self.seed.child("halton-extra").child(&number.to_string()).rng();
        self.shift
            .iter()
            .enumerate()
            .map(|(axis, shift)| {
                let value = BASES.get(axis).map_or_else(|| extra.uniform(), |&base| radical_inverse(base, number));
                (value + shift).fract()
            })
            .collect()
    }
}

impl Optimiser for Halton {
    fn ask(&mut self) -> (Vec<f64>, &'static str) {
        (self.next_point(), "halton")
    }

    fn tell(&mut self, _point: &[f64], _objective: f64) {}

    fn copy(&self) -> Box<dyn Optimiser> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_eighth_of_an_axis_gets_its_share() {
        let mut sequence = Halton::new(3, Seed(5));
        let mut counts = [[0; 8]; 3];
        for _ in 0..800 {
            for (axis, value) in sequence.next_point().into_iter().enumerate() {
                counts[axis][(value * 8.0) as usize] += 1;
            }
        }
        assert!(counts.iter().flatten().all(|n| (90..=110).contains(n)), "{counts:?}");
    }
}
