//! Accounts retold: a reconstruction each, and what becomes of every incident of crash files.

use crate::error::PipelineError;
use crate::files::json::to_compact_json;
use crate::files::store::sha256;
use crate::models::cast::Reads;
use crate::progress::{Progress, ProgressEvent};
use crate::reading::accounts::told_facts;
use crate::reading::records;
use rayon::prelude::*;
use recrash_model::account::{
    ACCOUNTS_FORMAT, Account, AccountSet, CrashType, FactShare, TypeShare, Untold, UntoldIncident, told,
};
use recrash_model::incident::Incident;
use recrash_model::metrics::{Answer, Check, CheckKind, CheckResult};
use recrash_model::record::{CrashRecord, FunnelStep, Reading, RecordSet, Redaction, Reject, RejectReason};
use recrash_model::scenario::ScenarioDraft;
use recrash_reconstruct::{Reconstruction, reconstruct, told_kinds};
use recrash_records::Filter;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Reconstructions of told accounts, from the stage that finds them to the one that writes them: an account is staged once a run. One that
/// is not here, since it was edited or comes from an earlier run, is staged again, and comes out as it did.
#[derive(Default)]
pub(crate) struct Stagings(Mutex<BTreeMap<String, Staged>>);

/// The scenario of an account, and what was assumed for it.
pub(crate) struct Staged {
    pub draft: ScenarioDraft,
    pub assumed: Vec<String>,
}

impl Stagings {
    fn keep(&self, account: &Account, made: &Reconstruction) {
        let staged = Staged { draft: made.draft.clone(), assumed: made.assumed.clone() };
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key(account), staged);
    }

    /// That of this very account.
    pub fn take(&self, account: &Account) -> Option<Staged> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&key(account))
    }
}

fn key(account: &Account) -> String {
    sha256(&to_compact_json(account))
}

/// Name of the work in progress bars.
const STAGE: &str = "reconstruct";

/// What became of one account.
pub struct Retold {
    /// Position in the list of accounts.
    pub account: usize,
    /// Its scenario, or why there is none.
    pub result: Result<Reconstruction, Untold>,
}

impl Retold {
    /// Why its crash is not told; nothing where no told fact is shown otherwise, and all that the two did is.
    pub fn untold(&self) -> Option<Untold> {
        match &self.result {
            Ok(made) => made.missed().map(|_| Untold::NotShown),
            Err(why) => Some(*why),
        }
    }

    /// Whether every told fact is checked, and shown.
    pub fn is_whole(&self) -> bool {
        self.result.as_ref().is_ok_and(|made| made.verdict.faithful() == Answer::Yes)
    }

    /// The same, with the fact that is not shown.
    pub fn reason(&self) -> Option<String> {
        match &self.result {
            Ok(made) => Some(what_is_missed(made.missed()?)),
            Err(reason) => Some(reason.label().to_owned()),
        }
    }
}

/// Why the crash of an account is not told by its reconstruction; nothing where it is, or where it need not be yet and there is one.
pub(crate) fn why_untold(account: &Account, is_staged_again: bool) -> Option<String> {
    let retold = Retold { account: 0, result: reconstruct(account) };
    if is_staged_again && retold.result.is_ok() { None } else { retold.reason() }
}

/// A told fact that is missed, and what is seen in its place.
pub(crate) fn what_is_missed(missed: &Check) -> String {
    let what = missed.kind.label();
    match missed.result {
        CheckResult::CannotBeShown => format!("{what} is not drawn: {}", missed.observed),
        _ => format!("{what} is not shown: {}, not {}", missed.observed, missed.expected),
    }
}

/// Reconstructs every account, on all threads, in the order given.
pub fn reconstruct_accounts(accounts: &[Account], progress: &dyn Progress) -> Vec<Retold> {
    progress.event(ProgressEvent::Started { stage: STAGE, units: accounts.len() });
    let retell = |(position, account): (usize, &Account)| {
        let retold = Retold { account: position, result: reconstruct(account) };
        progress.event(ProgressEvent::Advanced { stage: STAGE, unit: &account.incident, skipped: false });
        retold
    };
    let all = accounts.par_iter().enumerate().map(retell).collect();
    progress.event(ProgressEvent::Finished { stage: STAGE });
    all
}

