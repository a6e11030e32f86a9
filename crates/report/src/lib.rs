//! The report of a suite: one self-contained HTML page, JUnit XML and a CSV table, each a function of a [`SuiteView`].
//!
//! What this crate does **not** do: it opens no file, measures nothing, and loads nothing from a network, neither when it
//! runs nor when the page is looked at.

mod anchor;
mod data;
mod junit;
mod page;
mod pairs;
mod results;
mod summary;
mod view;
mod words;

pub use pairs::{PairView, PairsView, RunTrace, TableView};
pub use recrash_roads::{LineKind, RoadDrawing, RoadLine};
pub use view::{CaseView, RunView, SuiteView};

/// The page. Same view, same bytes; all text of records and models is escaped, and nothing on it can load anything.
pub fn html(suite: &SuiteView) -> String {
    page::render(suite)
}

/// The page of runs side by side, with the same promises as [`html`].
pub fn pairs_html(pairs: &PairsView) -> String {
    page::render_pairs(pairs)
}

/// JUnit XML: one test suite of the scenarios as designed, one of the tuned ones. A failure is a failure of the ego; a
/// refused scenario is skipped.
pub fn junit(suite: &SuiteView) -> String {
    junit::render(suite)
}

/// A table (RFC 4180): one row for each run of each scenario, and one for each scenario that was refused.
pub fn results_csv(suite: &SuiteView) -> String {
    results::render(suite)
}
