//! What became of all incidents of crash files.

use super::{Account, CrashType, Untold};
use crate::metrics::CheckKind;
use crate::origin::RecordRef;
use serde::{Deserialize, Deserializer, Serialize};

/// Format tag of [`AccountSet`].
pub const ACCOUNTS_FORMAT: &str = "recrash.accounts/2";

/// How often a kind of fact is told, and shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FactShare {
    /// The kind of fact.
    pub fact: CheckKind,
    /// Accounts that tell it, also those that could not be staged.
    pub told: usize,
    /// Of those, the ones whose reconstruction shows it.
    pub shown: usize,
    /// Of those, the ones whose reconstruction neither shows it nor anything else in its place: it is told, and not drawn.
    #[serde(default)]
    pub not_drawn: usize,
}

/// How much of a crash type is told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TypeShare {
    /// The type; `None` where no account tells it.
    pub crash_type: Option<CrashType>,
    /// Incidents with a narrative that can be read.
    pub incidents: usize,
    /// Of those, the ones whose reconstruction shows every told fact that is checked.
    pub told: usize,
    /// Of those, the ones of which every told fact is shown; in the others some are told and not drawn.
    pub whole: usize,
    /// Facts that stand in the narratives, for every 100 words of them: so that silence does not pass for truth.
    pub facts_per_100_words: f64,
}

/// The accounts of a suite (`1-accounts.json`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccountSet {
    /// Always [`ACCOUNTS_FORMAT`].
    #[serde(deserialize_with = "known_format")]
    pub format: String,
    /// Incidents of the files.
    pub incidents: usize,
    /// Of those, the ones with a narrative that can be read, and that the filter keeps.
    pub readable: usize,
    /// How much of each crash type is told.
    pub types: Vec<TypeShare>,
    /// How much of each kind of fact is shown.
    pub facts: Vec<FactShare>,
    /// Accounts whose reconstruction shows every told fact, by incident.
    pub told: Vec<Account>,
    /// What became of the other readable incidents.
    pub untold: Vec<UntoldIncident>,
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    crate::formats::known(deserializer, ACCOUNTS_FORMAT)
}

/// An incident whose crash is not told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UntoldIncident {
    /// What its reports tell.
    pub account: Account,
    /// Why.
    pub why: Untold,
    /// The same, with the fact that is not shown.
    pub reason: String,
}

impl AccountSet {
    /// Every readable incident and its crash type.
    pub fn all(&self) -> impl Iterator<Item = (&str, Option<CrashType>)> {
        let accounts = self.told.iter().chain(self.untold.iter().map(|untold| &untold.account));
        accounts.map(|account| (account.incident.as_str(), super::told(&account.crash_type)))
    }

    /// The account of the incident that this report speaks for.
    pub fn of(&self, report: &RecordRef) -> Option<&Account> {
        self.told.iter().find(|account| account.report == *report)
    }
}
