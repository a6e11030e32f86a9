//! Two greedy choices of picks with proven bounds: farthest point first, and facility location.

use crate::matrix::{Matrix, distance, squared_distance};

/// Picks of `k` points so that the worst-served point lies near to one (Gonzalez 1985): first the point nearest to the
/// mean, then each time the point farthest from all picks, the first of equals. The greatest distance of a point to its
/// nearest pick is at most twice the least possible. Stops early where every point equals a pick.
pub(crate) fn k_center(points: &Matrix, k: usize) -> Vec<usize> {
    let mean = points.mean();
    let Some(first) = (0..points.rows)
        .min_by(|&a, &b| squared_distance(points.row(a), &mean).total_cmp(&squared_distance(points.row(b), &mean)))
    else {
        return Vec::new();
    };
    let mut picks = vec![first];
    let mut nearest: Vec<f64> = (0..points.rows).map(|i| squared_distance(points.row(i), points.row(first))).collect();
    while picks.len() < k {
        let farthest =
            nearest.iter().enumerate().fold((0, 0.0), |best, (i, &d)| if d > best.1 { (i, d) } else { best });
        if farthest.1 == 0.0 {
            break;
        }
        picks.push(farthest.0);
        for (i, least) in nearest.iter_mut().enumerate() {
            *least = least.min(squared_distance(points.row(i), points.row(farthest.0)));
        }
    }
    picks
}

/// Picks of `k` points so that the weighted mean distance to the nearest pick is small: each time the point that lowers
/// it most, the first of equals.
///
/// This maximises `F(S) = sum_i w_i (D - min over j in S of d(i, j))` with `D` the greatest distance, a monotone
/// submodular function, so `F` is at least `1 - 1/e` of the best possible (Nemhauser, Wolsey and Fisher 1978). A point's
/// gain never grows, so only those that may still be the best are computed again (Minoux 1978); the result is the same.
pub(crate) fn facility_location(points: &Matrix, weights: &[f64], k: usize) -> Vec<usize> {
    let n = points.rows;
    let mut nearest: Vec<f64> = vec![f64::INFINITY; n];
    // Before the first pick all distances count, so the first is the point with the least weighted sum of distances.
    let sum_of_distances =
        |j: usize| -> f64 { (0..n).map(|i| weights[i] * distance(points.row(i), points.row(j))).sum() };
    let sums: Vec<f64> = (0..n).map(sum_of_distances).collect();
    let Some(first) = (0..n).min_by(|&a, &b| sums[a].total_cmp(&sums[b])) else { return Vec::new() };
    let mut picks = Vec::new();
    let mut next = Some(first);
    let mut gains: Vec<(f64, usize)> = vec![(f64::INFINITY, 0); n];
    while let Some(pick) = next.filter(|_| picks.len() < k) {
        picks.push(pick);
        for (i, least) in nearest.iter_mut().enumerate() {
            *least = least.min(distance(points.row(i), points.row(pick)));
        }
        next = best_gain(points, weights, &nearest, &mut gains, picks.len());
    }
    picks
}

/// The point of greatest positive gain. `gains` holds each point's last known gain and how many picks there were then.
fn best_gain(
    points: &Matrix,
    weights: &[f64],
    nearest: &[f64],
    gains: &mut [(f64, usize)],
    picks: usize,
) -> Option<usize> {
    loop {
        let best = (0..points.rows).reduce(|best, j| if gains[j].0 > gains[best].0 { j } else { best })?;
        if gains[best].1 == picks {
            // Gains of this size are rounding errors of distances that are zero.
            return (gains[best].0 > 1e-12).then_some(best);
        }
        let saved = |i: usize| weights[i] * (nearest[i] - distance(points.row(i), points.row(best))).max(0.0);
        gains[best] = ((0..points.rows).map(saved).sum(), picks);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::Seed;

    fn cloud(n: usize, seed: u64) -> Matrix {
        let mut rng = Seed(seed).rng();
        let rows: Vec<[f64; 2]> = (0..n).map(|_| [rng.normal(), rng.normal()]).collect();
        Matrix::from_rows(2, &rows)
    }

    fn worst(points: &Matrix, picks: &[usize]) -> f64 {
        let served =
            |i: usize| picks.iter().map(|&j| distance(points.row(i), points.row(j))).fold(f64::INFINITY, f64::min);
        (0..points.rows).map(served).fold(0.0, f64::max)
    }

    fn total(points: &Matrix, picks: &[usize]) -> f64 {
        let served =
            |i: usize| picks.iter().map(|&j| distance(points.row(i), points.row(j))).fold(f64::INFINITY, f64::min);
        (0..points.rows).map(served).sum()
    }

    fn every_three(n: usize) -> impl Iterator<Item = [usize; 3]> {
        (0..n).flat_map(move |a| (a + 1..n).flat_map(move |b| (b + 1..n).map(move |c| [a, b, c])))
    }

    #[test]
    fn k_center_is_at_most_twice_the_best() {
        for seed in 0..10 {
            let points = cloud(14, seed);
            let best = every_three(14).map(|picks| worst(&points, &picks)).fold(f64::INFINITY, f64::min);
            assert!(worst(&points, &k_center(&points, 3)) <= 2.0 * best);
        }
    }

    #[test]
    fn facility_location_keeps_its_bound() {
        for seed in 0..10 {
            let points = cloud(14, seed);
            let diameter = (0..14).map(|i| worst(&points, &[i])).fold(0.0, f64::max);
            let value = |picks: &[usize]| 14.0 * diameter - total(&points, picks);
            let best = every_three(14).map(|picks| value(&picks)).fold(0.0, f64::max);
            assert!(value(&facility_location(&points, &[1.0; 14], 3)) >= (1.0 - 1.0 / std::f64::consts::E) * best);
        }
    }

    #[test]
    fn lazy_gains_give_the_plain_greedy_choice() {
        let points = cloud(40, 3);
        let mut plain: Vec<usize> = Vec::new();
        for _ in 0..6 {
            let with = |j: usize| total(&points, &[plain.as_slice(), &[j]].concat());
            let next = (0..40).filter(|j| !plain.contains(j)).min_by(|&a, &b| with(a).total_cmp(&with(b))).unwrap();
            plain.push(next);
        }
        assert_eq!(facility_location(&points, &[1.0; 40], 6), plain);
    }

    #[test]
    fn by_hand_on_a_line() {
        let points = Matrix::from_rows(1, &[[0.0], [1.0], [2.0], [9.0]]);
        // Mean 3: nearest is 2; farthest from it 9; then 0.
        assert_eq!(k_center(&points, 3), [2, 3, 0]);
        assert_eq!(facility_location(&points, &[1.0; 4], 2), [1, 3]);
    }

    #[test]
    fn equal_points_are_picked_once() {
        let points = Matrix::from_rows(1, &[[1.0], [1.0], [4.0]]);
        assert_eq!(k_center(&points, 3).len(), 2);
        assert_eq!(facility_location(&points, &[1.0; 3], 3).len(), 2);
        assert!(k_center(&Matrix::zeros(0, 1), 3).is_empty());
    }
}
