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
    /// The recorded driver's run, in a suite that goes by accounts.
    pub recorded: Option<Ran>,
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

impl<'a> Case<'a> {
    /// Reads all that there is of a case.
    pub fn read(suite: &Suite, cases: &Cases, cluster: &'a Cluster) -> Result<Self, PipelineError> {
        let id = &cluster.scenario_id;
        let store = suite.store();
        let failure = failures::before(suite, id, Stage::Report);
        let made =
            |stage: Stage| failures::before(suite, id, stage).is_none() && failures::at(suite, id, stage).is_none();
        let by_account = cases.accounts.is_some();
        let log = made(Stage::Narrate).then(|| store.read_json(&names::narrative_log(id))).transpose()?;
        let narrative = match by_account {
            true => Some(retold::account(suite, id).map(|account| tell(&account, id, cluster.template))),
            false => made(Stage::Narrate).then(|| store.read_json(&names::narrative(id))),
        };
        // What a person spoiled stops its case at its design, and tells nothing.
        let narrative = match narrative {
            Some(Err(_)) if !made(Stage::Design) => None,
            read => read.transpose()?,
        };
        let narrative = narrative.zip(log);
        let reading = cases.records.records[cluster.pick_index].reading.as_ref().filter(|_| !cluster.invented);
        let account = reading.map(|reading| AccountRow {
            incident: reading.incident.clone(),
            reports: reading.reports,
            crash_type: reading.crash_type,
            role: reading.role,
            driver: reading.driver,
        });
        let edited = edited_files(suite, id);
        let design = made(Stage::Design).then(|| store.read_json(&names::design_log(id))).transpose()?;
        // Who was parked is not tested: those runs are not there.
        let run = |stage: Stage, scenario: String, run: String| -> Result<Option<Ran>, PipelineError> {
            let there = made(stage) && (!by_account || store.stamp(&run).is_some());
            there.then(|| ran(suite, id, &scenario, &run)).transpose()
        };
        let recorded = match by_account {
            true => run(Stage::Simulate, names::scenario(id), names::recorded_run(id))?,
            false => None,
        };
        let review = optional(suite, &names::review(id), made(Stage::Review) && recorded.is_some())?;
        let first = run(Stage::Simulate, names::scenario(id), names::first_run(id))?;
        let tuned = match run(Stage::Triage, names::tuned(id), names::tuned_run(id))? {
            None => None,
            Some(ran) => Some(Tuned {
                ran,
                log: store.read_json(&names::tune_log(id))?,
                agent: store.read_json(&names::tune_agent(id))?,
            }),
        };
        // Beside a tuned run belongs how the recorded driver fares in the tuned scenario.
        let recorded = match &tuned {
            Some(Tuned { log, .. }) if by_account && (log.best != 0 || !edited.is_empty()) => {
                run(Stage::Triage, names::tuned(id), names::tuned_recorded_run(id))?
            }
            _ => recorded,
        };
        let triage = optional(suite, &names::triage(id), tuned.is_some())?;
        let reference = optional(suite, &names::reference_run(id), triage.is_some())?;
        Ok(Self {
            cluster,
            narrative,
            design,
            account,
            recorded,
            review,
            first,
            tuned,
            triage,
            reference,
            failure,
            edited,
        })
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
