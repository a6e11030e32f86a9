//! Results against a baseline, and what continuous integration reads of them. Described in `docs/nightly.md`.

mod page;

pub use page::{PageRequest, write_page};

use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::files::output::{Output, Outputs};
use crate::tools::testing::read_results;
use recrash_lab::comparison::compare;
use recrash_model::comparison::{Change, Compared, Comparison};
use recrash_model::results::{TestResults, TestVerdict};
use recrash_report::comparison::{junit, markdown};
use std::path::{Path, PathBuf};

/// What is written of results and their comparison.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CiFiles {
    /// JUnit XML.
    pub junit: Option<PathBuf>,
    /// Summary in Markdown.
    pub markdown: Option<PathBuf>,
    /// The comparison as JSON.
    pub json: Option<PathBuf>,
}

/// The same, once it is sure that nothing that is read is overwritten.
pub struct CiOutputs {
    junit: Option<Output>,
    markdown: Option<Output>,
    json: Option<Output>,
}

impl CiFiles {
    /// Claims the files beside the outputs of a command.
    ///
    /// # Errors
    /// One of them is read, or written twice.
    pub fn claim(&self, outputs: &mut Outputs) -> Result<CiOutputs, PipelineError> {
        let mut claim = |path: &Option<PathBuf>| path.as_ref().map(|path| outputs.claim(path)).transpose();
        Ok(CiOutputs { junit: claim(&self.junit)?, markdown: claim(&self.markdown)?, json: claim(&self.json)? })
    }
}

impl CiOutputs {
    /// Writes them.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, results: &TestResults, comparison: Option<&Comparison>) -> Result<(), PipelineError> {
        if let Some(output) = &self.junit {
            output.write(junit(results, comparison).as_bytes())?;
        }
        if let (Some(output), Some(comparison)) = (&self.markdown, comparison) {
            output.write(markdown(comparison).as_bytes())?;
        }
        if let (Some(output), Some(comparison)) = (&self.json, comparison) {
            output.write(&to_json(comparison))?;
        }
        Ok(())
    }
}

/// Reads two results and compares them.
///
/// # Errors
/// A file cannot be read, or holds no results.
pub fn compare_files(base: &Path, new: &Path) -> Result<(TestResults, Comparison), PipelineError> {
    let (base, new) = (read_results(base)?, read_results(new)?);
    let comparison = compare_with(&base, &new)?;
    Ok((new, comparison))
}

/// Compares results with a baseline.
///
/// # Errors
/// The two have no test in common, or none of those could be run for the baseline: nothing would be compared, and nothing be red.
pub fn compare_with(base: &TestResults, new: &TestResults) -> Result<Comparison, PipelineError> {
    let comparison = compare(base, new);
    if comparison.comparable().any(Compared::ran_before) || new.tests.is_empty() {
        return Ok(comparison);
    }
    if comparison.comparable().next().is_some() {
        return Err(tells_nothing(base));
    }
    Err(PipelineError::bad_input(format!(
        "there is nothing to compare: no test of suite {} is in suite {} with the same scenario; make new results of the \
         suite as it is now, and take those as the baseline",
        new.suite, base.suite
    )))
}

/// Refuses a baseline of which nothing could be run.
///
/// # Errors
/// It is one.
pub fn must_tell(baseline: &TestResults) -> Result<(), PipelineError> {
    let ran = baseline.tests.iter().any(|test| test.verdict() != TestVerdict::NotRun);
    if ran || baseline.tests.is_empty() { Ok(()) } else { Err(tells_nothing(baseline)) }
}

fn tells_nothing(baseline: &TestResults) -> PipelineError {
    let why = baseline.tests.iter().flat_map(|test| &test.runs).find_map(|run| run.why.as_deref());
    PipelineError::bad_input(format!(
        "there is nothing to compare: no test could be run for the baseline ({}); make it again with an ego that runs",
        why.unwrap_or("no reason is told")
    ))
}

/// Refuses changes that must not be, and without a comparison tests that failed; in both cases those that were not run: a system
/// that cannot be run is not as good as it was. Where nothing is asked for, only that nothing at all could be run.
///
/// # Errors
/// There are some.
pub fn hold_to(
    results: &TestResults,
    comparison: Option<&Comparison>,
    fail_on: &[Change],
) -> Result<(), PipelineError> {
    if fail_on.is_empty() {
        let (not_run, all) = (results.count(TestVerdict::NotRun), results.tests.len());
        return match not_run > 0 && not_run == all {
            true => Err(PipelineError::Missed { what: format!("none of {all} tests could be run") }),
            false => Ok(()),
        };
    }
    let mut counted: Vec<(usize, &str)> = match comparison {
        Some(all) => {
            let asked = fail_on.iter().filter(|change| **change != Change::NotRun);
            asked.map(|change| (all.of(*change).len(), change.label())).collect()
        }
        // Without a baseline every failure is a change, but none is where only what cannot be run was asked for.
        None if fail_on.iter().all(|change| *change == Change::NotRun) => Vec::new(),
        None => vec![(results.count(TestVerdict::Failed), TestVerdict::Failed.label())],
    };
    counted.push((results.count(TestVerdict::NotRun), TestVerdict::NotRun.label()));
    let told: Vec<String> =
        counted.into_iter().filter(|(count, _)| *count > 0).map(|(count, label)| format!("{count} {label}")).collect();
    match told.is_empty() {
        true => Ok(()),
        false => Err(PipelineError::Missed { what: format!("{} of {} tests", told.join(", "), results.tests.len()) }),
    }
}
