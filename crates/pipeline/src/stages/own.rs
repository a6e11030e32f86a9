//! Which records of a suite that goes by templates can be told as their own crash: what the rules read in them is what the
//! account of their incident says, and a scenario of it is true to them.

use super::design::staged_by_rules;
use rayon::prelude::*;
use recrash_agents::{Brief, Paraphrase, Rules, disagreement, expectation};
use recrash_model::Seed;
use recrash_model::account::Account;
use recrash_model::metrics::Check;
use recrash_model::profile::SystemProfile;
use recrash_model::record::{CrashRecord, RecordSet};
use recrash_sim::{Ego, Native};
use std::collections::{BTreeMap, BTreeSet};

/// How the reason ends of a record whose incident another record tells.
pub(super) const TOLD_BY_ANOTHER: &str = "tells the same crash";

/// Fills in why the crashes of usable records are not told. Of an incident one record tells the crash: the one whose narrative
/// speaks for it, else the first that can.
///
/// The paper's ego drives, whatever the suite tests: which records are chosen does not depend on the system under test.
pub(super) fn find_untold(set: &mut RecordSet, profile: &SystemProfile) {
    let place = |record: &CrashRecord| (record.provenance.file.clone(), record.provenance.row);
    let at: BTreeMap<_, usize> = set.usable.iter().map(|&at| (place(&set.records[at]), at)).collect();
    let untold_of = |incident: &recrash_model::incident::Incident| -> Vec<(usize, String)> {
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
                Some(told) => untold.push((at, format!("{} {TOLD_BY_ANOTHER}", told.id))),
                None => match why_untold(record, account.as_ref(), profile) {
                    Some(why) => untold.push((at, why)),
                    None => told = Some(record),
                },
            }
        }
        untold
    };
    let incidents = recrash_reader::incidents(&set.records);
    let untold: Vec<Vec<(usize, String)>> = incidents.par_iter().map(untold_of).collect();
    set.untold = untold.into_iter().flatten().collect();
}

/// Why a record's own crash cannot be told; nothing where it can.
fn why_untold(record: &CrashRecord, account: Option<&Account>, profile: &SystemProfile) -> Option<String> {
    let id = &record.id;
    let Some(template) = record.template() else { return Some(format!("{id} has no template")) };
    let (scenario_id, seed) = ("own", Seed(0));
    let brief = Brief { scenario_id, template, records: &[record], untold: None, profile, account, seed };
    let narrative = match Rules.paraphrase(&brief) {
        Ok(outcome) => outcome.value,
        Err(why) => return Some(why.to_string()),
    };
    if let Some(reason) = narrative.origin.reason() {
        return Some(reason.split("; a plausible").next().unwrap_or(reason).to_owned());
    }
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
