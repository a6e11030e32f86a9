//! Groups of rows, each with a pick: made by k-means, or by the nearest pick.

use crate::kmeans::kmeans;
use crate::matrix::{Matrix, squared_distance};
use crate::space::ClusteringSpace;

/// A cluster: rows of the space, the pick first, then the nearest to the centre first. Never empty. The pick is the nearest whose
/// crash is told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Group {
    pub members: Vec<usize>,
}

impl Group {
    pub fn pick(&self) -> usize {
        self.members[0]
    }
}

/// k-means on `points`; point `i` is row `rows[i]` of the space. The pick is the point nearest to the centre, the first
/// of equals.
pub(crate) fn groups_by_kmeans(
    points: &Matrix,
    weights: &[f64],
    rows: &[usize],
    k: usize,
    restarts: usize,
    seed: recrash_model::Seed,
) -> Vec<Group> {
    let clustering = kmeans(points, weights, k, restarts, seed);
    let mut groups: Vec<Vec<(f64, usize)>> = vec![Vec::new(); clustering.centres.rows];
    for (i, &group) in clustering.groups.iter().enumerate() {
        let distance = squared_distance(points.row(i), clustering.centres.row(group));
        groups[group].push((distance, rows[i]));
    }
    groups.into_iter().filter(|group| !group.is_empty()).map(nearest_first).collect()
}

/// Appends rows to the groups of their nearest picks, the nearest row first.
pub(crate) fn join_nearest(space: &ClusteringSpace, groups: &mut [Group], rows: &[usize]) {
    let mut joining: Vec<Vec<(f64, usize)>> = vec![Vec::new(); groups.len()];
    for &row in rows {
        let to = |group: &Group| squared_distance(space.points.row(row), space.points.row(group.pick()));
        let nearest =
            groups.iter().map(to).enumerate().reduce(|best, other| if other.1 < best.1 { other } else { best });
        if let Some((group, distance)) = nearest {
            joining[group].push((distance, row));
        }
    }
    for (group, joining) in groups.iter_mut().zip(joining) {
        group.members.extend(nearest_first(joining).members);
    }
}

fn nearest_first(mut members: Vec<(f64, usize)>) -> Group {
    members.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    Group { members: members.into_iter().map(|(_, row)| row).collect() }
}
