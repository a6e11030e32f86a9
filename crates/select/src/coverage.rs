//! What the picks cover, and the tables of the usable records.

use crate::group::Group;
use crate::matrix::distance;
use crate::space::ClusteringSpace;
use recrash_model::profile::SystemProfile;
use recrash_model::selection::{Coverage, PairCoverage, StageTables, ValuePair};
use recrash_model::template::Template;
use std::collections::BTreeSet;

/// Coverage of all rows of the space by the groups' picks. Definitions: `docs/models/selection.md`.
pub(crate) fn coverage(profile: &SystemProfile, space: &ClusteringSpace, groups: &[Group]) -> Coverage {
    let possible = profile.templates();
    // A pick whose crash is not told stands for nobody's.
    let told = groups.iter().map(Group::pick).filter(|&pick| space.told[pick]);
    let covered: BTreeSet<usize> = told.map(|pick| space.template_of[pick]).collect();
    let observed: BTreeSet<Template> = space.observed.iter().map(|o| o.template).collect();
    let picked: Vec<Template> = covered.iter().map(|&t| space.observed[t].template).collect();

    let nearest_pick = |row: usize| {
        let to_pick = |group: &Group| distance(space.points.row(row), space.points.row(group.pick()));
        groups.iter().map(to_pick).fold(f64::INFINITY, f64::min)
    };
    let to_nearest: Vec<f64> = (0..space.points.rows).map(nearest_pick).collect();
    let to_own: Vec<f64> = groups
        .iter()
        .flat_map(|group| {
            let pick = space.narrative.row(group.pick());
            group.members.iter().map(|&row| distance(space.narrative.row(row), pick))
        })
        .collect();
    let mean = |distances: &[f64]| distances.iter().sum::<f64>() / distances.len().max(1) as f64;
    let greatest = |distances: &[f64]| distances.iter().copied().fold(0.0, f64::max);

    Coverage {
        templates_possible: possible.len(),
        templates_observed: space.observed.len(),
        templates_covered: covered.len(),
        records_covered: covered.iter().map(|&t| space.observed[t].rows.len()).sum(),
        records: space.points.rows,
        radius: greatest(&to_nearest),
        mean_distance: mean(&to_nearest),
        embedding_radius: greatest(&to_own),
        embedding_mean_distance: mean(&to_own),
        pairs: pair_coverage(&possible, observed.iter(), &picked),
        holes_observed: space
            .observed
            .iter()
            .enumerate()
            .filter(|(index, _)| !covered.contains(index))
            .map(|(_, observed)| observed.template)
            .collect(),
        holes_possible: possible.into_iter().filter(|template| !observed.contains(template)).collect(),
    }
}

fn pair_coverage<'t>(
    possible: &[Template],
    observed: impl Iterator<Item = &'t Template>,
    picked: &[Template],
) -> PairCoverage {
    let pairs_of =
        |templates: &mut dyn Iterator<Item = &'t Template>| templates.flat_map(pairs).collect::<BTreeSet<_>>();
    let mut observed = observed;
    let observed = pairs_of(&mut observed);
    let covered: BTreeSet<ValuePair> = picked.iter().flat_map(pairs).collect();
    let possible: BTreeSet<ValuePair> = possible.iter().flat_map(pairs).collect();
    PairCoverage {
        possible: possible.len(),
        observed: observed.len(),
        covered: covered.len(),
        holes_observed: observed.difference(&covered).copied().collect(),
        holes_possible: possible.difference(&observed).copied().collect(),
    }
}

/// The six pairs of values in a template.
fn pairs(template: &Template) -> [ValuePair; 6] {
    let none = ValuePair { road: None, sv: None, cp: None, work_zone: None };
    let (road, sv, cp, work_zone) =
        (Some(template.road), Some(template.sv), Some(template.cp), Some(template.work_zone));
    [
        ValuePair { road, sv, ..none },
        ValuePair { road, cp, ..none },
        ValuePair { road, work_zone, ..none },
        ValuePair { sv, cp, ..none },
        ValuePair { sv, work_zone, ..none },
        ValuePair { cp, work_zone, ..none },
    ]
}

/// The tables of stage 1, in the profile's order.
pub(crate) fn stage_tables(profile: &SystemProfile, space: &ClusteringSpace) -> StageTables {
    let count = |keep: &dyn Fn(&Template) -> bool| -> usize {
        space.observed.iter().filter(|o| keep(&o.template)).map(|o| o.rows.len()).sum()
    };
    let expresses = &profile.expresses;
    StageTables {
        road_types: expresses.road_types.iter().map(|&road| (road, count(&|t| t.road == road))).collect(),
        sv_movements: expresses.sv_movements.clone(),
        movements: expresses
            .cp_movements
            .iter()
            .map(|&cp| {
                let row = expresses.sv_movements.iter().map(|&sv| count(&|t| t.cp == cp && t.sv == sv)).collect();
                (cp, row)
            })
            .collect(),
        work_zone: count(&|t| t.work_zone),
        largest_template: space.observed.first().map_or(0, |o| o.rows.len()),
    }
}
