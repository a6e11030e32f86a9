//! Weighted k-means: k-means++ starts, Lloyd's iterations, then Hartigan's single moves, best of several restarts.
//!
//! Equations and sources: `docs/models/selection.md`. Every sum runs from the first record to the last in double
//! precision, so the result is the same bits on every machine.

use crate::matrix::{Matrix, add_scaled, squared_distance};
use recrash_model::Seed;
use recrash_model::seed::Rng;

/// Points in groups around centres.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Clustering {
    /// Group of each point.
    pub groups: Vec<usize>,
    /// Weighted mean of each group, one row each. No group is empty.
    pub centres: Matrix,
    /// Weighted sum of squared distances of the points to their centres.
    pub inertia: f64,
}

/// Bounds the loops below; on real data both end after a few dozen rounds.
const MAX_ROUNDS: usize = 300;

/// Splits points into `k` groups, at most as many as there are different points.
///
/// `weights` are positive, one per point. Of `restarts` runs with seeds of their own the one with the least inertia
/// is kept, the first of equals.
pub(crate) fn kmeans(points: &Matrix, weights: &[f64], k: usize, restarts: usize, seed: Seed) -> Clustering {
    let k = k.min(points.distinct_rows());
    let run = |restart: usize| {
        let mut rng = seed.child(&format!("restart {restart}")).rng();
        let mut clustering = Clustering {
            groups: vec![0; points.rows],
            centres: spread_starts(points, weights, k, &mut rng),
            inertia: f64::INFINITY,
        };
        lloyd(points, weights, &mut clustering);
        hartigan(points, weights, &mut clustering);
        clustering.inertia = inertia(points, weights, &clustering);
        clustering
    };
    let mut best = run(0);
    for restart in 1..restarts {
        let other = run(restart);
        if other.inertia < best.inertia {
            best = other;
        }
    }
    best
}

/// Greedy k-means++ (Arthur and Vassilvitskii 2007, section 4; `2 + ln k` candidates each, as in scikit-learn).
fn spread_starts(points: &Matrix, weights: &[f64], k: usize, rng: &mut Rng) -> Matrix {
    let mut centres = Matrix::zeros(k, points.columns);
    if k == 0 {
        return centres;
    }
    let candidates = 2 + recrash_model::math::ln(k as f64) as usize;
    let first = draw(weights, rng);
    centres.row_mut(0).copy_from_slice(points.row(first));
    let mut nearest: Vec<f64> = (0..points.rows).map(|i| squared_distance(points.row(i), points.row(first))).collect();
    for centre in 1..k {
        let potential: Vec<f64> = nearest.iter().zip(weights).map(|(d, w)| d * w).collect();
        let mut best: Option<(f64, usize, Vec<f64>)> = None;
        for _ in 0..candidates {
            let candidate = draw(&potential, rng);
            let left: Vec<f64> = (0..points.rows)
                .map(|i| squared_distance(points.row(i), points.row(candidate)).min(nearest[i]))
                .collect();
            let total: f64 = left.iter().zip(weights).map(|(d, w)| d * w).sum();
            if best.as_ref().is_none_or(|(least, ..)| total < *least) {
                best = Some((total, candidate, left));
            }
        }
        if let Some((_, candidate, left)) = best {
            centres.row_mut(centre).copy_from_slice(points.row(candidate));
            nearest = left;
        }
    }
    centres
}

/// A position drawn with probability proportional to its share; never one whose share is zero, unless all are.
fn draw(shares: &[f64], rng: &mut Rng) -> usize {
    let total: f64 = shares.iter().sum();
    let target = rng.uniform() * total;
    let mut sum = 0.0;
    let mut chosen = 0;
    for (i, &share) in shares.iter().enumerate() {
        if share > 0.0 {
            chosen = i;
            sum += share;
            if sum > target {
                break;
            }
        }
    }
    chosen
}

/// Each point to its nearest centre, each centre to the mean of its points, until nothing changes (Lloyd 1982).
fn lloyd(points: &Matrix, weights: &[f64], clustering: &mut Clustering) {
    for round in 0..MAX_ROUNDS {
        let mut groups: Vec<usize> = (0..points.rows).map(|i| nearest(points.row(i), &clustering.centres)).collect();
        fill_empty_groups(points, weights, &clustering.centres, &mut groups);
        if round > 0 && groups == clustering.groups {
            break;
        }
        clustering.groups = groups;
        move_centres(points, weights, clustering);
    }
}

