//! What the pipeline hands to this crate: one suite, read only. Everything the page shows is computed from it.
//!
//! A suite is its light part, [`SuiteView`] with one [`CaseRow`] a scenario, from which come the overview, JUnit and CSV. The
//! heavy part, a [`CaseView`] with tracks and series, is needed for one scenario at a time, and never for all of them.
//!
//! Nothing is said twice: strategy, budget and embedding stand in [`Selection`], limits in [`SystemProfile`],
//! files and their hashes in [`RecordSet`].

use crate::pairs::RunTrace;
use crate::thumbnail::Thumbnail;
use recrash_model::Diagnostic;
use recrash_model::account::{AccountSet, CrashType, Driver, Role};
use recrash_model::coverage::CorpusCoverage;
use recrash_model::metrics::{Answer, Series};
use recrash_model::narrative::{Narrative, Origin};
use recrash_model::profile::SystemProfile;
use recrash_model::record::{CrashRecord, RecordRef, RecordSet};
use recrash_model::review::ReviewBy;
use recrash_model::run::{JudgedRun, Judgement};
use recrash_model::scenario::ScenarioDraft;
use recrash_model::selection::{Cluster, Selection};
use recrash_model::template::Template;
use recrash_model::triage::Triage;
use recrash_model::tuning::TuneLog;
use recrash_roads::RoadDrawing;
use serde::{Deserialize, Serialize};

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
    pub cases: Vec<CaseRow>,
    /// Remarks of every stage.
    pub diagnostics: Vec<Diagnostic>,
    /// What became of all incidents, in a suite that goes by accounts. Of [`AccountSet::told`] nothing is read.
    pub accounts: Option<AccountSet>,
    /// What of all readable incidents the suite covers, where it goes by accounts.
    pub corpus: Option<CorpusCoverage>,
}

/// What an account says of its crash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccountRow {
    /// Incident.
    pub incident: String,
    /// Reports of the incident.
    pub reports: usize,
    /// Crash type.
    pub crash_type: CrashType,
    /// Whose move brought the conflict about.
    pub role: Option<Role>,
    /// Who drove the record's vehicle at the contact.
    pub driver: Option<Driver>,
}

impl AccountRow {
    /// Whether a human drove the record's vehicle at the contact.
    pub fn human_drove(&self) -> bool {
        matches!(self.driver, Some(Driver::Human | Driver::HumanTookOver))
    }
}

/// What the runs of a case are called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RunNames {
    /// The first.
    pub before: &'static str,
    /// The one before tuning, where tuning kept another scenario than the reconstruction.
    pub untuned: &'static str,
    /// The recorded driver's in the scenario that tuning kept.
    pub told_tuned: &'static str,
    /// The last.
    pub after: &'static str,
}

impl RunNames {
    /// Of a suite that goes by templates: the same ego in the scenario as designed, and as tuned.
    pub const DESIGNED: Self = Self { before: "as designed", untuned: "as designed", told_tuned: "", after: "tuned" };
    /// Of a suite that goes by accounts: the recorded driver, and the system under test in the crash as reconstructed.
    pub const RETOLD: Self =
        Self { before: "as told", untuned: "tested", told_tuned: "as told, tuned", after: "tested" };
    /// The same where tuning kept another scenario: the system under test in both.
    pub const RETOLD_TUNED: Self = Self { after: "tuned", ..Self::RETOLD };

    /// Whether a run of this name is the recorded driver's: nobody is under test in it, and it is held against the record.
    pub fn is_recorded(name: &str) -> bool {
        [Self::RETOLD.before, Self::RETOLD.told_tuned].contains(&name)
    }

    fn of(account: bool, untuned: bool) -> Self {
        match (account, untuned) {
            (false, _) => Self::DESIGNED,
            (true, false) => Self::RETOLD,
            (true, true) => Self::RETOLD_TUNED,
        }
    }
}

