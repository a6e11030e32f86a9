//! Studies of a choice: how much it depends on the seed, and how large the budget should be.

use crate::assemble::inertia;
use crate::coverage::coverage;
use crate::group::Group;
use crate::matrix::{Matrix, distance};
use crate::space::ClusteringSpace;
use crate::strategy::choose;
use crate::{Embedding, SelectError, SelectOptions};
use recrash_model::profile::SystemProfile;
use recrash_model::record::RecordSet;
use recrash_model::selection::{BudgetRow, Stability};
use std::collections::{BTreeMap, BTreeSet};

/// Repeats the selection under `seeds` seeds, children of the options' own.
///
/// # Errors
/// As [`crate::select_with`], and where `seeds` is below 2.
pub fn stability(
    records: &RecordSet,
    profile: &SystemProfile,
    options: &SelectOptions,
    embedding: &Embedding,
    seeds: usize,
) -> Result<Stability, SelectError> {
    if seeds < 2 {
        return Err(SelectError::BadOption {
            option: "stability seeds",
            value: seeds.to_string(),
            allowed: "it takes at least 2 to compare",
        });
    }
    let space = ClusteringSpace::new(records, profile, options, embedding)?;
    let mut templates_covered = BTreeMap::new();
    let mut sums = [0.0; 4];
    let mut runs: Vec<(BTreeSet<usize>, Vec<usize>)> = Vec::with_capacity(seeds);
    for number in 0..seeds {
        let seed = options.seed.child(&format!("stability {number}"));
        let groups = choose(&space, &SelectOptions { seed, ..options.clone() });
        let coverage = coverage(profile, &space, &groups);
        *templates_covered.entry(coverage.templates_covered).or_insert(0) += 1;
        let measures =
            [coverage.radius, coverage.mean_distance, coverage.embedding_radius, coverage.embedding_mean_distance];
        sums.iter_mut().zip(measures).for_each(|(sum, measure)| *sum += measure);
        runs.push((groups.iter().map(Group::pick).collect(), labels(&groups, space.points.rows)));
    }
    let (mut common, mut agreement) = (0.0, 0.0);
    for (number, (picks, labels)) in runs.iter().enumerate() {
        for (other_picks, other_labels) in &runs[..number] {
            common += jaccard(picks, other_picks);
            agreement += adjusted_rand_index(labels, other_labels);
        }
    }
    let pairs = (seeds * (seeds - 1) / 2) as f64;
    let [mean_radius, mean_distance, mean_embedding_radius, mean_embedding_distance] =
        sums.map(|sum| sum / seeds as f64);
    Ok(Stability {
        seeds,
        templates_covered: templates_covered.into_iter().collect(),
        mean_radius,
        mean_distance,
        mean_embedding_radius,
        mean_embedding_distance,
        picks_in_common: common / pairs,
        cluster_agreement: agreement / pairs,
    })
}

/// One line per budget: what to look at in choosing one (elbow of the inertia, peak of the silhouette, coverage).
///
/// # Errors
/// As [`crate::select_with`].
pub fn budget_table(
    records: &RecordSet,
    profile: &SystemProfile,
    options: &SelectOptions,
    embedding: &Embedding,
    budgets: &[usize],
) -> Result<Vec<BudgetRow>, SelectError> {
    let mut table = Vec::with_capacity(budgets.len());
    for &budget in budgets {
        let options = SelectOptions { budget, ..options.clone() };
        let space = ClusteringSpace::new(records, profile, &options, embedding)?;
        let groups = choose(&space, &options);
        let coverage = coverage(profile, &space, &groups);
        table.push(BudgetRow {
            budget,
            inertia: inertia(&space, &groups),
            silhouette: silhouette(&space.points, &groups),
            templates_covered: coverage.templates_covered,
            radius: coverage.radius,
            mean_distance: coverage.mean_distance,
        });
    }
    Ok(table)
}

/// The budget at the elbow of the inertia: of the rows between the first and the last, the one farthest below the straight
/// line that joins these, with both axes scaled to `[0, 1]` (Satopaa et al. 2011). `None` where there is no row between
/// them, or none below the line.
pub fn elbow(table: &[BudgetRow]) -> Option<usize> {
    let (first, last) = (table.first()?, table.last()?);
    let width = last.budget.checked_sub(first.budget).filter(|&width| width > 0)? as f64;
    let fall = first.inertia - last.inertia;
    let below = |row: &BudgetRow| {
        let share = row.budget.saturating_sub(first.budget) as f64 / width;
        (first.inertia - row.inertia) / fall - share
    };
    let all = table.iter().map(|row| (row.budget, below(row)));
    let best = all.filter(|(_, below)| *below > 0.0).reduce(|best, row| if row.1 > best.1 { row } else { best });
    best.map(|(budget, _)| budget)
}

/// Group of each row.
fn labels(groups: &[Group], rows: usize) -> Vec<usize> {
    let mut labels = vec![0; rows];
    for (index, group) in groups.iter().enumerate() {
        group.members.iter().for_each(|&row| labels[row] = index);
    }
    labels
}

