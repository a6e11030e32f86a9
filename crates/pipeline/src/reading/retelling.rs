//! Accounts retold: a reconstruction each, and what becomes of every incident of crash files.

use crate::error::PipelineError;
use crate::models::cast::Reads;
use crate::profiles::{DEFAULT_PROFILE, load_profile};
use crate::progress::{Progress, ProgressEvent};
use crate::reading::accounts::told_facts;
pub(crate) use crate::reading::outcomes::what_is_missed;
use crate::reading::outcomes::{Outcome, Outcomes, key};
use crate::reading::records;
use rayon::prelude::*;
use recrash_model::account::{
    ACCOUNTS_FORMAT, Account, AccountSet, CrashType, FactShare, TypeShare, Untold, UntoldIncident, told,
};
use recrash_model::incident::Incident;
use recrash_model::metrics::{Answer, CheckKind, CheckResult};
use recrash_model::record::{CrashRecord, FunnelStep, Reading, RecordSet, Redaction, Reject, RejectReason};
use recrash_model::scenario::ScenarioDraft;
use recrash_reconstruct::{Reconstruction, reconstruct, told_kinds};
use recrash_records::Filter;
use serde::Serialize;
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

    /// The scenario that tells its crash, where there is one.
    pub fn shown(&self) -> Option<&Reconstruction> {
        self.result.as_ref().ok().filter(|made| made.missed().is_none())
    }

    /// How the two touch in the scenario that tells its crash; nothing where there is none.
    pub fn impact(&self) -> Option<Impact> {
        let made = self.shown()?;
        let scenario = recrash_roads::check(made.draft.clone()).ok()?.value;
        let metrics = recrash_metrics::measure(&scenario, &made.rollout, &load_profile(DEFAULT_PROFILE).ok()?.failure);
        let severity = recrash_metrics::severity_of(&made.rollout, &metrics)?;
        Some(Impact {
            ego_impact_speed_mps: severity.first.impact_speed_mps,
            other_impact_speed_mps: severity.second.impact_speed_mps,
            closing_speed_mps: severity.closing_speed_mps,
            delta_v_mps: severity.first.delta_v_mps,
            other_delta_v_mps: severity.second.delta_v_mps,
        })
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

/// Numbers of the first contact of a reconstructed crash (`docs/models/severity.md`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Impact {
    /// Speed of the ego at the contact. [m/s]
    pub ego_impact_speed_mps: f64,
    /// Speed of the other. [m/s]
    pub other_impact_speed_mps: f64,
    /// Magnitude of their relative velocity. [m/s]
    pub closing_speed_mps: f64,
    /// Change of the ego's velocity, by momentum. [m/s]
    pub delta_v_mps: f64,
    /// Change of the other's; 0 of what stands firm. [m/s]
    pub other_delta_v_mps: f64,
}

/// An account with what became of it.
struct Fated {
    account: Account,
    outcome: Outcome,
    /// Its scenario, where it was made in this run and there is one.
    made: Option<Reconstruction>,
}

impl Fated {
    /// Reconstructs an account.
    fn of(account: Account) -> Self {
        let result = reconstruct(&account);
        Self { account, outcome: Outcome::of(&result), made: result.ok() }
    }
}

/// Why the crash of an account is not told by its reconstruction; nothing where it is, or where it need not be yet and there is one.
pub(crate) fn why_untold(account: &Account, is_staged_again: bool) -> Option<String> {
    let retold = Retold { account: 0, result: reconstruct(account) };
    if is_staged_again && retold.result.is_ok() { None } else { retold.reason() }
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
    let outcomes: Vec<Outcome> = retold.iter().map(|each| Outcome::of(&each.result)).collect();
    let each: Vec<_> = retold.iter().zip(&outcomes).map(|(each, outcome)| (&accounts[each.account], outcome)).collect();
    shares_of_facts(&each)
}