/// The share of told facts that are shown, by kind, over all accounts.
pub fn fact_shares(accounts: &[Account], retold: &[Retold]) -> Vec<FactShare> {
    let told_by: Vec<Vec<CheckKind>> = accounts.par_iter().map(told_kinds).collect();
    let share = |fact: CheckKind| {
        let tells = |each: &&Retold| told_by[each.account].contains(&fact);
        let of = |result: CheckResult| {
            let holds = |each: &&Retold| {
                let checks = each.result.as_ref().map_or(&[][..], |made| &made.verdict.checks);
                checks.iter().any(|check| check.kind == fact && check.result == result)
            };
            retold.iter().filter(tells).filter(holds).count()
        };
        let (shown, not_drawn) = (of(CheckResult::Shown), of(CheckResult::CannotBeShown));
        FactShare { fact, told: retold.iter().filter(tells).count(), shown, not_drawn }
    };
    CheckKind::OF_ACCOUNTS.into_iter().map(share).collect()
}

/// How much of every type that occurs is told.
pub fn type_shares(accounts: &[Account], retold: &[Retold]) -> Vec<TypeShare> {
    let facts: Vec<usize> = accounts.par_iter().map(|account| told_facts(account).len()).collect();
    let share = |crash_type: Option<CrashType>| {
        let of: Vec<&Retold> =
            retold.iter().filter(|each| told(&accounts[each.account].crash_type) == crash_type).collect();
        let words: usize = of.iter().map(|each| accounts[each.account].words as usize).sum();
        let facts: usize = of.iter().map(|each| facts[each.account]).sum();
        TypeShare {
            crash_type,
            incidents: of.len(),
            told: of.iter().filter(|each| each.untold().is_none()).count(),
            whole: of.iter().filter(|each| each.is_whole()).count(),
            facts_per_100_words: 100.0 * facts as f64 / words.max(1) as f64,
        }
    };
    let all = CrashType::ALL.into_iter().map(Some).chain([None]).map(share);
    all.filter(|share| share.incidents > 0).collect()
}

/// Where a record stands: file, row and narrative tell it apart from every other.
type Place<'a> = (&'a str, u64);

fn place(record: &CrashRecord) -> Place<'_> {
    (&record.provenance.file, record.provenance.row)
}

/// An incident that somebody else is to read, and what the built-in reader made of it.
pub(crate) struct Unread<'a> {
    /// Its reports.
    pub incident: &'a Incident,
    /// The account so far.
    pub account: &'a Account,
}

/// Whether an account lacks what a crash is told by, or says what cannot have been.
fn is_incomplete(account: &Account, retold: &Retold) -> bool {
    let lacks = account.crash_type.is_none() || account.striker.is_none() || account.came_from.is_none();
    lacks
        || matches!(
            retold.untold(),
            Some(Untold::NoAccount | Untold::OthersOnly | Untold::NoContact | Untold::NotShown)
        )
}

/// An incident whose crash is staged, and not as it is told.
pub(crate) struct Unstaged<'a> {
    /// Its reports.
    pub incident: &'a Incident,
    /// Its account.
    pub account: &'a Account,
    /// What there is of it.
    pub made: &'a Reconstruction,
}

/// Accounts that somebody else made of these incidents, of so many; none where nobody is asked.
pub(crate) type ReadAgain<'a> = dyn FnMut(&[Unread], usize) -> Result<Vec<Option<Account>>, PipelineError> + 'a;

/// Reconstructions of these incidents by somebody else that miss no told fact.
pub(crate) type StageAgain<'a> = dyn FnMut(&[Unstaged]) -> Result<Vec<Option<Reconstruction>>, PipelineError> + 'a;

/// Who else is asked.
pub(crate) struct Second<'a> {
    /// Which incidents are read again.
    pub reads: Reads,
    /// Reads them.
    pub read_again: &'a mut ReadAgain<'a>,
    /// Stages what the rules do not show as told, where somebody does.
    pub stage_again: Option<&'a mut StageAgain<'a>>,
}

