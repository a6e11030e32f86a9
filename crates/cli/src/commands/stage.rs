//! The commands that run one stage of a suite and nothing more.

use crate::options::SuiteArgs;
use crate::output::{self, Output};
use crate::screen::println;
use recrash_pipeline::{PipelineError, Stage, unfaithful};

/// Runs one stage of a suite.
///
/// # Errors
/// The stage's, or a run is not true to its record.
pub fn run(args: &SuiteArgs, stage: Stage, output: Output) -> Result<(), PipelineError> {
    let suite = args.open_saved()?;
    let report = suite.run_stage(stage, &*output.progress())?;
    let unfaithful = unfaithful(&suite, stage)?;
    let (done, skipped) = (report.done, report.skipped);
    if output.json {
        output::json(&serde_json::json!({
            "stage": stage.name(), "done": done, "skipped": skipped, "unfaithful": unfaithful,
        }));
    } else if !output.quiet {
        output::remarks(&report);
        output::remark_list(&unfaithful, "told by --json");
        let dir = suite.store().dir().display();
        println!("{}: {done} done, {skipped} there already, in {dir}", stage.name());
    }
    match unfaithful.len() {
        0 => Ok(()),
        lost => Err(PipelineError::Missed {
            what: format!(
                "{lost} of {} scenarios are not true to their records; the results are written",
                done + skipped
            ),
        }),
    }
}
