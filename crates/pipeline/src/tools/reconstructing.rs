//! Accounts into reconstructions: a scenario an incident, each told fact held against its rollout.

use crate::error::PipelineError;
use crate::files::output::Outputs;
use crate::files::store::io;
use crate::progress::{Progress, ProgressEvent};
use rayon::prelude::*;
use recrash_model::account::Account;
use recrash_reconstruct::{FactKind, Reconstruction, Untold, reconstruct};
use serde::Serialize;
use std::path::{Path, PathBuf};

const STAGE: &str = "reconstruct";

/// What became of one account.
pub struct Retold {
    /// Position in the list of accounts.
    pub account: usize,
    /// Its scenario, or why there is none.
    pub result: Result<Reconstruction, Untold>,
}

/// How a reconstruction stands to what is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Every told fact that is checked is shown.
    Shown,
    /// Staged, and at least one told fact is not shown.
    NotShown,
    /// Not staged.
    Untold,
}

impl Retold {
    /// How it stands to what is told.
    pub fn standing(&self) -> Standing {
        match &self.result {
            Ok(made) if made.is_true() => Standing::Shown,
            Ok(_) => Standing::NotShown,
            Err(_) => Standing::Untold,
        }
    }

    /// Why its crash is not told; nothing where it is.
    pub fn reason(&self) -> Option<String> {
        match &self.result {
            Ok(made) => {
                let missed = made.facts.iter().find(|fact| !fact.shown)?;
                Some(format!("{} is not shown", missed.kind.label()))
            }
            Err(reason) => Some(reason.label().to_owned()),
        }
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

/// Writes the scenarios that show every told fact that is checked, each as a file named by its incident. Gives the files.
///
/// # Errors
/// A file cannot be written, or is one of the inputs.
pub fn write_reconstructions(
    retold: &[Retold],
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<Vec<PathBuf>, PipelineError> {
    if folder.exists() && !folder.is_dir() {
        return Err(PipelineError::bad_input(format!(
            "{} is a file; name a folder for the scenarios",
            folder.display()
        )));
    }
    std::fs::create_dir_all(folder).map_err(|source| io("create", folder, source))?;
    let mut files = Vec::new();
    // A file that is there and says something else may be somebody's work: nothing is written then.
    let text = |made: &Reconstruction| recrash_roads::write_draft(&made.draft);
    for made in
        retold.iter().filter(|each| each.standing() == Standing::Shown).filter_map(|each| each.result.as_ref().ok())
    {
        let file = folder.join(format!("{}.json", made.draft.id));
        if std::fs::symlink_metadata(&file).is_ok() && std::fs::read(&file).ok() != Some(text(made).into_bytes()) {
            return Err(PipelineError::bad_input(format!(
                "{} is there and differs from what would be written; name another folder, or move the file away",
                file.display()
            )));
        }
    }
    for each in retold.iter().filter(|each| each.standing() == Standing::Shown) {
        let Ok(made) = &each.result else { continue };
        let file = folder.join(format!("{}.json", made.draft.id));
        let output = outputs.claim(&file)?;
        output.write(text(made).as_bytes())?;
        files.push(file);
    }
    Ok(files)
}

/// How often a kind of fact is told, and shown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FactShare {
    /// The kind of fact.
    pub fact: &'static str,
    /// Reconstructions whose account tells it.
    pub told: usize,
    /// Of those, the ones that show it.
    pub shown: usize,
}

/// The share of told facts that are shown, by kind, over everything that was staged.
pub fn fact_shares(retold: &[Retold]) -> Vec<FactShare> {
    let all = || retold.iter().filter_map(|each| each.result.as_ref().ok()).flat_map(|made| &made.facts);
    let share = |kind: FactKind| FactShare {
        fact: kind.label(),
        told: all().filter(|fact| fact.kind == kind).count(),
        shown: all().filter(|fact| fact.kind == kind && fact.shown).count(),
    };
    FactKind::ALL.into_iter().map(share).collect()
}
