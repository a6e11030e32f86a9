//! The cases of a suite: what the stages after selection share.

use super::design_log::DesignLog;
use super::failures;
use crate::error::PipelineError;
use crate::models::cast::AgentLog;
use crate::reading::scenarios::read_scenario;
use crate::suite::names;
use crate::suite::{Stage, Suite};
use recrash_agents::{Brief, expectation};
use recrash_model::Seed;
use recrash_model::account::{Account, AccountSet};
use recrash_model::metrics::Expectation;
use recrash_model::narrative::Narrative;
use recrash_model::profile::Tells;
use recrash_model::record::{CrashRecord, Provenance, RecordRef, RecordSet};
use recrash_model::selection::{Cluster, Selection};
use recrash_model::template::Template;
use recrash_roads::Scenario;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Records and picks.
pub(crate) struct Cases {
    /// All records.
    pub records: RecordSet,
    /// Which were picked.
    pub selection: Selection,
    /// Accounts, in a suite that goes by them.
    pub accounts: Option<AccountSet>,
    /// Who was asked to read which incident again.
    pub readers: BTreeMap<String, AgentLog>,
    /// How a model staged which incident, of those that the rules do not show as told.
    pub stagings: BTreeMap<String, DesignLog>,
    /// Where records stand, by report and by incident, and told accounts by report.
    reports: BTreeMap<String, Vec<usize>>,
    incidents: BTreeMap<String, Vec<usize>>,
    told: BTreeMap<String, Vec<usize>>,
}

/// Where everything stands, by a key that some have.
fn places<'a, T: 'a>(all: &'a [T], key: impl Fn(&'a T) -> Option<&'a String>) -> BTreeMap<String, Vec<usize>> {
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (at, one) in all.iter().enumerate() {
        if let Some(key) = key(one) {
            places.entry(key.clone()).or_default().push(at);
        }
    }
    places
}

impl Cases {
    pub fn read(suite: &Suite) -> Result<Self, PipelineError> {
        suite.output_hash(Stage::Records, Stage::Records.name(), names::RECORDS)?;
        suite.output_hash(Stage::Select, Stage::Select.name(), names::SELECTION)?;
        let records: RecordSet = suite.store().read_json(names::RECORDS)?;
        let selection: Selection = suite.store().read_json(names::SELECTION)?;
        let bound = records.records.len();
        let named = |c: &Cluster| c.pick_index < bound && records.records[c.pick_index].id == c.pick;
        if selection.clusters.iter().any(|c| !named(c) || c.members.iter().any(|&m| m >= bound)) {
            return Err(suite.stale(Stage::Select));
        }
        let (accounts, readers): (Option<AccountSet>, _) = match suite.profile().records.tells {
            Tells::Templates => (None, BTreeMap::new()),
            Tells::Accounts => {
                (Some(suite.store().read_json(names::ACCOUNTS)?), suite.store().read_json(names::ACCOUNT_READERS)?)
            }
        };
        let is_staged = suite.options().stager().is_some() && accounts.is_some();
        let stagings = if is_staged { stagings(suite)? } else { BTreeMap::new() };
        let reports = places(&records.records, |record| Some(&record.id.report_id));
        let incidents = places(&records.records, |record| record.incident_id.as_ref());
        let told = accounts.as_ref().map(|set| places(&set.told, |account| Some(&account.report.report_id)));
        Ok(Self { reports, incidents, told: told.unwrap_or_default(), records, selection, accounts, readers, stagings })
    }

    /// How a model staged the crash of this account, where the rules do not show it as told.
    pub fn staged_again(&self, account: &Account) -> Option<&DesignLog> {
        let log = self.stagings.get(&account.incident)?;
        let told = &self.accounts.as_ref()?.told;
        let is_of = |at: &&usize| told[**at] == *account;
        let at = self.told.get(&account.report.report_id)?.iter().find(is_of);
        at.map(|_| log).filter(|log| log.gave_up.is_empty())
    }

