//! A language model reads what the built-in reader did not read whole, or everything, in a suite that goes by accounts.

use crate::error::PipelineError;
use crate::models::cast::{AgentLog, RULES, Reads, reading_brief, unusable};
use crate::progress::{Progress, ProgressEvent};
use crate::reading::retelling::{Unread, why_untold};
use crate::suite::{Stage, Suite};
use rayon::prelude::*;
use recrash_agents::llm::{Repairs, paraphrase_question};
use recrash_model::account::Account;
use recrash_model::record::CrashRecord;
use std::collections::BTreeMap;

/// What a model made of incidents.
#[derive(Default)]
pub(super) struct SecondReading {
    /// An account for each that was asked about, where the model gave one.
    pub accounts: Vec<Option<Account>>,
    /// Who was asked and who answered, by incident.
    pub logs: BTreeMap<String, AgentLog>,
}

/// The account with what follows from its facts, where the crash is told by it; where somebody stages what the rules do not show, it is
/// enough that there is something to begin with.
fn shown(mut account: Account, is_staged_again: bool) -> Result<Account, String> {
    recrash_reader::refold(&mut account);
    match why_untold(&account, is_staged_again) {
        None => Ok(account),
        Some(why) => Err(format!(
            "the crash cannot be rebuilt from this account: {why}. Read again whether the report says so, who did it, to which side, and \
             before or after what; mend what it says otherwise, and nothing else"
        )),
    }
}

/// Has the model read these incidents, of so many; nothing where none is cast. How many they are and what they cost is said before
/// the first question.
///
/// # Errors
/// The run has to stop: a batch waits, a cap is reached, nobody answers.
pub(super) fn read_again(
    suite: &Suite,
    unread: &[Unread],
    all: usize,
    progress: &dyn Progress,
) -> Result<SecondReading, PipelineError> {
    let name = &suite.options().cast.paraphrase;
    let Some(models) = suite.models().filter(|_| name != RULES) else { return Ok(SecondReading::default()) };
    let cast = &suite.options().cast;
    let with_brief = |each: &Unread, ask: &mut dyn FnMut(&recrash_agents::Brief)| {
        let records: Vec<&CrashRecord> = each.incident.reports.iter().map(|report| &report.record).collect();
        ask(&reading_brief(&each.account.incident, &records, suite.profile(), each.account));
    };
    let mut bytes = 0;
    for each in unread {
        with_brief(each, &mut |brief| {
            bytes += paraphrase_question(name, brief).map_or(0, |question| question.bytes());
        });
    }
    let cost = models.estimate(name, bytes, unread.len());
    let share = 100.0 * unread.len() as f64 / all.max(1) as f64;
    let which = match cast.reads {
        Reads::Unread => ", those that the built-in reader did not read whole",
        Reads::All => "",
    };
    let what = format!("{name} reads {} of {all} readable incidents ({share:.1} %){which}: {cost}", unread.len());
    progress.event(ProgressEvent::Said { what: &what });

    let stage = "read";
    progress.event(ProgressEvent::Started { stage, units: unread.len() });
    let stages = suite.options().stager().is_some();
    let one = |each: &Unread| -> Result<(Option<Account>, AgentLog), PipelineError> {
        let repairs = Repairs::default();
        let mut answer = None;
        with_brief(each, &mut |brief| {
            answer = Some(
                models.model(name, cast, &repairs).read_until(brief, each.account, |account| shown(account, stages)),
            );
        });
        progress.event(ProgressEvent::Advanced { stage, unit: &each.account.incident, skipped: false });
        match answer.unwrap_or_else(|| unreachable!("it is asked once")) {
            Ok(account) => Ok((Some(account), AgentLog::model(name, repairs.all()))),
            Err(error) => Ok((None, AgentLog::fallback(name, repairs.all(), unusable(error)?))),
        }
    };
    let answers: Vec<_> = suite.on_threads(Stage::Narrate, || unread.par_iter().map(one).collect());
    progress.event(ProgressEvent::Finished { stage });
    models.must_be_answered(&answers)?;
    let mut read = SecondReading::default();
    for (each, answer) in unread.iter().zip(answers) {
        let (account, log) = answer?;
        read.accounts.push(account);
        read.logs.insert(each.account.incident.clone(), log);
    }
    Ok(read)
}
