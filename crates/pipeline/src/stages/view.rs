//! The suite as the report sees it.

use super::Cases;
use super::DesignLog;
use super::made::{Case, Ran};
use super::review::Reviewed;
use super::summary::Summary;
use crate::files::paths::quoted;
use crate::options::{Options, RecordSource};
use crate::reading::named;
use crate::suite::{Stage, Suite, names};
use recrash_metrics::series;
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_report::{CaseRow, CaseView, RunRow, RunTrace, RunView, SuiteView, Thumbnail};
use recrash_sim::Ego;

/// The suite with all its rows.
pub(super) fn suite(
    suite: &Suite,
    cases: Cases,
    rows: Vec<CaseRow>,
    summary: &Summary,
    remarks: Vec<Diagnostic>,
) -> SuiteView {
    let options = suite.options();
    SuiteView {
        title: format!("{} crash scenarios for {}", rows.len(), suite.ego()),
        generated_by: format!("recrash {}", env!("CARGO_PKG_VERSION")),
        generated_at: None,
        command: options.command(),
        profile: suite.profile().clone(),
        ego: suite.ego().to_owned(),
        simulator: simulator_name(&rows),
        agents: options.cast.describe(),
        seed: options.seed,
        sample: options.records == RecordSource::Sample,
        records: cases.records,
        selection: cases.selection,
        accounts: cases.accounts,
        corpus: summary.corpus.clone(),
        cases: rows,
        diagnostics: model_remarks(summary).into_iter().chain(remarks).collect(),
    }
}

/// The simulator that ran the scenarios, with its version.
pub(super) fn simulator_name(rows: &[CaseRow]) -> String {
    rows.iter().find_map(|row| row.before.as_ref()).map_or_else(String::new, |run| run.judgement.simulator.clone())
}

/// How the models did: a note for each role, and a warning for each scenario in which the rules took over.
fn model_remarks(summary: &Summary) -> Vec<Diagnostic> {
    let mut remarks = Vec::new();
    for model in &summary.models {
        let code = format!("model.{}", model.role);
        let mut tell = |severity, message| {
            remarks.push(Diagnostic::new(severity, &code, Location::default(), message));
        };
        tell(Severity::Note, format!("{} by {}: {}", model.role, model.model, model.describe()));
        for reason in &model.reasons {
            let what = if model.is_review() { "nobody reviews it instead of" } else { "the rules took over from" };
            tell(Severity::Warning, format!("{}: {what} {}: {}", reason.id, model.model, reason.why));
        }
    }
    remarks
}

/// The stages in which a scenario is driven.
const DRIVEN_IN: [Stage; 3] = [Stage::Simulate, Stage::Tune, Stage::Triage];

/// The light part of a case.
pub(super) fn row(suite: &Suite, cases: &Cases, position: usize, case: &Case) -> CaseRow {
    let id = &case.cluster.scenario_id;
    let narrative = case.narrative.as_ref().map(|(narrative, _)| narrative);
    let Runs { before, untuned, told_tuned, after } = Runs::of(case);
    let last = after.or(before).map(|(ran, _)| ran);
    let mut row = CaseRow {
        scenario_id: id.clone(),
        template: case.cluster.template,
        cluster: None,
        records: Vec::new(),
        origin: narrative.map(|narrative| narrative.origin.clone()),
        told: narrative.and_then(|narrative| narrative.told_record().cloned()),
        narrative: narrative.map_or_else(String::new, |narrative| narrative.text.clone()),
        account: case.account.clone(),
        before: before.map(|(ran, file)| run_row(suite, ran, &file(id))),
        untuned: untuned.map(|(ran, file)| run_row(suite, ran, &file(id))),
        told_tuned: told_tuned.map(|(ran, file)| run_row(suite, ran, &file(id))),
        after: after.map(|(ran, file)| run_row(suite, ran, &file(id))),
        triage: case.triage.clone(),
        review: case.review.as_ref().and_then(Reviewed::by),
        changed: case.design.as_ref().and_then(DesignLog::change),
        undriven: case.failure.as_ref().is_some_and(|at| DRIVEN_IN.iter().any(|stage| stage.name() == at.stage)),
        refused: case.failure.as_ref().map(ToString::to_string),
        edited: case.edited.clone(),
        thumbnail: last.and_then(|ran| Thumbnail::of(&ran.run)),
    };
    place(cases, position, &mut row);
    row
}

