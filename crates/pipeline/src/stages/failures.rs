//! Scenarios that could not be made or run: each is told with its reason, kept in the suite, and the others go on.

use super::run_summary::RunSummary;
use super::{case_stages, unit_name};
use crate::error::PipelineError;
use crate::files::json::to_json;
use crate::suite::names;
use crate::suite::{Files, Stage, Suite};
use rayon::prelude::*;
use recrash_model::Diagnostic;
use recrash_model::diagnostic::{Location, Severity};
use recrash_model::metrics::Answer;
use recrash_model::profile::Tells;
use recrash_model::run::JudgedRun;
use recrash_model::selection::Selection;
use serde::{Deserialize, Serialize};

/// Why a scenario went no further.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// The stage it failed in.
    pub stage: String,
    /// Why.
    pub why: String,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.stage, self.why)
    }
}

/// Turns the failure of one scenario into a file of its unit; every other error stays one.
pub(crate) fn keep(stage: Stage, id: &str, result: Result<Files, PipelineError>) -> Result<Files, PipelineError> {
    match result {
        Err(PipelineError::Scenario { why, .. }) => {
            let failure = Failure { stage: stage.name().to_owned(), why };
            Ok(vec![(names::failure(stage, id), to_json(&failure))])
        }
        other => other,
    }
}

/// Where a scenario failed, in the stages before `end`.
pub(crate) fn before(suite: &Suite, id: &str, end: Stage) -> Option<Failure> {
    case_stages(suite)
        .iter()
        .map(|declared| declared.stage)
        .filter(|stage| *stage < end)
        .find_map(|stage| at(suite, id, stage))
}

/// How a scenario failed in one stage.
pub(crate) fn at(suite: &Suite, id: &str, stage: Stage) -> Option<Failure> {
    let file = names::failure(stage, id);
    let there = suite.wrote(&unit_name(stage, id), &file) && suite.store().stamp(&file).is_some();
    there.then(|| {
        suite.store().read_json(&file).unwrap_or_else(|e| Failure { stage: stage.name().into(), why: e.to_string() })
    })
}

/// The scenarios of a suite whose run is not true to its record, after simulating, as designed or as tuned: a remark each.
///
/// # Errors
/// A file of the suite cannot be read.
pub fn unfaithful(suite: &Suite, stage: Stage) -> Result<Vec<Diagnostic>, PipelineError> {
    let selection: Selection = suite.store().read_json(names::SELECTION)?;
    let ids: Vec<&str> = selection.clusters.iter().map(|cluster| cluster.scenario_id.as_str()).collect();
    unfaithful_among(suite, stage, &ids)
}

/// The same among these scenarios.
pub(super) fn unfaithful_among(suite: &Suite, stage: Stage, ids: &[&str]) -> Result<Vec<Diagnostic>, PipelineError> {
    let file: fn(&str) -> String = match (stage, suite.profile().records.tells) {
        (Stage::Simulate, Tells::Templates) => names::first_run,
        (Stage::Triage, Tells::Templates) => names::tuned_run,
        // What was recorded is held against the account; what the system under test does is its own.
        (Stage::Simulate, Tells::Accounts) => names::recorded_run,
        _ => return Ok(Vec::new()),
    };
    let judged = |id: &&str| -> Result<Option<Diagnostic>, PipelineError> {
        if !suite.store().path(&file(id)).exists() {
            return Ok(None);
        }
        let run: JudgedRun = suite.store().read_json(&file(id))?;
        let remark = || {
            let why = RunSummary::new(&run).unfaithful.join("; ");
            let location = Location { file: Some((*id).to_owned()), ..Location::default() };
            Diagnostic::new(Severity::Warning, "scenario.unfaithful", location, format!("not faithful: {why}"))
        };
        Ok((run.faithful() == Answer::No).then(remark))
    };
    let all: Vec<Option<Diagnostic>> = suite.in_pool(|| ids.par_iter().map(judged).collect::<Result<_, _>>())?;
    Ok(all.into_iter().flatten().collect())
}

/// What a run is told to have missed; nothing where every scenario was run and is true to its record.
pub fn missed(unfaithful: usize, not_run: usize) -> Option<String> {
    let scenarios = |count: usize| if count == 1 { "1 scenario".to_owned() } else { format!("{count} scenarios") };
    let unfaithful = match unfaithful {
        0 => None,
        1 => Some("1 scenario is not true to the record it tells".to_owned()),
        count => Some(format!("{count} scenarios are not true to the records they tell")),
    };
    let not_run = (not_run > 0).then(|| format!("{} could not be run", scenarios(not_run)));
    let both: Vec<String> = unfaithful.into_iter().chain(not_run).collect();
    (!both.is_empty()).then(|| format!("{}; the results are written", both.join(", and ")))
}

/// Whether a remark of a stage is about a scenario that could not be made or run.
pub fn is_of_failure(remark: &Diagnostic) -> bool {
    remark.code == FAILED
}

/// Name of remarks on scenarios that could not be made or run.
const FAILED: &str = "scenario.failed";

/// For people.
pub(crate) fn remark(id: &str, failure: &Failure) -> Diagnostic {
    let location = Location { file: Some(id.to_owned()), ..Location::default() };
    Diagnostic::new(Severity::Warning, FAILED, location, failure.to_string())
}
