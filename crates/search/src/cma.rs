//! (1+1)-CMA-ES with a Cholesky factor, after a first look around.
//!
//! Igel, Suttorp and Hansen, "A computational efficient covariance matrix update and a (1+1)-CMA for evolution
//! strategies", GECCO 2006, algorithm 2. One parent, one child; the step size follows the rate of success, and the
//! covariance learns from successful steps. A point outside the box is mirrored back in.

use crate::Optimiser;
use crate::halton::Halton;
use recrash_model::math::exp;
use recrash_model::seed::Rng;
use recrash_model::{Seed, math};

/// Share of the budget for the look around.
const EXPLORE_SHARE: f64 = 0.25;
/// First step size, as a share of the box.
const START_STEP: f64 = 0.15;
/// Below this step size the search has converged, and starts again from the next best start. [share of the box]
const LEAST_STEP: f64 = 1e-4;

/// Halton points first; then the strategy from the best of them, started again when it has converged.
#[derive(Clone)]
pub struct ExploreThenCma {
    halton: Halton,
    explore_left: usize,
    starts: Vec<(f64, Vec<f64>)>,
    strategy: Option<Strategy>,
    rng: Rng,
    dimensions: usize,
}

impl ExploreThenCma {
    /// Splits the budget.
    pub fn new(dimensions: usize, budget: usize, seed: Seed) -> Self {
        Self {
            halton: Halton::new(dimensions, seed),
            explore_left: (budget as f64 * EXPLORE_SHARE) as usize,
            starts: Vec::new(),
            strategy: None,
            rng: seed.child("cma").rng(),
            dimensions,
        }
    }

    fn next_start(&mut self) -> (f64, Vec<f64>) {
        // Best first; ties by order of arrival, since the sort is stable.
        self.starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        match self.starts.is_empty() {
            true => (f64::INFINITY, (0..self.dimensions).map(|_| self.rng.uniform()).collect()),
            false => self.starts.remove(0),
        }
    }
}

impl Optimiser for ExploreThenCma {
    fn ask(&mut self) -> (Vec<f64>, &'static str) {
        if self.explore_left > 0 {
            self.explore_left -= 1;
            return (self.halton.next_point(), "halton");
        }
        if self.strategy.as_ref().is_none_or(|s| s.step < LEAST_STEP) {
            let (objective, point) = self.next_start();
            self.strategy = Some(Strategy::new(point, objective));
        }
        let strategy = self.strategy.as_mut().expect("made above");
        (strategy.sample(&mut self.rng), "cma")
    }

    fn tell(&mut self, point: &[f64], objective: f64) {
        match self.strategy.as_mut() {
            Some(strategy) => strategy.learn(point, objective),
            None => self.starts.push((objective, point.to_vec())),
        }
    }

    fn copy(&self) -> Box<dyn Optimiser> {
        Box::new(self.clone())
    }
}

/// State of one (1+1)-CMA-ES. Names in comments are the paper's.
#[derive(Clone)]
struct Strategy {
    parent: Vec<f64>,
    objective: f64,
    /// sigma.
    step: f64,
    /// A: the lower triangular factor of the covariance.
    factor: Vec<Vec<f64>>,
    /// p_c.
    path: Vec<f64>,
    /// p_succ bar.
    success_rate: f64,
    /// A z of the last child, before the box.
    last: Vec<f64>,
}