/// Takes the accounts that somebody else made: where the crash is told by it, or can be staged by whom `stage_again` asks. Who is not
/// staged then is left as it was.
///
/// # Errors
/// Those of `stage_again`.
fn take_again(
    (accounts, retold): (&mut [Account], &mut [Retold]),
    again: Vec<(usize, Account)>,
    incidents: &BTreeMap<&str, &Incident>,
    stage_again: Option<&mut StageAgain>,
) -> Result<(), PipelineError> {
    let mut before: BTreeMap<usize, (Account, Retold)> = BTreeMap::new();
    for (at, account) in again {
        let other = Retold { account: at, result: reconstruct(&account) };
        let is_told = other.untold().is_none();
        if is_told || stage_again.is_some() && other.result.is_ok() {
            let old = (std::mem::replace(&mut accounts[at], account), std::mem::replace(&mut retold[at], other));
            before.extend((!is_told).then_some((at, old)));
        }
    }
    let Some(stage_again) = stage_again else { return Ok(()) };
    let is_unstaged = |each: &&Retold| each.untold() == Some(Untold::NotShown);
    let asked = retold.iter().filter(is_unstaged).filter_map(|each| {
        let account = &accounts[each.account];
        let incident = incidents[account.incident.as_str()];
        Some(Unstaged { incident, account, made: each.result.as_ref().ok()? })
    });
    let asked: Vec<Unstaged> = asked.collect();
    let staged = stage_again(&asked)?;
    let at: Vec<usize> = retold.iter().filter(is_unstaged).map(|each| each.account).collect();
    for (at, made) in at.into_iter().zip(staged) {
        match made {
            Some(made) => retold[at].result = Ok(made),
            None => {
                if let Some(old) = before.remove(&at) {
                    (accounts[at], retold[at]) = old;
                }
            }
        }
    }
    Ok(())
}

