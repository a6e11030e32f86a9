//! Rank correlation of a quantity with an outcome that has few levels.

use recrash_model::Seed;
use recrash_model::severity::Interval;

/// Resamples behind an interval.
const RESAMPLES: usize = 2000;
/// Share of the resamples outside of an interval, on each side.
const TAIL: f64 = 0.025;

/// A quantity and a level for each of many, as ranks.
pub struct Ranks {
    /// Place of each quantity among the distinct ones, and its level.
    pairs: Vec<(usize, usize)>,
    distinct: usize,
    levels: usize,
}

/// How many have each quantity, by level.
struct Table {
    levels: usize,
    counts: Vec<usize>,
    all: usize,
}

impl Ranks {
    /// Of quantities that are no NaN, and levels from 0.
    pub fn of(values: &[(f64, usize)]) -> Self {
        let mut distinct: Vec<f64> = values.iter().map(|(value, _)| *value).collect();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        let place = |value: f64| distinct.partition_point(|other| *other < value);
        Self {
            pairs: values.iter().map(|&(value, level)| (place(value), level)).collect(),
            distinct: distinct.len(),
            levels: values.iter().map(|(_, level)| level + 1).max().unwrap_or(1),
        }
    }

    /// Spearman's rho: Pearson's correlation of the ranks, ties at their mean rank. `None` where all are alike on one side.
    pub fn spearman(&self, seed: Seed) -> Option<Interval> {
        self.interval(seed, Table::spearman)
    }

    /// Kendall's tau-b. `None` where all are alike on one side.
    pub fn kendall(&self, seed: Seed) -> Option<Interval> {
        self.interval(seed, Table::kendall)
    }

    /// The estimate with its percentile bootstrap interval of 95 %. Resamples in which all are alike count as 0.
    fn interval(&self, seed: Seed, estimate: fn(&Table) -> Option<f64>) -> Option<Interval> {
        let value = estimate(&self.table(self.pairs.iter()))?;
        let mut rng = seed.rng();
        let mut resampled: Vec<f64> = (0..RESAMPLES)
            .map(|_| {
                let drawn = (0..self.pairs.len()).map(|_| &self.pairs[rng.below(self.pairs.len())]);
                estimate(&self.table(drawn)).unwrap_or(0.0)
            })
            .collect();
        resampled.sort_by(f64::total_cmp);
        let at = |share: f64| resampled[(share * (RESAMPLES - 1) as f64).round() as usize];
        Some(Interval { value, low: at(TAIL), high: at(1.0 - TAIL) })
    }

    fn table<'a>(&self, pairs: impl Iterator<Item = &'a (usize, usize)>) -> Table {
        let mut counts = vec![0; self.distinct * self.levels];
        let mut all = 0;
        for (place, level) in pairs {
            counts[place * self.levels + level] += 1;
            all += 1;
        }
        Table { levels: self.levels, counts, all }
    }
}

impl Table {
    fn rows(&self) -> impl Iterator<Item = &[usize]> {
        self.counts.chunks(self.levels)
    }

    fn of_levels(&self) -> Vec<usize> {
        (0..self.levels).map(|level| self.rows().map(|row| row[level]).sum()).collect()
    }

    fn spearman(&self) -> Option<f64> {
        let centre = (self.all as f64 + 1.0) / 2.0;
        let rows: Vec<usize> = self.rows().map(|row| row.iter().sum()).collect();
        let of_values = centred_ranks(&rows, centre);
        let of_levels = centred_ranks(&self.of_levels(), centre);
        let mut sums = [0.0; 3];
        for (row, value) in self.rows().zip(&of_values) {
            for (&count, level) in row.iter().zip(&of_levels) {
                let count = count as f64;
                for (sum, product) in sums.iter_mut().zip([value * level, value * value, level * level]) {
                    *sum += count * product;
                }
            }
        }
        ratio(sums[0], sums[1], sums[2])
    }

