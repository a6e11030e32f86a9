//! The commands that run one stage of a suite and nothing more.

use crate::options::SuiteArgs;
use crate::output::{self, Output};
use anstream::println;
use recrash_pipeline::{PipelineError, Stage, check_choices};

/// Runs one stage of a suite.
///
/// # Errors
/// The stage's.
pub fn run(args: &SuiteArgs, stage: Stage, output: Output) -> Result<(), PipelineError> {
    let suite = args.open_saved()?;
    output::batch_remarks(&suite, output);
    check_choices(&suite)?;
    let report = suite.run_stage(stage, &*output.progress())?;
    if output.json {
        output::json(&serde_json::json!({ "stage": stage.name(), "done": report.done, "skipped": report.skipped }));
    } else if !output.quiet {
        output::remarks(&report);
        let dir = suite.store().dir().display();
        println!("{}: {} done, {} there already, in {dir}", stage.name(), report.done, report.skipped);
    }
    Ok(())
}
