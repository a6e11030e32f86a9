//! What an assessor asks of a suite: what of all crashes it covers, and how far its severity goes with what records report.
//! Described in `docs/models/coverage.md` and `docs/models/severity.md`.

use crate::error::PipelineError;
use crate::files::output::Outputs;
use crate::stages::{CaseSummary, Cases, RunSummary, Summary};
use crate::suite::{Stage, Suite, names};
use recrash_lab::{HarmCase, severity_agreement};
use recrash_model::account::{Account, Party, SpeedMeaning, told};
use recrash_model::coverage::{CorpusCoverage, CoverageCounts, Hole};
use recrash_model::metrics::Answer;
use recrash_model::record::CrashRecord;
use recrash_model::severity::SeverityAgreement;
use recrash_model::spreadsheet::inert;
use serde::Serialize;
use std::path::Path;

/// Columns of the table of cells.
const COLUMNS: [&str; 9] = ["table", "axes", "cell", "incidents", "tellable", "told", "met", "failed", "hole"];

/// A failure of a suite, and what the record of its crash reports.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SevereFailure {
    /// Scenario.
    pub id: String,
    /// Change of velocity of the ego and of the other. [m/s]
    pub delta_v_mps: [f64; 2],
    /// Probability that somebody is seriously injured, where a published curve covers the contact.
    pub serious_injury: Option<f64>,
    /// Whether the system under test came into the situation of the record.
    pub met: bool,
    /// What the failure is worth.
    pub class: Option<&'static str>,
    /// Injury that the record alleges, where known.
    pub injury: Option<String>,
    /// A vehicle was towed, where known.
    pub towed: Option<bool>,
    /// Air bags deployed, where known.
    pub airbags: Option<bool>,
}

/// Severity in a suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuiteSeverity {
    /// Ego.
    pub ego: String,
    /// Failures with a contact of two road users, the worst first.
    pub failures: Vec<SevereFailure>,
    /// Computed severity of the crashes as they are told, against what their records report.
    pub agreement: SeverityAgreement,
}

/// What of all readable incidents a suite covers, as its report has it; written as a table of cells where `csv` is given.
///
/// # Errors
/// There is no suite with a report in the folder, it goes by templates, or the file cannot be written.
pub fn suite_coverage(dir: &Path, csv: Option<&Path>) -> Result<CorpusCoverage, PipelineError> {
    let suite = Suite::look(dir)?;
    let corpus = summary(&suite)?.corpus.ok_or_else(|| by_accounts_only(&suite))?;
    if let Some(csv) = csv {
        let output = Outputs::of_inputs([dir.to_owned()]).claim(csv)?;
        output.write(&cells_csv(&corpus))?;
    }
    Ok(corpus)
}

/// The same where there is a report of a suite that goes by accounts.
///
/// # Errors
/// There is no suite in the folder, or its summary is damaged.
pub(crate) fn coverage_where_told(dir: &Path) -> Result<Option<CorpusCoverage>, PipelineError> {
    let suite = Suite::look(dir)?;
    let told = suite.store().stamp(names::SUMMARY).is_some();
    Ok(told.then(|| summary(&suite)).transpose()?.and_then(|summary| summary.corpus))
}

/// How bad a suite's failures are, and how far that goes with what records report.
///
/// # Errors
/// There is no suite with a report in the folder, or it goes by templates.
pub fn suite_severity(dir: &Path) -> Result<SuiteSeverity, PipelineError> {
    let suite = Suite::look(dir)?;
    let summary = summary(&suite)?;
    let cases = Cases::read(&suite)?;
    if cases.accounts.is_none() {
        return Err(by_accounts_only(&suite));
    }
    let told: Vec<(&CaseSummary, &Account, &CrashRecord)> =
        summary.cases.iter().filter_map(|case| of_case(&cases, case)).collect();
    let harm_mps = |case: &CaseSummary| case.tuned.as_ref().map_or(0.0, RunSummary::harm_mps);
    let mut failures: Vec<(f64, SevereFailure)> =
        told.iter().filter_map(|&(case, _, record)| Some((harm_mps(case), failure(case, record)?))).collect();
    failures.sort_by(|(a_mps, a), (b_mps, b)| b_mps.total_cmp(a_mps).then_with(|| a.id.cmp(&b.id)));
    let failures = failures.into_iter().map(|(_, failure)| failure).collect();
    let crashes: Vec<HarmCase> =
        told.iter().filter_map(|&(case, account, record)| harm(case, account, record)).collect();
    Ok(SuiteSeverity { ego: summary.ego, failures, agreement: severity_agreement(&crashes) })
}

