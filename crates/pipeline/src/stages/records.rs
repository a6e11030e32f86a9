//! The first stage: crash files to records.

use super::{StageReport, StageWork, cases};
use crate::error::PipelineError;
use crate::files::store::{to_compact_json, to_json};
use crate::reading::records::RecordInput;
use crate::suite::Suite;
use crate::suite::names;
use recrash_model::Outcome;

/// Runs the stage.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let input = RecordInput::read(suite.options())?;
    let mut report = work.whole(&inputs(suite, &input), || {
        let Outcome { value, diagnostics } = input.ingest(suite.profile())?;
        Ok(vec![
            (names::RECORDS.into(), to_compact_json(&value)),
            (names::RECORD_REMARKS.into(), to_json(&diagnostics)),
        ])
    })?;
    report.diagnostics = suite.store().read_json(names::RECORD_REMARKS)?;
    Ok(report)
}

/// What decides which records come out.
pub(super) fn inputs(suite: &Suite, input: &RecordInput) -> Vec<String> {
    std::iter::once(cases::text_of(suite.profile())).chain(input.parts()).collect()
}
