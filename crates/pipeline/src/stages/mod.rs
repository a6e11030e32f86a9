//! The stages: what each reads, does and writes.
//!
//! A stage that works case by case is [declared](CaseStage): the files of earlier stages it reads, the files people may
//! edit, the options that decide, and the work. Everything else (what is skipped, kept, made again or removed, failures,
//! progress) is the same for all and stands here.

mod ahead;
mod cases;
mod choices;
mod design;
mod design_log;
mod failures;
mod invent;
mod made;
mod narrate;
mod own;
mod records;
mod report;
mod restage;
mod retold;
mod review;
mod run_summary;
mod second_reading;
mod second_staging;
mod select;
mod simulate;
mod summary;
mod triage;
mod tune;
mod view;

pub(crate) use cases::Cases;
pub use choices::{check_choices, must_be_ready};
pub use design_log::{DesignAttempt, DesignLog};
pub use failures::{Failure, is_of_failure, missed, unfaithful};
pub(crate) use restage::question as restage_question;
pub(crate) use review::Beside;
pub use run_summary::RunSummary;
pub use select::{SelectionStudy, StrategyStudy};
pub use summary::{AccountSummary, CaseSummary, FallbackReason, ModelSummary, Reviews, Shown, Summary, TestedRuns};

use crate::error::PipelineError;
use crate::models::cast::RULES;
use crate::progress::{Progress, ProgressEvent};
use crate::simulators::Simulator;
use crate::simulators::external::FILES_UNKNOWN;
use crate::suite::{Course, Files, Stage, Suite, Work};
use rayon::prelude::*;
use recrash_agents::llm::prompts_version;
use recrash_model::profile::Tells;
use recrash_model::selection::Cluster;
use recrash_model::{Diagnostic, Location, Severity};
use std::sync::Arc;

/// The stages that work case by case, in order: of a suite that goes by templates, or by accounts. The last of those is there where a
/// model is cast for it.
pub(crate) fn case_stages(suite: &Suite) -> Vec<CaseStage> {
    match suite.profile().records.tells {
        Tells::Templates => {
            vec![narrate::DECLARED, design::DECLARED, simulate::DECLARED, tune::DECLARED, triage::DECLARED]
        }
        Tells::Accounts => retold::DECLARED
            .into_iter()
            .chain(suite.options().cast.review.is_some().then_some(review::DECLARED))
            .collect(),
    }
}

/// A stage that works case by case.
#[derive(Clone, Copy)]
pub(crate) struct CaseStage {
    /// Which one.
    pub stage: Stage,
    /// Files of earlier stages that it reads, by the case's id.
    pub reads: fn(&str) -> Vec<(Stage, String)>,
    /// Files of its own that a person may edit.
    pub editable: fn(&str) -> Vec<String>,
    /// Options that decide what it makes, beside the profile.
    pub decides: fn(&Suite) -> Result<Vec<String>, PipelineError>,
    /// Whether the ego is run.
    pub runs_ego: bool,
    /// What it makes of a case.
    pub work: fn(&Bench, &Cluster) -> Result<Files, PipelineError>,
}

/// What the work on a case needs.
pub(crate) struct Bench<'a> {
    /// The suite.
    pub suite: &'a Suite,
    /// Its cases.
    pub cases: &'a Cases,
    simulator: Option<Arc<dyn Simulator>>,
}

impl Bench<'_> {
    /// The simulator with the ego in it, of a stage that runs it.
    pub fn simulator(&self) -> &dyn Simulator {
        self.simulator.as_deref().unwrap_or_else(|| unreachable!("the stage is declared to run the ego"))
    }
}

/// What a stage did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StageReport {
    /// Units that were done.
    pub done: usize,
    /// Units that were there already.
    pub skipped: usize,
    /// Remarks worth showing.
    pub diagnostics: Vec<Diagnostic>,
}