/// The same of accounts with their outcomes.
fn shares_of_facts(all: &[(&Account, &Outcome)]) -> Vec<FactShare> {
    let told_by: Vec<Vec<CheckKind>> = all.par_iter().map(|(account, _)| told_kinds(account)).collect();
    let share = |fact: CheckKind| {
        let tells =
            || all.iter().zip(&told_by).filter(|(_, told)| told.contains(&fact)).map(|((_, outcome), _)| outcome);
        let of = |result: CheckResult| tells().filter(|outcome| outcome.checks.contains(&(fact, result))).count();
        let (shown, not_drawn) = (of(CheckResult::Shown), of(CheckResult::CannotBeShown));
        FactShare { fact, told: tells().count(), shown, not_drawn }
    };
    CheckKind::OF_ACCOUNTS.into_iter().map(share).collect()
}

/// How much of every type that occurs is told.
pub fn type_shares(accounts: &[Account], retold: &[Retold]) -> Vec<TypeShare> {
    let outcomes: Vec<Outcome> = retold.iter().map(|each| Outcome::of(&each.result)).collect();
    let each: Vec<_> = retold.iter().zip(&outcomes).map(|(each, outcome)| (&accounts[each.account], outcome)).collect();
    shares_of_types(&each)
}

/// The same of accounts with their outcomes.
fn shares_of_types(all: &[(&Account, &Outcome)]) -> Vec<TypeShare> {
    let facts: Vec<usize> = all.par_iter().map(|(account, _)| told_facts(account).len()).collect();
    let share = |crash_type: Option<CrashType>| {
        let of = || all.iter().zip(&facts).filter(|((account, _), _)| told(&account.crash_type) == crash_type);
        let words: usize = of().map(|((account, _), _)| account.words as usize).sum();
        let facts: usize = of().map(|(_, facts)| facts).sum();
        TypeShare {
            crash_type,
            incidents: of().count(),
            told: of().filter(|((_, outcome), _)| outcome.untold.is_none()).count(),
            whole: of().filter(|((_, outcome), _)| outcome.is_whole).count(),
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
fn is_incomplete(Fated { account, outcome, .. }: &Fated) -> bool {
    let lacks = account.crash_type.is_none() || account.striker.is_none() || account.came_from.is_none();
    lacks
        || matches!(outcome.untold, Some(Untold::NoAccount | Untold::OthersOnly | Untold::NoContact | Untold::NotShown))
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
    outcomes: Outcomes,
) -> Result<(RecordSet, AccountSet), PipelineError> {
    let incidents = records::incidents(&set);
    let read: Vec<&Incident> = incidents.iter().filter(|incident| is_kept(incident, filter)).collect();
    let mut telling = Telling::of(&read, progress, outcomes, second.stage_again.is_some())?;
    telling.look_again(&read, second)?;
    telling.keep(stagings);
    let fates = fates(&set, &incidents, filter, &telling);
    add_steps(&mut set, filter, &fates);
    settle(&mut set, fates);
    Ok((set, telling.into_set(incidents.len())))
}

/// Whether the report that leads an incident is one that the filter keeps.
fn is_kept(incident: &Incident, filter: Option<&Filter>) -> bool {
    incident.leading().is_some_and(|report| filter.is_none_or(|filter| filter.keeps(&report.record)))
}

/// The accounts of incidents, and what became of each.
struct Telling(Vec<Fated>);

impl Telling {
    /// What the built-in reader makes of these incidents. What became of an account in an earlier run is taken from there, but for scenes
    /// that somebody else is to change.
    fn of(
        read: &[&Incident],
        progress: &dyn Progress,
        outcomes: Outcomes,
        is_staged_again: bool,
    ) -> Result<Self, PipelineError> {
        let accounts: Vec<Account> = read.par_iter().filter_map(|incident| recrash_reader::account(incident)).collect();
        progress.event(ProgressEvent::Started { stage: STAGE, units: accounts.len() });
        let tell = |account: &Account| {
            let is_enough = |outcome: &Outcome| !(is_staged_again && outcome.untold == Some(Untold::NotShown));
            let known = outcomes.get(account).filter(is_enough);
            let skipped = known.is_some();
            let fated = match known {
                Some(outcome) => Fated { account: account.clone(), outcome, made: None },
                None => {
                    let fated = Fated::of(account.clone());
                    outcomes.keep(account, &fated.outcome);
                    fated
                }
            };
            progress.event(ProgressEvent::Advanced { stage: STAGE, unit: &account.incident, skipped });
            fated
        };
        let all: Vec<Fated> = accounts.par_iter().map(tell).collect();
        outcomes.finish(&accounts)?;
        progress.event(ProgressEvent::Finished { stage: STAGE });
        Ok(Self(all))
    }

    /// Has somebody else read what is not read whole, or all, and stage what is not shown as told. An account of theirs is taken where the
    /// crash is told by it, or staged then; else the account stays as it was.
    fn look_again(&mut self, read: &[&Incident], second: Second) -> Result<(), PipelineError> {
        let of_id: BTreeMap<&str, &Incident> = read.iter().map(|&incident| (incident.id.as_str(), incident)).collect();
        let is_asked = |at: &usize| second.reads == Reads::All || is_incomplete(&self.0[*at]);
        let positions: Vec<usize> = (0..self.0.len()).filter(is_asked).collect();
        let unread = |&at: &usize| {
            let account = &self.0[at].account;
            Unread { incident: of_id[account.incident.as_str()], account }
        };
        let asked: Vec<Unread> = positions.iter().map(unread).collect();
        let again = (second.read_again)(&asked, self.0.len())?;
        let again = positions.into_iter().zip(again).filter_map(|(at, account)| Some((at, account?)));
        let before = self.take(again.collect(), second.stage_again.is_some());
        second.stage_again.map_or(Ok(()), |stage_again| self.stage_again(&of_id, before, stage_again))
    }

    /// Takes these accounts where the crash is told by them, and where there is a scene of it, if it is to be staged by somebody else. Gives
    /// what stood in the place of the latter.
    fn take(&mut self, again: Vec<(usize, Account)>, is_staged_again: bool) -> BTreeMap<usize, Fated> {
        let mut before = BTreeMap::new();
        for (at, account) in again {
            let other = Fated::of(account);
            let is_told = other.outcome.untold.is_none();
            if is_told || is_staged_again && other.made.is_some() {
                let old = std::mem::replace(&mut self.0[at], other);
                before.extend((!is_told).then_some((at, old)));
            }
        }
        before
    }

    /// Has somebody else stage what is not shown as told; what they do not stage either is left as it was before.
    fn stage_again(
        &mut self,
        incidents: &BTreeMap<&str, &Incident>,
        mut before: BTreeMap<usize, Fated>,
        stage_again: &mut StageAgain,
    ) -> Result<(), PipelineError> {
        let unstaged = self.0.iter().enumerate().filter_map(|(at, Fated { account, outcome, made })| {
            let made = made.as_ref().filter(|_| outcome.untold == Some(Untold::NotShown))?;
            Some((at, Unstaged { incident: incidents[account.incident.as_str()], account, made }))
        });
        let (positions, unstaged): (Vec<usize>, Vec<Unstaged>) = unstaged.unzip();
        for (at, made) in positions.into_iter().zip(stage_again(&unstaged)?) {
            if let Some(made) = made {
                let made = Ok(made);
                self.0[at].outcome = Outcome::of(&made);
                self.0[at].made = made.ok();
            } else if let Some(old) = before.remove(&at) {
                self.0[at] = old;
            }
        }
        Ok(())
    }

    /// Hands on the scenarios of what the rules tell.
    fn keep(&self, stagings: &Stagings) {
        for Fated { account, outcome, made } in &self.0 {
            let told = made.as_ref().filter(|_| outcome.untold.is_none());
            if let Some(made) = told.filter(|made| made.draft.source.author.is_rules()) {
                stagings.keep(account, made);
            }
        }
    }

    /// The accounts for the stages that follow, told and untold, of so many incidents.
    fn into_set(self, incidents: usize) -> AccountSet {
        let each: Vec<(&Account, &Outcome)> = self.0.iter().map(|fated| (&fated.account, &fated.outcome)).collect();
        let (types, facts) = (shares_of_types(&each), shares_of_facts(&each));
        let readable = self.0.len();
        let (mut told, mut untold) = (Vec::new(), Vec::new());
        for Fated { account, outcome, .. } in self.0 {
            match outcome.untold {
                None => told.push(account),
                Some(why) => {
                    untold.push(UntoldIncident { account, why, reason: outcome.reason.unwrap_or_default() });
                }
            }
        }
        AccountSet { format: ACCOUNTS_FORMAT.to_owned(), incidents, readable, types, facts, told, untold }
    }
}

/// What becomes of a report: what is read of it, or why it is left out.
type Fate = Result<Reading, RejectReason>;

/// What becomes of each report that is left: merged, filtered out, unreadable, untold, or told.
fn fates(set: &RecordSet, incidents: &[Incident], filter: Option<&Filter>, telling: &Telling) -> Vec<Fate> {
    let leading: BTreeMap<Place, &Incident> =
        incidents.iter().filter_map(|incident| Some((place(&incident.leading()?.record), incident))).collect();
    let of_incident: BTreeMap<&str, &Fated> =
        telling.0.iter().map(|fated| (fated.account.incident.as_str(), fated)).collect();
    let fate = |record: &CrashRecord| -> Fate {
        let incident = leading.get(&place(record)).ok_or(RejectReason::Merged)?;
        if !is_kept(incident, filter) {
            return Err(RejectReason::FilteredOut);
        }
        let fated = of_incident.get(incident.id.as_str()).ok_or_else(|| why_no_account(record))?;
        reading(incident, fated).map_err(RejectReason::Untold)
    };
    set.usable.iter().map(|&at| fate(&set.records[at])).collect()
}

/// Why there is no account of a record.
fn why_no_account(record: &CrashRecord) -> RejectReason {
    match record.redaction {
        Redaction::Redacted => RejectReason::RedactedNarrative,
        Redaction::Empty => RejectReason::EmptyNarrative,
        Redaction::Open => RejectReason::Untold(Untold::NoAccount),
    }
}

/// What is read of an incident whose crash is told; else why it is not.
fn reading(incident: &Incident, Fated { account, outcome, .. }: &Fated) -> Result<Reading, Untold> {
    match (outcome.untold, told(&account.crash_type)) {
        (None, Some(crash_type)) => Ok(Reading {
            incident: incident.id.clone(),
            reports: account.reports.len(),
            crash_type,
            role: told(&account.role),
            driver: told(&account.driver),
            template: account.template(),
        }),
        (why, _) => Err(why.unwrap_or(Untold::NoAccount)),
    }
}

/// The steps that the usable reports go through, with those lost at each.
fn add_steps(set: &mut RecordSet, filter: Option<&Filter>, fates: &[Fate]) {
    let mut remaining = fates.len();
    let mut step = |name: &str, is_lost_here: fn(&RejectReason) -> bool| {
        let mut lost: BTreeMap<RejectReason, usize> = BTreeMap::new();
        for reason in fates.iter().filter_map(|fate| fate.as_ref().err()).filter(|reason| is_lost_here(reason)) {
            *lost.entry(*reason).or_default() += 1;
        }
        remaining -= lost.values().sum::<usize>();
        set.funnel.push(FunnelStep { name: name.to_owned(), remaining, lost: lost.into_iter().collect() });
    };
    step("one report an incident", |reason| *reason == RejectReason::Merged);
    if let Some(filter) = filter {
        step(&format!("where {}", filter.text()), |reason| *reason == RejectReason::FilteredOut);
    }
    step("narrative readable", |reason| {
        matches!(reason, RejectReason::RedactedNarrative | RejectReason::EmptyNarrative)
    });
    step("told as it happened", |reason| matches!(reason, RejectReason::Untold(_)));
}

/// Leaves those usable that are told, with what is read of them, and lists the others as rejected.
fn settle(set: &mut RecordSet, fates: Vec<Fate>) {
    for (at, fate) in std::mem::take(&mut set.usable).into_iter().zip(fates) {
        let record = &mut set.records[at];
        match fate {
            Ok(reading) => {
                record.reading = Some(reading);
                set.usable.push(at);
            }
            Err(reason) => {
                let (file, row) = (record.provenance.file.clone(), record.provenance.row);
                set.rejects.push(Reject { file, row, record: Some(record.id.clone()), reason });
            }
        }
    }
}
