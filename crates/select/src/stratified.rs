//! The default strategy: every observed template first, then the frequent ones and the badly served ones in turn.

use crate::SelectOptions;
use crate::apportion::next_by_equal_proportions;
use crate::greedy::k_center;
use crate::group::{Group, groups_by_kmeans, join_nearest};
use crate::matrix::{Matrix, distance};
use crate::space::{ClusteringSpace, ObservedTemplate};
use std::collections::BTreeSet;

/// Groups of all rows. While the budget lasts:
///
/// 1. every observed template gets one pick, the heaviest first;
/// 2. of the picks left, the first, third and so on go where frequency puts them (equal proportions), the second, fourth
///    and so on to the template that holds the record farthest from its pick.
///
/// Inside a template the groups are those of k-means on the narratives. A template gets no more picks than it has
/// different narratives, and records whose crash is told, but one: another would be the same scenario again, or nobody's. Rows of templates without a pick join the nearest.
pub(crate) fn stratified(space: &ClusteringSpace, options: &SelectOptions) -> Vec<Group> {
    let mut strata: Vec<Stratum> = space.observed.iter().map(|template| Stratum::new(space, template)).collect();
    // Stable: equals stay in the order of tables.
    strata.sort_by(|a, b| b.template.weight.total_cmp(&a.template.weight));
    let weights: Vec<f64> = strata.iter().map(|stratum| stratum.template.weight).collect();
    let limits: Vec<usize> = strata.iter().map(Stratum::most_picks).collect();
    let few = options.budget.min(MOST_BY_KMEANS);
    for pick in 0..few {
        let picks: Vec<usize> = strata.iter().map(|stratum| stratum.groups.len()).collect();
        let by_distance = pick >= strata.len() && (pick - strata.len()) % 2 == 1;
        let worst_served = if by_distance { worst_served(&strata, &limits) } else { None };
        let Some(next) = worst_served.or_else(|| next_by_equal_proportions(&weights, &picks, &limits)) else { break };
        strata[next].split(picks[next] + 1, options);
    }
    spread_the_rest(&mut strata, &weights, &limits, options.budget - few);
    let mut without_pick = Vec::new();
    let mut groups = Vec::new();
    for stratum in strata {
        if stratum.groups.is_empty() {
            without_pick.extend_from_slice(&stratum.template.rows);
        }
        groups.extend(stratum.groups);
    }
    join_nearest(space, &mut groups, &without_pick);
    groups
}

/// Picks up to this many are placed one by one with k-means; each costs as much as all before it.
const MOST_BY_KMEANS: usize = 256;

/// Shares out the picks beyond those by frequency alone, and divides each template once, farthest point first
/// (gonzalez1985): with hundreds of picks of one template the centres of groups say little more than the records.
fn spread_the_rest(strata: &mut [Stratum], weights: &[f64], limits: &[usize], rest: usize) {
    if rest == 0 {
        return;
    }
    let mut picks: Vec<usize> = strata.iter().map(|stratum| stratum.groups.len()).collect();
    for _ in 0..rest {
        let Some(next) = next_by_equal_proportions(weights, &picks, limits) else { break };
        picks[next] += 1;
    }
    for (stratum, &k) in strata.iter_mut().zip(&picks).filter(|(stratum, k)| **k > stratum.groups.len()) {
        stratum.spread(k);
    }
}

/// The records of one template, and their groups so far.
struct Stratum<'s> {
    space: &'s ClusteringSpace,
    template: &'s ObservedTemplate,
    /// Narratives, one row per record.
    points: Matrix,
    groups: Vec<Group>,
    /// Distance of the worst-served record from its pick.
    radius: f64,
}

impl<'s> Stratum<'s> {
    fn new(space: &'s ClusteringSpace, template: &'s ObservedTemplate) -> Self {
        let points = space.narrative.select(&template.rows);
        Self { space, template, points, groups: Vec::new(), radius: f64::INFINITY }
    }

    /// Another pick would be the same scenario again, or nobody's crash.
    fn most_picks(&self) -> usize {
        let told = self.template.rows.iter().filter(|&&row| self.space.told[row]).count();
        self.points.distinct_rows().min(told.max(1))
    }

    /// Divides the records into `k` groups around records that lie far from each other.
    fn spread(&mut self, k: usize) {
        let rows = &self.template.rows;
        let picks = k_center(&self.points, k);
        let mut groups: Vec<Group> = picks.iter().map(|&pick| Group { members: vec![rows[pick]] }).collect();
        let is_pick: BTreeSet<usize> = picks.iter().map(|&pick| rows[pick]).collect();
        let others: Vec<usize> = rows.iter().copied().filter(|row| !is_pick.contains(row)).collect();
        join_nearest(self.space, &mut groups, &others);
        self.groups = groups;
    }

    /// Divides the records into `k` groups.
    fn split(&mut self, k: usize, options: &SelectOptions) {
        let rows = &self.template.rows;
        let weights: Vec<f64> = rows.iter().map(|&row| self.space.weights[row]).collect();
        let seed = options.seed.child(&self.template.template.slug());
        self.groups = groups_by_kmeans(&self.points, &weights, rows, k, options.restarts, seed);
        let narrative = &self.space.narrative;
        let radius_of = |group: &Group| {
            let to_pick = |&row: &usize| distance(narrative.row(row), narrative.row(group.pick()));
            group.members.iter().map(to_pick).fold(0.0, f64::max)
        };
        self.radius = self.groups.iter().map(radius_of).fold(0.0, f64::max);
    }
}

/// The template below its limit that holds the record farthest from its pick, the first of equals.
fn worst_served(strata: &[Stratum], limits: &[usize]) -> Option<usize> {
    let mut worst: Option<usize> = None;
    for (index, stratum) in strata.iter().enumerate().filter(|(index, s)| s.groups.len() < limits[*index]) {
        if worst.is_none_or(|worst| stratum.radius > strata[worst].radius) {
            worst = Some(index);
        }
    }
    worst
}