/// Runs one stage of a suite; the stages before must be finished.
///
/// # Errors
/// A stage before is missing, the input is bad, or a file cannot be read or written. Finished units stay.
pub fn run_stage(suite: &Suite, stage: Stage, progress: &dyn Progress) -> Result<StageReport, PipelineError> {
    suite.on_threads(stage, || run(&StageWork { suite, stage, progress }))
}

fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    match work.stage {
        Stage::Records => records::run(work),
        Stage::Select => select::run(work),
        Stage::Report => report::run(work),
        Stage::Review => review::run(work),
        _ => {
            let declared = case_stages(work.suite).into_iter().find(|declared| declared.stage == work.stage);
            let declared = declared.unwrap_or_else(|| unreachable!("every other stage works case by case"));
            let cases = Cases::read(work.suite)?;
            if work.stage == Stage::Design && cases.accounts.is_some() {
                restage::tell_cost(work, &declared, &cases)?;
            }
            per_case(work, &declared, &cases)
        }
    }
}

/// A stage at work.
pub(crate) struct StageWork<'a> {
    /// Where.
    pub suite: &'a Suite,
    stage: Stage,
    progress: &'a dyn Progress,
}

impl StageWork<'_> {
    /// A stage of one unit.
    pub fn whole(
        &self,
        inputs: &[String],
        make: impl FnOnce() -> Result<Files, PipelineError>,
    ) -> Result<StageReport, PipelineError> {
        let stage = self.stage.name();
        self.progress.event(ProgressEvent::Started { stage, units: 1 });
        let course = self.suite.unit(&Work { name: stage, inputs, editable: &[] }, make)?;
        let skipped = course != Course::Done;
        self.progress.event(ProgressEvent::Advanced { stage, unit: stage, skipped });
        self.progress.event(ProgressEvent::Finished { stage });
        Ok(StageReport { done: usize::from(!skipped), skipped: usize::from(skipped), diagnostics: Vec::new() })
    }

    /// Units of this stage, in parallel; a unit's failure that is its own is kept as a file.
    pub fn units<T: Sync>(
        &self,
        units: &[T],
        id: impl Fn(&T) -> &str + Sync,
        editable: fn(&str) -> Vec<String>,
        inputs: impl Fn(&T) -> Result<Vec<String>, PipelineError> + Sync,
        make: impl Fn(&T) -> Result<Files, PipelineError> + Sync,
    ) -> Result<StageReport, PipelineError> {
        let (suite, stage) = (self.suite, self.stage.name());
        let names: Vec<String> = units.iter().map(|unit| unit_name(self.stage, id(unit))).collect();
        let mut diagnostics = suite.keep_only(self.stage, &names, editable)?;
        self.progress.event(ProgressEvent::Started { stage, units: names.len() });
        let one = |(unit, name): (&T, &String)| {
            let id = id(unit);
            let work = Work { name, inputs: &inputs(unit)?, editable: &editable(id) };
            let course = suite.unit(&work, || failures::keep(self.stage, id, make(unit)))?;
            self.progress.event(ProgressEvent::Advanced { stage, unit: id, skipped: course != Course::Done });
            Ok((id.to_owned(), course))
        };
        let results: Vec<Result<(String, Course), PipelineError>> = units.par_iter().zip(&names).map(one).collect();
        let waits = |result: &Result<_, PipelineError>| matches!(result, Err(PipelineError::AnswerPending));
        let waiting = results.iter().any(waits);
        let courses = results.into_iter().filter(|r| !waits(r)).collect::<Result<Vec<_>, _>>()?;
        if let (true, Some(models)) = (waiting, suite.models()) {
            let (requests, count) = models.write_requests()?;
            return Err(PipelineError::WaitingForBatch { requests, count });
        }
        self.progress.event(ProgressEvent::Finished { stage });
        diagnostics.extend(courses.iter().filter_map(|(id, course)| edit_remark(stage, id, *course)));
        let done = courses.iter().filter(|(_, course)| *course == Course::Done).count();
        Ok(StageReport { done, skipped: courses.len() - done, diagnostics })
    }
}

