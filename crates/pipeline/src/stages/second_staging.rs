//! A language model stages the crashes that the rules do not show as they are told, in a suite that goes by accounts: it is given what there
//! is of them, and changes that until no told fact is missed.

use super::design_log::DesignLog;
use super::restage::{as_staged, looked_at, question_cost};
use crate::error::PipelineError;
use crate::models::cast::reading_brief;
use crate::progress::{Progress, ProgressEvent};
use crate::reading::retelling::Unstaged;
use crate::suite::{Stage, Suite};
use rayon::prelude::*;
use recrash_model::record::CrashRecord;
use recrash_reconstruct::Reconstruction;
use std::collections::BTreeMap;

/// Name of the work in progress bars.
const STAGE: &str = "stage";

/// What a model made of crashes.
#[derive(Default)]
pub(super) struct SecondStaging {
    /// A reconstruction for each that was asked about, where the model is content with one that misses no told fact.
    pub made: Vec<Option<Reconstruction>>,
    /// How it came to it, or why it did not, by incident.
    pub logs: BTreeMap<String, DesignLog>,
}

/// Has the model stage these crashes; nothing where none is cast. How many they are and what they cost is said before the first
/// question, how many came out behind the last.
///
/// # Errors
/// The run has to stop: a batch waits, a cap is reached, nobody answers.
pub(super) fn stage_again(
    suite: &Suite,
    unstaged: &[Unstaged],
    progress: &dyn Progress,
) -> Result<SecondStaging, PipelineError> {
    let Some((models, name)) = suite.models().zip(suite.options().stager()) else {
        return Ok(SecondStaging::default());
    };
    if unstaged.is_empty() {
        return Ok(SecondStaging::default());
    }
    let (count, cost) = (unstaged.len(), question_cost(models, name, unstaged.len()));
    let what = format!(
        "{name} stages {count} crashes that the rules do not show as told: {cost}, and more for each change, as all that was said before is \
         sent again"
    );
    progress.event(ProgressEvent::Said { what: &what });
    progress.event(ProgressEvent::Started { stage: STAGE, units: count });
    let one = |each: &Unstaged| {
        let staged = staged_again(suite, each);
        progress.event(ProgressEvent::Advanced { stage: STAGE, unit: &each.account.incident, skipped: false });
        staged
    };
    let answers: Vec<_> = suite.on_threads(Stage::Narrate, || unstaged.par_iter().map(one).collect());
    progress.event(ProgressEvent::Finished { stage: STAGE });
    models.must_be_answered(&answers)?;
    let mut staged = SecondStaging::default();
    for (each, answer) in unstaged.iter().zip(answers) {
        let (made, log) = answer?;
        staged.made.push(made);
        staged.logs.insert(each.account.incident.clone(), log);
    }
    let made = staged.made.iter().flatten().count();
    let what = format!("{name} staged {made} of {count} crashes that the rules do not show as told");
    progress.event(ProgressEvent::Said { what: &what });
    Ok(staged)
}

/// What the model makes of one of them. What goes wrong with this one alone is why it is not staged.
fn staged_again(suite: &Suite, unstaged: &Unstaged) -> Result<(Option<Reconstruction>, DesignLog), PipelineError> {
    let Unstaged { incident, account, made } = *unstaged;
    let records: Vec<&CrashRecord> = incident.reports.iter().map(|report| &report.record).collect();
    let brief = reading_brief(&account.incident, &records, suite.profile(), account);
    let begun = DesignLog::begun_with(made);
    let gave_up = |why: String| (None, DesignLog { gave_up: vec![why], ..begun.clone() });
    let (draft, log) = match looked_at(suite, &brief, account, made.draft.clone(), begun.clone()) {
        Err(PipelineError::Scenario { why, .. }) => return Ok(gave_up(why)),
        looked_at => looked_at?,
    };
    if !log.gave_up.is_empty() {
        return Ok((None, log));
    }
    Ok(match as_staged(account, &draft) {
        Ok(made) if made.missed().is_none() => (Some(made), log),
        Ok(_) => gave_up("what it is content with misses a told fact".to_owned()),
        Err(why) => gave_up(why.join("; ")),
    })
}
