//! `recrash reconstruct`: each incident of crash files as a scenario that shows its own crash.

use crate::options::SourceArgs;
use crate::output::{self, Output, title};
use crate::screen::println;
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_model::account::{Account, CrashType, FactShare, TypeShare, told};
use recrash_model::metrics::CheckResult;
use recrash_pipeline::{
    Accounts, Options, PipelineError, Retold, fact_shares, read_accounts, reconstruct_accounts, record_outputs,
    type_shares, write_reconstructions,
};
use std::collections::BTreeMap;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash reconstruct                                      the built-in sample
  recrash reconstruct archive.csv current.csv              how many crashes can be shown as they are told, by type
  recrash reconstruct archive.csv --to-dir scenes          the scenarios, a file an incident
  recrash reconstruct archive.csv --report 30270-7733      one: each stated fact, and what the rollout shows
  recrash simulate scenes/incident-X.json --ego recorded   the crash as it is told
  recrash simulate scenes/incident-X.json --ego idm        another driver in its place, from the handover on

The ego is the recorded driver. Checked are: contact, kind of partner, zones of both within a step, state of both at the
contact, impact speeds, turns of both, lanes of both, signals and signs and whether they were obeyed, why the ego stood, from
where the partner comes, who was first, whether another threw the partner at the ego, doors that took part,
and the others of the story. docs/models/reconstruction.md says how each is checked.";

/// Options of `reconstruct`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ReconstructArgs {
    /// SGO crash files (CSV), as with --records. [default: the built-in sample]
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where crash records come from.
    #[command(flatten)]
    pub source: SourceArgs,
    /// Show the reconstruction of the incident that this report is of, fact by fact.
    #[arg(long, value_name = "ID")]
    pub report: Option<String>,
    /// Write the scenarios that show every checked fact into this folder, and a table of all incidents (`index.csv`).
    #[arg(long, value_name = "DIR")]
    pub to_dir: Option<PathBuf>,
}

impl ReconstructArgs {
    fn options(&self) -> Options {
        let mut source = self.source.clone();
        source.records.extend(self.files.iter().cloned());
        source.over(crate::options::defaults())
    }
}

/// Reconstructs crash files and says how much of them is shown.
///
/// # Errors
/// A file cannot be read or written, or the report is in none of them.
pub fn run(args: &ReconstructArgs, output: Output) -> Result<(), PipelineError> {
    let options = args.options();
    let mut read = read_accounts(&options)?;
    if let Some(id) = &args.report {
        read.accounts.retain(|account| account.reports.iter().any(|report| report.is_called(id)));
        if read.accounts.is_empty() {
            let message = format!("there is no report {id} with a readable narrative among {} reports", read.reports);
            return Err(PipelineError::bad_input(message));
        }
    }
    let retold = reconstruct_accounts(&read.accounts, &*output.progress());
    let mut outputs = record_outputs(&options, None);
    let files = match &args.to_dir {
        Some(folder) => write_reconstructions(&read.accounts, &retold, folder, &mut outputs)?,
        None => Vec::new(),
    };
    if output.json {
        output::json(&json(&read, &retold));
        return Ok(());
    }
    if output.quiet {
        return Ok(());
    }
    output::remark_list(&read.diagnostics, "told by --json");
    if args.report.is_some() {
        one(&read, &retold);
    } else {
        types(&read, &retold);
        reasons(&retold);
        fact_table(&fact_shares(&read.accounts, &retold));
    }
    if let Some(folder) = &args.to_dir {
        println!("{} scenarios in {}, and index.csv: what became of each incident", files.len(), folder.display());
    }
    Ok(())
}

fn json(read: &Accounts, retold: &[Retold]) -> serde_json::Value {
    let of = |each: &Retold| {
        let account = &read.accounts[each.account];
        serde_json::json!({
            "incident": account.incident,
            "report": account.report.to_string(),
            "crash_type": told(&account.crash_type),
            "told": each.untold().is_none(),
            "reason": each.reason(),
            "impact": each.impact(),
            "facts": each.result.as_ref().map_or(&[][..], |made| &made.verdict.checks),
            "assumed": each.result.as_ref().map_or(&[][..], |made| &made.assumed),
        })
    };
    serde_json::json!({
        "incidents": read.incidents.len(),
        "accounts": read.accounts.len(),
        "reconstructions": retold.iter().map(of).collect::<Vec<_>>(),
        "types": type_shares(&read.accounts, retold),
        "facts": fact_shares(&read.accounts, retold),
    })
}

