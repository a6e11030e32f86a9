//! The report of a suite: an HTML page with one file a scenario beside it, JUnit XML and a CSV table.
//!
//! The page is a function of a [`SuiteView`], which holds what the tables say; the file of a scenario is a function of that
//! scenario's [`CaseView`] and nothing else, and is read when somebody looks at the scenario. So a suite of thousands opens
//! at once, and a scenario that changed is written alone.
//!
//! What this crate does **not** do: it opens no file, measures nothing, and loads nothing from a network, neither when it
//! runs nor when the page is looked at.

mod anchor;
pub mod comparison;
mod data;
mod junit;
mod numbers;
mod page;
mod pairs;
mod picture;
mod results;
mod search;
mod staging;
mod summary;
mod thumbnail;
mod view;
mod words;

pub use pairs::{PairView, PairsView, RunTrace, TableView};
pub use picture::picture;
pub use recrash_roads::{DrawnArea, GroundShape, LineKind, RoadDrawing, RoadLine};
pub use thumbnail::Thumbnail;
pub use view::{AccountRow, CaseContext, CaseRow, CaseView, Changed, RunRow, RunView, SuiteView};

/// The page. Same view, same bytes; all text of records and models is escaped, and nothing on it can load anything but the
/// files of its own scenarios, [`case_file_name`], from beside it.
pub fn html(suite: &SuiteView) -> String {
    page::render(suite)
}

/// The file of one scenario: data for the page, as one call of one function with one JSON value. It depends on the context,
/// the case and the row only.
pub fn case_file(context: &CaseContext, case: &CaseView, row: &CaseRow) -> String {
    page::case_file(context, case, row)
}

/// Where the page looks for it, from its own folder: `report/ID.js`, with an id that is not plain letters made so.
pub fn case_file_name(scenario_id: &str) -> String {
    format!("report/{}.js", anchor::stem(scenario_id))
}

/// The page of runs side by side: one document, with the same promises as [`html`].
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
