//! Results against a baseline, and what continuous integration reads of them. Described in `docs/nightly.md`.

mod page;

pub use page::{PageRequest, write_page};

use crate::error::PipelineError;
use crate::files::output::{Output, Outputs};
use crate::files::store::to_json;
use crate::tools::testing::read_results;
use recrash_lab::comparison::compare;
use recrash_model::comparison::{Change, Comparison};
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
    let comparison = compare(&base, &new);
    Ok((new, comparison))
}

/// Compares results that were just made with a baseline.
///
/// # Errors
/// The baseline cannot be read, or holds no results.
pub fn compare_with(base: &Path, new: &TestResults) -> Result<Comparison, PipelineError> {
    Ok(compare(&read_results(base)?, new))
}

/// Refuses changes that must not be, and without a comparison tests that failed; in both cases those that were not run.
///
/// # Errors
/// There are some.
pub fn hold_to(
    results: &TestResults,
    comparison: Option<&Comparison>,
    fail_on: &[Change],
) -> Result<(), PipelineError> {
    let counted: Vec<(usize, &str)> = match comparison {
        Some(all) => fail_on.iter().map(|change| (all.of(*change).count(), change.label())).collect(),
        None => {
            [TestVerdict::Failed, TestVerdict::NotRun].map(|verdict| (results.count(verdict), verdict.label())).into()
        }
    };
    let told: Vec<String> =
        counted.into_iter().filter(|(count, _)| *count > 0).map(|(count, label)| format!("{count} {label}")).collect();
    match told.is_empty() || (comparison.is_none() && fail_on.is_empty()) {
        true => Ok(()),
        false => Err(PipelineError::Missed { what: format!("{} of {} tests", told.join(", "), results.tests.len()) }),
    }
}
