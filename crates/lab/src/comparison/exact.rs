//! Exact tests of counts: Fisher's for runs of one test, McNemar's for tests that changed.

use recrash_model::math;

/// Sums of logarithms: `ln(n!)` for every n up to `most`.
fn ln_factorials(most: usize) -> Vec<f64> {
    let mut all = Vec::with_capacity(most + 1);
    all.push(0.0);
    for n in 1..=most {
        all.push(all[n - 1] + math::ln(n as f64));
    }
    all
}

/// Fisher's exact test, two-sided (fisher1922): how probable it is that two series with one share of failures differ at least as
/// much as these. Failures and runs of both.
pub fn fisher([first, first_runs]: [usize; 2], [second, second_runs]: [usize; 2]) -> f64 {
    let (runs, failures) = (first_runs + second_runs, first + second);
    let ln = ln_factorials(runs);
    let choose = |n: usize, k: usize| ln[n] - ln[k] - ln[n - k];
    let least = failures.saturating_sub(second_runs);
    let weight = |k: usize| choose(first_runs, k) + choose(second_runs, failures - k) - choose(runs, failures);
    let seen = weight(first);
    // As improbable as what was seen, but for rounding.
    let tail = (least..=failures.min(first_runs)).map(weight).filter(|ln| *ln <= seen + 1e-9);
    tail.map(math::exp).sum::<f64>().min(1.0)
}

/// McNemar's test, exact and two-sided (mcnemar1947): how probable it is that as many or more of the changes go one way, where both
/// ways are as likely. Changes one way and the other.
pub fn mcnemar(one: usize, other: usize) -> f64 {
    let changes = one + other;
    let ln = ln_factorials(changes);
    let weight = |k: usize| ln[changes] - ln[k] - ln[changes - k] - changes as f64 * math::ln(2.0);
    let tail: f64 = (0..=one.min(other)).map(|k| math::exp(weight(k))).sum();
    (2.0 * tail).min(1.0)
}

/// The greatest p that counts, where at most a share `false_share` of what is found may be chance (benjamini1995): of m sorted
/// ones, the last p(k) that is no more than k/m of that share takes all before it along. `None` without any p.
pub fn benjamini_hochberg(mut all: Vec<f64>, false_share: f64) -> Option<f64> {
    all.sort_by(f64::total_cmp);
    let bound = |found: usize| found as f64 * false_share / all.len() as f64;
    let found = (1..=all.len()).rev().find(|&found| all[found - 1] <= bound(found));
    (!all.is_empty()).then(|| bound(found.unwrap_or(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(one: f64, other: f64) {
        assert!((one - other).abs() < 1e-9, "{one} is not {other}");
    }

    #[test]
    fn fishers_tea_is_as_he_reckoned_it() {
        // Three of four cups told right on both sides: 34/70 two-sided; all four: 2/70.
        near(fisher([3, 4], [1, 4]), 34.0 / 70.0);
        near(fisher([4, 4], [0, 4]), 2.0 / 70.0);
        near(fisher([2, 5], [2, 5]), 1.0);
        near(fisher([0, 1], [1, 1]), 1.0);
    }

    #[test]
    fn many_tests_ask_for_smaller_p() {
        // The fifteen of the paper's example: the first four count, by 4/15 of 0.05.
        let example = [
            0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262, 0.5719, 0.6528,
            0.7590, 1.0,
        ];
        near(benjamini_hochberg(example.to_vec(), 0.05).unwrap(), 4.0 / 15.0 * 0.05);
        near(benjamini_hochberg(vec![0.04], 0.05).unwrap(), 0.05);
        near(benjamini_hochberg(vec![0.04, 0.9], 0.05).unwrap(), 0.025);
        assert_eq!(benjamini_hochberg(Vec::new(), 0.05), None);
    }

    #[test]
    fn mcnemar_is_the_binomial_of_the_changes() {
        near(mcnemar(0, 5), 2.0 / 32.0);
        near(mcnemar(1, 4), 12.0 / 32.0);
        near(mcnemar(3, 3), 1.0);
        near(mcnemar(0, 0), 1.0);
    }
}
