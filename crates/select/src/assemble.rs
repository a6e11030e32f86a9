//! From groups to the saved selection: numbers, names, map and remarks.

use crate::SelectOptions;
use crate::coverage::{coverage, stage_tables};
use crate::matrix::{distance, squared_distance};
use crate::pca::principal_components;
use crate::space::ClusteringSpace;
use crate::strategy::Group;
use recrash_model::profile::SystemProfile;
use recrash_model::record::RecordSet;
use recrash_model::selection::{Cluster, Coverage, MapPoint, Selection, TemplateCount};
use recrash_model::{Diagnostic, Location, Outcome, Severity};

/// The selection that these groups make.
pub(crate) fn selection(
    records: &RecordSet,
    profile: &SystemProfile,
    options: &SelectOptions,
    space: &ClusteringSpace,
    groups: &[Group],
) -> Outcome<Selection> {
    let mut groups: Vec<&Group> = groups.iter().collect();
    // Templates are in the order of size already.
    groups.sort_by_key(|group| (space.template_of[group.pick()], group.members.iter().min().copied()));
    let clusters: Vec<Cluster> =
        groups.iter().enumerate().map(|(i, group)| cluster(records, space, i + 1, group)).collect();
    let templates = space
        .observed
        .iter()
        .map(|observed| TemplateCount {
            template: observed.template,
            records: observed.rows.len(),
            picks: clusters.iter().filter(|cluster| cluster.template == observed.template).count(),
        })
        .collect();
    let owned: Vec<Group> = groups.into_iter().cloned().collect();
    let coverage = coverage(profile, space, &owned);
    let mut diagnostics = space.diagnostics.clone();
    diagnostics.extend(remarks(options, clusters.len(), &coverage));
    let value = Selection {
        strategy: options.strategy,
        budget: options.budget,
        seed: options.seed.0,
        embedding: space.info.clone(),
        template_weight: options.template_weight,
        weighting: options.weighting,
        inertia: inertia(space, &owned),
        tables: stage_tables(profile, space),
        templates,
        clusters,
        map: map(space, &owned),
        coverage,
    };
    Outcome { value, diagnostics }
}

fn cluster(records: &RecordSet, space: &ClusteringSpace, number: usize, group: &Group) -> Cluster {
    let pick = group.pick();
    let template = space.observed[space.template_of[pick]].template;
    let pick_index = space.positions[pick];
    let to_pick = |&row: &usize| distance(space.points.row(row), space.points.row(pick));
    Cluster {
        number,
        scenario_id: format!("{number:02}-{}", template.slug()),
        template,
        pick: records.records[pick_index].id.clone(),
        pick_index,
        members: group.members.iter().map(|&row| space.positions[row]).collect(),
        radius: group.members.iter().map(to_pick).fold(0.0, f64::max),
    }
}

/// Sum of squared distances of the rows to the mean of their group, each row counted once whatever its weight.
pub(crate) fn inertia(space: &ClusteringSpace, groups: &[Group]) -> f64 {
    let of_group = |group: &Group| -> f64 {
        let points = space.points.select(&group.members);
        let mean = points.mean();
        (0..points.rows).map(|i| squared_distance(points.row(i), &mean)).sum()
    };
    groups.iter().map(of_group).sum()
}

fn map(space: &ClusteringSpace, groups: &[Group]) -> Vec<MapPoint> {
    let plane = principal_components(&space.points, 2).scores;
    let mut cluster_of = vec![0; space.points.rows];
    for (index, group) in groups.iter().enumerate() {
        group.members.iter().for_each(|&row| cluster_of[row] = index);
    }
    let coordinate = |row: usize, axis: usize| plane.row(row).get(axis).copied().unwrap_or(0.0);
    (0..space.points.rows)
        .map(|row| MapPoint {
            record: space.positions[row],
            cluster: cluster_of[row],
            x: coordinate(row, 0),
            y: coordinate(row, 1),
        })
        .collect()
}

fn remarks(options: &SelectOptions, picks: usize, coverage: &Coverage) -> Vec<Diagnostic> {
    let mut remarks = Vec::new();
    if picks < options.budget {
        let message = format!(
            "{picks} picks instead of {}: {} usable records are not enough different ones",
            options.budget, coverage.records
        );
        let remark = Diagnostic::new(Severity::Warning, "select.fewer-picks", Location::default(), message);
        remarks.push(remark.with_hint("give more records, or a profile that expresses more, or a smaller budget"));
    }
    if !coverage.holes_observed.is_empty() {
        let message = format!(
            "{} of {} observed templates have no pick",
            coverage.holes_observed.len(),
            coverage.templates_observed
        );
        let hint = if options.budget < coverage.templates_observed {
            format!("a budget of {} covers them all with the stratified strategy", coverage.templates_observed)
        } else {
            "the stratified strategy covers them all".to_owned()
        };
        let remark = Diagnostic::new(Severity::Warning, "select.templates-without-pick", Location::default(), message);
        remarks.push(remark.with_hint(hint));
    }
    remarks
}
