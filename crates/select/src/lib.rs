//! Chooses the few records that stand for all of them, and says what the choice covers.
//!
//! Words: a *template* is one combination of the categorical columns; the *embedding* of a narrative is a row of numbers
//! that lies near to those of similar narratives; the *clustering space* joins both; a *pick* is the record nearest to
//! its cluster's centre. One scenario is made per pick.
//!
//! What this crate does **not** do: it reads no files and runs no language model. An embedder of its own kind plugs in
//! as rows of numbers ([`Embedding::new`], [`select_with`]). Equations, sources and what is guaranteed:
//! `docs/models/selection.md`.

mod apportion;
mod assemble;
mod coverage;
mod eigen;
mod embedding;
mod greedy;
mod group;
mod kmeans;
mod lexical;
mod matrix;
mod onward;
#[cfg(test)]
mod oracle;
mod pca;
mod space;
mod strategy;
mod stratified;
mod study;
mod words;

pub use embedding::{EMBEDDING_GRID, Embedding};
pub use lexical::{LEXICAL_DIMENSIONS, LEXICAL_NAME, lexical_embedding};
pub use study::{budget_table, elbow, stability};

use recrash_model::profile::SystemProfile;
use recrash_model::record::RecordSet;
use recrash_model::selection::{Selection, Strategy, Weighting};
use recrash_model::{Diagnostic, Location, Outcome, Seed, Severity};

/// How to choose.
#[derive(Debug, Clone, PartialEq)]
pub struct SelectOptions {
    /// How the picks are chosen.
    pub strategy: Strategy,
    /// Number of picks asked for.
    pub budget: usize,
    /// Seed of the k-means starts. `k-center` and `facility-location` use none.
    pub seed: Seed,
    /// Principal components of the embedding that enter the clustering space. The paper's six.
    pub dimensions: usize,
    /// Length of a template's one-hot vector in the clustering space: two records of different templates lie
    /// `sqrt(2)` times this apart, narratives aside. The paper's 1.
    pub template_weight: f64,
    /// How much one record counts.
    pub weighting: Weighting,
    /// Runs of k-means, of which the best is kept.
    pub restarts: usize,
}

impl Default for SelectOptions {
    fn default() -> Self {
        Self {
            strategy: Strategy::Stratified,
            budget: 20,
            seed: Seed(0),
            dimensions: 6,
            template_weight: 1.0,
            weighting: Weighting::Frequency,
            restarts: 20,
        }
    }
}

/// Why there is no selection.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SelectError {
    /// Nothing to choose from.
    #[error(
        "no usable records to choose from; look at the funnel (`recrash records`) for where they were lost, \
         or use a profile that expresses more road types and movements"
    )]
    NoUsableRecords,
    /// An option that makes no sense.
    #[error("{option} is {value}; {allowed}")]
    BadOption {
        /// Name of the option.
        option: &'static str,
        /// What was given.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// `usable` does not point into `records`.
    #[error(
        "the record set is damaged: `usable` entry {entry} points to record {position} of {records}, or repeats it"
    )]
    DamagedRecordSet {
        /// Place in `usable`.
        entry: usize,
        /// What stands there.
        position: usize,
        /// Number of records.
        records: usize,
    },
    /// Another number of rows than usable records.
    #[error(
        "the embedding has {found} rows for {expected} usable records; give one row per entry of `usable`, in order"
    )]
    EmbeddingRows {
        /// Usable records.
        expected: usize,
        /// Rows given.
        found: usize,
    },
    /// Rows of different lengths.
    #[error("row {row} of the embedding has {found} values, the first has {expected}")]
    EmbeddingRagged {
        /// Row, from 0.
        row: usize,
        /// Length of the first row.
        expected: usize,
        /// Length of this row.
        found: usize,
    },
    /// NaN or infinity.
    #[error("row {row} of the embedding holds a value that is not a finite number")]
    EmbeddingNotFinite {
        /// Row, from 0.
        row: usize,
    },
}

/// Chooses records with the lexical embedding of their narratives.
///
/// # Errors
/// Where nothing is usable, an option makes no sense, or the record set is damaged.
pub fn select(
    records: &RecordSet,
    profile: &SystemProfile,
    options: &SelectOptions,
) -> Result<Outcome<Selection>, SelectError> {
    select_with(records, profile, options, &embed_records(records))
}

/// The same with an embedding of the narratives from elsewhere: one row per usable record, in the order of
/// [`usable_narratives`].
///
/// # Errors
/// As [`select`], and where the embedding does not fit the records.
pub fn select_with(
    records: &RecordSet,
    profile: &SystemProfile,
    options: &SelectOptions,
    embedding: &Embedding,
) -> Result<Outcome<Selection>, SelectError> {
    let space = space::ClusteringSpace::new(records, profile, options, embedding)?;
    let groups = strategy::choose(&space, options);
    Ok(assemble::selection(records, profile, options, &space, &groups))
}

/// As [`select_with`], going on from an earlier choice: its picks stay as long as their records are there, and records that came in
/// join them or become picks where there is room. `earlier` holds positions in [`RecordSet::records`], each group's pick first.
///
/// # Errors
/// As [`select_with`].
pub fn select_onward(
    records: &RecordSet,
    profile: &SystemProfile,
    options: &SelectOptions,
    embedding: &Embedding,
    earlier: &[Vec<usize>],
) -> Result<Outcome<Selection>, SelectError> {
    let space = space::ClusteringSpace::new(records, profile, options, embedding)?;
    let Some(onward) = onward::go_on(&space, earlier, options.budget) else {
        let groups = strategy::choose(&space, options);
        return Ok(assemble::selection(records, profile, options, &space, &groups));
    };
    let mut outcome = assemble::selection(records, profile, options, &space, &onward.groups);
    outcome.diagnostics.extend(new_without_pick(onward.new_without_pick));
    Ok(outcome)
}

/// What there is to say about templates that came in since the last choice, and that none of its picks has.
fn new_without_pick(count: usize) -> Option<Diagnostic> {
    let have = match count {
        0 => return None,
        1 => "1 new template has".to_owned(),
        count => format!("{count} new templates have"),
    };
    let message = format!("{have} no pick, as those of the last choice stay");
    let note = Diagnostic::new(Severity::Note, "select.new-without-pick", Location::default(), message);
    Some(note.with_hint("a new choice, or a larger budget, takes them in"))
}

/// The narratives of the usable records, in order: what an embedder has to embed.
pub fn usable_narratives(records: &RecordSet) -> Vec<&str> {
    let narrative = |&i: &usize| records.records.get(i).map_or("", |record| record.narrative.as_str());
    records.usable.iter().map(narrative).collect()
}

/// Who reported each of the usable records, in order: for [`Embedding::without_house_style`].
pub fn usable_reporters(records: &RecordSet) -> Vec<&str> {
    let reporter = |&i: &usize| records.records.get(i).map_or("", |record| record.entity.as_str());
    records.usable.iter().map(reporter).collect()
}

/// The embedding [`select`] uses: the lexical one of the usable records, without what tells who wrote the report instead
/// of what happened (the words that name reporter and vehicle, and the reporter's house style).
pub fn embed_records(records: &RecordSet) -> Embedding {
    let used = records.usable.iter().filter_map(|&i| records.records.get(i));
    let authors: Vec<&str> = used.flat_map(|record| [record.entity.as_str(), record.vehicle.as_str()]).collect();
    lexical_embedding(&usable_narratives(records), &authors).without_house_style(&usable_reporters(records))
}
