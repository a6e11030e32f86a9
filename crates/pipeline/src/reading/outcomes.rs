//! What became of accounts that were reconstructed, kept in the suite's folder while it is found: a run that was killed goes on from there,
//! and only accounts that are new are reconstructed when records come in.
//!
//! A reconstruction is made of its account alone, so an outcome holds for that very account and for this code. The file is no result: it may
//! be removed at any time.

use crate::error::PipelineError;
use crate::files::json::{from_json, to_compact_json};
use crate::files::store::{CODE, Store, sha256};
use recrash_model::account::{Account, Untold};
use recrash_model::metrics::{Answer, Check, CheckKind, CheckResult};
use recrash_reconstruct::Reconstruction;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The file: a line that says whose outcomes they are, then one for each account.
const FILE: &str = "1-accounts.outcomes.jsonl";
/// Format tag of its first line.
const FORMAT: &str = "recrash.outcomes/1";
/// Outcomes that are written at a time: as many may be lost where the program is killed.
const AT_A_TIME: usize = 16;

/// What became of one account, without its scenario.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Outcome {
    /// Why its crash is not told; nothing where no told fact is shown otherwise, and all that the two did is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub untold: Option<Untold>,
    /// The same, with the fact that is not shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Whether every told fact is checked, and shown.
    pub is_whole: bool,
    /// What became of each told fact.
    pub checks: Vec<(CheckKind, CheckResult)>,
}

impl Outcome {
    /// Of a reconstruction, or of the reason why there is none.
    pub fn of(result: &Result<Reconstruction, Untold>) -> Self {
        match result {
            Ok(made) => Self {
                untold: made.missed().map(|_| Untold::NotShown),
                reason: made.missed().map(what_is_missed),
                is_whole: made.verdict.faithful() == Answer::Yes,
                checks: made.verdict.checks.iter().map(|check| (check.kind, check.result)).collect(),
            },
            Err(why) => {
                Self { untold: Some(*why), reason: Some(why.label().to_owned()), is_whole: false, checks: Vec::new() }
            }
        }
    }
}

/// A told fact that is missed, and what is seen in its place.
pub(crate) fn what_is_missed(missed: &Check) -> String {
    let what = missed.kind.label();
    match missed.result {
        CheckResult::CannotBeShown => format!("{what} is not drawn: {}", missed.observed),
        _ => format!("{what} is not shown: {}, not {}", missed.observed, missed.expected),
    }
}

/// What an account is known by.
pub(crate) fn key(account: &Account) -> String {
    sha256(&to_compact_json(account))
}

#[derive(Serialize)]
struct Head {
    format: String,
    code: String,
}

#[derive(Serialize, Deserialize)]
struct Line {
    account: String,
    outcome: Outcome,
}

/// The outcomes of a suite.
pub(crate) struct Outcomes<'a> {
    store: &'a Store,
    found: Mutex<Found>,
}

struct Found {
    known: BTreeMap<String, Outcome>,
    /// Lines that are still to be written, and how many.
    waiting: (Vec<u8>, usize),
    failed: Option<PipelineError>,
}

impl<'a> Outcomes<'a> {
    /// Those that are there. A file of other code, or one that is none, is begun anew; a line that was cut off ends it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn open(store: &'a Store) -> Result<Self, PipelineError> {
        let text = store.read_or_empty(FILE);
        let (known, is_whole) = read(&text);
        if !is_whole {
            let lines = known.iter().map(|(account, outcome)| line(account.clone(), outcome.clone()));
            store.write(FILE, &head().into_iter().chain(lines.flatten()).collect::<Vec<u8>>())?;
        }
        let found = Found { known, waiting: (Vec::new(), 0), failed: None };
        Ok(Self { store, found: Mutex::new(found) })
    }

    /// That of an account.
    pub fn get(&self, account: &Account) -> Option<Outcome> {
        self.lock().known.get(&key(account)).cloned()
    }

    /// Keeps one. What cannot be written is told at the end.
    pub fn keep(&self, account: &Account, outcome: &Outcome) {
        let key = key(account);
        let mut found = self.lock();
        let Found { known, waiting: (lines, count), failed } = &mut *found;
        lines.extend(line(key.clone(), outcome.clone()));
        known.insert(key, outcome.clone());
        *count += 1;
        if *count == AT_A_TIME && failed.is_none() {
            *failed = self.store.append(FILE, lines).err();
            (*lines, *count) = (Vec::new(), 0);
        }
    }

    /// Leaves those of these accounts in the file, in their order.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn finish(self, accounts: &[Account]) -> Result<(), PipelineError> {
        let Found { mut known, failed, .. } = self.found.into_inner().unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = failed {
            return Err(error);
        }
        let mut text = head();
        for account in accounts {
            let key = key(account);
            text.extend(known.remove(&key).into_iter().flat_map(|outcome| line(key.clone(), outcome)));
        }
        if self.store.read_or_empty(FILE) != text {
            self.store.write(FILE, &text)?;
        }
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, Found> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The outcomes in a file of this code, and whether nothing of it had to be left out.
fn read(text: &[u8]) -> (BTreeMap<String, Outcome>, bool) {
    let mut lines = text.split_inclusive(|byte| *byte == b'\n');
    if lines.next() != Some(&head()) {
        return (BTreeMap::new(), false);
    }
    let mut known = BTreeMap::new();
    for line in lines {
        match from_json::<Line>(line) {
            Ok(Line { account, outcome }) if line.ends_with(b"\n") => known.insert(account, outcome),
            _ => return (known, false),
        };
    }
    (known, true)
}

fn head() -> Vec<u8> {
    to_compact_json(&Head { format: FORMAT.to_owned(), code: CODE.to_owned() })
}

fn line(account: String, outcome: Outcome) -> Vec<u8> {
    to_compact_json(&Line { account, outcome })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::store::write_suite_file;

    fn outcome(reason: &str) -> Outcome {
        let checks = vec![(CheckKind::Order, CheckResult::Shown)];
        Outcome { untold: None, reason: Some(reason.to_owned()), is_whole: true, checks }
    }

    #[test]
    fn what_is_cut_off_or_of_other_code_is_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::create(folder.path(), write_suite_file).unwrap();
        let known = |text: Vec<u8>| -> Vec<String> {
            store.write(FILE, &text).unwrap();
            let known = Outcomes::open(&store).unwrap().lock().known.keys().cloned().collect();
            // Whatever it was, it is whole now.
            assert!(read(&store.read_or_empty(FILE)).1);
            known
        };
        let lines = [line("a".into(), outcome("x")), line("b".into(), outcome("y"))].concat();
        assert_eq!(known([head(), lines.clone()].concat()), ["a", "b"]);
        assert_eq!(known([head(), lines[..lines.len() - 1].to_vec()].concat()), ["a"]);
        assert_eq!(known([head(), b"{}\n".to_vec(), lines.clone()].concat()), [""; 0]);
        let other = String::from_utf8(head()).unwrap().replace(CODE, "other");
        assert_eq!(known([other.into_bytes(), lines].concat()), [""; 0]);
        assert_eq!(known(Vec::new()), [""; 0]);
    }
}