/// Prints, by crash type, how many crashes are shown as they are told.
fn types(read: &Accounts, retold: &[Retold]) {
    type_table(&type_shares(&read.accounts, retold));
    println!("{} incidents, {} with a narrative that can be read", read.incidents.len(), read.accounts.len());
    println!("stated, but not drawn yet: lanes for buses, some others in the story; work zones are not looked at");
}

/// Prints how much of each crash type is told.
pub fn type_table(types: &[TypeShare]) {
    title(
        "Readable incidents whose crash is reconstructed: no stated fact contradicted, nothing that the two did left out",
    );
    let mut table =
        table(&["type", "incidents", "scenes", "share", "all facts shown", "a fact not drawn", "facts per 100 words"]);
    let mut row = |label: &str, incidents: usize, told: usize, whole: usize, facts: String| {
        let share = format!("{:.1} %", 100.0 * told as f64 / incidents.max(1) as f64);
        table.add_row(vec![
            Cell::new(label),
            number(incidents),
            number(told),
            number(share),
            number(whole),
            number(told - whole),
            number(facts),
        ]);
    };
    for share in types {
        let label = share.crash_type.map_or("not stated", CrashType::label);
        row(label, share.incidents, share.told, share.whole, format!("{:.1}", share.facts_per_100_words));
    }
    let sum = |of: fn(&TypeShare) -> usize| types.iter().map(of).sum();
    row("all", sum(|share| share.incidents), sum(|share| share.told), sum(|share| share.whole), String::new());
    println!("{table}");
}

/// Prints why crashes are not told.
fn reasons(retold: &[Retold]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for reason in retold.iter().filter_map(Retold::reason) {
        *counts.entry(reason).or_default() += 1;
    }
    if counts.is_empty() {
        return;
    }
    title("Why the others are not");
    let mut ordered: Vec<(String, usize)> = counts.into_iter().collect();
    ordered.sort_by_key(|(reason, count)| (std::cmp::Reverse(*count), reason.clone()));
    let mut table = table(&["reason", "incidents"]);
    for (reason, count) in ordered {
        table.add_row(vec![Cell::new(reason), number(count)]);
    }
    println!("{table}");
}

/// How many stated facts no reconstruction draws, in a sentence.
pub fn not_drawn(facts: &[FactShare]) -> String {
    let sum = |of: fn(&FactShare) -> usize| facts.iter().map(of).sum::<usize>();
    let [told, shown, not_drawn] = [sum(|share| share.told), sum(|share| share.shown), sum(|share| share.not_drawn)];
    format!(
        "of {told} stated facts in all readable incidents {shown} are shown, {not_drawn} are not drawn, {} are of crashes that are not reconstructed or are shown otherwise",
        told.saturating_sub(shown + not_drawn)
    )
}

/// Prints the share of stated facts that are shown.
pub fn fact_table(facts: &[FactShare]) {
    title("Stated facts, over all readable incidents");
    let mut table = table(&["fact", "told", "shown", "share", "not drawn", "shown otherwise, or no scene"]);
    for share in facts.iter().filter(|share| share.told > 0) {
        let percent = format!("{:.1} %", 100.0 * share.shown as f64 / share.told as f64);
        let otherwise = share.told.saturating_sub(share.shown + share.not_drawn);
        let numbers =
            [number(share.told), number(share.shown), number(percent), number(share.not_drawn), number(otherwise)];
        table.add_row([Cell::new(share.fact.label())].into_iter().chain(numbers));
    }
    println!("{table}");
    println!("{}", not_drawn(facts));
}

/// Prints one reconstruction.
fn one(read: &Accounts, retold: &[Retold]) {
    for each in retold {
        let account: &Account = &read.accounts[each.account];
        let kind = told(&account.crash_type).map_or("not stated", CrashType::label);
        title(&format!("Incident {}, report {}, {kind}", account.incident, account.report));
        match &each.result {
            Ok(made) => {
                let mut table = table(&["fact", "shown", "told", "what the rollout shows"]);
                for fact in &made.verdict.checks {
                    let shown = match fact.result {
                        CheckResult::Shown => "yes",
                        CheckResult::NotShown => "no",
                        CheckResult::CannotBeShown => "not drawn",
                        CheckResult::NotTold => "not stated",
                    };
                    let cells = [fact.kind.label(), shown, &fact.expected, &fact.observed];
                    table.add_row(cells.into_iter().map(Cell::new).collect::<Vec<_>>());
                }
                println!("{table}");
                for assumed in &made.assumed {
                    println!("assumed: {assumed}");
                }
            }
            Err(reason) => println!("{reason}"),
        }
    }
}
