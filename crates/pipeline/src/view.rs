//! The suite as the report sees it.

use crate::agents::Cast;
use crate::paths;
use crate::stages::{Case, Ran, names};
use crate::suite::{Options, RecordSource, Suite, quoted};
use crate::summary::{self, FallbackReason, simulator_name};
use recrash_metrics::series;
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_model::record::RecordSet;
use recrash_model::selection::Selection;
use recrash_report::{CaseView, RunTrace, RunView, SuiteView};

/// Puts together what the report shows.
pub fn view(
    suite: &Suite,
    records: &RecordSet,
    selection: &Selection,
    cases: &[Case],
    remarks: Vec<Diagnostic>,
) -> SuiteView {
    let options = suite.options();
    SuiteView {
        title: format!("{} crash scenarios for {}", cases.len(), suite.ego()),
        generated_by: format!("recrash {}", env!("CARGO_PKG_VERSION")),
        generated_at: None,
        command: options.command(),
        profile: suite.profile().clone(),
        ego: suite.ego().to_owned(),
        simulator: simulator_name(cases),
        agents: options.cast.describe(),
        seed: options.seed,
        sample: options.records == RecordSource::Sample,
        records: records.clone(),
        selection: selection.clone(),
        cases: cases.iter().enumerate().map(|(index, case)| case_view(suite, records, index, case)).collect(),
        diagnostics: model_remarks(&options.cast, cases).into_iter().chain(remarks).collect(),
    }
}

/// How the models did: a note for each role, and a warning for each scenario in which the rules took over.
fn model_remarks(cast: &Cast, cases: &[Case]) -> Vec<Diagnostic> {
    let mut remarks = Vec::new();
    for model in summary::models(cast, cases) {
        let code = format!("model.{}", model.role);
        let mut tell = |severity, message| {
            remarks.push(Diagnostic::new(severity, &code, Location::default(), message));
        };
        tell(Severity::Note, format!("{} by {}: {}", model.role, model.model, model.describe()));
        for FallbackReason { id, why } in &model.reasons {
            tell(Severity::Warning, format!("{id}: the rules took over from {}: {why}", model.model));
        }
    }
    remarks
}

fn case_view(suite: &Suite, records: &RecordSet, index: usize, case: &Case) -> CaseView {
    let id = &case.cluster.scenario_id;
    let positions =
        case.records.iter().filter_map(|shown| records.records.iter().position(|r| std::ptr::eq(r, *shown)));
    let moved = case.tuned.as_ref().filter(|tuned| tuned.log.best != 0);
    CaseView {
        scenario_id: id.clone(),
        template: case.cluster.template,
        cluster: Some(index),
        records: positions.collect(),
        narrative: case.narrative.as_ref().map(|(narrative, _)| narrative.clone()),
        drawing: case.first.as_ref().map(|ran| ran.scenario.network().drawing()).unwrap_or_default(),
        before: case.first.as_ref().map(|ran| run_view(suite, ran, &names::scenario(id))),
        after: moved.map(|tuned| run_view(suite, &tuned.ran, &names::tuned(id))),
        triage: case.triage.clone(),
        reference: case.reference.as_ref().map(|run| RunTrace { run: run.clone(), series: series(&run.rollout) }),
        tune_log: case.tuned.as_ref().map(|tuned| tuned.log.clone()),
        refused: case.failure.as_ref().map(ToString::to_string),
    }
}

fn run_view(suite: &Suite, Ran { scenario, run }: &Ran, file: &str) -> RunView {
    RunView {
        scenario: scenario.draft().clone(),
        run: run.clone(),
        series: series(&run.rollout),
        rerun_command: rerun_command(suite, file),
    }
}

/// The command that gives the run again, from the suite's folder.
fn rerun_command(suite: &Suite, file: &str) -> String {
    let (options, default) = (suite.options(), Options::default());
    let mut command = format!("recrash simulate {file}");
    if options.profile != default.profile {
        command +=
            &format!(" --profile {}", quoted(&paths::profile_from_folder(suite.store().dir(), &options.profile)));
    }
    if options.simulator != default.simulator {
        command += &format!(" --sim {}", options.simulator.name());
    }
    command + &format!(" --ego {}", quoted(&paths::ego_from_folder(suite.store().dir(), suite.ego())))
}