/// A run, and the scenario file it is of.
type RunOf<'a> = (&'a Ran, fn(&str) -> String);

/// The runs of a case that the page shows.
#[derive(Clone, Copy)]
struct Runs<'a> {
    /// The scenario as designed; by accounts the recorded driver's, in the crash as reconstructed.
    before: Option<RunOf<'a>>,
    /// By accounts the system's there, where tuning kept another scenario.
    untuned: Option<RunOf<'a>>,
    /// By accounts the recorded driver's in that other scenario.
    told_tuned: Option<RunOf<'a>>,
    /// The scenario as tuned; by accounts the system's last run.
    after: Option<RunOf<'a>>,
}

impl<'a> Runs<'a> {
    fn of(case: &'a Case) -> Self {
        let scenario = |ran: &'a Option<Ran>| ran.as_ref().map(|ran| (ran, names::scenario as fn(&str) -> String));
        let tuned = |ran: &'a Ran| (ran, names::tuned as fn(&str) -> String);
        let first = scenario(&case.first);
        let moved = case.tuned.as_ref().filter(|tuned| tuned.is_another(&case.edited)).map(|moved| tuned(&moved.ran));
        match case.account {
            None => Self { before: first, untuned: None, told_tuned: None, after: moved },
            Some(_) => {
                // Where it went no further, the first run is not the last one.
                let stopped = case.failure.is_some();
                Self {
                    before: scenario(&case.recorded),
                    untuned: first.filter(|_| stopped || moved.is_some()),
                    told_tuned: case.recorded_tuned.as_ref().map(tuned),
                    after: moved.or(first.filter(|_| !stopped)),
                }
            }
        }
    }
}

/// Where a case's cluster and records stand in the suite.
pub(super) fn place(cases: &Cases, position: usize, row: &mut CaseRow) {
    let cluster = &cases.selection.clusters[position];
    row.cluster = Some(position);
    row.records = cases.shown(cluster);
}

fn run_row(suite: &Suite, ran: &Ran, file: &str) -> RunRow {
    RunRow { judgement: ran.run.judgement.clone(), rerun_command: rerun_command(suite, file, &ran.run.ego) }
}

/// The heavy part of a case.
pub(super) fn case(suite: &Suite, case: &Case) -> CaseView {
    let id = &case.cluster.scenario_id;
    let Runs { before, untuned, told_tuned, after } = Runs::of(case);
    CaseView {
        scenario_id: id.clone(),
        narrative: case.narrative.as_ref().map(|(narrative, _)| narrative.clone()),
        account: case.account.clone(),
        assumed: case.design.as_ref().map_or_else(Vec::new, |log| log.assumed.clone()),
        drawing: before.or(after).map(|(ran, _)| ran.scenario.drawing()).unwrap_or_default(),
        before: before.map(|(ran, file)| run_view(suite, ran, &file(id))),
        untuned: untuned.map(|(ran, file)| run_view(suite, ran, &file(id))),
        told_tuned: told_tuned.map(|(ran, file)| run_view(suite, ran, &file(id))),
        after: after.map(|(ran, file)| run_view(suite, ran, &file(id))),
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
        rerun_command: rerun_command(suite, file, &run.ego),
    }
}

/// The command that gives the run again, from the suite's folder.
pub(super) fn rerun_command(suite: &Suite, file: &str, driver: &str) -> String {
    let (options, default) = (suite.options(), Options::default());
    // The recorded driver is no system under test: no suite names it.
    let ego = if driver == Ego::Recorded.name() { driver } else { suite.ego() };
    let python_path = named::python_path_from_folder(suite.store().dir(), ego);
    let mut command = python_path.map_or_else(String::new, |path| path + " ") + &format!("recrash simulate {file}");
    if options.profile != default.profile {
        let profile = named::profile_from_folder(suite.store().dir(), &options.profile);
        command += &format!(" --profile {}", quoted(&profile));
    }
    if options.simulator != default.simulator {
        command += &format!(" --sim {}", options.simulator.name());
    }
    command + &format!(" --ego {}", quoted(&named::ego_from_folder(suite.store().dir(), ego)))
}
