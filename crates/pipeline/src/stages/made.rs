//! What was made of a case, as far as it went: read from the suite's files for tables, page and summary.

use super::review::Reviewed;
use super::{Cases, DesignLog, Failure, cases, edited_files, failures, retold};
use crate::error::PipelineError;
use crate::models::cast::AgentLog;
use crate::suite::names;
use crate::suite::{Stage, Suite};
use recrash_agents::tell;
use recrash_model::narrative::Narrative;
use recrash_model::run::JudgedRun;
use recrash_model::selection::Cluster;
use recrash_model::triage::Triage;
use recrash_model::tuning::TuneLog;
use recrash_report::AccountRow;
use recrash_roads::Scenario;
use serde::de::DeserializeOwned;

/// One case with everything that was made of it, as far as it went.
pub(super) struct Case<'a> {
    /// Cluster and pick.
    pub cluster: &'a Cluster,
    /// Narrative, and who wrote it.
    pub narrative: Option<(Narrative, AgentLog)>,
    /// How the scenario was designed.
    pub design: Option<DesignLog>,
    /// What the account says, in a suite that goes by accounts.
    pub account: Option<AccountRow>,
    /// The recorded driver's run in the crash as reconstructed, in a suite that goes by accounts.
    pub recorded: Option<Ran>,
    /// The same driver's in the scenario that tuning kept, where that is another one.
    pub recorded_tuned: Option<Ran>,
    /// What a model finds that holds the recorded driver's run against the report, where one is cast.
    pub review: Option<Reviewed>,
    /// As designed.
    pub first: Option<Ran>,
    /// As tuned.
    pub tuned: Option<Tuned>,
    /// How the other egos fare where the system under test fails at last.
    pub triage: Option<Triage>,
    /// The reference driver's run there.
    pub reference: Option<JudgedRun>,
    /// Why it went no further, where it did not.
    pub failure: Option<Failure>,
    /// Files that a person edited.
    pub edited: Vec<String>,
}

/// A scenario and its run.
pub(super) struct Ran {
    /// What was run.
    pub scenario: Scenario,
    /// What came of it.
    pub run: JudgedRun,
}

/// A tuned scenario.
pub(super) struct Tuned {
    /// It, and its run.
    pub ran: Ran,
    /// Log of the search.
    pub log: TuneLog,
    /// Who tuned it.
    pub agent: AgentLog,
}

impl Tuned {
    /// Whether tuning kept another scenario, or a person may have made one of it.
    pub fn is_another(&self, edited: &[String]) -> bool {
        self.log.best != 0 || !edited.is_empty()
    }
}

impl<'a> Case<'a> {
    /// Reads all that there is of a case.
    pub fn read(suite: &Suite, cases: &Cases, cluster: &'a Cluster) -> Result<Self, PipelineError> {
        let id = &cluster.scenario_id;
        let by_account = cases.accounts.is_some();
        let made = Made { suite, id, by_account };
        let edited = edited_files(suite, id);
        let narrative = made.narrative(cluster)?;
        let design = made.log(Stage::Design, &names::design_log(id))?;
        let recorded = made.recorded()?;
        let review = optional(suite, &names::review(id), made.whole(Stage::Review) && recorded.is_some())?;
        let first = made.run(Stage::Simulate, names::scenario(id), names::first_run(id))?;
        let tuned = made.tuned()?;
        let recorded_tuned = match &tuned {
            Some(tuned) if by_account && tuned.is_another(&edited) => {
                made.run(Stage::Triage, names::tuned(id), names::tuned_recorded_run(id))?
            }
            _ => None,
        };
        let triage = optional(suite, &names::triage(id), tuned.is_some())?;
        let reference = optional(suite, &names::reference_run(id), triage.is_some())?;
        Ok(Self {
            cluster,
            narrative,
            design,
            account: account_row(cases, cluster),
            recorded,
            recorded_tuned,
            review,
            first,
            tuned,
            triage,
            reference,
            failure: failures::before(suite, id, Stage::Report),
            edited,
        })
    }
}

/// What the record of a case says as an account, where its crash is one that is told.
fn account_row(cases: &Cases, cluster: &Cluster) -> Option<AccountRow> {
    let reading = cases.records.records[cluster.pick_index].reading.as_ref().filter(|_| !cluster.invented)?;
    Some(AccountRow {
        incident: reading.incident.clone(),
        reports: reading.reports,
        crash_type: reading.crash_type,
        role: reading.role,
        driver: reading.driver,
    })
}

/// The files of one case.
struct Made<'a> {
    suite: &'a Suite,
    id: &'a str,
    by_account: bool,
}

impl Made<'_> {
    /// Whether a stage came to its end, and those before it.
    fn whole(&self, stage: Stage) -> bool {
        failures::before(self.suite, self.id, stage).is_none() && failures::at(self.suite, self.id, stage).is_none()
    }

    /// What a stage wrote of how it went.
    fn log<T: DeserializeOwned>(&self, stage: Stage, file: &str) -> Result<Option<T>, PipelineError> {
        self.whole(stage).then(|| self.suite.store().read_json(file)).transpose()
    }

    /// A run of a stage. Who was parked is not tested: those runs are not there.
    fn run(&self, stage: Stage, scenario: String, run: String) -> Result<Option<Ran>, PipelineError> {
        let there = self.whole(stage) && (!self.by_account || self.suite.store().stamp(&run).is_some());
        there.then(|| ran(self.suite, self.id, &scenario, &run)).transpose()
    }

    /// The narrative, or what the account tells, and who wrote it.
    fn narrative(&self, cluster: &Cluster) -> Result<Option<(Narrative, AgentLog)>, PipelineError> {
        let (suite, id) = (self.suite, self.id);
        let log = self.log(Stage::Narrate, &names::narrative_log(id))?;
        let narrative = match self.by_account {
            true => Some(retold::account(suite, id).map(|account| tell(&account, id, cluster.template))),
            false => self.whole(Stage::Narrate).then(|| suite.store().read_json(&names::narrative(id))),
        };
        // What a person spoiled stops its case at its design, and tells nothing.
        let narrative = match narrative {
            Some(Err(_)) if !self.whole(Stage::Design) => None,
            read => read.transpose()?,
        };
        Ok(narrative.zip(log))
    }

    /// The recorded driver's run of the scenario as designed.
    fn recorded(&self) -> Result<Option<Ran>, PipelineError> {
        if !self.by_account {
            return Ok(None);
        }
        self.run(Stage::Simulate, names::scenario(self.id), names::recorded_run(self.id))
    }

    /// The tuned scenario with its run, and how it was found.
    fn tuned(&self) -> Result<Option<Tuned>, PipelineError> {
        let Some(ran) = self.run(Stage::Triage, names::tuned(self.id), names::tuned_run(self.id))? else {
            return Ok(None);
        };
        let store = self.suite.store();
        let log = store.read_json(&names::tune_log(self.id))?;
        Ok(Some(Tuned { ran, log, agent: store.read_json(&names::tune_agent(self.id))? }))
    }
}

/// Reads a file that not every unit writes; a stage removes what an earlier run left.
fn optional<T: DeserializeOwned>(suite: &Suite, file: &str, wanted: bool) -> Result<Option<T>, PipelineError> {
    let there = wanted && suite.store().stamp(file).is_some();
    there.then(|| suite.store().read_json(file)).transpose()
}

fn ran(suite: &Suite, id: &str, file: &str, run: &str) -> Result<Ran, PipelineError> {
    Ok(Ran { scenario: cases::scenario(suite, id, file)?, run: suite.store().read_json(run)? })
}