    /// The account of a cluster's pick, in a suite that goes by accounts.
    pub fn account(&self, cluster: &Cluster) -> Option<&Account> {
        let told = &self.accounts.as_ref()?.told;
        let mut accounts = self.told.get(&cluster.pick.report_id)?.iter().map(|&at| &told[at]);
        // Two reports may share an id; their incidents do not.
        let reading = self.records.records[cluster.pick_index].reading.as_ref();
        let is_its = |account: &&Account| reading.is_none_or(|reading| reading.incident == account.incident);
        accounts.find(|account| account.report == cluster.pick && is_its(account)).filter(|_| !cluster.invented)
    }

    /// Where the records of a case stand: the pick first, then the other reports of its incident; none of a template without records.
    pub fn shown(&self, cluster: &Cluster) -> Vec<usize> {
        if cluster.invented {
            return Vec::new();
        }
        let records = &self.records.records;
        let pick = &records[cluster.pick_index];
        let of_report = self.reports.get(&pick.id.report_id);
        let of_incident = pick.incident_id.as_ref().and_then(|incident| self.incidents.get(incident));
        let same: BTreeSet<usize> = of_report.into_iter().chain(of_incident).flatten().copied().collect();
        let others = same.into_iter().filter(|&at| at != cluster.pick_index);
        std::iter::once(cluster.pick_index).chain(others).collect()
    }

    /// Those records.
    pub fn records_of(&self, cluster: &Cluster) -> Vec<&CrashRecord> {
        self.shown(cluster).into_iter().map(|index| &self.records.records[index]).collect()
    }

    /// What the built-in reader makes of these records of one incident.
    pub fn read_by_rules(records: &[&CrashRecord]) -> Option<Account> {
        let records: Vec<CrashRecord> = records.iter().copied().cloned().collect();
        let incidents = recrash_reader::incidents(&records);
        incidents.iter().find_map(recrash_reader::account)
    }

    /// The clusters that no stage before this one failed on.
    pub fn up_to(&self, suite: &Suite, stage: Stage) -> Vec<&Cluster> {
        let whole = |cluster: &&Cluster| failures::before(suite, &cluster.scenario_id, stage).is_none();
        self.selection.clusters.iter().filter(whole).collect()
    }

    /// What decides about a case: its template and these of its records, without where in the files they stand.
    pub fn inputs(&self, cluster: &Cluster, records: &[&CrashRecord]) -> Vec<String> {
        #[derive(Serialize)]
        struct Own<'a> {
            scenario_id: &'a str,
            template: Template,
        }
        let own = Own { scenario_id: &cluster.scenario_id, template: cluster.template };
        let mut inputs = vec![text_of(&own)];
        for &record in records {
            let nowhere = Provenance { file: String::new(), row: 0, ..record.provenance.clone() };
            inputs.push(text_of(&CrashRecord { provenance: nowhere, ..record.clone() }));
        }
        let account = self.account(cluster);
        inputs.extend(account.map(text_of));
        inputs.extend(account.and_then(|account| self.staged_again(account)).map(text_of));
        inputs.extend(self.untold(cluster).map(str::to_owned));
        inputs
    }

    /// What an agent is told about a case. A model is shown all of its records, the rules read the pick.
    pub fn brief<'a>(
        &'a self,
        suite: &'a Suite,
        cluster: &'a Cluster,
        records: &'a [&'a CrashRecord],
        account: Option<&'a Account>,
    ) -> Brief<'a> {
        Brief {
            scenario_id: &cluster.scenario_id,
            template: cluster.template,
            records,
            untold: self.untold(cluster),
            profile: suite.profile(),
            account,
            seed: case_seed(suite, cluster),
        }
    }

    /// Why the pick's own crash is not told, where it is not.
    fn untold(&self, cluster: &Cluster) -> Option<&str> {
        if cluster.invented {
            return Some("no record is of this template");
        }
        self.records.untold.get(&cluster.pick_index).map(String::as_str)
    }

    /// The record whose crash a narrative tells; of an invented one the pick.
    fn told<'a>(&'a self, cluster: &Cluster, narrative: &Narrative) -> &'a CrashRecord {
        let named = |id: &RecordRef| self.records_of(cluster).into_iter().find(|record| record.id == *id);
        narrative.told_record().and_then(named).unwrap_or(&self.records.records[cluster.pick_index])
    }

    /// A case's narrative, and what a rollout must show to be true to it.
    pub fn expectation(&self, suite: &Suite, cluster: &Cluster) -> Result<(Narrative, Expectation), PipelineError> {
        let id = &cluster.scenario_id;
        let narrative: Narrative = suite.store().read_json(&names::narrative(id)).map_err(|e| of_case(id, e))?;
        let expectation = expectation(&narrative, self.told(cluster, &narrative), suite.profile());
        Ok((narrative, expectation))
    }
}