/// What the tables say of one scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRow {
    /// Scenario id. No two of a suite are the same.
    pub scenario_id: String,
    /// Template it stands for.
    pub template: Template,
    /// Position of its cluster in [`Selection::clusters`], where it stands for one.
    pub cluster: Option<usize>,
    /// Positions in [`RecordSet::records`] of the records to show: the pick first, then a few of its neighbours.
    pub records: Vec<usize>,
    /// Whose crash the narrative tells, where one was written.
    pub origin: Option<Origin>,
    /// The record that is told; none where the crash is invented.
    pub told: Option<RecordRef>,
    /// Text of the narrative, to search in; empty where none was written.
    pub narrative: String,
    /// What the account says, in a suite that goes by accounts.
    #[serde(default)]
    pub account: Option<AccountRow>,
    /// The scenario as designed; in a suite that goes by accounts, the recorded driver's run in the crash as reconstructed. `None` only where it was refused
    /// before it could run.
    pub before: Option<RunRow>,
    /// In a suite that goes by accounts, the run of the system under test in the crash as reconstructed, where tuning kept
    /// another scenario; else that run is `after`.
    #[serde(default)]
    pub untuned: Option<RunRow>,
    /// In a suite that goes by accounts, the recorded driver's run in the scenario that tuning kept, where that is another one.
    #[serde(default)]
    pub told_tuned: Option<RunRow>,
    /// The scenario as tuned, where tuning kept another point; in a suite that goes by accounts, the last run of the system
    /// under test, where there is something to test.
    pub after: Option<RunRow>,
    /// How the other egos fare in the last run's scenario, where the ego under test fails it.
    pub triage: Option<Triage>,
    /// What a language model finds that holds the recorded driver's run against the report, where one is cast.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub review: Option<ReviewBy>,
    /// What a language model changed in what the rules staged, where one was cast and did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changed: Option<Changed>,
    /// Whether there is a scenario, and driving it failed.
    pub undriven: bool,
    /// Why the scenario was refused, where it was.
    pub refused: Option<String>,
    /// Files of this scenario that a person edited.
    pub edited: Vec<String>,
    /// A small picture of the last run.
    pub thumbnail: Option<Thumbnail>,
}

/// What a language model changed in what the rules staged of an account.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Changed {
    /// The model.
    pub model: String,
    /// What was told and shown otherwise before, in its words.
    pub what: String,
}

/// What the tables say of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRow {
    /// What is said about it.
    pub judgement: Judgement,
    /// The command that runs this scenario again.
    pub rerun_command: String,
}

/// Everything behind one scenario: what it came from and what it showed.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseView {
    /// Scenario id, the row's.
    pub scenario_id: String,
    /// The narrative, where one was written.
    pub narrative: Option<Narrative>,
    /// What the account says, in a suite that goes by accounts: the row's.
    pub account: Option<AccountRow>,
    /// What nobody told, and was chosen.
    pub assumed: Vec<String>,
    /// The road, to draw under the replay. Both runs share it.
    pub drawing: RoadDrawing,
    /// As [`CaseRow::before`].
    pub before: Option<RunView>,
    /// As [`CaseRow::untuned`].
    pub untuned: Option<RunView>,
    /// As [`CaseRow::told_tuned`].
    pub told_tuned: Option<RunView>,
    /// As [`CaseRow::after`].
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

/// What a scenario's own file needs besides the scenario: nothing that another scenario could change.
#[derive(Debug, Clone, Copy)]
pub struct CaseContext<'a> {
    /// Ego that was run.
    pub ego: &'a str,
    /// A box gap below this is a near miss, where somebody came nearer. [m]
    pub min_gap_m: f64,
    /// The records that row and cluster name by position. Only those are read.
    pub records: &'a [CrashRecord],
    /// The cluster that the scenario stands for, where it does.
    pub cluster: Option<&'a Cluster>,
}

impl SuiteView {
    /// The cluster a case stands for.
    pub fn cluster(&self, case: &CaseRow) -> Option<&Cluster> {
        self.selection.clusters.get(case.cluster?)
    }

    /// What the file of this case needs of the suite.
    pub fn context(&self, case: &CaseRow) -> CaseContext<'_> {
        CaseContext {
            ego: &self.ego,
            min_gap_m: self.profile.failure.min_gap_m,
            records: &self.records.records,
            cluster: self.cluster(case),
        }
    }

    /// The records a case shows, the pick first.
    pub fn case_records<'a>(&'a self, case: &'a CaseRow) -> impl Iterator<Item = &'a CrashRecord> {
        case.records.iter().filter_map(|&position| self.records.records.get(position))
    }
}