/// The nearest centre, the first of equals.
fn nearest(point: &[f64], centres: &Matrix) -> usize {
    let mut best = (f64::INFINITY, 0);
    for centre in 0..centres.rows {
        let distance = squared_distance(point, centres.row(centre));
        if distance < best.0 {
            best = (distance, centre);
        }
    }
    best.1
}

/// Gives each empty group the point that costs most where it is, taken from a group with others in it.
fn fill_empty_groups(points: &Matrix, weights: &[f64], centres: &Matrix, groups: &mut [usize]) {
    let mut sizes = vec![0_usize; centres.rows];
    groups.iter().for_each(|&group| sizes[group] += 1);
    for empty in 0..centres.rows {
        if sizes[empty] > 0 {
            continue;
        }
        let mut costliest: Option<(f64, usize)> = None;
        for (i, &group) in groups.iter().enumerate().filter(|&(_, &group)| sizes[group] > 1) {
            let cost = weights[i] * squared_distance(points.row(i), centres.row(group));
            if costliest.is_none_or(|(most, _)| cost > most) {
                costliest = Some((cost, i));
            }
        }
        if let Some((_, i)) = costliest {
            sizes[groups[i]] -= 1;
            sizes[empty] += 1;
            groups[i] = empty;
        }
    }
}

fn move_centres(points: &Matrix, weights: &[f64], clustering: &mut Clustering) {
    let k = clustering.centres.rows;
    let mut sums = Matrix::zeros(k, points.columns);
    let mut totals = vec![0.0; k];
    for (i, &group) in clustering.groups.iter().enumerate() {
        add_scaled(sums.row_mut(group), weights[i], points.row(i));
        totals[group] += weights[i];
    }
    for (group, &total) in totals.iter().enumerate().filter(|&(_, &total)| total > 0.0) {
        sums.row_mut(group).iter_mut().for_each(|x| *x /= total);
    }
    clustering.centres = sums;
}

/// Moves single points while that lowers the inertia, both means counted as moving with it (Hartigan 1975). What is
/// left is a stricter optimum than Lloyd's (Telgarsky and Vattani 2010).
fn hartigan(points: &Matrix, weights: &[f64], clustering: &mut Clustering) {
    let k = clustering.centres.rows;
    let mut totals = vec![0.0; k];
    let mut sizes = vec![0_usize; k];
    for (i, &group) in clustering.groups.iter().enumerate() {
        totals[group] += weights[i];
        sizes[group] += 1;
    }
    for _ in 0..MAX_ROUNDS {
        let mut moved = false;
        for (i, &weight) in weights.iter().enumerate() {
            let from = clustering.groups[i];
            if sizes[from] < 2 {
                continue;
            }
            let cost = |to: usize, factor: f64| factor * squared_distance(points.row(i), clustering.centres.row(to));
            let gain = cost(from, weight * totals[from] / (totals[from] - weight));
            let mut best = (f64::INFINITY, from);
            for to in (0..k).filter(|&to| to != from) {
                let loss = cost(to, weight * totals[to] / (totals[to] + weight));
                if loss < best.0 {
                    best = (loss, to);
                }
            }
            // The margin keeps rounding errors from moving a point to and fro.
            if best.0 < gain * (1.0 - 1e-9) {
                let to = best.1;
                shift_centre(clustering.centres.row_mut(from), points.row(i), -weight / (totals[from] - weight));
                shift_centre(clustering.centres.row_mut(to), points.row(i), weight / (totals[to] + weight));
                totals[from] -= weight;
                totals[to] += weight;
                sizes[from] -= 1;
                sizes[to] += 1;
                clustering.groups[i] = to;
                moved = true;
            }
        }
        // Fresh means, so that the errors of many small shifts do not add up.
        move_centres(points, weights, clustering);
        if !moved {
            break;
        }
    }
}

fn shift_centre(centre: &mut [f64], point: &[f64], factor: f64) {
    for (c, p) in centre.iter_mut().zip(point) {
        *c += factor * (p - *c);
    }
}

