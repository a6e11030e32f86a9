//! All of it to a page: one file a case, and the overview of all.

use super::made::Case;
use super::summary::{CaseSummary, summarise};
use super::{
    Cases, StageReport, StageWork, case_inputs, case_stages, cases, edited_files, failures, records, unit_name, view,
};
use crate::error::PipelineError;
use crate::files::json::{to_compact_json, to_json};
use crate::reading::records::RecordInput;
use crate::suite::names;
use crate::suite::{Files, Stage, Suite, Work};
use rayon::prelude::*;
use recrash_model::Diagnostic;
use recrash_model::record::RecordRef;
use recrash_model::selection::Cluster;
use recrash_report::CaseRow;
use serde::{Deserialize, Serialize};

/// What the overview needs of a case: so that it is made without reading the case again.
#[derive(Serialize, Deserialize)]
pub(super) struct CaseReport {
    /// For the page, JUnit and CSV.
    pub row: CaseRow,
    /// For `summary.json`.
    pub summary: CaseSummary,
}

/// Where it is kept.
fn row_file(id: &str) -> String {
    format!("report/{id}.json")
}

/// Runs the stage.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let cases = Cases::read(suite)?;
    refuse_stale(suite, &cases)?;
    let clusters: Vec<(usize, &Cluster)> = cases.selection.clusters.iter().enumerate().collect();
    let parts = work.units(
        &clusters,
        |(_, cluster)| &cluster.scenario_id,
        |_| Vec::new(),
        |(_, cluster)| inputs(suite, &cases, cluster),
        |(position, cluster)| case_files(suite, &cases, *position, cluster),
    )?;
    let mut inputs = vec![suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS)?];
    inputs.push(suite.output_hash(Stage::Select, Stage::Select.name(), names::SELECTION)?);
    inputs.extend([cases::text_of(suite.profile()), suite.options().command()]);
    for cluster in &cases.selection.clusters {
        let id = &cluster.scenario_id;
        inputs.push(suite.output_hash(Stage::Report, &unit_name(Stage::Report, id), &row_file(id))?);
    }
    let whole = work.whole(&inputs, || {
        let (rows, summaries) = rows(suite, &cases)?;
        let summary = summarise(suite, &cases, summaries, view::simulator_name(&rows));
        let remarks: Vec<Diagnostic> = suite.store().read_json(names::RECORD_REMARKS)?;
        let view = view::suite(suite, cases, rows, &summary, remarks);
        Ok(vec![
            (names::SUMMARY.into(), to_json(&summary)),
            (names::REPORT.into(), recrash_report::html(&view).into_bytes()),
            (names::JUNIT.into(), recrash_report::junit(&view).into_bytes()),
            (names::RESULTS.into(), recrash_report::results_csv(&view).into_bytes()),
        ])
    })?;
    let (done, skipped) = (parts.done + whole.done, parts.skipped + whole.skipped);
    Ok(StageReport { done, skipped, diagnostics: parts.diagnostics })
}

/// What the overview needs of all cases.
fn rows(suite: &Suite, cases: &Cases) -> Result<(Vec<CaseRow>, Vec<CaseSummary>), PipelineError> {
    let read = |(position, cluster): (usize, &Cluster)| {
        let CaseReport { mut row, summary } = suite.store().read_json(&row_file(&cluster.scenario_id))?;
        // Where records and clusters stand may change without the case.
        view::place(cases, position, &mut row);
        Ok((row, summary))
    };
    let all: Vec<Result<_, PipelineError>> = cases.selection.clusters.par_iter().enumerate().map(read).collect();
    Ok(all.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
}

/// A report tells of one system and one set of records: what every stage made must be of the options and the files as
/// they are now. Crash files that have gone since are taken as they were.
fn refuse_stale(suite: &Suite, cases: &Cases) -> Result<(), PipelineError> {
    if let Ok(input) = RecordInput::read(suite.options()) {
        let inputs = records::inputs(suite, &input);
        let work = Work { name: Stage::Records.name(), inputs: &inputs, editable: &[] };
        suite.must_be_current(Stage::Records, &work)?;
    }
    for declared in &case_stages(suite) {
        let current = |cluster: &&Cluster| {
            let id = &cluster.scenario_id;
            let inputs = case_inputs(suite, declared, cases, cluster)?;
            let (name, editable) = (unit_name(declared.stage, id), (declared.editable)(id));
            suite.must_be_current(declared.stage, &Work { name: &name, inputs: &inputs, editable: &editable })
        };
        // Of several the first, on any number of threads.
        let all: Vec<Result<(), PipelineError>> = cases.up_to(suite, declared.stage).par_iter().map(current).collect();
        all.into_iter().collect::<Result<(), _>>()?;
    }
    Ok(())
}

/// What decides about a case's files: its records and everything that was made of them.
fn inputs(suite: &Suite, cases: &Cases, cluster: &Cluster) -> Result<Vec<String>, PipelineError> {
    let id = &cluster.scenario_id;
    let mut inputs = cases.inputs(cluster, &cases.records_of(cluster));
    let members: Vec<&RecordRef> = cluster.members.iter().map(|&at| &cases.records.records[at].id).collect();
    // The number is on the page of a template's case alone.
    inputs.push(cases::text_of(&(members, cases.accounts.is_none().then_some(cluster.number))));
    inputs.push(cases::text_of(suite.profile()));
    inputs.push(view::rerun_command(suite, "", suite.ego()));
    inputs.push(cases::text_of(&edited_files(suite, id)));
    for declared in &case_stages(suite) {
        if let Some(failure) = failures::at(suite, id, declared.stage) {
            inputs.push(failure.to_string());
            break;
        }
        inputs.push(suite.outputs_hash(&unit_name(declared.stage, id)));
    }
    Ok(inputs)
}

fn case_files(suite: &Suite, cases: &Cases, position: usize, cluster: &Cluster) -> Result<Files, PipelineError> {
    let case = Case::read(suite, cases, cluster)?;
    let report = CaseReport { row: view::row(suite, cases, position, &case), summary: CaseSummary::of(&case) };
    let context = recrash_report::CaseContext {
        ego: suite.ego(),
        min_gap_m: suite.profile().failure.min_gap_m,
        records: &cases.records.records,
        cluster: Some(cluster),
    };
    let page = recrash_report::case_file(&context, &view::case(suite, &case), &report.row);
    let id = &cluster.scenario_id;
    Ok(vec![(recrash_report::case_file_name(id), page.into_bytes()), (row_file(id), to_compact_json(&report))])
}
