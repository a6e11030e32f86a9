//! `recrash run` and `recrash report`: everything, and what came of it in tables.

use super::records::funnel;
use super::retold;
use super::select::{coverage, tables};
use super::simulate::REGULATION_DRIVERS;
use crate::options::{StageArgs, SuiteArgs};
use crate::output::{self, Output, title};
use crate::screen::{bold, eprintln, one_line, println, yellow};
use crate::table::{Cell, number, table};
use recrash_model::metrics::{Answer, CheckKind};
use recrash_model::narrative::Origin;
use recrash_pipeline::{
    CaseSummary, ModelSummary, PipelineError, RunSummary, Stage, Suite, Summary, check_choices, must_be_ready,
    run_stage,
};
use std::path::Path;

/// Runs every stage.
///
/// # Errors
/// The first stage's that stops; a scenario is not true to its record, or could not be run.
pub fn run(args: &SuiteArgs, output: Output) -> Result<(), PipelineError> {
    let suite = args.open(crate::options::defaults())?;
    output::batch_remarks(&suite, output);
    check_choices(&suite)?;
    if output.tables() {
        heading(&suite);
    }
    must_be_ready(&suite)?;
    let progress = output.progress();
    for stage in Stage::ALL {
        let report = run_stage(&suite, stage, &*progress)?;
        if output.tables() {
            output::remarks(&report);
        }
    }
    let summary = finish(&suite, output)?;
    summary.missed(&suite)?.map_or(Ok(()), |what| Err(PipelineError::Missed { what }))
}

/// Writes the report of a suite.
///
/// # Errors
/// A stage before it is not done.
pub fn report(args: &StageArgs, output: Output) -> Result<(), PipelineError> {
    let suite = args.suite().open_saved()?;
    run_stage(&suite, Stage::Report, &*output.progress())?;
    finish(&suite, output).map(drop)
}

fn finish(suite: &Suite, output: Output) -> Result<Summary, PipelineError> {
    let summary: Summary = suite.store().read_json("summary.json")?;
    if output.json {
        output::json(&summary);
    } else if !output.quiet {
        show(&summary, suite.store().dir());
        spent(suite);
    }
    let first = summary.failures().next().filter(|_| summary.run() == 0).map(|(_, failure)| failure.to_string());
    match first {
        Some(why) => Err(PipelineError::bad_input(format!("no scenario could be run; the first: {why}"))),
        None => Ok(summary),
    }
}

/// Prints what is about to be done.
fn heading(suite: &Suite) {
    let options = suite.options();
    eprintln!(
        "{} {}: profile {}, ego {}, budget {}, seed {} -> {}",
        bold("recrash"),
        env!("CARGO_PKG_VERSION"),
        suite.profile().name,
        suite.ego(),
        options.budget.map_or("all".to_owned(), |budget| budget.to_string()),
        options.seed,
        suite.store().dir().display()
    );
}

fn gap(run: Option<&RunSummary>) -> String {
    match run.map(|run| (&run.contact, run.min_gap_m)) {
        Some((Some(kind), _)) => format!("contact: {kind}"),
        Some((None, Some(gap))) if gap < 0.01 => "< 0.01 m".into(),
        Some((None, Some(gap))) => format!("{gap:.2} m"),
        Some((None, None)) | None => "-".into(),
    }
}

/// Prints what this run has spent on models.
fn spent(suite: &Suite) {
    if let Some(spent) = suite.spent().filter(|spent| spent.answers > 0) {
        let cost = if spent.cost_usd > 0.0 { format!(", {:.4} USD", spent.cost_usd) } else { String::new() };
        let dir = suite.store().dir().display();
        println!(
            "models: {} answers, {} tokens{cost} in this run; recrash ledger {dir} tells more",
            spent.answers, spent.tokens
        );
    }
}

/// Prints how the models did, and where the rules took over.
fn models(models: &[ModelSummary]) {
    if models.is_empty() {
        return;
    }
    title("Language models (scenarios)");
    let mut rows = table(&["role", "model", "first answer", "after repair", "rules took over", "not asked"]);
    for model in models {
        let mut row = vec![Cell::new(&model.role), Cell::new(&model.model)];
        row.extend([model.first_answer, model.after_repair, model.fallback, model.not_asked].map(number));
        rows.add_row(row);
    }
    println!("{rows}");
    for model in models {
        for reason in &model.reasons {
            println!(
                "  {} {} of {}: {}",
                yellow(if model.is_review() { "by nobody:" } else { "by the rules:" }),
                model.role,
                reason.id,
                one_line(&reason.why.chars().take(300).collect::<String>())
            );
        }
    }
}

