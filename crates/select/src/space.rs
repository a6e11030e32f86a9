//! The clustering space: one-hot templates beside the principal components of the embedding.

use crate::matrix::Matrix;
use crate::pca::principal_components;
use crate::{Embedding, SelectError, SelectOptions};
use recrash_model::profile::SystemProfile;
use recrash_model::record::{CrashRecord, RecordSet, Severity};
use recrash_model::selection::{EmbeddingInfo, Weighting};
use recrash_model::template::Template;
use recrash_model::{Diagnostic, Location};
use std::collections::{BTreeMap, BTreeSet};

/// A template that occurs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ObservedTemplate {
    pub template: Template,
    /// Rows of the space that have it, in order.
    pub rows: Vec<usize>,
    /// Sum of the weights of these rows.
    pub weight: f64,
}

/// Everything a strategy needs to choose from. Row numbers count the records that take part.
#[derive(Debug, Clone)]
pub(crate) struct ClusteringSpace {
    /// Position in [`RecordSet::records`] of each row.
    pub positions: Vec<usize>,
    /// Index into `observed` of each row.
    pub template_of: Vec<usize>,
    /// Observed templates, most records first, then in the profile's order.
    pub observed: Vec<ObservedTemplate>,
    /// How much each row counts. Positive.
    pub weights: Vec<f64>,
    /// Whether the row's own crash is told.
    pub told: Vec<bool>,
    /// Principal components of the embedding, one row per record.
    pub narrative: Matrix,
    /// `[template_weight * one-hot(template), narrative]`, one row per record.
    pub points: Matrix,
    /// What was embedded how.
    pub info: EmbeddingInfo,
    /// Remarks on records that take no part.
    pub diagnostics: Vec<Diagnostic>,
}

impl ClusteringSpace {
    pub fn new(
        records: &RecordSet,
        profile: &SystemProfile,
        options: &SelectOptions,
        embedding: &Embedding,
    ) -> Result<Self, SelectError> {
        check_options(options)?;
        check_records(records)?;
        if embedding.rows() != records.usable.len() {
            return Err(SelectError::EmbeddingRows { expected: records.usable.len(), found: embedding.rows() });
        }
        let Placed { positions, embedding_rows, mut observed, diagnostics } = place(records, profile)?;
        let mut template_of = vec![0; positions.len()];
        let mut weights = vec![1.0; positions.len()];
        for (index, template) in observed.iter_mut().enumerate() {
            for &row in &template.rows {
                template_of[row] = index;
                weights[row] = match options.weighting {
                    Weighting::Frequency => 1.0,
                    Weighting::Severity => severity_weight(&records.records[positions[row]]),
                    Weighting::Template => 1.0 / template.rows.len() as f64,
                };
            }
            template.weight = template.rows.iter().map(|&row| weights[row]).sum();
        }

        let pca = principal_components(&embedding.select(&embedding_rows), options.dimensions);
        let mut points = Matrix::zeros(positions.len(), observed.len() + pca.scores.columns);
        for (row, &template) in template_of.iter().enumerate() {
            let point = points.row_mut(row);
            point[template] = options.template_weight;
            point[observed.len()..].copy_from_slice(pca.scores.row(row));
        }
        let info = EmbeddingInfo {
            name: embedding.name().to_owned(),
            source_dimensions: embedding.dimensions(),
            dimensions: pca.scores.columns,
            explained_variance: pca.explained_variance,
        };
        let told = positions.iter().map(|position| !records.untold.contains_key(position)).collect();
        Ok(Self { positions, template_of, observed, weights, told, narrative: pca.scores, points, info, diagnostics })
    }
}

/// The records that the profile has a template for, and the templates they have, the most frequent first.
struct Placed {
    /// Positions in the list of records.
    positions: Vec<usize>,
    /// Their rows in the embedding.
    embedding_rows: Vec<usize>,
    observed: Vec<ObservedTemplate>,
    /// Remarks on the others.
    diagnostics: Vec<Diagnostic>,
}

/// Puts every usable record with its template.
fn place(records: &RecordSet, profile: &SystemProfile) -> Result<Placed, SelectError> {
    let order: BTreeMap<Template, usize> = profile.templates().into_iter().zip(0..).collect();
    let mut diagnostics = Vec::new();
    let mut positions = Vec::new();
    let mut embedding_rows = Vec::new();
    let mut by_template: BTreeMap<usize, ObservedTemplate> = BTreeMap::new();
    for (entry, &position) in records.usable.iter().enumerate() {
        let record = &records.records[position];
        let Some((template, &place)) = record.template().and_then(|t| Some((t, order.get(&t)?))) else {
            diagnostics.push(not_expressible(record, profile));
            continue;
        };
        let new = ObservedTemplate { template, rows: Vec::new(), weight: 0.0 };
        by_template.entry(place).or_insert(new).rows.push(positions.len());
        positions.push(position);
        embedding_rows.push(entry);
    }
    if positions.is_empty() {
        return Err(SelectError::NoUsableRecords);
    }
    let mut observed: Vec<ObservedTemplate> = by_template.into_values().collect();
    observed.sort_by_key(|template| std::cmp::Reverse(template.rows.len()));
    Ok(Placed { positions, embedding_rows, observed, diagnostics })
}

/// How much a record counts under [`Weighting::Severity`]: doubled for each step of harm; unknown severity counts as
/// none. Assumed: the Standing General Order ranks severities but puts no numbers to them.
fn severity_weight(record: &CrashRecord) -> f64 {
    match record.severity.known() {
        None | Some(Severity::None) => 1.0,
        Some(Severity::Minor) => 2.0,
        Some(Severity::Moderate) => 4.0,
        Some(Severity::Serious) => 8.0,
        Some(Severity::Fatality) => 16.0,
    }
}

fn check_options(options: &SelectOptions) -> Result<(), SelectError> {
    let at_least_one = |option: &'static str, value: usize| match value {
        0 => Err(SelectError::BadOption { option, value: "0".to_owned(), allowed: "it must be at least 1" }),
        _ => Ok(()),
    };
    at_least_one("budget", options.budget)?;
    at_least_one("dimensions", options.dimensions)?;
    at_least_one("restarts", options.restarts)?;
    // Beyond this the squares of distances lose the narratives' digits.
    if !(0.0..=1e6).contains(&options.template_weight) {
        return Err(SelectError::BadOption {
            option: "template_weight",
            value: options.template_weight.to_string(),
            allowed: "it must be a number from 0 to 1000000",
        });
    }
    Ok(())
}

fn check_records(records: &RecordSet) -> Result<(), SelectError> {
    let mut seen = BTreeSet::new();
    for (entry, &position) in records.usable.iter().enumerate() {
        if position >= records.records.len() || !seen.insert(position) {
            return Err(SelectError::DamagedRecordSet { entry, position, records: records.records.len() });
        }
    }
    Ok(())
}

fn not_expressible(record: &CrashRecord, profile: &SystemProfile) -> Diagnostic {
    let template = record.template().map_or("no complete template".to_owned(), |t| format!("template \"{t}\""));
    Diagnostic::new(
        recrash_model::Severity::Warning,
        "select.not-expressible",
        Location::at_row(record.provenance.file.clone(), record.provenance.row),
        format!(
            "record {} has {template}, which profile \"{}\" cannot express; it is left out",
            record.id, profile.name
        ),
    )
    .with_hint("run `recrash records` again with this profile")
}
