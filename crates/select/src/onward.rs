//! Going on from an earlier choice: when records come in, the picks there are stay, and so does all that was made of them.

use crate::group::{Group, join_nearest};
use crate::space::ClusteringSpace;
use std::collections::{BTreeMap, BTreeSet};

/// The groups of an earlier choice with the records of today; `None` where it no longer holds and has to be made anew: a pick
/// is gone, or a template that nobody stands for has come in.
///
/// Records that came in become picks while there is room in the budget, the first of a template before others; the rest
/// join the nearest pick, behind who was there. `earlier` holds positions in [`recrash_model::record::RecordSet::records`],
/// the pick first.
pub(crate) fn go_on(space: &ClusteringSpace, earlier: &[Vec<usize>], budget: usize) -> Option<Vec<Group>> {
    if earlier.is_empty() {
        return None;
    }
    let row_of: BTreeMap<usize, usize> = space.positions.iter().enumerate().map(|(row, &at)| (at, row)).collect();
    let mut groups = Vec::new();
    let mut known = BTreeSet::new();
    for positions in earlier {
        row_of.get(positions.first()?)?;
        let members: Vec<usize> = positions.iter().filter_map(|at| row_of.get(at).copied()).collect();
        known.extend(members.iter().copied());
        groups.push(Group { members });
    }
    let mut covered: BTreeSet<usize> = groups.iter().map(|group| space.template_of[group.pick()]).collect();
    let before: BTreeSet<usize> = known.iter().map(|&row| space.template_of[row]).collect();
    let mut fresh: Vec<usize> = (0..space.points.rows).filter(|row| !known.contains(row)).collect();
    // Whoever brings a template that nobody has comes first.
    fresh.sort_by_key(|&row| (covered.contains(&space.template_of[row]), row));
    let room = budget.saturating_sub(groups.len()).min(fresh.len());
    for row in fresh.drain(..room) {
        covered.insert(space.template_of[row]);
        groups.push(Group { members: vec![row] });
    }
    if fresh.iter().any(|&row| !covered.contains(&space.template_of[row]) && !before.contains(&space.template_of[row]))
    {
        return None;
    }
    join_nearest(space, &mut groups, &fresh);
    Some(groups)
}
