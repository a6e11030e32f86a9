//! What the pipeline hands to this crate: one suite, read only. Everything the page shows is computed from it.
//!
//! Nothing is said twice: strategy, budget and embedding stand in [`Selection`], limits in [`SystemProfile`],
//! files and their hashes in [`RecordSet`].

use crate::pairs::RunTrace;
use recrash_model::Diagnostic;
use recrash_model::metrics::Series;
use recrash_model::narrative::Narrative;
use recrash_model::profile::SystemProfile;
use recrash_model::record::{CrashRecord, RecordSet};
use recrash_model::run::JudgedRun;
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::{Cluster, Selection};
use recrash_model::template::Template;
use recrash_model::triage::Triage;
use recrash_model::tuning::TuneLog;
use recrash_roads::RoadDrawing;

/// A whole suite.
#[derive(Debug, Clone, PartialEq)]
pub struct SuiteView {
    /// Title of the page, such as the suite folder's name.
    pub title: String,
    /// Program and version that wrote it, such as `recrash 0.1.0`.
    pub generated_by: String,
    /// When, as text; left out where the bytes must not depend on the clock.
    pub generated_at: Option<String>,
    /// The command that makes the suite again.
    pub command: String,
    /// The system profile.
    pub profile: SystemProfile,
    /// Ego that was run, such as `metadrive-idm`.
    pub ego: String,
    /// Simulator and its version, such as `native 0.1.0`.
    pub simulator: String,
    /// Agents that wrote narratives and scenarios, such as `rules`.
    pub agents: String,
    /// Seed of the run, as on the command line; every other seed follows from it.
    pub seed: u64,
    /// Whether the records are the built-in sample and no real crashes.
    pub sample: bool,
    /// The records, with funnel and files.
    pub records: RecordSet,
    /// Templates, clusters, picks, coverage.
    pub selection: Selection,
    /// One case per pick, in the order of the suite.
    pub cases: Vec<CaseView>,
    /// Remarks of every stage.
    pub diagnostics: Vec<Diagnostic>,
}

/// One scenario of the suite, with everything it came from and everything it showed.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseView {
    /// Scenario id.
    pub scenario_id: String,
    /// Template it stands for.
    pub template: Template,
    /// Position of its cluster in [`Selection::clusters`], where it stands for one.
    pub cluster: Option<usize>,
    /// Positions in [`RecordSet::records`] of the records to show: the pick first, then a few of its neighbours.
    pub records: Vec<usize>,
    /// The narrative, where one was written.
    pub narrative: Option<Narrative>,
    /// The road, to draw under the replay. Before and after tuning share it.
    pub drawing: RoadDrawing,
    /// The scenario as designed. `None` only where it was refused before it could run.
    pub before: Option<RunView>,
    /// The scenario as tuned, where tuning kept another point.
    pub after: Option<RunView>,
    /// How the other egos fare in the last run's scenario, where the ego under test fails it.
    pub triage: Option<Triage>,
    /// The reference driver's run of that scenario.
    pub reference: Option<RunTrace>,
    /// Log of the search, where there was one.
    pub tune_log: Option<TuneLog>,
    /// Why the scenario was refused, where it was.
    pub refused: Option<String>,
}

/// One run of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct RunView {
    /// The scenario that was run.
    pub scenario: ScenarioDraft,
    /// What happened, and what that says.
    pub run: JudgedRun,
    /// Values over time.
    pub series: Series,
    /// The command that runs this scenario again.
    pub rerun_command: String,
}

impl SuiteView {
    /// The cluster a case stands for.
    pub fn cluster(&self, case: &CaseView) -> Option<&Cluster> {
        self.selection.clusters.get(case.cluster?)
    }

    /// The records a case shows, the pick first.
    pub fn case_records<'a>(&'a self, case: &'a CaseView) -> impl Iterator<Item = &'a CrashRecord> {
        case.records.iter().filter_map(|&position| self.records.records.get(position))
    }
}

impl CaseView {
    /// The run the verdict is about: the tuned one, or the scenario as designed where tuning kept it.
    pub fn last_run(&self) -> Option<&RunView> {
        self.after.as_ref().or(self.before.as_ref())
    }
}

impl std::ops::Deref for RunView {
    type Target = JudgedRun;

    fn deref(&self) -> &JudgedRun {
        &self.run
    }
}