fn summary(suite: &Suite) -> Result<Summary, PipelineError> {
    suite.output_hash(Stage::Report, Stage::Report.name(), names::SUMMARY)?;
    suite.store().read_json(names::SUMMARY)
}

fn by_accounts_only(suite: &Suite) -> PipelineError {
    let dir = suite.store().dir().display();
    PipelineError::bad_input(format!(
        "{dir}: profile \"{}\" goes by templates, whose scenarios tell no accounts; a suite of profile open does",
        suite.profile().name
    ))
}

/// The account and the record of the crash that a case tells.
fn of_case<'a>(cases: &'a Cases, case: &'a CaseSummary) -> Option<(&'a CaseSummary, &'a Account, &'a CrashRecord)> {
    let report = case.told.as_ref()?;
    let record = cases.records.records.iter().find(|record| record.id == *report && record.reading.is_some())?;
    Some((case, cases.accounts.as_ref()?.of(report)?, record))
}

fn failure(case: &CaseSummary, record: &CrashRecord) -> Option<SevereFailure> {
    let run = case.tuned.as_ref().filter(|run| run.failed)?;
    Some(SevereFailure {
        id: case.id.clone(),
        delta_v_mps: run.delta_v_mps?,
        serious_injury: run.serious_injury,
        met: case.situation_met == Some(true),
        class: case.triage.as_ref().map(|triage| triage.class.label()),
        injury: record
            .severity
            .known()
            .and_then(|injury| serde_json::to_value(injury).ok()?.as_str().map(str::to_owned)),
        towed: record.towed.any(),
        airbags: record.airbags.any(),
    })
}

/// What the recorded driver's crash does, where it is told with a contact of two road users.
fn harm(case: &CaseSummary, account: &Account, record: &CrashRecord) -> Option<HarmCase> {
    let run = case.recorded.as_ref().filter(|run| run.faithful != Some(Answer::No))?;
    run.contact.as_ref().and(run.delta_v_mps)?;
    Some(HarmCase {
        delta_v_mps: run.harm_mps(),
        speeds_told: [Some(&account.sv), account.partner.as_ref()].into_iter().flatten().all(speed_is_told),
        reported_speed_mps: record.sv_speed_mps,
        injury: record.severity.known(),
        towed: record.towed,
        airbags: record.airbags,
    })
}

fn speed_is_told(party: &Party) -> bool {
    let stands = told(&party.state).is_some_and(recrash_model::account::ContactState::stands);
    stands || party.speeds.iter().any(|speed| speed.value.meaning != SpeedMeaning::Posted)
}

fn cells_csv(corpus: &CorpusCoverage) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Into memory, and every row has the header's width.
    let mut write = |cells: Vec<String>| {
        let cells = cells.iter().map(|cell| inert(cell).into_owned());
        writer.write_record(cells).expect("a row of the header's width");
    };
    write(COLUMNS.map(str::to_owned).into());
    let mut row = |table: &str, axes: String, cell: String, counts: &CoverageCounts, hole: Option<Hole>| {
        let CoverageCounts { incidents, tellable, told, met, failed } = *counts;
        let numbers = [incidents, tellable, told, met, failed].map(|count| count.to_string());
        let mut cells = vec![table.to_owned(), axes, cell];
        cells.extend(numbers);
        cells.push(hole.map_or_else(String::new, |hole| hole.label().to_owned()));
        write(cells);
    };
    row("all", String::new(), "all readable incidents".to_owned(), &corpus.all, None);
    for table in &corpus.tables {
        for cell in &table.cells {
            row(&table.id, table.axes.join(" | "), cell.values.join(" | "), &cell.counts, cell.hole());
        }
        for outside in &table.outside {
            row(&table.id, "outside".to_owned(), outside.why.clone(), &outside.counts, None);
        }
    }
    writer.into_inner().unwrap_or_default()
}
