//! From groups to the saved selection: numbers, names, map and remarks.

use crate::SelectOptions;
use crate::coverage::{coverage, stage_tables};
use crate::group::Group;
use crate::matrix::{distance, squared_distance};
use crate::pca::principal_components;
use crate::space::ClusteringSpace;
use recrash_model::hash::Fnv;
use recrash_model::profile::SystemProfile;
use recrash_model::record::{RecordRef, RecordSet};
use recrash_model::selection::{Cluster, Coverage, MapPoint, Selection, TemplateCount};
use recrash_model::template::Template;
use recrash_model::{Diagnostic, Location, Outcome, Severity};
use std::collections::BTreeMap;

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
    let mut clusters: Vec<Cluster> =
        groups.iter().enumerate().map(|(i, group)| cluster(records, space, i + 1, group)).collect();
    name(&mut clusters);
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
    diagnostics.extend(remarks(options, &clusters, &coverage));
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
        scenario_id: scenario_id(&template, &records.records[pick_index].id),
        template,
        pick: records.records[pick_index].id.clone(),
        pick_index,
        members: group.members.iter().map(|&row| space.positions[row]).collect(),
        radius: group.members.iter().map(to_pick).fold(0.0, f64::max),
        invented: false,
    }
}

/// Name of the scenario of a pick: its template and its report. Neither changes when other records come or go, or a later
/// version of the report does.
fn scenario_id(template: &Template, pick: &RecordRef) -> String {
    let report = &pick.report_id;
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if report.len() <= LONGEST_REPORT_ID && report.chars().all(plain) {
        return format!("{}-{report}", template.slug());
    }
    let mut hash = Fnv::default();
    hash.write_text(report);
    format!("{}-{}", template.slug(), hash.hexadecimal())
}

/// Report ids up to this length stand in names of files as they are. [characters]
const LONGEST_REPORT_ID: usize = 32;

/// Tells apart what shares a name: several versions of one report may be picks where nothing is merged.
fn name(clusters: &mut [Cluster]) {
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    for cluster in clusters.iter() {
        *taken.entry(cluster.scenario_id.clone()).or_default() += 1;
    }
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for cluster in clusters.iter_mut().filter(|cluster| taken[&cluster.scenario_id] > 1) {
        cluster.scenario_id = format!("{}-v{}", cluster.scenario_id, cluster.pick.version);
        // One report in two files.
        let times = seen.entry(cluster.scenario_id.clone()).or_default();
        *times += 1;
        if *times > 1 {
            cluster.scenario_id = format!("{}-{times}", cluster.scenario_id);
        }
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

fn remarks(options: &SelectOptions, clusters: &[Cluster], coverage: &Coverage) -> Vec<Diagnostic> {
    let picks = clusters.len();
    let mut remarks = Vec::new();
    if picks < options.budget {
        let message = format!(
            "{picks} picks instead of {}: {} usable records are not enough different ones",
            options.budget, coverage.records
        );
        let remark = Diagnostic::new(Severity::Warning, "select.fewer-picks", Location::default(), message);
        remarks.push(remark.with_hint("give more records, or a profile that expresses more, or a smaller budget"));
    }
    let picked = |template: &Template| clusters.iter().any(|cluster| cluster.template == *template);
    let (invented, without): (Vec<&Template>, Vec<&Template>) =
        coverage.holes_observed.iter().partition(|template| picked(template));
    let mut tell = |code: &'static str, message: String, hint: String| {
        remarks.push(Diagnostic::new(Severity::Warning, code, Location::default(), message).with_hint(hint));
    };
    let observed = coverage.templates_observed;
    if !without.is_empty() {
        let hint = if options.budget < observed {
            format!("a budget of {observed} covers them all with the stratified strategy")
        } else {
            "the stratified strategy covers them all".to_owned()
        };
        let message = format!("{} of {observed} observed templates have no pick", without.len());
        tell("select.templates-without-pick", message, hint);
    }
    if !invented.is_empty() {
        let message = format!("{} of {observed} observed templates have no record whose crash is told", invented.len());
        let hint = "their scenarios are invented, and say why".to_owned();
        tell("select.templates-invented", message, hint);
    }
    remarks
}
