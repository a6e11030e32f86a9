//! The strategies: from the clustering space to groups with a pick each.

use crate::SelectOptions;
use crate::greedy::{facility_location, k_center};
use crate::group::{Group, groups_by_kmeans, join_nearest};
use crate::matrix::squared_distance;
use crate::space::ClusteringSpace;
use crate::stratified::stratified;
use recrash_model::selection::Strategy;

/// Groups of all rows by the strategy asked for, at most `budget` of them, in no particular order.
pub(crate) fn choose(space: &ClusteringSpace, options: &SelectOptions) -> Vec<Group> {
    let mut groups = match options.strategy {
        Strategy::Stratified => stratified(space, options),
        Strategy::Kmeans => {
            let rows: Vec<usize> = (0..space.points.rows).collect();
            let seed = options.seed.child("kmeans");
            groups_by_kmeans(&space.points, &space.weights, &rows, options.budget, options.restarts, seed)
        }
        Strategy::KCenter => groups_around(space, k_center(&space.points, options.budget)),
        Strategy::FacilityLocation => {
            groups_around(space, facility_location(&space.points, &space.weights, options.budget))
        }
    };
    settle(space, &mut groups);
    groups
}

/// Makes the nearest member whose crash is told the pick of its group. A group without one takes, of the others' members with the
/// template of its pick, the nearest that is told and no pick; where there is none it keeps its pick.
fn settle(space: &ClusteringSpace, groups: &mut [Group]) {
    for group in groups.iter_mut() {
        if let Some(at) = group.members.iter().position(|&row| space.told[row]) {
            group.members[..=at].rotate_right(1);
        }
    }
    for taker in 0..groups.len() {
        let pick = groups[taker].pick();
        if space.told[pick] {
            continue;
        }
        let fits = |row: usize| space.told[row] && space.template_of[row] == space.template_of[pick];
        let spare = groups.iter().enumerate().flat_map(|(from, group)| {
            group
                .members
                .iter()
                .enumerate()
                .skip(1)
                .filter(|(_, row)| fits(**row))
                .map(move |(at, &row)| (from, at, row))
        });
        let to_pick = |row: usize| squared_distance(space.points.row(row), space.points.row(pick));
        let nearest = spare.reduce(|best, other| if to_pick(other.2) < to_pick(best.2) { other } else { best });
        if let Some((from, at, row)) = nearest {
            groups[from].members.remove(at);
            groups[taker].members.insert(0, row);
        }
    }
}

/// Each row joins the nearest of these picks, the first of equals.
fn groups_around(space: &ClusteringSpace, picks: Vec<usize>) -> Vec<Group> {
    let mut groups: Vec<Group> = picks.iter().map(|&pick| Group { members: vec![pick] }).collect();
    let others: Vec<usize> = (0..space.points.rows).filter(|row| !picks.contains(row)).collect();
    join_nearest(space, &mut groups, &others);
    groups
}
