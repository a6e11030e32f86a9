//! Which records of a suite that goes by templates can be told as their own crash: what the rules read in them is what the
//! account of their incident says, and a scenario of it is true to them.

use super::design::staged_by_rules;
use rayon::prelude::*;
use recrash_agents::{Brief, disagreement, expectation, own_narrative};
use recrash_model::Seed;
use recrash_model::account::Account;
use recrash_model::metrics::Check;
use recrash_model::profile::SystemProfile;
use recrash_model::record::{CrashRecord, RecordRef, RecordSet};
use recrash_sim::{Ego, Native};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Why the crash of a usable record is not told.
enum Untold {
    /// This record of its incident tells it.
    ByAnother(RecordRef),
    /// It cannot be.
    Cannot(String),
}

impl fmt::Display for Untold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ByAnother(told) => write!(f, "{told} tells the same crash"),
            Self::Cannot(why) => f.write_str(why),
        }
    }
}

/// Fills in why the crashes of usable records are not told. Of an incident one record tells the crash: the one whose narrative
/// speaks for it, else the first that can. How many are told by another of their incident.
///
/// The paper's ego drives, whatever the suite tests: which records are chosen does not depend on the system under test.
pub(super) fn find_untold(set: &mut RecordSet, profile: &SystemProfile) -> usize {
    let place = |record: &CrashRecord| (record.provenance.file.clone(), record.provenance.row);
    let at: BTreeMap<_, usize> = set.usable.iter().map(|&at| (place(&set.records[at]), at)).collect();
    let untold_of = |incident: &recrash_model::incident::Incident| -> Vec<(usize, Untold)> {
        let speaker = incident.leading().map(|report| place(&report.record));
        let reports: BTreeSet<_> = incident.reports.iter().map(|report| place(&report.record)).collect();
        let first = speaker.iter().filter_map(|place| at.get(place));
        let others = reports.iter().filter(|place| Some(*place) != speaker.as_ref()).filter_map(|place| at.get(place));
        let account = recrash_reader::account(incident);
        let mut told: Option<&CrashRecord> = None;
        let mut untold = Vec::new();
        for &at in first.chain(others) {
            let record = &set.records[at];
            match told {
                Some(told) => untold.push((at, Untold::ByAnother(told.id.clone()))),
                None => match why_untold(record, account.as_ref(), profile) {
                    Some(why) => untold.push((at, Untold::Cannot(why))),
                    None => told = Some(record),
                },
            }
        }
        untold
    };
    let incidents = recrash_reader::incidents(&set.records);
    let untold: Vec<Vec<(usize, Untold)>> = incidents.par_iter().map(untold_of).collect();
    let untold: Vec<(usize, Untold)> = untold.into_iter().flatten().collect();
    set.untold = untold.iter().map(|(at, why)| (*at, why.to_string())).collect();
    untold.iter().filter(|(_, why)| matches!(why, Untold::ByAnother(_))).count()
}

/// Why a record's own crash cannot be told; nothing where it can.
fn why_untold(record: &CrashRecord, account: Option<&Account>, profile: &SystemProfile) -> Option<String> {
    let id = &record.id;
    let Some(template) = record.template() else { return Some(format!("{id} has no template")) };
    let (scenario_id, seed) = ("own", Seed(0));
    let brief = Brief { scenario_id, template, records: &[record], untold: None, profile, account, seed };
    let narrative = match own_narrative(&brief) {
        Ok(narrative) => narrative,
        Err(why) => return Some(why),
    };
    if let Some(why) = account.and_then(|account| disagreement(&narrative, account, profile)) {
        return Some(format!("the account of {id} says otherwise: {why}"));
    }
    let expectation = expectation(&narrative, record, profile);
    match staged_by_rules(&brief, &narrative, &expectation, &Native::new(Ego::MetadriveIdm)) {
        Ok(missed) => missed.map(|Check { kind, observed, expected, .. }| {
            format!("no design shows what {id} tells: {} is {observed}, not {expected}", kind.label())
        }),
        Err(why) => Some(why.to_string()),
    }
}
