//! The first stage: crash files to records.

use super::{StageReport, StageWork, cases};
use crate::error::PipelineError;
use crate::files::store::{to_compact_json, to_json};
use crate::reading::records::RecordInput;
use crate::reading::retelling::tell;
use crate::suite::Suite;
use crate::suite::names;
use recrash_model::Outcome;
use recrash_model::profile::Tells;

/// Runs the stage.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let input = RecordInput::read(suite.options())?;
    let mut report = work.whole(&inputs(suite, &input), || {
        let filter = input.filter().cloned();
        let Outcome { mut value, diagnostics } = input.ingest(suite.profile())?;
        let mut files = vec![(names::RECORD_REMARKS.into(), to_json(&diagnostics))];
        if suite.profile().records.tells == Tells::Accounts {
            let (told, accounts) = tell(value, filter.as_ref(), work.progress);
            value = told;
            files.push((names::ACCOUNTS.into(), to_compact_json(&accounts)));
        }
        files.push((names::RECORDS.into(), to_compact_json(&value)));
        Ok(files)
    })?;
    report.diagnostics = suite.store().read_json(names::RECORD_REMARKS)?;
    Ok(report)
}

/// What decides which records come out.
pub(super) fn inputs(suite: &Suite, input: &RecordInput) -> Vec<String> {
    std::iter::once(cases::text_of(suite.profile())).chain(input.parts()).collect()
}