/// Prints a whole run in tables.
fn show(summary: &Summary, dir: &Path) {
    if let Some(accounts) = &summary.accounts {
        return retold::show(summary, accounts, dir);
    }
    funnel(&summary.funnel);
    tables(&summary.tables);
    coverage(&summary.coverage, &summary.templates);
    scenarios(&summary.cases);
    for case in &summary.cases {
        doubts(case);
    }
    let doubted = |run: &RunSummary| run.unfaithful.iter().any(|why| why.starts_with(CheckKind::Order.label()));
    if summary.cases.iter().filter_map(|case| case.tuned.as_ref()).any(doubted) {
        println!("  order: {}", CheckKind::Order.doubt().unwrap_or_default());
    }
    models(&summary.models);
    result(summary);
    ending(summary, dir);
}

/// The scenarios in a table.
fn scenarios(cases: &[CaseSummary]) {
    title("Scenarios (least box gap to the partner, as designed and as tuned)");
    let mut rows = table(&["scenario", "from", "designed", "tuned", "verdict", "failure", "findings"])
        .without_first(&["findings", "from", "designed", "failure", "tuned"]);
    for case in cases {
        let verdict = match (case.faithful(), &case.tuned) {
            (Some(Answer::Yes), _) => "faithful",
            (Some(Answer::Unchecked), _) => "not all checked",
            (Some(Answer::No), _) => "NOT FAITHFUL",
            (None, Some(_)) => "no record",
            (None, None) => "NOT RUN",
        };
        rows.add_row(vec![
            Cell::new(&case.id),
            Cell::new(case.origin.as_ref().map_or("", Origin::label)),
            Cell::new(gap(case.first.as_ref())),
            Cell::new(gap(case.tuned.as_ref())),
            Cell::new(verdict),
            Cell::new(case.triage.as_ref().map_or("", |triage| triage.class.label())),
            Cell::new(case.tuned.as_ref().map_or_else(String::new, RunSummary::findings_in_words)),
        ]);
    }
    println!("{rows}");
}

/// Why a scenario was not run, or what of it does not show what is told.
fn doubts(case: &CaseSummary) {
    if let Some(failure) = &case.failure {
        let what = if case.unanswered().is_some() { "not answered:" } else { "not run:" };
        println!("  {} {}: {failure}", yellow(what), case.id);
        return;
    }
    let Some(run) = case.tuned.as_ref() else { return };
    match run.faithful {
        None | Some(Answer::Yes) => {}
        Some(Answer::No) => {
            println!("  {} {}: {}", yellow("not faithful:"), case.id, run.unfaithful.join("; "));
        }
        Some(Answer::Unchecked) => {
            let why = if run.unchecked.is_empty() { "nothing is told".into() } else { run.unchecked.join(", ") };
            println!("  {} {}: {why}", yellow("not all checked:"), case.id);
        }
    }
}

/// How many were run, failed, and show what is told.
fn result(summary: &Summary) {
    let (total, run) = (summary.cases.len(), summary.run());
    let of_total = if run < total { format!(" of {total}") } else { String::new() };
    let (first, tuned) = summary.failed();
    println!(
        "\n{} {run}{of_total} scenarios run; {} fails {first} as designed and {tuned} after tuning",
        bold("result:"),
        summary.ego,
    );
    let [own, other, invented] = summary.origins();
    println!("  told: {own} of their own record, {other} of another real record, {invented} invented");
    for (place, name, count) in [(0, "their own record", own), (1, "another record", other)] {
        let [yes, no, unchecked] = [Answer::Yes, Answer::No, Answer::Unchecked].map(|a| summary.faithful(a)[place]);
        println!(
            "  of the {count} of {name}: {yes} show every fact told, {no} do not, {unchecked} could not all be checked"
        );
    }
}

/// What every run says last.
fn ending(summary: &Summary, dir: &Path) {
    let edited = summary.cases.iter().filter(|case| !case.edited.is_empty()).count();
    if edited > 0 {
        println!("  {edited} edited by hand, and kept");
    }
    for (class, count) in summary.failure_classes() {
        println!("  {count:>4} {}: {}", class.label(), class.meaning());
    }
    let told = |counts: Vec<(&str, usize)>| {
        let told: Vec<String> = counts.into_iter().map(|(label, count)| format!("{count} {label}")).collect();
        told.join(", ")
    };
    retold::unrepeated(summary);
    let causes = summary.causes();
    if !causes.is_empty() {
        let word = if causes.len() == 1 { "cause" } else { "causes" };
        let listed = told(causes.iter().map(|(cause, count)| (cause.label(), *count)).collect());
        println!("  {} {word}, a finding each: {listed}", causes.len());
    }
    let brackets = summary.brackets();
    if !brackets.is_empty() {
        println!(
            "  of contacts, {REGULATION_DRIVERS}: {}",
            told(brackets.into_iter().map(|(bracket, count)| (bracket.label(), count)).collect())
        );
    }
    if summary.sample {
        println!("records: the built-in sample, invented; give real crash files with --records FILE");
    }
    println!("report: {}", dir.join("report.html").display());
}
