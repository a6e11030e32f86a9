//! Runs of the same scenarios by two simulators: what the pipeline hands over for the page that shows them side by side.

use recrash_model::metrics::Series;
use recrash_model::profile::FailureCriteria;
use recrash_model::run::JudgedRun;
use recrash_roads::RoadDrawing;

/// A comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct PairsView {
    /// Title of the page.
    pub title: String,
    /// Program and version that wrote it, such as `recrash 0.1.0`.
    pub generated_by: String,
    /// The command that makes it again.
    pub command: String,
    /// Names of the two, such as `native` and `MetaDrive`.
    pub names: [String; 2],
    /// Limits that are drawn into the plots.
    pub criteria: FailureCriteria,
    /// Tables, in order.
    pub tables: Vec<TableView>,
    /// Pairs to look at, in order; a list of them leads to each.
    pub pairs: Vec<PairView>,
    /// What is not played, folded, under the list of what is.
    pub more: Option<TableView>,
}

/// A table of texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableView {
    /// What it shows.
    pub caption: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

/// One scenario, run by both.
#[derive(Debug, Clone, PartialEq)]
pub struct PairView {
    /// Name of the scenario.
    pub title: String,
    /// What is different, in a few words.
    pub remark: String,
    /// The road.
    pub drawing: RoadDrawing,
    /// The first run.
    pub first: RunTrace,
    /// The second, where there is one.
    pub second: Option<RunTrace>,
}

/// What a replay shows of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunTrace {
    /// What happened, and what that says.
    pub run: JudgedRun,
    /// Values over time.
    pub series: Series,
}