/// Groups reports into incidents, reads and reconstructs each, and leaves those usable whose every told fact is shown: the
/// report that speaks stands for its incident. What is not read whole, or all, is read by somebody else where there is one; that account is
/// taken where the crash is told by it. Scenarios of what the rules tell go to `stagings`.
///
/// # Errors
/// Those of `second`.
pub(crate) fn tell(
    mut set: RecordSet,
    filter: Option<&Filter>,
    progress: &dyn Progress,
    second: Second,
    stagings: &Stagings,
) -> Result<(RecordSet, AccountSet), PipelineError> {
    let incidents = records::incidents(&set);
    let leading: BTreeMap<Place, &Incident> =
        incidents.iter().filter_map(|incident| Some((place(&incident.leading()?.record), incident))).collect();
    let kept = |incident: &&Incident| {
        incident.leading().is_some_and(|report| filter.is_none_or(|filter| filter.keeps(&report.record)))
    };
    let read: Vec<&Incident> = incidents.iter().filter(kept).collect();
    let mut accounts: Vec<Account> = read.par_iter().filter_map(|incident| recrash_reader::account(incident)).collect();
    let mut retold = reconstruct_accounts(&accounts, progress);
    let is_asked = |at: &usize| second.reads == Reads::All || is_incomplete(&accounts[*at], &retold[*at]);
    let unread: Vec<usize> = (0..accounts.len()).filter(is_asked).collect();
    let of_id: BTreeMap<&str, &Incident> = read.iter().map(|&incident| (incident.id.as_str(), incident)).collect();
    let incident = |account: &Account| of_id[account.incident.as_str()];
    let asked: Vec<Unread> =
        unread.iter().map(|&at| Unread { incident: incident(&accounts[at]), account: &accounts[at] }).collect();
    let again = (second.read_again)(&asked, accounts.len())?;
    let again = unread.into_iter().zip(again).filter_map(|(at, account)| Some((at, account?))).collect();
    take_again((&mut accounts, &mut retold), again, &of_id, second.stage_again)?;
    for (account, retold) in accounts.iter().zip(&retold) {
        if let (Ok(made), None) = (&retold.result, retold.untold())
            && made.draft.source.author.is_rules()
        {
            stagings.keep(account, made);
        }
    }
    let of_incident: BTreeMap<&str, (&Account, &Retold)> =
        accounts.iter().zip(&retold).map(|(account, retold)| (account.incident.as_str(), (account, retold))).collect();

    // What becomes of each report that is left: merged, filtered out, unreadable, untold, or told.
    type Fate = Result<Reading, RejectReason>;
    let fate = |record: &CrashRecord| -> Fate {
        let incident = leading.get(&place(record)).ok_or(RejectReason::Merged)?;
        if !kept(incident) {
            return Err(RejectReason::FilteredOut);
        }
        let Some((account, retold)) = of_incident.get(incident.id.as_str()) else {
            return Err(match record.redaction {
                Redaction::Redacted => RejectReason::RedactedNarrative,
                Redaction::Empty => RejectReason::EmptyNarrative,
                Redaction::Open => RejectReason::Untold(Untold::NoAccount),
            });
        };
        match (retold.untold(), told(&account.crash_type)) {
            (None, Some(crash_type)) => Ok(Reading {
                incident: incident.id.clone(),
                reports: account.reports.len(),
                crash_type,
                role: told(&account.role),
                driver: told(&account.driver),
                template: account.template(),
            }),
            (why, _) => Err(RejectReason::Untold(why.unwrap_or(Untold::NoAccount))),
        }
    };
    let fates: Vec<Fate> = set.usable.iter().map(|&at| fate(&set.records[at])).collect();
    let shares = (type_shares(&accounts, &retold), fact_shares(&accounts, &retold));
    let untold = |(account, retold): (&Account, &Retold)| {
        Some(UntoldIncident {
            account: account.clone(),
            why: retold.untold()?,
            reason: retold.reason().unwrap_or_default(),
        })
    };
    let untold = accounts.iter().zip(&retold).filter_map(untold).collect();
    let is_told: Vec<bool> = retold.iter().map(|retold| retold.untold().is_none()).collect();
    let (all, readable) = (incidents.len(), accounts.len());
    let mut is_told = is_told.into_iter();
    let mut told_accounts = accounts;
    told_accounts.retain(|_| is_told.next().unwrap_or(false));

    let usable = std::mem::take(&mut set.usable);
    for (&at, fate) in usable.iter().zip(&fates) {
        match fate {
            Ok(reading) => {
                set.records[at].reading = Some(reading.clone());
                set.usable.push(at);
            }
            Err(reason) => {
                let record = &set.records[at];
                let (file, row) = (record.provenance.file.clone(), record.provenance.row);
                set.rejects.push(Reject { file, row, record: Some(record.id.clone()), reason: *reason });
            }
        }
    }
    let lost_at = |step: fn(&RejectReason) -> bool| {
        let mut counts: BTreeMap<RejectReason, usize> = BTreeMap::new();
        for reason in fates.iter().filter_map(|fate| fate.as_ref().err()).filter(|reason| step(reason)) {
            *counts.entry(*reason).or_default() += 1;
        }
        counts.into_iter().collect::<Vec<_>>()
    };
    let mut remaining = usable.len();
    let mut step = |name: &str, lost: Vec<(RejectReason, usize)>| {
        remaining -= lost.iter().map(|(_, count)| count).sum::<usize>();
        set.funnel.push(FunnelStep { name: name.to_owned(), remaining, lost });
    };
    step("one report an incident", lost_at(|reason| *reason == RejectReason::Merged));
    if let Some(filter) = filter {
        step(&format!("where {}", filter.text()), lost_at(|reason| *reason == RejectReason::FilteredOut));
    }
    let unreadable =
        |reason: &RejectReason| matches!(reason, RejectReason::RedactedNarrative | RejectReason::EmptyNarrative);
    step("narrative readable", lost_at(unreadable));
    step("told as it happened", lost_at(|reason| matches!(reason, RejectReason::Untold(_))));

    let accounts = AccountSet {
        format: ACCOUNTS_FORMAT.to_owned(),
        incidents: all,
        readable,
        types: shares.0,
        facts: shares.1,
        told: told_accounts,
        untold,
    };
    Ok((set, accounts))
}
