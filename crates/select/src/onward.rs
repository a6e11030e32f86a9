//! Going on from an earlier choice: when records come in, the picks there are stay, and so does all that was made of them.

use crate::group::{Group, join_nearest};
use crate::space::ClusteringSpace;
use std::collections::{BTreeMap, BTreeSet};

/// An earlier choice with the records of today.
pub(crate) struct Onward {
    /// Its groups.
    pub groups: Vec<Group>,
    /// Templates that came in, and that no pick has.
    pub new_without_pick: usize,
}

/// The groups of an earlier choice with the records of today; `None` where none of its picks is there any more.
///
/// Records that came in become picks while there is room in the budget, the first of a template before others; the rest
/// join the nearest pick, behind who was there. A pick that is gone leaves room for another one, and its group is as if it had
/// come in. `earlier` holds positions in [`recrash_model::record::RecordSet::records`], the pick first.
pub(crate) fn go_on(space: &ClusteringSpace, earlier: &[Vec<usize>], budget: usize) -> Option<Onward> {
    let row_of: BTreeMap<usize, usize> = space.positions.iter().enumerate().map(|(row, &at)| (at, row)).collect();
    let rows = |positions: &Vec<usize>| -> Vec<usize> {
        positions.iter().filter_map(|position| row_of.get(position).copied()).collect()
    };
    let has_pick = |positions: &&Vec<usize>| positions.first().is_some_and(|pick| row_of.contains_key(pick));
    let mut groups: Vec<Group> =
        earlier.iter().filter(has_pick).map(|positions| Group { members: rows(positions) }).collect();
    if groups.is_empty() {
        return None;
    }
    let before: BTreeSet<usize> = earlier.iter().flat_map(rows).map(|row| space.template_of[row]).collect();
    let known: BTreeSet<usize> = groups.iter().flat_map(|group| group.members.iter().copied()).collect();
    let mut covered: BTreeSet<usize> = groups.iter().map(|group| space.template_of[group.pick()]).collect();
    let mut fresh: Vec<usize> = (0..space.points.rows).filter(|row| !known.contains(row)).collect();
    // Whoever brings a template that nobody has comes first.
    fresh.sort_by_key(|&row| (covered.contains(&space.template_of[row]), row));
    let room = budget.saturating_sub(groups.len()).min(fresh.len());
    for row in fresh.drain(..room) {
        covered.insert(space.template_of[row]);
        groups.push(Group { members: vec![row] });
    }
    let templates: BTreeSet<usize> = fresh.iter().map(|&row| space.template_of[row]).collect();
    let is_new = |template: &&usize| !covered.contains(*template) && !before.contains(*template);
    let new_without_pick = templates.iter().filter(is_new).count();
    join_nearest(space, &mut groups, &fresh);
    Some(Onward { groups, new_without_pick })
}
