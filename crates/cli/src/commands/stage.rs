//! The commands that run one stage of a suite, or two that belong together, and nothing more.

use crate::options::SuiteArgs;
use crate::output::{self, Output};
use crate::screen::{eprintln, println};
use recrash_pipeline::{PipelineError, Stage, Suite, check_choices, is_of_failure, missed, run_stage, unfaithful};

/// The command of the stage that comes then.
fn next(stage: &str) -> Option<&'static str> {
    Some(match stage {
        "narrate" => "design",
        "design" => "simulate",
        "simulate" => "tune",
        "tune" | "triage" | "review" => "report",
        _ => return None,
    })
}

/// Runs a stage of a suite, and the stages that belong to it, as one.
///
/// # Errors
/// A stage's, or a run is not true to its record.
pub fn run(args: &SuiteArgs, stages: &[Stage], output: Output) -> Result<(), PipelineError> {
    let saved = Suite::saved_options(&args.out)?.and_then(|options| options.ego);
    let suite = args.open_saved()?;
    let was = saved.as_deref().unwrap_or(&suite.profile().ego);
    if was != suite.ego() && !output.json && !output.quiet {
        eprintln!(
            "warning: the ego of this suite was {was} and is {} now; what later stages made with the other is out of date until they \
             run again",
            suite.ego()
        );
    }
    output::batch_remarks(&suite, output);
    check_choices(&suite)?;
    let (mut done, mut skipped, mut not_run, mut lost) = (0, 0, 0, Vec::new());
    for &stage in stages {
        let report = run_stage(&suite, stage, &*output.progress())?;
        (done, skipped) = (done + report.done, skipped + report.skipped);
        lost.extend(unfaithful(&suite, stage)?);
        not_run += report.diagnostics.iter().filter(|remark| runs_the_ego(stage) && is_of_failure(remark)).count();
        if !output.json && !output.quiet {
            output::remarks(&report);
        }
    }
    let name = stages.first().map_or("", |stage| stage.name());
    if output.json {
        output::json(
            &serde_json::json!({ "stage": name, "done": done, "skipped": skipped, "not_run": not_run, "unfaithful": lost }),
        );
    } else if !output.quiet {
        output::remark_list(&lost, "told by --json");
        let dir = suite.store().dir().display();
        println!("{name}: {done} units done, {skipped} there already, in {dir}");
        if let Some(next) = next(name) {
            println!("next: recrash {next} {dir}");
        }
    }
    missed(lost.len(), not_run).map_or(Ok(()), |what| Err(PipelineError::Missed { what }))
}

/// Whether a scenario that this stage fails on could not be run.
fn runs_the_ego(stage: Stage) -> bool {
    matches!(stage, Stage::Simulate | Stage::Tune | Stage::Triage)
}