impl Strategy {
    fn new(parent: Vec<f64>, objective: f64) -> Self {
        let n = parent.len();
        let factor = (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
        Self { parent, objective, step: START_STEP, factor, path: vec![0.0; n], success_rate: 2.0 / 11.0, last: vec![] }
    }

    fn sample(&mut self, rng: &mut Rng) -> Vec<f64> {
        let z: Vec<f64> = self.parent.iter().map(|_| rng.normal()).collect();
        self.last = self.factor.iter().map(|row| row.iter().zip(&z).map(|(a, z)| a * z).sum()).collect();
        self.parent.iter().zip(&self.last).map(|(x, d)| mirror(x + self.step * d)).collect()
    }

    fn learn(&mut self, child: &[f64], objective: f64) {
        let n = self.parent.len() as f64;
        // Constants of table 1 of the paper.
        let damping = 1.0 + n / 2.0;
        let target_rate = 2.0 / 11.0;
        let rate_weight = 1.0 / 12.0;
        let path_weight = 2.0 / (n + 2.0);
        let covariance_weight = 2.0 / (n * n + 6.0);
        let threshold = 0.44;

        let success = objective < self.objective || (self.objective.is_infinite() && objective.is_finite());
        self.success_rate = (1.0 - rate_weight) * self.success_rate + rate_weight * f64::from(success);
        self.step *= exp((self.success_rate - target_rate) / (damping * (1.0 - target_rate)));
        self.step = self.step.min(0.5);
        if !success {
            return;
        }
        self.parent = child.to_vec();
        self.objective = objective;
        if self.success_rate < threshold {
            let scale = (path_weight * (2.0 - path_weight)).sqrt();
            for (p, d) in self.path.iter_mut().zip(&self.last) {
                *p = (1.0 - path_weight) * *p + scale * d;
            }
            self.update_factor(1.0 - covariance_weight, covariance_weight);
        } else {
            self.path.iter_mut().for_each(|p| *p *= 1.0 - path_weight);
            let kept = 1.0 - covariance_weight + covariance_weight * path_weight * (2.0 - path_weight);
            self.update_factor(kept, covariance_weight);
        }
    }

    /// A A' becomes alpha A A' + beta p p' (rank-one update of a Cholesky factor).
    fn update_factor(&mut self, alpha: f64, beta: f64) {
        let n = self.path.len();
        let root = alpha.sqrt();
        self.factor.iter_mut().flatten().for_each(|a| *a *= root);
        let mut work: Vec<f64> = self.path.iter().map(|p| beta.sqrt() * p).collect();
        for k in 0..n {
            let diagonal = self.factor[k][k];
            let radius = (math::sq(diagonal) + math::sq(work[k])).sqrt();
            let (c, s) = (radius / diagonal, work[k] / diagonal);
            self.factor[k][k] = radius;
            for (row, rest) in self.factor.iter_mut().zip(&mut work).skip(k + 1) {
                row[k] = (row[k] + s * *rest) / c;
                *rest = c * *rest - s * row[k];
            }
        }
    }
}

/// Into [0, 1] by mirrors at both ends.
fn mirror(x: f64) -> f64 {
    let folded = x.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirrors_at_both_ends() {
        assert!((mirror(-0.25) - 0.25).abs() < 1e-15);
        assert!((mirror(1.25) - 0.75).abs() < 1e-15);
        assert_eq!(mirror(0.5), 0.5);
    }

    #[test]
    fn the_factor_update_is_the_factor_of_the_updated_matrix() {
        let mut strategy = Strategy::new(vec![0.5; 3], 1.0);
        strategy.factor = vec![vec![2.0, 0.0, 0.0], vec![0.5, 1.5, 0.0], vec![-0.3, 0.2, 1.0]];
        strategy.path = vec![0.7, -1.1, 0.4];
        let product = |a: &[Vec<f64>]| -> Vec<f64> {
            (0..9).map(|ij| (0..3).map(|k| a[ij / 3][k] * a[ij % 3][k]).sum()).collect()
        };
        let before = product(&strategy.factor);
        strategy.update_factor(0.8, 0.3);
        let after = product(&strategy.factor);
        for ij in 0..9 {
            let expected = 0.8 * before[ij] + 0.3 * strategy.path[ij / 3] * strategy.path[ij % 3];
            assert!((after[ij] - expected).abs() < 1e-12, "{ij}: {} {expected}", after[ij]);
        }
    }
}