    fn kendall(&self) -> Option<f64> {
        let mut below = vec![0_usize; self.levels];
        let mut difference = 0.0;
        for row in self.rows() {
            for (level, &count) in row.iter().enumerate() {
                let concordant: usize = below[..level].iter().sum();
                let discordant: usize = below[level + 1..].iter().sum();
                difference += count as f64 * (concordant as f64 - discordant as f64);
            }
            for (sum, count) in below.iter_mut().zip(row) {
                *sum += count;
            }
        }
        let pairs = |count: usize| count as f64 * (count as f64 - 1.0) / 2.0;
        let tied = |counts: &mut dyn Iterator<Item = usize>| counts.map(pairs).sum::<f64>();
        let in_values = tied(&mut self.rows().map(|row| row.iter().sum()));
        let in_levels = tied(&mut self.of_levels().into_iter());
        ratio(difference, pairs(self.all) - in_values, pairs(self.all) - in_levels)
    }
}

/// The mean rank of each group of equals, less the mean of all ranks.
fn centred_ranks(groups: &[usize], centre: f64) -> Vec<f64> {
    let mut before = 0;
    let rank = |&count: &usize| {
        let rank = before as f64 + (count as f64 + 1.0) / 2.0;
        before += count;
        rank - centre
    };
    groups.iter().map(rank).collect()
}

/// `None` where one side does not vary.
fn ratio(together: f64, one: f64, other: f64) -> Option<f64> {
    (one > 0.0 && other > 0.0).then(|| together / (one * other).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn both(values: &[(f64, usize)]) -> [f64; 2] {
        let ranks = Ranks::of(values);
        [ranks.spearman(Seed(1)).unwrap().value, ranks.kendall(Seed(1)).unwrap().value]
    }

    #[test]
    fn order_that_agrees_is_one_and_order_that_disagrees_is_less_one() {
        assert_eq!(both(&[(1.0, 0), (2.0, 1), (5.0, 2)]), [1.0, 1.0]);
        assert_eq!(both(&[(9.0, 0), (2.0, 1), (1.0, 2)]), [-1.0, -1.0]);
    }

    #[test]
    fn ties_have_their_mean_rank() {
        // Ranks 1, 2.5, 2.5, 4 and 1.5, 1.5, 3.5, 3.5. Of six pairs three agree and none disagrees; one is tied in the
        // quantity, two in the level.
        let [rho, tau] = both(&[(1.0, 0), (2.0, 0), (2.0, 1), (3.0, 1)]);
        assert!((rho - 3.0 / (4.5_f64 * 4.0).sqrt()).abs() < 1e-12, "{rho}");
        assert!((tau - 3.0 / (5.0_f64 * 4.0).sqrt()).abs() < 1e-12, "{tau}");
    }

    #[test]
    fn nothing_is_said_where_all_are_alike() {
        assert_eq!(Ranks::of(&[(1.0, 0), (2.0, 0)]).spearman(Seed(1)), None);
        assert_eq!(Ranks::of(&[(1.0, 0), (1.0, 1)]).kendall(Seed(1)), None);
        assert_eq!(Ranks::of(&[]).spearman(Seed(1)), None);
    }

    #[test]
    fn the_interval_holds_the_estimate_and_narrows_with_more_pairs() {
        let noisy = |count: usize| {
            let mut rng = Seed(3).rng();
            let pairs: Vec<(f64, usize)> = (0..count)
                .map(|_| {
                    let value = rng.uniform();
                    (value, usize::from(value + rng.range(-0.5, 0.5) > 0.5))
                })
                .collect();
            Ranks::of(&pairs).spearman(Seed(1)).unwrap()
        };
        let [few, many] = [noisy(40), noisy(1000)];
        for interval in [few, many] {
            assert!(interval.low < interval.value && interval.value < interval.high, "{interval:?}");
        }
        assert!(many.high - many.low < 0.3 * (few.high - few.low), "{few:?} {many:?}");
        assert_eq!(noisy(40), few);
    }
}
