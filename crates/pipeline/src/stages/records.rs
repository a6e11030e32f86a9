//! The first stage: crash files to records.

use super::second_reading::{SecondReading, read_again};
use super::second_staging::{SecondStaging, stage_again};
use super::{StageReport, StageWork, cases, own, player};
use crate::error::PipelineError;
use crate::files::json::{to_compact_json, to_json};
use crate::models::cast::{AgentLog, Reads};
use crate::reading::outcomes::Outcomes;
use crate::reading::records::RecordInput;
use crate::reading::retelling::{Second, StageAgain, Unread, Unstaged, tell};
use crate::suite::Suite;
use crate::suite::names;
use recrash_model::account::{Account, AccountSet, CrashType};
use recrash_model::diagnostic::{Location, Severity};
use recrash_model::profile::Tells;
use recrash_model::record::RecordSet;
use recrash_model::template::{Movement, RoadType};
use recrash_model::{Diagnostic, Outcome};
use std::collections::{BTreeMap, BTreeSet};

/// Runs the stage.
pub(super) fn run(work: &StageWork) -> Result<StageReport, PipelineError> {
    let suite = work.suite;
    let input = RecordInput::read(suite.options())?;
    let mut before: Option<AccountSet> = None;
    let mut report = work.whole(&inputs(suite, &input), || {
        before = serde_json::from_slice(&suite.store().read_or_empty(names::ACCOUNTS)).ok();
        let profile = suite.profile();
        if profile.records.tells == Tells::Templates {
            let Outcome { mut value, mut diagnostics } = input.ingest(profile)?;
            let copies = own::find_untold(&mut value, profile);
            diagnostics.push(what_is_told(&value, copies));
            return Ok(vec![
                (names::RECORDS.into(), to_compact_json(&value)),
                (names::RECORD_REMARKS.into(), to_json(&diagnostics)),
            ]);
        }
        let (Outcome { value, diagnostics }, filter) = input.ingest_all(profile)?;
        // Models are asked from here on, and what they say is kept in the folder.
        suite.save()?;
        let mut logs = BTreeMap::new();
        let mut again = |unread: &[Unread], all: usize| {
            let SecondReading { accounts, logs: told } = read_again(suite, unread, all, work.progress)?;
            logs = told;
            Ok(accounts)
        };
        let mut stagings = BTreeMap::new();
        let mut stage = |unstaged: &[Unstaged]| {
            let SecondStaging { made, logs: told } = stage_again(suite, unstaged, work.progress)?;
            stagings = told;
            Ok(made)
        };
        let stage_again: Option<&mut StageAgain> = suite.options().stager().is_some().then_some(&mut stage);
        let second = Second { reads: suite.options().cast.reads, read_again: &mut again, stage_again };
        let outcomes = Outcomes::open(suite.store())?;
        let (told, accounts) = tell(value, filter.as_ref(), work.progress, second, suite.stagings(), outcomes)?;
        take_back(&mut logs, &accounts);
        Ok(vec![
            (names::ACCOUNT_READERS.into(), to_json(&logs)),
            (names::STAGED_AGAIN.into(), to_compact_json(&stagings)),
            (names::RECORDS.into(), to_compact_json(&told)),
            (names::RECORD_REMARKS.into(), to_json(&diagnostics)),
            (names::ACCOUNTS.into(), to_compact_json(&accounts)),
        ])
    })?;
    report.diagnostics = suite.store().read_json(names::RECORD_REMARKS)?;
    if let (Some(before), Tells::Accounts) = (before, suite.profile().records.tells) {
        report.diagnostics.extend(what_is_new(&before, &suite.store().read_json(names::ACCOUNTS)?));
    }
    Ok(report)
}

/// A model's account that is not the one in the end has been read by the reader: the crash is not shown as it tells, and nobody staged it.
fn take_back(readers: &mut BTreeMap<String, AgentLog>, accounts: &AccountSet) {
    let by_rules = |account: &Account| account.author.is_rules().then(|| account.incident.clone());
    let all = accounts.told.iter().chain(accounts.untold.iter().map(|untold| &untold.account));
    let by_rules: BTreeSet<String> = all.filter_map(by_rules).collect();
    let is_taken_back =
        |(incident, log): &(&String, &mut AgentLog)| !log.author.is_rules() && by_rules.contains(*incident);
    for (_, log) in readers.iter_mut().filter(is_taken_back) {
        let why = format!("the rules do not show the crash as {} reads it, and no model stages it", log.asked);
        *log = AgentLog::fallback(&log.asked, log.repairs, why);
    }
}

/// What came in since the last run of this suite: incidents by crash type, and which roads and movements nobody had seen.
fn what_is_new(before: &AccountSet, now: &AccountSet) -> Option<Diagnostic> {
    let known: BTreeSet<&str> = before.all().map(|(incident, _)| incident).collect();
    let mut by_type: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, crash_type) in now.all().filter(|(incident, _)| !known.contains(incident)) {
        *by_type.entry(crash_type.map_or("type not told", CrashType::label)).or_default() += 1;
    }
    if by_type.is_empty() {
        return None;
    }
    let all: usize = by_type.values().sum();
    let types: Vec<String> = by_type.iter().map(|(name, count)| format!("{count} {name}")).collect();
    let triple = |account: &Account| {
        let template = account.template();
        (template.road, template.sv, template.cp)
    };
    let seen: BTreeSet<_> = before.told.iter().map(triple).collect();
    let unseen: BTreeSet<_> = now.told.iter().map(triple).filter(|of| !seen.contains(of)).collect();
    let shown = |(road, sv, cp): &(RoadType, Movement, Movement)| {
        format!("{}, SV {}, CP {}", road.label(), sv.label(), cp.label()).to_lowercase()
    };
    let triples = match unseen.len() {
        0 => "every road and pair of movements of theirs was seen before".to_owned(),
        count => {
            let list: Vec<String> = unseen.iter().take(TRIPLES_SHOWN).map(shown).collect();
            let more = if count > list.len() { format!("; and {} more", count - list.len()) } else { String::new() };
            format!("{count} roads and pairs of movements were never seen before: {}{more}", list.join("; "))
        }
    };
    let message = format!("{all} readable incidents are new: {}; {triples}", types.join(", "));
    Some(Diagnostic::new(Severity::Note, "records.new", Location::default(), message))
}

/// How many of the usable records of a suite of templates are told as their own crash; `copies` by another record of their incident.
fn what_is_told(set: &RecordSet, copies: usize) -> Diagnostic {
    let message = format!(
        "{} of {} usable records are told as their own crash, {copies} more by another record of their incident, and {} cannot be",
        set.usable.len() - set.untold.len(),
        set.usable.len(),
        set.untold.len() - copies
    );
    Diagnostic::new(Severity::Note, "records.told", Location::default(), message)
}

/// Roads and movements that are named.
const TRIPLES_SHOWN: usize = 20;

/// What decides which records come out.
pub(super) fn inputs(suite: &Suite, input: &RecordInput) -> Vec<String> {
    let by_accounts = suite.profile().records.tells == Tells::Accounts;
    let cast = &suite.options().cast;
    let reader = by_accounts.then(|| player(suite, &cast.paraphrase));
    // The rules stage what the reader makes of it; a model what they do not show as told.
    let stager = suite.options().stager().filter(|_| by_accounts).map(|name| player(suite, name));
    let reads = (by_accounts && cast.reads == Reads::All).then(|| "all".to_owned());
    std::iter::once(cases::text_of(suite.profile()))
        .chain(reader)
        .chain(reads)
        .chain(stager)
        .chain(input.parts())
        .collect()
}