/// What there is to say about a case that a person edited.
fn edit_remark(stage: &str, id: &str, course: Course) -> Option<Diagnostic> {
    let (severity, message) = match course {
        Course::Done | Course::Skipped => return None,
        Course::Edited => (Severity::Note, "edited by hand, and kept"),
        Course::EditedAndOld => {
            (Severity::Warning, "edited by hand, and kept, though what it was made of has changed since")
        }
    };
    let location = Location { file: Some(id.to_owned()), ..Location::default() };
    let remark = Diagnostic::new(severity, "suite.edited", location, format!("{stage}: {message}"));
    Some(if severity == Severity::Warning {
        remark.with_hint("where edits are discarded it is made anew")
    } else {
        remark
    })
}

/// Runs a stage that works case by case, without the cases that failed before.
fn per_case(work: &StageWork, declared: &CaseStage, cases: &Cases) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let simulator = declared.runs_ego.then(|| suite.simulator()).transpose()?;
    let bench = Bench { suite, cases, simulator };
    let clusters = cases.up_to(suite, declared.stage);
    let mut report = work.units(
        &clusters,
        |cluster| &cluster.scenario_id,
        declared.editable,
        |cluster| case_inputs(suite, declared, cases, cluster),
        |cluster| (declared.work)(&bench, cluster),
    )?;
    let failed = |cluster: &&Cluster| {
        let id = &cluster.scenario_id;
        failures::at(suite, id, declared.stage).map(|failure| failures::remark(id, &failure))
    };
    report.diagnostics.extend(clusters.iter().filter_map(failed));
    if declared.stage == Stage::Simulate && suite.ego_identity()?.iter().any(|input| input == FILES_UNKNOWN) {
        report.diagnostics.push(unknown_files(suite.ego()));
    }
    Ok(report)
}

/// Why every run of this ego is made again.
fn unknown_files(ego: &str) -> Diagnostic {
    let message = format!(
        "{ego}: its module is neither in the current folder nor in one of PYTHONPATH, so nobody can tell whether it has changed: all of \
         its runs are made again each time"
    );
    Diagnostic::new(Severity::Note, "suite.ego-files", Location::default(), message)
        .with_hint("run the command in the module's folder, or put that folder into PYTHONPATH")
}

/// Name of a unit of a stage that works case by case.
pub(crate) fn unit_name(stage: Stage, id: &str) -> String {
    format!("{}/{id}", stage.name())
}

/// Everything that decides what a stage makes of a case, as hashes and words.
pub(crate) fn case_inputs(
    suite: &Suite,
    declared: &CaseStage,
    cases: &Cases,
    cluster: &Cluster,
) -> Result<Vec<String>, PipelineError> {
    let id = &cluster.scenario_id;
    let mut records = cases.records_of(cluster);
    if declared.stage != Stage::Review && suite.options().cast.makers().is_empty() {
        records.truncate(1);
    }
    let mut inputs = cases.inputs(cluster, &records);
    for (stage, file) in (declared.reads)(id) {
        inputs.push(suite.output_hash(stage, &unit_name(stage, id), &file)?);
    }
    inputs.push(cases::text_of(suite.profile()));
    if declared.runs_ego {
        inputs.push(suite.options().simulator.name().to_owned());
        inputs.extend_from_slice(suite.ego_identity()?);
    }
    inputs.extend((declared.decides)(suite)?);
    Ok(inputs)
}

/// Who plays a role, and with which prompts.
fn player(suite: &Suite, name: &str) -> String {
    match name {
        RULES => RULES.to_owned(),
        model => format!("{model} {} {}", suite.options().cast.repairs, prompts_version()),
    }
}

/// Files of a case that a person edited, of all stages.
pub(crate) fn edited_files(suite: &Suite, id: &str) -> Vec<String> {
    case_stages(suite)
        .iter()
        .flat_map(|declared| suite.edited(&unit_name(declared.stage, id), &(declared.editable)(id)))
        .collect()
}