impl<'a> CaseContext<'a> {
    /// The records a case shows, the pick first.
    pub fn case_records(&self, case: &CaseRow) -> impl Iterator<Item = &'a CrashRecord> {
        let records = self.records;
        case.records.iter().filter_map(move |&position| records.get(position))
    }
}

impl CaseRow {
    /// The run of the system under test that counts: the tuned one, or the scenario as designed where tuning kept it.
    pub fn last_run(&self) -> Option<&RunRow> {
        self.after.as_ref().or(self.before.as_ref().filter(|_| self.account.is_none()))
    }

    /// Name of the run that counts.
    pub fn last_name(&self) -> &'static str {
        let names = self.names();
        if self.account.is_some() || self.after.is_some() { names.after } else { names.before }
    }

    /// The run of the system under test before tuning: in the scenario as designed, or in the crash as reconstructed.
    pub fn first_run(&self) -> Option<&RunRow> {
        match self.account {
            None => self.before.as_ref(),
            Some(_) => self.untuned.as_ref().or(self.after.as_ref()),
        }
    }

    /// Whether tuning kept another scenario than the first.
    pub fn is_tuned(&self) -> bool {
        let first = if self.account.is_some() { &self.untuned } else { &self.before };
        first.is_some() && self.after.is_some()
    }

    /// Whether the system under test fails after tuning alone.
    pub fn found_by_tuning(&self) -> bool {
        let fails = |run: Option<&RunRow>| run.is_some_and(|run| run.failed());
        fails(self.last_run()) && self.first_run().is_some() && !fails(self.first_run())
    }

    /// What its runs are called.
    pub fn names(&self) -> RunNames {
        RunNames::of(self.account.is_some(), self.untuned.is_some())
    }

    /// The runs with their names.
    pub fn runs(&self) -> Vec<(&'static str, &RunRow)> {
        named(self.names(), [&self.before, &self.untuned, &self.told_tuned, &self.after])
    }

    /// Those of the system under test: without the recorded driver's.
    pub fn system_runs(&self) -> Vec<(&'static str, &RunRow)> {
        self.runs().into_iter().filter(|(name, _)| !RunNames::is_recorded(name)).collect()
    }

    /// Whether the run that tells the record is true to it: the recorded driver's, or the last one where there is none. There
    /// is no answer where the scenario did not run, and none where nobody's crash is told: an invented course has no record to
    /// be true to.
    pub fn faithful(&self) -> Option<Answer> {
        let invented = matches!(self.origin, Some(Origin::Invented { .. }));
        self.telling_run().filter(|_| !invented).map(|run| run.faithful())
    }

    /// The run that is held against the record.
    pub fn telling_run(&self) -> Option<&RunRow> {
        if self.account.is_some() { self.before.as_ref() } else { self.last_run() }
    }

    /// Whether the system under test came into the situation of its record; nothing where that was not looked at.
    pub fn situation_met(&self) -> Option<bool> {
        self.account.as_ref().and(self.after.as_ref())?.situation_met()
    }
}

impl CaseView {
    /// As [`CaseRow::last_run`].
    pub fn last_run(&self) -> Option<&RunView> {
        self.after.as_ref().or(self.before.as_ref().filter(|_| self.account.is_none()))
    }

    /// What its runs are called.
    pub fn names(&self) -> RunNames {
        RunNames::of(self.account.is_some(), self.untuned.is_some())
    }

    /// The runs with their names.
    pub fn runs(&self) -> Vec<(&'static str, &RunView)> {
        named(self.names(), [&self.before, &self.untuned, &self.told_tuned, &self.after])
    }
}

fn named<T>(names: RunNames, runs: [&Option<T>; 4]) -> Vec<(&'static str, &T)> {
    let names = [names.before, names.untuned, names.told_tuned, names.after];
    names.into_iter().zip(runs).filter_map(|(name, run)| Some((name, run.as_ref()?))).collect()
}

impl std::ops::Deref for RunRow {
    type Target = Judgement;

    fn deref(&self) -> &Judgement {
        &self.judgement
    }
}

impl std::ops::Deref for RunView {
    type Target = JudgedRun;

    fn deref(&self) -> &JudgedRun {
        &self.run
    }
}