/// How a model staged what the rules do not show as told.
fn stagings(suite: &Suite) -> Result<BTreeMap<String, DesignLog>, PipelineError> {
    // A suite of before has none, and one that somebody changed is no good.
    suite.output_hash(Stage::Records, Stage::Records.name(), names::STAGED_AGAIN)?;
    let logs: BTreeMap<String, DesignLog> = suite.store().read_json(names::STAGED_AGAIN)?;
    match logs.values().all(|log| log.taken < log.attempts.len()) {
        true => Ok(logs),
        false => Err(suite.stale(Stage::Records)),
    }
}

/// JSON of what decides about a unit.
pub(crate) fn text_of<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).expect("nouns serialise")
}

/// Seed of a case's random choices.
pub(crate) fn case_seed(suite: &Suite, cluster: &Cluster) -> Seed {
    suite.seed().child("case").child(&cluster.scenario_id)
}

/// Reads and checks a scenario file of the suite; one that a person spoiled stops its case alone.
pub(crate) fn scenario(suite: &Suite, id: &str, file: &str) -> Result<Scenario, PipelineError> {
    suite.store().must_be_a_file(file)?;
    read_scenario(&suite.store().path(file)).map(|(scenario, _)| scenario).map_err(|error| of_case(id, error))
}

/// What is wrong with a file that a person may have edited: where first, then what was probably meant. The edit is theirs, and stays.
pub(super) fn edited(error: PipelineError) -> PipelineError {
    let PipelineError::Damaged { path, problem } = error else { return error };
    let (problem, place) = problem.rsplit_once(" at line ").unwrap_or((&problem, ""));
    let line = place.split(' ').next().filter(|line| !line.is_empty());
    let line = line.map_or_else(String::new, |line| format!("line {line}, "));
    let told = match problem.split_once("unknown variant `") {
        Some((before, rest)) => {
            let (found, known) = rest.split_once("`, expected ").unwrap_or((rest, ""));
            let known: Vec<&str> = known.split('`').skip(1).step_by(2).collect();
            format!("{before}there is no word `{found}` here; {}", meant(found, &known))
        }
        None => problem.to_owned(),
    };
    PipelineError::bad_input(format!(
        "{}: {line}{told}: correct it, or discard edits (discard-edits) to have it made anew",
        path.display()
    ))
}

/// The words that were probably meant, or what there is.
fn meant(found: &str, known: &[&str]) -> String {
    const LISTED: usize = 8;
    let mut near: Vec<&str> =
        known.iter().copied().filter(|word| word.contains(found) || found.contains(word)).collect();
    near.extend(recrash_roads::nearest(found, known).filter(|word| !near.contains(word)));
    if near.is_empty() {
        let more = known.len().saturating_sub(LISTED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        return format!("there are {}{more}", known[..known.len().min(LISTED)].join(", "));
    }
    format!("did you mean {}?", near[..near.len().min(LISTED)].join(", "))
}

/// What one case's file is no good for stops that case and no other.
pub(super) fn of_case(id: &str, error: PipelineError) -> PipelineError {
    match error {
        PipelineError::BadInput { what, diagnostics } => {
            let told: Vec<String> = std::iter::once(what).chain(diagnostics.iter().map(ToString::to_string)).collect();
            PipelineError::scenario(id, told.join("; "))
        }
        PipelineError::Damaged { .. } => PipelineError::scenario(id, error),
        other => other,
    }
}