/// Mean of `(b - a) / max(a, b)` over the rows, where `a` is the mean distance to the others of the own group and `b`
/// the least mean distance to another group; 0 for a row alone in its group (Rousseeuw 1987).
fn silhouette(points: &Matrix, groups: &[Group]) -> Option<f64> {
    let rows = points.rows;
    if groups.len() < 2 || groups.len() >= rows {
        return None;
    }
    let mut sum = 0.0;
    for (own, group) in groups.iter().enumerate() {
        for &row in &group.members {
            let mean_distance = |other: usize| {
                let members = &groups[other].members;
                let total: f64 = members.iter().map(|&m| distance(points.row(row), points.row(m))).sum();
                total / if other == own { (members.len() - 1) as f64 } else { members.len() as f64 }
            };
            if group.members.len() > 1 {
                let a = mean_distance(own);
                let b = (0..groups.len()).filter(|&g| g != own).map(mean_distance).fold(f64::INFINITY, f64::min);
                let greater = a.max(b);
                sum += if greater > 0.0 { (b - a) / greater } else { 0.0 };
            }
        }
    }
    Some(sum / rows as f64)
}

/// Share of the union that both have.
fn jaccard(a: &BTreeSet<usize>, b: &BTreeSet<usize>) -> f64 {
    let union = a.union(b).count();
    if union == 0 { 1.0 } else { a.intersection(b).count() as f64 / union as f64 }
}

/// Agreement of two groupings of the same things, corrected for chance (Hubert and Arabie 1985).
fn adjusted_rand_index(a: &[usize], b: &[usize]) -> f64 {
    let mut cells: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    let mut of_a: BTreeMap<usize, f64> = BTreeMap::new();
    let mut of_b: BTreeMap<usize, f64> = BTreeMap::new();
    for (&x, &y) in a.iter().zip(b) {
        *cells.entry((x, y)).or_insert(0.0) += 1.0;
        *of_a.entry(x).or_insert(0.0) += 1.0;
        *of_b.entry(y).or_insert(0.0) += 1.0;
    }
    let pairs = |n: f64| n * (n - 1.0) / 2.0;
    let both: f64 = cells.values().map(|&n| pairs(n)).sum();
    let (in_a, in_b): (f64, f64) = (of_a.values().map(|&n| pairs(n)).sum(), of_b.values().map(|&n| pairs(n)).sum());
    let by_chance = in_a * in_b / pairs(a.len() as f64).max(1.0);
    let most = 0.5 * (in_a + in_b);
    // Both put everything together, or everything apart: the same grouping.
    if most == by_chance { 1.0 } else { (both - by_chance) / (most - by_chance) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::oracle;

    #[test]
    fn adjusted_rand_index_by_hand() {
        assert_eq!(adjusted_rand_index(&[0, 0, 1, 1], &[5, 5, 2, 2]), 1.0);
        // Pairs together: both 1; in a 2, in b 3; of 6. Chance 1, most 2.5: (1 - 1) / 1.5.
        assert_eq!(adjusted_rand_index(&[0, 0, 1, 1], &[0, 0, 0, 1]), 0.0);
        assert_eq!(adjusted_rand_index(&[0, 0, 0], &[1, 1, 1]), 1.0);
    }

    #[test]
    fn silhouette_and_rand_index_agree_with_scikit_learn() {
        let fixture = oracle("clusters.json");
        let points = fixture.matrix("points");
        let (a, b) = (fixture.whole_numbers("labels"), fixture.whole_numbers("other_labels"));
        let groups: Vec<Group> = (0..=a.iter().copied().max().unwrap())
            .map(|g| Group { members: (0..points.rows).filter(|&i| a[i] == g).collect() })
            .collect();
        assert!((silhouette(&points, &groups).unwrap() - fixture.number("silhouette")).abs() < 1e-12);
        assert!((adjusted_rand_index(&a, &b) - fixture.number("adjusted_rand_index")).abs() < 1e-12);
    }

    #[test]
    fn the_elbow_is_where_the_inertia_stops_falling() {
        let row = |budget, inertia| BudgetRow {
            budget,
            inertia,
            silhouette: None,
            templates_covered: 0,
            radius: 0.0,
            mean_distance: 0.0,
        };
        // Falls by 8 of 10 in the first fifth of the way: 0.8 - 0.2 below the line; later 0.9 - 0.6.
        assert_eq!(elbow(&[row(10, 10.0), row(20, 2.0), row(40, 1.0), row(60, 0.0)]), Some(20));
        assert_eq!(elbow(&[row(10, 10.0), row(20, 5.0), row(30, 0.0)]), None, "a straight line");
        assert_eq!(elbow(&[row(10, 1.0), row(20, 1.0), row(30, 1.0)]), None, "nothing falls");
        assert_eq!((elbow(&[row(10, 1.0)]), elbow(&[])), (None, None));
    }

    #[test]
    fn jaccard_by_hand() {
        assert_eq!(jaccard(&BTreeSet::from([1, 2, 3]), &BTreeSet::from([2, 3, 4])), 0.5);
    }
}