fn inertia(points: &Matrix, weights: &[f64], clustering: &Clustering) -> f64 {
    let of_point =
        |i: usize| weights[i] * squared_distance(points.row(i), clustering.centres.row(clustering.groups[i]));
    (0..points.rows).map(of_point).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::oracle;

    fn line(xs: &[f64]) -> Matrix {
        let rows: Vec<[f64; 1]> = xs.iter().map(|&x| [x]).collect();
        Matrix::from_rows(1, &rows)
    }

    #[test]
    fn two_heaps_on_a_line() {
        // Heaps {0, 1, 2} and {10, 12}: centres 1 and 11, inertia 1 + 0 + 1 + 1 + 1.
        let clustering = kmeans(&line(&[0.0, 10.0, 1.0, 12.0, 2.0]), &[1.0; 5], 2, 3, Seed(1));
        assert_eq!(clustering.inertia, 4.0);
        assert_eq!(clustering.groups[0], clustering.groups[4]);
        assert_ne!(clustering.groups[0], clustering.groups[1]);
    }

    #[test]
    fn a_weight_is_so_many_equal_points() {
        let weighted = kmeans(&line(&[0.0, 4.0]), &[3.0, 1.0], 1, 1, Seed(1));
        let repeated = kmeans(&line(&[0.0, 0.0, 0.0, 4.0]), &[1.0; 4], 1, 1, Seed(1));
        assert_eq!(weighted.centres.row(0), [1.0]);
        assert_eq!(weighted.centres, repeated.centres);
        assert_eq!(weighted.inertia, 12.0);
    }

    #[test]
    fn no_more_groups_than_different_points_and_none_empty() {
        let clustering = kmeans(&line(&[1.0, 1.0, 1.0, 5.0]), &[1.0; 4], 3, 2, Seed(9));
        assert_eq!(clustering.centres.rows, 2);
        assert_eq!(clustering.inertia, 0.0);
        assert_eq!(kmeans(&Matrix::zeros(0, 2), &[], 3, 1, Seed(0)).centres.rows, 0);
    }

    #[test]
    fn an_empty_group_takes_the_costliest_point() {
        let centres = Matrix::from_rows(1, &[[0.0], [100.0]]);
        let mut groups = vec![0, 0, 0];
        fill_empty_groups(&line(&[0.0, 7.0, 3.0]), &[1.0; 3], &centres, &mut groups);
        assert_eq!(groups, [0, 1, 0]);
    }

    #[test]
    fn hartigan_goes_on_where_lloyd_stops() {
        // Lloyd keeps {0, x} and {3.9} for x = 1.9 and for 2.1, whose own centre is the nearer one. Moving x = 1.9 would
        // gain (2/1) 0.95^2 = 1.805 and cost (1/2) 2^2 = 2: it stays. For 2.1 it is 2.205 against 1.62: it goes.
        let mut stays =
            Clustering { groups: vec![0, 0, 1], centres: Matrix::from_rows(1, &[[0.95], [3.9]]), inertia: 0.0 };
        hartigan(&line(&[0.0, 1.9, 3.9]), &[1.0; 3], &mut stays);
        assert_eq!(stays.groups, [0, 0, 1]);
        let mut goes =
            Clustering { groups: vec![0, 0, 1], centres: Matrix::from_rows(1, &[[1.05], [3.9]]), inertia: 0.0 };
        hartigan(&line(&[0.0, 2.1, 3.9]), &[1.0; 3], &mut goes);
        assert_eq!(goes.groups, [0, 1, 1]);
    }

    #[test]
    fn inertia_is_no_worse_than_scikit_learns() {
        let fixture = oracle("clusters.json");
        let points = fixture.matrix("points");
        let theirs = fixture.numbers("kmeans_inertia");
        let (k, restarts) = (fixture.number("k") as usize, fixture.number("restarts") as usize);
        let inertia = |seed| kmeans(&points, &vec![1.0; points.rows], k, restarts, Seed(seed)).inertia;
        let ours: Vec<f64> = (0..theirs.len() as u64).map(inertia).collect();
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let least = |x: &[f64]| x.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(mean(&ours) <= mean(&theirs), "{} > {}", mean(&ours), mean(&theirs));
        assert!(least(&ours) <= least(&theirs) * (1.0 + 1e-12));
    }

    #[test]
    fn more_restarts_are_never_worse() {
        let mut rng = Seed(5).rng();
        let xs: Vec<f64> = (0..200).map(|_| rng.normal()).collect();
        let inertia = |restarts| kmeans(&line(&xs), &[1.0; 200], 12, restarts, Seed(2)).inertia;
        let results: Vec<f64> = (1..6).map(inertia).collect();
        assert!(results.is_sorted_by(|a, b| a >= b), "{results:?}");
    }
}
